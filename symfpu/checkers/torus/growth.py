"""How fast the weighted distance from a torus may grow, and the time that takes."""

from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers.reading import need
from symfpu.checkers.torus.series import Row

RATIO = Fraction(63, 64)  # of neighbouring nodes of an integral
NODE_BITS = 64
MOST_NODES = 20_000


class Growth(NamedTuple):
    """d' <= (sum terms[k] d^k) / (room - turning d)."""

    terms: Row
    room: Fraction
    turning: Fraction

    def rate(self, d: Fraction) -> Fraction:
        """Rounded up; refused where the frame may be singular."""
        below = self.room - self.turning * d
        need(below > 0, "the frame may be singular within the stated distance")
        total = Fraction(0)
        for term in reversed(self.terms):
            total = total * d + term
        return -rounded_down(-total / below)


def rounded_down(x: Fraction) -> Fraction:
    """With NODE_BITS bits or so."""
    places = NODE_BITS + x.denominator.bit_length() - abs(x.numerator).bit_length()
    places = max(places, 0)
    return Fraction((x.numerator << places) // x.denominator, 1 << places)


def time_to_grow(growth: Growth, d: Fraction) -> Fraction:
    """Below the integral of 1/rate from 0 to d: rate increases, each interval has its right end."""
    total, high = Fraction(0), d
    rate = growth.rate(high)
    for _ in range(MOST_NODES):
        low = rounded_down(high * RATIO)
        below = growth.rate(low)
        total += rounded_down((high - low) / rate)
        high, last, rate = low, rate, below
        if last - rate < last / 10**4:
            break
    return total + rounded_down(high / rate)
