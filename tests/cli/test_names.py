"""Names are names: no character of one is a command, and none leaves its line."""

import shutil

import pytest
from cases import SLS
from program import INPUT, USAGE, Vcor, complaint

# What makes a file X where the name is opened as a pipe
PIPES = ["|touch X", "<touch X"]
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


@pytest.mark.parametrize("name", PIPES)
def test_names_that_begin_a_pipe(vcor, result, name):
    shutil.copy(result, vcor.folder / "case.h5")
    shutil.copy(result, vcor.folder / f"{name}.h5")
    vcor.write(SLS)
    vcor.write(SLS, f"{name}.nml")
    for place in (name, f"{name};/", f"out/{name}", f"{name}/x", f"{name}.svg"):
        for words in (
            ["run", "case.nml"],
            ["material", "case.nml"],
        ):
            vcor.refuses(*words, "--output", place, code=USAGE, says=["--output", "pipe"])
    for key in ("stem", "directory"):
        setting = f"output.{key}={name}"
        vcor.refuses("run", "case.nml", "--set", setting, code=INPUT, says=[key, "pipe"])
        vcor.write(SLS.replace("&output\n", f"&output\n   {key} = '{name}'\n"), "named.nml")
        vcor.refuses("run", "named.nml", code=INPUT, at="named.nml:23", says=[key, "pipe"])
    vcor.refuses("run", f"{name}.nml", code=INPUT, says=["stem", "pipe"])
    assert ran(vcor.folder) == []


@pytest.mark.parametrize("control", CONTROLS, ids=ascii)
def test_control_characters(vcor, result, control):
    """They are refused in every name that is written anywhere."""
    name = INJECTED.format(control)
    shutil.copy(result, vcor.folder / "case.h5")
    shutil.copy(result, vcor.folder / f"{name}.h5")
    vcor.write(SLS)
    vcor.write(SLS, f"{name}.nml")
    vcor.write("t [s],E [Pa]\n1,5\n2,4\n", f"{name}.csv")
    for words in (
        ["run", "case.nml"],
        ["material", "case.nml"],
    ):
        for place in (name, f"{name}/", f"{name}.svg"):
            vcor.refuses(*words, "--output", place, code=USAGE, says="--output")
    for words in (
        ["run", f"{name}.nml"],
        ["run", f"{name}.nml", "--output", "out"],
        ["check", f"{name}.nml"],
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
