"""Do profiles stay put as N grows, and do slopes follow log(energy)? On cases small enough for every test run."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, fpu_trajectory, integrate, profile_invariance, profile_law, slope_by_energy
from tests.refusals import each, refused
from tests.tolerances import LEAST_SQUARES, RANDOM_RATE, ROUNDING, SMALL_CHANGE, THOUSAND_ROUNDINGS

ALPHA, BETA = Chain(N=32, alpha="0.33"), Chain(N=32, beta="0.3")


@pytest.mark.parametrize("chain", [ALPHA, BETA])
def test_rate_of_the_laws_themselves(chain):
    """Spectra made of the laws: d slope / d log10 eps = 1/M."""
    energies = [1e-8, 1e-7, 1e-6, 1e-5]
    kappa = np.arange(1, 32) / 32
    spectra = np.array([10 ** profile_law(chain, 4, e)(kappa) for e in energies])
    trend = slope_by_energy(chain, 4, energies, spectra, floor=0.0)
    assert trend.rate == pytest.approx(8.0, rel=LEAST_SQUARES)  # least squares twice
    assert trend.error < LEAST_SQUARES


@pytest.mark.parametrize(("chain", "order"), [(Chain(N=16, alpha="0.33"), 7), (Chain(N=16, beta="0.3"), 4)])
def test_middle_slopes_of_tori_follow_log_energy(chain, order):
    """At low energy E^(k) is the leading term, eps^(k+1) or eps^(2k+1): the slope of the middle modes moves by 1/M a decade."""
    energies = [1e-12, 1e-11, 1e-10]
    tori = [symfpu.torus(chain, (1, 2), energy=symfpu.Energy(e * 16, harmonic=True), method="series", order=order) for e in energies]
    spectra = np.array([torus.average_spectrum() for torus in tori])
    trend = slope_by_energy(chain, 2, energies, spectra, modes="middle", floor=0.0)
    assert trend.rate == pytest.approx(8.0, rel=SMALL_CHANGE)  # the next order is smaller by lambda / M^2 < 1e-4
    with pytest.raises(InputError, match="spectra"):
        slope_by_energy(chain, 2, energies[:2], spectra[:2])


def test_one_spectrum_by_hand():
    result = profile_invariance(ALPHA, "1/8", 1e-6, (16, 32, 64), 500.0, scheme="aba864_modes", step=1.0)
    chain = result.chains[1]
    assert chain == ALPHA
    Q, P = fpu_trajectory(chain, symfpu.packet_amplitudes(chain, (1, 2, 3, 4), 32e-6))
    orbit = integrate(chain, Q, P, 500.0, step=1.0, scheme="aba864_modes", samples=np.arange(0, 501.0))
    E = orbit.harmonic_energies()
    by_hand = (E[1:-1].sum(axis=0) + 0.5 * (E[0] + E[-1])) / 500
    assert result.spectra[1][0] == pytest.approx(by_hand / by_hand.sum(), rel=THOUSAND_ROUNDINGS)  # the same looks, summed in another order
    level = math.log10(32 * result.spectra[1][0][5])  # q = 6: of the kappas q/16 of all sizes, 3/16 alone is in the middle of D_1
    assert result.levels()[0][1, 0] == pytest.approx(level, rel=ROUNDING)
    common = np.arange(3, 16)  # q/16 beyond M = 1/8
    logs = np.log10([e[0, chain.N // 16 * common - 1] for e, chain in zip(result.spectra, result.chains, strict=True)])
    for per_mode, values in ((False, logs), (True, logs + np.log10([[16], [32], [64]]))):
        change = values.max(axis=0) - values.min(axis=0)
        moved, kappa = result.moved(per_mode=per_mode)
        assert moved == pytest.approx(change.max(), rel=THOUSAND_ROUNDINGS)
        assert kappa == common[np.argmax(change)] / 16


def test_equal_phases_raise_the_tail_and_random_ones_do_not():
    """alpha, D_1: with equal phases s terms add up, E_q/eps ~ N; with random phases their squares do, N^0 (docs/localization.md).

    Packets of few modes are still on the way there.
    """
    sizes, T = (128, 256, 512), 1000.0
    equal = profile_invariance(ALPHA, "1/8", 1.5625e-8, sizes, T, step=1.0)
    random = profile_invariance(ALPHA, "1/8", 1.5625e-8, sizes, T, phases="random", realisations=6, seed=1, step=1.0)
    assert 0.7 < equal.growth[1].rate < equal.late_growth[1] < 1.0  # 0.84, 0.91
    assert random.growth[1].rate == pytest.approx(0.0, abs=RANDOM_RATE)  # six realisations of three sizes
    assert np.isnan(equal.levels()[1]).all()
    assert (random.levels()[1][:, 0] > 0).all()
    assert "equal phases" in repr(equal)
    assert equal.slope_rate.rate == pytest.approx(np.polyfit(np.log10(sizes), [f.line.slope for f in equal.fits], 1)[0])
    again = profile_invariance(ALPHA, "1/8", 1.5625e-8, sizes, T, phases="random", realisations=6, seed=1, step=1.0)
    assert np.array_equal(again.spectra[2], random.spectra[2])


GOOD = {"chain": ALPHA, "fraction": "1/8", "specific_energy": 1e-6, "sizes": (16, 32, 64), "T": 10.0}


@each(
    fraction=["1/5", 2],
    sizes=[(16, 32), (16, 24, 64), (16, 16, 32)],
    specific_energy=[0],
    T=[-10.0],
    phases=["zero"],
    realisations=[2],
    scheme=["euler"],
)
def test_bad_input_is_named(name, value):
    refused(profile_invariance, name, value, **GOOD)


@each(realisations=[0], seed=[-1])
def test_bad_draws_are_named(name, value):
    refused(profile_invariance, name, value, phases="random", **GOOD)


def test_levels_compare_the_same_kappas():
    """Profiles on one line in kappa, at any size, have E_q/eps ~ N exactly, whatever their slope."""
    chains = tuple(replace(ALPHA, N=N) for N in (64, 128, 256))
    spectra = tuple(10.0 ** (-40 * np.arange(1, chain.N) / chain.N)[None, :] for chain in chains)
    floors = tuple(np.zeros(chain.N - 1) for chain in chains)
    found = symfpu.ProfileInvariance(Fraction(1, 8), 1e-8, 1.0, "equal", chains, spectra, floors, ())
    assert [trend.rate for trend in found.growth.values()] == pytest.approx([1.0] * 6, abs=THOUSAND_ROUNDINGS)
    assert list(found.late_growth.values()) == pytest.approx([1.0] * 6, abs=THOUSAND_ROUNDINGS)
