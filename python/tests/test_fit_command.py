"""vcor fit as a command: data in, a &material group out."""

import json
import re

import f90nml
import numpy as np
import pytest
from conftest import PAPER, ROOT, long_tests

SUCCESS, USAGE, INPUT, FILE, NUMERICAL = 0, 2, 3, 4, 5
POWER_LAW = PAPER / "butyl_power_law.nml"
TIMES = np.logspace(-5, -1, 41)
HEAD = "time [s],relaxation_modulus [Pa]\n"
BODIES = """&impact velocity = 10.0 /
&sphere radius = 0.01, material = 'steel' /
&plate half_thickness = 0.02, material = 'rubber' /
&material name = 'steel', model = 'rigid', density = 7800.0 /
"""
SLS = """&material name = 'rubber', model = 'sls', density = 1100.0, poisson_ratio = 0.5,
   glassy_modulus = 15e6, alpha = 300, beta = 1200 /
"""


@pytest.fixture(name="vcor")
def command(shell):
    return shell


def sls(times):
    return 15.0e6 * (0.25 + 0.75 * np.exp(-1200.0 * times))


def sls_dynamic(frequency):
    x = frequency / 1200.0
    return 3.75e6 + 11.25e6 * x**2 / (1 + x**2), 11.25e6 * x / (1 + x**2)


def columns(*numbers, head=HEAD):
    numbers = zip(*numbers, strict=True)
    rows = [",".join(f"{float(number):.17g}" for number in row) for row in numbers]
    return head + "\n".join(rows) + "\n"


def group(out):
    """The &material group of an output."""
    return f90nml.Parser().reads(out[out.index("&material") :])["material"]


def fitted(vcor, text, *words, model="sls"):
    vcor.write(text, "data.csv")
    return group(vcor.succeeds("fit", "data.csv", "--model", model, *words))


def is_the_sls(found, rel=1e-8):
    assert found["model"] == "sls"
    assert found["glassy_modulus"] == pytest.approx(15.0e6, rel=rel)
    assert found["alpha"] == pytest.approx(300.0, rel=rel)
    assert found["beta"] == pytest.approx(1200.0, rel=rel)


# What is read

DYNAMIC = "omega [rad/s],storage modulus [Pa],loss modulus [Pa]\n"
SPECTRUM = (np.logspace(-1, 6, 36), *sls_dynamic(np.logspace(-1, 6, 36)))


def test_units_and_columns_by_options(vcor):
    """Where the header does not name them."""
    text = columns(TIMES * 1e3, sls(TIMES) / 1e6, head="t,Spannung\n")
    words = ["--columns", "relaxation_modulus=Spannung", "--units", "ms,MPa"]
    is_the_sls(fitted(vcor, text, *words))
    frequency, storage, loss = SPECTRUM
    text = columns(frequency, storage, loss, head="f [rad/s],one [Pa],other [Pa]\n")
    words = ["--columns", "storage=one", "--columns", "loss=other"]
    is_the_sls(fitted(vcor, text, *words))
    vcor.refuses("fit", "data.csv", code=INPUT, says=["'one [Pa]'", "--columns"])


@pytest.mark.parametrize("name, words", [("E(t)", ["--shear"]), ("G(t)", [])])
def test_shear(vcor, name, words):
    head = f"t [s],{name} [Pa]\n" if not words else "t [s],modulus [Pa]\n"
    text = columns(TIMES, sls(TIMES) / 2.8, head=head)
    found = fitted(vcor, text, "--poisson-ratio", "0.4", *words)
    is_the_sls(found)
    assert found["poisson_ratio"] == 0.4 and "modulus_kind" not in found
    vcor.refuses("fit", "data.csv", "--model", "sls", *words, code=USAGE, says="--poisson-ratio")


def test_errors_without_those_of_a_shift_say_so(vcor):
    """Of a master curve; in the report and in the JSON, which vcor uncertainty reads."""
    text = columns(TIMES, sls(TIMES), head="t [s],E [Pa]\n")
    for keys, said in (("", False), ("# &material shift = 'wlf'\n", True)):
        vcor.write(keys + text, "data.csv")
        report = vcor.succeeds("fit", "data.csv", "--json", "fit.json")
        note = json.loads((vcor.folder / "fit.json").read_text())["note"]
        assert ("leave out those of the shift factors" in note) is said
        assert ("  note: the standard errors leave out" in report) is said


