"""Tasks on an executor, as many at once as the memory holds."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from queue import SimpleQueue
from typing import Any, NamedTuple


class Call(NamedTuple):
    """One case for an executor: as its row has it, its arguments, and the bytes that it needs."""

    case: dict[str, Any]
    arguments: dict[str, Any]
    needed: int = 0


def finished(
    executor: Executor, function: Callable[..., Any], calls: Sequence[Call], within: int
) -> Iterator[tuple[Call, Future[Any]]]:
    """Every call with its future, as they end.

    Calls go out in their order, and wait while those on their way need so much that the next would
    exceed `within` bytes; none may need more alone. Those that have ended go before others are
    sent out. Those on their way are cancelled if the caller stops.
    """
    ended: SimpleQueue[Future[Any]] = SimpleQueue()
    waiting = deque(calls)
    running: dict[Future[Any], Call] = {}
    free = within
    try:
        while waiting or running:
            while waiting and waiting[0].needed <= free and ended.empty():
                call = waiting.popleft()
                free -= call.needed
                future = _submitted(executor, function, call)
                running[future] = call
                future.add_done_callback(ended.put)
            future = ended.get()
            call = running.pop(future)
            free += call.needed
            yield call, future
    finally:
        for future in running:
            future.cancel()


def _submitted(executor: Executor, function: Callable[..., Any], call: Call) -> Future[Any]:
    """The future of a call; one that has failed already in a pool that is broken."""
    try:
        return executor.submit(function, call.arguments)
    except BrokenExecutor as error:
        failed: Future[Any] = Future()
        failed.set_exception(error)
        return failed
