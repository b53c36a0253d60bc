"""Programs: equal sums are one node, zeros are found, arrays come back; expansions by definition."""

import numpy as np
import pytest
import symengine as se
from hypothesis import given, settings
from hypothesis import strategies as st

from symfpu import Chain, ExpansionTooLarge, TooLarge, lindstedt
from symfpu.algebra import program as program_module
from symfpu.algebra.expansion import Expansion
from symfpu.algebra.formulas import expressions
from symfpu.algebra.program import ONE, POINTS, PRIME, ZERO, Program, Terms
from symfpu.algebra.program_ring import ProgramRing
from symfpu.algebra.program_values import values_in
from symfpu.series.divisors import UniversalDivisors
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import run_recursion


def one_sum(program, *terms):
    """The node of the sum of (left, right, factor)."""
    left, right, factor = np.array(terms, dtype=np.int64).T
    out = np.zeros(len(terms), dtype=np.int64)
    return int(program.sums(1, out, Terms(left, right, factor))[0])


def three_leaves():
    program = Program()
    return program, [program.leaf(name) for name in "abc"]


def test_equal_sums_are_one_node():
    program, (a, b, c) = three_leaves()
    first = one_sum(program, (a, b, 2), (c, ONE, -1))
    assert one_sum(program, (ONE, c, -1), (b, a, 1), (a, b, 1)) == first
    assert one_sum(program, (a, b, 2), (c, ONE, 1)) != first
    assert program.leaf("a") == a


def test_a_sum_of_one_node_is_that_node():
    program, (a, _, _) = three_leaves()
    size = program.size
    assert one_sum(program, (ONE, a, 1)) == a
    assert one_sum(program, (a, ONE, 3), (a, ONE, -2)) == a
    assert program.size == size


def test_sums_that_cancel_term_by_term_are_zero():
    program, (a, b, _) = three_leaves()
    assert one_sum(program, (a, b, 2), (b, a, -2)) == ZERO


def test_an_identity_of_different_products_shows_in_residues():
    """(a + b)(a - b) - a^2 + b^2 has no two equal products."""
    program, (a, b, _) = three_leaves()
    plus, minus = one_sum(program, (a, ONE, 1), (b, ONE, 1)), one_sum(program, (a, ONE, 1), (b, ONE, -1))
    node = one_sum(program, (plus, minus, 1), (a, a, -1), (b, b, 1))
    other = one_sum(program, (plus, minus, 1), (a, a, -1), (b, b, 2))
    assert program.vanishing(np.array([node, other, ZERO])).tolist() == [True, False, False]
    assert Expansion(program, np.array([node])).is_zero(node)
    assert not Expansion(program, np.array([other])).is_zero(other)


def test_sums_whose_hashes_meet_stay_apart(monkeypatch):
    """A hash that is the same for all: nodes are compared term by term."""
    monkeypatch.setattr(program_module, "_mixed", lambda terms: np.ones(len(terms.left), dtype=np.uint64))
    program, (a, b, c) = three_leaves()
    ab, ac = one_sum(program, (a, b, 1)), one_sum(program, (a, c, 1))
    assert ab != ac
    pair = program.sums(2, np.array([0, 1]), Terms(np.array([a, b]), np.array([a, b]), np.array([1, 1])))
    assert pair[0] != pair[1]
    again = program.sums(2, np.array([0, 1]), Terms(np.array([b, b]), np.array([b, b]), np.array([1, 1])))
    assert again[0] == again[1]


def test_long_keys_are_sorted_the_slow_way_too():
    """Where sum, left and right do not fit into one integer of 64 bits."""
    rng = np.random.default_rng(3)
    out, left, right = rng.integers(0, 5, (3, 200))
    factor = rng.integers(-2, 3, 200)
    short = program_module.collected(6, out, Terms(left, right, factor))
    long = program_module.collected(2**40, out, Terms(left, right, factor))
    for a, b in zip((short[0], *short[1]), (long[0], *long[1]), strict=True):
        assert a.tolist() == b.tolist()


@pytest.mark.parametrize(("N", "seeds", "order"), [(9, (3, 6), 4), (6, (2, 3), 2)])
def test_zeros_by_identities_are_zeros_in_both_forms(N, seeds, order):
    """N = 9: two sums of different products vanish; residues see it, and the expansion proves it."""
    expanded, nested = (lindstedt(Chain(N, beta=1), seeds, order=order, ring=ring) for ring in ("symbolic", "nested"))
    for a, b in zip(expanded.coordinates, nested.coordinates, strict=True):
        assert (a.nonzero == b.nonzero).all()
        assert not any(value == 0 for value in np.asarray(a)[a.nonzero])


