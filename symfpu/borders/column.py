"""One column of an atlas: a chain, a packet, and the borders of its tori as the energy grows."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from symfpu.borders.chaos import CHAOS, DRAWS, IN_PHASE, TIME, ChaosRay, chaos_borders
from symfpu.borders.newton_end import FOLD, MOST_HARMONICS, NEWTON, STABILITY, newton_end
from symfpu.borders.packets import packet_modes
from symfpu.borders.point import ENERGY, ESTIMATES, POLES, Ray
from symfpu.borders.search import NoBorder, Points, series_border
from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.errors import InputError, SymfpuError
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Json = dict[str, Any]

BORDERS = (*ESTIMATES, FOLD, NEWTON, STABILITY, CHAOS, IN_PHASE)
LOSSES = (FOLD, STABILITY)
OF_ORBITS = (CHAOS, IN_PHASE)
BEGIN_RESIDUAL = 1e-9  # of a series whose torus Newton's method begins with
REACH = 3.0  # times the largest place of the series, to which Newton's tori are followed


def atlas_column(
    chain: Chain,
    packet: str,
    order: int,
    borders: Sequence[str] = ESTIMATES,
    *,
    places: Sequence[str] = (),
    by: str = ENERGY,
    per_particle: bool = False,
    most_harmonics: int = MOST_HARMONICS,
    reach: float = REACH,
    time: float = TIME,
    draws: int = DRAWS,
) -> Json:
    """Points and borders of one ray, as JSON holds them: a case of `atlas`.

    Arguments are those of `atlas`. Raises InputError for a packet that the chain does not have;
    what has no torus is a point or a border with the reason.
    """
    require_fixed_ends(chain)
    seeds = packet_modes(chain, packet)
    points = Points(Ray(chain, seeds, order, by))
    unit = chain.N if per_particle else 1
    for place in sorted(float(Fraction(text) * unit) for text in places):
        points.at(place)
    estimates = [name for name in borders if name in ESTIMATES]
    found = {name: _series_border(points, name) for name in estimates}
    asked = [name for name in borders if name in (NEWTON, *LOSSES)]
    newton: list[Json] = []
    if asked:
        of_newton, newton = _newton_borders(points, asked, most_harmonics, reach)
        found |= of_newton
    column = {
        "modes": list(seeds),
        "points": [point.record() for point in points],
        "newton": newton,
        "borders": found,
    }
    of_orbits = [name for name in borders if name in OF_ORBITS]
    if of_orbits:
        orbits = ChaosRay(chain, seeds, time, draws).searched().records()
        column["orbits"] = orbits
        by_name = chaos_borders(orbits, time)
        found |= {name: by_name[name] for name in of_orbits}
    return column


def _series_border(points: Points, estimate: str) -> Json:
    try:
        return series_border(points, estimate).record()
    except NoBorder as reason:
        return {"none": str(reason)}


def _newton_borders(
    points: Points, asked: Sequence[str], most_harmonics: int, reach: float
) -> tuple[Json, list[Json]]:
    """The borders asked for, by name, and the tori on the way."""
    try:
        torus, place = _beginning(points)
        end = newton_end(
            points.ray,
            torus,
            place,
            reach * max(point.place for point in points),
            most_harmonics=most_harmonics,
            losses=[name for name in asked if name in LOSSES],
            confirm=NEWTON in asked,
        )
    except SymfpuError as error:
        none = {"none": f"{type(error).__name__}: {error}"}
        return dict.fromkeys(asked, none), []
    borders = {name: end.record(name) for name in asked}
    return borders, [point.record() for point in end.points]


def _beginning(points: Points) -> tuple[Torus[FromSeries], float]:
    """The torus from which Newton's method begins: the lowest whose series is good enough.

    And its place. Where no point was asked for, those on the way to the nearest pole are looked
    at. Raises InputError where the series has none.
    """
    if not len(points):
        _series_border(points, POLES)
    known = [(p.torus, p.place, p.residual) for p in points if p.torus is not None]
    if not known:
        allowed = "a chain and packet with a torus at small energy"
        raise InputError("packet", points.ray.seeds, allowed, "take another order")
    good = [entry for entry in known if entry[2] < BEGIN_RESIDUAL]
    torus, place, _ = (good or known)[0]
    return torus, place
