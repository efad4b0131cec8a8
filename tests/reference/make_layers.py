#!/usr/bin/env python3
"""Make layers.json: quasi-static impacts on layers that lie on a rigid base, and of the true sphere.

    tests/reference/make_layers.py [--seed N] [--count N] [FILE]        default: layers.json next to it

Nothing is shared with vcor but the equations. The law of the layer is the Fredholm equation of the
contact radius a with dense matrices: its kernel is summed over the wavenumbers, on Gauss nodes that
are new for every a, and force and indentation are Chebyshev series of a. The material is a rigid
body on Prony series, so that the past of the force is a few internal variables, which DOP853 follows
with the motion. With the receding law they are read from its dense output at t1, which is the root of
the condition int_t1^t k(t - x) s'(x) dx = 0. Needs numpy and scipy.
"""

import argparse
import json
import math
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

PANEL = np.polynomial.legendre.leggauss(16)


def compliance_missing(base, nu, k):
    """1 - L at wavenumbers times thickness."""
    if base == "bonded":
        q = 3 - 4 * nu
        top = 2 * q * np.exp(-2 * k) + 4 * k + 4 * k**2 + 1 + q**2
        return top / (2 * q * np.cosh(2 * k) + 4 * k**2 + 1 + q**2)
    return (1 + 2 * k - np.exp(-2 * k)) / (np.sinh(2 * k) + 2 * k)


class Shape:
    """Profile h(x) of the body, and its half-space law F/E' = factor s^n for small s."""

    def __init__(self, case):
        self.kind = case["shape"]
        self.radius = case.get("radius")
        self.case = case

    def height(self, x):
        if self.kind == "sphere":
            return x**2 / self.radius
        if self.kind == "true_sphere":
            return x * np.arctanh(x / self.radius)
        if self.kind == "cone":
            return math.pi / 2 * x / math.tan(math.radians(self.case["half_angle"]))
        p = self.case["profile_power"]
        kappa = math.sqrt(math.pi) * math.gamma(p / 2 + 1) / math.gamma((p + 1) / 2)
        return self.case["profile_coefficient"] * kappa * x**p


class Law:
    """s(a), F(a)/E' and S(a) up to a largest contact radius, as Chebyshev series."""

    def __init__(self, shape, base, nu, thickness, largest, terms=56):
        self.largest = largest
        self.shape = shape
        point = np.cos(math.pi * (np.arange(terms) + 0.5) / terms)
        rows = []
        for a in largest * (1 + point) / 2:
            rows.append(self.solve(shape, base, nu, thickness, a))
        s, force, stiffness = np.array(rows).T
        a = largest * (1 + point) / 2
        h = shape.height(a)
        fit = [
            chebyshev.chebfit(point, y, terms - 1)
            for y in (s / h, force / (a * h), stiffness / a)
        ]
        self.depth, self.force, self.stiffness = fit
        self.deepest = self.at(self.depth, largest) * shape.height(largest)

    @staticmethod
    def solve(shape, base, nu, thickness, a):
        """Indentation, force over E' and half the stiffness over E' at one contact radius."""
        n = int(60 + 20 * a / (thickness or math.inf))
        node, weight = np.polynomial.legendre.leggauss(n)
        # x = a t^3, so that powers of x are smooth
        t = (node + 1) / 2
        x, weight = a * t**3, a * 1.5 * t**2 * weight
        matrix = np.eye(n)
        row = np.zeros(n)
        if base != "half_space":
            parts = int(np.ceil(24 * max(1.0, a / thickness) / 6)) + 8
            edges = np.linspace(0, 24, parts + 1)
            half = np.diff(edges)[:, None] / 2
            k = (edges[:-1, None] + half * (1 + PANEL[0])).ravel()
            share = (
                (half * PANEL[1]).ravel()
                * compliance_missing(base, nu, k)
                * 2
                / math.pi
            )
            k = k / thickness
            share = share / thickness
            cosine = np.cos(np.outer(x, k))
            matrix -= (cosine * share) @ cosine.T * weight
            row = -(np.cos(a * k) * share) @ cosine.T * weight
        right = np.array([np.ones(n), shape.height(x)]).T
        chi, eta = np.linalg.solve(matrix, right).T
        s = (shape.height(a) - row @ eta) / (1 - row @ chi)
        return s, 2 * (s * (weight @ chi) - weight @ eta), weight @ chi

    def at(self, series, a):
        return chebyshev.chebval(2 * a / self.largest - 1, series)

    def radius(self, s):
        """Contact radius at an indentation."""
        if s <= 0:
            return 0.0
        if s > self.deepest:
            raise OverflowError
        return brentq(
            lambda a: self.at(self.depth, a) * self.shape.height(a) - s,
            0,
            self.largest,
            xtol=1e-18,
            rtol=1e-15,
        )

    def u(self, s):
        """Force over E', odd."""
        a = self.radius(abs(s))
        return math.copysign(self.at(self.force, a) * a * self.shape.height(a), s)

    def slope(self, s):
        a = self.radius(abs(s))
        return 2 * self.at(self.stiffness, a) * a


