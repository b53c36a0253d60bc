"""Modes and monomials of a series."""

from __future__ import annotations

from functools import lru_cache

from symfpu.algebra.grading import Grading
from symfpu.algebra.selection import CosineModes, Modes
from symfpu.algebra.waves import WaveModes
from symfpu.chain.chain import Chain


def monomial_space(
    chain: Chain, seeds: tuple[int, ...], order: int, *, phantom: bool = False
) -> CosineModes:
    """Those of fixed ends; the first force is a plain product of the seeds.

    phantom : whether the first seed's amplitude is needed to its first power only.
    """
    grading = _grading_of(chain, seeds, order, phantom=phantom)
    return CosineModes(chain.N, seeds, grading, chain.lowest_force)


def wave_space(
    chain: Chain, seeds: tuple[int, ...], order: int, *, phantom: bool = False
) -> WaveModes:
    """Those of travelling waves on a ring, likewise."""
    grading = _grading_of(chain, seeds, order, phantom=phantom)
    return WaveModes(chain.N, seeds, grading)


def modes_of(chain: Chain, seeds: tuple[int, ...], grading: Grading) -> Modes:
    """The modes of a chain of either ends, where selection rules are not asked for."""
    kind = WaveModes if chain.periodic else CosineModes
    return kind(chain.N, seeds, grading)


def _grading_of(
    chain: Chain, seeds: tuple[int, ...], order: int, *, phantom: bool
) -> Grading:
    return shared_grading(len(seeds), 1 + chain.degree_step * order, phantom=phantom)


@lru_cache(maxsize=4)
def shared_grading(seeds: int, degree: int, *, phantom: bool = False) -> Grading:
    """The grading of so many seeds; kept, because tables do not depend on the chain."""
    return Grading(seeds, degree, phantom)
