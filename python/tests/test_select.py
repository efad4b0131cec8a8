"""Rows of a file that the user takes, and what is advised where they must."""

import math

import numpy as np
import pandas as pd
import pytest

import vcor
from vcor import _command
from vcor.materials.data import curves, read_data
from vcor.materials.observations import observations
from vcor.materials.select import Condition, conditions
from vcor.materials.tables import Choice

BALLS = """ball,Run,h0 [cm],h1 [cm]
golf,1,50,36
tennis,1,50,26
golf,2,100,72
tennis,2,100,52
Golf,3,150,105
tennis,3,150,75
"""


def write(tmp_path, text, name="data.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(("where", "heights"), [
    ({"ball": "golf"}, [36, 72, 105]), ("ball = GOLF", [36, 72, 105]),
    ("ball!=golf", [26, 52, 75]), ("1=tennis", [26, 52, 75]), ({"Run": 2}, [72, 52]),
    ("Run=2.0", [72, 52]), ("Run!=2", [36, 26, 105, 75]), ("h0=60:120", [72, 52]),
    ("h0 [cm]=:100", [36, 26, 72, 52]), ("h0=100:", [72, 52, 105, 75]), ("h0!=60:", [36, 26]),
    (["ball=golf", "Run!=1"], [72, 105]), ("line=2:4", [36, 26, 72]), ("line!=2:6", [75]),
])  # fmt: skip
def test_rows_by_words_and_numbers(tmp_path, where, heights):
    data = read_data(write(tmp_path, BALLS), where=where)
    assert list(100 * data.rebound_height) == pytest.approx(heights)
    assert f"({len(heights)} of 6 rows)" in data.attrs["taken"]


def test_words_are_shown_with_the_option_that_takes_one(tmp_path):
    """The hint that the report gives is true."""
    taken = read_data(write(tmp_path, BALLS.replace("Golf", "golf"))).attrs["taken"]
    assert taken.endswith("ball (golf, tennis: where={'ball': 'golf'} takes one), Run")
    again = read_data(tmp_path / "data.csv", where={"ball": "golf"})
    assert len(again) == 3 and again.attrs["taken"].endswith("; not taken: ball, Run")
    remarks = "v [m/s],cor,Remark\n1,0.5,late\n2,0.4,\n3,0.4,wet\n4,0.3,cold\n"
    assert read_data(write(tmp_path, remarks)).attrs["taken"].endswith("; not taken: Remark")


@pytest.mark.parametrize(("where", "said"), [
    ("ball=foot", "found no row with 'ball=foot', expected one of 'golf', 'tennis', 'Golf'"),
    ("bal=golf", "has no column 'bal'"), ("Run=7", "expected one of '1', '2', '3'"),
    ("line=20:30", "expected one of '2 to 7'"), ("ball", "expected COLUMN=VALUE"),
    (["Run=1", "Run=2"], "no row with 'Run=2'"), ("sheet=1", "has no column 'sheet'"),
    ("temperature=20C", "has no column 'temperature'"),
])  # fmt: skip
def test_refused(tmp_path, where, said):
    with pytest.raises(vcor.UsageError) as caught:
        read_data(write(tmp_path, BALLS), where=where)
    assert said in str(caught.value) and len(str(caught.value)) < 300 + len(str(tmp_path))


LABELS = "".join(
    f"T = {t} °C\nf [Hz],E' [MPa],E'' [MPa]\n1,{5 + i},1\n10,{6 + i},1\n100,{8 + i},1\n"
    for i, t in enumerate((-20, 0, 20))
)


@pytest.mark.parametrize(("where", "celsius"), [
    ("temperature!=-20C", [0, 20]), ("temperature=-20 °C", [-20]), ("temperature=253K", [-20]),
    ("temperature=-5C:50C", [0, 20]), ("temperature!=-5C:5C", [-20, 20]),
    ("temperature=:0C", [-20, 0]),
])  # fmt: skip
def test_temperatures(tmp_path, where, celsius):
    column = "T [C],f [Hz],E' [MPa],E'' [MPa]\n" + "".join(
        f"{t},{f},{5 + i},1\n" for i, t in enumerate((-20, 0, 20)) for f in (1, 10, 100)
    )
    for text in (LABELS, column):
        found = curves(read_data(write(tmp_path, text), where=where))
        assert [one.attrs["temperature"] - 273.15 for one in found] == pytest.approx(celsius)


