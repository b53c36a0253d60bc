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
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import Number, exact, seed_modes
from symfpu.tori.quasiperiodic import QuasiPeriodic

Floats = NDArray[np.float64]

LARGEST_GROWTH = 4.0  # of the energy from one member to the next
SMALLEST_GROWTH = 1e-2  # relative; below it the family counts as ended
SMALLEST_START = 1e-12  # of the energy asked for: the least at which a first member is looked for


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
        self.seed, self.energy, self.harmonic, self.reason = seed, energy, harmonic, str(failure)
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
            if self.harmonic:
                gradient = self.chain.frequencies() ** 2 * Q
                value = float(gradient @ Q) / 2
            else:
                gradient, value = (
                    -self.chain.accelerations(Q),
                    float(self.chain.energy(Q, np.zeros_like(Q))),
                )
            scale = self.energy / np.max(np.abs(z[:-1]))
            return (value - self.energy) / scale, np.append(gradient[balance.q], 0.0) / scale

        return condition


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
    (seed,), target = seed_modes((seed,), chain.N), _positive(energy)
    if not isinstance(harmonic, bool):
        raise InputError(
            "harmonic", harmonic, "True or False", "say whether energy means sum E_q at t = 0"
        )
    if guess is not None:
        member = _member(guess, chain, seed)
        return orbit_near(
            chain, seed, member.cosines, member.sigma, Level(chain, float(target), harmonic), REACH
        )
    members: list[tuple[float, PeriodicOrbit]] = []
    aim, growth, iterations = float(target), LARGEST_GROWTH, 0
    while True:
        try:
            orbit = _next(chain, seed, aim, harmonic, members[-2:])
        except NoPeriodicOrbit as failure:
            if not members:
                aim /= LARGEST_GROWTH
                if aim > SMALLEST_START * float(target):
                    continue
            elif growth - 1 > SMALLEST_GROWTH:
                growth = growth**0.5
                aim = min(float(target), members[-1][0] * growth)
                continue
            raise NoBreatherAtEnergy(
                seed, float(target), harmonic, members[-1][1] if members else None, failure
            ) from failure
        iterations += orbit.iterations
        if aim == float(target):
            return replace(orbit, iterations=iterations)
        members.append((aim, orbit))
        growth = min(LARGEST_GROWTH, growth**1.5)
        aim = min(float(target), aim * growth)


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
        raise InputError(
            "guess",
            given,
            f"a solution of seed {seed} of the same chain",
            "take a member nearby, or None",
        )
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
    if not members:
        linear = float(chain.frequencies()[seed - 1])
        cosines = np.zeros((2, chain.N - 1))
        cosines[1, seed - 1] = (2 * energy) ** 0.5 / linear
        shift = frequency_shift(chain, {seed: float(cosines[1, seed - 1])})[seed]
        return orbit_near(
            chain,
            seed,
            cosines,
            shift * (2 * linear + shift),
            Level(chain, energy, harmonic),
            REACH,
        )
    last, member = members[-1]
    ratio = energy / last
    if len(members) == 1:
        return orbit_near(
            chain,
            seed,
            member.cosines * ratio**0.5,
            member.sigma * ratio,
            Level(chain, energy, harmonic),
            REACH,
        )
    first, before = members[0]
    weight = (energy**0.5 - last**0.5) / (last**0.5 - first**0.5)
    old = np.zeros((max(len(before.cosines), len(member.cosines)), chain.N - 1))
    new = old.copy()
    old[: len(before.cosines)], new[: len(member.cosines)] = before.cosines, member.cosines
    sigma = member.sigma + (energy - last) / (last - first) * (member.sigma - before.sigma)
    return orbit_near(
        chain, seed, new + weight * (new - old), sigma, Level(chain, energy, harmonic), REACH
    )