def impact(case, law):
    """Outcome of an impact."""
    mass, speed, gravity = case["mass"], case["velocity"], case.get("gravity", 0.0)
    factor = 1 / (1 - case["poisson_ratio"] ** 2)
    rest = factor * case["equilibrium_modulus"]
    moduli = factor * np.array(case["moduli"])
    rates = np.array(case["rates"])
    n = len(rates)
    glassy = rest + moduli.sum()

    def energy(s):
        grid, weight = np.polynomial.legendre.leggauss(20)
        return (
            glassy
            * sum(w * law.u(s * (1 + g) / 2) for g, w in zip(grid, weight))
            * s
            / 2
        )

    deep = brentq(
        lambda s: energy(s) - 0.5 * mass * speed**2, 1e-12, law.deepest * 0.999
    )
    unit, time, u_unit = deep, deep / speed, law.u(deep)

    # s, s', impulse of F less weight over m v; p_k = int exp(-l (t - x)) u' dx and w_k with s'
    def rates_of(_, y):
        s, v = y[0] * unit, y[1] * speed
        force = rest * law.u(s) + u_unit * moduli @ y[2 : 2 + n]
        return np.concatenate(
            (
                [v / unit, (gravity - force / mass) / speed],
                law.slope(s) * v / u_unit - rates * y[2 : 2 + n],
                v / unit - rates * y[2 + n :],
            )
        )

    def force_of(y):
        return rest * law.u(y[0] * unit) + u_unit * moduli @ y[2 : 2 + n]

    start = np.zeros(2 + 2 * n)
    start[1] = 1.0
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "dense_output": True}

    def turn(_, y):
        return y[1]

    turn.terminal, turn.direction = True, -1
    grow = solve_ivp(rates_of, (0, 60 * time), start, events=turn, **options)
    t_turn, y_turn = grow.t_events[0][0], grow.y_events[0][0]
    grid = np.linspace(0, t_turn, 2001)
    best = np.argmax([force_of(y) for y in grow.sol(grid).T])
    peak = minimize_scalar(
        lambda t: -force_of(grow.sol(t)),
        bounds=(grid[max(best - 1, 0)], grid[min(best + 1, 2000)]),
        method="bounded",
        options={"xatol": 1e-12 * t_turn},
    )
    result = {
        "max_indentation": y_turn[0] * unit,
        "max_force": max(-peak.fun, force_of(y_turn)),
    }
    if case["law"] == "boltzmann":

        def gone(_, y):
            return force_of(y) / (glassy * u_unit)

        gone.terminal, gone.direction = True, -1
        fall = solve_ivp(rates_of, (t_turn, 300 * time), y_turn, events=gone, **options)
    else:

        def edge(t, condition):
            """t1 at which the integral of k s' over the approach is the condition."""

            def excess(t1):
                y = grow.sol(t1)
                return (
                    rest * y[0]
                    + moduli @ (np.exp(-rates * (t - t1)) * y[2 + n :])
                    - condition
                )

            if excess(t_turn) <= 0:
                return t_turn
            return brentq(excess, 0, t_turn, xtol=1e-16 * t_turn, rtol=1e-15)

        def receding(t, y):
            condition = rest * y[0] + moduli @ y[2:]
            force = 0.0
            if condition > 0:
                t1 = edge(t, condition)
                past = grow.sol(t1)
                force = rest * law.u(past[0] * unit) + u_unit * moduli @ (
                    np.exp(-rates * (t - t1)) * past[2 : 2 + n]
                )
            v = y[1] * speed
            return np.concatenate(
                ([v / unit, (gravity - force / mass) / speed], v / unit - rates * y[2:])
            )

        def gone(_, y):
            return (rest * y[0] + moduli @ y[2:]) / glassy

        gone.terminal, gone.direction = True, -1
        begin = np.concatenate((y_turn[:2], y_turn[2 + n :]))
        options.update(rtol=1e-11, atol=1e-13, max_step=t_turn / 8)
        fall = solve_ivp(receding, (t_turn, 300 * time), begin, events=gone, **options)
    t_end, y_end = fall.t_events[0][0], fall.y_events[0][0]
    result.update(
        cor=-y_end[1],
        contact_time=t_end,
        residual_indentation=y_end[0] * unit,
        contact_radius=law.radius(result["max_indentation"]),
    )
    return result


