"""Write docs/reproducing_the_paper.md and docs/convergence.svg from the table and live runs.

    VCOR=build/release/vcor python tests/paper/make_document.py

The text stands in document.md; {{NAME}} is replaced by what the functions below give for it.
"""

import io
import re

import convergence
from matplotlib import rc_context
from matplotlib.figure import Figure
from printed import HERE, ROOT, call, cor, named_step, outcome, read_table

TEMPLATE = HERE / "document.md"
DOCUMENT = ROOT / "docs" / "reproducing_the_paper.md"
FIGURE = ROOT / "docs" / "convergence.svg"

NOTE = "<!-- Written by tests/paper/make_document.py from document.md: change that -->\n\n"


# Tables


def table(head, lines, right=()):
    """A table of Markdown; the columns of `right` are aligned to the right."""
    marks = ["--:" if i in right else "---" for i in range(len(head))]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, marks, *lines])


def code(run):
    """A run as code."""
    return "`" + run.replace(".nml", "", 1) + "`"


def run_cell(row):
    """The runs of a row."""
    return f"{code(row.run)} over {code(row.other)}" if row.other else code(row.run)


def printed_table():
    """What is printed, what the program gives for it, and the converged value."""
    head = ["", "quantity", "unit", "printed", "computed", "tolerance", "converged", "by", "needs"]
    lines = []
    for row in read_table():
        mark = "yes" if row.agrees() else "**no**"
        lines.append(
            [
                mark,
                f"{row.quantity}, {row.symbol} ({row.place})",
                row.unit,
                row.printed,
                f"{row.computed():.{row.decimals()}f}",
                row.tolerance,
                row.converged,
                run_cell(row),
                row.remark,
            ]
        )
    return table(head, lines, right={4, 5, 6})


def converged_table():
    """The runs behind the converged values."""
    runs = dict.fromkeys(
        run for row in read_table() for run in (row.converged_run, row.converged_other) if run
    )
    lines = [
        [code(run), f"{outcome(run).cor:.6f}", f"{1e3 * outcome(run).contact_time:.5f}"]
        for run in runs
    ]
    return table(["run", "COR", "$t_0$, ms"], lines, right={1, 2})


def signed(error, floor):
    """An error with two digits, unless it says nothing."""
    return f"below {floor:.0e}" if abs(error) < floor else f"{error:+.1e}"


def convergence_table(group):
    """Errors and orders of several series with the same steps."""
    head = ["step, µs"]
    for series in group:
        head += [series.name.split(", ", 1)[1], "error", "order"]
    columns = [
        (series, series.values(), series.errors(), [None, *series.orders()]) for series in group
    ]
    lines = []
    for i, step in enumerate(group[0].steps):
        line = [f"{step:g}"]
        for series, values, errors, orders in columns:
            order = f"{orders[i]:.1f}" if 0 < i < len(orders) else ""
            line += [f"{values[i]:.7f}", signed(errors[i], series.floor), order]
        lines.append(line)
    return table(head, lines, right=set(range(3 * len(group) + 1)))


def velocity_table():
    """COR of the SLS plate against the velocity, for the rates of Fig. 4."""
    velocities = [1, 2, 5, 10, 20, 30]
    lines = []
    for beta in (600, 1200, 2400, 4800):
        material = f"rubber.beta={beta} rubber.alpha={beta // 4}"
        values = [cor(f"sls_velocities.nml impact.velocity={v} {material}") for v in velocities]
        lines.append([str(beta), *(f"{value:.4f}" for value in values)])
    head = ["beta, 1/s", *(f"{v} m/s" for v in velocities)]
    return table(head, lines, right=set(range(len(head))))


PLATES = [
    ("SLS", "sls.nml"),
    ("BUTYL, Prony series (26)", "butyl_prony.nml"),
    ("BUTYL, (23-b)", "butyl_power_law.nml"),
    ("BUTYL, (24)", "butyl_cerf.nml"),
    ("BUTYL, (23-b), 50 m/s", "butyl_power_law.nml impact.velocity=50"),
    ("BUTYL, (24), 50 m/s", "butyl_cerf.nml impact.velocity=50"),
]


def plate_table():
    """Relaxing against frozen plate, converged."""
    lines = []
    for name, run in PLATES:
        line = [name]
        for waves in ("relaxing", "frozen"):
            found = outcome(f"{run} plate.waves={waves} solver.accuracy=1e-7")
            line += [
                f"{found.cor:.4f}",
                f"{1e3 * found.max_indentation:.3f}",
                f"{found.hysteresis_energy:.4g}",
                f"{found.min_frequency:.0f}",
            ]
        lines.append(line)
    parts = ["COR", "$s_{max}$, mm", "$W_h$, J", "$\\omega_{min}$, rad/s"]
    head = ["", *(f"{part}, relaxing" for part in parts), *(f"{part}, frozen" for part in parts)]
    return table(head, lines, right=set(range(1, 9)))


