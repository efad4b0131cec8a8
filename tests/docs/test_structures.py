"""Impacts on structures: the script makes the tables of the page again."""

from places import ROOT
from tables import compare


def test_the_tables_are_those_of_the_script(script, tmp_path):
    script(ROOT / "docs/make_structures.py", tmp_path)
    page = (ROOT / "docs/structures.md").read_text("utf-8")
    assert compare(page, (tmp_path / "structures.md").read_text("utf-8")) == 5
