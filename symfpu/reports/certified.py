"""Theorems about computed tori, for JSON and for the terminal."""

from __future__ import annotations

from typing import Any

import mpmath

from symfpu.certified.residual import ResidualProof
from symfpu.certified.stay import StayProof
from symfpu.numbers.one_sided import above
from symfpu.numbers.typed import decimal
from symfpu.reports.tables import fifteen_digits

SHOWN_DIGITS = 15


def residual_proof_record(proof: ResidualProof) -> dict[str, Any]:
    """Keys of the command line; bounds are texts, as they may be below all doubles."""
    return _head(proof) | {
        "bound": _text(proof.bound),
        "relative": _text(proof.relative),
        "energy": None if proof.energy is None else str(proof.energy),
        "energy_radius": None if proof.energy is None else _text(proof.energy_radius),
    }


def stay_record(proof: StayProof) -> dict[str, Any]:
    """The same with the time, the distances and what they follow from."""
    return _head(proof) | {
        "bound": _text(proof.bound),
        "time": decimal(proof.time),
        "distance": _text(proof.distance),
        "momentum": _text(proof.momentum),
        "drift": {str(q): _text(x) for q, x in proof.drift.items()},
        "longest": fifteen_digits(proof.longest),
        "sigma": {str(q): fifteen_digits(x) for q, x in proof.sigma.items()},
        "bounds": {
            "residual": _text(proof.growth.terms[0]),
            "frame": fifteen_digits(proof.frame),
            "curvature": fifteen_digits(proof.curvature),
            "room": fifteen_digits(proof.room),
        },
    }


def _head(proof: ResidualProof | StayProof) -> dict[str, Any]:
    pairs = zip(proof.seeds, proof.frequencies, strict=True)
    return {
        "kind": type(proof).__name__,
        **proof.chain.typed,
        "seeds": list(proof.seeds),
        "frequencies": {str(q): decimal(w) for q, w in pairs},
        "proved": True,
        "theorem": proof.theorem,
        "harmonics": proof.harmonics,
        "digits": proof.digits,
    }


def _text(x: Any) -> str:
    number = mpmath.mpf(x.numerator) / x.denominator if hasattr(x, "numerator") else x
    return str(mpmath.nstr(number, SHOWN_DIGITS))


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
