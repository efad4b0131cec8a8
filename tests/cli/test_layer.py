"""Layers on a rigid base and the true sphere, from outside.

The impacts of tests/reference/layers.json are from tests/reference/make_layers.py, which shares
nothing with vcor but the equations.
"""

import json
import math
import re

import pytest
from program import INPUT, NUMERICAL, ROOT

IMPACTS = json.loads(
    (ROOT / "tests" / "reference" / "layers.json").read_text(encoding="utf-8")
)
# Accuracy of the restitution, and that of other columns relative to their scale
CLOSE, NEAR = 1.0e-8, 1.0e-6
# A pendulum with the force of ISO 4662 on its test piece
PAD = """\
&impact velocity = 1.4 /
&sphere radius = 0.00625, mass = 0.35, material = 'steel' /
&plate thickness = 0.0125, base = 'bonded', material = 'rubber' /
&contact law = 'receding' /
&material name = 'steel', model = 'rigid' /
&material
   name = 'rubber', model = 'prony', poisson_ratio = 0.5, density = 1100.0
   equilibrium_modulus = 2.0e6
   moduli = 3.0e5, 3.0e5, 4.0e5, 6.0e5, rates = 30.0, 300.0, 3000.0, 30000.0
/
"""


def case_text(case, method, more=""):
    """Case file of an impact of the list."""
    sphere = ["radius", "mass", "half_angle", "profile_power", "profile_coefficient"]
    groups = {
        "impact": {k: case[k] for k in ("velocity", "gravity") if k in case},
        "sphere": {"shape": case["shape"], "material": "hard"}
        | {
            k: case[k]
            for k in sphere
            if k in case and (k != "radius" or "sphere" in case["shape"])
        },
        "plate": {"material": "soft", "waves": "none"},
        "contact": {"law": case["law"]},
        "solver": {"method": method},
    }
    if "thickness" in case:
        groups["plate"] |= {"base": case["base"], "thickness": case["thickness"]}
    text = "&material name = 'hard', model = 'rigid' /\n&material name = 'soft', model = 'prony'"
    for key in ("equilibrium_modulus", "poisson_ratio"):
        text += f", {key} = {case[key]!r}"
    for key in ("moduli", "rates"):
        text += f"\n   {key} = {', '.join(map(repr, case[key]))}"
    text += " /\n"
    for group, keys in groups.items():
        entries = (f"{k} = {v!r}" for k, v in keys.items())
        text += f"&{group} {', '.join(entries)} {more if group == 'solver' else ''}/\n"
    return text


@pytest.mark.parametrize(
    "row", IMPACTS, ids=lambda row: "{shape}-{base}-{law}".format(**row["case"])
)
def test_reference(vcor, row):
    """Thin and thick, sharp and blunt, with and without gravity: 1e-8 by ive, 1e-6 by direct."""
    methods = ["ive"]
    # direct takes a second for many of them
    if IMPACTS.index(row) % 3 == 0:
        methods.append("direct")
    for method in methods:
        vcor.write(
            case_text(
                row["case"], method, "accuracy = 1e-6" if method == "direct" else ""
            )
        )
        found = vcor.numbers("case.nml")
        bound = CLOSE if method == "ive" else NEAR
        assert float(found["cor"]) == pytest.approx(row["expect"]["cor"], abs=bound)
        for name in ("contact_time", "max_indentation", "max_force", "contact_radius"):
            assert float(found[name]) == pytest.approx(row["expect"][name], rel=NEAR), (
                name
            )
        assert float(found["residual_indentation"]) == pytest.approx(
            row["expect"]["residual_indentation"],
            abs=NEAR * row["expect"]["max_indentation"],
        )
        if "thickness" in row["case"]:
            ratio = row["expect"]["contact_radius"] / row["case"]["thickness"]
            assert float(found["layer_ratio"]) == pytest.approx(ratio, rel=NEAR)
            assert float(found["layer_stiffening"]) > 1.0


def test_pad(vcor):
    """The test piece of a standard: the values are those of another solver."""
    vcor.write(PAD)
    found = {
        k: float(v)
        for k, v in vcor.numbers("case.nml").items()
        if "valid" not in k and k not in {"status", "bounces_end"}
    }
    assert found["cor"] == pytest.approx(0.89723446486, abs=CLOSE)
    assert found["contact_time"] == pytest.approx(0.009326942625, rel=NEAR)
    assert found["max_force"] == pytest.approx(199.86223247, rel=NEAR)
    assert found["residual_indentation"] == pytest.approx(0.00044261088208, rel=NEAR)
    assert found["layer_ratio"] == pytest.approx(0.006416918627 / 0.0125, rel=NEAR)
    assert found["layer_stiffening"] == pytest.approx(1.889, abs=0.001)
    assert found["layer_strain"] == pytest.approx(found["max_indentation"] / 0.0125, rel=1e-12)
    # a layer on a floor does not bend
    for name in ("plate_wave_number", "deflection_ratio"):
        assert math.isnan(found[name]), name


