"""The verb atlas: where tori end, by length, packet and order."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from symfpu.algebra.dense import available_cores
from symfpu.borders.atlas import atlas
from symfpu.borders.chaos import DRAWS, TIME
from symfpu.borders.column import BORDERS, REACH
from symfpu.borders.newton_end import MOST_HARMONICS
from symfpu.borders.point import AMPLITUDE, ENERGY, ESTIMATES
from symfpu.cli.chains import AlphaOption, BetaOption, PotentialOption, chain_of
from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    NOTHING_KEPT,
    JsonOption,
    number,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.writing import output_file
from symfpu.sweeps.this_process import ThisProcess

SHORTEST = "2"  # a chain of any law


@app.command(
    "atlas",
    epilog="Example: symfpu atlas --beta 1 --lengths 8,16,32 --packets low:1 --order 8",
)
def borders_of_tori(
    context: typer.Context,
    lengths: Annotated[
        str, typer.Option(help="Numbers of bonds, such as 8,16,32.", metavar="N,N,...")
    ],
    packets: Annotated[
        str,
        typer.Option(
            help="Seed sets, such as 'low:1 high:1/16 1,2': low, middle or high with "
            "a number of modes or a part of N, or modes.",
            metavar="'P P ...'",
        ),
    ],
    order: Annotated[
        str, typer.Option(help="Order of the series, or several.", metavar="K,K,...")
    ],
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    borders: Annotated[
        str,
        typer.Option(help=f"Of {', '.join(BORDERS)}.", metavar="B,B,..."),
    ] = ",".join(ESTIMATES),
    places: Annotated[
        str | None,
        typer.Option(help="Energies H at which points are wanted, too.", metavar="E,E,..."),
    ] = None,
    per_particle: Annotated[
        bool, typer.Option("--per-particle", help="With --places: they are H/N.")
    ] = False,
    by: Annotated[
        str,
        choice(
            "--by", (ENERGY, AMPLITUDE), "What seeds have in equal parts on the way up."
        ),
    ] = ENERGY,
    most_harmonics: Annotated[
        str, typer.Option(help="Of a torus of Newton's method, at most.", metavar="M")
    ] = str(MOST_HARMONICS),
    reach: Annotated[
        str,
        typer.Option(
            help="Newton's tori: up to so many times the series' last place.", metavar="X"
        ),
    ] = f"{REACH:g}",
    time: Annotated[
        str, typer.Option(help="By which chaos is to be seen in an orbit.", metavar="T")
    ] = f"{TIME:g}",
    draws: Annotated[
        str,
        typer.Option(help="Of random phases, for the orbits of chaos.", metavar="D"),
    ] = str(DRAWS),
    file: Annotated[
        str | None,
        typer.Option(
            help="Keep every column as it comes; an interrupted run goes on from it.",
            metavar="FILE",
        ),
    ] = None,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Where q-tori end as their energy grows, by chain and packet, and the power laws in N."""
    chain_of(SHORTEST, alpha, beta, potential)
    law = {"alpha": alpha, "beta": beta, "potential": potential}
    given = {name: value for name, value in law.items() if value is not None}
    picture = picture_named(plot)
    saved = file_named(kept_file)
    log = _log(file)
    chains = [{"N": N} | given for N in _several("lengths", lengths)]
    seed_sets, orders = packets.split(), _several("order", order)
    alone = len(chains) * len(seed_sets) * len(orders) == 1 or available_cores() == 1
    with progress_bar("columns", lambda: _kept(log)) as advance:
        found = atlas(
            chains,
            seed_sets,
            orders,
            borders=borders.split(","),
            places=[] if places is None else places.split(","),
            by=by,
            per_particle=per_particle,
            most_harmonics=whole("most-harmonics", most_harmonics),
            reach=number("reach", reach),
            time=number("time", time),
            draws=whole("draws", draws),
            executor=ThisProcess() if alone else None,
            file=log,
            retry=True,
            progress=advance,
        )
        keep(found, saved, context)
        draw(found.plot, picture)
    if as_json:
        print_json(found.record())
    else:
        say(found.text())
        say_kept(saved)
        say_drawn(picture)
    raise typer.Exit(1 if found.rows.failures else 0)


def _several(argument: str, text: str) -> list[int]:
    """Whole numbers, at least one."""
    found = whole_numbers(argument, text)
    if not found:
        raise InputError(argument, text, "at least one whole number", "such as 8,16,32")
    return found


def _log(file: str | None) -> Path | None:
    if file is None:
        return None
    return output_file(path_named("file", file), "file", "choose another with --file")


def _kept(log: Path | None) -> str:
    """What stands of an atlas that was interrupted."""
    if log is None or not log.exists():
        return NOTHING_KEPT
    return f"columns so far are kept in {log}; the same command goes on from them"
