"""Harmonics chosen by forces: lattices of choices with holes, the choice itself, and tori found with it against those of polytopes."""

from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.errors import TorusTooLarge
from symfpu.refinement import search, widening
from symfpu.refinement.lattice import OVERSAMPLING, Lattice, dilated, has_holes, low_harmonics, neighbours, told_apart
from symfpu.refinement.newton import newton
from symfpu.refinement.refined_torus import COSINES, TOLERANCE, NoTorus, ended_early
from symfpu.refinement.tori import refine, refine_at_amplitudes
from symfpu.refinement.waves import WaveEquation
from symfpu.refinement.widening import GROWTH, widened
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.refinement.test_invariance import ball, equation_and_coefficients, largest
from tests.refinement.test_ring_tori import of_series
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


def folded_places(lattice, harmonics):
    """One place for every pair +-nu."""
    return lattice.entries(harmonics)


def pairs(harmonics):
    """How many different pairs +-nu."""
    both = np.sort(np.stack([harmonics, -harmonics], axis=1).view([("", np.int64)] * harmonics.shape[1])[..., 0], axis=1)
    return len(np.unique(both[:, 0]))


def test_a_polytope_has_no_holes_and_a_star_has():
    assert not has_holes(ball(2, 9))
    assert not has_holes(ball(4, 8))
    assert not has_holes(ball(5, 8))
    assert has_holes(with_holes())
    polytope = ball(4, 8)
    assert np.array_equal(told_apart(polytope), dilated(polytope, 1.25))


def test_a_lattice_tells_a_choice_with_holes_from_its_neighbours():
    chosen = with_holes()
    lattice, around = Lattice(chosen), neighbours(chosen)
    assert len(np.unique(folded_places(lattice, around))) == pairs(around)
    hull = dilated(chosen, OVERSAMPLING / 2)
    assert lattice.points < len(hull) / 2  # as many points as the lattice of a filled hull has at least


def test_steps_of_odd_harmonics_stay_odd():
    odd = np.array([nu for nu in ball(3, 5) if sum(nu) % 2])
    around = neighbours(odd)
    assert (around.sum(axis=1) % 2 == 1).all()
    moved = odd[:5] + np.array([1, -1, 0])
    assert set(map(tuple, moved.tolist())) <= set(map(tuple, around.tolist()))


def test_low_harmonics_are_short():
    assert np.abs(low_harmonics(4)).sum(axis=1).max() == 4


@pytest.mark.parametrize(("chain", "seeds"), [(Chain(6, beta="0.7"), (4, 5)), (Chain(8, alpha="0.3", beta="0.2"), (1, 2, 7))], ids=repr)
def test_a_force_is_the_same_on_another_lattice(chain, seeds):
    equation, c = equation_and_coefficients(chain, seeds, low=1, radius=4)
    wider = ball(len(seeds), 5)
    own = [i for i, nu in enumerate(map(tuple, wider.tolist())) if nu in set(map(tuple, equation.harmonics.tolist()))]
    there = np.zeros((len(wider), c.shape[1]))
    there[own] = c
    found, expected = equation.force_on(Lattice(wider), there)[own], equation.force(c)
    assert largest(found - expected) <= ROUNDING * largest(expected)


def test_a_force_of_waves_is_the_same_on_another_lattice():
    chain, seeds = Chain(9, alpha="0.3", ends="periodic"), (2, 3)
    equation = WaveEquation(chain, seeds, ball(2, 5))
    low = np.abs(equation.harmonics).sum(axis=1) <= 1
    c = np.where(low[:, None] & equation.mask, 0.1, 0.0)
    wider = ball(2, 6)
    own = np.abs(wider).sum(axis=1) <= 5
    there = np.zeros((len(wider), 1))
    there[own] = c
    found, expected = equation.force_on(Lattice(wider), there)[own], equation.force(c)
    assert largest(found - expected) <= ROUNDING * largest(expected)


def solved(chain, amplitudes, radius):
    """Equation, cosines and shifts of a torus in a ball of harmonics."""
    torus = refine(torus_at_amplitudes(chain, amplitudes, order=4))
    equation = COSINES.equation(chain, torus.seeds, ball(len(torus.seeds), radius), None)
    rows = dict(zip(map(tuple, torus.harmonics.tolist()), torus.cosines, strict=True))
    nothing = np.zeros(chain.N - 1)
    c = np.array([rows.get(nu, nothing) for nu in map(tuple, equation.harmonics.tolist())], dtype=np.longdouble)
    shifts = np.array([float(w) - equation.linear[q - 1] for q, w in torus.omega.items()])
    return equation, c, shifts


