"""Temperatures in words: each is read right, or refused."""

import itertools
import math
import os

import numpy as np
import pandas as pd
import pytest
from properties import assume, given, settings, st

import vcor
from vcor.materials.data import curves, read_data
from vcor.materials.labels import read_label

HERTZ = np.geomspace(0.1, 100, 5)
NAMES = ["f [Hz]", "E' [MPa]", "E'' [MPa]"]
#: What the forms are made of; a hyphen next to a letter or between blanks may be a dash
SIGNS = ["", "-", "−", "–", "+", "minus ", "- ", "− "]
WORDS = ["", "T", "Temp.", "Temperature", "Temperatur", "Température", "温度", "Step 2", "Isotherm",
         "sample temperature", "T1", "at"]  # fmt: skip
BETWEEN = ["", " ", " = ", "=", ": ", ":", " at ", "_", ", ", " - ", "("]
UNITS = [" °C", "°C", "C", " C", " K", " degC", " ℃", " ºC", "° C"]


def is_other(word, between, sign):
    """Whether the digits of a word and of the value are one number."""
    return word[-1:].isdigit() and between + sign == ""


def form(word, between, sign, value, unit):
    """A label, and the temperature [K] that it states."""
    text = f"{word}{between}{sign}{value}{unit}" + ")" * (between == "(")
    size = -value if sign.strip() in ("-", "−", "–", "minus") else value
    return text, size + (0 if "K" in unit else 273.15)


def numbers(i):
    """Frequencies, storage and loss moduli of a set, in the units of NAMES."""
    return [HERTZ, (2 + i) * (1 + HERTZ), 0.1 * (1 + i) * (1 + HERTZ)]


def rows(i, mark=","):
    return [mark.join(f"{x:.6g}" for x in row) for row in zip(*numbers(i), strict=True)]


def holds(data, kelvin):
    """Whether the sets are what was written, at these temperatures."""
    found = curves(data)
    assert [one.attrs["temperature"] for one in found] == pytest.approx(kelvin, abs=1e-6)
    for i, one in enumerate(found):
        assert np.allclose(one.storage_modulus, 1e6 * numbers(i)[1], rtol=1e-5)
    return True


def test_every_form_is_read_right_or_refused():
    read = total = 0
    for word, between, sign, value, unit in itertools.product(
        WORDS, BETWEEN, SIGNS, (20, 7.5, 120), UNITS
    ):
        if is_other(word, between, sign):
            continue
        text, kelvin = form(word, between, sign, value, unit)
        label = read_label(text)
        total += 1
        if math.isfinite(label.kelvin):
            read += 1
            # `T - 20 C` is refused; with a sign behind the dash it is none
            assert label.kelvin == pytest.approx(kelvin, abs=1e-9), text
    assert read > total / 2


READ = ["T = {} °C", "{} °C", "Temperature: {} °C", "T={}C", "({} °C)", "Step 1: {} °C", "T: {}°C",
        "isotherm at {} °C", "T [°C] = {}", "Temperatur {} °C", "Temperature (°C): {}", "{}C",
        "T,{},°C", "Temperature [°C],{}", "--- {} °C ---", "T_{}C"]  # fmt: skip


@pytest.mark.parametrize("sign", ["", "-", "−", "–"])
@pytest.mark.parametrize("text", READ)
def test_forms_that_are_read(text, sign):
    label = read_label(text.format(f"{sign}20"))
    assert label.kelvin == pytest.approx(253.15 if sign else 293.15)


@pytest.mark.parametrize("text", ["T - 20 °C", "T-20 °C", "- 20 °C", "Step 1 - 20 °C", "T--20 C",
                                  "Temperature — 20 °C", "T = -300 °C", "T [°C]-20"])  # fmt: skip
def test_forms_that_are_not_sure(text, tmp_path):
    assert read_label(text).flaw
    path = tmp_path / "data.csv"
    path.write_text("\n".join([text, ",".join(NAMES), *rows(0)]))
    with pytest.raises(vcor.InputError, match=r"data.csv:1: found '") as caught:
        read_data(path)
    assert "expected" in str(caught.value)


