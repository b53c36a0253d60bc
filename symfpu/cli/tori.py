"""Verbs of one torus: solve, show."""

from __future__ import annotations

import shlex
import sys
from typing import Annotated, Any

import typer

from symfpu.bundles.bundle import Bundle, load, save
from symfpu.chain.chain import require_fixed_ends
from symfpu.cli.chains import (
    AlphaOption,
    BetaOption,
    BondsOption,
    EndsOption,
    PotentialOption,
    chain_of,
)
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    FileArgument,
    JsonOption,
    OrderOption,
    SeedsOption,
    optional,
    path_named,
    print_json,
    progress_bar,
    say,
    warn,
    whole,
    whole_numbers,
    width_of,
)
from symfpu.cli.verbs import app
from symfpu.files.progress import NO_FRACTION
from symfpu.files.writing import output_file
from symfpu.numbers.arithmetic import text
from symfpu.refinement.tori import RefinedTorus
from symfpu.reports.family import refined_record, refined_text
from symfpu.reports.solution import solution_record, solution_text
from symfpu.reports.torus import assessment_text, torus_record
from symfpu.series.lindstedt import lindstedt
from symfpu.series.travelling import travelling_waves
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus, travelling_torus
from symfpu.tori.ring_verdict import assess_waves
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment, assess


@app.command(
    epilog="Example: symfpu solve -N 16 --alpha 0.33 --seeds 1 --omega 0.1962 --order 24"
)
def solve(
    context: typer.Context,
    bonds: BondsOption,
    seeds: SeedsOption,
    omega: Annotated[
        str,
        typer.Option(
            help="Frequencies, one for each seed, such as 0.19626,0.39046.",
            metavar="W,W,...",
        ),
    ],
    order: OrderOption,
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    ends: EndsOption = "fixed",
    frequency_order: Annotated[
        str | None,
        typer.Option(
            help="Order of the frequency series that gives the amplitudes.  Default: --order.",
            metavar="K",
        ),
    ] = None,
    coordinate_order: Annotated[
        str | None,
        typer.Option(
            help="Order at which the coordinates Q(t) are cut.  Default: --order.",
            metavar="K",
        ),
    ] = None,
    digits: Annotated[
        str | None,
        typer.Option(help="Any number of digits, proved.  Default: doubles.", metavar="D"),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Keep series, torus and verdict in this file.",
            metavar="FILE",
        ),
    ] = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Amplitudes and energies of the q-torus with the given frequencies.

    With a verdict on its series.
    """
    chain = chain_of(bonds, alpha, beta, potential, ends)
    chosen = whole_numbers("seeds", seeds)
    highest = optional("frequency-order", frequency_order)
    cut = optional("coordinate-order", coordinate_order)
    places = optional("digits", digits)
    file = None if output is None else output_file(path_named("output", output))
    picture = picture_named(plot)
    frequencies, last = omega.split(","), whole("order", order)
    if places is not None:
        require_fixed_ends(chain)
    torus: QTorus | RingTorus
    with progress_bar("series") as advance:
        if chain.periodic:
            waves = travelling_waves(chain, chosen, frequencies, last, progress=advance)
            advance("amplitudes", NO_FRACTION)
            torus = travelling_torus(waves, frequency_order=highest, order=cut)
            assessment = assess_waves(waves, torus, progress=advance)
            record = _ring_record(torus, assessment)
        else:
            series = lindstedt(
                chain, chosen, frequencies, last, digits=places, progress=advance
            )
            advance("amplitudes", NO_FRACTION)
            torus = solve_amplitudes(series, frequency_order=highest, order=cut)
            assessment = assess(series, torus, progress=advance)
            record = torus_record(torus, assessment)
        if file:
            advance("writing", NO_FRACTION)
            save(
                file,
                torus,
                verdict=assessment.record(),
                command=shlex.join(["symfpu", *context.obj]),
            )
        draw(torus.plot, picture)
    if as_json:
        print_json(record)
    else:
        say(f"verdict: {assessment.headline}")
        _print_solution(torus, record)
        say(assessment_text(assessment, width_of(sys.stdout)))
        if file:
            print(f"written: {file}")
        say_drawn(picture)


def _print_torus(torus: QTorus, record: dict[str, Any]) -> None:
    say(torus.series)
    for q, amplitude in record["amplitudes"].items():
        say(f"seed {q:<4} omega {record['frequencies'][q]:<20} amplitude {amplitude}")
    if torus.certificate is not None:
        radius = text(max(torus.certificate.radius.values()), 2)
        say(
            f"exactly one root within {radius}: certified"
            if torus.certificate.certified
            else f"root not certified: {torus.certificate.reason}"
        )
    say(f"frequency order {torus.frequency_order}, coordinate order {torus.order}")
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
    """What a result file holds: series, torus, verdict, and what made it."""
    bundle = load(path_named("FILE", file))
    solution = bundle.torus
    record = {} if solution is None else _record(solution)
    if as_json:
        kept = {
            "provenance": dict(bundle.provenance),
            "assessment": bundle.verdict,
            "test_vectors": bundle.test_vectors,
        }
        print_json(record | kept)
        return
    verdict = bundle.verdict or {}
    if verdict and not isinstance(solution, RefinedTorus):
        say(f"verdict: {verdict.get('verdict')}")
    _print_held(bundle, record)
    for reason in verdict.get("reasons", []):
        say(f"  {reason}")
    for key, value in bundle.provenance.items():
        say(f"{key:<18} {value}")


def _record(solution: QuasiPeriodic | RingTorus) -> dict[str, Any]:
    """A solution for JSON, with what only its kind has."""
    if isinstance(solution, RefinedTorus):
        return refined_record(solution)
    if isinstance(solution, QTorus):
        return torus_record(solution)
    return solution_record(solution)


def _print_held(bundle: Bundle, record: dict[str, Any]) -> None:
    """The series or the solution of a file, for a reader."""
    solution = bundle.torus
    if solution is None:
        say(bundle.series)
    elif isinstance(solution, RefinedTorus):
        say(refined_text(solution))
    else:
        _print_solution(solution, record)


def _print_solution(solution: QuasiPeriodic | RingTorus, record: dict[str, Any]) -> None:
    if isinstance(solution, QTorus):
        _print_torus(solution, record)
    else:
        say(solution_text(record))


def _ring_record(torus: RingTorus, assessment: Assessment) -> dict[str, Any]:
    """A torus of a ring for JSON, with the verdict on its series."""
    return {
        **solution_record(torus),
        "order": torus.order,
        "frequency_order": torus.frequency_order,
        "verdict": assessment.headline,
        "assessment": assessment.record(),
    }
