"""Pictures of the table, Figs. 1 and 6 and the convergence study; nothing is computed here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.drawing import plot_panel, plot_spectrum, save_panel
from symfpu.paper.claims import PaperFigure
from symfpu.paper.convergence import BreatherStudy, CancellationStudy, SchemeLimit
from symfpu.paper.corrected import CorrectedRow, ScalingStudy
from symfpu.paper.fig1 import Figure1
from symfpu.paper.fig6 import Figure6
from symfpu.paper.judgements import sums_panel

Floats = NDArray[np.float64]
Axes = Any
# of a series beside its exact torus; the longest one goes on in the same way, in the CSV
ORDERS_SHOWN = 62


def plot_amplitude_differences(
    differences: Mapping[int, tuple[float, ...]], seeds: tuple[int, ...], ax: Axes
) -> Axes:
    """|A(k+2) - A(k)| of every seed against the frequency order k."""
    orders = list(differences)
    for i, q in enumerate(seeds):
        ax.semilogy(
            orders, [differences[k][i] for k in orders], marker="o", label=rf"$\Delta A_{{{q}}}$"
        )
    ax.set_xlabel(r"frequency order $k$")
    ax.set_ylabel(r"$|A_i(k+2) - A_i(k)|$")
    ax.legend()
    return ax


def plot_energy_errors(
    times: Floats, errors: Mapping[int, tuple[Floats, Floats]], ax: Axes
) -> Axes:
    """Moduli of the relative errors of total and harmonic energy in time, by coordinate order."""
    for i, (k, (total, harmonic)) in enumerate(errors.items()):
        for values, name, style in (
            (harmonic, "harmonic energy", ":"),
            (total, "total energy", "-"),
        ):
            ax.semilogy(
                times[1:],
                np.abs(values[1:]),
                style,
                color=f"C{i}",
                lw=1.2,
                label=f"{name}, order {k}",
            )
    ax.set_ylim(bottom=1e-8)
    ax.set_xlabel(r"$t$")
    ax.set_ylabel(r"$|E(t) - E(0)| / E(0)$")
    ax.legend(loc="lower right", ncols=2)
    return ax


def draw_figure1(data: Figure1, folder: Path) -> list[Path]:
    """Write panels (a) to (d) of Fig. 1 as PNG and PDF; returns the paths."""
    seeds = data.torus.series.seeds

    def spectra(ax: Axes) -> Axes:
        for (k, spectrum), marker in zip(data.spectra.items(), "ox", strict=True):
            plot_spectrum(
                spectrum, ax, label=f"order {k}, residual {data.residuals[k]:.1e}", marker=marker
            )
        ax.legend()
        return ax

    panels: dict[str, Callable[[Axes], Axes]] = {
        "fig1a": spectra,
        "fig1b": lambda ax: plot_amplitude_differences(data.differences, seeds, ax),
        "fig1c": partial(plot_panel, sums_panel("fig1c", "", 1, data.sums)),
        "fig1d": lambda ax: plot_energy_errors(data.times, data.errors, ax),
    }
    titles = {
        "fig1a": "Fig. 1(a): average spectrum of the 2-torus",
        "fig1b": "Fig. 1(b): change of the amplitudes with the order",
        "fig1c": "Fig. 1(c): cancellations in the series of mode 1",
        "fig1d": "Fig. 1(d): relative errors in time",
    }
    return [
        path
        for name, panel in panels.items()
        for path in save_panel(panel, titles[name], folder / name)
    ]


def plot_variants(curves: Mapping[str, Mapping[int, float]], label: str, ax: Axes) -> Axes:
    """Several quantities by order on a logarithmic scale.

    Curves by name, the first ones drawn on top of each other as rings.
    """
    for i, (name, values) in enumerate(curves.items()):
        orders = [k for k, value in values.items() if value > 0]
        ax.semilogy(
            orders,
            [values[k] for k in orders],
            marker="osD^v"[i % 5],
            ms=9 - 1.5 * i,
            mfc="none",
            label=name,
        )
    ax.set_xlabel(r"order $k$")
    ax.set_ylabel(label)
    ax.legend()
    return ax


def plot_breather_roots(data: BreatherStudy, ax: Axes) -> Axes:
    """A(K) of the truncated series beside the periodic orbit and the end of the series."""
    ax.plot(
        list(data.amplitudes),
        list(data.amplitudes.values()),
        marker=".",
        ls="none",
        label=r"root $A(K)$ of the truncated series",
    )
    ax.axhline(
        data.orbit.amplitude,
        color="C1",
        label=rf"periodic orbit with the printed $\omega$: {data.orbit.amplitude:.6f}",
    )
    ax.axhline(
        data.singularity, color="C2", ls="--", label=f"the series ends: {data.singularity:.6f}"
    )
    ax.set_xlabel(r"frequency order $K$")
    ax.set_ylabel(r"$A_1$")
    ax.set_ylim(1.25, 1.5)
    ax.legend()
    return ax


def plot_scheme_limit(data: SchemeLimit, ax: Axes) -> Axes:
    """Amplitudes of a family and of the ends of its series against the frequency.

    The curves touch where the series stop to reach it.
    """
    rates, linear = (
        np.array(data.frequencies),
        float(data.orbit.chain.frequencies()[data.orbit.seed - 1]),
    )
    shifts, touch = rates / linear - 1, float(data.orbit.frequency) / linear - 1
    ax.loglog(shifts, data.amplitudes, marker=".", label="breathers (Newton)")
    ax.loglog(
        shifts,
        data.ends,
        marker="^",
        ls=":",
        label=r"end of the series with $\omega$ in its divisors",
    )
    ax.loglog(
        [touch],
        [data.orbit.amplitude],
        "o",
        ms=10,
        mfc="none",
        color="C3",
        label=rf"limit: $A_1 = {data.orbit.amplitude:.4f}$",
    )
    ax.axvspan(touch, shifts[-1], color="0.92", zorder=0)
    ax.text(
        np.sqrt(touch * shifts[-1]), data.amplitudes[0], "out of reach\nof the series", ha="center"
    )
    ax.set_xlabel(r"$\omega_1 / \Omega_1 - 1$")
    ax.set_ylabel(r"$A_1$")
    ax.legend()
    return ax


def draw_convergence(
    cancellation: CancellationStudy, breather: BreatherStudy, folder: Path
) -> list[Path]:
    """Write the pictures of the convergence study as PNG and PDF."""
    variants = cancellation.variants
    differences = {v.name: {k: max(d) for k, d in v.differences.items()} for v in variants}
    sums = {v.name: dict(enumerate(v.sums.tolist())) for v in variants}
    truncated = {k: float(r) for k, r in enumerate(cancellation.residuals) if k >= 2}
    panels: dict[str, tuple[str, Callable[[Axes], Axes]]] = {
        "convergence-a": (
            "Settling of the amplitudes",
            lambda ax: plot_variants(differences, r"$\max_i |A_i(k+2) - A_i(k)|$", ax),
        ),
        "convergence-b": (
            "Size of the terms of mode 1",
            lambda ax: plot_variants(sums, r"$\mu^k S_2(k)$", ax),
        ),
        "convergence-c": (
            "Residual of the 2-torus of Fig. 1",
            lambda ax: plot_variants(
                {"truncated": truncated, "resummed": cancellation.resummed}, "relative residual", ax
            ),
        ),
        "convergence-d": (
            "The breather of E = 0.014915",
            lambda ax: plot_breather_roots(breather, ax),
        ),
        "convergence-e": (
            "Breathers of seed 1 beyond their series",
            lambda ax: plot_scheme_limit(breather.limit, ax),
        ),
    }
    return [
        path
        for name, (title, panel) in panels.items()
        for path in save_panel(panel, title, folder / name)
    ]


def plot_error_by_order(errors: Mapping[str, Mapping[int, float]], ax: Axes) -> Axes:
    """Errors of several series against their exact tori, by name and order, on a logarithmic
    scale; up to order ORDERS_SHOWN.
    """
    for i, (name, values) in enumerate(errors.items()):
        style = {"marker": "osD^v<>*P"[i % 9], "ls": "-" if i < 5 else "--", "color": f"C{i}"}
        ax.semilogy(
            list(values), list(values.values()), ms=4, lw=1, mfc="none", label=name, **style
        )
    ax.set_xlim(0, ORDERS_SHOWN)
    ax.set_ylim(bottom=1e-16)
    ax.set_xlabel(r"order $K$ of coordinates and frequencies")
    ax.set_ylabel(r"$\max\,\Omega_q |c_q^{(K)}[\nu] - c_q[\nu]| \,/\, \max\,\Omega_q |c_q[\nu]|$")
    ax.legend(loc="center right")
    return ax


def plot_scaling(study: ScalingStudy, ax: Axes) -> Axes:
    """Errors of each order against the scale of mu A, beside lines of slope K + 1 through the
    last ones.
    """
    scales = np.array(study.scales)
    for i, (K, errors) in enumerate(study.given.items()):
        ax.loglog(
            scales, errors, marker="osD^"[i % 4], ls="none", color=f"C{i}", label=rf"$K = {K}$"
        )
        ax.loglog(
            scales,
            errors[-1] * (scales / scales[-1]) ** (K + 1),
            color=f"C{i}",
            lw=1,
            label=rf"$\mu^{{{K + 1}}}$",
        )
    for i, (K, errors) in enumerate(study.solved.items()):
        ax.loglog(
            scales,
            errors,
            marker="x",
            ls=":",
            color=f"C{list(study.given).index(K)}",
            label="$A(K)$ instead" if not i else None,
        )
    ax.set_xlabel(r"$\mu A$, relative to the printed torus")
    ax.set_ylabel("error of the coefficients, relative")
    ax.legend(ncols=2)
    return ax


def draw_corrected(
    rows: Sequence[CorrectedRow], studies: Sequence[ScalingStudy], folder: Path
) -> list[Path]:
    """Write the pictures of the corrected table as PNG and PDF: errors by order, and against mu;
    returns the paths.
    """
    known = [row for row in rows if row.errors is not None]
    solved = {row.printed.label: row.errors.solved for row in known if row.errors is not None}
    given = {row.printed.label: row.errors.given for row in known if row.errors is not None}
    panels: dict[str, tuple[str, Callable[[Axes], Axes]]] = {
        "corrected-a": (
            "Series against exact tori, amplitudes of order K",
            lambda ax: plot_error_by_order(solved, ax),
        ),
        "corrected-b": (
            "Series against exact tori, exact amplitudes",
            lambda ax: plot_error_by_order(given, ax),
        ),
    }
    for letter, study in zip("cdef", studies, strict=False):
        title = f"Error of order K against mu, {study.label} and scaled tori"
        panels[f"corrected-{letter}"] = (title, partial(plot_scaling, study))
    return [
        path
        for name, (title, panel) in panels.items()
        for path in save_panel(panel, title, folder / name)
    ]


def plot_propagation(N: int, orders: Mapping[int, int], ax: Axes) -> Axes:
    """The order k at which each mode is first excited, against kappa = q/N.

    Small orders on top, as energies would lie.
    """
    modes = sorted(orders)
    ax.plot([q / N for q in modes], [orders[q] for q in modes], marker="o", ls="none", ms=3)
    ax.invert_yaxis()
    ax.set_xlim(0, 1)
    ax.set_xlabel(r"$\kappa = q/N$")
    ax.set_ylabel(r"order $k$ of first excitation")
    return ax


def draw_figure6(data: Figure6, folder: Path) -> list[Path]:
    """Write panels (a) to (c) of Fig. 6 as PNG and PDF; returns the paths."""
    paths = []
    for (panel, (seeds, orders)), center in zip(
        data.panels.items(), ("1/4", "1/2", "3/4"), strict=True
    ):
        title = rf"Fig. 6({panel}): packet {seeds[0]}..{seeds[-1]} around $\kappa_0 = {center}$, N = {data.N}"
        paths += save_panel(
            partial(plot_propagation, data.N, orders), title, folder / f"fig6{panel}"
        )
    return paths


def draw_panels(figure: PaperFigure, folder: Path) -> list[Path]:
    """Write every panel of a figure as PNG and PDF; returns the paths."""
    return [
        path
        for panel in figure.panels
        for path in save_panel(partial(plot_panel, panel), panel.title, folder / panel.name)
    ]
