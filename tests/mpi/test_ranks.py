"""The program under mpirun: the same bits, and one voice whatever goes wrong on whatever rank."""

import itertools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "cli"))

from cases import SLS
from long_sweep import PART, done_in, same_files, sweep_text, write_long_sweep
from program import FILE, INPUT, NUMERICAL, SUCCESS, USAGE, Done, Vcor, program

# Tests run where there are fewer cores than ranks, and as root in containers
ENVIRONMENT = {
    **os.environ,
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}
# Ranks that wait give their core to those that work: there may be more ranks than cores
WAITING = ["--mca", "mpi_yield_when_idle", "1"]
MPIRUN = [os.environ.get("VCOR_MPIRUN", "mpirun"), "--oversubscribe", "--bind-to", "none", *WAITING]


@pytest.fixture
def vcor(tmp_path):
    return Vcor(tmp_path)


def start(vcor, *words, wrapper=()):
    """Begin a call of mpirun."""
    return subprocess.Popen(
        [*wrapper, *MPIRUN, *map(str, words)],
        cwd=vcor.folder,
        env=ENVIRONMENT,
        encoding="utf-8",
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


def end(process):
    out, err = process.communicate(timeout=600)
    return Done(process.returncode, out, err)


def run(vcor, ranks, *words):
    return end(start(vcor, "-n", ranks, program(), "run", *words))


def said(done):
    """What vcor has said, without what mpirun adds."""
    return [line for line in done.err.splitlines() if line.startswith("vcor: ")]


def with_reference(folder, seconds, *words):
    """A sweep that takes so long, and its files as one rank and one thread make them."""
    vcor = Vcor(folder)
    write_long_sweep(vcor, seconds)
    done = vcor("run", "case.nml", "--output", "ref", "--threads", "1", *words)
    assert done.code == NUMERICAL
    vcor.reference = done
    return vcor


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    return with_reference(tmp_path_factory.mktemp("ranks"), 0.5)


@pytest.mark.parametrize("ranks, threads", [(1, 4), (2, 1), (2, 2), (3, 1)])
def test_same_bits(solved, ranks, threads):
    folder = f"out{ranks}{threads}"
    done = run(solved, ranks, "case.nml", "--output", folder, "--threads", threads)
    assert done.code == NUMERICAL
    assert said(done) == solved.reference.err.splitlines()
    assert done.out.replace(folder, "ref") == solved.reference.out
    same_files(solved.folder / folder, solved.folder / "ref")


def test_structures(vcor):
    """Impacts with several contacts, on any number of ranks."""
    (vcor.folder / "modes.csv").write_text("frequency [Hz],damping_ratio,modal_mass [kg]\n900.0,0.1,0.003\n")
    vcor.write(
        "&impact velocity = 1.0 /\n&sphere radius = 0.005, material = 'steel' /\n"
        "&plate material = 'steel' /\n&target body = 'modes', file = 'modes.csv' /\n"
        "&material name = 'steel', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3,\n"
        "   density = 7850 /\n"
        "&sweep parameter = 'impact.velocity', values = 0.5, 1.0, 1.5, 2.0 /\n"
    )
    assert vcor("run", "case.nml", "--output", "ref", "--quiet").code == SUCCESS
    done = run(vcor, 3, "case.nml", "--output", "out", "--quiet")
    assert done.code == SUCCESS, done.err
    same_files(vcor.folder / "out", vcor.folder / "ref")


def test_one_voice(vcor):
    vcor.write(SLS)
    done = end(start(vcor, "-n", 2, program(), "--version"))
    assert (done.code, done.out.count("\n"), done.err) == (SUCCESS, 1, "")
    done = run(vcor, 2, "case.nml", "--print", "cor")
    assert (done.code, done.out.count("\n"), done.err.count("\n")) == (SUCCESS, 1, 1)
    assert "case.nml: validity outside: " in done.err
    vcor.write(SLS + "&sweep parameter = 'impact.velocity', values = 1, 2, 3 /\n")
    done = run(vcor, 3, "case.nml", "--print", "cor")
    assert (done.code, done.out.count("\n"), done.err.count("\n")) == (SUCCESS, 3, 1)
    assert "case.nml: validity: 3 of 3 points caution" in done.err


@pytest.mark.parametrize(
    "words, code, says",
    [
        (["case.nml", "--bogus"], USAGE, "unknown option '--bogus'"),
        (["none.nml"], FILE, "none.nml"),
        (["bad.nml"], INPUT, "bad.nml:"),
        (["stuck.nml"], NUMERICAL, "stuck.nml: the sphere sticks"),
    ],
)
def test_same_error_everywhere(vcor, words, code, says):
    vcor.write(SLS)
    vcor.write(SLS.replace("velocity = 10.0", "velocity = -1.0"), "bad.nml")
    stuck = SLS.replace("alpha = 300.0", "alpha = 0.0").replace("beta = 1200.0", "beta = 1.0e6")
    vcor.write(stuck.replace("half_thickness = 0.02", "half_thickness = 0.02\n   waves = 'none'"),
               "stuck.nml")
    done = run(vcor, 2, *words)
    assert done.code == code
    assert len(said(done)) == 1
    assert said(done)[0].startswith("vcor: error: ") and says in done.err


def test_error_of_another_rank(vcor):
    """The second rank finds no case where it looks, the third one another case."""
    vcor.write(sweep_text(100))
    (vcor.folder / "elsewhere").mkdir()
    words = ["-n", 1, program(), "run", "case.nml", ":", "-n", 1, "--wdir", "elsewhere"]
    done = end(start(vcor, *words, program(), "run", "case.nml"))
    assert done.code == FILE
    assert len(said(done)) == 1
    assert said(done)[0].startswith("vcor: error: rank 1: case.nml: ")
    vcor.write(sweep_text(200), "elsewhere/case.nml")
    done = end(start(vcor, *words, program(), "run", "case.nml"))
    assert done.code == INPUT
    assert len(said(done)) == 1 and "not all ranks read the same case" in said(done)[0]
    assert not list(vcor.folder.glob("**/*.h5"))


def processes(parent):
    """Ranks below a call of mpirun."""
    tasks = Path(f"/proc/{parent}/task").glob("*/children")
    return sorted(int(word) for task in tasks for word in task.read_text().split())


def begin_and_wait(vcor, ranks, known, *words):
    """Begin a run, and wait until it has more points than are known."""
    process = start(vcor, "-n", ranks, program(), "run", "case.nml", "--output", "out", *words)
    part = vcor.folder / "out" / PART
    while not part.exists() or done_in(part) <= known:
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    return process


def test_killed_ranks(tmp_path):
    """All ranks end, whichever is killed, and what they did is not lost: the next run goes on."""
    long = with_reference(tmp_path, 4.5, "--quiet")
    part, done = long.folder / "out" / PART, 0
    for number, victim in itertools.product([signal.SIGKILL, signal.SIGTERM], [0, 1]):
        process = begin_and_wait(long, 2, done, "--resume")
        ranks = processes(process.pid)
        assert len(ranks) == 2
        os.kill(ranks[victim], number)
        assert end(process).code != SUCCESS
        for rank in ranks:
            assert not Path(f"/proc/{rank}/exe").exists()
        assert done_in(part) > done
        done = done_in(part)
        assert {path.name for path in part.parent.iterdir()} == {PART}
    assert run(long, 3, "case.nml", "--output", "out", "--resume", "--quiet").code == NUMERICAL
    same_files(long.folder / "out", long.folder / "ref")


SCRIPT = """
    mkdir disk
    mount -t tmpfs -o size=200k tmpfs disk || exit 77
    shift
    "$@"
    code=$?
    ls -A disk
    exit $code
"""


def test_full_disk(solved):
    words = ["-n", 2, program(), "run", "case.nml", "--output", "disk"]
    done = end(start(solved, *words, wrapper=["unshare", "-rm", "sh", "-c", SCRIPT, "sh", "--"]))
    if done.code in {1, 77} and "vcor" not in done.err:
        pytest.skip(f"no disk can be mounted here: {done.err.strip()}")
    assert done.code == FILE
    assert len(said(done)) == 1 and "No space left on device" in said(done)[0]


def test_different_commands(vcor):
    """They end with an error instead of waiting for each other."""
    vcor.write(SLS)
    vcor.write(SLS, "other.nml")
    run_one = [program(), "run", "case.nml"]
    for other in (["check", "case.nml"], ["run", "other.nml"], ["run", "case.nml", "--quiet"]):
        done = end(start(vcor, "-n", 1, *run_one, ":", "-n", 1, program(), *other))
        assert done.code == USAGE
        assert len(said(done)) == 1 and "same command line" in said(done)[0]
    words = ["--threads", 1, ":", "-n", 1, *run_one, "--threads=2"]
    assert end(start(vcor, "-n", 1, *run_one, *words)).code == SUCCESS
