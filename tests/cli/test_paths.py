"""Names and places of case files."""

import os
import subprocess

import pytest
from cases import SLS
from program import EXAMPLES, LIMIT, PAPER, program


def results(folder):
    return {path.name for path in folder.iterdir() if path.suffix in {".csv", ".h5"}}


@pytest.mark.parametrize(
    "name, stem",
    [
        ("two words.nml", "two words"),
        ("Stoß_α_碰.nml", "Stoß_α_碰"),
        ("case", "case"),
        ("case.txt", "case.txt"),
        ("a.b.nml", "a.b"),
        (" x.nml", " x"),
        ("it's 100%.nml", "it's 100%"),
        ("x" * 200 + ".nml", "x" * 200),
    ],
)
def test_names(vcor, name, stem):
    vcor.write(SLS, name)
    out = vcor.succeeds("run", name)
    assert name in out
    found = results(vcor.folder)
    assert found == {f"{stem}_summary.csv", f"{stem}.csv", f"{stem}.h5"}


@pytest.mark.parametrize("folder", ["two words", "Übung α", "a/b/c"])
def test_folders(vcor, folder):
    """Files go to the current directory, not next to the case."""
    vcor.write(SLS, f"{folder}/case.nml")
    vcor.succeeds("run", f"{folder}/case.nml")
    assert results(vcor.folder) == {"case_summary.csv", "case.csv", "case.h5"}
    vcor.succeeds(
        "run", f"./{folder}/../{folder.split('/')[-1]}/case.nml", "--output", f"{folder}/x y"
    )
    assert len(results(vcor.folder / folder / "x y")) == 3


def test_long_path(vcor):
    folder = "/".join(["d" * 100] * 15)
    vcor.write(SLS, f"{folder}/case.nml")
    vcor.succeeds("run", f"{folder}/case.nml", "--output", f"{folder}/out")
    assert len(results(vcor.folder / folder / "out")) == 3


def test_link(vcor):
    """The stem is that of the name that was given."""
    vcor.write(SLS, "real/case.nml")
    (vcor.folder / "link.nml").symlink_to("real/case.nml")
    vcor.succeeds("run", "link.nml")
    assert results(vcor.folder) == {"link_summary.csv", "link.csv", "link.h5"}
    assert results(vcor.folder / "real") == set()


def test_absolute_path_from_elsewhere(vcor):
    vcor.write(SLS)
    elsewhere = vcor.folder / "elsewhere"
    elsewhere.mkdir()
    vcor.succeeds("run", vcor.folder / "case.nml", cwd=elsewhere)
    assert results(elsewhere) == {"case_summary.csv", "case.csv", "case.h5"}
    assert results(vcor.folder) == set()


def test_relative_path_from_elsewhere(vcor):
    path = os.path.relpath(PAPER / "sls.nml", vcor.folder)
    assert vcor.numbers(path) == vcor.numbers(PAPER / "sls.nml")


def test_pipe(vcor):
    """A case may come through a pipe."""
    vcor.write(SLS)
    values = vcor.numbers("case.nml")
    assert vcor.numbers("/dev/stdin", input=SLS) == values


def test_other_line_ends(vcor):
    vcor.write(SLS)
    values = vcor.numbers("case.nml")
    for text in (SLS.replace("\n", "\r\n"), "\ufeff" + SLS, SLS.rstrip("\n"), SLS + "\n\n"):
        vcor.write(text.encode(), "other.nml")
        assert vcor.numbers("other.nml") == values


def test_program_through_a_link(vcor):
    """The program does not look for anything next to itself."""
    vcor.write(SLS)
    (vcor.folder / "bin").mkdir()
    (vcor.folder / "bin" / "restitution").symlink_to(program())
    done = subprocess.run(
        ["restitution", "run", "case.nml", "--print", "cor", "--quiet"],
        cwd=vcor.folder,
        env={"PATH": str(vcor.folder / "bin")},
        capture_output=True,
        text=True,
        timeout=LIMIT,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.strip() == vcor.numbers("case.nml")["cor"]


def test_there_are_examples():
    assert len(EXAMPLES) >= 8
