"""Verbs of motion: the orbit that starts on a saved torus."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from numpy.typing import NDArray

from symfpu.bundles.bundle import load
from symfpu.cli.chains import solution_of
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    FileArgument,
    JsonOption,
    kept_run,
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
from symfpu.files.writing import output_file, write_text
from symfpu.numbers.arithmetic import Numbers
from symfpu.reports.tables import fifteen_digits
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus

Floats = NDArray[np.float64]
LOST_ENERGY = 1e-3  # relative
SHOWN_MODES = 8  # those of the largest average harmonic energy


@app.command(epilog="Example: symfpu orbit torus.symfpu --time 1e5 -o orbit.csv")
def orbit(
    file: FileArgument,
    time: Annotated[
        str, typer.Option("--time", help="How long to follow it, such as 1e6.", metavar="T")
    ],
    step: Annotated[str, typer.Option(help="Length of a step.", metavar="H")] = "0.2",
    scheme: Annotated[
        str, typer.Option(help=f"{', '.join(SCHEMES)}.", metavar="SCHEME")
    ] = "kahan_li8",
    samples: Annotated[
        str, typer.Option(help="How many times to look, log-spaced.", metavar="S")
    ] = "200",
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="t, H and E_q of the samples as .csv, or with Q and P as .npz.",
            metavar="FILE",
        ),
    ] = None,
    checkpoint: Annotated[
        str | None,
        typer.Option(
            help="Keep the run in this file, and go on from it if it was killed.",
            metavar="FILE",
        ),
    ] = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Integrates the orbit of a torus from t = 0 on, and says how far it stays from the torus."""
    target = None if output is None else _output(path_named("output", output))
    picture = picture_named(plot)
    kept = None if checkpoint is None else path_named("checkpoint", checkpoint)
    T = number("time", time)
    h = number("step", step)
    count = whole("samples", samples)
    torus = solution_of(load(path_named("FILE", file)), file)
    exact = torus if isinstance(torus, RingTorus) else torus.in_doubles()
    Q, P = exact.state()
    with progress_bar("orbit", lambda: kept_run(kept)) as advance:
        made = integrate(
            exact.chain,
            Q,
            P,
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
        draw(made.plot, picture)
    record = _record(made, exact)
    if as_json:
        print_json(record)
        return
    say(made)
    _print(record)
    if target is not None:
        print(f"written: {target}")
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


def _record(made: Orbit, torus: QuasiPeriodic | RingTorus) -> dict[str, Any]:
    """What the verb prints.

    Deviations relative to the largest coordinate of the torus at the samples.
    """
    there = _modes_of(torus, made.times)
    largest = np.max(np.abs(there))
    distances = np.max(np.abs(made.Q - there), axis=1) / largest
    worst = int(np.argmax(distances))
    assert made.averages is not None
    average = [fifteen_digits(value) for value in made.averages[-1]]
    expected = [fifteen_digits(value) for value in torus.average_spectrum()]
    return {
        "N": made.chain.N,
        **_mode_entries(made),
        "scheme": made.scheme.name,
        "step": fifteen_digits(made.step),
        "time": fifteen_digits(made.times[-1]),
        "samples": len(made.times),
        "energy": repr(float(made.energies[0])),
        "energy_error": fifteen_digits(made.energy_error),
        "largest_deviation": fifteen_digits(distances[worst]),
        "largest_deviation_time": fifteen_digits(made.times[worst]),
        "average_spectrum": average,
        "torus_average_spectrum": expected,
        "seconds": round(made.seconds, 3),
    }


def _modes_of(torus: QuasiPeriodic | RingTorus, times: Floats) -> Numbers:
    if isinstance(torus, RingTorus):
        return torus.mode_coordinates(times)
    return torus.positions(times)


def _mode_entries(made: Orbit) -> dict[str, Any]:
    """The ends of a ring and its modes, in the order of its spectra."""
    if not made.chain.periodic:
        return {}
    return {"ends": made.chain.ends, "modes": list(made.chain.mode_numbers)}


def _print(record: dict[str, Any]) -> None:
    energy_error = record["energy_error"]
    say(f"energy error       {energy_error:.3g}   (largest |H(t)/H(0) - 1| of the samples)")
    deviation = f"{record['largest_deviation']:.3g}"
    when = f"t = {record['largest_deviation_time']:.10g}"
    say(
        f"off the torus      {deviation}   (largest at {when}, relative to the largest coordinate)"
    )
    if energy_error > LOST_ENERGY:
        say("the energy is lost: this is no orbit of the chain, take a shorter step")
    say("mode  time average of E_q      on the torus, for ever")
    average = record["average_spectrum"]
    expected = record["torus_average_spectrum"]
    modes = record.get("modes", range(1, record["N"]))
    by_energy = sorted(range(len(average)), key=lambda place: -average[place])
    for place in by_energy[:SHOWN_MODES]:
        say(f"{modes[place]:<5} {average[place]:<24.6g} {expected[place]:.6g}")


def _write(path: Path, made: Orbit) -> None:
    """The samples: t, H and E_q, and in .npz also Q and P."""
    spectrum = made.harmonic_energies()
    if path.suffix == ".csv":
        write_text(path, _table(made, spectrum))
        return
    draft = path.with_name(f".{path.name}")
    try:
        with draft.open("wb") as stream:
            np.savez(stream, t=made.times, Q=made.Q, P=made.P, H=made.energies, E=spectrum)
        draft.replace(path)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise InputError(
            "output",
            str(path),
            "a file that can be written",
            f"choose another ({error.strerror})",
        ) from error


def _table(made: Orbit, spectrum: Floats) -> str:
    """t, H and E_q of the samples, with commas between them."""
    text = io.StringIO()
    rows = csv.writer(text)
    modes = [f"E{q}" for q in made.chain.mode_numbers]
    rows.writerow(["t", "H", *modes])
    for t, H, E in zip(made.times, made.energies, spectrum, strict=True):
        rows.writerow([repr(float(v)) for v in (t, H, *E)])
    return text.getvalue()
