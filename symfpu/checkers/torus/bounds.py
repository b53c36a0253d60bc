"""The norms that the second theorem asks for."""

import math
from fractions import Fraction

from symfpu.checkers.torus.frame import Frame
from symfpu.checkers.torus.growth import Growth
from symfpu.checkers.torus.inverse import Inverse
from symfpu.checkers.torus.residual import stretches
from symfpu.checkers.torus.series import Row, dot, shifted


class Bounds:
    """The norms that the theorem asks for; weights : of tangents, then of directions."""

    def __init__(self, frame: Frame, residual: Row, weights: Row) -> None:
        self.frame, self.claim = frame, frame.claim
        s = self.claim.angles
        self.weights = weights
        self.tangents, self.others = weights[:s], weights[s:]
        self.each = [w * (1 if i < s else 2) for i, w in enumerate(self.others)]
        self.inverse = Inverse(frame)
        self.by_x, self.by_y, self.by_bond = self.inverse.row_norms()
        self.residual = residual

    def growth(self) -> Growth:
        """Of the weighted distance max |v_c| / w_c."""
        drift, tangents = self.drift(), self.tangents
        turned = self.turnings()
        by_drift = [dot(drift, row) for row in turned]
        powers = range(2, max(self.claim.couplings) + 1)
        curvatures = [self.curvature(power) for power in powers]
        curvatures[0] = [a + b for a, b in zip(curvatures[0], by_drift, strict=True)]
        terms = [self.worst(row) for row in (self.forcing(), self.linear(), *curvatures)]
        turning = self.worst([dot(tangents, row) for row in turned])
        return Growth(terms, 1 - self.defect(), turning)

    def worst(self, row: Row) -> Fraction:
        """The largest over its weight."""
        return max(x / w for x, w in zip(row, self.weights, strict=True))

    def forcing(self) -> Row:
        """L R."""
        return [dot(row, self.residual) for row in self.by_y]

    def linear(self) -> Row:
        """L times what the directions leave of the linearised equations."""
        columns = zip(*self.frame.left(), strict=True)
        left = [dot(column, self.each) for column in columns]
        return [dot(row, left) for row in self.by_y]

    def curvature(self, power: int) -> Row:
        """L times the force beyond its linear part, its terms of that power of d."""
        bonds = []
        places = self.frame.places
        lengths = stretches([shifted(x, places) for x in self.claim.torus])
        for reach, r in zip(self.reach(), lengths, strict=True):
            parts = [
                abs(c) * math.comb(k, power) * r.norm ** (k - power)
                for k, c in self.claim.couplings.items()
                if k >= power
            ]
            bonds.append(reach**power * sum(parts, Fraction(0)))
        return [dot(row, bonds) for row in self.by_bond]

    def turnings(self) -> list[Row]:
        """L d_m Z, by row and angle."""
        found = []
        for x_row, y_row in zip(self.by_x, self.by_y, strict=True):
            angles = []
            for columns in self.frame.turned:
                images = [
                    dot(x_row, [x.norm for x in c.x]) + dot(y_row, [y.norm for y in c.y])
                    for c in columns
                ]
                angles.append(dot(images, self.each))
            found.append(angles)
        return found

    def defect(self) -> Fraction:
        """The norm of 1 - L M."""
        s = self.claim.angles
        every = [*self.weights, *self.others[s:]]
        return self.worst([dot(row, every) for row in self.inverse.identity()])

    def reach(self) -> Row:
        """Stretches of bonds at d = 1."""
        norms = [[r.norm for r in stretches(c.x)] for c in self.frame.others]
        return [dot(column, self.each) for column in zip(*norms, strict=True)]

    def speed(self) -> Row:
        """Velocities of particles at d = 1."""
        norms = [[y.norm for y in c.y] for c in self.frame.others]
        return [dot(column, self.each) for column in zip(*norms, strict=True)]

    def drift(self) -> Row:
        """Rates of the angles at d = 1, the directions of the actions alone."""
        s, directions = self.claim.angles, self.frame.directions
        return [
            dot([abs(d.twist[m]) for d in directions[:s]], self.others[:s])
            for m in range(s)
        ]
