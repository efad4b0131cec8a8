"""The same moduli through vcor, pyvisco and scipy alone: shift factors and Prony series.

    python benchmarks/peers.py SAMPLE_DATA

SAMPLE_DATA is the folder sample_data of https://github.com/NatLabRockies/pyvisco; data with a known
answer are made here. Needs the packages vcor and pyvisco (PyPI) in one environment. Prints the
tables of docs/identification.md.
"""

import contextlib
import io
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pyvisco
from scipy.optimize import least_squares, minimize_scalar, nnls

import vcor

#: Series with a known answer: long-time modulus, moduli [Pa], times [s]
TRUTH = (
    2e6,
    np.array([3e8, 2e8, 1e8, 4e7, 1e7]),
    np.array([2e-7, 4e-6, 6e-5, 1.5e-3, 3e-2]),
)
#: Temperature of the reference curve of the raw data [C]
REFERENCE = -5
CASE = """&impact velocity = 1 /
&sphere radius = 0.01, material = 'steel' /
&plate material = 'polymer', waves = 'none' /
&contact law = 'receding' /
&material name = 'steel', model = 'rigid', density = 7800 /
&material name = 'polymer', model = 'prony', poisson_ratio = 0.4, density = 1100,
   equilibrium_modulus = {}, moduli = {}, times = {}{} /
"""
#: Temperatures of impacts on the material of the raw data [C]
WARM = (18, 40, 62)


def moduli(x, dynamic, series):
    """E' and E'' at angular frequencies, or E at times, one row each."""
    lasting, strengths, times = series
    if not dynamic:
        return (lasting + np.exp(-x[:, None] / times) @ strengths)[None]
    p = 1j * x[:, None] * times
    found = lasting + (p / (1 + p)) @ strengths
    return np.array([found.real, found.imag])


def cor(series):
    """Coefficient of restitution of a steel ball on a block of the material."""
    lists = [", ".join(map(repr, map(float, row))) for row in series[1:]]
    return vcor.Case(CASE.format(float(series[0]), *lists, "")).solve()["cor"]


# ------------------------------------------------------------------------------ Prony series


def by_vcor(file, x, data, terms):
    """Series, standard errors of its parameters in the same order."""
    found = vcor.fit(file, model="prony", terms=terms)
    values = np.array([one.value for one in found.parameters])
    errors = np.array([one.error for one in found.parameters])
    return (values[0], values[1::2], values[2::2]), (
        errors[0],
        errors[1::2],
        errors[2::2],
    )


def by_pyvisco(file, x, data, terms):
    """A term per decade, or as many as are asked for with free times; it has no errors."""
    domain = "freq" if len(data) == 2 else "time"
    with contextlib.redirect_stdout(io.StringIO()):
        table, _ = pyvisco.load.user_master(pyvisco.load.file(file), domain, 20, "E")
        table = pyvisco.master.smooth(table, win=1)
        points = pyvisco.prony.discretize(table, "min" if terms else "round", terms or 0)
        found, _ = pyvisco.prony.fit(points, table, opt=bool(terms))
    rows = found["df_terms"]
    glassy = 1e6 * found["E_0"]
    strengths = glassy * rows["alpha_i"].to_numpy()
    kept = strengths > 0
    return (
        glassy - strengths.sum(),
        strengths[kept],
        rows["tau_i"].to_numpy()[kept],
    ), None


def by_scipy(file, x, data, terms):
    """A term per decade by non-negative least squares, or so many by least squares in logarithms."""
    dynamic = len(data) == 2
    ends = (1 / x[-1], 1 / x[0]) if dynamic else (x[0], x[-1])
    if not terms:
        times = np.geomspace(*ends, round(np.log10(ends[1] / ends[0])) + 1)
        unit = [
            moduli(x, dynamic, (0.0, np.ones(1), times[[i]])).ravel() for i in range(len(times))
        ]
        constant = np.repeat([1.0, 0.0], len(x))[: data.size]
        matrix = np.stack([constant, *unit], axis=1) / data.ravel()[:, None]
        found, _ = nnls(matrix, np.ones(data.size))
        kept = found[1:] > 0
        return (found[0], found[1:][kept], times[kept]), None

    def series(logs):
        lasting, *rest = np.exp(logs)
        return lasting, np.array(rest[:terms]), np.array(rest[terms:])

    def misfit(logs):
        return np.log(moduli(x, dynamic, series(logs)) / data).ravel()

    strengths = np.full(terms, np.ptp(data[0]) / terms)
    start = np.r_[data[0].min(), strengths, np.geomspace(*ends, terms + 2)[1:-1]]
    found = least_squares(misfit, np.log(start))
    variance = 2 * found.cost / (data.size - start.size)
    errors = np.sqrt(variance * np.diag(np.linalg.inv(found.jac.T @ found.jac)))
    return series(found.x), series(found.x + np.log(errors))


