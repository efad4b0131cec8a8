"""The HDF5 file as its readers see it."""

import subprocess
import time

import h5py
import numpy
import pytest
import xarray
from columns import HISTORY, INTEGERS, SUMMARY, TEXTS

GROUPS = {"summary": (SUMMARY, "impact"), "history": (HISTORY, "time")}


def test_root(hdf5):
    with h5py.File(hdf5) as file:
        assert set(file) == set(GROUPS)
        assert file.attrs["program"] == "vcor"
        assert file.attrs["version"].count(".") == 2
        assert isinstance(file.attrs["title"], str)
        assert "&impact" in file.attrs["case"]


@pytest.mark.parametrize("group", GROUPS)
def test_h5py(hdf5, group):
    columns, dimension = GROUPS[group]
    with h5py.File(hdf5) as file:
        names = list(file[group])
        assert set(names) == set(columns) | {dimension}
        length = len(file[group][dimension])
        for name, unit in columns.items():
            dataset = file[group][name]
            assert dataset.shape == (length,)
            assert dataset.attrs["long_name"]
            if unit == "":
                assert "units" not in dataset.attrs
            elif unit is not None:
                assert dataset.attrs["units"] == unit, name
            if name in TEXTS:
                assert all(isinstance(value, str) for value in dataset.asstr())
            elif name in INTEGERS:
                assert dataset.dtype == numpy.dtype("<i4")
            else:
                assert dataset.dtype == numpy.dtype("<f8")


@pytest.mark.parametrize("group", GROUPS)
def test_dimension_scales(hdf5, group):
    columns, dimension = GROUPS[group]
    with h5py.File(hdf5) as file:
        scale = file[group][dimension]
        assert scale.is_scale
        for name in columns:
            if name != dimension:
                assert list(file[group][name].dims[0].values()) == [scale], name


@pytest.mark.parametrize("group", GROUPS)
def test_order_is_that_of_the_columns(hdf5, group):
    columns, dimension = GROUPS[group]
    with h5py.File(hdf5) as file:
        names = []
        opened = file[group]
        opened.id.links.iterate(
            lambda name: names.append(name.decode()), idx_type=h5py.h5.INDEX_CRT_ORDER
        )
    expected = [name for name in columns if name != dimension]
    assert names == [dimension, *expected]


@pytest.mark.parametrize("group", GROUPS)
def test_xarray(hdf5, group):
    columns, dimension = GROUPS[group]
    with xarray.open_dataset(hdf5, engine="h5netcdf", group=group) as data:
        assert set(data.sizes) == {dimension}
        assert set(data.variables) == set(columns) | {dimension}
        assert dimension in data.coords
        for name, unit in columns.items():
            variable = data[name]
            assert variable.dims == (dimension,)
            # Times stay numbers: xarray makes dates of units such as `seconds`
            if name not in TEXTS:
                assert variable.dtype.kind == ("i" if name in INTEGERS else "f"), name
            else:
                assert all(isinstance(value, str) for value in variable.values)
            if unit:
                assert variable.attrs["units"] == unit


def test_xarray_root(hdf5):
    with xarray.open_dataset(hdf5, engine="h5netcdf") as data:
        assert data.attrs["program"] == "vcor"


def test_xarray_by_label(hdf5):
    with xarray.open_dataset(hdf5, engine="h5netcdf", group="history") as data:
        half = float(data["time"][-1]) / 2
        near = data["force"].sel(time=half, method="nearest")
        assert float(near) > 0
    with xarray.open_dataset(hdf5, engine="h5netcdf", group="summary") as data:
        assert int(data["impact"][0]) == 1
        assert 0 < float(data["cor"].sel(impact=1)) < 1


def test_pandas(hdf5):
    with xarray.open_dataset(hdf5, engine="h5netcdf", group="summary") as data:
        frame = data.to_dataframe()
    assert list(frame.index) == [1]
    assert isinstance(frame["status"].iloc[0], str)


def test_h5dump(hdf5):
    names = subprocess.run(
        ["h5dump", "-n", str(hdf5)], capture_output=True, text=True, check=True
    ).stdout
    for group, (columns, dimension) in GROUPS.items():
        for name in [*columns, dimension]:
            assert f"/{group}/{name}\n" in names
    whole = subprocess.run(["h5dump", str(hdf5)], capture_output=True, text=True, check=True)
    assert "DIMENSION_SCALE" in whole.stdout
    assert whole.stderr == ""


def test_same_case_same_bytes(run, folder, tmp_path):
    # Times in the file would have seconds
    time.sleep(1.1)
    assert run(tmp_path).returncode == 0
    for path in folder.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name
