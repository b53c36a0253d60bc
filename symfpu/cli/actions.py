"""The verb actions: actions of a saved solution, and how its frequencies turn with them."""

from __future__ import annotations

from typing import Any

from symfpu.action_angle.actions import actions as actions_of
from symfpu.action_angle.twist import Twist, is_refined, twist
from symfpu.cli.chains import solution_of
from symfpu.cli.terminal import (
    FileArgument,
    JsonOption,
    path_named,
    print_json,
    progress_bar,
    say,
)
from symfpu.cli.verbs import app
from symfpu.files.progress import NO_FRACTION
from symfpu.results.field import exact_by_seed
from symfpu.results.numbers import number_text
from symfpu.store.saved_file import load
from symfpu.tori.torus import Torus

PLACES = 12  # digits of doubles in lines for a reader


@app.command(epilog="Example: symfpu actions torus.symfpu --json")
def actions(file: FileArgument, as_json: JsonOption = False) -> None:
    """Actions I of a torus or breather, and the twist d omega / d I with its signature.

    Of a torus of a series, which is not refined, the actions alone: `symfpu refine` makes one.
    """
    solution = solution_of(load(path_named("FILE", file)), file)
    with progress_bar("twist") as advance:
        advance("twist", NO_FRACTION)
        found = twist(solution) if is_refined(solution) else None
    record = _record(solution, actions_of(solution), found)
    if as_json:
        print_json(record)
    else:
        say(_text(record))


def _record(
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


def _text(record: dict[str, Any]) -> str:
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
