"""Section 6.4.3, the tori that the FPU-trajectory of Fig. 9 is near.

Newton's method with an angle more each time, through the coordinates of the seeds at t = 0: what
is left in the other modes says how far the trajectory is from so many frequencies.

That of five angles takes minutes, so it is a file here. It was found as docs/dynamics.md says ("Up
to seven angles"), from sixteen lines a mode of the trajectory to t = 1e6, by `refine` at given
amplitudes, then at a given start, with 6000 harmonics and again with the 2500 largest of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import as_file, files

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.starts import packet_state
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.numbers.typed import Number
from symfpu.paper.claims import Claim, judged
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import refine
from symfpu.spectral.analysis import frequency_analysis
from symfpu.spectral.near import torus_near
from symfpu.store.saved_file import load
from symfpu.tori.torus import Torus, comes_from

Floats = NDArray[np.float64]

ANGLES = (1, 2, 3)
# time that is analysed, step, lines of each mode, and the least strength of a frequency
TIME, STEP, LINES, LEVEL = 1e5, 0.2, 8, 1e-6
MOST = 1200  # harmonics: residuals below the distances that are compared
LAST_FALL = 2.0  # an angle that takes less off the distance is one too many
NEAR = 0.05  # of the largest coordinate


@dataclass(frozen=True)
class Approach:
    """Distances from an orbit at t = 0 of tori with more and more angles.

    angles : how many. distances : of the coordinates, relative to the largest. residuals : of the
    tori, relative to the largest acceleration. harmonics : how many.
    """

    angles: tuple[int, ...]
    distances: tuple[float, ...]
    residuals: tuple[float, ...]
    harmonics: tuple[int, ...]

    @property
    def falls(self) -> tuple[float, ...]:
        """By what each angle after the first divides the distance."""
        pairs = zip(self.distances, self.distances[1:], strict=False)
        return tuple(before / after for before, after in pairs)


def approach(
    chain: Chain, energy: Number, progress: Progress, angles: Sequence[int] = ANGLES
) -> Approach:
    """Tori of the lowest modes near the FPU-trajectory that starts in mode 1 with an energy."""
    start, momenta = packet_state(chain, (1,), energy)
    progress("fig9: lines of the FPU-trajectory", NO_FRACTION)
    orbit = integrate(chain, start, momenta, TIME, step=STEP, samples=1)
    lines = frequency_analysis(orbit, lines=LINES, level=LEVEL)
    found = []
    for s in angles:
        progress(f"fig9: torus of {s} angles", NO_FRACTION)
        guess = _at_rest(torus_near(lines, range(1, s + 1)))
        coordinates = {q: float(start[q - 1]) for q in guess.seeds}
        near = refine(guess, amplitudes=guess.amplitudes, most_harmonics=MOST)
        torus = refine(near, start=coordinates, most_harmonics=MOST)
        off = distance_from(torus, start)
        found.append((s, off, torus.residual(), len(torus.harmonics)))
    return Approach(*zip(*found, strict=True))


def distance_from(torus: Torus, start: Floats) -> float:
    """How far the torus is from coordinates at t = 0, relative to the largest of them."""
    return float(np.abs(torus.Q(0.0) - start).max() / np.abs(start).max())


def five_angles() -> Torus[Newton]:
    """The torus of five angles whose seeds start where the trajectory of H = 0.014915 does."""
    with as_file(files("symfpu.paper") / "data" / "fig9-torus.symfpu") as path:
        found = load(path)
    assert comes_from(found, Newton)
    return found


def _at_rest(torus: Torus) -> Torus:
    """With phases 0 and pi, those of an orbit that starts at rest."""
    phases = {q: math.pi * round(float(x) / math.pi) for q, x in torus.phases.items()}
    return replace(torus, phases=phases)


def tori_claim(found: Approach) -> Claim:
    """How many frequencies the trajectory has, by the tori that it is near."""
    tori = zip(found.angles, found.distances, found.harmonics, strict=True)
    parts = [f"{s} angles {off:.2g} ({count} harmonics)" for s, off, count in tori]
    falls = ", ".join(f"{fall:.2g}" for fall in found.falls)
    ended = found.falls[-1] < LAST_FALL
    last = "" if ended else ", so that none of these is the last"
    which = "tori by Newton's method through the start of their seeds"
    missed = f"{which} miss it, in the largest coordinate, by: {', '.join(parts)}"
    ours = f"{missed}; an angle more divides the distance by {falls}{last}"
    text = "the dimension of the object associated with the FPU-trajectory is around 5"
    near = found.distances[-1] < NEAR
    return Claim("6.4.3", text, "5", ours, judged(ended and near, near))
