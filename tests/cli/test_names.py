"""Names are names: no character of one is a command, and none leaves its line."""

import os
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
import pytest
from cases import SLS
from program import FILE, INPUT, USAGE, Vcor, complaint

# What makes a file X where it is run by a shell or by gnuplot
COMMANDS = [
    "|touch X",
    "<touch X",
    "`touch X`",
    "$(touch X)",
    "x'; touch X; '",
    "x' ; system 'touch X' #",
    "x'.system('touch X').'",
    'x"; system "touch X" #',
    'x".system("touch X")."',
    "-e system 'touch X'",
    "@touch X",
    "$touch X",
    "~touch X",
    "x ; touch X",
    "x & touch X",
    "x | touch X",
    "x \\",
    "x ''touch X''",
    "#touch X",
    "%touch X",
    "{touch X}",
    "!touch X",
]
PIPES = [name for name in COMMANDS if name[0] in "|<"]
OTHERS = [name for name in COMMANDS if name[0] not in "|<"]
# control characters of ASCII, DEL, and one of the second set
CONTROLS = ["\n", "\r", "\t", "\x1b", "\x01", "\x7f", "\x85"]
INJECTED = "x{}system 'touch X' #"


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A file of results."""
    folder = tmp_path_factory.mktemp("result")
    (folder / "case.nml").write_text(SLS)
    Vcor(folder).succeeds("run", "case.nml", "--quiet")
    return folder / "case.h5"


def ran(folder):
    """Whether something has made the file X."""
    return [path for path in folder.rglob("*") if path.name == "X"]


@pytest.mark.parametrize("name", OTHERS)
def test_names_of_figures(vcor, result, name):
    """As the name of a figure, of its folder and of the file of results, by vcor and by hand."""
    environment = {**os.environ, "HOME": str(vcor.folder)}
    (vcor.folder / "in").mkdir()
    shutil.copy(result, vcor.folder / "in" / f"{name}.h5")
    for words in (
        [f"in/{name}.h5"],
        [f"in/{name}.h5", "--output", f"./{name}/"],
        [f"in/{name}.h5", "--output", f"out/{name}.svg", "--script"],
    ):
        out = vcor.succeeds("plot", *words, env=environment)
        written = out.splitlines()[0].removeprefix("written ")
        assert (vcor.folder / written).read_bytes().startswith(b"<?xml")
    script = next((vcor.folder / "out").glob("*.gp"))
    # the remark at its head says how to draw it again
    command = script.read_text().splitlines()[1].split("draw it again: ")[1]
    (script.with_suffix(".svg")).unlink()
    subprocess.run(command, shell=True, cwd=script.parent, env=environment, check=True)
    assert script.with_suffix(".svg").exists()
    assert ran(vcor.folder) == []


@pytest.mark.parametrize("name", PIPES)
def test_names_that_begin_a_pipe(vcor, result, name):
    shutil.copy(result, vcor.folder / "case.h5")
    shutil.copy(result, vcor.folder / f"{name}.h5")
    vcor.write(SLS)
    vcor.write(SLS, f"{name}.nml")
    vcor.write("t,E\n1,5\n2,4\n3,3\n4,2.5\n", "data.csv")
    for place in (name, f"{name};/", f"out/{name}", f"{name}/x", f"{name}.svg"):
        for words in (
            ["plot", "case.h5"],
            ["run", "case.nml"],
            ["material", "case.nml"],
            ["fit", "data.csv", "--model", "sls"],
            ["merge", "case.h5"],
        ):
            vcor.refuses(*words, "--output", place, code=USAGE, says=["--output", "pipe"])
    for key in ("stem", "directory"):
        setting = f"output.{key}={name}"
        vcor.refuses("run", "case.nml", "--set", setting, code=INPUT, says=[key, "pipe"])
        vcor.write(SLS.replace("&output\n", f"&output\n   {key} = '{name}'\n"), "named.nml")
        vcor.refuses("run", "named.nml", code=INPUT, at="named.nml:23", says=[key, "pipe"])
    vcor.refuses("run", f"{name}.nml", code=INPUT, says=["stem", "pipe"])
    vcor.refuses("plot", f"{name}.h5", code=FILE, says="pipe")
    vcor.succeeds("plot", f"{name}.h5", "--output", "figure.svg")
    assert ran(vcor.folder) == []


@pytest.mark.parametrize("control", CONTROLS, ids=ascii)
def test_control_characters(vcor, result, control):
    """They are refused in every name that is written anywhere."""
    name = INJECTED.format(control)
    shutil.copy(result, vcor.folder / "case.h5")
    shutil.copy(result, vcor.folder / f"{name}.h5")
    vcor.write(SLS)
    vcor.write(SLS, f"{name}.nml")
    data = "t,E\n1,5\n2,4\n3,3\n4,2.5\n"
    vcor.write(data, "data.csv")
    vcor.write(data, f"{name}.csv")
    fit = ["fit", "data.csv", "--model", "sls"]
    for words in (
        ["plot", "case.h5"],
        ["run", "case.nml"],
        ["material", "case.nml"],
        fit,
        ["merge", "case.h5"],
    ):
        for place in (name, f"{name}/", f"{name}.svg"):
            vcor.refuses(*words, "--output", place, code=USAGE, says="--output")
    for words in (
        [*fit, "--name", name],
        ["plot", "case.h5", "--legend", name],
        ["plot", f"{name}.h5"],
        ["run", f"{name}.nml"],
        ["run", f"{name}.nml", "--output", "out"],
        ["check", f"{name}.nml"],
        ["fit", f"{name}.csv", "--model", "sls"],
        ["merge", f"{name}.h5"],
        ["run", "case.nml", f"--output={name}"],
    ):
        vcor.refuses(*words, code=USAGE)
    keys = ["case.title", "output.stem", "output.directory", "rubber.name"]
    for key in keys:
        done = vcor("run", "case.nml", "--set", f"{key}={name}")
        complaint(done, USAGE if control != "\t" else done.code)
        assert done.code in {USAGE, INPUT}
    for old, new in (
        ("'Ball on plate'", f"'{name}'"),
        ("&output\n", f'&output\n   stem = "{name}"\n'),
        ("&output\n", f'&output\n   directory = "{name}"\n'),
        ("'rubber'", f'"{name}"'),
        ("model = 'sls'", f'model = \'table\'\n   file = "{name}.csv"'),
    ):
        new = new if new[0] != "'" else f'"{name}"'
        vcor.write(SLS.replace(old, new), "named.nml")
        vcor.refuses("run", "named.nml", code=INPUT)
        vcor.refuses("material", "named.nml", code=INPUT)
    assert ran(vcor.folder) == []


HOSTILE = [
    *COMMANDS,
    *(INJECTED.format(control) for control in CONTROLS),
    "x\\\nsystem 'touch X'\n",
    "{/:Bold x} @y &{z} ~a{.b} x^2_3",
]


PLACES = 4


@pytest.mark.parametrize("first", range(0, len(HOSTILE), PLACES))
def test_texts_of_a_file(vcor, first):
    """A file of results is anybody's: its title, units, names and meanings are shown, never run."""
    one = "\n&sweep\n parameter = 'impact.velocity', values = 1.0, 5.0, 9.0\n/\n"
    two = one + "&sweep\n parameter = 'rubber.beta', values = 600.0, 1200.0\n/\n"
    vcor.write(SLS + one)
    vcor.write(SLS + two, "grid.nml")
    vcor.succeeds("run", "case.nml", "grid.nml", "--quiet")
    for place, (file, words) in enumerate(
        [
            ("case.h5", ["case.h5"]),
            ("case.h5", ["case.h5", "other.h5"]),
            ("grid.h5", ["grid.h5", "--kind", "sweep"]),
            ("grid.h5", ["grid.h5", "--kind", "map"]),
        ]
    ):
        texts = [HOSTILE[(first + place + i) % len(HOSTILE)] for i in range(PLACES)]
        shutil.copy(vcor.folder / file, vcor.folder / f"{place}_{file}")
        spoil(vcor.folder / f"{place}_{file}", *texts)
        shutil.copy(vcor.folder / f"{place}_{file}", vcor.folder / "other.h5")
        with h5py.File(vcor.folder / "other.h5", "a") as other:
            other.attrs["title"] = f"other {texts[0]}"
        figure = f"figure{place}.svg"
        vcor.succeeds("plot", f"{place}_{file}", *words[1:], "--output", figure, "--script")
        ElementTree.parse(vcor.folder / figure)
        lines = (vcor.folder / f"figure{place}.dat").read_text(encoding="utf-8").splitlines()
        for line in lines:
            assert not line or line[0] == "#" or len(np.array(line.split(), float)) == 2
    assert ran(vcor.folder) == []


def spoil(path, title, units, meaning, name):
    """Other texts for a file of results, its numbers as they were."""
    with h5py.File(path, "a") as results:
        results.attrs["title"] = title
        results.attrs["case"] = f"title = {title}\n{title} = {path.stem}\n"
        group = results["summary"]
        for dataset in group.values():
            dataset.attrs["units"] = units
            dataset.attrs["long_name"] = meaning
        for swept in ("impact.velocity", "rubber.beta"):
            if swept in group:
                group.move(swept, f"{name.replace('/', '_')} {swept}")
