"""Proof that a truncated frequency series has a root: interval Newton in ball arithmetic.

The balls are python-flint's arb.

For the equations F(y) = 0 in y = A^2, a box Y around y0 and the Jacobian J(Y) of all its points,
N = y0 - J(Y)^-1 F(y0) holds every root in Y; if N lies inside Y there is exactly one (Krawczyk,
Moore). Coefficients enter as balls that hold the exact ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
import mpmath

from symfpu.algebra.polynomials import (
    Polynomial,
    evaluate,
    powers_of,
    roots_by_order,
)
from symfpu.chain.chain import Chain
from symfpu.series.series import LindstedtSeries
from symfpu.tori.from_series import RootCertificate

EXTRA_BITS = 64  # of the balls beyond the coefficients


def certify_root(
    series: LindstedtSeries, squares: Sequence[Any], frequency_order: int
) -> RootCertificate:
    """Whether exactly one root of the truncated series has A within 10^-digits of these A^2.

    The distance is relative; the series is cut at frequency_order.

    squares : A^2 by seed, mpf. Never raises for a root that cannot be certified: the certificate
    says which inequality failed.
    """
    digits, seeds = series.digits, series.seeds
    assert digits is not None
    with flint.ctx.workprec(series.bits + EXTRA_BITS):
        balls = frequency_balls(series)[: frequency_order + 1]
        tolerance = flint.arb(10) ** -digits
        point = [_exact_ball(y) for y in squares]
        radii = [y * tolerance for y in point]
        box, reached = [], {}
        for q, y, radius in zip(seeds, point, radii, strict=True):
            box.append(flint.arb(y, radius.upper()))
            reached[q] = _lower((y + radius).sqrt() - y.sqrt())
        left, _ = _equations(series, balls, point)
        _, jacobian = _equations(series, balls, box)
        value = flint.arb_mat([[f] for f in left])
        slope = flint.arb_mat(jacobian)
        try:
            step = slope.solve(value)
        except ZeroDivisionError:
            reason = "the Jacobian may be singular within the box"
            return RootCertificate(False, reached, reason)
        for i, (q, radius) in enumerate(zip(seeds, radii, strict=True)):
            step_bound = step[i, 0].abs_upper()
            allowed = radius.abs_lower()
            if not step_bound < allowed:
                bounds = (
                    f"bounded by {float(step_bound):.3g}, not below {float(allowed):.3g}"
                )
                reason = f"seed {q}: the Newton step of A^2 is only {bounds}"
                return RootCertificate(False, reached, reason)
    return RootCertificate(True, reached)


def _equations(
    series: LindstedtSeries, balls: list[list[Polynomial]], point: Sequence[Any]
) -> tuple[list[Any], list[list[Any]]]:
    """Truncated series minus the chosen frequency for every seed, and its Jacobian."""
    assert series.frequencies is not None
    last = balls[-1]
    last_order = len(balls) - 1
    highest = max((sum(e) for p in last for e in p), default=0)
    expected = series.chain.degree_step * last_order // 2
    powers = powers_of(point, max(highest, expected), flint.arb(1))
    zero = flint.arb(0)
    values, jacobian = [], []
    for i, frequency in enumerate(series.frequencies):
        parts = [evaluate(row[i], powers) for row in balls]
        truncated = sum((value for value, _ in parts), start=zero)
        values.append(truncated - ball(frequency))
        slopes = []
        for j in range(len(point)):
            slope = sum((gradient[j] for _, gradient in parts), start=zero)
            slopes.append(slope)
        jacobian.append(slopes)
    return values, jacobian


def frequency_balls(series: LindstedtSeries) -> list[list[Polynomial]]:
    """mu^k omega_q^(k) as polynomials in A^2, by order and seed.

    Their coefficients are balls that hold the exact ones.

    At the working precision of python-flint; for series with digits.
    """
    chain = series.chain
    mu = _coupling_ball(chain)
    variable_unit = abs(mu) if chain.degree_step == 1 else abs(mu).sqrt()
    kappa = variable_unit * ball(series.unit)
    linear = []
    for q in series.seeds:
        half_angle = flint.fmpq(q, 2 * chain.N)
        linear.append(2 * flint.arb.sin_pi_fmpq(half_angle))
    slopes = [(kappa * w / 2) ** 2 for w in linear]
    squares = [_squared_frequency(series, i, w) for i, w in enumerate(linear)]
    return roots_by_order(squares, linear, slopes, negative=chain.mu < 0)


def _coupling_ball(chain: Chain) -> Any:
    """mu: c_3/sqrt(2N), or c_4/(2N) where V is even."""
    if chain.potential.even:
        return ball(chain.unit_coupling / (2 * chain.N))
    root = flint.arb(2 * chain.N).sqrt()
    return ball(chain.unit_coupling) / root


def _squared_frequency(series: LindstedtSeries, i: int, linear: Any) -> list[Polynomial]:
    """[omega_q^2]^(k) of the i-th seed for every order, in the variables of the ring's tables."""
    place = flint.arb(2) ** -series.bits
    at_rest = (0,) * len(series.seeds)
    squares: list[Polynomial] = [{at_rest: linear**2}]
    for k in range(1, series.order + 1):
        diagonal = series.grading.diagonal(series.chain.degree_step * k).tolist()
        terms: Polynomial = {}
        if diagonal:
            whole = series.corrections[k].integers([i])[:, 0]
            radii = series.radii[k][1][:, i]
            for monomial, c, radius in zip(diagonal, whole, radii, strict=True):
                coefficient = flint.arb(int(c), float(radius))
                terms[tuple(monomial)] = linear**2 * place * coefficient
        squares.append(terms)
    return squares


def ball(value: Fraction) -> Any:
    """A ball that holds an exact fraction."""
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


def _exact_ball(value: Any) -> Any:
    """The ball of radius zero at an mpf."""
    negative, mantissa, exponent, _ = value._mpf_
    whole = -int(mantissa) if negative else int(mantissa)
    scale = flint.arb(2) ** int(exponent)
    return flint.arb(whole) * scale


def _lower(value: Any) -> Any:
    """A lower bound of a positive ball as mpf, rounded down to 30 bits."""
    mantissa, exponent = value.abs_lower().man_exp()
    rounded = mpmath.libmp.from_man_exp(int(mantissa), int(exponent), 30, "d")
    return mpmath.mp.make_mpf(rounded)
