"""Refined tori against the equations of motion: residuals, integration, breathers, all ways to prescribe them, and where there are none."""

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import mpmath
import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoTorus, frequency_shift, lindstedt, refine
from symfpu.paper.printed import TWO_TORUS
from symfpu.refinement import newton
from symfpu.refinement.conditions import frequency
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.invariance import InvarianceEquation
from tests import tolerances
from tests.tolerances import BREATHER_HARMONICS, EPS, LOW_ACCURACY, NEWTON_SLOPE, PROMISED_RESIDUAL, REFINED_COEFFICIENT, SLOPE

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
    return symfpu.solve_amplitudes(lindstedt(chain, tuple(amplitudes), frequencies, order))


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
    assert all(torus.amplitudes[q] == pytest.approx(a, rel=tolerances.LONGER_SERIES) for q, a in series.amplitudes.items())
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
    smallest = np.sort(np.abs(divisors[allowed]))[: len(torus.origin.near_resonances)]
    assert [abs(r.divisor) for r in torus.origin.near_resonances] == pytest.approx(smallest, abs=64 * EPS)
    assert all(r.coefficient == rows(torus)[r.harmonic][r.mode - 1] for r in torus.origin.near_resonances)


def test_harmonics_are_as_many_as_the_tolerance_needs():
    rough, fine = (refine(series_torus(TWO), tolerance=x) for x in (1e-6, 1e-11))
    assert len(rough.harmonics) < len(fine.harmonics) < len(refined(TWO).harmonics)
    assert rough.residual() <= LOW_ACCURACY
    assert fine.residual() <= tolerances.HIGH_ACCURACY
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
    found = newton.newton(
        equation, [frequency(i, x, equation.seed_frequencies) for i, x in enumerate(shifts)], disturbed.astype(np.longdouble), shifts
    )
    assert not found.failure
    changes = np.array([step.change for step in found.steps])
    assert changes[0] > 1e-3
    assert changes[-1] < PROMISED_RESIDUAL
    before, after = changes[:-1], changes[1:]
    assert (after <= 20 * before**2 + tolerances.NEWTON_LINEAR * before).all()
    seen = before > 1e-8
    assert fitted_slope(before[seen], after[seen]) == pytest.approx(2, abs=NEWTON_SLOPE)
    assert difference(torus, replace(torus, cosines=found.cosines.astype(float))) < REFINED_COEFFICIENT


@pytest.mark.parametrize("case", BREATHERS)
def test_one_seed_is_a_periodic_orbit(case):
    torus = refined(case)
    (seed,), (frequency,) = torus.seeds, torus.frequencies
    orbit = symfpu.torus(torus.chain, (seed,), frequencies=(frequency,))
    assert torus.amplitudes[seed] == pytest.approx(orbit.amplitude, rel=BREATHER_HARMONICS)
    assert float(torus.energy()) == pytest.approx(orbit.energy(), rel=BREATHER_HARMONICS)
    for (n,), row in rows(torus).items():
        expected = orbit.cosines[n] if n < len(orbit.cosines) else 0 * row
        assert row == pytest.approx(expected, abs=BREATHER_HARMONICS * abs(orbit.amplitude))


@pytest.mark.parametrize("case", ["alpha, breather", "mixed, two", "beta, two"])
def test_amplitudes_give_the_frequencies_back(case):
    torus = refined(case)
    back = refine(series_torus(case), amplitudes=torus.amplitudes)
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
    back = refine(guess, energy=symfpu.Energy(float(energy), harmonic=harmonic, **({} if ratio is None else {ratio: ratios[ratio]})))
    start = replace(back, phases={2: 0.0, 5: 0.0})
    assert float(start.harmonic_energies().sum() if harmonic else back.energy()) == pytest.approx(float(energy), rel=REFINED_COEFFICIENT)
    assert back.phases == guess.phases
    assert back.amplitudes == pytest.approx(torus.amplitudes, rel=1e2 * REFINED_COEFFICIENT)
    assert [float(w) for w in back.frequencies] == pytest.approx([float(w) for w in torus.frequencies], rel=REFINED_COEFFICIENT)
    assert back.residual() < PROMISED_RESIDUAL


def small(case, scale):
    """The torus of the case with all amplitudes scaled down; and the scaled amplitudes."""
    amplitudes = {q: scale * a for q, a in CASES[case][1].items()}
    torus = series_torus(case)
    reach = scale ** np.abs(torus.harmonics).sum(axis=1)[:, None]
    return refine(
        replace(refined(case), harmonics=torus.harmonics, cosines=torus.cosines * reach),
        amplitudes=amplitudes,
        tolerance=tolerances.FEW_HARMONICS,
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


def test_phases_only_shift_the_angles():
    plain, tau = refined(TWO), 2.5
    turned = refine(replace(series_torus(TWO), phases={q: float(w) * tau for q, w in zip(plain.seeds, plain.frequencies, strict=True)}))
    assert (turned.cosines == plain.cosines).all()
    t = np.array([0.0, 1.3, 17.0])
    assert turned.Q(t) == pytest.approx(plain.Q(t + tau), abs=64 * EPS)
    assert turned.P(t) == pytest.approx(plain.P(t + tau), abs=64 * EPS)
    assert np.abs(turned.Q(t) - plain.Q(t)).max() > 0.1


def test_the_torus_of_figure_1():
    """The amplitudes by two routes: the resummed series gives 0.58488951 and 0.41155510; the digits are of long doubles."""
    torus = refine(symfpu.solve_amplitudes(lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, 6)))
    assert torus.residual() < PROMISED_RESIDUAL
    assert torus.amplitudes == pytest.approx({1: 0.58488950850640, 2: 0.41155510344390}, abs=tolerances.FOURTEEN_DIGITS)
    assert torus.origin.near_resonances[0].harmonic == (5, -4)
    assert torus.origin.near_resonances[0].mode == 3


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


