"""The part of the verb prove that is about every N."""

from __future__ import annotations

from pathlib import Path

from symfpu.cli.terminal import NOTHING_KEPT, print_json, progress_bar, say, whole
from symfpu.errors import InputError
from symfpu.files.writing import output_file
from symfpu.proofs.theorem import RuleForAllN, prove_for_all_N

LISTED = 40  # families that are printed


def refuse_case(given: dict[str, str | None]) -> None:
    """InputError for options that name one N or one seed set."""
    for name, value in given.items():
        if value is not None:
            advice = f"leave {name} out, or leave --all-N out"
            raise InputError(name, value, "none with --all-N", advice)


def refuse_theorem(given: dict[str, str | None]) -> None:
    """InputError for options that are those of a theorem alone."""
    for name, value in given.items():
        if value is not None:
            raise InputError(name, value, "none without --all-N", "add --all-N")


def require_case(bonds: str | None, seeds: str | None) -> tuple[str, str]:
    """N and seeds of one case; InputError where one is missing."""
    if bonds is None:
        raise InputError("N", None, "2 or more", "give -N, or --all-N for all of them")
    if seeds is None:
        raise InputError("seeds", None, "modes such as 1,2", "give --seeds")
    return bonds, seeds


def prove_theorem(
    model: str | None,
    seeds_number: str | None,
    order: str,
    log: Path | None,
    output: Path | None,
    as_json: bool,
) -> RuleForAllN:
    """Prove the rule for every N, print it, and write the certificate."""
    if seeds_number is None:
        advice = "give --seeds-number"
        raise InputError("seeds_number", None, "how many seeds the sets have", advice)
    kept = None if log is None else output_file(log, "file", "choose another with --file")
    with progress_bar("flats", lambda: _kept(kept)) as advance:
        proof = prove_for_all_N(
            model or "alpha",
            whole("seeds_number", seeds_number),
            whole("order", order),
            file=kept,
            progress=advance,
        )
        if output is not None:
            proof.write(output)
    if as_json:
        print_json(proof.record())
        return proof
    _print(proof)
    if output is not None:
        print(f"certificate: {output}")
    return proof


def _kept(log: Path | None) -> str:
    """What stands of a proof that was interrupted."""
    if log is None or not log.exists():
        return NOTHING_KEPT
    return f"flats decided so far are kept in {log}; the same command goes on from them"


def _print(proof: RuleForAllN) -> None:
    say(f"theorem: {proof.theorem}")
    families = proof.exceptional_flats
    if families:
        say(f"exceptional flats, {len(families)} of {proof.flats}:")
    for family in families[:LISTED]:
        say(f"  {family}")
    if len(families) > LISTED:
        say(f"  {len(families) - LISTED} more; --json lists them all")
    say(f"verdict: {proof.verdict}   (excited modes by {proof.reason})")
