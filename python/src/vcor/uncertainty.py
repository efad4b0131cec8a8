"""Sensitivities, and uncertainty of results from that of their parameters."""

from __future__ import annotations

import contextlib
import json
import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.special import ndtri

from . import _library, _text
from ._coverage import unwarned
from ._differences import slopes
from ._library import (
    MOST_SEED,
    Error,
    Floats,
    InputError,
    NumericalError,
    UsageError,
    numbers,
    whole,
    within,
)
from ._text import option
from .arguments import MOST_POINTS, listed
from .case import Case, as_case, number, with_material
from .materials.advice import percent, product
from .materials.limits import UNDETERMINED
from .materials.observations import sharpen
from .uncertainty_samples import Plan, Sampled, sampled

#: Accuracy of the solutions whose differences are sensitivities
ACCURACY = 1e-11
#: Step of the logarithms for differences of fourth order: errors 1e-9 of the step and the solution
STEP = 5e-3
#: Quantities that are shown if none are asked for
USUAL = ("cor", "cor_sphere", "contact_time", "max_force", "max_indentation",
         "residual_indentation", "hysteresis_energy", "wave_energy")  # fmt: skip
#: Those of a plate with waves = 'body', whose loss has no parts
USUAL_BODY = (*USUAL[:-2], "energy_loss")
#: Percentiles that are given
PERCENTILES = (2.5, 16.0, 50.0, 84.0, 97.5)
#: Share of the samples that may have no result: more, and the others no longer stand for all
MOST_LOST = 0.1
#: Bootstrap samples for the errors of Sobol' indices
RESAMPLES = 40
#: Sobol' indices and their errors, as SALib names them
INDICES = {"first": "S1", "first_error": "S1_conf", "total": "ST", "total_error": "ST_conf"}
#: Columns of the impact itself that are reported beside the quantities
JUDGED = ("validity", "validity_cause", "contact_time", "cor_error", "cor_sphere_error",
          "contact_time_error", "max_force_error")  # fmt: skip
#: Settings of the exact linear theory
EXACT = {"contact.law": "receding", "contact.pair": "series", "solver.method": "auto",
         "plate.waves": "body"}  # fmt: skip


