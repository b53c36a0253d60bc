"""Harmonics chosen by forces: lattices of choices with holes, the choice itself, and tori found with it against those of polytopes."""

from dataclasses import replace
from functools import partial
from itertools import combinations, product

import numpy as np
import pytest

import symfpu
from symfpu import Chain, NoTorus, TorusTooLarge, refine
from symfpu.refinement import harmonics, search
from symfpu.refinement.harmonics import adaptive_harmonics
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import OVERSAMPLING, Lattice, dilated, neighbours
from symfpu.refinement.newton import newton
from symfpu.refinement.tori import TOLERANCE, ended_early
from tests.refinement.test_invariance import ball, equation_and_coefficients, largest
from tests.refinement.test_ring_tori import of_series
from tests.refinement.test_waves import plain_waves
from tests.tolerances import ROUNDING, SAME_TORUS

TORI = (
    (Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}),
    (Chain(3, beta="0.5"), {1: "0.3", 2: "0.3"}),
    (Chain(8, beta="0.3"), {1: "0.3", 2: "0.2", 3: "0.1"}),
    (Chain(8, potential="toda:0.4"), {1: "0.3", 2: "0.2"}),
    (Chain(7, alpha="0.2", beta="0.3"), {2: "0.2", 6: "0.1"}),
    (Chain(4, alpha="0.3"), {1: "0.2", 2: "0.1", 3: "0.05"}),
)


def with_holes(s=5, highest=8):
    """Harmonics of at most two of s angles, whose hull is mostly empty."""
    found = {tuple(row) for row in np.eye(s, dtype=np.int64).tolist()}
    for i, j in combinations(range(s), 2):
        for m, n in product(range(highest + 1), range(-highest, highest + 1)):
            nu = [0] * s
            nu[i], nu[j] = m, n if m else abs(n)
            found.add(tuple(nu))
    return np.array(sorted(found))


def test_a_lattice_tells_a_choice_with_holes_from_its_neighbours():
    chosen = with_holes()
    lattice, around = Lattice(chosen), neighbours(chosen)
    signed = {max(nu, tuple(-n for n in nu)) for nu in map(tuple, around.tolist())}
    assert len(np.unique(lattice.entries(around))) == len(signed)
    hull = dilated(chosen, OVERSAMPLING / 2)
    assert lattice.points < len(hull) / 2  # as many points as the lattice of a filled hull has at least


def test_steps_of_odd_harmonics_stay_odd():
    odd = np.array([nu for nu in ball(3, 5) if sum(nu) % 2])
    around = neighbours(odd)
    assert (around.sum(axis=1) % 2 == 1).all()
    moved = odd[:5] + np.array([1, -1, 0])
    assert set(map(tuple, moved.tolist())) <= set(map(tuple, around.tolist()))


LATTICES = {
    "beta": lambda: equation_and_coefficients(Chain(6, beta="0.7"), (4, 5), low=1, radius=4),
    "mixed": lambda: equation_and_coefficients(Chain(8, alpha="0.3", beta="0.2"), (1, 2, 7), low=1, radius=4),
    "waves": lambda: plain_waves(9, (2, 3), 5),
}


@pytest.mark.parametrize("name", LATTICES)
def test_a_force_is_the_same_on_another_lattice(name):
    equation, c = LATTICES[name]()
    reach = np.abs(equation.harmonics).sum(axis=1).max()
    wider = ball(equation.harmonics.shape[1], reach + 1)
    own = np.abs(wider).sum(axis=1) <= reach
    there = np.zeros((len(wider), c.shape[1]))
    there[own] = c
    found, expected = equation.force(there, grid=Lattice(wider))[own], equation.force(c)
    assert largest(found - expected) <= ROUNDING * largest(expected)


def solved(chain, amplitudes, radius):
    """Equation, cosines and shifts of a torus in a ball of harmonics."""
    torus = refine(symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4))
    equation = InvarianceEquation(chain, torus.seeds, ball(len(torus.seeds), radius))
    rows = dict(zip(map(tuple, torus.harmonics.tolist()), torus.cosines, strict=True))
    nothing = np.zeros(chain.N - 1)
    c = np.array([rows.get(nu, nothing) for nu in map(tuple, equation.harmonics.tolist())], dtype=np.longdouble)
    shifts = np.array([float(w) for w in torus.frequencies]) - equation.seed_frequencies
    return equation, c, shifts