def test_elastic(vcor):
    """No relaxation, no loss; a contact time that the stiffness alone decides."""
    vcor.write(
        PAD.replace("prony", "elastic")
        .replace("equilibrium_modulus", "modulus")
        .replace(
            "   moduli = 3.0e5, 3.0e5, 4.0e5, 6.0e5, rates = 30.0, 300.0, 3000.0, 30000.0\n",
            "",
        )
    )
    for law in ("receding", "boltzmann"):
        found = vcor.numbers("case.nml", "--set", f"contact.law={law}")
        assert float(found["cor"]) == pytest.approx(1.0, abs=CLOSE)
        assert float(found["contact_time"]) == pytest.approx(0.010175643297, rel=NEAR)


@pytest.mark.parametrize("waves", ["none", "body"])
def test_strain_is_judged(vcor, waves):
    """Deep in the layer strains are not small, whatever the mechanics."""
    vcor.write(PAD)
    for velocity, thickness, level in (
        (0.05, 0.0125, "good"),
        (1.0, 0.0125, "caution"),
        (0.9, 0.005, "outside"),
    ):
        words = ("--set", f"plate.waves={waves}", "--set", "sphere.shape=true_sphere")
        words += ("--set", f"impact.velocity={velocity}", "--set", f"plate.thickness={thickness}")
        found = vcor.numbers("case.nml", *words)
        strain = float(found["layer_strain"])
        assert level == ("good" if strain < 0.1 else "caution" if strain < 0.3 else "outside")
        if level == "good":
            assert found["validity_cause"] != "layer_strain"
        else:
            assert (found["validity"], found["validity_cause"]) == (level, "layer_strain")


def test_thick_layer(vcor):
    """A very thick layer is a half space; half of the thickness says the same as all of it."""
    vcor.write(PAD)
    half_space = vcor.numbers(
        "case.nml", "--set", "plate.base=free", "--set", "plate.waves=none"
    )
    thick = vcor.numbers("case.nml", "--set", "plate.thickness=1e6")
    assert math.isnan(float(half_space["layer_ratio"]))
    assert float(thick["cor"]) == pytest.approx(float(half_space["cor"]), abs=1e-9)
    assert float(thick["layer_stiffening"]) == pytest.approx(1.0, abs=1e-7)
    vcor.write(
        PAD.replace("thickness = 0.0125", "half_thickness = 0.00625"), "half.nml"
    )
    assert vcor.numbers("half.nml") == vcor.numbers("case.nml")


def test_sweep_is_the_single_impact(vcor):
    """A table of the law is kept from point to point, and changes no bit."""
    vcor.write(
        PAD + "&sweep parameter = 'plate.thickness', values = 0.003, 0.0125, 0.03 /\n"
        "&sweep parameter = 'rubber.poisson_ratio', values = 0.4, 0.5 /\n"
    )
    for threads in (1, 2):
        out = vcor.succeeds(
            "run", "case.nml", "--print", "cor,max_force", "--threads", threads
        )
        rows = [line.split() for line in out.splitlines()]
        assert len(rows) == 6
        vcor.write(PAD, "one.nml")
        alone = vcor.succeeds(
            "run", "one.nml", "--print", "cor,max_force", "--quiet"
        ).split()
        assert alone in rows
    assert len({row[0] for row in rows}) == 6


def test_exact_mechanics_of_a_layer(vcor):
    """Without waves by default; mechanics = 'exact' has them."""
    vcor.write(PAD)
    assert "waves = 'none'" in vcor.succeeds("check", "case.nml")
    vcor.write(PAD.replace("law =", "mechanics = 'exact', law ="))
    assert "waves = 'body'" in vcor("check", "case.nml").out


