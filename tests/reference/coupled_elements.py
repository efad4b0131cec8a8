"""Impacts with waves by explicit finite elements: a check of method coupled that has no transform and no formula of it.

A rigid paraboloid strikes a linear layer: axisymmetric quadrilaterals of four nodes with the volumetric strain averaged
over an element (so that nearly incompressible layers do not lock), lumped masses, central differences, unilateral
contact without friction that makes the nodes under the body and the body move as one, relaxation by one internal
variable a node and exponential (constant Poisson's ratio). Cells are equal under the contact and grow away from it by a
factor from one to the next.

    python coupled_elements.py            # all rows, some ten minutes
    python coupled_elements.py 0 1        # the first and the second

cor_sphere with growth 1.06 and 1.03, extrapolated to none as its error is of second order, and by method coupled:

    steel ball (radius 2 mm) on 4 mm of glass, 1 m/s       0.827362  0.827081   0.82699   0.82696
    the same on 2 mm of glass                              0.493714  0.492184   0.49167   0.49168
    the paper's rubber with nu 0.48, 40 mm, 10 m/s         0.380300  0.380194   0.38016   0.38017
    the same, 20 mm, 5 m/s                                 0.095423  0.095185   0.09511   0.09510
    the same, 10 mm bonded to a floor, 2 m/s               0.607442  0.607432   0.60743   0.60743
    the same, 10 mm sliding on a floor, 2 m/s              0.581391  0.581388   0.58139   0.58139
"""

import math
import sys
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import csr_matrix


@dataclass(frozen=True)
class Case:
    """A layer, a ball, and the mesh: SI units; `contact` bounds the contact radius, `extent` is the radius of the mesh."""

    name: str
    base: str
    thickness: float
    young: float
    relaxing: float
    rate: float
    poisson: float
    density: float
    radius: float
    ball_density: float
    velocity: float
    contact: float
    extent: float
    end: float
    cell: float


GLASS = {
    "young": 70e9, "relaxing": 0.0, "rate": 1.0, "poisson": 0.22, "density": 2500.0, "radius": 0.002, "ball_density": 7800.0
}
RUBBER = {
    "young": 3.75e6, "relaxing": 11.25e6, "rate": 1200.0, "poisson": 0.48, "density": 1100.0, "radius": 0.01,
    "ball_density": 7800.0
}
CASES = (
    Case("steel ball on 4 mm of glass", "free", 0.004, **GLASS, velocity=1.0, contact=1.4e-4, extent=0.06, end=2.5e-5,
         cell=6e-6),
    Case("steel ball on 2 mm of glass", "free", 0.002, **GLASS, velocity=1.0, contact=1.4e-4, extent=0.06, end=2.7e-5,
         cell=6e-6),
    Case("rubber 40 mm, 10 m/s", "free", 0.04, **RUBBER, velocity=10.0, contact=8e-3, extent=0.3, end=1.7e-3,
         cell=2e-4),
    Case("rubber 20 mm, 5 m/s", "free", 0.02, **RUBBER, velocity=5.0, contact=6.5e-3, extent=0.3, end=2.4e-3,
         cell=2e-4),
    Case("rubber 10 mm bonded, 2 m/s", "bonded", 0.01, **RUBBER, velocity=2.0, contact=5e-3, extent=0.15, end=2.2e-3,
         cell=1e-4),
    Case("rubber 10 mm sliding, 2 m/s", "sliding", 0.01, **RUBBER, velocity=2.0, contact=5e-3, extent=0.25, end=2.2e-3,
         cell=1e-4),
)


def edges(length: float, fine: float, cell: float, growth: float) -> np.ndarray:
    """Equal cells on 0 .. fine, then cells that grow geometrically to `length`."""
    near = np.linspace(0.0, fine, round(fine / cell) + 1)
    if length <= fine:
        return np.linspace(0.0, length, max(2, round(length / cell)) + 1)
    count = max(1, math.ceil(math.log(1.0 + (length - fine) * (growth - 1.0) / cell) / math.log(growth)))
    if count * cell >= length - fine:
        ratio = 1.0
    else:
        ratio = brentq(lambda q: cell * q * (q**count - 1.0) / (q - 1.0) - (length - fine), 1.0 + 1e-9, 3.0)
    sizes = cell * ratio ** np.arange(1, count + 1)
    return np.append(near, fine + np.cumsum(sizes) * (length - fine) / np.sum(sizes))


