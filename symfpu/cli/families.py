"""Verbs beyond the series: refine, family."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.cli.chains import (
    AlphaOption,
    BetaOption,
    BondsOption,
    EndsOption,
    PotentialOption,
    chain_of,
    solution_of,
)
from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, output_named, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    NOTHING_KEPT,
    DigitsOption,
    FileArgument,
    HarmonicOption,
    JsonOption,
    SeedsOption,
    SolutionOption,
    by_seed,
    number,
    optional,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
    whole_numbers,
)
from symfpu.cli.tori import verdict_of
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.families.following import METHODS, family
from symfpu.families.normal_events import RESONANCE_LENGTH
from symfpu.families.table import family_table
from symfpu.figures.family import draw_family
from symfpu.files.writing import output_folder, write_rows
from symfpu.numbers.counted import counted
from symfpu.refinement.harmonics import MOST_HARMONICS
from symfpu.refinement.tori import refine
from symfpu.store.saved_file import load, save
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Torus

ResonanceOption = Annotated[
    str,
    typer.Option(help="With --normal: largest sum |nu_i| of resonances.", metavar="K"),
]


@app.command("refine", epilog="Example: symfpu refine torus.symfpu -o refined.symfpu")
def refine_file(
    context: typer.Context,
    file: FileArgument,
    output: SolutionOption = None,
    frequencies: Annotated[
        str | None,
        typer.Option(
            help="The torus of these frequencies, one for each seed.", metavar="W,W,..."
        ),
    ] = None,
    amplitudes: Annotated[
        str | None,
        typer.Option(
            help="The torus of these amplitudes, one for each seed.", metavar="A,A,..."
        ),
    ] = None,
    energy: Annotated[
        str | None,
        typer.Option(
            help="The torus of this energy H, amplitudes in the same ratio.", metavar="E"
        ),
    ] = None,
    harmonic: HarmonicOption = False,
    start: Annotated[
        str | None,
        typer.Option(
            help="The torus whose seeds have these coordinates at t = 0.", metavar="Q,Q,..."
        ),
    ] = None,
    digits: DigitsOption = None,
    checkpoint: Annotated[
        str | None,
        typer.Option(
            "--checkpoint",
            help="With --digits: keep the run in this file; the same command goes on from it.",
            metavar="FILE",
        ),
    ] = None,
    tolerance: Annotated[
        str,
        typer.Option(
            help="Relative residual of the equations of motion to be reached.", metavar="X"
        ),
    ] = "1e-13",
    most_harmonics: Annotated[
        int,
        typer.Option(
            help="Harmonics that may be taken; memory grows with them.", metavar="H"
        ),
    ] = MOST_HARMONICS,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """The torus that solves the equations of motion, by Newton's method.

    It has the same frequencies, or given frequencies, amplitudes, energy or start.
    """
    places = optional("digits", digits)
    torus = solution_of(load(path_named("FILE", file)), file)
    picture = picture_named(plot)
    if checkpoint is not None and places is None:
        raise InputError("checkpoint", checkpoint, "one with --digits", "leave it out")
    run = None if checkpoint is None else path_named("checkpoint", checkpoint)
    kept = output_named(output)
    if harmonic and energy is None:
        raise InputError("harmonic", True, "none without --energy", "give --energy E, too")
    given: dict[str, Any] = {
        "frequencies": by_seed_or_none("frequencies", frequencies, torus.seeds),
        "amplitudes": by_seed_or_none("amplitudes", amplitudes, torus.seeds),
        "energy": None if energy is None else Energy(energy, harmonic=harmonic),
        "start": by_seed_or_none("start", start, torus.seeds),
        "digits": places,
        "file": run,
        "tolerance": number("tolerance", tolerance),
        "most_harmonics": most_harmonics,
    }
    with progress_bar("Newton's method") as advance:
        refined: Torus = refine(torus, **given, progress=advance)
        if kept:
            command = shlex.join(["symfpu", *context.obj])
            save(kept, refined, verdict=verdict_of(refined), command=command)
        draw(refined.plot, picture)
    if as_json:
        print_json(refined.record())
    else:
        say(refined.text())
        if kept:
            print(f"written: {kept}")
        say_drawn(picture)


def by_seed_or_none(
    argument: str, text: str | None, seeds: tuple[int, ...]
) -> dict[int, str] | None:
    """Numbers by seed, or None where the option is not given."""
    return None if text is None else by_seed(argument, text, seeds)


@app.command(
    "family",
    epilog="Example: symfpu family -N 32 --alpha 0.33 --seeds 1 --to-energy 0.05 -o out",
)
def follow_family(
    context: typer.Context,
    bonds: BondsOption,
    seeds: SeedsOption,
    to_energy: Annotated[
        str, typer.Option(help="Energy H up to which the family is followed.", metavar="E")
    ],
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    ends: EndsOption = "fixed",
    harmonic: Annotated[
        bool,
        typer.Option(
            "--harmonic", help="Energies are the harmonic energy sum E_q instead of H."
        ),
    ] = False,
    amplitude_ratio: Annotated[
        str | None,
        typer.Option(help="Ratio of the amplitudes, such as 1,0.5.", metavar="R,R,..."),
    ] = None,
    energy_ratio: Annotated[
        str | None,
        typer.Option(
            help="Ratio of the averaged mode energies.  Default: equal.", metavar="R,R,..."
        ),
    ] = None,
    from_energy: Annotated[
        str | None,
        typer.Option(
            help="Energy where it begins.  Default: near the linear limit.", metavar="E"
        ),
    ] = None,
    members: Annotated[str, typer.Option(help="The most members.", metavar="M")] = "200",
    multipliers: Annotated[
        bool, typer.Option("--multipliers", help="Floquet multipliers (one seed).")
    ] = False,
    normal: Annotated[
        bool,
        typer.Option(
            "--normal",
            help="Normal frequencies of every member, and where they collide or resonate.",
        ),
    ] = False,
    resonance_length: ResonanceOption = str(RESONANCE_LENGTH),
    method: Annotated[
        str, choice("--method", tuple(METHODS), "How it is followed.")
    ] = "arclength",
    order: Annotated[
        str | None, typer.Option(help="With appendix-a: order of the series.", metavar="K")
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Folder for members, table and pictures; an interrupted family goes on from it.",
            metavar="FOLDER",
        ),
    ] = None,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """A family of tori from small energy on, past folds and past the end of its series."""
    chain = chain_of(bonds, alpha, beta, potential, ends)
    chosen = tuple(whole_numbers("seeds", seeds))
    picture = picture_named(plot)
    saved = file_named(kept_file)
    folder = None if output is None else output_folder(path_named("output", output))
    with progress_bar("first member", lambda: _kept(folder)) as advance:
        found = family(
            chain,
            chosen,
            to_energy,
            harmonic=harmonic,
            amplitude_ratio=by_seed_or_none("amplitude-ratio", amplitude_ratio, chosen),
            energy_ratio=by_seed_or_none("energy-ratio", energy_ratio, chosen),
            from_energy=from_energy,
            members=whole("members", members),
            multipliers=multipliers,
            normal=normal,
            resonance_length=whole("resonance-length", resonance_length),
            method=method,
            order=optional("order", order),
            folder=folder,
            progress=advance,
        )
        pictures = [] if folder is None else draw_family(found, folder)
        if folder is not None:
            write_rows(folder / "family.csv", family_table(found))
        keep(found, saved, context)
        draw(found.plot, picture)
    if as_json:
        print_json(found.record())
    else:
        say(found.text())
        if folder is not None:
            counts = f"{counted(len(found.members), 'member')}, {counted(len(pictures), 'picture')}"
            print(f"written: {folder}: family.csv, {counts}")
        say_kept(saved)
        say_drawn(picture)
    raise typer.Exit(0 if found.ending.startswith("reached") else 1)


def _kept(folder: Path | None) -> str:
    """What stands of a family that was interrupted."""
    if folder is None or not any(folder.iterdir()):
        return NOTHING_KEPT
    return f"members found so far are kept in {folder}; the same command goes on from them"
