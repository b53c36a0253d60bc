"""A process that computes for one page, and what asks it: nothing here waits on the other side.

Messages to it are (kind, ticket, arguments), from it (kind, ticket, part); a part that is None says
that the wish was taken, DONE that it is over.
"""

from __future__ import annotations

import gc
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from threading import Lock, Thread
from typing import Any

from symfpu.workbench.choice import Choice
from symfpu.workbench.formulas import formula
from symfpu.workbench.newest import Newest, Wishes
from symfpu.workbench.parts import Bench, Problem

TORUS, TERM, FILE = "torus", "term", "file"
KINDS = (TORUS, TERM, FILE)
TAKEN, DONE = None, "done"
AGAIN = "another one takes its place at the next choice"
LEAST_PAUSE = 0.1  # seconds between two words of progress

Message = tuple[str, int, Any]


class Told:
    """What is being done, for a page: a label and the fraction that is done."""

    def __init__(self, label: str, fraction: float) -> None:
        self.label, self.fraction = label, fraction


class Died:
    """The process has died, for a page; ending : how, in words."""

    def __init__(self, ending: str) -> None:
        self.message = f"the computing process has died ({ending}); {AGAIN}"


def work(connection: Connection) -> None:
    """What the process does until the other side is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends it
    bench, wishes = Bench(), Wishes()
    for _ in bench.parts(Choice()):
        pass  # loads what was compiled and the pictures' fonts, before anybody waits for them
    gc.freeze()  # what is there now stays: a collection need not walk through it
    try:
        while True:
            bench.prepare()
            _receive(connection, wishes, wait=True)
            for kind, (ticket, arguments) in wishes.taken():
                connection.send((kind, ticket, TAKEN))
                for part in _answers(bench, kind, arguments, _teller(connection, ticket)):
                    connection.send((kind, ticket, part))
                    _receive(connection, wishes)
                    if kind in wishes:
                        break  # a newer one is there
                connection.send((kind, ticket, DONE))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return


def _receive(connection: Connection, wishes: Wishes, *, wait: bool = False) -> None:
    """Takes what has come; with `wait`, at least one wish."""
    while wait or connection.poll():
        kind, ticket, arguments = connection.recv()
        wishes.add(kind, (ticket, arguments))
        wait = False


def _teller(connection: Connection, ticket: int) -> Callable[[str, float], None]:
    last = time.monotonic()

    def tell(label: str, fraction: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= LEAST_PAUSE:
            connection.send((TORUS, ticket, Told(label, fraction)))
            last = now

    return tell


def _answers(bench: Bench, kind: str, arguments: Any, tell: Any) -> Iterator[Any]:
    """What is sent back; what no error of ours explains is said too, and ends nothing."""
    try:
        if kind == TORUS:
            (choice,) = arguments
            yield from bench.parts(choice, tell)
        elif kind == TERM:
            yield formula(*arguments)
        else:
            yield bench.file(*arguments)
    except Exception as error:  # a page must not go silent: the message names the class
        yield Problem(f"{type(error).__name__}: {error}")


class Process:
    """A process of `work` and the connection to it."""

    def __init__(self) -> None:
        context = get_context("spawn")
        self.connection, other = context.Pipe()
        self._process = context.Process(target=work, args=(other,), daemon=True)
        self._process.start()
        other.close()

    @property
    def alive(self) -> bool:
        return self._process.is_alive()

    @property
    def ending(self) -> str:
        """How a process ended that has, in words."""
        self._process.join()
        code = self._process.exitcode or 0
        return f"killed by signal {-code}" if code < 0 else f"exit code {code}"

    def kill(self) -> None:
        """Ends it at once, whatever it does; who listens to it finds the connection at its end."""
        self._process.kill()
        self._process.join()

    def end(self) -> None:
        """The same for one that nobody listens to."""
        self.kill()
        self.connection.close()


class Spares:
    """Keeps one process ready, so that a page and a cancelled computation need not wait for it."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._spare: Process | None = Process()

    def take(self) -> Process:
        """A process; the next one is started."""
        with self._lock:
            taken, self._spare = self._spare, Process()
        if taken is not None and taken.alive:
            return taken
        if taken is not None:
            taken.end()
        return Process()

    def end(self) -> None:
        """Ends the spare one."""
        with self._lock:
            if self._spare is not None:
                self._spare.end()
            self._spare = None


