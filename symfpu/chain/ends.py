"""What the ends of a chain decide: its particles, its modes and the transform between them.

Fixed ends: N - 1 particles between two walls, standing waves q = 1 .. N-1. A ring: N particles
whose total momentum and mean position are zero, travelling waves q = -(N-1)/2 .. N/2 without 0.
With `turn` the period of wave numbers, 2N or N, both have Omega_q = 2 |sin(q pi / turn)|, and the
chain of N bonds with fixed ends is the odd part of the ring of 2N.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, ClassVar

import mpmath
import numpy as np
from numpy.typing import ArrayLike

from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    Arithmetic,
    Numbers,
    arithmetic_of,
    mpf,
    sine_matrix,
)
from symfpu.numbers.typed import distinct_modes, seed_modes

SYMMETRY = 1e-9  # of modes q and -q, relative, above which no real displacement has them


class Ends(ABC):
    """N bonds with ends of one kind. Arrays end in the axis of particles or of modes."""

    name: ClassVar[str]
    mode_type: ClassVar[type]  # of the coordinates of a mode, in doubles

    def __init__(self, N: int) -> None:
        self.N = N

    @property
    @abstractmethod
    def turn(self) -> int:
        """The number of bonds after which a wave repeats, whatever its mode."""

    @property
    @abstractmethod
    def modes(self) -> tuple[int, ...]:
        """The wave numbers, ascending: what the axis of modes means."""

    @property
    @abstractmethod
    def particles(self) -> int:
        """How many particles move."""

    @abstractmethod
    def positions(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        """Displacements x of mode coordinates Q."""

    @abstractmethod
    def coordinates(self, x: Numbers, numbers: Arithmetic) -> Numbers:
        """Mode coordinates Q of displacements x."""

    @abstractmethod
    def sites(self, x: Numbers) -> Numbers:
        """Displacements of the sites 0 .. N, from those of the particles that move."""

    @abstractmethod
    def moving(self, sites: Numbers) -> Numbers:
        """Displacements of the particles that move, from those of the sites 0 .. N."""

    def stretches(self, x: Numbers) -> Numbers:
        """Stretches r_j = x_(j+1) - x_j of all N bonds."""
        return np.diff(self.sites(x), axis=-1)

    @abstractmethod
    def forces(self, tension: Numbers) -> Numbers:
        """Forces on the particles, from the tensions of the N bonds."""

    @abstractmethod
    def stretches_of_modes(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        """Stretches r_j of mode coordinates; in doubles without differences of neighbours, which
        move nearly alike in long waves.
        """

    @abstractmethod
    def forces_on_modes(self, tension: Numbers, numbers: Arithmetic) -> Numbers:
        """Forces on the mode coordinates, from the tensions of the N bonds; likewise."""

    @abstractmethod
    def state(self, values: ArrayLike, argument: str) -> tuple[Numbers, Arithmetic]:
        """Mode coordinates or momenta as an array, and its arithmetic.

        InputError if they are none.
        """

    def displacements(self, values: ArrayLike, argument: str) -> tuple[Numbers, Arithmetic]:
        """Displacements or velocities of the particles, likewise."""
        return self._real(values, argument, self.particles, "put the particles last")

    def _real(
        self, values: ArrayLike, argument: str, length: int, advice: str
    ) -> tuple[Numbers, Arithmetic]:
        numbers = arithmetic_of(values)
        try:
            array = numbers.array(values)
        except (TypeError, ValueError) as error:
            allowed = "an array of real numbers"
            raise InputError(argument, values, allowed, "pass numbers") from error
        self._require_length(array, argument, length, advice)
        return array, numbers

    def _require_length(
        self, array: Numbers, argument: str, length: int, advice: str
    ) -> None:
        if array.ndim == 0 or array.shape[-1] != length:
            name = "N-1" if length < self.N else "N"
            allowed = f"an array whose last axis has length {name} = {length}"
            raise InputError(argument, array.shape, allowed, advice)

    @abstractmethod
    def seeds(self, values: Iterable[object]) -> tuple[int, ...]:
        """Distinct modes, in the given order; InputError for what is none."""

    def place(self, q: int) -> int:
        """Where a mode stands on the axis of modes."""
        return self.modes.index(q)


class FixedEnds(Ends):
    """x_0 = x_N = 0."""

    name = "fixed"
    mode_type = float

    @property
    def turn(self) -> int:
        return 2 * self.N

    @property
    def modes(self) -> tuple[int, ...]:
        return tuple(range(1, self.N))

    @property
    def particles(self) -> int:
        return self.N - 1

    def seeds(self, values: Iterable[object]) -> tuple[int, ...]:
        return seed_modes(values, self.N)

    def positions(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        """The transform is orthogonal and its own inverse (Eq. lintra)."""
        from scipy.fft import dst

        if numbers is not DOUBLES:
            return numbers.dot(Q, sine_matrix(self.N))
        return np.asarray(dst(Q, type=1, norm="ortho", axis=-1))

    def coordinates(self, x: Numbers, numbers: Arithmetic) -> Numbers:
        return self.positions(x, numbers)

    def sites(self, x: Numbers) -> Numbers:
        """The walls stand at both ends."""
        wall = np.zeros_like(x[..., :1])
        return np.concatenate([wall, x, wall], axis=-1)

    def moving(self, sites: Numbers) -> Numbers:
        return sites[..., 1:-1]

    def forces(self, tension: Numbers) -> Numbers:
        return np.diff(tension, axis=-1)

    def stretches_of_modes(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        """sqrt(2/N) sum_q Omega_q Q_q cos((j + 1/2) q pi / N), a cosine transform."""
        from scipy.fft import dct

        if numbers is not DOUBLES:
            return self.stretches(self.positions(Q, numbers))
        scaled = np.concatenate([np.zeros_like(Q[..., :1]), self._linear * Q], axis=-1)
        return np.asarray(dct(scaled, type=3, norm="ortho", axis=-1))

    def forces_on_modes(self, tension: Numbers, numbers: Arithmetic) -> Numbers:
        """Minus the transpose."""
        from scipy.fft import dct

        if numbers is not DOUBLES:
            return self.coordinates(self.forces(tension), numbers)
        cosines = dct(tension, type=2, norm="ortho", axis=-1)
        return np.asarray(-self._linear * cosines[..., 1:])

    @property
    def _linear(self) -> Numbers:
        """Omega_q in doubles."""
        return np.asarray(2 * np.sin(np.pi * np.arange(1, self.N) / (2 * self.N)))

    def state(self, values: ArrayLike, argument: str) -> tuple[Numbers, Arithmetic]:
        return self._real(values, argument, self.N - 1, "put the modes last")


class PeriodicEnds(Ends):
    """x_(j+N) = x_j: x_j = N^(-1/2) sum_q Q_q e^(2 pi i q j / N), Q_(-q) = conj Q_q."""

    name = "periodic"
    mode_type = complex

    @property
    def turn(self) -> int:
        return self.N

    @property
    def modes(self) -> tuple[int, ...]:
        first, last = -((self.N - 1) // 2), self.N // 2
        return tuple(q for q in range(first, last + 1) if q)

    @property
    def particles(self) -> int:
        return self.N

    def seeds(self, values: Iterable[object]) -> tuple[int, ...]:
        modes = self.modes
        inside = f"distinct integers in {modes[0]}..{modes[-1]}"
        allowed = f"{inside} without 0 (a ring of N = {self.N})"
        return distinct_modes(values, modes, allowed)

    def positions(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        """Real, with the mean zero."""
        if numbers is not DOUBLES:
            cosines, sines = unit_waves(self.N)
            parts = numbers.dot(_real(Q), cosines), numbers.dot(_imaginary(Q), sines)
            return np.asarray(parts[0] - parts[1])
        whole = np.zeros((*Q.shape[:-1], self.N), dtype=complex)
        whole[..., np.array(self.modes)] = Q
        return np.asarray(np.fft.ifft(whole, norm="ortho", axis=-1).real)

    def coordinates(self, x: Numbers, numbers: Arithmetic) -> Numbers:
        """The mean is left out."""
        if numbers is not DOUBLES:
            cosines, sines = (table.T for table in unit_waves(self.N))
            return _complex(numbers.dot(x, cosines), -numbers.dot(x, sines))
        whole = np.fft.fft(x, norm="ortho", axis=-1)
        return np.asarray(whole[..., np.array(self.modes)])

    def sites(self, x: Numbers) -> Numbers:
        """Site N is site 0 again."""
        return np.concatenate([x, x[..., :1]], axis=-1)

    def moving(self, sites: Numbers) -> Numbers:
        return sites[..., :-1]

    def forces(self, tension: Numbers) -> Numbers:
        return np.asarray(tension - np.roll(tension, 1, axis=-1))

    def stretches_of_modes(self, Q: Numbers, numbers: Arithmetic) -> Numbers:
        if numbers is not DOUBLES:
            return self.stretches(self.positions(Q, numbers))
        return self.positions(self._differences * Q, numbers)

    def forces_on_modes(self, tension: Numbers, numbers: Arithmetic) -> Numbers:
        if numbers is not DOUBLES:
            return self.coordinates(self.forces(tension), numbers)
        return -self._differences.conj() * self.coordinates(tension, numbers)

    @property
    def _differences(self) -> Numbers:
        """Of neighbours in a wave: e^(2 pi i q / N) - 1 = 2 i sin(pi q / N) e^(i pi q / N)."""
        half = np.pi * np.array(self.modes) / self.N
        return np.asarray(2j * np.sin(half) * np.exp(1j * half))

    def state(self, values: ArrayLike, argument: str) -> tuple[Numbers, Arithmetic]:
        numbers = arithmetic_of(values)
        try:
            array = _complex_array(values, numbers)
        except (TypeError, ValueError) as error:
            allowed = "an array of complex numbers"
            raise InputError(
                argument, type(values).__name__, allowed, "pass numbers"
            ) from error
        self._require_length(array, argument, self.N - 1, "put the modes last")
        self._require_symmetry(array, argument)
        return array, numbers

    def _require_symmetry(self, array: Numbers, argument: str) -> None:
        """Displacements are real: Q_(-q) = conj Q_q."""
        opposite = [self.place(q if 2 * q == self.N else -q) for q in self.modes]
        rounded = array.astype(complex)
        excess = np.abs(rounded - rounded[..., opposite].conj()).max(initial=0.0)
        if not excess <= SYMMETRY * np.abs(rounded).max(initial=0.0):
            allowed = "modes with Q_(-q) = conj Q_q, those of real displacements"
            advice = "take chain.modes(x) of the displacements"
            raise InputError(argument, f"off by {excess:.3g}", allowed, advice)


def unit_waves(N: int) -> tuple[Numbers, Numbers]:
    """N^(-1/2) cos and sin of 2 pi q j / N at the working precision of mpmath.

    q by `PeriodicEnds.modes`, j = 0 .. N-1; shapes (N-1, N).
    """
    return _unit_waves(N, int(mpmath.mp.prec))


@lru_cache(maxsize=8)
def _unit_waves(N: int, precision: int) -> tuple[Numbers, Numbers]:
    root = 1 / mpmath.sqrt(N)
    angles = [2 * mpmath.mpf(k) / N for k in range(N)]
    places = np.outer(PeriodicEnds(N).modes, np.arange(N)) % N
    one_turn = [[root * f(x) for x in angles] for f in (mpmath.cospi, mpmath.sinpi)]
    cosines, sines = (np.array(values, dtype=object)[places] for values in one_turn)
    return cosines, sines


def _complex_array(values: ArrayLike, numbers: Arithmetic) -> Numbers:
    """An array of complex doubles, or of mpc."""
    if numbers is DOUBLES:
        return np.asarray(values, dtype=complex)
    array = np.asarray(values, dtype=object)
    return np.asarray(_MPC(array), dtype=object)


def _as_mpc(value: Any) -> Any:
    return mpmath.mpc(mpf(value.real), mpf(value.imag))


_MPC = np.frompyfunc(_as_mpc, 1, 1)
_REAL = np.frompyfunc(lambda value: value.real, 1, 1)
_IMAGINARY = np.frompyfunc(lambda value: value.imag, 1, 1)
_COMPLEX = np.frompyfunc(mpmath.mpc, 2, 1)


def _real(values: Numbers) -> Numbers:
    """Real parts of mpc."""
    return np.asarray(_REAL(values), dtype=object)


def _imaginary(values: Numbers) -> Numbers:
    return np.asarray(_IMAGINARY(values), dtype=object)


def _complex(real: Numbers, imaginary: Numbers) -> Numbers:
    return np.asarray(_COMPLEX(real, imaginary), dtype=object)


ENDS: dict[Any, type[Ends]] = {kind.name: kind for kind in (FixedEnds, PeriodicEnds)}


def checked_ends(ends: object) -> str:
    """The name of a kind of ends; InputError for any other."""
    if not isinstance(ends, str) or ends not in ENDS:
        allowed = " or ".join(map(repr, ENDS))
        raise InputError("ends", ends, allowed, "leave it out for fixed ends")
    return ends
