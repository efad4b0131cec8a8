"""Files as rows of cells: encodings, separators, spreadsheets, and numbers with decimal commas."""

from __future__ import annotations

import csv
import io
import math
import os
import re
import sys
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._library import FileError, InputError
from .names import read_head

#: Largest file that is read [bytes], and largest content of a spreadsheet
MOST_BYTES = 50_000_000
_MOST_UNPACKED = 4 * MOST_BYTES
#: Most cells of a spreadsheet, counted up to the last one of each row, and columns of any file
_MOST_CELLS, MOST_COLUMNS = 10_000_000, 2000
#: Values of a cell of a spreadsheet whose formula fails
_ERRORS = ("#NULL!", "#DIV/0!", "#VALUE!", "#REF!", "#NAME?", "#NUM!", "#N/A")
#: Encodings of instruments that do not write Unicode; the one whose names are known is taken
_ENCODINGS = ("cp1252", "shift_jis", "gb18030", "iso8859_7", "latin-1")
_NUMBER = re.compile(r"[-+−]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][-+−]?\d+)?")
#: Numbers whose thousands are apart, which no other reading allows: 1,234.5 and 1.234,5, 1,234,567
#: and 1.234.567, or 1'234 and with a blank that is no separator
_THOUSANDS = re.compile(
    r"[-+−]?\d{1,3}((,\d{3})+\.\d*|(\.\d{3})+,\d*|(,\d{3}){2,}|(\.\d{3}){2,}"
    "|(['’\u00a0\u2009\u202f]\\d{3})+([.,]\\d*)?)"
)
_MISSING = {"", "nan", "na", "n/a", "#n/a", "#na", "-", "--", "---", "null", "none", "*", "**"}
_REMARKS = ("#", "%", "//", "!")
#: Lines from which the separator is seen
_SEEN = 3000


@dataclass
class Row:
    """A line of a file."""

    line: int
    text: str
    cells: list[str]
    remark: bool = False
    #: Whether it is the name of a sheet, which is a remark
    sheet: bool = False

    def numbers(self) -> int:
        """How many cells are numbers."""
        return sum(map(is_number, self.cells))

    def filled(self) -> int:
        """How many cells are not empty."""
        return sum(map(bool, self.cells))


@dataclass
class Grid:
    """Rows of a file that are not blank, and how they were read."""

    path: str
    rows: list[Row]
    separator: str = ""
    #: Lines that are remarks, without their mark
    remarks: list[str] = field(default_factory=list)
    #: Lines at which the sheets of a spreadsheet begin
    sheets: list[int] = field(default_factory=list)


def is_number(cell: str) -> bool:
    """Whether a cell is a number, with a decimal point or a decimal comma."""
    return bool(cell) and (_NUMBER.fullmatch(cell) is not None or has_thousands(cell))


def has_thousands(cell: str) -> bool:
    """Whether a cell is a number whose thousands are apart.

    Others of its column, as 1.234, would be ambiguous: no such number is taken.
    """
    return _THOUSANDS.fullmatch(cell) is not None


def is_missing(cell: str) -> bool:
    """Whether a cell says that there is no number."""
    return cell.lower() in _MISSING


def number(cell: str) -> float:
    """A cell as a number; nan if it holds none that is taken."""
    text = cell.replace(",", ".").replace("−", "-").replace("d", "e").replace("D", "e")
    return float(text) if _NUMBER.fullmatch(cell) else math.nan


def digits_of(cell: str) -> tuple[float, int]:
    """Unit of the last digit of a number, and its significant digits.

    Zeros at the end count only after a decimal mark.
    """
    mantissa, _, power = re.sub("[dD]", "e", cell.lower().replace("−", "-")).partition("e")
    whole, mark, decimals = re.sub(r"[-+]", "", mantissa).replace(",", ".").partition(".")
    last = len(decimals) if mark else len(whole.rstrip("0")) - len(whole)
    digits = (whole + decimals if mark else whole.rstrip("0")).lstrip("0")
    return _power_of_ten(power, last), len(digits)


def resolution(cell: str) -> float:
    """Half a unit of the last digit of a number."""
    mantissa, _, power = re.sub("[dD]", "e", cell.lower().replace("−", "-")).partition("e")
    digits = re.split("[.,]", mantissa)
    return 0.5 * _power_of_ten(power, len(digits[1]) if len(digits) > 1 else 0)


def _power_of_ten(power: str, decimals: int) -> float:
    """Unit of the last of some decimals of a number with a power of ten, 0 or inf beyond reals."""
    # a float, since a text of thousands of digits is no int
    exponent = float(power or 0) - decimals
    return float(f"1e{max(-999.0, min(999.0, exponent)):.0f}")


