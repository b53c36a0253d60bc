"""What a curve of periodic orbits does at a resonance: how wide is the gap that it leaves open.

Where harmonic n of an orbit meets the frequency of mode q, its coefficient c obeys
f + D c + g c^3 = 0, with D from one sign to the other along the curve. The curve turns away where
c is about (f / 2g)^(1/3): another one goes on where it would have gone. All three numbers are read
off orbits whose harmonic is held: every equation but its own is solved, and that one is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.curve import (
    OF_DIVISORS,
    Linearisation,
    NotOnTheCurve,
    Point,
    settled,
)
from symfpu.breathers.equations import Balance

Floats = NDArray[np.float64]
CENTRE = 1e-4  # relative change of an amplitude, to which the middle of a gap is found
CENTRE_STEPS = 25
FARTHEST = 0.5  # of the amplitude, from which the middle of a gap is looked for
AHEAD = 0.5  # of a step, by which D may vanish before or beyond it
DIRECTIONS, INVERSE_STEPS = (
    4,
    4,
)  # in which an orbit is nearly degenerate, and how they are found
PROBE = 0.02  # of the amplitude: the coefficient at which the cubic term is read off
PROBE_ASIDE = 0.002  # the same at an orbit aside of the middle, with its own linearisation


@dataclass(frozen=True, eq=False)
class Gap:
    """A resonance of a curve: the middle of its gap, and how wide this is.

    place : of the coefficient among the unknowns. amplitude : of the seed where D = 0. slope :
    dD/dA there; drive, cubic : f and g. z : the orbit there whose harmonic is held at zero.
    """

    balance: Balance
    place: int
    amplitude: float
    slope: float
    drive: float
    cubic: float
    z: Floats
    held: Held

    @property
    def turn(self) -> float:
        """The coefficient where the curve turns away."""
        return float(np.cbrt(abs(self.drive) / (2 * abs(self.cubic))))

    @property
    def half_range(self) -> float:
        """The amplitudes of the seed between the middle and the turn."""
        return 3 * abs(self.cubic) * self.turn**2 / abs(self.slope)

    @property
    def width(self) -> float:
        """The same, relative."""
        return self.half_range / abs(self.amplitude)

    def turns_back(self, forward: float) -> bool:
        """Whether the curve that comes with this sign of dA turns back to where it came from.

        Where D / g < 0 there are three orbits, and the middle one ends. The other way there is
        one, whose harmonic grows from there on.
        """
        return forward * self.slope * self.cubic > 0

    @property
    def mode(self) -> int:
        """q of the resonance."""
        return int(self.balance.q[self.place]) + 1

    @property
    def harmonic(self) -> int:
        """n of the resonance."""
        return int(self.balance.n[self.place])


class Held:
    """Orbits of given A with one coefficient held: all equations but its own are solved."""

    def __init__(self, start: Point, place: int) -> None:
        self.balance, self.place = start.balance, place
        self.linear = start.linearised()
        self._driven: tuple[Linearisation | None, Floats] = (None, start.z)

    def _alone(self, linear: Linearisation) -> Floats:
        """The change at given A by which its own equation alone has the value 1."""
        if self._driven[0] is not linear:
            unit = np.zeros(len(self.balance.n))
            unit[self.place] = 1.0
            driven = linear.holding(self.balance.first, unit, OF_DIVISORS)
            self._driven = linear, driven
        return self._driven[1]

    def divisor(self, linear: Linearisation) -> float:
        """D: the derivative of its own equation by the coefficient, the others solved."""
        return 1 / float(self._alone(linear)[self.place])

    def solved(self, z: Floats, amplitude: float, value: float) -> Floats:
        """The orbit near z. Raises NotOnTheCurve."""
        z = z.copy()
        ratio = amplitude / z[self.balance.first]
        z[self.balance.first], z[self.place] = amplitude, value
        z[-1] *= ratio**2

        def step(linear: Linearisation, z: Floats, equations: Floats) -> Floats:
            alone = self._alone(linear)
            change = linear.holding(self.balance.first, equations)
            return np.asarray(change - alone * (change[self.place] / alone[self.place]))

        z, _, self.linear = settled(self.balance, z, self.linear, step)
        return z

    def drive(self, z: Floats) -> float:
        """The equation that is left out."""
        return float(self.balance.equations(z)[self.place])


def gap_ahead(start: Point, found: Point | None, place: int, distance: float) -> Gap | None:
    """The resonance of a coefficient near the part of the curve from a point on; None without one.

    found : what a step of this length led to. There is one where D changes its sign, or would.
    """
    held, A = Held(start, place), start.amplitude
    step = distance * float(start.tangent[start.balance.first])
    try:
        D = held.divisor(start.linearised())
        if found is not None and abs(found.amplitude - A) > abs(step) / 2:
            other, D_other = found.amplitude, held.divisor(found.linearised())
        else:
            other = A + step
            z = held.solved(start.z, other, 0.0)
            D_other = held.divisor(Linearisation(start.balance, z))
        part = D / (D - D_other) if D_other != D else np.inf
        if not -AHEAD <= part <= 1 + AHEAD:
            return None
        return _centred(held, start.z, A, A + part * (other - A))
    except NotOnTheCurve:
        return None


def gap_between(start: Point, found: Point, place: int) -> Gap | None:
    """The resonance of a coefficient between two orbits, by both of them; None without one.

    D is taken as linear between them; f and g are those at the start.
    """
    held, A = Held(start, place), start.amplitude
    D, D_other = (held.divisor(point.linearised()) for point in (start, found))
    if D * D_other >= 0:
        return None
    slope = (D_other - D) / (found.amplitude - A)
    drive = -D * float(start.z[place])
    return _measured(held, start.z, A, -D / slope, slope, drive, PROBE_ASIDE)


def _centred(held: Held, z: Floats, begin: float, other: float) -> Gap | None:
    """The gap whose middle is found from a first guess of its amplitude, by secants."""
    A, D, slope = begin, np.nan, np.nan
    for _ in range(CENTRE_STEPS):
        z = held.solved(z, other, 0.0)
        held.linear = Linearisation(held.balance, z)
        D_other = held.divisor(held.linear)
        if np.isnan(D):  # D where the harmonic is held is not that of the curve
            A, D, other = other, D_other, other * (1 + 10 * CENTRE)
            continue
        slope = (D_other - D) / (other - A)
        A, D = other, D_other
        ahead = -D / slope if slope else np.inf
        if abs(ahead) < CENTRE * abs(A):
            return _measured(held, z, A, ahead, slope, held.drive(z))
        other = A + float(np.clip(ahead, -0.1 * abs(A), 0.1 * abs(A)))
        if abs(other - begin) > FARTHEST * abs(begin):
            return None
    return None


def _measured(
    held: Held,
    z: Floats,
    A: float,
    ahead: float,
    slope: float,
    drive: float,
    aside: float = PROBE,
) -> Gap | None:
    probe, D = aside * float(np.max(np.abs(z[:-1]))), -ahead * slope
    forces = [held.drive(held.solved(z, A, c)) for c in (probe, -probe)]
    cubic = ((forces[0] - forces[1]) / 2 / probe - D) / probe**2
    if not cubic:
        return None
    return Gap(held.balance, held.place, A + ahead, slope, drive, cubic, z, held)


def landing(gap: Gap, amplitude: float) -> tuple[Floats, float]:
    """A guess of the orbit beside a gap that this amplitude has, and its small coefficient."""
    held = gap.held
    z = held.solved(gap.z, amplitude, 0.0)
    held.linear = Linearisation(held.balance, z)
    small = -held.drive(z) / held.divisor(held.linear)
    return held.solved(z, amplitude, small), small


def beside(gap: Gap, amplitude: float) -> Floats:
    """A guess of the orbit next to a gap or in it, its harmonic the least that balances it."""
    held = gap.held
    z = held.solved(gap.z, amplitude, 0.0)
    held.linear = Linearisation(held.balance, z)
    cubic = [gap.cubic, 0.0, held.divisor(held.linear), held.drive(z)]
    real = [c.real for c in np.roots(cubic) if abs(c.imag) <= 1e-9 * abs(c)]
    return held.solved(z, amplitude, float(min(real, key=abs)))


def changed(start: Point, found: Point) -> Iterator[int]:
    """Places of coefficients whose own divisor has another sign at the second orbit, then others.

    The others are the suspects of both. Both orbits have the same unknowns.
    """
    slopes = [point.balance.slopes(point.z) for point in (start, found)]
    pair = [
        point.balance.own_divisors(slope, point.z)
        for point, slope in zip((start, found), slopes, strict=True)
    ]
    places = np.flatnonzero(pair[0] * pair[1] < 0).tolist()
    yield from places
    for place in suspects(start, found):
        if place not in places:
            yield place


def suspects(start: Point, found: Point | None) -> Iterator[int]:
    """Places of coefficients that may resonate, each once."""
    seen = {start.balance.first}
    if found is not None:
        turned = np.abs(found.tangent[:-1] - start.tangent[:-1])
        turned[start.balance.first] = 0
        place = int(np.argmax(turned))
        seen.add(place)
        yield place
    for point in (found, start):
        for place in _weakest(point) if point else ():
            if place not in seen:
                seen.add(place)
                yield place


def _weakest(point: Point) -> list[int]:
    """The largest coefficients of the directions in which an orbit is nearly degenerate."""
    matrix = point.linearised()
    vectors = np.random.default_rng(0).standard_normal((len(point.z), DIRECTIONS))
    for _ in range(INVERSE_STEPS):
        vectors, _ = np.linalg.qr(matrix.solve(vectors))
    small = vectors.T @ matrix.solve(vectors)
    values, mix = np.linalg.eigh((small + small.T) / 2)
    vectors = np.abs(vectors @ mix[:, np.argsort(-np.abs(values))])[:-1]
    vectors[point.balance.first] = 0
    return list(map(int, np.argmax(vectors, axis=0)))
