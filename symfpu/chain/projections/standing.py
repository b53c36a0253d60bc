"""The projections of deviations from standing waves on a ring: sines and cosines apart.

A torus of standing waves on a ring of 2N is one of fixed ends on N bonds, unfolded: odd about site
0. Odd deviations, x_j = sum Q_q sin(q pi j/N), are those of the fixed ends; even ones, cosines,
stretch the same bonds by other amounts,

    r_j = -sum Omega_q Q_q sin(q (j + 1/2) pi/N) of unit norm, q = 1 .. N,

and the two do not couple. The modes q and -q of the ring stand for them: q > 0 for the sine, -q
and N for the cosines. At rest both have Omega_q; on the torus the pair is split. The cosine q = 0,
uniform motion, is left out: nothing couples to it. Ours.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.projections.modes import ModeProjection
from symfpu.chain.projections.projection import Ints, Mask


class SineProjection(ModeProjection):
    """Odd deviations: a column for each of q = 1 .. N-1.

    ring : of the modes. chain : with fixed ends, and half of its bonds.
    """

    def __init__(
        self, ring: Chain, chain: Chain, seeds: Sequence[int], harmonics: Ints
    ) -> None:
        self.ring = ring
        super().__init__(chain, seeds, harmonics)

    @property
    def numbers(self) -> tuple[int, ...]:
        return self.ring.mode_numbers

    def column(self, q: int) -> int:
        return abs(q) - 1

    def deviating(self, q: int) -> SineProjection:
        kind = SineProjection if is_sine(self.ring, q) else CosineProjection
        if type(self) is kind:
            return self
        return kind(self.ring, self.chain, self.seeds, self.harmonics)


class CosineProjection(SineProjection):
    """Even deviations: a column for each of q = 1 .. N, the last one of half the norm squared."""

    fold = -1.0

    def _set_tables(self) -> None:
        """Sines are cosines turned by a quarter."""
        self._set_columns(self.chain.N, self.chain.N)
        self.modes = np.where(self.modes < self.chain.N, -self.modes, self.modes)

    @property
    def mask(self) -> Mask:
        """A torus of standing waves has no cosines."""
        return np.zeros((len(self.harmonics), self.columns), dtype=bool)


def is_sine(ring: Chain, q: int) -> bool:
    """Whether a mode stands for odd deviations about standing waves."""
    return 0 < 2 * q < ring.N
