"""Receding contacts that grow again, by the method of dimensionality reduction (MDR).

An axisymmetric frictionless contact with a viscoelastic half space is a row of independent springs
(V. L. Popov and M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction,
2015). The one that the body touches at the indentation sigma carries

    phi = int_0^t k(t - x) dw(x) + viscosity w',   k = G_0 + sum_i G_i exp(-l_i t)

with w = s - sigma where it is pressed and phi = 0 where it is free, so w = max(s - sigma, free
position), and F = int max(0, phi) u''(sigma) dsigma with u = s^n. Nothing else is assumed: the
contact may grow and shrink as often as it likes.

Method. Springs at fixed sigma ~ i^2, each with its internal variables, exact for w linear in a time
step; a dashpot by the parabola through the last two steps; F as the integral of the positive part
of a polygon times u'', the motion by trapezoids, steps t ~ i^2 at first. Errors fall with the
square of the steps; runs with halved steps and springs are extrapolated, and the digits are what
the extrapolations of the coarser and of the finer runs have in common. vcor shares nothing of this
but the springs: it takes the force from one sum over the past of int w u'' dsigma, on equal steps.

Usage: regrowth.py        needs numpy; prints the numbers of tests/unit/test_springs.f90, 3 minutes
"""

import math

import numpy as np


class Impact:
    """An impact on a plate by `constant`, `relaxing` or `hereditary` waves of an SLS."""

    def __init__(
        self,
        glassy,
        rubbery,
        rate,
        half_thickness,
        waves,
        velocity,
        poisson=0.45,
        density=1100.0,
        viscosity=0.0,
        gravity=0.0,
        power=1.5,
        radius=0.01,
    ):
        strain = 1 / (1 - poisson**2)
        self.mass = 4 / 3 * math.pi * radius**3 * 7800.0
        self.v0, self.gravity, self.n, self.waves = velocity, gravity, power, waves
        self.rate, self.rest = rate, rubbery / glassy
        factor = 4 / 3 * math.sqrt(radius) * strain
        self.spring, self.mode, self.viscosity = (
            factor * rubbery,
            factor * (glassy - rubbery),
            factor * viscosity,
        )
        self.alpha0 = math.sqrt(3 * density / (glassy * strain)) / (
            16 * density * half_thickness**2
        )
        # (E(0)/Q)^(1/2) = ((s + l)/(s + l r))^(1/2) by Gauss and Chebyshev's rule, third kind
        angle = np.arange(1, 41) * np.pi / 81
        self.memory_rate = rate * (self.rest + (1 - self.rest) * np.cos(angle) ** 2)
        self.memory = self.alpha0 * 2 / 81 * np.sin(angle) ** 2 * rate * (1 - self.rest)

    def alpha(self, t):
        """alpha and its rate."""
        if self.waves != "relaxing":
            return self.alpha0, 0.0
        part = (1 - self.rest) * math.exp(-self.rate * t)
        e = self.rest + part
        return self.alpha0 / math.sqrt(e), 0.5 * self.alpha0 * self.rate * part / e**1.5


def shares(rate, h):
    """q' = rate (w - q) with w linear: q_new = e q + a w + b w_new."""
    x = rate * h
    mean = -np.expm1(-x) / x
    return np.exp(-x), mean - np.exp(-x), 1 - mean


