"""Identification of parameters from measured impacts, records of force and moduli.

Least squares of (model - datum)/sigma in the logarithms of the parameters; sigma has a floor from
the digits of the data and the errors of the solution. What the data do not determine is said
instead of a number.
"""

from __future__ import annotations

import argparse
import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import chdtri, ndtri

from .. import _command, _library
from .._differences import slopes
from .._library import MOST_SEED, Error, Floats, NumericalError, UsageError, whole
from .._outputs import finish
from .._text import option
from ..arguments import listed, namelists, scalars
from ..case import Case, as_case, number, read, with_material
from ..progress import progress_bar
from .advice import next_measurement, not_determined, probe, product
from .data import Columns, Units, add_data_options, columns_option
from .fit import fit
from .identification_exact import Corrected, corrected, is_exact
from .identification_report import figure, report
from .identified import DATUM, Estimate, Identified, Tangent
from .limits import BESIDE, OPEN, Better, Fit, Interval
from .misfit import are_alike
from .observations import (
    Block,
    Impacts,
    Moduli,
    Record,
    Source,
    materials_of,
    observations,
    sharpen,
    velocity_of,
    window,
)
from .samples import one_thread
from .search import STEP, Problem
from .select import Where
from .tables import Choice

#: Errors of the impacts to those of the data, small since derivatives are differences of impacts,
#: and the accuracies between which they are solved
SHARP, FINEST, COARSEST = 1e-5, 1e-9, 1e-6
#: Better fits that profiles may find one after the other
BETTER = 5
#: Rise of the sum of squares that no data see: a tenth of a standard error
ALIKE = 0.01
#: Probability of a larger misfit below which the model does not follow the data
FOLLOWS = 1e-3
#: Mean square of misfits, in their errors, below which rounding and the solution explain them
UNSEEN = 0.5
#: Velocities of the band of a prediction, and of how many of them one is solved exactly
BAND, BAND_STEP = 41, 4
#: Keys of a material that stay with another model
KEPT = ("name", "density", "poisson_ratio", "shift", "shift_file", "reference_temperature",
        "wlf_c1", "wlf_c2", "activation_energy", "vertical_shift", "valid_temperature_from",
        "valid_temperature_to")  # fmt: skip


class Identification(Identified):
    """Parameters identified from data, with their errors.

    `str` gives the report that the command prints.
    """

    def __str__(self) -> str:
        return report(self)

    def figure(self) -> Any:
        """Figure (matplotlib): data, model with the band of cor, and residuals below."""
        return figure(self)


def identify(
    case: Case | str | os.PathLike[str],
    data: Source | Sequence[Source],
    free: Sequence[str],
    *,
    fix: Mapping[str, float] | None = None,
    errors: Mapping[str, float] | None = None,
    model: str | None = None,
    seed: int = 1,
    columns: Columns = None,
    units: Units = None,
    where: Where = None,
) -> Identification:
    """Identify parameters of a case from measured data, as `vcor identify` does.

    Parameters
    ----------
    case
        The case; the values of the free parameters are a first guess.
    data
        Files, or columns in SI units (a mapping or a DataFrame). Impacts have a row: `velocity` or
        `drop_height`, `temperature`, `radius`, `mass` or any address, and measured columns of the
        summary, such as `cor`, `cor_sphere`, `resilience`, `rebound_height`, `contact_time`,
        `max_force`; `bounce_time` are the times in flight of one sequence of bounces. `time` and
        `force` are a record of an impact, or of the bounces of a ball, which are split; `time` and
        `relaxation_modulus`, or `frequency`, `storage_modulus` and `loss_modulus`, are moduli of
        the material that is free. NAME_sigma is the standard error of a column. Without errors all
        data have the same relative one. The rounding of the data and the errors of the solution are
        added.
    free
        Addresses of the parameters, all > 0; of a material with `model` they may be empty.
    fix
        Values at addresses that are given.
    errors
        Relative standard errors by column, where the data have none.
    model
        Another model for the material, `prony:2` for two terms; all its parameters are free.
    seed
        Seed of the starts.
    columns, units
        Which columns of files are what, and their units, as for `vcor.read_data`. A text counts in
        the files that have such a head.
    where
        Which rows of files are taken, as for `vcor.read_data`; a condition counts in the files that
        have such a column.

    Returns
    -------
    Identification
        Values, intervals, and what the data do not determine.

    Raises
    ------
    InputError
        The data cannot be used.
    NumericalError
        The data do not determine the parameters; the message names the combinations that they do
        determine, and what would help.
    """
    case = as_case(case).copy()
    free = free.split(",") if isinstance(free, str) else listed(free)
    for address in free:
        if b"solver." in _library.encoded(address).lower():
            raise UsageError(f"{address}: found a setting of the solver, expected a parameter")
    fix = scalars(fix)
    for address, value in fix.items():
        case[address] = value
    alone: Any = [data] if hasattr(data, "keys") else listed(data)
    # a DataFrame is not a Mapping
    sources = [dict(one.items()) if hasattr(one, "keys") else one for one in alone]
    choice = Choice(columns, units, sum(not isinstance(one, dict) for one in sources), where)
    if not sources:
        raise UsageError("expected at least one file or table of data")
    free = [address for address in free if address not in fix]
    if model:
        read = [block for one in sources for block in observations(case, one, free, choice)]
        case, free = _with_model(case, free, model, fix, read)
    if not free:
        also = f" that {option('fix')} does not give, found {', '.join(fix)}" if fix else ""
        raise UsageError(f"expected at least one free parameter{also}")
    whole(seed, option("seed"), 0, MOST_SEED)
    if len(set(free)) < len(free):
        raise UsageError("a free parameter is named twice")
    blocks = [block for one in sources for block in observations(case, one, free, choice)]
    choice.refuse_unseen("the files have")
    # the accuracy that the fit needs is not one of the case
    given = case.copy()
    if case["solver.method"] != "direct":
        sharpen(case, _deserved(blocks, scalars(errors)))
    with progress_bar(None, None) as bar, one_thread():
        problem = Problem(case, free, blocks, scalars(errors), bar)
        start = corrected(problem, seed) if case._has_mesh else None
        best, limits = _determined(problem, *(start or problem.best(seed)))
        return _result(problem, best, limits, model or "", given)


