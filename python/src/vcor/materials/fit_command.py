"""Command `vcor fit`: a material from data, or from another model."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import _command
from .._coverage import unwarned
from .._library import Error, FileError, InputError, UsageError, __version__, printable
from .._text import near, place, write
from ..arguments import written
from ..case import number, read, with_material
from .data import add_data_options, columns_option, read_data
from .fit import (
    MODELS,
    SHIFT_NOTE,
    Fit,
    Parameter,
    check_fixed,
    fit_samples,
    is_shifted,
    moduli_at,
    samples_of,
)
from .samples import Samples

#: Decades before and after the contact time that are sampled, and samples per decade
BEFORE, AFTER, PER_DECADE = 5, 1, 50
#: Note on a model whose misfits are not noise
SYSTEMATIC = "the model does not follow the data: its misfits are not noise"


class Sampled:
    """A material of a case, sampled in place of data."""

    def __init__(self, options: argparse.Namespace) -> None:
        """Sample the material of --from-model; a case with &sweep has its first values.

        The window of times follows from the contact time of its impact; where that has no result, a
        note says so. UsageError: a --set that is no GROUP.KEY=VALUE.
        """
        path, name = _parts(options.from_model)
        self.path = path
        self.case = read(path)
        for word in options.set:
            address, mark, value = word.partition("=")
            if not mark:
                raise UsageError(f"--set {word}: expected GROUP.KEY=VALUE")
            self.case[address.strip()] = value.strip()
        self.notes = [
            f"the case varies {address}, here it is {values[0]:.8g}"
            for address, values in self.case._axes().items()
        ]
        for address, values in self.case._axes().items():
            self.case[address] = float(values[0])
        self.cor = self.contact_time = math.nan
        try:
            with unwarned():
                found = self.case.solve(quantities=["cor", "contact_time"])
            self.cor, self.contact_time = float(found["cor"]), float(found["contact_time"])
        except Error as error:
            self.notes.append(f"the impact has no result ({error}): its window is not known")
        self.name = self._find(name)
        self.material = self.case.material(self.name)
        self.samples = self._sample(options)

    def _find(self, name: str) -> str:
        """The named material, otherwise that of the plate if it relaxes, or of the sphere."""
        case = self.case
        if name and f"{name.replace(' ', '_')}.model" not in case:
            known = [str(case[f"{body}.material"]) for body in ("sphere", "plate")]
            raise UsageError(f"--from-model: there is no material '{name}' in {self.path}, known: "
                             f"{', '.join(dict.fromkeys(known))}{near(name, known)}")  # fmt: skip
        if not name:
            name = str(case["plate.material"])
            if case[f"{name.replace(' ', '_')}.model"] in ("rigid", "elastic"):
                name = str(case["sphere.material"])
        if self.value("model", name) in ("rigid", "elastic"):
            raise InputError(f"{self.path}: the material '{name}' does not relax: there is nothing "
                             "to be fitted")  # fmt: skip
        viscosity = self.value("viscosity", name)
        if isinstance(viscosity, float) and viscosity > 0:
            raise InputError(f"{self.path}: the material '{name}' has a dashpot in parallel "
                             "(viscosity), expected one that relaxes only")  # fmt: skip
        return name

    def value(self, key: str, name: str = "") -> Any:
        """Value of a key of the material."""
        return self.case[f"{(name or self.name).replace(' ', '_')}.{key}"]

    @property
    def place(self) -> str:
        """Its temperature, if it is shifted from its constants, as the fit has no shift."""
        if self.material.time_factor() == 1:
            return ""
        return f" at {self.case['impact.temperature']:.7g} K"

    def _sample(self, options: argparse.Namespace) -> Samples:
        """Moduli of the material from --from to --to, or around the contact time."""
        time = self.contact_time
        if not time > 0 and None in (options.first, options.last):
            raise UsageError(
                f"{self.path}: the contact time is not known, expected --from and --to"
            )
        first = options.first or 10.0 ** (math.floor(math.log10(time)) - BEFORE)
        last = options.last or 10.0 ** (math.ceil(math.log10(time)) + AFTER)
        if not first < last:
            raise UsageError("expected --from before --to")
        n = options.points or 1 + max(1, round(PER_DECADE * math.log10(last / first)))
        at = (
            np.geomspace(1 / last, 1 / first, n)
            if options.dynamic
            else np.geomspace(first, last, n)
        )
        moduli = moduli_at(self.material, at, options.dynamic)
        if not (moduli > 1e-300).all():
            raise InputError(f"{self.path}: the modulus vanishes in the range of the samples, "
                             "expected a narrower one (--from, --to)")  # fmt: skip
        return Samples(at, moduli)

    def compared(self, fit: Fit) -> str:
        """The coefficient of restitution of the case with the material, and with the fit."""
        if not math.isfinite(self.cor):
            return ""
        name = f"   name = {written(self.value('name'), 'name')}"
        group = re.sub(r"(?m)^   name = .*$", lambda _: name, fit.group, count=1)
        if self.value("shift") is not None:
            # the fit is at the temperature of the impact
            kelvin = number(self.case, "impact.temperature")
            kelvin = kelvin if kelvin > 0 else float(self.value("reference_temperature"))
            group = group.replace("\n/", "\n   shift = 'arrhenius'\n   activation_energy = 1.0\n   "
                                  f"reference_temperature = {kelvin!r}\n/")  # fmt: skip
        case = with_material(self.case, self.name.replace(" ", "_"), group)
        try:
            with unwarned():
                found = float(case.solve(quantities=["cor"])["cor"])
        except Error:
            return "  the impact of the case has no result with the fit"
        return (f"  cor of the impact   {self.cor:10.7f}  with the fit {found:10.7f}  difference "
                f"{found - self.cor:9.1E}")  # fmt: skip


def _parts(source: str) -> tuple[str, str]:
    """File and material of CASE.nml:NAME; an existing file of that name is a case."""
    path, mark, name = source.rpartition(":")
    return (path, name) if mark and path and not Path(source).exists() else (source, "")


def report(fit: Fit, source: str, note: str, tail: Sequence[str]) -> str:
    """Report that the command prints before the group."""
    samples = fit.samples
    lines = [f"vcor {__version__}  {source}", note, "", f"  {_title(fit)}"]
    lines.append(f"    {'parameter':24s}{'value':>16s} {'unit':8s}+- standard error")
    lines += [_line(fit, one) for one in fit.parameters]
    band = f"{_short(samples.first_time)} to {_short(samples.last_time)} s"
    if samples.dynamic:
        band += f", from {_short(samples.at[0])} to {_short(samples.at[-1])} rad/s"
    lines += [
        "",
        f"  rms misfit          {percent(fit.rms)}",
        f"  largest misfit      {_largest(fit)}",
        f"  band of the data    {band}",
    ]
    if not fit.follows:
        lines.append(f"  note: {SYSTEMATIC}, its standard errors mean little")
    if is_shifted(samples):
        lines.append(f"  note: {SHIFT_NOTE}")
    if fit.is_open:
        lines.append(
            "  note: the modulus still falls where the data end: equilibrium_modulus holds all "
            "that relaxes later"
        )
    lines += [f"  note: {line}" for line in _hidden(fit)]
    return "\n".join([*lines, *tail, "", ""])


def remarks(fit: Fit, source: str) -> str:
    """Comments before a group: the data of the fit, and its quality."""
    lines = [f"vcor {__version__} fit of {_title(fit)} to {source}",
             f"rms misfit {percent(fit.rms)}, largest {_largest(fit)}"]  # fmt: skip
    if not fit.follows:
        lines.append(SYSTEMATIC)
    if fit.is_open:
        lines.append(f"the data do not reach equilibrium_modulus: 0 to {_short(_upper(fit))} Pa")
    lines += _hidden(fit)
    lines += [
        f"{one.label} is at its bound: {_short(one.value)} +- {_short(one.error)} {one.unit}"
        for one in fit.parameters
        if one.state == "bound"
    ]
    return "".join(f"! {line}\n" for line in lines)


def _hidden(fit: Fit) -> list[str]:
    """Lines about modes of a series that the data cannot see."""
    modes: dict[str, dict[str, None]] = {}
    for one in fit.parameters:
        if one.hidden:
            modes.setdefault(one.hidden, {})[str(one.term)] = None
    lines = []
    for what, which in modes.items():
        plural = len(which) > 1
        verb = "are" if plural else "is"
        lines.append(f"mode{'s' * plural} {', '.join(which)} {verb} {what}")
    return lines


def _title(fit: Fit) -> str:
    """Name of a fitted model, with its number of terms if it has any."""
    n = fit.parameters[-1].term
    return fit.model + (f", {n} term{'s' * (n > 1)}" if n else "")


def _largest(fit: Fit) -> str:
    """The largest misfit and its place."""
    samples, n = fit.samples, len(fit.samples.at)
    at = _short(samples.at[fit.largest_place % n])
    if not samples.dynamic:
        return f"{percent(fit.largest)} at {at} s"
    which = "loss" if fit.largest_place >= n else "storage"
    return f"{percent(fit.largest)} of the {which} modulus at {at} rad/s"


def _upper(fit: Fit) -> float:
    """Upper end of the equilibrium modulus, three standard errors above its value."""
    return fit.parameters[0].value + 3 * fit.parameters[0].error


def _line(fit: Fit, one: Parameter) -> str:
    """Line of a parameter."""
    unit = "" if one.unit == "1" else one.unit
    text = f"    {one.label:24s}{_significant(one.value, _digits(one)):>16s} {unit:8s}"
    if one.state == "fixed":
        return f"{text}given"
    if one is fit.parameters[0] and fit.is_open:
        return f"{text}not reached: 0 to {_short(_upper(fit))}"
    text += f"+- {_short(one.error)}" + ", at its bound" * (one.state == "bound")
    # not even the order of magnitude is known; for a value of 0 the error is a limit
    if 0 < one.value <= one.error:
        text += ", the data do not determine it"
        return text
    if one.unseen:
        what = "if nothing relaxes" if fit.model == "prony" else "if the model holds"
        text += f" {what} {one.unseen}"
    return text + f", {one.hidden}" * bool(one.hidden)


def _short(value: float) -> str:
    return f"{value:.1E}"


def _digits(one: Parameter) -> int:
    """Digits down to the second one of the standard error, 2 to 8."""
    if one.state == "fixed" or not one.error > 1e-8 * one.value > 0:
        return 8
    return max(2, min(8, 2 + math.floor(math.log10(one.value / one.error))))


def _significant(value: float, digits: int = 8) -> str:
    """A number with some digits."""
    if value == 0:
        return "0"
    if not 0.1 <= abs(value) < 10 ** min(6, digits):
        return f"{value:.{digits - 1}E}"
    before = 1 + math.floor(math.log10(float(f"{value:.{digits - 1}e}")))
    return f"{value:.{digits - max(0, before)}f}"


def percent(ratio: float) -> str:
    """A ratio in percent with two digits."""
    if abs(ratio) < 1e-12:
        return "0 %"
    exponent = int(f"{100 * ratio:.1e}".partition("e")[2])
    if abs(exponent) > 4:
        return f"{_short(100 * ratio)} %"
    return f"{100 * ratio:.{max(0, 1 - exponent)}f} %"


def _parser() -> _command.Parser:
    """Options of `vcor fit`."""
    parser = _command.Parser(
        "fit",
        usage="vcor fit DATA [options]\n       vcor fit --from-model CASE.nml[:MATERIAL] [options]",
        description="Fits a material to moduli: time and relaxation modulus, or frequency, storage "
        "and loss modulus (or loss tangent). Prints the parameters with standard errors, the "
        "misfit, the band of the data and a &material group to paste into a case. With "
        "--from-model a material of a case is sampled in place of data: the named one, or that of "
        "the plate; the impact of the case is then solved with the material and with the fit.",
        epilog="The exit code is 5 if the fit does not converge or the data do not determine the "
        "parameters.",
    )
    add = parser.add_argument
    add("data", nargs="*", metavar="DATA", help="data file; - for the standard input")
    add("--model", default=MODELS[0], metavar="NAME",
        help="prony (default), sls, power_law, cerf or mittag_leffler")  # fmt: skip
    add("--terms", type=_whole, metavar="N", help="terms of a Prony series; default: as many as "
        "the data support, or until the largest misfit is below 0.05 %%")  # fmt: skip
    add("--fix", action="append", default=[], metavar="KEY=VALUE", help="a parameter that is "
        "given, in SI units; may be repeated")  # fmt: skip
    add_data_options(parser)
    add("--shear", action="store_true", help="the data are shear moduli G: E = 2 (1 + nu) G")
    add("--poisson-ratio", type=float, metavar="NU", help="Poisson's ratio of the material; "
        "default 0.5; required for shear moduli")  # fmt: skip
    add("--density", type=float, metavar="RHO", help="density of the material [kg/m3]")
    add("--name", metavar="NAME", help="name of the material; default: that of the data file")
    add("--from-model", metavar="CASE.nml", help="sample a material of this case")
    add("--dynamic", action="store_true", help="with --from-model: storage and loss modulus, at "
        "the reciprocals of the times")  # fmt: skip
    add("--set", action="append", default=[], metavar="GROUP.KEY=VALUE",
        help="with --from-model: replace a value of the case")  # fmt: skip
    add("--from", dest="first", type=_positive, metavar="T", help="with --from-model: first time "
        "[s]; default: 1e-5 contact times, rounded to a whole decade")  # fmt: skip
    add("--to", dest="last", type=_positive, metavar="T", help="with --from-model: last time [s]; "
        "default: 10 contact times, rounded to a whole decade")  # fmt: skip
    add("--points", type=_whole, metavar="N", help="with --from-model: number of samples; "
        "default: 50 per decade")  # fmt: skip
    add("--output", metavar="PATH", help="write the group to PATH if it ends in .nml, otherwise "
        "to DATA_fit.nml in the folder PATH")  # fmt: skip
    add("--json", metavar="FILE", help="write values, standard errors, covariance, misfit, band "
        "and group as JSON, such as vcor uncertainty --covariance reads")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing")
    return parser


def _whole(text: str) -> int:
    """A whole number >= 1 of an option."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"found '{text}', expected a whole number from 1")
    return int(text)


