"""Lines of one record: complex exponentials found one after the other, then all anew together.

A record is a signal at equal times. Times are taken from its middle, so that a frequency and a
phase do not disturb each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Numbers = NDArray[Any]

POWER = 3  # of the window (1 + cos)^p: a neighbour at distance d disturbs as (d T)^-(2p+1)
PADDING = 4  # places of the transform for each of the record
SWEEPS = 40
STEPS = 12  # of Newton's method on one line
STILL = 1e-12  # of a turn over the record: a frequency that moves less has arrived
ROUNDING = 4 * float(np.finfo(float).eps)  # of a frequency
WHILE_SEARCHING = 3  # sweeps
LINE_WIDTH = POWER + 1  # half width of a line, in turns over the record


@dataclass
class Exponential:
    """c e^(i f t), t from the middle of the record.

    Of a real record with its complex conjugate; a constant is its own, and stands once.
    """

    frequency: float
    coefficient: complex


def hann(n: int, power: int = POWER) -> Floats:
    """The window (1 + cos)^power on n points, of sum 1."""
    x = (2 * np.arange(n) + 1 - n) / n
    values = (1 + np.cos(np.pi * x)) ** power
    return np.asarray(values / values.sum())


def one_constant(lines: list[Exponential]) -> list[Exponential]:
    """The lines with one constant for all that are: slow ones climb there, each in turn."""
    constants = [line for line in lines if line.frequency == 0]
    if len(constants) < 2:
        return lines
    whole = Exponential(0.0, sum(line.coefficient for line in constants))
    first = lines.index(constants[0])
    return [
        whole if i == first else line
        for i, line in enumerate(lines)
        if line.frequency or i == first
    ]


class Record:
    """A signal y (n,) at times (k - (n-1)/2) interval, with a window."""

    def __init__(self, y: Numbers, interval: float) -> None:
        self.y, self.interval, self.n = y, interval, len(y)
        self.real = not np.iscomplexobj(y)
        self.window = hann(self.n)
        self.places = np.arange(self.n) - (self.n - 1) / 2
        self.times = self.places * interval
        self.squares = self.times**2
        self.stretch = math.isqrt(self.n - 1) + 1

    @property
    def turn(self) -> float:
        """The frequency of one turn over the record."""
        return 2 * math.pi / (self.n * self.interval)

    def part(self, first: int, last: int) -> Record:
        """The record from one place to before another, its times from its own middle."""
        return Record(self.y[first:last], self.interval)

    def wave(self, frequency: float) -> Numbers:
        """e^(i f t) at all times: those of the stretches times those within one."""
        angle = frequency * self.interval
        firsts = np.exp(1j * angle * self.places[:: self.stretch])
        within = np.exp(1j * angle * np.arange(self.stretch))
        return np.asarray(np.multiply.outer(firsts, within).ravel()[: self.n])

    def model(self, line: Exponential) -> Numbers:
        wave = line.coefficient * self.wave(line.frequency)
        if not self.real:
            return wave
        return np.asarray(wave.real if line.frequency == 0 else 2 * wave.real)

    def rest(self, lines: list[Exponential]) -> Numbers:
        """What the lines leave."""
        rest = self.y.copy()
        for line in lines:
            rest -= self.model(line)
        return rest

    def peak(self, rest: Numbers, band: tuple[float, float]) -> Exponential:
        """The highest place of the windowed transform within a band of frequencies."""
        padded = PADDING * self.n
        transform = np.fft.fft(self.window * rest, padded)
        frequencies = 2 * math.pi * np.fft.fftfreq(padded, self.interval)
        inside = (frequencies >= band[0]) & (frequencies <= band[1])
        heights = np.where(inside, np.abs(transform), -1.0)
        frequency = float(frequencies[int(np.argmax(heights))])
        if self.real and abs(frequency) < self.turn:
            frequency = 0.0
        return self.climb(rest, frequency)

    def climb(self, rest: Numbers, frequency: float) -> Exponential:
        """The maximum of the windowed transform next to a frequency, by Newton's method."""
        weighted = self.window * rest
        if self.real and frequency == 0:
            return Exponential(0.0, complex(weighted.sum()))
        near = self.turn  # no step is longer
        for _ in range(STEPS):
            waves = weighted * self.wave(-frequency)
            value = waves.sum()
            slope = -1j * (self.times @ waves)
            bend = -(self.squares @ waves)
            gradient = (slope * np.conj(value)).real
            curvature = abs(slope) ** 2 + (bend * np.conj(value)).real
            if curvature >= 0:  # not at a maximum yet: uphill
                step = math.copysign(near / 4, gradient)
            else:
                step = max(-near / 2, min(near / 2, -gradient / curvature))
            frequency += step
            if abs(step) <= self._still(frequency):
                break
        if self.real and abs(frequency) <= self._still(frequency):
            frequency = 0.0
        value = (weighted * self.wave(-frequency)).sum()
        return Exponential(frequency, complex(value))

    def settle(self, lines: list[Exponential], sweeps: int = SWEEPS) -> list[Exponential]:
        """Each line anew from what the others leave, until none moves."""
        lines = list(lines)
        rest = self.rest(lines)
        highest = max((abs(line.coefficient) for line in lines), default=0.0)
        for _ in range(sweeps):
            still = True
            for i, line in enumerate(lines):
                rest += self.model(line)
                lines[i] = again = self.climb(rest, line.frequency)
                rest -= self.model(again)
                moved = abs(again.frequency - line.frequency)
                share = abs(again.coefficient) / highest
                still = still and share * moved <= self._still(line.frequency)
            if still:
                break
        return lines

    def _still(self, frequency: float) -> float:
        """A change of a frequency that is none."""
        return STILL * self.turn + ROUNDING * abs(frequency)

    def lines(
        self, most: int, level: float, band: tuple[float, float]
    ) -> list[Exponential]:
        """At most so many lines, down to a level of the highest, the highest first."""
        found: list[Exponential] = []
        rest = self.y.copy()
        for _ in range(most):
            line = self.peak(rest, band)
            height = abs(line.coefficient)
            highest = max((abs(x.coefficient) for x in found), default=height)
            outside = not band[0] <= line.frequency <= band[1]
            if outside or height <= level * highest or height == 0:
                break
            if self._on_top(line, found):
                break
            found = one_constant(self.settle([*found, line], WHILE_SEARCHING))
            rest = self.rest(found)
        return sorted(found, key=lambda x: -abs(x.coefficient))

    def _on_top(self, line: Exponential, found: list[Exponential]) -> bool:
        """Whether it is what an unfinished line leaves: no second one of its own."""
        return any(abs(line.frequency - x.frequency) < self.turn for x in found)
