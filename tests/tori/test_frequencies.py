"""Amplitudes to frequencies: there and back, rates at small amplitudes, exactly solvable reductions, the paper's tori."""

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, NoSelfConsistentFrequencies, Orders, ResonantDivisor, frequency_shift, lindstedt
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS
from symfpu.tori import frequencies
from symfpu.tori.frequencies import series_at_amplitudes
from tests.refusals import each
from tests.tolerances import LAST_DIGIT, RELATIVE_SHIFT, ROUNDING, SAME_SHIFT, THERE_AND_BACK

ROUND_TRIPS = [
    (Chain(16, alpha="0.33"), {1: "0.58", 2: "0.41"}, 8),
    (Chain(16, alpha="-0.33"), {1: "0.58", 2: "0.41"}, 7),
    (Chain(9, alpha="0.4"), {8: "0.2"}, 6),
    (Chain(2, beta=1), {1: "0.3"}, 10),
    (Chain(16, beta="-0.3"), {3: "0.3", 5: "0.2"}, 5),
    (Chain(16, beta="0.3"), {1: "0.3", 2: "0.2", 15: "0.05"}, 3),
    (Chain(12, alpha="-0.25", beta="0.2"), {3: "0.2", 10: "0.1", 7: "0.1"}, 6),
    (Chain(6, alpha="0.33"), {4: "0.1", 5: "0.1"}, 6),
]


@pytest.mark.long
@pytest.mark.parametrize(("chain", "amplitudes", "order"), ROUND_TRIPS, ids=str)
def test_the_frequencies_give_the_amplitudes_back(chain, amplitudes, order):
    torus = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=order)
    assert torus.amplitudes == {q: float(amplitudes[q]) for q in sorted(amplitudes)}
    back = symfpu.solve_amplitudes(torus.origin.series)
    assert list(back.amplitudes.values()) == pytest.approx(list(torus.amplitudes.values()), rel=THERE_AND_BACK)
    terms, _ = torus.origin.series.frequency_terms([a**2 for a in torus.amplitudes.values()])
    left = np.abs(terms.sum(axis=0) - [float(w) for w in torus.frequencies])
    assert left.max() < ROUNDING
    assert torus.origin.root_residual < ROUNDING
    assert torus.warnings == back.warnings
    assert torus.origin.history == back.origin.history


@pytest.mark.long
@pytest.mark.parametrize(
    ("printed", "order", "tolerance"),
    [(APPENDIX_F[1], 6, 1e-10), (APPENDIX_F[4], 4, 1e-10), (TWO_TORUS, 14, 1e-4)],
    ids=lambda value: getattr(value, "label", None),
)
def test_printed_tori_of_other_figures(printed, order, tolerance):
    """Those of Appendix F have many digits; the seven of Fig. 1 are met up to the orders from 16 to 24."""
    torus = symfpu.torus(
        printed.chain,
        printed.seeds,
        amplitudes=dict(zip(printed.seeds, printed.amplitudes, strict=True)),
        method="series",
        order=order,
    )
    for q, found, expected in zip(printed.seeds, torus.frequencies, printed.frequencies, strict=True):
        shift = abs(float(expected) - printed.chain.frequencies()[q - 1])
        assert abs(float(found) - float(expected)) < tolerance * shift


def test_divisors_are_those_of_the_frequencies_found():
    """Order 2 with the divisors of the linear frequencies is `frequency_shift`: the same amplitudes, other frequencies."""
    chain, amplitudes = Chain(16, alpha="0.33"), {1: 0.58, 2: 0.41}
    torus = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=2)
    at_linear, at_found = (
        lindstedt(chain, (1, 2), w, 2).frequency_terms([0.58**2, 0.41**2])[0][2]
        for w in (chain.frequencies()[:2].tolist(), torus.frequencies)
    )
    shift = np.array([float(w) for w in torus.frequencies]) - chain.frequencies()[:2]
    assert list(frequency_shift(chain, amplitudes).values()) == pytest.approx(at_linear, rel=RELATIVE_SHIFT)
    assert shift == pytest.approx(at_found, rel=SAME_SHIFT)
    assert np.abs(at_found / at_linear - 1).min() > 0.03


def test_middle_mode_of_alpha_keeps_its_frequency():
    torus = symfpu.torus(Chain(16, alpha=1), (8,), amplitudes={8: "0.3"}, method="series", order=6)
    assert float(torus.frequencies[0]) == pytest.approx(2**0.5, rel=LAST_DIGIT)
    assert "do not determine" in torus.warnings[0]


def test_a_family_that_ends_says_where():
    """Order 1 of a soft beta breather is omega = Omega (1 - c A^2): at A^2 = 1/c no frequency is left."""
    chain, seed = Chain(8, beta=-1), 3
    end = (-chain.frequencies()[seed - 1] / frequency_shift(chain, {seed: 1.0})[seed]) ** 0.5
    with pytest.raises(NoSelfConsistentFrequencies) as caught:
        symfpu.torus(chain, (seed,), amplitudes={seed: 10}, method="series", order=1)
    error = caught.value
    assert error.amplitudes == {seed: 10.0}
    assert 0.97 * end < error.reached[seed] < end
    assert "omega_3" in error.reason
    assert set(error.frequencies) == {seed}
    assert isinstance(error, symfpu.SymfpuError)
    assert "\n" not in str(error)
    symfpu.torus(chain, tuple(error.reached), amplitudes=error.reached, method="series", order=1)


