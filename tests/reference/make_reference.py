"""High-accuracy reference impacts for the tests of vcor.

An impact of a sphere (mass m) on a plate, twice integrated, is the scalar Volterra equation

    s(t) = v0 t - J(t)/m - alpha(t) I(t),     J' = I,
    I(t) = int_0^t k(t-x) u(x) dx + eta u(t),     u = s sqrt(|s|),

because F = int k(t-x) u'(x) dx + eta u', u(0) = 0 and I' = F.  k = (4/3) sqrt(R) E'(t) is the
firmness (N/m^1.5), eta that of a dashpot, alpha(t) = sqrt(3 rho_b / E'_b(t)) / (16 rho_b h^2).

Method.  Spectral collocation in y = sqrt(t), element by element.  u is a polynomial of degree n in
y on each element (Chebyshev-Lobatto nodes); the elements grow geometrically from 1e-4 of the
contact time's root, and shrink geometrically towards the non-smooth point s = 0.  The history
integrals are Gauss-Legendre sums on panels that are graded dyadically towards x = t, the last one
with a substitution that removes the singularity of k.  Only values of k(t), alpha(t) and
alpha'(t) are needed, so every material and every pair of materials takes the same path: no sum of
exponentials, no internal variables, no time stepping.  Each impact is solved on two meshes
(degree, elements and quadrature all different); what they agree on decides the digits.  In double
precision that is 13 digits for nearly every case.

Checks (--check), by methods that share k(t) and alpha(t) with the first and nothing else:
- kernels that are sums of exponentials: their internal variables q_k' = l_k (u - q_k) with I' = F,
  J' = I are explicit ordinary differential equations (s is an algebraic function of the state);
  Dormand and Prince's Runge-Kutta 8(5,3) at a relative tolerance of 1e-13: about 13 digits;
- all others: product integration on uniform steps, u piecewise linear, order 2 - a for a kernel
  t^-a, with Richardson extrapolation: 10 to 11 digits.
--laws compares with closed forms and with limits, and the loss tangents with another quadrature.

Usage:  make_reference.py [--check] [--laws] [--only TEXT] [--compare FILE.csv] [--output DIR]

Without options it writes reference.csv and cases/NAME.nml beside itself.  Units are SI.
"""

import argparse
import csv
import math
import os
import pathlib
from concurrent.futures import ProcessPoolExecutor

os.environ.setdefault("OMP_NUM_THREADS", "1")    # the cases run in parallel, not the matrices

import mpmath
import numpy as np
from numpy.polynomial import chebyshev as cheb
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from scipy.special import erfcx

from case_list import CASES

OUTCOME = ["cor", "cor_sphere", "contact_time", "max_indentation", "max_force",
           "residual_indentation", "residual_ratio", "hysteresis_energy", "wave_energy",
           "initial_energy", "energy_imbalance", "min_frequency", "inelasticity", "loss_tangent"]


# ---------------------------------------------------------------------------------- materials

class Material:
    """Relaxation modulus E(t) = regular part (t > 0) + viscosity delta(t), and its transforms."""

    def __init__(self, name, model, density=None, poisson_ratio=0.5, **keys):
        self.name, self.model, self.density, self.nu, self.keys = (
            name, model, density, poisson_ratio, keys)
        self.viscosity = 0.0
        self.moduli = self.rates = np.zeros(0)
        if model == "elastic":
            self.e0 = keys["modulus"]
        elif model == "sls":
            ratio = keys["alpha"] / keys["beta"]
            self.e0 = keys["glassy_modulus"] * ratio
            self.moduli = np.array([keys["glassy_modulus"] * (1 - ratio)])
            self.rates = np.array([keys["beta"]])
        elif model == "prony":
            self.e0 = keys["equilibrium_modulus"]
            self.viscosity = keys.get("viscosity", 0.0)
            self.moduli = np.array(keys.get("moduli", []), float)
            self.rates = (np.array(keys["rates"], float) if "rates" in keys
                          else 1.0 / np.array(keys.get("times", []), float))
        elif model in ("power_law", "cerf"):
            self.e0 = keys["equilibrium_modulus"]
        elif model != "rigid":
            raise ValueError(model)

    @property
    def is_exponential_sum(self):
        return self.model in ("rigid", "elastic", "sls", "prony")

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
        else:
            for modulus, rate in zip(self.moduli, self.rates):
                value = value + modulus * np.exp(-rate * t)
        return value / (1 - self.nu ** 2)

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
        else:
            value = 0.0 * t
            for modulus, rate in zip(self.moduli, self.rates):
                value = value - modulus * rate * np.exp(-rate * t)
        return value / (1 - self.nu ** 2)

    def complex_plane(self, s):
        """s E(s)/(1-nu^2) with the Laplace variable s [Pa]."""
        value = self.e0 + self.viscosity * s
        if self.model == "power_law":
            value += self.keys["coefficient"] * s ** self.keys["exponent"]
        elif self.model == "cerf":
            root = np.sqrt(s)
            value += self.keys["relaxing_modulus"] * root / (root + self.keys["beta"])
        else:
            value += np.sum(self.moduli * s / (s + self.rates))
        return value / (1 - self.nu ** 2)

    @property
    def singular_exponent(self):
        return self.keys["exponent"] if self.model == "power_law" else 0.0


