"""The Python package as users install it: a wheel made from the sources, in an environment of its own."""

import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# Debian's Python with Debian's packages, the oldest ones that are supported; and the newest Python that
# scripts/test_long.sh has found, which may be that of these tests
PYTHONS = {"debian": Path("/usr/bin/python3"), "newest": ROOT / "build/newest/bin/python"}
SUITES = ["test_case.py", "test_fit.py", "test_tutorial.py"]
# What the package needs is taken from the environment of the tests
SCRIPT = f"""
import vcor
case = vcor.read({str(ROOT / "examples/paper/sls.nml")!r})
case["impact.velocity"] = 2.5
print(vcor.__file__, vcor.__version__, case.solve()["cor"])
"""


def run(*words, **options):
    """Run a command; what it prints."""
    done = subprocess.run(
        list(map(str, words)),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
        **options,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    words = ["--no-build-isolation", "--no-deps", "--no-index", "-w", folder, ROOT / "python"]
    options = ["-C", f"build-dir={folder / 'build'}"]
    run(sys.executable, "-m", "pip", "wheel", *words, *options)
    (path,) = folder.glob("*.whl")
    return path


def test_what_is_in_the_wheel(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    library = [name for name in names if ".so" in name]
    assert library == ["vcor/lib/libvcor_python.so"]
    assert {"vcor/case.py", "vcor/py.typed", "vcor/vcor.mplstyle", "vcor/page/page.js"} <= set(names)
    assert {"vcor/page/live.html", "vcor/lib/materials/steel.nml"} <= set(names)
    assert not [name for name in names if "test" in name or name.endswith((".mod", ".a"))]


def test_the_wheel_in_an_empty_environment(wheel, tmp_path):
    run(sys.executable, "-m", "venv", tmp_path / "env")
    python = tmp_path / "env/bin/python"
    run(python, "-m", "pip", "install", "--no-index", "--no-deps", wheel)
    env = {"PATH": os.environ["PATH"], "PYTHONPATH": sysconfig.get_path("purelib")}
    file, version, cor = run(python, "-c", SCRIPT, env=env, cwd=tmp_path).split()
    assert Path(file).is_relative_to(tmp_path / "env")
    assert f'version = "{version}"' in (ROOT / "fpm.toml").read_text()
    words = ["run", "examples/paper/sls.nml", "--set", "impact.velocity=2.5", "--print", "cor", "--quiet"]
    assert float(run(os.environ["VCOR"], *words, cwd=ROOT)) == float(cor)


@pytest.mark.parametrize("name", PYTHONS)
def test_the_wheel_with_another_python(wheel, tmp_path, name):
    if not PYTHONS[name].exists():
        pytest.skip(f"no {PYTHONS[name]}: scripts/test_long.sh makes it")
    words = ["install", "--no-index", "--no-deps", "--target", tmp_path, wheel]
    run(sys.executable, "-m", "pip", *words)
    env = {**os.environ, "PYTHONPATH": str(tmp_path)}
    suites = [ROOT / "python/tests" / suite for suite in SUITES]
    words = ["-q", "-p", "no:cacheprovider", "--rootdir", ROOT / "python/tests", *suites]
    assert " passed" in run(PYTHONS[name], "-m", "pytest", *words, env=env, cwd=tmp_path)
