"""Integer relations between the linear frequencies, by exact rank over the rationals."""

from __future__ import annotations

from collections.abc import Mapping

import flint

from symfpu.numbers.typed import integer


def frequency_rank(N: int) -> int:
    """Rank over the rationals of Omega_1 .. Omega_(N-1); N - 1 if they are incommensurable.

    N : number of bonds, at least 2. The rank is a dimensionless integer, exact.

    Omega_q = -i (x^q - x^-q) with x a primitive 4N-th root of unity; dropping the common factor,
    each frequency is an integer vector of powers of x modulo the cyclotomic polynomial of 4N. The
    paper states that no relation holds where N - 1 is prime (section 3.1); it is N that must be:
    N = 6 has rank 4, N = 7 rank 6.
    Raises InputError.

    >>> frequency_rank(7), frequency_rank(8), frequency_rank(6)
    (6, 7, 4)
    """
    from sympy import QQ, Poly, Symbol, cyclotomic_poly
    from sympy.polys.matrices import DomainMatrix

    N = integer(N, "N", 2)
    x = Symbol("x")
    modulus = Poly(cyclotomic_poly(4 * N, x), x, domain=QQ)
    degree = modulus.degree()
    rows = []
    for q in range(1, N):
        sine = Poly.from_dict({(q,): 1, (4 * N - q,): -1}, x, domain=QQ)
        remainder = sine.rem(modulus)
        rows.append([QQ(int(remainder.nth(k))) for k in range(degree)])
    matrix = DomainMatrix(rows, (N - 1, degree), QQ)
    return int(matrix.rank())


def frequencies_cancel(turn: int, combination: Mapping[int, int]) -> bool:
    """Whether sum n_q Omega_q = 0 exactly, Omega_q = 2 sin(q pi / turn), |q| below turn.

    Decided by the cyclotomic polynomial of 2 turn.

    >>> frequencies_cancel(8, {4: 1, -4: -1}), frequencies_cancel(6, {1: 2, 3: -1})
    (True, True)
    >>> frequencies_cancel(8, {4: 1, 2: -1})
    False
    """
    period = 2 * turn
    powers = [0] * period
    for q, count in combination.items():
        powers[abs(q) % period] += count
        powers[-abs(q) % period] -= count
    remainder = flint.fmpz_poly(powers) % flint.fmpz_poly.cyclotomic(period)
    return not any(remainder.coeffs())
