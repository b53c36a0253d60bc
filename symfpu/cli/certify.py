"""The verb certify: a proof that a periodic orbit exists, and of its stability."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from symfpu.breathers.existence import ExistenceProof, prove_existence
from symfpu.breathers.stability_proof import StabilityProof, prove_stability
from symfpu.bundles.bundle import load
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
from symfpu.files.progress import NO_FRACTION
from symfpu.files.writing import output_file
from symfpu.reports.existence import existence_record, existence_text
from symfpu.reports.stability_proof import stability_record, stability_text
from symfpu.tori.quasiperiodic import QuasiPeriodic


@app.command(epilog="Example: symfpu certify breather.symfpu -o proof.json")
def certify(
    file: FileArgument,
    output: CertificateOption = None,
    stability: Annotated[
        bool,
        typer.Option(
            "--stability", help="Prove as well that it is linearly stable, or unstable."
        ),
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Prove that a periodic orbit exists near a saved breather, and whether it is stable.

    Exit code 1 where the bounds do not prove it.
    """
    orbit = solution_of(load(path_named("FILE", file)), file)
    require_fixed_ends(orbit.chain)
    assert isinstance(orbit, QuasiPeriodic)
    target = None if output is None else output_file(path_named("output", output))
    proof: ExistenceProof | StabilityProof
    with progress_bar("proof") as advance:
        advance("proof", NO_FRACTION)
        proof = prove_existence(orbit)
        if stability:
            proof = prove_stability(proof, progress=advance)
        if target is not None:
            proof.write(target)
    if as_json:
        print_json(proof_record(proof))
        return
    say(proof_text(proof))
    if target is not None:
        print(f"certificate: {target}")


def proof_record(proof: ExistenceProof | StabilityProof) -> dict[str, Any]:
    """Of either kind, for JSON."""
    if isinstance(proof, StabilityProof):
        return stability_record(proof)
    return existence_record(proof)


def proof_text(proof: ExistenceProof | StabilityProof) -> str:
    """Of either kind, for the terminal."""
    if isinstance(proof, StabilityProof):
        return stability_text(proof)
    return existence_text(proof)