@dataclass(frozen=True)
class Spread:
    """How a parameter is distributed, or several that depend on each other."""

    name: str
    addresses: list[str]
    #: Values at standardised coordinates, independent and of variance 1, shape (points, addresses)
    place: Callable[[Floats], Floats]
    #: Coordinates of one deviation upwards, shape (quantities, addresses), by how quantities follow
    #: the parameters, of the same shape; downwards they have the other sign
    end: Callable[[Floats], Floats]
    #: Whether the coordinates are uniform, else normal
    uniform: bool = False
    #: Coordinate of the value of the case
    middle: float = 0.0

    def standardised(self, share: Floats) -> Floats:
        """Coordinates at shares 0 < u < 1 of the distributions."""
        made: Floats = math.sqrt(12) * (share - 0.5) if self.uniform else ndtri(share)
        return made

    @classmethod
    def read(cls, case: Case, address: str, text: str | float) -> Spread:
        """Distribution of a parameter as `vary={address: text}` has it.

        `5%` is the standard deviation of its logarithm (log-normal), `0.1` one in its own unit
        (normal), `A:B` a uniform distribution from A to B; a number is as with `%`, at most 1. A
        normal distribution of which one deviation below the value is impossible is refused.
        """
        given = case[address]
        if given is None:
            raise UsageError(f"{address}: the case does not give it, expected a number that it "
                             "gives")  # fmt: skip
        if not isinstance(given, (int, float)):
            one = f"one of them, such as {address}(1)" if isinstance(given, list) else "a number"
            raise UsageError(f"{address}: found {given}, expected {one}")
        value = float(given)
        forms = "5%, 0.1 (in its unit) or 1:2, larger than 0"
        if not _text.OPTIONS.get():
            forms = "0.05 or '5%', '0.1' (in its unit) or '1:2', larger than 0"
        refusal = UsageError(f"{address}={text!s:.60}: expected such as {forms}")
        if not isinstance(text, str):
            if isinstance(text, bool) or not isinstance(text, Real):
                raise refusal
            part = within(text, address, 0, math.inf)
            if part > 1:
                raise UsageError(f"{address}: found {part:g}, {100 * part:g} % of the value, "
                                 f"expected at most 1; {part:g} % is {part / 100:g} or "
                                 f"'{part:g}%'")  # fmt: skip
            text = f"{100 * part}%"

        def spread(place: Callable[[Floats], Floats], *of_uniform: Any) -> Spread:
            """A spread of one parameter by a distribution."""
            return cls(address, [address], place, np.ones_like, *of_uniform)

        made = None
        with contextlib.suppress(ValueError):
            if ":" in text:
                low, high = (float(end) for end in text.split(":"))
                if low < high:
                    mean, deviation = (low + high) / 2, (high - low) / math.sqrt(12)
                    middle = (value - mean) / deviation
                    return spread(lambda z: mean + deviation * z, True, middle)
            elif text.endswith("%"):
                relative = float(text[:-1]) / 100
                if relative > 0 and value > 0:
                    return spread(lambda z: value * np.exp(relative * z))
            elif (deviation := float(text)) > 0:
                made = spread(lambda z: value + deviation * z)
        if made:
            _check_deviation(case, address, value, deviation, text)
            return made
        raise refusal

    @classmethod
    def joint(cls, case: Case, source: Any) -> tuple[Case, Spread]:
        """Parameters with a covariance, by the JSON of a fit, and the case with what was found."""
        fit = _Fit.read(source)
        values, covariance = fit.values, fit.covariance
        # what a fit has brought to 0 stays there: it has no logarithm
        kept = np.flatnonzero((np.diag(covariance) > 0) & (values > 0))
        if not kept.size:
            raise InputError(
                f"{option('covariance')}: found no parameter > 0 with a standard error"
            )
        # each factor in turn: their product may underflow
        with np.errstate(over="ignore"):
            scaled = covariance[np.ix_(kept, kept)] / values[kept] / values[kept, None]
        if (large := ~np.isfinite(scaled).all(axis=0)).any():
            raise InputError(f"{option('covariance')}: found a standard error that is too large "
                             f"for the value of {fit.addresses[kept[large][0]]}")  # fmt: skip
        weights, vectors = np.linalg.eigh((scaled + scaled.T) / 2)
        if weights.min() < -1e-8 * weights.max():
            raise InputError(f"{option('covariance')}: the matrix is not positive")
        if weights[-1] > UNDETERMINED**2:
            names = [fit.addresses[i] for i in kept]
            raise NumericalError(
                f"{option('covariance')}: the fit does not determine "
                f"{product(names, vectors[:, -1])}, which has a standard error of "
                f"{percent(math.sqrt(weights[-1]))}: fix a parameter of it in the fit, "
                f"and give that with {option('vary', {'ADDRESS': 'LOW:HIGH'})}"
            )
        if fit.note:
            warnings.warn(f"{option('covariance')}: {fit.note}", stacklevel=3)
        if fit.group:
            case = _with_group(case, fit)
        for i in kept:
            case[fit.addresses[i]] = float(values[i])
        values, root = values[kept], vectors * np.sqrt(weights.clip(0))

        def end(elastic: Floats) -> Floats:
            """Directions of one deviation for each quantity, shape (quantities, coordinates)."""
            # they move together, as they do where the quantity is off by one deviation
            pull: Floats = elastic @ root
            pull /= np.fmax(np.linalg.norm(pull, axis=1, keepdims=True), 1e-300)
            return pull

        return case, cls("covariance", [fit.addresses[i] for i in kept],
                         lambda z: values * np.exp(z @ root.T), end)  # fmt: skip


def _check_deviation(case: Case, address: str, value: float, deviation: float, text: str) -> None:
    """Refuse a deviation by which the value becomes one that it cannot have."""
    try:
        case.copy()[address] = value - deviation
    except InputError as error:
        unit = f" {one}" if (one := case._describe(address).unit) != "1" else ""
        raise UsageError(
            f"{address}={text}: found a standard deviation of {text}{unit} of {value:g}{unit}, "
            f"by which it becomes impossible ({error}); {text} % is {text}%"
        ) from None


