"""The q-breather of a prescribed energy: harmonic balance bordered by the energy.

The family is followed from rest, in growing steps of the energy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import (
    ONE_SEED,
    REACH,
    Balance,
    Condition,
    NoPeriodicOrbit,
    PeriodicOrbit,
    as_periodic_orbit,
    orbit_near,
)
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import Number, exact, seed_modes
from symfpu.tori.quasiperiodic import QuasiPeriodic

Floats = NDArray[np.float64]

LARGEST_GROWTH = 4.0  # of the energy from one member to the next
SMALLEST_GROWTH = 1e-2  # relative; below it the family counts as ended
SMALLEST_START = (
    1e-12  # of the energy asked for: the least at which a first member is looked for
)


class NoBreatherAtEnergy(SymfpuError):
    """No breather of this energy: the family from rest ends below it.

    Raised by `breather_at_energy`.

    seed : the mode. energy : asked for; harmonic : whether it is sum E_q.
    reached, frequency, amplitude : of the member with the largest energy, all dimensionless;
        frequency None if there was none.
    reason : of the last failure. Ours.
    """

    def __init__(
        self,
        seed: int,
        energy: float,
        harmonic: bool,
        member: PeriodicOrbit | None,
        failure: NoPeriodicOrbit,
    ) -> None:
        self.seed, self.energy, self.harmonic, self.reason = (
            seed,
            energy,
            harmonic,
            str(failure),
        )
        self.reached = 0.0 if member is None else _energy(member, harmonic)
        self.frequency = None if member is None else float(member.frequency)
        self.amplitude = 0.0 if member is None else member.amplitude
        kind = "harmonic energy" if harmonic else "energy"
        last = "no member was found"
        if member is not None:
            last = f"the last has omega = {self.frequency:.12g}, A = {self.amplitude:.6g}"
        why, *_ = self.reason.partition("; the best")
        super().__init__(
            f"no breather of seed {seed} at {kind} {energy:.6g}: "
            f"the family from rest was followed over 0 .. {self.reached:.6g}, {last}; "
            f"it ended because: {why}; ask for {kind} below {self.reached:.6g}"
        )


@dataclass(frozen=True)
class Level:
    """The condition that H, or the harmonic energy at t = 0, has a given value.

    Momenta vanish then, and Q_q(0) = sum_n c[n, q].
    """

    chain: Chain
    energy: float
    harmonic: bool

    def __call__(self, balance: Balance) -> Condition:
        def condition(z: Floats) -> tuple[float, Floats]:
            Q = balance.cosines(z).sum(axis=0)
            value, gradient = self._at(Q)
            scale = self.energy / np.max(np.abs(z[:-1]))
            excess = (value - self.energy) / scale
            return excess, np.append(gradient[balance.q], 0.0) / scale

        return condition

    def _at(self, Q: Floats) -> tuple[float, Floats]:
        """The energy of the state at rest Q, and its derivatives by Q."""
        if self.harmonic:
            gradient = self.chain.frequencies() ** 2 * Q
            return float(gradient @ Q) / 2, gradient
        energy = self.chain.energy(Q, np.zeros_like(Q))
        return float(energy), -self.chain.accelerations(Q)


def breather_at_energy(
    chain: Chain,
    seed: int,
    energy: Number,
    *,
    harmonic: bool = False,
    guess: QuasiPeriodic | None = None,
) -> PeriodicOrbit:
    """The q-breather of a seed mode with the given energy; frequency and amplitude are found.

    chain, seed : the model and the mode; all quantities are dimensionless.
    energy : H, or with harmonic=True the harmonic energy sum E_q at t = 0, when every momentum
        vanishes; a positive exact number.
    harmonic : which of the two.
    guess : a member nearby, any solution of this seed and chain; None follows the family from
        rest, with A > 0.

    Harmonic balance, as `periodic_orbit`; the breathers of section 6.4 by their energy, where the
    paper gives frequencies.
    Raises InputError; NoBreatherAtEnergy if the family from rest ends before; with a guess
    NoPeriodicOrbit.

    >>> orbit = breather_at_energy(Chain(N=32, alpha="0.33"), 25, "0.00465")
    >>> round(float(orbit.frequency), 12), round(float(orbit.energy()), 15)
    (1.883074184707, 0.00465)
    """
    require_chain(chain)
    (seed,), target = seed_modes((seed,), chain.N), _positive(energy)
    if not isinstance(harmonic, bool):
        advice = "say whether energy means sum E_q at t = 0"
        raise InputError("harmonic", harmonic, "True or False", advice)
    goal = float(target)
    if guess is not None:
        member = _member(guess, chain, seed)
        level = Level(chain, goal, harmonic)
        return orbit_near(chain, seed, member.cosines, member.sigma, level, REACH)
    members: list[tuple[float, PeriodicOrbit]] = []
    aim, growth, iterations = goal, LARGEST_GROWTH, 0
    while True:
        try:
            orbit = _next(chain, seed, aim, harmonic, members[-2:])
        except NoPeriodicOrbit as failure:
            if not members:
                aim /= LARGEST_GROWTH
                if aim > SMALLEST_START * goal:
                    continue
            elif growth - 1 > SMALLEST_GROWTH:
                growth = growth**0.5
                aim = min(goal, members[-1][0] * growth)
                continue
            last = members[-1][1] if members else None
            raise NoBreatherAtEnergy(seed, goal, harmonic, last, failure) from failure
        iterations += orbit.iterations
        if aim == goal:
            return replace(orbit, iterations=iterations)
        members.append((aim, orbit))
        growth = min(LARGEST_GROWTH, growth**1.5)
        aim = min(goal, aim * growth)


def _positive(energy: Number) -> Fraction:
    target = exact(energy, "energy")
    if target <= 0:
        raise InputError("energy", energy, "a positive number", "take a small one")
    return target


def _member(guess: object, chain: Chain, seed: int) -> PeriodicOrbit:
    """A guess as a periodic orbit of this seed and chain; raises InputError for any other."""
    member = as_periodic_orbit(guess, "guess", ONE_SEED)
    if (member.chain, member.seed) != (chain, seed):
        given = f"of seed {member.seed}, {member.chain!r}"
        allowed = f"a solution of seed {seed} of the same chain"
        raise InputError("guess", given, allowed, "take a member nearby, or None")
    return member


def _energy(member: PeriodicOrbit, harmonic: bool) -> float:
    """H, or the harmonic energy sum E_q, at t = 0."""
    return float(member.harmonic_energies().sum() if harmonic else member.energy())


def _next(
    chain: Chain,
    seed: int,
    energy: float,
    harmonic: bool,
    members: list[tuple[float, PeriodicOrbit]],
) -> PeriodicOrbit:
    """The member at an energy near those of the last two, or near the linear mode."""
    level = Level(chain, energy, harmonic)
    if not members:
        cosines, sigma = _linear_guess(chain, seed, energy)
    elif len(members) == 1:
        [(last, member)] = members
        ratio = energy / last
        cosines, sigma = member.cosines * ratio**0.5, member.sigma * ratio
    else:
        cosines, sigma = _secant_guess(members, energy)
    return orbit_near(chain, seed, cosines, sigma, level, REACH)


def _linear_guess(chain: Chain, seed: int, energy: float) -> tuple[Floats, float]:
    """Cosines and sigma of the linear mode of this energy, with the lowest shift."""
    linear = float(chain.frequencies()[seed - 1])
    amplitude = (2 * energy) ** 0.5 / linear
    cosines = np.zeros((2, chain.N - 1))
    cosines[1, seed - 1] = amplitude
    shift = frequency_shift(chain, {seed: amplitude})[seed]
    return cosines, shift * (2 * linear + shift)


def _secant_guess(
    members: list[tuple[float, PeriodicOrbit]], energy: float
) -> tuple[Floats, float]:
    """Cosines on the secant in the square root of the energy, sigma on that in the energy."""
    (first, before), (last, member) = members
    weight = (energy**0.5 - last**0.5) / (last**0.5 - first**0.5)
    length = max(len(before.cosines), len(member.cosines))
    old = np.zeros((length, before.cosines.shape[1]))
    new = old.copy()
    old[: len(before.cosines)] = before.cosines
    new[: len(member.cosines)] = member.cosines
    slope = (energy - last) / (last - first)
    sigma = member.sigma + slope * (member.sigma - before.sigma)
    return new + weight * (new - old), sigma
