"""The verb gali: alignment indices of the orbit of a saved torus, or of a state of your own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer

from symfpu.action_angle.foretold import ForetoldIndices, flow_of, indices_by, settled_text
from symfpu.action_angle.linear_flow import LinearFlow
from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.runs import CheckpointOption, SamplesOption, StepOption, kept_run
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
from symfpu.errors import InputError
from symfpu.figures.alignment import draw_alignment
from symfpu.files.writing import output_folder, write_rows
from symfpu.normal.search import normal_modes
from symfpu.normal.torus import checked_modes
from symfpu.plots.indices import foretold as draw_foretold
from symfpu.results.numbers import fifteen_digits
from symfpu.tori.torus import Torus


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
    step: StepOption = str(STEP),
    scheme: Annotated[
        str, choice("--scheme", tuple(PARTICLE_SCHEMES), "Integrator.")
    ] = SCHEME,
    samples: SamplesOption = str(SAMPLES),
    seed: Annotated[
        str, typer.Option(help="Seed of the random deviation vectors.", metavar="SEED")
    ] = "0",
    frames: Annotated[
        str, typer.Option(help="Number of frames of deviation vectors.", metavar="M")
    ] = str(FRAMES),
    output: Annotated[
        str | None,
        typer.Option(
            "-o", "--output", help="Folder for gali.csv and the pictures.", metavar="FOLDER"
        ),
    ] = None,
    checkpoint: CheckpointOption = None,
    estimate: Annotated[
        bool,
        typer.Option(
            "--estimate", help="Only say how long it would take, from a trial of a second."
        ),
    ] = False,
    foretold: Annotated[
        bool,
        typer.Option(
            "--foretold",
            help="Beside them those of the torus in closed form; FILE has to be refined.",
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
    drawn = whole("seed", seed)
    forecast = _forecast(start) if foretold else None
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
            seed=drawn,
            frames=many,
            file=kept,
            progress=advance,
        )
        closed = forecast.of(found, drawn) if forecast else None
        if folder is not None:
            _write_table(found, folder / "gali.csv", closed)
            draw_alignment(found, folder)
        keep(found, saved, context)
        draw(_plot(found, closed), picture)
    if as_json:
        print_json(_record(found, start) | _foretold_record(found, closed))
    else:
        say("\n".join([*_text(found, start), *_foretold_text(found, closed)]))
        if folder is not None:
            pictures = "gali.png, gali.pdf, gali-lyapunov.png, gali-lyapunov.pdf"
            print(f"written: {folder}: gali.csv, {pictures}")
        say_kept(saved)
        say_drawn(picture)


class _Forecast(NamedTuple):
    """The linearised flow about a torus: what foretells its indices."""

    torus: Torus
    flow: LinearFlow

    def of(self, found: AlignmentIndices, seed: int) -> ForetoldIndices:
        """The indices of the first frame at the times of those integrated."""
        return indices_by(self.flow, self.torus, found.times, found.vectors, seed)


def _forecast(start: Start) -> _Forecast:
    """Of the torus of a file; InputError for other starts, and for a torus not refined."""
    torus = start.torus
    if torus is None:
        allowed = "only for a FILE with a torus"
        raise InputError("foretold", True, allowed, "leave --foretold out")
    with progress_bar("normal modes") as advance:
        every = checked_modes(torus, None)
        normal = normal_modes(torus, modes=every, progress=advance)
        return _Forecast(torus, flow_of(torus, normal))


def _plot(found: AlignmentIndices, closed: ForetoldIndices | None) -> Callable[..., object]:
    """Indices, or those in closed form with the integrated ones on them."""
    if closed is None:
        return found.plot
    return partial(draw_foretold, closed, observed=found)


def _apart(found: AlignmentIndices, closed: ForetoldIndices) -> float:
    """The largest difference of log10 GALI_k, of the first frame."""
    return float(np.abs(found.log10_gali - closed.log10_gali).max())


def _foretold_record(
    found: AlignmentIndices, closed: ForetoldIndices | None
) -> dict[str, Any]:
    """What the torus foretells, for JSON; nothing where it was not asked for."""
    if closed is None:
        return {}
    settled = closed.settling().items()
    return {
        "foretold": {
            "verdict": closed.verdict,
            "slopes": {str(s.k): fifteen_digits(s.value) for s in closed.slopes()},
            "asymptotic_slopes": {str(k): n for k, n in closed.asymptotic_slopes.items()},
            "settled": {str(k): repr(t) if isfinite(t) else None for k, t in settled},
            "largest_difference": fifteen_digits(_apart(found, closed)),
        }
    }


def _foretold_text(found: AlignmentIndices, closed: ForetoldIndices | None) -> list[str]:
    """The same for a reader."""
    if closed is None:
        return []
    apart = f"log10 GALI_k of frame 1 differ by up to {_apart(found, closed):.2g}"
    lines = [f"foretold           {closed.verdict}   ({apart})"]
    settled = closed.settling()
    for slope in closed.slopes():
        due = f"on the torus {closed.asymptotic_slopes[slope.k]}"
        since = settled_text(settled[slope.k], closed.times[-1])
        lines.append(f"GALI_{slope.k:<3} slope {slope.value:8.3f}   {due}, {since}")
    return lines


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


def _write_table(
    found: AlignmentIndices, path: Path, closed: ForetoldIndices | None
) -> None:
    """Time, log10 GALI_k, the Lyapunov estimate and what is foretold, of every sample."""
    indices = [f"log10 GALI_{k}" for k in range(2, found.vectors + 1)]
    due = [] if closed is None else [f"foretold {name}" for name in indices]
    columns = (found.times, found.log10_gali, found.lyapunov)
    nothing = np.empty((len(found.times), 0))
    ours = nothing if closed is None else closed.log10_gali
    samples = zip(*columns, ours, strict=True)
    rows = [
        [repr(float(v)) for v in (t, *values, exponent, *told)]
        for t, values, exponent, told in samples
    ]
    write_rows(path, [["t", *indices, "lyapunov", *due], *rows])
