"""The shared library: its functions as include/vcor.h declares them, errors and columns."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import queue
import re
import threading
from collections.abc import Callable
from ctypes import POINTER, Structure, byref, c_char, c_char_p, c_double, c_int, c_void_p
from decimal import Decimal
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
#: Largest seed of random numbers
MOST_SEED = 2**63 - 1


def printable(text: str) -> str:
    """A text on one line: `?` for each character that has no shape."""
    return "".join(c if c.isprintable() else " " if c in "\t\n\r" else "?" for c in text)


def _short(line: str) -> str:
    """A line that can be read, whatever a file has in its cells: no long words, not too many."""
    line = re.sub(r"(\S{80})\S{120,}(\S{20})", r"\1...\2", line)
    return line if len(line) <= 1000 else f"{line[:600]} ... {line[-300:]}"


class Error(Exception):
    """An error of vcor; its text is the line of the program, `code` the program's exit code."""

    code = 1
    #: Summary of an impact that does not separate, else None
    result: Any = None

    def __init__(self, message: str = "") -> None:
        super().__init__(_short(printable(message)))


class InputError(Error, ValueError):
    """The case or a data file is wrong."""

    code = 3


class UsageError(InputError, LookupError):
    """An address, a column or a material of this name does not exist."""

    code = 2


class FileError(Error, OSError):
    """A file cannot be read or written."""

    code = 4


class NumericalError(Error, ArithmeticError):
    """There is no result to be trusted."""

    code = 5


_KINDS = {kind.code: kind for kind in (UsageError, InputError, FileError, NumericalError)}


class NoResultWarning(UserWarning):
    """Some points of a sweep have no result."""


class UnitWarning(UserWarning):
    """A number looks like one in another unit."""


class ValidityWarning(UserWarning):
    """A result is outside of what the model is valid for, or near to that; docs/validity.md."""


class DataRangeWarning(UserWarning):
    """The data behind a material do not cover an impact: its contact time, or its temperature."""


class _ErrorStruct(Structure):
    _fields_ = [("code", c_int), ("message", c_char * 2048)]


@functools.cache
def words_of(labels: str) -> tuple[str, ...]:
    """Words of a column, which loops ask for at each impact."""
    return tuple(labels.split())


class Column(NamedTuple):
    """A column of a table, or what an address is."""

    name: str
    symbol: str
    unit: str
    meaning: str
    #: Words that the numbers stand for, between blanks; empty for numbers
    labels: str
    #: Number of the first word
    first: int
    #: Whether the numbers are whole
    is_whole: int

    @property
    def attrs(self) -> dict[str, str]:
        """Attributes of a variable."""
        attrs = {"units": self.unit} if self.unit else {}
        return attrs | {"long_name": self.meaning}

    def value(self, number: float) -> float | str:
        """One value as it is shown."""
        if self.labels:
            return words_of(self.labels)[int(number) - self.first]
        return int(number) if self.is_whole else number

    def values(self, numbers: Floats) -> NDArray[Any]:
        """Values as they are shown: numbers, or the words that they stand for."""
        if self.labels:
            words: NDArray[Any] = np.array(words_of(self.labels))[numbers.astype(int) - self.first]
            return words
        return numbers.astype(np.int64) if self.is_whole else numbers


class ColumnStruct(Structure):
    """A column as the library has it."""

    _fields_ = [
        ("name", c_char * 256),
        ("symbol", c_char * 16),
        ("unit", c_char * 32),
        ("meaning", c_char * 128),
        ("labels", c_char * 512),
        ("first", c_int),
        ("is_whole", c_int),
    ]

    @property
    def column(self) -> Column:
        """The same in words of Python."""
        values = (getattr(self, key) for key in Column._fields)
        return Column._make(one.decode() if isinstance(one, bytes) else one for one in values)


def _find_library() -> Path:
    """The library beside this file, or where the variable VCOR_LIBRARY says."""
    if "VCOR_LIBRARY" in os.environ:
        return Path(os.environ["VCOR_LIBRARY"])
    path = Path(__file__).parent / "lib" / "libvcor_python.so"
    if not path.exists():
        raise ImportError(f"{path} is missing: install the package with pip, or set VCOR_LIBRARY")
    return path


