"""Norms of a torus and its frame, and the growth of a distance that follows from them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import Any

from symfpu.certified.bounds import (
    PLACES,
    Column,
    Frame,
    Inverse,
    Row,
    identity_norms,
)
from symfpu.certified.frame import Direction
from symfpu.certified.growth import Growth, rounded_down, rounded_up
from symfpu.certified.rounded_torus import (
    RoundedTorus,
    polynomial_of,
    stretches_of,
)
from symfpu.certified.series import Series

LEAST_ROOM = 0.25
SLACK = Fraction(129, 128)  # of all bounds, so that a checker's own roundings fit
SWEEPS = 40  # of the search for weights


def norms_of(row: Sequence[Series]) -> Row:
    """One by one."""
    return [series.norm for series in row]


def dot(one: Sequence[Any], other: Sequence[Any]) -> Any:
    """sum a b."""
    return sum(a * b for a, b in zip(one, other, strict=True))


@dataclass(frozen=True, eq=False)
class Norms:
    """Bounds; rows are s tangents, then the directions, columns the directions.

    A normal direction's conjugate counts with it: `images` is 1 for the actions, 2 for others.
    residual : L R by row. left : L times what a column leaves, (rows, columns). bonds : of L, by
    row and bond. stretches : by column and bond. momenta : by column and particle. turned : L
    d_m Z, by angle, row, column. identity : of 1 - L M, by row and column of all. twist :
    |domega_m| by angle and column. lengths : |r_b|. couplings : |c_k| by power.
    """

    s: int
    images: list[int]
    residual: Row
    left: list[Row]
    bonds: list[Row]
    stretches: list[Row]
    momenta: list[Row]
    turned: list[list[Row]]
    identity: list[Row]
    twist: list[Row]
    lengths: Row
    couplings: dict[int, Fraction]

    def growth(self, weights: Sequence[Fraction]) -> Growth:
        """Of the weighted distance max |v_c| / w_c; weights : of tangents, then directions."""
        terms, defect, turning = self.bounds(weights)
        room = rounded_down(1 - defect * SLACK)
        rounded = [rounded_up(x * SLACK) for x in terms]
        return Growth(tuple(rounded), room, rounded_up(turning * SLACK))

    def bounds(self, weights: Sequence[Any]) -> tuple[list[Any], Any, Any]:
        """Residual, frame and curvatures; of 1 - L M; of the frame that turns with a tangent."""
        tangents, others = weights[: self.s], weights[self.s :]
        each = [w * n for w, n in zip(others, self.images, strict=True)]
        drift = [dot(row, others) for row in self.twist]
        turned = [[dot(row, each) for row in rows] for rows in self.turned]
        by_drift = [dot(drift, column) for column in zip(*turned, strict=True)]
        by_tangent = [dot(tangents, column) for column in zip(*turned, strict=True)]
        curvatures = [self._curvature(power, each) for power in range(2, self.degree + 1)]
        curvatures[0] = [a + b for a, b in zip(curvatures[0], by_drift, strict=True)]
        linear = [dot(row, each) for row in self.left]
        identity = [dot(row, [*weights, *others[self.s :]]) for row in self.identity]
        terms = [largest(row, weights) for row in (self.residual, linear, *curvatures)]
        return terms, largest(identity, weights), largest(by_tangent, weights)

    def in_doubles(self) -> Norms:
        """The same, rounded: for choices."""
        rounded = {field.name: doubles(getattr(self, field.name)) for field in fields(self)}
        return replace(self, **rounded)

    @property
    def degree(self) -> int:
        """The highest power of r in V'."""
        return max(self.couplings, default=2)

    def reach(self, weights: Sequence[Fraction]) -> Row:
        """Stretches of bonds at distance 1."""
        return self._summed(self.stretches, weights)

    def speed(self, weights: Sequence[Fraction]) -> Row:
        """Momenta of particles at distance 1."""
        return self._summed(self.momenta, weights)

    def drift(self, weights: Sequence[Fraction]) -> Row:
        """Rates of the angles at distance 1, without that of the tangents."""
        return [dot(row, weights[self.s :]) for row in self.twist]

    def _summed(self, table: list[Row], weights: Sequence[Fraction]) -> Row:
        each = [w * n for w, n in zip(weights[self.s :], self.images, strict=True)]
        return [dot(column, each) for column in zip(*table, strict=True)]

    def _curvature(self, power: int, each: Row) -> Row:
        """Of the force, its part of that power, by row."""
        reach = [dot(column, each) for column in zip(*self.stretches, strict=True)]
        bonds = [
            h**power * taylor(self.couplings, r, power)
            for h, r in zip(reach, self.lengths, strict=True)
        ]
        return [dot(row, bonds) for row in self.bonds]


