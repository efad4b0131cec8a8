"""Measured data: files of any laboratory in SI units, strictly by the names of columns."""

from __future__ import annotations

import argparse
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .. import _library
from .._library import Floats, InputError, UsageError
from .._text import option
from ..units import ZERO_C
from .grid import read_grid
from .labels import unified
from .names import read_head
from .reader import SAME_TEMPERATURE, Reader, refuse_all_but_moduli
from .select import Where
from .tables import REPLICATES, Choice

if TYPE_CHECKING:
    import pandas as pd

#: Which columns are what, and their units, as a user states them
Columns = Mapping[str, str | int] | Sequence[str] | None
Units = Mapping[str, str] | Sequence[str] | str | None

MODULI = {"relaxation_modulus", "storage_modulus", "loss_modulus"}
#: Relative difference of the frequencies of a sweep of temperatures at one frequency
SAME_FREQUENCY = 0.01


def read_data(
    path: str | os.PathLike[str],
    columns: Columns | Choice = None,
    units: Units = None,
    *,
    where: Where = None,
    unit_of: Callable[[str], str] | None = None,
    whole: bool = True,
) -> pd.DataFrame:
    """Measured data of a file, in SI units and by the names of vcor.

    Parameters
    ----------
    path
        The file: text in any encoding, or a spreadsheet (.xlsx); `-` is the standard input.
    columns
        Which column is what, where the names in the file do not say so: texts of heads or numbers
        of columns by name; or the names of all columns of a file without a head, in their order.
    units
        Units of columns that have none in the file: each for the columns of its quantity, or by
        the names of columns.
    where
        Which rows are taken: `{"ball": "golf"}` those with a word or number in a column, or
        conditions `"ball!=golf"`, `"Run=1"`, `"f=0.1:10"` (a range, in the unit of the file);
        `sheet`, `temperature` (`"temperature!=-20C"`) and `line` are columns too.
    unit_of
        SI unit of the value at an address, for columns with names such as `rubber.beta`.
    whole
        Whether columns that belong together must be complete, as storage and loss modulus.

    Returns
    -------
    pandas.DataFrame
        A row for each point, with its line in the file as index. `attrs` has `kind` (dynamic,
        relaxation, shift, record or impacts), `taken`, a line that says what was taken for what,
        `shear`, whether moduli are shear moduli (None: not stated), `units`, `names`, `remarks`,
        `path`; `word`, how to take the rows with one word of a column that has some; `hertz`,
        whether frequencies are in Hz or a multiple; and `digits`, the unit of the last digit of a
        column and its significant digits.
    """
    import pandas as pd

    choice = columns if isinstance(columns, Choice) else Choice(columns, units, where=where)
    grid = read_grid(path)
    reader = Reader(grid, choice, unit_of, whole)
    parts, kind = reader.parts()
    frame = pd.concat(parts)
    frame.index.name = "line"
    if frame["set"].nunique() < 2:
        frame = frame.drop(columns="set")
    names = {key: text for key, text in reader.names.items() if key in frame}
    frame.attrs = {
        "path": grid.path,
        "kind": kind,
        "shear": reader.shear(),
        "names": names,
        "units": {key: reader.units.get(key, "") for key in frame},
        "remarks": grid.remarks,
        "digits": reader.digits,
        "hertz": reader.hertz,
        "word": reader.word,
    }
    frame.attrs["taken"] = reader.taken(frame)
    if whole and kind in ("dynamic", "relaxation"):
        frame.attrs["taken"] += _replicates(frame)
    return frame


def curves(data: pd.DataFrame) -> list[pd.DataFrame]:
    """Moduli at one temperature each, by frequency or time that rise, or are equal.

    Several runs at one temperature that agree are one curve, whose points have the number of their
    run as `set`: specimens, sweeps up and down, readings at one frequency. `attrs["temperature"]`
    is the mean temperature [K], nan where the file has none, `attrs["runs"]` the number of runs.
    """
    attrs = data.attrs
    across = "frequency" if attrs["kind"] == "dynamic" else "time"
    if any(remark.strip().startswith("&material shift ") for remark in attrs["remarks"]):
        # a master curve is one, whose points belong to the sets that it was made of
        one = data.sort_values(across)
        one.attrs = {**attrs, "temperature": math.nan, "runs": 1}
        return [one]
    # pandas copies the attributes, with all that is in them, in each operation
    data = data.copy(deep=False)
    data.attrs = {}
    kelvin = data["temperature"].to_numpy() if "temperature" in data else np.full(len(data), np.nan)
    group = data["set"].to_numpy() if "set" in data else np.zeros(len(data))
    jumps = (np.diff(group) != 0) | (np.abs(np.diff(kelvin)) > SAME_TEMPERATURE)
    if across == "frequency" and np.ptp(data[across]) < SAME_FREQUENCY * data[across].max():
        # a temperature sweep
        jumps |= np.isfinite(kelvin[1:])
    found = []
    for part in np.split(np.arange(len(data)), np.flatnonzero(jumps) + 1):
        one = data.iloc[part].copy()
        run = _runs(one[across].to_numpy())
        one["set"] = run
        if run[-1] and not _differ(one, across) < REPLICATES:
            steps = np.diff(one[across])
            rises = steps[steps != 0].size and steps[steps != 0][0] > 0
            at = int(np.argmax(run > 0))
            raise InputError(
                f"{attrs['path']}:{one.index[at]}: found a {across} of "
                f"{one[across].iloc[at]:.6g} after {one[across].iloc[at - 1]:.6g} (line "
                f"{one.index[at - 1]}), expected one curve that {'rises' if rises else 'falls'}, "
                "or a column of temperatures that separates the curves"
                + f"; {attrs['word']} takes one of several" * bool(attrs.get("word"))
                + f"; replicates differ by less than {100 * math.expm1(REPLICATES):.0f} %"
            )
        temperature = one["temperature"].mean() if "temperature" in one else math.nan
        one.attrs = {**attrs, "runs": int(run[-1]) + 1, "temperature": float(temperature)}
        found.append(one)
    if len(found) > 1 and all(len(one) == 1 for one in found):
        # a temperature sweep
        return found
    return [one.sort_values(across, kind="stable") for one in together(found)]


