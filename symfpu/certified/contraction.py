"""The contraction of a proof of existence: approximate inverse, weights, and how far I - A DF is
from zero, in doubles whose rounding is bounded.

A is the inverse of a small block, an integer matrix times 2^-INVERSE_BITS, and 1/lambda_q[n] =
1/(1 - n^2 omega^2/Omega_q^2) elsewhere. Weights are w = v nu^n with integers v 2^-WEIGHT_BITS for
n up to FREE harmonics, 1 beyond. The slopes of the bonds enter with K harmonics, rounded to
doubles; the norm of the rest is a bound of its own. Where the frequency is an unknown, it and its
equation are the first place, n = q = 0, always in the block. Ours; docs/existence.md has the proof.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from symfpu.certified.layout import ROUNDOFF, Layout
from symfpu.certified.room import require_room

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

INVERSE_BITS = 8
WEIGHT_BITS = 6
UPWARDS = 1 + 1e-9  # more than sums of so many positive doubles lose
SMALLEST_DIVISOR = 1e-14
MARGIN = 1e-12  # relative, more than the divisors beyond all resonances lose
MOST_RADIUS = 0.85  # of |I - A DF|, so that weights make its norm less than 1
LEAST_RATE = 0.5  # that weights are asked for
MOST_LINEAR = 0.93  # of the norm of I - A DF
LARGEST_WEIGHT, LARGEST_ENTRY = 2.0**40, 2**52
POWERS = 60
FIRST_FREE, WIDENING, WIDENINGS = 1.3, 1.3, 5  # harmonics, in units of the highest mode
FIRST_BLOCK, SMALLEST_GROWTH, LARGEST_BLOCK = 8, 4, 400
MATRICES = 7  # of rows by columns, that are there at once


@dataclass(frozen=True)
class Places:
    """The unknowns up to a harmonic, ascending: their harmonics n and modes q.

    An unknown frequency is the first, n = q = 0.
    """

    n: Ints
    q: Ints

    @property
    def bordered(self) -> bool:
        """Whether the frequency is among them."""
        return bool(self.q[0] == 0)


def places_of(layout: Layout, harmonics: int, *, bordered: bool = False) -> Places:
    """Those that the symmetry allows."""
    harmonic, mode = np.nonzero(layout.allowed(harmonics))
    first = [0] if bordered else []
    return Places(
        np.append(first, harmonic).astype(int), np.append(first, mode + 1).astype(int)
    )


@dataclass(frozen=True, eq=False)
class BorderLine:
    """The row and the column of an unknown frequency in doubles, with bounds of their rounding.

    unit : omega^2 of 1. of_seed, rows, row_errors, corner : derivatives of the equation by c_s[1]
        alone, by every c_q[n], shape (.., modes), and by the unknown; nu^n times any later one is
        below `beyond`. column : of F_q[n] by the unknown, shape (H+1, modes).
    """

    seed: int
    unit: float
    of_seed: int
    rows: Floats
    row_errors: Floats
    beyond: float
    corner: int
    column: Floats

    def row(self, places: Places) -> tuple[Floats, Floats]:
        """Derivatives of the equation; nothing for the first place."""
        values, errors = at(self.rows, places), at(self.row_errors, places)
        seed = (places.n == 1) & (places.q == self.seed)
        return values + self.of_seed * seed, errors

    def derivatives(self, places: Places) -> tuple[Floats, Floats]:
        """Of F by the unknown."""
        values = at(self.column, places)
        return values, 16 * ROUNDOFF * np.abs(values)


def at(table: Floats, places: Places) -> Floats:
    """Entries of a table by harmonic and mode, 0 beyond its end."""
    inside = places.n < len(table)
    return np.where(inside, table[places.n * inside, places.q - 1], 0.0)


@dataclass(frozen=True, eq=False)
class LinearPart:
    """DF at the orbit, its slopes cut after K harmonics.

    slopes : g_0, g_1/2, .. of every bond in doubles, shape (K+1, bonds). rest : above the sum over
        bonds of the norms of what is left out.
    """

    layout: Layout
    omega: float
    nu: float
    slopes: Floats
    rest: float
    border: BorderLine | None = None

    @property
    def K(self) -> int:
        """The last harmonic of the slopes."""
        return len(self.slopes) - 1

    def divisors(self, places: Places) -> Floats:
        """lambda_q[n] = 1 - n^2 omega^2 / Omega_q^2."""
        linear = self.layout.frequencies()[places.q - 1]
        divisors = np.asarray(1 - (places.n * self.omega / linear) ** 2)
        if self.border is not None:
            divisors[0] = self.border.corner
        return divisors

    def divisor_errors(self, places: Places) -> Floats:
        """Above the rounding of the divisors."""
        linear = self.layout.frequencies()[places.q - 1]
        return np.asarray(16 * ROUNDOFF * (1 + (places.n * self.omega / linear) ** 2))

    @cached_property
    def coupling(self) -> Floats:
        """By harmonic of the slope, what couples two modes; shape (K+1, modes, modes)."""
        return self._couplings[0]

    @cached_property
    def coupling_errors(self) -> Floats:
        """Above the rounding of the couplings of a harmonic, shape (K+1,)."""
        return self._couplings[1]

    @cached_property
    def _couplings(self) -> tuple[Floats, Floats]:
        return self.layout.coupling(self.slopes)

    def matrix(self, rows: Places, columns: Places) -> tuple[Floats, Floats]:
        """Derivatives of the anharmonic force, and a bound of their rounding."""
        values = np.zeros((len(rows.n), len(columns.n)))
        errors = np.zeros_like(values)
        for n in range(int(rows.n[-1]) + 1):
            near = within(columns.n, n - self.K, n + self.K)
            own = within(rows.n, n, n)
            entries, rounding = self._of_harmonic(n, columns.n[near], columns.q[near])
            values[own, near] = entries[:, rows.q[own] - 1].T
            errors[own, near] = rounding
        if self.border is not None:
            values[0], errors[0] = self.border.row(columns)
            values[:, 0], errors[:, 0] = self.border.derivatives(rows)
            values[0, 0] = errors[0, 0] = 0.0  # the corner is among the divisors
        return values, errors

    def _of_harmonic(self, n: int, m: Ints, q: Ints) -> tuple[Floats, Floats]:
        """Rows of all modes at a harmonic n, by column and mode; columns (m, q) within K of it."""
        values = self.coupling[abs(n - m), q - 1]
        errors = self.coupling_errors[abs(n - m)]
        folded = np.flatnonzero((n > 0) & (n + m <= self.K))
        values[folded] += self.coupling[n + m[folded], q[folded] - 1]
        errors[folded] += self.coupling_errors[n + m[folded]]
        return values, errors


def within(ascending: Ints, first: int, last: int) -> slice:
    """Where they are from the first to the last."""
    start = np.searchsorted(ascending, first)
    return slice(int(start), int(np.searchsorted(ascending, last, side="right")))


@dataclass(frozen=True, eq=False)
class Contraction:
    """Choices and bounds.

    free, columns : the last harmonic whose weights are free, and the last whose columns are taken
        one by one. block : places of the block among those up to `columns`. inverse : integers.
    weights : integers v of the places up to `free`.
    linear : Z0 + Z1, above the norm of I - A DF with slopes cut. spread : above
        sum_q nu^-n |A e_q[n]| for every n; the share of a bond times it bounds A on what one gives.
    columns_of_inverse : above |A e| nu^-n by place, up to `columns`; beyond, those of every mode
        are below `beyond`.
    of_frequency : above |A d^2 F/dm dc h| / (|m| |h|), where the frequency is an unknown, else 0.
    """

    part: LinearPart
    places: Places
    free: int
    block: Ints
    inverse: Ints
    weights: Ints
    linear: float
    spread: float
    columns_of_inverse: Floats
    beyond: Floats
    of_frequency: float


class Attempt:
    """Bounds for cutoffs that are given."""

    def __init__(self, part: LinearPart, free: int) -> None:
        self.part, self.free, self.columns = part, free, free + part.K
        bordered = part.border is not None
        last = self.columns + part.K
        if part.border is not None:
            last = max(last, len(part.border.column) - 1)
        self.inside = places_of(part.layout, self.columns, bordered=bordered)
        self.rows = places_of(part.layout, last, bordered=bordered)
        require_room(part.layout.chain.N, len(self.rows.n), len(self.inside.n), MATRICES)
        self.divisors = part.divisors(self.rows)
        self.errors = part.divisor_errors(self.rows)
        self.count = len(self.inside.n)
        self.free_count = int((self.inside.n <= free).sum())
        self.force, self.force_errors = part.matrix(self.rows, self.inside)
        # of a column to the weight nu^n of its place
        powers = part.nu ** np.arange(-self.columns, last + 1.0)
        self.scales = powers[self.rows.n[:, None] - self.inside.n + self.columns]
        # a divisor that may be zero makes the bounds huge, and the attempt fail
        self.diagonal = np.maximum(abs(self.divisors) - self.errors, SMALLEST_DIVISOR)
        # above the rows of |I - A DF| that no block changes
        sizes = (np.abs(self.force) + self.force_errors) / self.diagonal[:, None]
        self.outside = sizes * self.scales * UPWARDS

    def importance(self) -> Floats:
        """How much the rows with free weights fail to be dominated by the diagonal."""
        sums = np.abs(self.force[: self.free_count]).sum(axis=1)
        scores = sums / self.diagonal[: self.free_count]
        if self.inside.bordered:
            scores[0] = math.inf
        return np.asarray(scores)

    def order(self) -> Ints:
        """Places, those that need the block most first."""
        return np.argsort(-self.importance(), kind="stable")

    def inverse(self, block: Ints) -> Floats:
        """Of DF on the block, rounded to integers."""
        square = self.force[np.ix_(block, block)] + np.diag(self.divisors[block])
        inverse = np.linalg.inv(square)
        return np.asarray(np.rint(np.ldexp(inverse, INVERSE_BITS)))

    def defect(self, block: Ints, inverse: Ints) -> Floats:
        """Above the entries of |I - A DF|, columns up to `columns`, in units of nu^n."""
        A = np.ldexp(inverse.astype(float), -INVERSE_BITS)
        full, errors = self.force[block], self.force_errors[block]
        own = np.arange(len(block))
        full[own, block] += self.divisors[block]
        errors[own, block] += self.errors[block]
        errors = errors + 2 * ROUNDOFF * np.abs(full)
        product = -(A @ full)
        product[own, block] += 1
        size = np.abs(A) @ np.abs(full)
        lost = (len(block) + 4) * ROUNDOFF * (size + 1)
        bounds = self.outside.copy()
        inner = np.abs(product) + np.abs(A) @ errors + lost
        bounds[block] = inner * self.scales[block] * UPWARDS
        return np.asarray(bounds)

    def tail(self) -> float:
        """The same for all columns beyond `columns`."""
        part, K = self.part, self.part.K
        n = self.columns + 1 - K
        linear = part.layout.frequencies()
        if n * part.omega <= linear[-1] * (1 + 1e-9):
            return math.inf
        least = self._beyond(n)
        growth = part.nu ** np.arange(K + 1) + part.nu ** -np.arange(K + 1.0)
        growth[0] = 1.0
        sums = part.layout.beyond(growth, part.slopes) / least[:, None]
        return float(part.layout.together(sums).max() * UPWARDS)

    def _beyond(self, n: int) -> Floats:
        """Below |lambda_q| of every harmonic from n on, which is above all resonances."""
        ratio = n * self.part.omega / self.part.layout.frequencies()
        return np.asarray((ratio**2 - 1) * (1 - MARGIN) - MARGIN)

    def weights(self, defect: Floats) -> Ints | None:
        """v with v |I - A DF| <= rho v for a rho below 1, at least 1; None if there are none."""
        count = self.free_count
        own, leaving = defect[:count, :count], defect[count:, :count].sum(axis=0)
        _, radius = perron(own.T)
        if not radius < MOST_RADIUS:
            return None
        rho = max(LEAST_RATE, (1 + 2 * radius) / 3)
        v = np.linalg.solve(rho * np.eye(count) - own.T, leaving + rho)
        if not (v.min() > 0 and v.max() < LARGEST_WEIGHT):
            return None
        scaled = np.ceil(np.ldexp(np.maximum(v, 1.0), WEIGHT_BITS))
        return np.asarray(scaled, dtype=np.int64)

    def own(self, defect: Floats) -> Floats:
        """The part whose weights are free."""
        return defect[: self.free_count, : self.free_count]

    def grown(self, block: Ints, defect: Floats | None) -> Ints:
        """With more places: those that the spectral radius depends on most."""
        outside = np.setdiff1d(np.arange(self.free_count), block)
        score = self.importance()
        if defect is not None:
            score = perron(self.own(defect))[0] * perron(self.own(defect).T)[0]
        more = max(SMALLEST_GROWTH, len(block) // 3)
        chosen = outside[np.argsort(-score[outside], kind="stable")][:more]
        return np.sort(np.append(block, chosen))

    def bounded(self, block: Ints) -> tuple[Contraction | None, Floats | None]:
        """The bounds with this block, and |I - A DF|.

        None where weights cannot make it a contraction, and where the block has no inverse.
        """
        try:
            inverse = self.inverse(block)
        except np.linalg.LinAlgError:
            return None, None
        if not np.abs(inverse).max() < LARGEST_ENTRY:
            return None, None
        defect = self.defect(block, inverse.astype(np.int64))
        chosen = self.weights(defect)
        if chosen is None:
            return None, defect
        return self._contraction(block, inverse.astype(np.int64), defect, chosen), defect

    def _contraction(
        self, block: Ints, inverse: Ints, defect: Floats, chosen: Ints
    ) -> Contraction:
        """The bounds with these weights."""
        v = np.ones(len(self.rows.n))
        v[: self.free_count] = np.ldexp(chosen.astype(float), -WEIGHT_BITS)
        of_columns = (v @ defect) / v[: self.count]
        norms = v[: self.count] / self.diagonal[: self.count]
        sizes = np.abs(np.ldexp(inverse.astype(float), -INVERSE_BITS))
        norms[block] = v[block] @ (sizes * self.scales[np.ix_(block, block)])
        norms *= UPWARDS
        beyond = UPWARDS / self._beyond(self.columns + 1)
        tail, first = self.tail(), int(self.inside.bordered)
        if self.part.border is not None:
            tail += norms[0] * self._farthest_of_equation()
        linear = max(float(of_columns.max()), tail) * UPWARDS
        sums = np.bincount(self.inside.n[first:], weights=norms[first:])
        of_beyond = float(self.part.layout.together(beyond))
        spread = max(float(sums.max()), of_beyond) * UPWARDS
        return Contraction(
            part=self.part,
            places=self.inside,
            free=self.free,
            block=block,
            inverse=inverse,
            weights=chosen,
            linear=linear,
            spread=spread,
            columns_of_inverse=norms,
            beyond=beyond,
            of_frequency=self._of_frequency(norms / v[: self.count], beyond, v[0]),
        )

    def _farthest_of_equation(self) -> float:
        """Above the derivatives of the equation by unknowns beyond `columns`, over nu^n."""
        assert self.part.border is not None
        line, nu, first = self.part.border, self.part.nu, self.columns + 1
        largest = (np.abs(line.rows) + line.row_errors).max(axis=1)[first:]
        powers = nu ** -np.arange(first, first + len(largest), dtype=float)
        rest = line.beyond * nu ** (-2.0 * first)
        return float(max((largest * powers).max(initial=0.0), rest) * UPWARDS)

    def _of_frequency(self, norms: Floats, beyond: Floats, weight: float) -> float:
        """A places -n^2 unit/Omega_q^2 h_q[n], from norms |A e| / |e| by place."""
        if self.part.border is None:
            return 0.0
        squares = self.part.layout.frequencies() ** 2
        n, q = self.inside.n[1:], self.inside.q[1:]
        inside = float((norms[1:] * n**2 / squares[q - 1]).max())
        outside = float((beyond * (self.columns + 1) ** 2 / squares).max())
        return float(max(inside, outside) * self.part.border.unit / weight * UPWARDS)


def perron(matrix: Floats) -> tuple[Floats, float]:
    """The eigenvector of a matrix that is not negative, and its largest eigenvalue, about."""
    x = np.ones(len(matrix))
    size = 0.0
    for _ in range(POWERS):
        x = matrix @ x
        size = float(np.linalg.norm(x))
        if not 0 < size < math.inf:
            break
        x /= size
    return x, size


def first_free(part: LinearPart) -> int:
    """The last harmonic with free weights to begin with, above all resonances."""
    top = float(part.layout.frequencies()[-1]) / part.omega
    return math.ceil(FIRST_FREE * top) + 2


def contraction(part: LinearPart) -> tuple[Contraction | None, float]:
    """A contraction with a small block, and the smallest norm or spectral radius that was met.

    The block grows by the places that matter most to the spectral radius of |I - A DF|; where the
    weights cannot end at the last free harmonic, more are freed.
    """
    free = first_free(part)
    attempt = Attempt(part, free)
    block = np.sort(attempt.order()[:FIRST_BLOCK])
    least, widened = math.inf, 0
    while True:
        found, defect = attempt.bounded(block)
        if found is not None:
            least = min(least, found.linear)
            if found.linear < MOST_LINEAR:
                return found, found.linear
        elif defect is not None:
            least = min(least, max(1.0, perron(attempt.own(defect))[1]))
        if found is not None and widened < WIDENINGS:
            widened, free = widened + 1, math.ceil(WIDENING * free)
            again = Attempt(part, free)
            block, attempt = moved(block, attempt, again), again
            continue
        larger = attempt.grown(block, defect)
        if len(larger) == len(block) or len(larger) > LARGEST_BLOCK:
            return None, least
        block = larger


def moved(block: Ints, old: Attempt, new: Attempt) -> Ints:
    """The same places among those of another attempt; they ascend, so nothing moves."""
    assert (old.inside.n[block] == new.inside.n[block]).all()
    return block