@dataclass(frozen=True)
class _Fit:
    """Parameters from JSON of vcor fit or identify: nothing of it is taken unchecked."""

    path: str
    #: Name of the material, empty if the addresses have it
    name: str
    addresses: list[str]
    values: Floats
    covariance: Floats
    #: Group &material and a remark, empty if there is none
    group: str
    note: str

    @classmethod
    def read(cls, source: Any) -> _Fit:
        """The parameters of a file or of its contents."""
        path, named = "", option("covariance")
        if not isinstance(source, Mapping):
            path = os.fspath(source)
            named += f" {path}"
            try:
                source = json.loads(_text.read_text(path, "strict"))
            except (ValueError, RecursionError):
                source = None
        wrong = InputError(f"{named}: found no JSON of vcor fit or identify")
        if not isinstance(source, Mapping) or not isinstance(source.get("parameters"), list):
            raise wrong
        name, group, note = (source.get(key) or "" for key in ("name", "group", "note"))
        rows = source["parameters"]
        if not all(isinstance(one, str) for one in (name, group, note)):
            raise InputError(f"{named}: expected texts as name, group and note")
        addresses = []
        for row in rows:
            if not isinstance(row, Mapping) or not isinstance(row.get("name"), str):
                raise InputError(f"{named}: found a parameter without a name")
            addresses.append(row["name"] if "." in row["name"] else f"{name}.{row['name']}")
            if row.get("standard_error", 0) is None:
                raise InputError(
                    f"{named}: {addresses[-1]} is at its bound, without a standard error: fix it, "
                    "identify the others, and take its interval with "
                    + option("vary", {addresses[-1]: "LOW:HIGH"})
                )
        n = len(rows)
        try:
            values = numbers([row["value"] for row in rows], "value")
            covariance = numbers(source["covariance"], "covariance", 2)
        except (KeyError, InputError):
            raise wrong from None
        if covariance.shape != (n, n) or not np.isfinite(covariance).all():
            raise InputError(f"{named}: expected a covariance of {n} x {n} finite numbers")
        if not np.isfinite(values).all():
            raise InputError(f"{named}: expected finite values of the parameters")
        size = np.sqrt(np.abs(np.diag(covariance)))
        if (np.abs(covariance - covariance.T) > 1e-6 * np.outer(size, size)).any():
            raise InputError(f"{named}: the covariance is not symmetrical")
        return cls(path, name, addresses, values, covariance, group, note)


@dataclass(frozen=True)
class Uncertainty:
    """Results of an impact with their errors; `str` is the report of the command."""

    #: Over `quantity`: value, that of the exact mechanics, numerical, material and model error, nan
    #: if not known, percentiles, and correction, the error of a sample by corrected thin mechanics
    #: as part of the standard deviation, 0 if all samples were solved;
    #: over `parameter` too: elasticity; over `source`, a parameter or the covariance as one: first
    #: and total Sobol' index, their 95 % half widths, and swing, the ends of one deviation
    table: xr.Dataset
    #: Samples, and how many of them have no result
    samples: int
    lost: int
    dominant: str
    #: Whether the model holds, and the column of the summary that decides
    validity: str
    validity_cause: str
    #: Parts of the impact beyond the data of its materials, in words; empty if there are none
    beyond: str = ""
    #: Impacts that were solved with the mechanics of the case for the samples, all of them or those
    #: that a correction of thin mechanics was fitted to and tested with, and how many of these were
    #: not fitted to: the error of its samples is `correction` of the table
    solved: int = 0
    fresh: int = 0

    def __str__(self) -> str:
        return _report(self)

    @property
    def quantities(self) -> list[str]:
        """Names of the quantities."""
        return [str(name) for name in self.table.quantity.values]

    def as_dict(self) -> dict[str, Any]:
        """All results as they are written to JSON."""
        table = self.table
        return _text.document(
            samples=self.samples,
            without_result=self.lost,
            solved=self.solved,
            fresh=self.fresh,
            validity=self.validity,
            validity_cause=self.validity_cause,
            beyond=self.beyond,
            quantities={
                name: {
                    "unit": row.units.item(),
                    **{key: _by_name(row[key]) for key in table.data_vars},
                }
                for name, row in ((one, table.sel(quantity=one)) for one in self.quantities)
            },
        )

    def figure(self, quantity: str = "cor") -> Any:
        """Tornado figure (matplotlib) of a quantity: its change by one standard deviation."""
        from .plot import COLUMN, _labelled, _name_of, drawn

        if quantity not in self.quantities:
            raise UsageError(f"found no quantity '{quantity}', expected one of "
                             f"{', '.join(self.quantities)}")  # fmt: skip
        row = self.table.sel(quantity=quantity)
        below, above = (row["swing"].sel(side=side).values for side in ("below", "above"))
        order = np.argsort(np.abs(above - below))
        with drawn(COLUMN, 2.5 + 0.6 * len(order)) as (made, axis):
            joint = f"{row.parameter.size - row.source.size + 1} parameters together"
            # a dollar in the name of a material begins no formula
            names = [_name_of(str(name)).replace("$", r"\$") if "." in str(name) else joint
                     for name in row.source.values[order]]  # fmt: skip
            attrs = _library.columns(0)[quantity].attrs
            factor, label = _labelled(quantity, attrs, row["value"].values)
            for color, side, text in (
                ("0.75", below[order], "− one standard deviation"),
                ("C1", above[order], "+ one"),
            ):
                start = factor * float(row["value"])
                axis.barh(names, factor * side - start, left=start, label=text, color=color)
            axis.axvline(start, color="black", lw=0.8, marker="")
            axis.set_xlabel(label)
            axis.tick_params(axis="y", length=0)
            axis.tick_params(axis="x", top=False)
            axis.locator_params(axis="x", nbins=4)
            # where Matplotlib 3.6 can have it, too
            axis.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=2)
        return made


