"""Motion of a plate by full elastodynamics: compliance and memory of a layer or a half space.

The plate is a layer 0 <= z <= H with free faces (H infinite: a half space).  A pressure with the
transform F(s) and the distribution of a flat punch of radius a moves its face; of that motion,
weighted with the same distribution, Hertz's static dent of a half space is taken off:

    U(s) = C(s) F(s),   C = 1/(2 pi) int_0^inf (k G - (1-nu)/mu) (sin(k a)/(k a))^2 dk,

G(k, s) the displacement under a pressure J0(k r), mu = Q/(2 (1+nu)) the complex shear modulus.
C falls into the dent, C0 = -(1-nu)/(4 mu a), and what tends to 0 as s grows.  In time,

    U(t) = C0(inf) F(t) + int_0^t psi(t-x) F(x) dx,   psi the inverse transform of C - C0(inf).

psi comes from three sources, each used where it is good to about 1e-12 of its size:

- that of C0 from a parabola, as all kernels in impact_solver.py;
- the rest before a wave has crossed the punch or the layer from an expansion of C in 1/s, in which
  the waves do not appear, on the same parabola;
- the rest afterwards from lines Re s = const: one per octave of time, faded out smoothly at
  frequencies that the force does not contain.  The octaves overlap and are added up with weights
  whose sum is 1, so that a wave's arrival on a border counts once.

`python body_waves.py` compares C with mpmath's integral of the formula as it stands.
"""

import functools
import math

import mpmath as mp
import numpy as np
from numpy.polynomial import chebyshev as cheb
from scipy.special import erf, erfc

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
LAGUERRE, DECAY = np.polynomial.laguerre.laggauss(24)


class Layer:
    """C(s).  modulus: complex modulus Q(s) of tension [Pa]; thickness: inf for a half space;
    fine: a factor on the number of wave numbers."""

    def __init__(self, modulus, nu, density, thickness, footprint, fine=1.0):
        self.modulus, self.nu, self.rho = modulus, nu, density
        self.h, self.a, self.fine = thickness, footprint, fine
        self.g2 = (1 - 2 * nu) / (2 * (1 - nu))           # (c_s/c_p)^2

    def shear(self, s):
        return self.modulus(s) / (2 * (1 + self.nu))

    def dent(self, s):
        """C0(s)."""
        return -(1 - self.nu) / (4 * self.shear(s) * self.a)

    def response(self, k, q):
        """k mu G, q = (s/c_s)^2; without differences of large numbers."""
        p = self.g2 * q
        k2 = k * k
        al, be = np.sqrt(k2 + p), np.sqrt(k2 + q)
        both = (2 * k2 + q) ** 2 + 4 * k2 * al * be       # S + T
        minus = (16 * k2 ** 3 * (q - p) + k2 * k2 * q * (24 * q - 16 * p) + 8 * k2 * q ** 3
                 + q ** 4) / both                         # S - T = (S^2 - T^2)/(S + T)
        if math.isinf(self.h):
            return k * al * q / minus
        t = 4 * k2 * al * be
        ea, eb = np.exp(-al * self.h), np.exp(-be * self.h)
        ta, tb = (1 - ea) / (1 + ea), (1 - eb) / (1 + eb)
        more = np.tanh((q - p) / (al + be) * self.h / 2) * (1 - ta * tb)   # tb - ta
        return k * al * q / 2 * (ta * tb / (minus * tb + t * more) + 1 / (minus * ta - t * more))

    def edges(self, s, q):
        """Wave numbers at which panels end, beyond all poles in the end: that of a mode lies
        Re s/(group velocity) beside the axis."""
        slow = np.sqrt(q)                                 # s/c_s
        reach, beside = 1.6 * abs(slow), abs(slow.real)
        least = 1.5 * beside * max(math.sqrt(self.g2), 0.02)
        first = abs(slow) * max(math.sqrt(self.g2), 0.1)
        bend = 0.0
        if math.isfinite(self.h):
            # bending wave: D k^4 = -rho H s^2
            bend = abs(6 * (1 - self.nu) * q / self.h ** 2) ** 0.25
            first = min(first, bend, 1 / self.h)
        end = max(reach, 20 / self.a, 30 / self.h, 2 * bend)
        edge = [0.0, 1e-3 * first]
        while edge[-1] < end:
            k = edge[-1]
            step = min(0.4 * k, 2 / self.a)
            if k < reach:
                # no mode with phase velocity V has a group velocity far above V and 2 c_s
                step = min(step, max(least, beside * min(0.8, 1.2 * k / abs(slow))))
            if k < 1.6 * bend:
                step = min(step, max(0.5 * bend * abs(s.real / s), least))
            edge.append(k + step / self.fine)
        return np.array(edge)

    def __call__(self, s):
        """C at one complex s, Re s > 0."""
        mu, a = self.shear(s), self.a
        q = self.rho * s * s / mu

        def value(k):
            return self.response(k, q) - (1 - self.nu)

        def rule(edge):
            half = np.diff(edge)[:, None] / 2
            return (edge[:-1, None] + half * (1 + NODES)).ravel(), (half * WEIGHTS).ravel()
        edge = self.edges(s, q)
        k, w = rule(edge)
        total = np.sum(w * value(k) * (np.sin(k * a) / k) ** 2)
        # beyond: sin^2 = 1/2 - cos/2, the first part on growing panels and by its limit c/k^4 ...
        end = edge[-1]
        k, w = rule(end * 1.4 ** np.arange(25))
        total += np.sum(w * value(k) / k ** 2) / 2
        total += value(k[-1]) * k[-1] ** 2 / (6 * (end * 1.4 ** 24) ** 3)
        # ... the second along k = end +- iy, where it decays
        k = end + 0.5j * LAGUERRE / a
        turn = 0.5j * np.exp(2j * a * end) / a
        total -= np.sum(DECAY * (turn * value(k) / k ** 2
                                 + np.conj(turn) * value(np.conj(k)) / np.conj(k) ** 2)) / 4
        return total / (2 * math.pi * a * a * mu)