def of_round_trip():
    chain, amplitudes, order = ROUND_TRIPS[0]
    return symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=order)


@pytest.mark.long
def test_a_resonant_trial_is_walked_around(monkeypatch):
    """The first trial, straight from rest, meets a resonance; shorter steps have other trials."""
    calls = []

    def resonant(*arguments, **options):
        calls.append(arguments)
        if len(calls) == 1:
            raise ResonantDivisor(3, (1, 1), (1, 2), 2, exact=True)
        return lindstedt(*arguments, **options)

    plain = of_round_trip()
    monkeypatch.setattr(frequencies, "lindstedt", resonant)
    torus = of_round_trip()
    assert [float(w) for w in torus.frequencies] == pytest.approx([float(w) for w in plain.frequencies], rel=ROUNDING)


def test_resonances_everywhere_are_the_reason(monkeypatch):
    def resonant(*arguments, **options):
        raise ResonantDivisor(3, (1, 1), (1, 2), 2, exact=True)

    monkeypatch.setattr(frequencies, "lindstedt", resonant)
    with pytest.raises(NoSelfConsistentFrequencies, match="commensurable") as caught:
        of_round_trip()
    assert caught.value.reached == {1: 0.0, 2: 0.0}


def test_the_orders_are_passed_on():
    chain, amplitudes = Chain(16, alpha="0.33"), {1: "0.3", 2: "0.2"}
    orders = Orders(6, frequency_order=4, coordinate_order=3)
    torus = symfpu.torus(chain, (1, 2), amplitudes=amplitudes, method="series", order=orders)
    assert (torus.origin.series.order, torus.origin.frequency_order, torus.origin.order) == (6, 4, 3)
    same = symfpu.torus(chain, tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)
    assert torus.frequencies == same.frequencies


@each(
    amplitudes=[[0.1], {1: -0.1}, {1: 0}, {1: float("nan")}, {1: "1e-20"}],
    order=[1, 2.0],
    digits=[0],
    chain=[8],
)
def test_bad_arguments_are_refused_by_name(name, value):
    given = {"seeds": (1,), "amplitudes": {1: 0.1}, "method": "series", "order": 4}
    with pytest.raises(InputError) as caught:
        symfpu.torus(**{"chain": Chain(8, alpha="0.3"), **given} | {name: value})
    assert caught.value.argument.startswith(name)


@each(order=[-1, 2.0, "x"], frequency_order=[0, 5, 1.5], coordinate_order=[5, -1])
def test_orders_beyond_the_series_are_refused(name, value):
    with pytest.raises(InputError) as caught:
        Orders(**{"order": 4} | {name: value})
    assert caught.value.argument == name


@pytest.mark.parametrize("amplitudes", [{}, {9: 0.1}])
def test_amplitudes_of_no_seeds_are_refused(amplitudes):
    with pytest.raises(InputError, match=r"^seeds = "):
        symfpu.torus(Chain(8, alpha="0.3"), tuple(amplitudes), amplitudes=amplitudes, method="series", order=4)


NEIGHBOURS = [
    (Chain(8, alpha="0.33"), {1: "0.2", 2: "0.1"}, {1: "0.22", 2: "0.1"}, 4),
    pytest.param(Chain(16, beta="-0.3"), {3: "0.3", 5: "0.2"}, {3: "0.2", 5: "0.25"}, 5, marks=pytest.mark.long),
    pytest.param(Chain(2, beta=1), {1: "0.3"}, {1: "0.6"}, 6, marks=pytest.mark.long),
]


@pytest.mark.parametrize(("chain", "first", "second", "order"), NEIGHBOURS, ids=str)
def test_a_torus_nearby_saves_series_and_decides_nothing(chain, first, second, order, monkeypatch):
    counted = []

    def counting(*arguments, **options):
        counted.append(1)
        return lindstedt(*arguments, **options)

    monkeypatch.setattr(frequencies, "lindstedt", counting)
    start = symfpu.torus(chain, tuple(first), amplitudes=first, method="series", order=order)
    counted.clear()
    from_rest = symfpu.torus(chain, tuple(second), amplitudes=second, method="series", order=order)
    needed = len(counted)
    counted.clear()
    nearby = series_at_amplitudes(chain, second, Orders(order), near=start)
    assert 0 < len(counted) <= needed
    assert nearby.amplitudes == from_rest.amplitudes
    shifts = [[float(w) for w in torus.frequencies] for torus in (nearby, from_rest)]
    assert shifts[0] == pytest.approx(shifts[1], rel=ROUNDING)
    counted.clear()
    again = series_at_amplitudes(chain, second, Orders(order), near=nearby)
    assert len(counted) < needed
    assert [float(w) for w in again.frequencies] == pytest.approx(shifts[1], rel=ROUNDING)


@pytest.mark.parametrize(
    ("chain", "seeds", "order"),
    [(Chain(8, alpha="0.4"), {1: "0.2"}, 4), (Chain(8, alpha="0.33"), {2: "0.2"}, 4)],
    ids=str,
)
def test_a_torus_of_something_else_is_not_nearby(chain, seeds, order):
    start = symfpu.torus(Chain(8, alpha="0.33"), (1,), amplitudes={1: "0.2"}, method="series", order=4)
    with pytest.raises(InputError, match="near"):
        series_at_amplitudes(chain, seeds, Orders(order), near=start)
