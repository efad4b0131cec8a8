"""The numbers behind the thresholds of docs/validity.md: what each assumption costs, by the measure
that watches it.  Prints tables, writes nothing.  Nothing of vcor is used.

Usage:  make_thresholds.py [NAME ...]    contact layer sphere plate edge membrane half_space
"""

import itertools
import math
import sys

import mpmath as mp
import numpy as np
from make_validity import radiation, radiation_shares
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import j1, jn_zeros

# ------------------------------------------------------------------- impacts of another force law

def elastic_impact(force, indentation):
    """Energy, contact time and largest force of an elastic impact of unit mass with this indentation."""
    def energy(d):
        return quad(lambda y: 2 * y * force(y * y), 0, math.sqrt(d))[0]

    top = energy(indentation)

    def rate(angle):
        d = indentation * math.sin(angle) ** 2
        return 2 * math.sin(angle) * math.cos(angle) * indentation / math.sqrt(2 * (top - energy(d)))

    return top, 2 * quad(rate, 0, math.pi / 2 - 1e-6, limit=200)[0], force(indentation)


def compare_with_hertz(force, indentation):
    """By how much contact time and largest force differ from Hertz' at the energy that brings
    Hertz' contact to this indentation; force tends to indentation^1.5."""
    energy, time, largest = elastic_impact(lambda d: d ** 1.5, indentation)
    own = brentq(lambda d: elastic_impact(force, d)[0] - energy, 0.3 * indentation, 2 * indentation)
    _, t, f = elastic_impact(force, own)
    return t / time - 1, f / largest - 1


def sneddon(d):
    """Force of a rigid sphere of radius 1 on an incompressible half space, 4/3 E' = 1."""
    if d < 1e-6:
        return d ** 1.5

    def log(a):
        return math.log((1 + a) / (1 - a))

    a = brentq(lambda a: a / 2 * log(a) - d, 1e-9, 1 - 1e-15)
    return 0.375 * ((a * a + 1) * log(a) - 2 * a)


def contact():
    print("a/R by Hertz; force at the same indentation, contact time and largest force against Hertz")
    print("  a/R    sphere's true shape (Sneddon)      neo-Hookean, 1 - 0.15 d/R")
    for x in (0.1, 0.2, 0.4, 0.6, 0.67, 0.8, 0.95):
        row = []
        for law in (sneddon, lambda d: d ** 1.5 * (1 - 0.15 * d)):
            time, largest = compare_with_hertz(law, x * x)
            row.append(f"{law(x * x) / x ** 3 - 1:+8.4f} {time:+8.4f} {largest:+8.4f}")
        print(f"  {x:.2f} {'     '.join(row)}")


