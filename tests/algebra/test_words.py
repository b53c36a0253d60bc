"""Large integers in bulk: every change of basis is exact, rounding is to the nearest, and what does not fit is seen."""

from fractions import Fraction
from math import prod

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from symfpu.algebra.words import (
    LEAST_TOP,
    LIMB_BITS,
    SIZE_ERROR,
    WORD_BITS,
    IntegerTable,
    ResidueBasis,
    TooFewPrimes,
    whole_places,
    words_of,
)
from tests.tolerances import EPS, NEAREST

BITS = 150
LARGEST = 2**23
BASIS = ResidueBasis(BITS, LARGEST)

within = st.integers(-(2**BITS) + 1, 2**BITS - 1)
lists = st.lists(within, min_size=1, max_size=6)
tables = st.integers(0, 4).flatmap(lambda columns: st.lists(st.lists(st.integers(), min_size=columns, max_size=columns), max_size=4))


def row(integers):
    return np.array(integers, dtype=object)


def of_limbs(limbs):
    """Python's integers of balanced limbs (limbs, count)."""
    return [sum(int(limb) << (LIMB_BITS * n) for n, limb in enumerate(column)) for column in limbs.T]


def of_words(words):
    return IntegerTable(words[:, None, :]).integers()[:, 0].tolist()


def test_the_primes_are_distinct_primes_below_the_largest_and_are_enough():
    assert len(set(BASIS.primes)) == len(BASIS) == len(BASIS.primes)
    assert all(pow(2, p - 1, p) == 1 and p % 2 and p <= LARGEST for p in BASIS.primes)
    assert prod(BASIS.primes) > 2 ** (BITS + 1)


@given(lists | st.lists(st.integers(-(2**900), 2**900), max_size=5))
def test_residues_of_integers_are_the_centred_remainders(integers):
    """Integers longer than those of the basis go by Horner's rule."""
    for p, residues in zip(BASIS.primes, BASIS.of_integers(row(integers)), strict=True):
        assert np.abs(residues).max(initial=0) <= p // 2
        assert [int(r) % p for r in residues] == [x % p for x in integers]


@given(lists)
def test_limbs_and_words_give_integers_and_residues_back(integers):
    residues = BASIS.of_integers(row(integers))
    limbs = BASIS.limbs(residues.copy())
    words = words_of(limbs)
    assert of_limbs(limbs) == of_words(words) == integers
    assert (BASIS.residues(limbs) == residues).all()
    assert np.abs(limbs[:-1]).max() <= 2 ** (LIMB_BITS - 1)
    assert np.abs(words).max() < 2**WORD_BITS


