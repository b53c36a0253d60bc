"""What is prescribed of a torus: as many conditions as it has angles.

The unknowns are the coefficients c (H, C) and the shifts omega - Omega (s,). A condition gives
its value, zero where it is met, and its derivatives by both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from symfpu.refinement.invariance import InvarianceEquation, Slopes, WithSlopes
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
    ) -> Slopes:
        """Derivatives of the value by coefficients (H, C) and shifts (s,), in doubles."""
        ...


@dataclass(frozen=True, eq=False)
class Linear:
    """by_amplitude.A + by_shift.shifts = target, relative to a size; s factors of each.

    of_logarithms : whether ln |A| take the place of the amplitudes A of the seeds.
    """

    by_amplitude: Floats
    by_shift: Floats
    target: np.longdouble
    size: Any = 1.0
    of_logarithms: bool = False

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        A = seed_amplitudes(equation, cosines)
        x = np.log(np.abs(A)) if self.of_logarithms else A
        found = self.by_amplitude @ x + self.by_shift @ shifts
        return np.longdouble((found - self.target) / self.size)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> Slopes:
        A, size = seed_amplitudes(equation, cosines), float(self.size)
        slopes = self.by_amplitude / A if self.of_logarithms else self.by_amplitude
        by_cosine = np.zeros(cosines.shape)
        by_cosine[equation.seed_rows, equation.seed_columns] = slopes.astype(float) / size
        return by_cosine, self.by_shift.astype(float) / size


def frequency(place: int, shift: np.longdouble, linear: Sequence[Any]) -> Linear:
    """omega - Omega of a seed (its place among the seeds) is given; linear : Omega of all."""
    s = len(linear)
    return Linear(np.zeros(s), np.eye(s)[place], shift, float(linear[place]))


def amplitude(place: int, A: np.longdouble, s: int) -> Linear:
    """The amplitude of one of s seeds is given."""
    return Linear(np.eye(s)[place], np.zeros(s), A, A)


def resonance(harmonic: Sequence[int], shift: np.longdouble, size: float) -> Linear:
    """nu.omega is, up to its sign, the linear frequency of a mode.

    nu.(omega - Omega) = shift, relative to size, which is that frequency.
    """
    factors = np.array(harmonic)
    return Linear(np.zeros(len(factors)), factors, shift, size)


def amplitude_line(places: tuple[int, int], start: Floats, steps: Floats) -> Linear:
    """The amplitudes of two seeds are on a line: (A - start) of the one to steps as of the other.

    places : of the two among the seeds, the first with a step. start, steps : of all seeds, (s,).
    """
    i, j = places
    factors = np.zeros(len(steps), dtype=np.longdouble)
    factors[j], factors[i] = steps[i], -steps[j]
    return Linear(factors, np.zeros(len(steps)), np.longdouble(factors @ start))


def plane(x: Floats, tangent: Floats, scales: Floats, distance: float) -> Linear:
    """A plane across the way of a family: tangent.(y - x) = distance.

    y are the variables (ln |A| of all seeds, shifts / scales), x a point of the way, (2s,).
    """
    by_amplitude, by_shift = np.split(tangent.astype(np.longdouble), 2)
    target = np.longdouble(tangent @ x + distance)
    return Linear(by_amplitude, by_shift / scales, target, of_logarithms=True)


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
    ) -> Slopes:
        by_cosine = np.zeros(cosines.shape)
        waves = self._waves(equation).astype(float)
        by_cosine[:, equation.seed_columns[self.place]] = waves / self.size
        return by_cosine, np.zeros(len(shifts))

    def _waves(self, equation: InvarianceEquation) -> Floats:
        angles = equation.harmonics @ np.array(self.phases, dtype=np.longdouble)
        return np.asarray(np.cos(angles))


@dataclass(frozen=True)
class Ratio:
    """The amplitude of a seed, or its averaged energy, is a multiple of that of the first one."""

    place: int
    ratio: float
    energies: bool

    def value(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> np.longdouble:
        first, _ = self._of_seed(0, equation, cosines, shifts)
        own, _ = self._of_seed(self.place, equation, cosines, shifts)
        return np.longdouble(own / (self.ratio * first) - 1)

    def gradient(
        self, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> Slopes:
        first, of_first = self._of_seed(0, equation, cosines, shifts)
        own, of_own = self._of_seed(self.place, equation, cosines, shifts)
        factors = 1 / (self.ratio * first), -own / (self.ratio * first**2)
        by_cosine, by_shift = (
            (factors[0] * x + factors[1] * y).astype(float)
            for x, y in zip(of_own, of_first, strict=True)
        )
        return by_cosine, by_shift

    def _of_seed(
        self, place: int, equation: InvarianceEquation, cosines: Floats, shifts: Floats
    ) -> WithSlopes:
        """Its energy or amplitude, and the derivatives."""
        if self.energies:
            return equation.seed_energy(place, cosines, shifts)
        by_cosine = np.zeros(cosines.shape)
        by_cosine[equation.seed_rows[place], equation.seed_columns[place]] = 1
        A = seed_amplitudes(equation, cosines)[place]
        return A, (by_cosine, np.zeros(len(shifts)))


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
    ) -> Slopes:
        _, slopes = equation.energy(cosines, shifts, harmonic=self.harmonic)
        by_cosine, by_shift = ((slope / self.energy).astype(float) for slope in slopes)
        return by_cosine, by_shift


def seed_amplitudes(equation: InvarianceEquation, cosines: Floats) -> Floats:
    """A of every seed, with its sign; shape (s,)."""
    return np.asarray(cosines[equation.seed_rows, equation.seed_columns])


def ratio_conditions(
    seeds: Sequence[int], ratio: Mapping[int, Any], *, energies: bool
) -> list[Condition]:
    """The s - 1 conditions of a ratio, by seed, of amplitudes or of averaged mode energies."""
    first, *others = [float(ratio[q]) for q in seeds]
    return [Ratio(i, other / first, energies) for i, other in enumerate(others, 1)]
