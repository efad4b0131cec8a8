"""The numbers of docs/numbers.toml are those that the pages show."""

import subprocess
import sys

from places import LIMIT, ROOT


def test_the_numbers_of_the_pages():
    command = [sys.executable, ROOT / "docs/make_numbers.py", "--check"]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=LIMIT, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
