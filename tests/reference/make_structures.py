#!/usr/bin/env python3
"""Make structures.json: impacts on structures whose material relaxes.

    tests/reference/make_structures.py [--steps N] [FILE]        default: structures.json next to it

Nothing is shared with vcor but the equations. There are no modes and no sums of exponentials: rod,
beam and plate have their receptance in closed form for any complex modulus Q(p), the beam by its
boundary-value problem, the plate by Levy's series, and the motion is marched by convolution
quadrature with the Runge-Kutta method Radau IIA of three stages (C. Lubich and A. Ostermann, Math.
Comp. 60 (1993) 105). The force of an elastic contact is Hertz's, through any number of contacts; that
of a rigid ball on the relaxing material is Boltzmann's, up to the first separation, where it is the
last one. A pad on the structure has the law of make_layers.py. The digits are those on which N and
N/2 steps agree. Needs numpy and scipy.
"""

import argparse
import json
import math
from pathlib import Path

import numpy as np
from make_layers import Law, Shape

ROOT6 = math.sqrt(6)
RADAU = np.array(
    [
        [(88 - 7 * ROOT6) / 360, (296 - 169 * ROOT6) / 1800, (-2 + 3 * ROOT6) / 225],
        [(296 + 169 * ROOT6) / 1800, (88 + 7 * ROOT6) / 360, (-2 - 3 * ROOT6) / 225],
        [(16 - ROOT6) / 36, (16 + ROOT6) / 36, 1 / 9],
    ]
)
WEIGHT, NODE = RADAU[2], RADAU.sum(1)
# The radius of the circle of quadrature to the power of the number of its points
CIRCLE = 1e-9
NU, DENSITY = 0.3, 1200.0
BALL = {"radius": 0.005, "density": 7850.0}
STEEL = 210e9
MATERIALS = {
    "power": (
        "model = 'power_law', equilibrium_modulus = 1e9, coefficient = 6e7, exponent = 0.3",
        lambda p: 1e9 + 6e7 * p**0.3,
    ),
    "fluid": (
        "model = 'power_law', coefficient = 2e8, exponent = 0.2",
        lambda p: 2e8 * p**0.2,
    ),
    "cerf": (
        "model = 'cerf', equilibrium_modulus = 1e9, relaxing_modulus = 4e9, beta = 100.0",
        lambda p: 1e9 + 4e9 * p**0.5 / (p**0.5 + 100),
    ),
    "mittag_leffler": (
        "model = 'mittag_leffler', equilibrium_modulus = 1e9, relaxing_modulus = 4e9, "
        "exponent = 0.3, time = 1e-5",
        lambda p: 1e9 + 4e9 * p**0.3 / (p**0.3 + 1e-5**-0.3),
    ),
    "kelvin": (
        "model = 'prony', equilibrium_modulus = 4e9, viscosity = 5e3",
        lambda p: 4e9 + 5e3 * p,
    ),
    "maxwell": (
        "model = 'prony', moduli = 4e9, times = 1e-4",
        lambda p: 4e9 * p / (p + 1e4),
    ),
    "prony": (
        "model = 'prony', equilibrium_modulus = 1e9, moduli = 5e8, 1e9, 2e9, rates = 1e3, 3e4, 1e6",
        lambda p: 1e9 + 5e8 * p / (p + 1e3) + 1e9 * p / (p + 3e4) + 2e9 * p / (p + 1e6),
    ),
    # of a pad
    "rubber": (
        "model = 'power_law', equilibrium_modulus = 2e6, coefficient = 2e5, exponent = 0.3",
        lambda p: 2e6 + 2e5 * p**0.3,
    ),
}
# Material, whether the ball is rigid on this material, body, an end of the march [s] after the last contact, and
# base and thickness [m] of a pad below the rigid ball
IMPACTS = [
    ("power", False, {"body": "rod", "support": "clamped", "length": 0.05, "diameter": 0.02}, 5e-5),
    ("cerf", False, {"body": "rod", "support": "free", "length": 0.03, "diameter": 0.02}, 5e-5),
    (
        "mittag_leffler",
        False,
        {
            "body": "beam",
            "support": "supported",
            "length": 0.1,
            "width": 0.02,
            "thickness": 0.006,
            "position": [0.03],
        },
        2e-3,
    ),
    (
        "power",
        False,
        {
            "body": "beam",
            "support": "free",
            "length": 0.1,
            "width": 0.02,
            "thickness": 0.006,
            "position": [0.04],
        },
        8e-4,
    ),
    (
        "cerf",
        False,
        {"body": "beam", "support": "clamped", "length": 0.08, "width": 0.02, "thickness": 0.006},
        4e-4,
    ),
    (
        "power",
        False,
        {
            "body": "beam",
            "support": "cantilever",
            "length": 0.05,
            "width": 0.02,
            "thickness": 0.006,
        },
        2.2e-3,
    ),
    (
        "kelvin",
        False,
        {
            "body": "beam",
            "support": "cantilever",
            "length": 0.04,
            "width": 0.02,
            "thickness": 0.006,
        },
        1.5e-3,
    ),
    (
        "maxwell",
        False,
        {"body": "beam", "support": "supported", "length": 0.06, "width": 0.02, "thickness": 0.008},
        5e-4,
    ),
    (
        "cerf",
        False,
        {
            "body": "plate",
            "support": "supported",
            "length": 0.06,
            "width": 0.05,
            "thickness": 0.004,
            "position": [0.025, 0.02],
        },
        3.5e-4,
    ),
    (
        "fluid",
        False,
        {"body": "plate", "support": "supported", "length": 0.05, "width": 0.05, "thickness": 0.003},
        1.5e-3,
    ),
    (
        "prony",
        False,
        {"body": "plate", "support": "supported", "length": 0.06, "width": 0.05, "thickness": 0.003},
        1.5e-3,
    ),
    (
        "mittag_leffler",
        True,
        {
            "body": "plate",
            "support": "supported",
            "length": 0.06,
            "width": 0.05,
            "thickness": 0.006,
            "position": [0.03, 0.02],
        },
        3.3e-4,
    ),
    (
        "cerf",
        True,
        {"body": "beam", "support": "free", "length": 0.06, "width": 0.03, "thickness": 0.012},
        1.3e-4,
    ),
    ("power", True, {"body": "rod", "support": "free", "length": 0.04, "diameter": 0.03}, 1.6e-4),
    (
        "cerf",
        True,
        {"body": "beam", "support": "supported", "length": 0.1, "width": 0.02, "thickness": 0.01},
        4e-3,
        ("bonded", 0.004),
    ),
    (
        "power",
        True,
        {"body": "plate", "support": "supported", "length": 0.1, "width": 0.08, "thickness": 0.003},
        4e-3,
        ("sliding", 0.005),
    ),
]


