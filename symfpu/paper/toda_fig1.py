"""Fig. 1 for Toda beside alpha: is the pole of its series the chain's, or the scheme's?

The series keeps chosen frequencies in its divisors, and poles of the scheme need not be those of
the tori. What is the chain's own shows on tori by Newton's method, along a scan of one frequency
through the resonance of mode 3 with the harmonic (5, -4).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.toda import toda
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.integrable.torus import TodaTorus, toda_torus
from symfpu.numbers.typed import decimal
from symfpu.paper.convergence_fig1 import (
    RESONANT_HARMONIC,
    RESONANT_MODE,
    growth_ratios,
    resonant_coefficients,
    resonant_pole,
)
from symfpu.paper.printed import FIG1_AMPLITUDE_ORDER, TWO_TORUS
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.resummation import resum_by_order
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment, assess

Floats = NDArray[np.float64]

GUESS_ORDER = 12  # of the series from which Newton's method starts
EXACT_DIGITS = 15
# omega_2 on both sides of each chain's own resonance, omega_1 as printed
SCANS = {
    "alpha": (
        "0.390436",
        "0.390441",
        "0.390446",
        "0.390449",
        "0.390450",
        "0.390452",
        "0.390453",
        "0.390455",
        "0.390458",
        "0.390461",
        "0.390466",
    ),
    "alpha and beta": (
        "0.390459",
        "0.390464",
        "0.390469",
        "0.390471",
        "0.390472",
        "0.390473",
        "0.390474",
        "0.390475",
        "0.390477",
        "0.390482",
    ),
    "Toda": (
        "0.390458",
        "0.390463",
        "0.390469",
        "0.390471",
        "0.390472",
        "0.390473",
        "0.390474",
        "0.390476",
        "0.390478",
        "0.390482",
        "0.390487",
    ),
}
RESONANCE_BRACKET = ("0.390472", "0.390474")  # omega_2 on both sides of Toda's
RESONANCE_DIGITS = 12  # of omega_2 there
BACKGROUND = 2  # degree of what is smooth in the scan


@dataclass(frozen=True, eq=False)
class SeriesStudy:
    """The series of Fig. 1 in one chain.

    coefficients, ratios : by order, of the resonant harmonic. pole : mu^2 in units of the actual
    one, where the probe says the scheme has it. assessment : of the series. resummed : residual of
    the torus of Pade sums.
    """

    torus: Torus[FromSeries] = field(repr=False)
    coefficients: dict[int, float]
    ratios: dict[int, float]
    pole: float
    assessment: Assessment = field(repr=False)
    resummed: float


@dataclass(frozen=True, eq=False)
class ResonanceScan:
    """The coefficient of the resonant harmonic on tori of one chain, omega_2 by omega_2.

    frequencies, coefficients : (S,). resonance : omega_2 where mode 3 meets the harmonic; residue :
    of the coefficient there, in units of omega_2. worst : largest residual of the tori.
    """

    frequencies: Floats = field(repr=False)
    coefficients: Floats = field(repr=False)
    resonance: float
    residue: float
    worst: float


@dataclass(frozen=True, eq=False)
class Fig1Study:
    """Series and scans by chain, in the order of `chains_of`; exact : the Toda torus."""

    series: dict[str, SeriesStudy]
    scans: dict[str, ResonanceScan]
    exact: TodaTorus


def chains_of(chain: Chain) -> dict[str, Chain]:
    """An alpha chain, the FPU chain nearest to Toda's, and Toda's, all with the same c_3."""
    a = chain.alpha
    both = Chain(chain.N, alpha=a, beta=2 * a**2 / 3)
    return {
        "alpha": chain,
        "alpha and beta": both,
        "Toda": Chain(chain.N, potential=toda(a)),
    }


def fig1_study(progress: Progress = unheard) -> Fig1Study:
    """Series, scans and the exact Toda torus of Fig. 1."""
    chains = chains_of(TWO_TORUS.chain)
    series = {}
    scans = {}
    for name, chain in chains.items():
        progress(f"toda: Fig. 1, series of {name}", NO_FRACTION)
        series[name] = series_study(chain)
        scans[name] = _scan(name, chain, progress)
    exact = exact_torus(chains["Toda"], TWO_TORUS.frequencies)
    return Fig1Study(series, scans, exact)


def exact_torus(chain: Chain, frequencies: Sequence[str]) -> TodaTorus:
    """The Toda torus of the seeds of Fig. 1, by the spectral curve."""
    return toda_torus(chain, TWO_TORUS.seeds, frequencies=frequencies, digits=EXACT_DIGITS)


def series_study(chain: Chain, order: int = TWO_TORUS.order) -> SeriesStudy:
    """The series of a chain with the printed frequencies, and where it has its pole."""
    series = lindstedt(chain, TWO_TORUS.seeds, TWO_TORUS.frequencies, order)
    frequency_order = min(order, FIG1_AMPLITUDE_ORDER)
    torus = solve_amplitudes(series, frequency_order=frequency_order)
    (resummed,) = resum_by_order(torus, (order,))
    return SeriesStudy(
        torus=torus,
        coefficients=resonant_coefficients(torus),
        ratios=growth_ratios(torus),
        pole=resonant_pole(torus),
        assessment=assess(series, torus, resummed=False),
        resummed=resummed.residual(),
    )


def refined_two_torus(chain: Chain, second: str) -> Torus[Newton]:
    """The torus of seeds 1, 2 with the printed omega_1 and another omega_2, by Newton's method."""
    frequencies = (TWO_TORUS.frequencies[0], second)
    series = lindstedt(chain, TWO_TORUS.seeds, frequencies, GUESS_ORDER)
    return refine(solve_amplitudes(series))


