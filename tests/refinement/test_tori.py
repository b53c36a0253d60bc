"""Refined tori against the equations of motion: residuals, integration, breathers, all ways to prescribe them, and where there are none."""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from symfpu.breathers.balance import periodic_orbit
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError
from symfpu.paper.printed import TWO_TORUS
from symfpu.refinement import newton
from symfpu.refinement.conditions import FrequencyShift
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.tori import NoTorus, refine, refine_at_amplitudes, refine_at_energy, shifts_of
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.frequencies import torus_at_amplitudes
from tests.tolerances import (
    ALLOWANCE,
    BREATHER_HARMONICS,
    EPS,
    FEW_HARMONICS,
    FOURTEEN_DIGITS,
    HIGH_ACCURACY,
    LONG_DOUBLE_RESIDUAL,
    LONGER_SERIES,
    LOW_ACCURACY,
    NEWTON_LINEAR,
    NEWTON_SLOPE,
    PEER_ABSOLUTE,
    PEER_RELATIVE,
    PROMISED_RESIDUAL,
    REFINED_COEFFICIENT,
    SLOPE,
)

SCALES = np.array([0.25, 0.125, 0.0625])  # of amplitudes, such that the order after the one looked at is below SLOPE

CASES = {
    "alpha, breather": (Chain(8, alpha="0.4"), {1: 0.5}, 6),
    "beta, breather": (Chain(8, beta="0.3"), {3: 0.5}, 4),
    "mixed, breather": (Chain(9, alpha="0.3", beta="0.2"), {2: 0.4}, 6),
    "alpha, two": (Chain(8, alpha="0.3"), {1: 0.3, 3: 0.15}, 6),
    "beta, two": (Chain(8, beta="0.3"), {1: 0.4, 2: 0.2}, 3),
    "mixed, two": (Chain(9, alpha="0.3", beta="-0.2"), {2: 0.2, 5: 0.15}, 6),
    "alpha, three": (Chain(8, alpha="0.3"), {1: 0.1, 2: 0.05, 3: 0.04}, 4),
    "beta, three": (Chain(8, beta="0.3"), {1: 0.2, 2: 0.1, 3: 0.1}, 2),
    "mixed, three": (Chain(12, alpha="0.2", beta="0.1"), {1: 0.1, 3: 0.05, 5: 0.04}, 4),
}
BREATHERS = [name for name in CASES if "breather" in name]
TWO = "alpha, two"


@lru_cache
def series_torus(case):
    """Of a Lindstedt series whose lowest-order frequencies have about the amplitudes of the case."""
    chain, amplitudes, order = CASES[case]
    shifts = frequency_shift(chain, amplitudes)
    frequencies = [f"{float(chain.linear_frequency(q)) + shifts[q]:.10f}" for q in amplitudes]
    return solve_amplitudes(lindstedt(chain, tuple(amplitudes), frequencies, order))


@lru_cache
def refined(case):
    return refine(series_torus(case))


def rows(torus):
    return dict(zip(map(tuple, torus.harmonics.tolist()), torus.cosines, strict=True))


def difference(torus, other):
    """Largest difference of coefficients, relative to the largest one; a harmonic that one of them lacks is zero there."""
    mine, yours = rows(torus), rows(other)
    none = np.zeros(torus.chain.N - 1)
    worst = max(np.abs(mine.get(nu, none) - yours.get(nu, none)).max() for nu in mine.keys() | yours.keys())
    return worst / np.abs(torus.cosines).max()


def fitted_slope(x, y):
    return np.polyfit(np.log(x), np.log(np.abs(y)), 1)[0]


def changed(torus, shifts):
    """The same guess with other frequencies, given by omega - Omega."""
    with mpmath.workdps(30):
        omega = [torus.chain.linear_frequency(q) + x for q, x in zip(torus.seeds, shifts, strict=True)]
        return replace(torus, frequencies=tuple(Fraction(mpmath.nstr(w, 20)) for w in omega))


