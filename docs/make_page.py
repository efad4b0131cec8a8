"""Write docs/page.png and docs/live.png: the pages of docs/page.md in Chromium.

    pip install './python[page]' playwright && python docs/make_page.py

needs the program /usr/bin/chromium, which scripts/setup.sh --tests installs.
"""

import re
import shutil
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from vcor._command import call
from vcor.page.server import start_case

ROOT = Path(__file__).resolve().parent.parent
# Made-up measurements: temperature [C], e, bar
ROWS = "5, 0.85, 0.02\n23, 0.92, 0.02\n45, 0.96, 0.02"
# Drop height [mm], e, bar
LIVE_ROWS = "150, 0.925, 0.01\n300, 0.92, 0.01\n600, 0.905, 0.01"


def live(driver):
    """The live page without a case, with a kept curve and measured points."""
    made = start_case().page()
    browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
    shown = browser.new_page(viewport={"width": 1280, "height": 860}, color_scheme="light")
    shown.goto(made.url)
    shown.locator("#cor_sphere").wait_for(state="attached")
    shown.get_by_role("button", name="Keep this curve").click()
    shown.get_by_text("now: the same values").wait_for()
    temperature = shown.get_by_label("Temperature").first
    temperature.fill("5")
    temperature.press("Enter")
    shown.get_by_text("now: impact temperature 5").wait_for()
    shown.locator(".exact").first.wait_for()
    shown.locator("textarea").fill(LIVE_ROWS)
    shown.locator("textarea").blur()
    shown.evaluate("scrollTo(0, 0); document.getElementById('inputs').scrollTo(0, 0)")
    # the curves are drawn in the next frame
    shown.wait_for_timeout(1000)
    shown.screenshot(path=ROOT / "docs" / "live.png")
    browser.close()
    made.stop()


def main():
    """Run the commands of the page and take their pictures."""
    text = (ROOT / "docs" / "page.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```sh\n(cat > ball\.nml.*?)^```$", text, re.S | re.M)
    case, command = re.fullmatch(r"cat .*?\n(.*?)^END\nvcor page (.*)", block, re.S | re.M).groups()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        file, made = Path(folder) / "ball.nml", Path(folder) / "ball.html"
        file.write_text(case)
        words = [word for word in command.split() if word != "\\"]
        places = {"ball.nml": file, "ball.html": made}
        call("page", [str(places.get(word, ROOT / word if "/materials/" in word else word)) for word in words])
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        shown = browser.new_page(viewport={"width": 960, "height": 700}, color_scheme="light")
        shown.goto(made.as_uri())
        shown.wait_for_selector("body[data-ready]")
        shown.fill("#number-0", "23")
        shown.fill("#rows", ROWS)
        shown.evaluate("document.activeElement.blur()")
        # the curve is drawn in the next frame
        shown.wait_for_timeout(500)
        shown.screenshot(path=ROOT / "docs" / "page.png", full_page=True)
        browser.close()
        live(driver)


if __name__ == "__main__":
    main()
