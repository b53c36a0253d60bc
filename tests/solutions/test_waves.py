"""Travelling waves of one seed: by frequency, amplitude and energy, against refined series."""

import numpy as np
import pytest

import symfpu
from symfpu import (
    InputError,
    NoRealAmplitude,
    lindstedt,
    refine,
    solve_amplitudes,
)
from tests.refinement.test_ring_tori import TODA
from tests.tolerances import CONVERGED_DIGITS, PROMISED_RESIDUAL
from tests.tori.test_ring_torus import ring

CASES = [(8, 1, "0.5", TODA), (5, -2, "0.4", {"alpha": "0.3", "beta": "0.2"})]
LONG = [
    (2, 1, "0.5", {"beta": 1}),
    (3, 1, "0.3", {"alpha": 1}),
    (5, 2, "0.05", {"potential": "lj:12,6"}),
    (8, 4, "2", {"potential": "morse:1/2"}),
    (8, 2, "-1", {"beta": "-0.1"}),
    (64, 3, "0.5", {"alpha": "0.3", "beta": 1}),
    (8, 3, "30", {"beta": 1}),
]
ALL = [*CASES, *(pytest.param(*case, marks=pytest.mark.long) for case in LONG)]


@pytest.mark.parametrize(("N", "q", "A", "law"), ALL)
def test_amplitude_frequency_and_energy_find_the_same_wave(N, q, A, law):
    chain = ring(N, **law)
    found = symfpu.torus(chain, (q,), amplitudes={q: A})
    assert found.residual() < PROMISED_RESIDUAL
    assert np.isclose(found.amplitude, float(A), rtol=CONVERGED_DIGITS)
    by_frequency = symfpu.torus(chain, (q,), frequencies=(found.frequency,))
    assert by_frequency.frequency == found.frequency
    assert np.isclose(by_frequency.amplitude, abs(float(A)), rtol=CONVERGED_DIGITS)
    by_energy = symfpu.torus(chain, (q,), energy=repr(float(found.energy())))
    assert np.isclose(float(by_energy.frequency), float(found.frequency), rtol=CONVERGED_DIGITS)


@pytest.mark.parametrize(("N", "q", "A", "law"), CASES)
def test_it_goes_on_by_one_site_in_a_part_of_its_period(N, q, A, law):
    found = symfpu.torus(ring(N, **law), (q,), amplitudes={q: A})
    delay = 2 * np.pi * q / N / float(found.frequency)
    assert np.abs(np.roll(found.x(0.7 + delay), -1) - found.x(0.7)).max() < PROMISED_RESIDUAL


def test_it_is_the_refined_torus_of_its_series():
    chain = ring(9, alpha="0.3")
    series = lindstedt(chain, (2,), ("1.2859",), 6)
    one = refine(solve_amplitudes(series))
    other = symfpu.torus(chain, (2,), frequencies=("1.2859",))
    assert np.isclose(one.amplitude, other.amplitude, rtol=CONVERGED_DIGITS)
    assert np.allclose(one.x(2.0), other.x(2.0), atol=PROMISED_RESIDUAL)


def test_near_a_guess_it_is_the_same():
    chain = ring(8, alpha="0.3", beta="0.2")
    guess = symfpu.torus(chain, (-1,), amplitudes={-1: "0.4"})
    energy = symfpu.torus(chain, (-1,), energy="0.1")
    for found, near in (
        (refine(guess, energy="0.1"), energy),
        (refine(guess, frequencies=energy.frequencies), energy),
        (refine(guess, amplitudes=energy.amplitudes), energy),
        (symfpu.torus(chain, (-1,), energy=symfpu.Energy(energy.average_spectrum().sum(), harmonic=True)), energy),
    ):
        assert np.isclose(found.amplitude, near.amplitude, rtol=CONVERGED_DIGITS)


def test_arguments_are_checked():
    beta = ring(8, beta=1)
    for name, value in (
        ("amplitudes", {1: 0}),
        ("frequencies", (-1,)),
        ("energy", 0),
    ):
        with pytest.raises(InputError, match=f"^{name}"):
            symfpu.torus(beta, (1,), **{name: value})
    with pytest.raises(InputError, match="seeds"):
        symfpu.torus(beta, (0,), amplitudes={0: 1})
    with pytest.raises(NoRealAmplitude):
        symfpu.torus(beta, (1,), frequencies=("0.7",))
    with pytest.raises(symfpu.UndeterminedAmplitudes):
        symfpu.torus(ring(8, alpha="0.3"), (4,), frequencies=("2.1",))