def together(read: Sequence[pd.DataFrame]) -> list[pd.DataFrame]:
    """Curves, those of one temperature that agree as one, as replicates of a measurement are.

    Each has points in any order; `attrs["runs"]` counts how many were put together.
    """
    import pandas as pd

    found: list[pd.DataFrame] = []
    #: Those in each kelvin
    near: dict[int, list[int]] = {}
    for one in read:
        across = "frequency" if one.attrs["kind"] == "dynamic" else "time"
        kelvin = one.attrs["temperature"]
        place = -9 if math.isnan(kelvin) else int(kelvin)
        for i in [i for k in (-1, 0, 1) for i in near.get(place + k, [])]:
            other = found[i]
            at = [each.attrs["temperature"] for each in (one, other)]
            same = abs(at[0] - at[1]) < SAME_TEMPERATURE or all(map(math.isnan, at))
            if not same or one.attrs["kind"] != other.attrs["kind"]:
                continue
            both = pd.concat([other, one.assign(set=one["set"] + other["set"].max() + 1)])
            both = both.sort_values(across, kind="stable")
            # the same numbers once more are a copy, which would lessen the errors for nothing
            columns = [across, *(MODULI & set(both))]
            copy = len(one) == len(other) and (one[columns].values == other[columns].values).all()
            if copy or not _differ(both, across) < REPLICATES:
                continue
            runs = [each.attrs["runs"] for each in (one, other)]
            mean = (at[0] * len(one) + at[1] * len(other)) / len(both)
            both.attrs = {**other.attrs, "runs": sum(runs), "temperature": mean}
            found[i] = both
            break
        else:
            near.setdefault(place, []).append(len(found))
            found.append(one)
    return found


def _runs(x: Floats) -> NDArray[np.int_]:
    """Number of the run, rising or falling throughout, that each point belongs to."""
    run = np.zeros(len(x), dtype=int)
    way = 0.0
    for i, step in enumerate(np.sign(np.diff(x)), 1):
        ends = step == 0 or step == -way
        run[i] = run[i - 1] + ends
        way = 0.0 if ends else step
    return run


def _differ(data: pd.DataFrame, across: str) -> float:
    """Logarithm of the factor by which points of one run differ from others between them.

    The median over all points next to one of another run, of the modulus that differs more; each is
    compared with the line between its neighbours. Infinite if no point lies between others.
    """
    data = data.sort_values(across, kind="stable")
    x, run = np.log(data[across].to_numpy()), data["set"].to_numpy()
    other = np.diff(run) != 0
    mixed = (other[1:] | other[:-1]).nonzero()[0] + 1
    if not mixed.size:
        return math.inf
    span = x[mixed + 1] - x[mixed - 1]
    part = np.where(span > 0, (x[mixed] - x[mixed - 1]) / np.where(span > 0, span, 1.0), 0.5)
    found = 0.0
    for name in MODULI & set(data):
        y = np.log(data[name].to_numpy())
        line = (1 - part) * y[mixed - 1] + part * y[mixed + 1]
        found = max(found, float(np.median(np.abs(y[mixed] - line))))
    return found


def _replicates(data: pd.DataFrame) -> str:
    """Remark on replicates, empty if there are none."""
    try:
        found = curves(data)
    except InputError:
        return ""
    across = "frequency" if data.attrs["kind"] == "dynamic" else "time"
    several = [one for one in found if one.attrs.get("runs", 1) > 1]
    if not several:
        return ""
    counts = [one.attrs["runs"] for one in several]
    most = 100 * math.expm1(max(_differ(one, across) for one in several))
    runs = f"{min(counts)} to {max(counts)}" if min(counts) < max(counts) else f"{counts[0]}"
    each = f" at each of {len(several)} temperatures" if len(several) > 1 else ""
    return f"; {runs} runs{each} are one curve, as they differ by {most:.2g} % only"


