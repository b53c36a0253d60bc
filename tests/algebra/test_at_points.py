"""Values at points give coefficients back, and products at points are those of coefficients, modulo every prime."""

from itertools import product

import numpy as np
import pytest

from symfpu.algebra import several_primes
from symfpu.algebra.at_points import AtPoints
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.several_primes import SeveralPrimesRing, largest_prime
from symfpu.algebra.words import ResidueBasis

TOPS = [(1, 2), (1, 7), (1, 40), (2, 2), (2, 9)]


def points_of(seeds, top):
    grading = Grading(seeds, top)
    points = AtPoints(grading)
    basis = ResidueBasis(60, largest_prime(top), points.divisor)
    return points, basis


def matrix(table, places, degree, prime):
    """The matrix of a degree modulo one prime, as Python's integers."""
    end = places.start[degree + 1] if degree + 1 < len(places.start) else len(places.flat)
    entries = places.flat[places.start[degree] : end]
    return np.array([int(x) for x in table[entries, prime]], dtype=object).reshape(-1, places.columns[degree])


@pytest.mark.parametrize(("seeds", "top"), TOPS)
def test_interpolation_undoes_evaluation(seeds, top):
    """At as many points as a product of this degree is known at."""
    points, basis = points_of(seeds, top)
    powers, inverses = points.powers(basis.primes), points.inverse_powers(basis.primes)
    for degree, (i, p) in product(range(1, top + 1), enumerate(basis.primes)):
        back = matrix(inverses, points.inverse_places(degree), degree, i)
        there = matrix(powers, points.places(degree), degree, i)[: back.shape[1]]
        assert (np.dot(back, there) % p == np.eye(len(back), dtype=int)).all()


@pytest.mark.parametrize(("seeds", "top"), TOPS)
def test_residues_are_centred_and_roots_have_their_order(seeds, top):
    points, basis = points_of(seeds, top)
    for table in (points.powers(basis.primes), points.inverse_powers(basis.primes)):
        assert (np.abs(table) <= basis.moduli // 2).all()
    if seeds == 1:
        cosines = points.powers(basis.primes)[:-1]
        assert (cosines[0] == 2).all()
        assert (cosines[points.divisor // 2] == -2).all()
        assert (np.abs(cosines[1 : points.divisor // 2]) > 0).all(axis=1).sum() == points.divisor // 2 - 2


@pytest.mark.parametrize(("seeds", "top"), TOPS)
def test_every_value_has_a_row_of_its_own(seeds, top):
    points, _ = points_of(seeds, top)
    rows = np.concatenate([points.rows_of(degree) for degree in range(top)])
    assert sorted(rows) == list(range(points.rows.first[-1]))


def test_three_seeds_are_kept_by_their_coefficients():
    assert AtPoints.fits(Grading(2, 3))
    assert not AtPoints.fits(Grading(3, 3))


def rings(seeds, top, N, monkeypatch):
    """At points and by coefficients, with the same primes."""
    grading = Grading(len(seeds), top)
    space = CosineModes(N, seeds, grading)
    basis = ResidueBasis(70, largest_prime(top), AtPoints(grading).divisor)
    at_points = SeveralPrimesRing(space, basis)
    monkeypatch.setattr(several_primes, "at_points", lambda grading: None)
    return at_points, SeveralPrimesRing(space, basis)


def filled(ring, degrees, largest):
    """The ring with the same residues on the bonds for the same degrees; largest : all as large as they can be."""
    generator = np.random.default_rng(5)
    half = ring.basis.moduli[:, None, None] // 2
    for degree in degrees:
        shape = (len(ring.basis), len(ring.grading.canonical(degree)), ring.space.half)
        values = np.broadcast_to(half, shape) if largest else np.rint(generator.uniform(-1, 1, shape) * half)
        ring.store(degree, np.zeros((*shape[:2], ring.space.N - 1)))
        ring.store_bonds(degree, lambda some, values=values: np.ascontiguousarray(values[:, some]))


def residues(ring, power, degree):
    values = ring.residues(degree, ring.power_rows(power, degree), slice(None), 1.0)
    ring.basis.reduce(values)
    return values


@pytest.mark.parametrize("largest", [False, True])
@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize(("seeds", "top", "N"), [((1,), 40, 5), ((1,), 301, 2), ((1, 2), 9, 5), ((1, 3), 16, 4)])
def test_products_are_those_of_coefficients(seeds, top, N, step, largest, monkeypatch):
    """Squares, degree after degree, as the recursion asks for them; step : 2 where even degrees are missing."""
    ours, theirs = rings(seeds, top, N, monkeypatch)
    for degree in range(1, top, step):
        for ring in (ours, theirs):
            filled(ring, [degree], largest)
        for target in (degree + 1, degree + 2)[:step]:
            if target <= top and (target > top - 3 or target < 20):
                assert (residues(ours, 2, target) == residues(theirs, 2, target)).all()
            elif target <= top:
                ours.power_rows(2, target)


@pytest.mark.parametrize(("seeds", "top", "N"), [((1,), 21, 5), ((1, 2), 8, 5)])
def test_cubes_are_those_of_coefficients(seeds, top, N, monkeypatch):
    """A lower power is kept at points as the bonds are."""
    ours, theirs = rings(seeds, top, N, monkeypatch)
    for ring in (ours, theirs):
        filled(ring, range(1, top), largest=False)
        for degree in range(2, top):
            square = residues(ring, 2, degree)
            ring.store_power(2, degree, lambda some, square=square: np.ascontiguousarray(square[:, some]))
    for degree in (3, top - 1, top):
        assert (residues(ours, 3, degree) == residues(theirs, 3, degree)).all()


def test_a_basis_without_such_roots_is_kept_by_coefficients():
    """At high orders too few primes are a multiple of 4M above one."""
    grading = Grading(1, 2000)
    few, many = (several_primes.residue_basis(grading, bits) for bits in (500, 5000))
    divisor = AtPoints(grading).divisor
    assert all(p % divisor == 1 for p in few.primes)
    assert not all(p % divisor == 1 for p in many.primes)
    assert max(*few.primes, *many.primes) <= largest_prime(2000)
    space = CosineModes(3, (1,), Grading(1, 9))
    assert SeveralPrimesRing(space, ResidueBasis(60, 5000))._at_points is None
    assert SeveralPrimesRing(space, several_primes.residue_basis(space.grading, 60))._at_points is not None
