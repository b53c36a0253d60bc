"""Tori of a given energy: both energies, both ratios, both couplings; energies that no torus has."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, Energy, InputError, NoTorusAtEnergy, SymfpuError
from symfpu.tori import at_energy
from tests.refusals import each
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
    torus = symfpu.torus(chain, seeds, energy=symfpu.Energy(energy, harmonic=harmonic, energy_ratio=weights), method="series", order=order)
    assert measured(torus, harmonic) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    modes = torus.average_spectrum()[np.array(seeds) - 1]
    assert modes / modes.sum() == pytest.approx(np.array(list(weights.values())) / sum(weights.values()), rel=FIXED_ENERGY)
    again = symfpu.torus(chain, tuple(torus.amplitudes), amplitudes=torus.amplitudes, method="series", order=order)
    assert [float(w) for w in again.frequencies] == pytest.approx([float(w) for w in torus.frequencies], rel=TEN_ROUNDINGS)
    assert again.warnings == torus.warnings


@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.parametrize(("chain", "seeds", "energy", "order"), CASES, ids=str)
def test_energy_and_amplitude_ratio_are_met(chain, seeds, energy, order, harmonic):
    ratio = {q: 1 / (i + 1) for i, q in enumerate(seeds)}
    torus = symfpu.torus(chain, seeds, energy=symfpu.Energy(energy, harmonic=harmonic, amplitude_ratio=ratio), method="series", order=order)
    assert measured(torus, harmonic) == pytest.approx(float(energy), rel=FIXED_ENERGY)
    for i, q in enumerate(seeds):
        assert torus.amplitudes[q] / torus.amplitudes[seeds[0]] == pytest.approx(1 / (i + 1), rel=LAST_DIGIT)


@pytest.mark.long
def test_equal_mode_energies_are_the_default():
    chain, seeds, energy, _ = CASES[0]
    torus = symfpu.torus(chain, seeds, energy=symfpu.Energy(energy, harmonic=True), method="series", order=6)
    modes = torus.average_spectrum()[:2]
    assert modes[0] == pytest.approx(modes[1], rel=FIXED_ENERGY)
    assert measured(torus, True) == pytest.approx(0.01, rel=FIXED_ENERGY)


@pytest.mark.parametrize("harmonic", [False, True])
@pytest.mark.long
def test_many_digits(harmonic):
    import mpmath

    chain = Chain(8, beta="0.3")
    torus = symfpu.torus(chain, (1, 2), energy=symfpu.Energy("0.1", harmonic=harmonic), method="series", order=3, digits=30)
    with mpmath.workdps(40):
        assert abs(measured(torus, harmonic) / mpmath.mpf("0.1") - 1) < mpmath.mpf(10) ** -30
    doubles = symfpu.torus(chain, (1, 2), energy=symfpu.Energy("0.1", harmonic=harmonic), method="series", order=3)
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
        symfpu.torus(chain, seeds, energy=energy, method="series", order=2)
    error = caught.value
    assert isinstance(error, SymfpuError)
    assert 0 < error.reached < error.energy == float(energy)
    assert error.reason in str(error)
    assert "\n" not in str(error)
    last = symfpu.torus(chain, tuple(error.amplitudes), amplitudes=error.amplitudes, method="series", order=2)
    assert float(last.energy()) == pytest.approx(error.reached, rel=RELATIVE_SHIFT)
    assert last.residual(64) < 1.1 * at_energy.LARGEST_RESIDUAL


@each(
    energy=[0, "-1", float("inf"), "1e-60", [1]],
    seeds=[(1, 1), 1],
    order=[1, 2.0],
)
def test_bad_arguments_are_refused_by_name(name, value):
    given = {"seeds": (1, 2), "energy": "0.01", "method": "series", "order": 4}
    with pytest.raises(InputError) as caught:
        symfpu.torus(Chain(8, alpha="0.3"), **given | {name: value})
    assert caught.value.argument == name


@pytest.mark.parametrize(("name", "value"), [("energy_ratio", {1: 1}), ("energy_ratio", {1: 1, 2: 0}), ("amplitude_ratio", (1, 2))])
def test_bad_ratios_are_refused_by_name(name, value):
    with pytest.raises(InputError, match=rf"^{name}"):
        symfpu.torus(Chain(8, alpha="0.3"), (1, 2), energy=Energy(1, **{name: value}), method="series", order=4)


@each(value=[0, "one"], harmonic=[1, "yes"], energy_ratio=[{1: 1}])
def test_bad_energies_are_refused_by_name(name, value):
    given = {"value": "0.01", "amplitude_ratio": {1: 1, 2: 1} if name == "energy_ratio" else None}
    with pytest.raises(InputError) as caught:
        Energy(**given | {name: value})
    assert caught.value.argument == ("energy" if name == "value" else name)
