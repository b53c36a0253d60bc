"""Solutions with fixed ends as standing waves of a ring of twice the length, and back."""

from __future__ import annotations

from dataclasses import replace

from symfpu.chain.chain import Chain
from symfpu.numbers.public import public
from symfpu.tori.columns import half_of
from symfpu.tori.torus import GIVEN, Torus, require_fixed_solution


@public
def unfold(solution: Torus) -> Torus:
    """A solution with fixed ends as the odd solution of the ring of twice the length.

    solution : any torus or breather of a chain of N bonds; dimensionless. x_0 = x_N = 0 stay at
        rest, x_(2N-j) = -x_j. Its modes are standing waves of the modes q and -q of the ring,
        whose energies are those of the chain. Ours. Raises InputError.

    >>> import symfpu
    >>> unfold(symfpu.torus(Chain(N=8, alpha="0.3"), (1,), amplitudes={1: "0.4"}))
    Torus(N=16, alpha=0.3, ends='periodic', omega_1=..., A_1=0.4, H=...,
    ... harmonics, residual ...)
    """
    require_fixed_solution(solution, "solution")
    fixed = solution.chain
    ring = Chain(2 * fixed.N, potential=fixed.potential, ends="periodic")
    return replace(solution, chain=ring, origin=GIVEN)


def folded(torus: Torus) -> Torus:
    """The torus with fixed ends that standing waves of a ring unfold, in doubles."""
    return replace(torus.in_doubles(), chain=half_of(torus.chain))