class Impact:
    """One case: kernel, plate parameter, and the numbers that enter the equation."""

    def __init__(self, case):
        self.case = case
        made = {m["name"]: Material(**m) for m in case["materials"]}
        sphere, plate = case["sphere"], case["plate"]
        self.a, self.b = made[sphere["material"]], made[plate["material"]]
        self.v0 = case["velocity"]
        r = sphere["radius"]
        self.m = sphere.get("mass") or 4 / 3 * math.pi * r ** 3 * self.a.density
        rs = plate.get("surface_radius", 0.0)
        self.radius = 1 / (1 / r + (1 / rs if rs else 0.0))
        self.c = 4 / 3 * math.sqrt(self.radius)
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
                self.modulus(np.array(1.0)))), 1.0)
        visc = self.single[0].viscosity / (1 - self.single[0].nu ** 2) if self.single else 0.0
        if not self.single and (a.viscosity or b.viscosity):
            raise ValueError("a dashpot in a general pair has no contact modulus by Eq. (1)")
        self.eta = self.c * visc * (self.single[1] if self.single else 0.0)
        self.is_exponential_sum = bool(self.single and self.single[0].is_exponential_sum)
        self.is_elastic = (self.is_exponential_sum and self.eta == 0.0
                           and not self.single[0].moduli.size)
        self.singular = self.single[0].singular_exponent if self.single else 0.0
        if not self.single and a.singular_exponent and b.singular_exponent:
            self.singular = min(a.singular_exponent, b.singular_exponent)
        h, rho = plate.get("half_thickness", 1.0), b.density or 1.0
        self.plate_factor = math.sqrt(3 * rho) / (16 * rho * h ** 2)
        if self.waves == "none" or b.model == "rigid":
            self.plate_factor = 0.0

    def modulus(self, t):
        """Contact modulus, Eq. (1), for t > 0 [Pa]."""
        ea, eb = self.a.plane(t), self.b.plane(t)
        if self.a.model == "rigid":
            return eb
        if self.b.model == "rigid":
            return ea
        return 1 / (1 / ea + 1 / eb)

    def k(self, t):
        return self.c * self.modulus(t)

    def alpha(self, t):
        """alpha(t) and alpha'(t)."""
        if self.plate_factor == 0.0:
            return 0.0 * t, 0.0 * t
        if self.waves == "constant":
            return self.plate_factor / np.sqrt(self.b.plane(0.0 * t)), 0.0 * t
        eb = self.b.plane(t)
        a = self.plate_factor / np.sqrt(eb)
        with np.errstate(all="ignore"):
            rate = np.where(t > 0, -0.5 * a * self.b.plane_rate(np.maximum(t, 1e-300)) / eb, 0.0)
        return a, rate

    def inelasticity(self):
        """Zener's lambda; 0 where k(0) is infinite (the limit t -> 0 of alpha m / T)."""
        a0 = float(self.alpha(np.zeros(1))[0][0])
        if self.singular or self.eta or a0 == 0.0:
            return 0.0
        k0 = float(self.k(np.zeros(1))[0])
        return a0 * self.m / (self.m / (k0 * math.sqrt(self.v0))) ** 0.4

    def loss_tangent(self, omega):
        """Loss over storage of the contact modulus at omega."""
        if self.single:
            value = self.single[0].complex_plane(1j * omega)
            return value.imag / value.real
        # E' of Eq. (1) is a product in time: i omega int (E'(t) - E'(inf)) e^(-i omega t) dt
        end = 1 / (1 / (self.a.e0 / (1 - self.a.nu ** 2)) + 1 / (self.b.e0 / (1 - self.b.nu ** 2)))
        nodes, weights = np.polynomial.legendre.leggauss(20)
        if self.a.is_exponential_sum and self.b.is_exponential_sum:
            turn = 1.0      # along the real axis, down to e^(-45) of the slowest mode
            rates = np.concatenate([self.a.rates, self.b.rates])
            top = 45 / rates.min()
            start = 1e-3 / max(rates.max(), omega)
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
        """Duration of contact, roughly: the Hertz formula with k at about that time [s]."""
        t = 1e-3
        for _ in range(100):
            k = float(self.k(np.array([t]))[0]) + self.eta / t
            t = 0.5 * (t + 3.2 * (self.m / (k * math.sqrt(self.v0))) ** 0.4)
        return t


