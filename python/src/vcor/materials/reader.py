"""Tables of a file converted to SI units: what kind they are, and what they must have."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .._library import Floats, InputError, UsageError, printable
from .._text import near, option
from ..units import ZERO_C, examples, plain_unit, quantities_of, size
from . import hints
from .grid import (
    Grid,
    Row,
    digits_of,
    has_thousands,
    is_missing,
    is_number,
    number,
)
from .labels import COLDEST, Label
from .names import ASIDE, COMPUTED, QUANTITIES, REMARKS, Head, is_address, plain
from .select import words_of
from .tables import Choice, Column, Table, groups_of, quantities, tables_of

if TYPE_CHECKING:
    import pandas as pd

#: Range of measured moduli, times and frequencies
_LEAST, _MOST = 1e-30, 1e30
#: Logarithm of the difference between E''/E' and tan delta by which they contradict each other
_CONTRADICTION = 0.1
#: Part by which the strain of a relaxation test changes at most, so that its moduli err no more
STEADY = 0.05
#: Difference of temperatures that begins another curve [K]
SAME_TEMPERATURE = 1.0
#: Sets that a report names one by one
MOST_SETS = 20
#: Names of compliances
_COMPLIANCE = re.compile(
    r"(?i:complian|nachgiebig|complaisance|コンプライアンス|柔量)"
    r"|^\s*J(\(t\)|_?t|['\"′″*]{0,2})?\s*([\[(/].*)?$"
)
ALIKE = {
    "dynamic": "moduli against frequency",
    "relaxation": "moduli against time",
    "shift": "shift factors",
    "record": "forces or accelerations against time",
    "impacts": "impacts",
}
#: Columns that a table of some kind may have besides those that it needs
_BESIDE = {
    "dynamic": {"temperature", "set", "loss_tangent", "complex_modulus", "phase_angle"},
    "relaxation": {"temperature", "set"},
    "shift": {"temperature"},
    "record": {"velocity", "temperature", "radius", "diameter", "mass", "set"},
}
_MODULI = ("storage_modulus", "loss_modulus", "complex_modulus")
_DYNAMIC = set(_MODULI)
_IMPACTS = {
    "velocity",
    "rebound_velocity",
    "drop_height",
    "rebound_height",
    "bounce_time",
    "event_time",
}
_SETTINGS = {"velocity", "drop_height", "temperature", "radius", "diameter", "mass", "set"}


class Reader:
    """Tables of a file converted to SI units."""

    def __init__(
        self, grid: Grid, choice: Choice, unit_of: Callable[[str], str] | None, whole: bool
    ) -> None:
        """Read a grid of cells as `choice` says.

        `unit_of` gives the SI unit of an address that is the head of a column; `whole`: columns
        that belong together, as both moduli, must be complete. UsageError: rows that `choice` takes
        and the file does not have.
        """
        self.whole = whole
        grid = choice.select(grid)
        self.path, self.grid, self.choice, self.unit_of = grid.path, grid, choice, unit_of
        self.names: dict[str, str] = {}
        self.units: dict[str, str] = {}
        #: By column: the unit of its last digit in SI units, and its most significant digits
        self.digits: dict[str, tuple[float, int]] = {}
        self.left: list[str] = []
        #: How a user takes the rows with one word of a column of words, empty: there is none
        self.word = ""
        #: How many rows the user wants
        self.selected = ""
        #: Points that were left out, and why
        self.failed: list[str] = []
        #: Whether a frequency is in Hz, kHz and the like
        self.hertz = False
        self.comma = False
        self._shear: list[tuple[bool, str]] = []
        #: Temperatures that are stated, but not sure
        self._doubts: list[Label] = []

    def parts(self) -> tuple[list[pd.DataFrame], str]:
        """Frames of the tables of one kind, and the kind."""
        tables = tables_of(self.grid, self.choice)
        self.choice.look(tables)
        if not self.choice.shared:
            self.choice.refuse_unread(f"{self.path} has")
        if not tables:
            raise self._no_table()
        tables = self._selected(tables)
        for table in tables:
            table.heads = self.choice.heads(table)
        kinds = [self._kind(table) for table in tables]
        whole = [
            bool(kind) and not self._lacks(_known(table), kind)
            for table, kind in zip(tables, kinds, strict=True)
        ]
        if not any(whole):
            most = max(range(len(tables)), key=lambda i: (bool(kinds[i]), len(_known(tables[i]))))
            raise self._incomplete(tables[most], kinds[most])
        found = {kind for kind, one in zip(kinds, whole, strict=True) if one}
        if len(found) > 1:
            raise InputError(
                f"{self.path}: found {' and '.join(ALIKE[kind] for kind in sorted(found))}"
                f", expected a file with one of them{self._one_sheet()}"
            )
        (kind,) = found
        frames: list[pd.DataFrame] = []
        for table, one in zip(tables, whole, strict=True):
            if one:
                frames += self._frames(table, kind, len(frames))
            else:
                self._all_cells(table)
                self.left += [f"table at line {table.line}"] * bool(_known(table))
        if (
            kind in ("record", "impacts")
            and len({one.attrs["table"] for one in frames}) > 1
            and (kind == "record" or any({"bounce_time"} & set(one) for one in frames))
        ):
            raise InputError(
                f"{self.path}: found {len(frames)} tables of {ALIKE[kind]}, expected "
                f"one{self._one_sheet()}"
            )
        self._same_labels(frames)
        frames = self._at_temperatures(frames)
        if not self.choice.shared:
            self.choice.refuse_unseen(f"{self.path} has")
        return frames, kind

    def _one_sheet(self) -> str:
        """How a user takes one sheet of several, for a message."""
        sheets = [row.text for row in self.grid.rows if row.sheet]
        return f", or {option('where', {'sheet': sheets[0]})}" if len(sheets) > 1 else ""

    def _selected(self, tables: Sequence[Table]) -> list[Table]:
        """Tables with the rows that the user wants, by their columns."""
        before = sum(len(table.rows()) for table in tables)
        found = [table for table in tables if self.choice.filter(table)]
        rows = sum(len(table.rows()) for table in found)
        if rows < before:
            self.selected = f"{rows} of {before} rows"
        if not found:
            wanted = self.choice.where
            raise next((one for one in wanted if not one.met), wanted[-1]).refusal(self.path)
        return found

    def _at_temperatures(self, frames: Sequence[pd.DataFrame]) -> list[pd.DataFrame]:
        """Rows at the temperatures that the user wants."""
        found = []
        for frame in frames:
            taken = np.ones(len(frame), dtype=bool)
            for one in self.choice.where:
                if plain(one.name) == "temperature" and "temperature" in frame:
                    taken &= one.temperatures(frame["temperature"].to_numpy(dtype=float))
            if taken.all():
                found.append(frame)
            elif taken.any():
                found.append(frame[taken].copy())
        if not found:
            one = next(one for one in self.choice.where if plain(one.name) == "temperature")
            raise one.refusal(f"{self.path} has")
        return found

    def _same_labels(self, frames: Sequence[pd.DataFrame]) -> None:
        """Refuse temperatures that are not sure, and sets with and without a temperature."""
        several = len({label.line for label in self._doubts}) > 1
        for label in self._doubts:
            # `T = 5` above a single set may be a thickness, and any temperature one of storage
            if several or (label.has_unit and label.alone):
                raise InputError(f"{self.path}:{label.line}: {label.flaw}")
        have = ["temperature" in one for one in frames]
        if any(have) and not all(have):
            first, other = (frames[have.index(x)].index[0] for x in (True, False))
            raise InputError(
                f"{self.path}:{other}: found points without a temperature, while those at line "
                f"{first} have one, expected it for all, such as a line T = 20 °C above them"
            )

    def _all_cells(self, table: Table) -> None:
        """Refuse rows that end before the last name, as cells may be missing anywhere in them."""
        if self.grid.separator == "xlsx":
            # cells of a spreadsheet have places of their own
            return
        rows = table.rows()
        need = len(table.heads)
        while need and _may_end_before(table.heads[need - 1], need - 1, rows):
            need -= 1
        for row in rows:
            if len(row.cells) < need:
                n, last = len(row.cells), table.heads[need - 1].text.strip()
                raise InputError(
                    f"{self.path}:{row.line}: found {n} cell{'s' * (n > 1)} below {need} names up "
                    f"to '{last}', expected an empty cell where a number is missing"
                )

    def _kind(self, table: Table) -> str:
        """Kind of a table by the names that it has."""
        names = _known(table)
        times = {"time", "run_time"} & names
        if names & _DYNAMIC and "relaxation_modulus" in names:
            if "frequency" in names and times:
                raise InputError(
                    f"{self.path}:{table.line}: found moduli against frequency and against "
                    f"time in one table, expected one of them, or {option('columns')}"
                )
            return "relaxation" if times else "dynamic"
        if names & _DYNAMIC:
            return "dynamic"
        # amplitudes of an oscillation are no step
        oscillates = names & {"frequency", "loss_tangent", "phase_angle"}
        step = times and {"stress", "strain"} <= names and not oscillates
        if "relaxation_modulus" in names or step:
            return "relaxation"
        if "shift_factor" in names:
            return "shift"
        history, impact = quantities()
        impact -= COMPUTED
        if "loss_tangent" in names and ("frequency" in names or not names & (impact | _IMPACTS)):
            return "dynamic"
        if times and names & (history | {"force", "acceleration"}):
            return "record"
        if names & (impact | _IMPACTS) or any(is_address(name) for name in names):
            return "impacts"
        return ""

    def _lacks(self, names: set[str], kind: str) -> list[str]:
        """Quantities that a table of some kind needs, and does not have among its names."""
        if not self.whole:
            return []
        if kind == "dynamic":
            missing = [] if "frequency" in names else ["frequency"]
            pair = names & {"storage_modulus", "loss_modulus", "complex_modulus"}
            if "storage_modulus" not in names and not (
                names & {"loss_modulus", "complex_modulus"}
                and (len(pair) > 1 or names & {"loss_tangent", "phase_angle"})
            ):
                missing.append("storage_modulus")
            if (
                "loss_modulus" not in names
                and not names & {"loss_tangent", "phase_angle"}
                and (len(pair) < 2)
            ):
                missing.append("loss_modulus")
            return missing
        across = {"relaxation": "time", "record": "time", "shift": "temperature"}.get(kind, "")
        if across == "time" and "run_time" in names:
            across = ""
        return [across] if across and across not in names else []

    def _wanted(self, table: Table, kind: str) -> set[str]:
        """Keys of columns that are taken from a table."""
        names = _known(table)
        if kind == "dynamic":
            found = {"frequency", "storage_modulus", "loss_modulus"} | _BESIDE[kind]
        elif kind == "relaxation":
            found = {"time", "relaxation_modulus"} | _BESIDE[kind]
            if "relaxation_modulus" not in names:
                found |= {"stress", "strain"}
        elif kind == "shift":
            found = {"shift_factor"} | _BESIDE[kind]
        elif kind == "record":
            found = {"time", "force", "acceleration"} | quantities()[0] | _BESIDE[kind]
        else:
            found = names - {"time", "run_time", "frequency"} - (COMPUTED - {*self.choice.columns})
            # errors of settings have no part in a fit
            return found | {f"{name}_sigma" for name in found - _SETTINGS}
        if "time" in found and "time" not in names:
            found = found - {"time"} | {"run_time"}
        return {key for name in found for key in (name, f"{name}_sigma")}

    def _frames(self, table: Table, kind: str, first: int) -> list[pd.DataFrame]:
        """Frames of a table: one for each temperature in its heads, and below each title."""
        if table.flaw:
            raise InputError(table.flaw)
        self._all_cells(table)
        wanted = self._wanted(table, kind)
        if kind == "impacts":
            self._all_known(table)
        groups = groups_of(table, self.path, wanted)
        taken = {column.index for _, group in groups for column in group.values()}
        self._leave(table, taken)
        units = {}
        for _, group in groups:
            units.update(self._units(table, group))
        frames: list[pd.DataFrame] = []
        for tag, group in groups:
            for part, (title, rows) in enumerate(table.parts):
                frame = self._frame(
                    Table(table.line, table.heads, [(title, rows)]), group, units, kind
                )
                if frame is None:
                    continue
                at = title.kelvin if math.isnan(tag) else tag
                if part and abs(title.kelvin - at) > SAME_TEMPERATURE:
                    raise InputError(
                        f"{self.path}:{title.line}: found {_celsius(title.kelvin)} above numbers "
                        f"whose names say {_celsius(at)}, expected names of their own above them"
                    )
                if "temperature" not in frame and math.isfinite(at):
                    frame["temperature"] = at
                    self.units["temperature"] = "K"
                elif "temperature" not in frame and title.flaw:
                    self._doubts.append(title)
                own = frame["set"].to_numpy() if "set" in frame else np.zeros(len(frame))
                changes = np.concatenate([[0], np.cumsum(np.diff(own) != 0)])
                frame["set"] = first + len(frames) + changes
                first += int(changes[-1])
                frame.attrs["table"] = (table.line, part, tag)
                frames.append(frame)
        return frames

    def _leave(self, table: Table, taken: set[int]) -> None:
        """Note the columns that are not taken, and the words by which they select rows."""
        for i, head in enumerate(table.heads):
            text = head.text.strip()
            if i in taken or not text or any(one.partition(" (")[0] == text for one in self.left):
                continue
            words = words_of([row.cells[i] for row in table.rows() if i < len(row.cells)])
            if words:
                how = option("where", {text: words[0]})
                text += f" ({', '.join(words)}: {how} takes one)"
                self.word = how
            self.left.append(text)

    def _frame(
        self, table: Table, group: dict[str, Column], units: dict[int, str], kind: str
    ) -> pd.DataFrame | None:
        """Rows of a table in SI units."""
        import pandas as pd

        rows = table.rows()
        # rows without a number in any column that is taken belong to the columns of another curve
        rows = [row for row in rows if not all(is_missing(one.cell(row)) for one in group.values())]
        if not rows:
            return None
        if self.whole and kind in ("dynamic", "relaxation", "shift"):
            rows = self._measured(rows, group)
        values: dict[str, Floats] = {}
        for key, column in group.items():
            name = "time" if key == "run_time" else key
            cells = [column.cell(row) for row in rows]
            if key == "set" and not all(map(is_number, cells)):
                # words, by the order in which they come
                codes = {word: i for i, word in enumerate(dict.fromkeys(cells))}
                values[name] = np.array([codes[cell] for cell in cells], dtype=float)
                self.names.setdefault(name, column.head.text.strip())
                continue
            values[name] = self._numbers(rows, column, units.get(column.index, ""), name, kind)
            self.names.setdefault(name, column.head.text.strip())
            self.units[name] = column.head.si
            unit = plain_unit(units.get(column.index, ""))
            self.hertz |= name == "frequency" and unit.endswith("Hz")
            if column.head.shear is not None:
                self._shear.append((column.head.shear, column.head.text))
        lines = [row.line for row in rows]
        frame = pd.DataFrame(values, index=pd.Index(lines, name="line"))
        if kind == "dynamic" and self.whole:
            frame = self._dynamic(frame, table)
        elif kind == "relaxation" and {"stress", "strain"} <= {*frame}:
            frame = self._of_step(frame)
        elif kind == "impacts":
            frame = self._impacts(frame)
        if "diameter" in frame:
            frame = self._radius(frame, table)
        if self.whole and kind in ("dynamic", "relaxation", "shift"):
            self._positive(frame, kind)
        return frame

    def _measured(self, rows: list[Row], group: dict[str, Column]) -> list[Row]:
        """Rows without those of failed points, as long as these are the fewer ones."""
        columns = [one for key, one in group.items() if key not in ("temperature", "set")]
        failed = [
            (row, next(one for one in columns if is_missing(one.cell(row))))
            for row in rows
            if any(is_missing(one.cell(row)) for one in columns)
        ]
        if 2 * len(failed) >= len(rows):
            return rows
        self.failed += [
            f"line {row.line} ('{cell}' in '{one.head.text.strip()}')"
            if (cell := one.cell(row))
            else f"line {row.line} (nothing in '{one.head.text.strip()}')"
            for row, one in failed
        ]
        lost = {row.line for row, _ in failed}
        return [row for row in rows if row.line not in lost]

    def _numbers(
        self, rows: Sequence[Row], column: Column, unit: str, name: str, kind: str
    ) -> Floats:
        """Numbers of a column in SI units, nan where there is none."""
        factor, offset = (size(unit, column.head.si) if unit else None) or (1.0, 0.0)
        if column.head.sigma:
            offset = 0.0
        found = np.empty(len(rows))
        commas = points = ambiguous = 0
        for i, row in enumerate(rows):
            cell, place = column.cell(row), f"{self.path}:{row.line}"
            if has_thousands(cell):
                raise InputError(
                    f"{place}: found '{cell}' with thousands apart in column "
                    f"'{column.head.text}', expected numbers without marks between digits"
                )
            if is_number(cell):
                found[i] = number(cell)
                if "," in cell:
                    commas += 1
                    ambiguous += len(cell.rpartition(",")[2]) == 3 and cell.lstrip("+-")[:1] != "0"
                points += "." in cell
                if commas and points:
                    raise InputError(
                        f"{place}: found decimal commas and decimal points in column "
                        f"'{column.head.text}', expected one of them"
                    )
                if not math.isfinite(found[i]):
                    raise InputError(
                        f"{place}: found '{cell}' in column '{column.head.text}', "
                        "expected a number that can be represented"
                    )
            elif is_missing(cell) and (kind in ("impacts", "record") or name in ("temperature",)):
                found[i] = math.nan
            else:
                what = ": no number" if not cell else f"'{cell[:40]}'"
                raise InputError(
                    f"{place}: found {what.removeprefix(': ')} in column "
                    f"'{column.head.text}', expected a number"
                )
        if ambiguous == commas > 0 and self.grid.separator == ",":
            raise InputError(
                f"{self.path}: found numbers such as {_first_comma(rows, column)} in column "
                f"'{column.head.text}', whose comma may be one of thousands, expected "
                "decimal points, or semicolons between the columns"
            )
        self.comma |= commas > 0
        told = [digits_of(cell) for row in rows if is_number(cell := column.cell(row))]
        told = [one for one in told if one[1]]
        # a spreadsheet has numbers, not their digits
        if told and not column.head.base and self.grid.separator != "xlsx":
            units, counts = zip(*told, strict=True)
            before = self.digits.get(name, (math.inf, 0))
            self.digits[name] = min(factor * min(units), before[0]), max(*counts, before[1])
        if column.head.base:
            if column.head.sigma:
                raise InputError(
                    f"{self.path}: found a standard error of a logarithm, "
                    f"'{column.head.text}', expected one of the quantity"
                )
            with np.errstate(over="ignore"):
                found = column.head.base**found
        return found * factor + offset

    def _units(self, table: Table, group: dict[str, Column]) -> dict[int, str]:
        """Units of columns by their indices: of the file or the user, SI if none has one."""
        place = f"{self.path}:{table.line}" if table.line else self.path
        found: dict[int, str] = {}
        stated = False
        for key, column in group.items():
            head = column.head
            given = self._given(key, column, group)
            unit = head.unit or given
            if given and head.unit and size(given, head.si) != size(head.unit, head.si):
                if not head.implied:
                    raise UsageError(
                        f"{option('units')}: found {given}, but {place} says '{head.unit}' for "
                        f"'{head.text}'"
                    )
                unit = given
            if unit and not quantities_of(unit) and head.si == "":
                unit = ""
            if unit and head.si and size(unit, head.si) is None:
                raise InputError(
                    f"{place}: found '{plain_unit(unit)}' as unit of '{head.text}', expected "
                    f"{examples(head.si)}{_meant(unit, head.si)}"
                )
            if head.si == "rad/s" and table.line:
                self._frequency(head, unit, place, bool(given))
            found[column.index] = unit
            stated |= (
                bool(unit)
                and not (head.implied and unit == head.unit)
                and head.si not in ("1", "", "K")
            )
        for key, column in group.items():
            head = column.head
            base = group.get(key.removesuffix("_sigma"))
            if head.sigma and not found[column.index] and base:
                found[column.index] = found[base.index]
            if (
                head.sigma
                and base
                and head.si == "1"
                and size(found[column.index] or "1", "1") != size(found[base.index] or "1", "1")
            ):
                raise InputError(
                    f"{place}: found '{head.unit}' as unit of '{head.text}', which may be a part "
                    f"of '{base.head.text}' or of 1, expected the unit of '{base.head.text}'"
                )
            missing = not found[column.index]
            if head.si == "K" and missing and not head.sigma:
                self._kelvin(table, column, place)
            elif head.si == "rad/s" and missing and table.line:
                raise InputError(
                    f"{place}: found no unit of '{head.text}', expected one of "
                    f"{examples(head.si)} in its head, or {option('units')}"
                )
            elif missing and stated and head.si not in ("1", "", "K"):
                raise InputError(
                    f"{place}: found no unit of '{head.text}', while other columns have one, "
                    f"expected one of {examples(head.si)} in its head, or {option('units')}"
                )
        return found

    def _given(self, key: str, column: Column, group: dict[str, Column]) -> str:
        """Unit that the user gives to a column, empty if none."""
        head = column.head
        for unit in self.choice.free:
            if not quantities_of(unit):
                raise UsageError(
                    f"{option('units')}: found '{unit}', expected a unit such as Hz, rad/s, s, MPa "
                    "or C"
                )
        if key in self.choice.units:
            unit = self.choice.units[key]
            if head.si and size(unit, head.si) is None:
                raise UsageError(f"{option('units')}: found '{unit}' for {key}, expected "
                                 f"{examples(head.si)}")  # fmt: skip
            return unit
        fits = [unit for unit in self.choice.free if head.si and size(unit, head.si)]
        own = size(head.unit, head.si) if head.unit else None
        return next((unit for unit in fits if size(unit, head.si) == own), fits[0] if fits else "")

    def _frequency(self, head: Head, unit: str, place: str, given: bool) -> None:
        """Refuse a unit that contradicts the kind of a frequency."""
        text, usual = head.text, plain_unit(unit)
        if head.angular and usual.endswith("Hz"):
            raise InputError(
                f"{place}: found Hz as unit of the angular frequency '{text}', expected "
                f"rad/s, or {option('columns', {'frequency': text})} if it is one in Hz"
            )
        if not head.angular and usual == "1/s" and not given:
            raise InputError(
                f"{place}: found 1/s as unit of '{text}', which may be Hz or rad/s, expected "
                "one of them"
            )

    def _kelvin(self, table: Table, column: Column, place: str) -> None:
        """Refuse temperatures without a unit that cannot be in kelvin."""
        values = [number(column.cell(row)) for row in table.rows()]
        warmest = np.nanmax(values)
        if warmest < COLDEST:
            raise InputError(
                f"{place}: column '{column.head.text}': found at most {warmest:g} K, expected "
                f"{column.head.text} [C] for degrees Celsius, or [K]"
            )

    def _all_known(self, table: Table) -> None:
        """Refuse numbers of a table of impacts whose names are not known."""
        history, impact = quantities()
        known = [*impact - COMPUTED, *_IMPACTS, *_SETTINGS]
        for i, head in enumerate(table.heads):
            if plain(head.text) in ASIDE or plain(head.text).rstrip(" .") in ASIDE:
                continue
            cells = [row.cells[i] if i < len(row.cells) else "" for row in table.rows()]
            if not any(map(is_number, cells)) or not head.text.strip():
                continue
            if head.name in ("time", "run_time") and (
                size(head.unit, "s") is None if head.unit else head.symbol
            ):
                # a time may be left out, a thickness t must not
                raise self._unknown(table, head, known)
            if head.name and is_address(head.name) and head.name not in QUANTITIES:
                if self.unit_of is not None:
                    unit = self.unit_of(head.name)
                    table.heads[i] = dataclasses.replace(head, si=unit)
                elif head.unit and quantities_of(head.unit):
                    table.heads[i] = dataclasses.replace(head, si=quantities_of(head.unit)[0])
                continue
            if head.flaw or head.name not in {*impact, *_IMPACTS, *_SETTINGS, "time", "run_time"}:
                raise self._unknown(table, head, known)

    def _unknown(self, table: Table, head: Head, known: Sequence[str]) -> InputError:
        """A column of a table of impacts whose name is not known, and what it may be."""
        text, may = head.text.strip(), hints.of_impacts(head, _known(table) - {head.name})
        line = (
            f"{self.path}:{table.line}: found the column '{text}', expected one of velocity, "
            "rebound_velocity, drop_height, rebound_height, bounce_time, cor, cor_sphere, "
            "resilience, contact_time, max_force, temperature, radius, diameter, mass, another "
            "column of the summary or an address, or NAME_sigma for a standard error"
        )
        if head.name == "time":
            line += f"; a time that is left out has its unit, {text} [s]" * (not head.unit)
        elif not may:
            line += near(plain(text.split("[")[0].split("(")[0]).replace(" ", "_"), known)
        if not may:
            return InputError(f"{line}; or {option('columns', {'NAME': text})}")
        return InputError(f"{line}; {_say_which(text, may)}")

    def _dynamic(self, frame: pd.DataFrame, table: Table) -> pd.DataFrame:
        """Storage and loss moduli from what there is; refused if they contradict each other."""
        size_of = frame.get("complex_modulus")
        tangent = frame.get("loss_tangent")
        if tangent is None and "phase_angle" in frame:
            tangent = np.tan(frame["phase_angle"])
        storage, loss = frame.get("storage_modulus"), frame.get("loss_modulus")
        if storage is not None and loss is not None:
            for name, given, made in (
                ("tan delta", tangent, loss / storage),
                ("the complex modulus", size_of, np.hypot(storage, loss)),
            ):
                if given is None:
                    continue
                with np.errstate(all="ignore"):
                    off = float(np.nanmedian(np.abs(np.log(made / given))))
                if off > _CONTRADICTION:
                    raise InputError(
                        f"{self.path}:{table.line}: found {name} that contradicts the storage "
                        f"and loss moduli (by {100 * np.expm1(off):.0f} %), expected columns "
                        "and units that agree"
                    )
        if storage is None:
            if size_of is None:
                storage = loss / tangent
            elif tangent is not None:
                storage = size_of / np.sqrt(1 + tangent**2)
            else:
                storage = np.sqrt(size_of**2 - loss**2)
        if loss is None:
            loss = storage * tangent if tangent is not None else np.sqrt(size_of**2 - storage**2)
        frame["storage_modulus"], frame["loss_modulus"] = storage, loss
        self.units["storage_modulus"] = self.units["loss_modulus"] = "Pa"
        order = ["frequency", "storage_modulus", "loss_modulus"]
        rest = [
            name
            for name in frame
            if name not in order
            and name.removesuffix("_sigma")
            not in ("loss_tangent", "complex_modulus", "phase_angle")
        ]
        return frame[[*order, *rest]].copy()

    def _of_step(self, frame: pd.DataFrame) -> pd.DataFrame:
        """The relaxation modulus from the stress after a step of strain, and the strain."""
        stress, strain = frame["stress"].to_numpy(), frame["strain"].to_numpy()
        texts = f"'{self.names['stress']}' and '{self.names['strain']}'"
        off = np.abs(strain / np.median(strain) - 1) if np.median(strain) else np.ones(1)
        if not off.max() < STEADY:
            place = f"{self.path}:{frame.index[int(np.argmax(~(off < STEADY)))]}"
            if np.ptp(stress) < STEADY * abs(np.median(stress)):
                raise InputError(f"{place}: found {texts} of a creep test, whose compliance J is "
                                 "the strain over the stress" + _of_compliance(False))  # fmt: skip
            raise InputError(
                f"{place}: found a strain that changes by more than {100 * STEADY:.0f} %, expected "
                f"{texts} after a step of strain; {option('where', {'line': 'FROM:TO'})} takes the "
                "lines after it"
            )
        # pushed or pulled
        frame["relaxation_modulus"] = stress / strain
        self.units["relaxation_modulus"] = "Pa"
        self.names["relaxation_modulus"] = f"{self.names['stress']} over {self.names['strain']}"
        return frame.drop(columns=[key for key in frame if str(key)[:6] in ("stress", "strain")])

    def _impacts(self, frame: pd.DataFrame) -> pd.DataFrame:
        """Times of events as times in flight, without the last one that has not ended."""
        if "event_time" in frame:
            if "bounce_time" not in frame:
                frame["bounce_time"] = -frame["event_time"].diff(-1)
                self.units["bounce_time"] = "s"
                self.names["bounce_time"] = f"differences of {self.names['event_time']}"
            frame = frame.drop(columns="event_time")
            self.names.pop("event_time", None)
        if "bounce_time" in frame:
            # a stopwatch writes 0 for the flight that has not ended
            ended = ~(frame["bounce_time"].isna() | (frame["bounce_time"] == 0))
            last = np.flatnonzero(ended)
            frame = frame.iloc[: last[-1] + 1 if last.size else 0].copy()
        return frame

    def _radius(self, frame: pd.DataFrame, table: Table) -> pd.DataFrame:
        """The radius of the sphere in the place of its diameter."""
        if "radius" in frame:
            raise InputError(
                f"{self.path}:{table.line}: found both a radius and a diameter, expected one"
            )
        halves = {key: key.replace("diameter", "radius") for key in frame if "diameter" in str(key)}
        for key, name in halves.items():
            frame[key] /= 2
            if text := self.names.pop(str(key), ""):
                self.names[name] = f"half of {text}"
            self.units[name] = "m"
        return frame.rename(columns=halves)

    def _positive(self, frame: pd.DataFrame, kind: str) -> None:
        """Refuse moduli, times and frequencies that are not positive."""
        names = {
            "dynamic": ["frequency", "storage_modulus", "loss_modulus"],
            "relaxation": ["time", "relaxation_modulus"],
            "shift": ["shift_factor"],
        }[kind]
        names += [f"{name}_sigma" for name in names if f"{name}_sigma" in frame]
        for name in names:
            values = frame[name].to_numpy()
            with np.errstate(invalid="ignore"):
                bad = ~((values > 0) if kind == "shift" else (values >= _LEAST) & (values <= _MOST))
            if bad.any():
                at = int(np.argmax(bad))
                limits = (
                    "> 0"
                    if kind == "shift" or not values[at] > 0
                    else (f"from {_LEAST:g} to {_MOST:g} in SI units")
                )
                raise InputError(
                    f"{self.path}:{frame.index[at]}: found {values[at]:.6g}, expected a "
                    f"{name.replace('_', ' ')} {limits}"
                )

    def _no_table(self) -> InputError:
        """Error of a file without numbers, or with numbers without a head."""
        numbers = [row for row in self.grid.rows if row.numbers()]
        if not numbers:
            last = self.grid.rows[-1].line if self.grid.rows else 1
            return InputError(f"{self.path}:{last}: found no numbers, expected a table of them")
        row = numbers[0]
        return InputError(
            f"{self.path}:{row.line}: found {row.filled()} column{'s' * (row.filled() > 1)} "
            "without names, expected a head above them, such as 't [s],E [Pa]', or "
            f"{option('columns')} with their names, such as time,relaxation_modulus or "
            "frequency,storage_modulus,loss_modulus"
        )

    def _incomplete(self, table: Table, kind: str) -> InputError:
        """Error of a table that lacks a column, with the name of one that it could be."""
        place = f"{self.path}:{table.line}"
        flawed = [head for head in table.heads if head.flaw]
        free = [
            head for head in table.heads if head.text.strip() and not (head.name and not head.flaw)
        ]
        told = ", ".join(f"'{text}'" for text in table.texts()[:12])
        if flawed:
            return InputError(f"{place}: '{flawed[0].text}': {flawed[0].flaw}")
        if table.flaw:
            return InputError(table.flaw)
        names = _known(table)
        if not kind:
            creep = next((h.text.strip() for h in table.heads if _COMPLIANCE.search(h.text)), "")
            if creep:
                return InputError(f"{place}: found the compliance '{creep}', expected moduli"
                                  + _of_compliance("frequency" in names))  # fmt: skip
            if lone := names & {"stress", "strain"}:
                return self._half_of_a_step(place, table, lone)
            could = [(head, may) for head in free if (may := _could_be(head, names))]
            stress = " (a stress over the strain)"
            if not could:
                return InputError(
                    f"{place}: found the columns {told}, none of which is a measured quantity that "
                    f"is known, such as a relaxation modulus{stress}; {option('columns')} says "
                    "which is what"
                )
            last, may = could[-1]
            stress *= may[0].endswith("_modulus")
            return InputError(
                f"{place}: found the columns {told}, none of which is a measured quantity that is "
                f"known; {_say_which(last.text.strip(), may, stress)}"
            )
        if {"frequency", "relaxation_modulus"} <= names:
            # a modulus against frequency
            text = next(h.text.strip() for h in table.heads if h.name == "relaxation_modulus")
            own = names - {"relaxation_modulus"}
            may = [name for name in _MODULI if not self._lacks(own | {name}, "dynamic")]
            return InputError(
                f"{place}: found '{text}' against frequency, expected storage and loss modulus, or "
                "one of them or the complex modulus with the loss tangent; "
                + _say_which(text, may or ["storage_modulus", "complex_modulus"])
            )
        lacks = self._lacks(names, kind)
        words = " and of the ".join(name.replace("_", " ") for name in lacks)
        line = (
            f"{place}: found {told}, but no column of the {words}, expected one named as "
            + " and ".join(QUANTITIES[name].example for name in lacks)
        )
        si = QUANTITIES[lacks[0]].unit
        may = [lacks[0]]
        if lacks[0] in _MODULI:
            may = [one for one in _MODULI if one not in names
                   and (len(lacks) > 1 or not self._lacks(names | {one}, kind))]  # fmt: skip
        fit = [
            (head.text.strip(), found)
            for head in free
            if head.unit and size(head.unit, si) and (found := hints.of_moduli(head, may, names))
        ]
        # one whose name tells that it is what is missing, before others of its unit
        fit = [one for one in fit if one[1] == [lacks[0]]] or fit
        if len(fit) == 1:
            line += f"; {_say_which(*fit[0])}"
        elif fit:
            line += f"; {option('columns')} says which of " + ", ".join(
                f"'{one}'" for one, _ in fit
            )
        if "frequency" in lacks and "temperature" in names:
            line += "; a temperature sweep at one frequency tells no shifts, those at several do"
        return InputError(line)

    def _half_of_a_step(self, place: str, table: Table, names: set[str]) -> InputError:
        """A stress without the strain of its step, or a strain without its stress."""
        name = min(names)
        text = next(head.text.strip() for head in table.heads if head.name in names)
        if len(names) > 1 and "frequency" in _known(table):
            return InputError(f"{place}: found stress and strain of an oscillation, expected "
                              "storage and loss modulus")  # fmt: skip
        if len(names) > 1:
            return InputError(f"{place}: found stress and strain, but no column of the time, "
                              f"expected one named as {QUANTITIES['time'].example}")  # fmt: skip
        if name == "stress":
            return InputError(f"{place}: found the stress '{text}', expected moduli: after a step "
                              "of strain the stress over the strain; a column strain [%] beside it "
                              "makes them")  # fmt: skip
        return InputError(
            f"{place}: found the strain '{text}', expected moduli; of a creep test the strain over "
            f"the stress is the compliance J{_of_compliance(False)}"
        )

    def shear(self) -> bool | None:
        """Whether the moduli are shear moduli, None: the names do not say."""
        kinds = {kind for kind, _ in self._shear}
        if len(kinds) > 1:
            texts = " and ".join(
                f"'{next(t for k, t in self._shear if k is kind)}'" for kind in kinds
            )
            raise InputError(
                f"{self.path}: found shear and tensile moduli, {texts}, expected one kind"
            )
        return kinds.pop() if kinds else None

    def taken(self, frame: pd.DataFrame) -> str:
        """A line that says which columns are what."""
        parts = [
            f"{name} from '{text}'" if name != text else name
            for name, text in self.names.items()
            if name.removesuffix("_sigma") in frame
            or name in ("loss_tangent", "complex_modulus", "phase_angle")
        ]
        n = len(frame)
        line = f"{self.path}: {n} point{'s' * (n > 1)}: {', '.join(parts)}"
        if self.choice.where:
            line += f"; with {' and '.join(map(str, self.choice.where))}"
            line += f" ({self.selected})" if self.selected else ""
        if sets := _sets(frame):
            line += f"; {sets}"
        if self.comma:
            line += "; with decimal commas"
        if self.failed:
            n = len(self.failed)
            more = f" and {n - 4} more" if n > 4 else ""
            line += f"; {n} failed point{'s' * (n > 1)} left out: "
            line += f"{', '.join(self.failed[:4])}{more}"
        if self.left:
            more = f" and {len(self.left) - 8} more" if len(self.left) > 8 else ""
            line += f"; not taken: {', '.join(self.left[:8])}{more}"
        return printable(line)


def refuse_all_but_moduli(kind: str | None, path: str) -> None:
    """Refuse data that are no moduli, and say how those of a relaxation test become some."""
    if kind not in ("dynamic", "relaxation"):
        found = f"found {ALIKE[kind]}, " if kind in ALIKE else ""
        test = "; of a relaxation test F/(A strain) is one, with the area A" * (kind == "record")
        raise InputError(f"{path}: {found}expected moduli against time or frequency{test}")


def _of_compliance(dynamic: bool) -> str:
    """How compliances become moduli, for a message."""
    if dynamic:
        return ": E' = J'/(J'^2 + J''^2) and E'' = J''/(J'^2 + J''^2)"
    return (
        ": E(t) = sin(pi n)/(pi n J(t)) with the slope n = d ln J/d ln t, which is exact for a "
        "power law"
    )


def _sets(frame: pd.DataFrame) -> str:
    """The sets of points in words: how many points each has, and its temperature."""
    own = frame["set"].to_numpy() if "set" in frame else np.zeros(len(frame))
    begins = np.diff(own) != 0
    kelvin = (
        frame["temperature"].to_numpy() if "temperature" in frame else np.full(len(own), np.nan)
    )
    if "shift_factor" in frame:
        # a temperature each
        kelvin = np.full(len(own), np.nan)
    elif {"frequency", "time"} & set(frame):
        begins |= np.abs(np.diff(kelvin)) > SAME_TEMPERATURE
    groups = np.split(np.arange(len(own)), np.flatnonzero(begins) + 1)
    counts = [len(group) for group in groups]
    at = [_range(kelvin[group]) for group in groups]
    if len(groups) == 1:
        return at[0].strip()
    if len(groups) > MOST_SETS:
        return (f"{len(groups)} sets of {min(counts)} to {max(counts)} points"
                f"{_range(kelvin)}")  # fmt: skip
    told = [f"{n}{place}" for n, place in zip(counts, at, strict=True)]
    points = f"{counts[0]} point{'s' * (counts[0] > 1)}{at[0]}"
    return f"{len(groups)} sets: {', '.join([points, *told[1:]])}"


def _range(kelvin: Floats) -> str:
    """Temperatures of points in words, empty if there are none."""
    known = kelvin[np.isfinite(kelvin)]
    if not known.size:
        return ""
    if np.ptp(known) < SAME_TEMPERATURE:
        return f" at {_celsius(known.mean())}"
    return f" at {_celsius(known.min()).removesuffix(' C')} to {_celsius(known.max())}"


def _celsius(kelvin: float) -> str:
    """A temperature in degrees Celsius."""
    return f"{round(float(kelvin) - ZERO_C, 2) + 0.0:g} C"


def _may_end_before(head: Head, index: int, rows: Sequence[Row]) -> bool:
    """Whether rows may end before a column, the last one: it holds no numbers, but remarks."""
    if not head.text.strip() or plain(head.text) in REMARKS:
        return True
    cells = [row.cells[index] for row in rows if index < len(row.cells)]
    return not any(map(is_number, cells)) and not all(map(is_missing, cells))


def _known(table: Table) -> set[str]:
    """Names of quantities that a table has numbers of, without those whose units are others'."""
    return {
        head.name
        for i, head in enumerate(table.heads)
        if head.name
        and not table.is_empty(i)
        and not head.flaw
        and not head.sigma
        and not (head.name == "velocity" and plain_unit(head.unit).startswith("rad/"))
    }


