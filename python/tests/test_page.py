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


# One interpreter for the scripts of a page, each in a folder and with names of its own: half of
# their time goes into imports. Those of a cluster have processes that import the script
GROUPS = {}
for _name in SCRIPTS:
    # that of the recipe has a test of its own
    if _name != "recipes.md-0":
        _page = _name.rpartition("-")[0]
        GROUPS.setdefault(_name if "__main__" in SCRIPTS[_name] else _page, []).append(_name)
RUNNER = """import os, runpy, sys
for folder in sys.argv[1:]:
    os.chdir(folder)
    runpy.run_path("script.py", {}, "__main__")
    print("\\f", end="", flush=True)
"""


@pytest.mark.parametrize("names", GROUPS.values(), ids=GROUPS)
def test_the_scripts_of_the_pages(names, tmp_path):
    for name in names:
        folder = tmp_path / name
        shutil.copytree(ROOT / "examples", folder / "examples")
        (folder / "data").symlink_to(ROOT / "data")
        script = SCRIPTS[name]
        assert ("10_000_000" in script) == (FEWER[0] in script)
        (folder / "script.py").write_text(script.replace(*FEWER))
    if names[0] in GROUPS:
        command, folder = ["script.py"], tmp_path / names[0]
    else:
        (tmp_path / "runner.py").write_text(RUNNER)
        command, folder = ["runner.py", *(str(tmp_path / name) for name in names)], tmp_path
    done = subprocess.run(
        [sys.executable, "-W", "default", *command],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    if FEWER[0] in SCRIPTS[names[0]]:
        # a cluster that is slow to stop says so
        assert done.stdout.startswith("400 impacts, cor 0.43")
        return
    # each prints something; a warning of the validity has its line, and that of the script
    printed = done.stdout.split("\f")[: len(names)]
    assert len(printed) == len(names) and all(printed)
    assert not re.sub(r"^.*: ValidityWarning: .*\n(  .*\n)?", "", done.stderr, flags=re.M)


def test_the_pair_of_the_recipe(tmp_path):
    """The line that the page shows, to the digits that a fit keeps."""
    page = (ROOT / "docs/recipes.md").read_text("utf-8")
    done = subprocess.run(
        [sys.executable, "-c", SCRIPTS["recipes.md-0"]],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    (shown,) = re.findall("^pair_coeff .*$", page, re.M)
    for word, other in zip(shown.split(), done.stdout.split(), strict=True):
        if re.match(r"\d.*\d$", word):
            assert float(other) == pytest.approx(float(word), rel=1e-5)
        else:
            assert other == word
