"""The verb breather: the periodic orbit of one seed, by frequency, amplitude or energy."""

from __future__ import annotations

import shlex
import warnings
from typing import Annotated, Any

import typer

from symfpu.breathers.floquet import floquet
from symfpu.cli.chains import (
    AlphaOption,
    BetaOption,
    BondsOption,
    EndsOption,
    PotentialOption,
    chain_of,
)
from symfpu.cli.keeping import output_named
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    DigitsOption,
    JsonOption,
    SolutionOption,
    one_of,
    optional,
    print_json,
    progress_bar,
    say,
    whole,
)
from symfpu.cli.verbs import app
from symfpu.files.progress import NO_FRACTION
from symfpu.reports.solution import solution_record, solution_text
from symfpu.solutions.torus import torus
from symfpu.store.saved_file import save
from symfpu.tori.torus import Torus


@app.command(epilog="Example: symfpu breather -N 32 --alpha 0.33 --seed 1 --energy 0.01")
def breather(
    context: typer.Context,
    bonds: BondsOption,
    seed: Annotated[str, typer.Option("--seed", help="Seed mode.", metavar="Q")],
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    ends: EndsOption = "fixed",
    omega: Annotated[
        str | None, typer.Option(help="The breather of this frequency.", metavar="W")
    ] = None,
    amplitude: Annotated[
        str | None, typer.Option(help="The one of this amplitude.", metavar="A")
    ] = None,
    energy: Annotated[
        str | None, typer.Option(help="The one of this energy H.", metavar="E")
    ] = None,
    digits: DigitsOption = None,
    multipliers: Annotated[
        bool, typer.Option("--multipliers", help="Floquet multipliers.")
    ] = False,
    output: SolutionOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """A q-breather, found from exactly one of --omega, --amplitude and --energy.

    On a ring the travelling wave of one seed.
    """
    chain = chain_of(bonds, alpha, beta, potential, ends)
    mode, places = whole("seed", seed), optional("digits", digits)
    one_of({"omega": omega, "amplitude": amplitude, "energy": energy})
    file = output_named(output)
    picture = picture_named(plot)
    wish: dict[str, Any] = {
        "frequencies": None if omega is None else (omega,),
        "amplitudes": None if amplitude is None else {mode: amplitude},
        "energy": energy,
    }
    with progress_bar("Newton's method") as advance:
        with warnings.catch_warnings(record=True) as several:
            warnings.simplefilter("always", UserWarning)
            orbit: Torus = torus(chain, (mode,), **wish, digits=places, progress=advance)
        doubts = tuple(str(w.message) for w in several if w.category is UserWarning)
        advance("multipliers" if multipliers else "energies", NO_FRACTION)
        stability = floquet(orbit) if multipliers else None
        if file:
            verdict = {"verdict": "periodic orbit", "reasons": list(doubts)}
            save(file, orbit, verdict=verdict, command=shlex.join(["symfpu", *context.obj]))
        draw(orbit.plot, picture)
    record = solution_record(orbit, found=stability, warnings=doubts)
    if as_json:
        print_json(record)
        return
    say(solution_text(record))
    if file:
        print(f"written: {file}")
    say_drawn(picture)
