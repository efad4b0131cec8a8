"""High-accuracy reference impacts for the tests of vcor: the rows of reference.csv.

The cases are those of case_list.py, solved by impact_solver.py (equations and method there) on two
meshes; what they agree on decides the digits.  In double precision that is 13 digits for nearly
every case.

Checks (--check), by methods that share k(t) and alpha(t) with the first and nothing else:
- kernels that are sums of exponentials: their internal variables q_k' = l_k (u - q_k) with I' = F,
  J' = I are explicit ordinary differential equations (s is an algebraic function of the state);
  Dormand and Prince's Runge-Kutta 8(5,3) at a relative tolerance of 1e-13: about 13 digits;
- all others: product integration on uniform steps, u piecewise linear, order 2 - a for a kernel
  t^-a, with Richardson extrapolation: 10 to 11 digits.
--laws compares with closed forms and with limits, and the loss tangents with another quadrature.

Usage:  make_reference.py [--check] [--laws] [--only TEXT] [--compare FILE.csv] [--output DIR]

Without options it writes reference.csv and cases/NAME.nml next to itself.  Units are SI.
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
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from case_list import CASES
from impact_solver import Impact, solve

OUTCOME = ["cor", "cor_sphere", "contact_time", "max_indentation", "max_force",
           "residual_indentation", "residual_ratio", "hysteresis_energy", "wave_energy",
           "initial_energy", "energy_imbalance", "min_frequency", "inelasticity", "loss_tangent"]


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
