"""The two questions that the paper leaves open: what settles them, at reduced size; the full studies behind `long`."""

import math
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

import symfpu
from symfpu import InputError, amplitude_history, lindstedt, solve_amplitudes
from symfpu.paper.convergence_fig1 import (
    DETUNED_FREQUENCIES,
    INCOMMENSURABLE_FREQUENCIES,
    SHOWN_ORDERS,
    _coincidence,
    cancellation_study,
    growth_ratios,
    resonant_pole,
)
from symfpu.paper.convergence_fig9 import _singularity, breather_study, scheme_limit, series_end
from symfpu.paper.printed import FIG1_AMPLITUDE_ORDER, FIG9_BREATHER, TWO_TORUS
from tests.tolerances import (
    ALIKE,
    END_SPREAD,
    EXPONENT,
    FIVE_DIGITS,
    FOUR_DIGITS,
    FOUR_PLACES,
    LATE_TERM_RATIO,
    PERIODIC_ORBIT,
    ROUNDING,
    SEQUENCE_LIMIT,
    SERIES_END,
    SEVEN_DIGITS,
    SINGULARITY,
    SIX_PLACES,
    SMALL_CHANGE,
    SUMMED_FIG1_FURTHER,
    TERM_RATIO,
    THERE_AND_BACK,
)

pytestmark = pytest.mark.long  # compilers and whole figures: minutes together

RATIO = 1.494248  # by how much the harmonic (5,-4) of mode 3 grows every two orders, from orders 36 .. 42
END = 1.2869859  # amplitude at which the breather's series ends: 30 digits, order 242
PERIODIC = 1.27153895251  # amplitude of the periodic orbit with the printed frequency


@pytest.fixture(scope="module")
def torus():
    series = lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, TWO_TORUS.order)
    return solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)


@pytest.fixture(scope="module")
def breather():
    return lindstedt(FIG9_BREATHER.chain, FIG9_BREATHER.seeds, FIG9_BREATHER.frequencies, 150)


def heights(sums):
    """Largest sum of orders 10 .. 16, 17 .. 23 and 24 .. 30."""
    return [float(sums[first : first + 7].max()) for first in (10, 17, 24)]


def test_one_harmonic_grows_by_a_constant_ratio(torus):
    ratios = growth_ratios(torus)
    assert list(ratios) == list(range(10, 31, 2))
    errors = [abs(ratios[k] / RATIO - 1) for k in range(24, 31, 2)]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < TERM_RATIO
    for k in (24, 30):
        found = []
        for order in (k - 2, k):
            nu, values = torus.origin.series.harmonic_terms(list(torus.amplitudes.values()), order)
            found.append(values[[tuple(row) for row in nu.tolist()].index((5, -4)), 2])
        assert ratios[k] == pytest.approx(found[1] / found[0], rel=ROUNDING)


def test_the_growth_is_the_pole_where_mode_3_meets_the_harmonic(torus):
    """Mode 3 as a third seed of amplitude zero, with divisors of the harmonic: two routes to one number."""
    pole = resonant_pole(torus)
    assert 1 / pole == pytest.approx(RATIO, rel=TERM_RATIO)
    assert 1 / pole == pytest.approx(growth_ratios(torus)[30], rel=TERM_RATIO)


def test_at_the_pole_the_frequency_of_mode_3_is_that_of_the_harmonic(torus):
    """With amplitudes shrunk by sqrt(pole) the probe's own series sums to 4 omega_2 - 5 omega_1; its lowest term is Omega_3."""
    drive = 4 * torus.frequencies[1] - 5 * torus.frequencies[0]
    probe = lindstedt(torus.chain, (1, 2, 3), (*torus.frequencies, drive + Fraction("1e-8")), 14)
    squares = [resonant_pole(torus) * float(a) ** 2 for a in torus.amplitudes.values()]
    terms, _ = probe.frequency_terms([*squares, 0.0])
    shift = float(drive) - 2 * math.sin(3 * math.pi / 32)
    assert terms[0, 2] == pytest.approx(2 * math.sin(3 * math.pi / 32), rel=ROUNDING)
    assert terms[1:, 2].sum() == pytest.approx(shift, rel=TERM_RATIO)


