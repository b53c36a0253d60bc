"""Small tori: the lowest shifts of their frequencies, and the short series there.

With fixed ends the shifts have a closed form. On a ring there is none: they are read off a series
next to the linear frequencies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.numbers.arithmetic import text
from symfpu.numbers.typed import exact
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

DIGITS = 25  # of the frequencies
# relative shift of the frequencies of the series whose first corrections are read
TRIAL = 1e-9


def shifts_by_squares(chain: Chain, seeds: Sequence[int]) -> NDArray[np.float64]:
    """d omega_i / d (A_j^2) of small tori, the lowest order of the series; (s, s).

    Raises ResonantDivisor where a resonance of a ring is of so low an order.
    """
    if not chain.periodic:
        units = [{q: float(q == n) for q in seeds} for n in seeds]
        columns = [frequency_shift(chain, unit) for unit in units]
        return np.array([[column[q] for column in columns] for q in seeds])
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
    sizes = np.array(list(amplitudes.values()), dtype=float)
    if chain.periodic:
        return Torus(chain, seeds, tuple(frequencies), each, sizes[:, None], travels=True)
    cosines = np.zeros((len(seeds), chain.N - 1))
    cosines[np.arange(len(seeds)), np.array(seeds) - 1] = sizes
    return Torus(chain, seeds, tuple(frequencies), each, cosines)


def shifted_frequencies(
    chain: Chain, amplitudes: Mapping[int, float]
) -> tuple[Fraction, ...]:
    """omega of every seed with the lowest shift of these amplitudes."""
    squares = np.array(list(amplitudes.values())) ** 2
    shifts = shifts_by_squares(chain, tuple(amplitudes)) @ squares
    with mpmath.workdps(2 * DIGITS):
        pairs = zip(amplitudes, shifts.tolist(), strict=True)
        shifted = [chain.linear_frequency(q) + mpmath.mpf(w) for q, w in pairs]
        return tuple(Fraction(text(w, DIGITS)) for w in shifted)


def short_series(
    chain: Chain, amplitudes: Mapping[int, float], order: int
) -> Torus[FromSeries]:
    """The series to an order about the frequencies that amplitudes shift, with these.

    Its frequencies are those of the lowest order, not of the whole series. Raises ResonantDivisor
    where a resonance of a ring is of so low an order.
    """
    omega = shifted_frequencies(chain, amplitudes)
    series = lindstedt(chain, tuple(amplitudes), omega, order)
    sizes = dict(zip(amplitudes, amplitudes.values(), strict=True))
    chosen = tuple(sizes[q] for q in series.seeds)
    return FromSeries(series, chosen, order, order).torus()