def sensitivities(
    case: Case | str | os.PathLike[str],
    parameters: Sequence[str],
    quantities: Sequence[str] = USUAL,
) -> xr.DataArray:
    """Elasticities d ln q/d ln p of results, by differences of solutions at 1e-11.

    With waves = 'body' the solutions are at the accuracy of the case on one mesh, on which they
    follow the parameters to 1e-6: elasticities of cor_sphere are within some 1e-4. At the end of a
    parameter's range the differences are one-sided.

    Parameters
    ----------
    case
        The case, an impact.
    parameters
        Addresses of numbers other than 0.
    quantities
        Columns of the summary.

    Returns
    -------
    xarray.DataArray
        Elasticity [1] over `quantity` and `parameter`; nan where the quantity is 0.
    """
    case = _accurate(case)
    parameters, quantities = listed(parameters), _checked(case, quantities)
    if not parameters:
        raise UsageError("expected at least one parameter")
    values = np.array([_number(case, address) for address in parameters])
    near = case._settled(parameters, values) if case._has_mesh else case
    # impacts without a mesh of their own take less time than threads do
    threads = 0 if case._has_mesh else 1
    middle: Floats = near._solve(parameters, values[None], quantities, 1)[0]

    def results(steps: Floats) -> Floats:
        """Quantities, shape (points, quantities), for steps in logarithms from the middle."""
        if not steps.any():
            return middle
        return near._solve(parameters, values * np.exp(steps), quantities, threads)[0]

    slope = slopes(results, len(values), STEP)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = slope / middle.T
    return xr.DataArray(
        np.where(np.isfinite(ratio), ratio, np.nan),
        dims=("quantity", "parameter"),
        coords={"quantity": list(quantities), "parameter": list(parameters)},
        name="elasticity",
    )


def propagate(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, str | float] | None = None,
    *,
    covariance: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    samples: int = 4096,
    quantities: Sequence[str] = USUAL,
    seed: int = 1,
    threads: int | None = None,
) -> Uncertainty:
    """Uncertainty of the results of an impact, and what it comes from.

    With waves = 'body' the samples are those of thin mechanics with a correction, which is fitted
    to some hundred exact impacts; the results say its error, at most 1 % of their standard
    deviations. Where it is larger, all samples are solved.

    Parameters
    ----------
    case
        The case; its values are the middle of the distributions.
    vary
        Distribution at each address: 0.05 or "5%" of its value, "0.1" in its unit, "1:2" uniform.
    covariance
        JSON of `vcor fit` or `vcor identify`, or its content: values and covariance of parameters,
        which count as one parameter for Sobol' indices, since they depend on each other. The
        &material group of a fit takes the place of that of the case.
    samples
        Samples, about; rounded to a power of 2 times (parameters + 2).
    quantities
        Columns of the summary.
    seed
        Seed of the samples.
    threads
        As for `Case.run`.

    Returns
    -------
    Uncertainty
        Errors, percentiles, elasticities and Sobol' indices.
    """
    return _propagate(case, vary, covariance, samples, quantities, seed, threads)


