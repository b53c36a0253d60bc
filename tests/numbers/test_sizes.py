"""Sizes are bounded at the door: what would not end, or not fit into memory, is refused before it begins."""

from decimal import Decimal
from functools import cache
from itertools import product

import mpmath
import numpy as np
import pytest
import symengine as se
import sympy
from sympy.polys.matrices import DomainMatrix

import symfpu
from symfpu import Chain, InputError, frequency_rank, group_energy, integrate, lindstedt, series_bytes
from symfpu.chain.powers import Powers
from symfpu.chain.propagation import _orders
from tests.every_result import two_angles

ALPHA, TODA = Chain(8, alpha="0.3"), Chain(8, potential="toda:1/2")
OPEN = Chain("N", alpha=1)
OMEGA = ("0.39", "0.77")
AT_REST = np.zeros(7)
X = se.Symbol("x")

ORDERS = {
    "lindstedt": lambda k: lindstedt(ALPHA, (1, 2), OMEGA, k),
    "lindstedt, toda": lambda k: lindstedt(TODA, (1, 2), OMEGA, k),
    "lindstedt, universal": lambda k: lindstedt(ALPHA, (1, 2), order=k),
    "lindstedt, every N": lambda k: lindstedt(OPEN, (1, 2), order=k),
    "lindstedt, digits": lambda k: lindstedt(ALPHA, (1, 2), OMEGA, k, digits=30),
    "lemma_holds": lambda k: symfpu.lemma_holds(ALPHA, (1, 2), k),
    "prove_propagation": lambda k: symfpu.prove_propagation(8, (1, 2), k),
    "prove_propagation, toda": lambda k: symfpu.prove_propagation(8, (1, 2), k, potential="toda:1/2"),
    "torus of an energy": lambda k: symfpu.torus(ALPHA, (1, 2), energy="0.01", method="series", order=k),
    "torus of amplitudes": lambda k: symfpu.torus(ALPHA, (1,), amplitudes={1: "0.1"}, method="series", order=k),
    "coupling_sequence": lambda k: symfpu.coupling_sequence(8, (1, 2), k, potential="toda:1/2"),
}
SETS = {
    "series_bytes": lambda k: series_bytes(ALPHA, (1, 2), k),
    "excitation_sequence": lambda k: symfpu.excitation_sequence(8, (1, 2), k),
}


@pytest.mark.parametrize("name", [*ORDERS, *SETS])
@pytest.mark.parametrize("order", [10**9, 2**31, 10**400], ids=["1e9", "2^31", "1e400"])
def test_an_absurd_order_is_refused_with_the_range(name, order):
    with pytest.raises(InputError, match=r"order.*an integer from"):
        (ORDERS | SETS)[name](order)


@pytest.mark.parametrize("name", ORDERS)
def test_the_highest_order_that_fits_is_named(name):
    with pytest.raises(InputError, match=r"take order [1-9][0-9]* or less"):
        ORDERS[name](10_000)


def test_the_order_named_fits_and_the_next_does_not():
    with pytest.raises(symfpu.TooLarge) as caught:
        lindstedt(ALPHA, (1, 2), OMEGA, 10_000)
    largest, free = caught.value.largest, caught.value.free
    assert series_bytes(ALPHA, (1, 2), largest) <= free < series_bytes(ALPHA, (1, 2), largest + 1)


LENGTHS = {
    "Chain": lambda N: Chain(N, beta=1),
    "frequency_rank": frequency_rank,
    "excitation_sequence": lambda N: symfpu.excitation_sequence(N, (1, 2), 3),
    "coupling_sequence": lambda N: symfpu.coupling_sequence(N, (1, 2), 3),
    "prove_propagation": lambda N: symfpu.prove_propagation(N, (1, 2), 3),
    "sweep_propagation": lambda N: symfpu.sweep_propagation((N,), 1, 1),
}


@pytest.mark.parametrize("name", LENGTHS)
@pytest.mark.parametrize("N", [10**9, 10**25, 10**5000], ids=["1e9", "1e25", "1e5000"])
def test_an_absurd_length_is_refused_with_the_range(name, N):
    with pytest.raises(InputError, match=r"N = .*(an integer from 2 to 1000000|to 2\^63 - 1)"):
        LENGTHS[name](N)


def test_a_sweep_of_more_cases_than_fit_names_the_longest_chain():
    with pytest.raises(InputError, match="take lengths up to 391"):
        symfpu.sweep_propagation(range(2, 2000), 2, 2)


def test_sets_larger_than_the_chain_cost_nothing():
    with pytest.raises(InputError, match="executor"):
        symfpu.sweep_propagation((2, 3, 4), 10**9, 1, executor=object())


