"""What the commands share: options, errors of one line, names of files, and files written whole."""

from __future__ import annotations

import argparse
import contextlib
import difflib
import functools
import importlib
import json
import math
import os
import signal
import sys
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from ._library import Error, FileError, UsageError, __version__

if TYPE_CHECKING:
    from .case import Case

FORMATS = ("svg", "pdf", "png")


class Parser(argparse.ArgumentParser):
    """Options of a command; a mistake is a `UsageError`."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(prog=f"vcor {name}", allow_abbrev=False, **options)
        self.add_argument("--version", action="version", version=f"vcor {__version__}")

    def add_outputs(self) -> None:
        """Add the options of a command that writes several files and a figure."""
        self.add_argument("--output", metavar="FOLDER", default=".", help="folder for the files")
        self.add_argument(
            "--format", choices=FORMATS, default="svg", help="format of the figure; default: svg"
        )
        self.add_argument("--quiet", action="store_true", help="print nothing")

    def error(self, message: str) -> NoReturn:
        """Refuse the options."""
        what, _, words = message.partition("unrecognized arguments: ")
        if words and not what:
            message += near(words.split()[0].partition("=")[0], self._option_string_actions)
        raise UsageError(f"{message} ({self.prog} --help says more)")

    def options(self, arguments: Sequence[str] | None) -> argparse.Namespace:
        """Options of the command line, without control characters in any."""
        options = self.parse_args(arguments)
        for word in vars(options).values():
            for text in [word] if isinstance(word, str) else word if isinstance(word, list) else []:
                if printable(text) != text:
                    raise UsageError(
                        f"found a control character in '{printable(text)}', expected a text that "
                        "can be read on one line"
                    )
        if (flaw := name_flaw(getattr(options, "output", None) or "")) != "":
            raise UsageError(f"--output: the name {flaw}, expected another name")
        return options


def _note(message: Warning | str, *_: Any) -> None:
    """Write a warning on one line."""
    sys.stderr.write(f"vcor: note: {printable(str(message))}\n")


@contextlib.contextmanager
def one_line() -> Iterator[None]:
    """Errors and warnings are lines on stderr; an error leaves with the code of the program."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _note  # type: ignore[assignment]
            yield
    except Error as error:
        sys.stderr.write(f"vcor: error: {printable(str(error))}\n")
        sys.exit(error.code)
    except KeyboardInterrupt:
        sys.exit(130)


def _run(name: str, module: str) -> None:
    """Run the command of a module, if what it needs is there."""
    # a reader that has enough ends the command in silence, as it ends the program
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    with one_line():
        if sys.stdout is None:
            raise FileError("cannot write the standard output: it is closed")
        try:
            # a text is UTF-8 in whatever locale
            sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
            importlib.import_module(f"vcor.{module}").main()
            sys.stdout.flush()
        except OSError as error:
            # what is left in its buffer would fail again at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            raise FileError(f"cannot write the standard output: {error.strerror}") from None
        except ModuleNotFoundError as error:
            raise UsageError(
                f"vcor {name} needs the Python package {error.name}, expected: "
                f"pip install {error.name}"
            ) from None


# The commands vcor-NAME
card = functools.partial(_run, "card", "cards")
export = functools.partial(_run, "export", "exchange")
identify = functools.partial(_run, "identify", "identification")
master = functools.partial(_run, "master", "master_curve")
plot = functools.partial(_run, "plot", "plot")
uncertainty = functools.partial(_run, "uncertainty", "uncertainty")


def near(word: str, known: Iterable[str]) -> str:
    """What to add to a message about an unknown name, if a known one is like it."""
    found = difflib.get_close_matches(word, list(known), 1)
    return f"; did you mean '{found[0]}'?" if found else ""


def printable(text: str) -> str:
    """A text on one line: `?` for each character that has no shape."""
    return "".join(c if c.isprintable() else " " if c in "\t\n\r" else "?" for c in text)


def read_text(path: str | os.PathLike[str], errors: str = "replace") -> str:
    """Text of a file, without a byte order mark."""
    if not os.fspath(path):
        raise FileError("the name of a file is empty")
    try:
        return Path(path).read_text(encoding="utf-8-sig", errors=errors)
    except OSError as error:
        raise FileError(f"{os.fspath(path)}: {error.strerror}") from None


def number(case: Case, address: str, missing: float = math.nan) -> float:
    """Number at an address of a case."""
    value = case[address]
    return float(value) if isinstance(value, (int, float)) else missing


def document(**entries: Any) -> dict[str, Any]:
    """Results as they are written to JSON, which has no infinity: None in its place."""

    def plain(value: Any) -> Any:
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, Mapping):
            return {key: plain(one) for key, one in value.items()}
        if isinstance(value, (list, tuple)):
            return [plain(one) for one in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    return {"program": "vcor", "version": __version__, **plain(entries)}


def name_flaw(name: str) -> str:
    """What is wrong with the name of a file to be written, empty if nothing is."""
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
        raise UsageError(f"the name '{output}' ends with {path.suffix}, but --format is {ending}")
    if flaw := name_flaw(path.name):
        raise FileError(f"cannot write the file: the name {flaw}, expected another name")
    for name in inputs:
        if path.resolve() == Path(name).resolve():
            raise UsageError(f"{path} would replace a file that is read, expected another --output")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise FileError(f"{path.parent}: found a file, expected the name of a folder") from None
    except OSError as error:
        raise FileError(f"{path.parent}: {error.strerror}") from None
    return path


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


def finish(
    options: argparse.Namespace, report: str, stem: str, contents: Mapping[str, Any], figure: Any
) -> None:
    """Write texts, or what goes into JSON, by the ends of their names and a figure, and report."""
    from .plot import save

    folder = options.output if options.output.endswith("/") else f"{options.output}/"
    paths = [place(folder, stem + end.rpartition(".")[0], [end.rpartition(".")[2]], None, [])
             for end in contents]  # fmt: skip
    for path, content in zip(paths, contents.values(), strict=True):
        text = content if isinstance(content, str) else json.dumps(content, indent=1) + "\n"
        write(path, text.encode())
    paths.append(place(folder, stem, [options.format], None, []))
    save(figure, paths[-1])
    if not options.quiet:
        sys.stdout.write(f"{report}\nwritten {', '.join(map(str, paths))}\n")
