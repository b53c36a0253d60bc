"""Alignment indices of the paper's orbits: Figs. 1(e), 2(b), 9(d)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.foretold import ForetoldIndices, flow_of, indices_by
from symfpu.dynamics.alignment import AlignmentIndices, alignment_indices, seconds_needed
from symfpu.dynamics.dimension import DECADES, ODDNESS, TorusDimension, fits
from symfpu.dynamics.several_frames import together
from symfpu.figures.alignment import alignment_panel
from symfpu.figures.panels import Panel
from symfpu.files.progress import Progress
from symfpu.paper.starts import printed_row
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
Start = tuple[Floats, Floats]
TIME, FULL_TIME = 1e7, 1e9  # default, at the latest; the paper's, with --full
# times at which it is looked whether what is foretold is confirmed, and the least growth of
# log |v_1| by then
STAGES, SEEN_GROWTH = (1e6, 3e6), 1.0
# by figure: whose chain, and how many vectors
VECTORS = {"fig1": ("Fig. 1", 5), "fig2": ("Fig. 2", 5), "fig9": ("Fig. 9", 7)}
# of the tangent map: of --full, and of what only confirms a forecast, whose slopes it moves by
# hundredths (docs/performance.md)
GALI_STEP, CONFIRMING_STEP = 0.4, 0.8
FORETOLD_TIME, FORETOLD_SAMPLES, FORETOLD_FRAMES = 1e11, 440, 4
FIRST_LOOK = 5.0  # decades of time, from which it is looked which dimension frames show


class Foretold(NamedTuple):
    """Indices in closed form, of the frame that is integrated.

    times : (S,). log10_gali : (S, vectors-1). growth : log |v_1|, (S,).
    """

    times: Floats
    log10_gali: Floats
    growth: Floats


Foretell = Callable[[Floats], Foretold]


@dataclass(frozen=True, eq=False)
class FigureIndices:
    """Alignment indices of an orbit of a figure.

    found : integrated. there : foretold at the same times, None if nothing is. beyond : foretold to
    the paper's time. confirmed : whether what was integrated confirms what is foretold.
    """

    found: AlignmentIndices
    there: Foretold | None = None
    beyond: Foretold | None = None
    confirmed: bool = False


def full_seconds(figure: str) -> float:
    """Processor time that the alignment indices of a figure will take with --full.

    From a short trial.
    """
    label, vectors = VECTORS[figure]
    chain = printed_row(label).chain
    return seconds_needed(chain, FULL_TIME, vectors=vectors, step=GALI_STEP, frames=1)


def figure_alignment(
    name: str, start: Start, tell: Progress, folder: Path, foretell: Foretell, *, full: bool
) -> FigureIndices:
    """GALI_2, ... of an orbit of a figure, integrated until they confirm what is foretold.

    To TIME at the latest; or to FULL_TIME, with a checkpoint in the folder, and nothing foretold.
    """
    if full:
        file = folder / f"{name}-gali.checkpoint"
        found = _integrated(name, start, FULL_TIME, GALI_STEP, file, tell)
        return FigureIndices(found)
    stages = [T for T in STAGES if T < TIME] + [TIME]
    with TemporaryDirectory() as kept:
        for T in stages:
            file = Path(kept) / "gali.checkpoint"
            found = _integrated(name, start, T, CONFIRMING_STEP, file, tell)
            there = foretell(found.times)
            if confirms(found, there):
                break
    times = np.geomspace(1.0, FULL_TIME, FORETOLD_SAMPLES)
    return FigureIndices(found, there, foretell(times), confirmed=confirms(found, there))


def _integrated(
    name: str, start: Start, T: float, step: float, file: Path, tell: Progress
) -> AlignmentIndices:
    """To a time, going on from the file where it holds a shorter run."""
    label, vectors = VECTORS[name]

    def progress(label: str, fraction: float) -> None:
        tell(f"{name}: GALI, {label} of {T:.0e}", fraction)

    return alignment_indices(
        printed_row(label).chain,
        *start,
        T,
        vectors=vectors,
        step=step,
        frames=1,
        file=file,
        progress=progress,
    )


def confirms(found: AlignmentIndices, foretold: Foretold) -> bool:
    """Whether integrated indices have the slopes that are foretold, where growth shows already.

    To ODDNESS in the last decades, as a verdict asks for; the first vector has grown by
    SEEN_GROWTH, in both: before, all indices of any torus are constant.
    """
    seen = float(found.lyapunov[-1] * found.times[-1]), float(foretold.growth[-1])
    return min(seen) >= SEEN_GROWTH and slopes_apart(found, foretold) <= ODDNESS


def slopes_apart(found: AlignmentIndices, foretold: Foretold) -> float:
    """The largest difference of slopes over the last decades."""
    due = fits(foretold.times, foretold.log10_gali, DECADES)
    pairs = zip(found.slopes(), due, strict=True)
    return max(abs(slope.value - value) for slope, (value, _) in pairs)


def levels_apart(found: AlignmentIndices, foretold: Foretold) -> float:
    """The largest distance of two indices over the last decades, in decades, by the mean."""
    late = found.times >= found.times[-1] / 10**DECADES
    off = (found.log10_gali - foretold.log10_gali)[late].mean(axis=0)
    return float(np.abs(off).max())


class TorusForecast:
    """Alignment indices of an exact torus in closed form."""

    def __init__(self, torus: Torus, vectors: int) -> None:
        self._torus, self._vectors, self._flow = torus, vectors, flow_of(torus)

    def __call__(self, times: Floats) -> Foretold:
        """Of the frame that is integrated."""
        found = indices_by(self._flow, self._torus, times, self._vectors, 0)
        return Foretold(times, found.log10_gali, found.growth)

    def frames(self) -> tuple[ForetoldIndices, ...]:
        """Of four frames, beyond the paper's time."""
        times = np.geomspace(1.0, FORETOLD_TIME, FORETOLD_SAMPLES)
        frames = range(FORETOLD_FRAMES)
        return tuple(
            indices_by(self._flow, self._torus, times, self._vectors, seed)
            for seed in frames
        )


