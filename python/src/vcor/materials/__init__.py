"""Materials from measurements: data, fits, master curves, identification."""
