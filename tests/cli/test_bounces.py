"""Bounces under the weight: each against independent solutions, refusals, files, how they end."""

import json
import re

import h5py
import numpy as np
import pandas as pd
import pytest
from program import INPUT, NUMERICAL, ROOT, SUCCESS

KNOWN = json.loads((ROOT / "tests" / "reference" / "bounces.json").read_text(encoding="utf-8"))
BALL = "radius = 0.01, mass = 0.02, material = 'ball'"


def case(known, more="", impact=""):
    """The case of a reference, in files of vcor."""
    face = "model = 'elastic', modulus = {equilibrium}"
    if known["viscosity"] or known["moduli"]:
        face = "model = 'prony', equilibrium_modulus = {equilibrium}"
        if known["viscosity"]:
            face += ", viscosity = {viscosity}"
        if known["moduli"]:
            face += f", moduli = {str(known['moduli'])[1:-1]}, rates = {str(known['rates'])[1:-1]}"
    waves = "waves = 'none'"
    if "density" in known:
        waves = "waves = 'constant', half_thickness = {half_thickness}"
    return f"""
&impact velocity = {{velocity}}, gravity = {{gravity}}, bounces = {{bounces}} {impact} /
&sphere radius = {{radius}}, mass = {{mass}}, material = 'ball' /
&plate material = 'floor', {waves} /
&contact pair = 'series' /
&material name = 'ball', model = 'rigid' /
&material name = 'floor', {face}, poisson_ratio = {{poisson}}, density = {known.get("density", 1000.0)} /
{"&target body = 'modes', file = 'modes.csv' /" if "modes" in known else ""}
{more}
""".format(**known)


def write_modes(vcor, known):
    """The list of modes of a structure."""
    if "modes" in known:
        rows = "".join("{},{},{}\n".format(*mode) for mode in known["modes"])
        vcor.write("frequency [Hz],damping_ratio,modal_mass [kg]\n" + rows, "modes.csv")


def bounces(vcor, text, *words):
    """Table of the bounces of a case."""
    vcor.write(text)
    vcor.succeeds("run", "case.nml", *words)
    return pd.read_csv(vcor.folder / "case_bounces.csv", comment="#")


@pytest.mark.parametrize("name", KNOWN)
def test_against_independent_solutions(vcor, name):
    """Every bounce to 1e-8, its time to 1e-6 of the whole, and what is stated covers the error."""
    known = KNOWN[name]
    expected = pd.DataFrame(known["rows"], columns=known["columns"])
    write_modes(vcor, known)
    vcor.write(case(known, "&solver accuracy = 1e-8 /"))
    done = vcor("run", "case.nml", "--output", ".", "--print", "bounces,bounces_end,bouncing_time,bouncing_time_error")
    assert done.code == SUCCESS, done.err
    count, ending, total, total_error = done.out.split()
    assert (int(count), ending) == (len(expected), known["bounces_end"])
    assert abs(float(total) - known["bouncing_time"]) < max(1e-9 * float(total), 2 * float(total_error)) < 1e-7
    found = pd.read_csv(vcor.folder / "case_bounces.csv", comment="#")
    assert list(found.bounce) == list(range(1, len(expected) + 1))
    assert (found.contacts == expected.contacts).all()
    error = (found.cor - expected.cor).abs()
    assert error.max() < 1e-8
    # the references are good to about 1e-11
    assert (error <= 2 * found.cor_error + 2e-11).all()
    for column in ("time", "velocity", "last_separation", "rebound_height", "max_force", "max_indentation"):
        largest = expected[column].abs().max()
        assert found[column].to_numpy() == pytest.approx(expected[column].to_numpy(), abs=1e-7 * largest)


