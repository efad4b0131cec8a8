"""Cards of finite element programs: what they say by the rules of each, both ways, and traps."""

import dataclasses
import math
import re

import numpy as np
import pytest
from conftest import PAPER, ROOT

import vcor
from vcor import _command
from vcor.exchange.card_formats import FORMATS, GAS, UNITS, Card

ALL = list(FORMATS)
SERIES = ["abaqus", "ansys", "ansys-mpl", "lsdyna", "openradioss", "comsol"]
#: Rounding of the 14 to 16 digits of a card, of which the long-time modulus is a difference
ROUNDING = 1e-13
HEAD = """&impact velocity = 5.0 /
&sphere radius = 0.01, material = 'steel' /
&plate material = 'rubber', waves = 'none' /
&material name = 'steel', model = 'rigid', density = 7800.0 /
&material name = 'rubber', density = 1100.0, poisson_ratio = {nu}, {keys} /
"""
PRONY = "model='prony', equilibrium_modulus=1.234e6, moduli=3e7,2.1e6, times=1.23e-5,0.1"
MODELS = {
    "sls": "model='sls', glassy_modulus=1.5e7, alpha=300.0, beta=1200.0",
    "prony": PRONY,
    "rates": "model='prony', equilibrium_modulus=2e6, moduli=3e7,2e6, rates=3e3,70.0",
    "shear": PRONY + ", modulus_kind='shear'",
    "power_law": "model='power_law', equilibrium_modulus=2e6, coefficient=8.85e5, exponent=0.5",
    "springpot": "model='power_law', equilibrium_modulus=1e6, coefficient=5e6, exponent=0.2",
    "cerf": "model='cerf', equilibrium_modulus=2e6, relaxing_modulus=5e8, beta=500.0",
    "exponential": "model='mittag_leffler', equilibrium_modulus=1e7, relaxing_modulus=2e9, "
    "exponent=1.0, time=1e-4",
    "whole_numbers": PRONY + ", shift='wlf', reference_temperature=298, wlf_c1=9, wlf_c2=200",
    "mittag_leffler": "model='mittag_leffler', equilibrium_modulus=1e7, relaxing_modulus=2e9, "
    "exponent=0.4, time=1e-5",
}
WLF = ", shift='wlf', reference_temperature=298.15, wlf_c1=8.61, wlf_c2=200.4"
ARRHENIUS = ", shift='arrhenius', reference_temperature=298.15, activation_energy=1.2e5"


def case_of(keys, nu=0.45):
    return vcor.Case(HEAD.format(nu=nu, keys=keys))


def back(tmp_path, text, **options):
    """A card that was written, read again."""
    path = tmp_path / "some.card"
    path.write_text(text)
    return vcor.read_card(path, **options)


def assert_same(found, wanted):
    """The same material to the digits of the card."""
    assert (found.name, found.shift.keys()) == (wanted.name, wanted.shift.keys())
    for key, value in wanted.shift.items():
        assert found.shift[key] == (value if key == "shift" else pytest.approx(value, rel=ROUNDING))
    assert found.poisson_ratio == pytest.approx(wanted.poisson_ratio, abs=ROUNDING)
    assert found.density == pytest.approx(wanted.density, rel=ROUNDING)
    assert found.times == pytest.approx(wanted.times, rel=ROUNDING)
    assert found.moduli == pytest.approx(wanted.moduli, rel=ROUNDING)
    loss = ROUNDING * wanted.glassy_modulus
    assert found.equilibrium_modulus == pytest.approx(wanted.equilibrium_modulus, abs=loss)


def with_material(case, made):
    """A case with the group of a card in place of its material."""
    text = re.sub(r"&material\s+name = '" + made.name + r"'.*?\n/\n", "", case.text(), flags=re.S)
    return vcor.Case(text + str(made))


@pytest.mark.parametrize("model", MODELS)
def test_a_material_is_read_back(model, tmp_path):
    case = case_of(MODELS[model])
    made = vcor.card(case, "rubber", terms=17)
    codes = ALL if len(made.moduli) == 1 else SERIES
    if made.shift:
        assert made.shift["wlf_c1"] == 9 and len(made.shift) == 4
        codes = [code for code in codes if FORMATS[code].shifts]
    for units, code in zip([*UNITS] * 2, codes, strict=False):
        assert_same(back(tmp_path, made.text(code, units)), made)
    other = with_material(case, back(tmp_path, made.text("abaqus")))
    cor, again = (one.solve(quantities=["cor"])["cor"] for one in (case, other))
    assert again == pytest.approx(cor, abs=1e-9 if not made.remarks else 3e-4)


@pytest.mark.parametrize("code", SERIES)
def test_any_series_is_read_back(code, tmp_path):
    rng = np.random.default_rng(23)
    for _ in range(20):
        n = int(rng.integers(1, 18))
        shift = {}
        if "wlf" in FORMATS[code].shifts:
            shift = [{}, {"shift": "wlf", "reference_temperature": rng.uniform(200, 400),
                          "wlf_c1": rng.uniform(1, 50), "wlf_c2": rng.uniform(10, 500)},
                     {"shift": "arrhenius", "reference_temperature": rng.uniform(200, 400),
                      "activation_energy": rng.uniform(1e4, 1e6)}][rng.integers(3)]  # fmt: skip
        made = Card(
            "a, name", rng.uniform(-0.4, 0.499), 10 ** rng.uniform(2, 9),
            tuple(10 ** rng.uniform(2, 10, n)), tuple(10 ** rng.uniform(-9, 9, n)),
            rng.uniform(10, 9000), shift,
        )  # fmt: skip
        assert_same(back(tmp_path, made.text(code, rng.choice(list(UNITS)))), made)


# ------------------------------------------------------------- what the cards say, by their rules


def numbers_of(lines):
    return [[float(x) for x in re.split(r"[,\s]+", line.strip(" ,"))] for line in lines]


