"""Independent checker of certificates of stability: Python integers and fractions alone.

A certificate holds one of existence, which its own checker checks, and for every exponent finitely
many numbers: sigma, the coefficients v of a Floquet solution, a block of places, weights, a radius.
docs/stability-proofs.md states the theorems and proves them; here their hypotheses are computed
anew, each in a function: first the slopes of the bonds, then Y, Z and Z2 of every exponent, then
the count.

Fixed point: an integer times 2^-PLACES unless said. Bounds are rounded up, divisors down; of a
complex number |Re| + |Im| is the norm. The file shares no code with the prover and imports nothing
but the standard library and the checker of existence.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from operator import mul
from pathlib import Path
from typing import Any, NamedTuple

from symfpu.proofs import check_existence

FORMAT = "symfpu stability certificate"
SCHEMA = 1
KEYS = {
    "format", "schema", "existence", "claim", "slope_harmonics", "free", "exponents", "digest",
}  # fmt: skip
EXPONENT_KEYS = {
    "sector", "base", "bits", "sigma", "kappa", "vector", "block", "weights", "radius",
}  # fmt: skip
LARGEST_FILE = 2**26  # bytes
PLACES = 64
COARSE = 48  # places of the moduli of couplings
FINE = 96  # of the slopes while they are computed
SMALLEST_SLOPE = (
    24  # units: harmonics of slopes below it are left out of Y and counted as lost
)
MOST_HARMONICS = 4096
MOST_BLOCK = 400
MOST_STEPS = 10**9
LETTERS = (
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    "!#$%&()*+,-./:;<=>?@[]^_`{|}~"
)
WEIGHT_BITS = 8
COSINE_UNITS = 2  # of the last place, more than a cosine is off
INVERSE_BITS = 32  # of the entries of the approximate inverse
READING_ERRORS = (
    OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError,
    ZeroDivisionError, OverflowError,
)  # fmt: skip

ONE = 1 << PLACES
Json = dict[str, Any]
Place = tuple[int, int]  # harmonic n, mode q
Gaussian = tuple[int, int]  # real and imaginary part


class StabilityError(ValueError):
    """Why a certificate is refused, in one line."""


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises StabilityError, with the reason, if it is not right.
    """
    try:
        return check_certificate(read_certificate(Path(path)))
    except StabilityError:
        raise
    except READING_ERRORS as error:
        raise StabilityError(f"no readable certificate: {error!r:.200}") from None


def need(condition: object, reason: str) -> None:
    """Refuse the certificate unless the condition holds."""
    if not condition:
        raise StabilityError(reason)


# --- the file


def read_certificate(path: Path) -> Json:
    """The contents of a file, its size bounded first; no floats, no booleans, no null."""
    small = path.is_file() and path.stat().st_size <= LARGEST_FILE
    need(small, "not a regular file of at most 64 MB")
    text = path.read_text("ascii", "replace")
    bare = re.sub(r'"[^"\\]*"', '"', text)  # without what stands in strings
    strange = re.search(r'[^\s0-9{}\[\],:"-]|[0-9]{1300}', bare)
    need(not strange, "not JSON of plain strings and integers of at most 1300 digits")
    data: Json = json.loads(text, object_pairs_hook=without_repeats)
    need(set(data) == KEYS, "a key is missing or unknown")
    need(data["format"] == FORMAT, "not a certificate of stability")
    need(data["schema"] == SCHEMA, f"this checker supports schema {SCHEMA}")
    check_digest(data)
    return data


def without_repeats(pairs: list[tuple[str, Any]]) -> Json:
    """An object whose keys are there once."""
    need(len({key for key, _ in pairs}) == len(pairs), "a key is there twice")
    return dict(pairs)


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


