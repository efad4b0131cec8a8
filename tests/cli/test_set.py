"""--set: another value for a key."""

import h5py
import pytest
from cases import SLS, case_text, edit
from program import INPUT, USAGE


@pytest.fixture
def sls(vcor):
    vcor.write(SLS)
    return vcor


def same(vcor, text, *settings):
    """The settings do what the text does."""
    vcor.write(text, "edited.nml")
    words = [word for setting in settings for word in ("--set", setting)]
    assert vcor.numbers("case.nml", *words) == vcor.numbers("edited.nml")


@pytest.mark.parametrize(
    "group, key, value",
    [
        ("impact", "velocity", "3.5"),
        ("sphere", "radius", "0.005"),
        ("sphere", "mass", "0.1"),
        ("plate", "waves", "'constant'"),
        ("plate", "surface_radius", "0.5"),
        ("solver", "method", "'direct'"),
        ("solver", "accuracy", "1e-5"),
    ],
)
def test_key_of_a_group(sls, group, key, value):
    text, _ = edit(SLS, group, key, value)
    same(sls, text, f"{group}.{key}={value}")
    same(sls, text, f" {group.upper()}.{key.title()} = {value} ")
    if "'" in value:
        same(sls, text, f"{group}.{key}=" + value.strip("'"))
        same(sls, text, f"{group}.{key}=" + value.replace("'", '"'))


@pytest.mark.parametrize("value", ["600", "600.0", "6e2", "6.D2", "+600.", "1*600"])
def test_key_of_a_material(sls, value):
    text, _ = edit(SLS, "material", "beta", "600.0")
    same(sls, text, f"rubber.beta={value}")


@pytest.mark.parametrize(
    "name", ["soft rubber", "soft_rubber", "'soft rubber'", '"soft rubber"', "SOFT Rubber"]
)
@pytest.mark.parametrize("written", ["soft rubber", "soft_rubber", "Soft Rubber"])
def test_material_with_a_blank(vcor, name, written):
    text = SLS.replace("rubber", written)
    vcor.write(text)
    text, _ = edit(text, "material", "beta", "600.0")
    same(vcor, text, f"{name}.beta=600")


def test_material_named_like_a_group(vcor):
    text = SLS.replace("rubber", "plate")
    vcor.write(text)
    other, _ = edit(text, "material", "beta", "600.0")
    same(vcor, other, "plate.beta=600")
    other, _ = edit(text, "plate", "half_thickness", "0.03")
    same(vcor, other, "plate.half_thickness=0.03")
    vcor.write(SLS.replace("'rubber'", "'material'"))
    other, _ = edit(SLS, "material", "beta", "600.0")
    same(vcor, other, "material.beta=600")


@pytest.mark.parametrize(
    "path, says",
    [
        ("plate.half_thicknes", ["&plate", "'half_thickness'"]),
        ("plate.extnt", ["&plate", "'extent'"]),
        ("plate.glassy_modul", ["&material", "'glassy_modulus'"]),
        ("'plate'.dens", ["&material", "'density'"]),
        ("plat.beta", ["neither", "'plate'"]),
    ],
)
def test_misspelt_where_a_material_is_named_like_a_group(vcor, path, says):
    """The nearest key is named, whichever of the two has it."""
    text = SLS.replace("rubber", "plate")
    vcor.write(text)
    says = [*says, "did you mean"]
    vcor.refuses("run", "case.nml", "--set", f"{path}=1.0", code=USAGE, at=f"--set {path}", says=says)
    vcor.write(text + f'&sweep parameter = "{path}", values = 1.0, 2.0 /\n')
    line = text.count("\n") + 1
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=says)


def test_material_with_a_dot(vcor):
    text = SLS.replace("rubber", "no. 2")
    vcor.write(text)
    text, _ = edit(text, "material", "beta", "600.0")
    same(vcor, text, "'no. 2'.beta=600")


def test_list(vcor):
    vcor.write(case_text("prony"))
    text, _ = edit(case_text("prony"), "material", "rates", "1000.0, 6000.0, 30000.0")
    same(vcor, text, "rubber.rates=1000, 6000, 30000")


def test_number_of_a_list(vcor):
    vcor.write(case_text("prony"))
    text, _ = edit(case_text("prony"), "material", "rates", "972.0, 6000.0, 34221.0")
    same(vcor, text, "rubber.rates(2)=6000")
    says = ["--set rubber.rates(4)", "(4) of a list of 3 numbers"]
    vcor.refuses("run", "case.nml", "--set", "rubber.rates(4)=1", code=USAGE, says=says)
    says = ["--set rubber.density(1)", "a single value"]
    vcor.refuses("run", "case.nml", "--set", "rubber.density(1)=1", code=USAGE, says=says)
    at = "--set rubber.rates(2)"
    vcor.refuses("run", "case.nml", "--set", "rubber.rates(2)=-1", code=INPUT, at=at, says="> 0")


@pytest.mark.parametrize("command", ["run", "check", "material"])
def test_what_a_sweep_varies(sls, command):
    """The sweep would have the last word: a value that has no effect is refused."""
    sls.write(SLS + "&sweep parameter = 'impact.velocity', values = 1, 2 /\n")
    line = SLS.count("\n") + 1
    says = ["--set impact.velocity", "&sweep", f"case.nml:{line}"]
    sls.refuses(command, "case.nml", "--set", "impact.velocity=3", code=INPUT, says=says)
    out = sls.succeeds("run", "case.nml", "--print", "cor", "--set", "sweep.values=3,4,5")
    assert len(out.splitlines()) == 3


