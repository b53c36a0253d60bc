"""Verbs of the exact layer: propagate, prove, verify, sweep."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from symfpu.chain.potentials.typed import potential_of_text
from symfpu.chain.propagation import excitation_sequence
from symfpu.checkers.reading import CertificateError
from symfpu.checkers.verify import CHECKERS, verified_certificate
from symfpu.cli.certificates import certificate_record
from symfpu.cli.chains import BondsIfGiven, BondsOption, EndsOption, PotentialOption
from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, output_named, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    NOTHING_KEPT,
    CertificateOption,
    JsonOption,
    OrderOption,
    SeedsIfGiven,
    SeedsOption,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.theorems import (
    prove_theorem,
    refuse_case,
    refuse_theorem,
    require_case,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.formats import format_of, opened_by
from symfpu.files.progress import NO_FRACTION
from symfpu.files.writing import output_file, write_text
from symfpu.plots.rule import propagation
from symfpu.proofs.certificates import PropagationProof, prove_propagation
from symfpu.proofs.sweeps import sweep_markdown, sweep_propagation

ALLOWED_CERTIFICATE = "one written by symfpu prove or certify, unaltered"
MODELS = ("alpha", "beta", "alpha+beta")
SingleModelOption = Annotated[
    str | None, choice("--model", MODELS[:2], "The chain.  Default: alpha.")
]


@app.command(epilog="Example: symfpu propagate -N 32 --model alpha --seeds 3,5 --order 4")
def propagate(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[
        str | None, choice("--model", MODELS, "The chain.  Default: alpha.")
    ] = None,
    potential: PotentialOption = None,
    ends: EndsOption = "fixed",
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Which modes the propagation rule D_k excites at each order."""
    chosen = whole_numbers("seeds", seeds)
    N = whole("N", bonds)
    highest = whole("order", order)
    picture = picture_named(plot)
    law = {"model": model, "potential": potential}
    sequence = excitation_sequence(N, chosen, highest, **law, ends=ends)
    draw(partial(propagation, sequence, N=N), picture)
    if as_json:
        record = {
            "kind": "propagate",
            "N": N,
            **_law_entries(model, potential),
            **({} if ends == "fixed" else {"ends": ends}),
            "seeds": sorted(chosen),
            "order": highest,
            "excitation_sequence": [list(modes) for modes in sequence],
        }
        print_json(record)
        return
    for k, modes in enumerate(sequence):
        say(f"D_{k} = {_set_of(modes)}")
    say_drawn(picture)


def _law_entries(model: str | None, potential: str | None) -> dict[str, str]:
    """The model, or the potential as it is written."""
    if potential is None:
        return {"model": model or "alpha"}
    return {"potential": potential_of_text(potential).text}


def _set_of(modes: Iterable[int]) -> str:
    listed = ", ".join(map(str, modes))
    return f"{{{listed}}}"


@app.command(
    epilog="Example: symfpu prove -N 8 --model beta --seeds 1,4 --order 3 -o proof.json"
)
def prove(
    order: OrderOption,
    bonds: BondsIfGiven = None,
    seeds: SeedsIfGiven = None,
    model: SingleModelOption = None,
    potential: PotentialOption = None,
    points: Annotated[
        str | None,
        typer.Option(
            help="Independent primes and random frequencies.  Default: 1.", metavar="P"
        ),
    ] = None,
    all_N: Annotated[
        bool, typer.Option("--all-N", help="Prove it for every N and all sets of S seeds.")
    ] = False,
    seeds_number: Annotated[
        str | None,
        typer.Option(help="With --all-N: how many seeds, 1 to 3.", metavar="S"),
    ] = None,
    log: Annotated[
        str | None,
        typer.Option(
            "--file",
            help="With --all-N: keep decided flats here; an interrupted proof goes on.",
            metavar="FILE",
        ),
    ] = None,
    output: CertificateOption = None,
    as_json: JsonOption = False,
) -> None:
    """Prove or refute the propagation rule by exact arithmetic, for one N or for all.

    Exit code 1 where it stays undecided.
    """
    file = output_named(output)
    if all_N:
        refuse_case({"N": bonds, "seeds": seeds, "potential": potential, "points": points})
        kept = None if log is None else path_named("file", log)
        theorem = prove_theorem(model, seeds_number, order, kept, file, as_json)
        raise typer.Exit(1 if theorem.verdict == "undecided" else 0)
    refuse_theorem({"seeds_number": seeds_number, "file": log})
    bonds, seeds = require_case(bonds, seeds)
    N = whole("N", bonds)
    chosen = whole_numbers("seeds", seeds)
    highest = whole("order", order)
    with progress_bar("recursion modulo a prime") as advance:
        proof = prove_propagation(
            N,
            chosen,
            highest,
            model=model,
            potential=potential,
            points=whole("points", points or "1"),
            progress=advance,
        )
        if file is not None:
            proof.write(file)
    if as_json:
        print_json(proof.record())
    else:
        _print_proof(proof)
        if file is not None:
            print(f"certificate: {file}")
    raise typer.Exit(1 if proof.verdict == "undecided" else 0)


