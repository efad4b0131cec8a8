"""Data as the plain table of two columns that `model = 'table'` and `shift_file` read."""

from __future__ import annotations

import argparse
import math
import os
import sys

import numpy as np

from .. import _command
from .._library import InputError, UsageError, within
from .._text import command, option
from .data import (
    Columns,
    Units,
    add_data_options,
    columns_option,
    curves,
    kelvin,
    read_data,
    tensile,
)
from .reader import ALIKE, SAME_TEMPERATURE, refuse_all_but_moduli
from .select import Where


def table(
    path: str | os.PathLike[str],
    columns: Columns = None,
    units: Units = None,
    *,
    poisson_ratio: float | None = None,
    temperature: float | None = None,
    where: Where = None,
) -> tuple[str, str]:
    """Text of a table of relaxation moduli or shift factors, and a line on what was taken.

    Parameters
    ----------
    path
        Measured data, as `read_data` reads them.
    columns, units
        As for `read_data`.
    poisson_ratio
        By which shear moduli become tensile ones; without it they stay what they are.
    temperature
        Which curve [K], where the data have several.
    where
        Which rows are taken, as for `read_data`.
    """
    data = read_data(path, columns, units, where=where)
    if data.attrs["kind"] == "shift":
        data = data.sort_values("temperature")
        if (np.diff(data.temperature) <= 0).any():
            raise InputError(f"{data.attrs['path']}: found a temperature twice, expected it once")
        rows = zip(data.temperature, np.log10(data.shift_factor), strict=True)
        return _text("temperature [K],log10_shift_factor [1]", rows), data.attrs["taken"]
    refuse_all_but_moduli(data.attrs["kind"], data.attrs["path"])
    if data.attrs["kind"] != "relaxation":
        raise InputError(
            f"{data.attrs['path']}: found {ALIKE['dynamic']}, expected moduli against time or "
            f"shift factors, of which a table is made; {command('fit')} takes this file"
        )
    if poisson_ratio is not None:
        data = tensile(data, within(poisson_ratio, option("poisson_ratio"), -1, 0.5))
    found = curves(data)
    if temperature is not None:
        found = [
            one for one in found if abs(one.attrs["temperature"] - temperature) < SAME_TEMPERATURE
        ]
    if len(found) != 1:
        known = ", ".join(f"{one.attrs['temperature']:.2f} K" for one in curves(data)
                          if not math.isnan(one.attrs["temperature"]))  # fmt: skip
        raise UsageError(f"{data.attrs['path']}: found {len(found)} curves ({known or 'without'} "
                         f"temperatures), expected {option('temperature')} with that of "
                         "one")  # fmt: skip
    (one,) = found
    name = "shear_relaxation_modulus" if data.attrs["shear"] else "relaxation_modulus"
    times, moduli = one.time, one.relaxation_modulus
    if one.attrs["runs"] > 1:
        # a table has each time once: the geometric mean of replicates
        means = np.log(moduli).groupby(times.to_numpy()).mean()
        times, moduli = means.index, np.exp(means)
    rows = zip(times, moduli, strict=True)
    return _text(f"time [s],{name} [Pa]", rows), data.attrs["taken"]


def _text(head: str, rows: zip[tuple[float, float]]) -> str:
    return head + "\n" + "".join(f"{float(x)!r},{float(y)!r}\n" for x, y in rows)


def _parser() -> _command.Parser:
    """Options of `vcor table`."""
    parser = _command.Parser(
        "table",
        description="Relaxation moduli or shift factors of a file of measured data as the plain "
        "table that model = 'table' and shift_file read; it is printed.",
    )
    parser.signed = "--temperature"
    parser.add_argument("data", metavar="DATA", help="file of measured data; - is the input")
    add_data_options(parser)
    what = "by which shear moduli become tensile ones"
    parser.add_argument("--poisson-ratio", type=float, metavar="NU", help=what)
    what = "which curve, where the data have several, such as 20C or 293K"
    parser.add_argument("--temperature", metavar="T", help=what)
    parser.add_argument("--quiet", action="store_true", help="do not say what was taken")
    return parser


def _work(options: argparse.Namespace) -> None:
    """`vcor table`: print the plain table that a material of model table reads."""
    at = options.temperature
    text, taken = table(
        options.data, columns_option(options.columns), options.units,
        poisson_ratio=options.poisson_ratio,
        temperature=None if at is None else kelvin(at, "--temperature"),
        where=options.where,
    )  # fmt: skip
    if not options.quiet:
        sys.stderr.write(f"vcor: note: {taken}\n")
    sys.stdout.write(text)
