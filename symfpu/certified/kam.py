"""What stands between a computed torus of two degrees of freedom and a true one: KAM in numbers.

No proof: the size of what the first step of a proof would ask for (docs/tori-proofs.md), in
doubles. Norms are sum |a[nu]| exp(rho |nu|), |nu| = sum |nu_i|.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from symfpu.certified.bounds import Frame, Inverse
from symfpu.certified.frame import directions_of
from symfpu.certified.rounded_torus import RoundedTorus, residual_of, rounded_torus
from symfpu.certified.series import Series
from symfpu.errors import InputError
from symfpu.files.progress import unheard
from symfpu.refinement.lattice import Floats
from symfpu.tori.torus import Torus

LOSS = 12  # the first step takes rho / 12 of the strip, as published theorems do
STRIPS = tuple(0.05 * k for k in range(1, 41))
STEPS_FACTOR = 16  # every step has half the loss of the one before: X^2 grows by 2^4
ROUNDED = 1 - 1e-12  # of gamma, for the rounding of doubles
NEAR = Fraction(1, 10**20)  # of the ratio of frequencies to the number that it stands for


@dataclass(frozen=True)
class KamSizes:
    """The factors of 16 (1/2) |D^3 H| |M|^2 |L|^2 X^2 |e| < 1; dimensionless, doubles, no bounds.

    gamma : |k.omega| >= gamma / |k|, proved. strip : rho, the best of some; loss : delta.
    residual : |e| at rho. frame, inverse : norms of M and L there. twist, untwist : |Lambda| and
    |Lambda^-1|. solved : X, of the solution of the linearised equation by its right-hand side.
    curvature : |D^3 H|. product : what has to be below 1.
    resonance : the least |k| with k.omega = 0 of the typed, rational frequencies.
    """

    gamma: float
    strip: float
    loss: float
    residual: float
    frame: float
    inverse: float
    twist: float
    untwist: float
    solved: float
    curvature: float
    product: float
    resonance: int


def kam_sizes(torus: Torus, polynomial: tuple[int, int, int]) -> KamSizes:
    """The sizes for a torus of N = 3 whose omega_2/omega_1 stands for an irrational number.

    polynomial : integers (a, b, c) of a x^2 + b x + c, without rational roots; the ratio is a
        root to 20 digits or more, and the statement would be about the root.
    Raises InputError for another chain, seeds, or ratio.

    >>> from fractions import Fraction
    >>> from symfpu import Chain, lindstedt, refine, solve_amplitudes
    >>> from symfpu.certified.kam import kam_sizes, root_near
    >>> noble = (61, -209, 179)
    >>> first = Fraction("0.9999")
    >>> second = first * root_near(noble, Fraction("1.7314"), 60)
    >>> series = lindstedt(Chain(3, alpha="0.3"), (1, 2), (first, second), 6)
    >>> kam_sizes(refine(solve_amplitudes(series), digits=30), noble).product < 1e-6
    True
    """
    if torus.chain.N != 3 or torus.seeds != (1, 2):
        given = f"seeds {torus.seeds} of N = {torus.chain.N}"
        raise InputError("torus", given, "seeds 1, 2 of N = 3", "take the smallest chain")
    rounded = rounded_torus(torus)
    gamma = diophantine(rounded.omega, polynomial)
    frame = Frame(rounded, directions_of(torus, unheard))
    left = residual_of(rounded)
    found = [_sizes(rounded, frame, left, gamma, rho) for rho in STRIPS]
    return min(found, key=lambda sizes: sizes.product)


def diophantine(omega: Sequence[Fraction], polynomial: tuple[int, int, int]) -> float:
    """gamma with |k.omega| >= gamma / |k| for omega_1 (1, x), x the root of a quadratic.

    With y = |k_1 + k_2 x| and d = |x - x'|, a y (y + |k_2| d) is at least |a (k_1 + k_2 x) (k_1 +
    k_2 x')|, a whole number that is not zero. So y >= (2/a) / (|k_2| (d + sqrt(d^2 + 4/a))), and
    |k_2| <= |k|; where k_2 = 0, y is at least 1.
    """
    a, b, c = polynomial
    discriminant = b * b - 4 * a * c
    if not a or discriminant <= 0 or math.isqrt(discriminant) ** 2 == discriminant:
        raise InputError(
            "polynomial", polynomial, "one with irrational roots", "take another"
        )
    ratio = omega[1] / omega[0]
    value, slope = a * ratio**2 + b * ratio + c, 2 * a * ratio + b
    if not slope or abs(value / slope) > NEAR:
        raise InputError(
            "torus", f"omega_2/omega_1 = {float(ratio)}", "a root", "see root_near"
        )
    apart = math.sqrt(discriminant) / abs(a)
    least = 2 / abs(a) / (apart + math.sqrt(apart**2 + 4 / abs(a)))
    return float(omega[0]) * min(1.0, least) * ROUNDED


def root_near(polynomial: tuple[int, int, int], guess: Fraction, digits: int) -> Fraction:
    """The root of a x^2 + b x + c near a guess, to so many digits, by Newton's method."""
    a, b, c = polynomial
    x = guess
    for _ in range(digits.bit_length() + 4):
        x = x - (a * x * x + b * x + c) / (2 * a * x + b)
        x = Fraction(round(x * 10 ** (digits + 3)), 10 ** (digits + 3))
    return x


