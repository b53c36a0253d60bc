"""The q-breather of a prescribed energy: harmonic balance bordered by the energy."""

from __future__ import annotations

import itertools
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import (
    ONE_SEED,
    HarmonicBalance,
    as_periodic_orbit,
    orbit_at,
    orbit_near,
)
from symfpu.breathers.equations import Balance, Condition, NoPeriodicOrbit
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import EnergyGoal, first_passage
from symfpu.breathers.waves import travelling_wave
from symfpu.chain.chain import Chain, require_any_chain
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, energy_of, seed_modes
from symfpu.refinement.refined_torus import Newton
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]

# change of a coefficient from a guess to its orbit, relative to the largest, that is near
REACH = 0.3
# points of the walk beyond the orbit, and the energy relative to its own, up to which another one
# is looked for
MORE_POINTS, MORE_ENERGY = 20, 1.5


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
        member: Torus[HarmonicBalance] | None,
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


@public
def breather_at_energy(
    chain: Chain,
    seed: int,
    energy: Number,
    *,
    harmonic: bool = False,
    guess: Torus | None = None,
) -> Torus[HarmonicBalance | Newton]:
    """The q-breather of a seed mode with the given energy; frequency and amplitude are found.

    chain, seed : the model and the mode, of a ring that of a travelling wave, signed; all
        quantities are dimensionless.
    energy : H, or with harmonic=True the harmonic energy sum E_q at t = 0, when every momentum
        vanishes, of a ring averaged over the angle; a positive exact number.
    harmonic : which of the two.
    guess : a member nearby, any solution of this seed and chain; None follows the family from
        rest, with A > 0.

    Harmonic balance, as `periodic_orbit`; the breathers of section 6.4 by their energy, where the
    paper gives frequencies. An energy may have several orbits. Without a guess this is the first
    one on the family from rest, which is followed in steps that do not depend on the energy. Where
    a wide gap has turned the family, it is followed a little further, and a UserWarning says
    that the energy is passed again.
    Raises InputError; NoBreatherAtEnergy if the family from rest ends before; with a guess
    NoPeriodicOrbit; on a ring NoTorus.

    >>> orbit = breather_at_energy(Chain(N=32, alpha="0.33"), 25, "0.00465")
    >>> round(float(orbit.frequency), 12), round(float(orbit.energy()), 15)
    (1.883074184707, 0.00465)
    """
    if not isinstance(harmonic, bool):
        advice = "say whether energy means sum E_q at t = 0"
        raise InputError("harmonic", harmonic, "True or False", advice)
    if require_any_chain(chain).periodic:
        return travelling_wave(chain, seed, "energy", energy, guess, harmonic=harmonic)
    (seed,), target = seed_modes((seed,), chain.N), energy_of(energy)
    goal = float(target)
    if guess is not None:
        member = _member(guess, chain, seed)
        level = Level(chain, goal, harmonic)
        return orbit_near(chain, seed, member.cosines, member.origin.sigma, level, REACH)
    aim, walk = EnergyGoal(chain, goal, harmonic), None
    try:
        walk = FromRest(chain, seed)
        orbit = orbit_at(first_passage(walk, aim), walk.iterations)
    except NoPeriodicOrbit as failure:
        last = _highest(walk, aim) if walk else None
        raise NoBreatherAtEnergy(seed, goal, harmonic, last, failure) from failure
    again = _passed_again(walk, aim) if walk.turned else None
    if again is not None:
        first = f"A = {orbit.amplitude:.6g} is the first orbit of this energy"
        later = f"the family from rest passes it again near A = {again:.6g}"
        warnings.warn(f"{first}, {later}: give a guess for others", stacklevel=3)
    return orbit


def _passed_again(walk: FromRest, aim: EnergyGoal) -> float | None:
    """A where the energy has fallen below the goal again, soon after the walk has passed it."""
    so_far = len(walk.points) - 1
    try:
        for point in itertools.islice(walk, so_far, so_far + MORE_POINTS):
            energy = aim.value(point.balance, point.z)
            if energy < aim.target:
                return point.amplitude
            if energy > MORE_ENERGY * aim.target:
                return None
    except NoPeriodicOrbit:
        return None
    return None


def _highest(walk: FromRest, aim: EnergyGoal) -> Torus[HarmonicBalance]:
    """The orbit of a walk with the largest energy."""
    highest = max(walk.points, key=lambda point: aim.value(point.balance, point.z))
    return orbit_at(highest, walk.iterations)


def _member(guess: object, chain: Chain, seed: int) -> Torus[HarmonicBalance]:
    """A guess as a periodic orbit of this seed and chain; raises InputError for any other."""
    member = as_periodic_orbit(guess, "guess", ONE_SEED)
    if (member.chain, member.seed) != (chain, seed):
        given = f"of seed {member.seed}, {member.chain!r}"
        allowed = f"a solution of seed {seed} of the same chain"
        raise InputError("guess", given, allowed, "take a member nearby, or None")
    return member


def _energy(member: Torus[HarmonicBalance], harmonic: bool) -> float:
    """H, or the harmonic energy sum E_q, at t = 0."""
    return float(member.harmonic_energies().sum() if harmonic else member.energy())