def resonant_coefficient(torus: Torus[Newton]) -> float:
    """The coefficient of the harmonic (5, -4) in mode 3."""
    resonant = (torus.harmonics == RESONANT_HARMONIC).all(axis=1)
    (row,) = np.flatnonzero(resonant)
    return float(torus.cosines[row, RESONANT_MODE - 1])


def _scan(name: str, chain: Chain, progress: Progress) -> ResonanceScan:
    progress(f"toda: Fig. 1, {name} through its resonance", NO_FRACTION)
    known = toda_resonance(chain) if name == "Toda" else None
    return resonance_scan(chain, SCANS[name], known)


def resonance_scan(
    chain: Chain, frequencies: Sequence[str], known: float | None
) -> ResonanceScan:
    """Tori on both sides of a resonance, and the residue of what grows there.

    known : omega_2 of the resonance; None : the pole of the coefficients themselves.
    """
    tori = [refined_two_torus(chain, second) for second in frequencies]
    coefficients = np.array([resonant_coefficient(torus) for torus in tori])
    omega = np.array([float(second) for second in frequencies])
    resonance = _pole_of(omega, coefficients) if known is None else known
    residue = _residue(omega, coefficients, resonance)
    worst = max(torus.residual() for torus in tori)
    return ResonanceScan(omega, coefficients, resonance, residue, worst)


def toda_resonance(chain: Chain) -> float:
    """omega_2 at which the exact frequency of mode 3 about the Toda torus is the harmonic's.

    By the secant through two frequencies on both sides of it.
    """
    low, high = map(Fraction, RESONANCE_BRACKET)
    below, above = (detuning(chain, decimal(second)) for second in (low, high))
    with mpmath.workdps(EXACT_DIGITS):
        share = below / (below - above)
        return float(low) + float(share) * float(high - low)


def detuning(chain: Chain, second: str) -> Any:
    """Mode 3's own frequency on the exact Toda torus, less that of the harmonic."""
    torus = exact_torus(chain, (TWO_TORUS.frequencies[0], second))
    rates = zip(RESONANT_HARMONIC, torus.frequencies.values(), strict=True)
    drive = abs(sum(n * w for n, w in rates))
    return torus.normal_frequencies[RESONANT_MODE] - drive


def _pole_of(omega: Floats, coefficients: Floats) -> float:
    """p of c = (polynomial) / (omega - p), by least squares for c omega = p c + polynomial."""
    middle = float(omega.mean())
    x = omega - middle
    scale = float(np.abs(x).max())
    powers = [(x / scale) ** k for k in range(BACKGROUND + 1)]
    table = np.stack([coefficients / scale, *powers], axis=1)
    solution, *_ = np.linalg.lstsq(table, coefficients * x / scale, rcond=None)
    return middle + float(solution[0])


def _residue(omega: Floats, coefficients: Floats, pole: float) -> float:
    """r of c = r / (omega - pole) + polynomial, by least squares with all terms of one size."""
    x = omega - pole
    scale = float(np.abs(x).max())
    powers = [(x / scale) ** k for k in range(BACKGROUND + 1)]
    table = np.stack([scale / x, *powers], axis=1)
    solution, *_ = np.linalg.lstsq(table, coefficients, rcond=None)
    return float(solution[0]) * scale
