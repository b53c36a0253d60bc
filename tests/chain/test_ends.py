"""A chain closed to a ring: its modes and energies against sums, and every public door that does not know rings."""

import inspect
import pickle
from fractions import Fraction

import numpy as np
import pytest

import symfpu
from symfpu import Chain
from symfpu.chain import bonds
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from tests.tolerances import ROUNDING

RING = Chain(8, alpha="0.3", ends="periodic")
SIZES = (2, 3, 4, 5, 8, 9)

# arguments by name for every public function that takes a chain: it must refuse a ring before it looks at them
ARGUMENTS = {
    "Q": np.zeros(7), "P": np.zeros(7), "T": 1.0, "step": 0.1, "seeds": (1, 2), "seed": 1, "q": 3, "s": 1, "k": 1,
    "order": 2, "amplitude": "0.1", "amplitudes": {1: "0.1"}, "energy": "0.1", "to_energy": "0.1", "frequency": "0.39",
    "energies": 0.1, "harmonic": False, "expression": 1, "spectrum": np.ones(7), "times": np.arange(1.0, 9.0),
    "averages": np.ones((8, 7)), "groups": [[1], [2]], "specific_energy": 0.01, "fraction": "1/8", "sizes": (8, 16),
    "specific_energies": (0.01, 0.02), "spectra": np.ones((2, 7)), "harmonics": np.array([[1]]),
    "cosines": np.zeros((1, 7)), "frequencies": (Fraction(1, 2),), "iterations": 1, "degree": 2, "sigma": 0.0, "phases": {}, "mode": 3,
}  # fmt: skip
# results: the functions that make them are tested instead
RESULTS = {
    "AlignmentIndices",
    "AtlasBorder",
    "BirkhoffForm",
    "ExistenceProof",
    "Family",
    "ForetoldIndices",
    "FrequencyAnalysis",
    "FrequencyMap",
    "LindstedtSeries",
    "NormalFrequencySeries",
    "Orbit",
    "ProfileInvariance",
    "RefinedRingTorus",
    "RefinedTorus",
    "ResidualProof",
    "RingTorus",
    "ShotOrbit",
    "StabilityProof",
    "StayProof",
    "TravellingSeries",
    "Twist",
    "TwistAtRest",
}
TAKE_RINGS = {"travelling_waves", "integrate", "alignment_indices", "seconds_needed"}
TAKE_RINGS |= {"family", "toda_gaps", "toda_invariants", "toda_torus", "travelling_breather"}
TAKE_RINGS |= {"packet_state", "particle_state", "random_state", "read_state", "normal_frequency_series"}


def takes_a_chain(name):
    try:
        parameters = inspect.signature(getattr(symfpu, name)).parameters
    except ValueError:  # errors
        return False
    return "chain" in parameters


DOORS = sorted(set(filter(takes_a_chain, symfpu.__all__)) - RESULTS - TAKE_RINGS)


def displacements(N, count=3):
    x = np.random.default_rng(N).normal(size=(count, N))
    return x - x.mean(axis=-1, keepdims=True)


def test_the_doors_are_found():
    assert len(DOORS) > 30
    assert {"lindstedt", "integrate", "frequency_shift", "FourierTorus", "family"} <= {*DOORS, *TAKE_RINGS}


@pytest.mark.parametrize("name", DOORS)
def test_a_door_that_does_not_know_rings_refuses_one_by_name(name):
    door = getattr(symfpu, name)
    required = [p.name for p in inspect.signature(door).parameters.values() if p.default is p.empty]
    arguments = {p: ARGUMENTS[p] for p in required if p != "chain"}
    with pytest.raises(InputError, match=r"Chain\(N=8, alpha=0.3, ends='periodic'\).*fixed ends.*docs/chains.md") as caught:
        door(chain=RING, **arguments)
    assert "\n" not in str(caught.value)


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


@pytest.mark.parametrize(("N", "modes"), [(2, (1,)), (3, (-1, 1)), (4, (-1, 1, 2)), (5, (-2, -1, 1, 2)), (6, (-2, -1, 1, 2, 3))])
def test_wave_numbers(N, modes):
    chain = Chain(N, beta=1, ends="periodic")
    assert chain.mode_numbers == chain.seeds_of(modes) == modes
    expected = 2 * np.abs(np.sin(np.pi * np.array(modes) / N))
    assert np.allclose(chain.frequencies(), expected, rtol=ROUNDING, atol=0)
    assert np.allclose(chain.frequencies(MULTIPRECISION).astype(float), expected, rtol=ROUNDING, atol=0)


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


def test_many_digits_on_a_ring_are_refused():
    Q = MULTIPRECISION.array(np.ones(7))
    with pytest.raises(InputError, match="doubles"):
        RING.positions(Q)
    with pytest.raises(InputError, match="doubles"):
        RING.modes(MULTIPRECISION.array(np.ones(8)))
