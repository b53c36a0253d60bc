"""Two questions that the paper leaves open about the convergence of its series: page and pictures.

The numbers that settle them come from convergence_fig1.py and convergence_fig9.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import Progress
from symfpu.numbers.typed import decimal
from symfpu.paper.claims import PaperFigure
from symfpu.paper.convergence_claims import convergence_claims
from symfpu.paper.convergence_fig1 import CancellationStudy, cancellation_study
from symfpu.paper.convergence_fig9 import BreatherStudy, SchemeLimit, breather_study
from symfpu.results.numbers import fifteen_digits
from symfpu.results.text_tables import markdown_table
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment

Floats = NDArray[np.float64]
ByOrder = Mapping[int, float]

DIFFERENCE_ORDERS = (14, 20, 24, 28)  # in the table of variants
SUM_ORDERS = (14, 30)
FIRST_RATIO = 20  # order from which ratios are shown
ROOT_ORDERS = (2, 10, 50, 100, 150, 200)  # and the last
ROOT_LIMITS = (1.25, 1.5)  # of the picture of A(K)
FIRST_RESIDUAL = 2  # order from which residuals are drawn
BREATHER_HEAD = ("periodic orbit with the", "omega", "A", "H", "harmonic E(0)", "residual")
AMPLITUDE_HEAD = (
    "order",
    "residual",
    "resummed",
    "A_1",
    "A_2",
    "A_1 resummed",
    "A_2 resummed",
)


def convergence(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Both questions: why the errors of Fig. 1 stop falling, and whether Fig. 9 is a breather."""
    return convergence_figure(cancellation_study(progress), breather_study(progress))


def convergence_figure(
    cancellation: CancellationStudy, breather: BreatherStudy
) -> PaperFigure:
    """What the studies found."""
    title = "Convergence of the series: two questions"
    panels = (*cancellation_panels(cancellation), *breather_panels(breather))
    text = (*cancellation_text(cancellation), *breather_text(breather))
    numbers = convergence_numbers(cancellation, breather)
    claims = convergence_claims(cancellation)
    return PaperFigure("convergence", title, panels, claims, text=text, numbers=numbers)


def cancellation_text(data: CancellationStudy) -> tuple[str, ...]:
    """Question (i): what was tested, what came out."""
    first, second = data.coincidence
    order = abs(first) + abs(second) - 1
    coincidence = f"{first} omega_1 {second:+d} omega_2 = 0, at order {order}; none before."
    shown = [f"{k}: {r:.6f}" for k, r in data.ratios.items() if k >= FIRST_RATIO]
    growth = f"The coefficient of harmonic (5,-4) in mode 3, divisor {data.divisor:.4e}, "
    growth += f"grows every two orders by: {', '.join(shown)}."
    pole = "Mode 3's own frequency on the torus, a series in mu^2, meets 4 omega_2 - 5 omega_1 "
    pole += f"at {data.pole:.5f} of the actual mu^2: "
    pole += f"a pole there makes terms grow by {1 / data.pole:.5f} every two orders."
    return (
        "### Question (i): Fig. 1(b, c), why the errors stop falling",
        _variants_table(data),
        f"Exact coincidence: {coincidence}",
        _verdict(data.assessment),
        growth,
        pole,
        _amplitudes_table(data),
    )


def _verdict(assessment: Assessment) -> str:
    return f"Verdict: {assessment.verdict} ({'; '.join(assessment.reasons)})."


def _variants_table(data: CancellationStudy) -> str:
    head = ["case"]
    head += [f"dA({k})" for k in DIFFERENCE_ORDERS]
    head += [f"S_2({k})" for k in SUM_ORDERS]
    rows = []
    for variant in data.variants:
        row = [variant.name]
        row += [f"{max(variant.differences[k]):.2e}" for k in DIFFERENCE_ORDERS]
        row += [f"{variant.sums[k]:.2e}" for k in SUM_ORDERS]
        row.append(f"{variant.residuals.min():.1e}")
        rows.append(row)
    return markdown_table([*head, "least residual"], rows)


