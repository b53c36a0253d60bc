"""What several frames of deviation vectors say together of the torus under one orbit.

Each frame is random: how soon its indices settle depends on it, what they settle to does not.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from symfpu.dynamics.dimension import TorusDimension


def together(found: Sequence[TorusDimension]) -> TorusDimension:
    """The verdict of all frames.

    Chaotic if one frame is: growth is never taken back. Regular if half of the frames are, none
    with another dimension. Undecided else.
    """
    if len(found) == 1:
        return found[0]
    values = tuple(one.value for one in found)
    chaotic = [one for one in found if one.verdict == "chaotic"]
    if chaotic:
        reason = f"{chaotic[0].reason} (in {len(chaotic)} of {len(found)} frames)"
        return TorusDimension("chaotic", None, 0.0, {}, reason, None, values)
    weights = _mean_weights(found)
    said = Counter(one.verdict for one in found if one.value is not None)
    supported = _supported(found)
    if len(said) == 1 and 2 * said.total() >= len(found):
        first = next(one for one in found if one.value is not None)
        reason = f"{first.reason} ({said.total()} of {len(found)} frames)"
        error = _spread(weights, first.value)
        decided = first.verdict, first.value, error, weights, reason
        return TorusDimension(*decided, first.value, values)
    reason = _disagreement(said, found)
    error = _spread(weights, supported)
    return TorusDimension("undecided", None, error, weights, reason, supported, values)


def _mean_weights(found: Sequence[TorusDimension]) -> dict[int, float]:
    every = sorted({s for one in found for s in one.weights})
    return {s: sum(one.weights.get(s, 0.0) for one in found) / len(found) for s in every}


def _spread(weights: Mapping[int, float], about: int | None) -> float:
    """The standard deviation of s about a value, default the heaviest; nan without weights."""
    if not weights:
        return math.nan
    centre = max(weights, key=lambda s: weights[s]) if about is None else about
    return math.sqrt(sum(w * (s - centre) ** 2 for s, w in weights.items()))


def _supported(found: Sequence[TorusDimension]) -> int | None:
    """What most frames support; the smaller one of two."""
    counts = Counter(one.supported for one in found if one.supported is not None)
    return min(counts, key=lambda s: (-counts[s], s), default=None)


def _disagreement(said: Counter[str], found: Sequence[TorusDimension]) -> str:
    """Why frames decide nothing together, with the reason of one that does not."""
    open_ = next((one for one in found if one.value is None), None)
    parts = [f"{word} in {count}" for word, count in said.items()]
    if open_ is None:
        return f"{', '.join(parts)} of {len(found)} frames: take a longer time"
    parts.append(f"undecided in {len(found) - said.total()} of {len(found)} frames")
    return f"{', '.join(parts)}: {open_.reason}"
