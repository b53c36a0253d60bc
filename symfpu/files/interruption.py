"""The interrupt key in a run that is kept on disk: it is written whole, and says so."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from symfpu.errors import RunInterrupted

Look = Callable[[str, bool, Callable[[], None]], None]


@contextmanager
def kept_run(path: Path | None, every: float, write: Callable[[], None]) -> Iterator[Look]:
    """A function (place, finished, tell) for a run to call at each consistent state.

    It writes where that is due, and tells.

    Due is every so many seconds, at the end, and when the interrupt key was pressed: then
    RunInterrupted is raised, with the place in its message. Without a path nothing is written,
    and the key acts at once.
    """
    if path is None:
        yield lambda place, finished, tell: tell()
        return
    saved, last = time.perf_counter(), ""
    with _interrupts_noted() as pressed:

        def look(place: str, finished: bool, tell: Callable[[], None]) -> None:
            nonlocal saved, last
            last = place
            due = finished or pressed() or time.perf_counter() - saved >= every
            if due:
                write()
                saved = time.perf_counter()
            if pressed():
                raise RunInterrupted(place, str(path))
            try:
                tell()
            except KeyboardInterrupt as stop:
                if not due:
                    write()
                raise RunInterrupted(place, str(path)) from stop

        yield look
        if pressed():
            raise RunInterrupted(last, str(path))


@contextmanager
def _interrupts_noted() -> Iterator[Callable[[], bool]]:
    """Whether the interrupt key was pressed; pressed again, it does what it does elsewhere.

    Only the main thread hears of it.
    """
    before, pressed = signal.getsignal(signal.SIGINT), False
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield lambda: False
        return
    usual: Callable[..., object] = before

    def note(number: int, frame: object) -> None:
        nonlocal pressed
        if pressed:
            usual(number, frame)
        pressed = True

    signal.signal(signal.SIGINT, note)
    try:
        yield lambda: pressed
    finally:
        signal.signal(signal.SIGINT, before)
