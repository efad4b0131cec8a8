"""Reference bounces of a sphere under its weight, for `test_bounces.py`.

A sphere of mass m falls on a face whose contact is Hertz's with a sum of exponentials and a dashpot,
by Boltzmann's law, on an infinite thin elastic plate or on nothing that moves:

    F = G_0 u + sum G_k p_k + eta u',   p_k' = u' - l_k p_k,   u = s^1.5
    v' = g - F/m,   s' = v - U',   U' = alpha F   or   U = sum of modes, x_n'' + d_n x_n' + w_n^2 x_n = F/m_n

In contact y = sqrt(s) and dt = y dx make everything analytic from first touch:

    dy/dx = s'/2,   dv/dx = y (g - F/m),   dp/dx = 3 y^2 s'/2 - l y p,   dt/dx = y

with F = G_0 y^3 + sum G_k p_k + 3 eta y s'/2. It is integrated by Dormand and Prince's method of
order 8 with a relative tolerance of 1e-13. The contact ends at F = 0, or at y = 0 if it is elastic.
In flight the dent is linear: w = sum of eigenvectors. The next touch is where the parabola of the
sphere meets w^(2/3); the modes are damped oscillations, and steps of a hundredth of the shortest
period look for the first touch. A bounce on modes ends where the sphere is farther off than the sum of
their amplitudes. The dent is never forgotten. The sphere rests if the force has three minima above
zero in a contact, which lasts three periods of the slowest mode.

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
    # on an infinite thin elastic plate, which sinks
    "plate": {"velocity": 1.0, "bounces": 8, "equilibrium": 7.0e10, "moduli": [], "rates": [],
              "viscosity": 0.0, "density": 2500.0, "half_thickness": 0.01},
    # an elastic ball on a block with a spring and a dashpot: several contacts in some bounces
    "block": {"velocity": 0.5, "bounces": 6, "equilibrium": 1.0e9, "moduli": [], "rates": [],
              "viscosity": 0.0, "modes": [[300.0, 0.05, 0.1]]},
    # two modes and a pad that relaxes
    "modes": {"velocity": 0.3, "bounces": 5, "equilibrium": 1.0e8, "moduli": [1.0e8],
              "rates": [3000.0], "viscosity": 0.0, 
              "modes": [[150.0, 0.04, 0.2], [700.0, 0.03, 0.3]]},
    # a flexible structure that strikes again
    "again": {"velocity": 0.3, "bounces": 2, "equilibrium": 1.0e8, "moduli": [1.0e8],
              "rates": [3000.0], "viscosity": 0.0,
              "modes": [[40.0, 0.05, 0.01], [260.0, 0.05, 0.02], [700.0, 0.05, 0.02]]},
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
        self.alpha = 0.0
        if "density" in case:
            # Zener's thin plate, sqrt(3 rho (1 - nu^2)/E)/(16 rho h^2)
            self.alpha = (np.sqrt(3*case["density"]*(1 - BALL["poisson"]**2)/case["equilibrium"])
                          / (16*case["density"]*case["half_thickness"]**2))
        modes = np.array(case.get("modes", np.zeros((0, 3))), dtype=float)
        self.omega, zeta, self.modal_mass = 2*np.pi*modes[:, 0], modes[:, 1], modes[:, 2]
        self.damping = 2*zeta*self.omega
        self.n, self.m = len(self.g), len(self.omega)

    def parts(self, state):
        """Lags, deflections and velocities of the modes in a state y, v, t, p, x, x'."""
        n, m = 3 + self.n, self.m
        return state[3:n], state[n:n + m], state[n + m:]

    def force(self, state):
        """Force; with the plate's velocity in it."""
        y, v = state[:2]
        p, _, rate = self.parts(state)
        drag = 1.5*self.eta*y
        return (self.g0*y**3 + self.g@p + drag*(v - rate.sum()))/(1 + self.alpha*drag)

    def rate(self, _, state):
        """Derivative by x."""
        y, v = state[:2]
        p, place, rate = self.parts(state)
        force = self.force(state)
        speed = v - self.alpha*force - rate.sum()
        return np.concatenate((
            [speed/2, y*(self.gravity - force/self.mass), y], 1.5*y**2*speed - self.rates*y*p,
            y*rate, y*(force/self.modal_mass - self.damping*rate - self.omega**2*place)))

    def press(self, state):
        """Follow a contact; state at its end, largest force and indentation, or None at rest."""
        elastic = self.eta == 0 and self.n == 0

        def ends(_, state):
            return state[0] if elastic else self.force(state)

        def turns(_, state):
            return self.rate(0, state)[0]

        ends.terminal, ends.direction = True, -1
        speed = max(abs(2*self.rate(0, state)[0]), 1e-3)
        scale = (self.mass/(self.g0 + self.g.sum()))**0.4*speed**-0.2
        length = scale/np.sqrt(speed*scale)
        options = {"method": "DOP853", "rtol": TOLERANCE, "atol": 1e-30}
        # leave the start, where the event has a zero
        state = solve_ivp(self.rate, (0, 1e-3*length), state, **options).y[:, -1]
        largest, deepest, count = 0.0, 0.0, 0
        longest = 3*2*np.pi/self.omega.min() if self.m else 0.0
        while True:
            piece = solve_ivp(self.rate, (0, 20*length), state, events=(ends, turns),
                              dense_output=True, **options)
            grid = np.linspace(0, piece.t[-1], 4001)
            force = np.array([self.force(one) for one in piece.sol(grid).T])
            top = force.argmax()
            low, high = grid[max(top - 1, 0)], grid[min(top + 1, len(grid) - 1)]
            while high - low > 1e-9*grid[1]:
                inner = np.linspace(low, high, 9)
                many = [self.force(piece.sol(x)) for x in inner]
                top = int(np.argmax(many))
                low, high = inner[max(top - 1, 0)], inner[min(top + 1, 8)]
            largest = max(largest, *many)
            deepest = max([deepest] + [one[0]**2 for one in piece.y_events[1]])
            count += len(piece.t_events[1])
            if piece.t_events[0].size:
                return piece.y_events[0][0], largest, deepest
            state = piece.y[:, -1]
            if count > 6 and state[2] > longest:
                break
        return None, largest, deepest

    def free_dent(self, w, p):
        """Function of time that gives w and p of the free dent."""
        n = self.n
        if self.eta > 0:
            # w' = -(G_0 w + sum G p)/eta, p' = w' - l p
            row = -np.concatenate(([self.g0], self.g))/self.eta
            matrix = np.vstack([row, *(row - np.eye(n + 1)[k + 1]*self.rates[k]
                                       for k in range(n))])
            values, vectors = np.linalg.eig(matrix)
            c = np.linalg.solve(vectors, np.concatenate(([w], p)))
        elif n:
            # in q = w - p: w = sum G q/(G_0 + sum G), q' = l (w - q)
            share = self.g/(self.g0 + self.g.sum())
            matrix = self.rates[:, None]*(np.tile(share, (n, 1)) - np.eye(n))
            values, vectors = np.linalg.eig(matrix)
            c = np.linalg.solve(vectors, w - p)
            vectors = np.vstack([share@vectors, share@vectors - vectors])
        else:
            return lambda t: np.zeros(1)
        return lambda t: np.real(vectors@(c*np.exp(values*t)))

    def free_modes(self, place, rate):
        """Function of time that gives deflections and velocities of the free modes."""
        half = self.damping/2
        root = np.sqrt(self.omega**2 - half**2)

        def at(t):
            fall, cosine, sine = np.exp(-half*t), np.cos(root*t), np.sin(root*t)/root
            return (fall*(place*cosine + (rate + half*place)*sine),
                    fall*(rate*cosine - (self.omega**2*place + half*rate)*sine))

        return at

    def fly(self, state):
        """State at the next touch, and whether the sphere has been out of reach before."""
        s, v = state[0]**2, state[1]
        p, place, rate = self.parts(state)
        dent, modes = self.free_dent(s**1.5, p), self.free_modes(place, rate)
        top = s + place.sum()

        def gap(t):
            return (max(dent(t)[0], 0.0)**(2/3) + modes(t)[0].sum() - top - v*t
                    - 0.5*self.gravity*t**2)

        if self.m == 0:
            left = True
            high = -2*v/self.gravity
            t = brentq(gap, 1e-9*high, 1.0001*high, xtol=1e-18, rtol=1e-15)
        else:
            left, t, step = False, 0.0, 2*np.pi/self.omega.max()/400
            while True:
                x, xdot = modes(t)
                reach = np.sqrt(x**2 + (xdot/self.omega)**2).sum()
                height = -(top + v*t + 0.5*self.gravity*t**2)
                if v + self.gravity*t < 0 and height >= reach:
                    left = True
                # steps far from the structure are long
                ahead = step
                if height > 1.2*reach and v + self.gravity*t < 0:
                    ahead = max(step, -(v + self.gravity*t)/self.gravity/3)
                if t > 0 and gap(t + ahead) < 0:
                    if ahead == step:
                        t = brentq(gap, t, t + ahead, xtol=1e-18, rtol=1e-15)
                        break
                    ahead = step
                t += ahead
        now = dent(t)
        y = np.cbrt(max(now[0], 0.0))
        return np.concatenate(([y, v + self.gravity*t, t], now[1:], *modes(t))), left

    def bounce(self, velocity, bounces):
        """All bounces, and how they end."""
        time, sunk, rows = 0.0, 0.0, []
        start = np.concatenate(([0.0, velocity, 0.0], np.zeros(self.n + 2*self.m)))
        while True:
            touch, contacts, largest, deepest = (time, start[1]), 0, 0.0, 0.0
            while True:
                state, force, depth = self.press(start)
                largest, deepest = max(largest, force), max(deepest, depth)
                if state is None:
                    return rows, "rest", touch[0]
                contacts += 1
                time += state[2]
                s, after = state[0]**2, state[1]
                if self.alpha:
                    # U = alpha int F = alpha m (g t - change of v)
                    sunk += self.alpha*self.mass*(self.gravity*state[2] + start[1] - after)
                last = time
                place = s + sunk + self.parts(state)[1].sum()
                start, left = self.fly(state)
                time += start[2]
                start[2] = 0.0
                if left:
                    break
            rows.append({"time": touch[0], "velocity": touch[1], "cor": -after/touch[1],
                         "contacts": contacts, "last_separation": last,
                         "rebound_height": after**2/(2*self.gravity) - place,
                         "max_force": largest, "max_indentation": deepest})
            if len(rows) == bounces:
                return rows, "count", last


def main():
    """Write all cases."""
    known = []
    for name, case in CASES.items():
        rows, ending, total = Contact(case).bounce(case["velocity"], case["bounces"])
        facts = {**BALL, **case, "bounces_end": ending, "bouncing_time": total,
                 "columns": list(rows[0])}
        lines = ",\n".join("   " + json.dumps(list(row.values())) for row in rows)
        known.append(f'"{name}": {json.dumps(facts)[:-1]},\n "rows": [\n{lines}]}}')
        print(name, len(rows), ending, total)
    path = Path(__file__).with_name("bounces.json")
    path.write_text("{\n" + ",\n".join(known) + "\n}\n")


if __name__ == "__main__":
    main()