def shear_and_bulk(code, text, t):
    """G(t) and K(t) as the manuals of the programs define them, t of shape (n,)."""
    lines = [line for line in text.splitlines() if not re.match(r"\*\*|!|\$|#|/COM", line)]

    def after(start, n=1):
        k = next(k for k, line in enumerate(lines) if line.startswith(start)) + 1
        return numbers_of(lines[k : k + n])

    def decay(rows, i, j=None):
        return sum(row[i] * np.exp(-t * (row[j] if j else 1 / row[-1])) for row in rows)

    if code == "abaqus":
        young, nu = after("*ELASTIC")[0]
        rows = numbers_of(lines[lines.index("*VISCOELASTIC, TIME=PRONY") + 1 :])
        g, k = (1 - sum(row[i] for row in rows) + decay(rows, i) for i in (0, 1))
        return young / (2 * (1 + nu)) * g, young / (3 * (1 - 2 * nu)) * k
    if code.startswith("ansys"):
        young, nu = (float(line.split(",")[3]) for line in lines if line[:5] in ("MP,EX", "MP,PR"))
        parts = []
        for kind in ("SHEAR", "BULK"):
            k = next(k for k, line in enumerate(lines) if line.endswith(kind)) + 1
            words = []
            while k < len(lines) and lines[k].startswith("TBDATA"):
                words += map(float, lines[k].split(",")[2:])
                k += 1
            rows = list(zip(words[::2], words[1::2], strict=True))
            parts.append(1 - sum(words[::2]) + decay(rows, 0))
        return young / (2 * (1 + nu)) * parts[0], young / (3 * (1 - 2 * nu)) * parts[1]
    rows = numbers_of(lines[4:])
    assert after("rubber")[0][2] == pytest.approx(sum(row[2] for row in rows))
    return decay(rows, 0, 1), decay(rows, 2, 3)


@pytest.mark.parametrize("code", ["abaqus", "ansys", "ansys-mpl", "lsdyna"])
def test_the_card_has_the_modulus_of_the_material(code):
    case = case_of(PRONY)
    t = np.geomspace(1e-7, 10, 30)
    g, k = shear_and_bulk(code, vcor.card(case, "rubber").text(code), t)
    assert 9 * k * g / (3 * k + g) == pytest.approx(
        case.material("rubber").relaxation(t), rel=1e-12
    )
    assert (3 * k - 2 * g) / (2 * (3 * k + g)) == pytest.approx(0.45, rel=1e-12)


def columns(line, *widths):
    ends = np.cumsum(widths)
    return [float(line[e - w : e] or 0) for e, w in zip(ends, widths, strict=True)]


def test_openradioss_has_the_long_time_law_and_the_terms_added_to_it():
    # GS = sum mu alpha, G = GS/2, K = GS (1 + nu)/(3 (1 - 2 nu)) of hm_read_mat42.F of OpenRadioss;
    # visc_prony.F adds 2 G_i and K_i with rates
    made = vcor.card(case_of(PRONY), "rubber")
    lines = made.text("openradioss").splitlines()
    rows = [line for line in lines if not line.startswith("#")]
    assert rows[0] == "/MAT/LAW42/1" and rows[1] == "rubber" and rows[8] == "/VISC/PRONY/1"
    nu, mu, alpha = (columns(rows[k], 20)[0] for k in (3, 4, 6))
    assert rows[9][:10] == f"{2:10d}" and nu == 0.45
    table = [columns(row, 20, 20, 20, 20) for row in rows[10:]]
    shear = mu * alpha / 2
    bulk = mu * alpha * (1 + nu) / (3 * (1 - 2 * nu))
    assert 2 * (1 + nu) * shear == pytest.approx(1.234e6, rel=1e-12)
    for (g, rate, k, bulk_rate), modulus, time in zip(table, made.moduli, made.times, strict=True):
        assert rate == bulk_rate == pytest.approx(1 / time, rel=1e-15)
        assert (2 * (1 + nu) * g, k / g) == pytest.approx((modulus, bulk / shear), rel=1e-12)


@pytest.mark.parametrize("code", ["lsdyna-006", "openradioss-law34"])
def test_one_term_cards(code):
    made = vcor.card(case_of(MODELS["sls"]), "rubber")
    lines = [line for line in made.text(code).splitlines() if line[0] not in "$#*/"][1:]
    if code == "lsdyna-006":
        _, density, bulk, g0, g, beta = columns(lines[0], *[20] * 6)
    else:
        density, bulk, (g0, g, beta) = (
            float(lines[0]),
            float(lines[1]),
            columns(lines[2], *[20] * 3),
        )
    assert (density, beta) == pytest.approx((1100.0, 1200.0))
    assert (2.9 * g0, 2.9 * g, 0.3 * bulk) == pytest.approx((1.5e7, 3.75e6, 1.5e7))
    assert any("grows from 0.45 to 0.487" in note for note in made.notes(code))


def test_comsol_has_three_columns_and_the_long_time_node():
    text = vcor.card(case_of(PRONY), "rubber").text("comsol")
    rows = numbers_of(line for line in text.splitlines() if not line.startswith("%"))
    assert [row[0] for row in rows] == [1, 2] and [row[2] for row in rows] == [1.23e-5, 0.1]
    assert [2.9 * row[1] for row in rows] == pytest.approx([3e7, 2.1e6])
    assert float(re.search(r"shear_modulus = (\S+)", text)[1]) == pytest.approx(1.234e6 / 2.9)


# ------------------------------------------------------------------------------------------- traps


ROWS = "0.4, {k}, 1e-3\n0.5, {k5}, 2.0"


def abaqus_of(tmp_path, elastic, rows=ROWS, k=True, rest="", **options):
    rows = rows.format(k=0.4 if k else 0.0, k5=0.5 if k else 0.0)
    text = (
        f"*Material, name=PAD\n{elastic}\n** remark\n*Viscoelastic, time = PRONY\n{rows}\n{rest}\n"
    )
    return back(tmp_path, text, **options)


