"""Two questions that the paper leaves open about the convergence of its series, settled with numbers.

(i) Fig. 1(b, c): why the amplitudes stop settling near order 24 and the cancellations stop
improving after order 14. The paper offers frequencies that become commensurable at that
precision, and the finite precision of the amplitudes. (ii) Fig. 9: is the amplitude found at
order 242 that of a periodic orbit with the printed frequency?
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import lcm

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import PeriodicOrbit, breather_at_amplitude, periodic_orbit
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.families.family import Family, family
from symfpu.numbers.typed import Number
from symfpu.paper.printed import FIG1_AMPLITUDE_ORDER, FIG9_BREATHER, TWO_TORUS
from symfpu.paper.steps import Step, unheard
from symfpu.series.divisors import divisor
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import frequency_orders, solve_amplitudes
from symfpu.tori.resummation import pade_amplitudes, resum_by_order
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]

DIGITS, MORE_DIGITS = 20, 40
SHOWN_ORDERS = (12, 18, 24, 30, 36, 42)  # of the resummed torus
LONG_ORDER = 42  # beyond the paper's 30, to see what the terms tend to
PRINTED_DIGITS = 7  # of the amplitudes that the paper goes on with
RESONANT_MODE, RESONANT_HARMONIC = 3, (5, -4)
PROBE_SHIFTS = ("1e-6", "1e-7")  # of the probe frequency from the resonance, to extrapolate to it
PROBE_ORDER = 14
REAL = 1e-9  # imaginary part below which a root of the probe counts as real
# printed digits, then sqrt 2, sqrt 3
INCOMMENSURABLE = ("0.19626000014142135623730950488", "0.39046000017320508075688772935")
# the divisor of the resonance 12.6 times larger, of the other sign
DETUNED = ("0.19626", "0.39056")
BREATHER_DIGITS = 30
SINGULARITY_TERMS = 60  # last terms of the frequency series to which its singularity is fitted
LIMIT_ORDER = 160  # of the series whose ends are followed along a family
LIMIT_ENERGIES = ("0.0005", "0.05")  # where the family is followed for the picture
LIMIT_POINTS = 14


@dataclass(frozen=True)
class Variant:
    """One way to compute Fig.

    1(b, c). differences : Delta A(k) of all seeds; sums : mu^k S_2(k) of mode 1, order 0 first.
    """

    name: str
    differences: dict[int, tuple[float, ...]]
    sums: Floats = field(repr=False)
    residuals: Floats = field(repr=False)


@dataclass(frozen=True)
class CancellationStudy:
    """Question (i). variants : the printed case in doubles, with digits, with rounded amplitudes,
    with other frequencies.

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


def cancellation_study(step: Step = unheard) -> CancellationStudy:
    """Compute question (i)."""
    chain, seeds, printed = TWO_TORUS.chain, TWO_TORUS.seeds, TWO_TORUS.frequencies
    step("convergence: long series")
    series = lindstedt(chain, seeds, printed, LONG_ORDER, digits=DIGITS)
    torus = solve_amplitudes(series, frequency_order=FIG1_AMPLITUDE_ORDER)
    step("convergence: verdict")
    assessment = assess(series, torus)
    variants = list(_variants(step))
    step("convergence: resummation")
    resummed = {
        k: t.residual()
        for k, t in zip(SHOWN_ORDERS, resum_by_order(torus, SHOWN_ORDERS), strict=True)
    }
    amplitudes = {}
    for K in SHOWN_ORDERS:
        root = pade_amplitudes(series, torus.amplitudes, K)
        amplitudes[K] = (
            tuple(map(float, torus.history[K])),
            tuple(float(a) for a in root.values()),
        )
    return CancellationStudy(
        variants=tuple(variants),
        coincidence=_coincidence(series),
        ratios=_ratios(torus),
        divisor=divisor(chain, seeds, torus.frequencies, RESONANT_MODE, RESONANT_HARMONIC),
        pole=_pole(torus),
        residuals=assessment.residuals,
        resummed=resummed,
        amplitudes=amplitudes,
        assessment=assessment,
    )


