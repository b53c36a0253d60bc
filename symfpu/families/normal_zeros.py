"""Zeros of functions of a place on a curve of tori, where Newton's method does not lead to them.

What two normal frequencies make cannot be computed next to where they meet: zeros are interpolated
from both sides, or the way is halved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from symfpu.normal.modes import NoNormalModes
from symfpu.refinement.tori import NoTorus

PLACE = 1e-12  # of the way, to which the crossing of a resonance is located
SHARE = 0.2  # of the bracket, that the points about an estimate reach out to
ROUNDS = 6  # of estimates, each with a point on either side
NODES = (-1.0, -0.6, -0.3, 0.3, 0.6, 1.0)  # of the last estimate, in units of the gap
NARROWED = 1e-7  # of the way, to which it is halved where D is too small to interpolate
NOISE = 1e-10  # of D, below which its sign says nothing

Failed = (NoTorus, NoNormalModes)


class Outside(Exception):
    """An estimate of a zero leaves the places between which it is."""


def zero_of(
    function: Callable[[float], float], low: float, high: float, ends: tuple[float, ...]
) -> float:
    """Where a function changes its sign, by Brent's secants."""
    from scipy.optimize import brentq

    known = dict(zip((low, high), ends, strict=True))

    def value(part: float) -> float:
        if part not in known:
            known[part] = function(part)
        return known[part]

    return float(brentq(value, low, high, xtol=PLACE))


def located(
    D: Callable[[float], float],
    low: float,
    high: float,
    ends: tuple[float, ...],
    least: float,
) -> tuple[float, float]:
    """As `collision`, between halves of the way where it leads out of it or D is too small.

    So are the ends of a narrow tongue, and of a short piece; then the error is what is left.
    """
    width = NARROWED * (high - low)
    while high - low > width:
        try:
            if min(map(abs, ends)) > least:
                return collision(D, low, high, ends, least)
        except (*Failed, Outside):
            pass
        middle = (low + high) / 2
        value = D(middle)
        if abs(value) < NOISE:
            return middle, high - low
        first, second = ends
        if (value < 0) == (first < 0):
            low, ends = middle, (value, second)
        else:
            high, ends = middle, (first, value)
    return (low + high) / 2, high - low


def collision(
    D: Callable[[float], float],
    low: float,
    high: float,
    ends: tuple[float, ...],
    least: float,
) -> tuple[float, float]:
    """The zero of a smooth function that cannot be computed where |D| < least, and its error.

    By secants of higher order: the inverse interpolation through points on both sides, drawn
    together until they stand at the least |D|. The error is what two points fewer change. Raises
    Outside.
    """
    known = dict(zip((low, high), ends, strict=True))
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
