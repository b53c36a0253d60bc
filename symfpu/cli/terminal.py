"""What all verbs share: options, whole numbers, JSON, a progress bar on standard error."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from symfpu.errors import InputError

app = typer.Typer(
    name="symfpu",
    help="Poincare-Lindstedt series of q-tori in Fermi-Pasta-Ulam chains.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

BondsOption = Annotated[str, typer.Option("-N", help="Number of bonds; the chain has N-1 moving particles.", metavar="N")]
SeedsOption = Annotated[str, typer.Option("--seeds", help="Seed modes D_0, such as 1,2.", metavar="Q,Q,...")]
OrderOption = Annotated[str, typer.Option("--order", help="Order k of the series.", metavar="K")]
JsonOption = Annotated[bool, typer.Option("--json", help="Machine-readable result on standard output.")]


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
    return [whole(argument, part) for part in text.split(",")] if text.strip() else []


def optional(argument: str, text: str | None) -> int | None:
    """A whole number, or None where the option is not given."""
    return None if text is None else whole(argument, text)


def print_json(record: dict[str, Any]) -> None:
    """A result for machines on standard output."""
    print(json.dumps(record, indent=1))


def console() -> Console:
    """Standard error."""
    return Console(stderr=True, soft_wrap=True)


@contextmanager
def progress_bar() -> Iterator[Callable[[str, float | None], None]]:
    """A function (label, fraction done or None) that moves a bar on standard error, if that is a terminal."""
    terminal = console()
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=terminal, transient=True, disable=not terminal.is_terminal) as progress:
        task = progress.add_task("", total=None)
        yield lambda label, done: progress.update(task, description=label, total=None if done is None else 1.0, completed=done)
