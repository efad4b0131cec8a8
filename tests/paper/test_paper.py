"""Every printed number of the paper, and what becomes of it when the step is refined."""

import csv
import itertools
import os
import re
import subprocess
from decimal import Decimal
from xml.etree import ElementTree

import convergence
import make_document
import pytest
from printed import CASES, call, cor, half_unit, named_step, outcome, program, read_table

ROWS = read_table()
EACH = pytest.mark.parametrize("row", ROWS, ids=lambda row: row.id)

# All schemes have to be this close to internal variables at their finest
CLOSE = 1e-6
# Exit code of a numerical failure
NUMERICAL = 5


@EACH
def test_printed(row):
    """The run gives the printed digits, or does not where the table says so."""
    computed = row.computed()
    report = (
        f"{row.quantity} [{row.unit}]: printed {row.printed}, computed {computed:.10g}, "
        f"tolerance {row.tolerance}, expected to agree: {row.reproduced}"
    )
    print(report)
    assert row.agrees() == (row.reproduced == "yes"), report


@EACH
def test_converged(row):
    """The converged value of the table is right to its last digit."""
    computed = row.computed_converged()
    unit = 2 * float(half_unit(row.converged))
    report = f"{row.quantity} [{row.unit}]: table {row.converged}, computed {computed:.10g}"
    print(report)
    assert abs(computed - float(row.converged)) <= unit, report


@EACH
def test_row(row):
    """Nobody has loosened a tolerance, and the table is complete."""
    allowed = half_unit(row.printed)
    if allowed is None:
        # In words: the number that is meant, and at most two digits of it in doubt
        assert re.search("[a-z]", row.printed)
        assert float(row.tolerance) <= 0.05 * float(row.value)
    else:
        assert Decimal(row.tolerance) == allowed
        assert row.value == row.printed
    assert row.reproduced in {"yes", "no"}
    for text in (row.quantity, row.symbol, row.unit, row.place, row.remark):
        assert text and text == text.strip()


def test_rows_are_distinct():
    assert len({row.id for row in ROWS}) == len(ROWS) > 20


def test_every_case_has_its_figure():
    """Each figure of the paper is named by a case, which says how to run what it shows."""
    texts = [path.read_text() for path in sorted(CASES.glob("*.nml"))]
    for figure in range(1, 10):
        named = re.compile(rf"Figs?\. [^.:;]*\b{figure}\b|Figs\. {figure - 1} to {figure + 1}\b")
        assert any(named.search(text) for text in texts), f"Fig. {figure}"
    for text in texts:
        assert text.startswith("! ")


# Convergence


def report(series):
    for dt, value, error in zip(series.steps, series.values(), series.errors(), strict=True):
        print(f"{series.name}: {dt} us, COR {value:.9f}, error {error:.2e}")
    print("order", " ".join(f"{order:.2f}" for order in series.orders()))


