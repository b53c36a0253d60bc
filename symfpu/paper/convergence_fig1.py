"""Question (i) of convergence: why the errors of Fig. 1(b, c) stop falling.

The amplitudes stop settling near order 24, and the cancellations stop improving after order 14.
The paper offers frequencies that become commensurable at that precision, and the finite
precision of the amplitudes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import gcd, lcm

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.paper.printed import FIG1_AMPLITUDE_ORDER, TWO_TORUS
from symfpu.series.divisors import divisor
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import frequency_orders, solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.resummation import pade_amplitudes, resum_by_order
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]

DIGITS, MORE_DIGITS = 20, 40
SHOWN_ORDERS = (12, 18, 24, 30, 36, 42)  # of the resummed torus
LONG_ORDER = 42  # beyond the paper's 30, to see what the terms tend to
PRINTED_DIGITS = 7  # of the amplitudes that the paper goes on with
RESONANT_MODE, RESONANT_HARMONIC = 3, (5, -4)
PROBE_SHIFTS = (
    "1e-6",
    "1e-7",
)  # of the probe frequency from the resonance, to extrapolate to it
PROBE_ORDER = 14
REAL_ROOT = 1e-9  # imaginary part below which a root of the probe counts as real
# printed digits, then sqrt 2, sqrt 3
INCOMMENSURABLE_FREQUENCIES = (
    "0.19626000014142135623730950488",
    "0.39046000017320508075688772935",
)
# the divisor of the resonance 12.6 times larger, of the other sign
DETUNED_FREQUENCIES = ("0.19626", "0.39056")


@dataclass(frozen=True)
class Variant:
    """One way to compute Fig. 1(b, c).

    differences : Delta A(k) of all seeds; sums : mu^k S_2(k) of mode 1, order 0 first.
    """

    name: str
    differences: dict[int, tuple[float, ...]]
    sums: Floats = field(repr=False)
    residuals: Floats = field(repr=False)


@dataclass(frozen=True)
class CancellationStudy:
    """Question (i).

    variants : the printed case in doubles, with digits, with rounded amplitudes, with other
    frequencies.
    coincidence : the first harmonic that the printed frequencies bring to rest. ratios : by
    order, how much the coefficient of the resonant harmonic grows from two orders before. divisor
    : its divisor. pole : mu^2 in units of the actual one at which mode 3's own frequency on the
    torus meets the harmonic; 1/pole is the ratio that this predicts. residuals, resummed : of
    truncated and of resummed tori, by order. amplitudes : by frequency order, truncated and
    resummed roots.
    """

    variants: tuple[Variant, ...]
    coincidence: tuple[int, int]
    ratios: dict[int, float]
    divisor: float
    pole: float
    residuals: Floats
    resummed: dict[int, float]
    amplitudes: dict[int, tuple[tuple[float, ...], tuple[float, ...]]]
    assessment: Assessment


def cancellation_study(progress: Progress = unheard) -> CancellationStudy:
    """Compute question (i)."""
    chain, seeds, printed = TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies
    progress("convergence: long series", NO_FRACTION)
    series = lindstedt(chain, seeds, printed, LONG_ORDER, digits=DIGITS)
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    progress("convergence: verdict", NO_FRACTION)
    assessment = assess(series, torus)
    variants = _variants(progress)
    progress("convergence: resummation", NO_FRACTION)
    tori = resum_by_order(torus, SHOWN_ORDERS)
    resummed = {k: t.residual() for k, t in zip(SHOWN_ORDERS, tori, strict=True)}
    amplitudes = {}
    for K in SHOWN_ORDERS:
        roots = pade_amplitudes(series, torus.amplitudes, K)
        truncated = tuple(map(float, torus.origin.history[K]))
        amplitudes[K] = (truncated, tuple(map(float, roots.values())))
    rates = torus.frequencies
    return CancellationStudy(
        variants=variants,
        coincidence=_coincidence(series),
        ratios=growth_ratios(torus),
        divisor=divisor(chain, seeds, rates, RESONANT_MODE, RESONANT_HARMONIC),
        pole=resonant_pole(torus),
        residuals=assessment.residuals,
        resummed=resummed,
        amplitudes=amplitudes,
        assessment=assessment,
    )


def _variants(progress: Progress) -> tuple[Variant, ...]:
    """The printed case and its counterfactuals, to the paper's order."""
    printed = TWO_TORUS.frequencies
    detuned = f"omega_2 = {DETUNED_FREQUENCIES[1]}"
    variants = [_variant("doubles", _series(printed, None, "doubles", progress))]
    name = f"{MORE_DIGITS} digits"
    precise = _series(printed, MORE_DIGITS, name, progress)
    variants.append(_variant(name, precise))
    name = f"amplitudes rounded to {PRINTED_DIGITS} digits"
    progress(f"convergence: {name}", NO_FRACTION)
    variants.append(_variant(name, precise, amplitude_digits=PRINTED_DIGITS))
    name = "incommensurable digits appended"
    variants.append(
        _variant(name, _series(INCOMMENSURABLE_FREQUENCIES, MORE_DIGITS, name, progress))
    )
    variants.append(
        _variant(detuned, _series(DETUNED_FREQUENCIES, None, detuned, progress))
    )
    return tuple(variants)


