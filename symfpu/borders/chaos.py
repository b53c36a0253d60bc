"""The energy at which orbits of a packet are seen to be chaotic: an end of tori that needs none.

Through a chaotic orbit goes no torus, of any dimension. So along the ray of a packet, its modes in
equal energies, orbits are integrated, one with phases 0 and several with random ones, and the
lowest energies at which chaos is seen by a given time are looked for. That chaos is not seen by
that time says nothing of later ones.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.onset import chaos_times
from symfpu.dynamics.starts import State, packet_state
from symfpu.errors import InputError
from symfpu.numbers.counted import short

CHAOS = "chaos"
IN_PHASE = "in-phase"
FACTOR = 1.2  # between neighbouring energies of the grid, H/N = FACTOR^k
COARSE = 4  # steps of the grid on the way down from H/N = 1
QUIET = 2  # such steps without chaos in any orbit, after which the way ends
LOWEST = -120  # where it ends in any case, H/N = 3e-10
EARLIER = (1, 10, 100)  # parts of the time, by which borders are located, too
TIME = 1e5
DRAWS = 7  # with the orbit of phases 0 as many as lanes of the processor
Floats = NDArray[np.float64]
Json = dict[str, Any]


@dataclass(frozen=True, eq=False)
class ChaosRay:
    """Orbits of a packet along its ray, and when they are seen to be chaotic.

    draws : of random phases, the same ones at all energies. found : by the step k of the grid, the
    time of each orbit, phases 0 first; infinite where nothing is seen by `time`, 0 where the well
    has no such state.
    """

    chain: Chain
    seeds: tuple[int, ...]
    time: float
    draws: int
    found: dict[int, Floats] = field(default_factory=dict)

    def searched(self) -> ChaosRay:
        """With the energies that borders by `time`, a tenth and a hundredth of it ask for."""
        self._descend()
        for part in EARLIER:
            while (step := self._between(self.time / part)) is not None:
                self._look(step)
        return self

    def records(self) -> list[Json]:
        """The orbits as JSON holds them."""
        return [
            {
                "place": short(self._energy(k)),
                "seen": [short(t) if math.isfinite(t) else None for t in self.found[k]],
            }
            for k in sorted(self.found)
        ]

    def _energy(self, k: int) -> float:
        return float(self.chain.N * FACTOR**k)

    def _look(self, k: int) -> None:
        phases = [dict.fromkeys(self.seeds, 0.0)]
        phases += [_phases(self.seeds, draw) for draw in range(self.draws)]
        states = [self._state(k, one) for one in phases]
        times = np.zeros(len(states))
        there = [i for i, state in enumerate(states) if state is not None]
        if there:
            kept = [state for state in states if state is not None]
            times[there] = chaos_times(self.chain, kept, self.time)
        self.found[k] = times

    def _state(self, k: int, phases: Mapping[int, float]) -> State | None:
        """None where the well of the bonds has no such state."""
        try:
            return packet_state(self.chain, self.seeds, self._energy(k), phases=phases)
        except InputError:
            return None

    def _descend(self) -> None:
        quiet = 0
        for k in range(0, LOWEST, -COARSE):
            self._look(k)
            quiet = quiet + 1 if np.isinf(self.found[k]).all() else 0
            if quiet == QUIET:
                return

    def _between(self, time: float) -> int | None:
        """A step between the lowest one with chaos by then and the one below; None if all meet."""
        steps = sorted(self.found)
        for orbit in range(self.draws + 1):
            seen = [k for k in steps if self.found[k][orbit] <= time]
            place = steps.index(seen[0]) if seen else 0
            if place and steps[place] - steps[place - 1] > 1:
                return (steps[place] + steps[place - 1]) // 2
        return None


def _phases(seeds: Sequence[int], draw: int) -> dict[int, float]:
    random = np.random.default_rng(draw)
    return dict(
        zip(seeds, random.uniform(0, 2 * math.pi, len(seeds)).tolist(), strict=True)
    )


def chaos_borders(orbits: Sequence[Json], time: float) -> dict[str, Json]:
    """The borders CHAOS and IN_PHASE by a time, of the orbits of a ray; as JSON holds them.

    orbits : as `ChaosRay.records`. CHAOS is the median over the random phases of the lowest energy
    at which an orbit is seen to be chaotic; `between` are the lowest and the highest of them.
    """
    places = [row["place"] for row in orbits]
    seen = [[t is not None and t <= time for t in row["seen"]] for row in orbits]
    by_orbit = list(zip(*seen, strict=True))
    lowest = [_lowest(places, one) for one in by_orbit]
    quiet = [_highest_quiet(places, one) for one in by_orbit]
    shared = {"time": time, "draws": len(lowest) - 1}
    return {
        CHAOS: _record(sorted(lowest[1:]), max(quiet[1:]), places) | shared,
        IN_PHASE: _record(lowest[:1], quiet[0], places) | shared,
    }


def _lowest(places: Sequence[float], seen: Sequence[bool]) -> float:
    return min(
        (H for H, chaotic in zip(places, seen, strict=True) if chaotic), default=math.inf
    )


def _highest_quiet(places: Sequence[float], seen: Sequence[bool]) -> float:
    """The largest energy at which nothing was seen; 0 if there is none."""
    return max(
        (H for H, chaotic in zip(places, seen, strict=True) if not chaotic), default=0.0
    )


def _record(rising: Sequence[float], quiet: float, places: Sequence[float]) -> Json:
    """quiet : of these orbits the highest energy without chaos, above the border in a window."""
    middle = rising[len(rising) // 2]
    if math.isinf(middle):
        return {"none": f"no chaos seen up to H = {max(places):.6g}"}
    highest = rising[-1] if math.isfinite(rising[-1]) else None
    return {
        "place": middle,
        "energy": middle,
        "between": [rising[0], highest],
        "quiet": quiet,
    }
