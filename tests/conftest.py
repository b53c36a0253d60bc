"""Settings of the whole suite: hypothesis draws the same examples every time and leaves no files behind; an executor."""

import math
import signal
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import settings

settings.register_profile("suite", max_examples=40, deadline=None, derandomize=True, database=None)
settings.load_profile("suite")


# a run in the background of a script ignores the interrupt key, and its children with it; tests press it
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def no_lines_of_progress(monkeypatch):
    """They come after seconds, more of them on a slow machine; the tests of these lines ask for them."""
    monkeypatch.setattr("symfpu.cli.terminal.PATIENCE", math.inf)


@pytest.fixture(autouse=True)
def lines_of_any_length(monkeypatch):
    """As where output is piped; workers of a parallel run hand their width down, and lines would be folded at it."""
    monkeypatch.delenv("COLUMNS", raising=False)


@pytest.fixture(scope="session")
def threads():
    """An executor of sweeps in this process, where others take seconds to start."""
    with ThreadPoolExecutor(2) as pool:
        yield pool
