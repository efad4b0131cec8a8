"""Parts of the live page that need no browser: keys and units, the form, what is taken away."""

import os
import re
import subprocess
import sys
import urllib.request

import numpy as np
import pytest
from bokeh.document import Document
from conftest import PAPER, ROOT
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.ioloop import IOLoop
from tornado.websocket import websocket_connect

import vcor
from vcor import page
from vcor.page import answer, form, keys, measured, server, take_away
from vcor.page.answer import Span
from vcor.page.live import Page

PAD = ROOT / "examples" / "rubber_pad_on_steel.nml"
pytestmark = pytest.mark.filterwarnings("ignore::vcor.ValidityWarning")


@pytest.fixture
def pad():
    return vcor.read(PAD)


def form_of(case):
    """A form without a page, and how often it said that the case has changed."""
    calls = []
    return form.Form(case, lambda: calls.append(1), []), calls


# ---------------------------------------------------------------------------- keys


@pytest.mark.parametrize(
    ("address", "typed", "value", "shown"),
    [
        ("sphere.radius", "12.3", 0.0123, "12.3"),
        ("sphere.radius", "1,5 cm", 0.015, "15"),
        ("sphere.radius", "2e-3 m", 0.002, "2"),
        ("sphere.mass", "350", 0.35, "350"),
        ("impact.temperature", "25", 298.15, "25"),
        ("impact.temperature", "77 F", 298.15, "25"),
        ("impact.velocity", "3.6 km/h", 1.0, "1"),
        ("rubber.moduli", "0.6, 0.7; 1.2e3", [6e5, 7e5, 1.2e9], "0.6, 0.7, 1200"),
        ("rubber.poisson_ratio", "0.49", 0.49, "0.49"),
        ("rubber.rates", "1e-12, 3", [1e-12, 3.0], "1e-12, 3"),
    ],
)
def test_values_have_usual_units(pad, address, typed, value, shown):
    """The case has the number that is nearest to what was typed: 12.3 mm are 0.0123 m."""
    key = keys.key_of(pad, address)
    pad[address] = key.written(typed)
    assert pad[address] == pytest.approx(value, rel=1e-15)
    if address == "sphere.radius":
        assert pad[address] == value
    assert key.shown(pad[address]) == shown


def test_each_key_of_the_catalogue_has_a_place(pad):
    """A new key appears by itself: all that the case may have, but for files and the output."""
    made, _ = form_of(pad)
    texts = [one for one in made.root.children if type(one).__name__ == "Toggle"]
    for one in texts:
        one.active = True
    known = {*made._fields}
    for group in keys.groups().values():
        if group.name in ("sweep", "output", "target", "material"):
            continue
        model = pad[f"{group.name}.{group.selector}"] if group.selector else None
        for key in group.keys_of(model):
            assert (f"{group.name}.{key.name}" in known) != key.is_file, key
    prony = {f"rubber.{key.name}" for key in keys.groups()["material"].keys_of("prony")}
    assert prony - known == {"rubber.name", "rubber.shift_file"}
    # of a structure those of its kind
    made.set_surface("structure")
    assert {"target.mass", "target.stiffness", "target.damping"} <= made._visible
    assert "target.length" not in made._visible


# ---------------------------------------------------------------------------- form


def test_surfaces_and_back(pad):
    made, calls = form_of(pad)
    assert made.kind == form.surface_of(pad) == "pad"
    for kind in ("block", "plate", "ball", "structure", "pad"):
        made.set_surface(kind)
        assert made.kind == form.surface_of(made.case) == kind
        assert np.isfinite(made.case.solve()["cor_sphere"])
    assert len(calls) == 5 and made.case["plate.waves"] == "none"


@pytest.mark.parametrize("mechanics", ["paper", "exact"])
def test_what_is_not_read_is_left_out_and_given_again(mechanics):
    case = server.case_of([])
    case["contact.mechanics"] = mechanics
    made, _ = form_of(case)
    (field,) = [one for one in made._fields.values() if one.address == "plate.material"]
    made.set(field, "glass")
    assert made.case["impact.temperature"] is None
    made.set(made._fields["plate.material"], "natural rubber")
    assert made.case["impact.temperature"] == 296.15
    # the material that was not kept is not in the case
    assert "glass.modulus" not in made.case


def test_a_wrong_value_leaves_the_case(pad):
    made, calls = form_of(pad)
    before = pad.text()
    made.set(made._fields["impact.velocity"], "-3")
    assert made.case.text() == before and len(calls) == 1
    assert "impact.velocity" in made.faults
    assert made._fields["impact.velocity"].fault.visible
    made.set(made._fields["impact.velocity"], "3")
    assert not made.faults and not made._fields["impact.velocity"].fault.visible


