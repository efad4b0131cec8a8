"""Completion of words in the shells, from completion/, and the help about programs of PATH."""

import json
import os
import subprocess

import pytest
from program import ROOT, USAGE

FOLDER = ROOT / "completion"
BASH = """
source "$1/vcor.bash"
COMP_LINE=$2 COMP_POINT=${#2}
read -ra COMP_WORDS <<<"$2"
_vcor
printf '%s\\n' "${COMPREPLY[@]}"
"""
FISH = 'source $argv[1]/vcor.fish; complete -C $argv[2]'
# zsh completes in a terminal only; the second tab lists what there is, and the line is dropped then
ZSH = r"""
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "stty cols 200; fpath=($1 \$fpath); autoload -U compinit; compinit -u -D; PS1='=''ready=='"
zpty -r shell shown '*=ready==*'
zpty -w -n shell "$2"$'\t\t\x15print ==''end==\n'
zpty -r shell shown '*==end==*'
print -r -- $shown
"""
LINES = [
    ("vcor ver", {"verify"}, {"run", "hello", "locked"}),
    ("vcor h", {"help", "hello"}, {"run"}),
    ("vcor run --re", {"--resume"}, {"--quiet"}),
    ("vcor run --print cor,contact_", {"cor,contact_time", "cor,contact_ratio"}, {"cor,cor"}),
    ("vcor check --set solver.me", {"solver.method=ive"}, {"solver.form=a"}),
    ("vcor help contact_t", {"contact_time"}, {"contact_ratio"}),
    ("vcor hello --lo", {"--loud"}, {"--quiet"}),
]


@pytest.fixture
def environment(tmp_path, monkeypatch):
    """PATH with the program and with programs that vcor runs, or not."""
    folder = tmp_path / "bin*"
    folder.mkdir()
    (folder / "vcor").symlink_to(os.environ["VCOR"])
    for name in ("vcor-hello", "vcor-identify", "vcor-Hello.py", "vcor-run", "vcor-locked"):
        (folder / name).write_text("#!/bin/sh\necho usage: $0 --loud, $1\n")
        (folder / name).chmod(0o644 if name == "vcor-locked" else 0o755)
    (folder / "vcor-folder").mkdir()
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def output(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, encoding="utf-8", check=True)
    return done.stdout


@pytest.mark.parametrize("line, there, not_there", LINES, ids=[line[0] for line in LINES])
def test_bash(environment, line, there, not_there):
    shown = set(output("bash", "-c", BASH, "bash", FOLDER, line).splitlines())
    assert there <= shown and not shown & not_there


def test_bash_takes_words_apart_at_an_equals_sign(environment):
    for line in ("vcor run --set plate.waves=no", "vcor run --set=plate.waves=no"):
        assert output("bash", "-c", BASH, "bash", FOLDER, line) == "none\n"


@pytest.mark.parametrize("line, there, not_there", LINES, ids=[line[0] for line in LINES])
def test_fish(environment, line, there, not_there):
    shown = {word.split("\t")[0] for word in output("fish", "-c", FISH, FOLDER, line).splitlines()}
    assert there <= shown and not shown & not_there


@pytest.mark.parametrize("line, there, not_there", LINES, ids=[line[0] for line in LINES])
def test_zsh(environment, line, there, not_there):
    shown = output("zsh", "-f", "-c", ZSH, "zsh", FOLDER, line)
    assert all(word.split(",")[-1] in shown for word in there)
    assert not any(word in shown.replace(line, "") for word in not_there)


def test_help_lists_programs_of_path(environment, vcor):
    page = vcor.succeeds("help")
    lines = [line.split()[1:] for line in page.splitlines() if line.startswith("       vcor ")]
    assert ["hello", "not", "part", "of", "vcor"] in lines
    assert ["identify", "find", "materials"] in [line[:3] for line in lines]
    names = [line[0] for line in lines]
    assert not {"run", "locked", "folder", "Hello.py"} & set(names)
    assert vcor.succeeds("help", "hello").endswith("--loud, --help\n")
    assert vcor.succeeds("help", "velocity").startswith("&impact")


def test_commands_of_the_package_that_are_not_there(vcor, monkeypatch):
    document = json.loads(vcor.succeeds("help", "--json"))
    names = [one["name"] for one in document["package_commands"]]
    assert names == ["plot", "page", "fit", "identify", "uncertainty", "export", "card", "master", "table"]
    monkeypatch.setenv("PATH", "/nowhere")
    for name in names:
        if name in [command["name"] for command in document["commands"]]:
            continue
        # table is the name of a model, too, which help explains
        asked = [] if name == "table" else [["help", name]]
        for words in ([name], [name, "x.h5", "--quiet"], *asked):
            vcor.refuses(*words, code=USAGE, says=[f"vcor-{name}", "pip install './python[all]'"])