def test_incommensurable_frequencies_do_not_change_how_amplitudes_settle(torus):
    """In doubles; with digits: the study below."""
    ours = amplitude_history(lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, INCOMMENSURABLE_FREQUENCIES, 14)).differences()
    theirs = amplitude_history(torus.origin.series).differences()
    assert list(ours) == list(range(2, 13, 2))
    for k, delta in ours.items():
        assert delta == pytest.approx(theirs[k], rel=ALIKE)


def test_detuning_moves_the_harmonic_to_the_other_side_of_mode_3():
    """Omega_3^2 - (4 omega_2 - 5 omega_1)^2 becomes 12.6 times larger, and negative."""
    linear = (2 * math.sin(3 * math.pi / 32)) ** 2
    near, far = (linear - (4 * float(b) - 5 * float(a)) ** 2 for a, b in (TWO_TORUS.frequencies, DETUNED_FREQUENCIES))
    assert near == pytest.approx(3.4083795e-5, rel=SEVEN_DIGITS)
    assert far / near == pytest.approx(-12.6309, rel=FIVE_DIGITS)


def test_the_first_coincidence_of_the_printed_frequencies_is_far(torus):
    first, second = (Fraction(w) for w in TWO_TORUS.frequencies)
    n, m = _coincidence(torus.origin.series)
    assert (n, m) == (19523, -9813)
    assert n * first + m * second == 0
    assert math.gcd(n, m) == 1  # the smallest whole numbers with this ratio


@pytest.mark.parametrize(("first", "second", "shortest"), [("0.4", "0.8", (2, -1)), ("1/3", "1/2", (3, -2)), ("0.6", "0.9", (3, -2))])
def test_a_coincidence_is_in_lowest_terms(first, second, shortest):
    assert _coincidence(SimpleNamespace(frequencies=(Fraction(first), Fraction(second)))) == shortest


def test_the_breathers_series_ends_in_a_square_root(breather):
    end, spread, exponent = _singularity(breather)
    assert end == pytest.approx(END, rel=SINGULARITY)
    assert spread < SINGULARITY
    assert exponent == pytest.approx(0.5, abs=SMALL_CHANGE)


def test_roots_of_the_breather_fall_and_stay_above_the_end_of_the_series(breather):
    """A(K) > END > PERIODIC: the truncated roots tend to an amplitude beyond which the series says nothing."""
    history = amplitude_history(breather)
    amplitudes = np.array([a for (a,) in history.amplitudes.values()])
    assert len(amplitudes) == 75
    assert (np.diff(amplitudes) < 0).all()
    assert amplitudes[-1] > END
    assert amplitudes[-1] > float(FIG9_BREATHER.amplitudes[0])
    falls = np.abs(np.diff(amplitudes))
    assert (np.diff(falls) < 0).all()


