"""A case, its copies, its pickle, its text and its file are the same case after any settings."""

import concurrent.futures
import functools
import multiprocessing
import os
import pickle
import random
import subprocess
import zlib

import pytest
from conftest import PAPER

import vcor
from vcor.case import with_material, with_values

#: Random sequences of settings
COUNT = 2000 if "VCOR_ALL_TESTS" in os.environ else 30
BASE = """&case title = 'drop' /
&impact {impact} /
&sphere {sphere}, material = 'ball' /
&plate {plate}, material = 'rubber' /
{mats}{sweep}"""
#: A material with each pair of keys for one quantity, and one with another model
MATERIALS = (
    "&material name = 'rubber', model = 'prony', density = 1100.0, poisson_ratio = 0.45, "
    "equilibrium_modulus = 4e6, moduli = 1e7, 2e7, {series} /\n",
    "&material name = 'rubber', model = 'table', density = 1000.0, poisson_ratio = 0.5, "
    "file = 'points.csv' /\n",
    "&material name = 'rubber', model = 'sls', density = 1100.0, poisson_ratio = 0.5, "
    "glassy_modulus = 1.5e7, alpha = 300.0, beta = 1200.0 /\n",
)
STEEL = "&material name = 'ball', model = 'rigid', density = 7800.0 /\n"
POINTS = "time [s],relaxation_modulus [Pa]\n1e-6,2e7\n1e-4,1.2e7\n1e-2,6e6\n"
#: Pairs of addresses for one quantity, with a range of their values
PAIRS = {
    "impact": (("velocity", 1.0, 8.0), ("drop_height", 0.05, 3.0)),
    "sphere": (("radius", 0.005, 0.02), ("diameter", 0.01, 0.04)),
    "plate": (("half_thickness", 0.005, 0.05), ("thickness", 0.01, 0.1)),
}
SINGLE = (
    ("sphere.mass", 0.01, 0.1),
    ("ball.density", 1e3, 1e4),
    ("rubber.poisson_ratio", 0.3, 0.5),
)


def begin(dice, folder):
    """A case of a file, without materials or with them, and its materials."""
    keys = {}
    for group, pair in PAIRS.items():
        key, low, high = dice.choice(pair)
        keys[group] = f"{key} = {dice.uniform(low, high)!r}"
    series = dice.choice(("rates = 2e3, 3e4", "times = 5e-4, 3e-5"))
    rubber = dice.choice(MATERIALS).format(series=series)
    sweep = ""
    if dice.random() < 0.25:
        key, low, high = dice.choice(PAIRS[group := dice.choice(tuple(PAIRS))])
        sweep = f"&sweep parameter = '{group}.{key}', values = {low!r}, {high!r} /\n"
    apart = dice.random() < 0.4
    mats = STEEL + ("" if apart else rubber)
    (folder / "case.nml").write_text(BASE.format(**keys, mats=mats, sweep=sweep))
    (folder / "mats").mkdir(exist_ok=True)
    (folder / "mats" / "m.nml").write_text(rubber)
    for place in (folder, folder / "mats"):
        (place / "points.csv").write_text(POINTS)
    case, materials = vcor.read(folder / "case.nml"), vcor.read(folder / "mats" / "m.nml")
    return case, materials if apart else None


def change(dice, case, materials):
    """Set some values, of each pair one after the other, and add the materials at some time."""
    when = dice.randrange(8)
    for step in range(8):
        target = case
        if materials is not None and step == when:
            case.add(materials)
            materials = None
        kind = dice.random()
        if kind < 0.6:
            group = dice.choice(tuple(PAIRS))
            key, low, high = dice.choice(PAIRS[group])
            case[f"{group}.{key}"] = dice.uniform(low, high)
        elif kind < 0.75:
            address, low, high = dice.choice(SINGLE)
            if address.startswith("rubber") and materials is not None:
                target = materials
            target[address] = dice.uniform(low, high)
        elif kind < 0.8:
            case["plate.waves"] = dice.choice(("none", "constant", "relaxing"))
        elif kind < 0.85:
            case["contact.mechanics"] = dice.choice(("paper", "paper", "exact"))
            case["plate.waves"] = "none"
        else:
            target = case if materials is None else materials
            if target["rubber.model"] == "prony":
                set_series(dice, target)
            elif target["rubber.model"] == "sls":
                target["rubber.beta"] = dice.uniform(600.0, 1500.0)
    if materials is not None:
        case.add(materials)


