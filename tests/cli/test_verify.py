"""The command verify: the table of laws, and cases by several methods."""

import re

import pytest
from cases import MODELS, SLS, case_text, edit
from program import FILE, INPUT, NUMERICAL, ONE_OF_EACH, PAPER, ROOT, SUCCESS, USAGE, complaint, long_tests

# Laws that the table must have, by a word of their rows, and their methods
LAWS = {
    "Hertz": ["ive", "direct"],
    "Zener": ["ive", "direct"],
    "power law": ["ive", "direct"],
    "Kelvin-Voigt": ["ive", "direct"],
    "two methods": ["ive", "direct"],
    "layer": ["ive", "direct"],
    "coupled": ["coupled"],
}
# A row: what, method, expected, found, deviation, tolerance, verdict
ROW = re.compile(
    r"^  (?P<name>\S.*?) +(?P<method>ive|direct|coupled) +(?P<expected>\S+) +(?P<found>\S+)"
    r" +(?P<deviation>\S+) +(?P<tolerance>\S+)  (?P<verdict>pass|FAIL)$"
)
# Quantities of a case that are compared
QUANTITIES = [
    "cor",
    "cor_sphere",
    "contact_time",
    "max_indentation",
    "max_force",
    "residual_indentation",
    "energy_loss",
]


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """What the program prints without a case, which takes a while in a debug build."""
    from program import Vcor

    return Vcor(tmp_path_factory.mktemp("table")).succeeds("verify")


@pytest.fixture(scope="module")
def rows(table):
    found = [ROW.match(line) for line in table.splitlines()]
    return [match.groupdict() for match in found if match]


def solutions(out):
    """The solutions of a case: cells of their lines by label."""
    lines = out.split("\n\n")[1].splitlines()[1:]
    return [re.split(r" {2,}", line.strip()) for line in lines if not line.startswith("  note")]


def digits(out):
    """Trusted digits by quantity."""
    found = {}
    for line in out.splitlines():
        cells = line.split()
        if cells and cells[0] in QUANTITIES and re.fullmatch(r"\d+", cells[-1]):
            found[cells[0]] = int(cells[-1])
    return found


def test_nothing_left_is_shown_as_zero(vcor):
    """An elastic contact leaves no indentation: what rounding leaves is none."""
    vcor.write(case_text("elastic"))
    lines = vcor.succeeds("verify", "case.nml").splitlines()
    (values,) = [line.split() for line in lines if re.match(r"  residual_indentation .* \d+$", line)]
    assert values[1:4] == ["0", "0", "0"]
    first = next(i for i, line in enumerate(lines) if "residual_indentation [m]" in line)
    shown = [line.split()[-1] for line in lines[first + 1 :] if line and "body" not in line and "half_space" not in line]
    assert len(shown) == 10 and set(shown) == {"0"}


def mechanics(out):
    """Cor by waves and law, of the case's pair and of the other one if that is shown."""
    lines = out[out.index("effect of the choice of model") :].splitlines()[2:]
    words = [line.lstrip("* ").split() for line in lines if line]
    # waves in a plate of any thickness have one law and one pair
    words = [line for line in words if line[0] not in ("body", "half_space")]
    middle = next((i for i, line in enumerate(words) if line[0] == "the"), len(words))
    tables = [{tuple(line[:2]): float(line[2]) for line in part}
              for part in (words[:middle], words[middle + 1 :])]  # fmt: skip
    return tables, [line for line in lines if "pair" in line]


def test_the_other_pair_is_shown_where_it_matters(vcor):
    """Two bodies that relax differently: the rows are those of the case with the other pair."""
    vcor.write(SLS + SLS[SLS.rindex("&material") :].replace("'rubber'", "'ball'"))
    soft = ["--set", "sphere.material=ball", "--set", "ball.beta=900.0"]
    (eq1, series), heading = mechanics(vcor.succeeds("verify", "case.nml", *soft))
    assert heading == ["  the same with pair = 'series'"]
    assert len(eq1) == len(series) == 10
    (first, second), heading = mechanics(
        vcor.succeeds("verify", "case.nml", *soft, "--set", "contact.pair=series")
    )
    assert heading == ["  the same with pair = 'eq1'"]
    assert (first, second) == (series, eq1)
    assert series["relaxing", "boltzmann"] != pytest.approx(eq1["relaxing", "boltzmann"], abs=1e-4)
    run = vcor.succeeds("run", "case.nml", *soft, "--set", "contact.pair=series", "--print", "cor")
    assert series["relaxing", "boltzmann"] == pytest.approx(float(run), abs=1e-8)


