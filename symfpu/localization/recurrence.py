"""When the mode energies of an orbit come back (section 6.4)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.errors import InputError, SymfpuError
from symfpu.localization.profiles import energy_record

Floats = NDArray[np.float64]
NEAR, FAR = 1 / 3, 2 / 3  # of the largest distance: apart, so that wiggles do not cross both


class NoRecurrence(SymfpuError):
    """The mode energies did not come back within the record: raised by `recurrence`.

    T : the end of the record, dimensionless. excursion : the largest fraction of the energy that was
        elsewhere. Ours.
    """

    def __init__(self, T: float, excursion: float) -> None:
        self.T, self.excursion = T, excursion
        super().__init__(
            f"no recurrence until t = {T:.6g}: the energies move {excursion:.3g} of the whole away and do not come back by two thirds; "
            f"record a longer orbit"
        )


@dataclass(frozen=True, eq=False)
class Recurrence:
    """Returns of an orbit to its first mode energies. Made by `recurrence` (section 6.4.3).

    times : (R,), of each visit, in order, in units of the chain (dimensionless).
    returned : (R,), fraction of the harmonic energy that is back in its modes, 1 for all of it.
    excursion : the farthest, the largest fraction that was elsewhere.

    >>> Recurrence(np.array([157.0, 315.0]), np.array([0.97, 0.99]), 0.8)
    Recurrence(2 returns, first at t=157 of 97.0000%, best at t=315 of 99.0000%, up to 0.8 of the energy
    away)
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
        (t, part), (T, most) = self.first, self.best
        return (
            f"Recurrence({len(self.times)} returns, first at t={t:.6g} of {part:.4%}, best at t={T:.6g} of {most:.4%}, "
            f"up to {self.excursion:.3g} of the energy away)"
        )


def recurrence(times: ArrayLike, energies: ArrayLike) -> Recurrence:
    """When the mode energies come back, by the fraction of the energy that is elsewhere, d(t).

    times, energies : (S,) and (S, N-1), E_q(t) sampled densely (`orbit.harmonic_energies()` with
        samples=np.arange(...)); E_q(0) is the first row. Times in units of the chain, energies in any unit.

    d(t) = sum |E_q(t) - E_q(0)| / (2 sum E_q(0)), dimensionless. A return is the deepest minimum of d,
    refined by a parabola, of a visit: a time below a third of the largest d, after and before one above two
    thirds. The last visit may lack its end, but not its minimum. Ours, for the recurrences of section 6.4.3.
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
    d = np.abs(E - E[0]).sum(axis=1) / (2 * whole)
    far, near = np.flatnonzero(d > FAR * d.max()), np.flatnonzero(d < NEAR * d.max())
    # the visits: groups of near samples with a far one between them, without the stay at the
    # beginning
    passed = np.searchsorted(far, near)
    visits = [near[passed == count] for count in np.unique(passed) if count]
    deepest = [int(visit[np.argmin(d[visit])]) for visit in visits]
    found = [place for place in deepest if place < len(d) - 1]
    if not found:
        raise NoRecurrence(float(t[-1]), float(d.max()))
    minima = np.array([_vertex(t[i - 1 : i + 2], d[i - 1 : i + 2]) for i in found])
    return Recurrence(minima[:, 0], 1 - minima[:, 1], float(d.max()))


def _vertex(t: Floats, d: Floats) -> tuple[float, float]:
    """The lowest point of the parabola through three points, the middle one lowest.

    Not below 0, which d cannot be.
    """
    (a, b), (f, g) = np.diff(t), np.diff(d) / np.diff(t)
    curvature = (g - f) / (a + b)
    if not curvature > 0:
        return float(t[1]), float(d[1])
    slope = f + a * curvature
    return float(t[1] - slope / (2 * curvature)), max(0.0, float(d[1] - slope**2 / (4 * curvature)))
