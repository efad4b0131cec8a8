"""Report and figure of an identification."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _library
from ..case import number
from .advice import percent
from .observations import COEFFICIENTS, materials_of

if TYPE_CHECKING:
    from .identification import Identification

#: Data that are shown at most
_MOST = 20
#: Abscissae of data that are no impacts
_ACROSS = {
    "force": "time [s]",
    "relaxation_modulus": "time [s]",
    "storage_modulus": "frequency [rad/s]",
    "loss_modulus": "frequency [rad/s]",
}


def report(found: Identification) -> str:
    """What the command prints."""
    lines = [
        f"{len(found.data)} data of {', '.join(dict.fromkeys(r['source'] for r in found.data))}",
        *found.taken,
    ]
    head = f"{'':32s} {'value':>12s} {'error':>9s}  {'68 % interval':26s}{'95 % interval':26s}"
    lines += ["", head.rstrip()]
    for one in found.estimates:
        ends = "".join(
            f"{f'{low:.5g} to {high:.5g}':26s}" for low, high in (one.interval_68, one.interval_95)
        )
        error = percent(one.standard_error / one.value)
        name = f"{one.address} [{one.unit}]" if one.unit not in ("", "1") else one.address
        lines.append(f"{name:32s} {one.value:12.6g} {error:>9s}  {ends}".rstrip())
    for one in found.estimates:
        if math.isnan(one.standard_error):
            wide = [f", {end:g} is as good" for end in one.interval_68 if end in (0, math.inf)]
            lines.append(f"{one.address} is at its bound{''.join(wide)}: no standard error")
    if found.relative_error is None:
        lines += ["", f"chi2/dof {found.chi2 / max(found.dof, 1):.3g} ({found.dof} dof)"]
    else:
        lines += ["", f"error of each datum {percent(found.relative_error)}, from the misfit and "
                  f"the digits ({found.dof} degrees of freedom)"]  # fmt: skip
    lines[-1] += f", AIC {found.aic:.1f}, BIC {found.bic:.1f}"
    for source in found.alike:
        lines.append(f"the misfits of {source} are no noise, neighbours are alike: the model does "
                     "not describe these data, and the intervals are too narrow")  # fmt: skip
    if not found.follows:
        lines.append("the data scatter more than their errors: the model (waves, law, material) "
                     "does not describe them")  # fmt: skip
    lines += ["", "what the data determine, from best to worst (eigenvalue of the Fisher matrix):"]
    lines += [
        f"  {percent(error):>8s}  {text}  ({value:.3g})"
        for (text, error), value in zip(found.combinations, found.eigenvalues, strict=True)
    ]
    low, high = found.window
    seen = f"the data see the material from {low:.2g} to {high:.2g} s"
    materials = materials_of([one.address for one in found.estimates])
    if len(materials) == 1 and found.case[f"{materials[0]}.shift"] is not None:
        kelvin = number(found.case, f"{materials[0]}.reference_temperature")
        seen += f" at its reference temperature, {kelvin:.2f} K"
    lines += ["", seen]
    if {row["quantity"] for row in found.data} <= {*COEFFICIENTS}:
        lines += ["these are coefficients only: the scale of times rests on what is not free"]
    lines += [f"validity: {found.validity}", f"what would help most: {found.advice}", ""]
    lines.append(f"{'datum':20s}{'at':>12s}{'value':>13s}{'model':>13s}{'residual/error':>16s}")
    shown = sorted(found.data, key=lambda row: -abs(row["residual"]))[:_MOST]
    lines += [
        f"{r['quantity']:20s}{r['at']:12.5g}{r['value']:13.6g}{r['model']:13.6g}"
        f"{r['residual']:16.2f}"
        for r in found.data if any(r is one for one in shown)
    ]  # fmt: skip
    if len(found.data) > len(shown):
        lines.append(f"(the {len(shown)} largest of {len(found.data)} residuals)")
    return "\n".join(lines) + "\n"


def figure(found: Identification) -> Any:
    """Figure (matplotlib): data, model with the band of cor, and residuals below."""
    from ..plot import COLUMN, HEIGHT, PAGE, _label_decades, _labelled, _legend, drawn

    names = list(dict.fromkeys(row["quantity"] for row in found.data))
    width = COLUMN if len(names) == 1 else PAGE
    settings: dict[str, Any] = {"sharex": "col", "squeeze": False, "height_ratios": (3, 1)}
    with drawn(width, 1.4 * HEIGHT, 2, len(names), **settings) as (made, axes):
        for (above, below), name in zip(axes.T, names, strict=True):
            rows = sorted((r for r in found.data if r["quantity"] == name), key=lambda r: r["at"])
            at, value, sigma, model, residual = (
                np.array([row[key] for row in rows])
                for key in ("at", "value", "sigma", "model", "residual")
            )
            attrs = {"units": "N" if name == "force" else "Pa"}
            column = _library.columns(0).get(name)
            factor, label = _labelled(name, column.attrs if column else attrs, value)
            # at several temperatures, say, no line leads through all
            apart = len(set(at)) < len(set(zip(at, model, strict=True)))
            line = at, factor * model
            if name in found.band and found.band["velocity"] and not apart:
                band = {key: np.array(column) for key, column in found.band.items()}
                line = band["velocity"], band[name]
                above.fill_between(
                    band["velocity"], band["low"], band["high"], alpha=0.3, lw=0, color="C1",
                    label="95 % band",
                )  # fmt: skip
            above.plot(
                *line, marker="x" if apart else "", ls="" if apart else "-", color="C1",
                zorder=3, label="model",
            )  # fmt: skip
            above.errorbar(
                at, factor * value, factor * sigma, fmt="o", ms=3, color="black",
                mfc="white", label="data",
            )  # fmt: skip
            above.set_ylabel(label)
            below.axhline(0, lw=0.5, color="grey", marker="")
            below.plot(at, residual, "o", ms=3, color="black")
            below.set(xlabel=_ACROSS.get(name, "velocity [m/s]"), ylabel="residual/error")
            if at.min() > 0 and at.max() > 8 * at.min():
                above.set_xscale("log")
            if "modulus" in name:
                above.set_yscale("log")
            for axis in (above.xaxis, above.yaxis):
                _label_decades(axis)
        _legend(made)
    return made
