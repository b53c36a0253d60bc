"""Numbers put into universal series: every arithmetic against the ring that has it, for random chains."""

import random
from fractions import Fraction

import numpy as np
import pytest
import symengine as se
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from symfpu import Chain, InputError, ResonantDivisor, lindstedt, load, sample_series, save
from symfpu.algebra.formulas import NodeTable
from symfpu.errors import VanishingResidue
from symfpu.proofs.certificates import random_point
from symfpu.series.coefficients import ResiduePoint
from symfpu.series.residues import residue_series
from tests.oracles.cases import DEEP, SHALLOW
from tests.oracles.residues import coordinates_modulo
from tests.tolerances import COEFFICIENT, DIFFERENCE_OF_DOUBLES, ROUNDING

CASES = (*SHALLOW, *DEEP)
ALPHA = Chain(8, alpha="0.3")


def universal(case):
    return lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, order=case.order)


def require_equal(ours, theirs, tolerance=COEFFICIENT):
    """Both tables of doubles, each scaled by its own unit, to rounding of the largest entry."""
    for kind, shift in (("coordinates", 1), ("corrections", 0)):
        for k, (mine, other) in enumerate(zip(getattr(ours, kind), getattr(theirs, kind), strict=True)):
            degree = theirs.degree(k) - shift if kind == "coordinates" else ours.chain.degree_step * k
            scaled = mine * float(ours.unit) ** degree / float(theirs.unit) ** degree
            assert np.abs(scaled - other).max(initial=0) <= tolerance * np.abs(other).max(initial=0)


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_doubles_are_those_of_the_ring_of_doubles(case):
    ours = universal(case).at(case.frequencies)
    theirs = lindstedt(Chain(case.N, case.alpha, case.beta), case.seeds, case.frequencies, case.order)
    require_equal(ours, theirs)
    assert ours.smallest_divisors == theirs.smallest_divisors
    assert ours.ring == "float64"


@pytest.mark.long
@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_digits_hold_and_their_radii_cover_the_difference(case):
    """Balls and fixed-point numbers, whose errors are bounded by other means, overlap."""
    ours = universal(case).at(case.frequencies, digits=25)
    theirs = lindstedt(ours.chain, case.seeds, case.frequencies, case.order, digits=40)
    assert (ours.digits, ours.ring) == (25, "fixedpoint")
    for k, (mine, other) in enumerate(zip(ours.coordinates, theirs.coordinates, strict=True)):
        power = (theirs.degree(k) - 1) * 1
        scale = theirs.unit**power
        radius = Fraction(ours.radii[k][0] + 1) / 2**ours.bits + Fraction(theirs.radii[k][0] + 1) / 2**theirs.bits * scale
        pairs = zip(mine.integers().ravel(), other.integers().ravel(), strict=True)
        assert all(abs(Fraction(int(a), 2**ours.bits) - Fraction(int(b), 2**theirs.bits) * scale) <= radius for a, b in pairs)
        assert ours.radii[k][0] <= max(abs(mine.floats()).max() * 1e-25, 0)


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_random_chains_agree_in_all_arithmetics(data):
    N = data.draw(st.integers(2, 9))
    seeds = tuple(sorted(data.draw(st.sets(st.integers(1, N - 1), min_size=1, max_size=min(3, N - 1)))))
    couplings = data.draw(st.sampled_from([{"alpha": "0.3"}, {"beta": "-0.2"}, {"alpha": "-1/3", "beta": "0.4"}, {"alpha": 1, "beta": 1}]))
    chain, order = Chain(N, **couplings), data.draw(st.integers(0, 3 if len(seeds) < 3 else 2))
    linear = chain.frequencies()
    shifts = data.draw(st.lists(st.integers(5, 60), min_size=len(seeds), max_size=len(seeds)))
    frequencies = [Fraction(round(linear[q - 1] * 1e6)) / 10**6 + Fraction(n, 1009) for q, n in zip(seeds, shifts, strict=True)]
    series = lindstedt(chain, seeds, order=order)
    try:
        theirs = lindstedt(chain, seeds, frequencies, order)
    except ResonantDivisor:
        with pytest.raises(ResonantDivisor):
            series.at(frequencies)
        return
    assume(not theirs.smallest_divisors or theirs.smallest_divisors[0].size > 1e-6)
    require_equal(series.at(frequencies), theirs)
    point = random_point(N, len(seeds), series.grading.degree, random.Random(N))
    try:
        residues = residue_series(chain, seeds, point, order)
    except VanishingResidue:
        return
    mine = coordinates_modulo(series, point)
    assert all((a == b).all() for a, b in zip(mine, residues.coordinates, strict=True))
    sampled = sample_series(series, [[float(w) for w in frequencies]] * 2)
    for k, table in enumerate(sampled.coordinates):
        expected = np.stack([series.at([Fraction(float(w)) for w in frequencies]).coordinates[k]] * 2, axis=-1)
        assert np.abs(table - expected).max(initial=0) <= COEFFICIENT * np.abs(expected).max(initial=0)


