#!/usr/bin/env python3
"""The impact as an ODE for SciPy's solve_ivp; needs numpy and scipy.

    solve_ivp.py NAME        sls, butyl_prony, butyl_cerf or butyl_power_law
    solve_ivp.py NAME --all  every method, not the fastest alone

The equations are in problems.py. Right-hand side and Jacobian are analytic and vectorised over the
modes. As in cvode.c the tolerance of a method is the loosest one that keeps the error of cor below
1e-8 and goes on doing so at the next two, and a line is

    problem,solver,settings,error,microseconds,spread,steps
"""

import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402
from scipy.special import erfcx  # noqa: E402

import problems  # noqa: E402

WANTED = 1e-8
BATCHES = 7
METHODS = ["DOP853", "LSODA", "Radau", "BDF"]
# An explicit method takes a step for each of the shortest times of the material: hopeless beyond
STIFF = 1e3
# Time in place of zero, where the fractional kernels have no rate
TINY = 1e-100


class Impact:
    """Right-hand side, Jacobian and event in sqrt(time) or time."""

    def __init__(self, problem, root):
        self.problem, self.root = problem, root
        self.rates, self.moduli = np.array(problem.rates), np.array(problem.moduli)
        self.total = problem.constant + self.moduli.sum()
        size = len(self.rates) + 2
        self.diagonal = np.arange(2, size)
        self.matrix = np.zeros((size, size))
        self.event.__func__.terminal = True
        self.event.__func__.direction = -1

    def kernel(self, tau):
        """g(tau) in a(tau) = A/sqrt(g), and its rate."""
        g0, g1, b = self.problem.parameters
        if self.problem.law != "sum":
            tau = max(tau, TINY)
        if self.problem.law == "cerf":
            y = float(erfcx(b * tau**0.5))
            return g0 + g1 * y, g1 * b * (b * y - (np.pi * tau) ** -0.5)
        if self.problem.law == "power":
            return g0 + g1 * tau**-b, -b * g1 * tau ** (-b - 1.0)
        terms = self.moduli * np.exp(-self.rates * tau)
        return self.problem.constant + terms.sum(), -(self.rates @ terms)

    def state(self, x, y):
        """Time, its derivative, a, sigma."""
        tau, factor = (x * x, 2.0 * x) if self.root else (x, 1.0)
        a = self.problem.plate / self.kernel(tau)[0] ** 0.5
        return tau, factor, a, tau - y[1] - a * y[0]

    def force(self, v, q):
        return self.problem.constant * v + self.moduli @ (v - q)

    def right_side(self, x, y):
        _, factor, _, sigma = self.state(x, y)
        v = sigma * abs(sigma) ** 0.5
        rates = np.empty_like(y)
        rates[0] = factor * self.force(v, y[2:])
        rates[1] = factor * y[0]
        rates[2:] = (factor * self.rates) * (v - y[2:])
        return rates

    def jacobian(self, x, y):
        _, factor, a, sigma = self.state(x, y)
        slope, matrix = 1.5 * abs(sigma) ** 0.5, self.matrix.copy()
        matrix[0, 0], matrix[0, 1] = -self.total * slope * a, -self.total * slope
        matrix[0, 2:] = -self.moduli
        matrix[1, 0] = 1.0
        matrix[2:, 0], matrix[2:, 1] = -a * slope * self.rates, -slope * self.rates
        matrix[self.diagonal, self.diagonal] = -self.rates
        return factor * matrix

    def event(self, x, y):
        sigma = self.state(x, y)[3]
        # the force is zero at the start too
        return self.force(sigma * abs(sigma) ** 0.5, y[2:]) if x > 0.0 else 1.0

    def solve(self, method, tolerance):
        """cor and the number of steps."""
        options = {} if method == "DOP853" else {"jac": self.jacobian}
        start = np.zeros(len(self.rates) + 2)
        result = solve_ivp(
            self.right_side,
            (0.0, 10.0),
            start,
            method=method,
            rtol=max(tolerance, 3e-14),
            atol=tolerance,
            events=self.event,
            **options,
        )
        if not result.t_events or not len(result.t_events[0]):
            return float("nan"), 0
        x, y = result.t_events[0][0], result.y_events[0][0]
        tau = x * x if self.root else x
        g, rate = self.kernel(tau)
        a = self.problem.plate / g**0.5
        return y[0] * (1.0 - a * rate / (2.0 * g)) - 1.0, len(result.t) - 1


def timed(work):
    """Median of the CPU times [us], and the median deviation from it over it."""
    times = []
    for _ in range(BATCHES):
        start = time.process_time()
        work()
        times.append(1e6 * (time.process_time() - start))
    median = float(np.median(times))
    return median, float(np.median(np.abs(np.array(times) - median))) / median


def attempt(problem, method, root):
    """The line of one method, and its time; None where it does not get there."""
    impact = Impact(problem, root)
    chosen = None
    good = 0
    for i in range(29):
        tolerance = 10.0 ** (-5.0 - 0.25 * i)
        error = abs(impact.solve(method, tolerance)[0] - problem.reference)
        if not error <= WANTED:
            good = 0
            continue
        if good == 0:
            chosen = tolerance, error
        good += 1
        if good == 3:
            break
    if good < 3:
        return None
    tolerance, error = chosen
    cost, spread = timed(lambda: impact.solve(method, tolerance))
    steps = impact.solve(method, tolerance)[1]
    settings = f"{method} in {'sqrt(t)' if root else 't'} tol {tolerance:.1e}"
    line = f"{problem.name},solve_ivp,{settings},{error:.1e},{cost:.1f},{spread:.3f},{steps}"
    return cost, line


def main():
    """Find the fastest method."""
    if len(sys.argv) < 2 or sys.argv[1] not in problems.NAMES:
        sys.exit(f"usage: solve_ivp.py {'|'.join(problems.NAMES)} [--all]")
    problem = problems.build(sys.argv[1])[0]
    found = []
    for method in METHODS:
        if method == "DOP853" and max(problem.rates) > STIFF:
            continue
        for root in (False, True):
            found.append(attempt(problem, method, root))
    found = sorted(one for one in found if one)
    if not found:
        sys.exit("solve_ivp: no method leads to the accuracy")
    for _, line in found if "--all" in sys.argv else found[:1]:
        print(line)


if __name__ == "__main__":
    main()