def volterra_table():
    """COR with the second Volterra term."""
    lines = []
    for name, run in [
        ("SLS", "sls.nml solver.method=direct solver.accuracy=1e-7"),
        ("BUTYL, Prony series (26)", "butyl_prony.nml solver.method=direct solver.accuracy=1e-7"),
        ("BUTYL, (23-b)", "butyl_power_law.nml solver.method=direct solver.accuracy=1e-7"),
    ]:
        second = [
            cor(f"{run} solver.volterra_order=2 solver.volterra_coefficient={c}") for c in (1, 200)
        ]
        lines.append([name, *(f"{value:.6f}" for value in [cor(run), *second])])
    return table(["", "without", "$c_2$ = 1", "$c_2$ = 200"], lines, right={1, 2, 3})


# Figure


# Colour, line and marker of each series: a colour is a kernel, a marker a scheme
STYLES = [("C0", "-", "o"), ("C0", "-", "s"), ("C0", "-", "^"), ("C1", "--", "o"), ("C1", "--", "^")]


def figure():
    """Errors against the step, both axes logarithmic, as SVG."""
    with rc_context(fname=ROOT / "python/src/vcor/vcor.mplstyle"):
        made = Figure(figsize=(5.2, 3.4), layout="constrained")
        axis = made.subplots()
        for series, (colour, line, marker) in zip(convergence.ALL, STYLES, strict=True):
            points = [
                (step, abs(error))
                for step, error in zip(series.steps, series.errors(), strict=True)
                if abs(error) >= series.floor
            ]
            look = {"color": colour, "linestyle": line, "marker": marker, "markerfacecolor": "white"}
            axis.loglog(*zip(*points, strict=True), label=series.name, **look)
        axis.set(xlabel="time step [\N{MICRO SIGN}s]", ylabel="error of the COR", ylim=(1e-9, 1e-1))
        axis.xaxis.set_major_formatter("{x:g}")
        made.legend(ncols=2, loc="outside upper center")
        text = io.StringIO()
        made.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


# Document


POWER_LAW_50 = f"butyl_power_law.nml {convergence.RECTANGLE} impact.velocity=50"
FROZEN_50 = f"{POWER_LAW_50} plate.waves=frozen solver.time_step=4e-7"
# Runs that explicit marching cannot do
CERF_UNSTABLE = f"butyl_cerf.nml {convergence.RECTANGLE} solver.time_step=1e-6"
POWER_LAW_UNSTABLE = f"{POWER_LAW_50} solver.time_step=4e-7"


def stable_step(run):
    """The step that the error of an unstable run names, in us."""
    return f"{1e6 * named_step(call(run).stderr):.2f}"


def replacements():
    """What stands for each name of the template that is not a row of the table."""
    rectangle = convergence.SLS_RECTANGLE
    return {
        "printed": printed_table,
        "converged": converged_table,
        "sls_convergence": lambda: convergence_table(
            [rectangle, convergence.SLS_TRAPEZOID, convergence.SLS_PRODUCT]
        ),
        "singular_convergence": lambda: convergence_table(
            [convergence.CAPPED, convergence.SINGULAR]
        ),
        "prony_convergence": lambda: convergence_table(
            [convergence.PRONY_RECTANGLE, convergence.PRONY_A, convergence.PRONY_B]
        ),
        "rectangle_limit": lambda: f"{rectangle.extrapolated(1):.7f}",
        "sls_limit": lambda: f"{cor(rectangle.converged):.7f}",
        "stable_cerf": lambda: stable_step(CERF_UNSTABLE),
        "stable_power_law": lambda: stable_step(POWER_LAW_UNSTABLE),
        "frozen_marching": lambda: f"{outcome(FROZEN_50).hysteresis_energy:.1f}",
        "velocities": velocity_table,
        "plates": plate_table,
        "volterra": volterra_table,
        "rows": lambda: str(len(read_table())),
        "agree": lambda: str(sum(row.agrees() for row in read_table())),
    }


def document():
    """The whole document."""
    rows = {row.id: row for row in read_table()}
    names = replacements()

    def replace(match):
        name = match.group(1)
        if name in names:
            return names[name]()
        # ROW.printed, ROW.computed, ROW.converged
        row, _, column = name.partition(".")
        if column == "computed":
            return f"{rows[row].computed():.{rows[row].decimals()}f}"
        return getattr(rows[row], column)

    return NOTE + re.sub(r"\{\{([\w.]+)\}\}", replace, TEMPLATE.read_text("utf-8"))


NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]\d+)?(?![\w])")


def last_digit(text):
    """The unit of the last digit of a number."""
    mantissa, _, exponent = text.partition("e")
    _, _, decimals = mantissa.partition(".")
    return 10.0 ** (int(exponent or 0) - len(decimals))


def compare(committed, made):
    """Two texts agree but for one unit in the last digit of a number."""
    assert NUMBER.sub("#", committed) == NUMBER.sub("#", made)
    for old, new in zip(NUMBER.findall(committed), NUMBER.findall(made), strict=True):
        if old != new:
            unit = max(last_digit(old), last_digit(new))
            assert abs(float(old) - float(new)) <= 1.01 * unit, f"{old} is now {new}"


if __name__ == "__main__":
    DOCUMENT.write_text(document(), "utf-8")
    FIGURE.write_text(figure(), "utf-8")
    print(f"written {DOCUMENT.relative_to(ROOT)}, {FIGURE.relative_to(ROOT)}")
