"""What section 6.4 says of q-breathers beside its figures.

Their existence, how trajectories start, whether printed pairs are orbits, and which orders help.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import breather_of_energy
from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.paper.claims import Claim, judged
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.starts import period_digits, printed_row, printed_torus
from symfpu.tori.energy import Energy
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]

BREATHERS = ("Fig. 7", "Fig. 8")  # that of Fig. 9 has its rows there
ENERGY_CHAIN, ENERGY_SEED = 6, 4  # 2N/3: one mode that moves alone
COUPLING = "0.33"
BELOW, ABOVE, FAR_ABOVE = 0.9, 1.1, 100.0  # of the energy of the saddle
ARRIVED_FACTOR = 10.0  # of the least residual: the first order below has arrived
SERIES_LIMIT = 50  # "near k_0 = 50"
STATED_DIGITS = (4.0, 6.0)
MOST_DIGITS = 10.0
SAME_ENERGY = 0.01  # relative
ORDER_STRIDE = 2


@dataclass(frozen=True)
class Closing:
    """Digits to which an orbit is back after 2 pi/omega, omega as printed.

    printed : with the printed amplitude. own : with the one that belongs to omega. excess : by how
    much of itself the printed amplitude is larger.
    """

    printed: float
    own: float
    excess: float


def breather_claims() -> list[Claim]:
    """Existence, starts, and what the breathers of Figs. 7 and 8 show."""
    rows = [printed_row(label) for label in BREATHERS]
    tori = {row.label: printed_torus(row) for row in rows}
    closings = {row.label: closing(row, tori[row.label]) for row in rows}
    arrivals = {label: arrival(torus) for label, torus in tori.items()}
    return [
        existence_claim(),
        start_claim(printed_row("Fig. 7")),
        start_claim(printed_row("Fig. 9")),
        pairs_claim(closings),
        precision_claim(closings),
        orders_claim(arrivals),
    ]


def closing(row: PrintedTorus, torus: Torus[FromSeries]) -> Closing:
    """How well both amplitudes close; torus : the series of the printed frequency."""
    (seed,) = row.seeds
    amplitude = float(row.amplitudes[0])
    printed = replace(torus.origin, amplitudes=(amplitude,)).torus(torus.phases)
    excess = amplitude / float(torus.amplitudes[seed]) - 1
    return Closing(period_digits(row, printed), period_digits(row, torus), excess)


def _exists(chain: Chain, energy: float) -> bool:
    try:
        found = breather_of_energy(chain, ENERGY_SEED, Energy(repr(energy)))
    except SymfpuError:
        return False
    return abs(float(found.energy()) / energy - 1) < SAME_ENERGY


def existence_claim(exists: Callable[[Chain, float], bool] = _exists) -> Claim:
    """Breathers of every energy: the mode 2N/3, which moves alone, has a saddle in alpha."""
    saddle = saddle_energy(Chain(ENERGY_CHAIN, alpha=COUPLING), ENERGY_SEED)
    alpha = Chain(ENERGY_CHAIN, alpha=COUPLING)
    beta = Chain(ENERGY_CHAIN, beta=COUPLING)
    below, above = (exists(alpha, share * saddle) for share in (BELOW, ABOVE))
    far = exists(beta, FAR_ABOVE * saddle)
    text = "q-breathers exist for an arbitrarily high energy, by Lyapunov's theorem"
    ours = "the theorem is local. Mode 2N/3 moves alone, in a cubic well of depth "
    ours += (
        f"H = {saddle:.4f} (N = {ENERGY_CHAIN}, alpha = {COUPLING}): Newton's method finds "
    )
    ours += f"{'a' if below else 'no'} breather at {BELOW:g} of it, {'one' if above else 'none'} "
    ours += f"at {ABOVE:g}, where no orbit of this mode is bounded; in beta "
    ours += f"{'one' if far else 'none'} at {FAR_ABOVE:g} of it"
    return Claim("6.4", text, "", ours, judged(below and above and far, below and far))


def saddle_energy(chain: Chain, q: int) -> float:
    """Of a mode that moves alone in V = a Q^2 + c Q^3: 4 a^3 / (27 c^2)."""
    Q = np.zeros((2, chain.N - 1))
    Q[:, q - 1] = (1, -1)
    plus, minus = np.asarray(chain.energy(Q, np.zeros_like(Q)), dtype=float)
    a, c = (plus + minus) / 2, (plus - minus) / 2
    return float(4 * a**3 / (27 * c**2))


def start_claim(row: PrintedTorus) -> Claim:
    """x_n(0) = A_1 sin(pi n/N), by Eq. lintra."""
    chain = row.chain
    amplitude = float(row.amplitudes[0])
    x = amplitude * np.sin(math.pi * np.arange(1, chain.N) / chain.N)
    as_printed = np.asarray(chain.modes(x), dtype=float)
    by_definition = np.zeros(chain.N - 1)
    by_definition[0] = amplitude
    energies = [_harmonic(chain, Q) for Q in (as_printed, by_definition)]
    same = abs(as_printed[0] / amplitude - 1) < SAME_ENERGY
    text = f"{row.label}: the FPU-trajectory starts at x_n(0) = A_1 sin(pi n/N), y_n(0) = 0"
    ours = f"that is Q_1(0) = {as_printed[0] / amplitude:.6g} A_1, harmonic energy "
    ours += f"{energies[0]:.6g}: "
    ours += "Eq. lintra has the factor (2/N)^(1/2), and Definition 4 Q_1(0) = A_1, "
    ours += f"harmonic energy {energies[1]:.6g}, beside the printed E = {row.energy}"
    return Claim("6.4.1", text, f"E = {row.energy}", ours, judged(same))


def _harmonic(chain: Chain, Q: Floats) -> float:
    return float(np.sum((chain.frequencies() * Q) ** 2) / 2)


def pairs_claim(closings: Mapping[str, Closing]) -> Claim:
    """Do the printed omega and A close as orbits?"""
    parts = []
    for label, found in closings.items():
        part = f"{label}: to {found.printed:.1f} digits, with the amplitude of the printed "
        part += f"frequency {found.own:.1f} (the printed one is off by {found.excess:+.1e} "
        part += "of itself)"
        parts.append(part)
    labels = " and ".join(closings)
    text = f"{labels}: the printed omega and A are those of a periodic orbit (Appendix F)"
    ours = f"back after 2 pi/omega - {'; '.join(parts)}"
    apart = [label for label, found in closings.items() if found.own - found.printed > 1]
    if apart:
        ours += f". In {' and '.join(apart)} A was not solved from the printed omega"
    digits = [found.printed for found in closings.values()]
    stated = [value >= STATED_DIGITS[0] - 0.5 for value in digits]
    verdict = judged(min(digits) >= MOST_DIGITS, all(stated))
    return Claim("6.4", text, "", ours, verdict)


def precision_claim(closings: Mapping[str, Closing]) -> Claim:
    """'4 to 6 significant digits, while in some cases we reach 10'."""
    parts = [
        f"{label}: {found.own:.1f} ({found.printed:.1f})"
        for label, found in closings.items()
    ]
    text = "the precision of initial conditions on a breather by series is 4 to 6 digits, "
    text += "in some cases 10"
    ours = f"digits after a period, with the printed A in brackets - {'; '.join(parts)}"
    low, high = STATED_DIGITS
    reached = all(found.own >= MOST_DIGITS for found in closings.values())
    stated = all(low - 0.5 <= found.own <= high + 0.5 for found in closings.values())
    if reached:
        ours += "; the series give what doubles hold, so more than is said"
    return Claim("6.4", text, "4 to 6, 10", ours, judged(stated, reached))


def arrival(torus: Torus[FromSeries]) -> tuple[int, float]:
    """The first order whose residual is near the least, and the residual there."""
    residuals = {}
    for k in range(2, torus.origin.order + 1, ORDER_STRIDE):
        residuals[k] = float(torus.origin.cut_at(k).torus(torus.phases).residual())
    least = min(residuals.values())
    first = next(k for k, value in residuals.items() if value <= ARRIVED_FACTOR * least)
    return first, residuals[first]


def orders_claim(arrivals: Mapping[str, tuple[int, float]]) -> Claim:
    """Little gain beyond order 50: for which breathers is it the order that matters?"""
    parts = []
    slow = []
    for label, (first, residual) in arrivals.items():
        parts.append(
            f"{label}: residual {residual:.0e} at order {first}, the least to a factor of ten"
        )
        slow.append(first >= SERIES_LIMIT)
    text = (
        "the convergence of the series of breathers is very slow, with little gain after "
    )
    text += f"an order near 50: {' and '.join(arrivals)}"
    ours = "; ".join(parts)
    if not any(slow):
        ours += ". They converge fast; the slow one is that of Fig. 9, which converges to no orbit"
    return Claim("6.4", text, "50", ours, judged(all(slow), any(slow)))
