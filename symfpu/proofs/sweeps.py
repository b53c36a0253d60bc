"""Sweeps of the propagation rule over all seed sets: how often the Proposition holds, and every exception.

Cases run through the standard Executor interface, and each finished case is one line of a file, from which an interrupted
sweep goes on.
"""

from __future__ import annotations

import json
import multiprocessing
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

from symfpu.chain.propagation import coupling_sequence
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import integer
from symfpu.proofs.certificates import prove_propagation

HEADER, SCHEMA = "symfpu propagation sweep", 1
BATCH = 16  # cases in one task


@dataclass(frozen=True)
class SweepCase:
    """One seed set: verdict, exceptions (mode, predicted order, actual order or None), and whether the corrected rule holds."""

    N: int
    seeds: tuple[int, ...]
    verdict: str
    exceptions: tuple[tuple[int, int | None, int | None], ...]
    corrected_rule_holds: bool


@dataclass(frozen=True)
class Sweep:
    """All cases of a sweep of the Proposition. Made by `sweep_propagation`.

    model, order : of every case. cases : sorted by N, number of seeds and seeds; each with its verdict, its
        exceptions (mode, predicted order, actual order or None) and whether the corrected rule holds.
        Dimensionless integers, exact.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import sweep_propagation
    >>> with ThreadPoolExecutor(1) as pool:
    ...     sweep_propagation((4, 5), 1, 2, model="beta", executor=pool)
    Sweep(beta, order 2: 7 seed sets: 7 proved; corrected rule holds in 7)
    """

    model: str
    order: int
    cases: tuple[SweepCase, ...] = field(repr=False)

    def __repr__(self) -> str:
        count = Counter(case.verdict for case in self.cases)
        verdicts = ", ".join(f"{n} {verdict}" for verdict, n in sorted(count.items()))
        holds = sum(case.corrected_rule_holds for case in self.cases)
        return f"Sweep({self.model}, order {self.order}: {len(self.cases)} seed sets: {verdicts}; corrected rule holds in {holds})"

    @property
    def exceptions(self) -> tuple[SweepCase, ...]:
        """The cases in which the proposition fails."""
        return tuple(case for case in self.cases if case.verdict == "refuted")


def decide(cases: Sequence[tuple[int, tuple[int, ...]]], model: str, order: int) -> list[dict[str, Any]]:
    """Decide some seed sets on one core; plain data in and out, so that any executor can carry it."""
    decided = []
    for N, seeds in cases:
        proof = prove_propagation(N, seeds, order, model=model, workers=1)
        corrected = tuple(coupling_sequence(N, seeds, order, model=model)) == proof.actual
        exceptions = tuple((e.mode, e.predicted, e.actual) for e in proof.exceptions)
        decided.append(asdict(SweepCase(N, tuple(seeds), proof.verdict, exceptions, corrected)))
    return decided


def sweep_propagation(
    lengths: Iterable[int],
    largest_set: int,
    order: int,
    *,
    model: str = "alpha",
    executor: Executor | None = None,
    file: Path | str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Sweep:
    """Decide the Proposition for all seed sets of up to `largest_set` modes and every N in `lengths`.

    lengths : numbers of bonds N. largest_set : most seeds. order : the last k. model : 'alpha', 'beta' or
        'alpha+beta'. All are dimensionless integers.
    executor : any concurrent.futures.Executor, such as dask.distributed's client.get_executor(); default a
        pool of processes, which a script must start under `if __name__ == "__main__":`.
    file : JSON lines, one for each decided case; an existing file of the same sweep is continued, its last
        line dropped if it was cut.
    progress : called as (cases done, cases in all).

    Every case is decided as by `prove_propagation` (Eqs. app, dk). Raises InputError, also for a file of
    another sweep; SymfpuError if processes of the pool die.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     [(case.seeds, case.verdict) for case in sweep_propagation((4,), 1, 2, executor=pool).cases]
    [((1,), 'proved'), ((2,), 'proved'), ((3,), 'proved')]
    """
    lengths = sorted({integer(N, "N", 2) for N in lengths})
    largest_set, order = integer(largest_set, "largest_set", 1), integer(order, "order", 0)
    if model not in ("alpha", "beta"):
        raise InputError("model", model, "'alpha' or 'beta'", "the rule is stated for these")
    cases = [(N, seeds) for N in lengths for s in range(1, largest_set + 1) for seeds in combinations(range(1, N), s)]
    log = SweepLog(Path(file), model, order) if file is not None else None
    decided = {key: case for key, case in (log.read() if log else {}).items() if key in set(cases)}
    todo = [case for case in cases if case not in decided]
    with ExitStack() as stack:
        pool = executor or stack.enter_context(ProcessPoolExecutor(mp_context=multiprocessing.get_context("spawn")))
        tasks = [pool.submit(decide, batch, model, order) for batch in _batches(todo)]
        try:
            for task in as_completed(tasks):
                for record in task.result():
                    case = _case(record)
                    decided[case.N, case.seeds] = case
                    if log:
                        log.append(record)
                if progress:
                    progress(len(decided), len(cases))
        except BrokenExecutor as error:
            raise SymfpuError(
                "the worker processes died: in a script, call sweep_propagation under `if __name__ == '__main__':`, or pass executor="
            ) from error
        finally:
            for task in tasks:
                task.cancel()
    return Sweep(model, order, tuple(decided[case] for case in cases))


def _batches(cases: Sequence[tuple[int, tuple[int, ...]]]) -> list[list[tuple[int, tuple[int, ...]]]]:
    return [list(cases[i : i + BATCH]) for i in range(0, len(cases), BATCH)]


def _case(record: dict[str, Any]) -> SweepCase:
    exceptions = tuple((int(m), p, a) for m, p, a in record["exceptions"])
    return SweepCase(record["N"], tuple(record["seeds"]), record["verdict"], exceptions, record["corrected_rule_holds"])


class SweepLog:
    """The file of a sweep: a header line, then one line for each decided case."""

    def __init__(self, path: Path, model: str, order: int) -> None:
        self.path = path
        self.header = json.dumps({"format": HEADER, "schema": SCHEMA, "model": model, "order": order})

    def read(self) -> dict[tuple[int, tuple[int, ...]], SweepCase]:
        """The cases decided so far; starts the file if there is none, and cuts off a last line that was not finished."""
        try:
            text = self.path.read_text() if self.path.exists() else ""
            start = self.header + "\n"
            if not text.startswith(start) and not start.startswith(text):
                raise InputError("file", str(self.path), f"a new file, or a sweep with header {self.header}", "name another file")
            complete = text[: text.rfind("\n") + 1] or start
            cases = [_case(json.loads(line)) for line in complete.splitlines()[1:]]
            if complete != text:
                self.path.write_text(complete)
        except OSError as error:
            raise InputError("file", str(self.path), "a file that can be read and written", f"name another ({error.strerror})") from error
        except (ValueError, KeyError, TypeError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError("file", str(self.path), "lines of a sweep", "it is damaged: remove it or name another") from error
        return {(case.N, case.seeds): case for case in cases}

    def append(self, record: dict[str, Any]) -> None:
        """Add one decided case, flushed to the file."""
        with self.path.open("a") as file:
            file.write(json.dumps(record) + "\n")