def _propagate(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, str | float] | None,
    covariance: str | os.PathLike[str] | Mapping[str, Any] | None,
    samples: int,
    quantities: Sequence[str],
    seed: int,
    threads: int | None,
    corrected: bool | None = None,
) -> Uncertainty:
    """As `propagate`; `corrected` as for `uncertainty_samples.sampled`."""
    case = as_case(case).copy()
    if axes := list(case._axes()):
        raise UsageError(f"{case.name}: found a sweep over {', '.join(axes)}, expected one impact; "
                         "vcor.bands takes a sweep")  # fmt: skip
    drawn = Drawn.of(case, vary, covariance, samples, quantities, seed)
    found = sampled([drawn.plan], drawn.quantities, seed, threads, corrected)
    made = drawn.uncertainty(found, 0)
    for note in found.notes:
        warnings.warn(note.message, note.category, stacklevel=3)
    return made


@dataclass(frozen=True)
class Drawn:
    """Samples of the parameters of an impact, and the impact itself."""

    case: Case
    spreads: list[Spread]
    quantities: list[str]
    #: As SALib has it, and how many samples belong together
    problem: dict[str, Any]
    together: int
    plan: Plan
    seed: int
    #: `validity`, `validity_cause`, contact_time and the errors that are stated
    judged: Mapping[str, float | str]

    @classmethod
    def of(
        cls, case: Case, vary: Mapping[str, str | float] | None,
        covariance: str | os.PathLike[str] | Mapping[str, Any] | None, samples: int,
        quantities: Sequence[str], seed: int, swept: tuple[str, float] = ("", 0.0),
    ) -> Drawn:  # fmt: skip
        """Samples of one impact, or of a point of a sweep."""
        from SALib.sample import sobol as sampling

        names = _checked(case, quantities)
        whole(samples, "samples", 1, MOST_POINTS)
        whole(seed, "seed", 0, MOST_SEED)
        if vary is not None and not hasattr(vary, "items"):
            raise UsageError("vary: expected a distribution by each address")
        joint = []
        if covariance is not None:
            case, found_together = Spread.joint(case, covariance)
            joint = [found_together]
        wanted = {} if vary is None else dict(vary.items())
        spreads = [Spread.read(case, address, text) for address, text in wanted.items()] + joint
        addresses = [address for spread in spreads for address in spread.addresses]
        if not addresses:
            raise UsageError("expected at least one parameter that varies")
        if len(set(addresses)) < len(addresses):
            raise UsageError("a parameter varies twice")
        groups = [spread.name for spread in spreads for _ in spread.addresses]
        # SALib counts groups; without joint parameters every parameter is its own
        problem = {"num_vars": len(addresses), "names": addresses,
                   "bounds": [[0.0, 1.0]] * len(addresses), "groups": groups}  # fmt: skip
        blocks = 2 ** max(3, round(math.log2(max(8, samples / (len(spreads) + 2)))))
        share = sampling.sample(problem, blocks, calc_second_order=False, seed=seed)
        share = np.clip(share, 1e-12, 1 - 1e-12)
        own = [slice(groups.index(one.name), groups.index(one.name) + len(one.addresses))
               for one in spreads]  # fmt: skip

        def place(z: Floats) -> Floats:
            """Values of all parameters, shape (samples, parameters), at standard coordinates."""
            parts = zip(spreads, own, strict=True)
            return np.hstack([one.place(z[:, part]) for one, part in parts])

        z = np.hstack([one.standardised(share[:, part])
                       for one, part in zip(spreads, own, strict=True)])  # fmt: skip
        uniform = [spread.uniform for spread in spreads for _ in spread.addresses]
        with unwarned():
            middle = case.solve(quantities=[*dict.fromkeys([*names, *JUDGED])])
        values = np.array([middle[name] for name in names], dtype=float)
        if lacking := [name for name, x in zip(names, values, strict=True) if np.isnan(x)]:
            raise NumericalError(f"{case.name}: this impact has no {', '.join(lacking)}, expected "
                                 f"quantities that it has ({option('quantities')})")  # fmt: skip
        plan = Plan(case, addresses, z, place, uniform, *swept, values)
        return cls(case, spreads, names, problem, len(share) // blocks, plan, seed,
                   middle)  # fmt: skip

    def uncertainty(self, sampled: Sampled, i: int) -> Uncertainty:
        """Results with their errors, by those of the samples of plan i."""
        case, quantities, addresses = self.case, self.quantities, self.plan.addresses
        found, names = sampled.found[i], [spread.name for spread in self.spreads]
        good = np.isfinite(found).all(axis=1).reshape(-1, self.together)
        kept = good.all(axis=1)
        if kept.sum() < 8 or (~good).sum() > MOST_LOST * good.size:
            raise NumericalError(
                f"{case.name}: {(~good).sum()} of {good.size} samples have no result, "
                f"{self._first_failure(~good.ravel())}; expected "
                f"{100 * MOST_LOST:g} % at most: {option('vary', {'ADDRESS': 'LOW:HIGH'})} has ends"
            )
        values = found.reshape(-1, self.together, len(quantities))[kept]
        sobol = _sobol(self.problem, values.reshape(-1, len(quantities)), names, self.seed)
        value = self.plan.middle
        # with waves = 'body' what is not stated is not known
        better = np.full(len(value), np.nan)
        if case["plate.waves"] != "body":
            better = _values(_accurate(case), quantities)
        stated = [float(self.judged.get(f"{name}_error", np.nan)) for name in quantities]
        numerical = np.fmax(np.abs(value - better), stated)
        shown = found[np.isfinite(found).all(axis=1)]
        elastic = np.full((len(quantities), len(addresses)), np.nan)
        apart = [k for k, address in enumerate(addresses) if case[address] != 0]
        if apart:
            elastic[:, apart] = sensitivities(case, [addresses[k] for k in apart], quantities)
        pull = np.nan_to_num(elastic) * np.sign(value)[:, None]
        exact = value if case["plate.waves"] == "body" else _exact(case, quantities)
        over, both = ("quantity",), ("quantity", "parameter")
        of_sample = np.zeros(len(value)) if sampled.error is None else sampled.error
        table = xr.Dataset(
            {
                "value": (over, value),
                "numerical": (over, numerical),
                "material": (over, shown.std(axis=0, ddof=1)),
                "exact": (over, exact),
                "model": (over, np.abs(exact - value)),
                "mean": (over, shown.mean(axis=0)),
                "percentiles": (
                    ("quantity", "percent"), np.percentile(shown, PERCENTILES, axis=0).T,
                ),
                "correction": (over, of_sample),
                "elasticity": (both, elastic),
                "swing": (("quantity", "source", "side"), self._swing(sampled, i, pull)),
                **{key: (("quantity", "source"), indices) for key, indices in sobol.items()},
            },
            coords={
                "quantity": quantities,
                "units": ("quantity", [_library.columns(0)[name].unit for name in quantities]),
                "parameter": addresses,
                "source": names,
                "percent": list(PERCENTILES),
                "side": ["below", "above"],
            },
        )  # fmt: skip
        row = table.isel(quantity=0)
        known = {key: float(row[key]) for key in ("numerical", "material", "model")}
        known = {key: error for key, error in known.items() if math.isfinite(error)}
        dominant = max(known, key=known.__getitem__)
        return Uncertainty(
            table=table,
            samples=len(found),
            lost=len(found) - len(shown),
            dominant=dominant,
            validity=str(self.judged["validity"]),
            validity_cause=str(self.judged["validity_cause"]),
            beyond=_beyond(case, float(self.judged["contact_time"])),
            solved=sampled.solved if sampled.fresh else len(found),
            fresh=sampled.fresh,
        )

    def _first_failure(self, lost: NDArray[np.bool_]) -> str:
        """Why the first of the samples that are lost has no result."""
        trial, (point,) = self.case.copy(), self.plan.place(self.plan.z[lost][:1])
        try:
            for address, value in zip(self.plan.addresses, point, strict=True):
                trial[address] = float(value)
            trial.solve(quantities=["cor"])
        except Error as error:
            return f"the first one because {error}"
        return f"the first one at {', '.join(f'{x:.6g}' for x in point)}"

    def _swing(self, sampled: Sampled, i: int, pull: Floats) -> Floats:
        """Quantities at one deviation to each side of each source.

        By how they follow the parameters, shape (quantities, addresses); the result has the shape
        (quantities, sources, 2).
        """
        n, m = len(self.quantities), len(self.spreads)
        z = np.tile([one.middle for one in self.spreads for _ in one.addresses], (n, m, 2, 1))
        first = 0
        for k, spread in enumerate(self.spreads):
            own = slice(first, first := first + len(spread.addresses))
            end = spread.end(pull[:, own])
            z[:, k, :, own] += np.stack([-end, end], axis=1)
        different, where = np.unique(z.reshape(n * m * 2, -1), axis=0, return_inverse=True)
        found = sampled.at(i, different)[where.reshape(n, m, 2)]
        swing: Floats = np.einsum("kijk->kij", found)
        return swing