@pytest.mark.parametrize("sphere", ["steel", "rubber"])
def test_the_other_pair_is_left_out_where_it_is_the_same(vcor, sphere):
    vcor.write(SLS)
    out = vcor.succeeds("verify", "case.nml", "--set", f"sphere.material={sphere}")
    (_, other), heading = mechanics(out)
    assert not other and not heading


# ------------------------------------------------------------------------------ the table of laws


@pytest.mark.parametrize("law", LAWS)
def test_laws_of_the_table(table, rows, law):
    assert [row["method"] for row in rows if law in row["name"]] == LAWS[law]
    sources = table[table.index("sources of the expected numbers") :].splitlines()[1:]
    assert len([line for line in sources if law in line[:34]]) == 1


def test_every_row_passes(rows):
    assert len(rows) == sum(map(len, LAWS.values()))
    assert {row["verdict"] for row in rows} == {"pass"}


def test_the_table_has_a_legend(table):
    assert "  A check passes if the deviation is at most the tolerance: " in table


def test_columns_fit_together(rows):
    for row in rows:
        expected, found, deviation, tolerance = (
            float(row[name]) for name in ("expected", "found", "deviation", "tolerance")
        )
        # ten digits are printed of the numbers, two of their difference
        shown = 1e-9 * max(abs(expected), abs(found)) + 0.06 * abs(deviation)
        assert found - expected == pytest.approx(deviation, abs=shown)
        assert abs(deviation) <= tolerance


def test_the_last_line_counts(table, rows):
    assert table.splitlines()[-1] == f"{len(rows)} checks, 0 failed"


def test_the_table_fits_the_screen(table):
    assert table.isascii()
    assert all(len(line) <= 100 for line in table.splitlines())
    assert not any(line.endswith(" ") for line in table.splitlines())


def test_quiet_table(vcor):
    assert vcor.succeeds("verify", "--quiet") == ""


def test_table_twice_the_same(vcor, table):
    assert vcor.succeeds("verify") == table


@pytest.mark.parametrize("words", [["--set", "impact.velocity=1"], ["--"]])
def test_settings_need_a_case(vcor, words):
    if words == ["--"]:
        assert vcor("verify", *words, "--quiet").code == FILE
    else:
        vcor.refuses("verify", *words, code=USAGE, says=["no case file", "vcor verify"])


# ---------------------------------------------------------------------------------------- cases


@pytest.mark.parametrize("path", ONE_OF_EACH, ids=lambda path: path.stem)
def test_examples(vcor, path):
    """Every example is verified, whatever its method, plate, materials and ghost lines."""
    out = vcor.succeeds("verify", path)
    trusted = digits(out)
    assert list(trusted) == QUANTITIES
    assert trusted["cor"] >= 5
    assert f"verified: {trusted['cor']} digits of cor" in out
    assert "TOO LOW" not in out
    assert all(len(line) <= 100 and line.rstrip() == line for line in out.splitlines())
    assert list(vcor.folder.iterdir()) == []


def test_solutions_of_a_case(vcor):
    vcor.write(SLS)
    done = vcor("verify", "case.nml")
    assert done.code == SUCCESS
    assert [path.name for path in vcor.folder.iterdir()] == ["case.nml"]
    found = solutions(done.out)
    assert [line[0] for line in found] == ["ive", "ive", "direct", "direct", "direct"]
    assert [float(line[1]) for line in found[:2]] == [1e-8, 1e-10]
    steps = [int(line[2]) for line in found[2:]]
    assert steps == pytest.approx([1000, 2000, 4000], abs=2)
    cor = [float(line[3]) for line in found]
    assert cor == pytest.approx([0.43198689865] * 5, abs=1e-7)
    assert {line[-1] for line in found} == {"honest"}


