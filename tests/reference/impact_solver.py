"""Impacts of a viscoelastic sphere on a plate by spectral collocation: the solver of the references.

A body of mass m strikes a plate at v0, g is gravity.  With s the indentation, u = s |s|^(n-1) and U
the displacement of the plate, the twice integrated equation of motion and its derivative are

    s(t) = v0 t + g t^2/2 - J(t)/m - U(t),    v(t) = s'(t) = v0 + g t - I(t)/m - U'(t),
    J' = I,  I' = F.

Shape: n = 3/2 and K = (4/3) sqrt(R) of a sphere, 2 and (2/pi) tan(half angle) of a cone, 1 and 2a
of a punch; a profile z = C r^p has n = 1 + 1/p and K = 2p/(p+1) (C kappa)^(-1/p) with
kappa = sqrt(pi) Gamma(p/2 + 1)/Gamma((p+1)/2) (Sneddon 1965).

Contact (`law`), k = K E'(t) the firmness (N/m^n), eta that of a dashpot:

    boltzmann   F = int_0^t k(t-x) u'(x) dx + eta u',   so   I = int_0^t k(t-x) u(x) dx + eta u
    receding    the same until s is largest; afterwards, with t1(t) the time at which the contact
                was as large as now and growing (T. C. T. Ting, J. Appl. Mech. 33 (1966) 845),
                    int_t1^t k(t-x) v(x) dx + eta v(t) = 0,    F = int_0^t1 k(t-x) u'(x) dx,
                until t1 = 0

E' (`pair`): eq1, E'_a E'_b/(E'_a + E'_b) at the same time; series, the compliances add up,
Q = Q_a Q_b/(Q_a + Q_b) with Q(p) = p times the Laplace transform of E'(t).

Plate (`waves`), A = sqrt(3 rho_b)/(16 rho_b h^2), alpha(t) = A/sqrt(E'_b(t)):

    none         U' = 0
    constant     U' = alpha(0) F
    relaxing     U' = (alpha I)'
    frozen       U' = int_0^t alpha F' dt = alpha F - int_0^t alpha' F dt
    hereditary   U' has the transform A F/sqrt(Q_b), so U' = g F + int_0^t psi(t-x) F(x) dx with
                 g = A/sqrt(Q_b(inf)) and psi the inverse transform of A/sqrt(Q_b) - g

Method.  Collocation in y = sqrt(t), element by element: all fields are polynomials of degree n in
y at Chebyshev-Lobatto nodes.  Elements grow geometrically from 1e-4 of the root of the contact
time, begin anew at the largest indentation of a receding contact, and shrink geometrically towards
points where the solution is not smooth (s = 0, t1 = 0).  A step is halved where the last
coefficients of the force say so.  History integrals are Gauss-Legendre sums on panels graded
dyadically towards x = t, the innermost with a substitution that removes the singularity of the
kernel.  Kernels are used as they are: nothing is expanded in exponentials and nothing is marched,
so every material and every pair takes the same path.  What has no closed form (Mittag-Leffler,
series, psi) is a Laplace transform inverted on a parabola, kept as Chebyshev series in ln t.

An impact is solved on two meshes that differ in degree, elements, tolerance and quadrature.
Units are SI.
"""

import functools
import math

import numpy as np
from numpy.polynomial import chebyshev as cheb
from scipy.optimize import brentq
from scipy.special import erfcx

TINY = 1e-290


# ------------------------------------------------------------------------ transforms and kernels

def invert(transform, t):
    """Inverse Laplace transform at the times t > 0, on the parabola p t = mu (1 + iy)^2."""
    mu, step = 2.2, 0.135
    y = step * (np.arange(32) + 0.5)
    w = mu * (1 + 1j * y) ** 2
    factor = 2 * mu * step / math.pi * np.exp(w) * (1 + 1j * y)
    t = np.asarray(t, float)
    total = np.zeros(t.shape)
    for wj, fj in zip(w, factor):
        total += (fj * transform(wj / t)).real
    return total / t


class Cached:
    """A kernel f(t) kept as piecewise Chebyshev series of t^a f(t) in ln t, up to `end`."""

    def __init__(self, function, exponent, end, degree=19):
        self.a, self.low = exponent, -640.0
        self.count = int(math.ceil(math.log(end) - self.low)) + 1
        nodes = -np.cos(math.pi * np.arange(degree + 1) / degree)
        x = self.low + np.arange(self.count)[:, None] + (1 + nodes) / 2
        t = np.exp(x)
        values = function(t.ravel()).reshape(t.shape) * t ** exponent
        self.c = np.ascontiguousarray((values @ np.linalg.inv(cheb.chebvander(nodes, degree)).T).T)

    def __call__(self, t):
        t = np.asarray(t, float)
        x = np.log(np.maximum(t, TINY)) - self.low
        i = np.clip(x.astype(int), 0, self.count - 1)
        z = 2 * (x - i) - 1
        b1 = b2 = 0.0
        for row in self.c[:0:-1]:
            b1, b2 = row[i] + 2 * z * b1 - b2, b1
        return (self.c[0][i] + z * b1 - b2) * np.maximum(t, TINY) ** -self.a


# ---------------------------------------------------------------------------------- materials

