"""Hypothesis as the tests of properties use it: half a second to import, which few files need."""

from conftest import EVERYTHING
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

__all__ = ["HealthCheck", "assume", "example", "examples", "given", "settings", "st"]

# The same examples in each run, and nothing written next to the sources
settings.register_profile("vcor", deadline=None, database=None, derandomize=True,
                          suppress_health_check=list(HealthCheck))  # fmt: skip
settings.load_profile("vcor")


def examples(count):
    """Settings of a property: so many examples in the long tests, a third of them in the others."""
    return settings(max_examples=count if EVERYTHING else -(-count // 3))
