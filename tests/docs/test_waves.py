"""The error of each choice of waves: its script makes the tables and the figure again."""

from places import ROOT
from tables import compare


def test_the_tables_and_the_figure_are_those_of_the_script(script, tmp_path):
    script(ROOT / "docs/make_waves.py", tmp_path)
    page = (ROOT / "docs/impact.md").read_text("utf-8")
    assert compare(page, (tmp_path / "impact.md").read_text("utf-8")) == 5
    assert (tmp_path / "waves.svg").stat().st_size > 0
    assert 'src="waves.svg"' in page
