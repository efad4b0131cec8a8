"""Reference impacts of every plate, contact law, pair and material: practical.txt, random.txt,
designed.txt, shapes.txt and found.txt, which tests/unit/test_impacts.f90 reads.

A set is a text file of impacts, each with two remarks and the case as vcor reads it:

    ! impact NUMBER REMARK
    ! expect COR COR_SPHERE CONTACT_TIME ...     the quantities of EXPECT below, SI units
    &impact velocity = ... /
    ...

practical.txt   230 random practical impacts, made by a solver that shares nothing with vcor nor
                with the one here; --check solves them again
random.txt      random practical impacts, made here: --random COUNT
designed.txt    every plate with every law and pair, every model, tables: --designed
shapes.txt      cones, punches and profiles, and impacts with gravity: --shapes
found.txt       impacts of other random sets (--random COUNT --seed SEED) that a version of vcor
                missed, or whose error it stated too small

The solver is impact_solver.py.

Usage:  make_impacts.py [--check SET.txt] [--random COUNT [--seed SEED]] [--designed] [--shapes]
                        [--output DIR]
"""

import argparse
import math
import os
import pathlib
import random
import re

os.environ.setdefault("OMP_NUM_THREADS", "1")

import impact_solver
from impact_solver import NoSeparation, solve

HERE = pathlib.Path(__file__).parent
EXPECT = ["cor", "cor_sphere", "contact_time", "max_indentation", "max_force",
          "residual_indentation", "hysteresis_energy", "wave_energy", "initial_energy"]


# ------------------------------------------------------------------------------------ text files

def text_of(case):
    """The case as vcor reads it, a group a line."""
    def value(x):
        if isinstance(x, str):
            return f"'{x}'"
        return ", ".join(repr(float(y)) for y in (x if isinstance(x, list) else [x]))

    # a plate that is infinitely stiff at first does not move: vcor wants that said
    plate = next(m for m in case["materials"] if m["name"] == case["plate"]["material"])
    if plate["model"] == "power_law" and case["plate"]["waves"] == "constant":
        case = dict(case, plate=dict(case["plate"], waves="none"))
    groups = [("impact", {k: case[k] for k in ("velocity", "gravity") if k in case})]
    groups += [(g, case[g]) for g in ("sphere", "plate", "contact")]
    groups += [("material", {k: v for k, v in m.items() if k != "points"})
               for m in case["materials"]]
    return "".join(f"&{name} " + ", ".join(f"{k} = {value(v)}" for k, v in keys.items()) + " /\n"
                   for name, keys in groups)


def case_of(text):
    """The case that `text_of` has written."""
    case = dict(materials=[], contact={})
    for line in text.splitlines():
        name, body = re.fullmatch(r"&(\w+) (.*) /", line).groups()
        keys = {}
        for part in re.split(r", (?=\w+ = )", body):
            key, value = part.split(" = ")
            if value.startswith("'"):
                keys[key] = value.strip("'")
            else:
                numbers = [float(x) for x in value.split(",")]
                keys[key] = numbers if key in ("moduli", "times", "rates") else numbers[0]
        if name == "impact":
            case.update(keys)
        elif name == "material":
            if "file" in keys:
                keys["points"] = read_points(HERE / keys["file"])
            case["materials"].append(keys)
        else:
            case[name] = keys
    return case


