"""Exact mechanics from outside: receding contact, hereditary plate, bodies in series."""

import re

import pytest
from cases import SLS, edit
from program import INPUT, NUMERICAL, PAPER, ROOT

EXACT = ["--set", "contact.law=receding", "--set", "plate.waves=hereditary"]

# Two bodies of different materials, neither of them rigid
PAIR = """\
&impact velocity = 10.0 /
&sphere radius = 0.01, material = 'ball' /
&plate half_thickness = 0.02, material = 'rubber', waves = 'hereditary' /
&contact law = 'receding', pair = 'series' /
&material name = 'ball', model = 'MODEL', density = 1200.0, poisson_ratio = 0.45, KEYS /
&material
   name = 'rubber', model = 'sls', density = 1100.0, poisson_ratio = 0.5
   glassy_modulus = 15.0e6, alpha = 300.0, beta = 1200.0
/
"""
BALLS = {
    "sls": "glassy_modulus = 30.0e6, alpha = 500.0, beta = 900.0",
    "elastic": "modulus = 30.0e6",
    "prony": "equilibrium_modulus = 5.0e6, viscosity = 500.0",
    "cerf": "equilibrium_modulus = 10.0e6, relaxing_modulus = 60.0e6, beta = 50.0",
    "power_law": "equilibrium_modulus = 5.0e6, coefficient = 5.0e5, exponent = 0.5",
    "mittag_leffler": "equilibrium_modulus = 5.0e6, relaxing_modulus = 40.0e6, "
    "exponent = 0.9, time = 1.0e-3",
}


def models(out):
    """The table of models: cells by plate and law."""
    rows = re.findall(r"^[* ] (\w+) +(boltzmann|receding) +(.*)$", out, re.MULTILINE)
    return {(waves, law): cells.split() for waves, law, cells in rows}


def test_exact_models_of_the_paper(vcor):
    out = vcor.succeeds("verify", PAPER / "sls.nml", *EXACT)
    assert "verified: " in out and "TOO LOW" not in out
    found = models(out)
    assert len(found) == 12
    assert float(found["body", "receding"][1]) == pytest.approx(0.380905, abs=2e-5)
    assert float(found["half_space", "receding"][1]) > 0.47
    # to all digits that are printed, which are those that the stated error leaves
    cor = found["hereditary", "receding"][0]
    assert len(cor) >= len("0.4875824") and round(0.48758244, len(cor) - 2) == float(cor)
    assert float(found["relaxing", "boltzmann"][0]) == pytest.approx(0.43198690, abs=2e-8)
    assert float(found["none", "receding"][2]) == pytest.approx(1.3913613e-3, rel=1e-7)
    assert [line for line in out.splitlines() if line.startswith("* hereditary  receding")]


def test_table_of_the_page(vcor):
    blocks = (ROOT / "docs" / "impact.md").read_text(encoding="utf-8").split("```")[1::2]
    block = next(block for block in blocks if "effect of the choice of model" in block)
    lines = [line for line in block.splitlines() if line and line != "..."]
    out = vcor.succeeds("verify", PAPER / "sls.nml").splitlines()
    assert [line for line in lines if line not in out] == []


def test_table_without_a_plate(vcor):
    """A half_space has one plate model only."""
    text = "\n".join(
        line for line in SLS.splitlines() if "half_thickness" not in line
    )
    text, _ = edit(text + "\n", "plate", "waves", "'none'")
    vcor.write(text)
    assert set(models(vcor.succeeds("verify", "case.nml"))) == {
        ("none", "boltzmann"),
        ("none", "receding"),
        ("body", "receding"),
    }


@pytest.mark.parametrize("model", BALLS)
def test_series(vcor, model):
    """Both methods agree on two bodies in series, whatever the sphere is made of."""
    vcor.write(PAIR.replace("MODEL", model).replace("KEYS", BALLS[model]))
    out = vcor.succeeds("verify", "case.nml")
    assert int(re.search(r"verified: (\d+) digits", out)[1]) >= 7


REFUSED = [
    ("contact.law=receding", "solver.volterra_order=2", "second term"),
    ("contact.law=receding", "solver.scheme=adams_bashforth", "all the past"),
    ("contact.law=receding", "solver.continue_after_separation=.true.", "no meaning"),
    ("plate.waves=hereditary", "solver.scheme=adams_bashforth", "differentiates"),
]


@pytest.mark.parametrize("first, second, reason", REFUSED)
def test_refused(vcor, first, second, reason):
    vcor.write(SLS)
    sets = ["--set", first, "--set", second]
    for command in ("run", "check", "verify"):
        vcor.refuses(command, "case.nml", *sets, code=INPUT, says=[first.split("=")[1], reason])