def test_moduli_of_abaqus_are_long_term_by_default(tmp_path):
    for head in ("*Elastic", "*ELASTIC, moduli=LONG TERM", "*Elastic, type=ISOTROPIC"):
        found = abaqus_of(tmp_path, f"{head}\n1e6, 0.4")
        assert found.equilibrium_modulus == pytest.approx(1e6)
        assert found.moduli == pytest.approx((4e6, 5e6))
        assert found.poisson_ratio == 0.4 and found.name == "PAD"
    found = abaqus_of(tmp_path, "*Elastic, moduli=INSTANTANEOUS\n1e7, 0.4")
    assert found.equilibrium_modulus == pytest.approx(1e6)
    assert found.moduli == pytest.approx((4e6, 5e6))


@pytest.mark.parametrize("long_term", [True, False])
def test_a_bulk_modulus_that_does_not_relax_is_reported(long_term, tmp_path):
    e, nu = (1e6, 0.49) if long_term else (1e7, 0.4)
    head = f"*Elastic, moduli={'LONG TERM' if long_term else 'INSTANTANEOUS'}\n{e}, {nu}"
    found = abaqus_of(tmp_path, head, k=False)
    shear, bulk = e / (2 * (1 + nu)), e / (3 * (1 - 2 * nu))
    start = shear * 10 if long_term else shear
    low, high = ((3 * bulk - 2 * g) / (2 * (3 * bulk + g)) for g in (start, start / 10))
    assert found.poisson_ratio == pytest.approx(low)
    assert found.glassy_modulus == pytest.approx(2 * (1 + low) * start)
    assert f"grows from {low:.6g} to {high:.6g}" in found.remarks[-1]
    found = abaqus_of(tmp_path, head, k=False, poisson_ratio=0.49)
    assert found.glassy_modulus == pytest.approx(2 * 1.49 * start) and found.poisson_ratio == 0.49


def test_a_ratio_that_is_not_constant_is_refused(tmp_path):
    head, rows = "*Elastic, moduli=instantaneous\n1e7, 0.4", "0.4, 0.1, 1e-3"
    with pytest.raises(vcor.InputError, match="Poisson's ratio is not constant") as caught:
        abaqus_of(tmp_path, head, rows)
    assert caught.value.code == 3
    assert abaqus_of(tmp_path, head, rows, poisson_ratio=0.4).moduli == pytest.approx((4e6,))
    # an incompressible one has no bulk modulus
    assert abaqus_of(tmp_path, head.replace("0.4", "0.5"), rows).poisson_ratio == 0.5


def test_shifts_have_the_sign_and_base_of_each_program(tmp_path):
    made = vcor.card(case_of(PRONY + WLF), "rubber")
    assert "*TRS, DEFINITION=WLF\n298.15, 8.61, 200.4\n" in made.text("abaqus")
    assert made.text("ansys").endswith("TB,SHIFT,1,1,3,WLF\nTBDATA,1,298.15,8.61,200.4\n")
    first = made.text("lsdyna").split("rubber\n")[1].splitlines()[1]
    reference, a, b = columns(first, *[20] * 8)[5:]
    assert (reference, a / math.log(10), b) == pytest.approx((298.15, 8.61, 200.4))
    assert any("unconfirmed" in note for note in made.notes("lsdyna"))
    assert any("unconfirmed" in note for note in back(tmp_path, made.text("lsdyna")).remarks)
    made = vcor.card(case_of(PRONY + ARRHENIUS), "rubber")
    first = made.text("lsdyna").split("rubber\n")[1].splitlines()[1]
    assert columns(first, *[20] * 8)[5:] == pytest.approx([298.15, 1.2e5 / GAS, 0.0])
    text = made.text("abaqus", "mm-t-s")
    gas, energy = (float(re.search(r, text)[1]) for r in (r"GAS=(\S+)", r"NIUS\n298.15, (\S+)"))
    assert (gas, energy) == pytest.approx((1e3 * GAS, 1.2e8))
    head = "*Elastic, moduli=instantaneous\n1e7, 0.4"
    zero = "*Trs\n25., 8.61, 200.4\n*Physical constants, absolute zero=-273.15"
    assert abaqus_of(tmp_path, head, rest=zero).shift["reference_temperature"] == 298.15
    with pytest.raises(vcor.InputError, match="DEFINITION=USER"):
        abaqus_of(tmp_path, head, rest="*Trs, definition=USER")
    assert abaqus_of(tmp_path, head, rest="*Trs, definition=USER", use_shift=False).shift == {}


def test_a_shift_that_lacks_a_constant_is_refused(tmp_path):
    for keys, constant in ((WLF, "wlf_c1"), (ARRHENIUS, "activation_energy")):
        text = vcor.card(case_of(PRONY + keys), "rubber").text("comsol")
        flawed = re.sub(rf"% {constant} = .*\n", "", text)
        assert flawed != text
        with pytest.raises(vcor.InputError, match=r"some\.card:\d+: found shift = "):
            back(tmp_path, flawed)


@pytest.mark.parametrize("temperature", [268.15, 338.15])
def test_the_card_serves_the_temperature_of_the_impact(temperature):
    """Its times are those of the reference temperature, where the shift takes them from."""
    keys = MODELS["cerf"] + WLF
    head = HEAD.replace("5.0 /", f"5.0, temperature = {temperature} /")
    case = vcor.Case(head.format(nu=0.4, keys=keys))
    again = with_material(case, vcor.card(case, "rubber"))
    cor, found = (float(one.solve(quantities=["cor"])["cor"]) for one in (case, again))
    assert found == pytest.approx(cor, abs=2e-3)


def test_the_other_body_may_exclude_the_reference_temperature():
    text = HEAD.replace("5.0 /", "5.0, temperature = 300.0 /").replace("model = 'rigid'",
        "model = 'cerf', poisson_ratio = 0.3, relaxing_modulus = 1e9, beta = 5, shift = 'wlf',"
        "wlf_c1 = 9, wlf_c2 = 51.6, reference_temperature = 300")  # fmt: skip
    keys = MODELS["cerf"] + WLF.replace("298.15", "220")
    case = vcor.Case(text.format(nu=0.4, keys=keys))
    warm = vcor.card(case, "rubber", band=(1e-6, 1e-3))
    assert warm.moduli == pytest.approx(
        vcor.card(case_of(keys, 0.4), "rubber", band=(1e-6, 1e-3)).moduli, rel=1e-6)  # fmt: skip


