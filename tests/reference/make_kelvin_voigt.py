"""Numbers of the Kelvin-Voigt and of Zener's elastic impact, for `test_laws`.

In units of T = (m/(k sqrt(v0)))^(2/5) and v0 T both are

    x'' + b sqrt(x) x' + x^1.5 = 0,   x(0) = 0,   x'(0) = 1,

with b = (3/2) A/T (a dashpot in the contact, A = viscosity/modulus) or b = (3/2) lambda (Zener's
plate). The first one ends at F = 0, that is x'' = 0, the second one at x = 0.

Method. With y = sqrt(x), dt = y ds and I = int x^1.5 dt the first integral
x' = g = 1 - I - (2/3) b y^3 makes it polynomial,

    dy/ds = g/2,   dI/ds = y^4,

so the Taylor series in s follows by recurrence to any order, and so do the ends: y = 0, and
y^2 + b g = 0. There the restitution is -g. Everything is analytic in b, hence e at x = 0 is a
power series in b. Its coefficients are fitted to solutions at b = 2^-n/8.

From one end to the other w = -x' obeys dw/dx = b sqrt(x) - x^1.5/w; with w = e y, x = b e xi and
p = b^(5/2) sqrt(e) that is dy/dxi = p (sqrt(xi) - xi^1.5/y), y(0) = 1. So e at F = 0 is
e Y(p), where Y is y at xi = y: a power series in p with rational coefficients, found by Picard's
iteration on truncated series.

Usage: make_kelvin_voigt.py        needs mpmath; prints, a minute
"""

from fractions import Fraction

import mpmath
from mpmath import mp, mpf

mp.dps = 50
ORDER = 44                                       # of the Taylor series in s
STEP = mpf(1)/6                                  # (STEP/radius)^ORDER < 1e-35: radius above 1.1
ENDS = 6                                         # coefficients of Y(p)
FIT = 13                                         # coefficients of the fit in b


def taylor(y, impulse, b):
    """Coefficients of y and I in s - s0."""
    y, impulse, two, three, four = [y], [impulse], [], [], []
    for n in range(ORDER):
        two.append(mpmath.fdot(y, y[::-1]))
        three.append(mpmath.fdot(two, y[::-1]))
        four.append(mpmath.fdot(two, two[::-1]))
        g = (n == 0) - impulse[n] - 2*b*three[n]/3
        y.append(g/(2*(n + 1)))
        impulse.append(four[n]/(n + 1))
    return y, impulse


def value(series, s):
    return mpmath.polyval(series[::-1], s)


def root(function):
    """Zero between 0 and STEP, by the secant method within brackets."""
    return mpmath.findroot(function, (mpf(0), STEP), solver="anderson", tol=mpf(10)**(-2*mp.dps + 8),
                           maxsteps=200)


def restitution(b):
    """Restitution at x = 0 and at F = 0."""
    b = mpf(b)
    y, impulse, at_force = mpf(0), mpf(0), None
    start = True
    while True:
        ys, impulses = taylor(y, impulse, b)

        def rate(s, ys=ys, impulses=impulses):
            return 1 - value(impulses, s) - 2*b*value(ys, s)**3/3

        def force(s, ys=ys, rate=rate):
            return value(ys, s)**2 + b*rate(s)

        y, impulse = value(ys, STEP), value(impulses, STEP)
        if at_force is None and not start and force(STEP) < 0:
            at_force = -rate(root(force))
        if y < 0:
            return -rate(root(lambda s, ys=ys: value(ys, s))), at_force
        start = False


def fitted():
    """Coefficients of b^n in the restitution at x = 0."""
    points = [mpf(2)**-n/8 for n in range(FIT)]
    matrix = mpmath.matrix(FIT, FIT)
    for i, b in enumerate(points):
        for j in range(FIT):
            matrix[i, j] = b**j
    return mpmath.lu_solve(matrix, mpmath.matrix([restitution(b)[0] for b in points]))


def between_the_ends():
    """Coefficients of p^n in Y(p), as fractions."""
    # y = sum p^n y_n(xi), y_n by twice the exponent of xi; inverse likewise
    y, inverse = [{0: Fraction(1)}], [{0: Fraction(1)}]
    for n in range(1, ENDS + 1):
        rate = {1: Fraction(1)} if n == 1 else {}
        for k, c in inverse[n - 1].items():
            rate[k + 3] = rate.get(k + 3, 0) - c
        y.append({k + 2: c/Fraction(k + 2, 2) for k, c in rate.items()})
        new = {}
        for m in range(1, n + 1):
            for i, c in y[m].items():
                for j, d in inverse[n - m].items():
                    new[i + j] = new.get(i + j, 0) - c*d
        inverse.append(new)

    def product(one, other):
        return [sum(one[j]*other[i - j] for j in range(i + 1)) for i in range(ENDS + 1)]

    def power(excess, exponent):
        """(1 + excess)^exponent as a series in p."""
        total = term = [Fraction(1)] + [Fraction(0)]*ENDS
        factor = Fraction(1)
        for k in range(1, ENDS + 1):
            term = product(term, excess)
            factor *= (exponent - k + 1)/k
            total = [a + factor*c for a, c in zip(total, term)]
        return total

    excess = [Fraction(0)]*(ENDS + 1)            # Y - 1
    for _ in range(ENDS + 1):
        new = [Fraction(0)]*(ENDS + 1)
        for n in range(1, ENDS + 1):
            for k, c in y[n].items():
                for i, d in enumerate(power(excess, Fraction(k, 2))[:ENDS + 1 - n]):
                    new[i + n] += c*d
        excess = new
    return [Fraction(1)] + excess[1:]


def main():
    c = mpf(4)/5*(mpf(5)/4)**(mpf(3)/5)*mpmath.beta(mpf(3)/5, mpf(3)/2)
    print("C", mpmath.nstr(c, 20))
    ends = between_the_ends()
    print("Y(p):", ", ".join(f"{f}" for f in ends))

    print("Zener: lambda, e; and e at F = 0 by Y(p) less the solution")
    for number in ("0.05", "0.2", "1"):
        b = mpf(number)*3/2
        at_zero, at_force = restitution(b)
        p = b**mpf("2.5")*mpmath.sqrt(at_zero)
        related = at_zero*sum(mpf(f.numerator)/f.denominator*p**n for n, f in enumerate(ends))
        print(number, mpmath.nstr(at_zero, 20), mpmath.nstr(related - at_force, 3))

    print("Kelvin-Voigt: b, e, the Pade approximant's error")
    a = 2/(3*c**2)
    for number in ("0.1", "0.25", "1", "4", "10"):
        b = mpf(number)
        e = restitution(b)[1]
        x = mpmath.sqrt(b)
        pade = (1 + a*x)/(1 + a*x + c*x**2 + a*c*x**3 + 2*c**2*x**4/5)
        print(number, mpmath.nstr(e, 20), mpmath.nstr(pade - e, 3))

    print("series of e at x = 0 in b; the second one is -C, the third one 3 C^2/5 =",
          mpmath.nstr(3*c**2/5, 20))
    for n, coefficient in enumerate(fitted()[:6]):
        print(n, mpmath.nstr(coefficient, 20))


if __name__ == "__main__":
    main()