def prony(title, file, x, data, terms=(None,), truth=None):
    """Rows of one set of data."""
    print(f"\n{title}\n")
    head = [
        "",
        "terms",
        "rms misfit",
        "the same over E_0",
        "E_0 [MPa]",
        "E_inf [MPa]",
        "cor",
    ]
    head += ["worst parameter", "in its errors"] * bool(truth and any(terms)) + ["CPU time [s]"]
    print("|".join(["", *head, ""]) + "\n" + "|---" * len(head) + "|")
    if truth:
        row = ["truth", "5", "", "", f"{glassy_of(truth):.4g}", f"{truth[0] / 1e6:.4g}"]
        print("|".join(["", *row, f"{cor(truth):.5f}", *[""] * (len(head) - 7), ""]))
    for wanted in terms:
        for name, solve in (
            ("vcor", by_vcor),
            ("pyvisco", by_pyvisco),
            ("scipy", by_scipy),
        ):
            solve(file, x, data, wanted)
            start = time.process_time()
            series, errors = solve(file, x, data, wanted)
            elapsed = time.process_time() - start
            model = moduli(x, len(data) == 2, series)
            relative = np.sqrt(np.mean(np.log(model / data) ** 2))
            absolute = np.sqrt(np.mean((model - data) ** 2)) / (1e6 * glassy_of(series))
            row = [
                name,
                str(len(series[1])),
                f"{100 * relative:.3g} %",
                f"{100 * absolute:.2g} %",
            ]
            row += [
                f"{glassy_of(series):.4g}",
                f"{series[0] / 1e6:.4g}",
                f"{cor(series):.5f}",
            ]
            if truth and any(terms):
                row += known(series, errors, truth) if wanted else ["", ""]
            print("|".join(["", *row, f"{elapsed:.3f}", ""]))


def glassy_of(series):
    """Modulus at once [MPa]."""
    return (series[0] + series[1].sum()) / 1e6


def known(series, errors, truth):
    """Largest relative error of a parameter, and the largest one in standard errors."""
    order = np.argsort(series[2])
    if len(order) != len(truth[1]):
        return ["", ""]
    off = [np.abs(np.log(series[0] / truth[0])) if series[0] > 0 else np.inf]
    off += [*np.log(series[1][order] / truth[1]), *np.log(series[2][order] / truth[2])]
    worst = f"{100 * np.max(np.abs(off)):.2g} %"
    if errors is None:
        return [worst, "none given"]
    pulls = [(series[0] - truth[0]) / errors[0]]
    for k in (1, 2):
        pulls += [*((series[k][order] - truth[k]) / errors[k][order])]
    return [worst, f"{np.max(np.abs(pulls)):.2g}"]


# ------------------------------------------------------------------------------ shift factors


def shift_by_vcor(file):
    """Temperatures [C], log10 a_T, their errors, WLF constants and their errors."""
    found = vcor.master(file, reference_temperature=REFERENCE + 273.15)
    law = next(one for one in found.laws if one.name == "WLF")
    wlf = [f"{law.values[k]:.4g} +- {law.errors[k]:.2g}" for k in ("wlf_c1", "wlf_c2")]
    return found.temperatures - 273.15, found.log_shift, found.log_error, wlf


def shift_by_pyvisco(file):
    """The same, without errors."""
    raw, _, _ = pyvisco.load.user_raw(pyvisco.load.file(file), "freq", "E")
    found, _ = pyvisco.master.get_aT(raw, REFERENCE)
    law = pyvisco.shift.fit_WLF(REFERENCE, found)
    wlf = [f"{float(law[k].iloc[0]):.4g}" for k in ("C1", "C2")]
    return found["T"].to_numpy(float), found["log_aT"].to_numpy(float), None, wlf


def shift_by_scipy(file):
    """By hand: neighbours are shifted until straight lines between their points are closest."""
    table = np.genfromtxt(file, delimiter=",", skip_header=2, encoding="utf-8-sig")
    curves = [table[table[:, 4] == k] for k in np.unique(table[:, 4])]
    celsius = np.array([round(curve[:, 3].mean()) for curve in curves], float)

    def step(cold, warm):
        def misfit(shift):
            x = np.log10(warm[:, 0]) + shift
            inside = (x > np.log10(cold[0, 0])) & (x < np.log10(cold[-1, 0]))
            if inside.sum() < 3:
                return 1.0
            line = np.interp(x[inside], np.log10(cold[:, 0]), np.log(cold[:, 1]))
            return np.mean((line - np.log(warm[inside, 1])) ** 2)

        trials = np.linspace(-2.9, 0.3, 129)
        best = trials[np.argmin([misfit(trial) for trial in trials])]
        return minimize_scalar(misfit, bounds=(best - 0.03, best + 0.03), method="bounded").x

    shift = np.cumsum([0.0, *map(step, curves[:-1], curves[1:])])
    shift -= shift[np.argmin(np.abs(celsius - REFERENCE))]
    found = least_squares(
        lambda p: shift + p[0] * (celsius - REFERENCE) / (p[1] + celsius - REFERENCE),
        (17.4, 120.0),
    )
    return celsius, shift, None, [f"{value:.4g}" for value in found.x]


