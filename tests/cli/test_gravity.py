"""Impacts with the weight of the sphere: rest, drop heights, and what does not go with it."""

import math

import pytest
from program import INPUT, NUMERICAL, PAPER

CASE = """&impact velocity = 0.4, gravity = 9.81 /
&sphere radius = 0.02, material = 'ball' /
&plate material = 'gel', waves = 'none' /
&material name = 'ball', model = 'rigid', density = 7800 /
&material name = 'gel', model = 'sls', poisson_ratio = 0.5, glassy_modulus = 1e5, alpha = 50.0, beta = 100.0 /
&output csv = .false., hdf5 = .false. /
"""
METHODS = ("ive", "direct")
MASS = 4 / 3 * math.pi * 0.02**3 * 7800


def settled(modulus, weight=MASS * 9.81):
    """Indentation at which a spring of the plane-strain modulus E/(1 - 1/4) holds the sphere."""
    return (weight * 0.75 / modulus / (4 / 3 * math.sqrt(0.02))) ** (2 / 3)


def run(vcor, names, *words):
    """Numbers and status of a case."""
    done = vcor("run", "case.nml", "--print", names + ",status", *words)
    assert done.code == 0, done.err
    *values, status = done.out.split()
    return [float(value) for value in values], status


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("velocity", [0.05, 1e-6])
def test_rests(vcor, method, velocity):
    """A sphere that is put down comes to where the relaxed spring holds its weight."""
    vcor.write(CASE)
    values, status = run(
        vcor,
        "residual_indentation,cor,contact_time",
        "--set",
        f"solver.method={method}",
        "--set",
        f"impact.velocity={velocity}",
    )
    assert status == "rests"
    assert values[0] == pytest.approx(settled(0.5e5), rel=1e-6)
    assert math.isnan(values[1]) and math.isnan(values[2])


@pytest.mark.parametrize("waves", ["none", "hereditary"])
@pytest.mark.parametrize("velocity", [1e-9, 1e-7, 1e-6, 1e-5, 1e-4])
def test_put_down_on_a_dashpot(vcor, velocity, waves):
    """Over many oscillations, ive took rounding in the force for the end of the contact."""
    gel = "'prony', density = 1000, poisson_ratio = 0.5, equilibrium_modulus = 1e5, viscosity = 30.0"
    vcor.write(
        CASE.replace("'sls', poisson_ratio = 0.5, glassy_modulus = 1e5, alpha = 50.0, beta = 100.0", gel)
        .replace("waves = 'none'", f"waves = '{waves}', half_thickness = 0.5")
        .replace("velocity = 0.4", f"velocity = {velocity}")
    )
    words = ["--set", "solver.method=ive", "--set"]
    names = "max_force,residual_indentation"
    (force, left), status = run(vcor, names, *words, "contact.law=boltzmann")
    assert status == "rests"
    assert left == pytest.approx(settled(1e5), rel=1e-6)
    # the contact is the same up to the largest indentation
    (other, _), _ = run(vcor, names, *words, "contact.law=receding")
    assert force == pytest.approx(other, rel=1e-7)


@pytest.mark.parametrize("method", ["ive", "direct"])
@pytest.mark.parametrize("law", ["boltzmann", "receding"])
def test_rest_of_a_material_that_creeps(vcor, law, method):
    """It comes to rest long after the end of the computation, or of the steps of method direct."""
    gel = "'prony', poisson_ratio = 0.5, equilibrium_modulus = 1e5, moduli = 1e6, times = 100.0, viscosity = 1e4"
    vcor.write(
        CASE.replace("'sls', poisson_ratio = 0.5, glassy_modulus = 1e5, alpha = 50.0, beta = 100.0", gel)
        .replace("velocity = 0.4", "velocity = 1e-3")
    )
    names = "max_indentation,residual_indentation"
    words = ["--set", f"solver.method={method}", "--set", f"contact.law={law}"]
    (largest, left), status = run(vcor, names, *words)
    assert status == "rests"
    assert left == pytest.approx(settled(1e5), rel=1e-12) and largest == left


