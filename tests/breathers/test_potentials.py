"""Breathers of chains of any potential: three routes to one orbit, Floquet multipliers, digits, and who is refused."""

import numpy as np
import pytest

from symfpu.breathers.at_energy import breather_at_energy
from symfpu.breathers.balance import Balance, breather_at_amplitude, half_period_points, periodic_orbit
from symfpu.breathers.digits import periodic_orbit_digits
from symfpu.breathers.floquet import floquet
from symfpu.breathers.shooting import shoot
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, UndeterminedAmplitudes
from symfpu.localization.floors import spectrum_floor
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from tests.tolerances import (
    NEWTON_RESIDUAL,
    ORBIT_IN_DOUBLES,
    PROMISED_RESIDUAL,
    RATE_OF_MU,
    SAME_ORBIT,
    SHOT_AMPLITUDE,
    TRANSFORM_OF_FORTY,
    UNSEEN_TAIL,
)

# laws with an amplitude at which they are far from harmonic
LAWS = {"toda:1/2": "0.3", "lj:12,6": "0.03", "poly:1/3,0,1/5,-1/4": "0.3", "poly:0,1/2,0,1/3": "0.4"}
POLYNOMIALS = [law for law in LAWS if law.startswith("poly")]


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("N", "seed"), [(2, 1), (8, 3), (9, 2)])
def test_harmonic_balance_shooting_and_newton_on_tori_agree(law, N, seed):
    orbit = breather_at_amplitude(Chain(N, potential=law), seed, LAWS[law])
    assert orbit.residual() < PROMISED_RESIDUAL
    start, size = orbit.positions(0.0), float(LAWS[law])
    shot = shoot(orbit.chain, seed, orbit.frequency, start)
    assert shot.start == pytest.approx(start, abs=SHOT_AMPLITUDE * size)
    assert shot.closure < NEWTON_RESIDUAL
    torus = refine(orbit)
    known = torus.by_harmonic()[: len(orbit.cosines)]
    assert known == pytest.approx(orbit.cosines[: len(known)], abs=SAME_ORBIT * size)
    at_energy = breather_at_energy(orbit.chain, seed, orbit.energy(), guess=orbit)
    assert at_energy.amplitude == pytest.approx(orbit.amplitude, rel=SAME_ORBIT)


@pytest.mark.parametrize("law", LAWS)
def test_the_symmetry_leaves_out_what_the_force_does_not_make(law):
    """All coefficients that are unknowns come out, those that are none are not needed: the residual says so."""
    orbit = breather_at_amplitude(Chain(8, potential=law), 2, LAWS[law])
    n, q = np.indices(orbit.cosines.shape)
    seen = np.abs(orbit.cosines[:4]) > 1e-12 * float(LAWS[law])
    allowed = (q + 1 - 2 * n) % 2 == 0
    if law == "poly:0,1/2,0,1/3":
        allowed &= n % 2 == 1
    assert not seen[~allowed[:4]].any()
    assert seen[1, 1]
    assert seen[3 if law == "poly:0,1/2,0,1/3" else 2].any()


@pytest.mark.parametrize(("law", "power"), [("alpha", 3), ("poly:0,1/2,0,1/3", 5), ("poly:1/3,0,1/5", 4), ("toda:1", 5)])
def test_the_samples_of_a_period_keep_products_apart(law, power):
    """cos^power has its harmonic `power` at 2^(1-power), and with H = power - 1 harmonics nothing of it folds onto them."""
    chain = Chain(2, alpha=1) if law == "alpha" else Chain(2, potential=law)
    H = power - 1
    balance = Balance(chain, 1, H)
    points = half_period_points(chain, H)
    first = balance.table[:, 1] ** power
    assert (balance.analysis @ first)[power] == pytest.approx(2.0 ** (1 - power))
    folded = balance.analysis @ np.cos(np.arange(points + 1) * np.pi / points * power * H)
    assert np.max(np.abs(folded[: H + 1])) < NEWTON_RESIDUAL


@pytest.mark.parametrize(("seed", "kind"), [(2, "real < 0"), (3, "complex quadruple"), (9, "real > 0")])
def test_breathers_of_toda_are_stable_where_those_of_alpha_are_not(seed, kind):
    """The chain is integrable: every multiplier is on the circle; at the same c_3 and amplitude alpha has each kind of instability."""
    integrable, alpha = (
        floquet(breather_at_amplitude(Chain(12, **law), seed, "1.6")) for law in ({"potential": "toda:1/2"}, {"alpha": "1/2"})
    )
    assert integrable.stable
    assert np.abs(integrable.multipliers) == pytest.approx(1, abs=PROMISED_RESIDUAL)
    assert kind in alpha.instabilities
    assert alpha.largest > 1.005


@pytest.mark.parametrize("law", LAWS)
def test_a_series_of_one_seed_becomes_the_orbit(law):
    """Its amplitude approaches that of the orbit of its frequency as the order grows."""
    orbit = breather_at_amplitude(Chain(8, potential=law), 1, LAWS[law])
    errors = []
    for order in (4, 8):
        torus = solve_amplitudes(lindstedt(orbit.chain, (1,), orbit.frequencies, order))
        errors.append(abs(torus.amplitudes[1] - orbit.amplitude))
    assert errors[1] < errors[0] / 5


@pytest.mark.parametrize("law", POLYNOMIALS)
def test_polynomials_of_any_degree_have_digits(law):
    orbit = breather_at_amplitude(Chain(6, potential=law), 2, LAWS[law])
    precise = periodic_orbit_digits(orbit, 40)
    assert precise.bound < TRANSFORM_OF_FORTY
    assert precise.cosines.astype(float)[: len(orbit.cosines)] == pytest.approx(orbit.cosines, abs=ORBIT_IN_DOUBLES)
    # by another route: mpf at the working precision, between the points of the sweeps
    assert precise.residual(7) < TRANSFORM_OF_FORTY


def test_digits_of_a_closed_law_are_refused():
    orbit = breather_at_amplitude(Chain(6, potential="expr:cosh(r)-1"), 2, "0.1")
    with pytest.raises(InputError, match=r"one of Chain\(N=6, .*digits= of lindstedt"):
        periodic_orbit_digits(orbit, 30)


@pytest.mark.parametrize("law", ["toda:1/2", "poly:0,1/2,0,1/3"])
def test_floors_of_newton_orbits_lie_below_their_spectra(law):
    orbit = breather_at_amplitude(Chain(8, potential=law), 1, LAWS[law])
    spectrum, floor = orbit.average_spectrum(), spectrum_floor(orbit)
    lowest = spectrum > 1e-24 * spectrum.max()
    assert np.all(floor[lowest] < spectrum[lowest])
    assert np.all(floor < UNSEEN_TAIL * spectrum.max())


def test_a_law_without_lowest_shift_is_followed_by_amplitude():
    """V = r^2/2 + r^6/6: the frequency moves with A^4."""
    chain = Chain(6, potential="poly:0,0,0,1")
    with pytest.raises(UndeterminedAmplitudes):
        periodic_orbit(chain, 1, "0.52")
    small, large = (breather_at_amplitude(chain, 1, A) for A in ("0.4", "0.8"))
    linear = chain.frequencies()[0]
    ratio = (float(large.frequency) - linear) / (float(small.frequency) - linear)
    assert ratio == pytest.approx(16, rel=RATE_OF_MU)
