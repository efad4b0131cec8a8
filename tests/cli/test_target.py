"""Impacts on structures: numbers, refusals, files of modes, sweeps, what the screen says."""

import csv
import json

import h5py
import pytest
from program import EVERYTHING, INPUT, NUMERICAL, ROOT, SUCCESS, long_tests

RELAXING = json.loads(
    (ROOT / "tests" / "reference" / "structures.json").read_text(encoding="utf-8")
)
STEEL = "name = 'steel', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3, density = 7850"
GLASS = "name = 'glass', model = 'elastic', modulus = 70e9, poisson_ratio = 0.22, density = 2500"
RUBBER = "name = 'rubber', model = 'sls', glassy_modulus = 15e6, alpha = 300, beta = 1200, poisson_ratio = 0.5, density = 1100"
BLOCK = "body = 'block', mass = 0.05"
CANTILEVER = "body = 'beam', support = 'cantilever', length = 0.15, width = 0.02, damping_ratio = 0.02"
PANEL = "body = 'plate', support = 'supported', length = 0.06, width = 0.045"
BAR = "body = 'rod', support = 'free', length = 0.3, diameter = 0.02"
LIST = "body = 'modes', file = 'modes.csv'"
HEAD = "frequency [Hz],damping_ratio,modal_mass [kg]\n"
MODES = HEAD + "1200.0,0.02,0.03\n3400.0,0.02,0.04\n"
# A slow mode that the ball leaves before it comes back
SLOW = HEAD + "20.0,0.02,0.4\n"


def case(target, plate="", impact="velocity = 1.0", more="", ball="steel", face="steel"):
    """A steel ball on a structure whose surface is of steel."""
    return f"""&impact {impact} /
&sphere radius = 0.005, material = '{ball}' /
&plate material = '{face}'{plate} /
&target {target} /
&material {STEEL} /
&material {GLASS} /
&material {RUBBER} /
{more}"""


def numbers(vcor, text, names, *words):
    """Some columns of a case."""
    vcor.write(text)
    done = vcor("run", "case.nml", "--print", ",".join(names), *words)
    assert done.code == SUCCESS, done.err
    return [float(word) for word in done.out.split()]


def refused(vcor, text, *words):
    """The line with which a case is refused."""
    vcor.write(text)
    done = vcor("run", "case.nml", *words)
    assert (done.code, done.out) == (INPUT, "")
    assert done.err.count("\n") == 1
    return done.err


def test_free_block(vcor):
    """Newton's impact of two masses, whatever the contact is, if it is elastic."""
    names = ["cor_sphere", "cor", "contacts", "last_separation", "contact_time", "structure_energy", "initial_energy"]
    mass = 7850 * 4 / 3 * 3.141592653589793 * 0.005**3
    e, relative, contacts, last, time, left, before = numbers(vcor, case(BLOCK), names)
    assert e == pytest.approx((0.05 - mass) / (0.05 + mass), abs=1e-8)
    assert relative == pytest.approx(1, abs=1e-8)
    assert (contacts, last) == (1, time)
    assert left == pytest.approx(before * (1 - e**2), rel=1e-7)


def test_without_a_structure(vcor):
    """One contact, whose end is the last separation, and no energy in a structure."""
    names = ["contacts", "last_separation", "contact_time", "structure_energy", "highest_mode"]
    text = case("").replace("&target  /\n", "").replace("material = 'steel' /\n&mat", "material = 'steel', waves = 'none' /\n&mat")
    contacts, last, time, left, highest = numbers(vcor, text, names)
    assert (contacts, last, left) == (1, time, 0)
    assert highest != highest


def test_cantilever_is_struck_again(vcor):
    """The impact on a cantilever of tests/reference/target.txt: 11 contacts; the first separation says nothing."""
    text = case(CANTILEVER, ", thickness = 0.003")
    vcor.write(text)
    out = vcor.succeeds("run", "case.nml")
    assert "the first separation, with cor_sphere -3.3E-01, is not the end" in out
    assert "11 contacts" in out
    assert "caution: contacts 11.0" in out
    assert "target beam cantilever" in out
    summary = list(csv.DictReader(line for line in open(vcor.folder / "case_summary.csv") if line[0] != "#"))[0]
    assert float(summary["cor_sphere"]) == pytest.approx(0.25944601616545, abs=1e-6)
    assert float(summary["last_separation"]) == pytest.approx(0.0039087447540, rel=1e-6)
    assert float(summary["structure_energy"]) == pytest.approx(0.000403408708, rel=1e-6)
    assert summary["validity_cause"] == "contacts"
    rows = list(csv.DictReader(line for line in open(vcor.folder / "case.csv") if line[0] != "#"))
    force = [float(row["force"]) for row in rows]
    assert float(rows[-1]["time"]) == pytest.approx(0.0039087447540, rel=1e-6)
    # the force ends and begins again
    assert sum(a > 0 >= b for a, b in zip(force, force[1:], strict=False)) >= 5


