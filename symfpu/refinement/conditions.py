"""What is prescribed of a torus: as many conditions as it has angles.

The unknowns are the coefficients c (H, N-1) and the shifts omega - Omega (s,). A condition gives its value, zero where it is met, and
its derivatives by both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from symfpu.refinement.invariance import Floats, InvarianceEquation


class Condition(Protocol):
    """One equation more."""

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        """What is to be zero, relative to its own size."""
        ...

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        """Derivatives of the value by coefficients (H, N-1) and shifts (s,), in doubles."""
        ...


@dataclass(frozen=True)
class FrequencyShift:
    """omega - Omega of a seed (its place among the seeds) is given."""

    place: int
    shift: np.longdouble

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        return np.longdouble((shifts[self.place] - self.shift) / self._size(equation))

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        by_shift = np.zeros(len(shifts))
        by_shift[self.place] = 1 / float(self._size(equation))
        return np.zeros(cosines.shape), by_shift

    def _size(self, equation: InvarianceEquation) -> np.longdouble:
        return np.longdouble(equation.linear[equation.seed_columns[self.place]])


@dataclass(frozen=True)
class Crossing:
    """nu.omega is, up to its sign, the linear frequency of a mode: nu.(omega - Omega) = shift, whose size is that frequency."""

    harmonic: tuple[int, ...]
    shift: np.longdouble
    size: float

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        return np.longdouble((np.dot(np.array(self.harmonic), shifts) - self.shift) / self.size)

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        return np.zeros(cosines.shape), np.array(self.harmonic) / self.size


@dataclass(frozen=True)
class Amplitude:
    """The amplitude of a seed is given."""

    place: int
    amplitude: np.longdouble

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        return np.longdouble(cosines[equation.seed_rows[self.place], equation.seed_columns[self.place]] / self.amplitude - 1)

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        by_cosine = np.zeros(cosines.shape)
        by_cosine[equation.seed_rows[self.place], equation.seed_columns[self.place]] = 1 / float(self.amplitude)
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class AmplitudeRatio:
    """The amplitude of a seed is a multiple of that of the first one."""

    place: int
    ratio: float

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        A = cosines[equation.seed_rows, equation.seed_columns]
        return np.longdouble(A[self.place] / (self.ratio * A[0]) - 1)

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        by_cosine = np.zeros(cosines.shape)
        A = cosines[equation.seed_rows, equation.seed_columns].astype(float)
        by_cosine[equation.seed_rows[self.place], equation.seed_columns[self.place]] = 1 / (self.ratio * A[0])
        by_cosine[equation.seed_rows[0], equation.seed_columns[0]] = -A[self.place] / (self.ratio * A[0] ** 2)
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class EnergyRatio:
    """The harmonic energy of a seed mode, averaged over the torus, is a multiple of that of the first one."""

    place: int
    ratio: float

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        averages = self._averages(equation, cosines, shifts)[0]
        return np.longdouble(averages[self.place] / (self.ratio * averages[0]) - 1)

    def _averages(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats, Floats]:
        weights = np.where((equation.harmonics != 0).any(axis=1), 0.25, 0.5)[:, None]
        rates, columns = equation.rates(shifts)[:, None], equation.seed_columns
        sizes = weights * (rates**2 + equation.linear[columns] ** 2)
        return (sizes * cosines[:, columns] ** 2).sum(axis=0), sizes, 2 * weights * rates

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        averages, sizes, slopes = self._averages(equation, cosines, shifts)
        by_cosine, by_shift = np.zeros(cosines.shape), np.zeros(len(shifts))
        for i, factor in ((self.place, 1 / (self.ratio * averages[0])), (0, -averages[self.place] / (self.ratio * averages[0] ** 2))):
            column = equation.seed_columns[i]
            c = cosines[:, column]
            by_cosine[:, column] += (factor * 2 * sizes[:, i] * c).astype(float)
            by_shift += (factor * ((slopes[:, 0] * c**2) @ equation.harmonics)).astype(float)
        return by_cosine, by_shift


@dataclass(frozen=True)
class Energy:
    """H, or with `harmonic` the harmonic energy sum E_q, at the angles zero, where the momenta vanish."""

    energy: np.longdouble
    harmonic: bool

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        Q = cosines.sum(axis=0)
        energy = (equation.linear**2 * Q**2).sum() / 2 if self.harmonic else equation.potential(Q)
        return np.longdouble(energy / self.energy - 1)

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        Q = cosines.sum(axis=0)
        slope = equation.linear**2 * Q if self.harmonic else equation.potential_slope(Q)
        row = (slope / self.energy).astype(float)
        return np.broadcast_to(row, cosines.shape) * equation.mask, np.zeros(len(shifts))


@dataclass(frozen=True)
class Plane:
    """A plane across the way of a family: tangent.(x - x_0) = distance in the variables (ln A of all seeds, shifts / scale)."""

    start: tuple[np.longdouble, ...]
    tangent: tuple[float, ...]
    scales: tuple[float, ...]
    distance: float

    def value(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> np.longdouble:
        x = plane_variables(equation, cosines, shifts, self.scales)
        return np.longdouble(np.dot(np.array(self.tangent), x - np.array(self.start)) - self.distance)

    def gradient(self, equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        s = len(shifts)
        A = cosines[equation.seed_rows, equation.seed_columns].astype(float)
        by_cosine = np.zeros(cosines.shape)
        by_cosine[equation.seed_rows, equation.seed_columns] = np.array(self.tangent[:s]) / A
        return by_cosine, np.array(self.tangent[s:]) / np.array(self.scales)


def plane_variables(equation: InvarianceEquation, cosines: Floats, shifts: Floats, scales: Sequence[float]) -> Floats:
    """(ln |A| of the seeds, shifts in units of scales), shape (2s,)."""
    A = cosines[equation.seed_rows, equation.seed_columns]
    return np.concatenate([np.log(np.abs(A)), shifts / np.array(scales)])


def ratio_conditions(seeds: Sequence[int], ratio: Mapping[int, Any], *, energies: bool) -> list[Condition]:
    """The s - 1 conditions of a ratio of amplitudes, or of averaged mode energies, given by seed."""
    kind = EnergyRatio if energies else AmplitudeRatio
    return [kind(i, float(ratio[q]) / float(ratio[seeds[0]])) for i, q in enumerate(seeds) if i]