@pytest.mark.long
@pytest.mark.parametrize("case", CASES)
def test_the_residual_is_that_of_rounding(case):
    torus, series = refined(case), series_torus(case)
    assert torus.residual(17 if len(torus.seeds) < 3 else 13) < PROMISED_RESIDUAL < series.residual()
    assert torus.warnings == ()
    assert torus.frequencies == tuple(series.frequencies)
    assert torus.amplitudes == {q: torus.cosines[rows_of_seeds(torus)[i], q - 1] for i, q in enumerate(torus.seeds)}
    assert all(torus.amplitudes[q] == pytest.approx(a, rel=LONGER_SERIES) for q, a in series.amplitudes.items())
    assert "residual" in repr(torus)


def rows_of_seeds(torus):
    return [torus.harmonics.tolist().index(e) for e in np.eye(len(torus.seeds), dtype=int).tolist()]


@pytest.mark.parametrize("case", CASES)
def test_near_resonances_are_the_smallest_divisors(case):
    """Counted over all harmonics in doubles; of the modes that reflection allows, and the seeds' own left out."""
    torus = refined(case)
    omega, linear = np.array([float(w) for w in torus.frequencies]), torus.chain.frequencies()
    divisors = (torus.harmonics @ omega)[:, None] ** 2 - linear**2
    odd = torus.harmonics.sum(axis=1) % 2 == 1
    allowed = (torus.harmonics @ torus.seeds)[:, None] % 2 == np.arange(1, torus.chain.N) % 2
    allowed = allowed if torus.chain.alpha else allowed & odd[:, None]
    allowed[rows_of_seeds(torus), np.array(torus.seeds) - 1] = False
    smallest = np.sort(np.abs(divisors[allowed]))[: len(torus.near_resonances)]
    assert [abs(r.divisor) for r in torus.near_resonances] == pytest.approx(smallest, abs=64 * EPS)
    assert all(r.coefficient == rows(torus)[r.harmonic][r.mode - 1] for r in torus.near_resonances)


def test_harmonics_are_as_many_as_the_tolerance_needs():
    rough, fine = (refine(series_torus(TWO), tolerance=x) for x in (1e-6, 1e-11))
    assert len(rough.harmonics) < len(fine.harmonics) < len(refined(TWO).harmonics)
    assert rough.residual() <= LOW_ACCURACY
    assert fine.residual() <= HIGH_ACCURACY
    left_out = [np.abs(c).max() for nu, c in rows(refined(TWO)).items() if nu not in rows(rough)]
    assert max(left_out) < LOW_ACCURACY
    assert difference(refined(TWO), rough) < LOW_ACCURACY


@pytest.mark.parametrize("case", ["alpha, breather", TWO, "beta, two"])
def test_newtons_method_converges_quadratically(case, monkeypatch):
    """From a disturbed torus: logarithms of the changes double from step to step, until the accuracy of Krylov solutions is seen.

    With forces in long doubles, whose rounding is not seen before it.
    """
    torus = refined(case)
    monkeypatch.setattr(newton, "force_precision", lambda *_: np.longdouble)
    equation = InvarianceEquation(torus.chain, torus.seeds, torus.harmonics)
    shifts = shifts_of(torus)
    disturbed = torus.cosines * (1 + 0.01 * np.random.default_rng(1).normal(size=torus.cosines.shape)) * equation.mask
    found = newton.newton(equation, [FrequencyShift(i, x) for i, x in enumerate(shifts)], disturbed.astype(np.longdouble), shifts)
    assert not found.failure
    changes = np.array([step.change for step in found.steps])
    assert changes[0] > 1e-3
    assert changes[-1] < PROMISED_RESIDUAL
    before, after = changes[:-1], changes[1:]
    assert (after <= 20 * before**2 + NEWTON_LINEAR * before).all()
    seen = before > 1e-8
    assert fitted_slope(before[seen], after[seen]) == pytest.approx(2, abs=NEWTON_SLOPE)
    assert difference(torus, replace(torus, cosines=found.cosines.astype(float))) < REFINED_COEFFICIENT