#: In the manner of the card of E1 of pyvisco (tests/data/E1_WLF.USER_MPL, NatLabRockies/pyvisco)
ANSYS = """!E1
MP,REFT,_MAT,_TREF
MP,EX,  _MAT, 9115.80E6  !Pa
MP,PRXY,_MAT, 0.35
MPAMOD, _MAT,273+20

TB,PRONY,_MAT,1,3,SHEAR
TBDATA,1,4.117658e-02,1.000000e-10,1.553623e-02
TBDATA,4,1.000000e-09,6.258372e-01,1.000000e+10

TB,SHIFT,_MAT,1,3,WLF       ! WLF
TBDATA, 1, 273-5, 199.73, 933.5     ! SHIFT FUNCTION PARAMETERS
"""


def test_foreign_cards_of_ansys(tmp_path):
    found = back(tmp_path, ANSYS)
    assert found.times == (1e-10, 1e-9, 1e10) and found.density is None
    assert found.moduli[0] == pytest.approx(4.117658e-02 * 9115.8e6)
    assert found.glassy_modulus == pytest.approx(9115.8e6)
    assert found.shift == {"shift": "wlf", "reference_temperature": 268.0, "wlf_c1": 199.73,
                           "wlf_c2": 933.5}  # fmt: skip
    assert "units SI" in found.remarks[0] and "0.35" in found.remarks[1]
    assert back(tmp_path, ANSYS, units="mm-t-s").glassy_modulus == pytest.approx(9115.8e12)
    user = ANSYS.replace("1,3,WLF", "1,5,USER")
    with pytest.raises(vcor.InputError, match="some.card:11: found TB,SHIFT of kind USER"):
        back(tmp_path, user)
    assert not back(tmp_path, user, use_shift=False).shift
    # MPWRITE after a fit: ratios alone
    native = ANSYS[ANSYS.index("TB,PRONY") : ANSYS.index("TB,SHIFT")]
    native = "/COM,ANSYS RELEASE\n/NOP\n" + native.replace(
        "TB,PRONY,_MAT,1,3,SHEAR", "TB,PRON,_MATL   ,   1,   3,SHEA\nTBFIELD,Temps,0.000000"
    ) + "TBIN,NORM,1\n/GO\n"  # fmt: skip
    with pytest.raises(vcor.InputError, match="expected modulus"):
        back(tmp_path, native)
    found = back(tmp_path, native, modulus=1e9, poisson_ratio=0.4)
    assert found.glassy_modulus == pytest.approx(1e9) and len(found.moduli) == 3


DYNA = """*KEYWORD
*MAT_GENERAL_VISCOELASTIC
$ remark
         11.1000E-09     400.0
{second}
       1.0      10.0
       2.0       0.0
*END
"""


def test_foreign_cards_of_lsdyna(tmp_path):
    found = back(tmp_path, DYNA.format(second=""), units="mm-t-s")
    assert found.density == pytest.approx(1100.0) and found.times == (0.1,)
    nu = (3 * 400 - 2 * 3) / (2 * (3 * 400 + 3))
    assert found.poisson_ratio == pytest.approx(nu)
    assert found.equilibrium_modulus == pytest.approx(2e6 * 2 * (1 + nu))
    with pytest.raises(vcor.InputError, match="second line of the card"):
        back(tmp_path, DYNA.format(second="").replace("\n\n", "\n"))
    long = DYNA.replace("*KEYWORD", "*KEYWORD LONG=Y").format(second="").splitlines()
    long[3] = f"{1:20d}{1.1e-9:20.4E}{400.0:20.1f}"
    long[5:7] = [f"{1.0:20f}{10.0:20f}", f"{2.0:20f}"]
    assert_same(back(tmp_path, "\n".join(long), units="mm-t-s"), found)
    free = DYNA.format(second="").replace("         11.1000E-09     400.0", "1,1.1e-9,400")
    assert_same(back(tmp_path, free, units="mm-t-s"), found)
    # fields of eight columns run into each other
    narrow = DYNA.format(second="").replace("       1.0      10.0", " 1.0e+00 1.0e+01")
    with pytest.raises(vcor.InputError, match="some.card:6: found '1.0e\\+00 1'"):
        back(tmp_path, narrow)


def test_a_card_states_what_it_cannot_hold():
    def refused(words, code, keys, nu=0.45, kind=vcor.InputError, **options):
        with pytest.raises(kind, match=words) as caught:
            vcor.card(case_of(keys, nu), "rubber", **options).text(code)
        assert caught.value.code == (3 if kind is vcor.InputError else 2)
        assert "\n" not in str(caught.value)

    for code in ALL:
        refused("dashpot", code, "model='prony', equilibrium_modulus=1e6, viscosity=10.0")
        refused("does not relax", code, "model='elastic', modulus=1e9")
        refused("vertical shift|shift 'wlf'", code, MODELS["sls"] + WLF + ", vertical_shift=.true.")
    for keys in ("model='rigid'", "model='prony', equilibrium_modulus=1e6",
                 "model='sls', glassy_modulus=1e7, alpha=5.0, beta=5.0"):  # fmt: skip
        refused("does not relax", "abaqus", keys)
    refused("alpha", "abaqus", "model='sls', glassy_modulus=1e7, alpha=7.0, beta=5.0")
    many = "model='prony', equilibrium_modulus=1e6, moduli=18*1e6, times=" + ",".join(
        f"1e{i}" for i in range(-9, 9)
    )
    refused("holds 18 terms, found 19", "lsdyna", many)
    refused("holds 1 terms, found 2", "lsdyna-006", PRONY)
    refused("to [0-9.]+ from", "lsdyna", MODELS["power_law"], terms=3)
    for code in ("lsdyna", "lsdyna-006", "openradioss", "openradioss-law34", "comsol"):
        refused("Poisson's ratio 0.5", code, MODELS["sls"], 0.5)
        vcor.card(case_of(MODELS["sls"], 0.5), "rubber", poisson_ratio=0.495).text(code)
    refused("Poisson's ratio 0", "openradioss", MODELS["sls"], 0.0)
    fluid = "model='prony', moduli=1e6, times=1e-3"
    for code in ("abaqus", "ansys", "openradioss", "comsol"):
        refused("fluid", code, fluid)
    assert vcor.card(case_of(fluid), "rubber").text("lsdyna")
    for code in ("openradioss", "lsdyna-006"):
        refused("expected use_shift=False", code, MODELS["sls"] + WLF)
        vcor.card(case_of(MODELS["sls"] + WLF), "rubber", use_shift=False).text(code)
    made = vcor.card(case_of(PRONY), "rubber")
    with pytest.raises(vcor.InputError, match="density"):
        dataclasses.replace(made, density=None).text("lsdyna")


