"""The columns of a frame, and what they leave of the linearised equations."""

from fractions import Fraction
from typing import NamedTuple

from symfpu.checkers.torus.claim import Claim, Direction
from symfpu.checkers.torus.residual import forces, polynomial, stretches
from symfpu.checkers.torus.series import (
    Row,
    Series,
    combined,
    derivative,
    mirrored,
    product,
    shifted,
    turned,
)

SPARE = 12  # places of the frame beyond its own


class Column(NamedTuple):
    """x and y of all particles, y = (rate + nu.omega) x + twist."""

    x: list[Series]
    y: list[Series]


class Frame:
    """Columns: tangents E_m = nu_m x of the torus, then the directions; and their derivatives."""

    def __init__(self, claim: Claim, directions: list[Direction]) -> None:
        self.claim, self.directions = claim, directions
        self.places = directions[0].x[0].places + SPARE
        tangents = range(claim.angles)
        still = Fraction(0)
        self.tangents = [
            self.column(Direction(still, [], self.by(claim.torus, m))) for m in tangents
        ]
        self.others = [self.column(d) for d in directions]
        self.turned = [[self.column(d, m) for d in directions] for m in tangents]

    def by(self, particles: list[Series], *angles: int) -> list[Series]:
        """Derivatives by angles."""
        for m in angles:
            particles = [derivative(x, m) for x in particles]
        return particles

    def column(self, d: Direction, *angles: int) -> Column:
        """Of a direction, or of its derivative by an angle."""
        x = self.by(d.x, *angles)
        fine = [shifted(series, max(series.places, self.places)) for series in x]
        y = [
            turned(series, self.claim.omega, d.rate, 1, self.claim.budget)
            for series in fine
        ]
        parts = [[(Fraction(1), shifted(series, self.places))] for series in y]
        for m, twist in enumerate(d.twist):
            for part, series in zip(
                parts, self.by(self.claim.torus, m, *angles), strict=True
            ):
                part.append((twist, shifted(series, self.places)))
        rounded = [shifted(series, self.places) for series in x]
        return Column(rounded, [combined(part) for part in parts])

    def left(self) -> list[Row]:
        """Norms of F'(X) x + (rate + nu.omega)^2 x + 2 twist (nu.omega) nu X, by direction."""
        bonds = stretches([shifted(x, self.places) for x in self.claim.torus])
        terms = {k - 1: k * c for k, c in self.claim.couplings.items()}
        slopes = [polynomial(r, terms, self.claim.budget) for r in bonds]
        return [self.left_by(d, slopes) for d in self.directions]

    def left_by(self, d: Direction, slopes: list[Series]) -> Row:
        """The same of one direction, by particle."""
        fine = [shifted(x, self.places) for x in d.x]
        pairs = zip(stretches(fine), slopes, strict=True)
        pushed = forces(
            [combined([(1, r), (1, product(g, r, self.claim.budget))]) for r, g in pairs]
        )
        norms = []
        for j, x in enumerate(fine):
            parts = [(Fraction(1), pushed[j])]
            parts.append(
                (Fraction(1), turned(x, self.claim.omega, d.rate, 2, self.claim.budget))
            )
            for tangent, twist in zip(self.tangents, d.twist, strict=False):
                parts.append((2 * twist, tangent.y[j]))
            norms.append(combined(parts).norm)
        return norms


def conjugate(column: Column) -> Column:
    """Of a normal direction: at -theta, y with the opposite sign."""
    return Column([mirrored(x, 1) for x in column.x], [mirrored(y, -1) for y in column.y])
