"""Narrow bands of a long signal: turned down to frequency 0, smoothed, and kept at few times.

A channel takes one mode and one frequency f: y_b = sum over k of w_k x(t_b + t_k) e^(-i f t), with
Kaiser's window w over sixteen hops, one value a hop. Lines within three eighths of 2 pi / hop of f
stay; what lies outside and would be taken for them is below 1e-12 of what it was.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Numbers = NDArray[Any]

SPAN = 16  # hops under a window
HALF_WIDTH = 10  # of the window's transform, in turns over the window
SHARE = 0.375  # of 2 pi / hop: SHARE * SPAN + HALF_WIDTH = SPAN


@dataclass(frozen=True)
class Channel:
    """mode : its column. frequency : the centre, in radians a unit of time."""

    mode: int
    frequency: float


class ChannelBank:
    """All channels of an orbit, fed with its samples block after block.

    hop : samples between two values. interval : time between two samples.
    """

    def __init__(self, channels: list[Channel], hop: int, interval: float) -> None:
        self.channels, self.hop, self.interval = channels, hop, interval
        self.length = SPAN * hop
        window = np.kaiser(self.length, math.pi * math.hypot(HALF_WIDTH, 1))
        self.window: Floats = window / window.sum()
        self.offsets = (np.arange(self.length) - (self.length - 1) / 2) * interval
        self.values: list[Numbers] = []
        self.waiting: Numbers | None = None
        self.consumed = 0  # samples before those that wait
        self.by_mode: dict[int, list[int]] = {}
        for place, channel in enumerate(channels):
            self.by_mode.setdefault(channel.mode, []).append(place)
        self.turned = {q: self._turned(places) for q, places in self.by_mode.items()}

    def _turned(self, places: list[int]) -> Numbers:
        """Window times e^(-i f t) of the channels of one mode; shape (length, channels)."""
        frequencies = np.array([self.channels[place].frequency for place in places])
        turns = np.exp(-1j * self.offsets[:, None] * frequencies)
        return np.asarray(self.window[:, None] * turns)

    @property
    def band(self) -> float:
        """Largest distance of a line from the centre of its channel."""
        return SHARE * 2 * math.pi / (self.hop * self.interval)

    def feed(self, samples: Numbers) -> None:
        """Takes the next samples, shape (n, modes)."""
        if self.waiting is not None:
            samples = np.concatenate([self.waiting, samples])
        count = (len(samples) - self.length) // self.hop + 1
        if count > 0:
            self.values.append(self._decimated(samples, count))
            samples = samples[count * self.hop :]
            self.consumed += count * self.hop
        self.waiting = samples

    def _decimated(self, samples: Numbers, count: int) -> Numbers:
        middles = self.hop * np.arange(count) + (self.length - 1) / 2
        times = (self.consumed + middles) * self.interval
        values = np.empty((count, len(self.channels)), complex)
        for q, places in self.by_mode.items():
            windows = np.lib.stride_tricks.sliding_window_view(samples[:, q], self.length)
            frequencies = np.array([self.channels[place].frequency for place in places])
            phases = np.exp(-1j * times[:, None] * frequencies)
            values[:, places] = (windows[:: self.hop][:count] @ self.turned[q]) * phases
        return values

    def records(self) -> Numbers:
        """The values so far, shape (blocks, channels), from the first sample to the last."""
        return np.concatenate(self.values)

    @property
    def first_time(self) -> float:
        """The time of the first value."""
        return (self.length - 1) / 2 * self.interval

    def response(self, distance: float) -> float:
        """What is left of a line so far from the centre of its channel."""
        return float(self.window @ np.cos(distance * self.offsets))
