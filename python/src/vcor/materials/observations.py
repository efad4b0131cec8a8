"""Measured data that parameters are identified from, and what a case predicts for them."""

from __future__ import annotations

import contextlib
import itertools
import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from .. import _library
from .._coverage import unwarned
from .._library import Error, Floats, InputError, NoResultWarning, ValidityWarning
from .._text import near, option
from ..arguments import arrays
from ..case import Case, number, radius_of
from .data import curves, read_data, tensile
from .names import COMPUTED
from .reader import SAME_TEMPERATURE
from .tables import Choice

if TYPE_CHECKING:
    import xarray as xr

#: By column: the unit of its last digit, and its most significant digits; of arrays none is known
Written = Mapping[str, tuple[float, int]]
NO_DIGITS: Written = {}

Source = str | os.PathLike[str] | Mapping[str, ArrayLike]

#: Standard gravity [m/s2]
GRAVITY = 9.80665
#: Columns of a data file that say where a datum was taken
SETTINGS = {
    "velocity": "impact.velocity",
    "temperature": "impact.temperature",
    "radius": "sphere.radius",
    "mass": "sphere.mass",
}
#: Quantities that are at most 1, and say nothing about the scale of times
COEFFICIENTS = ("cor", "cor_sphere", "resilience")
#: Factor between neighbouring coefficients of restitution that no sequence of bounces has
UNLIKE = 2.0
#: Part of the largest force above which a pulse is one of an impact, in noise and without, and
#: lengths of the longest pulse between impacts: a flight lasts far longer than a contact, and
#: contacts with a beam or a plate that swings follow each other within some lengths
PULSE, LEAST_PULSE, APART = 0.3, 0.1, 20.0
#: Part of the largest force of a pulse at which its contact begins and ends, and lengths of a
#: contact that are kept on each side of one of several
TOUCH, BESIDE_PULSE = 0.01, 2.0
#: End of the name of a record, behind that of its file, if it is one of several
IMPACT = " (impact "
#: Most impacts of a table: a fit solves each some 500 times, which takes 0.03 s an impact on a thin
#: plate, so a minute
MOST_IMPACTS = 2000
#: Relative error of the moduli of a model, with room: functions in double precision
ERROR_OF_MODULI = 1e-11
#: Accuracy with waves = 'body', where a finer one takes seconds
BODY_ACCURACY = 1e-5