def taylor(couplings: dict[int, Fraction], r: Fraction, power: int) -> Fraction:
    """sum_k |c_k| binomial(k, power) r^(k - power)."""
    pairs = ((k, c) for k, c in couplings.items() if k >= power)
    return Fraction(sum(c * math.comb(k, power) * r ** (k - power) for k, c in pairs))


def largest(row: Sequence[Fraction], weights: Sequence[Fraction]) -> Fraction:
    """The largest of a row over its weight."""
    return max(x / w for x, w in zip(row, weights, strict=True))


def norms(torus: RoundedTorus, directions: Sequence[Direction], residual: Row) -> Norms:
    """All that the theorem asks of a torus, its residual by particle, and its directions."""
    s = len(torus.seeds)
    frame = Frame(torus, directions)
    inverse = Inverse(frame)
    by_x, by_y = inverse.rows()
    of_x = [norms_of(row) for row in by_x]
    of_y = [norms_of(row) for row in by_y]
    fine = torus.stretches(PLACES)
    terms = {k - 1: k * c for k, c in torus.couplings.items()}
    slopes = [polynomial_of(r, terms) for r in fine]
    left = [frame.left(d, slopes) for d in directions]
    turned = [
        [[_image(x, y, c) for c in columns] for x, y in zip(of_x, of_y, strict=True)]
        for columns in frame.turned
    ]
    return Norms(
        s=s,
        images=[1 if d.twist else 2 for d in directions],
        residual=[dot(row, residual) for row in of_y],
        left=[[dot(row, column) for column in left] for row in of_y],
        bonds=[norms_of(stretches_of(row)) for row in by_y],
        stretches=[norms_of(stretches_of(c.x)) for c in frame.others],
        momenta=[norms_of(c.y) for c in frame.others],
        turned=turned,
        identity=identity_norms(inverse),
        twist=[[abs(x) for x in row] for row in _twist(directions, s)],
        lengths=norms_of(fine),
        couplings={k: abs(c) for k, c in torus.couplings.items()},
    )


def _image(x: Row, y: Row, column: Column) -> Fraction:
    return Fraction(dot(x, norms_of(column.x)) + dot(y, norms_of(column.y)))


def _twist(directions: Sequence[Direction], s: int) -> Iterator[list[Fraction]]:
    for m in range(s):
        yield [d.twist[m] if d.twist else Fraction(0) for d in directions]


def doubles(value: Any) -> Any:
    """Fractions in lists and tables as doubles; whole numbers as they are."""
    if isinstance(value, dict):
        return {key: doubles(x) for key, x in value.items()}
    if isinstance(value, list):
        return [doubles(x) for x in value]
    return float(value) if isinstance(value, Fraction) else value


def weights_of(found: Norms) -> tuple[Fraction, ...]:
    """Weights that let residual times curvature be nearly least: powers of 2, one by one."""
    rounded = found.in_doubles()
    exponents = [0] * (found.s + len(found.images))
    best = cost(rounded, exponents)
    for _ in range(SWEEPS):
        before = best
        for place in range(len(exponents)):
            best = improved(rounded, exponents, place, best)
        if best == before:
            break
    least = min(exponents)
    return tuple(Fraction(2) ** (e - least) for e in exponents)


def improved(found: Norms, exponents: list[int], place: int, best: float) -> float:
    """The cost with one exponent changed by 1 where that lowers it."""
    for step in (1, -1):
        exponents[place] += step
        tried = cost(found, exponents)
        if tried < best:
            return tried
        exponents[place] -= step
    return best


def cost(found: Norms, exponents: Sequence[int]) -> float:
    """Residual times curvature; infinite where the inverse has little room."""
    terms, defect, _ = found.bounds([2.0**e for e in exponents])
    room = 1 - float(defect)
    if room <= LEAST_ROOM:
        return math.inf
    return float(terms[0] * terms[2]) / room**2