def integration(torus, T):
    """Positions by DOP853 at rtol 1e-13, 51 times up to T, and the largest relative error of the energy."""
    chain, Q = torus.chain, torus.positions(0.0)
    bonds = chain.stretches(np.eye(len(Q)))
    alpha, beta = float(chain.alpha), float(chain.beta)

    def field(t, y):
        r = y[: len(Q)] @ bonds
        return np.concatenate([y[len(Q) :], -bonds @ (r * (1 + r * (alpha + r * beta)))])

    t = np.linspace(0, T, 51)
    start = np.concatenate([Q, torus.momenta(0.0)])
    y = solve_ivp(field, (0, T), start, method="DOP853", rtol=PEER_RELATIVE, atol=PEER_ABSOLUTE, t_eval=t).y.T
    energy = chain.energy(y[:, : len(Q)], y[:, len(Q) :])
    return t, y[:, : len(Q)], np.abs(energy / energy[0] - 1).max()


@pytest.mark.long
@pytest.mark.parametrize("T", [300, pytest.param(1e4, marks=pytest.mark.long)])
def test_the_torus_is_the_orbit_of_the_chain(T):
    """The integrator's errors move the orbit between tori and along them, about as much: by the error d of the energy, an angle of
    d + (omega - Omega) T d, as the frequency depends on the energy by its shift; beside them only the rounding of omega t in doubles."""
    torus = replace(refined(TWO), phases={1: 0.7, 3: -1.9})
    t, Q, drift = integration(torus, T)
    shift = float(np.abs(shifts_of(torus)).max())
    fastest = float(max(torus.frequencies))
    allowed = 4 * drift * (1 + shift * T) + EPS * fastest * T
    assert np.abs(Q - torus.positions(t)).max() <= allowed * np.abs(Q).max()
    assert allowed < ALLOWANCE


@pytest.mark.parametrize("case", BREATHERS)
def test_one_seed_is_a_periodic_orbit(case):
    torus = refined(case)
    (seed,), (frequency,) = torus.seeds, torus.frequencies
    orbit = periodic_orbit(torus.chain, seed, frequency)
    assert torus.amplitudes[seed] == pytest.approx(orbit.amplitude, rel=BREATHER_HARMONICS)
    assert float(torus.energy()) == pytest.approx(orbit.energy(), rel=BREATHER_HARMONICS)
    for (n,), row in rows(torus).items():
        expected = orbit.cosines[n] if n < len(orbit.cosines) else 0 * row
        assert row == pytest.approx(expected, abs=BREATHER_HARMONICS * abs(orbit.amplitude))


@pytest.mark.parametrize("case", ["alpha, breather", "mixed, two", "beta, two"])
def test_amplitudes_give_the_frequencies_back(case):
    torus = refined(case)
    back = refine_at_amplitudes(series_torus(case), torus.amplitudes)
    assert [float(w) for w in back.frequencies] == pytest.approx([float(w) for w in torus.frequencies], rel=REFINED_COEFFICIENT)
    assert shifts_of(back).astype(float) == pytest.approx(shifts_of(torus).astype(float), rel=1e3 * REFINED_COEFFICIENT)
    assert back.amplitudes == pytest.approx(torus.amplitudes, rel=2 * EPS)
    assert difference(torus, back) < REFINED_COEFFICIENT
    assert back.residual() < PROMISED_RESIDUAL


