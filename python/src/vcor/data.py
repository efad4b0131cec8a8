"""Measured data: columns of numbers in SI units, by the names of their header."""

from __future__ import annotations

import csv
import math
import os
import re

import numpy as np

from ._command import read_text
from ._library import Floats, InputError

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
#: Units that take a prefix
SCALED = ("m", "s", "m/s", "N", "Pa", "J", "W", "Hz", "rad/s", "g")
#: Sizes of units that are not those of the columns of vcor
_SIZES = {
    "Hz": 2 * math.pi, "g": 1e-3, "%": 0.01, "min": 60.0, "h": 3600.0, "N/mm2": 1e6, "cm": 0.01,
    "cm/s": 0.01,
}  # fmt: skip
#: 0 C [K]
ZERO_C = 273.15
_PLAIN = ("", "1", "-", "1/s", "kg", "kg/m3", "K", "N s", "N/m2")
#: Names that others give to columns, and what these are
NAMES = {
    "T": "temperature", "t": "time", "omega": "frequency", "w": "frequency",
    "angular_frequency": "frequency",
    "f": "frequency", "freq": "frequency", "e": "cor",
    "e_a": "cor_sphere", "t0": "contact_time", "s_max": "max_indentation", "F_max": "max_force",
    "E": "relaxation_modulus",
    "E(t)": "relaxation_modulus", "modulus": "relaxation_modulus", "E_relax": "relaxation_modulus",
    "E'": "storage_modulus", "E_stor": "storage_modulus", "storage": "storage_modulus",
    "E''": "loss_modulus", "E_loss": "loss_modulus", "loss": "loss_modulus",
    "tan_delta": "loss_tangent", "tan(d)": "loss_tangent", "loss_factor": "loss_tangent",
    "temp": "temperature", "v": "velocity", "impact_velocity": "velocity",
    "fall_height": "drop_height", "coefficient_of_restitution": "cor",
}  # fmt: skip
#: Columns of a laboratory's table that are no data
_ASIDE = ("nr", "no", "number", "run", "test", "sample", "specimen", "id", "date", "remark",
          "comment", "note", "operator")  # fmt: skip
#: Columns of a file of moduli without a header
_UNNAMED = {2: ["time", "relaxation_modulus"], 3: ["frequency", "storage_modulus", "loss_modulus"]}


class Data:
    """A file of measured points.

    Columns are separated by commas, semicolons, tabs or blanks. The header, which other lines may
    precede, names them, with units in brackets or in a second line where they are not SI; `#`
    begins a remark.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        try:
            text = read_text(path, "strict")
        except UnicodeDecodeError:
            raise InputError(f"{self.path}: this is no text") from None
        lines = [line for line in text.splitlines() if line.split("#")[0].strip(" ;,\t")]
        lines = [line for line in lines if not line.lower().startswith("sep=")]
        marks = [mark for mark in ";\t" if any(mark in line for line in lines)]
        mark = marks[0] if marks else "," if lines and "," in lines[0] else " "
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=mark)]
        if mark == " ":
            rows = [re.findall(r"[^\s\[]+(?:\s*\[[^\]]*\])?", line) for line in lines]
        if rows and all(map(_is_number, rows[0])) and len(rows[0]) in _UNNAMED:
            rows.insert(0, _UNNAMED[len(rows[0])])
        # a row of numbers may begin with a word, a line of the instrument may hold one number
        first = next((i for i, row in enumerate(rows) if i and (
            sum(map(_is_number, row)) > 1 or _is_number(row[0]))), 0)  # fmt: skip
        if not first:
            raise InputError(f"{self.path}: expected a header and at least one row of numbers")
        second = first == 2 and len(rows[0]) >= len(rows[1])
        units = rows[first - 1] if second or all(map(_is_unit, rows[first - 1])) else None
        heads, rows = rows[first - 1 - (units is not None)], rows[first:]
        #: Columns in SI units, by name
        self.columns: dict[str, Floats] = {}
        for i, head in enumerate(heads):
            found = re.fullmatch(r"(.+?)\s*(?:\[(.*)\]|\s\((.*)\))?", head)
            if not found:
                raise InputError(f"{self.path}: found '{head}' as name of a column")
            name, unit = plain_name(found[1]), found[2] or found[3]
            if name in _ASIDE:
                continue
            if units and i < len(units):
                unit = units[i].strip("[]()")
            if unit is None and found[1] in ("f", "freq"):
                unit = "Hz"
            try:
                cells = [row[i] if mark == "," else row[i].replace(",", ".") for row in rows]
                values = [float(cell) if cell else math.nan for cell in cells]
            except (ValueError, IndexError):
                raise InputError(f"{self.path}: column '{name}' holds more than numbers") from None
            zero = ZERO_C if _is_celsius(unit or "") else 0.0
            size = 1.0 if zero else _size(unit or "")
            if math.isnan(size):
                raise InputError(f"{self.path}: column '{name}': unknown unit '{unit}', expected "
                                 "such as cm, ms, MPa, rad/s")  # fmt: skip
            shift = 0.0 if name.endswith("_sigma") else zero
            self.columns[name] = np.array(values) * size + shift

    def find(self, name: str) -> tuple[Floats | None, Floats | None]:
        """Values, temperatures in C, and standard errors of a quantity or an address, else None."""
        zero = ZERO_C if is_temperature(name) else 0.0
        for key in (name, name.rpartition(".")[2]):
            if key in self.columns:
                return self.columns[key] - zero, self.columns.get(f"{key}_sigma")
        return None, None


def _size(unit: str) -> float:
    """A unit in SI units, nan if it is none."""
    unit = unit.replace("μ", "µ").replace("us", "µs").replace("^", "")
    if unit in _PLAIN:
        return 1.0
    for power, prefix in PREFIXES.items():
        if unit.startswith(prefix) and unit.removeprefix(prefix) in SCALED:
            return float(10.0**power) * _SIZES.get(unit.removeprefix(prefix), 1.0)
    return _SIZES.get(unit, math.nan)


def _is_celsius(unit: str) -> bool:
    return unit.strip("° ") in ("C", "degC")


def _is_unit(cell: str) -> bool:
    unit = cell.strip("[]()")
    return _is_celsius(unit) or not math.isnan(_size(unit))


def is_temperature(name: str) -> bool:
    """Whether a quantity or an address is a temperature, which figures show in degrees Celsius."""
    return "temperature" in name.rpartition(".")[2]


def plain_name(head: str) -> str:
    """Name of a column as vcor has it, whatever blanks and capitals it is written with."""
    head, ending = re.findall(r"(.+?)([ _](?:sigma|sd|std))?$", head.strip())[0]
    if head not in NAMES and not re.search(r"\.\w", head):
        head = re.sub(r"[\s-]+", "_", head.rstrip(".").lower())
    return NAMES.get(head, head) + ("_sigma" if ending else "")


def _is_number(cell: str) -> bool:
    return re.fullmatch(r"[-+]?[\d.,]+([eEdD][-+]?\d+)?|nan", cell) is not None
