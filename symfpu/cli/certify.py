"""The verb certify: theorems about a saved breather or torus."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.certified.existence import ExistenceProof, prove_existence
from symfpu.certified.residual import ResidualProof, prove_residual
from symfpu.certified.stability_proof import StabilityProof, prove_stability
from symfpu.certified.stay import TIME, StayProof, prove_stay
from symfpu.chain.chain import require_fixed_ends
from symfpu.cli.chains import solution_of
from symfpu.cli.keeping import output_named
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
from symfpu.store.saved_file import load
from symfpu.tori.torus import Torus

AmplitudeOption = Annotated[
    str | None,
    typer.Option(help="Of a breather: that of exactly this amplitude.", metavar="A"),
]
EnergyOption = Annotated[
    str | None,
    typer.Option(help="Of a breather: that of exactly this energy H.", metavar="E"),
]
HalfWidthOption = Annotated[
    str | None,
    typer.Option(
        help="Of a breather: one for each value that is no further away.", metavar="W"
    ),
]
DigitsOption = Annotated[
    int | None,
    typer.Option(
        help="Of a breather: Newton's method finds it to so many digits first.",
        metavar="D",
    ),
]
StabilityOption = Annotated[
    bool,
    typer.Option(
        "--stability", help="Of a breather: also that it is linearly stable, or unstable."
    ),
]
TimeOption = Annotated[
    str | None, typer.Option(help="Of a torus: for how long.  Default: 1e9.", metavar="T")
]
ResidualOption = Annotated[
    bool, typer.Option("--residual", help="Of a torus: its residual alone.")
]

Proof = ExistenceProof | StabilityProof | ResidualProof | StayProof


@app.command(epilog="Example: symfpu certify breather.symfpu --stability -o proof.json")
def certify(
    file: FileArgument,
    amplitude: AmplitudeOption = None,
    energy: EnergyOption = None,
    half_width: HalfWidthOption = None,
    digits: DigitsOption = None,
    stability: StabilityOption = False,
    time: TimeOption = None,
    residual: ResidualOption = False,
    output: CertificateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Prove that a periodic orbit exists near a breather, or how long orbits stay near a torus.

    Of a breather or a wave that travels along a ring: existence, at exactly its frequency or at
    the amplitude or energy given; of a breather its stability, at the same. Of a
    torus of two or more angles: its residual at all angles, and how near to it an orbit stays that
    starts on it. Exit code 1 where the bounds do not prove it.
    """
    solution = solution_of(load(path_named("FILE", file)), file)
    if len(solution.seeds) > 1 or stability:
        require_fixed_ends(solution.chain)
    of_breather = {
        "amplitude": amplitude,
        "energy": energy,
        "half_width": half_width,
        "digits": digits,
    }
    of_torus = {"time": time, "residual": residual or None}
    target = output_named(output)
    with progress_bar("proof") as advance:
        advance("proof", NO_FRACTION)
        if len(solution.seeds) == 1:
            _refuse(of_torus, "a breather")
            proof = _of_breather(solution, of_breather, stability, advance)
        else:
            _refuse(
                of_breather | {"stability": stability or None},
                "a torus of two or more angles",
            )
            proof = _torus_proof(solution, time, residual, advance)
        if target is not None:
            proof.write(target)
    _show(proof, target, as_json)


def _refuse(options: Mapping[str, Any], solution: str) -> None:
    """Options that belong to the other kind of solution."""
    for name, value in options.items():
        if value is not None:
            raise InputError(name, value, f"none for {solution}", "leave it out")


def _existence(orbit: Torus, options: Mapping[str, Any]) -> ExistenceProof:
    return prove_existence(
        orbit, **{name: value for name, value in options.items() if value is not None}
    )


def _of_breather(
    orbit: Torus,
    options: Mapping[str, Any],
    stability: bool,
    progress: Progress,
) -> Proof:
    if not stability:
        return _existence(orbit, options)
    assert isinstance(orbit, Torus)
    width = {"half_width": options["half_width"]}
    _refuse(width, "--stability, which is of one orbit")
    proof = _existence(orbit, options)
    return prove_stability(proof, progress=progress)


def _torus_proof(
    torus: Torus, time: str | None, residual: bool, progress: Progress
) -> Proof:
    if not residual:
        return prove_stay(torus, time=TIME if time is None else time, progress=progress)
    if time is not None:
        raise InputError("time", time, "none with --residual", "leave one out")
    return prove_residual(torus, progress=progress)


def _show(proof: Proof, target: Path | None, as_json: bool) -> None:
    if as_json:
        print_json(proof.record())
        return
    say(proof.text())
    if target is not None:
        print(f"certificate: {target}")
