"""Struck structures from Python: files of modes in copies, sweeps, identification."""

import math
import pickle

import numpy as np
import pytest
from conftest import long_tests

import vcor

STEEL = {"name": "steel", "model": "elastic", "modulus": 2.1e11, "density": 7850.0,
         "poisson_ratio": 0.3}  # fmt: skip
MODES = "frequency [Hz],damping_ratio,modal_mass [kg]\n1200.0,0.02,0.03\n3400.0,0.02,0.04\n"


def on(target):
    """A steel ball at 1 m/s on a structure."""
    return vcor.Case({"impact": {"velocity": 1.0}, "sphere": {"radius": 0.005, "material": "steel"},
                      "plate": {"material": "steel"}, "target": target,
                      "material": [STEEL]})  # fmt: skip


def test_a_block_and_no_block():
    """Newton's impact of two masses; the group can be set key by key."""
    mass = 7850 * 4 / 3 * math.pi * 0.005**3
    found = on({"body": "block", "mass": 0.05}).run()
    assert float(found.cor_sphere) == pytest.approx((0.05 - mass) / (0.05 + mass), abs=1e-8)
    assert int(found.contacts) == 1
    case = vcor.Case({"impact": {"velocity": 1.0}, "sphere": {"radius": 0.005, "material": "steel"},
                      "plate": {"material": "steel", "waves": "none"},
                      "material": [STEEL]})  # fmt: skip
    assert float(case.run().structure_energy) == 0
    case["target.body"] = "block"
    case["target.mass"] = 0.05
    assert float(case.run().cor_sphere) == float(found.cor_sphere)


@pytest.mark.filterwarnings("ignore::vcor.ValidityWarning")
def test_the_file_of_modes_stays_with_the_case(tmp_path):
    """Copies, pickles and saved cases read the same file; another file in its place is refused."""
    (tmp_path / "modes.csv").write_text(MODES, encoding="utf-8")
    text = str(on({"body": "modes", "file": "modes.csv"}))
    (tmp_path / "case.nml").write_text(text, encoding="utf-8")
    case = vcor.read(tmp_path / "case.nml")
    e = float(case.run().cor_sphere)
    assert float(case.copy().run().cor_sphere) == e
    dumped = pickle.dumps(case)
    assert float(pickle.loads(dumped).run().cor_sphere) == e
    (tmp_path / "elsewhere").mkdir()
    case.save(tmp_path / "elsewhere" / "case.nml")
    assert float(vcor.read(tmp_path / "elsewhere" / "case.nml").run().cor_sphere) == e
    (tmp_path / "modes.csv").write_text(MODES.replace("1200", "1300"), encoding="utf-8")
    with pytest.raises(vcor.InputError, match=r"modes\.csv"):
        pickle.loads(dumped)


def test_a_sweep_over_the_structure():
    """Points are the single impacts."""
    case = on({"body": "block", "mass": 0.05, "stiffness": 1e6, "damping": 5.0})
    found = case.sweep({"target.mass": [0.02, 0.05], "target.stiffness": [1e6, 1e7]})
    assert found.cor_sphere.shape == (2, 2)
    assert float(found.cor_sphere[1, 0]) == pytest.approx(float(case.run().cor_sphere), abs=1e-9)
    assert set(np.unique(found.contacts)) == {1}


@pytest.mark.usefixtures("few_starts")
@pytest.mark.parametrize(
    ("damping", "keys"),
    [
        (150.0, ["stiffness", "damping"]),
        # the larger ball is struck again
        (40.0, ["damping"]),
        *long_tests((40.0, ["stiffness", "damping"])),
    ],
)
def test_identification_of_an_anvil(damping, keys):
    """Stiffness and damping of an anvil from the rebound of balls of two sizes."""
    truth = {"stiffness": 2e7, "damping": damping}
    case = on({"body": "block", "mass": 0.02, **truth})
    data = {"radius": [0.003, 0.012], "velocity": [0.5, 0.5]}
    rows = [_at(case, r, v) for r, v in zip(*data.values(), strict=True)]
    assert max(int(row.contacts) for row in rows) == (2 if damping < 100 else 1)
    data["cor_sphere"] = [float(row.cor_sphere) for row in rows]
    data["contact_time"] = [float(row.contact_time) for row in rows]
    start = case.copy()
    for key in keys:
        start[f"target.{key}"] = 1.5 * truth[key]
    found = vcor.identify(start, data, [f"target.{key}" for key in keys])
    values = {one.address: one.value for one in found.estimates}
    for key in keys:
        assert values[f"target.{key}"] == pytest.approx(truth[key], rel=1e-3)


def _at(case, radius, velocity):
    """The impact of a ball of this radius."""
    one = case.copy()
    one["sphere.radius"], one["impact.velocity"] = radius, velocity
    return one.run()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_heavy_block_below_a_layer_is_a_floor():
    """Layers and bodies at random: the law of a layer, tabulated as deep as an impact may
    go, is that for all depths, which an impact on a structure has."""
    rng = np.random.default_rng(58)
    for _ in range(20):
        nu, power = rng.uniform(0.2, 0.5), rng.uniform(1, 4)
        bodies = [
            {"radius": 0.01},
            {"shape": "cone", "half_angle": rng.uniform(60, 88)},
            {"shape": "power", "profile_power": power,
             "profile_coefficient": 50 * 0.01 ** (1 - power)},
        ]  # fmt: skip
        given = {
            "impact": {"velocity": 10 ** rng.uniform(-2, 1)},
            "sphere": {"material": "ball", "mass": 10 ** rng.uniform(-3, -1), **rng.choice(bodies)},
            "plate": {"material": "pad", "thickness": 10 ** rng.uniform(-2.7, -1.3),
                      "base": str(rng.choice(["bonded", "sliding"])), "waves": "none"},
            "contact": {"law": "receding"},
            "material": [
                {"name": "ball", "model": "rigid"},
                {"name": "pad", "model": "prony", "equilibrium_modulus": 10 ** rng.uniform(4, 6),
                 "moduli": [1e7, 1e6], "times": [1e-4, 1e-2], "poisson_ratio": nu,
                 "density": 1100.0},
            ],
        }  # fmt: skip
        names = ["cor_sphere", "max_indentation", "max_force", "contact_time"]
        block = given | {"target": {"body": "block", "mass": 1e12, "stiffness": 1e16}}
        floor, block = (
            np.array([*vcor.Case(one).points({"plate.thickness": [given["plate"]["thickness"]]},
                                             names)[names].to_array().values[:, 0]])
            for one in (given, block)
        )  # fmt: skip
        assert floor == pytest.approx(block, rel=1e-6)
