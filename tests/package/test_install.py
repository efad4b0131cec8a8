"""What cmake --install and cpack leave behind: complete, movable, of use to others."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CONSUMER = ROOT / "tests" / "consumer"
PAPER = ROOT / "examples" / "paper"
LIMIT = 1000

# COR of examples/paper/sls.nml at 2.5 m/s, by vcor verify, and the setting for it
COR = 0.407292416
FASTER = ["--set", "impact.velocity=2.5", "--print", "cor"]
# What from_code.f90 of the consumer solves, as changes of that case
CODE = ["--set", "impact.velocity=3", "--set", "plate.waves=none", "--set", "sphere.mass=0.03"]


def run(*words, code=0, **options):
    """Run a command; what it prints."""
    done = subprocess.run(
        list(map(str, words)),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=LIMIT,
        check=False,
        **options,
    )
    assert done.returncode == code, done.stdout
    return done.stdout


@pytest.fixture(scope="session")
def build():
    """Folder of the build, from the environment."""
    folder = os.environ.get("VCOR_BUILD")
    assert folder, "the environment variable VCOR_BUILD is not set, expected a folder of a build"
    return Path(folder)


@pytest.fixture(scope="session")
def prefix(build, tmp_path_factory):
    """An installation that was moved as a whole, to a path with a blank."""
    folder = tmp_path_factory.mktemp("install")
    run("cmake", "--install", build, "--prefix", folder / "first")
    assert not any("first" in text for text in texts(folder / "first").values())
    (folder / "first").rename(folder / "moved here")
    return folder / "moved here"


def texts(folder):
    """The text files below a folder that programs read."""
    found = {}
    for path in folder.rglob("*"):
        if path.suffix in {".cmake", ".pc"}:
            found[path] = path.read_text()
    assert len(found) >= 5
    return found


def library_folder(prefix):
    """Where the library is: lib, lib64 or the like."""
    (archive,) = prefix.glob("lib*/**/libvcor.a")
    return archive.parent


def is_close(text):
    """Whether the first COR in a text is that of the case."""
    return abs(float(re.search(r"COR +([0-9.]+)", text).group(1)) - COR) <= 1e-7


def test_everything_is_there(prefix):
    files = {str(path.relative_to(prefix)) for path in prefix.rglob("*") if path.is_file()}
    for name in ["bin/vcor", "share/doc/vcor/LICENSE", "share/doc/vcor/README.md"]:
        assert name in files
    for page in (ROOT / "man").iterdir():
        (found,) = (name for name in files if Path(name).name.startswith(page.name))
        assert f"share/man/man{page.suffix[1:]}/" in found
    for folder in ["docs", "examples"]:
        for path in (ROOT / folder).rglob("*"):
            if path.is_file() and path.suffix != ".h5":
                assert f"share/doc/vcor/{path.relative_to(ROOT)}" in files
    assert any(name.startswith("include/vcor/") and name.endswith("/vcor.mod") for name in files)


def test_the_build_of_run_sh_can_be_installed(build, prefix):
    """scripts/run.sh builds one target: all files that are built to be installed belong to it."""
    target = "vcor_installed"
    assert f"--target {target}" in (ROOT / "scripts/run.sh").read_text()
    commands = run("ninja", "-C", build, "-t", "commands", target)
    built = [path for path in prefix.rglob("*") if re.search(r"/bin/\w+$|\.(a|so[.0-9]*|gz)$", str(path))]
    assert {"vcor", "libvcor.a", "libvcor.so", "libvcor_core.a", "vcor.1.gz"} <= {path.name for path in built}
    for path in built:
        name = path.resolve().name.removesuffix(".gz")
        assert re.search(rf"\b{re.escape(name)}\b", commands), path


def test_completion_is_where_shells_look(prefix, packages):
    for name in ["bash-completion/completions/vcor", "zsh/site-functions/_vcor", "fish/vendor_completions.d/vcor.fish"]:
        assert (prefix / "share" / name).is_file()
        name = name.replace("site-functions", "vendor-completions")
        assert f" ./usr/share/{name}\n" in run("dpkg-deb", "-c", packages["vcor"])


def test_no_path_of_the_build(build, prefix):
    """The installed files contain no path of the sources or the build."""
    for path, text in texts(prefix).items():
        assert str(ROOT) not in text, path
        assert str(build) not in text, path


def test_program(prefix, tmp_path):
    """The program in an empty environment, on an example that was installed with it."""
    case = prefix / "share/doc/vcor/examples/paper/sls.nml"
    words = ["run", case, *FASTER, "--quiet"]
    assert abs(float(run(prefix / "bin/vcor", *words, env={}, cwd=tmp_path)) - COR) <= 1e-8


def test_pages_of_man(prefix):
    env = {**os.environ, "LC_ALL": "C.UTF-8"}
    for section, name in [("1", "vcor"), ("5", "vcor-input"), ("5", "vcor-output")]:
        page = run("man", "-M", prefix / "share/man", section, name, env=env)
        assert f"{name.upper()}({section})" in page


def test_consumer_with_cmake(prefix, tmp_path):
    """A project in Fortran only: find_package and nothing else."""
    options = [f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release"]
    run("cmake", "-S", CONSUMER, "-B", tmp_path, *options)
    run("cmake", "--build", tmp_path)
    assert is_close(run(tmp_path / "from_case", cwd=PAPER))
    cor = float(run(prefix / "bin/vcor", "run", PAPER / "sls.nml", *CODE, "--print", "cor", "--quiet"))
    assert f"3 m/s: COR {cor:11.8f}," in run(tmp_path / "from_code")
    shown = run(tmp_path / "from_sweep", cwd=ROOT / "examples/sweeps").splitlines()
    assert shown[9] == "  10.000 m/s: COR  0.43198690"
    # it needs the core of the library, and that needs no HDF5
    needs = run("ldd", tmp_path / "from_case")
    assert "lapack" in needs and "hdf5" not in needs
    assert "hdf5" not in (tmp_path / "CMakeCache.txt").read_text().lower()


def test_consumer_in_c(prefix, tmp_path):
    """A project in C only: the core as a shared library, by CMake and by pkg-config."""
    run("cmake", "-S", CONSUMER / "c", "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path)
    shown = run(tmp_path / "from_c", cwd=PAPER)
    assert is_close(shown)
    folder = library_folder(prefix)
    env = {**os.environ, "PKG_CONFIG_PATH": str(folder / "pkgconfig")}
    # the command of docs/python.md, of which pkg-config quotes the paths but for that of rpath
    command = 'eval gcc "$1" $(pkg-config --cflags --libs vcor-c) -o drop'
    run("sh", "-c", command, "sh", CONSUMER / "c/from_c.c", env=env, cwd=tmp_path)
    env = {**os.environ, "LD_LIBRARY_PATH": str(folder)}
    assert run(tmp_path / "drop", cwd=PAPER, env=env) == shown
    needs = set(re.findall(r"NEEDED +(\S+)", run("objdump", "-p", folder / "libvcor.so")))
    known = r"lib(lapack|blas|gomp|gfortran|quadmath|m|mvec|gcc_s|c)\.so"
    assert "liblapack.so.3" in needs and all(re.match(known, name) for name in needs)
    # no name but those of vcor.h
    names = run("nm", "-D", "--defined-only", folder / "libvcor.so").split()[2::3]
    header = (ROOT / "include/vcor.h").read_text()
    assert set(names) == set(re.findall(r"^\w[\w *]*\b(vcor_\w+)\(", header, re.MULTILINE))


def test_an_error_in_c(prefix, tmp_path):
    """The code of the program, and its line."""
    (tmp_path / "sls.nml").write_text("&impact velocity = -1.0 /\n")
    run("cmake", "-S", CONSUMER / "c", "-B", tmp_path / "b", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "b")
    found = run(tmp_path / "b/from_c", cwd=tmp_path, code=3)
    program = run(prefix / "bin/vcor", "run", "sls.nml", cwd=tmp_path, code=3)
    assert program == f"vcor: error: {found}"


# A project that uses all of the library
ALL = f"""\
cmake_minimum_required(VERSION 3.20)
project(names LANGUAGES Fortran)
find_package(vcor REQUIRED)
add_executable(names {ROOT}/tests/unit/harness.f90 {ROOT}/tests/unit/test_library.f90)
target_link_libraries(names PRIVATE vcor::vcor)
"""


def test_all_names_with_cmake(prefix, tmp_path):
    """Every name of module vcor from an installation."""
    (tmp_path / "CMakeLists.txt").write_text(ALL)
    run("cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "build")
    assert "0 failed" in run(tmp_path / "build/names", cwd=ROOT)


def test_component_that_is_not_there(prefix, tmp_path):
    text = ALL.replace("REQUIRED", "REQUIRED COMPONENTS core gravity")
    (tmp_path / "CMakeLists.txt").write_text(text)
    words = ["-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}"]
    assert "gravity" in run("cmake", *words, code=1)


def test_consumer_with_another_compiler(prefix, tmp_path):
    """Module files of another compiler cannot be read: said at once, not by the compiler."""
    config = next(prefix.rglob("vcorConfig.cmake"))
    copy = tmp_path / "vcor"
    shutil.copytree(config.parent, copy)
    text = (copy / "vcorConfig.cmake").read_text()
    spoilt = re.sub(r"\^GNU [0-9]+", "^GNU 5", text)
    assert spoilt != text
    (copy / "vcorConfig.cmake").write_text(spoilt)
    words = ["cmake", "-S", CONSUMER, "-B", tmp_path / "build", f"-Dvcor_DIR={copy}"]
    assert "it was built by GNU" in run(*words, code=1).replace("\n ", "")


@pytest.mark.parametrize("name", ["vcor", "vcor-core"])
def test_consumer_with_pkg_config(prefix, tmp_path, name):
    """A plain compiler command."""
    env = {**os.environ, "PKG_CONFIG_PATH": str(library_folder(prefix) / "pkgconfig")}
    assert run("pkg-config", "--modversion", name, env=env).strip() == version()
    # the shell takes the words apart, as in the documents
    command = 'eval gfortran "$1" $(pkg-config --cflags --libs "$2") -o drop'
    source = CONSUMER / "app/from_case.f90"
    run("sh", "-c", command, "sh", source, name, env=env, cwd=tmp_path)
    assert is_close(run(tmp_path / "drop", cwd=PAPER))


def version():
    """Version of the project."""
    return re.search(r'^version = "(.*)"', (ROOT / "fpm.toml").read_text(), re.MULTILINE).group(1)


@pytest.fixture(scope="session")
def packages(build, tmp_path_factory):
    """The packages of Debian."""
    folder = tmp_path_factory.mktemp("packages")
    run("cpack", "--config", build / "CPackConfig.cmake", "-B", folder, cwd=folder)
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


def field(package, name):
    """A field of a package."""
    return run("dpkg-deb", "-f", package, name).strip()


def test_packages(packages):
    assert set(packages) == {"vcor", "libvcor-dev", "python3-vcor"}
    for name, package in packages.items():
        assert field(package, "Package") == name
        assert field(package, "Version") == version()
        assert run("dpkg-deb", "-c", package).count(f"./usr/share/doc/{name}/copyright\n") == 1
    needs = field(packages["vcor"], "Depends")
    for library in ["libc6", "libgfortran5", "liblapack3", "libgomp1"]:
        assert library in needs
    # Debian has archives of HDF5, which the program is linked with
    assert "hdf5" not in needs
    assert "python3-vcor" in field(packages["vcor"], "Recommends")
    needs = field(packages["python3-vcor"], "Depends")
    for library in ["python3-xarray", "python3-h5netcdf", "libgfortran5", "liblapack3", "libgomp1"]:
        assert library in needs
    needs = field(packages["libvcor-dev"], "Depends")
    for library in ["gfortran-", "libhdf5-dev", "liblapack-dev"]:
        assert library in needs


def test_packages_need_what_debian_has(packages):
    """Here, where vcor was built, all that they need is installed under these names."""
    for package in packages.values():
        for need in field(package, "Depends").split(", "):
            names = [re.sub(r" \(.*\)", "", name) for name in need.split(" | ")]
            states = [
                subprocess.run(
                    ["dpkg-query", "-W", "-f", "${Status}", name],
                    capture_output=True,
                    text=True,
                    check=False,
                ).stdout
                for name in names
            ]
            assert "install ok installed" in states, need


def test_package_runs(packages, tmp_path):
    """What is in the packages, in a folder of its own: the program and the library."""
    for package in packages.values():
        run("dpkg-deb", "-x", package, tmp_path)
    case = tmp_path / "usr/share/doc/vcor/examples/paper/sls.nml"
    words = ["run", case, *FASTER, "--quiet"]
    assert abs(float(run(tmp_path / "usr/bin/vcor", *words, env={}, cwd=tmp_path)) - COR) <= 1e-8
    env = {"PYTHONPATH": str(tmp_path / "usr/lib/python3/dist-packages")}
    env["PYTHONDONTWRITEBYTECODE"] = "1"
    run(tmp_path / "usr/bin/vcor", "run", case, "--quiet", env={}, cwd=tmp_path)
    run(tmp_path / "usr/bin/vcor-plot", "sls.h5", "--output", "sls.pdf", env=env, cwd=tmp_path)
    assert (tmp_path / "sls.pdf").read_bytes().startswith(b"%PDF")
    build = tmp_path / "build"
    run("cmake", "-S", CONSUMER, "-B", build, f"-DCMAKE_PREFIX_PATH={tmp_path / 'usr'}")
    run("cmake", "--build", build, "--target", "from_case")
    assert is_close(run(build / "from_case", cwd=PAPER))
