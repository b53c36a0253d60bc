"""The verb actions: actions of a saved solution, and how its frequencies turn with them."""

from __future__ import annotations

from symfpu.action_angle.actions import actions as actions_of
from symfpu.action_angle.twist import is_refined, twist
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
from symfpu.reports.action_angle import actions_record, actions_text
from symfpu.store.saved_file import load


@app.command(epilog="Example: symfpu actions torus.symfpu --json")
def actions(file: FileArgument, as_json: JsonOption = False) -> None:
    """Actions I of a torus or breather, and the twist d omega / d I with its signature.

    Of a torus of a series, which is not refined, the actions alone: `symfpu refine` makes one.
    """
    solution = solution_of(load(path_named("FILE", file)), file)
    with progress_bar("twist") as advance:
        advance("twist", NO_FRACTION)
        found = twist(solution) if is_refined(solution) else None
    record = actions_record(solution, actions_of(solution), found)
    if as_json:
        print_json(record)
    else:
        say(actions_text(record))
