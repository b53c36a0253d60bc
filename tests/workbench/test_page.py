"""The page in a real browser: one server for all tests, a tab for each."""

import os
import re
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from symfpu import Chain, lindstedt, load, save, solve_amplitudes
from tests.workbench.chromium import browser

pytestmark = pytest.mark.long
PATIENCE = 120_000  # milliseconds: a busy machine, a process that starts
ROOT = Path(__file__).parents[2]
SPECTRUM = 'svg[aria-label="spectrum"]'
HANDLE = ".noUi-handle"


@pytest.fixture(scope="module")
def address():
    """The workbench as a user starts it."""
    pytest.importorskip("panel")
    command = [sys.executable, "-m", "symfpu", "workbench", "--no-browser"]
    running = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, env=os.environ | {"COLUMNS": ""})
    line = running.stdout.readline()
    yield line.split()[-1]
    running.terminate()
    running.wait()
    running.stdout.close()


@pytest.fixture(scope="module")
def chrome():
    with browser() as running:
        yield running


@pytest.fixture
def tab(chrome, address):
    """A function that opens another tab and waits for its pictures."""
    contexts = []

    def opened(width=1400, height=900):
        context = chrome.new_context(viewport={"width": width, "height": height}, permissions=["clipboard-read", "clipboard-write"])
        contexts.append(context)
        return opened_in(context, address)

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture(scope="module")
def shared(chrome, address):
    """One tab for all tests that leave it usable: it takes a process of its own, and seconds to start."""
    context = chrome.new_context(viewport={"width": 1400, "height": 900}, permissions=["clipboard-read", "clipboard-write"])
    yield opened_in(context, address)
    context.close()


@pytest.fixture
def page(shared):
    """The same tab with the chain of N = 32 and the seeds 1 and 2, whatever was done before."""
    shared.get_by_role("button", name="fixed ends").click()
    shared.get_by_role("button", name="frequencies \u03c9").click()
    typed(shared, "or another potential V(r)", "")
    typed(shared, "seeds D\u2080", "1,2")
    typed(shared, "mode q", "3")
    for N, linear in (("16", "0.1960342807"), ("32", "0.09813534865")):
        typed(shared, "N, bonds", N)
        shared.wait_for_function(TEXT, arg=["table.seeds tbody tr", linear])
        shared.locator(".idle").wait_for(state="attached")
    shared.locator(".problem").first.wait_for(state="detached")
    return shared


def opened_in(context, address):
    """A tab with its pictures."""
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.requested = []
    page.on("request", lambda request: page.requested.append(request.url))
    page.goto(address)
    page.wait_for_selector("img.picture")
    return page


def field(page, label):
    return page.get_by_label(label, exact=True)


def typed(page, label, text):
    field(page, label).fill(text)
    field(page, label).press("Enter")


def changed(page, before, what=SPECTRUM):
    """Waits until a picture is another one; returns it."""
    page.wait_for_function(OTHER, arg=[what, before])
    return picture(page, what)


def picture(page, what=SPECTRUM):
    return page.locator(what).evaluate("element => element.outerHTML")


# these look into the shadow trees of the page, as the locators of playwright do
FOUND = """([what, wanted]) => {
  const find = root => {
    const found = root.querySelector(what);
    if (found) return found;
    for (const element of root.querySelectorAll('*'))
      if (element.shadowRoot) { const inner = find(element.shadowRoot); if (inner) return inner; }
    return null;
  };
  const now = find(document);
  return now !== null && (%s);
}"""
OTHER = FOUND % "now.outerHTML !== wanted"
TEXT = FOUND % "now.innerText.includes(wanted)"


def lines(page):
    """The lines of Python of the page, as its button copies them."""
    page.get_by_role("button", name="Copy the Python lines").click()
    return page.evaluate("navigator.clipboard.readText()")


def lines_with(page, word):
    """The lines as soon as they have a word: they change after the button is pressed, not with it."""
    found = lines(page)
    for _ in range(100):
        if word in found:
            break
        page.wait_for_timeout(200)
        found = lines(page)
    return found


def amplitudes_shown(page):
    rows = page.locator("table.seeds tbody tr")
    cells = [row.locator("td").all_inner_texts() for row in rows.all()]
    return {int(re.search(r"-?\d+", row[0])[0]): row[4] for row in cells}


def problem(page):
    message = page.locator(".problem").first
    message.wait_for()
    return message.inner_text()


def downloaded(page, button, path):
    with page.expect_download() as download:
        page.get_by_role("button", name=button).click()
    download.value.save_as(path)
    return path


def test_a_slider_changes_the_pictures_by_the_keyboard(page):
    made = lines(page)
    before, residual = picture(page), picture(page, 'svg[aria-label="residual by order"]')
    handle = page.locator(HANDLE).first
    handle.focus()
    for _ in range(3):
        handle.press("ArrowRight")
    changed(page, before)
    changed(page, residual, 'svg[aria-label="residual by order"]')
    assert lines(page) != made


def test_the_copied_lines_give_the_numbers_of_the_page(page):
    before = picture(page)
    typed(page, "seeds D\u2080", "1,3")
    changed(page, before)
    names = {}
    exec(lines(page), names)
    page.wait_for_function(TEXT, arg=["table.seeds", "q = 3"])
    assert amplitudes_shown(page) == {q: f"{a:.10g}" for q, a in names["torus"].amplitudes.items()}


def test_amplitudes_and_energy_begin_at_the_torus_that_is_there(page):
    before, shown = picture(page), amplitudes_shown(page)
    page.get_by_role("button", name="amplitudes A").click()
    found = lines_with(page, "amplitudes={")
    typed_amplitudes = dict(re.findall(r'(\d): "([\d.]+)"', found))
    assert {int(q): float(a) for q, a in typed_amplitudes.items()} == pytest.approx({q: float(a) for q, a in shown.items()})
    page.get_by_role("button", name="energy H").click()
    changed(page, before)
    assert "energy=symfpu.Energy(" in lines_with(page, "energy=")


