"""Tori of many digits against breathers of many digits, Toda's spectral curve, more digits, and the equations of motion at angles."""

from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import BundleError, Chain, InputError, NoTorus, actions, load, refine, save
from symfpu.refinement import iterative_refinement
from symfpu.refinement.digits import Guess, TorusProblem
from symfpu.refinement.prescribed import Frequencies
from symfpu.refinement.refinement_file import whole, words
from tests.oracles.oscillators import duffing
from tests.tolerances import SPOILT_LEAST, SPOILT_MOST

SMALL = Chain(4, alpha="0.2", beta="0.3")
SMALL_AMPLITUDES = {1: "0.1", 2: "0.05"}

CASES = {
    "alpha": (Chain(8, alpha="0.25"), {1: "0.2", 2: "0.1"}),
    "beta": (Chain(7, beta="0.3"), {1: "0.3", 3: "0.1"}),
    "mixed": (Chain(6, alpha="0.3", beta="-0.2"), {2: "0.2", 5: "0.1"}),
    "three": (Chain(4, beta="0.3"), {1: "0.1", 2: "0.05", 3: "0.04"}),
    "toda": (Chain(4, potential="toda:1/2"), {1: "0.2", 2: "0.1"}),
    "lennard-jones": (Chain(4, potential="lj:2,1"), {1: "0.02", 2: "0.01"}),
}


def unheard(label, fraction):
    """Progress that nobody follows."""


def ten(exponent):
    return mpmath.mpf(10) ** exponent


@cache
def small(digits):
    return refine(
        symfpu.torus(SMALL, tuple(SMALL_AMPLITUDES), amplitudes=SMALL_AMPLITUDES, method="series", order=3),
        amplitudes=SMALL_AMPLITUDES,
        digits=digits,
    )


def farthest(one, two):
    """Largest difference of coefficients, those of harmonics of one alone too, over the largest coefficient."""
    by_harmonic = [{tuple(nu): row for nu, row in zip(t.harmonics.tolist(), t.cosines, strict=True)} for t in (one, two)]
    none = 0 * one.cosines[0]
    with mpmath.workdps(2 * max(one.digits, two.digits)):
        keys = by_harmonic[0].keys() | by_harmonic[1].keys()
        off = max(np.abs(by_harmonic[0].get(nu, none) - by_harmonic[1].get(nu, none)).max() for nu in keys)
        return off / np.abs(two.cosines).max()


def largest_acceleration(torus):
    """Of a mode, at some times."""
    doubles = torus.in_doubles()
    return np.abs(torus.chain.accelerations(doubles.Q(np.linspace(0, 300, 4000)))).max()


def test_more_digits_continue_fewer_and_the_error_is_about_what_is_estimated():
    fewer, more = small(20), small(32)
    off = farthest(fewer, more)
    assert 0 < off < ten(-20)
    assert off < 100 * fewer.origin.error < ten(-18)
    assert more.origin.error < ten(-32)
    with mpmath.workdps(50):
        for w, x in zip(fewer.frequencies, more.frequencies, strict=True):
            assert abs(mpmath.mpf((w - x).numerator) / (w - x).denominator) < ten(-20)


def test_the_residual_at_angles_is_below_its_bound_and_energy_is_constant():
    torus = small(32)
    assert 0 < torus.residuals(3).max() < torus.origin.bound * largest_acceleration(torus)
    assert torus.origin.bound < ten(-31)
    energies = torus.energy([0, "1.7", "40.3"])
    with mpmath.workdps(50):
        assert max(abs(energies / energies[0] - 1)) < ten(-31)


def test_frequencies_lead_back_to_the_amplitudes_from_fewer_digits():
    """Refinement begins where those of fewer digits ended."""
    fewer, heard = small(20), []
    again = refine(fewer, digits=32, progress=lambda label, fraction: heard.append(label))
    assert heard[1].startswith("step 1: residual 1e-2")
    assert again.frequencies == fewer.frequencies
    with mpmath.workdps(50):
        for q, a in SMALL_AMPLITUDES.items():
            assert abs(again.amplitudes[q] - mpmath.mpf(a)) < ten(-19)


