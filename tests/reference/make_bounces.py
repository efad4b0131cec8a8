"""Reference bounces of a sphere under its weight, for `test_bounces.py`.

A sphere of mass m falls on a face whose contact is Hertz's with a sum of exponentials and a dashpot,
by Boltzmann's law, on an infinite thin elastic plate or on nothing that moves:

    F = G_0 u + sum G_k p_k + eta u',   p_k' = u' - l_k p_k,   u = K s^1.5
    v' = g - F/m,   s' = v - alpha F'' s'' ...   with U' = alpha F:   s' = v - alpha F

In contact y = sqrt(s) and dt = y dx make everything analytic from first touch:

    dy/dx = s'/2,   dv/dx = y (g - F/m),   dp/dx = 3 y^2 s'/2 - l y p,   dt/dx = y

with F = G_0 y^3 + sum G_k p_k + 3 eta y s'/2. It is integrated by Dormand and Prince's method of
order 8 with a relative tolerance of 1e-13. The contact ends at F = 0, or at y = 0 if it is elastic.
In flight the dent is linear: w = sum of eigenvectors. The next touch is where the parabola of the
sphere meets (w)^(2/3). The dent is never forgotten. The sphere rests if the force has three minima
above zero in a contact.

Usage: make_bounces.py        needs numpy, scipy; writes bounces.json, some seconds
"""

import json
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

TOLERANCE = 1e-13

BALL = {"mass": 0.02, "radius": 0.01, "gravity": 9.81, "poisson": 0.3}
CASES = {
    # a Kelvin-Voigt floor, to rest
    "kelvin_voigt": {"velocity": 1.0, "bounces": 1000, "equilibrium": 1.0e7, "moduli": [],
                     "rates": [], "viscosity": 300.0},
    # more damping: the last hops begin in a dent
    "soft_floor": {"velocity": 0.5, "bounces": 1000, "equilibrium": 3.0e5, "moduli": [],
                   "rates": [], "viscosity": 200.0},
    # standard linear solid
    "sls": {"velocity": 2.0, "bounces": 12, "equilibrium": 4.0e6, "moduli": [2.0e6],
            "rates": [800.0], "viscosity": 0.0},
    # a dent that recovers in a second, as of memory foam
    "slow_recovery": {"velocity": 1.0, "bounces": 1000, "equilibrium": 2.0e5,
                      "moduli": [2.0e6, 3.0e5], "rates": [30.0, 3.0], "viscosity": 0.0},
    # all of it
    "relaxing_dashpot": {"velocity": 1.0, "bounces": 12, "equilibrium": 1.0e6,
                         "moduli": [2.0e6, 5.0e5], "rates": [1000.0, 20.0], "viscosity": 60.0},
    # never rests
    "elastic": {"velocity": 1.0, "bounces": 20, "equilibrium": 1.0e8, "moduli": [], "rates": [],
                "viscosity": 0.0},
}