def read_grid(path: str | os.PathLike[str]) -> Grid:
    """Rows of a file, or of the standard input if its name is a dash."""
    name = os.fspath(path)
    if not name:
        raise FileError("the name of a file is empty")
    raw = _bytes(name)
    name = "stdin" if name == "-" else name
    if raw[:4] == b"PK\x03\x04":
        return _narrow(_spreadsheet(name, raw))
    if raw[:8] == b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1":
        raise InputError(f"{name}: found an old spreadsheet (.xls), expected .xlsx or CSV")
    text = _decoded(name, raw)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for i, line in enumerate(lines, 1):
        if not line.isprintable() and re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]", line):
            raise InputError(f"{name}:{i}: found a control character, expected a text file")
    return _narrow(_split(name, lines))


def _narrow(grid: Grid) -> Grid:
    """Refuse rows with more columns than any table of data has."""
    for row in grid.rows:
        if len(row.cells) > MOST_COLUMNS and row.filled() > 1:
            raise InputError(
                f"{grid.path}:{row.line}: found {len(row.cells)} columns, expected at most "
                f"{MOST_COLUMNS}"
            )
    return grid


def _bytes(name: str) -> bytes:
    """Bytes of a file, or of the standard input for `-`; refused beyond MOST_BYTES."""
    try:
        if name == "-" and sys.stdin is None:
            raise FileError("the standard input is closed")
        if name == "-":
            raw = sys.stdin.buffer.read(MOST_BYTES + 1)
        else:
            if Path(name).is_dir():
                raise FileError(f"{name}: found a folder, expected a file")
            with Path(name).open("rb") as file:
                raw = file.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{name}: {getattr(error, 'strerror', None) or error}") from None
    if len(raw) > MOST_BYTES:
        raise InputError(
            f"{name}: found more than {MOST_BYTES // 10**6} MB, expected a smaller file"
        )
    return raw


def _decoded(name: str, raw: bytes) -> str:
    """Text of a file: Unicode, or in the encoding that makes its names known ones."""
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        known = ["utf-16"]
    elif raw[:3] == b"\xef\xbb\xbf":
        known = ["utf-8-sig"]
    elif len(raw) > 3 and b"\0" in raw[:200] and (not any(raw[1:200:2]) or not any(raw[0:200:2])):
        known = ["utf-16-le" if raw[1] == 0 else "utf-16-be"]
    elif raw[:200].count(b"\0") > 20:
        known = ["utf-16-le" if raw[1:200:2].count(0) > raw[0:200:2].count(0) else "utf-16-be"]
    else:
        known = ["utf-8"]
    try:
        return raw.decode(known[0])
    except UnicodeDecodeError:
        if known != ["utf-8"]:
            raise InputError(f"{name}: the file is not text in {known[0].upper()}") from None
    texts: list[tuple[int, int, str]] = []
    for encoding in _ENCODINGS:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        head = [line for line in text.splitlines()[:200] if not line.isascii()]
        # names may stand between blanks, and have some within
        ways = (r"[;,\t#]|  +", r"\s+")
        cells = [cell for line in head for way in ways for cell in re.split(way, line)]
        texts.append((sum(bool(read_head(cell).name) for cell in cells), -len(texts), text))
    return max(texts)[2]


def _spreadsheet(name: str, raw: bytes) -> Grid:
    """Rows of all sheets, one below the other."""
    try:
        with zipfile.ZipFile(io.BytesIO(raw)) as archive:
            if sum(one.file_size for one in archive.infolist()) > _MOST_UNPACKED:
                raise InputError(
                    f"{name}: found more than {_MOST_UNPACKED // 10**6} MB in it, "
                    "expected a smaller file"
                )
        import openpyxl

        book = openpyxl.load_workbook(
            io.BytesIO(raw), read_only=True, data_only=True, keep_links=False
        )
        return _sheets(name, book.worksheets)
    except (InputError, ModuleNotFoundError):
        raise
    except ImportError as error:
        raise ModuleNotFoundError(str(error), name="openpyxl") from None
    except Exception as error:
        raise InputError(
            f"{name}: the spreadsheet cannot be read ({type(error).__name__})"
        ) from None


def _sheets(name: str, sheets: Iterable[Any]) -> Grid:
    """Rows of sheets, without the empty cells at their ends."""
    rows: list[Row] = []
    starts, line, count = [], 0, 0
    for sheet in sheets:
        starts.append(line + 1)
        # it may say the temperature; a name such as 2020 is no row of data
        title = str(sheet.title)
        rows.append(Row(line + 1, title, [], remark=True, sheet=True))
        # a cell far away makes the sheet large, but not the rows that have cells
        sheet.reset_dimensions()
        for values in sheet.iter_rows(values_only=True):
            line += 1
            cells = [_cell(value) for value in values]
            while cells and not cells[-1]:
                cells.pop()
            count += len(cells)
            if count > _MOST_CELLS:
                raise InputError(
                    f"{name}:{line}: found more than {_MOST_CELLS // 10**6} million cells up to "
                    "the last one of each row, expected a smaller spreadsheet"
                )
            if cells:
                rows.append(Row(line, " ".join(filter(None, cells)), cells))
    return Grid(name, rows, "xlsx", [], starts)


