"""Travelling waves of many digits: Toda's spectral curve, more digits, doubles, and the equations of motion at angles."""

from functools import cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, actions, load, refine, save, toda_torus, unfold
from symfpu.refinement.digits import Guess, TorusProblem
from symfpu.refinement.prescribed import Frequencies
from tests.refinement.test_digits import ten
from tests.refinement.test_ring_tori import TODA, of_series, seeds_alone
from tests.tolerances import NEWTON_TWIST, ORBIT
from tests.tori.test_ring_torus import ring

LAWS = {
    "alpha": (6, {1: 1e-2}, {"alpha": "0.3"}),
    "beta, wrapped": (5, {2: 1e-2}, {"beta": "0.5"}),
    "q = N/2": (8, {4: 1e-2}, TODA),
    "two": (9, {1: 1.5e-3, 4: 2e-3}, {"beta": "0.5"}),
}
LONG = {
    "opposite": (11, {2: 3e-3, -2: 4e-3}, {"beta": 1}),
    "one to each side": (16, {1: 2e-3, -3: 1e-3}, TODA),
    "a wall": (7, {2: 1e-3}, {"potential": "lj:12,6"}),
}
ALL = [pytest.param(name, marks=[] if name in LAWS else pytest.mark.long) for name in LAWS | LONG]


@cache
def near(name):
    return refine(of_series(*(LAWS | LONG)[name]))


@cache
def precise(name, digits=25):
    return refine(near(name), digits=digits)


def by_harmonic(torus):
    return {tuple(nu): b for nu, b in zip(torus.harmonics.tolist(), torus.cosines, strict=True)}


@pytest.mark.parametrize("name", ALL)
def test_it_solves_the_equations_of_motion_within_its_bound(name):
    """On particles, at angles of their own; and it continues the torus of doubles."""
    torus, doubles = precise(name), near(name)
    assert 0 < torus.residual(3) < torus.origin.bound < ten(-23)
    assert torus.origin.error < ten(-25)
    assert torus.energy_range() < ten(-24)
    assert (torus.frequencies, torus.phases, torus.seeds) == (doubles.frequencies, doubles.phases, doubles.seeds)
    times = [0.0, 1.7]
    assert np.abs(torus.x(times).astype(float) - doubles.x(times)).max() < ORBIT
    assert np.abs(torus.p(times).astype(float) - doubles.p(times)).max() < ORBIT
    assert np.abs(torus.average_spectrum().astype(float) - doubles.average_spectrum()).max() < ORBIT


@pytest.mark.parametrize("name", ["alpha", "two"])
def test_particles_obey_newtons_law_in_digits(name):
    """x'' by differences of four times the digits that they need, and V' of neighbours: nothing of the transform of modes."""
    torus, h = precise(name, 30), ten(-6)
    with mpmath.workdps(45):
        x = torus.x([mpmath.mpf("0.3") + k * h for k in (-1, 0, 1)])
        acceleration = (x[0] - 2 * x[1] + x[2]) / h**2
        r = np.roll(x[1], -1) - x[1]
        law = {"alpha": lambda r: r + mpmath.mpf("0.3") * r**2, "two": lambda r: r + r**3 / 2}[name]
        tension = law(r)
        force = tension - np.roll(tension, 1)
        assert max(abs(acceleration - force)) < ten(-11) * max(abs(force))


@pytest.mark.parametrize(
    ("N", "seeds"),
    [(6, (1,)), (5, (-2,)), pytest.param(6, (3, 1), marks=pytest.mark.long), pytest.param(8, (1, -3), marks=pytest.mark.long)],
)
def test_of_toda_energy_and_actions_are_those_of_the_spectral_curve(N, seeds):
    chain = ring(N, **TODA)
    linear = [float(chain.frequencies()[chain.mode_numbers.index(q)]) for q in seeds]
    guess = seeds_alone(chain, seeds, linear, [0.3] * len(seeds))
    given = {q: f"0.{3 + i}" for i, q in enumerate(seeds)}
    found = refine(refine(guess, amplitudes=given), digits=24)
    exact = toda_torus(chain, seeds, frequencies=found.frequencies, digits=30)
    with mpmath.workdps(40):
        assert abs(found.energy("0.7") / exact.energy - 1) < ten(-22)
        for q, action in actions(found).items():
            assert abs(action / exact.actions[q] - 1) < ten(-22)


