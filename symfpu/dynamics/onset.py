"""When orbits are seen to be chaotic: eight of them at once, each with one deviation vector.

The verdict is that of `alignment_indices` on its first vector, by the same numbers: it has
outgrown t^POWER by more than CHAOS_GROWTH e-foldings, which no regular orbit does and which is
never taken back. An orbit that leaves the well of its bonds is on no torus either, and counts with
the time at which it is gone. Of an orbit of which neither is seen nothing is said: more time may
show it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.dynamics.alignment import drawn_frame, last_time
from symfpu.dynamics.blanes_moan6 import BLANES_MOAN6
from symfpu.dynamics.dimension import CHAOS_GROWTH, EARLY_TIME, POWER
from symfpu.dynamics.starts import State
from symfpu.dynamics.stopping import UnstableStep
from symfpu.dynamics.wells import stretch_bounds
from symfpu.numbers.arithmetic import Numbers

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

STEP = 0.8
FINER = 0.5  # of the step, where an orbit has not kept its energy
LEAST_STEP = 0.02
ENERGY_KEPT = 1e-5  # relative: worse orbits are integrated again with a finer step
SAMPLES_A_DECADE = 40
LONGEST_BLOCK = 400.0  # of time, in which a deviation does not overflow


def chaos_times(chain: Chain, states: Sequence[State], T: float) -> Floats:
    """The time at which each orbit is seen to be chaotic, or has left its well; (M,).

    chain : of fixed ends. states : mode coordinates and momenta (Q, P), (N-1,) each. T : the last
    time; dimensionless. Infinite where neither is seen by T.

    Times are of a grid of SAMPLES_A_DECADE in every decade. Deviations begin at random, with the
    same one in every orbit. Raises UnstableStep where an orbit in its well does not keep its
    energy with the finest step.
    """
    # lazy: numba takes longer to import than all the rest
    from symfpu.numbers.lanes import LANES

    require_fixed_ends(chain)
    last_time(T)
    parts = range(0, len(states), LANES)
    return np.concatenate([_of_lanes(chain, states[i : i + LANES], T) for i in parts])


def _of_lanes(chain: Chain, states: Sequence[State], T: float) -> Floats:
    step = STEP
    while step >= LEAST_STEP:
        ensemble = _Ensemble(chain, states, step)
        seen = ensemble.followed(T)
        if ensemble.kept_energy():
            return seen
        step *= FINER
    raise ensemble.lost()


@dataclass(eq=False)
class _Verdict:
    """How far each deviation has outgrown t^POWER, as `outgrown_powers` has it, in turn."""

    most: Floats  # log |v| so far
    least: Floats  # of `most` less the power, from EARLY_TIME on
    seen: Floats

    def hears(self, time: float, growth: Floats, gone: Flags) -> None:
        """Of log |v| at one time, and of orbits that are gone."""
        self.most = np.fmax(self.most, growth)
        chaotic = np.zeros_like(gone)
        if time >= EARLY_TIME:
            power = POWER * math.log(time)
            self.least = np.fmin(self.least, self.most - power)
            chaotic = growth > self.least + power + CHAOS_GROWTH
        new = np.isinf(self.seen) & (chaotic | gone)
        self.seen[new] = time


class _Ensemble:
    """Up to eight orbits with their deviations, as the compiled loop moves them."""

    def __init__(self, chain: Chain, states: Sequence[State], step: float) -> None:
        from symfpu.numbers.lanes import LANES

        self.chain, self.step, self.count = chain, step, len(states)
        filled = [*states, *[states[-1]] * (LANES - len(states))]
        Q, P = (np.array(part, float) for part in zip(*filled, strict=True))
        dQ, dP = (np.broadcast_to(row[:1], Q.shape) for row in drawn_frame(chain, 2, 0))
        self.lanes = [_in_lanes(chain, rows) for rows in (Q, P, dQ, dP)]
        self.energies = np.asarray(chain.energy(Q, P))
        self.start = np.asarray(chain.harmonic_energies(Q, P))
        limits = [stretch_bounds(chain, float(H))[:2] for H in self.energies]
        self.bounds = np.array(limits).T
        self.growth = np.zeros(LANES)
        self.error = np.zeros(LANES)

    def followed(self, T: float) -> Floats:
        """Up to T, or until all are seen; the times at which they are."""
        none = np.full(len(self.growth), math.inf)
        verdict = _Verdict(-none, none.copy(), none.copy())
        done = 0
        for mark in _marks(T, self.step):
            self._move(mark - done)
            done = mark
            gone = ~self._inside()
            open_ = np.isinf(verdict.seen)
            verdict.hears(mark * self.step, self.growth, gone)
            self._look_at_energy(open_ & ~gone)
            if np.isfinite(verdict.seen[: self.count]).all():
                break
        return verdict.seen[: self.count]

    def kept_energy(self) -> bool:
        """Whether every orbit did, as long as nothing was seen and it was in its well."""
        return bool((self.error[: self.count] <= ENERGY_KEPT).all())

    def lost(self) -> UnstableStep:
        """What `kept_energy` denies, of the orbit that is farthest off."""
        worst = int(np.argmax(self.error[: self.count]))
        return UnstableStep(
            f"a step of {self.step:g} does not keep the energy to {ENERGY_KEPT:g}",
            "take less energy",
            time=0.0,
            mode=1 + int(np.argmax(self.start[worst])),
            energy=float(self.energies[worst]),
            orbit=(worst,),
        )

    def _move(self, steps: int) -> None:
        from symfpu.chain.bond_loops import run_loop
        from symfpu.dynamics.ensemble_loops import move_ensemble

        law, schedule = self.chain.law(), BLANES_MOAN6.merged(self.step)
        block = math.ceil(LONGEST_BLOCK / self.step)
        while steps > 0:
            now = min(steps, block)
            run_loop(move_ensemble, law, *self.lanes, law, now, *schedule)
            self._shorten()
            steps -= now

    def _shorten(self) -> None:
        """Deviations to unit length, which goes into their growth."""
        dx, dp = self.lanes[2:]
        with np.errstate(all="ignore"):
            length = np.sqrt((dx**2).sum(axis=0) + (dp**2).sum(axis=0))
            self.growth += np.log(length)
            dx /= length
            dp /= length

    def _inside(self) -> Flags:
        with np.errstate(all="ignore"):
            stretches = np.diff(self.lanes[0], axis=0)
        least, most = self.bounds
        return np.asarray(((stretches >= least) & (stretches <= most)).all(axis=0))

    def _look_at_energy(self, counted: Flags) -> None:
        """Of the lanes that count; an orbit that has left its bonds may be no number any more."""
        x, p = (lanes[1:-1].T[counted] for lanes in self.lanes[:2])
        now = np.asarray(self.chain.energy(self.chain.modes(x), self.chain.modes(p)))
        error = np.abs(now / self.energies[counted] - 1)
        self.error[counted] = np.fmax(self.error[counted], error)


def _in_lanes(chain: Chain, rows: Numbers) -> Floats:
    from symfpu.numbers.lanes import zeros

    lanes = zeros((chain.N + 1, len(rows)))
    lanes[1:-1] = np.asarray(chain.positions(rows)).T
    return lanes


def _marks(T: float, step: float) -> list[int]:
    """Numbers of steps after which the orbits are looked at, even in log t from 1 to T."""
    samples = math.ceil(SAMPLES_A_DECADE * math.log10(T)) + 1
    times = np.geomspace(1.0, T, samples)
    return [int(n) for n in np.unique(np.maximum(1, np.floor(times / step + 1e-9)))]