@pytest.mark.parametrize("code", ALL)
def test_a_card_that_is_cut_off_is_refused_or_shorter(code, tmp_path):
    made = vcor.card(case_of(MODELS["sls"]), "rubber")
    text = made.text(code)
    refusals = 0
    for k in range(0, len(text), 4):
        for broken in (text[:k], text[:k] + "x" + text[k + 1 :], text[:k] + text[k + 1 :]):
            try:
                back(tmp_path, broken, code=code)
            except vcor.InputError as error:
                refusals += 1
                assert "\n" not in str(error)
    assert refusals > len(text) / 8


def test_a_card_among_others(tmp_path):
    made = [dataclasses.replace(vcor.card(case_of(MODELS["sls"]), "rubber"), name=name)
            for name in ("one", "two")]  # fmt: skip
    for code in ("abaqus", "lsdyna", "openradioss"):
        text = "".join(one.text(code) for one in made).replace("LAW42/1\ntwo", "LAW42/2\ntwo")
        text = "/VISC/PRONY/2".join(text.rsplit("/VISC/PRONY/1", 1))
        assert back(tmp_path, text, material="two").name == "two"
        with pytest.raises(
            vcor.UsageError, match=r"2 materials, expected material with one of one, two"
        ):
            back(tmp_path, text)


# ---------------------------------------------------------------------------------------- commands


def command(capsys, *words, code=0):
    """Output of vcor card, or its line of error."""
    if code:
        with pytest.raises(SystemExit) as caught:
            _command.call("card", list(map(str, words)))
        assert caught.value.code == code
        return capsys.readouterr().err
    _command.call("card", list(map(str, words)))
    return capsys.readouterr()


def test_the_command_both_ways(tmp_path, capsys, program):
    card = tmp_path / "rubber.inp"
    found = command(
        capsys, PAPER / "butyl_power_law.nml", "--material", "butyl", "--for", "abaqus",
        "--output", card, "--units", "mm-t-s",
    )  # fmt: skip
    assert found.out == "" and "exponentials in place of model power_law" in found.err
    assert card.read_text().startswith(
        "** vcor card for abaqus in units mm-t-s: moduli in 1e+06 Pa, temperatures in K\n"
        "** material 'butyl'\n"
    )
    group = tmp_path / "group.nml"
    command(capsys, card, "--output", group)
    text = (PAPER / "butyl_power_law.nml").read_text()
    (tmp_path / "case.nml").write_text(text[: text.index("&material\n   name    = 'butyl'")])
    solved = program("run", "case.nml", "group.nml", "--print", "cor")
    wanted = vcor.read(PAPER / "butyl_power_law.nml").solve(quantities=["cor"])["cor"]
    assert float(solved) == pytest.approx(wanted, abs=3e-4)
    butyl = ROOT / "examples" / "materials" / "butyl.nml"
    words = [butyl, "--material", "butyl", "--for", "comsol", "--poisson-ratio", "0.495"]
    assert "expected --band" in command(capsys, *words, code=2)
    assert "wlf_c1 = 8.61" in command(capsys, *words, "--band", "1e-6:1e-2").out


def test_the_command_refuses_in_one_line(tmp_path, capsys):
    case = PAPER / "sls.nml"
    assert "expected --material and --for" in command(capsys, case, code=2)
    words = [case, "--for", "lsdyna"]
    assert "--poisson-ratio 0.495" in command(capsys, *words, code=3)
    assert "no such" in command(capsys, "none.k", code=4).lower()
    drops = ROOT / "examples" / "identification" / "drops.csv"
    (tmp_path / "empty").write_text("")
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    for file in (ROOT / "LICENSE", drops, tmp_path / "empty", tmp_path / "binary"):
        assert "found no card" in command(capsys, file, code=3)
    for error in ("-1", "0", "nan", "1"):
        assert "found --accuracy" in command(capsys, *words, f"--accuracy={error}", code=2)
    assert "would replace" in command(
        capsys, *words, "--poisson-ratio", "0.49", "--output", case, code=2
    )
    assert "--band" in command(capsys, *words, "--band", "1:x", code=2)
    assert "--modulus is for reading" in command(capsys, *words, "--modulus", "1", code=2)
    (tmp_path / "card.inp").write_text(ANSYS)
    given = [tmp_path / "card.inp", "--accuracy", "0.01"]
    assert "--accuracy is for writing" in command(capsys, *given, code=2)
    assert "--poisson-ratio" in command(capsys, *words, "--poisson-ratio", "0.6", code=2)


def test_the_only_material_is_found_however_its_group_is_written(tmp_path, capsys):
    keys = f"name = 'rubber', density = 1100.0, poisson_ratio = 0.45, {PRONY}"
    for text in (f"&material {keys} /\n", f"&MATERIAL\n   {keys}\n/\n"):
        (tmp_path / "rubber.nml").write_text(text)
        assert "rubber" in command(capsys, tmp_path / "rubber.nml", "--for", "abaqus").out


PAGES = sorted((ROOT / "docs" / "exchange").glob("*.md"))
SHOWN = [
    found
    for page in PAGES
    for found in re.findall(
        r"```sh\nvcor card ([^\n]*)\n```\n\n```text\n(.*?)```\n", page.read_text(), re.DOTALL
    )
]


