"""Exact q-breathers: time-periodic orbits of a given frequency or amplitude, in doubles.

Harmonic balance and Newton's method (`symfpu.breathers.equations`). Without a guess they are on the
family from rest (`symfpu.breathers.from_rest`).
"""

from __future__ import annotations

import itertools
import warnings
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.curve import Point
from symfpu.breathers.equations import (
    TAIL,
    Balance,
    NoPeriodicOrbit,
    relative_heights,
)
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import (
    AmplitudeGoal,
    EnergyGoal,
    Goal,
    first_passage,
)
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import (
    NoRealAmplitude,
    SymfpuError,
    UndeterminedAmplitudes,
)
from symfpu.numbers.typed import Number, double, exact
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import NoTorus
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Origin, Torus

Floats = NDArray[np.float64]
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


@dataclass(frozen=True, eq=False, repr=False)
class HarmonicBalance(Origin):
    """Where a breather comes from: harmonic balance in doubles, Eq. qser with s = 1.

    Exact where the paper cuts it (section 6.4). Its torus has the harmonics 0 .. H.

    iterations : Newton steps on the way. sigma : omega^2 - Omega_seed^2, dimensionless.

    >>> import symfpu
    >>> symfpu.torus(Chain(N=8, alpha="0.3"), (1,), frequencies=("0.3905",))
    Torus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.012798422083...,
    14 harmonics, residual ...)
    """

    name: ClassVar[str] = "breather"

    iterations: int
    sigma: float

    def require_whole(self, torus: Torus) -> None:
        numbered = np.arange(len(torus.harmonics))[:, None]
        if not np.array_equal(torus.harmonics, numbered):
            raise ValueError("the harmonics are not those of a periodic orbit")
        if self.iterations < 0 or not np.isfinite(self.sigma):
            raise ValueError(f"sigma = {self.sigma} after {self.iterations} iterations")


def orbit_of(
    chain: Chain,
    seed: int,
    omega: Fraction,
    cosines: Floats,
    *,
    iterations: int,
    sigma: float,
) -> Torus[HarmonicBalance]:
    """The orbit with these coefficients, harmonic 0 first, shape (H+1, N-1)."""
    harmonics = np.arange(len(cosines))[:, None]
    phases = {seed: 0.0}
    origin = HarmonicBalance(iterations, sigma)
    return Torus(chain, (seed,), (omega,), harmonics, cosines, phases, origin=origin)


def unknowns_of(balance: Balance, torus: Torus) -> Floats:
    """A torus of one angle with fixed ends as the unknowns of a balance."""
    _, sigma = detuning(torus.chain, torus.seed, torus.frequency)
    return balance.vector(torus.by_harmonic().astype(float), sigma)


def breather_of_frequency(
    chain: Chain, seed: int, frequency: Number
) -> Torus[HarmonicBalance]:
    """The first orbit on the family from rest with the given frequency, with A > 0.

    chain : with fixed ends. Newton's method on the Fourier coefficients of Eq. eqmo (harmonic
    balance), where the paper has the series of section 6.4. A frequency may have several orbits.
    Raises InputError; NoRealAmplitude or UndeterminedAmplitudes if the lowest order has no
    amplitude; NoPeriodicOrbit with the best iterate.
    """
    omega = exact(frequency, "frequency")
    shift, sigma = detuning(chain, seed, omega)
    lowest_amplitude(chain, seed, shift)
    orbit = _on_the_family(chain, seed, AmplitudeGoal(sigma, detuning=True))
    return replace(orbit, frequencies=(omega,))


def detuning(chain: Chain, seed: int, omega: Fraction) -> tuple[float, float]:
    """omega - Omega_seed and sigma = omega^2 - Omega_seed^2, without loss of digits."""
    with mpmath.workdps(50):
        linear = chain.linear_frequency(seed)
        target = mpmath.mpf(omega.numerator) / omega.denominator
        shift = target - linear
        return float(shift), float(shift * (target + linear))


def lowest_amplitude(chain: Chain, seed: int, shift: float) -> float:
    """A > 0 whose lowest frequency correction is omega - Omega = shift.

    Raises NoRealAmplitude or UndeterminedAmplitudes.
    """
    coefficient = frequency_shift(chain, {seed: 1.0})[seed]
    order = 2 // chain.degree_step
    if coefficient == 0:
        raise UndeterminedAmplitudes((seed,), order)
    squared = shift / coefficient
    if squared <= 0:
        raise NoRealAmplitude(seed, squared, order)
    return float(squared**0.5)


def breather_of_amplitude(
    chain: Chain, seed: int, amplitude: Number
) -> Torus[HarmonicBalance]:
    """The first orbit on the family from rest with the given amplitude.

    chain : with fixed ends. amplitude : A, the coefficient of cos(omega t) in Q_seed, not 0; it is
    not Q_seed(0). An amplitude may have several orbits. Raises InputError, and NoPeriodicOrbit with
    the best iterate.
    """
    A = double(amplitude, "amplitude")
    orbit = _on_the_family(chain, seed, AmplitudeGoal(abs(A)))
    return orbit if A > 0 else half_a_period_later(orbit)


def _on_the_family(chain: Chain, seed: int, goal: Goal) -> Torus[HarmonicBalance]:
    """The first orbit of the family from rest that has what is asked for."""
    walk = FromRest(chain, seed)
    return orbit_at(first_passage(walk, goal), walk.iterations)


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


def orbit_at(point: Point, iterations: int) -> Torus[HarmonicBalance]:
    """A point of a curve as an orbit, with the corrections on the way to it."""
    balance, cosines = point.balance, point.cosines
    last = int(np.flatnonzero(relative_heights(cosines) > TAIL / 100)[-1])
    omega = exact(balance.frequency(point.z), "frequency")
    total, sigma = iterations + point.iterations, float(point.z[-1])
    kept = cosines[: last + 1]
    return orbit_of(balance.chain, balance.seed, omega, kept, iterations=total, sigma=sigma)


def require_same(orbit: Torus[HarmonicBalance], found: Torus[Newton], most: float) -> None:
    """NoTorus where Newton's method on tori leads from an orbit to another one.

    most : what it may change of a coefficient, in parts of the largest.
    """
    here, there = orbit.cosines, found.by_harmonic().astype(float)
    length = min(len(here), len(there))
    change = float(np.abs(there[:length] - here[:length]).max())
    if change > most * float(np.abs(here).max()):
        raise NoTorus("Newton's method leads to another orbit", found, found.residual())


def half_a_period_later(orbit: Torus[HarmonicBalance]) -> Torus[HarmonicBalance]:
    """The same orbit from its other rest: A has the other sign."""
    signs = np.where(np.arange(len(orbit.cosines)) % 2, -1.0, 1.0)
    return replace(orbit, cosines=signs[:, None] * orbit.cosines)
