"""Damaged input of the package: cases, tables, data, cards, JSON and HDF5, seeded.

    VCOR=build/release/vcor VCOR_LIBRARY=build/release/libvcor_python.so PYTHONPATH=python/src \\
       python python/tests/fuzz_package.py [FIRST [COUNT]]

Whatever the input: an error of vcor in one line, or a result in which what was not damaged is as
it was. tests/cli/fuzz.py does the same with the program.
"""

import contextlib
import copy
import faulthandler
import functools
import io
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import vcor
from vcor.exchange.card_formats import FORMATS, UNITS, Card
from vcor.material_files import IMPACT
from vcor.materials.data import read_data
from vcor.materials.observations import observations

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))

from fuzz import CASES, DATA, WORDS, damaged  # noqa: E402

#: Seconds after which one input is said to hang
PATIENCE = 60
#: A number as Fortran and data files have it
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([EeDd][-+]?\d+)?")
TEXTS = [path.read_text(encoding="utf-8") for path in CASES]
SLS = (ROOT / "examples/paper/sls.nml").read_text(encoding="utf-8")


def ensure(holds, what):
    """Raise what is wrong."""
    if not holds:
        raise AssertionError(what)


def write(path, text):
    """Write a text with whatever characters."""
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    return path


def number(word):
    """Value of a word for a number."""
    return float(re.sub("[dD]", "e", word.replace(",", ".")))


def case_text(chance, _):
    """A damaged case: its completed text is the same case."""
    text = vcor.Case(damaged(chance.choice(TEXTS), chance, TEXTS).replace("\0", "")).text()
    ensure(vcor.Case(text).text() == text, "the completed text is another case")


def case_number(chance, _):
    """One number of a case replaced by a word: it is that number, or refused."""
    text = chance.choice(TEXTS)
    key, address = chance.choice([("velocity", "impact.velocity"), ("radius", "sphere.radius")])
    places = list(re.finditer(rf"(?m)^\s*{key}\s*=\s*([0-9.eE+-]+)\s*(?=$|!)", text))
    if len(places) != 1:
        return
    word = chance.choice(WORDS).replace("\0", "")
    case = vcor.Case(text[: places[0].start(1)] + word + text[places[0].end(1) :])
    word = word.strip(" \t\r\n,;")
    ensure(NUMBER.fullmatch(word), f"{word!r} is taken for a number")
    ensure(case[address] == number(word), f"{word!r} is taken for another number")


def addresses(chance, _):
    """A word at an address: what is refused changes nothing, what is not changes one key."""
    case = vcor.Case(chance.choice(TEXTS))
    before = case.text()
    known = ["impact.velocity", "sphere.radius", "solver.accuracy", "plate.waves", "rubber.beta"]
    address, word = chance.choice([*known, *WORDS]), chance.choice(WORDS)
    if chance.random() < 0.3:
        address = damaged(address, chance, known)
    try:
        case[address] = word
    except vcor.Error:
        ensure(case.text() == before, "a refused value changes the case")
        raise
    text = case.text()
    ensure(vcor.Case(text).text() == text, "the completed text is another case")
    ensure(len(set(text.splitlines()) - set(before.splitlines())) <= 3, "other keys are changed")


def data_text(chance, folder):
    """Damaged data: columns of numbers, and a line that says which."""
    found = read_data(write(folder / "data.csv", damaged(chance.choice(DATA), chance, DATA)))
    ensure(found.attrs["taken"] and "\n" not in found.attrs["taken"], "what is taken is no line")
    ensure(all(found[key].dtype.kind in "fi" for key in found), "a column is no numbers")


def data_cell(chance, folder):
    """A cell of data replaced by a word: the other rows are read as they were, or it is refused."""
    text = chance.choice(DATA)
    path = write(folder / "data.csv", text)
    before, lines = read_data(path), text.splitlines()
    row = chance.choice(list(before.index))
    separate = r"[^;\t]+" if ";" in text or "\t" in text else r"[^\s,]+"
    cell = chance.choice(list(re.finditer(separate, lines[row - 1])))
    word = chance.choice(WORDS)
    lines[row - 1] = lines[row - 1][: cell.start()] + word + lines[row - 1][cell.end() :]
    after = read_data(write(path, "\n".join(lines) + "\n"))
    ensure(set(after) == set(before), "other columns are read")
    for line in set(before.index) - {row}:
        # a word may have ends of lines
        there = [i for i in range(line, line + 1 + 3 * (line > row)) if i in after.index]
        same = [np.allclose(after.loc[i], before.loc[line], 1e-12, equal_nan=True) for i in there]
        ensure(any(same), f"line {line} has other numbers")
    if row in after.index and NUMBER.fullmatch(word):
        at, was = (one.loc[row].drop("temperature", errors="ignore") for one in (after, before))
        ratios = (at / was).to_numpy()
        changed = ratios[np.abs(ratios - 1) > 1e-12]
        if len(changed) == 1:
            said = changed[0] * number(cell[0])
            ensure(math.isclose(said, number(word), rel_tol=1e-12), f"{word!r} is read as {said!r}")


