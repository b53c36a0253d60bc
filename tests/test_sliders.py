"""The sliders of the notebooks in a real browser: JupyterLab runs the notebook, a slider is moved by its keys, and the picture changes.

Needs JupyterLab, which is no part of the development extra: pip install jupyterlab.
"""

import json
import os
import shutil
import subprocess
import sys
import time
import urllib.request
from importlib.util import find_spec
from pathlib import Path

import pytest

from symfpu.workbench.server import free_port
from tests.workbench.chromium import browser

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
WITH_SLIDERS = [path for path in sorted(NOTEBOOKS.glob("*.ipynb")) if "sliders = interact(" in path.read_text()]
TOKEN = "sliders"
PATIENCE = 600_000  # milliseconds: all cells of a notebook on a busy machine
READY = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel?.status === 'idle'"
RUN_ALL = "window.jupyterapp.commands.execute('notebook:run-all-cells')"
HANDLE = ".widget-slider .noUi-handle"
PICTURE = ".widget-interact .widget-output img"


def test_there_are_sliders():
    assert len(WITH_SLIDERS) == 4


def answers(address):
    try:
        with urllib.request.urlopen(f"{address}/api?token={TOKEN}", timeout=1) as reply:
            return "version" in json.load(reply)
    except OSError:
        return False


@pytest.fixture
def laboratory(tmp_path):
    """JupyterLab over a folder of its own, with the notebooks copied into it."""
    if find_spec("jupyterlab") is None:
        pytest.skip("JupyterLab is not installed: pip install jupyterlab")
    for path in WITH_SLIDERS:
        shutil.copy(path, tmp_path)
    port = free_port()
    words = [f"--ServerApp.port={port}", f"--IdentityProvider.token={TOKEN}", f"--ServerApp.root_dir={tmp_path}"]
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--LabApp.expose_app_in_browser=True", *words]
    surroundings = os.environ | {"IPYTHONDIR": str(tmp_path), "JUPYTER_CONFIG_DIR": str(tmp_path), "HOME": str(tmp_path)}
    with (tmp_path / "log").open("w") as log:
        running = subprocess.Popen(command, stdout=log, stderr=log, env=surroundings)
    address = f"http://127.0.0.1:{port}"
    end = time.monotonic() + 120
    while not answers(address):
        ended = running.poll() is not None or time.monotonic() > end
        assert not ended, (tmp_path / "log").read_text()[-2000:]
        time.sleep(0.2)
    yield address
    running.terminate()
    running.wait()


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("path", WITH_SLIDERS, ids=lambda path: path.name)
def test_a_slider_draws_anew(path, laboratory, tmp_path):
    with browser() as chrome:
        page = chrome.new_page(viewport={"width": 1200, "height": 1000})
        page.set_default_timeout(PATIENCE)
        page.goto(f"{laboratory}/lab/tree/{path.name}?token={TOKEN}")
        page.wait_for_selector(".jp-Notebook .jp-CodeCell")
        page.wait_for_function(READY)
        page.evaluate(RUN_ALL)
        handle = page.locator(HANDLE).first
        handle.scroll_into_view_if_needed()
        picture = page.locator(PICTURE).first
        picture.wait_for()
        before = picture.get_attribute("src")
        value = page.locator(".widget-readout").first
        shown = value.inner_text()
        handle.focus()
        page.keyboard.press("ArrowRight")
        page.wait_for_function(
            "([selector, before]) => { const found = document.querySelector(selector); return found && found.src !== before; }",
            arg=[PICTURE, before],
        )
        assert value.inner_text() != shown
        page.screenshot(path=tmp_path / f"{path.stem}.png")
