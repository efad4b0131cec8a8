"""Bodies that are not spheres: closed forms, scaling laws, both methods, refusals."""

import math

import pytest
from program import INPUT

PUNCH = "shape = 'punch', punch_radius = 0.004, mass = 0.05"
CONE = "shape = 'cone', half_angle = 65, mass = 0.05"
QUARTIC = "shape = 'power', profile_coefficient = 2e5, profile_power = 4, mass = 0.05"
SHAPES = {"cone": CONE, "punch": PUNCH, "quartic": QUARTIC}
ELASTIC = "model = 'elastic', modulus = 1e6"
SLS = "model = 'sls', glassy_modulus = 1e6, alpha = 60, beta = 200"
FLUID = "model = 'power_law', coefficient = 2e5, exponent = 0.3"
METHODS = {"ive": 5e-8, "direct": 2e-6}


def case(sphere, material=SLS, velocity=2.0, plate="waves = 'none'", more=""):
    """A rigid body on a material of plane-strain factor 4/3."""
    return f"""&impact velocity = {velocity!r} /
&sphere {sphere}, material = 'body' /
&plate material = 'base', {plate} /
&material name = 'body', model = 'rigid', density = 7800 /
&material name = 'base', density = 1100, poisson_ratio = 0.5, {material} /
{more}"""


def numbers(vcor, text, names, *words):
    """Some columns of a case."""
    vcor.write(text)
    done = vcor("run", "case.nml", "--print", names, *words)
    assert done.code == 0, done.err
    return [float(word) for word in done.out.split()]


@pytest.mark.parametrize("method", METHODS)
def test_elastic_punch(vcor, method):
    """A punch on an elastic base is a mass on a spring: half a period."""
    words = ["--set", f"solver.method={method}"]
    cor, time, depth, force = numbers(
        vcor, case(PUNCH, ELASTIC), "cor,contact_time,max_indentation,max_force", *words
    )
    stiffness = 2 * 0.004 * 1e6 / 0.75
    omega = math.sqrt(stiffness / 0.05)
    near = METHODS[method]
    assert cor == pytest.approx(1, abs=near)
    assert time == pytest.approx(math.pi / omega, rel=10 * near)
    assert depth == pytest.approx(2 / omega, rel=10 * near)
    assert force == pytest.approx(stiffness * 2 / omega, rel=10 * near)


def test_elastic_cone(vcor):
    """F = K s^2: at the end the force says little of the time, the indentation all."""
    stiffness = 2 / math.pi * math.tan(math.radians(65)) * 1e6 / 0.75
    depth = (3 * 0.05 * 2.0**2 / (2 * stiffness)) ** (1 / 3)
    half = math.gamma(1 / 3) * math.gamma(1 / 2) / math.gamma(5 / 6) / 3
    for accuracy in ("1e-6", "1e-8", "1e-10"):
        words = ["--set", f"solver.accuracy={accuracy}"]
        names = "cor,contact_time,max_indentation"
        cor, time, largest = numbers(vcor, case(CONE, ELASTIC), names, *words)
        assert cor == pytest.approx(1, abs=float(accuracy))
        assert largest == pytest.approx(depth, rel=float(accuracy))
        near = max(float(accuracy), 1e-9)
        assert time == pytest.approx(2 * depth / 2.0 * half, rel=near)


@pytest.mark.parametrize("power", [1.5, 3, 4.5])
def test_branch_point_of_a_profile(vcor, power):
    """F = K s^(1 + 1/p) is not a polynomial in sqrt(t) at first, which affects a rebound."""
    sphere = f"shape = 'power', profile_coefficient = {0.3 * 330**power}"
    sphere += f", profile_power = {power}, mass = 0.002"
    rubber = "model = 'prony', equilibrium_modulus = 2.5e7, moduli = 3.9e7, 5e7, 1.2e7"
    rubber += ", times = 9e-6, 1.2e-5, 5e-3"
    plate = "waves = 'constant', half_thickness = 0.03"
    text = case(sphere, rubber, 0.07, plate, "&contact law = 'receding' /\n")

    def solved(accuracy, method="ive"):
        words = ["--set", f"solver.accuracy={accuracy}"]
        words += ["--set", f"solver.method={method}"]
        return numbers(vcor, text, "cor,cor_error", *words)

    best, _ = solved(1e-11)
    direct, direct_error = solved(1e-7, "direct")
    assert best == pytest.approx(direct, abs=3 * direct_error)
    for accuracy in (1e-6, 1e-8, 1e-10):
        cor, error = solved(accuracy)
        assert abs(cor - best) < min(accuracy, 3 * error)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("plate", [0.0, 0.3])
