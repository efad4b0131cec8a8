"""Sweeps that are interrupted and go on."""

import csv
import os
import pty
import random
import re
import shutil
import signal
import struct
import subprocess
import time

import pytest
from cases import SLS
from long_sweep import (
    FILES,
    PART,
    begin,
    done_in,
    interrupted,
    same_files,
    stopped_at,
    sweep_text,
    wait_for,
    write_long_sweep,
)
from program import EVERYTHING, FILE, NAMES, NUMERICAL, USAGE, Vcor, complaint, long_tests, program


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """A sweep that is long enough to be interrupted at some time, and its undisturbed files in the folder ref."""
    vcor = Vcor(tmp_path_factory.mktemp("long"))
    write_long_sweep(vcor, 1.6)
    vcor.reference = vcor("run", "case.nml", "--output", "ref")
    assert vcor.reference.code == NUMERICAL
    return vcor


@pytest.fixture(scope="module")
def cut(solved):
    """What a run leaves that has most of the points, so that the rest takes no time: bytes of its
    file."""
    # a line has 17 bytes for each column
    points = (solved.folder / "ref" / "case_summary.csv").read_text().count("\n")
    part = stopped_at(solved, points * 17 * len(NAMES) * 3 // 4, "cut")
    data = part.read_bytes()
    shutil.rmtree(part.parent)
    return data


@pytest.fixture
def left(long, cut):
    """The file of such a run in the folder of results."""
    part = long.folder / "out" / PART
    part.parent.mkdir()
    part.write_bytes(cut)
    return part


@pytest.fixture
def few(left, vcor):
    """The same with the first lines of points, and nothing else in the folder of the test, so that
    a file that is refused takes no time to read; its path, and the program there."""
    bare = Vcor(vcor.folder / "few")
    part = bare.folder / "out" / PART
    part.parent.mkdir(parents=True)
    part.write_bytes(b"".join(left.read_bytes().splitlines(keepends=True)[:100]))
    shutil.copy(vcor.folder / "case.nml", bare.folder)
    return part, bare


@pytest.fixture
def long(vcor, solved):
    """The same in the folder of the test."""
    shutil.copytree(solved.folder, vcor.folder, dirs_exist_ok=True)
    vcor.reference = solved.reference
    return vcor


@pytest.fixture
def short(vcor):
    """A sweep that is too short for a file of points."""
    write_long_sweep(vcor, 0.1)
    return vcor


def untimed(text):
    """Without the line that says how long it takes, which a busy machine has."""
    return re.sub(r"(?m)^vcor: note: \d+ of \d+ points, .* left\n", "", text)


def finish(vcor, *words):
    """Resume; the screen is that of the undisturbed run, unless there is none with --quiet."""
    done = vcor("run", "case.nml", "--output", "out", "--resume", *words)
    assert done.code == NUMERICAL
    if "--quiet" not in words:
        assert untimed(done.err) == untimed(vcor.reference.err)
        assert done.out.replace("out/", "ref/") == vcor.reference.out
    same_files(vcor.folder / "out", vcor.folder / "ref")


KILLS = int(os.environ.get("VCOR_KILLS", "20" if EVERYTHING else "3"))


def test_kill_at_random(long):
    """At any time nothing of the file is lost, and the results are the same."""
    part = long.folder / "out" / PART
    done = 0
    for number in range(KILLS):
        threads = ["--threads", random.choice("12")]
        process = begin(long, "--resume", "--quiet", *threads)
        if number % 2:
            time.sleep(random.uniform(0.0, 1.0))
        else:
            while process.poll() is None and not part.exists():
                time.sleep(0.01)
            time.sleep(random.uniform(0.0, 0.4))
        process.send_signal(random.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
        process.communicate()
        if process.returncode == NUMERICAL:
            same_files(long.folder / "out", long.folder / "ref")
            shutil.rmtree(long.folder / "out")
            done = 0
        elif part.exists():
            now = done_in(part)
            assert now >= done
            done = now
    finish(long)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal(long, number):
    """The run ends as the signal does; the points are kept as bits."""
    code, out, err = interrupted(long, number)
    assert (code, out, err) == (-number, "", "")
    part = long.folder / "out" / PART
    assert {path.name for path in part.parent.iterdir()} == {PART}
    # the signal may come within a line, which the next run leaves out
    head, *lines = part.read_text().rpartition("\n")[0].splitlines()
    version = long("--version").out.split()[1]
    assert head.startswith(f"# vcor {version} ") and len(head.split()[3]) == 8
    rows = (long.folder / "ref" / "case_summary.csv").read_text().splitlines()
    rows = [row for row in rows if not row.startswith("#")]
    column = rows[0].split(",").index("cor")
    for line in lines[:50]:
        place, *bits = line.split()
        assert all(len(word) == 16 for word in bits)
        cor = float(rows[int(place)].split(",")[column])
        assert cor != cor or bits[0] == struct.pack(">d", cor).hex()
    finish(long, *["--quiet"] * (number == signal.SIGTERM))


def test_torn_last_line(long, left):
    part, data = left, left.read_bytes()
    end = data.rindex(b"\n", 0, len(data) - 1)
    for cut in (end + 2, len(data) - 1, 9, 0):
        part.write_bytes(data[:cut])
        shutil.copytree(long.folder / "out", long.folder / "kept")
        if cut in (end + 2, 9):
            finish(long, "--quiet")
        else:
            process = begin(long, "--resume", "--quiet")
            time.sleep(0.3)
            process.kill()
            process.communicate()
        shutil.rmtree(long.folder / "out")
        (long.folder / "kept").rename(long.folder / "out")
        part.write_bytes(data)


def test_damage(few):
    """Other damage is an error of one line, which names the line of the file."""
    part, bare = few
    data = part.read_bytes()
    first = data.index(b"\n") + 1
    length = data.index(b"\n", first) + 1 - first
    words = ["run", "case.nml", "--output", "out", "--resume"]
    whole = bytearray(data)
    harms = {
        "an index of no point": (first, b"9999999999"),
        "no index": (first, b"  what?   "),
        "no digit": (first + length + 12, b"x"),
        "a status that is none": (first + length - 1 - 2 * 17, b"7ff0000000000000"),
        "a pending point": (first + length - 1 - 2 * 17, b"bff0000000000000"),
        "no end of a line": (first + length - 1, b" "),
        "zeros": (first + 20, bytes(300)),
        "a byte too many": (first + 20, None),
    }
    for what, (place, harm) in harms.items():
        part.write_bytes(
            whole[:place] + b"0" + whole[place:]
            if harm is None
            else whole[:place] + harm + whole[place + len(harm) :]
        )
        before = part.read_bytes()
        bare.refuses(*words, code=FILE, says=[f"out/{PART}", "damaged in line", "delete"])
        assert part.read_bytes() == before, what
    # what is written well may still be wrong
    rows = whole[first:].split(b"\n")
    number = rows[2][:10].decode().strip()
    separated = next(i for i, row in enumerate(rows) if row[:10].strip() and status_of(row) == 0.0)
    cor = slice(11, 27)
    nan = bytearray(rows[separated])
    nan[cor] = b"7ff8000000000000"
    for what, place, row, says in (
        ("a point twice", 3, rows[2], f"it is the second line of point {number}"),
        ("no result", separated, nan, "has separated without a result"),
        ("too few points", 1, b"9999999999" + rows[1][10:], "has no point 9999999999"),
    ):
        changed = [*rows]
        changed[place] = checked(row)
        part.write_bytes(whole[:first] + b"\n".join(changed))
        says = ["damaged in line " + str(place + 2), says]
        if what != "too few points":  # which is no whole number of the program
            bare.refuses(*words, code=FILE, says=[f"out/{PART}", *says])
    part.write_bytes(b"what?" * 1000)
    bare.refuses(*words, code=FILE, says=[f"out/{PART}", "not of this case and version", "what?"])


def checked(row):
    """A line of a point with the check sum that belongs to it."""
    place, *words = row.split()[:-1]
    check = int(place)
    for word in words:
        check = (check << 1 | check >> 63) & (2**64 - 1) ^ int(word, 16)
    return bytes(row[: row.rindex(b" ")]) + b" %016x" % check


def status_of(row):
    """Number of the status, the last but one of a line."""
    return struct.unpack(">d", bytes.fromhex(row.split()[-3].decode()))[0]


def test_any_wrong_bit(long, left, few):
    """Each flipped bit is refused, or the results are the same: of a line that is torn."""
    part, bare = few
    # a few points are enough, so that the rest of a sweep need not be solved again and again
    lines = part.read_bytes().split(b"\n")
    data = b"\n".join([*lines[:3], lines[3][:40]])
    end = len(data) - 40
    draw = random.Random(1)
    every = [*range(0, 60, 7), *draw.sample(range(60, end), 40), end - 1]
    for place in every:
        bit = draw.randrange(8)
        flipped = bytearray(data)
        flipped[place] ^= 1 << bit
        part.write_bytes(flipped)
        words = ["damaged in line"] if place >= len(lines[0]) else ["not of this case and version"]
        if place == len(lines[0]):
            words = []
        bare.refuses("run", "case.nml", "--output", "out", "--resume", code=FILE,
                     says=[f"out/{PART}", *words])  # fmt: skip
        assert part.read_bytes() == flipped, (place, bit)
    # of the torn line nothing is read
    flipped = bytearray(left.read_bytes().rpartition(b"\n")[0][:-30])
    flipped[-5] ^= 1
    left.write_bytes(flipped)
    finish(long, "--quiet")


def test_other_columns(few):
    """A program with other columns refuses the file, and names the first one that differs."""
    part, bare = few
    data = part.read_bytes()
    words = ["run", "case.nml", "--output", "out", "--resume"]
    for old, new, says in (
        (b" cor cor_sphere ", b" cor_sphere cor ", "its column 1 is 'cor_sphere', expected 'cor'"),
        (b" cor cor_sphere ", b" cor mass cor_sphere ", "its column 2 is 'mass', expected 'cor_sphere'"),
        (b" cor cor_sphere ", b" cor ", "its column 2 is "),
        (b",caution,", b",", "its column "),
        (b"\n", b" mass\n", "expected "),
    ):
        part.write_bytes(data.replace(old, new, 1))
        bare.refuses(*words, code=FILE, says=[f"out/{PART}", "not of this case and version", says])


def test_another_case(few):
    """Of another case, sweep or version: refused, and the file stays."""
    part, bare = few
    data = part.read_bytes()
    words = ["run", "case.nml", "--output", "out"]
    says = [f"out/{PART}", "not of this case and version"]
    bare.refuses(*words, "--resume", "--set", "rubber.beta=900", code=FILE, says=says)
    case = (bare.folder / "case.nml").read_text()
    bare.write(case.replace("stop = 50.0", "stop = 40.0"))
    bare.refuses(*words, "--resume", code=FILE, says=says)
    bare.write(case)
    part.write_bytes(data.replace(b"# vcor ", b"# vcor 0", 1))
    bare.refuses(*words, "--resume", code=FILE, says=says)
    part.write_bytes(data)
    # without --resume any is refused
    bare.refuses(*words, code=FILE, says=[f"out/{PART}", "--resume", "delete"])
    assert part.read_bytes() == data


def test_other_data(vcor, data_files):
    """The points of a data file belong to the case."""
    assert data_files is None
    name = "soft_rubber_data.csv"
    text = sweep_text(30).split("&material\n   name = 'rubber'")[0]
    vcor.write(
        text
        + "&material\n   name = 'rubber', model = 'table', density = 1100.0, poisson_ratio = 0.5,\n"
        + f"   file = '{name}', modulus_unit = 'MPa'\n/\n"
        + "&sweep\n   parameter = 'impact.velocity'\n   values = 1, 2\n/\n"
    )
    vcor.write("of another\n", PART)
    data = vcor.folder / name
    expected = []
    for _ in range(2):
        done = vcor("run", "case.nml", "--resume")
        complaint(done, FILE, "not of this case and version")
        expected.append(done.err.split("expected '")[1])
        data.write_text("\n".join(data.read_text().splitlines()[:-1]) + "\n")
    assert expected[0] != expected[1]


def test_resume_of_nothing(vcor):
    vcor.write(sweep_text(30))
    words = ["run", "case.nml", "--output", "out", "--resume", "--quiet"]
    assert vcor(*words).code == NUMERICAL
    assert sorted(path.name for path in (vcor.folder / "out").iterdir()) == FILES
    before = {name: (vcor.folder / "out" / name).read_bytes() for name in FILES}
    # once more: the results are replaced
    assert vcor(*words).code == NUMERICAL
    assert before == {name: (vcor.folder / "out" / name).read_bytes() for name in FILES}
    vcor.write(SLS)
    vcor.succeeds(*words)


def test_resume_needs_files(vcor):
    vcor.write(sweep_text(30))
    vcor.refuses("run", "case.nml", "--print", "cor", "--resume", code=USAGE, says="--output")
    vcor.refuses("run", "case.nml", "--resume=yes", code=USAGE, says="--resume takes no value")
    vcor.refuses("check", "case.nml", "--resume", code=USAGE, says="--resume")


def test_no_files(short):
    """Without files of results there is none of finished points."""
    done = short("run", "case.nml", "--print", "cor", "--threads", "1", "--quiet")
    assert done.code == NUMERICAL
    assert not list(short.folder.glob("*.part"))


def test_two_at_once(long):
    """Of two runs of one sweep one has it, and the other says so; the results are whole."""
    both = [begin(long, "--quiet") for _ in range(2)]
    said = [process.communicate()[1] for process in both]
    codes = [process.returncode for process in both]
    assert FILE in codes, said
    line = said[codes.index(FILE)]
    assert line.count("\n") == 1 and line.startswith("vcor: error: 'out/case")
    if NUMERICAL in codes:
        same_files(long.folder / "out", long.folder / "ref")
    else:
        finish(long, "--quiet")


def test_at_work(long, left):
    """A sweep that another run is at is not begun."""
    before = done_in(left)
    process = begin(long, "--resume", "--quiet")
    while done_in(left) <= before:
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED)
    long.refuses("run", "case.nml", "--output", "out", code=FILE, says=[f"out/{PART}", "--resume"])
    process.send_signal(signal.SIGCONT)
    assert process.wait(timeout=600) == NUMERICAL
    process.communicate()
    same_files(long.folder / "out", long.folder / "ref")


# A disk that is too small for the points, or for the results

SCRIPT = """
    mkdir disk
    mount -t tmpfs -o size=$1 tmpfs disk || exit 77
    "$2" run case.nml --output disk --threads 1 --quiet
    echo $?
    ls -A disk
    echo --
    mount -o remount,size=500m disk
    "$2" run case.nml --output disk --quiet --resume 2>resumed
    echo $?
    mkdir out
    cp disk/* out
"""


# The first two end while the points are solved, the last one with the results
@pytest.mark.parametrize("bytes_per_point", [10, 600, 900, *long_tests(250)])
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


def test_progress(vcor):
    write_long_sweep(vcor, 1.0)
    text = on_terminal(vcor)
    assert text.count("\n") == 1  # that of the error
    lines = text.split("\r")
    shown = [line for line in lines if "points, " in line and "left" in line]
    assert len(shown) > 2
    for line in shown:
        assert " of " in line and " %, " in line and ("/s, " in line or "/min, " in line)
    # nothing of it is left
    assert lines[-2].strip().startswith("vcor: error: ") or lines[-1].strip() == ""
    assert text.split("vcor: error")[0].endswith("\r")


def test_a_log_is_told_once(vcor):
    """Where stderr is no terminal one line says how long it takes, unless that is short."""
    write_long_sweep(vcor, 100.0)
    process = begin(vcor)
    line = process.stderr.readline()
    assert re.fullmatch(r"vcor: note: \d+ of \d+ points, \d+ %, \d+/s, \d+:\d\d:\d\d left\n", line)
    process.send_signal(signal.SIGINT)
    assert process.communicate() == ("", "")
    process = begin(vcor, "--quiet", folder="quiet")
    # the line would come with the file of points
    part = vcor.folder / "quiet" / PART
    wait_for(part, process)
    first = done_in(part)
    while done_in(part) <= first:
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    assert process.communicate() == ("", "")


def test_no_progress(short, solved):
    assert on_terminal(short, "--quiet").startswith("vcor: error: ")
    assert "\r" not in solved.reference.err


def struck_twice(count):
    """A sweep over impacts of two contacts each."""
    return (
        "&impact velocity = 1.0 /\n&sphere radius = 0.005, material = 'steel' /\n"
        "&plate material = 'steel' /\n&target body = 'modes', file = 'modes.csv' /\n"
        "&material name = 'steel', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3,\n"
        "   density = 7850 /\n"
        f"&sweep parameter = 'impact.velocity', start = 0.5, stop = 2.0, count = {count} /\n"
    )


def test_structures(vcor):
    """Impacts with several contacts go on where they were; another list of modes is another case."""
    modes = vcor.folder / "modes.csv"
    modes.write_text("frequency [Hz],damping_ratio,modal_mass [kg]\n900.0,0.1,0.003\n")
    write_long_sweep(vcor, 1.6, struck_twice)
    vcor("run", "case.nml", "--output", "ref", "--quiet")
    rows = (vcor.folder / "ref" / "case_summary.csv").read_text().splitlines()
    rows = csv.DictReader(row for row in rows if not row.startswith("#"))
    assert {row["contacts"] for row in rows} == {"2"}
    interrupted(vcor)
    text = modes.read_text()
    modes.write_text(text.replace("900", "901"))
    done = vcor("run", "case.nml", "--output", "out", "--resume")
    assert done.code == FILE and PART in done.err
    modes.write_text(text)
    vcor.succeeds("run", "case.nml", "--output", "out", "--resume", "--quiet")
    same_files(vcor.folder / "out", vcor.folder / "ref")