def _amplitudes_table(data: CancellationStudy) -> str:
    """Residuals and amplitudes of truncated and resummed tori, by order."""
    rows = []
    for k, resummed in data.resummed.items():
        truncated_roots, resummed_roots = data.amplitudes[k]
        row = [str(k), f"{data.residuals[k]:.1e}", f"{resummed:.1e}"]
        row += [f"{a:.10f}" for a in (*truncated_roots, *resummed_roots)]
        rows.append(row)
    return markdown_table(AMPLITUDE_HEAD, rows)


def breather_text(data: BreatherStudy) -> tuple[str, ...]:
    """Question (ii): the orbits, the roots and the end of the series."""
    rows = [
        _orbit_row("printed frequency", data.orbit),
        _orbit_row("printed amplitude", data.at_printed),
    ]
    orders = [k for k in data.amplitudes if k in (*ROOT_ORDERS, max(data.amplitudes))]
    roots = ", ".join(f"{k}: {data.amplitudes[k]:.8f}" for k in orders)
    end = f"The frequency series with these divisors ends at A = {data.singularity:.9f} "
    end += f"(spread of the fit {data.spread:.0e}) in a singularity of exponent "
    end += f"{data.exponent:.4f}."
    orbit = data.limit.orbit
    last = data.limit.family.members[-1]
    limit = "The breathers lie behind such an end, out of reach of the series, from "
    limit += f"A = {orbit.amplitude:.6f}, omega = {float(orbit.frequency):.9f}, "
    limit += f"H = {orbit.energy():.7f} on; "
    limit += f"Newton's method followed the family to H = {last.energy:.4f}."
    return (
        "### Question (ii): the breather of E = 0.014915",
        markdown_table(BREATHER_HEAD, rows),
        f"A(K) of the truncated series: {roots}.",
        end,
        limit,
        _verdict(data.assessment),
    )


def _orbit_row(name: str, orbit: Torus) -> list[str]:
    row = [name, f"{float(orbit.frequency):.14f}"]
    row += [f"{orbit.amplitude:.11f}", f"{orbit.energy():.10f}"]
    harmonic = orbit.harmonic_energies().sum()
    row += [f"{harmonic:.10f}", f"{orbit.residual():.0e}"]
    return row


def convergence_numbers(
    cancellation: CancellationStudy, breather: BreatherStudy
) -> dict[str, Any]:
    """Both questions for JSON."""
    orbit = breather.orbit
    limit = breather.limit.orbit
    record: dict[str, Any] = {"coincidence": list(cancellation.coincidence)}
    record["divisor"] = fifteen_digits(cancellation.divisor)
    record["pole"] = fifteen_digits(cancellation.pole)
    record["ratios"] = _rounded(cancellation.ratios)
    record["resummed_residuals"] = _rounded(cancellation.resummed)
    record["torus"] = cancellation.assessment.record()
    record["orbit"] = _orbit_record(orbit)
    record["orbit_energy"] = repr(float(orbit.energy()))
    record["singularity"] = fifteen_digits(breather.singularity)
    record["limit"] = _orbit_record(limit) | {"energy": repr(float(limit.energy()))}
    record["breather"] = breather.assessment.record()
    return record


def _rounded(values: ByOrder) -> dict[str, float]:
    return {str(k): fifteen_digits(value) for k, value in values.items()}


def _orbit_record(orbit: Torus) -> dict[str, str]:
    return {"frequency": decimal(orbit.frequency), "amplitude": repr(orbit.amplitude)}


def cancellation_panels(data: CancellationStudy) -> tuple[Panel, ...]:
    """Panels (a) to (c): settling, sizes of terms, residuals."""
    differences, sums = {}, {}
    for variant in data.variants:
        differences[variant.name] = {k: max(d) for k, d in variant.differences.items()}
        sums[variant.name] = dict(enumerate(variant.sums.tolist()))
    residuals = [float(r) for r in data.residuals]
    truncated = {k: r for k, r in enumerate(residuals) if k >= FIRST_RESIDUAL}
    both = {"truncated": truncated, "resummed": data.resummed}
    orders = list(data.resummed)
    shown: dict[str, list[Any]] = {"order": orders}
    shown["truncated"] = [residuals[k] for k in orders]
    shown["resummed"] = list(data.resummed.values())
    difference, size = r"$\max_i |A_i(k+2) - A_i(k)|$", r"$\mu^k S_2(k)$"
    name, title = "convergence-c", "Residual of the 2-torus of Fig. 1"
    return (
        by_order_panel(
            "convergence-a", "Settling of the amplitudes", difference, differences
        ),
        by_order_panel("convergence-b", "Size of the terms of mode 1", size, sums),
        by_order_panel(name, title, "relative residual", both, columns=shown),
    )


