"""Files of a verb: --save keeps its whole result, for `symfpu show` and for `load`."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.cli.terminal import path_named
from symfpu.files.writing import output_file
from symfpu.store.saved_file import save

SaveOption = Annotated[
    str | None,
    typer.Option(
        "--save",
        help="Keep the whole result in this file, for symfpu show.",
        metavar="FILE",
    ),
]


def file_named(text: str | None) -> Path | None:
    """The file, checked before anything is computed; None where nothing is to be kept."""
    if text is None:
        return None
    return output_file(path_named("save", text), "save", "choose another with --save")


def output_named(text: str | None) -> Path | None:
    """The same of the option --output."""
    return None if text is None else output_file(path_named("output", text))


def keep(result: Any, file: Path | None, context: typer.Context) -> None:
    """Writes the result with the command that made it, if it is wanted."""
    if file is not None:
        save(file, result, command=shlex.join(["symfpu", *context.obj]))


def say_kept(file: Path | None) -> None:
    """The line for a reader that it is there."""
    if file is not None:
        print(f"saved: {file}")
