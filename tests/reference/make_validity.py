"""Reference of the measures of validity: validity.txt, which tests/cli/test_validity_reference.py reads.

Random practical impacts (the draw of make_impacts.py with a seed of its own) are solved by
impact_solver.py; each measure follows from its definition, written out below, with the force, the
indentation and the plate's displacement over time of that solver.  Nothing of vcor is used.

Usage:  make_validity.py [--check] [--count N] [--output DIR]
        --check   solve the impacts of validity.txt again and print how far the numbers are
"""

import argparse
import functools
import math
import os
import pathlib

os.environ.setdefault("OMP_NUM_THREADS", "1")

import mpmath as mp
import numpy as np
from impact_solver import Contact, Impact, NoSeparation, meshes
from make_impacts import Draw, case_of, head, text_of
from numpy.polynomial import chebyshev as cheb
from scipy.optimize import brentq

HERE = pathlib.Path(__file__).parent
SEED, COUNT = 18, 24
GRAVITY = 9.80665
COLUMNS = ["cor", "cor_sphere", "resilience", "contact_radius", "contact_ratio",
           "thickness_ratio", "plate_wave_number", "needed_extent", "deflection_ratio",
           "weight_ratio", "mean_pressure", "peak_loss_tangent"]
LEVELS = ["good", "caution", "outside"]
# what is judged: limits of caution and of outside; docs/validity.md gives the reasons
LIMITS = {"contact_ratio": (0.4, 0.8), "deflection_ratio": (0.3, 1.0), "weight_ratio": (0.01, 0.1)}
# a sphere that deforms: its share of contact_ratio is compared with the limits
SPHERE_WEIGHT = 3.0


# ------------------------------------------------------------------------------------ half space

@functools.cache
def radiation_shares(nu):
    """Pressure, shear and Rayleigh part of I(nu), Lamb's point compliance of the half space.

    Slowness e in units of 1/c_s, g = c_s/c_p: a = sqrt(g^2 - e^2) and b = sqrt(1 - e^2) belong to
    pressure and shear waves.  A normal point force sends into body waves of slowness e the power
    of each of its potentials; the Rayleigh wave is half the residue at the zero of Rayleigh's
    function, that is pi times its weight."""
    with mp.workdps(25):
        nu = mp.mpf(nu)
        g2 = (1 - 2 * nu) / (2 * (1 - nu))
        g = mp.sqrt(g2)

        def below(e):
            """Squared Rayleigh function where both waves travel."""
            return ((1 - 2 * e * e) ** 2
                    + 4 * e * e * mp.sqrt(abs(g2 - e * e)) * mp.sqrt(1 - e * e)) ** 2

        def above(e):
            """The same where pressure waves are evanescent."""
            return (1 - 2 * e * e) ** 4 + 16 * e ** 4 * (e * e - g2) * (1 - e * e)

        def rayleigh(e):
            return (2 * e * e - 1) ** 2 - 4 * e * e * mp.sqrt(e * e - g2) * mp.sqrt(e * e - 1)

        pressure = shear = mp.mpf(0)
        if g2 > 0:
            pressure = mp.quad(lambda e: e * mp.sqrt(abs(g2 - e * e)) * (1 - 2 * e * e) ** 2
                               / below(e), [0, g / 2, g])
            shear = mp.quad(lambda e: 4 * e ** 3 * (g2 - e * e) * mp.sqrt(1 - e * e)
                            / below(e), [0, g / 2, g])
        shear += mp.quad(lambda e: 4 * e ** 3 * (e * e - g2) * mp.sqrt(abs(1 - e * e))
                         / above(e), [g, (g + 1) / 2, 1])
        e = mp.findroot(rayleigh, (mp.mpf("1.0001"), mp.mpf("1.2")), solver="anderson")
        surface = -mp.pi * e * mp.sqrt(e * e - g2) / mp.diff(rayleigh, e)
        return float(pressure), float(shear), float(surface)


def radiation(nu):
    """I(nu): the power of a force F(t) on a half space is I/(2 pi rho c_s^3) (dF/dt)^2."""
    return sum(radiation_shares(nu))


# --------------------------------------------------------------------------------------- motion

