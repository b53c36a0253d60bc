"""Proofs and sweeps of the propagation rule, for JSON and as text."""

from __future__ import annotations

from typing import Any

from symfpu.certified.existence import ExistenceProof
from symfpu.certified.residual import ResidualProof
from symfpu.certified.stability_proof import StabilityProof
from symfpu.certified.stay import StayProof
from symfpu.numbers.counted import counted
from symfpu.proofs import (
    certificates,
    check_existence,
    check_stability,
    check_torus,
    theorem,
)
from symfpu.proofs.certificates import PropagationProof
from symfpu.proofs.sweeps import Sweep, SweepCase
from symfpu.proofs.theorem import RuleForAllN
from symfpu.results.text_tables import markdown_table

VERDICTS = ("proved", "refuted", "undecided")
CERTIFIED = {
    certificates.FORMAT: PropagationProof.__name__,
    theorem.FORMAT: RuleForAllN.__name__,
    check_existence.FORMAT: ExistenceProof.__name__,
    check_stability.FORMAT: StabilityProof.__name__,
    check_torus.FORMAT: ResidualProof.__name__,
}
EVIDENCE = ("excited", "vanishing", "points", "coefficients", "digest")

Json = dict[str, Any]


def certificate_record(certificate: Json) -> Json:
    """The same of a certificate that was read, of any kind; of others what is no list or table."""
    kind = (
        StayProof.__name__ if certificate.get("stay") else CERTIFIED[certificate["format"]]
    )
    if kind == PropagationProof.__name__:
        kept = {key: certificate[key] for key in certificate if key not in EVIDENCE}
    else:
        kept = {key: x for key, x in certificate.items() if isinstance(x, str | int)}
        kept.pop("digest", None)
    return {"kind": kind} | kept


def sweep_markdown(sweep: Sweep) -> str:
    """A sweep of the propagation rule.

    How often it holds by N and number of seeds, and every exception.
    """
    proved = sum(case.verdict == "proved" for case in sweep.cases)
    holds = sum(case.corrected_rule_holds for case in sweep.cases)
    counts = f"{counted(len(sweep.cases), 'seed set')}. The proposition holds in {proved}; "
    counts += f"the corrected rule predicts the actual sets in {holds}."
    parts = [f"## {sweep.model} model, order {sweep.order}", counts]
    parts.append(markdown_table(["N", "seeds", "sets", *VERDICTS], _count_rows(sweep)))
    exceptions = [_exception_row(case) for case in sweep.exceptions]
    if exceptions:
        parts.append("Exceptions (mode: predicted order -> actual order):")
        parts.append(markdown_table(["N", "seeds", "exceptions"], exceptions))
    return "\n\n".join(parts) + "\n"


def _count_rows(sweep: Sweep) -> list[list[str]]:
    """Verdicts by N and number of seeds."""
    groups: dict[tuple[int, int], list[str]] = {}
    for case in sweep.cases:
        size = (case.N, len(case.seeds))
        groups.setdefault(size, []).append(case.verdict)
    rows = []
    for (N, s), verdicts in groups.items():
        counts = [verdicts.count(verdict) for verdict in VERDICTS]
        row = [N, s, len(verdicts), *counts]
        rows.append([str(number) for number in row])
    return rows


def _exception_row(case: SweepCase) -> list[str]:
    seeds = ", ".join(map(str, case.seeds))
    moved = [
        f"{q}: {predicted} -> {'later' if actual is None else actual}"
        for q, predicted, actual in case.exceptions
    ]
    return [str(case.N), seeds, "; ".join(moved)]
