"""What is prescribed of a torus: as many conditions as it has angles.

The unknowns are the coefficients c (H, C) and the shifts omega - Omega (s,). A condition gives
its value, zero where it is met, and its derivatives by both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats


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
        """Derivatives of the value by coefficients (H, C) and shifts (s,), in doubles."""
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
        return np.longdouble(equation.seed_frequencies[self.place])


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
class Start:
    """The coordinate of a seed at t = 0 is given, in terms of another size.

    phases : of all seeds, radians, (s,).
    """

    place: int
    coordinate: np.longdouble
    phases: tuple[float, ...]
    size: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        column = cosines[:, equation.seed_columns[self.place]]
        found = self._waves(equation) @ column
        return np.longdouble((found - self.coordinate) / self.size)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        by_cosine = np.zeros(cosines.shape)
        waves = self._waves(equation).astype(float)
        by_cosine[:, equation.seed_columns[self.place]] = waves / self.size
        return by_cosine, np.zeros(len(shifts))

    def _waves(self, equation: InvarianceEquation) -> Floats:
        angles = equation.harmonics @ np.array(self.phases, dtype=np.longdouble)
        return np.asarray(np.cos(angles))


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


@dataclass(frozen=True, eq=False)
class AmplitudeLine:
    """The amplitudes of two seeds are on a line: (A - start) of the one to steps as of the other.

    places : of the two among the seeds, the first with a step. start, steps : of all seeds, (s,).
    """

    places: tuple[int, int]
    start: Floats
    steps: Floats

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        (i, j), gone = self.places, seed_amplitudes(equation, cosines) - self.start
        return np.longdouble(self.steps[i] * gone[j] - self.steps[j] * gone[i])

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        (i, j), by_cosine = self.places, np.zeros(cosines.shape)
        rows, columns = equation.seed_rows, equation.seed_columns
        by_cosine[rows[j], columns[j]] = self.steps[i]
        by_cosine[rows[i], columns[i]] = -self.steps[j]
        return by_cosine, np.zeros(len(shifts))


@dataclass(frozen=True)
class EnergyRatio:
    """The averaged harmonic energy of a seed mode is a multiple of that of the first one."""

    place: int
    ratio: float

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        first, _ = equation.seed_energy(0, cosines, shifts)
        own, _ = equation.seed_energy(self.place, cosines, shifts)
        return np.longdouble(own / (self.ratio * first) - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        first, of_first = equation.seed_energy(0, cosines, shifts)
        own, of_own = equation.seed_energy(self.place, cosines, shifts)
        factors = 1 / (self.ratio * first), -own / (self.ratio * first**2)
        by_cosine, by_shift = (
            (factors[0] * x + factors[1] * y).astype(float)
            for x, y in zip(of_own, of_first, strict=True)
        )
        return by_cosine, by_shift


@dataclass(frozen=True)
class EnergyLevel:
    """H, or with `harmonic` the harmonic energy sum E_q.

    With fixed ends at the angles zero, of a ring averaged over the angles.
    """

    energy: np.longdouble
    harmonic: bool

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        energy, _ = equation.energy(cosines, shifts, harmonic=self.harmonic)
        return np.longdouble(energy / self.energy - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> tuple[Floats, Floats]:
        _, slopes = equation.energy(cosines, shifts, harmonic=self.harmonic)
        by_cosine, by_shift = ((slope / self.energy).astype(float) for slope in slopes)
        return by_cosine, by_shift


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
