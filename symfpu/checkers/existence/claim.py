"""The claim of a certificate: a chain, a frequency, an orbit, and what it has exactly."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symfpu.checkers.existence.reading import MOST_BITS, unpacked
from symfpu.checkers.existence.shape import Shape, read_shape
from symfpu.checkers.reading import Json, fraction, fractions, need, whole

MOST_HARMONICS = 4096
HIGHEST_DEGREE = 200
FARTHEST_SCALE = 400  # binary places
FREQUENCY, AMPLITUDE, ENERGY = "frequency", "amplitude", "energy"

Place = tuple[int, int]  # harmonic n, mode q


class Growth(NamedTuple):
    """weight (g - 1) of a tension, (1 + slope r) g' = rate g, g(0) = 1."""

    weight: Fraction
    slope: Fraction
    rate: Fraction

    def ratio(self, k: int) -> Fraction:
        """g_(k+1) / g_k."""
        return (self.rate - self.slope * k) / (k + 1)


class Force(NamedTuple):
    """phi(r) = V'(r) - r: coefficients by power of r up to `degree`, and functions beyond."""

    couplings: dict[int, Fraction]
    growths: list[Growth]
    degree: int

    @property
    def even(self) -> bool:
        """Whether V is even, which of functions their signs show."""
        mirrored = [Growth(-g.weight, -g.slope, -g.rate) for g in self.growths]
        return sorted(mirrored) == sorted(self.growths) and all(
            k % 2 for k in self.couplings
        )

    def slope_bound(self, x: Fraction) -> Fraction:
        """Above |phi'(r)| in the norm where |r| is at most x."""
        terms = (abs(c) * k * x ** (k - 1) for k, c in self.couplings.items())
        return sum(terms, self.left_out(x, 1))

    def curvature_bound(self, x: Fraction) -> Fraction:
        """Above |phi''(r)| in the norm where |r| is at most x."""
        terms = (abs(c) * k * (k - 1) * x ** (k - 2) for k, c in self.couplings.items())
        return sum(terms, self.left_out(x, 2))

    def virial_terms(self) -> dict[int, Fraction]:
        """The derivative of V + r V'/2 by power of r, 2 r + (3 phi + r phi')/2."""
        terms = {k: c * Fraction(k + 3, 2) for k, c in self.couplings.items()}
        return {1: Fraction(2), **terms}

    def virial_left_out(self, x: Fraction) -> Fraction:
        """Above the norm of what that leaves out."""
        return (3 * self.left_out(x, 0) + x * self.left_out(x, 1)) / 2

    def virial_slope_bound(self, x: Fraction) -> Fraction:
        """Above the norm of its derivative, 2 + 2 phi' + r phi''/2, where |r| is at most x."""
        return 2 + 2 * self.slope_bound(x) + x * self.curvature_bound(x) / 2

    def left_out(self, x: Fraction, derivative: int) -> Fraction:
        """Above the norm of a derivative of the powers of phi beyond `degree`, |r| at most x."""
        parts = (rest_of_growth(g, self.degree + 1, x, derivative) for g in self.growths)
        return sum(parts, Fraction(0))


def rest_of_growth(growth: Growth, first: int, x: Fraction, derivative: int) -> Fraction:
    """Above the sum of |weight g_k| k (k-1) .. x^(k - derivative) from k = first on.

    The ratio of neighbours, |rate - slope k|/(k+1) x (k+1)/(k+1 - derivative), is at most its
    bound at `first` with the larger of (|rate| + |slope| first)/(first + 1) and |slope|.
    """
    size = abs(growth.weight)
    for k in range(first):
        size *= abs(growth.ratio(k))
    for i in range(derivative):
        size *= first - i
    rate, slope = abs(growth.rate), abs(growth.slope)
    largest = max(slope, (rate + slope * first) / (first + 1))
    ratio = largest * Fraction(first + 1, first + 1 - derivative) * x
    need(ratio < 1, "stretches are too large for the powers of phi that are used")
    return size * x ** (first - derivative) / (1 - ratio)


class Claim(NamedTuple):
    """What the theorem is about: a chain, a frequency, an orbit, a norm, a condition.

    omega : the frequency, or its middle. orbit : c_q[n] 2^bits by place, not zero; harmonics : the
    last n. fixed, value, half_width : what the orbit has exactly, and how far a segment goes.
    unknown_places, equation_places : omega^2 is 2^-unknown_places times the unknown, and the
    equation is multiplied by 2^-equation_places. direction, of_frequency : of a segment 2^bits.
    """

    shape: Shape
    force: Force
    omega: Fraction
    nu: Fraction
    bits: int
    orbit: dict[Place, int]
    harmonics: int
    fixed: str
    value: Fraction
    half_width: Fraction
    unknown_places: int
    equation_places: int
    direction: dict[Place, int]
    of_frequency: int

    @property
    def bordered(self) -> bool:
        """Whether the frequency is an unknown."""
        return self.fixed != FREQUENCY or self.half_width > 0

    @property
    def unit(self) -> Fraction:
        """omega^2 where the unknown is 1."""
        return Fraction(2) ** -self.unknown_places

    @property
    def N(self) -> int:
        """Bonds of the chain."""
        return self.shape.N

    def allowed(self, n: int) -> Sequence[int]:
        """The modes that the symmetry of the orbit leaves at a harmonic."""
        return self.shape.allowed(n)


