"""The discriminant of a Toda ring from the heights of its gaps.

The discriminant Delta(z) = trace of the transfer matrix over n sites is a polynomial of degree n
with leading coefficient 2^n. Its n - 1 critical points c_1 > ... > c_(n-1) are real, one in each
gap, and Delta(c_j) = (-1)^j 2 cosh h_j with h_j >= 0; the gap j is closed where h_j = 0. Any
heights belong to exactly one such polynomial, up to a shift of z (Marchenko and Ostrovskii; for
polynomials MacLane). It is found here from

    log int_(c_(j+1))^(c_j) |Delta'| dz = log(2 cosh h_j + 2 cosh h_(j+1)),  sum c_j = 0,

n - 1 equations for the n - 1 critical points, where |Delta'| = 2^n n prod |z - c_k|. Gauss-Legendre
quadrature with n/2 nodes is exact for it. Newton's method in doubles gives all of their digits; the
same matrix then corrects residuals computed with any number of digits.

Edges are the points of Delta = +-2. They are found as distances from the critical point next to
them, so a gap keeps its relative accuracy however small it is. Source: ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import gmpy2
import numpy as np
from numpy.typing import NDArray

from symfpu.errors import SymfpuError
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.mpfr import MPFR

Floats = NDArray[np.float64]
MOST_STEPS = 200
ROUNDING = 1e-14  # of critical points, which are of order one
SMALLEST_STEP = 1e-12  # of a damped step of Newton's method
CLOSE = 1e-12  # logarithms of distances, from where on they are as good as they get
NEAR = 1e-9  # critical points so near to the start that the digits of the start are worth keeping


class NoDiscriminant(SymfpuError):
    """Newton's method did not find the polynomial with the given heights.

    Raised by `toda_torus` at energies that are too large.

    heights : h_j, dimensionless; residual : of the logarithmic equations. Ours.
    """

    def __init__(self, heights: tuple[float, ...], residual: float) -> None:
        self.heights = heights
        self.residual = residual
        largest = max(heights)
        super().__init__(
            f"no discriminant found for gaps of heights up to {largest:.3g} (residual "
            f"{residual:.3g}): take a smaller energy"
        )


@dataclass(frozen=True)
class Edges:
    """Bands of a discriminant: gaps by centre and half width, and the two outer edges.

    centres, half_widths : shape (n-1,), the uppermost gap first; top, bottom : outer edges. All
    numbers are mpf, mpfr or doubles. Dimensionless.
    """

    centres: Numbers
    half_widths: Numbers
    top: Any
    bottom: Any

    def shifted(self, change: Any) -> Edges:
        """The same bands, moved."""
        return Edges(
            self.centres + change,
            self.half_widths,
            self.top + change,
            self.bottom + change,
        )


@lru_cache(maxsize=16)
def _gauss_legendre_of_doubles(count: int) -> tuple[Floats, Floats]:
    return np.polynomial.legendre.leggauss(count)


@lru_cache(maxsize=16)
def gauss_legendre(count: int, precision: int) -> tuple[Numbers, Numbers]:
    """Nodes and weights on -1 .. 1 as mpfr of so many bits.

    Doubles are the start of Newton's method.
    """
    start, _ = _gauss_legendre_of_doubles(count)
    with gmpy2.context(gmpy2.get_context(), precision=precision + 10):
        x = MPFR.array(start)
        steps = int(np.ceil(np.log2(precision / 50 + 1))) + 1
        for _ in range(steps):
            value, slope = _legendre(count, x)
            x = x - value / slope
        _, slope = _legendre(count, x)
        weights = 2 / ((1 - x**2) * slope**2)
    return x, weights


def _legendre(degree: int, x: Numbers) -> tuple[Numbers, Numbers]:
    """A Legendre polynomial and its derivative."""
    before, value = x * 0 + 1, x
    for k in range(1, degree):
        after = ((2 * k + 1) * x * value - k * before) / (k + 1)
        before, value = value, after
    return value, degree * (before - x * value) / (1 - x**2)


def free_points(n: int) -> Floats:
    """Critical points where all gaps are closed: cos(j pi / n), j = 1 .. n-1."""
    return np.asarray(np.cos(np.pi * np.arange(1, n) / n))


def critical_points(heights: Numbers, start: Numbers) -> Numbers:
    """Critical points c_1 > ... > c_(n-1) of the discriminant with these heights, sum c_j = 0.

    heights : h_j >= 0 as mpfr, shape (n-1,); start : critical points of some discriminant near,
    doubles or mpfr. As mpfr at the working precision. Raises NoDiscriminant.
    """
    n = len(heights) + 1
    if n == 2:
        return MPFR.zeros((1,))
    targets = _logarithms(heights)
    near = start.astype(float)
    points, inverse = _in_doubles(targets.astype(float), near, heights)
    if np.abs(points - near).max() > NEAR:
        return _with_digits(targets, MPFR.array(points), inverse)
    return _with_digits(targets, MPFR.array(start), inverse)


def _logarithms(heights: Numbers) -> Numbers:
    """log(2 cosh h_j + 2 cosh h_(j+1)), also for heights whose cosh is beyond the doubles."""
    sums = [gmpy2.cosh(h) for h in heights]
    values = [gmpy2.log(2 * (left + right)) for left, right in pairwise(sums)]
    return np.array(values, dtype=object)


def _in_doubles(targets: Floats, start: Floats, heights: Numbers) -> tuple[Floats, Floats]:
    """Critical points to the accuracy of doubles, and the inverse of the Jacobian there."""
    c = start
    residual, jacobian = _equations(c, targets)
    size = float(np.linalg.norm(residual))
    for _ in range(MOST_STEPS):
        step = np.linalg.solve(jacobian, residual)
        if np.abs(step).max() < ROUNDING:
            break
        damping = 1.0
        while damping > SMALLEST_STEP:
            trial = c - damping * step
            if (np.diff(trial) < 0).all():
                with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                    residual, jacobian = _equations(trial, targets)  # too far: not finite
                if np.linalg.norm(residual) < size:
                    break
            damping /= 2
        else:
            break
        c = trial
        size = float(np.linalg.norm(residual))
    # where no step makes the residual smaller it is rounding, or there is no way on
    if not size < 1e-9 * len(c):
        raise NoDiscriminant(tuple(map(float, heights)), size)
    _, jacobian = _equations(c, targets)
    return c, np.asarray(np.linalg.inv(jacobian), dtype=np.float64)


def _equations(c: Floats, targets: Floats) -> tuple[Floats, Floats]:
    """Residuals of the n - 1 equations and their Jacobian, in doubles."""
    n = len(c) + 1
    nodes, weights = _gauss_legendre_of_doubles(n // 2 + 1)
    middle, half = (c[:-1] + c[1:]) / 2, (c[:-1] - c[1:]) / 2
    z = middle[:, None] + half[:, None] * nodes
    differences = z[:, :, None] - c
    logarithms = np.log(2 * np.abs(differences)).sum(axis=-1) + np.log(2 * n)
    parts = np.exp(logarithms) * weights * half[:, None]
    integrals = parts.sum(axis=1)
    residual = np.append(np.log(integrals) - targets, c.sum())
    slopes = -np.einsum("jx,jxk->jk", parts, 1 / differences) / integrals[:, None]
    return residual, np.vstack([slopes, np.ones(n - 1)])


def _with_digits(targets: Numbers, c: Numbers, inverse: Floats) -> Numbers:
    """Critical points to the working precision, by the inverse Jacobian of doubles."""
    last = gmpy2.inf()
    while True:
        residual = np.append(_logarithms_of_integrals(c) - targets, c.sum())
        size = max(abs(r) for r in residual)
        if size == 0 or size >= last / 2:
            return c
        scaled = (residual / size).astype(float)
        c = c - MPFR.array(inverse @ scaled) * size
        last = size


def _logarithms_of_integrals(c: Numbers) -> Numbers:
    """log of the integral of |Delta'| between neighbouring critical points; shape (n-2,)."""
    n = len(c) + 1
    nodes, weights = gauss_legendre(n // 2 + 1, gmpy2.get_context().precision)
    half = (c[:-1] - c[1:]) / 2
    z = (c[:-1] + c[1:])[:, None] / 2 + half[:, None] * nodes
    slopes = 2 * n * product_of_distances(c, z)
    integrals = (slopes * weights).sum(axis=1) * half
    return MPFR.log(integrals)


def edges(c: Numbers, heights: Numbers) -> Edges:
    """Edges of the bands, from the critical points and the heights of the gaps."""
    centres, half_widths = c.copy(), c * 0
    for k in np.nonzero(heights)[0]:
        rise = 4 * gmpy2.sinh(heights[k] / 2) ** 2
        curvature = _relative_curvature(c, int(k))
        start = gmpy2.sqrt(2 * rise / curvature)
        up = _distance(c, int(k), 1, rise, start)
        down = _distance(c, int(k), -1, rise, start)
        centres[k] = c[k] + (up - down) / 2
        half_widths[k] = (up + down) / 2
    top = c[0] + _distance(c, 0, 1, 2 * gmpy2.cosh(heights[0]) + 2, gmpy2.mpfr(1) / len(c))
    last = len(c) - 1
    rise = 2 * gmpy2.cosh(heights[last]) + 2
    bottom = c[last] - _distance(c, last, -1, rise, gmpy2.mpfr(1) / len(c))
    return Edges(centres, half_widths, top, bottom)


def _relative_curvature(c: Numbers, k: int) -> Any:
    """|Delta''(c_k)|."""
    n = len(c) + 1
    here = np.array([c[k]], dtype=object)
    return 4 * n * product_of_distances(np.delete(c, k), here)[0]


def _distance(c: Numbers, k: int, side: int, rise: Any, start: Any) -> Any:
    """How far from c_k, above (side 1) or below (-1), Delta has changed by so much.

    Newton's method for the logarithm of the change as a function of the logarithm of the distance:
    nearly a straight line for short distances.
    """
    n = len(c) + 1
    nodes, weights = gauss_legendre(n // 2 + 1, gmpy2.get_context().precision)
    distance, last = start, gmpy2.inf()
    while True:
        z = (nodes + 1) * (side * distance / 2)
        change = _change(c, k, z, weights) * distance / 2
        error = gmpy2.log(change / rise)
        if error == 0 or (abs(error) >= last / 2 and abs(error) < CLOSE):
            return distance
        last = abs(error)
        end = np.array([side * distance], dtype=object)
        growth = _slopes_near(c, k, end)[0] * distance / change
        step = -error / growth
        distance = distance * gmpy2.exp(max(min(step, 1), -1))


def _change(c: Numbers, k: int, offsets: Numbers, weights: Numbers) -> Any:
    return (_slopes_near(c, k, offsets) * weights).sum()


def product_of_distances(points: Numbers, places: Numbers) -> Numbers:
    """prod_k 2 |place - point_k|; the shape of places."""
    doubled = 2 * places
    product = doubled * 0 + 1
    for point in 2 * points:
        product = product * (doubled - point)
    return np.asarray(abs(product))


def _slopes_near(c: Numbers, k: int, offsets: Numbers) -> Numbers:
    """|Delta'| at c_k + offsets; the factor of c_k is the offset itself, digits and all."""
    n = len(c) + 1
    others = np.delete(c, k) - c[k]
    return 4 * n * abs(offsets) * product_of_distances(others, offsets)