def test_infinite_limits(vcor):
    """A wide plate is an infinite one, and a long rod a dashpot rho c A."""
    wide = PANEL.replace("0.06", "0.5").replace("0.045", "0.5")
    names = ["cor_sphere"]
    [finite] = numbers(vcor, case(wide, ", thickness = 0.003"), names)
    text = case("", ", thickness = 0.003, waves = 'constant'").replace("&target  /\n", "")
    assert finite == pytest.approx(numbers(vcor, text, names)[0], abs=1e-6)
    [rod] = numbers(vcor, case(BAR.replace("0.3", "2.0")), names)
    drag = 7850 * (210e9 / 7850) ** 0.5 * 3.141592653589793 / 4 * 0.02**2
    assert rod == pytest.approx(numbers(vcor, case(f"body = 'block', mass = 1e-9, damping = {drag!r}"), names)[0], abs=1e-5)


REFUSED = {
    "a key of another body": (BLOCK + ", length = 0.1", "", "does not belong to body 'block'"),
    "no body": ("mass = 0.1", "", "key 'body' is missing in &target"),
    "no mass": ("body = 'block'", "", "key 'mass' is missing"),
    "a mass of zero": ("body = 'block', mass = 0.0", "", "expected a number > 0 [kg]"),
    "a negative spring": (BLOCK + ", stiffness = -1.0", "", "expected a number >= 0 [N/m]"),
    "a clamped plate": (PANEL.replace("supported", "clamped"), ", thickness = 0.003", "give its modes from finite elements"),
    "a free plate": (PANEL.replace("supported", "free"), ", thickness = 0.003", "expected support = 'supported' of a plate"),
    "a rod on supports": (BAR.replace("free", "supported"), "", "of the far end of a rod"),
    "beyond the end": (CANTILEVER + ", position = 0.16", ", thickness = 0.003", "found position = 0.16 and length = 0.15"),
    "beside the plate": (PANEL + ", position = 0.03, 0.05", ", thickness = 0.003", "0 <= position <= width"),
    "on a clamp": (CANTILEVER + ", position = 0.0", ", thickness = 0.003", "the impact is on a support"),
    "on an edge": (PANEL + ", position = 0.03, 0.0", ", thickness = 0.003", "the impact is on a support"),
    "one number for a plate": (PANEL + ", position = 0.03", ", thickness = 0.003", "expected two numbers for a plate"),
    "two numbers for a beam": (CANTILEVER + ", position = 0.1, 0.1", ", thickness = 0.003", "expected one number for a beam"),
    "no thickness": (PANEL, "", "needs its thickness"),
    "a ratio of 1": (CANTILEVER.replace("0.02", "1.0").replace("width = 1.0", "width = 0.02"), ", thickness = 0.003", "[0, 1)"),
    "a layer without a body": (PANEL, ", thickness = 0.003, base = 'bonded'", "key 'material' is missing in &target"),
    "a layer as thick as the body": (PANEL + ", material = 'steel'", ", thickness = 0.003, base = 'bonded'", "its thickness"),
    "no such material": (PANEL + ", material = 'brass'", ", thickness = 0.003", "there is no material 'brass' for &target"),
    "an extent": (BLOCK, ", extent = 0.1", "found extent with &target"),
    "waves of a thin plate": (BLOCK, ", thickness = 0.003, waves = 'hereditary'", "expected waves = 'none'"),
    "waves in a plate": (PANEL, ", thickness = 0.003, waves = 'body'", "the modes of this body hold the bending"),
    "waves in a beam": (CANTILEVER, ", thickness = 0.003, waves = 'body'", "the modes of this body hold the bending"),
    "waves in a free plate": (BLOCK, ", thickness = 0.003, waves = 'body'", "moves beside the structure"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(vcor, name):
    target, plate, words = REFUSED[name]
    assert words in refused(vcor, case(target, plate))


SETTINGS = {
    "solver.scheme=adams_bashforth": "'direct' with scheme = 'product'",
    "solver.volterra_order=2": "expected volterra_order = 1",
    "solver.continue_after_separation=.true.": "continuing has no meaning",
    "impact.gravity=9.81": "falls with the sphere",
    "target.length=0.1": "does not belong to body 'block'",
    "plate.thickness=0.003": "has no thickness of its own",
}


def test_what_falls_is_named(vcor):
    """A structure that nothing holds falls with the ball: the line names the keys of its body only."""
    (vcor.folder / "modes.csv").write_text(HEAD + "0.0,0.0,1.0\n900.0,0.0,1.0\n", encoding="utf-8")
    impact = "velocity = 1.0, gravity = 9.81"
    line = refused(vcor, case(LIST, impact=impact))
    assert "gravity = 9.81" in line and "'modes.csv'" in line and "stiffness" not in line
    line = refused(vcor, case(BAR, impact=impact))
    assert "support = 'free'" in line and "stiffness" not in line
    line = refused(vcor, case(BLOCK, impact=impact))
    assert "stiffness = 0.0" in line and "support" not in line


@pytest.mark.parametrize("setting", SETTINGS)
def test_settings_refused(vcor, setting):
    assert SETTINGS[setting] in refused(vcor, case(BLOCK), "--set", setting)


FILES = {
    "a unit of kHz": (MODES.replace("[Hz]", "[kHz]"), "'kHz' as unit of frequency, expected Hz"),
    "a unit of rad/s": (MODES.replace("[Hz]", "[rad/s]"), "'rad/s' as unit of frequency, expected Hz"),
    "no unit": (MODES.replace(" [Hz]", ""), "no unit of frequency, expected [Hz]"),
    "grams": (MODES.replace("[kg]", "[g]"), "'g' as unit of modal_mass, expected kg"),
    "no names": (MODES.replace(HEAD, ""), "numbers without names"),
    "another name": (MODES.replace("modal_mass", "weight"), "found 'weight'"),
    "two frequencies": (MODES.replace("damping_ratio", "frequency [Hz]"), "found 'frequency' after 'frequency'"),
    "two columns": ("frequency [Hz],modal_mass [kg]\n1200,0.03\n", "found 2 columns, expected 3"),
    "no modes": (HEAD, "found 0 points, expected 1 at least"),
    "a mass of zero": (MODES.replace("0.04", "0.0"), "expected a modal mass > 0"),
    "a negative mass": (MODES.replace("0.04", "-0.04"), "expected a modal mass > 0"),
    "a negative frequency": (MODES.replace("1200.0", "-1200.0"), "expected a frequency >= 0"),
    "a ratio above 1": (MODES.replace("0.02,0.04", "1.2,0.04"), "expected a damping ratio in [0, 1)"),
    "a text": (MODES.replace("1200.0", "first"), "expected a number"),
    "three rigid ones": (HEAD + 3 * "0.0,0.0,0.1\n", "expected at most two"),
    "nodes only": (HEAD.replace("modal_mass [kg]", "mode_shape [kg^-0.5]") + "1200,0.01,0.0\n", "on a node of every mode"),
}


@pytest.mark.parametrize("name", FILES)
def test_files_refused(vcor, name):
    text, words = FILES[name]
    (vcor.folder / "modes.csv").write_text(text, encoding="utf-8")
    line = refused(vcor, case(LIST))
    assert words in line
    assert "modes.csv" in line


def test_shapes_are_masses(vcor):
    """A mode shape of 1/sqrt(m) is a modal mass of m; the order of the columns is free."""
    (vcor.folder / "modes.csv").write_text(MODES, encoding="utf-8")
    names = ["cor_sphere", "highest_mode", "contact_time"]
    e, highest, time = numbers(vcor, case(LIST), names)
    assert highest == pytest.approx(2 * 3400 * time, rel=1e-12)
    text = "mode_shape [kg^-0.5],frequency [Hz],damping_ratio [1]\n"
    text += f"{0.03**-0.5!r},1200,0.02\n{-(0.04**-0.5)!r},3400,0.02\n0.0,5000.0,0.02\n"
    (vcor.folder / "modes.csv").write_text(text, encoding="utf-8")
    assert numbers(vcor, case(LIST), names)[0] == pytest.approx(e, abs=1e-10)
    done = vcor("run", "case.nml", "--print", "cor_sphere")
    assert "highest_mode" in done.err
    [with_rest] = numbers(vcor, case(LIST + ", residual_compliance = 1e-9"), ["highest_mode"])
    assert with_rest != with_rest


def test_a_block_is_no_thin_plate(vcor):
    """The surface of a block, a rod or a list of modes is that of the body, whatever thickness &plate has: it is judged as that of a half space."""
    names = ["cor_sphere", "cor_deviation", "wave_loss"]
    for body in (BLOCK, BAR):
        assert numbers(vcor, case(body, ", thickness = 0.003"), names) == numbers(vcor, case(body), names)


def test_no_file(vcor):
    vcor.write(case(LIST))
    done = vcor("run", "case.nml")
    assert done.code == 4
    assert "modes.csv" in done.err


def test_sweep(vcor):
    """Points of a sweep over the structure, on any number of threads, are the single impacts."""
    sweep = "&sweep parameter = 'target.mass', values = 0.02, 0.05 /\n"
    sweep += "&sweep parameter = 'impact.velocity', values = 0.5, 1.0, 2.0 /\n"
    vcor.write(case(BLOCK + ", stiffness = 1e6, damping = 5.0", more=sweep))
    for threads in (1, 2):
        assert vcor("run", "case.nml", "--threads", threads, "--output", f"by{threads}").code == SUCCESS
    one, two = ((vcor.folder / f"by{n}" / "case_summary.csv").read_text() for n in (1, 2))
    assert one == two
    rows = list(csv.DictReader(line for line in one.splitlines() if line[0] != "#"))
    [single] = numbers(vcor, case(BLOCK + ", stiffness = 1e6, damping = 5.0"), ["cor_sphere"])
    assert float(rows[4]["cor_sphere"]) == pytest.approx(single, abs=1e-9)
    with h5py.File(vcor.folder / "by1" / "case.h5") as file:
        assert file["summary/contacts"].shape == (2, 3)
        assert "&target" in file.attrs["case"]


def test_sweep_of_a_place(vcor):
    """Points where the structure does not move are invalid, the others not."""
    sweep = "&sweep parameter = 'target.position(1)', values = 0.0, 0.1 /\n"
    vcor.write(case(CANTILEVER + ", position = 0.1", ", thickness = 0.003", more=sweep))
    assert vcor("run", "case.nml").code == NUMERICAL
    rows = list(csv.DictReader(line for line in open(vcor.folder / "case_summary.csv") if line[0] != "#"))
    assert [row["status"] for row in rows] == ["invalid", "separated"]


def test_completed_case(vcor):
    """A completed case has the structure, and a case without one has no &target; both can be read again."""
    for text in (case(CANTILEVER, ", thickness = 0.003"), case("").replace("&target  /\n", "").replace("'steel' /\n&mat", "'steel', waves = 'none' /\n&mat")):
        vcor.write(text)
        completed = vcor("check", "case.nml").out
        assert ("&target" in completed) == ("&target" in text)
        (vcor.folder / "again.nml").write_text(completed, encoding="utf-8")
        assert vcor("check", "again.nml").code == SUCCESS
    vcor.write(case(BLOCK))
    assert "waves = 'none'" in vcor("check", "case.nml").out


def test_exact_mechanics(vcor):
    """With a structure it recedes, in series, without waves."""
    vcor.write(case(BLOCK, more="&contact mechanics = 'exact' /\n", face="rubber", ball="steel"))
    done = vcor("check", "case.nml")
    assert done.code == SUCCESS
    for words in ("law = 'receding'", "pair = 'series'", "waves = 'none'"):
        assert words in done.out
    vcor.write(case(CANTILEVER + ", material = 'steel', thickness = 0.003", face="rubber"))
    out = vcor("run", "case.nml").out
    assert "with receding contact" in out
    assert "exact" not in out


def test_verify(vcor):
    """Both methods on the first contact, half of the modes, no edges."""
    vcor.write(case(PANEL, ", thickness = 0.003"))
    done = vcor("verify", "case.nml")
    assert done.code == SUCCESS, done.out
    for words in ("verified:", "first contact", "half_modes", "infinite"):
        assert words in done.out


UNDAMPED = {
    "a plate": ("body = 'plate', support = 'supported', length = 0.05, width = 0.05", "velocity = 1.0"),
    "a thick plate": ("body = 'plate', support = 'supported', length = 0.1, width = 0.07", "velocity = 0.1"),
    "a small plate": ("body = 'plate', support = 'supported', length = 0.04, width = 0.05, thickness = 0.002", "velocity = 10.0"),
    "a beam": ("body = 'beam', support = 'supported', length = 0.1, width = 0.02", "velocity = 1.0"),
    "a cantilever": ("body = 'beam', support = 'cantilever', length = 0.15, width = 0.02", "velocity = 1.0"),
}


@pytest.mark.parametrize(
    "name, law",
    [
        *((name, "boltzmann") for name in UNDAMPED if name != "a cantilever"),
        ("a plate", "receding"),
        ("a cantilever", "receding"),
        *long_tests(
            ("a cantilever", "boltzmann"),
            *((name, "receding") for name in ("a thick plate", "a small plate", "a beam")),
        ),
    ],
)
def test_verify_undamped(vcor, name, law):
    """Fast modes that ring from the first touch on are no disagreement of the methods."""
    target, impact = UNDAMPED[name]
    vcor.write(case(target, ", thickness = 0.003", impact=impact, more=f"&contact law = '{law}' /\n"))
    done = vcor("verify", "case.nml")
    assert done.code == SUCCESS, done.out
    for line in done.out.splitlines():
        if line.strip().startswith(("max_indentation ", "max_force ")) and line.split()[-1].isdigit():
            assert int(line.split()[-1]) >= 5


def test_gravity(vcor):
    """With a weight momentum is m (v + g t) at the end of an elastic contact, and bodies part as they met."""
    mass, g, v = 7850 * 4 / 3 * 3.141592653589793 * 0.005**3, 9.81, 0.01
    names = ["cor_sphere", "contact_time", "contacts", "last_separation"]
    # the mode has no time to act: its phase at the end of the contact is 0.01
    (vcor.folder / "modes.csv").write_text(SLOW, encoding="utf-8")
    e, time, contacts, last = numbers(vcor, case(LIST, impact=f"velocity = {v}, gravity = {g}"), names)
    assert e == pytest.approx((0.4 * v - mass * (v + g * time)) / ((0.4 + mass) * v), abs=1e-5)
    assert (contacts, last) == (1, time)


def test_rests(vcor):
    """A ball that a damped structure stops rests on it: weight, deflection of the spring and dent are those of statics."""
    mass, g, stiffness = 7850 * 4 / 3 * 3.141592653589793 * 0.005**3, 9.81, 1e4
    block = f"body = 'block', mass = 0.01, stiffness = {stiffness}, damping = 20.0"
    vcor.write(case(block, impact=f"velocity = 0.01, gravity = {g}"))
    assert "status rests" in vcor.succeeds("run", "case.nml")
    row = list(csv.DictReader(line for line in open(vcor.folder / "case.csv") if line[0] != "#"))[-1]
    contact = 4 / 3 * 210e9 / (2 * (1 - 0.3**2)) * 0.005**0.5
    assert float(row["force"]) == pytest.approx(mass * g, rel=1e-6)
    assert float(row["plate_displacement"]) == pytest.approx(mass * g / stiffness, rel=1e-6)
    assert float(row["indentation"]) == pytest.approx((mass * g / contact) ** (2 / 3), rel=1e-6)
    assert float(row["sphere_velocity"]) == pytest.approx(0, abs=1e-8)


@pytest.mark.parametrize("mass, stiffness", [(0.1, 1e5), *long_tests((0.01, 1e4), (0.001, 1e4))])
def test_moves_for_ever(vcor, mass, stiffness):
    """A ball put on an undamped spring, slower than its weight moves it, neither leaves nor rests."""
    vcor.write(case(f"body = 'block', mass = {mass}, stiffness = {stiffness}", impact="velocity = 1e-4, gravity = 9.81"))
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert done.err.count("\n") == 1
    assert "the bodies do not separate within" in done.err


# The body, and the material, of others
REPEATED = {"plate supported, cerf", "plate supported, fluid", "beam cantilever, power"}


@pytest.mark.parametrize(
    "impact", [one for one in RELAXING if EVERYTHING or one["name"] not in REPEATED], ids=lambda one: one["name"]
)
def test_relaxing_structure(vcor, impact):
    """Every body of every material through one or several contacts, as tests/reference/make_structures.py has it."""
    names = ["cor_sphere", "contacts", "last_separation", "max_force", "cor_sphere_error"]
    e, contacts, last, force, error = numbers(vcor, impact["case"], names)
    # the accuracy that is asked for, with the digits of the reference
    assert e == pytest.approx(impact["cor_sphere"], abs=1e-6 + impact["difference"])
    assert contacts == impact["contacts"]
    # ends and largest forces of the reference are those of a node of its steps
    assert last == pytest.approx(impact["last_separation"], rel=1e-3)
    assert force == pytest.approx(impact["max_force"], rel=1e-3)
    assert error <= 1e-6


RELAXES = {
    "sls": "model = 'sls', glassy_modulus = 5e9, alpha = 5e4, beta = 1e5",
    "a dashpot beside a spring": "model = 'prony', equilibrium_modulus = 4e9, viscosity = 2e3",
    "a fluid": "model = 'prony', moduli = 4e9, times = 1e-4",
    "a power law": "model = 'power_law', equilibrium_modulus = 1e9, coefficient = 6e7, exponent = 0.3",
    "cerf": "model = 'cerf', equilibrium_modulus = 1e9, relaxing_modulus = 4e9, beta = 300.0",
    "a table": "model = 'table', file = 'sheet.csv'",
}


@pytest.mark.parametrize(
    "name, law",
    [
        *((name, "boltzmann") for name in RELAXES if name != "a table"),
        ("sls", "receding"),
        ("a table", "receding"),
        *long_tests(("a table", "boltzmann"), *((name, "receding") for name in RELAXES if name not in ("sls", "a table"))),
    ],
)
def test_relaxing_plate_without_edges(vcor, name, law):
    """A wide plate of a material that relaxes is the thin plate that remembers."""
    rows = "".join(f"{10 ** (i / 4 - 9)!r},{1e9 + 4e9 / (1 + (10 ** (i / 4 - 9) / 1e-5) ** 0.3)!r}\n" for i in range(29))
    (vcor.folder / "sheet.csv").write_text("time [s],modulus [Pa]\n" + rows, encoding="utf-8")
    text = f"""&impact velocity = 2.0 /
&sphere radius = 0.002, material = 'ball' /
&plate thickness = 0.002, material = 'sheet', waves = 'hereditary' /
&contact law = '{law}' /
&material name = 'ball', model = 'rigid', density = 2500 /
&material name = 'sheet', {RELAXES[name]}, density = 1200, poisson_ratio = 0.3 /
"""
    names = ["cor_sphere", "contact_time", "max_force"]
    infinite = numbers(vcor, text, names)
    body = "&target body = 'plate', support = 'supported', length = 0.12, width = 0.12 /\n"
    finite = numbers(vcor, text.replace(", waves = 'hereditary'", "") + body, [*names, "contacts", "structure_energy"])
    assert finite[0] == pytest.approx(infinite[0], abs=1e-6)
    assert finite[1:3] == pytest.approx(infinite[1:], rel=1e-5)
    assert finite[3] == 1
    # what is stored in a material that relaxes is not in its modulus; of a spring and a dashpot it is
    assert (finite[4] != finite[4]) == ("dashpot" not in name)


def test_table_on_a_block(vcor):
    """Data that begin within the contact are off where a sum of exponentials goes on beyond them: a block that does not move gives the value without it, within the stated errors."""
    points = [(1e-4 * 10 ** (k / 50), 1.5e6 + 1.24e4 * (1e-4 * 10 ** (k / 50)) ** -0.45) for k in range(101)]
    (vcor.folder / "soft.csv").write_text(
        "time [s],modulus [Pa]\n" + "".join(f"{time:.9e},{modulus:.9e}\n" for time, modulus in points), encoding="utf-8"
    )
    material = "&material name = 'soft', model = 'table', file = 'soft.csv', poisson_ratio = 0.49, density = 950 /\n"
    names = ["cor_sphere", "cor_sphere_error"]
    words = ["--set", "solver.method=direct", "--set", "solver.accuracy=1e-3"]
    text = case("body = 'block', mass = 1e5", more=material, face="soft")
    found, stated = numbers(vcor, text, names, *words)
    expected, error = numbers(vcor, text.replace("&target body = 'block', mass = 1e5 /", "").replace("'soft' /", "'soft', waves = 'none' /", 1), names, *words)
    assert abs(found - expected) > 1e-2
    assert abs(found - expected) <= 3.0 * (stated + error)
    # less than a hundred times the accuracy asked for is missed, or it is refused
    vcor.write(text)
    assert vcor("run", "case.nml", "--set", "solver.method=direct").code == NUMERICAL


def test_temperature_of_a_structure(vcor):
    """A shift moves the times of the structure's material, whatever carries it."""
    beam = "body = 'beam', support = 'free', length = 0.1, width = 0.02, thickness = 0.006, material = 'sheet'"
    sheet = "name = 'sheet', model = 'sls', glassy_modulus = 5e9, poisson_ratio = 0.3, density = 1200"
    wlf = ", shift = 'wlf', wlf_c1 = 10.0, wlf_c2 = 100.0, reference_temperature = 300.0"
    names = ["cor_sphere", "contacts"]
    slow = case(beam, impact="velocity = 1.0, temperature = 325.0", more=f"&material {sheet}, alpha = 1e3, beta = 2e3{wlf} /\n")
    fast = case(beam, more=f"&material {sheet}, alpha = 1e5, beta = 2e5 /\n")
    assert numbers(vcor, slow, names) == pytest.approx(numbers(vcor, fast, names), abs=1e-7)
    same = slow.replace("325.0", "300.0")
    assert numbers(vcor, same, names)[0] != pytest.approx(numbers(vcor, fast, names)[0], abs=1e-3)


def test_structure_of_a_dashpot(vcor):
    """Without a spring there are no modes."""
    beam = "body = 'beam', support = 'free', length = 0.1, width = 0.02, thickness = 0.006, material = 'oil'"
    oil = "&material name = 'oil', model = 'prony', viscosity = 1e3, poisson_ratio = 0.3, density = 1200 /\n"
    assert "more than a dashpot" in refused(vcor, case(beam, more=oil))


# The drop of a steel ball on natural rubber, which is a half space
DROP = """&impact drop_height = 0.25 /
&sphere radius = 0.0075, mass = 0.013872178, material = 'steel' /
&plate material = 'rubber'{plate} /
&contact law = 'receding', pair = 'series' /
&target {target} /
&material name = 'steel', model = 'rigid' /
&material name = 'rubber', model = 'prony', poisson_ratio = 0.5, density = 1100, equilibrium_modulus = 2e6,
   moduli = 3e5, 3e5, 4e5, 6e5, rates = 30, 300, 3e3, 3e4 /
"""
HEAVY = "body = 'block', mass = 1e9"


@pytest.mark.parametrize("base", ["", ", thickness = 0.02, base = 'bonded'", ", thickness = 0.02, base = 'sliding'"])
@pytest.mark.parametrize("target", ["body = 'block', mass = 1.0", "body = 'block', mass = 0.2, stiffness = 1e6, damping = 30.0"])
def test_coupled_without_waves(vcor, base, target):
    """A block behind the coupled contact, which knows no rule of receding contact, is that behind ive."""
    text = DROP.format(plate=base, target=target)
    names = ["cor_sphere", "cor", "contacts", "contact_time", "structure_energy"]
    expected = numbers(vcor, text, names)
    found = numbers(vcor, text, names, "--set", "solver.method=coupled")
    assert found[:2] == pytest.approx(expected[:2], abs=1e-5)
    assert found[2] == expected[2] == 1
    assert found[3:] == pytest.approx(expected[3:], rel=1e-3)


def test_rubber_block(vcor):
    """Natural rubber on 1 kg, by three independent solutions 0.8649."""
    text = DROP.format(plate="", target="body = 'block', mass = 1.0")
    for method in ("ive", "direct", "coupled"):
        assert numbers(vcor, text, ["cor_sphere"], "--set", f"solver.method={method}")[0] == pytest.approx(0.8649, abs=5e-5)


@pytest.mark.parametrize("base", ["", ", thickness = 0.02, base = 'bonded'"])
def test_waves_in_the_face(vcor, base):
    """Behind waves in its face a heavy block is a floor, a mode of frequency 0 a free block, a spring a sprung one."""
    body = base + ", waves = 'body'"
    names = ["cor_sphere", "contact_time", "max_force"]
    floor = numbers(vcor, DROP.format(plate=body, target="").replace("&target  /\n", ""), names)
    assert numbers(vcor, DROP.format(plate=body, target=HEAVY), names) == pytest.approx(floor, rel=1e-5)
    (vcor.folder / "modes.csv").write_text(HEAD + "0.0,0.0,1.0\n", encoding="utf-8")
    names = ["cor_sphere", "cor", "structure_energy", "wave_energy", "contacts"]
    block = numbers(vcor, DROP.format(plate=body, target="body = 'block', mass = 1.0"), names)
    of_list = numbers(vcor, DROP.format(plate=body, target=LIST), names)
    assert of_list[:3] == pytest.approx(block[:3], rel=1e-9)
    assert block[3] != block[3]
    assert block[4] == 1
    # the momentum of ball and block
    mass, velocity = 0.013872178, (2 * 9.80665 * 0.25) ** 0.5
    speed = mass * velocity * (1 + block[0]) / 1.0
    assert block[1] == pytest.approx(block[0] + speed / velocity, abs=2e-5)
    assert block[2] == pytest.approx(0.5 * speed**2, rel=1e-4)
    assert block[0] < floor[0]


def test_a_block_lighter_than_its_half_space(vcor):
    """Waves that are back from the other side of the block are said, in a sweep point by point."""
    plate = ", waves = 'body'"
    text = DROP.format(plate=plate, target="body = 'block', mass = 1.0").replace("drop_height = 0.25", "velocity = 0.44, gravity = 0.0")
    reach, extent = numbers(vcor, text, ["block_reach", "needed_extent"])
    assert reach == pytest.approx(extent / (1.0 / 1100) ** (1 / 3), rel=1e-12)
    vcor.write(text + "&sweep parameter = 'target.mass', values = 0.1, 1.0, 100.0 /\n")
    assert vcor("run", "case.nml").code == SUCCESS
    rows = list(csv.DictReader(line for line in open(vcor.folder / "case_summary.csv") if line[0] != "#"))
    for row in rows:
        assert (float(row["block_reach"]) > 1) == (row["validity_cause"] == "block_reach")
    assert {row["validity_cause"] == "block_reach" for row in rows} == {True, False}


def test_struck_again_behind_waves(vcor):
    """A light block on a spring comes back: that is solved as long as the ball has not turned back, and else refused."""
    names = ["cor_sphere", "contacts", "contact_time", "last_separation"]
    text = DROP.format(plate="", target="body = 'block', mass = 0.0139, stiffness = 1e3")
    expected = numbers(vcor, text, names)
    found = numbers(vcor, text, names, "--set", "solver.method=coupled")
    assert found[0] == pytest.approx(expected[0], abs=1e-5)
    assert found[1] == expected[1] == 2
    assert found[2:] == pytest.approx(expected[2:], rel=0.02)
    text = DROP.format(plate=", waves = 'body'", target="body = 'block', mass = 0.02, stiffness = 300.0")
    assert numbers(vcor, text.replace("waves = 'body'", "waves = 'none'"), ["contacts"])[0] > 1
    vcor.write(text)
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert "strikes the sphere again" in done.err
    assert done.err.count("\n") == 1


def test_a_rod_behind_a_pad(vcor):
    """A long rod behind a pad with waves is a dashpot."""
    pad = ", thickness = 0.02, base = 'bonded', waves = 'body'"
    metal = "&material name = 'metal', model = 'elastic', modulus = 70e9, poisson_ratio = 0.3, density = 2700 /\n"
    rod = "body = 'rod', support = 'free', length = 20.0, diameter = 0.004, material = 'metal'"
    drag = 2700 * (70e9 / 2700) ** 0.5 * 3.141592653589793 / 4 * 0.004**2
    [e] = numbers(vcor, DROP.format(plate=pad, target=rod) + metal, ["cor_sphere"])
    [dashpot] = numbers(vcor, DROP.format(plate=pad, target=f"body = 'block', mass = 1e-9, damping = {drag!r}"), ["cor_sphere"])
    assert e == pytest.approx(dashpot, abs=1e-4)


# A supported beam whose third contact ends at the velocity GRAZING
BEAM = "body = 'beam', support = 'supported', length = 0.3, width = 0.025, position = 0.11"
ALUMINIUM = "&material name = 'aluminium', model = 'elastic', modulus = 70e9, poisson_ratio = 0.33, density = 2700 /"
GRAZING = 0.34282655


def test_contact_just_made(vcor):
    """Where the last contact is just made or just missed, the weight changes cor_sphere in flight by a jump, and the stated error has it; elsewhere it has not."""
    velocities = [GRAZING * (1 + 4e-7 * n) for n in range(-4, 6)] + [GRAZING * 0.999, GRAZING * 1.001]
    sweep = f"&sweep parameter = 'impact.velocity', values = {', '.join(map(repr, velocities))} /\n{ALUMINIUM}\n"
    text = case(BEAM, ", thickness = 0.008", "velocity = 1.0, gravity = 9.81", sweep, face="aluminium").replace("0.005", "0.01")
    vcor.write(text)
    done = vcor("run", "case.nml", "--print", "contacts,cor_sphere,cor_sphere_error")
    assert done.code == SUCCESS, done.err
    rows = [tuple(map(float, line.split())) for line in done.out.splitlines()]
    jumps = [(one, other) for one, other in zip(rows[:-2], rows[1:-2], strict=False) if one[0] != other[0]]
    assert jumps
    for one, other in jumps:
        jump = abs(other[1] - one[1])
        assert jump > 1e-3
        assert min(one[2], other[2]) > 0.99 * jump
    assert max(row[2] for row in rows[-2:]) < 1e-5


def test_contact_just_missed(vcor):
    """A second contact that is just missed is in the stated error, too: the impact is not left to the method that follows the first one only."""
    (vcor.folder / "modes.csv").write_text(HEAD + "3000.0,0.0,0.01\n", encoding="utf-8")
    low, high = 0.86, 1.04
    counts = {}

    def contacts(velocity):
        counts[velocity] = numbers(vcor, case(LIST, impact=f"velocity = {velocity!r}, gravity = 2e3"), ["contacts", "cor_sphere", "cor_sphere_error"])
        return counts[velocity][0]

    assert (contacts(low) > 1) != (contacts(high) > 1)
    first = contacts(low)
    while high - low > 2e-7 * low:
        middle = 0.5 * (low + high)
        if contacts(middle) == first:
            low = middle
        else:
            high = middle
    jump = abs(counts[high][1] - counts[low][1])
    assert min(counts[high][2], counts[low][2]) >= 0.5 * jump


# Structures on which a contact splits into two as the velocity changes, and two such velocities
SPLITS = {
    "four modes": ("31213.5,0.01,0.009022\n29096.2,0.01,0.0011\n7240.9,0.01,0.004588\n26354.6,0.01,0.002131\n", 0.1220, 0.1232),
    "three modes": ("5214.06,0.01,0.01326\n14430.9,0.01,0.003406\n21463.4,0.01,0.01457\n", 1.575, 1.59),
}


@pytest.mark.parametrize("name", ["four modes", *long_tests("three modes")])
def test_contact_that_all_but_splits(vcor, name):
    """Where a contact almost ends in its middle, and steps that are shorter find that it does, the stated error of contact_time has the difference, whatever method has found it."""
    modes, low, high = SPLITS[name]
    (vcor.folder / "modes.csv").write_text(HEAD + modes, encoding="utf-8")
    names = ["contacts", "contact_time", "contact_time_error"]

    def result(velocity, *words):
        return numbers(vcor, case(LIST, impact=f"velocity = {velocity!r}"), names, *words)

    first, last = result(low), result(high)
    assert first[0] != last[0]
    assert abs(first[1] - last[1]) > 0.1 * first[1]
    assert max(first[2], last[2]) < 1e-5 * first[1]
    while high - low > 4e-7 * low:
        middle = 0.5 * (low + high)
        if result(middle)[0] == first[0]:
            low = middle
        else:
            high = middle
    for step in (-8e-7, -4e-7, 0.0, 4e-7):
        _, time, stated = result(low * (1.0 + step))
        _, expected, error = result(low * (1.0 + step), "--set", "solver.method=direct", "--set", "solver.accuracy=1e-9")
        assert abs(time - expected) <= 1.01 * stated + error + 1e-9 * time
    assert max(result(low)[2], result(high)[2]) > 0.1 * first[1]


@pytest.mark.parametrize("velocity", [3e-4, *long_tests(1e-3)])
def test_undamped_block_under_its_ball(vcor, velocity):
    """What bounces on an undamped block for long ends with a number or one line."""
    vcor.write(case("body = 'block', mass = 0.01, stiffness = 1e4", impact=f"velocity = {velocity}, gravity = 9.81"))
    done = vcor("run", "case.nml", "--print", "cor_sphere,contacts")
    assert done.code in (SUCCESS, NUMERICAL)
    assert done.code == SUCCESS or done.err.count("\n") == 1


def test_stays_within_the_reach(vcor):
    """Balls that hop on a light undamped block for ever: each ends with one line, some of them in flight."""
    lines = []
    for velocity in (2e-4, 3e-4, *long_tests(5e-4)):
        vcor.write(case("body = 'block', mass = 0.003, stiffness = 1e4", impact=f"velocity = {velocity}, gravity = 9.81"))
        done = vcor("run", "case.nml", "--print", "contacts")
        if done.code != SUCCESS:
            assert done.code == NUMERICAL and done.err.count("\n") == 1
            lines.append(done.err)
    assert any("stays within the reach of the structure, without damping for ever" in line for line in lines)


def test_help(vcor):
    help_text = vcor.succeeds("help", "target.body")
    assert "one of plate, beam, rod, block," in help_text
    keys = [one["name"] for one in json.loads(vcor("help", "--json").out)["summary"]]
    assert {"contacts", "last_separation", "structure_energy", "highest_mode"} <= set(keys)


# A ball of 24 mm on an anvil that it leaves for a moment within its contact, or just not
ANVIL = f"""&impact velocity = 0.5 /
&sphere radius = 0.012, material = 'steel' /
&plate material = 'steel' /
&target body = 'block', mass = 0.02, stiffness = 43625040, damping = 19.926479 /
&material {STEEL} /
"""


def test_short_steps_do_not_drown_in_rounding(vcor):
    """A contact that only just ends: s all but has a double root, which 1e-16 moves by 1e-8."""
    names = ["contact_time", "cor_sphere", "contact_time_error", "steps"]
    stiffer = ["--set", "target.stiffness=43625089", "--set", "solver.method=direct"]
    found = [
        numbers(vcor, ANVIL, names, *stiffer, "--set", f"solver.time_step={step}")
        for step in (1.2e-9, 6e-10)
    ]  # fmt: skip
    # the errors of order 2.5 are 4e-10 and 7e-11; rounding that adds up over the steps is 7e-9
    assert found[0][0] == pytest.approx(found[1][0], rel=1e-9, abs=0)
    assert found[0][1] == pytest.approx(found[1][1], abs=1e-12)
    sharp = numbers(vcor, ANVIL, names, *stiffer, "--set", "solver.accuracy=1e-9")
    # shorter ones are tried as long as they help
    assert sharp[3] < 1e6
    assert sharp[0] == pytest.approx(found[1][0], abs=sharp[2] + found[1][2])


@pytest.mark.parametrize("stiffness", [43625030, 43625040])
def test_contact_that_only_just_ends(vcor, stiffness):
    """The end of the first contact is another one at a velocity next to it, and the error says so."""
    found = [
        numbers(vcor, ANVIL, ["contact_time", "contact_time_error"], "--set",
                "solver.method=direct", "--set", "solver.accuracy=1e-9", "--set",
                f"target.stiffness={stiffness}", "--set", f"impact.velocity={velocity!r}")
        for velocity in (0.5 * (1 - 1e-6), 0.5, 0.5 * (1 + 1e-6))
    ]  # fmt: skip
    times = [one[0] for one in found]
    assert max(times) > 1.1 * min(times)
    assert found[1][1] > 0.9 * max(abs(time - times[1]) for time in times)


def test_an_infinite_plate_is_refused_before_its_thickness(vcor):
    """What the first refusal asks for is not refused by the next one."""
    vcor.write(ANVIL)
    done = vcor("check", "case.nml", "--set", "plate.waves=relaxing")
    assert done.code == INPUT and "those of an infinite plate" in done.err
