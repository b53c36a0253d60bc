"""The browser of the tests: the system's Chromium, or a test that is skipped with the package to install."""

import os
import shutil
from contextlib import contextmanager

import pytest

from tests.codegen.compilers import REQUIRED

NAMES = ("chromium", "chromium-browser", "google-chrome")
OPTIONS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]


def chromium():
    """The path of the browser; the test ends here if there is none."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        missing = "chromium is not installed (Debian: apt-get install chromium)"
        end = pytest.fail if REQUIRED in os.environ else pytest.skip
        end(missing)
    return found


@contextmanager
def browser():
    """A headless browser of playwright."""
    path = chromium()
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=path, args=OPTIONS)
        yield running
        running.close()