class Asker:
    """What a page asks: the newest wish of each kind counts, and slow ones can be given up.

    A process that has died is replaced at the next wish. The page hears `Died`, and that what was
    asked of it is over.

    hear : called as (kind, ticket, part) from a thread of its own, with what answers the newest
        wishes. Who hears later than that asks `current`.
    """

    def __init__(self, hear: Callable[[str, int, Any], None], spares: Spares) -> None:
        self._hear, self._spares = hear, spares
        self._newest = {kind: Newest() for kind in KINDS}
        self._wishes: dict[str, Message] = {}  # the newest, as long as they are not done
        self._lock = Lock()
        self._over = False
        self._told_of: Process | None = None  # a process of whose death the page has heard
        self._start()

    def _start(self) -> None:
        self._process = process = self._spares.take()
        Thread(target=self._listen, args=(process,), daemon=True).start()

    def ask(self, kind: str, *arguments: Any) -> None:
        """Asks for something, and forgets what was asked of this kind before."""
        with self._lock:
            ticket = self._newest[kind].ask(time.monotonic())
            self._wishes[kind] = (kind, ticket, arguments)
            if self._process.alive:
                self._send(self._wishes[kind])
            else:
                if self._process is not self._told_of:
                    died = Died(self._process.ending)
                    self._hear(TORUS, self._newest[TORUS].ticket, died)
                self._renew()
                self._send_all()

    def _send(self, message: Message) -> None:
        with suppress(OSError):  # it has died: its listener hears of that, and says so
            self._process.connection.send(message)

    def _send_all(self) -> None:
        for message in self._wishes.values():
            self._send(message)

    def current(self, kind: str, ticket: int) -> bool:
        """Whether an answer is still one to the newest wish."""
        return self._newest[kind].current(ticket)

    def cancel(self) -> None:
        """Gives up whatever is being computed, at once."""
        with self._lock:
            for newest in self._newest.values():
                newest.forget()
            self._wishes.clear()
            self._renew()

    def seconds(self) -> float:
        """How long the slowest of the newest wishes takes; an older one in its way is given up."""
        with self._lock:
            now = time.monotonic()
            if any(newest.stuck(now) for newest in self._newest.values()):
                self._renew()
                self._send_all()
            return max(newest.seconds(now) for newest in self._newest.values())

    def _renew(self) -> None:
        for newest in self._newest.values():
            newest.begun(0)
        self._process.kill()
        self._start()

    def end(self) -> None:
        """The page is closed."""
        with self._lock:
            self._over = True
            self._process.kill()

    def _listen(self, process: Process) -> None:
        """Hears a process until it has ended.

        The connection is closed here alone: closed under recv, its number would be that of the next
        one, whose messages would be taken.
        """
        try:
            while True:
                self._answered(process, *process.connection.recv())
        except (EOFError, OSError):
            self._died(process)
        finally:
            process.connection.close()

    def _died(self, process: Process) -> None:
        """Says what became of a process, if it was not ended by us, and answers what was asked."""
        with self._lock:
            if process is not self._process or self._over:
                return
            self._told_of = process
            lost = list(self._wishes.values())
            self._wishes.clear()
            for kind, ticket, _ in lost:
                self._newest[kind].done(ticket)
            told = self._newest[TORUS].ticket
        for kind, ticket, _ in lost:
            self._hear(kind, ticket, DONE)
        self._hear(TORUS, told, Died(process.ending))

    def _answered(self, process: Process, kind: str, ticket: int, part: Any) -> None:
        with self._lock:
            newest = self._newest[kind]
            if process is not self._process:
                return
            if part is TAKEN:
                newest.begun(ticket)
                return
            current = newest.current(ticket)
            if isinstance(part, str):
                newest.done(ticket)
                if current:
                    self._wishes.pop(kind, None)
        if current:
            self._hear(kind, ticket, part)
