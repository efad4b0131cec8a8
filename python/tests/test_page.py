"""The scripts of the pages do what they say."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

PAGES = [
    "python.md",
    "distributed.md",
    "exchange.md",
    "page.md",
    "recipes.md",
    "reference_impacts.md",
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


# That of the recipe has a test of its own
WITHOUT = {name: script for name, script in SCRIPTS.items() if name != "recipes.md-0"}


@pytest.mark.parametrize("script", WITHOUT.values(), ids=WITHOUT)
def test_a_script_of_the_pages(script, tmp_path):
    assert ("10_000_000" in script) == (FEWER[0] in script)
    script = script.replace(*FEWER)
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    (tmp_path / "data").symlink_to(ROOT / "data")
    (tmp_path / "script.py").write_text(script)
    done = subprocess.run(
        [sys.executable, "-W", "default", "script.py"],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    if FEWER[1] in script:
        # a cluster that is slow to stop says so
        assert done.stdout.startswith("400 impacts, cor 0.43")
    else:
        # a warning of the validity has its line, and that of the script
        assert done.stdout
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
