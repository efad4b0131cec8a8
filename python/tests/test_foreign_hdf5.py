"""HDF5 files of unknown origin: results, or an error of one line, in seconds."""

import os
import shutil
import struct

import h5py
import numpy as np
import pytest
from conftest import SWEEPS

import vcor
from vcor import results
from vcor.plot import figure


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    """Results of a sweep, changed by another program."""
    import subprocess

    folder = tmp_path_factory.mktemp("sweep")
    words = ["run", SWEEPS / "sls_velocity.nml", "--quiet", "--set", "output.stem=s"]
    subprocess.run([os.environ["VCOR"], *map(str, words)], cwd=folder, check=True)
    with h5py.File(folder / "s.h5", "r+") as file:
        file.attrs["changed"] = 1
    return folder / "s.h5"


@pytest.fixture
def copy(sweep, tmp_path):
    shutil.copy(sweep, tmp_path / "copy.h5")
    return tmp_path / "copy.h5"


def test_a_foreign_file_is_read(sweep):
    assert vcor.open(sweep).cor.dims == ("impact.velocity",)


def test_a_file_of_version_2_0_0(copy):
    """It has no columns of structures: it is read and drawn as it is."""
    with h5py.File(copy, "r+") as file:
        for name in (
            "contacts",
            "last_separation",
            "structure_energy",
            "highest_mode",
            "bounces",
            "bouncing_time",
            "bouncing_time_error",
            "bounces_end",
        ):
            del file["summary"][name]
        file.attrs["version"] = "2.0.0"
    found = vcor.open(copy)
    assert "cor" in found and "contacts" not in found
    assert len(figure([copy]).axes) > 0


def test_links_to_other_files(copy, tmp_path):
    (tmp_path / "secret.bin").write_bytes(struct.pack("<8d", *range(8)))
    with h5py.File(copy, "r+") as file:
        file["summary/here"] = h5py.SoftLink("/summary/cor")
    assert "cor" in vcor.open(copy)
    with h5py.File(copy, "r+") as file:
        file["summary/there"] = h5py.ExternalLink("other.h5", "/summary/cor")
    with pytest.raises(vcor.InputError, match="copy.h5: 'there' is a link to another file"):
        vcor.open(copy)


@pytest.mark.parametrize("way", ["external", "virtual"])
def test_data_in_other_files(copy, tmp_path, way):
    secret = tmp_path / "secret.h5"
    with h5py.File(secret, "w") as file:
        file["x"] = np.arange(400.0)
    with h5py.File(copy, "r+") as file:
        n = file["summary/cor"].shape
        del file["summary/cor"]
        if way == "external":
            file["summary"].create_dataset("cor", n, "<f8", external=[(str(secret), 0, 3200)])
        else:
            layout = h5py.VirtualLayout(n, "<f8")
            layout[:] = h5py.VirtualSource(str(secret), "x", (400,))[: n[0]]
            file["summary"].create_virtual_dataset("cor", layout)
    with pytest.raises(vcor.InputError, match="the data of 'cor' are in another file"):
        vcor.open(copy)
    pytest.importorskip("matplotlib")
    from vcor import plot

    with pytest.raises(vcor.InputError, match="the data of 'cor' are in another file"):
        plot.figure([copy])


def test_a_shape_of_its_own(copy):
    with h5py.File(copy, "r+") as file:
        del file["summary/cor"]
        file["summary/cor"] = np.zeros(3)
    with pytest.raises(vcor.FileError, match="damaged: the columns of 'summary' have dimensions"):
        vcor.open(copy)


def test_shapes_larger_than_the_file(copy):
    with h5py.File(copy, "r+") as file:
        file["summary"].create_dataset("huge", (10**12,), "<f8", chunks=(1000,))
    with pytest.raises(vcor.FileError, match="'huge' has 8000000000000 bytes, more than the file"):
        vcor.open(copy)


def test_hdf5_that_does_not_end_or_crashes(copy, monkeypatch):
    """The child process that tries the file ends at its limit or by a fault; the parent goes on."""
    monkeypatch.setattr(results, "_PATIENCE", 1)
    for harm in (lambda *_: [None for _ in iter(int, 1)], lambda *_: os.kill(os.getpid(), 11)):
        monkeypatch.setattr(results, "_datasets", harm)
        with pytest.raises(vcor.FileError, match="copy.h5: this file is damaged: HDF5 cannot read"):
            vcor.open(copy)
