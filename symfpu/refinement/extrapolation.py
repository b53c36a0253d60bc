"""Coefficients of tori with fixed ends and of a ring alike, and guesses on the line through two."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from symfpu.refinement.lattice import Floats, Ints
from symfpu.tori.torus import Torus


def coefficients_at(harmonics: Ints, torus: Torus) -> Floats:
    """Coefficients at these harmonics (H, s), 0 where the torus has none; (H, C)."""
    pairs = zip(torus.harmonics.tolist(), torus.cosines, strict=True)
    rows = {tuple(nu): row for nu, row in pairs}
    nothing = 0 * torus.cosines[0]
    return np.array([rows.get(tuple(nu), nothing) for nu in harmonics.tolist()])


def extrapolated(before: Torus, last: Torus, ratio: float) -> Torus:
    """The guess on the line through two tori, `ratio` of their distance beyond the second."""
    omega = zip(before.frequencies, last.frequencies, strict=True)
    frequencies = tuple(b + Fraction(ratio) * (b - a) for a, b in omega)
    earlier = coefficients_at(last.harmonics, before)
    cosines = last.cosines + ratio * (last.cosines - earlier)
    phases = dict(last.phases)
    return Torus(
        last.chain,
        last.seeds,
        frequencies,
        last.harmonics,
        cosines,
        phases,
        travels=last.travels,
    )