def test_damped_punch(vcor, method, plate):
    """A punch on a spring and a dashpot, on a plate that moves at once: a damped oscillator.

    F = k s + c s' with s = z - U, U' = a F: eta = F/m is what slows both, s'' = -F/m - a F'.
    """
    stiffness, drag, mass, v = 2 * 0.004 * 1e6 / 0.75, 2 * 0.004 * 80 / 0.75, 0.05, 2.0
    text = case(PUNCH, "model = 'prony', equilibrium_modulus = 1e6, viscosity = 80")
    a = 0.0
    if plate:
        h = 0.02
        a = math.sqrt(3 * 1100 / (1e6 / 0.75)) / (16 * 1100 * h**2)
        text = text.replace(
            "waves = 'none'", f"waves = 'constant', half_thickness = {h}"
        )
    # (1 + a c) s'' + (c/m + a k) s' + (k/m) s = 0, s(0) = 0, s'(0+) = v/(1 + a c)
    b = (drag / mass + a * stiffness) / (1 + a * drag) / 2
    w = math.sqrt(stiffness / mass / (1 + a * drag) - b * b)
    start = v / (1 + a * drag)

    def motion(t):
        s = start / w * math.exp(-b * t) * math.sin(w * t)
        rate = start * math.exp(-b * t) * (math.cos(w * t) - b / w * math.sin(w * t))
        return stiffness * s + drag * rate, rate

    low, high = 0.3 * math.pi / w, 1.01 * math.pi / w
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if motion(middle)[0] > 0 else (low, middle)
    words = ["--set", f"solver.method={method}"]
    cor, time = numbers(vcor, text, "cor,contact_time", *words)
    near = METHODS[method]
    # at F = 0 the plate has stopped, so s' is the velocity of the punch
    assert cor == pytest.approx(-motion(low)[1] / v, abs=near)
    assert time == pytest.approx(low, rel=10 * near)
    vcor.write(text + "&output hdf5 = .false. /\n")
    vcor("run", "case.nml", "--quiet", *words)
    rows = (vcor.folder / "case.csv").read_text().splitlines()
    rows = [row for row in rows if not row.startswith("#")]
    first = dict(zip(rows[0].split(","), map(float, rows[1].split(",")), strict=True))
    assert first["force"] == pytest.approx(drag * start)
    assert first["relative_velocity"] == pytest.approx(start)


def test_profile_of_a_sphere(vcor):
    """z = r^2/(2 R) is the sphere of Hertz."""
    names = "cor,contact_time,max_force,contact_radius,mean_pressure,thickness_ratio"
    plate = "waves = 'relaxing', half_thickness = 0.01"
    sphere = numbers(vcor, case("radius = 0.01, mass = 0.05", plate=plate), names)
    profile = (
        "shape = 'power', profile_coefficient = 50, profile_power = 2, mass = 0.05"
    )
    assert numbers(vcor, case(profile, plate=plate), names) == pytest.approx(
        sphere, rel=1e-12
    )


def test_profile_next_to_a_cone(vcor):
    cone = numbers(vcor, case(CONE), "cor,contact_time,contact_radius")
    slope = 1 / math.tan(math.radians(65))
    profile = f"shape = 'power', profile_coefficient = {slope!r}, profile_power = 1.0000001, mass = 0.05"
    assert numbers(
        vcor, case(profile), "cor,contact_time,contact_radius"
    ) == pytest.approx(cone, rel=1e-5)


