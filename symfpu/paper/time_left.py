"""How much of all targets is done, from what each took where it was measured."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import monotonic

from symfpu.files.progress import Progress

ENDING = 0.05  # of a target that takes longer than it should: so much is left of it
TICK = 1.0  # seconds
TRUSTED = 20.0  # seconds, until which a machine counts as fast as that of the table


class TimeLeft:
    """The progress of targets that are at work side by side, as one.

    seconds : of each target, as measured once. workers : at work at once. tell : hears the steps
    that are being done, with the part of all for a fraction, which never falls.
    """

    def __init__(
        self,
        seconds: Mapping[str, float],
        workers: int,
        tell: Progress,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._seconds, self._workers = dict(seconds), workers
        self._tell, self._clock = tell, clock
        self._begun: dict[str, float] = {}
        self._took: dict[str, float] = {}
        self._steps: dict[str, str] = {}
        self._part = 0.0
        self._lock = threading.Lock()

    def of(self, target: str) -> Progress:
        """What one of them tells."""

        def told(label: str, fraction: float) -> None:
            with self._lock:
                self._begun.setdefault(target, self._clock())
                self._steps[target] = _step(label, fraction)
                self._tell(self._line(), self._done())

        return told

    def ended(self, target: str) -> None:
        """It is done, or has failed."""
        with self._lock:
            now = self._clock()
            self._took[target] = now - self._begun.setdefault(target, now)
            self._steps.pop(target, None)

    @contextmanager
    def ticking(self, every: float = TICK) -> Iterator[None]:
        """Inside of it the time left is told again and again, also while all steps are silent."""
        over = threading.Event()
        watch = threading.Thread(target=self._tick, args=(over, every), daemon=True)
        watch.start()
        try:
            yield
        finally:
            over.set()
            watch.join()

    def _tick(self, over: threading.Event, every: float) -> None:
        while not over.wait(every):
            with self._lock:
                if self._steps:
                    self._tell(self._line(), self._done())

    def _line(self) -> str:
        """How many targets are done, and all steps at work."""
        steps = "; ".join(self._steps.values())
        if len(self._seconds) == 1:
            return steps
        return f"{len(self._took)} of {len(self._seconds)} done; {steps}"

    def _done(self) -> float:
        """The part of the whole time that has passed; no less than it was."""
        passed = self._clock() - min(self._begun.values())
        self._part = max(self._part, passed / (passed + self.seconds_left()))
        return self._part

    def seconds_left(self) -> float:
        """Until all are done, if the rest goes as the beginning."""
        rests = [self._rest(target) for target in self._seconds]
        return max(sum(rests) / self._workers, *rests)

    def _rest(self, target: str) -> float:
        if target in self._took:
            return 0.0
        whole = self._slowness() * self._seconds[target]
        if target not in self._begun:
            return whole
        age = self._clock() - self._begun[target]
        return max(whole - age, ENDING * whole)

    def _slowness(self) -> float:
        """Seconds here for one of the table, by the targets that are done."""
        due = sum(self._seconds[target] for target in self._took)
        return (TRUSTED + sum(self._took.values())) / (TRUSTED + due)


def _step(label: str, fraction: float) -> str:
    """The label, with the part of it that is done in brackets where it is known."""
    return label if math.isnan(fraction) else f"{label} ({fraction:.0%})"
