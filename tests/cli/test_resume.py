"""Sweeps that are interrupted, by whom ever, and go on."""

import os
import pty
import random
import shutil
import signal
import subprocess
import time

import h5py
import numpy
import pytest
import xarray
from cases import SLS
from long_sweep import (
    FILES,
    PART,
    begin,
    done_in,
    interrupted,
    same_files,
    sweep_text,
    wait_for,
    write_long_sweep,
)
from program import FILE, NUMERICAL, SUCCESS, USAGE, Vcor, complaint, program


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """A long sweep, and its undisturbed files in the folder ref."""
    vcor = Vcor(tmp_path_factory.mktemp("long"))
    write_long_sweep(vcor, 0.8)
    vcor.reference = vcor("run", "case.nml", "--output", "ref")
    assert vcor.reference.code == NUMERICAL
    return vcor


@pytest.fixture
def long(vcor, solved):
    """The same in the folder of the test."""
    shutil.copytree(solved.folder, vcor.folder, dirs_exist_ok=True)
    vcor.reference = solved.reference
    return vcor


def finish(vcor):
    """Resume; what it says is what the undisturbed run has said, reasons included."""
    done = vcor("run", "case.nml", "--output", "out", "--resume")
    assert done.code == NUMERICAL
    assert done.err == vcor.reference.err
    assert done.out.replace("out/", "ref/") == vcor.reference.out
    same_files(vcor.folder / "out", vcor.folder / "ref")


def test_kill_at_random(long):
    """Whatever the moment, what is there is a valid file and nothing of it is lost."""
    part = long.folder / "out" / PART
    done = 0
    for _ in range(20):
        process = begin(long, "--resume", "--quiet")
        time.sleep(random.uniform(0.0, 0.4))
        process.kill()
        process.communicate()
        if part.exists():
            now, _ = done_in(part, killed=True)
            assert now >= done
            done = now
    for path in (long.folder / "out").glob(".vcor-*"):
        shutil.rmtree(path)
    done = long("run", "case.nml", "--output", "out", "--resume", "--quiet")
    assert done.code in {SUCCESS, NUMERICAL}
    same_files(long.folder / "out", long.folder / "ref")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal(long, number):
    code, out, err = interrupted(long, number)
    assert code == 128 + number
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith(f"vcor: error: case.nml: stopped by {number.name} after ")
    part = long.folder / "out" / PART
    done, points = done_in(part)
    assert f" {done} of {points} points" in err
    assert f"out/{PART}" in err
    assert 0 < done < points
    assert {path.name for path in part.parent.iterdir()} == {PART}
    # a table of points
    with xarray.open_dataset(part, group="summary", engine="h5netcdf") as data:
        assert data["cor"].dims == ("point",)
        assert data.sizes["point"] == points
        assert {"impact.velocity", "sphere.radius"} < set(data)
        whole = xarray.open_dataset(
            long.folder / "ref" / "case.h5", group="summary", engine="h5netcdf"
        )
        there = data["check"].values != 0
        for name in ("cor", "contact_time", "steps"):
            expected = whole[name].values.ravel()[there]
            numpy.testing.assert_array_equal(data[name].values[there], expected)
    finish(long)