@pytest.mark.parametrize("text", [
    "Storage temperature 23 °C", "10-20 °C", "Step 1: 20 to 30 °C", "Temperature limit,620 [°C]",
    "3 K/min", "20 °C,0.1,5,1", "f [Hz] 20 °C", "T = 20 °C, then 30 °C", "aT 20 °C",
])  # fmt: skip
def test_lines_that_are_no_labels(text):
    assert not read_label(text)


def test_a_label_without_a_unit(tmp_path):
    path = tmp_path / "data.csv"
    block = [",".join(NAMES), *rows(0)]
    path.write_text("\n".join(["T = 5", *block]))
    assert "temperature" not in read_data(path)
    path.write_text("\n".join(["T = 293", *block]))
    assert np.allclose(read_data(path).temperature, 293)
    path.write_text("\n".join(["T = -20", *block, "T = 20", *block]))
    with pytest.raises(vcor.InputError, match=r"data.csv:1: .* without a unit"):
        read_data(path)


@settings(max_examples=400 if "VCOR_ALL_TESTS" in os.environ else 200)
@given(
    word=st.sampled_from(WORDS),
    between=st.sampled_from(BETWEEN),
    sign=st.sampled_from(SIGNS),
    unit=st.sampled_from(UNITS),
    place=st.sampled_from(["line", "cells", "remark", "beside", "names"]),
    head=st.sampled_from(["once, before", "once, below", "each, before", "each, below"]),
    mark=st.sampled_from([",", ";", "\t", "  "]),
    blank=st.booleans(),
)
def test_files_are_read_right_or_refused(
    tmp_path, word, between, sign, unit, place, head, mark, blank
):
    assume(not is_other(word, between, sign))
    assume(not (mark == "  " and place in ("beside", "cells")))
    values = [20, 30, 40]
    told = [form(word, between, sign, value, unit) for value in values]
    names = mark.join(NAMES)
    if place in ("beside", "names"):
        lines = [mark.join(f"{text}{mark}{mark}" for text, _ in told)] * (place == "beside")
        named = [[NAMES[0], *(f"{one} {text}" * (place == "names") for one in NAMES[1:])]
                 for text, _ in told]  # fmt: skip
        lines.append(names + 2 * (mark + names) if place == "beside" else
                     mark.join(cell for one in named for cell in one))  # fmt: skip
        lines += map(mark.join, zip(*[rows(i, mark) for i in range(3)], strict=True))
    else:
        lines = []
        for i, (text, _) in enumerate(told):
            label = {"remark": "# ", "line": "", "cells": ""}[place] + text
            if place == "cells":
                label = label.replace(" ", mark)
            own = i == 0 or head.startswith("each")
            lines += [""] * blank + ([label, names] if head.endswith("below") else [names, label])[
                0 if own else int(head.endswith("before")) :
            ][: 2 if own else 1]
            lines += rows(i, mark)
    path = tmp_path / "data.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    try:
        data = read_data(path)
        curves(data)
    except vcor.InputError as error:
        assert "\n" not in str(error)
        return
    holds(data, [kelvin for _, kelvin in told])


def written(tmp_path, lines):
    path = tmp_path / "data.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    return read_data(path)


@pytest.mark.parametrize("mark", [",", ";", "\t"])
@pytest.mark.parametrize("text", [
    "T = {} °C", "# T = {} °C", "T{mark}{}{mark}°C", "{} °C{mark}{mark}", "T [°C]{mark}{}",
    "#Temperature: {} C", "Step 3: {} °C",
])  # fmt: skip
@pytest.mark.parametrize("repeated", [True, False])
def test_blocks_with_the_head_once_or_each(tmp_path, text, mark, repeated):
    lines = []
    for i, value in enumerate(("-20", "−10", "0")):
        lines.append(text.format(value, mark=mark))
        lines += [mark.join(NAMES)] * (repeated or i == 0) + rows(i, mark)
    data = written(tmp_path, lines)
    holds(data, [253.15, 263.15, 273.15])
    assert data.attrs["taken"].endswith("; 3 sets: 5 points at -20 C, 5 at -10 C, 5 at 0 C")