@pytest.mark.parametrize("law", ["boltzmann", "receding"])
def test_master_curve_of_a_cone(vcor, law):
    """Without plate a cone's restitution depends on m/(tan(angle) v) alone."""
    more = f"&contact law = '{law}' /\n"
    one = numbers(vcor, case(CONE, more=more), "cor,contact_time")
    tan = math.tan(math.radians(65))
    angle = math.degrees(math.atan(3 * tan))
    other = f"shape = 'cone', half_angle = {angle!r}, mass = 0.3"
    found = numbers(vcor, case(other, velocity=4.0, more=more), "cor,contact_time")
    assert found == pytest.approx(one, rel=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
def test_time_scale(vcor, shape):
    """m/(K v^(n-1)) is all that counts without a plate, for every n."""
    n = {"cone": 2.0, "punch": 1.0, "quartic": 1.25}[shape]
    one = numbers(vcor, case(SHAPES[shape]), "cor,contact_time")
    heavier = SHAPES[shape].replace("mass = 0.05", f"mass = {0.05 * 7 ** (n - 1)!r}")
    assert numbers(
        vcor, case(heavier, velocity=14.0), "cor,contact_time"
    ) == pytest.approx(one, rel=2e-8)


@pytest.mark.parametrize("shape", SHAPES)
def test_power_law_material(vcor, shape):
    """A material without a time of its own: nothing but its exponent and n counts."""
    one = numbers(vcor, case(SHAPES[shape], FLUID), "cor")
    other = case(
        SHAPES[shape].replace("0.05", "0.9"), FLUID.replace("2e5", "7e3"), velocity=0.6
    )
    assert numbers(vcor, other, "cor") == pytest.approx(one, abs=2e-8)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("waves", ["none", "relaxing", "hereditary"])
def test_methods_agree(vcor, shape, waves):
    more = "&contact law = 'receding' /\n" if shape != "punch" else ""
    text = case(
        SHAPES[shape], plate=f"waves = '{waves}', half_thickness = 0.02", more=more
    )
    ive, direct = (
        numbers(vcor, text, "cor", "--set", f"solver.method={m}")
        for m in ("ive", "direct")
    )
    assert ive == pytest.approx(direct, abs=2e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_second_volterra_term(vcor, shape):
    """Its coefficient has the unit of 1/u, m^-n."""
    more = "&solver volterra_order = 2, volterra_coefficient = 30.0 /\n"
    text = case(SHAPES[shape], more=more)
    fine, usual = (
        numbers(vcor, text, "cor", "--set", f"solver.accuracy={accuracy}") for accuracy in ("1e-8", "1e-6")
    )
    plain = numbers(vcor, case(SHAPES[shape]), "cor")
    assert fine == pytest.approx(usual, abs=3e-6)
    assert abs(fine[0] - plain[0]) > 1e-5


def test_measures(vcor):
    """Contact radius and mean pressure of each shape; no radius to compare them with."""
    names = "max_indentation,max_force,contact_radius,mean_pressure,contact_ratio,thickness_ratio"
    plate = "waves = 'none', half_thickness = 0.02"
    depth, force, radius, pressure, ratio, thickness = numbers(
        vcor, case(CONE, ELASTIC, plate=plate), names
    )
    assert radius == pytest.approx(2 / math.pi * math.tan(math.radians(65)) * depth)
    assert pressure == pytest.approx(force / (math.pi * radius**2))
    assert pressure == pytest.approx(
        1e6 / 0.75 / 2 / math.tan(math.radians(65)), rel=1e-6
    )
    assert math.isnan(ratio)
    assert thickness == pytest.approx(radius / 0.04)
    *_, radius, pressure, ratio, _ = numbers(
        vcor, case(PUNCH, ELASTIC, plate=plate), names
    )
    assert radius == pytest.approx(0.004)


def test_sweep(vcor):
    """The power of a profile is a number like any other."""
    text = case(
        QUARTIC, more="&sweep parameter = 'sphere.profile_power', values = 2, 4, 9 /\n"
    )
    vcor.write(text)
    found = [
        float(line.split()[-1])
        for line in vcor.succeeds(
            "run", "case.nml", "--print", "sphere.profile_power,cor", "--quiet"
        ).splitlines()
    ]
    single = [
        numbers(vcor, case(QUARTIC.replace("power = 4", f"power = {p}")), "cor")[0]
        for p in (2, 4, 9)
    ]
    assert found == single


@pytest.mark.parametrize(
    "sphere, says",
    [
        ("shape = 'cone', half_angle = 65", ["mass", "missing", "cone"]),
        ("shape = 'cone', mass = 1", ["half_angle", "missing"]),
        ("shape = 'punch', mass = 1", ["punch_radius", "missing"]),
        (
            "shape = 'power', mass = 1, profile_power = 2",
            ["profile_coefficient", "missing"],
        ),
        ("mass = 1", ["radius", "missing"]),
        (CONE + ", radius = 0.01", ["radius", "does not belong to shape 'cone'"]),
        (
            "radius = 0.01, half_angle = 30",
            ["half_angle", "does not belong to shape 'sphere'"],
        ),
        (CONE.replace("65", "90"), ["half_angle", "90"]),
        (CONE.replace("65", "0"), ["half_angle", "0"]),
        (PUNCH.replace("0.004", "-0.004"), ["punch_radius", "> 0"]),
        (QUARTIC.replace("power = 4", "power = 1"), ["profile_power", "> 1"]),
        (QUARTIC.replace("2e5", "0"), ["profile_coefficient", "> 0"]),
        (CONE.replace("cone", "cube"), ["shape", "cone"]),
    ],
)
def test_refused(vcor, sphere, says):
    vcor.write(case(sphere))
    vcor.refuses("run", "case.nml", code=INPUT, says=says)


def test_what_does_not_go_together(vcor):
    """A punch does not recede, and only a sphere meets a curved surface."""
    vcor.write(case(PUNCH, more="&contact law = 'receding' /\n"))
    vcor.refuses("run", "case.nml", code=INPUT, says=["law", "recede", "boltzmann"])
    vcor.write(case(CONE, plate="waves = 'none', surface_radius = 0.1"))
    vcor.refuses("run", "case.nml", code=INPUT, says=["surface_radius", "sphere"])


def test_verify(vcor):
    """Both methods, and the choices that a punch has."""
    vcor.write(case(PUNCH, plate="waves = 'relaxing', half_thickness = 0.02"))
    out = vcor.succeeds("verify", "case.nml")
    assert "hereditary" in out
    assert "receding" not in out
    assert "receding" not in vcor("run", "case.nml").out