def test_more_digits_continue_fewer_and_amplitudes_lead_back_to_frequencies(tmp_path):
    fewer, file = precise("alpha"), tmp_path / "run"
    more = refine(fewer, digits=40)
    one, other = by_harmonic(fewer), by_harmonic(more)
    with mpmath.workdps(50):
        off = max(abs(one.get(nu, 0) - b) for nu, b in other.items())
        assert 0 < off < ten(-25) * max(abs(more.cosines))
        held = {1: mpmath.nstr(more.amplitude, 40)}
        again = refine(near("alpha"), amplitudes=held, digits=30, file=file)
        assert abs(mpmath.mpf((again.frequency - more.frequency).numerator) / (again.frequency - more.frequency).denominator) < ten(-30)
    resumed = refine(near("alpha"), amplitudes=held, digits=36, file=file)
    assert resumed.origin.sweeps > again.origin.sweeps
    loaded = load(save(tmp_path / "torus", more))
    assert type(loaded.origin) is symfpu.IterativeRefinement
    assert (loaded.cosines == more.cosines).all()
    assert (loaded.origin.bound, loaded.origin.error, loaded.origin.sweeps, loaded.digits) == (
        more.origin.bound,
        more.origin.error,
        more.origin.sweeps,
        40,
    )


def test_a_wrong_digit_is_seen():
    torus = precise("two", 20)
    with mpmath.workdps(40):
        guess = Guess(torus, Frequencies(torus.chain, torus.seeds, torus.frequencies))
        problem = TorusProblem(guess, torus.harmonics, 20)
        before = problem.truncation()
        problem.coefficients[problem.equation.seed_rows[0], 0] += problem.largest >> 50
        spoilt = problem.truncation()
    assert before.residual < ten(-19)
    assert ten(-17) < spoilt.residual < ten(-13)
    assert ten(-17) < spoilt.newton_update < ten(-11)


def test_standing_waves_have_the_digits_of_fixed_ends(tmp_path):
    fixed = symfpu.refine(symfpu.torus(Chain(4, alpha="0.3"), (1,), amplitudes={1: "0.2"}), digits=25)
    standing = unfold(fixed)
    assert standing.digits == 25
    assert 0 < standing.residual(5) < ten(-25)
    with mpmath.workdps(40):
        assert abs(standing.energy("0.4") / (2 * fixed.energy("0.4")) - 1) < ten(-25)
        difference = standing.x("0.4")[1:4] - fixed.x("0.4")
        assert max(abs(difference)) < ten(-25)
    loaded = load(save(tmp_path / "torus", standing))
    assert (loaded.cosines == standing.cosines).all()
    with pytest.raises(InputError, match="unfold"):
        refine(standing, digits=30)


def test_modes_and_particles_of_a_ring_in_digits():
    """There and back, energies and forces, against doubles and to all digits."""
    torus = precise("alpha")
    chain, Q, P = torus.chain, torus.Q("0.3"), torus.P("0.3")
    with mpmath.workdps(40):
        assert max(abs(chain.modes(chain.positions(Q)) - Q)) < ten(-38) * max(abs(Q))
        assert abs(chain.energy(Q, P) / torus.energy() - 1) < ten(-24)
        rough = Q.astype(complex), P.astype(complex)
        for exact, doubles in (
            (chain.positions(Q), chain.positions(rough[0])),
            (chain.stretches(Q), chain.stretches(rough[0])),
            (chain.accelerations(Q), chain.accelerations(rough[0])),
            (chain.harmonic_energies(Q, P), chain.harmonic_energies(*rough)),
        ):
            assert np.abs(exact.astype(doubles.dtype) - doubles).max() < ORBIT
        assert symfpu.toda_gaps(Chain(6, potential="toda:0.3", ends="periodic"), Q, P).dtype == float
        with pytest.raises(InputError, match=r"Q_\(-q\) = conj Q_q"):
            chain.positions(Q * mpmath.mpc(0, 1))


def test_what_has_no_digits_is_refused():
    equal = seeds_alone(ring(16, beta=1), (2, -2), ("0.775", "0.775"), (0.2, 0.2))
    with pytest.raises(InputError, match="omega_2 -1 omega_-2 = 0"):
        refine(equal, digits=20)
    with pytest.raises(InputError, match=r"^digits = 0"):
        refine(near("alpha"), digits=0)


def test_normal_modes_and_twist_of_waves_in_digits_are_those_of_doubles():
    wave = near("alpha")
    refined, many = refine(wave), precise("alpha")
    for mode, sigma in symfpu.normal_modes(refined).frequencies.items():
        assert symfpu.normal_modes(many).frequencies[mode] == pytest.approx(sigma, rel=NEWTON_TWIST)
    assert symfpu.twist(many).matrix == pytest.approx(symfpu.twist(refined).matrix, rel=NEWTON_TWIST)