def test_true_sphere(vcor):
    """A small contact is that of the paraboloid, a large one is softer, and mass is by the radius."""
    free = PAD.replace("thickness = 0.0125, base = 'bonded'", "waves = 'none'")
    vcor.write(free)
    vcor.write(
        free.replace("&sphere radius", "&sphere shape = 'true_sphere', radius"),
        "true.nml",
    )
    small = ["--set", "impact.velocity=1e-4"]
    one, other = vcor.numbers("case.nml", *small), vcor.numbers("true.nml", *small)
    assert float(other["cor"]) == pytest.approx(float(one["cor"]), abs=1e-4)
    one, other = vcor.numbers("case.nml"), vcor.numbers("true.nml")
    assert float(other["max_indentation"]) > 1.01 * float(one["max_indentation"])
    assert float(other["contact_radius"]) < float(one["contact_radius"])
    assert "contact_ratio" in vcor("run", "case.nml").out
    assert "contact_ratio" not in vcor("run", "true.nml").out


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("thickness = 0.0125, ", "", ["a layer on a base needs its thickness", "base"]),
        (
            "thickness = 0.0125",
            "thickness = 0.0125, half_thickness = 1e-2",
            ["found both"],
        ),
        ("thickness = 0.0125", "thickness = 0.0125, surface_radius = 1.0", ["flat"]),
        (
            "base = 'bonded'",
            "base = 'bonded', waves = 'relaxing'",
            ["waves", "'none' or 'body'"],
        ),
        ("base = 'bonded'", "base = 'glued'", ["one of free, bonded, sliding"]),
        (
            "model = 'rigid'",
            "model = 'elastic', modulus = 1e7, poisson_ratio = 0.3",
            ["model = 'rigid' of the ball", "waves = 'body'"],
        ),
        (
            "&contact law = 'receding' /",
            "&solver method = 'direct', scheme = 'adams_bashforth' /",
            ["adams_bashforth", "base"],
        ),
        ("radius = 0.00625,", "shape = 'true_sphere', radius = 0.00625,\n", None),
    ],
)
def test_refusals(vcor, old, new, says):
    text = PAD.replace(old, new)
    if says is None:
        text = text.replace(
            "thickness = 0.0125, base = 'bonded'",
            "surface_radius = 1.0, waves = 'none'",
        )
        says = ["curved", "shape"]
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=says)


def test_too_thin(vcor):
    """Beyond the table of the law the numbers are not printed."""
    vcor.write(PAD)
    done = vcor("run", "case.nml", "--set", "plate.thickness=1e-5", "--print", "cor")
    assert done.code == NUMERICAL and done.out == "nan\n"
    assert "20 times the thickness" in done.err
    found, limit = re.search(r"found an indentation of (\S+) m, expected at most (\S+) m", done.err).groups()
    assert float(found) > float(limit) > 0


def test_a_sphere_that_sinks_into_its_plate(vcor):
    """Springs beyond its radius have no profile of a sphere."""
    vcor.write("""&impact velocity = 0.003, gravity = 9.81 /
&sphere shape = 'true_sphere', radius = 0.19, mass = 480, material = 'ball' /
&plate material = 'plate', thickness = 1.9, base = 'bonded', waves = 'body' /
&material name = 'ball', model = 'rigid' /
&material name = 'plate', model = 'elastic', modulus = 5e3, density = 15, poisson_ratio = 0.2 /
""")
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code == NUMERICAL and "0.85 times the radius of a true sphere" in done.err


def test_spheres_of_the_layer(vcor):
    """Two bodies of one material, or two elastic ones, share the indentation; a rigid plate has no layer."""
    ball = PAD.replace("material = 'steel'", "material = 'rubber'")
    vcor.write(ball)
    found = vcor.numbers("case.nml")
    assert 1.0 < float(found["layer_stiffening"]) < 1.889
    rigid = PAD.replace("material = 'steel'", "material = 'rubber'").replace(
        "base = 'bonded', material = 'rubber'", "base = 'bonded', material = 'steel'"
    )
    vcor.write(rigid)
    assert math.isnan(float(vcor.numbers("case.nml")["layer_ratio"]))


def test_punch(vcor):
    """A flat punch is a spring: half a period of it, and stiffer on a layer."""
    text = PAD.replace(
        "radius = 0.00625", "shape = 'punch', punch_radius = 0.00625"
    ).replace("&contact law = 'receding' /\n", "")
    vcor.write(text)
    found = vcor.numbers("case.nml")
    assert float(found["contact_radius"]) == pytest.approx(0.00625, rel=1e-12)
    assert float(found["layer_ratio"]) == pytest.approx(0.5, rel=1e-12)
    # S/a of a bonded incompressible layer at a/H = 0.5
    assert float(found["layer_stiffening"]) == pytest.approx(
        0.9664671854237 / 0.5, rel=1e-9
    )
