"""The q-breather of a prescribed energy: harmonic balance bordered by the energy."""

from __future__ import annotations

import itertools
import warnings

from symfpu.breathers.balance import HarmonicBalance, orbit_at
from symfpu.breathers.equations import NoPeriodicOrbit
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import EnergyGoal, first_passage
from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Torus

# points of the walk beyond the orbit, and the energy relative to its own, up to which another one
# is looked for
MORE_POINTS, MORE_ENERGY = 20, 1.5


class NoBreatherAtEnergy(SymfpuError):
    """No breather of this energy: the family from rest ends below it.

    Raised by `torus`.

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


def breather_of_energy(
    chain: Chain, seed: int, energy: Energy, *, stacklevel: int = 3
) -> Torus[HarmonicBalance]:
    """The first orbit on the family from rest with the given energy, with A > 0.

    chain : with fixed ends. energy : H, or sum E_q at t = 0, when every momentum vanishes; any
    ratio has one seed.

    Harmonic balance; the breathers of section 6.4 by their energy, where the paper gives
    frequencies. The family is followed in steps that do not depend on the energy. Where a wide gap
    has turned it, it is followed a little further, and a UserWarning says that the energy is passed
    again. Raises NoBreatherAtEnergy if the family from rest ends before.
    """
    goal = float(energy.exact)
    aim, walk = EnergyGoal(chain, goal, energy.harmonic), None
    try:
        walk = FromRest(chain, seed)
        orbit = orbit_at(first_passage(walk, aim), walk.iterations)
    except NoPeriodicOrbit as failure:
        last = _highest(walk, aim) if walk else None
        raise NoBreatherAtEnergy(seed, goal, energy.harmonic, last, failure) from failure
    again = _passed_again(walk, aim) if walk.turned else None
    if again is not None:
        first = f"A = {orbit.amplitude:.6g} is the first orbit of this energy"
        later = f"the family from rest passes it again near A = {again:.6g}"
        advice = "refine(torus, energy=...) finds others near a guess"
        warnings.warn(f"{first}, {later}: {advice}", stacklevel=stacklevel)
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


def _energy(member: Torus[HarmonicBalance], harmonic: bool) -> float:
    """H, or the harmonic energy sum E_q, at t = 0."""
    return float(member.harmonic_energies().sum() if harmonic else member.energy())
