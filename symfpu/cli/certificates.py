"""Certificates that were read, for JSON."""

from __future__ import annotations

from typing import Any

from symfpu.certified.existence import ExistenceProof
from symfpu.certified.residual import ResidualProof
from symfpu.certified.stability_proof import StabilityProof
from symfpu.certified.stay import StayProof
from symfpu.checkers import existence as check_existence
from symfpu.checkers import stability as check_stability
from symfpu.checkers import torus as check_torus
from symfpu.proofs import certificates, theorem
from symfpu.proofs.certificates import EVIDENCE, PropagationProof
from symfpu.proofs.theorem import RuleForAllN

CERTIFIED = {
    certificates.FORMAT: PropagationProof.__name__,
    theorem.FORMAT: RuleForAllN.__name__,
    check_existence.FORMAT: ExistenceProof.__name__,
    check_stability.FORMAT: StabilityProof.__name__,
    check_torus.FORMAT: ResidualProof.__name__,
}

Json = dict[str, Any]


def certificate_record(certificate: Json) -> Json:
    """Of a proof of the rule all but the evidence; of other theorems what is no list or table."""
    kind = (
        StayProof.__name__ if certificate.get("stay") else CERTIFIED[certificate["format"]]
    )
    if kind == PropagationProof.__name__:
        kept = {key: certificate[key] for key in certificate if key not in EVIDENCE}
    else:
        kept = {key: x for key, x in certificate.items() if isinstance(x, str | int)}
        kept.pop("digest", None)
    return {"kind": kind} | kept