def test_standard_input(vcor):
    text = columns(TIMES, sls(TIMES))
    out = vcor.succeeds("fit", "-", "--model", "sls", input=text)
    is_the_sls(group(out))
    assert group(out)["name"] == "stdin"
    vcor.succeeds("fit", "-", "--model", "sls", "--output", "new", "--quiet", input=text)
    assert (vcor.folder / "new" / "stdin_fit.nml").is_file()
    vcor.refuses("fit", "-", code=INPUT, at="stdin:2", says="'x'", input="t [s],E [Pa]\n1,x\n")


def test_several_temperatures(vcor):
    rows = [(t, *row, kelvin) for kelvin in (0, 20, 40) for t, *row in zip(*SPECTRUM, strict=True)]
    text = columns(*zip(*rows, strict=True), head=DYNAMIC.strip() + ",T [C]\n")
    vcor.write(text, "data.csv")
    vcor.refuses("fit", "data.csv", code=INPUT, says=["3 temperatures", "no law", "vcor master"])


# What is wrong with data


def test_what_is_no_modulus(vcor):
    """A temperature sweep, and forces of a relaxation test: what they are and what to do."""
    (vcor.folder / "sweep.csv").write_text("T [C],f [Hz],E' [Pa],E'' [Pa]\n20,1,5,1\n30,1,4,1\n")
    (vcor.folder / "force.csv").write_text("t [s],F [N]\n1,3\n2,2\n")
    vcor.refuses("fit", "sweep.csv", code=INPUT, says=["one frequency at each", "identify"])
    vcor.refuses("fit", "force.csv", code=INPUT, says=["force.csv: found forces", "F/(A strain)"])


def test_unreadable(vcor):
    vcor.refuses("fit", "none.csv", code=FILE, says="No such file")
    vcor.refuses("fit", ".", code=FILE, says="found a folder")


def test_too_few_data(vcor):
    vcor.write(columns(TIMES[:3], sls(TIMES[:3])), "data.csv")
    vcor.refuses("fit", "data.csv", "--model", "sls", code=INPUT, at="data.csv",
                 says=["3 moduli", "at least 4"])  # fmt: skip
    vcor.refuses("fit", "data.csv", "--terms", "2", code=INPUT, at="data.csv", says="at least 6")


def test_nothing_relaxes(vcor):
    vcor.write("# a remark\nt [s],E [Pa]\n1,5\n2,5\n3,5\n4,5\n\n", "data.csv")
    vcor.refuses("fit", "data.csv", code=INPUT, at="data.csv", says="elastic")


@pytest.mark.parametrize(
    "text", [HEAD + "1,1\n2,2\n3,3\n4,4\n", DYNAMIC + "1,4,1\n2,3,1\n3,2,1\n4,1,1\n"]
)
def test_modulus_the_wrong_way(vcor, text):
    vcor.write(text, "data.csv")
    vcor.refuses("fit", "data.csv", code=INPUT, at="data.csv", says="does not fall with time")


@pytest.mark.parametrize("seed", [9, 123, *long_tests(10, 11, 13, 159)])
def test_as_many_terms_as_there_are(vcor, seed):
    """In spite of noise: a step of the search that stops short must not end it. With these seeds it
    was ended by three terms."""
    random = np.random.default_rng(seed)
    taus = 10 ** (-5 + np.cumsum(random.uniform(0.7, 1.5, 4)))
    moduli = 10 ** random.uniform(6, 7.5, 4)
    times = np.logspace(np.log10(taus[0]) - 1, np.log10(taus[-1]) + 1, 80)
    modulus = 3.0e6 + np.exp(-times[:, None] / taus) @ moduli
    vcor.write(columns(times, modulus * (1 + 0.004 * random.standard_normal(80))), "data.csv")
    out = vcor.succeeds("fit", "data.csv")
    assert len(group(out)["times"]) == 4
    assert float(re.search(r"rms misfit +(\S+) %", out)[1]) < 0.4


def test_too_many_terms(vcor):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    vcor.refuses("fit", "data.csv", "--terms", "4", code=NUMERICAL, says="--terms")


