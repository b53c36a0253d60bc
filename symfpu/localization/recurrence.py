"""When the mode energies of an orbit come back (section 6.4)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.errors import InputError, SymfpuError
from symfpu.localization.profiles import energy_record
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Table

Floats = NDArray[np.float64]
# of the largest distance: apart, so that wiggles do not cross both
NEAR_SHARE = 1 / 3
FAR_SHARE = 2 / 3


class NoRecurrence(SymfpuError):
    """The mode energies did not come back within the record: raised by `recurrence`.

    T : the end of the record, dimensionless. excursion : the largest fraction of the energy that
        was elsewhere. Ours.
    """

    def __init__(self, T: float, excursion: float) -> None:
        self.T = T
        self.excursion = excursion
        moved = f"the energies move {excursion:.3g} of the whole away"
        super().__init__(
            f"no recurrence until t = {T:.6g}: {moved} and do not come back by two thirds; "
            "record a longer orbit"
        )


@dataclass(frozen=True, eq=False)
class Recurrence(Tabled):
    """Returns of an orbit to its first mode energies. Made by `recurrence` (section 6.4.3).

    times : (R,), of each visit, in order, in units of the chain (dimensionless).
    returned : (R,), fraction of the harmonic energy that is back in its modes, 1 for all of it.
    excursion : the farthest, the largest fraction that was elsewhere.

    >>> Recurrence(np.array([157.0, 315.0]), np.array([0.97, 0.99]), 0.8)
    Recurrence(2 returns, first at t=157 of 97.0000%, best at t=315 of 99.0000%,
    up to 0.8 of the energy away)
    >>> Recurrence(np.array([157.0, 315.0]), np.array([0.97, 0.99]), 0.8).to_frame()
        time  returned
    0  157.0      0.97
    1  315.0      0.99
    """

    times: Floats = field(repr=False)
    returned: Floats = field(repr=False)
    excursion: float

    @property
    def first(self) -> tuple[float, float]:
        """Time and fraction of the first return."""
        return float(self.times[0]), float(self.returned[0])

    @property
    def best(self) -> tuple[float, float]:
        """Time and fraction of the most complete return."""
        place = int(np.argmax(self.returned))
        return float(self.times[place]), float(self.returned[place])

    def __repr__(self) -> str:
        time, part = self.first
        first = f"first at t={time:.6g} of {part:.4%}"
        time, part = self.best
        best = f"best at t={time:.6g} of {part:.4%}"
        away = f"up to {self.excursion:.3g} of the energy away"
        return f"Recurrence({counted(len(self.times), 'return')}, {first}, {best}, {away})"

    def _table(self) -> Table:
        columns = {"time": self.times, "returned": self.returned}
        return Table(columns, attributes(self, excursion=self.excursion))


@public
def recurrence(times: ArrayLike, energies: ArrayLike) -> Recurrence:
    """When the mode energies come back, by the fraction of the energy that is elsewhere, d(t).

    times, energies : (S,) and (S, N-1), E_q(t) sampled densely (`orbit.harmonic_energies()` with
        samples=np.arange(...)); E_q(0) is the first row. Times in units of the chain, energies in
        any unit.

    d(t) = sum |E_q(t) - E_q(0)| / (2 sum E_q(0)), dimensionless. A return is the deepest minimum
    of d, refined by a parabola, of a visit: a time below a third of the largest d, after and
    before one above two thirds. The last visit may lack its end, but not its minimum. Ours, for
    the recurrences of section 6.4.3.
    Raises InputError, NoRecurrence.

    >>> t = np.linspace(0, 15, 151)
    >>> recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1)).first
    (6.28..., 0.999...)
    """
    t, E = energy_record(times, energies, "energies")
    whole = E[0].sum()
    if not whole > 0:
        raise InputError(
            "energies",
            float(whole),
            "a positive energy at the first time",
            "pass those of an orbit that moves",
        )
    elsewhere = np.abs(E - E[0]).sum(axis=1)
    d = elsewhere / (2 * whole)
    excursion = float(d.max())
    minima = []
    for deepest in _deepest(d):
        around = slice(deepest - 1, deepest + 2)
        minima.append(_vertex(t[around], d[around]))
    if not minima:
        raise NoRecurrence(float(t[-1]), excursion)
    returns, depths = np.array(minima).T
    return Recurrence(returns, 1 - depths, excursion)


def _deepest(d: Floats) -> list[int]:
    """The sample of the least d of every visit, unless it is the last of the record."""
    far = np.flatnonzero(d > FAR_SHARE * d.max())
    near = np.flatnonzero(d < NEAR_SHARE * d.max())
    # a visit: near samples without a far one between them; none before is the stay at the beginning
    far_before = np.searchsorted(far, near)
    found = []
    for count in np.unique(far_before[far_before > 0]):
        visit = near[far_before == count]
        deepest = int(visit[np.argmin(d[visit])])
        if deepest < len(d) - 1:
            found.append(deepest)
    return found


def _vertex(t: Floats, d: Floats) -> tuple[float, float]:
    """The lowest point of the parabola through three points, the middle one lowest.

    Not below 0, which d cannot be.
    """
    steps = np.diff(t)
    falling, rising = np.diff(d) / steps
    curvature = (rising - falling) / (steps[0] + steps[1])
    if not curvature > 0:
        return float(t[1]), float(d[1])
    slope = falling + steps[0] * curvature
    time = t[1] - slope / (2 * curvature)
    depth = d[1] - slope**2 / (4 * curvature)
    return float(time), max(0.0, float(depth))
