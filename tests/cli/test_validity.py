"""Whether the model holds: the measures of validity, what is said of them, and the notes on input."""

import math

import pytest
from program import INPUT, ROOT, TEXTS

GLASS = (ROOT / "examples" / "steel_on_glass.nml").read_text(encoding="utf-8")
BEADS = (ROOT / "examples" / "granular_pair.nml").read_text(encoding="utf-8")
SLS = (ROOT / "examples" / "paper" / "sls.nml").read_text(encoding="utf-8")
DROPPED = GLASS.replace("velocity = 1.0 ", "drop_height = 0.05 ")
GRAVITY = 9.80665


def numbers(vcor, text, *words):
    """The columns of an impact, those that are no texts as numbers."""
    vcor.write(text)
    values = vcor.numbers("case.nml", *words)
    return {name: value if name in TEXTS else float(value) for name, value in values.items()}


# Columns


def test_elastic_plate(vcor):
    """Every measure of an elastic impact, by hand."""
    row = numbers(vcor, GLASS)
    sphere, plate = 210e9 / (1 - 0.3**2), 70e9 / (1 - 0.22**2)
    radius = math.sqrt(0.002 * row["max_indentation"])
    mass = 7800 * 4 / 3 * math.pi * 0.002**3
    frequency = math.pi / row["contact_time"]
    wave_number = (12 * 2500 * (1 - 0.22**2) * frequency**2 / (70e9 * 0.003**2)) ** 0.25
    shear_speed = math.sqrt(70e9 / (2 * 1.22) / 2500)
    expected = {
        "resilience": row["cor_sphere"] ** 2,
        "contact_radius": radius,
        "contact_ratio": radius / 0.002,
        "thickness_ratio": radius / 0.003 * sphere / (sphere + plate),
        "plate_wave_number": wave_number * 0.003,
        "needed_extent": math.pi / wave_number,
        "weight_ratio": mass * GRAVITY / row["max_force"],
        # the largest force of an elastic contact is that of the largest indentation
        "mean_pressure": row["max_force"] / (math.pi * radius**2),
        "peak_loss_tangent": 0.0,
    }
    # the polynomials between the nodes are as accurate as the solution, 1e-8
    for name, value in expected.items():
        assert row[name] == pytest.approx(value, rel=1e-8, abs=0.0), name
    loss = row["max_force"] ** 2 * math.pi**2 / (2 * row["contact_time"]) / row["initial_energy"]
    loss *= resistance(0.22) / (2 * math.pi * 2500 * shear_speed**3)
    assert row["half_space_loss"] == pytest.approx(loss, rel=1e-6)
    assert math.isnan(row["rebound_height"])
    assert (row["validity"], row["validity_cause"]) == ("good", "none")


def resistance(ratio):
    """Miller and Pursey's integral by the midpoint rule off the real axis, where it has no pole."""
    a2 = (1 - 2 * ratio) / (2 * (1 - ratio))
    steps, length, height = 20000, 40.0, 0.3
    total = 0.0
    # below the axis from 0 on, back to it far behind the pole, where the integrand is real
    for i in range(steps):
        t = (i + 0.5) / steps
        x = complex(length * t**2, height * math.sin(math.pi * t) ** 2)
        slope = complex(2 * length * t, height * math.pi * math.sin(2 * math.pi * t)) / steps
        p, q = (x**2 - a2) ** 0.5, (x**2 - 1) ** 0.5
        total += (x * p / ((2 * x**2 - 1) ** 2 - 4 * x**2 * p * q) * slope).imag
    return abs(total)


def test_numbers_that_there_are_not(vcor):
    """Of two spheres, of a rigid plate, without waves."""
    row = numbers(vcor, BEADS)
    plates = ["thickness_ratio", "plate_wave_number", "needed_extent", "deflection_ratio"]
    for name in [*plates, "half_space_loss", "rebound_height"]:
        assert math.isnan(row[name]), name
    assert row["validity"] == "good"
    row = numbers(vcor, BEADS.replace("surface_radius = 2.995e-3", "surface_radius = 0"))
    assert row["half_space_loss"] > 0 and math.isnan(row["thickness_ratio"])
    rigid = BEADS.replace("material = 'cellulose acetate'\n   waves", "material = 'wall'\n   waves")
    row = numbers(vcor, rigid + "&material name = 'wall', model = 'rigid' /\n")
    assert math.isnan(row["half_space_loss"])


def test_drop_height(vcor):
    row = numbers(vcor, DROPPED)
    velocity = math.sqrt(2 * GRAVITY * 0.05)
    other = numbers(vcor, GLASS, "--set", f"impact.velocity={velocity!r}")
    assert row["cor"] == other["cor"]
    assert row["rebound_height"] == pytest.approx(0.05 * row["resilience"], rel=1e-14)
    assert math.isnan(other["rebound_height"])
    vcor.write(DROPPED.replace("drop_height = 0.05", "")
               + "&sweep parameter = 'impact.drop_height', values = 0.05, 0.2 /\n")
    out = vcor.succeeds("run", "case.nml", "--print", "cor,rebound_height", "--quiet").split()
    assert float(out[0]) == row["cor"] and float(out[1]) == row["rebound_height"]
    assert float(out[3]) > float(out[1])


def test_drop_height_or_velocity(vcor):
    vcor.write(DROPPED)
    both = "found both velocity and drop_height, expected one of them"
    vcor.refuses("run", "case.nml", "--set", "impact.velocity=1", code=INPUT, says=both)
    vcor.write(GLASS + "&sweep parameter = 'impact.drop_height', values = 1, 2 /\n")
    vcor.refuses("run", "case.nml", code=INPUT, says=both)
    vcor.write(DROPPED.replace("drop_height = 0.05", ""))
    neither = "key 'velocity' is missing in &impact, expected a number > 0 [m/s], or drop_height"
    vcor.refuses("run", "case.nml", code=INPUT, says=neither)


@pytest.mark.parametrize(
    "key, value, measure, level",
    [
        ("plate.extent", "0.1", "none", "good"),
        ("plate.extent", "0.02", "needed_extent", "caution"),
        ("plate.extent", "0.01", "needed_extent", "outside"),
        ("float_glass.yield_strength", "2e9", "none", "good"),
        ("float_glass.yield_strength", "1e9", "mean_pressure", "caution"),
        ("bearing_steel.yield_strength", "1e8", "mean_pressure", "outside"),
        ("plate.half_thickness", "4e-3", "plate_wave_number", "caution"),
    ],
)
def test_levels(vcor, key, value, measure, level):
    row = numbers(vcor, GLASS, "--set", f"{key}={value}")
    assert (row["validity"], row["validity_cause"]) == (level, measure)
