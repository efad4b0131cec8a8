"""Common parts of the commands: options, and errors of one line."""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib
import io
import os
import re
import signal
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn

from ._library import (
    DataRangeWarning,
    Error,
    FileError,
    UnitWarning,
    UsageError,
    __version__,
    printable,
)
from ._text import OPTIONS, name_flaw, near, option

FORMATS = ("svg", "pdf", "png")


class Parser(argparse.ArgumentParser):
    """Options of a command; a mistake is a `UsageError`."""

    #: Option whose value may begin with a dash, as -5C
    signed = ""
    #: Words about choices that another command has
    elsewhere: Mapping[str, str] = {}

    def __init__(self, name: str, **options: Any) -> None:
        """A parser of `vcor NAME`, whose options are written in full."""
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
        what, mark, words = message.partition("unrecognized arguments: ")
        if mark and not what:
            first = next(iter(words.split()), "")
            message = f"unrecognized arguments: {words if first else repr(words)}"
            message += near(first.partition("=")[0], self._option_string_actions)
        if wrong := re.search(r"invalid choice: '([^']*)'", message):
            message += self.elsewhere.get(wrong[1].lower(), "")
        raise UsageError(f"{message} ({self.prog} --help says more)")

    def options(self, arguments: Sequence[str] | None) -> argparse.Namespace:
        """Options of the command line, without control characters in any.

        From here on messages name them in place of the parameters of Python.
        """
        words = list(sys.argv[1:] if arguments is None else arguments)
        if self.signed in words[:-1]:
            i = words.index(self.signed)
            words[i : i + 2] = [f"{self.signed}={words[i + 1]}"]
        options = self.parse_args(words)
        OPTIONS.set(
            {one.dest: one.option_strings[0] for one in self._actions if one.option_strings}
        )
        for word in vars(options).values():
            for text in [word] if isinstance(word, str) else word if isinstance(word, list) else []:
                if printable(text) != text:
                    raise UsageError(
                        f"found a control character in '{text}', expected a text that "
                        "can be read on one line"
                    )
        if (flaw := name_flaw(getattr(options, "output", None) or "")) != "":
            raise UsageError(f"{option('output')}: the name {flaw}, expected another name")
        return options


def _note(message: Warning | str, category: type[Warning], *_: Any) -> None:
    """Write a warning on one line."""
    kind = "warning" if issubclass(category, (DataRangeWarning, UnitWarning)) else "note"
    sys.stderr.write(f"vcor: {kind}: {printable(str(message))}\n")


@contextlib.contextmanager
def one_line() -> Iterator[None]:
    """Errors and warnings are lines on stderr; an error leaves with the code of the program."""
    spoken = OPTIONS.set(OPTIONS.get())
    try:
        with warnings.catch_warnings():
            # notes are a part of what a command says, whatever PYTHONWARNINGS is
            warnings.simplefilter("default", UserWarning)
            warnings.showwarning = _note  # type: ignore[assignment]
            yield
    except Error as error:
        sys.stderr.write(f"vcor: error: {error}\n")
        sys.exit(error.code)
    except MemoryError:
        sys.stderr.write("vcor: error: the memory is too small for this\n")
        sys.exit(FileError.code)
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        OPTIONS.reset(spoken)


def _print(text: str) -> None:
    """Write what a command prints, UTF-8 in whatever locale."""
    try:
        sys.stdout.buffer.write(text.encode(errors="replace"))
        sys.stdout.flush()
    except OSError as error:
        # what is left in its buffer would fail again at the end
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        raise FileError(f"cannot write the standard output: {error.strerror}") from None


def call(name: str, arguments: Sequence[str] | None = None) -> None:
    """Run a command; an error leaves with the code of the program."""
    with one_line():
        module = importlib.import_module(f"vcor.{MODULES[name]}")
        module._work(module._parser().options(arguments))


def _run(name: str) -> None:
    """Run a command of the shell, if what it needs is there."""
    # a reader that has enough ends the command in silence, as it ends the program
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    with one_line():
        if sys.stdout is None:
            raise FileError("cannot write the standard output: it is closed")
        # printed at the end: until then an error of the system is about something else
        printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(printed):
                call(name)
        except OSError as error:
            what = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
            raise FileError(f"{what}{error.strerror or error}") from None
        except ModuleNotFoundError as error:
            raise UsageError(
                f"vcor {name} needs the Python package {error.name}, expected: "
                f"pip install {error.name}"
            ) from None
        finally:
            _print(printed.getvalue())


#: Module of each command, with its `_parser` and `_work`
MODULES = {
    "card": "exchange.cards",
    "export": "exchange.export",
    "fit": "materials.fit_command",
    "identify": "materials.identification",
    "master": "materials.master",
    "page": "page.command",
    "plot": "materials.plot_command",
    "table": "materials.table",
    "uncertainty": "uncertainty_command",
}


def parser_of(name: str) -> Parser:
    """The options of a command, for its page of the manual."""
    made = importlib.import_module(f"vcor.{MODULES[name]}")._parser()
    assert isinstance(made, Parser)
    return made


# The commands vcor-NAME
card, export, fit, identify, master, page, plot, table, uncertainty = (
    functools.partial(_run, name) for name in MODULES
)
