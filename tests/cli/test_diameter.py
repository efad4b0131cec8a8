"""The size of the sphere by its diameter, and which mass two spheres have."""

import math

import pytest
from cases import SLS, edit
from program import ALL, INPUT

DIAMETER = SLS.replace("radius = 0.01", "diameter = 0.02")
BEADS = SLS.replace("half_thickness = 0.02", "surface_radius = 0.03, waves = 'none'")


def printed(vcor, text, *words):
    vcor.write(text)
    return vcor("run", "case.nml", "--print", ALL, "--quiet", *words).out


def test_half_the_diameter_is_the_radius(vcor):
    assert printed(vcor, DIAMETER) == printed(vcor, SLS)
    assert "   diameter = 0.02 " in vcor.succeeds("check", "case.nml", "--set", "sphere.diameter=0.02")


@pytest.mark.parametrize("text", [SLS, DIAMETER])
def test_what_is_set_replaces_the_other(vcor, text):
    """By --set and by a sweep, whichever the file has."""
    expected = printed(vcor, SLS.replace("radius = 0.01", "radius = 0.015"))
    assert printed(vcor, text, "--set", "sphere.radius=0.015") == expected
    assert printed(vcor, text, "--set", "sphere.diameter=0.03") == expected
    for key, value in (("radius", 0.015), ("diameter", 0.03)):
        sweep = f"&sweep parameter = 'sphere.{key}', values = {value} /\n"
        assert printed(vcor, text + sweep) == expected


def test_refused(vcor):
    vcor.write(SLS.replace("radius = 0.01", "radius = 0.01, diameter = 0.02"))
    vcor.refuses("run", "case.nml", code=INPUT, says="found both radius and diameter, expected one of them")
    vcor.write(SLS.replace("   radius = 0.01\n", ""))
    vcor.refuses("run", "case.nml", code=INPUT, says=["key 'radius' is missing", "or diameter"])
    vcor.write(DIAMETER.replace("half_thickness", "surface_radius = -0.005, half_thickness"))
    vcor.refuses("run", "case.nml", code=INPUT, says="found surface_radius = -0.005 and diameter = 0.02")
    text, line = edit(DIAMETER, "sphere", "diameter", "-0.02")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="diameter: found -0.02")
    vcor.write(DIAMETER.replace("0.02\n   material = 'steel'", "20.0\n   material = 'steel'"))
    assert "sphere.diameter = 20.0 m is more than 2.0: is it in mm?" in vcor("check", "case.nml").err


def test_which_mass_two_spheres_have(vcor):
    """Without mass it is that of the first one, which is said; a given or swept mass needs no note."""
    vcor.write(BEADS)
    err = vcor("run", "case.nml").err
    assert "note: case.nml:12: the second body is a sphere, and mass is not given: the mass is that of " \
        "&sphere alone, 3.3E-02 kg" in err
    assert "mass is not given" in vcor("check", "case.nml").err
    assert "mass is not given" not in vcor("run", "case.nml", "--set", "sphere.mass=0.02").err
    vcor.write(BEADS + "&sweep parameter = 'sphere.mass', values = 0.02, 0.03 /\n")
    assert "mass is not given" not in vcor("run", "case.nml").err
    vcor.write(BEADS.replace("surface_radius = 0.03", "surface_radius = -0.03"))
    assert "mass is not given" not in vcor("run", "case.nml").err


@pytest.mark.parametrize("temperature", ["", ", temperature = 310.0"])
@pytest.mark.parametrize("base", ["free", "bonded"])
def test_times_are_rates(vcor, base, temperature):
    """Two bodies of one rubber are that, whichever key each of them has, and whatever rounds."""
    times = (5e-4, 2.9e-5, 7e-6)
    series = [f"times = {str(times)[1:-1]}", f"rates = {str([1 / time for time in times])[1:-1]}"]
    rubber = """&material name = '{}', model = 'prony', density = 1000, poisson_ratio = 0.5,
   equilibrium_modulus = 4e6, moduli = 1e7, 2e7, 1e7, {}"""
    if temperature:
        rubber += ", shift = 'arrhenius', reference_temperature = 293.15, activation_energy = 5e4"
    rubber += " /\n"
    found = set()
    for one in series:
        for other in series:
            text = f"&impact velocity = 2{temperature} /\n&sphere radius = 0.01, material = 'ball' /\n"
            text += f"&plate thickness = 0.02, base = '{base}', waves = 'none', material = 'pad' /\n"
            vcor.write(text + rubber.format("ball", one) + rubber.format("pad", other))
            found.add(vcor.succeeds("run", "case.nml", "--print", "cor,contact_time,max_force,steps"))
    assert len(found) == 1
    next_to = math.nextafter(1 / times[1], math.inf)
    rounded = series[1].replace(repr(1 / times[1]), repr(next_to))
    vcor.write(text + rubber.format("ball", series[0]) + rubber.format("pad", rounded))
    vcor.succeeds("check", "case.nml")
