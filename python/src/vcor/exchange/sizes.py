"""Mixtures from a table of materials and sizes, for the command `vcor export --mixture`."""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import _text
from .._library import InputError, UsageError
from ..arguments import value_of
from ..case import Case, read
from ..units import examples, size
from .mixture import mixture

#: Columns of the table
COLUMNS = ("material", "radius", "diameter", "thickness")
#: Words for the size of a wall
WALL = ("wall", "inf", "infinity")
#: Addresses of a case that the table has instead, and `plate.surface_radius` of beads
_BODIES = {
    "impact": ("velocity", "drop_height"),
    "sphere": ("radius", "diameter", "mass", "material"),
    "plate": ("material", "surface_radius"),
}

#: Line, material, radius and thickness [m] of a body; a radius of a wall is infinite
Row = tuple[int, str, float, float | None]


def cases_of(path: str | os.PathLike[str], files: Sequence[str]) -> list[Case]:
    """Cases of all pairs of a mixture.

    Parameters
    ----------
    path
        Table with the columns `material` and `radius [UNIT]` or `diameter [UNIT]`, a row for each
        type of beads and each wall; the size of a wall is `wall`. `thickness [UNIT]` is that of
        walls, empty for a half space.
    files
        Files of &material groups; the first may be a case, or some of its groups, whose contact,
        temperature, gravity and walls count, and not its bodies.

    Returns
    -------
    list of Case
        As `mixture` makes them.

    Raises
    ------
    InputError
        The table is none, or names a material that the files do not have.
    """
    rows = _rows(os.fspath(path))
    case = _case_of(files)
    for line, name, _, _ in rows:
        if f"{name}.density" not in case:
            raise InputError(f"{os.fspath(path)}:{line}: found material '{name}', expected one of "
                             f"{', '.join(files)}")  # fmt: skip
    materials, groups = _groups(case, rows[0][1])
    beads = [(materials[name], radius) for _, name, radius, _ in rows if radius < math.inf]
    walls: list[Any] = [materials[name] if thickness is None else (materials[name], thickness)
                        for _, name, radius, thickness in rows if radius == math.inf]  # fmt: skip
    return mixture(beads, walls, **groups)


def _rows(path: str) -> list[Row]:
    """Bodies of the table."""
    lines = [(n, line) for n, line in enumerate(_text.read_text(path).splitlines(), 1)
             if line.strip() and not line.lstrip().startswith(("#", "!"))]  # fmt: skip
    if len(lines) < 2:
        raise InputError(f"{path}: found {len(lines)} lines, expected a table with the columns "
                         "material and radius [mm], and a row for each type")  # fmt: skip
    mark = next((one for one in (";", "\t", ",") if one in lines[0][1]), None)
    if mark is None:
        raise InputError(f"{path}:{lines[0][0]}: found one column, expected material, radius [mm], "
                         "with commas between the columns")  # fmt: skip
    cells = [[cell.strip() for cell in one]
             for one in csv.reader([line for _, line in lines], delimiter=mark)]  # fmt: skip
    units = _heads(cells[0], f"{path}:{lines[0][0]}")
    found: list[Row] = []
    for (n, _), row in zip(lines[1:], cells[1:], strict=False):
        place = f"{path}:{n}"
        if len(row) > len(units) and any(row[len(units) :]):
            raise InputError(f"{place}: found {len(row)} cells, expected {len(units)}")
        given = dict(zip(units, row, strict=False))
        name, thickness = given.get("material", ""), given.get("thickness", "")
        radius = math.inf
        of = "radius" if "radius" in units else "diameter"
        if not name:
            raise InputError(f"{place}: found no material, expected its name")
        if given.get(of, "").lower() not in WALL:
            radius = _length(given.get(of, ""), units[of], mark, f"{place}: {of}", " or wall")
            radius /= 1 + (of == "diameter")
            if thickness:
                raise InputError(f"{place}: found a thickness of beads, expected none: only a wall "
                                 "has one")  # fmt: skip
        depth = (_length(thickness, units["thickness"], mark, f"{place}: thickness")
                 if thickness else None)  # fmt: skip
        if any(one[1:] == (name, radius, depth) for one in found):
            raise InputError(f"{place}: found this type for the second time, expected each once")
        found.append((n, name, radius, depth))
    if all(radius == math.inf for _, _, radius, _ in found):
        raise InputError(f"{path}: found {len(found)} walls, expected one type of beads or more")
    return found


