"""Normal modes along a family: each continued from member to member, with events between them."""

from __future__ import annotations

import numpy as np

from symfpu.families.continuation import Way
from symfpu.families.members import Member
from symfpu.families.normal_events import Known, NormalEvent, Stretch
from symfpu.files.progress import Progress
from symfpu.normal.frequencies import NormalFrequencies, frequencies_of
from symfpu.normal.modes import NormalModes
from symfpu.normal.search import followed_modes
from symfpu.normal.torus import REFINED
from symfpu.refinement.conditions import Condition
from symfpu.refinement.lattice import Floats
from symfpu.refinement.newton import Newton
from symfpu.tori.torus import Torus


class NormalWay:
    """The normal modes of the last two members of a family, and those of the next from them.

    length : the largest sum |nu_i| of resonances whose crossing is an event, or 0.
    """

    def __init__(self, length: int, progress: Progress) -> None:
        self.length, self.progress = length, progress
        self.known: list[NormalModes] = []

    def of(self, torus: Torus, way: Way | None = None) -> NormalFrequencies | None:
        """Those of the next member; None where it does not solve the equations well enough.

        way : its last two tori are the member before and this one.
        """
        if not torus.residual() <= REFINED:
            return None
        last = self.known[-1] if self.known else None
        between = None
        if way and last and way.tori[-2].frequencies == last.torus.frequencies:
            between = _Between(way).torus
        found, missing = followed_modes(
            torus, last, between=between, progress=self.progress
        )
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
        return Stretch(_Between(way), start, end, after).events(self.length)


class _Between:
    """The tori of a family between the last two, by the part of the way along their secant."""

    def __init__(self, way: Way) -> None:
        self._way, self._ends = way, way.tori[-2:]
        before, last = self._ends
        self._local = way.local(last, before)
        self._scales = self._local.scales()
        self._secant = self._variables(last) - self._variables(before)
        self._length = float(np.linalg.norm(self._secant))

    def torus(self, part: float) -> Torus[Newton]:
        """The one at a part."""
        if part in (0.0, 1.0):
            return self._ends[int(part)]
        return self._local.at(-part * self._length)

    def met(self, condition: Condition, part: float) -> tuple[float, Torus[Newton]]:
        """The one that meets a condition, by Newton's method from a part; with its own."""
        found = self._way.meeting(condition, self.torus(part))
        gone = self._variables(found) - self._variables(self._ends[0])
        return float(gone @ self._secant) / self._length**2, found

    def _variables(self, torus: Torus[Newton]) -> Floats:
        return self._local.variables(torus, self._scales).astype(float)
