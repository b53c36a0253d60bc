"""Which mode a direction continues, by its coefficients, and whether two directions are one.

The main coefficient of a direction, that of its mode without any angle, is near 1 at rest. Where
modes mix it may be smaller than that of another mode at some nu.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from symfpu.normal.modes import NormalMode
from symfpu.normal.reduction import SURE
from symfpu.tori.torus import Torus

SAME = 1e-9  # difference of two frequencies that are one
ALIKE = 1e-3  # relative difference of one coefficient of one solution, in other harmonics
# part of the main coefficient from which another mode may be the one that a direction continues
RIVAL = 0.5


class Names:
    """The modes after which directions of one torus are named."""

    def __init__(self, torus: Torus) -> None:
        self._modes = torus.chain.mode_numbers
        self._normal = [q for q in self._modes if q not in torus.seeds]
        self._travels = torus.travels

    def share(self, found: NormalMode) -> float:
        """The main coefficient, of an eigenfunction of norm 1."""
        still = int(np.flatnonzero((found.harmonics == 0).all(axis=1))[0])
        return float(abs(found.coefficients[still, self._modes.index(found.mode)]))

    def _sizes(self, found: NormalMode) -> dict[int, float]:
        """The largest coefficient of each normal mode."""
        largest = np.abs(found.coefficients).max(axis=0)
        sizes = dict(zip(self._modes, largest.tolist(), strict=True))
        return {q: sizes[q] for q in self._normal}

    def rivals(self, found: NormalMode) -> set[int]:
        """Other modes that the direction might continue: nearly as large in it, or larger."""
        least = RIVAL * self.share(found)
        others = {q for q, size in self._sizes(found).items() if size > least}
        return others - {found.mode}

    def is_others(self, found: NormalMode) -> bool:
        """Whether a direction has become that of another mode."""
        sizes = self._sizes(found)
        largest = max(sizes, key=lambda q: sizes[q])
        least = max(SURE, self.share(found))
        return largest != found.mode and sizes[largest] > least

    def told(self, found: NormalMode) -> bool:
        """Whether the main coefficient alone says which mode it is."""
        return self.share(found) > SURE and not self.is_others(found)

    def twin(self, found: NormalMode, others: Iterable[NormalMode]) -> NormalMode | None:
        """One of the others that is the same solution, shifted by a harmonic or conjugate.

        Of a hyperbolic mode the partner in a quartet, nu.omega - conj(sigma), is none: it has two
        more solutions.
        """
        for other in others:
            if found.mode != other.mode and self._same(found, other):
                return other
        return None

    def _same(self, found: NormalMode, other: NormalMode) -> bool:
        """Whether a solution has the frequency of another, or its negative, in that one's mode."""
        if found.growth or other.growth:
            return self._same_growing(found, other)
        sigma, q = complex(other.sigma).real, other.mode
        opposite = -q if self._travels and -q in self._modes else q
        for mode, signed in ((q, sigma), (opposite, -sigma)):
            column = np.abs(found.coefficients[:, self._modes.index(mode)])
            rate = found.rate(int(np.argmax(column)))
            if column.any() and abs(rate - signed) < SAME:
                return True
        return False

    def _same_growing(self, found: NormalMode, other: NormalMode) -> bool:
        """Whether a hyperbolic solution has another's main coefficient at that one's frequency."""
        if abs(found.growth - other.growth) > SAME:
            return False
        column = np.abs(found.coefficients[:, self._modes.index(other.mode)])
        main = self.share(other)
        alike = np.abs(column - main) < ALIKE * main
        rates = complex(found.sigma).real + found.rates
        near = np.abs(rates - complex(other.sigma).real) < SAME
        return bool((alike & near).any())
