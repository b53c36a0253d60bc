"""Where the series of a torus is best cut: the order with the least residual, in doubles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.numbers.arithmetic import Numbers
from symfpu.tori.columns import columns_of
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, points_of_each_angle

Floats = NDArray[np.float64]

# angles at which residuals by order are taken, about, and at most
GRID_POINTS, MOST_POINTS = 512, 1024
NOISE = 1e-14  # relative residual below which doubles tell no order from another


def best_order(torus: Torus[FromSeries]) -> int:
    """The order of the coordinates, up to that of the torus, that leaves the least residual.

    Relative to the largest acceleration, as `assess` takes it, on the same angles. Of orders whose
    residuals are rounding it is the last.
    """
    residuals = residuals_by_order(torus)
    least = float(residuals.min())
    good = np.flatnonzero(residuals <= max(least, NOISE))
    return int(good[-1]) if len(good) else torus.origin.order


def residuals_by_order(torus: Torus[FromSeries]) -> Floats:
    """Largest |d^2Q/dt^2 - force| over the largest |force|, cut at each order; (order + 1,).

    Infinite where a coefficient or a force is no number.
    """
    chain = torus.chain
    number = points_of_each_angle(GRID_POINTS, len(torus.seeds))
    theta = some_angles(torus, number).astype(float)
    omega = np.array([float(w) for w in torus.frequencies])
    squares = chain.frequencies() ** 2
    Q: Any = 0.0
    linear: Any = 0.0  # d^2Q/dt^2 less the linear force
    found = []
    with np.errstate(over="ignore", invalid="ignore"):
        for nu, exact in torus.origin.terms_by_order:
            columns = columns_of(chain, torus.seeds, nu, travels=torus.travels)
            values = exact.astype(float)
            off = (columns.linear() ** 2 - (nu @ omega)[:, None] ** 2) * values
            more, more_linear = columns.modes(theta @ nu.T, [values, off])
            Q, linear = Q + more, linear + more_linear
            if not np.isfinite(Q).all():
                break
            anharmonic = chain.anharmonic_accelerations(Q)
            largest = np.abs(anharmonic - squares * Q).max()
            found.append(np.abs(linear - anharmonic).max() / largest)
    residuals = np.full(torus.origin.order + 1, np.inf)
    residuals[: len(found)] = found
    residuals[np.isnan(residuals)] = np.inf
    return residuals


def some_angles(torus: Torus[FromSeries], number: int) -> Numbers:
    """A tensor grid of angles of so many for each seed, in the numbers of the torus; shape (P, s).

    For many seeds, where even two points for each are too many, points drawn at random.
    """
    s = len(torus.seeds)
    if number**s <= MOST_POINTS:
        return np.concatenate(list(torus.angle_grid(number)))
    random = np.random.default_rng(s)
    return 2 * np.pi * random.random((MOST_POINTS, s))
