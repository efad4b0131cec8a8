#!/usr/bin/env python3
"""Values of relaxation moduli to 17 digits, for tests/unit/test_material.f90.

    env/bin/python make_material_values.py > ../unit/material_values.f90

needs mpmath (requirements.txt) and prints a Fortran module. The times are binary numbers, so the
values belong to exactly the times that the tests use. 60 digits are carried.

The Mittag-Leffler functions are summed: by their power series up to x = 100, with as many more
digits as its terms cancel, by their asymptotic series beyond. Each value is compared with an
integral over the relaxation spectrum, which shares nothing with the series; the script stops
where they differ by more than 1e-25 of the value. That takes a quarter of an hour.
"""

from mpmath import ceil, cos, erfc, exp, expm1, gamma, mp, mpf, pi, quad, rgamma, sin, sqrt

mp.dps = 60

# x = sqrt(t): small, moderate and large ones; 0.5 and 20 are where the code changes its formula
ROOTS = [
    1e-8, 1e-6, 1e-4, 0.01, 0.1, 0.3, 0.4, 0.49, 0.4999, 0.5, 0.5001, 0.51, 0.7, 1.0, 2.0, 3.0,
    5.0, 7.0, 9.9, 10.1, 12.0, 15.0, 18.0, 19.9, 19.999, 20.001, 20.1, 22.0, 30.0, 50.0, 100.0,
    1e3, 1e4, 1e6, 1e8,
]
EXPONENTS = [0.05, 0.25, 0.5, 0.75, 0.95]
POWER_TIMES = [1e-9, 1e-3, 1.0, 1e4]
# Exponents of the Mittag-Leffler function, down to the last digits below 1, and times over tau
ML_EXPONENTS = [
    0.01, 0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 0.999, 0.9999, 1 - 1e-8, 1 - 1e-12, 1 - 2.0**-53,
]
ML_TIMES = [
    1e-30, 1e-15, 1e-9, 1e-5, 1e-3, 0.03, 0.3, 1.0, 3.0, 10.0, 20.0, 30.0, 50.0, 100.0, 1e3, 1e6,
    1e10, 1e15, 1e30,
]
# Rates of relaxation times tau
ML_RATES = [1e-30, 1e-15, 1e-3, 0.5, 0.9, 1.0, 1.1, 2.0, 1e3, 1e15, 1e30]
# Of the value: difference of the two ways to a Mittag-Leffler function that is let pass
ML_AGREEMENT = mpf(10) ** -25


def cerf(x):
    """exp(x^2) erfc(x), by its asymptotic series where exp(x^2) overflows any precision"""
    if x < 100:
        return exp(x * x) * erfc(x)
    term = total = mpf(1)
    for n in range(1, 12):
        term *= -(2 * n - 1) / (2 * x * x)
        total += term
    return total / (x * sqrt(mp.pi))


def mittag_leffler_series(a, x):
    """E_a(-u), u E_{a,a}(-u) and E_{a,2}(-u) with u = x^a"""
    if x > 100:
        return asymptotic_series(a, x)
    digits = mp.dps
    # the terms grow to exp(x), and for a near 1 the sum falls to (1 - a)/x
    with mp.workdps(digits + int(ceil(mpf("0.44") * x)) + 40):
        u = x**a
        value, slope, mean = mpf(0), mpf(0), mpf(0)
        power, k = mpf(1), 0
        while True:
            term = power * rgamma(1 + a * k)
            value += term
            slope -= a * k * term
            mean += term / (1 + a * k)
            # the terms fall once a k exceeds x
            if a * k > x + 1 and abs(term) < mpf(10) ** (-digits - 20) * abs(value) * (1 - a):
                return value, slope, mean
            power *= -u
            k += 1


def asymptotic_series(a, x):
    """The same for x > 100, where the smallest term is about exp(-x)"""
    u = x**a
    value, slope, mean = mpf(0), mpf(0), mpf(0)
    power, k = mpf(1), 1
    while True:
        power /= -u
        value -= power * rgamma(1 - a * k)
        slope -= a * k * power * rgamma(1 - a * k)
        mean -= power * rgamma(2 - a * k)
        # size of the terms without the factor sin(pi a k) of rgamma
        size = abs(power) * gamma(1 + a * k) * (1 - a)
        if size < mpf(10) ** (-mp.dps) * min(abs(value), abs(slope)):
            return value, slope, mean
        assert a * k < x, "the asymptotic series does not reach the digits"
        k += 1