# ------------------------------------------------------------------------ spectral collocation

def solve_volterra(impact, degree, elements, ratio, panels):
    """Outcome of the impact and the reached s, I, J at separation.

    degree: of the polynomials; elements: how many, about, per contact time; ratio: growth of the
    first ones; panels: dyadic levels of the history quadrature.
    """
    n = degree
    xi = -np.cos(math.pi * np.arange(n + 1) / n)
    to_coef = np.linalg.inv(cheb.chebvander(xi, n))
    gauss, gauss_w = np.polynomial.legendre.leggauss(n + 6)
    g01, w01 = (1 + gauss) / 2, gauss_w / 2
    # derivative T_j'(x) as coefficients, columns j
    deriv = np.zeros((n + 1, n + 1))
    for j in range(1, n + 1):
        deriv[:j, j] = cheb.chebder(np.eye(n + 1)[j, :j + 1])
    power = 4 / (1 - impact.singular)

    v0, m, eta = impact.v0, impact.m, impact.eta
    y_scale = math.sqrt(impact.time_scale())
    step_max = y_scale / elements
    left, size, coefs = [], [], []           # past elements: left end, size, coefficients of u
    start = 1e-4 * y_scale
    y0, h = 0.0, start
    s_end, v_end, i_end, j_end, u_end = 0.0, v0, 0.0, 0.0, 0.0
    w_h = w_wave = 0.0
    smax = fmax = 0.0
    for _ in range(20000):
        y = y0 + h * (1 + xi) / 2
        y[-1] = y0 + h
        t = y * y
        alpha, alpha_rate = impact.alpha(t)
        # rows of  I = A_in u + history  and  F = D_in u + history
        a_in, d_in = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
        a_his, d_his = np.zeros(n + 1), np.zeros(n + 1)
        bounds = np.array(left + [y0])
        for i in range(n + 1):
            if y[i] == 0.0:
                continue
            own = h * (1 + xi[i]) / 2                  # distance to the left end, exact
            to_bounds = y[i] - bounds
            to_bounds[-1] = own
            dyadic = [y[i]]
            floor = y[i] * 2.0 ** -panels
            if i > 0:
                floor = min(floor, own / 2)
            else:
                floor = min(floor, size[-1] / 2)
            while dyadic[-1] > floor:
                dyadic.append(dyadic[-1] / 2)
            edge = np.unique(np.concatenate([dyadic, to_bounds[to_bounds > 0]]))
            keep = np.ones(edge.size, bool)
            keep[1:] = np.diff(edge) > 1e-14 * edge[1:]
            edge = edge[keep]
            d = edge[:-1, None] + np.diff(edge)[:, None] * g01
            w = np.diff(edge)[:, None] * w01
            # innermost panel [0, edge0], substitution d = edge0 z^power
            d = np.vstack([edge[0] * g01[None, :] ** power, d])
            w = np.vstack([edge[0] * power * g01 ** (power - 1) * w01, w])
            k = impact.k((d * (2 * y[i] - d)).ravel()).reshape(d.shape)
            middle = d.mean(axis=1)
            # element of each panel: bounds is increasing, to_bounds decreasing
            where = np.searchsorted(-to_bounds, -middle, side="right") - 1
            now = where == len(left)
            if now.any():
                z = (xi[i] + 1) - 2 * d[now] / h - 1
                van = cheb.chebvander(z.ravel(), n)
                kk = (w[now] * k[now]).ravel()
                a_in[i] = ((kk * 2 * (y[i] - d[now]).ravel()) @ van) @ to_coef
                d_in[i] = (kk @ (van @ deriv)) @ to_coef * (2 / h)
            if not now.all():
                old = ~now
                dist = to_bounds[where[old]][:, None] - d[old]     # from the left end
                sizes = np.array(size)[where[old]][:, None]
                z = 2 * dist / sizes - 1
                c = np.array(coefs)[where[old]].T[:, :, None]
                value, slope = clenshaw(c, z, n)
                kk = w[old] * k[old]
                a_his[i] = np.sum(kk * 2 * (y[i] - d[old]) * value)
                d_his[i] = np.sum(kk * slope * 2 / sizes)
        # I = a_in u + a_his + eta u;  J by integrating I's interpolant over t
        a_full = a_in + eta * np.eye(n + 1)
        integral = integration_matrix(n, to_coef, y0, h)     # of f dt, from the left end
        if y0 == 0.0:
            a_full[0] = 0.0
        weight = alpha[:, None] * a_full + integral @ a_full / m
        known = v0 * t - j_end / m - alpha * a_his - integral @ a_his / m
        s = s_end + v_end * (t - t[0])
        s[0] = s_end
        for it in range(60):
            u = s * np.sqrt(np.abs(s))
            u[0] = u_end
            residual = s + weight @ u - known
            jacobian = np.eye(n + 1) + weight * (1.5 * np.sqrt(np.abs(s)))[None, :]
            ds = np.zeros(n + 1)
            ds[1:] = np.linalg.solve(jacobian[1:, 1:], residual[1:])
            s = s - ds
            size_s = max(smax, np.max(np.abs(s)))
            if np.max(np.abs(ds)) <= (3e-16 if it < 8 else 1e-14) * size_s:
                break
        else:
            raise RuntimeError("Newton iteration does not converge")
        u = s * np.sqrt(np.abs(s))
        u[0] = u_end
        impulse = a_full @ u + a_his
        du = cheb.chebval(xi, deriv @ (to_coef @ u)) * (2 / h) / np.maximum(2 * y, 1e-300)
        force = d_in @ u + d_his + eta * du
        if y0 == 0.0:
            force[0] = impulse[0] = 0.0
        plate_velocity = alpha_rate * impulse + alpha * force
        plate_velocity[t == 0] = 0.0
        velocity = v0 - impulse / m - plate_velocity
        # energies need integrals over t of F s' and F U'
        f_c = to_coef @ force
        ended = bool(np.any(force[1:] < 0.0))
        if ended:
            first = int(np.argmax(force[1:] < 0.0)) + 1
            lower = xi[first - 1]
            root = brentq(lambda z: cheb.chebval(z, f_c), lower, xi[first], xtol=1e-16, rtol=1e-15)
        upto = root if ended else 1.0
        pz = -1 + (upto + 1) * g01
        pw = (upto + 1) * w01 * (h / 2) * 2 * (y0 + h * (1 + pz) / 2)
        values = cheb.chebval(pz, to_coef @ np.stack([force, velocity, plate_velocity]).T)
        w_h += np.sum(pw * values[0] * values[1])
        w_wave += np.sum(pw * values[0] * values[2])
        smax = max(smax, peak(to_coef @ s, upto))
        fmax = max(fmax, peak(f_c, upto))
        left.append(y0)
        size.append(h)
        coefs.append(to_coef @ u)
        if ended:
            at = {q: float(cheb.chebval(root, to_coef @ x)) for q, x in
                  dict(s=s, i=impulse, v=velocity).items()}
            t_end = (y0 + h * (1 + root) / 2) ** 2
            break
        s_end, v_end, u_end, i_end = s[-1], velocity[-1], u[-1], impulse[-1]
        j_end += integral[-1] @ impulse
        y0 = y0 + h
        # next step: growth, the largest one, and half-way at most to where s vanishes
        h = min((ratio - 1) * y0, step_max)
        if v_end < 0:
            acc = (cheb.chebval(1.0, deriv @ (to_coef @ velocity)) * (2 / size[-1]) / (2 * y0))
            rest = -s_end / v_end
            disc = v_end ** 2 - 2 * acc * s_end
            if acc < 0 and disc > 0:
                rest = min(rest, 2 * s_end / (-v_end + math.sqrt(disc)))
            if rest < 1e-9 * y0 ** 2:      # s and F vanish together: an elastic end
                t_end = y0 ** 2 + rest
                at = dict(s=0.0, i=i_end, v=v_end)
                break
            h = min(h, math.sqrt(y0 ** 2 + 0.5 * rest) - y0)
    else:
        raise RuntimeError("no separation")
    # F = 0 at the end, so s' = v0 - I/m - alpha' I there
    a_rate = float(impact.alpha(np.array([t_end]))[1][0])
    energy = 0.5 * m * v0 ** 2
    cor_sphere = at["i"] / (m * v0) - 1
    omega = 2 * math.pi / t_end
    if impact.is_elastic:
        w_h = 0.0
    return dict(
        cor=cor_sphere + a_rate * at["i"] / v0, cor_sphere=cor_sphere, contact_time=t_end,
        max_indentation=smax, max_force=fmax, residual_indentation=at["s"],
        residual_ratio=at["s"] / smax, hysteresis_energy=w_h, wave_energy=w_wave,
        initial_energy=energy,
        energy_imbalance=(energy * (1 - cor_sphere ** 2) - w_h - w_wave) / energy,
        min_frequency=omega, inelasticity=impact.inelasticity(),
        loss_tangent=impact.loss_tangent(omega))


