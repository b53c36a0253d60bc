"""Independent checker of certificates of tori: Python integers and fractions alone.

A certificate names a chain, frequencies and finitely many numbers x_j[nu]; the first claim is how
well the torus of these numbers solves the equations of motion, at all angles. If it names a frame
beside it, the second is how near to the torus an orbit stays that starts on it, and for how long.
docs/tori-proofs.md states the theorems and proves them; here every bound is computed anew, each
in a function, in the order of `check_certificate`.

A series is sum a[nu] exp(i nu.theta) with real a[nu], integers times 2^-places, and a bound of
what it is off by in the norm sum |a[nu]|, in units of the last place. With p = i y a state of the
chain has real series x_j, y_j. Bounds are rounded up. The file shares no code with the prover and
imports nothing but the standard library and what checkers read and round with.
"""

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.proofs.reading import (
    MOST_BITS,
    Json,
    Kind,
    dyadic,
    fraction,
    need,
    read_kind,
    verified,
    whole,
)
from symfpu.proofs.rounding import scientific, up

FORMAT = "symfpu torus certificate"
KEYS = {
    "format", "schema", "N", "coefficients", "seeds", "omega", "bits", "torus", "residual",
    "frame_bits", "rate_bits", "directions", "weights", "stay", "digest",
}  # fmt: skip
KIND = Kind(FORMAT, 1, KEYS, largest_file=2**28)
LARGEST_N, MOST_ANGLES = 128, 4
MOST_HARMONICS, HIGHEST_HARMONIC = 300_000, 2000
MOST_PLACES = 8_000_000  # of the box of a product
HIGHEST_DEGREE = 40
GUARD = 40  # places of the residual beyond those of the torus
SPARE = 12  # places of the frame beyond its own
COARSE = 20  # places of the frame where its inverse is bounded
INVERSE_PLACES = 40
RATIO = Fraction(63, 64)  # of neighbouring nodes of an integral
NODE_BITS = 64
MOST_NODES = 20_000

Harmonic = tuple[int, ...]
Row = list[Fraction]


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]


def read_certificate(path: Path) -> Json:
    """A certificate from its file."""
    return read_kind(path, KIND)


# --- series


class Series(NamedTuple):
    """values : integers by harmonic, in units of 2^-places. error : of the norm, in units."""

    values: dict[Harmonic, int]
    places: int
    error: int = 0

    @property
    def size(self) -> int:
        """Above the norm, in units."""
        return sum(map(abs, self.values.values())) + self.error

    @property
    def norm(self) -> Fraction:
        """Above the norm."""
        return Fraction(self.size, 1 << self.places)


def combined(terms: Iterable[tuple[Fraction | int, Series]]) -> Series:
    """sum factor series, of series with the same places; a factor that is no integer rounds."""
    total: dict[Harmonic, int] = {}
    error, places = 0, 0
    for factor, series in terms:
        top, bottom = factor.numerator, factor.denominator
        places = series.places
        for nu, x in series.values.items():
            total[nu] = total.get(nu, 0) + x * top // bottom
        error += up(series.error * abs(Fraction(factor)))
        error += len(series.values) if bottom > 1 else 0
    return Series(total, places, error)


def shifted(series: Series, places: int) -> Series:
    """With other places, rounded to nearest; what is zero then is left out."""
    shift = series.places - places
    if shift <= 0:
        values = {nu: x << -shift for nu, x in series.values.items()}
        return Series(values, places, series.error << -shift)
    half, values, lost = 1 << (shift - 1), {}, series.error
    for nu, x in series.values.items():
        near = (x + half) >> shift
        lost += abs(x - (near << shift))
        if near:
            values[nu] = near
    return Series(values, places, up(Fraction(lost, 1 << shift)))


def derivative(series: Series, m: int) -> Series:
    """nu_m a[nu]; of series without error."""
    need(not series.error, "a derivative of an error has no bound")
    return series._replace(values={nu: nu[m] * x for nu, x in series.values.items()})


def turned(series: Series, omega: Row, rate: Fraction, power: int) -> Series:
    """(rate + nu.omega)^power a[nu], rounded down; of series without error."""
    need(not series.error, "a derivative of an error has no bound")
    values = {}
    for nu, x in series.values.items():
        factor = (rate + sum(n * w for n, w in zip(nu, omega, strict=True))) ** power
        values[nu] = x * factor.numerator // factor.denominator
    return Series(values, series.places, len(values))


