"""The examples of CONTRIBUTING.md: their blocks, put where the page says, compile and run."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
CASE = ROOT / "examples" / "paper" / "sls.nml"


def blocks(title):
    """Blocks of code of an example."""
    text = PAGE.split(f"## Example: {title}\n")[1].split("\n## ")[0]
    found = re.findall(r"^   ```\n(.*?)^   ```$", text, re.M | re.S)
    return [re.sub(r"^   ", "", block, flags=re.M) for block in found]


def put_before(path, line, block):
    """Put a block before the only line of a file that begins so, at the same indentation."""
    text = path.read_text()
    (found,) = re.finditer(rf"^( *){re.escape(line)}", text, re.M)
    more = "".join(found[1] + row + "\n" for row in block.splitlines())
    path.write_text(text[: found.start()] + more + text[found.start() :])


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The program with the column and the key of the page."""
    top = tmp_path_factory.mktemp("sources") / "vcor"
    left_out = shutil.ignore_patterns("build", ".git", "gallery", "__pycache__")
    shutil.copytree(ROOT, top, ignore=left_out)
    (column,) = blocks("a column of the summary")
    put_before(top / "src/vcor/sweep/quantity.f90", "call list%add('resilience'", column)
    row, take, component, case, use = blocks("a key of the input")
    put_before(top / "src/vcor/case/catalogue.f90", 'key_t("impact", "gravity"', row)
    put_before(top / "src/vcor/case/reader.f90", "call put(case, inputs, 'impact', 'gravity')", take)
    inputs = top / "src/vcor/case/inputs.f90"
    put_before(inputs, "!> Gravity along the impact", component)
    put_before(inputs, "case ('gravity')", case)
    text = inputs.read_text()
    assert text.count("velocity = self%velocity\n") == 1
    inputs.write_text(text.replace("velocity = self%velocity\n", use))
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DVCOR_WERROR=ON", "-DVCOR_BENCHMARKS=OFF"]
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
