"""The anharmonic tension of a bond as powers of its stretch, with a bound of what is left out.

For what computes in fixed point: a polynomial potential has finitely many powers; one whose tension
is made of exponentials and powers is cut where its last ones are below the last place.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Growth
from symfpu.errors import InputError

MOST_POWERS = 2000
WIDER = 1.25  # times the reach: where the rest of the derivative is taken from
UPWARDS = 1 + 1e-9  # more than doubles lose


def highest_product(chain: Chain) -> int:
    """The power of r in the force, 3 or more: H harmonics have forces up to so many times H."""
    return max(3, (chain.potential.degree or 0) - 1)


class Terms(NamedTuple):
    """The anharmonic tension as powers of the stretch.

    couplings : c_(k+1) by power k. rest : above the sum of all others.
    """

    couplings: dict[int, Fraction]
    rest: Any = 0


def has_terms(chain: Chain) -> bool:
    """Whether `terms` knows the tension exactly: its coefficients, and a bound of the last ones."""
    return chain.potential.degree is not None or bool(chain.potential.growths())


def terms(chain: Chain, bits: int, reach: Any) -> Terms:
    """So many powers that the rest is below 2^-bits where no stretch is above the reach."""
    potential = chain.potential
    highest, rest = highest_product(chain), mpmath.mpf(0)
    if potential.degree is None:
        highest, rest = _highest_power(potential.growths(), bits, reach)
    found = {k: potential.coefficient(k + 1) for k in range(2, highest + 1)}
    return Terms({k: coupling for k, coupling in found.items() if coupling}, rest)


def stiffness_terms(chain: Chain, bits: int, reach: Any) -> Terms:
    """V''(r) - 1 likewise: k c_(k+1) by power k - 1.

    The rest is below that of the tension at stretches WIDER times as large, over its distance to
    the reach: n r^(n-1) (w - r) <= w^n for w > r.
    """
    wide = WIDER * reach
    distance = wide - reach
    spare = max(0, math.ceil(-math.log2(distance)))
    tension = terms(chain, bits + spare, wide)
    slopes = {k - 1: k * coupling for k, coupling in tension.couplings.items()}
    return Terms(slopes, tension.rest / distance)


def _highest_power(growths: Sequence[Growth], bits: int, reach: Any) -> tuple[int, Any]:
    """The power after which Taylor series of growths are cut, and what they add beyond.

    The ratio of successive terms, (rate - slope n)/(n + 1) times the reach, is monotonic.
    """
    sizes = [abs(growth.weight * growth.rate) * reach for growth in growths]  # of r^1
    rates = [(float(abs(g.rate)), float(abs(g.slope))) for g in growths]
    for n in range(2, MOST_POWERS):
        rest = mpmath.mpf(0)
        for i, (rate, slope) in enumerate(rates):
            sizes[i] *= reach * (rate + slope * (n - 1)) / n * UPWARDS
            ratio = reach * max((rate + slope * n) / (n + 1), slope) * UPWARDS
            rest += sizes[i] / (1 - ratio) if ratio < 1 else mpmath.inf
        if rest < mpmath.ldexp(1, -bits):
            return n - 1, rest
    allowed = (
        f"what {MOST_POWERS} powers of stretches up to {mpmath.nstr(reach, 3)} can give"
    )
    advice = "take fewer digits or a smaller amplitude"
    raise InputError("digits", math.floor(bits * math.log10(2)), allowed, advice)