@pytest.mark.parametrize("text", ["Probe {1} at {0} °C", "{0} to 90 °C", "heated to {0} °C"])
def test_temperatures_among_other_words(tmp_path, text):
    """They are refused above several sets, and left alone above one."""
    head = ",".join(NAMES)
    lines = [text.format(20, "A"), head, *rows(0)]
    assert "temperature" not in written(tmp_path, lines)
    with pytest.raises(vcor.InputError, match="data.csv:1: found .* their temperature alone"):
        written(tmp_path, [*lines, text.format(30, "B"), head, *rows(1)])
    column = ",".join(["T [C]", *NAMES])
    lines = [text.format(20, "A"), column, *(f"20,{row}" for row in rows(0))]
    lines += [text.format(30, "B"), column, *(f"30,{row}" for row in rows(1))]
    holds(written(tmp_path, lines), [293.15, 303.15])


def test_blanks_between_the_columns(tmp_path):
    lines = []
    for i, value in enumerate((-20, 0)):
        lines += [
            f"T = {value} °C",
            *["f   E'   E''", "Hz   MPa   MPa"][: 2 * (i == 0)],
            *rows(i, "   "),
        ]
    holds(written(tmp_path, lines), [253.15, 273.15])


@pytest.mark.parametrize("text", ["{} °C", "T = {} °C", "({} °C)", "T={}C"])
def test_blocks_side_by_side(tmp_path, text):
    above = ",".join(f"{text.format(value)},," for value in ("-20", "−10", "10"))
    lines = [above, ",".join(NAMES * 3)]
    lines += map(",".join, zip(*[rows(i) for i in range(3)], strict=True))
    holds(written(tmp_path, lines), [253.15, 263.15, 283.15])
    heads = [f"{name} {text.format(value)}" for value in ("-20", "−10", "10") for name in NAMES]
    holds(written(tmp_path, [",".join(heads), *lines[2:]]), [253.15, 263.15, 283.15])


def test_a_block_without_a_temperature_beside_others(tmp_path):
    lines = [",,,-20 °C,,", ",".join(NAMES * 2)]
    lines += map(",".join, zip(*[rows(i) for i in range(2)], strict=True))
    with pytest.raises(vcor.InputError, match="without a temperature next to"):
        written(tmp_path, lines)
    lines[0] = "T [C],–20,–20,–10,–10,–10"
    with pytest.raises(vcor.InputError, match=":1: found '–20', expected a temperature"):
        written(tmp_path, lines)


def test_some_sets_without_a_temperature(tmp_path):
    head = ",".join(NAMES)
    with pytest.raises(vcor.InputError, match=r"data.csv:9: .* without a temperature.* line 3"):
        written(tmp_path, ["T = 20 °C", head, *rows(0), head, *rows(1)])


def test_names_of_sheets(tmp_path):
    path = tmp_path / "data.xlsx"
    for form_of in ("{} °C", "T={}°C", "({} °C)", "T_{}C", "Sheet {} C"):
        with pd.ExcelWriter(path) as book:
            for i, value in enumerate(("-20", "−10", "5")):
                frame = pd.DataFrame(dict(zip(NAMES, numbers(i), strict=True)))
                frame.to_excel(book, sheet_name=form_of.format(value), index=False, header=i < 2)
        holds(read_data(path), [253.15, 263.15, 278.15])


def test_names_of_sheets_that_are_numbers(tmp_path):
    """A title is no row of numbers, on a sheet with data or without."""
    path = tmp_path / "data.xlsx"
    for name, other in itertools.product(("2", "0.5", "2020", "-1"), (None, "remark")):
        with pd.ExcelWriter(path) as book:
            times = pd.DataFrame({"Event time (s)": [0.5, 1.11, 1.56, 1.89]})
            times.to_excel(book, sheet_name="data", index=False)
            pd.DataFrame({other: []} if other else {}).to_excel(book, sheet_name=name, index=False)
        assert np.allclose(read_data(path).bounce_time, [0.61, 0.45, 0.33])
        with pd.ExcelWriter(path) as book:
            for i, title in enumerate(("1", name)):
                frame = pd.DataFrame(dict(zip(NAMES, numbers(i), strict=True)))
                frame.to_excel(book, sheet_name=title, index=False, startrow=1)
                book.sheets[title]["A1"] = f"T = {20 + 10 * i} °C"
        holds(read_data(path), [293.15, 303.15])


