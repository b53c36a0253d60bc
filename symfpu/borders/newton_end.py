"""How far Newton's method follows the tori of a ray, and where they lose their stability."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.borders.point import ENERGY, Ray
from symfpu.breathers.floquet import floquet
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.search import normal_modes
from symfpu.refinement.tori import (
    NoTorus,
    RefinedTorus,
    refine_at_amplitudes,
    refine_at_energy,
)
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import short

FACTOR = 1.5  # of the place, at most, from one torus to the next
STABILITY_WIDTH = 1.02  # ratio of the places between which stability is lost
LEAST_FACTOR = 1.01  # a step below which the torus before is the last
TOLERANCE = 1e-9  # of the residual, as of what `normal_modes` takes
MOST_HARMONICS = 800
NEWTON, STABILITY = "newton", "stability"
TOO_MANY = "more harmonics than allowed"
NOT_FOLLOWED = "followed as far as asked"
SEARCH_ENDS = (TOO_MANY, NOT_FOLLOWED)


@dataclass(frozen=True, eq=False)
class RefinedPoint:
    """A torus of Newton's method on a ray."""

    place: float
    torus: RefinedTorus

    def record(self) -> dict[str, Any]:
        """As JSON holds it."""
        return {
            "place": short(self.place),
            "energy": short(float(self.torus.energy())),
            "amplitudes": [short(float(A)) for A in self.torus.amplitudes.values()],
            "frequencies": [round(float(w), 12) for w in self.torus.frequencies],
            "harmonics": len(self.torus.harmonics),
            "residual": short(float(self.torus.residual())),
        }


@dataclass(frozen=True, eq=False)
class NewtonEnd:
    """The last torus of a ray, and what stands in the way of the next.

    reason : of Newton's method; TOO_MANY and NOT_FOLLOWED are limits of the search, not of the
    tori. turns : the amplitude or frequency that grows fastest there, as d ln / d ln place.
    points : of all tori. first_unstable : the places of the last stable and first unstable one.
    """

    reason: str
    above: float
    points: tuple[RefinedPoint, ...] = field(repr=False)
    first_unstable: tuple[float, float] | None
    growth: float
    degree: int

    @property
    def last(self) -> RefinedPoint:
        """The torus at the largest place."""
        return self.points[-1]

    def record(self, border: str) -> dict[str, Any]:
        """The border asked for, NEWTON or STABILITY, as JSON holds it."""
        return self._newton() if border == NEWTON else self._stability()

    def _newton(self) -> dict[str, Any]:
        near = self.last.torus.near_resonances[:1]
        return {
            "place": short(self.last.place),
            "energy": short(float(self.last.torus.energy())),
            "between": [short(self.last.place), short(self.above)],
            "failure": self.reason,
            "mode": near[0].mode if near else None,
            "harmonic": list(map(int, near[0].harmonic)) if near else None,
            "divisor": short(float(near[0].divisor)) if near else None,
            "slopes": [short(x) for x in _slopes(self.points)],
        }

    def _stability(self) -> dict[str, Any]:
        if self.first_unstable is None:
            return {"none": f"no unstable torus up to {self.last.place:.6g}: {self.reason}"}
        below, above = self.first_unstable
        place = math.sqrt(below * above) if below else above
        near = min(self.points, key=lambda point: abs(math.log(point.place / place)))
        energy = float(near.torus.energy()) * (place / near.place) ** self.degree
        return {
            "place": short(place),
            "energy": short(energy),
            "between": [short(below), short(above)],
            "growth": short(self.growth),
        }


def newton_end(
    ray: Ray,
    guess: QTorus,
    begin: float,
    end: float,
    *,
    most_harmonics: int = MOST_HARMONICS,
    stability: bool = False,
) -> NewtonEnd:
    """The tori of a ray from one of the series on, each from the one before.

    guess : a torus of the series; begin : its place; end : where the tori are left. stability :
    whether the first unstable one is looked for.

    Raises what `refine_at_energy` raises at the first of them.
    """
    points: list[RefinedPoint] = []
    unstable: tuple[float, float] | None = None
    growth = 0.0
    for found in _followed(ray, guess, begin, end, most_harmonics):
        if isinstance(found, _Stop):
            stop = found
            break
        if stability and unstable is None and _growth(found.torus):
            stable = points[-1] if points else None
            unstable, growth = _first_unstable(ray, stable, found)
        points.append(found)
    return NewtonEnd(stop.reason, stop.above, tuple(points), unstable, growth, ray.degree)


def _first_unstable(
    ray: Ray, stable: RefinedPoint | None, unstable: RefinedPoint
) -> tuple[tuple[float, float], float]:
    """The places between which stability is lost, by halving, and the rate of growth above."""
    growth = _growth(unstable.torus)
    if stable is None:
        return (0.0, unstable.place), growth
    below, above = stable, unstable
    while above.place > STABILITY_WIDTH * below.place:
        place = math.sqrt(below.place * above.place)
        try:
            middle = RefinedPoint(place, _refined(ray, below.torus, place))
        except NoTorus:
            break
        if rate := _growth(middle.torus):
            above, growth = middle, rate
        else:
            below = middle
    return (below.place, above.place), growth


def _growth(torus: RefinedTorus) -> float:
    """The rate of the fastest normal mode; 0 where none is unstable beyond doubt."""
    if len(torus.seeds) == 1:
        found = floquet(torus)
        if found.stable:
            return 0.0
        period = 2 * math.pi / float(torus.frequencies[0])
        return math.log(np.abs(found.multipliers).max()) / period
    try:
        modes = normal_modes(torus)
    except NoNormalModes:
        return 0.0
    return float(modes.growth) if modes.stable is False else 0.0


@dataclass(frozen=True)
class _Stop:
    reason: str
    above: float


def _followed(
    ray: Ray, guess: QuasiPeriodic, place: float, end: float, most: int
) -> Iterator[RefinedPoint | _Stop]:
    """The tori as they come, then why there is no further one."""
    torus = _refined(ray, guess, place)
    yield RefinedPoint(place, torus)
    factor = FACTOR
    while place < end:
        following = min(place * factor, end)
        try:
            torus = _refined(ray, torus, following)
        except NoTorus as failure:
            if factor < LEAST_FACTOR:
                yield _Stop(failure.reason, following)
                return
            factor = math.sqrt(factor)
            continue
        if len(torus.harmonics) > most:
            yield _Stop(TOO_MANY, following)
            return
        place = following
        factor = min(FACTOR, factor**1.5)
        yield RefinedPoint(place, torus)
    yield _Stop(NOT_FOLLOWED, math.inf)


def _refined(ray: Ray, guess: QuasiPeriodic, place: float) -> RefinedTorus:
    name = f"{place:.8g}"
    if ray.by == ENERGY:
        equal = dict.fromkeys(ray.seeds, 1)
        return refine_at_energy(
            guess, name, harmonic=False, energy_ratio=equal, tolerance=TOLERANCE
        )
    amplitudes = dict.fromkeys(ray.seeds, name)
    return refine_at_amplitudes(guess, amplitudes, tolerance=TOLERANCE)


def _slopes(points: tuple[RefinedPoint, ...]) -> list[float]:
    """d ln A / d ln place of each seed between the last two tori: large before a fold."""
    if len(points) < 2:
        return []
    before, last = points[-2:]
    sizes = [
        np.log([float(abs(A)) for A in p.torus.amplitudes.values()]) for p in (before, last)
    ]
    slopes = (sizes[1] - sizes[0]) / math.log(last.place / before.place)
    return [float(x) for x in slopes]
