"""The ring of SymEngine expressions: cosine coefficients multiplied by the selection rules, term by
term.

It works by definition rather than for speed, keeps integer coefficients integers, and serves
small orders: what the fast rings are tested against.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.selection import CosineModes

Objects = NDArray[np.object_]
Monomial = tuple[int, ...]
Cosines = dict[int, Any]  # wave number 0 .. N-1 -> coefficient of cos(q theta)


class SymbolicRing:
    """Coefficients as SymEngine expressions: expanded, or nested as the recursion builds them
    (zeros are found either way).
    """

    def __init__(self, space: CosineModes, *, nested: bool = False) -> None:
        self.name = "nested" if nested else "symbolic"
        self.nested, self.multiply_adds = nested, 0
        self.space, self.grading = space, space.grading
        self._modes: dict[int, Objects] = {}
        self._bonds: dict[int, dict[Monomial, Cosines]] = {}
        # powers of the bonds, by degree
        self._powers: dict[int, dict[int, dict[Monomial, Cosines]]] = {}
        self._corrections: dict[int, Objects] = {}

    def _monomials(self, degree: int) -> list[Monomial]:
        return [tuple(map(int, row)) for row in self.grading.exponents(degree)[self.grading.canonical(degree)]]

    def _zeros(self, degree: int) -> Objects:
        return np.full((len(self.grading.canonical(degree)), self.space.N - 1), se.Integer(0), dtype=object)

    def coupling(self, power: int, value: Fraction) -> Any:
        return se.Integer(value.numerator) / se.Integer(value.denominator)

    def seed_terms(self) -> Objects:
        modes = self._zeros(1)
        for row, power in enumerate(self.grading.powers(1)):
            seed = self.space.seeds[int(np.argmax(power))]
            modes[row, seed - 1] = se.Integer(1)
        return modes

    def put(self, degree: int, modes: Objects) -> None:
        self._modes[degree] = modes
        bonds = {}
        for monomial, row in zip(self._monomials(degree), modes, strict=True):
            cosines = {q + 1: value for q, value in enumerate(row) if value != 0}
            bonds[monomial] = bonds[conjugate(monomial)] = cosines
        self._bonds[degree] = bonds

    def power(self, power: int, degree: int) -> dict[Monomial, Cosines]:
        if power == 2:
            return self._sum(self._bonds, self._bonds, degree)
        known = self._powers.setdefault(power - 1, {})
        for d in range(power - 1, degree):
            if d not in known:
                known[d] = self.power(power - 1, d)
        return self._sum(known, self._bonds, degree)

    def _sum(self, left: dict[int, Any], right: dict[int, Any], degree: int) -> dict[Monomial, Cosines]:
        result: dict[Monomial, Cosines] = defaultdict(lambda: defaultdict(lambda: se.Integer(0)))
        for d in left:
            if degree - d not in right:
                continue
            for a, f in left[d].items():
                for b, g in right[degree - d].items():
                    product = tuple(x + y for x, y in zip(a, b, strict=True))
                    self._add_product(result[product], f, g)
        return {monomial: self._without_zeros(cosines) for monomial, cosines in result.items()}

    def _without_zeros(self, cosines: Cosines) -> Cosines:
        simplified = {q: self._simplified(value) for q, value in cosines.items()}
        return {q: value for q, value in simplified.items() if value != 0}

    def _simplified(self, value: Any) -> Any:
        expanded = se.expand(value)
        return value if self.nested and expanded != 0 else expanded

    def _add_product(self, out: Cosines, f: Cosines, g: Cosines) -> None:
        """out += f o g by 2 T_l T_m = T_(l+m) + T_(l-m), with T_N = 0 and T_(2N-q) = -T_q."""
        N = self.space.N
        for l, x in f.items():
            for m, y in g.items():
                term = x * y
                for q in (l + m, abs(l - m)):
                    if q < N:
                        out[q] += term
                    elif q > N:
                        out[2 * N - q] -= term

    def project(self, degree: int, parts: Sequence[tuple[Any, dict[Monomial, Cosines]]]) -> Objects:
        modes = self._zeros(degree)
        for row, monomial in enumerate(self._monomials(degree)):
            for coefficient, bonds in parts:
                for q, value in bonds.get(monomial, {}).items():
                    if q > 0:
                        modes[row, q - 1] += coefficient * value
        return modes

    def secular(self, degree: int, modes: Objects) -> Objects:
        place = self._places(degree)
        diagonal = self.grading.diagonal(degree - 1)
        table = self._of_seeds(len(diagonal))
        for t, e in enumerate(diagonal):
            for i, q in enumerate(self.space.seeds):
                row = place[raised(e, i)]
                table[t, i] = modes[row, q - 1]
        return table

    def _places(self, degree: int) -> dict[Monomial, int]:
        """The row of each canonical monomial."""
        return {monomial: row for row, monomial in enumerate(self._monomials(degree))}

    def _of_seeds(self, rows: int) -> Objects:
        """Zeros with a column for each seed."""
        return np.full((rows, len(self.space.seeds)), se.Integer(0), dtype=object)

    def correct(self, degree: int, corrections: Objects) -> None:
        self._corrections[degree] = corrections

    def corrected(self, degree: int) -> Objects:
        place = self._places(degree)
        table = self._of_seeds(len(place))
        for n, corrections in self._corrections.items():
            if degree - n not in self._modes:
                continue
            diagonals = zip(self.grading.diagonal(n), corrections, strict=True)
            for e, values in diagonals:
                self._add_corrected(table, place, degree - n, np.repeat(e, 2), values)
        return table

    def _add_corrected(self, table: Objects, place: dict[Monomial, int], degree: int, diagonal: Any, values: Any) -> None:
        """table += W_q u_q, of one coefficient of the corrections and the modes of a degree."""
        for monomial, terms in zip(self._monomials(degree), self._modes[degree], strict=True):
            product = tuple(m + int(k) for m, k in zip(monomial, diagonal, strict=True))
            row = place[product]
            for i, q in enumerate(self.space.seeds):
                table[row, i] += values[i] * terms[q - 1]

    def solve(self, degree: int, corrected: Objects, force: Objects, multipliers: Objects) -> Objects:
        _, index = self.grading.harmonics(degree)
        bracket = -force
        seeds = np.array(self.space.seeds) - 1
        bracket[:, seeds] += corrected
        modes = self._zeros(degree)
        for row, column in np.argwhere(bracket != 0):
            multiplier = multipliers[index[row], column]
            value = self._simplified(bracket[row, column])
            modes[row, column] = self._simplified(multiplier * value)
        return modes

    def results(self) -> tuple[list[Objects], list[Objects], Fraction]:
        return list(self._modes.values()), list(self._corrections.values()), Fraction(1)


def conjugate(monomial: Monomial) -> Monomial:
    """Exponents with the roles of z and conj z exchanged."""
    return tuple(monomial[i ^ 1] for i in range(len(monomial)))


def raised(diagonal: Any, i: int) -> Monomial:
    """Exponents of z_i times |z|^(2e)."""
    exponents = [int(e) for e in diagonal for _ in (0, 1)]
    exponents[2 * i] += 1
    return tuple(exponents)
