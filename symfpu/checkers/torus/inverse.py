"""The approximate inverse of a frame, and how far it is from one."""

from fractions import Fraction

from symfpu.checkers.reading import need
from symfpu.checkers.torus.frame import Column, Frame, conjugate
from symfpu.checkers.torus.residual import stretches
from symfpu.checkers.torus.series import (
    Harmonic,
    Packing,
    Row,
    Series,
    mirrored,
    shifted,
)

COARSE = 20  # places of the frame where its inverse is bounded
INVERSE_PLACES = 40


class Inverse:
    """Rows <c*, .> / <c*, c> with partners c*, <a, b> = sum x^a y^b - y^a x^b; any rows will do.

    partners : cut to COARSE places; that is part of the choice, so they have no error.
    """

    def __init__(self, frame: Frame) -> None:
        s, normal = frame.claim.angles, frame.others[frame.claim.angles :]
        self.frame = frame
        self.columns = [*frame.tangents, *frame.others]
        partners = [*frame.others[:s], *frame.tangents, *map(conjugate, normal)]
        pairs = zip(partners, self.columns, strict=True)
        self.factors = [reciprocal(mean_product(a, b)) for a, b in pairs]
        self.partners = [Column(*map(self.cut, column)) for column in partners]

    def cut(self, part: list[Series]) -> list[Series]:
        return [shifted(series, COARSE)._replace(error=0) for series in part]

    def row_norms(self) -> tuple[list[Row], list[Row], list[Row]]:
        """Of what multiplies x, of what multiplies y, of differences of the latter, by bond."""
        by_x, by_y, by_bond = [], [], []
        for factor, partner in zip(self.factors, self.partners, strict=True):
            by_x.append([abs(factor) * y.norm for y in partner.y])
            by_y.append([abs(factor) * x.norm for x in partner.x])
            by_bond.append([abs(factor) * r.norm for r in stretches(partner.x)])
        return by_x, by_y, by_bond

    def identity(self) -> list[Row]:
        """Norms of the entries of 1 - L M: tangents, directions, conjugates of normal ones."""
        s = self.frame.claim.angles
        columns = [*self.columns, *map(conjugate, self.columns[2 * s :])]
        cut = [[shifted(x, COARSE) for x in (*c.y, *c.x)] for c in columns]
        rows = [[*p.x, *(mirror_sign(y) for y in p.y)] for p in self.partners]
        packing = Packing([x for entry in (*rows, *cut) for x in entry], len(rows[0]))
        packing.check_places()
        self.frame.claim.budget.spend(len(rows) * len(cut) * len(rows[0]) * packing.steps)
        packed = [[packing.packed(x) for x in column] for column in cut]
        found = []
        for i, (factor, row) in enumerate(zip(self.factors, rows, strict=True)):
            left = [packing.packed(x) for x in row]
            sizes = [x.size for x in row]
            norms = []
            for j, column in enumerate(packed):
                entry = packing.unpacked(sum(map(int.__mul__, left, column)))
                off = sum(map(int.__mul__, sizes, (x.error for x in cut[j])))
                norms.append(entry_norm(entry, factor, i == j, off))
            found.append(norms)
        return found


def mirror_sign(series: Series) -> Series:
    """With the opposite sign."""
    return series._replace(values={nu: -x for nu, x in series.values.items()})


def entry_norm(
    entry: dict[Harmonic, int], factor: Fraction, diagonal: bool, off: int
) -> Fraction:
    """Of 1 - factor entry, or of factor entry; units of 2^-(2 COARSE)."""
    unit = 1 << (2 * COARSE)
    middle = sum(x for nu, x in entry.items() if not any(nu))
    others = sum(abs(x) for nu, x in entry.items() if any(nu)) + off
    return abs(diagonal - factor * Fraction(middle, unit)) + abs(factor) * Fraction(
        others, unit
    )


def mean_product(a: Column, b: Column) -> Fraction:
    """The mean of <a, b>, nearly."""
    total = 0
    for x, y, u, v in zip(a.x, a.y, b.x, b.y, strict=True):
        total += mean(x, v) - mean(y, u)
    return Fraction(total, 1 << (2 * a.x[0].places))


def mean(one: Series, other: Series) -> int:
    """sum a[nu] b[-nu]."""
    opposite = mirrored(other, 1).values
    return sum(x * opposite.get(nu, 0) for nu, x in one.values.items())


def reciprocal(x: Fraction) -> Fraction:
    """1/x, to INVERSE_PLACES places."""
    need(x != 0, "a direction of the frame has no partner")
    return Fraction(round(2**INVERSE_PLACES / x), 2**INVERSE_PLACES)
