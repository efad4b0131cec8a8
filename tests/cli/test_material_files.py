"""Cases completed by files of materials."""

import re

import h5py
import pytest
from program import INPUT, MATERIALS, PAPER, USAGE

BODIES = """&impact velocity = 5 /
&sphere radius = 0.01, material = 'steel' /
&plate material = 'rubber', half_thickness = 0.02 /
"""
STEEL = "&material name = 'steel', model = 'rigid', density = 7800 /\n"
RUBBER = """&material name = 'rubber', model = 'sls', density = 1100, poisson_ratio = 0.4,
   glassy_modulus = 15e6, alpha = 300, beta = 1200 /
"""
TABLE = """&material name = 'rubber', model = 'table', density = 1100, poisson_ratio = 0.4,
   file = 'points.csv' /
&solver method = 'direct' /
"""
POINTS = "t [s],E [Pa]\n1e-6,2e7\n1e-4,1e7\n1e-2,4e6\n"


@pytest.fixture
def whole(vcor):
    """A case in one file."""
    vcor.write(BODIES + STEEL + RUBBER, "whole.nml")
    return vcor.numbers("whole.nml")


@pytest.mark.parametrize(
    "files",
    [
        (BODIES, STEEL + RUBBER),
        (BODIES + STEEL, RUBBER),
        (BODIES + RUBBER, STEEL),
        (BODIES, RUBBER, STEEL),
    ],
)
def test_completed(vcor, whole, files):
    """However the groups are spread, the numbers are those of one file."""
    names = [vcor.write(text, f"{i}.nml") for i, text in enumerate(files)]
    assert vcor.numbers(*names) == whole
    assert vcor.numbers(*names, "--set", "rubber.beta=1200") == whole


def test_every_command(vcor, whole):
    vcor.write(BODIES, "part/whole.nml")
    vcor.write(STEEL + RUBBER, "m.nml")
    for command in ("check", "material", "verify"):
        one = vcor.succeeds(command, "part/whole.nml", "m.nml")
        assert one.replace("part/whole.nml", "whole.nml") == vcor.succeeds(command, "whole.nml")


def test_several_cases(vcor, whole):
    """A file of materials completes all cases before it, and none behind it."""
    vcor.write(BODIES + STEEL, "a.nml")
    vcor.write(BODIES.replace("5", "2") + STEEL, "b.nml")
    vcor.write(RUBBER, "m.nml")
    rows = vcor.succeeds("run", "a.nml", "b.nml", "m.nml", "--print", "cor", "--quiet").splitlines()
    assert rows[0] == whole["cor"] != rows[1]
    vcor.refuses("run", "a.nml", "m.nml", "b.nml", code=INPUT, says=["'rubber'"], at="b.nml:3")
    vcor.refuses("run", "m.nml", "a.nml", code=USAGE, says=["before it"], at="m.nml")
    vcor.refuses("run", "m.nml", code=INPUT, says=["&impact"], at="m.nml")


def test_a_name_twice(vcor):
    vcor.write(BODIES + STEEL + RUBBER, "a.nml")
    vcor.write("\n" + RUBBER, "m.nml")
    vcor.refuses(
        "run", "a.nml", "m.nml", code=INPUT, says=["two materials", "'rubber'", "a.nml:5"], at="m.nml:2"
    )


def test_mistakes_name_their_file(vcor):
    vcor.write(BODIES + STEEL, "a.nml")
    vcor.write("\n" + RUBBER.replace("300", "-300"), "m.nml")
    vcor.refuses("run", "a.nml", "m.nml", code=INPUT, says=["alpha"], at="m.nml:3")
    vcor.write(RUBBER.replace("alpha", "alhpa"), "m.nml")
    vcor.refuses("run", "a.nml", "m.nml", code=INPUT, says=["alhpa"], at="m.nml:2")
    vcor.write(RUBBER.replace("300", "3000"), "m.nml")
    vcor.refuses("run", "a.nml", "m.nml", code=INPUT, says=["alpha", "'rubber'"], at="m.nml:2")