def _deserved(blocks: Sequence[Block], errors: Mapping[str, float]) -> float:
    """Accuracy of the impacts that data deserve, by their stated errors and their digits."""
    least = math.inf
    for block in blocks:
        stated = np.array([errors.get(name, 0.0) for name in block.quantity]) * block.scale
        stated = np.where(np.isnan(block.sigma), stated, block.sigma)
        digits = np.nan_to_num(block.digit) / math.sqrt(12)
        known = np.hypot(stated, digits)[block.scale > 0] / block.scale[block.scale > 0]
        least = min(least, float(known.min(initial=math.inf)))
    return min(max(SHARP * least, FINEST), COARSEST)


def _determined(problem: Problem, x: Floats, chi2: float) -> tuple[Fit, list[list[Interval]]]:
    """The best fit and the intervals of all parameters; refused if the data do not limit one."""
    better = meetings = 0
    limits: list[list[Interval]] = []
    while better < BETTER:
        best = _beside_guess(Fit(problem, x, chi2, *problem.derivatives(x), limits))
        try:
            if (free := best.free()) is not None:
                raise NumericalError(not_determined(problem, x, best.lost(free)))
            limits = [best.intervals(i) for i in range(len(x))]
        except Better as found:
            better += 1
            x, chi2 = problem.settle(found.x)
            continue
        meetings += 1
        if is_exact(best, limits, meetings):
            return best, limits
        x, chi2 = problem.settle(best.x)
    raise NumericalError(f"{problem.case.name}: the sum of squares has many minima, and the best "
                         "of them was not found: give a guess that is closer")  # fmt: skip


def _beside_guess(best: Fit) -> Fit:
    """A fit that is as good with a doubtful parameter at its first guess, or the same.

    A search that follows no slope may have ended anywhere, such as at a reference temperature so
    high that nothing depends on it any more. From there data seem to limit what they do not.
    """
    problem = best.problem
    for i in best.doubtful():
        start = best.x.copy()
        start[i] = problem.guess[i]
        x, chi2 = problem.minimize(start, [j for j in range(len(start)) if j != i])
        if chi2 < best.chi2 + ALIKE:
            return Fit(problem, x, chi2, *problem.derivatives(x))
    return best


