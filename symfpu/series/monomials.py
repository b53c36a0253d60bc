"""Modes and monomials of a series."""

from __future__ import annotations

from functools import lru_cache

from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes
from symfpu.chain.chain import Chain


def monomial_space(
    chain: Chain, seeds: tuple[int, ...], order: int, *, phantom: bool = False
) -> CosineModes:
    """Modes and monomials of a series; its first force is a plain product of the seeds.

    phantom : whether the first seed's amplitude is needed to its first power only.
    """
    degree = 1 + chain.degree_step * order
    grading = shared_grading(len(seeds), degree, phantom=phantom)
    return CosineModes(chain.N, seeds, grading, chain.lowest_force)


@lru_cache(maxsize=4)
def shared_grading(seeds: int, degree: int, *, phantom: bool = False) -> Grading:
    """The grading of so many seeds; kept, because tables do not depend on the chain."""
    return Grading(seeds, degree, phantom)
