"""Sums and chains of couplings: Theorems 7 to 10 of docs/propagation.md, on seed sets drawn at random."""

import random
from collections import Counter
from itertools import combinations_with_replacement

import numpy as np
import pytest

from symfpu import excitation_sequence
from symfpu.proofs.certificates import random_point
from symfpu.proofs.flats import degree_of
from symfpu.proofs.plus_terms import MINUS, PLUS, PlusResidues, PlusTerms, powers_of_degree
from symfpu.proofs.seed_sums import CHAINS, chained_modes, modes_of_one_parity, without_odd_sums


def orders_of(sequence):
    return {q: k for k, modes in enumerate(sequence) for q in modes}


def seed_sets(number, longest, largest):
    """Half of them with a pair l, N - l, of which exceptions are made."""
    source = random.Random(18)
    for i in range(number):
        N = source.randrange(4, longest)
        seeds = set(source.sample(range(1, N), source.randint(1, min(largest, N - 1))))
        if i % 2:
            seeds.add(N - min(seeds))
        yield N, tuple(sorted(seeds))


def orders_by_chains(N, model, seeds, last):
    """Where chains of couplings lead, these being sums of cosines over the ring of 2N bonds."""
    waves = np.cos(np.pi * np.outer(np.arange(1, N), np.arange(2 * N) + 0.5) / N)
    known, members = dict.fromkeys(seeds, 0), set(seeds)
    for k in range(1, last + 1):
        factors = combinations_with_replacement(seeds, 1 if model == "alpha" else 2)
        driven = [np.prod(waves[[m - 1, *(n - 1 for n in f)]], axis=0) for f in factors for m in members]
        # of four cosines one that is left gives 2N/8
        sizes = np.abs(np.array(driven).reshape(-1, 2 * N) @ waves.T)
        members = {int(q) + 1 for q in np.flatnonzero((sizes > N / 8).any(axis=0))} - known.keys()
        known |= dict.fromkeys(members, k)
    return known


@pytest.mark.parametrize(("model", "last", "late"), [("alpha", 4, set()), ("beta", 3, {(1, 2)})])
def test_chains_reach_every_mode_at_its_order(model, last, late):
    # Theorems 9 and 10: no exception in alpha; in beta those of D_1 alone, which enter at order 2
    differing = Counter()
    for N, seeds in seed_sets(150, 24, 5):
        rule = orders_of(excitation_sequence(N, seeds, last, model=model))
        reached = orders_by_chains(N, model, seeds, last)
        assert reached.keys() == rule.keys()
        differing.update((k, reached[q]) for q, k in rule.items() if reached[q] != k)
    assert set(differing) == late


@pytest.mark.parametrize("model", ["alpha", "beta"])
def test_chained_modes_have_terms_at_the_frequencies_of_the_chain(model):
    # Theorem 8, true Omega: some residue is not zero at one random point; a zero has odds of 1 in 10^4 at most
    last, shown = CHAINS[model], 0
    for N, seeds in seed_sets(24 if model == "alpha" else 60, 12, 3):
        rule = orders_of(excitation_sequence(N, seeds, last, model=model))
        terms = PlusTerms(N, model, seeds)
        residues = PlusResidues(terms, random_point(N, len(seeds), degree_of(model, last), random.Random(N)))
        chained = chained_modes(N, model, seeds, rule, ())
        for q in chained:
            powers = powers_of_degree(len(seeds), degree_of(model, rule[q]))
            assert any(residues.values(p).get(q) for p in powers), (N, seeds, q)
        shown += len(chained)
    assert shown > 50


@pytest.mark.parametrize("model", ["alpha", "beta"])
def test_sums_of_one_parity_make_products_of_one_sign(model):
    # Theorem 7 against the products themselves, which know nothing of it
    last = 3 if model == "alpha" else 2
    plain = mixed = 0
    for N, seeds in seed_sets(120, 14, 3):
        rule = orders_of(excitation_sequence(N, seeds, last, model=model))
        found = modes_of_one_parity(N, model, seeds, rule)
        terms = PlusTerms(N, model, seeds)
        for q in found:
            powers = powers_of_degree(len(seeds), degree_of(model, rule[q]))
            assert any(terms.signs(p).get(q) in (PLUS, MINUS) for p in powers), (N, seeds, q)
        excited = {q for q, k in rule.items() if k}
        if without_odd_sums(model, last, np.array([seeds]), np.array([N]))[0]:
            assert found == excited, (N, seeds)
            plain += 1
        mixed += found < excited
    assert plain > 2
    assert mixed > 2


def test_a_chain_needs_a_coupling():
    # N = 6, seeds 2, 3: C_4332 = 0, so that no chain leads to mode 4 at order 1 (docs/propagation.md)
    assert chained_modes(6, "beta", (2, 3), {1: 1, 4: 1, 5: 1}, ()) == {1, 5}
    assert chained_modes(6, "beta", (2, 3), {1: 1, 5: 1, 4: 2}, ()) == {1, 4, 5}
    assert chained_modes(6, "beta", (2, 3), {1: 9, 5: 9, 4: 2}, ()) == set()


def test_odd_sums_are_found():
    seeds, N = np.array([[1, 2], [1, 3], [2, 4]]), np.array([9, 6, 6])
    # order 2 of alpha: sums of one or two seeds that are 9, 6: 3 + 3 and 2 + 4
    assert without_odd_sums("alpha", 2, seeds, N).tolist() == [True, False, False]