def _beyond(case: Case, contact_time: float) -> str:
    """Words for a temperature, or most of the contact, beyond the data of the materials."""
    said = []
    for name in dict.fromkeys(str(case[f"{body}.material"]) for body in ("sphere", "plate")):
        first, last, cold, warm = (
            number(case, f"{name}.{key}")
            for key in ("valid_from", "valid_to", "valid_temperature_from", "valid_temperature_to")
        )
        kelvin = number(case, "impact.temperature")
        if kelvin < cold or kelvin > warm:
            said.append(
                f"{kelvin:g} K is outside of the shift of '{name}' ({cold:g} to {warm:g} K)"
            )
        factor = case.material(name).time_factor()
        if 2 * first * factor > contact_time:
            said.append(f"the contact lasts {contact_time:.2g} s, the data of '{name}' begin at "
                        f"{first * factor:.2g} s")  # fmt: skip
        if 2 * last * factor < contact_time:
            said.append(f"the contact lasts {contact_time:.2g} s, the data of '{name}' end at "
                        f"{last * factor:.2g} s")  # fmt: skip
    return "; ".join(said)


def _checked(case: Case | str | os.PathLike[str], quantities: Sequence[str]) -> list[str]:
    """Columns of the summary that are numbers, each once; the usual ones are those of the case."""
    if quantities is USUAL and as_case(case)["plate.waves"] == "body":
        quantities = USUAL_BODY
    quantities, columns = listed(quantities), _library.columns(0)
    if not quantities or len(set(quantities)) < len(quantities):
        raise UsageError("quantities: expected one or more columns of the summary, each once")
    for name in quantities:
        if name in columns and columns[name].labels:
            raise UsageError(f"{name}: found a column of words, expected one of numbers")
    return quantities


