"""Small travelling waves of a ring: the lowest shifts of their frequencies, and short series there.

There is no closed form of these shifts: they are read off a series next to the linear frequencies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import exact
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

DIGITS = 25  # of the frequencies
# relative shift of the frequencies of the series whose first corrections are read
TRIAL = 1e-9


def shifts_by_squares(chain: Chain, seeds: Sequence[int]) -> NDArray[np.float64]:
    """d omega_i / d (A_j^2) of small waves, the lowest order of the series; (s, s).

    chain : a ring. Raises ResonantDivisor where a resonance of the ring is of so low an order.
    """
    linear = [float(chain.linear_frequency(q)) for q in seeds]
    trial = tuple(exact(w * (1 + TRIAL), "frequency") for w in linear)
    series = lindstedt(chain, tuple(seeds), trial, 2 // chain.degree_step)
    _, slopes = series.frequency_terms(np.zeros(len(seeds)))
    return np.asarray(slopes.sum(axis=0))


def plain_waves(
    chain: Chain, frequencies: Sequence[Fraction], amplitudes: Mapping[int, float]
) -> Torus:
    """The waves of the seeds alone; amplitudes : by seed, in the order of the frequencies."""
    seeds = tuple(amplitudes)
    each = np.eye(len(seeds), dtype=np.int64)
    cosines = np.array(list(amplitudes.values()), dtype=float)[:, None]
    return Torus(chain, seeds, tuple(frequencies), each, cosines, travels=True)


def short_waves(
    chain: Chain, amplitudes: Mapping[int, float], order: int
) -> Torus[FromSeries]:
    """The series to an order about the frequencies that amplitudes shift, with these.

    Raises ResonantDivisor where a resonance of the ring is of so low an order.
    """
    seeds, squares = tuple(amplitudes), np.array(list(amplitudes.values())) ** 2
    shifts = shifts_by_squares(chain, seeds) @ squares
    with mpmath.workdps(2 * DIGITS):
        pairs = zip(seeds, shifts.tolist(), strict=True)
        shifted = [chain.linear_frequency(q) + mpmath.mpf(w) for q, w in pairs]
        omega = tuple(Fraction(text(w, DIGITS)) for w in shifted)
    series = lindstedt(chain, seeds, omega, order)
    return FromSeries(series, tuple(amplitudes.values()), order, order).torus()