def read_moduli(
    name: str | os.PathLike[str],
    columns: Columns | Choice = None,
    units: Units = None,
    *,
    poisson_ratio: float | None = None,
    shear: bool = False,
) -> list[pd.DataFrame]:
    """Tensile moduli of a file at one temperature each; `FILE@-20C` states that of the file.

    Shear moduli, by their names or by `shear`, become tensile ones by Poisson's ratio.
    """
    path, given = _at(os.fspath(name))
    data = read_data(path, columns, units)
    refuse_all_but_moduli(data.attrs["kind"], data.attrs["path"])
    data = tensile(data, poisson_ratio, shear=shear)
    found = curves(data)
    for one in found:
        one.attrs["given"] = given
    if given:
        if len(found) > 1:
            raise InputError(f"{path}: found {len(found)} curves, expected one at {given}")
        found[0].attrs["temperature"] = kelvin(given, path)
    for one in found:
        if not math.isnan(at := one.attrs["temperature"]) and at <= 0:
            raise InputError(
                f"{path}: found {at:g} K, expected a temperature above 0 K; one in degrees "
                "Celsius stands under T [C] or ends in C, as -20C"
            )
    return found


def tensile(
    data: pd.DataFrame, poisson_ratio: float | None = None, *, shear: bool = False
) -> pd.DataFrame:
    """Moduli as tensile ones: shear moduli times 2 (1 + nu)."""
    if shear and data.attrs["shear"] is False:
        raise UsageError(
            f"{option('shear')}: found tensile moduli by their names in {data.attrs['path']}"
        )
    if not (shear or data.attrs["shear"]):
        return data
    if poisson_ratio is None or math.isnan(poisson_ratio):
        raise UsageError(
            f"{data.attrs['path']}: found shear moduli, expected {option('poisson_ratio')}, by "
            "which they become tensile ones"
        )
    found, digits = data.copy(), dict(data.attrs["digits"])
    for key in found:
        if str(key).removesuffix("_sigma").endswith("_modulus"):
            found[key] *= 2 * (1 + poisson_ratio)
            if key in digits:
                digits[key] = 2 * (1 + poisson_ratio) * digits[key][0], digits[key][1]
    found.attrs = {**data.attrs, "shear": False, "digits": digits}
    return found


def _at(name: str) -> tuple[str, str]:
    """File and temperature of FILE@-20C; a file may have such a name itself."""
    if "@" not in name or Path(name).exists():
        return name, ""
    path, _, given = name.rpartition("@")
    return path, given


def kelvin(text: str, what: str) -> float:
    """A temperature such as -20C, 253K or 253 in kelvin."""
    found = re.fullmatch(
        r"([-+]?\d+\.?\d*)\s*(?:°|deg)?([CK]?)", unified(text).replace("−", "-").strip()
    )
    if not found:
        raise UsageError(f"{what}: found '{text}', expected a temperature such as -20C or 253K")
    return float(found[1]) + (ZERO_C if found[2] == "C" else 0.0)


def plain_name(text: str) -> str:
    """Name of a quantity as vcor has it, whatever it is called."""
    return text if text in _library.columns(0) else read_head(text).key or text


def read_points(
    files: Sequence[str | os.PathLike[str]], columns: Columns, units: Units, where: Where
) -> list[pd.DataFrame]:
    """Files of measured points that a figure shows over results."""
    choice = Choice(columns, units, len(files), where)
    data = [read_data(one, choice, whole=False) for one in files]
    choice.refuse_unseen("the files have")
    return data


def add_data_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a command that reads measured data."""
    parser.add_argument(
        "--columns",
        action="append",
        metavar="NAME=HEAD",
        default=[],
        help="which column is what, where its head does not say so: the text of its "
        "head or its number; NAME,NAME,... for a file without heads",
    )
    parser.add_argument(
        "--units",
        metavar="UNIT,UNIT",
        default=None,
        help="units of columns that have none in the file",
    )
    parser.add_argument(
        "--where",
        action="append",
        metavar="COLUMN=VALUE",
        default=[],
        help="rows that are taken: those with a word, a number or one of FROM:TO in a column; "
        "sheet, line and temperature (such as -20C) are columns too; COLUMN!=VALUE for all others",
    )


def columns_option(words: Sequence[str]) -> dict[str, str] | list[str] | None:
    """Values of --columns as `columns` of `read_data`."""
    if not words:
        return None
    if all("=" not in word for word in words):
        return [name.strip() for name in ",".join(words).split(",")]
    found: dict[str, str] = {}
    for word in words:
        last = ""
        for piece in word.split(","):
            key, mark, text = piece.partition("=")
            # a head may hold a comma
            if mark and read_head(key).name:
                last = key.strip()
                found[last] = text.strip()
            elif last:
                found[last] += f",{piece}"
            else:
                raise UsageError(
                    f"{option('columns')}: found '{word}', expected NAME=HEAD with a name such as "
                    "storage_modulus, frequency, temperature or cor"
                )
    return found
