"""Integer relations between the linear frequencies, by exact rank over the rationals."""

from __future__ import annotations

from collections.abc import Mapping

import flint

from symfpu.numbers.public import public
from symfpu.numbers.typed import length_of


@public
def frequency_rank(N: int) -> int:
    """Rank over the rationals of Omega_1 .. Omega_(N-1); N - 1 if they are incommensurable.

    N : number of bonds, at least 2. The rank is a dimensionless integer, exact.

    All 2 cos(k pi / 2N), Omega_q at k = N - q, span the real field of the 4N-th roots of unity,
    of degree phi(4N)/2 = phi(2N) (Euler's phi). Without that of k = 0, which is 2, they still do
    if N has an odd factor p: the p-th roots of unity add up to zero. If N is a power of 2 all N of
    them are independent, and the N - 1 frequencies too.
    The paper states that no relation holds where N - 1 is prime (section 3.1); it is N that must
    be: N = 6 has rank 4, N = 7 rank 6.
    Raises InputError.

    >>> frequency_rank(7), frequency_rank(8), frequency_rank(6)
    (6, 7, 4)
    """
    N = length_of(N)
    return min(N - 1, int(flint.fmpz(2 * N).euler_phi()))


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