def test_zeros_that_are_believed_are_counted():
    chain = Chain(9, beta=1)
    counts = []
    for expanded in (True, False):
        ring = ProgramRing(monomial_space(chain, (3, 6), 4), expanded=expanded)
        run_recursion(ring, UniversalDivisors(ring.space), chain, 4, None)
        counts.append(ring.guessed)
    assert counts == [0, 2]


def a_program():
    series = lindstedt(Chain(7, alpha="0.5", beta="0.3"), (1, 5), order=4)
    table = series.coordinates[4]
    return table.program, table.nodes


def test_residues_are_the_values_at_the_random_points():
    program, nodes = a_program()
    for point in range(POINTS):
        leaves = [int(program.residues[leaf, point]) for leaf in program.leaves]
        values = values_in(program, leaves, nodes)
        for node, value in zip(nodes.ravel(), values.ravel(), strict=True):
            if node != ZERO:
                assert value % PRIME == int(program.residues[node, point])


def test_arrays_come_back_and_go_on():
    """A program of its own arrays knows its nodes again, and makes the same new ones."""
    program, nodes = a_program()
    copy = Program.of_arrays(program.symbols, program.start, program.terms)
    a, b = (int(x) for x in nodes[nodes != ZERO][-2:])
    assert one_sum(copy, (a, b, 3), (a, a, 1)) == one_sum(program, (a, b, 3), (a, a, 1))
    first = program.terms.at(slice(*program.start[a : a + 2]))
    assert one_sum(copy, *zip(*first, strict=True)) == a
    assert (copy.residues == program.residues).all()


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(-3, 3)), min_size=1, max_size=8), st.integers(1, 3))
def test_expansions_are_those_of_symengine(terms, rounds):
    program = Program()
    nodes = [ONE, *(program.leaf(f"y{i}") for i in range(5))]
    symbols = [se.Integer(1), *(se.Symbol(f"y{i}") for i in range(5))]
    node, expected = nodes[1], symbols[1]
    for _ in range(rounds):
        expected = se.expand(sum((f * symbols[l] * symbols[r] for l, r, f in terms), se.Integer(0)) + expected * symbols[2])
        node = (
            one_sum(program, *((nodes[l], nodes[r], f) for l, r, f in terms), (node, nodes[2], 1))
            if node != ZERO
            else one_sum(program, *((nodes[l], nodes[r], f) for l, r, f in terms))
        )
        found = expressions(program, np.array([node]), expanded=True)[0]
        assert se.expand(found - expected) == 0
        nodes.append(node if node != ZERO else ONE)
        symbols.append(expected if node != ZERO else se.Integer(1))
        if node != ZERO and Expansion(program, np.array([node])).is_zero(node):
            break


def test_monomials_of_many_words():
    """Thirty symbols of high degree need more than one word of 64 bits."""
    program = Program()
    leaves = [program.leaf(i) for i in range(30)]
    node = leaves[0]
    for leaf in leaves[1:]:
        node = one_sum(program, (node, leaf, 2))
    polynomial = Expansion(program, np.array([node])).polynomial(node)
    assert sorted(polynomial.symbols[0].tolist(), reverse=True) == list(range(29, -1, -1))
    assert polynomial.coefficients.tolist() == [2**29]


def test_expansions_that_do_not_fit_are_refused_before_they_are_made(monkeypatch):
    series = lindstedt(Chain(16, alpha=1), (1, 2), order=6)
    monkeypatch.setattr("psutil.virtual_memory", lambda: type("Memory", (), {"available": 10**6}))
    with pytest.raises(ExpansionTooLarge, match=r"ask for form=\"factored\" or \"cse\"") as refusal:
        series.term(3, 6)
    assert refusal.value.terms > 1000
    assert refusal.value.needed > refusal.value.free == 10**6
    assert series.term(3, 6, form="factored")


def test_expansions_beyond_integers_of_64_bits_are_refused():
    program = Program()
    node = program.leaf("a")
    for _ in range(3):
        node = one_sum(program, (node, node, 2**30))
    with pytest.raises(ExpansionTooLarge, match="integers of 64 bits"):
        Expansion(program, np.array([node]))


def test_an_order_that_does_not_fit_is_refused(monkeypatch):
    ring = ProgramRing(monomial_space(Chain(16, alpha=1), (1, 2), 6), expanded=True)
    monkeypatch.setattr("psutil.virtual_memory", lambda: type("Memory", (), {"available": 10**5}))
    with pytest.raises(TooLarge, match=r"take order \d or less") as refusal:
        run_recursion(ring, UniversalDivisors(ring.space), Chain(16, alpha=1), 6, None)
    assert 0 < refusal.value.order <= 6