@functools.lru_cache(maxsize=None)
def expansion(nu, terms=14):
    """g, c and c_i of int r(x) (1 - cos M x)/x dx = g ln M + c + sum c_i/M^(2i) for large M, with
    r = sqrt(x^2 + g^2)/R, R Rayleigh's function of imaginary wave numbers."""
    with mp.workdps(30):
        g2 = (1 - 2 * mp.mpf(nu)) / (2 * (1 - mp.mpf(nu)))
        g = mp.sqrt(g2)

        def r(x):
            alpha, beta = mp.sqrt(x * x + g2), mp.sqrt(x * x + 1)
            both = (2 * x * x + 1) ** 2 + 4 * x * x * alpha * beta
            return alpha * both / (16 * x ** 6 * (1 - g2) + x ** 4 * (24 - 16 * g2) + 8 * x * x + 1)
        constant = g * mp.euler + mp.quad(lambda x: (r(x) - g / (1 + x * x)) / x,
                                          [0, g / 4, g, 1, 2, 10, 100, mp.inf])
        # Taylor's coefficients of the even r by Cauchy's integral on a circle
        points = 256
        values = [r(g / 2 * mp.expjpi(mp.mpf(2 * j) / points)) for j in range(points)]
        factors = []
        for i in range(1, terms):
            taylor = mp.re(sum(v * mp.expjpi(-mp.mpf(4 * i * j) / points)
                               for j, v in enumerate(values))) / points / (g / 2) ** (2 * i)
            factors.append(float(-taylor * (-1) ** i * mp.factorial(2 * i - 1)))
        return float(g), float(constant), factors


class TooLate(RuntimeError):
    """A time after the end of the memory."""


