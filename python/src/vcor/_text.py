"""Texts in and out: lines that can be read, names of files, and files written whole."""

from __future__ import annotations

import difflib
import math
import os
import re
import shlex
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import Any

from ._library import Error, FileError, UsageError, __version__

#: Options of the command that runs, by the parameters that they give; empty: Python calls
OPTIONS: ContextVar[Mapping[str, str]] = ContextVar("OPTIONS", default={})  # noqa: B039


def option(name: str, value: Any = None) -> str:
    """A parameter as the user writes it: an option of the command that runs, else in Python.

    Parameters
    ----------
    name
        The parameter of a function, `dest` of the option.
    value
        What to add: a value, or a mapping as `fix={"rubber.beta": 1e3}` has it; `...` is for
        one that the user knows, a boolean is an option without a value.
    """
    known = OPTIONS.get()
    if name not in known:
        return name if value is None else f"{name}={_python(value)}"
    words = [known[name]]
    if isinstance(value, Mapping):
        words += [f"{key}={_plain(one)}" for key, one in value.items()]
    elif value is not None and not isinstance(value, bool):
        words.append(_plain(value))
    return " ".join(map(shlex.quote, words))


def _plain(value: Any) -> str:
    """A value of an option as the shell has it."""
    if isinstance(value, tuple):
        return ":".join(map(_plain, value))
    return "VALUE" if value is ... else f"{value:g}" if isinstance(value, float) else str(value)


def _python(value: Any) -> str:
    """A value of an option as Python has it."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key!r}: {_python(one)}' for key, one in value.items())}}}"
    if isinstance(value, tuple):
        return f"({', '.join(map(_python, value))})"
    return "..." if value is ... else f"{value:g}" if isinstance(value, float) else repr(value)


def command(name: str) -> str:
    """A command of the program as the user calls it, in the shell or in Python."""
    return f"vcor {name}" if OPTIONS.get() else f"vcor.{name}"


#: Columns that are gone, and the one that has what they had
GONE = {"half_space_loss": "wave_loss", "bending_loss": "wave_loss"}


def near(word: str, known: Iterable[str]) -> str:
    """Addition to a message about an unknown name: its successor, or a known one like it."""
    if word in GONE:
        return f"; its place has been taken by {GONE[word]}"
    found = difflib.get_close_matches(word, list(known), 1)
    return f"; did you mean '{found[0]}'?" if found else ""


def read_text(path: str | os.PathLike[str], errors: str = "replace") -> str:
    """Text of a file, without a byte order mark."""
    if not os.fspath(path):
        raise FileError("the name of a file is empty")
    try:
        return Path(path).read_text(encoding="utf-8-sig", errors=errors)
    except (OSError, ValueError) as error:
        # a byte 0 in a name is a ValueError
        if isinstance(error, UnicodeError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise FileError(f"{os.fspath(path)}: {reason}") from None


def document(**entries: Any) -> dict[str, Any]:
    """Results as they are written to JSON, which has no infinity: None in its place."""

    def plain(value: Any) -> Any:
        """A value as JSON has it: lists for arrays, None for numbers that are not finite."""
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, Mapping):
            return {key: plain(one) for key, one in value.items()}
        if isinstance(value, (list, tuple)):
            return [plain(one) for one in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    return {"program": "vcor", "version": __version__, **plain(entries)}


def name_flaw(name: str) -> str:
    """Fault of the name of a file to be written, empty if there is none."""
    for part in name.split("/"):
        if part.startswith(("|", "<")):
            return f"'{name}' has a part that begins with '{part[0]}', a pipe to other programs"
    return ""


def place(
    output: str | None,
    usual: str,
    endings: Sequence[str],
    ending: str | None,
    inputs: Sequence[str],
) -> Path:
    """Where the file of a command goes: a name, or a folder, which is made if it is not there.

    Parameters
    ----------
    output
        Value of --output; a name without an ending, or with a slash at its end, is a folder.
    usual
        Name in a folder, without its ending.
    endings
        Endings that the file may have; the first one is the usual one.
    ending
        Value of --format.
    inputs
        Files that must not be replaced.
    """
    path = Path(output or ".")
    if not output or output.endswith("/") or path.is_dir() or path.suffix in ("", "."):
        path = path / f"{usual}.{ending or endings[0]}"
    elif path.suffix[1:] not in endings:
        raise UsageError(
            f"unknown format '{path.suffix[1:]}' of '{output}', known: {', '.join(endings)}; "
            "the name of a folder ends with a slash"
        )
    elif ending and path.suffix[1:] != ending:
        raise UsageError(f"the name '{output}' ends with {path.suffix}, but {option('format')} is "
                         f"{ending}")  # fmt: skip
    if flaw := name_flaw(path.name):
        raise FileError(f"cannot write the file: the name {flaw}, expected another name")
    for name in inputs:
        if path.resolve() == Path(name).resolve():
            raise UsageError(f"{path} would replace a file that is read, expected another "
                             f"{option('output')}")  # fmt: skip
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise FileError(f"{path.parent}: found a file, expected the name of a folder") from None
    except OSError as error:
        raise FileError(f"{path.parent}: {error.strerror}") from None
    return path


def values_of(case: str) -> dict[str, str]:
    """Values of a case as it is printed, by address."""
    found: dict[str, str] = {}
    group = ""
    # a list may go on in the next line
    for line in re.sub(r",\s*\n\s+", ", ", case).splitlines():
        if line.startswith("&"):
            group = line[1:].strip()
        key, mark, value = (part.strip() for part in line.partition(" = "))
        if mark and group == "material" and key == "name":
            group = value.strip("'").replace(" ", "_")
        if mark:
            found[f"{group}.{key}"] = value
    return found


def write(path: Path, data: bytes) -> None:
    """Write a file under another name and rename it, so that there is never half of it."""
    part = None
    try:
        if path.exists() and not path.is_file():
            raise FileError(f"{path}: found a folder or a device, expected the name of a file")
        descriptor, part = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name[:100]}.")
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
            os.umask(mask := os.umask(0))
            os.fchmod(file.fileno(), path.stat().st_mode if path.exists() else 0o666 & ~mask)
        Path(part).replace(path)
    except OSError as error:
        if part:
            Path(part).unlink(missing_ok=True)
        if isinstance(error, Error):
            raise
        raise FileError(f"{path}: {error.strerror}") from None