def receptance(body, modulus):
    """Displacement of the struck point over the force, for an array of p."""
    place = body.get("position")
    if body["body"] == "rod":
        return rod(body, modulus)
    if body["body"] == "beam":
        x = place[0] if place else body["length"] * (1 if body["support"] == "cantilever" else 0.5)
        return beam(body, modulus, x)
    return plate(body, modulus, *(place or (body["length"] / 2, body["width"] / 2)))


def rod(body, modulus):
    """A rod struck at its end."""
    area = math.pi / 4 * body["diameter"] ** 2

    def compliance(p):
        q = modulus(p)
        k = p * np.sqrt(DENSITY / q)
        far = np.tanh(k * body["length"])
        return (1 / far if body["support"] == "free" else far) / (area * q * k)

    return compliance


def beam(body, modulus, place):
    """Euler and Bernoulli's beam: four waves on each side of the force, scaled where they are largest."""
    length, width, thickness = body["length"], body["width"], body["thickness"]
    ends = {
        "supported": ((0, 2), (0, 2)),
        "clamped": ((0, 1), (0, 1)),
        "cantilever": ((0, 1), (2, 3)),
        "free": ((2, 3), (2, 3)),
    }[body["support"]]

    def compliance(p):
        bending = modulus(p) * width * thickness**3 / 12
        k = (-DENSITY * width * thickness * p**2 / bending + 0j) ** 0.25
        root = np.stack([k, 1j * k, -k, -1j * k], -1)

        def wave(x, left, right, order):
            at = np.where(root.real > 0, right, left)
            return (root / np.abs(k)[..., None]) ** order * np.exp(root * (x - at))

        matrix = np.zeros((*p.shape, 8, 8), complex)
        right = np.zeros((*p.shape, 8), complex)
        rows = iter(range(8))
        near, far = (0, place), (place, length)
        for order in ends[0]:
            matrix[..., next(rows), :4] = wave(0, *near, order)
        jump = 1 / (bending * np.abs(k) ** 3)
        if place >= length:
            # the force is the shear force at the free end
            matrix, right = matrix[..., :4, :4], right[..., :4]
            matrix[..., 2, :] = wave(length, *near, 2)
            matrix[..., 3, :] = -wave(length, *near, 3)
            right[..., 3] = jump
        else:
            for order in ends[1]:
                matrix[..., next(rows), 4:] = wave(length, *far, order)
            for order in range(4):
                row = next(rows)
                matrix[..., row, :4] = -wave(place, *near, order)
                matrix[..., row, 4:] = wave(place, *far, order)
                right[..., row] = jump if order == 3 else 0
        amplitude = np.linalg.solve(matrix, right[..., None])[..., 0]
        return (amplitude[..., :4] * wave(place, *near, 0)).sum(-1)

    return compliance


