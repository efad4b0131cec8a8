"""vcor material: moduli over time and frequency, and the window of the case's impact."""

import math

import h5py
import numpy as np
import pandas as pd
import pytest
import xarray
from cases import SLS, case_text
from program import EXAMPLES, INPUT, PAPER, SUCCESS, SWEEPS, USAGE

SUFFIXES = ["_material.csv", "_material.h5", "_material_dynamic.csv", "_material_relaxation.csv"]


def table(vcor, kind, stem="case"):
    """One of the CSV files."""
    name = f"{stem}_material{'_' + kind if kind else ''}.csv"
    return pd.read_csv(vcor.folder / name, comment="#")


def files(vcor):
    return sorted(path.name for path in vcor.folder.iterdir() if path.suffix != ".nml")


def test_files(vcor):
    vcor.write(SLS)
    out = vcor.succeeds("material", "case.nml")
    assert files(vcor) == sorted("case" + suffix for suffix in SUFFIXES)
    for suffix in SUFFIXES:
        assert f"case{suffix}" in out


def test_relaxation(vcor):
    vcor.write(SLS)
    vcor.succeeds("material", "case.nml")
    data = table(vcor, "relaxation")
    t0 = float(vcor.numbers("case.nml")["contact_time"])
    assert set(data.material) == {"rubber"}
    expected = 15.0e6 * (0.25 + 0.75 * np.exp(-1200.0 * data.time))
    assert np.allclose(data.relaxation_modulus, expected, rtol=1e-13)
    assert (np.diff(data.time) > 0).all()
    assert ((data.time <= t0) == (data.in_window == 1)).all()
    # both plateaus and both sides of the contact time are there
    assert data.relaxation_modulus.iloc[0] > 0.99 * 15.0e6
    assert data.relaxation_modulus.iloc[-1] < 1.01 * 3.75e6
    assert 0 < data.in_window.sum() < len(data)


def test_dynamic(vcor):
    vcor.write(SLS)
    vcor.succeeds("material", "case.nml")
    data = table(vcor, "dynamic")
    x = data.frequency / 1200.0
    assert np.allclose(data.storage_modulus, 3.75e6 + 11.25e6 * x**2 / (1 + x**2), rtol=1e-13)
    assert np.allclose(data.loss_modulus, 11.25e6 * x / (1 + x**2), rtol=1e-13)
    assert np.allclose(data.loss_tangent, data.loss_modulus / data.storage_modulus, rtol=1e-14)
    lowest = float(vcor.numbers("case.nml")["min_frequency"])
    assert ((data.frequency >= lowest) == (data.in_window == 1)).all()
    assert 0 < data.in_window.sum() < len(data)


def test_summary(vcor):
    """A row per material; what the impact says about itself is found again."""
    vcor.write(SLS)
    vcor.succeeds("material", "case.nml")
    data = table(vcor, "").set_index("material")
    assert list(data.index) == ["steel", "rubber"]
    assert math.isinf(data.glassy_modulus["steel"])
    assert data.glassy_modulus["rubber"] == 15.0e6
    assert data.rubbery_modulus["rubber"] == 3.75e6
    assert data.loss_tangent["rubber"] == pytest.approx(
        float(vcor.numbers("case.nml")["loss_tangent"]), rel=1e-12
    )


def test_hdf5(vcor):
    vcor.write(SLS)
    vcor.succeeds("material", "case.nml")
    values = vcor.numbers("case.nml")
    with h5py.File(vcor.folder / "case_material.h5") as file:
        assert list(file) == ["summary", "relaxation", "dynamic"]
        for group in file.values():
            assert group.attrs["contact_time"] == float(values["contact_time"])
            assert group.attrs["contact_time_units"] == "s"
            assert group.attrs["min_frequency"] == float(values["min_frequency"])
            assert group.attrs["min_frequency_units"] == "rad/s"
        assert file["dynamic/loss_modulus"].attrs["units"] == "Pa"
        assert "rubber" in file.attrs["case"]
    with xarray.open_dataset(
        vcor.folder / "case_material.h5", group="relaxation", engine="h5netcdf"
    ) as data:
        modulus = data.relaxation_modulus.sel(material="rubber")
        assert modulus.dims == ("time",)
        assert np.array_equal(modulus, table(vcor, "relaxation").relaxation_modulus)


