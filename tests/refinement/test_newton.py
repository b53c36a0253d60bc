"""The preconditioner of Newton's method, and the search for a lattice."""

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.refinement import couplings, invariance, lattice, linear_system
from symfpu.refinement.conditions import Amplitude, FrequencyShift
from symfpu.refinement.waves import WaveEquation
from tests.refinement.test_invariance import ball, equation_and_coefficients
from tests.tolerances import ROUNDING
from tests.tori.test_ring_torus import ring

BLOCK = 8  # unknowns
SHIFTS = np.array([0.01, -0.02], dtype=np.longdouble)


def standing():
    """Among its harmonics is zero, whose cosine has another norm."""
    return equation_and_coefficients(Chain(8, alpha="0.4", beta="0.3"), (1, 3), low=1, radius=3)


def travelling():
    equation = WaveEquation(ring(7, alpha="0.3"), (2, -3), ball(2, 3))
    low = equation.mask & (np.abs(equation.harmonics).sum(axis=1) <= 1)[:, None]
    return equation, np.where(low, 0.1, 0.0)


@pytest.fixture(params=[standing, travelling], ids=["standing", "travelling"])
def system(request, monkeypatch):
    """Of coefficients of short harmonics, with all couplings to a small block."""
    monkeypatch.setattr(linear_system, "SMALLEST_BLOCK", BLOCK)
    monkeypatch.setattr(linear_system, "LARGEST_BLOCK", BLOCK)
    monkeypatch.setattr(couplings, "SHARE", 0.0)
    monkeypatch.setattr(couplings, "MOST_SLOPES", 1000)
    monkeypatch.setattr(invariance, "LEAST_COUPLING", 0.0)
    equation, c = request.param()
    conditions = [FrequencyShift(0, SHIFTS[0]), Amplitude(1, np.longdouble(0.2))]
    return linear_system.LinearSystem(equation, conditions, c.astype(np.longdouble), SHIFTS)


def whole_matrix(system):
    count = int(system.mask.sum()) + system.s
    return np.array([system.product(unit) for unit in np.eye(count)]).T


def test_couplings_into_and_out_of_the_block_are_those_of_the_system(system):
    """Of harmonics so short that their products do not fold; out of the block by symmetry, the harmonic zero with another weight."""
    preconditioner = linear_system.Preconditioner(system)
    assert not preconditioner.whole
    count, block = int(system.mask.sum()), preconditioner.inside[: -system.s]
    coupling = whole_matrix(system)[:count, :count] - np.diag(system.diagonal[system.mask])
    rows, _ = np.nonzero(system.mask)
    harmonics = system.equation.harmonics[rows]
    short = np.abs(harmonics).sum(axis=1) <= 2
    own = block[short[block]]
    chosen = short[block]
    largest = np.abs(coupling).max()
    into, out = preconditioner.into.toarray()[chosen], preconditioner.out.toarray()[:, chosen]
    assert np.abs(coupling[own][:, short]).max() > largest / 2
    assert np.abs(into[:, short] - coupling[own][:, short]).max() < ROUNDING * largest
    assert np.abs(out[short] - coupling[short][:, own]).max() < ROUNDING * largest


def test_the_preconditioner_is_the_inverse_of_its_parts(system):
    """Of the block, the couplings it holds, the shifts and conditions, and divisors elsewhere."""
    preconditioner = linear_system.Preconditioner(system)
    matrix, inside = whole_matrix(system), preconditioner.inside
    count, block = int(system.mask.sum()), inside[:-2]
    outside = np.setdiff1d(np.arange(count), block)
    kept = np.zeros_like(matrix)
    kept[outside, outside] = system.diagonal[system.mask][outside]
    kept[np.ix_(block, range(count))] = preconditioner.into.toarray()
    kept[np.ix_(outside, block)] = preconditioner.out.toarray()[outside]
    kept[np.ix_(block, block)] = matrix[np.ix_(block, block)]
    kept[count:] = matrix[count:]
    kept[:, count:] = matrix[:, count:]
    vector = np.random.default_rng(3).normal(size=len(matrix))
    found = kept @ preconditioner(vector)
    condition = np.linalg.cond(kept)
    assert condition < 1e8
    assert np.abs(found - vector).max() < ROUNDING * condition


def test_a_clash_of_the_last_harmonics_is_found():
    """Where the first ones, in portions that grow, are all different."""
    numbers = np.arange(3 * lattice.FIRST_TRIED)[:, None]
    generator, period = np.array([1]), len(numbers)
    assert lattice._distinct(numbers, generator, period)
    clash = np.append(numbers, [[period]], axis=0)
    assert not lattice._distinct(clash, generator, period)
    assert not lattice._distinct(np.append(numbers, numbers[-1:], axis=0), generator, 2 * period)
