"""Symmetry sectors of the equations linearised at a q-breather.

Solutions x_q(t) = exp(i sigma t) sum_n v_q[n] exp(i n omega t) of the linearised equations split by
the symmetries of the orbit: reflection multiplies mode q by (-1)^q, and half a period, for a seed
that is odd or a potential that is even, multiplies the slopes by a sign. Ours;
docs/stability-proofs.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain

Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Sector:
    """Places (n, q) with q = first + slope n (mod 2), every `step`-th harmonic n from `start` on.

    folds : h, the exponents of the sector count modulo h omega. trivial : whether the velocity of
        the orbit, a double multiplier 1, is in it.
    """

    N: int
    first: int
    slope: int
    start: int
    step: int
    folds: int
    trivial: bool

    @property
    def modes(self) -> list[int]:
        """Those that take part; each gives one pair of multipliers."""
        if self.slope:
            return list(range(1, self.N))
        return [q for q in range(1, self.N) if (q - self.first) % 2 == 0]

    @property
    def count(self) -> int:
        """How many exponents up to sign there are beside the double multiplier 1."""
        return len(self.modes) - int(self.trivial)

    def allowed(self, n: int) -> list[int]:
        """The modes at a harmonic."""
        if (n - self.start) % self.step:
            return []
        return [q for q in range(1, self.N) if (q - self.first - self.slope * n) % 2 == 0]

    def places(self, harmonics: int) -> tuple[Ints, Ints]:
        """Harmonics and modes of all places with |n| up to a harmonic, ascending."""
        pairs = [(n, q) for n in range(-harmonics, harmonics + 1) for q in self.allowed(n)]
        n, q = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
        return n, q


def sectors_of(chain: Chain, seed: int) -> tuple[Sector, ...]:
    """The sectors of a q-breather, that of its velocity first; none is empty."""
    N, parity = chain.N, seed % 2
    if chain.potential.even:
        own = Sector(N, parity, 0, 1, 2, 2, trivial=True)
        other = Sector(N, 1 - parity, 0, 0, 2, 2, trivial=False)
    elif parity == 0:
        own = Sector(N, 0, 0, 0, 1, 1, trivial=True)
        other = Sector(N, 1, 0, 0, 1, 1, trivial=False)
    else:
        return (Sector(N, 0, 1, 0, 1, 2, trivial=True),)
    return (own, other) if other.modes else (own,)
