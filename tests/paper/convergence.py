"""How the schemes approach the converged solution when the step is refined."""

import itertools
import math
from dataclasses import dataclass

from printed import cor

# Steps [us], each half of the one before
STEPS = [8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125]
PRONY_STEPS = [1.0, 0.5, 0.25, 0.125]
# Steps for the singular kernel [us]: explicit marching is not stable with larger ones
SINGULAR_STEPS = [0.8, 0.4, 0.2, 0.1, 0.05]

RECTANGLE = "solver.method=direct solver.scheme=adams_bashforth solver.quadrature=rectangle"
TRAPEZOID = "solver.method=direct solver.scheme=adams_bashforth solver.quadrature=trapezoid"
PRODUCT = "solver.method=direct solver.scheme=product"

SLS_CONVERGED = "sls.nml solver.method=ive solver.accuracy=1e-10"
PRONY_CONVERGED = "butyl_prony.nml solver.method=ive solver.accuracy=1e-10"
POWER_LAW_CONVERGED = "butyl_power_law.nml solver.method=direct solver.accuracy=3e-10"

# Errors below say nothing: those of the converged values, and of explicit marching, which divides
# differences of rounded numbers by the square of the step
FLOOR, MARCHING_FLOOR = 1e-9, 2e-8


@dataclass(frozen=True)
class Series:
    """COR of one impact by one scheme, against the step."""

    name: str
    settings: str
    case: str
    steps: tuple
    converged: str
    floor: float = FLOOR

    def values(self):
        """COR at each step."""
        return [cor(f"{self.case} {self.settings} solver.time_step={dt}e-6") for dt in self.steps]

    def errors(self):
        """COR at each step less the converged one."""
        return [value - cor(self.converged) for value in self.values()]

    def orders(self):
        """Measured order from each step to the next one, as long as the errors say something."""
        errors = [abs(error) for error in self.errors()]
        pairs = itertools.pairwise(errors)
        return [math.log2(a / b) for a, b in pairs if min(a, b) > self.floor]

    def extrapolated(self, *orders):
        """COR at step zero from the last steps, for errors that go with these powers of it."""
        values = self.values()[-len(orders) - 1 :]
        for order in orders:
            pairs = itertools.pairwise(values)
            values = [fine + (fine - coarse) / (2**order - 1) for coarse, fine in pairs]
        return values[0]


def sls(name, settings, floor=FLOOR):
    return Series(name, settings, "sls.nml", tuple(STEPS), SLS_CONVERGED, floor)


def prony(name, settings):
    steps = tuple(PRONY_STEPS)
    return Series(name, settings, "butyl_prony.nml", steps, PRONY_CONVERGED, MARCHING_FLOOR)


def power_law(name, settings):
    steps = tuple(SINGULAR_STEPS)
    return Series(name, settings, "butyl_power_law.nml", steps, POWER_LAW_CONVERGED)


SLS_RECTANGLE = sls("SLS, rectangle sums", RECTANGLE, MARCHING_FLOOR)
SLS_TRAPEZOID = sls("SLS, trapezoidal sums", TRAPEZOID, MARCHING_FLOOR)
SLS_PRODUCT = sls("SLS, product integration", PRODUCT)
PRONY_RECTANGLE = prony("BUTYL (26), rectangle sums, form a", RECTANGLE)
PRONY_A = prony("BUTYL (26), trapezoidal sums, form a", TRAPEZOID)
PRONY_B = prony("BUTYL (26), trapezoidal sums, form b", TRAPEZOID + " solver.form=b")
CAPPED = power_law("BUTYL (23-b), rectangle sums, capped", RECTANGLE)
SINGULAR = power_law("BUTYL (23-b), product integration", PRODUCT)
# Those of the figure
ALL = [SLS_RECTANGLE, SLS_TRAPEZOID, SLS_PRODUCT, CAPPED, SINGULAR]