def foretold_dimension(frames: tuple[ForetoldIndices, ...], T: float) -> TorusDimension:
    """What frames that are followed to T say together."""
    return together([frame.dimension(T) for frame in frames])


def first_shown(frames: tuple[ForetoldIndices, ...]) -> dict[int, float]:
    """The first time, of two in a decade, at which frames show a dimension together."""
    found: dict[int, float] = {}
    last = float(np.log10(frames[0].times[-1]))
    for T in 10 ** np.arange(FIRST_LOOK, last + 0.25, 0.5):
        value = foretold_dimension(frames, float(T)).value
        if value is not None:
            found.setdefault(value, float(T))
    return found


def indices_panel(name: str, title: str, seen: FigureIndices) -> Panel:
    """What was integrated, and beyond it what is foretold."""
    if seen.beyond is None:
        return alignment_panel(name, title, seen.found)
    beyond = (seen.beyond.times, seen.beyond.log10_gali)
    return alignment_panel(name, title, seen.found, beyond)


def integrated_text(seen: FigureIndices) -> str:
    """What was integrated, and how far it confirms what is foretold."""
    text = f"integrated: {slopes_text(seen.found)}"
    if seen.there is None:
        return text
    word = "those" if seen.confirmed else "not those"
    slopes, levels = (
        slopes_apart(seen.found, seen.there),
        levels_apart(seen.found, seen.there),
    )
    text += f"; slopes are {word} foretold for the same frame, to {slopes:.2f}; "
    return f"{text}levels are off by up to {levels:.2f} decades"


def slopes_text(found: AlignmentIndices) -> str:
    """Slopes and verdict in a line."""
    slopes = ", ".join(f"{s.value:.2f}+-{s.error:.2f}" for s in found.slopes())
    last = f"{found.times[-1]:.0e}"
    verdict = found.dimension().verdict
    return f"slopes {slopes} of G_2..G_{found.vectors} to t = {last}: {verdict}"
