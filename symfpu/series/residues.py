"""The series modulo a prime, for exact statements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from symfpu.algebra.residue import ResidueRing
from symfpu.chain.chain import Chain
from symfpu.files.progress import Progress
from symfpu.numbers.typed import order_of, seed_modes
from symfpu.series.coefficients import ResiduePoint
from symfpu.series.divisors import ResidueDivisors
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import ring_series
from symfpu.series.series import LindstedtSeries


def residue_series(
    chain: Chain,
    seeds: Sequence[int],
    point: ResiduePoint,
    order: int,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
) -> LindstedtSeries:
    """The same series modulo a prime.

    `coordinates` and `corrections` hold residues in -p/2 .. p/2, as doubles.

    workers : threads; default one for each core. Raises VanishingResidue where a divisor vanishes
    modulo the prime, TooLarge as `lindstedt` does.
    """
    seeds = tuple(sorted(seed_modes(seeds, chain.N)))
    check_size(chain, seeds, order_of(order), "residue")
    space = monomial_space(chain, seeds, order)
    ring = ResidueRing(space, point.prime, point.root, workers=workers)
    divisors = ResidueDivisors(chain, space, ring, point.frequencies)
    series = ring_series(chain, None, order, ring, divisors, progress)
    return replace(series, point=point)