def clenshaw(c, z, n):
    """Chebyshev series with coefficients c(0:n, ...) at z and its derivative."""
    b1 = b2 = d1 = d2 = 0.0 * z
    for j in range(n, 0, -1):
        b1, b2, d1, d2 = c[j] + 2 * z * b1 - b2, b1, 2 * b1 + 2 * z * d1 - d2, d1
    return c[0] + z * b1 - b2, b1 + z * d1 - d2


def integration_matrix(n, to_coef, y0, h):
    """Matrix of int f dt from the left end to each node, f given at the nodes, dt = 2 y dy."""
    xi = -np.cos(math.pi * np.arange(n + 1) / n)
    out = np.zeros((n + 1, n + 1))
    for j in range(n + 1):
        c = to_coef[:, j]
        c = cheb.chebmul(c, [2 * (y0 + h / 2), h]) * (h / 2)
        p = cheb.chebint(c, lbnd=-1)
        out[:, j] = cheb.chebval(xi, p)
    return out


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
    impact = Impact(case)
    fine = solve_volterra(impact, 22, 12, 1.4, 16)
    coarse = solve_volterra(impact, 17, 9, 1.6, 13)
    return fine, difference(fine, coarse)


def difference(x, y):
    """Largest relative difference of two outcomes, or the energy imbalance if that is larger."""
    error = 0.0
    for name in OUTCOME:
        if name in ("energy_imbalance", "residual_ratio"):
            continue
        scale = abs(x[name])
        if name == "residual_indentation":
            scale = x["max_indentation"]
        if name in ("hysteresis_energy", "wave_energy"):
            scale = x["initial_energy"]
        if scale > 0:
            error = max(error, abs(x[name] - y[name]) / scale)
    error = max(error, abs(x["energy_imbalance"]))
    return error



