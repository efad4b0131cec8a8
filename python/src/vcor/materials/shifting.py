"""Shift factors of moduli at several temperatures, and the laws they follow.

Neighbouring temperatures are shifted along the logarithm of frequency (or minus that of time) until
one polynomial of fourth degree goes through both curves of each modulus. Storage and loss modulus
of a curve count by the covariance of their scatter, and so does the loss tangent, their ratio:
where they scatter together it is known better than either. A storage modulus that is flat says
nothing about the shift; the loss modulus of a rubber does.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, minimize_scalar

from .._library import Error, Floats, NumericalError
from ..case import Case
from ..units import ZERO_C

#: Degree of the polynomial in the logarithm of frequency that two curves share
DEGREE = 4
#: Standard errors by which a shift has to differ from one that makes the warmer material slower
UNSURE = 3.0
#: Smallest scatter of a curve that is believed, and that of one of few points, relative
LEAST_SCATTER, FEW_SCATTER = 1e-3, 0.02
#: Largest misfit of the steps, in standard errors, of a law that stands for the table
FOLLOWS = 2.0
#: Standard errors of the shift of the storage moduli within which the loss moduli have to agree
AGREE = 3.0
#: Relative standard error from which on a constant of a law is not determined
UNDETERMINED = 1 / 3
#: Step of 1/C2 for its slope, in parts of the reciprocal of the span of the temperatures: the
#: curvature that it adds is this part of the shift, far above rounding errors
STEP_OF_WLF = 1e-4
#: Logarithm of a factor that leaves nothing of a shift in double precision
NO_SHIFT = 50.0
#: Least change of ln a_T between temperatures, far below what data resolve
NO_STEP = 1e-6
#: Reduction of the sum of squares, in variances, from which on moduli follow the temperature
VERTICAL = 9.0
#: Case with a material whose times follow a law
_CASE = """&impact velocity = 1.0 /
&sphere radius = 1.0, mass = 1.0, material = 'm' /
&plate material = 'm', waves = 'none' /
&material name = 'm', model = 'sls', glassy_modulus = 2.0, alpha = 1.0, beta = 2.0,
poisson_ratio = 0.5, shift = '{}', reference_temperature = {!r}{} /
"""


@dataclass(frozen=True)
class Curve:
    """Moduli at one temperature."""

    #: Temperature [K]
    temperature: float
    dynamic: bool
    #: Angular frequency [rad/s] or time [s], shape (n,)
    at: Floats
    #: Storage and loss modulus, or relaxation modulus [Pa], shape (1 or 2, n)
    moduli: Floats
    #: Whether the temperature is given in degrees Celsius
    celsius: bool = True
    #: Whether figures show the frequency in Hz, as the data have it
    hertz: bool = False

    @property
    def x(self) -> Floats:
        """Logarithm of the frequency, or of the reciprocal of the time, rising."""
        return np.log(self.at) if self.dynamic else -np.log(self.at)

    @property
    def storage(self) -> Curve:
        """The first modulus alone."""
        return dataclasses.replace(self, moduli=self.moduli[:1])

    @property
    def place(self) -> str:
        """The temperature as it was given."""
        if self.celsius:
            return f"{round(self.temperature - ZERO_C, 2) + 0.0:g} C"
        return f"{self.temperature:.2f} K"

    def whitening(self) -> Floats:
        """Matrix that makes the logarithms of moduli independent numbers with a scatter of 1.

        The scatter is that about parabolas.
        """
        y, unit = np.log(self.moduli), np.eye(len(self.moduli))
        if len(self.at) < 5:
            return unit / FEW_SCATTER
        rest = y - np.array([np.polyval(np.polyfit(self.x, row, 2), self.x) for row in y])
        covariance = rest @ rest.T / (len(self.at) - 3) + LEAST_SCATTER**2 * unit
        found: Floats = np.linalg.inv(np.linalg.cholesky(covariance))
        return found


@dataclass(frozen=True)
class Step:
    """Change of ln a_T from a colder to a warmer curve."""

    #: nan if the curves do not determine it
    value: float = math.nan
    variance: float = math.nan
    #: Weighted sum of squares, infinite for curves that do not overlap, and its degrees of freedom
    squares: float = 0.0
    dof: int = 0
    #: Why there is none
    reason: str = ""
    #: Said where storage and loss moduli do not agree
    apart: str = ""


@dataclass(frozen=True)
class _Trial:
    """Steps between neighbours by all their moduli and by the storage moduli alone."""

    every: Step
    storage: Step

    @property
    def agree(self) -> bool:
        """Whether all moduli give the step that the storage moduli give.

        Where these are too flat to determine one, the step of all must differ from 0.
        """
        every, storage = self.every, self.storage
        if every.reason or storage.reason:
            return not every.reason and every.value < -2 * math.sqrt(every.variance)
        return abs(every.value - storage.value) <= AGREE * math.sqrt(storage.variance)


def _trial(cold: Curve, warm: Curve, vertical: bool) -> _Trial:
    """The steps between neighbours; with `vertical` moduli are proportional to the temperature."""
    every = _step(cold, warm, vertical)
    return _Trial(every, _step(cold.storage, warm.storage, vertical) if cold.dynamic else every)


def _step(cold: Curve, warm: Curve, vertical: bool) -> Step:
    """The step by all moduli of the curves."""
    up = math.log(warm.temperature / cold.temperature) if vertical else 0.0
    middle, span = np.mean(cold.x), np.ptp(cold.x) + np.ptp(warm.x)
    degree = min(DEGREE, (len(cold.at) + len(warm.at)) // 2 - 1)
    weights = cold.whitening(), warm.whitening()
    moduli = np.log(cold.moduli), np.log(warm.moduli) - up
    y = np.concatenate([(w @ one).ravel() for w, one in zip(weights, moduli, strict=True)])

    def misfits(shifts: Floats) -> Floats:
        """Weighted sum of squares about polynomials through both curves for each shift."""
        powers = np.arange(degree + 1)
        rows = []
        for weight, x in zip(weights, (cold.x[None], warm.x + shifts[:, None]), strict=True):
            basis = ((x - middle) / span)[..., None] ** powers
            both = np.einsum("ab,snp->sanbp", weight, basis)
            both = both.reshape(len(basis), weight.shape[0] * x.shape[1], -1)
            rows.append(np.broadcast_to(both, (len(shifts), *both.shape[1:])))
        q = np.linalg.qr(np.concatenate(rows, axis=1))[0]
        rest = y - (q @ (y @ q)[..., None])[..., 0]
        squares: Floats = np.sum(rest**2, axis=1)
        return squares

    def misfit(shift: float) -> float:
        """Sum of squares for one shift."""
        return float(misfits(np.array([shift]))[0])

    # a warmer material is faster: its curve belongs to lower frequencies of the colder one, or to
    # those below them
    trials = np.linspace(cold.x[0] - warm.x[-1], 0.1 * span, 301)
    values = misfits(trials)
    best = int(np.argmin(values))
    dof = max(1, len(y) - len(cold.moduli) * (degree + 1) - 1)
    kind = "storage" if cold.dynamic else "relaxation"
    pair = f"the {kind} moduli at {cold.place} and {warm.place}"
    noise = max(values[best] / dof, 1.0)
    if values[-1] < values[best] + UNSURE**2 * noise:
        reason = f"{pair} are too flat for their scatter to determine the shift between them"
        return Step(reason=reason + ", and so are the loss moduli" * cold.dynamic)
    if best in (0, len(trials) - 1):
        reason = f"{pair} have none in common, by which alone they are shifted; expected more "
        reason += f"{'frequencies' if cold.dynamic else 'times'}, or temperatures between"
        return Step(reason=reason, squares=math.inf)
    h = trials[1] - trials[0]
    found = minimize_scalar(misfit, bounds=(trials[best] - h, trials[best] + h), method="bounded",
                            options={"xatol": 1e-8})  # fmt: skip
    curvature = (misfit(found.x + h) + misfit(found.x - h) - 2 * found.fun) / h**2
    noise = max(found.fun / dof, 1.0)
    # a material takes only shift factors that fall
    value = min(float(found.x), -NO_STEP)
    return Step(value, float(2 * noise / curvature), float(found.fun), dof)


def steps_of(curves: Sequence[Curve], vertical: bool | None = None) -> tuple[list[Step], bool]:
    """Steps between neighbours, and whether the moduli are proportional to the temperature too.

    The sum of squares of all moduli decides, unless `vertical` is given. The loss
    moduli of a pair count in it unless they contradict the storage moduli either way, as those of a
    glass, which are often those of the instrument.
    """
    pairs = list(zip(curves[:-1], curves[1:], strict=True))
    trials = [[_trial(*pair, way) for way in (False, True)] for pair in pairs]
    if vertical is None:
        compared = [
            [way.every if any(one.agree for one in trial) else way.storage for way in trial]
            for trial in trials
        ]
        seen = [
            ways for ways in compared if not any(one.reason and not one.squares for one in ways)
        ]
        plain, shifted = (sum(ways[i].squares for ways in seen) for i in (0, 1))
        noise = max(1.0, shifted / max(1, sum(ways[1].dof for ways in seen)))
        vertical = plain > shifted + VERTICAL * noise
    found = []
    for pair, trial in zip(pairs, trials, strict=True):
        chosen = trial[vertical]
        step = chosen.every if chosen.agree or not pair[0].dynamic else chosen.storage
        if math.isinf(step.squares):
            raise NumericalError(step.reason)
        if not (step is chosen.every or step.reason):
            said = "give another shift than the storage moduli, by which alone they are shifted"
            places = f"{pair[0].place} and {pair[1].place}"
            step = dataclasses.replace(step, apart=f"the loss moduli at {places} {said}")
        found.append(step)
    return found, vertical


@dataclass(frozen=True)
class Law:
    """A law of the shift factors, with standard errors."""

    name: str
    values: dict[str, float]
    errors: dict[str, float]
    #: Root of the mean square of the misfit of the steps of log10 a_T
    rms: float
    #: The same of the misfit in standard errors, by the degrees of freedom
    misfit: float = math.inf
    #: Ratio of the constants of WLF [1/K] and its standard error, which is known better than they
    ratio: tuple[float, float] = (math.nan, math.nan)

    @property
    def determined(self) -> bool:
        """Whether the data determine the constants."""
        return all(self.errors[key] < UNDETERMINED * one for key, one in self.values.items())

    def log_shift(self, t: Floats, reference: float) -> Floats:
        """log10 a_T at temperatures [K]."""
        return log_shift(self.values, t, reference)


def log_shift(values: Mapping[str, float], t: Floats, reference: float) -> Floats:
    """log10 a_T by the constants of a law; nan if they do not allow all temperatures."""
    return _Shifts(values, t, reference)(values)


class _Shifts:
    """log10 a_T of a material at temperatures, by constants of a law that change from call to call.

    Parameters
    ----------
    keys
        Keys of the constants.
    t
        Temperatures [K], shape (n,).
    reference
        Reference temperature [K].
    """

    def __init__(self, keys: Iterable[str], t: Floats, reference: float) -> None:
        """Make a case with such a material; the constants come with each call."""
        constants = "".join(f", {key} = 1.0" for key in keys)
        law = "wlf" if "wlf_c1" in constants else "arrhenius"
        self._case = Case(_CASE.format(law, reference, constants))
        self._material = self._case.material("m")
        self._t = t

    def __call__(self, values: Mapping[str, float]) -> Floats:
        """log10 a_T, shape (n,); nan if the constants do not allow all temperatures."""
        try:
            for key, value in values.items():
                self._case[f"m.{key}"] = value
            found: Floats = np.log10(self._material.time_factors(self._t))
        except Error:
            return np.full(len(self._t), np.nan)
        return found


def _errors_of_wlf(
    misfit: Callable[[Floats], Floats], x: Floats, span: float
) -> tuple[Floats, float]:
    """Relative errors of C1 and C2 and of their ratio, at their logarithms x, for data of error 1.

    In k = C1/C2 and u = 1/C2 the law is log10 a_T = -k (T - T0)/(1 + u (T - T0)). Both slopes stay
    finite where the best C2 is infinite, u = 0: shift factors that are straight, or bend the other
    way. In C1 and C2 they vanish there, and a covariance is one of rounding errors.
    """
    k, u = x[0] - x[1], math.exp(-x[1])
    # the slope against ln k is exact, as the law is proportional to k
    at = [
        misfit(np.array([k - math.log(one), -math.log(one)])) for one in (u, u + STEP_OF_WLF / span)
    ]
    zero = misfit(np.array([x[0] - 50.0, x[1]]))
    slopes = np.stack([at[0] - zero, (at[1] - at[0]) * span / STEP_OF_WLF], axis=1)
    covariance = np.linalg.inv(slopes.T @ slopes)
    # ln C1 = ln k - ln u and ln C2 = -ln u
    turn = np.array([[1.0, -1.0 / u], [0.0, -1.0 / u]])
    errors: Floats = np.sqrt(np.diag(turn @ covariance @ turn.T))
    return errors, math.sqrt(covariance[0, 0])


def laws_of(temperatures: Floats, steps: Floats, errors: Floats, reference: float) -> list[Law]:
    """Laws by least squares of the steps of log10 a_T, whose errors are independent.

    Steps that are nan are left out, and laws with more constants than there are steps.
    """
    seen, found = np.isfinite(steps), []
    starts = {
        "WLF": {"wlf_c1": 17.44, "wlf_c2": 51.6 - float(np.min(temperatures - reference))},
        "Arrhenius": {"activation_energy": 1e5},
    }
    for name, start in starts.items():
        if seen.sum() < len(start):
            continue

        shifts = _Shifts(start, temperatures, reference)

        def misfit(x: Floats, start: dict[str, float] = start, shifts: _Shifts = shifts) -> Floats:
            """Residuals of the steps between temperatures, over their errors, for logarithms x."""
            law = np.diff(shifts(dict(zip(start, np.exp(x).tolist(), strict=True))))
            found: Floats = ((law - steps) / errors)[seen]
            return found

        begin = np.log(list(start.values()))
        if not np.isfinite(misfit(begin)).all():
            continue
        best = least_squares(misfit, begin, max_nfev=500)
        values = np.exp(best.x)
        square = 2 * best.cost / max(int(seen.sum()) - len(start), 1)
        rms = float(np.sqrt(np.mean((misfit(best.x) * errors[seen]) ** 2)))
        ratio = (math.nan, math.nan)
        if name == "WLF":
            relative, slope = _errors_of_wlf(misfit, best.x, float(np.ptp(temperatures)))
            slope *= math.sqrt(max(1.0, square))
            ratio = values[0] / values[1], values[0] / values[1] * slope
        else:
            relative = np.sqrt(np.diag(np.linalg.pinv(best.jac.T @ best.jac)))
        deviations = dict(zip(start, values * relative * math.sqrt(max(1.0, square)), strict=True))
        constants = dict(zip(start, values.tolist(), strict=True))
        found.append(Law(name, constants, deviations, rms, math.sqrt(square), ratio))
    return found