@pytest.mark.parametrize("accuracy, refined", [("1e-4", 1e-6), ("1e-11", 1e-11), *long_tests(("1e-10", 1e-11))])
def test_accuracy_of_the_case(vcor, accuracy, refined):
    vcor.write(SLS)
    out = vcor.succeeds("verify", "case.nml", "--set", f"solver.accuracy={accuracy}")
    found = solutions(out)
    assert [float(line[1]) for line in found[:2]] == [float(accuracy), refined]


@pytest.mark.parametrize("model", MODELS)
def test_models(vcor, model):
    vcor.write(case_text(model))
    out = vcor.succeeds("verify", "case.nml")
    assert digits(out)["cor"] >= 5


@pytest.mark.parametrize(
    ("words", "least"),
    [
        (["solver.volterra_order=2", "solver.volterra_coefficient=100"], 6),  # direct alone
        (["plate.waves=frozen"], 6),  # direct alone
        (["plate.waves=none"], 7),
        (["solver.continue_after_separation=.true."], 7),
        (["solver.method=direct", "solver.time_step=1e-5"], 7),
    ],
)
def test_physics_and_settings(vcor, words, least):
    vcor.write(SLS)
    sets = [word for setting in words for word in ("--set", setting)]
    assert digits(vcor.succeeds("verify", "case.nml", *sets))["cor"] >= least


def test_viscosity(vcor):
    vcor.write(case_text("prony"))
    out = vcor.succeeds("verify", "case.nml", "--set", "rubber.viscosity=100")
    assert digits(out)["cor"] >= 7


def test_small_numbers(vcor):
    """A restitution with an exponent stands apart from the number of steps."""
    vcor.write(SLS)
    out = vcor.succeeds("verify", "case.nml", "--set", "plate.half_thickness=0.003")
    found = out.split("\n\n")[1].splitlines()[1:]
    assert len(found) == 5
    for line in found:
        steps, cor = line.split()[2:4]
        assert int(steps) < 10000
        assert float(cor) == pytest.approx(1.953e-4, rel=1e-2)
        assert len(line) <= 100


def significant(number):
    """Number of significant digits of a printed number."""
    return len(number.partition("E")[0].lstrip("-").replace(".", "").lstrip("0"))


def test_no_digits_that_cannot_be_trusted(vcor):
    """Both methods share the compliance of a layer: the error that they state counts too."""
    vcor.write(SLS)
    out = vcor.succeeds("verify", "case.nml", "--set", "plate.waves=body")
    n, value = re.search(r"verified: (\d+) digits of cor = (\S+) can be trusted$", out, re.M).groups()
    assert significant(value) == int(n) == digits(out)["cor"] <= 5
    _, refined, *_ = solutions(out)
    assert float(refined[4]) < float(value) * 10.0 ** -int(n)
    shown = {line.split()[0]: line.split()[1:4] for line in out.splitlines() if line[-1:].isdigit()}
    for name, trusted in digits(out).items():
        assert all(significant(number) <= trusted + 2 for number in shown[name])
    table = out[out.index("effect of the choice") :]
    (row,) = [line.split()[3:] for line in table.splitlines() if line.startswith("* ")]
    assert significant(row[0]) <= 4 and all(significant(number) <= 7 for number in row[1:])


def test_scheme_of_the_case(vcor):
    """The paper's scheme is shown next to the others, as far off as it is."""
    out = vcor.succeeds("verify", PAPER / "sls_printed.nml")
    found = solutions(out)
    assert found[0][0] == "case: adams_bashforth"
    assert float(found[0][3]) == pytest.approx(0.4313, abs=5e-5)
    assert len(found) == 6
    assert "as given" in out
    assert "is off by 6.7E-04" in out


def test_scheme_that_fails(vcor):
    """Its failure is that of the case."""
    vcor.write(SLS)
    sets = ["--set", "solver.scheme=adams_bashforth", "--set", "solver.time_step=5e-5"]
    complaint(vcor("run", "case.nml", *sets), NUMERICAL, at="case.nml")
    done = vcor("verify", "case.nml", *sets)
    complaint(done, NUMERICAL, "adams_bashforth", at="case.nml")
    assert "not verified" in done.out and "failed" in done.out


