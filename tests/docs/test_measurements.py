"""The page of measurements: its script makes its tables and figures again."""

import re

import pytest
from places import ROOT
from tables import compare

FILES = sorted((ROOT / "data/measurements").glob("*.csv"))


@pytest.fixture(scope="module")
def made(script, tmp_path_factory):
    folder = tmp_path_factory.mktemp("measurements")
    script(ROOT / "docs/make_measurements.py", folder)
    return folder


def test_the_tables_are_those_of_the_script(made):
    page = (ROOT / "docs/measurements.md").read_text("utf-8")
    assert compare(page, (made / "measurements.md").read_text("utf-8")) >= 5


def test_the_figures_are_those_of_the_script(made):
    figures = {path.name for path in made.glob("*.svg")}
    assert figures == {path.name for path in (ROOT / "docs").glob("measurements_*.svg")}
    page = (ROOT / "docs/measurements.md").read_text("utf-8")
    assert figures == set(re.findall(r'src="(\w+\.svg)"', page))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_each_set_says_where_it_is_from(path):
    """And is read by the script."""
    head = [line for line in path.read_text("utf-8").splitlines() if line.startswith("#")]
    for word in ("source", "how", "uncertainty", "licence"):
        assert any(line.startswith(f"# {word}: ") for line in head), word
    assert f'"{path.stem}"' in (ROOT / "docs/make_measurements.py").read_text("utf-8")