def test_temperatures_that_are_not_there(tmp_path):
    path = write(tmp_path, LABELS)
    with pytest.raises(vcor.UsageError, match="expected one of '-20C', '0C', '20C'"):
        read_data(path, where="temperature=50C")
    with pytest.raises(vcor.UsageError, match="expected temperatures such as -20C or 253K"):
        read_data(path, where="temperature=50")


def test_a_sheet_of_a_workbook(tmp_path):
    path = tmp_path / "book.xlsx"
    moduli = pd.DataFrame({"t [s]": [1, 2, 3], "E [MPa]": [3, 2, 1]})
    with pd.ExcelWriter(path) as book:
        moduli.to_excel(book, sheet_name="rubber", index=False)
        pd.DataFrame({"T [C]": [0, 20], "a_T": [10, 1]}).to_excel(book, sheet_name="shift")
        (10 * moduli).to_excel(book, sheet_name="glass", index=False)
    with pytest.raises(vcor.InputError, match=r"or where=\{'sheet': 'rubber'\}"):
        read_data(path)
    assert list(read_data(path, where={"sheet": "rubber"}).time) == [1, 2, 3]
    assert list(read_data(path, where={"sheet": "Glass"}).time) == [10, 20, 30]
    assert read_data(path, where="sheet=shift").attrs["kind"] == "shift"
    assert len(read_data(path, where="sheet!=shift")) == 6
    with pytest.raises(vcor.UsageError, match="expected one of 'rubber', 'shift', 'glass'"):
        read_data(path, where="sheet=steel")


def test_a_condition_counts_in_the_files_that_have_its_column(tmp_path):
    head = "Sample,f [Hz],E' [MPa],E'' [MPa]\n"
    names = []
    for i, t in enumerate((0, 20, 40)):
        rows = [f"{s},{f},{m * 2 * (f / 10**i) ** 0.3},{m * (f / 10**i) ** 0.3}\n"
                for s, m in (("A", 1), ("B", 3)) for f in (1, 3, 10, 30, 100)]  # fmt: skip
        text = head + "".join(rows) if i < 2 else (
            "f [Hz],E' [MPa],E'' [MPa]\n" + "".join(row[2:] for row in rows[:5]))  # fmt: skip
        names.append(f"{write(tmp_path, text, f'{t}.csv')}@{t}C")
    with pytest.raises(vcor.InputError, match="found a frequency"):
        vcor.master(names)
    found = vcor.master(names, where="Sample=A")
    assert found.log_shift == pytest.approx([1, 0, -1], abs=0.05)
    with pytest.raises(vcor.UsageError, match="the files have no column 'Probe'"):
        vcor.master(names, where=["Sample=A", "Probe=A"])


def test_words_as_sets(tmp_path):
    text = "Sample,t [s],E [Pa]\n" + "".join(
        f"{name},{t},{factor / t**0.1}\n"
        for name, factor in (("A", 1e6), ("B", 3e6), ("C", 1.02e6))
        for t in (1, 2, 3)
    )  # fmt: skip
    found = curves(read_data(write(tmp_path, text), {"set": "Sample"}))
    # B differs, A and C are replicates
    assert [len(one) for one in found] == [6, 3]


def test_the_option(tmp_path, capsys):
    path = write(tmp_path, LABELS.replace("f [Hz],E' [MPa],E'' [MPa]", "t [s],E [MPa],x"))
    for words in (["--where", "temperature=0C"], ["--where", "T=0C"]):
        if "T=0C" in words:
            with pytest.raises(SystemExit) as ended:
                _command.call("table", [str(path), *words])
            assert ended.value.code == 2
            assert "--where: " in capsys.readouterr().err
        else:
            with pytest.raises(SystemExit) as ended:
                _command.call("table", [str(path)])
            assert ended.value.code == 2
            capsys.readouterr()
            _command.call("table", [str(path), *words, "--quiet"])
            assert capsys.readouterr().out.splitlines()[1:] == [
                "1.0,6000000.0", "10.0,7000000.0", "100.0,9000000.0"
            ]  # fmt: skip


def test_conditions_that_are_read():
    (one,) = conditions("a b != c")
    assert one == Condition("a b", "c", negated=True) and str(one) == "a b!=c"
    assert conditions(None) == [] and len(conditions({"a": 1, "b": "c"})) == 2


# -------------------------------------------------------------------------- what is refused