@given(lists, st.integers(0, BITS // LIMB_BITS + 1))
def test_dropped_limbs_round_to_the_nearest(integers, drop):
    """The remainder of balanced limbs is at most 2^19 (1 + 2^20 + ..) / 2^(20 drop): half a unit and one part in 2^20."""
    rounded = of_limbs(BASIS.limbs(BASIS.of_integers(row(integers)), drop))
    unit = 2 ** (LIMB_BITS * drop)
    assert all(abs(Fraction(x, unit) - r) <= NEAREST for x, r in zip(integers, rounded, strict=True))


@given(st.integers(2 ** (BITS + 1), 2 ** (BITS + 2)), st.sampled_from([-1, 1]), lists)
def test_an_integer_beyond_the_promised_bits_is_seen(number, sign, others):
    """The basis has four bits to spare: up to eight times the promised range nothing wraps around unseen."""
    residues = BASIS.of_integers(row([*others, sign * number]))
    for leave in (BASIS.limbs, lambda x: BASIS.round_in_place(x, np.ones(len(others) + 1, dtype=bool), LIMB_BITS)):
        with pytest.raises(OverflowError, match="range"):
            leave(residues.copy())


@pytest.mark.long
@pytest.mark.parametrize(("bits", "largest"), [(40, 2**23), (400, 2**27), (4000, 5_000_011), (25_000, 2**23)])
def test_round_trips_at_every_size_of_the_basis(bits, largest):
    """Up to nearly as many primes as doubles hold: sums of limbs stay exact."""
    basis = ResidueBasis(bits, largest)
    generator = np.random.default_rng(bits)
    integers = [int.from_bytes(generator.bytes(bits // 8), "little", signed=True) for _ in range(5)] + [2**bits - 1, 1 - 2**bits]
    limbs = basis.limbs(basis.of_integers(row(integers)))
    assert of_limbs(limbs) == of_words(words_of(limbs)) == integers
    assert (basis.residues(limbs) == basis.of_integers(row(integers))).all()


def test_no_integers_at_all():
    empty = BASIS.of_integers(np.zeros(0, dtype=object))
    assert empty.shape == (len(BASIS), 0)
    limbs = BASIS.limbs(empty)
    assert limbs.shape[1] == 0
    assert words_of(limbs).shape == (0, 1)


@given(tables)
def test_tables_hold_any_integers(rows):
    integers = np.array(rows, dtype=object).reshape(len(rows), len(rows[0]) if rows else 0)
    table = IntegerTable.of(integers)
    assert table.shape == integers.shape
    assert table.size == integers.size
    assert table.integers().tolist() == integers.tolist()
    assert np.abs(table.words).max(initial=0) < 2**WORD_BITS


@pytest.mark.parametrize("power", [58, 59, 60, 61, 119, 120, 1000, 40_000])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("off", [-1, 0, 1])
def test_tables_hold_integers_at_the_borders_of_words(power, sign, off):
    number = sign * 2**power + off
    assert IntegerTable.of(row([[number, 0, -number]])).integers().tolist() == [[number, 0, -number]]


def test_columns_are_picked():
    table = IntegerTable.of(row([[1, 2**70, 3], [4, 5, -(2**90)]]))
    assert table.integers([1]).tolist() == [[2**70], [5]]
    assert table.integers(slice(1, 3)).tolist() == [[2**70, 3], [5, -(2**90)]]
    assert repr(table) == "IntegerTable(2 x 3 integers of up to 120 bits)"


@given(st.lists(st.integers(-(2**900), 2**900), min_size=1, max_size=5), st.integers(-1000, 100))
def test_floats_are_the_numbers_to_about_an_ulp(integers, exponent):
    """The first word may be one, the next half a word of the other sign: two roundings of the larger, one of the sum."""
    values = IntegerTable.of(row([integers])).floats(exponent)[0]
    for x, value in zip(integers, values, strict=True):
        exact = Fraction(x) * Fraction(2) ** exponent
        assert abs(Fraction(float(value)) - exact) <= 4 * Fraction(EPS) * abs(exact)


def test_floats_of_entries_that_only_fit_with_their_exponent():
    assert IntegerTable.of(row([[3 << 4000, 0]])).floats(-4000).tolist() == [[3.0, 0.0]]
    assert IntegerTable.of(row([[1]])).floats(-4000).tolist() == [[0.0]]


FIRST = BASIS.beginning(BITS)


@given(st.lists(st.tuples(within, st.booleans()), max_size=300), st.integers(0, BITS // LIMB_BITS))
def test_rounding_in_place_is_that_by_limbs(entries, drop):
    """Entries that are not wanted become zero, and have no words."""
    integers, wanted = [x for x, _ in entries], np.array([kept for _, kept in entries], dtype=bool)
    residues = BASIS.of_integers(row(integers))
    limbs = BASIS.limbs(residues[:, wanted], drop)
    expected = np.zeros_like(residues)
    expected[:, wanted] = BASIS.residues(limbs)
    again = residues.copy()
    words = BASIS.rounded_words(residues, wanted, LIMB_BITS * drop, FIRST)
    BASIS.round_in_place(again, wanted, LIMB_BITS * drop)
    assert np.array_equal(residues, expected)
    assert np.array_equal(again, expected)
    assert of_words(words) == of_words(words_of(limbs))


@given(st.lists(st.tuples(within, st.booleans()), max_size=300))
def test_sizes_are_moduli_over_the_product_of_all_primes(entries):
    """Those before rounding; zero where they are not wanted."""
    integers, wanted = [x for x, _ in entries], np.array([kept for _, kept in entries], dtype=bool)
    sizes = np.full(len(entries), np.nan)
    BASIS.round_in_place(BASIS.of_integers(row(integers)), wanted, LIMB_BITS, sizes)
    for x, kept, size in zip(integers, wanted, sizes, strict=True):
        assert size == 0 or kept
        assert abs(Fraction(abs(x) * int(kept), prod(BASIS.primes)) - Fraction(float(size))) < SIZE_ERROR


@given(lists, st.integers(0, BITS + LIMB_BITS))
def test_any_number_of_places_is_rounded_to_the_nearest(integers, places):
    """Half a unit, and what the limbs below the highest one add to it; words are those of the residues."""
    bits = whole_places(places)
    assert places <= bits < places + LEAST_TOP
    residues = BASIS.of_integers(row(integers))
    words = of_words(BASIS.rounded_words(residues, np.ones(len(integers), dtype=bool), bits, FIRST))
    assert all(abs(Fraction(x, 2**bits) - r) <= NEAREST for x, r in zip(integers, words, strict=True))
    assert np.array_equal(residues, BASIS.of_integers(row(words)))


@given(st.lists(st.tuples(st.integers(0, 3), st.booleans()), min_size=1, max_size=50))
def test_products_with_factors_in_their_places(entries):
    factors = row([-(2**60), 5, 0, 2**31])
    places, wanted = np.array([at for at, _ in entries]), np.array([kept for _, kept in entries])
    residues = BASIS.of_integers(row([7**20 + n for n in range(len(entries))]))
    BASIS.multiply_places(residues, wanted, BASIS.of_integers(factors), places)
    expected = [(7**20 + n) * factors[at] if kept else 0 for n, (at, kept) in enumerate(entries)]
    for p, found in zip(BASIS.primes, residues, strict=True):
        assert [int(x) % p for x in found] == [x % p for x in expected]


def test_too_few_primes_are_named():
    with pytest.raises(TooFewPrimes, match="too few primes up to 50 "):
        ResidueBasis(BITS, 50)
    with pytest.raises(TooFewPrimes, match=r"too few primes up to 8388608 for 50000 bits"):
        ResidueBasis(50_000 - 4, 2**23)
