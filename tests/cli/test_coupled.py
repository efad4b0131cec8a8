"""The coupled contact from outside: without waves it is Ting's receding contact, and what it says.

Springs and a convolution share nothing with the internal variables but materials and the law of
the static contact, so that each case tests the response of a base and its profile.
"""

import math

import pytest
from program import INPUT, NUMERICAL

PRONY = (
    "model = 'prony', equilibrium_modulus = 2e6, moduli = 1e6, 1e6, 3e6, "
    "rates = 100.0, 3000.0, 40000.0"
)
WARM = ", reference_temperature = 293.0"
MATERIALS = {
    "elastic": "model = 'elastic', modulus = 5e6",
    "sls": "model = 'sls', glassy_modulus = 1e7, alpha = 500.0, beta = 2000.0",
    "prony": PRONY,
    "shear": PRONY + ", modulus_kind = 'shear'",
    "kelvin_voigt": "model = 'prony', equilibrium_modulus = 5e6, viscosity = 300.0",
    "power_law": "model = 'power_law', equilibrium_modulus = 3e6, coefficient = 3e5, "
    "exponent = 0.25",
    "cerf": "model = 'cerf', equilibrium_modulus = 2e6, relaxing_modulus = 8e6, beta = 30.0",
    "mittag_leffler": "model = 'mittag_leffler', equilibrium_modulus = 2e6, "
    "relaxing_modulus = 8e6, exponent = 0.6, time = 1e-3",
    "wlf": PRONY + WARM + ", shift = 'wlf', wlf_c1 = 8.86, wlf_c2 = 101.6",
    "arrhenius": PRONY + WARM + ", shift = 'arrhenius', activation_energy = 1e5",
    "table": "model = 'table', file = 'measured.csv'",
}
SHAPES = {
    "sphere": "radius = 0.01",
    "true_sphere": "radius = 0.01, shape = 'true_sphere'",
    "cone": "shape = 'cone', half_angle = 60.0",
    "power": "shape = 'power', profile_power = 4.0, profile_coefficient = 1e5",
    "blunt": "shape = 'power', profile_power = 1.3, profile_coefficient = 3.0",
    "punch": "shape = 'punch', punch_radius = 0.004",
}
BASES = {
    "half_space": "",
    "bonded": "base = 'bonded', thickness = 0.01",
    "sliding": "base = 'sliding', thickness = 0.01",
    "concave": "surface_radius = -0.02",
}
# material, shape, base, Poisson's ratio
CASES = [
    ("elastic", "sphere", "half_space", 0.5),
    ("sls", "sphere", "half_space", 0.3),
    ("prony", "sphere", "bonded", 0.5),
    ("shear", "sphere", "sliding", 0.4),
    ("kelvin_voigt", "cone", "half_space", 0.45),
    ("power_law", "true_sphere", "bonded", 0.3),
    ("cerf", "power", "sliding", 0.5),
    ("mittag_leffler", "blunt", "bonded", 0.48),
    ("wlf", "sphere", "concave", 0.5),
    ("arrhenius", "true_sphere", "half_space", 0.5),
    ("table", "power", "half_space", 0.49),
    ("power_law", "punch", "bonded", 0.5),
    ("prony", "punch", "half_space", 0.5),
]


def text(material, shape, base, poisson_ratio, waves="none", keys=""):
    """Case file of a rigid body of 10 g on a soft plate."""
    law = "" if shape == "punch" else "law = 'receding'"
    temperature = ", temperature = 285.0" if "reference" in MATERIALS[material] else ""
    return f"""\
&impact velocity = 2.0{temperature} /
&sphere {SHAPES[shape]}, mass = 0.01, material = 'hard' /
&plate material = 'soft', waves = '{waves}'
   {BASES[base]} /
&contact {law} /
&solver {keys} /
&material name = 'hard', model = 'rigid' /
&material name = 'soft', density = 1100.0, poisson_ratio = {poisson_ratio}
   {MATERIALS[material]} /
"""


@pytest.fixture
def measured(vcor):
    """A table of moduli next to the case."""
    times = [10 ** (-7 + 0.05 * i) for i in range(160)]
    rows = (f"{t:.9e},{2e6 + 3e6 / (1 + math.sqrt(t / 1e-3)):.9e}" for t in times)
    vcor.write(
        "\n".join(["time [s],relaxation_modulus [Pa]", *rows]) + "\n", "measured.csv"
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: "-".join(case[:3]))
def test_without_waves(vcor, measured, case):
    """Within 1e-5 and three times the stated error of Ting's rule, on all bases."""
    vcor.write(text(*case))
    ting = vcor.numbers("case.nml", "--set", "solver.method=ive")
    found = vcor.numbers("case.nml", "--set", "solver.method=coupled")
    stated = float(found["cor_sphere_error"])
    assert 0.0 < stated <= 1e-5
    error = abs(float(found["cor_sphere"]) - float(ting["cor_sphere"]))
    assert error <= min(1e-5, 3 * stated)
    for name, bound in (
        ("contact_time", 2e-3),
        ("max_force", 1e-3),
        ("max_indentation", 1e-4),
    ):
        assert float(found[name]) == pytest.approx(float(ting[name]), rel=bound), name
    assert float(found["residual_indentation"]) == pytest.approx(
        float(ting["residual_indentation"]), abs=2e-3 * float(ting["max_indentation"])
    )


