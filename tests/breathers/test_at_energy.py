"""Breathers of a given energy against the exact potentials of one mode, and where the family ends."""

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoBreatherAtEnergy, NoPeriodicOrbit, NoTorus, refine
from tests.tolerances import (
    CONDITION,
    DISTINCTION,
    HUNDRED_ROUNDINGS,
    NEWTON_RESIDUAL,
    ONE_MODE_FREQUENCY,
    RELATIVE_SHIFT,
    ROUNDING,
)
from tests.tori.test_ring_torus import ring

ALPHA = Chain(N=32, alpha="0.33")


def potential(chain, seed):
    """Coefficients of x^2, x^3, x^4 of H on one exact mode, from the sums of powers of cos(q (j + 1/2) pi / N) over the bonds.

    Squares give N/2. Cubes: -N/4 for 2N/3, else 0 (for N/3 by pairs; then alpha excites 2N/3, and the mode is exact in beta only).
    Fourth powers: N/4 for N/2, 3N/8 for N/3 and 2N/3.
    """
    N, Omega = mpmath.mpf(chain.N), chain.linear_frequency(seed)
    alpha, beta = (mpmath.mpf(c.numerator) / c.denominator for c in (chain.alpha, chain.beta))
    cubes = -N / 4 if 3 * seed == 2 * chain.N else 0
    fourth = N / 4 if 2 * seed == chain.N else 3 * N / 8
    scale = mpmath.sqrt(2 / N) * Omega
    return Omega**2 / 2, alpha / 3 * scale**3 * cubes, beta / 4 * scale**4 * fourth


def frequency_at(coefficients, energy):
    """omega of x'' = -V'(x) at an energy: the period by the trapezoidal rule in the phase between the turning points."""
    a, b, c = coefficients
    roots = mpmath.polyroots([c, b, a, 0, -energy] if c else [b, a, 0, -energy] if b else [a, 0, -energy], maxsteps=200, extraprec=200)
    real = [mpmath.re(x) for x in roots if abs(mpmath.im(x)) < mpmath.mpf("1e-20")]
    top, bottom = min(x for x in real if x > 0), max(x for x in real if x < 0)
    others = [x for x in roots if abs(x - top) > mpmath.mpf("1e-15") and abs(x - bottom) > mpmath.mpf("1e-15")]
    points, total = 200, mpmath.mpf(0)
    for k in range(points):
        x = (top + bottom) / 2 + (top - bottom) / 2 * mpmath.cospi(2 * (k + mpmath.mpf(1) / 2) / points)
        total += 1 / mpmath.sqrt(2 * mpmath.re(mpmath.fprod(x - other for other in others)) * (c or b or a))
    return points / total


CASES = (
    (Chain(4, alpha=1), 2, "0.8"),  # stays harmonic
    (Chain(4, alpha=1, beta="0.5"), 2, "0.8"),
    (Chain(6, beta=1), 2, "1.5"),
    (Chain(6, beta="-0.3"), 3, "0.3"),
    (Chain(6, beta=1), 4, "2"),
    (Chain(6, alpha="0.4"), 4, "2"),
    (Chain(9, alpha="0.4", beta="0.2"), 6, "1"),
)


@pytest.mark.parametrize(("chain", "seed", "energy"), CASES, ids=repr)
def test_one_mode_has_the_frequency_of_its_potential(chain, seed, energy):
    with mpmath.workdps(30):
        omega = frequency_at(potential(chain, seed), mpmath.mpf(energy))
    orbit = symfpu.torus(chain, (seed,), energy=energy)
    assert orbit.energy() == pytest.approx(float(energy), rel=CONDITION)
    assert float(orbit.frequency) == pytest.approx(float(omega), rel=ONE_MODE_FREQUENCY)
    others = np.delete(np.arange(chain.N - 1), seed - 1)
    assert orbit.cosines[:, others] == pytest.approx(0, abs=HUNDRED_ROUNDINGS)
    assert orbit.residual() < NEWTON_RESIDUAL


def test_harmonic_energy_is_another_member():
    chain = Chain(8, alpha="0.4", beta="0.1")
    total, harmonic = symfpu.torus(chain, (3,), energy="0.4"), symfpu.torus(chain, (3,), energy=symfpu.Energy("0.4", harmonic=True))
    assert total.energy() == pytest.approx(0.4, rel=CONDITION)
    assert harmonic.harmonic_energies().sum() == pytest.approx(0.4, rel=CONDITION)
    assert harmonic.energy() != pytest.approx(0.4, rel=DISTINCTION)


def test_a_member_nearby_is_enough():
    chain = Chain(8, alpha="0.4", beta="0.1")
    member = symfpu.torus(chain, (3,), amplitudes={3: "-0.8"})
    found = refine(member, energy=1.01 * member.energy())
    assert found.energy() == pytest.approx(1.01 * member.energy(), rel=CONDITION)
    assert found.amplitude < 0
    with pytest.raises(NoTorus):
        refine(member, energy=1e6 * member.energy())


def test_the_family_ends_at_the_barrier_of_its_potential():
    """V = a x^2 + b x^3 of mode 2N/3 in alpha: no oscillation above the maximum of V, 4 a^3 / (27 b^2)."""
    chain = Chain(6, alpha="0.4")
    a, b, _ = (float(value) for value in potential(chain, 4))
    barrier = 4 * a**3 / (27 * b**2)
    with pytest.raises(NoBreatherAtEnergy, match=r"the family from rest was followed over 0 \.\. .* ended because: ") as failure:
        symfpu.torus(chain, (4,), energy="50")
    error = failure.value
    assert 0.97 * barrier < error.reached < barrier * (1 + ROUNDING)  # it ends beside it to rounding
    assert (error.seed, error.energy, error.harmonic) == (4, 50.0, False)
    assert error.reason
    member = symfpu.torus(chain, (4,), frequencies=(error.frequency,))
    assert float(member.energy()) == pytest.approx(error.reached, rel=RELATIVE_SHIFT)
    assert member.amplitude == pytest.approx(error.amplitude, rel=RELATIVE_SHIFT)


@pytest.mark.parametrize("energy", ["1e-20", "0.001", "0.01", "1"])
def test_a_mode_that_stays_harmonic_has_every_energy(energy):
    """N = 2, alpha: the two bonds cancel, and all of its shift is rounding."""
    found = symfpu.torus(Chain(2, alpha="0.3"), (1,), energy=energy)
    assert float(found.frequency) == pytest.approx(2**0.5, rel=RELATIVE_SHIFT)
    assert found.amplitude == pytest.approx(float(energy) ** 0.5, rel=RELATIVE_SHIFT)


@pytest.mark.parametrize("energy", [0, -1, "one", float("inf")])
def test_energies_that_select_no_orbit_are_refused(energy):
    with pytest.raises(InputError, match=r"^energy = "):
        symfpu.torus(ALPHA, (1,), energy=energy)


def test_other_bad_input_is_refused():
    with pytest.raises(InputError, match=r"^seeds = "):
        symfpu.torus(ALPHA, (0,), energy="0.1")
    for chain in (ALPHA, ring(8, alpha="0.25")):
        with pytest.raises(InputError, match=r"^harmonic = "):
            symfpu.torus(chain, (1,), energy=symfpu.Energy("0.1", harmonic="yes"))


def test_solutions_of_negative_squared_frequency_are_no_orbits():
    """cosh solves the same equations; a soft mode at an amplitude beyond its barrier."""
    with pytest.raises(NoPeriodicOrbit):
        symfpu.torus(Chain(6, beta=-1), (4,), amplitudes={4: "1.5"})
