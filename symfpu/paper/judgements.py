"""Verdicts that several figures need: profiles that agree, dimensions of tori, cancellations in a
series, sequences of groups.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.profiles import profile_distance
from symfpu.paper.claims import OPEN, Claim, judged
from symfpu.paper.dimensions import slopes_text

Floats = NDArray[np.float64]
SIMILAR = 1.0  # decades in which profiles over thirty decades are alike
# decades in which profiles are the same to the eye: the height of a marker in the paper's
# pictures
AGREEMENT = 0.1
FLOOR = 1e-28  # of the energy: T + V leaves in a mode the squared rounding of all others
SHOWN_GROUPS = 6  # medians in the text
NEAR = 0.5  # decades: a size that the paper gives by its order of magnitude


def same_profile(
    section: str,
    text: str,
    profiles: Mapping[str, Floats],
    first: str,
    second: str,
    *,
    floor: float = FLOOR,
    within: float = AGREEMENT,
) -> Claim:
    """Whether two normalised spectra agree in all modes above a floor.

    In part if they do where the energy is above its square root.
    """
    found = profile_distance(profiles[first], profiles[second], floor)
    upper = profile_distance(profiles[first], profiles[second], floor**0.5)
    ours = (
        f"{first} and {second} differ by at most {found.distance:.2g} decades (mode {found.mode}) in the {found.modes} modes above "
        f"{floor:.0e}, by {upper.distance:.2g} (mode {upper.mode}) in the {upper.modes} above {floor**0.5:.0e}"
    )
    return Claim(
        section, text, "", ours, judged(found.distance <= within, upper.distance <= within)
    )


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
    """Whether the alignment indices show the printed dimension. shown_after : the time from which
    the paper reads its slopes; another dimension that is seen before does not decide. whole : the
    paper's time; what agrees over a part of it is named so.
    """
    verdict, T = found.dimension(), float(found.times[-1])
    same = verdict.verdict == f"regular, dimension {printed}"
    early = not same and shown_after > T
    decided = verdict.verdict != "undecided" and not early
    ours = slopes_text(found) + (f" ({verdict.reason})" if verdict.verdict == "undecided" else "")
    ours += f"; the paper's slopes are those after {shown_after:.0e}" if early else ""
    ours += f"; the paper goes to {whole:.0e}" if same and whole / 2 > T else ""
    return Claim(
        section, text, f"dimension {printed}", ours + more, judged(same) if decided else OPEN
    )


def cancellation_claim(
    section: str, text: str, printed: float, sums: tuple[Floats, Floats], order: int
) -> Claim:
    """Whether S_1 / S_2 has the printed size at an order, in decades.

    In part from half of them on.
    """
    decades = float(np.log10(sums[0][order] / sums[1][order]))
    ours = f"S_1/S_2 = 10^{decades:.2f} at k = {order}"
    return Claim(
        section,
        text,
        f"10^{printed:g}",
        ours,
        judged(abs(decades - printed) <= NEAR, decades >= printed / 2),
    )


def falls(values: Floats, order: int) -> bool:
    """Whether a sum falls from every k to k + 2 up to an order: odd and even orders of one mode
    are series of their own.
    """
    return bool(np.all(values[2 : order + 1] < values[: order - 1]))


def groups_claim(
    section: str, text: str, groups: Sequence[Sequence[int]], spectrum: Floats
) -> Claim:
    """Whether every group of modes lies below the one before, wholly or by its median."""
    levels = [np.log10(spectrum[np.array(modes) - 1]) for modes in groups if len(modes)]
    falling = all(np.median(b) < np.median(a) for a, b in itertools.pairwise(levels))
    apart = sum(bool(b.max() < a.min()) for a, b in itertools.pairwise(levels))
    medians = ", ".join(f"{np.median(g):.1f}" for g in levels[:SHOWN_GROUPS])
    ours = (
        f"median log10 of D_0, D_1, ...: {medians}{', ...' if len(levels) > SHOWN_GROUPS else ''}; {'always' if falling else 'not always'} "
        f"falling; {apart} of {len(levels) - 1} groups lie wholly below the one before"
    )
    return Claim(section, text, "", ours, judged(apart == len(levels) - 1, falling))


def parting_level(a: Floats, b: Floats, decades: float = AGREEMENT) -> tuple[float, int]:
    """The largest energy of a mode in which two spectra differ by more than so many decades, and
    the mode; (0, 0) if there is none.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(np.log10(a) - np.log10(b)) > decades
    if not apart.any():
        return 0.0, 0
    larger = np.where(apart, np.maximum(a, b), 0.0)
    mode = int(np.argmax(larger))
    return float(larger[mode]), mode + 1


def sums_panel(name: str, title: str, q: int, sums: tuple[Floats, Floats]) -> Panel:
    """mu^k S_1(k) and mu^k S_2(k) against the order."""
    orders = np.arange(float(len(sums[0])))
    curves = tuple(
        Curve(rf"$\mu^k S_{i}(k)$", orders, values, style, name=f"mu_k_S{i}")
        for i, (values, style) in enumerate(zip(sums, ("triangles", "points"), strict=True), 1)
    )
    return Panel(
        name,
        title,
        r"order $k$",
        rf"sums of the terms of $Q_{{{q}}}^{{(k)}}$",
        curves,
        ("k", "mu_k_S"),
    )


def runs(modes: tuple[int, ...]) -> str:
    """5, 6, 7, 9 as 5..7, 9."""
    parts: list[list[int]] = []
    for q in modes:
        if parts and q == parts[-1][-1] + 1:
            parts[-1].append(q)
        else:
            parts.append([q])
    return ", ".join(str(p[0]) if len(p) == 1 else f"{p[0]}..{p[-1]}" for p in parts)