@pytest.mark.parametrize(("end", "exponent"), [(1.5, 0.5), (0.8, -0.25), (2.0, 1.5)])
def test_the_singularity_of_a_binomial_series_is_found(end, exponent):
    """(1 - x / x_c)^g has the ratios (1 - (1 + g) / k) / x_c exactly."""

    class Binomial:
        chain, order, digits = FIG9_BREATHER.chain, 240, 30

        def frequency_terms(self, squares):
            terms = np.zeros((self.order + 1, 1))
            terms[2, 0] = 1.0
            for k in range(2, self.order // 2 + 1):
                terms[2 * k, 0] = terms[2 * k - 2, 0] * (1 - (1 + exponent) / k) / end**2
            return terms, None

    found, spread, power = _singularity(Binomial())
    assert found == pytest.approx(end, rel=SEQUENCE_LIMIT)
    assert power == pytest.approx(exponent, rel=EXPONENT)
    assert spread < SEQUENCE_LIMIT


def test_the_study_of_fig_1():
    labels = []
    study = cancellation_study(lambda label, fraction: labels.append(label))
    printed, precise, rounded, incommensurable, detuned = study.variants
    for variant in (precise, rounded, incommensurable):
        assert variant.sums == pytest.approx(printed.sums, rel=ALIKE)
        for k, delta in variant.differences.items():
            if variant is not rounded and k <= 26:
                assert delta == pytest.approx(printed.differences[k], rel=ALIKE if k <= 12 else 20 * ALIKE)
    growing, falling = heights(printed.sums), heights(detuned.sums)  # omega_2 = 0.39056 makes one divisor twelve times larger
    assert growing[2] > 3 * growing[1] > 3 * growing[0]
    assert falling[0] > 3 * falling[1] > 9 * falling[2]
    assert detuned.residuals.min() < printed.residuals.min() / 100
    assert [study.ratios[k] for k in (36, 38, 40, 42)] == pytest.approx([RATIO] * 4, rel=LATE_TERM_RATIO)
    assert 1 / study.pole == pytest.approx(RATIO, rel=TERM_RATIO)
    assert study.divisor == pytest.approx(3.408e-5, rel=FOUR_DIGITS)
    assert study.coincidence == (19523, -9813)
    assert study.assessment.verdict == "asymptotic, best at order 12"
    assert tuple(study.resummed) == tuple(study.amplitudes) == SHOWN_ORDERS
    assert study.resummed[42] < SUMMED_FIG1_FURTHER < study.residuals[12] < study.residuals[42]
    assert len(labels) == 2 + 5 + 1


@pytest.mark.parametrize(
    ("omega", "before"), [("0.0982", True), ("0.09834", True), ("0.09836", False), (FIG9_BREATHER.frequencies[0], False)]
)
def test_the_series_reaches_its_frequency_before_its_end_up_to_a_limit(omega, before):
    end, reached = series_end(FIG9_BREATHER.chain, 1, omega)
    assert (reached > float(omega)) == before
    assert end > 0.999 * symfpu.torus(FIG9_BREATHER.chain, (1,), frequencies=(omega,)).amplitude


def test_at_the_limit_the_breather_is_the_end_of_its_series():
    limit = scheme_limit(FIG9_BREATHER.chain, 1, ("0.0005", "0.05"))
    end, reached = series_end(FIG9_BREATHER.chain, 1, float(limit.orbit.frequency))
    assert reached == pytest.approx(float(limit.orbit.frequency), abs=PERIODIC_ORBIT)
    assert end == pytest.approx(limit.orbit.amplitude, rel=SERIES_END)  # the two curves touch: the end is found from ratios of its terms
    assert limit.orbit.amplitude == pytest.approx(1.0812, abs=FOUR_PLACES)  # by arclength in the fixed-divisor problem
    assert limit.orbit.energy() == pytest.approx(0.0092638, abs=SIX_PLACES)
    assert limit.family.members[-1].energy > 5 * limit.orbit.energy()
    assert all(m.verdict == "torus" for m in limit.family.members)


def test_a_range_without_the_limit_is_refused():
    with pytest.raises(InputError, match=r"^energies = .*the second larger"):
        scheme_limit(FIG9_BREATHER.chain, 1, ("0.0002", "0.002"))


def test_the_study_of_fig_9():
    study = breather_study()
    assert study.assessment.verdict == "not a torus"
    assert (study.orbit.amplitude, study.singularity, study.exponent) == pytest.approx((PERIODIC, END, 0.5), abs=SERIES_END)
    assert study.spread < END_SPREAD
    assert float(study.at_printed.frequency) > float(study.orbit.frequency)
    assert study.amplitudes[242] == pytest.approx(float(FIG9_BREATHER.amplitudes[0]), rel=THERE_AND_BACK)
