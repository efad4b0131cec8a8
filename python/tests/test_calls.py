"""Calls of the functions of a notebook with what they do not take: a line, as in the commands."""

import numpy as np
import pandas as pd
import pytest
from conftest import PAPER, ROOT, SWEEPS

import vcor

plot = pytest.importorskip("vcor.plot", reason="needs matplotlib")
pytest.importorskip("SALib", reason="vcor.propagate needs it")

EXAMPLES = ROOT / "examples" / "identification"
CASE, DROPS, DMA = (EXAMPLES / name for name in ("rubber.nml", "drops.csv", "dma.csv"))
POWER_LAW = PAPER / "butyl_power_law.nml"
TIMES = np.geomspace(1e-5, 1.0, 40)
MODULI = 1e6 * (1 + 3 * np.exp(-TIMES / 1e-3))
GLASS = {"name": "glass", "model": "sls", "density": 2500.0, "poisson_ratio": 0.3,
         "glassy_modulus": 1e7, "alpha": 300.0, "beta": 1200.0}  # fmt: skip


def fit(**options):
    return vcor.fit((TIMES, MODULI), model="sls", **options)


def spread(vary=None, **options):
    vary = {"rubber.beta": 0.05} if vary is None else vary
    return vcor.propagate(CASE, vary, **{"samples": 64, "quantities": ["cor"]} | options)


def identified(data=DROPS, free=("rubber.beta",), **options):
    return vcor.identify(CASE, data, free, **options)


def exported(velocities=(1.0, 2.0), **options):
    return vcor.export(PAPER / "elastic.nml", "lammps", velocities, **options)


def drawn(files=None, axes=1, **options):
    path = SWEEPS / ("sls_velocity.nml" if axes == 1 else "velocity_and_radius.nml")
    return plot.figure([vcor.read(path).run()] if files is None else files, **options)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: vcor.fit((TIMES, MODULI * 1e300)), "numbers > 0, from 1e-30 to 1e30"),
        (lambda: fit(density=-1.0), r"density: found -1, expected a number in \(0, 1e\+30\]"),
        (lambda: fit(density=np.nan), "density: found nan"),
        (lambda: fit(density="heavy"), "density: expected a number"),
        (lambda: fit(poisson_ratio=0.7), r"poisson_ratio: found 0.7, .* in \(-1, 0.5\]"),
        (lambda: fit(poisson_ratio="0.5"), "poisson_ratio: expected a number"),
        (lambda: fit(terms=1.5), "terms: found 1.5, expected a whole number from 1 to 60"),
        (lambda: fit(terms=10**12), "terms: found 1000000000000"),
        (lambda: fit(fix=["beta"]), "expected at least one column of numbers, by its address or"),
        (lambda: vcor.master(DMA, reference_temperature=np.nan), "reference_temperature: found na"),
        (lambda: vcor.master(DMA, reference_temperature="20C"), "reference_temperature: expected"),
        (lambda: vcor.master(DMA, poisson_ratio=2.0), "poisson_ratio: found 2"),
        (lambda: spread({"rubber.beta": None}), "rubber.beta=None: expected such as 0.05"),
        (lambda: spread({"rubber.beta": [0.1]}), r"rubber.beta=\[0.1\]: expected such as 0.05"),
        (lambda: spread("rubber.beta"), "vary: expected a distribution by each address"),
        (lambda: spread(samples=10**9), "samples: found 1000000000, expected a whole number from"),
        (lambda: spread(samples=64.5), "samples: found 64.5"),
        (lambda: spread(seed=None), "seed: found None, expected a whole number"),
        (lambda: spread(quantities=[]), "expected one or more columns of the summary, each once"),
        (lambda: spread(quantities=["cor", "cor"]), "columns of the summary, each once"),
        (lambda: spread().figure("core"), "found no quantity 'core', expected one of cor"),
        (lambda: vcor.sensitivities(CASE, "rubber.beta", "status"), "status: found a column of w"),
        (lambda: identified([]), "expected at least one file or table of data"),
        (lambda: identified(pd.DataFrame(np.ones((3, 2)))), "found 0, expected a text"),
        (lambda: identified(free=[3]), "found 3, expected a text"),
        (lambda: identified(free=None), "found None, expected a text"),
        (lambda: identified(fix={"rubber.alpha": "x"}), "rubber.alpha: expected a number"),
        (lambda: identified(errors={"cor": "1%"}), "cor: expected a number"),
        (lambda: identified(seed=1.5), "seed: found 1.5, expected a whole number"),
        (lambda: identified(model="prony:1.5"), "expected the name of a model, or such as prony:2"),
        (lambda: identified(model="prony:99999999999"), "expected the name of a model, or such"),
        (lambda: identified(model="cef"), "did you mean 'cerf'"),
        (lambda: identified(""), "the name of a file is empty"),
        (lambda: identified(free=["solver.accuracy"]), "found a setting of the solver"),
        (lambda: exported(["fast"]), "velocities: expected numbers in one dimension"),
        (lambda: exported(np.ma.array([1, 2, 3], mask=[0, 1, 0])), "velocities > 0 that rise"),
        (lambda: vcor.export([], "lammps", [1, 2]), "cases: expected one or more"),
        (lambda: exported(law="1"), "law: found .1., expected a whole number from 1 to"),
        (lambda: vcor.export(CASE, ["lammps"], [1, 2]), "unknown program"),
        (lambda: vcor.pair({"density": 1.0}, 0.01), "expected the name of the material of each"),
        (lambda: vcor.pair(GLASS, [0.01, 0.01], masses=[1.0]), "masses > 0, one of each bead"),
        (lambda: vcor.pair(GLASS, [0.01, 0.01], masses=[1, 2, 3]), "masses > 0, one of each bead"),
        (lambda: vcor.pair(GLASS, [0.01, 0.01], masses="heavy"), "masses > 0, one of each bead"),
        (lambda: vcor.pair(GLASS, 0.01, contact=None), "&contact: found None, expected the keys"),
        (lambda: vcor.card(POWER_LAW, "butyl", band=(1e-5, np.inf)), "band: found 1e-05:inf, exp"),
        (lambda: vcor.card(POWER_LAW, "butyl", band=(1e-300, 1.0)), "expected two times .s. that"),
        (lambda: vcor.card(POWER_LAW, "butyl", band=1.0), "band: found 1, expected"),
        (lambda: vcor.card(POWER_LAW, "butyl", band="1:2"), "band: expected two times"),
        (lambda: vcor.card(POWER_LAW, "butyl", terms=1), r"sums of 1 exponentials follow .* to \d"),
        (lambda: vcor.card(POWER_LAW, "butyl", terms=5.5), "terms: found 5.5"),
        (lambda: vcor.card(POWER_LAW, "butyl", accuracy=None), "accuracy: expected a number"),
        (lambda: vcor.read_card(CASE, poisson_ratio=2.0), "poisson_ratio: found 2"),
        (lambda: vcor.read_card(CASE, modulus=-1.0), "modulus: found -1"),
        (lambda: drawn(quantities=["core"]), "found no quantity 'core'"),
        (lambda: drawn(quantities="core"), "found no quantity 'core'"),
        (lambda: drawn("sls.h5"), "sls.h5: there is no such file"),
        (lambda: drawn(log="q"), "expected letters among x, y, z"),
        (lambda: drawn(log=True), "expected letters among x, y, z"),
        (lambda: drawn(ranges={"x": 3}), "expected a range such as x=0.1:10"),
        (lambda: drawn(ranges={"q": (0, 1)}), "expected a range such as x=0.1:10"),
        (lambda: drawn(ranges={"x": (np.nan, 1)}), "expected a range such as x=0.1:10"),
        (lambda: drawn(ranges={"z": (0.2, 0.2)}, axes=2), "expected a range such as x=0.1:10"),
        (lambda: drawn(ranges={"x": (1e-300, 1)}, log="x"), "expected a range such as x=0.1:10"),
        (lambda: drawn(levels=[100, 200], axes=2), "levels from 100 to 200, expected some among"),
        (lambda: drawn(levels=0, axes=2), "levels: found 0, expected a whole number from 2 to 50"),
        (lambda: drawn(levels=2.5, axes=2), "levels: found 2.5, expected a whole number"),
        (lambda: drawn(levels=[0.2, "a"], axes=2), "levels: expected numbers"),
        (lambda: drawn(width="8"), "width: expected cm"),
        (lambda: plot.save(drawn(), "sls"), "sls: expected a name that ends with .svg, .pdf, .png"),
    ],
)  # fmt: skip
def test_wrong_arguments_are_refused(call, words):
    with pytest.raises((vcor.InputError, vcor.FileError), match=words):
        call()


