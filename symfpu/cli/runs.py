"""Options of verbs that follow an orbit: how long, in which steps, and where the run is kept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from symfpu.cli.terminal import NOTHING_KEPT

TimeOption = Annotated[
    str, typer.Option("--time", help="How long to follow it, such as 1e6.", metavar="T")
]
StepOption = Annotated[
    str, typer.Option("--step", help="Length of a step of the integrator.", metavar="H")
]
SamplesOption = Annotated[
    str,
    typer.Option("--samples", help="How many times to look, log-spaced.", metavar="S"),
]
CheckpointOption = Annotated[
    str | None,
    typer.Option(
        "--checkpoint",
        help="Keep the run in this file, and go on from it if it was killed.",
        metavar="FILE",
    ),
]


def kept_run(checkpoint: Path | None) -> str:
    """What stands of a run that was interrupted."""
    if checkpoint is None or not checkpoint.exists():
        return NOTHING_KEPT
    kept = f"the run up to its last checkpoint is kept in {checkpoint}"
    return f"{kept}; the same command goes on from it"