def read_points(path):
    """Times and moduli of a data file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [[float(x) for x in line.split(",")] for line in lines if line[:1].isdigit()]


def read_set(path):
    """Number, text and expected quantities of each impact of a file."""
    for block in path.read_text(encoding="utf-8").split("! impact ")[1:]:
        number, numbers, text = block.split("\n", 2)
        yield int(number.split()[0]), text, dict(zip(EXPECT, map(float, numbers.split()[2:])))


def entry(number, text, outcome):
    """An impact of a set as it stands in the file."""
    numbers = " ".join(repr(float(outcome[k])) for k in EXPECT)
    return f"! impact {number}\n! expect {numbers}\n{text}"


def head(*lines):
    return "".join(f"! {line}\n" for line in lines) + "\n"


def largest(outcome, expected):
    """Largest difference: of both cor absolute, of energies over the initial one, else relative."""
    scale = dict(cor=1.0, cor_sphere=1.0, residual_indentation=outcome["max_indentation"],
                 hysteresis_energy=outcome["initial_energy"],
                 wave_energy=outcome["initial_energy"])
    return max((abs(outcome[k] - expected[k]) / scale.get(k, outcome[k]), k) for k in EXPECT)


# ------------------------------------------------------------------------------- random impacts

class Draw:
    """Random practical impacts: 0.1 to 100 mm, 0.01 to 50 m/s, 1 MPa to 3 GPa, relaxation within
    two decades of the contact time and beyond."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def log(self, a, b):
        return math.exp(self.random.uniform(math.log(a), math.log(b)))

    def material(self, name, duration, modulus):
        """A viscoelastic material that matters in a contact of this duration [s]."""
        one = self.random
        model = one.choice(["sls", "prony", "power_law", "cerf", "mittag_leffler"])
        m = dict(name=name, density=self.log(900, 1500) if one.random() < 0.8 else 1100.0,
                 poisson_ratio=one.choice([0.35, 0.4, 0.45, 0.49, 0.5]), model=model)
        tau = duration * 10 ** one.uniform(-2.2, 2.2)
        low = 10 ** one.uniform(-3.3, -0.2)
        if model == "sls":
            m.update(glassy_modulus=modulus, alpha=min(low * 3, 0.95) / tau, beta=1 / tau)
        elif model == "prony":
            n, width = one.randint(2, 8), one.choice([0.3, 1.0, 2.5])
            m.update(equilibrium_modulus=modulus * low)
            if one.random() < 0.12:
                m["viscosity"] = modulus * duration * 10 ** one.uniform(-3.5, -1)
            m.update(moduli=[modulus * one.uniform(0.05, 1) / n for _ in range(n)],
                     times=sorted(tau * 10 ** one.uniform(-width, width) for _ in range(n)))
        elif model == "power_law":
            a = one.uniform(0.05, 0.95)
            if one.random() < 0.7:
                m.update(equilibrium_modulus=modulus * low)
            m.update(coefficient=modulus * 10 ** one.uniform(-1.5, 0) * duration ** a, exponent=a)
        elif model == "cerf":
            m.update(equilibrium_modulus=modulus * low, relaxing_modulus=modulus, beta=tau ** -0.5)
        else:
            m.update(equilibrium_modulus=modulus * low, relaxing_modulus=modulus,
                     exponent=one.uniform(0.05, 0.95), time=tau)
        return m

    def case(self):
        one = self.random
        r, v, modulus = self.log(1e-4, 0.1), self.log(0.01, 50), self.log(1e6, 3e9)
        kind = one.choices(["steel", "glass", "soft", "rigid", "same", "two"],
                           [16, 23, 20, 20, 12, 12])[0]
        curved = one.choice([-3.0, 2.0, 5.0]) if one.random() < 0.09 else 0.0
        radius = 1 / (1 / r + (1 / (curved * r) if curved else 0))
        mass = 4 / 3 * math.pi * r ** 3 * 2000
        duration = 3.2 * (mass / (4 / 3 * math.sqrt(radius) * modulus * math.sqrt(v))) ** 0.4
        materials = [self.material("plate", duration, modulus)]
        if kind == "steel":
            materials.append(dict(name="ball", density=7800.0, model="elastic", modulus=210e9,
                                  poisson_ratio=0.3))
        elif kind == "glass":
            materials.append(dict(name="ball", density=2500.0, model="elastic", modulus=70e9,
                                  poisson_ratio=0.22))
        elif kind == "soft":
            materials.append(dict(name="ball", density=one.choice([1100.0, 1200.0]),
                                  model="elastic", modulus=modulus * 10 ** one.uniform(-0.5, 1.5),
                                  poisson_ratio=0.35))
        elif kind == "rigid":
            materials.append(dict(name="ball", density=one.choice([7800.0, 1100.0]),
                                  model="rigid"))
        elif kind == "two":
            materials.append(self.material("ball", duration, modulus * 10 ** one.uniform(-1, 1)))
        swap = one.random() < 0.08 and kind in ("steel", "glass", "soft", "rigid")
        waves = one.choices(["relaxing", "none", "hereditary", "constant", "frozen"],
                            [70, 45, 50, 35, 35])[0]
        law = "receding" if one.random() < 0.4 else "boltzmann"
        pair = one.choice(["eq1", "series"])
        if pair == "eq1" and kind in ("steel", "glass", "soft", "two") and any(
                "viscosity" in m for m in materials):
            pair = "series"
        plate = dict(half_thickness=max(2.5e-4, r * math.exp(one.gauss(0.8, 1.0))),
                     material="ball" if swap else "plate", waves=waves)
        if curved:
            plate["surface_radius"] = curved * r
        sphere = dict(radius=r, material="plate" if swap or kind == "same" else "ball")
        return dict(velocity=v, sphere=sphere, plate=plate, contact=dict(law=law, pair=pair),
                    materials=materials)