def _positive(text: str) -> float:
    """A number > 0 and finite of an option."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"found '{text}', expected a number > 0")
    return value


def _check_options(options: argparse.Namespace) -> dict[str, float]:
    """Refuse options that do not go together; values of --fix."""
    given = options.from_model is not None
    if given and options.data:
        raise UsageError("--from-model takes the place of a data file, found both")
    if given and (options.units or options.columns or options.where or options.shear):
        raise UsageError("--units, --columns, --where and --shear are for data files, found "
                         "--from-model")  # fmt: skip
    if not given and len(options.data) != 1:
        raise UsageError("fit takes one data file, or --from-model CASE.nml")
    if not given and options.dynamic:
        raise UsageError("--dynamic is for --from-model; the names of their columns say "
                         "what data are")  # fmt: skip
    if not given and (options.first or options.last or options.points or options.set):
        raise UsageError("--from, --to, --points and --set are for --from-model")
    fix: dict[str, float] = {}
    for word in options.fix:
        key, mark, text = word.partition("=")
        try:
            value = float(text) if mark else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise UsageError(f"--fix {word}: expected KEY=VALUE with a number")
        if key in fix:
            raise UsageError(f"--fix: {key} is given twice")
        fix[key] = value
    return check_fixed(options.model, fix)


def _work(options: argparse.Namespace) -> None:
    """`vcor fit`: fit data, or samples of a material; print the report and write the files."""
    fix, ratio = _check_options(options), options.poisson_ratio
    density, name, notes, place_of = options.density, options.name, [], ""
    sampled = None
    if options.from_model is not None:
        sampled = Sampled(options)
        samples, source, place_of = sampled.samples, sampled.path, sampled.place
        what = f"{len(samples.at)} samples of {sampled.name}{place_of}"
        density = density or sampled.value("density")
        name = name or str(sampled.value("name"))
        ratio = float(sampled.value("poisson_ratio")) if ratio is None else ratio
        notes = [f"  note: {note}" for note in sampled.notes]
    else:
        table = read_data(options.data[0], columns_option(options.columns),
                          options.units, where=options.where)  # fmt: skip
        samples, source, notes = samples_of(table, ratio, shear=options.shear)
        what = str(table.attrs["taken"]).removeprefix(f"{source}: ")
    stem = Path(source).stem
    fit = fit_samples(
        samples, source, model=options.model, terms=options.terms, fix=fix,
        poisson_ratio=ratio, density=density, name=name or stem,
    )  # fmt: skip
    if sampled:
        what += ", angular frequency [rad/s], storage modulus [Pa], loss modulus [Pa]" if (
            options.dynamic) else ", time [s], relaxation modulus [Pa]"  # fmt: skip
        if line := sampled.compared(fit):
            notes.append(line)
    text = remarks(fit, f"{printable(source)}{place_of}") + fit.group
    files = _write(options, stem, source, text, fit)
    notes += [f"  written {path}" for path in files]
    if options.quiet:
        return
    if ratio is None:
        notes.append("  note: poisson_ratio is taken as 0.5, --poisson-ratio gives another")
    if not density:
        notes.append("  note: the density is not known, --density gives it")
    sys.stdout.write(report(fit, printable(source), what, notes) + text)


def _write(options: argparse.Namespace, stem: str, source: str, text: str, fit: Fit) -> list[Path]:
    """Write the group and the document, where they are asked for."""
    written: list[tuple[Path, str]] = []
    if options.output is not None:
        path = place(options.output, f"{stem}_fit", ["nml"], None, [source])
        written.append((path, text))
    if options.json is not None:
        path = Path(options.json)
        taken = [(Path(source), "would replace a file that is read")]
        taken += [(one, "is that of --output, too") for one, _ in written]
        for other, what in taken:
            if path.resolve() == other.resolve():
                raise UsageError(f"--json: {path} {what}, expected another name")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(f"{path.parent}: {error.strerror or os.strerror(20)}") from None
        written.append((path, json.dumps(fit.as_dict(), indent=1) + "\n"))
    for path, content in written:
        write(path, content.encode())
    return [path for path, _ in written]
