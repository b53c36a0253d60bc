"""Where the sliders of a chain and its seeds go: up to where series begin to fail."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.numbers.typed import decimal, exact
from symfpu.workbench.choice import AMPLITUDES, ENERGY, FREQUENCIES

WIDEST = 2e-3  # relative shift of a frequency, to lowest order, at the end of a slider
FIRST = 0.25  # part of that shift where a slider stands first
LEAST = 0.01  # part of that shift at the other end
STEPS = 100  # of a slider, about, at least
LARGEST = 0.3  # Omega_q A_q where no frequency shifts to lowest order
DECADES = 4  # of the energy
PLACES = 12  # decimals of a number of a slider


@dataclass(frozen=True)
class Range:
    """A slider: its ends, its step, and where it stands first; dimensionless."""

    start: float
    end: float
    step: float
    value: float


def typed(value: float) -> str:
    """A number of a slider as one would type it, without what doubles add.

    >>> typed(0.09816000000000001), typed(2.5e-7)
    ('0.09816', '0.00000025')
    """
    return decimal(exact(round(value, PLACES), "value"))


def ranges(chain: Chain, seeds: tuple[int, ...], given: str) -> tuple[Range, ...]:
    """One for each seed: of its frequency, its amplitude, or its share of the energy.

    Raises InputError for modes that the chain has not.

    >>> ranges(Chain(N=32, alpha="0.33"), (1, 2), "energy")[0]
    Range(start=0.05, end=1.0, step=0.01, value=1.0)
    """
    modes = chain.seeds_of(seeds)
    if given == ENERGY:
        return tuple(Range(0.05, 1.0, 0.01, 1.0) for _ in modes)
    largest = _largest_amplitudes(chain, modes)
    if given == AMPLITUDES:
        parts = math.sqrt(LEAST), 1.0, math.sqrt(FIRST)
        return tuple(_range(*(part * largest[q] for part in parts)) for q in modes)
    assert given == FREQUENCIES
    return tuple(_of_frequency(chain, q, largest) for q in modes)


def energies(chain: Chain, seeds: tuple[int, ...]) -> tuple[float, float]:
    """log10 of the least and the largest energy of the slider."""
    modes = chain.seeds_of(seeds)
    largest = _largest_amplitudes(chain, modes)
    linear = _linear(chain)
    top = sum((linear[q] * largest[q]) ** 2 / 2 for q in modes)
    end = math.floor(10 * math.log10(top)) / 10
    return end - DECADES, end


def _linear(chain: Chain) -> dict[int, float]:
    return dict(zip(chain.mode_numbers, chain.frequencies().tolist(), strict=True))


def _largest_amplitudes(chain: Chain, modes: tuple[int, ...]) -> dict[int, float]:
    """Amplitudes of equal Omega_q A_q at which a frequency shifts by WIDEST of itself."""
    linear = _linear(chain)
    unit = {q: 1 / linear[q] for q in modes}
    if chain.periodic:
        return {q: LARGEST * a for q, a in unit.items()}
    shifts = frequency_shift(chain, unit)
    widest = max(abs(shifts[q]) / linear[q] for q in modes)
    size = min(LARGEST, math.sqrt(WIDEST / widest)) if widest else LARGEST
    return {q: size * a for q, a in unit.items()}


def _of_frequency(chain: Chain, q: int, largest: dict[int, float]) -> Range:
    linear = _linear(chain)[q]
    if chain.periodic:
        width = WIDEST * linear
        return _range(linear - width, linear + width, linear + FIRST * width)
    shift = frequency_shift(chain, largest)[q] or WIDEST * linear
    return _range(linear + LEAST * shift, linear + shift, linear + FIRST * shift)


def _range(one: float, other: float, first: float) -> Range:
    """With a round step; the ends and the first value are multiples of it."""
    start, end = sorted((one, other))
    step = 10.0 ** math.floor(math.log10((end - start) / STEPS))

    def rounded(value: float, towards: int) -> float:
        return float(round((towards + round(value / step)) * step, PLACES))

    return Range(rounded(start, 1), rounded(end, 0), step, rounded(first, 0))
