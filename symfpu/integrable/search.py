"""Heights of the seeds' gaps that give asked frequencies or actions.

Newton's method for the logarithms of the squared heights h_k^2. It begins at the normal form of
fourth order, in which Toda's frequencies do not mix: omega_k = Omega_k + (2 a^2 / n) I_k and
h_k^2 = 8 n a^2 I_k / Omega_k, n the length of the ring (2N for fixed ends). Its Jacobian, from
differences, then serves with any number of digits. Source: ours.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import gmpy2
import numpy as np

from symfpu.errors import InputError, SymfpuError
from symfpu.integrable.curve import SpectralCurve
from symfpu.integrable.discriminant import (
    Edges,
    Floats,
    critical_points,
    edges,
    free_points,
)
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, working_digits
from symfpu.numbers.mpfr import MPFR, in_mpf

START_DIGITS = 12  # of the stage with full Newton steps
DIFFERENCE = 2.0**-33  # of the logarithms, for derivatives
SMALL_STEP = 1e-9  # after it the Jacobian is kept
LARGEST_CHANGE = 1.0  # of a logarithm in one step
MOST_STEPS = 60
LARGEST_START = 4  # squared height up to which the normal form is of use
MOST_HALVINGS = 12
GUARD_DIGITS = 15
GOOD_REDUCTION = 0.2  # of the residual by one step


class NoTodaTorus(SymfpuError):
    """No torus with these frequencies or actions was found; raised by `toda_torus`.

    seeds, heights : of the last iterate; residual : relative to what was asked. Ours.
    """

    def __init__(
        self, seeds: Sequence[int], heights: Sequence[float], residual: float
    ) -> None:
        self.seeds = tuple(seeds)
        self.heights = tuple(heights)
        self.residual = residual
        last = ", ".join(f"h_{q} = {h:.3g}" for q, h in zip(seeds, heights, strict=True))
        super().__init__(
            f"no Toda torus found: the last iterate {last} leaves a relative residual of "
            f"{residual:.3g}; raise the frequency of the lowest gap, or ask for actions"
        )


@dataclass(frozen=True)
class Found:
    """Bands with sum c_j = 0, the heights of the seeds' gaps, and the curve of the chain."""

    bands: Edges
    points: Numbers
    heights: Numbers
    curve: SpectralCurve