def pulses(starts, width=2e-3, step=1e-4, end=0.6):
    time = np.arange(0, end, step)
    force = np.zeros(len(time))
    for i, start in enumerate(starts):
        x = (time - start) / width
        force += np.where((x > 0) & (x < 1), 100 * 0.7**i * np.sin(np.pi * np.clip(x, 0, 1)), 0)
    force += 0.1 * np.random.default_rng(2).standard_normal(len(time))
    rows = "".join(f"{1e3 * t:.6g},{f:.6g}\n" for t, f in zip(time, force, strict=True))
    return "t [ms],F [N]\n" + rows


def test_a_record_of_several_impacts(tmp_path, sls):
    """Each is a record of its own, at the velocity that the flight before it ends with."""
    path = write(tmp_path, pulses([0.01, 0.3, 0.5]))
    found = observations(sls, path, ["rubber.beta"])
    speeds = [one.settings["impact.velocity"] for one in found]
    # flights of 288 ms and 198 ms
    assert speeds == pytest.approx([10.0, 9.80665 * 0.144, 9.80665 * 0.099], rel=3e-3)
    assert [round(one.scale[0]) for one in found] == pytest.approx([100, 70, 49], abs=2)
    assert all(np.ptp(one.at) < 0.02 for one in found)
    assert found[0].taken.endswith("; 3 impacts at 10, 1.412, 0.9709 m/s, by the times in flight")
    # as columns, and with a sensor that is turned
    data = read_data(path)
    columns = {"time": data.time.to_numpy(), "force": -data.force.to_numpy()}
    assert [one.turned for one in observations(sls, columns, ["rubber.beta"])] == [True] * 3
    # contacts that follow one another belong to one impact, and so does a record of one
    for starts in ([0.01, 0.014, 0.02], [0.2]):
        (one,) = observations(sls, write(tmp_path, pulses(starts)), ["rubber.beta"])
        assert len(one.at) == 6000


def test_a_record_of_repeated_drops(tmp_path, sls):
    """Their velocities are in a column, or only one of them can be taken."""
    sls["impact.velocity"] = 1.0
    path = write(tmp_path, pulses([0.01, 0.3, 0.5]))
    with pytest.raises(vcor.InputError, match=r"data.csv:30\d\d: found impact 2 of 3") as caught:
        observations(sls, path, ["rubber.beta"])
    assert "at 1.41 m/s by its time in flight after 1 m/s" in str(caught.value)
    # the advice leads to one impact
    line = str(caught.value).partition("{'line': '")[2].partition("'}")[0]
    (one,) = observations(sls, path, ["rubber.beta"], Choice(None, None, where={"line": line}))
    assert one.value.max() > 95 and 0.1 < one.at[-1] < 0.3
    head, *rows = pulses([0.01, 0.3]).splitlines()
    speeds = ["1.5" if float(row.split(",")[0]) < 200 else "1.6" for row in rows]
    rows = [f"{row},{speed}" for row, speed in zip(rows, speeds, strict=True)]
    path = write(tmp_path, "\n".join([f"{head},velocity [m/s]", *rows]))
    found = observations(sls, path, ["rubber.beta"])
    assert [one.settings["impact.velocity"] for one in found] == [1.5, 1.6]
    assert "1.5, 1.6 m/s, of their column" in found[0].taken


@pytest.mark.parametrize(("head", "said"), [
    ("t [s],J(t) [1/Pa]", "n = d ln J/d ln t"), ("t [s],J [1/MPa]", "n = d ln J/d ln t"),
    ("time [s],Creep compliance [1/MPa]", "E(t) = sin(pi n)/(pi n J(t))"),
    ("Zeit [s];Kriechnachgiebigkeit [1/Pa]", "E(t) = "),
    ("f [Hz],J' [1/Pa],J'' [1/Pa]", "E'' = J''/(J'^2 + J''^2)"),
])  # fmt: skip
def test_compliances(tmp_path, head, said):
    mark = ";" if ";" in head else ","
    rows = "".join(mark.join(["1", "2", "3"][: head.count(mark) + 1]) + "\n" for _ in range(2))
    with pytest.raises(vcor.InputError, match="found the compliance 'J|found the compliance '[CK]"):
        read_data(write(tmp_path, f"{head}\n{rows}"))
    try:
        read_data(tmp_path / "data.csv")
    except vcor.InputError as error:
        assert said in str(error) and "expected moduli" in str(error)


