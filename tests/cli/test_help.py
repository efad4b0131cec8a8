"""Help, and the version."""

import json
import re
import tomllib

import pytest
from program import NAMES, ROOT, USAGE

TOPICS = ["run", "check", "material", "verify", "help", "input", "output"]


def test_version_is_that_of_the_package(vcor):
    version = tomllib.loads((ROOT / "fpm.toml").read_text())["version"]
    assert vcor.succeeds("--version") == f"vcor {version}\n"


@pytest.mark.parametrize(
    "words", [["help"], ["--help"], ["-h"], ["help", "--help"], ["help", "help"]]
)
def test_overview(vcor, words):
    page = vcor.succeeds(*words)
    assert page == vcor.succeeds("help")
    for word in ("vcor run", "vcor check", "vcor material", "vcor verify", "vcor help", "--version", "exit codes"):
        assert word in page


@pytest.mark.parametrize("topic", TOPICS)
def test_topics(vcor, topic):
    page = vcor.succeeds("help", topic)
    assert page.endswith("\n") and not page.endswith("\n\n")
    assert page.isascii()
    assert not any(line.endswith(" ") for line in page.splitlines())
    assert vcor.succeeds("--help", topic) == page


@pytest.mark.parametrize("topic", TOPICS)
def test_the_overview_names_every_topic(vcor, topic):
    assert topic in vcor.succeeds("help")


@pytest.mark.parametrize("command", ["run", "check", "material", "verify"])
@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_after_a_command(vcor, command, option):
    page = vcor.succeeds("help", command)
    assert vcor.succeeds(command, option) == page
    assert vcor.succeeds(command, "no.nml", option) == page


@pytest.mark.parametrize("option", ["--set", "--output", "--print", "--threads", "--quiet"])
def test_page_of_run(vcor, option):
    assert option in vcor.succeeds("help", "run")


def test_page_of_check(vcor):
    assert "--set" in vcor.succeeds("help", "check")


@pytest.mark.parametrize("word", ["--set", "--quiet", "digits", "honest", "exit code 5"])
def test_page_of_verify(vcor, word):
    assert word in vcor.succeeds("help", "verify")


@pytest.mark.parametrize("name", NAMES)
def test_page_of_the_output(vcor, name):
    assert f"\n   {name} " in vcor.succeeds("help", "output")


@pytest.mark.parametrize(
    "group", ["case", "impact", "sphere", "plate", "material", "solver", "sweep", "output"]
)
def test_page_of_the_input(vcor, group):
    assert f"\n&{group} " in vcor.succeeds("help", "input")


def test_pages_fit_the_screen(vcor):
    for topic in TOPICS:
        assert all(len(line) <= 100 for line in vcor.succeeds("help", topic).splitlines())


@pytest.mark.parametrize("topic, nearest", [("inptu", "input"), ("rum", "run"), ("chek", "check")])
def test_unknown_topic(vcor, topic, nearest):
    vcor.refuses("help", topic, code=USAGE, says=[f"'{topic}'", f"'{nearest}'"])


@pytest.mark.parametrize(
    "word, groups, keys",
    [
        ("velocity", ["impact"], ["velocity"]),
        ("beta", ["material"], ["beta", "beta"]),
        ("rubber.beta", ["material"], ["beta", "beta"]),
        ("material", None, None),
        ("plate.material", ["plate"], ["material"]),
        ("power_law", ["material"], ["model", "poisson_ratio", "equilibrium_modulus", "coefficient", "exponent", "modulus_kind", "valid_from", "valid_to", "shift", "reference_temperature", "wlf_c1", "wlf_c2", "activation_energy", "shift_file", "vertical_shift", "valid_temperature_from", "valid_temperature_to"]),
        ("direct", ["solver"], ["method"]),
        ("sweep", ["sweep"], ["parameter", "values", "start", "stop", "count", "spacing"]),
    ],
)
def test_words_of_the_input(vcor, word, groups, keys):
    """A group, a key or a choice is shown as on the page of the input; a command comes first."""
    page = vcor.succeeds("help", word)
    if groups is None:
        assert page.startswith("usage: vcor material")
        return
    # so does one of the bounces
    lines = page.partition("\nColumns of STEM_bounces.csv")[0].splitlines()
    assert [line.split()[0] for line in lines if line.startswith("&")] == [f"&{name}" for name in groups]
    assert [line.split()[0] for line in lines if line[:4].strip() and line[0] == " "] == keys
    assert set(lines) <= set(vcor.succeeds("help", "input").splitlines())
    vcor.refuses("help", word, "--json", code=USAGE, says=["takes no topic", word])


