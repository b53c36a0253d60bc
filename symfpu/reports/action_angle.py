"""Actions and twist of a solution as records for JSON and as lines for a reader."""

from __future__ import annotations

from typing import Any

from symfpu.action_angle.twist import Twist
from symfpu.numbers.typed import decimal
from symfpu.reports.tables import fifteen_digits, number_text
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus

PLACES = 12  # digits of doubles in lines for a reader


def actions_record(
    solution: QuasiPeriodic | RingTorus, by_angle: dict[int, Any], found: Twist | None
) -> dict[str, Any]:
    """Keys of the command line; `twist` and what follows from it are there where it was found."""
    digits = solution.digits
    frequencies = zip(solution.seeds, solution.frequencies, strict=True)
    record = {
        "kind": type(solution).__name__,
        **solution.chain.typed,
        "seeds": list(solution.seeds),
        "digits": digits,
        "frequencies": {str(q): decimal(omega) for q, omega in frequencies},
        "actions": {str(q): number_text(x, digits) for q, x in by_angle.items()},
    }
    return record if found is None else record | _twist_record(found)


def _twist_record(found: Twist) -> dict[str, Any]:
    places = found.digits
    rows = [[number_text(x, places) for x in row] for row in found.matrix]
    return {
        "twist": rows,
        "twist_method": found.method,
        "asymmetry": fifteen_digits(found.asymmetry),
        "eigenvalues": [number_text(x, places) for x in found.eigenvalues],
        "signature": list(found.signature),
        "definiteness": found.definiteness,
        "determinant": number_text(found.determinant, places),
        "isoenergetic_determinant": number_text(found.isoenergetic_determinant, places),
    }


def actions_text(record: dict[str, Any]) -> str:
    """A record for a reader."""
    places = record["digits"] or PLACES
    lines = []
    for q, action in record["actions"].items():
        omega = _short(record["frequencies"][q], places)
        lines.append(f"mode {q:<4} I = {_short(action, places)}   omega = {omega}")
    if "twist" not in record:
        return "\n".join(lines)
    lines.append(
        f"twist d omega / d I ({record['twist_method']}): {record['definiteness']}"
    )
    rows = [[_short(x, places) for x in row] for row in record["twist"]]
    lines += ["  " + "  ".join(row) for row in rows]
    eigenvalues = ", ".join(_short(x, places) for x in record["eigenvalues"])
    lines.append(f"asymmetry          {record['asymmetry']:.2g}")
    lines.append(f"eigenvalues        {eigenvalues}")
    for key in ("determinant", "isoenergetic_determinant"):
        name = key.replace("_determinant", " det.")
        lines.append(f"{name:<18} {_short(record[key], places)}")
    return "\n".join(lines)


def _short(number: str, places: int) -> str:
    """A number as text, in no more digits than a reader wants."""
    return number if places > PLACES else f"{float(number):.{places}g}"
