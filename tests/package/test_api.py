"""The pages that FORD makes of the comments in the sources."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LIMIT = 1000


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Folder of the pages, and what FORD said about them."""
    folder = tmp_path_factory.mktemp("ford") / "api"
    done = subprocess.run(
        # without the pages of the sources, which take a fifth of its time
        [sys.executable, "-m", "ford", "--output_dir", folder, "--config", "incl_src = false",
         ROOT / "docs/site/fortran.md"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=LIMIT,
        check=False,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stdout
    return folder, done.stdout


def test_no_warning(pages):
    """A first line as 'Word: ...' is taken for a setting, for example: reword it."""
    words = [part for part in re.split(r"(?=Warning:)", pages[1]) if part.startswith("Warning:")]
    assert not words, words
    # its progress names what it is at, the module error among others
    assert not re.search(r"[Ee]rror:|ERROR|Exception|Traceback", pages[1]), pages[1]


def test_every_module_has_a_page(pages):
    sources = [*(ROOT / "src").rglob("*.f90"), *(ROOT / "src").rglob("*.F90")]
    assert len(sources) > 80
    for source in sources:
        path = source.relative_to(ROOT / "src").with_suffix("")
        assert (pages[0] / "module" / f"{'_'.join(path.parts)}.html").exists()


def test_the_first_page_has_the_example(pages):
    first = (pages[0] / "index.html").read_text(encoding="utf-8")
    assert "from_code" in first and "new_contact_modulus" in first
    assert "[[" not in first and "{!" not in first


def names_in(text, pattern):
    """Names of a list that a statement of Fortran has, its continuation lines joined."""
    found = set()
    for part in re.findall(pattern, re.sub(r"&\s*\n\s*", "", text)):
        found |= {name.strip() for name in part.split(",")}
    return found


def test_the_facade_is_used():
    """A program that uses module vcor alone takes every name of it; so do the examples."""
    facade = (ROOT / "src/vcor.f90").read_text()
    public = names_in(facade, r"public :: (.*)")
    assert 50 < len(public) < 90
    text = (ROOT / "tests/unit/test_library.f90").read_text()
    assert names_in(text, r"use vcor, only : (.*)") == public
    assert set(re.findall(r"use (\w+), only", text)) == {"vcor", "vcor_test"}
    for name in public:
        assert len(re.findall(rf"\b{name}\b", text)) > 1, f"{name} is not used"
