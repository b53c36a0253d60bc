"""Where a direction turns nearly as the torus does: the solutions beside sigma = nu.omega.

Shifts of the angles are solutions with sigma = nu.omega exactly, each a double root. A direction
whose frequency comes near meets them, on the real line or along the imaginary one, and there
Newton's method leads to a shift from nearly everywhere. So all roots nearby are taken at once: the
small matrix E(sigma) of `reduction` is smooth, a parabola through three values gives a quadratic
eigenvalue problem, and what is left without the shifts is a guess with its eigenfunction.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from symfpu.normal.linearised import Linearised, Values
from symfpu.normal.reduction import (
    DEFLATED,
    FINE,
    LEAST_ACTION,
    Block,
    Bordered,
    Reduced,
    followed,
    shares_of,
)
from symfpu.refinement.lattice import Floats

SPACING = 1e-3  # of the three values of sigma, relative
REACH = 10.0  # spacings from nu.omega, up to which the parabola is believed
LEAST_SHARE = 0.1  # of the main coefficient of a mode in a solution that may continue it


class _Root(NamedTuple):
    """A solution nearby: how far from nu.omega, its eigenfunction (F, C), its main coefficient."""

    distance: complex
    table: Values
    share: float


def beside(flow: Linearised, q: int, rate: float, shifts: int) -> Reduced | None:
    """The solution beside nu.omega that has most of a mode; None where there is none.

    rate : nu.omega. shifts : of the torus, how many solutions turn with it exactly.
    """
    for likest in _likest(flow, q, rate, shifts):
        found = followed(flow, q, _guess(rate, likest), likest.table)
        if found:
            return found
    return None


def nearness(flow: Linearised, q: int, rate: float, shifts: int) -> float:
    """How far from nu.omega that solution is, about; infinite where there is none."""
    distances = [abs(root.distance) for root in _likest(flow, q, rate, shifts)]
    return min(distances, default=np.inf)


def _likest(flow: Linearised, q: int, rate: float, shifts: int) -> Iterator[_Root]:
    """The root with most of a mode, by fewer and by more vectors."""
    for part in DEFLATED[1:]:
        roots = _roots(flow, q, rate, part, shifts)
        likest = max(roots, key=lambda root: root.share, default=None)
        if likest and likest.share > LEAST_SHARE:
            yield likest


def _guess(rate: float, root: _Root) -> complex:
    """As a float where it is on the real line."""
    far = root.distance
    return rate + far if far.imag else float(rate + far.real)


def _roots(
    flow: Linearised, q: int, rate: float, part: float, shifts: int
) -> Iterator[_Root]:
    """All but the shifts, those that turn forwards or grow."""
    like = _main(flow, q)
    block = Block(flow, q, rate)
    W = block.deflation(rate, part, like[block.mask][block.inside])
    system = Bordered(block, W)
    step = SPACING * rate
    values, X = _three(system, rate, step)
    distances, vectors = _quadratic(values)
    order = np.argsort(np.abs(distances))[2 * shifts :]
    shares = shares_of(X, vectors, like[block.mask])
    for at in order.tolist():
        far, p = step * complex(distances[at]), X @ vectors[:, at]
        if abs(far) < REACH * step and _forwards(system, rate + far, p):
            yield _Root(far, _normed(system.table(p)), float(shares[at]))


def _main(flow: Linearised, q: int) -> Floats:
    """The mode without any angle, (F, C)."""
    table = np.zeros(flow.allowed(q).shape)
    table[0, flow.column(q)] = 1
    return table


def _three(system: Bordered, rate: float, step: float) -> tuple[list[Values], Values]:
    """E at nu.omega and a step to either side, and X at nu.omega itself."""
    values = []
    X: Values = system.start()
    for sigma in (rate - step, rate + step, rate):
        system.take(sigma)
        X, images = system.improved(X, FINE)
        E = X.T @ images
        values.append((E + E.T) / 2)
    return values, X


def _quadratic(values: list[Values]) -> tuple[Values, Values]:
    """All x and v, of norm 1, with E(x) v = 0, E the parabola with these values at -1, 1, 0."""
    from scipy import linalg

    below, above, here = values
    slope, curvature = (above - below) / 2, (above + below) / 2 - here
    none, one = np.zeros_like(here), np.eye(len(here))
    left = np.block([[none, one], [-here, -slope]])
    right = np.block([[one, none], [none, curvature]])
    distances, vectors = linalg.eig(left, right)
    vectors = vectors[: len(here)]
    finite = np.isfinite(distances)
    vectors, distances = vectors[:, finite], distances[finite]
    return distances, vectors / np.linalg.norm(vectors, axis=0)


def _forwards(system: Bordered, sigma: complex, p: Values) -> bool:
    """Whether a solution grows, or is elliptic and has positive action."""
    if sigma.imag:
        return sigma.imag > 0
    weights = np.abs(p) ** 2
    action = float((sigma.real + system.rates) @ weights / weights.sum())
    return action > LEAST_ACTION * abs(sigma)


def _normed(table: Values) -> Values:
    return np.asarray(table / np.linalg.norm(table))