def by_order_panel(
    name: str,
    title: str,
    y_label: str,
    curves: Mapping[str, ByOrder],
    *,
    columns: Mapping[str, list[Any]] | None = None,
) -> Panel:
    """Several quantities by order, by name; the table has the orders of the first one.

    columns : of another table.
    """
    drawn = []
    first = next(iter(curves.values()))
    table: dict[str, list[Any]] = {"k": list(first)}
    for label, values in curves.items():
        orders = np.array(list(values), dtype=float)
        sizes = list(values.values())
        drawn.append(Curve(label, orders, np.array(sizes), "joined"))
        table[label] = sizes
    return Panel(
        name,
        title,
        r"order $k$",
        y_label,
        tuple(drawn),
        ("k", "size"),
        columns=columns or table,
    )


def breather_panels(data: BreatherStudy) -> tuple[Panel, Panel]:
    """Panels (d) and (e): roots of the series, and the family beyond its series."""
    roots = roots_panel(data.amplitudes, data.orbit.amplitude, data.singularity)
    return (roots, _limit_panel(data.limit))


def roots_panel(amplitudes: ByOrder, periodic: float, end: float) -> Panel:
    """A(K) of the truncated series beside the periodic orbit and the end of the series."""
    orders = np.array(list(amplitudes), dtype=float)
    roots = list(amplitudes.values())
    ends = orders[[0, -1]]
    orbit = rf"periodic orbit with the printed $\omega$: {periodic:.6f}"
    curves = (
        Curve(r"root $A(K)$ of the truncated series", orders, np.array(roots), "dots"),
        Curve(orbit, ends, np.full(2, periodic)),
        Curve(f"the series ends: {end:.6f}", ends, np.full(2, end), "law"),
    )
    bottom, top = ROOT_LIMITS
    return Panel(
        "convergence-d",
        "The breather of E = 0.014915",
        r"frequency order $K$",
        r"$A_1$",
        curves,
        ("K", "A"),
        log_y=False,
        bottom=bottom,
        top=top,
        columns={"K": list(amplitudes), "A": roots},
    )


def _limit_panel(data: SchemeLimit) -> Panel:
    """Amplitudes of a family and of the ends of its series against the frequency.

    The curves touch where the series stop to reach it.
    """
    linear = float(data.orbit.chain.frequencies()[data.orbit.seed - 1])
    shifts = np.array(data.frequencies) / linear - 1
    touch = float(data.orbit.frequency) / linear - 1
    amplitude = data.orbit.amplitude
    amplitudes, ends = np.array(data.amplitudes), np.array(data.ends)
    beyond = np.array([touch, shifts[-1]])
    lowest = np.full(2, data.amplitudes[0])
    limit = rf"limit: $A_1 = {amplitude:.4f}$"
    end = r"end of the series with $\omega$ in its divisors"
    curves = (
        Curve(limit, np.array([touch]), np.array([amplitude]), "rings", group=3),
        Curve("breathers (Newton)", shifts, amplitudes, "beads", group=0),
        Curve(end, shifts, ends, "crosses", group=1),
        Curve("out of reach\nof the series", beyond, lowest, "span"),
    )
    columns: dict[str, list[float]] = {"omega": list(data.frequencies)}
    columns["A"] = list(data.amplitudes)
    columns["A at the end of the series"] = list(data.ends)
    return Panel(
        "convergence-e",
        "Breathers of seed 1 beyond their series",
        r"$\omega_1 / \Omega_1 - 1$",
        r"$A_1$",
        curves,
        ("shift", "A"),
        log_x=True,
        columns=columns,
    )
