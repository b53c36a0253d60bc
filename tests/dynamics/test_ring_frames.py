"""Deviation vectors and alignment indices on rings: against differences, fixed ends unfolded, and the dimensions of Toda's tori."""

import numpy as np
import pytest

from symfpu import Chain, InputError, OrbitLost, alignment_indices, lindstedt, seconds_needed, solve_amplitudes
from symfpu.dynamics.alignment import _first_frame
from symfpu.dynamics.frame_run import carried
from symfpu.dynamics.tangent import moving_frame, tangent_steps
from tests.tolerances import CENTRAL_DIFFERENCE, ENERGY_LONG_STEPS, ROUNDING, SAME_VOLUME, STEP_ERROR


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def drawn(chain, size, count=(), seed=1):
    values = np.random.default_rng(seed).normal(scale=size, size=(2, *count, chain.N))
    return tuple(chain.modes(values - values.mean(axis=-1, keepdims=True)))


def odd(x):
    """The odd displacements of the ring of twice the length."""
    rest = np.zeros_like(x[..., :1])
    return np.concatenate([rest, x, rest, -x[..., ::-1]], axis=-1)


@pytest.mark.parametrize("N", [2, 3, 8])
def test_deviations_are_differences_of_orbits(N):
    chain = ring(N, alpha="0.3", beta="0.2")
    state, way = drawn(chain, 0.3), drawn(chain, 1.0, (2,), seed=2)
    *there, dQ, dP = tangent_steps(chain, *state, *way, 0.1, 30)
    small = 1e-4
    for i in range(2):
        ends = []
        for sign in (1, -1):
            near = [part + sign * small * shift[i] for part, shift in zip(state, way, strict=True)]
            nothing = np.zeros((0, N - 1))
            ends.append(tangent_steps(chain, *near, nothing, nothing, 0.1, 30)[:2])
        slopes = [(ahead - behind) / (2 * small) for ahead, behind in zip(*ends, strict=True)]
        assert np.abs(slopes[0] - dQ[i]).max() < CENTRAL_DIFFERENCE
        assert np.abs(slopes[1] - dP[i]).max() < CENTRAL_DIFFERENCE
    assert len(there) == 2


@pytest.mark.long
def test_deviations_of_an_odd_orbit_are_those_of_fixed_ends():
    N = 5
    fixed, whole = Chain(N, potential="toda:1/2"), ring(2 * N, potential="toda:1/2")
    x, p = np.random.default_rng(3).normal(scale=0.3, size=(2, N - 1))
    dx, dp = np.random.default_rng(4).normal(size=(2, 3, N - 1))
    run = 0.1, 100
    walls = tangent_steps(fixed, *map(fixed.modes, (x, p, dx, dp)), *run)
    around = tangent_steps(whole, *[whole.modes(odd(part)) for part in (x, p, dx, dp)], *run)
    for between, closed in zip(walls, around, strict=True):
        assert np.abs(whole.positions(closed)[..., 1:N] - fixed.positions(between)).max() < STEP_ERROR


def test_first_vectors_are_orthonormal_and_do_not_move_the_ring():
    chain = ring(6, alpha=1)
    dQ, dP = _first_frame(chain, 10, 0)
    vectors = np.hstack([chain.positions(dQ), chain.positions(dP)])
    assert np.abs(vectors @ vectors.T - np.eye(10)).max() < ROUNDING
    frame = moving_frame(chain, *drawn(chain, 0.1), dQ, dP, 0.2)
    assert np.array_equal(frame.dx[:, 0], frame.dx[:, -1])
    assert np.abs(frame.dx[:, :-1].sum(axis=1)).max() < ROUNDING


TODA_TORI = [(5, (1,), ("1.210817",), 20, 4e4), (6, (1, -2), ("1.02", "1.766692"), 14, 1e4)]


@pytest.mark.long
@pytest.mark.parametrize(("N", "seeds", "omega", "order", "T"), TODA_TORI)
def test_a_torus_of_waves_has_as_many_dimensions_as_seeds(N, seeds, omega, order, T):
    torus = solve_amplitudes(lindstedt(ring(N, potential="toda:1"), seeds, omega, order))
    start = torus.Q(0.0), torus.P(0.0)
    found = alignment_indices(torus.chain, *start, T, vectors=4, step=0.2, frames=1)
    assert found.dimension().verdict == f"regular, dimension {len(seeds)}"
    assert found.energy_error < ENERGY_LONG_STEPS


def test_a_chaotic_orbit_of_a_ring_keeps_the_volume_of_its_phase_space():
    """All 2(N-1) vectors, for so long that rounding would bring the mean, which does not shrink, into those that do."""
    chain = ring(5, beta=1)
    state = drawn(chain, 1.5)
    frame = moving_frame(chain, *state, *_first_frame(chain, 8, 0), 0.1)
    diagonal = np.zeros(8)
    carried(frame, 5000, 10, 10, np.eye(8), diagonal, np.zeros(8))
    assert diagonal[-1] < -50
    assert abs(diagonal.sum()) < SAME_VOLUME
    found = alignment_indices(chain, *state, 500.0, vectors=2, step=0.1, frames=1)
    assert found.dimension().verdict == "chaotic"


def test_what_rings_do_not_have_is_refused():
    chain = ring(6, alpha="1/4")
    with pytest.raises(InputError, match="vectors"):
        alignment_indices(chain, *drawn(chain, 0.1), 200.0, vectors=11, frames=1)
    with pytest.raises(InputError, match=r"Q_\(-q\) = conj Q_q"):
        alignment_indices(chain, np.arange(5.0), np.zeros(5), 200.0, frames=1)
    p = np.array([-3.0, 0, 0, 0, 0, 3.0])
    with pytest.raises(OrbitLost, match="bond 0"):
        alignment_indices(chain, np.zeros(5), chain.modes(p), 200.0, frames=1)
    assert 0 < seconds_needed(chain, 1e3, vectors=2) < 60
