"""The interrupt key where no work is under way that would be kept."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from typing import Any

INTERRUPTION = "interrupted: nothing is kept but what was already written"
INTERRUPTED = 130  # exit code


def leave(*_: object) -> None:
    """End the process at once, with one line."""
    with suppress(OSError):
        os.write(2, f"symfpu: {INTERRUPTION}\n".encode())
    os._exit(INTERRUPTED)


def hear(action: Any) -> None:
    """What the interrupt key does; nothing still, where the command was begun without it."""
    if callable(signal.getsignal(signal.SIGINT)):
        signal.signal(signal.SIGINT, action)
