"""The table of methods and features of `vcor help --json`: every yes is accepted, every no refused."""

import json

import pytest
from program import INPUT, SUCCESS, Vcor

STEEL = "&material name = 'ball', model = 'rigid', density = 7800 /\n"
SOLID = "&material name = 'ball', model = 'sls', density = 1100, poisson_ratio = 0.4,\n"
SOLID += "   glassy_modulus = 3e7, alpha = 100, beta = 400 /\n"
PLATE = "&material name = 'sheet', density = 1100, poisson_ratio = 0.5,\n"
RUBBER = PLATE + "   model = 'sls', glassy_modulus = 15e6, alpha = 300, beta = 1200 /\n"
DASHPOT = PLATE + "   model = 'prony', equilibrium_modulus = 5e6, moduli = 1e7, times = 1e-3, viscosity = 100 /\n"
METHODS = {
    "ive": ["solver.method=ive"],
    "direct": ["solver.method=direct"],
    "paper": ["solver.method=direct", "solver.scheme=adams_bashforth"],
    "coupled": ["solver.method=coupled"],
}
# The keys of each feature: in &impact, &plate, &contact and &solver, and the materials
STILL = ", waves = 'none'"
FEATURES = {
    "waves = 'body'": ("", ", waves = 'body'", "", "", STEEL + RUBBER),
    "waves = 'constant', 'relaxing'": ("", ", waves = 'relaxing'", "", "", STEEL + RUBBER),
    "waves = 'hereditary'": ("", ", waves = 'hereditary'", "", "", STEEL + RUBBER),
    "waves = 'frozen'": ("", ", waves = 'frozen'", "", "", STEEL + RUBBER),
    "base = 'bonded', 'sliding'": ("", ", base = 'sliding'", "", "", STEEL + RUBBER),
    "law = 'boltzmann'": ("", STILL, "law = 'boltzmann'", "", STEEL + RUBBER),
    "law = 'receding'": ("", STILL, "law = 'receding'", "", STEEL + RUBBER),
    "pair = 'eq1'": ("", STILL, "pair = 'eq1'", "", SOLID + RUBBER),
    "viscosity": ("", STILL, "", "", STEEL + DASHPOT),
    "gravity": (", gravity = 9.81", STILL, "", "", STEEL + RUBBER),
    "volterra_order = 2": ("", STILL, "", "volterra_order = 2, volterra_coefficient = 0.1", STEEL + RUBBER),
    "continue_after_separation": ("", STILL, "", "continue_after_separation = .true.", STEEL + RUBBER),
    "&target": ("", STILL, "", "", STEEL + RUBBER + "&target body = 'block', mass = 0.1 /\n"),
    "waves = 'relaxing'": ("", ", waves = 'relaxing'", "", "", STEEL + RUBBER),
    "bounces": (", gravity = 9.81, bounces = 3", STILL, "", "", STEEL + RUBBER),
}
KEYS = {"gravity": ("impact", "9.81"), "time_step": ("solver", "1e-5"), "volterra_coefficient": ("solver", "0.1"),
        "form": ("solver", "a"), "quadrature": ("solver", "rectangle"), "volterra_order": ("solver", "1"),
        "continue_after_separation": ("solver", ".false."), "scheme": ("solver", "product")}


def case_of(feature):
    impact, plate, contact, solver, materials = FEATURES[feature]
    return (f"&impact velocity = 5{impact} /\n&sphere radius = 0.01, material = 'ball' /\n"
            f"&plate thickness = 0.04, material = 'sheet'{plate} /\n"
            f"&contact {contact} /\n&solver {solver} /\n{materials}")


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return json.loads(Vcor(tmp_path_factory.mktemp("table"))("help", "--json").out)


def test_the_table_is_complete(table):
    assert [one["keys"] for one in table["features"]] == list(FEATURES)
    assert table["methods"] == list(METHODS)
    assert {one["key"].partition(".")[2] for one in table["method_keys"]} == set(KEYS)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("feature", FEATURES)
def test_what_a_method_solves(table, vcor, feature, method):
    row = next(one for one in table["features"] if one["keys"] == feature)
    vcor.write(case_of(feature))
    words = [word for setting in METHODS[method] for word in ("--set", setting)]
    done = vcor("check", "case.nml", *words)
    assert done.code == (SUCCESS if method in row["methods"] else INPUT), done.err


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("key", KEYS)
def test_what_a_method_reads(table, vcor, key, method):
    group, value = KEYS[key]
    row = next(one for one in table["method_keys"] if one["key"] == f"{group}.{key}")
    settings = [*METHODS[method], f"{group}.{key}={value}"]
    if key == "scheme":
        settings = ["solver.method=" + method] if method in ("ive", "coupled") else METHODS[method]
        settings = [word for word in settings if "scheme" not in word]
        settings.append("solver.scheme=" + ("adams_bashforth" if method == "paper" else "product"))
    vcor.write(case_of("gravity").replace(", gravity = 9.81", ""))
    if key == "volterra_coefficient" and method in ("direct", "paper"):
        settings.append("solver.volterra_order=2")
    done = vcor("check", "case.nml", *[word for setting in settings for word in ("--set", setting)])
    assert done.code == (SUCCESS if method in row["methods"] else INPUT), done.err


def test_features_that_exclude_each_other(table, vcor):
    """Each of the pairs, by a method that solves both alone."""
    assert len(table["exclusions"]) == 13
    for pair in table["exclusions"]:
        one, other = case_of(pair["one"]), case_of(pair["other"])
        both = other.replace("&contact  /", "&contact law = 'receding' /") if "law" in pair["one"] else other
        if pair["one"] == "viscosity":
            both = other.replace(RUBBER, DASHPOT)
        if pair["other"] == "&target":
            both = one + "&target body = 'block', mass = 0.1 /\n"
        if pair["other"] == "bounces":
            both = one.replace("velocity = 5", "velocity = 5, gravity = 9.81, bounces = 3")
        assert both != one and both != other
        vcor.write(both)
        # what direct does not solve alone is refused for that
        method = "auto" if "body" in pair["one"] else "direct"
        done = vcor("check", "case.nml", "--set", f"solver.method={method}")
        assert done.code == INPUT, pair
        assert pair["reason"] in done.err