@pytest.mark.parametrize(
    "word, says",
    [("velosity", "'velocity'"), ("pronny", "'prony'"), ("nothing at all", "a word of the input or the output"), ("", None)],
)
def test_words_near_those_of_the_input(vcor, word, says):
    if says:
        vcor.refuses("help", word, code=USAGE, says=[f"'{word}'", says])
    else:
        assert vcor.succeeds("help", word) == vcor.succeeds("help")


@pytest.mark.parametrize("word", [*NAMES, "sticks", "no_separation", "invalid"])
def test_words_of_the_output(vcor, word):
    """A column, or what the status says, is shown as on the page of the output."""
    whole = vcor.succeeds("help", "output").splitlines()
    # a key of the same name comes first, a column of the history or of the bounces last
    page = vcor.succeeds("help", word)
    page = page[max(0, page.find("Columns of STEM_summary.csv")) :]
    page = re.split(r"Columns of STEM(?:_bounces)?\.csv", page)[0].splitlines()
    assert all(line in whole for line in page if line)
    names = [line.split()[0] for line in page if line.startswith("   ") and line[3] != " "]
    assert word in names
    if word != "status":
        assert names == [word]


@pytest.mark.parametrize(
    "word, says",
    [
        ("hertz", "contact.law"),
        ("layer", "plate.base"),
        ("pad", "plate.base"),
        ("ting", "receding"),
        ("zener", "'constant'"),
        ("hardness", "DMA"),
        ("shore", "vcor identify"),
        ("rebound", "resilience"),
        ("tan_delta", "peak_loss_tangent"),
        ("glued", "plate.base"),
        ("celsius", "296.15 K"),
    ],
)
def test_words_of_the_field(vcor, word, says):
    """Terms that are not words of the input lead to related keys."""
    assert says in " ".join(vcor.succeeds("help", word).split())


def test_values_have_meanings(vcor):
    """Every word that a key can have is explained, but units, and spacings."""
    plain = {"time_unit", "modulus_unit", "spacing"}
    for group in json.loads(vcor.succeeds("help", "--json"))["groups"]:
        for key in group["keys"]:
            if key["name"] not in plain:
                assert [c["word"] for c in key["meanings"]] == key["choices"], key["name"]
                assert all(c["meaning"] for c in key["meanings"])


def test_misspelt_word_of_the_output(vcor):
    vcor.refuses("help", "contact_tiem", code=USAGE, says="'contact_time'")


@pytest.mark.parametrize(
    ("symbol", "name"),
    {"e": "cor ", "e_a": "cor_sphere", "lambda": "inelasticity", "W_wave": "wave_energy", "KE_0": "initial_energy", "U": "plate_displacement"}.items(),
)
def test_symbols_of_the_screen(vcor, symbol, name):
    assert f"   {name}" in vcor.succeeds("help", symbol)


def test_words_of_the_screen(vcor):
    """Words of the screen that are not columns."""
    assert "left to the sphere" in vcor.succeeds("help", "KE_1")
    assert "numerical error" in vcor.succeeds("help", "+-")
    for word in ("good", "caution", "outside"):
        assert "levels of validity" in vcor.succeeds("help", word)
    for word in ("exponentials", "kernel"):
        assert "solver.accuracy" in vcor.succeeds("help", word)
