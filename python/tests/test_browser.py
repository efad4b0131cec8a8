"""The page of `vcor page` in Debian's Chromium, without a network."""

import json
import os
import re
import subprocess

import numpy as np
import pytest
from chromium import launched, playwright
from test_page_file import DROP, MATERIALS, PAD

import vcor
from vcor import page

expect = playwright.expect

FILES = [MATERIALS / f"{name}.nml" for name in ("steel", "natural_rubber", "butyl")]
LEVELS = ("good", "caution", "outside")
#: Two numbers, two materials
POINTS = 9


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """A page with a choice of materials, one whose verdict changes, and their tables."""
    made = tmp_path_factory.mktemp("pages")
    (made / "drop.nml").write_text(DROP)
    ranges = {"impact.temperature": "0C:40C", "sphere.diameter": "4mm:40mm"}
    drop = page.make(made / "drop.nml", ranges, FILES, points=POINTS)
    drop.save(made / "drop.html")
    with pytest.warns(vcor.NoResultWarning):
        pad = page.make(PAD, {"impact.velocity": "0.2m/s:8m/s"}, points=33)
    pad.save(made / "pad.html")
    return made, {"drop": drop.tables, "pad": pad.tables}


@pytest.fixture
def folder(pages):
    return pages[0]


@pytest.fixture
def tables(pages):
    return pages[1]


@pytest.fixture(scope="module")
def tab():
    """One for all tests, since a new one takes a second; pages are loaded anew and keep nothing."""
    with launched() as browser:
        yield browser.new_context(offline=True).new_page()


@pytest.fixture
def opened(tab, folder):
    """Open a page of a name; at the end nothing has gone wrong in it, and nothing was asked for."""
    said, asked = [], []
    heard = {
        "console": lambda one: said.append(one.text) if one.type in ("error", "warning") else 0,
        "pageerror": lambda error: said.append(str(error)),
        "request": lambda one: asked.append(one.url),
    }
    for event, hear in heard.items():
        tab.on(event, hear)

    def open_page(name, *, viewport=None, color_scheme=None):
        tab.set_viewport_size(viewport or {"width": 1280, "height": 720})
        tab.emulate_media(color_scheme=color_scheme)
        tab.goto((folder / f"{name}.html").as_uri())
        tab.wait_for_selector("body[data-ready]")
        return tab

    yield open_page
    for event, hear in heard.items():
        tab.remove_listener(event, hear)
    assert said == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []


def number_of(shown):
    """The coefficient that is shown, as it stands there."""
    return re.fullmatch(r"e = (\d\.\d+)", shown.inner_text("#e"))[1]


def source(shown, name):
    """A column data source of the figure; None where a number is none."""
    return shown.evaluate(
        """(name) => {
             const {data} = Bokeh.documents[0].get_model_by_name(name)
             return JSON.stringify(Object.fromEntries(
               Object.entries(data).map(([key, column]) => [key, Array.from(column)])))
           }""",
        name,
    )


def columns(shown, name):
    return json.loads(source(shown, name))


def program(*words):
    """A number of the program."""
    words = [os.environ["VCOR"], "run", *map(str, words), "--print", "cor_sphere", "--quiet"]
    return float(subprocess.run(words, stdout=subprocess.PIPE, check=True, encoding="utf-8").stdout)


def test_a_page_opens(opened):
    shown = opened("drop")
    assert shown.title() == shown.inner_text("h1") == "Drop </script><b>&amp;"
    assert shown.locator("#inputs label").all_inner_texts() == [
        "Material of the plate", "Temperature of both bodies [°C]", "Sphere: diameter [mm]",
    ]  # fmt: skip


def test_a_page_cannot_ask_for_anything(tab, folder):
    """Not even what needs no network: its own policy forbids it."""
    tab.goto((folder / "drop.html").as_uri())
    with pytest.raises(playwright.Error, match="Failed to fetch"):
        tab.evaluate("fetch('data:,x')")


