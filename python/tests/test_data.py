"""Files of laboratories: read right, or refused with the line and what is expected."""

import io
import re
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from properties import assume, examples, given, st

import vcor
from vcor import _command
from vcor.materials import grid
from vcor.materials.data import columns_option, curves, read_data, read_moduli
from vcor.materials.names import read_head
from vcor.materials.tables import Choice

OMEGA = np.geomspace(1, 1000, 7)
STORAGE = 2e6 + 3e7 * OMEGA**2 / (1e4 + OMEGA**2)
LOSS = 3e7 * 100 * OMEGA / (1e4 + OMEGA**2)
HERTZ = OMEGA / (2 * np.pi)


def table(*columns, head="", mark=",", digits=9, comma=False):
    rows = [mark.join(f"{x:.{digits}g}" for x in row) for row in zip(*columns, strict=True)]
    text = "\n".join(rows) + "\n"
    return head + (text.replace(".", ",") if comma else text)


def read(tmp_path, text, *options, name="data.csv", **named):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_data(path, *options, **named)


def is_the_material(data):
    assert data.attrs["kind"] == "dynamic"
    assert np.allclose(data.frequency, OMEGA, rtol=1e-6)
    assert np.allclose(data.storage_modulus, STORAGE, rtol=1e-6)
    assert np.allclose(data.loss_modulus, LOSS, rtol=1e-6)


def refused(tmp_path, text, *said, options=(), kind=vcor.InputError):
    with pytest.raises(kind) as caught:
        read(tmp_path, text, *options)
    message = str(caught.value)
    assert "\n" not in message
    for words in said:
        assert words in message
    return message


# ------------------------------------------------------------------------------ ways to write

