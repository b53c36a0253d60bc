"""Runs calls by number in a process with little memory, and ends those that hang.

python -m tests.fuzz.run 0 2500        calls 0 .. 2499, with counts
python -m tests.fuzz.run 1234          one call, with its arguments and its traceback
"""

import collections
import contextlib
import json
import os
import resource
import select
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import psutil

ROOT = Path(__file__).parents[2]
MEMORY = 6 * 2**30  # bytes of addresses: numba, BLAS and matplotlib reserve about 2
PROCESSOR = 30.0  # seconds of processor time of one call; the dearest sound one takes 5
IDLE = 60.0  # seconds in which a call sleeps, with all that it has started
STARTED = 900.0  # seconds of processor time in which the process compiles what its results need


def child():
    """Answers a number on standard input with the name of its function, then with the outcome and the seconds that it took.

    The work is done in this folder of its own. Sweeps start no processes: each would import everything again, and tests/sweeps
    have their lives and deaths.
    """
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    from symfpu.sweeps import workers
    from tests.fuzz import calls

    workers.ProcessWorkers = lambda workers: ThreadPoolExecutor(1)
    calls.methods()
    _furnish()
    print("ready", flush=True)
    answers = os.fdopen(os.dup(1), "w")

    def say(words):
        answers.write(json.dumps(words) + "\n")
        answers.flush()

    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
        for line in sys.stdin:
            number = int(line)
            say(calls.chosen(number)[0])
            before = _processor_time()
            outcome = calls.called(number)
            seconds = _processor_time() - before
            call = f"{calls.described(number)} " if outcome.kind == calls.FAULT else ""
            say([outcome.kind, f"{call}{outcome.what}"[:800], seconds])


def _processor_time():
    """Seconds of this process and of those that it started and that have ended."""
    whose = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(used.ru_utime + used.ru_stime for used in map(resource.getrusage, whose))


def _furnish():
    """Files that paths of the pool lead to."""
    from tests.fuzz import values

    values.symfpu.save("torus.symfpu", values.torus())
    values.rule().write("certificate.json")
    Path("text.txt").write_text("0.1 0.2\n0.3 nan\n")
    Path("empty").touch()
    Path("folder").mkdir()


class Child:
    """A process that makes calls; it is replaced after one that hangs or dies."""

    def __init__(self, folder):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        command = [sys.executable, "-m", "tests.fuzz.run", "child"]
        place = tempfile.mkdtemp(dir=folder)
        self.process = subprocess.Popen(command, cwd=place, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.family, self.rest = [psutil.Process(self.process.pid)], b""
        if self._line(STARTED) != "ready":
            self.end()
            raise RuntimeError("the process of the fuzzer does not start")

    def answer(self, number):
        """(where, kind, what, seconds) of a call; whether its process lives.

        Also of one that hangs or ends its process: what it took is not known, 0 seconds.
        """
        self.process.stdin.write(f"{number}\n".encode())
        self.process.stdin.flush()
        where = self._line(PROCESSOR)
        line = where and self._line(PROCESSOR)
        name = json.loads(where or '"?"')
        if line:
            return (name, *json.loads(line)), True
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(0.1)
        dead = self.process.poll()
        self.end()
        return (name, "fault", "no end" if dead is None else f"the process ended with {dead}", 0.0), False

    def _line(self, most):
        """One line of the process; empty if it is dead, works longer than `most`, or sleeps.

        The clock does not judge work: on a loaded machine it runs on while others have the processors.
        Processor time is asked for, and counted, from the first half second on that brings nothing: most calls take less, and to ask
        costs more than they do.
        """
        before, last, slept = None, -1.0, time.monotonic()
        while b"\n" not in self.rest:
            ready, _, _ = select.select([self.process.stdout], [], [], 0.5)
            if ready:
                part = os.read(self.process.stdout.fileno(), 65536)
                if not part:
                    return ""
                self.rest += part
                continue
            used = self._used()
            before = used if before is None else before
            if used != last or self._runs():
                last, slept = used, time.monotonic()
            if used - before > most or time.monotonic() - slept > IDLE:
                return ""
        line, self.rest = self.rest.split(b"\n", 1)
        return line.decode()

    def _used(self):
        """Processor time of the process and of all that it has started."""
        with contextlib.suppress(psutil.Error):
            self.family = [self.family[0], *self.family[0].children(recursive=True)]
        return sum(sum(times[:4]) for times in self._of_each("cpu_times"))

    def _runs(self):
        """Whether one of them has work to do, or waits for a processor or a disk."""
        return any(status != psutil.STATUS_SLEEPING for status in self._of_each("status"))

    def _of_each(self, what):
        """What the processes that live say of themselves."""
        for part in self.family:
            with contextlib.suppress(psutil.Error):
                yield getattr(part, what)()

    def end(self):
        """Ends the process and those that it has made, and closes the pipes."""
        self._used()
        for part in reversed(self.family):
            with contextlib.suppress(psutil.Error):
                part.kill()
        self.process.communicate()


def outcomes(numbers, folder, tell=lambda outcome: None):
    """(number, where, kind, what, seconds) of each."""
    one, found = Child(folder), []
    try:
        for number in numbers:
            answer, alive = one.answer(number)
            found.append((number, *answer))
            tell(found[-1])
            if not alive:
                one = Child(folder)
    finally:
        one.end()
    return found


def counts(found):
    """How many calls returned, were refused, and are faults; and how often each function returned."""
    kinds = collections.Counter(kind for _, _, kind, _, _ in found)
    returned = collections.Counter(where for _, where, kind, _, _ in found if kind == "returned")
    return kinds, returned


def report(found):
    """Counts of all outcomes, refusals by their class, and the functions that took longest."""
    kinds, returned = counts(found)
    classes = collections.Counter(what.partition(":")[0] or "exit code 1 or 2" for _, _, kind, what, _ in found if kind == "refused")
    spent = collections.Counter()
    for _, where, _, _, seconds in found:
        spent[where] += seconds
    dearest = ", ".join(f"{where} {seconds:.1f}" for where, seconds in spent.most_common(25))
    return (
        f"{kinds.total()} calls: {dict(kinds)}; {len(returned)} functions returned something\n"
        f"refused: {dict(classes.most_common())}\n"
        f"seconds of processor time: {spent.total():.0f}: {dearest}"
    )


def main(words):
    """One call in this process, or several in others."""
    if words == ["child"]:
        child()
        return
    with tempfile.TemporaryDirectory() as folder:
        if len(words) == 1:
            os.chdir(folder)
            from tests.fuzz import calls

            _furnish()
            print(calls.described(int(words[0])), calls.called(int(words[0])), sep="\n")
            _, function, (positional, named) = calls.chosen(int(words[0]))
            function(*positional, **named)
            return

        def say(outcome):
            if outcome[2] == "fault":
                print(*outcome, flush=True)

        print(report(outcomes(range(int(words[0]), int(words[1])), folder, say)))


if __name__ == "__main__":
    main(sys.argv[1:])
