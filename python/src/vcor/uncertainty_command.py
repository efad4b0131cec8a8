"""Command `vcor uncertainty`: of an impact, or along a sweep."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from . import _command
from ._outputs import finish
from .case import read
from .results import as_csv, as_hdf5
from .uncertainty import USUAL, propagate
from .uncertainty_sweep import bands


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
        help="samples, about, at each point of a sweep; default: 4096")  # fmt: skip
    add(
        "--quantity",
        dest="quantities",
        metavar="NAME,NAME",
        help="columns of the summary, the first is drawn",
    )
    add("--seed", metavar="N", type=int, default=1, help="seed of the samples; default: 1")
    add("--threads", metavar="N", type=int, help="threads; default: one per core")
    return parser


def _work(options: argparse.Namespace) -> None:
    """Run the command `vcor uncertainty` on a case or a sweep; write report, figure and files."""
    vary: dict[str, str | float] = {}
    for word in options.vary:
        address, _, vary[address] = word.partition("=")
    case = read(*options.case)
    for word in options.set:
        address, _, case[address] = word.partition("=")
    swept = bool(case._axes())
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