@dataclass(frozen=True)
class Search:
    """What is asked: `given` are frequencies, or actions, by seed in the order of the seeds."""

    N: int
    a: Fraction
    fixed: bool
    seeds: tuple[int, ...]
    given: tuple[Fraction, ...]
    by_action: bool

    @property
    def ring(self) -> int:
        return 2 * self.N if self.fixed else self.N

    def run(self, digits: int) -> Found:
        """The torus to so many digits; with guard digits, that the heights say, for its energy."""
        with working_digits(START_DIGITS):
            extra = guard_digits(float(min(self._start())))
        with working_digits(START_DIGITS + extra):
            u, jacobian, points = self._newton(self._start())
            extra = guard_digits(float(min(u)))
        with working_digits(digits + extra):
            return _in_mpf(self._chords(u, jacobian, points))

    def _start(self) -> Numbers:
        """Logarithms of the squared heights from the normal form of fourth order."""
        linear = self._linear()
        wanted = self._wanted()
        a = MPFR.number(self.a)
        actions = wanted if self.by_action else (wanted - linear) * self.ring / (2 * a**2)
        best = int(np.argmax(actions))
        if actions[best] <= 0:
            allowed = f"above the linear frequency {float(linear[best]):.12g}"
            argument = f"frequencies, omega_{self.seeds[best]}"
            advice = "the Toda chain hardens: take larger ones"
            raise InputError(argument, float(self.given[best]), allowed, advice)
        least = actions[best] / 1000
        positive = np.array([max(x, least) for x in actions], dtype=object)
        squares = 8 * self.ring * a**2 * positive / linear
        return np.array([gmpy2.log(min(x, LARGEST_START)) for x in squares], dtype=object)

    def _wanted(self) -> Numbers:
        return MPFR.array(list(self.given))

    def _largest_shift(self) -> Any:
        return max(abs(self._wanted() - self._linear()))

    def _linear(self) -> Numbers:
        angles = MPFR.array(self.seeds) * MPFR.pi / self.ring
        return 2 * MPFR.sin(angles)

    def _newton(self, u: Numbers) -> tuple[Numbers, Floats, Numbers]:
        """The heights up to SMALL_STEP, the Jacobian, the critical points.

        The Jacobian is kept by Broyden's rank-one changes while they serve.
        """
        residual, points = self._residual(u, free_points(self.N))
        jacobian = self._jacobian(u, residual, points)
        for _ in range(MOST_STEPS):
            step = _solution(jacobian, residual)
            if _size(step) < SMALL_STEP:
                return u, self._jacobian(u, residual, points), points
            before = residual
            step = step * min(1, LARGEST_CHANGE / _size(step))
            u, step, residual, points = self._damped(u, step, residual, points)
            jacobian = _broyden(jacobian, step, residual - before)
            if _size(residual) > GOOD_REDUCTION * _size(before):
                jacobian = self._jacobian(u, residual, points)
        raise self._failure(u, residual)

    def _damped(
        self, u: Numbers, step: Numbers, residual: Numbers, points: Numbers
    ) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """The point after the step, halved until the residual is smaller, and that step."""
        for _ in range(MOST_HALVINGS):
            trial, near = self._residual(u + step, points)
            if _size(trial) < _size(residual):
                return u + step, step, trial, near
            step = step / 2
        raise self._failure(u, residual)

    def _failure(self, u: Numbers, residual: Numbers) -> NoTodaTorus:
        heights = [float(h) for h in _heights(u)]
        return NoTodaTorus(self.seeds, heights, _size(residual))

    def _jacobian(self, u: Numbers, residual: Numbers, points: Numbers) -> Floats:
        columns = []
        for k in range(len(u)):
            moved = u.copy()
            moved[k] += DIFFERENCE
            changed, _ = self._residual(moved, points)
            columns.append(((changed - residual) / DIFFERENCE).astype(float))
        return np.array(columns).T

    def _chords(self, u: Numbers, jacobian: Floats, points: Numbers) -> Found:
        """Steps with the last Jacobian, down to the working precision."""
        last = gmpy2.inf()
        while True:
            residual, points = self._residual(u, points)
            size = max(abs(r) for r in residual)
            if size == 0 or size >= last / 2:
                return self._found(u, points)
            u = u + _solution(jacobian, residual)
            last = size

    def _residual(self, u: Numbers, points: Numbers) -> tuple[Numbers, Numbers]:
        """What is too much, relative to the actions, or to the largest shift of a frequency."""
        found = self._found(u, points)
        wanted = self._wanted()
        if self.by_action:
            values, scale = found.curve.actions()[found.curve.open], wanted
        else:
            values, scale = found.curve.open_frequencies(), self._largest_shift()
        return (values - wanted) / scale, found.points

    def _found(self, u: Numbers, near: Numbers) -> Found:
        heights = MPFR.zeros((self.N - 1,))
        heights[[q - 1 for q in self.seeds]] = _heights(u)
        points = critical_points(heights, near)
        bands = edges(points, heights)
        placed = bands.shifted(-1 - bands.bottom) if self.fixed else bands
        curve = SpectralCurve(placed, self.N, self.fixed, self.a, MPFR)
        return Found(bands, points, heights, curve)


def _solution(jacobian: Floats, residual: Numbers) -> Numbers:
    """The step of Newton's method, also where the residual is far below the doubles."""
    size = max(abs(r) for r in residual)
    if size == 0:
        return residual
    scaled = (residual / size).astype(float)
    direction = MPFR.array(np.linalg.solve(jacobian, scaled))
    return np.asarray(direction * -size)


def _broyden(jacobian: Floats, step: Numbers, change: Numbers) -> Floats:
    """The nearest matrix that takes the step to the change of the residual."""
    s, y = step.astype(float), change.astype(float)
    correction = np.outer(y - jacobian @ s, s) / (s @ s)
    return np.asarray(jacobian + correction)


def _heights(u: Numbers) -> Numbers:
    return MPFR.exp(u / 2)


def _size(values: Numbers) -> float:
    return float(max(abs(x) for x in values))


def _in_mpf(found: Found) -> Found:
    bands, placed = (_edges_in_mpf(e) for e in (found.bands, found.curve.edges))
    curve = replace(found.curve, edges=placed, numbers=MULTIPRECISION)
    return Found(bands, in_mpf(found.points), in_mpf(found.heights), curve)


def _edges_in_mpf(edges: Edges) -> Edges:
    outer = in_mpf(np.array([edges.top, edges.bottom], dtype=object))
    return Edges(in_mpf(edges.centres), in_mpf(edges.half_widths), *outer)


def guard_digits(logarithm: float) -> int:
    """Energies and shifts are small as squared heights beside numbers of order one.

    logarithm : of the least squared height.
    """
    return GUARD_DIGITS + max(0, math.ceil(-logarithm / math.log(10)))
