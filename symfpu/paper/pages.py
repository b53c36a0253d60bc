"""The table, Figs. 1 and 6 and the convergence study as Markdown, JSON and CSV."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from symfpu.numbers.typed import decimal
from symfpu.paper.convergence import BreatherStudy, CancellationStudy
from symfpu.paper.fig1 import Figure1
from symfpu.paper.fig6 import Figure6
from symfpu.paper.printed import FIG1_CLAIMS
from symfpu.paper.table import AmplitudeRow
from symfpu.reports.tables import fifteen_digits, markdown_table, write_csv
from symfpu.reports.torus import torus_record


def row_record(row: AmplitudeRow) -> dict[str, Any]:
    """One row of the table for JSON, printed and computed numbers side by side."""
    printed = row.printed
    return {
        "label": printed.label,
        "printed_label": printed.printed_label,
        "printed_amplitudes": dict(zip(map(str, printed.seeds), printed.amplitudes, strict=True)),
        "printed_energy": printed.energy,
        "digits_by_frequency_order": {str(k): round(d, 2) for k, d in row.digits.items()},
        "met_at_frequency_orders": list(row.met),
        "digits": round(row.digits[row.best], 2),
        "energies": {name: repr(value) for name, value in row.energies.items()},
        "energy_matches": list(row.energy_matches),
        "energy_orders": {name: list(orders) for name, orders in row.energy_orders.items()},
        "verdict": row.verdict,
        "torus": torus_record(row.torus),
    }


def figure1_record(data: Figure1) -> dict[str, Any]:
    """The claims about Fig. 1 for JSON."""
    ours = data.claims()
    judged = {
        "digits": data.torus.digits,
        "rounding_of_doubles": fifteen_digits(data.rounding),
        "assessment": data.assessment.record(),
    }
    return {
        "best_order": data.best_order,
        **judged,
        "claims": {key: {"printed": FIG1_CLAIMS[key], "computed": ours[key]} for key in ours},
    }


def table_markdown(rows: Sequence[AmplitudeRow]) -> str:
    """The table of Appendix F and Fig. 1: a summary, then every frequency order of every row."""
    parts = [
        "## Appendix F and Fig. 1: amplitudes and energies from the printed frequencies",
        "Digits are those of the worst amplitude, -log10 |ours/printed - 1|. Two truncation orders: K of the frequency series "
        "that gives the amplitudes, `order` of the coordinates that give the energies.",
        markdown_table(
            [
                "torus",
                "N",
                "alpha",
                "seeds",
                "order",
                "met at K",
                "digits",
                "printed E",
                "H(0)",
                "harmonic E(0)",
                "average",
                "residual",
            ],
            [_summary(row) for row in rows],
        ),
    ]
    for row in rows:
        printed = row.printed
        head = f"### {printed.label} (Appendix F: {printed.printed_label}), {printed.chain!r}, seeds {printed.seeds}"
        lines = [["printed", *printed.amplitudes, ""]]
        lines += [
            [str(k), *(repr(a) for a in row.history.amplitudes[k]), f"{row.digits[k]:.1f}"]
            for k in _shown(row)
        ]
        columns = ["K", *(f"A_{q}" for q in printed.seeds), "digits"]
        failures = [f"K = {k}: {failure}" for k, failure in row.history.failures.items()]
        parts += [head, f"Verdict: {row.verdict}.", markdown_table(columns, lines), *failures]
    return "\n\n".join(parts) + "\n"


def _summary(row: AmplitudeRow) -> list[str]:
    printed = row.printed
    met = ", ".join(map(str, row.met)) or f"none (nearest {row.best})"
    values = [f"{value:.8g}" for value in row.energies.values()]
    seeds = ",".join(map(str, printed.seeds))
    fixed = [
        printed.label,
        str(printed.chain.N),
        decimal(printed.chain.alpha),
        seeds,
        str(printed.order),
    ]
    return [
        *fixed,
        met,
        f"{row.digits[row.best]:.1f}",
        printed.energy,
        *values,
        f"{row.residual:.1e}",
    ]


def _shown(row: AmplitudeRow) -> list[int]:
    """All orders of a short history.

    Of a long one the beginning, the end, what is met and every tenth.
    """
    orders = list(row.digits)
    if len(orders) <= 30:
        return orders
    return [
        k
        for i, k in enumerate(orders)
        if i < 5 or i >= len(orders) - 5 or k in (*row.met, row.best) or i % 10 == 9
    ]


def figure1_markdown(data: Figure1) -> str:
    """The claims of the text about Fig. 1 beside ours, and where the pictures are."""
    ours = data.claims()
    rows = [[key.replace("_", " "), FIG1_CLAIMS[key], ours[key]] for key in ours]
    pictures = "\n\n".join(f"![Fig. 1({panel})](fig1{panel}.png)" for panel in "abcd")
    residual = ", ".join(f"{k}: {value:.1e}" for k, value in data.residuals.items() if k % 2 == 0)
    return (
        "## Fig. 1: the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2\n\n"
        + markdown_table(["claim", "printed", "computed"], rows)
        + f"\n\nResidual of the equations of motion by coordinate order: {residual}.\n"
        + f"The least is at order {data.best_order}.\n\n"
        + f"Verdict on the series: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).\n\n"
        + f"Computed with {data.torus.series.precision}. In doubles the amplitudes of all orders come out the same to "
        + f"{data.rounding:.1e}.\n\n{pictures}\n"
    )


def write_figure1_csv(data: Figure1, folder: Path) -> list[Path]:
    """The data behind panels (a) to (d), one CSV file each."""
    seeds = data.torus.series.seeds
    modes = range(1, data.torus.series.chain.N)
    tables: dict[str, tuple[list[str], Iterable[Sequence[Any]]]] = {
        "fig1a": (
            ["q", *(f"average_energy_over_H_order_{k}" for k in data.spectra)],
            ([q, *(float(s[q - 1]) for s in data.spectra.values())] for q in modes),
        ),
        "fig1b": (
            ["k", *(f"delta_A{q}" for q in seeds)],
            ([k, *d] for k, d in data.differences.items()),
        ),
        "fig1c": (
            ["k", "mu_k_S1", "mu_k_S2"],
            ([k, float(a), float(b)] for k, (a, b) in enumerate(zip(*data.sums, strict=True))),
        ),
        "fig1d": (
            ["t", *(f"{name}_order_{k}" for k in data.errors for name in ("total", "harmonic"))],
            (
                [float(t), *(float(e[i]) for pair in data.errors.values() for e in pair)]
                for i, t in enumerate(data.times)
            ),
        ),
    }
    return write_csv(tables, folder)


def write_figure6_csv(data: Figure6, folder: Path) -> list[Path]:
    """The data behind the panels of Fig. 6, one CSV file each."""
    return write_csv(
        {
            f"fig6{panel}": (
                ["q", "kappa", "order"],
                [[q, q / data.N, orders[q]] for q in sorted(orders)],
            )
            for panel, (_, orders) in data.panels.items()
        },
        folder,
    )


def figure6_markdown(data: Figure6) -> str:
    """What Fig. 6 shows, and where the pictures are."""
    lines = [
        [panel, f"{seeds[0]}..{seeds[-1]}", str(len(orders)), str(max(orders.values()))]
        for panel, (seeds, orders) in data.panels.items()
    ]
    pictures = "\n\n".join(f"![Fig. 6({panel})](fig6{panel}.png)" for panel in data.panels)
    table = markdown_table(["panel", "seeds", "modes excited", "at order, at the latest"], lines)
    return f"## Fig. 6: orders of first excitation, N = {data.N}, alpha\n\n{table}\n\n{pictures}\n"


def cancellation_markdown(data: CancellationStudy) -> str:
    """Question (i) of the convergence study: what was tested, what came out."""
    shown = (14, 20, 24, 28)
    rows = [
        [
            v.name,
            *(f"{max(v.differences[k]):.2e}" for k in shown),
            *(f"{v.sums[k]:.2e}" for k in (14, 30)),
            f"{v.residuals.min():.1e}",
        ]
        for v in data.variants
    ]
    table = markdown_table(
        ["case", *(f"dA({k})" for k in shown), "S_2(14)", "S_2(30)", "least residual"], rows
    )
    ratios = ", ".join(f"{k}: {r:.6f}" for k, r in data.ratios.items() if k >= 20)
    by_order = [
        [
            str(k),
            f"{data.residuals[k]:.1e}",
            f"{data.resummed[k]:.1e}",
            *(f"{a:.10f}" for pair in data.amplitudes[k] for a in pair),
        ]
        for k in data.resummed
    ]
    columns = ["order", "residual", "resummed", "A_1", "A_2", "A_1 resummed", "A_2 resummed"]
    first, second = data.coincidence
    return "\n\n".join(
        [
            "## Question (i): Fig. 1(b, c), why the errors stop falling",
            table,
            f"Exact coincidence: {first} omega_1 {second:+d} omega_2 = 0, at order {abs(first) + abs(second) - 1}; none before.",
            f"Verdict: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).",
            f"The coefficient of harmonic (5,-4) in mode 3, divisor {data.divisor:.4e}, grows every two orders by: {ratios}.",
            f"Mode 3's own frequency on the torus, a series in mu^2, meets 4 omega_2 - 5 omega_1 at {data.pole:.5f} of the actual mu^2: "
            f"a pole there makes terms grow by {1 / data.pole:.5f} every two orders.",
            markdown_table(columns, by_order),
        ]
    )


def breather_markdown(data: BreatherStudy) -> str:
    """Question (ii) of the convergence study."""
    rows = []
    for name, orbit in (("printed frequency", data.orbit), ("printed amplitude", data.at_printed)):
        harmonic = orbit.harmonic_energies().sum()
        motion = [f"{float(orbit.frequency):.14f}", f"{orbit.amplitude:.11f}"]
        energies = [f"{orbit.energy():.10f}", f"{harmonic:.10f}"]
        rows.append([name, *motion, *energies, f"{orbit.residual():.0e}"])
    orders = [
        k for k in data.amplitudes if k in (2, 10, 50, 100, 150, 200) or k == max(data.amplitudes)
    ]
    return "\n\n".join(
        [
            "## Question (ii): the breather of E = 0.014915",
            markdown_table(
                ["periodic orbit with the", "omega", "A", "H", "harmonic E(0)", "residual"], rows
            ),
            "A(K) of the truncated series: "
            + ", ".join(f"{k}: {data.amplitudes[k]:.8f}" for k in orders)
            + ".",
            f"The frequency series with these divisors ends at A = {data.singularity:.9f} (spread of the fit {data.spread:.0e}) in a "
            f"singularity of exponent {data.exponent:.4f}.",
            f"The breathers lie behind such an end, out of reach of the series, from A = {data.limit.orbit.amplitude:.6f}, omega = "
            f"{float(data.limit.orbit.frequency):.9f}, H = {data.limit.orbit.energy():.7f} on; Newton's method followed the family to H = "
            f"{data.limit.family.members[-1].energy:.4f}.",
            f"Verdict: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).",
        ]
    )


def convergence_markdown(cancellation: CancellationStudy, breather: BreatherStudy) -> str:
    """Both questions, and where the pictures are."""
    pictures = "\n\n".join(
        f"![{name}]({name}.png)" for name in (f"convergence-{x}" for x in "abcde")
    )
    return (
        "\n\n".join([cancellation_markdown(cancellation), breather_markdown(breather), pictures])
        + "\n"
    )


def convergence_record(cancellation: CancellationStudy, breather: BreatherStudy) -> dict[str, Any]:
    """Both questions for JSON."""
    return {
        "coincidence": list(cancellation.coincidence),
        "divisor": fifteen_digits(cancellation.divisor),
        "pole": fifteen_digits(cancellation.pole),
        "ratios": {str(k): fifteen_digits(r) for k, r in cancellation.ratios.items()},
        "resummed_residuals": {str(k): fifteen_digits(r) for k, r in cancellation.resummed.items()},
        "torus": cancellation.assessment.record(),
        "orbit": {
            "frequency": decimal(breather.orbit.frequency),
            "amplitude": repr(breather.orbit.amplitude),
        },
        "orbit_energy": repr(float(breather.orbit.energy())),
        "singularity": fifteen_digits(breather.singularity),
        "limit": {
            "frequency": decimal(breather.limit.orbit.frequency),
            "amplitude": repr(breather.limit.orbit.amplitude),
            "energy": repr(float(breather.limit.orbit.energy())),
        },
        "breather": breather.assessment.record(),
    }


def write_convergence_csv(
    cancellation: CancellationStudy, breather: BreatherStudy, folder: Path
) -> list[Path]:
    """The data behind the pictures of the convergence study."""
    names = [v.name for v in cancellation.variants]
    orders = list(cancellation.variants[0].differences)
    return write_csv(
        {
            "convergence-a": (
                ["k", *names],
                ([k, *(max(v.differences[k]) for v in cancellation.variants)] for k in orders),
            ),
            "convergence-b": (
                ["k", *names],
                (
                    [k, *row]
                    for k, row in enumerate(
                        zip(*(v.sums for v in cancellation.variants), strict=True)
                    )
                ),
            ),
            "convergence-c": (
                ["order", "truncated", "resummed"],
                ([k, cancellation.residuals[k], r] for k, r in cancellation.resummed.items()),
            ),
            "convergence-d": (["K", "A"], ([k, a] for k, a in breather.amplitudes.items())),
            "convergence-e": (
                ["omega", "A", "A at the end of the series"],
                zip(
                    breather.limit.frequencies,
                    breather.limit.amplitudes,
                    breather.limit.ends,
                    strict=True,
                ),
            ),
        },
        folder,
    )