def test_the_only_material_may_have_any_name_and_stand_after_a_remark(tmp_path, capsys):
    text = (
        "! as name = 'old' was\n&material\n name = 'jo''s', model = 'sls', poisson_ratio = 0.4,\n"
    )
    text += " density = 1100, glassy_modulus = 1e7, alpha = 300, beta = 1200\n/\n"
    (tmp_path / "m.nml").write_text(text)
    card = command(capsys, tmp_path / "m.nml", "--for", "abaqus").out
    assert '*MATERIAL, NAME="jo\'s"' in card


@pytest.mark.parametrize(("words", "text"), SHOWN, ids=lambda text: text.split("\n")[0][-60:])
def test_the_pages_show_what_the_command_prints(words, text, capsys):
    assert command(capsys, *[ROOT / w if "/" in w else w for w in words.split()]).out == text


def test_there_are_pages():
    assert {word for words, _ in SHOWN for word in words.split()} >= set(FORMATS) - {"ansys-mpl"}


# Blank and continued fields, temperatures in degrees Celsius, other elastic constants

NEO = """*MATERIAL, NAME=gum
*HYPERELASTIC, NEO HOOKE{}
 0.5, {}
*VISCOELASTIC, TIME=PRONY
 0.4, , 0.02
 0.3, , 0.0005
"""
LOCATED = """MP,EX,1,4200.5, ! E0
MP,PRXY,1,0.38
{}
TB,PRONY,1,1,3,SHEAR
{}
"""


def test_blank_fields_are_zero(tmp_path):
    text = "*MATERIAL, NAME=a\n*ELASTIC, MODULI=LONG TERM\n3.0, 0.49\n{}"
    text += "*VISCOELASTIC,{}TIME=PRONY\n"
    rows = "0.4, ,0.02\n 0.3,,0.0005,\n"
    found = back(tmp_path, text.format("", " ") + rows)
    g = 3.0 / (2 * 1.49) / 0.3
    assert found.moduli == pytest.approx(
        [2 * (1 + found.poisson_ratio) * g * part for part in (0.4, 0.3)]
    )
    # a line of keywords that goes on, and *TRS before what it shifts
    trs = "*TRS, DEFINITION=WLF\n 298.15, 8.86, 101.6\n"
    again = back(tmp_path, text.format(trs, "\n ") + rows)
    assert again.moduli == found.moduli
    assert again.shift["reference_temperature"] == 298.15


@pytest.mark.parametrize("moduli", [", MODULI=INSTANTANEOUS", ", MODULI=LONG TERM", ""])
@pytest.mark.parametrize("d1", ["0.1", "", "0."])
def test_neo_hooke(tmp_path, moduli, d1):
    """mu = 2 C10 and K = 2/D1, at time zero or in the long term."""
    found = back(tmp_path, NEO.format(moduli, d1))
    g, k = 1.0, 2 / float(d1) if d1 == "0.1" else math.inf
    if "INST" not in moduli:
        g /= 0.3
    nu = 0.5 if math.isinf(k) else (3 * k - 2 * g) / (2 * (3 * k + g))
    assert found.poisson_ratio == pytest.approx(nu)
    assert found.glassy_modulus == pytest.approx(2 * (1 + nu) * g)


ANSYS_NEO = """MP,DENS,1,1.1e-9
TB,HYPER,1,1,2,NEO
TBDATA,1,2.0,0.1
TB,PRONY,1,1,1,SHEAR
TBDATA,1,0.7,1e-3
"""


@pytest.mark.parametrize("d", ["0.1", "", "0."])
def test_neo_hooke_of_ansys(tmp_path, d):
    """mu and d, with G = mu and K = 2/d at time zero."""
    found = back(tmp_path, ANSYS_NEO.replace("2.0,0.1", f"2.0,{d}"), units="mm-t-s")
    k = 2 / float(d) if d == "0.1" else math.inf
    nu = 0.5 if math.isinf(k) else (3 * k - 4) / (2 * (3 * k + 2))
    assert found.poisson_ratio == pytest.approx(nu)
    assert found.glassy_modulus == pytest.approx(2e6 * 2 * (1 + nu))
    assert found.moduli[0] == pytest.approx(0.7 * found.glassy_modulus)


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("NEO", "BOYCE", "TB,HYPER of kind BOYCE, expected NEO, MOONEY, YEOH"),
        ("2,NEO", "5,MOONEY", "found 2 constants of TB,HYPER,,,,MOONEY, expected 6: 5 and 1"),
        ("2,NEO", "2,OGDEN", "found 2 constants of TB,HYPER,,,,OGDEN, expected 6: 4 and 2"),
        (",2,NEO", ",2", "TB,HYPER of kind none, expected NEO"),
        ("TBDATA,1,2.0", "TBDATA,1,-2.0", ":2: found mu = -2"),
        ("TB,PRONY", "MP,EX,1,3.0\nTB,PRONY", ":2: found TB,HYPER and MP,EX, expected one"),
    ],
)
def test_wrong_options_of_ansys_are_named(tmp_path, old, new, says):
    with pytest.raises(vcor.InputError, match=says):
        back(tmp_path, ANSYS_NEO.replace(old, new))


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("NEO HOOKE", "OGDEN, N=2", r"2 numbers of \*HYPERELASTIC, OGDEN, expected 6: 4 and 2"),
        ("NEO HOOKE", "YEOH", "2 numbers of .*, YEOH, expected 6: 3 and 3 of the volume"),
        ("NEO HOOKE", "OGDEN, N=7", "N=7, expected a whole number from 1 to 6"),
        ("NEO HOOKE", "POLYNOMIAL, N=x", "found 'x', expected a number"),
        ("NEO HOOKE", "ARRUDA-BOYCE", "ARRUDA-BOYCE, expected constants of NEO HOOKE"),
        ("NEO HOOKE", "MARLOW", "MARLOW"),
        ("NEO HOOKE", "YEOH, TEST DATA INPUT", "YEOH, TESTDATAINPUT"),
        ("HYPERELASTIC, NEO HOOKE", "HYPERFOAM, N=1", r"HYPERFOAM, expected \*ELASTIC or \*HYP"),
        ("HYPERELASTIC, NEO HOOKE", "HYPOELASTIC", "found no elastic constants"),
        (
            "TIME=PRONY",
            "TIME=PRONY, TYPE=TRACTION",
            "TYPE=TRACTION; expected TIME=PRONY of",
        ),
        ("TIME=PRONY", "TIME=RELAXATION TEST DATA", "TIME=RELAXATIONTESTDATA"),
        ("TIME=PRONY\n 0.4, , 0.02", "FREQUENCY=TABULAR\n 0.4,1,0.1,1,0.02", "FREQUENCY=TABULAR"),
        (" 0.5, 0.1", " 0.5, 0.1, 20\n 0.4, 0.1, 40", "with 2 lines, expected the 2 constants"),
        ("NAME=gum", 'NAME="gum" rubber', "found 'rubber' after the name"),
        ("NEO HOOKE", "NEO HOOKE, TEST DATA INPUT", "TESTDATAINPUT"),
        (" 0.5, 0.1", " -0.5, 0.1", "C10 = -0.5"),
        ("TIME=PRONY", "TIME=CREEP TEST DATA", "TIME=CREEPTESTDATA"),
        ("TIME=PRONY", "FREQUENCY=TABULAR", "FREQUENCY=TABULAR"),
        ("NEO HOOKE", "NEO HOOKE, MODULI=TANGENT", "MODULI=TANGENT"),
    ],
)
def test_wrong_options_of_abaqus_are_named(tmp_path, old, new, says):
    with pytest.raises(vcor.InputError, match=says):
        back(tmp_path, NEO.format("", "0.1").replace(old, new))


