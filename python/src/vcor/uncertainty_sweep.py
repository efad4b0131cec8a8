"""Uncertainty along a sweep: bands of results against the parameter that a case varies."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from . import _library, _text
from ._coverage import unwarned
from ._library import NoResultWarning, NumericalError, UsageError, ValidityWarning
from .case import Case, as_case, with_values
from .uncertainty import PERCENTILES, USUAL, Drawn, Spread, Uncertainty, how
from .uncertainty_samples import sampled

#: Most points of the sweep that a report shows
ROWS = 12
#: Ending of the name of a column after that of a quantity, and its meaning
COLUMNS = {
    "numerical": "error of the numbers",
    "material": "standard deviation by the parameters",
    "exact": "with exact mechanics",
}


@dataclass(frozen=True)
class Bands:
    """Uncertainty of the results along a sweep; `str` is the report of the command."""

    #: Over the swept address: each quantity, NAME_numerical, NAME_material, NAME_exact, its
    #: percentiles NAME_p2.5 to NAME_p97.5, validity and validity_cause; nan without a result; the
    #: attribute `samples` says how they were found if not all were solved
    table: xr.Dataset
    quantities: list[str]
    #: All that is known of each point of the sweep, None where there is no result
    points: list[Uncertainty | None]

    def __str__(self) -> str:
        return _report(self)

    def as_dict(self) -> dict[str, Any]:
        """All results as they are written to JSON."""
        (axis,) = self.table.coords
        return _text.document(
            parameter=str(axis),
            unit=self.table[axis].attrs.get("units", "1"),
            points=[
                {"value": float(value), **(found.as_dict() if found else {})}
                for value, found in zip(self.table[axis].values, self.points, strict=True)
            ],
        )

    def figure(self, quantity: str = "cor") -> Any:
        """Figure (matplotlib) of a quantity with its bands, as `vcor plot` makes it.

        Points at which the impact lies beyond the data of its materials are marked.
        """
        from .plot import figure

        (axis,) = self.table.coords
        beyond = [bool(one and one.beyond) for one in self.points]
        return figure(self.table.assign(beyond=(axis, beyond)), quantities=[quantity])


def bands(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, str | float] | None = None,
    *,
    covariance: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    samples: int = 4096,
    quantities: Sequence[str] = USUAL,
    seed: int = 1,
    threads: int | None = None,
) -> Bands:
    """Uncertainty of results along a sweep: at each of its values what `propagate` gives.

    The samples are the same at all values, so that the bands are as smooth as the results.

    Parameters
    ----------
    case
        A case with one &sweep group.
    vary, covariance
        As for `propagate`. The swept parameter may vary about its values: "5%" or "0.1".
    samples
        Samples at each value, about.
    quantities
        Columns of the summary; by default all quantities that the impacts have.
    seed, threads
        As for `propagate`.

    Returns
    -------
    Bands
        Quantities and their percentiles over the swept parameter.
    """
    return _bands(case, vary, covariance, samples, quantities, seed, threads)


def _bands(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, str | float] | None,
    covariance: str | os.PathLike[str] | Mapping[str, Any] | None,
    samples: int,
    quantities: Sequence[str],
    seed: int,
    threads: int | None,
    corrected: bool | None = None,
) -> Bands:
    """As `bands`; `corrected` as for `uncertainty_samples.sampled`."""
    case = as_case(case)
    axes = case._axes()
    if quantities is USUAL:
        quantities = _every(case)
    if len(axes) != 1:
        raise UsageError(f"{case.name}: found {len(axes)} swept parameters, expected one")
    ((address, values),) = axes.items()
    wanted = {} if vary is None else dict(vary.items())
    if ":" in str(wanted.get(address, "")):
        raise UsageError(f"{address}={wanted[address]}: this parameter is swept, expected a spread "
                         "about its values, such as 5% or 0.1 (in its unit)")  # fmt: skip
    if covariance is not None:
        case, joint = Spread.joint(case, covariance)
        if address in joint.addresses:
            raise UsageError(f"{address}: this parameter is swept, and the covariance has it; "
                             "expected one of the two")  # fmt: skip
    drawn: dict[int, Drawn] = {}
    points: list[Uncertainty | None] = [None] * len(values)
    failures = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for i, value in enumerate(values.tolist()):
            try:
                drawn[i] = Drawn.of(with_values(case, {address: value}), wanted, covariance,
                                    samples, quantities, seed, (address, value))  # fmt: skip
            except NumericalError as error:
                failures.append(error)
    if not drawn:
        raise failures[0]
    names = next(iter(drawn.values())).quantities
    found = sampled([one.plan for one in drawn.values()], names, seed, threads, corrected)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for k, (i, one) in enumerate(drawn.items()):
            try:
                points[i] = one.uncertainty(found, k)
            except NumericalError as error:
                failures.append(error)
    good = next((one for one in points if one), None)
    if not good:
        raise failures[0]
    lost = sum(one.lost for one in points if one)
    if failures or lost:
        first = f", the first one: {failures[0]}" if failures else ""
        warnings.warn(
            f"{case.name}: {len(failures)} of {len(points)} values of {address}, and {lost} "
            f"samples of the others, have no result{first}",
            NoResultWarning,
            stacklevel=2,
        )
    nothing = xr.full_like(good.table, np.nan)
    along = xr.concat([one.table if one else nothing for one in points], address)
    columns: dict[str, tuple[NDArray[Any], dict[str, str]]] = {}
    for name in good.quantities:
        columns |= _columns(name, along.sel(quantity=name))
    for name in ("validity", "validity_cause"):
        words = [getattr(one, name) if one else "none" for one in points]
        columns[name] = np.array(words), _library.columns(0)[name].attrs
    attrs = case._attrs({})
    if said := how(good.solved, good.fresh, good.table.correction):
        attrs["samples"] = said
    table = xr.Dataset(
        {name: (address, column, units) for name, (column, units) in columns.items()},
        coords={address: (address, values, case._describe(address).attrs)},
        attrs=attrs,
    )
    return Bands(table, good.quantities, points)


def _every(case: Case) -> list[str]:
    """Quantities that all impacts of a sweep have, but errors and pure numbers that only judge."""
    with warnings.catch_warnings(), unwarned(ValidityWarning):
        warnings.simplefilter("ignore", NoResultWarning)
        found = case.run(progress=False)
    columns = _library.columns(0)
    judges = columns["validity_cause"].labels.split()
    there = np.isfinite(found["cor"].values)
    if not there.any():
        return list(USUAL)
    return [
        name
        for name, one in columns.items()
        if not (one.labels or one.is_whole or name.endswith("_error") or name == "energy_imbalance")
        and not (name in judges and one.unit == "1")
        and np.isfinite(found[name].values[there]).all()
    ]


def _columns(name: str, along: xr.Dataset) -> dict[str, tuple[NDArray[Any], dict[str, str]]]:
    """Columns of a quantity with their attributes, from what is known of it along the sweep."""
    attrs = _library.columns(0)[name].attrs

    def named(meaning: str) -> dict[str, str]:
        """Attributes of a column of the quantity."""
        return attrs | {"long_name": f"{attrs['long_name']}: {meaning}"}

    found = {name: (along["value"].values, attrs)}
    for key, meaning in COLUMNS.items():
        found[f"{name}_{key}"] = along[key].values, named(meaning)
    for percent in PERCENTILES:
        column = along.percentiles.sel(percent=percent).values
        found[f"{name}_p{percent:g}"] = column, named(f"percentile {percent:g} of the samples")
    return found


def _report(found: Bands) -> str:
    """The report of the command: some points, the largest errors, shares at both ends."""
    table, name = found.table, found.quantities[0]
    (axis,) = table.coords
    known = [(float(at), one) for at, one in zip(table[axis].values, found.points, strict=True)
             if one]  # fmt: skip
    units = [table[one].attrs.get("units", "1") for one in (axis, name)]
    heads = [f"{one} [{unit}]" if unit != "1" else str(one)
             for one, unit in zip((axis, name), units, strict=True)]  # fmt: skip
    lines = [f"{heads[0]:>26s} {heads[1]:>15s}{'numerical':>11s}{'material':>11s}{'model':>11s}"
             f"  {'95 % of the samples':26s}validity"]  # fmt: skip
    chosen = np.unique(np.linspace(0, len(found.points) - 1, ROWS).round().astype(int))
    for i in chosen:
        row = table.isel({axis: i})
        number, exact = float(row[name]), float(row[f"{name}_exact"])
        errors = [float(row[f"{name}_numerical"]), float(row[f"{name}_material"]),
                  abs(exact - number)]  # fmt: skip
        texts = "".join(f"{'-':>11s}" if np.isnan(one) else f"{one:11.2g}" for one in errors)
        low, high = (float(row[f"{name}_p{end:g}"]) for end in (PERCENTILES[0], PERCENTILES[-1]))
        lines.append(f"{float(row[axis]):26.6g}{number:16.6g}{texts}  "
                     f"{f'{low:.5g} to {high:.5g}':26s}{row.validity.item()}")  # fmt: skip
    largest = {key: sum(one.dominant == key for _, one in known)
               for key in ("numerical", "material", "model")}  # fmt: skip
    lines += ["", f"{name}: the largest error is " + ", ".join(
        f"that of the {'numbers' if key == 'numerical' else key} at {n}"
        for key, n in largest.items() if n) + f" of {len(found.points)} values"]  # fmt: skip
    beyond = [(at, one.beyond) for at, one in known if one.beyond]
    if beyond:
        places = ", ".join(f"{at:g}" for at, _ in beyond[:8]) + ", ..." * (len(beyond) > 8)
        lines += [f"beyond the data, which no column above contains, at {len(beyond)} of "
                  f"{len(found.points)} values ({places}); the first: {beyond[0][1]}"]  # fmt: skip
    where = [known[i][0] for i in (0, -1)]
    ends = [known[i][1] for i in (0, -1)]
    head = f"share of the variance of {name} (total)"
    lines += ["", f"{head:44s}{f'at {where[0]:.4g}':>12s}{f'at {where[1]:.4g}':>12s}"]
    for source in ends[0].table.source.values:
        shares = [float(one.table.total.sel(quantity=name, source=source)) for one in ends]
        lines.append(f"{str(source):44s}{shares[0]:12.3f}{shares[1]:12.3f}")
    if "samples" in table.attrs:
        lines += ["", table.attrs["samples"]]
    return "\n".join(lines) + "\n"