def layer():
    print("a/(2h); force at the same indentation, contact time and largest force against a half space")
    laws = {"bonded": (1.133, 1.283, 0.769, 0.0975), "unbonded": (0.884, 0.781, 0.386, 0.0048)}
    for name, c in laws.items():
        def factor(x, c=c):
            return 1 + x * (c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        for x in (0.05, 0.1, 0.2, 0.3):
            time, largest = compare_with_hertz(
                lambda d, x=x, factor=factor: d ** 1.5 * factor(x * math.sqrt(d)), 1.0)
            print(f"  {name:8s} {x:.2f} {factor(x) - 1:+8.3f} {time:+8.3f} {largest:+8.3f}")


# ---------------------------------------------------------------------------------------- sphere

def sphere_compliance(x, nu):
    """Dent of a free elastic sphere under Hertz' pressure over the radius x = a/r, held up by its
    inertia, over that of a half space, less one.

    Surface displacement of the pressure p_n P_n(cos theta) of a sphere, 2 mu = r = 1 (Lur'e);
    n = 1, the resultant, goes with a uniform body force."""
    nodes, weights = leggauss(2000)
    theta, weight = (nodes + 1) / 2 * math.asin(x), weights / 2 * math.asin(x)
    mu, area = np.cos(theta), np.sin(theta) * weight
    p = np.sqrt(np.maximum(1 - (np.sin(theta) / x) ** 2, 0))
    force = 2 * math.pi * np.sum(p * mu * area)
    old, new = np.ones_like(mu), mu.copy()
    indentation = np.sum(p * area) / 2 * (1 - 2 * nu) / (1 + nu) + 1.5 * np.sum(p * mu * area) * first(nu)
    count = int(60 / x)
    sums = []
    for n in range(2, count + 1):
        old, new = new, ((2 * n - 1) * mu * new - (n - 1) * old) / n
        u = (n * (n * n + 2 * n - 1 + 2 * nu) / (n - 1) - (n + 1) * (n - 2 + 4 * nu)) / (
            2 * (n * n + n + 1 + nu * (2 * n + 1)))
        indentation += (2 * n + 1) / 2 * np.sum(p * new * area) * u
        sums.append(indentation)
    half_space = 3 * (1 - nu ** 2) * force / (4 * (1 + nu) * x)
    return np.mean(sums[-count // 4:]) / half_space - 1


def first(nu):
    """Displacement of the centre of mass less that of the pole under the pressure cos(theta) and
    a uniform body force, 2 mu = r = 1: u_rho = c rho z, u_z = a rho^2 + b z^2."""
    lam = nu / (1 - 2 * nu)          # Lame's lambda, 2 mu = 1
    # strains: e_rho = e_phi = c z, e_z = 2 b z, gamma = (c + 2 a) rho
    # s_rho = (2 lam (c + b) + c) z, s_z = (2 lam (c + b) + 2 b) z, tau = (c + 2 a) rho/2
    # traction rho: (s_rho + tau) rho z, z: tau rho^2 + s_z z^2; to be -(z rho, z^2)
    matrix = np.array([[0.0, 2 * lam, 2 * lam + 1],     # s_rho/z
                       [0.0, 2 * lam + 2, 2 * lam],     # s_z/z
                       [1.0, 0.0, 0.5]])                # tau/rho
    rows = np.array([matrix[0] + matrix[2], matrix[1], matrix[2]])
    a, b, _ = np.linalg.solve(rows, [-1.0, -1.0, 0.0])
    return 0.4 * a + 0.2 * b - b     # means of rho^2 and z^2 over the ball: 2/5, 1/5


def sphere():
    print("free elastic sphere, rigid plane: indentation at the same force, first order; contact time")
    print("and largest force of an impact, against Hertz")
    for nu in (0.25, 0.3, 0.4, 0.499):
        for x in (0.05, 0.1, 0.2, 0.3):
            c = -sphere_compliance(x, nu) / x

            def law(d, c=c, x=x):
                # d = f^2 (1 - c x f), force f^3, Hertz' indentation is 1
                return brentq(lambda f: f * f * (1 - c * x * f) - d, 0, 2 / (3 * c * x)) ** 3

            time, largest = compare_with_hertz(law, 1.0)
            print(f"  nu {nu:.3f} a/r {x:.2f} indentation {-c * x:+.4f} time {time:+.3f} "
                  f"force {largest:+.3f}")


# ----------------------------------------------------------------------------------------- plate

def compliance(s, nu, a_f=0.0):
    """C(s) of a layer of thickness 1 with mu = rho = 1: displacement of the loaded face under a
    point force beyond the static half space's indentation, by Rayleigh and Lamb's equations."""
    ratio = 2 * (1 - nu) / (1 - 2 * nu)

    def integrand(k):
        al, be = np.sqrt(k * k + s * s / ratio), np.sqrt(k * k + s * s)
        big, small = (k * k + be * be) ** 2, 4 * k * k * al * be
        ta, tb = np.tanh(al / 2), np.tanh(be / 2)
        g = al * s * s / 2 * (ta * tb / (big * tb - small * ta) + 1 / (big * ta - small * tb))
        return (g - (1 - nu) / k) * k

    nodes, weights = leggauss(24)
    total = 0j
    edges = np.concatenate([np.linspace(0, 4, 41), np.geomspace(4, 400, 40)[1:]]) * max(
        1.0, abs(s) / 3)
    for low, high in itertools.pairwise(edges):
        k = low + (high - low) * (nodes + 1) / 2
        total += np.sum(weights * integrand(k)) * (high - low) / 2
    return total / (2 * math.pi)


def plate():
    print("radiated energy of a half sine of force: thin plate against the layer, nu = 0.22")
    nu = 0.22
    for kh in (0.3, 0.5, 0.66, 0.7, 0.93, 1.32, 1.97):
        w = kh ** 2 / math.sqrt(6 * (1 - nu))       # of half sine, in c_s/H
        t0 = math.pi / w
        sigma = 0.5 / t0
        x = np.linspace(0, 40 * w, 1601)
        s = sigma + 1j * x
        energy = [(w * (1 + np.exp(-z * t0)) / (z * z + w * w)
                   * w * (1 + np.exp(z * t0)) / (z * z + w * w) * z * compliance(z, nu)).real
                  for z in s]
        layer_energy = np.trapezoid(energy, x) / math.pi
        # 1/(8 sqrt(D rho H)), D = E H^3/(12 (1 - nu^2)) = mu H^3/(6 (1 - nu)); int F^2 = t0/2
        thin = math.sqrt(6 * (1 - nu)) / 8 * t0 / 2
        print(f"  kH {kh:.2f} layer/thin {layer_energy / thin:.4f}, thin too small by "
              f"{1 - thin / layer_energy:.3f} of the layer's")


def edge():
    print("energy radiated by a half sine of force at the centre of a simply supported plate, edge at")
    print("L, against that of an infinite one: round, square")
    zeros = jn_zeros(0, 4000)
    odd = np.arange(1, 400, 2)

    def energy(frequency, inverse_mass):
        """Energy left in the modes; half sine of unit force and frequency."""
        with np.errstate(all="ignore"):
            square = np.where(abs(frequency - 1) < 1e-6, (math.pi / 2) ** 2,
                              (2 * np.cos(math.pi * frequency / 2) / (1 - frequency ** 2)) ** 2)
        return np.sum(inverse_mass * square) / 2

    infinite = math.pi / 16             # alpha int F^2 dt, alpha = 1/8, D = mu = 1: k = 1
    for ratio in (0.5, 0.6, 0.7, 0.8, 1.0, 1.25, 1.5):
        wide = math.pi / ratio          # the edge, needed_extent = pi/k
        disc = energy((zeros / wide) ** 2, 1 / (math.pi * wide ** 2 * j1(zeros) ** 2))
        square = energy((odd[:, None] ** 2 + odd ** 2) * (math.pi / (2 * wide)) ** 2, 1 / wide ** 2)
        print(f"  needed_extent/extent {ratio:.2f} {disc / infinite - 1:+.3f} "
              f"{square / infinite - 1:+.3f}")


def membrane():
    """Clamped circular plate, force at the centre: stiffening by stretching for the shape of
    linear bending, w = w0 (1 - r^2 + 2 r^2 ln r), edge held, nu = 0.3."""
    nu = 0.3
    nodes, weights = leggauss(400)
    r, weight = (nodes + 1) / 2, weights / 2
    slope = 4 * r * np.log(r)
    curve = 4 * np.log(r) + 4
    # u'' + u'/r - u/r^2 = -(1 - nu) w'^2/(2 r) - w' w''
    fine = np.linspace(0, 1, 20001)[1:]
    sl, cu = 4 * fine * np.log(fine), 4 * np.log(fine) + 4
    ff = -(1 - nu) / (2 * fine) * sl ** 2 - sl * cu
    g = np.concatenate([[0], np.cumsum((ff[1:] + ff[:-1]) / 2 * np.diff(fine))])
    g = np.interp(r, fine, g)
    h = np.cumsum(weight * r * g) - weight * r * g / 2
    c = -2 * np.sum(weight * r * g)
    u = h / r + c * r / 2
    du = g - h / r ** 2 + c / 2
    er, et = du + slope ** 2 / 2, u / r
    stretch = np.sum(weight * r * (er ** 2 + et ** 2 + 2 * nu * er * et)) / 2
    bend = np.sum(weight * r * (curve + slope / r) ** 2) / 24
    cubic = 4 * stretch / (2 * bend)
    print(f"force over that of bending alone: 1 + {cubic:.3f} (w/H)^2")
    for x in (0.3, 0.5, 1.0):
        print(f"  w/H {x:.1f}: {cubic * x * x:+.3f}")


def half_space():
    print("I(nu), pressure, shear and Rayleigh wave in per cent")
    for nu in (0.0, 0.1, 0.2, 0.22, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5):
        parts = radiation_shares(nu)
        total = radiation(nu)
        print(f"  {nu:.2f} {total:.10f}  " + "  ".join(f"{100 * x / total:.2f}" for x in parts))
    # int (dF/dt)^2 of Hertz' elastic impact over that of the half sine of the same F_max and t0
    beta = mp.beta(mp.mpf(4) / 5, mp.mpf(3) / 2)
    time = mp.mpf(4) / 5 * mp.beta(mp.mpf(2) / 5, mp.mpf(1) / 2)
    print("Hertz over half sine:", mp.nstr(mp.mpf(9) / 5 * beta * 2 * time / mp.pi ** 2, 8))


TABLES = [contact, layer, sphere, plate, edge, membrane, half_space]

if __name__ == "__main__":
    for table in TABLES:
        if not sys.argv[1:] or table.__name__ in sys.argv[1:]:
            table()
