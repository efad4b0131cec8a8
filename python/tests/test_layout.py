"""Modules of the package: arrows between them run one way."""

import ast
from pathlib import Path

import vcor

ROOT = Path(vcor.__file__).parent


def imports(path, known):
    """Modules of the package that a file imports, at its head or within a procedure."""
    found = set()
    own = path.relative_to(ROOT).parent.parts
    tree = ast.parse(path.read_text())
    # names of types alone are not an arrow
    tree.body = [
        one for one in tree.body
        if not (isinstance(one, ast.If) and "TYPE_CHECKING" in ast.dump(one.test))
    ]  # fmt: skip
    for node in ast.walk(tree):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        base = [*own[: len(own) + 1 - node.level], *(node.module or "").split(".")]
        base = [part for part in base if part]
        for name in node.names:
            for parts in ([*base, name.name], base):
                if ".".join(parts) in known:
                    found.add(".".join(parts))
                    break
    return found


def test_no_circle_of_imports():
    paths = {".".join(p.relative_to(ROOT).with_suffix("").parts): p for p in ROOT.rglob("*.py")}
    paths = {name: path for name, path in paths.items() if not name.endswith("__init__")}
    assert len(paths) > 10
    left = {name: imports(path, paths) - {name} for name, path in paths.items()}
    assert any(left.values())
    while ground := [name for name, needs in left.items() if not needs & left.keys()]:
        for name in ground:
            del left[name]
    assert not left
