"""The table of Appendix F and Fig. 1, as printed and corrected: page, record, lines, pictures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from symfpu.files.progress import Progress
from symfpu.numbers.typed import decimal
from symfpu.paper.claims import PaperFigure
from symfpu.paper.corrected import corrected_rows
from symfpu.paper.corrected_page import (
    corrected_line,
    corrected_panels,
    corrected_record,
    corrected_text,
)
from symfpu.paper.series_errors import ScalingStudy, scaling_study
from symfpu.paper.table import AmplitudeRow, amplitude_table
from symfpu.paper.table_claims import table_claims
from symfpu.results.text_tables import markdown_table

SCALED_ROWS = ("Fig. 1", "Fig. 7")  # whose errors are followed to smaller mu
SHORT_HISTORY = 30  # orders; of a longer one some are shown
ENDS_SHOWN = 5  # orders at the beginning and at the end of a long history
TITLE = "Appendix F and Fig. 1: amplitudes and energies from the printed frequencies"
WHAT = (
    "Digits are those of the worst amplitude, -log10 |ours/printed - 1|. Two truncation orders: "
    "K of the frequency series that gives the amplitudes, `order` of the coordinates that give "
    "the energies."
)
ENERGIES = ("printed E", "H(0)", "harmonic E(0)", "average")
HEAD = (
    "torus",
    "N",
    "alpha",
    "seeds",
    "order",
    "met at K",
    "digits",
    *ENERGIES,
    "residual",
)


def table(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """The table from the printed frequencies, and the exact tori beside it."""
    rows = list(amplitude_table(progress))
    known = {row.printed: row.series for row in rows}
    corrected = list(corrected_rows(known, progress, full=full))
    studies: dict[str, ScalingStudy] = {}
    for row in corrected:
        label = row.printed.label
        if row.torus and label in SCALED_ROWS:
            studies[label] = scaling_study(row.torus, label, progress)
    records = []
    lines = []
    for series_row, row in zip(rows, corrected, strict=True):
        study = studies.get(row.printed.label)
        record = row_record(series_row)
        record["corrected"] = corrected_record(row, study)
        records.append(record)
        lines.append(f"{row_line(record)}\n{corrected_line(row)}\n")
    found = list(studies.values())
    text = (*table_text(rows), *corrected_text(corrected, found))
    panels = corrected_panels(corrected, found)
    claims = table_claims(rows)
    return PaperFigure("table", TITLE, panels, claims, (), text, records, tuple(lines))


def row_record(row: AmplitudeRow) -> dict[str, Any]:
    """One row of the table for JSON, printed and computed numbers side by side."""
    printed = row.printed
    by_seed = zip(map(str, printed.seeds), printed.amplitudes, strict=True)
    record: dict[str, Any] = {"label": printed.label}
    record["printed_label"] = printed.printed_label
    record["printed_amplitudes"] = dict(by_seed)
    record["printed_energy"] = printed.energy
    record["digits_by_frequency_order"] = {
        str(k): round(d, 2) for k, d in row.digits.items()
    }
    record["met_at_frequency_orders"] = list(row.met)
    record["digits"] = round(row.digits[row.best], 2)
    record["energies"] = {name: repr(value) for name, value in row.energies.items()}
    record["energy_matches"] = list(row.energy_matches)
    record["energy_orders"] = {
        name: list(orders) for name, orders in row.energy_orders.items()
    }
    record["verdict"] = row.verdict
    record["torus"] = row.torus.record()
    return record


def row_line(record: dict[str, Any]) -> str:
    """One row of the table for the terminal, in lines."""
    computed = record["torus"]["amplitudes"]
    lines = [f"{record['label']}  (Appendix F: {record['printed_label']})"]
    for q, printed in record["printed_amplitudes"].items():
        lines.append(f"  A_{q:<3} printed {printed:<24} computed {computed[q]}")
    energies = [f"{name} {float(value):.9g}" for name, value in record["energies"].items()]
    lines.append(
        f"  E    printed {record['printed_energy']:<24} computed {', '.join(energies)}"
    )
    lines.append(f"  {record['verdict']}")
    return "\n".join(lines)


def table_text(rows: Sequence[AmplitudeRow]) -> tuple[str, ...]:
    """A summary, then every frequency order of every row."""
    summary = [_summary(row) for row in rows]
    parts = [WHAT, markdown_table(HEAD, summary)]
    for row in rows:
        printed = row.printed
        head = f"### {printed.label} (Appendix F: {printed.printed_label}), "
        head += f"{printed.chain!r}, seeds {printed.seeds}"
        parts += [head, f"Verdict: {row.verdict}.", _orders_table(row)]
        parts += [f"K = {k}: {failure}" for k, failure in row.history.failures.items()]
    return tuple(parts)


def _orders_table(row: AmplitudeRow) -> str:
    """Amplitudes by frequency order, below the printed ones."""
    lines = [["printed", *row.printed.amplitudes, ""]]
    for k in _shown_orders(row):
        amplitudes = [repr(a) for a in row.history.amplitudes[k]]
        lines.append([str(k), *amplitudes, f"{row.digits[k]:.1f}"])
    columns = [f"A_{q}" for q in row.printed.seeds]
    return markdown_table(["K", *columns, "digits"], lines)


def _summary(row: AmplitudeRow) -> list[str]:
    printed = row.printed
    seeds = ",".join(map(str, printed.seeds))
    met = ", ".join(map(str, row.met)) or f"none (nearest {row.best})"
    cells = [printed.label, str(printed.chain.N), decimal(printed.chain.alpha)]
    cells += [seeds, str(printed.order), met]
    cells += [f"{row.digits[row.best]:.1f}", printed.energy]
    cells += [f"{value:.8g}" for value in row.energies.values()]
    cells.append(f"{row.residual:.1e}")
    return cells


def _shown_orders(row: AmplitudeRow) -> list[int]:
    """All orders of a short history.

    Of a long one the beginning, the end, what is met and every tenth.
    """
    orders = list(row.digits)
    if len(orders) <= SHORT_HISTORY:
        return orders
    named = {*row.met, row.best}
    named |= {*orders[:ENDS_SHOWN], *orders[-ENDS_SHOWN:], *orders[9::10]}
    return [k for k in orders if k in named]
