"""A function over many cases: every case a row, kept as it comes, gone on with after any death."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Future
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import psutil

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer
from symfpu.sweeps.rows import Json, SweepFailure, SweepRow, SweepRows
from symfpu.sweeps.rows_file import RowsFile, head_of, in_order, key_of, read_rows
from symfpu.sweeps.running import Call, finished
from symfpu.sweeps.values import argument_value, error_value, result_value
from symfpu.sweeps.workers import executor_of

Case = Mapping[str, Any]
Memory = Callable[..., float]


class SweepStopped(SymfpuError):
    """An executor broke down before all cases were done. Raised by `sweep`.

    rows : of the cases that are done. missing : how many are not. reason : of the executor. Ours.
    """

    def __init__(self, rows: SweepRows, missing: int, reason: str) -> None:
        self.rows = rows
        self.missing = missing
        self.reason = reason
        state = f"{missing} cases have no row, {len(rows.rows)} have one"
        advice = (
            "call again to go on from a file; without executor= dead workers are replaced"
        )
        super().__init__(f"the executor broke down ({reason}); {state}: {advice}")


class CaseTooLarge(SymfpuError):
    """A case that needs more memory than there is: it is not started.

    Raised in `sweep`: the failure of a row. needed, free : bytes. Ours.
    """

    def __init__(self, needed: int, free: int) -> None:
        self.needed = needed
        self.free = free
        size = f"the case needs {needed:,} bytes, {free:,} are free"
        super().__init__(f"{size}; compute it where there are more, or pass within=")


@public
def sweep(
    function: Callable[..., Any],
    cases: Iterable[Case],
    *,
    fixed: Case | None = None,
    executor: Any = None,
    file: Path | str | None = None,
    memory: Memory | None = None,
    within: int | None = None,
    retry: bool = False,
    progress: Progress | None = None,
) -> SweepRows:
    """A row for each case: the result of function(**case, **fixed) as a record, or its failure.

    function : any function of a module, public or yours. Its results are kept as their records;
        numbers, text, lists and mappings as they are.
    cases : mappings from arguments to chains, text, numbers, and tuples of these; all different.
        A chain may be a mapping of its arguments, {"N": 8, "beta": "0.1"}: then an impossible one
        is a row too. fixed : arguments of all cases, kept in the head of the file.
    executor : any concurrent.futures.Executor or client of dask.distributed; default processes,
        one a core, of which those that die are replaced. A script must start them under
        `if __name__ == "__main__":`.
    file : JSON lines, a head and the rows as they come. A file of the same sweep is continued: its
        rows are not computed again, its last line is dropped if it was cut.
    memory : the bytes that a case needs, as a function of those of its arguments that it names
        (`series_bytes`); as many cases run at once as need `within` bytes, default what is free.
    retry : whether cases that failed in the file are computed again.
    progress : called as (label, fraction done).

    An error of a case, the death of its process (WorkerDied) and a case too large for the memory
    (CaseTooLarge) are failures in its row, and all others go on. Raises InputError for other
    arguments and for a file of another sweep, FileFull where a row finds no room, SweepStopped if
    the executor breaks down. All is dimensionless but for bytes. Ours.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import frequency_rank
    >>> with ThreadPoolExecutor(1) as pool:
    ...     swept = sweep(frequency_rank, [{"N": N} for N in (1, 8, 9)], executor=pool)
    >>> swept
    SweepRows(symfpu.chain.commensurability.frequency_rank: 3 cases, 1 failed: 1 InputError)
    >>> [row.result for row in swept.rows]
    [None, 7, 6]
    """
    shared = dict(fixed or {})
    head = head_of(_name(function), _values(shared))
    if executor is None:
        _require_file(function)
    calls = _calls(function, cases, shared)
    limit = _limit(memory, within)
    told = progress or unheard
    with RowsFile(file, head, retry=retry) as kept:
        todo = [call for key, call in calls.items() if key not in kept.rows]
        computed = Computed(function, executor, memory, limit)
        done = len(calls) - len(todo)
        with closing(computed.rows(todo)) as coming:
            for row in coming:
                kept.append(row)
                done += 1
                told("cases", done / len(calls))
        rows = SweepRows(head["function"], head["fixed"], in_order(kept.rows, calls))
    if computed.broken is not None:
        missing = len(calls) - done
        raise SweepStopped(rows, missing, str(computed.broken)) from computed.broken
    return rows


@public
def read_sweep(file: Path | str) -> SweepRows:
    """The rows in the file of a sweep, in the order in which they came.

    file : as `sweep` wrote it; a last line that was cut is left out. Also while the sweep goes on.
    Raises InputError for another file. All is dimensionless. Ours.

    >>> import tempfile
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import frequency_rank
    >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as pool:
    ...     file = f"{folder}/rank.jsonl"
    ...     swept = sweep(frequency_rank, [{"N": 8}], executor=pool, file=file)
    ...     read_sweep(file) == swept
    True
    """
    head, rows = read_rows(Path(file))
    return SweepRows(head["function"], head["fixed"], tuple(rows))


class Computed:
    """The rows of calls as they end. broken : the error of an executor that broke down, or None."""

    def __init__(
        self,
        function: Callable[..., Any],
        executor: Any,
        memory: Memory | None,
        limit: int,
    ) -> None:
        self.function = function
        self.executor = executor
        self.memory = memory
        self.limit = limit
        self.broken: BaseException | None = None

    def rows(self, calls: Sequence[Call]) -> Generator[SweepRow, None, None]:
        """First those that are not started, as their memory is too large or not known."""
        due = []
        for call in calls:
            try:
                due.append(self._sized(call))
            except Exception as error:
                yield _failed(call, error)
        if not due:
            return
        with executor_of(self.executor, len(due)) as pool:
            task = partial(answer, self.function)
            for call, future in finished(pool, task, due, self.limit):
                row = self._row(call, future)
                if row is not None:
                    yield row

    def _sized(self, call: Call) -> Call:
        """The call with the bytes that it needs; CaseTooLarge if they are not to be had."""
        if self.memory is None:
            return call
        named = inspect.signature(self.memory).parameters
        known = built(call.arguments)
        needed = int(self.memory(**{name: known[name] for name in named if name in known}))
        if needed > self.limit:
            raise CaseTooLarge(needed, self.limit)
        return call._replace(needed=needed)

    def _row(self, call: Call, future: Future[Any]) -> SweepRow | None:
        """The row of a call that has ended; None where its executor did not compute it."""
        if future.cancelled():
            self.broken = self.broken or RuntimeError("cases were cancelled")
            return None
        error = future.exception()
        if isinstance(error, BrokenExecutor):
            self.broken = self.broken or error
            return None
        if isinstance(error, Exception):
            return _failed(call, error)
        if error is not None:
            raise error
        found = future.result()
        if "failure" in found:
            return SweepRow(call.case, None, SweepFailure(**found["failure"]))
        return SweepRow(call.case, found["result"])


def answer(function: Callable[..., Any], arguments: Json) -> Json:
    """What the row of a case says, computed where the case is: small, whatever the result is."""
    try:
        return {"result": result_value(function(**built(arguments)))}
    # whatever it is, it is in the row and costs no other case
    except Exception as error:
        return {"failure": error_value(error)}


def built(arguments: Json) -> Json:
    """Arguments with the chain made of those of its own."""
    chain = arguments.get("chain")
    return (
        arguments | {"chain": Chain(**chain)} if isinstance(chain, Mapping) else arguments
    )


def _failed(call: Call, error: Exception) -> SweepRow:
    return SweepRow(call.case, None, SweepFailure(**error_value(error)))


def _limit(memory: Memory | None, within: int | None) -> int:
    """The bytes that cases at work may need together."""
    if within is None:
        return int(psutil.virtual_memory().available)
    if memory is None:
        advice = "pass memory= too, or leave within= out"
        raise InputError("within", within, "bytes for what memory= tells", advice)
    return integer(within, "within", 1)


def _name(function: Callable[..., Any]) -> str:
    """The name of a function by which another process finds it."""
    module = getattr(function, "__module__", None)
    name = getattr(function, "__qualname__", None)
    place: Any = sys.modules.get(str(module))
    for part in str(name).split("."):
        place = getattr(place, part, None)
    if place is not function:
        allowed = "a function of a module, under its own name"
        advice = "write it at the top of a file; arguments that stay go into fixed="
        raise InputError("function", function, allowed, advice)
    return f"{module}.{name}"


def _require_file(function: Callable[..., Any]) -> None:
    """InputError for a function typed at a prompt or in a notebook: new processes lack it."""
    typed = not hasattr(sys.modules["__main__"], "__file__")
    if typed and function.__module__ == "__main__":
        allowed = "a function in a file, from which worker processes import it"
        advice = "write it to a file and import it, or pass executor="
        raise InputError("function", function.__qualname__, allowed, advice)


def _values(arguments: Case) -> Json:
    return {
        str(name): argument_value(value, str(name)) for name, value in arguments.items()
    }


def _calls(
    function: Callable[..., Any], cases: Iterable[Case], shared: Json
) -> dict[str, Call]:
    """The calls by the keys of their cases; InputError for what is no case, or there twice."""
    calls: dict[str, Call] = {}
    signature = _signature(function)
    for given in cases:
        if not isinstance(given, Mapping):
            allowed = "mappings from arguments to their values"
            raise InputError("cases", given, allowed, "pass dictionaries")
        case = _values(given)
        key = key_of(case)
        if key in calls:
            raise InputError("cases", case, "cases that all differ", "leave the second out")
        arguments = shared | dict(given)
        _require_bound(signature, arguments, shared.keys() & given.keys())
        calls[key] = Call(case, arguments)
    if not calls:
        raise InputError("cases", [], "at least one case", "pass some")
    return calls


def _signature(function: Callable[..., Any]) -> inspect.Signature | None:
    """None for a compiled function that does not tell."""
    try:
        return inspect.signature(function)
    except ValueError:
        return None


def _require_bound(
    signature: inspect.Signature | None, arguments: Json, twice: Iterable[str]
) -> None:
    """InputError where a function does not take arguments of these names."""
    for name in twice:
        raise InputError(name, arguments[name], "in cases or in fixed", "name it once")
    if signature is None:
        return
    try:
        signature.bind(**arguments)
    except TypeError as error:
        allowed = f"arguments of the function, {signature}"
        raise InputError("cases", sorted(arguments), allowed, str(error)) from error
