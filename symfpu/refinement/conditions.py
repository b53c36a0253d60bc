"""What is prescribed of a torus: as many conditions as it has angles.

The unknowns are the coefficients c (H, N-1) and the shifts omega - Omega (s,). A condition gives
its value, zero where it is met, and its derivatives by both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from symfpu.refinement.invariance import Floats, InvarianceEquation


class Condition(Protocol):
    """One equation more."""

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        """What is to be zero, relative to its own size."""
        ...

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        """Derivatives of the value by coefficients (H, N-1) and shifts (s,), in doubles."""
        ...


@dataclass(frozen=True)
class FrequencyShift:
    """omega - Omega of a seed (its place among the seeds) is given."""

    place: int
    shift: np.longdouble

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        off = shifts[self.place] - self.shift
        return np.longdouble(off / self._size(equation))

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        by_shift = np.zeros(len(shifts))
        by_shift[self.place] = 1 / float(self._size(equation))
        return np.zeros(cosines.shape), by_shift

    def _size(self, equation: InvarianceEquation) -> np.longdouble:
        column = equation.seed_columns[self.place]
        return np.longdouble(equation.linear[column])


@dataclass(frozen=True)
class Crossing:
    """nu.omega is, up to its sign, the linear frequency of a mode.

    nu.(omega - Omega) = shift, relative to size, which is that frequency.
    """

    harmonic: tuple[int, ...]
    shift: np.longdouble
    size: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        moved = np.dot(np.array(self.harmonic), shifts)
        return np.longdouble((moved - self.shift) / self.size)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        by_shift = np.array(self.harmonic) / self.size
        return np.zeros(cosines.shape), by_shift


@dataclass(frozen=True)
class Amplitude:
    """The amplitude of a seed is given."""

    place: int
    amplitude: np.longdouble

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        A = seed_amplitudes(equation, cosines)[self.place]
        return np.longdouble(A / self.amplitude - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        row, column = equation.seed_rows[self.place], equation.seed_columns[self.place]
        by_cosine = np.zeros(cosines.shape)
        by_cosine[row, column] = 1 / float(self.amplitude)
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class AmplitudeRatio:
    """The amplitude of a seed is a multiple of that of the first one."""

    place: int
    ratio: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        A = seed_amplitudes(equation, cosines)
        expected = self.ratio * A[0]
        return np.longdouble(A[self.place] / expected - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        by_cosine = np.zeros(cosines.shape)
        rows, columns = equation.seed_rows, equation.seed_columns
        A = seed_amplitudes(equation, cosines).astype(float)
        by_cosine[rows[self.place], columns[self.place]] = 1 / (self.ratio * A[0])
        by_cosine[rows[0], columns[0]] = -A[self.place] / (self.ratio * A[0] ** 2)
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class EnergyRatio:
    """The averaged harmonic energy of a seed mode is a multiple of that of the first one."""

    place: int
    ratio: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        averages = self._averages(equation, cosines, shifts)[0]
        expected = self.ratio * averages[0]
        return np.longdouble(averages[self.place] / expected - 1)

    def _averages(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """The averages by seed, what multiplies c^2 in them, and its derivative by rates."""
        moving = (equation.harmonics != 0).any(axis=1)
        weights = np.where(moving, 0.25, 0.5)[:, None]
        rates, columns = equation.rates(shifts)[:, None], equation.seed_columns
        sizes = weights * (rates**2 + equation.linear[columns] ** 2)
        averages = (sizes * cosines[:, columns] ** 2).sum(axis=0)
        return averages, sizes, 2 * weights * rates

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        averages, sizes, slopes = self._averages(equation, cosines, shifts)
        by_cosine, by_shift = np.zeros(cosines.shape), np.zeros(len(shifts))
        own = 1 / (self.ratio * averages[0])
        first = -averages[self.place] / (self.ratio * averages[0] ** 2)
        for i, factor in ((self.place, own), (0, first)):
            column = equation.seed_columns[i]
            c = cosines[:, column]
            by_cosine[:, column] += (factor * 2 * sizes[:, i] * c).astype(float)
            turning = (slopes[:, 0] * c**2) @ equation.harmonics
            by_shift += (factor * turning).astype(float)
        return by_cosine, by_shift


@dataclass(frozen=True)
class Energy:
    """H, or with `harmonic` the harmonic energy sum E_q, at the angles zero.

    The momenta vanish there.
    """

    energy: np.longdouble
    harmonic: bool

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        Q = cosines.sum(axis=0)
        harmonic = (equation.linear**2 * Q**2).sum() / 2
        energy = harmonic if self.harmonic else equation.potential(Q)
        return np.longdouble(energy / self.energy - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        Q = cosines.sum(axis=0)
        slope = equation.linear**2 * Q if self.harmonic else equation.potential_slope(Q)
        row = (slope / self.energy).astype(float)
        by_cosine = np.broadcast_to(row, cosines.shape) * equation.mask
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class Plane:
    """A plane across the way of a family: tangent.(x - x_0) = distance.

    x are the variables (ln A of all seeds, shifts / scale).
    """

    start: tuple[np.longdouble, ...]
    tangent: tuple[float, ...]
    scales: tuple[float, ...]
    distance: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        x = plane_variables(equation, cosines, shifts, self.scales)
        gone = np.dot(np.array(self.tangent), x - np.array(self.start))
        return np.longdouble(gone - self.distance)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        s, tangent = len(shifts), np.array(self.tangent)
        A = seed_amplitudes(equation, cosines).astype(float)
        by_cosine = np.zeros(cosines.shape)
        by_cosine[equation.seed_rows, equation.seed_columns] = tangent[:s] / A
        by_shift = tangent[s:] / np.array(self.scales)
        return by_cosine, by_shift


def seed_amplitudes(equation: InvarianceEquation, cosines: Floats) -> Floats:
    """A of every seed, with its sign; shape (s,)."""
    return np.asarray(cosines[equation.seed_rows, equation.seed_columns])


def plane_variables(
    equation: InvarianceEquation, cosines: Floats, shifts: Floats, scales: Sequence[float]
) -> Floats:
    """(ln |A| of the seeds, shifts in units of scales), shape (2s,)."""
    A = seed_amplitudes(equation, cosines)
    scaled = shifts / np.array(scales)
    return np.concatenate([np.log(np.abs(A)), scaled])


def ratio_conditions(
    seeds: Sequence[int], ratio: Mapping[int, Any], *, energies: bool
) -> list[Condition]:
    """The s - 1 conditions of a ratio, by seed, of amplitudes or of averaged mode energies."""
    kind = EnergyRatio if energies else AmplitudeRatio
    first, *others = [float(ratio[q]) for q in seeds]
    return [kind(i, other / first) for i, other in enumerate(others, 1)]
