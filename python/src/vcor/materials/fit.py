"""Identification of a material from measured moduli."""

from __future__ import annotations

import math
import os
import re
import textwrap
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .._library import Error, Floats, InputError, UsageError, numbers, printable, whole, within
from .._text import command, document, near, option
from ..arguments import scalars, written
from ..case import Case
from ..material import Material
from ..units import ZERO_C, size
from .data import curves, read_data, tensile
from .laws import LAWS, fit_law
from .master import curve_of, of_curves
from .names import read_head
from .prony import MOST_TERMS, fit_series
from .reader import refuse_all_but_moduli
from .samples import Samples, one_thread

if TYPE_CHECKING:
    import pandas as pd

#: Poisson's ratio of rubber, which is incompressible
INCOMPRESSIBLE = 0.5
#: Models, the first one the default
MODELS = ("prony", *LAWS)
#: Relative change of the modulus below which it is constant
CONSTANT = 1e-6
#: Fall of the modulus over a decade that is none: for a series the accuracy of any data, for a law,
#: which extrapolates, more
FLAT_SERIES, FLAT_LAW = 5e-3, 0.1
#: Digits of a parameter at least, which reproduce the fit, and at most
LEAST_DIGITS, MOST_DIGITS = 6, 15
#: Said of the standard errors of a fit to a master curve, whose points of one temperature move
#: together, which no misfit shows
SHIFT_NOTE = (
    "the standard errors leave out those of the shift factors: identify fits moduli and shift at "
    "once"
)
#: Most points of a curve that are fitted one by one
MOST_POINTS = 2000
#: Arrays of a fit, in their order
_RELAXATION = ("time", "relaxation_modulus")
_DYNAMIC = ("frequency", "storage_modulus", "loss_modulus")
#: Case that a material is put into to be evaluated
_CASE = """&impact velocity = 1.0 /
&sphere radius = 1.0, mass = 1.0, material = {0} /
&plate material = {0}, waves = 'none' /
"""


@dataclass(frozen=True)
class Parameter:
    """A parameter of a fit, in SI units."""

    name: str
    unit: str
    value: float
    #: Standard error; 0 if the value was given
    error: float
    #: free, fixed (given) or bound (at the end of its range)
    state: str
    #: Number of the term of a series, 0 for others
    term: int = 0
    #: `earlier` or `later`: the error holds only if the model does before or after the data
    unseen: str = ""
    #: Where the term of a series lies that the data cannot see: its time is before or after theirs,
    #: or its modulus is not determined
    hidden: str = ""

    @property
    def label(self) -> str:
        """Name as a key of &material, with the number of its term."""
        return f"{self.name}({self.term})" if self.term else self.name

    @property
    def digits(self) -> int:
        """Digits that are written: two more than the standard error leaves, at least six."""
        if not self.value or not self.error:
            return MOST_DIGITS
        sure = math.ceil(math.log10(abs(self.value) / self.error))
        return min(max(LEAST_DIGITS, sure + 2), MOST_DIGITS)

    @property
    def rounded(self) -> float:
        """The value with these digits, or as it was given."""
        return self.value if self.state == "fixed" else float(f"{self.value:.{self.digits - 1}e}")


@dataclass(frozen=True)
class Fit:
    """A material that was found in data."""

    #: Parameters; moduli and times of a Prony series alternate, the fastest term first
    parameters: tuple[Parameter, ...]
    #: The material as a &material group, to be put into a case
    group: str
    #: Root of the mean square of the relative misfits
    rms: float
    #: Whether the model follows the data: the misfits are noise
    follows: bool
    #: Covariance of the parameters, in their units; 0 of what is given
    covariance: Floats = field(repr=False)
    model: str = field(repr=False)
    samples: Samples = field(repr=False)
    #: Largest relative misfit, model/data - 1, and its index in the data
    largest: float = field(repr=False)
    largest_place: int = field(repr=False)
    _document: dict[str, Any] = field(repr=False)

    def __getitem__(self, name: str) -> float | list[float]:
        """Value of a parameter, a list for the terms of a series."""
        values = [one.value for one in self.parameters if one.name == name]
        if not values:
            raise KeyError(name)
        return values if name in ("moduli", "times") else values[0]

    def as_dict(self) -> dict[str, Any]:
        """All results, as `vcor fit --json` writes them."""
        return self._document

    def __str__(self) -> str:
        return self.group

    @property
    def is_open(self) -> bool:
        """Whether the equilibrium modulus of a series is only what had not relaxed by the end."""
        first = self.parameters[0]
        return self.model == "prony" and first.unseen == "later" and first.error < first.value