def test_the_choice_takes_the_largest_forces():
    equation, c, shifts = solved(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, 4)
    choice = widened(equation, c, shifts, 1e-30, 10_000)
    assert len(choice.harmonics) == int(GROWTH * len(equation.harmonics))
    assert not choice.full
    wider = ball(2, 9)
    there = np.zeros((len(wider), c.shape[1]))
    own = {nu: i for i, nu in enumerate(map(tuple, wider.tolist()))}
    there[[own[tuple(nu)] for nu in equation.harmonics.tolist()]] = c
    forces = np.abs(equation.force_on(Lattice(wider), there)).max(axis=1)
    chosen = set(map(tuple, choice.harmonics.tolist()))
    order = np.argsort(-forces)[: len(equation.harmonics)]
    assert set(map(tuple, wider[order].tolist())) <= chosen


def test_the_choice_keeps_the_seeds_and_its_limit():
    equation, c, shifts = solved(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, 4)
    choice = widened(equation, c, shifts, 1e-30, 7)
    assert len(choice.harmonics) == 7
    assert choice.full
    assert {(1, 0), (0, 1)} <= set(map(tuple, choice.harmonics.tolist()))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_what_is_left_out_adds_up_to_less_than_the_tolerance(tolerance, monkeypatch):
    monkeypatch.setattr(widening, "LEAST_GROWTH", 0)
    equation, c, shifts = solved(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, 8)
    choice = widened(equation, c, shifts, tolerance, 10_000)
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


@pytest.mark.parametrize(("chain", "amplitudes"), TORI, ids=repr)
def test_tori_of_both_choices_are_the_same(chain, amplitudes, monkeypatch):
    guess = torus_at_amplitudes(chain, amplitudes, order=4)
    by_polytope = refine(guess)
    monkeypatch.setattr(search, "LARGEST_POLYTOPE", 60)
    monkeypatch.setattr(search, "FIRST_POLYTOPE", 30)
    by_forces = refine(guess)
    assert not by_forces.warnings
    assert by_forces.residual() <= TOLERANCE
    assert not np.array_equal(by_forces.harmonics, by_polytope.harmonics)
    for q, a in by_polytope.amplitudes.items():
        assert abs(by_forces.amplitudes[q] / a - 1) <= SAME_TORUS
    assert abs(by_forces.energy() / by_polytope.energy() - 1) <= SAME_TORUS


def test_waves_of_both_choices_are_the_same(monkeypatch):
    guess = of_series(12, {2: 0.001, 3: 0.002}, {"beta": "0.3"})
    by_polytope = refine(guess)
    monkeypatch.setattr(search, "LARGEST_POLYTOPE", 20)
    monkeypatch.setattr(search, "FIRST_POLYTOPE", 10)
    by_forces = refine(guess)
    assert not by_forces.warnings
    for q, a in by_polytope.amplitudes.items():
        assert abs(by_forces.amplitudes[q] / a - 1) <= SAME_TORUS


@pytest.mark.usefixtures("small_polytopes")
def test_as_many_as_allowed_leave_a_doubt():
    guess = torus_at_amplitudes(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, order=4)
    torus = refine_at_amplitudes(guess, guess.amplitudes, most_harmonics=70)
    assert torus.verdict == "doubtful"
    assert len(torus.harmonics) == 70
    assert "most_harmonics=70" in torus.warnings[0]
    assert f"{torus.residual():.2g}" in torus.warnings[0]


@pytest.mark.usefixtures("small_polytopes")
def test_a_failure_with_more_harmonics_gives_the_best_torus_with_a_doubt(monkeypatch):
    guess = torus_at_amplitudes(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, order=4)
    calls = []

    def fails_with_many(equation, *rest, **how):
        calls.append(len(equation.harmonics))
        found = newton(equation, *rest, **how)
        return found if calls[-1] < 120 else replace(found, failure="no way")

    monkeypatch.setattr(search, "newton", fails_with_many)
    torus = refine_at_amplitudes(guess, guess.amplitudes)
    assert ended_early(torus)
    assert "no way" in torus.warnings[0]
    assert len(torus.harmonics) == calls[-2] < 120 <= calls[-1]


@pytest.mark.usefixtures("small_polytopes")
def test_what_does_not_fit_into_memory_leaves_the_best_torus_with_a_doubt(monkeypatch):
    guess = torus_at_amplitudes(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, order=4)

    def small(sizes, chain):
        if sizes.harmonics > 100:
            raise TorusTooLarge(chain.N, sizes.harmonics, 10, 1, 100)

    monkeypatch.setattr(search, "require_memory", small)
    torus = refine_at_amplitudes(guess, guess.amplitudes)
    assert torus.verdict == "doubtful"
    assert 50 < len(torus.harmonics) <= 100
    assert f"leave a residual of {torus.residual():.2g}" in torus.warnings[0]


@pytest.mark.usefixtures("small_polytopes")
def test_a_failure_with_the_first_ones_is_no_torus():
    guess = torus_at_amplitudes(Chain(8, alpha="0.3"), {1: "0.3", 2: "0.1"}, order=4)
    with pytest.raises(NoTorus, match="goes from"):
        refine_at_amplitudes(guess, {1: "6", 2: "5"})
