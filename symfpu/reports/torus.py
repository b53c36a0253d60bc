"""A torus and the verdict on its series, for JSON and for the terminal."""

from __future__ import annotations

import math
from typing import Any

from symfpu.numbers.typed import decimal
from symfpu.reports.tables import GAP, fifteen_digits, number_text, text_table
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment


def torus_record(torus: QTorus, assessment: Assessment | None = None) -> dict[str, Any]:
    """A torus for JSON: keys of the command line, numbers of more than 15 digits as strings."""
    series, digits = torus.series, torus.digits
    energies = {
        "energy": torus.energy(),
        "harmonic_energy": torus.harmonic_energies().sum(),
        "average_harmonic_energy": torus.average_spectrum().sum(),
    }
    judged = (
        {}
        if assessment is None
        else {"verdict": assessment.headline, "assessment": assessment.record()}
    )
    return {
        "N": series.chain.N,
        "alpha": decimal(series.chain.alpha),
        "beta": decimal(series.chain.beta),
        "seeds": list(series.seeds),
        "frequencies": {
            str(q): decimal(w) for q, w in zip(series.seeds, series.frequencies or (), strict=True)
        },
        "order": torus.order,
        "frequency_order": torus.frequency_order,
        "digits": digits,
        "guard_digits": None if digits is None else series.guard_digits,
        "amplitudes": {str(q): number_text(a, digits) for q, a in torus.amplitudes.items()},
        "certified": None if torus.certificate is None else torus.certificate.certified,
        "history": {
            str(k): [number_text(a, digits) for a in values] for k, values in torus.history.items()
        },
        **{name: number_text(value, digits) for name, value in energies.items()},
        "residual": fifteen_digits(torus.residual()),
        "root_residual": fifteen_digits(torus.root_residual),
        "smallest_divisors": [
            {
                "size": fifteen_digits(d.size),
                "mode": d.mode,
                "harmonic": list(d.harmonic),
                "order": d.order,
            }
            for d in series.smallest_divisors
        ],
        "warnings": list(torus.warnings),
        **judged,
    }


def assessment_text(found: Assessment, width: int | None = None) -> str:
    """The evidence of a verdict: reasons, radii, and a line for some of the orders (all are in the JSON).

    width : columns of the terminal, where the table is to fit into them.
    """
    lines = [f"  {reason}" for reason in found.reasons]
    poles = "no pole" if math.isinf(found.pole_radius) else f"{found.pole_radius:.3g}"
    lines.append(
        f"  radius of convergence in units of mu: {found.radius:.3g} by ratio of terms, {poles} by Pade poles of the frequencies (a hint)"
    )
    seed = next(iter(found.sums))
    errors = ("coarse residual", "energy error")
    largest = "largest term: mode, harmonic, divisor"
    head = ("order", f"A_{seed}(k)", "dA(k)", f"S_1, S_2 of Q_{seed}", *errors, largest)
    rows = [_order_line(found, seed, k) for k in _some(found)]
    table = text_table(head, rows, None if width is None else width - len(GAP))
    return "\n".join([*lines, *(GAP + line for line in table)])


def _some(found: Assessment) -> list[int]:
    """At most about a dozen orders: the first, the best, the last, and some between."""
    step = max(1, found.order // 10)
    return sorted({*range(0, found.order + 1, step), found.best_order, found.order})


def _order_line(found: Assessment, seed: int, k: int) -> tuple[str, ...]:
    first, second = (sums[k] for sums in found.sums[seed])
    term = next((t for t in found.terms if t.order == k), None)
    largest = (
        ""
        if term is None
        else f"{term.size:.1e}: {term.mode}, ({','.join(map(str, term.harmonic))}), {term.divisor:.1e}"
    )
    position = list(found.sums).index(seed)
    amplitude = f"{float(found.amplitudes[k][position]):.10g}" if k in found.amplitudes else ""
    change = f"{max(found.differences[k]):.1e}" if k in found.differences else ""
    sums, errors = (
        f"{first:.1e}, {second:.1e}",
        (f"{found.residuals[k]:.1e}", f"{found.energy_errors[k]:.1e}"),
    )
    return (str(k), amplitude, change, sums, *errors, largest)
