"""The verb show: what a result file holds."""

from __future__ import annotations

import sys
from typing import Any

from symfpu.cli.terminal import (
    FileArgument,
    JsonOption,
    path_named,
    print_json,
    say,
    width_of,
)
from symfpu.cli.verbs import app
from symfpu.refinement.newton import Newton
from symfpu.store.saved_file import saved_file
from symfpu.tori.torus import Torus, comes_from


@app.command(epilog="Example: symfpu show torus.symfpu")
def show(
    file: FileArgument,
    as_json: JsonOption = False,
) -> None:
    """What a result file holds: any result, its verdict, and what made it."""
    held = saved_file(path_named("FILE", file))
    if as_json:
        print_json(held.record())
        return
    verdict = held.verdict or {}
    if verdict and not comes_from(held.result, Newton):
        say(f"verdict: {verdict.get('verdict')}")
    say(held.result.text(width_of(sys.stdout)))
    for reason in verdict.get("reasons", []):
        say(f"  {reason}")
    for key, value in held.provenance.items():
        say(f"{key:<18} {value}")


def verdict_of(torus: Torus) -> dict[str, Any]:
    """What a file says of a refined torus."""
    verdict = "doubtful" if torus.warnings else "torus"
    return {"verdict": verdict, "reasons": list(torus.warnings)}