def test_numbers_below_the_name_of_a_sheet(tmp_path):
    path = tmp_path / "data.xlsx"
    with pd.ExcelWriter(path) as book:
        for i, title in enumerate(("first", "second")):
            frame = pd.DataFrame(dict(zip(NAMES, numbers(i), strict=True)))
            frame.to_excel(book, sheet_name=title, index=False, header=i == 0)
    with pytest.raises(vcor.InputError, match="below 'second', expected a head"):
        read_data(path)


# ------------------------------------------------------------------- rows that lack a cell

KINDS = {
    "moduli": (["t [s]", "f [Hz]", "strain [%]", "E' [MPa]", "E'' [MPa]", "torque [uNm]"], 4),
    "relaxation": (["T [C]", "t [s]", "stress [Pa]", "E(t) [MPa]"], 3),
    "shift factors": (["T [C]", "log10 a_T", "n"], 2),
    "record": (["time [ms]", "x [mm]", "force [N]"], 2),
    "impacts": (["Nr", "velocity [m/s]", "cor", "contact_time [ms]"], 3),
    "bounces": (["n", "bounce_time [s]", "No"], 2),
}


@pytest.mark.parametrize("mark", [",", ";", "\t", "  "])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("every", [True, False])
def test_rows_with_fewer_cells_than_names(tmp_path, kind, mark, every):
    names, _ = KINDS[kind]
    full = [
        [f"{(0.9 - 0.1 * i) * (1 + 0.01 * j):.4g}" for j in range(len(names))] for i in range(6)
    ]
    for missing in range(len(names)):
        short = [[cell for j, cell in enumerate(row) if j != missing or not (every or i == 3)]
                 for i, row in enumerate(full)]  # fmt: skip
        with pytest.raises(vcor.InputError) as caught:
            written(tmp_path, [mark.join(names), *map(mark.join, short)])
        if not every:
            assert "data.csv:5: found" in str(caught.value)
            assert f"below {len(names)} names" in str(caught.value)
    assert len(written(tmp_path, [mark.join(names), *map(mark.join, full)]))


def test_cells_that_are_visibly_empty(tmp_path):
    head = "Nr,velocity [m/s],cor,contact_time [ms],Remark"
    data = written(tmp_path, [head, ",1,0.5,0.9,", "2,2,,0.8,late", "3,3,0.4,,"])
    assert np.isnan(data.cor[3]) and np.isnan(data.contact_time[4])
    assert list(data.velocity) == [1, 2, 3]


def test_remarks_at_the_end_may_be_missing(tmp_path):
    for name in ("Remark", "Bemerkung", "", "Operator"):
        data = written(tmp_path, [f"velocity [m/s],cor,{name}", "1,0.5", "2,0.4,late", "3,0.3"])
        assert list(data.cor) == [0.5, 0.4, 0.3]
    with pytest.raises(vcor.InputError, match=":2: found 2 cells below 3 names up to 'Nr'"):
        written(tmp_path, ["velocity [m/s],cor,Nr", "1,0.5", "2,0.4,2"])


def test_a_line_of_units_that_lacks_a_cell(tmp_path):
    names = "Angular frequency,Step time,Tan(delta),Storage modulus,Loss modulus"
    block = [f"{f},1,0.1,{f},{0.1 * f}" for f in (1, 2, 3)]
    with pytest.raises(vcor.InputError, match=":2: found 4 units below 5 names"):
        written(tmp_path, [names, "rad/s,s,MPa,MPa", *block])
    data = written(tmp_path, [names, "rad/s,s,,MPa,MPa", *block])
    assert np.allclose(data.storage_modulus, [1e6, 2e6, 3e6])
