#!/usr/bin/env python3
"""Values of relaxation moduli to 17 digits, for tests/unit/test_material.f90.

    env/bin/python make_material_values.py > ../unit/material_values.f90

needs mpmath (requirements.txt) and prints a Fortran module. The times are binary numbers, so the
values belong to exactly the times that the tests use. 60 digits are carried.
"""

from mpmath import erfc, exp, gamma, mp, mpf, sqrt

mp.dps = 60

# x = sqrt(t): small, moderate and large ones; 0.5 and 20 are where the code changes its formula
ROOTS = [
    1e-8, 1e-6, 1e-4, 0.01, 0.1, 0.3, 0.4, 0.49, 0.4999, 0.5, 0.5001, 0.51, 0.7, 1.0, 2.0, 3.0,
    5.0, 7.0, 9.9, 10.1, 12.0, 15.0, 18.0, 19.9, 19.999, 20.001, 20.1, 22.0, 30.0, 50.0, 100.0,
    1e3, 1e4, 1e6, 1e8,
]
EXPONENTS = [0.05, 0.25, 0.5, 0.75, 0.95]
POWER_TIMES = [1e-9, 1e-3, 1.0, 1e4]


def cerf(x):
    """exp(x^2) erfc(x), by its asymptotic series where exp(x^2) overflows any precision"""
    if x < 100:
        return exp(x * x) * erfc(x)
    term = total = mpf(1)
    for n in range(1, 12):
        term *= -(2 * n - 1) / (2 * x * x)
        total += term
    return total / (x * sqrt(mp.pi))


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
    print("   public :: power_exponent, power_time, power_relaxation, power_integral\n")
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
    print("\nend module vcor_test_material_values")


if __name__ == "__main__":
    main()
