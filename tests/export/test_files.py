"""How files are written: as a whole or not at all."""

import os
import subprocess

import pytest
from conftest import CASE

NAMES = {"sls_summary.csv", "sls.csv", "sls.h5"}


def names(folder):
    return {path.name for path in folder.iterdir()}


def one_line(done):
    """The error message, which is all there is on stderr."""
    assert done.stderr.startswith("vcor: error: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


def test_names(folder):
    assert names(folder) == NAMES


def test_parents_are_made(run, tmp_path):
    below = tmp_path / "a" / "b" / "c"
    assert run(f"{below}/").returncode == 0
    assert names(below) == NAMES


def test_old_files_are_replaced(run, tmp_path):
    for name in NAMES:
        (tmp_path / name).write_text("old")
    assert run(tmp_path).returncode == 0
    assert names(tmp_path) == NAMES
    assert all((tmp_path / name).stat().st_size > 100 for name in NAMES)


def test_umask(run, tmp_path):
    mask = os.umask(0o022)
    try:
        assert run(tmp_path).returncode == 0
    finally:
        os.umask(mask)
    for name in NAMES:
        assert (tmp_path / name).stat().st_mode & 0o777 == 0o644


def test_link_is_replaced(run, tmp_path):
    target = tmp_path / "target"
    target.write_text("old")
    out = tmp_path / "out"
    out.mkdir()
    (out / "sls.csv").symlink_to(target)
    assert run(out).returncode == 0
    assert not (out / "sls.csv").is_symlink()
    assert target.read_text() == "old"


def test_link_to_a_full_disk(run, tmp_path):
    (tmp_path / "sls_summary.csv").symlink_to("/dev/full")
    done = run(tmp_path)
    assert done.returncode == 4
    assert "sls_summary.csv" in one_line(done)


def test_directory_in_the_way(run, tmp_path):
    (tmp_path / "sls.h5").mkdir()
    done = run(tmp_path)
    assert done.returncode == 4
    assert "sls.h5" in one_line(done)
    assert (tmp_path / "sls.h5").is_dir()
    assert not list(tmp_path.glob(".vcor-*"))


def test_file_instead_of_the_folder(run, tmp_path):
    path = tmp_path / "file"
    path.write_text("old")
    done = run(path)
    assert done.returncode == 4
    assert str(path) in one_line(done)
    assert path.read_text() == "old"


def test_folder_that_cannot_be_made(run):
    done = run("/proc/vcor")
    assert done.returncode == 4
    assert "/proc/vcor" in one_line(done)


def test_full_standard_output(vcor, tmp_path):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [vcor, "run", str(CASE), "--output", str(tmp_path)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=600,
        )
    assert done.returncode == 4
    assert "No space left on device" in one_line(done)


def test_disk_that_ends_within_a_file(vcor, tmp_path):
    """A disk of two pages, seen by the processes of this test only."""
    script = """
        mount -t tmpfs -o size=8k tmpfs "$1" || exit 77
        echo old > "$1/sls.h5"
        "$2" run "$3" --output "$1"
        code=$?
        ls -A "$1"
        cat "$1/sls.h5"
        exit $code
    """
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", script, "sh", str(tmp_path), vcor, str(CASE)],
        capture_output=True,
        text=True,
        timeout=600,
    )
    if done.returncode in {1, 77} and "vcor" not in done.stderr:
        pytest.skip(f"no disk can be mounted here: {done.stderr.strip()}")
    assert done.returncode == 4
    assert "No space left on device" in one_line(done)
    assert done.stdout.endswith("old\n")
    assert ".vcor-" not in done.stdout