@pytest.mark.parametrize("kind", ["ISOTROPIC", "isotropic"])
def test_the_kind_of_a_solid_is_read(tmp_path, kind):
    found = back(tmp_path, NEO.format("", "0.1").replace("=PRONY", f"=PRONY, TYPE={kind}"))
    assert found == back(tmp_path, NEO.format("", "0.1"))


def small_shear(energy):
    """Shear modulus of a strain energy of the stretches, by its second difference."""
    h = 1e-3

    def at(shear):
        stretch = shear / 2 + math.sqrt(1 + shear**2 / 4)
        return energy(np.array([stretch, 1 / stretch, 1.0]))

    return (at(h) - 2 * at(0.0) + at(-h)) / h**2


def polynomial(terms):
    """Strain energy of C_ij (I1 - 3)^i (I2 - 3)^j."""
    return lambda stretch: sum(
        c * ((stretch**2).sum() - 3) ** i * ((stretch**-2.0).sum() - 3) ** j
        for (i, j), c in terms.items()
    )


def ogden(pairs, factor):
    return lambda stretch: sum(
        factor(mu, alpha) * ((stretch**alpha).sum() - 3) for mu, alpha in pairs
    )


C10, C01, C20, C11, C02, C30 = 0.4, 0.1, -0.02, 0.01, 0.003, 0.004
OGDEN = [(0.7, 1.3), (-0.1, -2.0), (0.02, 6.0)]
#: What stands in Abaqus and in Ansys, and the strain energy of their manuals
HYPERELASTIC = {
    "Mooney-Rivlin": ("MOONEY-RIVLIN", [C10, C01], 1, "2,MOONEY", polynomial(
        {(1, 0): C10, (0, 1): C01})),
    "polynomial": ("POLYNOMIAL, N=2", [C10, C01, C20, C11, C02], 2, "2,POLY", polynomial(
        {(1, 0): C10, (0, 1): C01, (2, 0): C20, (1, 1): C11, (0, 2): C02})),
    "polynomial without a word": ("N=1", [C10, C01], 1, "1,POLY", polynomial(
        {(1, 0): C10, (0, 1): C01})),
    "Mooney of five": ("", [C10, C01, C20, C11, C02], 1, "5,MOONEY", polynomial(
        {(1, 0): C10, (0, 1): C01, (2, 0): C20, (1, 1): C11, (0, 2): C02})),
    "Yeoh": ("YEOH", [C10, C20, C30], 3, "3,YEOH", polynomial(
        {(1, 0): C10, (2, 0): C20, (3, 0): C30})),
    "reduced": ("REDUCED POLYNOMIAL, N=4", [C10, C20, C30, 1e-4], 4, "4,YEOH", polynomial(
        {(1, 0): C10, (2, 0): C20, (3, 0): C30, (4, 0): 1e-4})),
    "Ogden of Abaqus": ("OGDEN, N=3", [x for pair in OGDEN for x in pair], 3, "", ogden(
        OGDEN, lambda mu, alpha: 2 * mu / alpha**2)),
    "Ogden of Ansys": ("", [x for pair in OGDEN for x in pair], 3, "3,OGDEN", ogden(
        OGDEN, lambda mu, alpha: mu / alpha)),
}  # fmt: skip


@pytest.mark.parametrize("d", [0.1, 0.0, None])
@pytest.mark.parametrize("name", HYPERELASTIC)
def test_hyperelastic_solids_at_small_strains(tmp_path, name, d):
    """G by the strain energy, K = 2/D1, at time zero."""
    form, constants, volumes, kind, energy = HYPERELASTIC[name]
    numbers = [*constants, *([] if d is None else [d, *[0.0] * (volumes - 1)])]
    texts = []
    if form:
        rows = [", ".join(map(str, numbers[i : i + 8])) for i in range(0, len(numbers), 8)]
        head = f"*MATERIAL, NAME=gum\n*HYPERELASTIC, {form}, MODULI=INSTANTANEOUS\n"
        texts.append(head + "\n".join(rows) + "\n*VISCOELASTIC, TIME=PRONY\n0.4, , 0.02\n")
    if kind:
        data = "\n".join(f"TBDATA,{i + 1},{','.join(map(str, numbers[i : i + 6]))}"
                         for i in range(0, len(numbers), 6))  # fmt: skip
        texts.append(f"TB,HYPER,1,1,{kind}\n{data}\nTB,PRONY,1,1,1,SHEAR\nTBDATA,1,0.4,0.02\n")
    g = small_shear(energy)
    nu = (3 * 2 / d - 2 * g) / (2 * (3 * 2 / d + g)) if d else 0.5
    for text in texts:
        found = back(tmp_path, text)
        # the second difference has an error of h^2 and some 1e-10
        assert found.glassy_modulus == pytest.approx(2 * (1 + nu) * g, rel=1e-5)
        assert found.poisson_ratio == pytest.approx(nu, rel=1e-5)
        assert found.moduli[0] == pytest.approx(0.4 * found.glassy_modulus)
        assert any("read at small strains" in remark for remark in found.remarks)


