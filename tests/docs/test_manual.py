"""The program's description of itself, and the pages that scripts/manual.py makes from it."""

import json
import os
import re
import subprocess

import pytest
from places import ROOT
from vcor._command import MODULES, parser_of

MAN = ["man/vcor.1", "man/vcor-input.5", "man/vcor-output.5"]
MARKDOWN = ["docs/commands.md", "docs/input.md", "docs/output.md"]


@pytest.fixture(scope="module")
def document(vcor, run):
    """What `vcor help --json` prints."""
    return json.loads(run(vcor, "help", "--json"))


def test_pages_are_current(vcor, script):
    assert script(ROOT / "scripts/manual.py", "--check", vcor) == ("", "", [])


@pytest.mark.parametrize("name", MAN + MARKDOWN)
def test_page_is_plain(name):
    page = (ROOT / name).read_text(encoding="utf-8")
    assert page.isascii()
    assert not any(line.endswith(" ") for line in page.splitlines())
    assert "{{" not in page


def test_no_other_page_of_man():
    assert {f"man/{path.name}" for path in (ROOT / "man").iterdir()} == set(MAN)


@pytest.mark.parametrize("name", MAN)
def test_man_has_nothing_to_complain_about(run, name):
    words = {**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80", "MAN_KEEP_FORMATTING": ""}
    shown = run("man", "-Tutf8", "--warnings=w", "-l", ROOT / name, env=words)
    assert len(shown.splitlines()) > 50
    run("groff", "-man", "-ww", "-z", "-Tutf8", ROOT / name)


def test_document(document, vcor, run):
    assert run(vcor, "--version") == f"{document['program']} {document['version']}\n"
    assert [c["code"] for c in document["exit_codes"]] == list(range(6))
    assert [c["name"] for c in document["commands"]][:2] == ["run", "check"]
    velocity = document["groups"][1]["keys"][0]
    assert velocity["name"] == "velocity"
    assert (velocity["type"], velocity["unit"], velocity["range"]) == ("real", "m/s", "> 0")
    assert velocity["required"] and "default" not in velocity
    waves = next(k for k in document["groups"][3]["keys"] if k["name"] == "waves")
    assert waves["default"] == "relaxing" and waves["default"] in waves["choices"]


def test_every_text_is_complete(document):
    """Fortran cuts a text that is too long for its place, and pads a short one."""

    def texts(value):
        if isinstance(value, str):
            yield value
        elif isinstance(value, (list, dict)):
            for element in value.values() if isinstance(value, dict) else value:
                yield from texts(element)

    for text in texts(document):
        assert text == text.strip() and text.isascii() and text.count("`") % 2 == 0
    for command in document["commands"]:
        assert command["summary"] and command["usage"] and command["examples"]
        for entry in command["page"]:
            assert len(entry["text"]) < 560


def test_every_key_and_group(document, vcor, run):
    """What the help on the screen has, the document and the manual have too."""
    groups, keys = [], []
    for line in run(vcor, "help", "input").splitlines():
        if line.startswith("&"):
            groups.append(line.split()[0][1:])
        elif line.startswith("   ") and line[3] != " ":
            keys.append(line.split()[0])
    assert len(groups) > 8 and len(keys) > 40
    assert groups == [group["name"] for group in document["groups"]]
    assert keys == [key["name"] for group in document["groups"] for key in group["keys"]]
    page, man = ((ROOT / name).read_text() for name in ("docs/input.md", "man/vcor-input.5"))
    for group in groups:
        assert f"\n## &{group}\n" in page and f"\n.SH &{group.upper()}\n" in man
    for key in keys:
        assert page.count(f"\n| `{key}` |") == keys.count(key), key
        assert man.count(f"\n.TP\n\\fB{key}\\fR\n") == keys.count(key), key


def test_every_command_and_option(document, vcor, run):
    page, man = ((ROOT / name).read_text() for name in ("docs/commands.md", "man/vcor.1"))
    man = man.replace("\\-", "-")
    shown = [
        line[7:].split()[1]
        for line in run(vcor, "help").splitlines()
        if line.startswith(("usage: vcor", "       vcor"))
    ]
    assert shown == [command["name"] for command in document["commands"]] + ["--version"]
    for command in document["commands"]:
        assert f"\n### `vcor {command['name']}`\n" in page
        assert f"\n.SS \\fBvcor {command['name']}\\fR\n" in man
        if command["name"] == "help":
            continue
        for line in run(vcor, "help", command["name"]).splitlines():
            if line.startswith("  --"):
                term = line.strip().split("  ")[0]
                assert f"`{term}`" in page and f"\\fB{term}\\fR" in man


@pytest.mark.parametrize("name", MODULES)
def test_every_option_of_the_python_package(document, name):
    """What argparse takes stands in the manual, under its command, and says what it means."""
    page, man = ((ROOT / path).read_text() for path in ("docs/commands.md", "man/vcor.1"))
    assert name in [one["name"] for one in document["package_commands"]]
    page = page.split(f"\n### `vcor {name}`\n")[1].split("\n### ")[0]
    man = man.replace("\\-", "-").split(f"\n.SS \\fBvcor {name}\\fR\n")[1].split("\n.SS ")[0]
    parser = parser_of(name)
    actions = [action for action in parser._actions if action.dest not in ("help", "version")]
    assert len(actions) > 4
    for action in actions:
        word = (action.option_strings or [action.metavar])[0]
        assert action.help and len(action.option_strings) <= 1, word
        assert re.search(rf"^- `{word}[ `]", page, re.MULTILINE), word
        assert re.search(rf"^\\fB{word}( .*)?\\fR$", man, re.MULTILINE), word
        assert word in parser.format_help()


def test_the_parser_takes_every_option(document, vcor):
    """Each option is known, and takes a value if the page names one."""
    for command in document["commands"]:
        assert command["options"][-2:] == ["--help", "--version"]
        for entry in command["page"]:
            if "option" not in entry:
                continue
            words = [vcor, command["name"], entry["option"]]
            said = subprocess.run(words, capture_output=True, text=True, check=False).stderr
            assert "unknown option" not in said
            assert ("needs a value" in said) == bool(entry["value"]), words


def test_every_column(document, vcor, run):
    page = (ROOT / "docs/output.md").read_text()
    columns = [column["name"] for column in document["summary"]]
    for line in run(vcor, "help", "output").splitlines():
        if line.startswith("   ") and line[3] != " ":
            name = line.split()[0]
            assert f"| `{name}` |" in page
            assert name in columns or name in [status["name"] for status in document["statuses"]]
    for column in columns + [column["name"] for column in document["history"]]:
        assert f"| `{column}` |" in page


def test_the_example_of_the_input_runs(vcor, run, tmp_path):
    text = (ROOT / "docs/input.md").read_text().split("```fortran\n")[1].split("```")[0]
    (tmp_path / "case.nml").write_text(text)
    assert 0 < float(run(vcor, "run", "case.nml", "--print", "cor", "--quiet", cwd=tmp_path)) < 1
