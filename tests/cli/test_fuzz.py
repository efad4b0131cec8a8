"""Damaged cases and data files: a short run of fuzz.py, which goes on by hand."""

import pytest
from fuzz import fault_of

# Numbers of damages, eight to a test
SEEDS = range(1, 321, 8)


@pytest.mark.parametrize("first", SEEDS)
def test_damaged_input(first):
    faults = [fault for seed in range(first, first + 8) if (fault := fault_of(seed))]
    assert faults == []