def test_sweeps_and_lists(vcor):
    """What a sweep varies may stand in another file."""
    prony = RUBBER.replace("'sls'", "'prony'").replace(
        "glassy_modulus = 15e6, alpha = 300, beta = 1200",
        "equilibrium_modulus = 4e6, moduli = 6e6, 9e6, times = 2e-4, 3e-3",
    )
    vcor.write(BODIES + "&sweep parameter = 'rubber.moduli(2)', values = 5e6, 9e6 /\n", "a.nml")
    vcor.write(STEEL + prony, "m.nml")
    rows = vcor.succeeds("run", "a.nml", "m.nml", "--print", "cor", "--quiet").splitlines()
    vcor.write(BODIES, "b.nml")
    for value, row in zip((5e6, 9e6), rows, strict=True):
        single = vcor.numbers("b.nml", "m.nml", "--set", f"rubber.moduli(2)={value}")
        assert row.split()[-1] == single["cor"]
    assert rows[0] != rows[1]


@pytest.mark.parametrize("case", ["a.nml", "deep/er/a.nml"])
def test_data_files_are_in_the_folder_of_the_file_that_names_them(vcor, case):
    """And the completed case, as it stands in the results, runs where the case stood."""
    vcor.write(POINTS, "library/points.csv")
    vcor.write(TABLE.split("&solver")[0], "library/m.nml")
    vcor.write(BODIES + STEEL + "&solver method = 'direct' /\n", case)
    found = vcor.numbers(case, "library/m.nml")
    vcor.write(POINTS, "whole/points.csv")
    vcor.write(BODIES + STEEL + TABLE, "whole/w.nml")
    assert found == vcor.numbers("whole/w.nml")
    vcor.succeeds("run", case, "library/m.nml", "--output", "out")
    head = (vcor.folder / "out/a_summary.csv").read_text().split("# case:\n")[1]
    text = "".join(line[2:] + "\n" for line in head.splitlines() if line.startswith("#"))
    with h5py.File(vcor.folder / "out/a.h5") as file:
        assert file.attrs["case"].strip() == text.strip()
    again = case.replace("a.nml", "again.nml")
    vcor.write(text, again)
    assert vcor.numbers(again) == found
    # an option names a file from the folder of the case
    vcor.write(POINTS, case.replace("a.nml", "other.csv"))
    assert vcor.numbers(case, "library/m.nml", "--set", "rubber.file=other.csv") == found


def test_no_result_replaces_a_file_of_materials(vcor):
    vcor.write(POINTS, "points.csv")
    vcor.write(BODIES + STEEL + "&solver method = 'direct' /\n", "a.nml")
    vcor.write(TABLE.split("&solver")[0], "m.csv")
    vcor.refuses("run", "a.nml", "m.csv", "--set", "output.stem=m", "--set", "output.history=.true.",
                 code=INPUT, says=["m.csv"])  # fmt: skip


@pytest.mark.parametrize("path", MATERIALS, ids=lambda path: path.stem)
def test_materials_of_the_examples(vcor, path):
    """A ball of each on a rigid floor; every value has its source in the head of the file."""
    name = re.search(r"name *= '(.*)'", path.read_text(encoding="utf-8"))[1]
    shifts = "shift" in path.read_text(encoding="utf-8")
    temperature = ", temperature = 313.15" if shifts else ""
    vcor.write(
        f"&impact velocity = 0.5{temperature} /\n&sphere radius = 0.005, material = '{name}' /\n"
        "&plate material = 'floor', waves = 'none' /\n&material name = 'floor', model = 'rigid' /\n",
        "a.nml",
    )
    numbers = vcor.numbers("a.nml", path)
    assert numbers["status"] == "separated"
    assert "warning" not in vcor("check", "a.nml", path).err
    assert path.read_text(encoding="utf-8").startswith("! ")


def test_butyl_is_that_of_the_paper(vcor):
    """Shear moduli in the library, tensile ones in the paper."""
    vcor.write(BODIES.replace("'rubber'", "'butyl'") + STEEL, "a.nml")
    butyl = next(path for path in MATERIALS if path.stem == "butyl")
    paper = PAPER / "butyl_power_law.nml"
    found = vcor("run", "a.nml", butyl, "--print", "cor", "--quiet").out
    vcor.write(paper.read_text(encoding="utf-8"), "b.nml")
    words = ["--set", "impact.velocity=5", "--print", "cor", "--quiet"]
    assert float(found) == pytest.approx(float(vcor.succeeds("run", "b.nml", *words)), rel=1e-12)
