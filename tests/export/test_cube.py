"""The files of a sweep as their readers see them: a labelled cube."""

import subprocess

import h5py
import numpy
import pandas
import pytest
import xarray
from columns import INTEGERS, SUMMARY, TEXTS
from conftest import CASE

# Radius below zero at two points of each row
SWEEPS = """
&sweep
   parameter = 'impact.velocity'
   values = 2.0, 5.0, 10.0
/
&sweep
   parameter = 'rubber.beta'
   start = 400.0
   stop = 1200.0
   count = 3
/
&sweep
   parameter = 'sphere.radius'
   values = -0.01, 0.0, 0.005, 0.01
/
"""
NAMES = ["impact.velocity", "rubber.beta", "sphere.radius"]
UNITS = {"impact.velocity": "m/s", "rubber.beta": "1/s", "sphere.radius": "m"}
SHAPE = (3, 3, 4)


def solve(vcor, folder, text, code):
    case = folder / "cube.nml"
    case.write_text(CASE.read_text() + text)
    done = subprocess.run(
        [vcor, "run", str(case), "--output", str(folder), "--quiet"],
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == code, done.stderr
    return folder / "cube_summary.csv", folder / "cube.h5"


@pytest.fixture(scope="module")
def cube(vcor, tmp_path_factory):
    return solve(vcor, tmp_path_factory.mktemp("cube"), SWEEPS, 5)


def test_pandas(cube):
    table = pandas.read_csv(cube[0], comment="#")
    assert list(table.columns) == [*NAMES, *SUMMARY]
    assert len(table) == 36
    grid = pandas.MultiIndex.from_product(
        [[2.0, 5.0, 10.0], [400.0, 800.0, 1200.0], [-0.01, 0.0, 0.005, 0.01]]
    )
    assert list(pandas.MultiIndex.from_frame(table[NAMES])) == list(grid)
    good = table["sphere.radius"] > 0
    assert (table["status"] == numpy.where(good, "separated", "invalid")).all()
    assert (table["cor"].isna() == ~good).all()
    assert list(table.pivot_table("cor", "impact.velocity", "rubber.beta").shape) == [3, 3]


def test_h5py(cube):
    with h5py.File(cube[1]) as file:
        assert set(file) == {"summary"}
        group = file["summary"]
        assert set(group) == {*NAMES, *SUMMARY}
        for name, length in zip(NAMES, SHAPE, strict=True):
            assert group[name].shape == (length,)
            assert group[name].is_scale
            assert group[name].attrs["units"] == UNITS[name]
            assert group[name].attrs["long_name"]
        for name, unit in SUMMARY.items():
            assert group[name].shape == SHAPE
            scales = [list(dimension.values()) for dimension in group[name].dims]
            assert scales == [[group[other]] for other in NAMES]
            assert group[name].attrs["long_name"]
            if unit:
                assert group[name].attrs["units"] == unit
            # small ones are stored as they are
            assert group[name].compression is None


def test_same_bits_as_csv(cube):
    table = pandas.read_csv(cube[0], comment="#")
    with h5py.File(cube[1]) as file:
        for name in SUMMARY:
            if name in TEXTS:
                assert list(table[name]) == list(file["summary"][name].asstr()[:].flat)
            elif name in INTEGERS:
                assert list(table[name]) == list(file["summary"][name][:].flat)
            else:
                found = file["summary"][name][:].ravel()
                assert numpy.array_equal(table[name].to_numpy(), found, equal_nan=True), name


def test_xarray(cube):
    with xarray.open_dataset(cube[1], group="summary", engine="h5netcdf") as data:
        assert dict(data.sizes) == dict(zip(NAMES, SHAPE, strict=True))
        assert set(data.coords) == set(NAMES)
        assert set(data.data_vars) == set(SUMMARY)
        for name in SUMMARY:
            assert data[name].dims == tuple(NAMES)
        one = data.sel({"impact.velocity": 10.0, "rubber.beta": 1200.0, "sphere.radius": 0.01})
        assert float(one["cor"]) == pytest.approx(0.4319869, abs=1e-7)
        assert str(one["status"].values) == "separated"
        faster = data["cor"].sel({"rubber.beta": 1200.0, "sphere.radius": 0.01})
        assert (faster.diff("impact.velocity") > 0).all()
        frame = data.to_dataframe()
        assert list(frame.index.names) == NAMES
        assert data["impact.velocity"].attrs["units"] == "m/s"


def test_names_with_blanks_and_slashes(vcor, tmp_path):
    """Names of materials are the user's."""
    text = CASE.read_text().replace("'rubber'", "'SLS a/b'")
    case = tmp_path / "names.nml"
    case.write_text(text + "&sweep parameter = 'sls_a/b.beta' values = 600, 1200 /\n")
    subprocess.run([vcor, "run", str(case), "--output", str(tmp_path)], check=True)
    with h5py.File(tmp_path / "names.h5") as file:
        assert "sls_a_b.beta" in file["summary"]
    with xarray.open_dataset(
        tmp_path / "names.h5", group="summary", engine="h5netcdf"
    ) as data:
        assert list(data.sizes) == ["sls_a_b.beta"]


def test_long_columns(vcor, tmp_path):
    """Columns of any length are stored as they are."""
    sweeps = """
        &sweep parameter = 'impact.velocity' start = -1 stop = -2 count = 300 /
        &sweep parameter = 'sphere.radius' start = 1e-3 stop = 1e-2 count = 200 /
        &output csv = .false. /
    """
    _, path = solve(vcor, tmp_path, sweeps, 5)
    with h5py.File(path) as file:
        cor = file["summary/cor"]
        assert cor.shape == (300, 200)
        assert cor.fletcher32 and cor.compression is None
        assert numpy.isnan(cor[:]).all()
        status = file["summary/status"].asstr()[:]
        assert (status == "invalid").all()
    with xarray.open_dataset(path, group="summary", engine="h5netcdf") as data:
        assert dict(data.sizes) == {"impact.velocity": 300, "sphere.radius": 200}


@pytest.mark.parametrize("first", [-399, -390])
def test_long_texts(vcor, tmp_path, first):
    """A text that all points share takes no room and reads as if it did."""
    sweeps = f"""
        &sweep parameter = 'impact.velocity' start = {first} stop = {first + 399} count = 400 /
        &sweep parameter = 'sphere.radius' start = 1e-3 stop = 1e-2 count = 200 /
    """
    table, path = solve(vcor, tmp_path, sweeps, 5)
    good = numpy.repeat(first + numpy.arange(400) > 0, 200)
    expected = numpy.where(good, "separated", "invalid")
    assert (pandas.read_csv(table, comment="#")["status"] == expected).all()
    with h5py.File(path) as file:
        status = file["summary/status"]
        assert (status.asstr()[:].ravel() == expected).all()
        assert (status.asstr()[395:, 7] == expected[-1]).all()
        assert (status.id.get_storage_size() == 0) == (not good.any())
    with xarray.open_dataset(path, group="summary", engine="h5netcdf") as data:
        assert (data["status"].values.ravel() == expected).all()
    shown = subprocess.run(
        ["h5dump", "-d", "/summary/status", str(path)], capture_output=True, text=True, check=True
    )
    assert shown.stdout.count('"separated"') == good.sum()


def test_h5dump(cube):
    whole = subprocess.run(["h5dump", str(cube[1])], capture_output=True, text=True, check=True)
    assert "DIMENSION_SCALE" in whole.stdout
    assert whole.stderr == ""


def test_netcdf_names(cube):
    """Dimension names that netCDF takes: they begin with a letter, and have no slash."""
    with h5py.File(cube[1]) as file:
        for name in file["summary"]:
            assert name[0].isalpha() and "/" not in name and name == name.strip()
