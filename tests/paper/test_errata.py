"""The entries of docs/errata.md, one test each, and its tables of verdicts, which are held to what the targets compute."""

import importlib.util
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import sympy

from symfpu import Chain, ResonantDivisor, amplitude_history, excitation_sequence, lindstedt, reachable_modes, solve_amplitudes
from symfpu.paper.printed import APPENDIX_F, FIG1_AMPLITUDE_ORDER, TWO_TORUS
from symfpu.paper.table import amplitude_row, energies, rounds_to
from symfpu.paper.targets import TARGETS
from tests.paper.cases import unheard
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


def test_frequencies_may_be_resonant_though_each_is_incommensurable():
    """No frequency is a rational multiple of another or of an Omega_q; a divisor of order 1 is zero."""
    chain, seeds = Chain(N=6, alpha=1), (1, 3)
    chosen = (sympy.sqrt(5) / 4, 1 + sympy.sqrt(5) / 4)
    linear = {q: 2 * sympy.sin(sympy.pi * q / (2 * chain.N)) for q in chain.mode_numbers}
    ratios = [omega / Omega for omega in chosen for Omega in linear.values()] + [chosen[1] / chosen[0]]
    assert all(sympy.degree(sympy.minimal_polynomial(ratio)) > 1 for ratio in ratios)
    assert linear[2] ** 2 - (chosen[0] - chosen[1]) ** 2 == 0
    term = lindstedt(chain, seeds, order=1).term(q=2, order=1)
    assert "L_{2}(1,-1)" in {str(symbol) for symbol in term.free_symbols}
    with pytest.raises(ResonantDivisor) as found:
        lindstedt(chain, seeds, ("0.559", "1.559"), order=1)
    assert (found.value.mode, found.value.harmonic, found.value.order) == (2, (1, -1), 1)


def sets_as_printed(N, seeds, order, step):
    """M_k of Eq. app, from every signed sum of r seeds."""
    r = step * order + 1
    sums = {abs(sum(chosen)) for chosen in product([sign * q for q in seeds for sign in (1, -1)], repeat=r)}
    return {abs(2 * ((total + N - 1) // (2 * N)) * N - total) for total in sums}


@pytest.mark.parametrize(("model", "step"), [("alpha", 1), ("beta", 2)])
@pytest.mark.parametrize("N", [4, 7, 8])
def test_the_formula_of_the_sets_gives_zero_and_N(N, model, step):
    found = set()
    for seeds in [(q,) for q in range(1, N)] + [(1, N - 1), (1, 2)]:
        for k, modes in enumerate(reachable_modes(N, seeds, 2, model=model)):
            printed = sets_as_printed(N, seeds, k, step)
            assert printed - {0, N} == set(modes)
            assert 0 in printed or model == "beta" or k % 2 == 0
            found |= printed - set(modes)
    assert found == {0, N}


LONGEST = 25  # powers of two to 16, and multiples of three
BREATHERS = [(N, q) for N in range(2, LONGEST) for q in range(1, N)]


def exponent_of_two(n):
    """v2(n), the largest v with 2^v a factor of n."""
    return (n & -n).bit_length() - 1


def test_doubled_orders_of_breathers_are_a_matter_of_powers_of_two():
    """To the order where multiples of q return to q, beyond which neither model has a new mode."""
    for N, q in BREATHERS:
        last = N // 2 + 1
        alpha = excitation_sequence(N, (q,), 2 * last)
        beta = excitation_sequence(N, (q,), last, model="beta")
        holds = exponent_of_two(q) <= exponent_of_two(N) or 3 * q == 2 * N
        assert (alpha[::2] == beta) == holds, (N, q)
    assert excitation_sequence(7, (2,), 2) == [(2,), (4,), (6,)]
    assert excitation_sequence(7, (2,), 2, model="beta") == [(2,), (6,), (4,)]


def test_an_odd_seed_of_alpha_excites_even_modes_but_for_the_middle():
    odd = [(N, q) for N, q in BREATHERS if q % 2]
    without = [(N, q) for N, q in odd if not any(m % 2 == 0 for modes in excitation_sequence(N, (q,), N) for m in modes)]
    assert without == [(N, N // 2) for N in range(2, LONGEST, 4)]


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
@pytest.mark.parametrize("label", ["Fig. 2", "Fig. 9"])
def test_two_energies_are_harmonic(label):
    assert row(label).energy_matches == ("harmonic energy at t = 0",)


@pytest.mark.long
@pytest.mark.parametrize(
    ("label", "energy", "orders"),
    [("Fig. 5d", "harmonic energy, time average", (2, 3)), ("Fig. 1", "H(0)", (8, 10, 12, 16, 18, 20))],
)
def test_two_energies_are_of_shorter_series(label, energy, orders):
    assert row(label).energy_matches == ()
    assert row(label).energy_orders[energy] == orders


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


PAGE = Path(__file__).parents[2] / "docs" / "errata.md"


def loaded():
    spec = importlib.util.spec_from_file_location("make_verdicts", PAGE.parent / "make_verdicts.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


verdicts = loaded()


def test_every_target_with_claims_has_a_table():
    assert set(verdicts.TARGETS.values()) == TARGETS.keys() - {"toda"}
    headings = PAGE.read_text().split("## Claims of sections")[1].split("\n### ")[1:]
    assert [part.splitlines()[0] for part in headings] == list(verdicts.TARGETS)


@pytest.mark.long
@pytest.mark.parametrize("target", ["section5", "fig6"])
def test_cells_are_what_the_target_computes(target, tmp_path):
    """Two targets of seconds, whose evidence is of whole numbers or rounded far above rounding; the others by `make verdicts`."""
    figure = TARGETS[target](tmp_path, unheard)
    record = {target: {"claims": [claim.record() for claim in figure.claims]}}
    assert verdicts.with_verdicts(PAGE.read_text(), record) == PAGE.read_text()
