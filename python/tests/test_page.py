"""The scripts of the pages do what they say."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

PAGES = [
    "python.md",
    "exchange.md",
    "page.md",
    "recipes.md",
    "reproducing_the_paper.md",
]
SCRIPTS = {
    f"{name}-{i}": script
    for name in PAGES
    for i, script in enumerate(
        re.findall(
            r"^```python\n(.*?)^```$", (ROOT / "docs" / name).read_text("utf-8"), re.M | re.S
        )
    )
}
# The script for a cluster, with fewer points
FEWER = ("POINTS, PART = 10_000_000, 100_000", "POINTS, PART = 400, 100")


# Those of a cluster have processes that import the script
ALONE = [name for name, script in SCRIPTS.items() if "__main__" in script]
RUNNER = """import os, runpy, sys, warnings
for folder in sys.argv[1:]:
    os.chdir(folder)
    with warnings.catch_warnings():
        runpy.run_path("script.py", {}, "__main__")
    for file in (sys.stdout, sys.stderr):
        print("\\f", end="", file=file, flush=True)
"""


def prepared(name, folder):
    """A folder with the examples and the script of a name."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    (folder / "data").symlink_to(ROOT / "data")
    script = SCRIPTS[name]
    assert ("10_000_000" in script) == (FEWER[0] in script)
    (folder / "script.py").write_text(script.replace(*FEWER))
    return folder


def run(folder, *words):
    """Run Python as a user does, but with all warnings."""
    return subprocess.run(
        [sys.executable, "-W", "default", *map(str, words)],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """What each script prints and says on stderr, and how the one that fails ends.

    They are run one after the other in one interpreter, each in a folder and with names of its own:
    most of their time is imports.
    """
    folder = tmp_path_factory.mktemp("scripts")
    names = [name for name in SCRIPTS if name not in ALONE]
    (folder / "runner.py").write_text(RUNNER)
    done = run(folder, "runner.py", *(prepared(name, folder / name) for name in names))
    parts = [text.split("\f") for text in (done.stdout, done.stderr)]
    return dict(zip(names, zip(*parts, strict=True), strict=False)) | {"code": done.returncode}


@pytest.mark.parametrize("name", [name for name in SCRIPTS if name not in ALONE])
def test_the_scripts_of_the_pages(printed, name):
    """Each prints something; a warning of the validity has its line, and that of the script."""
    assert name in printed, "a script before this one failed"
    out, err = printed[name]
    assert out
    assert not re.sub(r"^.*: ValidityWarning: .*\n(  .*\n)?", "", err, flags=re.M)


def test_no_script_fails(printed):
    assert printed["code"] == 0


@pytest.mark.parametrize("name", ALONE)
def test_the_script_for_a_cluster(name, tmp_path):
    """It may say that a cluster is slow to stop."""
    done = run(prepared(name, tmp_path / "here"), "script.py")
    assert done.returncode == 0, done.stderr
    if FEWER[0] in SCRIPTS[name]:
        assert done.stdout.startswith("400 impacts, cor 0.43")
    else:
        assert done.stdout
        assert not re.sub(r"^.*: ValidityWarning: .*\n(  .*\n)?", "", done.stderr, flags=re.M)


def test_the_pair_of_the_recipe(printed):
    """The line that the page shows, to the digits that a fit keeps."""
    page = (ROOT / "docs/recipes.md").read_text("utf-8")
    (shown,) = re.findall("^pair_coeff .*$", page, re.M)
    for word, other in zip(shown.split(), printed["recipes.md-0"][0].split(), strict=True):
        if re.match(r"\d.*\d$", word):
            assert float(other) == pytest.approx(float(word), rel=1e-5)
        else:
            assert other == word