def plate(body, modulus, x, y, terms=400):
    """A supported plate by Levy's series, its rest beyond the average as in statics."""
    length, width, thickness = body["length"], body["width"], body["thickness"]

    def compliance(p):
        bending = modulus(p) * thickness**3 / (12 * (1 - NU**2))
        square = np.sqrt(-DENSITY * thickness * p**2 / bending + 0j)
        total = np.zeros(p.shape, complex)

        def line(q):
            ends = (1 - np.exp(-2 * q * y)) * (1 - np.exp(-2 * q * (width - y)))
            return ends / (2 * q * (1 - np.exp(-2 * q * width)))

        for i in range(1, terms + 1):
            k = i * math.pi / length
            share = math.sin(k * x) ** 2
            if share > 1e-14:
                slow, fast = np.sqrt(k**2 - square), np.sqrt(k**2 + square)
                total += share / length * (line(slow) - line(fast)) / square
        return (total + length**2 / (8 * math.pi**3 * (terms + 0.5) ** 2)) / bending

    return compliance


def weights(response, step, count):
    """Weights of the quadrature of a response K(p), shape (count, 3, 3)."""
    points = 2 * count
    radius = CIRCLE ** (1 / points)
    values = np.empty((points, 3, 3), complex)
    for i, zeta in enumerate(radius * np.exp(2j * math.pi * np.arange(points) / points)):
        values[i] = np.linalg.inv(RADAU + zeta / (1 - zeta) * np.outer(np.ones(3), WEIGHT)) / step
    rate, vector = np.linalg.eig(values)
    values = vector * response(rate)[:, None, :] @ np.linalg.inv(vector)
    found = np.fft.fft(values, axis=0)[:count] / points
    return (found * radius ** -np.arange(count)[:, None, None]).real


def hertz(s):
    """u(s) and its slope."""
    return np.maximum(s, 0) ** 1.5, 1.5 * np.sqrt(np.maximum(s, 0))


def law_of(base, thickness):
    """u(s) and its slope of a pad; a force over a modulus."""
    law = Law(Shape({"shape": "sphere", "radius": BALL["radius"]}), base, NU, thickness, 0.003)

    def of(s):
        s = np.maximum(s, 0)
        return np.array([law.u(x) for x in s]), np.array([law.slope(x) for x in s])

    return of


