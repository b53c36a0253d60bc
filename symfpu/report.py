"""Results as text: JSON with numbers that lose no digit, Markdown, CSV. Computes nothing."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from symfpu.chain import decimal
from symfpu.errors import InputError
from symfpu.paper import FIG1_CLAIMS
from symfpu.reproduction import AmplitudeRow, Figure1, Figure6
from symfpu.sweeps import Sweep, SweepCase
from symfpu.torus import QTorus


def output_folder(path: Path) -> Path:
    """The folder, made if missing; InputError if it cannot be written."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        if not os.access(path, os.W_OK):
            raise PermissionError("no permission to write")
    except OSError as error:
        raise InputError(
            "output", str(path), "a folder that can be written", f"choose another with -o ({error.strerror or error})"
        ) from error
    return path


def fifteen_digits(value: float) -> float:
    """A measure of size to 15 digits, the most that a number in JSON has; what needs more is written as a string."""
    return float(f"{value:.15g}")


def torus_record(torus: QTorus) -> dict[str, Any]:
    """A torus for JSON: keys of the command line, numbers of more than 15 digits as strings."""
    series = torus.series
    return {
        "N": series.chain.N,
        "alpha": decimal(series.chain.alpha),
        "beta": decimal(series.chain.beta),
        "seeds": list(series.seeds),
        "frequencies": {str(q): decimal(w) for q, w in zip(series.seeds, series.frequencies or (), strict=True)},
        "order": torus.order,
        "frequency_order": torus.frequency_order,
        "amplitudes": {str(q): repr(a) for q, a in torus.amplitudes.items()},
        "history": {str(k): [repr(a) for a in values] for k, values in torus.history.items()},
        "energy": repr(float(torus.energy())),
        "harmonic_energy": repr(float(torus.harmonic_energies().sum())),
        "average_harmonic_energy": repr(float(torus.average_spectrum().sum())),
        "residual": fifteen_digits(torus.residual()),
        "root_residual": fifteen_digits(torus.root_residual),
        "smallest_divisors": [
            {"size": fifteen_digits(d.size), "mode": d.mode, "harmonic": list(d.harmonic), "order": d.order}
            for d in series.smallest_divisors
        ],
        "warnings": list(torus.warnings),
    }


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
    return {"best_order": data.best_order, "claims": {key: {"printed": FIG1_CLAIMS[key], "computed": ours[key]} for key in ours}}


def markdown_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def table_markdown(rows: Sequence[AmplitudeRow]) -> str:
    """The table of Appendix F and Fig. 1: a summary, then every frequency order of every row."""
    parts = [
        "## Appendix F and Fig. 1: amplitudes and energies from the printed frequencies",
        "Digits are those of the worst amplitude, -log10 |ours/printed - 1|. Two truncation orders: K of the frequency series "
        "that gives the amplitudes, `order` of the coordinates that give the energies.",
        markdown_table(
            ["torus", "N", "alpha", "seeds", "order", "met at K", "digits", "printed E", "H(0)", "harmonic E(0)", "average", "residual"],
            [_summary(row) for row in rows],
        ),
    ]
    for row in rows:
        printed = row.printed
        head = f"### {printed.label} (Appendix F: {printed.printed_label}), {printed.chain!r}, seeds {printed.seeds}"
        lines = [["printed", *printed.amplitudes, ""]]
        lines += [[str(k), *(repr(a) for a in row.history.amplitudes[k]), f"{row.digits[k]:.1f}"] for k in _shown(row)]
        columns = ["K", *(f"A_{q}" for q in printed.seeds), "digits"]
        failures = [f"K = {k}: {failure}" for k, failure in row.history.failures.items()]
        parts += [head, f"Verdict: {row.verdict}.", markdown_table(columns, lines), *failures]
    return "\n\n".join(parts) + "\n"


def _summary(row: AmplitudeRow) -> list[str]:
    printed = row.printed
    met = ", ".join(map(str, row.met)) or f"none (nearest {row.best})"
    values = [f"{value:.8g}" for value in row.energies.values()]
    seeds = ",".join(map(str, printed.seeds))
    fixed = [printed.label, str(printed.chain.N), decimal(printed.chain.alpha), seeds, str(printed.order)]
    return [*fixed, met, f"{row.digits[row.best]:.1f}", printed.energy, *values, f"{row.residual:.1e}"]


