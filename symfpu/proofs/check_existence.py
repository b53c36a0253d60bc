"""Independent checker of certificates of existence: Python integers and fractions alone.

A certificate names a chain, a frequency and finitely many numbers c_q[n]; the claim is that the
chain has a periodic orbit of that frequency near them. docs/existence.md states the theorem and
proves it; here its four bounds are computed anew, each in a function, in the order of `verify`.

Fixed point: a number is an integer times 2^-P, FINE places for the residual and COARSE for all
else. A series is its cosine coefficients and the bound of their error in the norm
sum |a_n| nu^n, in units of the last place. Bounds are rounded up, divisors down. The file shares
no code with the prover and imports nothing but the standard library.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

FORMAT = "symfpu existence certificate"
SCHEMA = 1
KEYS = {
    "format", "schema", "N", "coefficients", "seed", "omega", "nu", "bits", "orbit",
    "slope_harmonics", "free", "block", "inverse_bits", "inverse", "weight_bits", "weights",
    "radius", "unique", "amplitude", "energy", "digest",
}  # fmt: skip
LARGEST_FILE = 2**26  # bytes
LARGEST_N = 512
MOST_STEPS = 10**9
MOST_HARMONICS = 4096
MOST_BITS = 4096
MOST_BLOCK = 600
HIGHEST_DEGREE = 40
LONGEST_NUMBER = 2000  # characters
COARSE = 60  # places of everything but the residual
GUARD = 64  # places of the residual beyond those of the orbit
GUARD_OF_COSINES = 48
POWER_PLACES = 40  # of nu^n
LARGEST_DERIVATIVE = 2**20  # an entry of DF that the packed product expects
COSINE_UNITS = 2  # of the last place, more than a cosine is off
EXACT = re.compile(r"-?[0-9]+(/[1-9][0-9]*)?")
READING_ERRORS = (
    OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError,
    ZeroDivisionError, OverflowError,
)  # fmt: skip

Json = dict[str, Any]
Place = tuple[int, int]  # harmonic n, mode q


class ExistenceError(ValueError):
    """Why a certificate is refused, in one line."""


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises ExistenceError, with the reason, if it is not right.
    """
    try:
        return check_certificate(read_certificate(Path(path)))
    except ExistenceError:
        raise
    except READING_ERRORS as error:
        raise ExistenceError(f"no readable certificate: {error!r:.200}") from None


def need(condition: object, reason: str) -> None:
    """Refuse the certificate unless the condition holds."""
    if not condition:
        raise ExistenceError(reason)


