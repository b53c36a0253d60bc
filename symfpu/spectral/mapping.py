"""How the frequencies of an orbit change with its energy: a frequency map.

One use of `symfpu.sweeps`: each energy is a case, and each case a row of a file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing import parent_process
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.dense import available_cores
from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import (
    Number,
    decimal,
    double,
    energy_of,
    integer,
    part,
    seed_modes,
)
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, listed
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded
from symfpu.results.table import joined
from symfpu.spectral.one_energy import Row, kept_row, orbit_frequencies, require_analysable
from symfpu.spectral.samples import require_turns
from symfpu.sweeps.rows import SweepFailure, SweepRows
from symfpu.sweeps.sweep import sweep
from symfpu.sweeps.this_process import ThisProcess

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
WORTH_PROCESSES = 2e6  # steps times bonds, of all energies: a second to ten of one core


@public
@dataclass(frozen=True, eq=False)
class FrequencyMap(Gridded):
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

    def _answer(self) -> str:
        return f"{self.counts.min()} to {self.counts.max()} frequencies"

    def _fields(self) -> Iterator[Field]:
        yield from super()._fields()
        yield Field("", label="packet", shown=listed(self.packet))
        yield Field("", label="to t", shown=f"{self.T:.10g}")
        by_energy = zip(self.energies, self.counts, self.drifts, strict=True)
        for energy, count, drift in by_energy:
            found = counted(count, "frequency", "frequencies")
            yield Field("", label=f"H = {energy:.6g}", shown=f"{found}, drift {drift:.2g}")

    def __repr__(self) -> str:
        chain = self.chain.label
        E, n, d = self.energies, self.counts, self.drifts
        start = f"packet {joined(self.packet)}, T={self.T:.10g}"
        energies = f"{counted(len(E), 'energy', 'energies')} {E[0]:.6g} .. {E[-1]:.6g}"
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


class MapIncomplete(SymfpuError):
    """Some energies of a map have no frequencies: raised by `frequency_map` at its end.

    All other energies are then done.

    done : the map of all other energies, None if there is none. failures : what went wrong by
    energy, as text: kind of error, message, numbers. Ours.
    """

    def __init__(
        self, done: FrequencyMap | None, failures: Mapping[str, SweepFailure]
    ) -> None:
        self.done = done
        self.failures = dict(failures)
        energy, failure = next(iter(self.failures.items()))
        many = "energy has" if len(self.failures) == 1 else "energies have"
        none = f"{len(self.failures)} {many} no frequencies, the first H = {energy}"
        count = 0 if done is None else len(done.energies)
        kept = "kept in the attribute done, and in the file if there is one"
        others = f"energies that have some: {count}, {kept}"
        advice = "leave out those that have none, or call again to try them once more"
        super().__init__(f"{none} ({failure}); {others}: {advice}")


@public
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
    file : JSON lines, one for each energy as it comes, as of `sweep`: an existing file of the same
        map is continued, its last line dropped if it was cut; failures in it are computed again.
    progress : called as (label, fraction done).

    Energies whose orbits take more than seconds are shared out to processes, one a core, which a
    script must start under `if __name__ == "__main__":`.

    Everything is dimensionless. Lines nearer to each other than 4 turns over T/2 blur the drift:
    2 omega_1 - omega_2, about (pi/N)^3/4, is the nearest. Ours. Raises InputError, also for a
    file of another map, and UnstableStep; MapIncomplete, after all other energies, if one failed
    (an orbit that has left its well, a process that died); FileFull and SweepStopped as `sweep`.

    >>> from symfpu import Chain
    >>> frequency_map(Chain(N=4, alpha="0.3"), ("0.001", "0.01"), T=500, step=0.1).counts
    array([...])
    """
    require_fixed_ends(chain)
    modes = tuple(seed_modes(seeds, chain.N))
    part(level, "level")
    asked = _energies(energies)
    orbits = _orbits(chain, T, step, scheme, lines)
    require_turns(chain, min(modes), orbits["T"])
    told = _Told(progress or unheard, len(asked))
    swept = sweep(
        orbit_frequencies,
        [{"energy": name} for name in asked],
        fixed={"chain": chain, "seeds": modes} | orbits,
        executor=_executor(chain.N * orbits["T"] / orbits["step"], told),
        file=file,
        retry=True,
        progress=told.energies,
    )
    rows = _rows(swept, file)
    failures = {row.case["energy"]: row.failure for row in swept.rows if row.failure}
    if not rows:
        raise MapIncomplete(None, failures)
    found = np.array([asked[name] for name in rows])
    done = _map(chain, orbits["T"], modes, level, found, list(rows.values()))
    if failures:
        raise MapIncomplete(done, failures)
    return done


def _orbits(
    chain: Chain, T: Number, step: Number, scheme: str, lines: int
) -> dict[str, Any]:
    """How each orbit is followed; InputError and UnstableStep for what no energy would pass."""
    length, each = double(T, "T"), double(step, "step")
    most = integer(lines, "lines", 1)
    require_analysable(chain, length, each, scheme)
    return {"T": length, "step": each, "scheme": scheme, "lines": most}


class _Told:
    """The progress of a map, and of the one energy that is at work in this process."""

    def __init__(self, tell: Progress, count: int) -> None:
        self.tell, self.count = tell, count
        self.done = 0.0

    def energies(self, _: str, fraction: float) -> None:
        """So much of all energies is done."""
        self.done = fraction
        self.tell("energies", fraction)

    def one(self, label: str, fraction: float) -> None:
        """So much of one energy: a part of the whole."""
        if not math.isnan(fraction):
            self.tell(label, self.done + fraction / self.count)


def _executor(work: float, told: _Told) -> ThisProcess | None:
    """None for processes: where several energies take longer than it takes to start them.

    A process that is itself one of a pool has its share of the cores and starts no others.
    work : of one energy, steps times bonds.
    """
    alone = told.count == 1 or available_cores() == 1 or parent_process() is not None
    if alone or work * told.count < WORTH_PROCESSES:
        return ThisProcess(progress=told.one)
    told.energies("", 0.0)
    return None


def _rows(swept: SweepRows, file: Path | str | None) -> dict[str, Row]:
    """By energy, of those that have one; InputError for a file in which other things stand."""
    done = [row for row in swept.rows if row.failure is None]
    try:
        return {row.case["energy"]: kept_row(row.result) for row in done}
    except (KeyError, TypeError) as error:
        advice = "it is damaged: remove it or name another"
        raise InputError("file", str(file), "rows of a map", advice) from error


def _energies(energies: Sequence[Number]) -> dict[str, float]:
    """Rising, by their decimal names; a doubled one once."""
    advice = "pass a sequence such as ('0.001', '0.01')"
    if isinstance(energies, (str, bytes)) or not np.iterable(energies):
        raise InputError("energies", energies, "energies H > 0", advice)
    found = {energy_of(energy, "energies") for energy in energies}
    if not found:
        raise InputError("energies", (), "energies H > 0", advice)
    return {decimal(energy): float(energy) for energy in sorted(found)}


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