def test_rest_is_no_doubt(vcor):
    """In a sweep a sphere that rests is not counted among those with a large estimated error."""
    vcor.write(CASE + "&sweep parameter = 'impact.velocity', values = 1e-6, 0.4 /\n")
    done = vcor("run", "case.nml", "--print", "cor,status")
    assert done.code == 0 and done.out.split()[1::2] == ["rests", "separated"]
    assert "estimated error" not in done.err


@pytest.mark.parametrize("law", ["boltzmann", "receding"])
@pytest.mark.parametrize("waves", ["none", "relaxing", "hereditary"])
def test_separates_or_rests(vcor, law, waves):
    """From the fastest to the slowest: there is one velocity below which a sphere rests."""
    vcor.write(
        CASE.replace("waves = 'none'", f"waves = '{waves}', half_thickness = 0.1")
    )
    vcor.write(
        (vcor.folder / "case.nml")
        .read_text()
        .replace("'sls',", "'sls', density = 1000,")
    )
    found = [
        run(
            vcor, "cor", "--set", f"contact.law={law}", "--set", f"impact.velocity={v}"
        )[1]
        for v in (2.0, 0.6, 0.05, 0.01, 1e-4)
    ]
    assert found == sorted(found, reverse=True)
    assert {found[0], found[-1]} == {"separated", "rests"}


def test_just_comes_off(vcor):
    """A force that is gone for a moment only ends the contact, however long the steps are."""
    vcor.write(CASE.replace("velocity = 0.4", "velocity = 0.2669"))
    values, status = run(vcor, "cor", "--set", "solver.accuracy=1e-11")
    assert status == "separated"
    for digits in range(6, 11):
        others, status = run(vcor, "cor", "--set", f"solver.accuracy=1e-{digits}")
        assert status == "separated"
        assert others == pytest.approx(values, abs=10.0**-digits)


def test_comes_off_between_two_steps(vcor):
    """The force vanishes for less than a step of direct, which took the contact for one that lasts."""
    vcor.write(
        "&impact velocity = 0.0640574, gravity = 9.81 /\n&sphere radius = 0.01, material = 'ball' /\n"
        "&plate material = 'plate', waves = 'none' /\n&material name = 'ball', model = 'rigid', density = 7800 /\n"
        "&material name = 'plate', model = 'sls', poisson_ratio = 0.48, glassy_modulus = 15e6, alpha = 300.0, "
        "beta = 1200.0 /\n"
    )
    found = [run(vcor, "cor_sphere", "--set", f"solver.method={method}") for method in METHODS]
    assert [status for _, status in found] == ["separated", "separated"]
    assert found[1][0] == pytest.approx(found[0][0], abs=2e-6)


def test_end_time(vcor):
    """At the end of the computation it rests or it does not, as its energy says."""
    vcor.write(CASE.replace("velocity = 0.4", "velocity = 1e-3"))
    assert run(vcor, "cor", "--set", "solver.end_time=0.3")[1] == "rests"
    done = vcor(
        "run", "case.nml", "--print", "status", "--set", "solver.end_time=0.001"
    )
    assert (done.code, done.out) == (5, "no_separation\n")


def test_elastic_contact_lets_go(vcor):
    """Without losses a sphere comes off, however slow."""
    vcor.write(
        CASE.replace(
            "'sls', poisson_ratio = 0.5, glassy_modulus = 1e5, alpha = 50.0, beta = 100.0",
            "'elastic', poisson_ratio = 0.5, modulus = 1e5",
        )
    )
    for velocity in (1.0, 1e-2):
        values, status = run(
            vcor, "cor,cor_sphere", "--set", f"impact.velocity={velocity}"
        )
        assert status == "separated"
        assert values == pytest.approx([1.0, 1.0], abs=5e-8)