@pytest.mark.parametrize(
    ("harmonic", "ratio"), [(False, "amplitude_ratio"), (True, "amplitude_ratio"), (False, "energy_ratio"), (True, None)]
)
def test_an_energy_and_a_ratio_give_the_torus_back(harmonic, ratio):
    """Those of a torus of given frequencies, whose phases are not zero, from a guess of other amplitudes; the gauge is the angles zero."""
    torus = refined("mixed, two")
    energy = torus.harmonic_energies().sum() if harmonic else torus.energy()
    spectrum = torus.average_spectrum()
    ratios = {
        "amplitude_ratio": {q: 3 * a for q, a in torus.amplitudes.items()},
        "energy_ratio": {q: 7 * spectrum[q - 1] for q in torus.seeds},
    }
    guess = replace(torus, cosines=1.05 * torus.cosines, phases={2: 0.3, 5: 1.1})
    back = refine_at_energy(guess, float(energy), harmonic=harmonic, **({} if ratio is None else {ratio: ratios[ratio]}))
    start = replace(back, phases={2: 0.0, 5: 0.0})
    assert float(start.harmonic_energies().sum() if harmonic else back.energy()) == pytest.approx(float(energy), rel=REFINED_COEFFICIENT)
    assert back.phases == guess.phases
    assert back.amplitudes == pytest.approx(torus.amplitudes, rel=1e2 * REFINED_COEFFICIENT)
    assert [float(w) for w in back.frequencies] == pytest.approx([float(w) for w in torus.frequencies], rel=REFINED_COEFFICIENT)
    assert back.residual() < PROMISED_RESIDUAL


def test_a_ratio_is_that_of_the_result():
    torus = refined(TWO)
    energy = float(torus.energy())
    by_amplitude = refine_at_energy(torus, energy, harmonic=False, amplitude_ratio={3: "1/3", 1: 1}, tolerance=FEW_HARMONICS)
    assert by_amplitude.amplitudes[3] / by_amplitude.amplitudes[1] == pytest.approx(1 / 3, rel=REFINED_COEFFICIENT)
    by_energy = refine_at_energy(torus, energy, harmonic=False, energy_ratio={1: 1, 3: "3/2"}, tolerance=FEW_HARMONICS)
    spectrum = by_energy.average_spectrum()
    assert spectrum[2] / spectrum[0] == pytest.approx(1.5, rel=REFINED_COEFFICIENT)
    assert float(by_energy.energy()) == pytest.approx(energy, rel=REFINED_COEFFICIENT)
    assert by_energy.residual() < FEW_HARMONICS


def small(case, scale):
    """The torus of the case with all amplitudes scaled down; and the scaled amplitudes."""
    amplitudes = {q: scale * a for q, a in CASES[case][1].items()}
    torus = series_torus(case)
    reach = scale ** np.abs(torus.harmonics).sum(axis=1)[:, None]
    return refine_at_amplitudes(
        replace(refined(case), harmonics=torus.harmonics, cosines=torus.cosines * reach), amplitudes, tolerance=FEW_HARMONICS
    ), amplitudes


@pytest.mark.parametrize("case", ["alpha, breather", TWO, "beta, two", "mixed, two"])
def test_small_tori_have_the_shifts_of_the_lowest_order(case):
    """omega - Omega is frequency_shift of the amplitudes up to the fourth power of their size."""
    scales, errors = SCALES, []
    for scale in scales:
        torus, amplitudes = small(case, float(scale))
        expected = np.array(list(frequency_shift(torus.chain, amplitudes).values()))
        errors.append((shifts_of(torus) - expected).astype(float))
    assert np.abs(errors[-1]).max() < 0.01 * np.abs(expected).max()
    for error in np.array(errors).T:
        assert fitted_slope(scales, error) == pytest.approx(4, abs=SLOPE)


def test_shifts_near_the_toda_lattice_depend_on_the_own_amplitude():
    """At beta = 2 alpha^2 / 3, omega_q - Omega_q = (alpha^2/2N) Omega_q A_q^2 up to the fourth power, whatever the other amplitude."""
    chain = Chain(8, alpha="0.3", beta="0.06")
    guess = solve_amplitudes(
        lindstedt(chain, (1, 3), [f"{float(chain.linear_frequency(q)) + x:.12f}" for q, x in ((1, 2e-6), (3, 6e-6))], 3)
    )
    for other in (0.5, 2.0):
        errors = []
        for scale in SCALES:
            amplitudes = {1: 0.3 * float(scale), 3: 0.3 * other * float(scale)}
            expected = [0.3**2 / 16 * float(chain.linear_frequency(q)) * a**2 for q, a in amplitudes.items()]
            errors.append((shifts_of(refine_at_amplitudes(guess, amplitudes, tolerance=FEW_HARMONICS)) - expected).astype(float))
        assert np.abs(errors[-1]).max() < 0.01 * max(expected)
        for error in np.array(errors).T:
            assert fitted_slope(SCALES, error) == pytest.approx(4, abs=SLOPE)