def test_resume_after_a_crash(long):
    """Pages that never came to the disk are solved again: the check sum tells."""
    interrupted(long, signal.SIGINT)
    part = long.folder / "out" / PART
    done, _ = done_in(part)
    with h5py.File(part, "r+") as file:
        file["summary/cor"][: done // 4] = 0.0
        file["summary/status"][done // 4 : done // 2] = 0
        file["summary/steps"][done // 2] += 1
    finish(long)


def test_resume_of_nothing(vcor):
    vcor.write(sweep_text(30))
    done = vcor("run", "case.nml", "--output", "out", "--resume")
    assert done.code == NUMERICAL
    assert sorted(path.name for path in (vcor.folder / "out").iterdir()) == FILES


@pytest.mark.parametrize("only", ["", "csv", "hdf5"])
def test_resume_of_a_finished_one(vcor, only):
    text = sweep_text(30)
    if only:
        other = {"csv": "hdf5", "hdf5": "csv"}[only]
        text = text.replace("&output\n", f"&output\n   {other} = .false.\n")
    vcor.write(text)
    assert vcor("run", "case.nml", "--output", "out").code == NUMERICAL
    before = {path: path.stat().st_mtime_ns for path in (vcor.folder / "out").iterdir()}
    out = vcor.succeeds("run", "case.nml", "--output", "out", "--resume")
    assert out.count("\n") == 1
    assert "out/case" in out and "finished" in out
    assert vcor.succeeds("run", "case.nml", "--output", "out", "--resume", "--quiet") == ""
    assert before == {path: path.stat().st_mtime_ns for path in (vcor.folder / "out").iterdir()}
    words = ["run", "case.nml", "--output", "out", "--resume", "--set", "rubber.beta=900"]
    vcor.refuses(*words, code=FILE, says=["another case", "beta = 1200", "beta = 900"])


@pytest.mark.parametrize("missing", FILES)
def test_resume_where_a_file_is_missing(vcor, missing):
    """Of two files one is not finished."""
    vcor.write(sweep_text(30))
    reference = vcor("run", "case.nml", "--output", "ref")
    shutil.copytree(vcor.folder / "ref", vcor.folder / "out")
    (vcor.folder / "out" / missing).unlink()
    done = vcor("run", "case.nml", "--output", "out", "--resume")
    assert (done.code, done.err) == (NUMERICAL, reference.err)
    assert done.out.replace("out/", "ref/") == reference.out
    same_files(vcor.folder / "out", vcor.folder / "ref")


@pytest.mark.parametrize("only", ["", "csv"])
@pytest.mark.parametrize("kept", [0.0, 0.5, 0.99, "a row less", "a row more", "its last byte"])
def test_resume_where_text_is_cut_short(vcor, kept, only):
    """A CSV file without all of its rows is made anew, from the HDF5 file or the points."""
    text = sweep_text(30)
    if only:
        text = text.replace("&output\n", "&output\n   hdf5 = .false.\n")
    vcor.write(text)
    vcor("run", "case.nml", "--output", "ref")
    shutil.copytree(vcor.folder / "ref", vcor.folder / "out")
    cut = vcor.folder / "out" / "case_summary.csv"
    lines = cut.read_bytes().splitlines(keepends=True)
    whole = b"".join(lines)
    if kept == "a row less":
        cut.write_bytes(b"".join(lines[:-1]))
    elif kept == "a row more":
        cut.write_bytes(whole + lines[-1])
    elif kept == "its last byte":
        cut.write_bytes(whole[:-1])
    else:
        head = sum(len(line) for line in lines if line.startswith(b"#"))
        cut.write_bytes(whole[: head + int(kept * (len(whole) - head))])
    done = vcor("run", "case.nml", "--output", "out", "--resume")
    assert done.code == NUMERICAL
    names = ["case_summary.csv"] if only else FILES
    same_files(vcor.folder / "out", vcor.folder / "ref", names)
    assert "finished" in vcor.succeeds("run", "case.nml", "--output", "out", "--resume")


@pytest.mark.parametrize("cut", ["case.csv", "case_summary.csv"])
def test_resume_of_one_impact_where_text_is_cut_short(vcor, cut):
    vcor.write(SLS)
    vcor.succeeds("run", "case.nml", "--output", "ref")
    shutil.copytree(vcor.folder / "ref", vcor.folder / "out")
    path = vcor.folder / "out" / cut
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:-1]))
    vcor.succeeds("run", "case.nml", "--output", "out", "--resume")
    same_files(vcor.folder / "out", vcor.folder / "ref", [*FILES, "case.csv"])


@pytest.mark.parametrize("missing", ["case.h5", "case.csv", "case_summary.csv"])
def test_resume_of_one_impact_where_a_file_is_missing(vcor, missing):
    vcor.write(SLS)
    vcor.succeeds("run", "case.nml", "--output", "ref")
    shutil.copytree(vcor.folder / "ref", vcor.folder / "out")
    (vcor.folder / "out" / missing).unlink()
    vcor.succeeds("run", "case.nml", "--output", "out", "--resume")
    same_files(vcor.folder / "out", vcor.folder / "ref", [*FILES, "case.csv"])