IMPACTS = [
    "velocity [m/s],cor,contact_time [ms]\n1,0.62,1.1\n2,0.60,1.0\n3,0.59,0.95\n5,0.57,0.9\n",
    "drop height (cm)\trebound height (cm)\n20\t9\n40\t17\n60\t25\n80\t33\n",
    "Event time (s),Interval (s)\n0.5,0.61\n1.11,0.45\n1.56,0.33\n1.89,0.25\n",
    "time [ms];force [N]\n0;0\n0,1;12\n0,2;25\n0,3;33\n0,4;36\n0,5;32\n0,6;22\n0,7;9\n0,8;0\n",
    "velocity,cor,cor_sigma,temperature [C]\n1,0.62,0.01,20\n2,0.60,0.01,20\n3,0.59,0.01,40\n",
]


def impacts(chance, folder):
    """Damaged tables of impacts and records, as identify reads them: finite data."""
    path = write(folder / "data.csv", damaged(chance.choice(IMPACTS), chance, IMPACTS))
    for block in observations(vcor.Case(SLS), path, ["rubber.beta"]):
        ensure(np.isfinite(block.value).all() and block.taken, "a datum is no number")


TABLE = "time [s],relaxation_modulus [Pa]\n1e-6,9e7\n1e-5,6e7\n1e-4,3e7\n1e-3,1.5e7\n1e-2,8e6\n"
SHIFT = "temperature [K],log10_shift_factor [1]\n273.15,2.5\n283.15,1.1\n293.15,0\n303.15,-0.9\n"
TABLE_CASE = """&impact velocity = 2, temperature = 293.15 /
&sphere radius = 0.01, material = 'steel' /
&plate half_thickness = 0.02, material = 'rubber', waves = 'none' /
&material name = 'steel', model = 'rigid', density = 7800 /
&material name = 'rubber', model = 'table', file = '{0}/t.csv', density = 1100,
   poisson_ratio = 0.4, shift = 'table', shift_file = '{0}/s.csv', reference_temperature = 293.15 /
"""


def plain_table(chance, folder):
    """A damaged table of a material or of its shift: a modulus > 0 that falls, a factor > 0."""
    texts = [TABLE, SHIFT]
    which = chance.randrange(2)
    texts[which] = damaged(texts[which], chance, [*DATA, TABLE, SHIFT])
    for name, text in zip(("t.csv", "s.csv"), texts, strict=True):
        write(folder / name, text)
    material = vcor.Case(TABLE_CASE.format(folder)).material("rubber")
    found = material.relaxation(np.geomspace(1e-7, 1, 50))
    ensure(np.isfinite(found).all() and (found > 0).all(), "a modulus is not positive")
    ensure((np.diff(found) <= 1e-9 * found[:-1]).all(), "a modulus rises")
    ensure(0 < material.time_factor() < math.inf, "a shift factor is not positive")


def card(chance, folder):
    """A damaged card: a material that the case then has."""
    code = chance.choice(list(FORMATS))
    form = FORMATS[code]
    n = min(2, form.terms)
    shift = {"shift": "wlf", "reference_temperature": 293.15, "wlf_c1": 8.86, "wlf_c2": 101.6}
    shift = shift if "wlf" in form.shifts else {}
    made = Card("rubber", 0.49, 1e6, (2e6, 3e6)[:n], (1e-3, 0.1)[:n], 1100.0, shift)
    text = made.text(code, chance.choice(list(UNITS)))
    path = write(folder / "some.card", damaged(text, chance, [text]))
    found = vcor.read_card(path, code=code if chance.random() < 0.5 else None)
    case = vcor.Case(IMPACT.format(found.name.replace("'", "''")) + str(found))
    glassy = found.equilibrium_modulus + sum(found.moduli)
    ensure(math.isclose(case.material(found.name).relaxation(0.0), glassy, rel_tol=1e-9),
           "the group is another material")  # fmt: skip


