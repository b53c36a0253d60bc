"""The rings that a series can be asked for by name."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from symfpu.algebra.float64 import Float64Ring
from symfpu.algebra.selection import CosineModes
from symfpu.algebra.symbolic import SymbolicRing
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.series.divisors import Float64Divisors, UniversalDivisors
from symfpu.series.recursion import Frequencies, Progress, ring_series
from symfpu.series.series import LindstedtSeries


def float64_series(chain: Chain, space: CosineModes, frequencies: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as doubles."""
    divisors = Float64Divisors(chain, space.seeds, chosen_frequencies(frequencies, "float64"), space.grading.degree)
    return ring_series(chain, frequencies, order, Float64Ring(space), divisors, progress)


def _symbolic(chain: Chain, space: CosineModes, _: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as expanded polynomials in the multipliers."""
    return ring_series(chain, None, order, SymbolicRing(space), UniversalDivisors(chain, space.seeds), progress)


def _nested(chain: Chain, space: CosineModes, _: Frequencies, order: int, progress: Progress | None) -> LindstedtSeries:
    """Coefficients as nested expressions in the multipliers."""
    return ring_series(chain, None, order, SymbolicRing(space, nested=True), UniversalDivisors(chain, space.seeds), progress)


RINGS: dict[str, Callable[[Chain, CosineModes, Frequencies, int, Progress | None], LindstedtSeries]] = {
    "float64": float64_series,
    "symbolic": _symbolic,
    "nested": _nested,
}


def chosen_frequencies(frequencies: Frequencies, ring: str) -> tuple[Fraction, ...]:
    if frequencies is None:
        advice = "give frequencies=, or ring='symbolic'"
        raise InputError("frequencies", None, f"one number for each seed in the {ring} ring", advice)
    return frequencies