# ------------------------------------------------------------------------- independent checks

def solve_ode(impact):
    """cor, cor_sphere, contact_time, W_h, W_wave by internal variables and Runge-Kutta 8(5,3)."""
    material, factor = impact.single
    scale = impact.c * factor / (1 - material.nu ** 2)
    g0, g, rates = scale * material.e0, scale * material.moduli, material.rates
    m, v0, eta = impact.m, impact.v0, impact.eta
    if eta and impact.plate_factor:
        raise ValueError("the check has no dashpot together with a moving plate")
    n = g.size
    time = impact.time_scale()
    s_scale = v0 * time
    u_scale = s_scale ** 1.5
    size = np.concatenate([[m * v0, m * v0 * time], np.full(n, u_scale), [m * v0 ** 2] * 2])

    def parts(x, state):
        """Rate of the state over t, force."""
        t = x * x
        i, j, q = state[0], state[1], state[2:2 + n]
        if eta:                                  # state[0] is the impulse without the dashpot's
            s = v0 * t - j / m
            u = s * math.sqrt(abs(s))
            i = i + eta * u
            alpha = alpha_rate = 0.0
        else:
            a, b = impact.alpha(np.array([t]))
            alpha, alpha_rate = float(a[0]), float(b[0])
            s = v0 * t - j / m - alpha * i
            u = s * math.sqrt(abs(s))
        f = g0 * u + np.dot(g, u - q)
        rate = np.empty(n + 4)
        rate[0] = f
        if eta:
            f = f + eta * 1.5 * math.sqrt(abs(s)) * (v0 - i / m)
        wave = alpha_rate * i + alpha * f
        rate[1] = i
        rate[2:2 + n] = rates * (u - q)
        rate[-2] = f * (v0 - i / m - wave)
        rate[-1] = f * wave
        return rate, f, i, alpha_rate

    def right_side(x, z):
        return 2 * x * parts(x, z * size)[0] / size

    def force(x, z):
        return parts(x, z * size)[1] if x > 1e-3 * math.sqrt(time) else 1.0
    force.terminal, force.direction = True, -1

    run = solve_ivp(right_side, (0.0, 30 * math.sqrt(time)), np.zeros(n + 4), method="DOP853",
                    rtol=1e-13, atol=1e-16, events=force, max_step=math.sqrt(time) / 30)
    x, state = run.t_events[0][0], run.y_events[0][0] * size
    rate, _, i, alpha_rate = parts(x, state)
    cor_sphere = i / (m * v0) - 1
    return dict(cor=cor_sphere + alpha_rate * i / v0, cor_sphere=cor_sphere, contact_time=x * x,
                hysteresis_energy=state[-2], wave_energy=state[-1])


