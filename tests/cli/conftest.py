"""Each test has the program in an empty folder."""

import pytest
from program import Vcor


@pytest.fixture
def vcor(tmp_path):
    """The program, run in the folder of the test."""
    return Vcor(tmp_path)
