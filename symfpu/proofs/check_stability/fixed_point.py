"""Cosines in fixed point, and numbers rounded to one side: integers times 2^-PLACES."""

from fractions import Fraction

PLACES = 64
COSINE_UNITS = 2  # of the last place, more than a cosine is off
ONE = 1 << PLACES


def up(x: Fraction | int) -> int:
    """The least integer not below."""
    return -((-x.numerator) // x.denominator)


def floor(x: Fraction) -> int:
    """In units 2^-PLACES, rounded down."""
    return x.numerator * ONE // x.denominator


class Cosines:
    """cos(k pi / 2N) in units of 2^-places, each off by less than COSINE_UNITS."""

    def __init__(self, N: int, places: int) -> None:
        guard = 48
        pi = 4 * (
            4 * inverse_tangent(5, places + guard) - inverse_tangent(239, places + guard)
        )
        self.N = N
        angles = [pi * k // (2 * N) for k in range(N + 1)]
        self.quarter = [cosine_of(angle, places + guard) >> guard for angle in angles]

    def of(self, k: int) -> int:
        """For any k, by the symmetries of the cosine."""
        k %= 4 * self.N
        k = min(k, 4 * self.N - k)
        return self.quarter[k] if k <= self.N else -self.quarter[2 * self.N - k]

    def bond(self, q: int, j: int) -> int:
        """cos(q theta_j), theta_j = (j + 1/2) pi / N."""
        return self.of(q * (2 * j + 1))


def inverse_tangent(n: int, places: int) -> int:
    """arctan(1/n) 2^places, off by less than two units a term."""
    power, k, total = (1 << places) // n, 1, 0
    while power:
        total += power // k if k % 4 == 1 else -(power // k)
        power //= n * n
        k += 2
    return total


def cosine_of(angle: int, places: int) -> int:
    """The cosine of an angle up to pi/2 by its alternating series, off by less than 2^40 units."""
    one = 1 << places
    square = angle * angle >> places
    total, term, i = one, one, 0
    while term:
        i += 1
        term = (term * square >> places) // ((2 * i - 1) * (2 * i))
        total += -term if i % 2 else term
    return total
