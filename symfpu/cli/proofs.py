"""Verbs of the exact layer: propagate, prove, verify, sweep."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from symfpu.chain.propagation import excitation_sequence
from symfpu.cli.terminal import (
    BondsOption,
    JsonOption,
    OrderOption,
    SeedsOption,
    app,
    print_json,
    progress_bar,
    whole,
    whole_numbers,
)
from symfpu.errors import InputError
from symfpu.files.writing import write_text
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
        record = {"N": whole("N", bonds), "model": model, "seeds": sorted(chosen), "order": whole("order", order)}
        print_json(record | {"excitation_sequence": [list(modes) for modes in sequence]})
        return
    for k, modes in enumerate(sequence):
        print(f"D_{k} = {{{', '.join(map(str, modes))}}}")


@app.command(epilog="Example: symfpu prove -N 8 --model beta --seeds 1,4 --order 3 -o certificate.json")
def prove(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    points: Annotated[str, typer.Option(help="Independent primes and random frequencies.")] = "1",
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the certificate to this file.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Prove or refute the propagation rule by exact arithmetic; exit code 1 where it stays undecided."""
    number, chosen, highest = whole("N", bonds), whole_numbers("seeds", seeds), whole("order", order)
    with progress_bar() as advance:
        proof = prove_propagation(
            number,
            chosen,
            highest,
            model=model,
            points=whole("points", points),
            progress=lambda done, total: advance("recursion modulo a prime", done / max(total, 1)),
        )
    if output:
        proof.write(output)
    if as_json:
        print_json({key: value for key, value in proof.certificate().items() if key not in ("excited", "vanishing", "points", "digest")})
    else:
        _print_proof(proof)
        if output:
            print(f"certificate: {output}")
    raise typer.Exit(1 if proof.verdict == "undecided" else 0)


def _print_proof(proof: PropagationProof) -> None:
    open_modes = {u.mode: u for u in proof.undecided}
    for k, (rule, actual) in enumerate(zip(proof.rule, proof.actual, strict=True)):
        same = "" if rule == actual else f"   actually {{{', '.join(map(str, actual))}}}"
        print(f"D_{k} = {{{', '.join(map(str, rule))}}}{same}")
    for e in proof.exceptions:
        doubt = f" (undecided, error probability {open_modes[e.mode].error_probability:.1e})" if e.mode in open_modes else ""
        print(f"mode {e.mode}: predicted at order {e.predicted}, actually {'at no order' if e.actual is None else e.actual}{doubt}")
    print(f"verdict: {proof.verdict}")


@app.command(epilog="Example: symfpu verify certificate.json")
def verify(
    file: Annotated[Path, typer.Argument(help="A certificate written by symfpu prove.", metavar="FILE")],
    as_json: JsonOption = False,
) -> None:
    """Check a certificate by another route: mode space, the tensors B and C, Python's integers, nothing of the prover."""
    try:
        checked = verify_certificate(file)
    except CertificateError as error:
        raise InputError("certificate", str(file), "one written by symfpu prove, unaltered", str(error)) from error
    if as_json:
        print_json({"file": str(file), "valid": True, "checked": checked})
        return
    print("\n".join([*checked, "the certificate is valid"]))


@app.command(epilog="Example: symfpu sweep --model beta --longest 12 --largest 3 --order 3 --file beta.jsonl")
def sweep(
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    longest: Annotated[str, typer.Option(help="All chains with 2 up to this many bonds.", metavar="N")] = "12",
    largest: Annotated[str, typer.Option(help="All seed sets with up to this many modes.", metavar="S")] = "3",
    file: Annotated[Path | None, typer.Option(help="Keep every decided case here; an interrupted sweep goes on from it.")] = None,
    markdown: Annotated[Path | None, typer.Option("-o", "--output", help="Write the summary to this Markdown file.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Decide the propagation rule for all seed sets of a range of chains."""
    lengths = range(2, whole("longest", longest) + 1)
    if not lengths:
        raise InputError("longest", longest, "2 or more", "take a longer chain")
    with progress_bar() as advance:
        result = sweep_propagation(
            lengths,
            whole("largest", largest),
            whole("order", order),
            model=model,
            file=file,
            progress=lambda done, total: advance("seed sets", done / total),
        )
    if markdown:
        write_text(markdown, sweep_markdown(result))
    if as_json:
        print_json(
            {"model": model, "order": result.order, "cases": len(result.cases), "exceptions": [asdict(c) for c in result.exceptions]}
        )
        return
    print(result)
    for case in result.exceptions:
        print(f"N={case.N} seeds {case.seeds}: " + ", ".join(f"mode {q} at {a}, predicted {p}" for q, p, a in case.exceptions))
