"""The Lemma of Appendix C: leading terms in closed form, exact expressions in L_q(nu).

For q first excited at order k (q in D_k), Q_q^(k) = sum over n in D_0^r and sigma in {-1,1}^r of
R_q^(k) K_q^(k) exp(i sigma.(omega_n t + phi_n)) (Eq. Qqkr), r = k+1 (alpha) or 2k+1 (beta); R and
K depend on n and sigma. Read here: K_m^(0)(n) = delta_{m,n}, L^(0) = 1 also in R, and D_k the
modes that are in fact excited first at order k.

The sums over m_i in D_{l_i} need leading terms only. Let c(q) be the first order at which the
couplings admit q, so that c(q) <= c(l) + c(m) + 1 wherever B_qlm is not zero. A product of terms
of orders n_1 >= c(l), n_2 >= c(m) enters at order n_1 + n_2 + 1, so at order c(q) both are
equalities; and q, no seed, has no frequency correction. Likewise for C. So the Lemma holds for
every mode whose term of order c(q) is not identically zero. `lemma_holds` compares it with the
recursion.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, reduce
from itertools import combinations_with_replacement, pairwise, product
from math import factorial, prod
from typing import Any

import symengine as se

from symfpu.algebra.formulas import multiplier_symbol
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.propagation import excitation_sequence, product_modes
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import HIGHEST_ORDER, integer, order_of, seed_modes
from symfpu.proofs.kernel_trees import count_trees
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries

MOST_PRODUCTS = 2 * 10**6  # of the kernels of one order: ten seconds, about
# exponents (p_1, n_1, ..., p_s, n_s) of w_i = Omega_i (A_i/2) exp(i theta_i) and its conjugate
Monomial = tuple[int, ...]
Polynomial = dict[Monomial, Any]
Block = tuple[tuple[int, int], ...]  # pairs (n_i, sigma_i)


@dataclass(frozen=True)
class LeadingTerm:
    """Q_q^(k) of a mode first excited at order k, without mu^k.

    kernels : by monomial, the sum of K_q^(k) over all arrangements of (n, sigma) in which seed i
    stands p_i times with sigma = +1 and n_i times with -1. Zero sums are left out.
    """

    mode: int
    order: int
    seeds: tuple[int, ...]
    kernels: Mapping[Monomial, Any] = field(repr=False)

    def expression(self) -> Any:
        """The term as `LindstedtSeries.term` writes it: in A_i, theta_i, Omega_q and L_q(nu)."""
        terms = []
        for monomial, kernel in self.kernels.items():
            nu = _harmonic(monomial)
            # the conjugate monomial has the same kernel and makes the cosine
            conjugate = tuple(-n for n in nu)
            if nu < conjugate:
                continue
            modes = []
            for i, exponent in enumerate(monomial):
                modes += [self.seeds[i // 2]] * exponent
            phases = [
                n * se.Symbol(f"theta{q}") for n, q in zip(nu, self.seeds, strict=True)
            ]
            angle = se.Add(*phases)
            factor = _factor(self.mode, self.order, modes, nu)
            pair = 2 if any(nu) else 1
            terms.append(pair * factor * kernel * se.cos(angle))
        return se.Add(*terms)


def leading_terms(chain: Chain, seeds: Sequence[int], order: int) -> dict[int, LeadingTerm]:
    """The leading term of every mode first excited at orders 1 .. order, by the Lemma.

    Eqs. Qqkr, Rqr, Kkga, Kk, Lm; at order 1 this is Eq. Qq1cora.

    The (2s)^r summands are grouped by monomial: K factorises over its blocks, so their sum is a
    product of polynomials. Raises InputError for seeds or an order out of range, and for a chain
    with both couplings.

    >>> leading_terms(Chain(N=6, beta=1), (2, 3), 2)[4]
    LeadingTerm(mode=4, order=2, seeds=(2, 3))
    """
    modes = _seeds(chain, seeds)
    last = order_of(order)
    sequence = excitation_sequence(chain.N, modes, last, potential=chain.potential)
    reached = max(k for k, excited in enumerate(sequence) if excited)
    _require_few_products(chain, sequence, reached, "order")
    terms: dict[int, LeadingTerm] = {}
    others = _closure(chain, set(modes)).difference(modes)
    for k in range(1, last + 1):
        if others == terms.keys():
            break
        terms = _leading(chain, modes, k)
    return dict(terms)


@public
def leading_term(chain: Chain, seeds: Sequence[int], q: int) -> Any:
    """Q_q^(k) at the order k of its first excitation (Lemma, Eq. Qqkr), without mu^k, in symbols.

    chain : one coupling or both. seeds : distinct modes D_0. q : a mode that they excite. All
        dimensionless, phases theta in radians.

    A SymEngine expression in A_i, theta_i, Omega_q and L_q(nu), as of a series in universal form.
    The work grows exponentially with k: a mode of an order with more than 2 10^6 products is
    refused. The Lemma is read with K_m^(0)(n) = delta_{m,n}, which it
    needs and does not print.
    Raises InputError for a seed, a mode that the seeds never excite, and as `leading_terms`.

    >>> sorted(map(str, leading_term(Chain(N=8, alpha=1), (1,), 2).free_symbols))
    ['A1', 'L_{2}(0)', 'L_{2}(2)', 'Omega_1', 'Omega_2', 'theta1']
    """
    require_chain(chain)
    modes = _seeds(chain, seeds)
    if integer(q, "q", 1) not in modes and q in _closure(chain, set(modes)):
        top = min(2 * chain.N, HIGHEST_ORDER)
        sequence = excitation_sequence(chain.N, modes, top, potential=chain.potential)
        earliest = next((k for k, excited in enumerate(sequence) if q in excited), top)
        _require_few_products(chain, sequence, earliest, "q")
        for k in range(1, 2 * chain.N):
            _require_few_products(chain, sequence, k, "q")
            terms = _leading(chain, modes, k)
            if q in terms:
                return terms[q].expression()
    allowed = f"a mode, no seed, that the seeds {modes} excite"
    raise InputError(
        "q", q, allowed, "other terms are zero, or A_q cos(theta_q) for a seed"
    )


def leading_factor(
    chain: Chain, seeds: Sequence[int], q: int, modes: Sequence[int], signs: Sequence[int]
) -> Any:
    """R_q^(k)(n, sigma) (Eq. Rqr).

    Its divisor is written as L_q(nu) = Omega_q^2 / (Omega_q^2 - (sigma.omega_n)^2).

    modes, signs : n in D_0^r and sigma in {-1,1}^r, which give k. At k = 0, L is 1 as in Eq. Lm.
    Raises InputError.

    >>> leading_factor(Chain(N=8, alpha=1), (1,), 2, (1, 1), (1, 1))
    (-1/4)*A1**2*Omega_1**2*L_{2}(2)/Omega_2
    """
    ordered, block = _block(chain, seeds, q, modes, signs)
    order = (len(block) - 1) // chain.degree_step
    nu = _harmonic(_monomial(ordered, block))
    return _factor(q, order, modes, nu)


def leading_kernel(
    chain: Chain, seeds: Sequence[int], q: int, modes: Sequence[int], signs: Sequence[int]
) -> Any:
    """K_q^(k)(n, sigma) by Eqs. Kkga and Kk as they stand.

    A polynomial of degree k-1 in the symbols L_m(nu).

    modes, signs as in `leading_factor`. At k = 0 it is delta_{q,n}. Not symmetric in the pairs
    (n_i, sigma_i). Raises InputError.

    >>> leading_kernel(Chain(N=8, alpha=1), (1,), 3, (1, 1, 1), (1, 1, 1))
    2*L_{2}(2)
    """
    ordered, block = _block(chain, seeds, q, modes, signs)
    kernels = _kernels(chain, ordered, block)
    return se.expand(kernels.get(q, se.Integer(0)))


@public
def lemma_holds(chain: Chain, seeds: Sequence[int], order: int) -> dict[int, bool]:
    """For every mode excited at 1 .. order: is the Lemma's term that of the recursion?

    It is asked as an identity.

    chain : one coupling or both. seeds : distinct modes D_0. order : the last k, a dimensionless
        integer from 0 up.

    Returns truth by mode. Excited means here: not identically zero in independent symbols
    L_q(nu). True: the same order, and the expanded difference of the two terms (Eq. Qqkr) is 0.
    Raises InputError, TooLarge.

    >>> lemma_holds(Chain(N=6, beta=1), (2, 3), 2)
    {1: True, 4: True, 5: True}
    """
    require_chain(chain)
    series = lindstedt(chain, seeds, order=order)
    predicted = leading_terms(chain, seeds, order)
    first = _first_orders(series)
    excited = {q for q, k in first.items() if k > 0}
    verdicts = {}
    for q in sorted(excited | predicted.keys()):
        term = predicted.get(q)
        verdicts[q] = term is not None and _agree(term, series, first.get(q))
    return verdicts


def _first_orders(series: LindstedtSeries) -> dict[int, int]:
    """By mode, the first order at which the recursion gives it a term."""
    first: dict[int, int] = {}
    for k, table in enumerate(series.coordinates):
        nonzero = series.tables.nonzero(table)
        for q in range(1, series.chain.N):
            if nonzero[:, q - 1].any():
                first.setdefault(q, k)
    return first


def _agree(term: LeadingTerm, series: LindstedtSeries, order: int | None) -> bool:
    """The same order, and the same polynomial in the symbols L."""
    if order != term.order:
        return False
    difference = term.expression() - series.term(term.mode, order)
    return bool(se.expand(difference) == 0)


@lru_cache(maxsize=16)
def _leading(chain: Chain, seeds: tuple[int, ...], order: int) -> dict[int, LeadingTerm]:
    """The Lemma order by order.

    D_k are the modes whose sum of products of earlier leading terms is not zero.
    """
    if order == 0:
        return {}
    terms = dict(_leading(chain, seeds, order - 1))
    weights = _weights(seeds, terms)
    levels = [seeds, *(_first_excited(terms, k) for k in range(1, order))]
    sums: dict[int, Polynomial] = defaultdict(lambda: defaultdict(int))
    for modes in _products(levels, chain.degree_step + 1):
        targets = product_modes(chain.N, modes) - weights.keys()
        if not targets:
            continue
        polynomial = reduce(_times, [weights[m] for m in modes])
        arrangements = _arrangements(modes)
        for q in targets:
            number = arrangements * _coupling(chain, q, modes)
            for monomial, value in polynomial.items():
                sums[q][monomial] += number * value
    for q in sorted(sums):
        kernels = _nonzero(sums[q])
        if kernels:
            terms[q] = LeadingTerm(q, order, seeds, kernels)
    return terms


def _first_excited(terms: Mapping[int, LeadingTerm], order: int) -> tuple[int, ...]:
    return tuple(q for q, term in terms.items() if term.order == order)


def _weights(
    seeds: tuple[int, ...], terms: Mapping[int, LeadingTerm]
) -> dict[int, Polynomial]:
    """What a mode brings into a product: of seeds L K = 1, of excited modes L_q K_q (Eq. Lm)."""
    weights: dict[int, Polynomial] = {}
    for q in seeds:
        weights[q] = {_monomial(seeds, ((q, sign),)): se.Integer(1) for sign in (1, -1)}
    for q, term in terms.items():
        polynomial = {}
        for monomial, kernel in term.kernels.items():
            polynomial[monomial] = _multiplier(q, _harmonic(monomial)) * kernel
        weights[q] = polynomial
    return weights


def _arrangements(modes: Sequence[int]) -> int:
    """In how many orders the factors of a product can stand."""
    repeated = Counter(modes).values()
    return factorial(len(modes)) // prod(map(factorial, repeated))


def _nonzero(polynomial: Polynomial) -> Polynomial:
    """Its expanded coefficients that are not zero, by ascending monomial."""
    expanded = {}
    for monomial, value in sorted(polynomial.items()):
        coefficient = se.expand(value)
        if coefficient != 0:
            expanded[monomial] = coefficient
    return expanded


def _products(levels: Sequence[Sequence[int]], factors: int) -> Iterator[tuple[int, ...]]:
    """Ascending (m_1, m_2) or (m_1, m_2, m_3) with m_i in D_{l_i} and sum l_i = k-1.

    The sets D_0 .. D_(k-1) are given.
    """
    last = len(levels) - 1
    for orders in combinations_with_replacement(range(len(levels)), factors):
        if sum(orders) == last:
            chosen = product(*(levels[l] for l in orders))
            yield from sorted({tuple(sorted(modes)) for modes in chosen})


def _times(left: Polynomial, right: Polynomial) -> Polynomial:
    result: Polynomial = defaultdict(int)
    for (a, x), (b, y) in product(left.items(), right.items()):
        exponents = tuple(i + j for i, j in zip(a, b, strict=True))
        result[exponents] += x * y
    return result


def _closure(chain: Chain, modes: set[int]) -> set[int]:
    """All modes that the couplings let in at some order."""
    larger = set(modes)
    for chosen in combinations_with_replacement(sorted(modes), chain.degree_step + 1):
        larger |= product_modes(chain.N, chosen)
    return modes if larger == modes else _closure(chain, larger)


@lru_cache(maxsize=1 << 14)
def _kernels(chain: Chain, seeds: tuple[int, ...], block: Block) -> dict[int, Any]:
    """K_q by mode: the sum of Eqs. Kkga, Kk over l_i and m_i; delta_{q,n} at k = 0.

    The block is cut into consecutive ones (Eqs. nvecta, nvectb).
    """
    if len(block) == 1:
        seed, _ = block[0]
        return {seed: se.Integer(1)}
    sums: dict[int, Any] = {}
    for ends in combinations_with_replacement(range(1, len(block)), chain.degree_step):
        cuts = (0, *ends, len(block))
        pieces = [block[a:b] for a, b in pairwise(cuts)]
        if not all(_is_block(piece, chain.degree_step) for piece in pieces):
            continue
        weights = [_weighted(chain, seeds, piece) for piece in pieces]
        for modes in product(*weights):
            factors = [w[m] for w, m in zip(weights, modes, strict=True)]
            value = prod(factors, start=se.Integer(1))
            for q in product_modes(chain.N, tuple(sorted(modes))):
                sums[q] = sums.get(q, 0) + _coupling(chain, q, modes) * value
    return sums


def _is_block(piece: Block, step: int) -> bool:
    """Whether a piece has a length k + 1 (alpha) or 2k + 1 (beta)."""
    return bool(piece) and (len(piece) - 1) % step == 0


def _weighted(chain: Chain, seeds: tuple[int, ...], block: Block) -> dict[int, Any]:
    """L_m K_m for m in D_l (Eq. Lm), with the sigma of the block."""
    kernels = _kernels(chain, seeds, block)
    l = (len(block) - 1) // chain.degree_step
    if l == 0:
        return kernels
    nu = _harmonic(_monomial(seeds, block))
    weighted = {}
    for m, term in _leading(chain, seeds, l).items():
        if term.order == l and m in kernels:
            weighted[m] = _multiplier(m, nu) * kernels[m]
    return weighted


def _require_few_products(
    chain: Chain, sequence: Sequence[Sequence[int]], order: int, argument: str
) -> None:
    """InputError for an order whose kernels have more products than end soon.

    sequence : the modes by the order that first excites them, the seeds first. A product is a tree
    whose leaves have two signs, and its factors are modes of lower orders. So it has as many
    choices of modes as the most that one order excites; the number of seeds is what was found for
    up to five.
    """
    factors, seeds = chain.degree_step + 1, len(sequence[0])
    widest = max(map(len, sequence[: max(order, 1)]))
    count = seeds * widest**factors * count_trees(order, factors, 2)
    if count > MOST_PRODUCTS:
        allowed = f"first excited at an order with at most {MOST_PRODUCTS:,} products"
        advice = "take a lower order, or a mode nearer to the seeds"
        raise InputError(argument, f"of order {order}", allowed, advice)


def _factor(q: int, order: int, modes: Sequence[int], nu: tuple[int, ...]) -> Any:
    """R_q^(k) of Eq. Rqr."""
    amplitudes = [se.Symbol(f"Omega_{n}") * se.Symbol(f"A{n}") for n in modes]
    multiplier = _multiplier(q, nu) if order else se.Integer(1)
    sign = se.Integer((-1) ** order)
    number = sign / se.Integer(2) ** len(modes)
    return number * se.Mul(*amplitudes) * multiplier / se.Symbol(f"Omega_{q}")


def _multiplier(q: int, nu: tuple[int, ...]) -> Any:
    """L_q(nu) = L_q(-nu), named by the harmonic whose first nonzero entry is positive."""
    opposite = tuple(-n for n in nu)
    return multiplier_symbol(q, max(nu, opposite))


def _harmonic(monomial: Monomial) -> tuple[int, ...]:
    return tuple(p - n for p, n in zip(monomial[::2], monomial[1::2], strict=True))


def _monomial(seeds: tuple[int, ...], block: Block) -> Monomial:
    return tuple(block.count((q, sign)) for q in seeds for sign in (1, -1))


def _coupling(chain: Chain, q: int, modes: Sequence[int]) -> int:
    return chain.B(q, *modes) if len(modes) == 2 else chain.C(q, *modes)


def _seeds(chain: Chain, seeds: Sequence[int]) -> tuple[int, ...]:
    if chain.model not in ("alpha", "beta"):
        allowed = "one coupling, alpha or beta"
        raise InputError(
            "chain", chain, allowed, "the Lemma is stated for each model alone"
        )
    return tuple(sorted(seed_modes(seeds, chain.N)))


def _block(
    chain: Chain, seeds: Sequence[int], q: int, modes: Sequence[int], signs: Sequence[int]
) -> tuple[tuple[int, ...], Block]:
    """Seeds in ascending order, and the pairs (n_i, sigma_i), sigma in Sigma^r (Eq. set)."""
    ordered = _seeds(chain, seeds)
    if integer(q, "q", 1) >= chain.N:
        raise InputError("q", q, f"1..{chain.N - 1}", "name a mode of the chain")
    whole_orders = modes and (len(modes) - 1) % chain.degree_step == 0
    if not whole_orders or not set(modes) <= set(ordered):
        allowed = f"r = k+1 (alpha) or 2k+1 (beta) of the seeds {ordered}"
        raise InputError("modes", tuple(modes), allowed, "take n in D_0^r")
    if len(signs) != len(modes) or not set(signs) <= {1, -1}:
        allowed = f"{len(modes)} numbers 1 or -1"
        raise InputError("signs", tuple(signs), allowed, "take sigma in {-1,1}^r")
    pairs = zip(map(int, modes), map(int, signs), strict=True)
    return ordered, tuple(pairs)
