"""cor_sphere of rigid balls that strike a half space or a layer of glass, PMMA or rubber, with waves by full
elastodynamics and Boltzmann's law, computed as plainly as possible: numpy alone, no formula of vcor but the definition
of the compliance C(s). It prints a table of numbers over steps, takes half a minute to a minute, and writes nothing.

- Navier's equations for plane waves of wavenumber k, Laplace variable s: potentials phi, chi ~ exp(-al z), exp(-be z)
  from the loaded face and the same from the far one, one 4x4 system of the tractions of both faces per (k, s).
- Memory: the modulus is E0 + sum Ei s/(s + rate), Poisson's ratio constant (correspondence principle).
- C(s) by Gauss-Legendre quadrature over k; beyond 60/a it falls as sin^2(k a)/k^4, the mean of sin^2 is 1/2.
- The ramp response L^-1[C/s^2] by a sum over a line Re s = const with a smooth cut.
- Motion: the twice-integrated equation, force and indentation^1.5 linear over each step, second order, Newton's method.

cor_sphere is accurate to 3e-7. vcor (waves = 'body', law = 'boltzmann', accuracy 1e-9, footprint 0.00016947256 m for
glass, 0.00018507566 m for PMMA, 0.011051797 m for rubber) has cor_sphere 0.9941471, 0.8269918, 0.8131882 and 0.4562591,
max_force 58.054, 52.799, 8.2155 and 657.39 N.
"""

import math

import numpy as np

node, weight = np.polynomial.legendre.leggauss(10)


class Impact:
    """Thickness, E0, {rate: Ei}, Poisson's ratio and density of the plate; radius, density and velocity of the ball."""

    def __init__(self, thickness, rest, relaxing, poisson, density, radius, ball, velocity):
        self.thickness, self.rest, self.relaxing, self.velocity = thickness, rest, relaxing, velocity
        self.poisson, self.density = poisson, density
        self.mass = 4 / 3 * math.pi * radius**3 * ball
        self.geometry = 4 / 3 * math.sqrt(radius) / (1 - poisson**2)
        stiffness = self.geometry * (rest + sum(relaxing.values()))
        self.time_scale = (self.mass / (stiffness * math.sqrt(velocity))) ** 0.4
        self.footprint = 1.6 * math.sqrt(1.0936 * radius * velocity * self.time_scale)

    def shear(self, s: complex) -> complex:
        """Complex shear modulus."""
        return (self.rest + sum(e / (1 + rate / s) for rate, e in self.relaxing.items())) / (2 + 2 * self.poisson)

    def displacement(self, k: np.ndarray, s: complex) -> np.ndarray:
        """Displacement of the loaded face per pressure J0(k r), shape of k."""
        shear, n, thickness = self.shear(s), self.poisson, self.thickness
        slow = self.density * s * s / shear  # (s/c_s)^2
        al, be = np.sqrt(k * k + slow * (1 - 2 * n) / (2 - 2 * n)), np.sqrt(k * k + slow)
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

    def compliance(self, s: complex) -> complex:
        """C(s) = 1/(2 pi) int (k G - static) (sin(k a)/(k a))^2 dk [m/N], panels refined where waves travel."""
        wave, a = s * np.sqrt(self.density / self.shear(s)), self.footprint
        pole, reach = wave.real, 1.25 * abs(wave)
        end, edges = math.pi / a * math.ceil(max(2 * reach * a, 60) / math.pi), [0.0]
        while edges[-1] < end:
            k = edges[-1]
            edges.append(min(end, k + (min(pole, 2 / a, 0.15 * k + 0.3 * pole) if k < reach else min(0.3 * k, 2 / a))))
        edge = np.array(edges)
        half = np.diff(edge) / 2
        k, w = (edge[:-1, None] + half[:, None] * (1 + node)).ravel(), (half[:, None] * weight).ravel()
        w = np.append(w * (np.sin(k * a) / (k * a)) ** 2, 1 / (6 * end * a * a))
        k = np.append(k, end)
        return np.sum(w * (k * self.displacement(k, s) - (1 - self.poisson) / self.shear(s))) / (2 * math.pi)

    def march(self, lines: int = 1500) -> None:
        """Print cor_sphere and max_force of marches with more and more steps."""
        period = 1.35 * 3.22 * self.time_scale
        s = 20 / period + 2j * math.pi / period * np.arange(lines)
        at_once = -(1 - self.poisson) / self.shear(math.inf) / (4 * self.footprint)  # C(oo)
        f = (np.array([self.compliance(x) for x in s]) - at_once) / s**2 * 2 / period
        f[0] /= 2
        part = np.arange(lines) / lines
        f *= np.where(part < 0.7, 1, np.cos(np.pi / 2 * (part - 0.7) / 0.3) ** 2)
        for steps in (200, 400, 800, 1600):
            dt = 1.1 * 3.22 * self.time_scale / steps
            ramp = np.array([(np.exp(s * dt * n) @ f).real for n in range(steps + 1)])
            ramp[0] = 0
            w = np.diff(ramp) / dt
            time = dt * np.arange(steps + 1)
            lasting = sum((-e / rate * np.expm1(-rate * time) for rate, e in self.relaxing.items()), self.rest * time)
            memory = self.geometry * np.diff(lasting) / dt
            force, change, gain = np.zeros((3, steps + 1))
            impulse = second = indentation = power = 0.0
            for n in range(1, steps):
                past = memory[1:n] @ gain[n - 1 : 0 : -1] - memory[0] * power
                known = second + dt * impulse + dt * dt / 3 * force[n - 1]
                per_force = dt * dt / 6 / self.mass + at_once + w[0]
                free = self.velocity * time[n] - known / self.mass - w[1:n] @ change[n - 1 : 0 : -1]
                free += w[0] * force[n - 1] - per_force * past
                before = power
                indentation += self.velocity * dt * 1e-3
                for _ in range(50):
                    root = math.sqrt(abs(indentation))
                    power = indentation * root
                    indentation -= (indentation - free + per_force * memory[0] * power) / (
                        1 + 1.5 * per_force * memory[0] * root
                    )
                gain[n] = power - before
                force[n] = past + memory[0] * power
                change[n] = force[n] - force[n - 1]
                second = known + dt * dt / 6 * force[n]
                if force[n] <= 0:
                    break
                impulse += dt / 2 * (force[n] + force[n - 1])
            impulse += dt / 2 * force[n - 1] ** 2 / (force[n - 1] - force[n])
            rebound = impulse / (self.mass * self.velocity) - 1
            print(f"  {steps:4d} steps: cor_sphere {rebound:.7f}  max_force {force.max():.5g} N")


if __name__ == "__main__":
    glass, pmma = (70e9, {}, 0.22, 2500.0), (2.6e9, {3e4: 0.5e9, 4e5: 0.9e9}, 0.35, 1190.0)
    rubber = (3.75e6, {1200.0: 11.25e6}, 0.48, 1100.0)
    for name, impact in {
        "steel on glass, half space": Impact(1e3, *glass, 2e-3, 7800.0, 1.0),
        "steel on glass, 4 mm": Impact(4e-3, *glass, 2e-3, 7800.0, 1.0),
        "glass on PMMA, 10 mm": Impact(1e-2, *pmma, 1e-3, 2500.0, 3.1),
        "steel on rubber, 80 mm": Impact(8e-2, *rubber, 1e-2, 7800.0, 10.0),
    }.items():
        print(name)
        impact.march()
