"""A series and the verdict on it, for JSON and for the terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from symfpu.chain.length import label_entry
from symfpu.frames.attributes import exact_text
from symfpu.numbers.arithmetic import text
from symfpu.numbers.counted import short
from symfpu.reports.tables import GAP, fifteen_digits, text_table
from symfpu.series.series import LindstedtSeries
from symfpu.tori.verdict import Assessment, LargestTerm

SHOWN_ORDERS = 10  # of the evidence, about


def series_record(series: LindstedtSeries) -> dict[str, Any]:
    """A series for JSON, without its coefficients: those are in its table and in its file."""
    record = {"kind": type(series).__name__, **series.chain.typed}
    record["seeds"] = list(map(label_entry, series.seeds))
    record["frequencies"] = frequencies_record(series)
    record["order"] = series.order
    record["digits"] = series.digits
    record["smallest_divisors"] = divisor_records(series)
    return record


def frequencies_record(solution: Any) -> dict[str, str] | None:
    """By seed, exact; of a series, too: None where none are chosen."""
    if solution.frequencies is None:
        return None
    return {str(q): exact_text(w) for q, w in solution.omega.items()}


def divisor_records(series: LindstedtSeries) -> list[dict[str, Any]]:
    records = []
    for divisor in series.smallest_divisors:
        record: dict[str, Any] = {"size": fifteen_digits(divisor.size)}
        record["mode"] = divisor.mode
        record["harmonic"] = list(divisor.harmonic)
        record["order"] = divisor.order
        records.append(record)
    return records


def assessment_record(found: Assessment) -> dict[str, Any]:
    """A verdict for JSON, with all its evidence; numbers of more than 15 digits as strings."""
    certificate, sums = found.certificate, found.sums.items()
    return {
        **({} if found.chain is None else found.chain.typed),
        "verdict": found.verdict,
        "reasons": list(found.reasons),
        "best_order": found.best_order,
        "order": found.order,
        "frequency_order": found.frequency_order,
        "root_uncertainty": short(found.root_uncertainty),
        "amplitudes_by_frequency_order": {
            str(K): [text(a, 17) for a in values] for K, values in found.amplitudes.items()
        },
        "differences": {str(K): _short(x) for K, x in found.differences.items()},
        "S_1": {str(q): _short(moduli) for q, (moduli, _) in sums},
        "S_2": {str(q): _short(cosines) for q, (_, cosines) in sums},
        "largest_terms": [_term_record(term) for term in found.terms],
        "growth": short(found.growth),
        "radius_by_ratio": short(found.radius),
        "radius_by_poles": short(found.pole_radius),
        "residuals": _short(found.residuals),
        "energy_errors": _short(found.energy_errors),
        "resummed_residual": short(found.resummed_residual),
        "certified": None if certificate is None else certificate.certified,
    }


def _term_record(term: LargestTerm) -> dict[str, Any]:
    record = {"order": term.order, "size": short(term.size), "mode": term.mode}
    return record | {"harmonic": list(term.harmonic), "divisor": short(term.divisor)}


def _short(values: Iterable[float]) -> list[float | None]:
    return [short(x) for x in values]


def assessment_text(found: Assessment, width: int | None = None) -> str:
    """The evidence of a verdict: reasons, radii, and a line for some of the orders.

    All orders are in the JSON. width : columns of the terminal, where the table is to fit into
    them.
    """
    lines = [f"  {reason}" for reason in found.reasons]
    poles = "no pole" if math.isinf(found.pole_radius) else f"{found.pole_radius:.3g}"
    radii = f"{found.radius:.3g} by ratio of terms, "
    radii += f"{poles} by Pade poles of the frequencies (a hint)"
    lines.append(f"  radius of convergence in units of mu: {radii}")
    seed = next(iter(found.sums))
    head = ["order", f"A_{seed}(k)", "dA(k)", f"S_1, S_2 of Q_{seed}"]
    head += ["coarse residual", "energy error", "largest term: mode, harmonic, divisor"]
    rows = [_order_line(found, seed, k) for k in _shown_orders(found)]
    inner_width = None if width is None else width - len(GAP)
    table = text_table(head, rows, inner_width)
    lines += [GAP + line for line in table]
    return "\n".join(lines)


def _shown_orders(found: Assessment) -> list[int]:
    """At most about a dozen orders: the first, the best, the last, and some between."""
    step = max(1, found.order // SHOWN_ORDERS)
    evenly = range(0, found.order + 1, step)
    return sorted({*evenly, found.best_order, found.order})


def _order_line(found: Assessment, seed: int, k: int) -> list[str]:
    first, second = (sums[k] for sums in found.sums[seed])
    position = list(found.sums).index(seed)
    amplitude = change = largest = ""
    if k in found.amplitudes:
        amplitude = f"{float(found.amplitudes[k][position]):.10g}"
    if k in found.differences:
        change = f"{max(found.differences[k]):.1e}"
    term = next((t for t in found.terms if t.order == k), None)
    if term is not None:
        harmonic = ",".join(map(str, term.harmonic))
        largest = f"{term.size:.1e}: {term.mode}, ({harmonic}), {term.divisor:.1e}"
    sums = f"{first:.1e}, {second:.1e}"
    residual = f"{found.residuals[k]:.1e}"
    energy_error = f"{found.energy_errors[k]:.1e}"
    return [str(k), amplitude, change, sums, residual, energy_error, largest]
