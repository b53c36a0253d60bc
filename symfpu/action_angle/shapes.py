"""What the modes of a torus displace, in real coordinates of its states.

With fixed ends these are the Q_q themselves. On a ring they are the displacements of the N
particles: travelling waves are sums of N^(-1/2) exp(-2 pi i q j/N), standing ones of the sines of
the fixed ends that they unfold and of cosines, sqrt(2/N') cos(q pi j/N') on the ring of N = 2 N'.
So x(theta) = Re sum over nu of (c[nu] shapes) exp(i nu.theta), with fixed ends and on a ring.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.projections.standing import is_sine
from symfpu.refinement.lattice import Floats, Ints
from symfpu.tori.torus import Torus

Values = NDArray[Any]  # doubles or complex doubles


def mode_shapes(torus: Torus) -> Values:
    """What each mode displaces, in the order of chain.mode_numbers; (N-1, coordinates)."""
    if not torus.chain.periodic:
        return np.eye(torus.chain.N - 1)
    if torus.stands:
        return _standing(torus.chain)
    return _travelling(torus.chain)


def _travelling(ring: Chain) -> Values:
    turns = np.outer(ring.mode_numbers, np.arange(ring.N)) / ring.N
    return np.asarray(np.exp(-2j * np.pi * turns) / np.sqrt(ring.N))


def _standing(ring: Chain) -> Floats:
    half, sites = ring.N // 2, np.arange(ring.N)
    rows = []
    for q in ring.mode_numbers:
        wave = np.sin if is_sine(ring, q) else np.cos
        norm = np.sqrt((1 if q == half else 2) / half)
        rows.append(norm * wave(np.pi * abs(q) * sites / half))
    return np.array(rows)


def by_mode(torus: Torus, harmonics: Ints, coefficients: Floats) -> Values:
    """Coefficients (..., H, C) of a torus, or of its changes, by all modes; (..., H, N-1).

    harmonics : (H, s). C as in `ActionChanges`: complex of travelling waves, whose
    sin(a - nu.theta) is the real part of i exp(i (nu.theta - a)).
    """
    if not torus.chain.periodic:
        return coefficients
    numbers = np.array(torus.chain.mode_numbers)
    every = np.zeros((*coefficients.shape[:-1], len(numbers)), dtype=complex)
    if torus.stands:
        sines = [is_sine(torus.chain, q) for q in numbers.tolist()]
        every[..., sines] = coefficients
        return every.real
    N = torus.chain.N
    waves = harmonics @ np.array(torus.seeds)
    place = np.full(N, -1)
    place[numbers % N] = np.arange(N - 1)
    columns = place[waves % N]
    moving = np.flatnonzero(columns >= 0)
    signs = np.where(waves // N % 2 == 0, 1j, -1j)
    every[..., moving, columns[moving]] = (signs * coefficients[..., 0])[..., moving]
    return every