def set_series(dice, case):
    """Set rates or times, whole lists or one number of them, and moduli likewise."""
    for key, low, high in (
        dice.choice((("rates", 1e3, 1e5), ("times", 1e-5, 1e-3))), ("moduli", 1e6, 1e7),
    ):  # fmt: skip
        if case[f"rubber.{key}"] is not None and dice.random() < 0.6:
            case[f"rubber.{key}({dice.choice((1, 2))})"] = dice.uniform(low, high)
        else:
            case[f"rubber.{key}"] = [dice.uniform(low, high) for _ in range(2)]


def outcome(case):
    """All columns bit by bit, or the line that refuses the case."""
    try:
        found = case.run(progress=False)
    except vcor.Error as error:
        return str(error)
    columns = {str(name): found[name].values for name in [*found.coords, *found.data_vars]}
    return {
        name: one.tobytes() if one.dtype.kind in "fi" else one.tolist()
        for name, one in columns.items()
    }


def screens(folder, names):
    """Lines of the program for each case, without those of files and with the exact mechanics."""
    words = [os.environ["VCOR"], "run", *names, "--set", "output.hdf5=false", "output.csv=false"]
    words = [*words[:-1], "--set", words[-1]]
    done = subprocess.run(words, cwd=folder, capture_output=True, encoding="utf-8", check=True)
    parts = done.stdout.split("\nvcor ")
    return [[line for line in part.splitlines()[1:] if "written" not in line] for part in parts]


@pytest.fixture(scope="module")
def pool():
    context = multiprocessing.get_context("forkserver")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as one:
        yield one


def every_copy(case):
    """A case, its copy and its pickle."""
    return case, case.copy(), pickle.loads(pickle.dumps(case))


def cors(case):
    """Coefficients of restitution of a case and its copies."""
    return [one.solve(quantities=["cor"])["cor"] for one in every_copy(case)]


@pytest.mark.parametrize(("settings", "expected"), [
    ({"impact.velocity": (1.0, 2.0), "impact.drop_height": (0.3,)}, {"impact.velocity": 2.0}),
    ({"plate.half_thickness": (0.02, 0.01), "plate.thickness": (0.08,)},
     {"plate.half_thickness": 0.01}),
    ({"sphere.radius": (0.02, 0.01), "sphere.diameter": (0.03,)}, {"sphere.radius": 0.01}),
])  # fmt: skip
def test_the_last_of_two_keys_counts(sls, settings, expected):
    (first, (before, after)), (other, (between,)) = settings.items()
    for address, value in ((first, before), (other, between), (first, after)):
        sls[address] = value
    assert sls[other] is None
    wanted = vcor.read(PAPER / "sls.nml")
    for address, value in expected.items():
        wanted[address] = value
    assert set(cors(sls)) == {wanted.solve()["cor"]}


def test_the_last_of_a_list_and_its_numbers_counts():
    case = vcor.read(PAPER / "butyl_prony.nml")
    case["butyl.moduli(2)"] = 5e7
    case["butyl.moduli"] = [1e7, 2e7, 3e7]
    case["butyl.moduli(2)"] = 4e7
    assert all(one["butyl.moduli"] == [1e7, 4e7, 3e7] for one in every_copy(case))
    assert len(set(cors(case))) == 1


