"""Result files: which there are, and what happens to those of an earlier run."""

import os
from itertools import product

import h5py
import pytest
from cases import SLS, case_text, edit
from program import FILE, INPUT, NAMES, NUMERICAL, SUCCESS, VALIDITY, complaint, contents

FLAGS = list(product([True, False], repeat=3))


@pytest.fixture
def sls(vcor):
    vcor.write(SLS)
    return vcor


def results(folder):
    return {path.name for path in folder.iterdir() if path.suffix != ".nml"}


@pytest.mark.parametrize("csv, hdf5, history", FLAGS)
def test_which_files(vcor, csv, hdf5, history):
    text = SLS
    for key, value in {"csv": csv, "hdf5": hdf5, "history": history}.items():
        text, _ = edit(text, "output", key, ".true." if value else ".false.")
    vcor.write(text)
    expected = set()
    if csv:
        expected.add("case_summary.csv")
    if csv and history:
        expected.add("case.csv")
    if hdf5:
        expected.add("case.h5")
    out = vcor.succeeds("run", "case.nml", "--output", "out")
    folder = vcor.folder / "out"
    assert (results(folder) if folder.exists() else set()) == expected
    assert folder.exists() == bool(expected)
    for name in ("case_summary.csv", "case.csv", "case.h5"):
        assert (name in out) == (name in expected)
    if hdf5:
        with h5py.File(folder / "case.h5") as file:
            assert set(file) == ({"summary", "history"} if history else {"summary"})


def test_output_names_the_file_where_there_is_one(sls):
    """--output y.h5 is the file, as of fit and plot; of several files, or cases, it is the folder."""
    words = ["run", "case.nml", "--set"]
    out = sls.succeeds(*words, "output.csv=.false.", "--output", "y.h5")
    assert "  written y.h5\n" in out and results(sls.folder) == {"y.h5"}
    assert (sls.folder / "y.h5").is_file()
    sls.succeeds(*words, "output.csv=.false.", "--output", "a/b/z.h5", "--quiet")
    assert results(sls.folder / "a/b") == {"z.h5"}
    only = ["output.hdf5=.false.", "--set", "output.history=.false.", "--output", "z.csv"]
    sls.succeeds(*words, *only)
    assert (sls.folder / "z.csv").read_text().startswith("# vcor")
    # what is there is seen under that name
    done = sls(*words, "output.csv=.false.", "--output", "y.h5", "--set", "impact.velocity=2")
    assert done.code == SUCCESS
    # another extension, several files, a folder of this name
    sls.succeeds(*words, "output.csv=.false.", "--output", "y.csv", "--quiet")
    assert results(sls.folder / "y.csv") == {"case.h5"}
    sls.succeeds("run", "case.nml", "--output", "w.h5", "--quiet")
    assert results(sls.folder / "w.h5") == {"case_summary.csv", "case.csv", "case.h5"}
    assert sls(*words, "output.csv=.false.", "--output", "w.h5", "--quiet").code == SUCCESS
    assert results(sls.folder / "w.h5") == {"case_summary.csv", "case.csv", "case.h5"}
    sls.succeeds("material", "case.nml", "--set", "output.csv=.false.", "--output", "m.h5")
    assert (sls.folder / "m.h5").is_file()


def test_output_names_the_file_of_a_sweep(vcor):
    text = SLS + "&sweep parameter = 'impact.velocity', values = 1, 2, 3 /\n"
    vcor.write(text + "&output csv = .false. /\n" if "&output" not in SLS else text)
    words = ["run", "case.nml", "--set", "output.csv=.false.", "--output", "y.h5"]
    vcor.succeeds(*words)
    assert results(vcor.folder) == {"y.h5"}


@pytest.mark.parametrize("value", ["F", ".F.", "false", ".FALSE."])
def test_forms_of_a_logical(vcor, value):
    text, _ = edit(SLS, "output", "hdf5", value)
    vcor.write(text)
    vcor.succeeds("run", "case.nml")
    assert results(vcor.folder) == {"case_summary.csv", "case.csv"}


