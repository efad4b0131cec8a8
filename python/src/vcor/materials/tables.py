"""Tables of a file: where they are, what their heads say, and which columns belong together."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _library
from .._library import InputError, UsageError
from .._text import option
from ..units import plain_unit, size
from .grid import Grid, Row, is_missing, is_number, number, resolution, split_line
from .labels import UNLABELLED, Label, read_label
from .names import (
    CURVES,
    QUANTITIES,
    Head,
    canonical,
    is_average,
    plain,
    plain_units,
    read_head,
)
from .select import Where, conditions

#: Logarithm of a factor by which replicates differ at most: specimens of a material scatter by some
#: percent, while moduli at temperatures between which it relaxes differ by more than this
REPLICATES = 0.2
#: Heads that a message shows
MOST_HEADS = 12


@dataclass
class Table:
    """Rows of numbers under one head."""

    #: Line of the head, 0: there is no head
    line: int
    heads: list[Head]
    #: Temperature in a title, and rows, for each part below a title
    parts: list[tuple[Label, list[Row]]]
    #: Fault of it, for a message if it is used
    flaw: str = ""

    def rows(self) -> list[Row]:
        """All rows."""
        return [row for _, rows in self.parts for row in rows]

    def is_empty(self, index: int) -> bool:
        """Whether a column has no value in any row."""
        return all(len(row.cells) <= index or is_missing(row.cells[index]) for row in self.rows())

    def texts(self) -> list[str]:
        """Heads that say something."""
        return [head.text.strip() for head in self.heads if head.text.strip()]


@dataclass(frozen=True)
class Column:
    """A column that is taken."""

    index: int
    head: Head

    def cell(self, row: Row) -> str:
        """Its cell in a row, empty if the row ends before."""
        return row.cells[self.index] if self.index < len(row.cells) else ""


#: Columns of one curve by their keys, and its temperature [K], nan: not in the head
Group = tuple[float, dict[str, Column]]


class Choice:
    """Which columns and units a user says a file has, or several that share it."""

    def __init__(
        self,
        columns: Mapping[str, str | int] | Sequence[str] | None,
        units: Mapping[str, str] | Sequence[str] | str | None,
        files: int = 1,
        where: Where = None,
    ) -> None:
        """Take the `columns`, `units` and `where` that a user gives to a command or function.

        `files` is the number of files that share them: what one lacks may stand in another.
        UsageError: a name of no quantity.
        """
        #: Which rows are taken
        self.where = conditions(where)
        #: Whether what one file lacks may stand in another
        self.shared = files > 1
        #: Texts of `columns` that a file had, and heads of the files
        self._seen: set[str] = set()
        self._heads: dict[str, None] = {}
        columns, units = _texts(columns, "columns"), _texts(units, "units")
        if isinstance(columns, str):
            columns = columns.split(",")
        #: Names of the columns of a file without a head, in their order
        self.order = [] if columns is None or isinstance(columns, Mapping) else list(columns)
        self.columns: dict[str, tuple[str, float]] = {}
        if isinstance(columns, Mapping):
            for key, text in columns.items():
                name, base = _named(key)
                self.columns[name] = str(text), base
        for name in filter(None, map(str.strip, self.order)):
            _named(name)
        self.units: dict[str, str] = {}
        if isinstance(units, Mapping):
            self.units = {_named(key)[0]: unit for key, unit in units.items()}
            units = None
        if isinstance(units, str):
            units = units.split(",")
        #: Units of columns without one, each for those of its quantity
        self.free = [unit.strip() for unit in units or [] if unit.strip()]

    def heads(self, table: Table) -> list[Head]:
        """Heads of a table, with those that the user says in place of those in the file."""
        heads = list(table.heads)
        said = set()
        for name, (text, base) in self.columns.items():
            at = [i for i, head in enumerate(heads) if _matches(head, text)]
            if not at and text.isdigit() and 0 < int(text) <= len(heads):
                at = [int(text) - 1]
            if len(at) != 1:
                continue
            told, head = read_head(name), heads[at[0]]
            heads[at[0]] = replace(
                told,
                text=head.text,
                unit=head.unit or _unit_of(head),
                base=base or head.base,
                temperature=head.temperature,
                flaw="",
                shear=told.shear if head.shear is None else head.shear,
                run=head.run,
                angular=False,
            )
            said.add((at[0], told.key))
        # what the user says is that quantity, nothing else is
        keys = {key for _, key in said}
        return [
            replace(head, name="", flaw="")
            if head.key in keys and (i, head.key) not in said
            else head
            for i, head in enumerate(heads)
        ]

    def look(self, tables: Sequence[Table]) -> None:
        """Note which texts of `columns` the tables of a file have."""
        self._heads |= dict.fromkeys(text for table in tables for text in table.texts())
        self._seen |= {
            text
            for text, _ in self.columns.values()
            for table in tables
            if any(_matches(head, text) for head in table.heads)
            or (text.isdigit() and 0 < int(text) <= len(table.heads))
        }

    def select(self, grid: Grid) -> Grid:
        """Rows of the sheets that are taken."""
        for one in self.where:
            if plain(one.name) != "sheet" or not any(row.sheet for row in grid.rows):
                continue
            taken, rows = True, []
            for row in grid.rows:
                taken = one.takes(row.text) if row.sheet else taken
                if taken:
                    rows.append(row)
            if not one.met:
                raise one.refusal(f"{grid.path} has")
            grid = replace(grid, rows=rows)
        return grid

    def filter(self, table: Table) -> bool:
        """Leave the rows of a table that are taken; whether there are any."""
        for one in self.where:
            at = [i for i, head in enumerate(table.heads) if _matches(head, one.name)]
            if not at and plain(one.name) == "line":
                table.parts = [
                    (title, [row for row in rows if one.takes(str(row.line))])
                    for title, rows in table.parts
                ]
                continue
            if not at and one.name.isdigit() and 0 < int(one.name) <= len(table.heads):
                at = [int(one.name) - 1]
            if len(at) != 1 or plain(one.name) == "temperature":
                continue
            column = Column(at[0], table.heads[at[0]])
            table.parts = [
                (title, [row for row in rows if one.takes(column.cell(row))])
                for title, rows in table.parts
            ]
        return any(rows for _, rows in table.parts)

    def refuse_unseen(self, where: str) -> None:
        """Refuse a text of `columns` that no file had, and a condition that took no row."""
        for one in self.where:
            if not one.met:
                raise one.refusal(where)
        self.refuse_unread(where)

    def refuse_unread(self, where: str) -> None:
        """Refuse a text of `columns` that no file had."""
        for text, _ in self.columns.values():
            if text not in self._seen:
                known = ", ".join(f"'{one}'" for one in [*self._heads][:MOST_HEADS])
                known += ", ..." * (len(self._heads) > MOST_HEADS)
                raise UsageError(f"{option('columns')}: {where} no column '{text}', expected one "
                                 f"of {known}")  # fmt: skip


def _texts(given: Any, name: str) -> Any:
    """Columns as a user gives them: a text, texts, or texts by their names; else refused."""
    if isinstance(given, np.ndarray):
        given = given.tolist()
    if given is None or isinstance(given, str):
        return given
    words = given
    if isinstance(given, Mapping):
        # a column may be a number
        words = [*given, *(str(one) if name == "columns" else one for one in given.values())]
    if not isinstance(words, Sequence) or not all(isinstance(one, str) for one in words):
        raise UsageError(f"{option(name)}: found {given!r:.60}, expected texts, or texts by the "
                         "names of quantities")  # fmt: skip
    return given


def _named(key: str) -> tuple[str, float]:
    """Name that a user gives to a column."""
    name, base = canonical(key)
    if not name:
        raise UsageError(
            f"unknown quantity '{key}', expected a name such as storage_modulus, "
            "frequency, temperature, cor or time"
        )
    return name, base


def _matches(head: Head, text: str) -> bool:
    """Whether a text is the head of a column, with or without its unit."""
    given = plain(text)
    return given != "" and given in (plain(head.text), plain(re.sub(r"[\[(/].*", "", head.text)))


def _unit_of(head: Head) -> str:
    """Unit in brackets of a head whose name is not known."""
    found = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", head.text)
    return found[1] if found else ""


def tables_of(grid: Grid, choice: Choice) -> list[Table]:
    """Tables of a file: runs of numbers, and the heads above them."""
    hints = _hints(grid)
    found: list[Table] = []
    rows, start = grid.rows, 0
    gap: list[Row] = []
    stray: list[Row] = []
    while start < len(rows):
        if not _is_data(rows[start]):
            gap.append(rows[start])
            start += 1
            continue
        end = start
        while end < len(rows) and _is_data(rows[end]):
            end += 1
        run = rows[start:end]
        table = _table(grid, gap, run, hints, choice)
        title = _titled(gap)
        if table:
            table.parts = [(title, run)]
            found.append(table)
            stray = []
        elif found and title and title.alone:
            found[-1].parts.append((title, run))
            found[-1].flaw = found[-1].flaw or _too_wide(grid, run, found[-1])
        elif len(run) == 1 and _has_tags(grid, run[0]):
            # temperatures above the names of columns
            gap, start = [*gap, *run], end
            continue
        elif found and all(row.remark and not row.sheet for row in gap):
            # remarks among the numbers of a table
            found[-1].parts[-1][1].extend(run)
            found[-1].flaw = found[-1].flaw or _too_wide(grid, run, found[-1])
        elif found:
            stray += [row for row in run if _fits(row, found[-1])]
            if len(stray) > 1 or (stray and end == len(rows)):
                text = gap[-1].text if gap else ""
                found[-1].flaw = (
                    f"{grid.path}:{stray[0].line}: found numbers below '{text[:40]}', "
                    "expected a head above them"
                )
        gap, start = [], end
    if not found and choice.order:
        run = [row for row in rows if row.numbers()]
        if run:
            found = [_nameless(grid, run, choice)]
    return found


def _is_data(row: Row) -> bool:
    """Whether a line has numbers that are data, not a temperature with its unit."""
    numbers, filled = 0 if row.remark else row.numbers(), row.filled()
    # a label has two numbers at most: its own, and one of a step
    plenty = numbers > 2 and 2 * numbers > filled
    return plenty or numbers == filled > 0 or (numbers > 0 and not _label(row))


def _label(row: Row, *, among_others: bool = False) -> Label:
    """The temperature that a line states."""
    text = " ".join(filter(None, row.cells)) if row.cells else row.text
    found = read_label(text, among_others=among_others)
    return replace(found, line=row.line) if found else found


def _too_wide(grid: Grid, run: Sequence[Row], table: Table) -> str:
    """Error of rows that have numbers beyond the names of a table."""
    names = len(table.heads)
    width = max((i + 1 for row in run for i, c in enumerate(row.cells) if is_number(c)), default=0)
    if width <= names:
        return ""
    flaw = f"{grid.path}:{table.line}: found {width} columns, but the head has {names} names"
    if grid.separator == ",":
        flaw += "; expected semicolons or tabs between numbers with decimal commas"
    return flaw


def _table(
    grid: Grid, gap: list[Row], run: list[Row], hints: Mapping[str, str], choice: Choice
) -> Table | None:
    """A run of numbers with the head that stands in the lines above it, None: there is no head."""
    width = max(i for row in run for i, cell in enumerate(row.cells) if cell) + 1
    above = [row for row in gap if row.remark or any(row.cells)]
    units: list[str] | None = None
    units_line, flaw = 0, ""
    while above:
        row = above.pop()
        if _label(row):
            continue
        texts = [row.text] if row.sheet and width == 1 else _cells(grid, row, width)
        if texts is None:
            if row.remark:
                continue
            texts = row.cells
        if units is None and _is_units(texts, choice):
            units, units_line = texts, row.line
            continue
        heads = [read_head(text) for text in texts]
        said = any(_matches(head, text) for head in heads for text, _ in choice.columns.values())
        if not said and not any(head.name for head in heads):
            if row.remark and units is None:
                continue
            # a line of text: it may be a head whose names are not known
            if sum(map(bool, texts)) < min(width, 2 if units else width):
                return None
        if above and not above[-1].remark and any(head.name for head in heads):
            # a column whose name stands in the line above, next to those of groups
            over = [read_head(cell) for cell in above[-1].cells[: len(heads)]]
            heads[: len(over)] = [
                other if other.name and not head.text.strip() else head
                for head, other in zip(heads, over, strict=False)
            ]
        if units:
            flaw = _shifted(grid, units_line, units, heads)
            heads = [
                _with_unit(head, units[i] if i < len(units) else "") for i, head in enumerate(heads)
            ]
        heads = [_with_unit(head, hints.get(plain(head.text), "")) for head in heads]
        tags, other = _tags(grid, above[-1] if above else None, len(heads))
        if above and above[-1].cells and _label(above[-1]):
            # the title of all columns, unless there are named ones before it
            first = next(i for i, cell in enumerate(above[-1].cells) if cell)
            if not any(head.name for head in heads[:first]):
                tags, other = [math.nan] * len(heads), ""
        heads = [
            head if math.isfinite(head.temperature) else replace(head, temperature=tag)
            for head, tag in zip(heads, tags, strict=True)
        ]
        table = Table(row.line, heads, [])
        doubt = next((head.doubt for head in heads if head.name and head.doubt), "")
        doubt = doubt and f"{grid.path}:{row.line}: {doubt}"
        table.flaw = _too_wide(grid, run, table) or flaw or other or doubt
        return table
    return None


def _shifted(grid: Grid, line: int, units: Sequence[str], heads: Sequence[Head]) -> str:
    """Error of a line of units that has fewer cells than the names, or more."""
    need, n = len(heads), len(units)
    if grid.separator == "xlsx":
        return ""
    while need and heads[need - 1].si in ("", "1"):
        need -= 1
    if need <= n and not any(cell.strip() for cell in units[len(heads) :]):
        return ""
    return (
        f"{grid.path}:{line}: found {n} units below {len(heads)} names, expected an empty cell "
        "or [-] where there is no unit"
    )


def _nameless(grid: Grid, run: list[Row], choice: Choice) -> Table:
    """A table without a head, by the names that the user gives."""
    width = max(len(row.cells) for row in run)
    if len(choice.order) != width:
        raise UsageError(
            f"{option('columns')}: found {len(choice.order)} names, but {grid.path} has "
            f"{width} columns"
        )
    heads = []
    for i, text in enumerate(choice.order):
        name, base = _named(text) if text.strip() else ("", 0.0)
        head = read_head(name) if name else Head("")
        heads.append(replace(head, text=f"column {i + 1}", base=base))
    return Table(0, heads, [(UNLABELLED, run)])


def _cells(grid: Grid, row: Row, width: int) -> list[str] | None:
    """Cells of a line above a table with some number of columns, None: it has others."""
    if not row.remark and grid.separator != " ":
        cells = list(row.cells)
        while len(cells) > width and not cells[-1]:
            cells.pop()
        return cells
    ways = [split_line(row.text, mark) for mark in "\t;,"]
    ways.append([cell.strip() for cell in re.split(r"\s{2,}|\t", row.text)])
    # names with their units in brackets, names of one word with or without a unit
    ways.append(
        [
            cell.strip()
            for cell in re.findall(
                r"[^\[\](]+(?:\[[^\]]*\]|\((?!t\)|w\)|f\)|ω\))[^)]*\))", row.text
            )
        ]
    )
    ways.append(re.findall(r"[^\s\[]+(?:\s*\[[^\]]*\]|\s\([^)]*\))?", row.text))
    if not row.remark:
        ways = [*ways[-3:], row.cells]
    ways += [way[1:] for way in ways if way and not way[0]]
    return next((way for way in ways if len(way) == width), None)


def _is_units(texts: list[str], choice: Choice) -> bool:
    """Whether cells are a line of units."""
    if any(plain(text) == plain(cell) for text, _ in choice.columns.values() for cell in texts):
        return False
    told = [cell for cell in texts if cell.strip()]
    units = [cell for cell in told if plain_units(cell)]
    real = [cell for cell in units if plain_unit(cell) not in ("", "-")]
    names = [cell for cell in told if read_head(cell).name in QUANTITIES and not plain_units(cell)]
    return bool(real) and len(names) < len(real) and 2 * len(units) >= len(told)


def _with_unit(head: Head, cell: str) -> Head:
    """A head with the unit of the line below it."""
    if plain_unit(cell) in ("", "-") or (head.unit and not head.implied):
        return head
    return replace(head, unit=plain_unit(cell), implied=False)


def _hints(grid: Grid) -> dict[str, str]:
    """Units that remarks `NAME [UNIT] meaning` state, as vcor writes them."""
    found = {}
    for remark in grid.remarks:
        if told := re.match(r"(\w+) \[([^\]]+)\](?: |$)", remark):
            found[plain(told[1])] = told[2]
    return found


def _has_tags(grid: Grid, row: Row) -> bool:
    """Whether a line has temperatures of columns."""
    return any(map(math.isfinite, _tags(grid, row, len(row.cells))[0]))


def _titled(gap: list[Row]) -> Label:
    """Temperature in the lines above a table: the nearest one, with a unit if one has it."""
    found = [label for row in reversed(gap) if (label := _label(row, among_others=True))]
    found.sort(key=lambda one: (not one.alone, not one.has_unit))
    return found[0] if found else UNLABELLED


def _tags(grid: Grid, row: Row | None, width: int) -> tuple[list[float], str]:
    """Temperatures [K] of columns by the line above their names, and what is wrong with them.

    Each goes up to the next one; nan: there is none.
    """
    found = [math.nan] * width
    if row is None or row.remark:
        return found, ""
    first, flaw = read_head(row.cells[0]) if row.cells else Head(""), ""
    across = first.name == "temperature" and size(first.unit, "K")
    for i, cell in enumerate(row.cells[:width]):
        if told := read_label(cell):
            found[i] = told.kelvin
            flaw = flaw or (told.flaw and f"{grid.path}:{row.line}: {told.flaw}")
        elif across and is_number(cell):
            factor, offset = across
            found[i] = number(cell) * factor + offset
        elif i and not cell:
            found[i] = found[i - 1]
        elif i and across:
            flaw = flaw or f"{grid.path}:{row.line}: found '{cell[:40]}', expected a temperature"
    return found, flaw


def _fits(row: Row, table: Table) -> bool:
    """Whether a row has numbers in all columns with names that are known."""
    at = [i for i, head in enumerate(table.heads) if head.name]
    return all(i < len(row.cells) and is_number(row.cells[i]) for i in at)


def groups_of(table: Table, path: str, wanted: set[str]) -> list[Group]:
    """Columns that are wanted, once each, for each temperature in the heads or each measurement."""
    by_key: dict[str, list[Column]] = {}
    for i, head in enumerate(table.heads):
        if head.name and head.key in wanted and not table.is_empty(i):
            by_key.setdefault(head.key, []).append(Column(i, head))
    tags: list[float] = []
    for columns in by_key.values():
        for column in columns:
            at = column.head.temperature
            if math.isfinite(at) and at not in tags:
                tags.append(at)
    if not tags and (runs := _side_by_side(table, by_key)):
        return [(math.nan, one) for one in runs]
    if not tags:
        return [(math.nan, {key: _one(table, path, key, some) for key, some in by_key.items()})]
    groups: list[Group] = []
    for tag in tags:
        found = {}
        for key, some in by_key.items():
            own = [one for one in some if one.head.temperature == tag]
            common = [one for one in some if math.isnan(one.head.temperature)]
            if own and common:
                raise InputError(
                    f"{path}:{table.line}: found the column '{common[0].head.text}' (column "
                    f"{common[0].index + 1}) without a temperature next to '{own[0].head.text}' "
                    f"(column {own[0].index + 1}) with one, expected it for both"
                )
            if own or common:
                found[key] = _one(table, path, key, own or common)
        groups.append((tag, found))
    return groups


def _side_by_side(table: Table, by_key: Mapping[str, list[Column]]) -> list[dict[str, Column]]:
    """Columns of each of several measurements side by side; empty if there is one.

    Names have the numbers of the measurements, or moduli that agree have the same names once more.
    Columns that all have stand once, a mean of the others is left out.
    """
    shared: dict[str, Column] = {}
    own: dict[str, dict[int, Column]] = {}
    for key, some in by_key.items():
        columns = [one for one in some if not is_average(one.head.text)] or some
        numbered = len({one.head.run for one in columns} - {0}) == len(columns) > 1
        same = not numbered and all(_same(table, columns[0], one) for one in columns[1:])
        if len(columns) == 1 or same:
            shared[key] = columns[0] if len(columns) == 1 else _one(table, "", key, columns)
            continue
        alike = len({plain(one.head.text) for one in columns}) == 1
        numbers = [i if alike else one.head.run for i, one in enumerate(columns, 1)]
        if len({*numbers}) < len(numbers) or (alike and not _agree(table, key, columns)):
            return []
        own[key] = dict(zip(numbers, columns, strict=True))
    if not own or len({tuple(sorted(one)) for one in own.values()}) > 1:
        return []
    runs = sorted(next(iter(own.values())))
    return [{key: own[key][run] if key in own else shared[key] for key in by_key} for run in runs]


def _agree(table: Table, key: str, columns: Sequence[Column]) -> bool:
    """Whether columns of one name are those of one curve, measured several times."""
    if key.removesuffix("_sigma") not in CURVES:
        return False
    cells = [[one.cell(row) for one in columns] for row in table.rows()]
    values = np.array([[number(c) if is_number(c) else math.nan for c in row] for row in cells])
    with np.errstate(all="ignore"):
        apart = np.nanmax(np.abs(np.log(values / values[:, :1])), axis=1)
    return bool(np.nanmedian(apart) < REPLICATES)


def _one(table: Table, path: str, key: str, columns: list[Column]) -> Column:
    """One of several columns of a quantity, which hold the same within their digits."""
    best = max(columns, key=lambda one: (one.head.angular, bool(one.head.unit)))
    for other in columns:
        if other is best:
            continue
        if not _same(table, best, other):
            first, second = sorted((best, other), key=lambda one: one.index)
            name = key.removesuffix("_sigma")
            raise InputError(
                f"{path}:{table.line}: found two columns of {name.replace('_', ' ')} with "
                f"different numbers, '{first.head.text}' (column {first.index + 1}) and "
                f"'{second.head.text}' "
                f"(column {second.index + 1}), expected one; say which, such as "
                + option("columns", {key: _stated(table, second)})
            )
    return best


def _stated(table: Table, column: Column) -> str:
    """How a user names a column."""
    alike = [head for head in table.heads if plain(head.text) == plain(column.head.text)]
    return column.head.text if len(alike) == 1 else str(column.index + 1)


def _same(table: Table, one: Column, other: Column) -> bool:
    """Whether two columns hold the same numbers within their digits."""
    first, second = (
        size(c.head.unit, c.head.si) if c.head.unit else (1.0, 0.0) for c in (one, other)
    )
    if first is None or second is None or one.head.base != other.head.base:
        return False
    scales = first, second
    for row in table.rows():
        cells = one.cell(row), other.cell(row)
        if is_missing(cells[0]) and is_missing(cells[1]):
            continue
        if not all(is_number(cell) and math.isfinite(number(cell)) for cell in cells):
            return False
        values = [number(c) * s[0] + s[1] for c, s in zip(cells, scales, strict=True)]
        # each is rounded for itself
        slack = sum(resolution(c) * s[0] for c, s in zip(cells, scales, strict=True))
        # at the sum itself only ties are rounded apart, such as 2.5 to 2 and 3
        if abs(values[0] - values[1]) > max((1 - 1e-9) * slack, 1e-12 * abs(values[0])):
            return False
    return True


def quantities() -> tuple[set[str], set[str]]:
    """Names of quantities of a history, and of an impact."""
    return set(_library.columns(1)) - {"time"}, set(_library.columns(0))
