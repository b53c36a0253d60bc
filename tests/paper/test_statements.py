"""The paper's discrete statements, each an exact test: section 5's examples, section 6's sequences and patterns."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
import symengine as se
from sympy import isprime

from symfpu import excitation_sequence, frequency_rank, profile_law, prove_propagation, reachable_modes
from symfpu.paper import breather_claims, statements
from symfpu.paper.claims import FAILS, HOLDS, PARTLY
from symfpu.paper.printed import EXCITATIONS
from tests.paper.cases import unheard


def span(first, last):
    return tuple(range(first, last + 1))


@pytest.mark.parametrize(("N", "s"), [(32, 4), (100, 2), (101, 3), (200, 6)])
def test_high_packets(N, s):
    """Example iv: the alpha rule as printed; in beta D_k = {N-(2k+1)s .. N-(2k-1)s-1}, not the printed N-(k+1)s .. N-(k-1)s-1."""
    seeds = span(N - s, N - 1)
    alpha, beta = excitation_sequence(N, seeds, 6), excitation_sequence(N, seeds, 3, model="beta")
    for k in range(1, min(7, (N - 1) // (2 * s) - 1)):
        low, high = span((k - 1) * s + 1, (k + 1) * s), span(N - (k + 1) * s, N - (k - 1) * s - 1)
        assert alpha[k] == (low if k % 2 else high)
    for k in range(1, min(4, ((N - 1) // (2 * s) - 1) // 2 + 1)):
        assert beta[k] == span(N - (2 * k + 1) * s, N - (2 * k - 1) * s - 1) == alpha[2 * k]
        assert beta[k] != span(N - (k + 1) * s, N - (k - 1) * s - 1)


def test_general_packet_rules_fail_for_one_seed():
    """One seed excites one mode an order: {1} in beta gives {3}, not {2, 3}; {N-1} in alpha gives {2}, not {1, 2}."""
    assert excitation_sequence(100, (1,), 1, model="beta")[1] == (3,)
    assert excitation_sequence(100, (99,), 1)[1] == (2,)


@pytest.mark.parametrize("N", [6, 12, 30])
def test_discrete_symmetry_solutions(N):
    """Example v: nothing but the seed is ever excited. By Eq. dk the later D_k are empty, not D_0 as printed."""
    for model, q in (("alpha", N // 2), ("alpha", 2 * N // 3), ("beta", N // 2), ("beta", 2 * N // 3), ("beta", N // 3)):
        assert excitation_sequence(N, (q,), 8, model=model) == [(q,)] + [()] * 8
        assert prove_propagation(N, (q,), 3, model=model).verdict == "proved"
    assert excitation_sequence(N, (N // 3,), 1)[1] == (2 * N // 3,)


@pytest.mark.parametrize("N", [8, 9, 12])
def test_relation_between_the_models(N):
    """M_2k of alpha is M_k of beta; D_k of beta is D_2k of alpha where M_(2k-1) and M_2k of alpha are disjoint."""
    both = 0
    for s in (1, 2):
        for seeds in combinations(range(1, N), s):
            M = reachable_modes(N, seeds, 6)
            assert M[::2] == reachable_modes(N, seeds, 3, model="beta")
            alpha, beta = excitation_sequence(N, seeds, 6), excitation_sequence(N, seeds, 3, model="beta")
            for k in range(1, 4):
                if not set(M[2 * k - 1]) & set(M[2 * k]):
                    both += 1
                    assert beta[k] == alpha[2 * k]
    assert both > 0


@pytest.mark.parametrize("example", EXCITATIONS, ids=lambda e: e.label)
def test_printed_sequences(example):
    """Section 6: examples 1 to 4 and the q_0 = 25 breather, with the misprint of example 4 corrected in the data."""
    sequence = excitation_sequence(example.N, example.seeds, len(example.sets))
    assert tuple(sequence[1:]) == example.sets


def test_printed_third_set_of_example_4_repeats_the_first():
    """Printed {56 .. 72}, of which 60 .. 68 were excited at order 1 already."""
    sequence = excitation_sequence(128, span(94, 98), 3)
    assert not set(span(60, 68)) & set(sequence[3])
    assert set(span(60, 68)) <= set(sequence[1])
    assert set(span(56, 72)) - set(span(60, 68)) <= set(sequence[3])


def around(N, center, width):
    return {q for q in range(center - width, center + width + 1) if 0 < q < N}


@pytest.mark.parametrize(("N", "w"), [(128, 2), (256, 4), (64, 0)])
@pytest.mark.parametrize("quarter", [1, 2, 3])
def test_patterns_around_quarters(N, w, quarter):
    """Section 6.3: M_k of packets around kappa_0 = 1/4, 1/2, 3/4, exactly, for half-widths w in modes."""
    M = reachable_modes(N, around(N, quarter * N // 4, w), 6)
    for k in range(1, 7):
        width = w * (k + 1)
        low, middle, high = around(N, 0, width), around(N, N // 2, width), around(N, N, width)
        quarters = around(N, N // 4, width) | around(N, 3 * N // 4, width)
        if quarter == 2:
            expected = low | high if k % 2 else middle
        elif k == 1:
            expected = low | middle
        else:
            expected = low | middle | high if k % 2 else quarters
        assert set(M[k]) == expected


@pytest.mark.parametrize("N", range(2, 61))
def test_linear_frequencies_are_incommensurable_for_primes_and_powers_of_two(N):
    """The paper has 'N-1 prime'; exactly, it is N that must be prime (or a power of two)."""
    assert (frequency_rank(N) == N - 1) == (isprime(N) or N & (N - 1) == 0)


def test_ranks_judge_the_condition_of_section_2():
    lengths = range(3, 15)
    claim = statements.commensurability_claim(lengths)
    assert claim.verdict == PARTLY
    assert "N = 6, 12, 14;" in claim.ours
    assert statements.commensurability_claim(lengths, lambda N: N - 1).verdict == HOLDS
    assert statements.commensurability_claim(lengths, lambda N: N - 2).verdict == FAILS


def corrections(alpha_orders, degree):
    A = se.Symbol("A1")
    return {
        "alpha": {k: [A ** degree(k) if k in alpha_orders else se.Integer(0)] for k in (1, 2, 3, 4)},
        "beta": {k: [A ** (2 * k)] for k in (1, 2)},
    }


def test_secular_terms_and_degrees():
    found = corrections((2, 4), lambda k: k)
    assert statements.secular_claim(found).verdict == HOLDS
    assert statements.degree_claim(found).verdict == FAILS
    assert statements.secular_claim(corrections((2, 3, 4), lambda k: k)).verdict == PARTLY
    assert statements.degree_claim(corrections((2, 4), lambda k: k + 1)).verdict == PARTLY


@pytest.mark.long
def test_secular_terms_of_the_recursion():
    secular, degree = statements.secular_claims()
    assert (secular.verdict, degree.verdict) == (HOLDS, FAILS)


def test_groups_of_beta_are_united_groups_of_alpha():
    assert statements.united_groups_claim().verdict == PARTLY  # not for one seed
    assert statements.united_groups_claim(range(2, 4)).verdict == HOLDS


def test_the_stated_condition_suffices_and_is_not_needed():
    claim = statements.condition_claim()
    assert claim.verdict == PARTLY
    assert "holds for 18, the equality then for 18" in claim.ours
    assert "for 1 of 45" in claim.ours
    always = statements.condition_claim(lambda N, seeds, order: [()] * (order + 1))
    assert always.verdict == FAILS  # a condition that always holds


def test_three_thirds():
    assert statements.thirds_claim().verdict == FAILS
    assert statements.thirds_claim(2).verdict == HOLDS


def test_slopes_of_tori_are_logarithms():
    assert statements.slopes_claim().verdict == HOLDS
    power = statements.slopes_claim(lambda chain, s, eps: replace(profile_law(chain, s, eps), slope=-(eps**-0.25)))
    assert power.verdict == FAILS


@pytest.mark.long
def test_every_statement_has_a_verdict(tmp_path, monkeypatch):
    """Without what takes minutes: test_reasons.py judges all conclusions, the slopes and both breathers by their own numbers."""
    monkeypatch.setattr(statements, "conclusion_claims", list)
    monkeypatch.setattr(statements, "natural_slopes", lambda: (np.array([6.0, 9.0, 14.0]), np.array([21.6, 32.4, 50.4])))
    monkeypatch.setattr(breather_claims, "BREATHERS", ("Fig. 8",))
    figure = statements.statements(tmp_path, unheard)
    assert len(figure.claims) == 20 - 5
    assert figure.panels == ()
