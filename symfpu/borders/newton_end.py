"""How far Newton's method follows the tori of a ray, and where they lose their stability."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from symfpu.borders.fold import MOST_UNKNOWNS, sheet_of
from symfpu.borders.last_torus import confirmation, vanishing_divisor
from symfpu.borders.point import ENERGY, Ray
from symfpu.breathers.balance import HarmonicBalance, orbit_at, require_same
from symfpu.breathers.equations import NoPeriodicOrbit
from symfpu.breathers.floquet import floquet
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import AmplitudeGoal, EnergyGoal, first_passage
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.search import normal_modes
from symfpu.numbers.counted import short
from symfpu.refinement.newton import Newton
from symfpu.refinement.resonances import NearResonance
from symfpu.refinement.search import ALL_THAT_FIT
from symfpu.refinement.tori import NoTorus, ended_early, refine
from symfpu.tori.energy import Energy
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

FACTOR = 1.25  # of the place, at most, from one torus to the next, if a loss is looked for
WIDE_FACTOR = 1.6  # and if none is
LOSS_WIDTH = 1.01  # ratio of the places between which something is lost
LEAST_FACTOR = 1.01  # a step below which the torus before is the last
TOLERANCE = 1e-9  # of the residual, as of what `normal_modes` takes
SAME_ORBIT = 1e-5  # of the size: what such a residual leaves open of an orbit
CONFIRMING = 3  # times as many harmonics for the last torus as for those on the way
Json = dict[str, Any]
Test = Callable[[Torus[Newton]], Json | None]

MOST_HARMONICS = 400
NEWTON, FOLD, STABILITY = "newton", "fold", "stability"
TOO_MANY = "more harmonics than allowed"
NOT_FOLLOWED = "followed as far as asked"
NOT_SMALL = "the residual stays above the tolerance"
SEARCH_ENDS = (TOO_MANY, NOT_FOLLOWED, NOT_SMALL)


@dataclass(frozen=True, eq=False)
class RefinedPoint:
    """A torus of Newton's method on a ray."""

    place: float
    torus: Torus[Newton]

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
class Loss:
    """What tori lose on their way: stability, or the sheet of their series.

    below, above : the last with it and the first without; below is None where the first torus has
    lost it. found : of the latter, as JSON holds it.
    """

    below: RefinedPoint | None
    above: RefinedPoint
    found: Json

    def record(self) -> Json:
        """As JSON holds it."""
        low = self.below or self.above
        energies = [float(point.torus.energy()) for point in (low, self.above)]
        return {
            "place": short(math.sqrt(low.place * self.above.place)),
            "energy": short(math.sqrt(energies[0] * energies[1])),
            "between": [
                short(self.below.place if self.below else 0.0),
                short(self.above.place),
            ],
            **self.found,
        }


@dataclass(frozen=True, eq=False)
class NewtonEnd:
    """The last torus of a ray, and what stands in the way of the next.

    reason : of Newton's method; SEARCH_ENDS are limits of the search, not of the tori. above : the
    place at which there is none. points : of all tori. losses : by name, FOLD or STABILITY.
    confirmed : the last torus with more harmonics, as `confirmation` gives it.
    """

    reason: str
    above: float
    points: tuple[RefinedPoint, ...] = field(repr=False)
    losses: Mapping[str, Loss]
    confirmed: Json = field(default_factory=dict)

    @property
    def last(self) -> RefinedPoint:
        """The torus at the largest place."""
        return self.points[-1]

    def record(self, border: str) -> Json:
        """The border asked for, NEWTON, FOLD or STABILITY, as JSON holds it."""
        if border == NEWTON:
            return self._newton()
        if border in self.losses:
            return self.losses[border].record()
        if border == FOLD and sheet_of(self.last.torus) is None:
            return {"none": f"not looked for above {MOST_UNKNOWNS} coefficients of a torus"}
        return {"none": f"kept up to {self.last.place:.6g}: {self.reason}"}

    def _vanishing(self) -> NearResonance | None:
        """The divisor in the way, where it was Newton's method that ended."""
        if self.reason in SEARCH_ENDS or len(self.points) < 2:
            return None
        before, last = ((p.place, p.torus) for p in self.points[-2:])
        return vanishing_divisor(before, last, self.above)

    def _newton(self) -> Json:
        vanishing = self._vanishing()
        near = [vanishing] if vanishing else self.last.torus.origin.near_resonances[:1]
        return {
            "place": short(self.last.place),
            "energy": short(float(self.last.torus.energy())),
            "between": [short(self.last.place), short(self.above)],
            "failure": self.reason,
            "mode": near[0].mode if near else None,
            "harmonic": list(map(int, near[0].harmonic)) if near else None,
            "divisor": short(float(near[0].divisor)) if near else None,
            "vanishes": vanishing is not None,
            "slopes": [short(x) for x in _slopes(self.points)],
            "confirmed": dict(self.confirmed),
        }