def test_unknown_words(vcor):
    text, line = edit(f"&contact\n/\n{SLS}", "contact", "law", "'recedeing'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="receding")


@pytest.mark.parametrize("exponent", [0.95, 0.98, 0.995])
def test_hereditary_plate_next_to_a_maxwell_element(vcor, exponent):
    """The spectrum of its memory has features as narrow as 1 - exponent, and is resolved."""
    vcor.write(f"""
        &impact velocity = 5 /
        &sphere radius = 0.01, material = 'steel' /
        &plate material = 'rubber', half_thickness = 0.02, waves = 'hereditary' /
        &material name = 'steel', model = 'rigid', density = 7800 /
        &material
           name = 'rubber', model = 'mittag_leffler', density = 1100, poisson_ratio = 0.45
           equilibrium_modulus = 1e6, relaxing_modulus = 2e7, exponent = {exponent}, time = 1e-5
        /
    """)
    ive = vcor.numbers("case.nml")
    direct = vcor.numbers("case.nml", "--set", "solver.method=direct")
    assert float(ive["cor_error"]) <= 1e-8
    difference = abs(float(ive["cor"]) - float(direct["cor"]))
    assert difference <= 3 * (float(ive["cor_error"]) + float(direct["cor_error"]))


THICKNESSES = [["plate.half_thickness=0.02"], ["plate.thickness=0.04"]]
KINDS = {
    "free": ["plate.waves=none"],
    "bonded": ["plate.base=bonded", "plate.waves=none"],
    "thin": ["plate.waves=hereditary"],
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("command", ["run", "verify", "sweep"])
def test_equal_thicknesses_have_equal_exact_mechanics(vcor, kind, command):
    """What the screen says of exact mechanics does not depend on the key of the thickness."""
    screens = []
    for settings in THICKNESSES:
        words = [word for setting in KINDS[kind] + settings for word in ("--set", setting)]
        text = SLS if command != "sweep" else SLS + "&sweep parameter = 'impact.velocity', values = 2, 5 /\n"
        vcor.write(text)
        out = vcor.succeeds("verify" if command == "verify" else "run", "case.nml", *words)
        screens.append([line for line in out.splitlines() if "written" not in line])
    assert screens[0] == screens[1]
    assert any("exact" in line or "half_space" in line for line in screens[0])


def test_swept_thicknesses_have_equal_exact_mechanics(vcor):
    screens = []
    for key, values in (("half_thickness", "0.01, 0.02"), ("thickness", "0.02, 0.04")):
        vcor.write(f"{SLS}&sweep parameter = 'plate.{key}', values = {values} /\n")
        out = vcor.succeeds("run", "case.nml", "--set", "plate.waves=none")
        screens.append(re.findall(r"exact (\S+)", out))
    assert len(screens[0]) >= 2 and screens[0] == screens[1]


BEADS = """
    &impact velocity = 1 /
    &sphere radius = 2.995e-3, mass = 7.4215e-5, material = 'acetate' /
    &plate material = 'acetate', surface_radius = {radius} WAVES /
    &contact mechanics = 'exact' /
    &material name = 'acetate', model = 'prony', density = 1319, poisson_ratio = 0.28,
       equilibrium_modulus = 3.2e9, viscosity = 3870 /
"""


def test_two_spheres_are_no_half_space(vcor):
    """Exact mechanics leaves waves = 'none' with a second sphere, says so, and verify has no waves."""
    text = BEADS.format(radius="2.995e-3")
    vcor.write(text.replace("WAVES", ""))
    done = vcor("run", "case.nml", "--print", "cor_sphere")
    assert "two spheres are no half space" in done.err
    vcor.write(text.replace("WAVES", ", waves = 'none'"), "none.nml")
    none = vcor("run", "none.nml", "--print", "cor_sphere")
    assert (none.out, "half space" in none.err) == (done.out, False)
    assert "waves = 'none'" in vcor("check", "case.nml").out
    for name in ("case.nml", "none.nml"):
        assert {row[0] for row in models(vcor("verify", name).out)} == {"none"}
    # the paper's mechanics: no solution of a half space beside that of two spheres
    out = vcor.succeeds("run", "none.nml", "--set", "contact.mechanics=paper")
    assert "waves body" not in out


def test_exact_mechanics_of_a_seat(vcor):
    """A concave surface is that of a wide body, whose waves are solved; so is a radius set to 0."""
    vcor.write(BEADS.format(radius="-2e-2").replace("WAVES", ""))
    assert "waves = 'body'" in vcor.succeeds("check", "case.nml")
    vcor.write(BEADS.format(radius="2e-2").replace("WAVES", ""))
    checked = vcor.succeeds("check", "case.nml", "--set", "plate.surface_radius=0")
    assert "waves = 'body'" in checked


def test_sweep_from_a_seat_to_a_second_sphere(vcor):
    text = BEADS.format(radius="-2e-2")
    sweep = "&sweep parameter = 'plate.surface_radius', values = -2e-2, 2e-2 /\n"
    vcor.write(text.replace("WAVES", "") + sweep)
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL and "surface_radius" in done.err and "one sign" in done.err
    vcor.write(text.replace("WAVES", ", waves = 'none'") + sweep)
    assert vcor("run", "case.nml").code == 0