def random_set(count, seed, path):
    """Append random impacts until there are `count`; those that stick or end below 0.01 are
    left out."""
    draw = Draw(seed)
    number = 0
    with open(path, "w", encoding="utf-8") as file:
        file.write(head(f"Random practical impacts, made by make_impacts.py --random, seed {seed}.",
                        "Expected: " + ", ".join(EXPECT)))
        while number < count:
            case = draw.case()
            text = text_of(case)
            try:
                outcome, error = solve(case_of(text))
            except NoSeparation:
                continue
            longest = 300 * impact_solver.Impact(case).time_scale()
            if (outcome["cor"] < 0.01 or outcome["cor_sphere"] < 0
                    or outcome["contact_time"] > longest or error > 1e-6):
                continue
            number += 1
            file.write(entry(number, text, outcome))
            file.flush()
            print(number, f"cor {outcome['cor']:.6f}  two meshes {error:.1e}", flush=True)


# ----------------------------------------------------------------------------- designed impacts

PLATES = ("none", "constant", "relaxing", "frozen", "hereditary")
LAWS = ("boltzmann", "receding")

RIGID = dict(name="ball", density=7800.0, model="rigid")
STEEL = dict(name="ball", density=7800.0, poisson_ratio=0.3, model="elastic", modulus=210e9)
SOFT = dict(name="ball", density=1200.0, poisson_ratio=0.35, model="elastic", modulus=30e6)
SLS = dict(name="plate", density=1100.0, poisson_ratio=0.5, model="sls", glassy_modulus=15e6,
           alpha=300.0, beta=1200.0)
SOFT_SLS = dict(name="ball", density=1250.0, poisson_ratio=0.45, model="sls",
                glassy_modulus=8e6, alpha=360.0, beta=900.0)
PRONY = dict(name="plate", density=1100.0, poisson_ratio=0.5, model="prony",
             equilibrium_modulus=10.421e6, moduli=[20.181e6, 38.204e6, 87.344e6],
             rates=[972.0, 6426.0, 34221.0])
VISCOUS = dict(name="plate", density=1100.0, poisson_ratio=0.45, model="prony",
               equilibrium_modulus=3e6, viscosity=150.0, moduli=[6e6, 4e6], rates=[700.0, 9000.0])
VOIGT = dict(name="plate", density=1100.0, poisson_ratio=0.5, model="prony",
             equilibrium_modulus=4e6, viscosity=300.0)
POWER = dict(name="plate", density=1100.0, poisson_ratio=0.4, model="power_law",
             equilibrium_modulus=2.28e6, coefficient=8.85e5, exponent=0.35)
FLUID = dict(name="ball", density=1300.0, poisson_ratio=0.5, model="power_law",
             coefficient=3e6, exponent=0.2)
CERF = dict(name="plate", density=1100.0, poisson_ratio=0.49, model="cerf",
            equilibrium_modulus=1e6, relaxing_modulus=60e6, beta=50.0)
LEFFLER = dict(name="plate", density=1200.0, poisson_ratio=0.49, model="mittag_leffler",
               equilibrium_modulus=2e6, relaxing_modulus=40e6, exponent=0.7, time=5e-4)
LEFFLER_BALL = dict(name="ball", density=1150.0, poisson_ratio=0.4, model="mittag_leffler",
                    equilibrium_modulus=4e6, relaxing_modulus=15e6, exponent=0.3, time=2e-3)
TABLE = dict(name="plate", density=1100.0, poisson_ratio=0.5, model="table", file="table.csv")


def impact(materials, waves, law, pair="eq1", velocity=5.0, radius=0.01, half_thickness=0.01,
           **plate):
    """A sphere of the first material on a plate of the last one."""
    names = [m["name"] for m in materials]
    return dict(velocity=velocity, sphere=dict(radius=radius, material=names[0]),
                plate=dict(half_thickness=half_thickness, material=names[-1], waves=waves, **plate),
                contact=dict(law=law, pair=pair), materials=list(materials))