def test_a_model_brings_its_keys(pad):
    made, _ = form_of(pad)
    for toggle in [one for one in made.root.children if type(one).__name__ == "Toggle"]:
        toggle.active = True
    for model in ("sls", "power_law", "cerf", "mittag_leffler", "elastic", "prony"):
        made.set(made._fields["rubber.model"], model)
        assert made.case["rubber.model"] == model
        assert form._refusal(made.case) == ""


# -------------------------------------------------------------------------- answers


def test_an_answer_is_that_of_the_case(pad):
    span = Span("impact.velocity", 0.2, 1.4, True)
    *_, found = answer.parts(pad, span, [pad.copy()])
    expected = pad.solve()
    assert found.is_whole and str(found.numbers) == str(dict(expected))  # nan is nan
    assert found.drop == pytest.approx(1.4**2 / (2 * 9.80665), rel=1e-12)
    one, other = found.curves
    assert np.array_equal(one.cor, other.cor) and one.cor[-1] == expected["cor_sphere"]
    assert one.level[-1] == expected["validity"]
    assert found.history["force"].max() == pytest.approx(expected["max_force"], rel=1e-3)
    assert list(found.moduli) == ["rubber"]


def test_an_answer_without_a_result(pad):
    pad["impact.velocity"] = 50.0
    (found,) = answer.parts(pad, None, [])
    assert found.numbers is None and found.is_whole
    assert "the contact becomes wider" in found.fault and found.code == 5


def test_what_the_data_do_not_cover_is_said():
    case = vcor.read(ROOT / "examples" / "steel_on_measured_rubber.nml")
    case["sphere.radius"] = 1e-5
    first = next(iter(answer.parts(case, None, [])))
    with pytest.warns(vcor.DataRangeWarning):
        lines = case.run().attrs["beyond_data"].splitlines()
    assert lines and set(lines) <= set(first.remarks)


# ------------------------------------------------------------------------- take away


@pytest.mark.parametrize("has_file", [True, False])
def test_commands_give_the_same_bits(pad, tmp_path, program, has_file):
    pad["impact.velocity"] = 1.3
    pad["rubber.rates"] = [31.0, 310.0, 3100.0, 31000.0]
    if not has_file:
        del pad["contact.law"]
    shell, python = take_away.commands(pad, [str(PAD)], tmp_path)
    assert ("--set" in shell) == ("vcor.read" in python) == has_file
    expected = pad.solve(quantities=["cor_sphere"])["cor_sphere"]
    shell = shell.replace("vcor run", f"{os.environ['VCOR']} run --quiet")
    for command in (["sh", "-c", shell], [sys.executable, "-W", "ignore", "-c", python]):
        done = subprocess.run(command, stdout=subprocess.PIPE, check=True, cwd=tmp_path)
        assert float(done.stdout) == expected


def test_a_case_that_is_taken_finds_its_data_files(tmp_path):
    case = vcor.read(ROOT / "examples" / "steel_on_measured_rubber.nml")
    other = tmp_path / "elsewhere"
    other.mkdir()
    (other / "case.nml").write_text(take_away.case_text(case, tmp_path))
    both = [one.solve(quantities=["cor"])["cor"] for one in (case, vcor.read(other / "case.nml"))]
    assert both[0] == both[1]


def test_figures_are_those_of_the_package(pad):
    span = Span("impact.velocity", 0.2, 1.4, True)
    for kind in take_away.FIGURES:
        text = take_away.svg(kind, [pad, pad.copy()], ["one", "other"], span)
        assert text.startswith("<?xml") and text.count("<svg") == 1


# -------------------------------------------------------------------------- measured


def test_measured_rows_are_those_of_the_page_of_a_file(pad):
    key = keys.key_of(pad, "impact.velocity")
    text = "v; e; bar\n1,5; 0,9; 0,02 # cold\n\n2\t61 %\nfast; 0.6\n3; 0.6; 0.1; 4\n3; 36"
    found = measured.rows(text, "impact.velocity", key)
    assert found.at["impact.velocity"].tolist() == [1.5, 2.0]
    assert found.e.tolist() == [0.9, 0.61] and found.bar.tolist() == [0.02, 0.0]
    assert [line.partition(",")[0] for line in found.faults] == [
        "line 5: found 'fast'", "line 6: found 4 numbers", "line 7: found e = 36",
    ]  # fmt: skip


