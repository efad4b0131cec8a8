"""Each test has the program in an empty folder."""

import shutil

import pytest
from program import ROOT, Vcor


@pytest.fixture
def vcor(tmp_path):
    """The program, run in the folder of the test."""
    return Vcor(tmp_path)


@pytest.fixture
def data_files(vcor):
    """The data of the examples: a case that is made from one looks for them next to it."""
    for path in (ROOT / "examples").glob("*_data.csv"):
        shutil.copy(path, vcor.folder)