class Memory:
    """psi(t), 0 < t <= end, as a function; `instant` is C0(inf), `edges` times between which psi is
    resolved by a few nodes.  material: Material of the plate; band: highest frequency times end, and
    `least` times the beginning of a line's octave; damping: of the lines, times their period;
    fine: of Layer."""

    def __init__(self, material, thickness, footprint, end, cached, band=300.0, least=110.0, damping=25.0,
                 fine=1.0):
        nu, a = material.nu, footprint
        self.end = end
        self.layer = Layer(lambda s: material.complex_plane(s) * (1 - nu * nu), nu,
                           material.density, thickness, a, fine)
        glassy = math.inf if material.viscosity else material.glassy_plane
        self.instant = 0.0 if math.isinf(glassy) else -1 / (2 * a * glassy)
        self.creep = 0.0
        if material.model != "elastic":
            self.creep = (lambda s: -1 / (2 * a * material.complex_plane(s))) if math.isinf(
                glassy) else (lambda s: -material.deficit(s) / (
                    2 * a * glassy * material.complex_plane(s)))
        expansion = self.expand()
        # the first wave crosses the punch or comes back from the other face
        way = min(2 * a, 2 * thickness)
        first = 0.3 * way / self.speed(1 / end)
        for _ in range(60):
            share = 0.3 if math.isfinite(glassy) else 0.05
            first = share * way / self.speed((1e300 if math.isfinite(glassy) else 2.2 / first))
        early = (lambda s: expansion(s) + self.creep(s)) if self.creep else expansion
        self.early = cached(early, first)
        self.late = cached(self.creep, end) if self.creep else None
        self.lines(first / 2, band, least, damping)

    def speed(self, s):
        """Of pressure waves [m/s]."""
        s = min(s, 1e30)
        return math.sqrt(abs(self.layer.shear(s)) / self.layer.g2 / self.layer.rho)

    def expand(self):
        """C - C0 without waves: of a half space, 1/(4 pi a^2 mu q) int r(x) (1 - cos M x)/x dx with
        q = s/c_s, M = 2 a q, for large M."""
        layer = self.layer
        g, constant, factors = expansion(layer.nu)

        def transform(s):
            mu = layer.shear(s)
            q = s * np.sqrt(layer.rho / mu)
            part = 1 / (2 * layer.a * q)
            total = constant - g * np.log(part)
            for i, factor in enumerate(factors, 1):
                total = total + factor * part ** (2 * i)
            return total / (4 * math.pi * layer.a ** 2 * mu * q)
        return transform

    def lines(self, start, band, least, damping):
        """Sums over lines Re s = const and their Chebyshev series."""
        octaves = max(1, math.ceil(math.log2(self.end / start)) + 1)
        self.start, degree = start, 15
        layer = self.layer
        nodes = -np.cos(math.pi * np.arange(degree + 1) / degree)
        inverse = np.linalg.inv(cheb.chebvander(nodes, degree)).T
        lines = []
        for m in range(octaves):
            scale = start * 2.0 ** m
            period = 8 * scale
            top = max(least / scale, band / self.end)
            omega = 2 * math.pi / period * np.arange(int(top * period / (2 * math.pi)) + 1)
            s = damping / period + 1j * omega
            c = np.array([layer(x) - layer.dent(x) for x in s])
            c *= 0.5 * erfc((omega / top - 0.55) / 0.08) * 2 / period
            c[0] *= 0.5
            lines.append((s, c, top))
        left, width, rows = [], [], []
        for j in range(-1, octaves + 1):
            scale = start * 2.0 ** j
            if scale >= self.end:
                break
            near = [m for m in range(j - 1, j + 2) if 0 <= m < octaves]
            top = max(lines[m][2] for m in near)
            count = max(2, math.ceil(scale * top / 18))
            edge = scale * (1 + np.arange(count) / count)
            t = edge[:, None] + scale / count * (1 + nodes) / 2
            values = np.zeros(t.shape)
            for m in near:
                s, c, _ = lines[m]
                weight = self.step(t, m) - (self.step(t, m + 1) if m < octaves - 1 else 0.0)
                sums = np.array([(np.exp(np.outer(x, s)) @ c).real for x in t])
                values += weight * sums
            left.append(edge)
            width.append(np.full(count, scale / count))
            rows.append(values @ inverse)
        self.left, self.width = np.concatenate(left), np.concatenate(width)
        self.rows = np.ascontiguousarray(np.concatenate(rows).T)
        self.edges = self.left
        self.evaluations = sum(len(line[0]) for line in lines)

    def step(self, t, m):
        """From 0 to 1 within an octave of the beginning of line m."""
        return 0.5 * (1 + erf(np.log2(t / (self.start * 2.0 ** m)) / 0.18))

    def __call__(self, t):
        t = np.asarray(t, float)
        if t.max() > self.end:
            raise TooLate
        value = np.zeros(t.shape)
        small, large = t < 2 * self.start, t >= self.start / 2
        if small.any():
            weight = 1 - np.where(large[small], self.step(np.maximum(t[small], 1e-290), 0), 0.0)
            value[small] = weight * self.early(np.maximum(t[small], 1e-200))
        if large.any():
            x = t[large]
            i = np.searchsorted(self.left, x, side="right") - 1
            z = 2 * (x - self.left[i]) / self.width[i] - 1
            b1 = b2 = 0.0
            for row in self.rows[:0:-1]:
                b1, b2 = row[i] + 2 * z * b1 - b2, b1
            value[large] += self.rows[0][i] + z * b1 - b2
            if self.late:
                value[large] += self.step(x, 0) * self.late(x)
        return value