def top(c, upto):
    """Place and value of the largest value of a Chebyshev series on [-1, upto]."""
    d = cheb.chebder(c)
    grid = np.linspace(-1, upto, 60)
    slope = cheb.chebval(grid, d)
    found = [-1.0, upto]
    found += [brentq(lambda x: cheb.chebval(x, d), grid[i], grid[i + 1], xtol=1e-15)
              for i in range(59) if slope[i] > 0 >= slope[i + 1]]
    return max(((float(cheb.chebval(z, c)), z) for z in found), key=lambda pair: pair[0])


class Watched(Contact):
    """The solver, with the largest displacement of the plate and the indentation at the largest
    force."""

    def __init__(self, impact, mesh):
        super().__init__(impact, mesh)
        self.plate_max = self.s_of_force = 0.0

    def accept(self, e, upto=1.0):
        p, mesh, y0, h = self.p, self.mesh, e["y0"], e["h"]
        force, s, impulse = (mesh.to_coef @ e[f] for f in ("force", "s", "impulse"))
        largest, z = top(force, upto)
        if largest > self.fmax:
            self.s_of_force = float(cheb.chebval(z, s))
        # U = v0 t - J/m - s, J the integral of the impulse, dt = 2 y dy
        root = np.array([y0 + h / 2, h / 2])
        j = cheb.chebint(h * cheb.chebmul(impulse, root), lbnd=-1)
        j[0] += self.at["j"]
        u = cheb.chebsub(cheb.chebsub(p.v0 * cheb.chebmul(root, root), j / p.m), s)
        if p.plate_factor:
            self.plate_max = max(self.plate_max, top(u, upto)[0])
        return super().accept(e, upto)


# ------------------------------------------------------------------------------------- measures

def leffler(t, a):
    """E_a(-t^a) for complex t by its spectrum, the trapezoidal rule in the logarithm of the rate."""
    y = np.arange(-37 / a, 37 / a, 0.04)
    power = np.exp(a * y)
    weight = 0.04 * math.sin(math.pi * a) / math.pi * power / (
        power ** 2 + 2 * power * math.cos(math.pi * a) + 1)
    rate = np.exp(np.clip(y, -600, 600))
    return np.array([np.sum(weight * np.exp(-rate * x)) for x in t])


def plane(material, t):
    """Plane modulus at complex times."""
    if material.model != "mittag_leffler":
        return material.plane(t)
    keys = material.keys
    return (material.e0 + keys["relaxing_modulus"] * leffler(t / keys["time"], keys["exponent"])
            ) / (1 - material.nu ** 2)


def loss_tangent(impact, w):
    """Loss over storage of the contact modulus; the pairs by Eq. (1) that the solver leaves out
    have a Mittag-Leffler body: i w int E'(t) exp(-i w t) dt along t = r exp(-i pi/4)."""
    known = impact.loss_tangent(w)
    if not math.isnan(known):
        return known
    nodes, weights = np.polynomial.legendre.leggauss(20)
    edges = [0.0, 1e-40 / w]
    while edges[-1] < 64 / w:
        edges.append(edges[-1] + min(edges[-1], 1 / w))
    half = np.diff(edges)[:, None] / 2
    turn = np.exp(-0.25j * math.pi)
    t = (np.array(edges)[:-1, None] + half * (1 + nodes)).ravel() * turn
    e = [plane(x, t) for x in (impact.a, impact.b)]
    value = 1j * w * np.sum((half * weights).ravel() * turn * e[0] * e[1] / (e[0] + e[1])
                            * np.exp(-1j * w * t))
    return float(value.imag / value.real)


