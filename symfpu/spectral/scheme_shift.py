"""How far the frequencies of a computed orbit are off by its scheme and step: with half the step.

The beginning of the orbit is integrated twice. A line is looked for in both, with the same window
and beside the same others: what window and neighbours make of its frequency is the same in both,
and the difference is that of the schemes. Half the step leaves a 2^order-th part of it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from symfpu.spectral.record import Exponential, Record
from symfpu.spectral.samples import Samples

Floats = NDArray[np.float64]

BEGINNING = 2**12  # samples that are compared
TURNS = 8  # of the slowest frequency that is asked for, at least
MOST = 2**24  # numbers, of all modes
LOST = 0.5  # turns over the beginning that a line may move and be the same
SAFETY = 2.0  # what half the step leaves, and errors of the comparison


def scheme_shifts(
    samples: Samples, lines: dict[int, list[Exponential]], omega: Floats
) -> dict[int, Floats]:
    """Above the shift of every line, by mode (from 0 up); dimensionless.

    lines : with their coefficients at time 0. One that the beginning does not show, or not apart
    from a stronger one, has the largest shift of the others. omega : the independent frequencies,
    of whose slowest the beginning has some turns.
    """
    slowest = float(np.abs(omega[omega != 0]).min(initial=1.0))
    turns = TURNS * 2 * math.pi / (slowest * samples.interval)
    most = max(BEGINNING, MOST // (samples.orbit.chain.N - 1))
    count = min(samples.count, most, max(BEGINNING, math.ceil(turns)))
    whole, half = samples.first(count), samples.first(count, parts=2)
    found = {}
    for mode, own in lines.items():
        first, second = (Record(x[:, mode], samples.interval) for x in (whole, half))
        found[mode] = _differences(first, second, own)
    known = np.concatenate([*found.values(), [0.0]])
    largest = float(np.nanmax(known))
    return {mode: np.where(np.isnan(x), largest, x) for mode, x in found.items()}


def _differences(whole: Record, half: Record, lines: list[Exponential]) -> Floats:
    """SAFETY times those of one mode; nan where a line is not the same in both."""
    middle = (whole.n - 1) / 2 * whole.interval
    seen = _apart(lines, whole.turn)
    guess = [
        Exponential(x.frequency, x.coefficient * np.exp(1j * x.frequency * middle))
        for x in (lines[i] for i in seen)
    ]
    first = whole.settle(guess)
    second = half.settle(first)
    moves = np.full(len(lines), math.nan)
    for i, a, b in zip(seen, first, second, strict=True):
        away = (abs(x.frequency - lines[i].frequency) for x in (a, b))
        if max(away) <= LOST * whole.turn:
            moves[i] = SAFETY * abs(a.frequency - b.frequency)
    return moves


def _apart(lines: list[Exponential], turn: float) -> list[int]:
    """Which have no stronger line within a turn, the strongest first."""
    found: list[int] = []
    for i in sorted(range(len(lines)), key=lambda i: -abs(lines[i].coefficient)):
        others = (abs(lines[i].frequency - lines[j].frequency) for j in found)
        if all(other >= turn for other in others):
            found.append(i)
    return found