# --- the file


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first; no floats, no booleans, no null."""
    small = path.is_file() and path.stat().st_size <= LARGEST_FILE
    need(small, "not a regular file of at most 64 MB")
    text = path.read_text("ascii", "replace")
    bare = re.sub(r'"[^"\\]*"', '"', text)  # without what stands in strings
    strange = re.search(r'[^\s0-9{}\[\],:"-]|[0-9]{1300}', bare)
    need(not strange, "not JSON of plain strings and integers of at most 1300 digits")
    data: Json = json.loads(text)
    need(bare.count(":") == len(KEYS), "a key is missing, unknown or there twice")
    need(set(data) == KEYS, "a key is missing, unknown or there twice")
    need(data["format"] == FORMAT, "not a certificate of existence")
    need(data["schema"] == SCHEMA, f"this checker supports schema {SCHEMA}")
    check_digest(data)
    return data


def check_digest(data: Json) -> None:
    """The digest is that of everything else."""
    contents = {key: data[key] for key in data if key != "digest"}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    digest = hashlib.sha256(text.encode()).hexdigest()
    need(data["digest"] == digest, "the digest is not that of the contents")


def whole(value: Any, least: int, most: int, name: str) -> int:
    """An integer in its range."""
    need(type(value) is int and least <= value <= most, f"{name} is not in {least}..{most}")
    return int(value)


def fraction(text: Any, name: str) -> Fraction:
    """An exact number as it is written."""
    readable = type(text) is str and len(text) <= LONGEST_NUMBER and EXACT.fullmatch(text)
    need(readable, f"{name} is no fraction")
    return Fraction(text)


# --- the claim


class Claim(NamedTuple):
    """What the theorem is about: a chain, a frequency, an orbit, a norm.

    couplings : of phi(r) = V'(r) - r by power of r. orbit : c_q[n] 2^bits by place, not zero.
    harmonics : the last n.
    """

    N: int
    couplings: dict[int, Fraction]
    seed: int
    omega: Fraction
    nu: Fraction
    bits: int
    orbit: dict[Place, int]
    harmonics: int

    @property
    def even(self) -> bool:
        """Whether V is even."""
        return all(k % 2 for k in self.couplings)

    def allowed(self, n: int) -> range:
        """The modes that the symmetry of the orbit leaves at a harmonic."""
        if self.even and n % 2 == 0:
            return range(0)
        return range(1 if n * self.seed % 2 else 2, self.N, 2)


def read_claim(data: Json) -> Claim:
    """The claim, its sizes bounded."""
    N = whole(data["N"], 2, LARGEST_N, "N")
    seed = whole(data["seed"], 1, N - 1, "seed")
    bits = whole(data["bits"], 1, MOST_BITS, "bits")
    couplings = read_couplings(data["coefficients"])
    omega, nu = fraction(data["omega"], "omega"), fraction(data["nu"], "nu")
    need(omega > 0, "omega is not positive")
    need(1 < nu <= 2, "nu is not in 1 < nu <= 2")
    need(nu.denominator <= 2**20, "nu has too large a denominator")
    rows = data["orbit"]
    whole(len(rows), 2, MOST_HARMONICS, "the number of harmonics")
    claim = Claim(N, couplings, seed, omega, nu, bits, {}, len(rows) - 1)
    for n, row in enumerate(rows):
        modes = claim.allowed(n)
        need(type(row) is list and len(row) == len(modes), f"wrong length of harmonic {n}")
        for q, value in zip(modes, row, strict=True):
            claim.orbit[n, q] = whole(value, -(2**4000), 2**4000, "a coefficient")
    need(claim.orbit.get((1, seed)), "the seed has no amplitude")
    return claim


def read_couplings(texts: Any) -> dict[int, Fraction]:
    """phi(r) = c_3 r^2 + c_4 r^3 + ..., by power of r."""
    need(type(texts) is list and 0 < len(texts) <= HIGHEST_DEGREE, "wrong coefficients")
    values = [fraction(text, "a coefficient of V") for text in texts]
    need(any(values), "the chain is harmonic")
    return {k: c for k, c in enumerate(values, 2) if c}


# --- cosines


class Cosines:
    """cos(k pi / 2N) in units of 2^-places, each off by less than COSINE_UNITS."""

    def __init__(self, N: int, places: int) -> None:
        w = places + GUARD_OF_COSINES
        pi = pi_times(w)
        self.N = N
        self.quarter = [
            cosine_of(pi * k // (2 * N), w) >> GUARD_OF_COSINES for k in range(N + 1)
        ]

    def of(self, k: int) -> int:
        """cos(k pi / 2N) for any k, by the symmetries of the cosine."""
        k %= 4 * self.N
        k = min(k, 4 * self.N - k)
        return self.quarter[k] if k <= self.N else -self.quarter[2 * self.N - k]

    def bond(self, q: int, j: int) -> int:
        """cos(q theta_j), theta_j = (j + 1/2) pi / N."""
        return self.of(q * (2 * j + 1))


def pi_times(places: int) -> int:
    """pi 2^places within a unit: Machin's 16 arctan 1/5 - 4 arctan 1/239."""
    w = places + 32
    return (16 * inverse_tangent(5, w) - 4 * inverse_tangent(239, w)) >> 32


def inverse_tangent(n: int, places: int) -> int:
    """arctan(1/n) 2^places, off by less than two units a term."""
    power, k, total = (1 << places) // n, 1, 0
    while power:
        total += power // k if k % 4 == 1 else -(power // k)
        power //= n * n
        k += 2
    return total


