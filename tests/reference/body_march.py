"""cor_sphere of a rigid steel ball (2 mm radius, 1 m/s) that strikes elastic glass, a half space and a plate of 4 mm,
with waves by full elastodynamics, computed as plainly as possible: numpy alone, no formula of vcor but the definition
of the compliance C(s). It prints a table of numbers over steps, a minute or two, and writes nothing.

- Navier's equations for plane waves of wavenumber k, Laplace variable s: potentials phi, chi ~ exp(-al z), exp(-be z)
  from the loaded face and the same from the far one, one 4x4 system of the tractions of both faces per (k, s).
- C(s) by Gauss-Legendre quadrature over k; the tail beyond 60/a falls as k^-4.
- The ramp response L^-1[C/s^2] by a sum over a line Re s = const with a smooth cut.
- Motion: the twice-integrated equation, force linear over each step, second order, Newton's method for s.

vcor (waves = 'body', accuracy 1e-9) has cor_sphere 0.9941471 and 0.8269918, max_force 58.0536 and 52.7990 N.
"""

import math

import numpy as np

young, poisson, density, radius, velocity = 70e9, 0.22, 2500.0, 2e-3, 1.0
mass = 4 / 3 * math.pi * radius**3 * 7800
stiffness = 4 / 3 * math.sqrt(radius) * young / (1 - poisson**2)
time_scale = (mass / (stiffness * math.sqrt(velocity))) ** 0.4
footprint = 1.6 * math.sqrt(1.0936 * radius * velocity * time_scale)
shear = young / (2 + 2 * poisson)
c_s = math.sqrt(shear / density)
c_p = c_s * math.sqrt((2 - 2 * poisson) / (1 - 2 * poisson))
static = (1 - poisson) / shear
node, weight = np.polynomial.legendre.leggauss(10)


def displacement(k: np.ndarray, s: complex, thickness: float) -> np.ndarray:
    """Displacement of the loaded face per pressure J0(k r), shape of k."""
    al, be = np.sqrt(k * k + (s / c_p) ** 2), np.sqrt(k * k + (s / c_s) ** 2)
    ea, eb, q, one = np.exp(-al * thickness), np.exp(-be * thickness), k * k + be * be, np.ones_like(al)
    # normal traction/mu = q phi + 2 k^2 chi', shear traction ~ 2 phi' + q chi, displacement = phi' + k^2 chi
    rows = [
        [q, q * ea, -2 * k * k * be, 2 * k * k * be * eb],
        [-2 * al, 2 * al * ea, q, q * eb],
        [q * ea, q, -2 * k * k * be * eb, 2 * k * k * be],
        [-2 * al * ea, 2 * al, q * eb, q],
    ]
    matrix = np.moveaxis(np.array([[x * one for x in row] for row in rows]), -1, 0)
    column = np.abs(matrix).max(axis=1)
    row = np.abs(matrix / column[:, None, :]).max(axis=2)
    right = np.zeros(al.shape + (4, 1), complex)
    right[:, 0, 0] = -1 / shear / row[:, 0]
    scaled = matrix / column[:, None, :] / row[:, :, None]
    a, b, c, d = (np.linalg.solve(scaled, right)[:, :, 0] / column).T
    return -al * a + al * ea * b + k * k * (c + eb * d)


def compliance(s: complex, thickness: float) -> complex:
    """C(s) = 1/(2 pi) int (k G - static) (sin(k a)/(k a))^2 dk [m/N], panels refined where waves travel."""
    pole, reach = s.real / c_s, 1.25 * abs(s) / c_s
    edges = [0.0]
    while edges[-1] < max(2 * reach, 60 / footprint):
        k = edges[-1]
        step = min(pole, 2 / footprint, 0.15 * k + 0.3 * pole) if k < reach else min(0.3 * k, 2 / footprint)
        edges.append(k + step)
    edge = np.array(edges)
    half = np.diff(edge) / 2
    k, w = (edge[:-1, None] + half[:, None] * (1 + node)).ravel(), (half[:, None] * weight).ravel()
    shape = (np.sin(k * footprint) / (k * footprint)) ** 2
    return np.sum(w * (k * displacement(k, s, thickness) - static) * shape) / (2 * math.pi)


def impact(thickness: float, lines: int = 1500) -> None:
    """Print cor_sphere and max_force of marches with more and more steps."""
    period = 1.35 * 3.22 * time_scale
    s = 16 / period + 2j * math.pi / period * np.arange(lines)
    at_once = -static / (4 * footprint)  # C(oo)
    f = (np.array([compliance(x, thickness) for x in s]) - at_once) / s**2 * 2 / period
    f[0] /= 2
    part = np.arange(lines) / lines
    f *= np.where(part < 0.7, 1, np.cos(np.pi / 2 * (part - 0.7) / 0.3) ** 2)
    for steps in (200, 400, 800, 1600):
        dt = 1.1 * 3.22 * time_scale / steps
        ramp = np.array([(np.exp(s * dt * n) @ f).real for n in range(steps + 1)])
        ramp[0] = 0
        w = np.diff(ramp) / dt
        force, change = np.zeros(steps + 1), np.zeros(steps + 1)
        impulse = second = indentation = 0.0
        for n in range(1, steps):
            known = second + dt * impulse + dt * dt / 3 * force[n - 1]
            per_force = dt * dt / 6 / mass + at_once + w[0]
            free = velocity * n * dt - known / mass - w[1:n] @ change[n - 1 : 0 : -1] + w[0] * force[n - 1]
            indentation += velocity * dt * 1e-3
            for _ in range(50):
                root = math.sqrt(abs(indentation))
                indentation -= (indentation - free + per_force * stiffness * indentation * root) / (
                    1 + 1.5 * per_force * stiffness * root
                )
            force[n] = stiffness * indentation * math.sqrt(abs(indentation))
            change[n] = force[n] - force[n - 1]
            second = known + dt * dt / 6 * force[n]
            if force[n] <= 0:
                break
            impulse += dt / 2 * (force[n] + force[n - 1])
        print(f"  {steps:4d} steps: cor_sphere {impulse / (mass * velocity) - 1:.7f}  max_force {force.max():.4f} N")


if __name__ == "__main__":
    for name, thickness in (("half space", 1e3), ("plate of 4 mm", 4e-3)):
        print(f"glass, {name}")
        impact(thickness)
