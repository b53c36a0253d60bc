"""A phantom seed: the cut recursion against the whole one in every ring, closed forms, and resonances named."""

import pytest
import symengine as se

from symfpu import Chain, InputError, ResonantDivisor, TooLarge, lindstedt, normal_frequency_series, substitute_multipliers
from symfpu.series.memory import check_size
from tests.tolerances import ROUNDING, THIRTY_DIGITS

BOTH = Chain(8, alpha="0.3", beta="0.2")
CASES = {
    "alpha, two seeds": (BOTH, (1, 3), 5, 4),
    "one seed, the mode below": (Chain(8, alpha="0.3"), (2,), 1, 6),
    "beta, four seeds": (Chain(8, beta="-0.3"), (1, 2, 3, 6), 4, 2),
    "Toda": (Chain(6, potential="toda:1/2"), (1, 5), 3, 4),
    "N - q": (Chain(7, beta=1), (2, 3), 5, 3),
}


def chosen(chain, modes):
    """Frequencies a little above the linear ones, without relations."""
    linear = chain.frequencies()
    return {q: f"{linear[q - 1] * (1 + 0.01 / (q + 1)):.7f}" for q in modes}


def whole(chain, seeds, mode, order, **options):
    """By the series with one seed more: the terms without its amplitude, by order."""
    every = tuple(sorted((*seeds, mode)))
    place = every.index(mode)
    series = lindstedt(chain, every, order=order, **options)
    for k in range(order + 1):
        rows, values = series.frequency_coefficients(mode, k)
        yield {tuple(e[:place] + e[place + 1 :]): c for e, c in zip(rows.tolist(), values, strict=True) if not e[place]}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_cut_at_the_first_power_nothing_of_the_frequency_is_lost(case):
    chain, seeds, mode, order = case
    omega = chosen(chain, (mode, *seeds))
    found = normal_frequency_series(chain, seeds, mode, order, omega)
    expected = list(whole(chain, seeds, mode, order, frequencies=omega_of(omega)))
    for mine, theirs in zip(found.coefficients, expected, strict=True):
        assert mine == pytest.approx(theirs, rel=ROUNDING)
    assert found.at(dict.fromkeys(seeds, 0.1)) == pytest.approx(sum(found.terms(dict.fromkeys(seeds, 0.1))), rel=ROUNDING)


def omega_of(omega):
    return [omega[q] for q in sorted(omega)]


@pytest.mark.parametrize("ring", ["symbolic", "nested"])
def test_symbols_are_those_of_the_whole_series(ring):
    """Their harmonics have the phantom seed first; written out both are one rational function."""
    seeds, mode, order = (1, 3), 2, 2
    found = normal_frequency_series(BOTH, seeds, mode, order, ring=ring)
    series = lindstedt(BOTH, (1, 2, 3), order=order)
    expected = series.frequency_correction(mode, order).subs({se.Symbol("A2"): 0})
    mine = substitute_multipliers(found.correction(order), (mode, *seeds))
    theirs = substitute_multipliers(expected, (1, 2, 3))
    values = {s: se.Rational(7 + 2 * i, 11 + i * i) for i, s in enumerate(sorted(mine.free_symbols, key=str))}
    assert mine.free_symbols == theirs.free_symbols
    assert (mine.subs(values) - theirs.subs(values)).expand() == 0


@pytest.mark.parametrize("mode", [5, pytest.param(7, marks=pytest.mark.long)])
def test_digits_are_those_of_the_whole_series(mode):
    omega = chosen(BOTH, (1, 3, mode))
    found = normal_frequency_series(BOTH, (1, 3), mode, 3, omega, digits=40)
    expected = list(whole(BOTH, (1, 3), mode, 3, frequencies=omega_of(omega), digits=40))
    for mine, theirs in zip(found.coefficients, expected, strict=True):
        assert mine.keys() == theirs.keys()
        assert all(abs(c / theirs[e] - 1) < THIRTY_DIGITS for e, c in mine.items())


def test_a_phantom_seed_that_is_resonant_is_named():
    with pytest.raises(ResonantDivisor, match="omega_2") as caught:
        normal_frequency_series(BOTH, (1,), 2, 2, {1: "0.4", 2: "0.8"})
    assert (caught.value.mode, caught.value.harmonic) == (2, (0, 2))


def test_memory_is_asked_for_before():
    with pytest.raises(TooLarge):
        normal_frequency_series(BOTH, (1, 2, 3, 4), 5, 60)
    check_size(BOTH, (5, 1, 2), 6, "float64", phantom=True)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((BOTH, (1,), 1, 2), "no seed"),
        ((BOTH, (1,), 8, 2), "^mode"),
        ((BOTH, (1,), 2, -1), "^order"),
        ((BOTH, (1, 1), 2, 1), "seeds"),
        ((BOTH, (1,), 2, 1, {1: "0.4"}), "^frequencies"),
        ((BOTH, (1,), 2, 1, {1: "0.4", 2: -1}), "positive"),
        ((BOTH, (1,), 2, 1, ("0.4", "0.8")), "^frequencies"),
        ((Chain("N", beta=1), (1,), 2, 1), "frequency_shift_formula"),
        ((Chain(8, beta=1, ends="periodic"), (1,), 2, 1), "on a ring give"),
    ],
    ids=lambda x: repr(x)[:40],
)
def test_arguments_out_of_range_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        normal_frequency_series(*arguments)


def test_rings_and_numbers_are_told_apart():
    universal = normal_frequency_series(BOTH, (1,), 2, 1)
    for call in (lambda: universal.sigma, lambda: universal.at({1: 0.1})):
        with pytest.raises(InputError, match="universal"):
            call()
    omega = chosen(BOTH, (1, 2))
    for options, message in (({"ring": "residue"}, "^ring"), ({"ring": "float64", "digits": 20}, "^ring")):
        with pytest.raises(InputError, match=message):
            normal_frequency_series(BOTH, (1,), 2, 1, omega, **options)
    with pytest.raises(InputError, match=r"^amplitudes"):
        normal_frequency_series(BOTH, (1,), 2, 1, omega).at({2: 0.1})
    with pytest.raises(InputError, match=r"^order"):
        universal.correction(2)
