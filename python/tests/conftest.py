"""What the tests of the package share: the program to compare with, and cases."""

import io
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "examples" / "paper"
SWEEPS = ROOT / "examples" / "sweeps"
EVERYTHING = "VCOR_ALL_TESTS" in os.environ
#: Starts of an identification where a test is not about them
FEW = 3


def long_tests(*cases):
    """Cases that prove once more what others of the same test prove: of the long tests only."""
    return list(cases) if EVERYTHING else []


@pytest.fixture
def program(tmp_path, capsys, monkeypatch):
    """Run the program, or `vcor fit`, in an empty folder; what it prints, or its line of error."""
    shell = Shell(tmp_path, capsys, monkeypatch)

    def run(*words, code=0):
        done = shell(*words)
        assert done.code == code, done.err
        return done.out if code == 0 else done.err

    return run


@pytest.fixture
def few_starts(monkeypatch):
    """Identification from fewer starts, where a test is not about them: most of its time."""
    from vcor.materials import search

    if not EVERYTHING:
        monkeypatch.setattr(search, "STARTS", FEW)


@pytest.fixture
def no_figures(monkeypatch):
    """Commands without their figures, where a test is about the rest: half of their time."""
    from vcor.materials.master import Master
    from vcor.uncertainty import Uncertainty
    from vcor.uncertainty_sweep import Bands

    for made in (Bands, Master, Uncertainty):
        monkeypatch.setattr(made, "figure", lambda *_: None)


@pytest.fixture
def sls():
    """The SLS case of the paper."""
    import vcor

    return vcor.read(PAPER / "sls.nml")


class Shell:
    """`vcor fit` as a user calls it, and the program, in an empty folder."""

    def __init__(self, folder, capsys, monkeypatch):
        self.folder, self._capsys, self._patch = folder, capsys, monkeypatch
        monkeypatch.chdir(folder)

    def write(self, text, name="case.nml"):
        """Write a file."""
        data = text if isinstance(text, bytes) else text.encode()
        (self.folder / name).write_bytes(data)

    def __call__(self, *words, input=""):
        """Run a command; exit code, output and errors."""
        words = [str(word) for word in words]
        if words[0] != "fit":
            done = subprocess.run(
                [os.environ["VCOR"], *words], capture_output=True, encoding="utf-8", check=False
            )
            return SimpleNamespace(code=done.returncode, out=done.stdout, err=done.stderr)
        from vcor._command import call

        self._patch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(input.encode())))
        self._capsys.readouterr()
        code = 0
        try:
            call("fit", words[1:])
        except SystemExit as leaving:
            code = leaving.code
        out, err = self._capsys.readouterr()
        return SimpleNamespace(code=code, out=out, err=err)

    def succeeds(self, *words, **options):
        """Run a command that says nothing on stderr; what it prints."""
        done = self(*words, **options)
        assert (done.code, done.err) == (0, "")
        return done.out

    def refuses(self, *words, code, says=(), at="", **options):
        """Run a command that complains in one line and leaves everything as it was."""
        before = sorted(self.folder.rglob("*"))
        done = self(*words, **options)
        assert (done.code, done.out) == (code, "")
        assert done.err.startswith(f"vcor: error: {at}") and done.err.count("\n") == 1
        for word in [says] if isinstance(says, str) else says:
            assert word in done.err
        assert sorted(self.folder.rglob("*")) == before
        return done.err


@pytest.fixture
def shell(tmp_path, capsys, monkeypatch):
    """Run `vcor fit` and the program in an empty folder."""
    return Shell(tmp_path, capsys, monkeypatch)