def mirrored(series: Series, sign: int) -> Series:
    """sign a[-nu]."""
    values = {tuple(-n for n in nu): sign * x for nu, x in series.values.items()}
    return series._replace(values=values)


def product(a: Series, b: Series) -> Series:
    """With the places of both, exact products rounded once."""
    if not a.values or not b.values:
        return Series({}, a.places, up(Fraction(a.size * b.size, 1 << a.places)))
    packing = Packing([a, b], 1)
    values = packing.unpacked(packing.packed(a) * packing.packed(b))
    error = a.size * b.error + (b.size - b.error) * a.error
    return shifted(Series(values, a.places + b.places, error), a.places)


class Packing:
    """Sums of products of series as those of single integers, by Kronecker's substitution.

    Box of twice the highest harmonics of all; a coefficient of a sum of `terms` products fits
    into its bytes with its sign.
    """

    def __init__(self, every: Sequence[Series], terms: int) -> None:
        harmonics = [nu for series in every for nu in series.values]
        highest = [max(map(abs, column)) for column in zip(*harmonics, strict=True)]
        self.lengths = [4 * m + 1 for m in highest]
        self.count = math.prod(self.lengths)
        need(self.count <= MOST_PLACES, "a product has too many harmonics")
        self.highest = highest
        largest = max(series.size for series in every)
        self.width = (2 * largest.bit_length() + terms.bit_length() + 2) // 8 + 1

    def packed(self, series: Series) -> int:
        """Sum of x 2^(8 width place), the place of -highest being 0."""
        plus, minus = bytearray(self.width * self.count), bytearray(self.width * self.count)
        for nu, x in series.values.items():
            place = 0
            for n, m, length in zip(nu, self.highest, self.lengths, strict=True):
                place = place * length + n + m
            start = place * self.width
            side = plus if x > 0 else minus
            side[start : start + self.width] = abs(x).to_bytes(self.width, "little")
        return int.from_bytes(plus, "little") - int.from_bytes(minus, "little")

    def unpacked(self, number: int) -> dict[Harmonic, int]:
        """The coefficients of a sum of products, those that are not zero."""
        width, zero = self.width, b"\0" * (self.width - 1) + b"\x80"
        bias = int.from_bytes(zero * self.count, "little")
        digits = (number + bias).to_bytes(width * (self.count + 1), "little")
        half, values = 1 << (8 * width - 1), {}
        for place in range(self.count):
            digit = digits[place * width : (place + 1) * width]
            if digit != zero:
                values[self.harmonic(place)] = int.from_bytes(digit, "little") - half
        return values

    def harmonic(self, place: int) -> Harmonic:
        """Of a place of a product."""
        nu = []
        for m, length in zip(reversed(self.highest), reversed(self.lengths), strict=True):
            place, at = divmod(place, length)
            nu.append(at - 2 * m)
        return tuple(reversed(nu))


def dot(one: Sequence[Fraction], other: Sequence[Fraction]) -> Fraction:
    """sum a b."""
    return sum((a * b for a, b in zip(one, other, strict=True)), Fraction(0))


# --- the claim


class Claim(NamedTuple):
    """What the theorems are about: a chain, frequencies, a torus by particle 1 .. N-1.

    couplings : of V'(r) - r by power of r.
    """

    N: int
    couplings: dict[int, Fraction]
    seeds: list[int]
    omega: Row
    torus: list[Series]

    @property
    def angles(self) -> int:
        return len(self.seeds)


class Direction(NamedTuple):
    """x of a column of the frame with its rate sigma; twist : (domega), () of normal ones."""

    rate: Fraction
    twist: Row
    x: list[Series]


def read_claim(data: Json) -> Claim:
    """The claim, its sizes bounded."""
    N = whole(data["N"], 3, LARGEST_N, "N")
    couplings = read_couplings(data["coefficients"])
    seeds, rates = data["seeds"], data["omega"]
    whole(len(seeds), 1, min(MOST_ANGLES, N - 1), "the number of seeds")
    need(len(set(seeds)) == len(seeds) == len(rates), "as many frequencies as seeds")
    for q in seeds:
        whole(q, 1, N - 1, "a seed")
    omega = [fraction(w, "omega") for w in rates]
    need(all(w > 0 for w in omega), "a frequency is not positive")
    bits = whole(data["bits"], 1, MOST_BITS, "bits")
    torus = read_series(data["torus"], bits, N, seeds, parity=0, even=True)
    check_angles(torus, len(seeds))
    return Claim(N, couplings, list(seeds), omega, torus)