_library = ctypes.CDLL(str(_find_library()))
_free = ctypes.CDLL(None).free
_free.argtypes = [c_void_p]
_doubles = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
_texts = POINTER(c_char_p)
_ARGUMENTS: dict[str, list[Any]] = {
    "vcor_read": [c_char_p, c_char_p, POINTER(c_void_p)],
    "vcor_copy": [c_void_p, POINTER(c_void_p)],
    "vcor_dump": [c_void_p, POINTER(c_void_p)],
    "vcor_load": [c_char_p, POINTER(c_void_p)],
    "vcor_name": [c_void_p, POINTER(c_void_p)],
    "vcor_add_materials": [c_void_p, c_void_p],
    "vcor_replace_material": [c_void_p, c_char_p, c_char_p, c_char_p],
    "vcor_remove_sweeps": [c_void_p],
    "vcor_set": [c_void_p, c_char_p, c_char_p],
    "vcor_unset": [c_void_p, c_char_p],
    "vcor_get": [c_void_p, c_char_p, POINTER(c_void_p)],
    "vcor_describe": [c_void_p, c_char_p, POINTER(ColumnStruct)],
    "vcor_catalogue": [POINTER(c_void_p)],
    "vcor_case_text": [c_void_p, c_int, POINTER(c_void_p)],
    "vcor_save": [c_void_p, c_char_p, c_int],
    "vcor_axis": [c_void_p, c_int, POINTER(ColumnStruct), POINTER(c_int), POINTER(c_void_p)],
    "vcor_settle": [c_void_p],
    "vcor_solve": [
        c_void_p, c_int, _texts, c_int, _doubles, c_int, _texts, _doubles, c_int,
    ],
    "vcor_impact": [
        c_void_p, c_int, _texts, POINTER(c_double), c_int, _texts, POINTER(c_double),
        POINTER(c_void_p), POINTER(c_void_p), POINTER(c_void_p),
    ],
    "vcor_warnings": [c_void_p, c_int, _texts, c_int, _doubles, POINTER(c_void_p)],
    "vcor_beyond_data": [
        c_void_p, c_int, _texts, c_int, _doubles, _doubles, _doubles, _doubles, POINTER(c_void_p),
    ],
    "vcor_history": [c_void_p, POINTER(c_int), POINTER(c_void_p)],
    "vcor_bounces": [c_void_p, POINTER(c_int), POINTER(c_void_p)],
    "vcor_relaxation": [c_void_p, c_char_p, c_int, _doubles, _doubles],
    "vcor_complex_modulus": [c_void_p, c_char_p, c_int, _doubles, _doubles, _doubles],
    "vcor_time_factor": [c_void_p, c_char_p, POINTER(c_double)],
    "vcor_time_factors": [c_void_p, c_char_p, c_int, _doubles, _doubles],
    "vcor_verify": [c_void_p, _doubles],
    "vcor_exact": [c_void_p, POINTER(c_double)],
}  # fmt: skip
for _name, _types in _ARGUMENTS.items():
    getattr(_library, _name).argtypes = [*_types, POINTER(_ErrorStruct)]
_library.vcor_free.argtypes = [c_void_p]
_library.vcor_column_of.argtypes = [c_int, c_int, POINTER(ColumnStruct)]
_library.vcor_library_version.restype = c_char_p

__version__: str = _library.vcor_library_version().decode()


class Handle(c_void_p):
    """A case of the library, released with the last reference to it, that of a call included."""

    # what modules hold may be gone when the interpreter ends
    def __del__(self, free: Any = _library.vcor_free) -> None:
        """Release the case."""
        if self:
            free(self)


#: Longest time for which Ctrl-C may be missed [s]
_PATIENCE = 0.5


class _Worker:
    """A thread for the calls of the main thread, which Ctrl-C can only reach while it waits."""

    def __init__(self) -> None:
        """Begin the thread; it waits for calls."""
        self._jobs: queue.SimpleQueue[Callable[[], int] | None] = queue.SimpleQueue()
        self._codes: queue.SimpleQueue[int] = queue.SimpleQueue()
        threading.Thread(target=self._work, name="vcor", daemon=True).start()

    def _work(self) -> None:
        """Make the calls, one after the other."""
        while (job := self._jobs.get()) is not None:
            self._codes.put(job())

    def code(self, job: Callable[[], int]) -> int:
        """Code that a call returns."""
        self._jobs.put(job)
        while True:
            # a signal just before a wait does not end it
            try:
                return self._codes.get(timeout=_PATIENCE)
            except queue.Empty:
                pass

    def end(self) -> None:
        """End after the present call."""
        self._jobs.put(None)


_worker: _Worker | None = None


def _interruptible(job: Callable[[], int]) -> int:
    """Return what a call returns; Ctrl-C leaves it to end by itself, unheard."""
    global _worker
    if threading.current_thread() is not threading.main_thread():
        return job()
    # nobody else has it: neither a handler of signals, nor who calls after an interrupt
    worker, _worker = _worker or _Worker(), None
    try:
        code = worker.code(job)
    except BaseException:
        worker.end()
        raise
    _worker = worker
    return code


def _forget_worker() -> None:
    """A child of fork has no threads."""
    global _worker
    _worker = None


