"""The page beside measurements: its script makes its tables and figures again."""

import re
import subprocess
import sys

import pytest
from places import LIMIT, ROOT

NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?")
FILES = sorted((ROOT / "data/measurements").glob("*.csv"))


def tables(text):
    """The tables that the script writes, by name."""
    return dict(re.findall(r"<!-- (\w+) -->\n(.*?)\n<!-- end -->", text, re.DOTALL))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("measurements")
    command = [sys.executable, ROOT / "docs/make_measurements.py", folder]
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", timeout=LIMIT, check=False
    )
    assert done.returncode == 0, done.stderr
    return folder


def test_the_tables_are_those_of_the_script(made):
    """To one unit of the last digit that is shown."""
    page = (ROOT / "docs/measurements.md").read_text("utf-8")
    shown, found = tables(page), tables((made / "measurements.md").read_text("utf-8"))
    assert shown.keys() == found.keys()
    assert len(shown) == page.count("<!-- end -->") >= 5
    for name, text in shown.items():
        assert NUMBER.sub("#", text) == NUMBER.sub("#", found[name]), name
        for one, other in zip(NUMBER.findall(text), NUMBER.findall(found[name]), strict=True):
            unit = 10.0 ** -len(one.partition(".")[2])
            assert abs(float(one) - float(other)) <= 1.001 * unit, (name, one, other)


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
