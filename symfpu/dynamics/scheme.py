"""What an integrator is: drifts and kicks by turns, symmetric, of one splitting of H."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SCAN = 1e-3  # of the phase step * Omega, at which stability is looked for
# no explicit scheme of fewer than a hundred stages is stable beyond, with steps that are worth
# their force evaluations
LARGEST_PHASE = 8.0
SLACK = 1e-9  # of the half trace: rounding


@dataclass(frozen=True)
class Scheme:
    """A composition of `stages` kicks with a drift before, between and after them; step 1.

    splitting : "T + V", drifts move the particles and kicks are of all springs; or "harmonic +
    anharmonic", drifts are exact rotations of the harmonic modes and kicks are of the couplings
    between them. order : of the error of a step of a chain without small parameters.
    source : where the coefficients are from.
    """

    name: str
    order: int
    splitting: str
    source: str
    drifts: tuple[float, ...] = field(repr=False)
    kicks: tuple[float, ...] = field(repr=False)

    @property
    def stages(self) -> int:
        """Force evaluations of a step."""
        return len(self.kicks)

    @property
    def in_modes(self) -> bool:
        return self.splitting != "T + V"

    def merged(self, step: float) -> tuple[float, Floats, Floats]:
        """First drift, kicks, and the drift after each kick in a row of steps of this length.

        The last drift leads into the next step.
        """
        first, *between, last = self.drifts
        kicks = step * np.array(self.kicks)
        drifts = step * np.array([*between, last + first])
        return step * first, kicks, drifts

    @cached_property
    def stable_phase(self) -> float:
        """The largest z such that modes with step * Omega below z stay bounded.

        It follows from the trace of the step of the harmonic chain.

        Exact rotations are stable at any step; we stop where one of them passes a right angle,
        since steps of half a period resonate with the kicks.
        """
        if self.in_modes:
            return float(np.pi / 2 / max(map(abs, self.drifts)))
        z = np.arange(SCAN, LARGEST_PHASE, SCAN)
        unstable = np.abs(half_trace(self, z)) > 1 + SLACK
        return float(z[np.argmax(unstable)] - SCAN) if unstable.any() else LARGEST_PHASE


def half_trace(scheme: Scheme, z: Floats) -> Floats:
    """Half the trace of the step matrix of an oscillator of frequency z, on T + V.

    Outside of -1 .. 1 the step is unstable.
    """
    # rows (a b), (c d)
    a, b = np.ones_like(z), np.zeros_like(z)
    c, d = np.zeros_like(z), np.ones_like(z)
    for drift, kick in itertools.zip_longest(scheme.drifts, scheme.kicks, fillvalue=0.0):
        drifted, kicked = drift * z, kick * z
        a = a + drifted * c
        b = b + drifted * d
        c = c - kicked * a
        d = d - kicked * b
    return 0.5 * (a + d)


def palindrome(half: Sequence[float], *, middle: bool) -> tuple[float, ...]:
    """A symmetric row of coefficients from its first half.

    The last entry of the half is the middle one, or occurs twice.
    """
    return (*half, *reversed(half[:-1] if middle else half))
