"""Command `vcor uncertainty`: of an impact, or along a sweep."""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import time
import warnings
from pathlib import Path
from typing import Any

from . import _command
from ._coverage import unwarned
from ._library import Error
from ._outputs import finish
from ._text import option
from .case import Case, as_case, read, with_values
from .results import as_csv, as_hdf5
from .uncertainty import USUAL, propagate
from .uncertainty_sweep import bands

#: Time that is announced [s]
LONG = 60.0


def _parser() -> _command.Parser:
    """Options of `vcor uncertainty`."""
    parser = _command.Parser(
        "uncertainty",
        description="How uncertain the results of an impact are, and by what: errors of the "
        "numbers, of the material and of the model, elasticities and Sobol' indices. Writes JSON "
        "and a figure; of a case with one &sweep also CSV and HDF5 with bands along the sweep.",
    )
    parser.add_outputs()
    add = parser.add_argument
    add("case", metavar="CASE.nml", nargs="+", help="case, and files of materials that it needs")
    setting = "replace a value of the case, as vcor run does"
    add("--set", metavar="ADDRESS=VALUE", action="append", default=[], help=setting)
    spreads = "5%% (of its value), 0.1 (in its unit) or 1:2 (uniform)"
    add("--vary", metavar="ADDRESS=SPREAD", action="append", default=[], help=spreads)
    add("--covariance", metavar="FIT.json", help="JSON of vcor fit or vcor identify")
    add("--samples", metavar="N", type=int, default=4096,
        help="impacts that are solved, about, at each point of a sweep; default: 4096")  # fmt: skip
    add(
        "--quantity",
        dest="quantities",
        metavar="NAME,NAME",
        help="columns of the summary, the first is drawn",
    )
    add("--seed", metavar="N", type=int, default=1, help="seed of the samples; default: 1")
    add("--threads", metavar="N", type=int, help="threads; default: one per core")
    return parser


def _announce(case: Case, samples: int, threads: int | None) -> None:
    """Say how long it may take, if that is long."""
    axes, one = as_case(case)._axes(), case
    for address, values in axes.items():
        one = with_values(one, {address: float(values[0])})
    begin = time.perf_counter()
    with contextlib.suppress(Error), unwarned():
        one.solve(quantities=["cor"])
    impacts = samples * math.prod(len(values) for values in axes.values())
    seconds = (time.perf_counter() - begin) * impacts / (threads or os.cpu_count() or 1)
    if seconds > LONG:
        warnings.warn(
            f"{case.name}: {impacts} impacts take some {math.ceil(seconds / 60)} min at least; "
            f"{option('samples')} with a smaller number takes less", stacklevel=2,
        )  # fmt: skip


def _work(options: argparse.Namespace) -> None:
    vary: dict[str, str | float] = {}
    for word in options.vary:
        address, _, vary[address] = word.partition("=")
    case = read(*options.case)
    for word in options.set:
        address, _, case[address] = word.partition("=")
    swept = bool(case._axes())
    _announce(case, options.samples, options.threads)
    found = (bands if swept else propagate)(
        case,
        vary,
        covariance=options.covariance,
        samples=options.samples,
        quantities=options.quantities.split(",") if options.quantities else USUAL,
        seed=options.seed,
        threads=options.threads,
    )
    contents: dict[str, Any] = {".json": found.as_dict()}
    if swept:
        contents |= {".csv": as_csv(found.table), ".h5": as_hdf5(found.table)}
    stem = f"{Path(options.case[0]).stem}_uncertainty"
    finish(options, str(found), stem, contents, found.figure(found.quantities[0]))
