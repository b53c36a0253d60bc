"""Sweeps: complete, resumable, on any executor."""

from concurrent.futures import ThreadPoolExecutor
from itertools import combinations
from math import comb

import pytest

from symfpu.errors import InputError
from symfpu.proofs.sweeps import sweep_propagation
from symfpu.reports.sweep import sweep_markdown


@pytest.fixture(scope="module")
def threads():
    with ThreadPoolExecutor(2) as pool:
        yield pool


@pytest.fixture(scope="module")
def beta(threads):
    return sweep_propagation(range(2, 10), 3, 3, model="beta", executor=threads)


def predicted_exceptions(N, seeds):
    """Mode N - n for a third seed n beside a pair l + m = N, if no other route leads there at order 1."""
    from symfpu.chain.propagation import coupled_modes, reachable_modes

    return set(reachable_modes(N, seeds, 1, model="beta")[1]) - set(coupled_modes(N, seeds, 1, model="beta")[1]) - set(seeds)


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


def test_alpha_has_no_exception(threads):
    sweep = sweep_propagation(range(2, 9), 3, 5, executor=threads)
    assert sweep.exceptions == ()
    assert all(case.verdict == "proved" and case.corrected_rule_holds for case in sweep.cases)


def test_interrupted_sweep_goes_on_where_it_was(tmp_path, threads):
    file, calls = tmp_path / "sweep.jsonl", []
    whole = sweep_propagation(range(2, 7), 2, 2, model="beta", executor=threads, file=file)
    lines = file.read_text().splitlines(keepends=True)
    assert len(lines) == 1 + len(whole.cases)
    file.write_text("".join(lines[:9]) + lines[9][:20])  # cut in the middle of a line
    again = sweep_propagation(range(2, 7), 2, 2, model="beta", executor=threads, file=file, progress=lambda *a: calls.append(a))
    assert again == whole
    assert calls[0][0] > 8
    assert sorted(file.read_text().splitlines()) == sorted(line.rstrip("\n") for line in lines)


def test_file_of_another_sweep_is_refused(tmp_path, threads):
    file = tmp_path / "sweep.jsonl"
    sweep_propagation([4], 1, 1, executor=threads, file=file)
    with pytest.raises(InputError, match="another file"):
        sweep_propagation([4], 1, 2, executor=threads, file=file)
    file.write_text(file.read_text() + "{}\n")
    with pytest.raises(InputError, match="damaged"):
        sweep_propagation([4], 1, 1, executor=threads, file=file)
    with pytest.raises(InputError, match="file"):
        sweep_propagation([4], 1, 1, executor=threads, file=tmp_path / "none" / "sweep.jsonl")


def test_process_pool_by_default():
    assert len(sweep_propagation([4], 2, 2).cases) == len([s for n in (1, 2) for s in combinations(range(1, 4), n)])


@pytest.mark.filterwarnings("ignore")
def test_dask_executor_works_unchanged(beta):
    distributed = pytest.importorskip("distributed", reason="the optional extra 'dask' is not installed")
    local = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**local) as cluster, distributed.Client(cluster) as client:
        sweep = sweep_propagation(range(2, 6), 3, 3, model="beta", executor=client.get_executor())
    assert sweep.cases == tuple(case for case in beta.cases if case.N < 6)


def test_summary_counts_what_the_sweep_holds(beta):
    text = sweep_markdown(beta)
    assert f"{len(beta.cases)} seed sets" in text
    assert text.count(" -> ") == 1 + sum(len(case.exceptions) for case in beta.cases)


@pytest.mark.parametrize("text", ["precious data without newline", "line one\nprecious tail"])
def test_foreign_file_is_left_as_it_is(tmp_path, threads, text):
    file = tmp_path / "notes.txt"
    file.write_text(text)
    with pytest.raises(InputError, match="another file"):
        sweep_propagation([4], 1, 1, executor=threads, file=file)
    assert file.read_text() == text