class Springs:
    """The springs of a contact."""

    def __init__(self, p, deepest, count):
        self.p = p
        self.sigma = deepest * (np.arange(count + 1) / count) ** 2
        self.u, self.du = self.sigma**p.n, p.n * self.sigma ** (p.n - 1)
        self.w, self.moved, self.q = np.zeros((3, self.sigma.size))
        self.last = 0.0

    def step(self, h):
        """Go on by a step: phi = stiff (s - level) where it is positive."""
        p = self.p
        e, a, self.b = shares(p.rate, h)
        self.known = e * self.q + a * self.w
        stiff, load = p.spring + p.mode * (1 - self.b), -p.mode * self.known
        if p.viscosity > 0:
            ratio = h / self.last if self.last else 0.0
            one = p.viscosity * (1 + 2 * ratio) / (1 + ratio) / h
            other = p.viscosity * ratio / (1 + ratio) / self.last if self.last else 0.0
            stiff, load = stiff + one, load - one * self.w - other * self.moved
        self.last, self.stiff, self.level = h, stiff, self.sigma - load / stiff

    def force(self, s):
        """Force and its slope by s."""
        x, sigma, u, du = s - self.level, self.sigma, self.u, self.du
        a, b = x[:-1], x[1:]
        tilt = (b - a) / np.diff(sigma)
        pressed, cut = (a > 0) & (b > 0), (a > 0) != (b > 0)
        value = (b * du[1:] - a * du[:-1] - tilt * np.diff(u))[pressed].sum()
        slope = np.diff(du)[pressed].sum()
        for i in np.flatnonzero(cut):
            zero = sigma[i] - a[i] / tilt[i]
            u0, du0 = zero**self.p.n, self.p.n * zero ** (self.p.n - 1)
            if a[i] > 0:
                value += -a[i] * du[i] - tilt[i] * (u0 - u[i])
                slope += du0 - du[i]
            else:
                value += b[i] * du[i + 1] - tilt[i] * (u[i + 1] - u0)
                slope += du[i + 1] - du0
        return self.stiff * value, self.stiff * slope

    def accept(self, s):
        """Take the indentation in."""
        new = np.maximum(s, self.level) - self.sigma
        self.moved, self.w = new - self.w, new
        self.q = self.known + self.b * new


