"""Which cosine can appear in which monomial: the selection rules of products of cosines on N points.

On the points theta_j = (j + 1/2) pi / N the cosines T_q = cos(q theta), q = 0 .. N-1, are a
basis, and 2 T_l T_m = T_(l+m) + T_(l-m) with T_N = 0, T_(2N-q) = -T_q. A monomial with powers e_i
of the seeds q_i can therefore carry the modes q = +-q_1 ... +-q_1 +-q_2 ... (e_i signs for each
seed), folded into 0 .. N, and no other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Grading, Ints, compositions


def fold(number: int, N: int) -> int:
    """The wave number in 0 .. N that equals +-number modulo 2N: |2 [(|n| + N - 1) / 2N] N - |n|| of
    Eq. app.

    >>> fold(33, 32), fold(-5, 32), fold(96, 32)
    (31, 5, 32)
    """
    size = abs(number)
    return abs(2 * ((size + N - 1) // (2 * N)) * N - size)


class PowerTable:
    """For each degree, every split of it into powers of the seeds and the modes that monomials
    with these powers carry.
    """

    def __init__(self, N: int, seeds: Sequence[int], degree: int) -> None:
        self.N = N
        self._weights = np.array(
            [(degree + 1) ** i for i in reversed(range(len(seeds)))],
            dtype=object if len(seeds) > 12 else np.int64,
        )
        self._keys = [compositions(d, len(seeds)) @ self._weights for d in range(degree + 1)]
        self._residues = [np.arange(2 * N)[None, :] == 0]
        columns = np.arange(2 * N)
        for d in range(1, degree + 1):
            powers = compositions(d, len(seeds))
            first = np.argmax(powers > 0, axis=1)
            residues = np.empty((len(powers), 2 * N), dtype=np.bool_)
            # one more factor of the first seed present: its wave number with either sign
            for i, q in enumerate(seeds):
                rows = np.flatnonzero(first == i)
                lower = self._residues[d - 1][
                    np.searchsorted(self._keys[d - 1], self._keys[d][rows] - self._weights[i])
                ]
                residues[rows] = (
                    lower[:, (columns - q) % (2 * N)] | lower[:, (columns + q) % (2 * N)]
                )
            self._residues.append(residues)

    def carried(self, degree: int, powers: Ints) -> NDArray[np.bool_]:
        """Whether a monomial with these powers can carry mode q = 1 ..

        N-1; shape (count, N-1).
        """
        return np.asarray(
            self._residues[degree][
                np.searchsorted(self._keys[degree], powers @ self._weights), 1 : self.N
            ]
        )


def product_modes_of_seeds(N: int, seeds: Sequence[int], powers: Ints) -> NDArray[np.bool_]:
    """Whether the plain product of the seeds' cosines with these powers contains cosine q = 1 ..
    N-1, exactly.

    Counts the signed sums: q and 2N +- q enter with opposite signs and can cancel, as for l + m =
    N in a triple product.
    powers : (count, s), small. Returns (count, N-1).
    """
    turn, angles = 4 * N, np.arange(4 * N)
    result = np.empty((len(powers), N - 1), dtype=np.bool_)
    q = np.arange(1, N)
    for row, power in enumerate(powers):
        counts = (angles == 0).astype(np.int64)
        for seed, e in zip(seeds, power, strict=True):
            for _ in range(int(e)):
                counts = counts[(angles - seed) % turn] + counts[(angles + seed) % turn]
        result[row] = counts[q] + counts[turn - q] != counts[2 * N - q] + counts[2 * N + q]
    return result


class CosineModes:
    """Modes q = 1 .. N-1 on N bonds with the monomials of a grading: parities, cosines and selection
    masks.

    A monomial is even or odd with sum_i e_i q_i. It carries modes of that parity only, and its
    value on bond N-1-j is that on bond j times the parity: half of the bonds are enough.
    """

    def __init__(
        self, N: int, seeds: Sequence[int], grading: Grading, product_degree: int | None = None
    ) -> None:
        """product_degree : a degree whose terms are plain products of the seeds: there cancelling
        couplings are exact zeros.
        """
        self.N, self.seeds, self.grading, self.product_degree = (
            N,
            tuple(seeds),
            grading,
            product_degree,
        )
        self.half = (N + 1) // 2
        self._table = PowerTable(N, seeds, grading.degree)

    def parity(self, degree: int) -> Ints:
        """0 or 1 for each canonical monomial of a degree."""
        return np.asarray(self.grading.powers(degree) @ np.array(self.seeds) % 2)

    def mask(self, degree: int) -> NDArray[np.bool_]:
        """Whether a canonical monomial of this degree can carry a mode.

        Shape (canonical, N-1).
        """
        powers = self.grading.powers(degree)
        if degree == self.product_degree:
            return product_modes_of_seeds(self.N, self.seeds, powers)
        return self._table.carried(degree, powers)

    def mask_by_harmonic(self, degree: int) -> NDArray[np.bool_]:
        """Whether a harmonic can appear in a mode at this degree; shape (harmonics, N-1)."""
        nu, index = self.grading.harmonics(degree)
        order = np.argsort(index, kind="stable")
        starts = np.searchsorted(index[order], np.arange(len(nu)))
        return np.asarray(np.logical_or.reduceat(self.mask(degree)[order], starts, axis=0))
