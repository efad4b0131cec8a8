"""Damaged cases and data files for the program: seeded, so that each can be made again.

usage: VCOR=build/release/vcor python fuzz.py [FIRST [COUNT]]      by hand, as many as you like

Whatever the input, the program ends by itself with one of its exit codes, says no more than one
line of error, and leaves no file behind when it refuses.
"""

import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from program import FILE, INPUT, NUMERICAL, ROOT, SUCCESS, USAGE, program

# What one run may use: seconds of the processor, bytes of memory and of a file. A run that needs
# more hangs or has lost its way; how busy the machine is makes no difference
SECONDS, MEMORY, LARGEST = 120, 8 * 2**30, 2**30

CASES = sorted((ROOT / "examples").glob("**/*.nml")) + sorted((ROOT / "tests/reference/cases").glob("*.nml"))
DATA = [
    "t,E\n1e-6,9e7\n1e-5,6e7\n1e-4,3e7\n1e-3,1.5e7\n1e-2,8e6\n1e-1,6e6\n1,5.5e6\n",
    "t [ms];E [MPa]\n0,001;90\n0,01;60,5\n0,1;30\n1,0;15\n10;8\n100;6\n",
    "f, E_stor, E_loss\nHz, MPa, MPa\n0.1,24.8,8.2\n1.0,33.7,12.5\n10,48,20\n100,70,33\n1000,100,50\n1e4,140,60\n",
    "Filename\tx\nWidth\t10.05\tmm\n[step]\nAngular frequency\tStorage modulus\tLoss modulus\tTan(delta)\n"
    "rad/s\tMPa\tMPa\t\n0.1\t5\t1\t0.2\n1\t7\t2\t0.28\n10\t12\t5\t0.4\n100\t20\t9\t0.45\n1000\t40\t15\t0.37\n",
    "#X\n##Temp./°C;f/Hz;E'/MPa;E''/MPa\n23;100;9,5;3\n23;10;6;2\n23;1;4;1\n23;0,1;3;0,5\n23;0,01;2,8;0,2\n",
    "# remark [Pa]\n1e-6 9e7\n1e-5 6e7\n1e-4 3e7\n1e-3 1.5e7\n1e-2 8e6\n",
]
# What people and programs type in place of a number or a word
WORDS = [
    "0", "-1", "1e308", "1e-308", "-0.0", "nan", "Inf", "-inf", "1e400", "1d5", "1D-400", "1e5e5", "1,5", "3*1.0",
    "2*", "1000*1.0", "99999999999999999999", "-2147483649", "0x10", "1_8", "(1,2)", ".true.", "T", "''", "'", '"',
    "'a\tb'", "'é'", "\x00", "\x1b[31m", "\xff", "/", "&end", "&material", "!", ",", ",,", "=", "%", "a%b", "(1)", "(:)",
    "x" * 500, "'" + "y" * 5000 + "'", "'|touch z'", "'$(touch z)'", "'../../z'", "''''", "rubber", "steel", "'table'",
    "'receding'", "'hereditary'", "'series'", "'frozen'", "'direct'", "'adams_bashforth'", "'mittag_leffler'", "'cerf'",
    "1e-12", "1e12", "0.5", "0.49999999999", "1.0", "2", "1e-30", "1e30", "1e155", "\r", "\r\n", "\n", "\t", " ", ";",
]  # fmt: skip


def damaged(text, chance, others):
    """A text with one to six damages."""
    for _ in range(chance.choice([1, 1, 1, 2, 3, 6])):
        place = chance.randrange(len(text) + 1)
        kind = chance.randrange(9)
        words = list(re.finditer(r"[^\s=,;/&!]+", text))
        if kind == 0:
            text = text[:place] + chr(chance.randrange(256)) + text[place + chance.randrange(2) :]
        elif kind == 1:
            text = text[:place]
        elif kind == 2:
            text = text[:place] + text[place + chance.randrange(1, 60) :]
        elif kind == 3:
            end = place + chance.randrange(1, 200)
            text = text[:end] + text[place:end] + text[end:]
        elif kind == 4:
            lines = text.splitlines(keepends=True)
            chance.shuffle(lines)
            text = "".join(lines)
        elif kind == 5:
            other = chance.choice(others)
            text = text[:place] + other[chance.randrange(len(other)) :]
        elif words:
            # a word for a word is the damage that gets furthest
            word = chance.choice(words)
            text = text[: word.start()] + chance.choice(WORDS) + text[word.end() :]
    return text


