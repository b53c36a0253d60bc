"""Universal series as programs: nodes, products, seconds and bytes; expansion beside FLINT's and SymEngine's."""

import flint
import numpy as np
import pytest
import symengine as se

from symfpu import Chain, lindstedt, load, sample_series, save
from symfpu.algebra.expansion import Expansion
from symfpu.algebra.formulas import expression_of_leaf
from symfpu.algebra.program_values import terms_of
from tests.benchmarks.history import seconds

CASES = [
    (Chain(16, alpha=1), (1, 2), 6),
    (Chain(16, alpha=1), (1, 2), 12),
    (Chain(16, beta=1), (1, 2), 6),
    (Chain(16, alpha=1, beta="1/2"), (1, 2), 8),
    (Chain(32, alpha=1), (1, 2, 3, 4), 6),
]


@pytest.mark.parametrize("case", CASES, ids=str)
def test_building(benchmark, record, case):
    chain, seeds, order = case
    series = benchmark.pedantic(lindstedt, (chain, seeds, None, order), rounds=3, iterations=1, warmup_rounds=1)
    program = series.node_tables()[0].program
    terms = program.terms
    size = sum(part.nbytes for part in terms) + program.start.nbytes
    record(f"{chain}, seeds {seeds}, order {order}", note=f"{program.size:,} nodes, {len(terms.left):,} products, {size / 1e6:.1f} MB")


def wanted_nodes(series):
    tables = [table.nodes[table.nonzero] for table in series.node_tables()]
    return np.concatenate(tables)


@pytest.mark.parametrize("order", [5, 6, 7])
def test_expansion(benchmark, record, order):
    series = lindstedt(Chain(16, alpha=1), (1, 2), order=order)
    program, wanted = series.node_tables()[0].program, wanted_nodes(series)
    expansion = benchmark.pedantic(Expansion, (program, wanted), rounds=2, iterations=1, warmup_rounds=1)
    terms = sum(len(expansion.polynomial(int(node)).coefficients) for node in wanted)
    predicted = expansion.size
    record(f"order {order}", note=f"{terms:,} terms, at most {predicted.terms:,.0f} predicted, {predicted.bytes / 1e6:.0f} MB at most")


@pytest.mark.parametrize("order", [4, 5])
def test_expansion_by_flint_and_symengine(benchmark, record, order):
    """The same polynomials, node after node, by FLINT's sparse polynomials and by SymEngine's expand."""
    series = lindstedt(Chain(16, alpha=1), (1, 2), order=order)
    program, wanted = series.node_tables()[0].program, wanted_nodes(series)
    needed = Expansion(program, wanted).needed.tolist()
    names = [f"s{i}" for i in range(len(program.symbols))]
    context = flint.fmpz_mpoly_ctx.get(names, flint.Ordering.lex)

    def made(one, leaves, finish):
        values = {0: one, **dict(zip(program.leaves, leaves, strict=True))}
        for node in needed:
            if node not in values:
                values[node] = finish(sum((f * values[a] * values[b] for a, b, f in terms_of(program, node)), 0 * one))
        return values

    def by_flint():
        return made(context.constant(1), context.gens(), lambda value: value)

    def by_symengine():
        return made(se.Integer(1), [expression_of_leaf(s) for s in program.symbols], se.expand)

    Expansion(program, wanted)
    ours, theirs = seconds(lambda: Expansion(program, wanted)), seconds(by_symengine)
    benchmark.pedantic(by_flint, rounds=1, iterations=1)
    flint_seconds = benchmark.stats.stats.median
    record(f"order {order} by FLINT", note=f"{flint_seconds / ours:.1f} times ours ({ours:.3f} s); SymEngine {theirs / ours:.1f} times")


def test_a_thousand_sets(benchmark, record):
    series = lindstedt(Chain(16, alpha=1), (1, 2), order=8)
    frequencies = series.chain.frequencies()[:2] * (1 + 1e-3 * np.random.default_rng(1).random((1000, 2)))
    sampled = benchmark.pedantic(sample_series, (series, frequencies), rounds=3, iterations=1, warmup_rounds=1)
    terms = len(series.node_tables()[0].program.terms.left)
    left, right = np.random.default_rng(2).random((2, 1500, 1500))
    flops = 2 * 1500**3 / seconds(lambda: left @ right)
    rate = 3 * terms * 1000 / benchmark.stats.stats.median
    record("1000 sets, order 8", note=f"{terms:,} products each, {rate / 1e9:.2f} GFlop/s, {rate / flops:.1%} of a matrix product")
    more = seconds(lambda: sampled.frequencies_at([0.3, 0.2]))
    record("with derivatives by frequencies and amplitudes", note=f"{more:.2f} s more")


def test_loading(benchmark, record, tmp_path):
    building = seconds(lambda: lindstedt(Chain(16, alpha=1), (1, 2), order=12))
    path = save(tmp_path / "series", lindstedt(Chain(16, alpha=1), (1, 2), order=12))
    benchmark.pedantic(load, (path,), rounds=3, iterations=1, warmup_rounds=1)
    ratio = benchmark.stats.stats.median / building
    record("order 12 from its file", note=f"{path.stat().st_size / 1e6:.1f} MB, {ratio:.2f} of the time to build it")
