"""Many orbits as one array that a compiled loop moves.

The array holds the coordinates of the splitting of a scheme.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.wells import beyond_walls
from symfpu.numbers.arithmetic import Numbers

Floats = NDArray[np.float64]
# orbits moved as lanes: all take as long as two to four alone, six of a law that takes them singly
FEWEST, FEWEST_SINGLY = 4, 6
CLOSED = 16  # a tension by exponentials and logarithms, in those of a polynomial, about


class Motion:
    """Coordinates of M orbits, shape (M, 2, length), and how they move.

    bounds : of the bond stretches, for each orbit, (M, 2). parts : orbits that go together, as
    lanes where they are `fewest` or more; products of modes are vectors already and go alone.
    """

    def __init__(
        self, chain: Chain, scheme: Scheme, step: float, bounds: Floats, workers: int = 1
    ) -> None:
        # lazy: numba takes longer to import than all the rest
        from symfpu.numbers.lanes import LANES

        self.chain, self.scheme, self.bounds = chain, scheme, bounds
        together = 1 if scheme.in_modes else LANES
        self.parts = parted(len(bounds), together, workers)
        self.entry, self.kicks, self.drifts = scheme.merged(step)
        self.law = chain.law()
        self.fewest = FEWEST_SINGLY if hasattr(self.law, "tension_loop") else FEWEST
        self.Omega = np.concatenate([[0.0], chain.frequencies()])
        self.unit = (2 * chain.N) ** 0.5
        self.ends = chain.kind_of_ends

    def coordinates(self, Q: Numbers, P: Numbers) -> Floats:
        """Of mode coordinates and momenta (M, N-1)."""
        if self.scheme.in_modes:
            state = np.zeros((len(Q), 2, self.chain.N))
            state[:, 0, 1:] = self.Omega[1:] * Q / self.unit
            state[:, 1, 1:] = P / self.unit
        else:
            state = np.zeros((len(Q), 2, self.chain.N + 1))
            state[:, 0] = self.ends.sites(self.chain.positions(Q))
            state[:, 1] = self.ends.sites(self.chain.positions(P))
        return state

    def modes(self, state: Floats) -> tuple[Numbers, Numbers]:
        """Mode coordinates and momenta (M, N-1)."""
        if self.scheme.in_modes:
            Q = state[:, 0, 1:] * self.unit / self.Omega[1:]
            P = state[:, 1, 1:] * self.unit
        else:
            Q = np.asarray(self.chain.modes(self.ends.moving(state[:, 0])))
            P = np.asarray(self.chain.modes(self.ends.moving(state[:, 1])))
        return Q, P

    @property
    def polynomial(self) -> bool:
        return isinstance(self.chain.potential, Polynomial)

    @property
    def moves_a_kick(self) -> int:
        """The work of a kick: particles moved, or products of two modes."""
        chain = self.chain
        if self.scheme.in_modes:
            terms = [place for place, c in enumerate(self.law, 1) if c]
            return int(chain.N**2 * terms[-1])
        return chain.N if self.polynomial else CLOSED * chain.N

    def beyond_wall(self, row: Floats) -> bool:
        """Whether the coordinates of one orbit have a bond beyond a wall of its potential."""
        law = self.chain.potential
        return not self.polynomial and bool(beyond_walls(law, np.diff(row[0])).any())

    def advance(self, state: Floats, steps: int, each: Callable[..., Any]) -> list[int]:
        """Moves all orbits; returns the steps of each of them before it had to stop.

        each : a map, perhaps of several threads.
        """

        def moved(part: slice) -> list[int]:
            return self._moved(state[part], self.bounds[part], steps)

        return list(itertools.chain.from_iterable(each(moved, self.parts)))

    def move(self, row: Floats, bounds: Floats, steps: int) -> int:
        """Moves one orbit."""
        loop, _ = self._loops()
        return self._run(loop, *self._arguments(row, bounds, steps))

    def _moved(self, rows: Floats, bounds: Floats, steps: int) -> list[int]:
        """Moves orbits of one part.

        Lanes stop together: where one does, each orbit is moved alone, to where it stops.
        """
        if len(rows) >= self.fewest:
            lanes = _in_lanes(rows)
            if self.move(lanes, _in_lanes(bounds), steps) == steps:
                rows[...] = _out_of_lanes(lanes, len(rows))
                return [steps] * len(rows)
        return [self.move(*one, steps) for one in zip(rows, bounds, strict=True)]

    def look(
        self, state: Floats, looks: int, stride: int, each: Callable[..., Any]
    ) -> tuple[list[int], Numbers, Numbers]:
        """Moves all orbits and looks at them every `stride` steps.

        Returns those steps, and the Q and P seen, shapes (M, looks, N-1).
        """
        orbits, *one = state.shape
        seen = np.zeros((orbits, looks, *one))

        def looked(part: slice) -> list[int]:
            return self._looked(state[part], self.bounds[part], stride, seen[part])

        done = list(itertools.chain.from_iterable(each(looked, self.parts)))
        Q, P = self.modes(seen.reshape(-1, *one))
        return done, Q.reshape(orbits, looks, -1), P.reshape(orbits, looks, -1)

    def _looked(self, rows: Floats, bounds: Floats, stride: int, seen: Floats) -> list[int]:
        """Looks at orbits of one part; seen (orbits, looks, 2, length)."""
        steps = seen.shape[1] * stride
        if len(rows) >= self.fewest:
            lanes, seen_lanes = _in_lanes(rows), _in_lanes(seen)
            if self._look(lanes, _in_lanes(bounds), stride, seen_lanes) == steps:
                rows[...] = _out_of_lanes(lanes, len(rows))
                seen[...] = _out_of_lanes(seen_lanes, len(rows))
                return [steps] * len(rows)
        every = zip(rows, bounds, seen, strict=True)
        return [self._look(row, limits, stride, out) for row, limits, out in every]

    def _look(self, row: Floats, bounds: Floats, stride: int, seen: Floats) -> int:
        _, loop = self._loops()
        return self._run(loop, *self._arguments(row, bounds, stride), seen)

    def _run(self, loop: Any, *arguments: Any) -> int:
        # lazy: numba takes longer to import than all the rest
        from symfpu.chain.bond_loops import run_loop

        return int(run_loop(loop, self.law, *arguments))

    def _loops(self) -> tuple[Any, Any]:
        """The loop that moves one orbit, and the one that looks at it."""
        # lazy: numba takes longer to import than all the rest
        if self.chain.periodic:
            from symfpu.dynamics.ring_loops import look_at_ring, move_ring

            return move_ring, look_at_ring
        from symfpu.dynamics import orbit_loops as fixed

        if self.scheme.in_modes:
            return fixed.move_modes, fixed.look_at_modes
        return fixed.move_particles, fixed.look_at_particles

    def _arguments(self, row: Floats, bounds: Floats, steps: int) -> tuple[Any, ...]:
        rates = (row[0], row[1], self.law, steps, self.entry, self.kicks, self.drifts)
        if self.scheme.in_modes:
            widest = float(np.max(np.abs(bounds)))
            return (*rates, self.Omega, 0.5 * widest**2)
        return (*rates, bounds)


def parted(orbits: int, together: int, workers: int) -> list[slice]:
    """Orbits in parts of so many, or fewer where each worker would not have one."""
    size = min(together, -(-orbits // workers))
    return [slice(first, first + size) for first in range(0, orbits, size)]


def _in_lanes(rows: Floats) -> Floats:
    """Numbers of several orbits, (M, ...), as lanes (..., LANES); the last orbit fills up."""
    from symfpu.numbers.lanes import LANES, zeros

    lanes = zeros((*rows.shape[1:], LANES))
    lanes[...] = np.moveaxis(rows[-1:], 0, -1)
    lanes[..., : len(rows)] = np.moveaxis(rows, 0, -1)
    return lanes


def _out_of_lanes(lanes: Floats, orbits: int) -> Floats:
    """The way back."""
    return np.moveaxis(lanes[..., :orbits], -1, 0)
