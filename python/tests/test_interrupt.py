"""Ctrl-C: every call of the library ends at once, whatever the library is doing."""

import os
import subprocess
import sys

import numpy as np
import pytest

import vcor

# The library, whose calls sleep for a long time; SIGINT comes when one does. What describes
# columns and addresses ends at once, and is called where it is asked.
SCRIPT = """
import ctypes, os, signal, sys, threading, warnings
import vcor
from vcor import _library

warnings.simplefilter("ignore", vcor.ValidityWarning)
case = vcor.read(sys.argv[1])
case.solve()
sleep = ctypes.CDLL(None).sleep
begun = threading.Event()

class Asleep:
    def __getattr__(self, name):
        if name in (*_library._QUICK, "vcor_column_of"):
            return getattr(library, name)
        def function(*_):
            begun.set()
            return sleep(1000)
        return function

def interrupt():
    begun.wait()
    os.kill(os.getpid(), signal.SIGINT)

library, _library._library = _library._library, Asleep()
threading.Thread(target=interrupt, daemon=True).start()
MASK
try:
    CALL
except KeyboardInterrupt:
    print("interrupted")
# what comes next does not wait for it
_library._library = library
print(case["impact.velocity"], case.solve(quantities=["cor"])["cor"])
"""
# A signal just before a wait does not end it: as here, where another thread receives it
UNHEARD = "signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})"


@pytest.mark.parametrize(("call", "mask"), [
    ("case.run()", ""), ("case.history()", ""), ("case.verify()", ""), ("case.text()", ""),
    ("case.points({'impact.velocity': [1.0, 2.0, 3.0]}, progress=False)", ""),
    ("case.history()", UNHEARD),
])  # fmt: skip
def test_ctrl_c(sls, call, mask):
    # the limit is far below the sleep of the library, and far above what a busy machine needs
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.replace("CALL", call).replace("MASK", mask), sls.name],
        capture_output=True, encoding="utf-8", timeout=400, check=False,
    )  # fmt: skip
    assert done.stderr == ""
    assert done.stdout.split() == ["interrupted", "10.0", str(sls.solve()["cor"])]
    assert done.returncode == 0


# A comparison of some seconds, and calls when it has begun to solve: their time is that of the
# processor, which does not depend on what else the machine does
BESIDE = """
import sys, threading, time, warnings
import vcor

warnings.simplefilter("ignore", vcor.ValidityWarning)
case = vcor.read(sys.argv[1])
long = case.copy()
long["solver.method"], long["solver.time_step"] = "direct", 3e-8
used = []

def compare():
    long.verify()
    used.append(time.thread_time())

thread = threading.Thread(target=compare)
thread.start()
clock = time.pthread_getcpuclockid(thread.ident)
while time.clock_gettime(clock) < 0.05:
    time.sleep(0.001)
before = time.clock_gettime(clock)
case["impact.velocity"] = 10.0
status = case.solve(quantities=["status"])["status"]
meanwhile = time.clock_gettime(clock) - before
thread.join()
print(status, meanwhile < used[0]/2, "of", used[0], meanwhile)
"""


def test_other_calls_do_not_wait_for_a_comparison(sls):
    done = subprocess.run(
        [sys.executable, "-c", BESIDE, sls.name],
        capture_output=True, encoding="utf-8", timeout=400, check=False,
    )  # fmt: skip
    assert (done.stdout.split()[:2], done.stderr) == (["separated", "True"], "")


def test_the_first_part_is_one_point_a_thread(sls, monkeypatch):
    """The time of a point is unknown before one is solved."""
    solve, lengths = vcor.Case._solve, []

    def watched(self, addresses, values, names, threads):
        lengths.append(len(values))
        return solve(self, addresses, values, names, threads)

    monkeypatch.setattr(vcor.Case, "_solve", watched)
    velocities = np.linspace(1.0, 2.0, 30)
    sls.points({"impact.velocity": velocities}, threads=2, progress=False)
    assert lengths[0] == 2
    assert sum(lengths) == 30
    sls.points({"impact.velocity": velocities}, progress=False)
    assert len(os.sched_getaffinity(0)) in lengths


def test_a_case_lives_as_long_as_a_call():
    """A call that was interrupted still has its case."""
    case = vcor.Case({"case": {"title": "x"}})
    handle = case._pointer
    del case
    assert handle and vcor._library.text_of("vcor_get", handle, "case.title") == "'x'"


def test_child_of_fork(sls):
    """It has no threads, and starts one."""
    sls.solve()
    if not (child := os.fork()):
        ok = vcor._library._worker is None and sls.solve()["status"] == "separated"
        os._exit(0 if ok else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


@pytest.mark.parametrize("word", ["x", "-1", "0", "2.5", "1025", "9" * 400, "٣x"])
def test_threads_of_slurm(sls, monkeypatch, word):
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", word)
    with pytest.raises(vcor.UsageError, match=r"^SLURM_CPUS_PER_TASK: found .*1 to 1024"):
        sls.points({"impact.velocity": [1.0]})
    with pytest.raises(vcor.UsageError, match="^SLURM_CPUS_PER_TASK"):
        sls.run()
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", " 2 ")
    assert float(sls.points({"impact.velocity": [10.0]}).cor[0]) == sls.solve()["cor"]


@pytest.mark.parametrize("threads", [0, -1, 1025, 2**70, 1.5, "2", None.__class__])
def test_threads(sls, threads):
    for call in (sls.run, lambda **more: sls.points({"impact.velocity": [1.0]}, **more)):
        with pytest.raises(vcor.UsageError, match="^threads: found .*1 to 1024"):
            call(threads=threads)