def cosine_of(angle: int, places: int) -> int:
    """The cosine of an angle up to pi/2 by its alternating series.

    A term is off by a few units, and by less from the third on as its factor is below 1/2: less
    than 2^40 units together, where the guard has 2^48.
    """
    one = 1 << places
    square = angle * angle >> places
    total, term, i = one, one, 0
    while term:
        i += 1
        term = (term * square >> places) // ((2 * i - 1) * (2 * i))
        total += -term if i % 2 else term
    return total


# --- series


class Series(NamedTuple):
    """Cosine coefficients a_0, a_1, .. and a bound of their error in the norm; units 2^-P."""

    values: list[int]
    error: int


class Norm:
    """sum |a_n| nu^n, rounded up.

    powers, below : nu^n rounded up and down to POWER_PLACES.
    """

    def __init__(self, nu: Fraction, harmonics: int) -> None:
        self.powers, self.below = [], []
        top, bottom = nu.numerator, nu.denominator
        value = least = 1 << POWER_PLACES
        for _ in range(harmonics + 1):
            self.powers.append(value)
            self.below.append(least)
            value, least = value * top // bottom + 1, least * top // bottom
        sums = 0
        self.sums = [0]
        for power in self.powers:
            sums += power
            self.sums.append(sums)

    def of(self, values: Iterable[int]) -> int:
        """In units of the values."""
        weighted = zip(values, self.powers, strict=False)
        return (sum(abs(a) * power for a, power in weighted) >> POWER_PLACES) + 1

    def units(self, length: int) -> int:
        """The norm of so many coefficients of one unit."""
        return (self.sums[length] >> POWER_PLACES) + 1


class FixedPoint:
    """Sums and products of series with P places."""

    def __init__(self, places: int, norm: Norm) -> None:
        self.places, self.norm = places, norm

    def product(self, a: Series, b: Series) -> Series:
        """2 cos i cos j = cos(i+j) + cos(i-j); rounded down once."""
        doubled = [0] * (len(a.values) + len(b.values) - 1)
        for i, x in enumerate(a.values):
            if x:
                for j, y in enumerate(b.values):
                    xy = x * y
                    doubled[i + j] += xy
                    doubled[abs(i - j)] += xy
        values = [x >> (self.places + 1) for x in doubled]
        sizes = self.norm.of(a.values), self.norm.of(b.values)
        crossed = sizes[0] * b.error + sizes[1] * a.error + a.error * b.error
        error = (crossed >> self.places) + 1 + self.norm.units(len(values))
        return Series(values, error)

    def combination(self, powers: dict[int, Series], terms: dict[int, Fraction]) -> Series:
        """sum terms[k] powers[k]."""
        values = [0] * max(len(powers[k].values) for k in terms)
        error = 0
        for k, c in terms.items():
            for n, x in enumerate(powers[k].values):
                values[n] += x * c.numerator // c.denominator
            error += up(powers[k].error * abs(c)) + self.norm.units(len(values))
        return Series(values, error)


