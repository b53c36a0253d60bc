"""The verb stability: normal frequencies of a saved torus or breather, and along a line from it."""

from __future__ import annotations

from typing import Annotated

import typer

from symfpu.cli.chains import solution_of
from symfpu.cli.keeping import SaveOption, file_named, keep, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    NOTHING_KEPT,
    FileArgument,
    JsonOption,
    by_seed,
    optional,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.families.normal_events import RESONANCE_LENGTH
from symfpu.families.normal_family import NormalFamily, normal_family
from symfpu.files.writing import output_folder
from symfpu.normal.by_series import (
    BySeries,
    by_series,
    series_records,
    series_text,
)
from symfpu.normal.modes import NormalModes
from symfpu.normal.search import normal_modes
from symfpu.normal.self_consistent import solve_normal_frequency
from symfpu.normal.torus import LENGTH
from symfpu.store.saved_file import load
from symfpu.tori.torus import Torus

MEMBERS = 9
TO_AMPLITUDES = "to-amplitudes"


@app.command("stability", epilog="Example: symfpu stability refined.symfpu")
def stability(
    context: typer.Context,
    file: FileArgument,
    modes: Annotated[
        str | None, typer.Option(help="Only these modes.  Default: all.", metavar="Q,Q,...")
    ] = None,
    resonance_length: Annotated[
        str | None,
        typer.Option(
            help=f"Largest sum |nu_i| of resonances.  Default: {LENGTH} in the list, "
            f"{RESONANCE_LENGTH} as events on a line.",
            metavar="K",
        ),
    ] = None,
    series: Annotated[
        str | None,
        typer.Option(help="Beside them those by series of this order.", metavar="K"),
    ] = None,
    to_amplitudes: Annotated[
        str | None,
        typer.Option(
            help="Also along the line of tori to these amplitudes, with events.",
            metavar="A,A,...",
        ),
    ] = None,
    members: Annotated[
        str | None,
        typer.Option(
            help=f"With --to-amplitudes: number of tori.  Default: {MEMBERS}.", metavar="M"
        ),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="With --to-amplitudes: folder of the tori; the same command goes on from it.",
            metavar="FOLDER",
        ),
    ] = None,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Normal frequencies of a refined torus or breather: is it stable, what is it near?

    With --to-amplitudes A,A also of the tori on the way to these amplitudes, and where one of them
    becomes unstable: symfpu stability refined.symfpu --to-amplitudes 0.1,0.5 --members 5.
    """
    torus = solution_of(load(path_named("FILE", file)), file)
    chosen = None if modes is None else whole_numbers("modes", modes)
    length = optional("resonance-length", resonance_length)
    order = optional("series", series)
    picture, saved = picture_named(plot), file_named(kept_file)
    found: NormalModes | NormalFamily
    if to_amplitudes is not None:
        _refuse("series", series, "only without --to-amplitudes")
        found = _line(torus, to_amplitudes, members, chosen, length, output)
        records: list[BySeries] = []
    else:
        _refuse("members", members, f"a number only with --{TO_AMPLITUDES}")
        _refuse(
            "output", output, f"a folder only with --{TO_AMPLITUDES}; --save keeps this"
        )
        found, records = _modes(torus, chosen, LENGTH if length is None else length, order)
    keep(found, saved, context)
    draw(found.plot, picture)
    if as_json:
        print_json(found.record() | series_records(records))
        return
    say("\n".join([found.text(), *series_text(records)]))
    say_kept(saved)
    say_drawn(picture)


def _refuse(option: str, given: str | None, allowed: str) -> None:
    """InputError for an option that says nothing here."""
    if given is not None:
        raise InputError(option, given, allowed, "leave it out")


def _modes(
    torus: Torus, chosen: list[int] | None, length: int, order: int | None
) -> tuple[NormalModes, list[BySeries]]:
    """Normal modes, and those by series if an order is given."""
    with progress_bar("normal modes") as advance:
        found = normal_modes(torus, modes=chosen, resonance_length=length, progress=advance)
        if order is None:
            return found, []
        records = [
            by_series(
                mode,
                lambda q: solve_normal_frequency(torus, q, order, progress=advance),
                torus,
            )
            for mode in found.modes
        ]
    return found, records


def _line(
    torus: Torus,
    amplitudes: str,
    members: str | None,
    chosen: list[int] | None,
    length: int | None,
    output: str | None,
) -> NormalFamily:
    """The line from a torus to other amplitudes."""
    end = by_seed(TO_AMPLITUDES, amplitudes, torus.seeds)
    folder = None if output is None else output_folder(path_named("output", output))
    note = f"tori found so far are kept in {folder}; the same command goes on from them"

    def kept() -> str:
        return NOTHING_KEPT if folder is None or not any(folder.iterdir()) else note

    with progress_bar("first torus", kept) as advance:
        return normal_family(
            torus,
            end,
            members=MEMBERS if members is None else whole("members", members),
            modes=chosen,
            resonance_length=RESONANCE_LENGTH if length is None else length,
            folder=folder,
            progress=advance,
        )
