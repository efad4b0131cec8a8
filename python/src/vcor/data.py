"""Measured data: columns of numbers in SI units, by the names of their header."""

from __future__ import annotations

import csv
import math
import os
import re
from pathlib import Path

import numpy as np

from ._library import FileError, Floats, InputError

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
#: Units that take a prefix
SCALED = ("m", "s", "m/s", "N", "Pa", "J", "W", "Hz", "rad/s", "g")
#: Sizes of units that are not those of the columns of vcor
_SIZES = {
    "Hz": 2 * math.pi, "g": 1e-3, "%": 0.01, "min": 60.0, "h": 3600.0, "N/mm2": 1e6, "cm": 0.01,
    "cm/s": 0.01,
}  # fmt: skip
#: 0 C [K]
_ZERO_C = 273.15
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
}  # fmt: skip
#: Columns of a file of moduli without a header
_UNNAMED = {2: ["time", "relaxation_modulus"], 3: ["frequency", "storage_modulus", "loss_modulus"]}


class Data:
    """A file of measured points.

    Columns are separated by commas, semicolons, tabs or blanks. The header names them, with units
    in brackets or in a second line where they are not SI; `#` begins a remark.

    Parameters
    ----------
    path
        The file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        try:
            text = Path(path).read_text(encoding="utf-8-sig")
        except OSError as error:
            raise FileError(f"{self.path}: {error.strerror}") from None
        except UnicodeDecodeError:
            raise InputError(f"{self.path}: this is no text") from None
        lines = [line for line in text.splitlines() if line.split("#")[0].strip()]
        mark = next((mark for mark in ";\t," if lines and mark in lines[0]), " ")
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=mark)]
        if mark == " ":
            rows = [re.findall(r"[^\s\[]+(?:\s*\[[^\]]*\])?", line) for line in lines]
        if rows and all(map(_is_number, rows[0])) and len(rows[0]) in _UNNAMED:
            rows.insert(0, _UNNAMED[len(rows[0])])
        if len(rows) < 2:
            raise InputError(f"{self.path}: expected a header and at least one row of numbers")
        units = rows.pop(1) if not any(map(_is_number, rows[1])) else None
        #: Columns in SI units, by name
        self.columns: dict[str, Floats] = {}
        for i, head in enumerate(rows[0]):
            found = re.fullmatch(r"(.+?)\s*(?:\[(.*)\]|\s\((.*)\))?", head)
            if not found:
                raise InputError(f"{self.path}:1: found '{head}' as name of a column")
            name, unit = found[1], found[2] or found[3]
            if units and i < len(units):
                unit = units[i]
            if unit is None and name in ("f", "freq"):
                unit = "Hz"
            try:
                cells = [row[i] if mark == "," else row[i].replace(",", ".") for row in rows[1:]]
                values = [float(cell) if cell else math.nan for cell in cells]
            except (ValueError, IndexError):
                raise InputError(f"{self.path}: column '{name}' holds more than numbers") from None
            zero = _ZERO_C if (unit or "").strip("°") == "C" else 0.0
            size = 1.0 if zero else self._size(unit or "")
            what = name.removesuffix("_sigma")
            ending = name[len(what) :]
            self.columns[NAMES.get(what, what) + ending] = np.array(values) * size + (
                0.0 if ending else zero
            )

    def _size(self, unit: str) -> float:
        """A unit in SI units."""
        unit = unit.replace("μ", "µ").replace("us", "µs").replace("^", "")
        if unit in _PLAIN:
            return 1.0
        for power, prefix in PREFIXES.items():
            if unit.startswith(prefix) and unit.removeprefix(prefix) in SCALED:
                return float(10.0**power) * _SIZES.get(unit.removeprefix(prefix), 1.0)
        if unit not in _SIZES:
            raise InputError(f"{self.path}: unknown unit '{unit}', expected such as s, MPa, rad/s")
        return _SIZES[unit]

    def find(self, name: str) -> tuple[Floats | None, Floats | None]:
        """Values and standard errors of a quantity or an address, None where there are none."""
        for key in (name, name.rpartition(".")[2]):
            if key in self.columns:
                return self.columns[key], self.columns.get(f"{key}_sigma")
        return None, None


def _is_number(cell: str) -> bool:
    return re.fullmatch(r"[-+]?[\d.,]+([eEdD][-+]?\d+)?|nan", cell) is not None