def test_one_angle_is_the_sum_of_the_series():
    """Of 40 digits, to order 15 in an amplitude of 1/100: another algorithm, without any matrix."""
    orbit = symfpu.torus(Chain(6, alpha="0.3", beta="0.1"), (2,), amplitudes={2: "0.01"})
    series = symfpu.lindstedt(orbit.chain, orbit.seeds, orbit.frequencies, 15, digits=40)
    found, summed = refine(orbit, digits=40), symfpu.solve_amplitudes(series)
    assert 0 < farthest(found, summed) < ten(-28)
    precise = symfpu.refine(orbit, digits=40)
    assert farthest(found, precise) < ten(-40)


def test_a_torus_that_runs_away_is_refused():
    """alpha, N = 4, seed 2: omega = Omega_2 at every amplitude, and that of doubles is not quite Omega_2."""
    near = refine(symfpu.torus(Chain(4, alpha="0.5"), (2,), amplitudes={2: "0.3"}), amplitudes={2: "0.3"})
    with pytest.raises(NoTorus, match=r"A_2 goes from 0\.3 to (0|-?[0-9.]+e-)"):
        refine(near, digits=20)


def test_two_bonds_swing_as_elliptic_functions_do():
    chain = Chain(2, beta="0.5")
    with mpmath.workdps(40):
        squared = chain.linear_frequency(1) ** 2
        omega, amplitude = duffing(squared, mpmath.mpf("0.5") / 4 * squared**2 * chain.C(1, 1, 1, 1), mpmath.mpf("0.5"))
        found = refine(symfpu.torus(chain, (1,), frequencies=(mpmath.nstr(omega, 33),)), digits=28)
        assert abs(found.amplitude / amplitude - 1) < ten(-27)


def test_phases_are_kept_and_actions_have_the_digits():
    guess = replace(symfpu.torus(Chain(3, beta="0.5"), (1, 2), amplitudes={1: "0.1", 2: "0.1"}), phases={1: 0.5, 2: 1.25})
    fewer, more = refine(guess, digits=16), refine(guess, digits=24)
    assert [float(phi) for phi in more.phases.values()] == [0.5, 1.25]
    with mpmath.workdps(40):
        for q, action in actions(more).items():
            assert abs(actions(fewer)[q] / action - 1) < ten(-15)


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_few_and_many_digits_agree(name, tmp_path):
    """30 and 50 of two angles; three have digits cubed as many harmonics."""
    chain, amplitudes = CASES[name]
    low, high = (16, 20) if len(amplitudes) > 2 else (30, 50)
    near = refine(symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=3))
    fewer, more = refine(near, digits=low), refine(near, digits=high)
    assert 0 < farthest(fewer, more) < ten(-low)
    assert 0 < more.residuals(2).max() < more.origin.bound * largest_acceleration(more)
    assert more.origin.bound < ten(2 - high)
    energies = more.energy([0, 1, 30])
    with mpmath.workdps(70):
        assert max(abs(energies / energies[0] - 1)) < ten(2 - high)
    loaded = load(save(tmp_path / "torus", more))
    assert type(loaded.origin) is symfpu.IterativeRefinement
    assert farthest(loaded, more) == 0
    assert (loaded.origin.bound, loaded.origin.error, loaded.origin.sweeps) == (more.origin.bound, more.origin.error, more.origin.sweeps)


@pytest.mark.long
def test_toda_has_the_energy_and_actions_of_the_spectral_curve():
    chain = Chain(4, potential="toda:1/2")
    near = refine(symfpu.torus(chain, (1, 2), amplitudes={1: "0.1", 2: "0.1"}, method="series", order=4))
    found = refine(near, digits=32)
    exact = symfpu.toda_torus(chain, (1, 2), frequencies=near.frequencies, digits=35)
    with mpmath.workdps(50):
        assert abs(found.energy() / exact.energy - 1) < ten(-30)
        for q, action in actions(found).items():
            assert abs(action / exact.actions[q] - 1) < ten(-30)


def test_a_wrong_digit_is_seen():
    torus = small(20)
    guess = Guess(torus, Frequencies(torus.chain, torus.seeds, torus.frequencies))
    with mpmath.workdps(40):
        problem = TorusProblem(guess, torus.harmonics, 20)
        before = problem.truncation()
        problem.coefficients[problem.equation.seed_rows[0], 0] += problem.largest >> 50
        spoilt = problem.truncation()
    assert before.residual < ten(-19)
    assert ten(-17) < spoilt.residual < ten(-13)
    assert ten(-17) < spoilt.newton_update < ten(-13)