def read_claim(data: Json) -> Claim:
    """The claim, its sizes bounded."""
    bits = whole(data["bits"], 1, MOST_BITS, "bits")
    force = read_force(data)
    shape = read_shape(data, even=force.even)
    omega, nu = fraction(data["omega"], "omega"), fraction(data["nu"], "nu")
    need(omega > 0, "omega is not positive")
    need(1 < nu <= 2, "nu is not in 1 < nu <= 2")
    need(nu.denominator <= 2**20, "nu has too large a denominator")
    rows = data["orbit"]
    whole(len(rows), 2, MOST_HARMONICS, "the number of harmonics")
    orbit = read_rows(rows, shape)
    need(orbit.get(shape.place), "the seed has no amplitude")
    condition, segment = read_condition(data, omega), read_segment(data, shape)
    harmonics = len(rows) - 1
    return Claim(shape, force, omega, nu, bits, orbit, harmonics, *condition, *segment)


def read_rows(rows: Any, shape: Shape) -> dict[Place, int]:
    """Coefficients by place; rows are harmonics, with the modes that the symmetry allows."""
    found = {}
    for n, text in enumerate(rows):
        modes, row = shape.allowed(n), unpacked(text, f"harmonic {n}")
        need(len(row) == len(modes), f"wrong length of harmonic {n}")
        for q, value in zip(modes, row, strict=True):
            found[n, q] = whole(value, -(2**4000), 2**4000, "a coefficient")
    return found


def read_force(data: Json) -> Force:
    """phi, as a polynomial or as a sum of functions of which the first powers are used."""
    degree = whole(data["degree"], 2, HIGHEST_DEGREE, "degree")
    texts, growths = data["coefficients"], data["growths"]
    need(type(texts) is list and type(growths) is list, "wrong coefficients")
    need(bool(texts) != bool(growths), "a polynomial or functions, one of the two")
    if growths:
        return force_of_growths(read_growths(growths, degree), degree)
    need(len(texts) == degree - 1, "wrong coefficients")
    values = fractions(texts, 1, "a coefficient of V")
    need(any(values), "the chain is harmonic")
    return Force({k: c for k, c in enumerate(values, 2) if c}, [], degree)


def read_growths(entries: Any, degree: int) -> list[Growth]:
    """The functions of a tension; r itself has the coefficient 1."""
    need(len(entries) <= 8, "too many functions")
    found = []
    for entry in entries:
        weight, slope, rate = fractions(entry, degree, "a function's number")
        found.append(Growth(weight, slope, rate))
    need(sum(g.weight * g.rate for g in found) == 1, "the linear force is not r")
    return found


def force_of_growths(growths: list[Growth], degree: int) -> Force:
    """The powers up to a degree."""
    couplings: dict[int, Fraction] = {}
    for growth in growths:
        coefficient = growth.weight
        for k in range(degree):
            coefficient *= growth.ratio(k)
            if k:
                couplings[k + 1] = couplings.get(k + 1, Fraction(0)) + coefficient
    couplings = {k: c for k, c in couplings.items() if c}
    need(couplings, "the chain is harmonic")
    return Force(couplings, growths, degree)


def read_condition(data: Json, omega: Fraction) -> tuple[str, Fraction, Fraction, int, int]:
    """What the orbit has exactly, and the scales of the unknown frequency and of its equation."""
    fixed = data["fixed"]
    need(fixed in (FREQUENCY, AMPLITUDE, ENERGY), "nothing that can be fixed")
    value, width = (
        fraction(data["value"], "value"),
        fraction(data["half_width"], "half_width"),
    )
    need(0 <= width < abs(value), "half_width is not in 0 <= half_width < |value|")
    if fixed == FREQUENCY:
        need(value == omega, "the value is not the frequency")
        if width == 0:
            need(
                data["scales"] == [] and data["frequency"] == [],
                "scales without an unknown",
            )
            return fixed, value, width, 0, 0
    unknown, equation = data["scales"]
    whole(unknown, -FARTHEST_SCALE, FARTHEST_SCALE, "a scale")
    whole(equation, -FARTHEST_SCALE, FARTHEST_SCALE, "a scale")
    return fixed, value, width, unknown, equation


def read_segment(data: Json, shape: Shape) -> tuple[dict[Place, int], int]:
    """The direction of a segment; none of a single orbit."""
    rows = data["direction"]
    of_frequency = whole(data["direction_frequency"], -(2**4000), 2**4000, "a direction")
    need(type(rows) is list and len(rows) <= len(data["orbit"]), "wrong direction")
    if fraction(data["half_width"], "half_width") == 0:
        need(rows == [] and of_frequency == 0, "a direction without a segment")
    else:
        need(len(rows) >= 2, "a segment without a direction")
    return read_rows(rows, shape), of_frequency
