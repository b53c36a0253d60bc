"""The verb certify: a proof that a periodic orbit exists near a computed one."""

from __future__ import annotations

from symfpu.breathers.existence import prove_existence
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
from symfpu.tori.quasiperiodic import QuasiPeriodic


@app.command(epilog="Example: symfpu certify breather.symfpu -o proof.json")
def certify(
    file: FileArgument,
    output: CertificateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Prove that a periodic orbit exists near a saved breather.

    Exit code 1 where the bounds do not prove it.
    """
    orbit = solution_of(load(path_named("FILE", file)), file)
    require_fixed_ends(orbit.chain)
    assert isinstance(orbit, QuasiPeriodic)
    target = None if output is None else output_file(path_named("output", output))
    with progress_bar("proof") as advance:
        advance("proof", NO_FRACTION)
        proof = prove_existence(orbit)
        if target is not None:
            proof.write(target)
    if as_json:
        print_json(existence_record(proof))
        return
    say(existence_text(proof))
    if target is not None:
        print(f"certificate: {target}")
