"""The couplings between harmonics that a preconditioner keeps: by the largest of the slopes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from symfpu.refinement.lattice import (
    Floats,
    Ints,
    Lattice,
    dilated,
    has_holes,
    low_harmonics,
    without_opposites,
)

# harmonics of the slopes that sparse rows hold, and their least height, relative
MOST_SLOPES, SHARE = 12, 0.1
LEAST_COUPLING = (
    1e-3  # of two columns by one harmonic of the slopes, in sparse rows, relative
)
LEAST_STEP = 1e-3  # height of those by which further harmonics are reached, relative


def largest_slopes(grid: Lattice, spectrum: Floats) -> Ints:
    """The harmonics of the slopes that sparse rows hold, with both signs; (k, s).

    spectrum : of the slopes, (bonds, points).
    """
    return _tallest(grid, spectrum, MOST_SLOPES, SHARE)


def steps_by_slopes(grid: Lattice, spectrum: Floats, most: int) -> Ints:
    """The same with smaller ones: steps from a harmonic to those that it drives."""
    return _tallest(grid, spectrum, most, LEAST_STEP)


def _tallest(grid: Lattice, spectrum: Floats, most: int, share: float) -> Ints:
    """The largest harmonics of the slopes above a share of the height of the first of all.

    They are among all harmonics as large as the chosen ones, or among low ones where those have
    holes: where V is even the slopes have even harmonics alone, and the torus odd ones.
    """
    heights = np.abs(spectrum).max(axis=0)
    nu = without_opposites(_possible(grid.harmonics))
    height = heights[grid.entries(nu)]
    order = np.argsort(-height, kind="stable")
    chosen = nu[order[:most]]
    tall = chosen[heights[grid.entries(chosen)] > share * heights.max()]
    return np.unique(np.concatenate([tall, -tall]), axis=0)


def _possible(harmonics: Ints) -> Ints:
    if has_holes(harmonics):
        return low_harmonics(harmonics.shape[1])
    return dilated(harmonics, 1)


def shifted(harmonics: Ints, rows: Ints, kappa: Ints) -> tuple[Ints, Ints]:
    """Where nu - kappa of chosen rows nu of the harmonics, or its negative, is one of them.

    Places among the chosen rows, and rows of the harmonics.
    """
    highest = np.abs(harmonics).max(axis=0)
    base = 4 * highest + 3
    weights = np.cumprod(np.append(base[1:], 1)[::-1])[::-1]
    moved = harmonics[rows] - kappa
    first_nonzero = np.argmax(moved != 0, axis=1)
    lead = moved[np.arange(len(moved)), first_nonzero]
    sign = np.where(lead < 0, -1, 1)
    keys, wanted = harmonics @ weights, sign * (moved @ weights)
    order = np.argsort(keys)
    nearest = np.searchsorted(keys[order], wanted)
    place = order[np.clip(nearest, 0, len(keys) - 1)]
    within = (np.abs(moved) <= highest).all(axis=1)
    found = np.flatnonzero((keys[place] == wanted) & within)
    return found, place[found]


def sparse_rows(
    mask: Any,
    kappas: Ints,
    coupled: Callable[[Ints, float], tuple[Floats, Ints, Ints]],
    count: int,
) -> Any:
    """A sparse matrix (count, unknowns) from what every harmonic of the slopes couples.

    coupled : of a harmonic and the least coupling, values (k, C), their rows (k,) and harmonics
    (k,), one value for each of the unknowns of the harmonic.
    """
    from scipy import sparse

    unknowns = int(mask.sum())
    number = np.full(mask.shape, -1, dtype=np.int32)
    number[mask] = np.arange(unknowns, dtype=np.int32)
    parts = []
    for kappa in kappas:
        values, rows, harmonics = coupled(kappa, LEAST_COUPLING)
        columns = number[harmonics]
        k, c = np.nonzero((values != 0) & (columns >= 0))
        parts.append((values[k, c], rows[k], columns[k, c]))
    values, i, j = (np.concatenate(x) for x in zip(*parts, strict=True))
    return sparse.csr_matrix((values, (i, j)), shape=(count, unknowns))
