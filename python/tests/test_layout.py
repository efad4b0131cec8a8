"""Modules of the package: arrows between them run one way."""

import ast
from pathlib import Path

import vcor

ROOT = Path(vcor.__file__).parent


def imports(path, known, *, at_once=False):
    """Modules of the package that a file imports, anywhere, for types alone too; or `at_once`."""
    found = set()
    own = path.relative_to(ROOT).parent.parts
    tree = ast.parse(path.read_text())
    for node in tree.body if at_once else ast.walk(tree):
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


def arrows(**which):
    """Modules that each module imports."""
    paths = {".".join(p.relative_to(ROOT).with_suffix("").parts): p for p in ROOT.rglob("*.py")}
    paths = {name: path for name, path in paths.items() if not name.endswith("__init__")}
    assert len(paths) > 10
    return {name: imports(path, paths, **which) - {name} for name, path in paths.items()}


#: Layers: cases, results, sweeps and their figures; materials from data; exchange
CORE = {
    "_command", "_coverage", "_differences", "_library", "_outputs", "_text", "arguments", "case",
    "material", "material_files", "plot", "points", "progress", "results", "sources", "units",
}  # fmt: skip
EXCHANGE = "exchange."


def layer(name):
    """0, 1 or 2."""
    return 0 if name in CORE else 2 if name.startswith(EXCHANGE) else 1


def test_three_layers():
    found = arrows()
    assert set(found) > CORE and {layer(name) for name in found} == {0, 1, 2}
    for name, needs in found.items():
        assert {one for one in needs if layer(one) > layer(name)} == set(), name


def test_a_case_is_no_module_of_figures():
    """Its method `plot` is put there by the package: no module is named in a text either."""
    for name in CORE - {"_command"}:
        assert "import_module" not in (ROOT / f"{name}.py").read_text(), name


def test_what_a_case_is_stands_in_its_handle():
    """No module of the core keeps anything about cases but the library."""
    for name in CORE:
        text = (ROOT / f"{name}.py").read_text()
        assert "weakref" not in text and "WeakKey" not in text, name


def test_what_draws_nothing_starts_without_figures():
    """Matplotlib, xarray and h5py take most of the time in which such a command starts."""
    needs = arrows(at_once=True)
    for name in ("case", "exchange.cards", "materials.fit_command", "materials.identification",
                 "materials.master", "materials.table"):  # fmt: skip
        found, left = set(), [name]
        while left:
            found.add(one := left.pop())
            left += needs[one] - found
        assert len(found) > 4 and not found & {"plot", "results", "sources"}, (name, found)


def test_no_circle_of_imports():
    left = arrows()
    assert any(left.values())
    while ground := [name for name, needs in left.items() if not needs & left.keys()]:
        for name in ground:
            del left[name]
    assert not left
