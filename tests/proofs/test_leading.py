"""The Lemma of Appendix C and the expressions of Appendix D, as exact identities."""

import pickle
from itertools import combinations, permutations, product

import numpy as np
import pytest
import symengine as se

import symfpu.proofs.leading
from symfpu import Chain, InputError, coupling_sequence, excitation_sequence, leading_term, lemma_holds, lindstedt
from symfpu.algebra.formulas import expressions, multiplier_symbol
from symfpu.algebra.program_values import terms_of
from symfpu.proofs.kernel_trees import appendix_d, count_trees, kernel_trees
from symfpu.proofs.leading import LeadingTerm, leading_factor, leading_kernel, leading_terms
from tests.refusals import refused

ORDER = {"alpha": 4, "beta": 2}


def chain_of(model, N):
    return Chain(N, **{model: 1})


def coupled(N, seeds, model, order):
    """Modes by the first order at which the couplings admit them, the seeds left out."""
    sequence = coupling_sequence(N, seeds, order, model=model)
    return {q: k for k, modes in enumerate(sequence) for q in modes if k > 0}


def L(seeds, q, block):
    """L_q at the harmonic of a block of pairs (n, sigma)."""
    nu = tuple(sum(sign for n, sign in block if n == seed) for seed in seeds)
    return multiplier_symbol(q, max(nu, tuple(-n for n in nu)))


