"""Actions and twist of a solution as records for JSON and as lines for a reader."""

from __future__ import annotations

from typing import Any

from symfpu.action_angle.twist import Twist
from symfpu.results.field import exact_by_seed
from symfpu.results.numbers import number_text
from symfpu.tori.torus import Torus

PLACES = 12  # digits of doubles in lines for a reader


def actions_record(
    solution: Torus, by_angle: dict[int, Any], found: Twist | None
) -> dict[str, Any]:
    """What the verb prints: the twist with exact frequencies, or the actions alone."""
    frequencies = exact_by_seed(solution.omega)
    if found is not None:
        return found.record() | {"frequencies": frequencies}
    digits = solution.digits
    return {
        "kind": "actions",
        **solution.chain.typed,
        "seeds": list(solution.seeds),
        "frequencies": frequencies,
        "digits": digits,
        "actions": {str(q): number_text(x, digits) for q, x in by_angle.items()},
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