@pytest.mark.parametrize(
    "words, says",
    [
        (["--model", "maxwell"], ["'maxwell'", "power_law"]),
        (["--model", "sls", "--terms", "3"], ["--terms", "prony"]),
        (["--terms", "0"], ["--terms", "from 1"]),
        (["--fix", "beta"], ["KEY=VALUE"]),
        (["--model", "cerf", "--fix", "alpha=1"], ["'alpha'", "relaxing_modulus"]),
        (["--model", "cerf", "--fix", "beta=-1"], ["beta", "out of range", "> 0"]),
        (["--model", "sls", "--fix", "alpha=9", "--fix", "beta=3"], ["alpha above beta"]),
        (["--model", "cerf", "--fix", "beta=1", "--fix", "beta=2"], ["twice"]),
        (["--units", "s,GPa"], ["--units", "GPa"]),
        (["--columns", "E=nothing"], ["--columns"]),
        (["--fix", "glassy_modulus=x"], ["KEY=VALUE"]),
        (["--from", "-1"], ["--from", "> 0"]),
        (["--poisson-ratio", "0.6"], ["--poisson-ratio", "0.5"]),
        (["--density", "0"], ["density", "0"]),
        (["--dynamic"], ["--dynamic", "--from-model"]),
        (["--points", "9"], ["--points", "--from-model"]),
        (["--from-model", "case.nml"], ["both"]),
        (["other.csv"], ["one data file"]),
        (["--terns", "3"], ["--terns", "did you mean '--terms'"]),
    ],
)
def test_wrong_options(vcor, words, says):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    done = vcor("fit", "data.csv", *words)
    assert done.code in {USAGE, INPUT} and done.out == ""
    assert done.err.startswith("vcor: error: ") and done.err.count("\n") == 1
    for word in says:
        assert word in done.err


@pytest.mark.parametrize("name", ["a\udcffb", "x" * 5000, "a\nb", " "])
def test_names_that_no_case_may_have(vcor, name):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    words = ["data.csv", "--model", "sls", "--output", "fit.nml", "--name", name]
    vcor.refuses("fit", *words, code=USAGE, says="expected")


def test_no_data(vcor):
    vcor.refuses("fit", code=USAGE, says=["one data file", "--from-model"])


# What comes out


def test_screen(vcor):
    vcor.write(
        columns(
            TIMES,
            sls(TIMES),
        ),
        "rubber.csv",
    )
    out = vcor.succeeds("fit", "rubber.csv", "--model", "sls")
    for word in (
        "41 points: time from 'time [s]', relaxation_modulus",
        "glassy_modulus",
        "+- ",
        "rms misfit",
        "largest misfit",
        "1.0E-05 to 1.0E-01 s",
        "density is not known",
    ):
        assert word in out
    found = group(out)
    assert (found["valid_from"], found["valid_to"]) == pytest.approx((1e-5, 0.1))
    assert found["name"] == "rubber" and "density" not in found


def test_group_is_pasted(vcor):
    """The group makes a case that runs, and the cor is that of the material."""
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    words = ["--model", "sls", "--density", "1100", "--name", "rubber", "--output", "fit.nml"]
    vcor.succeeds("fit", "data.csv", *words)
    text = (vcor.folder / "fit.nml").read_text()
    assert text.startswith("! vcor ") and "rms misfit" in text
    vcor.write(BODIES + text)
    vcor.write(BODIES + SLS, "true.nml")
    mine, true = (vcor("run", name, "--print", "cor") for name in ("case.nml", "true.nml"))
    assert mine.code == true.code == SUCCESS
    assert float(mine.out) == pytest.approx(float(true.out), rel=1e-8)


def test_output_into_a_directory(vcor):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    (vcor.folder / "out").mkdir()
    out = vcor.succeeds("fit", "data.csv", "--model", "sls", "--output", "out", "--quiet")
    assert out == ""
    assert [path.name for path in (vcor.folder / "out").iterdir()] == ["data_fit.nml"]
    places = {"new": "new/data_fit.nml", "a/b/": "a/b/data_fit.nml", "c/d.nml": "c/d.nml"}
    for name, made in places.items():
        vcor.succeeds("fit", "data.csv", "--model", "sls", "--output", name, "--quiet")
        assert (vcor.folder / made).is_file()
    words = ["fit", "data.csv", "--model", "sls", "--output", "fit.txt"]
    vcor.refuses(*words, code=USAGE, says=["unknown format 'txt'", "nml"])