def _variants(step: Step) -> list[Variant]:
    """The printed case and its counterfactuals, to the paper's order."""
    cases: tuple[tuple[str, Sequence[str], int | None, int | None], ...] = (
        ("doubles", TWO_TORUS.frequencies, None, None),
        (f"{MORE_DIGITS} digits", TWO_TORUS.frequencies, MORE_DIGITS, None),
        (
            f"amplitudes rounded to {PRINTED_DIGITS} digits",
            TWO_TORUS.frequencies,
            MORE_DIGITS,
            PRINTED_DIGITS,
        ),
        ("incommensurable digits appended", INCOMMENSURABLE, MORE_DIGITS, None),
        (f"omega_2 = {DETUNED[1]}", DETUNED, None, None),
    )
    variants, known = [], {}
    for name, frequencies, digits, rounded in cases:
        step(f"convergence: {name}")
        key = (tuple(frequencies), digits)
        if key not in known:
            known[key] = lindstedt(
                TWO_TORUS.chain, TWO_TORUS.seeds, frequencies, TWO_TORUS.order, digits=digits
            )
        torus = solve_amplitudes(known[key], frequency_order=FIG1_AMPLITUDE_ORDER)
        if rounded:
            torus = replace(
                torus,
                amplitudes={
                    q: mpmath.mpf(mpmath.nstr(a, rounded)) for q, a in torus.amplitudes.items()
                },
            )
        found = assess(known[key], torus, resummed=False)
        variants.append(Variant(name, dict(found.differences), found.sums[1][1], found.residuals))
    return variants


def _coincidence(series: LindstedtSeries) -> tuple[int, int]:
    """The shortest harmonic with nu.omega = 0 for the two chosen frequencies, exactly."""
    assert series.frequencies is not None
    first, second = series.frequencies
    common = lcm(first.denominator, second.denominator)
    a, b = int(first * common), int(second * common)
    divisor_ = int(np.gcd(a, b))
    return b // divisor_, -a // divisor_


def _ratios(torus: QTorus) -> dict[int, float]:
    """By order, the coefficient of the resonant harmonic over that two orders before."""
    series, values = torus.series, {}
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    for k in range(sum(map(abs, RESONANT_HARMONIC)) - 1, series.order + 1, 2):
        nu, table = series.harmonic_terms(amplitudes, k)
        row = int(np.flatnonzero((nu == RESONANT_HARMONIC).all(axis=1))[0])
        values[k] = float(table[row, RESONANT_MODE - 1])
    return {k: values[k] / values[k - 2] for k in values if k - 2 in values}


def _pole(torus: QTorus) -> float:
    """Where the frequency of small oscillations of mode 3 on the torus, a series in mu^2, equals
    |nu.omega| of the resonance.

    The mode is made a third seed of amplitude zero with a frequency ever closer to the
    harmonic's: its frequency series then starts at Omega_3, and its divisors are those of the
    harmonic.
    """
    drive = abs(
        sum(
            (n * w for n, w in zip(RESONANT_HARMONIC, torus.frequencies, strict=True)),
            start=Fraction(0),
        )
    )
    found = []
    for shift in PROBE_SHIFTS:
        probe = lindstedt(
            torus.chain,
            (*torus.seeds, RESONANT_MODE),
            (*torus.frequencies, drive + Fraction(shift)),
            PROBE_ORDER,
        )
        squares = [float(torus.amplitudes[q]) ** 2 for q in torus.seeds]
        terms, _ = probe.frequency_terms([*squares, 0.0])
        coefficients = terms[[0, *frequency_orders(probe)], 2].copy()
        coefficients[0] -= float(drive)
        roots = np.polynomial.Polynomial(coefficients).roots()
        found.append(
            min(float(r.real) for r in roots if abs(float(r.imag)) < REAL and float(r.real) > 0)
        )
    far, near = (float(shift) for shift in PROBE_SHIFTS)
    return found[1] + (found[1] - found[0]) * near / (far - near)


@dataclass(frozen=True)
class BreatherStudy:
    """Question (ii). orbit : the periodic orbit with the printed frequency, by Newton. at_printed :
    the one with the printed amplitude. amplitudes : A(K). singularity : amplitude at which the
    frequency series with these divisors ends, from the ratios of its terms, with the spread of
    the fit. assessment : of the series at the printed order.
    """

    orbit: PeriodicOrbit
    at_printed: PeriodicOrbit
    amplitudes: dict[int, float]
    singularity: float
    spread: float
    exponent: float
    assessment: Assessment
    limit: SchemeLimit


@dataclass(frozen=True)
class SchemeLimit:
    """Where the series with chosen frequencies in its divisors ceases to find a family of breathers.

    For a chosen omega the frequency series in A ends at a fold. Up to omega_limit it reaches
    omega before; beyond, the breather lies behind the fold. orbit : the breather there.
    frequencies, amplitudes : of the family; ends : amplitude at which the series with these
    divisors ends. family : on both sides of the limit.
    """

    orbit: PeriodicOrbit
    frequencies: tuple[float, ...]
    amplitudes: tuple[float, ...]
    ends: tuple[float, ...]
    family: Family = field(repr=False)


