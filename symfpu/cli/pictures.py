"""The option --plot: the usual picture of what a verb computes, as a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.cli.terminal import path_named
from symfpu.plots.style import SUFFIXES, picture_file, write_picture

PlotOption = Annotated[
    str | None,
    typer.Option(
        "--plot",
        help=f"Draw the result into this file: {', '.join(SUFFIXES)}.",
        metavar="FILE",
    ),
]


def picture_named(text: str | None) -> Path | None:
    """The file of a picture, checked before anything is computed; None where none is wanted.

    Raises InputError for another suffix, and for a file that cannot be written.
    """
    return None if text is None else picture_file("plot", path_named("plot", text))


def draw(plot: Callable[[Any], object], file: Path | None) -> None:
    """Writes the picture, if one is wanted; plot : draws into axes, as the method of a result."""
    if file is not None:
        write_picture(plot, file)


def say_drawn(file: Path | None) -> None:
    """The line for a reader that a picture is there."""
    if file is not None:
        print(f"drawn: {file}")