def test_stem(vcor):
    text, _ = edit(SLS, "output", "stem", "'ball 1'")
    vcor.write(text)
    vcor.succeeds("run", "case.nml")
    assert results(vcor.folder) == {"ball 1_summary.csv", "ball 1.csv", "ball 1.h5"}


def test_same_run_same_files(sls):
    """Nothing in a file depends on when it was written."""
    sls.succeeds("run", "case.nml")
    first = {path: data for path, (data, _) in contents(sls.folder).items()}
    sls.succeeds("run", "case.nml")
    assert {path: data for path, (data, _) in contents(sls.folder).items()} == first


def test_old_files_are_replaced_as_a_whole(sls):
    """Longer old files leave nothing behind."""
    sls.succeeds("run", "case.nml", "--output", "new")
    sls.succeeds("run", "case.nml", "--output", "out")
    for name in results(sls.folder / "out"):
        with (sls.folder / "out" / name).open("ab") as file:
            file.write(b"old\n" * 100_000)
    sls.succeeds("run", "case.nml", "--output", "out")
    for name in results(sls.folder / "new"):
        old, new = (sls.folder / folder / name for folder in ("out", "new"))
        assert old.read_bytes() == new.read_bytes()


@pytest.mark.parametrize(
    "words, code",
    [
        (["--set", "impact.velocity=-1"], INPUT),
        (["--set", "rubber.beta=1"], INPUT),
        (["--set", "sphere.material=gum"], INPUT),
        (["--set", "plate.waves=still"], INPUT),
        (["no.nml"], FILE),
    ],
)
def test_old_files_stay_when_the_run_fails(sls, words, code):
    sls.succeeds("run", "case.nml")
    sls.refuses("run", "case.nml", *words, code=code)


def test_old_files_stay_when_a_folder_is_in_the_way(sls):
    (sls.folder / "case_summary.csv").mkdir()
    for name in ("case.csv", "case.h5"):
        (sls.folder / name).write_text("old")
    sls.refuses("run", "case.nml", code=FILE, says="case_summary.csv")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write to every folder")
def test_folder_that_is_read_only(sls):
    (sls.folder / "out").mkdir(mode=0o555)
    sls.refuses("run", "case.nml", "--output", "out", code=FILE, says="out/case")


def last_row(folder, name):
    """The last line of a summary by column."""
    lines = (folder / name).read_text().splitlines()
    return dict(zip(lines[-2].split(","), lines[-1].split(",")))


@pytest.mark.parametrize("method", ["ive", "direct"])
def test_no_separation(vcor, method):
    """Contact that lasts longer than end_time: a status, and files that say so."""
    text, _ = edit(SLS, "solver", "method", f"'{method}'")
    text, _ = edit(text, "solver", "end_time", "1.0e-3")
    vcor.write(text)
    done = vcor("run", "case.nml")
    complaint(done, NUMERICAL, ["do not separate", "solver.end_time"], "case.nml")
    assert "no_separation" in done.out
    row = last_row(vcor.folder, "case_summary.csv")
    assert row.pop("status") == "no_separation"
    assert int(row.pop("steps")) > 0 and row.pop("contacts") == row.pop("bounces") == "0"
    assert float(row.pop("initial_energy")) > 1.6
    assert row.pop("validity") == row.pop("validity_cause") == row.pop("bounces_end") == "none"
    assert set(row.values()) == {"nan"}
    with h5py.File(vcor.folder / "case.h5") as file:
        assert file["summary/status"].asstr()[0] == "no_separation"
        assert file["summary/cor"][0] != file["summary/cor"][0]
        time, force = file["history/time"][:], file["history/force"][:]
    assert time[0] == 0.0 and 0.999e-3 <= time[-1]
    assert (force[1:] > 0).all()