def breather_study(step: Step = unheard) -> BreatherStudy:
    """Compute question (ii)."""
    printed = FIG9_BREATHER
    (seed,), (omega,) = printed.seeds, printed.frequencies
    step("convergence: breather series")
    series = lindstedt(
        printed.chain, printed.seeds, printed.frequencies, printed.order, digits=BREATHER_DIGITS
    )
    torus = solve_amplitudes(series)
    step("convergence: breather verdict")
    assessment = assess(series, torus)
    singularity, spread, exponent = _singularity(series)
    step("convergence: periodic orbits")
    return BreatherStudy(
        orbit=periodic_orbit(printed.chain, seed, omega),
        at_printed=breather_at_amplitude(printed.chain, seed, float(printed.amplitudes[0])),
        amplitudes={K: float(a[0]) for K, a in torus.history.items()},
        singularity=singularity,
        spread=spread,
        exponent=exponent,
        assessment=assessment,
        limit=scheme_limit(printed.chain, seed, LIMIT_ENERGIES, step),
    )


def scheme_limit(
    chain: Chain, seed: int, energies: tuple[str, str], step: Step = unheard
) -> SchemeLimit:
    """Follow the breathers of a seed between two energies, and find where their fixed-frequency
    series stop to reach them.

    Raises InputError where the limit does not lie between them.
    """
    step("convergence: family of breathers")
    found = family(chain, (seed,), energies[1], from_energy=energies[0])
    chosen = [
        found.members[k]
        for k in np.unique(np.linspace(0, len(found.members) - 1, LIMIT_POINTS).round().astype(int))
    ]
    rates = [float(m.torus.frequencies[0]) for m in chosen]
    step("convergence: ends of the series along the family")
    ends = [series_end(chain, seed, w) for w in rates]
    gaps = [reached - w for (_, reached), w in zip(ends, rates, strict=True)]
    if gaps[0] <= 0 or gaps[-1] >= 0:
        raise InputError(
            "energies",
            energies,
            "two with the limit between them",
            "take the first smaller or the second larger",
        )
    from scipy.optimize import brentq

    k = next(k for k, gap in enumerate(gaps) if gap < 0)
    omega = brentq(
        lambda w: series_end(chain, seed, w)[1] - w, rates[k - 1], rates[k], xtol=1e-12, rtol=1e-12
    )
    orbit = periodic_orbit(chain, seed, omega, chosen[k - 1].torus)
    return SchemeLimit(
        orbit,
        tuple(rates),
        tuple(m.amplitudes[seed] for m in chosen),
        tuple(a for a, _ in ends),
        found,
    )


def series_end(chain: Chain, seed: int, omega: Number) -> tuple[float, float]:
    """The amplitude at which the frequency series with omega in its divisors ends, and the frequency
    that it has reached there.

    At its square-root end the terms fall as k^(-3/2); the sum is extrapolated in powers of k^(-1/2).
    """
    series = lindstedt(chain, (seed,), (omega,), LIMIT_ORDER)
    end, _, _ = _singularity(series)
    terms, _ = series.frequency_terms([end**2])
    orders = np.array([0, *frequency_orders(series)])
    sums = np.cumsum(terms[orders, 0] - np.where(orders == 0, terms[0, 0], 0.0))
    n = np.arange(1, len(sums) + 1, dtype=float)[-SINGULARITY_TERMS:]
    powers = np.stack([np.ones_like(n), n**-0.5, n**-1.5, n**-2.5], axis=1)
    limit = float(np.linalg.lstsq(powers, sums[-SINGULARITY_TERMS:], rcond=None)[0][0])
    return end, float(terms[0, 0]) + limit


def _singularity(series: LindstedtSeries) -> tuple[float, float, float]:
    """Amplitude, its spread, and exponent g of the singularity (x_c - A^2)^g of the frequency
    series, from ratios of terms.

    a_k / a_(k-1) = (1 - (1 + g) / k + O(1/k^2)) / x_c (Domb and Sykes, Proc. R. Soc. A 240 (1957)
    214), k counting powers of A^2.
    """
    orders = frequency_orders(series)
    with mpmath.workdps(BREATHER_DIGITS):
        unit = (
            mpmath.mpf(1) / series.seed_factors[0] ** 2 if series.digits is None else mpmath.mpf(1)
        )
        terms, _ = series.frequency_terms([unit])
        ratios = np.array(
            [float(terms[b, 0] / terms[a, 0] / unit) for a, b in itertools.pairwise(orders)]
        )
    n = np.arange(2, len(ratios) + 2, dtype=float)
    estimates = []
    for last in (SINGULARITY_TERMS, SINGULARITY_TERMS // 2):
        fit = np.polyfit(1 / n[-last:], ratios[-last:], 2)
        estimates.append((1 / fit[2], -fit[1] / fit[2] - 1))
    (x, g), (other, _) = estimates
    return float(np.sqrt(x)), float(abs(np.sqrt(x) - np.sqrt(other))), float(g)
