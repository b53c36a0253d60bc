"""Which lines are whole combinations of others: the independent frequencies of an orbit."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_COMBINATIONS = 200_000
CHANCE = (
    0.01  # expected combinations that meet a frequency by accident, above which none counts
)
LOWEST_ORDER = 3  # to which sums are tried before a frequency is called independent
DOUBTS = 4.0  # errors that a combination may be away
LEAST_ERROR = 1e-14  # of a frequency of order 1: rounding
FURTHER = 1.15  # from one reach that is tried to the next
LONGEST_REACH = 40.0  # light ones beyond it are no lines


def combinations_within(weights: Floats, reach: float) -> Ints:
    """All nu that are not 0 with sum w_i |nu_i| <= reach; shape (M, s), light ones first."""
    table = np.zeros((1, 0), dtype=np.int64)
    sizes = np.zeros(1)
    for weight in weights:
        most = int(reach / weight)
        numbers = np.arange(-most, most + 1)
        sums = (sizes[:, None] + weight * np.abs(numbers)).ravel()
        left = np.repeat(table, len(numbers), axis=0)
        right = np.tile(numbers, len(table))[:, None]
        inside = sums <= reach
        table = np.hstack([left[inside], right[inside]])
        sizes = sums[inside]
    order = np.argsort(sizes, kind="stable")
    return np.asarray(table[order][1:])


def widest(weights: Floats, most: int) -> Ints:
    """The combinations within the greatest reach that has no more of them than that."""
    reach = float(weights.min())
    table = combinations_within(weights, reach)
    while True:
        reach *= FURTHER
        more = combinations_within(weights, reach)
        if len(more) > most or reach > LONGEST_REACH:
            return table
        table = more


@dataclass
class Basis:
    """Independent frequencies so far, with their errors, and their combinations.

    rate : 2 pi over the time between samples; frequencies are known but for multiples of it.
    weights : of each in a combination, 1 + log10 of how much weaker it is than the strongest: a
        weak frequency takes part in low sums alone.
    """

    rate: float
    frequencies: list[float] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)
    weights: list[float] = field(default_factory=list)
    table: Ints = field(default_factory=lambda: np.zeros((0, 0), dtype=np.int64))

    def add(self, frequency: float, error: float, strength: float = 1.0) -> None:
        """One more; strength : as part of the strongest."""
        self.frequencies.append(frequency)
        self.errors.append(error)
        self.weights.append(1 - math.log10(strength))
        self.table = widest(np.array(self.weights), MOST_COMBINATIONS)

    def combination(self, frequency: float, error: float) -> tuple[int, ...] | None:
        """The lightest combination that meets a frequency, if that is no accident."""
        if not self.frequencies:
            return None
        tolerances = self._tolerances(error)
        turns = (self.table @ np.array(self.frequencies) - frequency) / self.rate
        away = self.rate * np.abs(turns - np.rint(turns))
        hits = np.flatnonzero(away <= tolerances)
        if not len(hits):
            return None
        sizes = self._sizes()
        lightest = hits[sizes[hits] == sizes[hits[0]]]
        best = int(lightest[np.argmin(away[lightest])])
        if self._accidents(float(sizes[best]), tolerances) > CHANCE:
            return None
        return tuple(self.table[best].tolist())

    def can_tell(self, error: float) -> bool:
        """Whether a frequency of this error would be known for a sum of low order."""
        if not self.frequencies:
            return True
        return self._accidents(LOWEST_ORDER, self._tolerances(error)) <= CHANCE

    def _sizes(self) -> Floats:
        return np.asarray(np.abs(self.table) @ np.array(self.weights))

    def _tolerances(self, error: float) -> Floats:
        own = error + np.abs(self.table) @ np.array(self.errors)
        return np.asarray(DOUBTS * own + LEAST_ERROR)

    def _accidents(self, size: float, tolerances: Floats) -> float:
        """Combinations up to a size expected within their tolerances of any one frequency."""
        light = self._sizes() <= size
        return float(2 * tolerances[light].sum() / self.rate)