@pytest.mark.parametrize("method", METHODS)
def test_energies(vcor, method):
    """The balance of energies has the work of the weight in it."""
    vcor.write(CASE)
    names = "energy_imbalance,initial_energy,cor_sphere,hysteresis_energy,residual_indentation"
    values, status = run(vcor, names, "--set", f"solver.method={method}")
    imbalance, energy, cor, lost, left = values
    assert status == "separated"
    assert abs(imbalance) < 1e-6 * energy
    assert energy * (1 - cor**2) + MASS * 9.81 * left == pytest.approx(lost, rel=2e-6)


def test_drop_height(vcor):
    """A drop has the gravity that is given, else the standard one, and does not switch it on."""
    vcor.write(CASE.replace("velocity = 0.4, gravity = 9.81", "drop_height = 0.05"))
    standard = run(vcor, "initial_energy,cor")[0]
    moon = run(vcor, "initial_energy,cor", "--set", "impact.gravity=1.62")[0]
    assert standard[0] == pytest.approx(MASS * 9.80665 * 0.05)
    assert moon[0] == pytest.approx(MASS * 1.62 * 0.05)
    vcor.write(
        CASE.replace(
            "velocity = 0.4, gravity = 9.81",
            f"velocity = {math.sqrt(2 * 9.80665 * 0.05)!r}",
        )
    )
    assert run(vcor, "initial_energy,cor")[0] == pytest.approx(standard)


def test_weight_is_not_judged(vcor):
    """weight_ratio is a column, but no objection where a gravity is given, 0 on a pendulum."""
    words = ["run", "case.nml", "--print", "weight_ratio,validity_cause"]
    vcor.write(CASE)
    for gravity in ("9.81", "0"):
        given = vcor(*words, "--set", f"impact.gravity={gravity}")
        assert float(given.out.split()[0]) > 0.01
        assert "weight_ratio" not in given.out + given.err
    vcor.write(CASE.replace(", gravity = 9.81", ""))
    without = vcor(*words)
    assert "weight_ratio" in without.out and "weight_ratio" in without.err
    # also as a point of a sweep
    vcor.write(CASE + "&sweep parameter = 'impact.gravity', values = 0, 9.81 /\n")
    assert "weight_ratio" not in vcor(*words).out


def test_drop_of_a_pendulum(vcor):
    """Its height has the standard gravity, which does not act along the impact."""
    vcor.write(CASE.replace("velocity = 0.4, gravity = 9.81", "drop_height = 0.05"))
    assert run(vcor, "initial_energy,cor,rebound_height")[0] == run(
        vcor, "initial_energy,cor,rebound_height", "--set", "impact.gravity=0"
    )[0]


def test_refused(vcor):
    """Gravity pulls down, and the paper's scheme has none."""
    vcor.write(CASE)
    vcor.refuses(
        "run",
        "case.nml",
        "--set",
        "impact.gravity=-9.81",
        code=INPUT,
        says=["gravity", ">= 0"],
    )
    words = ["--set", "solver.method=direct", "--set", "solver.scheme=adams_bashforth"]
    vcor.refuses("run", "case.nml", *words, code=INPUT, says=["gravity", "product"])
    vcor.write(CASE.replace(", gravity = 9.81", ""))
    words += ["--set", "impact.gravity=9.81"]
    vcor.refuses("run", "case.nml", *words, code=INPUT, says=["gravity", "does not read", "weight"])


def test_sweep(vcor):
    """A resting sphere is a point with a result."""
    vcor.write(CASE + "&sweep parameter = 'impact.velocity', values = 0.01, 0.5 /\n")
    done = vcor("run", "case.nml", "--print", "status,cor")
    assert done.code == 0
    assert [line.split()[-2] for line in done.out.splitlines()] == [
        "rests",
        "separated",
    ]
    assert "no result" not in done.err


def test_more_than_any_weight(vcor):
    """A panel that ends without any indentation is not a solution, and nothing is divided by it."""
    path = PAPER / "butyl_power_law_50_frozen.nml"
    words = ["plate.waves=relaxing", "contact.law=receding", "solver.method=ive", "impact.gravity=1e60"]
    done = vcor("run", path, "--print", "cor", *(word for setting in words for word in ("--set", setting)))
    assert done.code == NUMERICAL and "the plate is too light" in done.err
