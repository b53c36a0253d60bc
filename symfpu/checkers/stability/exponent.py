"""The numbers of a certificate for one exponent: a Floquet solution, and choices of the prover."""

from fractions import Fraction
from math import isqrt
from typing import Any, NamedTuple

from symfpu.checkers.reading import Json, dyadic, need, whole
from symfpu.checkers.stability.orbit import Orbit, Place, Sector, sectors_of

EXPONENT_KEYS = {
    "sector", "base", "bits", "sigma", "kappa", "vector", "block", "weights", "radius",
}  # fmt: skip
MOST_HARMONICS = 4096
MOST_BLOCK = 400
LETTERS = (
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
    "!#$%&()*+,-./:;<=>?@[]^_`{|}~"
)
WEIGHT_BITS = 8

Gaussian = tuple[int, int]  # real and imaginary part


class Exponent(NamedTuple):
    """The numbers of a certificate for one exponent.

    sigma : turns omega + value, exactly, turns = base folds / 2. rows : v 2^bits by harmonic, as
    long as the allowed modes, without kappa none is 1. weights : by place, units 2^-WEIGHT_BITS.
    """

    sector: Sector
    turns: Fraction
    value: Fraction
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
        """Above what the value of the zero is off this one."""
        return self.radius * (1 << WEIGHT_BITS) / self.weights[self.kappa]

    def in_turns(self, orbit: Orbit) -> tuple[Fraction, Fraction]:
        """The ends of an interval that holds sigma* over the frequency, sigma* real.

        It is turns + value* / omega*.
        """
        least, most = orbit.omega - orbit.omega_off, orbit.omega + orbit.omega_off
        ends = [
            (self.value + off) / w for off in (-self.off, self.off) for w in (least, most)
        ]
        return self.turns + min(ends), self.turns + max(ends)

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
    turns = Fraction(base * sector.folds, 2)
    real = values[0] + turns * orbit.omega
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
    radius = dyadic(data["radius"], "radius")
    sigma = (turns, values[0], real, imaginary)
    return Exponent(sector, *sigma, bits, kappa, rows, block, weights, radius)


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
