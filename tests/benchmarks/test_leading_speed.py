"""Speed of the Lemma: closed form and comparison with the recursion for all modes of D_1 .. D_4. Measured and printed, not asserted."""

import symfpu.proofs.leading
from symfpu import Chain, lemma_holds
from symfpu.proofs.leading import leading_terms

CHAIN, SEEDS, ORDER = Chain(N=32, alpha=1), (1, 2, 3, 4), 4


def forget():
    symfpu.proofs.leading._leading.cache_clear()


def test_closed_form(benchmark, record):
    terms = benchmark.pedantic(leading_terms, (CHAIN, SEEDS, ORDER), setup=forget, rounds=5)
    record("Lemma, N = 32, seeds 1..4, alpha, order 4: closed form", note=f"{len(terms)} modes")


def test_lemma(benchmark, record):
    holds = benchmark.pedantic(lemma_holds, (CHAIN, SEEDS, ORDER), setup=forget, rounds=3)
    assert holds == dict.fromkeys(range(5, 21), True)
    record("the same with the recursion and the comparison", note=f"{sum(holds.values())} of {len(holds)} modes identical")
