"""Damaged HDF5 files end with one line, or with the right results."""

import os

import h5py
import pytest
from damage import SHARDS, TARGETS, make_files, trials
from program import FILE, NUMERICAL, SUCCESS, Vcor


@pytest.fixture(scope="module")
def pristine(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pristine")
    make_files(folder)
    return folder


@pytest.mark.parametrize("seed", [1, 2])
def test_damage(pristine, seed):
    found, faults = trials(pristine, 15 * len(TARGETS), seed)
    assert not faults
    assert sum(ends["refused"] for ends in found.values()) > 0


def test_pipe(vcor):
    """Nobody is waited for."""
    os.mkfifo(vcor.folder / "case.h5")
    vcor.refuses("merge", "case.h5", code=FILE, says="expected a file of results")


def test_damaged_shard_is_finished_again(pristine, tmp_path):
    """Of a shard that is finished --resume solves the points that are damaged."""
    vcor = Vcor(tmp_path)
    (tmp_path / "out").mkdir()
    for name in ["case.nml", *SHARDS]:
        (tmp_path / name).write_bytes((pristine / name).read_bytes())
    with h5py.File(tmp_path / SHARDS[0]) as file:
        place = file["summary/cor"].id.get_offset()
    data = bytearray((tmp_path / SHARDS[0]).read_bytes())
    data[place + 15 * 8 + 6] ^= 2
    (tmp_path / SHARDS[0]).write_bytes(data)
    vcor.refuses("merge", *SHARDS, code=FILE, says="--resume")
    done = vcor("run", "case.nml", "--output", "out", "--shard", "1/2", "--resume")
    assert done.code in {SUCCESS, NUMERICAL}
    assert (tmp_path / SHARDS[0]).read_bytes() == (pristine / SHARDS[0]).read_bytes()


def test_points_that_have_changed_places(pristine, tmp_path):
    """A point whose numbers are those of another one is damaged, be they right in themselves."""
    vcor = Vcor(tmp_path)
    (tmp_path / "out").mkdir()
    for name in ["case.nml", *SHARDS]:
        (tmp_path / name).write_bytes((pristine / name).read_bytes())
    data = bytearray((tmp_path / SHARDS[0]).read_bytes())
    with h5py.File(tmp_path / SHARDS[0]) as file:
        for name, column in file["summary"].items():
            if name in {"point", "impact.velocity", "sphere.radius"}:
                continue
            width = column.dtype.itemsize
            one, other = (column.id.get_offset() + place * width for place in (13, 15))
            data[one : one + width], data[other : other + width] = (
                data[other : other + width],
                data[one : one + width],
            )
    (tmp_path / SHARDS[0]).write_bytes(data)
    vcor.refuses("merge", *SHARDS, code=FILE, says="--resume")
    done = vcor("run", "case.nml", "--output", "out", "--shard", "1/2", "--resume")
    assert done.code in {SUCCESS, NUMERICAL}
    assert (tmp_path / SHARDS[0]).read_bytes() == (pristine / SHARDS[0]).read_bytes()
