"""Orbits of rings: the order of every scheme, tori of travelling waves, standing waves of fixed ends, momentum, checkpoints."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu import Chain, EscapedOrbit, InputError, UnstableStep, integrate, lindstedt, solve_amplitudes
from symfpu.dynamics.motion import Motion
from symfpu.dynamics.schemes import SCHEMES
from tests.tolerances import ENERGY_WALK, HUNDRED_ROUNDINGS, ORBIT, PEER_ABSOLUTE, PEER_RELATIVE, ROUNDING, STEP_ERROR


def ring(N, **law):
    return Chain(N, **law, ends="periodic")


def centred(values):
    return values - values.mean(axis=-1, keepdims=True)


def state(chain, size, count=()):
    draws = np.random.default_rng(3)
    shape = (*count, chain.N)
    x, p = draws.normal(scale=size, size=shape), draws.normal(scale=size, size=shape)
    return chain.modes(centred(x)), chain.modes(centred(p))


@pytest.mark.parametrize("N", [2, 3, 4, 9])
def test_the_shortest_rings_and_their_fields(N):
    """Against another program and the equations of motion in modes, which know nothing of sites."""
    chain = ring(N, alpha="0.3", beta="0.2")
    Q, P = state(chain, 0.2)
    orbit = integrate(chain, Q, P, 10.0, step=0.05, samples=1, averages=True)
    assert (orbit.Q.dtype, orbit.Q.shape, orbit.averages.shape) == (complex, (2, N - 1), (2, N - 1))

    def motion(t, together):
        return np.concatenate([together[N - 1 :], chain.accelerations(together[: N - 1])])

    peer = solve_ivp(motion, (0, 10), np.concatenate([Q, P]), "DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE)
    assert np.abs(np.concatenate([orbit.Q[-1], orbit.P[-1]]) - peer.y[:, -1]).max() < STEP_ERROR
    assert np.allclose(orbit.energies, chain.energy(orbit.Q, orbit.P), rtol=ROUNDING)
    assert np.array_equal(orbit.harmonic_energies(), chain.harmonic_energies(orbit.Q, orbit.P))


def test_averages_go_to_those_of_the_torus():
    torus = solve_amplitudes(lindstedt(ring(6, beta=1), (-2,), ("1.7326",), 12))
    orbit = integrate(torus.chain, torus.Q(0.0), torus.P(0.0), 20.0, step=0.1, averages=True)
    # one wave: its energies do not change
    assert np.allclose(orbit.averages, torus.average_spectrum(), rtol=0, atol=ORBIT)


@pytest.mark.parametrize("N", [2, 5, 8])
def test_the_odd_orbit_of_a_ring_is_that_of_fixed_ends(N):
    fixed, whole = Chain(N, alpha="0.4", beta="0.1"), ring(2 * N, alpha="0.4", beta="0.1")
    draws = np.random.default_rng(N)
    x, p = draws.normal(scale=0.3, size=(2, N - 1))
    odd = [whole.modes([0, *values, 0, *-values[::-1]]) for values in (x, p)]
    run = {"T": 50.0, "step": 0.05, "samples": 20}
    between_walls = integrate(fixed, fixed.modes(x), fixed.modes(p), **run)
    around = integrate(whole, *odd, **run)
    there = fixed.positions(between_walls.Q)
    assert np.abs(whole.positions(around.Q)[:, 1:N] - there).max() < STEP_ERROR
    assert np.allclose(around.energies, 2 * between_walls.energies, rtol=ENERGY_WALK)


def test_the_momentum_is_kept_to_rounding():
    """A ring that moves as a whole is no state of its modes; particles keep their sums."""
    chain = ring(16, potential="toda:1/2")
    Q, P = state(chain, 0.3)
    motion = Motion(chain, SCHEMES["kahan_li8"], 0.25, np.array([[-9.0, 9.0]]))
    moved = motion.coordinates(Q[None], P[None])
    motion.advance(moved, 40_000, map)
    assert np.array_equal(moved[:, :, 0], moved[:, :, -1])
    assert abs(moved[0, 1, :-1].sum()) < HUNDRED_ROUNDINGS * 10
    assert abs(moved[0, 0, :-1].sum()) < 10_000 * HUNDRED_ROUNDINGS * 10  # for the time it took


def test_what_stops_an_orbit_names_mode_and_bond():
    chain = ring(6, alpha="1/4")
    p = np.array([5.0, 0, 0, 0, 0, -5.0])
    rest = np.zeros(5)
    with pytest.raises(EscapedOrbit, match="bond 5 passes the barrier") as caught:
        integrate(chain, rest, chain.modes(-0.6 * p), 10.0, step=0.05)
    assert caught.value.bond == 5
    with pytest.raises(UnstableStep) as coarse:
        integrate(chain, *state(chain, 0.1), 10.0, step=5.0, scheme="yoshida4")
    assert coarse.value.mode in chain.mode_numbers
    crossing = ring(6, potential="lj:12,6")
    with pytest.raises(UnstableStep, match="bond 5 across the wall r = -1") as crossed:
        integrate(crossing, rest, crossing.modes(-p), 10.0, step=0.3)
    assert crossed.value.bond == 5


def test_a_state_that_is_none_of_a_ring_is_refused():
    chain = ring(6, alpha="1/4")
    with pytest.raises(InputError, match=r"Q_\(-q\) = conj Q_q"):
        integrate(chain, np.arange(5.0), np.zeros(5), 1.0, step=0.1)
    with pytest.raises(InputError, match="N-1 = 5"):
        integrate(chain, np.zeros(6), np.zeros(6), 1.0, step=0.1)
