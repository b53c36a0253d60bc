"""Fig. 6: orders of first excitation around three packets."""

from __future__ import annotations

from dataclasses import dataclass

from symfpu.chain.propagation import excitation_sequence, reachable_modes
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.printed import FIG6_CHAIN, FIG6_WIDTH


def figure6_claims(data: Figure6) -> PaperFigure:
    """The intervals M_k of section 6.3 against the rule."""
    claims = tuple(_intervals(data, panel) for panel in data.panels)
    return PaperFigure("fig6", "Fig. 6: what section 6.3 says of it", (), claims)


def _intervals(data: Figure6, panel: str) -> Claim:
    N, seeds = data.N, data.panels[panel][0]
    center, width = (seeds[0] + seeds[-1]) // 2, (seeds[-1] - seeds[0]) // 2
    last = N // (4 * width) - 1  # before the intervals meet
    sets = reachable_modes(N, seeds, last)
    wrong = [
        k
        for k in range(1, last + 1)
        if set(sets[k]) != _interval_modes(N, center, width * (k + 1), k)
    ]
    ours = f"N = {N}, packets of {len(seeds)} modes: M_k as stated for {'all' if not wrong else f'all but {wrong} of'} k = 1 .. {last}"
    text = f"kappa_0 = {center / N:g}: M_k are intervals of half-width epsilon (k+1) around the places listed"
    return Claim("6.3", text, "", ours, judged(not wrong))


def _interval_modes(N: int, center: int, half: int, k: int) -> set[int]:
    """Modes of the printed intervals of M_k."""
    if k % 2 == 0:
        places = [center] if 2 * center == N else [N // 4, 3 * N // 4]
    elif 2 * center == N:
        places = [0, N]
    else:
        places = [0, N // 2] + ([N] if k > 1 else [])
    return {q for place in places for q in range(place - half, place + half + 1) if 1 <= q <= N - 1}


@dataclass(frozen=True)
class Figure6:
    """Order at which each mode is first excited by packets around N/4, N/2, 3N/4 (alpha).

    Seeds and orders by panel.
    """

    N: int
    panels: dict[str, tuple[tuple[int, ...], dict[int, int]]]


def figure6() -> Figure6:
    """Compute the data of Fig.

    6: packets of half-width FIG6_WIDTH modes, up to the order that excites every mode.
    """
    N, w = FIG6_CHAIN, FIG6_WIDTH
    panels = {}
    for panel, quarter in zip("abc", (1, 2, 3), strict=True):
        seeds = tuple(range(quarter * N // 4 - w, quarter * N // 4 + w + 1))
        sequence = excitation_sequence(N, seeds, N // w)
        panels[panel] = (seeds, {q: k for k, modes in enumerate(sequence) for q in modes})
    return Figure6(N, panels)
