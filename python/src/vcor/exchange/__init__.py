"""Input for other programs: restitution for DEM codes, cards of materials for FE codes."""
