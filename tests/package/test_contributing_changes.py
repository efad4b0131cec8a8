"""The examples of CONTRIBUTING.md can be put where the page says, and what they change compiles.

A long test, test_contributing.py, builds the program with them and runs it.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import contributing
import pytest
from contributing import (
    ADDED,
    CATALOGUE,
    EXAMPLES,
    FACTORY,
    FEATURES,
    INPUTS,
    READER,
    ROOT,
    SHAPE,
    blocks,
    text_of,
)

BUILD = Path(os.environ["VCOR_BUILD"])


#: Files of each example to compile, each after those that it uses; of a method also the only one that holds the length
#: of the table
COMPILED = {
    "a column of the summary": ["src/vcor/sweep/quantity.f90"],
    "a key of the input": [CATALOGUE, INPUTS, "src/vcor/case/body.f90", READER],
    "a shape of the striking body": [SHAPE, CATALOGUE],
    "a method": [FEATURES, "src/vcor/solver/type.f90", "src/vcor/solver/my_method.f90", FACTORY],
}


@pytest.mark.parametrize("title", EXAMPLES)
def test_the_page_names_the_file_of_each_block(title):
    """A reader finds the file of each block, and the file exists."""
    text = text_of(title)
    assert len(blocks(title)) == len(EXAMPLES[title])
    for name, _, _ in EXAMPLES[title]:
        assert f"`{name}`" in text
    for name in re.findall(r"`((?:src|app|tests|docs|scripts|python)/[\w/.]+\.\w+)`", text):
        assert (ROOT / name).exists() or name in ADDED[title], name


@pytest.mark.parametrize("title", EXAMPLES)
def test_what_they_change_compiles(title, tmp_path):
    """Each changed file, with the modules of this build for the others."""
    shutil.copytree(ROOT / "src", tmp_path / "src")
    cache = (BUILD / "CMakeCache.txt").read_text("utf-8")
    compiler = re.search(r"^CMAKE_Fortran_COMPILER:\w+=(.*)$", cache, re.M)[1]
    (modules,) = {path.parent for path in BUILD.glob("include/**/vcor_error.mod")}
    contributing.apply(title, tmp_path)
    assert {name for name, _, _ in EXAMPLES[title]} | {*ADDED.get(title, {})} <= {*COMPILED[title]}
    options = ["-std=f2008", "-fopenmp", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    for name in COMPILED[title]:
        done = subprocess.run(
            [compiler, *options, "-J", tmp_path, "-I", modules, name],
            cwd=tmp_path,
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stderr
