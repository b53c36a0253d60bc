"""The three bounds of the theorem: Y, Z0 + Z1 and Z2, computed anew."""

from fractions import Fraction

from symfpu.checkers.existence.bonds import COARSE, Bonds, Divisors
from symfpu.checkers.existence.claim import Claim, Place
from symfpu.checkers.existence.condition import condition_of
from symfpu.checkers.existence.fixed_point import (
    COSINE_UNITS,
    POWER_PLACES,
    Cosines,
    Series,
    rounded_up,
)
from symfpu.checkers.existence.inverse import BORDER, Inverse, Packed
from symfpu.checkers.reading import need
from symfpu.checkers.rounding import up

LARGEST_DERIVATIVE = 2**20  # an entry of DF that the packed product expects

Ends = tuple[int, int]  # below and above, COARSE places


class Bounds:
    """Y, Z0 + Z1 and Z2 of the theorem; COARSE places."""

    def __init__(self, claim: Claim, bonds: Bonds, inverse: Inverse) -> None:
        self.claim, self.bonds, self.inverse = claim, bonds, inverse
        self.unit, self.norm = 1 << COARSE, bonds.norm
        self.condition = condition_of(claim, bonds)
        self.divisors = Divisors(claim, Cosines(claim.N, COARSE), COARSE)
        self.check_beyond()
        self.read_slopes()
        self.couple()
        self.members = {place: i for i, place in enumerate(inverse.block)}
        self.norms = self.norms_of_columns()
        self.spread = self.largest_sum()

    def check_beyond(self) -> None:
        """Beyond `free` every harmonic is above all modes: |lambda| grows from there on."""
        for q in self.claim.shape.modes:
            _, high = self.divisors.between(self.inverse.free + 1, q)
            need(high < 0, f"harmonic {self.inverse.free + 1} is not above mode {q}")

    def read_slopes(self) -> None:
        """g_0, g_1/2, .. of every bond up to K, cut to COARSE places, and the norm of the rest."""
        K, drop = self.inverse.slope_harmonics, self.bonds.places - COARSE
        need(drop > 0, "the orbit has too few bits")
        norm, kept, rest = self.bonds.norm, [], 0
        for slope in self.bonds.slopes:
            halves = [x >> (drop + (k > 0)) for k, x in enumerate(slope.values[: K + 1])]
            whole_again = [(x << drop) * (2 if k else 1) for k, x in enumerate(halves)]
            left = list(slope.values)
            for k, x in enumerate(whole_again):
                left[k] -= x
            rest += norm.of(left) + slope.error
            kept.append(halves + [0] * (K + 1 - len(halves)))
        self.slopes = kept
        self.rest = (rest >> drop) + 1  # COARSE places

    def couple(self) -> None:
        """By harmonic k the coupling of modes q, q' is sums[k][|q - q'|] + sums[k][q + q'].

        It is (1/N) sum_j (cos((q-q') theta_j) + cos((q+q') theta_j)) g_j[k], off by `losses[k]`.
        """
        N, K = self.claim.N, self.inverse.slope_harmonics
        self.losses = [0] * (K + 1)
        if self.claim.shape.travelling:
            return
        cosines = Cosines(N, COARSE)
        tables = [[cosines.bond(p, j) for j in range(N)] for p in range(2 * N - 1)]
        self.sums = []
        for k in range(K + 1):
            column = [slope[k] for slope in self.slopes]
            row = []
            for table in tables:
                total = sum(x * g for x, g in zip(table, column, strict=True))
                row.append((total >> COARSE) // N)
            self.sums.append(row)
            size = sum(map(abs, column)) * COSINE_UNITS // N
            self.losses[k] = 2 * ((size >> COARSE) + 3)

    def coupling(self, k: int, q: int, p: int) -> int:
        """Of modes q and p by harmonic k of the slopes; of a wave that of its slope alone."""
        if self.claim.shape.travelling:
            return self.slopes[0][k]
        row = self.sums[k]
        return row[abs(q - p)] + row[q + p]

    def derivatives(self, column: Place) -> dict[Place, int]:
        """Derivatives by c_p[m] of the anharmonic force, rows without zeros."""
        m, p = column
        K = self.inverse.slope_harmonics
        found = {}
        for n in range(max(0, m - K), m + K + 1):
            near, far = abs(n - m), n + m
            for q in self.claim.allowed(n):
                value = self.coupling(near, q, p)
                if n and far <= K:
                    value += self.coupling(far, q, p)
                if value:
                    found[n, q] = value
        return found

    # norms of columns of A

    def weighted(self, place: Place) -> int:
        """w = v nu^n, rounded up, in units 2^-(weight_bits + POWER_PLACES)."""
        v = self.inverse.weights.get(place, 1 << self.inverse.weight_bits)
        return v * self.norm.powers[place[0]]

    def norms_of_columns(self) -> dict[Place, int]:
        """|A e| / nu^n by place, COARSE places, rounded up."""
        inverse = self.inverse
        found = {}
        for place in inverse.places:
            if place not in self.members:
                v = inverse.weights[place]
                size = self.divisors.size(*place)
                found[place] = (v << (2 * COARSE)) // (size << inverse.weight_bits) + 1
        weights = [self.weighted(place) for place in inverse.block]
        scale = inverse.bits + inverse.weight_bits
        for place, column in zip(
            inverse.block, zip(*inverse.rows, strict=True), strict=True
        ):
            total = sum(w * abs(a) for w, a in zip(weights, column, strict=True))
            below = self.norm.below[place[0]] << scale
            found[place] = (total << COARSE) // below + 1
        return found

    def largest_sum(self) -> int:
        """Above sum_q |A e_q[n]| / nu^n for every n."""
        last = self.inverse.last
        sums = [0] * (last + 1)
        for (n, q), size in self.norms.items():
            if (n, q) != BORDER:
                sums[n] += size
        shape = self.claim.shape
        beyond = shape.together([self.beyond(q) for q in shape.modes])
        return max([*sums, beyond])

    def beyond(self, q: int) -> int:
        """Above 1/|lambda_q[n]| for every n beyond `last`."""
        size = self.divisors.size(self.inverse.last + 1, q)
        return (self.unit * self.unit) // size + 1

    # the bounds

    def of_bonds(self, total: Fraction) -> Fraction:
        """Above |A share sum_j cos(q theta_j) f_j| where the norms of the f_j add up to total."""
        return self.claim.shape.share * Fraction(self.spread, self.unit) * total

    def residual(self) -> Fraction:
        """Y, above |A F| at every orbit of the line, of one orbit at that."""
        newton = self.image(self.bonds.forces, self.claim.orbit, 0)
        newton += self.of_condition(self.condition.residual)
        if not self.claim.half_width:
            return newton
        length = self.length()
        return newton + self.drift() + self.curvature(length) * length**2 / 2

    def drift(self) -> Fraction:
        """Above |A (DF t + dF/ds)|, t the direction of the line."""
        claim, bonds = self.claim, self.bonds
        stretches = bonds.on_bonds(claim.direction)
        pairs = zip(bonds.slopes, stretches, strict=True)
        products = [bonds.arithmetic.product(slope, t) for slope, t in pairs]
        moved = self.image(products, claim.direction, claim.of_frequency)
        return moved + self.of_condition(self.condition.along(claim, bonds))

    def length(self) -> Fraction:
        """Above the norm of the direction; 0 of one orbit."""
        claim, total = self.claim, 0
        for (n, q), x in claim.direction.items():
            total += abs(x) * self.weighted((n, q))
        if claim.of_frequency:
            total += abs(claim.of_frequency) * self.weighted(BORDER)
        scale = claim.bits + self.inverse.weight_bits + POWER_PLACES
        return Fraction(total, 1 << scale)

    def of_condition(self, size: Fraction) -> Fraction:
        """|A e| of the condition's row times a size; 0 where there is no condition."""
        return size * Fraction(self.norms.get(BORDER, 0), self.unit)

    def image(
        self, series: list[Series], coefficients: dict[Place, int], of_frequency: int
    ) -> Fraction:
        """Above |A f|, f the modes of the series + lambda times coefficients + D_m F of_frequency.

        coefficients, of_frequency : in units 2^-bits.
        """
        bonds, claim = self.bonds, self.claim
        divisors = Divisors(claim, bonds.cosines, bonds.places)
        factor = claim.unit * of_frequency / (1 << 2 * claim.bits)
        # series may end before the orbit does, as products are cut where they are small
        longest = max(claim.harmonics + 1, *(len(bond.values) for bond in series))
        total = 0
        for n in range(longest):
            forces = [f.values[n] if n < len(f.values) else 0 for f in series]
            size = up(sum(map(abs, forces)) * COSINE_UNITS * claim.shape.share)
            off = (size >> bonds.places) + 4
            of_harmonic = 0
            for q in claim.allowed(n):
                c = coefficients.get((n, q), 0)
                force = self.force_of_mode(q, forces)
                ends = [(x * c >> claim.bits) + force for x in divisors.between(n, q)]
                moved = divisors.of_unknown(n, q, factor * claim.orbit.get((n, q), 0))
                low, high = min(ends) + moved[0], max(ends) + moved[1]
                value = max(abs(low), abs(high)) + off
                norm = self.norms[n, q] if n <= self.inverse.last else self.beyond(q)
                of_harmonic += value * norm
            total += of_harmonic * self.norm.powers[n]
        unit = 1 << (bonds.places + COARSE + POWER_PLACES)
        errors = sum(bond.error for bond in series)
        return Fraction(total, unit) + self.of_bonds(Fraction(errors, 1 << bonds.places))

    def force_of_mode(self, q: int, forces: list[int]) -> int:
        """share sum_j cos(q theta_j) f_j of one harmonic, in units of the bonds."""
        cosines, shape = self.bonds.cosines, self.claim.shape
        total = sum(shape.on_bond(cosines, q, j) * f for j, f in enumerate(forces))
        return (total * shape.share).__floor__() >> self.bonds.places

    def linear(self) -> Fraction:
        """Z0 + Z1, above |I - A DF| at the orbit."""
        columns = max(self.of_columns(), self.of_tail() + self.of_condition_beyond())
        lost = sum(map(int.__mul__, self.losses, self.norm.powers))
        couplings = Fraction(2 * self.spread * lost, self.unit**2 << POWER_PLACES)
        return columns + couplings + self.of_bonds(Fraction(self.rest, self.unit))

    def of_columns(self) -> Fraction:
        """The largest column of |I - A DF| up to harmonic `last`, its slopes cut."""
        inverse = self.inverse
        highest = max(inverse.last + inverse.slope_harmonics, self.claim.harmonics)
        reached = [(n, q) for n in range(highest + 1) for q in self.claim.allowed(n)]
        factors = {}
        for place in reached:
            if place not in self.members:
                shifted = self.weighted(place) << COARSE
                factors[place] = shifted // self.divisors.size(*place) + 1
        packed = Packed(inverse.rows, LARGEST_DERIVATIVE << COARSE)
        weights = [self.weighted(place) for place in inverse.block]
        worst = Fraction(0)
        for column in inverse.places:
            entries = self.border_column() if column == BORDER else self.column(column)
            worst = max(worst, self.of_column(column, entries, factors, packed, weights))
        return worst

    def column(self, place: Place) -> dict[Place, Ends]:
        """Ends of the derivatives of F, and of the condition, by c_q[n]; slopes cut."""
        entries = {row: (x, x) for row, x in self.derivatives(place).items()}
        if place in self.members:
            low, high = self.divisors.between(*place)
            value, _ = entries.get(place, (0, 0))
            entries[place] = value + low, value + high
        if self.claim.bordered:
            entries[BORDER] = self.condition.by(*place, self.claim, self.bonds)
        return entries

    def border_column(self) -> dict[Place, Ends]:
        """Ends of the derivatives of F, and of the condition, by the unknown frequency."""
        claim = self.claim
        factor = claim.unit / (1 << claim.bits)
        entries = {
            (n, q): self.divisors.of_unknown(n, q, factor * c)
            for (n, q), c in claim.orbit.items()
        }
        corner = self.condition.corner << COARSE
        entries[BORDER] = corner, corner
        return entries

    def of_column(
        self,
        column: Place,
        entries: dict[Place, Ends],
        factors: dict[Place, int],
        packed: Packed,
        weights: list[int],
    ) -> Fraction:
        """|(I - A DF) e| over the weight of e; outside the block without the diagonal of DF."""
        inverse, outside, inside, lost = self.inverse, 0, {}, 0
        for place, (low, high) in entries.items():
            l = self.members.get(place)
            if l is None:
                outside += factors[place] * max(abs(low), abs(high))
                continue
            inside[l] = low
            lost += (high - low) * self.norms[place] * self.norm.powers[place[0]]
        product = packed.combination(inside)
        own = self.members.get(column)
        if own is not None:
            product[own] -= 1 << (inverse.bits + COARSE)
        of_block = sum(w * abs(x) for w, x in zip(weights, product, strict=True))
        weight = inverse.weights[column] * self.norm.below[column[0]]
        scale = inverse.bits + COARSE
        found = Fraction((outside << inverse.bits) + of_block, weight << scale)
        return found + Fraction(lost << inverse.weight_bits, weight << 2 * COARSE)

    def of_condition_beyond(self) -> Fraction:
        """What the condition adds to columns beyond `last`."""
        if not self.claim.bordered:
            return Fraction(0)
        return self.of_condition(self.condition.farthest(self.inverse.last + 1, self.bonds))

    def of_tail(self) -> Fraction:
        """The same for every column beyond `last`: it meets rows beyond `free` alone."""
        shape = self.claim.shape
        columns = shape.modes[:1] if shape.travelling else shape.modes  # one slope for all
        return max(
            shape.together([self.of_pair(q, p) for q in shape.modes]) for p in columns
        )

    def of_pair(self, q: int, p: int) -> Fraction:
        """Of a row of mode q and a column of mode p, beyond all that are taken one by one."""
        powers = self.norm.powers
        growths = [powers[0]] + [x + powers[0] for x in powers[1:]]
        sizes = (abs(self.coupling(k, q, p)) for k in range(len(self.losses)))
        weighted = sum(g * x for g, x in zip(growths, sizes, strict=False))
        divisor = self.divisors.size(self.inverse.free + 1, q)
        return Fraction(weighted, divisor << POWER_PLACES)

    def curvature(self, radius: Fraction) -> Fraction:
        """Z2, above |A (DF(x + b) - DF(x))| / |b| for |b| up to the radius."""
        claim = self.claim
        sizes = (rounded_up(size + radius, COARSE) for size in self.bonds.sizes)
        total = sum((claim.force.curvature_bound(x) for x in sizes), Fraction(0))
        if not claim.bordered:
            return self.of_bonds(total)
        of_condition = self.condition.curvature(claim, self.bonds, radius)
        return self.of_bonds(total) + self.of_condition(of_condition) + self.of_frequency()

    def of_frequency(self) -> Fraction:
        """Above |A D_m D_c F h| / (|m| |h|): |A e| / |e| n^2 unit / Omega_q^2, the largest."""
        inverse, worst = self.inverse, 0
        one = 1 << inverse.weight_bits
        for (n, q), norm in self.norms.items():
            if q:
                v = inverse.weights[n, q]
                size = norm * n * n * self.divisors.inverse_above[q] * one
                worst = max(worst, size // v + 1)
        n = inverse.last + 1  # beyond it n^2 / |lambda| falls
        for q in self.claim.shape.modes:
            size = self.beyond(q) * n * n * self.divisors.inverse_above[q]
            worst = max(worst, size)
        weight = Fraction(inverse.weights[BORDER], one)
        return self.claim.unit * Fraction(worst, self.unit**2) / weight
