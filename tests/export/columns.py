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
    "initial_energy": "J",
    "energy_imbalance": None,
    "min_frequency": "rad/s",
    "inelasticity": "1",
    "loss_tangent": "1",
    "cor_error": "1",
    "cor_sphere_error": "1",
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
TEXTS = {"status"}
