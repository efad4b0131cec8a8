"""Nothing may be lost in silence when a disk is full."""

import subprocess

import pytest
from cases import SLS
from program import FILE, complaint, contents, program


@pytest.mark.parametrize(
    "words",
    [
        ["run", "case.nml"],
        ["run", "case.nml", "--print", "cor", "--quiet"],
        ["check", "case.nml"],
        ["help"],
        ["help", "input"],
        ["run", "--help"],
        ["--help"],
        ["--version"],
    ],
    ids=" ".join,
)
def test_screen(vcor, words):
    vcor.write(SLS)
    with open("/dev/full", "w") as full:
        done = vcor(*words, stdout=full)
    complaint(done, FILE, ["standard output", "No space left on device"])


SCRIPT = """
    mkdir disk
    mount -t tmpfs -o size=$1 tmpfs disk || exit 77
    for name in case.csv case.h5 case_summary.csv; do echo old > disk/$name; done
    "$2" run case.nml --output disk --quiet
    code=$?
    ls -A disk
    mkdir kept
    cp disk/* kept
    exit $code
"""


@pytest.mark.parametrize("only", ["", "csv", "hdf5"])
@pytest.mark.parametrize("size", ["12k", "16k", "24k"])
def test_files(vcor, only, size):
    """A disk of a few pages, seen by the processes of this test only."""
    text = SLS
    if only:
        other = {"csv": "hdf5", "hdf5": "csv"}[only]
        text = SLS.replace("&output\n", f"&output\n   {other} = .false.\n")
    vcor.write(text)
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", SCRIPT, "sh", size, program()],
        cwd=vcor.folder,
        capture_output=True,
        text=True,
        timeout=600,
    )
    if done.returncode in {1, 77} and "vcor" not in done.stderr:
        pytest.skip(f"no disk can be mounted here: {done.stderr.strip()}")
    names = done.stdout.split()
    assert names == ["case.csv", "case.h5", "case_summary.csv"]
    done.code, done.err = done.returncode, done.stderr
    complaint(done, FILE, ["disk/case", "No space left on device"])
    # Each file is a whole new one or the old one, and not all are new
    vcor.succeeds("run", "case.nml", "--output", "whole", "--set", "output.hdf5=T")
    kept = contents(vcor.folder / "kept")
    state = {}
    for path, (data, _) in kept.items():
        whole = vcor.folder / "whole" / path.name
        old = data == b"old\n"
        same = whole.exists() and len(data) == whole.stat().st_size
        assert old or same or path.suffix != ".h5", path.name
        assert old or data.endswith(b"\n") or path.suffix == ".h5"
        state[path.name] = old
    assert any(state.values())