def _heads(cells: Sequence[str], place: str) -> dict[str, float]:
    """Columns of the table, each with the size of its unit [m]."""
    units: dict[str, float] = {}
    for cell in cells:
        parts = re.fullmatch(r"([^\W_]+)(?:\s*[\[(]\s*(.*?)\s*[\])]|_(\w+))?", cell)
        name = parts[1].lower() if parts else cell
        if parts is None or name not in COLUMNS or name in units:
            raise InputError(f"{place}: found the column '{cell}', expected material and "
                             "radius [mm] or diameter [mm], each once, and of walls thickness [mm]"
                             f"{_text.near(name, COLUMNS)}")  # fmt: skip
        unit = parts[2] or parts[3]
        if name == "material":
            units[name] = 1.0
            continue
        known = size(unit or "", "m")
        if not unit or known is None:
            raise InputError(f"{place}: found the column '{cell}', expected its unit, such as "
                             f"{name} [mm]; units are {examples('m')}")  # fmt: skip
        units[name] = known[0]
    if "material" not in units or ("radius" in units) == ("diameter" in units):
        raise InputError(f"{place}: found the columns {', '.join(cells)}, expected material and "
                         "one of radius [mm] and diameter [mm]")  # fmt: skip
    return units


def _length(text: str, unit: float, mark: str, what: str, more: str = "") -> float:
    """A length > 0 [m]; with other separators a comma is that of decimals."""
    try:
        value = float(text if mark == "," else text.replace(",", ".")) * unit
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise InputError(f"{what}: found '{text}', expected a number > 0{more}")
    return value


def _case_of(files: Sequence[str]) -> Case:
    """The first file, a case or materials, completed by files of materials."""
    case = read(files[0])
    for path in files[1:]:
        other = read(path)
        if any(other[f"{body}.material"] for body in ("sphere", "plate")):
            raise UsageError(f"{path}: found a case after the first file, expected files of "
                             "materials: the bodies are those of the table of sizes")  # fmt: skip
        case.add(other)
    return case


def _groups(
    case: Case, material: str
) -> tuple[dict[str, dict[str, Any]], dict[str, dict[str, Any]]]:
    """Groups &material of a case by their names, and its other groups without its bodies."""
    # only a case with bodies has a text; those of the table take their place
    for body in ("sphere", "plate"):
        case[f"{body}.material"] = material
    if case["sphere.radius"] is None and case["sphere.diameter"] is None:
        case["sphere.radius"] = 1.0
    if case["impact.velocity"] is None and case["impact.drop_height"] is None:
        case["impact.velocity"] = 1.0
    folder = Path(case.name).parent
    materials: dict[str, dict[str, Any]] = {}
    groups: dict[str, dict[str, Any]] = {}
    for found in re.finditer(r"(?ms)^&(\w+)\n(.*?)^/$", case.text()):
        keys = {line[1]: value_of(line[2])
                for line in re.finditer(r"(?m)^   (\S+) = (.*)$", found[2])}  # fmt: skip
        if found[1] == "material":
            if "file" in keys:
                # the cases of the pairs are in no folder
                keys["file"] = str((folder / str(keys["file"])).absolute())
            materials[str(keys["name"])] = keys
        elif found[1] == "sweep":
            raise InputError(f"{case.name}: found a &sweep group, expected a case without one for "
                             "a mixture")  # fmt: skip
        elif found[1] in (*_BODIES, "contact", "solver"):
            rest = {key: value for key, value in keys.items()
                    if key not in _BODIES.get(found[1], ())}  # fmt: skip
            if found[1] == "sphere" and rest:
                raise InputError(f"{case.name}: found sphere.{next(iter(rest))}, expected spheres "
                                 "without it: the beads are those of the table")  # fmt: skip
            if rest and rest != {"waves": "none"}:
                groups[found[1]] = rest
    return materials, groups
