"""Alignment indices of the paper's orbits: Figs. 1(e), 2(b), 9(d)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.foretold import ForetoldIndices, flow_of, indices_by
from symfpu.dynamics.alignment import AlignmentIndices, alignment_indices, seconds_needed
from symfpu.dynamics.dimension import TorusDimension
from symfpu.dynamics.several_frames import together
from symfpu.files.progress import Progress
from symfpu.paper.starts import printed_row
from symfpu.tori.quasiperiodic import QuasiPeriodic

Floats = NDArray[np.float64]
TIME, FULL_TIME = 1e7, 1e9  # default; the paper's, with --full
# by figure: whose chain, and how many vectors
VECTORS = {"fig1": ("Fig. 1", 5), "fig2": ("Fig. 2", 5), "fig9": ("Fig. 9", 7)}
GALI_STEP = 0.4  # of the tangent map
FORETOLD_TIME, FORETOLD_SAMPLES, FORETOLD_FRAMES = 1e11, 440, 4
SETTLED_DECADES = 0.3  # of the last value of an index


def full_seconds(figure: str) -> float:
    """Processor time that the alignment indices of a figure will take with --full.

    From a short trial.
    """
    label, vectors = VECTORS[figure]
    chain = printed_row(label).chain
    return seconds_needed(chain, FULL_TIME, vectors=vectors, step=GALI_STEP, frames=1)


def figure_alignment(
    name: str, start: tuple[Floats, Floats], tell: Progress, folder: Path, *, full: bool
) -> AlignmentIndices:
    """GALI_2, ... of an orbit of a figure to TIME.

    Or to FULL_TIME, with a checkpoint in the folder.
    """
    label, vectors = VECTORS[name]
    chain = printed_row(label).chain
    T = FULL_TIME if full else TIME
    file = folder / f"{name}-gali.checkpoint" if full else None

    def progress(label: str, fraction: float) -> None:
        tell(f"{name}: GALI, {label} of {T:.0e}", fraction)

    return alignment_indices(
        chain,
        *start,
        T,
        vectors=vectors,
        step=GALI_STEP,
        frames=1,
        file=file,
        progress=progress,
    )


def foretold_frames(torus: QuasiPeriodic, vectors: int) -> tuple[ForetoldIndices, ...]:
    """Alignment indices of an exact torus in closed form, beyond the paper's time; four frames."""
    flow = flow_of(torus)
    times = np.geomspace(1.0, FORETOLD_TIME, FORETOLD_SAMPLES)
    frames = range(FORETOLD_FRAMES)
    return tuple(indices_by(flow, torus, times, vectors, seed) for seed in frames)


def foretold_dimension(frames: tuple[ForetoldIndices, ...], T: float) -> TorusDimension:
    """What frames that are followed to T say together."""
    return together([frame.dimension(T) for frame in frames])


def slopes_text(found: AlignmentIndices) -> str:
    """Slopes and verdict in a line."""
    slopes = ", ".join(f"{s.value:.2f}+-{s.error:.2f}" for s in found.slopes())
    last = f"{found.times[-1]:.0e}"
    verdict = found.dimension().verdict
    return f"slopes {slopes} of G_2..G_{found.vectors} to t = {last}: {verdict}"


def settled_after(
    found: AlignmentIndices, k: int, decades: float = SETTLED_DECADES
) -> float:
    """The time after which log10 G_k stays within so many decades of its last value."""
    values = found.log10_gali[:, k - 2]
    off = np.abs(values - values[-1]) > decades
    if not off.any():
        return float(found.times[0])
    last_off = int(np.flatnonzero(off)[-1])
    return float(found.times[last_off + 1])