HEADS = {
    "numpy.savetxt": ("# f [Hz],E' [MPa],E'' [MPa]\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "savetxt, two lines": ("# f,E',E''\n# Hz,MPa,MPa\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "parentheses": ("Frequency (Hz),E' (kPa),E'' (kPa)\n", (HERTZ, STORAGE / 1e3, LOSS / 1e3)),
    "no blank": ("omega(rad/s),G'(Pa),G''(Pa)\n", (OMEGA, STORAGE, LOSS)),
    "slash": ("f/Hz,E'/MPa,E''/MPa\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "in": ("f in kHz,E' in GPa,E'' in MPa\n", (HERTZ / 1e3, STORAGE / 1e9, LOSS / 1e6)),
    "suffixes": ("frequency_hz,storage_modulus_mpa,loss_modulus_kpa\n",
                 (HERTZ, STORAGE / 1e6, LOSS / 1e3)),
    "more suffixes": ("omega_rad_s,E_stor_MPa,E_loss_MPa\n", (OMEGA, STORAGE / 1e6, LOSS / 1e6)),
    "units below": ("f,E_stor,E_loss\nHz,MPa,MPa\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "brackets below": ("f,G',G''\n[Hz],[MPa],[MPa]\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "separators between": ("f,E',E''\n,,\nHz,MPa,MPa\n,,\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "per second": ("Kreisfrequenz [1/s],Speichermodul [Pa],Verlustmodul [Pa]\n",
                   (OMEGA, STORAGE, LOSS)),
    "powers": ("ω [s^-1],E' [N/mm^2],E'' [N/mm²]\n", (OMEGA, STORAGE / 1e6, LOSS / 1e6)),
    "logarithms": ("log10(f [Hz]),log10 E' [Pa],lg(E''/Pa)\n",
                   (np.log10(HERTZ), np.log10(STORAGE), np.log10(LOSS))),
    "natural": ("ln(omega [rad/s]),ln(E') (MPa),ln(E'') (MPa)\n",
                (np.log(OMEGA), np.log(STORAGE / 1e6), np.log(LOSS / 1e6))),
    "tangent": ("f [Hz],E' [Pa],tan δ\n", (HERTZ, STORAGE, LOSS / STORAGE)),
    "tangent and loss": ("f [Hz],Loss factor [-],E'' [Pa]\n", (HERTZ, LOSS / STORAGE, LOSS)),
    "magnitude": ("f [Hz],|G*| [Pa],tan(delta)\n",
                  (HERTZ, np.hypot(STORAGE, LOSS), LOSS / STORAGE)),
    "phase": ("f [Hz],Complex modulus [Pa],Phase angle [°]\n",
              (HERTZ, np.hypot(STORAGE, LOSS), np.degrees(np.arctan2(LOSS, STORAGE)))),
    "other order": ("Module de perte [MPa],Module de conservation [MPa],Fréquence [Hz]\n",
                    (LOSS / 1e6, STORAGE / 1e6, HERTZ)),
    "name and symbol": ("Angular frequency ω [rad/s],Storage modulus E' [Pa],"
                        "Loss modulus (E'') [Pa]\n",
                        (OMEGA, STORAGE, LOSS)),
    "both frequencies": ("f [Hz],omega [rad/s],E' [Pa],E'' [Pa]\n", (HERTZ, OMEGA, STORAGE, LOSS)),
    "velocity": ("Frequency [Hz],Velocity [rad/s],Storage modulus [Pa],Loss modulus [Pa]\n",
                 (HERTZ, OMEGA / 100, STORAGE, LOSS)),
    "repeated": ("f [Hz],E' [MPa],E'' [MPa],f [Hz],E' [MPa]\n",
                 (HERTZ, STORAGE / 1e6, LOSS / 1e6, HERTZ, STORAGE / 1e6)),
    "others beside": ("No.,f [Hz],Stress [Pa],Strain [%],Torque [µNm],E' [Pa],E'' [Pa],Status\n",
                      (OMEGA, HERTZ, OMEGA, OMEGA, OMEGA, STORAGE, LOSS, OMEGA)),
    "Spanish": ("Frecuencia angular [rad/s],Módulo de almacenamiento [Pa],Módulo de pérdida [Pa]\n",
                (OMEGA, STORAGE, LOSS)),
    "Japanese": ("角周波数 [rad/s],貯蔵弾性率 [MPa],損失弾性率 [MPa]\n",
                 (OMEGA, STORAGE / 1e6, LOSS / 1e6)),
    "Chinese": ("频率（Hz）,储能模量（MPa）,损耗模量（MPa）\n", (HERTZ, STORAGE / 1e6, LOSS / 1e6)),
    "typographic": ("f [Hz],E′ [Pa],E″ [Pa]\n", (HERTZ, STORAGE, LOSS)),
    "quotation mark": ("f [Hz],E' [Pa],E\" [Pa]\n", (HERTZ, STORAGE, LOSS)),
    "exclamation marks": ("! made by a script\n! f [Hz], E' [Pa], E'' [Pa]\n",
                          (HERTZ, STORAGE, LOSS)),
    "preamble": ("Sample,rubber 12\nDiameter,8.0\nTemperature limit,620 [°C]\n\n"
                 "f [Hz],E' [Pa],E'' [Pa]\n", (HERTZ, STORAGE, LOSS)),
}  # fmt: skip


@pytest.mark.parametrize("name", HEADS)
def test_heads(tmp_path, name):
    head, columns = HEADS[name]
    is_the_material(read(tmp_path, table(*columns, head=head)))


@pytest.mark.parametrize("gap", [" ", "   "])
def test_names_between_blanks_tell_the_encoding(tmp_path, gap):
    """As names between commas do: of a Chinese file that is no Unicode."""
    lines = ["频率[Hz] 储能模量[Pa] 损耗模量[Pa]"]
    lines += [" ".join(f"{x:.10g}" for x in row) for row in zip(HERTZ, STORAGE, LOSS, strict=True)]
    text = "\n".join(line.replace(" ", gap) for line in lines) + "\n"
    is_the_material(read(tmp_path, text.encode("gb18030")))


LANGUAGES = {
    "en": ("Angular frequency", "Storage modulus", "Loss modulus", "Temperature"),
    "de": ("Kreisfrequenz", "Speichermodul", "Verlustmodul", "Temperatur"),
    "fr": ("Fréquence angulaire", "Module de stockage", "Module de perte", "Température"),
    "es": ("Frecuencia angular", "Módulo de almacenamiento", "Módulo de pérdidas", "Temperatura"),
    "ja": ("角周波数", "貯蔵弾性率", "損失弾性率", "温度"),
    "zh": ("角频率", "储能模量", "损耗模量", "温度"),
}
ENCODINGS = {"en": "ascii", "de": "cp1252", "fr": "cp1252", "es": "cp1252", "ja": "shift_jis",
             "zh": "gb18030"}  # fmt: skip


@examples(150)
@given(
    language=st.sampled_from(sorted(LANGUAGES)),
    order=st.permutations(range(4)),
    style=st.sampled_from(["[]", "()", "below", "[below]", "suffix", "remark"]),
    mark=st.sampled_from([",", ";", "\t", "blank"]),
    comma=st.booleans(),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "own"]),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    units=st.tuples(
        st.sampled_from(["rad/s", "Hz", "kHz"]),
        st.sampled_from(["Pa", "kPa", "MPa"]),
        st.sampled_from(["C", "K"]),
    ),  # fmt: skip
    index=st.booleans(),
    blanks=st.sets(st.integers(0, 9), max_size=3),
    preamble=st.sampled_from(
        ["", "Project:{0}pad{0}{0}\n", "Created{0}12.03.2026\nOperator{0}X\n"]
    ),
)
def test_all_combinations(
    tmp_path, language, order, style, mark, comma, encoding, end, units, index, blanks, preamble
):
    """Any combination is read correctly, or refused."""
    assume(not (mark == "," and comma) and not (mark == "blank" and (preamble or index)))
    names = list(LANGUAGES[language])
    if units[0] != "rad/s":
        names[0] = {"en": "Frequency", "de": "Frequenz", "fr": "Fréquence", "es": "Frecuencia",
                    "ja": "周波数", "zh": "频率"}[language]  # fmt: skip
    if mark == "blank":
        assume(all(" " not in name for name in names) or style in ("[]", "()"))
    sizes = {"rad/s": 1, "Hz": 2 * np.pi, "kHz": 2e3 * np.pi, "Pa": 1, "kPa": 1e3, "MPa": 1e6}
    kelvin = np.full(len(OMEGA), 296.15)
    values = [OMEGA / sizes[units[0]], STORAGE / sizes[units[1]], LOSS / sizes[units[1]],
              kelvin - 273.15 * (units[2] == "C")]  # fmt: skip
    told = [units[0], units[1], units[1], units[2]]
    names, values, told = ([one[i] for i in order] for one in (names, values, told))
    sep = "  " if mark == "blank" else mark
    heads = {
        "[]": [f"{name} [{unit}]" for name, unit in zip(names, told, strict=True)],
        "()": [f"{name} ({unit})" for name, unit in zip(names, told, strict=True)],
        "remark": [f"{name} [{unit}]" for name, unit in zip(names, told, strict=True)],
        "suffix": [
            f"{name}_{unit.replace('/', '_').lower()}"
            for name, unit in zip(names, told, strict=True)
        ],
    }.get(style, names)
    lines = [("# " if style == "remark" else "") + sep.join([""] * index + heads)]
    if style.endswith("below") or style == "[below]":
        below = [f"[{unit}]" if "[" in style else unit for unit in told]
        lines.append(sep.join([""] * index + below))
    for i, row in enumerate(zip(*values, strict=True)):
        cells = [f"{x:.10g}".replace(".", "," if comma else ".") for x in row]
        lines.append(sep.join([str(i + 1)] * index + cells))
        if i in blanks and mark != "blank":
            lines.append(mark * 3)
    text = preamble.format(mark) + "\n".join(lines) + "\n"
    raw = text.replace("\n", end).encode(ENCODINGS[language] if encoding == "own" else encoding)
    data = read(tmp_path, raw)
    is_the_material(data)
    assert np.allclose(data.temperature, 296.15)
    assert ("with decimal commas" in data.attrs["taken"]) is comma


def test_the_encoding_whose_names_are_known(tmp_path):
    head = "##Temp./°C;Time/min;f/Hz;E'/MPa;E''/MPa;tan δ\n"
    text = table(OMEGA * 0 + 25, OMEGA, HERTZ, STORAGE / 1e6, LOSS / 1e6, LOSS / STORAGE,
                 head=head, mark=";", comma=True)  # fmt: skip
    for encoding in ("utf-8", "iso8859_7", "utf-16-be"):
        is_the_material(
            read(tmp_path, ("#EXPORTTYPE:DATA ALL\n#RANGE: a; b\n" + text).encode(encoding))
        )


def test_first_cell_empty(tmp_path):
    for mark in ",;\t":
        head = f"Interval data:{mark}Point No.{mark}Angular Frequency{mark}"
        head += f"Storage Modulus{mark}Loss Modulus\n"
        head += f"{mark * 4}\n{mark}[]{mark}[rad/s]{mark}[Pa]{mark}[Pa]\n"
        rows = [mark.join(["", str(i), *(f"{x:.9g}" for x in row)])
                for i, row in enumerate(zip(OMEGA, STORAGE, LOSS, strict=True))]  # fmt: skip
        is_the_material(read(tmp_path, head + "\n".join(rows)))


def test_relaxation_with_two_times(tmp_path):
    head = "Step time\tRun time\tRelaxation modulus G(t)\ns\ts\tMPa\n"
    data = read(tmp_path, table(OMEGA, OMEGA + 100, STORAGE / 1e6, head=head, mark="\t"))
    assert data.attrs["kind"] == "relaxation" and data.attrs["shear"] is True
    assert np.allclose(data.time, OMEGA) and np.allclose(data.relaxation_modulus, STORAGE)
    only = read(tmp_path, table(OMEGA, STORAGE / 1e6, head="Run time [s],E(t) [MPa]\n"))
    assert np.allclose(only.time, OMEGA) and only.attrs["shear"] is False
    both = table(OMEGA, OMEGA / 60, STORAGE, head="t [s],t [min],E [Pa]\n", digits=12)
    assert np.allclose(read(tmp_path, both).time, OMEGA)


def test_shift_factors(tmp_path):
    for head, value in {
        "T [C],log10 a_T\n": lambda x: x, "T [C],a_T\n": lambda x: 10**x,
        "Temperature_C,ln(aT)\n": lambda x: x * np.log(10),
        "T,log10_shift_factor\nC,-\n": lambda x: x,
    }.items():  # fmt: skip
        x = np.array([3.0, 1.0, 0.0, -1.5])
        data = read(tmp_path, table([0, 10, 20, 30], value(x), head=head))
        assert data.attrs["kind"] == "shift"
        assert np.allclose(data.temperature, [273.15, 283.15, 293.15, 303.15])
        assert np.allclose(np.log10(data.shift_factor), x)
    refused(tmp_path, table([0, 10], [1, 0], head="T [C],log aT\n"), "expected log10 or ln")


# ------------------------------------------------------------------------------- several curves


def blocks(head, step="[Step]\nStep name,Frequency sweep ({t}.0 °C)\n", column=False):
    text = ""
    for i, t in enumerate((0, 10, 20)):
        text += step.format(t=t) + head
        columns = [HERTZ, STORAGE * (3 - i) / 1e6, LOSS * (3 - i) / 1e6]
        text += table(*([OMEGA * 0 + t] * column), *columns) + "\n"
    return text


@pytest.mark.parametrize("text", [
    blocks("f,E',E''\nHz,MPa,MPa\n"),
    blocks("T,f,E',E''\nC,Hz,MPa,MPa\n", "[Step]\nStep name,Sweep\nNumber of points,7\n", True),
    "f [Hz],E' [MPa],E'' [MPa]\n" + blocks("", "T = {t} °C\n"),
    "f [Hz],E' [MPa],E'' [MPa]\n" + blocks("", "Temperature: {t} C\n"),
    "T [C],f [Hz],E' [MPa],E'' [MPa]\n" + blocks("", "", True).replace("\n\n", "\n"),
])  # fmt: skip
def test_steps_and_blocks(tmp_path, text):
    data = read(tmp_path, text)
    found = curves(data)
    assert [round(one.attrs["temperature"] - 273.15) for one in found] == [0, 10, 20]
    for i, one in enumerate(found):
        assert np.allclose(one.frequency, OMEGA) and np.allclose(
            one.storage_modulus, STORAGE * (3 - i)
        )


SIDES = {
    "own frequencies": "20 °C,,,30 °C,,\nf [Hz],E' [MPa],E'' [MPa],f [Hz],E' [MPa],E'' [MPa]\n",
    "in the heads": "f [Hz] 20 °C,E' [MPa] 20 °C,E'' [MPa] 20 °C,f [Hz] 30 °C,E' [MPa] 30 °C,"
    "E'' [MPa] 30 °C\n",
    "common": "f [Hz],E' (MPa) 20C,E'' (MPa) 20C,E' (MPa) 30C,E'' (MPa) 30C\n",
    "at": "f [Hz],E'@20C [MPa],E''@20C [MPa],E'@30C [MPa],E''@30C [MPa]\n",
    "numbers above": "T [C],20,20,30,30\nf [Hz],E' [MPa],E'' [MPa],E' [MPa],E'' [MPa]\n",
}


@pytest.mark.parametrize("name", SIDES)
def test_temperatures_side_by_side(tmp_path, name):
    columns = [HERTZ, STORAGE / 1e6, LOSS / 1e6, HERTZ, STORAGE / 2e6, LOSS / 2e6]
    if SIDES[name].splitlines()[-1].count(",") == 4:
        del columns[3]
    found = curves(read(tmp_path, table(*columns, head=SIDES[name])))
    assert [round(one.attrs["temperature"] - 273.15, 6) for one in found] == [20, 30]
    for one, size in zip(found, (1, 2), strict=True):
        assert np.allclose(one.frequency, OMEGA) and np.allclose(
            one.storage_modulus, STORAGE / size
        )


def test_columns_of_different_lengths(tmp_path):
    text = table(HERTZ, STORAGE, LOSS, HERTZ, STORAGE, LOSS,
                 head="20 C,,,30 C,,\n"
                 "f [Hz],E' [Pa],E'' [Pa],f [Hz],E' [Pa],E'' [Pa]\n")  # fmt: skip
    lines = text.splitlines()
    lines[-1] = ",".join(lines[-1].split(",")[:3]) + ",,,"
    first, second = curves(read(tmp_path, "\n".join(lines)))
    assert (len(first), len(second)) == (7, 6)


def test_two_sweeps_that_cannot_be_separated(tmp_path):
    text = table(HERTZ, STORAGE, LOSS, head="f [Hz],E' [Pa],E'' [Pa]\n")
    data = read(tmp_path, text + table(HERTZ, STORAGE / 2, LOSS / 2))
    with pytest.raises(vcor.InputError, match=r"data.csv:9: found a frequency.*less than 22 %"):
        curves(data)
    two = "f [Hz],E' [Pa],E'' [Pa],f [Hz],E' [Pa],E'' [Pa]\n"
    refused(tmp_path, table(HERTZ, STORAGE, LOSS, HERTZ, STORAGE / 2, LOSS / 2, head=two),
            "found two columns of storage modulus with different numbers", "columns=")  # fmt: skip


def test_a_temperature_by_the_name_of_the_file(tmp_path):
    (tmp_path / "a.csv").write_text(table(HERTZ, STORAGE, LOSS, head="f [Hz],G' [Pa],G'' [Pa]\n"))
    with pytest.raises(vcor.UsageError, match="expected poisson_ratio"):
        read_moduli(f"{tmp_path}/a.csv@20C")
    (one,) = read_moduli(f"{tmp_path}/a.csv@20C", poisson_ratio=0.5)
    assert one.attrs["temperature"] == 293.15 and np.allclose(one.loss_modulus, 3 * LOSS)


# ------------------------------------------------------------------------------ impacts, records


@pytest.mark.parametrize(("head", "names", "factors"), [
    ("Impact velocity (m/s),Rebound velocity (m/s)\n", ("velocity", "rebound_velocity"), (1, 1)),
    ("v_in [m/s],v_out [m/s]\n", ("velocity", "rebound_velocity"), (1, 1)),
    ("speed in [km/h],speed out [km/h]\n", ("velocity", "rebound_velocity"), (1 / 3.6, 1 / 3.6)),
    ("Initial height (cm),Bounce height (cm)\n", ("drop_height", "rebound_height"), (0.01, 0.01)),
    ("H0 (cm),H1 (cm)\n", ("drop_height", "rebound_height"), (0.01, 0.01)),
    ("Fallhöhe [mm],Rückprallhöhe [mm]\n", ("drop_height", "rebound_height"), (1e-3, 1e-3)),
    ("Hauteur de chute (cm),Coefficient de restitution\n", ("drop_height", "cor"), (0.01, 1)),
    ("落下高さ [cm],反発係数\n", ("drop_height", "cor"), (0.01, 1)),
    ("v [mm/s],Stoßzahl\n", ("velocity", "cor"), (1e-3, 1)),
    ("velocity,resilience [%]\n", ("velocity", "resilience"), (1, 0.01)),
])  # fmt: skip
def test_names_of_impacts(tmp_path, head, names, factors):
    data = read(tmp_path, head + "60,40\n50,35\n")
    assert data.attrs["kind"] == "impacts" and tuple(data) == names
    assert np.allclose(data, np.array([[60, 40], [50, 35]]) * factors)


def test_a_stopwatch(tmp_path):
    both = read(tmp_path, "Event time (s),Interval (s)\n2.0,0.5\n2.5,0.4\n2.9,0.3\n3.2,0.000000\n")
    assert list(both) == ["bounce_time"] and np.allclose(both.bounce_time, [0.5, 0.4, 0.3])
    only = read(tmp_path, "Event time (s)\n2.0\n2.5\n2.9\n3.2\n")
    assert np.allclose(only.bounce_time, [0.5, 0.4, 0.3])


@pytest.mark.parametrize(("cells", "unit", "digits"), [
    (["0.80", "0.70"], 0.01, 2), (["1.0", "1.0"], 0.1, 2), (["0,5", "0,4837"], 1e-4, 4),
    (["1", "0.5"], 0.1, 1), (["1.50e-1", "2.5e-1"], 1e-3, 3),
])  # fmt: skip
def test_digits_as_they_are_written(tmp_path, cells, unit, digits):
    text = "v [m/s];cor\n" + "".join(f"{i + 1};{cell}\n" for i, cell in enumerate(cells))
    found = read(tmp_path, text).attrs["digits"]["cor"]
    assert found == (pytest.approx(unit), digits)


def test_digits_of_whole_numbers_and_percent(tmp_path):
    data = read(tmp_path, "v [m/s];resilience [%];max force [N]\n1;80;1500\n2;75;1200\n")
    assert data.attrs["digits"]["resilience"] == (pytest.approx(0.01), 2)
    # zeros at the end of a whole number may be none that was measured
    assert data.attrs["digits"]["max_force"] == (pytest.approx(100), 2)


def test_a_diameter_is_two_radii(tmp_path):
    head = "v [m/s],{} [mm],cor\n"
    for name in ("ball diameter", "Kugeldurchmesser", "diamètre de la bille", "直径"):
        data = read(tmp_path, head.format(name) + "1,40,0.5\n2,30,0.4\n")
        assert np.allclose(data.radius, [0.02, 0.015]) and "diameter" not in data
        assert f"radius from 'half of {name} [mm]'" in data.attrs["taken"]
    refused(tmp_path, "v [m/s],radius [mm],diameter [mm],cor\n1,20,40,0.5\n",
            "both a radius and a diameter")  # fmt: skip


def test_unknown_columns_of_impacts(tmp_path):
    said = refused(
        tmp_path, "velocity [m/s],core\n1,0.5\n", "found the column 'core'", "rebound_height"
    )
    assert "did you mean 'cor'" in said
    data = read(tmp_path, "Nr.,velocity [m/s],cor,Remark\n1,2,0.5,late\n2,3,0.4,\n")
    assert list(data) == ["velocity", "cor"]


def test_labview(tmp_path):
    head = (
        "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nX_Columns\tNo\n"
        "***End_of_Header***\n\n"
        "Channels\t1\nSamples\t3\nDate\t2026/01/01\nTime\t12:00:00\nY_Unit_Label\tN\nX_Dimension\tTime\n"
        "X0\t0.0\nDelta_X\t0.001\n***End_of_Header***\nX_Value\tForce\tComment\n"
    )
    data = read(tmp_path, head + "\t1.5\n\t2.5\n\t0.5\n", name="a.lvm")
    assert data.attrs["kind"] == "record" and np.allclose(data.time, [0, 1e-3, 2e-3])
    assert np.allclose(data.force, [1.5, 2.5, 0.5])
    text = head.replace("\tNo\n", "\tOne\n") + "0.0\t1\n0.5\t2\n1.0\t1\n"
    assert np.allclose(read(tmp_path, text, name="a.lvm").time, [0, 0.5, 1.0])
    text = text.replace("\tForce\t", "\tUntitled\t")
    refused(tmp_path, text, "'Untitled [N]'", "columns=")
    found = read(tmp_path, text, {"force": "Untitled"})
    assert np.allclose(found.force, [1, 2, 1])


def test_acceleration(tmp_path):
    text = '"Time (s)","Acceleration (m/s^2)"\n0,1\n0.1,2\n'
    data = read(tmp_path, text)
    assert list(data) == ["time", "acceleration"] and data.attrs["kind"] == "record"
    assert np.allclose(read(tmp_path, "t [ms],a [g]\n0,1\n1,2\n").acceleration, [9.80665, 19.6133])


# ---------------------------------------------------------------------------------- refusals

BAD = {
    "stress": ("Time [s],Stress [Pa]\n1,5\n2,4\n",
               [":1:", "the stress 'Stress [Pa]'", "the stress over the strain; a column strain"]),
    "loss tangent and temperature": ("T [C],tan delta\n20,0.1\n30,0.2\n", [
        "no column of the frequency and of the storage modulus", "tells no shifts"]),
    "temperatures at one frequency": ("T [C],E' [Pa],E'' [Pa]\n20,5,1\n30,4,1\n", [
        "no column of the frequency", "a temperature sweep at one frequency tells no shifts"]),
    "Spannung": ("Zeit [s];Spannung [Pa]\n1;5\n2;4\n", ["'Spannung [Pa]'"]),
    "bulk": ("time [s],bulk modulus [Pa]\n1,5\n2,4\n", ["'bulk modulus [Pa]'"]),
    "creep": ("time [s],Creep modulus [Pa]\n1,5\n2,4\n", ["'Creep modulus [Pa]'"]),
    "compliance": ("f [Hz],J' [1/Pa],J'' [1/Pa]\n1,5,1\n2,4,1\n", ["J'"]),
    "viscosity": ("f [Hz],Complex viscosity [Pa s]\n1,5\n2,4\n", ["'Complex viscosity"]),
    "no loss": ("f [Hz],Stress [Pa],E' [Pa]\n1,5,5\n2,6,6\n", ["loss modulus", "E''"]),
    **{
        f"thousands {i}": (f"t [s];E [Pa]\n1;{one}\n2;{two}\n", [":2:", f"'{one}' with thousands"])
        for i, (one, two) in enumerate([
            ("2,000,000", "1,900,000"), ("2.000.000,0", "1.900.000,0"), ("1,234.5", "999.5"),
            ("1.234,5", "999,5"), ("2'000'000", "999.5"), ("2’000,5", "999,5"),
        ])
    },
    "no names": ("1,5,1\n2,6,1\n", ["3 columns without names", "columns with their names"]),
    "names of places": ("a,b,c\n1,5,1\n2,6,1\n", ["'b'"]),
    "bare log": ("log t,log E\n1,5\n2,4\n", ["expected log10 or ln"]),
    "unit of frequency": ("Frequency [1/s],E' [Pa],E'' [Pa]\n1,5,1\n2,6,1\n", ["Hz or rad/s"]),
    "no unit of frequency": ("frequency,storage,loss\n1,5,1\n2,6,1\n", ["no unit of 'frequency'"]),
    "Hz of omega": ("omega [Hz],E' [Pa],E'' [Pa]\n1,5,1\n2,6,1\n", ["angular frequency", "rad/s"]),
    "unit of one": ("t [s],E\n1,5\n2,4\n", ["no unit of 'E'", "or units"]),
    "unit of temperature": ("f [Hz],T,E' [Pa],E'' [Pa]\n1,23,5,1\n2,23,6,1\n", ["T [C]"]),
    "capitals": ("t [s],E [MPA]\n1,5\n2,4\n", ["'MPA'", "did you mean MPa?"]),
    "milli": ("t [s],E [mPa]\n1,5\n2,4\n", ["'mPa'", "did you mean MPa?"]),
    "wrong unit": ("t [s],E [s]\n1,5\n2,4\n", ["'s' as unit of 'E [s]'"]),
    "T is no time": ("T [s],E [Pa]\n1,5\n2,4\n", ["no column of the time"]),
    "text": ("t [s],E [Pa]\n1,5\n2,abc\n", [":3:", "'abc'", "'E [Pa]'"]),
    "nothing": ("t [s],E [Pa]\n1,5\n2,\n", [":3:", "no number"]),
    "infinite": ("t [s],E [Pa]\n1,5\n2,1e999\n", [":3:", "1e999"]),
    "negative": ("t [s],E [Pa]\n1,5\n2,-4\n", [":3:", "-4", "relaxation modulus > 0"]),
    "time zero": ("t [s],E [Pa]\n0,5\n1,4\n", [":2:", "time > 0"]),
    "mixed decimals": ("t [s];E [Pa]\n1,5;5,5\n2.5;4\n",
                       [":3:", "decimal commas and decimal points"]),
    "thousands": ('t [s],E [Pa]\n1,"1,500"\n2,"1,400"\n', ["thousands"]),
    "thousands and point": ('t [s],E [Pa]\n1,"1,500.5"\n2,3\n', [":2:", "1,500.5"]),
    "decimal commas between commas": ("t [s],E [Pa]\n1,5,5\n2,5,4\n", ["3 columns", "2 names"]),
    "index without a head": ("f [Hz]\tE' [Pa]\tE'' [Pa]\n1\t1\t5\t1\n2\t2\t6\t1\n",
                             ["4 columns", "3 names"]),
    "text between": ("t [s],E [Pa]\n1,5\n2,4\nsecond,\n3,2\n4,1\n", [":5:", "second"]),
    "a table below": ("t [s],E [Pa]\n1,5\n2,4\nsecond sample\n1,2\n2,1\n",
                      [":5:", "second sample"]),
    "shear and tensile": ("f [Hz],E' [Pa],G'' [Pa]\n1,5,1\n2,6,1\n", ["shear and tensile"]),
    "contradiction": ("f [Hz],E' [Pa],E'' [Pa],tan delta\n1,5,1,2\n2,6,1,2\n",
                      ["tan delta that contradicts"]),
    "two frequencies": ("f [Hz],omega [rad/s],E' [Pa],E'' [Pa]\n1,2,5,1\n2,3,6,1\n",
                        ["two columns of frequency"]),
    "control character": ("t [s],E [Pa]\n1,5\n2,\x004\n", [":3:", "control character"]),
    "empty": ("", ["no numbers"]),
    "blank": ("\n \n", ["no numbers"]),
    "a column without numbers": ("t [s];x;E [MPa]\n1;9;\n2;6;\n", ["the columns 't [s]', 'x'"]),
    "cut short": ("f,E_stor,E_loss\nHz,MPa,MPa\n0.1,24", ["no column of the loss modulus"]),
    "head only": ("t [s],E [Pa]\n", ["no numbers"]),
    "two of one name": ("f [Hz],E' [MPa],E'' [MPa],E' [MPa]\n1,2,1,3\n2,3,1,4\n",
                        ["two columns of storage modulus", "columns={'storage_modulus': '4'}"]),
    "compliance and tangent": ("f [Hz],Storage compliance [1/Pa],tan delta\n1,2,1\n2,3,1\n",
                               ["no column of the storage modulus"]),
    "axes": ("Time [s],Fx [N],Fz [N]\n1,2,1\n2,3,1\n", ["columns={'force': 'Fz [N]'}"]),
    "moduli of both kinds": ("t [s],f [Hz],E(t) [Pa],E' [Pa],E'' [Pa]\n1,1,5,5,1\n2,2,4,6,1\n",
                             ["against time"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_refused(tmp_path, name):
    text, said = BAD[name]
    refused(tmp_path, text, *said)


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(vcor.FileError, match="found a folder"):
        read_data(tmp_path)
    with pytest.raises(vcor.FileError, match="No such file"):
        read_data(tmp_path / "none.csv")
    refused(tmp_path, b"PK\x03\x04rest", "spreadsheet cannot be read")
    refused(tmp_path, b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1rest", ".xlsx")


def test_files_have_a_bound(tmp_path, monkeypatch):
    monkeypatch.setattr(grid, "MOST_BYTES", 100)
    refused(tmp_path, "t [s],E [Pa]\n" + "1,5\n" * 30, "smaller file")


@examples(300)
@given(
    st.binary(max_size=200)
    | st.text(alphabet="tfE'GvT,;\t \n[]()#0123456789.-eHzPaMC\"", max_size=120)
)
def test_any_content_of_a_file(tmp_path, content):
    """A table or a line that says why not; nothing else."""
    try:
        data = read(tmp_path, content)
    except vcor.Error as error:
        assert "\n" not in str(error)
    else:
        assert len(data) and data.attrs["kind"]


# ---------------------------------------------------------------------------------- options


def test_columns_that_the_user_names(tmp_path):
    text = table(OMEGA, LOSS, STORAGE, head="Kolumna (rad/s),B (Pa),A (Pa)\n")
    refused(tmp_path, text, "columns=")
    choice = {"frequency": "Kolumna", "storage": "A (Pa)", "E''": 2}
    is_the_material(read(tmp_path, text, choice))
    options = columns_option(["frequency=Kolumna (rad/s)", "storage=A,loss=B"])
    is_the_material(read(tmp_path, text, options))
    bare = table(OMEGA, STORAGE, LOSS)
    is_the_material(read(tmp_path, bare, ["omega", "storage", "loss"]))
    is_the_material(read(tmp_path, table(HERTZ, STORAGE / 1e6, LOSS / 1e6),
                         columns_option(["frequency,storage,loss"]), "Hz,MPa"))  # fmt: skip
    skipped = read(tmp_path, table(OMEGA, OMEGA, STORAGE, LOSS), ["", "omega", "storage", "loss"])
    is_the_material(skipped)
    for wrong in ({"frequency": "C"}, {"sorage": "A"}, ["omega"]):
        with pytest.raises(vcor.UsageError):
            read(tmp_path, bare if isinstance(wrong, list) else text, wrong)
    two = table(OMEGA, STORAGE, LOSS, STORAGE / 2, head="omega,E',E'',E'\n")
    is_the_material(read(tmp_path, two, {"storage": 2}))


def test_columns_of_several_files(tmp_path):
    """A head that the user names counts in the files that have it, names in those without heads."""
    dynamic, impacts, record = tmp_path / "dma.csv", tmp_path / "e.csv", tmp_path / "force.csv"
    dynamic.write_text(table(OMEGA, STORAGE, LOSS, head="omega,A,E''\n"))
    impacts.write_text("velocity,e1\n1,0.5\n2,0.4\n")
    record.write_text("0.001,0\n0.002,1\n")
    choice = Choice({"storage": "A", "cor": "e1"}, None, files=2)
    is_the_material(read_data(dynamic, choice))
    assert list(read_data(impacts, choice)["cor"]) == [0.5, 0.4]
    choice.refuse_unseen("the files have")
    names = Choice(["time", "force"], None, files=2)
    assert list(read_data(record, names)["force"]) == [0, 1]
    with pytest.raises(vcor.InputError, match="'A'"):
        read_data(dynamic, names)
    wrong = Choice({"cor": "e1", "storage": "C"}, None, files=2)
    read_data(impacts, wrong)
    with pytest.raises(vcor.UsageError, match="the files have no column 'C', expected one of"):
        wrong.refuse_unseen("the files have")


def test_units_that_the_user_names(tmp_path):
    text = table(HERTZ, STORAGE / 1e6, LOSS / 1e6, head="frequency,storage,loss\n")
    is_the_material(read(tmp_path, text, None, "Hz,MPa"))
    is_the_material(
        read(tmp_path, text, units={"frequency": "Hz", "storage": "MPa", "loss": "MPa"})
    )
    same = table(HERTZ, STORAGE, LOSS, head="f [Hz],E' [Pa],E'' [Pa]\n")
    is_the_material(read(tmp_path, same, units=["Hz", "Pa"]))
    for units in ("rad/s", "Hz,MPa", "bananas"):
        with pytest.raises(vcor.UsageError):
            read(tmp_path, same, units=units)


def test_errors_of_columns(tmp_path):
    head = "f [Hz],E_stor [MPa],E_stor_sigma [MPa],E_loss [MPa]\n"
    data = read(tmp_path, table(HERTZ, STORAGE / 1e6, STORAGE / 1e8, LOSS / 1e6, head=head))
    assert np.allclose(data.storage_modulus_sigma, STORAGE / 100)


def test_spreadsheets(tmp_path):
    path = tmp_path / "data.xlsx"
    frame = pd.DataFrame({"f [Hz]": HERTZ, "E' [MPa]": STORAGE / 1e6, "E'' [MPa]": LOSS / 1e6})
    frame.to_excel(path, index=False, startrow=3, sheet_name="Sweep")
    is_the_material(read_data(path))
    with pd.ExcelWriter(path) as book:
        pd.DataFrame({"Device": ["DMA"], "Serial": [12]}).to_excel(book, sheet_name="Info")
        for t in (20, 30):
            frame.assign(**{"Temperature [°C]": t}).to_excel(book, sheet_name=f"{t} C", index=False)
    assert [round(one.attrs["temperature"] - 273.15) for one in curves(read_data(path))] == [20, 30]
    # the names of the sheets alone
    with pd.ExcelWriter(path) as book:
        for t in (20, 30):
            frame.to_excel(book, sheet_name=f"{t} °C", index=False)
    assert [round(one.attrs["temperature"] - 273.15) for one in curves(read_data(path))] == [20, 30]


def test_standard_input(tmp_path, monkeypatch):
    text = table(HERTZ, STORAGE, LOSS, head="f [Hz],E' [Pa],E'' [Pa]\n")
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    data = read_data("-")
    is_the_material(data)
    assert data.attrs["path"] == "stdin"


def test_everything_taken_is_in_one_line(tmp_path):
    text = table(HERTZ, STORAGE, LOSS, OMEGA, head="f [Hz],E' [Pa],E'' [Pa],Torque [µNm]\n")
    assert (
        read(tmp_path, text)
        .attrs["taken"]
        .endswith(
            "data.csv: 7 points: frequency from 'f [Hz]', storage_modulus from 'E' [Pa]', "
            "loss_modulus from 'E'' [Pa]'; not taken: Torque [µNm]"
        )
    )


# ------------------------------------------------------------------------------ vcor table


def printed(capsys, *words):
    _command.call("table", [*map(str, words)])
    return capsys.readouterr()


def test_the_table_of_relaxation_moduli(tmp_path, capsys):
    path = tmp_path / "raw.csv"
    path.write_text(table(OMEGA * 1e3, STORAGE / 1e6, head="Zeit [ms];G(t) [MPa]\n", mark=";"))
    found = printed(capsys, path)
    assert found.out.startswith("time [s],shear_relaxation_modulus [Pa]\n")
    (tmp_path / "t.csv").write_text(found.out)
    again = read_data(tmp_path / "t.csv")
    assert np.allclose(again.time, OMEGA) and np.allclose(again.relaxation_modulus, STORAGE)
    assert again.attrs["shear"] is True and "note: " in found.err and "G(t) [MPa]" in found.err
    found = printed(capsys, path, "--poisson-ratio", 0.5, "--quiet")
    assert found.out.startswith("time [s],relaxation_modulus [Pa]\n") and not found.err
    (tmp_path / "t.csv").write_text(found.out)
    assert np.allclose(read_data(tmp_path / "t.csv").relaxation_modulus, 3 * STORAGE)
    (tmp_path / "bare.csv").write_text(table(OMEGA, STORAGE))
    words = ["--columns", "time,relaxation_modulus", "--units", "ms,MPa", "--quiet"]
    rows = printed(capsys, tmp_path / "bare.csv", *words).out.splitlines()
    assert np.allclose([float(x) for x in rows[1].split(",")], [1e-3, STORAGE[0] * 1e6])


def test_the_table_of_one_temperature(tmp_path, capsys):
    path = tmp_path / "raw.csv"
    head = "T [C],t [s],E [Pa]\n"
    path.write_text(table(OMEGA * 0 - 5, OMEGA, STORAGE, head=head)
                    + table(OMEGA * 0 + 20, OMEGA, STORAGE / 2))  # fmt: skip
    found = printed(capsys, path, "--temperature", "-5C")
    assert len(found.out.splitlines()) == len(OMEGA) + 1
    with pytest.raises(SystemExit) as ended:
        _command.call("table", [str(path)])
    assert ended.value.code == 2 and "268.15 K, 293.15 K" in capsys.readouterr().err


def test_the_table_of_shift_factors(tmp_path, capsys):
    path = tmp_path / "raw.csv"
    path.write_text("T [C],a_T\n20,1\n0,1000\n40,0.01\n")
    assert printed(capsys, path).out == (
        "temperature [K],log10_shift_factor [1]\n273.15,3.0\n293.15,0.0\n313.15,-2.0\n"
    )


def test_data_that_make_no_table(tmp_path, capsys):
    path = tmp_path / "raw.csv"
    path.write_text(table(HERTZ, STORAGE, LOSS, head="f [Hz],E' [Pa],E'' [Pa]\n"))
    with pytest.raises(SystemExit) as ended:
        _command.call("table", [str(path)])
    assert ended.value.code == 3 and "vcor fit" in capsys.readouterr().err


def test_the_tables_of_the_page(tmp_path):
    page = (Path(__file__).parents[2] / "docs/data.md").read_text(encoding="utf-8")
    tables = re.findall(r"^```csv\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    assert len(tables) == 2
    for text in tables:
        data = read(tmp_path, text)
        assert np.allclose(data.storage_modulus, [2.11e6, 9.95e6])
        assert np.allclose(data.loss_modulus / data.storage_modulus, [0.886, 1.403], rtol=1e-3)
    known = re.findall(r"^\| ([^|]*) \| (`[^|]*|`.*) \|", page, re.MULTILINE)
    names = [name for _, cell in known for name in re.findall(r"`([^`]+)`", cell)]
    assert len(names) > 60
    for name in names:
        assert read_head(name).name, name


# --------------------------------------------------------------------- what is ordinary is read


@pytest.mark.parametrize("mark", [",", ";", "\t", "   "])
@pytest.mark.parametrize("letter", "EG")
@pytest.mark.parametrize("units", [True, False])
def test_a_straight_double_quote(tmp_path, mark, letter, units):
    """The name stands alone, with a unit below it or in the same cell."""
    size = 1e6 if units else 1
    head = mark.join(["f", f"{letter}'", f'{letter}"']) + "\n"
    head += mark.join(["[Hz]", "[MPa]", "[MPa]"]) * units + "\n"
    is_the_material(read(tmp_path, table(HERTZ, STORAGE / size, LOSS / size, head=head, mark=mark)))
    head = mark.join(["t [s]", "f [Hz]", f"{letter}' [Pa]", f'{letter}"[Pa]']) + "\n"
    data = read(tmp_path, table(OMEGA, HERTZ, STORAGE, LOSS, head=head, mark=mark))
    is_the_material(data)
    assert data.attrs["taken"].endswith("; not taken: t [s]")
    assert data.attrs["shear"] is (letter == "G")


def test_cells_in_quotes(tmp_path):
    for head in ('"f [Hz]","E\' [Pa]","E"" [Pa]"\n', '"f [Hz]","E\' [Pa]","E\'\' [Pa]"\n'):
        is_the_material(read(tmp_path, table(HERTZ, STORAGE, LOSS, head=head)))
    assert read_head('"E"').name == "relaxation_modulus"


@pytest.mark.parametrize(("first", "second", "factor"), [
    ("omega [rad/s]", "f [Hz]", 2 * np.pi), ("f [Hz]", "f [kHz]", 1000.0),
])  # fmt: skip
@pytest.mark.parametrize("digits", [3, 4, 5, 6])
def test_two_columns_that_are_rounded_each(tmp_path, first, second, factor, digits):
    """They differ by the sum of half a unit of both at most."""
    hertz = np.geomspace(0.1, 25, 60)
    columns = [hertz * factor, hertz, 1e6 * (1 + hertz), 1e5 * (1 + hertz)]
    text = table(*columns, head=f"{first},{second},E' [Pa],E'' [Pa]\n", digits=digits)
    assert len(read(tmp_path, text)) == 60
    columns[1] = hertz * (1 + 3 * 10.0**-digits * 10)
    text = table(*columns, head=f"{first},{second},E' [Pa],E'' [Pa]\n", digits=digits)
    refused(tmp_path, text, "two columns of frequency")


@pytest.mark.parametrize(("units", "factor", "kind"), [
    (("s", "min"), 60.0, "t"), (("m/s", "km/h"), 1 / 3.6, "v"), (("m/s", "mph"), 0.44704, "v"),
    (("cm", "in"), 2.54, "h0"),
])  # fmt: skip
def test_other_columns_that_are_rounded_each(tmp_path, units, factor, kind):
    values = np.geomspace(0.3, 70, 40)
    more, name = (np.linspace(0.9, 0.5, 40), "cor") if kind != "t" else (1e6 / values, "E [Pa]")
    head = f"{kind} [{units[0]}],{kind} [{units[1]}],{name}\n"
    for digits in (3, 4, 6):
        assert len(read(tmp_path, table(factor * values, values, more, head=head, digits=digits)))


def test_the_dynamic_modulus_is_the_complex_one(tmp_path):
    for name in ("Dynamic modulus [Pa]", "dynamic_modulus_pa", "Dynamic shear modulus [Pa]"):
        text = table(HERTZ, np.hypot(STORAGE, LOSS), LOSS / STORAGE, head=f"f [Hz],{name},tan d\n")
        data = read(tmp_path, text)
        is_the_material(data)
        assert "complex_modulus from " in data.attrs["taken"]


@pytest.mark.parametrize(("key", "names"), {
    "cor": ["e_n", "eN", "en", "ε", "C.O.R.", "COR", "CoR", "C_R", "normal COR", "cor_n",
            "mean cor", "average COR"],
    "rebound_height": ["height of bounce [m]", "height after bounce [m]", "h_bounce [m]", "h_f [m]",
                       "final height [m]", "Average rebound height [m]",
                       "rebound height (avg) [m]"],
    "rebound_velocity": ["exit speed [m/s]", "v_f [m/s]", "final velocity [m/s]",
                         "mean rebound velocity [m/s]"],
}.items())  # fmt: skip
def test_names_in_use(tmp_path, key, names):
    for name in names:
        data = read(tmp_path, f"v_n [m/s],{name}\n2,0.8\n3,0.7\n")
        assert tuple(data) == ("velocity", key) and list(data[key]) == [0.8, 0.7]


def test_an_index_is_no_unit(tmp_path):
    for name in ("e_s", "e_m", "v_g", "cor_s"):
        assert not read_head(name).name
        refused(tmp_path, f"velocity [m/s],{name}\n2,0.8\n", f"'{name}'")
    assert (read_head("t_ms").name, read_head("t_ms").unit) == ("time", "ms")


FAILED = ["---", "NaN", "nan", "", "n/a", "--", "null"]


@pytest.mark.parametrize("cell", FAILED)
@pytest.mark.parametrize("column", [1, 2])
def test_a_failed_point(tmp_path, cell, column):
    """It is left out and named; the others are read."""
    lines = table(HERTZ, STORAGE, LOSS, head="f [Hz],E' [Pa],E'' [Pa]\n").splitlines()
    cells = lines[4].split(",")
    cells[column] = cell
    data = read(tmp_path, "\n".join([*lines[:4], ",".join(cells), *lines[5:]]))
    assert np.allclose(data.storage_modulus, np.delete(STORAGE, 3))
    assert np.allclose(data.loss_modulus, np.delete(LOSS, 3))
    said = f"'{cell}' in" if cell else "nothing in"
    assert f"; 1 failed point left out: line 5 ({said} 'E'" in data.attrs["taken"]


def test_failed_points_of_other_data(tmp_path):
    data = read(tmp_path, "t [s];E [Pa]\n1;5\n2;---\n3;4\n4;\n5;3\n")
    assert list(data.time) == [1, 3, 5]
    assert (
        "; 2 failed points left out: line 3 ('---' in 'E [Pa]'), line 5 (nothing in"
        in (data.attrs["taken"])
    )
    data = read(tmp_path, "T [C],log10 a_T\n20,0\n30,---\n40,-2\n")
    assert len(data) == 2
    # what is no failed point, and half of the points
    refused(tmp_path, "t [s],E [Pa]\n1,5\n2,abc\n3,4\n", ":3:", "'abc'")
    refused(tmp_path, "t [s],E [Pa]\n1,5\n2,-4\n3,4\n", ":3:", "-4")
    refused(tmp_path, "t [s],E [Pa]\n1,5\n2,\n", ":3:", "no number")


# ------------------------------------------------------------------------------- replicates

RUNS = {
    "one below the other": lambda f: np.tile(f, 3),
    "up and down": lambda f: np.concatenate([f, f[::-1], f]),
    "up and down, the end once": lambda f: np.concatenate([f, f[-2::-1], f[1:]]),
    "three readings at each": lambda f: np.repeat(f, 3),
    "grids of their own": lambda f: np.concatenate([f, 1.1 * f, 0.9 * f]),
    "falling": lambda f: np.tile(f[::-1], 3),
}


def moduli_at(omega, scatter=0.01, seed=1):
    """Moduli of the material with the scatter of each reading."""
    random = np.random.default_rng(seed)
    storage = 2e6 + 3e7 * omega**2 / (1e4 + omega**2)
    loss = 3e7 * 100 * omega / (1e4 + omega**2)
    return [one * np.exp(scatter * random.standard_normal(len(omega))) for one in (storage, loss)]


def replicates(kind, scatter=0.01, *, factor=1.0, before=""):
    omega = RUNS[kind](np.geomspace(10, 1000, 12))
    columns = [omega, *(factor * one for one in moduli_at(omega, scatter))]
    return omega, table(*columns, head=f"{before}omega [rad/s],E' [Pa],E'' [Pa]\n")


@pytest.mark.parametrize("kind", RUNS)
def test_replicates_are_one_curve(tmp_path, kind):
    omega, text = replicates(kind)
    data = read(tmp_path, text)
    (one,) = curves(data)
    assert np.allclose(np.sort(omega), one.frequency)
    assert sorted(one.storage_modulus) == pytest.approx(sorted(data.storage_modulus))
    assert re.search(
        r"; \d+ runs are one curve, as they differ by [\d.]+ % only", data.attrs["taken"]
    )
    (again,) = read_moduli(tmp_path / "data.csv")
    assert len(again) == len(omega)


def test_runs_that_differ_are_no_replicates(tmp_path):
    factors = np.array([1, 2, 4])
    for kind in ("one below the other", "up and down", "three readings at each"):
        omega, _ = replicates(kind)
        storage, loss = moduli_at(omega)
        storage *= np.tile(factors, 12) if kind.startswith("three") else np.repeat(factors, 12)
        text = table(omega, storage, loss, head="omega [rad/s],E' [Pa],E'' [Pa]\n")
        with pytest.raises(vcor.InputError, match=r"found a frequency.*replicates differ by"):
            curves(read(tmp_path, text))


def test_replicates_by_a_column_of_sets(tmp_path):
    omega, _ = replicates("one below the other")
    run = np.repeat([1, 2, 3], len(omega) // 3)
    storage, loss = moduli_at(omega)
    head = "set,omega [rad/s],E' [Pa],E'' [Pa]\n"
    (one,) = curves(read(tmp_path, table(run, omega, storage, loss, head=head)))
    assert len(one) == len(omega) and one.attrs["runs"] == 3
    # other materials stay apart
    found = curves(read(tmp_path, table(run, omega, storage * run, loss, head=head)))
    assert len(found) == 3


def test_replicates_at_several_temperatures(tmp_path):
    omega, _ = replicates("up and down")
    kelvin = np.repeat([283.15, 293.15, 303.15], len(omega))
    moduli = [np.concatenate([moduli_at(omega * f, seed=i)[k] for i, f in enumerate((3, 1, 0.3))])
              for k in (0, 1)]  # fmt: skip
    text = table(kelvin, np.tile(omega, 3), *moduli, head="T [K],omega [rad/s],E' [Pa],E'' [Pa]\n")
    data = read(tmp_path, text)
    found = curves(data)
    assert [one.attrs["temperature"] for one in found] == pytest.approx([283.15, 293.15, 303.15])
    assert "3 runs at each of 3 temperatures are one curve" in data.attrs["taken"]
    # a sweep of temperatures up and another one down
    order = np.concatenate([np.arange(len(kelvin)), np.arange(len(kelvin))[::-1]])
    rows = np.array(text.splitlines()[1:])[order]
    again = curves(read(tmp_path, "\n".join([text.splitlines()[0], *rows])))
    assert [one.attrs["runs"] for one in again] == [6, 6, 6]
    master = vcor.master(tmp_path / "data.csv")
    assert np.allclose(master.log_shift, [np.log10(3), 0, np.log10(0.3)], atol=0.05)


def test_replicates_in_several_files(tmp_path):
    names = []
    for i, (celsius, factor) in enumerate(((10, 3), (10, 3), (20, 1), (20, 1), (30, 0.3))):
        omega = np.geomspace(10, 1000, 12)
        text = table(omega, *moduli_at(omega * factor, seed=i), head="omega,E',E''\n")
        (tmp_path / f"{i}.csv").write_text(text)
        names.append(f"{tmp_path}/{i}.csv@{celsius}C")
    master = vcor.master(names)
    assert [len(one.at) for one in master.curves] == [24, 24, 12]
    assert np.allclose(master.log_shift, [np.log10(3), 0, np.log10(0.3)], atol=0.05)


def test_a_copy_is_no_replicate(tmp_path):
    omega = np.geomspace(10, 1000, 12)
    text = table(omega, *moduli_at(omega), head="omega,E',E''\n")
    for name in ("a", "b"):
        (tmp_path / f"{name}.csv").write_text(text)
    names = [f"{tmp_path}/{name}.csv@20C" for name in ("a", "b")]
    with pytest.raises(vcor.InputError, match="two curves at 20 C"):
        vcor.master([*names, f"{tmp_path}/a.csv@30C"])


def test_the_error_of_a_fit_to_replicates_is_their_scatter(tmp_path):
    """Nine runs leave a third of the error of one, for the same misfit."""
    parts = []
    for runs in (1, 9):
        omega = np.tile(np.geomspace(10, 1000, 12), runs)
        storage, loss = moduli_at(omega, 0.02, seed=3)
        text = table(omega, storage, loss, head="omega,E',E''\n")
        found = vcor.fit(read(tmp_path, text), model="sls", poisson_ratio=0.4)
        assert found.rms == pytest.approx(0.02, rel=0.3)
        error = next(one.error for one in found.parameters if one.name == "beta")
        # a misfit has 24 or 216 data, of which three parameters take some
        parts.append(error / (found.rms * np.sqrt(24 * runs / (24 * runs - 3))))
    assert parts[0] / parts[1] == pytest.approx(3, rel=0.05)


def test_replicates_in_identify_and_a_table(tmp_path, capsys):
    time = np.tile(np.geomspace(1e-3, 1, 9), 3)
    modulus = 2e6 * time**-0.2 * np.exp(0.01 * np.random.default_rng(3).standard_normal(27))
    path = tmp_path / "relaxation.csv"
    path.write_text(table(time, modulus, head="t [s],E [Pa]\n"))
    (tmp_path / "case.nml").write_text(
        "&impact velocity = 1.0 /\n&sphere radius = 0.01, mass = 0.01, material = 'r' /\n"
        "&plate material = 'm', waves = 'none' /\n&material name = 'r', model = 'rigid' /\n"
        "&material name = 'm', model = 'power_law', coefficient = 1e6, exponent = 0.3, "
        "poisson_ratio = 0.5 /\n"
    )
    found = vcor.identify(vcor.read(tmp_path / "case.nml"), path, ["m.exponent", "m.coefficient"])
    assert found["m.exponent"] == pytest.approx(0.2, abs=0.01)
    rows = printed(capsys, path, "--quiet").out.splitlines()[1:]
    at, mean = np.array([[float(x) for x in row.split(",")] for row in rows]).T
    assert np.allclose(at, time[:9]) and np.allclose(
        np.log(mean), np.log(modulus).reshape(3, 9).mean(axis=0)
    )


# ------------------------------------------------------------------------------ bounded work


def test_a_stray_cell_far_away(tmp_path):
    """It costs neither memory nor time; one that belongs to the table makes it too wide."""
    path = tmp_path / "data.xlsx"
    frame = pd.DataFrame({"f [Hz]": HERTZ, "E' [MPa]": STORAGE / 1e6, "E'' [MPa]": LOSS / 1e6})
    for place, value in (("XFD20000", "remark"), ("XFD1", "remark"), ("A200000", None)):
        with pd.ExcelWriter(path) as book:
            frame.to_excel(book, sheet_name="Sweep", index=False, startrow=3)
            book.sheets["Sweep"][place] = value
        is_the_material(read_data(path))
    with pd.ExcelWriter(path) as book:
        frame.to_excel(book, sheet_name="Sweep", index=False)
        book.sheets["Sweep"]["XFD20000"] = 5.0
    with pytest.raises(vcor.InputError, match="found 16384 columns, but the head has 3 names"):
        read_data(path)


def test_spreadsheets_have_a_bound(tmp_path, monkeypatch):
    path = tmp_path / "data.xlsx"
    pd.DataFrame({"t [s]": [1, 2], "E [Pa]": [2, 1]}).to_excel(path, index=False)
    monkeypatch.setattr(grid, "_MOST_CELLS", 5)
    with pytest.raises(vcor.InputError, match="data.xlsx:3: found more than"):
        read_data(path)


def test_numbers_and_errors_of_spreadsheets(tmp_path):
    path = tmp_path / "data.xlsx"
    times, moduli = [1, 2.5, 3, 4.0, 5], [5e6, 4.25e6, "#DIV/0!", 3e6, 2.123456789e6]
    pd.DataFrame({"t [s]": times, "E [Pa]": moduli, "x": None}).to_excel(path, index=False)
    data = read_data(path)
    assert list(data.time) == [1, 2.5, 4, 5]
    assert list(data.relaxation_modulus) == [5e6, 4.25e6, 3e6, 2.123456789e6]
    assert "1 failed point left out: line 4" in data.attrs["taken"]


def test_tables_have_a_bound(tmp_path):
    text = "t [s],E [Pa]" + ",x" * 3000 + "\n1,5\n2,4\n"
    refused(tmp_path, text, ":1: found 3002 columns, expected at most 2000")


@pytest.mark.parametrize("cell", [
    "0e400", "1e400", "0e-400", "1e" + "9" * 50, "1e-400", "0e" + "9" * 5000, "1e+99999",
    "0." + "0" * 5000 + "1",
])  # fmt: skip
def test_exponents_of_any_length(tmp_path, cell):
    """A number that cannot be represented, or is 0, is refused with its line."""
    for head in ("t [s],E [Pa]\n", "t [s],E [Pa],E [MPa]\n"):
        more = "," * (head.count(",") > 1)
        text = f"{head}1,5{more}\n2,{cell}{more and ',' + cell}\n3,4{more}\n"
        with pytest.raises(vcor.InputError) as caught:
            read(tmp_path, text)
        assert len(str(caught.value)) < 300 + len(str(tmp_path))
