"""Worker processes that may die: a death costs the task that it worked on, and no other.

Each worker has a pipe of its own. Pools whose workers share one queue lose more: a worker that is
killed while it holds the lock of the queue stops all of them.
"""

from __future__ import annotations

import os
import pickle
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

from symfpu.algebra.dense import available_cores
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress, unheard

STARTS = 20  # times that a process may be killed before it is ready, or has begun a task
READY, BEGUN = b"ready", b"begun"  # what a worker says before its answers
TOLD = (
    "told"  # in place of whether a call succeeded: its progress, and the answer is to come
)
# each worker is one of as many as there are cores: its libraries shall not start more threads
THREADS = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
ENVIRONMENT = threading.Lock()


class WorkerDied(SymfpuError):
    """The process that worked on a task ended: it was killed, or out of memory.

    Raised in `sweep`: the failure of a row. exit_code : of the process, -n if signal n ended it.
    Ours.
    """

    def __init__(self, exit_code: int | None) -> None:
        self.exit_code = exit_code
        how = f"with exit code {exit_code}"
        if exit_code is not None and exit_code < 0:
            how = f"by signal {-exit_code}"
        advice = "if it was out of memory, pass memory= so that fewer cases run at once"
        super().__init__(f"the worker process was ended {how}; {advice}")


