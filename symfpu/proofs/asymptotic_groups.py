"""Packets at an end of the spectrum: the energies of section 6.1, derived instead of estimated.

Eqs. eksa and eksp estimate the energy of the middle mode of a group D_k, and Eqs. eksa2 and eksp2
are their logarithms. Here both come from the recursion, exactly, with the next powers of M = s/N.
"""

from __future__ import annotations

from typing import Any

import symengine as se

from symfpu.chain.chain import Chain
from symfpu.chain.length import HighMode
from symfpu.chain.symbols import energy_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, rational
from symfpu.proofs.asymptotics import asymptotic_energy, require_symbolic
from symfpu.series.closed_forms import collect_terms

ENDS = ("low", "high")


@public
def asymptotic_group_energy(
    chain: Chain, s: int, k: int, *, terms: int = 2, end: str = "low"
) -> Any:
    """E^(k), the energy of the middle mode of D_k, derived: s seeds of the same energy at an end.

    The seeds are 1 .. s, or N-s .. N-1. The middle modes are ks + [s/2] (alpha) and 2ks (beta),
    as in section 6.1, or N - 2ks; for one seed the one mode excited, k + 1 and 2k + 1.

    chain : its couplings; N has to be a symbol. s : how many seeds. k : order, from 0 up.
    terms : how many powers of 1/N^2. end : 'low', or 'high' for potentials that are even: those of
        others excite both ends at once (`asymptotic_energy` takes any mode). All is dimensionless.

    Returns a SymEngine expression in N and epsilon = E/N, E the energy of the seeds. It is the
    sum that Eqs. eksa and eksp estimate, over all products of seeds, at random phases. Differs
    from them in the factor: C_k(s) (epsilon/M) lambda^k with a rational C_k(s), which
    docs/asymptotics.md lists, (k + 1)^2 for one seed of alpha.
    Raises InputError for a chain with a number for N, for s, k or end out of range.

    >>> asymptotic_group_energy(Chain("N", alpha=1), 1, 2, terms=1)
    9*N**9*epsilon**3/pi**8
    """
    s, k = _packet(chain, s, k, end)
    formula = asymptotic_energy(
        chain, _seeds(s, end), _middle(chain, s, k, end), terms=terms
    )
    share = se.Symbol("epsilon") * se.Symbol("N") / s
    labels = [HighMode(-q) if end == "high" else q for q in range(1, s + 1)]
    return se.expand(formula.subs({energy_symbol(q): share for q in labels}))


@public
def asymptotic_profile(
    chain: Chain, s: int, k: int, *, terms: int = 2, end: str = "low"
) -> Any:
    """log e_kappa of the middle mode of D_k, derived, with the next powers of M^2.

    e_kappa = E^(k)/E of `asymptotic_group_energy`, where Eqs. eksa2 and eksp2 have their lines:
    with kappa = (k + 1/2) M, or 2k M, the first term is log(lambda) kappa/M and what it has at
    kappa = 0. The logarithm is the natural one.

    chain : one coupling; N has to be a symbol. s, k, end : as of `asymptotic_group_energy`.
    terms : how many powers of M^2, the constant one included. All is dimensionless.

    Returns a SymEngine expression in lambda and M = s/N, lambda = alpha^2 epsilon/(pi M)^4, or
    beta epsilon/(pi M)^2: k log lambda + log(C_k(s)/s) - r M^2 ..., where the paper has
    (k + 1/2)^2, or 1, for C_k(s), and nothing for r.
    Raises InputError as there, and where the energies do not go with powers of lambda.

    >>> derived = asymptotic_profile(Chain("N", alpha=1), 1, 2)
    >>> derived - 2 * se.log(se.Symbol("lambda")) - se.log(9)  # k log lambda, C_k(1) = (k + 1)^2
    (-5/6)*M**2*pi**2
    """
    energy = asymptotic_group_energy(chain, s, k, terms=terms, end=end)
    s, k = integer(s, "s", 1), integer(k, "k", 0)
    parameter, exponent = _parameter(chain, s), k * chain.degree_step
    share = se.Symbol("epsilon") * se.Symbol("N")
    factors = _factors(chain, energy / (share * parameter**exponent), terms)
    slope = exponent * se.log(se.Symbol("lambda")) + se.log(factors[0])
    # pi^2/N^2 is (pi M/s)^2
    unit = (se.pi * se.Symbol("M") / s) ** 2
    relative = [c / factors[0] for c in factors]
    bends = [c * unit**n for n, c in enumerate(_logarithm(relative))]
    return se.Add(slope, *bends)


def _parameter(chain: Chain, s: int) -> Any:
    """lambda of s seeds in epsilon and N."""
    coupling, width = abs(rational(chain.unit_coupling)), se.pi * s / se.Symbol("N")
    epsilon = se.Symbol("epsilon")
    if chain.degree_step == 1:
        return coupling**2 * epsilon / width**4
    return coupling * epsilon / width**2


def _factors(chain: Chain, ratio: Any, count: int) -> list[Any]:
    """c_0, c_1, ... of c_0 + c_1 (pi/N)^2 + ...; InputError for what is no such series."""
    N = se.Symbol("N")
    terms = collect_terms(ratio.subs({N: se.pi * N}), [N])
    factors = [terms.pop(N ** (-2 * n), se.Integer(0)) for n in range(count)]
    if terms or factors[0] == 0 or any(c.free_symbols for c in factors):
        allowed = "a chain with alpha, or with beta alone"
        raise InputError("chain", chain, allowed, "see asymptotic_group_energy")
    return factors


def _logarithm(factors: list[Any]) -> list[Any]:
    """Of a power series that begins with 1."""
    found = [se.Integer(0)]
    for n in range(1, len(factors)):
        earlier = sum((j * found[j] * factors[n - j] for j in range(1, n)), se.Integer(0))
        found.append(factors[n] - earlier / n)
    return found


def _packet(chain: Chain, s: int, k: int, end: str) -> tuple[int, int]:
    """s and k, checked with the rest."""
    require_symbolic(chain)
    if end not in ENDS:
        raise InputError("end", end, "'low' or 'high'", "leave it out for modes 1 .. s")
    if end == "high" and chain.degree_step == 1:
        allowed = "'low' where V is not even: high seeds excite both ends at once"
        raise InputError("end", end, allowed, "ask asymptotic_energy for one mode")
    return integer(s, "s", 1), integer(k, "k", 0)


def _seeds(s: int, end: str) -> list[int | str]:
    return [f"N-{q}" if end == "high" else q for q in range(1, s + 1)]


def _middle(chain: Chain, s: int, k: int, end: str) -> int | str:
    """The middle mode of D_k."""
    if chain.degree_step == 1:
        return k * s + (s // 2 or 1)
    middle = 2 * k * s if s > 1 and k else 2 * k + (s + 1) // 2
    return f"N-{middle}" if end == "high" else middle