def up(x: Fraction | int) -> int:
    """The least integer not below."""
    return -((-x.numerator) // x.denominator)


def floor(x: Fraction) -> int:
    """In units 2^-PLACES, rounded down."""
    return x.numerator * ONE // x.denominator


# --- the orbit


class Orbit(NamedTuple):
    """What the certificate of existence has proved: an orbit within `radius` of these numbers.

    couplings : of phi(r) = V'(r) - r by power of r. rows : c_q[n] 2^bits by harmonic, all modes.
    """

    N: int
    couplings: dict[int, Fraction]
    seed: int
    omega: Fraction
    bits: int
    rows: list[list[int]]
    radius: Fraction

    @property
    def even(self) -> bool:
        """Whether V is even."""
        return all(k % 2 for k in self.couplings)


def check_existence_of(data: Json) -> str:
    """The orbit exists: the sentence of the other checker."""
    need(data["format"] == check_existence.FORMAT, "it holds no certificate of existence")
    schema = check_existence.reading.SCHEMA
    need(data["schema"] == schema, "a proof of existence of another schema")
    contents = {key: data[key] for key in data if key != "digest"}
    text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
    digest = hashlib.sha256(text.encode()).hexdigest()
    need(data["digest"] == digest, "the digest of the proof of existence does not fit")
    try:
        return check_existence.check_certificate(data)[0]
    except check_existence.ExistenceError as error:
        raise StabilityError(f"no orbit is proved: {error}") from error


def orbit_of(data: Json) -> Orbit:
    """The numbers of a certificate of existence that has been checked."""
    claim = check_existence.read_claim(data)
    need(not claim.bordered, "stability needs an orbit of exact frequency")
    need(not claim.force.growths, "stability needs a polynomial potential")
    rows = [[0] * claim.N for _ in range(claim.harmonics + 1)]
    for (n, q), c in claim.orbit.items():
        rows[n][q] = c
    radius = check_existence.dyadic(data["radius"], "radius")
    couplings = claim.force.couplings
    return Orbit(claim.N, couplings, claim.seed, claim.omega, claim.bits, rows, radius)


class Sector(NamedTuple):
    """Places (n, q) with q = first + slope n (mod 2), n = start (mod step).

    folds : exponents count modulo folds omega. trivial : the velocity of the orbit is in it.
    """

    N: int
    first: int
    slope: int
    start: int
    step: int
    folds: int
    trivial: bool

    def allowed(self, n: int) -> range:
        """The modes at a harmonic."""
        if (n - self.start) % self.step:
            return range(0)
        parity = (self.first + self.slope * n) % 2
        return range(1 if parity else 2, self.N, 2)

    @property
    def exponents(self) -> int:
        """How many exponents up to sign there are beside the double multiplier 1."""
        modes = self.N - 1 if self.slope else len(self.allowed(self.start))
        return modes - int(self.trivial)


def sectors_of(orbit: Orbit) -> list[Sector]:
    """The table of docs/stability-proofs.md; none is empty."""
    N, parity = orbit.N, orbit.seed % 2
    if orbit.even:
        own = Sector(N, parity, 0, 1, 2, 2, True)
        other = Sector(N, 1 - parity, 0, 0, 2, 2, False)
    elif parity == 0:
        own = Sector(N, 0, 0, 0, 1, 1, True)
        other = Sector(N, 1, 0, 0, 1, 1, False)
    else:
        return [Sector(N, 0, 1, 0, 1, 2, True)]
    return [own, other] if other.exponents else [own]


# --- cosines


class Cosines:
    """cos(k pi / 2N) in units of 2^-places, each off by less than COSINE_UNITS."""

    def __init__(self, N: int, places: int) -> None:
        guard = 48
        pi = 4 * (
            4 * inverse_tangent(5, places + guard) - inverse_tangent(239, places + guard)
        )
        self.N = N
        angles = [pi * k // (2 * N) for k in range(N + 1)]
        self.quarter = [cosine_of(angle, places + guard) >> guard for angle in angles]

    def of(self, k: int) -> int:
        """For any k, by the symmetries of the cosine."""
        k %= 4 * self.N
        k = min(k, 4 * self.N - k)
        return self.quarter[k] if k <= self.N else -self.quarter[2 * self.N - k]

    def bond(self, q: int, j: int) -> int:
        """cos(q theta_j), theta_j = (j + 1/2) pi / N."""
        return self.of(q * (2 * j + 1))


def inverse_tangent(n: int, places: int) -> int:
    """arctan(1/n) 2^places, off by less than two units a term."""
    power, k, total = (1 << places) // n, 1, 0
    while power:
        total += power // k if k % 4 == 1 else -(power // k)
        power //= n * n
        k += 2
    return total


def cosine_of(angle: int, places: int) -> int:
    """The cosine of an angle up to pi/2 by its alternating series, off by less than 2^40 units."""
    one = 1 << places
    square = angle * angle >> places
    total, term, i = one, one, 0
    while term:
        i += 1
        term = (term * square >> places) // ((2 * i - 1) * (2 * i))
        total += -term if i % 2 else term
    return total


# --- slopes of the bonds


class Series(NamedTuple):
    """Cosine coefficients a_0, a_1, .. in units 2^-FINE and a bound of the sum of their errors."""

    values: list[int]
    error: int

    @property
    def size(self) -> int:
        """Above sum |a_n| of the true series."""
        return sum(map(abs, self.values)) + self.error


def stretch(orbit: Orbit, cosines: Cosines, j: int) -> Series:
    """r_j = sum_q c_q cos(q theta_j): the c are exact, the cosines off by COSINE_UNITS."""
    row_of_cosines = [cosines.bond(q, j) for q in range(orbit.N)]
    values, error = [], 0
    for row in orbit.rows:
        values.append(sum(map(mul, row, row_of_cosines)) >> orbit.bits)
        error += (COSINE_UNITS * sum(map(abs, row)) >> orbit.bits) + 2
    return Series(values, error)


def product(a: Series, b: Series) -> Series:
    """2 cos i cos j = cos(i+j) + cos(i-j); rounded down once."""
    doubled = [0] * (len(a.values) + len(b.values) - 1)
    for i, x in enumerate(a.values):
        for j, y in enumerate(b.values):
            doubled[i + j] += x * y
            doubled[abs(i - j)] += x * y
    values = [x >> (FINE + 1) for x in doubled]
    crossed = a.size * b.error + b.size * a.error
    return Series(values, (crossed >> FINE) + 1 + len(values))


def slope(orbit: Orbit, r: Series) -> Series:
    """phi'(r) = sum k c_k r^(k-1)."""
    power, total, error = Series([1 << FINE], 0), [0], 0
    for k in range(2, max(orbit.couplings) + 1):
        power = product(power, r)
        c = k * orbit.couplings.get(k, Fraction(0))
        total += [0] * (len(power.values) - len(total))
        for n, x in enumerate(power.values):
            total[n] += x * c.numerator // c.denominator
        error += up(power.error * abs(c)) + len(power.values)
    return Series(total, error)


def moved_slope(orbit: Orbit, r: Series) -> Fraction:
    """Above |phi'(r*) - phi'(r)| for |r* - r| up to the radius of the orbit."""
    size = Fraction(r.size, 1 << FINE) + orbit.radius
    size = Fraction(up(size * ONE), ONE)
    terms = orbit.couplings.items()
    steepest = sum((abs(c) * k * (k - 1) * size ** (k - 2) for k, c in terms), Fraction(0))
    return steepest * orbit.radius


class Slopes:
    """Couplings G_qp[k] of modes by harmonics of the slopes of all bonds.

    K : harmonics that I - A DF sees; those up to `all` enter Y. lost : above the sum over bonds of
    the moduli of all Fourier coefficients that differ from those of the true orbit; cut : the same
    with harmonics beyond K left out. entry : above the error of a coupling, summed over harmonics.
    """

    def __init__(self, orbit: Orbit, K: int) -> None:
        self.orbit, N = orbit, orbit.N
        cosines = Cosines(N, FINE)
        stretches = [stretch(orbit, cosines, j) for j in range(N)]
        slopes = [slope(orbit, r) for r in stretches]
        moved = sum((moved_slope(orbit, r) for r in stretches), Fraction(0))
        errors = sum(s.error + len(s.values) for s in slopes)
        self.halves = self.fourier(slopes)
        sizes = [sum(map(abs, column)) for column in self.halves]
        small = [k for k, size in enumerate(sizes) if size > N * SMALLEST_SLOPE]
        self.K, self.all = K, max([K, *small])
        left = 2 * sum(sizes[self.all + 1 :])
        # cutting to PLACES moves every coefficient by less than a unit
        cut_places = 2 * N * len(sizes)
        self.lost = moved + Fraction(errors, 1 << FINE) + Fraction(left + cut_places, ONE)
        self.cut = self.lost + Fraction(2 * sum(sizes[K + 1 :]), ONE)
        self.couple(sizes)
        self.near = self.tables(self.all)
        self.sizes = [self.moduli(table) for table in self.near[: K + 1]]

    @staticmethod
    def fourier(slopes: list[Series]) -> list[list[int]]:
        """g_j[k] by harmonic, a column of bonds each, cut to PLACES."""
        drop = FINE - PLACES
        columns = zip(*[s.values for s in slopes], strict=True)
        return [[x >> (drop + (k > 0)) for x in column] for k, column in enumerate(columns)]

    def couple(self, sizes: list[int]) -> None:
        """G_qp[k] = sums[k][|q - p|] + sums[k][q + p], off by the units that make up `entry`."""
        N = self.orbit.N
        cosines = Cosines(N, PLACES)
        tables = [[cosines.bond(p, j) for j in range(N)] for p in range(2 * N - 1)]
        self.sums: list[list[int]] = []
        errors = 0
        for k in range(self.all + 1):
            column = self.halves[k] if k < len(self.halves) else [0] * N
            totals = [sum(map(mul, table, column)) for table in tables]
            self.sums.append([(total >> PLACES) // N for total in totals])
            size = sizes[k] if k < len(sizes) else 0
            error = 2 * ((COSINE_UNITS * size >> PLACES) + 3)
            errors += error if k == 0 else 2 * error
        self.entry = Fraction(errors, ONE)

    def tables(self, last: int) -> list[list[tuple[list[int], list[int]]]]:
        """By k and q the couplings with the even modes and with the odd ones."""
        N = self.orbit.N
        result = []
        for k in range(last + 1):
            row = self.sums[k]
            of_modes = []
            for q in range(N):
                even, odd = (
                    [row[abs(q - p)] + row[q + p] for p in range(first, N, 2)]
                    for first in (2, 1)
                )
                of_modes.append((even, odd))
            result.append(of_modes)
        return result

    @staticmethod
    def moduli(
        table: list[tuple[list[int], list[int]]],
    ) -> list[tuple[list[int], list[int]]]:
        """Their moduli with COARSE places, rounded up."""
        drop = PLACES - COARSE
        return [
            (
                [(abs(x) >> drop) + 1 for x in even],
                [(abs(x) >> drop) + 1 for x in odd],
            )
            for even, odd in table
        ]


# --- one exponent


class Exponent(NamedTuple):
    """The numbers of a certificate for one exponent.

    sigma : base folds omega / 2 + value, exactly. rows : v 2^bits by harmonic, as long as the
    allowed modes, without kappa none is 1. weights : by place, units 2^-WEIGHT_BITS.
    """

    sector: Sector
    real: Fraction
    imaginary: Fraction
    bits: int
    kappa: Place
    rows: dict[int, list[Gaussian]]
    block: list[Place]
    weights: dict[Place, int]
    radius: Fraction

    @property
    def reals(self) -> bool:
        """Whether all is real, and with it the zero."""
        return not self.imaginary

    @property
    def off(self) -> Fraction:
        """Above |sigma* - sigma|."""
        return self.radius * (1 << WEIGHT_BITS) / self.weights[self.kappa]

    def weight(self, place: Place) -> int:
        """w of a place, 1 beyond `free` harmonics."""
        return self.weights.get(place, 1 << WEIGHT_BITS)


def read_exponent(data: Json, orbit: Orbit, free: int) -> Exponent:
    """The choices of the prover, their sizes bounded; any that meet the bounds will do."""
    need(type(data) is dict and set(data) == EXPONENT_KEYS, "wrong keys of an exponent")
    sectors = sectors_of(orbit)
    sector = sectors[whole(data["sector"], 0, len(sectors) - 1, "sector")]
    bits, base = whole(data["bits"], 1, 60, "bits"), whole(data["base"], 0, 1, "base")
    parts = data["sigma"]
    need(type(parts) is list and len(parts) in (1, 2), "sigma has one or two parts")
    values = [Fraction(whole(x, -(2**70), 2**70, "sigma"), 1 << bits) for x in parts]
    imaginary = values[1] if len(parts) == 2 else Fraction(0)
    need(len(parts) == 1 or imaginary, "a complex sigma has an imaginary part")
    real = values[0] + base * sector.folds * orbit.omega / 2
    rows = read_rows(data["vector"], sector, len(parts))
    n, q = data["kappa"]
    kappa = whole(n, -free, free, "kappa"), whole(q, 1, orbit.N - 1, "kappa")
    need(kappa[1] in sector.allowed(kappa[0]), "kappa is no place of the sector")
    place = list(sector.allowed(kappa[0])).index(kappa[1])
    need(rows[kappa[0]][place] == (1 << bits, 0), "v is not 1 at kappa")
    weights = read_weights(data["weights"], sector, free)
    block = [(n, q) for n, q in data["block"]]
    ascending = block == sorted(set(block)) and set(block) <= set(weights)
    need(ascending and len(block) <= MOST_BLOCK, "the block is not of ascending places")
    need(kappa in block, "kappa is not in the block")
    mantissa = whole(data["radius"][0], 1, 2**64, "radius")
    places = whole(data["radius"][1], 0, 4096, "radius")
    need(len(data["radius"]) == 2, "the radius is no pair")
    radius = Fraction(mantissa, 1 << places)
    return Exponent(sector, real, imaginary, bits, kappa, rows, block, weights, radius)


def read_rows(parts: Any, sector: Sector, count: int) -> dict[int, list[Gaussian]]:
    """v by harmonic from rows [n, i, v, v, ..], real parts and imaginary ones."""
    need(type(parts) is list and len(parts) == count, "v has as many parts as sigma")
    found: dict[int, list[list[int]]] = {}
    for part, rows in enumerate(parts):
        for n, first, *values in rows:
            whole(n, -MOST_HARMONICS, MOST_HARMONICS, "a harmonic of v")
            modes = len(sector.allowed(n))
            whole(first, 0, modes, "the first place of a row of v")
            need(0 < len(values) <= modes - first, "a row of v has the wrong length")
            row = found.setdefault(n, [[0] * modes, [0] * modes])
            need(not any(row[part]), "a row of v is there twice")
            for i, v in enumerate(values, first):
                row[part][i] = whole(v, -(2**64), 2**64, "a coefficient of v")
    return {n: list(zip(*row, strict=True)) for n, row in sorted(found.items())}


def read_weights(letters: Any, sector: Sector, free: int) -> dict[Place, int]:
    """w = 2^(letter/4) of the places up to `free`, rounded down to WEIGHT_BITS."""
    places = [(n, q) for n in range(-free, free + 1) for q in sector.allowed(n)]
    need(type(letters) is str and len(letters) == len(places), "wrong number of weights")
    values = {
        letter: isqrt(isqrt(1 << (k + 4 * WEIGHT_BITS))) for k, letter in enumerate(LETTERS)
    }
    return {place: values[letter] for place, letter in zip(places, letters, strict=True)}


class Divisor(NamedTuple):
    """lambda of a place: real and imaginary part, each off by at most `off`."""

    re: int
    im: int
    off: int

    @property
    def inverse(self) -> int:
        """Above |Re| + |Im| of 1/lambda, PLACES; refused where lambda may be zero."""
        re, im = max(0, abs(self.re) - self.off), max(0, abs(self.im) - self.off)
        need(re or im, "a divisor outside the block may be zero")
        size = abs(self.re) + abs(self.im) + 2 * self.off
        return (size << (2 * PLACES)) // (re * re + im * im) + 1


class Bounds:
    """Y, Z and Z2 of one exponent."""

    def __init__(self, slopes: Slopes, exponent: Exponent, free: int) -> None:
        self.slopes, self.exponent, self.free = slopes, exponent, free
        self.sector, self.N = exponent.sector, slopes.orbit.N
        self.last = free + slopes.K
        self.read_frequencies()
        self.check_beyond()
        self.members = {place: i for i, place in enumerate(exponent.block)}
        self.invert()
        self.norms = self.norms_of_columns()
        self.spread = self.largest_sum()

    # divisors

    def read_frequencies(self) -> None:
        """1/Omega_q^2 between two integers."""
        cosines = Cosines(self.N, PLACES)
        off = 2 * COSINE_UNITS
        self.least, self.most = [0], [0]
        for q in range(1, self.N):
            squared = 2 * ONE - 2 * cosines.of(2 * q)
            need(squared > off, "places do not resolve Omega_1")
            self.least.append(ONE * ONE // (squared + off))
            self.most.append(ONE * ONE // (squared - off) + 1)

    def angle(self, n: int) -> Gaussian:
        """sigma + n omega, each part rounded down."""
        real = self.exponent.real + n * self.slopes.orbit.omega
        return floor(real), floor(self.exponent.imaginary)

    def size_of_angle(self, n: int) -> int:
        """Above |Re| + |Im| of it."""
        re, im = self.angle(n)
        return abs(re) + abs(im) + 2

    def divisor(self, place: Place) -> Divisor:
        """1 - (sigma + n omega)^2 / Omega_q^2."""
        n, q = place
        (x, y), least, most = self.angle(n), self.least[q], self.most[q]
        re = ONE - ((x * x - y * y) * least >> (2 * PLACES))
        im = -(2 * x * y * least >> (2 * PLACES))
        size = self.size_of_angle(n)
        off_square = (2 * size >> PLACES) + 2  # rounding of the angle, units
        off = off_square * most + size * size * (most - least) // ONE
        return Divisor(re, im, (off >> PLACES) + 2)

    def edge(self, n: int, q: int) -> int:
        """Below |lambda_q| of every harmonic from n on, on both sides, where it is positive."""
        far = floor(n * self.slopes.orbit.omega - abs(self.exponent.real))
        return (far * far * self.least[q] >> (2 * PLACES)) - ONE if far > 0 else -ONE

    def check_beyond(self) -> None:
        """Beyond `free` every harmonic is above all modes: |lambda| grows from there on."""
        for q in range(1, self.N):
            need(self.edge(self.free + 1, q) > 0, f"harmonic {self.free + 1} is too low")

    def inverse_beyond(self, n: int, q: int) -> int:
        """Above |Re| + |Im| of 1/lambda_q of every harmonic from n on."""
        found = ONE * ONE // self.edge(n, q) + 1
        return found if self.exponent.reals else found * 3 // 2 + 1  # above the root of 2

    # the approximate inverse

    def derivative(self, place: Place, column: Place) -> int:
        """The coupling in a row by a column that is not kappa."""
        (n, q), (m, p) = place, column
        k = abs(n - m)
        if k > self.slopes.K:
            return 0
        row = self.slopes.sums[k]
        return row[abs(q - p)] + row[q + p]

    def of_sigma(self, place: Place) -> tuple[Gaussian, int]:
        """-2 (sigma + n omega) v / Omega_q^2, and a bound of its error."""
        n, q = place
        v = self.coefficient(place)
        (x, y), least, most, shift = self.angle(n), self.least[q], self.most[q], PLACES
        drop = shift + self.exponent.bits
        re = -(2 * (x * v[0] - y * v[1]) * least >> drop)
        im = -(2 * (x * v[1] + y * v[0]) * least >> drop)
        size = abs(v[0]) + abs(v[1])
        error = 2 * size * (2 * most + self.size_of_angle(n) * (most - least))
        return (re, im), (error >> drop) + 2

    def coefficient(self, place: Place) -> Gaussian:
        """v 2^bits."""
        n, q = place
        row = self.exponent.rows.get(n)
        if not row:
            return 0, 0
        return row[(q - self.sector.allowed(n)[0]) // 2]

    def column_in_block(self, column: Place) -> list[Gaussian]:
        """Its entries of DF in the rows of the block."""
        if column == self.exponent.kappa:
            return [self.of_sigma(place)[0] for place in self.exponent.block]
        result = [(self.derivative(place, column), 0) for place in self.exponent.block]
        own = self.members.get(column)
        if own is not None:
            divisor = self.divisor(column)
            result[own] = result[own][0] + divisor.re, divisor.im
        return result

    def invert(self) -> None:
        """A on the block: the inverse of DF there, rounded; any other would do."""
        columns = [self.column_in_block(place) for place in self.exponent.block]
        size = len(columns)
        matrix = [[columns[l][i][0] for l in range(size)] for i in range(size)]
        if not self.exponent.reals:
            lower = [[columns[l][i][1] for l in range(size)] for i in range(size)]
            upper_rows = [a + [-x for x in b] for a, b in zip(matrix, lower, strict=True)]
            lower_rows = [b + a for a, b in zip(matrix, lower, strict=True)]
            matrix = upper_rows + lower_rows
        inverse = inverse_of(matrix)
        self.real = [row[:size] for row in inverse[:size]]
        self.imaginary = [row[:size] for row in inverse[size:]]

    def applied(self, column: list[Gaussian]) -> list[Gaussian]:
        """A times a column of the block, PLACES + INVERSE_BITS."""
        re, im = [x for x, _ in column], [y for _, y in column]
        if self.exponent.reals:
            return [(sum(map(mul, row, re)), 0) for row in self.real]
        result = []
        for a, b in zip(self.real, self.imaginary, strict=True):
            real = sum(map(mul, a, re)) - sum(map(mul, b, im))
            result.append((real, sum(map(mul, a, im)) + sum(map(mul, b, re))))
        return result

    # norms of columns of A: units 2^-(PLACES + WEIGHT_BITS)

    def norms_of_columns(self) -> dict[int, list[int]]:
        """|A e| of the places up to M + 2 K by harmonic, rounded up."""
        of_block = self.norms_in_block()
        found = {}
        for n in range(-self.last - self.slopes.K, self.last + self.slopes.K + 1):
            row = []
            for q in self.sector.allowed(n):
                place = (n, q)
                if place in of_block:
                    row.append(of_block[place])
                else:
                    row.append(self.exponent.weight(place) * self.divisor(place).inverse)
            found[n] = row
        return found

    def norms_in_block(self) -> dict[Place, int]:
        """Those of the block."""
        block = self.exponent.block
        result = {}
        for l, place in enumerate(block):
            total = 0
            for i, row in enumerate(block):
                size = abs(self.real[i][l])
                if not self.exponent.reals:
                    size += abs(self.imaginary[i][l])
                total += self.exponent.weights[row] * size
            result[place] = total << (PLACES - INVERSE_BITS)
        return result

    def norm(self, place: Place) -> int:
        """Of any place."""
        n, q = place
        if n in self.norms:
            return self.norms[n][(q - self.sector.allowed(n)[0]) // 2]
        return self.inverse_beyond(self.last + 1, q) << WEIGHT_BITS

    def largest_sum(self) -> Fraction:
        """S, above sum_q a_q[n] of every n."""
        beyond = sum(self.inverse_beyond(self.last + 1, q) for q in range(1, self.N))
        largest = max([beyond << WEIGHT_BITS, *map(sum, self.norms.values())])
        return Fraction(largest, ONE << WEIGHT_BITS)

    # the bounds

    def of_bonds(self, size: Fraction) -> Fraction:
        """Above |A (G' x)| / sum |x| where slopes that make G' have norms that sum to `size`."""
        return self.spread * (Fraction(2, self.N) * size + self.slopes.entry)

    def residual(self) -> Fraction:
        """Y."""
        total = sum((self.of_harmonic(n) for n in self.reached()), 0)
        unit = 1 << (2 * PLACES + WEIGHT_BITS + self.exponent.bits)
        sizes = (abs(x) + abs(y) for row in self.exponent.rows.values() for x, y in row)
        size = Fraction(sum(sizes), 1 << self.exponent.bits)
        return Fraction(total, unit) + self.of_bonds(self.slopes.lost) * size

    def reached(self) -> range:
        """Harmonics of L v."""
        rows, last = self.exponent.rows, self.slopes.all
        return range(min(rows) - last, max(rows) + last + 1)

    def of_harmonic(self, n: int) -> int:
        """sum_q a |L v| of a harmonic, units 2^-(2 PLACES + WEIGHT_BITS + bits)."""
        near = [
            (m, row)
            for m, row in self.exponent.rows.items()
            if abs(n - m) <= self.slopes.all
        ]
        total = 0
        for q in self.sector.allowed(n):
            value = self.row_of_residual((n, q), near)
            total += self.norm((n, q)) * value
        return total

    def row_of_residual(self, place: Place, near: list[tuple[int, list[Gaussian]]]) -> int:
        """|(L v)_q[n]| with the error of its divisor."""
        n, q = place
        re = im = 0
        for m, row in near:
            odd = self.sector.allowed(m)[0] % 2
            coupling = self.slopes.near[abs(n - m)][q][odd]
            re += sum(map(mul, coupling, [x for x, _ in row]))
            if not self.exponent.reals:
                im += sum(map(mul, coupling, [y for _, y in row]))
        (x, y), divisor = self.coefficient(place), self.divisor(place)
        re += divisor.re * x - divisor.im * y
        im += divisor.re * y + divisor.im * x
        return abs(re) + abs(im) + 2 * divisor.off * (abs(x) + abs(y))

    def linear(self) -> Fraction:
        """Z, above |I - A DF|."""
        columns = max(self.of_columns(), self.of_sigma_column(), self.of_tail())
        return columns + self.of_bonds(self.slopes.cut)

    def of_columns(self) -> Fraction:
        """The largest column of a place but kappa, up to harmonic M + K."""
        outside = self.outside_norms()
        worst = Fraction(0)
        for m in range(-self.last, self.last + 1):
            for p in self.sector.allowed(m):
                if (m, p) != self.exponent.kappa:
                    worst = max(worst, self.of_column((m, p), outside))
        return worst

    def outside_norms(self) -> dict[int, list[int]]:
        """The norms of columns of A, none for those of the block."""
        found = {n: list(row) for n, row in self.norms.items()}
        for n, q in self.exponent.block:
            found[n][(q - self.sector.allowed(n)[0]) // 2] = 0
        return found

    def of_column(self, column: Place, outside: dict[int, list[int]]) -> Fraction:
        """|(I - A DF) e| over the weight of e."""
        m, p = column
        total = 0
        for n in range(m - self.slopes.K, m + self.slopes.K + 1):
            row = outside[n]
            if row:
                odd = self.sector.allowed(n)[0] % 2
                total += sum(map(mul, row, self.slopes.sizes[abs(n - m)][p][odd]))
        found = Fraction(total, 1 << (PLACES + WEIGHT_BITS + COARSE))
        found += self.in_block(column)
        if column in self.members:
            off = 2 * self.divisor(column).off * self.norm(column)
            found += Fraction(off, 1 << (2 * PLACES + WEIGHT_BITS))
        return found * (1 << WEIGHT_BITS) / self.exponent.weight(column)

    def in_block(self, column: Place) -> Fraction:
        """sum over the rows of the block of w |(I - A DF) e|."""
        entries = self.column_in_block(column)
        if not any(x or y for x, y in entries):
            return Fraction(0)
        image, own = self.applied(entries), self.members.get(column)
        total = 0
        for i, (x, y) in enumerate(image):
            identity = 1 << (PLACES + INVERSE_BITS) if i == own else 0
            weight = self.exponent.weights[self.exponent.block[i]]
            total += weight * (abs(identity - x) + abs(y))
        return Fraction(total, 1 << (PLACES + INVERSE_BITS + WEIGHT_BITS))

    def of_sigma_column(self) -> Fraction:
        """The column of sigma in the place of kappa."""
        total = 0
        for n, row in self.exponent.rows.items():
            for q, v in zip(self.sector.allowed(n), row, strict=True):
                if v != (0, 0):
                    (x, y), error = self.of_sigma((n, q))
                    inside = (n, q) in self.members
                    size = 0 if inside else abs(x) + abs(y)
                    total += self.norm((n, q)) * (size + 2 * error)
        found = Fraction(total, 1 << (2 * PLACES + WEIGHT_BITS))
        found += self.in_block(self.exponent.kappa)
        return found * (1 << WEIGHT_BITS) / self.exponent.weights[self.exponent.kappa]

    def of_tail(self) -> Fraction:
        """Every column beyond M + K: it meets rows beyond M alone."""
        modes = range(1, self.N)
        inverse = [0] + [self.inverse_beyond(self.free + 1, q) for q in modes]
        worst = 0
        for p in modes:
            total = 0
            for k, table in enumerate(self.slopes.sizes):
                even, odd = table[p]
                sizes = sum(map(mul, inverse[2::2], even)) + sum(
                    map(mul, inverse[1::2], odd)
                )
                total += sizes if k == 0 else 2 * sizes
            worst = max(worst, total)
        return Fraction(worst, 1 << (PLACES + COARSE))

    def curvature(self) -> tuple[Fraction, Fraction, Fraction]:
        """e1, e2, e3 of the theorem."""
        e1, e2 = self.curvature_beyond()
        unit = 1 << (2 * PLACES)
        for n in range(-self.last, self.last + 1):
            size = Fraction(self.size_of_angle(n), ONE)
            for q, norm in zip(self.sector.allowed(n), self.norms[n], strict=True):
                if (n, q) != self.exponent.kappa:
                    weight = self.exponent.weight((n, q))
                    ratio = Fraction(2 * norm * self.most[q], weight * unit)
                    e1, e2 = max(e1, ratio * size), max(e2, ratio)
        e3 = 0
        for n, row in self.exponent.rows.items():
            for q, (x, y) in zip(self.sector.allowed(n), row, strict=True):
                if x or y:
                    e3 += 2 * self.norm((n, q)) * self.most[q] * (abs(x) + abs(y))
        third = Fraction(e3, unit << (WEIGHT_BITS + self.exponent.bits))
        return e1, e2, third

    def curvature_beyond(self) -> tuple[Fraction, Fraction]:
        """e1 and e2 of places beyond M + K: both fall with the harmonic.

        |z| / |z^2 - Omega^2| falls with |z|, on both sides.
        """
        n = self.last + 1
        size = max(self.size_of_angle(n), self.size_of_angle(-n))
        worst = max(2 * self.inverse_beyond(n, q) * self.most[q] for q in range(1, self.N))
        second = Fraction(worst, ONE * ONE)
        return second * Fraction(size, ONE), second

    def check_contraction(self) -> tuple[Fraction, Fraction]:
        """The map takes the ball of the radius into itself and contracts it; Y and Z."""
        rho, weight = self.exponent.radius, self.exponent.weights[self.exponent.kappa]
        w = Fraction(weight, 1 << WEIGHT_BITS)
        Y, Z, (e1, e2, e3) = self.residual(), self.linear(), self.curvature()
        rate = Z + (e1 / w + e2 * rho / w**2 + e3 / w**2) * rho
        need(rate < 1, f"of an exponent Z + Z2 r = {scientific(rate)} is not below 1")
        reached = Y + rate * rho
        text = f"Y + (Z + Z2 r) r = {scientific(reached)} exceeds r = {scientific(rho)}"
        need(reached <= rho, f"of an exponent {text}")
        return Y, Z


def inverse_of(matrix: list[list[int]]) -> list[list[int]]:
    """About the inverse of a matrix with PLACES, with INVERSE_BITS: Gauss and Jordan."""
    size = len(matrix)
    rows = [
        row + [ONE if i == j else 0 for j in range(size)] for i, row in enumerate(matrix)
    ]
    for i in range(size):
        best = max(range(i, size), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        pivot = rows[i][i]
        need(pivot, "the block has no inverse")
        rows[i] = [(x << PLACES) // pivot for x in rows[i]]
        for k in range(size):
            factor = rows[k][i]
            if k != i and factor:
                rows[k] = [
                    x - (factor * y >> PLACES)
                    for x, y in zip(rows[k], rows[i], strict=True)
                ]
    return [[x >> (PLACES - INVERSE_BITS) for x in row[size:]] for row in rows]


# --- the theorem


def check_certificate(data: Json) -> list[str]:
    """The orbit exists, every exponent is enclosed, and the count is right."""
    sentence = check_existence_of(data["existence"])
    orbit = orbit_of(data["existence"])
    K = whole(data["slope_harmonics"], 1, MOST_HARMONICS, "slope_harmonics")
    free = whole(data["free"], 1, MOST_HARMONICS, "free")
    given = data["exponents"]
    need(type(given) is list and len(given) <= 2 * orbit.N, "too many exponents")
    check_cost(orbit, K, free, len(given))
    slopes = Slopes(orbit, K)
    exponents = [read_exponent(entry, orbit, free) for entry in given]
    bounds = [Bounds(slopes, one, free).check_contraction() for one in exponents]
    need(data["claim"] in ("stable", "unstable"), "the claim is stable or unstable")
    check = check_stable if data["claim"] == "stable" else check_unstable
    line = check(orbit, exponents)
    largest = [max((pair[i] for pair in bounds), default=Fraction(0)) for i in (0, 1)]
    numbers = f"Y up to {scientific(largest[0])}, Z up to {scientific(largest[1])}"
    return [line, sentence, f"{len(given)} exponents: {numbers}: recomputed with integers"]


def check_cost(orbit: Orbit, K: int, free: int, exponents: int) -> None:
    """Checking takes minutes at most."""
    columns = (2 * (free + K) + 1) * orbit.N
    steps = exponents * columns * (2 * K + 1) * orbit.N
    need(steps <= MOST_STEPS, "checking it would take too many steps")


def check_stable(orbit: Orbit, exponents: Iterable[Exponent]) -> str:
    """As many distinct real exponents in every sector as the theorem on counting asks for."""
    listed = list(exponents)
    gaps = []
    for sector in sectors_of(orbit):
        own = [one for one in listed if one.sector == sector]
        need(
            len(own) == sector.exponents,
            f"a sector needs {sector.exponents} exponents, not {len(own)}",
        )
        need(all(one.reals for one in own), "an exponent of a stable orbit is not real")
        ends = sorted((one.real - one.off, one.real + one.off) for one in own)
        zero, last = Fraction(0), sector.folds * orbit.omega / 2
        points = [(zero, zero), *ends, (last, last)]
        for a, b in pairwise(points):
            need(
                a[1] < b[0], "two exponents may be the same, or one at 0 or half the period"
            )
            gaps.append((b[0] - a[1]) / orbit.omega)
    return (
        "theorem: the periodic orbit of the next line is linearly stable: all its Floquet "
        f"multipliers lie on the unit circle, 1 is double, and within each of "
        f"{len(sectors_of(orbit))} symmetry sectors all others are simple, their exponents at "
        f"least {scientific_below(min(gaps))} omega apart"
    )


def check_unstable(orbit: Orbit, exponents: Iterable[Exponent]) -> str:
    """A solution of the linearised equations grows."""
    rates = []
    for one in exponents:
        rate = abs(one.imaginary)
        need(rate > one.off, "an exponent may be real")
        rates.append((rate - one.off, rate + one.off))
    need(rates, "no exponent is given")
    least, most = max(rates)
    return (
        "theorem: the periodic orbit of the next line is linearly unstable: a solution of its "
        f"linearised equations grows with a rate between {scientific_below(least, 10)} and "
        f"{scientific(most, 10)}"
    )


def scientific_below(x: Fraction, digits: int = 3) -> str:
    """A positive number in decimals, rounded down."""
    return scientific(x, digits, down=True)


def scientific(x: Fraction, digits: int = 3, *, down: bool = False) -> str:
    """A number that is not negative in decimals, rounded up."""
    if not x:
        return "0"
    exponent = len(str(x.numerator)) - len(str(x.denominator))
    if x < Fraction(10) ** exponent:
        exponent -= 1
    scaled = x / Fraction(10) ** (exponent - digits + 1)
    text = str(scaled.numerator // scaled.denominator if down else up(scaled))
    if len(text) > digits:
        exponent += 1
        text = text[:digits]
    return f"{text[0]}.{text[1:]}e{exponent}" if exponent else f"{text[0]}.{text[1:]}"
