"""The documents, and the program that they are about."""

import contextlib
import io
import os
import runpy
import subprocess
import sys
import warnings
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


@pytest.fixture(scope="session")
def script():
    """Run a script of the project, which has to succeed; what it prints, what it says on stderr, and its warnings.

    It runs in this process, as most of the time of another would be imports; what it changes of this one is undone.
    """

    def call(path, *words):
        out, err = io.StringIO(), io.StringIO()
        with (
            pytest.MonkeyPatch.context() as patch,
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
            warnings.catch_warnings(record=True) as heard,
        ):
            warnings.simplefilter("default")
            # as Python does
            for kind in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
                warnings.simplefilter("ignore", kind)
            patch.setattr(sys, "argv", [str(path), *map(str, words)])
            patch.setattr(sys, "path", [str(path.parent), *sys.path])
            try:
                runpy.run_path(str(path), run_name="__main__")
            except SystemExit as leaving:
                assert not leaving.code, (leaving.code, out.getvalue(), err.getvalue())
        return out.getvalue(), err.getvalue(), [str(one.message) for one in heard]

    return call
