"""The tori on a line between two sets of amplitudes, with fixed ends or of a ring.

Standing waves of a ring are found with fixed ends and unfolded.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from symfpu.normal.modes import NormalModes
from symfpu.normal.search import Between, followed_modes
from symfpu.refinement.conditions import Condition, amplitude_line
from symfpu.refinement.guesses import extrapolated
from symfpu.refinement.tori import NoTorus, refine, refined_torus
from symfpu.tori.torus import Torus
from symfpu.tori.unfolding import folded, unfold

HALVINGS = 6  # of a step to a torus that Newton's method does not reach at once


class Line:
    """Tori between two sets of amplitudes, by the part of the way."""

    def __init__(self, first: Torus, end: Mapping[int, float], members: int) -> None:
        self.start = {q: float(a) for q, a in first.amplitudes.items()}
        self.end = dict(end)
        self.parts = tuple(n / (members - 1) for n in range(members))
        self._chain = first.chain
        self._stands = first.stands
        self._given = first
        self._known: dict[float, Torus] = {0.0: self._found_as(first)}
        self._last: dict[float, Torus] = {}

    def described(self, modes: tuple[int, ...], length: int) -> dict[str, Any]:
        """What two runs of one line have in common."""
        ends = (self.start, self.end)
        ring = {"ends": self._chain.ends, "stands": self._stands}
        return {
            "N": self._chain.N,
            **self._chain.typed_law,
            **(ring if self._chain.periodic else {}),
            "amplitudes": [{str(q): repr(a) for q, a in end.items()} for end in ends],
            "members": len(self.parts),
            "modes": list(modes),
            "resonance_length": length,
        }

    def take(self, members: Sequence[NormalModes]) -> None:
        """Members of a run that was interrupted."""
        pairs = zip(self.parts, members, strict=False)
        self._known |= {part: self._found_as(known.torus) for part, known in pairs}

    def _found_as(self, torus: Torus) -> Torus:
        """Standing waves as the torus of fixed ends that they unfold."""
        if not self._stands:
            return torus
        return folded(torus)

    def _given_as(self, torus: Torus) -> Torus:
        """The reverse of it."""
        if not self._stands:
            return torus
        return unfold(torus)

    def amplitudes(self, part: float) -> dict[int, float]:
        """A_q by seed."""
        return {q: (1 - part) * a + part * self.end[q] for q, a in self.start.items()}

    def torus(self, part: float) -> Torus:
        """From the nearest one that is known, or by halves of the way to it; raises NoTorus."""
        return self._given if part == 0 else self._given_as(self._torus(part))

    def met(self, condition: Condition, part: float) -> tuple[float, Torus]:
        """The one that meets a condition, by Newton's method from a part; with its own."""
        guess: Any = self._torus(part)
        found = refined_torus(guess, [condition, *self._on_the_line()])
        if found.warnings:
            raise NoTorus("it is doubtful", found, found.residual())
        seed = max(self.end, key=lambda q: abs(self.end[q] - self.start[q]))
        start, end = self.start[seed], self.end[seed]
        place = (found.amplitudes[seed] - start) / (end - start)
        return place, self._given_as(found)

    def _on_the_line(self) -> list[Condition]:
        """As many as there are seeds, less one."""
        steps = np.array([self.end[q] - self.start[q] for q in self.start])
        start = np.array([np.longdouble(a) for a in self.start.values()])
        first = int(np.argmax(np.abs(steps)))
        relative = steps / abs(steps[first])
        others = [i for i in range(len(steps)) if i != first]
        return [amplitude_line((first, i), start, relative) for i in others]

    def _torus(self, part: float) -> Torus:
        if part in self._known:
            return self._known[part]
        if part not in self._last:
            self._last[part] = self._reached(part, HALVINGS)
        return self._last[part]

    def _reached(self, part: float, halvings: int) -> Torus:
        nearest = min(self._known, key=lambda p: abs(p - part))
        guess: Any = self._guess(part)
        try:
            found: Torus = refine(guess, amplitudes=self.amplitudes(part))
            return found
        except NoTorus:
            if not halvings:
                raise
        middle = (nearest + part) / 2
        self._known[middle] = self._reached(middle, halvings - 1)
        return self._reached(part, halvings - 1)

    def _guess(self, part: float) -> Torus:
        """On the line through the two nearest, or the nearest."""
        near = sorted(self._known, key=lambda p: abs(p - part))[:2]
        if len(near) == 1:
            return self._known[near[0]]
        last, before = near
        ratio = (part - last) / (last - before)
        earlier, later = (self._known[p].in_doubles() for p in (before, last))
        return extrapolated(earlier, later, ratio)

    def _before(self, n: int) -> Between | None:
        """The tori from the member before to this one, by part of the way; None of the first."""
        if n == 0:
            return None
        low, high = self.parts[n - 1 : n + 1]
        return lambda part: self.torus(low + part * (high - low))

    def modes_at(
        self, n: int, modes: tuple[int, ...], before: list[NormalModes]
    ) -> NormalModes:
        """Normal modes of a member, continued from those of the one before."""
        part = self.parts[n]
        torus = self.torus(part)
        self._known[part] = self._torus(part)
        self._last.clear()
        near = before[0] if before else None
        found, missing = followed_modes(torus, near, modes=modes, between=self._before(n))
        for none in missing.values():
            raise none
        return found
