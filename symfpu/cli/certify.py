"""The verb certify: theorems about a saved breather or torus."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.breathers.existence import ExistenceProof, prove_existence
from symfpu.bundles.bundle import load
from symfpu.certified.residual import ResidualProof, prove_residual
from symfpu.certified.stay import TIME, StayProof, prove_stay
from symfpu.chain.chain import require_fixed_ends
from symfpu.cli.chains import solution_of
from symfpu.cli.terminal import (
    CertificateOption,
    FileArgument,
    JsonOption,
    path_named,
    print_json,
    progress_bar,
    say,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.files.writing import output_file
from symfpu.reports.certified import (
    residual_proof_record,
    residual_proof_text,
    stay_record,
    stay_text,
)
from symfpu.reports.existence import existence_record, existence_text
from symfpu.tori.quasiperiodic import QuasiPeriodic

Proof = ExistenceProof | ResidualProof | StayProof
REPORTS: dict[type, tuple[Callable[[Any], dict[str, Any]], Callable[[Any], str]]] = {
    ExistenceProof: (existence_record, existence_text),
    ResidualProof: (residual_proof_record, residual_proof_text),
    StayProof: (stay_record, stay_text),
}


@app.command(epilog="Example: symfpu certify breather.symfpu -o proof.json")
def certify(
    file: FileArgument,
    time: Annotated[
        str | None,
        typer.Option(help="Of a torus: for how long.  Default: 1e9.", metavar="T"),
    ] = None,
    residual: Annotated[
        bool, typer.Option("--residual", help="Of a torus: its residual alone.")
    ] = False,
    output: CertificateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Prove that a periodic orbit exists near a breather, or how long orbits stay near a torus.

    Of a breather: existence. Of a torus of two or more angles: its residual at all angles, and
    how near to it an orbit stays that starts on it. Exit code 1 where the bounds do not prove it.
    """
    solution = solution_of(load(path_named("FILE", file)), file)
    require_fixed_ends(solution.chain)
    assert isinstance(solution, QuasiPeriodic)
    target = None if output is None else output_file(path_named("output", output))
    with progress_bar("proof") as advance:
        advance("proof", NO_FRACTION)
        proof = _proved(solution, time, residual, advance)
        if target is not None:
            proof.write(target)
    _show(proof, target, as_json)


def _proved(
    solution: QuasiPeriodic, time: str | None, residual: bool, advance: Progress
) -> Proof:
    if len(solution.seeds) == 1:
        if residual or time is not None:
            name, value = ("residual", True) if residual else ("time", time)
            raise InputError(name, value, "none for a breather", "leave it out")
        return prove_existence(solution)
    if residual:
        if time is not None:
            raise InputError("time", time, "none with --residual", "leave one out")
        return prove_residual(solution)
    return prove_stay(solution, time=TIME if time is None else time, progress=advance)


def _show(proof: Proof, target: Path | None, as_json: bool) -> None:
    record, text = REPORTS[type(proof)]
    if as_json:
        print_json(record(proof))
        return
    say(text(proof))
    if target is not None:
        print(f"certificate: {target}")
