"""The first orbit of the family from rest that has a given energy, amplitude or frequency."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.crossings import Gap, beside
from symfpu.breathers.curve import (
    Along,
    NotOnTheCurve,
    Point,
    alike,
    corrected,
    disagreement,
    more_harmonics,
    point_at,
    resolved,
    with_harmonics,
)
from symfpu.breathers.equations import Balance, NoPeriodicOrbit
from symfpu.breathers.from_rest import FromRest
from symfpu.chain.chain import Chain

Floats = NDArray[np.float64]
LOWEST = 400  # halvings of the amplitude of the first orbit
HALVINGS = 12  # of a segment in which what is asked for may turn
NEARLY = 1e-2  # of what is asked for: how far below it a segment may seem to turn
SAME = 1e-9  # of the largest coefficient: distance of orbits that are one to rounding
SECANTS, SECANT_TOLERANCE = 30, 1e-3  # for the amplitude beside a gap


@dataclass(frozen=True)
class EnergyGoal:
    """H, or with `harmonic` the sum of E_q, at t = 0: momenta vanish there.

    A goal is what is asked of an orbit, a number that is 0 at rest. target : not 0. value : of the
    orbit z; slope : its derivative along a direction.
    """

    chain: Chain
    target: float
    harmonic: bool = False

    def value(self, balance: Balance, z: Floats) -> float:
        """The energy."""
        Q = balance.cosines(z).sum(axis=0)
        if self.harmonic:
            return float(self.chain.frequencies() ** 2 @ Q**2) / 2
        return float(self.chain.energy(Q, np.zeros_like(Q)))

    def slope(self, balance: Balance, z: Floats, direction: Floats) -> float:
        """Its derivative."""
        Q = balance.cosines(z).sum(axis=0)
        linear = self.chain.frequencies() ** 2 * Q
        gradient = linear if self.harmonic else -self.chain.accelerations(Q)
        return float(gradient[balance.q] @ direction[:-1])


@dataclass(frozen=True)
class AmplitudeGoal:
    """A of the seed, or with `detuning` sigma = omega^2 - Omega^2."""

    target: float
    detuning: bool = False

    def _place(self, balance: Balance) -> int:
        return -1 if self.detuning else balance.first

    def value(self, balance: Balance, z: Floats) -> float:
        """The amplitude."""
        return float(z[self._place(balance)])

    def slope(self, balance: Balance, z: Floats, direction: Floats) -> float:
        """Its derivative."""
        return float(direction[self._place(balance)])


Goal = EnergyGoal | AmplitudeGoal


def first_passage(walk: FromRest, goal: Goal) -> Point:
    """The orbit at which the walk first has the target; NoPeriodicOrbit where it never has."""
    try:
        return _first(walk, goal)
    except NotOnTheCurve as failure:
        last = walk.points[-1]
        raise NoPeriodicOrbit(last.balance, failure.reason, last.z) from failure


def _first(walk: FromRest, goal: Goal) -> Point:
    if point := _near_rest(walk, goal):
        return point
    points = iter(walk)
    next(points)
    for k, found in enumerate(points):
        gap = walk.gap_after(k)
        if gap is None:
            point = within(walk.points[k], found, goal, HALVINGS)
        else:
            point = beside_gap(walk.points[k], found, goal, gap)
        if point:
            return point
    raise AssertionError  # the walk ends with NoPeriodicOrbit


def _short(point: Point, goal: Goal) -> float:
    """By how much a point is below the target, relative to it."""
    return 1 - goal.value(point.balance, point.z) / goal.target


def _met(goal: Goal, balance: Balance) -> Along:
    """How far along the tangent the target is met."""

    def along(z: Floats, tangent: Floats) -> float:
        missing = goal.target - goal.value(balance, z)
        return missing / goal.slope(balance, z, tangent)

    return along


def _near_rest(walk: FromRest, goal: Goal) -> Point | None:
    """The orbit below the first of the walk; None if the target is beyond."""
    if _short(walk.points[0], goal) >= 0:
        return None
    high = walk.points[0]
    for parts in range(1, LOWEST):
        low = walk.lowered(parts)
        if _short(low, goal) >= 0:
            return within(low, high, goal, HALVINGS)
        high = low
    raise NoPeriodicOrbit(high.balance, "the linear mode has it alone", high.z)


def within(start: Point, end: Point, goal: Goal, halvings: int = HALVINGS) -> Point | None:
    """The first orbit between two neighbours that has the target; None if there is none."""
    start, end = alike(start, end)
    before, after = _short(start, goal), _short(end, goal)
    if before == 0:
        return start
    rates = [-goal.slope(p.balance, p.z, p.tangent) / goal.target for p in (start, end)]
    length = _length(start, end)
    cubic = Cubic(before, after, rates[0] * length, rates[1] * length)
    if after > 0:
        turns = rates[0] < 0 < rates[1]
        if not turns or not halvings:
            return None
        if min(cubic(s) for s in np.linspace(0, 1, 65)) > NEARLY:
            return None
        middle = at_part(start, end, 0.5)
        for pair in pairwise((start, middle, end)):
            if point := within(*pair, goal, halvings - 1):
                return point
        return None
    try:
        return _solved(start, end, goal, _root(cubic))
    except NotOnTheCurve as failure:
        if not halvings:
            raise NoPeriodicOrbit(start.balance, failure.reason, start.z) from failure
    middle = at_part(start, end, 0.5)
    return within(start, middle, goal, halvings - 1) or within(
        middle, end, goal, halvings - 1
    )


def _length(start: Point, end: Point) -> float:
    """Of the curve between neighbours."""
    tangents = start.tangent[:-1] + end.tangent[:-1]
    return float(2 * (end.z - start.z)[:-1] @ tangents / (tangents @ tangents))


class Cubic:
    """A cubic on 0 .. 1 by values and slopes at both ends, numbers or vectors."""

    def __init__(self, y0: Any, y1: Any, slope0: Any, slope1: Any) -> None:
        self.terms = (y0, slope0, 3 * (y1 - y0) - 2 * slope0 - slope1)
        self.last = 2 * (y0 - y1) + slope0 + slope1

    def __call__(self, s: float) -> Any:
        a, b, c = self.terms
        return a + s * (b + s * (c + s * self.last))


def _root(cubic: Cubic) -> float:
    """The first zero on 0 .. 1, of a cubic that is positive at 0 and not at 1."""
    from scipy.optimize import brentq

    if cubic(1.0) >= 0:
        return 1.0
    return float(brentq(cubic, 0.0, 1.0))


def _guess(start: Point, end: Point, part: float) -> Floats:
    length = _length(start, end)
    curve = Cubic(start.z, end.z, length * start.tangent, length * end.tangent)
    return np.asarray(curve(part))


def at_part(start: Point, end: Point, part: float) -> Point:
    """The orbit about a part of the way between neighbours."""
    guess, balance = _guess(start, end, part), start.balance
    z, steps, _ = corrected(balance, guess, start.linearised())
    found = point_at(balance, z, start.tangent, steps)
    require_between(start, found, end)
    return found


def _solved(start: Point, end: Point, goal: Goal, part: float) -> Point:
    """The orbit of the target between neighbours; NotOnTheCurve where it is not between them."""
    while True:
        balance, guess = start.balance, _guess(start, end, part)
        linear = (start if part < 0.5 else end).linearised()
        z, steps, linear = corrected(balance, guess, linear, _met(goal, balance))
        if resolved(balance, z):
            break
        harmonics = more_harmonics(balance, z)
        start, end = with_harmonics(start, harmonics), with_harmonics(end, harmonics)
    found = point_at(balance, z, start.tangent, steps, linear)
    require_between(start, found, end)
    return found


def require_between(start: Point, found: Point, end: Point) -> None:
    """NotOnTheCurve for an orbit that does not fit the curve between two of its points.

    An orbit that is one of the two to rounding fits: a step of that length has no direction.
    """
    for first, second in ((start, found), (found, end)):
        distance = np.abs(second.z - first.z).max()
        if distance <= SAME * np.abs(first.z).max():
            continue
        if reason := disagreement(first, second):
            raise NotOnTheCurve(reason, found)


def beside_gap(start: Point, end: Point, goal: Goal, gap: Gap) -> Point | None:
    """The orbit of the target between two points on both sides of a narrow gap; None without."""
    if _short(end, goal) > 0:
        return None
    balance, low, high = gap.balance, start.amplitude, end.amplitude
    short = [_short(start, goal), _short(end, goal)]
    A, z = low, start.z
    for _ in range(SECANTS):
        A = low + (high - low) * short[0] / (short[0] - short[1])
        z = beside(gap, A)
        now = 1 - goal.value(balance, z) / goal.target
        if abs(now) < SECANT_TOLERANCE * gap.width:
            break
        low, high = (A, high) if now > 0 else (low, A)
        short = [now, short[1]] if now > 0 else [short[0], now]

    towards = np.zeros(len(z))
    towards[balance.first] = end.amplitude - start.amplitude
    try:
        z, steps, linear = corrected(balance, z, gap.held.linear, _met(goal, balance))
        return point_at(balance, z, towards, steps, linear)
    except NotOnTheCurve as failure:
        reason = f"it lies in the gap of harmonic {gap.harmonic} of mode {gap.mode}"
        raise NoPeriodicOrbit(balance, reason, z) from failure
