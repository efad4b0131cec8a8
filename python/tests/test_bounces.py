"""Bounces by Python: the same as in the files of the program."""

import numpy as np
import pytest

import vcor

CASE = """
&impact velocity = 2.0, gravity = 9.81, bounces = 4 /
&sphere radius = 0.02, mass = 0.04, material = 'rubber' /
&plate material = 'floor', waves = 'none' /
&material name = 'floor', model = 'rigid' /
&material name = 'rubber', model = 'sls', glassy_modulus = 15e6, alpha = 300, beta = 1200,
   poisson_ratio = 0.5, density = 1100 /
"""


def test_bounces():
    """A row per bounce with units; the first one is the impact of `run`."""
    case = vcor.Case(CASE)
    found = case.bounces()
    assert found.sizes == {"bounce": 4}
    assert list(found.bounce.values) == [1, 2, 3, 4]
    assert found.velocity.attrs["units"] == "m/s"
    first = case.run()
    assert float(found.cor[0]) == pytest.approx(float(first.cor_sphere), rel=1e-12)
    assert (int(first.bounces), str(first.bounces_end.values)) == (4, "count")
    # free flight between two bounces
    flight = found.time.values[1:] - found.last_separation.values[:-1]
    speeds = (found.cor * found.velocity).values[:-1] + found.velocity.values[1:]
    assert np.allclose(flight * 9.81, speeds, rtol=1e-9)


def test_without_a_weight():
    """One bounce, of which no height is known."""
    case = vcor.Case(CASE.replace(", gravity = 9.81, bounces = 4", ""))
    found = case.bounces()
    assert found.sizes == {"bounce": 1}
    assert np.isnan(found.rebound_height[0])
    with pytest.raises(vcor.InputError, match="comes back under its weight only"):
        vcor.Case(CASE.replace(", gravity = 9.81", "")).bounces()
