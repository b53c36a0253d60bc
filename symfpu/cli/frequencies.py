"""The verb frequencies: frequency analysis of an orbit, or of many by their energy."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from symfpu.cli.chains import chain_of
from symfpu.cli.keeping import SaveOption, file_named, keep, output_named, say_kept
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.runs import StepOption, TimeOption
from symfpu.cli.starts import (
    EnergyOption,
    OwnAlpha,
    OwnBeta,
    OwnBonds,
    OwnPotential,
    PacketOption,
    RandomOption,
    StartArgument,
    StateOption,
    start_of,
)
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
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.typed import part
from symfpu.results.text_tables import text_table
from symfpu.spectral.analysis import FrequencyAnalysis, SpectralLine, frequency_analysis
from symfpu.spectral.mapping import FrequencyMap, frequency_map
from symfpu.spectral.near import torus_near
from symfpu.store.saved_file import save

RANGE_PARTS = 3  # A:B:n
SHOWN_LINES = 20
ENERGY_DIGITS = 4  # of the energies of a range


@app.command(epilog="Example: symfpu frequencies torus.symfpu --time 1e5")
def frequencies(
    context: typer.Context,
    time: TimeOption,
    file: StartArgument = None,
    state: StateOption = None,
    packet: PacketOption = None,
    random: RandomOption = None,
    energy: EnergyOption = None,
    energies: Annotated[
        str | None,
        typer.Option(
            "--energies",
            help="With --packet: a map over these energies, E,E,... or FROM:TO:NUMBER.",
            metavar="E",
        ),
    ] = None,
    bonds: OwnBonds = None,
    alpha: OwnAlpha = None,
    beta: OwnBeta = None,
    potential: OwnPotential = None,
    step: StepOption = "0.2",
    lines: Annotated[
        str, typer.Option(help="Lines of each mode, at most.", metavar="L")
    ] = "8",
    level: Annotated[
        str,
        typer.Option(
            help="Part of the strongest above which an independent frequency counts.",
            metavar="X",
        ),
    ] = "1e-3",
    rows: Annotated[
        str | None,
        typer.Option(
            "--file",
            help="With --energies: keep every energy as it comes, and go on from there.",
            metavar="FILE",
        ),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Of one orbit: write the torus near it, for symfpu refine.",
            metavar="FILE",
        ),
    ] = None,
    angles: Annotated[
        str | None,
        typer.Option(
            help="With -o: how many frequencies it has, the strongest; all, if left out.",
            metavar="S",
        ),
    ] = None,
    kept_file: SaveOption = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """Frequencies of an orbit, its strongest lines and its drift; with --energies a map."""
    picture = picture_named(plot)
    saved = file_named(kept_file)
    typed = {"N": bonds, "alpha": alpha, "beta": beta, "potential": potential, "ends": None}
    states = {"state": state, "packet": packet, "random": random}
    how: dict[str, Any] = {"T": number("time", time), "step": number("step", step)}
    how["lines"] = whole("lines", lines)
    above = part(number("level", level), "level")
    log = None if rows is None else path_named("file", rows)
    _refuse_for_others(energies is None, rows, output, angles)
    target = output_named(output)
    with progress_bar("frequencies", lambda: _kept(log)) as advance:
        found: FrequencyAnalysis | FrequencyMap
        if energies is None:
            found = _of_one(file, typed, states, energy, how, advance)
        else:
            others = {"FILE": file, "state": state, "random": random, "energy": energy}
            _refuse_beside_energies(others)
            how |= {"level": above, "file": log}
            found = _of_many(typed, packet, energies, how, advance)
        if target is not None and isinstance(found, FrequencyAnalysis):
            near = torus_near(found, _strongest(found, angles))
            save(target, near, command=shlex.join(["symfpu", *context.obj]))
        keep(found, saved, context)
        draw(found.plot, picture)
    if as_json:
        print_json(found.record())
        return
    say(found)
    _print(found, above)
    if target is not None:
        print(f"written: {target}")
    say_kept(saved)
    say_drawn(picture)


def _refuse_for_others(
    one: bool, rows: str | None, output: str | None, angles: str | None
) -> None:
    """InputError for the options of a map beside one orbit, and the other way round."""
    if one and rows is not None:
        raise InputError("file", rows, "nothing without --energies", "leave it out")
    if not one and output is not None:
        raise InputError("output", output, "nothing beside --energies", "use --save")
    if output is None and angles is not None:
        raise InputError("angles", angles, "nothing without -o", "leave it out")


def _strongest(found: FrequencyAnalysis, angles: str | None) -> tuple[int, ...]:
    """The seeds of so many frequencies; they come with falling strengths."""
    if angles is None:
        return found.seeds
    count = whole("angles", angles)
    if not 1 <= count <= len(found.seeds):
        allowed = f"1 to {len(found.seeds)}, the independent frequencies"
        raise InputError("angles", count, allowed, "choose among these")
    return found.seeds[:count]


def _kept(log: Path | None) -> str:
    if log is None or not log.exists():
        return NOTHING_KEPT
    return f"the energies so far are kept in {log}; the same command goes on from it"


def _of_one(
    file: str | None,
    typed: dict[str, str | None],
    states: dict[str, str | None],
    energy: str | None,
    how: dict[str, Any],
    progress: Progress,
) -> FrequencyAnalysis:
    start = start_of(file, typed, states, energy)
    orbit = integrate(start.chain, start.Q, start.P, how["T"], step=how["step"], samples=1)
    return frequency_analysis(orbit, lines=how["lines"], progress=progress)


def _refuse_beside_energies(others: dict[str, str | None]) -> None:
    for name, value in others.items():
        if value is not None:
            allowed = "nothing beside --energies, whose orbits start from --packet"
            raise InputError(name, value, allowed, "leave it out, or leave out --energies")


def _of_many(
    typed: dict[str, str | None],
    packet: str | None,
    energies: str,
    how: dict[str, Any],
    progress: Progress,
) -> FrequencyMap:
    if typed["N"] is None:
        allowed = "the chain of the map"
        raise InputError("N", None, allowed, "give -N, and --alpha, --beta or --potential")
    couplings = typed["alpha"] or "0", typed["beta"] or "0"
    chain = chain_of(typed["N"], *couplings, typed["potential"], "fixed")
    modes = whole_numbers("packet", packet or "1")
    return frequency_map(chain, _energies(energies), seeds=modes, progress=progress, **how)


def _energies(text: str) -> list[str]:
    """E,E,... as they are; FROM:TO:NUMBER in equal ratios, rounded to a few digits."""
    if ":" not in text:
        return text.split(",")
    parts = text.split(":")
    if len(parts) != RANGE_PARTS:
        advice = "such as 1e-4:0.1:20"
        raise InputError("energies", text, "E,E,... or FROM:TO:NUMBER", advice)
    first, last = number("energies", parts[0]), number("energies", parts[1])
    count = whole("energies", parts[2])
    if not 0 < first < last or count < 2:
        allowed = "0 < FROM < TO, and 2 or more of them"
        raise InputError("energies", text, allowed, "such as 1e-4:0.1:20")
    return [f"{x:.{ENERGY_DIGITS}g}" for x in np.geomspace(first, last, count)]


def _print(found: FrequencyAnalysis | FrequencyMap, level: float) -> None:
    if isinstance(found, FrequencyMap):
        head = ["H", "frequencies", "drift", "omega_q/Omega_q - 1 of the modes q"]
        say("\n".join(text_table(head, _map_rows(found))))
        return
    say(f"independent frequencies above {level:g} of the strongest: {found.count(level)}")
    say("errors of the lines of the computed orbit; what its step adds, half of it shows")
    head = ["mode", "frequency", "error", "amplitude", "harmonic"]
    strongest = sorted(found.lines, key=lambda line: -line.amplitude)[:SHOWN_LINES]
    say("\n".join(text_table(head, [_line_row(line) for line in strongest])))


def _map_rows(found: FrequencyMap) -> list[list[str]]:
    rows = []
    by_energy = zip(found.energies, found.counts, found.drifts, found.shifts(), strict=True)
    for energy, count, drift, shifts in by_energy:
        known = [(q, x) for q, x in enumerate(shifts, 1) if not np.isnan(x)]
        shown = ", ".join(f"{q}: {x:+.3e}" for q, x in known)
        rows.append([f"{energy:.6g}", str(count), f"{drift:.1e}", shown])
    return rows


def _line_row(line: SpectralLine) -> list[str]:
    name = "?" if line.harmonic is None else ",".join(map(str, line.harmonic))
    return [
        str(line.mode),
        f"{line.frequency:.15g}",
        f"{line.error:.1e}",
        f"{line.amplitude:.6g}",
        name,
    ]
