"""Sweeps of the propagation rule over all seed sets: how often it holds, and every exception.

Cases run through the standard Executor interface, and each finished case is one line of a file,
from which an interrupted sweep goes on. A case that raises an error loses no other.
"""

from __future__ import annotations

import multiprocessing
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    as_completed,
)
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

from symfpu.chain.potentials.potential import Potential
from symfpu.chain.propagation import coupling_sequence
from symfpu.errors import SymfpuError
from symfpu.files.lines_file import LinesFile
from symfpu.files.progress import Progress
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Columns, Table, joined
from symfpu.frames.tabled import Tabled
from symfpu.numbers.typed import integer
from symfpu.proofs.certificates import law_name, prove_propagation, proved_chain

HEADER, SCHEMA = "symfpu propagation sweep", 1
BATCH = 16  # cases in one task
GUARD = "call sweep_propagation under `if __name__ == '__main__':`, or pass executor="
DEAD_WORKERS = f"the worker processes died: in a script, {GUARD}"

Key = tuple[int, tuple[int, ...]]  # N and the seeds
# records of decided cases, errors of others
Decided = tuple[list[dict[str, Any]], dict[Key, Exception]]


@dataclass(frozen=True)
class SweepCase:
    """One seed set: its verdict, its exceptions, and whether the corrected rule holds.

    An exception is (mode, predicted order, actual order or None).
    """

    N: int
    seeds: tuple[int, ...]
    verdict: str
    exceptions: tuple[tuple[int, int | None, int | None], ...]
    corrected_rule_holds: bool


@dataclass(frozen=True)
class Sweep(Tabled):
    """All cases of a sweep of the Proposition. Made by `sweep_propagation`.

    model, order : of every case, the model of another potential being its text, "toda:0.5".
    cases : sorted by N, number of seeds and seeds; each with its
        verdict, its exceptions (mode, predicted order, actual order or None) and whether the
        corrected rule holds. Dimensionless integers, exact.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import sweep_propagation
    >>> with ThreadPoolExecutor(1) as pool:
    ...     sweep_propagation((4, 5), 1, 2, model="beta", executor=pool)
    Sweep(beta, order 2: 7 seed sets: 7 proved; corrected rule holds in 7)
    >>> case = SweepCase(4, (1, 2), "refuted", ((3, 1, None),), True)
    >>> Sweep("beta", 1, (case,)).to_frame()
       N seeds  verdict  exceptions  corrected_rule_holds
    0  4   1,2  refuted           1                  True
    """

    model: str
    order: int
    cases: tuple[SweepCase, ...] = field(repr=False)

    def __repr__(self) -> str:
        count = Counter(case.verdict for case in self.cases)
        verdicts = ", ".join(f"{n} {verdict}" for verdict, n in sorted(count.items()))
        holds = sum(case.corrected_rule_holds for case in self.cases)
        what = f"{self.model}, order {self.order}: {len(self.cases)} seed sets"
        return f"Sweep({what}: {verdicts}; corrected rule holds in {holds})"

    @property
    def exceptions(self) -> tuple[SweepCase, ...]:
        """The cases in which the proposition fails."""
        return tuple(case for case in self.cases if case.verdict == "refuted")

    def _table(self) -> Table:
        """One row for each seed set."""
        cases = self.cases
        columns: Columns = {
            "N": [case.N for case in cases],
            "seeds": [joined(case.seeds) for case in cases],
            "verdict": [case.verdict for case in cases],
            "exceptions": [len(case.exceptions) for case in cases],
            "corrected_rule_holds": [case.corrected_rule_holds for case in cases],
        }
        return Table(columns, attributes(self, model=self.model, order=self.order))


class SweepIncomplete(SymfpuError):
    """Some cases of a sweep raised errors: raised by `sweep_propagation` at its end.

    All other cases are then decided.

    sweep : of all other cases. failures : the errors by (N, seeds). Ours.
    """

    def __init__(self, sweep: Sweep, failures: Mapping[Key, Exception]) -> None:
        self.sweep = sweep
        self.failures = dict(failures)
        (N, seeds), error = next(iter(self.failures.items()))
        dead = isinstance(error, BrokenExecutor)
        reason = DEAD_WORKERS if dead else f"{type(error).__name__}: {error}"
        first = f"the first N = {N}, seeds {seeds} ({reason})"
        undecided = f"{len(self.failures)} seed sets were not decided, {first}"
        others = f"the {len(sweep.cases)} others are in the attribute sweep"
        advice = "and in the file if there is one: call again to go on from it"
        super().__init__(f"{undecided}; {others}, {advice}")


def decide(cases: Sequence[Key], potential: str, order: int) -> Decided:
    """Decide some seed sets on one core.

    Plain data and errors out, so that any executor can carry it.
    """
    records, failures = [], {}
    for N, seeds in cases:
        try:
            records.append(asdict(_decided(N, seeds, potential, order)))
        # whatever it is, it is reported at the end and costs no other case
        except Exception as error:
            failures[N, seeds] = error
    return records, failures


