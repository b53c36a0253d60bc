"""Orbits of many digits against orbits in doubles, an elliptic oscillator, and their own residual at other points."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoTorus, refine, toda_torus
from symfpu.chain.tension_terms import terms
from symfpu.numbers.arithmetic import MULTIPRECISION
from tests.oracles.oscillators import duffing
from tests.tolerances import BOUND_OF_FORTY, ORBIT_IN_DOUBLES

ALPHA = Chain(N=32, alpha="0.33")

# The elliptic oracle has 30 digits.
ORACLE = mpmath.mpf("1e-27")

CASES = (
    (ALPHA, 1, "0.0981410995944860", 100),
    (ALPHA, 25, "1.8830741847088537", 100),
    (Chain(8, alpha="0.4", beta="0.1"), 3, "1.13", 60),
    (Chain(7, beta="-0.3"), 2, "0.86", 40),
    (Chain(2, alpha=1, beta=1), 1, "1.5", 20),
)


@pytest.mark.long
@pytest.mark.parametrize(("chain", "seed", "frequency", "digits"), CASES, ids=repr)
def test_the_digits_continue_those_of_doubles(chain, seed, frequency, digits):
    orbit = symfpu.torus(chain, (seed,), frequencies=(frequency,))
    precise = refine(orbit, digits=digits + 5)
    assert precise.frequency == Fraction(frequency)
    assert precise.digits == digits + 5
    rounded = precise.by_harmonic()[: len(orbit.cosines)].astype(float)
    assert rounded == pytest.approx(orbit.cosines, abs=ORBIT_IN_DOUBLES * np.max(np.abs(orbit.cosines)))
    assert precise.origin.bound < mpmath.mpf(10) ** -digits
    assert 0 < precise.residual(3) < mpmath.mpf(10) ** (-digits - 5)  # at angles where nothing was collocated
    assert np.max(np.abs(precise.cosines[-1])) < mpmath.mpf(10) ** (-digits - 5)


def test_the_bound_is_above_the_residual():
    """One that sees a wrong digit: tests/refinement/test_digits.py."""
    orbit = symfpu.torus(Chain(6, alpha="0.4", beta="0.2"), (5,), amplitudes={5: "0.6"})
    precise = refine(orbit, digits=40)
    t = np.linspace(0, 2 * np.pi / float(orbit.frequency), 1001)
    largest = np.max(np.abs(orbit.chain.accelerations(orbit.Q(t))))
    assert replace(precise, digits=80).residuals(7).max() < precise.origin.bound * largest < BOUND_OF_FORTY


def test_duffing_to_many_digits():
    """N/2 of beta at large swing: amplitude and frequency by elliptic functions, each found from the other."""
    chain = Chain(4, beta="0.5")
    with mpmath.workdps(40):
        squared = chain.linear_frequency(2) ** 2
        omega, amplitude = duffing(squared, mpmath.mpf("0.5") / 8 * squared**2 * chain.C(2, 2, 2, 2), mpmath.mpf(1))
        texts = mpmath.nstr(omega, 29), mpmath.nstr(amplitude, 29)
        by_frequency = refine(symfpu.torus(chain, (2,), frequencies=(texts[0],)), digits=30)
        assert abs(by_frequency.amplitude / amplitude - 1) < ORACLE
        by_amplitude = refine(symfpu.torus(chain, (2,), amplitudes={2: texts[1]}), digits=30, amplitudes={2: texts[1]})
        assert abs(mpmath.mpf(by_amplitude.frequency.numerator) / by_amplitude.frequency.denominator / omega - 1) < ORACLE
        assert abs(by_amplitude.amplitude - mpmath.mpf(texts[1])) < mpmath.mpf("1e-38")
        assert not by_amplitude.cosines[:, [0, 2]].any()


def test_toda_has_the_energy_of_the_spectral_curve():
    chain = Chain(4, potential="toda:1/2")
    precise = refine(symfpu.torus(chain, (1,), frequencies=("0.78",)), digits=30)
    exact = toda_torus(chain, (1,), frequencies=("0.78",), digits=35)
    assert abs(precise.energy() / exact.energy - 1) < ORACLE
    assert precise.origin.bound < ORACLE


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "amplitude"), [("morse:1/2", "0.3"), ("lj:12,6", "0.03"), ("lj:5/2,1", "-0.1"), ("expr:(exp(2*r)-1-2*r)/4", "0.3")]
)
def test_closed_laws_to_many_digits(text, amplitude):
    """The residual goes by the closed law, the orbit by its first Taylor coefficients."""
    orbit = symfpu.torus(Chain(6, potential=text), (2,), amplitudes={2: amplitude})
    precise = refine(orbit, digits=45, amplitudes={2: amplitude})
    rounded = precise.by_harmonic()[: len(orbit.cosines)].astype(float)
    assert rounded == pytest.approx(orbit.cosines, abs=ORBIT_IN_DOUBLES * np.max(np.abs(orbit.cosines)))
    assert precise.origin.bound < mpmath.mpf(10) ** -40
    assert 0 < precise.residual(3) < mpmath.mpf(10) ** -45


@pytest.mark.parametrize("text", ["morse:1/2", "lj:12,6", "toda:-2"])
def test_the_rest_of_the_terms_is_above_what_is_left_out(text):
    """Against the closed law, at both ends of the reach."""
    chain, reach = Chain(2, potential=text), mpmath.mpf("0.2")
    with mpmath.workdps(60):
        found = terms(chain, 60, reach)
        law = chain.law(MULTIPRECISION)
        left = []
        for r in (reach, -reach):
            kept = sum(mpmath.mpf(c.numerator) / c.denominator * r**k for k, c in found.couplings.items())
            left.append(abs(law.anharmonic_tension(r) - kept))
        assert 0 < max(left) < found.rest < mpmath.ldexp(1, -60)


@pytest.mark.parametrize("text", ["expr:cosh(r)-1", "expr:log(1+r**2)/2", "expr:r**2/2+sqrt(2)*sin(r)**3"])
def test_what_has_no_known_rest_is_refused(text):
    orbit = symfpu.torus(Chain(2, potential=text), (1,), amplitudes={1: "0.1"})
    with pytest.raises(InputError, match=r"^torus = .*exponentials and powers"):
        refine(orbit, digits=20)


def test_stretches_near_the_singularity_are_refused():
    orbit = symfpu.torus(Chain(2, potential="lj:2,1"), (1,), amplitudes={1: "0.5"})
    with pytest.raises(InputError, match=r"powers of stretches up to .* take fewer digits or a smaller amplitude"):
        refine(orbit, digits=1000)


def test_steps_that_gain_nothing_are_given_up(monkeypatch):
    orbit = symfpu.torus(Chain(6, alpha="0.4"), (2,), amplitudes={2: "0.5"})
    monkeypatch.setattr("scipy.linalg.lu_solve", lambda matrix, values, **how: 0 * values)
    with pytest.raises(NoTorus, match="iterative refinement stops at a residual or update of 1e-1"):
        refine(orbit, digits=30)


def test_an_interrupted_run_goes_on_from_its_file(tmp_path):
    """From the step it ended at, and on to more digits; also from an orbit of fewer."""
    orbit, file, heard = symfpu.torus(Chain(6, alpha="0.4"), (2,), amplitudes={2: "0.5"}), tmp_path / "run", []

    def until_third(label, fraction):
        if label.startswith("step 2"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        refine(orbit, digits=30, file=file, progress=until_third)
    again = refine(orbit, digits=30, file=file, progress=lambda label, fraction: heard.append(label))
    assert next(label for label in heard if label.startswith("step ")).startswith("step 2: residual 1e-23")
    more = refine(orbit, digits=50, file=file)
    fewer_first = refine(again, digits=50)
    assert more.origin.sweeps > again.origin.sweeps
    with mpmath.workdps(80):
        for found in (more, fewer_first):
            assert np.max(np.abs(found.cosines[: len(again.cosines)] - again.cosines)) < mpmath.mpf(10) ** -30
        assert np.max(np.abs(more.cosines - fewer_first.cosines)) < mpmath.mpf(10) ** -50
    with pytest.raises(InputError, match=r"^file = .*frequencies is"):
        refine(orbit, digits=30, amplitudes={2: "0.5"}, file=file)


@pytest.mark.parametrize("amplitude", ["0.3", 1])
def test_a_frequency_that_does_not_tell_the_amplitude_is_named(amplitude):
    """alpha, N = 4, seed 2: r^2 is the same on all bonds, so that no force is left but the linear one: omega = Omega_2."""
    orbit = symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: amplitude})
    with pytest.raises(NoTorus, match=r"many amplitudes, .*: give the amplitudes"):
        refine(orbit, digits=20)
    precise = refine(orbit, digits=20, amplitudes={2: amplitude})
    with mpmath.workdps(2 * precise.digits):
        exact = mpmath.mpf(precise.frequency.numerator) / precise.frequency.denominator
        assert abs(exact - mpmath.sqrt(2)) < mpmath.mpf(10) ** -precise.digits
