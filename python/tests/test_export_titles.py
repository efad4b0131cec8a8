"""Exports with any title and name: each file as the parser of its format reads it."""

import ast
import io
import re
import subprocess
import xml.etree.ElementTree as ET

import numpy as np
import pandas as pd
import pytest
from conftest import PAPER, ROOT
from properties import given, settings, st

import vcor
from vcor.arguments import written
from vcor.exchange import codes

VELOCITIES = np.geomspace(1.0, 5.0, 4)
TRAPS = ["x---><script>evil</script><!---", "-->", "--", "---", "----", "-", "--->", "<!--", "]]>",
         "&amp;", "&", "x &", "\\", "a\\", "??/", "*/", "/*", "//", "'''", '"""', "#", "!", "$x",
         "${x}", "@step", "@", "{0}", "%s", "coding: latin-1", "-*- coding: nonsense -*-",
         "vim: set x:", "\u2028import os", "\u0085", "weiß", "橡胶", " ", "x" * 300]  # fmt: skip
TITLES = st.one_of(
    st.lists(st.sampled_from(TRAPS), min_size=1, max_size=4).map("".join),
    st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=60),
)
#: How a line of a comment begins, for files that no parser here reads
LINES = {"lammps": "#", "liggghts": "#", "mfix": "!"}


def parsed(name, ending, text, folder):
    """A file as the parser of its format reads it, without comments."""
    if ending == ".xml":
        return ET.tostring(ET.fromstring(text))
    if ending == ".py":
        return ast.dump(ast.parse(text.encode()))
    if ending == ".csv":
        return pd.read_csv(io.StringIO(text), comment="#").to_csv()
    if ending in (".c", ".cpp"):
        (folder / f"x{ending}").write_text(text)
        words = ["gcc", "-E", "-P", "-trigraphs", "-Wcomment", "-Werror", "-x", "c", f"x{ending}"]
        # the headers of MercuryDPM are not here
        text = re.sub(r"(?m)^#include.*$", "", text)
        (folder / f"x{ending}").write_text(text)
        done = subprocess.run(words, cwd=folder, capture_output=True, encoding="utf-8", check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout
    # LAMMPS and LIGGGHTS join a line that ends with & to the next one before they drop comments
    lines = re.sub(r"&[ \t]*\n", "", text).splitlines()
    return [line for line in lines if line.strip() and not line.startswith(LINES[name])]


def bare():
    """The SLS case on a rigid plate."""
    case = vcor.read(PAPER / "sls.nml")
    case["plate.waves"] = "none"
    return case


@pytest.fixture(scope="module")
def curve():
    """Results that all exports of this page are made of."""
    return codes.solved(bare(), VELOCITIES, "cor_sphere", 1)


@pytest.fixture(scope="module", params=list(codes.TARGETS))
def plain(request, curve, tmp_path_factory):
    """A target, and its files with a plain title: as they are, and as they are read."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(codes, "solved", lambda *_: curve)
        texts = vcor.export(bare(), request.param, VELOCITIES).texts
    folder = tmp_path_factory.mktemp("plain")
    read = {ending: parsed(request.param, ending, one, folder) for ending, one in texts.items()}
    return request.param, texts, read


@settings(max_examples=25)
@given(title=TITLES, name=TITLES)
def test_a_title_is_a_comment(tmp_path, curve, plain, title, name):
    target, texts, read = plain
    text = bare().text().replace("'rubber'", written(name, ""))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(codes, "solved", lambda *_: curve)
        try:
            other = vcor.Case(text)
            other["case.title"] = title
            other.text()
        except vcor.InputError:
            return
        found = vcor.export(other, target, VELOCITIES)
    assert found.texts.keys() == texts.keys()
    for ending, one in found.texts.items():
        assert parsed(target, ending, one, tmp_path) == read[ending]
        assert one.count("\n") == texts[ending].count("\n")


@pytest.mark.parametrize("target", list(codes.TARGETS))
def test_elastic_pairs(tmp_path, target):
    """e is 1 and nowhere more, which programs refuse."""
    glass = {"name": "glass", "model": "elastic", "modulus": 7e10, "density": 2500.0,
             "poisson_ratio": 0.2}  # fmt: skip
    found = vcor.export(vcor.pair(glass, (0.005, 0.004)), target, VELOCITIES)
    assert float(found.table.e.max()) <= 1
    assert float(found.table.e.min()) > 1 - 1e-6
    for _, twin in found.options.items():
        assert twin.cor.max() <= 1
        assert twin.entered <= 1
    assert not re.search(r"(?<![\d.])1\.0*[1-9]\d* damping coeff_restitution", str(found))


def test_e_above_1_is_refused(monkeypatch):
    case = vcor.read(ROOT / "examples/granular_pair.nml")
    points = vcor.Case.points

    def lifted(self, *arguments, **options):
        found = points(self, *arguments, **options)
        found["cor_sphere"] = found.cor_sphere * 0 + 1.01
        return found

    monkeypatch.setattr(vcor.Case, "points", lifted)
    with pytest.raises(vcor.NumericalError, match=r"found cor_sphere = 1.01 at .* at most 1"):
        vcor.export(case, "lammps", VELOCITIES)