def definition(layer, s):
    """C by mpmath from the formula as it stands, with 30 digits; for s that is not large."""
    with mp.workdps(30):
        s, a, nu = mp.mpc(s), mp.mpf(layer.a), mp.mpf(layer.nu)
        mu = mp.mpc(layer.modulus(complex(s))) / (2 * (1 + nu))
        shear2 = s * s * layer.rho / mu
        half = layer.h / 2

        def value(k):
            al, be = mp.sqrt(k * k + shear2 * layer.g2), mp.sqrt(k * k + shear2)
            big, small = (k * k + be * be) ** 2, 4 * k * k * al * be
            if math.isinf(half):
                g = 1 / (big - small)
            else:
                ta, tb = mp.tanh(al * half), mp.tanh(be * half)
                g = (ta * tb / (big * tb - small * ta) + 1 / (big * ta - small * tb)) / 2
            return k * al * shear2 / mu * g - (1 - nu) / mu

        unit = abs(mp.sqrt(shear2))
        edge = [unit * mp.mpf(x) / 40 for x in (0, 1e-3, 1e-2, 0.1, 0.5, *range(1, 80))]
        while edge[-1] < 8 * max(2 * unit, 60 / a):
            edge.append(edge[-1] + min(0.3 * edge[-1], 3 / a))
        total = mp.quad(lambda k: value(k) * (mp.sin(k * a) / k) ** 2, edge, maxdegree=5)
        # the rest, from its limit c/k^4 sin^2
        end = edge[-1]
        limit = value(end) * end ** 2
        turn = mp.expj(2 * a * end) * mp.mpc(0, 1) / (2 * a * end ** 4)
        total += limit / 2 * (1 / (3 * end ** 3) - mp.re(turn * (1 - mp.mpc(0, 2) / (a * end))))
        return complex(total / (2 * mp.pi * a * a))


def main():
    """Compare C with its definition."""
    glass = (lambda s: 70e9 + 0 * s, 0.22, 2500.0)
    pmma = lambda s: 2.6e9 + 5e8 * s / (s + 3e4) + 9e8 * s / (s + 4e5)   # noqa: E731
    for name, layer in (("glass, 4 mm", Layer(*glass, 4e-3, 1.7e-4)),
                        ("glass, half space", Layer(*glass, math.inf, 1.7e-4)),
                        ("PMMA, 0.3 mm", Layer(pmma, 0.35, 1190.0, 3e-4, 1.9e-4)),
                        ("nu = 0.499, 10 mm", Layer(pmma, 0.499, 1190.0, 1e-2, 1.9e-4)),
                        ("nu = 0, 2 mm", Layer(pmma, 0.0, 1190.0, 2e-3, 1.9e-4))):
        for s in (2e5, 2e5 + 6e5j, 5e5 + 7e6j):
            found, exact = layer(s), definition(layer, s)
            print(f"{name:18s} s = {s:.0e}  C = {exact:.12e}  "
                  f"difference {abs(found - exact) / abs(exact):.0e}")


if __name__ == "__main__":
    main()
