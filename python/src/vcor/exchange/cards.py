"""Cards of finite element programs: from a material of a case, and from a file."""

from __future__ import annotations

import argparse
import math
import os
import re
import sys
from pathlib import Path

import numpy as np

from .. import _command, _text
from .._coverage import unwarned
from .._library import InputError, NumericalError, UsageError, numbers, whole, within
from .._text import option
from ..arguments import MOST_POINTS
from ..case import Case, number
from ..material_files import IMPACT, material_case
from .card_formats import FORMATS, UNITS, Card, Source, Terms, head_of
from .targets import TARGETS

#: Times of an impact that matter, over the time of contact
_BAND = (1e-2, 2.0)
#: Points per decade at which a sum of exponentials is fitted and its error measured
_POINTS = 40
#: Relative error of a sum
_ACCURACY = 1e-3
#: Weight of the integral before the band, relative to that of a point in it
_AREA_WEIGHT = 10.0
#: Most terms of a sum
_MOST_TERMS = 40
#: Numbers of a shift law
_SHIFT = ("reference_temperature", "wlf_c1", "wlf_c2", "activation_energy")


def card(
    case: Case | str | os.PathLike[str],
    material: str,
    *,
    poisson_ratio: float | None = None,
    band: tuple[float, float] | None = None,
    accuracy: float = _ACCURACY,
    terms: int = _MOST_TERMS,
    use_shift: bool = True,
) -> Card:
    """Material of a case as a constant and exponentials, to be written as a card.

    Parameters
    ----------
    case
        The case, a case file, or a file of materials.
    material
        Name of the material.
    poisson_ratio
        Another Poisson's ratio, at the same E(t).
    band
        First and last time [s] where a sum of exponentials follows a model that is none; None:
        that of the data behind the model, or a hundredth to twice the time of contact; with a
        shift times at the reference temperature.
    accuracy
        Largest relative error of E(t) in the band.
    terms
        Most terms of such a sum.
    use_shift
        Whether the card holds the shift with temperature.

    Raises
    ------
    InputError
        No card holds the material, or no sum of so many terms is accurate enough.
    """
    if poisson_ratio is not None:
        within(poisson_ratio, option("poisson_ratio"), -1, 0.5)
    whole(terms, option("terms"), 1, MOST_POINTS)
    if not 0 < numbers(accuracy, "accuracy", 0, "a number") < 1:
        raise UsageError(
            f"found {option('accuracy', accuracy)}, expected more than 0 and less than 1"
        )
    has_impact = True
    if isinstance(case, Case):
        case = case.copy()
    else:
        case, _, has_impact = material_case(case, material)
    case.text()  # checks it

    def of(key: str) -> float:
        """A number of the material, 0 if it has none."""
        return number(case, f"{material}.{key}", 0.0)

    def series(key: str) -> list[float]:
        """A list of numbers of the material, empty if it has none."""
        return list(np.atleast_1d(case[f"{material}.{key}"] or ()))

    model = str(case[f"{material}.model"])
    if of("viscosity") > 0:
        raise InputError(
            f"{case.name}: '{material}' has a dashpot (viscosity), which no card holds; expected "
            "a fast term in its place, modulus times time = viscosity"
        )
    shift: dict[str, str | float] = {}
    if case[f"{material}.shift"]:
        shift = {"shift": str(case[f"{material}.shift"])}
        shift |= {key: of(key) for key in _SHIFT if case[f"{material}.{key}"]}
        shift |= {"vertical_shift": True} if case[f"{material}.vertical_shift"] else {}
    # in tension, whatever the moduli of the case are
    size = 2 * (1 + of("poisson_ratio")) if case[f"{material}.modulus_kind"] == "shear" else 1.0
    if poisson_ratio is not None and size == 1.0:
        case[f"{material}.poisson_ratio"] = poisson_ratio
    remarks: list[str] = []
    equilibrium = of("equilibrium_modulus")
    found: Terms = []
    if model == "sls":
        beta, glassy = of("beta"), of("glassy_modulus")
        share = of("alpha") / beta if beta else 1.0
        equilibrium, found = glassy * share, [(glassy * (1 - share), 1 / (beta or 1.0))]
    elif model == "prony":
        rates = series("rates")
        found = list(zip(series("moduli"), series("times") or [1 / x for x in rates], strict=True))
    elif model == "mittag_leffler" and of("exponent") == 1:
        found = [(of("relaxing_modulus"), of("time"))]
    elif model not in ("rigid", "elastic"):
        if band is None and of("valid_from") and of("valid_to"):
            band = of("valid_from"), of("valid_to")
        if band is None:
            if not has_impact:
                raise UsageError(f"{case.name}: expected {option('band')}, as there is no impact")
            # the shift of the card takes it back to the temperature of the impact
            impact, factor = case, case.material(material).time_factor()
            if not use_shift and factor != 1:
                impact, factor = case.copy(), 1.0
                impact["impact.temperature"] = of("reference_temperature")
            try:
                with unwarned():
                    solved = impact.solve(quantities=["contact_time"])
                contact = float(solved["contact_time"]) / factor
            except NumericalError as error:
                raise UsageError(f"{error}; expected {option('band')} for the card") from None
            band = _BAND[0] * contact, _BAND[1] * contact
        equilibrium, found, misfit = _sum(case, material, band, accuracy, terms)
        remarks = [f"{len(found)} exponentials in place of model {model}: E(t) to {misfit:.1g} "
                   f"from {band[0]:.3g} to {band[1]:.3g} s"]  # fmt: skip
        size = 1.0
    if not any(modulus for modulus, _ in found):
        raise InputError(f"{case.name}: '{material}' does not relax, which needs no such card")
    if shift and not use_shift:
        remarks.append(f"without its shift: the material at {of('reference_temperature'):g} K")
        shift = {}
    moduli, times = zip(*((size * modulus, time) for modulus, time in found), strict=True)
    ratio = of("poisson_ratio") if poisson_ratio is None else poisson_ratio
    return Card(material, ratio, size * equilibrium, moduli, times, of("density") or None, shift,
                tuple(remarks))  # fmt: skip


