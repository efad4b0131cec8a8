"""Measured data: columns of numbers in SI units, by the names of their header."""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Callable

import numpy as np

from .._library import Floats, InputError
from .._text import read_text

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
#: Units that take a prefix
SCALED = ("m", "s", "m/s", "N", "Pa", "J", "W", "Hz", "rad/s", "g")
#: Units that are not those of the columns of vcor: how much of which
_OTHERS = {
    "Hz": (2 * math.pi, "rad/s"), "g": (1e-3, "kg"), "%": (0.01, "1"), "-": (1.0, "1"),
    "min": (60.0, "s"), "h": (3600.0, "s"), "N/m2": (1.0, "Pa"), "N/mm2": (1e6, "Pa"),
    "cm": (0.01, "m"), "cm/s": (0.01, "m/s"),
}  # fmt: skip
#: 0 C [K]
ZERO_C = 273.15
#: Temperature below which one without a unit is none in kelvin
_COLDEST = 150.0
_PLAIN = ("", "1", "1/s", "kg", "kg/m3", "K", "N s")
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
    unit_of
        SI unit that a column of some name has; empty: any.
    """

    def __init__(
        self, path: str | os.PathLike[str], unit_of: Callable[[str], str] = lambda _: ""
    ) -> None:
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
            if name in self.columns:
                raise InputError(f"{self.path}: found two columns '{name}', expected one")
            if units and i < len(units):
                unit = units[i].strip("[]()")
            if unit is None and found[1] in ("f", "freq"):
                unit = "Hz"
            values: list[float] = []
            try:
                for row in rows:
                    cell = row[i] if mark == "," else row[i].replace(",", ".")
                    values.append(float(cell) if cell else math.nan)
            except (ValueError, IndexError):
                cell = f"'{row[i]}'" if i < len(row) else "no cell"
                raise InputError(f"{self.path}: column '{name}' holds more than numbers: found "
                                 f"{cell} in row {rows.index(row) + 1}") from None  # fmt: skip
            expected = unit_of(name.removesuffix("_sigma"))
            zero = ZERO_C if _is_celsius(unit or "") else 0.0
            size, si = (1.0, "K") if zero else _size(unit or "", expected)
            known = not math.isnan(size)
            if not known or (unit and expected not in ("", si)):
                what = f"found '{unit}' as unit" if known else f"unknown unit '{unit}'"
                ours = {"": "such as cm, ms, MPa, rad/s", "K": "K or C"}.get(
                    expected, f"{expected} or a multiple of it"
                )
                raise InputError(f"{self.path}: column '{name}': {what}, expected {ours}")
            shift = 0.0 if name.endswith("_sigma") else zero
            self.columns[name] = np.array(values) * size + shift
            warmest = np.nan_to_num(values).max(initial=0.0)
            if expected == "K" and not unit and is_temperature(name) and warmest < _COLDEST:
                raise InputError(f"{self.path}: column '{name}': found at most {warmest:g} K, "
                                 f"expected {name} [C] for degrees Celsius, or [K]")  # fmt: skip

    def find(self, name: str) -> tuple[Floats | None, Floats | None]:
        """Values, temperatures in C, and standard errors of a quantity or an address, else None."""
        zero = ZERO_C if is_temperature(name) else 0.0
        for key in (name, name.rpartition(".")[2]):
            if key in self.columns:
                return self.columns[key] - zero, self.columns.get(f"{key}_sigma")
        return None, None


def _size(unit: str, own: str = "1") -> tuple[float, str]:
    """A unit as so much, nan if it is none, of which SI unit, its own one among them."""
    unit = unit.replace("μ", "µ").replace("us", "µs").replace("^", "")
    if unit in (own, *_PLAIN):
        return 1.0, unit
    for power, prefix in PREFIXES.items():
        base = unit.removeprefix(prefix)
        if unit.startswith(prefix) and base in SCALED:
            size, si = _OTHERS.get(base, (1.0, base))
            return 10.0**power * size, si
    return _OTHERS.get(unit, (math.nan, ""))


def _is_celsius(unit: str) -> bool:
    return unit.strip("° ") in ("C", "degC")


def _is_unit(cell: str) -> bool:
    unit = cell.strip("[]()")
    return _is_celsius(unit) or not math.isnan(_size(unit)[0])


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
