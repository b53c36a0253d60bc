"""The recursion of the Poincare-Lindstedt series (Eqs. moda, modb), once for all rings and models.

With u_q = Omega_q Q_q and multipliers L_q(nu), degree by degree in the seed amplitudes:
    u_q[nu] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - a sum B u u - b sum C u u u)[nu],
and W_q^(k) makes the bracket vanish at the secular harmonic nu = e_q of a seed, where u_q gets no
term (the gauge of A_q).
"""

from __future__ import annotations

import numpy as np

from symfpu.algebra.ring import Ring
from symfpu.algebra.selection import Modes
from symfpu.chain.chain import Chain
from symfpu.files.progress import Progress
from symfpu.series.divisors import Divisors
from symfpu.series.force import force_of
from symfpu.series.rings import Frequencies, RingKind
from symfpu.series.series import LindstedtSeries


def run_recursion(
    ring: Ring, divisors: Divisors, chain: Chain, order: int, progress: Progress | None
) -> None:
    """The recursion itself (Eqs. moda, modb), from the seeds (Eq. qq0).

    It fills the ring degree by degree.
    """
    law = force_of(ring, chain, 1 + chain.degree_step * order)
    ring.put(1, ring.seed_terms())
    for k in range(1, order + 1):
        degree = 1 + chain.degree_step * k
        force = ring.project(degree, law.parts(degree))
        secular = ring.secular(degree, force)
        ring.correct(degree - 1, secular)
        harmonics, _ = ring.space.grading.harmonics(degree)
        carried = ring.space.mask_by_harmonic(degree)
        multipliers = divisors.multipliers(harmonics, carried, k)
        ring.put(degree, ring.solve(degree, ring.corrected(degree), force, multipliers))
        if progress:
            progress("series", k / order)


def ring_series(
    chain: Chain,
    frequencies: Frequencies,
    order: int,
    arithmetic: Ring,
    divisors: Divisors,
    progress: Progress | None,
) -> LindstedtSeries:
    """Run the recursion and collect what the ring holds."""
    run_recursion(arithmetic, divisors, chain, order, progress)
    modes, corrections, unit = arithmetic.results()
    space = arithmetic.space
    none = np.zeros((0, len(space.seeds)))
    return LindstedtSeries(
        chain=chain,
        seeds=space.seeds,
        frequencies=frequencies,
        order=order,
        ring=arithmetic.name,
        grading=space.grading,
        coordinates=tuple(modes),
        corrections=(none, *corrections),
        unit=unit,
        smallest_divisors=divisors.smallest(),
        multiply_adds=arithmetic.multiply_adds,
    )


def named_series(
    kind: RingKind,
    chain: Chain,
    space: Modes,
    frequencies: Frequencies,
    order: int,
    progress: Progress | None,
) -> LindstedtSeries:
    """The series over a ring that a name is enough for."""
    assert kind.ring is not None
    assert kind.divisors is not None
    divisors = kind.divisors(chain, space, frequencies)
    given = frequencies if kind.numeric else None
    return ring_series(chain, given, order, kind.ring(space), divisors, progress)