def test_errors_are_text_and_go_away(page):
    """Of which words: tests/workbench/test_choice.py."""
    typed(page, "N, bonds", "1")
    assert "N = 1: allowed is an integer from 2 up" in problem(page)
    typed(page, "N, bonds", "32")
    page.locator(".problem").first.wait_for(state="detached")


def test_no_real_amplitude_is_text(page):
    value = page.locator("input[type=text]").nth(5)
    value.fill("0.0975")
    value.press("Enter")
    assert "no real amplitude" in problem(page)


def test_newton_refines_and_a_slider_leaves_it_behind(page):
    before = picture(page)
    page.get_by_role("button", name="Refine by Newton's method").click()
    after = changed(page, before)
    assert "Newton" in after
    assert "refined = refine(torus)" in lines(page)
    page.locator(HANDLE).first.press("ArrowRight")
    changed(page, after)
    assert "refine" not in lines(page)


def test_waves_of_a_ring_are_seen_refined_and_saved(page, tmp_path):
    section = 'svg[aria-label="section"]'
    before, fixed = picture(page), picture(page, section)
    page.get_by_role("button", name="ring").click()
    series = changed(page, before)
    assert "Re" in changed(page, fixed, section)
    page.get_by_role("button", name="Refine by Newton's method").click()
    assert "Newton" in changed(page, series)
    names = {}
    exec(lines(page), names)
    page.wait_for_function(TEXT, arg=["table.seeds", f"{names['refined'].amplitudes[1]:.10g}"])
    path = downloaded(page, "Save as bundle", tmp_path / "ring.symfpu")
    assert type(load(path).origin).__name__ == "Newton"


def test_amplitudes_of_a_ring_are_refused_by_name(page):
    before = picture(page)
    page.get_by_role("button", name="ring").click()
    changed(page, before)
    page.get_by_role("button", name="amplitudes A").click()
    page.get_by_text("amplitudes of a ring").first.wait_for()


def test_a_bundle_is_saved_and_loaded(page, tmp_path):
    kept = load(downloaded(page, "Save as bundle", tmp_path / "kept.symfpu"))
    assert {q: f"{a:.10g}" for q, a in kept.amplitudes.items()} == amplitudes_shown(page)
    other = solve_amplitudes(lindstedt(Chain(8, beta="0.3"), (1,), ("0.3905",), 4))
    before = picture(page)
    page.locator("input[type=file]").set_input_files(save(tmp_path / "other.symfpu", other))
    changed(page, before)
    assert 'load("other.symfpu")' in lines(page)
    assert amplitudes_shown(page) == {1: f"{other.amplitudes[1]:.10g}"}
    assert field(page, "N, bonds").input_value() == "8"


def test_a_damaged_bundle_is_refused(page, tmp_path):
    file = tmp_path / "damaged.symfpu"
    torus = solve_amplitudes(lindstedt(Chain(8, beta="0.3"), (1,), ("0.3905",), 4))
    content = bytearray(save(file, torus).read_bytes())
    content[len(content) // 2] ^= 255
    file.write_bytes(content)
    page.locator("input[type=file]").set_input_files(file)
    message = problem(page)
    assert message.startswith("damaged.symfpu")


def test_code_is_exported(page, tmp_path):
    path = downloaded(page, "Export code", tmp_path / "torus.c")
    assert "written by symfpu" in path.read_text().replace(":", "")


def test_two_tabs_are_independent(tab):
    one, other = tab(), tab()
    untouched = picture(other)
    before = picture(one)
    typed(one, "N, bonds", "16")
    changed(one, before)
    assert picture(other) == untouched
    assert "N=32" in lines(other)
    assert "N=16" in lines(one)


def test_a_term_is_typeset(page):
    formula = page.locator(".formula svg")
    formula.wait_for()
    assert "Q_{3}^{(2)}" in formula.get_attribute("aria-label")
    typed(page, "mode q", "99")
    assert "q = 99" in problem(page)


def test_a_slow_case_says_so_and_is_cancelled(tab):
    """In a tab of its own, with the order that a page begins with: eight seeds take two gigabytes, and seconds."""
    page = tab()
    typed(page, "seeds D\u2080", "1,2,3,4,5,6,7,8")
    page.get_by_text(re.compile(r"computing, \d+ s")).wait_for()
    page.get_by_role("button", name="Cancel").click()
    assert "cancelled" in problem(page)
    typed(page, "seeds D\u2080", "1,2")
    page.locator(".problem").first.wait_for(state="detached")
    page.wait_for_function(OTHER, arg=[SPECTRUM, ""])


def test_nothing_is_asked_of_another_machine(page, address):
    here = address.partition("?")[0]
    outside = [url for url in page.requested if not url.startswith((here, "data:", f"blob:{here}"))]
    assert outside == []


@pytest.mark.parametrize("path", ["", "?token=wrong", "autoload.js?bokeh-autoload-element=1", "metadata"])
def test_pages_without_the_token_are_refused(address, path):
    with pytest.raises(urllib.error.HTTPError) as caught:
        urllib.request.urlopen(address.partition("?")[0] + path)
    assert caught.value.code == 403
    caught.value.close()


def test_a_websocket_without_the_token_is_refused(address):
    url = address.partition("?")[0] + "ws"
    headers = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Protocol": "bokeh, x",
    }
    with pytest.raises(urllib.error.HTTPError) as caught:
        urllib.request.urlopen(urllib.request.Request(url, headers=headers))
    assert caught.value.code == 403
    caught.value.close()
