"""The contraction around one Floquet exponent: choices and bounds in doubles, roundings bounded.

L(sigma) v = 0 with v = 1 at a place kappa, sigma in its stead; the approximate inverse is that of
a block of places and 1/lambda elsewhere. Every entry of a matrix carries a bound of its rounding,
and sums of positive numbers are enlarged. Ours; docs/stability-proofs.md has the theorem.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.certified.exponents import FourierZero, Guess, Values, coupled
from symfpu.certified.sectors import Ints, Sector

Floats = NDArray[np.float64]

ROUNDOFF = 2.0**-53
UPWARDS = 1 + 1e-9
HUGE = 1e14
POWERS, MEAN_OF = 12, 6
NO_DENORMALS = 1e-25  # which are slow
LETTERS = (
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    "!#$%&()*+,-./:;<=>?@[]^_`{|}~"
)
OCTAVE = 4  # weights are 2^(letter/4), rounded down to 8 binary places
WEIGHTS = np.array(
    [math.isqrt(math.isqrt(2 ** (k + 32))) / 256 for k in range(len(LETTERS))]
)
FIRST_BLOCK, SMALLEST_GROWTH, LARGEST_BLOCK = 6, 4, 160
GOOD_RADIUS = 0.6  # of |I - A DF|, so that coarse weights make its norm less than 1
LEAST_RATE, LARGEST_RATE, RATES = 0.4, 0.85, 4  # that weights are asked for
MOST_RADIUS = 0.85
SLACK = 1.02  # of all bounds, so that coarser ones suffice
RADIUS_SLACK = 1.25


@dataclass(frozen=True, eq=False)
class Slopes:
    """G_qp[k] in doubles and what they leave out.

    coupling : shape (all + 1, N-1, N-1); K : harmonics that the norm of I - A DF sees.
    omega_off : above what the frequency of the true orbit is off omega, 0 where it is given.
    lost : above the sum over bonds of the moduli of Fourier coefficients of what is not in
        `coupling`, the orbit's own radius among it; cut : the same with harmonics beyond K.
    entry : above the rounding of an entry, summed over harmonics. reach : the harmonics from
        which on the diagonal rules alone, over the highest mode.
    """

    N: int
    omega: float
    omega_off: float
    linear: Floats
    coupling: Floats
    K: int
    lost: float
    cut: float
    entry: float
    reach: float

    def free(self, sector: Sector) -> int:
        """M: the diagonal rules all places with |n| > M."""
        top = self.reach * float(self.linear[-1]) / self.omega
        return math.ceil(top + sector.folds / 2) + 2


@dataclass(frozen=True, eq=False)
class Choice:
    """Indices of the block into the places up to M, and a letter for the weight of each place."""

    block: Ints
    letters: str

    @property
    def weights(self) -> Floats:
        """w of the places up to M."""
        return WEIGHTS[[LETTERS.index(x) for x in self.letters]]


@dataclass(frozen=True, eq=False)
class ExponentBounds:
    """Y, Z and what Z2 is made of.

    lost : the part of Z from what the slopes leave out. weight : of sigma. curvatures : e1, e2,
        e3 of the theorem.
    """

    residual: float
    linear: float
    lost: float
    curvatures: tuple[float, float, float]
    weight: float

    @property
    def needed(self) -> float:
        """What Y would have to be below, about."""
        e1, _, e3 = self.curvatures
        return (1 - self.linear) ** 2 / (4 * (e1 / self.weight + e3 / self.weight**2))

    def rate(self, radius: float) -> float:
        """Z + Z2(radius) radius."""
        e1, e2, e3 = self.curvatures
        w = self.weight
        curvature = e1 / w + e2 * radius / w**2 + e3 / w**2
        return SLACK * (self.linear + curvature * radius)

    @property
    def radius(self) -> float | None:
        """Of a ball that is mapped into itself; None where there is none."""
        if not SLACK * self.linear < 1:
            return None
        radius = RADIUS_SLACK * SLACK * self.residual / (1 - SLACK * self.linear)
        inside = SLACK * self.residual + self.rate(radius) * radius <= radius
        return radius if inside and self.rate(radius) < 1 else None


@dataclass(frozen=True, eq=False)
class RoundedZero:
    """sigma = base h omega/2 + sigma 2^-bits and v 2^-bits: integers, re and im.

    rows : by harmonic from -harmonics to harmonics, all modes; those of kappa are (2^bits, 0).
    """

    guess: Guess
    bits: int
    sigma: tuple[int, int]
    kappa: tuple[int, int]
    harmonics: int
    rows: tuple[NDArray[np.int64], NDArray[np.int64]]

    @property
    def value(self) -> complex:
        """sigma without its base."""
        return complex(*(math.ldexp(x, -self.bits) for x in self.sigma))

    @cached_property
    def v(self) -> Values:
        """The coefficients, shape (2 harmonics + 1, N-1)."""
        re, im = (np.ldexp(part.astype(float), -self.bits) for part in self.rows)
        found: Values = re if self.guess.circle else re + 1j * im
        return found


def rounded_zero(zero: FourierZero, bits: int, N: int) -> RoundedZero:
    """The nearest integers; harmonics without any are left out."""
    last = int(np.abs(zero.n).max())
    table = np.zeros((2 * last + 1, N - 1), dtype=complex)
    table[zero.n + last, zero.q - 1] = zero.v
    scaled = np.ldexp(table.real, bits), np.ldexp(table.imag, bits)
    re, im = (np.rint(part).astype(np.int64) for part in scaled)
    used = np.abs(np.flatnonzero((re != 0).any(axis=1) | (im != 0).any(axis=1)) - last)
    H = int(used.max())
    re, im = re[last - H : last + H + 1], im[last - H : last + H + 1]
    sigma = tuple(round(math.ldexp(x, bits)) for x in (zero.value.real, zero.value.imag))
    kappa = int(zero.n[zero.place]), int(zero.q[zero.place])
    return RoundedZero(zero.guess, bits, (sigma[0], sigma[1]), kappa, H, (re, im))


def size(z: Values) -> Floats:
    """|Re| + |Im|."""
    return np.asarray(np.abs(z.real) + np.abs(z.imag))


class Attempt:
    """Matrices of the theorem at a rounded zero, harmonics up to M, M + K and M + 2 K."""

    def __init__(self, slopes: Slopes, zero: RoundedZero) -> None:
        self.slopes, self.zero = slopes, zero
        self.sector, self.M = zero.guess.sector, slopes.free(zero.guess.sector)
        self.columns = self.M + slopes.K
        self.places = self.sector.places(self.columns + slopes.K)
        n = self.places[0]
        self.own = np.flatnonzero(np.abs(n) <= self.M)
        self.taken = np.flatnonzero(np.abs(n) <= self.columns)
        self.z, self.squared = self.angles(n), slopes.linear[self.places[1] - 1] ** 2
        self.divisors = 1 - self.z**2 / self.squared
        errors = 16 * ROUNDOFF * (1 + self.magnitude(n) ** 2 / self.squared)
        relative = 4 * errors / np.maximum(np.abs(self.divisors), 1 / HUGE)
        self.divisor_errors = errors
        inverse = np.where(relative < 0.01, 1 / self.divisors, HUGE)
        self.inverse_sizes = size(inverse) * (1 + relative) * UPWARDS
        kappa = (n == zero.kappa[0]) & (self.places[1] == zero.kappa[1])
        self.kappa = int(np.flatnonzero(kappa)[0])
        self.slope = -2 * self.z / self.squared * self.coefficients()
        turns = zero.guess.base * self.sector.folds / 2
        self.moved_angles = np.abs(n + turns) * slopes.omega_off * UPWARDS
        twice = 3 * self.magnitude(n) + self.moved_angles  # above 2 (|Re z| + |Im z|)
        self.moved = self.moved_angles * twice / self.squared * UPWARDS

    def angles(self, n: Ints) -> Values:
        """sigma + n omega."""
        guess, zero = self.zero.guess, self.zero
        shift = guess.base * self.sector.folds * self.slopes.omega / 2
        z: Values = n * self.slopes.omega + (shift + zero.value)
        return z.real if guess.circle else z

    def magnitude(self, n: Ints) -> Floats:
        """Above |sigma + n omega| with room for what it loses by cancellation."""
        omega = self.slopes.omega
        return np.asarray(np.abs(self.angles(n)) + (np.abs(n) + 2) * omega)

    def coefficients(self) -> Values:
        """v at all places."""
        n, q = self.places
        H = self.zero.harmonics
        inside = np.abs(n) <= H
        return np.where(inside, self.zero.v[np.clip(n, -H, H) + H, q - 1], 0)

    def derivative(self, rows: Ints, columns: Ints, *, diagonal: bool) -> Values:
        """DF by indices of places, with the divisors or without."""
        n, q = self.places
        coupling = self.slopes.coupling[: self.slopes.K + 1]
        matrix: Values = coupled(coupling, (n[rows], q[rows]), (n[columns], q[columns]))
        if not self.zero.guess.circle:
            matrix = matrix.astype(complex)
        if diagonal:
            same = rows[:, None] == columns
            matrix = matrix + np.where(same, self.divisors[columns], 0)
        matrix[:, columns == self.kappa] = self.slope[rows][:, None]
        return matrix

    def defect(self, block: Ints, outside: Floats, columns: Ints, rows: Ints) -> Floats:
        """Above |I - A DF| by entries; `outside` is that of the diagonal in all rows."""
        among = np.searchsorted(rows, block)
        square = self.derivative(block, block, diagonal=True)
        full = self.derivative(block, columns, diagonal=True)
        A = np.linalg.inv(square)
        product = -(A @ full)
        product[np.arange(len(block)), np.searchsorted(columns, block)] += 1
        errors = 4 * (len(block) + 8) * ROUNDOFF * np.abs(full)
        errors[np.arange(len(block)), np.searchsorted(columns, block)] += (
            4 * self.divisor_errors[block]
        )
        result = outside.copy()
        result[among] = size(product) + size(A) @ errors
        return result

    def diagonal_part(self, rows: Ints, columns: Ints) -> Floats:
        """|DF| over |lambda|, as rows outside the block have it."""
        matrix = size(self.derivative(rows, columns, diagonal=False))
        return np.asarray(self.inverse_sizes[rows][:, None] * matrix)

    def choice(self) -> tuple[Choice | None, str, float]:
        """Block and weights that make |I - A DF| small.

        None where there are none: then "Z" and its spectral radius, or "weights" and the largest.
        """
        own = self.own
        outside = self.diagonal_part(own, own)
        order = np.argsort(-outside.sum(axis=1), kind="stable")
        kappa = int(np.searchsorted(own, self.kappa))
        block = np.union1d(order[:FIRST_BLOCK], kappa)
        x = y = np.ones(len(own), dtype=np.float32)
        while True:
            defect = np.maximum(self.defect(own[block], outside, own, own), NO_DENORMALS)
            single = defect.astype(np.float32)  # a choice needs no more
            x, radius = perron(single, x)
            y, _ = perron(single.T, y)
            if radius < GOOD_RADIUS or len(block) >= min(LARGEST_BLOCK, len(own)):
                break
            score = x * y
            score[block] = -1
            more = max(SMALLEST_GROWTH, len(block) // 2)
            block = np.union1d(block, np.argsort(-score, kind="stable")[:more])
        if not radius < MOST_RADIUS:
            return None, "Z", radius
        letters, largest = self.letters(self.whole_defect(block), radius)
        if letters is None:
            return None, "weights", largest
        return Choice(block, letters), "Z", radius

    def whole_defect(self, block: Ints) -> Floats:
        """Above |I - A DF|: all rows, columns up to M + K."""
        rows = np.arange(len(self.places[0]))
        outside = self.diagonal_part(rows, self.taken)
        return self.defect(self.own[block], outside, self.taken, rows)

    def bounds(self, choice: Choice) -> ExponentBounds:
        """All bounds with these choices."""
        block, w = self.own[choice.block], np.ones(len(self.places[0]))
        w[self.own] = choice.weights
        defect = self.whole_defect(choice.block)
        sizes = w * self.inverse_sizes
        A = np.linalg.inv(self.derivative(block, block, diagonal=True))
        sizes[block] = w[block] @ size(A)
        sizes *= UPWARDS
        of_columns = float(((w @ defect) / w[self.taken]).max()) * UPWARDS
        spread = self.spread(sizes)
        lost = (2 / self.slopes.N * self.slopes.cut + self.slopes.entry) * spread
        return ExponentBounds(
            residual=(self.residual(sizes, spread) + self.moved_residual(sizes)) * UPWARDS,
            linear=max(of_columns, self.tail()) + lost + self.moved_part(sizes, w) + 1e-9,
            lost=lost,
            curvatures=self.curvatures(sizes, w),
            weight=float(w[self.kappa]),
        )

    def letters(self, defect: Floats, radius: float) -> tuple[str | None, float]:
        """A letter for each weight, w |I - A DF| <= rho w about; the largest.

        None for the letters where weights are too large."""
        rows = np.isin(np.arange(len(defect)), self.own)
        own = defect[np.ix_(rows, np.isin(self.taken, self.own))]
        leaving = defect[np.ix_(~rows, np.isin(self.taken, self.own))].sum(axis=0)
        for rho in np.linspace(max(LEAST_RATE, (1 + 3 * radius) / 4), LARGEST_RATE, RATES):
            w = np.linalg.solve(rho * np.eye(len(own)) - own.T, leaving + rho)
            levels = np.rint(OCTAVE * np.log2(np.maximum(w, 1.0))).astype(int)
            if w.min() > 0 and levels.max() < len(LETTERS):
                return "".join(LETTERS[k] for k in levels), float(w.max())
        return None, float(w.max()) if w.min() > 0 else math.inf

    def edge(self, n: int) -> Floats:
        """Below (sigma + n omega)^2 / Omega_q^2 - 1 for |harmonics| from n on."""
        z = n * self.slopes.omega - abs(self.angles(np.array([0]))[0].real)
        return np.asarray((z / self.slopes.linear) ** 2 * (1 - 1e-12) - 1)

    def tail(self) -> float:
        """Columns beyond M + K: they meet rows beyond M alone."""
        coupling = np.abs(self.slopes.coupling[: self.slopes.K + 1])
        sums = coupling[0] + 2 * coupling[1:].sum(axis=0)
        edge = self.edge(self.M + 1)
        if not edge.min() > 0:
            return HUGE
        complex_size = 1 if self.zero.guess.circle else math.sqrt(2)
        return float((sums / edge[:, None]).sum(axis=0).max()) * complex_size * UPWARDS

    def beyond(self) -> Floats:
        """Above |1/lambda_q[n]| for |n| > M + K."""
        complex_size = 1 if self.zero.guess.circle else math.sqrt(2)
        return np.asarray(complex_size / self.edge(self.columns + 1) * UPWARDS)

    def spread(self, sizes: Floats) -> float:
        """S."""
        n = self.places[0][self.taken]
        sums = np.bincount(n + self.columns, weights=sizes[self.taken])
        return max(float(sums.max()), float(self.beyond().sum())) * UPWARDS

    def residual(self, sizes: Floats, spread: float) -> float:
        """Y."""
        zero, coupling = self.zero, self.slopes.coupling
        v, last, H = zero.v, len(coupling) - 1, zero.harmonics
        found = np.zeros((2 * (H + last) + 1, self.slopes.N - 1), dtype=v.dtype)
        total = np.zeros(found.shape)
        for k in range(-last, last + 1):
            of_slope = coupling[abs(k)]
            rows = slice(last + k, last + k + 2 * H + 1)
            found[rows] += v @ of_slope
            total[rows] += size(v) @ np.abs(of_slope)
        n = np.arange(-H, H + 1)
        z, squared = self.angles(n)[:, None], self.slopes.linear**2
        found[last : last + 2 * H + 1] += (1 - z**2 / squared) * v
        sizes_of_terms = 1 + self.magnitude(n)[:, None] ** 2 / squared
        total[last : last + 2 * H + 1] += sizes_of_terms * size(v)
        rounding = 8 * (2 * last + self.slopes.N + 16) * ROUNDOFF
        above = size(found) + rounding * total
        norms = self.norms(sizes, H + last)
        missing = (2 / self.slopes.N * self.slopes.lost + self.slopes.entry) * spread
        return float((norms * above).sum()) + missing * float(size(v).sum())

    def moved_residual(self, sizes: Floats) -> float:
        """|A (L* v - L v)| where L* has the frequency of the true orbit."""
        taken = self.taken
        parts = sizes[taken] * self.moved[taken] * size(self.coefficients()[taken])
        return float(parts.sum())

    def moved_part(self, sizes: Floats, w: Floats) -> float:
        """|A (DF* - DF)| where DF* has the frequency of the true orbit."""
        taken, v = self.taken, size(self.coefficients())
        other = taken[taken != self.kappa]
        of_sigma = 2 * sizes[taken] * self.moved_angles[taken] / self.squared[taken]
        of_kappa = float((of_sigma * v[taken]).sum()) / float(w[self.kappa])
        of_columns = float((sizes[other] * self.moved[other] / w[other]).max())
        omega, value = self.slopes.omega, self.zero.value
        part = self.slopes.omega_off / omega
        far = (self.columns + 2) * omega + abs(value.real) + abs(value.imag)
        beyond = self.beyond() * part * (2 + part) * far**2 / self.slopes.linear**2
        return max(of_kappa, of_columns, float(beyond.max())) * UPWARDS

    def norms(self, sizes: Floats, last: int) -> Floats:
        """a of all places up to a harmonic, zero where the symmetry forbids them."""
        table = np.zeros((2 * last + 1, self.slopes.N - 1))
        n, q = self.sector.places(last)
        table[n + last, q - 1] = self.beyond()[q - 1]
        n, q = self.places[0][self.taken], self.places[1][self.taken]
        inside = np.abs(n) <= last
        table[n[inside] + last, q[inside] - 1] = sizes[self.taken][inside]
        return table

    def curvatures(self, sizes: Floats, w: Floats) -> tuple[float, float, float]:
        """e1, e2, e3."""
        taken = self.taken
        ratios = 2 * sizes[taken] / self.squared[taken]
        e3 = float((ratios * size(self.coefficients()[taken])).sum())
        other = taken != self.kappa
        scaled = (ratios / w[taken])[other]
        z = (size(self.z[taken]) + self.moved_angles[taken])[other]
        squared = self.slopes.linear**2
        edge = self.beyond() * 2 / squared
        far = (self.columns + 1) * self.slopes.omega - abs(self.zero.value.real)
        far += 2 * self.slopes.omega * self.sector.folds + 2 * abs(self.zero.value.imag)
        far += (self.columns + 2) * self.slopes.omega_off
        e1 = max(float((scaled * z).max()), float((edge * far).max()))
        e2 = max(float(scaled.max()), float(edge.max()))
        return e1 * UPWARDS, e2 * UPWARDS, e3 * UPWARDS


def perron(matrix: NDArray[Any], start: NDArray[Any]) -> tuple[NDArray[Any], float]:
    """The eigenvector of a positive matrix from a guess, and its largest eigenvalue, about."""
    x, ratios = start, []
    for _ in range(POWERS):
        x = matrix @ x
        ratios.append(float(np.linalg.norm(x)))
        x = x / ratios[-1]
    # places that feed each other in turn make the ratios oscillate
    return x, math.prod(ratios[-MEAN_OF:]) ** (1 / MEAN_OF)
