"""The corrected table: text, record and pictures of exact tori beside the printed ones.

Computes nothing.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from symfpu.figures.panels import Curve, Panel
from symfpu.paper.corrected import LEAST_DIGITS, LIMIT, CorrectedRow
from symfpu.paper.series_errors import Decay, ScalingStudy, SeriesErrors
from symfpu.paper.table import rounds_to
from symfpu.refinement.newton import Newton
from symfpu.results.numbers import fifteen_digits
from symfpu.results.text_tables import markdown_table
from symfpu.tori.torus import Torus

ErrorsByLabel = Mapping[str, Mapping[int, float]]

SHOWN_ORDERS = (2, 4, 6, 8, 10, 12, 16, 20, 30, 60, 120, 242)
# of a series beside its exact torus; the longest one goes on in the same way, in the CSV
LAST_DRAWN_ORDER = 62
ERRORS_BOTTOM = 1e-16
HEADING = "## Appendix F and Fig. 1 corrected: exact tori of the printed frequencies"
WHAT = (
    "Newton's method on the invariance equation, at the printed frequencies. Amplitudes have the "
    "digits, at most 12, in which two refinements with different sets of harmonics agree, and so "
    "have energies. H and the harmonic energies are at the angles zero; the residual is the "
    "largest of the equations of motion, between the grid points, relative to the largest "
    "acceleration. A row that takes "
    f"more than {LIMIT:.0f} s is not refined."
)
ERRORS = (
    "Error of order K: largest Omega_q |c_q^PL[nu] - c_q[nu]|, relative to the largest Omega_q "
    "|c_q[nu]|, the series cut at order K. `A(K)`: with the amplitudes of the frequency series "
    "cut at K, which is the paper's method; `A exact`: with those of the exact torus."
)
SCALING = (
    "Exponents of mu, the slope of the error against mu A between the last two of the tori with "
    "amplitudes 1, 1/2, 1/4, ... of the exact one's. With the exact amplitudes the error of order "
    "K is that of the first term left out, K + 1. The amplitudes A(K) are worse: they solve omega "
    "- Omega, itself of order mu^2, with an error of order mu^(K+2) for even K, and so have a "
    "relative error of mu^K."
)
AMPLITUDE_HEAD = ("torus", "mode", "printed A", "exact A", "printed/exact - 1")
ENERGIES = ("printed E", "H", "harmonic E(0)", "average", "printed E is, or nearest")
ENERGY_HEAD = ("torus", *ENERGIES, "residual", "harmonics")
EXPONENT_HEAD = (
    "torus",
    "K",
    "exponent, A exact",
    "expected",
    "exponent, A(K)",
    "expected",
)
ORDER_LABEL = r"order $K$ of coordinates and frequencies"
ERROR_LABEL = (
    r"$\max\,\Omega_q |c_q^{(K)}[\nu] - c_q[\nu]| \,/\, \max\,\Omega_q |c_q[\nu]|$"
)
SCALE_LABEL = r"$\mu A$, relative to the printed torus"


def corrected_text(
    rows: Sequence[CorrectedRow], studies: Sequence[ScalingStudy]
) -> tuple[str, ...]:
    """The corrected table: amplitudes, energies, errors by order, exponents."""
    amplitudes: list[list[str]] = []
    energies: list[list[str]] = []
    errors: list[list[str]] = []
    for row in rows:
        if row.torus is None or row.errors is None:
            continue
        amplitudes += _amplitude_lines(row, row.torus)
        energies.append(_energy_line(row, row.torus))
        errors += _error_lines(row, row.errors)
    orders = [str(K) for K in SHOWN_ORDERS]
    verdicts = [f"- {row.printed.label}: {row.verdict}." for row in rows]
    return (
        HEADING,
        WHAT,
        markdown_table(AMPLITUDE_HEAD, amplitudes),
        markdown_table(ENERGY_HEAD, energies),
        "### The error of the series by order",
        ERRORS,
        markdown_table(["torus", "amplitudes", *orders], errors),
        "\n".join(verdicts),
        "### Does the error of order K fall as mu^(K+1)?",
        SCALING,
        markdown_table(EXPONENT_HEAD, _exponent_lines(studies)),
    )


def amplitude_text(row: CorrectedRow, value: float) -> str:
    """An amplitude to its converged digits, the last zeros kept."""
    digits = max(row.digits, LEAST_DIGITS)
    return f"{value:#.{digits}g}"


def energy_text(row: CorrectedRow, value: float) -> str:
    """An energy to its converged digits, the last zeros kept."""
    digits = max(row.energy_digits, LEAST_DIGITS)
    return f"{value:#.{digits}g}"


def _amplitude_lines(row: CorrectedRow, torus: Torus[Newton]) -> list[list[str]]:
    printed = dict(zip(row.printed.seeds, row.printed.amplitudes, strict=True))
    lines = []
    label = row.printed.label
    for q, a in torus.amplitudes.items():
        deviation = f"{row.deviations[q]:+.1e}"
        lines.append([label, str(q), printed[q], amplitude_text(row, a), deviation])
        label = ""
    return lines


def _energy_line(row: CorrectedRow, torus: Torus[Newton]) -> list[str]:
    printed = row.printed.energy
    met = [name for name, value in row.energies.items() if rounds_to(value, printed)]
    deviations = row.energy_deviations
    nearest = min(deviations, key=lambda name: abs(deviations[name]))
    said = " and ".join(met) or f"none; {nearest} {deviations[nearest]:+.1e}"
    values = [energy_text(row, value) for value in row.energies.values()]
    residual = f"{row.residual:.0e}"
    return [row.printed.label, printed, *values, said, residual, str(len(torus.harmonics))]


def _error_lines(row: CorrectedRow, errors: SeriesErrors) -> list[list[str]]:
    lines = []
    label = row.printed.label
    for name, values in (("A(K)", errors.solved), ("A exact", errors.given)):
        cells = [f"{values[K]:.0e}" if K in values else "" for K in SHOWN_ORDERS]
        lines.append([label, name, *cells])
        label = ""
    return lines


def _exponent_lines(studies: Sequence[ScalingStudy]) -> list[list[str]]:
    lines = []
    for study in studies:
        for K, (given, solved) in study.rates.items():
            line = [study.label, str(K), f"{given:.3f}", str(K + 1)]
            known = not math.isnan(solved)
            even = K - K % 2
            line += [f"{solved:.3f}", str(even)] if known else ["", ""]
            lines.append(line)
    return lines


def corrected_record(
    row: CorrectedRow, study: ScalingStudy | None = None
) -> dict[str, Any]:
    """A corrected row for JSON: numbers of more than 15 digits as strings, errors by order."""
    if row.torus is None or row.errors is None:
        return {"refined": False, "verdict": row.verdict}
    deviations = row.energy_deviations
    amplitudes = row.torus.amplitudes
    record: dict[str, Any] = {"refined": True}
    record["amplitudes"] = {str(q): amplitude_text(row, a) for q, a in amplitudes.items()}
    record["converged_digits"] = row.digits
    record["converged_energy_digits"] = row.energy_digits
    record["amplitude_deviations"] = _rounded(row.deviations)
    record["energies"] = {name: repr(value) for name, value in row.energies.items()}
    record["energy_deviations"] = {
        name: fifteen_digits(x) for name, x in deviations.items()
    }
    record["residual"] = fifteen_digits(row.residual)
    record["harmonics"] = len(row.torus.harmonics)
    record["errors"] = _errors_record(row.errors)
    record["decays"] = {name: _decay_record(d) for name, d in row.decays.items()}
    record["exponents_of_mu"] = None if study is None else _exponents_record(study)
    record["verdict"] = row.verdict
    return record


def _errors_record(errors: SeriesErrors) -> dict[str, dict[str, float]]:
    record = {"solved": _rounded(errors.solved)}
    record["given"] = _rounded(errors.given)
    record["amplitudes"] = _rounded(errors.amplitudes)
    return record


def _rounded(values: Mapping[int, float]) -> dict[str, float]:
    """For JSON, which has strings as keys."""
    return {str(key): fifteen_digits(value) for key, value in values.items()}


def _number(value: float) -> float | None:
    """For JSON, which has no NaN."""
    return None if math.isnan(value) else fifteen_digits(value)


def _decay_record(found: Decay) -> dict[str, Any]:
    record: dict[str, Any] = {"factor": _number(found.factor)}
    record["late_factor"] = _number(found.late)
    record["last_falling_order"] = found.last
    record["least"] = fifteen_digits(found.least)
    record["longest_order"] = found.longest
    record["at_longest"] = fifteen_digits(found.at_end)
    record["rounding"] = found.rounding
    return record


def _exponents_record(study: ScalingStudy) -> dict[str, Any]:
    record = {}
    for K, (given, solved) in study.rates.items():
        record[str(K)] = {"given": _number(given), "solved": _number(solved)}
    return record


def corrected_line(row: CorrectedRow) -> str:
    """A corrected row for the terminal, beside the lines of the table."""
    if row.torus is None:
        return f"  corrected: {row.verdict}"
    found = row.torus.amplitudes
    amplitudes = [f"A_{q} = {amplitude_text(row, a)}" for q, a in found.items()]
    H = energy_text(row, row.energies["H"])
    exact = f"{', '.join(amplitudes)}, H = {H}, residual {row.residual:.0e}"
    return f"  exact torus: {exact}\n  {row.verdict}"


def corrected_panels(
    rows: Sequence[CorrectedRow], studies: Sequence[ScalingStudy]
) -> tuple[Panel, ...]:
    """Pictures of the corrected table: errors by order, and against mu."""
    known = {row.printed.label: row.errors for row in rows if row.errors is not None}
    solved = {label: errors.solved for label, errors in known.items()}
    given = {label: errors.given for label, errors in known.items()}
    title = "Series against exact tori"
    panels = [
        _errors_panel("corrected-a", f"{title}, amplitudes of order K", solved),
        _errors_panel("corrected-b", f"{title}, exact amplitudes", given),
    ]
    for letter, study in zip("cdef", studies, strict=False):
        panels.append(_scaling_panel(f"corrected-{letter}", study))
    return tuple(panels)


def _errors_panel(name: str, title: str, errors: ErrorsByLabel) -> Panel:
    """Errors of several series, by label and order; drawn up to LAST_DRAWN_ORDER."""
    orders = sorted({*itertools.chain.from_iterable(errors.values())})
    columns: dict[str, list[Any]] = {"K": orders}
    curves = []
    for label, values in errors.items():
        K = np.array(list(values), dtype=float)
        curves.append(Curve(label, K, np.array(list(values.values())), "beads"))
        columns[label] = [values.get(order, "") for order in orders]
    return Panel(
        name,
        title,
        ORDER_LABEL,
        ERROR_LABEL,
        tuple(curves),
        ("K", "error"),
        bottom=ERRORS_BOTTOM,
        x_limits=(0.0, LAST_DRAWN_ORDER),
        legend="center right",
        columns=columns,
    )


def _scaling_panel(name: str, study: ScalingStudy) -> Panel:
    """Errors of each order against the scale of mu A.

    Beside them lines of slope K + 1 through the last ones.
    """
    scales = np.array(study.scales)
    columns: dict[str, list[Any]] = {"scale": list(study.scales)}
    curves = []
    groups = {}
    for i, (K, errors) in enumerate(study.given.items()):
        groups[K] = i
        law = errors[-1] * (scales / scales[-1]) ** (K + 1)
        curves.append(Curve(rf"$K = {K}$", scales, np.array(errors), "marks", group=i))
        curves.append(Curve(rf"$\mu^{{{K + 1}}}$", scales, law, group=i))
        columns[f"given_{K}"] = list(errors)
    label = "$A(K)$ instead"
    for K, errors in study.solved.items():
        curve = Curve(label, scales, np.array(errors), "crosses", group=groups[K])
        curves.append(curve)
        columns[f"solved_{K}"] = list(errors)
        label = ""
    return Panel(
        name,
        f"Error of order K against mu, {study.label} and scaled tori",
        SCALE_LABEL,
        "error of the coefficients, relative",
        tuple(curves),
        ("scale", "error"),
        log_x=True,
        legend="best",
        legend_columns=2,
        columns=columns,
    )