def command(chance, folder):
    """A call of the program, and the files for it."""
    cases = [path.read_text(encoding="utf-8") for path in CASES]
    if chance.random() < 0.35:
        text = damaged(chance.choice(DATA), chance, DATA)
        (folder / "data.csv").write_bytes(text.encode("utf-8", "surrogateescape"))
        case = chance.choice(cases) + "&material name='table', model='table', file='data.csv', density=1e3, poisson_ratio=0.4 /\n"
        (folder / "case.nml").write_text(re.sub(r"(&plate[^/]*material *= *)'[^']*'", r"\1'table'", case), encoding="utf-8")
        return ["run", "case.nml", "--output", "out"]
    text = damaged(chance.choice(cases), chance, cases)
    (folder / "case.nml").write_bytes(text.encode("utf-8", "surrogateescape"))
    words = [chance.choice(["run", "run", "run", "check", "material"]), "case.nml"]
    if chance.random() < 0.2:
        key = chance.choice(["impact.velocity", "plate.half_thickness", "plate.waves", "contact.law", "sphere.radius", "solver.accuracy"])
        words += ["--set", f"{key}={chance.choice(WORDS)}".replace("\x00", "")]
    if words[0] != "check":
        words += ["--output", "out"]
    return words


def is_nan(text):
    """Whether it holds a nan as a word of its own."""
    return re.search(rb"\bnan\b", text, re.IGNORECASE)


def limit():
    """What the program may use."""
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST, LARGEST))


def fault_of(seed):
    """What is wrong with the answer to the damage of this number; empty where nothing is."""
    folder = Path(tempfile.mkdtemp(prefix="vcor-fuzz-"))
    try:
        words = command(random.Random(seed), folder)
        before = {path.name for path in folder.iterdir()}
        done = subprocess.run(
            [program(), *words], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, check=False, preexec_fn=limit
        )
        lines = done.stderr.decode("utf-8", "replace").splitlines()
        errors = [line for line in lines if line.startswith("vcor: error: ")]
        fault = ""
        if done.returncode not in {SUCCESS, USAGE, INPUT, FILE, NUMERICAL}:
            fault = f"exit code {done.returncode}"
        elif len(errors) != (done.returncode != SUCCESS) or any(
            not re.match("vcor: (error|warning|note): ", line) or re.search("[\0-\x1f\x7f-\x9f]", line) for line in lines
        ):
            fault = "stderr is not one line"
        elif done.returncode in {USAGE, INPUT, FILE} and len(lines) > 1:
            fault = "more than one line on refusal"
        elif done.returncode in {USAGE, INPUT, FILE} and {path.name for path in folder.iterdir()} != before:
            fault = "a file is left on refusal"
        elif (folder / "z").exists():
            fault = "a name was run"
        elif done.returncode == SUCCESS and is_nan(re.sub(rb"(?m)^  note: .*", b"", done.stdout)) and not any(
            is_nan(path.read_bytes()) for path in folder.glob("*.*")
        ):
            fault = "nan where a result is said to be"
        return f"seed {seed}: {' '.join(words)}: {fault}: {' | '.join(lines)[:300]}" if fault else ""
    finally:
        shutil.rmtree(folder)


def main():
    first, count = (int(word) for word in (sys.argv[1:] + ["1", "1000"][len(sys.argv) - 1 :]))
    faults = [fault for seed in range(first, first + count) if (fault := fault_of(seed))]
    print(*faults, sep="\n")
    print(f"{count} damaged inputs, {len(faults)} faults")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
