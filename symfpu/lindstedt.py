"""The recursion of the Poincare-Lindstedt series (Eqs. moda, modb), written once for every ring and both models.

With u_q = Omega_q Q_q and multipliers L_q(nu), degree by degree in the seed amplitudes:
    u_q[nu] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - a sum B u u - b sum C u u u)[nu],
and W_q^(k) makes the bracket vanish at the secular harmonic nu = e_q of a seed, where u_q gets no term (the gauge of A_q).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
import psutil

from symfpu.algebra.dense import predicted_bytes
from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.grading import Grading
from symfpu.algebra.residue import ResidueRing
from symfpu.algebra.ring import Ring
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.symbolic import SymbolicRing
from symfpu.chain import Chain
from symfpu.divisors import Float64Divisors, ResidueDivisors, UniversalDivisors
from symfpu.errors import InputError, TooLarge
from symfpu.exact import Number, exact, integer, seed_modes
from symfpu.series import LindstedtSeries

Progress = Callable[[int, int], None]
SYMBOLIC_GROWTH = 4  # factor by which an expanded coefficient grows with the order, about


def _float64(chain: Chain, space: CosineModes, frequencies: Sequence[Fraction] | None) -> tuple[Ring, Any]:
    if frequencies is None:
        raise InputError("frequencies", None, "one number for each seed in the float64 ring", "give frequencies=, or ring='symbolic'")
    return Float64Ring(space), Float64Divisors(chain, space.seeds, frequencies, space.grading.degree)


def _symbolic(chain: Chain, space: CosineModes, frequencies: Sequence[Fraction] | None) -> tuple[Ring, Any]:
    return SymbolicRing(space), UniversalDivisors(chain, space.seeds)


def _nested(chain: Chain, space: CosineModes, frequencies: Sequence[Fraction] | None) -> tuple[Ring, Any]:
    return SymbolicRing(space, nested=True), UniversalDivisors(chain, space.seeds)


RINGS: dict[str, Callable[[Chain, CosineModes, Sequence[Fraction] | None], tuple[Ring, Any]]] = {
    "float64": _float64,
    "symbolic": _symbolic,
    "nested": _nested,
}


def lindstedt(
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Sequence[Number] | None = None,
    order: int = 0,
    *,
    ring: str | None = None,
    progress: Progress | None = None,
) -> LindstedtSeries:
    """The Poincare-Lindstedt series of a q-torus with free seed amplitudes (Eqs. qser, omeser).

    chain : the model. seeds : distinct modes D_0. frequencies : omega_q of each seed, exact numbers; None gives the
    universal form with symbols L_q(nu). order : K of the coordinates and of the frequency corrections, from 0 up; order
    k has degree k+1 in the amplitudes (2k+1 if alpha = 0, and with both couplings beta enters two orders up).
    ring : 'float64', or in universal form 'symbolic' (expanded) or 'nested'; default by whether frequencies are given.
    progress : called as (order done, orders).

    Raises InputError for arguments out of range, TooLarge before allocating what would not fit into memory,
    ResonantDivisor at the first divisor that is zero.

    >>> series = lindstedt(Chain(N=8, alpha="0.25"), seeds=(1,), order=1)
    >>> series.coordinates[1][-1, 1], series.coordinates[1][-1, 0]
    (-L_{2}(2), 0)
    """
    seeds = seed_modes(seeds, chain.N)
    order = integer(order, "order", 0)
    exact_frequencies = None if frequencies is None else _frequencies(frequencies, seeds)
    seeds, exact_frequencies = _ascending(seeds, exact_frequencies)
    ring = ring or ("symbolic" if frequencies is None else "float64")
    if ring not in RINGS:
        raise InputError("ring", ring, f"one of {', '.join(RINGS)}", "name a ring or leave it out")
    check_size(chain, seeds, order, ring)
    space = _space(chain, seeds, order)
    arithmetic, divisors = RINGS[ring](chain, space, exact_frequencies)
    return _series(chain, exact_frequencies, order, arithmetic, divisors, progress)


@dataclass(frozen=True)
class ResiduePoint:
    """A prime p = 1 mod 4N, an element of order 4N and the chosen frequencies, all modulo p."""

    prime: int
    root: int
    frequencies: tuple[int, ...]


def residue_series(
    chain: Chain, seeds: Sequence[int], point: ResiduePoint, order: int, *, workers: int | None = None, progress: Progress | None = None
) -> LindstedtSeries:
    """The same series modulo a prime: `coordinates` and `corrections` hold residues in -p/2 .. p/2, as doubles.

    workers : threads; default one for each core. Raises VanishingResidue where a divisor vanishes modulo the prime,
    TooLarge as `lindstedt` does.
    """
    seeds = tuple(sorted(seed_modes(seeds, chain.N)))
    check_size(chain, seeds, integer(order, "order", 0), "residue")
    space = _space(chain, seeds, order)
    ring = ResidueRing(space, point.prime, point.root, workers=workers)
    return _series(chain, None, order, ring, ResidueDivisors(chain, seeds, ring, point.frequencies), progress)


@lru_cache(maxsize=4)
def shared_grading(seeds: int, degree: int) -> Grading:
    """The grading of so many seeds; kept, because tables do not depend on the chain."""
    return Grading(seeds, degree)


def _space(chain: Chain, seeds: tuple[int, ...], order: int) -> CosineModes:
    """Modes and monomials of a series; its first order is a plain product of the seeds."""
    return CosineModes(chain.N, seeds, shared_grading(len(seeds), 1 + chain.degree_step * order), 1 + chain.degree_step)


def _series(
    chain: Chain, frequencies: tuple[Fraction, ...] | None, order: int, arithmetic: Ring, divisors: Any, progress: Progress | None
) -> LindstedtSeries:
    """Run the recursion and collect what the ring holds."""
    _run(arithmetic, divisors, chain, order, progress)
    modes, corrections, scale = arithmetic.results()
    seeds = arithmetic.space.seeds
    return LindstedtSeries(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        order=order,
        ring=arithmetic.name,
        grading=arithmetic.space.grading,
        coordinates=tuple(modes),
        corrections=(np.zeros((0, len(seeds))), *corrections),
        scale=scale,
        smallest_divisors=divisors.smallest(),
        multiply_adds=getattr(arithmetic, "multiply_adds", 0),
    )


def _run(ring: Ring, divisors: Any, chain: Chain, order: int, progress: Progress | None) -> None:
    """The recursion itself: fills the ring degree by degree."""
    quadratic, cubic = chain.relative_couplings
    ring.put(1, ring.seed_terms())
    for k in range(1, order + 1):
        degree = 1 + chain.degree_step * k
        parts = []
        if quadratic:
            parts.append((ring.number(quadratic), ring.square(degree)))
        if cubic and degree >= 3:
            parts.append((ring.number(cubic), ring.cube(degree)))
        force = ring.project(degree, parts)
        ring.correct(degree - 1, ring.secular(degree, force))
        harmonics, _ = ring.space.grading.harmonics(degree)
        multipliers = divisors.multipliers(harmonics, ring.space.mask_by_harmonic(degree), k)
        ring.put(degree, ring.solve(degree, ring.corrected(degree), force, multipliers))
        if progress:
            progress(k, order)


def _frequencies(frequencies: Sequence[Number], seeds: tuple[int, ...]) -> tuple[Fraction, ...]:
    if isinstance(frequencies, (str, Mapping)) or not isinstance(frequencies, Iterable):
        raise InputError("frequencies", frequencies, "a sequence, one positive number for each seed", "list them in the order of the seeds")
    frequencies = list(frequencies)
    values = tuple(exact(w, "frequencies") for w in frequencies)
    if len(values) != len(seeds):
        raise InputError("frequencies", tuple(map(str, frequencies)), f"one number for each of the seeds {seeds}", "add or drop some")
    for q, w, typed in zip(seeds, values, frequencies, strict=True):
        if not Fraction(1, 10**6) <= w <= 10**6:
            allowed = "a positive finite number (1e-6 to 1e6)"
            raise InputError(f"frequencies, omega_{q}", str(typed), allowed, "take one near the linear frequency")
    return values


def _ascending(seeds: tuple[int, ...], frequencies: tuple[Fraction, ...] | None) -> tuple[tuple[int, ...], tuple[Fraction, ...] | None]:
    """Seeds in ascending order, each with its own frequency."""
    order = sorted(range(len(seeds)), key=lambda i: seeds[i])
    return tuple(seeds[i] for i in order), None if frequencies is None else tuple(frequencies[i] for i in order)


def check_size(chain: Chain, seeds: tuple[int, ...], order: int, ring: str) -> None:
    """Refuse an order whose arrays would not fit, before anything is allocated."""
    free = psutil.virtual_memory().available
    if _needed(chain, len(seeds), order, ring) <= free:
        return
    largest = -1
    while _needed(chain, len(seeds), largest + 1, ring) <= free:
        largest += 1
    raise TooLarge(order, _needed(chain, len(seeds), order, ring), free, largest)


def _needed(chain: Chain, seeds: int, order: int, ring: str) -> int:
    size = predicted_bytes(chain.N, seeds, 1 + chain.degree_step * order, cubic=chain.beta != 0)
    return size * SYMBOLIC_GROWTH ** min(order, 100) if ring in ("symbolic", "nested") else size
