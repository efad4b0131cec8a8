"""The pages that the program prints of itself: current, complete, and readable by man."""

import os
import subprocess

import pytest
from places import ROOT

# As scripts/manual.sh has them
PAGES = {
    "docs/commands.md": ["--markdown"],
    "docs/input.md": ["input", "--markdown"],
    "docs/output.md": ["output", "--markdown"],
    "man/vcor.1": ["--man"],
    "man/vcor-input.5": ["input", "--man"],
    "man/vcor-output.5": ["output", "--man"],
}
MAN = [name for name in PAGES if name.startswith("man/")]


@pytest.mark.parametrize("name", PAGES)
def test_page_is_current(vcor, run, name):
    page = run(vcor, "help", *PAGES[name])
    assert (ROOT / name).read_text(encoding="utf-8") == page, "run scripts/manual.sh"
    assert page.isascii()
    assert not any(line.endswith(" ") for line in page.splitlines())


def test_the_script_writes_these_pages():
    lines = (ROOT / "scripts/manual.sh").read_text().splitlines()
    calls = [line.split()[1:] for line in lines if line.startswith("page ")]
    assert {name: words for name, *words in calls} == PAGES


def test_no_other_page_of_man():
    assert {f"man/{path.name}" for path in (ROOT / "man").iterdir()} == set(MAN)


@pytest.mark.parametrize("name", MAN)
def test_man_has_nothing_to_complain_about(run, name):
    words = {**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80", "MAN_KEEP_FORMATTING": ""}
    shown = run("man", "-Tutf8", "--warnings=w", "-l", ROOT / name, env=words)
    assert len(shown.splitlines()) > 50
    run("groff", "-man", "-ww", "-z", "-Tutf8", ROOT / name)


@pytest.mark.parametrize("suffix", ["--man", "--markdown"])
def test_every_key_and_group(vcor, run, suffix):
    """What the help on the screen has, the manual has too."""
    groups, keys = [], []
    for line in run(vcor, "help", "input").splitlines():
        if line.startswith("&"):
            groups.append(line.split()[0][1:])
        elif line.startswith("   ") and line[3] != " ":
            keys.append(line.split()[0])
    assert len(groups) > 8 and len(keys) > 40
    page = run(vcor, "help", "input", suffix)
    for group in groups:
        heading = f"## &{group}" if suffix == "--markdown" else f".SH &{group.upper()}"
        assert f"\n{heading}\n" in page
    mark = "\n| `{}` |" if suffix == "--markdown" else "\n.TP\n\\fB{}\\fR\n"
    for key in keys:
        assert page.count(mark.format(key)) == keys.count(key), key


@pytest.mark.parametrize("suffix", ["--man", "--markdown"])
def test_every_command_and_option(vcor, run, suffix):
    page = run(vcor, "help", suffix).replace("\\-", "-")
    commands = [
        line.split("vcor ")[1].split()[0]
        for line in run(vcor, "help").splitlines()
        if line.startswith(("usage: vcor", "       vcor"))
    ]
    commands = [word for word in dict.fromkeys(commands) if word.isalpha() and word != "help"]
    assert len(commands) >= 3
    mark = "\n### `vcor {}`\n" if suffix == "--markdown" else "\n.SS \\fBvcor {}\\fR\n"
    for command in commands:
        assert mark.format(command) in page
        for line in run(vcor, "help", command).splitlines():
            if line.startswith("  --"):
                term = line.strip().split("  ")[0]
                assert f"`{term}`" in page or f"\\fB{term}\\fR" in page


def test_every_column(vcor, run):
    page = run(vcor, "help", "output", "--markdown")
    for line in run(vcor, "help", "output").splitlines():
        if line.startswith("   ") and line[3] != " ":
            assert f"| `{line.split()[0]}` |" in page


def test_the_example_of_the_input_runs(vcor, run, tmp_path):
    text = (ROOT / "docs/input.md").read_text().split("```fortran\n")[1].split("```")[0]
    (tmp_path / "case.nml").write_text(text)
    assert 0 < float(run(vcor, "run", "case.nml", "--print", "cor", cwd=tmp_path)) < 1


@pytest.mark.parametrize("topic", ["run", "verify", "nothing"])
def test_no_manual_page(vcor, topic):
    done = subprocess.run(
        [vcor, "help", topic, "--man"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("vcor: error: no ") and topic in done.stderr