def test_hdf5_gets_its_name_last(vcor):
    """Whenever a small sweep is killed: where the HDF5 file is there, so is the other."""
    vcor.write(sweep_text(300))
    vcor("run", "case.nml", "--output", "ref")
    for number in range(25):
        process = begin(vcor, "--quiet")
        time.sleep(0.002 * number)
        process.kill()
        process.communicate()
        found = vcor.folder / "out"
        if (found / "case.h5").exists():
            assert (found / "case_summary.csv").exists()
        done = vcor("run", "case.nml", "--output", "out", "--quiet", "--resume")
        assert done.code in {SUCCESS, NUMERICAL}
        for name in FILES:
            assert (found / name).read_bytes() == (vcor.folder / "ref" / name).read_bytes()
        shutil.rmtree(found)


def test_resume_of_one_impact(vcor):
    vcor.write(SLS)
    vcor.succeeds("run", "case.nml", "--resume")
    assert "finished" in vcor.succeeds("run", "case.nml", "--resume")
    vcor.refuses(
        "run", "case.nml", "--resume", "--set", "impact.velocity=9", code=FILE, says="another case"
    )


def test_resume_needs_files(vcor):
    vcor.write(sweep_text(30))
    vcor.refuses("run", "case.nml", "--print", "cor", "--resume", code=USAGE, says="--output")
    vcor.refuses("run", "case.nml", "--resume=yes", code=USAGE, says="--resume takes no value")
    vcor.refuses("check", "case.nml", "--resume", code=USAGE, says="--resume")


def test_refused(long):
    """Of another case, sweep or version, or none at all; with and without --resume."""
    interrupted(long, signal.SIGINT)
    part = long.folder / "out" / PART
    words = ["run", "case.nml", "--output", "out"]
    for more in ([], ["--resume"]):
        setting = ["--set", "rubber.beta=900"]
        says = [f"out/{PART}", "another case", "beta = 1200", "beta = 900"]
        long.refuses(*words, *more, *setting, code=FILE, says=says)
        case = (long.folder / "case.nml").read_text()
        long.write(case.replace("stop = 50.0", "stop = 40.0"))
        says = ["another case", "stop = 50.0", "stop = 40.0"]
        long.refuses(*words, *more, code=FILE, says=says)
        long.write(case)
        with h5py.File(part, "r+") as file:
            version = file.attrs["version"]
            file.attrs["version"] = "0.0.1"
        says = ["another version", "0.0.1", version]
        long.refuses(*words, *more, code=FILE, says=says)
        with h5py.File(part, "r+") as file:
            file.attrs["version"] = version
        data = part.read_bytes()
        part.write_bytes(b"what?" * 1000)
        long.refuses(*words, *more, code=FILE, says=[f"out/{PART}", "expected an HDF5 file"])
        part.write_bytes(data)
    # the same case may begin anew, and says so
    done = long(*words, "--quiet")
    assert done.code == NUMERICAL
    assert f"vcor: note: 'out/{PART}' is given up" in done.err
    same_files(long.folder / "out", long.folder / "ref")


def checks_in(path):
    """The check sums of a file that another process may be writing to: of no two columns the same
    moment is seen."""
    with h5py.File(path) as file:
        return file["summary/check"][:]


def test_in_use(long):
    """Two at work on one sweep would take each other's points."""
    for _ in range(5):
        process = begin(long)
        part = long.folder / "out" / PART
        wait_for(part, process)
        # the file is locked a moment after it is there, and before more points come to it
        begun = checks_in(part)
        while part.exists() and (checks_in(part) == begun).all():
            assert process.poll() is None, process.communicate()
        process.send_signal(signal.SIGSTOP)
        if process.poll() is None and part.exists():
            break
        # a busy machine has let it finish before it was stopped
        process.send_signal(signal.SIGCONT)
        process.communicate()
        shutil.rmtree(long.folder / "out")
    for more in ([], ["--resume"]):
        long.refuses("run", "case.nml", "--output", "out", *more, code=FILE, says="in use")
    process.send_signal(signal.SIGCONT)
    assert process.wait(timeout=600) == NUMERICAL
    process.communicate()
    same_files(long.folder / "out", long.folder / "ref")