class Material:
    """Relaxation modulus E(t) = regular part (t > 0) + viscosity delta(t), and its transforms."""

    def __init__(self, name, model, density=None, poisson_ratio=0.5, **keys):
        self.name, self.model, self.density, self.nu, self.keys = (
            name, model, density, poisson_ratio, keys)
        self.viscosity = 0.0
        self.moduli = self.rates = np.zeros(0)
        self.e0 = keys.get("equilibrium_modulus", 0.0)
        if model == "elastic":
            self.e0 = keys["modulus"]
        elif model == "sls":
            ratio = keys["alpha"] / keys["beta"]
            self.e0 = keys["glassy_modulus"] * ratio
            self.moduli = np.array([keys["glassy_modulus"] * (1 - ratio)])
            self.rates = np.array([keys["beta"]])
        elif model == "prony":
            self.viscosity = keys.get("viscosity", 0.0)
            self.moduli = np.array(keys.get("moduli", []), float)
            self.rates = (np.array(keys["rates"], float) if "rates" in keys
                          else 1.0 / np.array(keys.get("times", []), float))
        elif model == "table":
            self.points = np.array(keys["points"], float)
            self.x, self.y = np.log(self.points.T / self.points[0][:, None])
            self.slope = monotone_slopes(self.x, self.y)
        elif model not in ("rigid", "power_law", "cerf", "mittag_leffler"):
            raise ValueError(model)

    @property
    def is_exponential_sum(self):
        return self.model in ("rigid", "elastic", "sls", "prony")

    @property
    def kinks(self):
        """Times at which E(t) is not smooth [s]."""
        return list(self.points[:, 0]) if self.model == "table" else []

    def plane(self, t):
        """E(t)/(1-nu^2) for t > 0 [Pa]."""
        t = np.asarray(t)
        if self.model == "rigid":
            return np.full(t.shape, np.inf)
        value = self.e0 + np.zeros(t.shape, t.dtype)
        if self.model == "power_law":
            a = self.keys["exponent"]
            with np.errstate(divide="ignore"):
                value = value + self.keys["coefficient"] * t ** (-a) / math.gamma(1 - a)
        elif self.model == "cerf":
            value = value + self.keys["relaxing_modulus"] * erfcx(self.keys["beta"] * np.sqrt(t))
        elif self.model == "mittag_leffler":
            a, tau = self.keys["exponent"], self.keys["time"]
            positive = np.maximum(t, TINY)
            value = value + self.keys["relaxing_modulus"] * np.where(
                t > 0, invert(lambda p: tau * (p * tau) ** (a - 1) / (1 + (p * tau) ** a),
                              positive), 1.0)
        elif self.model == "table":
            value = value + self.table(t)[0]
        else:
            for modulus, rate in zip(self.moduli, self.rates):
                value = value + modulus * np.exp(-rate * t)
        return value / (1 - self.nu ** 2)

    def table(self, t):
        """E and its rate from the points: monotone cubics of ln E over ln t, constant outside."""
        x = np.log(np.maximum(t, TINY) / self.points[0, 0])
        inside = np.clip(x, 0.0, self.x[-1])
        i = np.clip(np.searchsorted(self.x, inside, side="right") - 1, 0, self.x.size - 2)
        h = self.x[i + 1] - self.x[i]
        z = (inside - self.x[i]) / h
        # Hermite's basis
        y = (self.y[i] * (1 + 2 * z) * (1 - z) ** 2 + self.y[i + 1] * z * z * (3 - 2 * z)
             + h * z * (1 - z) * (self.slope[i] * (1 - z) - self.slope[i + 1] * z))
        dy = (6 * z * (1 - z) * (self.y[i + 1] - self.y[i]) / h
              + self.slope[i] * (1 - z) * (1 - 3 * z) + self.slope[i + 1] * z * (3 * z - 2))
        e = self.points[0, 1] * np.exp(y)
        return e, np.where((x > 0) & (x < self.x[-1]), e * dy / np.maximum(t, TINY), 0.0)

    def plane_rate(self, t):
        """Time derivative of the plane modulus for t > 0 [Pa/s]."""
        if self.model == "power_law":
            a = self.keys["exponent"]
            value = -a * self.keys["coefficient"] * t ** (-a - 1) / math.gamma(1 - a)
        elif self.model == "cerf":
            beta = self.keys["beta"]
            z = beta * np.sqrt(t)
            # d/dt erfcx(z) = beta^2 (erfcx(z) - 1/(sqrt(pi) z)); for large z the difference is
            # taken from the continued fraction instead, it cancels there
            small = np.where(z < 6, erfcx(z) - 1 / (math.sqrt(math.pi) * z), 0.0)
            zl = np.maximum(z, 6.0)
            tail = 0.0 * zl
            for j in range(60, 1, -1):
                tail = (j / 2) / (zl + tail)
            # erfcx(z) = (1/sqrt pi)/(z + r), r = (1/2)/(z + tail)
            r = 0.5 / (zl + tail)
            large = -r / (zl * (zl + r)) / math.sqrt(math.pi)
            value = self.keys["relaxing_modulus"] * beta ** 2 * np.where(z < 6, small, large)
        elif self.model == "mittag_leffler":
            return -invert(self.deficit, t)
        elif self.model == "table":
            value = self.table(t)[1]
        else:
            value = 0.0 * t
            for modulus, rate in zip(self.moduli, self.rates):
                value = value - modulus * rate * np.exp(-rate * t)
        return value / (1 - self.nu ** 2)

    def complex_plane(self, p):
        """Q(p)/(1-nu^2), Q(p) = p times the transform of E, at complex p [Pa]."""
        value = self.e0 + self.viscosity * p
        if self.model == "power_law":
            value = value + self.keys["coefficient"] * p ** self.keys["exponent"]
        elif self.model == "cerf":
            root = np.sqrt(p)
            value = value + self.keys["relaxing_modulus"] * root / (root + self.keys["beta"])
        elif self.model == "mittag_leffler":
            power = (p * self.keys["time"]) ** self.keys["exponent"]
            value = value + self.keys["relaxing_modulus"] * power / (1 + power)
        elif self.model == "table":
            raise ValueError("the transform of a table is not known here")
        else:
            for modulus, rate in zip(self.moduli, self.rates):
                value = value + modulus * p / (p + rate)
        return value / (1 - self.nu ** 2)

    def deficit(self, p):
        """Q(inf) - Q(p) of a modulus that is finite at t = 0, without cancellation [Pa]."""
        value = 0.0 * p
        if self.model == "cerf":
            value = (self.keys["relaxing_modulus"] * self.keys["beta"]
                     / (np.sqrt(p) + self.keys["beta"]))
        elif self.model == "mittag_leffler":
            value = (self.keys["relaxing_modulus"]
                     / (1 + (p * self.keys["time"]) ** self.keys["exponent"]))
        else:
            for modulus, rate in zip(self.moduli, self.rates):
                value = value + modulus * rate / (p + rate)
        return value / (1 - self.nu ** 2)

    @property
    def glassy_plane(self):
        """Plane modulus at t = 0, the dashpot aside [Pa]."""
        if self.model == "power_law":
            return math.inf
        if self.model == "table":
            return self.points[0, 1] / (1 - self.nu ** 2)
        total = self.e0 + self.keys.get("relaxing_modulus", 0.0) + self.moduli.sum()
        return math.inf if self.model == "rigid" else total / (1 - self.nu ** 2)

    @property
    def singular_exponent(self):
        return self.keys["exponent"] if self.model == "power_law" else 0.0


