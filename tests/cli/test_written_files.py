"""Files while they are written: complete or not there; other files are not changed."""

import os
import resource
import signal
import subprocess
import time

import pytest
from cases import SLS
from program import FILE, SUCCESS, USAGE, complaint, contents, program

SWEEP = SLS + "&sweep\n parameter = 'impact.velocity', start = 1, stop = 50, count = 40\n/\n"
NAMES = ["case.h5", "case.csv", "case_summary.csv"]


def plant(path, kind, victim):
    """Something of that name."""
    path.parent.mkdir(exist_ok=True)
    if kind == "file":
        path.write_text("whose?")
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "link that leads nowhere":
        path.symlink_to("nowhere")
    else:
        victim.write_text("precious")
        path.symlink_to(victim)


KINDS = ["file", "link", "link that leads nowhere", "pipe", "folder"]


@pytest.mark.parametrize("text", [SLS, SWEEP])
@pytest.mark.parametrize("kind", KINDS)
def test_temporary_name_is_taken(vcor, kind, text):
    """What a killed run has left is replaced, and no link is followed."""
    vcor.write(text)
    path = vcor.folder / "out" / "case_summary.csv.vcor.tmp"
    plant(path, kind, vcor.folder / "victim")
    words = ["run", "case.nml", "--output", "out", "--quiet"]
    if kind == "folder":
        vcor.refuses(*words, code=FILE, says="cannot write 'out/case_summary.csv'")
        return
    vcor.succeeds(*words)
    assert not os.path.lexists(path)
    assert kind != "link" or (vcor.folder / "victim").read_text() == "precious"
    assert not (vcor.folder / "out" / "nowhere").exists()


@pytest.mark.parametrize("words", [["run"], ["run", "--output", "out"], ["material"]])
@pytest.mark.parametrize("text", [SLS, SWEEP])
def test_files_of_the_user_stay(vcor, text, words):
    """NAME.tmp beside any result is a file of the user's."""
    vcor.write(text)
    (vcor.folder / "out").mkdir()
    vcor.succeeds(words[0], "case.nml", *words[1:], "--quiet")
    made = [path for path in contents(vcor.folder) if path.suffix != ".nml"]
    assert made
    own = [path.with_name(path.name + ".tmp") for path in made]
    for path in own:
        path.write_text("precious")
    vcor.succeeds(words[0], "case.nml", *words[1:], "--quiet")
    assert [path.read_text() for path in own] == ["precious"]*len(own)
    assert set(contents(vcor.folder)) - {*made, *own} == {vcor.folder / "case.nml"}


@pytest.mark.parametrize("kind", KINDS)
def test_something_at_the_name_of_an_unfinished_sweep(vcor, kind):
    """It is not replaced, and no link is followed."""
    vcor.write(SWEEP)
    plant(vcor.folder / "out" / "case.part", kind, vcor.folder / "victim")
    before = contents(vcor.folder)
    words = ["run", "case.nml", "--output", "out"]
    vcor.refuses(*words, code=FILE, says=["out/case.part", "--resume", "delete"])
    expected = "expected" if kind == "file" else "expected a file or nothing"
    vcor.refuses(*words, "--resume", code=FILE, says=["out/case.part", expected])
    assert contents(vcor.folder) == before
    # a single impact has no such file
    vcor.write(SLS)
    vcor.succeeds(*words)


def test_case_of_that_name(vcor):
    vcor.write(SWEEP, "case.part")
    words = ["run", "case.part", "--set", "output.stem=case"]
    vcor.refuses(*words, code=3, says=["would replace the case file case.part"])
    assert (vcor.folder / "case.part").read_text() == SWEEP


def test_planted_results(vcor):
    """A link under a real name is replaced by the file; what it leads to stays."""
    vcor.write(SLS)
    for name in NAMES:
        plant(vcor.folder / "out" / name, "link", vcor.folder / "victim")
    assert vcor("run", "case.nml", "--output", "out", "--quiet").code == SUCCESS
    assert (vcor.folder / "victim").read_text() == "precious"
    assert not any((vcor.folder / "out" / name).is_symlink() for name in NAMES)


def test_results_are_replaced_unread(vcor):
    vcor.write(SLS)
    vcor.succeeds("run", "case.nml", "--output", "ref", "--quiet")
    (vcor.folder / "out").mkdir()
    for name in NAMES:
        (vcor.folder / "out" / name).write_text("something else")
    done = vcor("run", "case.nml", "--output", "out", "--quiet")
    assert (done.code, done.out) == (SUCCESS, "") and "replaced" not in done.err
    for name in NAMES:
        assert (vcor.folder / "out" / name).read_bytes() == (vcor.folder / "ref" / name).read_bytes()


@pytest.mark.parametrize("mask, mode", [(0o022, 0o644), (0o027, 0o640), (0o077, 0o600), (0, 0o666)])
def test_permissions(vcor, mask, mode):
    """Files have the permissions that the user's umask leaves."""
    vcor.write(SLS)
    (vcor.folder / "sweep.nml").write_text(SWEEP)
    before = set(vcor.folder.iterdir())
    vcor.succeeds("run", "case.nml", "sweep.nml", "--quiet", umask=mask)
    vcor.succeeds("material", "case.nml", "--quiet", umask=mask)
    made = set(vcor.folder.iterdir()) - before
    assert len(made) == 9
    assert {path.name: path.stat().st_mode & 0o777 for path in made} == {
        path.name: mode for path in made
    }


def test_folder_without_permission(vcor):
    if os.geteuid() == 0:
        pytest.skip("root may write everywhere")
    vcor.write(SWEEP)
    (vcor.folder / "out").mkdir(mode=0o555)
    vcor.refuses("run", "case.nml", "--output", "out", code=FILE, says=["cannot write 'out/case", "ermission"])
    assert list((vcor.folder / "out").iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_killed_while_writing(vcor, number):
    """The real names have the old files or the new ones, and the next run leaves nothing else."""
    vcor.write(SWEEP.replace("count = 40", "count = 10000"))
    words = ["run", "case.nml", "--quiet"]
    vcor.succeeds(*words, "--output", "ref")
    out = vcor.folder / "out"
    for _ in range(30):
        out.mkdir(exist_ok=True)
        for name in ("case.h5", "case_summary.csv"):
            (out / name).write_text("old")
        process = subprocess.Popen([program(), *words, "--output", "out"], cwd=vcor.folder)
        while process.poll() is None and not list(out.glob("*.tmp")):
            time.sleep(0.001)
        process.send_signal(number)
        if process.wait() == -number and list(out.glob("*.tmp")):
            break
    else:
        raise AssertionError("no run has been met while it wrote")
    for name in ("case.h5", "case_summary.csv"):
        new = (vcor.folder / "ref" / name).read_bytes()
        assert (out / name).read_bytes() in (b"old", new)
    vcor.succeeds(*words, "--output", "out", "--resume")
    assert {path.name: path.read_bytes() for path in out.iterdir()} == {
        path.name: path.read_bytes() for path in (vcor.folder / "ref").iterdir()
    }


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
    for name in NAMES:
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


# What has gone


@pytest.mark.parametrize(
    "words",
    [
        ["run", "case.nml", "--shard", "1/2"],
        ["run", "case.nml", "--shard=1/2"],
        ["merge", "case_shard_1_of_2.h5", "--output", "out"],
        ["merge"],
    ],
)
def test_shards(vcor, words):
    vcor.write(SWEEP)
    vcor.refuses(*words, code=USAGE, says=[" gone; expected mpirun -n N vcor run CASE.nml"])
