"""Means over a gap: int f(e + x) dx / (pi sqrt(w^2 - x^2)) from -w to w.

With x = w cos(phi) equal weights in phi (Gauss and Chebyshev) converge as rho^(-2m), rho the sum of
the half axes of the ellipse with foci at the edges of the gap that ends at the next branch point.
Where a band beside the gap is very narrow, rho is near one and they are too many. Then x = w
tanh((pi/2) sinh t) with equal steps in t (Takahashi and Mori) converges at a rate that knows the
width of the band by its logarithm alone. Source: ours.
"""

from __future__ import annotations

from functools import lru_cache

import mpmath
import numpy as np

from symfpu.errors import SymfpuError
from symfpu.integrable.discriminant import Edges
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, Arithmetic, Numbers
from symfpu.numbers.functions import exp

MOST_NODES = 20000
DIGITS_OF_DOUBLES = 17
WIDEST_STRIP = 1.4  # below pi/2, where the map itself is singular


class BandsTooNarrow(SymfpuError):
    """A band is so narrow beside a gap that it cannot be told from a point.

    gap : its number, from 1. Raised by `toda_torus` and `toda_invariants`. Ours.
    """

    def __init__(self, gap: int) -> None:
        self.gap = gap
        super().__init__(
            f"gap {gap}: the band beside it is too narrow for these digits: take a smaller "
            "energy or, for the invariants of a state, more digits"
        )


def mean_rule(edges: Edges, i: int, numbers: Arithmetic) -> tuple[Numbers, Numbers]:
    """Offsets x and weights of the mean over gap i, to the precision of the edges.

    The weights sum to one. Raises BandsTooNarrow.
    """
    digits = DIGITS_OF_DOUBLES if numbers is DOUBLES else mpmath.mp.dps + 2
    excess = _relative_distance(edges, i)
    if not excess > 0:
        raise BandsTooNarrow(i + 1)
    equal, graded, reach = _counts(excess, digits * np.log(10))
    if min(equal, graded) > MOST_NODES:
        raise BandsTooNarrow(i + 1)
    precision = 0 if numbers is DOUBLES else mpmath.mp.prec
    if equal <= 2 * graded + 1:
        places, weights = _equal_weights(equal, precision, numbers)
    else:
        places, weights = _graded(graded, reach, precision, numbers)
    return places * edges.half_widths[i], weights


def _counts(excess: float, nepers: float) -> tuple[int, int, float]:
    """Nodes of equal weights, graded nodes on each side, and how far these reach in t.

    Rounded up, so that few rules serve many gaps.
    """
    rate = np.log1p(excess + np.sqrt(excess * (2 + excess)))
    equal = int(np.ceil(nepers / (2 * rate))) + 2
    strip = np.arcsinh(complex(np.log(2 / excess), np.pi) / np.pi).imag
    step = 2 * np.pi * min(strip, WIDEST_STRIP) / nepers
    reach = float(np.arcsinh(2 * nepers / np.pi))
    graded = int(np.ceil(reach / step))
    return equal + -equal % 8, graded + -graded % 64, reach


def _relative_distance(edges: Edges, i: int) -> float:
    """From the edge of gap i to the next branch point, in half widths."""
    e, w = edges.centres, edges.half_widths
    others = np.nonzero(w)[0]
    others = others[others != i]
    distances = [abs(e[l] - e[i]) - w[l] for l in others]
    nearest = min(edges.top - e[i], e[i] - edges.bottom, *distances)
    return float((nearest - w[i]) / w[i])


@lru_cache(maxsize=64)
def _equal_weights(
    count: int, precision: int, numbers: Arithmetic
) -> tuple[Numbers, Numbers]:
    """Nodes cos((k - 1/2) pi / count) and weights 1/count; precision : in bits, 0 for doubles."""
    odd = numbers.array(2 * np.arange(count) + 1)
    cosines = numbers.cos(odd * numbers.pi / (2 * count))
    return cosines, (cosines * 0 + 1) / count


@lru_cache(maxsize=16)
def _graded(
    count: int, reach: float, precision: int, numbers: Arithmetic
) -> tuple[Numbers, Numbers]:
    """Nodes tanh((pi/2) sinh t) at 2 count + 1 steps of t from -reach to reach, and weights."""
    own = MULTIPRECISION if precision else DOUBLES
    t = own.array(np.arange(-count, count + 1)) * (reach / count)
    growth = exp(t)
    bend = exp((growth - 1 / growth) * (own.pi / 4))
    places = (bend - 1 / bend) / (bend + 1 / bend)
    weights = (growth + 1 / growth) / (bend + 1 / bend) * (reach / count / 2)
    return numbers.array(places), numbers.array(weights)
