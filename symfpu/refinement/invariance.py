"""The invariance equation of a torus in Fourier space, its linear part exact and its products pseudo-spectral.

Q_q(theta) = sum over nu of c_q[nu] cos(nu.theta) is a torus of the chain if for every mode and harmonic
((nu.omega)^2 - Omega_q^2) c_q[nu] = N_q[nu], N the transform of alpha r^2 + beta r^3 with the stretches r of the bonds on points of
all angles. Reflection of the chain shifts the angles by half turns: only c with q = nu.seeds (mod 2) are unknowns (for beta alone also
nu of odd length), and half of the bonds are enough. All sums of one kind run in one precision, doubles or the machine's long doubles.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain

Floats = NDArray[Any]
Ints = NDArray[np.int64]

OVERSAMPLING = 2.5  # size, in that of the largest chosen harmonics, up to which harmonics are told apart
PORTION = 4_000_000  # values of all bonds transformed at once
MOST_SLOPES, SHARE = 12, 0.1  # harmonics of the slopes that a sparse derivative holds, and their least height, relative
MOST_ENTRIES = 40_000_000  # of a sparse derivative; 16 bytes each
DIGITS = 30  # of the numbers that long doubles are made of


def long(value: Any) -> np.longdouble:
    """A rational or an mpf as a long double."""
    with mpmath.workdps(DIGITS):
        exact = mpmath.mpf(value.numerator) / value.denominator if isinstance(value, Fraction) else mpmath.mpf(value)
        return np.longdouble(mpmath.nstr(exact, DIGITS))


def rational(value: np.longdouble) -> Fraction:
    """A long double as the number it is."""
    high = float(value)
    return Fraction(high) + Fraction(float(value - np.longdouble(high)))


def _halves(value: Any) -> tuple[np.longdouble, np.longdouble]:
    """An mpf as the sum of two long doubles."""
    high = long(value)
    with mpmath.workdps(2 * DIGITS):
        exact = rational(high)
        return high, long(value - mpmath.mpf(exact.numerator) / exact.denominator)


class Lattice:
    """Fourier coefficients of even functions of s angles at chosen harmonics, and their values on a line of points through all angles.

    The points are theta_k = 2 pi k g / M: of the harmonic nu they see nu.g modulo M only, so that one transform of one variable
    serves any number of angles (a rank-1 lattice). M and g are such that no two harmonics up to OVERSAMPLING / 2 times as large as
    the chosen ones coincide: of a product, harmonics fold onto chosen ones only if both together are OVERSAMPLING times as large, as
    small as what the choice leaves out. Even functions need half of the points, M/2 + 1.
    """

    def __init__(self, harmonics: Ints) -> None:
        self.harmonics = harmonics
        self.period, self.generator = generated_lattice(dilated(harmonics, OVERSAMPLING / 2))
        self.points = self.period // 2 + 1
        self._place = self.entries(harmonics)
        self._weight = np.where((harmonics != 0).any(axis=1), 0.5, 1.0)

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
        spectrum[:, self._place] = (coefficients * self._weight[:, None]).T
        return np.asarray(fft.dct(spectrum, type=1, workers=WORKERS, overwrite_x=True))

    def coefficients(self, values: Floats) -> Floats:
        """Coefficients (H, m) of cosines of even functions given by values (m, points)."""
        return np.asarray(self.spectrum(values)[:, self._place].T / self._weight[:, None])

    def spectrum(self, values: Floats) -> Floats:
        """Coefficients of exp(i nu.theta), by place; shape (m, points)."""
        from scipy import fft

        return np.asarray(fft.dct(values, type=1, workers=WORKERS) / self.period)


def dilated(harmonics: Ints, factor: float) -> Ints:
    """All harmonics, of both signs, in the smallest cross-polytope about the given ones, enlarged by a factor."""
    highest = np.maximum(np.abs(harmonics).max(axis=0), 1)
    reach = factor * float((np.abs(harmonics) / highest).sum(axis=1).max())
    rows, left = np.zeros((1, 0), dtype=np.int64), np.array([reach])
    for k in highest.tolist():
        tops = np.floor(left * k + 1e-9).astype(np.int64)
        counts = 2 * tops + 1
        at = np.repeat(np.arange(len(rows)), counts)
        numbers = np.arange(len(at)) - np.repeat(np.cumsum(counts) - counts, counts) - tops[at]
        rows, left = np.column_stack([rows[at], numbers]), left[at] - np.abs(numbers) / k
    return np.asarray(rows)


@lru_cache(maxsize=8)
def _known_lattice(content: bytes, s: int) -> tuple[int, tuple[int, ...]]:
    from scipy import fft

    harmonics = np.frombuffer(content, dtype=np.int64).reshape(-1, s)
    draw = np.random.default_rng(0)  # any will do; the same every time
    few = harmonics[draw.permutation(len(harmonics))[:FEW]]
    size = float(len(harmonics))
    while True:
        period = 2 * fft.next_fast_len(max(1, int(np.ceil(size / 2))), real=True)
        for factor in draw.integers(1, period, TRIALS) if s > 1 else [1]:
            generator = np.array([pow(int(factor), k, period) for k in range(s)])
            if all(len(np.unique(part @ generator % period)) == len(part) for part in (few, harmonics)):
                return period, tuple(generator.tolist())
        size *= 1.1


def generated_lattice(harmonics: Ints) -> tuple[int, Ints]:
    """A short period M and a generator g = (1, a, a^2, ...) for which nu.g modulo M differs for all given harmonics."""
    period, generator = _known_lattice(np.ascontiguousarray(harmonics).tobytes(), harmonics.shape[1])
    return period, np.array(generator)


WORKERS = os.cpu_count() or 1
FEW, TRIALS = 500, 60  # harmonics that are tried first, and generators of one period


class InvarianceEquation:
    """The equations of one torus: divisors (H, N-1) and forces (H, N-1) of coefficients (H, N-1), unknown where `mask` holds."""

    def __init__(self, chain: Chain, seeds: Sequence[int], harmonics: Ints) -> None:
        self.chain, self.seeds, self.harmonics = chain, tuple(seeds), harmonics
        N, modes = chain.N, np.arange(1, chain.N)
        self.grid = Lattice(harmonics)
        parity = (harmonics @ np.array(seeds))[:, None] % 2 == modes % 2
        self.mask = parity if chain.alpha else parity & (harmonics.sum(axis=1) % 2 == 1)[:, None]
        self.seed_rows = np.array([int(np.flatnonzero((harmonics == e).all(axis=1))[0]) for e in np.eye(len(seeds), dtype=np.int64)])
        self.seed_columns = np.array(seeds) - 1
        half = np.arange((N + 1) // 2)
        with mpmath.workdps(2 * DIGITS):
            linear = [chain.linear_frequency(q) for q in modes.tolist()]
            cosines = np.array([long(mpmath.cospi(mpmath.mpf(k) / (2 * N))) for k in range(4 * N)])
            norm = long(mpmath.sqrt(mpmath.mpf(2) / N))
        self.linear = np.array([long(w) for w in linear])
        self._all_bonds = norm * self.linear[:, None] * cosines[np.outer(modes, 2 * np.arange(N) + 1) % (4 * N)]
        self._stretch = self._all_bonds[:, : len(half)]
        self._back = self._stretch * np.where(2 * half + 1 == N, 1, 2)
        self._law = tuple(long(coupling) for coupling in chain.couplings)
        high, low = (np.array(part) for part in zip(*map(_halves, linear), strict=True))
        with mpmath.workdps(2 * DIGITS):
            exact = [mpmath.fdot(nu, [linear[q - 1] for q in seeds]) for nu in harmonics.tolist()]
        rate_high, rate_low = (np.array(part)[:, None] for part in zip(*map(_halves, exact), strict=True))
        self._below = (rate_high - high) + (rate_low - low)
        self._above = (rate_high + high) + (rate_low + low)

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_q^2 for omega = Omega + shifts of the seeds, all in long doubles; shape (H, N-1).

        nu.Omega - Omega_q, where digits cancel, is taken from twice as many.
        """
        moved = (self.harmonics @ shifts)[:, None]
        return np.asarray((self._below + moved) * (self._above + moved))

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega in long doubles; shape (H,)."""
        return np.asarray(self.harmonics @ (self.linear[self.seed_columns] + shifts))

    def _portions(self) -> list[slice]:
        step, count = max(1, PORTION // self.grid.points), self._stretch.shape[1]
        return [slice(j, j + step) for j in range(0, count, step)]

    def force(self, cosines: Floats) -> Floats:
        """N_q[nu] of coefficients (H, N-1), in their precision; zero where the mask does not hold."""
        kind = cosines.dtype
        law = tuple(coupling.astype(kind) for coupling in self._law)
        total = np.zeros(cosines.shape, dtype=kind)
        for part in self._portions():
            r = self.grid.values(cosines @ self._stretch[:, part].astype(kind))
            total += self.grid.coefficients(bonds.anharmonic_tension(law, r)) @ self._back[:, part].T.astype(kind)
        return np.asarray(total * self.mask)

    def potential(self, Q: Floats) -> np.longdouble:
        """The potential energy of mode coordinates (N-1,), by all bonds."""
        return np.longdouble(bonds.potential(self._law, Q @ self._all_bonds).sum())

    def potential_slope(self, Q: Floats) -> Floats:
        """Its gradient; shape (N-1,)."""
        return np.asarray(self._all_bonds @ bonds.tension(self._law, Q @ self._all_bonds))

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 on the lattice, in doubles; shape (bonds, points)."""
        law = self.chain.law()
        result = np.empty((self._stretch.shape[1], self.grid.points))
        for part in self._portions():
            r = self.grid.values(np.asarray(cosines @ self._stretch[:, part]).astype(float))
            result[part] = bonds.anharmonic_stiffness(law, r)
        return result

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles; shapes (H, N-1)."""
        total = np.zeros(change.shape)
        for part in self._portions():
            d = self.grid.values(change @ self._stretch[:, part].astype(float))
            total += self.grid.coefficients(slopes[part] * d) @ self._back[:, part].T.astype(float)
        return np.asarray(total * self.mask)

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between chosen unknowns (row of the harmonic, column of the mode); shape (m, m).

        Of a unit of cos(nu'.theta) the coefficient at nu is slope[nu - nu'] + slope[nu + nu'], without the second for nu = 0.
        """
        spectrum = np.concatenate([self.grid.spectrum(slopes[part]) for part in self._portions()]).T.copy()
        nu, still = self.harmonics[rows], (self.harmonics[rows] == 0).all(axis=1)
        out, back = self._stretch.astype(float)[columns], self._back.astype(float)[columns]
        along = nu @ self.grid.generator
        matrix = np.empty((len(rows), len(rows)))
        for a in range(len(rows)):
            both = spectrum[self.grid.folded(along[a] - along)]
            if not still[a]:
                both += spectrum[self.grid.folded(along[a] + along)]
            both *= out
            matrix[a] = both @ back[a]
        return matrix

    def sparse_derivative(self, slopes: Floats) -> Any:
        """The derivative of the force by the largest harmonics of the slopes alone, as a sparse matrix between all unknowns (in the
        order of the mask)."""
        from scipy import sparse

        spectrum = np.concatenate([self.grid.spectrum(slopes[part]) for part in self._portions()])
        heights = np.abs(spectrum).max(axis=0)
        nu = self.harmonics
        height = heights[self.grid.entries(nu)]
        most = min(MOST_SLOPES, max(1, MOST_ENTRIES // (int(self.mask.sum()) * 4)))  # two modes a row and sign
        chosen = nu[np.argsort(-height, kind="stable")[:most]]
        chosen = chosen[heights[self.grid.entries(chosen)] > SHARE * heights.max()]
        number = np.full(self.mask.shape, -1, dtype=np.int32)
        number[self.mask] = np.arange(int(self.mask.sum()))
        parts = []
        for kappa in np.unique(np.concatenate([chosen, -chosen]), axis=0):
            coupling = (self._back.astype(float) * spectrum[:, self.grid.entries(kappa)]) @ self._stretch.astype(float).T
            at, to = np.nonzero(np.abs(coupling) > 1e-3 * np.abs(coupling).max())
            rows, columns = self._shifted(kappa)
            still_row, still_column = (nu[rows] == 0).all(axis=1), (nu[columns] == 0).all(axis=1)
            weight = np.where(still_row, 0.5, 1.0) * np.where(still_column, 2.0, 1.0)
            values = weight[:, None] * coupling[at, to]
            i, j = number[rows[:, None], at], number[columns[:, None], to]
            inside = (i >= 0) & (j >= 0)
            parts.append((values[inside], i[inside], j[inside]))
        values, i, j = (np.concatenate(x) for x in zip(*parts, strict=True))
        return sparse.csr_matrix((values, (i, j)), shape=(int(self.mask.sum()),) * 2)

    def _shifted(self, kappa: Ints) -> tuple[Ints, Ints]:
        """Rows of harmonics nu and of nu - kappa (or its negative), where both are chosen."""
        base = 4 * np.abs(self.harmonics).max(axis=0) + 3
        weights = np.cumprod(np.append(base[1:], 1)[::-1])[::-1]
        shifted = self.harmonics - kappa
        lead = shifted[np.arange(len(shifted)), np.argmax(shifted != 0, axis=1)]
        keys, wanted = self.harmonics @ weights, np.where(lead < 0, -1, 1) * (shifted @ weights)
        order = np.argsort(keys)
        place = order[np.clip(np.searchsorted(keys[order], wanted), 0, len(keys) - 1)]
        rows = np.flatnonzero((keys[place] == wanted) & (np.abs(shifted) <= np.abs(self.harmonics).max(axis=0)).all(axis=1))
        return rows, place[rows]
