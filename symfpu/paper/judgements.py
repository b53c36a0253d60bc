"""Verdicts that several figures need.

Profiles that agree, dimensions of tori, cancellations in a series, sequences of groups.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.foretold import ForetoldIndices
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.dimension import DECADES
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.profiles import profile_distance
from symfpu.paper.claims import OPEN, Claim, judged
from symfpu.paper.dimensions import (
    FULL_TIME,
    FigureIndices,
    foretold_dimension,
    integrated_text,
    slopes_text,
)

Floats = NDArray[np.float64]
SIMILAR_DECADES = 1.0  # in which profiles over thirty decades are alike
# in which profiles are the same to the eye: the height of a marker in the paper's pictures
SAME_DECADES = 0.1
# of the energy: T + V leaves in a mode the squared rounding of all others
ENERGY_FLOOR = 1e-28
SHOWN_GROUPS = 6  # medians in the text
SIZE_DECADES = (
    0.5  # within which a size is the one that the paper gives by its order of magnitude
)


def same_profile(
    section: str,
    text: str,
    profiles: Mapping[str, Floats],
    first: str,
    second: str,
    *,
    floor: float = ENERGY_FLOOR,
    within: float = SAME_DECADES,
) -> Claim:
    """Whether two normalised spectra agree in all modes above a floor.

    In part if they do where the energy is above its square root.
    """
    high = floor**0.5
    found = profile_distance(profiles[first], profiles[second], floor)
    upper = profile_distance(profiles[first], profiles[second], high)
    ours = f"{first} and {second} differ by at most {found.distance:.2g} decades "
    ours += f"(mode {found.mode}) in the {found.modes} modes above {floor:.0e}, "
    ours += (
        f"by {upper.distance:.2g} (mode {upper.mode}) in the {upper.modes} above {high:.0e}"
    )
    verdict = judged(found.distance <= within, upper.distance <= within)
    return Claim(section, text, "", ours, verdict)


def dimension_claim(
    section: str,
    text: str,
    printed: int,
    found: AlignmentIndices,
    *,
    shown_after: float = 0.0,
    whole: float = 0.0,
    more: str = "",
) -> Claim:
    """Whether the alignment indices show the printed dimension.

    shown_after : the time from which the paper reads its slopes; another dimension that is seen
    before does not decide. whole : the paper's time; what agrees over a part of it is named so.
    """
    verdict = found.dimension()
    last = float(found.times[-1])
    undecided = verdict.verdict == "undecided"
    same = verdict.verdict == f"regular, dimension {printed}"
    early = not same and shown_after > last
    ours = slopes_text(found)
    if undecided:
        ours += f" ({verdict.reason})"
    if early:
        ours += f"; the paper's slopes are those after {shown_after:.0e}"
    if same and whole / 2 > last:
        ours += f"; the paper goes to {whole:.0e}"
    decided = OPEN if undecided or early else judged(same)
    return Claim(section, text, f"dimension {printed}", ours + more, decided)


def foretold_claim(
    section: str,
    text: str,
    printed: int,
    frames: tuple[ForetoldIndices, ...],
    seen: FigureIndices,
    settled: tuple[int, float] | None = None,
) -> Claim:
    """Whether the torus itself shows the printed dimension at the paper's time, in closed form.

    seen : what was integrated, for the evidence. settled : k, and the time from which the paper
    sees G_k constant, which must be within those of the frames; in part if it is not. A frame's is
    where the first stretch of DECADES begins that has the slope of the torus.
    """
    said = foretold_dimension(frames, FULL_TIME)
    rates = ", ".join(f"{rate:.1e}" for rate in frames[0].rates)
    slopes = np.mean(
        [[s.value for s in frame.slopes(FULL_TIME)] for frame in frames], axis=0
    )
    shown = ", ".join(f"{slope:.2f}" for slope in slopes)
    values = ", ".join("none" if s is None else str(s) for s in said.frames)
    ours = f"foretold from the exact torus, its twist and {len(frames)} frames: {said.verdict} "
    ours += f"at {FULL_TIME:.0e} (by frame {values}; mean slopes {shown} "
    ours += f"of G_2..G_{frames[0].vectors}); growth rates {rates}; "
    in_time = True
    if settled is not None:
        in_time, when = _settles(frames, *settled)
        ours += f"{when}; "
    ours += integrated_text(seen)
    same = said.value == printed
    return Claim(
        section, text, f"dimension {printed}", ours, judged(same and in_time, same)
    )


def _settles(frames: tuple[ForetoldIndices, ...], k: int, after: float) -> tuple[bool, str]:
    """Whether the time from which the paper sees G_k constant is one of the frames'."""
    times = [frame.settling()[k] / 10**DECADES for frame in frames]
    when = ", ".join(f"{time:.0e}" for time in sorted(times))
    words = f"G_{k} has the slope of the torus from t = {when} on, "
    words += f"in the paper from {after:.0e}"
    return min(times) <= after <= max(times), words


