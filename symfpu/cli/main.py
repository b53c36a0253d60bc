"""Where the command line begins: it hears the interrupt key before anything large is loaded."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Sequence

from symfpu.cli.interrupting import hear, leave


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    return _application()(arguments)


def run() -> None:
    """Entry point of the console script."""
    if sys.stderr is None:  # closed: Python would print errors where results belong
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    try:
        usual = signal.getsignal(signal.SIGINT)
        hear(leave)
        answer = _application()
        hear(usual)
        code = answer(None)
        hear(leave)
    except KeyboardInterrupt:
        leave()
    sys.exit(code)


def _application() -> Callable[[Sequence[str] | None], int]:
    """All of it: loaded here, since this module must be there first."""
    from symfpu.cli.application import answer

    return answer
