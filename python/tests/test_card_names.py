"""Cards with any name, in all formats and units: what is read is what was written."""

import dataclasses

import pytest
from conftest import PAPER
from properties import example, examples, given, st

import vcor
from vcor.exchange.card_formats import FORMATS, UNITS, Card
from vcor.material_files import IMPACT

#: Rounding of the 14 to 15 digits of a card; the long-time modulus is a difference of some of them
ROUNDING = 1e-12
#: Texts that a program may take for more than a name
TRAPS = ["*END", "**", "#", "$", "$ x", "/", "/END", "//", "!", "! x", "%", "% density = 1", ",",
         "&", "\\", "'", "''", '"', "', units SI: ", "vcor card for abaqus in units SI: ",
         "material 'x'",
         "TB,PRONY,1", "*MAT_076", "/MAT/LAW42/1", "*MATERIAL, NAME=y", "&material", "NAME=", "1",
         "natural rubber, 40 Shore A, batch 17, measured in tension", "r" * 79, "r" * 101, "{0}",
         "@", "\u2028*END", "\u0085/END", "\x1c", "Gummi weiß", "橡胶", "a\tb", "a  b"]  # fmt: skip
NAMES = st.one_of(
    st.sampled_from(TRAPS),
    st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=90),
    st.lists(st.sampled_from(TRAPS), min_size=2, max_size=4).map("".join),
)
POSITIVE = {"allow_nan": False, "allow_infinity": False}


@st.composite
def materials(draw, code):
    """A material that a format can hold, of any name."""
    form = FORMATS[code]
    n = draw(st.integers(1, min(8, form.terms - form.constant)))
    ratio = draw(st.integers(-400, 490).map(lambda n: n / 1000))
    equilibrium, density = (draw(st.floats(*ends, **POSITIVE)) for ends in ((1e2, 1e9), (1.0, 2e4)))
    moduli = draw(st.lists(st.floats(1e3, 1e9, **POSITIVE), min_size=n, max_size=n))
    times = draw(st.lists(st.floats(1e-9, 1e9, **POSITIVE), min_size=n, max_size=n))
    shift = draw(st.sampled_from(["", *form.shifts]))
    keys = {}
    if shift:
        keys = {"shift": shift, "reference_temperature": draw(st.floats(200.0, 400.0))}
        wlf = {"wlf_c1": draw(st.floats(1.0, 50.0)), "wlf_c2": draw(st.floats(10.0, 500.0))}
        keys |= wlf if shift == "wlf" else {"activation_energy": draw(st.floats(1e4, 1e6))}
    return Card(draw(NAMES), ratio if ratio != form.forbidden else 0.3, equilibrium,
                tuple(moduli), tuple(times), density, keys)  # fmt: skip


def assert_same(found, wanted):
    """The same material to the digits of the card."""
    assert found.name.rstrip() == wanted.name.rstrip()
    loss = ROUNDING * wanted.glassy_modulus
    for key, near in (("poisson_ratio", ROUNDING), ("density", 0.0), ("times", 0.0),
                      ("moduli", loss), ("equilibrium_modulus", loss)):  # fmt: skip
        assert getattr(found, key) == pytest.approx(getattr(wanted, key), rel=ROUNDING, abs=near)
    assert found.shift.keys() == wanted.shift.keys()
    for key, value in wanted.shift.items():
        assert found.shift[key] == (value if key == "shift" else pytest.approx(value, rel=ROUNDING))


def group_of(made):
    """A case with the group of a card, as vcor reads it."""
    return vcor.Case(IMPACT.format(made.name.replace("'", "''")) + str(made))


@pytest.mark.parametrize("code", FORMATS)
@examples(60)
@given(data=st.data(), units=st.sampled_from(list(UNITS)), tell=st.booleans())
def test_a_written_card_is_read_back(tmp_path, code, data, units, tell):
    made = data.draw(materials(code))
    try:
        text = made.text(code, units)
    except vcor.InputError as error:
        assert "name" in str(error)
        return
    path = tmp_path / "some.card"
    path.write_text(text, newline="")
    found = vcor.read_card(path, code=code if tell else None)
    assert_same(found, made)
    case = group_of(found)
    name = case["sphere.material"]
    assert name == found.name
    assert case.material(name).relaxation(0.0) == pytest.approx(found.glassy_modulus, rel=ROUNDING)


