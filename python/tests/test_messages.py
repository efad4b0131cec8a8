"""Messages speak of parameters in Python, and of options in the commands."""

import ast
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import vcor
import vcor.plot
from vcor import _command, _text
from vcor._command import MODULES, parser_of
from vcor.materials.table import table

ROOT = Path(vcor.__file__).parent
#: What only commands call, and what writes a command for a shell
OF_COMMANDS = {"_parser", "_work", "_serve", "main", "joined", "add_outputs", "add_data_options",
               "commands"}  # fmt: skip
#: Public functions whose parameters messages may name
FUNCTIONS = [
    *(getattr(vcor, name) for name in vcor.__all__ if inspect.isfunction(getattr(vcor, name))),
    vcor.page.make, vcor.Case.page, vcor.plot.figure, table, _text.place,
]  # fmt: skip


def parts():
    """Each procedure of the package with its file, what is below it included."""
    for path in sorted(ROOT.rglob("*.py")):
        for node in ast.parse(path.read_text()).body:
            for one in node.body if isinstance(node, ast.ClassDef) else [node]:
                yield path, one


def documentation(tree):
    """Texts that are no values: docstrings."""
    return {id(one.value) for one in ast.walk(tree) if isinstance(one, ast.Expr)}


def test_no_message_of_a_function_names_an_option():
    found, seen = [], 0
    for path, node in parts():
        name = getattr(node, "name", "")
        if path.stem.endswith("_command") or name in OF_COMMANDS:
            seen += 1
            continue
        for one in ast.walk(node):
            if isinstance(one, ast.Constant) and isinstance(one.value, str) and (
                re.search(r"(^|[^-\w])--[a-z]", one.value) and id(one) not in documentation(node)
            ):  # fmt: skip
                found.append(f"{path.name}: {name}: {one.value}")
    assert seen > 20
    assert found == []


def test_what_messages_name_is_a_parameter_and_an_option():
    parameters = {name for one in FUNCTIONS for name in inspect.signature(one).parameters}
    options = {a.dest for name in MODULES for a in parser_of(name)._actions if a.option_strings}
    named = {
        node.args[0].value
        for path in ROOT.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call)
        and getattr(node.func, "id", "") == "option"
        and isinstance(node.args[0], ast.Constant)
    }
    assert len(named) > 25
    # shear and use_shift are of commands that have functions with other names
    assert named - parameters - {"shear", "output", "format"} == set()
    assert named - options - {"terms"} == set()


@pytest.mark.parametrize("value, in_shell, in_python", [
    (None, "--no-shift", "use_shift"), (False, "--no-shift", "use_shift=False"),
    (0.5, "--no-shift 0.5", "use_shift=0.5"), ("prony", "--no-shift prony", "use_shift='prony'"),
    ({"a.b": ...}, "--no-shift a.b=VALUE", "use_shift={'a.b': ...}"),
    ({"cor": 0.02}, "--no-shift cor=0.02", "use_shift={'cor': 0.02}"),
    ({"x": (0.0, 1.0)}, "--no-shift x=0:1", "use_shift={'x': (0, 1)}"),
    ({"cor": "E [Pa]"}, "--no-shift 'cor=E [Pa]'", "use_shift={'cor': 'E [Pa]'}"),
])  # fmt: skip
def test_a_parameter_is_written_as_its_user_does(value, in_shell, in_python):
    assert _text.option("use_shift", value) == in_python
    assert _text.command("fit") == "vcor.fit"
    with _command.one_line():
        parser_of("card").options(["case.nml"])
        assert _text.option("use_shift", value) == in_shell
        # an option that this command has not is a parameter
        assert _text.option("fix") == "fix"
        assert _text.command("fit") == "vcor fit"
    assert _text.option("use_shift", value) == in_python


def test_the_same_message_of_a_function_and_of_its_command(tmp_path, capsys):
    path = tmp_path / "data.csv"
    t = np.geomspace(1e-4, 1, 20)
    rows = "".join(f"{x},{1e6 + 1e7 * np.exp(-x / 0.01)}\n" for x in t)
    path.write_text(f"t [s],G [Pa]\n{rows}")
    with pytest.raises(vcor.UsageError) as error:
        vcor.fit(path)
    assert "expected poisson_ratio, by which" in str(error.value)
    with pytest.raises(SystemExit):
        _command.call("fit", [str(path)])
    assert "expected --poisson-ratio, by which" in capsys.readouterr().err
    with pytest.raises(vcor.UsageError) as error:
        vcor.fit(path, poisson_ratio=0.7)
    assert str(error.value) == "poisson_ratio: found 0.7, expected a number in (-1, 0.5]"


def test_a_failed_command_leaves_no_options_behind(tmp_path, capsys):
    with pytest.raises(SystemExit):
        _command.call(
            "plot", [str(tmp_path / "nothing.h5"), "--quantity", "cor", "--kind", "history"]
        )
    assert "vcor: error: " in capsys.readouterr().err
    assert _text.option("quantities") == "quantities"
