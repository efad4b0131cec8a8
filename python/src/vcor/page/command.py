"""Command `vcor page`."""

from __future__ import annotations

import argparse
import sys

from .. import _command
from .._library import UsageError
from .document import LEAST_POINTS, MOST_POINTS, make, target


def _parser() -> _command.Parser:
    """Options of `vcor page`."""
    parser = _command.Parser(
        "page",
        description="Write a page for the browser: sliders for up to three numbers, the "
        "coefficient of restitution of the sphere, its rebound height, whether the model holds, a "
        "curve, and your own measured points over it. It is one file that needs neither vcor nor "
        "a network: the impacts are solved beforehand, and the page interpolates between them.",
    )
    add = parser.add_argument
    add("case", metavar="CASE.nml", nargs="+",
        help="case, and files of materials: what it needs, and others to choose from")  # fmt: skip
    add("--vary", metavar="ADDRESS=FROM:TO", action="append", default=[],
        help="number with a slider and its range with a unit, such as impact.temperature=0C:60C; "
        "up to three, the curve is drawn against the first")  # fmt: skip
    add("--save", metavar="FILE.html", dest="output", required=True, help="the file of the page")
    add("--set", metavar="ADDRESS=VALUE", action="append", default=[],
        help="replace a value of the case, as vcor run does")  # fmt: skip
    add("--body", choices=("plate", "sphere"), default="plate",
        help="body whose material is chosen; default: plate")  # fmt: skip
    add("--points", metavar="N", type=int,
        help=f"points along each range, {LEAST_POINTS} to {MOST_POINTS}; default: what some "
        "10 s allow, 17 to 129 for one range, 9 to 65 for two, 7 to 25 for three")  # fmt: skip
    add("--threads", metavar="N", type=int, help="threads; default: one per core")
    add("--quiet", action="store_true", help="print nothing")
    return parser


def _work(options: argparse.Namespace) -> None:
    vary: dict[str, str] = {}
    for word in options.vary:
        address, _, text = word.partition("=")
        if address in vary:
            raise UsageError(f"--vary: found {address} twice, expected it once")
        vary[address] = text
    settings: dict[str, str] = {}
    for word in options.set:
        address, _, settings[address] = word.partition("=")
    path = target(options.output, options.case[0])
    made = make(
        options.case[0], vary, options.case[1:], settings=settings, body=options.body,
        points=options.points, threads=options.threads,
    )  # fmt: skip
    made.save(path)
    if not options.quiet:
        sys.stdout.write(f"{made}\nwritten {path}\n")