def solve_product(impact, steps, end):
    """cor and contact time by product integration with u piecewise linear, second order."""
    dt = end / steps
    g, w = np.polynomial.legendre.leggauss(24)
    z, zw = (1 + g) / 2, w / 2
    p = 4 / (1 - impact.singular)
    first = np.sum(impact.k(dt * z ** p) * p * z ** (p - 1) * zw)
    nodes = dt * (np.arange(1, steps + 2)[:, None] + z)
    mean = np.concatenate([[first], (impact.k(nodes.ravel()).reshape(nodes.shape) * zw).sum(1)])
    t = dt * np.arange(steps + 2)
    alpha, alpha_rate = impact.alpha(t)
    backward = mean[::-1].copy()
    du = np.zeros(steps + 2)
    force, impulse = np.zeros(steps + 2), np.zeros(steps + 2)
    j = u = s = 0.0
    m, v0 = impact.m, impact.v0
    for n in range(1, steps + 2):
        history = np.dot(backward[mean.size - n:mean.size - 1], du[1:n]) if n > 1 else 0.0
        s = s + v0 * dt if n == 1 else s
        for _ in range(50):
            un = s * math.sqrt(abs(s))
            f = history + mean[0] * (un - u)
            i = impulse[n - 1] + dt / 2 * (force[n - 1] + f)
            jn = j + dt / 2 * (impulse[n - 1] + i)
            fp = mean[0] * 1.5 * math.sqrt(abs(s))
            ds = ((s - v0 * t[n] + jn / m + alpha[n] * i)
                  / (1 + fp * (dt * dt / 4 / m + alpha[n] * dt / 2)))
            s -= ds
            if abs(ds) < 1e-16 * v0 * end:
                break
        un = s * math.sqrt(abs(s))
        du[n], u = un - u, un
        force[n], impulse[n], j = f, i, jn
        if f < 0 and n > 3:
            at = slice(n - 3, n + 1)
            line = np.polynomial.Polynomial.fit(t[at], force[at], 3)
            t0 = brentq(line, t[n - 1], t[n])
            whole = line.integ(lbnd=t[n - 1])(t0)
            i0 = impulse[n - 1] + whole
            rate = float(impact.alpha(np.array([t0]))[1][0])
            return i0 / (m * v0) - 1 + rate * i0 / v0, t0
    raise RuntimeError("no separation within the product check")


def richardson(impact, t0):
    """COR by product integration, extrapolated from five step sizes, and its error estimate."""
    end = 1.02 * t0
    table = [solve_product(impact, n, end)[0] for n in (500, 1000, 2000, 4000, 8000)]
    before = table[-1]
    a = impact.singular
    for order in ((2 - a, 2.0, 3 - a) if a else (2.0, 2.5, 3.0)):
        before = table[-1]
        table = [b + (b - a) / (2 ** order - 1) for a, b in zip(table, table[1:])]
    return table[-1], abs(table[-1] - before)


def check(case, outcome):
    """One line: difference of the independent method from the outcome."""
    impact = Impact(case)
    if impact.is_exponential_sum and (impact.single[0].rates.max(initial=0.0)
                                      * outcome["contact_time"] < 1e6):
        other = solve_ode(impact)
        errors = {k: abs(other[k] - outcome[k]) / (outcome["initial_energy"] if "energy" in k
                                                   else abs(outcome[k])) for k in other}
        return "ode      " + "  ".join(f"{k} {e:.1e}" for k, e in errors.items())
    if impact.eta:
        return "none"
    value, estimate = richardson(impact, outcome["contact_time"])
    return f"product  cor {abs(value - outcome['cor']):.1e} (own estimate {estimate:.1e})"


def fourier_loss_tangent(impact, omega):
    """Loss tangent of a general pair by the Fourier quadrature of QUADPACK on the real axis."""
    def plane0(x):
        return x.e0 / (1 - x.nu ** 2)

    end = 1 / (1 / plane0(impact.a) + 1 / plane0(impact.b))

    def decay(t):
        return float(impact.modulus(np.array(t))) / end - 1

    if impact.a.is_exponential_sum and impact.b.is_exponential_sum:
        stop = 60 / np.concatenate([impact.a.rates, impact.b.rates]).min()
    else:
        stop = np.inf
    storage, loss = (quad(decay, 0, stop, weight=w, wvar=omega, epsabs=1e-10 / omega,
                          epsrel=1e-12, limit=2000, limlst=400)[0] for w in ("sin", "cos"))
    return omega * loss / (1 + omega * storage)


