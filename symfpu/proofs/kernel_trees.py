"""Appendix D: the shapes of product in the kernels K of the Lemma, counted, listed and as LaTeX."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cache
from itertools import product
from math import prod
from typing import Any

from symfpu.errors import InputError
from symfpu.numbers.typed import order_of

MOST_COUNTED = 10**9  # products, beyond which they are not counted on
MOST_SHAPES = 10_000  # of products, which are listed
# the shape of a product in K: () is a seed, else a tuple of two or three smaller shapes
Tree = tuple[Any, ...]


def count_trees(order: int, factors: int, colours: int) -> int:
    """How many products of 2 or 3 factors, of such products in turn, K^(k) has at most.

    Trees whose leaves have so many colours, by the number of leaves: the pairs and triples of a
    multiset. What is beyond MOST_COUNTED is not counted on.

    >>> [count_trees(k, 2, 1) for k in range(8)]  # Wedderburn and Etherington
    [1, 1, 1, 2, 3, 6, 11, 23]
    """
    known = [0, colours]
    while len(known) <= (factors - 1) * order + 1 and known[-1] <= MOST_COUNTED:
        known.append(_pairs(known) if factors == 2 else _triples(known))
    return known[-1]


def _pairs(known: Sequence[int]) -> int:
    """Of the next number of leaves, each tree of two of those before."""
    size = len(known)
    ordered = sum(known[i] * known[size - i] for i in range(1, size))
    return (ordered + (known[size // 2] if size % 2 == 0 else 0)) // 2


def _triples(known: Sequence[int]) -> int:
    """Likewise of three."""
    size = len(known)
    ordered = 0
    for i in range(1, size - 1):
        ordered += known[i] * sum(
            known[j] * known[size - i - j] for j in range(1, size - i)
        )
    doubled = sum(known[i] * known[size - 2 * i] for i in range(1, (size + 1) // 2))
    tripled = known[size // 3] if size % 3 == 0 else 0
    return (ordered + 3 * doubled + 2 * tripled) // 6


def kernel_trees(order: int, factors: int) -> Counter[Tree]:
    """The shapes of product in K^(k), largest block first, with their numbers of arrangements.

    Eqs. Kkga (2 factors), Kk (3).

    >>> kernel_trees(2, 2)
    Counter({(((), ()), ()): 2})
    """
    _require_few_shapes(order_of(order), factors)
    return Counter(_shapes(order, factors))


def _require_few_shapes(order: int, factors: int) -> None:
    if count_trees(order, factors, 1) > MOST_SHAPES:
        allowed = f"an order with at most {MOST_SHAPES:,} shapes of product"
        raise InputError("order", order, allowed, "take a lower order")


@cache
def _shapes(order: int, factors: int) -> Counter[Tree]:
    if order == 0:
        return Counter([()])
    trees: Counter[Tree] = Counter()
    for orders in product(range(order), repeat=factors):
        if sum(orders) != order - 1:
            continue
        shapes = [_shapes(l, factors).items() for l in orders]
        for chosen in product(*shapes):
            parts = sorted(
                (t for t, _ in chosen), key=lambda t: (_leaves(t), t), reverse=True
            )
            trees[tuple(parts)] += prod(count for _, count in chosen)
    return trees


def appendix_d(order: int = 3, *, model: str = "alpha", one_symbol: bool = True) -> str:
    r"""K^(1) .. K^(order) as LaTeX in the layout of Appendix D (Eq. Kqalpha).

    Equal products of Eqs. Kkga, Kk are collected (`kernel_trees`).

    one_symbol : q_0 for all seeds and q_l for all modes of D_l, as in the paper; otherwise seeds
    n_1 .. n_r, and q_l, q_l' for two modes of one D_l, sums over D_l understood. Collecting
    changes K(n, sigma), but not its sum over all arrangements. The paper's square in K^(3) is
    wrong: the second block has sigma_3, sigma_4. Raises InputError.

    >>> print(appendix_d(1).splitlines()[1])
    &&\mathcal{K}_{q_1 ; \alpha} ^{(1)} = B_{q_1 q_0 q_0}
    """
    factors = {"alpha": 2, "beta": 3}
    if model not in factors:
        raise InputError(
            "model", model, "'alpha' or 'beta'", "the Lemma is stated for these"
        )
    _require_few_shapes(order_of(order, 1), factors[model])
    lines = []
    for k in range(1, order + 1):
        terms = []
        for tree, count in kernel_trees(k, factors[model]).most_common():
            number = f"{count} " if count > 1 else ""
            terms.append(number + _latex(tree, one_symbol=one_symbol))
        kernel = rf"\mathcal{{K}}_{{q_{k} ; \{model}}} ^{{({k})}}"
        lines.append(rf"&&{kernel} = {' + '.join(terms)}")
    body = " \\nonumber\\\\\n".join(lines)
    return "\n".join([r"\begin{eqnarray}", body, r"\end{eqnarray}"])


def _latex(tree: Tree, *, one_symbol: bool) -> str:
    """One product of K as a fraction of the L times couplings, the earliest first."""
    couplings, squares, divisors = Counter[str](), Counter[str](), Counter[str]()
    used = Counter[int]()

    def visit(node: Tree, first: int) -> str:
        """The name of the node's mode; its block begins with sigma_first."""
        if not node:
            return "q_0" if one_symbol else f"n_{first}"
        level = (_leaves(node) - 1) // (len(node) - 1)
        primes = 0 if one_symbol else used[level]
        name = f"q_{level}" + "'" * primes
        used[level] += 1
        names = [name]
        start = first
        for child in node:
            names.append(visit(child, start))
            start += _leaves(child)
        letter = "B" if len(node) == 2 else "C"
        couplings[f"{letter}_{{{' '.join(names)}}}"] += 1
        if node is not tree:
            block = range(first, first + _leaves(node))
            rates = [rf"\sigma_{i} \omega_{{{visit((), i)}}}" for i in block]
            squares[rf"\Omega_{{{name}}}"] += 2
            divisors[rf"[\Omega_{{{name}}}^2 - ({'+'.join(rates)})^2]"] += 1
        return name

    visit(tree, 1)
    product_of_couplings = _latex_product(couplings)
    if not divisors:
        return product_of_couplings
    top, bottom = _latex_product(squares), _latex_product(divisors)
    return rf"\frac{{{top}}}{{{bottom}}} " + product_of_couplings


def _latex_product(powers: Counter[str]) -> str:
    return " ".join(f"{factor}^{e}" if e > 1 else factor for factor, e in powers.items())


def _leaves(tree: Tree) -> int:
    return sum(map(_leaves, tree)) if tree else 1