def test_materials_are_added_as_they_are(sls):
    """With what was set of them; what is set of them later is theirs alone."""
    text = str(sls)
    bodies, rubber = text[: text.index("&material", 1)], text[text.rindex("&material") :]
    steel = text[len(bodies) : text.rindex("&material")]
    case, materials = vcor.Case(bodies + steel), vcor.Case(rubber, name="mats.nml")
    materials["rubber.beta"] = 600.0
    case.add(materials)
    materials["rubber.beta"] = 900.0
    sls["rubber.beta"] = 600.0
    assert set(cors(case)) == {sls.solve()["cor"]}
    cards = [vcor.card(one, "rubber") for one in (*every_copy(case), sls)]
    assert all((one.times, one.moduli) == (cards[-1].times, cards[-1].moduli) for one in cards)
    assert cards[-1].times == pytest.approx((1.0 / 600.0,))


def test_a_case_holds_its_handle_alone(sls):
    sls["impact.velocity"] = 2.0
    sls["plate.waves"] = "none"
    sls.solve({"rubber.beta": 1e3})
    sls.run()
    assert set(vars(sls)) == set(vars(sls.copy())) == {"_pointer"}


@pytest.mark.parametrize(("address", "value"), [
    ("rubber.beta", 1e-3), ("solver.volterra_coefficient", 2.0), ("rubber.shift", "wlf"),
    ("rubber.model", "elastic"), ("sphere.shape", "cone"),
])  # fmt: skip
def test_a_copy_is_refused_as_the_case_is(sls, address, value):
    """In the same line, with the place of the value."""
    sls[address] = value
    lines = set()
    for one in every_copy(sls):
        with pytest.raises(vcor.InputError) as caught:
            one.solve()
        lines.add(str(caught.value))
    assert len(lines) == 1


def test_lines_of_the_file_are_kept(tmp_path):
    text = (PAPER / "sls.nml").read_text().replace("beta    = 1200.0", "beta    = 1.0")
    (tmp_path / "c.nml").write_text(text)
    line = next(i for i, row in enumerate(text.splitlines(), 1) if "alpha   =" in row)
    for one in every_copy(vcor.read(tmp_path / "c.nml")):
        with pytest.raises(vcor.InputError, match=rf"c\.nml:{line}: found alpha"):
            one.solve()


def test_a_dump_of_something_else_is_refused(tmp_path, monkeypatch):
    (tmp_path / "points.csv").write_text(POINTS)
    rubber = MATERIALS[1]
    keys = {"impact": "velocity = 1.0", "sphere": "radius = 0.01", "plate": "thickness = 0.02"}
    (tmp_path / "c.nml").write_text(BASE.format(**keys, mats=STEEL + rubber, sweep=""))
    case = vcor.read(tmp_path / "c.nml")
    make, (dump,) = case.__reduce__()
    assert repr(make(dump).solve()) == repr(case.solve())
    other = dump.replace(vcor.__version__.encode(), b"0.9.0", 1)
    refused = {
        other: r"by vcor 0\.9\.0, expected one by vcor",
        dump.replace(b"velocity = 1.0", b"velocity = 3.0"): "damaged",
        dump[:-5]: "damaged",
        b"": "expected a dump",
        b"&impact velocity = 1.0 /\n": "expected a dump",
    }
    for data, words in refused.items():
        with pytest.raises(vcor.InputError, match=words):
            make(data)
    points = tmp_path / "points.csv"
    other_points = functools.partial(points.write_text, POINTS.replace("6e6", "7e6"))
    points.unlink()
    with pytest.raises(vcor.FileError, match=r"points\.csv: there is no such file"):
        make(dump)
    other_points()
    with pytest.raises(vcor.InputError, match=r"points\.csv: it is not the file"):
        make(dump)
    points.write_text(POINTS)
    monkeypatch.chdir(tmp_path.parent)
    assert repr(make(dump).solve()) == repr(case.solve())


def test_a_dump_of_another_build_is_refused(sls):
    """One of the same version, with a check sum that is right, and other fields."""
    make, (dump,) = sls.__reduce__()
    head, _, fields = dump.partition(b"\n")
    short = fields[: fields.rindex(b"\n", 0, -1) + 1]
    name = fields.partition(b"\n")[0]
    swapped = (fields.replace(name, b"-1:x"), fields.replace(b"1:0\n", b"1:y\n", 1))
    for other in (b"", b"x", short, fields + b"1:0\n", fields[:20], b"99999999999:x\n", *swapped):
        made = head[: head.rindex(b" ") + 1] + b"%08X\n" % zlib.crc32(other) + other
        with pytest.raises(vcor.InputError, match="damaged"):
            make(made)