def _sum(
    case: Case, material: str, band: tuple[float, float], accuracy: float, most: int
) -> tuple[float, Terms, float]:
    """The shortest sum of exponentials that follows E(t): constant, terms and error.

    What relaxes before the band loses energy as a dashpot does: the integral of E up to the band
    is kept by a fast term. Without it the COR of a power law is wrong by 0.015, with it by 1e-4.
    """
    from scipy.integrate import trapezoid
    from scipy.optimize import nnls

    ends = numbers(band, "band", 1, "two times [s]")
    if ends.shape != (2,) or not 1e-30 <= ends[0] < ends[1] <= 1e30:
        found = ":".join(f"{end:g}" for end in np.atleast_1d(ends))
        raise UsageError(f"{option('band')}: found {found}, expected two times [s] that rise, from "
                         "1e-30 to 1e30")  # fmt: skip
    first, last = ends
    t = np.geomspace(first, last, int(_POINTS * np.log10(last / first)) + 2)
    # at the reference temperature, whatever that of the impact is
    made = case.material(material)
    factor, size = made.time_factor(), 1.0
    if factor != 1 and case[f"{material}.vertical_shift"]:
        size = (number(case, "impact.temperature", 0.0)
                / number(case, f"{material}.reference_temperature", 0.0))  # fmt: skip
    relaxation = made.relaxation(t * factor) / size
    before = np.geomspace(first * 1e-35, first, 4001)
    area = trapezoid(made.relaxation(before * factor) / size * before, np.log(before))
    best = np.inf
    for n in range(min(2, most), most + 1):
        times = np.append(first / 10, np.geomspace(first / 3, last, n - 1))
        values = np.hstack([np.ones((t.size, 1)), np.exp(-t[:, None] / times)])
        values /= relaxation[:, None]
        areas = np.append(first, -times * np.expm1(-first / times)) / area
        target = np.append(np.ones(t.size), _AREA_WEIGHT)
        found, _ = nnls(np.vstack([values, _AREA_WEIGHT * areas]), target, maxiter=200 * n)
        error = float(np.abs(np.append(values @ found, areas @ found) - 1).max())
        best = min(best, error)
        if error <= accuracy:
            kept = zip(found[1:].tolist(), times.tolist(), strict=True)
            return float(found[0]), [term for term in kept if term[0] > 0], error
    raise InputError(
        f"{case.name}: sums of {most} exponentials follow '{material}' to {best:.1g} from "
        f"{first:.3g} to {last:.3g} s, wanted {accuracy:g}; expected a shorter "
        f"{option('band')}, another {option('accuracy')}, or a card with more terms"
    )


