"""Write the numbers of docs/numbers.toml where pages show them, or say which of them are wrong.

    python docs/make_numbers.py [--check]

Needs the Python package. With --check nothing is written, and the exit code is 1 if a number is not what it should be.
"""

import math
import re
import sys
import tomllib
import warnings
from pathlib import Path

import vcor

ROOT = Path(__file__).resolve().parent.parent
NUMBER = r"[+-]?\d+(?:\.\d+)?(?:E[+-]\d+)?"


def computed(entries):
    """The value of each entry, in the order of the file."""
    found = {}
    for name, entry in entries.items():
        if "from" in entry:
            found[name] = eval(entry["from"], {"__builtins__": {}, "sqrt": math.sqrt}, dict(found))
            continue
        case = vcor.read(ROOT / entry["case"])
        for address, value in entry.get("set", {}).items():
            case[address] = value
        found[name] = case.solve({}, [entry["column"]])[entry["column"]]
    return found


def places(entry, value):
    """Each place of a number: page, what is there, what should be."""
    for page, text in entry.get("shown", []):
        before, form, after = re.fullmatch(r"(.*?)(\{.*?\})(.*)", text, re.DOTALL).groups()
        pattern = re.escape(before) + f"({NUMBER})" + re.escape(after)
        matches = re.findall(pattern, (ROOT / page).read_text("utf-8"))
        if len(matches) != 1:
            raise LookupError(f"{page} has {len(matches)} texts such as '{text}', expected one")
        yield page, f"{before}{matches[0]}{after}", before + form.format(value) + after


def main():
    """Write or check every number."""
    warnings.simplefilter("ignore", vcor.ValidityWarning)
    check = sys.argv[1:] == ["--check"]
    entries = tomllib.loads((ROOT / "docs/numbers.toml").read_text("utf-8"))
    values = computed(entries)
    wrong = 0
    for name, entry in entries.items():
        for page, shown, right in places(entry, values[name]):
            if shown == right:
                continue
            wrong += 1
            print(f"{page}: {name}: found '{shown}', expected '{right}'")
            if not check:
                path = ROOT / page
                path.write_text(path.read_text("utf-8").replace(shown, right), "utf-8")
    if check and wrong:
        sys.exit(1)


if __name__ == "__main__":
    main()
