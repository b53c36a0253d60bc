"""An executor for cases that are too short to be worth a process."""

from __future__ import annotations

from concurrent.futures import Executor, Future
from typing import Any


class ThisProcess(Executor):
    """Computes each call of a sweep when it is submitted, in the thread that submits it.

    No process is started, every row is kept before the next is begun, and an interrupt acts at
    once. beside : arguments of all calls that no file keeps, such as a progress.
    """

    def __init__(self, **beside: Any) -> None:
        self.beside = beside

    def submit(self, function: Any, /, *args: Any, **named: Any) -> Future[Any]:
        """The future, which has ended, of the call with its arguments and those beside."""
        future: Future[Any] = Future()
        try:
            calls = [arguments | self.beside for arguments in args]
            future.set_result(function(*calls, **named))
        except Exception as error:
            future.set_exception(error)
        return future
