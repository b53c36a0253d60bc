"""The equations of motion linearised about a torus in fixed point: Kronecker products by FLINT.

K, the products with V''(r) - 1 on the bonds, is even in the angles; what it acts on is any
function of them, packed into one polynomial by the same substitution. Every number is an integer
times 2^-bits; complex ones have two.
"""

from __future__ import annotations

from typing import Any

import flint
import numpy as np

from symfpu.chain.projections.by_ends import projection
from symfpu.chain.tension_terms import Terms, stiffness_terms
from symfpu.numbers.arithmetic import mpf
from symfpu.refinement.kronecker import Box, Integers, KroneckerForce
from symfpu.refinement.lattice import Ints
from symfpu.tori.torus import Torus

NEAR_REACH = 1.01  # times the largest stretch


class KroneckerFlow(KroneckerForce):
    """L(sigma) of a torus with many digits, from and to chosen harmonics.

    harmonics : of both signs, (M, s). Made at a working precision of mpmath above the bits.
    """

    def __init__(self, torus: Torus, harmonics: Ints, bits: int) -> None:
        self.harmonics = harmonics
        every = np.concatenate([harmonics, torus.harmonics])
        box = Box(np.abs(every).max(axis=0), whole=False)
        there = projection(torus.chain, torus.seeds, harmonics)
        super().__init__(there, box, bits, _reach(torus))
        self.omega: Integers = np.array(
            [self.fixed(w) for w in torus.frequencies], dtype=object
        )
        self.rates: Integers = harmonics.astype(object) @ self.omega
        self._places = box.middle + harmonics @ box.strides
        self._slopes = self._packed_slopes(torus)

    def _terms(self, reach: Any) -> Terms:
        """Of V''(r) - 1."""
        return stiffness_terms(self.chain, self.bits, reach)

    def _packed_slopes(self, torus: Torus) -> list[Any]:
        """V''(r) - 1 of half of the bonds, as polynomials."""
        each_fixed = np.frompyfunc(lambda x: self.fixed(mpf(x)), 1, 1)
        stretches = self.stretches(torus.harmonics, each_fixed(torus.cosines))
        rows = self.box.rows(torus.harmonics)
        return [
            self.box.packed(self._sum_of_powers(rows, r, 0).values) for r in stretches.T
        ]

    def coupling(self, rows: Ints, p: Integers) -> Integers:
        """K p at all chosen harmonics, (M, N-1), of real p (F, N-1) at some of them.

        It holds where the selection rules let a mode carry a harmonic.
        """
        stretches = self.stretches(self.harmonics[rows], p)
        sums = np.zeros((len(self.harmonics), stretches.shape[1]), dtype=object)
        for j, slope in enumerate(self._slopes):
            sums[:, j] = self._multiplied(slope, self._places[rows], stretches[:, j])
        return self.driven(self.harmonics, sums)

    def _multiplied(self, slope: Any, places: Ints, values: Integers) -> Integers:
        """A slope times a function that has values at places; at all chosen harmonics."""
        middle = self.box.middle
        table = np.zeros(2 * middle + 1, dtype=object)
        table[places] = values
        found = (slope * flint.fmpz_poly(table.tolist())).coeffs()
        product = np.zeros(4 * middle + 1, dtype=object)
        product[: len(found)] = found
        kept = product[self._places + middle]
        # a packed slope is twice the slope
        return np.asarray((kept + (1 << self.bits)) >> (self.bits + 1))

    def image(self, rows: Ints, p: Integers, sigma: Integers) -> Integers:
        """L(sigma) p at all chosen harmonics, (n, M, N-1), of p (n, F, N-1) at some of them.

        n : 1, or 2 for real and imaginary parts; sigma (n,).
        """
        images = np.array([self.coupling(rows, part) for part in p], dtype=object)
        divisors = self.divisors(sigma)[:, rows]
        images[:, rows] += multiplied(divisors, p, self.bits)
        return images

    def divisors(self, sigma: Integers) -> Integers:
        """Omega_q^2 - (sigma + nu.omega)^2 at all chosen harmonics; (n, M, N-1)."""
        rates = np.zeros((len(sigma), len(self.rates)), dtype=object)
        rates[:] = sigma[:, None]
        rates[0] += self.rates
        found = -multiplied(rates, rates, self.bits)[:, :, None]
        squares = self.squares(self.harmonics)
        found = np.repeat(found, squares.shape[1], axis=2)
        found[0] += squares
        return np.asarray(found)


def _reach(torus: Torus) -> float:
    """What no stretch of a torus exceeds."""
    stretches = np.abs(torus.chain.stretches(torus.cosines.astype(float)))
    return float(NEAR_REACH * stretches.sum(axis=0).max())


def multiplied(left: Integers, right: Integers, bits: int) -> Integers:
    """The product of real (1, ..) or complex (2, ..) numbers in fixed point."""
    if len(left) == 1:
        return np.asarray((left * right) >> bits)
    (a, b), (c, d) = left, right
    return np.array([(a * c - b * d) >> bits, (a * d + b * c) >> bits], dtype=object)
