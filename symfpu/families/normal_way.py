"""Normal modes along a family: each continued from member to member, with events between them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symfpu.families.continuation import Member, Way
from symfpu.families.normal_events import Known, NormalEvent, Stretch
from symfpu.files.progress import Progress
from symfpu.normal.frequencies import NormalFrequencies, frequencies_of
from symfpu.normal.modes import NormalModes
from symfpu.normal.search import REFINED, followed_modes
from symfpu.refinement.tori import RefinedTorus
from symfpu.tori.quasiperiodic import QuasiPeriodic


class NormalWay:
    """The normal modes of the last two members of a family, and those of the next from them.

    length : the largest sum |nu_i| of resonances whose crossing is an event, or 0.
    """

    def __init__(self, length: int, progress: Progress) -> None:
        self.length, self.progress = length, progress
        self.known: list[NormalModes] = []

    def of(self, torus: QuasiPeriodic) -> NormalFrequencies | None:
        """Those of the next member; None where it does not solve the equations well enough."""
        if not torus.residual() <= REFINED:
            return None
        last = self.known[-1] if self.known else None
        found, missing = followed_modes(torus, last, progress=self.progress)
        self.known = [*self.known[-1:], found]
        return frequencies_of(found, missing)

    def events(
        self, way: Way, first: Member, second: Member, after: int
    ) -> list[NormalEvent]:
        """Between the last two members, the last two tori of the way, along the family itself."""
        if first.normal is None or second.normal is None:
            return []
        self.progress("events of the normal frequencies", 1.0)
        before, last = self.known[-2:]
        start, end = Known(0.0, first.normal, before), Known(1.0, second.normal, last)
        return Stretch(_between(way), start, end, after).events(self.length)


def _between(way: Way) -> Callable[[float], RefinedTorus]:
    """The tori of a family between the last two, by the part of the way along their secant."""
    before, last = way.tori[-2:]
    local = way.local(last, before)
    scales = local.scales()
    difference = local.variables(last, scales) - local.variables(before, scales)
    length = float(np.linalg.norm(difference.astype(float)))
    ends = {0.0: before, 1.0: last}

    def torus(part: float) -> RefinedTorus:
        return ends[part] if part in ends else local.at(-part * length)

    return torus