os.register_at_fork(after_in_child=_forget_worker)
#: Functions that end at once
_QUICK = (
    "vcor_copy", "vcor_dump", "vcor_load", "vcor_name", "vcor_set", "vcor_unset", "vcor_get",
    "vcor_describe", "vcor_catalogue",
)  # fmt: skip
#: Functions of a material, a microsecond a number at most, and for how many they end at once
_MODULI = ("vcor_relaxation", "vcor_complex_modulus", "vcor_time_factors")
_FEW = 100_000


def call(name: str, *arguments: Any) -> str:
    """Call a function of the library; its remark, if it has one."""
    error = _ErrorStruct()
    given = [
        encoded(one) if kind is c_char_p and not isinstance(one, c_char_p) else one
        for kind, one in zip(_ARGUMENTS[name], arguments, strict=True)
    ]
    function = functools.partial(getattr(_library, name), *given, byref(error))
    # but after an interrupt, what it left may still keep the others waiting
    quick = (
        name in _QUICK
        or (name in _MODULI and arguments[2] <= _FEW)
        # one number, which a loop asks for again and again
        or name == "vcor_time_factor"
    )
    code = function() if quick and _worker else _interruptible(function)
    message: str = error.message.decode(errors="replace")
    if code:
        raise _KINDS.get(code, Error)(message)
    return message


def encoded(text: str | bytes) -> bytes:
    """A text as the library takes it, which ends it at a byte 0."""
    if not isinstance(text, (str, bytes)):
        raise UsageError(f"found {text!r:.60}, expected a text: an address or a name")
    try:
        data = text if isinstance(text, bytes) else text.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError as error:
        raise InputError(f"found {text[error.start]!r}, which is no character, in a text") from None
    if b"\0" in data:
        around = data[max(data.index(0) - 20, 0) :][:40].decode(errors="replace")
        raise InputError(f"found byte 0, a control character, in {around!r}, expected a text")
    return data


def whole(given: Any, name: str, low: int, high: int) -> int:
    """A whole number in a range; anything else is refused by its name."""
    if not isinstance(given, (int, np.integer)) or not low <= given <= high:
        raise UsageError(f"{name}: found {given!r:.60}, expected a whole number from {low} to "
                         f"{high}")  # fmt: skip
    return int(given)


def within(given: Any, name: str, low: float, high: float) -> float:
    """A number above an end, up to another; anything else is refused by its name."""
    expected = f"a number in ({low:g}, {high:g}]"
    number = float(numbers(given, name, 0, expected))
    if not low < number <= high:
        raise UsageError(f"{name}: found {number:g}, expected {expected}")
    return number


def numbers(
    given: Any, name: str, dimensions: float = 1, expected: str = "numbers in one dimension"
) -> Floats:
    """Real numbers, nan where they are masked; what is none is refused by its name."""
    with contextlib.suppress(TypeError, ValueError, OverflowError):
        found = given if isinstance(given, np.ma.MaskedArray) else np.asarray(given)
        if found.dtype == object and all(isinstance(one, (Real, Decimal)) for one in found.flat):
            found = found.astype(float)
        if found.dtype.kind in "iuf" and found.ndim <= dimensions:
            return np.ma.filled(found.astype(float), np.nan)
    raise InputError(f"{name}: expected {expected}")


def text_of(name: str, *arguments: Any) -> str | None:
    """Text that a function of the library gives last."""
    pointer = c_void_p()
    call(name, *arguments, byref(pointer))
    return take_text(pointer)


def bytes_of(name: str, *arguments: Any) -> bytes:
    """Bytes that a function of the library gives last, of any encoding."""
    pointer = c_void_p()
    call(name, *arguments, byref(pointer))
    return _taken(pointer) or b""


def take_text(pointer: c_void_p) -> str | None:
    """A text of the library, which is released."""
    data = _taken(pointer)
    return None if data is None else data.decode()


def _taken(pointer: c_void_p) -> bytes | None:
    """Bytes of the library, which are released."""
    if not pointer:
        return None
    try:
        return ctypes.string_at(pointer)
    finally:
        _free(pointer)


def take_numbers(pointer: c_void_p, n: int) -> Floats:
    """Numbers of the library, which are released."""
    try:
        return np.array(ctypes.cast(pointer, POINTER(c_double))[:n])
    finally:
        _free(pointer)


@functools.lru_cache(maxsize=64)
def texts(texts: tuple[str, ...]) -> Any:
    return (c_char_p * len(texts))(*map(encoded, texts))


@functools.cache
def columns(table: int) -> dict[str, Column]:
    """Columns of a table by name: 0 summary, 1 history, 2 what is compared by verify, 3 bounces."""
    found: dict[str, Column] = {}
    struct = ColumnStruct()
    while _library.vcor_column_of(table, len(found), byref(struct)):
        found[struct.column.name] = struct.column
    return found
