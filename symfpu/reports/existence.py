"""Proofs of existence, for JSON and for the terminal."""

from __future__ import annotations

from typing import Any

import mpmath

from symfpu.certified.existence import ExistenceProof
from symfpu.numbers.one_sided import above, below
from symfpu.numbers.typed import decimal
from symfpu.reports.tables import fifteen_digits


def existence_record(proof: ExistenceProof) -> dict[str, Any]:
    """Keys of the command line; A and H are the middles of intervals."""
    digits = proof.digits + 3
    return {
        "kind": type(proof).__name__,
        **proof.chain.typed,
        "seeds": [proof.seed],
        "frequencies": {str(proof.seed): decimal(proof.frequency)},
        "frequency_radius": fifteen_digits(proof.frequency_radius),
        "proved": True,
        "theorem": proof.theorem,
        "fixed": proof.fixed,
        "value": decimal(proof.value),
        "half_width": decimal(proof.half_width),
        "radius": fifteen_digits(proof.radius),
        "unique": fifteen_digits(proof.unique),
        "nu": str(proof.nu),
        "amplitudes": {str(proof.seed): mpmath.nstr(proof.amplitude, digits)},
        "amplitude_radius": fifteen_digits(proof.amplitude_radius),
        "energy": mpmath.nstr(proof.energy, digits),
        "energy_radius": fifteen_digits(proof.energy_radius),
        "bounds": {
            "Y": fifteen_digits(proof.residual),
            "Z1": fifteen_digits(proof.linear),
            "Z2": fifteen_digits(proof.curvature),
        },
        "harmonics": proof.harmonics,
        "block": proof.block,
    }


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
