"""What alignment indices say of an orbit: the dimension of its torus, chaos, or nothing yet.

Two things are looked at. The first deviation vector grows as t on every torus, in the end, and
exponentially on a chaotic orbit. The volumes GALI_k fall as powers of t that depend on the
dimension s of the torus. An orbit on a torus of low dimension shows it by indices that fall, and
a chaotic one does not do so by chance; but where no index falls, or few, a chaotic orbit looks
like one on a torus of full dimension before its exponential growth sets in. Such orbits were seen
to grow as t for 3.6 decades of time first (N = 4, beta = 1): four are asked for there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

DECADES = 1.5  # of time, the last ones, in which slopes are fitted
PARTS = 8  # of that range, left out one at a time for the uncertainty of a slope
LEAST_SAMPLES = 4 * PARTS  # samples in it
# least uncertainty of a slope in the choice of a dimension: for what one window cannot show
FLOOR = 0.1
ODDNESS = 1 / 3  # a slope so far from every integer it should be decides nothing
CERTAINTY = 0.95  # weight of a dimension that is called decided
POWER = 3  # of t: no regular orbit has a |v| that outgrows it
CHAOS_GROWTH = (
    10.0  # e-foldings of |v| beyond this power that are called chaos; regular: up to 0.3
)
EARLY_TIME = 10.0  # time before which growth says nothing: |v| finds its directions
PIECE = 1.0  # decades of time in which |v| is asked to grow as t
STRIDE = 0.5  # decades from one such piece to the next
LOW_DECADES = 2.0  # decades with |v| as t before a torus of low dimension is believed
FULL_DECADES = 4.0  # and one of full dimension


@dataclass(frozen=True)
class TorusDimension:
    """What the slopes say of the torus under an orbit.

    verdict : 'regular, dimension s', 'regular, dimension s or more' if no index falls, 'chaotic'
    or 'undecided'. value : s, None for a chaotic or undecided orbit. error : the standard
    deviation of s over the weights; weights : of each s, normalised, also where nothing is
    decided, their mean over the frames. reason : the numbers behind the verdict, and for an
    undecided one what it would take.
    supported : s, or the best supported value of an undecided orbit, by the indices that have
    settled: the first ones, up to a fall by 1/t; None where there is no such fall.
    frames : s of each frame of deviation vectors, None where that one decides nothing.
    """

    verdict: str
    value: int | None
    error: float
    weights: Mapping[int, float] = field(repr=False)
    reason: str
    supported: int | None = None
    frames: tuple[int | None, ...] = field(default=(None,), repr=False)

    def __repr__(self) -> str:
        return f"TorusDimension({self.verdict}: {self.reason})"


@dataclass(frozen=True, eq=False)
class Evidence:
    """Indices as they are judged.

    times : (S,). growth : log |v_1|, natural, (S,). log10_gali : (S, vectors-1).

    freedom : degrees of freedom n of the chain. decades : in which slopes are fitted.
    """

    times: Floats
    growth: Floats
    log10_gali: Floats
    freedom: int
    decades: float

    @property
    def vectors(self) -> int:
        return int(self.log10_gali.shape[1]) + 1

    def exponent(self) -> tuple[float, float]:
        """d log |v_1| / d log t over the last decades, and its uncertainty."""
        return fits(self.times, self.growth[:, None] / math.log(10), self.decades)[0]

    def steps(self, decades: float) -> Floats:
        """Slopes of log GALI_j - log GALI_(j-1), j = 2 .. vectors, with errors; (vectors-1, 2)."""
        return np.array(
            fits(self.times, np.diff(self.log10_gali, axis=1, prepend=0.0), decades)
        )


def torus_dimension(seen: Evidence) -> TorusDimension:
    """The verdict on an orbit that has kept its energy."""
    outgrown = outgrown_powers(seen.times, seen.growth)
    if outgrown > CHAOS_GROWTH:
        grown = f"|v| has grown by e^{seen.growth[-1]:.3g}"
        reason = f"{grown}, by e^{outgrown:.3g} more than t^{POWER} does"
        return TorusDimension("chaotic", None, 0.0, {}, reason)
    steps = seen.steps(seen.decades)
    weights, best = _weights(steps, seen)
    error = math.sqrt(sum(w * (s - best) ** 2 for s, w in weights.items()))
    reason, doubt = _growth_doubt(seen, outgrown)
    if not doubt:
        found, doubt = _slope_doubt(seen, steps, best, weights[best])
        reason += found
    if not doubt:
        doubt = _length_doubt(seen, best)
    if doubt:
        supported = supported_dimension(seen, steps)
        return TorusDimension("undecided", None, error, weights, reason + doubt, supported)
    more = " or more" if best == seen.vectors < seen.freedom else ""
    verdict = f"regular, dimension {best}{more}"
    return TorusDimension(verdict, best, error, weights, reason, best, (best,))


def supported_dimension(seen: Evidence, steps: Floats) -> int | None:
    """s by the indices that have settled, where |v| grows as t.

    Differences of slopes are 0 up to j = s, then -1: the first of them to ODDNESS, the others
    may still be on their way. None without a difference of -1.
    """
    exponent, _ = seen.exponent()
    if abs(exponent - 1) > ODDNESS:
        return None
    s = 1
    for slope in steps[:, 0]:
        if abs(slope + 1) <= ODDNESS:
            return s
        if abs(slope) > ODDNESS:
            return None
        s += 1
    return None


def expected_steps(s: int, n: int, vectors: int) -> Ints:
    """Slopes of log GALI_j - log GALI_(j-1), j = 2 .. vectors, on a torus of dimension s.

    2n : dimension of the phase space.
    """
    j = np.arange(2, vectors + 1)
    return -np.add(j > s, j > 2 * n - s, dtype=np.int64)


def outgrown_powers(times: Floats, growth: Floats) -> float:
    """The most e-foldings by which |v| came to exceed t^POWER times the largest |v| before.

    It counts from EARLY_TIME on and is 0 or more. It is never less after a longer time: what has
    once been called chaotic stays so.
    """
    late = times >= EARLY_TIME
    power = POWER * np.log(times[late])
    before = np.minimum.accumulate(np.maximum.accumulate(growth)[late] - power)
    return float(np.max(growth[late] - power - before, initial=0.0))


def linear_decades(times: Floats, growth: Floats) -> float:
    """For how many decades |v| has grown as t, counted back from the end, at most to EARLY_TIME.

    It has done so in every PIECE of them, to ODDNESS in the exponent.
    """
    x, y = np.log10(times), growth / math.log(10)
    length, end = 0.0, float(x[-1])
    while end - PIECE >= math.log10(EARLY_TIME) - 1e-2:
        inside = (x >= end - PIECE - 1e-9) & (x <= end + 1e-9)
        if np.count_nonzero(inside) < 3:
            break
        slope, _ = np.polyfit(x[inside], y[inside], 1)
        if abs(slope - 1) > ODDNESS:
            break
        length = float(x[-1]) - end + PIECE
        end -= STRIDE
    return length


def fits(times: Floats, values: Floats, decades: float) -> list[tuple[float, float]]:
    """Slopes of columns (S, k) against log10 t over the last decades, with jackknife errors."""
    x = np.log10(times)
    begin = x[-1] - _span(x, decades) - 1e-9
    first = min(int(np.searchsorted(x, begin)), max(0, len(x) - LEAST_SAMPLES))
    x = x[first:]
    values = values[first:]
    part = np.arange(len(x)) * PARTS // len(x)
    whole = np.polyfit(x, values, 1)[0]
    partial = []
    for i in range(PARTS):
        others = part != i
        partial.append(np.polyfit(x[others], values[others], 1)[0])
    without = np.array(partial)
    squares = (without - without.mean(axis=0)) ** 2
    errors = np.sqrt((PARTS - 1) / PARTS * np.sum(squares, axis=0))
    return list(zip(whole.tolist(), errors.tolist(), strict=True))


def _span(log_time: Floats, decades: float) -> float:
    if not decades > 0:
        raise InputError("decades", decades, "a positive number", "take one or two")
    return min(decades, float(log_time[-1] - log_time[0]))


def _weights(steps: Floats, seen: Evidence) -> tuple[dict[int, float], int]:
    """The weight exp(-chi^2/2) of each s, normalised, and the heaviest s.

    Errors are enlarged where no s fits.
    """
    n, most = seen.freedom, min(seen.vectors, seen.freedom)
    slopes, errors = steps[:, 0], np.maximum(steps[:, 1], FLOOR)
    squares = {}
    for s in range(1, most + 1):
        off = (slopes - expected_steps(s, n, seen.vectors)) / errors
        squares[s] = float(np.sum(off**2))
    best = min(squares, key=lambda s: squares[s])
    least = squares[best]
    scale = max(1.0, least / len(errors))
    weights = {s: math.exp((least - square) / (2 * scale)) for s, square in squares.items()}
    total = sum(weights.values())
    return {s: w / total for s, w in weights.items()}, best


def _growth_doubt(seen: Evidence, outgrown: float) -> tuple[str, str]:
    """How |v| grows, and why this is not, or not yet, as on a torus.

    The second is empty if it is.
    """
    exponent, error = seen.exponent()
    reason = f"|v| grows as t^{exponent:.2f} +- {error:.2f}"
    if exponent > 1 + ODDNESS:
        return reason, (
            f", faster than on a torus, but not by so much that it must be chaos: "
            f"by e^{outgrown:.2g} more than t^{POWER}, where e^{CHAOS_GROWTH:g} would do; "
            f"take a longer time"
        )
    if exponent < 1 - ODDNESS:
        return reason, ", on a torus as t^1 in the end: take a longer time"
    return reason, ""


def _slope_doubt(
    seen: Evidence, steps: Floats, best: int, weight: float
) -> tuple[str, str]:
    """The slope farthest from its integer, and why slopes decide nothing or have not settled.

    The second is empty if they decide.
    """
    expected = expected_steps(best, seen.freedom, seen.vectors)
    off = np.abs(steps[:, 0] - expected)
    j = int(np.argmax(off))
    slope, error = steps[j]
    reason = (
        f"; {_difference(j)}, the farthest from its integer, has the slope "
        f"{slope:.2f} +- {error:.2f}, on a torus of dimension {best} it is {expected[j]}"
    )
    if off[j] > ODDNESS or weight < CERTAINTY:
        return reason, ": take a longer time"
    late = seen.steps(seen.decades / 2)[:, 0]
    off = np.abs(late - expected)
    j = int(np.argmax(off))
    if off[j] > ODDNESS:
        ending = f"{_difference(j)} ends with {late[j]:.2f}"
        return reason, f", and {ending}: take a longer time"
    return reason, ""


def _difference(j: int) -> str:
    return f"log GALI_{j + 2} - log GALI_{j + 1}"


def _length_doubt(seen: Evidence, s: int) -> str:
    """Whether |v| has grown as t for too short a time to believe in dimension s; empty if not."""
    # an index falls, and more will not come to join s soon
    special = s < seen.vectors and 2 * s <= seen.freedom
    regular = seen.freedom == 1  # knows no chaos
    needed = LOW_DECADES if special or regular else FULL_DECADES
    length = linear_decades(seen.times, seen.growth)
    if length >= needed - 1e-6:
        return ""
    until = seen.times[-1] * 10 ** (needed - length)
    more = " or take more vectors" if s == seen.vectors < seen.freedom else ""
    return (
        f"; |v| has grown as t for {length:.1f} decades, and {needed:g} are needed to tell "
        f"such a torus from an orbit whose chaos shows late: "
        f"take a longer time, about {until:.0e},{more or ' or more'}"
    )