@pytest.mark.parametrize("code", FORMATS)
@pytest.mark.parametrize("name", TRAPS)
def test_a_name_is_only_a_name(tmp_path, code, name):
    """Each trap: either refused by its name, or nothing but the name in the card."""
    plain = Card("rubber", 0.4, 1e6, (2e6,), (1e-3,), 1100.0)
    try:
        text = dataclasses.replace(plain, name=name).text(code)
    except vcor.InputError as error:
        assert "name" in str(error)
        return
    pairs = list(zip(text.split("\n"), plain.text(code).split("\n"), strict=True))
    assert all(one == other or name in one for one, other in pairs)
    assert sum(one != other for one, other in pairs) <= 2
    (tmp_path / "some.card").write_text(text)
    assert vcor.read_card(tmp_path / "some.card").name.rstrip() == name.rstrip()


@pytest.mark.parametrize(("code", "name"), [
    ("lsdyna", "*END"), ("lsdyna", "$"), ("lsdyna-006", "*END"), ("openradioss", "/END"),
    ("openradioss", "#"), ("openradioss-law34", "$x"), ("abaqus", 'a"b'), ("abaqus", "r" * 81),
    ("lsdyna", "r" * 81), ("openradioss", "r" * 101), ("ansys", "a\u2028b"), ("comsol", "a\nb"),
])  # fmt: skip
def test_names_that_are_refused(code, name):
    with pytest.raises(vcor.InputError, match="name"):
        Card(name, 0.4, 1e6, (2e6,), (1e-3,), 1100.0).text(code)


# ------------------------------------------------------------------------------- cards of others


OLD = """** vcor card 'natural rubber, 40 Shore A, batch 17, measured in tension',
** units mm-t-s: moduli in 1e+06 Pa, temperatures in K
*MATERIAL, NAME="natural rubber, 40 Shore A, batch 17, measured in tension"
*DENSITY
1.1e-09,
*ELASTIC, MODULI=INSTANTANEOUS
3, 0.49
*VISCOELASTIC, TIME=PRONY
0.666666666666667, 0.666666666666667, 0.001
"""


def test_units_are_not_guessed_where_the_head_is_damaged(tmp_path):
    path = tmp_path / "old.inp"
    path.write_text(OLD)
    with pytest.raises(vcor.InputError, match="the head .* is damaged or old, expected units"):
        vcor.read_card(path)
    assert vcor.read_card(path, units="mm-t-s").equilibrium_modulus == pytest.approx(1e6)


ABAQUS = """*MATERIAL, NAME={0}
*DENSITY
1100.,
*ELASTIC, MODULI=INSTANTANEOUS
1e6, {1}
*VISCOELASTIC, TIME=PRONY
0.5, 0, 0.001
"""


@pytest.mark.parametrize("ratio", ["-1", "-1.5", "0.51", "1e300", "-1e300"])
def test_ratios_out_of_range(tmp_path, ratio):
    (tmp_path / "a.inp").write_text(ABAQUS.format("r", ratio))
    with pytest.raises(vcor.InputError, match=r"a.inp:\d: found Poisson's ratio"):
        vcor.read_card(tmp_path / "a.inp")


def test_two_materials_of_one_name(tmp_path):
    (tmp_path / "a.inp").write_text(2 * ABAQUS.format("r", "0.4"))
    with pytest.raises(vcor.InputError, match="a.inp:1: found several materials 'r'"):
        vcor.read_card(tmp_path / "a.inp")


@example("a\tb")
@given(st.text(min_size=1, max_size=60).filter(lambda name: "\n" not in name and "\r" not in name))
def test_names_of_other_programs(tmp_path, name):
    (tmp_path / "a.inp").write_text(ABAQUS.format(f'"{name}"', "0.4"), errors="replace")
    try:
        found = vcor.read_card(tmp_path / "a.inp")
    except vcor.InputError:
        return
    assert group_of(found)["plate.material"] == found.name


def test_the_name_of_a_case_is_written_on_one_line(tmp_path):
    name = "natural rubber filled with carbon black " * 3
    text = PAPER.joinpath("sls.nml").read_text().replace("'rubber'", f"'{name}'")
    case = vcor.Case(text.replace("poisson_ratio  = 0.5", "poisson_ratio  = 0.49"))
    for code in ("ansys", "comsol"):
        (tmp_path / "c.txt").write_text(vcor.card(case, name).text(code, "mm-t-s"))
        found = vcor.read_card(tmp_path / "c.txt")
        assert found.name == name
        assert found.glassy_modulus == pytest.approx(15e6)
        assert f"   name = '{name}'\n" in str(found)
    with pytest.raises(vcor.InputError, match="holds names of 80 letters"):
        vcor.card(case, name).text("abaqus")