def mittag_leffler_integral(a, x):
    """The same as integrals of exp(-r x), r x exp(-r x) and (1 - exp(-r x))/(r x) over the
    spectrum. With r^a = sin(y)/sin(pi a - y) its weight is dy/(pi a), 0 < y < pi a. The functions
    are smooth between points that are denser where they or r change"""
    top, rest = pi * a, pi * (1 - a)

    def angle(r, upper):
        """y, or pi a - y, where the rate is r; mp.atan2 keeps its digits"""
        v = r ** (-a) if upper else r**a
        return mp.atan2(v * sin(rest), 1 - v * cos(rest))

    def integrands(y, upper):
        """The three functions at y, or at pi a - y"""
        v = sin(y) / sin(rest + y)
        rx = x * (1 / v if upper else v) ** (1 / a)
        if rx > 300:
            return mpf(0), mpf(0), 1 / rx
        return exp(-rx), rx * exp(-rx), -expm1(-rx) / rx

    total = [mpf(0)] * 3
    for upper in (False, True):
        points = {mpf(0), top / 2}
        scales = [mpf(10) ** k / x for k in range(-4, 2)] + [m / x for m in (3, 30, 60, 100, 300)]
        points |= {angle(r, upper) for r in scales}
        point = min(points - {mpf(0)} | {rest / 10})
        while point < top / 2:
            points.add(point)
            point *= 10
        points = sorted(point for point in points if point <= top / 2)
        for lower, higher in zip(points, points[1:]):
            width = higher - lower
            for i in range(3):
                # the tolerance of quad is an absolute one
                unit = max(integrands(lower + width * part / 4, upper)[i] for part in (1, 2, 4))
                if unit > 0:
                    total[i] += unit * width * quad(
                        lambda t, i=i: integrands(lower + width * t, upper)[i] / unit, [0, 1]
                    )
    return [part / top for part in total]


def mittag_leffler(a, x):
    """The three functions by series, after a comparison with the integrals"""
    values = mittag_leffler_series(a, x)
    with mp.workdps(32):
        for value, other in zip(values, mittag_leffler_integral(a, x)):
            assert abs(other / value - 1) < ML_AGREEMENT, (a, x, value, other)
    return values


def spectrum(a, rate):
    """Im Q at -rate + i0 for Q = p/(1 + p), p = s^a"""
    q = rate**a
    return q * sin(pi * a) / (1 + 2 * q * cos(pi * a) + q * q)


def literal(value):
    """A number as a Fortran literal"""
    text = mp.nstr(mpf(value), 17, min_fixed=0, max_fixed=0, strip_zeros=False)
    mantissa, exponent = text.split("e") if "e" in text else (text, "0")
    return f"{mantissa}e{int(exponent)}_wp"


def table(name, what, values):
    """An array as a Fortran parameter"""
    texts = [literal(value) for value in values]
    lines = [texts[i : i + 3] for i in range(0, len(texts), 3)]
    print(f"   !> {what}, shape ({len(texts)})")
    print(f"   real(wp), parameter :: {name}({len(texts)}) = [ &")
    print(", &\n".join("      " + ", ".join(line) for line in lines) + "]")


def main():
    """Print the module"""
    times = [x * x for x in ROOTS]
    roots = [sqrt(mpf(t)) for t in times]
    powers = [(mpf(a), mpf(t)) for a in EXPONENTS for t in POWER_TIMES]
    print("!> Relaxation moduli to 17 digits, made by tests/reference/make_material_values.py")
    print("module vcor_test_material_values")
    print("   use vcor_kinds, only : wp")
    print("   implicit none")
    print("   private\n")
    print("   public :: cerf_time, cerf_relaxation, cerf_rate, cerf_integral")
    print("   public :: power_exponent, power_time, power_relaxation, power_integral")
    print("   public :: ml_exponent, ml_time, ml_value, ml_slope, ml_mean, ml_rate, ml_spectrum\n")
    table("cerf_time", "Times t, with x = sqrt(t) from 1e-8 to 1e8", times)
    table("cerf_relaxation", "CERF(x)", [cerf(x) for x in roots])
    table("cerf_rate", "d CERF(sqrt(t))/dt = CERF(x) - 1/(x sqrt(pi))",
          [cerf(x) - 1 / (x * sqrt(mp.pi)) for x in roots])
    table("cerf_integral", "Integral of CERF(sqrt(t)) from 0 to t = CERF(x) - 1 + 2 x/sqrt(pi)",
          [cerf(x) - 1 + 2 * x / sqrt(mp.pi) for x in roots])
    table("power_exponent", "Exponents a of the power law t^-a/Gamma(1 - a)", [a for a, _ in powers])
    table("power_time", "Times t", [t for _, t in powers])
    table("power_relaxation", "t^-a/Gamma(1 - a)", [t**-a / gamma(1 - a) for a, t in powers])
    table("power_integral", "t^(1 - a)/Gamma(2 - a)",
          [t ** (1 - a) / gamma(2 - a) for a, t in powers])
    table("ml_exponent", "Exponents a of the Mittag-Leffler function", ML_EXPONENTS)
    table("ml_time", "Times x", ML_TIMES)
    rows = [mittag_leffler(mpf(a), mpf(x)) for a in ML_EXPONENTS for x in ML_TIMES]
    table("ml_value", "E_a(-x^a), exponent by exponent", [row[0] for row in rows])
    table("ml_slope", "-x d/dx E_a(-x^a)", [row[1] for row in rows])
    table("ml_mean", "Mean of E_a(-x^a) from 0 to x", [row[2] for row in rows])
    table("ml_rate", "Rates", ML_RATES)
    table("ml_spectrum", "Imaginary part of s^a/(1 + s^a) at minus a rate, exponent by exponent",
          [spectrum(mpf(a), mpf(r)) for a in ML_EXPONENTS for r in ML_RATES])
    print("\nend module vcor_test_material_values")


if __name__ == "__main__":
    main()