def _print_proof(proof: PropagationProof) -> None:
    for k, (rule, actual) in enumerate(zip(proof.rule, proof.actual, strict=True)):
        differs = "" if rule == actual else f"   actually {_set_of(actual)}"
        say(f"D_{k} = {_set_of(rule)}{differs}")
    doubts = {}
    for undecided in proof.undecided:
        probability = f"{undecided.error_probability:.1e}"
        doubts[undecided.mode] = f" (undecided, error probability {probability})"
    for case in proof.exceptions:
        found = "at no order" if case.actual is None else case.actual
        doubt = doubts.get(case.mode, "")
        say(
            f"mode {case.mode}: predicted at order {case.predicted}, actually {found}{doubt}"
        )
    how = f"   (excited modes by {proof.reason})" if proof.excited else ""
    say(f"verdict: {proof.verdict}{how}")


@app.command(epilog="Example: symfpu verify proof.json")
def verify(
    file: Annotated[
        str,
        typer.Argument(
            help="A certificate written by symfpu prove or certify.", metavar="FILE"
        ),
    ],
    as_json: JsonOption = False,
) -> None:
    """Check a certificate by another route.

    Python's integers, nothing of the prover: of the rule in mode space, with the tensors B and C;
    of theorems for every N the flats are found again; of orbits and exponents every bound.
    """
    path = path_named("certificate", file)
    _require_certificate(path)
    try:
        with progress_bar("check") as advance:
            advance(f"check of {path.name}", NO_FRACTION)
            certificate, checked = verified_certificate(path)
    except CertificateError as error:
        raise InputError(
            "certificate", str(path), ALLOWED_CERTIFICATE, str(error)
        ) from error
    if as_json:
        about = {"file": str(path), "valid": True, "checked": checked}
        print_json(certificate_record(certificate) | about)
        return
    say("\n".join([*checked, "the certificate is valid"]))


def _require_certificate(path: Path) -> None:
    """InputError for a file of ours that is none, with what opens it."""
    try:
        named = format_of(path)
    except OSError:  # that there is none is said by the checker
        return
    advice = None if named in CHECKERS else opened_by(named)
    if advice is not None:
        problem = f"its format is {named!r}: {advice}"
        raise InputError("certificate", str(path), ALLOWED_CERTIFICATE, problem)


@app.command(
    epilog="Example: symfpu sweep --model beta --longest 9 --order 3 --file beta.jsonl"
)
def sweep(
    context: typer.Context,
    order: OrderOption,
    model: SingleModelOption = None,
    potential: PotentialOption = None,
    longest: Annotated[
        str, typer.Option(help="All chains with 2 up to this many bonds.", metavar="N")
    ] = "12",
    largest: Annotated[
        str, typer.Option(help="All seed sets with up to this many modes.", metavar="S")
    ] = "3",
    file: Annotated[
        str | None,
        typer.Option(
            help="Keep decided cases here; an interrupted sweep goes on from it.",
            metavar="FILE",
        ),
    ] = None,
    markdown: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Write the summary to this Markdown file.",
            metavar="FILE",
        ),
    ] = None,
    kept_file: SaveOption = None,
    as_json: JsonOption = False,
) -> None:
    """Decide the propagation rule for all seed sets of a range of chains."""
    lengths = range(2, whole("longest", longest) + 1)
    if not lengths:
        raise InputError("longest", longest, "2 or more", "take a longer chain")
    log = None
    if file is not None:
        log = output_file(path_named("file", file), "file", "choose another with --file")
    summary = output_named(markdown)
    saved = file_named(kept_file)
    with progress_bar("seed sets", lambda: _kept(log)) as advance:
        result = sweep_propagation(
            lengths,
            whole("largest", largest),
            whole("order", order),
            model=model,
            potential=potential,
            file=log,
            progress=advance,
        )
        if summary is not None:
            write_text(summary, sweep_markdown(result))
        keep(result, saved, context)
    if as_json:
        print_json(result.record())
        return
    say(result)
    for case in result.exceptions:
        modes = []
        for q, predicted, actual in case.exceptions:
            modes.append(f"mode {q} at {actual}, predicted {predicted}")
        say(f"N={case.N} seeds {case.seeds}: {', '.join(modes)}")
    say_kept(saved)


def _kept(log: Path | None) -> str:
    """What stands of a sweep that was interrupted."""
    if log is None or not log.exists():
        return NOTHING_KEPT
    return f"cases decided so far are kept in {log}; the same command goes on from them"