def _with_group(case: Case, fit: _Fit) -> Case:
    """The case with the group of a fit in the place of its own material, whose density stays."""
    density = case[f"{fit.name}.density"]
    case = with_material(case, fit.name, fit.group, fit.path or "fit.json")
    if density is not None and case[f"{fit.name}.density"] is None:
        case[f"{fit.name}.density"] = density
    return case


def _sobol(
    problem: Mapping[str, Any], values: Floats, names: Sequence[str], seed: int
) -> dict[str, Floats]:
    """INDICES of each column of the samples, shape (columns, names)."""
    from SALib.analyze import sobol as analysis

    found = {key: np.zeros((values.shape[1], len(names))) for key in INDICES}
    for k, column in enumerate(values.T):
        if np.ptp(column) <= 1e-12 * np.abs(column).max():
            continue
        if len(names) == 1:
            # SALib takes a single group for none
            found["first"][k] = found["total"][k] = 1.0
            continue
        indices = analysis.analyze(
            problem, column, calc_second_order=False, num_resamples=RESAMPLES, seed=seed
        )
        for key, name in INDICES.items():
            found[key][k] = indices[name]
    return found


def _exact(case: Case, quantities: list[str]) -> Floats:
    """Results of the exact linear theory; nan if they cannot be had."""
    exact, found = case, np.full(len(quantities), np.nan)
    for address, value in EXACT.items():
        if address == "plate.waves" and case[address] == "none" and not _has_thickness(case):
            continue
        trial = exact.copy()
        try:
            trial[address] = value
            found = _values(trial, quantities)
        except InputError:
            # what has no part in this impact, such as the pair of a rigid sphere
            continue
        except NumericalError:
            found = np.full(len(quantities), np.nan)
        exact = trial
    return found


