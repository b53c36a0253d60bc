"""Points of a curve of periodic orbits in the space of all their coefficients, and steps on it.

The equations of harmonic balance leave one direction free, the tangent. Lengths are those of
the coefficients; sigma has none, as it follows from them. Two points lie on one smooth piece of a
curve if the whole solutions agree with the cubic through both and their tangents, and if the
index is the same: the number of negative eigenvalues of the second variation of the action at
fixed frequency, bordered by the action's own gradient. It changes where an orbit is degenerate,
at a fold of the action or where another family crosses, and on a curve that turns away before a
crossing it does not. So a step across a resonance is told from one on the curve by an integer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.equations import TAIL, Balance, relative_heights
from symfpu.breathers.linearisation import MOST_UNKNOWNS, linear_system
from symfpu.errors import SymfpuError

Floats = NDArray[np.float64]
Along = Callable[[Floats, Floats], float]
# corrections of a prediction, new linearisations for them, and a correction relative to the size;
# a prediction that needs more is too far away
MOST_CORRECTIONS, MOST_LINEARISATIONS, LARGEST_CORRECTION = 40, 4, 1.0
STEP = 1e-14  # relative correction that ends the iteration at once
ROUNDING_STEP = 1e-9  # the one that ends it when it no longer shrinks
SLOW = 0.1  # of the correction before: one that is larger asks for a new linearisation
ONE_PLACE = 1e-9  # of the size: orbits so near have one linearisation
NEARLY_THERE = 1e-4  # a correction after which a linearisation is that of the orbit
DETUNING = 1e-2  # weight of a relative correction of sigma, whose rounding is larger
LEAST_MOST, PER_BOND = (
    128,
    8,
)  # harmonics that are taken, at most: a number, or so many a bond
# accuracy of solutions of long chains, relative: of tangents, divisors, and corrections, which the
# next one corrects
OF_TANGENTS, OF_DIVISORS, OF_STEPS = 1e-13, 1e-7, 1e-4
ANGLE = 0.3  # between tangents, in radians, from one point to the next
NEAR = 0.1  # of a step: how far the point may be from the cubic's chord rule
COMPARED = 1e-3  # of the largest coefficient: smaller ones are not compared one by one
COEFFICIENT = 0.25  # relative misfit of one coefficient


class NotOnTheCurve(SymfpuError):
    """A point that a step found does not continue the curve. Ours.

    point : what was found, or None. reason : why it is refused. crossings : by how much the index
    has changed, where the whole solutions agree. unresolved : whether it has more harmonics than
    are taken.
    """

    def __init__(
        self,
        reason: str,
        point: Point | None,
        *,
        crossings: int = 0,
        unresolved: bool = False,
    ) -> None:
        self.reason, self.point = reason, point
        self.crossings, self.unresolved = crossings, unresolved
        super().__init__(reason)


class Linearisation:
    """The second variation of the action at fixed frequency, with the action's gradient.

    tangent : of the curve through z, of length 1 in the coefficients, the action rising. index :
    its negative eigenvalues.
    """

    def __init__(self, balance: Balance, z: Floats) -> None:
        try:
            self._system = linear_system(balance, z)
        except np.linalg.LinAlgError as failure:
            raise NotOnTheCurve(str(failure), None) from failure
        self._z, self._weights = z, balance.weights
        self.index = self._system.index
        along = np.append(np.zeros(len(balance.n)), 1.0)
        self.tangent = self._system.solve(along, OF_TANGENTS)
        self.tangent /= np.linalg.norm(self.tangent[:-1])

    def is_at(self, z: Floats) -> bool:
        """Whether z is where it was taken, about."""
        moved = np.abs(z - self._z)[:-1].max()
        return bool(moved <= ONE_PLACE * np.abs(z[:-1]).max())

    def solve(self, right: Floats) -> Floats:
        """The solution for one right-hand side or several, in columns."""
        return self._system.solve(right, OF_DIVISORS)

    def _particular(self, equations: Floats, accuracy: float = OF_STEPS) -> Floats:
        return self._system.solve(np.append(self._weights * equations, 0.0), accuracy)

    def across(self, equations: Floats) -> Floats:
        """The change of z by which the equations have these values, across the tangent."""
        x = self._particular(equations)
        return np.asarray(x - self.tangent * (self.tangent[:-1] @ x[:-1]))

    def holding(self, place: int, equations: Floats, accuracy: float = OF_STEPS) -> Floats:
        """The same without a change of one coefficient."""
        x = self._particular(equations, accuracy)
        change = x - self.tangent * (x[place] / self.tangent[place])
        change[place] = 0.0
        return np.asarray(change)


@dataclass(frozen=True, eq=False)
class Point:
    """One orbit of a curve: z of a balance, and the derivative of z by the length of the curve.

    index : of its linearisation, which is kept while steps start from it. iterations : corrections
    that led to it.
    """

    balance: Balance
    z: Floats
    tangent: Floats
    index: int
    iterations: int
    linear: Linearisation | None

    @property
    def amplitude(self) -> float:
        """A of the seed."""
        return float(self.z[self.balance.first])

    @property
    def size(self) -> float:
        """The largest coefficient."""
        return float(np.max(np.abs(self.z[:-1])))

    @cached_property
    def cosines(self) -> Floats:
        """Coefficients, harmonic 0 first, shape (H+1, N-1)."""
        return self.balance.cosines(self.z)

    @property
    def rise(self) -> float:
        """Of sum n^2 c^2, twice the action over the frequency, along the tangent."""
        return float((self.balance.n**2 * self.z[:-1]) @ self.tangent[:-1])

    def linearised(self) -> Linearisation:
        """Its linearisation, anew if it is not kept."""
        return self.linear or Linearisation(self.balance, self.z)


def point_at(
    balance: Balance,
    z: Floats,
    towards: Floats,
    iterations: int = 0,
    linear: Linearisation | None = None,
) -> Point:
    """The orbit z as a point whose tangent goes along with `towards`.

    linear : its linearisation, if it is known.
    """
    linear = linear or Linearisation(balance, z)
    forward = linear.tangent[:-1] @ towards[:-1] >= 0
    tangent = linear.tangent if forward else -linear.tangent
    return Point(balance, z, tangent, linear.index, iterations, linear)


def corrected(
    balance: Balance,
    z: Floats,
    linear: Linearisation,
    along: Along | None = None,
) -> tuple[Floats, int, Linearisation]:
    """The orbit near z, across the tangent, or where a condition is met.

    along : how far along the tangent it is met, by z and the tangent. With the number of
    corrections, and the last linearisation. Raises NotOnTheCurve.
    """

    def step(linear: Linearisation, z: Floats, equations: Floats) -> Floats:
        change = linear.across(equations)
        if along is None:
            return change
        return np.asarray(change - along(z - change, linear.tangent) * linear.tangent)

    return settled(balance, z, linear, step)


def at_amplitude(balance: Balance, guess: Floats) -> tuple[Floats, int, Linearisation]:
    """The orbit near a guess that has its amplitude, as `corrected` gives it."""

    def step(linear: Linearisation, z: Floats, equations: Floats) -> Floats:
        return linear.holding(balance.first, equations)

    return settled(balance, guess, Linearisation(balance, guess), step)


def settled(
    balance: Balance,
    guess: Floats,
    linear: Linearisation,
    step: Callable[[Linearisation, Floats, Floats], Floats],
) -> tuple[Floats, int, Linearisation]:
    """What corrections of a guess lead to, as `corrected` gives it.

    One linearisation serves as long as the corrections shrink fast. The first one that does not
    serve is replaced by that at the guess, others by that at z.
    """
    z, size = guess, float(np.max(np.abs(guess[:-1])))
    before, made, near, of_guess = np.inf, 0, False, balance.equations(guess)
    for count in range(1, MOST_CORRECTIONS + 1):
        change = step(linear, z, of_guess if z is guess else balance.equations(z))
        z = z - change
        moved = float(np.max(np.abs(change[:-1]))) / size
        relative = max(moved, DETUNING * _relative(float(change[-1]), float(z[-1])))
        if relative <= STEP:
            return z, count, linear
        grows = not relative < LARGEST_CORRECTION
        if grows and made:
            raise NotOnTheCurve("the corrections grow", None)
        if grows or relative > SLOW * before:
            rounding = relative < ROUNDING_STEP or _is_rounding(balance, change, moved)
            if near and rounding:  # nothing else is left
                return z, count, linear
            if (made := made + 1) > MOST_LINEARISATIONS:
                break
            near = rounding or relative < NEARLY_THERE
            z = z if near or made > 1 else guess
            linear, relative = Linearisation(balance, z), np.inf
        before = relative
    raise NotOnTheCurve("the corrections do not converge", None)


def _is_rounding(balance: Balance, change: Floats, moved: float) -> bool:
    """Whether a correction leaves omega^2 as it is in doubles: a shift may be zero but for that."""
    linear = float(balance.chain.frequencies()[balance.seed - 1])
    least = float(np.finfo(float).eps) * linear**2
    return moved < ROUNDING_STEP and abs(float(change[-1])) < least


def _relative(change: float, value: float) -> float:
    """Of a change to a value that may be rounding."""
    return abs(change) / max(abs(value), float(np.finfo(float).eps))


def with_harmonics(point: Point, harmonics: int) -> Point:
    """The same orbit with more harmonics."""
    balance = point.balance.at(harmonics)
    towards = balance.vector(point.balance.cosines(point.tangent), point.tangent[-1])
    z = balance.vector(point.cosines, float(point.z[-1]))
    linear = Linearisation(balance, z)
    z, steps, linear = corrected(balance, z, linear)
    return point_at(balance, z, towards, point.iterations + steps, linear)


def alike(start: Point, end: Point) -> tuple[Point, Point]:
    """Both with as many harmonics."""
    most = max(p.balance.harmonics for p in (start, end))
    first, second = (
        p if p.balance.harmonics == most else with_harmonics(p, most) for p in (start, end)
    )
    return first, second


def resolved(balance: Balance, z: Floats) -> bool:
    """Whether the last harmonics of an orbit are as small as rounding."""
    heights = relative_heights(balance.cosines(z))
    return bool(np.max(heights[-max(2, balance.harmonics // 8) :]) <= TAIL)


def more_harmonics(balance: Balance, z: Floats) -> int:
    """As many as their fall asks for; NotOnTheCurve where these are too many."""
    known, heights = balance.harmonics, relative_heights(balance.cosines(z))
    ends = [
        max(float(heights[k : k + 2].max()), TAIL / 10) for k in (known // 2, known - 1)
    ]
    fall = np.log(ends[0] / ends[1]) / (known - 1 - known // 2)
    missing = np.log(10 * ends[1] / TAIL) / fall if fall > 0 else known
    harmonics = known + int(np.clip(1.2 * missing, max(4, known // 5), known))
    N = balance.chain.N
    most = min(max(LEAST_MOST, PER_BOND * N), 2 * MOST_UNKNOWNS // (N - 1))
    if known >= most:
        reason = f"{known} harmonics do not resolve it"
        raise NotOnTheCurve(reason, None, unresolved=True)
    return min(harmonics, most)


def step_from(
    start: Point, length: float, bend: Floats, widen: Callable[[Point, int], Point]
) -> tuple[Point, Point]:
    """The point at this length along the curve, and the start with as many harmonics.

    bend : half of the second derivative by the length, of the balance of the start. widen : gives
    the start with more harmonics. Raises NotOnTheCurve.
    """
    balance = start.balance
    guess = start.z + length * start.tangent + length**2 * bend
    z, steps, _ = corrected(balance, guess, start.linearised())
    linear: Linearisation | None = None
    while True:
        if balance.frequency(z) <= 0:
            raise NotOnTheCurve("the frequency falls to zero", None)
        if resolved(balance, z):
            return point_at(balance, z, start.tangent, steps, linear), start
        try:
            harmonics = more_harmonics(balance, z)
        except NotOnTheCurve as refusal:
            refusal.point = point_at(balance, z, start.tangent, steps)
            raise
        start = widen(start, harmonics)
        guess, balance = start.balance.vector(balance.cosines(z), z[-1]), start.balance
        z, more, linear = corrected(balance, guess, Linearisation(balance, guess))
        linear = linear if linear.is_at(z) else None
        steps += more


def require_agreement(start: Point, found: Point) -> None:
    """NotOnTheCurve unless both points lie on one smooth piece of a curve.

    Both have as many harmonics.
    """
    if reason := disagreement(start, found):
        raise NotOnTheCurve(reason, found)
    change, turned = found.index - start.index, start.rise * found.rise < 0
    if abs(change) != int(turned):
        reason = f"the index goes from {start.index} to {found.index}"
        raise NotOnTheCurve(reason, found, crossings=abs(change))


def disagreement(start: Point, found: Point) -> str:
    """What of two whole solutions does not fit the cubic through both; empty if all does."""

    def name(place: int) -> str:
        n, q = int(start.balance.n[place]), int(start.balance.q[place]) + 1
        return f"harmonic {n} of mode {q}"

    return unlike(
        (start.z[:-1], start.tangent[:-1]), (found.z[:-1], found.tangent[:-1]), name
    )


def unlike(
    start: tuple[Floats, Floats],
    found: tuple[Floats, Floats],
    name: Callable[[int], str],
) -> str:
    """What of two solutions does not fit the cubic through both; empty if all does.

    start, found : their coefficients and tangents of length 1, (n,) each, the same unknowns.
    name : of the coefficient at a place. It holds for orbits and tori alike.
    """
    (here, before), (there, after) = start, found
    cosine = float(before @ after)
    if cosine < np.cos(ANGLE):
        return f"the tangent turns by {np.arccos(np.clip(cosine, -1, 1)):.2g}"
    moved = there - here
    gone = 2 * float(moved @ (before + after)) / float((before + after) @ (before + after))
    misfit = np.abs(moved - gone * (before + after) / 2)
    if float(np.linalg.norm(misfit)) > NEAR * abs(gone):
        part = float(np.linalg.norm(misfit)) / max(abs(gone), np.finfo(float).tiny)
        return f"the point found is {part:.2g} steps off"
    sizes = np.maximum(np.abs(here), np.abs(there))
    compared = np.where(sizes > COMPARED * sizes.max(), sizes, np.inf)
    if float(np.max(misfit / compared)) > COEFFICIENT:
        return f"{name(int(np.argmax(misfit / compared)))} does not fit"
    return ""
