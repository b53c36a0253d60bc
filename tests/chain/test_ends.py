"""A chain closed to a ring: its modes and energies against sums, and every public door that does not know rings."""

import pickle

import numpy as np
import pytest

from symfpu import Chain, InputError
from symfpu.chain import bonds
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from tests.tolerances import ROUNDING

RING = Chain(8, alpha="0.3", ends="periodic")
SIZES = (2, 3, 4, 5, 8, 9)

TAKE_RINGS = {"lindstedt", "series_bytes", "integrate", "alignment_indices", "seconds_needed"}
TAKE_RINGS |= {"family", "toda_gaps", "toda_invariants", "toda_torus", "torus"}
TAKE_RINGS |= {"packet_state", "particle_state", "random_state", "read_state", "normal_frequency_series"}


def displacements(N, count=3):
    x = np.random.default_rng(N).normal(size=(count, N))
    return x - x.mean(axis=-1, keepdims=True)


CLOSED_FORMS = {
    "B": lambda: RING.B(1, 2, 3),
    "C": lambda: RING.C(1, 1, 1, 1),
    "coupled": lambda: list(RING.coupled(1, 2)),
    "hamiltonian": RING.hamiltonian,
    "equations_of_motion": RING.equations_of_motion,
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_closed_forms_of_fixed_ends_refuse_a_ring(name):
    with pytest.raises(InputError, match="periodic"):
        CLOSED_FORMS[name]()


def test_ends_are_part_of_the_chain():
    fixed = Chain(8, alpha="0.3")
    assert fixed != RING
    assert hash(RING) != hash(fixed)
    assert Chain(8, alpha="0.3", ends="fixed") == fixed
    assert pickle.loads(pickle.dumps(RING)) == RING
    assert repr(RING) == "Chain(N=8, alpha=0.3, ends='periodic')"
    assert eval(repr(RING)) == RING
    assert repr(fixed) == "Chain(N=8, alpha=0.3)"
    assert RING.at(N=16) == Chain(16, alpha="0.3", ends="periodic")
    assert RING.at(beta=1) == Chain(8, alpha="0.3", beta=1, ends="periodic")


@pytest.mark.parametrize("ends", ["ring", "", None, 1, ["fixed"]])
def test_unknown_ends(ends):
    with pytest.raises(InputError, match="'fixed' or 'periodic'"):
        Chain(8, alpha=1, ends=ends)


def test_a_ring_of_any_length_is_refused():
    with pytest.raises(InputError, match="put a number for N"):
        Chain("N", alpha=1, ends="periodic")


@pytest.mark.parametrize("seeds", [(0,), (5,), (-4,), (1, 1), (), ("1",), (True,), 1])
def test_modes_that_a_ring_does_not_have(seeds):
    with pytest.raises(InputError) as caught:
        RING.seeds_of(seeds)
    assert "\n" not in str(caught.value)
    assert "-3..4 without 0" in str(caught.value)


@pytest.mark.parametrize("N", SIZES)
def test_transform_is_the_sum_of_travelling_waves(N):
    chain, x = Chain(N, alpha=1, ends="periodic"), displacements(N)
    phases = np.exp(-2j * np.pi * np.outer(np.arange(N), chain.mode_numbers) / N) / np.sqrt(N)
    Q = chain.modes(x)
    assert Q.shape == (3, N - 1)
    assert np.abs(Q - x @ phases).max() < ROUNDING
    assert np.abs(chain.positions(Q) - x).max() < ROUNDING
    assert np.abs(chain.modes(x + 1.5) - Q).max() < 10 * ROUNDING  # where the ring is does not matter


@pytest.mark.parametrize("N", SIZES)
def test_energies_and_accelerations_are_those_of_particles_and_bonds(N):
    chain = Chain(N, alpha="0.3", beta="0.2", ends="periodic")
    x, p = displacements(N), displacements(N + 0)[::-1]
    Q, P = chain.modes(x), chain.modes(p)
    r = np.stack([x[:, (j + 1) % N] - x[:, j] for j in range(N)], axis=-1)
    law = chain.law(DOUBLES)
    H = (p**2).sum(axis=-1) / 2 + bonds.potential(law, r).sum(axis=-1)
    assert np.allclose(chain.stretches(Q), r, rtol=0, atol=10 * ROUNDING)
    assert np.allclose(chain.energy(Q, P), H, rtol=10 * ROUNDING)
    harmonic = (p**2).sum(axis=-1) / 2 + (r**2).sum(axis=-1) / 2
    assert np.allclose(chain.harmonic_energies(Q, P).sum(axis=-1), harmonic, rtol=10 * ROUNDING)
    tension = bonds.tension(law, r)
    force = np.stack([tension[:, j] - tension[:, j - 1] for j in range(N)], axis=-1)
    assert np.allclose(chain.positions(chain.accelerations(Q)), force, rtol=0, atol=100 * ROUNDING)


@pytest.mark.parametrize("N", [2, 3, 6, 7])
def test_fixed_ends_are_the_odd_part_of_the_ring_of_twice_the_length(N):
    fixed, ring = Chain(N, alpha="0.4", beta="0.1"), Chain(2 * N, alpha="0.4", beta="0.1", ends="periodic")
    assert ring.mu == fixed.mu
    assert ring.turn == fixed.turn
    x = np.random.default_rng(N).normal(size=N - 1)
    odd = np.concatenate([[0.0], x, [0.0], -x[::-1]])
    Q, ring_Q = fixed.modes(x), ring.modes(odd)
    assert np.isclose(ring.energy(ring_Q, 0 * ring_Q), 2 * fixed.energy(Q, 0 * Q), rtol=10 * ROUNDING)
    accelerations = ring.positions(ring.accelerations(ring_Q))
    assert np.allclose(accelerations[1:N], fixed.positions(fixed.accelerations(Q)), rtol=0, atol=100 * ROUNDING)
    standing = {q: Q_q for q, Q_q in zip(ring.mode_numbers, ring_Q, strict=True) if 0 < q < N}
    assert np.allclose(list(standing.values()), -1j * Q, rtol=0, atol=10 * ROUNDING)


@pytest.mark.parametrize("state", [np.ones(7) * 1j, np.ones(6), np.full((2, 7), "x"), np.arange(7.0), 1.0])
def test_a_state_that_no_ring_has(state):
    with pytest.raises(InputError) as caught:
        RING.positions(state)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("N", SIZES)
def test_many_digits_on_a_ring_are_those_of_doubles_and_more(N):
    """There and back; what is no state of a ring is refused as in doubles."""
    chain, x = Chain(N, alpha="0.3", ends="periodic"), displacements(N)
    Q = chain.modes(x)
    with MULTIPRECISION.context(30):
        exact = MULTIPRECISION.array(x)
        exact = exact - exact.sum(axis=-1, keepdims=True) / N
        modes = chain.modes(exact)
        assert np.abs(modes.astype(complex) - Q).max() < ROUNDING
        assert float(np.abs(chain.positions(modes) - exact).max()) < ROUNDING**2
        energies = chain.energy(modes, modes).astype(float), chain.energy(Q, Q)
        assert np.allclose(*energies, rtol=ROUNDING, atol=0)
        forces = chain.accelerations(modes).astype(complex), chain.accelerations(Q)
        assert np.allclose(*forces, rtol=ROUNDING, atol=ROUNDING)
        if N > 2:
            with pytest.raises(InputError, match=r"^Q = .*conj"):
                chain.positions(1j * modes)
        with pytest.raises(InputError, match=r"^Q = "):
            chain.positions(modes[:, :0])