def cancellation_claim(
    section: str, text: str, printed: float, sums: tuple[Floats, Floats], order: int
) -> Claim:
    """Whether S_1 / S_2 has the printed size at an order, in decades.

    In part from half of them on.
    """
    upper, lower = sums
    decades = float(np.log10(upper[order] / lower[order]))
    ours = f"S_1/S_2 = 10^{decades:.2f} at k = {order}"
    verdict = judged(abs(decades - printed) <= SIZE_DECADES, decades >= printed / 2)
    return Claim(section, text, f"10^{printed:g}", ours, verdict)


def falls(values: Floats, order: int) -> bool:
    """Whether a sum falls from every k to k + 2 up to an order.

    Odd and even orders of one mode are series of their own.
    """
    later = values[2 : order + 1]
    earlier = values[: order - 1]
    return bool(np.all(later < earlier))


def groups_claim(
    section: str, text: str, groups: Sequence[Sequence[int]], spectrum: Floats
) -> Claim:
    """Whether every group of modes lies below the one before, wholly or by its median."""
    levels = [np.log10(spectrum[np.array(modes) - 1]) for modes in groups if len(modes)]
    medians = [np.median(level) for level in levels]
    steps = len(levels) - 1
    falling = all(b < a for a, b in itertools.pairwise(medians))
    apart = sum(bool(b.max() < a.min()) for a, b in itertools.pairwise(levels))
    shown = [f"{median:.1f}" for median in medians[:SHOWN_GROUPS]]
    if len(levels) > SHOWN_GROUPS:
        shown.append("...")
    word = "always" if falling else "not always"
    ours = f"median log10 of D_0, D_1, ...: {', '.join(shown)}; {word} falling; "
    ours += f"{apart} of {steps} groups lie wholly below the one before"
    return Claim(section, text, "", ours, judged(apart == steps, falling))


def parting_level(a: Floats, b: Floats, decades: float = SAME_DECADES) -> tuple[float, int]:
    """The largest energy of a mode in which two spectra differ by more than so many decades.

    And the mode; (0, 0) if there is none.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.abs(np.log10(a) - np.log10(b))
        apart = distance > decades
    if not apart.any():
        return 0.0, 0
    larger = np.where(apart, np.maximum(a, b), 0.0)
    place = int(np.argmax(larger))
    return float(larger[place]), place + 1


def sums_panel(
    name: str,
    title: str,
    q: int,
    sums: tuple[Floats, Floats],
    *,
    columns: Mapping[str, Sequence[Any]] | None = None,
) -> Panel:
    """mu^k S_1(k) and mu^k S_2(k) against the order."""
    upper, lower = sums
    orders = np.arange(float(len(upper)))
    curves = (
        Curve(r"$\mu^k S_1(k)$", orders, upper, "triangles", name="mu_k_S1"),
        Curve(r"$\mu^k S_2(k)$", orders, lower, "points", name="mu_k_S2"),
    )
    labels = (r"order $k$", rf"sums of the terms of $Q_{{{q}}}^{{(k)}}$")
    return Panel(name, title, *labels, curves, ("k", "mu_k_S"), columns=columns)


def runs(modes: tuple[int, ...]) -> str:
    """5, 6, 7, 9 as 5..7, 9."""
    found: list[list[int]] = []
    for q in modes:
        if found and q == found[-1][-1] + 1:
            found[-1].append(q)
        else:
            found.append([q])
    parts = []
    for run in found:
        alone = len(run) == 1
        parts.append(str(run[0]) if alone else f"{run[0]}..{run[-1]}")
    return ", ".join(parts)
