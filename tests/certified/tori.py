"""Tori of short chains for the proofs, one with a coefficient off, and their sums by the definition in many digits."""

from functools import cache

import mpmath

import symfpu
from symfpu import Chain, Torus, refine

AMPLITUDES = {1: "0.2", 2: "0.1"}


@cache
def torus(N=3, **law):
    """Refined, with two angles."""
    guess = symfpu.torus(Chain(N, **law or {"alpha": "0.3"}), tuple(AMPLITUDES), amplitudes=AMPLITUDES, method="series", order=4)
    return refine(guess, amplitudes=AMPLITUDES)


def one_off(exact, change):
    """The torus with one coefficient changed, of mode 2 in the harmonic (2, 0)."""
    moved = exact.cosines.copy()
    moved[exact.harmonics.tolist().index([2, 0]), 1] += change
    return Torus(exact.chain, exact.seeds, exact.frequencies, exact.harmonics, moved, exact.phases)


def entries(series):
    """Harmonics and coefficients of a rounded series."""
    for at in zip(*series.values.nonzero(), strict=True):
        nu = [int(n) - m for n, m in zip(at, series.highest, strict=True)]
        yield nu, mpmath.ldexp(int(series.values[at]), -series.places)


def turned(nu, turns):
    """nu times the angles, in half turns."""
    return sum(n * a for n, a in zip(nu, turns, strict=True))


def value(series, turns):
    """The sum of a rounded series at these angles."""
    return sum((c * mpmath.cospi(turned(nu, turns)) for nu, c in entries(series)), mpmath.mpf(0))


def rational(x):
    return mpmath.mpf(x.numerator) / x.denominator
