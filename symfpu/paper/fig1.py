"""Fig. 1: the 2-torus by the series of the printed frequencies, and its alignment indices."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import Progress, labelled
from symfpu.paper.claims import PaperFigure
from symfpu.paper.dimensions import (
    VECTORS,
    TorusForecast,
    figure_alignment,
    indices_panel,
)
from symfpu.paper.fig1_claims import figure1_claims
from symfpu.paper.fig1_data import Figure1, figure1_data
from symfpu.paper.judgements import sums_panel
from symfpu.paper.printed import FIG1_CLAIMS
from symfpu.refinement.tori import refine
from symfpu.results.numbers import fifteen_digits
from symfpu.results.text_tables import markdown_table

Floats = NDArray[np.float64]
ERRORS_BOTTOM = 1e-8  # of the picture: errors of rounding at its beginning are below
TITLE_E = "Fig. 1(e): alignment indices of the orbit from the series"


def figure1(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Panels (a) to (e), and the claims of section 3.2 on the 2-torus."""
    data = figure1_data(progress)
    torus = data.torus
    exact = refine(torus, progress=labelled(progress, "fig1: exact torus"))
    Q = np.asarray(torus.Q(0.0), dtype=float)
    P = np.asarray(torus.P(0.0), dtype=float)
    forecast = TorusForecast(exact, VECTORS["fig1"][1])
    seen = figure_alignment("fig1", (Q, P), progress, folder, forecast, full=full)
    return PaperFigure(
        "fig1",
        "Fig. 1: the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2",
        (*figure1_panels(data), indices_panel("fig1e", TITLE_E, seen)),
        figure1_claims(data, exact, seen, forecast),
        text=figure1_text(data),
        numbers=figure1_numbers(data),
        lines=_lines(data),
    )


def figure1_panels(data: Figure1) -> tuple[Panel, ...]:
    """Panels (a) to (d): spectrum, amplitudes by order, cancellations, errors in time."""
    seeds = data.torus.origin.series.seeds
    differences = differences_panel("fig1b", data.differences, seeds)
    return (_spectra_panel(data), differences, _sums_panel(data), _errors_panel(data))


def _spectra_panel(data: Figure1) -> Panel:
    curves = []
    modes = list(range(1, data.torus.origin.series.chain.N))
    columns: dict[str, list[Any]] = {"q": modes}
    for k, spectrum in data.spectra.items():
        label = f"order {k}, residual {data.residuals[k]:.1e}"
        curves.append(Curve(label, np.array(modes, dtype=float), spectrum, "joined"))
        columns[f"average_energy_over_H_order_{k}"] = spectrum.tolist()
    return Panel(
        "fig1a",
        "Fig. 1(a): average spectrum of the 2-torus",
        r"$q$",
        r"$\overline{E}_q / E$",
        tuple(curves),
        ("q", "average_energy_over_H"),
        columns=columns,
    )


def differences_panel(
    name: str, differences: Mapping[int, tuple[float, ...]], seeds: tuple[int, ...]
) -> Panel:
    """|A(k+2) - A(k)| of every seed against the frequency order k."""
    orders = list(differences)
    curves = []
    columns: dict[str, list[Any]] = {"k": orders}
    for i, q in enumerate(seeds):
        changes = [differences[k][i] for k in orders]
        label = rf"$\Delta A_{{{q}}}$"
        curve = Curve(label, np.array(orders, dtype=float), np.array(changes), "joined")
        curves.append(curve)
        columns[f"delta_A{q}"] = changes
    return Panel(
        name,
        "Fig. 1(b): change of the amplitudes with the order",
        r"frequency order $k$",
        r"$|A_i(k+2) - A_i(k)|$",
        tuple(curves),
        ("k", "delta_A"),
        columns=columns,
    )


def _sums_panel(data: Figure1) -> Panel:
    title = "Fig. 1(c): cancellations in the series of mode 1"
    upper, lower = data.sums
    columns: dict[str, list[Any]] = {"k": list(range(len(upper)))}
    columns["mu_k_S1"] = upper.tolist()
    columns["mu_k_S2"] = lower.tolist()
    return sums_panel("fig1c", title, 1, data.sums, columns=columns)


def _errors_panel(data: Figure1) -> Panel:
    """Moduli of the errors in time, by coordinate order; in the table with their signs."""
    times = data.times[1:]
    curves = []
    columns: dict[str, list[Any]] = {"t": data.times.tolist()}
    for i, (k, (total, harmonic)) in enumerate(data.errors.items()):
        of_harmonic = f"harmonic energy, order {k}"
        of_total = f"total energy, order {k}"
        curves.append(Curve(of_harmonic, times, np.abs(harmonic[1:]), "dotted", group=i))
        curves.append(Curve(of_total, times, np.abs(total[1:]), group=i))
        columns[f"total_order_{k}"] = total.tolist()
        columns[f"harmonic_order_{k}"] = harmonic.tolist()
    return Panel(
        "fig1d",
        "Fig. 1(d): relative errors in time",
        r"$t$",
        r"$|E(t) - E(0)| / E(0)$",
        tuple(curves),
        ("t", "relative_error"),
        bottom=ERRORS_BOTTOM,
        legend="lower right",
        legend_columns=2,
        columns=columns,
    )


def figure1_text(data: Figure1) -> tuple[str, ...]:
    """The numbers of the text beside ours, residuals by order, the verdict and its precision."""
    ours = data.claims()
    rows = [[key.replace("_", " "), FIG1_CLAIMS[key], ours[key]] for key in ours]
    even = [f"{k}: {value:.1e}" for k, value in data.residuals.items() if k % 2 == 0]
    residuals = (
        f"Residual of the equations of motion by coordinate order: {', '.join(even)}."
    )
    reasons = "; ".join(data.assessment.reasons)
    precision = f"Computed with {data.torus.origin.series.precision}. In doubles the "
    precision += f"amplitudes of all orders come out the same to {data.rounding:.1e}."
    return (
        markdown_table(["claim", "printed", "computed"], rows),
        f"{residuals}\nThe least is at order {data.best_order}.",
        f"Verdict on the series: {data.assessment.verdict} ({reasons}).",
        precision,
    )


def figure1_numbers(data: Figure1) -> dict[str, Any]:
    """For JSON: the numbers of the text beside ours, and the evidence."""
    record: dict[str, Any] = {"best_order": data.best_order}
    record["digits"] = data.torus.digits
    record["rounding_of_doubles"] = fifteen_digits(data.rounding)
    record["assessment"] = data.assessment.record()
    claims = {}
    for key, computed in data.claims().items():
        claims[key] = {"printed": FIG1_CLAIMS[key], "computed": computed}
    record["claims"] = claims
    return record


def _lines(data: Figure1) -> tuple[str, ...]:
    lines = []
    for key, computed in data.claims().items():
        name = key.replace("_", " ")
        lines.append(f"Fig. 1, {name}: printed {FIG1_CLAIMS[key]}; computed {computed}")
    return tuple(lines)
