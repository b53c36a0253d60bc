"""Breathers of chains of any potential: three routes to one orbit, Floquet multipliers, digits, and who is refused."""

import pytest

import symfpu
from symfpu import Chain, UndeterminedAmplitudes, refine
from tests import tolerances
from tests.oracles.shooting import shoot
from tests.tolerances import NEWTON_RESIDUAL, ORBIT_IN_DOUBLES, RATE_OF_MU, SAME_ORBIT, SHOT_AMPLITUDE, TRANSFORM_OF_FORTY

# laws with an amplitude at which they are far from harmonic
LAWS = {"toda:1/2": "0.3", "lj:12,6": "0.03", "poly:1/3,0,1/5,-1/4": "0.3", "poly:0,1/2,0,1/3": "0.4"}
POLYNOMIALS = [law for law in LAWS if law.startswith("poly")]


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("N", "seed"), [(2, 1), (8, 3), (9, 2)])
def test_harmonic_balance_shooting_and_newton_on_tori_agree(law, N, seed):
    orbit = symfpu.torus(Chain(N, potential=law), (seed,), amplitudes={seed: LAWS[law]})
    assert orbit.residual() < tolerances.PROMISED_RESIDUAL
    start, size = orbit.Q(0.0), float(LAWS[law])
    shot = shoot(orbit.chain, seed, orbit.frequency, start)
    assert shot.start == pytest.approx(start, abs=SHOT_AMPLITUDE * size)
    assert shot.closure < NEWTON_RESIDUAL
    torus = refine(orbit)
    known = torus.by_harmonic()[: len(orbit.cosines)]
    assert known == pytest.approx(orbit.cosines[: len(known)], abs=SAME_ORBIT * size)
    at_energy = refine(orbit, energy=orbit.energy())
    assert at_energy.amplitude == pytest.approx(orbit.amplitude, rel=SAME_ORBIT)


@pytest.mark.parametrize("law", POLYNOMIALS)
def test_polynomials_of_any_degree_have_digits(law):
    orbit = symfpu.torus(Chain(6, potential=law), (2,), amplitudes={2: LAWS[law]})
    precise = refine(orbit, digits=40)
    assert precise.origin.bound < TRANSFORM_OF_FORTY
    assert precise.by_harmonic().astype(float)[: len(orbit.cosines)] == pytest.approx(orbit.cosines, abs=ORBIT_IN_DOUBLES)
    # by another route: mpf at the working precision, between the points of the sweeps
    assert precise.residual(7) < TRANSFORM_OF_FORTY


def test_a_law_without_lowest_shift_is_followed_by_amplitude():
    """V = r^2/2 + r^6/6: the frequency moves with A^4."""
    chain = Chain(6, potential="poly:0,0,0,1")
    with pytest.raises(UndeterminedAmplitudes):
        symfpu.torus(chain, (1,), frequencies=("0.52",))
    small, large = (symfpu.torus(chain, (1,), amplitudes={1: A}) for A in ("0.4", "0.8"))
    linear = chain.frequencies()[0]
    ratio = (float(large.frequency) - linear) / (float(small.frequency) - linear)
    assert ratio == pytest.approx(16, rel=RATE_OF_MU)
