"""Input for other programs from e(v): of a pair of bodies, or of a mixture."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from .. import _command
from .._library import UsageError
from .._outputs import finish
from ..arguments import listed
from ..case import Case, as_case, read_cases
from .codes import MEANING, Export, export_pair
from .mixture import Mixture, export_mixture
from .sizes import cases_of
from .targets import TARGETS

Source = Case | str | os.PathLike[str]


def export(
    cases: Source | Sequence[Source],
    target: str,
    velocities: ArrayLike,
    *,
    quantity: str = "cor_sphere",
    master: bool = False,
    law: int = 1,
    threads: int | None = None,
) -> Export | Mixture:
    """Input of another program for the impacts of a case, or of all pairs of a mixture.

    Parameters
    ----------
    cases
        The case: a sphere, and a plate or another sphere; or those of all pairs, as `mixture`
        makes them.
    target
        Program: a name of `TARGETS`.
    velocities
        Velocities [m/s] that rise, at least 2. The law is also fitted and judged between them.
    quantity
        What e is: `cor_sphere` or `cor`; both are the same without waves.
    master
        e against (m/sqrt(R v))^(2/5), for a `table`: one curve for all sizes of two materials.
    law
        Number of the law in the header of the export, by its misfit; 1: the best one.
    threads
        As for `Case.run`.

    Raises
    ------
    InputError
        The program has no such contact, or a pair of the mixture is missing.
    NumericalError
        An impact has no result.
    """
    given = [as_case(one) for one in listed(cases)]
    if not given:
        raise UsageError("cases: expected one or more")
    if len(given) == 1:
        return export_pair(given[0], target, velocities, quantity=quantity, master=master, law=law,
                           threads=threads)  # fmt: skip
    if master:
        raise UsageError(f"master: found {len(given)} cases, expected one pair of materials, for "
                         "all of whose sizes the curve is")  # fmt: skip
    return export_mixture(given, target, velocities, quantity=quantity, law=law, threads=threads)


def _parser() -> _command.Parser:
    """Options of `vcor export`."""
    parser = _command.Parser(
        "export",
        description="Input for other programs from e(v) of a case: the law that they have, fitted "
        "to e and contact times, with its misfit. Several cases are all pairs of a mixture of "
        "beads and walls. Prints it; with --output, writes it and a figure.",
    )
    add = parser.add_argument
    add(
        "case",
        metavar="CASE.nml",
        nargs="+",
        help="case of a pair, or of all pairs of a mixture, and files of materials; with "
        "--mixture, files of materials, of which the first may have other groups of a case too",
    )
    add("--mixture", metavar="SIZES.csv",
        help="make all pairs of a mixture from a table with the columns material and radius [mm] "
        "or diameter [mm], of walls the word wall, and thickness [mm]")  # fmt: skip
    add("--for", metavar="PROGRAM", dest="target", required=True, type=str.lower,
        help=f"one of {', '.join(TARGETS)}")  # fmt: skip
    add("--velocities", metavar="A:B:N", required=True,
        help="N velocities from A to B [m/s], in equal ratios")  # fmt: skip
    add("--quantity", choices=tuple(MEANING), default="cor_sphere",
        help="what e is; default: cor_sphere")  # fmt: skip
    add("--master", action="store_true",
        help="table of e against (m/sqrt(R v))^(2/5), for all sizes of a pair")  # fmt: skip
    add("--law", metavar="N", type=int, default=1, help="law of the header; default: the best, 1")
    add("--threads", metavar="N", type=int, help="threads; default: one per core")
    parser.add_outputs()
    parser.set_defaults(output=None)
    return parser


def _work(options: argparse.Namespace) -> None:
    """`vcor export`: restitution at velocities A:B:N [m/s], and the input of another program.

    UsageError: velocities that are no range with 2 to 10000 numbers.
    """
    try:
        low, high, count = options.velocities.split(":")
        if not (0 < float(low) < float(high) < math.inf and 2 <= int(count) <= 10000):
            raise ValueError
        velocities = np.geomspace(float(low), float(high), int(count))
    except ValueError:
        raise UsageError(
            f"--velocities {options.velocities}: expected A:B:N, N velocities from A up to B in "
            "m/s, such as 0.05:5:20"
        ) from None
    cases = (read_cases(options.case) if options.mixture is None
             else cases_of(options.mixture, options.case))  # fmt: skip
    found = export(cases, options.target, velocities, quantity=options.quantity,
                   master=options.master, law=options.law, threads=options.threads)  # fmt: skip
    if options.output is None:
        sys.stdout.write(str(found))
        return
    of_pair = isinstance(found, Export)
    stem = f"{Path(options.case[0]).stem if of_pair else 'mixture'}_{found.target}"
    finish(options, "\n".join(found.header), stem, found.texts, found.figure())