def test_two_viscoelastic_bodies(vcor):
    """Their compliances are in series; on a layer no fixed share has them, but waves = 'body' does."""
    ball = MATERIALS["sls"] + ", density = 1000.0, poisson_ratio = 0.5"
    soft = text("prony", "sphere", "half_space", 0.5).replace("model = 'rigid'", ball)
    vcor.write(soft.replace("law =", "pair = 'series', law ="))
    ting = vcor.numbers("case.nml")
    found = vcor.numbers("case.nml", "--set", "solver.method=coupled")
    assert float(found["cor"]) == pytest.approx(float(ting["cor"]), abs=1e-5)
    layer = text("prony", "sphere", "bonded", 0.5, "body").replace(
        "model = 'rigid'", ball
    )
    vcor.write(layer)
    cor = float(vcor.numbers("case.nml")["cor"])
    vcor.write(text("prony", "sphere", "bonded", 0.5, "body"))
    assert cor < float(vcor.numbers("case.nml")["cor"]) - 0.1


@pytest.mark.parametrize(
    "key, says",
    [
        ("contact.law=boltzmann", ["law", "'receding'"]),
        ("solver.method=ive", ["method", "'coupled'"]),
        ("solver.method=direct", ["method", "'coupled'"]),
        ("solver.continue_after_separation=true", ["continue_after_separation"]),
        ("solver.time_step=1e-6", ["time_step"]),
        ("solver.form=b", ["form"]),
        ("solver.quadrature=rectangle", ["quadrature"]),
        ("solver.volterra_order=2", ["volterra_order"]),
        ("solver.scheme=adams_bashforth", ["scheme"]),
    ],
)
def test_refusals(vcor, key, says):
    """What the coupled contact cannot do is refused by name."""
    vcor.write(
        text("sls", "sphere", "half_space", 0.5, "body").replace("law = 'receding'", "")
    )
    line = vcor.refuses("run", "case.nml", "--set", key, code=INPUT, says=says)
    if len(says) == 1:
        # its default is not read either, which --set would refuse
        assert line.endswith(", expected no such key")


def test_completed_text(vcor):
    """It prints the law and the pair that waves = 'body' sets."""
    vcor.write(
        text("sls", "sphere", "half_space", 0.5, "body").replace("law = 'receding'", "")
    )
    complete = vcor.succeeds("check", "case.nml")
    assert "law = 'receding'" in complete and "pair = 'series'" in complete


def test_an_early_end(vcor):
    """The time of the message is that of the case; steps are another method's."""
    vcor.write(text("sls", "sphere", "half_space", 0.5, "body", "end_time = 1e-5"))
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert "do not separate within 1.0E-05 s" in done.err
    assert "time_step" not in done.err


def test_an_end_time_that_is_out_of_reach(vcor):
    """Nothing is gained by a later one, and nothing says so."""
    fluid = "model = 'prony', equilibrium_modulus = 1e-3, moduli = 1e6, times = 1e-3"
    case = text("sls", "sphere", "bonded", 0.45, "body", "end_time = 1e4")
    case = case.replace("base = 'bonded', ", "").replace(MATERIALS["sls"], fluid)
    vcor.write(case)
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert "too many steps to reach solver.end_time" in done.err


def test_verify_compares_two_meshes(vcor):
    """More digits than two meshes have in common are not claimed."""
    vcor.write(text("sls", "sphere", "half_space", 0.5, "body", "accuracy = 1e-4"))
    lines = vcor.succeeds("verify", "case.nml").splitlines()
    steps = [line.split()[2] for line in lines if line.split()[:1] == ["coupled"]]
    assert len(set(steps)) == 2
    digits = [line.split()[-1] for line in lines if "max_indentation " in line]
    assert len(digits) == 1 and 3 <= int(digits[0]) <= 8


def test_a_force_without_a_largest_value(vcor):
    """A blunt profile meets an infinite force on an incompressible plate: the screen says so."""
    blunt = text("prony", "power", "sliding", 0.5, "body", "accuracy = 1e-4")
    vcor.write(blunt)
    (force,) = (
        x for x in vcor.succeeds("run", "case.nml").splitlines() if "F_max" in x
    )
    assert "+-" in force
    sharp = blunt.replace("accuracy = 1e-4", "accuracy = 1e-5")
    vcor.write(sharp.replace("poisson_ratio = 0.5", "poisson_ratio = 0.3"))
    (force,) = (
        x for x in vcor.succeeds("run", "case.nml").splitlines() if "F_max" in x
    )
    assert "+-" not in force
    vcor.write(
        text("prony", "punch", "half_space", 0.5, "body").replace("&contact  /", "")
    )
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code == NUMERICAL and done.out == "nan\n"


@pytest.mark.parametrize("density", ["1e6", "1e20"])
def test_waves_slower_than_the_edge(vcor, density):
    """Where the edge outruns the waves all the time, the march ends with an error, and soon."""
    vcor.write(text("sls", "sphere", "half_space", 0.5, "body").replace("1100.0", density))
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code == NUMERICAL and done.out == "nan\n"
    assert "exceeds solver.accuracy" in done.err