def run(p, duration, deepest, steps):
    """cor, cor_sphere, contact time; largest indentation and how often the contact grew again."""
    x = np.arange(60 * steps + 1) / steps
    times = duration * 1.05 * x**2 / (x + 0.05)
    springs = Springs(p, 1.01 * deepest, steps // 2)
    memory = np.zeros(p.memory.size)
    s = force = impulse = second = deflection = speed = deep = 0.0
    nodes, edge, growths, shrinking = [], -1, 0, False
    for t, h in zip(times[1:], np.diff(times)):
        springs.step(h)
        alpha, alpha_rate = p.alpha(t)
        # s = known - per_force F
        impulse_known = impulse + h / 2 * force
        known = (
            p.v0 * t + p.gravity * t**2 / 2 - (second + h / 2 * (impulse + impulse_known)) / p.mass
        )
        per_force = h**2 / 4 / p.mass
        if p.waves == "hereditary":
            e, a, b = shares(p.memory_rate, h)
            memory_known, own = e * memory + a / p.memory_rate * force, b / p.memory_rate
            known -= deflection + h / 2 * (speed + p.memory @ memory_known)
            per_force += h / 2 * (alpha + p.memory @ own)
        else:
            known -= alpha * impulse_known
            per_force += alpha * h / 2
        for _ in range(60):
            value, slope = springs.force(s)
            change = (s + per_force * value - known) / (1 + per_force * slope)
            s -= change
            if abs(change) <= 1e-14 * deepest:
                break
        last, force = force, springs.force(s)[0]
        springs.accept(s)
        deep = max(deep, s)
        second += h * impulse + h**2 / 4 * (last + force)
        impulse = impulse_known + h / 2 * force
        flight = alpha_rate * impulse
        if p.waves == "hereditary":
            memory = memory_known + own * force
            flight = p.memory @ memory
            deflection, speed = (
                deflection + h / 2 * (speed + flight + alpha * force),
                flight + alpha * force,
            )
        pressed = np.flatnonzero(s > springs.level)
        now = pressed[-1] if pressed.size else -1
        growths += shrinking and now > edge
        shrinking = now < edge or shrinking and now == edge
        edge = now
        tip = springs.stiff * (s - springs.level[0])
        nodes.append((t, tip, impulse, flight))
        if tip <= 0:
            # the force ends as the power n of the time that is left: only its time is interpolated
            t, y, impulses, flights = np.array(nodes[-3:]).T
            end = t[2] + np.polyfit(y, t - t[2], 2)[-1]
            flight = np.polyval(np.polyfit(t - t[1], flights, 2), end - t[1])
            impulse = impulses[1] + (end - t[1]) / (t[2] - t[1]) * (impulses[2] - impulses[1])
            sphere = impulse / (p.mass * p.v0) - 1 - p.gravity * end / p.v0
            return np.array([sphere + flight / p.v0, sphere, end]), deep, growths
    raise RuntimeError("no separation")


def wave(x):
    """Indentation with a small growth after the first maximum, and a last one beyond it."""
    return x + 0.25 * np.sin(2 * np.pi * x) + 0.05 * np.sin(8 * np.pi * x)


def press(p, deepest, duration, steps, at=(0.5, 0.6, 0.8, 1.0)):
    """Force where the indentation is prescribed, at some of the time."""
    springs = Springs(p, deepest * 1.02, steps)
    force = []
    for i in range(1, steps + 1):
        springs.step(duration / steps)
        s = deepest * float(wave(i / steps))
        if any(abs(i / steps - x) < 1e-9 for x in at):
            force.append(springs.force(s)[0])
        springs.accept(s)
    return np.array(force)


def extrapolated(values):
    """Limit of runs with halved steps, and how far that of the coarser ones is from it."""
    once = [(4 * b - a) / 3 for a, b in zip(values, values[1:])]
    return once[-1], np.abs(once[-1] - once[-2])


def main():
    """Print what vcor is compared with."""
    shown = {"precision": 10, "max_line_width": 100}
    for name, p, duration, steps in (
        ("one maximum, relaxing", Impact(15e6, 1.5e6, 1000.0, 10e-3, "relaxing", 5.0), 3e-3, 400),
        (
            "one maximum, hereditary",
            Impact(15e6, 3.75e6, 1200.0, 20e-3, "hereditary", 10.0, 0.5),
            3e-3,
            400,
        ),
        ("regrowth, relaxing", Impact(15e6, 1.5e6, 1000.0, 8e-3, "relaxing", 5.0), 3e-3, 400),
        (
            "regrowth, gravity",
            Impact(15e6, 1.5e6, 1000.0, 8e-3, "relaxing", 5.0, gravity=1.0),
            3e-3,
            400,
        ),
        (
            "regrowth, dashpot",
            Impact(15e6, 1.5e6, 1000.0, 7e-3, "relaxing", 5.0, viscosity=300.0),
            3e-3,
            400,
        ),
    ):
        deepest = run(p, duration, 2 * p.v0 * duration, 1000)[1]
        runs = [run(p, duration, deepest, steps * 2**i) for i in range(4)]
        limit, error = extrapolated([r[0] for r in runs])
        print(f"{name}: cor, cor_sphere, contact time, growths {runs[-1][2]}")
        print("  ", np.array2string(limit, **shown), "+-", np.array2string(error, precision=1))
    for name, options in (
        ("elastic", dict(rubbery=15e6, glassy=15e6)),
        ("SLS", {}),
        ("dashpot", dict(viscosity=300.0)),
        ("cone", dict(power=2.0)),
    ):
        p = Impact(
            **{
                **dict(
                    glassy=15e6,
                    rubbery=1.5e6,
                    rate=1000.0,
                    half_thickness=1.0,
                    waves="constant",
                    velocity=1.0,
                ),
                **options,
            }
        )
        limit, error = extrapolated([press(p, 1e-3, 4e-3, 250 * 2**i) for i in range(4)])
        print(f"prescribed, {name}: forces at 0.5, 0.6, 0.8 and 1 of the time")
        print("  ", np.array2string(limit, **shown), "+-", np.array2string(error, precision=1))


if __name__ == "__main__":
    main()