def read_card(
    path: str | os.PathLike[str],
    *,
    code: str | None = None,
    material: str | None = None,
    units: str | None = None,
    modulus: float | None = None,
    poisson_ratio: float | None = None,
    use_shift: bool = True,
    celsius: bool = False,
) -> Card:
    """Read the card of a finite element program.

    Parameters
    ----------
    path
        The file; it may hold more than the card.
    code
        The program, one of `card_formats.FORMATS`; None: by what the file looks like.
    material
        Name or number of the material, for a file that has several.
    units
        Units of the card; None: those that its first lines tell if vcor made it, else SI.
    modulus
        Young's modulus at time zero in these units, for a card without elastic constants.
    poisson_ratio
        Poisson's ratio in place of that of the card, at the same shear moduli.
    use_shift
        Whether to read the shift with temperature.
    celsius
        Whether the temperatures of the card are degrees Celsius.

    Returns
    -------
    Card
        The material in SI units; `str` of it is a &material group.
    """
    if poisson_ratio is not None:
        within(poisson_ratio, option("poisson_ratio"), -1, 0.5)
    if modulus is not None:
        within(modulus, option("modulus"), 0, math.inf)
    text = _text.read_text(path)
    if code is None and (head := head_of(text)):
        code = head[1]
    if code is None:
        code = next((code for code, mark in _MARKS if re.search(mark, text)), None)
    if code not in FORMATS:
        expected = f"expected {option('code')}, one of {', '.join(FORMATS)}"
        if code is None:
            raise InputError(f"{os.fspath(path)}: found no card, {expected}")
        raise UsageError(f"unknown program '{code}', {expected}")
    source = Source(os.fspath(path), text, material, units or "", modulus, poisson_ratio, use_shift,
                    celsius)  # fmt: skip
    try:
        made = FORMATS[code].read(source)
    except InputError:
        raise
    except (ArithmeticError, ValueError):
        source.fail(0, "its numbers are beyond the range of vcor, expected a card in other "
                       f"{option('units')}")  # fmt: skip
    _check(made, source)
    return made


def _check(made: Card, source: Source) -> None:
    """Refuse a material that vcor would not read."""
    impact = IMPACT.format(made.name.replace("'", "''"))
    try:
        Case(impact + str(made)).text()
    except InputError as error:
        why = str(error).partition(": ")[2]
        source.fail(0, f"the card makes a group that vcor refuses: {why}")


#: Line by which a file of each program is recognised
_MARKS = (
    ("lsdyna", r"(?im)^\*MAT_"),
    ("abaqus", r"(?im)^\*(MATERIAL|ELASTIC|VISCOELASTIC)\b"),
    ("openradioss", r"(?im)^/(MAT|VISC)/"),
    ("ansys", r"(?im)^\s*TB\s*,"),
    ("comsol", r"(?m)\A(\s*%.*\n|\s*\n)*(\s*\d+\s+\S+\s+\S+\s*(\n|\Z))"),
)


