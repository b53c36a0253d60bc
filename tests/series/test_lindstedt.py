"""Symmetries of the recursion, selection rules as exact zeros, and what it refuses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu import Chain, TooLarge, excitation_sequence, lindstedt, reachable_modes
from tests.refusals import each, refused
from tests.tolerances import LAST_DIGIT, ROUNDING, THOUSAND_ROUNDINGS

FEW = settings(max_examples=15)


@st.composite
def tori(draw, most_seeds=2):
    """A short chain with seeds and frequencies near the linear ones, off every resonance of low order with odd decimals."""
    N = draw(st.integers(4, 12))
    seeds = sorted(draw(st.lists(st.integers(1, N - 1), min_size=1, max_size=most_seeds, unique=True)))
    linear = Chain(N, 1).frequencies()
    return N, tuple(seeds), tuple(f"{linear[q - 1] + 0.00317 + 0.000713 * i:.7f}" for i, q in enumerate(seeds))


@FEW
@given(tori())
def test_alpha_to_minus_alpha_is_an_odd_order_with_the_other_sign(torus):
    """H(x, alpha) = H(-x, -alpha): A -> -A. The tables have no mu, so only the evaluated terms can tell."""
    N, seeds, frequencies = torus
    plus, minus = (lindstedt(Chain(N, alpha=a, beta="0.1"), seeds, frequencies, 4) for a in ("0.3", "-0.3"))
    amplitudes = np.linspace(0.1, 0.2, len(seeds))
    for k in range(5):
        (nu, terms), (_, mirrored), (_, opposite) = (
            plus.harmonic_terms(amplitudes, k),
            minus.harmonic_terms(amplitudes, k),
            plus.harmonic_terms(-amplitudes, k),
        )
        assert (mirrored == (-1) ** k * terms).all()
        assert np.allclose(mirrored, -opposite, rtol=ROUNDING, atol=0)
        assert len(nu) == len(terms)
    assert np.abs(plus.harmonic_terms(amplitudes, 1)[1]).max() > 0
    assert (plus.frequency_terms(amplitudes**2)[0] == minus.frequency_terms(amplitudes**2)[0]).all()


@FEW
@given(tori(most_seeds=3), st.sampled_from(["alpha", "beta", "alpha+beta"]))
def test_a_mode_enters_no_earlier_than_the_rule_says(torus, model):
    N, seeds, frequencies = torus
    chain = Chain(N, **dict.fromkeys(model.split("+"), "0.3"))
    series = lindstedt(chain, seeds, frequencies, 3)
    for table, reached in zip(series.coordinates, reachable_modes(N, seeds, 3, model=model), strict=True):
        assert {int(q) + 1 for q in np.flatnonzero(table.any(axis=0))} <= set(reached)


def test_a_breather_enters_exactly_where_the_rule_says():
    """N = 32, seed 3: every mode of D_k is zero before order k and is not at k."""
    series = lindstedt(Chain(32, alpha="0.3"), (3,), ("0.2936",), 12)
    for k, (mode,) in enumerate(excitation_sequence(32, (3,), 9)):
        entered = [bool(table[:, mode - 1].any()) for table in series.coordinates[: k + 1]]
        assert entered == [False] * k + [True]


@FEW
@given(tori(most_seeds=3), st.randoms(use_true_random=False))
def test_permuting_the_seeds_with_their_frequencies_changes_nothing(torus, random):
    N, seeds, frequencies = torus
    pairs = list(zip(seeds, frequencies, strict=True))
    random.shuffle(pairs)
    chain = Chain(N, alpha="0.3", beta="0.1")
    ours, theirs = lindstedt(chain, seeds, frequencies, 3), lindstedt(chain, *zip(*pairs, strict=True), 3)
    assert (ours.seeds, ours.frequencies) == (theirs.seeds, theirs.frequencies)
    assert all((a == b).all() for a, b in zip(ours.coordinates, theirs.coordinates, strict=True))
    assert ours.coordinates[1].any()


def test_a_longer_series_begins_with_the_shorter_one():
    chain = Chain(8, alpha="0.3")
    short, long = (lindstedt(chain, (1, 2), ("0.395", "0.77"), order) for order in (3, 5))
    for k in range(4):
        assert np.allclose(short.coordinates[k], long.coordinates[k], rtol=THOUSAND_ROUNDINGS, atol=0)


def test_weak_alpha_tends_to_beta():
    """With alpha -> 0 the even orders 2k of both couplings are the orders k of beta: mu_alpha^2k (beta/alpha^2)^k = mu_beta^k."""
    beta = lindstedt(Chain(8, beta="0.3"), (1,), ("0.4",), 2)
    both = lindstedt(Chain(8, alpha="1e-9", beta="0.3"), (1,), ("0.4",), 4)
    for k in range(3):
        (nu, small), (other, terms) = both.harmonic_terms([0.3], 2 * k), beta.harmonic_terms([0.3], k)
        assert (nu == other).all()
        assert np.allclose(small, terms, rtol=THOUSAND_ROUNDINGS, atol=LAST_DIGIT)


@pytest.mark.parametrize("digits", [None, 30])
def test_progress_counts_the_orders(digits):
    calls = []
    lindstedt(Chain(8, alpha="0.3"), (1,), ("0.4",), 3, digits=digits, progress=lambda *told: calls.append(told))
    assert {label for label, _ in calls} == {"series"}
    fractions = [fraction for _, fraction in calls]
    assert fractions == sorted(fractions)
    assert digits or fractions == [1 / 3, 2 / 3, 1.0]
    assert fractions[-1] == 1


@each(
    seeds=[(), (1, 1), (8,), (0,), (1.0,)],
    frequencies=[("0.4", "0.8"), (), ("-0.4",), ("0",), (float("nan"),), ("inf",), 0.4, "0.4", {2: "0.4"}],
    order=[-1, 2.0],
    ring=["quaternions"],
)
def test_bad_arguments_are_refused_by_name(name, value):
    refused(lindstedt, name, value, chain=Chain(8, alpha=1), seeds=(1,), frequencies=("0.4",), order=2)


def test_a_ring_of_numbers_wants_frequencies():
    refused(lindstedt, "frequencies", None, chain=Chain(8, alpha=1), seeds=(1,), order=2, ring="float64")


def test_the_largest_order_named_is_the_largest_that_fits(monkeypatch):
    """With a million free bytes: the order named is accepted, the next is not."""

    class Memory:
        available = 1_000_000

    monkeypatch.setattr("psutil.virtual_memory", Memory)
    chain, seeds, frequencies = Chain(16, alpha=1), (1, 2), ("0.19626", "0.39046")
    with pytest.raises(TooLarge) as caught:
        lindstedt(chain, seeds, frequencies, 40)
    largest = caught.value.largest
    assert 1 < largest < 40
    assert lindstedt(chain, seeds, frequencies, largest).order == largest
    with pytest.raises(TooLarge):
        lindstedt(chain, seeds, frequencies, largest + 1)


@pytest.mark.parametrize("N", [6000, 10**7])
def test_long_chains_are_counted_before_anything_is_allocated(N):
    """Transforms take N^2 doubles: they are in the prediction, so that a chain too long is refused."""
    from symfpu.algebra.dense import predicted_bytes

    assert predicted_bytes(N, 1, 2, powers=1) > 16 * N * N


def test_frequencies_may_come_from_a_generator():
    assert lindstedt(Chain(8, alpha=1), (1,), (w for w in ["0.4"]), 1).order == 1
