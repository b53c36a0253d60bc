"""The divisors of one exponent: lambda_q[n] = 1 - (sigma + n omega)^2 / Omega_q^2."""

from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers.existence.fixed_point import COSINE_UNITS, Cosines
from symfpu.checkers.reading import need
from symfpu.checkers.stability.exponent import Exponent, Gaussian
from symfpu.checkers.stability.orbit import Orbit, Place
from symfpu.checkers.stability.slopes import ONE, PLACES


def in_units(x: Fraction) -> int:
    """In units 2^-PLACES, rounded down."""
    return x.numerator * ONE // x.denominator


class Divisor(NamedTuple):
    """lambda of a place: real and imaginary part, each off by at most `off`."""

    re: int
    im: int
    off: int

    @property
    def inverse(self) -> int:
        """Above |Re| + |Im| of 1/lambda, PLACES; refused where lambda may be zero."""
        re, im = max(0, abs(self.re) - self.off), max(0, abs(self.im) - self.off)
        need(re or im, "a divisor outside the block may be zero")
        size = abs(self.re) + abs(self.im) + 2 * self.off
        return (size << (2 * PLACES)) // (re * re + im * im) + 1


class Divisors:
    """All of them; beyond `free` harmonics they grow."""

    def __init__(self, orbit: Orbit, exponent: Exponent, free: int) -> None:
        self.exponent, self.free = exponent, free
        self.N, self.omega, self.omega_off = orbit.N, orbit.omega, orbit.omega_off
        self.read_frequencies()
        self.check_beyond()

    def read_frequencies(self) -> None:
        """1/Omega_q^2 between two integers."""
        cosines = Cosines(self.N, PLACES)
        off = 2 * COSINE_UNITS
        self.least, self.most = [0], [0]
        for q in range(1, self.N):
            squared = 2 * ONE - 2 * cosines.of(2 * q)
            need(squared > off, "places do not resolve Omega_1")
            self.least.append(ONE * ONE // (squared + off))
            self.most.append(ONE * ONE // (squared - off) + 1)

    def angle(self, n: int) -> Gaussian:
        """sigma + n omega, each part rounded down."""
        real = self.exponent.real + n * self.omega
        return in_units(real), in_units(self.exponent.imaginary)

    def size_of_angle(self, n: int) -> int:
        """Above |Re| + |Im| of it."""
        re, im = self.angle(n)
        return abs(re) + abs(im) + 2

    def of(self, place: Place) -> Divisor:
        """1 - (sigma + n omega)^2 / Omega_q^2."""
        n, q = place
        (x, y), least, most = self.angle(n), self.least[q], self.most[q]
        re = ONE - ((x * x - y * y) * least >> (2 * PLACES))
        im = -(2 * x * y * least >> (2 * PLACES))
        size = self.size_of_angle(n)
        off_square = (2 * size >> PLACES) + 2  # rounding of the angle, units
        off = off_square * most + size * size * (most - least) // ONE
        return Divisor(re, im, (off >> PLACES) + 2)

    def edge(self, n: int, q: int) -> int:
        """Below |lambda_q| of every harmonic from n on, on both sides, where it is positive."""
        far = in_units(n * self.omega - abs(self.exponent.real))
        return (far * far * self.least[q] >> (2 * PLACES)) - ONE if far > 0 else -ONE

    def check_beyond(self) -> None:
        """Beyond `free` every harmonic is above all modes: |lambda| grows from there on."""
        for q in range(1, self.N):
            need(self.edge(self.free + 1, q) > 0, f"harmonic {self.free + 1} is too low")

    def inverse_beyond(self, n: int, q: int) -> int:
        """Above |Re| + |Im| of 1/lambda_q of every harmonic from n on."""
        found = ONE * ONE // self.edge(n, q) + 1
        return found if self.exponent.reals else found * 3 // 2 + 1  # above the root of 2

    # what an error of the frequency moves: z = (n + turns) omega + value goes with it

    def moved_angle(self, n: int) -> Fraction:
        """Above what z of a harmonic moves."""
        return abs(n + self.exponent.turns) * self.omega_off

    def moved(self, place: Place) -> Fraction:
        """Above |Re| + |Im| of what lambda moves: of 2 z d + d^2, over Omega^2."""
        n, q = place
        move = self.moved_angle(n)
        size = Fraction(self.size_of_angle(n), ONE)
        return move * (2 * size + move) * Fraction(self.most[q], ONE)

    def moved_beyond(self, n: int, q: int) -> Fraction:
        """Above |1/lambda| times what lambda moves, for every harmonic from n on.

        With x = |Re z| and s = |Re value| + |Im value| the move of z is at most (x + s) e,
        e = omega_off / omega, and |z| at most x + s. (x + s)^2 / (x^2 - Omega^2) falls with x.
        """
        one, part = self.exponent, self.omega_off / self.omega
        far = n * self.omega - abs(one.real) + abs(one.value) + abs(one.imaginary)
        of_divisor = Fraction(self.inverse_beyond(n, q) * self.most[q], ONE * ONE)
        # x is at least n omega - |Re sigma|, where the divisor is taken
        return part * (2 + part) * far**2 * of_divisor
