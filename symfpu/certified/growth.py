"""How a small distance may grow: d' <= g(d), g a quotient of polynomials, solved from above."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

RATIO = Fraction(31, 32)  # of neighbouring nodes of the integral of 1/g
NODE_BITS = 64
SEARCH_STEPS = 60
POINTS = 400  # of a search in doubles
WIDER, TRIES = Fraction(65, 64), 12  # steps from what doubles found


@dataclass(frozen=True)
class Growth:
    """d' <= g(d) = (sum terms[k] d^k) / (room - turning d), d >= 0.

    terms : residual, what the frame leaves, and the curvature of the force with that of the
    frame; not negative. room : 1 less the norm of 1 - L M. All dimensionless.
    """

    terms: tuple[Fraction, ...]
    room: Fraction
    turning: Fraction

    def rate(self, d: Fraction) -> Fraction:
        """g(d). Raises ValueError where the frame is no frame that far from the torus."""
        below = self.room - self.turning * d
        if below <= 0:
            raise ValueError("the frame may be singular so far from the torus")
        total = Fraction(0)
        for term in reversed(self.terms):
            total = total * d + term
        return total / below

    def time(self, d: Fraction) -> Fraction:
        """Below the time that a distance takes to grow from 0 to d: the integral of 1/g.

        g increases, so that 1/g is least at the right end of every interval between nodes.
        """
        places = nodes(d, self.quiet)
        total = Fraction(0)
        for low, high in zip([*places[1:], Fraction(0)], places, strict=True):
            total += rounded_down((high - low) / self.rate(high))
        return total

    @property
    def quiet(self) -> Fraction:
        """A distance up to which g is nearly what it is at 0."""
        residual = float(self.terms[0])
        linear = residual / (float(self.terms[1]) + residual * float(self.turning) or 1.0)
        curved = math.sqrt(residual / (float(sum(self.terms[2:])) or 1.0))
        return Fraction(min(linear, curved, 1.0) / 64)

    def longest(self) -> Fraction:
        """A distance at which more time hardly costs less than all of it."""
        room = self.room / (2 * self.turning) if self.turning else Fraction(1)
        residual, curvature = float(self.terms[0]), float(sum(self.terms[2:])) or 1.0
        return min(room, Fraction(64 * (residual / curvature) ** 0.5), Fraction(1, 16))

    def distance(self, time: Fraction) -> Fraction | None:
        """A distance not reached before a time, nearly the least; None where none is known."""
        most = self.longest()
        d = Fraction(self._guess(float(time), float(most)))
        for _ in range(TRIES):
            if d >= most:
                break
            if self.time(d) >= time:
                return d
            d = rounded_down(d * WIDER)
        return most if self.time(most) >= time else None

    def _guess(self, time: float, most: float) -> float:
        """The same in doubles, by bisection."""
        least = float(self.terms[0]) * time / 2
        for _ in range(SEARCH_STEPS):
            middle = math.sqrt(least * most)
            least, most = (
                (least, middle) if self._nearly(middle) >= time else (middle, most)
            )
        return most

    def _nearly(self, d: float) -> float:
        """The integral of 1/g in doubles, by trapezes in log d."""
        x = np.concatenate([[0.0], np.geomspace(min(float(self.quiet), d / 2), d, POINTS)])
        powers = np.vander(x, len(self.terms), increasing=True)
        above = powers @ np.array([float(term) for term in self.terms])
        slowness = (float(self.room) - float(self.turning) * x) / above
        return float(np.trapezoid(slowness, x))


def nodes(d: Fraction, quiet: Fraction) -> list[Fraction]:
    """From d down, each a little below the one before, to about `quiet`."""
    found = [d]
    while found[-1] > quiet:
        found.append(rounded_down(found[-1] * RATIO))
    return found


def rounded_down(x: Fraction) -> Fraction:
    """With a numerator of NODE_BITS bits over a power of 2."""
    if not x:
        return x
    shift = NODE_BITS - (x.numerator.bit_length() - x.denominator.bit_length())
    if shift >= 0:
        return Fraction((x.numerator << shift) // x.denominator, 1 << shift)
    return Fraction((x.numerator // (x.denominator << -shift)) << -shift)


def rounded_up(x: Fraction) -> Fraction:
    """The same from above."""
    return rounded_down(x) + ulp(x) if x else x


def ulp(x: Fraction) -> Fraction:
    """Above the step of `rounded_down`."""
    places = x.numerator.bit_length() - x.denominator.bit_length() - NODE_BITS + 1
    return Fraction(2) ** places