def measures(case, mesh):
    """All measures of a case by their definitions; nan where there is none."""
    impact = Impact(case)
    contact = Watched(impact, mesh)
    out = contact.run()
    a, b, plate = impact.a, impact.b, case["plate"]
    t0, force = out["contact_time"], out["max_force"]
    w = math.pi / t0                    # of the half sine that the force resembles
    moves = impact.waves != "none" and b.model != "rigid"
    thickness = 2 * plate["half_thickness"] if "half_thickness" in plate else math.nan
    modulus = [math.inf if x.model == "rigid" else complex(x.complex_plane(1j * w))
               for x in (a, b)]
    value = dict.fromkeys(COLUMNS, math.nan)
    value["cor"], value["cor_sphere"] = out["cor"], out["cor_sphere"]
    value["resilience"] = out["cor_sphere"] ** 2
    radius = math.sqrt(impact.radius * out["max_indentation"])
    value["contact_radius"] = radius
    value["contact_ratio"] = radius / min(impact.radius, case["sphere"]["radius"])
    # the plate's share of the compliance, (1/|E'_b|)/(1/|E'_a| + 1/|E'_b|)
    share = (0.0 if b.model == "rigid" else 1.0 if a.model == "rigid"
             else abs(modulus[0]) / (abs(modulus[0]) + abs(modulus[1])))
    value["thickness_ratio"] = radius / thickness * share
    # the same of the spheres: that of the case and, on a convex surface, a second one
    second = max(plate.get("surface_radius", 0.0), 0.0)
    spheres = radius * ((1 - share) / case["sphere"]["radius"] + (share / second if second else 0))
    value["weight_ratio"] = impact.m * GRAVITY / force
    value["mean_pressure"] = force / (math.pi * impact.radius * contact.s_of_force)
    value["peak_loss_tangent"] = loss_tangent(impact, w)
    if moves:
        storage = modulus[1].real * (1 - b.nu ** 2)
        k = (12 * b.density * (1 - b.nu ** 2) * w ** 2 / (storage * thickness ** 2)) ** 0.25
        value["plate_wave_number"] = k * thickness
        value["needed_extent"] = math.pi / k
        value["deflection_ratio"] = contact.plate_max / thickness
    return value, out | {"judged": judge(value, spheres)}


def judge(value, spheres):
    """The worst level of all measures but cor_deviation, and the measure that is farthest beyond its first limit
    among those of that level."""
    level, cause, farthest = "good", "none", 0.0
    for name, (caution, outside) in LIMITS.items():
        x = value[name]
        if name == "contact_ratio":
            x = max(x, SPHERE_WEIGHT * spheres)
        own = "outside" if x >= outside else "caution" if x >= caution else "good"
        if LEVELS.index(own) < LEVELS.index(level) or own == "good":
            continue
        if own != level or x / caution > farthest:
            level, cause, farthest = own, name, x / caution
    return level, cause


def solve(case):
    """Measures on the fine mesh, the outcome, and the largest relative difference of a second
    mesh."""
    (fine, out), (coarse, _) = (measures(case, mesh) for mesh in meshes())
    error = max(abs(fine[k] - coarse[k]) / abs(fine[k]) for k in COLUMNS
                if fine[k] == fine[k] and fine[k] != 0)
    return fine, out, error


# ------------------------------------------------------------------------------------------ file

def read_set(path):
    """Number, text, expected measures, validity and its cause of each impact."""
    for block in path.read_text(encoding="utf-8").split("! impact ")[1:]:
        number, numbers, judged, text = block.split("\n", 3)
        yield (int(number), text, dict(zip(COLUMNS, map(float, numbers.split()[2:]))),
               judged.split()[2:])


def make(count, path):
    draw = Draw(SEED)
    lines = head(f"Measures of validity, made by make_validity.py, seed {SEED}.",
                 "Expected: " + ", ".join(COLUMNS) + "; validity, validity_cause")
    number, worst = 0, 0.0
    while number < count:
        case = draw.case()
        try:
            value, out, error = solve(case)
        except (NoSeparation, RuntimeError, np.linalg.LinAlgError, ValueError) as trouble:
            print("left out:", trouble, flush=True)
            continue
        if out["cor_sphere"] < 0.01 or error > 1e-9:
            print("left out: cor", out["cor_sphere"], "error", error, flush=True)
            continue
        number += 1
        worst = max(worst, error)
        numbers = " ".join(repr(float(value[k])) for k in COLUMNS)
        level, cause = out["judged"]
        lines += (f"! impact {number}\n! expect {numbers}\n! judged {level} {cause}\n"
                  f"{text_of(case)}")
        print(f"{number:3d} cor {out['cor']:.9f} two meshes {error:.1e}", flush=True)
    path.write_text(lines, encoding="utf-8")
    print("largest difference of two meshes", worst)


def check(path):
    for number, text, expected, _ in read_set(path):
        value, _, error = solve(case_of(text))
        off = max(abs(value[k] - expected[k]) / abs(expected[k]) for k in COLUMNS
                  if expected[k] == expected[k] and expected[k] != 0)
        print(f"{number:3d} {off:.1e}, two meshes {error:.1e}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="solve the impacts of the set again")
    parser.add_argument("--count", type=int, default=COUNT)
    parser.add_argument("--output", default=HERE, type=pathlib.Path)
    options = parser.parse_args()
    path = options.output / "validity.txt"
    if options.check:
        check(path)
    else:
        make(options.count, path)


if __name__ == "__main__":
    main()