def test_other_couplings_of_the_same_model():
    series = lindstedt(Chain(7, alpha=1, beta=1), (2,), order=4)
    ours = series.at(("0.88",), alpha="0.5", beta="-0.25")
    require_equal(ours, lindstedt(Chain(7, alpha="0.5", beta="-0.25"), (2,), ("0.88",), 4))
    assert ours.chain == Chain(7, alpha="0.5", beta="-0.25")
    with pytest.raises(InputError, match="couplings of the same model, alpha"):
        lindstedt(ALPHA, (1,), order=2).at(("0.39",), beta=1)


def test_frequencies_that_make_a_multiplier_infinite_are_named():
    series = lindstedt(ALPHA, (1, 2), order=3)
    with pytest.raises(ResonantDivisor, match=r"omega_1\^2 - \(\+1 omega_1 -1 omega_2\)\^2 = 0 at order 1, mode 1, harmonic \(1, -1\)"):
        series.at(("0.39", "0.78"))
    with pytest.raises(ResonantDivisor, match=r"= 0 at order 1, mode [12], harmonic .*: the frequencies are commensurable"):
        series.at(("0.39", "0.78"), digits=20)
    with pytest.raises(ResonantDivisor, match=r"= 0 at order 1, mode [12], harmonic .*: the frequencies are commensurable"):
        sample_series(series, [[0.391, 0.77], [0.390625, 0.78125]])
    with pytest.raises(VanishingResidue):
        coordinates_modulo(series, ResiduePoint(97, pow(5, 3, 97), (1, 2)))


def test_series_without_a_program_are_refused():
    numeric = lindstedt(ALPHA, (1,), ("0.3905",), 3)
    for action in (lambda: numeric.at(("0.39",)), lambda: sample_series(numeric, [[0.39]]), lambda: numeric.term(2, 1, form="cse")):
        with pytest.raises(InputError, match="make it by lindstedt without frequencies"):
            action()


@pytest.mark.parametrize(
    ("frequencies", "relative", "message"),
    [
        ([0.39, 0.78], None, "a row for every point"),
        ([[0.39]], None, "a row for every point"),
        (np.zeros((0, 2)), None, "a row for every point"),
        ([[0.39, np.nan]], None, "positive finite numbers"),
        ([[0.39, -0.7]], None, "positive finite numbers"),
        ([[0.39, 0.77]], 0.5, "the chain has one coupling"),
    ],
)
def test_samples_of_other_shapes_are_refused(frequencies, relative, message):
    with pytest.raises(InputError, match=message):
        sample_series(lindstedt(ALPHA, (1, 2), order=2), frequencies, relative)


def test_samples_that_do_not_fit_are_refused(monkeypatch):
    series = lindstedt(ALPHA, (1, 2), order=3)
    monkeypatch.setattr("psutil.virtual_memory", lambda: type("Memory", (), {"available": 10**5}))
    with pytest.raises(InputError, match="take them in parts"):
        sample_series(series, np.full((1000, 2), 0.5))


SAMPLES = [
    (ALPHA, (1, 2), [0.391, 0.77], 5),
    (Chain(7, beta="-0.4"), (3,), [1.25], 4),
    (Chain(6, alpha="-0.3", beta="0.2"), (1, 4), [0.53, 1.75], 4),
    (Chain(2, beta=1), (1,), [1.5], 3),
]