def _result(
    problem: Problem, best: Fit, limits: list[list[Interval]], model: str, given: Case
) -> Identification:
    """Results of a fit, with the given case completed by the values found."""
    x, chi2, derivatives = best.x, best.chi2, best.slopes
    case, free, dof = problem.case, problem.free, problem.dof
    predicted = problem.predict(x[None])[0]
    taken = tuple(b.said() if isinstance(b, Record) else b.taken for b in problem.blocks)
    eigenvalues, vectors = np.linalg.eigh(derivatives.T @ derivatives)
    covariance = best.covariance()
    for address, value in zip(free, np.exp(x), strict=True):
        case[address] = given[address] = float(value)
    ends = np.minimum(x - problem.low, problem.high - x)
    estimates = tuple(
        _estimate(case, address, float(x[i]), float(covariance[i, i]), limits[i], ends[i] < BESIDE)
        for i, address in enumerate(free)
    )
    n, k = len(problem.value), len(x) + int(problem.noise.estimated)
    likelihood = problem.likelihood(x)
    materials = materials_of(free)
    sources = [block.source for block in problem.blocks for _ in block.quantity]
    at, kelvin = (
        np.concatenate([getattr(block, name) for block in problem.blocks])
        for name in ("at", "temperature")
    )
    kelvin = np.where(np.isnan(kelvin), number(case, "impact.temperature"), kelvin)
    columns = at, kelvin, problem.value, problem.sigma, predicted, problem.residuals(x)
    rows = tuple(
        dict(zip(DATUM, (source, name, *row), strict=True))
        for source, name, row in zip(
            sources, problem.quantity, np.stack(columns, axis=1).tolist(), strict=True
        )
    )
    order = np.argsort(-eigenvalues)
    return Identification(
        case=given,
        estimates=estimates,
        covariance=covariance,
        chi2=chi2,
        dof=dof,
        taken=tuple(filter(None, taken)),
        alike=_correlated(problem, x, derivatives),
        hertz=any(isinstance(block, Moduli) and block.hertz for block in problem.blocks),
        follows=problem.noise.estimated or chi2 <= float(chdtri(max(dof, 1), FOLLOWS)),
        relative_error=problem.noise.relative(problem.sigma) if problem.noise.estimated else None,
        combinations=tuple(
            (
                product(free, vectors[:, j]),
                eigenvalues[j] ** -0.5 if eigenvalues[j] > 1 / OPEN**2 else math.inf,
            )
            for j in order
        ),
        eigenvalues=eigenvalues[order].clip(1 / OPEN**2),
        aic=likelihood + 2 * k,
        bic=likelihood + k * math.log(n),
        data=rows,
        window=window(problem.blocks, case, materials[0] if len(materials) == 1 else ""),
        advice=next_measurement(problem, x, covariance),
        band=_band(problem, x, covariance),
        loss_tangents=tuple(_tangents(problem, x, covariance)),
        model=model,
        validity=_validity(problem, case),
        **_of_correction(problem.corrected),
    )


def _of_correction(made: Any) -> dict[str, Any]:
    """Fields of a result by corrected impacts: their number, and the error of the correction."""
    if not isinstance(made, Corrected):
        return {}
    return {"solved": made.solved, "fresh": made.fresh, "correction": made.error}


def _correlated(problem: Problem, x: Floats, derivatives: Floats) -> tuple[str, ...]:
    """Files of records and moduli whose neighbouring misfits are too correlated for noise."""
    r, found, first = problem.residuals(x), [], 0
    predicted = problem.predict(x[None])[0] / problem.sigma
    for block in problem.blocks:
        part = slice(first, first + len(block.value))
        first = part.stop
        if isinstance(block, Impacts) or r[part] @ r[part] < UNSEEN * len(block.value):
            continue
        own = derivatives[part]
        if isinstance(block, Record):
            # the baseline and the start are fitted, too
            more = [1 / problem.sigma[part], np.gradient(predicted[part], block.at)]
            own = np.column_stack([own, *more])
        if are_alike(r[part], own, len(set(block.quantity))):
            found.append(block.source)
    return tuple(found)


def _estimate(
    case: Case, address: str, x: float, variance: float, limits: list[Interval], at_end: bool
) -> Estimate:
    """A parameter by its logarithm, the variance of that and its intervals."""
    value = math.exp(x)
    at_bound = at_end or not np.isfinite(limits[0][:2]).all()
    narrow, wide = ((math.exp(one.low), math.exp(one.high)) for one in limits)
    error = math.nan if at_bound else value * math.sqrt(variance)
    return Estimate(address, case._describe(address).unit, value, error, narrow, wide)


def _validity(problem: Problem, case: Case) -> str:
    """Where the model of the impact does not hold for measured impacts, in words."""
    found = [pair for block in problem.impacts for pair in block.validity(case)]
    words = [
        f"{kind} at {sum(one == kind for one, _ in found)} of {len(found)} impacts, by "
        + ", ".join(sorted({cause for one, cause in found if one == kind}))
        for kind in ("outside", "caution")
        if any(one == kind for one, _ in found)
    ]
    return "; ".join(words) or "good"


