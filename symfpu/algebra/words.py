"""Large integers in bulk: residues modulo many primes, limbs of 20 bits, and words for storage.

Sums and products are taken modulo each prime; only rounding needs the integers themselves. Both
changes of basis, residues to limbs (Chinese remainders) and limbs to residues, are products with
small matrices, exact in doubles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import repeat
from math import prod
from typing import Any, NamedTuple

import flint
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Words = NDArray[np.int64]

LIMB_BITS = 20
LIMB = 2.0**LIMB_BITS
LIMBS_PER_WORD = 3
LARGEST_DIVISOR = 2**42
LEAST_TOP = 8  # bits of the highest of the limbs that are rounded away
EXACT = 2.0**52  # integers below it are exact in doubles
WORD_BITS = LIMB_BITS * LIMBS_PER_WORD
NO_WORDS, NO_SIZES = (
    np.zeros((0, 0), dtype=np.int64),
    np.zeros(0),
)  # of one type for the loops
SIZE_ERROR = 2.0**-40  # of a sum of shares, one a prime, modulo one


class TooFewPrimes(ArithmeticError):
    """Integers of so many bits need more primes than there are, or than sums in doubles hold."""


@dataclass(frozen=True, eq=False)
class IntegerTable:
    """A table of signed integers, stored as words: the entry is sum_j words[..., j] 2^(60 j).

    words : (rows, columns, n), each word below 2^60 in size and with its own sign.
    """

    words: Words

    def __repr__(self) -> str:
        rows, columns, n = self.words.shape
        return f"IntegerTable({rows} x {columns} integers of up to {n * WORD_BITS} bits)"

    @property
    def shape(self) -> tuple[int, int]:
        return self.words.shape[0], self.words.shape[1]

    @property
    def size(self) -> int:
        return int(self.words.shape[0] * self.words.shape[1])

    def integers(self, columns: Any = slice(None)) -> NDArray[np.object_]:
        """The entries of some columns as Python's integers."""
        words = self.words[:, columns]
        total = words[..., -1].astype(object)
        for j in range(words.shape[-1] - 2, -1, -1):
            total = (total << WORD_BITS) + words[..., j].astype(object)
        return np.asarray(total)

    def floats(self, exponent: int = 0) -> Floats:
        """The entries times 2^exponent as doubles, correct to about an ulp.

        Infinite beyond their range.
        """
        total = np.zeros(self.shape)
        with np.errstate(over="ignore", invalid="ignore"):
            for j in range(self.words.shape[-1]):
                word = self.words[..., j].astype(np.float64)
                total += np.ldexp(word, j * WORD_BITS + exponent)
        return total

    @staticmethod
    def of(integers: NDArray[np.object_]) -> IntegerTable:
        """The table of an array (rows, columns) of Python's integers.

        >>> IntegerTable.of(np.array([[-5, 2**100]], dtype=object)).integers().tolist()
        [[-5, 1267650600228229401496703205376]]
        """
        longest = max((int(x).bit_length() for x in integers.ravel()), default=0)
        words, rest = [], integers.astype(object)
        half, whole = 2 ** (WORD_BITS - 1), 2**WORD_BITS
        count = max(1, -(-(longest + 2) // WORD_BITS))
        for _ in range(count):
            low = (rest + half) % whole - half
            words.append(low.astype(np.int64))
            rest = (rest - low) >> WORD_BITS
        assert not np.any(rest)
        return IntegerTable(np.stack(words, axis=-1))


class Rounding(NamedTuple):
    """Tables of `rounding_loops.round_columns`: moduli, inverses of cofactors, limbs of the
    cofactors (limbs, primes) and of the product of all primes (limbs,).
    """

    moduli: Floats
    inverses: Floats
    cofactor_limbs: Floats
    modulus_limbs: Floats


class Scale(NamedTuple):
    """A power of two to divide by: 2^bits.

    share : its inverse modulo each prime. lowest : (primes, limbs) what the limbs below it are
    times, to be taken away. top : two to as many bits as its highest limb has.
    """

    share: Floats
    lowest: Floats
    top: float


class ResidueBasis:
    """Integers below `bits` bits as residues modulo enough primes up to `largest`.

    Arrays of residues are (primes, count). Raises TooFewPrimes.

    largest : at most 2^27, so that a product of two residues is exact in doubles.
    """

    def __init__(self, bits: int, largest: int) -> None:
        # lazy: numba takes longer to import than all the rest
        from symfpu.algebra import kernels, rounding_loops

        self._kernels, self._loops = kernels, rounding_loops
        self._largest = largest
        self.longest_word = -(
            -(bits + 2) // WORD_BITS
        )  # words that its integers have at most
        # an overflow of the promised bits by a factor of eight is still seen
        self.primes = _primes(bits + 4, largest)
        self.moduli = np.array(self.primes, dtype=np.float64)
        modulus = self.modulus = prod(self.primes)
        spare = modulus.bit_length() - bits - 1
        self._limit = 2.0**-spare
        count = -(-modulus.bit_length() // LIMB_BITS) + 2
        cofactors = [modulus // p for p in self.primes]
        inverses = [pow(c, -1, p) for c, p in zip(cofactors, self.primes, strict=True)]
        self._inverses = self._centred(inverses)
        limbs = np.array([_limbs(c, count) for c in cofactors])
        self._cofactor_limbs = limbs.T.copy()
        self._modulus_limbs = np.array(_limbs(modulus, count))[:, None]
        powers = [self._centred([2 ** (LIMB_BITS * n)] * len(self)) for n in range(count)]
        self._powers = np.stack(powers, axis=1)
        self._turn = self._centred([2 ** (LIMB_BITS * count)] * len(self))
        self._rounding = Rounding(
            self.moduli,
            self._inverses,
            self._cofactor_limbs,
            self._modulus_limbs[:, 0].copy(),
        )
        self._scales: dict[int, Scale] = {}
        # limbs whose sums with residues are exact in doubles, beside one residue
        self._exact_limbs = int(2 * EXACT / (self.primes[0] * LIMB)) - 1

    def beginning(self, bits: int) -> ResidueBasis:
        """The basis of the first of these primes, as many as integers of so many bits need."""
        return ResidueBasis(bits, self._largest)

    def _centred(self, numbers: Sequence[int]) -> Floats:
        """One number for each prime, as residues in -p/2 .. p/2."""
        pairs = zip(numbers, self.primes, strict=True)
        return np.array([_centred(number % p, p) for number, p in pairs])

    def __len__(self) -> int:
        return len(self.primes)

    def limbs(self, residues: Floats, drop: int = 0) -> Floats:
        """The integers / 2^(20 drop), rounded to the nearest, as balanced limbs, lowest first.

        residues : overwritten. Returns (limbs, count). Raises OverflowError if an integer exceeds
        the promised bits.
        """
        self._kernels.multiply_rows(residues, self._inverses, self.moduli)
        share = (1 / self.moduli) @ residues
        turns = np.rint(share)
        self._check(float(np.abs(share - turns).max(initial=0.0)), self._limit)
        limbs = self._cofactor_limbs @ residues - self._modulus_limbs * turns
        for n in range(len(limbs) - 1):
            carry = np.rint(limbs[n] / LIMB)
            limbs[n] -= carry * LIMB
            limbs[n + 1] += carry
        return np.asarray(limbs[drop:])

    def _scale(self, bits: int) -> Scale:
        if bits not in self._scales:
            count = max(1, -(-bits // LIMB_BITS))
            shares = [pow(2, -bits, p) for p in self.primes]
            lowest = [
                self._centred([-share * 2 ** (LIMB_BITS * k) for share in shares])
                for k in range(count)
            ]
            top = 2.0 ** (bits - LIMB_BITS * (count - 1))
            table = np.stack(lowest, axis=1)
            self._scales[bits] = Scale(self._centred(shares), table, top)
        return self._scales[bits]

    def round_in_place(
        self,
        residues: Floats,
        wanted: NDArray[np.bool_],
        bits: int,
        sizes: Floats | None = None,
    ) -> None:
        """The wanted integers / 2^bits, rounded to the nearest; zeros where not wanted.

        residues : (primes, count), below a prime in size, overwritten. bits : as `whole_places`
        gives them. sizes : (count,), filled with the moduli of the integers over the product of
        all primes, off by less than SIZE_ERROR. Raises OverflowError as `limbs` does.
        """
        distances = NO_SIZES if sizes is None else sizes
        self._round(residues, wanted, bits, self, NO_WORDS, distances)

    def rounded_words(
        self, residues: Floats, wanted: NDArray[np.bool_], bits: int, first: ResidueBasis
    ) -> Words:
        """The same, and words of the wanted ones, (wanted, n).

        first : the basis of the first primes, as many as hold what is rounded.
        """
        count = int(np.count_nonzero(wanted))
        words = np.zeros((count, first.longest_word), dtype=np.int64)
        self._round(residues, wanted, bits, first, words, NO_SIZES)
        used = first.longest_word
        while used > 1 and not words[:, used - 1].any():
            used -= 1
        return words[:, :used]

    def _round(
        self,
        residues: Floats,
        wanted: NDArray[np.bool_],
        bits: int,
        first: ResidueBasis,
        words: Words,
        sizes: Floats,
    ) -> None:
        scale = self._scale(bits)
        farthest, farther = self._loops.round_columns(
            residues, wanted, self._rounding, LIMB, scale, first._rounding, words, sizes
        )
        self._check(farthest, self._limit)
        self._check(farther, first._limit)

    def _check(self, farthest: float, limit: float) -> None:
        """OverflowError where a sum of shares is too far from a whole number."""
        if farthest > limit + SIZE_ERROR:
            raise OverflowError("an integer exceeds the range of the residues")

    def residues(self, limbs: Floats) -> Floats:
        """Residues (primes, count) of the integers given by balanced limbs (limbs, count)."""
        total = np.zeros((len(self), limbs.shape[1]))
        for first in range(0, len(limbs), self._exact_limbs):
            some = slice(first, first + self._exact_limbs)
            total += self._powers[:, : len(limbs)][:, some] @ limbs[some]
            self._kernels.reduce_rows(total, self.moduli)
        return total

    def reduce(self, residues: Floats) -> None:
        """Integers (primes, ...) below 2^52 in size modulo each prime; overwritten."""
        flat = residues.reshape(len(self), -1)
        assert np.shares_memory(flat, residues) or not residues.size
        self._kernels.reduce_rows(flat, self.moduli)

    def scale(self, residues: Floats, factors: Floats) -> None:
        """Multiply residues (primes, count), which are overwritten, by one number (primes,)."""
        self._kernels.multiply_rows(residues, factors, self.moduli)

    def multiply_places(
        self, residues: Floats, wanted: NDArray[np.bool_], factors: Floats, places: Any
    ) -> None:
        """residues[:, n] *= factors[:, places[n]] where wanted; else zero. Of any shape."""
        some, at = wanted.ravel(), places.ravel()
        self._kernels.multiply_places(residues, some, factors, at, self.moduli)

    def of_integers(self, integers: NDArray[np.object_]) -> Floats:
        """Residues (primes, ...) of Python's integers, of any size."""
        flat = list(map(int, np.asarray(integers, dtype=object).ravel().tolist()))
        limbs = limbs_of(flat)
        total = np.zeros((len(self), len(flat)))
        step = self._powers.shape[1]
        for start in range(len(limbs) - len(limbs) % step, -1, -step):
            # by Horner's rule over so many limbs at once
            self._kernels.multiply_rows(total, self._turn, self.moduli)
            total += self.residues(limbs[start : start + step])
        self._kernels.reduce_rows(total, self.moduli)
        return total.reshape(len(self), *np.shape(integers))


def whole_places(bits: int) -> int:
    """At least so many bits, so that rounding by limbs is to the nearest.

    Limbs below a highest one of r bits round it by less than 2^-r of a unit more.
    """
    rest = bits % LIMB_BITS
    return bits + LEAST_TOP - rest if 0 < rest < LEAST_TOP else bits


def limbs_of(integers: Sequence[int]) -> Floats:
    """Limbs (limbs, count) of Python's integers, 0 .. 2^20 - 1 but the highest, which is signed.

    >>> limbs_of([-1, 2**20 + 3]).tolist()
    [[1048575.0, 3.0], [-1.0, 1.0]]
    """
    longest = max(map(int.bit_length, integers), default=0) + 1
    pairs = -(-longest // (2 * LIMB_BITS))
    size = 2 * LIMB_BITS // 8 * pairs
    # shifted to be positive, which turns the sign, the highest bit
    shifted = map((1 << (8 * size - 1)).__add__, integers)
    as_bytes: Any = int.to_bytes
    joined = b"".join(map(as_bytes, shifted, repeat(size), repeat("little")))
    bytes_of = np.frombuffer(joined, dtype=np.uint8).reshape(len(integers), pairs, 5)
    weights = 256.0 ** np.arange(3)
    limbs = np.empty((pairs, 2, len(integers)))
    low, middle, high = bytes_of[..., :2], bytes_of[..., 2], bytes_of[..., 3:]
    limbs[:, 0] = (low @ weights[:2] + (middle & 15) * weights[2]).T
    limbs[:, 1] = ((middle >> 4) + high @ (16 * weights[:2])).T
    limbs[-1, 1] -= 2.0 ** (LIMB_BITS - 1)
    return limbs.reshape(2 * pairs, len(integers))


def divided(limbs: Floats, divisor: int) -> Floats:
    """Integers / (2^20 divisor) as balanced limbs, off by less than 0.5 + 2^-20.

    limbs : balanced, (limbs, count), lowest first. divisor : positive.

    >>> divided(np.array([[1.0], [12.0], [0.0]]), 4).ravel().tolist()
    [3.0, 0.0]
    """
    # long division; remainders times 2^20 fit into 63 bits
    kind = np.int64 if divisor < LARGEST_DIVISOR else object
    whole = limbs.astype(np.int64).astype(kind)
    rest = np.zeros_like(whole[0])
    for n in range(len(whole) - 1, -1, -1):
        value = (rest << LIMB_BITS) + whole[n]
        whole[n] = value // divisor
        rest = value - whole[n] * divisor
    quotients = whole.astype(np.float64)
    for n in range(len(quotients) - 1):
        carry = np.rint(quotients[n] / LIMB)
        quotients[n] -= carry * LIMB
        quotients[n + 1] += carry
    return np.asarray(quotients[1:])


def words_of(limbs: Floats) -> Words:
    """Words (count, n) of the integers given by limbs (limbs, count)."""
    top = np.flatnonzero(limbs.any(axis=1))
    count = int(top[-1]) + 1 if len(top) else 1
    used = limbs[:count].astype(np.int64)
    longest = -(-count // LIMBS_PER_WORD)
    words = np.zeros((limbs.shape[1], longest), dtype=np.int64)
    for n, row in enumerate(used):
        word, place = divmod(n, LIMBS_PER_WORD)
        words[:, word] += row << (LIMB_BITS * place)
    return words


def _primes(bits: int, largest: int) -> tuple[int, ...]:
    """The largest odd primes up to `largest` whose product has more than `bits` bits.

    No more than can be summed exactly in doubles, as residues times limbs.
    """
    most = int(4 * EXACT / (largest * LIMB))
    primes: list[int] = []
    candidate = largest - (largest - 1) % 2
    product = 1
    while product.bit_length() <= bits:
        if candidate < 3 or len(primes) == most:
            raise TooFewPrimes(f"too few primes up to {largest} for {bits} bits")
        if flint.fmpz(candidate).is_prime():
            primes.append(candidate)
            product *= candidate
        candidate -= 2
    return tuple(primes)


def _limbs(number: int, count: int) -> list[float]:
    """Balanced limbs of a non-negative number, lowest first."""
    limbs = []
    for _ in range(count):
        low = ((number + 2 ** (LIMB_BITS - 1)) % 2**LIMB_BITS) - 2 ** (LIMB_BITS - 1)
        limbs.append(float(low))
        number = (number - low) >> LIMB_BITS
    assert number == 0
    return limbs


def _centred(residue: int, prime: int) -> float:
    return float(residue - prime if residue > prime // 2 else residue)
