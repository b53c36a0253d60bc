"""The lowest frequency corrections at the linear frequencies, in closed form (Appendix A).

This is Eq. omamid with the right bracket, and Eq. omebguess where only beta acts. In other
potentials alpha is c_3 and beta is c_4: no higher coefficient enters at this order.

For generic modes, mu^2 omega_q^(2) = (alpha^2/2N) Omega_q [(1 - 3/4 Omega_q^2) A_q^2 - sum_n
Omega_n^2 A_n^2] and mu omega_q^(1) = (beta/2N) Omega_q [9/8 Omega_q^2 A_q^2 + 3/2 sum_n Omega_n^2
A_n^2], n running over the other seeds. Special modes: for q = N/2 the first bracket of alpha is 0
and 9/8 becomes 3/4; for q + n = N the term of n is halved in both. N/3 and 2N/3 are not special.

At beta = 2 alpha^2/3 both add up to (alpha^2/2N) Omega_q A_q^2, for every mode and without any
other seed: these are the couplings of the Toda lattice, whose Birkhoff normal form of this order
is a sum of squares of the single actions. Higher orders: `frequency_expansion`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import symengine as se

from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.length import seed_labels
from symfpu.chain.symbols import amplitude_symbol, linear_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, rational, seed_modes

LARGEST_AMPLITUDE = 1e25


def shift_coefficients(
    N: int, q: int, n: int
) -> tuple[tuple[Fraction, Fraction], Fraction]:
    """Closed form of the shift of mode q by the amplitude of mode n, as exact numbers ((a, b), c).

    omega_q - Omega_q = Omega_q A_n^2 [(alpha^2/2N) (a + b Omega_n^2) + (beta/2N) c Omega_n^2].
    """
    if q == n:
        alpha = (Fraction(0), Fraction(0)) if 2 * q == N else (Fraction(1), Fraction(-3, 4))
        return alpha, Fraction(3, 4) if 2 * q == N else Fraction(9, 8)
    half = Fraction(1, 2 if q + n == N else 1)
    return (Fraction(0), -half), Fraction(3, 2) * half


@public
def frequency_shift(chain: Chain, amplitudes: Mapping[int, float]) -> dict[int, float]:
    """omega_q - Omega_q of every seed to lowest order, for seed amplitudes by mode; dimensionless.

    chain : of any potential; c_3 counts with its square, c_4 with its first power.
    amplitudes : A_q by seed, of cos(omega_q t + phi_q) in Q_q.

    Returns the shifts by seed, the lowest terms of Eq. omeser with the linear frequencies in the
    divisors. In closed form, ours: the sums over modes of the recursion are done. Raises
    InputError for modes outside the chain and amplitudes that are not finite numbers.
    `frequency_expansion` has higher orders.

    >>> round(frequency_shift(Chain(N=2, beta=1), {1: 0.1})[1], 12)  # sqrt(2)/4 3/4 2 0.01
    0.005303300859
    """
    require_chain(chain)
    if not isinstance(amplitudes, Mapping):
        allowed = "a mapping from modes to numbers"
        raise InputError("amplitudes", amplitudes, allowed, "write it as {mode: amplitude}")
    seeds = seed_modes(amplitudes, chain.N)
    numbers = {q: _amplitude(amplitudes[q], f"amplitudes, A_{q}") for q in seeds}
    linear = chain.frequencies()
    alpha, beta = (chain.potential.coefficient(n) for n in (3, 4))
    quadratic = float(alpha**2) / (2 * chain.N)
    cubic = float(beta) / (2 * chain.N)
    shifts = {}
    for q in seeds:
        total = 0.0
        for n in seeds:
            (a, b), c = shift_coefficients(chain.N, q, n)
            square = float(linear[n - 1]) ** 2
            by_alpha = quadratic * (float(a) + float(b) * square)
            by_beta = cubic * float(c) * square
            total += numbers[n] ** 2 * (by_alpha + by_beta)
        shifts[q] = float(linear[q - 1]) * total
    return shifts


@public
def frequency_shift_formula(chain: Chain, seeds: Sequence[int | str]) -> dict[int, Any]:
    """omega_q - Omega_q of every seed to lowest order, as expressions in Omega_q, A{q}.

    chain : its exact c_3 and c_4 stand in the formulas.
    seeds : distinct modes, whose amplitudes A{q} are symbols; all is dimensionless. Where N is a
        symbol also 'N-1', 'N-2', ...; the formulas then hold from some N on, where the modes are
        none of the special ones but for q + n = N.

    Returns expressions by seed, the closed form (ours) of the lowest terms of Eq. omeser, whose
    numbers `frequency_shift` gives. Raises InputError for modes outside the chain or repeated.

    >>> frequency_shift_formula(Chain(N=12, potential="toda:1"), (1, 5))
    {1: (1/24)*A1**2*Omega_1, 5: (1/24)*A5**2*Omega_5}
    >>> frequency_shift_formula(Chain("N", beta=1), (1,))
    {1: (9/16)*A1**2*Omega_1**3/N}
    """
    require_chain(chain)
    symbolic = chain.symbolic
    modes = seed_labels(seeds) if symbolic else seed_modes(seeds, chain.N)
    length = se.Symbol("N") if symbolic else chain.N
    alpha, beta = (chain.potential.coefficient(n) for n in (3, 4))
    quadratic = rational(alpha**2) / (2 * length)
    cubic = rational(beta) / (2 * length)
    formulas = {}
    for q in modes:
        terms = []
        for n in modes:
            # labels of modes count N as 0
            (a, b), c = shift_coefficients(0 if symbolic else chain.N, q, n)
            square = linear_symbol(n) ** 2
            by_alpha = quadratic * (rational(a) + rational(b) * square)
            by_beta = cubic * rational(c) * square
            shift = (by_alpha + by_beta) * amplitude_symbol(n) ** 2 * linear_symbol(q)
            terms.append(se.expand(shift))
        formulas[q] = se.Add(*terms)
    return formulas


def _amplitude(value: Number, name: str) -> float:
    """A number whose fourth power, times that of a coupling, is a double."""
    size = double(value, name)
    if abs(size) > LARGEST_AMPLITUDE:
        allowed = f"a number up to {LARGEST_AMPLITUDE:.0e}"
        raise InputError(name, value, allowed, "rescale the amplitudes")
    return size
