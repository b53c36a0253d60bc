"""Sweeps of the propagation rule over all seed sets: how often it holds, and every exception.

One use of `symfpu.sweeps`: each seed set is a case, and each case a row of a file, from which an
interrupted sweep goes on. A case that raises an error loses no other.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

from symfpu.chain.potentials.potential import Potential
from symfpu.chain.propagation import coupling_sequence
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, length_of, order_of
from symfpu.proofs.certificates import (
    SINGLE,
    RuleException,
    law_name,
    prove_propagation,
    proved_chain,
)
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.result import Tabled, columns_field
from symfpu.results.table import Columns, Table, joined
from symfpu.results.text_tables import markdown_table
from symfpu.sweeps.rows import SweepFailure, SweepRow
from symfpu.sweeps.sweep import SweepStopped, sweep

VERDICTS = ("proved", "refuted", "undecided")
MOST_CASES = 10**7  # of one sweep, which has all of them in memory

Key = tuple[int, tuple[int, ...]]  # N and the seeds


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

    def entry(self) -> dict[str, Any]:
        """For a record; its exceptions as those of a proof."""
        exceptions = [RuleException(*entry).record() for entry in self.exceptions]
        return {
            "N": self.N,
            "seeds": list(self.seeds),
            "verdict": self.verdict,
            "exceptions": exceptions,
            "corrected_rule_holds": self.corrected_rule_holds,
        }


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

    def _fields(self) -> Iterator[Field]:
        """How many seed sets, those in which the Proposition fails, and all by column."""
        law = "model" if self.model in SINGLE else "potential"
        yield Field(law, self.model, "chain")
        yield Field("order", self.order, "order")
        yield Field("cases", len(self.cases), "seed sets")
        failing = [case.entry() for case in self.exceptions]
        yield Field("exceptions", failing, "exceptions", str(len(failing)))
        yield columns_field(self._table())

    def __repr__(self) -> str:
        count = Counter(case.verdict for case in self.cases)
        verdicts = ", ".join(f"{n} {verdict}" for verdict, n in sorted(count.items()))
        holds = sum(case.corrected_rule_holds for case in self.cases)
        what = f"{self.model}, order {self.order}: {counted(len(self.cases), 'seed set')}"
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

    sweep : of all other cases. failures : what went wrong by (N, seeds): kind of error, message,
    numbers. Ours.
    """

    def __init__(self, sweep: Sweep, failures: Mapping[Key, SweepFailure]) -> None:
        self.sweep = sweep
        self.failures = dict(failures)
        (N, seeds), failure = next(iter(self.failures.items()))
        first = f"the first N = {N}, seeds {seeds} ({failure})"
        undecided = f"{len(self.failures)} seed sets were not decided, {first}"
        others = f"the {len(sweep.cases)} others are in the attribute sweep"
        advice = "and in the file if there is one: call again to go on from it"
        super().__init__(f"{undecided}; {others}, {advice}")


def decide(N: int, seeds: tuple[int, ...], *, potential: str, order: int) -> dict[str, Any]:
    """One seed set on one core, as plain data."""
    proof = prove_propagation(N, seeds, order, potential=potential, workers=1)
    sets = coupling_sequence(N, seeds, order, potential=potential)
    corrected = tuple(sets) == proof.actual
    exceptions = tuple((e.mode, e.predicted, e.actual) for e in proof.exceptions)
    return asdict(SweepCase(N, tuple(seeds), proof.verdict, exceptions, corrected))


@public
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
    executor, file : as of `sweep`; failures in the file are decided again.
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
    lengths = sorted({length_of(N) for N in lengths})
    largest_set, order = integer(largest_set, "largest_set", 1), order_of(order)
    chain = proved_chain(2, model, potential)
    law, name = chain.potential.text, law_name(chain)
    _check_count(lengths, largest_set)
    cases: list[dict[str, Any]] = [
        {"N": N, "seeds": seeds}
        for N in lengths
        for s in range(1, min(largest_set, N - 1) + 1)
        for seeds in combinations(range(1, N), s)
    ]
    shared = {"potential": law, "order": order}
    options: dict[str, Any] = {"executor": executor, "file": file, "progress": progress}
    rows, reason = _rows(cases, shared, options)
    decided, failures = [], {}
    for case in cases:
        key = (case["N"], case["seeds"])
        row = rows.get(key)
        if row is not None and row.failure is None:
            decided.append(_case(row.result))
        else:
            failures[key] = reason if row is None or row.failure is None else row.failure
    result = Sweep(name, order, tuple(decided))
    if failures:
        raise SweepIncomplete(result, failures)
    return result