def fit(
    data: str | os.PathLike[str] | Mapping[str, ArrayLike] | Sequence[ArrayLike],
    *,
    model: str = "prony",
    terms: int | None = None,
    fix: Mapping[str, float] | None = None,
    poisson_ratio: float | None = None,
    density: float | None = None,
    name: str | None = None,
) -> Fit:
    """Fit a model to relaxation moduli, or to storage and loss moduli, as `vcor fit` does.

    Parameters
    ----------
    data
        A data file, or its columns as `vcor.read_data` gives them; or arrays: times [s] and
        relaxation moduli [Pa], or angular frequencies [rad/s], storage and loss moduli [Pa], each
        of shape (n,). Arrays by name may have units: `{"f [Hz]": ..., "E' [MPa]": ...,
        "E'' [MPa]": ...}`; without them `time`, `frequency` and moduli are in s, rad/s and Pa.
    model
        Model of the relaxation modulus.
    terms
        Terms of a Prony series; None: as many as the data support.
    fix
        Parameters of the model that have a given value, in SI units.
    poisson_ratio
        Poisson's ratio; None: 0.5. Needed for shear moduli.
    density
        Density [kg/m3], for the group of the result.
    name
        Name of the material; None: that of the file.

    Returns
    -------
    Fit
        Parameters with standard errors, and the material as a group of a case.

    Raises
    ------
    FileError
        The file cannot be read.
    InputError
        The data cannot be fitted.
    NumericalError
        The fit fails, or the data do not determine the parameters.
    """
    source = "data"
    if isinstance(data, (str, os.PathLike)) or hasattr(data, "attrs"):
        samples, source, _ = samples_of(data, poisson_ratio)
        name = name or Path(source).stem
    else:
        samples = _samples_of_arrays(_named_arrays(data, poisson_ratio))
    return fit_samples(
        samples, source, model=model, terms=terms, fix=fix, poisson_ratio=poisson_ratio,
        density=density, name=name or "material",
    )  # fmt: skip


def samples_of(
    data: Any, poisson_ratio: float | None = None, *, shear: bool = False
) -> tuple[Samples, str, list[str]]:
    """Samples of a file or of its columns, tensile; the name of the file, and what was done."""
    table = data if hasattr(data, "attrs") else read_data(data)
    source, kind = str(table.attrs.get("path", "data")), table.attrs.get("kind")
    refuse_all_but_moduli(kind, source)
    parts = curves(tensile(table, poisson_ratio, shear=shear))
    if len(parts) > 1:
        samples, note = _shifted(parts, source)
        return samples, source, [note]
    keys = tuple(
        found[1].strip()
        for line in table.attrs.get("remarks", ())
        if (found := re.match(r"\s*&material\s+(.*=.*)", line))
    )
    names = ["storage_modulus", "loss_modulus"] if kind == "dynamic" else ["relaxation_modulus"]
    at = parts[0]["frequency" if kind == "dynamic" else "time"].to_numpy(dtype=float)
    moduli = parts[0][names].to_numpy(dtype=float).T
    own = parts[0]["set"].to_numpy(dtype=int) if "set" in parts[0] else None
    if len(at) > MOST_POINTS:
        n = len(at)
        at, moduli = _averaged(at, moduli)
        across = "frequency" if kind == "dynamic" else "time"
        note = (
            f"  note: {n} points are more than {MOST_POINTS}: the fit is to {len(at)} geometric "
            f"means of those next to each other in log {across}"
        )
        return Samples(at, moduli, keys), source, [note]
    return Samples(at, np.ascontiguousarray(moduli), keys, own), source, []


