"""Targets side by side on worker processes: a picture soon, then the slowest first."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from concurrent.futures import Future, as_completed
from contextlib import closing
from functools import partial
from pathlib import Path

from symfpu.algebra.dense import available_cores
from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress
from symfpu.paper.claims import PaperFigure
from symfpu.paper.targets import FIRST_PICTURE, SECONDS, reproduced
from symfpu.paper.time_left import TimeLeft
from symfpu.sweeps.workers import worker_processes

Found = tuple[str, PaperFigure | Exception]


class TargetsFailed(SymfpuError):
    """Some targets of several have no figure; all others are done.

    failures : what went wrong, by target.
    """

    def __init__(self, failures: Mapping[str, Exception]) -> None:
        self.failures = dict(failures)
        parts = [
            f"{target} ({type(error).__name__}: {error})"
            for target, error in failures.items()
        ]
        super().__init__(f"no figures of {'; '.join(parts)}; the others are done")


def side_by_side(
    targets: list[str],
    folder: Path,
    progress: Progress,
    *,
    full: Mapping[str, float] | None = None,
) -> Generator[Found, None, None]:
    """Each target with its figure, or with the error that it ended with, as they end.

    On as many processes as there are cores, a single one in this process. full : the seconds that
    --full adds by target, None without it. Left before its end, what is at work is ended:
    alignment indices go on from their checkpoints.
    """
    added = full or {}
    seconds = {target: SECONDS[target] + added.get(target, 0.0) for target in targets}
    order = in_turn(seconds)
    workers = min(len(order), available_cores())
    left = TimeLeft(seconds, workers, progress)
    computed = _in_this_process if workers == 1 else _in_workers
    coming = computed(order, folder, left, workers, full=full is not None)
    with left.ticking(), closing(coming):
        for target, found in coming:
            yield target, found
            left.ended(target)


def in_turn(seconds: Mapping[str, float]) -> list[str]:
    """The one with the first picture, then the slowest first."""
    order = sorted(seconds, key=lambda target: -seconds[target])
    return sorted(order, key=lambda target: target != FIRST_PICTURE)


def _in_this_process(
    order: list[str], folder: Path, left: TimeLeft, workers: int, *, full: bool
) -> Generator[Found, None, None]:
    for target in order:
        yield (
            target,
            _tried(partial(reproduced, target, folder, left.of(target), full=full)),
        )


def _in_workers(
    order: list[str], folder: Path, left: TimeLeft, workers: int, *, full: bool
) -> Generator[Found, None, None]:
    with worker_processes(workers) as pool:
        futures: dict[Future[PaperFigure], str] = {}
        for target in order:
            task = pool.submit_heard(left.of(target), reproduced, target, folder, full=full)
            futures[task] = target
        for task in as_completed(futures):
            yield futures[task], _tried(task.result)


def _tried(compute: Callable[[], PaperFigure]) -> PaperFigure | Exception:
    """The figure, or the error: it costs no other target."""
    try:
        return compute()
    except Exception as error:
        return error