def test_the_advised_law_is_exact_for_a_power_law():
    """A creep test of E(t) = C t^-n has J(t) = t^n sin(pi n)/(pi n C)."""
    n, time = 0.3, np.array([1e-3, 1.0])
    # s^2 L(E) L(J) = 1 with L(t^-n) = Gamma(1 - n) s^(n - 1), L(t^n) = Gamma(1 + n) s^(-1 - n)
    compliance = time**n / (math.gamma(1 - n) * math.gamma(1 + n))
    assert math.sin(math.pi * n) / (math.pi * n * compliance) == pytest.approx(time**-n, rel=1e-12)


# ------------------------------------------------------------------------------ side by side


HERTZ = np.geomspace(0.1, 100, 8)


def columns_of(head, *columns):
    rows = [",".join(f"{x:.6g}" for x in row) for row in zip(*columns, strict=True)]
    return "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize("head", [
    "f [Hz],E' [Pa],E'' [Pa],E' [Pa],E'' [Pa]",
    "f [Hz],E'_1 [Pa],E''_1 [Pa],E'_2 [Pa],E''_2 [Pa]",
    "f [Hz],Storage modulus (1) [Pa],Loss modulus (1) [Pa],Storage modulus (2) [Pa],"
    "Loss modulus (2) [Pa]",
    "f [Hz],Run 1: E' [Pa],Run 1: E'' [Pa],Run 2: E' [Pa],Run 2: E'' [Pa]",
    "f [Hz],E' rep 3 [Pa],E'' rep 3 [Pa],E' rep 5 [Pa],E'' rep 5 [Pa]",
    "f [Hz],Rep 1,,Rep 2,\n,E' [Pa],E'' [Pa],E' [Pa],E'' [Pa]",
])  # fmt: skip
def test_replicates_side_by_side(tmp_path, head):
    """Each is a run of its own; the frequencies of one column are those of all."""
    storage, loss = 1e6 * (1 + HERTZ), 5e5 * (1 + HERTZ**0.5)
    text = columns_of(head, HERTZ, storage, loss, 1.02 * storage, 0.97 * loss)
    data = read_data(write(tmp_path, text))
    assert "2 runs are one curve" in data.attrs["taken"]
    (one,) = curves(data)
    first, second = (one[one["set"] == run] for run in (0, 1))
    assert np.allclose(first.storage_modulus, storage, rtol=1e-5)
    assert np.allclose(second.storage_modulus, 1.02 * storage, rtol=1e-5)
    assert np.allclose(second.loss_modulus, 0.97 * loss, rtol=1e-5)
    # as they would be one below the other
    assert np.allclose(first.frequency, second.frequency)


def test_replicates_with_their_own_frequencies_and_failed_points(tmp_path):
    storage, loss = 1e6 * (1 + HERTZ), 5e5 * (1 + HERTZ**0.5)
    head = "f_1 [Hz],E'_1 [Pa],E''_1 [Pa],f_2 [Hz],E'_2 [Pa],E''_2 [Pa],Average E' [Pa]"
    text = columns_of(head, HERTZ, storage, loss, 1.1 * HERTZ, 1.02 * storage, loss, storage)
    lines = text.splitlines()
    lines[3] = lines[3].rsplit(",", 3)[0] + ",---,---,5"
    (one,) = curves(read_data(write(tmp_path, "\n".join(lines))))
    assert len(one) == 15 and one.attrs["runs"] == 2
    second = one[one["set"] == 1]
    assert np.allclose(second.frequency, np.delete(2 * np.pi * 1.1 * HERTZ, 2), rtol=1e-5)


@pytest.mark.parametrize("head", [
    "drop height [cm],rebound height trial 1 [cm],rebound height trial 2 [cm]",
    "drop height [cm],Trial 1 rebound height [cm],Trial 2 rebound height [cm]",
    "drop height [cm],rebound height (run 1) [cm],rebound height (run 2) [cm]",
])  # fmt: skip
def test_trials_of_impacts_side_by_side(tmp_path, head):
    data = read_data(write(tmp_path, head + "\n50,30,31\n100,58,60\n"))
    assert data.drop_height.tolist() == pytest.approx([0.5, 1.0, 0.5, 1.0])
    assert data.rebound_height.tolist() == pytest.approx([0.3, 0.58, 0.31, 0.6])


