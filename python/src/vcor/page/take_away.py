"""Files of a live page: the case, a table, figures; and the commands that make the same."""

from __future__ import annotations

import csv
import io
import re
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import _library
from .._coverage import unwarned
from .._library import Error, InputError, __version__
from .._text import values_of
from ..case import Case, read
from .answer import Span

#: Figures that can be taken, as `vcor plot` draws them
FIGURES = {"curve": "e over the range", "history": "Impact over time", "loop": "Loop"}
#: Settings of Matplotlib are those of the whole process
_lock = threading.Lock()


def case_text(case: Case, folder: Path) -> str:
    """The case as a file that the program reads wherever it is put.

    Parameters
    ----------
    case
        The case.
    folder
        Where a file may stand for a moment, so that data files have their whole paths.
    """
    with tempfile.TemporaryDirectory(dir=folder) as own:
        path = Path(own) / "case.nml"
        case.save(path)
        return path.read_text(encoding="utf-8")


def name_of(case: Case) -> str:
    """Name for files, without an ending."""
    words = re.sub(r"[^\w-]+", "_", Path(case.name).stem).strip("_")
    return words or "case"


def commands(case: Case, files: Sequence[str], folder: Path) -> tuple[str, str]:
    """The shell command and the lines of Python that give the same bits.

    With the files that the page was started with, if values at addresses make the case of them,
    else with the whole case.
    """
    text = case_text(case, folder)
    settings = _settings(case, files)
    if settings is not None:
        words = [f"--set {_quoted(f'{address}={value}')}" for address, value in settings.items()]
        shell = " ".join(["vcor run", *map(_quoted, files), *words, "--print cor_sphere"])
        lines = [f"case = vcor.read({', '.join(map(repr, files))})"]
        lines += [f"case[{address!r}] = {_value(value)}" for address, value in settings.items()]
    else:
        name = f"{name_of(case)}.nml"
        shell = f"cat > {_quoted(name)} <<'END'\n{text}END\n"
        shell += f"vcor run {_quoted(name)} --print cor_sphere"
        lines = [f'case = vcor.Case(r"""\n{text}""")']
    python = "\n".join(["import vcor", "", *lines, 'print(case.solve()["cor_sphere"])'])
    return shell, python


def _settings(case: Case, files: Sequence[str]) -> dict[str, str] | None:
    """Values at addresses that make the case of its files; None if there is more to it."""
    if not files:
        return None
    try:
        first = read(*files)
        wanted, start = values_of(case.text()), values_of(first.text())
        found = {address: value for address, value in wanted.items() if start.get(address) != value}
        for address, value in found.items():
            first[address] = value
        if first.text() != case.text():
            return None
    except Error:
        return None
    return found


def differences(case: Case, other: Case) -> list[str]:
    """Addresses at which two cases differ, those of the first one first."""
    one, two = values_of(case.text()), values_of(other.text())
    found = [key for key in {**one, **two} if one.get(key) != two.get(key)]
    return [key for key in found if not key.startswith(("case.", "output."))]


def _quoted(word: str) -> str:
    """A word as a shell needs it."""
    if re.fullmatch(r"[\w./=:+,()-]+", word):
        return word
    return "'" + word.replace("'", "'\\''") + "'"


def _value(text: str) -> str:
    """A value of a namelist in Python."""
    if text.startswith("'"):
        return repr(text[1:-1].replace("''", "'"))
    if text in (".true.", ".false."):
        return str(text == ".true.")
    numbers = [repr(float(word)) for word in text.split(",") if word.strip()]
    return numbers[0] if len(numbers) == 1 else f"[{', '.join(numbers)}]"


def table(case: Case, span: Span | None, folder: Path) -> str:
    """All columns of the summary over a range, as the program writes them, or of the impact."""
    columns = _library.columns(0)
    x = span.values() if span else np.empty((1, 0))
    found, _ = case._solve([span.address] if span else [], x.reshape(len(x), -1), list(columns), 0)
    units = {span.address: case._describe(span.address).unit} if span else {}
    units |= {name: column.unit for name, column in columns.items()}
    out = io.StringIO()
    out.write(f"# vcor {__version__}\n# title: {case['case.title'] or ''}\n")
    out.write(f"# units: {', '.join(f'{name} [{unit}]' for name, unit in units.items() if unit)}\n")
    out.writelines(f"# {line}\n" for line in case_text(case, folder).splitlines())
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(units)
    for point, values in zip(x, found.tolist(), strict=True):
        row = [one.value(value) for one, value in zip(columns.values(), values, strict=True)]
        rows.writerow(([repr(float(point))] if span else []) + row)
    return out.getvalue()


def svg(kind: str, cases: Sequence[Case], labels: Sequence[str], span: Span | None) -> str:
    """A figure in the style of `vcor plot`, as SVG.

    Raises
    ------
    Error
        A case has no such figure; the message is one line.
    """
    # a second of imports that a page without a figure does not need
    import matplotlib as mpl

    from .. import plot

    out = io.StringIO()
    with _lock, unwarned():
        if kind == "curve":
            if span is None:
                raise InputError("there is no number to draw e against")
            x = span.values()
            sources: list[Any] = []
            for case in cases:
                names = ["cor_sphere", "validity", "validity_cause", "status"]
                found, _ = case._solve([span.address], x[:, None], names, 0)
                sources.append(case._dataset(names, found, {span.address: (span.address, x)}))
            kind, quantities, log = "sweep", ["cor_sphere"], "x" * span.is_log
        else:
            sources, quantities, log = list(cases), None, None
        legends = list(labels) if len(cases) > 1 else []
        made = plot.figure(sources, kind=kind, legends=legends, quantities=quantities, log=log)
        with mpl.style.context(plot.STYLE):
            made.savefig(out, format="svg", metadata={"Date": None})
    return out.getvalue()
