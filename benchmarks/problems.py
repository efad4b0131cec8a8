#!/usr/bin/env python3
"""The impacts of the comparison as general-purpose ODE solvers get them.

    problems.py FOLDER        writes FOLDER/NAME.txt for every problem, and NAME_modes.nml where
                              the sum of exponentials is an approximation

Read from the case files of examples/paper, a rigid sphere on a relaxing plate, and made
dimensionless: time by T, lengths by v0 T, impulses by m v0. With sigma = s/(v0 T), i = I/(m v0),
j = J/(m v0 T) and v = sigma^1.5 the impact is the explicit ODE

    i' = f,  j' = i,  q_k' = r_k (v - q_k),    f = g0 v + sum_k g_k (v - q_k)
    sigma = tau - j - a(tau) i,  a(tau) = A/sqrt(g(tau)),   cor = i (1 + a') - 1 where f = 0

with the kernel g(tau) = g0 + sum_k g_k exp(-r_k tau). The fractional kernels become such a sum by
the trapezoidal rule in ln r over their spectrum; a(tau) keeps their closed form.

Standard library only. Layout of a file: name; reference value of cor; A; law of a (sum, cerf,
power) and its three parameters; g0 and the number of modes; r_k and g_k, a line per mode.
"""

import csv
import math
import pathlib
import re
import sys
from dataclasses import dataclass

TOP = pathlib.Path(__file__).resolve().parent.parent

# Spacing in ln(rate), lowest and highest rate [1/s] of the sums: 37 modes with an error of cor of
# 2e-10. Fewer modes by the same rule lose digits at once: 34 have 2e-9, 28 have 6e-7
SPACING = 0.45
LOWEST, HIGHEST = 2.0, 1.0e7

# Case file in examples/paper, row of the reference values
NAMES = {
    "sls": "sls_v10",
    "butyl_prony": "butyl_prony_v10",
    "butyl_cerf": "butyl_cerf_v10",
    "butyl_power_law": "butyl_power_law_v10",
}


@dataclass
class Problem:
    """An impact in dimensionless form."""

    name: str
    reference: float
    plate: float  # A
    law: str  # of g in a(tau): sum, cerf, power
    parameters: tuple  # g0, g1 and the rate or exponent of the closed form; zeros for a sum
    constant: float  # g0
    rates: list  # r_k
    moduli: list  # g_k

    def text(self):
        """The file that the CVODE program reads."""
        head = [
            self.name,
            f"{self.reference:.16e}",
            f"{self.plate:.16e}",
            self.law + "".join(f" {value:.16e}" for value in self.parameters),
            f"{self.constant:.16e} {len(self.rates)}",
        ]
        modes = [f"{r:.16e} {g:.16e}" for r, g in zip(self.rates, self.moduli)]
        return "\n".join(head + modes) + "\n"


def read_case(name):
    """Groups of a case file: {group: {key: text}}, materials under their names."""
    text = (TOP / "examples" / "paper" / f"{name}.nml").read_text()
    groups = {}
    for group, body in re.findall(r"^&(\w+)\n(.*?)^/", text, re.M | re.S):
        keys = {}
        for line in body.splitlines():
            key, equals, value = line.split("!")[0].partition("=")
            if equals:
                keys[key.strip()] = value.strip().strip("'")
        groups[keys["name"] if group == "material" else group] = keys
    return groups


def numbers(text):
    """A list of numbers as namelists have it."""
    return [float(word) for word in text.replace(",", " ").split()]


def references():
    """The reference values of cor by row."""
    with open(TOP / "tests" / "reference" / "reference.csv", newline="") as file:
        return {row["name"]: float(row["cor"]) for row in csv.DictReader(file)}


def modes_of(spectrum, low=LOWEST, high=HIGHEST, spacing=SPACING):
    """Rates and moduli of a spectrum per unit of ln(rate): trapezoidal rule between two rates.

    What the rule has above them becomes one mode with the same sums of g/r and g/r^2, what it has
    below one with the same sums of g and g r: there is no dashpot, so the ODE stays explicit.
    """
    count = round(math.log(high / low) / spacing)
    rates = [low * math.exp(spacing * i) for i in range(count + 1)]
    moduli = [spacing * spectrum(r) for r in rates]
    above = [rates[-1] * math.exp(spacing * i) for i in range(1, 400)]
    first = sum(spacing * spectrum(r) / r for r in above)
    second = sum(spacing * spectrum(r) / r**2 for r in above)
    below = [rates[0] * math.exp(-spacing * i) for i in range(1, 400)]
    weight = sum(spacing * spectrum(r) for r in below)
    moment = sum(spacing * spectrum(r) * r for r in below)
    return (
        [moment / weight, *rates, first / second],
        [weight, *moduli, first**2 / second],
    )


