"""The second theorem: how near to the torus an orbit stays, and for how long."""

import math
from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.checkers.reading import Json, dyadic, fraction, need, whole
from symfpu.checkers.rounding import scientific
from symfpu.checkers.torus.bounds import Bounds
from symfpu.checkers.torus.claim import Claim, read_directions
from symfpu.checkers.torus.frame import Frame
from symfpu.checkers.torus.growth import Growth, time_to_grow
from symfpu.checkers.torus.series import Row


class Stay(NamedTuple):
    """What is stated: up to a time, a weighted distance and what follows from it."""

    time: Fraction
    d: Fraction
    distance: Fraction
    momentum: Fraction
    drift: Row


def read_stay(entry: Any, angles: int) -> Stay:
    """[time, d, distance, momentum, drift of every angle]."""
    time, d, distance, momentum, drift = entry
    long = fraction(time, "time")
    need(long > 0, "the time is not positive")
    need(type(drift) is list and len(drift) == angles, "not one drift an angle")
    return Stay(
        long,
        dyadic(d, "the weighted distance"),
        dyadic(distance, "the distance"),
        dyadic(momentum, "the distance of velocities"),
        [dyadic(x, "a drift") for x in drift],
    )


def read_weights(values: Any, count: int) -> Row:
    """Positive integers."""
    need(type(values) is list and len(values) == count, "not one weight a coordinate")
    return [Fraction(whole(w, 1, 2**64, "a weight")) for w in values]


def check_time(growth: Growth, stay: Stay) -> None:
    """The weighted distance is not reached before the stated time."""
    long = time_to_grow(growth, stay.d)
    text = (
        f"the distance may be reached at {scientific(long)}, before {scientific(stay.time)}"
    )
    need(long >= stay.time, text)


def check_distance(bounds: Bounds, stay: Stay) -> None:
    """Stretches within the weighted distance."""
    most = max(bounds.reach()) * stay.d
    need(most <= stay.distance, f"stretches may differ by {scientific(most)}")


def check_momentum(bounds: Bounds, stay: Stay) -> None:
    """Velocities within the weighted distance."""
    most = max(bounds.speed()) * stay.d
    need(most <= stay.momentum, f"velocities may differ by {scientific(most)}")


def check_drift(bounds: Bounds, growth: Growth, stay: Stay) -> None:
    """|theta_m - phi_m - omega_m t| <= t (drift d + weight rate(d))."""
    rate = growth.rate(stay.d)
    pairs = zip(bounds.drift(), bounds.tangents, stay.drift, strict=True)
    for turn, weight, stated in pairs:
        most = stay.time * (turn * stay.d + weight * rate)
        need(most <= stated, f"an angle may drift by {scientific(most)}")


def check_stay(data: Json, claim: Claim, residual: Row) -> list[str]:
    """The hypotheses of the second theorem, and what it says."""
    stay = read_stay(data["stay"], claim.angles)
    directions = read_directions(data, claim)
    weights = read_weights(data["weights"], claim.angles + claim.N - 1)
    bounds = Bounds(Frame(claim, directions), residual, weights)
    growth = bounds.growth()
    check_time(growth, stay)
    check_distance(bounds, stay)
    check_momentum(bounds, stay)
    check_drift(bounds, growth, stay)
    drift, long = scientific(max(stay.drift)), scientific(stay.time, rounded=math.floor)
    terms = ", ".join(scientific(term) for term in growth.terms[:3])
    return [
        f"theorem: every orbit that starts on this torus stays, for {long} units "
        f"of time, within {scientific(stay.distance)} of it in all stretches and "
        f"{scientific(stay.momentum)} in all velocities, and the angles of the points it stays "
        f"near are within {drift} of phi + omega t",
        f"residual, frame and curvature in the frame: {terms}; 1 - |1 - LM| = "
        f"{float(growth.room):.4f}: recomputed with integers",
    ]
