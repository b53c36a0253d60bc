"""The verb certify: a proof that a periodic orbit exists near a computed one."""

from __future__ import annotations

from typing import Annotated

import typer

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

AmplitudeOption = Annotated[
    str | None, typer.Option(help="The orbit of exactly this amplitude.", metavar="A")
]
EnergyOption = Annotated[
    str | None, typer.Option(help="The orbit of exactly this energy H.", metavar="E")
]
HalfWidthOption = Annotated[
    str, typer.Option(help="One for each value that is no further away.", metavar="W")
]


@app.command(
    epilog="Examples: symfpu certify breather.symfpu -o proof.json; "
    "symfpu certify breather.symfpu --amplitude 0.4 --half-width 1e-5"
)
def certify(
    file: FileArgument,
    amplitude: AmplitudeOption = None,
    energy: EnergyOption = None,
    half_width: HalfWidthOption = "0",
    output: CertificateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Prove that a periodic orbit exists near a saved breather.

    Of exactly its frequency, or of the amplitude or energy given. Exit code 1 where the bounds do
    not prove it.
    """
    orbit = solution_of(load(path_named("FILE", file)), file)
    require_fixed_ends(orbit.chain)
    assert isinstance(orbit, QuasiPeriodic)
    target = None if output is None else output_file(path_named("output", output))
    with progress_bar("proof") as advance:
        advance("proof", NO_FRACTION)
        proof = prove_existence(
            orbit, amplitude=amplitude, energy=energy, half_width=half_width
        )
        if target is not None:
            proof.write(target)
    if as_json:
        print_json(existence_record(proof))
        return
    say(existence_text(proof))
    if target is not None:
        print(f"certificate: {target}")
