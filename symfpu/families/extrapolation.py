"""Guesses of tori on the line through two others."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from symfpu.refinement.equation import Floats, Ints
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus


def extrapolated(before: QuasiPeriodic, last: QuasiPeriodic, ratio: float) -> FourierTorus:
    """The guess on the line through two tori, `ratio` of their distance beyond the second."""
    earlier = cosines_at(last.harmonics, before, 0 * last.cosines[0])
    cosines = last.cosines + ratio * (last.cosines - earlier)
    omega = zip(before.frequencies, last.frequencies, strict=True)
    frequencies = tuple(b + Fraction(ratio) * (b - a) for a, b in omega)
    phases = dict(last.phases)
    return FourierTorus(
        last.chain, last.seeds, frequencies, last.harmonics, cosines, phases
    )


def cosines_at(harmonics: Ints, torus: QuasiPeriodic, missing: Floats) -> Floats:
    """The cosines of a torus at these harmonics, (H, s); a row `missing` where it has none."""
    rows = {tuple(nu): i for i, nu in enumerate(torus.harmonics.tolist())}
    wanted = map(tuple, harmonics.tolist())
    found = [torus.cosines[rows[nu]] if nu in rows else missing for nu in wanted]
    return np.array(found)


def waves_extrapolated(before: RingTorus, last: RingTorus, ratio: float) -> RingTorus:
    """The guess on the line through two tori of waves, `ratio` of their distance beyond."""
    known = dict(zip(map(tuple, before.harmonics.tolist()), before.sines, strict=True))
    earlier: Floats = np.array(
        [known.get(tuple(nu), 0.0) for nu in last.harmonics.tolist()]
    )
    pairs = zip(before.frequencies, last.frequencies, strict=True)
    exact_part = Fraction(ratio)
    frequencies = tuple(b + exact_part * (b - a) for a, b in pairs)
    return replace(
        last, frequencies=frequencies, sines=last.sines + ratio * (last.sines - earlier)
    )