@pytest.mark.parametrize(
    "method",
    [
        "ive",
        "direct",
    ],
)
def test_end_time_is_the_end(sls, method):
    words = ["--set", f"solver.method={method}", "--set", "solver.end_time=1e-4", "--quiet"]
    assert sls("run", "case.nml", *words).code == NUMERICAL
    with h5py.File(sls.folder / "case.h5") as file:
        assert file["history/time"][-1] == pytest.approx(1e-4, rel=1e-12)


def test_time_in_a_message_is_short(sls):
    done = sls("run", "case.nml", "--set", "solver.end_time=1e-4")
    assert "1.0000000000000000e-04" not in done.err


def test_longer_end_time_helps(sls):
    """What the message says to do works."""
    words = ["case.nml", "--set"]
    assert sls("run", *words, "solver.end_time=1e-3").code == NUMERICAL
    assert sls.numbers(*words, "solver.end_time=2e-3") == sls.numbers("case.nml")


def test_no_separation_printed(sls):
    words = ["--set", "solver.end_time=1e-3", "--print", "cor,status,contact_time"]
    done = sls("run", "case.nml", *words)
    complaint(done, NUMERICAL, "solver.end_time", "case.nml")
    assert done.out == "nan no_separation nan\n"
    assert results(sls.folder) == set()


def test_no_separation_replaces_old_files(sls):
    """They are the results of this case now."""
    sls.succeeds("run", "case.nml")
    assert sls("run", "case.nml", "--set", "solver.end_time=1e-3", "--quiet").out == ""
    assert last_row(sls.folder, "case_summary.csv")["cor"] == "nan"


STICKING = [
    # A sphere of glue on a rigid plate, and glue as a half space
    ("sls", "sphere"),
    ("sls", "plate"),
    ("prony", "sphere"),
    ("prony", "plate"),
]


def sticky(model, body):
    """A case whose material flows like a liquid before it can push back."""
    hard, soft = ("plate", "sphere") if body == "sphere" else ("sphere", "plate")
    lines = {
        "sls": ["glassy_modulus = 15.0e6", "alpha = 0.0", "beta = 1.0e6"],
        "prony": ["moduli = 10.0e6, 5.0e6", "rates = 1.0e6, 3.0e6"],
    }[model]
    return "\n".join(
        [
            "&impact velocity = 10.0 /",
            f"&{hard} material = 'steel'",
            "   radius = 0.01" if hard == "sphere" else "   waves = 'none'",
            "/",
            f"&{soft} material = 'glue'",
            "   radius = 0.01" if soft == "sphere" else "   waves = 'none'",
            "/",
            "&material name = 'steel' model = 'rigid' density = 7800.0 /",
            f"&material name = 'glue' model = '{model}' density = 1100.0 poisson_ratio = 0.5",
            *lines,
            "/\n",
        ]
    )


def sticks(vcor, method):
    """The case is found to stick, and its files say so."""
    done = vcor("run", "case.nml", "--set", f"solver.method={method}")
    complaint(done, NUMERICAL, ["sticks", "equilibrium"], "case.nml")
    assert "sticks" in done.out
    row = last_row(vcor.folder, "case_summary.csv")
    assert row["status"] == "sticks"
    assert row["cor"] == row["contact_time"] == "nan"


@pytest.mark.parametrize("model, body", STICKING)
def test_sticks(vcor, model, body):
    vcor.write(sticky(model, body))
    sticks(vcor, "direct")


def test_sticks_by_the_default_method(vcor):
    """All of them in one test: which of them fail depends on rounding."""
    for model, body in STICKING:
        for rate in ("1.0e6", "2.0e6", "5.0e6", "1.0e7"):
            vcor.write(sticky(model, body).replace("1.0e6", rate))
            sticks(vcor, "auto")