def check_angles(torus: list[Series], count: int) -> None:
    """Every angle moves a particle by a harmonic of its own: no point, and no torus of fewer."""
    for m in range(count):
        own = tuple(int(i == m) for i in range(count))
        need(any(x.values.get(own) for x in torus), f"nothing moves with the angle {m + 1}")


def read_couplings(texts: Any) -> dict[int, Fraction]:
    """V'(r) - r = c_3 r^2 + c_4 r^3 + ..., by power of r."""
    need(type(texts) is list and 0 < len(texts) <= HIGHEST_DEGREE, "wrong coefficients")
    values = [fraction(text, "a coefficient of V") for text in texts]
    need(any(values), "the chain is harmonic")
    return {k: c for k, c in enumerate(values, 2) if c}


def read_series(
    rows: Any, bits: int, N: int, seeds: list[int], *, parity: int, even: bool
) -> list[Series]:
    """x_1 .. x_(N-1) of rows [nu, x_1 .. x_(N//2)]; the other particles by reflection.

    even : of cosines, from half of the harmonics.
    """
    whole(len(rows), 1, MOST_HARMONICS, "the number of harmonics")
    s, particles = len(seeds), [Series({}, bits) for _ in range(N - 1)]
    for row in rows:
        need(type(row) is list and len(row) == s + N // 2, "wrong length of a harmonic")
        nu = tuple(whole(n, -HIGHEST_HARMONIC, HIGHEST_HARMONIC, "nu") for n in row[:s])
        half = [whole(x, -(2**MOST_BITS), 2**MOST_BITS, "a coefficient") for x in row[s:]]
        sign = reflection(nu, seeds, parity)
        need(N % 2 or sign > 0 or not half[-1], "the middle particle breaks the symmetry")
        every = [*half, *(sign * x for x in reversed(half[: (N - 1) // 2]))]
        for at in {nu, tuple(-n for n in nu)} if even else {nu}:
            need(at not in particles[0].values, "a harmonic is there twice")
            for series, x in zip(particles, every, strict=True):
                series.values[at] = x
    return particles


def reflection(nu: Harmonic, seeds: list[int], parity: int) -> int:
    """x_(N-j) = +-x_j: all modes of a harmonic are odd, or all are even."""
    modes = sum(n * q for n, q in zip(nu, seeds, strict=True)) + parity
    return 1 if modes % 2 else -1


def read_directions(data: Json, claim: Claim) -> list[Direction]:
    """s directions of the actions, and N-1-s normal ones."""
    entries, s = data["directions"], claim.angles
    need(len(entries) == claim.N - 1, "there are not N - 1 directions")
    bits = whole(data["frame_bits"], 1, 256, "frame_bits")
    unit = 1 << whole(data["rate_bits"], 1, 256, "rate_bits")
    found = []
    for i, (mode, rate, twist, rows) in enumerate(entries):
        even = i < s
        need(type(twist) is list and len(twist) == (s if even else 0), "wrong twist")
        need(not even or rate == 0, "a direction of an action has a frequency")
        turns = [whole(x, -(2**300), 2**300, "the twist") for x in twist]
        parity = 0 if even else whole(mode, 1, claim.N - 1, "a mode")
        x = read_series(rows, bits, claim.N, claim.seeds, parity=parity, even=even)
        sigma = Fraction(whole(rate, -(2**300), 2**300, "a rate"), unit)
        found.append(Direction(sigma, [Fraction(t, unit) for t in turns], x))
    return found


# --- the first theorem


def stretches(particles: Sequence[Series]) -> list[Series]:
    """r_j = x_(j+1) - x_j of the N bonds, j = 0 .. N-1."""
    still = Series({}, particles[0].places)
    ends = [still, *particles, still]
    return [combined([(1, b), (-1, a)]) for a, b in pairwise(ends)]


def forces(tensions: Sequence[Series]) -> list[Series]:
    """On the N-1 particles, of the tensions of bonds."""
    return [combined([(1, b), (-1, a)]) for a, b in pairwise(tensions)]


def polynomial(r: Series, terms: dict[int, Fraction]) -> Series:
    """sum terms[k] r^k, k >= 1."""
    power, parts = r, []
    for k in range(1, max(terms) + 1):
        power = power if k == 1 else product(power, r)
        if k in terms:
            parts.append((terms[k], power))
    return combined(parts)


def residuals(claim: Claim) -> Row:
    """Above |x_j'' - force| of every particle at all angles."""
    places = claim.torus[0].places + GUARD
    fine = [shifted(x, places) for x in claim.torus]
    terms = {1: Fraction(1), **claim.couplings}
    pushed = forces([polynomial(r, terms) for r in stretches(fine)])
    norms = []
    for x, force in zip(fine, pushed, strict=True):
        moved = turned(x, claim.omega, Fraction(0), 2)
        norms.append(combined([(-1, moved), (-1, force)]).norm)
    return norms


def check_residual(found: Row, stated: Fraction) -> None:
    """No particle's residual exceeds the stated one."""
    most = max(found)
    text = f"the residual may be {scientific(most)}, above {scientific(stated)}"
    need(most <= stated, text)


# --- the frame


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
        y = [turned(series, self.claim.omega, d.rate, 1) for series in fine]
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
        slopes = [polynomial(r, terms) for r in bonds]
        return [self.left_by(d, slopes) for d in self.directions]

    def left_by(self, d: Direction, slopes: list[Series]) -> Row:
        """The same of one direction, by particle."""
        fine = [shifted(x, self.places) for x in d.x]
        pairs = zip(stretches(fine), slopes, strict=True)
        pushed = forces([combined([(1, r), (1, product(g, r))]) for r, g in pairs])
        norms = []
        for j, x in enumerate(fine):
            parts = [(Fraction(1), pushed[j])]
            parts.append((Fraction(1), turned(x, self.claim.omega, d.rate, 2)))
            for tangent, twist in zip(self.tangents, d.twist, strict=False):
                parts.append((2 * twist, tangent.y[j]))
            norms.append(combined(parts).norm)
        return norms


def conjugate(column: Column) -> Column:
    """Of a normal direction: at -theta, y with the opposite sign."""
    return Column([mirrored(x, 1) for x in column.x], [mirrored(y, -1) for y in column.y])


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


# --- the second theorem


class Growth(NamedTuple):
    """d' <= (sum terms[k] d^k) / (room - turning d)."""

    terms: Row
    room: Fraction
    turning: Fraction

    def rate(self, d: Fraction) -> Fraction:
        """Rounded up; refused where the frame may be singular."""
        below = self.room - self.turning * d
        need(below > 0, "the frame may be singular within the stated distance")
        total = Fraction(0)
        for term in reversed(self.terms):
            total = total * d + term
        return -rounded_down(-total / below)


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


class Stay(NamedTuple):
    """What is stated: up to a time, a weighted distance and what follows from it."""

    time: Fraction
    d: Fraction
    distance: Fraction
    momentum: Fraction
    drift: Row


def read_stay(entry: Any, angles: int) -> Stay:
    """[time, d, distance, momentum, drift of every angle]."""
    time, d, distance, momentum, drift = entry
    long = fraction(time, "time")
    need(long > 0, "the time is not positive")
    need(type(drift) is list and len(drift) == angles, "not one drift an angle")
    return Stay(
        long,
        dyadic(d, "the weighted distance"),
        dyadic(distance, "the distance"),
        dyadic(momentum, "the distance of velocities"),
        [dyadic(x, "a drift") for x in drift],
    )


def read_weights(values: Any, count: int) -> Row:
    """Positive integers."""
    need(type(values) is list and len(values) == count, "not one weight a coordinate")
    return [Fraction(whole(w, 1, 2**64, "a weight")) for w in values]


def rounded_down(x: Fraction) -> Fraction:
    """With NODE_BITS bits or so."""
    places = NODE_BITS + x.denominator.bit_length() - abs(x.numerator).bit_length()
    places = max(places, 0)
    return Fraction((x.numerator << places) // x.denominator, 1 << places)


def time_to_grow(growth: Growth, d: Fraction) -> Fraction:
    """Below the integral of 1/rate from 0 to d: rate increases, each interval has its right end."""
    total, high = Fraction(0), d
    rate = growth.rate(high)
    for _ in range(MOST_NODES):
        low = rounded_down(high * RATIO)
        below = growth.rate(low)
        total += rounded_down((high - low) / rate)
        high, last, rate = low, rate, below
        if last - rate < last / 10**4:
            break
    return total + rounded_down(high / rate)


def check_time(growth: Growth, stay: Stay) -> None:
    """The weighted distance is not reached before the stated time."""
    long = time_to_grow(growth, stay.d)
    text = (
        f"the distance may be reached at {scientific(long)}, before {scientific(stay.time)}"
    )
    need(long >= stay.time, text)


def check_distance(bounds: Bounds, stay: Stay) -> None:
    """Stretches within the weighted distance."""
    most = max(bounds.reach()) * stay.d
    need(most <= stay.distance, f"stretches may differ by {scientific(most)}")


def check_momentum(bounds: Bounds, stay: Stay) -> None:
    """Velocities within the weighted distance."""
    most = max(bounds.speed()) * stay.d
    need(most <= stay.momentum, f"velocities may differ by {scientific(most)}")


def check_drift(bounds: Bounds, growth: Growth, stay: Stay) -> None:
    """|theta_m - phi_m - omega_m t| <= t (drift d + weight rate(d))."""
    rate = growth.rate(stay.d)
    pairs = zip(bounds.drift(), bounds.tangents, stay.drift, strict=True)
    for turn, weight, stated in pairs:
        most = stay.time * (turn * stay.d + weight * rate)
        need(most <= stated, f"an angle may drift by {scientific(most)}")


def check_stay(data: Json, claim: Claim, residual: Row) -> list[str]:
    """The hypotheses of the second theorem, and what it says."""
    stay = read_stay(data["stay"], claim.angles)
    directions = read_directions(data, claim)
    weights = read_weights(data["weights"], claim.angles + claim.N - 1)
    bounds = Bounds(Frame(claim, directions), residual, weights)
    growth = bounds.growth()
    check_time(growth, stay)
    check_distance(bounds, stay)
    check_momentum(bounds, stay)
    check_drift(bounds, growth, stay)
    drift, long = scientific(max(stay.drift)), scientific(stay.time, rounded=math.floor)
    terms = ", ".join(scientific(term) for term in growth.terms[:3])
    return [
        f"theorem: every orbit that starts on this torus stays, for {long} units "
        f"of time, within {scientific(stay.distance)} of it in all stretches and "
        f"{scientific(stay.momentum)} in all velocities, and the angles of the points it stays "
        f"near are within {drift} of phi + omega t",
        f"residual, frame and curvature in the frame: {terms}; 1 - |1 - LM| = "
        f"{float(growth.room):.4f}: recomputed with integers",
    ]


# --- the theorems


def check_certificate(data: Json) -> list[str]:
    """What has been proved, in sentences."""
    claim = read_claim(data)
    stated = dyadic(data["residual"], "residual")
    found = residuals(claim)
    check_residual(found, stated)
    lines = [residual_text(claim, data, stated)]
    if data["stay"]:
        return [*lines, *check_stay(data, claim, found)]
    empty = not (data["directions"] or data["weights"])
    need(empty and data["frame_bits"] == data["rate_bits"] == 0, "a frame without a claim")
    return lines


def residual_text(claim: Claim, data: Json, stated: Fraction) -> str:
    """The first theorem."""
    law = " + ".join(f"({c}) r^{k + 1}/{k + 1}" for k, c in claim.couplings.items())
    digits = [scientific(w, 12) for w in claim.omega]
    exact = list(map(Fraction, digits)) == claim.omega
    omega = ", ".join(digits) if exact else f"near {', '.join(digits)} (exact in it)"
    return (
        f"theorem: in the chain of N = {claim.N} bonds with fixed ends and V = r^2/2 + {law} the "
        f"torus of the certificate, {len(data['torus'])} harmonics of {claim.angles} angles with "
        f"frequencies {omega}, leaves |x'' - force| <= {scientific(stated)} of every particle at "
        f"all angles"
    )
