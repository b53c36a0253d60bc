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
LARGEST = 2**40
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


@given(lists)
def test_residues_of_integers_are_the_centred_remainders(integers):
    for p, residues in zip(BASIS.primes, BASIS.of_integers(row(integers)), strict=True):
        assert np.abs(residues).max() <= p // 2
        assert [int(r) % p for r in residues] == [x % p for x in integers]


@given(lists)
def test_chinese_remainders_give_the_integers_back(integers):
    limbs = BASIS.limbs(BASIS.of_integers(row(integers)))
    assert of_limbs(limbs) == integers
    assert np.abs(limbs[:-1]).max() <= 2 ** (LIMB_BITS - 1)


@given(lists)
def test_limbs_give_the_residues_back(integers):
    residues = BASIS.of_integers(row(integers))
    assert (BASIS.residues(BASIS.limbs(residues.copy())) == residues).all()


@given(lists)
def test_words_give_the_integers_back(integers):
    words = words_of(BASIS.limbs(BASIS.of_integers(row(integers))))
    assert of_words(words) == integers
    assert np.abs(words).max() < 2**WORD_BITS


@given(lists, st.integers(0, BITS // LIMB_BITS + 1))
def test_dropped_limbs_round_to_the_nearest(integers, drop):
    """The remainder of balanced limbs is at most 2^19 (1 + 2^20 + ..) / 2^(20 drop): half a unit and one part in 2^20."""
    rounded = of_limbs(BASIS.limbs(BASIS.of_integers(row(integers)), drop))
    unit = 2 ** (LIMB_BITS * drop)
    assert all(abs(Fraction(x, unit) - r) <= NEAREST for x, r in zip(integers, rounded, strict=True))


@given(st.integers(0, 2 ** (BITS - 60)), st.sampled_from([-1, 1]), st.sampled_from([-1, 1]))
def test_rounding_just_off_the_half_goes_to_the_nearer_side(whole, sign, side):
    """A quarter of a unit off the half nobody may go wrong."""
    unit = 2**40
    number = sign * (whole * unit + unit // 2 + side * unit // 4)
    (rounded,) = of_limbs(BASIS.limbs(BASIS.of_integers(row([number])), drop=2))
    assert rounded == sign * (whole + (side > 0))


@given(st.integers(2 ** (BITS + 1), 2 ** (BITS + 2)), st.sampled_from([-1, 1]), lists)
def test_an_integer_beyond_the_promised_bits_is_seen(number, sign, others):
    """The basis has four bits to spare: up to eight times the promised range nothing wraps around unseen."""
    with pytest.raises(OverflowError, match="range"):
        BASIS.limbs(BASIS.of_integers(row([*others, sign * number])))


@pytest.mark.parametrize("size", [2**BITS - 1, 2 ** (BITS - 1), 1, 0])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_ends_of_the_promised_range_pass(size, sign):
    assert of_limbs(BASIS.limbs(BASIS.of_integers(row([sign * size])))) == [sign * size]


@pytest.mark.long
@pytest.mark.parametrize(("bits", "largest"), [(40, 2**40), (400, 2**40), (4000, 2**40), (12_000, 2**40), (400, 2**33), (4000, 5_000_011)])
def test_round_trips_at_every_size_of_the_basis(bits, largest):
    """Three hundred primes: sums of limbs stay exact in doubles."""
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


SMALL = ResidueBasis(BITS, 2**23)


FIRST = {basis: ResidueBasis(BITS, max(basis.primes)) for basis in (SMALL, BASIS)}


@pytest.mark.parametrize("basis", [SMALL, BASIS], ids=["small primes", "large primes"])
@given(st.lists(st.tuples(within, st.booleans()), max_size=300), st.integers(0, BITS // LIMB_BITS))
def test_rounding_in_place_is_that_by_limbs(basis, entries, drop):
    """Entries that are not wanted become zero, and have no words."""
    integers, wanted = [x for x, _ in entries], np.array([kept for _, kept in entries], dtype=bool)
    residues = basis.of_integers(row(integers))
    limbs = basis.limbs(residues[:, wanted], drop)
    expected = np.zeros_like(residues)
    expected[:, wanted] = basis.residues(limbs)
    again = residues.copy()
    words = basis.rounded_words(residues, wanted, LIMB_BITS * drop, FIRST[basis])
    basis.round_in_place(again, wanted, LIMB_BITS * drop)
    assert np.array_equal(residues, expected)
    assert np.array_equal(again, expected)
    assert of_words(words) == of_words(words_of(limbs))


@pytest.mark.parametrize("basis", [SMALL, BASIS], ids=["small primes", "large primes"])
@given(st.lists(st.tuples(within, st.booleans()), max_size=300))
def test_sizes_are_moduli_over_the_product_of_all_primes(basis, entries):
    """Those before rounding; zero where they are not wanted."""
    integers, wanted = [x for x, _ in entries], np.array([kept for _, kept in entries], dtype=bool)
    sizes = np.full(len(entries), np.nan)
    basis.round_in_place(basis.of_integers(row(integers)), wanted, LIMB_BITS, sizes)
    for x, kept, size in zip(integers, wanted, sizes, strict=True):
        assert size == 0 or kept
        assert abs(Fraction(abs(x) * int(kept), prod(basis.primes)) - Fraction(float(size))) < SIZE_ERROR


@pytest.mark.parametrize("basis", [SMALL, BASIS], ids=["small primes", "large primes"])
@given(lists, st.integers(0, BITS + LIMB_BITS))
def test_any_number_of_places_is_rounded_to_the_nearest(basis, integers, places):
    """Half a unit, and what the limbs below the highest one add to it; words are those of the residues."""
    bits = whole_places(places)
    assert places <= bits < places + LEAST_TOP
    residues = basis.of_integers(row(integers))
    words = of_words(basis.rounded_words(residues, np.ones(len(integers), dtype=bool), bits, FIRST[basis]))
    assert all(abs(Fraction(x, 2**bits) - r) <= NEAREST for x, r in zip(integers, words, strict=True))
    assert np.array_equal(residues, basis.of_integers(row(words)))


@pytest.mark.parametrize("basis", [SMALL, BASIS], ids=["small primes", "large primes"])
@given(st.lists(st.tuples(st.integers(0, 3), st.booleans()), min_size=1, max_size=50))
def test_products_with_factors_in_their_places(basis, entries):
    factors = row([-(2**60), 5, 0, 2**31])
    places, wanted = np.array([at for at, _ in entries]), np.array([kept for _, kept in entries])
    residues = basis.of_integers(row([7**20 + n for n in range(len(entries))]))
    basis.multiply_places(residues, wanted, basis.of_integers(factors), places)
    expected = [(7**20 + n) * factors[at] if kept else 0 for n, (at, kept) in enumerate(entries)]
    for p, found in zip(basis.primes, residues, strict=True):
        assert [int(x) % p for x in found] == [x % p for x in expected]


@pytest.mark.parametrize("divisor", [2, 4, 1008, 10**4])
def test_a_divisor_of_all_primes_less_one(divisor):
    basis = ResidueBasis(BITS, 2**23, divisor)
    assert all(p % divisor == 1 for p in basis.primes)
    assert prod(basis.primes) > 2 ** (BITS + 4)
    assert len(set(basis.primes)) == len(basis)


def test_too_few_primes_are_named():
    with pytest.raises(TooFewPrimes, match="too few primes up to 50"):
        ResidueBasis(BITS, 50)


def test_which_primes_are_small():
    assert SMALL.small
    assert not BASIS.small


@pytest.mark.parametrize("sign", [-1, 1])
def test_rounding_in_place_sees_an_integer_beyond_the_promised_bits(sign):
    residues = SMALL.of_integers(row([1, sign * 2 ** (BITS + 1)]))
    with pytest.raises(OverflowError, match="range"):
        SMALL.round_in_place(residues, np.ones(2, dtype=bool), LIMB_BITS)


@given(st.lists(st.integers(-(2**900), 2**900), max_size=5))
def test_residues_of_integers_of_any_size(integers):
    """Longer ones than those of the basis go by Horner's rule."""
    for p, residues in zip(SMALL.primes, SMALL.of_integers(row(integers)), strict=True):
        assert [int(r) % p for r in residues] == [x % p for x in integers]
        assert np.abs(residues).max(initial=0) <= p // 2
