"""Even functions of several angles on a line of points, by transforms of one variable.

A rank-1 lattice; `symfpu.refinement.invariance` multiplies on it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import threads_of_a_computation

Floats = NDArray[Any]
Ints = NDArray[np.int64]
# size, in that of the largest chosen harmonics, up to which harmonics are told apart
OVERSAMPLING = 2.5
WORKERS = threads_of_a_computation()
# harmonics of its hull, in all and in those of a choice, above which the choice has holes; the
# length of harmonics that count as low beside such a choice
SMALL_HULL, HOLES, LOW = 20_000, 3.0, 4.0
# harmonics that are tried first, generators of one period, and the ratio of the periods tried
FIRST_TRIED, TRIALS, GROWTH = 400, 600, 1.1


def halves_of_pairs(harmonics: Ints) -> Floats:
    """The coefficient of exp(i nu.theta) for one of cos(nu.theta); shape (H,)."""
    return np.where((harmonics != 0).any(axis=1), 0.5, 1.0)


class Lattice:
    """Even functions of s angles: coefficients at chosen harmonics, values on a line of points.

    The points are theta_k = 2 pi k g / M: of the harmonic nu they see nu.g modulo M only, so that
    one transform of one variable serves any number of angles (a rank-1 lattice). M and g are such
    that no two harmonics up to OVERSAMPLING / 2 times as large as the chosen ones coincide: of a
    product, harmonics fold onto chosen ones only if both together are OVERSAMPLING times as
    large, as small as what the choice leaves out. Even functions need half of the points, M/2 +
    1.

    A choice that follows sizes (`symfpu.refinement.harmonics`) fills a small part of the least
    polytope that holds it. It is told apart from its neighbours alone: what folds onto it is a
    product of a harmonic at its border with others than the neighbouring one.
    """

    def __init__(self, harmonics: Ints, separated: Ints | None = None) -> None:
        """separated : harmonics of both signs, with the chosen ones; those of `alias_free_set`."""
        self.harmonics = harmonics
        if separated is None:
            separated = alias_free_set(harmonics)
        self.period, self.generator = generated_lattice(separated)
        self.points = self.period // 2 + 1
        self._place = self.entries(harmonics)
        self._weight = halves_of_pairs(harmonics)

    @property
    def averaged_rounding(self) -> float:
        """Of a coefficient, in that of one value: of a transform, and the mean over all points."""
        return float(np.sqrt(np.log2(self.points) / self.points))

    def entries(self, harmonics: Ints) -> Ints:
        """Places of any harmonics in the spectrum; shape (...) of (..., s)."""
        return self.folded(harmonics @ self.generator)

    def folded(self, numbers: Ints) -> Ints:
        """Places of nu.g."""
        place = numbers % self.period
        return np.asarray(np.minimum(place, self.period - place))

    def values(self, coefficients: Floats) -> Floats:
        """Values (m, points) of m functions given by coefficients (H, m) of cosines."""
        from scipy import fft

        spectrum = np.zeros((coefficients.shape[1], self.points), dtype=coefficients.dtype)
        halved = coefficients * self._weight[:, None]
        spectrum[:, self._place] = halved.T
        return np.asarray(fft.dct(spectrum, type=1, workers=WORKERS, overwrite_x=True))

    def coefficients(self, values: Floats, harmonics: Ints | None = None) -> Floats:
        """Coefficients (H, m) of cosines of even functions given by values (m, points).

        harmonics : others (M, s), up to OVERSAMPLING / 2 times as large as these.
        """
        place, weight = self._place, self._weight
        if harmonics is not None:
            place, weight = self.entries(harmonics), halves_of_pairs(harmonics)
        return np.asarray(self.spectrum(values)[:, place].T / weight[:, None])

    def tallest(self, spectrum: Floats, most: int, share: float) -> Ints:
        """The largest harmonics of functions above a share of the height of all; (k, s).

        spectrum : of the functions, (m, points). With both signs. They are among all harmonics as
        large as the chosen ones, or among low ones where those have holes: where V is even the
        slopes have even harmonics alone, and the torus odd ones.
        """
        heights = np.abs(spectrum).max(axis=0)
        holes, s = has_holes(self.harmonics), self.harmonics.shape[1]
        nu = without_opposites(low_harmonics(s) if holes else dilated(self.harmonics, 1))
        order = np.argsort(-heights[self.entries(nu)], kind="stable")
        chosen = nu[order[:most]]
        tall = chosen[heights[self.entries(chosen)] > share * heights.max()]
        return np.unique(np.concatenate([tall, -tall]), axis=0)

    def spectrum(self, values: Floats) -> Floats:
        """Coefficients of exp(i nu.theta), by place; shape (m, points)."""
        from scipy import fft

        sums = fft.dct(values, type=1, workers=WORKERS)
        return np.asarray(sums / self.period)


def has_holes(harmonics: Ints) -> bool:
    """Whether chosen harmonics fill a small part of their hull, the polytope of `dilated`."""
    highest, reach = _hull(harmonics)
    size = float(np.prod(2 * reach * highest + 1)) / math.factorial(len(highest))
    return size > max(SMALL_HULL, HOLES * 2 * len(harmonics))


def alias_free_set(harmonics: Ints) -> Ints:
    """The harmonics, of both signs, that the lattice of chosen ones tells apart."""
    if has_holes(harmonics):
        return neighbours(harmonics)
    return dilated(harmonics, OVERSAMPLING / 2)


def neighbours(harmonics: Ints) -> Ints:
    """Chosen harmonics and those one step beside them, of both signs.

    A step is one of one angle; where all have odd lengths, as where V is even, two of them.
    """
    units = np.eye(harmonics.shape[1], dtype=np.int64)
    steps = np.concatenate([units, -units])
    if (harmonics.sum(axis=1) % 2 == 1).all():
        steps = (steps[:, None] + steps).reshape(-1, harmonics.shape[1])
    return beside(harmonics, steps)


def beside(harmonics: Ints, steps: Ints) -> Ints:
    """Harmonics and those by steps (k, s) beside them, of both signs."""
    signed = np.concatenate([harmonics, -harmonics])
    moved = (signed[:, None] + steps).reshape(-1, harmonics.shape[1])
    both = np.concatenate([signed, moved, -moved])
    return _distinct_rows(both)


def _distinct_rows(rows: Ints) -> Ints:
    """Every row once."""
    lowest = rows.min(axis=0)
    widths = rows.max(axis=0) - lowest + 1
    weights = np.cumprod(np.append(1, widths[:-1]))
    _, places = np.unique((rows - lowest) @ weights, return_index=True)
    return np.asarray(rows[places])


def low_harmonics(s: int) -> Ints:
    """All of s angles up to a small length, of both signs."""
    return dilated(np.eye(s, dtype=np.int64), LOW)


def _hull(harmonics: Ints) -> tuple[Ints, float]:
    """The highest number of each angle, at least 1, and the reach of the polytope of `dilated`."""
    sizes = np.abs(harmonics)
    highest = np.maximum(sizes.max(axis=0), 1)
    return highest, float((sizes / highest).sum(axis=1).max())


def dilated(harmonics: Ints, factor: float) -> Ints:
    """All harmonics, of both signs, in an enlarged cross-polytope about the given ones.

    The smallest one that holds them, times the factor.
    """
    highest, reach = _hull(harmonics)
    rows, left = np.zeros((1, 0), dtype=np.int64), np.array([factor * reach])
    for k in highest.tolist():
        tops = np.floor(left * k + 1e-9).astype(np.int64)
        counts = 2 * tops + 1
        at = np.repeat(np.arange(len(rows)), counts)
        before = np.repeat(np.cumsum(counts) - counts, counts)
        numbers = np.arange(len(at)) - before - tops[at]
        rows = np.column_stack([rows[at], numbers])
        left = left[at] - np.abs(numbers) / k
    return np.asarray(rows)


def shifted(harmonics: Ints, rows: Ints, kappa: Ints) -> tuple[Ints, Ints]:
    """Where nu - kappa of chosen rows nu of the harmonics, or its negative, is one of them.

    Places among the chosen rows, and rows of the harmonics.
    """
    highest = np.abs(harmonics).max(axis=0)
    base = 4 * highest + 3
    weights = np.cumprod(np.append(base[1:], 1)[::-1])[::-1]
    moved = canonical_signs(harmonics[rows] - kappa)
    keys, wanted = harmonics @ weights, moved @ weights
    order = np.argsort(keys)
    nearest = np.searchsorted(keys[order], wanted)
    place = order[np.clip(nearest, 0, len(keys) - 1)]
    within = (np.abs(moved) <= highest).all(axis=1)
    found = np.flatnonzero((keys[place] == wanted) & within)
    return found, place[found]


def _leads(harmonics: Ints) -> Ints:
    """The first number of each that is not 0."""
    return np.asarray(
        harmonics[np.arange(len(harmonics)), np.argmax(harmonics != 0, axis=1)]
    )


def without_opposites(harmonics: Ints) -> Ints:
    """Those whose first number that is not 0 is positive, and 0, of harmonics of both signs."""
    return np.asarray(harmonics[_leads(harmonics) >= 0])


def canonical_signs(harmonics: Ints) -> Ints:
    """One of each pair +-nu: the first number that is not 0 is positive, as of chosen harmonics."""
    return np.asarray(np.where(_leads(harmonics)[:, None] < 0, -harmonics, harmonics))


def places_of(rows: Ints, among: Ints) -> Ints:
    """Where harmonics stand among others, which hold them all; shape (len(rows),)."""
    places = {nu: i for i, nu in enumerate(map(tuple, among.tolist()))}
    return np.array([places[nu] for nu in map(tuple, rows.tolist())], dtype=np.int64)


@lru_cache(maxsize=8)
def _known_lattice(content: bytes, s: int) -> tuple[int, tuple[int, ...]]:
    from scipy import fft

    harmonics = np.frombuffer(content, dtype=np.int64).reshape(-1, s)
    draw = np.random.default_rng(0)  # any will do; the same every time
    shuffled = harmonics[draw.permutation(len(harmonics))]
    size = float(len(harmonics))
    while True:
        half = fft.next_fast_len(max(1, int(np.ceil(size / 2))), real=True)
        period = 2 * half
        factors = draw.integers(1, period, TRIALS) if s > 1 else np.ones(1, dtype=np.int64)
        for generator in _powers(factors, s, period):
            if _distinct(shuffled, generator, period):
                return period, tuple(generator.tolist())
        size *= GROWTH


def _powers(factors: Ints, s: int, period: int) -> Ints:
    """1, a, a^2, .. modulo the period, of every factor a; shape (factors, s)."""
    powers = np.ones((len(factors), s), dtype=np.int64)
    for k in range(1, s):
        powers[:, k] = powers[:, k - 1] * factors % period
    return powers


def _distinct(shuffled: Ints, generator: Ints, period: int) -> bool:
    """Whether nu.g modulo the period differs for all harmonics.

    Those of few harmonics first: of M places, about the root of M fill two of one.
    """
    count = FIRST_TRIED
    while True:
        places = np.sort(shuffled[:count] @ generator % period)
        if (places[1:] == places[:-1]).any():
            return False
        if count >= len(shuffled):
            return True
        count *= 4


def generated_lattice(harmonics: Ints) -> tuple[int, Ints]:
    """A short period M and a generator g = (1, a, a^2, ...) that tell all given harmonics apart.

    nu.g modulo M differs for all of them.
    """
    content = np.ascontiguousarray(harmonics).tobytes()
    period, generator = _known_lattice(content, harmonics.shape[1])
    return period, np.array(generator)
