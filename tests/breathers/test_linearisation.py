"""The linearisation of long chains, whose far coefficients are eliminated, beside the whole matrix."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, refine
from symfpu.breathers.equations import Balance
from symfpu.breathers.linearisation import NEAR_RESONANCE, SecondVariation
from tests.tolerances import PERIODIC_ORBIT, THOUSAND_ROUNDINGS

CASES = (
    (Chain(24, alpha="0.33"), 1, "0.6"),
    (Chain(24, beta="0.5"), 3, "0.3"),
    (Chain(16, potential="toda:1/2"), 2, "0.3"),
    (Chain(24, alpha="0.2", beta="0.3"), 12, "0.1"),
)


@pytest.mark.parametrize(("chain", "seed", "amplitude"), CASES, ids=repr)
def test_elimination_changes_neither_index_nor_solutions(chain, seed, amplitude):
    orbit = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    balance = Balance(chain, seed, len(orbit.cosines) + 3)
    z = balance.vector(orbit.cosines, orbit.origin.sigma)
    slopes = balance.slopes(z)
    resonant = balance.near_resonance(slopes, z, NEAR_RESONANCE)
    assert 0 < resonant.sum() < len(z) - 1
    whole, near = (SecondVariation(balance, slopes, z, chosen) for chosen in (resonant | True, resonant))
    assert near.index == whole.index
    right = np.random.default_rng(1).standard_normal((len(z), 3))
    expected, found = whole.solve(right, 0.0), near.solve(right, 0.0)
    assert np.abs(found - expected).max() <= THOUSAND_ROUNDINGS * np.abs(expected).max()
    rough = near.solve(right, 1e-4)
    left = [np.abs(near._times(x) - b).max() / np.abs(b).max() for x, b in zip(rough.T, right.T, strict=True)]
    assert max(left) <= 1e-4


@pytest.mark.parametrize(("chain", "seed", "amplitude"), CASES, ids=repr)
def test_own_divisors_are_the_diagonal(chain, seed, amplitude):
    orbit = symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})
    balance = Balance(chain, seed, len(orbit.cosines) - 1)
    z = balance.vector(orbit.cosines, orbit.origin.sigma)
    slopes = balance.slopes(z)
    diagonal = [balance.image(slopes, z, unit)[k] for k, unit in enumerate(np.eye(len(balance.n)))]
    assert balance.own_divisors(slopes, z) == pytest.approx(np.array(diagonal), abs=THOUSAND_ROUNDINGS)


@pytest.mark.long
@pytest.mark.parametrize(("N", "energy"), [(64, "0.01"), (128, "0.0002")])
def test_breathers_of_long_chains_are_those_of_the_invariance_equation(N, energy):
    """From rest past narrow gaps, beside Newton's method from a series."""
    chain = Chain(N, alpha="0.33")
    breather = symfpu.torus(chain, (1,), energy=energy)
    near = symfpu.torus(chain, (1,), energy=energy, method="series", order=8)
    expected = refine(near, energy=energy)
    assert breather.amplitude == pytest.approx(float(expected.amplitude), rel=PERIODIC_ORBIT)
    assert float(breather.frequency) == pytest.approx(float(expected.frequency), rel=PERIODIC_ORBIT)