def up(x: Fraction | int) -> int:
    """The least integer not below."""
    return -((-x.numerator) // x.denominator)


# --- the orbit on the bonds


class Bonds:
    """Stretches, forces and slopes of all bonds along the orbit, P = bits + GUARD places."""

    def __init__(self, claim: Claim, harmonics: int) -> None:
        self.claim, N = claim, claim.N
        self.places = claim.bits + GUARD
        degree = max(claim.couplings)
        self.norm = Norm(claim.nu, max(degree * claim.harmonics, harmonics) + 1)
        self.cosines = Cosines(N, self.places)
        self.arithmetic = FixedPoint(self.places, self.norm)
        self.stretches = [self.stretch(j) for j in range(N)]
        self.powers = [self.powers_of(series, degree) for series in self.stretches]
        terms, slopes = claim.couplings, {k - 1: k * c for k, c in claim.couplings.items()}
        self.forces = [self.arithmetic.combination(p, terms) for p in self.powers]
        self.slopes = [self.arithmetic.combination(p, slopes) for p in self.powers]

    def stretch(self, j: int) -> Series:
        """r_j = sum_q c_q cos(q theta_j): the c are exact, the cosines off by COSINE_UNITS."""
        claim = self.claim
        values, error = [], 0
        for n in range(claim.harmonics + 1):
            modes = claim.allowed(n)
            row = [claim.orbit[n, q] for q in modes]
            cosines = [self.cosines.bond(q, j) for q in modes]
            total = sum(c * x for c, x in zip(row, cosines, strict=True))
            values.append(total >> claim.bits)
            off = COSINE_UNITS * (sum(map(abs, row)) >> claim.bits) + COSINE_UNITS + 1
            error += off * self.norm.powers[n]
        return Series(values, (error >> POWER_PLACES) + 1)

    def powers_of(self, series: Series, highest: int) -> dict[int, Series]:
        """The powers 1 .. highest."""
        found = {1: series}
        for k in range(2, highest + 1):
            found[k] = self.arithmetic.product(found[k - 1], series)
        return found

    def bounds_of_norms(self) -> list[Fraction]:
        """Of every stretch."""
        unit = 1 << self.places
        return [Fraction(self.norm.of(s.values) + s.error, unit) for s in self.stretches]


class Divisors:
    """lambda_q[n] = 1 - n^2 omega^2 / Omega_q^2 between two integers, P places."""

    def __init__(self, claim: Claim, cosines: Cosines, places: int) -> None:
        squared = claim.omega**2
        self.one = 1 << places
        self.least, self.most = {}, {}
        for q in range(1, claim.N):
            linear = 2 * self.one - 2 * cosines.of(2 * q)  # Omega_q^2
            off = 2 * COSINE_UNITS
            need(linear > off, "places do not resolve Omega_1")
            above = squared * self.one**2
            self.least[q] = above // (linear + off)
            self.most[q] = above // (linear - off) + 1

    def between(self, n: int, q: int) -> tuple[int, int]:
        """Below and above lambda_q[n]."""
        return self.one - n * n * self.most[q], self.one - n * n * self.least[q]

    def size(self, n: int, q: int) -> int:
        """Below |lambda_q[n]|; refused where it may be zero."""
        low, high = self.between(n, q)
        need(low > 0 or high < 0, f"the divisor of mode {q}, harmonic {n} may be zero")
        return min(abs(low), abs(high))


# --- the approximate inverse and the weights


class Inverse(NamedTuple):
    """A: integers times 2^-bits on the block, 1/lambda elsewhere; and w = v nu^n.

    slope_harmonics : K. free : v is 1 beyond this harmonic. places : those up to free + K.
    weights : v 2^weight_bits of every place. block : the places of the block. rows : of A there.
    """

    slope_harmonics: int
    free: int
    places: list[Place]
    weight_bits: int
    weights: dict[Place, int]
    block: list[Place]
    bits: int
    rows: list[list[int]]

    @property
    def last(self) -> int:
        """The last harmonic whose columns are taken one by one."""
        return self.free + self.slope_harmonics


def read_inverse(data: Json, claim: Claim) -> Inverse:
    """The choices of the prover; any choice that meets the bounds proves the theorem."""
    K = whole(data["slope_harmonics"], 1, MOST_HARMONICS, "slope_harmonics")
    free = whole(data["free"], 1, MOST_HARMONICS, "free")
    weight_bits = whole(data["weight_bits"], 0, 64, "weight_bits")
    places = [(n, q) for n in range(free + K + 1) for q in claim.allowed(n)]
    weighed = [place for place in places if place[0] <= free]
    given = data["weights"]
    need(type(given) is list and len(given) == len(weighed), "wrong number of weights")
    weights = dict.fromkeys(places, 1 << weight_bits)
    for place, v in zip(weighed, given, strict=True):
        weights[place] = whole(v, 1 << weight_bits, 2**80, "a weight")
    block = [(n, q) for n, q in data["block"]]
    need(0 < len(block) <= MOST_BLOCK, "wrong size of the block")
    inside = block == sorted(set(block)) and set(block) <= set(weighed)
    need(inside, "the block is not of ascending places with weights")
    rows = data["inverse"]
    bits = whole(data["inverse_bits"], 0, 128, "inverse_bits")
    for row in rows:
        need(type(row) is list and len(row) == len(block), "the inverse is not square")
        for value in row:
            whole(value, -(2**128), 2**128, "an entry of the inverse")
    need(len(rows) == len(block), "the inverse is not square")
    return Inverse(K, free, places, weight_bits, weights, block, bits, rows)


class Packed:
    """The columns of an integer matrix, each one integer with a digit a row: a combination of
    columns then is a sum of products of two integers.
    """

    def __init__(self, rows: list[list[int]], largest_factor: int) -> None:
        self.count = len(rows)
        largest = max((abs(x) for row in rows for x in row), default=0)
        bits = (largest * largest_factor * self.count).bit_length() + 2
        self.width = (bits + 7) // 8  # bytes, so that no sum leaves its digit
        self.largest_factor = largest_factor
        self.columns = [self.packed(column) for column in zip(*rows, strict=True)]
        self.middle = 1 << (8 * self.width - 1)
        self.shift = self.packed([self.middle] * self.count)

    def packed(self, column: Iterable[int]) -> int:
        """sum of the entries times 256^(width i)."""
        return sum(x << (8 * self.width * i) for i, x in enumerate(column))

    def combination(self, factors: dict[int, int]) -> list[int]:
        """sum over columns l of factors[l] times the column."""
        need(
            all(abs(x) <= self.largest_factor for x in factors.values()),
            "a derivative is larger than its bound",
        )
        total = self.shift + sum(x * self.columns[l] for l, x in factors.items())
        digits = total.to_bytes(self.width * self.count, "little")
        starts = range(0, len(digits), self.width)
        parts = [digits[i : i + self.width] for i in starts]
        return [int.from_bytes(part, "little") - self.middle for part in parts]


class Bounds:
    """Y, Z0 + Z1 and Z2 of the theorem; COARSE places."""

    def __init__(self, claim: Claim, bonds: Bonds, inverse: Inverse) -> None:
        self.claim, self.bonds, self.inverse = claim, bonds, inverse
        self.unit, self.norm = 1 << COARSE, bonds.norm
        self.divisors = Divisors(claim, Cosines(claim.N, COARSE), COARSE)
        self.check_beyond()
        self.read_slopes()
        self.couple()
        self.members = {place: i for i, place in enumerate(inverse.block)}
        self.norms = self.norms_of_columns()
        self.spread = self.largest_sum()

    def check_beyond(self) -> None:
        """Beyond `free` every harmonic is above all modes: |lambda| grows from there on."""
        for q in range(1, self.claim.N):
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
        cosines = Cosines(N, COARSE)
        tables = [[cosines.bond(p, j) for j in range(N)] for p in range(2 * N - 1)]
        self.sums, self.losses = [], []
        for k in range(K + 1):
            column = [slope[k] for slope in self.slopes]
            row = []
            for table in tables:
                total = sum(x * g for x, g in zip(table, column, strict=True))
                row.append((total >> COARSE) // N)
            self.sums.append(row)
            size = sum(map(abs, column)) * COSINE_UNITS // N
            self.losses.append(2 * ((size >> COARSE) + 3))

    def coupling(self, k: int, q: int, p: int) -> int:
        """Of modes q and p by harmonic k of the slopes."""
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
        for (n, _), size in self.norms.items():
            sums[n] += size
        beyond = sum(self.beyond(q) for q in range(1, self.claim.N))
        return max([*sums, beyond])

    def beyond(self, q: int) -> int:
        """Above 1/|lambda_q[n]| for every n beyond `last`."""
        size = self.divisors.size(self.inverse.last + 1, q)
        return (self.unit * self.unit) // size + 1

    # the bounds

    def of_bonds(self, total: Fraction) -> Fraction:
        """Above |A (2/N) sum_j cos(q theta_j) f_j| where the norms of the f_j add up to total."""
        return Fraction(2 * self.spread, self.claim.N * self.unit) * total

    def residual(self) -> Fraction:
        """Y, above |A F| at the orbit."""
        bonds, claim = self.bonds, self.claim
        divisors = Divisors(claim, bonds.cosines, bonds.places)
        longest = max(len(force.values) for force in bonds.forces)
        total = 0
        for n in range(longest):
            forces = [f.values[n] if n < len(f.values) else 0 for f in bonds.forces]
            size = sum(map(abs, forces)) * COSINE_UNITS * 2 // claim.N
            off = (size >> bonds.places) + 4
            of_harmonic = 0
            for q in claim.allowed(n):
                c = claim.orbit.get((n, q), 0)
                force = self.force_of_mode(q, forces)
                ends = [(x * c >> claim.bits) + force for x in divisors.between(n, q)]
                value = max(map(abs, ends)) + off
                norm = self.norms[n, q] if n <= self.inverse.last else self.beyond(q)
                of_harmonic += value * norm
            total += of_harmonic * self.norm.powers[n]
        unit = 1 << (bonds.places + COARSE + POWER_PLACES)
        errors = sum(force.error for force in bonds.forces)
        return Fraction(total, unit) + self.of_bonds(Fraction(errors, 1 << bonds.places))

    def force_of_mode(self, q: int, forces: list[int]) -> int:
        """(2/N) sum_j cos(q theta_j) f_j of one harmonic, in units of the bonds."""
        cosines = self.bonds.cosines
        total = sum(cosines.bond(q, j) * f for j, f in enumerate(forces))
        return (2 * total // self.claim.N) >> self.bonds.places

    def linear(self) -> Fraction:
        """Z0 + Z1, above |I - A DF| at the orbit."""
        columns = max(self.of_columns(), self.of_tail())
        lost = sum(map(int.__mul__, self.losses, self.norm.powers))
        couplings = Fraction(2 * self.spread * lost, self.unit**2 << POWER_PLACES)
        return columns + couplings + self.of_bonds(Fraction(self.rest, self.unit))

    def of_columns(self) -> Fraction:
        """The largest column of |I - A DF| up to harmonic `last`, its slopes cut."""
        inverse = self.inverse
        rows = range(inverse.last + inverse.slope_harmonics + 1)
        reached = [(n, q) for n in rows for q in self.claim.allowed(n)]
        factors = {}
        for place in reached:
            if place not in self.members:
                shifted = self.weighted(place) << COARSE
                factors[place] = shifted // self.divisors.size(*place) + 1
        packed = Packed(inverse.rows, LARGEST_DERIVATIVE << COARSE)
        weights = [self.weighted(place) for place in inverse.block]
        worst = Fraction(0)
        for column in inverse.places:
            worst = max(worst, self.of_column(column, factors, packed, weights))
        return worst

    def of_column(
        self, column: Place, factors: dict[Place, int], packed: Packed, weights: list[int]
    ) -> Fraction:
        """|(I - A DF) e| over the weight of e."""
        inverse, outside, inside = self.inverse, 0, {}
        own, width = self.members.get(column), 0
        for place, value in self.derivatives(column).items():
            l = self.members.get(place)
            if l is None:
                outside += factors[place] * abs(value)
            else:
                inside[l] = value
        if own is not None:
            low, high = self.divisors.between(*column)
            inside[own] = inside.get(own, 0) + low
            width = high - low
        product = packed.combination(inside)
        if own is not None:
            product[own] -= 1 << (inverse.bits + COARSE)
        of_block = sum(w * abs(x) for w, x in zip(weights, product, strict=True))
        weight = inverse.weights[column] * self.norm.below[column[0]]
        found = Fraction(
            (outside << inverse.bits) + of_block, weight << inverse.bits + COARSE
        )
        return found + Fraction(width * self.norms[column], self.unit**2)

    def of_tail(self) -> Fraction:
        """The same for every column beyond `last`: it meets rows beyond `free` alone."""
        modes = range(1, self.claim.N)
        powers = self.norm.powers
        growths = [powers[0]] + [x + powers[0] for x in powers[1:]]
        worst = Fraction(0)
        for p in modes:
            total = Fraction(0)
            for q in modes:
                sizes = (abs(self.coupling(k, q, p)) for k in range(len(self.sums)))
                weighted = sum(g * x for g, x in zip(growths, sizes, strict=False))
                divisor = self.divisors.size(self.inverse.free + 1, q)
                total += Fraction(weighted, divisor << POWER_PLACES)
            worst = max(worst, total)
        return worst

    def curvature(self, radius: Fraction) -> Fraction:
        """Z2, above |A (DF(c + b) - DF(c))| / |b| for |b| up to the radius."""
        total = Fraction(0)
        for size in self.bonds.bounds_of_norms():
            x = rounded_up(size + radius)
            for k, c in self.claim.couplings.items():
                total += abs(c) * k * (k - 1) * x ** (k - 2)
        return self.of_bonds(total)


def rounded_up(x: Fraction) -> Fraction:
    """To COARSE places."""
    return Fraction(up(x * 2**COARSE), 2**COARSE)


# --- the theorem


def check_certificate(data: Json) -> list[str]:
    """The hypotheses of the theorem, and what it then says of the orbit."""
    claim = read_claim(data)
    inverse = read_inverse(data, claim)
    check_cost(claim, inverse)
    radius, unique = dyadic(data["radius"], "radius"), dyadic(data["unique"], "unique")
    highest = inverse.last + inverse.slope_harmonics
    bounds = Bounds(claim, Bonds(claim, highest), inverse)
    Y, linear = bounds.residual(), bounds.linear()
    check_contraction(bounds, Y, linear, radius, unique)
    check_amplitude(claim, bounds.bonds, data["amplitude"], radius)
    check_energy(claim, bounds.bonds, data["energy"], radius)
    return [
        theorem_text(claim, data, radius, unique),
        f"Y = {scientific(Y)}, Z0 + Z1 = {scientific(linear)}, "
        f"Z2 = {scientific(bounds.curvature(unique))}: recomputed with integers",
    ]


def check_cost(claim: Claim, inverse: Inverse) -> None:
    """Checking takes minutes at most: products of series, and entries of I - A DF."""
    products = claim.N * max(claim.couplings) ** 2 * claim.harmonics**2
    width = 2 * inverse.slope_harmonics + 1
    entries = (inverse.last + 1) * width * claim.N**2
    need(max(products, entries) <= MOST_STEPS, "checking it would take too many steps")


def check_contraction(
    bounds: Bounds, Y: Fraction, linear: Fraction, radius: Fraction, unique: Fraction
) -> None:
    """The map c - A F(c) takes the ball of the radius into itself and contracts the larger one."""
    need(radius <= unique, "the radius of existence is above that of uniqueness")
    rate = linear + bounds.curvature(unique) * unique
    need(rate < 1, f"Z0 + Z1 + Z2 R = {scientific(rate)} is not below 1")
    reached = Y + (linear + bounds.curvature(radius) * radius) * radius
    text = (
        f"Y + (Z0 + Z1 + Z2 r) r = {scientific(reached)} exceeds r = {scientific(radius)}"
    )
    need(reached <= radius, text)


def dyadic(pair: Any, name: str) -> Fraction:
    """m 2^-e of a pair [m, e], positive."""
    mantissa, places = pair
    whole(mantissa, 1, 2**64, name)
    whole(places, 0, MOST_BITS * 2, name)
    return Fraction(mantissa, 1 << places)


def stated(entry: Any, name: str) -> tuple[Fraction, Fraction]:
    """The ends of an interval [middle, radius, e], units 2^-e."""
    middle, half, places = entry
    whole(middle, -(2**4100), 2**4100, name)
    whole(half, 0, 2**4100, name)
    whole(places, 0, MOST_BITS * 2, name)
    unit = 1 << places
    return Fraction(middle - half, unit), Fraction(middle + half, unit)


def check_amplitude(claim: Claim, bonds: Bonds, entry: Any, radius: Fraction) -> None:
    """A = sqrt(N/2) c / Omega of the seed, compared by squares; c has one sign."""
    low, high = stated(entry, "amplitude")
    c = Fraction(claim.orbit[1, claim.seed], 1 << claim.bits)
    if c < 0:
        c, low, high = -c, -high, -low
    need(c > radius, "the amplitude may be zero")
    one = 1 << bonds.places
    linear = 2 * one - 2 * bonds.cosines.of(2 * claim.seed)
    off = 2 * COSINE_UNITS
    half = Fraction(claim.N * one, 2)
    least = (c - radius) ** 2 * half / (linear + off)
    most = (c + radius) ** 2 * half / (linear - off)
    inside = low > 0 and low**2 <= least and most <= high**2
    need(inside, "the amplitude of the orbit may be outside the stated interval")


def check_energy(claim: Claim, bonds: Bonds, entry: Any, radius: Fraction) -> None:
    """H = sum_j V(r_j) at t = 0, where all momenta vanish."""
    low, high = stated(entry, "energy")
    least, most = Fraction(0), Fraction(0)
    for stretch in bonds.stretches:
        r = Fraction(sum(stretch.values), 1 << bonds.places)
        off = radius + Fraction(stretch.error, 1 << bonds.places)
        ends = potential_between(claim, r - off, r + off)
        least, most = least + ends[0], most + ends[1]
    need(low <= least and most <= high, "H may be outside the stated interval")


def potential_between(
    claim: Claim, low: Fraction, high: Fraction
) -> tuple[Fraction, Fraction]:
    """Ends of an interval that holds V(r) = r^2/2 + sum c_k r^(k+1)/(k+1)."""
    least, most = Fraction(0), Fraction(0)
    terms = {1: Fraction(1), **claim.couplings}
    for k, c in terms.items():
        ends = [low ** (k + 1), high ** (k + 1)]
        crosses = low < 0 < high and k % 2 == 1
        powers = (Fraction(0) if crosses else min(ends), max(ends))
        parts = [c * x / (k + 1) for x in powers]
        least, most = least + min(parts), most + max(parts)
    return least, most


def theorem_text(claim: Claim, data: Json, radius: Fraction, unique: Fraction) -> str:
    """What has been proved, in one sentence."""
    law = " + ".join(f"({c}) r^{k + 1}/{k + 1}" for k, c in claim.couplings.items())
    interval = [decimal_interval(data[name]) for name in ("amplitude", "energy")]
    return (
        f"theorem: the chain of N = {claim.N} bonds with fixed ends and V = r^2/2 + {law} has a "
        f"periodic orbit of frequency {shown(claim.omega)}, even in time, whose bond stretches "
        f"differ from those of the certificate by at most {scientific(radius)} at all times "
        f"and in the strip |Im omega t| <= log({claim.nu}); with the symmetry of seed {claim.seed} "
        f"it is the only one within {scientific(unique)} in the weighted norm; "
        f"A = {interval[0]}, H = {interval[1]}"
    )


def shown(x: Fraction) -> str:
    """A fraction, or its first digits where it is long."""
    return str(x) if len(str(x)) <= 40 else f"{scientific(x, 20)} (exactly {x})"


def decimal_interval(entry: Any) -> str:
    """Middle +- radius, the radius rounded up and enough digits of the middle."""
    low, high = stated(entry, "interval")
    middle, half = (low + high) / 2, (high - low) / 2
    digits = max(1, len(str(int(abs(middle) / half))) + 1) if half else 40
    return f"{scientific(middle, digits)} +- {scientific(half + abs(middle) / 10**digits)}"


def scientific(x: Fraction, digits: int = 3) -> str:
    """A number in decimals, rounded away from zero."""
    if not x:
        return "0"
    exponent = len(str(abs(x.numerator))) - len(str(x.denominator))
    if abs(x) < Fraction(10) ** exponent:
        exponent -= 1
    mantissa = up(abs(x) / Fraction(10) ** (exponent - digits + 1))
    text = str(mantissa)
    if len(text) > digits:
        exponent += 1
        text = text[:digits]
    sign = "-" if x < 0 else ""
    point = f"{text[0]}.{text[1:]}" if digits > 1 else text
    return f"{sign}{point}e{exponent}" if exponent else f"{sign}{point}"