def _sizes(
    torus: RoundedTorus, frame: Frame, left: Sequence[Series], gamma: float, rho: float
) -> KamSizes:
    inverse = Inverse(frame)
    by_x, by_y = inverse.rows()
    delta = rho / LOSS
    twist = np.array([[float(t) for t in d.twist] for d in frame.directions]).T
    forth, back = row_norm(twist), row_norm(np.linalg.inv(twist))
    small = 2 / (math.e * gamma * delta)  # of 1/(k.omega), half of the loss each time
    solved = max(small + back, small + forth * small**2)
    columns = [sizes_of([*c.x, *c.y], rho) for c in inverse.columns]
    M = float(np.sum(columns, axis=0).max())
    L = max(sum(sizes_of([*x, *y], rho)) for x, y in zip(by_x, by_y, strict=True))
    residual = max(sizes_of(left, rho))
    curvature = third(torus, rho)
    product = STEPS_FACTOR * curvature / 2 * (M * L * solved) ** 2 * residual
    return KamSizes(
        gamma=gamma,
        strip=rho,
        loss=delta,
        residual=residual,
        frame=M,
        inverse=L,
        twist=forth,
        untwist=back,
        solved=solved,
        curvature=curvature,
        product=product,
        resonance=least_resonance(torus.omega),
    )


def row_norm(matrix: Floats) -> float:
    """The largest sum of a row's sizes."""
    return float(np.abs(matrix).sum(axis=1).max())


def sizes_of(row: Sequence[Series], rho: float) -> list[float]:
    """One by one."""
    return [size(series, rho) for series in row]


def size(series: Series, rho: float) -> float:
    """sum |a[nu]| exp(rho |nu|), nearly."""
    lengths = sum(
        np.abs(np.arange(-m, m + 1)).reshape([-1 if i == axis else 1 for i in range(2)])
        for axis, m in enumerate(series.highest)
    )
    values = np.abs(np.ldexp(series.values.astype(float), -series.places))
    return float((values * np.exp(rho * np.asarray(lengths))).sum())


def third(torus: RoundedTorus, rho: float) -> float:
    """8 max |V'''(r_j)|: two bonds push a particle, and a stretch is two displacements."""
    bonds = torus.stretches(torus.bits)
    lengths = [size(r, rho) for r in bonds]
    degrees = [(k, float(abs(c))) for k, c in torus.couplings.items()]
    sums = [sum(c * k * (k - 1) * r ** (k - 2) for k, c in degrees) for r in lengths]
    return 8 * max(sums)


def least_resonance(omega: Sequence[Fraction]) -> int:
    """|k| of the first k with k.omega = 0 of rational frequencies: they are never Diophantine."""
    ratio = omega[1] / omega[0]
    return ratio.numerator + ratio.denominator