def newton_end(
    ray: Ray,
    guess: Torus[FromSeries],
    begin: float,
    end: float,
    *,
    most_harmonics: int = MOST_HARMONICS,
    losses: Sequence[str] = (),
    confirm: bool = False,
) -> NewtonEnd:
    """The tori of a ray from one of the series on, each from the one before.

    guess : a torus of the series; begin : its place; end : where the tori are left. losses : of
    FOLD and STABILITY, what is looked for on the way. confirm : whether the last torus is found
    with more harmonics, too.

    Raises what `refine` raises at the first of them.
    """
    points: list[RefinedPoint] = []
    lost: dict[str, Loss] = {}
    factor = FACTOR if losses else WIDE_FACTOR
    tori = _Tori(ray)
    for found in _followed(tori, guess, begin, end, most_harmonics, factor):
        if isinstance(found, _Stop):
            stop = found
            break
        points.append(found)
        for name in losses:
            if name not in lost and (loss := _loss(name, points)):
                loss = _located(tori, TESTS[name], loss, most_harmonics)
                lost[name] = _named(loss) if name == FOLD else loss
    confirmed = _confirmed(tori, points[-1], most_harmonics) if confirm else {}
    return NewtonEnd(stop.reason, stop.above, tuple(points), lost, confirmed)


def _confirmed(tori: _Tori, last: RefinedPoint, most: int) -> Json:
    def refined(sharper: float) -> Torus[Newton]:
        tolerance = sharper * TOLERANCE
        return tori.refined(last.torus, last.place, CONFIRMING * most, tolerance)

    return confirmation(last.torus, refined)


def _loss(name: str, points: Sequence[RefinedPoint]) -> Loss | None:
    """What the last of these tori has lost: a sheet only if the torus before had lost it already.

    Next to a weak resonance a torus is on another sheet for a moment, between the zeros of the
    divisor and of what the amplitudes make of it.
    """
    lasting = LASTING[name]
    if len(points) < lasting:
        return None
    latest = points[-lasting:]
    changes = [TESTS[name](point.torus) for point in latest]
    first = changes[0]
    if first is None or None in changes:
        return None
    before = points[-lasting - 1] if len(points) > lasting else None
    return Loss(before, latest[0], first)


def _located(tori: _Tori, test: Test, loss: Loss, most: int) -> Loss:
    """The same between nearer places, by halving, as far as tori are found."""
    below, above, found = loss.below, loss.above, loss.found
    if below is None:
        return loss
    while above.place > LOSS_WIDTH * below.place:
        place = math.sqrt(below.place * above.place)
        try:
            middle = RefinedPoint(place, tori.refined(below.torus, place, most))
        except NoTorus:
            break
        change = test(middle.torus)
        if change is None:
            below = middle
        else:
            above, found = middle, change
    return Loss(below, above, found)


def _growth(torus: Torus[Newton]) -> Json | None:
    """The rate of the fastest normal mode; None where none is unstable beyond doubt."""
    if len(torus.seeds) == 1:
        found = floquet(torus)
        if found.stable:
            return None
        period = 2 * math.pi / float(torus.frequencies[0])
        rate = math.log(np.abs(found.multipliers).max()) / period
        return {"growth": short(rate)}
    try:
        modes = normal_modes(torus)
    except NoNormalModes:
        return None
    return {"growth": short(float(modes.growth))} if modes.stable is False else None