def _has_thickness(case: Case) -> bool:
    """Whether the plate is a plate, or a layer on a base."""
    return any(case[f"plate.{name}"] for name in ("half_thickness", "thickness"))


def _values(case: Case, quantities: list[str]) -> Floats:
    """Quantities of an impact, shape (quantities,)."""
    with unwarned():
        return np.array(list(case.solve(quantities=quantities).values()), dtype=float)


def _accurate(case: Case | str | os.PathLike[str]) -> Case:
    """A copy of the case that is solved to ACCURACY."""
    case = as_case(case).copy()
    sharpen(case, ACCURACY)
    return case


def _number(case: Case, address: str) -> float:
    """A number of a case; raises UsageError if it is 0 or none, as it has no relative change."""
    value = case[address]
    if not isinstance(value, (int, float)) or value == 0:
        raise UsageError(f"{address}: found {value}, expected a number other than 0")
    return float(value)


def how(solved: int, fresh: int, correction: xr.DataArray) -> str:
    """How results of samples were found by thin mechanics, in words; empty if they were solved."""
    if not fresh:
        return ""
    worst = correction.idxmax("quantity").item()
    first = correction.quantity.values[0]
    parts = " and ".join(
        f"{100 * float(correction.sel(quantity=name)):.2g} % of the standard deviation of {name}"
        for name in dict.fromkeys((first, worst))
    )
    return (
        f"by thin mechanics with a correction from {solved} exact impacts, {fresh} of which it "
        f"does not know: there its error is {parts}"
    )


def _by_name(values: xr.DataArray) -> Any:
    """Numbers by the names of their coordinates."""
    if values.ndim == 0:
        return values.item()
    names = values[values.dims[0]].values
    return {str(name): _by_name(one) for name, one in zip(names, values, strict=True)}


def _report(found: Uncertainty) -> str:
    """The report of the command: errors, elasticities and shares of the variance."""
    table = found.table
    lines = [f"{'':26s}{'value':>13s}{'numerical':>11s}{'material':>11s}{'model':>11s}"
             f"  {'95 % of the samples':26s}"]  # fmt: skip
    for name in table.quantity.values:
        row = table.sel(quantity=name)
        if float(row["value"]) == 0 and float(row.material) == 0:
            continue
        unit = str(row.units.item())
        text = f"{name} [{unit}]" if unit != "1" else str(name)
        low, *_, high = row.percentiles.values
        known = [float(row[key]) for key in ("numerical", "material", "model")]
        errors = "".join(f"{'-':>11s}" if math.isnan(one) else f"{one:11.2g}" for one in known)
        number = float(row["value"])
        lines.append(f"{text:26s}{number:13.6g}{errors}  {low:.5g} to {high:.5g}")
    name = str(table.quantity.values[0])
    lines += ["", f"{name}: the {found.dominant} error is the largest"]
    lines += ["validity: good", ""] if found.validity == "good" else [
        f"validity: {found.validity} by {found.validity_cause}, which no column above contains; "
        "vcor run says what it means", ""]  # fmt: skip
    if found.beyond:
        lines[-1:] = [f"beyond the data, which no column above contains: {found.beyond}", ""]
    lines.append(f"{name + ' by parameter':34s}{'elasticity':>11s}")
    lines += [
        f"{str(one):34s}{float(table.elasticity.sel(quantity=name, parameter=one)):11.4f}"
        for one in table.parameter.values
    ]
    lines += ["", f"{'share of the variance':34s}{'first':>8s}{'+-':>7s}{'total':>8s}{'+-':>7s}"]
    for one in table.source.values:
        row = table.sel(quantity=name, source=one)
        lines.append(f"{str(one):34s}{float(row['first']):8.3f}{float(row.first_error):7.3f}"
                     f"{float(row.total):8.3f}{float(row.total_error):7.3f}")  # fmt: skip
    lines += ["", f"{found.samples} samples, {found.lost} of them without a result"]
    lines += [said] if (said := how(found.solved, found.fresh, table.correction)) else []
    return "\n".join(lines) + "\n"