def test_output_keeps_what_was_read(vcor):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    words = ["fit", "data.csv", "--model", "sls", "--output"]
    vcor.refuses(*words, "./data.csv", code=USAGE, says="unknown format 'csv'")
    vcor.refuses(*words[:-1], "--json", "./data.csv", code=USAGE, says="replace")
    vcor.write(BODIES + SLS)
    words = ["fit", "--from-model", "case.nml:rubber", "--model", "sls", "--output"]
    vcor.refuses(*words, "case.nml", code=USAGE, says="replace")


def test_fixed_parameter(vcor):
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", "sls", "--fix", "beta=1000")
    assert re.search(r"beta +1000\.0000 1/s +given", out)
    assert group(out)["beta"] == 1000.0


def test_wrong_model(vcor):
    """A model that does not follow the data is reported."""
    words = ["fit", "--from-model", POWER_LAW, "--from", "1e-8", "--to", "1e-2", "--model"]
    assert NO_NOISE in vcor.succeeds(*words, "sls")
    assert NO_NOISE not in vcor.succeeds(*words, "power_law")


NO_NOISE = "does not follow the data"


def noisy(modulus, noise, seed):
    """Data with a relative noise."""
    return modulus * np.exp(noise * np.random.default_rng(seed).standard_normal(modulus.size))


