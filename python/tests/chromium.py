"""Debian's Chromium for tests of pages."""

import shutil
from contextlib import contextmanager

import pytest

CHROMIUM = shutil.which("chromium")
if CHROMIUM is None:
    pytest.skip(
        "there is no chromium: scripts/setup.sh --tests installs it", allow_module_level=True
    )
playwright = pytest.importorskip("playwright.sync_api")


@contextmanager
def launched():
    """A browser."""
    with playwright.sync_playwright() as driver:
        made = driver.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )
        yield made
        made.close()
