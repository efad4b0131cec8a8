"""Damaged cases, tables, data, cards, JSON and HDF5: a short run of fuzz_package.py."""

import pytest
from fuzz_package import KINDS, fault_of

#: Damages of each kind
EACH = 24


@pytest.mark.parametrize("first", range(len(KINDS)), ids=[kind.__name__ for kind in KINDS])
def test_damaged_input(first):
    seeds = range(first, first + EACH * len(KINDS), len(KINDS))
    assert [fault for seed in seeds if (fault := fault_of(seed))] == []
