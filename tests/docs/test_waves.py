"""The error of each choice of waves: its script makes the tables and the figure again."""

import subprocess
import sys

from places import LIMIT, ROOT
from tables import compare


def test_the_tables_and_the_figure_are_those_of_the_script(tmp_path):
    command = [sys.executable, ROOT / "docs/make_waves.py", tmp_path]
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", timeout=LIMIT, check=False
    )
    assert done.returncode == 0, done.stderr
    page = (ROOT / "docs/impact.md").read_text("utf-8")
    assert compare(page, (tmp_path / "impact.md").read_text("utf-8")) == 5
    assert (tmp_path / "waves.svg").stat().st_size > 0
    assert 'src="waves.svg"' in page