def test_a_slider_moves_the_number_to_that_of_the_program(opened, folder):
    """By the keyboard, to a point of the sweep: all its digits are those of the program."""
    shown = opened("drop")
    before = number_of(shown)
    slider = shown.locator("#slider-0")
    slider.focus()
    # half of the places of the slider to the next point of the sweep, from the middle
    for _ in range(240 // (POINTS - 1)):
        slider.press("ArrowRight")
    assert shown.input_value("#number-0") == "25"
    assert slider.get_attribute("aria-valuetext") == "25 °C"
    shown.fill("#number-1", "13")
    after = number_of(shown)
    assert after != before
    words = [folder / "drop.nml", *FILES, "--set", "impact.temperature=298.15"]
    value = program(*words, "--set", "sphere.diameter=13e-3")
    assert after == f"{value:.{len(after) - 2}f}"
    # between the points: within the error that the page says, of the digits too
    shown.fill("#number-0", "22.3")
    words[-1] = "impact.temperature=295.45"
    value = program(*words, "--set", "sphere.diameter=13e-3")
    error = float(re.search(r"± (\S+) by", shown.inner_text("#error"))[1])
    digit = 0.5 * 10.0 ** (2 - len(after))
    assert abs(float(number_of(shown)) - value) < 2 * error + digit


@pytest.mark.parametrize("name", ["drop", "pad"])
def test_the_page_interpolates_as_the_package_does(opened, tables, name):
    shown = opened(name)
    rng = np.random.default_rng(3)
    seen = []
    for i, table in enumerate(tables[name]):
        places = rng.random((200, len(table.counts))) * (np.array(table.counts) - 1)
        places[:40] = places[:40].round()
        words = "([i, places]) => places.map((one) => vcor.at(i, one))"
        found = shown.evaluate(words, [i, places.tolist()])
        found = [np.nan if one is None else one for one in found]
        expected = [table.at(place).value for place in places.tolist()]
        # the same operations on the same numbers, in another order
        assert found == pytest.approx(expected, rel=1e-12, nan_ok=True)
        seen += expected
    assert np.isnan(seen).any() and np.isfinite(seen).any()


def test_the_choice_of_a_material(opened, folder):
    shown = opened("drop")
    shown.fill("#number-0", "20")
    rubber = number_of(shown)
    height = shown.inner_text("#height")
    assert height == f"Rebound height {100 * 0.5 * float(rubber) ** 2:.3g} cm of 50 cm"
    shown.select_option("#material", label="butyl")
    butyl = number_of(shown)
    value = program(
        folder / "drop.nml", *FILES, "--set", "impact.temperature=293.15",
        "--set", "sphere.diameter=22e-3", "--set", "plate.material=butyl",
    )  # fmt: skip
    shown.fill("#number-1", "22")
    assert number_of(shown) == f"{value:.{len(butyl) - 2}f}" and butyl != rubber
    assert "material = 'butyl'" in shown.locator("#case").text_content()
    assert shown.inner_text("#said").startswith("butyl: 9 x 9 impacts")


def test_verdicts_and_where_there_is_no_number(opened, tables):
    shown = opened("pad")
    (table,) = tables["pad"]
    found = dict.fromkeys(table.state.tolist())
    for k in found:
        node = int(np.flatnonzero(table.state == k)[0])
        status, level, _contacts = table.states[k]
        value = 0.2 * 40.0 ** (node / 32)
        shown.fill("#number-0", repr(min(max(value, 0.2), 8.0)))
        sentence = shown.inner_text("#verdict")
        if np.isnan(table.cor[node]):
            assert shown.inner_text("#e") == "e = –"
            assert sentence == f"No result: {status.replace('_', ' ')}."
            assert shown.inner_text("#height") == ""
            continue
        assert shown.get_attribute("#verdict", "data-level") == level
        assert sentence.startswith(f"{level.capitalize()}. ")
        assert ("layer_strain" in sentence) == (level != "good")
    # between the last good point and the first one with caution
    change = int(np.flatnonzero(np.diff(table.state))[0])
    shown.fill("#number-0", f"{0.2 * 40.0 ** ((change + 0.5) / 32):.6g}")
    assert shown.inner_text("#e") == "e = –" and shown.inner_text("#error") == ""
    assert "between impacts of different kinds (good, caution)" in shown.inner_text("#verdict")
    curve = columns(shown, "curve")
    x = np.array(curve.pop("x"))
    values = {level: np.array(some, dtype=float) for level, some in curve.items()}
    shown_at = np.array([np.isfinite(some) for some in values.values()])
    assert shown_at.any(axis=1).all() and shown_at.sum(axis=0).max() == 1
    gap = (x > 0.2 * 40.0 ** ((change + 0.01) / 32)) & (x < 0.2 * 40.0 ** ((change + 0.99) / 32))
    assert gap.sum() > 3 and not shown_at[:, gap].any()
    # and none where there is no result
    assert not shown_at[
        :, x > 0.2 * 40.0 ** (np.flatnonzero(np.isfinite(table.cor))[-1] / 32) + 1e-9
    ].any()


ROWS = """temperature [C]; e; bar
10; 0,55; 0,02   # in the fridge

20	61 %
thirty; 0.6
30; 0.6; 0.1; 4
35; 36
"""


def test_measured_points(opened):
    shown = opened("drop")
    assert shown.locator("#legend .points").is_hidden()
    shown.fill("#rows", ROWS)
    points = columns(shown, "points")
    assert points["x"] == [10, 20] and points["e"] == [0.55, 0.61]
    assert points["low"] == pytest.approx([0.53, 0.61])
    assert points["high"] == pytest.approx([0.57, 0.61])
    assert shown.locator("#legend .points").is_visible()
    faults = shown.locator("#faults li").all_inner_texts()
    assert [one.partition(":")[0] for one in faults] == ["line 5", "line 6", "line 7"]
    for fault, word in zip(faults, ("'thirty'", "found 4 numbers", "e = 36"), strict=True):
        assert word in fault
    # the axes hold the points
    axis = "Bokeh.documents[0].get_model_by_name('figure').y_range"
    assert shown.evaluate(f"{axis}.start") < 0.53 < shown.evaluate(f"{axis}.end")
    shown.fill("#rows", "\n".join(["wrong"] * 30))
    assert len(shown.locator("#faults li").all()) == 6
    shown.click("#clear")
    assert columns(shown, "points")["x"] == [] and shown.input_value("#rows") == ""
    assert shown.locator("#faults li").count() == 0


def test_a_file_of_points(opened, tmp_path):
    shown = opened("drop")
    (tmp_path / "points.csv").write_text("x,e\n5,0.5,0.01\n15,0.6\n")
    shown.set_input_files("#file", tmp_path / "points.csv")
    expect(shown.locator("#legend .points")).to_be_visible()
    assert columns(shown, "points")["e"] == [0.5, 0.6]
    shown.evaluate(
        """() => {
             const dropped = new DataTransfer()
             dropped.items.add(new File(["25 0.7 0.1"], "other.csv"))
             const event = {dataTransfer: dropped, bubbles: true, cancelable: true}
             document.body.dispatchEvent(new DragEvent("drop", event))
           }"""
    )
    expect(shown.locator("#rows")).to_have_value("25 0.7 0.1")
    assert columns(shown, "points")["high"] == pytest.approx([0.8])
    large = {"name": "large.csv", "mimeType": "text/csv", "buffer": b"1,0.5\n" * 700_000}
    shown.set_input_files("#file", large)
    expect(shown.locator("#faults")).to_contain_text("large.csv: found 4200000 bytes")
    assert columns(shown, "points")["x"] == [25]


def test_a_wrong_value_is_said_at_its_widget(opened):
    shown = opened("drop")
    before = number_of(shown)
    for value in ("41", "-1", ""):
        shown.fill("#number-0", value)
        found = value or "no number"
        assert shown.inner_text("#fault-0") == f"found {found}, expected 0 to 40 °C"
        assert number_of(shown) == before and shown.inner_text("#fault-1") == ""
        shown.fill("#number-0", "20")
        assert shown.inner_text("#fault-0") == ""


def test_a_narrow_window_has_one_column(opened):
    shown = opened("drop", viewport={"width": 400, "height": 800})
    shown.fill("#rows", ROWS)
    assert shown.evaluate("document.documentElement.scrollWidth") <= 400
    boxes = [one.bounding_box() for one in shown.locator("main > section").all()]
    assert len({box["x"] for box in boxes}) == 1
    assert all(
        one["y"] + one["height"] <= other["y"] for one, other in zip(boxes, boxes[1:], strict=False)
    )
    figure = shown.locator("#figure canvas").first.bounding_box()
    assert figure["x"] >= 0 and figure["x"] + figure["width"] <= 400


def lightness(colour):
    """Relative luminance of `rgb(r, g, b)` or `#rrggbb`, of the WCAG."""
    if colour.startswith("#"):
        parts = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
    else:
        parts = [int(one) for one in re.findall(r"\d+", colour)[:3]]
    parts = [one / 255 for one in parts]
    linear = [one / 12.92 if one <= 0.04045 else ((one + 0.055) / 1.055) ** 2.4 for one in parts]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def contrast(one, other):
    low, high = sorted((lightness(one), lightness(other)))
    return (high + 0.05) / (low + 0.05)


def test_light_and_dark(opened):
    """Texts have the contrast that the WCAG ask for, 4.5; the figure follows the scheme."""
    shown = opened("drop", color_scheme="light")
    backs = []
    for scheme in ("light", "dark"):
        shown.emulate_media(color_scheme=scheme)
        colours = {
            name: shown.evaluate(f"getComputedStyle(document.body).getPropertyValue('--{name}')")
            for name in ("page", "box", "text", "soft", "curve", "points", *LEVELS)
        }
        backs.append(lightness(colours["page"]))
        for name in ("text", "soft", *LEVELS):
            assert contrast(colours[name], colours["box"]) >= 4.5
        for name in ("curve", "points"):
            assert contrast(colours[name], colours["page"]) >= 3
        line = "Bokeh.documents[0].get_model_by_name('good').glyph.line_color.value"
        shown.wait_for_function(f"{line} === '{colours['curve']}'")
    assert backs[0] > 0.9 and backs[1] < 0.05


def test_the_keyboard_reaches_everything(opened):
    shown = opened("drop")
    reached = []
    for _ in range(40):
        shown.keyboard.press("Tab")
        reached.append(shown.evaluate("document.activeElement.id"))
    wanted = ["material", "slider-0", "number-0", "slider-1", "number-1", "rows", "file", "clear"]
    assert [one for one in dict.fromkeys(reached) if one in wanted] == wanted