def _band(problem: Problem, x: Floats, covariance: Floats) -> dict[str, list[float]]:
    """Prediction of cor, or cor_sphere, against velocity with its 95 % band."""
    grid = np.geomspace(problem.speeds.min() / 2, problem.speeds.max() * 2, BAND)
    name = "cor_sphere" if {"cor", "cor_sphere"} & {*problem.quantity} == {"cor_sphere"} else "cor"
    trial = probe(problem.case, grid, name)

    def cor(steps: Floats) -> Floats:
        """Coefficients at the velocities of the grid, shape (points, grid), for steps from x."""
        return trial.predict(problem.quick, problem.free, np.exp(x + steps), np.exp(x))

    slope = slopes(cor, len(x), STEP)
    deviation = np.sqrt(np.einsum("ij,jk,ik->i", slope, covariance, slope))
    middle, half = cor(np.zeros((1, len(x))))[0], float(ndtri(0.975)) * deviation
    if problem.corrected:
        # thin mechanics have the width in parts of the coefficient, exact ones change it smoothly
        some = grid[::BAND_STEP]
        exact = probe(problem.case, some, name).predict(problem.case, problem.free, np.exp(x)[None])
        ratio = exact[0] / middle[::BAND_STEP]
        if np.isfinite(ratio).all():
            ratio = CubicSpline(np.log(some), ratio)(np.log(grid))
        else:
            ratio = trial.predict(problem.case, problem.free, np.exp(x)[None])[0] / middle
        middle, half = middle * ratio, half * ratio
    columns = {"velocity": grid, name: middle, "low": middle - half, "high": middle + half}
    good = np.isfinite(middle)
    return {name: column[good].tolist() for name, column in columns.items()}