NAMES = {"a null byte": "\x00", "no letter of any name": "\ud800"}
OF_FILES = {
    "load": symfpu.load,
    "save": lambda name: symfpu.save(name, small_orbit()),
    "read_sweep": symfpu.read_sweep,
    "write": lambda name: symfpu.prove_propagation(4, (1,), 1).write(name),
    "family": lambda name: symfpu.family(ALPHA, (1,), "0.0002", members=4, folder=name),
}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("door", OF_FILES)
def test_what_is_no_name_of_a_file_is_refused(door, name):
    with pytest.raises(InputError, match=r"the name of a file|a folder that can be written"):
        OF_FILES[door](NAMES[name])


def rank_of_the_matrix(N):
    """Rows of integers by powers of a root of unity, modulo its cyclotomic polynomial."""
    x = sympy.Symbol("x")
    modulus = sympy.Poly(sympy.cyclotomic_poly(4 * N, x), x, domain=sympy.QQ)
    rows = []
    for q in range(1, N):
        rest = sympy.Poly.from_dict({(q,): 1, (4 * N - q,): -1}, x, domain=sympy.QQ).rem(modulus)
        rows.append([sympy.QQ(int(rest.nth(k))) for k in range(modulus.degree())])
    return DomainMatrix(rows, (N - 1, modulus.degree()), sympy.QQ).rank()


def test_the_rank_in_closed_form_is_that_of_the_matrix():
    lengths = [*range(2, 17), 18, 20, 21, 24, 25, 30, 32]
    assert [frequency_rank(N) for N in lengths] == [rank_of_the_matrix(N) for N in lengths]
    assert frequency_rank(10**6) == 800_000


@pytest.mark.parametrize(("step", "acting"), list(product((1, 2), [{1}, {1, 2}, {2, 5}, set(range(1, 12))])))
def test_products_of_sets_are_counted_before_they_are_made(step, acting, monkeypatch):
    powers, order = Powers(step, acting.__contains__), 9
    count = sum(1 for k in range(1, order + 1) for added in acting if added <= k for _ in _orders(k - added, powers.factors(added)))
    count_products(powers, order, count, monkeypatch)
    with pytest.raises(InputError, match="take order 8 or less"):
        count_products(powers, order, count - 1, monkeypatch)


def count_products(powers, order, most, monkeypatch):
    from symfpu.chain import propagation

    monkeypatch.setattr(propagation, "MOST_PRODUCTS", most)
    propagation._check_products(powers, order)


def orbit():
    return integrate(ALPHA, [0.1] * 7, AT_REST, 200, step=0.2)


def ring_wave():
    return symfpu.torus(Chain(8, beta=1, ends="periodic"), (1,), amplitudes={1: "0.1"})


def ring_series():
    return symfpu.lindstedt(Chain(8, beta=1, ends="periodic"), (1,), ("0.766",), 3)


@cache
def small_orbit():
    return symfpu.torus(ALPHA, (1,), amplitudes={1: "0.1"})


@cache
def small_family():
    return symfpu.family(ALPHA, (1,), "0.0002", members=4)


