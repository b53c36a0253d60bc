"""The verb stability: normal frequencies of a saved torus or breather."""

from __future__ import annotations

from typing import Annotated

import typer

from symfpu.bundles.bundle import load
from symfpu.chain.chain import require_fixed_ends
from symfpu.cli.chains import solution_of
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    FileArgument,
    JsonOption,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.verbs import app
from symfpu.normal.search import LENGTH, normal_modes
from symfpu.reports.normal import normal_record, normal_text
from symfpu.tori.quasiperiodic import QuasiPeriodic


@app.command("stability", epilog="Example: symfpu stability refined.symfpu")
def stability(
    file: FileArgument,
    modes: Annotated[
        str | None, typer.Option(help="Only these modes.  Default: all.", metavar="Q,Q,...")
    ] = None,
    resonance_length: Annotated[
        str,
        typer.Option(help="Largest sum |nu_i| of the resonances listed.", metavar="K"),
    ] = str(LENGTH),
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Normal frequencies of a refined torus or breather: is it stable, what is it near?"""
    torus = solution_of(load(path_named("FILE", file)), file)
    require_fixed_ends(torus.chain)
    assert isinstance(torus, QuasiPeriodic)
    chosen = None if modes is None else whole_numbers("modes", modes)
    length = whole("resonance-length", resonance_length)
    picture = picture_named(plot)
    with progress_bar("normal modes") as advance:
        found = normal_modes(torus, modes=chosen, resonance_length=length, progress=advance)
        draw(found.plot, picture)
    if as_json:
        print_json(normal_record(found))
        return
    say(normal_text(found))
    say_drawn(picture)