def assemble(r: np.ndarray, z: np.ndarray, poisson: float, density: float) -> tuple[csr_matrix, np.ndarray]:
    """Stiffness for Young's modulus 1, and lumped masses; node i, j has the number i*len(z) + j, freedoms r and z."""
    rows = len(z)
    i, j = (part.ravel() for part in np.meshgrid(np.arange(len(r) - 1), np.arange(rows - 1), indexing="ij"))
    nodes = np.stack([i * rows + j, (i + 1) * rows + j, (i + 1) * rows + j + 1, i * rows + j + 1], axis=1)
    half_r, half_z, middle = (r[i + 1] - r[i]) / 2, (z[j + 1] - z[j]) / 2, (r[i + 1] + r[i]) / 2
    shear = 0.5 / (1.0 + poisson)
    bulk = 1.0 / (3.0 * (1.0 - 2.0 * poisson))
    side, height = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    strains, weights, mass = [], [], np.zeros((len(i), 4))
    for x in (-1 / math.sqrt(3), 1 / math.sqrt(3)):
        for y in (-1 / math.sqrt(3), 1 / math.sqrt(3)):
            shape = (1 + side * x) * (1 + height * y) / 4
            along_r = side * (1 + height * y) / 4 / half_r[:, None]
            along_z = height * (1 + side * x) / 4 / half_z[:, None]
            radius = middle + half_r * x
            strain = np.zeros((len(i), 4, 8))  # rr, hoop, zz, shear
            strain[:, 0, 0::2] = along_r
            strain[:, 1, 0::2] = shape / radius[:, None]
            strain[:, 2, 1::2] = along_z
            strain[:, 3, 0::2] = along_z
            strain[:, 3, 1::2] = along_r
            weight = 2 * math.pi * radius * half_r * half_z
            strains.append(strain)
            weights.append(weight)
            mass += weight[:, None] * shape * density
    volume = sum(weights)
    dilatation = sum(w[:, None] * b[:, :3].sum(axis=1) for w, b in zip(weights, strains)) / volume[:, None]
    stiffness = bulk * np.einsum("e,ei,ej->eij", volume, dilatation, dilatation)
    modulus = np.array([2 * shear, 2 * shear, 2 * shear, shear])
    for weight, strain in zip(weights, strains):
        deviator = strain.copy()
        deviator[:, :3] -= strain[:, :3].sum(axis=1)[:, None, :] / 3
        stiffness += np.einsum("e,eai,a,eaj->eij", weight, deviator, modulus, deviator)
    freedoms = np.stack([nodes * 2, nodes * 2 + 1], axis=2).reshape(len(i), 8)
    size = 2 * len(r) * rows
    place = (np.repeat(freedoms, 8, axis=1).ravel(), np.tile(freedoms, (1, 8)).ravel())
    masses = np.zeros(len(r) * rows)
    np.add.at(masses, nodes.ravel(), mass.ravel())
    return csr_matrix((stiffness.ravel(), place), shape=(size, size)), masses


def fixed_freedoms(case: Case, columns: int, rows: int) -> np.ndarray:
    """Freedoms that do not move: the axis along r, and those of the floor."""
    axis = 2 * np.arange(rows)
    floor = np.arange(columns) * rows
    if case.base == "bonded":
        return np.unique(np.concatenate([axis, 2 * floor, 2 * floor + 1]))
    if case.base == "sliding":
        return np.unique(np.concatenate([axis, 2 * floor + 1]))
    return axis


def impact(case: Case, growth: float) -> float:
    """cor_sphere with cells that grow by a factor."""
    r = edges(case.extent, case.contact, case.cell, growth)
    z = case.thickness - edges(case.thickness, 0.6 * case.contact, case.cell, growth)[::-1]
    stiffness, masses = assemble(r, z, case.poisson, case.density)
    rows, ball = len(z), case.ball_density * 4 / 3 * math.pi * case.radius**3
    glassy = case.young + case.relaxing
    fastest = math.sqrt(glassy * (1 - case.poisson) / ((1 + case.poisson) * (1 - 2 * case.poisson)) / case.density)
    dt = 0.45 * min(np.diff(r).min(), np.diff(z).min()) / fastest
    under = np.flatnonzero(r <= case.contact)
    face = 2 * (under * rows + rows - 1) + 1
    face_mass, profile = masses[under * rows + rows - 1], r[under] ** 2 / (2 * case.radius)
    fixed, per_mass = fixed_freedoms(case, len(r), rows), dt * dt / np.repeat(masses, 2)
    decay = math.exp(-case.rate * dt)
    gain = (1 - decay) / (case.rate * dt)
    now, before, memory = (np.zeros(stiffness.shape[0]) for _ in range(3))
    height, height_before, impulse, idle = 0.0, -case.velocity * dt, 0.0, 0
    for _ in range(int(case.end / dt)):
        following = 2 * now - before - per_mass * (stiffness @ (case.young * now + case.relaxing * memory))
        following[fixed] = 0.0
        free = 2 * height - height_before
        deflection = -following[face]
        pressed = deflection < free - profile
        for _ in range(20):
            if pressed.any():
                height_next = (ball * free + (face_mass * (deflection + profile))[pressed].sum()) / (
                    ball + face_mass[pressed].sum())
            else:
                height_next = free
            update = deflection < height_next - profile
            if np.array_equal(update, pressed):
                break
            pressed = update
        force = np.where(pressed, face_mass * (height_next - profile - deflection) / dt**2, 0.0)
        following[face] -= force * dt**2 / face_mass
        impulse += force.sum() * dt
        memory = memory * decay + (following - now) * gain
        before, now = now, following
        height_before, height = height, height_next
        idle = 0 if pressed.any() else idle + 1
        if idle > 200 and impulse > ball * case.velocity:
            break
    return impulse / (ball * case.velocity) - 1.0


def main() -> None:
    """Print the rows named on the command line."""
    for number in map(int, sys.argv[1:] or range(len(CASES))):
        case = CASES[number]
        coarse, fine = impact(case, 1.06), impact(case, 1.03)
        print(f"{case.name}: {coarse:.6f} {fine:.6f}, extrapolated {(4 * fine - coarse) / 3:.5f}", flush=True)


if __name__ == "__main__":
    main()