def _parser() -> _command.Parser:
    """Options of `vcor card`."""
    parser = _command.Parser(
        "card",
        description="Write a material of a case as a card of a finite element program, or read "
        "such a card and write a &material group. Models that are not sums of exponentials become "
        "one, with its error.",
    )
    parser.elsewhere = {one: f"; vcor export writes for {one}" for one in TARGETS}
    add = parser.add_argument
    add("file", metavar="FILE", help="case, file of &material groups, or a file that holds a card")
    add("--material", metavar="NAME", help="name of the material; needed if there are several")
    add("--for", dest="code", choices=FORMATS, help="the program")
    add("--output", metavar="FILE", help="file to be written; default: print")
    add("--units", choices=UNITS, help="units of the card; default: SI")
    add("--celsius", action="store_true", help="temperatures of the card are degrees Celsius")
    add("--poisson-ratio", type=float, metavar="NU", help="another Poisson's ratio")
    add(
        "--no-shift",
        dest="use_shift",
        action="store_false",
        help="without the shift with temperature",
    )
    what = "times [s] where a sum of exponentials follows the model; default: those of its data, "
    add("--band", metavar="FROM:TO", help=what + "or a hundredth to twice the contact time")
    what = "largest relative error of such a sum; default: 1e-3"
    add("--accuracy", type=float, default=_ACCURACY, metavar="ERROR", help=what)
    what = "reading: modulus at time zero in the units of the card, if the card has none"
    add("--modulus", type=float, metavar="E", help=what)
    return parser


def _work(options: argparse.Namespace) -> None:
    """`vcor card`: write the card of a material of a case, or read a card as a &material."""
    nu = options.poisson_ratio
    text = _text.read_text(options.file)
    if not head_of(text) and re.search(r"(?im)^\s*&material\b", text):
        if not options.code:
            raise UsageError(f"{options.file} is a case, expected --material and --for")
        options.material = options.material or _only(options.file)
        _refuse(options, "reading a card", modulus=None)
        made = card(
            options.file, options.material, poisson_ratio=nu, band=_band(options.band),
            accuracy=options.accuracy, terms=min(FORMATS[options.code].terms, _MOST_TERMS) - 1 or 1,
            use_shift=options.use_shift,
        )  # fmt: skip
        text = made.text(options.code, options.units or "SI", celsius=options.celsius)
        notes = made.notes(options.code)
    else:
        _refuse(options, "writing a card", band=None, accuracy=_ACCURACY)
        made = read_card(
            options.file, code=options.code, material=options.material, units=options.units,
            modulus=options.modulus, poisson_ratio=nu, use_shift=options.use_shift,
            celsius=options.celsius,
        )  # fmt: skip
        text, notes = str(made), list(made.remarks)
    if options.output:
        ending = Path(options.output).suffix[1:] or ("nml" if text.endswith("/\n") else "txt")
        path = _text.place(options.output, made.name, [ending], None, [options.file])
        _text.write(path, text.encode())
    else:
        sys.stdout.write(text)
    for note in notes:
        sys.stderr.write(f"vcor: note: {note}\n")


def _only(path: str) -> str:
    """The only material of a case that relaxes."""
    case, names, _ = material_case(path)
    names = [name for name in names if case[f"{name}.model"] not in ("rigid", "elastic")]
    if len(names) != 1:
        known = f", one of {', '.join(names)}" if names else ""
        raise UsageError(f"{path}: found {len(names)} materials that relax, expected "
                         f"{option('material')}{known}")  # fmt: skip
    return names[0]


def _refuse(options: argparse.Namespace, what: str, **defaults: float | None) -> None:
    """Refuse options that would be without effect."""
    for name, default in defaults.items():
        if getattr(options, name) != default:
            raise UsageError(f"{option(name)} is for {what}")


def _band(word: str | None) -> tuple[float, float] | None:
    """Times of --band."""
    if word is None:
        return None
    try:
        first, last = map(float, word.split(":"))
    except ValueError:
        raise UsageError(f"found {option('band', word)}, expected FROM:TO in s") from None
    return first, last