def _tangents(problem: Problem, x: Floats, covariance: Floats) -> Iterator[Tangent]:
    """Loss tangents at pi/t0: at each temperature of the impact of median velocity."""
    case, free = problem.case, problem.free
    own = np.array([velocity_of(case)])
    impacts = problem.impacts or [probe(case, own)]
    rows: dict[str, list[tuple[float, float, Impacts, int]]] = {}
    for block in impacts:
        kelvin = block.settings.get(
            "impact.temperature", np.full(len(block.velocity), number(case, "impact.temperature"))
        )
        for i, (velocity, at) in enumerate(zip(block.velocity, kelvin, strict=True)):
            rows.setdefault(str(at), []).append((float(velocity), float(at), block, i))
    for some in rows.values():
        velocity, at, block, i = sorted(some, key=lambda one: one[0])[len(some) // 2]

        def results(
            steps: Floats, model: Case = problem.quick, block: Impacts = block, i: int = i
        ) -> Floats:
            """Loss tangent and contact time of one impact, shape (points, 2), for steps from x."""
            values, names = np.exp(x + steps), ["peak_loss_tangent", "contact_time"]
            found = block.quantities(model, free, values, names, np.array([i]), np.exp(x))
            return found[:, 0]

        tangent, time = results(np.zeros((1, len(x))), case)[0]
        if not np.isfinite(tangent):
            continue
        slope = slopes(results, len(x), STEP)[0]
        error = math.sqrt(max(float(slope @ covariance @ slope), 0.0))
        yield Tangent(velocity, at, math.pi / float(time), float(tangent), error)


def _with_model(
    case: Case, free: Sequence[str], model: str, fix: Mapping[str, float], blocks: Sequence[Block]
) -> tuple[Case, list[str]]:
    """The case with another model for the material of the free parameters, all of it free."""
    names = materials_of(free)
    if len(names) != 1 or not all(address.startswith(f"{names[0]}.") for address in free):
        raise UsageError(f"{option('model')}: the free parameters must be those of one material")
    name = names[0]
    kind, _, terms = str(model).partition(":")
    if not re.fullmatch(r"prony:0*[1-9]\d?|[^:]*", str(model)):
        raise UsageError(
            f"{option('model', model)}: expected the name of a model, or such as prony:2"
        )
    first, last = window(blocks, case, name)
    times = np.geomspace(first, last, 60)
    reference = case.copy()
    if case[f"{name}.shift"] is not None:
        reference["impact.temperature"] = number(case, f"{name}.reference_temperature")
    moduli = reference.material(name).relaxation(times)
    keys: dict[str, list[float]] = {}
    if kind == "prony":
        # equal moduli and times that are apart, also where one term would do
        n = int(terms or 1)
        keys["equilibrium_modulus"] = [moduli[-1]]
        keys["moduli"] = [(moduli[0] - moduli[-1]) / n] * n
        keys["times"] = list(np.geomspace(first, last, n + 2)[1:-1])
    else:
        for one in fit((times, moduli), model=kind, name=name).parameters:
            keys[one.name] = [one.value]

    kept = {key: case[f"{name}.{key}"] for key in KEPT}
    group = {"model": kind, **{key: x for key, x in kept.items() if x is not None}, **keys}
    changed = with_material(case, name, namelists({"material": group}))
    addresses = [
        f"{name}.{key}({i + 1})" if key in ("moduli", "times") else f"{name}.{key}"
        for key, row in keys.items()
        for i, x in enumerate(row)
        if x > 0
    ]
    addresses += [address for address in free if address.rpartition(".")[2] in KEPT]
    for address in fix:
        if address in addresses:
            changed[address] = float(fix[address])
            addresses.remove(address)
    return changed, addresses


def _pairs(words: Sequence[str], option: str) -> dict[str, float]:
    """NAME=NUMBER of an option, percent as a fraction."""
    found = {}
    for word in words:
        name, _, text = word.partition("=")
        try:
            found[name] = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            raise UsageError(f"{option} {word}: expected NAME=NUMBER") from None
    return found


def _parser() -> _command.Parser:
    """Options of `vcor identify`."""
    parser = _command.Parser(
        "identify",
        description="Identify parameters of a case from measured impacts (a row each: velocity or "
        "drop_height, and cor, contact_time ...), records of time and force, and moduli. Writes "
        "the case, JSON and a figure.",
    )
    parser.add_outputs()
    add = parser.add_argument
    add("case", metavar="CASE.nml", help="case; its values are the first guess")
    data = "data files with a header, and files of materials (.nml) that the case needs"
    add("data", nargs="+", metavar="DATA", help=data)
    add("--free", metavar="ADDRESS,ADDRESS", help="parameters to be identified")
    add("--fix", metavar="ADDRESS=VALUE", action="append", default=[], help="a value that is given")
    error = "relative error of a column that has none, such as cor=1%%"
    add("--error", dest="errors", metavar="NAME=VALUE", action="append", default=[], help=error)
    model = "another model of the material, such as sls or prony:2; several are compared"
    add("--model", metavar="NAME,NAME", action="append", default=[], help=model)
    add("--seed", metavar="N", type=int, default=1, help="seed of the starts; default: 1")
    add_data_options(parser)
    return parser


def _work(options: argparse.Namespace) -> None:
    """Run the command `vcor identify`: report, figure and files of what is identified.

    Of several models the one with the least AIC is written, and all are compared.
    Raises UsageError without free parameters, and NumericalError if no model has a result.
    """
    if options.free is None:
        raise UsageError("expected --free ADDRESS,ADDRESS, the parameters to be identified")
    free = [word.strip() for word in options.free.split(",") if word.strip()]
    fix, errors = _pairs(options.fix, "--fix"), _pairs(options.errors, "--error")
    found: list[Identification] = []
    refused: list[Error] = []
    models = [word.strip() for words in options.model for word in words.split(",")]
    case = read(options.case, *(name for name in options.data if name.endswith(".nml")))
    data = [name for name in options.data if not name.endswith(".nml")]
    said: dict[str, Any] = {"columns": columns_option(options.columns), "units": options.units,
                            "where": options.where}  # fmt: skip
    for model in models or [None]:
        try:
            found.append(
                identify(case, data, free, fix=fix, errors=errors, model=model, seed=options.seed,
                         **said)
            )  # fmt: skip
        except NumericalError as error:
            refused.append(error)
    if not found:
        raise refused[0]
    best = min(found, key=lambda one: one.aic)
    report, written = str(best), best.as_dict()
    if len(models) > 1:
        order = sorted(found, key=lambda one: one.aic)
        keys = ("model", "chi2", "aic", "bic")
        written["models"] = [{key: getattr(one, key) for key in keys} for one in order]
        report += f"\n{'model':16s}{'parameters':>11s}{'chi2':>12s}{'AIC':>10s}{'BIC':>10s}\n"
        for one in order:
            report += f"{one.model:16s}{len(one.estimates):11d}{one.chi2:12.4g}"
            report += f"{one.aic:10.1f}{one.bic:10.1f}\n"
        report += "".join(f"no result: {error}\n" for error in refused)
    texts = {".nml": best.case.text(), ".json": written}
    stem = f"{Path(options.case).stem}_identified"

    # a single datum needs no figure
    finish(options, report, stem, texts, best.figure() if len(best.data) > 1 else None)
