"""The program with the examples of CONTRIBUTING.md."""

import shutil
import subprocess

import contributing
import pytest
from contributing import ROOT

CASE = ROOT / "examples" / "paper" / "sls.nml"
STRIKER = """
&impact velocity = 2.0 /
&sphere shape = '{}', mass = 0.004, material = 'steel' /
&plate material = 'rubber', waves = 'none' /
&material name = 'steel', model = 'rigid' /
&material name = 'rubber', model = 'sls', poisson_ratio = 0.5, glassy_modulus = 1.5e7, alpha = 300.0, beta = 1200.0 /
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The program with all examples of the page."""
    top = tmp_path_factory.mktemp("sources") / "vcor"
    left_out = shutil.ignore_patterns("build", ".git", "gallery", "__pycache__")
    shutil.copytree(ROOT, top, ignore=left_out)
    for title in contributing.EXAMPLES:
        contributing.apply(title, top)
    # -O1 in place of -O3: two thirds of the time
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_Fortran_FLAGS_RELEASE=-O1", "-DVCOR_WERROR=ON"]
    options.append("-DVCOR_BENCHMARKS=OFF")
    build = top / "build/release"
    for command in (
        ["cmake", "-S", top, "-B", build, "-G", "Ninja", *options],
        ["cmake", "--build", build, "--target", "vcor_program"],
    ):
        done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    return build / "vcor"


def run(program, *words, code=0):
    """What the program prints, or its line of error."""
    done = subprocess.run([program, *words], capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == code, done.stderr
    return done.stderr if code else done.stdout


def test_a_column(program):
    shown = run(program, "run", CASE, "--print", "retained_energy,resilience").split()
    assert float(shown[0]) == pytest.approx(float(shown[1]), rel=1e-6)


def test_a_key(program):
    words = ["run", CASE, "--print", "cor,initial_energy"]
    oblique, half = (
        [float(word) for word in run(program, *words, "--set", setting).split()]
        for setting in ("impact.incidence=60", "impact.velocity=5")
    )
    # pi/3 is rounded
    assert oblique == pytest.approx(half, rel=1e-12)
    line = run(program, *words, "--set", "impact.incidence=90", code=3)
    assert "--set impact.incidence: found 90" in line
    assert "incidence" in run(program, "help", "input")


def test_a_sweep_over_the_key(program, tmp_path):
    sweep = "\n&sweep parameter = 'impact.incidence', values = 0, 60 /\n"
    (tmp_path / "case.nml").write_text(CASE.read_text() + sweep)
    shown = run(program, "run", tmp_path / "case.nml", "--print", "cor").split()
    words = ["--set", "impact.incidence=60", "--print", "cor"]
    assert shown[1] == run(program, "run", CASE, *words).strip()


def test_a_shape(program, tmp_path):
    """The body of the example is one of the bodies z = C r^p."""
    case = tmp_path / "case.nml"
    case.write_text(STRIKER.format("quartic"))
    printed = ["--print", "cor,contact_time,max_force"]
    found = run(program, "run", case, "--set", "sphere.quartic_coefficient=1e5", *printed)
    line = run(program, "run", case, "--set", "sphere.quartic_coefficient=-1", code=3)
    assert "expected a number > 0 [m^-3]" in line
    assert "quartic_coefficient" in run(program, "run", case, code=3)
    assert "a body of revolution z = C r^4" in run(program, "help", "quartic")
    sweep = "&sweep parameter = 'sphere.quartic_coefficient', values = 1e5, 2e5 /\n"
    case.write_text(STRIKER.format("quartic") + sweep)
    assert run(program, "run", case, *printed).splitlines()[0] == found.strip()
    case.write_text(STRIKER.format("power"))
    known = ["--set", "sphere.profile_coefficient=1e5", "--set", "sphere.profile_power=4"]
    assert run(program, "run", case, *known, *printed) == found


def test_a_method(program, tmp_path):
    """Verlet's steps are of second order: 2000 of them are within 1e-5 of the other methods."""
    case = tmp_path / "case.nml"
    case.write_text(STRIKER.format("sphere").replace("mass", "radius = 0.005, mass"))
    printed = ["--print", "cor,contact_time,max_force"]
    found, known = (
        [float(word) for word in run(program, "run", case, "--set", f"solver.method={name}", *printed).split()]
        for name in ("verlet", "ive")
    )
    assert found == pytest.approx(known, rel=1e-5)
    assert found != known
    line = run(program, "run", CASE, "--set", "solver.method=verlet", code=3)
    assert "method = 'verlet' solves a contact alone" in line
    assert "the contact alone, by Verlet's steps" in run(program, "help", "method")
