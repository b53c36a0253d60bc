"""What all figures of orbits begin with.

The paper's tori from its printed frequencies, their orbits, and profiles beside each other.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import Orbit, integrate
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import Progress, unheard
from symfpu.localization.floors import spectrum_floor
from symfpu.paper.printed import APPENDIX_F, TWO_TORUS, PrintedTorus
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.amplitudes import solve_amplitudes
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

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
# tails far below the rounding of the largest mode; one look a step, more than one in a period of
# E_q
SCHEME, MODE_STEP = "aba864_modes", 1.0
PERIOD_STEP = 0.02  # twelve digits of a period of the highest mode
EPS = float(np.finfo(float).eps)


class Starting(Protocol):
    """Where an orbit can start: tori and breathers."""

    def Q(self, t: ArrayLike) -> Any: ...

    def P(self, t: ArrayLike) -> Any: ...


def printed_row(label: str) -> PrintedTorus:
    """The printed torus shown in a figure."""
    return next(row for row in (TWO_TORUS, *APPENDIX_F) if row.label == label)


def printed_torus(row: PrintedTorus) -> Torus[FromSeries]:
    """The truncated series of the printed frequencies and order.

    Its amplitudes are of the frequency order that gives the printed ones.
    """
    series = lindstedt(row.chain, row.seeds, row.frequencies, row.order)
    frequency_order = AMPLITUDE_ORDERS.get(row.label)
    return solve_amplitudes(series, frequency_order=frequency_order)


def printed_amplitudes(row: PrintedTorus) -> dict[int, str]:
    """By seed, as printed."""
    return dict(zip(row.seeds, row.amplitudes, strict=True))


def integrated_orbit(
    name: str,
    chain: Chain,
    start: Starting | tuple[Floats, Floats],
    T: float,
    tell: Progress,
    *,
    scheme: str = SCHEME,
    step: float = MODE_STEP,
    samples: int | Floats = 200,
    averages: bool = True,
) -> Orbit:
    """The orbit from a torus or a state at t = 0, with running averages.

    `tell` hears how far it is.
    """

    def progress(_: str, fraction: float) -> None:
        tell(f"{name}: orbit to t = {T:.2g}", fraction)

    if isinstance(start, tuple):
        Q, P = start
    else:
        Q, P = start.Q(0.0), start.P(0.0)
    return integrate(
        chain,
        np.asarray(Q, dtype=float),
        np.asarray(P, dtype=float),
        T,
        step=step,
        scheme=scheme,
        samples=samples,
        averages=averages,
        workers=2,
        progress=progress,
    )


def period_digits(row: PrintedTorus, torus: Torus[FromSeries]) -> float:
    """To how many digits of its largest coordinate an orbit is back at its start.

    After 2 pi/omega, omega as printed.
    """
    period = 2 * math.pi / float(row.frequencies[0])
    orbit = integrated_orbit(
        f"{row.label} period",
        row.chain,
        torus,
        period,
        unheard,
        step=PERIOD_STEP,
        samples=1,
        averages=False,
    )
    off_Q = np.abs(orbit.Q[-1] - orbit.Q[0]).max()
    off_P = np.abs(orbit.P[-1] - orbit.P[0]).max()
    off = float(max(off_Q, off_P) / np.abs(orbit.Q[0]).max())
    return -math.log10(max(off, EPS))


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
    x = np.arange(1.0, chain.N)
    labels = (r"$q$", r"$\overline{E}_q / E$")
    axes = ("q", "average_energy_over_H")
    if by_kappa:
        x = x / chain.N
        labels = (r"$\kappa = q/N$", r"$e_\kappa$")
        axes = ("kappa", "average_energy_over_H")
    styles = itertools.cycle(("points", "triangles", "rings"))
    curves = []
    for (label, profile), style in zip(profiles.items(), styles, strict=False):
        shares = np.asarray(profile, dtype=float)
        known = shares > floors.get(label, -np.inf)
        curves.append(Curve(label, x[known], shares[known], style))
    return Panel(name, title, *labels, (*curves, *laws), axes)


def normalised_floor(solution: Torus) -> Floats:
    """The energies below which a mode of a torus is rounding, over its energy; shape (N-1,)."""
    floor = spectrum_floor(solution)
    return np.asarray(floor / float(solution.energy()))


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
    curves = []
    for q in modes:
        energy = energies[:, q - 1]
        curves.append(Curve(f"$q = {q}$", times, energy, name=f"q={q}"))
    labels = (r"$t$", r"$E_q(t) / E$")
    axes = ("t", "energy_over_H")
    return Panel(name, title, *labels, tuple(curves), axes, bottom=bottom)
