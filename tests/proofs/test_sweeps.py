"""Sweeps: complete, resumable, on any executor."""

import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor
from itertools import combinations
from math import comb

import pytest

from symfpu import SweepIncomplete, TooLarge, sweep_propagation
from symfpu.proofs import sweeps
from symfpu.proofs.sweeps import sweep_markdown


@pytest.fixture(scope="module")
def beta(threads):
    return sweep_propagation(range(2, 10), 3, 3, model="beta", executor=threads)


def predicted_exceptions(N, seeds):
    """Mode N - n for a third seed n beside a pair l + m = N, if no other route leads there at order 1."""
    from symfpu import reachable_modes
    from symfpu.chain.propagation import coupled_modes

    return set(reachable_modes(N, seeds, 1, model="beta")[1]) - set(coupled_modes(N, seeds, 1, model="beta")[1]) - set(seeds)


@pytest.mark.long
def test_every_seed_set_is_there_once(beta):
    assert len(beta.cases) == sum(comb(N - 1, s) for N in range(2, 10) for s in (1, 2, 3))
    assert len({(case.N, case.seeds) for case in beta.cases}) == len(beta.cases)


def test_exceptions_are_pairs_with_sum_N_and_a_third_seed(beta):
    """What the exceptions have in common: the exceptional mode is N - n for a seed n, and two other seeds (or one, twice)
    have the sum N. And the corrected rule is right in every case."""
    assert all(case.corrected_rule_holds for case in beta.cases)
    assert len(beta.exceptions) > 10
    for case in beta.cases:
        modes = {q for q, _, _ in case.exceptions}
        assert modes == predicted_exceptions(case.N, case.seeds)
        for q, predicted, actual in case.exceptions:
            n = case.N - q
            assert (predicted, actual) == (1, 2)
            assert n in case.seeds
            assert any(l + m == case.N for l in case.seeds for m in case.seeds if n not in (l, m))


@pytest.mark.long
def test_alpha_has_no_exception(threads):
    sweep = sweep_propagation(range(2, 9), 3, 5, executor=threads)
    assert sweep.exceptions == ()
    assert all(case.verdict == "proved" and case.corrected_rule_holds for case in sweep.cases)


def test_summary_counts_what_the_sweep_holds(beta):
    text = sweep_markdown(beta)
    assert f"{len(beta.cases)} seed sets" in text
    assert text.count(" -> ") == 1 + sum(len(case.exceptions) for case in beta.cases)


HARD = {(4, (1, 3)), (5, (2,))}  # seed sets that fail in the tests below


def fails(N, seeds, *arguments, prove=sweeps.prove_propagation, **options):
    if (N, seeds) in HARD:
        raise TooLarge(2, 10**12, 10**9, 1)
    return prove(N, seeds, *arguments, **options)


def dies(N, seeds, *arguments, prove=sweeps.prove_propagation, **options):
    return os._exit(1) if (N, seeds) == (8, (1,)) else prove(N, seeds, *arguments, **options)


def prove_by(function):
    """In a worker of a pool: every case is decided by this function."""
    sweeps.prove_propagation = function


def workers_that(function):
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(1, context, initializer=prove_by, initargs=(function,))


@pytest.mark.long
def test_a_case_that_fails_in_a_worker_costs_no_other(tmp_path, threads):
    file, calls = tmp_path / "sweep.jsonl", []
    with workers_that(fails) as pool, pytest.raises(SweepIncomplete) as caught:
        sweep_propagation(range(2, 6), 2, 1, executor=pool, file=file, progress=lambda label, fraction: calls.append(fraction))
    whole, error = sweep_propagation(range(2, 6), 2, 1, executor=threads), caught.value
    assert error.sweep.cases == tuple(case for case in whole.cases if (case.N, case.seeds) not in HARD)
    assert set(error.failures) == HARD
    assert [(e.kind, e.numbers["largest"]) for e in error.failures.values()] == [("TooLarge", 1)] * 2
    first = "2 seed sets were not decided, the first N = 4, seeds (1, 3) (TooLarge: order = 2: "
    assert str(error).startswith(first)
    assert "18 others" in str(error)
    assert calls[-1] == 1
    assert len(file.read_text().splitlines()) == 1 + 20
    assert sweep_propagation(range(2, 6), 2, 1, executor=threads, file=file) == whole


@pytest.mark.long
def test_workers_that_die_cost_only_what_they_had_not_decided(tmp_path):
    file = tmp_path / "sweep.jsonl"
    message = "SweepStopped: the executor broke down"
    with workers_that(dies) as pool, pytest.raises(SweepIncomplete, match=message) as caught:
        sweep_propagation(range(2, 9), 2, 0, executor=pool, file=file)
    kept, failures = {(case.N, case.seeds) for case in caught.value.sweep.cases}, caught.value.failures
    everything = {(N, seeds) for N in range(2, 9) for s in (1, 2) for seeds in combinations(range(1, N), s)}
    assert kept | set(failures) == everything
    assert not kept & set(failures)
    assert {(2, (1,)), (8, (1,))} & kept == {(2, (1,))}
    assert {failure.kind for failure in failures.values()} == {"SweepStopped"}
    assert len(file.read_text().splitlines()) == 1 + len(kept)