def test_materials_and_sweeps_are_replaced_in_a_copy():
    case = vcor.read(PAPER.parent / "sweeps" / "sls_velocity.nml")
    name = case["plate.material"].replace(" ", "_")
    single = with_values(case, {"impact.velocity": 2.0})
    assert case._axes() and not single._axes() and single["impact.velocity"] == 2.0
    group = f"&material name = '{name}', model = 'elastic', modulus = 1e7, density = 1e3, " \
            "poisson_ratio = 0.3 /"  # fmt: skip
    made = with_material(single, name, group)
    assert made[f"{name}.model"] == "elastic" and case[f"{name}.model"] == "sls"
    order = [text.split("'")[1] for text in str(made).split("&material")[1:]]
    assert order == [text.split("'")[1] for text in str(case).split("&material")[1:]]
    with pytest.raises(vcor.UsageError, match="nobody"):
        with_material(case, "nobody", group)
    with pytest.raises(vcor.InputError, match="found 2 &material groups"):
        with_material(case, name, group + group)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("group", PAIRS)
def test_a_setting_of_the_shell_is_one_of_the_case(tmp_path, group):
    """--set of either key of a quantity, over either in the file: all of the screen is equal."""
    keys = {name: f"{pair[0][0]} = {pair[0][1]!r}" for name, pair in PAIRS.items()}
    for given, low, _ in PAIRS[group]:
        for key, _, high in PAIRS[group]:
            keys[group] = f"{given} = {low!r}"
            text = BASE.format(**keys, mats=STEEL + MATERIALS[2], sweep="")
            (tmp_path / "case.nml").write_text(text)
            case = vcor.read(tmp_path / "case.nml")
            case[f"{group}.{key}"] = high
            case.save(tmp_path / "saved.nml")
            shell = screens(tmp_path, ["case.nml", "--set", f"{group}.{key}={high!r}"])
            assert shell == screens(tmp_path, ["saved.nml"])
            assert case.solve()["cor"] == vcor.read(tmp_path / "saved.nml").solve()["cor"]
            assert any("e_a" in line for line in shell[0])


@pytest.mark.filterwarnings("ignore")
def test_copies_are_the_case(tmp_path, pool):
    solved, cases, expected = [], [], []
    for seed in range(COUNT):
        dice, folder = random.Random(seed), tmp_path / str(seed)
        folder.mkdir()
        case, materials = begin(dice, folder)
        change(dice, case, materials)
        wanted = outcome(case)
        copies = {"copy": case.copy(), "pickle": pickle.loads(pickle.dumps(case))}
        if not isinstance(wanted, str):
            assert str(copies["copy"]) == str(copies["pickle"]) == str(case)
            copies["text"] = vcor.Case(case.text(), name=str(folder / "text.nml"))
            case.save(folder / "saved.nml")
            case.save(tmp_path / f"elsewhere_{seed}.nml")
            copies["saved"] = vcor.read(folder / "saved.nml")
            copies["elsewhere"] = vcor.read(tmp_path / f"elsewhere_{seed}.nml")
            case.save(folder / "complete.nml", complete=True)
            copies["complete"] = vcor.read(folder / "complete.nml")
            if not case._axes():
                solved.append(seed)
            assert str(copies["text"]) == str(copies["saved"]) == str(case)
        for name, one in copies.items():
            assert outcome(one) == wanted, (seed, name)
        cases.append(case)
        expected.append(wanted)
    assert len(solved) > COUNT // 3
    assert list(pool.map(outcome, cases, chunksize=10)) == expected
    some = solved[: 10 if COUNT == 30 else None]
    one, other = ([f"{seed}/{name}.nml" for seed in some] for name in ("saved", "complete"))
    assert any("with exact mechanics" in line for part in screens(tmp_path, one) for line in part)
    assert screens(tmp_path, one) == screens(tmp_path, other)