REFUSED = {
    "a seed before the energy": (lambda: symfpu.torus(ALPHA, (8,), energy="1e-400"), "seeds = 8"),
    "an energy below all doubles": (lambda: symfpu.torus(ALPHA, (1,), energy="1e-400"), "energy.*1e-50 to 1e50"),
    "an energy above them": (lambda: symfpu.torus(ALPHA, (1,), energy="1e400"), "energy.*1e-50 to 1e50"),
    "an amplitude": (lambda: symfpu.torus(ALPHA, (1,), amplitudes={1: "1e400"}), "amplitude"),
    "a frequency": (lambda: symfpu.torus(ALPHA, (1,), frequencies=("1e400",)), "frequencies, omega_1.*1e-6 to 1e6"),
    "a breather of a long chain": (lambda: symfpu.torus(Chain(100_000, beta=1), (1,), energy="0.1"), "N = 100000.*take [1-9]"),
    "resonances": (
        lambda: symfpu.normal_modes(symfpu.torus(ALPHA, (1,), amplitudes={1: "0.1"}), resonance_length=2**31),
        "resonance_length.*take [0-9]+ or less",
    ),
    "a shift": (lambda: symfpu.frequency_shift(ALPHA, {1: 1e300}), "A_1.*up to 1e\\+25"),
    "a start": (lambda: integrate(ALPHA, [10**400] + [0] * 6, AT_REST, 1.0, step=0.1), "Q = "),
    "samples": (lambda: integrate(ALPHA, AT_REST + 0.1, AT_REST, 1e12, step=0.1, samples=10**12), "samples.*free memory"),
    "a time": (lambda: symfpu.alignment_indices(ALPHA, AT_REST + 0.1, AT_REST, 10**400), "T = "),
    "a long stay": (lambda: symfpu.prove_stay(two_angles(), time=10**400), "time.*1e-100 to 1e100"),
    "a short stay": (lambda: symfpu.prove_stay(two_angles(), time="1e-400"), "time.*1e-100 to 1e100"),
    "digits": (lambda: symfpu.birkhoff_form(ALPHA, (1,), 2, digits=2**64), "digits"),
    "a degree": (lambda: symfpu.birkhoff_form(OPEN, (1, 2), 4), "degree = 4.*products of divisors"),
    "a degree of an even potential": (lambda: symfpu.birkhoff_form(Chain("N", beta=1), (1, 2), 4), "degree = 4.*products of divisors"),
    "sets of a long chain": (lambda: symfpu.reachable_modes(10**6, (3, 5), 10_000), "order = 10000.*take order [1-9][0-9]* or less"),
    "rows of two lengths": (lambda: symfpu.read_sweep([[1, 2], [3]]), "file = "),
    "windows": (lambda: symfpu.frequency_analysis(orbit(), windows=1000), "windows = 1000.*samples of the orbit"),
    "no times": (lambda: symfpu.foretold_indices(two_angles(), ()), "ascending times"),
    "frequencies as text": (lambda: symfpu.sample_series(lindstedt(ALPHA, (1,), order=1), ("2/5",)), "frequencies"),
    "half of a formula": (lambda: symfpu.collect_terms("x+", ["x"]), "expression = 'x\\+'"),
    "a high power": (lambda: symfpu.collect_terms((X + 1) ** 100_000, [X]), "terms when expanded"),
    "points": (lambda: symfpu.prove_propagation(8, (1, 4), 2, points=10**9), "points = .*from 0 to 1000"),
    "a tolerance": (
        lambda: symfpu.refine(ring_wave(), energy=symfpu.Energy("0.01", harmonic=True), tolerance=mpmath.mpf("1e-400")),
        "tolerance.*between 0 and 1",
    ),
    "complex coordinates": (lambda: ALPHA.stretches(np.ones(7, dtype=complex)), "Q = .*an array of real numbers"),
    "complex times": (
        lambda: two_angles().Q(np.ones(3, dtype=complex)),
        "t = .*allowed is .*(an array of them|array of finite numbers)",
    ),
    "complex times of a ring": (
        lambda: ring_wave().Q(np.ones(3, dtype=complex)),
        "t = .*allowed is .*(an array of them|array of finite numbers)",
    ),
    "an energy of a map": (lambda: symfpu.frequency_map(ALPHA, ["1e400"], T=100, step=0.1), "energies = '1e400'.*1e-50 to 1e50"),
    "an energy of a torus": (lambda: symfpu.refine(ring_wave(), energy=symfpu.Energy("1e400", harmonic=True)), "energy.*1e-50 to 1e50"),
    "a degree of shifts": (lambda: ALPHA.shift_degrees(10**400), "highest"),
    "a power of forces": (lambda: ALPHA.relative_couplings(2**63), "highest"),
    "a number of bonds": (lambda: Chain(np.zeros(0), alpha=1), "N = array"),
    "a wide interval": (lambda: symfpu.prove_existence(small_orbit(), half_width="1e1000"), "half_width.*from 0 to 1"),
    "an energy beyond doubles": (lambda: symfpu.prove_existence(small_orbit(), energy="1e400"), "energy.*1e-50 to 1e50"),
    "a guess": (lambda: symfpu.pade_amplitudes(lindstedt(ALPHA, (1,), ("0.39",), 4, digits=30), {1: 1e300}), "guess.*up to 1e\\+25"),
    "squares of no seed": (lambda: ring_series().frequency_terms(np.zeros((3, 7))), "squared_amplitudes = \\(3, 7\\)"),
    "a member": (lambda: symfpu.member_at_frequency(small_family(), 1, Decimal("1e1000")), "frequency"),
    "draws": (lambda: symfpu.atlas([ALPHA], [(1, 2)], 4, draws=object()), "draws"),
    "progress": (lambda: lindstedt(ALPHA, (1, 2), OMEGA, 4, progress=object), "progress.*a function of 2 arguments"),
    "complex energies": (lambda: symfpu.recurrence([0.0, 1.0], np.ones(2, dtype=complex)), "energies"),
    "no group": (lambda: group_energy(ALPHA, 3, 0.01, [None]), "k = "),
    "a group before the first": (lambda: group_energy(ALPHA, 3, 0.01, [-1]), "k = .*0 or more"),
    "a group beyond doubles": (lambda: group_energy(ALPHA, 3, 1e300, [1000]), "k = .*doubles"),
    "a law beyond its series": (lambda: symfpu.breather_law(Chain(32, alpha="0.33"), 0.077), "gamma = 2.82"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_number_of_the_right_type_and_wrong_size_is_named(name):
    call, reason = REFUSED[name]
    with pytest.raises(InputError, match=reason):
        call()
