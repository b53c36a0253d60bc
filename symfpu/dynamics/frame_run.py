"""The run behind the alignment indices: a frame moved from mark to mark.

It is kept on disk and taken up again bitwise; the time that it will take is estimated here too.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.stopping import OrbitStopped
from symfpu.dynamics.tangent import MovingFrame
from symfpu.errors import SymfpuError
from symfpu.files.archive import BundleError, Json
from symfpu.files.checkpoint import (
    ADVICE,
    ALIGNMENT,
    digest,
    marks_of,
    read_checkpoint,
    write_checkpoint,
)
from symfpu.files.interruption import kept_run
from symfpu.files.progress import Progress

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# moves of a particle with its lanes between two looks at the clock: half a second, about
PORTION = 6_400_000
TRIAL = 0.2  # seconds of a measurement


class OrbitLost(SymfpuError):
    """An orbit that went to infinity.

    Orbits of the alpha model over its barrier do so, and any orbit with too long a step, which
    may also take a bond across the wall of its potential.

    Raised by `alignment_indices`. Ours.

    time : before which it was lost; step : of the integrator; both dimensionless. bond : j of the
        bond r_j = x_(j+1) - x_j that went too far, None where it is not known.
    """

    def __init__(self, time: float, step: float, bond: int | None = None) -> None:
        self.time, self.step, self.bond = time, step, bond
        lost = f"the orbit is lost before t = {time:.6g} with steps of {step:g}"
        place = "" if bond is None else f" in bond {bond}"
        super().__init__(f"{lost}{place}; take less energy or a shorter step")


class FrameRun:
    """A frame after so many steps, the product of its triangular factors, and the samples so far.

    marks : numbers of steps at which there are samples, (S,). longest : block, in steps.
    volumes : log(R_jj / |R e_j|) at every mark, (S, vectors), and growth : log R_11, (S,),
        natural logarithms.
    every : seconds between two checkpoints.
    """

    def __init__(
        self, frame: MovingFrame, marks: Ints, step: float, longest: int, every: float
    ) -> None:
        self.frame, self.step, self.longest, self.every = frame, step, longest, every
        m, work = frame.vectors, frame.chain.N * len(frame.dx)
        self.portion = max(longest, PORTION // work)
        self.done, self.block = 0, longest
        self.columns = np.eye(m)
        self.diagonal, self.norms = np.zeros(m), np.zeros(m)
        self.path: Path | None = None
        self._sample_at(marks)

    def _sample_at(self, marks: Ints) -> None:
        self.marks = marks
        self.volumes = np.zeros((len(marks), self.frame.vectors))
        self.growth = np.zeros(len(marks))

    def keep_in(self, path: Path, start: Json) -> None:
        """Goes on from the file, if there is one, which may hold a shorter run.

        start : what the first frame was made of, the same on every machine.
        """
        self.path, frame = path, self.frame
        known = {
            **frame.chain.typed,
            "vectors": frame.vectors,
            "scheme": frame.scheme.name,
            "step": repr(self.step),
            "steps": int(self.marks[-1]),
            "sampled steps": digest(self.marks),
            "block": self.longest,
            "portion": self.portion,
        }
        self.parameters = known | start
        kept = read_checkpoint(path, self.parameters, ALIGNMENT)
        if kept is None:
            return
        done, arrays = kept
        marks = marks_of(path, arrays["sampled"], done, self.marks, exact=False)
        self._sample_at(marks)
        block = arrays.pop("block", np.zeros(0))
        block_is_one = block.shape == (1,) and 1 <= block[0] <= self.longest
        room = self._arrays(done)
        shapes = {name: values.shape for name, values in arrays.items()}
        due = {name: values.shape for name, values in room.items()}
        if shapes != due or done > self.marks[-1] or not block_is_one:
            reason = "is damaged (its arrays are not those of its parameters)"
            raise BundleError(path, reason, ADVICE)
        for name, values in room.items():
            values[...] = arrays[name]
        self.done = done
        self.block = int(block[0])

    def _known_marks(self, done: int) -> Floats:
        """Numbers of steps at which there are samples after so many, as a checkpoint holds them."""
        return self.marks[self.marks <= done].astype(np.float64)

    def _arrays(self, done: int) -> dict[str, Floats]:
        """Everything that the run is after so many steps, but for the block."""
        frame, marks = self.frame, self._known_marks(done)
        known = len(marks)
        return {
            "x": frame.x,
            "p": frame.p,
            "dx": frame.dx,
            "dp": frame.dp,
            "columns": self.columns,
            "diagonal": self.diagonal,
            "norms": self.norms,
            "sampled": marks,
            "volumes": self.volumes[:known],
            "growth": self.growth[:known],
        }

    def _ends(self) -> Iterator[int]:
        """Where loops end: at marks, and after portions that depend on the arguments alone.

        Each end is also the end of a block: so an interrupted run rounds like one that was not.
        """
        while self.done < self.marks[-1]:
            place = np.searchsorted(self.marks, self.done, side="right")
            portions = self.done // self.portion + 1
            yield min(int(self.marks[place]), portions * self.portion)

    def go(self, tell: Progress) -> None:
        """To the last mark. Raises OrbitLost; RunInterrupted where the run is kept in a file."""
        last = int(self.marks[-1])
        with kept_run(self.path, self.every, self._write) as look:
            for end in self._ends():
                self._move_to(end)
                place = f"at t = {end * self.step:.6g} of {last * self.step:.6g}"
                look(
                    place,
                    end == last,
                    partial(tell, f"t = {end * self.step:.3g}", end / last),
                )

    def _move_to(self, end: int) -> None:
        steps, before = end - self.done, self.frame.remembered()
        product = (self.columns, self.diagonal, self.norms)
        self.block = carried(self.frame, steps, self.block, self.longest, *product)
        if not np.isfinite(self.norms).all():
            raise self._lost(before, end)
        self.done = end
        place = int(np.searchsorted(self.marks, end))
        if self.marks[place] == end:
            self.volumes[place] = self.diagonal - self.norms
            self.growth[place] = self.diagonal[0]

    def _lost(self, before: MovingFrame, end: int) -> OrbitLost:
        """Why, by the orbit alone from the last state that was well."""
        frame, steps = self.frame, end - self.done
        T, scheme = steps * self.step, frame.scheme.name
        try:
            integrate(
                frame.chain, *before.orbit(), T, step=self.step, scheme=scheme, samples=1
            )
        except OrbitStopped as stopped:
            steps = round(stopped.time / self.step) + 1
            return OrbitLost((self.done + steps) * self.step, self.step, stopped.bond)
        return OrbitLost(float(end * self.step), self.step)

    def _write(self) -> None:
        assert self.path is not None
        block = np.array([float(self.block)])
        arrays = self._arrays(self.done) | {"block": block}
        write_checkpoint(self.path, self.parameters, self.done, arrays, ALIGNMENT)


def carried(
    frame: MovingFrame,
    steps: int,
    block: int,
    longest: int,
    columns: Floats,
    diagonal: Floats,
    norms: Floats,
) -> int:
    """Moves a frame and the product of its factors; returns the block to go on with."""
    # lazy: numba takes longer to import than all the rest
    from symfpu.chain.bond_loops import run_loop
    from symfpu.dynamics.tangent_loops import carry_frame

    product = columns, diagonal, norms
    arguments = *frame.arguments(), steps, block, longest, *product
    return int(run_loop(carry_frame, frame.law, *arguments))


def seconds_a_step(frame: MovingFrame, block: int) -> float:
    """Processor time of a step of a frame, from as many steps as take TRIAL seconds, about.

    The frame is moved.
    """
    m, steps = frame.vectors, block
    product = np.eye(m), np.zeros(m), np.zeros(m)
    carried(frame, block, block, block, *product)  # compiles
    while True:
        start = time.thread_time()
        carried(frame, steps, block, block, *product)
        seconds = time.thread_time() - start
        if seconds >= TRIAL / 4:
            return seconds / steps
        steps *= 4