def designed():
    """Remark and case of each designed impact."""
    # the standard linear solid of the paper, on every plate by both laws
    for waves in PLATES:
        for law in LAWS:
            yield f"the paper's SLS, {waves}, {law}", impact(
                (RIGID, SLS), waves, law, velocity=10.0, half_thickness=0.02)
    # two bodies that deform, both pairs: an elastic one and two viscoelastic ones
    pairs = ((SOFT, CERF), (SOFT_SLS, PRONY), (SOFT, POWER), (LEFFLER_BALL, SLS), (STEEL, LEFFLER),
             (FLUID, CERF), (SOFT_SLS, LEFFLER), (FLUID, PRONY))
    number = 0
    for waves in PLATES:
        for law in LAWS:
            for pair in ("eq1", "series"):
                yield f"two bodies, {waves}, {law}, {pair}", impact(
                    pairs[number % len(pairs)], waves, law, pair, velocity=2.0)
                number += 3
    # every model under a rigid sphere
    number = 0
    for plate in (PRONY, POWER, CERF, LEFFLER, VISCOUS, VOIGT):
        for law in LAWS:
            for waves in ("hereditary", PLATES[number % 4]):
                yield f"rigid on {plate['model']}, {waves}, {law}", impact(
                    (RIGID, plate), waves, law, radius=0.005)
            number += 1
    # the sphere is the viscoelastic one; equal bodies; surfaces that are not flat
    yield "SLS on steel, receding", impact(
        (SOFT_SLS, dict(STEEL, name="plate")), "hereditary", "receding", "series")
    yield "equal bodies, receding", impact((CERF,), "relaxing", "receding")
    yield "equal bodies, hereditary", impact((LEFFLER,), "hereditary", "receding", "series")
    yield "a dashpot in one of two bodies in series", impact(
        (SOFT, VISCOUS), "hereditary", "boltzmann", "series")
    yield "the same, receding", impact((SOFT_SLS, VOIGT), "relaxing", "receding", "series")
    yield "concave, receding", impact((RIGID, PRONY), "relaxing", "receding", surface_radius=-0.03)
    yield "convex, hereditary", impact((SOFT, CERF), "hereditary", "receding", "series",
                                       surface_radius=0.02)
    # nearly elastic, and heavily damped
    yield "nearly elastic, receding", impact(
        (RIGID, dict(SLS, alpha=0.25, beta=1.0)), "relaxing", "receding", half_thickness=0.1)
    yield "nearly elastic, frozen", impact(
        (RIGID, dict(SLS, alpha=0.25, beta=1.0)), "frozen", "boltzmann", half_thickness=0.1)
    yield "elastic bodies, receding", impact(
        (STEEL, dict(STEEL, name="plate", modulus=70e9)), "hereditary", "receding", "series",
        velocity=0.5, half_thickness=0.005)
    yield "long rebound, receding", impact(
        (RIGID, dict(POWER, equilibrium_modulus=2e5)), "constant", "receding", velocity=1.0,
        half_thickness=0.006)
    # bodies in series: the paper's geometry and mass
    for waves, law in (("none", "boltzmann"), ("hereditary", "receding")):
        case = impact((dict(SOFT_SLS, poisson_ratio=0.5), SLS), waves, law, "series",
                      velocity=10.0, half_thickness=0.02)
        case["sphere"]["mass"] = 4 / 3 * math.pi * 0.01 ** 3 * 7800.0
        yield f"SLS sphere on the paper's SLS, {waves}, {law}, series", case
    # data files
    for waves, law in (("none", "boltzmann"), ("relaxing", "boltzmann"), ("constant", "receding"),
                       ("frozen", "boltzmann"), ("relaxing", "receding")):
        yield f"table, {waves}, {law}", impact((RIGID, TABLE), waves, law, velocity=3.0)
    yield "table and an elastic sphere", impact((SOFT, TABLE), "relaxing", "boltzmann")