class Contact:
    """Kernel and motion of one case, in SI units."""

    def __init__(self, case):
        factor = 4/3*np.sqrt(BALL["radius"])/(1 - BALL["poisson"]**2)
        self.mass, self.gravity = BALL["mass"], BALL["gravity"]
        self.g0 = factor*case["equilibrium"]
        self.g = factor*np.array(case["moduli"], dtype=float)
        self.rates = np.array(case["rates"], dtype=float)
        self.eta = factor*case["viscosity"]
        self.alpha = case.get("alpha", 0.0)

    def force(self, state):
        """Force from y, v, t, p; with the plate's velocity in it."""
        y, v, p = state[0], state[1], state[3:]
        drag = 1.5*self.eta*y
        return (self.g0*y**3 + self.g@p + drag*v)/(1 + self.alpha*drag)

    def rate(self, _, state):
        """Derivative by x."""
        y, v, p = state[0], state[1], state[3:]
        force = self.force(state)
        speed = v - self.alpha*force
        return np.concatenate(([speed/2, y*(self.gravity - force/self.mass), y],
                               1.5*y**2*speed - self.rates*y*p))

    def press(self, y, v, p):
        """Follow a contact; state at its end, largest force and indentation, or None at rest."""
        elastic = self.eta == 0 and len(self.g) == 0

        def ends(_, state):
            return state[0] if elastic else self.force(state)

        def dips(_, state):
            h = 1e-6*state[2:3]
            del h
            return self.rate(0, state)[0]
        ends.terminal, ends.direction = True, -1
        dips.direction = 0
        state = np.concatenate(([y, v, 0.0], p))
        scale = (self.mass/(self.g0 + self.g.sum() + 1e-300))**0.4*max(abs(v), 1e-3)**-0.2
        length = np.sqrt(max(abs(v), 1e-3)*scale)
        # leave the start, where the event has a zero
        first = solve_ivp(self.rate, (0, 1e-3*scale/length), state, method="DOP853",
                          rtol=TOLERANCE, atol=1e-30)
        state = first.y[:, -1]
        largest, deepest, turns = 0.0, 0.0, 0
        for _ in range(40):
            piece = solve_ivp(self.rate, (0, 20*scale/length), state, method="DOP853",
                              rtol=TOLERANCE, atol=1e-30, events=(ends, dips), dense_output=True)
            grid = np.linspace(0, piece.t[-1], 4001)
            values = piece.sol(grid)
            force = np.array([self.force(one) for one in values.T])
            top = force.argmax()
            low, high = grid[max(top - 1, 0)], grid[min(top + 1, len(grid) - 1)]
            for _ in range(60):
                inner = np.linspace(low, high, 9)
                many = [self.force(piece.sol(x)) for x in inner]
                top = int(np.argmax(many))
                low, high = inner[max(top - 1, 0)], inner[min(top + 1, 8)]
                if high - low < 1e-9*(grid[1] - grid[0]):
                    break
            largest = max(largest, max(many), force.max())
            for turn in piece.y_events[1]:
                deepest = max(deepest, turn[0]**2)
            turns += len(piece.t_events[1])
            if piece.t_events[0].size:
                return piece.y_events[0][0], largest, deepest
            if turns > 6:
                return None, largest, deepest
            state = piece.y[:, -1]
        return None, largest, deepest

    def free(self, w, p):
        """Amplitudes, rates and vectors (w, p) of the free dent."""
        n = len(self.g)
        if self.eta > 0:
            # w' = -(G_0 w + sum G p)/eta, p' = w' - l p
            row = -np.concatenate(([self.g0], self.g))/self.eta
            matrix = np.vstack([row, np.tile(row, (n, 1)) - np.hstack(
                [np.zeros((n, 1)), np.diag(self.rates)])]) if n else row[None, :]
            start = np.concatenate(([w], p))
            values, vectors = np.linalg.eig(matrix)
            return np.linalg.solve(vectors, start), values, vectors
        if n == 0:
            return np.zeros(1), np.zeros(1), np.zeros((1, 1))
        # in q = w - p: w = sum G q/(G_0 + sum G), q' = l (w - q)
        share = self.g/(self.g0 + self.g.sum())
        matrix = self.rates[:, None]*(np.tile(share, (n, 1)) - np.eye(n))
        values, vectors = np.linalg.eig(matrix)
        amplitude = np.linalg.solve(vectors, w - p)
        w_of = share@vectors
        return amplitude, values, np.vstack([w_of, w_of - vectors])

    def bounce(self, velocity, bounces):
        """All bounces, and how they end."""
        n = len(self.g)
        y, v, p, time, sunk = 0.0, velocity, np.zeros(n), 0.0, 0.0
        rows = []
        while True:
            state, largest, deepest = self.press(y, v, p)
            if state is None:
                return rows, "rest", time
            s, after, p = state[0]**2, state[1], state[3:]
            if self.alpha:
                # U = alpha int F = alpha m (g t - change of v)
                sunk += self.alpha*self.mass*(self.gravity*state[2] + v - after)
            rows.append({"time": time, "velocity": v, "cor": -after/v, "separation": time + state[2],
                         "height": after**2/(2*self.gravity) - s - sunk, "max_force": largest,
                         "max_indentation": deepest})
            if len(rows) == bounces:
                return rows, "count", rows[-1]["separation"]
            c, values, vectors = self.free(s**1.5, p)

            def dent(t, c=c, values=values, vectors=vectors):
                return np.real(vectors@(c*np.exp(values*t)))

            def gap(t, s=s, after=after, dent=dent):
                return max(dent(t)[0], 0.0)**(2/3) - s - after*t - 0.5*self.gravity*t**2

            high = -2*after/self.gravity
            flight = brentq(gap, 1e-9*high, 1.0001*high, xtol=1e-18, rtol=1e-15)
            now = dent(flight)
            y, p = np.cbrt(max(now[0], 0.0)), now[1:]
            v = after + self.gravity*flight
            time = rows[-1]["separation"] + flight


def main():
    """Write all cases."""
    known = {}
    for name, case in CASES.items():
        rows, ending, total = Contact(case).bounce(case["velocity"], case["bounces"])
        known[name] = {**BALL, **case, "ending": ending, "total_time": total, "rows": rows}
        print(name, len(rows), ending, total)
    path = Path(__file__).with_name("bounces.json")
    path.write_text(json.dumps(known, indent=1) + "\n")


if __name__ == "__main__":
    main()
