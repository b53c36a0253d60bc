"""What is known of the last torus of Newton's method: whether it is one, and what ends it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from symfpu.numbers.counted import short
from symfpu.refinement.newton import Newton
from symfpu.refinement.resonances import NearResonance
from symfpu.refinement.tori import NoTorus
from symfpu.tori.torus import Torus

SHARPER = 1e-2  # of the tolerance to which a torus was found, to confirm it
Json = dict[str, Any]


def confirmation(torus: Torus[Newton], refined: Callable[[float], Torus[Newton]]) -> Json:
    """The same torus with more harmonics, to a hundredth of the residual, as JSON holds it.

    refined : the torus to SHARPER of the tolerance it was found with, given that factor.

    change : the largest relative change of an amplitude or a frequency; failure : why it could
    not be refined, or what the sharper one leaves.
    """
    try:
        sharper = refined(SHARPER)
    except NoTorus as failure:
        return {"failure": failure.reason}
    amplitudes = [sharper.amplitudes[q] / torus.amplitudes[q] for q in torus.seeds]
    pairs = zip(sharper.frequencies, torus.frequencies, strict=True)
    frequencies = [float(new / old) for new, old in pairs]
    return {
        "harmonics": len(sharper.harmonics),
        "residual": short(float(sharper.residual())),
        "change": short(max(abs(ratio - 1) for ratio in (*amplitudes, *frequencies))),
        "failure": "; ".join(sharper.warnings),
    }


def vanishing_divisor(
    before: tuple[float, Torus[Newton]], last: tuple[float, Torus[Newton]], above: float
) -> NearResonance | None:
    """The divisor that is zero before the place `above` if it goes on as between two tori.

    before, last : places and tori. Of several the one with the largest coefficient; None if there
    is none: each falls by no more than its size, in a straight line over the logarithm of place.
    """
    past = _by_name(before[1])
    step = math.log(last[0] / before[0])
    ahead = math.log(above / last[0])
    found = []
    for name, now in _by_name(last[1]).items():
        if name not in past:
            continue
        slope = (now.divisor - past[name].divisor) / step
        if now.divisor * (now.divisor + slope * ahead) <= 0:
            found.append(now)
    return max(found, key=lambda resonance: abs(resonance.coefficient), default=None)


def _by_name(torus: Torus[Newton]) -> Mapping[tuple[Any, ...], NearResonance]:
    return {(near.mode, near.harmonic): near for near in torus.origin.near_resonances}