FLUID = """\
&impact velocity = 1.0 /
&sphere radius = 0.01, material = 'steel', mass = 0.03 /
&plate material = 'fluid', waves = 'none' /
&material name = 'steel', model = 'rigid' /
&material
   name = 'fluid', model = 'prony', density = 1100, poisson_ratio = 0.5
   equilibrium_modulus = 1e-3, moduli = 1e6, rates = 1e4
/
"""
# Restitution by direct at 1e-6, which converges to an error of 1e-12: rate, equilibrium modulus
SOFT_SPRINGS = {
    ("1e4", "1e-6"): 9.45e-11,
    ("1e4", "1e-3"): 9.4494e-8,
    ("1e5", "1e-6"): 4.386e-9,
    ("1e6", "1e-6"): 2.0357e-7,
    ("1e6", "1"): 0.130716,
}


def test_a_contact_at_rest_does_not_grow(vcor):
    """On a plate at rest the indentation only falls: what looks like growth is rounding."""
    vcor.write(FLUID)
    for accuracy in ("1e-5", "1e-8"):
        words = ["--set", "contact.law=receding", "--set", f"solver.accuracy={accuracy}"]
        done = vcor("run", "case.nml", "--quiet", "--output", "out", *words)
        assert done.code == NUMERICAL and "comes to rest in contact" in done.err
        assert "grows again" not in done.err


@pytest.mark.parametrize("rate, modulus", SOFT_SPRINGS)
def test_equilibrium_modulus_of_next_to_nothing(vcor, rate, modulus):
    """However soft a spring is, in the end it pushes the sphere off: at any accuracy."""
    vcor.write(FLUID)
    for method, accuracies in {
        "ive": ("1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10", "1e-11"),
        "direct": ("1e-4", "1e-6"),
    }.items():
        for accuracy in accuracies:
            changes = {
                "fluid.rates": rate,
                "fluid.equilibrium_modulus": modulus,
                "solver.method": method,
                "solver.accuracy": accuracy,
            }
            words = [word for key in changes for word in ("--set", f"{key}={changes[key]}")]
            numbers = vcor.numbers("case.nml", *words)
            assert numbers["status"] == "separated"
            expected = SOFT_SPRINGS[rate, modulus]
            error = abs(float(numbers["cor"]) - expected)
            assert error <= 3 * float(numbers["cor_error"]) + 1e-3 * expected + 1e-12
            assert float(numbers["cor_error"]) <= max(1.0e-6, float(accuracy))


def test_reason_to_stick(vcor):
    """The message names the cause: no equilibrium modulus, losses in spite of one, a light plate."""
    plate = "half_thickness = 1e-3, waves = 'constant'"
    reasons = {
        ("0", "waves = 'none'"): "without equilibrium modulus",
        ("1e-20", "waves = 'none'"): "the material dissipates all the energy of the impact",
        ("1e8", plate): "the plate is too light",
    }
    for (modulus, plate), reason in reasons.items():
        vcor.write(
            FLUID.replace("waves = 'none'", plate).replace("_modulus = 1e-3", f"_modulus = {modulus}")
        )
        for method in ("ive", "direct"):
            done = vcor("run", "case.nml", "--set", f"solver.method={method}", "--print", "status")
            complaint(done, NUMERICAL, ["sticks", reason], "case.nml")


def test_velocity_beyond_the_numbers(sls):
    """Its energy would overflow: refused, not taken for a sphere that sticks."""
    done = sls("run", "case.nml", "--set", "impact.velocity=1e200")
    complaint(done, INPUT, ["outside", "1e60"], at="--set impact.velocity")
    text, line = edit(SLS, "impact", "velocity", "1e200")
    sls.write(text)
    sls.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="1e60")