@pytest.mark.parametrize("example", [*EXAMPLES, *SWEEPS], ids=lambda path: path.stem)
def test_examples(vcor, example):
    """Every example has moduli that fall with time and grow with frequency."""
    out = vcor.succeeds("material", example, "--points", "60")
    for (_, data) in table(vcor, "relaxation", example.stem).groupby("material"):
        assert len(data) == 60
        modulus = data.relaxation_modulus.to_numpy()
        assert (modulus > 0).all() and (np.diff(modulus) <= 1e-12 * modulus[1:]).all()
    for (_, data) in table(vcor, "dynamic", example.stem).groupby("material"):
        modulus = data.storage_modulus.to_numpy()
        assert (modulus > 0).all() and (np.diff(modulus) >= -1e-12 * modulus[1:]).all()
        assert (data.loss_modulus >= 0).all()
    assert "glassy modulus" in out


def test_range(vcor):
    vcor.write(SLS)
    vcor.succeeds("material", "case.nml", "--from", "1e-5", "--to", "0.1", "--points", "5")
    assert list(table(vcor, "relaxation").time) == [1e-5, 1e-4, 1e-3, 1e-2, 0.1]
    assert np.allclose(table(vcor, "dynamic").frequency, [10, 100, 1e3, 1e4, 1e5], rtol=1e-14)


def test_all_materials(vcor):
    """A material that no body is made of is one of the case, too; a sphere may be soft."""
    vcor.write(case_text("sls") + "&material name='spare' model='elastic' modulus=1e9 "
               "density=1e3 poisson_ratio=0.3 /\n")
    vcor.succeeds("material", "case.nml", "--set", "sphere.material='rubber'")
    assert list(table(vcor, "").material) == ["steel", "rubber", "spare"]
    data = table(vcor, "relaxation")
    assert list(dict.fromkeys(data.material)) == ["rubber", "spare"]
    assert set(data.relaxation_modulus[data.material == "spare"]) == {1e9}
    assert set(table(vcor, "dynamic").query("material == 'spare'").loss_tangent) == {0.0}


def test_no_separation(vcor):
    """Without a contact time the table is written all the same."""
    vcor.write(SLS)
    out = vcor.succeeds("material", "case.nml", "--set", "solver.end_time=1e-4")
    assert "does not end in separation" in out
    assert set(table(vcor, "relaxation").in_window) == {-1}
    with h5py.File(vcor.folder / "case_material.h5") as file:
        assert "contact_time" not in file["relaxation"].attrs
    assert table(vcor, "").loss_tangent.isna().tolist() == [False, True]


def test_sweep(vcor):
    """The first point of a sweep stands for it."""
    vcor.write(SLS + "&sweep parameter = 'rubber.beta' values = 2400.0, 600.0 /\n")
    out = vcor.succeeds("material", "case.nml")
    assert "note: the case varies rubber.beta, here it is 2400" in out
    assert table(vcor, "").set_index("material").rubbery_modulus["rubber"] == 15.0e6 / 8


def test_output_group(vcor):
    vcor.write(SLS.replace("&output\n", "&output\n   csv = .false.\n   stem = 'other'\n"))
    vcor.succeeds("material", "case.nml", "--output", "out")
    assert [path.name for path in (vcor.folder / "out").iterdir()] == ["other_material.h5"]
    assert vcor.succeeds("material", "case.nml", "--quiet") == ""


def test_no_case_is_replaced(vcor):
    vcor.write(SLS)
    vcor.write(SLS, "x_material.csv")
    words = ["material", "case.nml", "x_material.csv", "--set", "output.stem='x'"]
    vcor.refuses(*words, code=INPUT, says="x_material.csv")


@pytest.mark.parametrize(
    "words, says",
    [
        (["--points", "1"], ["--points", "whole number from 2"]),
        (["--from", "0"], ["--from", "1e-30"]),
        (["--from", "x"], ["--from", "'x'"]),
        (["--from", "2", "--to", "1"], ["--from before --to"]),
        (["--print", "cor"], ["--print", "material"]),
    ],
)
def test_wrong_options(vcor, words, says):
    vcor.write(SLS)
    vcor.refuses("material", "case.nml", *words, code=USAGE, says=says)


def test_case_is_checked(vcor):
    vcor.write(SLS.replace("beta = 1200.0", "beta = -1.0"))
    vcor.refuses("material", "case.nml", code=INPUT, says="beta")


def test_values_on_the_screen(vcor):
    """The paper's: t0 = 1.34 ms, omega_min = 4684 rad/s for Fig. 1."""
    done = vcor("material", PAPER / "sls.nml")
    assert done.code == SUCCESS
    assert "1.3415430E-03 s" in done.out and "4683.5511 rad/s" in done.out
