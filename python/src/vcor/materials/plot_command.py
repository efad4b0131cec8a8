"""The command `vcor plot`: figures of results, with measured points over them."""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import _command, _text
from .._command import FORMATS
from .._library import UsageError
from ..plot import COLUMN, KINDS, PAGE, figure, save
from ..sources import is_result
from .data import add_data_options, columns_option, read_points

#: Units of length [cm]
_UNITS = {"cm": 1.0, "mm": 0.1, "in": 2.54}


def _parser() -> _command.Parser:
    """Options of `vcor plot`."""
    parser = _command.Parser(
        "plot",
        description="Draw figures of results: FILE.h5 of vcor run or vcor material, or materials "
        "in FILE.nml of vcor fit; and measured points over them in FILE.csv with a header such as: "
        "velocity [m/s], cor, cor_sigma",
    )
    add = parser.add_argument
    add("files", nargs="+", metavar="FILE", help="results (.h5, .nml), and measured points (.csv)")
    add("--kind", choices=KINDS, help="kind of figure; default: what the first file is for")
    add(
        "--quantity",
        dest="quantities",
        metavar="NAME,NAME",
        help="columns for sweeps and maps; default: cor",
    )
    add("--legend", dest="legends", metavar="TEXT", action="append", default=[],
        help="a text for each result")  # fmt: skip
    add("--label", dest="labels", metavar="TEXT", action="append", default=[],
        help="a text for each file of measured points")  # fmt: skip
    add("--xlabel", metavar="TEXT", help="label of the axis x, where all panels have the same")
    add("--ylabel", metavar="TEXT", help="label of the axis y, where all panels have the same")
    add("--log", metavar="AXES", help="logarithmic axes: x, y, z (levels), xy ..., or none")
    add("--range", dest="ranges", metavar="AXIS=FROM:TO", action="append", default=[],
        help="range of x, y or the levels z, in the unit that is drawn; repeatable")  # fmt: skip
    add("--levels", metavar="N|Z,Z,...", help="levels of a map, or about how many; default: 8")
    add(
        "--no-hatch",
        dest="hatch",
        action="store_false",
        help="do not hatch where the model does not hold",
    )
    add("--width", metavar="CM", type=_width,
        help=f"width in cm, or such as 85mm or 3.35in; default: {COLUMN} or {PAGE}")  # fmt: skip
    add("--celsius", action="store_true", help="temperatures in degrees Celsius, not in kelvin")
    add("--output", metavar="PATH", help="NAME.svg, .pdf or .png, or a folder")
    add("--format", choices=FORMATS, help="format in a folder; default: svg")
    add("--script", action="store_true", help="leave the Python script that makes the figure")
    add_data_options(parser)
    add("--quiet", action="store_true", help="do not report what is written")
    return parser


def _settings(options: Any) -> dict[str, Any]:
    """Arguments of `figure` that differ from their defaults."""
    settings: dict[str, Any] = {"kind": options.kind, "width": options.width}
    settings["quantities"] = options.quantities.split(",") if options.quantities else None
    settings["legends"], settings["labels"] = options.legends or None, options.labels or None
    settings["xlabel"], settings["ylabel"] = options.xlabel, options.ylabel
    settings["hatch"] = None if options.hatch else False
    settings["celsius"] = options.celsius or None
    if options.log is not None:
        settings["log"] = "" if options.log == "none" else options.log or "none"
    try:
        word = options.levels
        if word:
            levels = [float(level) for level in word.split(",")]
            settings["levels"] = int(word) if word.isdigit() else levels
        ranges = {}
        for word in options.ranges:
            name, _, ends = word.partition("=")
            low, high = (float(end) if end else None for end in ends.split(":"))
            ranges[name] = (low, high)
    except ValueError:
        raise UsageError(
            f"found '{word}', expected a range such as x=0.1:10 or y=0:, or levels such as 10 or "
            "0.2,0.5"
        ) from None
    settings["ranges"] = ranges or None
    settings["columns"], settings["units"] = columns_option(options.columns), options.units
    settings["where"] = options.where or None
    return {name: value for name, value in settings.items() if value is not None}


def _width(word: str) -> float:
    """Width [cm] of an option, a number of cm or with its unit."""
    unit = next((unit for unit in _UNITS if word.endswith(unit)), "")
    try:
        return float(word.removesuffix(unit)) * _UNITS.get(unit, 1.0)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"found '{word}', expected a number of cm, or such as 85mm"
        ) from None


def _work(options: argparse.Namespace) -> None:
    """`vcor plot`: draw the files, write the figure and with --script what draws it again."""
    with warnings.catch_warnings():
        # such as letters that the font does not have
        warnings.simplefilter("ignore")
        settings = _settings(options)
        made = figure(options.files, **settings)
        first = next(name for name in options.files if is_result(name))
        usual = f"{Path(first).stem}_{made.get_label()}"
        path = _text.place(options.output, usual, FORMATS, options.format, options.files)
        if options.script and path.stem in sys.modules:
            raise UsageError(f"a script {path.stem}.py would hide the package "
                             f"{path.stem}, expected another --output")  # fmt: skip
        save(made, path)
        written = [path]
        if options.script:
            written.append(path.with_suffix(".py"))
            _text.write(written[-1], _script(options.files, settings, path).encode())
        measured = [name for name in options.files if not is_result(name)]
        said = read_points(measured, *map(settings.get, ("columns", "units", "where")))
        if not options.quiet:
            sys.stdout.write("".join(f"{one.attrs['taken']}\n" for one in said))
            sys.stdout.write("".join(f"written {path}\n" for path in written))


def _script(files: Sequence[str], settings: dict[str, Any], target: Path) -> str:
    """Python script that makes the same figure."""
    names = [os.path.relpath(name, target.parent) for name in files]
    lines = "".join(f"    {name}={value!r},\n" for name, value in settings.items())
    return (
        '"""Figure made by vcor plot; change it here, and run it in its folder."""\n\n'
        f"import vcor.plot\n\nfigure = vcor.plot.figure(\n    {names!r},\n{lines})\n"
        f"vcor.plot.save(figure, {target.name!r})\n"
    )