FIT = {
    "vcor": "1", "name": "rubber", "model": "sls",
    "parameters": [
        {"name": "glassy_modulus", "value": 1.5e7, "standard_error": 3e5, "unit": "Pa"},
        {"name": "alpha", "value": 300.0, "standard_error": 6.0, "unit": "1/s"},
        {"name": "beta", "value": 1200.0, "standard_error": 30.0, "unit": "1/s"},
    ],
    "covariance": [[9e10, 0.0, 0.0], [0.0, 36.0, 20.0], [0.0, 20.0, 900.0]],
    "group": "&material\n   name = 'rubber'\n   model = 'sls'\n   glassy_modulus = 1.5e7\n"
    "   alpha = 300\n   beta = 1200\n/",
}  # fmt: skip
VALUES = [0, -1, 1e308, 1e-308, None, True, "x", "nan", [], [1], {}, {"a": 1}, 10**400, "rubber",
          "\0", "é" * 99, 1e5]  # fmt: skip


def places_of(document, path=()):
    """All places of a JSON document, as keys."""
    yield path
    rows = document.items() if isinstance(document, dict) else []
    for key, value in enumerate(document) if isinstance(document, list) else rows:
        yield from places_of(value, (*path, key))


def fitted(chance, folder):
    """A damaged JSON of a fit: a deviation that is a number, or refused."""
    document, text = copy.deepcopy(FIT), damaged(json.dumps(FIT), chance, [json.dumps(FIT)])
    if chance.random() < 0.7:
        for _ in range(chance.choice([1, 1, 2, 4])):
            *way, last = chance.choice(list(places_of(document))[1:])
            holder = functools.reduce(lambda one, key: one[key], way, document)
            if chance.random() < 0.3:
                del holder[last]
            else:
                holder[last] = chance.choice(VALUES)
            if len(list(places_of(document))) == 1:
                break
        text = json.dumps(document)
    path = write(folder / "fit.json", text)
    found = vcor.propagate(vcor.Case(SLS), covariance=path, samples=2, quantities=["cor"])
    said = float(found.table["material"].sel(quantity="cor"))
    ensure(math.isfinite(said) and said >= 0, "a deviation is no number")


@functools.cache
def sweep():
    """Bytes of results, and what they hold."""
    with tempfile.TemporaryDirectory() as folder:
        case = ROOT / "examples" / "sweeps" / "sls_velocity.nml"
        words = [os.environ["VCOR"], "run", case, "--quiet", "--set", "output.stem=s"]
        subprocess.run(words, cwd=folder, check=True)
        path = Path(folder) / "s.h5"
        return path.read_bytes(), vcor.open(path)


def hdf5(chance, folder):
    """Damaged bytes of results: the numbers that were written, or refused."""
    whole, wanted = sweep()
    data = bytearray(whole)
    for _ in range(chance.choice((1, 1, 3, 20))):
        data[chance.randrange(len(data))] = chance.choice((0, 1, 127, 255, chance.randrange(256)))
    path = folder / "d.h5"
    path.write_bytes(data[: len(data) if chance.random() < 0.9 else chance.randrange(len(data))])
    found = vcor.open(path)
    for name in set(found.variables) & set(wanted.variables):
        one, other = found[name].values, wanted[name].values
        if one.dtype == other.dtype == np.float64 and one.shape == other.shape:
            ensure(np.array_equal(one, other, equal_nan=True), f"other numbers of {name}")


KINDS = (case_text, case_number, addresses, data_text, data_cell, impacts, plain_table, card,
         fitted, hdf5)  # fmt: skip


def fault_of(seed):
    """What is wrong with the answer to the damage of this number; empty where nothing is."""
    kind = KINDS[seed % len(KINDS)]
    with tempfile.TemporaryDirectory(prefix="vcor-fuzz-") as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            kind(random.Random(seed), Path(folder))
        except vcor.Error as error:
            if error.code not in (2, 3, 4, 5) or not str(error).isprintable():
                return f"seed {seed}: {kind.__name__}: code {error.code}, {str(error)!r:.300}"
        except Exception as error:  # noqa: BLE001
            return f"seed {seed}: {kind.__name__}: {type(error).__name__}: {error}"
    return ""


def main():
    """Print the faults of many."""
    first, count = (int(word) for word in (sys.argv[1:] + ["1", "1000"][len(sys.argv) - 1 :]))
    faults = 0
    for seed in range(first, first + count):
        faulthandler.dump_traceback_later(PATIENCE, exit=True)
        with contextlib.redirect_stderr(io.StringIO()):
            fault = fault_of(seed)
        if fault:
            print(fault, flush=True)
            faults += 1
    print(f"{count} damaged inputs, {faults} faults")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
