"""One universal series for every N: the same program as that of each chain, node by node; and no numbers without N."""

import copy
import inspect
import pickle
from functools import cache

import numpy as np
import pytest
import symengine as se

import symfpu
from symfpu.algebra.formulas import Multiplier
from symfpu.chain.chain import Chain
from symfpu.chain.length import HighMode, SymbolicLength, mode_label, mode_of
from symfpu.errors import InputError
from symfpu.series.all_lengths import reach
from symfpu.series.lindstedt import lindstedt

LONGEST, HIGHEST_ORDER = 40, 5
COUPLINGS = {"alpha": {"alpha": 1}, "beta": {"beta": 1}, "both": {"alpha": "1/2", "beta": "1/3"}}
LOW = [(1,), (2,), (1, 2), (1, 3), (2, 3)]
HIGH = [("N-1",), ("N-2", "N-1"), ("N-3",), (1, "N-1"), (2, "N-1"), (1, "N-2", "N-1")]


@cache
def for_all(model, seeds, order):
    return lindstedt(Chain("N", **COUPLINGS[model]), seeds, order=order)


@cache
def for_one(model, seeds, order, N):
    modes = tuple(mode_of(mode_label(q, "seeds"), N) for q in seeds)
    return lindstedt(Chain(N, **COUPLINGS[model]), modes, order=order)


def same_nodes(a, b):
    """Seeds, symbols, graph and tables of two series are the same arrays."""
    first, second = (series.coordinates[0].program for series in (a, b))
    arrays = [(first.start, second.start), *zip(first.terms, second.terms, strict=True)]
    for name in ("coordinates", "corrections"):
        tables = zip(getattr(a, name)[1:], getattr(b, name)[1:], strict=True)
        arrays += [(x.nodes, y.nodes) for x, y in tables]
    arrays.append((a.coordinates[0].nodes, b.coordinates[0].nodes))
    return a.seeds == b.seeds and first.symbols == second.symbols and all(np.array_equal(x, y) for x, y in arrays)


def longest_order(model, seeds, N):
    """The last order at which the series for all N claims to be that of N, none for -1."""
    valid = [k for k in range(HIGHEST_ORDER + 1) if for_all(model, seeds, k).valid_from <= N]
    return max(valid, default=-1)


def differences(model, seeds, lengths):
    """The lengths at which the series for all N, at the longest order that holds there, is not that of the chain."""
    wrong = []
    for N in lengths:
        order = longest_order(model, seeds, N)
        if order >= 0 and not same_nodes(for_all(model, seeds, order).at_length(N), for_one(model, seeds, order, N)):
            wrong.append(N)
    return wrong


@pytest.mark.long
@pytest.mark.parametrize("model", COUPLINGS)
@pytest.mark.parametrize("seeds", [(1,), (1, 2), ("N-2", "N-1"), (1, "N-1")], ids=str)
def test_one_program_serves_every_chain(model, seeds):
    assert differences(model, seeds, (*range(3, 15), LONGEST)) == []


@pytest.mark.long
@pytest.mark.parametrize("model", COUPLINGS)
@pytest.mark.parametrize("seeds", LOW + HIGH, ids=str)
def test_one_program_serves_every_chain_to_forty_bonds(model, seeds):
    assert longest_order(model, seeds, LONGEST) >= (2 if len(seeds) == 3 else 3)
    assert differences(model, seeds, range(2, LONGEST + 1)) == []


@pytest.mark.parametrize("model", COUPLINGS)
@pytest.mark.parametrize("seeds", LOW + HIGH[:-1], ids=str)
def test_a_shorter_series_is_the_beginning_of_a_longer_one(model, seeds):
    """So that a comparison at the longest order speaks for all orders below."""
    short, long = (for_all(model, seeds, k) for k in (2, 3))
    size = short.coordinates[0].program.size
    names = [[repr(s) for s in series.coordinates[0].program.symbols] for series in (short, long)]
    assert names[1][: len(names[0])] == names[0]
    assert np.array_equal(long.coordinates[0].program.start[: size + 1], short.coordinates[0].program.start)
    for k in range(1, 3):
        assert np.array_equal(long.corrections[k].nodes, short.corrections[k].nodes)
        columns = [series._mode(q) - 1 for series in (short, long) for q in short.modes]
        first, second = np.array(columns).reshape(2, -1)
        assert np.array_equal(long.coordinates[k].nodes[:, second], short.coordinates[k].nodes[:, first])


