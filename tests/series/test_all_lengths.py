"""One universal series for every N: the same program as that of each chain, node by node; and no numbers without N."""

import copy
import inspect
import pickle
from functools import cache, partial

import numpy as np
import pytest

import symfpu
from symfpu import Chain, InputError, lindstedt
from symfpu.chain.length import HighMode, SymbolicLength, mode_label, mode_of
from symfpu.series.all_lengths import reach

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


@pytest.mark.parametrize("seeds", [(1, 2), (1, "N-1")], ids=str)
def test_one_program_serves_two_short_chains(seeds):
    assert longest_order("alpha", seeds, 9) > 1
    assert differences("alpha", seeds, (8, 9)) == []


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
ONES, ROWS = np.ones(3), np.ones((3, 3))
METHODS = ("B", "C", "accelerations", "energy", "equations_of_motion", "frequencies", "hamiltonian", "harmonic_energies")
METHODS += ("linear_frequency", "modes", "positions", "small_parameter", "stretches")
# by the name of a parameter
GIVEN = {
    **dict.fromkeys(("Q", "P", "x", "displacements", "momenta", "spectrum"), ONES),
    **dict.fromkeys(("spectra", "averages"), ROWS),
    **dict.fromkeys(("times", "specific_energies"), (0.1, 0.2, 0.3)),
    **dict.fromkeys(("energy", "to_energy", "specific_energy", "amplitude", "frequency", "step"), 0.1),
    **dict.fromkeys(("k", "l", "m", "n", "q", "seed"), 1),
    **dict.fromkeys(("mode", "order", "s"), 2),
    "T": 1e3,
    "amplitudes": {1: 0.1},
    "energies": (0.1, 0.2),
    "groups": [(1,), (2,)],
    "seeds": (1,),
}
# functions of a chain that answer without N, or have something else to say first
ANSWERED = {
    "asymptotic_energy",
    "asymptotic_group_energy",
    "frequency_expansion",
    "frequency_shift_formula",
    "asymptotic_profile",
    "birkhoff_form",
    "lindstedt",
    "read_state",  # says first whether there is a file
    "profile_invariance",
}


def of_a_chain(name):
    """Whether a public function has a chain as its first argument."""
    function = getattr(symfpu, name)
    return inspect.isfunction(function) and next(iter(inspect.signature(function).parameters), "") == "chain"


def called(function):
    """With values for the parameters that have no default."""
    needed = [p.name for p in inspect.signature(function).parameters.values() if p.default is p.empty and p.name != "chain"]
    chain = Chain("N", potential="toda:1/2") if function.__name__.startswith("toda") else SYMBOLIC
    first = [] if inspect.ismethod(function) else [chain]
    return function(*first, **{name: GIVEN[name] for name in needed})


PUBLIC = {name: partial(called, getattr(symfpu, name)) for name in symfpu.__all__ if name not in ANSWERED and of_a_chain(name)}
PUBLIC |= {name: partial(called, getattr(SYMBOLIC, name)) for name in METHODS}
PUBLIC |= {
    "coupled": lambda: list(SYMBOLIC.coupled(1, 1)),
    "export": lambda: symfpu.export(SERIES, "c", "there"),
    "lindstedt, digits": lambda: lindstedt(SYMBOLIC, (1,), order=2, digits=20),
    "lindstedt, frequencies": lambda: lindstedt(SYMBOLIC, (1,), ("0.39",), 2),
    "lindstedt, ring": lambda: lindstedt(SYMBOLIC, (1,), order=2, ring="float64"),
    "mu": lambda: SYMBOLIC.mu,
    "prove_propagation": lambda: symfpu.prove_propagation(SYMBOLIC.N, (1,), 2),
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
