"""The invariance equation of a torus in Fourier space: linear part exact, products pseudo-spectral.

Q_q(theta) = sum over nu of c_q[nu] cos(nu.theta) is a torus of the chain if for every mode and
harmonic ((nu.omega)^2 - Omega_q^2) c_q[nu] = N_q[nu], N the transform of V'(r) - r, which is
alpha r^2 + beta r^3 in an FPU chain, with the stretches r of the bonds on points of all angles.
Reflection of the chain shifts the angles by half turns: only c with q = nu.seeds (mod 2) are
unknowns (where V is even also nu of odd length), and half of the bonds are enough. All sums of
one kind run in one precision, doubles or the machine's long doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import threads_of_a_computation
from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.numbers.arithmetic import Arithmetic, mpf
from symfpu.refinement.equation import Floats, Ints, Slopes

# size, in that of the largest chosen harmonics, up to which harmonics are told apart
OVERSAMPLING = 2.5
PORTION = 4_000_000  # values of all bonds transformed at once
# harmonics of the slopes that a sparse derivative holds, and their least height, relative
MOST_SLOPES, SHARE = 12, 0.1
APART = 1e-5  # of stretches, for a derivative by differences
MOST_ENTRIES = 40_000_000  # of a sparse derivative; 16 bytes each
DIGITS = 30  # of the numbers that long doubles are made of


def long(value: Any) -> np.longdouble:
    """A rational or an mpf as a long double."""
    with mpmath.workdps(DIGITS):
        exact = mpf(value)
        return np.longdouble(mpmath.nstr(exact, DIGITS))


class LongDoubles(Arithmetic):
    """Numbers as long doubles."""

    def number(self, value: Fraction) -> np.longdouble:
        return long(value)


LONG_DOUBLES = LongDoubles()


def rational(value: np.longdouble) -> Fraction:
    """A long double as the number it is."""
    high = float(value)
    low = float(value - np.longdouble(high))
    return Fraction(high) + Fraction(low)


def halves(value: Any) -> tuple[np.longdouble, np.longdouble]:
    """An mpf as the sum of two long doubles."""
    high = long(value)
    with mpmath.workdps(2 * DIGITS):
        exact = rational(high)
        low = value - mpmath.mpf(exact.numerator) / exact.denominator
        return high, long(low)


def _halves_of_pairs(harmonics: Ints) -> Floats:
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
        self._weight = _halves_of_pairs(harmonics)

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
        return np.asarray(found.T / _halves_of_pairs(harmonics)[:, None])

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
    few = harmonics[draw.permutation(len(harmonics))[:FIRST_TRIED]]
    size = float(len(harmonics))
    while True:
        half = fft.next_fast_len(max(1, int(np.ceil(size / 2))), real=True)
        period = 2 * half
        factors = draw.integers(1, period, TRIALS) if s > 1 else [1]
        for factor in factors:
            generator = np.array([pow(int(factor), k, period) for k in range(s)])
            if _distinct(few, generator, period) and _distinct(
                harmonics, generator, period
            ):
                return period, tuple(generator.tolist())
        size *= 1.1


def _distinct(harmonics: Ints, generator: Ints, period: int) -> bool:
    """Whether nu.g modulo the period differs for all harmonics."""
    places = harmonics @ generator % period
    return len(np.unique(places)) == len(harmonics)


def generated_lattice(harmonics: Ints) -> tuple[int, Ints]:
    """A short period M and a generator g = (1, a, a^2, ...) that tell all given harmonics apart.

    nu.g modulo M differs for all of them.
    """
    content = np.ascontiguousarray(harmonics).tobytes()
    period, generator = _known_lattice(content, harmonics.shape[1])
    return period, np.array(generator)


def largest_slopes(grid: Lattice, spectrum: Floats, entries: int) -> Ints:
    """The harmonics of the slopes that a sparse derivative holds, one of each pair.

    spectrum : of the slopes, (bonds, points). entries : that one harmonic makes.

    They are among all harmonics as large as the chosen ones: where V is even the slopes have even
    harmonics alone, and the torus odd ones.
    """
    heights = np.abs(spectrum).max(axis=0)
    nu = without_opposites(dilated(grid.harmonics, 1))
    height = heights[grid.entries(nu)]
    most = min(MOST_SLOPES, max(1, MOST_ENTRIES // entries))
    order = np.argsort(-height, kind="stable")
    chosen = nu[order[:most]]
    tall = heights[grid.entries(chosen)] > SHARE * heights.max()
    return np.asarray(chosen[tall])


def shifted(harmonics: Ints, kappa: Ints) -> tuple[Ints, Ints]:
    """Rows of harmonics nu and of nu - kappa (or its negative), where both are chosen."""
    highest = np.abs(harmonics).max(axis=0)
    base = 4 * highest + 3
    weights = np.cumprod(np.append(base[1:], 1)[::-1])[::-1]
    moved = harmonics - kappa
    first_nonzero = np.argmax(moved != 0, axis=1)
    lead = moved[np.arange(len(moved)), first_nonzero]
    sign = np.where(lead < 0, -1, 1)
    keys, wanted = harmonics @ weights, sign * (moved @ weights)
    order = np.argsort(keys)
    nearest = np.searchsorted(keys[order], wanted)
    place = order[np.clip(nearest, 0, len(keys) - 1)]
    within = (np.abs(moved) <= highest).all(axis=1)
    rows = np.flatnonzero((keys[place] == wanted) & within)
    return rows, place[rows]


WORKERS = threads_of_a_computation()
FIRST_TRIED, TRIALS = (
    500,
    60,
)  # harmonics that are tried first, and generators of one period


def curvature(law: bonds.Law, r: Floats) -> Floats:
    """The third derivative of V by central differences of the second."""
    above, below = (bonds.anharmonic_stiffness(law, r + h) for h in (APART, -APART))
    return np.asarray((above - below) / (2 * APART))


class InvarianceEquation:
    """The equations of one torus: divisors and forces of coefficients, all (H, N-1).

    Coefficients are unknown where `mask` holds.
    """

    def __init__(self, chain: Chain, seeds: Sequence[int], harmonics: Ints) -> None:
        self.chain, self.seeds, self.harmonics = chain, tuple(seeds), harmonics
        self.grid = Lattice(harmonics)
        self.mask = self.allowed(harmonics)
        units = np.eye(len(seeds), dtype=np.int64)
        places = [np.flatnonzero((harmonics == e).all(axis=1)) for e in units]
        self.seed_rows = np.array([int(place[0]) for place in places])
        self.seed_columns = np.array(seeds) - 1
        with mpmath.workdps(2 * DIGITS):
            linear = [chain.linear_frequency(q) for q in range(1, chain.N)]
        self.linear = np.array([long(w) for w in linear])
        self._set_bonds()
        self._set_divisors(linear)

    def allowed(self, harmonics: Ints) -> NDArray[np.bool_]:
        """Where the selection rules let a mode carry a harmonic (H, s); shape (H, N-1)."""
        modes = np.arange(1, self.chain.N)
        of_harmonic = harmonics @ np.array(self.seeds) % 2
        parity = of_harmonic[:, None] == modes % 2
        if not self.chain.potential.even:
            return np.asarray(parity)
        odd = harmonics.sum(axis=1) % 2 == 1
        return np.asarray(parity & odd[:, None])

    def _set_bonds(self) -> None:
        """Stretches by a unit of each mode, and the way back from half of the bonds."""
        N, modes = self.chain.N, np.arange(1, self.chain.N)
        with mpmath.workdps(2 * DIGITS):
            exact = [mpmath.cospi(mpmath.mpf(k) / (2 * N)) for k in range(4 * N)]
            cosines = np.array([long(x) for x in exact])
            norm = long(mpmath.sqrt(mpmath.mpf(2) / N))
        angles = np.outer(modes, 2 * np.arange(N) + 1) % (4 * N)
        self._all_bonds = norm * self.linear[:, None] * cosines[angles]
        half = np.arange((N + 1) // 2)
        self._stretch = self._all_bonds[:, : len(half)]
        own_image = 2 * half + 1 == N
        self._back = self._stretch * np.where(own_image, 1, 2)
        self._law = self.chain.law(LONG_DOUBLES)

    def stretches_of_half(self) -> tuple[Floats, Floats]:
        """Stretches of half of the bonds by a unit of each mode, and the way back, in doubles.

        Both (N-1, bonds).
        """
        return self._stretch.astype(float), self._back.astype(float)

    def _set_divisors(self, linear: Sequence[Any]) -> None:
        """nu.Omega - Omega_q and nu.Omega + Omega_q from twice as many digits as they keep."""
        of_seeds = [linear[q - 1] for q in self.seeds]
        with mpmath.workdps(2 * DIGITS):
            exact = [mpmath.fdot(nu, of_seeds) for nu in self.harmonics.tolist()]
        high, low = (np.array(part) for part in zip(*map(halves, linear), strict=True))
        rates = zip(*map(halves, exact), strict=True)
        rate_high, rate_low = (np.array(part)[:, None] for part in rates)
        self._below = (rate_high - high) + (rate_low - low)
        self._above = (rate_high + high) + (rate_low + low)

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega_q^2 for omega = Omega + shifts of the seeds; shape (H, N-1).

        All in long doubles.

        nu.Omega - Omega_q, where digits cancel, is taken from twice as many.
        """
        moved = (self.harmonics @ shifts)[:, None]
        return np.asarray((self._below + moved) * (self._above + moved))

    @property
    def points(self) -> int:
        """Of the lattice."""
        return self.grid.points

    @property
    def seed_frequencies(self) -> Floats:
        """Omega of the seeds in long doubles; shape (s,)."""
        return np.asarray(self.linear[self.seed_columns])

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega in long doubles; shape (H,)."""
        omega = self.seed_frequencies + shifts
        return np.asarray(self.harmonics @ omega)

    def _portions(self) -> list[slice]:
        step = max(1, PORTION // self.grid.points)
        count = self._stretch.shape[1]
        return [slice(j, j + step) for j in range(0, count, step)]

    def force(self, cosines: Floats) -> Floats:
        """N_q[nu] of coefficients (H, N-1), in their precision.

        Zero where the mask does not hold.
        """
        kind = cosines.dtype
        law = bonds.cast(self._law, kind)
        total = np.zeros(cosines.shape, dtype=kind)
        for part in self._portions():
            there = self._stretch[:, part].astype(kind)
            back = self._back[:, part].T.astype(kind)
            r = self.grid.values(cosines @ there)
            tension = bonds.anharmonic_tension(law, r)
            total += self.grid.coefficients(tension) @ back
        return np.asarray(total * self.mask)

    def force_at(self, cosines: Floats, harmonics: Ints) -> Floats:
        """The same at harmonics (M, s) that were not chosen, next to those; shape (M, N-1)."""
        total = np.zeros((len(harmonics), cosines.shape[1]), dtype=np.longdouble)
        for part in self._portions():
            r = self.grid.values(cosines @ self._stretch[:, part])
            tension = bonds.anharmonic_tension(self._law, r)
            total += self.grid.coefficients_at(tension, harmonics) @ self._back[:, part].T
        return np.asarray(total * self.allowed(harmonics))

    def rounding(self, cosines: Floats) -> Floats:
        """What rounding in long doubles makes of the force of each mode, about; shape (N-1,).

        Every bond rounds at random at every point, and a force is a sum over bonds and points.
        """
        tension = np.zeros(self._stretch.shape[1])
        for part in self._portions():
            r = self.grid.values(cosines @ self._stretch[:, part])
            tension[part] = np.mean(bonds.anharmonic_tension(self._law, r) ** 2, axis=1)
        sizes = np.sqrt(self._back**2 @ tension)
        points = self.grid.points
        return np.asarray(
            np.finfo(np.longdouble).eps * np.sqrt(np.log2(points) / points) * sizes
        )

    def potential(self, Q: Floats) -> np.longdouble:
        """The potential energy of mode coordinates (N-1,), by all bonds."""
        each = bonds.potential(self._law, Q @ self._all_bonds)
        return np.longdouble(each.sum())

    def potential_slope(self, Q: Floats) -> Floats:
        """Its gradient; shape (N-1,)."""
        tension = bonds.tension(self._law, Q @ self._all_bonds)
        return np.asarray(self._all_bonds @ tension)

    def energy(
        self, cosines: Floats, shifts: Floats, *, harmonic: bool
    ) -> tuple[np.longdouble, Slopes]:
        """H, or the harmonic energy, at the angles zero, where the momenta vanish."""
        Q = cosines.sum(axis=0)
        if harmonic:
            energy, slope = (self.linear**2 * Q**2).sum() / 2, self.linear**2 * Q
        else:
            energy, slope = self.potential(Q), self.potential_slope(Q)
        by_cosine = np.broadcast_to(slope, cosines.shape) * self.mask
        return np.longdouble(energy), (by_cosine, np.zeros(len(shifts)))

    def seed_energy(
        self, place: int, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """E_q of a seed averaged over the angles."""
        column = self.seed_columns[place]
        c, rates = cosines[:, column], self.rates(shifts)
        weights = np.where((self.harmonics != 0).any(axis=1), 0.25, 0.5)
        sizes = weights * (rates**2 + self.linear[column] ** 2)
        by_cosine = np.zeros(cosines.shape, dtype=cosines.dtype)
        by_cosine[:, column] = 2 * sizes * c
        by_shift = (2 * weights * rates * c**2) @ self.harmonics
        return np.longdouble((sizes * c**2).sum()), (by_cosine, by_shift)

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 on the lattice, in doubles; shape (bonds, points)."""
        law = self.chain.law()
        result = np.empty((self._stretch.shape[1], self.grid.points))
        for part in self._portions():
            stretches = np.asarray(cosines @ self._stretch[:, part])
            r = self.grid.values(stretches.astype(float))
            result[part] = bonds.anharmonic_stiffness(law, r)
        return result

    def slope_changes(self, cosines: Floats, weights: Floats) -> Floats:
        """Derivatives of the mean of weights times slopes, (H, N-1); weights (bonds, points)."""
        there = self._stretch.astype(float)
        r = self.grid.values(np.asarray(cosines.astype(float) @ there))
        bent = weights * curvature(self.chain.law(), r)
        spectrum = self.grid.spectrum(bent)[:, self.grid.entries(self.harmonics)]
        return np.asarray((spectrum.T @ there.T) * self.mask)

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients, in doubles.

        Shapes (H, N-1).
        """
        total = np.zeros(change.shape)
        for part in self._portions():
            there = self._stretch[:, part].astype(float)
            back = self._back[:, part].T.astype(float)
            d = self.grid.values(change @ there)
            total += self.grid.coefficients(slopes[part] * d) @ back
        return np.asarray(total * self.mask)

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between chosen unknowns; shape (m, m).

        rows, columns : of harmonic and mode. Of a unit of cos(nu'.theta) the coefficient at nu is
        slope[nu - nu'] + slope[nu + nu'], without the second for nu = 0.
        """
        spectrum = self._spectrum(slopes).T.copy()
        nu = self.harmonics[rows]
        still = (nu == 0).all(axis=1)
        out = self._stretch.astype(float)[columns]
        back = self._back.astype(float)[columns]
        along = nu @ self.grid.generator
        matrix = np.empty((len(rows), len(rows)))
        for a in range(len(rows)):
            both = spectrum[self.grid.folded(along[a] - along)]
            if not still[a]:
                both += spectrum[self.grid.folded(along[a] + along)]
            both *= out
            matrix[a] = both @ back[a]
        return matrix

    def _spectrum(self, slopes: Floats) -> Floats:
        """Coefficients of the slopes of all bonds, by place; shape (bonds, points)."""
        return np.concatenate(
            [self.grid.spectrum(slopes[part]) for part in self._portions()]
        )

    def sparse_derivative(self, slopes: Floats) -> Any:
        """The derivative of the force by the largest harmonics of the slopes alone.

        A sparse matrix between all unknowns, in the order of the mask.
        """
        from scipy import sparse

        spectrum = self._spectrum(slopes)
        unknowns = int(self.mask.sum())
        # two modes a row and sign
        chosen = largest_slopes(self.grid, spectrum, 4 * unknowns)
        number = np.full(self.mask.shape, -1, dtype=np.int32)
        number[self.mask] = np.arange(unknowns)
        both_signs = np.unique(np.concatenate([chosen, -chosen]), axis=0)
        parts = [self._coupled_by(kappa, spectrum, number) for kappa in both_signs]
        values, i, j = (np.concatenate(x) for x in zip(*parts, strict=True))
        return sparse.csr_matrix((values, (i, j)), shape=(unknowns, unknowns))

    def _coupled_by(
        self, kappa: Ints, spectrum: Floats, number: NDArray[np.int32]
    ) -> tuple[Floats, NDArray[np.int32], NDArray[np.int32]]:
        """Entries of the derivative by one harmonic of the slopes: values, rows, columns."""
        nu = self.harmonics
        slope = spectrum[:, self.grid.entries(kappa)]
        coupling = (self._back.astype(float) * slope) @ self._stretch.astype(float).T
        sizes = np.abs(coupling)
        at, to = np.nonzero(sizes > 1e-3 * sizes.max())
        rows, columns = shifted(self.harmonics, kappa)
        still_row = (nu[rows] == 0).all(axis=1)
        still_column = (nu[columns] == 0).all(axis=1)
        weight = np.where(still_row, 0.5, 1.0) * np.where(still_column, 2.0, 1.0)
        values = weight[:, None] * coupling[at, to]
        i, j = number[rows[:, None], at], number[columns[:, None], to]
        inside = (i >= 0) & (j >= 0)
        return values[inside], i[inside], j[inside]
