"""Integer relations of the frequencies of travelling waves, and resonances that Umklapp makes."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm

import numpy as np

from symfpu.errors import InputError
from symfpu.refinement.lattice import low_harmonics
from symfpu.refinement.resonances import NearResonance
from symfpu.series.ring_resonances import resonant
from symfpu.tori.torus import Torus

SUSPECT = 1e-9  # of nu.omega, below which it is decided exactly
STANDING = (
    "opposite waves of one frequency stand: refine the solution of Chain(N // 2, ...) with "
    "fixed ends and unfold it; else change a frequency"
)


def require_independent(torus: Torus, frequencies: Sequence[Fraction]) -> None:
    """InputError where nu.omega = 0 for a low harmonic: the angles are not independent then.

    frequencies : of the seeds of the torus, (s,).
    """
    harmonics = np.concatenate([low_harmonics(len(frequencies)), torus.harmonics])
    shared = lcm(*(w.denominator for w in frequencies))
    whole = [int(w * shared) for w in frequencies]
    near = np.abs(harmonics @ np.array([float(w) for w in frequencies])) < SUSPECT
    for nu in sorted(harmonics[near].tolist(), key=_size):
        if any(nu) and not sum(n * w for n, w in zip(nu, whole, strict=True)):
            terms = zip(nu, torus.seeds, strict=True)
            relation = " ".join(f"{n:+d} omega_{q}" for n, q in terms if n)
            allowed = "frequencies without an integer relation among the harmonics"
            raise InputError("torus", f"{relation} = 0", allowed, STANDING)


def _size(nu: list[int]) -> tuple[int, list[int]]:
    """The sum of |nu_i|, and of equal ones those first whose first number is positive."""
    return sum(map(abs, nu)), [-n for n in nu]


def driven_in_resonance(torus: Torus, near_resonances: Sequence[NearResonance]) -> str:
    """The lowest of the small divisors that are zero at the linear frequencies, in words.

    Empty where there is none.
    """
    chain, seeds = torus.chain, torus.seeds
    for found in sorted(near_resonances, key=lambda d: _size(list(d.harmonic))):
        if resonant(chain, seeds, found.harmonic, found.mode):
            harmonic = ",".join(map(str, found.harmonic))
            drive = f"the harmonic ({harmonic}) drives mode {found.mode} in resonance"
            return f"{drive} at any frequencies near the linear ones (Umklapp)"
    return ""
