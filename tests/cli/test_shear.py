"""Shear moduli: E = 2 (1 + nu) G, once and in every place that has moduli."""

import pytest
from program import INPUT
from test_temperature import MODELS, ROUNDING, case, material, same, shifted, write_points

NU = 0.4
FACTOR = 2 * (1 + NU)
ELASTIC = "&material name = 'sheet', model = 'elastic', density = 1100, poisson_ratio = 0.4,\n"


@pytest.mark.parametrize("model", MODELS)
def test_each_model(vcor, model):
    accuracy = "&solver accuracy = 1e-4 /\n" if model == "table" else ""
    write_points(vcor, name="modulus")
    vcor.write(case(material(model, more="modulus_kind = 'shear'"), more=accuracy))
    found = vcor.numbers("case.nml")
    write_points(vcor, b=FACTOR)
    vcor.write(case(material(model, b=FACTOR), more=accuracy))
    same(found, vcor.numbers("case.nml"), ROUNDING)
    # a name that says nothing, and the default said
    write_points(vcor)
    vcor.write(case(material(model, more="modulus_kind = 'tensile'"), more=accuracy), "said.nml")
    vcor.write(case(material(model), more=accuracy))
    assert vcor.numbers("said.nml") == vcor.numbers("case.nml")


def test_an_elastic_body(vcor):
    ball = "&material name = 'ball', model = 'sls', density = 1200, poisson_ratio = 0.45,\n"
    ball += "   glassy_modulus = 15e6, alpha = 300, beta = 1200 /\n"
    vcor.write(case(ball, ELASTIC + f"modulus = {3e9!r}, modulus_kind = 'shear' /\n",
                    bodies=("ball", "sheet")))  # fmt: skip
    found = vcor.numbers("case.nml")
    vcor.write(case(ball, ELASTIC + f"modulus = {3e9 * FACTOR!r} /\n", bodies=("ball", "sheet")))
    same(found, vcor.numbers("case.nml"), ROUNDING)


def test_poissons_ratio_is_swept(vcor):
    """The tensile moduli follow it."""
    text = case(shifted("sls", "wlf").replace("'sls'", "'sls', modulus_kind = 'shear'"),
                temperature=305.0)  # fmt: skip
    vcor.write(text)
    vcor.write(text + "&sweep parameter = 'sheet.poisson_ratio', values = 0.2, 0.35, 0.5 /\n", "s.nml")
    rows = vcor.succeeds("run", "s.nml", "--print", "cor", "--quiet").splitlines()
    for value, row in zip((0.2, 0.35, 0.5), rows, strict=True):
        single = vcor.numbers("case.nml", "--set", f"sheet.poisson_ratio={value}")
        assert row.split()[-1] == single["cor"]
    assert len({row.split()[-1] for row in rows}) == 3


def test_a_rigid_body_has_none(vcor):
    text = case(material("sls")).replace("'rigid'", "'rigid', modulus_kind = 'shear'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["'modulus_kind'", "'rigid'"], at="case.nml:6")


HEADERS = [
    ("t [s],G [Pa]", "tensile", ["shear modulus", "modulus_kind = 'shear'"]),
    ("t [s],shear_modulus [Pa]", "tensile", ["shear modulus"]),
    ("t [s],E [Pa]", "shear", ["tensile modulus", "modulus_kind = 'shear'"]),
    ("t [s],Young's modulus [Pa]", "shear", ["vcor table"]),
    ("t [s],G [Pa]", "shear", None),
    ("t [s],relaxation_modulus [Pa]", "shear", None),
    ("t [s],modulus [Pa]", "tensile", None),
]


@pytest.mark.parametrize("header, kind, says", HEADERS)
def test_headers(vcor, header, kind, says):
    """A header that contradicts the case is refused."""
    write_points(vcor)
    path = vcor.folder / "points.csv"
    path.write_text(path.read_text().replace("t [s],E [Pa]", header))
    vcor.write(case(material("table", more=f"modulus_kind = '{kind}'")))
    if says:
        vcor.refuses("check", "case.nml", code=INPUT, says=says, at="points.csv:1")
    else:
        vcor.succeeds("check", "case.nml")


def test_reliance_takes_the_moduli_as_they_are(vcor):
    said = []
    for b, kind in ((1.0, "shear"), (FACTOR, "tensile")):
        vcor.write(case(material("sls", b=b, more=f"modulus_kind = '{kind}', valid_from = 1e-3")))
        said.append(vcor("run", "case.nml", "--print", "cor", "--quiet").err)
    assert said[0] == said[1]
    assert "valid_from" in said[0]
