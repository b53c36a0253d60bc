"""Even functions of several angles on a line of points, by transforms of one variable.

A rank-1 lattice; `symfpu.refinement.invariance` and `symfpu.refinement.waves` multiply on it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from symfpu.algebra.dense import threads_of_a_computation
from symfpu.refinement.equation import Floats, Ints

# size, in that of the largest chosen harmonics, up to which harmonics are told apart
OVERSAMPLING = 2.5
WORKERS = threads_of_a_computation()
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
    """

    def __init__(self, harmonics: Ints) -> None:
        self.harmonics = harmonics
        self.period, self.generator = generated_lattice(
            dilated(harmonics, OVERSAMPLING / 2)
        )
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

    def coefficients(self, values: Floats) -> Floats:
        """Coefficients (H, m) of cosines of even functions given by values (m, points)."""
        chosen = self.spectrum(values)[:, self._place]
        return np.asarray(chosen.T / self._weight[:, None])

    def coefficients_at(self, values: Floats, harmonics: Ints) -> Floats:
        """The same at other harmonics (M, s), up to OVERSAMPLING / 2 times as large as these."""
        found = self.spectrum(values)[:, self.entries(harmonics)]
        return np.asarray(found.T / halves_of_pairs(harmonics)[:, None])

    def spectrum(self, values: Floats) -> Floats:
        """Coefficients of exp(i nu.theta), by place; shape (m, points)."""
        from scipy import fft

        sums = fft.dct(values, type=1, workers=WORKERS)
        return np.asarray(sums / self.period)


def dilated(harmonics: Ints, factor: float) -> Ints:
    """All harmonics, of both signs, in an enlarged cross-polytope about the given ones.

    The smallest one that holds them, times the factor.
    """
    sizes = np.abs(harmonics)
    highest = np.maximum(sizes.max(axis=0), 1)
    reach = factor * float((sizes / highest).sum(axis=1).max())
    rows, left = np.zeros((1, 0), dtype=np.int64), np.array([reach])
    for k in highest.tolist():
        tops = np.floor(left * k + 1e-9).astype(np.int64)
        counts = 2 * tops + 1
        at = np.repeat(np.arange(len(rows)), counts)
        before = np.repeat(np.cumsum(counts) - counts, counts)
        numbers = np.arange(len(at)) - before - tops[at]
        rows = np.column_stack([rows[at], numbers])
        left = left[at] - np.abs(numbers) / k
    return np.asarray(rows)


def without_opposites(harmonics: Ints) -> Ints:
    """Those whose first number that is not 0 is positive, and 0, of harmonics of both signs."""
    first = np.argmax(harmonics != 0, axis=1)
    lead = harmonics[np.arange(len(harmonics)), first]
    return np.asarray(harmonics[lead >= 0])


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