def test_phases_only_shift_the_angles():
    plain, tau = refined(TWO), 2.5
    turned = refine(replace(series_torus(TWO), phases={q: float(w) * tau for q, w in zip(plain.seeds, plain.frequencies, strict=True)}))
    assert (turned.cosines == plain.cosines).all()
    t = np.array([0.0, 1.3, 17.0])
    assert turned.positions(t) == pytest.approx(plain.positions(t + tau), abs=64 * EPS)
    assert turned.momenta(t) == pytest.approx(plain.momenta(t + tau), abs=64 * EPS)
    assert np.abs(turned.positions(t) - plain.positions(t)).max() > 0.1


def test_the_torus_of_figure_1():
    """The amplitudes by two routes: the resummed series gives 0.58488951 and 0.41155510; the digits are of long doubles."""
    torus = refine(solve_amplitudes(lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, 6)))
    assert torus.residual() < PROMISED_RESIDUAL
    assert torus.amplitudes == pytest.approx({1: 0.58488950850640, 2: 0.41155510344390}, abs=FOURTEEN_DIGITS)
    assert torus.near_resonances[0].harmonic == (5, -4)
    assert torus.near_resonances[0].mode == 3


def honest(failure, seeds):
    """What a failure carries is data: finite numbers of the best iterate."""
    assert failure.iterate.seeds == seeds
    assert np.isfinite(failure.iterate.cosines).all()
    assert all(np.isfinite(float(w)) for w in failure.iterate.frequencies)
    assert np.isfinite(failure.residual)
    assert failure.residual > PROMISED_RESIDUAL
    assert failure.reason in str(failure)
    assert "start from a torus nearer" in str(failure)


@pytest.mark.parametrize(
    ("case", "factors"),
    [
        pytest.param("alpha, breather", (-1,), id="other side, alpha"),
        pytest.param("beta, breather", (-1,), id="other side, beta"),
        pytest.param("alpha, breather", (-1e3,), id="far on the other side"),
        pytest.param(TWO, (-1, -10), id="other side of both"),
        pytest.param(TWO, (1e3, 1), id="far too large a shift"),
        pytest.param(TWO, (1, -10), id="other side of the second, alpha"),
        pytest.param("beta, two", (1, -1), id="other side of the second, beta"),
    ],
)
def test_frequencies_that_no_torus_has_are_refused(case, factors):
    """Also if Newton's method ends at a torus of fewer angles: with the amplitude of a seed zero, its frequency means nothing."""
    torus = refined(case)
    shifts = shifts_of(torus).astype(float) * factors
    with pytest.raises(NoTorus) as failure:
        refine(changed(torus, shifts))
    honest(failure.value, torus.seeds)


@pytest.mark.parametrize("scale", [0.0, float("nan"), 1e200])
def test_guesses_that_are_none_are_refused(scale):
    torus = refined(TWO)
    with pytest.raises((InputError, NoTorus)) as failure:
        refine(replace(torus, cosines=scale * torus.cosines))
    if isinstance(failure.value, NoTorus):
        honest(failure.value, torus.seeds)


@pytest.mark.parametrize("energy", [1e9, 1e300])
def test_an_energy_beyond_reach_is_refused(energy):
    with pytest.raises(NoTorus) as failure:
        refine_at_energy(refined(TWO), energy, harmonic=False)
    assert np.isfinite(failure.value.residual)
    assert np.isfinite(failure.value.iterate.cosines).all()


