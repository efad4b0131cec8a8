"""The live page of `vcor page` in Debian's Chromium, without a network but for 127.0.0.1."""

import os
import re
import signal
import subprocess
import sys
import time

import pytest
from chromium import launched
from conftest import PAPER, ROOT

from vcor import _command

SERVE = "from vcor._command import page; page()"
PAD = ROOT / "examples" / "rubber_pad_on_steel.nml"
#: Longest that a page may take on a machine that does other things [s]
PATIENCE = 60.0


def start(*words):
    """Start `vcor page`; the process and the address of the page."""
    command = [sys.executable, "-c", SERVE, *map(str, words), "--no-browser"]
    made = subprocess.Popen(command, stderr=subprocess.PIPE, encoding="utf-8")
    line = made.stderr.readline()
    found = re.fullmatch(r"vcor page: (http://127\.0\.0\.1:\d+/) \(Ctrl-C ends it\)\n", line)
    assert found, line + made.stderr.read()
    return made, found[1]


@pytest.fixture(scope="module")
def url():
    process, address = start(PAD)
    yield address
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=PATIENCE) == 0
    # no traceback of what happened in any test
    assert process.stderr.read() == ""


@pytest.fixture(scope="module")
def tabs():
    """Two for all tests, since a new one takes a second; pages are loaded anew and keep nothing."""
    with launched() as browser:
        context = browser.new_context()
        yield [context.new_page() for _ in range(2)]


class Watched:
    """Pages in one browser, and what went wrong in them."""

    def __init__(self, tabs):
        self.said, self.asked = [], []
        self._left, self._opened = list(tabs), []
        self._heard = {
            "console": self._hear,
            "pageerror": lambda error: self.said.append(str(error)),
            "request": lambda one: self.asked.append(one.url),
            "websocket": lambda one: self.asked.append(one.url),
        }

    def open(self, url, *, viewport=None, color_scheme=None):
        shown = self._left.pop(0)
        self._opened.append(shown)
        for event, hear in self._heard.items():
            shown.on(event, hear)
        shown.set_viewport_size(viewport or {"width": 1280, "height": 720})
        shown.emulate_media(color_scheme=color_scheme)
        shown.set_default_timeout(1000 * PATIENCE)
        shown.goto(url)
        shown.wait_for_selector("body[data-ready]")
        shown.locator("#cor_sphere").wait_for(state="attached")
        return shown

    def leave(self):
        """Leave the pages, which ends what the program still solves for them."""
        for shown in self._opened:
            shown.goto("about:blank")
            for event, hear in self._heard.items():
                shown.remove_listener(event, hear)

    def _hear(self, message):
        if message.type in ("error", "warning"):
            self.said.append(message.text)


@pytest.fixture
def watched(tabs):
    """Pages are opened; at the end nothing has gone wrong in them, and they asked this machine."""
    made = Watched(tabs)
    yield made
    made.leave()
    assert made.said == []
    own = ("about:", "data:", "blob:", "http://127.0.0.1:", "ws://127.0.0.1:")
    assert [one for one in made.asked if not one.startswith(own)] == []


def program(*words):
    """A number of the program."""
    words = [os.environ["VCOR"], "run", *map(str, words), "--print", "cor_sphere", "--quiet"]
    return float(subprocess.run(words, stdout=subprocess.PIPE, check=True, encoding="utf-8").stdout)


def number(shown):
    return float(shown.locator("#cor_sphere").text_content())


def wait(found, wanted):
    """Wait until something is what it should be."""
    end = time.monotonic() + PATIENCE
    while (one := found()) != wanted and time.monotonic() < end:
        time.sleep(0.05)
    assert one == wanted


def give(shown, label, text):
    field = shown.get_by_label(label, exact=True).first
    field.fill(text)
    field.press("Enter")


def said(shown, words):
    shown.get_by_text(words).first.wait_for()


