"""How a layer's restitution tends to that of the thin plate, for `vcor verify`.

With y = s H/c_s and a footprint that is small against the thickness H a layer has the compliance

    C = (alpha/s) [1 - (2/(5 pi)) (6 - 6 nu)^(1/2) y ln y + O(y)].

With x = H/(c_s T) the term y ln x is a spring in series with the contact. Its compliance is that of
the plate's material, so it gives way by kappa u where the contact carries a force by u = s^1.5:

    s + kappa u = t - J - W,   kappa = lambda (2/(5 pi)) (6 - 6 nu)^(1/2) x ln(1/x)

in units of T and v0 T, with J the double integral of the force F and W the thin plate's motion. The
restitution is off by A x ln(1/x) + B x + O(x^2 ln(x)^2), and A is its derivative by kappa.

The plate is a standard linear solid with E(t)/E(0) = r + (1 - r) exp(-t/T), elastic for r = 1:

    F = u - (1 - r) q, q' = u - q,   W' = lambda (F + int_r^1 w(l) P_l dl), P_l' = F - l P_l

with w(l) = ((1 - l)/(l - r))^(1/2)/pi, as sqrt(E(0)/Q(s)) = sqrt((s + 1)/(s + r)).

Usage: make_thin_limit.py        needs numpy and scipy; prints, some seconds
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

LAMBDA, POISSON = 0.5, 0.5
MODES = 40


def restitution(kappa, rest):
    """Of the impact with the spring, on a solid that keeps this part of its modulus."""
    k = np.arange(1, MODES + 1) * math.pi / (2 * MODES + 1)
    rate = rest + (1 - rest) * (1 + np.cos(2 * k)) / 2      # Gauss and Chebyshev, third kind
    weight = 2 / (2 * MODES + 1) * np.sin(k) ** 2 * (1 - rest)

    def contact(t, y):
        """u and F."""
        way = t - y[1] - y[2]
        s = max(way, 0.0)
        for _ in range(20):
            s -= (s + kappa * s**1.5 - way) / (1 + 1.5 * kappa * math.sqrt(s)) if s > 0 else 0.0
        return s**1.5, s**1.5 - (1 - rest) * y[3]

    def rates(t, y):
        u, force = contact(t, y)
        return [force, y[0], LAMBDA * (force + weight @ y[4:]), u - y[3], *(force - rate * y[4:])]

    def end(t, y):
        return contact(t, y)[1] if t > 0.3 else 1.0

    end.terminal = True
    found = solve_ivp(rates, (0, 60), np.zeros(4 + MODES), "DOP853", rtol=1e-11, atol=1e-13,
                      events=end, max_step=0.1)
    return found.y[0, -1] - 1


def main():
    """Print A of both plates."""
    spring = LAMBDA * 2 / (5 * math.pi) * math.sqrt(6 * (1 - POISSON))
    for rest in (1.0, 0.25):
        slope = [(restitution(h, rest) - restitution(-h, rest)) / (2 * h) for h in (2e-3, 4e-3)]
        print(f"r = {rest}: e = {restitution(0.0, rest):.9f}, "
              f"A = {spring * (4 * slope[0] - slope[1]) / 3:.7f}")


if __name__ == "__main__":
    main()
