"""Theorems about computed tori, for JSON and for the terminal."""

from __future__ import annotations

import mpmath

from symfpu.certified.residual import ResidualProof
from symfpu.certified.stay import StayProof
from symfpu.numbers.one_sided import above

SHOWN_DIGITS = 15


def residual_proof_text(proof: ResidualProof) -> str:
    """The theorem in lines."""
    return "\n".join(
        [
            f"{_which(proof)}: proved",
            f"  the residual of the equations of motion is below {mpmath.nstr(proof.bound, 3)} "
            f"of every particle at all angles,",
            f"  {mpmath.nstr(proof.relative, 3)} of the largest acceleration",
            f"  {_energy_text(proof)}",
        ]
    )


def _energy_text(proof: ResidualProof) -> str:
    if proof.energy is None:
        return "of its energy nothing is proved: a harmonic of it has nu.omega = 0"
    return f"H is within {above(proof.energy_radius, 3)} of {proof.energy} at all angles"


def stay_text(proof: StayProof) -> str:
    """The theorem, and what it follows from."""
    bounds = (proof.residual, proof.frame, proof.curvature, proof.room)
    residual, frame, curvature, room = (f"{x:.3g}" for x in bounds)
    return "\n".join(
        [
            f"{_which(proof)}: proved",
            f"  {proof.text};",
            f"  velocities within {mpmath.nstr(proof.momentum, 3)}; {proof.most}",
            f"  residual {residual}, frame {frame}, curvature {curvature}, room {room}; "
            f"residual of every particle below {mpmath.nstr(proof.bound, 3)}",
        ]
    )


def _which(proof: ResidualProof | StayProof) -> str:
    name = proof.chain.label
    seeds = ", ".join(map(str, proof.seeds))
    harmonics = f"{proof.harmonics} harmonics, {proof.digits} digits"
    return f"{name}, seeds {seeds}, {harmonics}"
