"""Proofs of existence, for JSON and for the terminal."""

from __future__ import annotations

from symfpu.certified.existence import ExistenceProof
from symfpu.numbers.one_sided import above, below


def existence_text(proof: ExistenceProof) -> str:
    """The theorem, the intervals, and the bounds."""
    chain = proof.chain.label
    given = (
        f"of this {proof.fixed}" if not proof.half_width else f"of each such {proof.fixed}"
    )
    return "\n".join(
        [
            f"{chain}, seed {proof.seed}, {proof.condition}: proved",
            f"  a {proof.kind} {given} exists within {above(proof.radius, 2)} "
            f"of the computed one, the only one within {below(proof.unique, 2)}",
            f"  in the norm {proof.norm}, nu = {proof.nu};",
            f"  analytic for |Im omega t| < log {proof.nu}",
            *(f"  {interval}" for interval in proof.intervals),
            f"  Y = {proof.residual:.2g}, Z0 + Z1 = {proof.linear:.3g}, "
            f"Z2 = {proof.curvature:.3g}; {proof.harmonics} harmonics, block of {proof.block}",
        ]
    )