def _cell(value: Any) -> str:
    """Text of a cell of a spreadsheet; empty for none and for an error."""
    if value is None or value in _ERRORS or value != value:
        return ""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        value = int(value)
    return repr(value) if isinstance(value, (int, float)) else " ".join(str(value).split())


def _split(name: str, lines: list[str]) -> Grid:
    """Lines as rows of cells."""
    given = ""
    if lines and (found := re.fullmatch(r"\ufeff?\"?sep=(.)\"?", lines[0].strip(" \r"), re.I)):
        given = found[1]
        lines = ["", *lines[1:]]
    elif lines and lines[0].rstrip("\r\n").lower() == "sep=\t":
        given = "\t"
        lines = ["", *lines[1:]]
    if lines and lines[0].startswith("LabVIEW Measurement"):
        return _labview(name, lines)
    plain = [line for line in lines if line.strip() and not line.lstrip().startswith(_REMARKS)]
    mark = given or separator_of(plain)
    rows, remarks = [], []
    for i, line in enumerate(lines, 1):
        text = line.strip().lstrip("\ufeff")
        if text.startswith(_REMARKS):
            bare = line.strip("\r\n").lstrip(" \ufeff#%/!").rstrip(" ")
            remarks.append(bare.strip())
            if bare.strip():
                rows.append(Row(i, bare, [], remark=True))
            continue
        cells = split_line(line.rstrip("\r\n").lstrip("\ufeff"), mark)
        if any(cells):
            rows.append(Row(i, text, cells))
    return Grid(name, rows, mark, remarks)


def split_line(line: str, mark: str) -> list[str]:
    """Cells of a line."""
    if mark == " ":
        return line.split()
    try:
        cells = next(csv.reader([line], delimiter=mark, skipinitialspace=True))
    except (csv.Error, StopIteration):
        cells = line.split(mark)
    return [cell.strip() for cell in cells]


def separator_of(lines: list[str]) -> str:
    """The separator by which most cells become numbers."""
    if len(lines) > _SEEN:
        lines = [*lines[: _SEEN // 2], *lines[-_SEEN // 2 :]]

    def numbers(mark: str) -> int:
        """Cells that become numbers with a mark, in lines with several."""
        counts = [sum(map(is_number, split_line(line, mark))) for line in lines]
        return sum(count for count in counts if count > 1)

    found = {mark: numbers(mark) for mark in "\t;, "}
    best = max(found, key=lambda mark: found[mark])
    if found[best]:
        return best
    # a single column, or no numbers at all: the mark that the text has
    return next((mark for mark in "\t;" if any(mark in line for line in lines)), ",")


def _labview(name: str, lines: list[str]) -> Grid:
    """A file of LabVIEW measurements (.lvm): what its head says becomes a head of columns."""
    facts: dict[str, list[str]] = {}
    rows: list[Row] = []
    mark, in_head, body = "\t", True, 0
    for i, line in enumerate(lines, 1):
        cells = [cell.strip() for cell in line.split(mark)]
        if len(cells) > 1 and cells[0] == "Separator" and cells[1] == "Comma":
            mark = ","
        if in_head and (line.startswith("Separator,") or cells[0] == "Separator,Comma"):
            mark = ","
        if not any(cells):
            continue
        if cells[0] == "***End_of_Header***":
            in_head = False
            continue
        if cells[0] in ("X_Value", "X-Value") or (
            not in_head and "Comment" in cells and not any(map(is_number, cells))
        ):
            rows.append(Row(i, line, _labview_heads(cells, facts)))
            in_head, body = False, 0
            continue
        if cells[0] in ("Channels", "Samples", "LabVIEW Measurement"):
            in_head = True
        if in_head or not is_number(cells[0]) and not any(map(is_number, cells[1:])):
            facts[cells[0]] = cells[1:]
            continue
        if not cells[0] and (facts.get("X_Columns") or [""])[0] == "No":
            first, step = (number((facts.get(key) or ["nan"])[0]) for key in ("X0", "Delta_X"))
            cells[0] = repr(first + body * step)
        body += 1
        rows.append(Row(i, line, cells))
    return Grid(name, rows, mark)


def _labview_heads(cells: list[str], facts: dict[str, list[str]]) -> list[str]:
    """Names of columns with the units that the head of a LabVIEW file states."""
    units = [unit for unit in facts.get("Y_Unit_Label", []) if unit]
    across = (facts.get("X_Dimension") or ["Time"])[0]
    heads, channel = [], 0
    for cell in cells:
        if cell in ("X_Value", "X-Value"):
            heads.append({"Time": "time [s]", "Frequency": "frequency [Hz]"}.get(across, across))
        elif cell == "Comment" or not cell:
            heads.append(cell)
        else:
            unit = units[channel] if channel < len(units) else ""
            heads.append(f"{cell} [{unit}]" if unit and "[" not in cell else cell)
            channel += 1
    return heads