def test_another_case_is_not_replaced_in_silence(vcor):
    vcor.write(sweep_text(30))
    vcor("run", "case.nml", "--quiet")
    assert vcor("run", "case.nml", "--quiet").err.count("\n") == 1
    done = vcor("run", "case.nml", "--quiet", "--set", "rubber.beta=900")
    assert done.err.startswith("vcor: note: replaced: './case.h5' is of another case: ")
    # it is a note: nobody expected anything
    note = done.err.splitlines()[0]
    assert "expected" not in note and "it has 'beta = 1200" in note
    vcor.write(SLS, "case.nml")
    assert "replaced: './case.h5'" in vcor.succeeds("run", "case.nml")
    assert "replaced" not in vcor.succeeds("run", "case.nml")
    assert "replaced: './case.h5'" in vcor.succeeds("run", "case.nml", "--set", "rubber.beta=900")
    # a key that only one of the two gives
    given = ["--set", "rubber.beta=900", "--set", "solver.accuracy=1e-9"]
    assert "it lacks 'accuracy = 1.0e-9'" in vcor.succeeds("run", "case.nml", *given)
    done = vcor.succeeds("run", "case.nml", "--set", "rubber.beta=900")
    assert "it has 'accuracy = 1.0e-9', which this one lacks" in done
    (vcor.folder / "case.h5").write_text("something else")
    assert "replaced: './case.h5' is not a file" in vcor.succeeds("run", "case.nml")


def test_other_data(vcor, data_files):
    """The points of a data file belong to the case."""
    assert data_files is None
    name = "soft_rubber_data.csv"
    text = sweep_text(30).split("&material\n   name = 'rubber'")[0]
    vcor.write(
        text
        + "&material\n   name = 'rubber', model = 'table', density = 1100.0, poisson_ratio = 0.5,\n"
        + f"   file = '{name}', modulus_unit = 'MPa'\n/\n&sweep\n   parameter = 'impact.velocity'\n   values = 1, 2\n/\n"
    )
    vcor.succeeds("run", "case.nml")
    assert "finished" in vcor.succeeds("run", "case.nml", "--resume")
    data = vcor.folder / name
    lines = data.read_text().splitlines()
    data.write_text("\n".join(lines[:-1]) + "\n")
    vcor.refuses("run", "case.nml", "--resume", code=FILE, says="other points")


# A disk that is too small for the unfinished file, or for what it becomes

SCRIPT = """
    mkdir disk
    mount -t tmpfs -o size=$1 tmpfs disk || exit 77
    "$2" run case.nml --output disk --quiet
    echo $?
    ls -A disk
    echo --
    mount -o remount,size=200m disk
    "$2" run case.nml --output disk --quiet --resume 2>resumed
    echo $?
    mkdir out
    cp disk/* out
"""


@pytest.mark.parametrize("bytes_per_point", [10, 100, 250, 450])
def test_full_disk(long, bytes_per_point):
    points = (long.folder / "ref" / "case_summary.csv").read_text().count("\n")
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", SCRIPT, "sh", str(bytes_per_point * points), program()],
        cwd=long.folder,
        capture_output=True,
        text=True,
        timeout=600,
    )
    if done.returncode in {1, 77} and "vcor" not in done.stderr:
        pytest.skip(f"no disk can be mounted here: {done.stderr.strip()}")
    first, rest = done.stdout.split("--\n")
    code, *left = first.split()
    done.code, done.err = int(code), done.stderr
    complaint(done, FILE, ["disk/case", "No space left on device"])
    assert set(left) <= {PART, *FILES}
    assert int(rest) == NUMERICAL
    same_files(long.folder / "out", long.folder / "ref")


# The terminal


def on_terminal(vcor, *words):
    """What a run writes to a terminal."""
    ours, theirs = pty.openpty()
    process = begin(vcor, *words, stderr=theirs, stdout=subprocess.DEVNULL)
    os.close(theirs)
    found = b""
    try:
        while True:
            block = os.read(ours, 4096)
            if not block:
                break
            found += block
    except OSError:  # what Linux says at the end
        pass
    os.close(ours)
    assert process.wait() == NUMERICAL
    return found.decode()


def test_progress(long):
    text = on_terminal(long)
    assert text.count("\n") == 1  # that of the error
    lines = text.split("\r")
    shown = [line for line in lines if "points, " in line and "left" in line]
    assert len(shown) > 2
    for line in shown:
        assert " of " in line and " %, " in line and ("/s, " in line or "/min, " in line)
    # nothing of it is left
    assert lines[-2].strip().startswith("vcor: error: ") or lines[-1].strip() == ""
    assert text.split("vcor: error")[0].endswith("\r")


def test_no_progress(long):
    assert on_terminal(long, "--quiet").startswith("vcor: error: ")
    assert "\r" not in long.reference.err