def test_one_bounce_is_the_impact(vcor):
    """bounces = 1 changes no bit; the first of several is the impact that direct solves."""
    vcor.write(case(KNOWN["sls"]))
    names = ("run", "case.nml", "--print", "cor,cor_sphere,contact_time,max_force,bounces,bouncing_time,bounces_end")
    one = vcor.succeeds(*names, "--set", "impact.bounces=1")
    vcor.write(case({**KNOWN["sls"], "bounces": 1}).replace(", bounces = 1", ""))
    assert vcor.succeeds(*names) == one
    several = vcor.succeeds(*names, "--set", "impact.bounces=3").split()
    assert np.array(several[:4], dtype=float) == pytest.approx(np.array(one.split()[:4], dtype=float), rel=1e-6)
    assert several[4] == "3" and several[6] == one.split()[6] == "count"


def test_files_and_screen(vcor):
    """A row per bounce in CSV and HDF5, the same on the screen; history and summary of the first bounce."""
    vcor.write(case(KNOWN["soft_floor"]))
    screen = vcor.succeeds("run", "case.nml")
    assert "5 bounces in 0.253289 s; then the weight keeps the sphere in contact\n" in screen
    assert "case_bounces.csv\n" in screen
    table = pd.read_csv(vcor.folder / "case_bounces.csv", comment="#")
    summary = pd.read_csv(vcor.folder / "case_summary.csv", comment="#").iloc[0]
    with h5py.File(vcor.folder / "case.h5") as file:
        group = file["bounces"]
        assert set(group) == set(table.columns)
        for name in table.columns:
            assert (group[name][:] == table[name]).all()
            assert group[name].attrs["long_name"]
        assert group.attrs["bouncing_time"] == summary.bouncing_time
        assert file["history/time"][-1] == summary.contact_time
    assert table.cor[0] == pytest.approx(summary.cor_sphere, rel=1e-13)
    assert len(table) == summary.bounces


def test_how_they_end(vcor):
    """After as many as were asked for, at end_time, at rest, or before the first of them."""
    names = ("run", "case.nml", "--print", "bounces,bouncing_time,bounces_end")
    vcor.write(case(KNOWN["elastic"]))
    assert vcor.succeeds(*names).split()[::2] == ["20", "count"]
    late = vcor.succeeds(*names, "--set", "solver.end_time=0.9").split()
    assert late == ["5", "9.0000000000000002e-01", "end_time"]
    vcor.write(case({**KNOWN["soft_floor"], "velocity": 1e-6}))
    assert vcor.succeeds(*names).split() == ["0", "0.0000000000000000e+00", "rest"]
    assert "none; then the weight keeps the sphere in contact" in vcor.succeeds("run", "case.nml")


def test_a_dent_that_rises_meets_the_sphere(vcor):
    """In the last hop the sphere is still on its way up: no time scale has its velocity, and no end is given."""
    vcor.write(
        "&impact drop_height = 0.25, gravity = 9.81, bounces = 20 /\n"
        "&sphere diameter = 0.012, material = 'steel' /\n"
        "&plate material = 'pad', waves = 'none' /\n"
        "&material name = 'steel', model = 'rigid', density = 7850 /\n"
        "&material name = 'pad', model = 'sls', glassy_modulus = 2e7, alpha = 500, beta = 1500,\n"
        "   poisson_ratio = 0.48, density = 1100 /\n"
    )
    vcor.succeeds("run", "case.nml", "--quiet")
    table = pd.read_csv(vcor.folder / "case_bounces.csv", comment="#")
    summary = pd.read_csv(vcor.folder / "case_summary.csv", comment="#").iloc[0]
    assert (summary.bounces, summary.bounces_end) == (9, "rest")
    assert summary.bouncing_time > table.last_separation.iloc[-1]