@pytest.mark.parametrize(
    ("series", "order", "within"),
    [
        (convergence.SLS_RECTANGLE, 1.0, 0.1),
        (convergence.PRONY_RECTANGLE, 1.0, 0.1),
        # Better than second order, as the leading terms nearly cancel
        (convergence.SLS_TRAPEZOID, 2.3, 0.3),
        (convergence.PRONY_A, 1.8, 0.2),
        (convergence.PRONY_B, 2.0, 0.1),
        # Theory: 5/2, from the start of the contact
        (convergence.SLS_PRODUCT, 2.5, 0.25),
        # The cap at the step takes the square root of it off the integral of the kernel
        (convergence.CAPPED, 0.5, 0.1),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_order(series, order, within):
    report(series)
    assert all(abs(measured - order) <= within for measured in series.orders()[-2:])


@pytest.mark.parametrize(
    "series", [convergence.SLS_TRAPEZOID, convergence.SLS_PRODUCT], ids=lambda series: series.name
)
def test_finest(series):
    """At the finest step, without any extrapolation."""
    report(series)
    assert abs(series.errors()[-1]) <= CLOSE


def test_rectangle_sums_extrapolated():
    """Rectangle sums would take a nanosecond; the limit follows from their last two steps."""
    series = convergence.SLS_RECTANGLE
    report(series)
    limit = series.extrapolated(1)
    print(f"step 0: {limit:.9f}")
    assert abs(limit - cor(series.converged)) <= CLOSE


# Second term of the Volterra series


VOLTERRA = "solver.volterra_order=2 solver.volterra_coefficient={}"
SECOND = ["sls", "butyl_prony"]
FINE = f"{convergence.PRODUCT} solver.accuracy=1e-9"
CONVERGED = {"sls": convergence.SLS_CONVERGED, "butyl_prony": convergence.PRONY_CONVERGED}


@pytest.mark.parametrize("coefficient", [1, 200])
@pytest.mark.parametrize("case", SECOND)
def test_second_term_product(case, coefficient):
    second = VOLTERRA.format(coefficient)
    fine = cor(f"{case}.nml {FINE} {second}")
    product = cor(f"{case}.nml {convergence.PRODUCT} solver.accuracy=1e-7 {second}")
    assert abs(product - fine) <= CLOSE
    assert abs(fine - cor(CONVERGED[case])) > CLOSE


@pytest.mark.parametrize("form", ["a", "b"])
@pytest.mark.parametrize("coefficient", [1, 200])
@pytest.mark.parametrize("case", SECOND)
def test_second_term_adams_bashforth(case, coefficient, form):
    """Trapezoidal sums at a step of 0.125 us, not extrapolated."""
    second = VOLTERRA.format(coefficient)
    run = f"{case}.nml {convergence.TRAPEZOID} solver.form={form} solver.time_step=1.25e-7"
    found, fine = cor(f"{run} {second}"), cor(f"{case}.nml {FINE} {second}")
    print(found, fine, found - fine)
    assert abs(found - fine) <= CLOSE


@pytest.mark.parametrize("coefficient", [1, 200])
@pytest.mark.parametrize("case", SECOND)
def test_second_term_rectangle(case, coefficient):
    """Rectangle sums, extrapolated from steps of 0.5, 0.25 and 0.125 us with orders 1 and 3/2."""
    second = VOLTERRA.format(coefficient)
    converged = f"{case}.nml {FINE} {second}"
    settings = f"{convergence.RECTANGLE} {second}"
    series = convergence.Series("", settings, f"{case}.nml", (0.5, 0.25, 0.125), converged)
    limit = series.extrapolated(1, 1.5)
    print(series.values(), limit, cor(converged))
    assert abs(limit - cor(converged)) <= CLOSE


def test_second_term_is_insignificant():
    """What the paper found for its coefficient, in the digits that it prints."""
    for case in SECOND:
        plain = f"{case}.nml {FINE}"
        assert abs(cor(f"{plain} {VOLTERRA.format(1)}") - cor(plain)) < 0.00005


# Explicit marching is stable for small steps only


UNSTABLE = {
    "Eq. (24) at 10 m/s": "butyl_cerf.nml",
    "Eq. (23-b) at 50 m/s": "butyl_power_law.nml impact.velocity=50",
}


@pytest.mark.parametrize("impact", UNSTABLE)
def test_unstable(impact, tmp_path):
    """No number comes out, but a step that works."""
    run = f"{UNSTABLE[impact]} {convergence.RECTANGLE} solver.time_step="
    done = call(run + "1e-6", "--output", str(tmp_path))
    assert done.returncode == NUMERICAL
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("vcor: error: ")
    assert "restitution" not in done.stdout
    assert not list(tmp_path.iterdir())
    printed = call(run + "1e-6", "--print", "cor")
    assert printed.returncode == NUMERICAL
    assert printed.stdout == "nan\n"
    step = named_step(done.stderr)
    assert 0 < step < 1e-6
    exact = cor(f"{UNSTABLE[impact]} solver.accuracy=1e-6")
    assert abs(cor(run + repr(step)) - exact) < 0.01
    # It is not far from the largest one
    assert call(run + repr(2 * step)).returncode == NUMERICAL


# Figures


def summaries(case, velocities, settings=""):
    return [outcome(f"{case} impact.velocity={v} {settings}".rstrip()) for v in velocities]


def rises(values):
    return all(a < b for a, b in itertools.pairwise(values))


def test_figure_4():
    """With the paper's rate the COR rises over the whole range."""
    assert rises([run.cor for run in summaries("sls_velocities.nml", [1, 2, 5, 10, 20, 30])])


def test_figure_8():
    """Both curves fall, the one of the Prony series lies higher."""
    velocities = [1, 2, 5, 10, 20, 35, 50]
    prony = [run.cor for run in summaries("butyl_prony_velocities.nml", velocities)]
    power_law = [run.cor for run in summaries("butyl_power_law_velocities.nml", velocities)]
    assert rises(prony[::-1])
    assert rises(power_law[::-1])
    assert all(a > b for a, b in zip(prony, power_law, strict=True))


def test_figure_9():
    """Faster impacts are shorter, deeper, stronger and lose more."""
    runs = summaries("butyl_power_law_velocities.nml", [1, 2, 5, 10, 20, 35, 50])
    assert rises([run.min_frequency for run in runs])
    assert rises([run.max_indentation for run in runs])
    assert rises([run.max_force for run in runs])
    assert rises([run.hysteresis_energy for run in runs])


@pytest.mark.parametrize(
    ("case", "lines", "columns"),
    [
        ("sls_velocities", 12, 3),
        ("butyl_prony_velocities", 3, 3),
        ("butyl_power_law_velocities", 3, 7),
    ],
)
def test_loop_in_the_comment(case, lines, columns, tmp_path):
    """The shell loops run as they are written, here with fewer velocities."""
    text = (CASES / f"{case}.nml").read_text().split("\n&", 1)[0]
    script = "\n".join(line[3:] for line in text.splitlines() if line.startswith("!   "))
    script, count = re.subn(r"seq 1 (\d+)", r"seq 10 \1 | head -n 3", script.replace("50", "12"))
    assert count == 1
    (tmp_path / "vcor").symlink_to(program())
    done = subprocess.run(
        ["bash", "-euc", script],
        cwd=CASES,
        env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    rows = [line.split() for line in done.stdout.splitlines()]
    assert [len(row) for row in rows] == [columns] * lines
    assert all(float(word) > 0 for row in rows for word in row)


@pytest.mark.parametrize(
    ("ghost", "plain", "end"),
    [
        ("sls_ghost", "sls_printed.nml", 2e-3),
        ("butyl_power_law_ghost", "butyl_power_law_printed.nml", 1.2e-3),
        ("butyl_prony_ghost", "butyl_prony.nml plate.waves=frozen solver.end_time=1.2e-3", 1.2e-3),
    ],
)
def test_ghost_lines(ghost, plain, end, tmp_path):
    """The history goes on with a negative force; the summary is that of the separation."""
    done = call(f"{ghost}.nml", "--output", str(tmp_path), "--quiet")
    assert (done.returncode, done.stderr) == (0, "")
    text = (tmp_path / f"{ghost}.csv").read_text().splitlines()
    history = list(csv.DictReader(line for line in text if not line.startswith("#")))
    times = [float(line["time"]) for line in history]
    forces = [float(line["force"]) for line in history]
    summary = outcome(f"{ghost}.nml")
    assert times[-1] == pytest.approx(end, rel=1e-3)
    after = [f for t, f in zip(times, forces, strict=True) if t > 1.001 * summary.contact_time]
    assert len(after) > 10
    assert after[0] < 0
    assert summary.cor == pytest.approx(cor(plain), abs=1e-9)


# The document


def test_document_is_up_to_date():
    """What is committed says what the program gives, to the digits shown."""
    make_document.compare(make_document.DOCUMENT.read_text("utf-8"), make_document.document())


def test_figure_is_up_to_date():
    """To a tenth of a point."""
    committed = make_document.FIGURE.read_text("utf-8")
    ElementTree.fromstring(committed)
    # the name of a clip path is a hash of numbers, and changes with the last digit of one
    texts = [re.sub(r"\bp[0-9a-f]{10}\b", "path", text) for text in (committed, make_document.figure())]
    parts, others = (re.split(r"(-?\d+\.\d+)", text) for text in texts)
    assert parts[::2] == others[::2]
    assert list(map(float, parts[1::2])) == pytest.approx(list(map(float, others[1::2])), abs=0.1)


def test_document_comparison_can_fail():
    make_document.compare("COR 0.4313 at 2", "COR 0.4314 at 2")
    with pytest.raises(AssertionError):
        make_document.compare("COR 0.4313", "COR 0.4315")
    with pytest.raises(AssertionError):
        make_document.compare("COR 0.4313", "e 0.4313")