def _decided(N: int, seeds: tuple[int, ...], potential: str, order: int) -> SweepCase:
    proof = prove_propagation(N, seeds, order, potential=potential, workers=1)
    sets = coupling_sequence(N, seeds, order, potential=potential)
    corrected = tuple(sets) == proof.actual
    exceptions = tuple((e.mode, e.predicted, e.actual) for e in proof.exceptions)
    return SweepCase(N, tuple(seeds), proof.verdict, exceptions, corrected)


def sweep_propagation(
    lengths: Iterable[int],
    largest_set: int,
    order: int,
    *,
    model: str | None = None,
    potential: Potential | str | None = None,
    executor: Executor | None = None,
    file: Path | str | None = None,
    progress: Progress | None = None,
) -> Sweep:
    """Decide the Proposition for all seed sets of up to `largest_set` modes, all N in `lengths`.

    lengths : numbers of bonds N. largest_set : most seeds. order : the last k. model : 'alpha'
        (default) or 'beta'. potential : in its place, that of any chain with exact coefficients.
        All are dimensionless integers.
    executor : any concurrent.futures.Executor, such as dask.distributed's client.get_executor();
        default a pool of processes, which a script must start under `if __name__ == "__main__":`.
    file : JSON lines, one for each decided case; an existing file of the same sweep is continued,
        its last line dropped if it was cut.
    progress : called as (label, fraction done).

    Every case is decided as by `prove_propagation` (Eqs. app, dk). Raises InputError, also for a
    file of another sweep; SweepIncomplete, after all other cases, if one raised an error or its
    process died.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     sweep = sweep_propagation((4,), 1, 2, executor=pool)
    >>> [(case.seeds, case.verdict) for case in sweep.cases]
    [((1,), 'proved'), ((2,), 'proved'), ((3,), 'proved')]
    """
    lengths = sorted({integer(N, "N", 2) for N in lengths})
    largest_set, order = integer(largest_set, "largest_set", 1), integer(order, "order", 0)
    chain = proved_chain(2, model, potential)
    law, name = chain.potential.text, law_name(chain)
    cases = [
        (N, seeds)
        for N in lengths
        for s in range(1, largest_set + 1)
        for seeds in combinations(range(1, N), s)
    ]
    log = _log(file, name, order)
    asked = set(cases)
    known = {(case.N, case.seeds): case for case in log.read()}
    decided = {key: case for key, case in known.items() if key in asked}
    todo = [case for case in cases if case not in decided]
    failures: dict[Key, Exception] = {}
    with ExitStack() as stack:
        pool = executor or stack.enter_context(
            ProcessPoolExecutor(mp_context=multiprocessing.get_context("spawn"))
        )
        for records, failed in _results(pool, _batches(todo), law, order):
            failures |= failed
            for record in records:
                case = _case(record)
                decided[case.N, case.seeds] = case
            log.append(records)
            if progress:
                progress("seed sets", len(decided) / len(cases))
    sweep = Sweep(name, order, tuple(decided[case] for case in cases if case in decided))
    if failures:
        ordered = {case: failures[case] for case in cases if case in failures}
        raise SweepIncomplete(sweep, ordered) from next(iter(ordered.values()))
    return sweep


def _results(
    pool: Executor, batches: Sequence[Sequence[Key]], potential: str, order: int
) -> Iterator[Decided]:
    """What became of every batch, as it ends; the others are cancelled if the caller stops."""
    batch_of: dict[Future[Decided], Sequence[Key]] = {}
    try:
        for batch in batches:
            batch_of[_submitted(pool, batch, potential, order)] = batch
        for task in as_completed(batch_of):
            error = task.exception()
            if error is None:
                yield task.result()
            # the worker died, or what it decided could not be carried
            elif isinstance(error, Exception):
                yield [], dict.fromkeys(batch_of[task], error)
            else:
                raise error
    finally:
        for task in batch_of:
            task.cancel()


def _submitted(
    pool: Executor, batch: Sequence[Key], potential: str, order: int
) -> Future[Decided]:
    """The task of a batch, submitted.

    One that has failed already in a pool whose workers died while it was filled.
    """
    try:
        return pool.submit(decide, batch, potential, order)
    except BrokenExecutor as error:
        failed: Future[Decided] = Future()
        failed.set_exception(error)
        return failed


def _batches(cases: Sequence[Key]) -> list[list[Key]]:
    return [list(cases[i : i + BATCH]) for i in range(0, len(cases), BATCH)]


def _case(record: dict[str, Any]) -> SweepCase:
    exceptions = tuple((int(m), p, a) for m, p, a in record["exceptions"])
    return SweepCase(
        record["N"],
        tuple(record["seeds"]),
        record["verdict"],
        exceptions,
        record["corrected_rule_holds"],
    )


def _log(path: Path | str | None, model: str, order: int) -> LinesFile[SweepCase]:
    header = {"format": HEADER, "schema": SCHEMA, "model": model, "order": order}
    return LinesFile(path, header, _case, "a sweep")
