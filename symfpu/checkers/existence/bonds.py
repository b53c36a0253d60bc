"""The orbit on the bonds: stretches, forces and slopes as cosine series; the divisors of modes."""

from fractions import Fraction

from symfpu.checkers.existence.claim import Claim, Place
from symfpu.checkers.existence.fixed_point import (
    COSINE_UNITS,
    POWER_PLACES,
    Cosines,
    FixedPoint,
    Norm,
    Series,
    rounded_up,
)
from symfpu.checkers.reading import need
from symfpu.checkers.rounding import up

COARSE = 60  # places of everything but the residual
GUARD = 64  # places of the residual beyond those of the orbit


class Bonds:
    """Stretches, forces and slopes of all bonds along the orbit, P = bits + GUARD places."""

    def __init__(self, claim: Claim, harmonics: int) -> None:
        self.claim, self.shape = claim, claim.shape
        self.places = claim.bits + GUARD
        degree = max(claim.force.couplings)
        self.norm = Norm(claim.nu, max(degree * claim.harmonics, harmonics) + 1)
        self.cosines = Cosines(claim.N, self.places)
        self.arithmetic = FixedPoint(self.places, self.norm)
        self.stretches = self.on_bonds(claim.orbit)
        self.sizes = [self.size(stretch) for stretch in self.stretches]
        self.powers = [self.powers_of(series, degree) for series in self.stretches]
        force = claim.force
        rests = [force.left_out(size, 0) for size in self.sizes]
        self.forces = self.combinations(force.couplings, rests)
        slopes = {k - 1: k * c for k, c in force.couplings.items()}
        rests = [force.left_out(size, 1) for size in self.sizes]
        self.slopes = self.combinations(slopes, rests)

    def on_bonds(self, coefficients: dict[Place, int]) -> list[Series]:
        """sum_q c_q cos(q theta_j) of every bond."""
        return [self.stretch(coefficients, j) for j in range(self.shape.bonds)]

    def stretch(self, coefficients: dict[Place, int], j: int) -> Series:
        """Of bond j: the c are exact, the cosines off by COSINE_UNITS."""
        claim = self.claim
        values, error = [], 0
        for n in range(max(n for n, _ in coefficients) + 1):
            modes = claim.allowed(n)
            row = [coefficients[n, q] for q in modes]
            cosines = [self.shape.on_bond(self.cosines, q, j) for q in modes]
            total = sum(c * x for c, x in zip(row, cosines, strict=True))
            values.append(total >> claim.bits)
            off = COSINE_UNITS * (sum(map(abs, row)) >> claim.bits) + COSINE_UNITS + 1
            error += off * self.norm.powers[n]
        return Series(values, (error >> POWER_PLACES) + 1)

    def powers_of(self, series: Series, highest: int) -> dict[int, Series]:
        """The powers 1 .. highest."""
        found = {1: series}
        for k in range(2, highest + 1):
            found[k] = self.arithmetic.product(found[k - 1], series)
        return found

    def combinations(
        self, terms: dict[int, Fraction], rests: list[Fraction]
    ) -> list[Series]:
        """sum terms[k] r_j^k of every bond; the norms of what is left out are errors."""
        found = []
        for powers, rest in zip(self.powers, rests, strict=True):
            series = self.arithmetic.combination(powers, terms)
            lost = up(rest * (1 << self.places))
            found.append(Series(series.values, series.error + lost))
        return found

    def size(self, series: Series) -> Fraction:
        """Above the norm of a series, to COARSE places."""
        unit = 1 << self.places
        exact = Fraction(self.norm.of(series.values) + series.error, unit)
        return rounded_up(exact, COARSE)

    def at_rest(self, series: Series) -> tuple[Fraction, Fraction]:
        """The value at t = 0, and above its error."""
        unit = 1 << self.places
        return Fraction(sum(series.values), unit), Fraction(series.error, unit)

    def linear(self, q: int) -> tuple[Fraction, Fraction]:
        """Below and above Omega_q^2."""
        middle = self.shape.squared(self.cosines, q)
        off, unit = 2 * COSINE_UNITS, 1 << self.places
        need(middle > off, "places do not resolve Omega_1")
        return Fraction(middle - off, unit), Fraction(middle + off, unit)


class Divisors:
    """lambda_q[n] = 1 - n^2 omega^2 / Omega_q^2 between two integers, P places."""

    def __init__(self, claim: Claim, cosines: Cosines, places: int) -> None:
        squared = claim.omega**2
        self.one = 1 << places
        self.least, self.most = {}, {}
        self.inverse_below, self.inverse_above = {}, {}
        for q in claim.shape.modes:
            linear = claim.shape.squared(cosines, q)
            off = 2 * COSINE_UNITS
            need(linear > off, "places do not resolve Omega_1")
            self.inverse_below[q] = self.one**2 // (linear + off)  # of 1/Omega_q^2
            self.inverse_above[q] = self.one**2 // (linear - off) + 1
            above = squared * self.one**2
            self.least[q] = above // (linear + off)
            self.most[q] = above // (linear - off) + 1

    def between(self, n: int, q: int) -> tuple[int, int]:
        """Below and above lambda_q[n]."""
        return self.one - n * n * self.most[q], self.one - n * n * self.least[q]

    def size(self, n: int, q: int) -> int:
        """Below |lambda_q[n]|; refused where it may be zero."""
        low, high = self.between(n, q)
        need(low > 0 or high < 0, f"the divisor of mode {q}, harmonic {n} may be zero")
        return min(abs(low), abs(high))

    def of_unknown(self, n: int, q: int, factor: Fraction) -> tuple[int, int]:
        """Below and above -n^2 factor / Omega_q^2, what F_q[n] gains by the unknown."""
        ends = [
            -(n**2) * factor * x for x in (self.inverse_below[q], self.inverse_above[q])
        ]
        return min(ends).__floor__(), up(max(ends))