def write_table(path):
    """Data of a solid with a broad spectrum, 6 points to the decade, six digits."""
    lines = ["# broad spectrum, made by make_impacts.py", "time [s], modulus [Pa]"]
    for i in range(37):
        t = 10 ** (-7 + i / 6)
        e = 2e6 + 8e6 / (1 + (t / 1e-3) ** 0.6) + 2e6 * math.exp(-t / 3e-4)
        lines.append(f"{t:.5e}, {e:.5e}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def weighed():
    """Remark and case of each impact with gravity."""
    gel = dict(SLS, glassy_modulus=1e5, alpha=20.0, beta=60.0)
    creeping = dict(POWER, equilibrium_modulus=2e4, coefficient=2e4, exponent=0.35)
    dashpot = dict(VOIGT, equilibrium_modulus=1e5, viscosity=100.0)
    number = 0
    for plate in (gel, creeping, dashpot, dict(CERF, equilibrium_modulus=1e4,
                                               relaxing_modulus=2e5, beta=3.0)):
        for law in LAWS:
            for waves in ("none", PLATES[1 + number % 4]):
                if plate is dashpot and waves == "frozen":
                    waves = "constant"
                case = impact((RIGID, plate), waves, law, velocity=0.4, half_thickness=0.03)
                yield f"gravity, {plate['model']}, {waves}, {law}", dict(case, gravity=9.81)
            number += 1
    yield "gravity, elastic spheres of ice in series", dict(
        impact((SOFT, LEFFLER), "none", "receding", "series", velocity=0.02), gravity=1.62)


CONE = dict(shape="cone", half_angle=65.0, mass=0.05)
PUNCH = dict(shape="punch", punch_radius=0.004, mass=0.05)
QUARTIC = dict(shape="power", profile_coefficient=2e5, profile_power=4.0, mass=0.05)
BLUNT = dict(shape="power", profile_coefficient=20.0, profile_power=1.5, mass=0.05)


def shaped():
    """Remark and case of each impact of another shape than a sphere."""
    number = 0
    for body in (CONE, PUNCH, QUARTIC, BLUNT):
        for plate in (SLS, VOIGT, POWER, LEFFLER):
            law = "boltzmann" if body is PUNCH else LAWS[(number + number // 4) % 2]
            waves = ("none", "relaxing", "hereditary", "constant", "frozen")[number % 5]
            if plate is VOIGT and waves == "frozen":
                waves = "constant"
            case = impact((RIGID, plate), waves, law, velocity=3.0, half_thickness=0.02)
            case["sphere"] = dict(body, material="ball")
            yield f"{body['shape']}, {plate['model']}, {waves}, {law}", case
            number += 1
    for body in (CONE, QUARTIC):
        case = impact((SOFT, CERF), "hereditary", "receding", "series", velocity=2.0)
        case["sphere"] = dict(body, material="ball")
        yield f"{body['shape']}, two bodies in series, hereditary, receding", case
    gel = dict(SLS, glassy_modulus=1e5, alpha=20.0, beta=60.0)
    for body in (CONE, PUNCH, BLUNT):
        case = impact((RIGID, gel), "none", "boltzmann", velocity=1.0)
        case["sphere"] = dict(body, material="ball")
        yield f"{body['shape']}, a gel, gravity", dict(case, gravity=9.81)


def designed_set(path, title, cases, only=""):
    """Solve designed impacts and write them."""
    out = head(title, "Expected: " + ", ".join(EXPECT))
    for number, (note, case) in enumerate(cases, 1):
        if only not in note:
            continue
        text = text_of(case)
        try:
            outcome, error = solve(case_of(text))
        except NoSeparation as trouble:
            print(number, note, "FAIL", trouble, flush=True)
            continue
        out += entry(f"{number} {note}", text, outcome)
        print(f"{number:4d} {note:50s} cor {outcome['cor']:.12f}  two meshes {error:.1e}  imbalance "
              f"{outcome['energy_imbalance']:.1e}", flush=True)
    if not only:
        path.write_text(out, encoding="utf-8")


# ------------------------------------------------------------------------------------------ main

def check(path):
    """Solve the impacts of a set again."""
    for number, text, expected in read_set(path):
        outcome, error = solve(case_of(text))
        difference, where = largest(outcome, expected)
        print(f"{number:5d}  cor {abs(outcome['cor'] - expected['cor']):.1e}  largest "
              f"{difference:.1e} ({where})  two meshes {error:.1e}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", type=pathlib.Path, help="solve the impacts of a set again")
    parser.add_argument("--random", type=int, default=0, help="number of random impacts to make")
    parser.add_argument("--seed", type=int, default=7, help="another seed, another set")
    parser.add_argument("--designed", action="store_true", help="make the designed set")
    parser.add_argument("--shapes", action="store_true", help="make the set of shapes and gravity")
    parser.add_argument("--output", default=HERE, type=pathlib.Path)
    options = parser.parse_args()
    if options.check:
        check(options.check)
    if options.random:
        random_set(options.random, options.seed, options.output / "random.txt")
    if options.designed:
        write_table(options.output / "table.csv")
        designed_set(options.output / "designed.txt",
                     "Designed impacts, made by make_impacts.py --designed.", designed())
    if options.shapes:
        designed_set(options.output / "shapes.txt",
                     "Other shapes than spheres, and gravity: made by make_impacts.py --shapes.",
                     [*weighed(), *shaped()])


if __name__ == "__main__":
    main()