def _check_count(lengths: Sequence[int], largest_set: int) -> None:
    """InputError for more seed sets than fit into memory, by their number alone."""
    counts: dict[int, int] = {}
    total = 0
    for N in lengths:
        total += sum(math.comb(N - 1, s) for s in range(1, min(largest_set, N - 1) + 1))
        counts[N] = total
        if total > MOST_CASES:
            fitting = [N for N, count in counts.items() if count <= MOST_CASES]
            advice = (
                f"take lengths up to {max(fitting)}" if fitting else "take smaller sets"
            )
            allowed = f"lengths and sets of at most {MOST_CASES:,} cases"
            raise InputError("lengths", f"{N} and shorter", allowed, advice)


def _rows(
    cases: Sequence[Mapping[str, Any]], shared: Mapping[str, Any], options: dict[str, Any]
) -> tuple[dict[Key, SweepRow], SweepFailure]:
    """The rows by N and seeds, and why others are missing if the executor broke down."""
    reason = SweepFailure(SweepStopped.__name__, "the executor broke down")
    try:
        found = sweep(decide, cases, fixed=shared, retry=True, **options)
    except SweepStopped as stopped:
        found = stopped.rows
        reason = SweepFailure(SweepStopped.__name__, str(stopped))
    rows = {(row.case["N"], tuple(row.case["seeds"])): row for row in found.rows}
    return rows, reason


def _case(record: Mapping[str, Any]) -> SweepCase:
    exceptions = tuple((int(m), p, a) for m, p, a in record["exceptions"])
    return SweepCase(
        record["N"],
        tuple(record["seeds"]),
        record["verdict"],
        exceptions,
        record["corrected_rule_holds"],
    )


def sweep_markdown(sweep: Sweep) -> str:
    """A sweep of the propagation rule.

    How often it holds by N and number of seeds, and every exception.
    """
    proved = sum(case.verdict == "proved" for case in sweep.cases)
    holds = sum(case.corrected_rule_holds for case in sweep.cases)
    counts = f"{counted(len(sweep.cases), 'seed set')}. The proposition holds in {proved}; "
    counts += f"the corrected rule predicts the actual sets in {holds}."
    parts = [f"## {sweep.model} model, order {sweep.order}", counts]
    parts.append(markdown_table(["N", "seeds", "sets", *VERDICTS], _count_rows(sweep)))
    exceptions = [_exception_row(case) for case in sweep.exceptions]
    if exceptions:
        parts.append("Exceptions (mode: predicted order -> actual order):")
        parts.append(markdown_table(["N", "seeds", "exceptions"], exceptions))
    return "\n\n".join(parts) + "\n"


def _count_rows(sweep: Sweep) -> list[list[str]]:
    """Verdicts by N and number of seeds."""
    groups: dict[tuple[int, int], list[str]] = {}
    for case in sweep.cases:
        size = (case.N, len(case.seeds))
        groups.setdefault(size, []).append(case.verdict)
    rows = []
    for (N, s), verdicts in groups.items():
        counts = [verdicts.count(verdict) for verdict in VERDICTS]
        row = [N, s, len(verdicts), *counts]
        rows.append([str(number) for number in row])
    return rows


def _exception_row(case: SweepCase) -> list[str]:
    seeds = ", ".join(map(str, case.seeds))
    moved = [
        f"{q}: {predicted} -> {'later' if actual is None else actual}"
        for q, predicted, actual in case.exceptions
    ]
    return [str(case.N), seeds, "; ".join(moved)]
