"""The corrected table as text: Markdown, JSON and CSV of exact tori beside the printed ones.
Computes nothing.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from symfpu.paper.corrected import FEW_DIGITS, LIMIT, CorrectedRow, ScalingStudy, SeriesErrors
from symfpu.paper.table import rounds_to
from symfpu.refinement.tori import RefinedTorus
from symfpu.reports.tables import fifteen_digits, markdown_table, write_csv

SHOWN_ORDERS = (2, 4, 6, 8, 10, 12, 16, 20, 30, 60, 120, 242)
HEADING = "## Appendix F and Fig. 1 corrected: exact tori of the printed frequencies"
WHAT = (
    "Newton's method on the invariance equation, at the printed frequencies. Amplitudes have the digits, at most 12, in which two "
    "refinements with different sets of harmonics agree. H and the harmonic energies are at the angles zero; the residual is the largest "
    "of the equations of motion, between the grid points, relative to the largest acceleration. A row that takes more than "
    f"{LIMIT:.0f} s is not refined."
)
ERRORS = (
    "Error of order K: largest Omega_q |c_q^PL[nu] - c_q[nu]|, relative to the largest Omega_q |c_q[nu]|, the series cut at order K. "
    "`A(K)`: with the amplitudes of the frequency series cut at K, which is the paper's method; `A exact`: with those of the exact torus."
)
SCALING = (
    "Exponents of mu, the slope of the error against mu A between the last two of the tori with amplitudes 1, 1/2, 1/4, ... of the exact "
    "one's. With the exact amplitudes the error of order K is that of the first term left out, K + 1. The amplitudes A(K) are worse: they "
    "solve omega - Omega, itself of order mu^2, with an error of order mu^(K+2) for even K, and so have a relative error of mu^K."
)


def corrected_markdown(rows: Sequence[CorrectedRow], studies: Sequence[ScalingStudy]) -> str:
    """The corrected table: amplitudes, energies, errors by order, exponents, and where the
    pictures are.
    """
    refined = [
        (row, row.torus, row.errors)
        for row in rows
        if row.torus is not None and row.errors is not None
    ]
    names = ["corrected-a", "corrected-b", *(f"corrected-{c}" for c in "cdef"[: len(studies)])]
    parts = [
        HEADING,
        WHAT,
        markdown_table(
            ["torus", "mode", "printed A", "exact A", "printed/exact - 1"],
            [line for row, torus, _ in refined for line in _amplitude_lines(row, torus)],
        ),
        markdown_table(
            [
                "torus",
                "printed E",
                "H",
                "harmonic E(0)",
                "average",
                "printed E is, or nearest",
                "residual",
                "harmonics",
            ],
            [_energy_line(row, torus) for row, torus, _ in refined],
        ),
        "### The error of the series by order",
        ERRORS,
        markdown_table(
            ["torus", "amplitudes", *map(str, SHOWN_ORDERS)],
            [line for row, _, errors in refined for line in _error_lines(row, errors)],
        ),
        "\n".join(f"- {row.printed.label}: {row.verdict}." for row in rows),
        "### Does the error of order K fall as mu^(K+1)?",
        SCALING,
        markdown_table(
            ["torus", "K", "exponent, A exact", "expected", "exponent, A(K)", "expected"],
            _exponent_lines(studies),
        ),
        "\n\n".join(f"![{name}]({name}.png)" for name in names),
    ]
    return "\n\n".join(parts) + "\n"


def amplitude_text(row: CorrectedRow, value: float) -> str:
    """An amplitude to its converged digits, the last zeros kept."""
    return f"{value:#.{max(row.digits, FEW_DIGITS)}g}"


def _amplitude_lines(row: CorrectedRow, torus: RefinedTorus) -> list[list[str]]:
    printed = dict(zip(row.printed.seeds, row.printed.amplitudes, strict=True))
    return [
        [
            row.printed.label if q == row.printed.seeds[0] else "",
            str(q),
            printed[q],
            amplitude_text(row, a),
            f"{row.deviations[q]:+.1e}",
        ]
        for q, a in torus.amplitudes.items()
    ]


def _energy_line(row: CorrectedRow, torus: RefinedTorus) -> list[str]:
    met = [name for name, value in row.energies.items() if rounds_to(value, row.printed.energy)]
    nearest = min(row.energy_deviations.items(), key=lambda item: abs(item[1]))
    said = " and ".join(met) or f"none; {nearest[0]} {nearest[1]:+.1e}"
    values = [f"{value:.12g}" for value in row.energies.values()]
    return [
        row.printed.label,
        row.printed.energy,
        *values,
        said,
        f"{row.residual:.0e}",
        str(len(torus.harmonics)),
    ]


def _error_lines(row: CorrectedRow, errors: SeriesErrors) -> list[list[str]]:
    both = (("A(K)", errors.solved), ("A exact", errors.given))
    return [
        [
            row.printed.label if i == 0 else "",
            name,
            *(f"{values[K]:.0e}" if K in values else "" for K in SHOWN_ORDERS),
        ]
        for i, (name, values) in enumerate(both)
    ]


def _exponent_lines(studies: Sequence[ScalingStudy]) -> list[list[str]]:
    return [
        [
            study.label,
            str(K),
            f"{given:.3f}",
            str(K + 1),
            *(("", "") if math.isnan(solved) else (f"{solved:.3f}", str(K - K % 2))),
        ]
        for study in studies
        for K, (given, solved) in study.rates.items()
    ]


def corrected_record(row: CorrectedRow, study: ScalingStudy | None = None) -> dict[str, Any]:
    """A corrected row for JSON: numbers of more than 15 digits as strings, errors by order."""
    if row.torus is None or row.errors is None:
        return {"refined": False, "verdict": row.verdict}
    errors = {
        "solved": row.errors.solved,
        "given": row.errors.given,
        "amplitudes": row.errors.amplitudes,
    }
    decays = {
        name: {
            "factor": None if math.isnan(d.factor) else fifteen_digits(d.factor),
            "late_factor": None if math.isnan(d.late) else fifteen_digits(d.late),
            "last_falling_order": d.last,
            "least": fifteen_digits(d.least),
            "longest_order": d.longest,
            "at_longest": fifteen_digits(d.at_end),
            "rounding": d.rounding,
        }
        for name, d in row.decays.items()
    }
    return {
        "refined": True,
        "amplitudes": {str(q): amplitude_text(row, a) for q, a in row.torus.amplitudes.items()},
        "converged_digits": row.digits,
        "amplitude_deviations": {str(q): fifteen_digits(x) for q, x in row.deviations.items()},
        "energies": {name: repr(value) for name, value in row.energies.items()},
        "energy_deviations": {name: fifteen_digits(x) for name, x in row.energy_deviations.items()},
        "residual": fifteen_digits(row.residual),
        "harmonics": len(row.torus.harmonics),
        "errors": {
            name: {str(K): fifteen_digits(e) for K, e in values.items()}
            for name, values in errors.items()
        },
        "decays": decays,
        "exponents_of_mu": None if study is None else _exponents_record(study),
        "verdict": row.verdict,
    }


def _exponents_record(study: ScalingStudy) -> dict[str, Any]:
    return {
        str(K): {
            name: None if math.isnan(x) else fifteen_digits(x)
            for name, x in zip(("given", "solved"), rates, strict=True)
        }
        for K, rates in study.rates.items()
    }


def corrected_text(row: CorrectedRow) -> str:
    """A corrected row for the terminal, beside the lines of the table."""
    if row.torus is None:
        return f"  corrected: {row.verdict}"
    amplitudes = ", ".join(
        f"A_{q} = {amplitude_text(row, a)}" for q, a in row.torus.amplitudes.items()
    )
    return f"  exact torus: {amplitudes}, H = {row.energies['H']:.12g}, residual {row.residual:.0e}\n  {row.verdict}"


def write_corrected_csv(
    rows: Sequence[CorrectedRow], studies: Sequence[ScalingStudy], folder: Path
) -> list[Path]:
    """The data behind the pictures of the corrected table, one CSV file each."""
    known = {row.printed.label: row.errors for row in rows if row.errors is not None}
    solved = {label: errors.solved for label, errors in known.items()}
    given = {label: errors.given for label, errors in known.items()}
    tables: dict[str, tuple[list[str], list[list[Any]]]] = {}
    for name, errors in (("corrected-a", solved), ("corrected-b", given)):
        orders = sorted({*itertools.chain.from_iterable(errors.values())})
        tables[name] = (
            ["K", *errors],
            [[K, *(values.get(K, "") for values in errors.values())] for K in orders],
        )
    for letter, study in zip("cdef", studies, strict=False):
        columns = {
            f"{name}_{K}": e
            for name, part in (("given", study.given), ("solved", study.solved))
            for K, e in part.items()
        }
        lines = [[x, *(e[i] for e in columns.values())] for i, x in enumerate(study.scales)]
        tables[f"corrected-{letter}"] = (["scale", *columns], lines)
    return write_csv(tables, folder)
