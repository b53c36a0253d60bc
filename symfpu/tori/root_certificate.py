"""Proof that a truncated frequency series has a root: interval Newton in ball arithmetic (python-flint's arb).

For the equations F(y) = 0 in y = A^2, a box Y around y0 and the Jacobian J(Y) of all its points, N = y0 - J(Y)^-1 F(y0) holds
every root in Y; if N lies inside Y there is exactly one (Krawczyk, Moore). Coefficients enter as balls that hold the exact ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
import mpmath

from symfpu.algebra.polynomials import Polynomial, evaluate, powers_of, rescaled, square_root
from symfpu.series.series import LindstedtSeries
from symfpu.tori.torus import RootCertificate

EXTRA_BITS = 64  # of the balls beyond the coefficients


def certify_root(series: LindstedtSeries, squares: Sequence[Any], frequency_order: int) -> RootCertificate:
    """Whether exactly one root of the series truncated at frequency_order has A within 10^-digits of these A^2, relative.

    squares : A^2 by seed, mpf. Never raises for a root that cannot be certified: the certificate says which inequality failed.
    """
    digits, seeds = series.digits, series.seeds
    assert digits is not None
    with flint.ctx.workprec(series.bits + EXTRA_BITS):
        balls = frequency_balls(series)[: frequency_order + 1]
        point = [_exact_ball(y) for y in squares]
        radii = [y * flint.arb(10) ** -digits for y in point]
        box = [flint.arb(y, r.upper()) for y, r in zip(point, radii, strict=True)]
        reached = [_lower((y + r).sqrt() - y.sqrt()) for y, r in zip(point, radii, strict=True)]
        value = flint.arb_mat([[f] for f in _equations(series, balls, point)[0]])
        slope = flint.arb_mat(_equations(series, balls, box)[1])
        try:
            step = slope.solve(value)
        except ZeroDivisionError:
            return RootCertificate(False, dict(zip(seeds, reached, strict=True)), "the Jacobian may be singular within the box")
        for i, (q, radius) in enumerate(zip(seeds, radii, strict=True)):
            if not step[i, 0].abs_upper() < radius.abs_lower():
                step_size, allowed = float(step[i, 0].abs_upper()), float(radius.abs_lower())
                reason = f"seed {q}: the Newton step of A^2 is only bounded by {step_size:.3g}, not below {allowed:.3g}"
                return RootCertificate(False, dict(zip(seeds, reached, strict=True)), reason)
    return RootCertificate(True, dict(zip(seeds, reached, strict=True)))


def _equations(series: LindstedtSeries, balls: list[list[Polynomial]], point: Sequence[Any]) -> tuple[list[Any], list[list[Any]]]:
    """Truncated series minus the chosen frequency for every seed, and its Jacobian."""
    assert series.frequencies is not None
    highest = max((sum(e) for p in balls[-1] for e in p), default=0)
    powers = powers_of(point, max(highest, series.chain.degree_step * (len(balls) - 1) // 2), flint.arb(1))
    values, jacobian = [], []
    for i, frequency in enumerate(series.frequencies):
        parts = [evaluate(row[i], powers) for row in balls]
        values.append(sum((value for value, _ in parts), start=flint.arb(0)) - ball(frequency))
        jacobian.append([sum((g[j] for _, g in parts), start=flint.arb(0)) for j in range(len(point))])
    return values, jacobian


def frequency_balls(series: LindstedtSeries) -> list[list[Polynomial]]:
    """mu^k omega_q^(k) as polynomials in A^2, by order and seed, with coefficients in balls that hold the exact ones.

    At the working precision of python-flint; for series with digits.
    """
    chain, step = series.chain, series.chain.degree_step
    linear = [2 * flint.arb.sin_pi_fmpq(flint.fmpq(q, 2 * chain.N)) for q in series.seeds]
    mu = ball(chain.alpha) / flint.arb(2 * chain.N).sqrt() if chain.alpha else ball(chain.beta / (2 * chain.N))
    kappa = (abs(mu) if step == 1 else abs(mu).sqrt()) * ball(series.unit)
    slopes = [(kappa * w / 2) ** 2 for w in linear]
    place = flint.arb(2) ** -series.bits
    by_seed = []
    for i, w in enumerate(linear):
        squares: list[Polynomial] = [{(0,) * len(series.seeds): w**2}]
        for k in range(1, series.order + 1):
            diagonal = series.grading.diagonal(step * k).tolist()
            whole = series.corrections[k].integers([i])[:, 0] if diagonal else ()
            radii = series.radii[k][1][:, i] if diagonal else ()
            balls = [flint.arb(int(c), float(r)) for c, r in zip(whole, radii, strict=True)]
            squares.append({tuple(e): w**2 * place * c for e, c in zip(diagonal, balls, strict=True)})
        signs = [-1.0 if chain.mu < 0 and k % 2 else 1.0 for k in range(series.order + 1)]
        by_seed.append([rescaled(p, slopes, sign) for p, sign in zip(square_root(squares, w), signs, strict=True)])
    return [list(row) for row in zip(*by_seed, strict=True)]


def ball(value: Fraction) -> Any:
    """A ball that holds an exact fraction."""
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


def _exact_ball(value: Any) -> Any:
    """The ball of radius zero at an mpf."""
    sign, mantissa, exponent, _ = value._mpf_
    return flint.arb(-int(mantissa) if sign else int(mantissa)) * flint.arb(2) ** int(exponent)


def _lower(value: Any) -> Any:
    """A lower bound of a positive ball as mpf, rounded down to 30 bits."""
    mantissa, exponent = value.abs_lower().man_exp()
    return mpmath.mp.make_mpf(mpmath.libmp.from_man_exp(int(mantissa), int(exponent), 30, "d"))
