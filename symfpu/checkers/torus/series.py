"""Series of many angles in fixed point, with a bound of what they are off by."""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers.reading import need
from symfpu.checkers.rounding import up
from symfpu.checkers.torus.budget import PLACE, Budget, fraction_steps, packed_steps

Harmonic = tuple[int, ...]
Row = list[Fraction]
MOST_PLACES = 8_000_000  # of the box of a product


class Series(NamedTuple):
    """values : integers by harmonic, in units of 2^-places. error : of the norm, in units."""

    values: dict[Harmonic, int]
    places: int
    error: int = 0

    @property
    def size(self) -> int:
        """Above the norm, in units."""
        return sum(map(abs, self.values.values())) + self.error

    @property
    def norm(self) -> Fraction:
        """Above the norm."""
        return Fraction(self.size, 1 << self.places)


def combined(terms: Iterable[tuple[Fraction | int, Series]]) -> Series:
    """sum factor series, of series with the same places; a factor that is no integer rounds."""
    total: dict[Harmonic, int] = {}
    error, places = 0, 0
    for factor, series in terms:
        top, bottom = factor.numerator, factor.denominator
        places = series.places
        for nu, x in series.values.items():
            total[nu] = total.get(nu, 0) + x * top // bottom
        error += up(series.error * abs(Fraction(factor)))
        error += len(series.values) if bottom > 1 else 0
    return Series(total, places, error)


def shifted(series: Series, places: int) -> Series:
    """With other places, rounded to nearest; what is zero then is left out."""
    shift = series.places - places
    if shift <= 0:
        values = {nu: x << -shift for nu, x in series.values.items()}
        return Series(values, places, series.error << -shift)
    half, values, lost = 1 << (shift - 1), {}, series.error
    for nu, x in series.values.items():
        near = (x + half) >> shift
        lost += abs(x - (near << shift))
        if near:
            values[nu] = near
    return Series(values, places, up(Fraction(lost, 1 << shift)))


def derivative(series: Series, m: int) -> Series:
    """nu_m a[nu]; of series without error."""
    need(not series.error, "a derivative of an error has no bound")
    return series._replace(values={nu: nu[m] * x for nu, x in series.values.items()})


def turned(
    series: Series, omega: Row, rate: Fraction, power: int, budget: Budget
) -> Series:
    """(rate + nu.omega)^power a[nu], rounded down; of series without error."""
    need(not series.error, "a derivative of an error has no bound")
    steps = sum(fraction_steps(w, series.size.bit_length()) for w in (rate, *omega))
    budget.spend(len(series.values) * power * len(omega) * steps)
    values = {}
    for nu, x in series.values.items():
        factor = (rate + sum(n * w for n, w in zip(nu, omega, strict=True))) ** power
        values[nu] = x * factor.numerator // factor.denominator
    return Series(values, series.places, len(values))


def mirrored(series: Series, sign: int) -> Series:
    """sign a[-nu]."""
    values = {tuple(-n for n in nu): sign * x for nu, x in series.values.items()}
    return series._replace(values=values)


def product(a: Series, b: Series, budget: Budget) -> Series:
    """With the places of both, exact products rounded once."""
    if not a.values or not b.values:
        return Series({}, a.places, up(Fraction(a.size * b.size, 1 << a.places)))
    values = exact_product(a, b, budget)
    error = a.size * b.error + (b.size - b.error) * a.error
    return shifted(Series(values, a.places + b.places, error), a.places)


def exact_product(a: Series, b: Series, budget: Budget) -> dict[Harmonic, int]:
    """Coefficients of the product of values, by the shorter of two ways."""
    packing = Packing([a, b], 1)
    pairs = float(PLACE * len(a.values) * len(b.values))
    budget.spend(min(pairs, packing.steps))
    if pairs < packing.steps:
        return by_pairs(a, b)
    packing.check_places()
    return packing.unpacked(packing.packed(a) * packing.packed(b))


def by_pairs(a: Series, b: Series) -> dict[Harmonic, int]:
    """The same of few harmonics in a large box: every pair of them."""
    found: dict[Harmonic, int] = {}
    for nu, x in a.values.items():
        for mu, y in b.values.items():
            at = tuple(map(int.__add__, nu, mu))
            found[at] = found.get(at, 0) + x * y
    return found


class Packing:
    """Sums of products of series as those of single integers, by Kronecker's substitution.

    Box of twice the highest harmonics of all; a coefficient of a sum of `terms` products fits
    into its bytes with its sign.
    """

    def __init__(self, every: Sequence[Series], terms: int) -> None:
        harmonics = [nu for series in every for nu in series.values]
        highest = [max(map(abs, column)) for column in zip(*harmonics, strict=True)]
        self.lengths = [4 * m + 1 for m in highest]
        self.count = math.prod(self.lengths)
        self.highest = highest
        largest = max(series.size for series in every)
        self.width = (2 * largest.bit_length() + terms.bit_length() + 2) // 8 + 1
        self.steps = packed_steps(self.count, 8 * self.width)

    def check_places(self) -> None:
        """The box fits into memory."""
        need(self.count <= MOST_PLACES, "a product has too many harmonics")

    def packed(self, series: Series) -> int:
        """Sum of x 2^(8 width place), the place of -highest being 0."""
        plus, minus = bytearray(self.width * self.count), bytearray(self.width * self.count)
        for nu, x in series.values.items():
            place = 0
            for n, m, length in zip(nu, self.highest, self.lengths, strict=True):
                place = place * length + n + m
            start = place * self.width
            side = plus if x > 0 else minus
            side[start : start + self.width] = abs(x).to_bytes(self.width, "little")
        return int.from_bytes(plus, "little") - int.from_bytes(minus, "little")

    def unpacked(self, number: int) -> dict[Harmonic, int]:
        """The coefficients of a sum of products, those that are not zero."""
        width, zero = self.width, b"\0" * (self.width - 1) + b"\x80"
        bias = int.from_bytes(zero * self.count, "little")
        digits = (number + bias).to_bytes(width * (self.count + 1), "little")
        half, values = 1 << (8 * width - 1), {}
        for place in range(self.count):
            digit = digits[place * width : (place + 1) * width]
            if digit != zero:
                values[self.harmonic(place)] = int.from_bytes(digit, "little") - half
        return values

    def harmonic(self, place: int) -> Harmonic:
        """Of a place of a product."""
        nu = []
        for m, length in zip(reversed(self.highest), reversed(self.lengths), strict=True):
            place, at = divmod(place, length)
            nu.append(at - 2 * m)
        return tuple(reversed(nu))


def dot(one: Sequence[Fraction], other: Sequence[Fraction]) -> Fraction:
    """sum a b."""
    return sum((a * b for a, b in zip(one, other, strict=True)), Fraction(0))
