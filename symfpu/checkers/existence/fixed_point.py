"""Cosines and cosine series in fixed point: integers times 2^-places, their errors bounded."""

from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers.rounding import up

GUARD_OF_COSINES = 48
POWER_PLACES = 40  # of nu^n
COSINE_UNITS = 2  # of the last place, more than a cosine is off


class Cosines:
    """cos(k pi / 2N) in units of 2^-places, each off by less than COSINE_UNITS."""

    def __init__(self, N: int, places: int) -> None:
        w = places + GUARD_OF_COSINES
        pi = pi_times(w)
        self.N, self.one = N, 1 << places
        self.quarter = [
            cosine_of(pi * k // (2 * N), w) >> GUARD_OF_COSINES for k in range(N + 1)
        ]

    def of(self, k: int) -> int:
        """cos(k pi / 2N) for any k, by the symmetries of the cosine."""
        k %= 4 * self.N
        k = min(k, 4 * self.N - k)
        return self.quarter[k] if k <= self.N else -self.quarter[2 * self.N - k]

    def bond(self, q: int, j: int) -> int:
        """cos(q theta_j), theta_j = (j + 1/2) pi / N."""
        return self.of(q * (2 * j + 1))


def pi_times(places: int) -> int:
    """pi 2^places within a unit: Machin's 16 arctan 1/5 - 4 arctan 1/239."""
    w = places + 32
    return (16 * inverse_tangent(5, w) - 4 * inverse_tangent(239, w)) >> 32


def inverse_tangent(n: int, places: int) -> int:
    """arctan(1/n) 2^places, off by less than two units a term."""
    power, k, total = (1 << places) // n, 1, 0
    while power:
        total += power // k if k % 4 == 1 else -(power // k)
        power //= n * n
        k += 2
    return total


def cosine_of(angle: int, places: int) -> int:
    """The cosine of an angle up to pi/2 by its alternating series.

    A term is off by a few units, and by less from the third on as its factor is below 1/2: less
    than 2^40 units together, where the guard has 2^48.
    """
    one = 1 << places
    square = angle * angle >> places
    total, term, i = one, one, 0
    while term:
        i += 1
        term = (term * square >> places) // ((2 * i - 1) * (2 * i))
        total += -term if i % 2 else term
    return total


class Series(NamedTuple):
    """Cosine coefficients a_0, a_1, .. and a bound of their error in the norm; units 2^-P."""

    values: list[int]
    error: int


class Norm:
    """sum |a_n| nu^n, rounded up.

    powers, below : nu^n rounded up and down to POWER_PLACES.
    """

    def __init__(self, nu: Fraction, harmonics: int) -> None:
        self.powers, self.below = [], []
        top, bottom = nu.numerator, nu.denominator
        value = least = 1 << POWER_PLACES
        for _ in range(harmonics + 1):
            self.powers.append(value)
            self.below.append(least)
            value, least = value * top // bottom + 1, least * top // bottom
        sums = 0
        self.sums = [0]
        for power in self.powers:
            sums += power
            self.sums.append(sums)

    def of(self, values: Iterable[int], first: int = 0) -> int:
        """In units of the values, whose harmonics are those from the first on."""
        weighted = zip(values, self.powers[first:], strict=False)
        return (sum(abs(a) * power for a, power in weighted) >> POWER_PLACES) + 1

    def units(self, length: int) -> int:
        """The norm of so many coefficients of one unit."""
        return (self.sums[length] >> POWER_PLACES) + 1


class FixedPoint:
    """Sums and products of series with P places."""

    def __init__(self, places: int, norm: Norm) -> None:
        self.places, self.norm = places, norm

    def product(self, a: Series, b: Series) -> Series:
        """2 cos i cos j = cos(i+j) + cos(i-j); rounded down once.

        Its last coefficients, each below a unit, are left out and counted as errors.
        """
        doubled = [0] * (len(a.values) + len(b.values) - 1)
        for i, x in enumerate(a.values):
            if x:
                for j, y in enumerate(b.values):
                    xy = x * y
                    doubled[i + j] += xy
                    doubled[abs(i - j)] += xy
        shift = self.places + 1
        kept = max((n for n, x in enumerate(doubled) if abs(x) >> shift), default=0) + 1
        values = [x >> shift for x in doubled[:kept]]
        left_out = (self.norm.of(doubled[kept:], kept) >> shift) + 1
        sizes = self.norm.of(a.values), self.norm.of(b.values)
        crossed = sizes[0] * b.error + sizes[1] * a.error + a.error * b.error
        error = (crossed >> self.places) + 1 + self.norm.units(kept) + left_out
        return Series(values, error)

    def combination(self, powers: dict[int, Series], terms: dict[int, Fraction]) -> Series:
        """sum terms[k] powers[k]."""
        values = [0] * max(len(powers[k].values) for k in terms)
        error = 0
        for k, c in terms.items():
            for n, x in enumerate(powers[k].values):
                values[n] += x * c.numerator // c.denominator
            error += up(powers[k].error * abs(c)) + self.norm.units(len(values))
        return Series(values, error)


def rounded_up(x: Fraction, places: int) -> Fraction:
    """The least multiple of 2^-places not below."""
    return Fraction(up(x * 2**places), 2**places)
