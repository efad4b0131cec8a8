"""Report and figure of an identification."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _library
from .._library import printable
from ..case import number
from ..units import TURN, ZERO_C
from .advice import percent
from .identified import Identified
from .observations import COEFFICIENTS, IMPACT, materials_of

#: Data that are shown at most
_MOST = 20
#: Temperatures of one source that the legend of a figure names, each
_NAMED = 6
#: Abscissae of data other than impacts
_ACROSS = {
    "force": "time [s]",
    "relaxation_modulus": "time [s]",
}


def report(found: Identified) -> str:
    """Report that the command prints."""
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
    if not found.dof:
        lines += ["", "as many data as parameters: nothing tests the model (0 degrees of freedom)"]
    elif found.relative_error is None:
        lines += ["", f"chi2/dof {found.chi2 / max(found.dof, 1):.3g} ({found.dof} dof)"]
    else:
        lines += ["", f"error of each datum {percent(found.relative_error)}, from the misfit and "
                  f"the digits ({found.dof} degrees of freedom)"]  # fmt: skip
    if found.dof:
        lines[-1] += f", AIC {found.aic:.1f}, BIC {found.bic:.1f}"
    for source in found.alike:
        lines.append(f"the misfits of {source} are not noise, neighbours are correlated: the model "
                     "does not describe these data, and the intervals are too narrow")  # fmt: skip
    if not found.follows:
        lines.append("the data scatter more than their errors: the model (waves, law, material) "
                     "does not describe them")  # fmt: skip
    lines += ["", "what the data determine, from best to worst (eigenvalue of the Fisher matrix):"]
    lines += [
        f"  {percent(error):>8s}  {text}  ({value:.3g})"
        for (text, error), value in zip(found.combinations, found.eigenvalues, strict=True)
    ]
    low, high = found.window
    seen = f"the data cover the material from {low:.2g} to {high:.2g} s"
    materials = materials_of([one.address for one in found.estimates])
    if len(materials) == 1 and found.case[f"{materials[0]}.shift"] is not None:
        kelvin = number(found.case, f"{materials[0]}.reference_temperature")
        seen += f" at its reference temperature, {kelvin:.2f} K"
    lines += ["", seen]
    if {row["quantity"] for row in found.data} <= {*COEFFICIENTS}:
        lines += ["these are coefficients, which leave the scale of times to what is fixed"]
    if found.loss_tangents:
        lines += [
            "",
            "loss tangent at pi/t0, the frequency of the contact, which decides the loss:",
        ]
    for tangent in found.loss_tangents:
        warm = "" if math.isnan(tangent.temperature) else f", {tangent.temperature:.2f} K"
        where = f"{tangent.velocity:.4g} m/s{warm} ({tangent.frequency:.4g} rad/s)"
        lines.append(f"  {tangent.value:.4g} +- {tangent.standard_error:.2g} at {where}")
    if found.solved:
        lines += ["", f"by thin mechanics with a correction from {found.solved} exact impacts, "
                  f"{found.fresh} of which it does not know: there it is off by "
                  f"{100 * found.correction:.2g} % of the errors of the data"]  # fmt: skip
    lines += ["", f"validity: {found.validity}", f"what would help most: {found.advice}", ""]
    sources, kelvins = _sources(found), {row["temperature"] for row in found.data}
    several, heated = len(sources) > 1, not all(map(math.isnan, kelvins))
    head = f"{'datum':20s}" + f"{'source':16s}" * several + f"{'at':>12s}"
    lines.append(head + f"{'T [K]':>9s}" * heated + f"{'value':>13s}{'model':>13s}"
                 f"{'residual/error':>16s}")  # fmt: skip
    shown = sorted(found.data, key=lambda row: -abs(row["residual"]))[:_MOST]
    for r in found.data:
        if any(r is one for one in shown):
            begin = f"{r['quantity']:20s}" + f"{sources[r['source']]:16.15s}" * several
            begin += f"{r['at']:12.5g}" + f"{r['temperature']:9.2f}" * heated
            lines.append(f"{begin}{r['value']:13.6g}{r['model']:13.6g}{r['residual']:z16.2f}")
    if len(found.data) > len(shown):
        lines.append(f"(the {len(shown)} largest of {len(found.data)} residuals)")
    return "\n".join(lines) + "\n"


def _sources(found: Identified) -> dict[str, str]:
    """Files of data by their names without folders and endings."""
    names = {}
    for row in found.data:
        path, mark, rest = row["source"].partition(IMPACT)
        names[row["source"]] = printable(Path(path).stem + mark + rest)
    return names


@dataclass(frozen=True)
class _Look:
    """How data of one source at one temperature are drawn."""

    color: Any
    marker: str
    #: In the legend, empty if it names others
    text: str


def _looks(found: Identified) -> dict[tuple[str, str], _Look]:
    """Colours by temperature, or by source at one temperature; markers by source."""
    import matplotlib as mpl

    sources = _sources(found)
    kelvins = sorted({str(row["temperature"]) for row in found.data}, key=float)
    keys = {(row["source"], str(row["temperature"])) for row in found.data}
    if len(keys) == 1:
        return dict.fromkeys(keys, _Look("black", "o", "data"))
    warm = len(kelvins) > 1
    shades = mpl.colormaps["viridis"](np.linspace(0, 0.85, len(kelvins if warm else sources)))
    looks = {}
    for source, kelvin in sorted(keys, key=lambda key: (float(key[1]), key[0])):
        i, k = list(sources).index(source), kelvins.index(kelvin)
        # of many temperatures the lowest, the middle and the highest one
        own = [one for one in kelvins if (source, one) in keys]
        named = own if len(own) <= _NAMED else (own[0], own[len(own) // 2], own[-1])
        parts = [sources[source]] if len(sources) > 1 else []
        parts += [f"{float(kelvin) - ZERO_C:.4g} °C"] if warm else []
        looks[source, kelvin] = _Look(
            shades[k if warm else i], "osD^v"[i % 5], ", ".join(parts) if kelvin in named else ""
        )
    return looks


def figure(found: Identified) -> Any:
    """Figure (matplotlib): data, model with the band of cor, and residuals below."""
    from ..plot import COLUMN, HEIGHT, PAGE, _label_decades, _labelled, _legend, drawn

    names, looks = list(dict.fromkeys(row["quantity"] for row in found.data)), _looks(found)
    alone = len(looks) == 1
    width = COLUMN if len(names) == 1 else PAGE
    settings: dict[str, Any] = {"sharex": "col", "squeeze": False, "height_ratios": (3, 1)}
    with drawn(width, 1.4 * HEIGHT, 2, len(names), **settings) as (made, axes):
        for (above, below), name in zip(axes.T, names, strict=True):
            rows = [row for row in found.data if row["quantity"] == name]
            attrs = {"units": "N" if name == "force" else "Pa"}
            column = _library.columns(0).get(name)
            factor, label = _labelled(name, column.attrs if column else attrs,
                                      np.array([row["value"] for row in rows]))  # fmt: skip
            across = _ACROSS.get(name, "velocity [m/s]")
            unit = 1.0
            if name in ("storage_modulus", "loss_modulus"):
                across = f"frequency [{'Hz' if found.hertz else 'rad/s'}]"
                unit = TURN if found.hertz else 1.0
            at = np.array([row["at"] for row in rows]) / unit
            for key, look in looks.items():
                some = [row for row in rows if (row["source"], str(row["temperature"])) == key]
                some.sort(key=lambda row: row["at"])
                if not some:
                    continue
                x, value, sigma, model, residual = (
                    np.array([row[key] for row in some])
                    for key in ("at", "value", "sigma", "model", "residual")
                )
                x = x / unit
                # at several radii, say, no line leads through all
                apart = len(set(x)) < len(set(zip(x, model, strict=True)))
                line = x, factor * model
                if alone and name in found.band and found.band["velocity"] and not apart:
                    band = {key: np.array(column) for key, column in found.band.items()}
                    line = band["velocity"], band[name]
                    above.fill_between(
                        band["velocity"], band["low"], band["high"], alpha=0.3, lw=0, color="C1",
                        label="95 % band",
                    )  # fmt: skip
                above.plot(
                    *line, marker="x" if apart else "", ls="" if apart else "-",
                    color="C1" if alone else look.color, zorder=3, label="model" if alone else "",
                )  # fmt: skip
                above.errorbar(
                    x, factor * value, factor * sigma, fmt=look.marker, ms=3, color=look.color,
                    mfc="white", label=look.text,
                )  # fmt: skip
                below.plot(x, residual, look.marker, ms=3, color=look.color)
            above.set_ylabel(label)
            below.axhline(0, lw=0.5, color="grey", marker="")
            below.set(xlabel=across, ylabel="residual/error")
            if at.min() > 0 and at.max() > 8 * at.min():
                above.set_xscale("log")
            if "modulus" in name:
                above.set_yscale("log")
            for axis in (above.xaxis, above.yaxis):
                _label_decades(axis)
        _legend(made)
    return made