class Impacts:
    """Impacts: a row of settings each, and what was measured."""

    unknowns = 0
    taken = ""

    def __init__(
        self, source: str, columns: Mapping[str, Floats], case: Case, written: Written = NO_DIGITS
    ) -> None:
        """Take the rows of a table of impacts.

        `columns` has SI units, shape (rows,) each: the settings of the rows and what was measured,
        with NAME_sigma for a standard error [same unit, nan: not known]. `written` has the digits
        of the file. Velocities that are missing are those of the case.

        InputError: an unknown column, a number out of range, a row without a setting, no measured
        quantity, or more than MOST_IMPACTS rows.
        """
        self.source = source
        columns, digits = _as_velocities(source, dict(columns), case, written)
        self.settings: dict[str, Floats] = {}
        parts = []
        known = _library.columns(0)
        for name, column in columns.items():
            if name.endswith("_sigma") and name[:-6] in columns:
                continue
            if "." in name:
                self.settings[name] = column
                continue
            if name not in SETTINGS and (name not in known or known[name].labels):
                hint = near(name, [*known, *SETTINGS, "drop_height", "bounce_time"])
                raise InputError(f"{source}: found column '{name}', expected a column of the "
                                 f"summary, {', '.join(SETTINGS)} or an address{hint}")  # fmt: skip
            most = 1.0 if name in COEFFICIENTS else math.inf
            if (bad := np.flatnonzero((column <= 0) | (column > most))).size:
                limit = " and <= 1" if most == 1 else ""
                if 2 < column[bad[0]] <= 100 and limit:
                    limit += f", or the unit in the head, such as {name} [%]"
                raise InputError(f"{source}: row {bad[0] + 1}: found a {name} of "
                                 f"{column[bad[0]]:.6g}, expected one > 0{limit}")  # fmt: skip
            if name in SETTINGS:
                self.settings[SETTINGS[name]] = column
                continue
            rows = np.flatnonzero(np.isfinite(column))
            if rows.size:
                digit = digits.get(name, last_digit(column, written.get(name)))
                parts.append((name, rows, column[rows], _sigma(columns, name)[rows], digit[rows]))
        if not parts:
            raise InputError(f"{source}: there is no measured quantity, such as cor, in this file")
        for address, column in self.settings.items():
            if np.isnan(column).any():
                row = int(np.argmax(np.isnan(column))) + 1
                raise InputError(f"{source}: row {row}: found no number of {address}")
        self.names = [name for name, *_ in parts]
        self.quantity = [name for name, rows, *_ in parts for _ in rows]
        self._rows, self.value, self.sigma, self.digit = (
            np.concatenate([part[i] for part in parts]) for i in (1, 2, 3, 4)
        )
        self.scale = np.abs(self.value)
        self._columns = np.repeat(np.arange(len(parts)), [len(rows) for _, rows, *_ in parts])
        n = max((len(column) for column in self.settings.values()), default=max(self._rows) + 1)
        if n > MOST_IMPACTS:
            raise InputError(f"{source}: found {n} impacts, expected at most {MOST_IMPACTS}, as a "
                             "fit solves each some hundred times: take a part of the rows "
                             f"({option('where')}), or means of repeated impacts")  # fmt: skip
        #: Velocity of each impact [m/s]
        self.velocity = self.settings.pop("impact.velocity", np.full(n, velocity_of(case)))
        if case["impact.drop_height"] is None:
            self.settings["impact.velocity"] = self.velocity
        else:
            self.settings["impact.drop_height"] = self.velocity**2 / (2 * gravity_of(case))
        self.at = self.velocity[self._rows]
        kelvin = self.settings.get("impact.temperature")
        self.temperature = np.full(len(self.at), np.nan) if kelvin is None else kelvin[self._rows]
        self._last: tuple[str, xr.Dataset] | None = None
        table = np.stack(list(self.settings.values()), axis=1)
        self.place = [tuple(table[row].tolist()) for row in self._rows]

    def predict(
        self, case: Case, addresses: list[str], values: Floats, middle: Floats | None = None
    ) -> Floats:
        """Data for each row of values at the addresses, shape (rows, n); nan without result."""
        results = self.quantities(case, addresses, values, self.names, middle=middle)
        return results[:, self._rows, self._columns]

    def error_of_model(self, case: Case, addresses: list[str], values: Floats) -> Floats:
        """Error of the solution of each datum at one row of values: as stated, or as asked for."""
        return self._errors(case, self.quantities(case, addresses, values[None], self._stated())[0])

    def solved(
        self, case: Case, addresses: list[str], values: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Data of each row of values, shape (rows, n), errors of the first, contacts of each."""
        names = [*self.names, *self._stated(), "contacts"]
        found = self.quantities(case, addresses, values, names)
        n = len(self.names)
        data = found[:, self._rows, self._columns]
        return data, self._errors(case, found[0, :, n:-1]), found[:, self._rows, -1]

    def _stated(self) -> list[str]:
        """Columns of the errors of what was measured.

        What has no stated error of its own is as accurate, in parts of its size, as the rebound.
        """
        known = _library.columns(0)
        stated = [f"{name}_error" for name in self.names]
        return [name if name in known else "cor_sphere_error" for name in stated]

    def _errors(self, case: Case, stated: Floats) -> Floats:
        """Error of each datum by stated ones, shape (impacts, names): these, or as asked for."""
        own = np.array([f"{name}_error" in self._stated() for name in self.names])
        found = stated[self._rows, self._columns]
        found = found * np.where(own[self._columns], 1.0, self.scale)
        errors: Floats = np.fmax(number(case, "solver.accuracy") * self.scale, found)
        return errors

    def steps(self, case: Case, addresses: list[str], values: Floats, part: float) -> Floats:
        """Steps of an impact for each row of values, inf without a result.

        By the part of the impacts that are slower than it: 0 is the slowest one, 1 the fastest.
        """
        one = np.argsort(self.velocity)[[round(part * (len(self.velocity) - 1))]]
        found = self.quantities(case, addresses, values, [*self.names, "steps"], one)[:, 0]
        steps: Floats = np.where(np.isfinite(found).all(axis=1), found[:, -1], np.inf)
        return steps

    def quantities(
        self,
        case: Case,
        addresses: list[str],
        values: Floats,
        names: list[str],
        which: NDArray[np.intp] | slice = slice(None),
        middle: Floats | None = None,
    ) -> Floats:
        """Columns of all impacts or some, shape (rows of values, impacts, names).

        With `middle`, a row of values, each impact has one mesh, for differences.
        """
        settings = np.stack(list(self.settings.values()), axis=1)[which]
        m, n = len(values), len(settings)
        places = [*self.settings, *addresses]
        if middle is not None and case._has_mesh:
            parts = []
            for own in settings:
                settled = case._settled(places, np.concatenate([own, middle]))
                table = np.hstack([np.tile(own, (m, 1)), values])
                parts.append(settled._solve(places, table, names, 0)[0])
            return np.stack(parts, axis=1)
        table = np.hstack([np.tile(settings, (m, 1)), np.repeat(values, n, axis=0)])
        # an impact on a layer takes a thousand times as long as on a thin plate
        threads = 0 if len(table) >= 2000 or case["plate.waves"] == "body" else 1
        results, _ = case._solve(places, table, names, threads)
        return results.reshape(m, n, len(names))

    def _seen(self, case: Case) -> xr.Dataset:
        """How the impacts of a case are judged, and their contact times; kept for the same case."""
        if self._last is None or self._last[0] != case.text():
            names = ["validity", "validity_cause", "contact_time"]
            with warnings.catch_warnings(), unwarned(ValidityWarning):
                warnings.simplefilter("ignore", NoResultWarning)
                self._last = case.text(), case.points(self.settings, names, progress=False)
        return self._last[1]

    def validity(self, case: Case) -> list[tuple[str, str]]:
        """Whether the model holds, and the column that decides, of each impact."""
        found = self._seen(case)
        return [
            (str(one), str(cause))
            for one, cause in zip(found.validity.values, found.validity_cause.values, strict=True)
        ]

    def windows(self, case: Case) -> Floats:
        """First and last time [s] that the data see and temperature [K] (nan: of the case)."""
        times: Floats = self._seen(case).contact_time.values
        kelvin = self.settings.get("impact.temperature", np.full(len(times), np.nan))
        return np.stack([times / 100, times, kelvin], axis=1)[np.isfinite(times)]


class Record:
    """Force against time of one impact; its start and the zero of the sensor are unknown.

    The baseline is a constant that is found with the begin of the contact, for any parameters; a
    record whose largest deflection from it is negative is inverted.
    """

    #: Numbers that are found for any parameters: start and baseline
    unknowns = 2
    taken = ""

    def __init__(
        self, source: str, columns: Mapping[str, Floats], case: Case, written: Written = NO_DIGITS
    ) -> None:
        """Take the force, or acceleration times mass of the sphere, at rising times [N, m/s2, s].

        Columns of shape (n,), n >= 5 with finite numbers; settings of SETTINGS are those of the
        first row. InputError: fewer rows, times that do not rise, or no contact in them.
        """
        self.source = source
        self.settings = {
            address: float(columns[name][0])
            for name, address in SETTINGS.items()
            if name in columns
        }
        self.at, forces, factor = columns["time"], columns.get("force"), 1.0
        name = "force"
        if forces is None:
            name, factor = "acceleration", self._mass(case)
            forces = columns[name]
        good = np.isfinite(forces) & np.isfinite(self.at)
        self.at, forces = self.at[good], factor * forces[good]
        if len(self.at) < 5 or not (np.diff(self.at) > 0).all():
            raise InputError(f"{source}: expected five or more rising times with forces")
        # the ends of a record are outside the contact, or where it begins and ends
        edge = max(1, len(forces) // 20)
        zero = float(np.median(np.concatenate([forces[:edge], forces[-edge:]])))
        self.turned = float(np.max(forces)) - zero < zero - float(np.min(forces))
        self.value = -forces if self.turned else forces
        self.quantity = ["force"] * len(self.at)
        # an error relative to the value would take the zeros outside the contact as exact
        self.sigma = factor * _sigma(columns, name)[good]
        if not np.argmax(self.value):
            raise InputError(f"{source}: found the largest force at the first time, as in a "
                             "relaxation test, whose modulus is F/(A strain) with the area A; "
                             "expected a record of an impact, from its begin on")  # fmt: skip
        largest = float(np.max(self.value)) - (-zero if self.turned else zero)
        self.scale = np.full(len(self.at), largest)
        self.digit = factor * last_digit(columns[name], written.get(name))[good]
        self.place = [(t,) for t in self.at.tolist()]
        kelvin = self.settings.get("impact.temperature", math.nan)
        self.temperature = np.full(len(self.at), kelvin)
        #: Baseline that was found last [N]
        self.baseline = zero
        if not largest > 0:
            raise InputError(f"{source}: found a constant force, expected a record of an impact")

    def _mass(self, case: Case) -> float:
        """Mass of the sphere, by which its acceleration is a force."""
        impact = case.copy()
        for address, value in self.settings.items():
            impact[address] = value
        given = number(impact, "sphere.mass")
        if math.isfinite(given):
            return given
        density = number(impact, f"{impact['sphere.material']}.density")
        return 4 / 3 * math.pi * density * radius_of(impact) ** 3

    def predict(
        self, case: Case, addresses: list[str], values: Floats, middle: Floats | None = None
    ) -> Floats:
        """Data for each row of values at the addresses, shape (rows, n); nan without result."""
        impact = case.copy()
        for address, value in self.settings.items():
            impact[address] = value
        if middle is not None and case._has_mesh:
            impact = impact._settled(addresses, middle)
        return _one_by_one(self._force, impact, addresses, values, len(self.at))

    def error_of_model(self, case: Case, *_: Any) -> Floats:
        """Error of the solution of each datum, as asked for."""
        return number(case, "solver.accuracy") * self.scale

    def _force(self, case: Case) -> Floats:
        """The force from the start and on the baseline that fit best, by Gauss and Newton."""
        with unwarned():
            history = case.history()
        times, forces = history["time"].values, history["force"].values
        course = CubicSpline(times, forces)
        slope = course.derivative()
        start = float(self.at[np.argmax(self.value)] - times[np.argmax(forces)])
        for _ in range(30):
            t = self.at - start
            inside = (t > times[0]) & (t < times[-1])
            model = np.where(inside, course(t), 0.0)
            rate = np.where(inside, slope(t), 0.0)
            # the best baseline for a start is the mean misfit
            rate -= rate.mean()
            misfit = model - self.value
            change = float(rate @ (misfit - misfit.mean())) / max(float(rate @ rate), 1e-300)
            start += max(-0.2 * times[-1], min(0.2 * times[-1], change))
            if abs(change) < 1e-12 * times[-1]:
                break
        self.baseline = -float(misfit.mean())
        return model + self.baseline

    def said(self) -> str:
        """Remark on the record: how it was taken, and its baseline by the parameters tried last."""
        turned = ", inverted" * self.turned
        return (
            f"{self.taken or self.source}; force above a baseline of {self.baseline:.4g} N{turned}"
        )

    def windows(self, case: Case) -> Floats:
        """First and last time [s] that the data see and temperature [K] (nan: of the case)."""
        length = float(np.ptp(self.at[self.value - self.baseline > 0.01 * self.scale[0]]))
        return np.array([[length / 100, length, self.settings.get("impact.temperature", np.nan)]])


class Moduli:
    """Relaxation moduli, or storage and loss moduli, of a material, at one temperature or more."""

    unknowns = 0
    taken = ""
    #: Whether their frequencies were given in Hz
    hertz = False

    def __init__(
        self, source: str, columns: Mapping[str, Floats], material: str, case: Case,
        written: Written = NO_DIGITS,
    ) -> None:  # fmt: skip
        """Take moduli [Pa] > 0 at times [s] or angular frequencies [rad/s], shape (n,) each.

        `material` is the name in the case. Temperatures [K] that agree are those of the case if
        the material has no shift. InputError: a column is missing or not positive, or the case has
        no modulus there.
        """
        self.source, self.material = source, material
        self.dynamic = "frequency" in columns
        names = ["storage_modulus", "loss_modulus"] if self.dynamic else ["relaxation_modulus"]
        across = "frequency" if self.dynamic else "time"
        for name in (across, *names):
            if not (columns.get(name, np.empty(0)) > 0).all() or name not in columns:
                raise InputError(f"{source}: expected a column {name} with numbers > 0")
        self.points = columns[across]
        self.at = np.tile(self.points, len(names))
        self.quantity = [name for name in names for _ in self.points]
        self.value = np.concatenate([columns[name] for name in names])
        self.sigma = np.concatenate([_sigma(columns, name) for name in names])
        self.scale = np.abs(self.value)
        self.digit = np.concatenate(
            [last_digit(columns[name], written.get(name)) for name in names]
        )
        at = columns.get("temperature", np.full(len(self.points), np.nan))
        if case[f"{material}.shift"] is None and np.ptp(at) < SAME_TEMPERATURE:
            at = np.full(len(at), np.nan)
        #: Points at each temperature [K], nan: that of the case
        self.groups = {float(t): np.flatnonzero((at == t) | np.isnan(at)) for t in np.unique(at)}
        self.place = list(zip(self.points.tolist(), np.nan_to_num(at).tolist(), strict=True))
        self.place *= len(names)
        self.temperature = np.tile(at, len(names))
        self._moduli(case)

    def error_of_model(self, *_: Any) -> Floats:
        """Error of the modulus of each datum."""
        errors: Floats = ERROR_OF_MODULI * self.scale
        return errors

    def _moduli(self, case: Case) -> Floats:
        """Moduli of a case, which is changed."""
        found = np.empty(len(self.points), dtype=complex)
        for temperature, where in self.groups.items():
            if math.isfinite(temperature):
                case["impact.temperature"] = temperature
            material = case.material(self.material)
            read = material.complex_modulus if self.dynamic else material.relaxation
            found[where] = read(self.points[where])
        return np.concatenate([found.real, found.imag]) if self.dynamic else found.real

    def predict(
        self, case: Case, addresses: list[str], values: Floats, _: Floats | None = None
    ) -> Floats:
        """Data for each row of values at the addresses, shape (rows, n); nan without result."""
        return _one_by_one(self._moduli, case.copy(), addresses, values, len(self.at))

    def windows(self, case: Case) -> Floats:
        """First and last time [s] that the data see and temperature [K] (nan: of the case)."""
        times = 1 / self.points if self.dynamic else self.points
        return np.array([[times[i].min(), times[i].max(), t] for t, i in self.groups.items()])


#: Data of one file: `quantity`, what each datum is, `at`, its velocity, time or frequency in SI
#: units, `temperature` [K], nan: that of the case, `place`, all that it was measured at, `value`,
#: `scale`, the size that relative errors refer to, `digit`, the unit of its last digit, and
#: `sigma`, nan where there is no standard error; of shape (n,)
Block = Impacts | Record | Moduli


def _one_by_one(
    predict: Callable[[Case], Floats], case: Case, addresses: list[str], values: Floats, n: int
) -> Floats:
    """Data for each row of values at the addresses of a case, which is changed."""
    found = np.full((len(values), n), np.nan)
    for row, point in zip(found, values, strict=True):
        with contextlib.suppress(Error):
            for address, value in zip(addresses, point, strict=True):
                case[address] = float(value)
            row[:] = predict(case)
    return found


def _sigma(columns: Mapping[str, Floats], name: str) -> Floats:
    """Standard errors of a column, nan where there are none."""
    return columns.get(f"{name}_sigma", np.full(len(columns[name]), np.nan))


def window(blocks: Sequence[Block], case: Case, material: str) -> tuple[float, float]:
    """Times of a material that data see [s], at its reference temperature if it has a shift."""
    rows = np.vstack([block.windows(case) for block in blocks])
    if material and case[f"{material}.shift"] is not None:
        case, own = case.copy(), number(case, "impact.temperature")
        for row in rows:
            kelvin = float(row[2]) if math.isfinite(row[2]) else own
            if math.isfinite(kelvin):
                case["impact.temperature"] = kelvin
            row[:2] /= case.material(material).time_factor()
    return float(rows[:, 0].min()), float(rows[:, 1].max())


def last_digit(values: Floats, written: tuple[float, int] | None = None) -> Floats:
    """Unit of the last digit of each number of a column, shape (n,); nan where there is none.

    The column has a number of decimals, or one of significant digits: what a number lacks of them
    are zeros. Units turn the last ones of 16 digits, so 14 are looked at, unless it is known how
    the column is written: the unit of its last digit, and its most significant digits.
    """
    unit = np.full(len(values), np.nan)
    good = np.flatnonzero(np.isfinite(values) & (values != 0))
    if good.size:
        texts = [f"{abs(value):.13e}".split("e") for value in values[good]]
        digits = np.array([len(mantissa.replace(".", "").rstrip("0")) for mantissa, _ in texts])
        power = np.array([float(exponent) for _, exponent in texts])
        last, most = float((power - digits).min()) + 1, digits.max()
        if written:
            last, most = math.log10(written[0]), written[1]
        unit[good] = 10 ** np.maximum(last, power - most + 1)
        unit[values == 0] = 10**last
    return unit


def _as_velocities(
    source: str, columns: dict[str, Floats], case: Case, written: Written
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Heights and times in flight as velocities and coefficients of restitution.

    The second mapping has the units of the last digits of what was computed.
    """
    gravity = gravity_of(case)
    digits: dict[str, Floats] = {}

    def put(name: str, value: Floats, sigma: Floats, digit: Floats) -> None:
        """Set a column, its scatter where one is given, and the unit of its last digit."""
        columns[name], digits[name] = value, digit
        if not np.isnan(sigma).all():
            columns[f"{name}_sigma"] = sigma

    def take(name: str) -> tuple[Floats, Floats]:
        """Remove a column and its scatter, nan where none is given."""
        sigma = _sigma(columns, name)
        columns.pop(f"{name}_sigma", None)
        return columns.pop(name), sigma

    if "velocity" in columns and (columns["velocity"] < 0).all():
        columns["velocity"] = -columns["velocity"]
    if "drop_height" in columns:
        if "velocity" in columns:
            raise InputError(f"{source}: found both velocity and drop_height")
        columns["velocity"] = np.sqrt(2 * gravity * take("drop_height")[0])
    if "bounce_time" in columns:
        times, sigma = take("bounce_time")
        if not (times > 0).all():
            raise InputError(f"{source}: found a time in flight that is not > 0, expected times in "
                             "their order")  # fmt: skip
        if len(times) > 1 and (np.diff(times) > 0).all():
            raise InputError(f"{source}: found times that rise, expected times in flight, which "
                             "fall; times of the impacts belong under event_time")  # fmt: skip
        # the velocity of the drop, if it is given, and of each flight, which ends as it began
        drop = columns.pop("velocity", np.empty(0))
        drop = drop[np.isfinite(drop)]
        if drop.size and np.ptp(drop) > 1e-9 * np.max(drop):
            raise InputError(f"{source}: found several velocities or heights with the times of "
                             "one sequence of bounces, expected the first one")  # fmt: skip
        flights, sigmas = gravity * times / 2, gravity * sigma / 2
        speed = np.concatenate([drop[:1], flights])
        error = np.concatenate([np.zeros(len(drop[:1])), sigmas])
        if len(speed) < 2:
            raise InputError(f"{source}: expected two or more bounce times in their order")
        ratio = speed[1:] / speed[:-1]
        if drop.size and len(ratio) > 1 and not 1 / UNLIKE < ratio[0] / ratio[1] < UNLIKE:
            raise InputError(
                f"{source}: found a drop at {drop[0]:.4g} m/s that rebounds at {speed[1]:.4g} m/s "
                f"(cor {ratio[0]:.3g}), while the next cor is {ratio[1]:.3g}, expected a height "
                "that agrees with the times"
            )
        n = len(ratio)
        columns = {name: column[:n] for name, column in columns.items()}
        columns["velocity"] = speed[:-1]
        known = written.get("bounce_time")
        last = np.concatenate([np.zeros(len(drop[:1])), gravity * last_digit(times, known) / 2])
        sigma, digit = (
            ratio * np.hypot(part[1:] / speed[1:], part[:-1] / speed[:-1]) for part in (error, last)
        )
        put("cor_sphere", ratio, sigma, digit)
    if {"rebound_velocity", "rebound_height"} <= columns.keys():
        raise InputError(f"{source}: found both rebound_velocity and rebound_height")
    if "rebound_velocity" in columns:
        # a velocity after the impact has the other sign, if any
        rebound, sigma = take("rebound_velocity")
        rebound = np.abs(rebound)
        own = np.array(velocity_of(case))
        ratio = rebound / columns.get("velocity", own)
        digit = ratio * last_digit(rebound, written.get("rebound_velocity")) / rebound
        put("cor_sphere", ratio, ratio * sigma / rebound, digit)
    if "rebound_height" in columns:
        height, sigma = take("rebound_height")
        speed = columns.get("velocity", np.array(velocity_of(case)))
        ratio = np.sqrt(2 * gravity * height) / speed
        last = last_digit(height, written.get("rebound_height"))
        sigma, digit = (ratio * part / height / 2 for part in (sigma, last))
        put("cor_sphere", ratio, sigma, digit)
    return columns, digits


def observations(
    case: Case, source: Source, free: Sequence[str], choice: Choice | None = None
) -> list[Block]:
    """Data of a file or of columns, by what they are; a record of several impacts is one each."""
    materials = materials_of(free)
    about: dict[str, Any] = {"digits": NO_DIGITS, "hertz": False}
    if isinstance(source, Mapping):
        name = "data"
        columns, about["taken"] = _measured(arrays(source))
        if len({len(column) for column in columns.values()}) > 1:
            raise InputError("found columns of different lengths")
        lines = np.arange(len(next(iter(columns.values()), ()))) + 1
    else:
        name = os.fspath(source)
        columns, about, lines = read_columns(source, case, materials, choice)
    taken, written = about["taken"], about["digits"]
    for key, column in columns.items():
        wrong = np.isinf(column) | (key.endswith("_sigma") & (column <= 0))
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(f"{name}: row {row + 1}: found a {key} of {column[row]:.6g}, expected "
                             f"a finite one{' > 0' * key.endswith('_sigma')}")  # fmt: skip
    blocks: list[Block] = []
    if "time" in columns and ("force" in columns or "acceleration" in columns):
        parts, said = _single_impacts(name, columns, lines, case)
        for i, part in enumerate(parts, 1):
            own = name if len(parts) == 1 else f"{name}{IMPACT}{i})"
            blocks.append(Record(own, part, case, written))
        taken += said
    elif any(key in columns for key in ("relaxation_modulus", "storage_modulus")):
        if len(materials) != 1:
            raise InputError(f"{name}: moduli belong to the material of the free parameters, "
                             f"found {len(materials)} materials")  # fmt: skip
        moduli = Moduli(name, columns, materials[0], case.copy(), written)
        moduli.hertz = about["hertz"]
        blocks.append(moduli)
    else:
        blocks.append(Impacts(name, columns, case, written))
    blocks[0].taken = taken
    return blocks


def _measured(columns: dict[str, Floats]) -> tuple[dict[str, Floats], str]:
    """Columns without those that no one measures, whose errors are errors of data; what is left."""
    found: dict[str, Floats] = {}
    left = []
    for name, column in columns.items():
        if (stem := name.removesuffix("_error")) in columns and stem != name:
            found.setdefault(f"{stem}_sigma", column)
        elif name in COMPUTED:
            left.append(name)
        else:
            found[name] = column
    return found, f"data: not taken: {', '.join(left)}" * bool(left)


def read_columns(
    path: str | os.PathLike[str],
    case: Case,
    materials: Sequence[str] = (),
    choice: Choice | None = None,
) -> tuple[dict[str, Floats], dict[str, Any], NDArray[np.intp]]:
    """Columns of a file, what `read_data` says of them, and the line of each row.

    Moduli are tensile by Poisson's ratio of the first material.
    """

    def unit_of(address: str) -> str:
        """SI unit of the value at an address."""
        return case._describe(address).unit

    data = read_data(path, choice, unit_of=unit_of)
    if data.attrs["kind"] in ("dynamic", "relaxation"):
        ratios = [number(case, f"{name}.poisson_ratio") for name in materials]
        data = tensile(data, ratios[0] if ratios else None)
        parts = curves(data)
        for part in parts:
            part["temperature"] = part.attrs["temperature"]
        data = pd.concat(parts)
        data.attrs = parts[0].attrs
    lines = data.index.to_numpy(dtype=np.intp)
    return _arrays(data), data.attrs, lines


def _single_impacts(
    source: str, columns: dict[str, Floats], lines: NDArray[np.intp], case: Case
) -> tuple[list[dict[str, Floats]], str]:
    """Records of one impact each, and what is said of them if they are several.

    A column of velocities that differ is that of each impact. Else a ball bounces: an impact after
    the first has the velocity g T/2 that the flight T before it ends with.
    """
    name = "force" if "force" in columns else "acceleration"
    good = np.flatnonzero(np.isfinite(columns["time"]) & np.isfinite(columns[name]))
    pulses = _pulses(columns["time"][good], columns[name][good])
    if len(pulses) < 2:
        return [columns], ""
    # half way between two impacts one record ends and the next one begins
    middles = [(one.last + other.first) // 2 for one, other in itertools.pairwise(pulses)]
    cuts = [0, *good[middles].tolist(), len(columns["time"])]
    parts = [
        {key: column[begin:end] for key, column in columns.items()}
        for begin, end in itertools.pairwise(cuts)
    ]
    stated = columns.get("velocity", np.array([velocity_of(case)]))
    how = "of their column"
    speeds = [float(stated[min(good[one.first], len(stated) - 1)]) for one in pulses]
    if np.ptp(stated) == 0:
        how = "by the times in flight"
        flights = [other.begin - one.end for one, other in itertools.pairwise(pulses)]
        speeds = [float(stated[0]), *(gravity_of(case) * time / 2 for time in flights)]
        rises = [i for i, step in enumerate(np.diff(speeds), 1) if not step < 0]
        if rises:
            i = rises[0]
            rows = f"{lines[0]}:{lines[cuts[1] - 1]}"
            raise InputError(
                f"{source}:{lines[good[pulses[i].first]]}: found impact {i + 1} of {len(pulses)} "
                f"in one record, no bounce, which would come at {speeds[i]:.3g} m/s by its time "
                f"in flight after {speeds[i - 1]:.3g} m/s; expected a column of the velocity of "
                f"each, or a single impact: {option('where', {'line': rows})} takes the first"
            )
    for part, pulse, speed in zip(parts, pulses, speeds, strict=True):
        # beyond some lengths of the pulse there is only the baseline
        length = BESIDE_PULSE * (pulse.end - pulse.begin)
        time = part["time"]
        near = (time >= pulse.begin - length) & (time <= pulse.end + length)
        for key, column in part.items():
            part[key] = column[near]
        part["velocity"] = np.full(int(near.sum()), speed)
    told = ", ".join(f"{speed:.4g}" for speed in speeds)
    return parts, f"; {len(parts)} impacts at {told} m/s, {how}"


@dataclass(frozen=True)
class _Pulse:
    """The force of an impact in a record."""

    #: First and last point of the largest forces
    first: int
    last: int
    #: Times at which the contact begins and ends [s]
    begin: float
    end: float


def _pulses(time: Floats, force: Floats) -> list[_Pulse]:
    """The impacts of a record."""
    if len(time) < 5:
        return []
    force = force - np.median(force)
    force = force * np.sign(force[np.argmax(np.abs(force))])
    if not force.max() > 0:
        return []
    # above ten standard deviations of the baseline, by the median of its noise
    noise = 10 * 1.4826 * float(np.median(np.abs(force)))
    high = np.flatnonzero(force > max(LEAST_PULSE * force.max(), min(noise, PULSE * force.max())))
    runs = np.split(high, np.flatnonzero(np.diff(high) > 1) + 1)
    longest = max(time[run[-1]] - time[run[0]] for run in runs)
    apart = [
        i for i in range(1, len(runs)) if time[runs[i][0]] - time[runs[i - 1][-1]] > APART * longest
    ]
    if not longest > 0 or not apart:
        return []
    # contacts that follow one another at once belong to one impact
    groups = [runs[i:j] for i, j in itertools.pairwise([0, *apart, len(runs)])]
    # the contact is where the force is above the noise of the baseline
    found = []
    for group in groups:
        first, last = int(group[0][0]), int(group[-1][-1])
        edge = max(noise / 2, TOUCH * float(force[first : last + 1].max()))
        low = np.flatnonzero(force <= edge)
        before, after = low[low < first], low[low > last]
        begin = time[before[-1]] if before.size else time[0]
        end = time[after[0]] if after.size else time[-1]
        found.append(_Pulse(first, last, float(begin), float(end)))
    return found


def _arrays(data: pd.DataFrame) -> dict[str, Floats]:
    """Columns as arrays, without the numbers of sets."""
    return {str(key): data[key].to_numpy(dtype=float) for key in data if key != "set"}


def materials_of(addresses: Sequence[str]) -> list[str]:
    """Names of the materials that addresses belong to."""
    names = dict.fromkeys(address.rpartition(".")[0] for address in addresses)
    groups = ("impact", "sphere", "plate", "target", "contact")
    return [name for name in names if name not in groups]


def gravity_of(case: Case) -> float:
    """Gravity that a drop of the case has [m/s2]."""
    given = number(case, "impact.gravity")
    return given if given > 0 else GRAVITY


def velocity_of(case: Case) -> float:
    """Velocity of the impact of a case [m/s], given or by its drop height."""
    if case["impact.drop_height"] is None:
        return number(case, "impact.velocity")
    return math.sqrt(2 * gravity_of(case) * number(case, "impact.drop_height"))


def sharpen(case: Case, accuracy: float) -> None:
    """Solve a case to an accuracy; with waves = 'body' to BODY_ACCURACY."""
    if case["plate.waves"] == "body":
        accuracy = BODY_ACCURACY
    given = case["solver.accuracy"]
    wanted = accuracy if given is None else min(accuracy, number(case, "solver.accuracy"))
    case["solver.accuracy"] = wanted
