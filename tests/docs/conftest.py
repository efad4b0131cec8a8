"""The documents, and the program that they are about."""

import os
import subprocess
from pathlib import Path

import pytest
from places import LIMIT


@pytest.fixture(scope="session")
def vcor():
    """Path of the program, from the environment."""
    program = os.environ.get("VCOR")
    if not program:
        pytest.fail("the environment variable VCOR is not set, expected the path of the program")
    return Path(program).absolute()


@pytest.fixture(scope="session")
def run():
    """Run a command that has to succeed without a word on stderr; what it prints."""

    def call(*words, **options):
        done = subprocess.run(
            list(map(str, words)),
            capture_output=True,
            encoding="utf-8",
            timeout=LIMIT,
            check=False,
            stdin=subprocess.DEVNULL,
            **options,
        )
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout

    return call
