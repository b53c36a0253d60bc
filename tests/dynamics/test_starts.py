"""States of one's own: energies met, modes at rest, particles back as they were, refusals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import symfpu
from symfpu import Chain, InputError, fpu_trajectory, packet_state, particle_state, random_state, unfold
from tests.tolerances import ROUNDING, TEN_ROUNDINGS

CHAINS = [
    Chain(2, alpha=1),
    Chain(9, beta="-0.2"),
    Chain(8, alpha="0.3", beta="0.1"),
    Chain(8, potential="toda:1/2"),
    Chain(6, potential="lj:12,6"),
    Chain(2, alpha="0.3", ends="periodic"),
    Chain(8, alpha="0.3", ends="periodic"),
    Chain(7, potential="morse:1", ends="periodic"),
]


@pytest.mark.parametrize("chain", CHAINS, ids=str)
def test_random_states_have_their_energy_and_are_different(chain):
    states = [random_state(chain, "0.01", seed) for seed in (0, 1, 0)]
    for Q, P in states:
        assert float(chain.energy(Q, P)) == pytest.approx(0.01, rel=TEN_ROUNDINGS)
        assert np.all(Q != 0)
        assert np.all(P != 0)
    assert np.array_equal(states[0], states[2])
    assert not np.array_equal(states[0], states[1])


def test_random_directions_are_alike():
    """E_q of a linear chain, which a large energy scale of H leaves it: the mean of each mode is 1/(N-1) of it."""
    chain, count = Chain(8, beta="1e-6"), 50
    shares = np.mean([chain.harmonic_energies(*random_state(chain, 1, seed)) for seed in range(count)], axis=0)
    spread = 1 / 7 / np.sqrt(count)  # of the mean of an exponential share
    assert np.all(np.abs(shares - 1 / 7) < 4 * spread)


@pytest.mark.parametrize("chain", CHAINS, ids=str)
def test_packets_have_their_energy_and_nothing_else(chain):
    q = chain.mode_numbers[-1]
    Q, P = packet_state(chain, (q,), "0.02")
    assert float(chain.energy(Q, P)) == pytest.approx(0.02, rel=TEN_ROUNDINGS)
    moving = {abs(m) for m, a, b in zip(chain.mode_numbers, Q, P, strict=True) if a or b}
    assert moving == {abs(q)}


def test_shares_and_phases_are_those_of_an_fpu_trajectory():
    chain, phases = Chain(8, alpha="0.3"), {2: "0.4", 3: 1}
    state = packet_state(chain, (3, 2), "0.02", shares={2: 3, 3: 1}, phases=phases)
    harmonic = chain.harmonic_energies(*state)
    assert harmonic[1] / harmonic[2] == pytest.approx(3, rel=TEN_ROUNDINGS)
    amplitudes = {q: np.sqrt(2 * harmonic[q - 1]) / chain.frequencies()[q - 1] for q in (2, 3)}
    assert np.allclose(state, fpu_trajectory(chain, amplitudes, phases), rtol=0, atol=ROUNDING)


def test_a_wave_of_a_ring_travels_and_two_stand():
    """In the linear chain x_j(t) of mode q is x_(j - 1)(t - 2 pi q / (N Omega_q)): the momentum follows from the slope."""
    ring = Chain(8, beta="1e-9", ends="periodic")
    Q, P = packet_state(ring, (1,), "0.02")
    x, p, Omega = ring.positions(Q), ring.positions(P), ring.linear_frequency(1)
    quarter = ring.positions(packet_state(ring, (1,), "0.02", phases={1: np.pi / 2})[0])
    assert np.allclose(p, float(Omega) * quarter, rtol=0, atol=ROUNDING)
    assert np.allclose(np.roll(x, 2), quarter, rtol=0, atol=ROUNDING)
    back = packet_state(ring, (-1,), "0.02")
    assert np.allclose(ring.positions(back[0]), -x, rtol=0, atol=ROUNDING)
    assert np.allclose(ring.positions(back[1]), p, rtol=0, atol=ROUNDING)
    standing = packet_state(ring, (1, -1), "0.02")
    assert np.max(np.abs(ring.positions(standing[0]))) < ROUNDING


@settings(max_examples=20, deadline=None)
@given(st.integers(2, 12), st.sampled_from(["fixed", "periodic"]), st.integers(0, 99))
def test_particles_come_back(N, ends, seed):
    chain = Chain(N, alpha="0.3", ends=ends)
    x, p = np.random.default_rng(seed).normal(size=(2, chain.kind_of_ends.particles))
    if chain.periodic:
        x, p = x - x.mean(), p - p.mean()
    Q, P = particle_state(chain, x, p)
    assert np.allclose(chain.positions(Q), x, rtol=0, atol=ROUNDING)
    assert np.allclose(chain.positions(P), p, rtol=0, atol=ROUNDING)


@pytest.mark.long
def test_a_state_of_a_torus_is_the_particles_state():
    torus = symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.1"}, method="series", order=2)
    ring = unfold(torus.in_doubles())
    state = particle_state(ring.chain, ring.x(0.0), ring.p(0.0))
    assert np.allclose(state, ring.state(), rtol=0, atol=ROUNDING)


SOFT, RING = Chain(4, alpha=1), Chain(8, alpha="0.3", ends="periodic")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: random_state(SOFT, 0, 1), "energy = 0: allowed is a positive number"),
        (lambda: random_state(SOFT, "0.1", -1), "seed = -1"),
        (lambda: random_state(Chain("N", alpha=1), "0.1", 1), "N = 'N'"),
        (lambda: random_state("chain", "0.1", 1), "chain"),
        (lambda: packet_state(SOFT, (), "0.1"), "seeds = "),
        (lambda: packet_state(SOFT, (4,), "0.1"), "seeds = "),
        (lambda: packet_state(RING, (0,), "0.1"), "seeds = "),
        (lambda: packet_state(SOFT, (1, 2), "0.1", shares={1: 1}), "shares = .*every seed once"),
        (lambda: packet_state(SOFT, (1, 2), "0.1", shares={1: 1, 2: -1}), "shares = "),
        (lambda: packet_state(SOFT, (1,), "0.1", phases={2: 1}), "phases = 2"),
        (lambda: packet_state(SOFT, (1,), "0.1", phases=[1]), "phases = "),
        (lambda: packet_state(Chain(2, beta=-1), (1,), 100), "energy = '100': allowed is what states in this direction have, at most 0.5"),
        (lambda: packet_state(Chain(2, alpha=1, ends="periodic"), (1,), "nan"), "energy"),
        (lambda: particle_state(SOFT, [0, 0], [0, 0]), "displacements = "),
        (lambda: particle_state(SOFT, [0, 0, 0], [0, 0, np.inf]), "momenta = 'nan or inf'"),
        (lambda: particle_state(SOFT, [[0, 0, 0]], [0, 0, 0]), "displacements = "),
        (lambda: particle_state(RING, [0] * 8, [1] * 8), "momenta = 'sum 8'.*its centre rests"),
    ],
)
def test_refusals_say_what_is_wrong(call, words):
    with pytest.raises(InputError, match=words):
        call()