def solve(case):
    """Outcome, with the range of the law as large as the contact needs."""
    shape = Shape(case)
    thickness = case.get("thickness")
    largest = 0.3 * (thickness or case["radius"])
    limit = math.inf
    if case["shape"] == "true_sphere":
        limit = 0.9 * case["radius"]
    while True:
        law = Law(
            shape, case["base"], case["poisson_ratio"], thickness, min(largest, limit)
        )
        try:
            return impact(case, law)
        except (OverflowError, ValueError):
            if largest > limit or largest > 25 * (thickness or math.inf):
                raise
            largest *= 1.4


def draw(rng):
    """A random impact: thin to thick layers, little and much relaxation."""
    case = {"law": str(rng.choice(["boltzmann", "receding"]))}
    case["shape"] = str(
        rng.choice(["sphere", "sphere", "true_sphere", "cone", "power"])
    )
    case["base"] = str(rng.choice(["bonded", "bonded", "sliding"]))
    if case["shape"] == "true_sphere" and rng.random() < 0.3:
        case["base"] = "half_space"
    case["poisson_ratio"] = round(float(rng.choice([0.5, rng.uniform(0.3, 0.499)])), 4)
    if case["shape"] in ("sphere", "true_sphere"):
        case["radius"] = float("%.4g" % 10 ** rng.uniform(-3, -1.5))
        size = case["radius"]
    else:
        size = 0.01
    if case["shape"] == "cone":
        case["half_angle"] = round(float(rng.uniform(50, 80)), 2)
    if case["shape"] == "power":
        case["profile_power"] = round(float(rng.uniform(1.3, 4)), 2)
        case["profile_coefficient"] = float(
            "%.4g" % (size ** (1 - case["profile_power"]) / 2)
        )
    if case["base"] != "half_space":
        case["thickness"] = float("%.4g" % (size * 10 ** rng.uniform(-1.3, 0.7)))
    n = int(rng.integers(1, 4))
    case["equilibrium_modulus"] = float("%.4g" % 10 ** rng.uniform(5.7, 7))
    time = size / 10 ** rng.uniform(0, 1)
    case["moduli"] = [
        float("%.4g" % (case["equilibrium_modulus"] * 10 ** rng.uniform(-0.7, 0.5)))
        for _ in range(n)
    ]
    case["rates"] = sorted(
        float("%.4g" % (10 ** rng.uniform(-1.5, 1.2) / time)) for _ in range(n)
    )
    # a mass and a velocity whose energy presses half a space by some per cent of the size
    depth = 10 ** rng.uniform(-2.2, -0.7) * size
    glassy = (case["equilibrium_modulus"] + sum(case["moduli"])) / (
        1 - case["poisson_ratio"] ** 2
    )
    case["velocity"] = float("%.4g" % (depth / time / 2))
    case["mass"] = float(
        "%.4g" % (glassy * math.sqrt(size) * depth**2.5 / case["velocity"] ** 2)
    )
    if rng.random() < 0.25:
        case["gravity"] = float(
            "%.4g" % (rng.uniform(0.02, 0.2) * case["velocity"] / time)
        )
    return case


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "file", nargs="?", type=Path, default=Path(__file__).parent / "layers.json"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=12)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    rows = []
    while len(rows) < options.count:
        case = draw(rng)
        try:
            outcome = solve(case)
        except (OverflowError, ValueError, IndexError) as error:
            print("left out:", case, repr(error))
            continue
        rows.append(
            {
                "case": case,
                "expect": {k: float(f"{v:.12g}") for k, v in outcome.items()},
            }
        )
        print(rows[-1], flush=True)
    options.file.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
