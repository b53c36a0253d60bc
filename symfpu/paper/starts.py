"""What all figures of orbits begin with: the paper's tori from its printed frequencies, their
orbits, and profiles beside each other.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import Orbit, integrate
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.floors import spectrum_floor
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS, PrintedTorus
from symfpu.paper.steps import Step
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.torus import QTorus

Floats = NDArray[np.float64]

# frequency orders that give the printed amplitudes (docs/reproduction.md); the last one for those
# that are met by none
AMPLITUDE_ORDERS = {
    "Fig. 1": 24,
    "Fig. 2": 4,
    "Fig. 5a": 6,
    "Fig. 5b": 6,
    "Fig. 5c": 6,
    "Fig. 5d": 4,
    "Fig. 9": 242,
}
# tails far below the rounding of the largest mode; two looks in a period of E_q
SCHEME, MODE_STEP = "aba864_modes", 0.7


def printed_row(label: str) -> PrintedTorus:
    """The printed torus shown in a figure."""
    return next(row for row in (TWO_TORUS, *APPENDIX_F) if row.label == label)


def printed_torus(row: PrintedTorus) -> QTorus:
    """The truncated series of the printed frequencies and order, with amplitudes of the frequency
    order that gives the printed ones.
    """
    series = lindstedt(row.chain, row.seeds, row.frequencies, row.order)
    return solve_amplitudes(series, frequency_order=AMPLITUDE_ORDERS.get(row.label))


def printed_amplitudes(row: PrintedTorus) -> dict[int, str]:
    """By seed, as printed."""
    return dict(zip(row.seeds, row.amplitudes, strict=True))


def follow(
    name: str,
    chain: Chain,
    start: QuasiPeriodic | tuple[Floats, Floats],
    T: float,
    tell: Step,
    *,
    scheme: str = SCHEME,
    step: float = MODE_STEP,
    samples: int | Floats = 200,
    averages: bool = True,
) -> Orbit:
    """The orbit from a torus or a state at t = 0, with running averages; `tell` hears how far it is."""
    Q, P = start if isinstance(start, tuple) else start.state()
    return integrate(
        chain,
        Q,
        P,
        T,
        step=step,
        scheme=scheme,
        samples=samples,
        averages=averages,
        workers=2,
        progress=lambda done, total: tell(f"{name}: orbit to t = {T:.2g}", done / total),
    )


def profile_panel(
    name: str,
    title: str,
    chain: Chain,
    profiles: Mapping[str, Floats],
    *laws: Curve,
    by_kappa: bool = True,
    floors: Mapping[str, Floats] = MappingProxyType({}),
) -> Panel:
    """Normalised spectra (N-1,) by name, against q/N or q, with lines of laws.

    floors : by name too, from `normalised_floor`; modes at or below them are left out.
    """
    q = np.arange(1.0, chain.N)
    x = q / chain.N if by_kappa else q
    styles = itertools.cycle(("points", "triangles", "rings"))
    curves = []
    for (label, profile), style in zip(profiles.items(), styles, strict=False):
        e = np.asarray(profile, dtype=float)
        known = e > floors.get(label, -np.inf)
        curves.append(Curve(label, x[known], e[known], style))
    labels = (r"$\kappa = q/N$", r"$e_\kappa$") if by_kappa else (r"$q$", r"$\overline{E}_q / E$")
    axes = ("kappa" if by_kappa else "q", "average_energy_over_H")
    return Panel(name, title, *labels, (*curves, *laws), axes)


def normalised_floor(solution: QuasiPeriodic) -> Floats:
    """The energies below which a mode of a torus is rounding, over its energy; shape (N-1,)."""
    return np.asarray(spectrum_floor(solution) / float(solution.energy()))


def energies_panel(
    name: str,
    title: str,
    times: Floats,
    energies: Floats,
    modes: tuple[int, ...],
    *,
    bottom: float | None = None,
) -> Panel:
    """Instantaneous E_q(t)/E of some modes; energies (S, N-1), normalised."""
    curves = tuple(Curve(f"$q = {q}$", times, energies[:, q - 1], name=f"q={q}") for q in modes)
    return Panel(
        name, title, r"$t$", r"$E_q(t) / E$", curves, ("t", "energy_over_H"), bottom=bottom
    )
