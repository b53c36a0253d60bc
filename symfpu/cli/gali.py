"""The verb gali: alignment indices of the orbit of a saved torus, or of a state of your own."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Annotated, Any

import typer

from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.starts import (
    EnergyOption,
    OwnAlpha,
    OwnBeta,
    OwnBonds,
    OwnEnds,
    OwnPotential,
    PacketOption,
    RandomOption,
    Start,
    StartArgument,
    StateOption,
    start_of,
)
from symfpu.cli.terminal import (
    JsonOption,
    kept_run,
    number,
    optional,
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
)
from symfpu.cli.verbs import app
from symfpu.dynamics.alignment import (
    FRAMES,
    SAMPLES,
    SCHEME,
    STEP,
    VECTORS,
    AlignmentIndices,
    alignment_indices,
    seconds_needed,
)
from symfpu.dynamics.schemes import PARTICLE_SCHEMES
from symfpu.figures.alignment import draw_alignment
from symfpu.files.writing import output_folder


@app.command("gali", epilog="Example: symfpu gali torus.symfpu --time 1e6 -o out")
def gali(
    context: typer.Context,
    time: Annotated[
        str, typer.Option("--time", help="Length of the orbit, from 100 up.", metavar="T")
    ],
    file: StartArgument = None,
    state: StateOption = None,
    packet: PacketOption = None,
    random: RandomOption = None,
    energy: EnergyOption = None,
    bonds: OwnBonds = None,
    alpha: OwnAlpha = None,
    beta: OwnBeta = None,
    potential: OwnPotential = None,
    ends: OwnEnds = None,
    vectors: Annotated[
        str | None,
        typer.Option(
            help=f"Number of deviation vectors: GALI_2 to GALI_M; {VECTORS} if there are so many.",
            metavar="M",
        ),
    ] = None,
    step: Annotated[str, typer.Option(help="Step of the integrator.", metavar="H")] = str(
        STEP
    ),
    scheme: Annotated[
        str, choice("--scheme", tuple(PARTICLE_SCHEMES), "Integrator.")
    ] = SCHEME,
    samples: Annotated[
        str, typer.Option(help="Times at which the indices are kept.")
    ] = str(SAMPLES),
    seed: Annotated[str, typer.Option(help="Seed of the random deviation vectors.")] = "0",
    frames: Annotated[
        str, typer.Option(help="Number of frames of deviation vectors.", metavar="M")
    ] = str(FRAMES),
    output: Annotated[
        str | None,
        typer.Option(
            "-o", "--output", help="Folder for gali.csv and the pictures.", metavar="FOLDER"
        ),
    ] = None,
    checkpoint: Annotated[
        str | None,
        typer.Option(
            help="Keep the run in this file, and go on from it if it was killed.",
            metavar="FILE",
        ),
    ] = None,
    estimate: Annotated[
        bool,
        typer.Option(
            "--estimate", help="Only say how long it would take, from a trial of a second."
        ),
    ] = False,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Alignment indices of the orbit from a torus or a state, and the dimension they show.

    With the Lyapunov exponent of that orbit.
    """
    typed = {"N": bonds, "alpha": alpha, "beta": beta, "potential": potential, "ends": ends}
    states = {"state": state, "packet": packet, "random": random}
    start = start_of(file, typed, states, energy)
    picture = picture_named(plot)
    saved = file_named(kept_file)
    T = number("time", time)
    h = number("step", step)
    count = optional("vectors", vectors)
    many = whole("frames", frames)
    if estimate:
        seconds = seconds_needed(
            start.chain, T, vectors=count, step=h, scheme=scheme, frames=many
        )
        _print_estimate(seconds, as_json)
        return
    kept = None if checkpoint is None else path_named("checkpoint", checkpoint)
    folder = None if output is None else output_folder(path_named("output", output))
    with progress_bar("alignment indices", lambda: kept_run(kept)) as advance:
        found = alignment_indices(
            start.chain,
            start.Q,
            start.P,
            T,
            vectors=count,
            step=h,
            scheme=scheme,
            samples=whole("samples", samples),
            seed=whole("seed", seed),
            frames=many,
            file=kept,
            progress=advance,
        )
        if folder is not None:
            _write_table(found, folder / "gali.csv")
            draw_alignment(found, folder)
        keep(found, saved, context)
        draw(found.plot, picture)
    if as_json:
        print_json(_record(found, start))
    else:
        say("\n".join(_text(found, start)))
        if folder is not None:
            pictures = "gali.png, gali.pdf, gali-lyapunov.png, gali-lyapunov.pdf"
            print(f"written: {folder}: gali.csv, {pictures}")
        say_kept(saved)
        say_drawn(picture)


def _print_estimate(seconds: float, as_json: bool) -> None:
    if as_json:
        print_json({"kind": "gali", "seconds": float(f"{seconds:.2g}")})
    else:
        hours = f" ({seconds / 3600:.1f} hours)" if seconds > 3600 else ""
        print(f"about {seconds:.2g} seconds{hours} of one processor")


def _record(found: AlignmentIndices, start: Start) -> dict[str, Any]:
    """The result for JSON, and where it started."""
    seeds = None if start.torus is None else list(start.torus.seeds)
    return found.record() | {"seeds": seeds, "start": start.record}


def _text(found: AlignmentIndices, start: Start) -> list[str]:
    """The same for a reader."""
    dimension = found.dimension()
    value = "none" if dimension.value is None else str(dimension.value)
    if dimension.value is None and dimension.supported is not None:
        value = f"none, best supported {dimension.supported}"
    origin = "a state of your own"
    if start.torus is not None:
        origin = f"the torus has the seeds {', '.join(map(str, start.torus.seeds))}"
    end = f"log|v| / t at t = {found.times[-1]:.6g}"
    steps = f"steps of {found.step:g}"
    lines = [
        f"verdict: {dimension.verdict}",
        f"dimension          {value}   ({origin})",
        f"                   {dimension.reason}",
        f"by frame           {_by_frame(dimension.frames)}",
        f"Lyapunov exponent  {found.lyapunov[-1]:.3g}   ({end}; falls as log(t)/t on a torus)",
        f"energy error       {found.energy_error:.2g}   (relative, at the end; {steps})",
    ]
    for slope, index in zip(found.slopes(), found.log10_gali[-1], strict=True):
        fitted = f"slope {slope.value:8.3f} +- {slope.error:.3f}"
        lines.append(f"GALI_{slope.k:<3} {fitted}   log10 at the end {index:.4g}")
    return lines


def _by_frame(values: tuple[int | None, ...]) -> str:
    """The dimension of each frame, - for none."""
    return ", ".join("-" if value is None else str(value) for value in values)


def _write_table(found: AlignmentIndices, path: Path) -> None:
    """Time, log10 GALI_k and the Lyapunov estimate of every sample."""
    indices = [f"log10 GALI_{k}" for k in range(2, found.vectors + 1)]
    samples = zip(found.times, found.log10_gali, found.lyapunov, strict=True)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["t", *indices, "lyapunov"])
        for t, values, exponent in samples:
            writer.writerow([repr(float(v)) for v in (t, *values, exponent)])