@pytest.mark.parametrize("waves", ["constant", "relaxing", "frozen", "hereditary"])
@pytest.mark.parametrize("thickness, status", [(1e-3, None), (3e-4, "no_separation")])
def test_plate_too_light(sls, waves, thickness, status):
    """It moves away from the sphere, at any end time."""
    sets = ["--set", f"plate.waves={waves}", "--set", f"plate.half_thickness={thickness}"]
    done = sls("run", "case.nml", *sets, "--print", "status")
    assert done.out.strip() in ({status} if status else {"sticks", "no_separation"})
    line = complaint(done, NUMERICAL, ["the plate is too light", "lambda", "0.68/lambda^5"])
    assert "end_time" not in line


def test_advice_that_can_be_followed(sls):
    """No method sends to the other one in a circle: auto tries both, and a light plate is named by its lambda."""
    light = ["--set", "plate.half_thickness=5e-4", "--set", "contact.law=receding", "--print", "status"]
    for method in ("auto", "ive", "direct"):
        line = complaint(sls("run", "case.nml", *light, "--set", f"solver.method={method}"), NUMERICAL, "too light")
        assert "use method" not in line and "end_time" not in line and "lambda" in line
    few = ["--set", "solver.method=direct", "--set", "solver.time_step=1e-9", "--print", "status"]
    line = complaint(sls("run", "case.nml", *few), NUMERICAL, "more steps")
    assert line.endswith("; method = 'auto' without solver.time_step tries the other method, too")
    assert sls("run", "case.nml", *few[-2:]).code == 0


def test_rebound_from_a_light_plate(vcor):
    """Where lambda is large, the elastic sphere on Zener's plate keeps 0.68/lambda^5."""
    vcor.write(case_text("elastic"))
    for thickness in (3.5e-3, 2.5e-3):
        numbers = vcor.numbers("case.nml", "--set", f"plate.half_thickness={thickness}")
        scaled = float(numbers["cor"]) * float(numbers["inelasticity"]) ** 5
        assert scaled == pytest.approx(0.679, abs=2e-3)


@pytest.mark.parametrize("path", ["plate.half_thickness", "rubber.density"])
@pytest.mark.parametrize("value", ["1e155", "1e-155", "1e300", "1e-300"])
def test_plate_beyond_the_numbers(sls, path, value):
    """The square of its thickness would overflow."""
    says = [path.split(".")[1], "outside of that nothing can be computed"]
    sls.refuses("run", "case.nml", "--set", f"{path}={value}", code=INPUT, says=says)


def test_others_are_done_when_one_fails(sls):
    """Numerical failure of one case does not stop the next."""
    text, _ = edit(SLS, "solver", "end_time", "1.0e-3")
    sls.write(text, "a.nml")
    sls.write(SLS, "b.nml")
    sls.write(text, "c.nml")
    done = sls("run", "a.nml", "case.nml", "c.nml", "b.nml", "--print", "status", "--output", "out")
    assert done.code == NUMERICAL
    assert done.out.split() == ["no_separation", "separated", "no_separation", "separated"]
    lines = VALIDITY.sub("", done.err).splitlines()
    assert [line.split(": ")[2] for line in lines] == ["a.nml", "c.nml"]
    assert all(line.startswith("vcor: error: ") for line in lines)
    assert len(results(sls.folder / "out")) == 12
    for name in "bc":
        row = last_row(sls.folder / "out", f"{name}_summary.csv")
        assert row["status"] == {"b": "separated", "c": "no_separation"}[name]


def test_columns(sls):
    sls.succeeds("run", "case.nml")
    assert list(last_row(sls.folder, "case_summary.csv")) == NAMES


@pytest.mark.parametrize("words", [["sphere.radius=10"], ["sphere.radius=3"], ["plate.half_thickness=1e-6"]])
def test_lambda_of_any_size(vcor, words):
    """A radius in mm makes lambda a large number, which the message holds all the same."""
    vcor.write(SLS)
    settings = [word for setting in words for word in ("--set", setting)]
    complaint(vcor("run", "case.nml", "--quiet", "--output", "out", *settings), NUMERICAL, "too light")
