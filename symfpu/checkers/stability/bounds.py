"""The three bounds of the theorem on one exponent: Y, Z and Z2, computed anew."""

from collections.abc import Iterator
from fractions import Fraction
from operator import mul

from symfpu.checkers.reading import need
from symfpu.checkers.rounding import scientific
from symfpu.checkers.stability.divisors import Divisors
from symfpu.checkers.stability.exponent import WEIGHT_BITS, Exponent, Gaussian
from symfpu.checkers.stability.orbit import Place
from symfpu.checkers.stability.slopes import COARSE, ONE, PLACES, Slopes

INVERSE_BITS = 32  # of the entries of the approximate inverse


class Bounds:
    """Y, Z and Z2 of one exponent."""

    def __init__(self, slopes: Slopes, exponent: Exponent, free: int) -> None:
        self.slopes, self.exponent, self.free = slopes, exponent, free
        self.sector, self.N = exponent.sector, slopes.orbit.N
        self.last = free + slopes.K
        self.divisors = Divisors(slopes.orbit, exponent, free)
        self.members = {place: i for i, place in enumerate(exponent.block)}
        self.invert()
        self.norms = self.norms_of_columns()
        self.spread = self.largest_sum()

    # the approximate inverse

    def derivative(self, place: Place, column: Place) -> int:
        """The coupling in a row by a column that is not kappa."""
        (n, q), (m, p) = place, column
        k = abs(n - m)
        if k > self.slopes.K:
            return 0
        row = self.slopes.sums[k]
        return row[abs(q - p)] + row[q + p]

    def of_sigma(self, place: Place) -> tuple[Gaussian, int]:
        """-2 (sigma + n omega) v / Omega_q^2, and a bound of its error."""
        n, q = place
        v = self.coefficient(place)
        x, y = self.divisors.angle(n)
        least, most = self.divisors.least[q], self.divisors.most[q]
        drop = PLACES + self.exponent.bits
        re = -(2 * (x * v[0] - y * v[1]) * least >> drop)
        im = -(2 * (x * v[1] + y * v[0]) * least >> drop)
        size = abs(v[0]) + abs(v[1])
        error = 2 * size * (2 * most + self.divisors.size_of_angle(n) * (most - least))
        return (re, im), (error >> drop) + 2

    def coefficient(self, place: Place) -> Gaussian:
        """v 2^bits."""
        n, q = place
        row = self.exponent.rows.get(n)
        if not row:
            return 0, 0
        return row[(q - self.sector.allowed(n)[0]) // 2]

    def column_in_block(self, column: Place) -> list[Gaussian]:
        """Its entries of DF in the rows of the block."""
        if column == self.exponent.kappa:
            return [self.of_sigma(place)[0] for place in self.exponent.block]
        result = [(self.derivative(place, column), 0) for place in self.exponent.block]
        own = self.members.get(column)
        if own is not None:
            divisor = self.divisors.of(column)
            result[own] = result[own][0] + divisor.re, divisor.im
        return result

    def invert(self) -> None:
        """A on the block: the inverse of DF there, rounded; any other would do."""
        columns = [self.column_in_block(place) for place in self.exponent.block]
        size = len(columns)
        matrix = [[columns[l][i][0] for l in range(size)] for i in range(size)]
        if not self.exponent.reals:
            lower = [[columns[l][i][1] for l in range(size)] for i in range(size)]
            upper_rows = [a + [-x for x in b] for a, b in zip(matrix, lower, strict=True)]
            lower_rows = [b + a for a, b in zip(matrix, lower, strict=True)]
            matrix = upper_rows + lower_rows
        inverse = inverse_of(matrix)
        self.real = [row[:size] for row in inverse[:size]]
        self.imaginary = [row[:size] for row in inverse[size:]]

    def applied(self, column: list[Gaussian]) -> list[Gaussian]:
        """A times a column of the block, PLACES + INVERSE_BITS."""
        re, im = [x for x, _ in column], [y for _, y in column]
        if self.exponent.reals:
            return [(sum(map(mul, row, re)), 0) for row in self.real]
        result = []
        for a, b in zip(self.real, self.imaginary, strict=True):
            real = sum(map(mul, a, re)) - sum(map(mul, b, im))
            result.append((real, sum(map(mul, a, im)) + sum(map(mul, b, re))))
        return result

    # norms of columns of A: units 2^-(PLACES + WEIGHT_BITS)

    def norms_of_columns(self) -> dict[int, list[int]]:
        """|A e| of the places up to M + 2 K by harmonic, rounded up."""
        of_block = self.norms_in_block()
        found = {}
        for n in range(-self.last - self.slopes.K, self.last + self.slopes.K + 1):
            row = []
            for q in self.sector.allowed(n):
                place = (n, q)
                if place in of_block:
                    row.append(of_block[place])
                else:
                    row.append(
                        self.exponent.weight(place) * self.divisors.of(place).inverse
                    )
            found[n] = row
        return found

    def norms_in_block(self) -> dict[Place, int]:
        """Those of the block."""
        block = self.exponent.block
        result = {}
        for l, place in enumerate(block):
            total = 0
            for i, row in enumerate(block):
                size = abs(self.real[i][l])
                if not self.exponent.reals:
                    size += abs(self.imaginary[i][l])
                total += self.exponent.weights[row] * size
            result[place] = total << (PLACES - INVERSE_BITS)
        return result

    def norm(self, place: Place) -> int:
        """Of any place."""
        n, q = place
        if n in self.norms:
            return self.norms[n][(q - self.sector.allowed(n)[0]) // 2]
        return self.divisors.inverse_beyond(self.last + 1, q) << WEIGHT_BITS

    def largest_sum(self) -> Fraction:
        """S, above sum_q a_q[n] of every n."""
        beyond = sum(
            self.divisors.inverse_beyond(self.last + 1, q) for q in range(1, self.N)
        )
        largest = max([beyond << WEIGHT_BITS, *map(sum, self.norms.values())])
        return Fraction(largest, ONE << WEIGHT_BITS)

    # the bounds

    def of_bonds(self, size: Fraction) -> Fraction:
        """Above |A (G' x)| / sum |x| where slopes that make G' have norms that sum to `size`."""
        return self.spread * (Fraction(2, self.N) * size + self.slopes.entry)

    def residual(self) -> Fraction:
        """Y."""
        total = sum((self.of_harmonic(n) for n in self.reached()), 0)
        unit = 1 << (2 * PLACES + WEIGHT_BITS + self.exponent.bits)
        sizes = (abs(x) + abs(y) for row in self.exponent.rows.values() for x, y in row)
        size = Fraction(sum(sizes), 1 << self.exponent.bits)
        known = Fraction(total, unit) + self.of_bonds(self.slopes.lost) * size
        return known + self.moved_residual()

    def moved_residual(self) -> Fraction:
        """|A (L* v - L v)| where L* has the frequency of the true orbit."""
        total = Fraction(0)
        for (n, q), size in self.sizes_of_coefficients():
            total += self.norm((n, q)) * self.divisors.moved((n, q)) * size
        return total / (1 << (PLACES + WEIGHT_BITS))

    def sizes_of_coefficients(self) -> Iterator[tuple[Place, Fraction]]:
        """|Re v| + |Im v| of the places where v is not zero."""
        for n, row in self.exponent.rows.items():
            for q, (x, y) in zip(self.sector.allowed(n), row, strict=True):
                if x or y:
                    yield (n, q), Fraction(abs(x) + abs(y), 1 << self.exponent.bits)

    def reached(self) -> range:
        """Harmonics of L v."""
        rows, last = self.exponent.rows, self.slopes.all
        return range(min(rows) - last, max(rows) + last + 1)

    def of_harmonic(self, n: int) -> int:
        """sum_q a |L v| of a harmonic, units 2^-(2 PLACES + WEIGHT_BITS + bits)."""
        near = [
            (m, row)
            for m, row in self.exponent.rows.items()
            if abs(n - m) <= self.slopes.all
        ]
        total = 0
        for q in self.sector.allowed(n):
            value = self.row_of_residual((n, q), near)
            total += self.norm((n, q)) * value
        return total

    def row_of_residual(self, place: Place, near: list[tuple[int, list[Gaussian]]]) -> int:
        """|(L v)_q[n]| with the error of its divisor."""
        n, q = place
        re = im = 0
        for m, row in near:
            odd = self.sector.allowed(m)[0] % 2
            coupling = self.slopes.near[abs(n - m)][q][odd]
            re += sum(map(mul, coupling, [x for x, _ in row]))
            if not self.exponent.reals:
                im += sum(map(mul, coupling, [y for _, y in row]))
        (x, y), divisor = self.coefficient(place), self.divisors.of(place)
        re += divisor.re * x - divisor.im * y
        im += divisor.re * y + divisor.im * x
        return abs(re) + abs(im) + 2 * divisor.off * (abs(x) + abs(y))

    def linear(self) -> Fraction:
        """Z, above |I - A DF|."""
        columns = max(self.of_columns(), self.of_sigma_column(), self.of_tail())
        return columns + self.of_bonds(self.slopes.cut) + self.moved_columns()

    def moved_columns(self) -> Fraction:
        """|A (DF* - DF)| where DF* has the frequency of the true orbit, column by column."""
        if not self.slopes.orbit.omega_off:
            return Fraction(0)
        beyond = self.last + 1
        modes = range(1, self.N)
        worst = max(self.divisors.moved_beyond(beyond, q) for q in modes)
        for n in range(-self.last, self.last + 1):
            for q, norm in zip(self.sector.allowed(n), self.norms[n], strict=True):
                if (n, q) != self.exponent.kappa:
                    moved = norm * self.divisors.moved((n, q))
                    worst = max(worst, moved / (ONE * self.exponent.weight((n, q))))
        return max(worst, self.moved_sigma_column())

    def moved_sigma_column(self) -> Fraction:
        """The column of sigma: 2 |move of z| |v| / Omega^2."""
        total = Fraction(0)
        for (n, q), size in self.sizes_of_coefficients():
            moved = 2 * self.divisors.moved_angle(n) * self.divisors.most[q] * size
            total += self.norm((n, q)) * moved
        return total / (ONE * ONE * self.exponent.weights[self.exponent.kappa])

    def of_columns(self) -> Fraction:
        """The largest column of a place but kappa, up to harmonic M + K."""
        outside = self.outside_norms()
        worst = Fraction(0)
        for m in range(-self.last, self.last + 1):
            for p in self.sector.allowed(m):
                if (m, p) != self.exponent.kappa:
                    worst = max(worst, self.of_column((m, p), outside))
        return worst

    def outside_norms(self) -> dict[int, list[int]]:
        """The norms of columns of A, none for those of the block."""
        found = {n: list(row) for n, row in self.norms.items()}
        for n, q in self.exponent.block:
            found[n][(q - self.sector.allowed(n)[0]) // 2] = 0
        return found

    def of_column(self, column: Place, outside: dict[int, list[int]]) -> Fraction:
        """|(I - A DF) e| over the weight of e."""
        m, p = column
        total = 0
        for n in range(m - self.slopes.K, m + self.slopes.K + 1):
            row = outside[n]
            if row:
                odd = self.sector.allowed(n)[0] % 2
                total += sum(map(mul, row, self.slopes.sizes[abs(n - m)][p][odd]))
        found = Fraction(total, 1 << (PLACES + WEIGHT_BITS + COARSE))
        found += self.in_block(column)
        if column in self.members:
            off = 2 * self.divisors.of(column).off * self.norm(column)
            found += Fraction(off, 1 << (2 * PLACES + WEIGHT_BITS))
        return found * (1 << WEIGHT_BITS) / self.exponent.weight(column)

    def in_block(self, column: Place) -> Fraction:
        """sum over the rows of the block of w |(I - A DF) e|."""
        entries = self.column_in_block(column)
        if not any(x or y for x, y in entries):
            return Fraction(0)
        image, own = self.applied(entries), self.members.get(column)
        total = 0
        for i, (x, y) in enumerate(image):
            identity = 1 << (PLACES + INVERSE_BITS) if i == own else 0
            weight = self.exponent.weights[self.exponent.block[i]]
            total += weight * (abs(identity - x) + abs(y))
        return Fraction(total, 1 << (PLACES + INVERSE_BITS + WEIGHT_BITS))

    def of_sigma_column(self) -> Fraction:
        """The column of sigma in the place of kappa."""
        total = 0
        for n, row in self.exponent.rows.items():
            for q, v in zip(self.sector.allowed(n), row, strict=True):
                if v != (0, 0):
                    (x, y), error = self.of_sigma((n, q))
                    inside = (n, q) in self.members
                    size = 0 if inside else abs(x) + abs(y)
                    total += self.norm((n, q)) * (size + 2 * error)
        found = Fraction(total, 1 << (2 * PLACES + WEIGHT_BITS))
        found += self.in_block(self.exponent.kappa)
        return found * (1 << WEIGHT_BITS) / self.exponent.weights[self.exponent.kappa]

    def of_tail(self) -> Fraction:
        """Every column beyond M + K: it meets rows beyond M alone."""
        modes = range(1, self.N)
        inverse = [0] + [self.divisors.inverse_beyond(self.free + 1, q) for q in modes]
        worst = 0
        for p in modes:
            total = 0
            for k, table in enumerate(self.slopes.sizes):
                even, odd = table[p]
                sizes = sum(map(mul, inverse[2::2], even)) + sum(
                    map(mul, inverse[1::2], odd)
                )
                total += sizes if k == 0 else 2 * sizes
            worst = max(worst, total)
        return Fraction(worst, 1 << (PLACES + COARSE))

    def curvature(self) -> tuple[Fraction, Fraction, Fraction]:
        """e1, e2, e3 of the theorem."""
        e1, e2 = self.curvature_beyond()
        unit = 1 << (2 * PLACES)
        for n in range(-self.last, self.last + 1):
            size = Fraction(self.divisors.size_of_angle(n), ONE)
            size += self.divisors.moved_angle(n)
            for q, norm in zip(self.sector.allowed(n), self.norms[n], strict=True):
                if (n, q) != self.exponent.kappa:
                    weight = self.exponent.weight((n, q))
                    ratio = Fraction(2 * norm * self.divisors.most[q], weight * unit)
                    e1, e2 = max(e1, ratio * size), max(e2, ratio)
        e3 = 0
        for n, row in self.exponent.rows.items():
            for q, (x, y) in zip(self.sector.allowed(n), row, strict=True):
                if x or y:
                    e3 += 2 * self.norm((n, q)) * self.divisors.most[q] * (abs(x) + abs(y))
        third = Fraction(e3, unit << (WEIGHT_BITS + self.exponent.bits))
        return e1, e2, third

    def curvature_beyond(self) -> tuple[Fraction, Fraction]:
        """e1 and e2 of places beyond M + K: both fall with the harmonic.

        |z| / |z^2 - Omega^2| falls with |z|, on both sides, and so does what z may move.
        """
        n = self.last + 1
        divisors = self.divisors
        size = max(divisors.size_of_angle(n), divisors.size_of_angle(-n))
        modes = range(1, self.N)
        worst = max(2 * divisors.inverse_beyond(n, q) * divisors.most[q] for q in modes)
        second = Fraction(worst, ONE * ONE)
        moved = max(divisors.moved_angle(n), divisors.moved_angle(-n))
        return second * (Fraction(size, ONE) + moved), second

    def check_contraction(self) -> tuple[Fraction, Fraction]:
        """The map takes the ball of the radius into itself and contracts it; Y and Z."""
        rho, weight = self.exponent.radius, self.exponent.weights[self.exponent.kappa]
        w = Fraction(weight, 1 << WEIGHT_BITS)
        Y, Z, (e1, e2, e3) = self.residual(), self.linear(), self.curvature()
        rate = Z + (e1 / w + e2 * rho / w**2 + e3 / w**2) * rho
        need(rate < 1, f"of an exponent Z + Z2 r = {scientific(rate)} is not below 1")
        reached = Y + rate * rho
        text = f"Y + (Z + Z2 r) r = {scientific(reached)} exceeds r = {scientific(rho)}"
        need(reached <= rho, f"of an exponent {text}")
        return Y, Z


def inverse_of(matrix: list[list[int]]) -> list[list[int]]:
    """About the inverse of a matrix with PLACES, with INVERSE_BITS: Gauss and Jordan."""
    size = len(matrix)
    rows = [
        row + [ONE if i == j else 0 for j in range(size)] for i, row in enumerate(matrix)
    ]
    for i in range(size):
        best = max(range(i, size), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        pivot = rows[i][i]
        need(pivot, "the block has no inverse")
        rows[i] = [(x << PLACES) // pivot for x in rows[i]]
        for k in range(size):
            factor = rows[k][i]
            if k != i and factor:
                rows[k] = [
                    x - (factor * y >> PLACES)
                    for x, y in zip(rows[k], rows[i], strict=True)
                ]
    return [[x >> (PLACES - INVERSE_BITS) for x in row[size:]] for row in rows]
