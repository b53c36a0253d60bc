"""The approximate inverse and the weights: choices of the prover, which need no proof."""

from collections.abc import Iterable
from typing import NamedTuple

from symfpu.checkers.existence.claim import Claim, Place
from symfpu.checkers.existence.reading import unpacked
from symfpu.checkers.reading import Json, need, whole

BORDER: Place = (0, 0)  # the unknown frequency as a column, the condition as a row
MOST_SLOPES = 4096  # harmonics of slopes and of weights
MOST_BLOCK = 600


class Inverse(NamedTuple):
    """A: integers times 2^-bits on the block, 1/lambda elsewhere; and w = v nu^n.

    slope_harmonics : K. free : v is 1 beyond this harmonic. places : those up to free + K.
    weights : v 2^weight_bits of every place. block : the places of the block. rows : of A there.
    An unknown frequency is the place BORDER, the first of the places and of the block.
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
    K = whole(data["slope_harmonics"], 1, MOST_SLOPES, "slope_harmonics")
    free = whole(data["free"], 1, MOST_SLOPES, "free")
    weight_bits = whole(data["weight_bits"], 0, 64, "weight_bits")
    first = [BORDER] if claim.bordered else []
    places = first + [(n, q) for n in range(free + K + 1) for q in claim.allowed(n)]
    weighed = [place for place in places if place[0] <= free]
    given = unpacked(data["weights"], "weights")
    need(len(given) == len(weighed), "wrong number of weights")
    weights = dict.fromkeys(places, 1 << weight_bits)
    for place, v in zip(weighed, given, strict=True):
        weights[place] = whole(v, 1 << weight_bits, 2**80, "a weight")
    block = first + [(n, q) for n, q in data["block"]]
    need(0 < len(block) <= MOST_BLOCK, "wrong size of the block")
    inside = block == sorted(set(block)) and set(block) <= set(weighed)
    need(inside, "the block is not of ascending places with weights")
    rows = [unpacked(text, "the inverse") for text in data["inverse"]]
    bits = whole(data["inverse_bits"], 0, 128, "inverse_bits")
    for row in rows:
        need(len(row) == len(block), "the inverse is not square")
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
