"""Tori of a given energy: both energies, both ratios, both couplings; energies that no torus has."""

import numpy as np
import pytest

from symfpu import Chain, NoTorusAtEnergy, SymfpuError, torus_at_amplitudes, torus_at_energy
from symfpu.tori import at_energy
from tests.refusals import each, refused
from tests.tolerances import FIXED_ENERGY, LAST_DIGIT, RELATIVE_SHIFT, TEN_ROUNDINGS

CASES = [
    (Chain(16, alpha="0.33"), (1, 2), "0.01", 4),
    (Chain(16, alpha="-0.33"), (14,), "0.05", 6),
    (Chain(2, beta=1), (1,), "0.2", 6),
    (Chain(9, beta="-0.2"), (1, 3, 8), "0.02", 3),
    (Chain(8, alpha="0.2", beta="0.3"), (3, 7), "0.05", 4),
]


def measured(torus, harmonic):
    return torus.harmonic_energies().sum() if harmonic else torus.energy()


@pytest.mark.long
@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.parametrize(("chain", "seeds", "energy", "order"), CASES, ids=str)
def test_energy_and_mode_energies_are_met(chain, seeds, energy, order, harmonic):
    weights = {q: i + 1 for i, q in enumerate(seeds)}
    torus = torus_at_energy(chain, seeds, energy, harmonic=harmonic, order=order, energy_ratio=weights)
    assert measured(torus, harmonic) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    modes = torus.average_spectrum()[np.array(seeds) - 1]
    assert modes / modes.sum() == pytest.approx(np.array(list(weights.values())) / sum(weights.values()), rel=FIXED_ENERGY)
    again = torus_at_amplitudes(chain, torus.amplitudes, order)
    assert [float(w) for w in again.frequencies] == pytest.approx([float(w) for w in torus.frequencies], rel=TEN_ROUNDINGS)
    assert again.warnings == torus.warnings


@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.parametrize(("chain", "seeds", "energy", "order"), CASES, ids=str)
def test_energy_and_amplitude_ratio_are_met(chain, seeds, energy, order, harmonic):
    ratio = {q: 1 / (i + 1) for i, q in enumerate(seeds)}
    torus = torus_at_energy(chain, seeds, energy, harmonic=harmonic, order=order, amplitude_ratio=ratio)
    assert measured(torus, harmonic) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    for i, q in enumerate(seeds):
        assert torus.amplitudes[q] / torus.amplitudes[seeds[0]] == pytest.approx(1 / (i + 1), rel=LAST_DIGIT)


@pytest.mark.long
def test_equal_mode_energies_are_the_default_and_phases_count():
    torus = torus_at_energy(*CASES[0][:3], harmonic=True, order=6, phases={1: 1, 2: 2})
    modes = torus.average_spectrum()[:2]
    assert modes[0] == pytest.approx(modes[1], rel=FIXED_ENERGY)
    assert torus.phases == {1: 1.0, 2: 2.0}
    assert measured(torus, True) == pytest.approx(0.01, rel=FIXED_ENERGY)


@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.long
def test_many_digits(harmonic):
    import mpmath

    chain = Chain(8, beta="0.3")
    torus = torus_at_energy(chain, (1, 2), "0.1", harmonic=harmonic, order=3, digits=30)
    with mpmath.workdps(40):
        assert abs(measured(torus, harmonic) / mpmath.mpf("0.1") - 1) < mpmath.mpf(10) ** -30
    doubles = torus_at_energy(chain, (1, 2), "0.1", harmonic=harmonic, order=3)
    assert [float(a) for a in torus.amplitudes.values()] == pytest.approx(list(doubles.amplitudes.values()), rel=FIXED_ENERGY)


@pytest.mark.long
@pytest.mark.parametrize(
    ("chain", "seeds", "energy"),
    [
        (Chain(16, alpha="0.33"), (2,), "1e8"),
        (Chain(8, beta="-0.5"), (3,), "100"),
        pytest.param(Chain(8, alpha="0.3", beta="-0.2"), (1, 7), "100", marks=pytest.mark.long),
    ],
    ids=str,
)
def test_unreachable_energies_say_how_far_the_family_goes(chain, seeds, energy):
    with pytest.raises(NoTorusAtEnergy) as caught:
        torus_at_energy(chain, seeds, energy, harmonic=False, order=2)
    error = caught.value
    assert isinstance(error, SymfpuError)
    assert 0 < error.reached < error.energy == float(energy)
    assert error.reason in str(error)
    assert "\n" not in str(error)
    last = torus_at_amplitudes(chain, error.amplitudes, 2)
    assert float(last.energy()) == pytest.approx(error.reached, rel=RELATIVE_SHIFT)
    assert last.residual(64) < 1.1 * at_energy.LARGEST_RESIDUAL


@each(
    harmonic=[1],
    energy=[0, "-1", float("inf"), "1e-50"],
    seeds=[(1, 1)],
    energy_ratio=[{1: 1}, {1: 1, 2: 0}],
    amplitude_ratio=[{1: 1, 3: 1}, (1, 2)],
    frequency_order=[7],
)
def test_bad_arguments_are_refused_by_name(name, value):
    refused(torus_at_energy, name, value, chain=Chain(8, alpha="0.3"), seeds=(1, 2), energy="0.01", harmonic=False, order=4)


def test_two_ratios_are_refused():
    equal = {1: 1, 2: 1}
    refused(torus_at_energy, "energy_ratio", equal, chain=Chain(8, alpha="0.3"), seeds=(1, 2), energy=1, order=4, amplitude_ratio=equal)