def test_values_change_e_to_that_of_the_program(watched, url):
    shown = watched.open(url)
    assert (
        shown.title() == shown.inner_text("h1") == "Hammer on a rubber pad that is bonded to steel"
    )
    assert number(shown) == program(PAD)
    # a height in place of the velocity, in a unit of its own; the other one is empty then
    give(shown, "Drop height [mm]", "5.3 cm")
    wait(lambda: number(shown), program(PAD, "--set", "impact.drop_height=0.053"))
    assert shown.get_by_label("Velocity [m/s]").first.input_value() == ""
    assert shown.get_by_label("Drop height [mm]").first.input_value() == "53"
    assert shown.locator(".e output").inner_text() == f"e = {number(shown):.4f}"
    assert "of 5.3 cm" in shown.locator(".height").inner_text()
    # the keyboard moves a slider, here the one of the thickness
    shown.locator("[role=slider]").nth(1).press("ArrowRight")
    thickness = shown.get_by_label("Thickness [mm]", exact=True).first
    wait(lambda: thickness.input_value() != "12.5", True)
    words = ["--set", f"plate.thickness={float(thickness.input_value()) / 1000!r}"]
    value = program(PAD, *words, "--set", "impact.drop_height=0.053")
    wait(lambda: number(shown), value)
    # what is wrong is said at its widget in the words of the program, and the number is grey
    for text, words in [
        ("fast", "impact.velocity: found 'fast'"),
        ("-1", "impact.velocity: found -1"),
        ("2 kg", "impact.velocity: found the unit 'kg'"),
    ]:
        give(shown, "Velocity [m/s]", text)
        said(shown, words)
        assert number(shown) == value
        shown.locator(".stale").first.wait_for(state="attached")
    give(shown, "Velocity [m/s]", "1,2")
    give(shown, "Thickness [mm]", "10")
    words = ["--set", "plate.thickness=0.01", "--set", "impact.velocity=1.2"]
    wait(lambda: number(shown), program(PAD, *words))
    wait(lambda: shown.locator(".stale").count(), 0)
    assert shown.get_by_text("impact.velocity: found").count() == 0


def test_surfaces_materials_and_files(watched, url, tmp_path):
    """Each surface has the values that it needs; what the impact does not read is left out."""
    shown = watched.open(url)
    seen = {number(shown)}
    for kind in ("Thick block", "Free plate", "Second ball", "Structure", "Pad on a floor"):
        shown.get_by_role("button", name=kind).click()
        wait(lambda: number(shown) not in seen, True)
        seen.add(number(shown))
    choice = shown.locator("#inputs").get_by_label("Material", exact=True).nth(1)
    choice.select_option(label="butyl")
    shown.get_by_role("button", name="Material: butyl").wait_for()
    file = shown.locator("#file")
    file.set_input_files(ROOT / "examples" / "soft_rubber_data.csv")
    said(shown, "rms misfit")
    assert choice.input_value() == "soft_rubber_data"
    group = tmp_path / "mine.nml"
    group.write_text("&material name = 'mine', model = 'elastic', modulus = 3e6, "
                     "poisson_ratio = 0.5, density = 1000.0 /")  # fmt: skip
    file.set_input_files(group)
    said(shown, "mine.nml: 'mine' is the material of the surface")
    shown.get_by_role("button", name="Material: mine").wait_for()
    # a path of the machine is not read
    group.write_text("&material name = 'mine', model = 'table', file = '/etc/passwd' /")
    file.set_input_files(group)
    said(shown, "mine.nml: found 'file' of mine, expected numbers")
    group.write_text("&material name = 'mine', nodel = 'elastic' /")
    file.set_input_files(group)
    said(shown, "unknown key 'nodel'")
    (tmp_path / "large.csv").write_text("1, 2\n" * 900_000)
    file.set_input_files(tmp_path / "large.csv")
    said(shown, "large.csv: found 4500000 bytes, expected at most 4 MB")
    # measured points, pasted and of a file
    points = "Bokeh.documents[0].get_model_by_name('points').data.x.length"
    shown.locator("textarea").fill("velocity; e\n1,5; 0,9; 0,02\n2; 91 %\nfast; 1")
    shown.locator("textarea").blur()
    said(shown, "line 4: found 'fast', expected Velocity [m/s], e")
    wait(lambda: shown.evaluate(points), 2)
    file.set_input_files(ROOT / "examples" / "identification" / "drops.csv")
    said(shown, "drops.csv: 10 measured points")
    wait(lambda: shown.evaluate(points), 10)
    shown.get_by_role("button", name="Remove", exact=True).click()
    wait(lambda: shown.evaluate(points), 0)


