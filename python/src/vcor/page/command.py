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
        description="Open a page in the browser: values of the impact on the left, the coefficient "
        "of restitution of the sphere on the right, with rebound height, verdict, curves and your "
        "own measured points. With --save, write one file with sliders for up to three numbers, "
        "which needs neither vcor nor a network: its impacts are solved beforehand, and the page "
        "interpolates between them.",
    )
    add = parser.add_argument
    add("case", metavar="CASE.nml", nargs="*",
        help="case, and files of materials: what it needs, and with --save others to choose from; "
        "without --save none is needed")  # fmt: skip
    add("--vary", metavar="ADDRESS=FROM:TO", action="append", default=[],
        help="number with a slider and its range with a unit, such as impact.temperature=0C:60C; "
        "up to three, the curve is drawn against the first")  # fmt: skip
    add("--save", metavar="FILE.html", dest="output", help="write the page to this file")
    add("--set", metavar="ADDRESS=VALUE", action="append", default=[],
        help="replace a value of the case, as vcor run does")  # fmt: skip
    add("--body", choices=("plate", "sphere"),
        help="with --save: body whose material is chosen; default: plate")  # fmt: skip
    add("--points", metavar="N", type=int,
        help=f"with --save: points along each range, {LEAST_POINTS} to {MOST_POINTS}; default: "
        "what some 10 s allow, 17 to 129 for one, 9 to 65 for two, 7 to 25 for three")  # fmt: skip
    add("--threads", metavar="N", type=int,
        help="with --save: threads; default: one per core")  # fmt: skip
    add("--port", metavar="N", type=int,
        help="port of 127.0.0.1 at which the page is; default: a free one")  # fmt: skip
    add("--no-browser", dest="browser", action="store_false",
        help="print the address of the page and open no browser")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing")
    return parser


def _work(options: argparse.Namespace) -> None:
    """`vcor page`: serve a live page, or write a page over ranges of --vary.

    UsageError: options that contradict each other.
    """
    vary: dict[str, str] = {}
    for word in options.vary:
        address, _, text = word.partition("=")
        if address in vary:
            raise UsageError(f"--vary: found {address} twice, expected it once")
        vary[address] = text
    settings: dict[str, str] = {}
    for word in options.set:
        address, _, settings[address] = word.partition("=")
    if options.output is None:
        _serve(options, vary, settings)
        return
    if options.port is not None or not options.browser:
        name = "--port" if options.port is not None else "--no-browser"
        raise UsageError(f"{name}: found it with --save, which writes a file: expected one of both")
    if not options.case:
        raise UsageError("found no case, expected one: vcor page CASE.nml --save FILE.html")
    path = target(options.output, options.case[0])
    made = make(
        options.case[0], vary, options.case[1:], settings=settings, body=options.body or "plate",
        points=options.points, threads=options.threads,
    )  # fmt: skip
    made.save(path)
    if not options.quiet:
        sys.stdout.write(f"{made}\nwritten {path}\n")


def _serve(options: argparse.Namespace, vary: dict[str, str], settings: dict[str, str]) -> None:
    """Open a live page."""
    for name in ("body", "points", "threads"):
        if getattr(options, name) is not None:
            raise UsageError(f"--{name}: found it without --save, expected --save FILE.html: a "
                             "live page solves what it shows")  # fmt: skip
    # its parts are not needed for a file
    from .server import serve

    serve(options.case, vary, settings, options.port, browser=options.browser, quiet=options.quiet)
