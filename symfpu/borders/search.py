"""The place on a ray at which an estimate of the radius of convergence falls to the torus."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from symfpu.borders.point import Point, Ray, point_at, singularity
from symfpu.numbers.counted import short
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

FIRST_PLACE, LOWERING, LOWERINGS = 1e-6, 1e-2, 6  # energies at which a ray is begun
LARGEST_PLACE = 1e6  # no border is looked for beyond
MOST_STEPS = 40  # on the way to a border
SHORTEST, LONGEST = 1.3, 1e4  # factors of a step towards a border
OVERSHOOT = 1.1
WIDTH = 0.01  # of ln place, to which a border is located
NO_TORUS = -1.0  # what counts as ln radius where the series has no torus
LARGEST_LOGARITHM = 30.0


class NoBorder(Exception):
    """The estimate does not fall to 1 on the places that were tried."""


class Points:
    """The points of a ray that were computed, each once."""

    def __init__(self, ray: Ray) -> None:
        self.ray = ray
        self.by_place: dict[float, Point] = {}

    def at(self, place: float) -> Point:
        """The point there, from the nearest torus that is known."""
        if place not in self.by_place:
            self.by_place[place] = point_at(self.ray, place, self.near(place))
        return self.by_place[place]

    def near(self, place: float) -> Torus[FromSeries] | None:
        """The torus of the nearest place below; None if there is none."""
        known = [p for p in self.by_place.values() if p.torus and p.place <= place]
        return max(known, key=lambda point: point.place).torus if known else None

    def __len__(self) -> int:
        return len(self.by_place)

    def __iter__(self) -> Iterator[Point]:
        return iter(sorted(self.by_place.values(), key=lambda point: point.place))


@dataclass(frozen=True, eq=False)
class SeriesBorder:
    """Where an estimate of the radius of convergence falls to the torus' own amplitudes.

    place, energy : there; below, above : the nearest places with a larger and a smaller radius.
    failure : why there is no torus above, where that is what ends the series; empty if the radius
    is. last : the point below.
    """

    estimate: str
    place: float
    energy: float
    below: float
    above: float
    last: Point
    failure: str

    def record(self) -> dict[str, Any]:
        """As JSON holds it."""
        assert self.last.assessment is not None
        return {
            "place": short(self.place),
            "energy": short(self.energy),
            "between": [short(self.below), short(self.above)],
            "failure": self.failure,
            **singularity(self.last.assessment),
        }


def series_border(points: Points, estimate: str) -> SeriesBorder:
    """The lowest border of a ray by this estimate; raises NoBorder."""
    from scipy.optimize import brentq

    def logarithm(place: float) -> float:
        return _logarithm(points.at(place), estimate)

    begin = _begun(points, logarithm)
    below, above = _bracket(points, logarithm, begin)
    ends = {math.log(below): logarithm(below), math.log(above): logarithm(above)}

    def between(x: float) -> float:
        return ends[x] if x in ends else logarithm(_rounded(math.exp(x)))

    brentq(between, *ends, xtol=WIDTH)
    return _border(points, estimate)


def _logarithm(point: Point, estimate: str) -> float:
    """Of the radius, in units of the torus' own; its zero is the border."""
    if point.torus is None:
        return NO_TORUS
    radius = point.radii[estimate]
    return math.log(radius) if math.isfinite(radius) else LARGEST_LOGARITHM


def _rounded(place: float) -> float:
    return float(f"{place:.6g}")


def _begun(points: Points, logarithm: Callable[[float], float]) -> float:
    """The lowest place with a torus inside its radius; one small enough, if none is known."""
    known = [p.place for p in points if logarithm(p.place) > 0]
    if known:
        return known[0]
    for k in range(LOWERINGS):
        place = _rounded(FIRST_PLACE * LOWERING**k)
        if logarithm(place) > 0:
            return place
    raise NoBorder(f"no torus of the series down to {place:g}")


def _bracket(
    points: Points, logarithm: Callable[[float], float], begin: float
) -> tuple[float, float]:
    """Neighbouring places on both sides of the border; new ones by steps the radius suggests."""
    below = begin
    for point in points:
        if point.place <= begin:
            continue
        if logarithm(point.place) <= 0:
            return below, point.place
        below = point.place
    for _ in range(MOST_STEPS):
        exponent = points.at(below).exponent
        size = math.log(OVERSHOOT) + exponent * logarithm(below)
        factor = math.exp(min(size, math.log(LONGEST)))
        place = _rounded(below * max(SHORTEST, factor))
        if logarithm(place) <= 0:
            return below, place
        below = place
        if below > LARGEST_PLACE:
            break
    raise NoBorder(f"the radius stays above 1 up to {below:g}")


def _border(points: Points, estimate: str) -> SeriesBorder:
    """Between the neighbouring places where the sign changes first."""
    ordered = list(points)
    logs = [_logarithm(point, estimate) for point in ordered]
    begin = next(i for i, value in enumerate(logs) if value > 0)
    first = next(i for i in range(begin, len(logs)) if logs[i] <= 0)
    last, beyond = ordered[first - 1], ordered[first]
    part = logs[first - 1] / (logs[first - 1] - logs[first]) if beyond.torus else 0.0
    factor = (beyond.place / last.place) ** part
    assert last.torus is not None
    energy = float(last.torus.energy()) * factor**points.ray.degree
    return SeriesBorder(
        estimate=estimate,
        place=last.place * factor,
        energy=energy,
        below=last.place,
        above=beyond.place,
        last=last,
        failure=beyond.failure,
    )