@pytest.mark.parametrize("seed", [0, 1, *long_tests(2, 3)])
@pytest.mark.parametrize("model", ["sls", "prony"])
def test_noise_is_noise(vcor, model, seed):
    """10 % of noise on the right model is not reported as a wrong model."""
    vcor.write(columns(TIMES, noisy(sls(TIMES), 0.1, seed)), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", model)
    assert float(re.search(r"rms misfit +(\S+) %", out)[1]) > 7
    assert NO_NOISE not in out


def test_misfits_too_large_for_noise(vcor):
    """Curves that were shifted wrongly alternate, and so do their misfits."""
    frequency = np.logspace(1, 5, 40)
    storage, loss = sls_dynamic(frequency)
    loss[::2] *= 10
    loss[1::2] /= 10
    rows = "".join(f"{a},{b},{c}\n" for a, b, c in zip(frequency, storage, loss, strict=True))
    vcor.write(DYNAMIC + rows, "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", "sls")
    assert float(re.search(r"rms misfit +(\S+) %", out)[1]) > 300
    assert f"note: the model {NO_NOISE}" in out


@pytest.mark.parametrize("model, most", [("cerf", 10), ("sls", 25), ("mittag_leffler", 6)])
def test_little_noise_on_the_wrong_model(vcor, model, most):
    """Systematic misfits of a few percent are noted on the screen and in the group."""
    times = np.logspace(-6, -2, 41)
    rates, moduli = [972.0, 6426.0, 34221.0], [20.181e6, 38.204e6, 87.344e6]
    modulus = 10.421e6 + np.exp(-np.outer(times, rates)) @ moduli
    vcor.write(columns(times, noisy(modulus, 0.02, 1)), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", model)
    assert 2 < float(re.search(r"rms misfit +(\S+) %", out)[1]) < most
    assert f"note: the model {NO_NOISE}" in out and f"\n! the model {NO_NOISE}" in out
    assert NO_NOISE not in vcor.succeeds("fit", "data.csv")


def test_misfit_that_does_not_matter(vcor):
    """A series follows a power law within the accuracy of any data."""
    words = ["--from-model", POWER_LAW, "--from", "1e-6", "--to", "1e-2", "--terms"]
    assert NO_NOISE not in vcor.succeeds("fit", *words, "8")
    assert NO_NOISE in vcor.succeeds("fit", *words, "3")


def decades(times):
    """A series with one term per decade and an equilibrium modulus of 3 MPa."""
    return 3.0e6 + np.exp(-np.outer(times, 10.0 ** np.arange(1, 7))) @ (1e7 * np.arange(1, 7))


@pytest.mark.parametrize("last", [-4, -3, -2])
def test_half_a_window(vcor, last):
    """Data that end before the slowest terms do not tell the equilibrium modulus from what relaxes
    later: no standard error, but 0 to what has not relaxed."""
    times = np.logspace(-7, last, 12 * (7 + last))
    vcor.write(columns(times, noisy(decades(times), 0.003, last + 9)), "data.csv")
    out = vcor.succeeds("fit", "data.csv")
    most = re.search(r"equilibrium_modulus +\S+ Pa +not reached: 0 to (\S+)$", out, re.M)[1]
    assert 3.0e6 < float(most) < 2.0 * decades(times)[-1]
    assert f"\n! the data do not reach equilibrium_modulus: 0 to {most} Pa" in out
    assert "note: the modulus still falls where the data end" in out
    ends = re.findall(r"(\w+)\((\d)\).*\+- \S+ if nothing relaxes (\w+)(?:,|$)", out, re.M)
    terms = str(len(group(out)["times"]))
    assert [("moduli", terms, "later"), ("times", terms, "later")] == ends[-2:]
    assert {(number, when) for _, number, when in ends[:-2]} <= {("1", "earlier")}


def test_whole_window(vcor):
    times = np.logspace(-8, 1, 91)
    vcor.write(columns(times, noisy(decades(times), 0.01, 3)), "data.csv")
    out = vcor.succeeds("fit", "data.csv")
    assert "not reached" not in out and "relaxes" not in out and "still falls" not in out
    value, error = re.search(r"equilibrium_modulus +(\S+) Pa +\+- (\S+)$", out, re.M).groups()
    assert abs(float(value) - 3.0e6) < 3.0 * float(error) < 1.0e5


def test_law_beyond_the_data(vcor):
    """Values of a law at times outside the data are marked."""
    times = np.logspace(-5, np.log10(5e-4), 41)
    vcor.write(columns(times, noisy(sls(times), 0.002, 1)), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", "sls")
    marked = re.findall(r"^ +(\w+) .* if the model holds (\w+)$", out, re.M)
    assert marked == [("alpha", "later"), ("beta", "later")]


@pytest.mark.parametrize(
    "part, text",
    [(0.5, r"33 %"), (0.02, r"2\.0 %"), (2e-4, r"0\.020 %"), (3e-6, r"0\.00030 %")],
)
def test_percent(vcor, part, text):
    """1.9 %, not 1.9E+00 %. An SLS with a given relative error."""
    vcor.write(columns(TIMES, (1 + part) * sls(TIMES)), "data.csv")
    fixed = ["--fix", "glassy_modulus=15e6", "--fix", "beta=1200"]
    out = vcor.succeeds("fit", "data.csv", "--model", "sls", *fixed)
    assert re.search(rf"^  largest misfit +-{text} at", out, re.M)
    vcor.write(columns(TIMES, sls(TIMES)), "data.csv")
    out = vcor.succeeds("fit", "data.csv", *fixed, "--model", "sls")
    assert re.search(r"^  rms misfit +0 %$", out, re.M)


def test_what_the_data_do_not_determine(vcor):
    """An equilibrium modulus far below all data: its standard error is larger than itself."""
    times = np.logspace(-6, -4, 41)
    noise = np.exp(0.01 * np.random.default_rng(1).standard_normal(41))
    vcor.write(columns(times, (1e4 + 1e6 * times**-0.3) * noise), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", "power_law")
    said = re.findall(r"^ +(\w+) +(\S+) .*\+- (\S+?)(, the data do not determine it)?$", out, re.M)
    assert [name for name, *_, remark in said if remark] == ["equilibrium_modulus"]
    assert len(said) == 3
    for _, value, error, remark in said:
        assert (float(error) >= float(value)) == bool(remark)


def test_what_is_at_its_bound(vcor):
    """A modulus that vanishes is 0 with a standard error, on the screen and in the group."""
    times = np.logspace(-6, -3, 61)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal(61))
    vcor.write(columns(times, 1e6 * times**-0.3 * noise), "data.csv")
    out = vcor.succeeds("fit", "data.csv", "--model", "power_law")
    error = re.search(r"^ +equilibrium_modulus +0 Pa +\+- (\S+), at its bound$", out, re.M)[1]
    # 1 % of 8e6 Pa, the least modulus, is what one of the 61 points says
    assert 2e4 < float(error) < 4e5
    assert f"\n! equilibrium_modulus is at its bound: 0.0E+00 +- {error} Pa\n&material" in out
    assert group(out)["equilibrium_modulus"] == 0
    # a given value is not fitted: the standard errors of the others are smaller
    words = ["--model", "power_law", "--fix", "equilibrium_modulus=0"]
    given = vcor.succeeds("fit", "data.csv", *words)
    errors = [float(re.search(r"exponent .*\+- (\S+)$", text, re.M)[1]) for text in (out, given)]
    assert errors[1] < 0.8 * errors[0]
    assert "at its bound" not in given


# Sampled models


def cors(out):
    """cor of the case, and with the fit."""
    found = re.search(r"cor of the impact +(\S+) +with the fit +(\S+)", out)
    return float(found[1]), float(found[2])


def misfit(out):
    return abs(float(re.search(r"largest misfit +(\S+) %", out)[1])) / 100


@pytest.mark.parametrize("first, most, change", [("1e-6", 12, 7e-3), ("1e-8", 16, 1e-3)])
def test_butyl(vcor, first, most, change):
    """A Prony series for BUTYL's power law, with few terms and a small misfit."""
    out = vcor.succeeds("fit", "--from-model", POWER_LAW, "--from", first, "--to", "1e-2")
    assert len(group(out)["times"]) <= most
    assert misfit(out) <= 1e-3
    exact, found = cors(out)
    assert abs(found - exact) <= change


def test_butyl_with_few_terms(vcor):
    """The misfit falls with 3, 5 and 8 terms."""
    words = ["--from-model", POWER_LAW, "--from", "1e-8", "--to", "1e-2"]
    off = []
    for terms in (3, 5, 8):
        exact, found = cors(vcor.succeeds("fit", *words, "--terms", terms))
        off.append(abs(found - exact))
    assert off[0] > off[1] > off[2]


def test_the_papers_fit(vcor):
    """Eq. (24) to Eq. (23-b): with its relaxing modulus, 676.5 MPa, over 1e-6 to 1e-2 s, its beta,
    700 s^-1/2, comes out."""
    words = ["--model", "cerf", "--fix", "relaxing_modulus=676.5e6"]
    out = vcor.succeeds("fit", "--from-model", POWER_LAW, "--from", "1e-6", "--to", "1e-2", *words)
    assert group(out)["beta"] == pytest.approx(700.0, rel=0.01)


def test_dynamic_samples(vcor):
    words = ["--from-model", POWER_LAW, "--from", "1e-6", "--to", "1e-2", "--points", "41"]
    out = vcor.succeeds("fit", *words, "--dynamic")
    assert "rad/s" in out
    exact, found = cors(out)
    assert found == pytest.approx(exact, abs=1e-4)


def test_material_by_name(vcor):
    vcor.write(BODIES + SLS)
    words = ["fit", "--model", "sls", "--from-model"]
    found = group(vcor.succeeds(*words, "case.nml:rubber"))
    is_the_sls(found)
    assert found["density"] == 1100.0
    vcor.refuses(*words, "case.nml:steel", code=INPUT, says="does not relax")
    vcor.refuses(*words, "case.nml:rubbr", code=USAGE, says=["'rubbr'", "rubber"])
    vcor.refuses(*words, "no.nml", code=FILE, says="no such file")


def test_a_number_of_a_list(vcor):
    """--set changes the case that is sampled."""
    prony = SLS.replace("'sls'", "'prony'").replace(
        "glassy_modulus = 15e6, alpha = 300, beta = 1200",
        "equilibrium_modulus = 4e6, moduli = 6e6, 9e6, times = 2e-4, 3e-3",
    )
    vcor.write(BODIES + prony, "a.nml")
    vcor.write(BODIES + prony.replace("9e6", "7e6"), "b.nml")
    words = ("fit", "--terms", "2", "--name", "x", "--from-model")
    found = vcor.succeeds(*words, "a.nml", "--set", "rubber.moduli(2)=7e6").split("&material")[1]
    assert found == vcor.succeeds(*words, "b.nml").split("&material")[1]


def test_a_shifted_material_is_sampled_at_its_temperature(vcor):
    """The group has no shift, and moduli given as G are sampled as E."""
    shift = "shift = 'wlf', reference_temperature = 298.15, wlf_c1 = 8.0, wlf_c2 = 90.0 /"
    for temperature, found in ((310.5, " at 310.5 K"), (298.15, "")):
        text = BODIES.replace("velocity = 10.0", f"velocity = 10.0, temperature = {temperature}")
        vcor.write(text + SLS.replace("/\n", f", {shift}\n"))
        out = vcor.succeeds("fit", "--from-model", "case.nml", "--model", "sls")
        assert f" samples of rubber{found}, time" in out
        assert f"fit of sls to case.nml{found}\n" in out and "shift" not in group(out)
        assert abs(np.subtract(*cors(out))) < 1e-6
    vcor.write(BODIES + SLS.replace("/\n", ", modulus_kind = 'shear' /\n"))
    found = group(vcor.succeeds("fit", "--from-model", "case.nml", "--model", "sls"))
    assert found["glassy_modulus"] == pytest.approx(45e6, rel=1e-6)


def warning(vcor, *words, name=POWER_LAW):
    """The notes of run on the band, without those on validity."""
    done = vcor("run", name, "--print", "cor", *words)
    assert done.code == SUCCESS
    return "".join(line for line in done.err.splitlines(keepends=True) if "validity " not in line)


def change(line):
    return abs(float(re.search(r"cor changes by (\S+),", line)[1]))


def test_band_of_a_fit(vcor):
    """What fit writes, run reads. Of the kernel before 1 us, which carries 1e-2, the fit makes up
    one half."""
    words = ["--from-model", POWER_LAW, "--from", "1e-6", "--to", "1e-2", "--output", "fit.nml"]
    vcor.succeeds("fit", *words)
    text = POWER_LAW.read_text()
    text = text[: text.index("&material", text.index("&material") + 1)]
    vcor.write(text + (vcor.folder / "fit.nml").read_text())
    line = warning(vcor, name="case.nml")
    assert "valid_from 1.0E-06 s, valid_to 1.0E-02 s" in line
    assert change(line) == pytest.approx(5.1e-3, rel=0.1)


# The fits of docs/data.md, and those of the paper's rubber

DATA = (ROOT / "docs" / "data.md").read_text()
PAPER = (ROOT / "docs" / "reproducing_the_paper.md").read_text()
DOCUMENT = DATA[DATA.index("\n## Fits\n") :] + PAPER[PAPER.index("\n## Prony series of BUTYL\n") :]
COMMANDS = [
    line.split()[1:]
    for block in re.findall(r"```sh\n(.*?)```", DOCUMENT, re.DOTALL)
    for line in block.splitlines()
    if "soft_rubber_data" not in line  # the example has a test of its own
]


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_commands_of_the_document(vcor, words):
    """They run, and give the numbers of the tables and the warning."""
    done = vcor(*[ROOT / word if word.startswith("examples/") else word for word in words])
    assert done.code == SUCCESS
    if words[0] == "run":
        assert done.err.replace(f"{ROOT}/", "").strip() in DOCUMENT
    elif words[0] == "fit":
        assert done.err == ""
        assert f"| {cors(done.out)[1]:.4f} |" in DOCUMENT
        if "prony," in done.out:
            terms = len(np.atleast_1d(group(done.out)["times"]))
            assert "2e-5" in words or re.search(
                rf"\| {terms}[ (automatic)]* \|.*{cors(done.out)[1]:.4f}", DOCUMENT
            )


def test_the_document_has_commands():
    assert len(COMMANDS) == 10


def test_the_example_of_the_page(vcor):
    """Its numbers are those of docs/data.md, and those of the material that the data are of."""
    words = ["--model", "mittag_leffler", "--density", "1100", "--name", "soft rubber"]
    out = vcor.succeeds("fit", ROOT / "examples" / "soft_rubber_data.csv", *words)
    shown = DATA[DATA.index("57 points: time") : DATA.index("band of the data    1.0E-07")]
    assert shown in out
    assert group(out)["exponent"] == pytest.approx(0.5, rel=1e-4)