def _averaged(at: Floats, moduli: Floats) -> tuple[Floats, Floats]:
    """Geometric means of points in parts of equal ratio, of which there are MOST_POINTS/2.

    Of twelve decades a part w = 0.028 of the logarithm; a mean is off by w^2/24 = 3e-5 times the
    curvature of ln E against ln t.
    """
    logs = np.log(np.vstack([at, moduli]))
    part = (logs[0] - logs[0].min()) * (MOST_POINTS // 2) / max(float(np.ptp(logs[0])), 1e-300)
    _, part = np.unique(np.floor(part), return_inverse=True)
    counts = np.bincount(part)
    means = np.exp([np.bincount(part, row) / counts for row in logs])
    return means[0], np.ascontiguousarray(means[1:])


def _shifted(parts: Sequence[pd.DataFrame], source: str) -> tuple[Samples, str]:
    """Samples of curves at several temperatures: their master curve, and what was done."""
    if any(math.isnan(one.attrs["temperature"]) for one in parts):
        raise InputError(f"{source}: found {len(parts)} curves without temperatures, expected one")
    found = of_curves([curve_of(one) for one in parts], source)
    if found.law is None:
        raise InputError(
            f"{source}: the shifts between its {len(parts)} temperatures follow no law; "
            f"{command('master')} gives them as a table, and the master curve for {command('fit')}"
        )
    at, moduli, own = found.points()
    order = np.argsort(at, kind="stable")
    celsius = [found.temperatures[i] - ZERO_C for i in (0, -1)]
    reference = found.reference_temperature - ZERO_C
    note = (
        f"  note: {len(parts)} curves from {celsius[0]:.4g} to {celsius[1]:.4g} C are shifted to "
        f"{reference:.4g} C by {found.law.name} ({command('master')} says more)"
    )
    return Samples(at[order], moduli[:, order], tuple(found.lines("")), own[order]), note


def _named_arrays(data: Any, poisson_ratio: float | None) -> Any:
    """Arrays by their names in the order of `fit`, in rad/s, s and Pa; other data as they are."""
    if not isinstance(data, Mapping):
        return data
    found: dict[str, Floats] = {}
    for key, column in data.items():
        head = read_head(str(key))
        scale = size(head.unit, head.si) if head.unit else (1.0, 0.0)
        if head.key not in (*_DYNAMIC, *_RELAXATION) or head.flaw or head.base or not scale:
            raise InputError(
                f"data: found '{key!s:.60}', expected {', '.join(_RELAXATION)}, or "
                f"{', '.join(_DYNAMIC)}, with a unit in brackets if it is not the SI unit"
            )
        if head.key in found:
            raise InputError(f"data: found two arrays of the {head.key.replace('_', ' ')}")
        if head.name == "frequency" and not (head.unit or head.angular):
            warnings.warn(f"data: '{key}' is taken in rad/s; 'frequency [Hz]' is one in Hz",
                          stacklevel=3)  # fmt: skip
        factor = scale[0]
        if head.shear:
            if poisson_ratio is None:
                raise UsageError(f"data: found shear moduli, '{key}', expected poisson_ratio, by "
                                 "which they become tensile ones")  # fmt: skip
            factor *= 2 * (1 + within(poisson_ratio, "poisson_ratio", -1, INCOMPRESSIBLE))
        found[head.key] = factor * numbers(column, str(key))
    wanted = _DYNAMIC if "frequency" in found else _RELAXATION
    if set(found) != set(wanted):
        raise InputError(f"data: found {', '.join(found) or 'nothing'}, expected "
                         f"{', '.join(wanted)}")  # fmt: skip
    return [found[name] for name in wanted]


def _samples_of_arrays(data: Any) -> Samples:
    """Samples of (times, moduli) or (frequencies, storage, loss), shape (n,) each, sorted.

    InputError: other arrays, or a number out of 1e-30 to 1e30.
    """
    parts = list(data) if np.iterable(data) else []
    columns = [numbers(part, "data", np.inf, "numbers").ravel() for part in parts]
    rows = np.array(columns) if len({len(column) for column in columns}) == 1 else np.empty((0, 0))
    if len(rows) not in (2, 3) or not ((rows >= 1e-30) & (rows <= 1e30)).all():
        raise InputError(
            "expected two or three arrays of one length with numbers > 0, from 1e-30 to 1e30: "
            "times and moduli, or angular frequencies, storage and loss moduli"
        )
    rows = rows[:, np.argsort(rows[0], kind="stable")]
    return Samples(rows[0], rows[1:])


def fit_samples(
    samples: Samples, source: str, *, model: str = "prony", terms: int | None = None,
    fix: Mapping[str, float] | None = None, poisson_ratio: float | None = None,
    density: float | None = None, name: str = "material",
) -> Fit:  # fmt: skip
    """Fit a model to samples; errors about all of them name their source."""
    fixed = check_fixed(model, fix)
    count = None if terms is None else whole(terms, option("terms"), 1, MOST_TERMS)
    rho = None if density is None else within(density, option("density"), 0, 1e30)
    nu = INCOMPRESSIBLE
    if poisson_ratio is not None:
        nu = within(poisson_ratio, option("poisson_ratio"), -1, INCOMPRESSIBLE)
    if count and model != "prony":
        raise UsageError(f"{option('terms')} is for {option('model', 'prony')}, found "
                         f"{option('model', model)}")  # fmt: skip
    try:
        _check(samples, model, count, fixed)
        if model == "prony":
            with one_thread():
                series, found = fit_series(samples, count, fixed.get("equilibrium_modulus"))
            names = ["equilibrium_modulus", *["moduli", "times"] * len(series.times)]
            units = ["Pa", *["Pa", "s"] * len(series.times)]
        else:
            with one_thread():
                _, found = fit_law(model, fixed, samples)
            names, units = [*LAWS[model].units], [*LAWS[model].units.values()]
    except Error as error:
        raise type(error)(f"{source}: {error}") from None
    rows = zip(names, units, found.values, found.errors, found.states, strict=True)
    parameters = [
        Parameter(key, unit, float(value), float(error), state,
                  (i + 1) // 2 if model == "prony" else 0)
        for i, (key, unit, value, error, state) in enumerate(rows)
    ]  # fmt: skip
    group, material = group_of(parameters, model, name, rho, nu, samples)
    values = moduli_at(material, samples.at, samples.dynamic).ravel()
    misfit = values / samples.data - 1
    parameters = _marked(parameters, model, material, samples)
    place = int(np.argmax(np.abs(misfit)))
    covariance = found.correlation * np.outer(found.errors, found.errors)
    np.fill_diagonal(covariance, found.errors**2)
    rms = float(np.sqrt(np.mean(misfit**2)))
    return Fit(
        tuple(parameters), group, rms, not found.structured, covariance, model, samples,
        float(misfit[place]), place,
        document(
            name=name, model=model,
            parameters=[
                {"name": one.label, "unit": one.unit, "value": one.value,
                 "standard_error": one.error, "state": one.state, "seen": not one.hidden}
                for one in parameters
            ],
            covariance=covariance, correlation=found.correlation, rms_misfit=rms,
            largest_misfit=float(misfit[place]),
            largest_misfit_at=float(samples.at[place % len(samples.at)]),
            follows=not found.structured, note=SHIFT_NOTE if is_shifted(samples) else "",
            band=[samples.first_time, samples.last_time], group=group,
        ),
    )  # fmt: skip


def is_shifted(samples: Samples) -> bool:
    """Whether the samples are a master curve."""
    return any(key.startswith("shift ") for key in samples.keys)


def check_fixed(model: str, fix: Mapping[str, float] | None) -> dict[str, float]:
    """Values of the parameters that are given, checked."""
    fixed = scalars(fix)
    if not isinstance(model, str):
        raise UsageError(f"{option('model')}: found {model!r:.60}, expected a text")
    if model not in MODELS:
        raise UsageError(f"unknown model '{model}', known: {', '.join(MODELS)}"
                         f"{near(model, MODELS)}")  # fmt: skip
    law = LAWS.get(model)
    known = [*law.units] if law else ["equilibrium_modulus"]
    vanishing = law.vanishing if law else "equilibrium_modulus"
    for key, value in fixed.items():
        if key not in known:
            raise UsageError(f"{option('fix')}: found '{key}', expected a parameter of model "
                             f"{model}: {', '.join(known)}{near(key, known)}")  # fmt: skip
        most = law.most_exponent if law and key == "exponent" else 1e30
        if not (1e-30 <= value <= most or key == vanishing and value == 0):
            sign = ">=" if key == vanishing else ">"
            raise UsageError(f"{option('fix')}: the value of {key} is out of range, expected a "
                             f"number {sign} 0, at most {most:g}")  # fmt: skip
    if model == "sls" and fixed.get("alpha", 0) > fixed.get("beta", math.inf):
        raise UsageError(f"{option('fix')}: found alpha above beta, expected alpha <= beta: the "
                         "rubbery modulus is glassy_modulus*alpha/beta")  # fmt: skip
    if law and len(fixed) == len(known):
        raise UsageError("all parameters are given: there is nothing to be fitted")
    return fixed


def _check(samples: Samples, model: str, terms: int | None, fixed: Mapping[str, float]) -> None:
    """Refuse samples that cannot be fitted."""
    unknowns = len(LAWS[model].units) if model in LAWS else 1 + 2 * (terms or 1)
    unknowns -= len(fixed)
    first = samples.moduli[0]
    if samples.data.size <= unknowns:
        raise InputError(f"found {samples.data.size} moduli, expected at least {unknowns + 1}: the "
                         f"model has {unknowns} parameters to be found")  # fmt: skip
    if not samples.dynamic and first.max() <= (1 + CONSTANT) * first.min():
        raise InputError("the modulus does not change: there is nothing to be fitted, model = "
                         "'elastic' describes it")  # fmt: skip
    x = np.log(samples.at) * (-1 if samples.dynamic else 1)
    if not (x - x.mean()) @ np.log(first) < 0:
        raise InputError("the modulus does not fall with time, or rise with frequency, as that of "
                         "a material that relaxes does")  # fmt: skip


def moduli_at(material: Material, at: Floats, dynamic: bool) -> Floats:
    """Relaxation, or storage and loss moduli of a material, shape (1 or 2, n)."""
    if not dynamic:
        return material.relaxation(at)[None]
    found = material.complex_modulus(at)
    return np.array([found.real, found.imag])


def group_of(
    parameters: Sequence[Parameter], model: str, name: str, density: float | None,
    poisson_ratio: float, samples: Samples,
) -> tuple[str, Material]:  # fmt: skip
    """A &material group, each key with its unit and meaning, and the material."""
    if not isinstance(name, str) or printable(name) != name or not name.strip():
        raise UsageError(f"the name of the material: found {name!r:.60}, expected a text that "
                         "can be read on one line; give another one with "
                         f"{option('name')}")  # fmt: skip
    name = name.strip()
    keys: dict[str, Any] = {"name": name, "model": model}
    if density:
        keys["density"] = density
    keys["poisson_ratio"] = poisson_ratio
    for one in parameters:
        keys[one.name] = [*keys.get(one.name, []), one.rounded] if one.term else one.rounded
    ends = {"valid_from": samples.first_time, "valid_to": samples.last_time}
    keys |= {key: float(f"{time:.{LEAST_DIGITS}g}") for key, time in ends.items()}
    quoted = written(name, "name")
    try:
        case = Case(_CASE.format(quoted) + f"&material name = {quoted} /\n")
    except Error as error:
        raise UsageError(f"the name of the material: {str(error).partition(': ')[2]}; give another "
                         f"one with {option('name')}") from None  # fmt: skip
    lines = list(_lines(keys, model))
    text = "\n".join(["&material", *lines, *(f"   {key}" for key in samples.keys), "/\n"])
    case = Case(_CASE.format(quoted) + "\n".join(["&material", *lines, "/\n"]))
    return text, case.material(name)


def _lines(keys: Mapping[str, Any], model: str) -> Iterator[str]:
    """Lines of a group."""
    case = Case(_CASE.format("'m'") + f"&material name = 'm', model = '{model}' /\n")
    for key, value in keys.items():
        if not isinstance(value, str):
            # no data are known better
            value = [float(f"{x:.7e}") for x in np.atleast_1d(value)]
        text = f"   {key} = {written(value, key)}"
        if key in ("moduli", "times"):
            text = textwrap.fill(text, 96, subsequent_indent=" " * (len(key) + 6))
        about = case._describe(f"m.{key}")
        unit = f"[{about.unit}] " if about.unit not in ("", "1") else ""
        yield f"{text:48s} ! {unit}{about.meaning}"


def _marked(
    parameters: Sequence[Parameter], model: str, material: Material, samples: Samples
) -> list[Parameter]:
    """The parameters with marks where they depend on relaxation that the data do not show.

    A modulus that still falls at the end of the data continues to fall, and no datum shows how far.
    A law extrapolates, correctly if it is the law of the material. A series does not: it adds what
    relaxes later to its equilibrium modulus and to its slowest term. The same holds at the
    beginning of the data. So the slope at that end decides: if the modulus would change by more
    than its standard error over another decade, the error is valid only if the model also describes
    the material beyond the data. The same applies to a relaxation time beyond the data.
    """
    flat = FLAT_SERIES if model == "prony" else FLAT_LAW
    early, late = (
        _fall(material, time, samples.dynamic, flat)
        for time in (samples.first_time, samples.last_time)
    )
    values = {one.name: one.value for one in parameters}
    last = parameters[-1].term
    errors = {one.label: one.error for one in parameters}
    found = []
    for one in parameters:
        unseen, hidden = "", ""
        if one.term:
            error = errors[f"moduli({one.term})"]
            if one.term == 1 and early > error:
                unseen = "earlier"
            if one.term == last and late > error:
                unseen = "later"
            modulus, tau = (two.value for two in parameters if two.term == one.term)
            if not error < modulus or not errors[f"times({one.term})"] < tau:
                hidden = "not determined by the data"
            elif not samples.first_time <= tau <= samples.last_time:
                hidden = f"{'before' if tau < samples.first_time else 'after'} the data"
        elif one.name == "equilibrium_modulus":
            unseen = "later" if late > one.error else ""
        elif one.name == "alpha":
            # the rubbery modulus is glassy_modulus*alpha/beta
            limit = values["glassy_modulus"] * one.error / values["beta"]
            unseen = "later" if late > limit else ""
        elif one.name in ("glassy_modulus", "relaxing_modulus"):
            unseen = "earlier" if early > one.error else ""
        elif model in LAWS and one.name == LAWS[model].time:
            time = one.value ** (1 / LAWS[model].power)
            if time < samples.first_time:
                unseen = "earlier"
            if time > samples.last_time:
                unseen = "later"
        found.append(replace(one, unseen=unseen if one.state == "free" else "", hidden=hidden))
    return found


def _fall(material: Material, time: float, dynamic: bool, flat: float) -> float:
    """Fall of the modulus in one decade, by its slope; 0 if it is flat."""
    step = 1e-3
    times = time * np.exp([-step, step])
    moduli = moduli_at(material, 1 / times if dynamic else times, dynamic)[0]
    change = math.log(10) * (moduli[0] - moduli[1]) / (2 * step)
    return float(change) if change > flat * moduli[1] else 0.0
