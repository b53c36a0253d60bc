"""A series and the verdict on it, for JSON and for the terminal."""

from __future__ import annotations

import math

from symfpu.results.text_tables import GAP, text_table
from symfpu.tori.verdict import Assessment

SHOWN_ORDERS = 10  # of the evidence, about


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