def test_sweep(vcor):
    """A sweep has how many bounces there were, and how long they took, at each point, and no table."""
    more = "&sweep parameter = 'impact.velocity', values = 0.1, 0.5 /"
    vcor.write(case(KNOWN["soft_floor"], more))
    vcor.succeeds("run", "case.nml")
    found = pd.read_csv(vcor.folder / "case_summary.csv", comment="#")
    assert list(found.bounces_end) == ["rest", "rest"]
    assert found.bounces[0] < found.bounces[1] == 5
    assert not (vcor.folder / "case_bounces.csv").exists()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"gravity": 0.0}, "the sphere comes back under its weight only"),
        ({"more": "&solver method = 'ive' /"}, "method = 'direct'"),
        ({"more": "&solver scheme = 'adams_bashforth' /"}, "adams_bashforth"),
        ({"waves": "waves = 'body'"}, "with waves = 'body' no dent is kept"),
        ({"waves": "waves = 'hereditary', half_thickness = 0.01"}, "a plate that has a memory"),
        ({"waves": "waves = 'relaxing', half_thickness = 0.01"}, "a plate that has a memory"),
        ({"more": "&solver volterra_order = 2 /"}, "one term of the Volterra series"),
        ({"bounces": 1001}, "expected a whole number in [1, 1000]"),
    ],
)
def test_refused(vcor, change, words):
    """What the march from bounce to bounce cannot follow is refused in one line."""
    known = {**KNOWN["sls"], **{key: value for key, value in change.items() if key not in ("more", "waves")}}
    text = case(known, change.get("more", "")).replace("waves = 'none'", change.get("waves", "waves = 'none'"))
    done = vcor("run", vcor.write(text))
    assert (done.code, done.out, done.err.count("\n")) == (INPUT, "", 1), done.err
    assert words in done.err


def test_receding_contact_and_pads(vcor):
    """Contacts that recede and layers on a base bounce, too; an elastic one never loses its speed."""
    known = {**KNOWN["elastic"], "bounces": 4}
    text = case(known).replace("waves = 'none'", "thickness = 0.004, base = 'bonded', waves = 'none'")
    found = bounces(vcor, text.replace("&contact ", "&contact law = 'receding', "))
    assert found.cor.to_numpy() == pytest.approx(np.ones(4), abs=1e-6)
    law = [bounces(vcor, case(KNOWN["sls"]), "--set", f"contact.law={law}") for law in ("boltzmann", "receding")]
    # dents are forgotten in flight: each is the impact of its own speed
    for name, table in zip(("boltzmann", "receding"), law, strict=True):
        speed, cor = float(table.velocity[5]), table.cor[5]
        alone = vcor.succeeds(
            "run", "case.nml", "--print", "cor", "--set", "impact.bounces=1", "--set", f"impact.velocity={speed!r}",
            "--set", f"contact.law={name}",
        )
        assert float(alone) == pytest.approx(cor, abs=3e-7)


@pytest.mark.parametrize("elastic", [True, False])
def test_pairs_whose_dent_is_not_followed(vcor, elastic):
    """What the line advises has a result."""
    known = {**KNOWN["sls"], "bounces": 2}
    ball = "model = 'prony', equilibrium_modulus = 1e8, moduli = 1e8, times = 1e-4"
    if elastic:
        ball = "model = 'elastic', modulus = 1e8"
    text = re.sub("name = 'ball', model = 'rigid'", f"name = 'ball', poisson_ratio = 0.4, {ball}", case(known))
    assert ball in text
    vcor.write(text.replace("pair = 'series'", ""))
    done = vcor("run", "case.nml", "--print", "cor")
    assert done.code == NUMERICAL and "or contact.pair = 'series' of materials that are sums" in done.err
    vcor.succeeds("run", "case.nml", "--print", "cor", "--set", "contact.pair=series")


def test_the_method_is_refused_before_the_weight(vcor):
    """A weight, which the paper's scheme would refuse, is not asked for where nothing would bounce."""
    vcor.write(re.sub("gravity = [^,]*, bounces = [0-9]+", "bounces = 3", case(KNOWN["sls"])))
    paper = ["--set", "solver.method=direct", "--set", "solver.scheme=adams_bashforth"]
    done = vcor("check", "case.nml", *paper)
    assert done.code == INPUT and "scheme = 'product'" in done.err
    done = vcor("check", "case.nml")
    assert done.code == INPUT and "expected gravity > 0" in done.err


def test_too_many_steps(vcor):
    """Bounces that would take too many steps end in one line with the way out."""
    known = {**KNOWN["elastic"], "bounces": 1000}
    vcor.write(case(known, "&solver method = 'direct', time_step = 1e-9 /"))
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert "give a smaller impact.bounces" in done.err