def shifts(file):
    """Shift factors of the raw data."""
    print("\nShift factors\n")
    found, head = {}, ["", "WLF C1", "WLF C2 [K]", "CPU time [s]"]
    rows = []
    for name, solve in (
        ("vcor", shift_by_vcor), ("pyvisco", shift_by_pyvisco), ("scipy", shift_by_scipy),
    ):  # fmt: skip
        start = time.process_time()
        celsius, shift, error, wlf = solve(file)
        rows.append([name, *wlf, f"{time.process_time() - start:.2f}"])
        found[name] = np.round(celsius), shift, error
    for row in [head, ["---"] * len(head), *rows]:
        print("|".join(["", *row, ""]))
    print("\n|T [C]|vcor|+-|pyvisco|scipy|\n|---|---|---|---|---|")
    celsius, shift, error = found["vcor"]
    for i, t in enumerate(celsius):
        others = [found[name][1][i] for name in ("pyvisco", "scipy")]
        print(f"|{t:.0f}|{shift[i]:.2f}|{error[i]:.2f}|{others[0]:.2f}|{others[1]:.2f}|")
    master = vcor.fit(vcor.master(file, reference_temperature=REFERENCE + 273.15).curve())
    lists = [", ".join(map(repr, master[key])) for key in ("moduli", "times")]
    print("\nImpacts on one series with the shift factors of each\n")
    print("|".join(["", "", *[f"cor at {t} C" for t in WARM], ""]) + "\n" + "|---" * 4 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for name, (celsius, shift, _) in found.items():
            table = Path(folder) / f"{name}.csv"
            np.savetxt(table, np.stack([celsius + 273.15, shift], axis=1), delimiter=",",
                       header="temperature [K],log10_shift_factor [1]", comments="")  # fmt: skip
            keys = f", reference_temperature = {REFERENCE + 273.15}, shift = 'table', "
            keys += f"shift_file = '{table}'"
            case = vcor.Case(CASE.format(master["equilibrium_modulus"], *lists, keys))
            cors = []
            for t in WARM:
                case["impact.temperature"] = t + 273.15
                cors.append(f"{case.solve()['cor']:.4f}")
            print("|".join(["", name, *cors, ""]))


# ------------------------------------------------------------------------------------ all


def written(folder, name, x, data):
    """A file of moduli that all three read: Hz or s, and MPa."""
    file = Path(folder) / name
    dynamic = len(data) == 2
    head = "f,E_stor,E_loss\nHz,MPa,MPa\n" if dynamic else "t,E_relax\ns,MPa\n"
    at = x / (2 * np.pi) if dynamic else x
    rows = zip(at, *(data / 1e6), strict=True)
    file.write_text(head + "".join(",".join(f"{v:.15g}" for v in row) + "\n" for row in rows))
    return file


def main(folder):
    """Print all tables."""
    print(f"vcor {vcor.__version__}, pyvisco {version('pyvisco')}, the data of {folder}")
    shifts(Path(folder) / "freq_user_raw.csv")
    for name in ("freq_user_master.csv", "time_user_master.csv"):
        file = Path(folder) / name
        table = np.genfromtxt(file, delimiter=",", skip_header=2, encoding="utf-8-sig").T
        dynamic = len(table) == 3
        x = 2 * np.pi * table[0] if dynamic else table[0]
        prony(name, file, x, 1e6 * table[1:])
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as temporary:
        for dynamic in (True, False):
            x = np.geomspace(1, 1e8, 81) if dynamic else np.geomspace(1e-8, 1, 81)
            exact = moduli(x, dynamic, TRUTH)
            for noise in (0.0, 0.01):
                data = exact * np.exp(noise * rng.normal(size=exact.shape))
                file = written(temporary, "data.csv", x, data)
                what = "storage and loss moduli" if dynamic else "relaxation moduli"
                prony(f"{what}, noise {100 * noise:g} %", file, x, data, (None, 5), TRUTH)


if __name__ == "__main__":
    main(sys.argv[1])
