"""Files on their way: private, complete or not there, and nobody else's are touched."""

import os
import resource
import shutil
import signal
import stat
import subprocess

import pytest
from cases import SLS
from long_sweep import PART, begin, same_files, wait_for, write_long_sweep
from program import FILE, NUMERICAL, SUCCESS, complaint, contents, program

SWEEP = SLS + "&sweep\n parameter = 'impact.velocity', start = 1, stop = 50, count = 40\n/\n"


def scratch(folder):
    """Private folders that are there."""
    return list(folder.rglob(".vcor-*"))


def plant(path, kind, victim):
    """Something of that name that is no file."""
    path.parent.mkdir(exist_ok=True)
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "link that leads nowhere":
        path.symlink_to("nowhere")
    else:
        victim.write_text("precious")
        path.symlink_to(victim)


KINDS = ["link", "link that leads nowhere", "pipe", "folder"]


@pytest.mark.parametrize("kind", KINDS)
def test_planted_unfinished_file(vcor, kind):
    """What stands under the one name that a run looks for is refused at once, not followed."""
    vcor.write(SWEEP)
    plant(vcor.folder / "out" / PART, kind, vcor.folder / "victim")
    for more in ([], ["--resume"]):
        words = ["run", "case.nml", "--output", "out", *more]
        vcor.refuses(*words, code=FILE, says=[f"out/{PART}", "expected a file or nothing"])
    assert not (vcor.folder / "out" / "nowhere").exists()


@pytest.mark.parametrize("kind", KINDS)
def test_planted_old_names(vcor, kind):
    """Names that a file had on its way once mean nothing."""
    vcor.write(SWEEP)
    for name in ("case.new.h5", "case_summary.part.csv", ".vcor-XXXXXX"):
        plant(vcor.folder / "out" / name, kind, vcor.folder / "victim")
    vcor.succeeds("run", "case.nml", "--output", "out", "--quiet")
    assert kind != "link" or (vcor.folder / "victim").read_text() == "precious"
    assert not (vcor.folder / "out" / "nowhere").exists()
    assert len(scratch(vcor.folder)) == 1


def test_planted_results(vcor):
    """A link under a real name gives way to the file; what it leads to stays."""
    vcor.write(SLS)
    names = ["case.h5", "case.csv", "case_summary.csv"]
    for name in names:
        plant(vcor.folder / "out" / name, "link", vcor.folder / "victim")
    assert vcor("run", "case.nml", "--output", "out", "--quiet").code == SUCCESS
    assert (vcor.folder / "victim").read_text() == "precious"
    assert not any((vcor.folder / "out" / name).is_symlink() for name in names)


@pytest.mark.parametrize("mask, mode", [(0o022, 0o644), (0o027, 0o640), (0o077, 0o600), (0, 0o666)])
def test_permissions(vcor, mask, mode):
    """Files have the permissions that the user's umask leaves."""
    vcor.write(SLS)
    (vcor.folder / "sweep.nml").write_text(SWEEP)
    before = set(vcor.folder.iterdir())
    vcor.succeeds("run", "case.nml", "sweep.nml", "--quiet", umask=mask)
    vcor.succeeds("material", "case.nml", "--quiet", umask=mask)
    for part in "12":
        vcor.succeeds("run", "sweep.nml", "--shard", f"{part}/2", "--quiet", umask=mask)
    made = set(vcor.folder.iterdir()) - before
    assert len(made) == 11
    assert {path.name: path.stat().st_mode & 0o777 for path in made} == {
        path.name: mode for path in made
    }


def write_large_sweep(vcor):
    """A sweep whose files take a while to be written."""
    vcor.write(SWEEP.replace("count = 40", "count = 10000"))


def until_seen(vcor, do, *words):
    """Run a command until its private folder has been seen, and do something with it."""
    for _ in range(100):
        process = subprocess.Popen(
            [program(), *words], cwd=vcor.folder, umask=0, stderr=subprocess.DEVNULL
        )
        while process.poll() is None:
            for path in scratch(vcor.folder):
                try:
                    found = path.stat()
                except FileNotFoundError:
                    continue
                do(process, path, found)
                return process.wait()
    raise AssertionError("no private folder has been seen")