class WorkersDoNotStart(SymfpuError, BrokenExecutor):
    """Worker processes die before they are ready.

    Raised in `sweep`, the cause of SweepStopped, and in `prove_for_all_N`. reason : how they end.
    Ours.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        advice = "in a script, start them under `if __name__ == '__main__':`"
        super().__init__(f"worker processes do not start ({reason}); {advice}")


class Task(NamedTuple):
    """What a worker is sent, and where its answer and its progress go."""

    future: Future[Any]
    call: bytes
    hear: Progress


class ProcessWorkers(Executor):
    """An executor of processes, of which those that die are replaced.

    workers : how many. A task whose process dies raises WorkerDied, a process
    that does not start WorkersDoNotStart. Libraries in them run on one thread, unless the
    environment says otherwise. Ends with its `with`: what runs is waited for, or ended where
    futures are cancelled.
    """

    def __init__(self, workers: int) -> None:
        self._tasks: SimpleQueue[Task | None] = SimpleQueue()
        self._workers = [Worker() for _ in range(workers)]
        serving = [
            threading.Thread(target=self._serve, args=(worker,), daemon=True)
            for worker in self._workers
        ]
        self._threads = serving
        for thread in serving:
            thread.start()

    def submit(
        self, function: Callable[..., Any], /, *args: Any, **named: Any
    ) -> Future[Any]:
        """The future of function(*args, **named), all of which pickle by reference."""
        return self._put(unheard, (function, args, named, False))

    def submit_heard(
        self, hear: Progress, function: Callable[..., Any], /, *args: Any, **named: Any
    ) -> Future[Any]:
        """The same of a function that has an argument `progress`: `hear` is told what it tells.

        In a thread of this process, before the future ends.
        """
        return self._put(hear, (function, args, named, True))

    def _put(self, hear: Progress, call: tuple[Any, ...]) -> Future[Any]:
        future: Future[Any] = Future()
        self._tasks.put(Task(future, pickle.dumps(call), hear))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """No more tasks; those at work are ended too where futures are cancelled."""
        if cancel_futures:
            self._cancel_waiting()
        for worker in self._workers:
            self._tasks.put(None)
            if cancel_futures:
                worker.kill()
        for thread in self._threads if wait else ():
            thread.join()

    def _cancel_waiting(self) -> None:
        while True:
            try:
                task = self._tasks.get_nowait()
            except Empty:
                return
            if task:
                task.future.cancel()

    def _serve(self, worker: Worker) -> None:
        """The thread of one worker: a task after the other, until there is none."""
        while task := self._tasks.get():
            if task.future.set_running_or_notify_cancel():
                try:
                    done, value = worker.answer(task.call, task.hear)
                except Exception as error:
                    done, value = False, error
                if done:
                    task.future.set_result(value)
                else:
                    task.future.set_exception(value)
        worker.close()


@contextmanager
def worker_processes(tasks: int) -> Iterator[ProcessWorkers]:
    """A process for each task, but no more than cores; all end at once where an error is raised."""
    pool = ProcessWorkers(min(tasks, available_cores()))
    try:
        yield pool
    except BaseException:
        pool.shutdown(cancel_futures=True)
        raise
    pool.shutdown()


@contextmanager
def executor_of(given: Any, tasks: int) -> Iterator[Executor]:
    """The executor given, that of a dask client, or processes of our own; InputError for others."""
    if given is None:
        with worker_processes(tasks) as pool:
            yield pool
        return
    executor = given.get_executor() if hasattr(given, "get_executor") else given
    if not isinstance(executor, Executor):
        allowed = "a concurrent.futures.Executor or a client of dask"
        raise InputError(
            "executor", given, allowed, "leave it out for processes of this machine"
        )
    yield executor


class Worker:
    """A process and its pipe, started when it is first asked, and again after it died."""

    def __init__(self) -> None:
        self._context = get_context("spawn")
        self._process: Any = None
        self._pipe: Connection | None = None
        self._killed = False

    def answer(self, call: bytes, hear: Progress) -> tuple[bool, Any]:
        """Whether a call succeeded, and its result or error. hear : its progress until then."""
        pipe = self._begun(call)
        said, value = self._said(pipe)
        while said == TOLD:
            hear(*value)
            said, value = self._said(pipe)
        return said, value

    def _said(self, pipe: Connection) -> tuple[Any, Any]:
        """What a process at work says next; WorkerDied where it is dead."""
        try:
            said: tuple[Any, Any] = pickle.loads(pipe.recv_bytes())  # noqa: S301 (from our own process)
        except (EOFError, OSError):
            raise WorkerDied(self._ended()) from None
        return said

    def _begun(self, call: bytes) -> Connection:
        """The pipe of a process that has begun a call.

        One that died before, while it had nothing to do, is replaced, and no task is lost.
        """
        for _ in range(STARTS):
            pipe = self._started()
            if _sent(pipe, call) and _says(pipe, BEGUN):
                return pipe
            code = self._ended()
        raise WorkerDied(code)

    def _started(self) -> Connection:
        if self._pipe is not None and self._process.is_alive():
            return self._pipe
        for _ in range(STARTS):
            if self._killed:
                raise WorkersDoNotStart("the pool is closed")
            pipe = self._start()
            if _says(pipe, READY):
                return pipe
            code = self._ended()
            if code is None or code >= 0:  # of its own: another would end as well
                break
        raise WorkersDoNotStart(f"exit code {code}")

    def _start(self) -> Connection:
        ours, theirs = self._context.Pipe()
        self._process = self._context.Process(target=serve, args=(theirs,))
        try:
            with _one_thread_each():
                self._process.start()
        # a worker whose script starts a sweep of its own, or a system that has no more processes
        except (RuntimeError, OSError) as error:
            self._process = None
            raise WorkersDoNotStart(type(error).__name__) from error
        theirs.close()  # so that the end of the process is the end of the pipe
        self._pipe = ours
        if self._killed:
            self._process.kill()
        return ours

    def _ended(self) -> int | None:
        """The exit code of a process whose pipe has ended."""
        if self._pipe is not None:
            self._pipe.close()
            self._pipe = None
        self._process.join()
        code: int | None = self._process.exitcode
        return code

    def close(self) -> None:
        """End the process, which has nothing to do: it ends with its pipe."""
        if self._pipe is not None:
            self._ended()

    def kill(self) -> None:
        """End the process, at work or not, and start no other."""
        self._killed = True
        if self._process is not None and self._process.is_alive():
            self._process.kill()


def _sent(pipe: Connection, call: bytes) -> bool:
    try:
        pipe.send_bytes(call)
    except OSError:
        return False
    return True


def _says(pipe: Connection, word: bytes) -> bool:
    """Whether this is the next word of a process that lives."""
    try:
        return pipe.recv_bytes() == word
    except (EOFError, OSError):
        return False


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """The environment in which a worker starts: what the user has set stays."""
    with ENVIRONMENT:
        ours = [name for name in THREADS if name not in os.environ]
        os.environ.update({name: THREADS[name] for name in ours})
        try:
            yield
        finally:
            for name in ours:
                del os.environ[name]


def serve(pipe: Connection) -> None:
    """In a worker: answer calls until the pipe ends. The interrupt key is its parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    pipe.send_bytes(READY)
    while True:
        try:
            call = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        pipe.send_bytes(BEGUN)
        pipe.send_bytes(_answer(call, Teller(pipe)))


def _end_with_parent() -> None:
    """A worker whose parent was killed works for nobody."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


class Teller:
    """In a worker: the progress of a call, sent to who waits for its answer."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe = pipe
        self._lock = threading.Lock()

    def __call__(self, label: str, fraction: float) -> None:
        said = pickle.dumps((TOLD, (label, float(fraction))))
        with self._lock:
            self._pipe.send_bytes(said)


def _answer(call: bytes, tell: Progress) -> bytes:
    try:
        function, args, named, told = pickle.loads(call)  # noqa: S301 (from our own process)
        if told:
            named = named | {"progress": tell}
        answer = True, function(*args, **named)
    except Exception as error:
        answer = False, error
    try:
        return pickle.dumps(answer)
    except Exception as error:
        what = type(answer[1]).__name__
        refused = InputError("result", what, "what pickles", f"return less ({error})")
        return pickle.dumps((False, refused))
