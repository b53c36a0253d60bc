"""The hypotheses of the theorem, one a function, and what it then says."""

from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise
from math import floor

from symfpu.checkers.reading import Json, need, whole
from symfpu.checkers.rounding import scientific
from symfpu.checkers.stability.bounds import Bounds
from symfpu.checkers.stability.exponent import MOST_HARMONICS, Exponent, read_exponent
from symfpu.checkers.stability.orbit import (
    Orbit,
    check_existence_of,
    orbit_of,
    sectors_of,
)
from symfpu.checkers.stability.slopes import Slopes

MOST_STEPS = 10**9


def check_certificate(data: Json) -> list[str]:
    """The orbit exists, every exponent is enclosed, and the count is right."""
    sentence = check_existence_of(data["existence"])
    orbit = orbit_of(data["existence"])
    K = whole(data["slope_harmonics"], 1, MOST_HARMONICS, "slope_harmonics")
    free = whole(data["free"], 1, MOST_HARMONICS, "free")
    given = data["exponents"]
    need(type(given) is list and len(given) <= 2 * orbit.N, "too many exponents")
    check_cost(orbit, K, free, len(given))
    slopes = Slopes(orbit, K)
    exponents = [read_exponent(entry, orbit, free) for entry in given]
    bounds = [Bounds(slopes, one, free).check_contraction() for one in exponents]
    need(data["claim"] in ("stable", "unstable"), "the claim is stable or unstable")
    check = check_stable if data["claim"] == "stable" else check_unstable
    line = check(orbit, exponents)
    largest = [max((pair[i] for pair in bounds), default=Fraction(0)) for i in (0, 1)]
    numbers = f"Y up to {scientific(largest[0])}, Z up to {scientific(largest[1])}"
    count = "1 exponent" if len(given) == 1 else f"{len(given)} exponents"
    return [line, sentence, f"{count}: {numbers}: recomputed with integers"]


def check_cost(orbit: Orbit, K: int, free: int, exponents: int) -> None:
    """Checking takes minutes at most."""
    columns = (2 * (free + K) + 1) * orbit.N
    steps = exponents * columns * (2 * K + 1) * orbit.N
    need(steps <= MOST_STEPS, "checking it would take too many steps")


def check_stable(orbit: Orbit, exponents: Iterable[Exponent]) -> str:
    """As many distinct real exponents in every sector as the theorem on counting asks for."""
    listed = list(exponents)
    gaps = []
    for sector in sectors_of(orbit):
        own = [one for one in listed if one.sector == sector]
        need(
            len(own) == sector.exponents,
            f"exponents of a sector: {len(own)} where {sector.exponents} are due",
        )
        need(all(one.reals for one in own), "an exponent of a stable orbit is not real")
        ends = sorted(one.in_turns(orbit) for one in own)
        zero, last = Fraction(0), Fraction(sector.folds, 2)
        points = [(zero, zero), *ends, (last, last)]
        for a, b in pairwise(points):
            need(
                a[1] < b[0], "two exponents may be the same, or one at 0 or half the period"
            )
            gaps.append(b[0] - a[1])
    count = len(sectors_of(orbit))
    sectors = "its symmetry sector" if count == 1 else f"each of {count} symmetry sectors"
    return (
        "theorem: the periodic orbit of the next line is linearly stable: all its Floquet "
        f"multipliers lie on the unit circle, 1 is double, and within {sectors} all others are "
        f"simple, their exponents at "
        f"least {scientific(min(gaps), rounded=floor)} omega apart"
    )


def check_unstable(orbit: Orbit, exponents: Iterable[Exponent]) -> str:
    """A solution of the linearised equations grows."""
    rates = []
    for one in exponents:
        rate = abs(one.imaginary)
        need(rate > one.off, "an exponent may be real")
        rates.append((rate - one.off, rate + one.off))
    need(rates, "no exponent is given")
    least, most = max(rates)
    return (
        "theorem: the periodic orbit of the next line is linearly unstable: a solution of its "
        f"linearised equations grows with a rate between {scientific(least, 10, floor)} and "
        f"{scientific(most, 10)}"
    )