def test_a_tolerance_below_rounding_is_said_to_be_missed():
    torus = refine(series_torus("alpha, breather"), tolerance=1e-17)
    (warning,) = torus.warnings
    assert "above the tolerance 1e-17" in warning
    assert warning in repr(torus)
    assert LONG_DOUBLE_RESIDUAL < torus.residual() < PROMISED_RESIDUAL


@pytest.mark.parametrize("tolerance", [0, 1, -1e-13, float("nan"), float("inf"), "small", None])
def test_tolerances_are_positive_numbers_below_one(tolerance):
    torus = refined(TWO)
    for search in (
        lambda: refine(torus, tolerance=tolerance),
        lambda: refine_at_amplitudes(torus, torus.amplitudes, tolerance=tolerance),
        lambda: refine_at_energy(torus, 0.02, harmonic=False, tolerance=tolerance),
    ):
        with pytest.raises(InputError, match=r"^tolerance = "):
            search()


@pytest.mark.parametrize(
    "amplitudes",
    [{}, {1: 0.1}, {1: 0.1, 2: 0.1}, {1: 0, 3: 0.1}, {1: 0.1, 3: "0.0"}, {1: 0.1, 3: "x"}, {1: 0.1, 3: float("nan")}, (0.1, 0.1), 1],
)
def test_amplitudes_are_numbers_other_than_zero_for_every_seed(amplitudes):
    with pytest.raises(InputError, match=r"^amplitudes"):
        refine_at_amplitudes(refined(TWO), amplitudes)


@pytest.mark.parametrize("energy", [0, -1, "0", "x", float("nan"), float("inf"), None])
def test_energies_are_positive_numbers(energy):
    with pytest.raises(InputError, match=r"^energy = "):
        refine_at_energy(refined(TWO), energy, harmonic=True)


@pytest.mark.parametrize("name", ["amplitude_ratio", "energy_ratio"])
@pytest.mark.parametrize("ratio", [{}, {1: 1}, {1: 1, 2: 1}, {1: 0, 3: 1}, {1: 1, 3: 0}, {1: 1, 3: "x"}, (1, 1), 2])
def test_ratios_are_numbers_other_than_zero_for_every_seed(name, ratio):
    with pytest.raises(InputError, match=f"^{name}"):
        refine_at_energy(refined(TWO), 0.02, harmonic=False, **{name: ratio})


def test_ratios_of_energies_are_positive_and_only_one_ratio_is_given():
    with pytest.raises(InputError, match=r"^energy_ratio"):
        refine_at_energy(refined(TWO), 0.02, harmonic=False, energy_ratio={1: 1, 3: -1})
    with pytest.raises(InputError, match=r"^energy_ratio .* only one of amplitude_ratio and energy_ratio"):
        refine_at_energy(refined(TWO), 0.02, harmonic=False, amplitude_ratio={1: 1, 3: 1}, energy_ratio={1: 1, 3: 1})


def test_every_step_is_reported():
    lines = []
    torus = refine(series_torus("mixed, breather"), progress=lambda label, fraction: lines.append(label))
    assert sum(line.startswith("step") for line in lines) >= len(torus.steps) >= 1
    assert lines[0].split()[1] == "harmonics,"
    assert lines[-1].startswith("residual")


def test_fewer_harmonics_than_a_torus_needs_are_said_and_leave_a_residual():
    """The limit is an argument: with 60 of the harmonics the same torus is left with a doubt."""
    near = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4", 2: "0.2"}, order=4)
    whole, few = refine(near), refine(near, most_harmonics=60)
    assert len(few.harmonics) <= 60 < len(whole.harmonics)
    assert whole.verdict == "torus"
    assert few.verdict == "doubtful"
    assert few.residual() > whole.residual()
    assert "most_harmonics=60" in few.warnings[0]


@pytest.mark.parametrize("count", [0, 1.5, "many", True])
def test_a_number_of_harmonics_is_whole_and_one_a_seed_at_least(count):
    near = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4"}, order=4)
    with pytest.raises(InputError, match="most_harmonics"):
        refine(near, most_harmonics=count)
