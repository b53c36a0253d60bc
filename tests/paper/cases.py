"""For the verdicts, made by hand: alignment indices of a torus of a known dimension, spectra, records of orbits; and a short Fig. 9."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.paper import dimensions, fig9
from symfpu.paper.starts import printed_row
from symfpu.paper.toda_growth import TodaGrowth


def alignment(dimension, *, vectors=5, T=1e7, growth=1.0):
    """GALI_k = t^-(k - s) for k > s, constant below; the first vector grows as t^growth."""
    t = np.geomspace(1.0, T, 400)
    powers = -np.maximum(0.0, np.arange(2, vectors + 1) - dimension)
    return AlignmentIndices(Chain(16, alpha="0.33"), t, np.log10(t)[:, None] * powers, growth * np.log(t) / t, 0.4, 1e-12)


def growth_at(rates, N=16):
    """Directions that grow at these rates, and no others."""
    random = np.random.default_rng(3)
    left, right = (np.linalg.qr(random.normal(size=(2 * N - 2, len(rates))))[0] for _ in range(2))
    return TodaGrowth(Chain(N, alpha="0.33"), (left * rates) @ right.T, np.ones(N - 1))


def record(times, Q):
    """An orbit as far as its coordinates go."""
    return SimpleNamespace(times=np.asarray(times, dtype=float), Q=np.asarray(Q, dtype=float))


def exponential(N, decades):
    """e_q falling by so many decades a mode; sums to 1."""
    e = 10.0 ** (-decades * np.arange(N - 1))
    return e / math.fsum(e)


def shorter_figure_9(monkeypatch):
    """Order 40 in place of 242; one recurrence; alignment indices to 1e3."""
    monkeypatch.setattr(fig9, "printed_row", lambda label: replace(printed_row(label), order=40))
    monkeypatch.setattr("symfpu.paper.starts.AMPLITUDE_ORDERS", {})
    monkeypatch.setattr(fig9, "TIME", 1.5e4)
    monkeypatch.setattr(fig9, "LOOKS", 1501)
    monkeypatch.setattr(dimensions, "TIME", 1e3)
