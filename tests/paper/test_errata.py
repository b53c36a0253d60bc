"""The entries of docs/errata.md, one test each."""

from functools import cache

import numpy as np
import pytest

from symfpu.chain.chain import Chain
from symfpu.paper.printed import APPENDIX_F, FIG1_AMPLITUDE_ORDER, TWO_TORUS
from symfpu.paper.table import amplitude_row, energies, rounds_to
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import amplitude_history, solve_amplitudes
from tests.tolerances import ONE_PLACE, PERIODIC_ORBIT, STATED_LEAST, STATED_MOST, TWO_DIGITS


@cache
def row(label):
    """Of the paper's table, computed once."""
    return amplitude_row(next(printed for printed in (TWO_TORUS, *APPENDIX_F) if printed.label == label))


def test_quartic_coupling_needs_minus_2N():
    """At N = 4 the sum 1 - 3 - 3 - 3 = -2N occurs; C without it is not the bond sum of the Hamiltonian."""
    chain, modes = Chain(N=4, beta=1), (1, 3, 3, 3)
    bonds = (2 * np.arange(chain.N) + 1) * np.pi / (2 * chain.N)
    bond_sum = 8 / chain.N * np.prod([np.cos(q * bonds) for q in modes], axis=0).sum()
    sums = [1 + a * 3 + b * 3 + c * 3 for a in (1, -1) for b in (1, -1) for c in (1, -1)]
    printed = sum((total == 0) - (total == 2 * chain.N) for total in sums)
    assert chain.C(*modes) == round(bond_sum)
    assert printed != round(bond_sum)


@pytest.mark.parametrize(("couplings", "step"), [({"alpha": 1}, 1), ({"beta": 1}, 2)])
def test_degree_of_frequency_corrections(couplings, step):
    series = lindstedt(Chain(N=8, **couplings), (1, 3), ("0.4", "1.12"), 4)
    for k in range(1, 5):
        exponents, _ = series.frequency_coefficients(1, k)
        assert (exponents.sum(axis=1) == step * k).all()
        assert len(exponents) > 0 or (step == 1 and k % 2 == 1)


def test_average_energy_needs_one_half():
    """Averaged with the factor 1/2, the modes share the energy H up to the anharmonic part; without it, twice that."""
    series = lindstedt(Chain(N=8, alpha="0.1"), (1,), ("0.3902",), 6)
    torus = solve_amplitudes(series)
    assert torus.average_spectrum().sum() / torus.energy() == pytest.approx(1, abs=ONE_PLACE)


ORDERS = {"Fig. 2": 4, "Fig. 5a": 6, "Fig. 5b": 6, "Fig. 5d": 4, "Fig. 9": 242}
SLOW = ("Fig. 2", "Fig. 5a", "Fig. 5d", "Fig. 9")


@pytest.mark.parametrize("label", [pytest.param(label, marks=[pytest.mark.long] * (label in SLOW)) for label in ORDERS])
def test_appendix_f_is_met_at_these_frequency_orders(label):
    assert row(label).met == (ORDERS[label],)
    assert row(label).digits[ORDERS[label]] >= 10


@pytest.mark.long
def test_middle_modes_are_met_to_nine_digits():
    assert row("Fig. 5c").best == 6
    assert row("Fig. 5c").digits[6] == pytest.approx(9, abs=ONE_PLACE)


@pytest.mark.parametrize(("label", "true", "ratio"), [("Fig. 7", 0.1857360295755, 2.7e-5), ("Fig. 8", 0.05121215917411, 4.0e-5)])
def test_two_breathers_are_not_met(label, true, ratio):
    found = row(label)
    assert found.met == ()
    last = found.history.amplitudes[max(found.history.amplitudes)][0]
    assert last == pytest.approx(true, rel=PERIODIC_ORBIT)
    assert float(found.printed.amplitudes[0]) / last - 1 == pytest.approx(ratio, rel=TWO_DIGITS)
    assert "met at no frequency order" in found.verdict


@pytest.mark.long
@pytest.mark.parametrize("label", ["Fig. 2", pytest.param("Fig. 9", marks=pytest.mark.long)])
def test_two_energies_are_harmonic(label):
    assert row(label).energy_matches == ("harmonic energy at t = 0",)


@pytest.mark.long
def test_energy_of_example_4():
    assert row("Fig. 5d").energy_matches == ()
    assert row("Fig. 5d").energy_orders == {"harmonic energy, time average": (2, 3)}


@pytest.mark.long
def test_energy_of_figure_1():
    assert row("Fig. 1").energy_matches == ()
    assert row("Fig. 1").energy_orders["H(0)"] == (8, 10, 12, 16, 18, 20)


@pytest.fixture(scope="module")
def two_torus():
    return lindstedt(TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, TWO_TORUS.order)


def test_figure_1c_shows_mu_to_the_k(two_torus):
    amplitudes = amplitude_history(two_torus).amplitudes[FIG1_AMPLITUDE_ORDER]
    bare, folded = (two_torus.absolute_sums(1, amplitudes, with_mu=flag) for flag in (False, True))
    assert bare[1][14] > 1e11
    assert STATED_LEAST < folded[1][14] < STATED_MOST
    assert np.log10(folded[0][14] / folded[1][14]) == pytest.approx(3.7, abs=ONE_PLACE)


def test_energy_error_of_figure_1(two_torus):
    times = np.linspace(0, 1000, 501)
    errors = {
        k: np.abs(solve_amplitudes(two_torus, frequency_order=FIG1_AMPLITUDE_ORDER, order=k).energy_error(times)).max() for k in (12, 24)
    }
    assert errors[12] < 3e-4
    assert errors[24] > 1e-3


@pytest.mark.long
def test_energies_are_three_numbers():
    values = energies(row("Fig. 2").torus)
    assert len({f"{v:.6g}" for v in values.values()}) == 3
    assert [rounds_to(v, "0.000182466") for v in values.values()] == [False, True, False]