@pytest.mark.parametrize("head", [
    "drop height [cm],h_2 [cm],h_3 [cm]", "drop height [cm],rebound height 1 [cm],bounce 2 [cm]",
    "drop height [cm],rebound height [cm],rebound height [cm]",
])  # fmt: skip
def test_bounces_one_after_the_other_are_no_trials(tmp_path, head):
    with pytest.raises(vcor.InputError):
        read_data(write(tmp_path, head + "\n50,30,31\n100,58,60\n"))


def test_the_average_of_trials_is_none(tmp_path):
    head = "v [m/s],cor (trial 1),cor (trial 2),Average cor\n1,0.8,0.82,0.81\n2,0.7,0.72,0.71\n"
    data = read_data(write(tmp_path, head))
    assert data.cor.tolist() == [0.8, 0.7, 0.82, 0.72] and "Average cor" in data.attrs["taken"]


# ----------------------------------------------------------------------------- steps of strain


@pytest.mark.parametrize(("head", "strain"), [
    ("time [s],stress [MPa],strain [%]", 2.0), ("Zeit [s],Spannung [MPa],Dehnung", 0.02),
    ("t [s],compressive stress [MPa],compressive strain [%]", 2.02),
])  # fmt: skip
def test_a_step_of_strain(tmp_path, head, strain):
    """The modulus is the stress over the strain, which a machine holds to some percent."""
    stress = 0.5 / (1 + HERTZ)
    text = columns_of(head, HERTZ, stress, np.where(HERTZ < 1, strain, 0.98 * strain))
    data = read_data(write(tmp_path, text))
    share = 0.01 if strain == 2.02 else 0.0
    found = data.relaxation_modulus.to_numpy() / (1e6 * stress / 0.02)
    expected = np.where(HERTZ < 1, 1, 1 / 0.98) / (1 + share)
    assert data.attrs["kind"] == "relaxation" and found == pytest.approx(expected, rel=1e-5)
    assert " over " in data.attrs["taken"] and not {"stress", "strain"} & {*data}


@pytest.mark.parametrize("more", ["f [Hz]", "Phase angle [deg]", "tan delta"])
def test_amplitudes_of_an_oscillation_are_no_step(tmp_path, more):
    head, one = f"time [s],stress [Pa],strain [%],{more}", 0 * HERTZ + 1
    with pytest.raises(vcor.InputError):
        read_data(write(tmp_path, columns_of(head, HERTZ, 1 / HERTZ, one, HERTZ)))


def test_shear_stress_makes_shear_moduli(tmp_path):
    text = columns_of("t [s],shear stress [Pa],shear strain [%]", HERTZ, 1 / HERTZ, 0 * HERTZ + 1)
    assert read_data(write(tmp_path, text)).attrs["shear"] is True


@pytest.mark.parametrize(("head", "stress", "strain", "says"), [
    ("t [s],stress [Pa],strain [%]", 0 * HERTZ + 5, 1 + HERTZ, "of a creep test, whose compliance"),
    ("t [s],stress [Pa],strain [%]", 1 + HERTZ, 1 + HERTZ, "after a step of strain; where="),
    ("t [s],stress [Pa],x", 1 + HERTZ, HERTZ, "a column strain [%] beside it"),
    ("t [s],x,strain [%]", HERTZ, 1 + HERTZ, "strain over the stress is the compliance"),
    ("x,stress [Pa],strain [%]", 1 + HERTZ, 1 + HERTZ, "no column of the time"),
])  # fmt: skip
def test_stress_and_strain_that_make_no_modulus(tmp_path, head, stress, strain, says):
    with pytest.raises(vcor.InputError) as caught:
        read_data(write(tmp_path, columns_of(head, HERTZ, stress, strain)))
    assert says in str(caught.value)


def test_samples_by_a_column_of_words(tmp_path):
    """Curves of two materials are not one: the message says how one is taken."""
    rows = [f"{name},{f:.6g},{size * (1 + f):.6g},{size:.6g}" for name, size in (("A", 1), ("B", 2))
            for f in HERTZ]  # fmt: skip
    path = write(tmp_path, "\n".join(["polymer,f [Hz],E' [MPa],E'' [MPa]", *rows]))
    with pytest.raises(vcor.InputError, match=r"where={'polymer': 'A'} takes one of several"):
        curves(read_data(path))
    (one,) = curves(read_data(path, where={"polymer": "B"}))
    assert np.allclose(one.loss_modulus, 2e6)