@pytest.mark.parametrize("rate", ["1.0e5", "1.0e6", "1.0e7"])
def test_sticking(vcor, rate):
    """No number to compare, but all solutions agree on that."""
    text, _ = edit(SLS, "material", "alpha", "0.0")
    text, _ = edit(text, "material", "beta", rate)
    text, _ = edit(text, "plate", "waves", "'none'")
    # without its density no plate has waves, and the table of models is short
    vcor.write(text.replace("   density = 1100.0\n", ""))
    out = vcor.succeeds("verify", "case.nml")
    found = [line for line in solutions(out) if line[-1] == "sticks"]
    assert [line[0] for line in found] == ["ive", "ive", "direct"]
    assert "there are no numbers to compare" in out


def test_no_separation(vcor):
    vcor.write(SLS)
    out = vcor.succeeds("verify", "case.nml", "--set", "solver.end_time=1e-3")
    found = [line for line in solutions(out) if line[-1] == "no_separation"]
    assert [line[0] for line in found] == ["ive", "ive", "direct"]


def test_several_cases(vcor):
    vcor.write(SLS, "a.nml")
    vcor.write(case_text("prony"), "b.nml")
    out = vcor.succeeds("verify", "a.nml", "b.nml")
    assert out.index("a.nml") < out.index("b.nml")
    assert out.count("verified:") == 2


def test_others_are_verified_when_one_fails(vcor):
    vcor.write(SLS, "b.nml")
    text, _ = edit(SLS, "solver", "scheme", "'adams_bashforth'")
    text, _ = edit(text, "solver", "time_step", "5.0e-5")
    vcor.write(text, "a.nml")
    done = vcor("verify", "a.nml", "b.nml")
    complaint(done, NUMERICAL, at="a.nml")
    assert done.out.count("\n  verified:") == 1


def test_quiet_case(vcor):
    vcor.write(SLS)
    assert vcor.succeeds("verify", "case.nml", "--quiet") == ""


def test_faulty_case(vcor):
    text, line = edit(SLS, "material", "beta", "-1.0")
    vcor.write(text)
    vcor.refuses("verify", "case.nml", code=INPUT, at=f"case.nml:{line}", says="beta")
    vcor.refuses("verify", "no.nml", code=FILE, at="no.nml")


def test_scheme_that_cannot(vcor):
    """What no run of the case could do is a fault of the case."""
    vcor.write(case_text("prony"))
    sets = ["--set", "rubber.viscosity=1", "--set", "solver.scheme=adams_bashforth"]
    vcor.refuses("verify", "case.nml", *sets, code=INPUT, at="case.nml", says="viscosity")


# ---------------------------------------------------------------------------------- documentation


def block_of_the_page(word):
    """The block of docs/accuracy.md that holds a word, without what it leaves out."""
    blocks = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8").split("```")[1::2]
    block = next(block for block in blocks if word in block)
    return [line for line in block.splitlines() if line and line != "..."]


def test_table_of_the_page(table):
    """Printed with rounding that another machine may do differently: the deviations are not."""
    lines = [line[:72] for line in table.splitlines()]
    for line in block_of_the_page("checks, 0 failed"):
        assert line[:72] in lines


def test_case_of_the_page(vcor):
    """The numbers to nine digits: the last ones are within the error of either."""
    lines = vcor.succeeds("verify", PAPER / "sls.nml").splitlines()
    cells = [line.split() for line in lines if re.search(r"\d +\d+$", line)]
    values = {words[0]: words[1:4] for words in cells if words[0] in QUANTITIES}
    header, *rows, verdict = block_of_the_page("direct, dt -> 0")
    assert header in lines
    for row in rows:
        name, *numbers = row.split()
        assert [float(number) for number in values[name]] == pytest.approx(
            [float(number) for number in numbers[:3]], rel=1e-9
        )
    # how many digits is a matter of the last ones
    assert any(re.sub(r"\d+ digits", "N digits", line).partition("=")[0]
               == re.sub(r"\d+ digits", "N digits", verdict).partition("=")[0] for line in lines)
