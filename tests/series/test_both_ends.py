"""What every series says of itself, whatever the ends of its chain: coefficients, sums, frequencies, table, file."""

import numpy as np
import pytest

from symfpu import Chain, InputError, export, lindstedt, load, sample_series, save, series_bytes
from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.waves import WaveModes
from tests.store.test_saved_file import same
from tests.tolerances import COEFFICIENT, ROUNDING, WAVE_SLOPE, WAVE_SLOPE_ROUNDING

LAWS = ({"alpha": "0.3"}, {"beta": "-0.2"}, {"potential": "toda:1/2"})
SEEDS = {"fixed": ((1, 3), ("0.3905", "1.1123")), "periodic": ((-3, 1), ("1.8486", "0.7661"))}
AMPLITUDES = (0.31, 0.17)


@pytest.fixture(params=[(ends, law) for ends in SEEDS for law in range(len(LAWS))], ids=str)
def series(request):
    ends, law = request.param
    chain = Chain(8, **LAWS[law], ends=ends)
    seeds, frequencies = SEEDS[ends]
    return lindstedt(chain, seeds, frequencies, 4)


def test_seeds_alone_move_at_order_zero_each_with_its_amplitude(series):
    harmonics, values = series.harmonic_terms(AMPLITUDES, 0)
    assert np.abs(harmonics).sum(axis=1).tolist() == [1, 1]
    for i, q in enumerate(series.seeds):
        row = np.flatnonzero(harmonics[:, i])[0]
        own = np.zeros(series.space.columns)
        own[series.space.column(q, 1)[0]] = AMPLITUDES[i]
        assert np.allclose(values[row], own, rtol=0, atol=ROUNDING)


def test_sums_over_coefficients_are_the_terms_at_amplitudes(series):
    """Of every mode, at angles that no symmetry has."""
    angles, mu = np.array([0.4, 1.7]), series.chain.mu
    z = np.array(AMPLITUDES) / 2 * np.exp(1j * angles)
    for order in range(series.order + 1):
        harmonics, values = series.harmonic_terms(AMPLITUDES, order)
        whole = (values * np.cos(harmonics @ angles)[:, None]).sum()
        total = 0.0
        for q in series.chain.mode_numbers:
            exponents, coefficients = series.coefficients(q, order)
            monomials = np.prod(z ** exponents[:, 0::2] * z.conj() ** exponents[:, 1::2], axis=1)
            pairs = np.where((exponents[:, 0::2] != exponents[:, 1::2]).any(axis=1), 2, 1)
            total += (coefficients * pairs * monomials.real).sum()
        assert mu**order * total == pytest.approx(whole, abs=COEFFICIENT * max(np.abs(values).sum(), ROUNDING))


def test_polynomials_of_the_frequencies_are_their_terms(series):
    squares = np.square(AMPLITUDES)
    terms, slopes = series.frequency_terms(squares)
    for order in range(series.order + 1):
        for i, q in enumerate(series.seeds):
            exponents, values = series.frequency_coefficients(q, order)
            monomials = values * np.prod(np.array(AMPLITUDES) ** exponents, axis=1)
            assert series.chain.mu**order * monomials.sum() == pytest.approx(terms[order, i], abs=COEFFICIENT)
    step = 1e-6
    for j in range(2):
        shifted = squares + step * np.eye(2)[j]
        change = series.frequency_terms(shifted)[0] - series.frequency_terms(2 * squares - shifted)[0]
        assert np.allclose(change / (2 * step), slopes[:, :, j], rtol=WAVE_SLOPE, atol=WAVE_SLOPE_ROUNDING)


def test_moduli_of_a_mode_are_no_less_than_its_sum(series):
    q = series.seeds[0]
    first, second = series.absolute_sums(q, AMPLITUDES, with_mu=True)
    assert first.shape == second.shape == (series.order + 1,)
    assert (first >= second * (1 - ROUNDING)).all()
    assert second[0] == pytest.approx(abs(AMPLITUDES[0]))


def test_the_table_has_every_coefficient(series):
    table = series.to_frame()
    assert set(table.quantity) == {"coordinate", "frequency"}
    for order in range(series.order + 1):
        rows = table[(table.quantity == "coordinate") & (table.order == order)]
        count = sum(len(series.coefficients(q, order)[1]) for q in series.chain.mode_numbers)
        assert len(rows) == count
    first = table[(table.quantity == "coordinate") & (table.order == 0)]
    assert first["mode"].tolist() == sorted(series.seeds)
    assert np.allclose(first.value, 1, rtol=ROUNDING)


def test_it_comes_back_from_a_file(series, tmp_path):
    assert same(load(save(tmp_path / "series", series)), series)


def test_modes_that_it_does_not_have(series):
    for q in (0, 9, -8, "1"):
        with pytest.raises(InputError, match=r"^q = "):
            series.coefficients(q, 1)


@pytest.mark.parametrize("kind", [CosineModes, WaveModes])
def test_the_gauge_is_the_own_harmonic_of_each_seed_in_its_mode(kind):
    seeds = (1, 3) if kind is CosineModes else (2, -2)
    space = kind(9, seeds, Grading(2, 5))
    harmonics = np.concatenate([space.grading.harmonics(degree)[0] for degree in range(1, 6)])
    found = space.gauge(harmonics)
    for nu, row in zip(harmonics.tolist(), found, strict=True):
        own = [i for i in range(2) if [abs(n) for n in nu] == [int(j == i) for j in range(2)]]
        expected = np.zeros(space.columns, dtype=bool)
        for i in own:
            expected[space.seed_columns[i]] = True
        assert np.array_equal(row, expected)


def test_what_the_waves_of_a_ring_do_not_have_is_refused_with_what_helps(tmp_path):
    ring = lindstedt(Chain(8, alpha="0.3", ends="periodic"), (1,), ("0.766",), 3)
    with pytest.raises(InputError, match=r"coefficients\(q, order\)"):
        ring.term(1, 1)
    for function in (lambda x: sample_series(x, [[0.766]]), lambda x: export(x, "c", tmp_path / "a.c")):
        with pytest.raises(InputError, match="solve_amplitudes"):
            function(ring)
    with pytest.raises(InputError, match="near the linear ones"):
        lindstedt(ring.chain, (1,), order=2)
    with pytest.raises(InputError, match="standing waves have digits"):
        lindstedt(ring.chain, (1,), ("0.766",), 2, digits=30)


def test_a_long_ring_needs_no_more_than_a_short_one():
    bytes_of = [series_bytes(Chain(N, beta=1, ends="periodic"), (1, -2), 4) for N in (8, 1000)]
    assert bytes_of[0] == bytes_of[1] < series_bytes(Chain(1000, beta=1), (1, 2), 4)