def monotone_slopes(x, y):
    """Slopes of Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300; at the ends those of
    the parabola through three points, between 0 and three times the secant."""
    h, secant = np.diff(x), np.diff(y) / np.diff(x)
    slope = np.zeros(x.size)
    if x.size == 2:
        return slope + secant[0]
    for i in range(1, x.size - 1):
        if secant[i - 1] * secant[i] > 0:
            a = (h[i - 1] + 2 * h[i]) / (3 * (h[i - 1] + h[i]))
            slope[i] = secant[i - 1] * secant[i] / (a * secant[i] + (1 - a) * secant[i - 1])
    for end, one, two in ((0, 0, 1), (-1, -1, -2)):
        guess = secant[one] + h[one] / (h[one] + h[two]) * (secant[one] - secant[two])
        bounds = sorted((0.0, 3 * secant[one]))
        slope[end] = min(max(guess, bounds[0]), bounds[1])
    return slope


class Impact:
    """One case: kernels, plate parameter, and the numbers that enter the equations."""

    def __init__(self, case):
        self.case = case
        made = {m["name"]: Material(**m) for m in case["materials"]}
        sphere, plate = case["sphere"], case["plate"]
        contact = case.get("contact", {})
        self.law, self.pair = contact.get("law", "boltzmann"), contact.get("pair", "eq1")
        self.a, self.b = made[sphere["material"]], made[plate["material"]]
        self.v0 = case["velocity"]
        self.gravity = case.get("gravity", 0.0)
        self.m = (sphere.get("mass")
                  or 4 / 3 * math.pi * sphere["radius"] ** 3 * self.a.density)
        self.n, self.c = self.shape(sphere, plate.get("surface_radius", 0.0))
        self.waves = plate.get("waves", "relaxing")
        a, b = self.a, self.b
        # which pairs have a contact modulus that is again one material's E(t), times a factor
        self.single = None
        if a.model == "rigid":
            self.single = (b, 1.0)
        elif b.model == "rigid":
            self.single = (a, 1.0)
        elif a.name == b.name:
            self.single = (a, 0.5)
        elif a.model == b.model == "elastic":
            self.single = (Material("pair", "elastic", None, 0.0, modulus=float(
                1 / (1 / a.glassy_plane + 1 / b.glassy_plane))), 1.0)
        self.eta = 0.0
        if self.single:
            one, factor = self.single
            self.eta = self.c * one.viscosity / (1 - one.nu ** 2) * factor
        elif self.pair == "eq1" and (a.viscosity or b.viscosity):
            raise ValueError("a dashpot in a general pair has no contact modulus by Eq. (1)")
        elif a.viscosity and b.viscosity:
            self.eta = self.c / sum((1 - x.nu ** 2) / x.viscosity for x in (a, b))
        self.is_exponential_sum = bool(self.single and self.single[0].is_exponential_sum)
        self.is_elastic = (self.is_exponential_sum and self.eta == 0.0
                           and not self.single[0].moduli.size)
        self.singular = self.single[0].singular_exponent if self.single else self.pair_exponent()
        self.kinks = sorted(set(a.kinks + b.kinks))
        h, rho = plate.get("half_thickness", 1.0), b.density or 1.0
        self.plate_factor = math.sqrt(3 * rho) / (16 * rho * h ** 2)
        if self.waves == "none" or b.model == "rigid":
            self.plate_factor = 0.0
        self.k = self.kernel()
        self.g, self.psi, self.psi_singular = 0.0, None, 0.0
        if self.waves == "hereditary" and self.plate_factor:
            self.memory()

    @staticmethod
    def shape(sphere, surface_radius):
        """Exponent n and factor K of F = K E' s^n."""
        shape = sphere.get("shape", "sphere")
        if shape == "cone":
            return 2.0, 2 / math.pi * math.tan(math.radians(sphere["half_angle"]))
        if shape == "punch":
            return 1.0, 2 * sphere["punch_radius"]
        if shape == "power":
            p = sphere["profile_power"]
            kappa = math.sqrt(math.pi) * math.gamma(p / 2 + 1) / math.gamma((p + 1) / 2)
            return 1 + 1 / p, 2 * p / (p + 1) * (sphere["profile_coefficient"] * kappa) ** (-1 / p)
        r = sphere["radius"]
        return 1.5, 4 / 3 * math.sqrt(
            1 / (1 / r + (1 / surface_radius if surface_radius else 0.0)))

    def u(self, s):
        """s |s|^(n-1)."""
        return s * self.secant(s)

    def secant(self, s):
        """u/s = |s|^(n-1)."""
        return np.sqrt(np.abs(s)) if self.n == 1.5 else np.abs(s) ** (self.n - 1)

    def free(self, t):
        """Way and velocity without a force."""
        return self.v0 * t + self.gravity * t * t / 2, self.v0 + self.gravity * t

    def pair_exponent(self):
        """Exponent of the singularity of E' at t = 0 of two different bodies."""
        a, b = self.a, self.b
        if self.pair == "eq1":
            return min(a.singular_exponent, b.singular_exponent)
        if a.viscosity and b.viscosity:
            # what is left besides the common dashpot: the squares of the shares
            return max(a.singular_exponent, b.singular_exponent)
        if a.viscosity or b.viscosity:
            return (b if a.viscosity else a).singular_exponent
        return min(a.singular_exponent, b.singular_exponent)

    def modulus(self, t):
        """Contact modulus for t > 0 without a dashpot [Pa]."""
        if self.single:
            return self.single[0].plane(t) * self.single[1]
        if self.pair == "eq1":
            ea, eb = self.a.plane(t), self.b.plane(t)
            return 1 / (1 / ea + 1 / eb)
        return invert(lambda p: (self.complex_modulus(p) - self.eta / self.c * p) / p, t)

    def complex_modulus(self, p):
        """Q of a single material or of bodies in series, dashpots included [Pa]."""
        if self.single:
            return self.single[0].complex_plane(p) * self.single[1]
        qa, qb = self.a.complex_plane(p), self.b.complex_plane(p)
        return qa * qb / (qa + qb)

    def kernel(self):
        """k(t) as a function; from Chebyshev series where a transform has to be inverted."""
        slow = (self.pair == "series" and not self.single
                or "mittag_leffler" in (self.a.model, self.b.model))
        modulus = Cached(self.modulus, self.singular, 1e9) if slow else self.modulus
        return lambda t: self.c * modulus(t)

    def memory(self):
        """g and psi of a hereditary plate."""
        b, factor = self.b, self.plate_factor
        glassy = math.inf if b.viscosity else b.glassy_plane
        if math.isinf(glassy):
            self.psi_singular = 1 - (1.0 if b.viscosity else b.singular_exponent) / 2
            self.psi = Cached(lambda t: invert(
                lambda p: factor / np.sqrt(b.complex_plane(p)), t), self.psi_singular, 1e9)
            return
        self.g = factor / math.sqrt(glassy)
        if b.model == "elastic":
            return

        def transform(p):
            root = np.sqrt(b.complex_plane(p))
            return factor * b.deficit(p) / (root * math.sqrt(glassy) * (root + math.sqrt(glassy)))
        # the deficit falls as p^-a, so psi begins as t^(a - 1)
        self.psi_singular = {"cerf": 0.5, "mittag_leffler": 1 - b.keys.get("exponent", 1.0)}.get(
            b.model, 0.0)
        self.psi = Cached(lambda t: invert(transform, t), self.psi_singular, 1e9)

    def alpha(self, t):
        """alpha(t) and alpha'(t)."""
        if self.plate_factor == 0.0 or self.waves == "hereditary":
            return 0.0 * t, 0.0 * t
        if self.waves == "constant":
            return self.plate_factor / np.sqrt(self.b.glassy_plane + 0.0 * t), 0.0 * t
        with np.errstate(all="ignore"):
            eb = np.where(t > 0, self.b.plane(np.maximum(t, TINY)), self.b.glassy_plane)
            a = self.plate_factor / np.sqrt(eb)
            rate = np.where(t > 0, -0.5 * a * self.b.plane_rate(np.maximum(t, TINY)) / eb, 0.0)
        return a, rate

    def inelasticity(self):
        """Zener's lambda; 0 where k(0) is infinite (the limit t -> 0 of alpha m / T)."""
        glassy = self.b.glassy_plane
        if (self.singular or self.eta or self.plate_factor == 0.0 or math.isinf(glassy)):
            return 0.0
        k0 = self.c / ((0 if self.a.model == "rigid" else 1 / self.a.glassy_plane) + 1 / glassy)
        alpha = self.plate_factor / math.sqrt(glassy)
        return alpha * self.m / (self.m / (k0 * self.v0 ** (self.n - 1))) ** (1 / (self.n + 1))

    def loss_tangent(self, omega):
        """Loss over storage of the contact modulus at omega; nan where it is not known here."""
        if "table" in (self.a.model, self.b.model):
            return math.nan
        if self.single or self.pair == "series":
            value = self.complex_modulus(1j * omega)
            return float(value.imag / value.real)
        # E' of Eq. (1) is a product in time: i omega int (E'(t) - E'(inf)) e^(-i omega t) dt
        e0 = [x.e0 / (1 - x.nu ** 2) for x in (self.a, self.b)]
        end = e0[0] * e0[1] / (e0[0] + e0[1]) if min(e0) > 0 else 0.0
        nodes, weights = np.polynomial.legendre.leggauss(20)
        if self.a.is_exponential_sum and self.b.is_exponential_sum:
            turn = 1.0      # along the real axis, down to e^(-45) of the slowest mode
            rates = np.concatenate([self.a.rates, self.b.rates])
            top = 45 / rates.min()
            start = 1e-3 / max(rates.max(), omega)
        elif "mittag_leffler" in (self.a.model, self.b.model):
            return math.nan
        else:
            turn = np.exp(-0.25j * math.pi)   # fractional kernels are analytic in this sector
            top = 45 * math.sqrt(2) / omega
            start = 1e-40 / omega
        edges = [0.0, start]
        while edges[-1] < top:
            edges.append(edges[-1] + min(edges[-1], 1 / omega))
        edges = np.array(edges)
        half = np.diff(edges)[:, None] / 2
        t = (edges[:-1, None] + half * (1 + nodes)).ravel() * turn
        w = (half * weights).ravel() * turn
        value = end + 1j * omega * np.sum(w * (self.modulus(t) - end) * np.exp(-1j * omega * t))
        return value.imag / value.real

    def time_scale(self):
        """Duration of contact, roughly: the elastic one with k at about that time [s]."""
        t = 1e-3
        for _ in range(100):
            k = float(self.k(np.array([t]))[0]) + self.eta / t
            speed = self.v0 + self.gravity * t / 3.2
            t = 0.5 * (t + 3.2 * (self.m / (k * speed ** (self.n - 1))) ** (1 / (self.n + 1)))
        return t


