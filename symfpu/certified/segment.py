"""A segment of a family: its line of orbits, and what that adds to the bounds.

x(s) = x + s t, s in -1 .. 1, x the orbit with the square of its frequency and t the tangent of
its family. F(s, x(s)) is F(x), s times a small vector, and a rest of second order. Ours;
docs/existence.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np

from symfpu.certified.bond_balls import BondBalls, Series, product
from symfpu.certified.border import Border, power_of_two
from symfpu.certified.bordered_newton import as_integers, bordered_matrix
from symfpu.certified.contraction import WEIGHT_BITS, Contraction
from symfpu.certified.existence_bounds import norm_of_image
from symfpu.certified.force_series import ball


@dataclass(frozen=True, eq=False)
class Direction:
    """t in units 2^-bits: of the unknown frequency, and rows of coefficients by harmonic."""

    of_frequency: int
    rows: tuple[tuple[int, ...], ...]


def direction(balls: BondBalls, border: Border) -> Direction:
    """Of the family, by s."""
    zeros = np.zeros((1, balls.layout.modes))
    of_frequency, rows = bordered_matrix(balls, border).solve(float(border.change), zeros)
    bits, harmonics = balls.orbit.bits, balls.orbit.harmonics
    integers = as_integers(rows[: harmonics + 1], bits)
    kept = tuple(tuple(row) for row in integers.tolist())
    return Direction(round(Fraction(of_frequency) * 2**bits), kept)


class Line:
    """The line of orbits in balls.

    length : |t|. drift : above |A (DF t + dF/ds)|. at_rest : of every bond above the stretch of t
        at t = 0.
    """

    def __init__(
        self, balls: BondBalls, border: Border, found: Contraction, given: Direction
    ) -> None:
        self.given, self.unit = given, power_of_two(-balls.orbit.bits)
        self.stretches = balls.on_bonds(
            [[self.unit * x for x in row] for row in given.rows]
        )
        self.at_rest = [abs(sum(bond, flint.arb(0))) for bond in self.stretches]
        self.length = self._length(balls, found)
        image = self._image(balls, border)
        of_coefficients, _ = norm_of_image(balls, found, image)
        of_condition = abs(self._of_condition(balls, border))
        lost = sum(map(self._lost(balls), balls.norms, self.stretches), flint.arb(0))
        self.drift = (
            of_coefficients
            + of_condition * float(found.columns_of_inverse[0])
            + lost * ball(balls.layout.share) * flint.arb(found.spread)
        )

    def _length(self, balls: BondBalls, found: Contraction) -> Any:
        """The weighted norm of t."""
        weights = {
            (n, q): int(v)
            for n, q, v in zip(found.places.n, found.places.q, found.weights, strict=False)
        }
        plain = 2**WEIGHT_BITS
        total = flint.arb(abs(self.given.of_frequency) * weights[0, 0])
        power = flint.arb(1)
        for n, row in enumerate(self.given.rows):
            sizes = (abs(x) * weights.get((n, q), plain) for q, x in enumerate(row, 1))
            total += power * sum(sizes)
            power *= balls.nu
        return total * self.unit / plain

    def _image(self, balls: BondBalls, border: Border) -> list[list[Any]]:
        """DF t, rows by harmonic."""
        pairs = zip(balls.slopes, self.stretches, strict=True)
        rows = balls.of_modes([product(slope, stretch) for slope, stretch in pairs])
        balls.add_linear(rows, self.given.rows)
        factor = border.unit * self.given.of_frequency * self.unit**2
        for n, row in enumerate(balls.orbit.rows):
            for place, x in enumerate(row):
                rows[n][place] -= n**2 / balls.linear[place] * x * factor
        return rows

    def _of_condition(self, balls: BondBalls, border: Border) -> Any:
        """DG t + dG/ds."""
        place, given = balls.layout.place, self.given
        total = flint.arb(
            border.corner * given.of_frequency + border.of_seed * given.rows[1][place]
        )
        for slopes, row in zip(border.rows, given.rows, strict=False):
            total += sum(
                (slope * x for slope, x in zip(slopes, row, strict=True)), flint.arb(0)
            )
        return total * self.unit - border.change

    def _lost(self, balls: BondBalls) -> Any:
        """Of a bond above what its slope leaves out."""

        def of_bond(size: Any, stretch: Series) -> Any:
            return balls.force.left_out(size, 1) * balls.norm(stretch)

        return of_bond
