"""Tori of Figs. 1 and 2 in the alpha and in the Toda chain: spectra, gaps, groups D_k.

The gaps of Toda's spectral curve say how far a torus of the alpha chain is from an integrable one:
on a Toda torus all but those of the seeds are closed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.chain.potentials.toda import toda
from symfpu.chain.propagation import first_orders
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.integrable.invariants import toda_gaps
from symfpu.integrable.torus import toda_torus
from symfpu.paper.printed import TWO_TORUS, PrintedTorus
from symfpu.paper.starts import AMPLITUDE_ORDERS, printed_row
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]

# order of the series that Newton's method starts from, frequency order of its amplitudes
GUESS_ORDERS = {
    "Fig. 1": (12, 12),
    "Fig. 2": (6, AMPLITUDE_ORDERS["Fig. 2"]),
}
TOLERANCES = {"Fig. 1": 1e-13, "Fig. 2": 1e-11}  # residuals of the tori
LOOKS = 400  # states over a torus
LOOK_STEP = 1234.5  # between them in time: they fill the torus
ANGLES = 97  # states along one angle
AMPLITUDE_PLACES = 15
EXACT_DIGITS = 15
LARGEST_GROUPS_N = 8  # chains whose groups are compared
GROUP_ORDERS = {1: 4, 2: 3}  # by number of seeds
LINEAR_ORDER = 4  # up to which coefficients are compared at the linear frequencies
ZERO_SHARE = 1e-10  # of the largest coefficient of an order: below it is rounding


@dataclass(frozen=True, eq=False)
class TorusStudy:
    """One torus of the paper in three forms, all with the same c_3.

    alpha : with the printed frequencies. same_frequencies, same_amplitudes : Toda tori, with the
    frequencies and with the amplitudes of `alpha`. gaps : by name, of states over each torus,
    (LOOKS, N-1). exact_energy : of the Toda torus with the same frequencies, by its spectral curve.
    """

    label: str
    alpha: Torus[Newton] = field(repr=False)
    same_frequencies: Torus[Newton] = field(repr=False)
    same_amplitudes: Torus[Newton] = field(repr=False)
    gaps: dict[str, Floats] = field(repr=False)
    exact_energy: float

    def tori(self) -> dict[str, Torus[Newton]]:
        """By name."""
        return {
            "alpha": self.alpha,
            "Toda, same frequencies": self.same_frequencies,
            "Toda, same amplitudes": self.same_amplitudes,
        }


@dataclass(frozen=True)
class GroupStudy:
    """Groups D_k by excitation in alpha and Toda, and the seeds' frequency shifts.

    cases, differing : sets of seeds compared, and those whose groups differ. terms, vanishing : of
    `vanishing_terms`. cross_terms : by
    chain, the largest part of a seed's lowest shift that comes from the other seeds of Fig. 2,
    relative to the part of its own amplitude.
    """

    cases: int
    differing: tuple[tuple[int, tuple[int, ...]], ...]
    terms: int
    vanishing: int
    cross_terms: dict[str, float]


def torus_studies(progress: Progress = unheard) -> dict[str, TorusStudy]:
    """Figs. 1 and 2."""
    studies = {}
    for row in (TWO_TORUS, printed_row("Fig. 2")):
        progress(f"toda: {row.label}, tori by Newton's method", NO_FRACTION)
        studies[row.label] = torus_study(row)
    return studies


def torus_study(row: PrintedTorus) -> TorusStudy:
    """The torus of a figure in the alpha and in the Toda chain."""
    chain = Chain(row.chain.N, potential=toda(row.chain.alpha))
    tolerance = TOLERANCES[row.label]
    alpha, same_frequencies = (_refined(row, c, tolerance) for c in (row.chain, chain))
    amplitudes = {q: f"{a:.{AMPLITUDE_PLACES}f}" for q, a in alpha.amplitudes.items()}
    same_amplitudes = refine(same_frequencies, amplitudes=amplitudes, tolerance=tolerance)
    exact = toda_torus(chain, row.seeds, frequencies=row.frequencies, digits=EXACT_DIGITS)
    gaps = {
        "alpha": gaps_over(alpha),
        "Toda, same frequencies": gaps_over(same_frequencies),
        "Toda, same amplitudes": gaps_over(same_amplitudes),
    }
    return TorusStudy(
        row.label, alpha, same_frequencies, same_amplitudes, gaps, float(exact.energy)
    )


def _refined(row: PrintedTorus, chain: Chain, tolerance: float) -> Torus[Newton]:
    order, frequency_order = GUESS_ORDERS[row.label]
    series = lindstedt(chain, row.seeds, row.frequencies, order)
    guess = solve_amplitudes(series, frequency_order=frequency_order)
    return refine(guess, tolerance=tolerance)


def gaps_over(torus: Torus[Newton]) -> Floats:
    """Toda gaps (LOOKS, N-1) of states along an orbit that fills the torus."""
    times = LOOK_STEP * np.arange(LOOKS)
    Q, P = torus.Q(times), torus.P(times)
    return np.asarray(toda_gaps(torus.chain, Q, P), dtype=float)


def gaps_along(torus: Torus[Newton]) -> tuple[Floats, Floats]:
    """The first angle from 0 to 2 pi, the others 0, and the gaps (ANGLES, N-1) along it."""
    angles = np.linspace(0, 2 * np.pi, ANGLES)
    gaps = []
    for angle in angles:
        phases = dict.fromkeys(torus.seeds, 0.0) | {torus.seeds[0]: float(angle)}
        turned = replace(torus, phases=phases)
        gaps.append(toda_gaps(torus.chain, *turned.state()))
    return angles, np.array(gaps, dtype=float)


def gap_energies(torus: Torus[Newton], gaps: Floats) -> Floats:
    """Energy of small oscillations with these gaps, N gap^2 / (4 a^2), in units of H."""
    a = float(torus.chain.potential.coefficient(3))
    return np.asarray(torus.chain.N * gaps**2 / (4 * a**2) / float(torus.energy()))


def group_study(progress: Progress = unheard) -> GroupStudy:
    """Every set of one or two seeds of chains up to LARGEST_GROUPS_N."""
    progress("toda: groups D_k", NO_FRACTION)
    differing = []
    cases = 0
    for N, seeds in _seed_sets():
        cases += 1
        order = GROUP_ORDERS[len(seeds)]
        alpha = excited_groups(Chain(N, alpha=1), seeds, order)
        if alpha != excited_groups(Chain(N, potential=toda(1)), seeds, order):
            differing.append((N, seeds))
    terms, vanishing = vanishing_terms()
    return GroupStudy(cases, tuple(differing), terms, vanishing, _cross_terms())


def _seed_sets() -> Iterator[tuple[int, tuple[int, ...]]]:
    for N in range(3, LARGEST_GROUPS_N + 1):
        for count in GROUP_ORDERS:
            for seeds in combinations(range(1, N), count):
                yield N, seeds


def excited_groups(
    chain: Chain, seeds: tuple[int, ...], order: int
) -> list[tuple[int, ...]]:
    """Modes whose coordinate first differs from zero at order 0, 1, ...; for generic frequencies.

    From the series in the symbols L_q(nu).
    """
    series = lindstedt(chain, seeds, order=order, ring="nested")
    excited = []
    for coordinates in series.coordinates[: order + 1]:
        columns = np.flatnonzero(coordinates.nonzero.any(axis=0))
        excited.append((columns + 1).tolist())
    return first_orders(excited)


def vanishing_terms(order: int = LINEAR_ORDER) -> tuple[int, int]:
    """Coefficients of the alpha chain of Fig. 1 that are not zero, and how many are in Toda's.

    Of all coordinates up to an order, at the linear frequencies.
    """
    chain = TWO_TORUS.chain
    linear = chain.frequencies()
    frequencies = [repr(float(linear[q - 1])) for q in TWO_TORUS.seeds]
    tables = []
    for c in (chain, Chain(chain.N, potential=toda(chain.alpha))):
        symbols = lindstedt(c, TWO_TORUS.seeds, order=order, ring="nested")
        series = symbols.at(frequencies=frequencies)
        tables.append([np.abs(np.asarray(x, dtype=float)) for x in series.coordinates])
    present = vanish = 0
    for ours, theirs in zip(*tables, strict=True):
        here = ours > ZERO_SHARE * ours.max()
        gone = theirs <= ZERO_SHARE * theirs.max()
        present += int(here.sum())
        vanish += int((here & gone).sum())
    return present, vanish


def _cross_terms() -> dict[str, float]:
    """Shifts of the seeds of Fig. 2 at equal amplitudes, with and without the other seeds."""
    row = printed_row("Fig. 2")
    amplitudes = dict.fromkeys(row.seeds, 1.0)
    chains = {
        "alpha": row.chain,
        "Toda": Chain(row.chain.N, potential=toda(row.chain.alpha)),
    }
    parts = {}
    for name, chain in chains.items():
        together = frequency_shift(chain, amplitudes)
        alone = {q: frequency_shift(chain, {q: 1.0})[q] for q in row.seeds}
        parts[name] = max(abs(together[q] / alone[q] - 1) for q in row.seeds)
    return parts
