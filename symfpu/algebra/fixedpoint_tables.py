"""Tables that the ring of fixed-point numbers fills piece by piece, or order by order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import HarmonicRows, Ints, extended
from symfpu.algebra.words import IntegerTable, ResidueBasis


class Factors:
    """The multipliers L_q(nu) of all orders so far: what one had, the others do not change.

    residues : (primes, count), of the first, which is zero, and of those that were met. sizes :
    (count,) their moduli.
    """

    def __init__(self, basis: ResidueBasis, bits: int, modes: int, kind: Any) -> None:
        self._basis, self._bits = basis, bits
        self._rows = HarmonicRows()
        self._numbers = np.zeros((0, modes), dtype=np.int64)
        self.residues = np.zeros((len(basis), 1), dtype=kind)
        self.sizes = np.zeros(1)

    def numbers(self, harmonics: Ints, multipliers: NDArray[np.object_]) -> Ints:
        """Which of them a table of multipliers has, (harmonics, modes)."""
        rows, carried = self._rows.of(harmonics), multipliers != 0
        self._numbers = extended(self._numbers, len(self._rows), 0)
        places, columns = np.nonzero(carried & (self._numbers[rows] == 0))
        self._numbers[rows[places], columns] = len(self.sizes) + np.arange(len(places))
        self._append(multipliers[places, columns])
        return np.where(carried, self._numbers[rows], 0)

    def _append(self, multipliers: NDArray[np.object_]) -> None:
        residues = self._basis.of_integers(multipliers).astype(self.residues.dtype)
        sizes = np.abs((multipliers / 2**self._bits).astype(np.float64))
        self.residues = np.concatenate([self.residues, residues], axis=1)
        self.sizes = np.concatenate([self.sizes, sizes])


class CollectedWords:
    """The words of all coefficients of a degree, as its pieces give them."""

    def __init__(self, order: Ints, N: int, basis: ResidueBasis) -> None:
        # lazy: numba takes longer to import than all the rest
        from symfpu.algebra.rounding_loops import put_words

        self._put = put_words
        self._order = order
        self._lengths = [1]  # of the words of pieces, which come from several threads
        self._words = np.zeros((len(order), N - 1, basis.longest_word), dtype=np.int64)

    def put(
        self,
        some: slice,
        modes: slice,
        wanted: NDArray[np.bool_],
        words: NDArray[np.int64],
    ) -> None:
        """Words (wanted, n) of some monomials."""
        columns = np.arange(self._words.shape[1])[modes]
        self._put(words, wanted, self._order[some], columns, self._words)
        self._lengths.append(words.shape[1])

    def table(self) -> IntegerTable:
        used = self._words[:, :, : max(self._lengths)]
        return IntegerTable(np.ascontiguousarray(used))
