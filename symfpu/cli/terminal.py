"""What all verbs share.

Options, numbers and paths, lines for a reader, JSON, progress, the interrupt key.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import timedelta
from pathlib import Path
from threading import Event, Lock, Thread
from time import monotonic
from typing import Annotated, Any, TextIO

import rich.progress
import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    SpinnerColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Column
from rich.text import Text

from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress
from symfpu.results.head import headed

SEEDS = typer.Option("--seeds", help="Seed modes D_0, such as 1,2.", metavar="Q,Q,...")
SAVED_SOLUTION = "A file written by symfpu solve, breather or refine -o."

SeedsOption = Annotated[str, SEEDS]
SeedsIfGiven = Annotated[str | None, SEEDS]
OrderOption = Annotated[
    str, typer.Option("--order", help="Order k of the series.", metavar="K")
]
HarmonicOption = Annotated[
    bool,
    typer.Option(
        "--harmonic", help="With --energy: the harmonic energy sum E_q instead of H."
    ),
]
DigitsOption = Annotated[
    str | None,
    typer.Option("--digits", help="Any number of digits.  Default: doubles.", metavar="D"),
]
FileArgument = Annotated[str, typer.Argument(help=SAVED_SOLUTION, metavar="FILE")]
SolutionOption = Annotated[
    str | None,
    typer.Option(
        "-o",
        "--output",
        help="Keep the solution in this file, for verbs that take FILE.",
        metavar="FILE",
    ),
]
CertificateOption = Annotated[
    str | None,
    typer.Option(
        "-o", "--output", help="Write the certificate to this file.", metavar="FILE"
    ),
]
JsonOption = Annotated[
    bool, typer.Option("--json", help="Machine-readable result on standard output.")
]


NOTHING_KEPT = "nothing is kept"
BAR_WIDTH = 20
INDENT = 4  # of what follows on the next line
PATIENCE = 2.0  # seconds before the first line of progress
PAUSE = 1.0  # least seconds between two lines
SHARE = 0.01  # of the time that has passed, which the pause is at least
NUMBER = re.compile(r"[^a-z]*(e[-+]?\d+)?\W*")  # with what stands around it
SILENCE = 30.0  # seconds after which a line comes although nothing has changed


class Interrupted(SymfpuError):
    """The interrupt key; says what is kept of the work, and how to go on."""

    def __init__(self, kept: str) -> None:
        super().__init__(f"interrupted: {kept}")


def whole(argument: str, text: str) -> int:
    """A whole number of the command line; InputError naming the argument otherwise."""
    try:
        return int(text)
    except ValueError as error:
        raise InputError(argument, text, "a whole number", "write digits only") from error


def number(argument: str, text: str) -> float:
    """A number of the command line; InputError naming the argument otherwise."""
    try:
        return float(text)
    except ValueError as error:
        raise InputError(argument, text, "a number such as 1e5", "write digits") from error


def whole_numbers(argument: str, text: str) -> list[int]:
    """Whole numbers with commas between them."""
    if not text.strip():
        return []
    return [whole(argument, part) for part in text.split(",")]


def by_seed(argument: str, text: str, seeds: tuple[int, ...]) -> dict[int, str]:
    """Numbers with commas between them, one for each seed."""
    parts = text.split(",")
    if len(parts) != len(seeds):
        raise InputError(
            argument,
            text,
            f"a number for each of the seeds {seeds}",
            "separate them by commas",
        )
    return dict(zip(seeds, parts, strict=True))


def one_of(options: Mapping[str, str | None]) -> None:
    """InputError unless exactly one of the options, by name, is given."""
    given = {name: value for name, value in options.items() if value is not None}
    if len(given) != 1:
        *names, last = (f"--{name}" for name in options)
        allowed = f"exactly one of {', '.join(names)} and {last}"
        advice = "leave the others out" if given else "give one of them"
        raise InputError(", ".join(options), given or None, allowed, advice)


def mode_named(argument: str, text: str) -> int | str:
    """A mode of the command line: its number, or as N-1 counted from the end of all chains."""
    name = text.strip()
    return name if name.startswith("N") else whole(argument, name)


def optional(argument: str, text: str | None) -> int | None:
    """A whole number, or None where the option is not given."""
    return None if text is None else whole(argument, text)


def path_named(argument: str, text: str) -> Path:
    """A path of the command line.

    InputError for an empty name, which would be the working folder.
    """
    if not text.strip():
        raise InputError(
            argument,
            text,
            "the name of a file or folder",
            "write . for the folder you are in",
        )
    return Path(text)


def print_json(record: dict[str, Any]) -> None:
    """A result for machines on standard output."""
    print(json.dumps(headed(record), indent=1))


def say(text: object) -> None:
    """Lines for a reader on standard output, folded between words where a terminal is narrower."""
    print(folded(str(text), width_of(sys.stdout)))


def warn(text: str) -> None:
    """A warning on standard error."""
    lines = folded(f"warning: {text}", width_of(sys.stderr))
    console().print(lines, style="yellow", highlight=False, markup=False)


def width_of(stream: TextIO) -> int | None:
    """Columns of a terminal, or those that COLUMNS asks for.

    None for a pipe or a file: lines stay whole.
    """
    if not os.environ.get("COLUMNS") and not stream.isatty():
        return None
    return shutil.get_terminal_size().columns


def folded(text: str, width: int | None) -> str:
    """The lines broken between words only, so that a number stays whole, however long it is."""
    if width is None:
        return text
    return "\n".join(
        part for line in text.split("\n") for part in _folded_line(line, width)
    )


def _folded_line(line: str, width: int) -> list[str]:
    if len(line) <= width:
        return [line]
    margin = len(line) - len(line.lstrip())
    wrapper = textwrap.TextWrapper(
        width,
        subsequent_indent=" " * (margin + INDENT),
        replace_whitespace=False,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return wrapper.wrap(line)


def console() -> Console:
    """Standard error."""
    return Console(stderr=True, soft_wrap=True)


@contextmanager
def progress_bar(
    label: str, kept: Callable[[], str] = lambda: NOTHING_KEPT, *, again: float = 0.0
) -> Iterator[Progress]:
    """A function that shows on standard error what is being done.

    It shows a bar on a terminal, and lines elsewhere.

    label : what is done first. kept : what stands when the interrupt key is pressed, and how to
        go on. again : least seconds between a line and one of the same words, with other numbers.
    Raises Interrupted in place of KeyboardInterrupt.
    """
    terminal = console()
    moves = terminal.is_terminal and not terminal.is_dumb_terminal
    shown = Bar(terminal, label) if moves else Lines(label, again)
    try:
        with shown:
            yield shown
    except KeyboardInterrupt as pressed:
        raise Interrupted(str(pressed) or kept()) from pressed


class TimeLeft(TimeRemainingColumn):
    """The time left, with the word that says so; nothing where no fraction is known."""

    def render(self, task: Task) -> Text:
        """Hours, minutes and seconds, or lines where it cannot be told yet."""
        remaining = super().render(task)
        return remaining.append(" left") if remaining.plain else remaining


class Bar:
    """A bar with percentage, time since the beginning, and time left of what is being done."""

    def __init__(self, terminal: Console, label: str) -> None:
        rest_of_line = Column(ratio=1, no_wrap=True, overflow="ellipsis")
        what = (
            SpinnerColumn(),
            TextColumn("{task.description}", markup=False, table_column=rest_of_line),
        )
        much = BarColumn(BAR_WIDTH), TaskProgressColumn()
        when = TimeElapsedColumn(), TimeLeft(compact=True)
        self._progress = rich.progress.Progress(
            *what, *much, *when, console=terminal, transient=True, expand=True
        )
        self._begun = self._progress.get_time()
        self._task = self._progress.add_task(label, total=None)
        self._done: float | None = None

    def __enter__(self) -> None:
        self._progress.start()

    def __exit__(self, *reason: object) -> None:
        self._progress.stop()

    def __call__(self, label: str, fraction: float) -> None:
        """Moves the bar; where the fraction begins anew, so does the estimate of the time left."""
        done = _known(fraction)
        if done is None or self._done is None or done < self._done:
            self._progress.remove_task(self._task)
            self._task = self._progress.add_task(label, total=None if done is None else 1.0)
            self._progress.tasks[0].start_time = self._begun
        self._progress.update(self._task, description=label, completed=done)
        self._done = done


class Lines:
    """A line for each step that is seen.

    The first comes after some seconds, then others with pauses that grow with time. A thread
    looks on, so that a step which began during a pause has its line, too, however silent it is.
    """

    def __init__(self, label: str, again: float = 0.0) -> None:
        self._begun = self._said = monotonic()
        self._step, self._printed = label, ""
        self._again, self._known = again, {""}
        self._done: float | None = None
        self._since, self._from = self._begun, 0.0
        self._lock, self._over = Lock(), Event()
        self._watch = Thread(target=self._look_on, daemon=True)

    def __enter__(self) -> None:
        self._watch.start()

    def __exit__(self, *reason: object) -> None:
        self._over.set()
        self._watch.join()

    def __call__(self, label: str, fraction: float) -> None:
        """Hears what is being done."""
        done = _known(fraction)
        with self._lock:
            if done is not None and (self._done is None or done < self._done):
                self._since, self._from = monotonic(), done
            self._step, self._done = label, done
        self._look()

    def _look_on(self) -> None:
        while not self._over.wait(PAUSE / 2):
            self._look()

    def _look(self) -> None:
        """Prints what is being done, if it is time to."""
        with self._lock:
            now = monotonic()
            quiet, passed = now - self._said, now - self._begun
            first = not self._printed
            pause = PATIENCE if first else max(PAUSE, SHARE * passed)
            share = "" if self._done is None else f", {self._done:.0%}"
            text, words = self._step + share, _words(self._step)
            if words in self._known:
                pause = max(pause, self._again)
            if text == self._printed:
                pause = max(pause, SILENCE)
            if quiet < pause:
                return
            print(
                f"symfpu: {_clock(passed)} {text}{self._left(now)}",
                file=sys.stderr,
                flush=True,
            )
            self._said, self._printed = now, text
            self._known.add(words)

    def _left(self, now: float) -> str:
        """The time left, if the rest of the step goes as its beginning."""
        if self._done is None or self._done <= self._from:
            return ""
        rest = (1.0 - self._done) / (self._done - self._from)
        return f", {_clock(rest * (now - self._since))} left"


def _words(label: str) -> str:
    """The label without its numbers: what stays while a step goes on."""
    return " ".join(word for word in label.split() if not NUMBER.fullmatch(word))


def _known(fraction: float) -> float | None:
    """The fraction, or None for NO_FRACTION."""
    return None if math.isnan(fraction) else fraction


def _clock(seconds: float) -> str:
    """Hours, minutes and seconds."""
    return str(timedelta(seconds=round(seconds)))