def _could_be(head: Head, names: set[str]) -> list[str]:
    """Quantities that a column may be by its unit, the likeliest one first."""
    told = quantities_of(head.unit) if head.unit else []
    found = [one.name for one in QUANTITIES.values() if one.unit in told]
    # what none is by its unit alone
    never = ("run_time", "event_time", "angular_frequency", "stress", "strain")
    found = [name for name in found if name not in never]
    if not found:
        found = ["relaxation_modulus", "storage_modulus", "force", "cor"]
    if "frequency" in names:
        found = [name for name in found if name != "relaxation_modulus"]
    elif "time" in names or "run_time" in names:
        found = [name for name in found if name not in _DYNAMIC]
    return hints.of_moduli(head, found, names)[:4]


def _say_which(text: str, may: Sequence[str], more: str = "") -> str:
    """The option that says what a column is, by what it may be."""
    which = "which" if len(may) > 1 else "so"
    said = option("columns", {may[0]: text})
    return f"if '{text}' is {' or '.join(may)}{more}, say {which}: {said}"


def _first_comma(rows: Sequence[Row], column: Column) -> str:
    return next(column.cell(row) for row in rows if "," in column.cell(row))


def _meant(unit: str, si: str) -> str:
    """A unit of a quantity that is like another text."""
    known = examples(si).replace(" or ", ", ").split(", ")
    found = next((one for one in known if one.lower() == plain_unit(unit).lower()), "")
    return f"; did you mean {found}?" if found else ""
