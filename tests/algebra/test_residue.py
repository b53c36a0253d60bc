"""The residue ring: exact arithmetic on doubles, and the same series as the symbolic ring modulo a prime."""

import random
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sympy import nextprime

from symfpu import Chain, lindstedt
from symfpu.algebra.grading import Grading
from symfpu.algebra.kernels import multiply_elements
from symfpu.algebra.residue import PRIME_BITS, ResidueRing, cosine_table, largest_modulus, longest_sum
from symfpu.algebra.selection import CosineModes
from symfpu.errors import VanishingResidue
from symfpu.proofs.certificates import random_point
from symfpu.series.coefficients import ResiduePoint
from symfpu.series.residues import residue_series

PRIMES = (97, 65537, nextprime(2**39), 2**40 - 87)
residues = st.integers(-(2**39), 2**39)


@given(st.lists(st.tuples(residues, residues), min_size=1, max_size=40), st.sampled_from(PRIMES))
def test_products_are_exact_modulo_the_prime(pairs, prime):
    a, b = (np.array([balanced(pair[i], prime) for pair in pairs], dtype=float) for i in (0, 1))
    out = np.empty_like(a)
    multiply_elements(a, b, float(prime), out)
    assert np.abs(out).max() <= prime / 2
    assert [int(c) % prime for c in out] == [int(x) * int(y) % prime for x, y in zip(a, b, strict=True)]


def balanced(number, prime):
    residue = number % prime
    return residue - prime if residue > prime // 2 else residue


def ring(N=8, seeds=(1, 2), degree=3):
    point = random_point(N, len(seeds), degree, random.Random(3))
    return ResidueRing(CosineModes(N, seeds, Grading(len(seeds), degree)), point.prime, point.root)


@pytest.mark.parametrize("N", [2, 5, 12])
def test_cosines_satisfy_their_addition_theorem_and_vanish_where_they_must(N):
    point = random_point(N, 1, 2, random.Random(N))
    table = cosine_table(N, point.prime, point.root)
    assert table[0] == 1
    assert table[N] == 0
    assert table[2 * N] == point.prime - 1
    for k in range(N + 1):
        assert (2 * table[k] ** 2 - 1 - table[2 * k]) % point.prime == 0
    assert len(set(table)) == 2 * N + 1


@pytest.mark.parametrize(("seeds", "degree"), [(1, 251), (2, 31), (4, 12), (5, 10)])
def test_sums_stay_exact(seeds, degree):
    """The longest sum of products, each below p/2 (1 + 2^-10) after its reduction and doubled for symmetry, is below 2^53."""
    grading = Grading(min(seeds, 2), min(degree, 12))
    counted = max(int(np.prod(row + 1)) for row in grading.exponents(grading.degree))
    assert counted == longest_sum(grading.seeds, grading.degree)
    assert longest_sum(seeds, degree) * largest_modulus(seeds, degree) <= 2**52
    assert largest_modulus(seeds, degree) <= 2**PRIME_BITS


CASES = [
    (Chain(N=7, alpha=1), (2, 5), 4),
    (Chain(N=8, beta=1), (1, 6), 2),
    (Chain(N=6, alpha=1, beta=7), (1, 4), 4),
    (Chain(N=2, alpha=1, beta=3), (1,), 4),
    (Chain(N=5, alpha=1), (1, 2, 3), 3),
    (Chain(N=6, beta=1), (2, 3), 2),
]


@pytest.mark.parametrize(("chain", "seeds", "order"), CASES, ids=str)
def test_series_is_the_universal_form_modulo_the_prime(chain, seeds, order):
    point = random_point(chain.N, len(seeds), 1 + chain.degree_step * order, random.Random(7))
    ours, universal = residue_series(chain, seeds, point, order), lindstedt(chain, seeds, order=order)
    for mine, symbols in zip((*ours.coordinates, *ours.corrections), (*universal.coordinates, *universal.corrections), strict=True):
        expected = [modulo(value, chain.N, seeds, point) for value in np.ravel(symbols)]
        assert [int(value) % point.prime for value in mine.ravel()] == expected


def modulo(expression, N, seeds, point):
    """A polynomial in the symbols L_q(nu) at a point."""
    cosines, p = cosine_table(N, point.prime, point.root), point.prime
    values = {}
    for symbol in getattr(expression, "free_symbols", ()):
        q, *nu = map(int, re.findall(r"-?\d+", str(symbol)))
        square = 2 - 2 * cosines[2 * q]
        own = point.frequencies[seeds.index(q)] ** 2 if q in seeds else square
        drive = sum(n * w for n, w in zip(nu, point.frequencies, strict=True))
        values[symbol] = square * pow(own - drive**2, -1, p) % p
    return int(expression.subs(values)) % p if values else int(expression) % p


def test_vanishing_divisor_is_named():
    """The frequency Omega_2 / 2 makes the divisor of mode 2 and harmonic 2 vanish at order 1."""
    good = random_point(8, 1, 3, random.Random(1))
    square = (2 - 2 * cosine_table(8, good.prime, good.root)[2 * 2]) % good.prime
    omega_2 = pow(good.root, 2, good.prime) - pow(good.root, -2, good.prime)
    i = pow(good.root, 8, good.prime)
    omega_2 = omega_2 * pow(i, -1, good.prime) % good.prime
    assert (omega_2**2 - square) % good.prime == 0
    bad = ResiduePoint(good.prime, good.root, (omega_2 * pow(2, -1, good.prime) % good.prime,))
    with pytest.raises(VanishingResidue, match="take another point"):
        residue_series(Chain(N=8, alpha=1), (1,), bad, 1)