def arrangements(seeds, monomial):
    """All different orderings of the pairs (n, sigma) of a monomial."""
    pairs = [(seeds[i // 2], -1 if i % 2 else 1) for i, e in enumerate(monomial) for _ in range(e)]
    return sorted(set(permutations(pairs)))


CASES = [
    ("alpha", 32, (1, 2, 3)),
    ("alpha", 16, (2, 5)),
    ("alpha", 8, (1, 2, 3)),
    ("alpha", 8, (6, 7)),
    ("alpha", 12, (9, 10, 11)),
    ("alpha", 7, (2, 5)),
    ("alpha", 9, (4,)),
    ("alpha", 12, (4, 6, 8)),
    ("beta", 32, (1, 2, 3, 4)),
    ("beta", 16, (1, 6)),
    ("beta", 8, (6, 7)),
    ("beta", 12, (9, 10, 11)),
    ("beta", 8, (1, 4)),
    ("beta", 6, (2, 3)),
    ("beta", 5, (1, 4)),
    ("beta", 11, (5,)),
]


@pytest.mark.parametrize(("model", "N", "seeds"), CASES)
def test_lemma(model, N, seeds):
    """Every mode admitted by the couplings up to the last order is excited there, by the closed form and by the recursion."""
    predicted = coupled(N, seeds, model, ORDER[model])
    assert lemma_holds(chain_of(model, N), seeds, ORDER[model]) == dict.fromkeys(sorted(predicted), True)
    assert {q: term.order for q, term in leading_terms(chain_of(model, N), seeds, ORDER[model]).items()} == predicted


@pytest.mark.parametrize("model", ["alpha", "beta"])
def test_lemma_for_all_small_seed_sets(model):
    for N in range(2, 6):
        for seeds in (chosen for s in (1, 2) for chosen in combinations(range(1, N), s)):
            predicted = sorted(coupled(N, seeds, model, ORDER[model]))
            assert lemma_holds(chain_of(model, N), seeds, ORDER[model]) == dict.fromkeys(predicted, True), (N, seeds)


def test_leading_terms_of_a_planted_bug(monkeypatch):
    """With one sign of B wrong where the sums fold, the Lemma must be seen to fail, and only there."""
    monkeypatch.setattr(symfpu.proofs.leading, "_coupling", lambda chain, q, modes: abs(chain.B(q, *modes)))
    symfpu.proofs.leading._leading.cache_clear()
    try:
        holds = lemma_holds(Chain(N=5, alpha=1), (2, 3), 1)
        assert holds == {1: True, 4: False}  # 4 = 2 + 2 = 10 - 3 - 3
    finally:
        symfpu.proofs.leading._leading.cache_clear()


def test_missed_mode_is_a_failure(monkeypatch):
    monkeypatch.setattr(symfpu.proofs.leading, "_leading", lambda chain, seeds, order: {})
    assert lemma_holds(Chain(N=8, alpha=1), (1,), 2) == {2: False, 3: False}


def test_mode_that_the_recursion_lacks_is_a_failure(monkeypatch):
    extra = {5: LeadingTerm(5, 1, (2,), {(2, 0): se.Integer(1), (0, 2): se.Integer(1)})}
    monkeypatch.setattr(symfpu.proofs.leading, "_leading", lambda chain, seeds, order: extra)
    assert lemma_holds(Chain(N=8, alpha=1), (2,), 1) == {4: False, 5: False}


@pytest.mark.parametrize(
    ("model", "N", "seed", "excited"),
    [
        ("alpha", 2, 1, {}),
        ("alpha", 12, 6, {}),
        ("alpha", 12, 8, {}),
        ("alpha", 12, 4, {8: 1}),
        ("beta", 2, 1, {}),
        ("beta", 12, 6, {}),
        ("beta", 12, 8, {}),
        ("beta", 12, 4, {}),
        ("alpha", 12, 5, {10: 1, 9: 2, 4: 3, 1: 4}),
        ("beta", 12, 5, {9: 1, 1: 2}),
    ],
)
def test_one_seed(model, N, seed, excited):
    """N/2 and 2N/3, in beta also N/3, excite nothing; other breathers one mode at each order."""
    terms = leading_terms(chain_of(model, N), (seed,), ORDER[model])
    assert {q: term.order for q, term in terms.items()} == excited
    assert lemma_holds(chain_of(model, N), (seed,), ORDER[model]) == dict.fromkeys(sorted(excited), True)


def test_cancelled_couplings_delay_a_mode():
    """l + m = N in beta: the proposition has N - n at order 1, where C = 0; in fact it enters at order 2, and so in K."""
    chain, seeds = Chain(N=6, beta=1), (2, 3)
    assert 4 in excitation_sequence(6, seeds, 2, model="beta")[1]
    assert all(leading_kernel(chain, seeds, 4, n, signs) == 0 for n in product(seeds, repeat=3) for signs in product((1, -1), repeat=3))
    assert leading_terms(chain, seeds, 2)[4].order == 2
    assert se.expand(leading_term(chain, seeds, 4) - lindstedt(chain, seeds, order=2).term(4, 2)) == 0


def test_folded_sums_change_sign():
    """2 = 8 - 3 - 3 at N = 4: B = -1, so Q_2^(1) = + A^2 Omega_3^2 (L_2(0) + L_2(2) cos 2 theta) / (2 Omega_2)."""
    A, theta, Omega_2, Omega_3 = map(se.Symbol, ("A3", "theta3", "Omega_2", "Omega_3"))
    bracket = multiplier_symbol(2, (0,)) + multiplier_symbol(2, (2,)) * se.cos(2 * theta)
    assert se.expand(leading_term(Chain(N=4, alpha=1), (3,), 2) - A**2 * Omega_3**2 * bracket / (2 * Omega_2)) == 0


def sum_over_arrangements(chain, seeds, q, r, kernel):
    """The sum of Eq. Qqkr as it stands; the imaginary parts of opposite sigma cancel."""
    total = []
    for n, signs in product(product(seeds, repeat=r), product((1, -1), repeat=r)):
        angle = se.Add(*(sign * se.Symbol(f"theta{m}") for m, sign in zip(n, signs, strict=True)))
        total.append(leading_factor(chain, seeds, q, n, signs) * kernel(n, signs) * se.cos(angle))
    return se.expand(se.Add(*total))


@pytest.mark.parametrize(
    ("model", "N", "seeds", "order"),
    [("alpha", 16, (1, 3), 3), ("alpha", 12, (10, 11), 2), ("beta", 6, (2, 3), 2), ("beta", 8, (7,), 2), ("alpha", 16, (3,), 4)],
)
def test_sum_term_by_term(model, N, seeds, order):
    """Eqs. Qqkr, Rqr, Kkga, Kk summed literally over n and sigma are the recursion's term."""
    chain = chain_of(model, N)
    series = lindstedt(chain, seeds, order=order)
    chosen = [q for q, k in coupled(N, seeds, model, order).items() if k == order]
    assert chosen
    for q in chosen:
        literal = sum_over_arrangements(
            chain, seeds, q, series.degree(order), lambda n, signs, q=q: leading_kernel(chain, seeds, q, n, signs)
        )
        assert se.expand(literal - series.term(q, order)) == 0
        assert se.expand(literal - leading_term(chain, seeds, q)) == 0


def test_kernel_of_order_zero_is_a_delta():
    """With the printed K^(0) = 1, K^(1) = sum B over all seeds whatever n is: wrong for two seeds, right for one."""
    chain, q = Chain(N=8, alpha=1), 3
    recursion = lindstedt(chain, (1, 2), order=1).term(q, 1)
    printed = sum(chain.B(q, m, l) for m, l in product((1, 2), repeat=2))
    assert se.expand(sum_over_arrangements(chain, (1, 2), q, 2, lambda n, signs: printed) - recursion) != 0
    assert se.expand(sum_over_arrangements(chain, (1, 2), q, 2, lambda n, signs: chain.B(q, *n)) - recursion) == 0
    assert [leading_kernel(chain, (1, 2), q, (n,), (1,)) for q, n in product((1, 2), repeat=2)] == [1, 0, 0, 1]


def test_zero_order_term_needs_a_multiplier_of_one():
    """Eq. Rqr has a zero divisor at k = 0; with L^(0) = 1 it gives Q_q^(0) = A_q cos(theta_q)."""
    chain, A = Chain(N=8, alpha=1), se.Symbol("A2")
    assert leading_factor(chain, (1, 2), 2, (2,), (1,)) == A / 2
    literal = sum_over_arrangements(chain, (1, 2), 2, 1, lambda n, signs: leading_kernel(chain, (1, 2), 2, n, signs))
    assert literal == A * se.cos(se.Symbol("theta2"))


def test_kernel_depends_on_sigma():
    """The printed arguments of K and L are n alone."""
    chain = Chain(N=8, alpha=1)
    values = {leading_kernel(chain, (1,), 3, (1, 1, 1), signs) for signs in product((1, -1), repeat=3)}
    low, high = multiplier_symbol(2, (0,)), multiplier_symbol(2, (2,))
    assert values == {2 * high, low + high, 2 * low}


def test_kernel_sums_over_leading_modes_only():
    """K_5^(3) has m in D_2 = {5, 6} only: 5 = 6 - 1, 6 = 4 + 2; 5 = 3 + 2 with K_3^(2) = L_4, 3 = 4 - 1, is no part of it."""
    chain, seeds = Chain(N=8, alpha=1), (1, 2)
    assert coupling_sequence(8, seeds, 2) == [(1, 2), (3, 4), (5, 6)]
    symbols = set().union(*(leading_kernel(chain, seeds, 5, n, (1, 1, 1, 1)).free_symbols for n in product(seeds, repeat=4)))
    assert symbols == {multiplier_symbol(4, (0, 2)), multiplier_symbol(6, (0, 3))}


def tree_kernel(chain, seeds, tree, block):
    """One product of K by mode, from its shape: the oracle of `kernel_trees`; sums over m in D_l are taken."""
    if not tree:
        return {block[0][0]: 1}
    parts, at = [], 0
    for child in tree:
        size = str(child).count("()")
        piece, at = block[at : at + size], at + size
        level = leading_terms(chain, seeds, l := (size - 1) // chain.degree_step)
        kernels = tree_kernel(chain, seeds, child, piece)
        parts.append({m: k * (L(seeds, m, piece) if l else 1) for m, k in kernels.items() if not l or (m in level and level[m].order == l)})
    sums = {}
    for chosen in product(*(part.items() for part in parts)):
        for q, number in chain.coupled(*(m for m, _ in chosen)):
            sums[q] = sums.get(q, 0) + se.Mul(number, *(k for _, k in chosen))
    return sums


@pytest.mark.parametrize(
    ("model", "N", "seeds", "order"), [("alpha", 16, (1, 2), 3), ("alpha", 12, (10, 11), 3), ("alpha", 16, (1,), 4), ("beta", 6, (2, 3), 2)]
)
def test_collected_kernels_have_the_same_sum(model, N, seeds, order):
    """What Appendix D prints, Eq. Kkga as it stands, and the grouped closed form agree on every monomial, though not on (n, sigma)."""
    chain, trees, differ = chain_of(model, N), kernel_trees(order, 2 if model == "alpha" else 3), 0
    terms = [term for term in leading_terms(chain, seeds, order).values() if term.order == order]
    assert terms
    for term in terms:
        for monomial, grouped in term.kernels.items():
            literal = collected = se.Integer(0)
            for block in arrangements(seeds, monomial):
                k = leading_kernel(chain, seeds, term.mode, *zip(*block, strict=True))
                c = se.Add(*(count * tree_kernel(chain, seeds, tree, block).get(term.mode, 0) for tree, count in trees.items()))
                differ += se.expand(k - c) != 0
                literal, collected = literal + k, collected + c
            assert se.expand(literal - grouped) == 0
            assert se.expand(collected - grouped) == 0
    assert differ > 0


def test_shapes_of_appendix_d():
    """K^(1) = B, K^(2) = 2 L B B, K^(3) = 4 L L B B B + L L B B B; 14 ordered products, a Catalan number, at k = 4."""
    one = ((), ())
    two = (one, ())
    assert kernel_trees(1, 2) == {one: 1}
    assert kernel_trees(2, 2) == {two: 2}
    assert kernel_trees(3, 2) == {(two, ()): 4, (one, one): 1}
    assert sum(kernel_trees(4, 2).values()) == 14
    assert kernel_trees(2, 3) == {(((), (), ()), (), ()): 3}


@pytest.mark.parametrize("factors", [2, 3])
def test_shapes_are_counted_before_they_are_listed(factors):
    assert [count_trees(k, factors, 1) for k in range(9)] == [len(kernel_trees(k, factors)) for k in range(9)]


def test_trees_of_two_colours_are_those_that_are_listed():
    """Every leaf of a shape has one of two colours; equal subtrees are a multiset."""

    def coloured(tree):
        if not tree:
            return {0, 1}
        return {tuple(sorted(parts, key=repr)) for parts in product(*map(coloured, tree))}

    for order, factors in product(range(1, 5), (2, 3)):
        trees = set().union(*map(coloured, kernel_trees(order, factors)))
        assert len(trees) == count_trees(order, factors, 2)


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (lambda: kernel_trees(40, 2), "order = 40.*10,000 shapes"),
        (lambda: appendix_d(10_000), "10,000 shapes"),
        (lambda: leading_term(Chain(64, alpha=1), (1,), 60), "q = .*take a lower order, or a mode nearer"),
        (lambda: leading_terms(Chain(64, alpha=1), (1,), 60), "order = .*take a lower order"),
        (lambda: leading_term(Chain(81, beta=1), (1, 2), 30), "of order 7.*2,000,000 products"),
        (lambda: leading_term(Chain(81, beta=1), (1, 2, 3, 4, 5), 55), "of order 5.*2,000,000 products"),
    ],
)
def test_products_without_end_are_refused(call, reason):
    with pytest.raises(InputError, match=reason):
        call()


def test_orders_beyond_the_last_mode_cost_nothing():
    assert leading_terms(Chain(6, alpha=1), (1,), 1000).keys() == leading_terms(Chain(6, alpha=1), (1,), 5).keys()


def test_appendix_d_as_printed():
    """Eq. Kqalpha in the paper's symbols; only the second divisor of the last fraction is not the first one squared."""
    first, second = r"(\sigma_1 \omega_{q_0}+\sigma_2 \omega_{q_0})", r"(\sigma_3 \omega_{q_0}+\sigma_4 \omega_{q_0})"
    three = r"(\sigma_1 \omega_{q_0}+\sigma_2 \omega_{q_0}+\sigma_3 \omega_{q_0})"
    one, two, both = r"\Omega_{q_1}^2", r"\Omega_{q_2}^2", r"B_{q_1 q_0 q_0} B_{q_2 q_1 q_0}"
    chained = rf"4 \frac{{{one} {two}}}{{[{one} - {first}^2] [{two} - {three}^2]}} {both} B_{{q_3 q_2 q_0}}"
    expected = [
        r"&&\mathcal{K}_{q_1 ; \alpha} ^{(1)} = B_{q_1 q_0 q_0} \nonumber\\",
        rf"&&\mathcal{{K}}_{{q_2 ; \alpha}} ^{{(2)}} = 2 \frac{{{one}}}{{[{one} - {first}^2]}} {both} \nonumber\\",
        rf"&&\mathcal{{K}}_{{q_3 ; \alpha}} ^{{(3)}} = {chained}"
        rf" + \frac{{\Omega_{{q_1}}^4}}{{[{one} - {first}^2] [{one} - {second}^2]}} B_{{q_1 q_0 q_0}}^2 B_{{q_3 q_1 q_1}}",
    ]
    assert appendix_d().splitlines() == [r"\begin{eqnarray}", *expected, r"\end{eqnarray}"]


def test_appendix_d_with_a_symbol_for_every_mode():
    last = appendix_d(one_symbol=False).splitlines()[-2]
    assert last.endswith(r"B_{q_1 n_1 n_2} B_{q_1' n_3 n_4} B_{q_3 q_1 q_1'}")
    assert r"[\Omega_{q_1'}^2 - (\sigma_3 \omega_{n_3}+\sigma_4 \omega_{n_4})^2]" in last
    assert r"\mathcal{K}_{q_2 ; \beta} ^{(2)} = 3 \frac" in appendix_d(2, model="beta")


def third_kernel(chain, seeds, block, *, squared):
    """K^(3) of Eq. Kqalpha for q = 4 of the breather q_0 = 1, q_1 = 2, q_2 = 3; its second part printed as a square, or not."""
    chained = 4 * L(seeds, 2, block[:2]) * L(seeds, 3, block[:3]) * chain.B(2, 1, 1) * chain.B(3, 2, 1) * chain.B(4, 3, 1)
    other = L(seeds, 2, block[:2] if squared else block[2:])
    return chained + L(seeds, 2, block[:2]) * other * chain.B(2, 1, 1) ** 2 * chain.B(4, 2, 2)


def test_square_in_the_third_kernel_is_a_misprint():
    """Even for one seed: with a square the sum over sigma is wrong wherever the two blocks carry different harmonics."""
    chain, seeds = Chain(N=16, alpha=1), (1,)
    kernels = leading_terms(chain, seeds, 3)[4].kernels
    assert set(kernels) == {(4, 0), (3, 1), (2, 2), (1, 3), (0, 4)}
    for monomial, exact in kernels.items():
        blocks = arrangements(seeds, monomial)
        right, printed = (se.Add(*(third_kernel(chain, seeds, b, squared=squared) for b in blocks)) for squared in (False, True))
        assert se.expand(right - exact) == 0
        low, high = multiplier_symbol(2, (0,)), multiplier_symbol(2, (2,))
        wrong = 2 * (high - low) ** 2 if monomial in ((3, 1), (1, 3)) else 0
        assert se.expand(printed - exact - wrong) == 0


def test_second_kernel_is_collected():
    """2 L_q1(sigma_1, sigma_2) B B is not K^(2)(n, sigma) of Eq. Kkga: that has one L of either pair."""
    chain, block = Chain(N=16, alpha=1), ((1, 1), (1, 1), (1, -1))
    low, high = multiplier_symbol(2, (0,)), multiplier_symbol(2, (2,))
    (tree,) = kernel_trees(2, 2)
    assert 2 * tree_kernel(chain, (1,), tree, block)[3] == 2 * high
    assert leading_kernel(chain, (1,), 3, (1, 1, 1), (1, 1, -1)) == low + high


def test_seeds_in_any_order():
    chain = Chain(N=16, alpha=1)
    assert se.expand(leading_term(chain, (5, 2), 10) - leading_term(chain, (2, 5), 10)) == 0
    assert leading_factor(chain, (5, 2), 7, (5, 2), (-1, 1)) == leading_factor(chain, (2, 5), 7, (5, 2), (1, -1))


ONE_SEED, TODA = {"chain": Chain(N=8, alpha=1), "seeds": (1,)}, Chain(8, potential="toda:1/2")
AT_ONE = ONE_SEED | {"q": 3, "modes": (1, 1), "signs": (1, 1)}
BAD = [
    *((leading_term, ONE_SEED, "q", q) for q in (1, 8, 0, 1.5)),
    (leading_term, ONE_SEED | {"chain": Chain(N=8, beta=1)}, "q", 2),
    *((leading_term, ONE_SEED | {"q": 2}, "chain", chain) for chain in (Chain(N=8, alpha=1, beta=1), TODA)),
    *((function, ONE_SEED | {"order": 2}, "chain", TODA) for function in (leading_terms, lemma_holds)),
    (leading_terms, ONE_SEED | {"order": 1}, "seeds", (8,)),
    (leading_terms, ONE_SEED, "order", -1),
    (lemma_holds, ONE_SEED, "order", 1.0),
    (leading_kernel, AT_ONE, "q", 9),
    *((leading_kernel, AT_ONE | {"signs": (1,) * len(n)}, "modes", n) for n in ((1, 2), ())),
    (leading_kernel, AT_ONE | {"chain": Chain(N=8, beta=1)}, "modes", (1, 1)),
    *((leading_factor, AT_ONE, "signs", signs) for signs in ((1,), (1, 2))),
    (kernel_trees, {"factors": 2}, "order", -1),
    (appendix_d, {}, "order", 0),
    (appendix_d, {}, "model", "gamma"),
]


@pytest.mark.parametrize(("function", "given", "name", "value"), BAD)
def test_bad_input(function, given, name, value):
    refused(function, name, value, **given)


@pytest.mark.parametrize(
    ("couplings", "seeds", "order"), [({"alpha": 1}, (1,), 4), ({"alpha": 1}, (1, 2), 3), ({"beta": 1}, (1, 2), 2)], ids=str
)
def test_kernels_are_nodes_of_the_program(couplings, seeds, order):
    """u_q^(k)[nu] is one product in the program, L_q(nu) times a node: that node is the sum of the K_q^(k) of Eqs. Kkga, Kk."""
    chain = Chain(25, **couplings)
    series = lindstedt(chain, seeds, order=order, ring="nested")
    program, compared = series.coordinates[0].program, 0
    for q, term in leading_terms(chain, seeds, order).items():
        table = series.coordinates[term.order]
        rows = series.grading.exponents(series.degree(term.order))[series.grading.canonical(series.degree(term.order))]
        for row, node in zip(rows.tolist(), table.nodes[:, q - 1].tolist(), strict=True):
            if node < 0:
                assert tuple(row) not in term.kernels
                continue
            ((left, right, factor),) = terms_of(program, node)
            (leaf,) = {left, right} & set(program.leaves)
            bracket = left + right - leaf
            nu = tuple(p - n for p, n in zip(row[::2], row[1::2], strict=True))
            symbol = program.symbols[program.leaf_number(leaf)]
            assert symbol.mode == q
            assert symbol.harmonic in (nu, tuple(-n for n in nu))
            blocks = set(permutations([(seeds[i // 2], 1 - 2 * (i % 2)) for i, e in enumerate(row) for _ in range(e)]))
            kernels = sum(leading_kernel(chain, seeds, q, *zip(*block, strict=True)) for block in blocks)
            (value,) = expressions(program, np.array([bracket]), expanded=True)
            assert se.expand(factor * value - (-1) ** term.order * kernels) == 0
            compared += 1
    assert compared > order


def test_a_term_goes_to_other_processes():
    term = leading_terms(Chain(8, alpha="0.3"), (1, 2), 3)[5]
    returned = pickle.loads(pickle.dumps(term))
    assert repr(returned) == repr(term)
    assert returned.expression() == term.expression()
