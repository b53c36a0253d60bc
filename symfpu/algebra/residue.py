"""The ring of residues modulo a prime p = 1 mod 4N: exact, at the speed of doubles.

F_p then holds the cosines of the chain, and a coefficient whose residue is not zero is not zero:
reduction is a ring homomorphism wherever no divisor vanishes. Residues are integers in -p/2 ..
p/2 held as doubles.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from symfpu.algebra.dense import Floats, ValuesRing
from symfpu.algebra.grading import Ints
from symfpu.algebra.selection import CosineModes

PRIME_BITS = 40
LIMB = 2.0**20  # two limbs of 20 bits, so that matrix products of limbs are exact


def longest_sum(seeds: int, degree: int) -> int:
    """The largest number of factor pairs of one monomial of this degree."""
    each, rest = divmod(degree, 2 * seeds)
    return int((each + 2) ** rest * (each + 1) ** (2 * seeds - rest))


def largest_modulus(seeds: int, degree: int) -> int:
    """Primes below this keep all sums of a series of this degree exact."""
    return int(min(2**PRIME_BITS, 2**52 // longest_sum(seeds, degree)))


class ResidueRing(ValuesRing):
    """Coefficients modulo a prime; root is an element of order 4N."""

    name = "residue"

    def __init__(
        self, space: CosineModes, prime: int, root: int, *, workers: int | None = None
    ) -> None:
        self.prime, self.root = prime, root
        self.modulus = float(prime)
        super().__init__(space, workers=workers)

    def element(self, number: int) -> float:
        """The residue of an integer in -p/2 .. p/2."""
        residue = number % self.prime
        return float(residue - self.prime if residue > self.prime // 2 else residue)

    def number(self, value: Fraction) -> float:
        inverse = pow(value.denominator, -1, self.prime)
        return self.element(value.numerator * inverse)

    def _cosines(self, angles: Ints) -> Floats:
        table = cosine_table(self.space.N, self.prime, self.root)
        elements = np.array([self.element(c) for c in table])
        return elements[angles]

    def _reciprocal(self, number: int) -> float:
        return self.element(pow(number, -1, self.prime))

    def _matrix_product(self, left: Floats, right: Floats) -> Floats:
        """Exact by limbs: sums of at most 2^13 products of 19-bit numbers stay below 2^52."""
        a1, b1 = np.rint(left / LIMB), np.rint(right / LIMB)
        a0, b0 = left - a1 * LIMB, right - b1 * LIMB
        unit = int(LIMB)
        high, mixed = self._reduced(a1 @ b1), self._reduced(a1 @ b0 + a0 @ b1)
        top = self._times(high, self.element(unit**2))
        middle = self._times(mixed, self.element(unit))
        return self._reduced(top + middle + a0 @ b0)

    def _times(self, values: Floats, factor: Floats | float) -> Floats:
        values = np.ascontiguousarray(values)
        factors = np.asarray(factor, dtype=np.float64)
        other = np.ascontiguousarray(np.broadcast_to(factors, values.shape))
        self._kernels.multiply_elements(values, other, self.modulus, values)
        return values

    def _reduced(self, values: Floats) -> Floats:
        assert self.modulus is not None
        turns = np.rint(values / self.modulus)
        values -= self.modulus * turns
        return values

    def _keep_in_range(self, degree: int, modes: Floats) -> None:
        """Residues do not grow."""

    def inverses(self, values: Floats) -> Floats:
        """1 / value for every element, by Fermat's little theorem; zero stays zero."""
        result, power = np.ones_like(values), values.copy()
        exponent = self.prime - 2
        while exponent:
            if exponent & 1:
                result = self._times(result, power)
            power = self._times(power, power.copy())
            exponent >>= 1
        return result

    def reduced(self, values: Floats) -> Floats:
        """Integers below 2^53 in size as residues; the array is overwritten."""
        return self._reduced(values)

    def products(self, left: Floats, right: Floats) -> Floats:
        """Element by element products of arrays that broadcast."""
        left, right = np.broadcast_arrays(left, right)
        return self._times(left.copy(), right)


def cosine_table(N: int, prime: int, root: int) -> list[int]:
    """cos(k pi / 2N) = (root^k + root^-k) / 2 modulo the prime for k = 0 .. 2N."""
    inverse, half = pow(root, -1, prime), pow(2, -1, prime)
    table = []
    for k in range(2 * N + 1):
        power, reciprocal = pow(root, k, prime), pow(inverse, k, prime)
        table.append((power + reciprocal) * half % prime)
    return table
