"""Write docs/page.png: the page of docs/page.md in Chromium, with three measured points.

    pip install './python[page]' playwright && python docs/make_page.py

needs the program /usr/bin/chromium, which scripts/setup.sh --tests installs.
"""

import re
import shutil
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from vcor._command import call

ROOT = Path(__file__).resolve().parent.parent
# Made-up measurements: temperature [C], e, bar
ROWS = "5, 0.85, 0.02\n23, 0.92, 0.02\n45, 0.96, 0.02"


def main():
    """Run the command of the page and take its picture."""
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


if __name__ == "__main__":
    main()