def test_private_folder(vcor):
    """Nobody else can read what is not complete, or write where it is."""

    def look(_, path, found):
        assert stat.S_ISDIR(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o700
        assert path.name.startswith(".vcor-") and len(path.name) == 12

    write_large_sweep(vcor)
    assert until_seen(vcor, look, "run", "case.nml", "--quiet") == SUCCESS
    assert scratch(vcor.folder) == []


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_signal_removes_the_folder(vcor, number):
    write_large_sweep(vcor)
    until_seen(
        vcor, lambda process, *_: process.send_signal(number), "run", "case.nml", "--quiet"
    )
    assert scratch(vcor.folder) == []


def test_killed(vcor):
    """What a killed run leaves is in nobody's way."""
    write_large_sweep(vcor)
    until_seen(vcor, lambda process, *_: process.kill(), "run", "case.nml", "--quiet")
    assert len(list(vcor.folder.glob(".vcor-*"))) <= 1
    vcor.succeeds("run", "case.nml", "--quiet", "--set", "sweep.count=10")


# A file that becomes too large


def limited(kind, value):
    """To be called before the program begins."""

    def limit():
        resource.setrlimit(kind, (value, value))

    return limit


@pytest.mark.parametrize("only", ["csv", "hdf5"])
@pytest.mark.parametrize("text, size", [(SLS, 1024), (SLS, 40_000), (SWEEP, 2048)])
def test_file_too_large(vcor, only, text, size):
    """One line as for a full disk, and the old files are there."""
    other = {"csv": "hdf5", "hdf5": "csv"}[only]
    vcor.write(text.replace("&output\n", f"&output\n   {other} = .false.\n"))
    for name in ("case.h5", "case.csv", "case_summary.csv"):
        (vcor.folder / name).write_text("old")
    before = contents(vcor.folder)
    done = vcor("run", "case.nml", "--quiet", preexec_fn=limited(resource.RLIMIT_FSIZE, size))
    complaint(done, FILE, ["cannot write './case", "File too large"])
    after = contents(vcor.folder)
    assert set(after) == set(before)
    assert any(after[path] == before[path] for path in before if path.suffix != ".nml")


def test_other_files_too_large(vcor):
    vcor.write(SLS)
    vcor.succeeds("run", "case.nml", "--quiet")
    limit = limited(resource.RLIMIT_FSIZE, 1024)
    before = contents(vcor.folder)
    for words in (["material", "case.nml", "--quiet"], ["check", "case.nml"]):
        with open(vcor.folder / "screen", "w") as screen:
            done = vcor(*words, preexec_fn=limit, stdout=screen)
        complaint(done, FILE, "cannot")
        (vcor.folder / "screen").unlink()
    assert set(contents(vcor.folder)) == set(before)


def test_unfinished_file_too_large(vcor):
    write_long_sweep(vcor, 0.8)
    done = vcor(
        "run", "case.nml", "--output", "out", preexec_fn=limited(resource.RLIMIT_FSIZE, 100_000)
    )
    complaint(done, FILE, [f"out/{PART}", "File too large"])
    assert list((vcor.folder / "out").iterdir()) == []


# Two at once


def test_two_at_once(vcor):
    """Of two runs of one sweep one has it, and says the other; the results are whole."""
    write_long_sweep(vcor, 0.8)
    for more in ([], ["--resume"]):
        shutil.rmtree(vcor.folder / "out", ignore_errors=True)
        both = [begin(vcor, "--quiet", *more) for _ in range(2)]
        said = [process.communicate()[1] for process in both]
        codes = [process.returncode for process in both]
        assert sorted(codes) == sorted([FILE, NUMERICAL]), said
        line = said[codes.index(FILE)]
        assert line.count("\n") == 1 and line.startswith("vcor: error: ") and "in use" in line
        assert sorted(path.name for path in (vcor.folder / "out").iterdir()) == [
            "case.h5",
            "case_summary.csv",
        ]


def test_begun_anew_in_use(vcor):
    """Unfinished points that one run is about to replace are not another's."""
    write_long_sweep(vcor, 0.8)
    process = begin(vcor)
    wait_for(vcor.folder / "out" / PART, process)
    process.kill()
    process.communicate()
    both = [begin(vcor, "--quiet") for _ in range(2)]
    said = [process.communicate()[1] for process in both]
    codes = [process.returncode for process in both]
    assert sorted(codes) == sorted([FILE, NUMERICAL]), said
    assert "in use" in said[codes.index(FILE)]
    vcor("run", "case.nml", "--output", "ref", "--quiet")
    same_files(vcor.folder / "out", vcor.folder / "ref")


# Too little memory


@pytest.mark.parametrize("megabytes", [150, 400])
@pytest.mark.parametrize("threads", [1, 2])
def test_too_little_memory(vcor, megabytes, threads):
    """It is said before the first point is solved, and how much there should be."""
    vcor.write(SWEEP.replace("count = 40", "count = 5000000"))
    words = ["run", "case.nml", "--output", "out", "--threads", threads]
    limit = limited(resource.RLIMIT_AS, megabytes * 2**20)
    done = vcor(*words, preexec_fn=limit)
    complaint(done, FILE, ["not enough memory", "5000000 points", "MB"])
    assert not (vcor.folder / "out").exists()
