"""Coefficients of tori with fixed ends and of a ring alike, and guesses on the line through two."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from symfpu.refinement.equation import Floats, Ints
from symfpu.refinement.refined_torus import RefinedTorus
from symfpu.refinement.ring_tori import RefinedRingTorus
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.travelling import wave_coefficients

FamilyTorus: TypeAlias = RefinedTorus | RefinedRingTorus


def coefficients_of(torus: QuasiPeriodic | RingTorus) -> tuple[Ints, Floats]:
    """Harmonics (H, s) and coefficients (H, C): of each mode, or the one of travelling waves."""
    if isinstance(torus, RingTorus):
        return wave_coefficients(torus)
    return torus.harmonics, torus.cosines


def coefficients_at(harmonics: Ints, torus: QuasiPeriodic | RingTorus) -> Floats:
    """Coefficients at these harmonics (H, s), 0 where the torus has none; (H, C)."""
    known, table = coefficients_of(torus)
    rows = {tuple(nu): row for nu, row in zip(known.tolist(), table, strict=True)}
    nothing = 0 * table[0]
    return np.array([rows.get(tuple(nu), nothing) for nu in harmonics.tolist()])


def extrapolated(
    before: QuasiPeriodic | RingTorus, last: QuasiPeriodic | RingTorus, ratio: float
) -> FourierTorus | RingTorus:
    """The guess on the line through two tori, `ratio` of their distance beyond the second."""
    omega = zip(before.frequencies, last.frequencies, strict=True)
    frequencies = tuple(b + Fraction(ratio) * (b - a) for a, b in omega)
    if isinstance(last, RingTorus):
        return _waves(before, last, ratio, frequencies)
    earlier = coefficients_at(last.harmonics, before)
    cosines = last.cosines + ratio * (last.cosines - earlier)
    phases = dict(last.phases)
    return FourierTorus(
        last.chain, last.seeds, frequencies, last.harmonics, cosines, phases
    )


def _waves(
    before: QuasiPeriodic | RingTorus,
    last: RingTorus,
    ratio: float,
    frequencies: tuple[Fraction, ...],
) -> RingTorus:
    """Waves b of equal harmonics."""
    assert isinstance(before, RingTorus)
    known = dict(zip(map(tuple, before.harmonics.tolist()), before.sines, strict=True))
    there = [known.get(tuple(nu), 0.0) for nu in last.harmonics.tolist()]
    sines = last.sines + ratio * (last.sines - np.array(there))
    return replace(last, frequencies=frequencies, sines=sines)


def in_doubles(torus: QuasiPeriodic | RingTorus) -> QuasiPeriodic | RingTorus:
    """The torus without digits; of a ring none has them."""
    return torus if isinstance(torus, RingTorus) else torus.in_doubles()
