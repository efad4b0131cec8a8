"""Rows of a file that the user takes, and what is advised where they must."""

import math

import numpy as np
import pandas as pd
import pytest

import vcor
from vcor import _command
from vcor.materials.data import curves, read_data
from vcor.materials.observations import read_columns
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
    path = write(tmp_path, pulses([0.01, 0.3, 0.5]))
    with pytest.raises(vcor.InputError, match=r"data.csv:30\d\d: found impact 2 of 3") as caught:
        read_columns(path, sls)
    # the advice leads to one impact
    line = str(caught.value).partition("{'line': '")[2].partition("'}")[0]
    columns, _, _ = read_columns(path, sls, (), Choice(None, None, where={"line": line}))
    assert columns["force"].max() > 95 and 0.1 < columns["time"][-1] < 0.3
    head, *rows = pulses([0.01, 0.3]).replace(",", ",-").replace("--", "").splitlines()
    negative = write(tmp_path, "\n".join([head.replace("-", ""), *rows]))
    with pytest.raises(vcor.InputError, match="found impact 2 of 2"):
        read_columns(negative, sls)
    # contacts that follow one another belong to one impact, and so does a record of one
    for starts in ([0.01, 0.014, 0.02], [0.2]):
        assert len(read_columns(write(tmp_path, pulses(starts)), sls)[0]["time"]) == 6000


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