def material_of(keys):
    """Equilibrium modulus, rates, moduli, law and relaxation modulus as a function."""
    model = keys["model"]
    if model == "sls":
        glassy, alpha, beta = (float(keys[k]) for k in ("glassy_modulus", "alpha", "beta"))
        rubbery = glassy * alpha / beta
        rates, moduli, law, closed = [beta], [glassy - rubbery], "sum", None
    else:
        rubbery = float(keys["equilibrium_modulus"])
    if model == "prony":
        rates, moduli, law = numbers(keys["rates"]), numbers(keys["moduli"]), "sum"
        closed = None
    elif model == "cerf":
        e, b = float(keys["relaxing_modulus"]), float(keys["beta"])
        # H = Im Q(-r + i0)/(pi r) of Q = E_0 + E_1 sqrt(p)/(sqrt(p) + b), times r for d ln(r)
        rates, moduli = modes_of(lambda r: e * b * math.sqrt(r) / (math.pi * (r + b * b)))
        law, closed = "cerf", (rubbery, e, b)
    elif model == "power_law":
        c, a = float(keys["coefficient"]), float(keys["exponent"])
        rates, moduli = modes_of(lambda r: c * math.sin(math.pi * a) / math.pi * r**a)
        law, closed = "power", (rubbery, c / math.gamma(1.0 - a), a)
    return rubbery, rates, moduli, law, closed


def build(name):
    """The problem of a case of examples/paper, and its material as a Prony series in SI units."""
    case = read_case(name)
    sphere, plate = case[case["sphere"]["material"]], case[case["plate"]["material"]]
    velocity, radius = float(case["impact"]["velocity"]), float(case["sphere"]["radius"])
    mass = 4.0 / 3.0 * math.pi * radius**3 * float(sphere["density"])
    factor = 1.0 - float(plate["poisson_ratio"]) ** 2
    density, half = float(plate["density"]), float(case["plate"]["half_thickness"])
    rubbery, rates, moduli, law, closed = material_of(plate)

    # time scale: that of an elastic impact with the modulus at 0.3 ms, the middle of the contacts
    modulus = rubbery + sum(e * math.exp(-r * 3.0e-4) for e, r in zip(moduli, rates))
    hertz = 4.0 / 3.0 * math.sqrt(radius) / factor
    scale = (mass / (hertz * modulus * math.sqrt(velocity))) ** 0.4
    unit = hertz * math.sqrt(velocity) * scale**2.5 / mass
    alpha = math.sqrt(3.0 * density * factor) / (16.0 * density * half**2)

    parameters = (0.0, 0.0, 0.0)
    if law == "cerf":
        parameters = (unit * closed[0], unit * closed[1], closed[2] * math.sqrt(scale))
    elif law == "power":
        parameters = (unit * closed[0], unit * closed[1] * scale ** -closed[2], closed[2])
    problem = Problem(
        name,
        references()[NAMES[name]],
        alpha * mass / scale * math.sqrt(unit),
        law,
        parameters,
        unit * rubbery,
        [r * scale for r in rates],
        [e * unit for e in moduli],
    )
    return problem, rubbery, rates, moduli


def prony_case(name, rubbery, rates, moduli):
    """The case file with the material replaced by its sum of exponentials."""
    text = (TOP / "examples" / "paper" / f"{name}.nml").read_text()
    head, _, tail = text.rpartition("   model ")
    kept = [line for line in tail.splitlines() if re.match(r"\s*(density|poisson_ratio)\s*=", line)]
    lines = ["   model   = 'prony'", *kept, f"   equilibrium_modulus = {rubbery:.16e}"]
    for key, values in (("moduli", moduli), ("rates", rates)):
        lines.append(f"   {key} =")
        lines += [f"      {value:.16e}" for value in values]
    return head + "\n".join(lines) + "\n/\n"


def main():
    """Write the files."""
    if len(sys.argv) != 2:
        sys.exit("usage: problems.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in NAMES:
        problem, *series = build(name)
        (folder / f"{name}.txt").write_text(problem.text())
        if problem.law != "sum":
            (folder / f"{name}_modes.nml").write_text(prony_case(name, *series))


if __name__ == "__main__":
    main()
