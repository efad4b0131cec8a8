"""Impacts on structures: the script makes the tables of the page again."""

import subprocess
import sys

from places import LIMIT, ROOT
from tables import compare


def test_the_tables_are_those_of_the_script(tmp_path):
    command = [sys.executable, ROOT / "docs/make_structures.py", tmp_path]
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", timeout=LIMIT, check=False
    )
    assert done.returncode == 0, done.stderr
    page = (ROOT / "docs/structures.md").read_text("utf-8")
    assert compare(page, (tmp_path / "structures.md").read_text("utf-8")) == 5