@pytest.mark.parametrize("model", COUPLINGS)
@pytest.mark.parametrize("seeds", LOW, ids=str)
@pytest.mark.parametrize("order", [1, 2, 3])
def test_the_bound_is_sharp_for_low_seeds(model, seeds, order):
    """One bond less, and the highest wave number is N: no mode, where there was a term."""
    series = for_all(model, seeds, order)
    N = series.valid_from - 1
    assert max(seeds) * series.degree(order) == N
    present = series.coordinates[order].nonzero
    shorter = for_one(model, seeds, order, N).coordinates[order].nonzero
    assert present[:, -1].any()
    assert shorter.sum() < present.sum()
    with pytest.raises(InputError, match=f"from {N + 1} up"):
        series.at_length(N)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize("seeds", LOW + HIGH, ids=str)
def test_reach_is_that_of_all_signed_sums(seeds, step, order):
    """By enumeration in a long chain: modes near the start are low, those near the end high."""
    N = 1000
    modes = [mode_of(mode_label(q, "seeds"), N) for q in seeds]
    sums, low, high = set(modes), 0, 0
    for degree in range(1, 2 + step * order):
        if (degree - 1) % step == 0:
            folded = {min(m % (2 * N), -m % (2 * N)) for m in sums} - {0, N}
            low = max([low, *(q for q in folded if q < N // 2)])
            high = max([high, *(N - q for q in folded if q > N // 2)])
        sums = {m + sign * q for m in sums for q in modes for sign in (1, -1)}
    assert reach(step, [mode_label(q, "seeds") for q in seeds], order) == (low, high)


def test_terms_of_all_lengths_are_those_of_one_under_other_names():
    series, single = for_all("alpha", (1, "N-1"), 3), for_one("alpha", (1, "N-1"), 3, 12)
    names = {se.Symbol(f"{x}_{{N-1}}"): se.Symbol(f"{x}11") for x in ("A", "theta")}
    for q in series.modes:
        names[se.Symbol(f"Omega_{q}" if q > 0 else f"Omega_{{{q}}}")] = se.Symbol(f"Omega_{mode_of(q, 12)}")
    for symbol in series.coordinates[0].program.symbols:
        if isinstance(symbol, Multiplier):
            tail = f"({','.join(map(str, symbol.harmonic))})"
            names[se.Symbol(f"L_{{{symbol.mode}}}{tail}")] = se.Symbol(f"L_{{{mode_of(symbol.mode, 12)}}}{tail}")
    excited = 0
    for k in range(4):
        for q in series.modes:
            term = series.term(q, k)
            excited += term != 0
            assert se.expand(term.subs(names) - single.term(mode_of(q, 12), k)) == 0
    assert excited > 10
    for q in series.seeds:
        corrections = series.frequency_correction(q, 2), single.frequency_correction(mode_of(q, 12), 2)
        assert se.expand(corrections[0].subs(names) - corrections[1]) == 0
    assert str(series.frequency_correction("N-1", 2)) == str(series.frequency_correction(series.seeds[1], 2))


def test_the_nested_form_is_the_same_polynomial():
    nested = lindstedt(Chain("N", alpha=1), (1, 2), order=3, ring="nested")
    assert se.expand(nested.term(5, 3) - for_all("alpha", (1, 2), 3).term(5, 3)) == 0
    assert nested.at_length(20).ring == "nested"


def test_the_name_says_from_where_it_holds():
    assert repr(for_all("alpha", (1, "N-1"), 2)).endswith("(symbolic), for N >= 7)")
    assert for_all("alpha", (1, "N-1"), 2).modes == (1, 2, 3, HighMode(-3), HighMode(-2), HighMode(-1))


SYMBOLIC = Chain("N", alpha="1/4")


def test_a_symbolic_length_is_a_value():
    assert SYMBOLIC == Chain("N", alpha="1/4") != Chain("N", alpha=1)
    assert hash(SYMBOLIC) == hash(Chain("N", alpha="1/4"))
    assert pickle.loads(pickle.dumps(SYMBOLIC)) == copy.deepcopy(SYMBOLIC) == SYMBOLIC
    assert SYMBOLIC.at(N=8) == Chain(8, alpha="1/4")
    assert SYMBOLIC.at(beta=1) == Chain("N", alpha="1/4", beta=1)
    assert eval(repr(SYMBOLIC)) == SYMBOLIC
    assert f"{SYMBOLIC.N}" == "N"
    assert SymbolicLength() == SYMBOLIC.N
    assert SYMBOLIC.N not in (8, "N")


SERIES = lindstedt(SYMBOLIC, (1,), order=2)
ONES = np.ones(3)
PUBLIC = {
    "accelerations": lambda: SYMBOLIC.accelerations(ONES),
    "alignment_indices": lambda: symfpu.alignment_indices(SYMBOLIC, ONES, ONES, T=1.0, frames=1),
    "B": lambda: SYMBOLIC.B(1, 1, 2),
    "normal_frequency_series": lambda: symfpu.normal_frequency_series(SYMBOLIC, (1,), 2, 2),
    "breather_at_amplitude": lambda: symfpu.breather_at_amplitude(SYMBOLIC, 1, 0.1),
    "breather_at_energy": lambda: symfpu.breather_at_energy(SYMBOLIC, 1, 0.1),
    "breather_law": lambda: symfpu.breather_law(SYMBOLIC, 0.1),
    "C": lambda: SYMBOLIC.C(1, 1, 1, 1),
    "coupled": lambda: list(SYMBOLIC.coupled(1, 1)),
    "energy": lambda: SYMBOLIC.energy(ONES, ONES),
    "equations_of_motion": lambda: SYMBOLIC.equations_of_motion(),
    "export": lambda: symfpu.export(SERIES, "c", "there"),
    "family": lambda: symfpu.family(SYMBOLIC, (1,), 0.1),
    "fit_profile": lambda: symfpu.fit_profile(SYMBOLIC, ONES, 1),
    "fpu_trajectory": lambda: symfpu.fpu_trajectory(SYMBOLIC, {1: 0.1}),
    "frequencies": lambda: SYMBOLIC.frequencies(),
    "frequency_shift": lambda: symfpu.frequency_shift(SYMBOLIC, {1: 0.1}),
    "group_energy": lambda: symfpu.group_energy(SYMBOLIC, 1, 0.1, 1),
    "growth_exponents": lambda: symfpu.growth_exponents(SYMBOLIC, [1.0, 2.0, 3.0], np.ones((3, 3)), [(1,), (2,)]),
    "hamiltonian": lambda: SYMBOLIC.hamiltonian(),
    "harmonic_energies": lambda: SYMBOLIC.harmonic_energies(ONES, ONES),
    "integrate": lambda: symfpu.integrate(SYMBOLIC, ONES, ONES, T=1.0, step=0.1),
    "leading_term": lambda: symfpu.leading_term(SYMBOLIC, (1,), 2),
    "least_packet": lambda: symfpu.least_packet(SYMBOLIC, 0.1),
    "lemma_holds": lambda: symfpu.lemma_holds(SYMBOLIC, (1,), 2),
    "lindstedt, digits": lambda: lindstedt(SYMBOLIC, (1,), order=2, digits=20),
    "lindstedt, frequencies": lambda: lindstedt(SYMBOLIC, (1,), ("0.39",), 2),
    "lindstedt, ring": lambda: lindstedt(SYMBOLIC, (1,), order=2, ring="float64"),
    "linear_frequency": lambda: SYMBOLIC.linear_frequency(1),
    "middle_modes": lambda: symfpu.middle_modes(SYMBOLIC, 2),
    "modes": lambda: SYMBOLIC.modes(ONES),
    "mu": lambda: SYMBOLIC.mu,
    "natural_packet": lambda: symfpu.natural_packet(SYMBOLIC, 0.1),
    "packet_amplitudes": lambda: symfpu.packet_amplitudes(SYMBOLIC, (1, 2), 0.1),
    "packet_groups": lambda: symfpu.packet_groups(SYMBOLIC, 2),
    "packet_energies": lambda: symfpu.packet_energies(SYMBOLIC, 2, 0.1),
    "packet_parameter": lambda: symfpu.packet_parameter(SYMBOLIC, 2, 0.1),
    "periodic_orbit": lambda: symfpu.periodic_orbit(SYMBOLIC, 1, "0.4"),
    "positions": lambda: SYMBOLIC.positions(ONES),
    "profile_law": lambda: symfpu.profile_law(SYMBOLIC, 2, 0.1),
    "prove_propagation": lambda: symfpu.prove_propagation(SYMBOLIC.N, (1,), 2),
    "rounding_floor": lambda: symfpu.rounding_floor(SYMBOLIC, ONES, 1e3, step=0.1),
    "seconds_needed": lambda: symfpu.seconds_needed(SYMBOLIC, 1.0),
    "shoot": lambda: symfpu.shoot(SYMBOLIC, 1, "0.4"),
    "slope_by_energy": lambda: symfpu.slope_by_energy(SYMBOLIC, 2, [0.1, 0.2, 0.3], np.ones((3, 3))),
    "small_parameter": lambda: SYMBOLIC.small_parameter(),
    "frequency_map": lambda: symfpu.frequency_map(SYMBOLIC, (0.1, 0.2)),
    "series_bytes": lambda: symfpu.series_bytes(SYMBOLIC, (1,), 2),
    "stretches": lambda: SYMBOLIC.stretches(ONES),
    "twist_at_rest": lambda: symfpu.twist_at_rest(SYMBOLIC, (1,)),
    "packet_state": lambda: symfpu.packet_state(SYMBOLIC, (1,), 0.1),
    "particle_state": lambda: symfpu.particle_state(SYMBOLIC, ONES, ONES),
    "random_state": lambda: symfpu.random_state(SYMBOLIC, 0.1, 1),
    "toda_gaps": lambda: symfpu.toda_gaps(Chain("N", potential="toda:1/2"), ONES, ONES),
    "toda_invariants": lambda: symfpu.toda_invariants(Chain("N", potential="toda:1/2"), ONES, ONES),
    "toda_torus": lambda: symfpu.toda_torus(Chain("N", potential="toda:1/2"), (1,), actions=(0.1,)),
    "torus_at_amplitudes": lambda: symfpu.torus_at_amplitudes(SYMBOLIC, {1: 0.1}, order=2),
    "torus_at_energy": lambda: symfpu.torus_at_energy(SYMBOLIC, (1,), 0.1, harmonic=True, order=2),
    "absolute_sums": lambda: SERIES.absolute_sums(1, [0.1]),
    "amplitude_history": lambda: symfpu.amplitude_history(SERIES),
    "amplitude_terms": lambda: SERIES.amplitude_terms(1),
    "frequency_terms": lambda: SERIES.frequency_terms([0.1]),
    "harmonic_terms": lambda: SERIES.harmonic_terms([0.1], 1),
    "seed_factors": lambda: SERIES.seed_factors,
}


@pytest.mark.parametrize("name", PUBLIC)
def test_what_needs_a_number_says_so(name, tmp_path, monkeypatch):
    """InputError with the next step, never a TypeError from inside."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=r"put a number for N: chain.at\(N=32\)"):
        PUBLIC[name]()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("solve", [symfpu.solve_amplitudes, lambda series: symfpu.pade_amplitudes(series, {1: 0.1})])
def test_a_series_without_frequencies_has_no_amplitudes(solve):
    """They ask for frequencies first, which ask for N."""
    with pytest.raises(InputError, match="give frequencies="):
        solve(SERIES)


def test_every_function_of_a_chain_is_on_the_list():
    """Public functions whose first argument is a chain, but those that answer without N."""
    answered = {
        "asymptotic_energy",
        "asymptotic_group_energy",
        "frequency_expansion",
        "frequency_shift_formula",
        "asymptotic_profile",
        "birkhoff_form",
        "lindstedt",
        "read_state",  # says first whether there is a file
        "travelling_breather",  # of a ring, whose length is a number
        "profile_invariance",
        "travelling_waves",  # of a ring, whose length is a number
    }
    takes = set()
    for name in symfpu.__all__:
        function = getattr(symfpu, name)
        if inspect.isfunction(function) and next(iter(inspect.signature(function).parameters), "") == "chain":
            takes.add(name)
    assert takes - answered <= PUBLIC.keys()


WRONG_SEEDS = [(), (1, 1), ("N-1", "N-1"), ("N",), ("N+1",), ("N-0",), (0,), (-1,), (1.5,), (True,), "N-1", 3, None]


@pytest.mark.parametrize("seeds", WRONG_SEEDS, ids=str)
def test_wrong_seeds_are_refused(seeds):
    with pytest.raises(InputError) as refused:
        lindstedt(SYMBOLIC, seeds, order=1)
    assert refused.value.argument == "seeds"


@pytest.mark.parametrize("q", [4, "N-1", "x", 0, None], ids=str)
def test_modes_that_the_series_does_not_reach_are_refused(q):
    with pytest.raises(InputError):
        SERIES.term(q, 2)


@pytest.mark.parametrize("N", ["M", "n", "", None, 1.5, "32"], ids=str)
def test_other_lengths_are_refused(N):
    with pytest.raises(InputError, match="allowed is an integer"):
        Chain(N, alpha=1)
