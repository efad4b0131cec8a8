"""A sweep in shards, merged: the same files as in one piece."""

import shutil
import signal
import zlib

import h5py
import numpy
import pytest
from cases import SLS
from damage import column_place
from long_sweep import PART, interrupted, same_files, sweep_text, write_long_sweep
from program import FILE, NAMES, NUMERICAL, SUCCESS, USAGE, WHOLE

GOOD = SLS + "&sweep\n   parameter = 'impact.velocity'\n   start = 1\n   stop = 9\n   count = 17\n/\n"


def shards(vcor, count, *words, code=SUCCESS):
    """Run all shards; their files."""
    for number in range(1, count + 1):
        done = vcor("run", "case.nml", "--output", "out", "--shard", f"{number}/{count}", *words)
        assert done.code == code, done.err
    paths = [f"out/case_shard_{number}_of_{count}.h5" for number in range(1, count + 1)]
    assert {path.name for path in (vcor.folder / "out").iterdir()} >= {
        path.removeprefix("out/") for path in paths
    }
    return paths


@pytest.mark.parametrize("count", [1, 2, 5, 17])
def test_same_files(vcor, count):
    vcor.write(GOOD)
    vcor.succeeds("run", "case.nml", "--output", "ref")
    paths = shards(vcor, count)
    out = vcor.succeeds("merge", *reversed(paths), "--output", "merged")
    assert "merged/case.h5" in out and "merged/case_summary.csv" in out
    same_files(vcor.folder / "merged", vcor.folder / "ref")
    # once more, and without a word
    assert vcor.succeeds("merge", *paths, "--output", "merged", "--quiet") == ""
    same_files(vcor.folder / "merged", vcor.folder / "ref")


def test_points_without_result(vcor):
    vcor.write(sweep_text(200))
    reference = vcor("run", "case.nml", "--output", "ref")
    assert reference.code == NUMERICAL
    paths = shards(vcor, 2, code=NUMERICAL)
    done = vcor("merge", *paths, "--output", "merged")
    assert done.code == NUMERICAL
    assert done.err.startswith("vcor: error: 20 of 200 points without result: 20 invalid")
    same_files(vcor.folder / "merged", vcor.folder / "ref")


def test_what_a_shard_says(vcor):
    vcor.write(GOOD)
    out = vcor.succeeds("run", "case.nml", "--shard", "2/3")
    assert "6 of 17 impacts of shard 2 of 3" in out
    assert "written ./case_shard_2_of_3.h5" in out
    assert vcor.succeeds("run", "case.nml", "--shard", "2/3", "--quiet") == ""
    with h5py.File(vcor.folder / "case_shard_2_of_3.h5") as file:
        assert list(file["summary/point"]) == [2, 6, 7, 11, 15, 16]
        assert list(file["summary/impact.velocity"]) == [1.5, 3.5, 4.0, 6.0, 8.0, 8.5]
    assert "finished" in vcor.succeeds("run", "case.nml", "--shard", "2/3", "--resume")


@pytest.mark.parametrize("value", ["3/2", "0/2", "1", "1/", "/2", "1/0", "a/b", "1/2/3", "-1/2"])
def test_wrong_shard(vcor, value):
    vcor.write(GOOD)
    vcor.refuses("run", "case.nml", f"--shard={value}", code=USAGE, says=["--shard", "expected"])


def test_shard_of_what(vcor):
    vcor.write(GOOD)
    vcor.refuses("run", "case.nml", "--shard", "1/18", code=USAGE, says=["1/18", "17 points"])
    vcor.refuses("run", "case.nml", "--shard", "1/2", "--print", "cor", code=USAGE, says="--print")
    vcor.write(SLS)
    vcor.refuses("run", "case.nml", "--shard", "1/1", code=USAGE, says="no &sweep group")


