"""Tangent maps and multipliers of breathers against integrated variations, linear rotation, and their symmetries."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symfpu
from symfpu import Chain, InputError, Torus, floquet, refine
from symfpu.breathers.floquet import DOUBLING, ELLIPTIC, QUADRUPLE, TANGENT, TRIVIAL, monodromy
from symfpu.dynamics.schemes import PARTICLE_SCHEMES
from tests import tolerances
from tests.breather import breather_of
from tests.tolerances import EIGENVALUES, LAST_DIGIT, MAP_AT_REST, MONODROMY, PEER_ABSOLUTE, PEER_RELATIVE, TRACES, VARIATIONS

FIG7 = (Chain(N=32, alpha="0.33"), 1, "0.0981410995944860")

UNSTABLE = (
    (Chain(6, beta=1), 5, "1", {TANGENT: 1}),
    (Chain(4, alpha="0.5"), 2, "1", {DOUBLING: 1}),
    (Chain(6, alpha="0.5"), 3, "1", {QUADRUPLE: 1}),
    (Chain(8, alpha="0.5", beta="0.25"), 2, "1.5", {DOUBLING: 1}),
)


def variations(orbit):
    """M by DOP853 of the motion and its variations from the initial state, in modes, without the tables of the orbit."""
    chain, n = orbit.chain, orbit.chain.N - 1
    basis = chain.stretches(np.eye(n))  # row q: stretches by a unit of mode q

    def field(t, y):
        state = y.reshape(2 * n, 2 * n + 1)
        r = chain.stretches(state[:n, 0])
        slopes = 1 + 2 * float(chain.alpha) * r + 3 * float(chain.beta) * r**2
        force = -(basis * slopes) @ (basis.T @ state[:n])
        force[:, 0] = chain.accelerations(state[:n, 0])
        return np.vstack([state[n:], force]).reshape(-1)

    start = np.column_stack([np.append(orbit.Q(0.0), np.zeros(n)), np.eye(2 * n)])
    period = 2 * np.pi / float(orbit.frequency)
    run = solve_ivp(field, (0, period), start.reshape(-1), "DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
    return run.y[:, -1].reshape(2 * n, -1)[:, 1:]


def nearest(values, others):
    """Largest distance of a value from its nearest partner in others."""
    return max(np.min(np.abs(np.asarray(others) - value)) for value in values)


@pytest.mark.parametrize(("chain", "seed", "amplitude", "instabilities"), UNSTABLE, ids=repr)
def test_unstable_orbits_agree_with_integrated_variations(chain, seed, amplitude, instabilities):
    orbit = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    result, M = floquet(orbit), variations(orbit)
    assert result.instabilities == instabilities
    assert not result.stable
    assert result.largest > 1.01
    assert result.monodromy == pytest.approx(M, abs=VARIATIONS)
    off = np.abs(np.abs(result.multipliers) - 1) > 1e-3
    assert nearest(result.multipliers[off], np.linalg.eigvals(M)) < EIGENVALUES
    assert result.largest == pytest.approx(np.max(np.abs(np.linalg.eigvals(M))), rel=EIGENVALUES)


@pytest.mark.parametrize("case", [FIG7, (Chain(8, alpha="0.4", beta="0.1"), 3, "1.13"), (Chain(6, beta=1), 5, "2.3")], ids=repr)
def test_the_map_is_symplectic_and_reversible_and_has_the_pairs(case):
    chain, seed, frequency = case
    orbit = symfpu.torus(chain, (seed,), frequencies=(frequency,))
    result = floquet(orbit)
    n, M = orbit.chain.N - 1, result.monodromy
    J = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    R = np.diag(np.repeat([1.0, -1.0], n))
    assert result.symplecticity == np.max(np.abs(M.T @ J @ M - J))
    assert result.symplecticity < MONODROMY
    twice_reversed = R @ M @ R @ M
    assert twice_reversed == pytest.approx(np.eye(2 * n), abs=MONODROMY)
    assert np.linalg.det(M) == pytest.approx(1, abs=MONODROMY)
    assert result.pairs.prod(axis=1) == pytest.approx(np.ones(n), abs=LAST_DIGIT)
    assert result.pairs.shape == (n, 2)
    sums = np.trace(M), np.trace(M @ M)
    assert [result.multipliers.sum(), (result.multipliers**2).sum()] == pytest.approx(sums, abs=TRACES)
    assert monodromy(orbit) == pytest.approx(M, abs=0)


def test_the_trivial_pair_is_the_flow():
    """M carries (P, -dH/dQ) to itself: the unstable double eigenvalue of M costs half the digits, the pair here none."""
    chain, seed, frequency = FIG7
    result = floquet(symfpu.torus(chain, (seed,), frequencies=(frequency,)))
    flow = np.append(np.zeros(31), result.orbit.chain.accelerations(result.orbit.Q(0.0)))
    assert np.linalg.norm(result.monodromy @ flow - flow) < MONODROMY * np.linalg.norm(flow)
    assert result.kinds[0] == TRIVIAL
    assert result.pairs[0].tolist() == [1, 1]
    assert result.trivial_error < tolerances.NEWTON_RESIDUAL
    assert result.kinds.count(TRIVIAL) == 1


@pytest.mark.parametrize("chain", [Chain(9, alpha="0.3"), Chain(9, beta="0.3")], ids=repr)
def test_small_orbits_have_the_multipliers_of_rest(chain):
    orbit = symfpu.torus(chain, (2,), amplitudes={2: "1e-4"})
    result = floquet(orbit)
    angles = np.delete(chain.frequencies(), 1) * 2 * np.pi / float(orbit.frequency)
    assert result.stable
    assert result.largest == 1
    assert set(result.kinds[1:]) == {ELLIPTIC}
    expected = np.concatenate([np.exp(1j * angles), np.exp(-1j * angles)])
    assert nearest(expected, result.multipliers) < MAP_AT_REST
    assert nearest(result.multipliers[2:], expected) < MAP_AT_REST


def test_a_pair_next_to_the_trivial_one_is_resolved():
    """N = 16, beta = 1 on the branch 9 omega_1 = sigma_11. By Taylor's method in long doubles, from harmonic balance in them:
    kappa = 8.8466496e-12, so multipliers 1 +- 5.9e-6."""
    guess = np.zeros((10, 15))
    guess[1, 0], guess[3, 2], guess[9, 10] = 0.9964710546771, 0.0039244872, -0.069215195
    chain, harmonics = Chain(16, beta=1), np.arange(10)[:, None]
    near = Torus(chain, (1,), (Fraction("0.219"),), harmonics, guess)
    result = floquet(refine(near, amplitudes={1: "0.9964710546771008"}))
    assert result.instabilities == {TANGENT: 1}
    place = result.kinds.index(TANGENT)
    assert abs(result.kappa[place] - 8.8466496e-12) < result.tolerance[place]


def test_a_chain_of_one_particle_has_the_trivial_pair_only():
    result = floquet(symfpu.torus(Chain(2, beta=1), (1,), amplitudes={1: "0.5"}))
    assert result.multipliers.tolist() == [1, 1]
    assert result.stable


@pytest.mark.parametrize("name", PARTICLE_SCHEMES)
def test_multipliers_by_another_scheme_agree_within_the_errors(name):
    """A chain of eight bonds, two of whose multipliers are off the circle; the estimated errors are those found."""
    orbit = breather_of(*UNSTABLE[3][:3])
    one, other = floquet(orbit), floquet(orbit, scheme=name)
    assert other.instabilities == one.instabilities
    assert nearest(other.multipliers[2:], one.multipliers) < tolerances.MAP_BY_SCHEME
    assert np.linalg.norm(other.monodromy - one.monodromy, 2) < 20 * (one.map_error + other.map_error)
    assert np.array_equal(monodromy(orbit, scheme=name), other.monodromy)


@pytest.mark.parametrize("function", [floquet, monodromy])
def test_what_is_no_orbit_is_refused(function):
    with pytest.raises(InputError, match=r"^orbit = .*torus"):
        function(np.ones((3, 5)))