def history_error(exponent):
    """Relative error of int_0^t (t-x)^-a x^1.5 dx by the quadrature of the innermost panels."""
    g, w = np.polynomial.legendre.leggauss(28)
    z, zw, p = (1 + g) / 2, w / 2, 4 / (1 - exponent)
    y, total, high = 1.0, 0.0, 1.0
    for level in range(17):
        low = high / 2 if level < 16 else 0.0
        if low:
            d, dw = low + (high - low) * z, (high - low) * zw
        else:
            d, dw = high * z ** p, high * p * z ** (p - 1) * zw
        total += np.sum(dw * (d * (2 * y - d)) ** (-exponent) * 2 * (y - d) ** 4)
        high = low
    return total / float(mpmath.beta(1 - exponent, mpmath.mpf(5) / 2)) - 1


def laws(outcomes):
    """The closed-form laws and the rows that serve them: text, found, expected, tolerance."""
    mpmath.mp.dps = 30
    hertz = float(mpmath.mpf(4) / 5 * (mpmath.mpf(5) / 4) ** (mpmath.mpf(2) / 5)
                  * mpmath.sqrt(mpmath.pi) * mpmath.gamma(mpmath.mpf(2) / 5)
                  / mpmath.gamma(mpmath.mpf(9) / 10))
    o = outcomes

    def time_unit(name):
        impact = Impact(next(c for c in CASES if c["name"] == name))
        k0 = float(impact.k(np.zeros(1))[0])
        return (impact.m / (k0 * math.sqrt(impact.v0))) ** 0.4

    yield "t0 of Hertz = 3.218065460 T (half space)", (
        o["elastic_half_space_v0.001"]["contact_time"] / time_unit("elastic_half_space_v0.001")
    ), hertz, 1e-12
    yield "t0 of Hertz (convex)", (
        o["elastic_convex_v100"]["contact_time"] / time_unit("elastic_convex_v100")), hertz, 1e-12
    yield "Hertz: COR = 1", o["elastic_convex_v100"]["cor"], 1.0, 1e-12
    for lam, e in ((0.05, 0.917771501790), (0.2, 0.714044879992), (1.0, 0.184122874165)):
        row = o[f"elastic_lambda{lam}"]
        yield f"Zener, lambda = {lam}: e", row["cor"], e, 2e-12
        yield f"Zener, lambda = {lam}: lambda", row["inelasticity"], lam, 1e-13
    yield "power law a = 0.25", o["power_law_a0.25"]["cor"], 0.5716477, 1e-7
    yield "power law a = 0.5", o["power_law_a0.5"]["cor"], 0.2856531, 1e-7
    yield "power law: another impact, same COR", (
        o["power_law_a0.25_other"]["cor"]), o["power_law_a0.25"]["cor"], 1e-12
    t_c = hertz * time_unit("maxwell_weak")
    one, ten = o["maxwell_weak"]["cor"], o["maxwell_weak_faster"]["cor"]
    slope1, slope10 = (1 - one) / t_c, (1 - ten) / (10 * t_c)
    yield "Maxwell: (1 - COR) tau/t_c -> 5/9, at tau = 1 s", slope1, 5 / 9, 5e-3
    # the next term is of relative order (t_c/tau)^(2/3): F vanishes a little before s does
    ratio = 10 ** (2 / 3)
    yield "Maxwell: the same, extrapolated from 1 and 0.1 s", (
        (ratio * slope1 - slope10) / (ratio - 1)), 5 / 9, 1e-3
    yield "no plate: COR depends on T alone", (
        o["sls_scaled"]["cor"]), o["sls_plate_none_v10"]["cor"], 1e-12
    yield "beta -> 0: elastic COR with E_g", (
        o["sls_beta0.001"]["cor"]), o["elastic_v10"]["cor"], 1e-5
    yield "beta -> infinity: elastic COR with E_r", (
        o["sls_beta1e8"]["cor"]), o["elastic_rubbery_v10"]["cor"], 1e-4
    for name in ("soft_sphere_on_pmma", "two_sls", "power_law_sphere_on_rubber",
                 "cerf_sphere_on_sls"):
        impact = Impact(next(c for c in CASES if c["name"] == name))
        found = o[name]["loss_tangent"]
        yield f"loss tangent of {name} by Fourier quadrature", found, (
            fourier_loss_tangent(impact, o[name]["min_frequency"])), 1e-8
    impact = Impact(next(c for c in CASES if c["name"] == "sls_same_both"))
    closed, impact.single = impact.loss_tangent(5000.0), None
    yield "loss tangent: quadrature of Eq. (1) for equal materials", (
        impact.loss_tangent(5000.0)), closed, 1e-13
    for a in (0.25, 0.5, 0.75):
        error = history_error(a)
        yield f"history quadrature of t^-{a} against the Beta function", error, 0.0, 1e-13
    yield "a rigid plate has alpha = 0", (o["sls_sphere_rigid_plate_relaxing"]["cor"]), (
        o["sls_sphere_rigid_plate"]["cor"]), 1e-14


