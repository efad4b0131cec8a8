"""Contact laws of other programs: their own restitution and contact time, and fits of them to e(v).

In a program of discrete elements two bodies of reduced mass m meet with the force
F = K s^n + C s^p s' of their overlap s. Here this law is solved, not that of vcor.
"""

from __future__ import annotations

import bisect
import functools
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from .._library import Floats, NumericalError

#: Relative error of the solutions of a law
ACCURACY = 1e-9
#: Logarithms of the dampings that are solved, as multiples of a step: the first and the last among
#: which that of a fit is sought. All fits of a law share the solutions. With splines through them
#: parameters differ by at most 2e-6 from those with a step of 0.02
STEP, FIRST, LAST = 0.1, -207, 34
#: Longest contact, in units of a law's own time
LONGEST = 100.0


@dataclass(frozen=True)
class Law:
    """Force K s^n + C s^p s'. A clipped one never pulls: contact ends with the force."""

    name: str
    n: float
    p: float
    clipped: bool = False

    @property
    def critical(self) -> float:
        """C/sqrt(m K) where a contact with constant e never ends; a program is given e by it."""
        return 2 * math.sqrt((self.n + 1) / 2)

    @property
    def end(self) -> str:
        """How a contact ends."""
        if self.clipped:
            return "never pulls, ends with the force"
        return "may pull, ends with the overlap"

    @functools.cache  # noqa: B019  (a law is one of few, and inputs of a case solve the same)
    def bounce(self, damping: float) -> tuple[float, float]:
        """Restitution and contact time of s'' = -s^n - damping s^p s', s(0) = 0, s'(0) = 1."""

        def rate(_: float, y: Floats) -> tuple[float, float]:
            """Derivatives of indentation and velocity in the scales of the law."""
            s = max(y[0], 0.0)
            return y[1], -(s**self.n) - damping * s**self.p * y[1]

        def end(_: float, y: Floats) -> float:
            """A number that is 0 at the end of the contact: force over s^p if clipped, else s."""
            force: float = max(y[0], 0.0) ** (self.n - self.p) + damping * y[1]
            return force if self.clipped else y[0]

        end.terminal, end.direction = True, -1  # type: ignore[attr-defined]
        done = solve_ivp(rate, (0, LONGEST), (0.0, 1.0), "DOP853", events=end,
                         rtol=ACCURACY, atol=1e-3 * ACCURACY)  # fmt: skip
        if not len(done.t_events[0]):
            return 0.0, LONGEST
        return -float(done.y_events[0][0][1]), float(done.t_events[0][0])

    def fit(self, velocity: Floats, cor: Floats, time: Floats, mass: float) -> Twin:
        """Parameters with the smallest largest misfit: C by e(v), then K by the contact times.

        With T = (m v^(1-n)/K)^(1/(n+1)) for the time, the law has the damping
        b = C v^p T^(p+1)/m = b_1 v^q alone.
        """
        q = self.p - (1 + self.p) * (self.n - 1) / (self.n + 1)
        middle = math.exp(float(np.log(velocity).mean()))
        power = q * np.log(velocity / middle)
        wanted = (cor.max() + cor.min()) / 2
        tried = range(FIRST, LAST + 1)
        # the first that is damped enough
        start = bisect.bisect_left(
            tried, True, key=lambda i: self.bounce(math.exp(STEP * i))[0] <= wanted
        )
        if start == len(tried):
            raise NumericalError(f"e = {wanted:.3g} is too small for a {self.name}")
        room = 0.5 + np.ptp(power)
        around = STEP * tried[start] + np.array([power.min() - room, power.max() + room])
        first, last = math.floor(around[0] / STEP), math.ceil(around[1] / STEP)
        found = np.array([self.bounce(math.exp(STEP * i)) for i in range(first, last + 1)])
        kept = found[:, 0] > 0
        nodes, found = STEP * np.arange(first, last + 1)[kept], found[kept]
        # -ln(e)/b and ln(t) are smooth, and level for small dampings
        loss = CubicSpline(nodes, -np.log(found[:, 0]) / np.exp(nodes))
        duration = CubicSpline(nodes, np.log(found[:, 1]))

        def restitution(x: float) -> Floats:
            """Restitution at the velocities, shape (n,)."""
            e: Floats = np.exp(-loss(x + power) * np.exp(x + power))
            return np.minimum(e, 1.0)

        def balance(x: float) -> float:
            """Sum of the largest misfits above and below, 0 at the best place."""
            misfit = restitution(x) - cor
            return float(misfit.max() + misfit.min())

        low, high = nodes[0] - power.min(), nodes[-1] - power.max()
        best = float(brentq(balance, low, high)) if balance(low) > 0 else low
        ratio = time / np.exp(duration(best + power))
        scale = ratio * velocity ** ((self.n - 1) / (self.n + 1))
        unit = math.sqrt(scale.max() * scale.min())
        damping = math.exp(best - q * math.log(middle))
        return Twin(
            law=self,
            mass=mass,
            stiffness=mass / unit ** (self.n + 1),
            damping=damping * mass / unit ** (self.p + 1),
            cor=restitution(best),
            time=time / scale * unit,
            misfit=float(np.abs(restitution(best) - cor).max()),
            time_misfit=float(np.abs(unit / scale - 1).max()),
        )


@dataclass(frozen=True)
class Twin:
    """A law with the parameters that fit best."""

    law: Law
    #: Reduced mass [kg], K [N/m^n], C [N s/m^(p+1)]
    mass: float
    stiffness: float
    damping: float
    #: e and contact time [s] of the law at the velocities
    cor: Floats
    time: Floats
    #: Largest misfit of e, and of the contact time relative to it
    misfit: float
    time_misfit: float

    @property
    def entered(self) -> float:
        """Restitution to give to a program so that it has this C; without clipping, e itself."""
        share = self.damping / math.sqrt(self.mass * self.stiffness) / self.law.critical
        return math.exp(-math.pi * share / math.sqrt(1 - share**2)) if share < 1 else math.nan


LINEAR = Law("linear spring and dashpot", 1, 0)
HERTZ = Law("Hertz spring with a dashpot of constant e", 1.5, 0.25)
VISCOELASTIC = Law("Kelvin-Voigt solid in Hertz' contact", 1.5, 0.5)
#: By their names in templates/programs.toml
LAWS = {"linear": LINEAR, "hertz": HERTZ, "viscoelastic": VISCOELASTIC}
