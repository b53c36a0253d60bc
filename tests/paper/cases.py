"""For the verdicts, made by hand: alignment indices of a torus of a known dimension, spectra, records of orbits; and a short Fig. 9."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from symfpu import AlignmentIndices, Chain, ForetoldIndices
from symfpu.paper import dimensions, fig9
from symfpu.paper.fig9_tori import approach
from symfpu.paper.starts import printed_row


def alignment(dimension, *, vectors=5, T=1e7, growth=1.0):
    """GALI_k = t^-(k - s) for k > s, constant below; the first vector grows as t^growth."""
    t = np.geomspace(1.0, T, 400)
    powers = -np.maximum(0.0, np.arange(2, vectors + 1) - dimension)
    return AlignmentIndices(Chain(16, alpha="0.33"), t, np.log10(t)[:, None] * powers, growth * np.log(t) / t, 0.4, 1e-12)


def foretold(dimension, *, vectors=7, frames=4, T=1e11):
    """The same indices, as frames of a forecast have them."""
    t = np.geomspace(1.0, T, 440)
    powers = -np.maximum(0.0, np.arange(2, vectors + 1) - dimension)
    torus = SimpleNamespace(chain=Chain(32, alpha="0.33"), seeds=(1, 2, 3, 4, 5))
    rates = 10.0 ** -np.arange(3, 8)
    return (ForetoldIndices(torus, t, np.log10(t)[:, None] * powers, np.log(t), rates, "modes at rest"),) * frames


@dataclass(frozen=True)
class Cut:
    """A torus as far as one number goes, its energy or residual, that it has for each coordinate order."""

    order: int
    values: dict
    phases: None = None

    @property
    def origin(self):
        return self

    def cut_at(self, order):
        return replace(self, order=order)

    def torus(self, phases=None):
        return self

    def residual(self):
        return self.values[self.order]

    energy = residual


def unheard(label, fraction):
    """Progress that nobody asks for."""


def record(times, Q):
    """An orbit as far as its coordinates go."""
    return SimpleNamespace(times=np.asarray(times, dtype=float), Q=np.asarray(Q, dtype=float))


def exponential(N, decades):
    """e_q falling by so many decades a mode; sums to 1."""
    e = 10.0 ** (-decades * np.arange(N - 1))
    return e / math.fsum(e)


def shorter_figure_9(monkeypatch):
    """Order 40 in place of 242; one recurrence; alignment indices to 1e3; tori near an orbit of a short chain."""
    monkeypatch.setattr(fig9, "printed_row", lambda label: replace(printed_row(label), order=40))
    monkeypatch.setattr("symfpu.paper.starts.AMPLITUDE_ORDERS", {})
    monkeypatch.setattr(fig9, "TIME", 1.5e4)
    monkeypatch.setattr(fig9, "LOOKS", 1501)
    monkeypatch.setattr(dimensions, "TIME", 1e3)
    monkeypatch.setattr(fig9, "approach", lambda chain, energy, progress: approach(Chain(8, alpha="0.3"), "0.001", progress, (1, 2)))
