"""Question (ii) of convergence: is the amplitude of Fig. 9 that of a periodic orbit?

The amplitude found at order 242, and the orbit with the printed frequency.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import breather_of_amplitude, breather_of_frequency
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.families.family import Family
from symfpu.families.following import family
from symfpu.families.members import Member
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.typed import Number
from symfpu.paper.printed import FIG9_BREATHER
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import frequency_orders, solve_amplitudes
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]

BREATHER_DIGITS = 30
SINGULARITY_TERMS = (
    60  # last terms of the frequency series to which its singularity is fitted
)
LIMIT_ORDER = 160  # of the series whose ends are followed along a family
LIMIT_ENERGIES = ("0.0005", "0.05")  # where the family is followed for the picture
LIMIT_POINTS = 14
LIMIT_TOLERANCE = 1e-12  # of its frequency


@dataclass(frozen=True)
class BreatherStudy:
    """Question (ii).

    orbit : the periodic orbit with the printed frequency, by Newton. at_printed : the one with
    the printed amplitude. amplitudes : A(K). singularity : amplitude at which the frequency series
    with these divisors ends, from the ratios of its terms, with the spread of the fit. assessment
    : of the series at the printed order.
    """

    orbit: Torus
    at_printed: Torus
    amplitudes: dict[int, float]
    singularity: float
    spread: float
    exponent: float
    assessment: Assessment
    limit: SchemeLimit


@dataclass(frozen=True)
class SchemeLimit:
    """Where the series with chosen frequencies ceases to find a family of breathers.

    For a chosen omega the frequency series in A ends at a fold. Up to omega_limit it reaches
    omega before; beyond, the breather lies behind the fold. orbit : the breather there.
    frequencies, amplitudes : of the family; ends : amplitude at which the series with these
    divisors ends. family : on both sides of the limit.
    """

    orbit: Torus
    frequencies: tuple[float, ...]
    amplitudes: tuple[float, ...]
    ends: tuple[float, ...]
    family: Family = field(repr=False)


def breather_study(progress: Progress = unheard) -> BreatherStudy:
    """Compute question (ii)."""
    chain, seeds, rates = (
        FIG9_BREATHER.chain,
        FIG9_BREATHER.seeds,
        FIG9_BREATHER.frequencies,
    )
    (seed,) = seeds
    progress("convergence: breather series", NO_FRACTION)
    series = lindstedt(chain, seeds, rates, FIG9_BREATHER.order, digits=BREATHER_DIGITS)
    torus = solve_amplitudes(series)
    progress("convergence: breather verdict", NO_FRACTION)
    assessment = assess(series, torus)
    singularity, spread, exponent = _singularity(series)
    progress("convergence: periodic orbits", NO_FRACTION)
    printed = float(FIG9_BREATHER.amplitudes[0])
    amplitudes = {K: float(a[0]) for K, a in torus.origin.history.items()}
    return BreatherStudy(
        orbit=breather_of_frequency(chain, seed, rates[0]),
        at_printed=breather_of_amplitude(chain, seed, printed),
        amplitudes=amplitudes,
        singularity=singularity,
        spread=spread,
        exponent=exponent,
        assessment=assessment,
        limit=scheme_limit(chain, seed, LIMIT_ENERGIES, progress),
    )


def scheme_limit(
    chain: Chain, seed: int, energies: tuple[str, str], progress: Progress = unheard
) -> SchemeLimit:
    """Follow the breathers of a seed between two energies, to where their series end before them.

    Those are the series with fixed frequency. Raises InputError where the limit does not lie
    between the energies.
    """
    progress("convergence: family of breathers", NO_FRACTION)
    found = family(chain, (seed,), energies[1], from_energy=energies[0])
    chosen = _spread_members(found)
    rates = [float(m.torus.frequencies[0]) for m in chosen]
    progress("convergence: ends of the series along the family", NO_FRACTION)
    ends = []
    gaps = []
    for w in rates:
        end, reached = series_end(chain, seed, w)
        ends.append(end)
        gaps.append(reached - w)
    if gaps[0] <= 0 or gaps[-1] >= 0:
        allowed = "two with the limit between them"
        advice = "take the first smaller or the second larger"
        raise InputError("energies", energies, allowed, advice)
    beyond = next(k for k, gap in enumerate(gaps) if gap < 0)
    omega = limit_frequency(chain, seed, rates[beyond - 1], rates[beyond])
    last = chosen[beyond - 1].torus
    assert isinstance(last, Torus)
    orbit = refine(last, frequencies=(omega,))
    amplitudes = tuple(m.amplitudes[seed] for m in chosen)
    return SchemeLimit(orbit, tuple(rates), amplitudes, tuple(ends), found)


def _spread_members(found: Family) -> list[Member]:
    """LIMIT_POINTS members, from the first to the last."""
    last = len(found.members) - 1
    places = np.linspace(0, last, LIMIT_POINTS).round().astype(int)
    return [found.members[k] for k in np.unique(places)]


def limit_frequency(chain: Chain, seed: int, low: float, high: float) -> float:
    """The frequency between two others that its series just reaches at its end."""
    from scipy.optimize import brentq

    def gap(omega: float) -> float:
        _, reached = series_end(chain, seed, omega)
        return reached - omega

    return float(brentq(gap, low, high, xtol=LIMIT_TOLERANCE, rtol=LIMIT_TOLERANCE))


def series_end(chain: Chain, seed: int, omega: Number) -> tuple[float, float]:
    """The amplitude at which the frequency series with omega in its divisors ends.

    And the frequency that it has reached there. At its square-root end the terms fall as
    k^(-3/2); the sum is extrapolated in powers of k^(-1/2).
    """
    series = lindstedt(chain, (seed,), (omega,), LIMIT_ORDER)
    end, _, _ = _singularity(series)
    terms, _ = series.frequency_terms([end**2])
    orders = np.array([0, *frequency_orders(series)])
    linear = np.where(orders == 0, terms[0, 0], 0.0)
    sums = np.cumsum(terms[orders, 0] - linear)
    n = np.arange(1, len(sums) + 1, dtype=float)[-SINGULARITY_TERMS:]
    powers = np.stack([np.ones_like(n), n**-0.5, n**-1.5, n**-2.5], axis=1)
    fit, *_ = np.linalg.lstsq(powers, sums[-SINGULARITY_TERMS:], rcond=None)
    return end, float(terms[0, 0]) + float(fit[0])


def _singularity(series: LindstedtSeries) -> tuple[float, float, float]:
    """Amplitude, its spread, and exponent g of the singularity (x_c - A^2)^g, from ratios of terms.

    a_k / a_(k-1) = (1 - (1 + g) / k + O(1/k^2)) / x_c (Domb and Sykes, Proc. R. Soc. A 240 (1957)
    214), k counting powers of A^2.
    """
    ratios = _term_ratios(series)
    n = np.arange(2, len(ratios) + 2, dtype=float)
    estimates = []
    for last in (SINGULARITY_TERMS, SINGULARITY_TERMS // 2):
        fit = np.polyfit(1 / n[-last:], ratios[-last:], 2)
        x = 1 / fit[2]
        estimates.append((x, -fit[1] / fit[2] - 1))
    (x, g), (other, _) = estimates
    amplitude = np.sqrt(x)
    spread = abs(amplitude - np.sqrt(other))
    return float(amplitude), float(spread), float(g)


def _term_ratios(series: LindstedtSeries) -> Floats:
    """Of the terms of the frequency series, in powers of A^2."""
    orders = frequency_orders(series)
    ratios = []
    with mpmath.workdps(BREATHER_DIGITS):
        unit = mpmath.mpf(1)
        if series.digits is None:
            unit = unit / series.seed_factors[0] ** 2
        terms, _ = series.frequency_terms([unit])
        for a, b in itertools.pairwise(orders):
            ratio = terms[b, 0] / terms[a, 0] / unit
            ratios.append(float(ratio))
    return np.array(ratios)
