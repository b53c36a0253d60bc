"""Verbs of the exact layer: propagate, prove, verify, sweep."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from symfpu.chain.propagation import excitation_sequence
from symfpu.cli.terminal import (
    NOTHING_KEPT,
    BondsOption,
    JsonOption,
    OrderOption,
    SeedsOption,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.writing import output_file, write_text
from symfpu.proofs.certificates import PropagationProof, prove_propagation
from symfpu.proofs.sweeps import sweep_propagation
from symfpu.proofs.verify import CertificateError
from symfpu.proofs.verify import verify as verify_certificate
from symfpu.reports.sweep import sweep_markdown


@app.command(epilog="Example: symfpu propagate -N 32 --model alpha --seeds 3,5 --order 4")
def propagate(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha, beta or alpha+beta.")] = "alpha",
    as_json: JsonOption = False,
) -> None:
    """Which modes the propagation rule D_k excites at each order."""
    chosen = whole_numbers("seeds", seeds)
    sequence = excitation_sequence(whole("N", bonds), chosen, whole("order", order), model=model)
    if as_json:
        record = {
            "N": whole("N", bonds),
            "model": model,
            "seeds": sorted(chosen),
            "order": whole("order", order),
        }
        print_json(record | {"excitation_sequence": [list(modes) for modes in sequence]})
        return
    for k, modes in enumerate(sequence):
        say(f"D_{k} = {{{', '.join(map(str, modes))}}}")


@app.command(epilog="Example: symfpu prove -N 8 --model beta --seeds 1,4 --order 3 -o proof.json")
def prove(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    points: Annotated[str, typer.Option(help="Independent primes and random frequencies.")] = "1",
    output: Annotated[
        str | None,
        typer.Option("-o", "--output", help="Write the certificate to this file.", metavar="FILE"),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Prove or refute the propagation rule by exact arithmetic.

    Exit code 1 where it stays undecided.
    """
    number, chosen, highest = (
        whole("N", bonds),
        whole_numbers("seeds", seeds),
        whole("order", order),
    )
    file = None if output is None else output_file(path_named("output", output))
    with progress_bar("recursion modulo a prime") as advance:
        proof = prove_propagation(
            number,
            chosen,
            highest,
            model=model,
            points=whole("points", points),
            progress=lambda done, total: advance("recursion modulo a prime", done / max(total, 1)),
        )
        if file is not None:
            proof.write(file)
    if as_json:
        print_json(
            {
                key: value
                for key, value in proof.certificate().items()
                if key not in ("excited", "vanishing", "points", "digest")
            }
        )
    else:
        _print_proof(proof)
        if file is not None:
            print(f"certificate: {file}")
    raise typer.Exit(1 if proof.verdict == "undecided" else 0)


def _print_proof(proof: PropagationProof) -> None:
    open_modes = {u.mode: u for u in proof.undecided}
    for k, (rule, actual) in enumerate(zip(proof.rule, proof.actual, strict=True)):
        same = "" if rule == actual else f"   actually {{{', '.join(map(str, actual))}}}"
        say(f"D_{k} = {{{', '.join(map(str, rule))}}}{same}")
    for e in proof.exceptions:
        doubt = (
            f" (undecided, error probability {open_modes[e.mode].error_probability:.1e})"
            if e.mode in open_modes
            else ""
        )
        found = "at no order" if e.actual is None else e.actual
        say(f"mode {e.mode}: predicted at order {e.predicted}, actually {found}{doubt}")
    say(f"verdict: {proof.verdict}")


@app.command(epilog="Example: symfpu verify proof.json")
def verify(
    file: Annotated[
        str, typer.Argument(help="A certificate written by symfpu prove.", metavar="FILE")
    ],
    as_json: JsonOption = False,
) -> None:
    """Check a certificate by another route: mode space, the tensors B and C, Python's integers,
    nothing of the prover.
    """
    path = path_named("certificate", file)
    try:
        checked = verify_certificate(path)
    except CertificateError as error:
        raise InputError(
            "certificate", str(path), "one written by symfpu prove, unaltered", str(error)
        ) from error
    if as_json:
        print_json({"file": str(path), "valid": True, "checked": checked})
        return
    say("\n".join([*checked, "the certificate is valid"]))


@app.command(epilog="Example: symfpu sweep --model beta --longest 9 --order 3 --file beta.jsonl")
def sweep(
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    longest: Annotated[
        str, typer.Option(help="All chains with 2 up to this many bonds.", metavar="N")
    ] = "12",
    largest: Annotated[
        str, typer.Option(help="All seed sets with up to this many modes.", metavar="S")
    ] = "3",
    file: Annotated[
        str | None,
        typer.Option(
            help="Keep decided cases here; an interrupted sweep goes on from it.", metavar="FILE"
        ),
    ] = None,
    markdown: Annotated[
        str | None,
        typer.Option(
            "-o", "--output", help="Write the summary to this Markdown file.", metavar="FILE"
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Decide the propagation rule for all seed sets of a range of chains."""
    lengths = range(2, whole("longest", longest) + 1)
    if not lengths:
        raise InputError("longest", longest, "2 or more", "take a longer chain")
    log = (
        None
        if file is None
        else output_file(path_named("file", file), "file", "choose another with --file")
    )
    summary = None if markdown is None else output_file(path_named("output", markdown))
    with progress_bar("seed sets", lambda: _kept(log)) as advance:
        result = sweep_propagation(
            lengths,
            whole("largest", largest),
            whole("order", order),
            model=model,
            file=log,
            progress=lambda done, total: advance("seed sets", done / total),
        )
        if summary is not None:
            write_text(summary, sweep_markdown(result))
    if as_json:
        print_json(
            {
                "model": model,
                "order": result.order,
                "cases": len(result.cases),
                "exceptions": [asdict(c) for c in result.exceptions],
            }
        )
        return
    say(result)
    for case in result.exceptions:
        exceptions = ", ".join(f"mode {q} at {a}, predicted {p}" for q, p, a in case.exceptions)
        say(f"N={case.N} seeds {case.seeds}: {exceptions}")


def _kept(log: Path | None) -> str:
    """What stands of a sweep that was interrupted."""
    if log is None or not log.exists():
        return NOTHING_KEPT
    return f"cases decided so far are kept in {log}; the same command goes on from them"
