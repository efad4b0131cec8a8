"""Random impacts with exact mechanics: results and errors against a hundredth of the accuracy.

    python benchmarks/exact_impacts.py VCOR [--seed 1] [--count 100] [--accuracy 1e-5]

Rigid, elastic and viscoelastic strikers of four shapes on half spaces, plates, and layers that are
bonded or slide, of six kinds of material, at speeds over three decades up to 0.4 of that of shear
waves, one in five with gravity. Each line is an impact with a result that is off by more than three
stated errors, or refused.
"""

import argparse
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

COLUMNS = ("cor_sphere", "contact_time", "max_force")
OFF = 3.0


def main() -> None:
    """Solve the impacts twice and print what is off."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", help="the program vcor")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--accuracy", type=float, default=1e-5)
    options = parser.parse_args()
    off = dict.fromkeys((*COLUMNS, "refused", "without reference"), 0)
    with tempfile.TemporaryDirectory() as folder:
        for number in range(options.count):
            case = Path(folder, f"{number}.nml")
            case.write_text(make(random.Random(f"{options.seed} {number}")))
            found = solve(options.program, case, options.accuracy)
            if not found:
                off["refused"] += 1
                print(f"{number}: refused")
                continue
            expected = solve(options.program, case, 0.01 * options.accuracy)
            if not expected:
                off["without reference"] += 1
                continue
            for column in COLUMNS:
                value, error = found[column]
                distance = abs(value - expected[column][0])
                # not of a sphere that stays, which has no errors
                if distance > OFF * error:
                    off[column] += 1
                    print(f"{number}: {column} is off by {distance:.1e}, stated {error:.1e}")
    print(f"{options.count} impacts: {off}")


def solve(program: str, case: Path, accuracy: float) -> dict[str, tuple[float, float]]:
    """Results of an impact and their errors by column; empty if it is refused."""
    names = [name for column in COLUMNS for name in (column, f"{column}_error")]
    settings = ["--print", ",".join(names), "--set", f"solver.accuracy={accuracy}", "--quiet"]
    run = subprocess.run(
        [program, "run", case, *settings], capture_output=True, text=True, check=False
    )
    if run.returncode:
        return {}
    values = [float(word) for word in run.stdout.split()]
    return {column: (values[2 * i], values[2 * i + 1]) for i, column in enumerate(COLUMNS)}


def make(draw: random.Random) -> str:
    """A case file."""

    def log(low: float, high: float) -> float:
        return math.exp(draw.uniform(math.log(low), math.log(high)))

    radius = log(5e-4, 2e-2)
    shape = draw.choice(["sphere"] * 6 + ["true_sphere"] * 2 + ["cone", "power"])
    poisson_ratio = draw.choice([0.5, draw.uniform(0, 0.5), draw.uniform(0.3, 0.5), 0.49])
    modulus, density = log(3e5, 5e9), draw.uniform(900, 1300)
    velocity = math.sqrt(modulus / (2 * (1 + poisson_ratio) * density)) * log(4e-4, 0.4)
    mass = log(1000, 9000) * 4 / 3 * math.pi * radius**3
    # about the contact time, which rates are compared with
    time = (mass * (1 - poisson_ratio**2) / (4 / 3 * modulus * math.sqrt(radius * velocity))) ** 0.4
    layer = draw.choice(["", "", *[f", thickness={radius * log(0.2, 20)}"] * 5])
    if layer:
        layer += draw.choice(["", ", base='bonded'", ", base='sliding'"])
    if shape == "cone":
        body = f"shape='cone', half_angle={draw.uniform(45, 80)}"
    elif shape == "power":
        power = draw.uniform(1.4, 4)
        coefficient = 0.5 * radius ** (1 - power) * log(0.5, 2)
        body = f"shape='power', profile_power={power}, profile_coefficient={coefficient}"
    else:
        body = f"shape='{shape}', radius={radius}"
    exponent = draw.uniform(0.1, 0.6)
    rest = modulus * draw.uniform(0.05, 0.6)
    materials = [
        f"model='elastic', modulus={modulus}",
        f"model='sls', glassy_modulus={modulus}, alpha={log(0.01, 1) / time},"
        f" beta={log(1, 10) / time}",
        f"model='prony', equilibrium_modulus={rest}, moduli={modulus * log(0.1, 1)},"
        f" {modulus * log(0.1, 1)}, rates={log(0.05, 2) / time}, {log(2, 20) / time}",
        f"model='power_law', equilibrium_modulus={rest}, exponent={exponent},"
        f" coefficient={modulus * draw.uniform(0.1, 0.6) * time**exponent}",
        f"model='prony', equilibrium_modulus={modulus},"
        f" viscosity={modulus * time * log(0.02, 0.5)}",
        f"model='cerf', equilibrium_modulus={rest}, relaxing_modulus={modulus * log(0.2, 1)},"
        f" beta={log(0.1, 3) / math.sqrt(time)}",
    ]
    soft = modulus * log(0.2, 50)
    strikers = [
        "model='rigid'",
        f"model='elastic', modulus={soft}, poisson_ratio={draw.uniform(0.1, 0.4)}",
        f"model='sls', glassy_modulus={modulus * log(0.3, 5)}, alpha={log(0.1, 0.35) / time},"
        f" beta={1 / time}, poisson_ratio={draw.uniform(0.2, 0.5)}",
    ]
    plate, striker = draw.choice(materials), draw.choice(strikers)
    gravity = draw.choice(["", "", "", "", " gravity=9.80665"])
    return f"""&impact velocity={velocity}{gravity} /
&sphere material='striker', {body}, mass={mass} /
&plate material='plate', waves='body'{layer} /
&contact mechanics='exact' /
&material name='striker', {striker} /
&material name='plate', density={density}, poisson_ratio={poisson_ratio}, {plate} /
"""


if __name__ == "__main__":
    sys.exit(main())
