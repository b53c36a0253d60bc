"""Slopes of the bonds along the orbit, and how they couple modes."""

from fractions import Fraction
from operator import mul
from typing import NamedTuple

from symfpu.checkers.existence.fixed_point import COSINE_UNITS, Cosines
from symfpu.checkers.rounding import up
from symfpu.checkers.stability.orbit import Orbit

PLACES = 64
ONE = 1 << PLACES
COARSE = 48  # places of the moduli of couplings
FINE = 96  # of the slopes while they are computed
# units: harmonics of slopes below it are left out of Y and counted as lost
SMALLEST_SLOPE = 24


class Series(NamedTuple):
    """Cosine coefficients a_0, a_1, .. in units 2^-FINE and a bound of the sum of their errors."""

    values: list[int]
    error: int

    @property
    def size(self) -> int:
        """Above sum |a_n| of the true series."""
        return sum(map(abs, self.values)) + self.error


def stretch(orbit: Orbit, cosines: Cosines, j: int) -> Series:
    """r_j = sum_q c_q cos(q theta_j): the c are exact, the cosines off by COSINE_UNITS."""
    row_of_cosines = [cosines.bond(q, j) for q in range(orbit.N)]
    values, error = [], 0
    for row in orbit.rows:
        values.append(sum(map(mul, row, row_of_cosines)) >> orbit.bits)
        error += (COSINE_UNITS * sum(map(abs, row)) >> orbit.bits) + 2
    return Series(values, error)


def product(a: Series, b: Series) -> Series:
    """2 cos i cos j = cos(i+j) + cos(i-j); rounded down once."""
    doubled = [0] * (len(a.values) + len(b.values) - 1)
    for i, x in enumerate(a.values):
        for j, y in enumerate(b.values):
            doubled[i + j] += x * y
            doubled[abs(i - j)] += x * y
    values = [x >> (FINE + 1) for x in doubled]
    crossed = a.size * b.error + b.size * a.error
    return Series(values, (crossed >> FINE) + 1 + len(values))


def slope(orbit: Orbit, r: Series) -> Series:
    """phi'(r) = sum k c_k r^(k-1), up to the degree that is used; the rest is an error."""
    power, total, error = Series([1 << FINE], 0), [0], 0
    couplings = orbit.force.couplings
    for k in range(2, max(couplings) + 1):
        power = product(power, r)
        c = k * couplings.get(k, Fraction(0))
        total += [0] * (len(power.values) - len(total))
        for n, x in enumerate(power.values):
            total[n] += x * c.numerator // c.denominator
        error += up(power.error * abs(c)) + len(power.values)
    left_out = orbit.force.left_out(size_of(r), 1)
    return Series(total, error + up(left_out * (1 << FINE)))


def size_of(r: Series) -> Fraction:
    """Above sum |a_n|, in few places."""
    return Fraction(up(Fraction(r.size * ONE, 1 << FINE)), ONE)


def moved_slope(orbit: Orbit, r: Series) -> Fraction:
    """Above |phi'(r*) - phi'(r)| for |r* - r| up to the radius of the orbit."""
    size = Fraction(up((size_of(r) + orbit.radius) * ONE), ONE)
    return orbit.force.curvature_bound(size) * orbit.radius


class Slopes:
    """Couplings G_qp[k] of modes by harmonics of the slopes of all bonds.

    K : harmonics that I - A DF sees; those up to `all` enter Y. lost : above the sum over bonds of
    the moduli of all Fourier coefficients that differ from those of the true orbit; cut : the same
    with harmonics beyond K left out. entry : above the error of a coupling, summed over harmonics.
    """

    def __init__(self, orbit: Orbit, K: int) -> None:
        self.orbit, N = orbit, orbit.N
        cosines = Cosines(N, FINE)
        stretches = [stretch(orbit, cosines, j) for j in range(N)]
        slopes = [slope(orbit, r) for r in stretches]
        moved = sum((moved_slope(orbit, r) for r in stretches), Fraction(0))
        errors = sum(s.error + len(s.values) for s in slopes)
        self.halves = self.fourier(slopes)
        sizes = [sum(map(abs, column)) for column in self.halves]
        small = [k for k, size in enumerate(sizes) if size > N * SMALLEST_SLOPE]
        self.K, self.all = K, max([K, *small])
        left = 2 * sum(sizes[self.all + 1 :])
        # cutting to PLACES moves every coefficient by less than a unit
        cut_places = 2 * N * len(sizes)
        self.lost = moved + Fraction(errors, 1 << FINE) + Fraction(left + cut_places, ONE)
        self.cut = self.lost + Fraction(2 * sum(sizes[K + 1 :]), ONE)
        self.couple(sizes)
        self.near = self.tables(self.all)
        self.sizes = [self.moduli(table) for table in self.near[: K + 1]]

    @staticmethod
    def fourier(slopes: list[Series]) -> list[list[int]]:
        """g_j[k] by harmonic, a column of bonds each, cut to PLACES."""
        drop = FINE - PLACES
        columns = zip(*[s.values for s in slopes], strict=True)
        return [[x >> (drop + (k > 0)) for x in column] for k, column in enumerate(columns)]

    def couple(self, sizes: list[int]) -> None:
        """G_qp[k] = sums[k][|q - p|] + sums[k][q + p], off by the units that make up `entry`."""
        N = self.orbit.N
        cosines = Cosines(N, PLACES)
        tables = [[cosines.bond(p, j) for j in range(N)] for p in range(2 * N - 1)]
        self.sums: list[list[int]] = []
        errors = 0
        for k in range(self.all + 1):
            column = self.halves[k] if k < len(self.halves) else [0] * N
            totals = [sum(map(mul, table, column)) for table in tables]
            self.sums.append([(total >> PLACES) // N for total in totals])
            size = sizes[k] if k < len(sizes) else 0
            error = 2 * ((COSINE_UNITS * size >> PLACES) + 3)
            errors += error if k == 0 else 2 * error
        self.entry = Fraction(errors, ONE)

    def tables(self, last: int) -> list[list[tuple[list[int], list[int]]]]:
        """By k and q the couplings with the even modes and with the odd ones."""
        N = self.orbit.N
        result = []
        for k in range(last + 1):
            row = self.sums[k]
            of_modes = []
            for q in range(N):
                even, odd = (
                    [row[abs(q - p)] + row[q + p] for p in range(first, N, 2)]
                    for first in (2, 1)
                )
                of_modes.append((even, odd))
            result.append(of_modes)
        return result

    @staticmethod
    def moduli(
        table: list[tuple[list[int], list[int]]],
    ) -> list[tuple[list[int], list[int]]]:
        """Their moduli with COARSE places, rounded up."""
        drop = PLACES - COARSE
        return [
            (
                [(abs(x) >> drop) + 1 for x in even],
                [(abs(x) >> drop) + 1 for x in odd],
            )
            for even, odd in table
        ]
