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
    warn,
    width_of,
)
from symfpu.cli.verbs import app
from symfpu.numbers.arithmetic import text
from symfpu.refinement.newton import Newton
from symfpu.reports.solution import refined_text, solution_text
from symfpu.store.saved_file import saved_file
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from


def _print_torus(torus: Torus[FromSeries], record: dict[str, Any]) -> None:
    say(torus.origin.series)
    for q, amplitude in record["amplitudes"].items():
        say(f"seed {q:<4} omega {record['frequencies'][q]:<20} amplitude {amplitude}")
    if torus.origin.certificate is not None:
        radius = text(max(torus.origin.certificate.radius.values()), 2)
        say(
            f"exactly one root within {radius}: certified"
            if torus.origin.certificate.certified
            else f"root not certified: {torus.origin.certificate.reason}"
        )
    say(
        f"frequency order {torus.origin.frequency_order}, coordinate order {torus.origin.order}"
    )
    say(f"energy H           {record['energy']}   (at t = 0)")
    average = record["average_harmonic_energy"]
    say(
        f"harmonic energy    {record['harmonic_energy']}   (at t = 0; time average {average})"
    )
    residual = f"{record['residual']:.2g}"
    relative = "equations of motion, relative to the largest acceleration"
    say(f"residual           {residual}   ({relative})")
    for warning in torus.warnings:
        warn(warning)


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
    _print_result(held.result)
    for reason in verdict.get("reasons", []):
        say(f"  {reason}")
    for key, value in held.provenance.items():
        say(f"{key:<18} {value}")


def _print_result(result: Any) -> None:
    """The result of a file, for a reader."""
    if comes_from(result, Newton):
        say(refined_text(result))
    elif isinstance(result, Torus):
        print_solution(result, result.record())
    else:
        say(result.text(width_of(sys.stdout)))


def print_solution(solution: Torus, record: dict[str, Any]) -> None:
    """A solution for a reader, from its record."""
    if comes_from(solution, FromSeries):
        _print_torus(solution, record)
    else:
        say(solution_text(record))


def verdict_of(torus: Torus) -> dict[str, Any]:
    """What a file says of a refined torus."""
    verdict = "doubtful" if torus.warnings else "torus"
    return {"verdict": verdict, "reasons": list(torus.warnings)}