# --------------------------------------------------------------------------------------- files

def namelist(case):
    """The case as a vcor case file."""
    def value(x):
        if isinstance(x, str):
            return f"'{x}'"
        if isinstance(x, list):
            return ", ".join(repr(float(y)) for y in x)
        return repr(float(x))

    def group(name, items):
        return f"&{name}\n" + "".join(f"   {k} = {value(v)}\n" for k, v in items.items()) + "/\n"

    text = group("case", dict(title=f"{case['name']}: {case['note']}".replace("'", "''")))
    text += group("impact", dict(velocity=case["velocity"]))
    text += group("sphere", case["sphere"]) + group("plate", case["plate"])
    for material in case["materials"]:
        text += group("material", material)
    return text


def trusted(error):
    """Decimal digits to trust: a factor 4 on the difference of the two meshes, 13 at most."""
    return max(0, min(13, int(-math.log10(max(4 * error, 1e-15)))))


def compare(path, outcomes):
    """Print the largest relative difference from the rows of another table (case, v0, ...)."""
    alias = dict(cor="cor", cor_sphere="cor_sphere", t0="contact_time", s0="residual_indentation",
                 smax="max_indentation", Fmax="max_force", W_h="hysteresis_energy",
                 W_wave="wave_energy", KE0="initial_energy")
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            name = f"{row['case']}_v{row['v0']}"
            if name not in outcomes:
                print(f"{name}: no such case here")
                continue
            worst = max(((abs(float(row[a]) - outcomes[name][b])
                          / max(abs(outcomes[name][b]), 1e-300 if outcomes[name][b] else 1.0)), a)
                        for a, b in alias.items())
            print(f"{name:32s} worst relative difference {worst[0]:.1e} in {worst[1]:10s} "
                  f"cor {abs(float(row['cor']) - outcomes[name]['cor']):.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="solve again by another method")
    parser.add_argument("--laws", action="store_true", help="check the closed-form laws")
    parser.add_argument("--only", default="", help="cases whose name contains this; writes nothing")
    parser.add_argument("--compare", help="CSV with the columns case, v0, cor, t0, ...")
    parser.add_argument("--output", default=pathlib.Path(__file__).parent, type=pathlib.Path)
    options = parser.parse_args()
    cases = [c for c in CASES if options.only in c["name"]]
    with ProcessPoolExecutor() as pool:
        solved = list(pool.map(solve, cases))
        outcomes = {c["name"]: x for c, (x, _) in zip(cases, solved)}
        for case, (x, error) in zip(cases, solved):
            print(f"{case['name']:34s} cor {x['cor']:.14f}  t0 {x['contact_time']:.13e}  "
                  f"two meshes {error:.1e}  imbalance {x['energy_imbalance']:.1e}")
        if options.check:
            print("\nindependent method, relative differences")
            for case, line in zip(cases, pool.map(check, cases, outcomes.values())):
                print(f"{case['name']:34s} {line}")
    failed = False
    if options.laws and not options.only:
        print("\nlaws")
        for text, found, expected, tolerance in laws(outcomes):
            good = abs(found - expected) <= tolerance
            failed = failed or not good
            print(f"{'ok  ' if good else 'FAIL'} {text}: {found:.13g} against {expected:.13g}, "
                  f"difference {abs(found - expected):.1e}")
    if options.compare:
        print("\ncomparison with", options.compare)
        compare(options.compare, outcomes)
    if not options.only:
        folder = options.output / "cases"
        folder.mkdir(parents=True, exist_ok=True)
        with open(options.output / "reference.csv", "w", newline="", encoding="utf-8") as file:
            out = csv.writer(file, lineterminator="\n")
            out.writerow(["name", "kernel", "laws", *OUTCOME, "digits"])
            for case, (x, error) in zip(cases, solved):
                impact = Impact(case)
                kernel = "exponential_sum" if impact.is_exponential_sum else "general"
                out.writerow([case["name"], kernel, " ".join(case["laws"]),
                              *(f"{float(x[k]):.15e}" for k in OUTCOME), trusted(error)])
                (folder / f"{case['name']}.nml").write_text(namelist(case), encoding="utf-8")
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