def test_measured_files_have_columns_of_their_own(pad):
    found = measured.of_file(ROOT / "examples" / "identification" / "drops.csv", pad)
    velocity, height = found.at["impact.velocity"], found.at["impact.drop_height"]
    assert velocity**2 == pytest.approx(2 * 9.80665 * height, rel=1e-12)
    assert len(found.e) == len(found.bar) == len(velocity) == 10
    with pytest.raises(vcor.Error, match="expected"):
        measured.of_file(ROOT / "examples" / "soft_rubber_data.csv", pad)


# --------------------------------------------------------------------------- server


@pytest.fixture
def live(pad):
    made = pad.page()
    yield made
    made.stop()
    assert not made._thread.is_alive()


def test_a_page_of_a_notebook(live, pad):
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", live.url)
    assert f'<iframe src="{live.url}"' in live._repr_html_()
    with urllib.request.urlopen(live.url) as found:
        text = found.read().decode()
    # all parts are of this machine, and no part names a folder of it
    assert not re.search(r"https?://(?!127\.0\.0\.1)", text)
    assert str(ROOT) not in text
    with pytest.raises(vcor.FileError, match="is in use"):
        page.live(pad, port=int(live.url.rsplit(":", 1)[1].rstrip("/")))


def test_another_origin_is_refused(live):
    address = live.url.replace("http", "ws") + "ws"
    request = HTTPRequest(address, headers={"Origin": "http://example.org"})
    with pytest.raises(HTTPClientError, match="403"):
        IOLoop(make_current=False).run_sync(lambda: websocket_connect(request))
    assert live._server._tornado.websocket_origins == {
        live.url[7:-1], live.url[7:-1].replace("127.0.0.1", "localhost"),
    }  # fmt: skip


def test_a_document_names_no_key_of_a_file(pad, tmp_path):
    document = Document()
    made = Page(document, pad, [], None, tmp_path)
    for toggle in [one for one in made.form.root.children if type(one).__name__ == "Toggle"]:
        toggle.active = True
    assert not [one for one in made.form._fields if one.endswith("file")]
    made._end(None)


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["--port", "80"], 2, ["--port", "from 1024 to 65535"]),
        (["--points", "5"], 2, ["--points", "--save"]),
        (["--body", "sphere"], 2, ["--body", "--save"]),
        (["--save", "x.html", "--port", "5000"], 2, ["--port", "--save"]),
        (["--vary", "impact.velocity=slow:fast"], 2, ["a range of two numbers"]),
        (["--set", "impact.speed=1"], 2, ["unknown key 'speed'"]),
        ([str(PAPER / "sls.nml")], 2, ["a second case"]),
        (["none.nml"], 4, ["none.nml"]),
    ],
)
def test_what_is_refused(words, code, says, tmp_path, monkeypatch, capsys):
    from vcor._command import call

    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as leaving:
        call("page", [str(PAD), *words, "--no-browser"])
    out, err = capsys.readouterr()
    assert (leaving.value.code, out) == (code, "")
    assert err.startswith("vcor: error: ") and err.count("\n") == 1
    for word in says:
        assert word in err


def test_a_sweep_is_refused_for_a_live_page():
    case = vcor.read(ROOT / "examples" / "sweeps" / "sls_velocity.nml")
    with pytest.raises(vcor.InputError, match="found a &sweep group"):
        case.page()


# ---------------------------------------------------------------------- the library


def test_values_that_are_removed(sls):
    text = sls.text()
    sls["impact.gravity"] = 9.81
    del sls["impact.gravity"]
    assert sls.text() == text
    sls["target.body"] = "block"
    sls["target.mass"] = 1.0
    del sls["target"]
    assert sls["target.body"] is None
    sls["contact.mechanics"] = "exact"
    del sls["plate.waves"], sls["plate.surface_radius"]
    # what the mechanics choose follows
    assert sls["plate.waves"] == "body" and sls["contact.law"] == "receding"
    del sls["contact.mechanics"]
    assert sls["plate.waves"] == "relaxing" and sls["contact.law"] == "boltzmann"
    sls["output.stem"] = "other"
    del sls["output.stem"]
    assert sls["output.stem"] == "sls"
    sls.add(vcor.Case("&material name = 'unused one', model = 'rigid' /"))
    del sls["unused one"]
    assert "unused_one.model" not in sls
    for wrong in ("plate.speed", "nothing", "rubber.rates(1)"):
        with pytest.raises(vcor.UsageError):
            del sls[wrong]