def test_several(sls):
    text, _ = edit(SLS, "impact", "velocity", "2.0")
    text, _ = edit(text, "material", "beta", "600.0")
    text, _ = edit(text, "solver", "accuracy", "1e-6")
    same(sls, text, "impact.velocity=2", "rubber.beta=600", "solver.accuracy=1e-6")


def test_the_last_counts(sls):
    text, _ = edit(SLS, "impact", "velocity", "2.0")
    same(sls, text, "impact.velocity=1", "impact.velocity=2")


def test_of_several_files(sls):
    sls.write(SLS.replace("15.0e6", "30.0e6"), "b.nml")
    both = ["--set", "impact.velocity=2", "--print", "cor"]
    lines = sls.succeeds("run", "case.nml", "b.nml", *both).splitlines(keepends=True)
    assert lines == [sls.succeeds("run", name, *both) for name in ("case.nml", "b.nml")]


@pytest.mark.parametrize(
    "group, key, value, setting",
    [
        ("impact", "velocity", "-1.0", "impact.velocity=10"),
        ("material", "poisson_ratio", "0.7", "rubber.poisson_ratio=0.5"),
        ("sphere", "material", "'gum'", "sphere.material=steel"),
        ("material", "alpha", "3000.0", "rubber.alpha=300"),
    ],
)
def test_mends_a_broken_file(vcor, group, key, value, setting):
    text, line = edit(SLS, group, key, value)
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}")
    same(vcor, SLS, setting)


def test_mends_a_file_without_the_key(vcor):
    vcor.write(SLS.replace("   velocity = 10.0\n", ""))
    same(vcor, SLS, "impact.velocity=10")


def test_is_in_the_results(sls):
    sls.succeeds("run", "case.nml", "--set", "impact.velocity=3.25")
    assert "velocity = 3.25" in (sls.folder / "case_summary.csv").read_text()
    with h5py.File(sls.folder / "case.h5") as file:
        assert "velocity = 3.25" in file.attrs["case"]
    assert "velocity = 3.25" in sls.succeeds("check", "case.nml", "--set", "impact.velocity=3.25")


def test_title_and_stem(sls):
    out = sls.succeeds(
        "run", "case.nml", "--set", "case.title=It's 5 % = α", "--set", "output.stem=x y"
    )
    assert "It's 5 % = α" in out
    assert (sls.folder / "x y.h5").is_file()


@pytest.mark.parametrize("setting", ["x", "impact", "impact.velocity", "=3", "=", "velocity 3"])
def test_no_setting(sls, setting):
    sls.refuses("run", "case.nml", "--set", setting, code=USAGE, says=["--set", "group.key=value"])


@pytest.mark.parametrize("path", ["velocity", ".velocity", "impact.", ".", "impact.velocity.x"])
def test_no_path(sls, path):
    sls.refuses("run", "case.nml", "--set", f"{path}=3", code=USAGE, says=["--set", path])


@pytest.mark.parametrize(
    "path, nearest",
    [
        ("impact.velosity", "velocity"),
        ("impat.velocity", "impact"),
        ("ruber.beta", "rubber"),
        ("rubber.betta", "beta"),
    ],
)
def test_unknown_path(sls, path, nearest):
    sls.refuses("run", "case.nml", "--set", f"{path}=3", code=USAGE, says=["--set", f"'{nearest}'"])


def test_which_material(sls):
    words = ["run", "case.nml", "--set", "material.beta=3"]
    sls.refuses(*words, code=USAGE, says=["--set", "steel", "rubber"])


@pytest.mark.parametrize(
    "value", ["", " ", "abc", "NaN", "Inf", "1e400", "1e-400", "1 2", "1,2", "2*1", "1/", "'1'"]
)
def test_no_value(sls, value):
    words = ["run", "case.nml", "--set", f"impact.velocity={value}"]
    sls.refuses(*words, code=USAGE, at="--set impact.velocity")


@pytest.mark.parametrize(
    "path, value",
    [
        ("impact.velocity", "0"),
        ("impact.velocity", "-3"),
        ("rubber.poisson_ratio", "0.51"),
        ("rubber.alpha", "-1"),
        ("solver.accuracy", "1"),
        ("plate.waves", "tidal"),
        ("sphere.material", "gum"),
        ("plate.surface_radius", "-0.001"),
        ("rubber.modulus", "1e6"),
        ("output.stem", "''"),
    ],
)
def test_value_out_of_range(sls, path, value):
    words = ["run", "case.nml", "--set", f"{path}={value}"]
    sls.refuses(*words, code=INPUT, at=f"--set {path}")


def test_wrong_for_one_of_two_files(sls):
    """Nothing is run."""
    sls.write(SLS.replace("'rubber'", "'gum'"), "b.nml")
    words = ["run", "case.nml", "b.nml", "--set", "rubber.beta=600"]
    sls.refuses(*words, code=USAGE, says=["--set", "rubber"])