def test_the_choice_keeps_the_seeds_and_its_limit():
    equation, c, shifts = solved(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, 4)
    choice = adaptive_harmonics(equation, c, shifts, 1e-30, 7)
    assert len(choice.harmonics) == 7
    assert choice.full
    assert {(1, 0), (0, 1)} <= set(map(tuple, choice.harmonics.tolist()))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_what_is_left_out_adds_up_to_less_than_the_tolerance(tolerance, monkeypatch):
    monkeypatch.setattr(harmonics, "LEAST_GROWTH", 0)
    equation, c, shifts = solved(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, 8)
    choice = adaptive_harmonics(equation, c, shifts, tolerance, 10_000)
    chosen = set(map(tuple, choice.harmonics.tolist()))
    forces = np.abs(equation.force(c)).max(axis=1)
    accelerations = equation.rates(shifts) ** 2 @ np.abs(c)
    left = sum(f for nu, f in zip(equation.harmonics.tolist(), forces, strict=True) if tuple(nu) not in chosen)
    assert 0.1 * tolerance < left / accelerations.max() <= tolerance
    assert len(choice.harmonics) < len(equation.harmonics)


@pytest.fixture
def small_polytopes(monkeypatch):
    """Choices by forces for tori of any size."""
    monkeypatch.setattr(search, "LARGEST_POLYTOPE", 60)
    monkeypatch.setattr(search, "FIRST_POLYTOPE", 30)


QUICK = TORI[:2]
MARKS = [[] if case in QUICK else [pytest.mark.long] for case in TORI]


def series(chain, amplitudes):
    return symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)


GUESSES = [pytest.param(partial(series, *c), 60, id=repr(c), marks=m) for c, m in zip(TORI, MARKS, strict=True)]
GUESSES += [pytest.param(partial(of_series, 12, {2: 0.001, 3: 0.002}, {"beta": "0.3"}), 20, id="waves")]


@pytest.mark.parametrize(("make", "most"), GUESSES)
def test_tori_of_both_choices_are_the_same(make, most, monkeypatch):
    guess = make()
    by_polytope = refine(guess)
    monkeypatch.setattr(search, "LARGEST_POLYTOPE", most)
    monkeypatch.setattr(search, "FIRST_POLYTOPE", most // 2)
    by_forces = refine(guess)
    assert not by_forces.warnings
    assert by_forces.residual() <= TOLERANCE
    assert not np.array_equal(by_forces.harmonics, by_polytope.harmonics)
    for q, a in by_polytope.amplitudes.items():
        assert abs(by_forces.amplitudes[q] / a - 1) <= SAME_TORUS
    assert abs(by_forces.energy() / by_polytope.energy() - 1) <= SAME_TORUS


@pytest.fixture
def guess():
    return series(*TORI[0])


@pytest.mark.usefixtures("small_polytopes")
def test_as_many_as_allowed_leave_a_doubt(guess):
    torus = refine(guess, amplitudes=guess.amplitudes, most_harmonics=70)
    assert torus.warnings
    assert len(torus.harmonics) == 70
    assert "most_harmonics=70" in torus.warnings[0]
    assert f"{torus.residual():.2g}" in torus.warnings[0]


@pytest.mark.usefixtures("small_polytopes")
def test_a_failure_with_more_harmonics_gives_the_best_torus_with_a_doubt(guess, monkeypatch):
    calls = []

    def fails_with_many(equation, *rest, **how):
        calls.append(len(equation.harmonics))
        found = newton(equation, *rest, **how)
        return found if calls[-1] < 120 else replace(found, failure="no way")

    monkeypatch.setattr(search, "newton", fails_with_many)
    torus = refine(guess, amplitudes=guess.amplitudes)
    assert ended_early(torus)
    assert "no way" in torus.warnings[0]
    assert len(torus.harmonics) == calls[-2] < 120 <= calls[-1]


@pytest.mark.usefixtures("small_polytopes")
def test_what_does_not_fit_into_memory_leaves_the_best_torus_with_a_doubt(guess, monkeypatch):

    def small(sizes, chain):
        if sizes.harmonics > 100:
            raise TorusTooLarge(chain.N, sizes.harmonics, 10, 1, 100)

    monkeypatch.setattr(search, "require_memory", small)
    torus = refine(guess, amplitudes=guess.amplitudes)
    assert torus.warnings
    assert 50 < len(torus.harmonics) <= 100
    assert f"leave a residual of {torus.residual():.2g}" in torus.warnings[0]


@pytest.mark.usefixtures("small_polytopes")
def test_a_failure_with_the_first_ones_is_no_torus(guess):
    with pytest.raises(NoTorus, match="goes from"):
        refine(guess, amplitudes={1: "6", 2: "5"})
