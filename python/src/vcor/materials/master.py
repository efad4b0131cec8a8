"""Master curves: moduli at several temperatures, shifted to one.

How the shift is found is in `shifting`; the loss modulus of the figure shows whether the material
is thermorheologically simple.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import os
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _command, _text
from .._library import Floats, InputError, NumericalError, UsageError, within
from .._outputs import finish
from .._text import command, option
from ..units import TURN, ZERO_C
from .data import Columns, Units, add_data_options, columns_option, kelvin, read_moduli, together
from .samples import one_thread
from .select import Where
from .shifting import FOLLOWS, Curve, Law, laws_of, steps_of
from .tables import Choice

if TYPE_CHECKING:
    import pandas as pd

#: Temperature below which one in kelvin is taken for a slip [K]
COLDEST = 100.0
_UNITS = {"wlf_c1": "", "wlf_c2": "K", "activation_energy": "J/mol"}
#: Difference of temperatures of which none is the next of the other [K]
SAME = 0.1


@dataclass(frozen=True)
class Master:
    """A master curve; `str` is the report of the command."""

    reference_temperature: float
    #: Temperatures [K], log10 of the shift factors and their standard errors, shape (n,); the error
    #: is nan for curves that the law places
    temperatures: Floats
    log_shift: Floats
    log_error: Floats
    laws: tuple[Law, ...]
    curves: tuple[Curve, ...]
    #: Remarks on pairs of temperatures whose step is that of the law
    flat: tuple[str, ...] = ()
    #: Whether the moduli are also proportional to the temperature
    vertical: bool = False
    #: Where storage and loss moduli give different shifts, in words
    apart: tuple[str, ...] = ()
    #: Remarks on the columns taken of each file
    taken: tuple[str, ...] = ()

    def curve(self) -> tuple[Floats, ...]:
        """Reduced frequency and moduli, or reduced time and modulus, in rising order.

        The shift factors are those that a material takes: of the law, if they follow one.
        """
        at, moduli, _ = self.points()
        order = np.argsort(at, kind="stable")
        return at[order], *moduli[:, order]

    def points(self) -> tuple[Floats, Floats, NDArray[np.int_]]:
        """The same, one curve after the other, and the number of the curve of each point, from 1.

        The moduli are of shape (1 or 2, n).
        """
        law, log_shift = self.law, self.log_shift
        if law:
            log_shift = law.log_shift(self.temperatures, self.reference_temperature)
        factors = 10**log_shift
        at = np.concatenate([
            one.at * factor if one.dynamic else one.at / factor
            for one, factor in zip(self.curves, factors, strict=True)
        ])  # fmt: skip
        sizes = self.temperatures / self.reference_temperature if self.vertical else None
        moduli = np.hstack([
            one.moduli / (sizes[i] if sizes is not None else 1.0)
            for i, one in enumerate(self.curves)
        ])  # fmt: skip
        own = np.repeat(np.arange(len(self.curves)) + 1, [len(one.at) for one in self.curves])
        return at, moduli, own

    @property
    def law(self) -> Law | None:
        """The law that the shift factors follow and that the data determine, if any."""
        laws = [one for one in self.laws if one.determined]
        law = min(laws, key=lambda one: one.misfit, default=None)
        return law if law and law.misfit < FOLLOWS else None

    def keys(self, table: str) -> dict[str, str | float | bool]:
        """Keys of a &material: the law that the shift factors follow, else their table, a file."""
        found: dict[str, str | float | bool] = {"shift": "table", "shift_file": table}
        if self.law:
            found = {"shift": self.law.name.lower(), **self.law.values}
        if self.vertical:
            found["vertical_shift"] = True
        return {
            **found,
            "reference_temperature": self.reference_temperature,
            "valid_temperature_from": float(self.temperatures.min()),
            "valid_temperature_to": float(self.temperatures.max()),
        }

    def lines(self, table: str) -> list[str]:
        """Keys of a &material as a namelist has them."""
        return [f"{key} = {_value(x)}" for key, x in self.keys(table).items()]

    def as_dict(self) -> dict[str, Any]:
        """All results as they are written to JSON."""
        return _text.document(
            reference_temperature=self.reference_temperature,
            temperature=self.temperatures,
            log10_shift=self.log_shift,
            log10_shift_error=self.log_error,
            vertical_shift=self.vertical,
            laws=[_law(one) for one in self.laws],
        )

    def __str__(self) -> str:
        """The report: a row per temperature, the laws with standard errors, what is not sure."""
        kelvin = self.reference_temperature
        lines = [*self.taken, f"reference temperature {kelvin:.2f} K ({kelvin - ZERO_C:.2f} C)", ""]
        lines.append(f"{'T [K]':>10s}{'T [C]':>10s}{'log10 a_T':>12s}{'error':>8s}")
        lines += [
            f"{t:10.2f}{t - ZERO_C:10.2f}{shift:12.4f}"
            + ("  by law" if math.isnan(error) else f"{error:8.4f}")
            for t, shift, error in zip(
                self.temperatures, self.log_shift, self.log_error, strict=True
            )
        ]
        if self.law and self.flat:
            lines += ["", *self.flat, f"by law: these steps are those of {self.law.name}"]
        for law in self.laws:
            if law.name == "WLF" and not law.determined:
                value, error = law.ratio
                lines += ["", f"WLF: wlf_c1/wlf_c2 {value:.4g} +- {error:.2g} 1/K"]
                lines.append("   which is all that these data determine of its constants: the "
                             "temperatures are too close together, or the shift factors do not "
                             "bend as WLF does")  # fmt: skip
            else:
                constants = ", ".join(
                    f"{name} {value:.5g} +- {law.errors[name]:.2g} {_UNITS[name]}".strip()
                    for name, value in law.values.items()
                )
                lines += ["", f"{law.name}: {constants}"]
                lines += [] if law.determined else ["   not determined by these data"]
            if len(law.values) < len(self.temperatures) - 1 - len(self.flat):
                lines.append(f"   misses the steps between temperatures by {law.rms:.2g} decades, "
                             f"{law.misfit:.2g} times their errors")  # fmt: skip
            else:
                lines.append("   fixed by these few temperatures: one more would test the law")
        if len(self.temperatures) == 2:
            lines += ["", "WLF: two constants need three temperatures, and a test of them four"]
        lines += ["", *self.apart] if self.apart else []
        if self.vertical:
            lines += ["", "moduli are proportional to the temperature, too: vertical_shift"]
        if not self.law:
            lines += ["", "no law holds: a material takes the table of shift factors"]
        return "\n".join(lines) + "\n"

    def figure(self) -> Any:
        """Figure (matplotlib): the master curve, and the shift factors with their laws."""
        from ..plot import HEIGHT, PAGE, drawn

        with drawn(PAGE, HEIGHT, 1, 2) as (made, (left, right)):
            dynamic = self.curves[0].dynamic
            at, *moduli = self.curve()
            names = ("storage modulus", "loss modulus") if dynamic else ("relaxation modulus",)
            hertz = dynamic and any(one.hertz for one in self.curves)
            for name, row, mark in zip(names, moduli, "os", strict=False):
                left.loglog(at / (TURN if hertz else 1.0), row / 1e6, mark, ms=2, label=name)
            what = f"frequency [{'Hz' if hertz else 'rad/s'}]" if dynamic else "time [s]"
            what += f" at {self.reference_temperature - ZERO_C:.1f} °C"
            left.set(xlabel=f"reduced {what}", ylabel="modulus [MPa]")
            left.legend()
            t = np.linspace(self.temperatures.min(), self.temperatures.max(), 200)
            for i, law in enumerate(self.laws):
                shift = law.log_shift(t, self.reference_temperature)
                style_of = {"marker": "", "color": f"C{i + 1}", "ls": ("-", "--")[i % 2]}
                right.plot(t - ZERO_C, shift, label=law.name, **style_of)
            right.errorbar(
                self.temperatures - ZERO_C, self.log_shift, self.log_error, fmt="o", ms=3,
                color="black", mfc="white", label="shift factors",
            )  # fmt: skip
            right.set(xlabel="temperature [°C]", ylabel="log$_{10}$ a$_T$")
            right.legend()
        return made


def master(
    data: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    *,
    reference_temperature: float | None = None,
    poisson_ratio: float | None = None,
    vertical_shift: bool | None = None,
    columns: Columns = None,
    units: Units = None,
    where: Where = None,
) -> Master:
    """Master curve of moduli at several temperatures, as `vcor master` makes it.

    Parameters
    ----------
    data
        Files with a column of temperatures, or one file per temperature, `FILE@-20C` or `FILE@253`.
    reference_temperature
        [K], one of those of the data within 3 K is taken; None: that in their middle.
    poisson_ratio
        Poisson's ratio, by which shear moduli become tensile ones; needed for them only.
    vertical_shift
        Whether the moduli are also proportional to the temperature; None: the data decide.
    columns, units
        Which columns of the files are what, and their units, as for `vcor.read_data`. A text
        counts in the files that have such a head.
    where
        Which rows are taken, as for `vcor.read_data`.

    Returns
    -------
    Master
        Shift factors, WLF and Arrhenius constants with standard errors, and the curve.

    Raises
    ------
    InputError
        The files have no moduli at two or more temperatures.
    NumericalError
        Two neighbouring temperatures have no moduli in common, or are too flat to determine their
        shift and no law of the other steps does.
    """
    names = [data] if isinstance(data, (str, os.PathLike)) else list(data)
    if not names:
        raise UsageError("expected at least one file of data")
    if poisson_ratio is not None:
        within(poisson_ratio, option("poisson_ratio"), -1, 0.5)
    choice = Choice(columns, units, len(names), where)
    read = [one for name in names for one in read_moduli(name, choice, poisson_ratio=poisson_ratio)]
    choice.refuse_unseen("the files have")
    found = of_curves(
        [curve_of(one) for one in together(read)],
        str(names[0]),
        reference_temperature,
        vertical_shift,
    )
    return dataclasses.replace(
        found, taken=tuple(dict.fromkeys(one.attrs["taken"] for one in read))
    )


def of_curves(
    read: Sequence[Curve],
    source: str,
    reference_temperature: float | None = None,
    vertical_shift: bool | None = None,
) -> Master:
    """Master curve of curves of a source; a warning says where moduli contradict each other."""
    curves = sorted(read, key=lambda one: one.temperature)
    if any(math.isnan(curve.temperature) for curve in curves):
        raise InputError(f"{source}: found no column of temperatures, expected one named T, or "
                         f"{source}@-20C for a file of one temperature")  # fmt: skip
    if curves and all(len(curve.at) == 1 for curve in curves):
        what = "frequency" if curves[0].dynamic else "time"
        raise InputError(f"{source}: found one {what} at each temperature, which tells no shifts; "
                         f"expected several at each; {command('identify')} takes such a sweep for "
                         "a material that has a shift")  # fmt: skip
    if len(curves) < 2 or len({curve.dynamic for curve in curves}) > 1:
        raise InputError("expected moduli of one kind at two or more temperatures")
    temperatures = np.array([curve.temperature for curve in curves])
    if (same := np.flatnonzero(np.diff(temperatures) < SAME)).size:
        raise InputError(f"found two curves at {curves[same[0]].place}, expected one at each "
                         "temperature")  # fmt: skip
    if reference_temperature is None:
        middle = len(curves) // 2
    else:
        within(reference_temperature, option("reference_temperature"), -math.inf, math.inf)
        middle = int(np.argmin(np.abs(temperatures - reference_temperature)))
        if abs(temperatures[middle] - reference_temperature) > 3:
            slip = "; a temperature in degrees Celsius ends in C, as 25C"
            slip = slip if reference_temperature < COLDEST else ""
            raise InputError(
                f"there are no data within 3 K of {reference_temperature:g} K "
                f"({reference_temperature - ZERO_C:.4g} C), the nearest are at "
                f"{temperatures[middle]:.2f} K ({temperatures[middle] - ZERO_C:.4g} C): take "
                f"these, or none, as impact.temperature shifts to any temperature{slip}"
            )
        if abs(temperatures[middle] - reference_temperature) > SAME / 2:
            warnings.warn(
                f"{source}: the reference is {temperatures[middle] - ZERO_C:.2f} C, where data "
                f"are, in place of {reference_temperature - ZERO_C:.4g} C", stacklevel=2,
            )  # fmt: skip
    with one_thread():
        found, vertical = steps_of(curves, vertical_shift)
    if apart := tuple(one.apart for one in found if one.apart):
        more = f"; so it is at {len(apart) - 1} more pairs" if len(apart) > 1 else ""
        warnings.warn(f"{source}: {apart[0]}{more}", stacklevel=2)
    steps = np.array([one.value for one in found]) / math.log(10)
    errors = np.sqrt([one.variance for one in found]) / math.log(10)
    reference = float(temperatures[middle])
    laws = tuple(laws_of(temperatures, steps, errors, reference))
    unknown = tuple(one.reason for one in found if one.reason)
    seen = np.isfinite(steps)
    if unknown:
        # in the glass, below all steps that are seen, the law of the steps above does not hold
        best = min(laws, key=lambda one: one.misfit, default=None)
        if not (seen[0] and best and best.misfit < FOLLOWS and len(best.values) < seen.sum()):
            raise NumericalError(f"{unknown[0]}; expected data without one of the two")
        law = best.log_shift(temperatures, reference)
        steps = np.where(seen, steps, np.diff(law))
    shift, variance, unseen = (
        np.concatenate([[0.0], np.cumsum(one)])
        for one in (steps, np.where(seen, errors, 0.0) ** 2, 1.0 - seen)
    )
    return Master(
        reference,
        temperatures,
        shift - shift[middle],
        np.where(unseen == unseen[middle], np.sqrt(np.abs(variance - variance[middle])), np.nan),
        laws,
        tuple(curves),
        unknown,
        vertical,
        apart,
    )


def curve_of(data: pd.DataFrame) -> Curve:
    """Curve of data at one temperature, nan if they have none."""
    dynamic = data.attrs["kind"] == "dynamic"
    # frequencies rise; times fall, as their frequencies rise
    data = data if dynamic else data[::-1]
    names = ["storage_modulus", "loss_modulus"] if dynamic else ["relaxation_modulus"]
    at = data["frequency" if dynamic else "time"].to_numpy()
    given = str(data.attrs["names"].get("temperature", data.attrs.get("given", "")))
    celsius = re.search(r"(?i)K\W*$|kelvin", given) is None
    moduli = data[names].to_numpy().T.copy()
    return Curve(data.attrs["temperature"], dynamic, at, moduli, celsius, data.attrs["hertz"])


def _parser() -> _command.Parser:
    """Options of `vcor master`."""
    parser = _command.Parser(
        "master",
        description="Master curve and shift factors of moduli at several temperatures. Writes "
        "NAME_master.csv for vcor fit, NAME_master_shift.csv for shift_file, JSON and a figure.",
    )
    parser.signed = "--reference"
    parser.add_outputs()
    add = parser.add_argument
    what = "file with a column T [C] or T [K], or FILE@-20C of one temperature"
    add("data", nargs="+", metavar="DATA", help=what)
    add(
        "--reference",
        dest="reference_temperature",
        metavar="TEMPERATURE",
        help="such as 20C or 293.15K; default: the middle",
    )
    what = "for shear moduli: Poisson's ratio, by which they become tensile ones"
    add("--poisson-ratio", type=float, metavar="NU", help=what)
    what = "whether moduli are also proportional to the temperature; default: the data decide"
    add("--vertical-shift", choices=("yes", "no"), help=what)
    add_data_options(parser)
    return parser


def _work(options: argparse.Namespace) -> None:
    """`vcor master`: shift the curves, print the report, write the master curve and the shift."""
    given = options.reference_temperature
    reference = kelvin(given, "--reference") if given is not None else None
    ratio, vertical = options.poisson_ratio, options.vertical_shift
    found = master(
        options.data, reference_temperature=reference, poisson_ratio=ratio,
        vertical_shift=None if vertical is None else vertical == "yes",
        columns=columns_option(options.columns), units=options.units, where=options.where,
    )  # fmt: skip
    dynamic = found.curves[0].dynamic
    head = "omega [rad/s],E_stor [Pa],E_loss [Pa],set" if dynamic else "t [s],E [Pa],set"
    at, moduli, own = found.points()
    rows = _rows([at, *moduli, own.astype(float)])
    reference = found.reference_temperature
    stem = f"{Path(options.data[0].partition('@')[0]).stem}_master"
    pairs = found.lines(f"{stem}_shift.csv")
    keys = "".join(f"# &material {pair}\n" for pair in pairs)
    texts = {
        ".csv": f"# master curve at {reference:.6g} K\n{keys}{head}\n{rows}",
        "_shift.csv": f"# reference temperature {reference:.6g} K\nT [K],log10 a_T\n"
        + _rows((found.temperatures, found.log_shift)),
        ".json": found.as_dict(),
    }
    report = f"{found}\nshift of a &material, which vcor fit {stem}.csv takes over:\n"
    report += "".join(f"   {pair}\n" for pair in pairs)
    finish(options, report, stem, texts, found.figure())


def _law(law: Law) -> dict[str, Any]:
    """A law as it is written to JSON: without constants of WLF that are not determined."""
    known = law.name != "WLF" or law.determined
    found: dict[str, Any] = {"law": law.name}
    for key, values in (("values", law.values), ("errors", law.errors)):
        found[key] = {name: one if known else None for name, one in values.items()}
    if law.name == "WLF":
        found["ratio"], found["ratio_error"] = law.ratio
    return {**found, "rms": law.rms, "determined": law.determined}


def _rows(columns: Sequence[Floats]) -> str:
    """Columns as rows of text."""
    return "".join(",".join(f"{x:.9g}" for x in row) + "\n" for row in zip(*columns, strict=True))


def _value(value: str | float | bool) -> str:
    """A value as a namelist has it."""
    if isinstance(value, bool):
        return ".true." if value else ".false."
    return repr(value) if isinstance(value, str) else f"{value:.9g}"