# ------------------------------------------------------------------------ spectral collocation

class NoSeparation(RuntimeError):
    """The contact does not end within what is looked at, or the law does not hold."""


class Mesh:
    """degree: of the polynomials; elements: how many, about, per contact time; ratio: growth of
    the first ones; panels: dyadic levels of the history quadrature; gauss: points of a panel more
    than the degree; tolerance: of the last coefficients of the force, relative to its maximum."""

    def __init__(self, degree, elements, ratio, panels, gauss, tolerance):
        self.n, self.elements, self.ratio, self.panels, self.tolerance = (
            degree, elements, ratio, panels, tolerance)
        n = degree
        self.xi = -np.cos(math.pi * np.arange(n + 1) / n)
        self.to_coef = np.linalg.inv(cheb.chebvander(self.xi, n))
        nodes, weights = np.polynomial.legendre.leggauss(n + gauss)
        self.g01, self.w01 = (1 + nodes) / 2, weights / 2
        # derivative T_j'(x) as coefficients, columns j; integrals of f and x f from -1, at nodes
        self.deriv = np.zeros((n + 1, n + 1))
        for j in range(1, n + 1):
            self.deriv[:j, j] = cheb.chebder(np.eye(n + 1)[j, :j + 1])
        plain, times = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
        for j in range(n + 1):
            c = self.to_coef[:, j]
            plain[:, j] = cheb.chebval(self.xi, cheb.chebint(c, lbnd=-1))
            times[:, j] = cheb.chebval(self.xi, cheb.chebint(cheb.chebmul(c, [0, 1]), lbnd=-1))
        self.plain, self.times = plain, times
        self.rate_of = cheb.chebvander(self.xi, n) @ self.deriv @ self.to_coef

    def rate(self, y, h):
        """Matrix of d/dt at the nodes; zero at t = 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(y[:, None] > 0, self.rate_of * (2 / h) / (2 * y[:, None]), 0.0)

    def integral(self, y0, h):
        """Matrix of int f dt from the left end to each node, f at the nodes, dt = 2 y dy."""
        return h * ((y0 + h / 2) * self.plain + h / 2 * self.times)


@functools.lru_cache(maxsize=None)
def meshes():
    return Mesh(22, 12, 1.4, 30, 6, 2e-14), Mesh(17, 9, 1.6, 25, 5, 2e-13)


def clenshaw(c, z):
    """Chebyshev series with coefficients c(0:n, ...) at z."""
    b1 = b2 = 0.0
    for j in range(c.shape[0] - 1, 0, -1):
        b1, b2 = c[j] + 2 * z * b1 - b2, b1
    return c[0] + z * b1 - b2


class Contact:
    """The march over the elements; fields of past elements as Chebyshev coefficients."""

    FIELDS = ("u", "du", "impulse", "force", "df", "v", "s")

    def __init__(self, impact, mesh):
        self.p, self.mesh = impact, mesh
        self.left, self.size = [], []
        self.coef = {f: np.zeros((64, mesh.n + 1)) for f in self.FIELDS}
        self.y_scale = math.sqrt(impact.time_scale())
        self.y = 0.0
        self.at = dict(s=0.0, u=0.0, impulse=0.0, j=0.0, force=0.0, v=impact.v0, plate=0.0,
                       frozen=0.0)
        self.w_h = self.w_wave = self.smax = self.fmax = self.z = 0.0
        self.step_max = self.y_scale / mesh.elements

    # -- history ---------------------------------------------------------------------------

    def edges(self, y, gap, distances, floor):
        """Distances from y, from gap to y, at which panels end."""
        edge = [y]
        while edge[-1] > max(floor, gap):
            edge.append(edge[-1] / 2)
        edge = np.array(edge)
        kinks = np.array([x for x in self.p.kinks if x < y * y])
        kinks = kinks / (y + np.sqrt(y * y - kinks))
        edge = np.concatenate([edge[edge > gap], distances[distances > gap], kinks])
        edge = np.sort(edge[edge > gap])
        if gap:
            edge = np.concatenate([[gap], edge])
        keep = np.ones(edge.size, bool)
        keep[1:] = np.diff(edge) > 1e-14 * edge[1:]
        return edge[keep]

    def rule(self, edge, singular):
        """Nodes and weights on the panels; with `singular` an innermost one from 0 as well."""
        g, w = self.mesh.g01, self.mesh.w01
        width = np.diff(edge)[:, None]
        d, wd = edge[:-1, None] + width * g, width * w
        if singular is not None:
            power = 4 / (1 - singular)
            d = np.vstack([edge[0] * g[None, :] ** power, d])
            wd = np.vstack([edge[0] * power * g ** (power - 1) * w, wd])
        return d, wd

    def rows(self, y0, h, kernel, singular, fields, slope):
        """Rows of int kernel(t-x) f(x) dx: own element as a matrix for values at its nodes (and,
        with `slope`, for int kernel f' dx), past elements as a number per field ("du": int kernel
        u' dx, "df" alike) and node."""
        mesh, n = self.mesh, self.mesh.n
        y = y0 + h * (1 + mesh.xi) / 2
        own_value, own_slope = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
        past = {f: np.zeros(n + 1) for f in fields}
        left = np.array(self.left + [y0])
        sizes = np.array(self.size + [h])
        for i in range(n + 1):
            if y[i] == 0.0:
                continue
            own = h * (1 + mesh.xi[i]) / 2
            to_left = y[i] - left
            to_left[-1] = own
            floor = min(y[i] * 2.0 ** -mesh.panels, own / 2 if i else self.size[-1] / 2)
            edge = self.edges(y[i], 0.0, to_left, floor)
            d, w = self.rule(edge, singular)
            k = np.where(w > 0, kernel((d * (2 * y[i] - d)).ravel()).reshape(d.shape), 0.0)
            middle = d.mean(axis=1)
            where = np.searchsorted(-to_left, -middle, side="right") - 1
            z = 2 * (to_left[where][:, None] - d) / sizes[where][:, None] - 1
            now = where == len(self.left)
            kk = w * k
            dt = 2 * (y[i] - d)
            if now.any():
                van = cheb.chebvander(z[now].ravel(), n)
                own_value[i] = ((kk[now] * dt[now]).ravel() @ van) @ mesh.to_coef
                if slope:
                    own_slope[i] = (kk[now].ravel() @ (van @ mesh.deriv)) @ mesh.to_coef * (2 / h)
            old = ~now
            if old.any():
                for f in fields:
                    c = self.coef[f][where[old]].T[:, :, None]
                    value = clenshaw(c, z[old])
                    past[f][i] = np.sum(value * kk[old] * (1.0 if f in ("du", "df") else dt[old]))
        return own_value, own_slope, past

    def until(self, y, since, y_max):
        """int_0^t1 k u' dx, int_0^t1 k v dx and their derivatives by y1, at time y^2.

        since = y_max - y1 >= 0, y1 the root of t1; y_max ends an element."""
        gap = (y - y_max) + since
        y1 = y_max - since
        left, sizes = np.array(self.left), np.array(self.size)
        to_left = y - left
        edge = self.edges(y, gap, to_left, gap)
        d, w = self.rule(edge, None)
        where = np.searchsorted(-to_left, -d.mean(axis=1), side="right") - 1
        where = np.minimum(where, self.approach - 1)
        z = 2 * (to_left[where][:, None] - d) / sizes[where][:, None] - 1
        kk = w * self.p.k((d * (2 * y - d)).ravel()).reshape(d.shape) * 2 * (y - d)
        v = clenshaw(self.coef["v"][where].T[:, :, None], z)
        s = clenshaw(self.coef["s"][where].T[:, :, None], z)
        kv = kk * v
        p = self.p
        root = p.secant(np.maximum(s, 0.0))
        i = min(int(np.searchsorted(left[:self.approach], y1, side="right")) - 1,
                self.approach - 1)
        z1 = 2 * (y1 - left[i]) / sizes[i] - 1
        s1, v1 = (float(clenshaw(self.coef[f][i], z1)) for f in ("s", "v"))
        k1 = float(self.p.k(np.array([gap * (2 * y - gap)]))[0])
        return (p.n * np.sum(kv * root), np.sum(kv), p.n * float(p.secant(max(s1, 0.0))),
                k1 * v1 * 2 * y1)

    # -- elements --------------------------------------------------------------------------

    def plate_rows(self, y0, h, y, integral):
        """U' = of_force F + known, and alpha at the nodes."""
        p, at, n = self.p, self.at, self.mesh.n
        t = y * y
        alpha, rate = p.alpha(t)
        zero, one = np.zeros((n + 1, n + 1)), np.eye(n + 1)
        memory = zero, np.zeros(n + 1), np.zeros(n + 1)
        if p.plate_factor == 0.0:
            of_force, known = zero, np.zeros(n + 1)
        elif p.waves == "hereditary":
            of_force, known = p.g * one, np.zeros(n + 1)
            if p.psi:
                own, _, past = self.rows(y0, h, p.psi, p.psi_singular, ("impulse", "force"), False)
                of_force, known = of_force + own, past["force"]
                memory = own, past["impulse"], past["force"]
        elif p.waves == "frozen":
            of_force = np.diag(alpha) - integral * rate[None, :]
            known = np.full(n + 1, -at["frozen"])
        else:
            of_force = np.diag(alpha) + rate[:, None] * integral
            known = rate * at["impulse"]
        return of_force, known, alpha, rate, memory

    def boltzmann(self, y0, h):
        """Fields at the nodes of an element under Boltzmann's law."""
        p, at, mesh = self.p, self.at, self.mesh
        n, xi = mesh.n, mesh.xi
        y = y0 + h * (1 + xi) / 2
        y[-1] = y0 + h
        t = y * y
        since = (y - y0) * (y + y0)
        integral = mesh.integral(y0, h)
        own, own_slope, past = self.rows(y0, h, p.k, p.singular, ("u", "du"), True)
        a_full = own + p.eta * np.eye(n + 1)
        d_full = own_slope + p.eta * mesh.rate(y, h)
        if y0 == 0.0:
            a_full[0] = d_full[0] = 0.0
        of_force, known_rate, alpha, rate, memory = self.plate_rows(y0, h, y, integral)
        weight = integral @ a_full / p.m
        known = p.free(t)[0] - at["j"] / p.m - integral @ past["u"] / p.m
        if p.plate_factor == 0.0:
            pass
        elif p.waves == "frozen":
            move = integral @ of_force
            weight = weight + move @ d_full
            known = known - at["plate"] + at["frozen"] * since - move @ past["du"]
        else:
            of_impulse = np.diag(alpha) if p.waves != "hereditary" else (
                p.g * np.eye(n + 1) + memory[0])
            weight = weight + of_impulse @ a_full
            known = known - of_impulse @ past["u"] - memory[1]
        s = at["s"] + at["v"] * since
        for it in range(60):
            u = p.u(s)
            u[0] = at["u"]
            residual = s + weight @ u - known
            jacobian = np.eye(n + 1) + weight * (p.n * p.secant(s))[None, :]
            ds = np.zeros(n + 1)
            ds[1:] = np.linalg.solve(jacobian[1:, 1:], residual[1:])
            s = s - ds
            size_s = max(self.smax, np.max(np.abs(s)))
            if np.max(np.abs(ds)) <= (3e-16 if it < 8 else 1e-14) * size_s:
                break
        else:
            raise RuntimeError("Newton iteration does not converge")
        u = p.u(s)
        u[0] = at["u"]
        impulse = a_full @ u + past["u"]
        force = d_full @ u + past["du"]
        if y0 == 0.0:
            # a dashpot presses at once under a punch
            force[0] = p.eta * p.v0 / (1 + p.eta * of_force[0, 0]) if p.n == 1.0 else 0.0
            impulse[0] = 0.0
        wave = of_force @ force + known_rate
        if p.waves in ("relaxing", "constant"):
            wave = alpha * force + rate * impulse
        wave[t == 0] = of_force[0, 0] * force[0]
        return dict(y0=y0, h=h, s=s, u=u, impulse=impulse, force=force, wave=wave,
                    v=p.free(t)[1] - impulse / p.m - wave, integral=integral,
                    rate=rate, du=mesh.rate_of @ u * (2 / h), df=mesh.rate_of @ force * (2 / h))

    def receding(self, y0, h):
        """Fields at the nodes of an element after the largest indentation, by Ting's rule."""
        p, at, mesh, n = self.p, self.at, self.mesh, self.mesh.n
        y = y0 + h * (1 + mesh.xi) / 2
        y[-1] = y0 + h
        since = (y - y0) * (y + y0)
        integral = mesh.integral(y0, h)
        own, _, past = self.rows(y0, h, p.k, p.singular, ("v",), False)
        of_force, known_rate, _, rate, _ = self.plate_rows(y0, h, y, integral)
        # v = free - brake F; condition: own v + past + eta v = int_0^t1 k v
        brake = integral / p.m + of_force
        free = p.free(y * y)[1] - at["impulse"] / p.m - known_rate
        own = own + p.eta * np.eye(n + 1)
        of = -own @ brake
        back = np.empty(n + 1)                        # y_max - y1
        guess = np.maximum(self.t1 + self.t1_rate * since, 0.02 * self.t1)
        y_max = self.y_max
        back[:] = (y_max ** 2 - guess) / (y_max + np.sqrt(guess))
        back[0] = self.back
        force, target, root, slope = np.zeros((4, n + 1))
        force[0] = at["force"]
        best = math.inf
        for it in range(100):
            for i in range(1, n + 1):
                force[i], target[i], root[i], slope[i] = self.until(y[i], back[i], y_max)
            v = free - brake @ force
            residual = own @ v + past["v"] - target
            matrix = np.eye(n + 1) - of * root[None, :]
            dw = np.zeros(n + 1)
            dw[1:] = np.linalg.solve(matrix[1:, 1:], residual[1:])
            with np.errstate(divide="ignore", invalid="ignore"):
                change = np.where(slope != 0, -dw / slope, 0.0)
            # a step in t1 - t_max is taken as one in its square next to the maximum
            new = back + change
            new = np.clip(new, back / 4, back * 4 + 0.0)
            new = np.minimum(new, y_max - (y_max - back) / 4)
            clipped = np.any(np.abs(new - back - change)[1:] > 1e-3 * np.abs(back)[1:])
            size = np.max(np.abs(dw * root)) / self.fmax
            if not clipped and (size < 2e-15 or (it > 6 and size > 0.3 * best and size < 1e-12)):
                break
            if not clipped:
                best = min(best, size)
            back[1:] = new[1:]
        else:
            raise NoSeparation("Ting's rule: Newton iteration does not converge")
        impulse = at["impulse"] + integral @ force
        v = free - brake @ force
        wave = of_force @ force + known_rate
        s = at["s"] + integral @ v
        return dict(y0=y0, h=h, s=s, u=p.u(s), impulse=impulse, force=force, wave=wave,
                    v=v, integral=integral, rate=rate, du=0.0 * s,
                    df=mesh.rate_of @ force * (2 / h), back=back, condition=own @ v + past["v"])

    def accept(self, e, upto=1.0):
        """Keep an element up to the reduced coordinate `upto`."""
        p, at, mesh = self.p, self.at, self.mesh
        c = {f: mesh.to_coef @ e[f] for f in (*self.FIELDS, "wave")}
        pz = -1 + (upto + 1) * mesh.g01
        pw = (upto + 1) * mesh.w01 * (e["h"] / 2) * 2 * (e["y0"] + e["h"] * (1 + pz) / 2)
        force, v, wave = (cheb.chebval(pz, c[f]) for f in ("force", "v", "wave"))
        self.w_h += np.sum(pw * force * v)
        self.w_wave += np.sum(pw * force * wave)
        self.z += np.sum(pw * (v + wave))
        self.smax = max(self.smax, peak(c["s"], upto))
        self.fmax = max(self.fmax, peak(c["force"], upto))
        self.y = e["y0"] + e["h"] * (1 + upto) / 2
        number = len(self.left)
        for f in self.FIELDS:
            if number == self.coef[f].shape[0]:
                self.coef[f] = np.vstack([self.coef[f], 0 * self.coef[f]])
            self.coef[f][number] = c[f]
        self.left.append(e["y0"])
        self.size.append(e["h"])
        end = {f: float(cheb.chebval(upto, c[f])) for f in c}
        last = e["integral"][-1]
        since = e["h"] * (2 * e["y0"] + e["h"])
        frozen = e["integral"] @ (e["rate"] * e["force"])
        self.at = dict(s=end["s"], u=end["u"], impulse=end["impulse"], force=end["force"],
                       v=end["v"], wave=end["wave"], j=at["j"] + last @ e["impulse"],
                       plate=at["plate"] + last @ e["wave"], frozen=at["frozen"] + frozen[-1])
        return c, since

    def smooth(self, make, y0, h):
        """An element, halved until the last coefficients of the force are small."""
        mesh = self.mesh
        before = math.inf
        kept = None
        while True:
            e = make(y0, h)
            c = mesh.to_coef @ e["force"]
            scale = max(self.fmax, np.max(np.abs(e["force"])))
            tail = np.max(np.abs(c[-2:])) / scale
            if kept is not None and tail > 0.3 * before:
                return kept
            if tail < mesh.tolerance or h < 1e-3 * self.step_max:
                return e
            before, kept, h = tail, e, h / 2

    def to_kink(self, y0, h):
        """The step, ended at a time where a modulus is not smooth."""
        for x in self.p.kinks:
            root = math.sqrt(x)
            if y0 * (1 + 1e-12) < root < y0 + 1.3 * h:
                return root - y0 if root < y0 + h * (1 + 1e-12) else (root - y0) / 2
        return h

    # -- the march -------------------------------------------------------------------------

    def run(self, limit=3000.0):
        p, mesh = self.p, self.mesh
        h = 1e-4 * self.y_scale
        receding = p.law == "receding"
        for _ in range(20000):
            if self.y > math.sqrt(limit) * self.y_scale:
                raise NoSeparation("no separation")
            e = self.smooth(self.boltzmann, self.y, self.to_kink(self.y, h))
            if receding and np.any(e["v"][1:] < 0):
                c = mesh.to_coef @ e["v"]
                first = int(np.argmax(e["v"][1:] < 0)) + 1
                z = brentq(lambda x: cheb.chebval(x, c), mesh.xi[first - 1], mesh.xi[first],
                           xtol=1e-16, rtol=1e-15)
                if np.any(e["force"][1:first] <= 0):
                    raise NoSeparation("the force ends before the contact is largest")
                self.accept(self.boltzmann(self.y, e["h"] * (1 + z) / 2))
                return self.rebound(limit)
            if np.any(e["force"][1:] < 0.0):
                f_c = mesh.to_coef @ e["force"]
                first = int(np.argmax(e["force"][1:] < 0.0)) + 1
                root = brentq(lambda z: cheb.chebval(z, f_c), mesh.xi[first - 1], mesh.xi[first],
                              xtol=1e-16, rtol=1e-15)
                self.accept(e, root)
                return self.outcome(self.y ** 2)
            self.accept(e)
            # next step: growth, the largest one, and half-way at most to where s vanishes
            h = min((mesh.ratio - 1) * self.y, self.step_max, 2 * e["h"])
            s, v, y = self.at["s"], self.at["v"], self.y
            if v < 0:
                c = mesh.to_coef @ e["v"]
                acc = cheb.chebval(1.0, mesh.deriv @ c) * (2 / e["h"]) / (2 * y)
                rest = -s / v
                disc = v ** 2 - 2 * acc * s
                if acc < 0 and disc > 0:
                    rest = min(rest, 2 * s / (-v + math.sqrt(disc)))
                if rest < 1e-9 * y ** 2:      # s and F vanish together: an elastic end
                    self.at.update(s=0.0)
                    return self.outcome(y ** 2 + rest)
                h = min(h, math.sqrt(y ** 2 + 0.5 * rest) - y)
        raise NoSeparation("no separation")

    def rebound(self, limit):
        """From the largest indentation on, receding contact."""
        mesh = self.mesh
        self.y_max, self.approach = self.y, len(self.left)
        self.t1, self.t1_rate, self.back = self.y ** 2, -1.0, 0.0
        h = 1e-6 * self.y
        for _ in range(20000):
            if self.y > math.sqrt(limit) * self.y_scale:
                raise NoSeparation("no separation")
            e = self.smooth(self.receding, self.y, self.to_kink(self.y, h))
            self.accept(e)
            y = self.y
            y1 = self.y_max - e["back"]
            t1 = y1 ** 2
            if np.any(np.diff(t1) >= 0):
                raise NoSeparation("the contact grows again")
            slope = mesh.deriv @ (mesh.to_coef @ t1)
            self.t1, self.back = t1[-1], e["back"][-1]
            self.t1_rate = min(cheb.chebval(1.0, slope) * (2 / e["h"]) / (2 * y), 0.0)
            condition = mesh.to_coef @ e["condition"]
            falls = cheb.chebval(1.0, mesh.deriv @ condition) * (2 / e["h"]) / (2 * y)
            rest = -e["condition"][-1] / falls if falls < 0 else math.inf
            if rest < 1e-10 * y ** 2:
                self.at["s"] += self.at["v"] * rest
                return self.outcome(y ** 2 + rest)
            # y - y_max doubles at most, the rest is halved at most
            h = min(2 * e["h"], y - self.y_max, (mesh.ratio - 1) * y, self.step_max)
            if rest < math.inf:
                h = min(h, math.sqrt(y ** 2 + 0.5 * rest) - y)
        raise NoSeparation("no separation")

    def outcome(self, t_end):
        p, at = self.p, self.at
        energy = 0.5 * p.m * p.v0 ** 2
        fall = p.gravity * t_end
        cor_sphere = at["impulse"] / (p.m * p.v0) - 1 - fall / p.v0
        weight_work = p.m * p.gravity * (self.z + (at["v"] + at["wave"]) * (t_end - self.y ** 2))
        omega = 2 * math.pi / t_end
        w_h = 0.0 if p.is_elastic else self.w_h
        return dict(
            cor=cor_sphere + at["wave"] / p.v0, cor_sphere=cor_sphere, contact_time=t_end,
            max_indentation=self.smax, max_force=self.fmax, residual_indentation=at["s"],
            residual_ratio=at["s"] / self.smax, hysteresis_energy=w_h, wave_energy=self.w_wave,
            initial_energy=energy,
            energy_imbalance=(energy * (1 - cor_sphere ** 2) + weight_work - w_h - self.w_wave)
            / energy,
            min_frequency=omega, inelasticity=p.inelasticity(),
            loss_tangent=p.loss_tangent(omega))


def peak(c, upto):
    """Largest value of a Chebyshev series on [-1, upto]."""
    d = cheb.chebder(c)
    grid = np.linspace(-1, upto, 60)
    slope = cheb.chebval(grid, d)
    best = max(cheb.chebval(-1.0, c), cheb.chebval(upto, c))
    for i in range(59):
        if slope[i] > 0 >= slope[i + 1]:
            z = brentq(lambda x: cheb.chebval(x, d), grid[i], grid[i + 1], xtol=1e-15)
            best = max(best, cheb.chebval(z, c))
    return float(best)


def solve(case):
    """Reference outcome, and how far (relative) a second mesh is from it."""
    fine, coarse = both(case)
    return fine, difference(fine, coarse)


def both(case):
    """Outcomes on two meshes."""
    impact = Impact(case)
    return tuple(Contact(impact, mesh).run() for mesh in meshes())


def difference(x, y):
    """Largest relative difference of two outcomes, or the energy imbalance if that is larger."""
    error = abs(x["energy_imbalance"])
    for name in ("cor", "cor_sphere", "contact_time", "max_indentation", "max_force",
                 "residual_indentation", "hysteresis_energy", "wave_energy", "min_frequency",
                 "inelasticity", "loss_tangent"):
        scale = abs(x[name])
        if name == "residual_indentation":
            scale = x["max_indentation"]
        if name in ("hysteresis_energy", "wave_energy"):
            scale = x["initial_energy"]
        if scale > 0 and not math.isnan(x[name]):
            error = max(error, abs(x[name] - y[name]) / scale)
    return error