@pytest.mark.parametrize(("chain", "seeds", "omega", "order"), SAMPLES, ids=str)
def test_derivatives_are_the_limits_of_differences(chain, seeds, omega, order):
    series = lindstedt(chain, seeds, order=order)
    step = 1e-6
    amplitudes = 0.2 + 0.1 * np.arange(len(seeds))
    here = sample_series(series, [omega])
    for j, q in enumerate(seeds):
        moved = np.array([omega, omega])
        moved[:, j] += np.array([step, -step])
        around = sample_series(series, moved)
        tables, corrections = here.derivatives_by_frequency(q)
        for exact, table in zip((*tables, *corrections), (*around.coordinates, *around.corrections), strict=True):
            difference = (table[..., 0] - table[..., 1]) / (2 * step)
            assert np.abs(exact[..., 0] - difference).max(initial=0) <= DIFFERENCE_OF_DOUBLES * np.abs(difference).max(initial=0)
        ours = here.frequencies_at(amplitudes)
        found = around.frequencies_at(amplitudes).omega
        slope = (found[0] - found[1]) / (2 * step)
        assert np.abs(ours.by_frequencies[0, :, j] - slope).max() <= DIFFERENCE_OF_DOUBLES * max(1, np.abs(slope).max())
        more, less = (here.frequencies_at(amplitudes + sign * step * np.eye(len(seeds))[j]).omega for sign in (1, -1))
        assert np.abs(ours.by_amplitudes[0, :, j] - (more - less)[0] / (2 * step)).max() <= DIFFERENCE_OF_DOUBLES


@pytest.mark.parametrize(("chain", "seeds", "omega", "order"), SAMPLES, ids=str)
def test_frequencies_of_a_sample_are_those_of_the_series(chain, seeds, omega, order):
    sampled = sample_series(lindstedt(chain, seeds, order=order), [omega, [1.001 * w for w in omega]])
    amplitudes = np.array([[0.2] * len(seeds), [0.3] * len(seeds)])
    found = sampled.frequencies_at(amplitudes)
    for i in range(2):
        chosen = [Fraction(float(w)) for w in sampled.frequencies[i]]
        series = lindstedt(chain, seeds, chosen, order)
        terms, slopes = series.frequency_terms(amplitudes[i] ** 2)
        assert np.abs(found.omega[i] - terms.sum(axis=0)).max() <= ROUNDING * 4
        assert np.abs(found.by_amplitudes[i] - slopes.sum(axis=0) * 2 * amplitudes[i]).max() <= COEFFICIENT
    with pytest.raises(InputError, match="pass one row for every point"):
        sampled.frequencies_at([0.1] * 3)
    with pytest.raises(InputError, match="only seeds have chosen frequencies"):
        sampled.derivatives_by_frequency(max(seeds) + 1)


@pytest.mark.long
@pytest.mark.parametrize("form", ["expanded", "factored", "cse"])
@pytest.mark.parametrize("ring", ["symbolic", "nested"])
def test_a_term_is_the_same_in_every_form(form, ring):
    series = lindstedt(Chain(9, alpha="0.5", beta=2), (1, 4), order=4, ring=ring)
    for q in range(1, 9):
        found = series.term(q, 4, form=form)
        whole = found.whole() if form == "cse" else found
        assert se.expand(whole - series.term(q, 4)) == 0
    assert "begin{aligned}" in series.term(5, 4, form="cse").latex()
    with pytest.raises(InputError, match="one of expanded, factored, cse"):
        series.term(5, 4, form="short")


def test_a_high_order_is_built_kept_and_named(tmp_path):
    """Expanded it would have 1e11 terms."""
    series = lindstedt(Chain(16, alpha="0.33"), (1, 2), order=10)
    back = load(save(tmp_path / "high", series))
    assert isinstance(back.coordinates[10], NodeTable)
    ours, theirs = back.at(("0.197", "0.391")), series.at(("0.197", "0.391"))
    assert all((a == b).all() for a, b in zip(ours.coordinates, theirs.coordinates, strict=True))
    assert len(back.term(3, 10, form="cse").names) > 100