def test_a_solid_that_is_soft_at_small_strains_is_refused(tmp_path):
    text = NEO.format("", "0.1").replace("NEO HOOKE", "MOONEY-RIVLIN")
    with pytest.raises(vcor.InputError, match=r"found C10 \+ C01 = -0.1 and D1 = 0.1"):
        back(tmp_path, text.replace(" 0.5, 0.1", " 0.2, -0.3, 0.1"))


def test_what_lsdyna_has_more_of(tmp_path):
    with pytest.raises(vcor.InputError, match=r":1: found \*MAT_OGDEN_RUBBER, expected"):
        back(tmp_path, "*MAT_OGDEN_RUBBER\n         1  1.00E-09\n")
    with pytest.raises(vcor.InputError, match=r"found a load curve \(LCID, LCIDK\)"):
        back(tmp_path, DYNA.format(second="        12"))


def test_a_material_is_named_as_in_the_deck(tmp_path):
    text = NEO.format("", "0.1").replace("NAME=gum", 'NAME="a, soft = gum"')
    for name in ("a, soft = gum", '"a, soft = gum"', None):
        found = back(tmp_path, text + text.replace("soft", "hard") * bool(name), material=name)
        assert found.name == "a, soft = gum"
        assert back(tmp_path, found.text("abaqus")).name == found.name


@pytest.mark.parametrize(
    "constants",
    [
        "TBDATA,1,0.30,0.02,0.25,0.0005,0.15,1.5e-05",
        "TBDATA,,0.30,0.02,\nTBDATA,,0.25,0.0005\nTBDATA,, 0.15 , 1.5e-05 ,",
        "TBTEMP,0\nTBDATA,1,0.30,0.02,\nTBDATA,,0.25,0.0005,,\nTBDATA,5,0.15,1.5e-05",
    ],
)
@pytest.mark.parametrize("elastic", ["", "MPTEMP,1,0\nMPDATA,EX,1,,4200.5,\nMPDATA,PRXY,1,1,0.38"])
def test_locations_of_ansys(tmp_path, constants, elastic):
    text = LOCATED.format("", constants)
    if elastic:
        text = elastic + "\n" + text[text.index("\nTB") :]
    found = back(tmp_path, text)
    assert found.equilibrium_modulus == pytest.approx(1260.15)
    assert found.moduli == pytest.approx([1260.15, 1050.125, 630.075])


@pytest.mark.parametrize(
    "text, says",
    [
        ("TBTEMP,20\nTBDATA,1,0.3,0.02\nTBTEMP,40\nTBDATA,1,0.2,0.02", "several temperatures"),
        ("TBDATA,9,0.3,0.02", "TBDATA,9"),
    ],
)
def test_what_ansys_has_more_of(tmp_path, text, says):
    with pytest.raises(vcor.InputError, match=says):
        back(tmp_path, LOCATED.format("", text))
    with pytest.raises(vcor.InputError, match="depends on temperature"):
        back(tmp_path, LOCATED.format("MPDATA,EX,1,1,4200.5,4100.0", "TBDATA,1,0.3,0.02"))


SHIFTED = {
    "abaqus": NEO.format("", "0.1") + "*TRS\n {}, 8.86, 101.6\n",
    "ansys": LOCATED.format("", "TBDATA,1,0.30,0.02,0.25,0.0005,0.15,1.5e-05")
    + "TB,SHIFT,1,1,3,WLF\nTBDATA,1,{},8.86,101.6\n",
}


@pytest.mark.parametrize("code", SHIFTED)
def test_degrees_celsius(tmp_path, code, capsys):
    """A reference temperature that is not in K is taken as degrees Celsius, with a remark."""
    for given, options in ((25, {}), (25, {"celsius": True}), (298.15, {}), (-10, {})):
        (tmp_path / "card.inp").write_text(SHIFTED[code].format(given))
        found = vcor.read_card(tmp_path / "card.inp", code=code, **options)
        kelvin = given + (273.15 if given < 100 else 0)
        assert found.shift["reference_temperature"] == pytest.approx(kelvin)
        said = any("not in K: taken as degrees Celsius" in one for one in found.remarks)
        assert said == (given < 100 and not options)
    _command.call("card", [str(tmp_path / "card.inp"), "--for", code])
    assert "taken as degrees Celsius" in capsys.readouterr().err


@pytest.mark.parametrize("code", ["abaqus", "ansys", "lsdyna", "comsol"])
def test_cards_in_degrees_celsius(tmp_path, code):
    """They state the unit, and are read back."""
    shift = {"shift": "wlf", "reference_temperature": 298.15, "wlf_c1": 8.0, "wlf_c2": 90.0}
    made = Card("gum", 0.4, 1e6, (2e6,), (1e-3,), 1100.0, shift)
    text = made.text(code, celsius=True)
    assert "temperatures in C" in text and "298.15" not in text
    found = back(tmp_path, text, code=code)
    assert found.shift["wlf_c1"] == pytest.approx(8.0)
    assert found.shift["reference_temperature"] == pytest.approx(298.15)
    (tmp_path / "k.inp").write_text(made.text(code))
    with pytest.raises(vcor.InputError, match="kelvin, found celsius=True"):
        vcor.read_card(tmp_path / "k.inp", code=code, celsius=True)
    with pytest.raises(vcor.UsageError, match="celsius=True is for the WLF shift"):
        Card("gum", 0.4, 1e6, (2e6,), (1e-3,), 1100.0).text(code, celsius=True)
