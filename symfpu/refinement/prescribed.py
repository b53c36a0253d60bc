"""What fixes one torus of s angles in its family: s numbers.

Its frequencies, its amplitudes, an energy with s - 1 ratios, or the coordinates of its seeds at
t = 0. Each gives the s conditions of Newton's method in doubles, and their values on a torus with
digits.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import mpf
from symfpu.numbers.long_doubles import long
from symfpu.numbers.typed import exact
from symfpu.refinement.conditions import (
    Condition,
    EnergyLevel,
    Start,
    amplitude,
    frequency,
    ratio_conditions,
)
from symfpu.refinement.guesses import frequency_shifts, moderate_by_seed, numbers_by_seed
from symfpu.series.arguments import frequencies_of
from symfpu.tori.energy import Energy, asked_energy
from symfpu.tori.torus import Torus, require_fixed_solution

Exact = tuple[Fraction, ...]
ByName = dict[str, Exact | None]


class Prescribed(ABC):
    """s exact numbers, in the order of the seeds, that fix a torus.

    held_frequencies, held_amplitudes : what no step of Newton's method may change.
    """

    held_frequencies: Exact | None = None
    held_amplitudes: Exact | None = None

    @abstractmethod
    def conditions(self, part: float = 1.0) -> list[Condition]:
        """The conditions of Newton's method in doubles, one for each angle.

        part : of the way from rest: of amplitudes and coordinates; of energies and of frequencies'
        shifts it is the square.
        """

    def values(self, torus: Torus) -> list[Any]:
        """What the conditions leave on a torus with digits; 0 where their numbers are held."""
        return [0] * len(torus.seeds)

    def by_name(self) -> ByName:
        """The numbers by what they are, as a file of the refinement keeps them."""
        return {"frequencies": self.held_frequencies, "amplitudes": self.held_amplitudes}


@dataclass(frozen=True)
class Frequencies(Prescribed):
    """omega of every seed of a chain."""

    chain: Chain
    seeds: tuple[int, ...]
    held_frequencies: Exact

    def conditions(self, part: float = 1.0) -> list[Condition]:
        shifts = frequency_shifts(self.chain, self.seeds, self.held_frequencies)
        shifts = shifts * np.longdouble(part) ** 2
        linear = [self.chain.linear_frequency(q) for q in self.seeds]
        return [frequency(place, shift, linear) for place, shift in enumerate(shifts)]


@dataclass(frozen=True)
class Amplitudes(Prescribed):
    """A of every seed."""

    held_amplitudes: Exact

    def conditions(self, part: float = 1.0) -> list[Condition]:
        s = len(self.held_amplitudes)
        amplitudes = [long(A) * np.longdouble(part) for A in self.held_amplitudes]
        return [amplitude(place, A, s) for place, A in enumerate(amplitudes)]


@dataclass(frozen=True)
class AtEnergy(Prescribed):
    """H, or the harmonic energy, with the ratio of amplitudes or of averaged mode energies."""

    energy: Fraction
    harmonic: bool
    seeds: tuple[int, ...]
    ratio: Exact
    of_energies: bool

    def conditions(self, part: float = 1.0) -> list[Condition]:
        level = long(self.energy) * np.longdouble(part) ** 2
        energy = EnergyLevel(level, self.harmonic)
        ratio = {q: float(x) for q, x in zip(self.seeds, self.ratio, strict=True)}
        return [energy, *ratio_conditions(self.seeds, ratio, energies=self.of_energies)]

    def values(self, torus: Torus) -> list[Any]:
        energy = self._energy(torus) / mpf(self.energy) - 1
        first, *others = self._shares(torus)
        expected, *wanted = map(mpf, self.ratio)
        pairs = zip(others, wanted, strict=True)
        return [energy, *(own / first * (expected / ratio) - 1 for own, ratio in pairs)]

    def _energy(self, torus: Torus) -> Any:
        """At the angles zero, or of the waves of a ring averaged over the angles."""
        at_rest = replace(torus, phases={})
        if not self.harmonic:
            return at_rest.energy()
        if torus.chain.periodic:
            return torus.average_spectrum().sum()
        return at_rest.harmonic_energies().sum()

    def _shares(self, torus: Torus) -> list[Any]:
        """Of the seeds: their amplitudes, or their averaged energies."""
        if not self.of_energies:
            return list(torus.amplitudes.values())
        spectrum = torus.average_spectrum()
        modes = torus.chain.mode_numbers
        return [spectrum[modes.index(q)] for q in torus.seeds]

    def by_name(self) -> ByName:
        kind = "harmonic energy" if self.harmonic else "energy"
        ratio = "energy ratio" if self.of_energies else "amplitude ratio"
        return {**super().by_name(), kind: (self.energy,), ratio: self.ratio}


@dataclass(frozen=True)
class AtStart(Prescribed):
    """Q_q(0) of every seed. phases : of all seeds, (s,), radians."""

    numbers: Exact
    phases: tuple[Any, ...]

    @property
    def _size(self) -> Fraction:
        return max(abs(x) for x in self.numbers)

    def conditions(self, part: float = 1.0) -> list[Condition]:
        phases, size = tuple(map(float, self.phases)), float(self._size) * part
        values = enumerate(long(x) * np.longdouble(part) for x in self.numbers)
        return [Start(place, x, phases, size) for place, x in values]

    def values(self, torus: Torus) -> list[Any]:
        found = torus.Q(0.0)
        pairs = zip(torus.seeds, self.numbers, strict=True)
        return [(found[q - 1] - mpf(x)) / mpf(self._size) for q, x in pairs]

    def by_name(self) -> ByName:
        phases = tuple(exact(phase, "phases") for phase in self.phases)
        return {**super().by_name(), "start": self.numbers, "phases": phases}


def prescribed_by(torus: Torus, given: Mapping[str, Any]) -> Prescribed:
    """What was typed to fix a torus near a given one; nothing typed: its own frequencies.

    given : frequencies, amplitudes, energy, start, as of `refine`, None where left out. Raises
    InputError.
    """
    typed = {name: value for name, value in given.items() if value is not None}
    if len(typed) > 1:
        names = ", ".join(given)
        raise InputError(
            names, ", ".join(typed), "at most one of them", "leave the others out"
        )
    if "energy" in typed:
        return _at_energy(torus, asked_energy(typed["energy"]))
    if "amplitudes" in typed:
        values = typed["amplitudes"]
        by_seed = moderate_by_seed("amplitudes", values, torus.seeds, signed=True)
        return Amplitudes(tuple(by_seed.values()))
    if "start" in typed:
        return _at_start(torus, typed["start"])
    omega = tuple(torus.frequencies)
    if "frequencies" in typed:
        omega = frequencies_of(typed["frequencies"], torus.seeds)
    return Frequencies(torus.chain, torus.seeds, omega)


def _at_energy(torus: Torus, energy: Energy) -> AtEnergy:
    of_energies = energy.energy_ratio is not None
    ratio = tuple(_ratio(torus, energy).values())
    return AtEnergy(energy.exact, energy.harmonic, torus.seeds, ratio, of_energies)


def _ratio(torus: Torus, energy: Energy) -> dict[int, Fraction]:
    """The one that was given, by seed, or that of the amplitudes of the guess."""
    if energy.energy_ratio is not None:
        _require_energies(torus)
        given = energy.energy_ratio
        return moderate_by_seed("energy_ratio", given, torus.seeds, signed=False)
    if energy.amplitude_ratio is not None:
        given = energy.amplitude_ratio
        return moderate_by_seed("amplitude_ratio", given, torus.seeds, signed=True)
    found = torus.amplitudes
    return {q: exact(float(a), "amplitude") for q, a in found.items()}


def _require_energies(torus: Torus) -> None:
    """InputError for opposite seeds of a ring, which have the same E_q."""
    opposite = [q for q in torus.seeds if -q in torus.seeds]
    if opposite:
        allowed = "a ratio of modes of different energies: E_q = E_(-q) on a ring"
        given = f"of the seeds {opposite[0]} and {-opposite[0]}"
        raise InputError("energy_ratio", given, allowed, "give amplitude_ratio")


def _at_start(torus: Torus, values: object) -> AtStart:
    """A number for each seed, not all of them 0."""
    require_fixed_solution(torus, "torus", "on a ring give amplitudes")
    allowed = f"a number for each of the seeds {torus.seeds}, by seed"
    numbers = numbers_by_seed("start", values, torus.seeds, allowed)
    if not any(numbers.values()):
        advice = "take the coordinates of an orbit that moves"
        raise InputError("start", values, f"{allowed}, not all 0", advice)
    phases = tuple(torus.phases[q] for q in torus.seeds)
    return AtStart(tuple(numbers[q] for q in torus.seeds), phases)