def test_numbers_and_tables_of_numpy_and_pandas():
    """They are accepted as numbers and mappings."""
    wanted = spread({"rubber.beta": 0.05}).as_dict()
    for vary in ({"rubber.beta": np.float64(0.05)}, pd.Series({"rubber.beta": 0.05})):
        assert spread(vary).as_dict() == wanted
    assert fit(fix=pd.Series({"beta": 1000.0}))["beta"] == 1000.0
    masses = np.array([0.01, 0.02])
    assert vcor.pair(GLASS, [0.01, 0.01], masses=masses)["sphere.mass"] == 1 / sum(1 / masses)


def test_one_sweep_or_one_quantity_needs_no_list():
    sweep = vcor.read(SWEEPS / "sls_velocity.nml").run()
    one, other = drawn(sweep, quantities="cor"), drawn([sweep], quantities=["cor"])
    assert one.axes[0].get_ylabel() == other.axes[0].get_ylabel()


@pytest.mark.parametrize(("error", "line"), [
    (FileNotFoundError(2, "No such file", "x.csv"), "x.csv: No such file"),
    (OSError(12, "Cannot allocate memory"), "Cannot allocate memory"),
    (MemoryError(), "the memory is too small for this"),
])  # fmt: skip
def test_an_error_names_its_cause(error, line, monkeypatch, capfd):
    """Not the standard output, unless that cannot be written (test_exchange.py)."""
    from vcor import _command
    from vcor.exchange import cards

    def fail():
        raise error

    monkeypatch.setattr(cards, "_parser", fail)
    with pytest.raises(SystemExit) as end:
        _command.card()
    assert end.value.code == 4
    assert capfd.readouterr().err == f"vcor: error: {line}\n"
