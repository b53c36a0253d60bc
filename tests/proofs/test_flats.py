"""The flats of the propagation rule, against every seed set of every short chain."""

from itertools import combinations, product

import numpy as np
import pytest

from symfpu.proofs.flats import Arrangement, degree_of, flats, rank


def signature(model, order, N, seeds):
    """Which signed sums of up to 2d seeds are multiples of 2N, by trying all signs of all of them."""
    most = 2 * degree_of(model, order)
    found = set()
    for m in product(range(-most, most + 1), repeat=len(seeds)):
        size = sum(map(abs, m))
        if size <= most and (model == "alpha" or size % 2 == 0):
            total = sum(n * q for n, q in zip(m, seeds, strict=True))
            if total % (2 * N) == 0:
                found.add((m, total // (2 * N)))
    return frozenset(found)


# every representative is below the last length
SHORT = [("alpha", 1, 3, 17), ("alpha", 2, 1, 17), ("beta", 1, 2, 17), ("beta", 2, 1, 17)]
LONGER = [pytest.param(*case, marks=pytest.mark.long) for case in (("alpha", 2, 3, 50), ("alpha", 3, 1, 28))]


@pytest.mark.parametrize(("model", "s", "order", "longest"), [*SHORT, *LONGER])
def test_flats_are_what_the_seed_sets_of_all_short_chains_make(model, s, order, longest):
    made = {}
    for N in range(2, longest):
        for seeds in combinations(range(1, N), s):
            made.setdefault(signature(model, order, N, seeds), (N, seeds))
    assert sorted(made.values()) == sorted((flat.N, flat.seeds) for flat in flats(model, s, order))


def sets_of_sums(longest, inside):
    """How many different sets {(m, w): m.q = 2wN, |m| <= 8} the points q/N of a region make, N up to the longest."""
    every = [m for m in product(range(-8, 9), repeat=2) if 0 < sum(map(abs, m)) <= 8 and m > (0, 0)]
    normals = np.array(every).T
    found = set()
    for N in range(1, longest + 1):
        points = [q for q in product(range(N + 1), repeat=2) if inside(*q, N)]
        sums = np.array(points, dtype=np.int64).reshape(-1, 2) @ normals
        # every w is below 8
        met = np.where(sums % (2 * N) == 0, sums // (2 * N), 99).astype(np.int8)
        found |= set(map(bytes, met))
    return len(found)


def test_which_region_has_which_number_of_flats():
    # of alpha, two seeds, order 3: 1057 flats hold seed sets; 1080 need the faces q_1 = 0, q_1 = q_2
    assert len(flats("alpha", 2, 3)) == 1057
    assert sets_of_sums(49, lambda a, b, N: 0 < a < b < N) == 1057
    assert sets_of_sums(49, lambda a, b, N: 0 <= a <= b < N) == 1080


@pytest.mark.long
def test_other_regions():
    for inside, count in (
        (lambda a, b, N: 0 <= a < b < N, 1068),
        (lambda a, b, N: 0 < a <= b < N, 1068),
        (lambda a, b, N: 0 <= a < b <= N, 1087),
        (lambda a, b, N: 0 <= a <= b <= N, 1100),
    ):
        assert sets_of_sums(60, inside) == count


def test_dimension_is_what_the_equations_leave():
    for model, s, order in (("alpha", 2, 2), ("beta", 2, 1)):
        arrangement = Arrangement(model, s, order)
        for flat in flats(model, s, order):
            equations = arrangement.equations(flat.N, flat.seeds)
            assert len(equations) == rank(equations) == s - flat.dimension
            for *normal, value in equations:
                assert sum(n * q for n, q in zip(normal, flat.seeds, strict=True)) == value * flat.N