def _shown(row: AmplitudeRow) -> list[int]:
    """All orders of a short history; of a long one the beginning, the end, what is met and every tenth."""
    orders = list(row.digits)
    if len(orders) <= 30:
        return orders
    return [k for i, k in enumerate(orders) if i < 5 or i >= len(orders) - 5 or k in (*row.met, row.best) or i % 10 == 9]


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
        + f"The least is at order {data.best_order}.\n\n{pictures}\n"
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
        "fig1b": (["k", *(f"delta_A{q}" for q in seeds)], ([k, *d] for k, d in data.differences.items())),
        "fig1c": (
            ["k", "mu_k_S1", "mu_k_S2"],
            ([k, float(a), float(b)] for k, (a, b) in enumerate(zip(*data.sums, strict=True))),
        ),
        "fig1d": (
            ["t", *(f"{name}_order_{k}" for k in data.errors for name in ("total", "harmonic"))],
            ([float(t), *(float(e[i]) for pair in data.errors.values() for e in pair)] for i, t in enumerate(data.times)),
        ),
    }
    return write_csv(tables, folder)


def write_figure6_csv(data: Figure6, folder: Path) -> list[Path]:
    """The data behind the panels of Fig. 6, one CSV file each."""
    return write_csv(
        {
            f"fig6{panel}": (["q", "kappa", "order"], [[q, q / data.N, orders[q]] for q in sorted(orders)])
            for panel, (_, orders) in data.panels.items()
        },
        folder,
    )


def figure6_markdown(data: Figure6) -> str:
    """What Fig. 6 shows, and where the pictures are."""
    lines = [
        [panel, f"{seeds[0]}..{seeds[-1]}", str(len(orders)), str(max(orders.values()))] for panel, (seeds, orders) in data.panels.items()
    ]
    pictures = "\n\n".join(f"![Fig. 6({panel})](fig6{panel}.png)" for panel in data.panels)
    table = markdown_table(["panel", "seeds", "modes excited", "at order, at the latest"], lines)
    return f"## Fig. 6: orders of first excitation, N = {data.N}, alpha\n\n{table}\n\n{pictures}\n"


def write_csv(tables: Mapping[str, tuple[Sequence[str], Iterable[Sequence[Any]]]], folder: Path) -> list[Path]:
    """Tables by name, each with its header, as CSV files in a folder."""
    paths = []
    for name, (header, lines) in tables.items():
        path = folder / f"{name}.csv"
        with path.open("w", newline="") as file:
            csv.writer(file).writerows([header, *lines])
        paths.append(path)
    return paths


def sweep_markdown(sweep: Sweep) -> str:
    """A sweep of the propagation rule: how often it holds by N and number of seeds, and every exception."""
    groups: dict[tuple[int, int], list[SweepCase]] = {}
    for case in sweep.cases:
        groups.setdefault((case.N, len(case.seeds)), []).append(case)
    rows = [
        [str(N), str(s), str(len(cases)), *(str(sum(c.verdict == v for c in cases)) for v in ("proved", "refuted", "undecided"))]
        for (N, s), cases in groups.items()
    ]
    exceptions = [
        [str(case.N), ", ".join(map(str, case.seeds)), "; ".join(f"{q}: {p} -> {a}" for q, p, a in case.exceptions)]
        for case in sweep.exceptions
    ]
    holds = sum(case.corrected_rule_holds for case in sweep.cases)
    parts = [
        f"## {sweep.model} model, order {sweep.order}",
        f"{len(sweep.cases)} seed sets. The proposition holds in {sum(c.verdict == 'proved' for c in sweep.cases)}; "
        f"the corrected rule predicts the actual sets in {holds}.",
        markdown_table(["N", "seeds", "sets", "proved", "refuted", "undecided"], rows),
    ]
    if exceptions:
        parts += [
            "Exceptions (mode: predicted order -> actual order):",
            markdown_table(["N", "seeds", "exceptions"], exceptions),
        ]
    return "\n\n".join(parts) + "\n"
