"""The frame of a torus: directions in which its linearised flow has constant coefficients.

Along a torus of s angles, in complex coordinates: s tangents, s directions in which the actions
change (the angles then run apart, at the rate of the twist), and N-1-s normal ones with their
conjugates, which turn with sigma. All are known in doubles only; what they leave of the
linearised equations is bounded elsewhere, so that nothing here needs a proof.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from symfpu.action_angle.newton_twist import changes_by_action
from symfpu.certified.rounded_torus import exponentials, rounded_series
from symfpu.certified.series import Series
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.normal.linearised import Linearised, coefficients_by_harmonic
from symfpu.normal.modes import NormalMode
from symfpu.normal.reduction import Block, Bordered
from symfpu.normal.search import normal_modes
from symfpu.normal.torus import checked_modes
from symfpu.refinement.harmonics import chosen_harmonics
from symfpu.refinement.lattice import Floats
from symfpu.tori.torus import Torus

FRAME_BITS = 60  # of the coefficients of the frame
RATE_BITS = 70  # of sigma and of the twist
HEIGHT = 1e-17  # of coefficients of the torus whose harmonics an eigenfunction has
SMALLEST = 1e-18  # of coefficients of the torus over its largest
POLISHED = 2  # times that it is solved for again
FINE = 3e-16  # accuracy of those solutions


@dataclass(frozen=True, eq=False)
class Direction:
    """A solution exp(i rate t) x(theta) of the linearised equations, x_j as series, error 0.

    mode : q of a normal direction, of the seed otherwise. rate : sigma, or 0.
    twist : domega of the angles along a direction of the actions; () of normal ones.
    """

    mode: int
    rate: Fraction
    particles: tuple[Series, ...]
    twist: tuple[Fraction, ...] = ()


def directions_of(solution: Torus, tell: Progress) -> tuple[Direction, ...]:
    """s directions of the actions, then N-1-s normal ones, without their conjugates.

    Raises NoTwist, NoNormalModes, InputError.
    """
    torus = without_rounding(solution.in_doubles())
    found = normal_modes(torus, modes=checked_modes(torus, None), progress=tell)
    if not found.stable:
        allowed = "an elliptic torus: all normal frequencies real"
        advice = "take another amplitude; beside it orbits leave at the rate of growth"
        raise InputError("torus", found.verdict, allowed, advice)
    polish = Polish(torus)
    normal = [polish(mode) for mode in found.modes]
    return (*_of_actions(torus), *normal)


def without_rounding(torus: Torus) -> Torus:
    """Without harmonics that doubles cannot tell from none, of which many digits have many."""
    sizes = np.abs(torus.cosines.astype(float)).max(axis=1)
    kept = sizes > SMALLEST * sizes.max()
    return replace(torus, harmonics=torus.harmonics[kept], cosines=torus.cosines[kept])


def _of_actions(torus: Torus) -> list[Direction]:
    """dK/dI_i with domega/dI_i, times powers of 2 that make the largest coefficient about 1."""
    changes = changes_by_action(torus)
    found = []
    pairs = zip(torus.seeds, changes.by_cosine, changes.twist.T, strict=True)
    for seed, change, turned in pairs:
        size = 2.0 ** -np.round(np.log2(np.abs(change).max()))
        table = in_particles(change * size)
        parities = changes.harmonics @ np.array(torus.seeds)
        series = rounded_series(changes.harmonics, table, FRAME_BITS, parities)
        found.append(Direction(seed, Fraction(0), series, dyadics(turned * size)))
    return found


def dyadics(values: Iterable[float]) -> tuple[Fraction, ...]:
    """The nearest with so many places."""
    return tuple(dyadic(float(x)) for x in values)


def dyadic(value: float) -> Fraction:
    """The nearest with RATE_BITS places."""
    return Fraction(round(Fraction(value) * 2**RATE_BITS), 2**RATE_BITS)


def in_particles(table: Floats) -> Floats:
    """x_j = sqrt(2/N) sum_q sin(pi q j / N) Q_q of each row; (H, N-1) of (H, N-1)."""
    N = table.shape[1] + 1
    places = np.arange(1, N)
    sines = np.sin(np.pi * np.outer(places, places) / N)
    return np.asarray(np.sqrt(2 / N) * (table @ sines))


class Polish:
    """Eigenfunctions to rounding, with as many harmonics as doubles can tell."""

    def __init__(self, torus: Torus) -> None:
        known = coefficients_by_harmonic(torus)
        functions, s = (torus.chain.N + 1) // 2, len(torus.seeds)
        chosen, _ = chosen_harmonics(known, functions, s, HEIGHT)
        self.flow = Linearised(torus, chosen)

    def __call__(self, mode: NormalMode) -> Direction:
        """The direction of a normal mode that is nearly known."""
        sigma = float(complex(mode.sigma).real)
        block = Block(self.flow, mode.mode, sigma)
        vector = self._on_harmonics(mode)[block.mask]
        inside = vector[block.inside]
        size = float(np.linalg.norm(inside))
        system = Bordered(block, (inside / size)[:, None])
        X = (vector / size)[:, None]
        for _ in range(POLISHED):
            system.take(sigma)
            X, images = system.improved(X, FINE)
            x = X[:, 0]
            slope = -2 * float(x @ ((sigma + system.rates) * x))
            sigma -= float(x @ images[:, 0]) / slope
        table = system.table(x / np.linalg.norm(x))
        return Direction(mode.mode, dyadic(sigma), self._series(mode.mode, table))

    def _on_harmonics(self, mode: NormalMode) -> Floats:
        """Its coefficients at the harmonics chosen here."""
        none = np.zeros(mode.coefficients.shape[1])
        pairs = zip(mode.harmonics.tolist(), mode.coefficients.real, strict=True)
        rows = {tuple(nu): row for nu, row in pairs}
        return np.array([rows.get(tuple(nu), none) for nu in self.flow.harmonics.tolist()])

    def _series(self, mode: int, table: Floats) -> tuple[Series, ...]:
        used = np.abs(table).max(axis=1) >= 2.0**-FRAME_BITS
        harmonics = self.flow.harmonics[used]
        particles = in_particles(table[used])
        parities = harmonics @ np.array(self.flow.seeds) + mode
        return exponentials(harmonics, particles, FRAME_BITS, parities)
