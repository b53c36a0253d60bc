"""Zeros of functions of a place on a curve of tori, where Newton's method does not lead to them.

What two normal frequencies make cannot be computed next to where they meet: zeros are interpolated
from both sides, or the way is halved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from symfpu.normal.modes import NoNormalModes
from symfpu.refinement.tori import NoTorus

EPS = float(np.finfo(float).eps)
PLACE = 1e-12  # of the way, to which the crossing of a resonance is located
SHARE = 0.2  # of the bracket, that the points about an estimate reach out to
ROUNDS = 6  # of estimates, each with a point on either side
NODES = (-1.0, -0.6, -0.3, 0.3, 0.6, 1.0)  # of the last estimate, in units of the gap
NARROWED = 1e-7  # of the way, to which it is halved where D is too small to interpolate
NOISE = 1e-10  # of D, below which its sign says nothing

Failed = (NoTorus, NoNormalModes)


class Outside(Exception):
    """An estimate of a zero leaves the places between which it is."""


class Bracket(NamedTuple):
    """Two places of a curve, and what a function is there, of opposite signs."""

    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def width(self) -> float:
        return self.high - self.low

    @property
    def least(self) -> float:
        """The smaller size of the two values."""
        return min(abs(self.at_low), abs(self.at_high))

    @property
    def largest(self) -> float:
        """The larger one."""
        return max(abs(self.at_low), abs(self.at_high))

    def secant(self) -> float:
        """Where the function is zero if it is linear."""
        return self.low + self.width * self.at_low / (self.at_low - self.at_high)

    def half(self, middle: float, value: float) -> Bracket:
        """The half in which the sign changes."""
        if (value < 0) == (self.at_low < 0):
            return self._replace(low=middle, at_low=value)
        return self._replace(high=middle, at_high=value)

    def beside(self) -> float:
        """Where it is zero if it is a parabola that is least at the end where it is negative."""
        below, above = sorted((self.at_low, self.at_high))
        part = float(np.sqrt(below / (below - above)))
        if self.at_high < 0:
            return self.high - self.width * part
        return self.low + self.width * part

    def error(self, place: float, of_value: float) -> float:
        """Of the place of a zero between the two, from the flatter side."""
        before = abs(self.at_low) / (place - self.low)
        after = abs(self.at_high) / (self.high - place)
        slope = min(before, after)
        return max(of_value / slope, EPS) if slope else self.width


def zero_of(function: Callable[[float], float], bracket: Bracket) -> float:
    """Where a function changes its sign, by Brent's secants."""
    from scipy.optimize import brentq

    low, high = bracket.low, bracket.high
    known = {low: bracket.at_low, high: bracket.at_high}

    def value(part: float) -> float:
        if part not in known:
            known[part] = function(part)
        return known[part]

    return float(brentq(value, low, high, xtol=PLACE))


def located(
    D: Callable[[float], float], bracket: Bracket, least: float
) -> tuple[float, float]:
    """As `collision`, between halves of the way where it leads out of it or D is too small.

    So are the ends of a narrow tongue, and of a short piece; then the error is what is left.
    """
    width = NARROWED * bracket.width
    while bracket.width > width:
        try:
            if bracket.least > least:
                return collision(D, bracket, least)
        except (*Failed, Outside):
            pass
        middle = (bracket.low + bracket.high) / 2
        value = D(middle)
        if abs(value) < NOISE:
            return middle, bracket.width
        bracket = bracket.half(middle, value)
    return (bracket.low + bracket.high) / 2, bracket.width


def collision(
    D: Callable[[float], float], bracket: Bracket, least: float
) -> tuple[float, float]:
    """The zero of a smooth function that cannot be computed where |D| < least, and its error.

    By secants of higher order: the inverse interpolation through points on both sides, drawn
    together until they stand at the least |D|. The error is what two points fewer change. Raises
    Outside.
    """
    low, high = bracket.low, bracket.high
    known = {low: bracket.at_low, high: bracket.at_high}
    best = _inverse(known)
    for _ in range(ROUNDS):
        if not low < best < high:
            raise Outside
        slope = _slope(known, best)
        room = SHARE * min(best - low, high - best, key=abs)
        nearest = min(least / slope, room)
        reach = max(nearest, min(room, SHARE * _spread(known, best)))
        for part in (best - reach, best + reach):
            known[part] = D(part)
        before, best = best, _inverse(_closest(known, best, 4))
        if reach <= nearest and abs(best - before) < reach / 2:
            break
    known = {best + x * reach / min(map(abs, NODES)) / 3: 0.0 for x in NODES}
    known = {part: D(part) for part in known}
    fewer = _inverse(_closest(known, best, len(NODES) - 2))
    best = _inverse(known)
    return best, abs(best - fewer)


def _inverse(known: Mapping[float, float]) -> float:
    """The place as a polynomial of the value, at the value 0 (Lagrange)."""
    total = 0.0
    for part, value in known.items():
        others = [other for other in known.values() if other != value]
        total += part * float(np.prod([b / (b - value) for b in others]))
    return total


def _closest(known: Mapping[float, float], best: float, count: int) -> dict[float, float]:
    near = sorted(known, key=lambda part: abs(part - best))[:count]
    return {part: known[part] for part in near}


def _slope(known: Mapping[float, float], best: float) -> float:
    (a, x), (b, y) = _closest(known, best, 2).items()
    return abs((y - x) / (b - a))


def _spread(known: Mapping[float, float], best: float) -> float:
    return max(abs(part - best) for part in _closest(known, best, 2))
