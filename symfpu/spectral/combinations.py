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
DOUBTFUL = 0.1  # the same, up to which a light combination leaves a frequency in doubt
LIGHT = 6.0  # the size of such a combination
LOWEST_ORDER = 3  # to which sums are tried before a frequency is called independent
DOUBTS = 4.0  # errors that a combination may be away
LEAST_ERROR = 1e-14  # of a frequency of order 1: rounding
FURTHER = 1.15  # from one reach that is tried to the next
LONGEST_REACH = 40.0  # light ones beyond it are no lines


@dataclass(frozen=True, eq=False)
class Combinations:
    """All nu with sum w_i |nu_i| <= reach, 0 among them, light ones first.

    table : nu; shape (M, s). sizes : sum w_i |nu_i|, rising; (M,). sums : nu.omega; (M,).
    doubts : sum |nu_i| e_i, e the errors of omega; (M,).
    """

    reach: float
    table: Ints
    sizes: Floats
    sums: Floats
    doubts: Floats

    def number_within(self, reach: float, weight: float) -> int:
        """How many there are with one more frequency of this weight; counted, not made."""
        rest = reach - weight * np.abs(_numbers(reach / weight))
        return int(np.searchsorted(self.sizes, rest, side="right").sum())

    def extended(
        self, reach: float, weight: float, frequency: float, error: float
    ) -> Combinations:
        """With one more frequency, within a reach that is no longer."""
        numbers = _numbers(reach / weight)
        sizes = self.sizes[:, None] + weight * np.abs(numbers)
        rows, places = np.nonzero(sizes <= reach)
        order = np.argsort(sizes[rows, places], kind="stable")
        rows, places = rows[order], places[order]
        last = numbers[places]
        return Combinations(
            reach,
            np.hstack([self.table[rows], last[:, None]]),
            sizes[rows, places],
            self.sums[rows] + frequency * last,
            self.doubts[rows] + error * np.abs(last),
        )

    def widest(
        self, weight: float, most: int, frequency: float, error: float
    ) -> Combinations:
        """With one more frequency, within the greatest reach that has no more than that."""
        for reach in reversed(REACHES):
            if reach > self.reach:
                continue
            if self.number_within(reach, weight) <= most + 1:
                return self.extended(reach, weight, frequency, error)
        return self.extended(REACHES[0], weight, frequency, error)


def _numbers(most: float) -> Ints:
    return np.arange(-int(most), int(most) + 1, dtype=np.int16)


def _reaches() -> list[float]:
    found = [1.0]
    while found[-1] * FURTHER <= LONGEST_REACH:
        found.append(found[-1] * FURTHER)
    return found


REACHES = _reaches()


def nothing(reach: float = REACHES[-1]) -> Combinations:
    """Of no frequency: the empty sum."""
    zero = np.zeros(1)
    return Combinations(reach, np.zeros((1, 0), dtype=np.int16), zero, zero, zero)


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
    known: Combinations = field(default_factory=nothing)

    def add(self, frequency: float, error: float, strength: float = 1.0) -> None:
        """One more; strength : as part of the strongest."""
        self.frequencies.append(frequency)
        self.errors.append(error)
        self.weights.append(1 - math.log10(strength))
        self.known = self.known.widest(
            self.weights[-1], MOST_COMBINATIONS, frequency, error
        )

    def combination(self, frequency: float, error: float) -> tuple[int, ...] | None:
        """The lightest combination that meets a frequency, if that is no accident."""
        nu, accidents = self._met(frequency, error)
        return nu if accidents <= CHANCE else None

    def meeting(self, reach: float) -> float:
        """The distance of two light combinations within reach, if that is no accident; else 0.

        Of the lightest two: they are apart by a third, which is near zero.
        """
        known = self.known
        light = int(np.searchsorted(known.sizes, LIGHT, side="right"))
        turns = known.sums[1:light] / self.rate
        away = self.rate * np.abs(turns - np.rint(turns))
        hits = np.flatnonzero(away <= reach)
        if not len(hits):
            return 0.0
        lighter = int(np.searchsorted(known.sizes, known.sizes[1 + hits[0]], side="right"))
        accidents = reach * (lighter - 1) / self.rate  # nu and -nu are one
        return float(away[hits[0]]) if accidents <= DOUBTFUL else 0.0

    def is_independent(self, frequency: float, error: float) -> bool:
        """Whether no light combination meets a frequency, and one of low order could be told.

        Where an accident is neither likely nor unlikely, as for a weak line of a short orbit, the
        line may be that combination: it has no name, and adds no frequency.
        """
        if not self.frequencies:
            return True
        nu, accidents = self._met(frequency, error)
        size = math.inf if nu is None else float(np.abs(nu) @ self.weights)
        doubtful = size <= LIGHT and accidents <= DOUBTFUL
        return not doubtful and self._accidents(LOWEST_ORDER, error) <= CHANCE

    def _met(self, frequency: float, error: float) -> tuple[tuple[int, ...] | None, float]:
        """The lightest combination that meets a frequency, and how many would by accident."""
        if not self.frequencies:
            return None, math.inf
        known = self.known
        turns = (known.sums - frequency) / self.rate
        away = self.rate * np.abs(turns - np.rint(turns))
        away[0] = math.inf  # the empty sum is no name
        hits = np.flatnonzero(away <= self._tolerances(error))
        if not len(hits):
            return None, math.inf
        lightest = hits[known.sizes[hits] == known.sizes[hits[0]]]
        best = int(lightest[np.argmin(away[lightest])])
        accidents = self._accidents(float(known.sizes[best]), error)
        return tuple(self.known.table[best].tolist()), accidents

    def _tolerances(self, error: float) -> Floats:
        return np.asarray(DOUBTS * (error + self.known.doubts) + LEAST_ERROR)

    def _accidents(self, size: float, error: float) -> float:
        """Combinations up to a size expected within their tolerances of any one frequency."""
        light = int(np.searchsorted(self.known.sizes, size, side="right"))
        each = DOUBTS * (error + self.known.doubts[1:light]) + LEAST_ERROR
        return float(2 * each.sum() / self.rate)