def _other_sheet(torus: Torus[Newton]) -> Json | None:
    """Nothing to say where the torus is not on the sheet of its series; None where it is."""
    sheet = sheet_of(torus)
    return None if sheet is None or sheet.sign > 0 else {}


def _named(fold: Loss) -> Loss:
    """A fold with the coefficient that folds, where it is the same on both sides."""
    if fold.below is None:
        return fold
    sheets = [sheet_of(point.torus) for point in (fold.below, fold.above)]
    low, high = ((s.mode, list(s.harmonic)) if s else (None, []) for s in sheets)
    mode, harmonic = high
    if mode is None or low != high:
        return fold
    return replace(fold, found={"mode": mode, "harmonic": harmonic})


TESTS: Mapping[str, Test] = {FOLD: _other_sheet, STABILITY: _growth}
# how many tori in turn must have lost it
LASTING = {FOLD: 2, STABILITY: 1}


@dataclass(frozen=True)
class _Stop:
    reason: str
    above: float


def _followed(
    tori: _Tori,
    guess: Torus,
    place: float,
    end: float,
    most: int,
    widest: float,
) -> Iterator[RefinedPoint | _Stop]:
    """The tori as they come, then why there is no further one."""
    torus = tori.refined(guess, place, most)
    yield RefinedPoint(place, torus)
    factor = widest
    while place < end:
        following = min(place * factor, end)
        try:
            found = tori.refined(torus, following, most)
        except NoTorus as failure:
            if factor < LEAST_FACTOR:
                yield _Stop(failure.reason, following)
                return
            factor = math.sqrt(factor)
            continue
        if found.warnings:
            full = any(ALL_THAT_FIT in warning for warning in found.warnings)
            yield _Stop(TOO_MANY if full else NOT_SMALL, following)
            return
        torus, place = found, following
        factor = min(widest, factor**1.5)
        yield RefinedPoint(place, torus)
    yield _Stop(NOT_FOLLOWED, math.inf)


class _Tori:
    """The tori of a ray, each near a guess.

    Breathers are those of the family from rest, the first of every place: Newton's method alone
    goes over to other families in silence.
    """

    def __init__(self, ray: Ray) -> None:
        self.ray = ray
        one, fixed = len(ray.seeds) == 1, not ray.chain.periodic
        self._walk = FromRest(ray.chain, *ray.seeds) if one and fixed else None

    def refined(
        self, guess: Torus, place: float, most: int, tolerance: float = TOLERANCE
    ) -> Torus[Newton]:
        """The torus of a place; NoTorus also where Newton's method ended early."""
        orbit = None if self._walk is None else self._on_family(self._walk, guess, place)
        found = self._at(orbit or guess, place, most, tolerance)
        if ended_early(found):
            raise NoTorus("; ".join(found.warnings), found, found.residual())
        if orbit is not None:
            require_same(orbit, found, SAME_ORBIT)
        return found

    def _on_family(
        self, walk: FromRest, guess: Torus, place: float
    ) -> Torus[HarmonicBalance]:
        value = float(f"{place:.8g}")
        energy = EnergyGoal(self.ray.chain, value)
        goal = energy if self.ray.by == ENERGY else AmplitudeGoal(value)
        try:
            return orbit_at(first_passage(walk, goal), 0)
        except NoPeriodicOrbit as failure:
            raise NoTorus(failure.reason, guess, guess.residual()) from failure

    def _at(self, guess: Torus, place: float, most: int, tolerance: float) -> Torus[Newton]:
        name, seeds = f"{place:.8g}", self.ray.seeds
        if self.ray.by == ENERGY:
            return refine(
                guess,
                energy=Energy(name, energy_ratio=dict.fromkeys(seeds, 1)),
                tolerance=tolerance,
                most_harmonics=most,
            )
        amplitudes = dict.fromkeys(seeds, name)
        return refine(
            guess, amplitudes=amplitudes, tolerance=tolerance, most_harmonics=most
        )


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