def _series(
    frequencies: Sequence[str], digits: int | None, name: str, progress: Progress
) -> LindstedtSeries:
    """The series of the paper's torus with some frequencies, to the paper's order."""
    progress(f"convergence: {name}", NO_FRACTION)
    chain, seeds = TWO_TORUS.chain, TWO_TORUS.seeds
    return lindstedt(chain, seeds, frequencies, TWO_TORUS.order, digits=digits)


def _variant(
    name: str, series: LindstedtSeries, *, amplitude_digits: int | None = None
) -> Variant:
    """What a series shows, with its own amplitudes or with rounded ones."""
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    if amplitude_digits is not None:
        shown = [mpmath.nstr(a, amplitude_digits) for a in torus.amplitudes.values()]
        rounded = tuple(map(mpmath.mpf, shown))
        torus = replace(torus.origin, amplitudes=rounded).torus(torus.phases)
    found = assess(series, torus, resummed=False)
    _, lower = found.sums[1]
    return Variant(name, dict(found.differences), lower, found.residuals)


def _coincidence(series: LindstedtSeries) -> tuple[int, int]:
    """The shortest harmonic with nu.omega = 0 for the two chosen frequencies, exactly."""
    assert series.frequencies is not None
    first, second = series.frequencies
    common = lcm(first.denominator, second.denominator)
    a = int(first * common)
    b = int(second * common)
    shared = gcd(a, b)
    return b // shared, -a // shared


def growth_ratios(torus: Torus[FromSeries]) -> dict[int, float]:
    """By order, the coefficient of the resonant harmonic over that two orders before."""
    values = resonant_coefficients(torus)
    return {k: values[k] / values[k - 2] for k in values if k - 2 in values}


def resonant_coefficients(torus: Torus[FromSeries]) -> dict[int, float]:
    """By order, the coefficient of the resonant harmonic in the resonant mode of a 2-torus."""
    series = torus.origin.series
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    first = sum(map(abs, RESONANT_HARMONIC)) - 1
    values: dict[int, float] = {}
    for k in range(first, series.order + 1, 2):
        nu, terms = series.harmonic_terms(amplitudes, k)
        resonant = (nu == RESONANT_HARMONIC).all(axis=1)
        row = int(np.flatnonzero(resonant)[0])
        values[k] = float(terms[row, RESONANT_MODE - 1])
    return values


def resonant_pole(torus: Torus[FromSeries]) -> float:
    """mu^2, in units of the actual one, at which mode 3 is in resonance with the harmonic.

    The nearest real one: a negative one too keeps the series from converging.

    Its frequency of small oscillations on the torus, a series in mu^2, equals |nu.omega| there.
    The mode is made a third seed of amplitude zero with a frequency ever closer to the
    harmonic's: its frequency series then starts at Omega_3, and its divisors are those of the
    harmonic.
    """
    drive = Fraction(0)
    for n, w in zip(RESONANT_HARMONIC, torus.frequencies, strict=True):
        drive += n * w
    first, second = (_probed_pole(torus, abs(drive), shift) for shift in PROBE_SHIFTS)
    far, near = (float(shift) for shift in PROBE_SHIFTS)
    return second + (second - first) * near / (far - near)


def _probed_pole(torus: Torus[FromSeries], drive: Fraction, shift: str) -> float:
    """The pole with the frequency of the probe so far from that of the harmonic."""
    seeds = (*torus.seeds, RESONANT_MODE)
    frequencies = (*torus.frequencies, drive + Fraction(shift))
    probe = lindstedt(torus.chain, seeds, frequencies, PROBE_ORDER)
    squares = [float(torus.amplitudes[q]) ** 2 for q in torus.seeds]
    terms, _ = probe.frequency_terms([*squares, 0.0])
    coefficients = terms[[0, *frequency_orders(probe)], 2].copy()
    coefficients[0] -= float(drive)
    roots = np.polynomial.Polynomial(coefficients).roots()
    real = [float(root.real) for root in roots if abs(float(root.imag)) < REAL_ROOT]
    return min(real, key=abs)