def test_the_bound_of_a_breather_sees_a_digit_in_the_thirtieth_place():
    orbit = symfpu.torus(Chain(6, alpha="0.4", beta="0.2"), (5,), amplitudes={5: "0.6"})
    with mpmath.workdps(60):
        guess = Guess(orbit, Frequencies(orbit.chain, orbit.seeds, orbit.frequencies))
        problem = TorusProblem(guess, np.arange(61)[:, None], 30)
        iterative_refinement.converge(problem, 40, unheard)
        problem.coefficients[3, 4] += problem.largest >> 100
        spoilt = problem.result(problem.truncation())
    assert SPOILT_LEAST < spoilt.origin.bound < SPOILT_MOST
    assert SPOILT_LEAST < spoilt.residuals(7).max() < spoilt.origin.bound * largest_acceleration(orbit)


class Interrupted(Exception):
    pass


def test_an_interrupted_run_goes_on_from_its_file(tmp_path):
    """To the same torus, and on to more digits; another run is refused."""
    near, file = refine(small(20).in_doubles()), tmp_path / "run"
    whole = refine(near, digits=30)

    def until_second(label, fraction):
        if label.startswith("step 2"):
            with pytest.raises(InputError, match=r"^file = .*process [0-9]+ on"):
                refine(near, digits=30, file=file)
            raise Interrupted

    with pytest.raises(Interrupted):
        refine(near, digits=30, file=file, progress=until_second)
    heard = []
    again = refine(near, digits=30, file=str(file), progress=lambda label, fraction: heard.append(label))
    assert heard[1].startswith("step 2: residual 1e-2")
    assert farthest(again, whole) < ten(-30)
    assert again.frequencies == near.frequencies
    more = refine(near, digits=36, file=file)
    assert more.origin.sweeps > again.origin.sweeps
    with pytest.raises(InputError, match=r"^file = .*frequencies is"):
        refine(near, amplitudes=SMALL_AMPLITUDES, digits=40, file=file)
    with pytest.raises(InputError, match=r"^file = .*without digits"):
        refine(near, file=file)
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(BundleError):
        refine(near, digits=36, file=file)


@pytest.mark.long
def test_amplitudes_go_on_with_their_frequencies(tmp_path):
    near, file = small(20).in_doubles(), tmp_path / "run"
    refine(near, amplitudes=SMALL_AMPLITUDES, digits=18, file=file)
    more = refine(near, amplitudes=SMALL_AMPLITUDES, digits=32, file=file)
    assert farthest(more, small(32)) < ten(-32)
    with pytest.raises(BundleError, match="which holds no torus"):
        load(file)


@pytest.mark.parametrize("bits", [1, 31, 32, 33, 200])
def test_words_give_the_integers_back(bits):
    values = np.array([[0, 1, -1], [2**bits, -(2**bits), 2**bits - 1]], dtype=object)
    assert (whole(words(values)) == values).all()


def test_steps_that_gain_nothing_end(monkeypatch):
    monkeypatch.setattr(iterative_refinement, "MOST_STEPS", 1)
    near = small(20).in_doubles()
    with pytest.raises(NoTorus, match=r"iterative refinement stops at a residual or update of 1e-1\d") as caught:
        refine(near, digits=40)
    assert caught.value.iterate.seeds == near.seeds


def test_what_has_no_digits_is_refused_by_name():
    near = small(20).in_doubles()
    for digits in (0, 1001, 2.5):
        with pytest.raises(InputError, match=r"^digits = "):
            refine(near, digits=digits)
    sinh = symfpu.torus(Chain(2, potential="expr:cosh(r)-1"), (1,), amplitudes={1: "0.1"}, method="series", order=2)
    with pytest.raises(InputError, match=r"^torus = .*exponentials and powers"):
        refine(sinh, digits=20)


def test_more_digits_than_harmonics_fit_are_refused():
    with pytest.raises(InputError, match=r"^digits = 1000: .*harmonics"):
        refine(small(20).in_doubles(), digits=1000)