def test_refused(vcor):
    vcor.write(GOOD)
    one, two, three = shards(vcor, 3)
    vcor.refuses("merge", one, three, code=FILE, says=["missing: shard 2 of 3;"])
    vcor.refuses("merge", two, code=FILE, says=["missing: shards 1, 3 of 3;"])
    vcor.refuses("merge", one, two, three, two, code=FILE, says=["shard 2 of 3", "once"])
    vcor.refuses("merge", one, two, "out/none.h5", code=FILE, says="out/none.h5")
    vcor.refuses("merge", one, "case.nml", code=FILE, says=["case.nml", "HDF5"])
    vcor.refuses("merge", code=USAGE, says="vcor merge")
    vcor.succeeds("run", "case.nml", "--output", "whole")
    vcor.refuses("merge", "whole/case.h5", code=FILE, says="no shard")
    vcor.succeeds("run", "case.nml", "--output", "other", "--shard", "1/2")
    vcor.refuses("merge", one, "other/case_shard_1_of_2.h5", code=FILE, says="one of 2 shards")
    vcor.succeeds(
        *["run", "case.nml", "--output", "other", "--shard", "2/3", "--set", "rubber.beta=900"]
    )
    other = "other/case_shard_2_of_3.h5"
    says = [other, "another case", "beta = 900"]
    vcor.refuses("merge", one, other, three, code=FILE, says=says)
    shutil.copy(vcor.folder / two, vcor.folder / other)
    with h5py.File(vcor.folder / other, "r+") as file:
        file.attrs["version"] = "0.0.1"
    vcor.refuses("merge", one, other, three, code=FILE, says=[other, "another version", "0.0.1"])
    with h5py.File(vcor.folder / two, "r+") as file:
        file["summary/cor"][3] = 0.5
    vcor.refuses("merge", one, two, three, code=FILE, says=[two, "not finished", "1 of its 6"])


def test_every_bit_of_a_row(vcor):
    """No flip of a single bit of a row passes unseen: each row has another one."""
    places = {name: 32 if name in WHOLE else 64 for name in NAMES} | {"check": 32}
    bits = [(name, bit) for name, count in places.items() for bit in range(count)]
    sweep = f"&sweep parameter = 'impact.velocity' start = 1 stop = 9 count = {len(bits)} /\n"
    vcor.write(SLS + sweep)
    vcor.succeeds("run", "case.nml", "--output", "ref")
    (path,) = shards(vcor, 1)
    shard = vcor.folder / path
    whole = shard.read_bytes()
    data = bytearray(whole)
    for row, (name, bit) in enumerate(bits):
        offset, dtype, _ = column_place(shard, name)
        assert dtype.itemsize * 8 == places[name]
        data[offset + row * dtype.itemsize + bit // 8] ^= 1 << bit % 8
    shard.write_bytes(data)
    vcor.refuses("merge", path, code=FILE, says=f"{len(bits)} of its {len(bits)} points")
    # the sum is the one that others know, of the numbers and of the place, from 1
    shard.write_bytes(whole)
    with h5py.File(shard) as file:
        rows = [file["summary"][name][:] for name in NAMES]
        check = file["summary/check"][:].view(numpy.uint32)
    for row in (0, len(bits) - 1):
        numbers = [column[row] for column in rows] + [numpy.int32(row + 1)]
        assert zlib.crc32(b"".join(number.tobytes() for number in numbers)) == check[row]
    shard.write_bytes(data)
    part = shard.with_name("case_shard_1_of_1.part.h5")
    shard.rename(part)
    vcor.succeeds("run", "case.nml", "--output", "out", "--shard", "1/1", "--resume")
    assert shard.read_bytes() == whole


def test_unfinished_shard(vcor):
    write_long_sweep(vcor, 1.4)
    folder = vcor.folder / "out"
    name = PART.replace("case", "case_shard_1_of_2")
    words = ["--shard", "1/2"]
    shards_done = vcor("run", "case.nml", "--output", "out", "--shard", "2/2", "--quiet")
    assert shards_done.code == NUMERICAL
    code, _, err = interrupted(vcor, signal.SIGINT, "out", *words, name=name)
    assert code == 130, err
    both = [f"out/{name}", "out/case_shard_2_of_2.h5"]
    vcor.refuses("merge", *both, code=FILE, says=[name, "not finished"])
    assert vcor("run", "case.nml", "--output", "out", *words, "--resume").code == NUMERICAL
    assert sorted(path.name for path in folder.iterdir()) == [
        "case_shard_1_of_2.h5",
        "case_shard_2_of_2.h5",
    ]
    both[0] = "out/case_shard_1_of_2.h5"
    assert vcor("merge", *both, "--output", "merged").code == NUMERICAL
    assert vcor("run", "case.nml", "--output", "ref").code == NUMERICAL
    same_files(vcor.folder / "merged", vcor.folder / "ref")