def test_what_is_kept_and_taken(watched, url, tmp_path):
    shown = watched.open(url)
    shown.get_by_role("button", name="Keep this curve").click()
    said(shown, "the same values")
    give(shown, "Thickness [mm]", "9.1")
    said(shown, "now: plate thickness 9.1 mm; e = ")
    said(shown, "plate thickness 12.5 mm; e = ")
    kept = "Bokeh.documents[0].get_model_by_name('curve 1').data.x.length"
    wait(lambda: shown.evaluate(kept), 101)
    value = program(PAD, "--set", "plate.thickness=9.1e-3")
    wait(lambda: number(shown), value)
    names = {}
    for button in ("Case (.nml)", "Table (CSV)", "Figure (SVG)"):
        with shown.expect_download() as found:
            shown.get_by_role("button", name=button).click()
        names[button] = tmp_path / found.value.suggested_filename
        found.value.save_as(names[button])
    assert program(names["Case (.nml)"]) == value
    lines = names["Table (CSV)"].read_text().splitlines()
    head, *rows = [line.split(",") for line in lines if not line.startswith("#")]
    assert head[:2] == ["impact.velocity", "cor"] and len(rows) == 101
    first = program(names["Case (.nml)"], "--set", f"impact.velocity={rows[0][0]}")
    assert float(rows[0][head.index("cor_sphere")]) == first
    assert names["Figure (SVG)"].read_text().startswith("<?xml")
    # test_live.py runs such commands
    shown.get_by_text("The same bits").click()
    shell, python = shown.locator("pre").all_inner_texts()
    assert shell == f"vcor run {PAD} --set plate.thickness=0.0091 --print cor_sphere"
    assert 'case["plate.thickness"] = 0.0091'.replace('"', "'") in python


def test_two_pages_are_independent(watched, url):
    one, other = watched.open(url), watched.open(url)
    before = number(other)
    # exact mechanics come from the background; that of a value that was left is not shown
    one.get_by_label("Mechanics", exact=True).select_option(index=1)
    give(one, "Velocity [m/s]", "1")
    give(one, "Velocity [m/s]", "1.2")
    words = ["--set", "contact.mechanics=exact", "--set", "impact.velocity=1.2"]
    wait(lambda: number(one), program(PAD, *words))
    assert number(other) == before
    # beside the fast mechanics stands e with exact ones
    value = program(PAD, "--set", "contact.mechanics=exact")
    said(other, f"With exact mechanics e = {value:.4f}")
    give(other, "Thickness [mm]", "10")
    wait(lambda: number(other), program(PAD, "--set", "plate.thickness=0.01"))
    assert one.get_by_label("Thickness [mm]", exact=True).first.input_value() == "12.5"


def test_a_page_without_a_case(watched, monkeypatch, capsys):
    """On a dark telephone; a port that is in use; the end of the program."""
    process, address = start()
    try:
        shown = watched.open(address, viewport={"width": 400, "height": 800}, color_scheme="dark")
        assert shown.inner_text("h1") == "Steel ball dropped on a rubber pad"
        assert shown.evaluate("document.documentElement.scrollWidth") == 400
        paper = "Bokeh.documents[0].get_model_by_name('figure').background_fill_color"
        wait(lambda: shown.evaluate(paper), "#14171a")
        port = re.search(r":(\d+)/", address)[1]
        # how a command ends that serves is not for this process
        monkeypatch.setattr(signal, "signal", lambda *_: None)
        with pytest.raises(SystemExit) as leaving:
            _command.call("page", [str(PAPER / "sls.nml"), f"--port={port}"])
        out, err = capsys.readouterr()
        assert (leaving.value.code, out) == (4, "")
        assert err == (
            f"vcor: error: port {port} of 127.0.0.1 is in use, expected another one: --port VALUE\n"
        )
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=PATIENCE) == 0 and process.stderr.read() == ""
        shown.get_by_text("The program behind this page has ended").wait_for()
        # the browser says that the connection is lost
        watched.said.clear()
    finally:
        process.kill()
        process.wait()
