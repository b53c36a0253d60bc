"""How the frequencies of an orbit change with its energy: a frequency map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.starts import packet_state
from symfpu.errors import InputError
from symfpu.files.lines_file import LinesFile
from symfpu.files.progress import Progress, unheard
from symfpu.frames.attributes import attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.table import joined
from symfpu.frames.tabled import Gridded
from symfpu.notebook import Shown
from symfpu.numbers.typed import Number, decimal, exact, integer, seed_modes
from symfpu.spectral.analysis import FrequencyAnalysis, frequency_analysis

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Row = dict[str, Any]

HEADER, SCHEMA = "symfpu frequency map", 1
HALVES = 2  # windows of the drift
KEYS = ("energy", "modes", "frequencies", "errors", "strengths", "drifts")


@dataclass(frozen=True, eq=False)
class FrequencyMap(Shown, Gridded):
    """Frequencies of orbits of one kind by their energy. Made by `frequency_map`; ours.

    chain : the model. T : the length of each orbit; dimensionless, as all here. packet : the modes
        that move at t = 0.
    level : of the strongest line, above which an independent frequency counts.
    energies : H, rising; shape (E,).
    frequencies, errors, strengths : of the independent frequencies, each at the mode in which its
        line is strongest, and f A of that line as part of the largest; (E, N-1), nan where the
        strongest lines of a mode are combinations of others.
    counts : how many independent frequencies are above the level; (E,).
    drifts : largest relative change, from one half of the time to the other, of the strongest line
        of a mode that has one of these; (E,). Of a regular orbit the accuracy of half the time.

    >>> from symfpu import Chain, frequency_map
    >>> frequency_map(Chain(N=4, beta=1), ("0.01", "0.1"), T=500, step=0.1)
    FrequencyMap(N=4, beta=1, packet 1, T=500, 2 energies 0.01 .. 0.1, 2 .. 2 frequencies above
    0.001, drift ... .. ...)
    """

    chain: Chain
    T: float
    packet: tuple[int, ...]
    level: float
    energies: Floats
    frequencies: Floats = field(repr=False)
    errors: Floats = field(repr=False)
    strengths: Floats = field(repr=False)
    counts: Ints
    drifts: Floats

    def __repr__(self) -> str:
        chain = repr(self.chain)[6:-1]
        E, n, d = self.energies, self.counts, self.drifts
        start = f"packet {joined(self.packet)}, T={self.T:.10g}"
        energies = f"{len(E)} energies {E[0]:.6g} .. {E[-1]:.6g}"
        counts = f"{n.min()} .. {n.max()} frequencies above {self.level:g}"
        drift = f"drift {d.min():.2g} .. {d.max():.2g}"
        return f"FrequencyMap({chain}, {start}, {energies}, {counts}, {drift})"

    def shifts(self) -> Floats:
        """omega_q/Omega_q - 1 of those above the level, nan elsewhere; shape (E, N-1).

        >>> from symfpu import Chain, frequency_map
        >>> found = frequency_map(Chain(N=4, beta=1), ("0.01", "0.1"), T=500, step=0.1)
        >>> [round(float(x), 4) for x in found.shifts()[:, 0]]
        [0.0028, 0.0263]
        """
        shown = np.where(self.strengths > self.level, self.frequencies, np.nan)
        return np.asarray(shown / self.chain.frequencies() - 1)

    def _grid(self) -> Grid:
        by_mode = ("energy", "mode")
        return Grid(
            axes={"energy": self.energies, "mode": self.chain.mode_numbers},
            variables={
                "frequency": Variable(by_mode, self.frequencies, "independent frequency"),
                "error": Variable(by_mode, self.errors, "of the frequency"),
                "strength": Variable(by_mode, self.strengths, "f A as part of the largest"),
                "count": Variable(("energy",), self.counts, "frequencies above the level"),
                "drift": Variable(("energy",), self.drifts, "between halves, relative"),
            },
            attributes=attributes(
                self, self.chain, T=self.T, packet=self.packet, level=self.level
            ),
            rows=("energy", "mode"),
        )


def frequency_map(
    chain: Chain,
    energies: Sequence[Number],
    *,
    seeds: Sequence[int] = (1,),
    T: float = 1e6,
    step: float = 0.2,
    scheme: str = "kahan_li8",
    lines: int = 8,
    level: float = 1e-3,
    file: Path | str | None = None,
    progress: Progress | None = None,
) -> FrequencyMap:
    """Frequencies, their number and their drift for FPU-trajectories over a range of energies.

    chain : the model, of fixed ends. energies : H > 0 of each orbit; kept in rising order.
    seeds : the modes that move at t = 0, of equal harmonic energy, as `packet_state`; in the
        paper's section 6.4 the first one.
    T, step, scheme : of each orbit. lines : at most, of each mode, as `frequency_analysis`.
    level : of the strongest f A, above which an independent frequency counts, between 0 and 1.
    file : JSON lines, one for each energy as it comes; an existing file of the same map is
        continued, its last line dropped if it was cut.
    progress : called as (label, fraction done).

    Everything is dimensionless. Lines nearer to each other than 4 turns over T/2 blur the drift:
    2 omega_1 - omega_2, about (pi/N)^3/4, is the nearest. Ours. Raises InputError, also for a
    file of another map, and what `integrate` raises where an orbit has left its well.

    >>> from symfpu import Chain
    >>> frequency_map(Chain(N=4, alpha="0.3"), ("0.001", "0.01"), T=500, step=0.1).counts
    array([...])
    """
    require_fixed_ends(chain)
    modes = tuple(seed_modes(seeds, chain.N))
    if not 0 < level < 1:
        raise InputError("level", level, "a number between 0 and 1", "take 1e-3")
    asked = _energies(energies)
    most = integer(lines, "lines", 1)
    how = {"T": float(T), "step": float(step), "scheme": scheme, "lines": most}
    header = {"format": HEADER, "schema": SCHEMA, **chain.typed, "seeds": modes, **how}
    log = LinesFile(file, header, _kept_row, "a frequency map")
    rows = {row["energy"]: row for row in log.read()}
    tell = progress or unheard
    for i, (name, energy) in enumerate(asked.items()):
        if name not in rows:
            heard = _part(tell, f"H = {energy:.4g}", i, len(asked))
            rows[name] = _row(name, _analysis(chain, modes, name, how, heard))
            log.append([rows[name]])
        tell("energies", (i + 1) / len(asked))
    chosen = [rows[name] for name in asked]
    return _map(chain, float(T), modes, level, np.array(list(asked.values())), chosen)


def _energies(energies: Sequence[Number]) -> dict[str, float]:
    """Rising, by their decimal names; a doubled one once."""
    advice = "pass a sequence such as ('0.001', '0.01')"
    if isinstance(energies, (str, bytes)) or not np.iterable(energies):
        raise InputError("energies", energies, "energies H > 0", advice)
    found = {exact(energy, "energies") for energy in energies}
    if not found or min(found) <= 0:
        raise InputError("energies", tuple(energies), "energies H > 0", advice)
    return {decimal(energy): float(energy) for energy in sorted(found)}


def _part(tell: Progress, label: str, i: int, count: int) -> Progress:
    """The progress of one energy as part of the whole."""

    def heard(_: str, fraction: float) -> None:
        if not math.isnan(fraction):
            tell(label, (i + fraction) / count)

    return heard


def _analysis(
    chain: Chain, modes: Sequence[int], energy: str, how: Row, progress: Progress
) -> FrequencyAnalysis:
    state = packet_state(chain, modes, energy)
    orbit = integrate(
        chain, *state, how["T"], step=how["step"], scheme=how["scheme"], samples=1
    )
    return frequency_analysis(orbit, lines=how["lines"], windows=HALVES, progress=progress)


def _row(energy: str, found: FrequencyAnalysis) -> Row:
    """What is kept of an analysis: a line of the file."""
    return {
        "energy": energy,
        "modes": _modes(found),
        "frequencies": found.frequencies.tolist(),
        "errors": found.errors.tolist(),
        "strengths": found.strengths.tolist(),
        "drifts": [None if math.isnan(x) else x for x in _mode_drifts(found)],
    }


def _modes(found: FrequencyAnalysis) -> list[int]:
    """The mode of the strongest line of each independent frequency."""
    modes = []
    for place in range(len(found.seeds)):
        unit = tuple(int(i == place) for i in range(len(found.seeds)))
        own = [line for line in found.lines if line.harmonic == unit]
        modes.append(max(own, key=lambda line: line.amplitude).mode)
    return modes


def _mode_drifts(found: FrequencyAnalysis) -> list[float]:
    """Relative change of the strongest line of each mode between halves; nan without a line."""
    first, second = found.window_frequencies
    with np.errstate(invalid="ignore", divide="ignore"):
        changes = np.abs(second - first) / np.abs(first)
    return [float(x) for x in changes]


def _map(
    chain: Chain,
    T: float,
    modes: tuple[int, ...],
    level: float,
    energies: Floats,
    rows: Sequence[Row],
) -> FrequencyMap:
    by_mode = np.array([_by_mode(row, chain.N - 1) for row in rows])
    frequencies, errors, strengths = np.moveaxis(by_mode, 1, 0)
    counts = [sum(x > level for x in row["strengths"]) for row in rows]
    drifts = [_drift(row, level) for row in rows]
    return FrequencyMap(
        chain,
        T,
        modes,
        level,
        energies,
        frequencies,
        errors,
        strengths,
        np.array(counts),
        np.array(drifts),
    )


def _by_mode(row: Row, modes: int) -> Floats:
    """Frequency, error and strength of the strongest of each mode, nan without; (3, N-1)."""
    values = np.full((3, modes), np.nan)
    kept = row["modes"], row["frequencies"], row["errors"], row["strengths"]
    for q, *numbers in reversed(list(zip(*kept, strict=True))):  # the strongest last
        values[:, q - 1] = numbers
    return values


def _drift(row: Row, level: float) -> float:
    """The largest of the modes that have a frequency above the level."""
    pairs = zip(row["modes"], row["strengths"], strict=True)
    shown = {q for q, strength in pairs if strength > level}
    return max((row["drifts"][q - 1] or 0.0 for q in shown), default=0.0)


def _kept_row(record: Row) -> Row:
    """A line of the file, if it is one."""
    for name in KEYS:
        record[name]
    return record