def march(mass, velocity, yields, push, duration, count, law=hertz):
    """The march: yields(p) moves ball and structure apart; push is a factor K or a response K(p)."""
    step = duration / count
    of_force = weights(yields, step, count)
    of_dent = weights(push, step, count) if callable(push) else None
    force, dent, s = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(3)
    impulse, ends = 0.0, []
    for n in range(count):
        free = velocity * step * (n + NODE)
        known = np.zeros(3)
        if n:
            free = free - np.einsum("nij,nj->i", of_force[n:0:-1], force[:n])
            if of_dent is not None:
                known = np.einsum("nij,nj->i", of_dent[n:0:-1], dent[:n])
        now = of_dent[0] if of_dent is not None else push * np.eye(3)
        s = np.minimum(free, s[2])
        for _ in range(60):
            u, slope = law(s)
            left = s + of_force[0] @ (now @ u + known) - free
            change = np.linalg.solve(np.eye(3) + of_force[0] @ (now * slope), left)
            s = s - change
            if np.abs(change).max() < 1e-15 * np.abs(free).max():
                break
        dent[n] = law(s)[0]
        force[n] = now @ dent[n] + known
        before = force[n - 1, 2] if n else 0.0
        if of_dent is not None and force[n, 2] < 0:
            # Boltzmann's force passes through zero in this step, as the parabola through its nodes
            fit = np.polyfit([0, *NODE], [before, *force[n]], 3)
            end = min(x.real for x in np.roots(fit) if abs(x.imag) < 1e-9 and 0 < x.real <= 1)
            impulse += step * np.polyval(np.polyint(fit), end)
            return impulse / (mass * velocity) - 1, 1, step * (n + end), force.max()
        impulse += step * WEIGHT @ force[n]
        if before > 0 >= force[n, 2]:
            ends.append(step * (n + 1))
    return impulse / (mass * velocity) - 1, len(ends), ends[-1], force.max()


def make(steps, name, is_rigid, body, after, pad=None):
    """One impact, solved with N and N/2 steps."""
    text, modulus = MATERIALS[name]
    soft, softness = MATERIALS["rubber" if pad else name]
    mass = BALL["density"] * 4 / 3 * math.pi * BALL["radius"] ** 3
    factor = 4 / 3 * math.sqrt(BALL["radius"]) / (1 - NU**2)
    keys = ", ".join(
        f"{key} = '{value}'"
        if isinstance(value, str)
        else f"{key} = {str(value).strip('[]') if isinstance(value, list) else value}"
        for key, value in body.items()
    )
    model = "rigid" if is_rigid else "elastic', modulus = 210e9, poisson_ratio = 0.3, name = 'ball"
    case = (
        f"&impact velocity = 1.0 /\n&sphere radius = {BALL['radius']}, material = 'ball' /\n"
        f"&plate material = '{'rubber' if pad else 'body' if is_rigid else 'ball'}'"
        + (f", base = '{pad[0]}', thickness = {pad[1]}" if pad else "")
        + f" /\n&target {keys}, material = 'body' /\n"
        f"&material name = 'ball', model = '{model}', density = {BALL['density']} /\n"
        f"&material name = 'body', {text}, density = {DENSITY}, poisson_ratio = {NU} /\n"
    ).replace(", name = 'ball', density", ", density")
    if pad:
        case += f"&material name = 'rubber', {soft}, poisson_ratio = {NU} /\n"
        factor = 1 / (1 - NU**2)
    compliance = receptance(body, modulus)
    push = (lambda p: factor * softness(p)) if is_rigid else factor * STEEL / 2
    law = law_of(*pad) if pad else hertz
    coarse, fine = (
        march(mass, 1.0, lambda p: 1 / (mass * p**2) + compliance(p), push, after, n, law)
        for n in (steps // 2, steps)
    )
    return {
        "name": f"{body['body']} {body['support']}, {name}" + (", rigid ball" if is_rigid else "")
        + (f", pad {pad[0]}" if pad else ""),
        "case": case,
        "cor_sphere": fine[0],
        "contacts": fine[1],
        "last_separation": fine[2],
        "max_force": fine[3],
        "difference": float(abs(fine[0] - coarse[0])),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=6000)
    parser.add_argument("file", nargs="?", default=Path(__file__).with_name("structures.json"))
    options = parser.parse_args()
    rows = []
    for impact in IMPACTS:
        rows.append(make(options.steps, *impact))
        print(rows[-1]["name"], *(rows[-1][key] for key in list(rows[-1])[2:]), flush=True)
    Path(options.file).write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