@pytest.mark.parametrize("energy", [1e9, 1e50])
def test_an_energy_beyond_reach_is_refused(energy):
    with pytest.raises(NoTorus) as failure:
        refine(refined(TWO), energy=energy)
    assert np.isfinite(failure.value.residual)
    assert np.isfinite(failure.value.iterate.cosines).all()


def test_a_tolerance_below_rounding_is_said_to_be_missed():
    torus = refine(series_torus("alpha, breather"), tolerance=1e-17)
    (warning,) = torus.warnings
    assert "above the tolerance 1e-17" in warning
    assert warning in repr(torus)
    assert tolerances.LONG_DOUBLE_RESIDUAL < torus.residual() < PROMISED_RESIDUAL


SEARCHES = {
    "frequencies": refine,
    "amplitudes": lambda torus, **given: refine(torus, **{"amplitudes": torus.amplitudes} | given),
    "energy": lambda torus, energy=0.02, **given: refine(torus, energy=energy, **given),
    "ratio": lambda torus, **ratio: refine(torus, energy=symfpu.Energy(0.02, **ratio)),
}
WRONG_AMPLITUDES = ({}, {1: 0.1}, {1: 0.1, 2: 0.1}, {1: 0, 3: 0.1}, {1: 0.1, 3: "0.0"}, {1: 0.1, 3: "x"}, {1: 0.1, 3: float("nan")}, 1)
WRONG_RATIOS = ({}, {1: 1}, {1: 1, 2: 1}, {1: 0, 3: 1}, {1: 1, 3: 0}, {1: 1, 3: "x"}, (1, 1), 2)
WRONG = [
    *(
        (search, "tolerance", x)
        for search in ("frequencies", "amplitudes", "energy")
        for x in (0, 1, -1e-13, float("nan"), float("inf"), "small", None)
    ),
    *(("amplitudes", "amplitudes", x) for x in (*WRONG_AMPLITUDES, (0.1, 0.1))),
    *(("energy", "energy", x) for x in (0, -1, "0", "x", float("nan"), float("inf"))),
    *(("ratio", name, x) for name in ("amplitude_ratio", "energy_ratio") for x in WRONG_RATIOS),
    ("ratio", "energy_ratio", {1: 1, 3: -1}),
    *(("frequencies", "most_harmonics", x) for x in (0, 1.5, "many", True)),
]


@pytest.mark.parametrize(("search", "name", "value"), WRONG)
def test_wrong_arguments_are_refused_by_name(search, name, value):
    with pytest.raises(InputError, match=rf"^{name}\b"):
        SEARCHES[search](refined(TWO), **{name: value})


def test_only_one_ratio_is_given():
    with pytest.raises(InputError, match=r"^energy_ratio .* only one of amplitude_ratio and energy_ratio"):
        refine(refined(TWO), energy=symfpu.Energy(0.02, amplitude_ratio={1: 1, 3: 1}, energy_ratio={1: 1, 3: 1}))


def test_every_step_is_reported():
    lines = []
    torus = refine(series_torus("mixed, breather"), progress=lambda label, fraction: lines.append(label))
    assert sum(line.startswith("step") for line in lines) >= len(torus.origin.steps) >= 1
    assert lines[0].split()[1] == "harmonics,"
    assert lines[-1].startswith("residual")


def test_a_diverging_series_is_cut_where_it_is_best():
    """Its last order leaves all of the largest acceleration, its best 1e-5; Newton's method finds the torus of the latter."""
    torus = symfpu.torus(Chain(8, beta=1), (1, 3), amplitudes={1: "0.3", 3: "0.2"}, method="series", order=6)
    assert torus.residual() > 0.5
    found, by_hand = refine(torus), refine(torus.origin.cut_at(3).torus(torus.phases))
    assert found.residual() < PROMISED_RESIDUAL
    assert found.frequencies == torus.frequencies
    assert np.array_equal(found.harmonics, by_hand.harmonics)
    assert np.array_equal(found.cosines, by_hand.cosines)
    same = refine(torus, amplitudes={1: "0.3", 3: "0.2"})
    assert [float(w) for w in same.frequencies] == pytest.approx([float(w) for w in found.frequencies], rel=LOW_ACCURACY)


@pytest.mark.long
def test_what_fails_from_a_series_says_where_it_began():
    with pytest.raises(NoTorus, match=r"its series leaves \S+ at its best order 0: follow the family of tori from less energy"):
        refine(symfpu.torus(Chain(8, beta=1), (1, 3), amplitudes={1: "0.8", 3: "0.8"}, method="series", order=4))
