"""Tori of rings that travel: harmonic nu in the mode nu.seeds, one function of the angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.errors import InputError
from symfpu.tori.ring_torus import RingTorus

Floats = NDArray[np.float64]


def require_travelling(torus: RingTorus) -> None:
    """InputError for waves of a ring that are no function of the phases of its seeds alone."""
    own = torus.harmonics @ np.array(torus.seeds)
    if ((own - torus.modes) % torus.chain.N).any():
        allowed = "travelling waves: each harmonic nu in the mode nu.seeds, modulo N"
        advice = "refine the solution with fixed ends and unfold it"
        raise InputError("torus", "a torus of standing waves", allowed, advice)


def wave_coefficients(torus: RingTorus) -> tuple[Ints, Floats]:
    """The harmonics, and the coefficients (H, 1) of `WaveEquation`, as they stand."""
    signs = signs_of(torus.harmonics @ np.array(torus.seeds), torus.chain.N)
    found: dict[tuple[int, ...], float] = {}
    for nu, c in zip(torus.harmonics.tolist(), signs * torus.sines, strict=True):
        sign = -1 if next((n for n in nu if n), 1) < 0 else 1
        key = tuple(sign * n for n in nu)
        found[key] = found.get(key, 0.0) + float(c)
    harmonics = np.array(list(found), dtype=np.int64).reshape(-1, len(torus.seeds))
    return harmonics, np.array(list(found.values()))[:, None]


def signs_of(modes: Ints, N: int) -> Ints:
    """Of sin(pi m / N)."""
    return np.where(modes // N % 2 == 0, 1, -1)
