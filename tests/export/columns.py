"""The columns that users' scripts rely on, with their units."""

SUMMARY = {
    "cor": "1",
    "cor_sphere": "1",
    "contact_time": "s",
    "max_indentation": "m",
    "max_force": "N",
    "residual_indentation": "m",
    "residual_ratio": "1",
    "hysteresis_energy": "J",
    "wave_energy": "J",
    "energy_loss": "J",
    "initial_energy": "J",
    "energy_imbalance": None,
    "min_frequency": "rad/s",
    "inelasticity": "1",
    "loss_tangent": "1",
    "cor_error": "1",
    "cor_sphere_error": "1",
    "resilience": "1",
    "rebound_height": "m",
    "contact_radius": "m",
    "contact_ratio": "1",
    "thickness_ratio": "1",
    "plate_wave_number": "1",
    "needed_extent": "m",
    "deflection_ratio": "1",
    "weight_ratio": "1",
    "mean_pressure": "Pa",
    "half_space_loss": "1",
    "bending_loss": "1",
    "footprint_effect": "1",
    "peak_loss_tangent": "1",
    "validity": "",
    "validity_cause": "",
    "steps": "1",
    "status": "",
}

HISTORY = {
    "time": "s",
    "indentation": "m",
    "relative_velocity": "m/s",
    "force": "N",
    "impulse": "N s",
    "sphere_displacement": "m",
    "sphere_velocity": "m/s",
    "plate_displacement": "m",
    "plate_velocity": "m/s",
}

INTEGERS = {"steps"}
TEXTS = {"status", "validity", "validity_cause"}
