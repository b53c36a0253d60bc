"""The verb orbit: from a saved torus, or from a state of your own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, BinaryIO

import numpy as np
import typer
from numpy.typing import NDArray

from symfpu.cli.choices import choice
from symfpu.cli.keeping import SaveOption, file_named, keep, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.runs import (
    CheckpointOption,
    SamplesOption,
    StepOption,
    TimeOption,
    kept_run,
)
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
    path_named,
    print_json,
    progress_bar,
    say,
    whole,
)
from symfpu.cli.verbs import app
from symfpu.dynamics.orbits import Orbit, integrate
from symfpu.dynamics.schemes import SCHEMES
from symfpu.errors import InputError
from symfpu.files.writing import output_file, write_file, write_rows
from symfpu.results.numbers import fifteen_digits
from symfpu.results.text_tables import text_table
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
LOST_ENERGY = 1e-3  # relative
SHOWN_MODES = 8  # those of the largest average harmonic energy


@app.command(epilog="Example: symfpu orbit torus.symfpu --time 1e5 -o orbit.csv")
def orbit(
    context: typer.Context,
    time: TimeOption,
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
    step: StepOption = "0.2",
    scheme: Annotated[str, choice("--scheme", tuple(SCHEMES), "Integrator.")] = "kahan_li8",
    samples: SamplesOption = "200",
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="t, H and E_q of the samples as .csv, or with Q and P as .npz.",
            metavar="FILE",
        ),
    ] = None,
    checkpoint: CheckpointOption = None,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Integrates the orbit from a saved torus, or from a state of your own.

    It says how far the orbit stays from its torus.
    """
    target = None if output is None else _output(path_named("output", output))
    picture = picture_named(plot)
    saved = file_named(kept_file)
    kept = None if checkpoint is None else path_named("checkpoint", checkpoint)
    T = number("time", time)
    h = number("step", step)
    count = whole("samples", samples)
    typed = {"N": bonds, "alpha": alpha, "beta": beta, "potential": potential, "ends": ends}
    states = {"state": state, "packet": packet, "random": random}
    start = start_of(file, typed, states, energy)
    with progress_bar("orbit", lambda: kept_run(kept)) as advance:
        made = integrate(
            start.chain,
            start.Q,
            start.P,
            T,
            step=h,
            scheme=scheme,
            samples=count,
            averages=True,
            file=kept,
            progress=advance,
        )
        if target is not None:
            _write(target, made)
        keep(made, saved, context)
        draw(made.plot, picture)
    record = _record(made, start)
    if as_json:
        print_json(record)
        return
    say(made)
    _print(record)
    if target is not None:
        print(f"written: {target}")
    say_kept(saved)
    say_drawn(picture)


def _output(path: Path) -> Path:
    if path.suffix not in (".csv", ".npz"):
        raise InputError(
            "output",
            str(path),
            "a name that ends in .csv or .npz",
            "choose another with -o",
        )
    return output_file(path)


def _record(made: Orbit, start: Start) -> dict[str, Any]:
    """What the verb prints; what compares with a torus is null where there is none."""
    return made.record() | {"start": start.record} | _comparison(made, start.torus)


def _comparison(made: Orbit, torus: Torus | None) -> dict[str, Any]:
    """Deviations relative to the largest coordinate of the torus at the samples."""
    names = "largest_deviation", "largest_deviation_time", "torus_average_spectrum"
    if torus is None:
        return dict.fromkeys(names)
    there = torus.Q(made.times)
    largest = np.max(np.abs(there))
    distances = np.max(np.abs(made.Q - there), axis=1) / largest
    worst = int(np.argmax(distances))
    expected = [fifteen_digits(value) for value in torus.average_spectrum()]
    found = fifteen_digits(distances[worst]), fifteen_digits(made.times[worst]), expected
    return dict(zip(names, found, strict=True))


def _print(record: dict[str, Any]) -> None:
    energy_error = record["energy_error"]
    say(f"energy error       {energy_error:.3g}   (largest |H(t)/H(0) - 1| of the samples)")
    expected = record["torus_average_spectrum"]
    if expected is not None:
        deviation = f"{record['largest_deviation']:.3g}"
        when = f"largest at t = {record['largest_deviation_time']:.10g}"
        say(
            f"off the torus      {deviation}   ({when}, relative to the largest coordinate)"
        )
    if energy_error > LOST_ENERGY:
        say("the energy is lost: this is no orbit of the chain, take a shorter step")
    head = ["mode", "time average of E_q"]
    head += [] if expected is None else ["on the torus, for ever"]
    say("\n".join(text_table(head, _rows(record))))


def _rows(record: dict[str, Any]) -> list[list[str]]:
    """The modes of the largest average harmonic energy."""
    average = record["average_spectrum"]
    columns = [average]
    if record["torus_average_spectrum"] is not None:
        columns.append(record["torus_average_spectrum"])
    modes = record.get("modes", range(1, record["N"]))
    by_energy = sorted(range(len(average)), key=lambda place: -average[place])
    rows = []
    for place in by_energy[:SHOWN_MODES]:
        numbers = [f"{column[place]:.6g}" for column in columns]
        rows.append([str(modes[place]), *numbers])
    return rows


def _write(path: Path, made: Orbit) -> None:
    """The samples: t, H and E_q, and in .npz also Q and P."""
    spectrum = made.harmonic_energies()
    if path.suffix == ".csv":
        write_rows(path, _table(made, spectrum))
        return

    def write(stream: BinaryIO) -> None:
        np.savez(stream, t=made.times, Q=made.Q, P=made.P, H=made.energies, E=spectrum)

    write_file(path, write)


def _table(made: Orbit, spectrum: Floats) -> Iterator[list[str]]:
    """A head, then t, H and E_q of each sample."""
    yield ["t", "H", *(f"E{q}" for q in made.chain.mode_numbers)]
    for t, H, E in zip(made.times, made.energies, spectrum, strict=True):
        yield [repr(float(v)) for v in (t, H, *E)]
