"""Exact q-breathers: time-periodic orbits of a given frequency or amplitude, in doubles.

Harmonic balance and Newton's method (`symfpu.breathers.equations`). Without a guess they are on the
family from rest (`symfpu.breathers.from_rest`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.curve import Point
from symfpu.breathers.equations import (
    TAIL,
    relative_heights,
)
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import AmplitudeGoal, DetuningGoal, Goal, first_passage
from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, NoRealAmplitude, UndeterminedAmplitudes
from symfpu.numbers.typed import Number, double, exact
from symfpu.tori.torus import Origin, Torus, comes_from, require_fixed_solution

Floats = NDArray[np.float64]
ONE_ANGLE = "a solution of one angle"
LARGEST_FREQUENCY = 10**6


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


def as_periodic_orbit(
    solution: object, argument: str, advice: str
) -> Torus[HarmonicBalance]:
    """A solution of one angle as a periodic orbit in doubles, at rest at t = 0.

    Raises InputError for any other. advice : what to do with a torus of more angles.
    """
    if not isinstance(solution, Torus):
        advice = "take one from torus or refine"
        raise InputError(argument, type(solution).__name__, ONE_ANGLE, advice)
    require_fixed_solution(solution, argument)
    if len(solution.seeds) > 1:
        raise InputError(
            argument, f"a torus of {len(solution.seeds)} angles", ONE_ANGLE, advice
        )
    if comes_from(solution, HarmonicBalance) and not solution.phases[solution.seed]:
        return solution
    chain, seed, omega = solution.chain, solution.seed, solution.frequency
    _, sigma = detuning(chain, seed, omega)
    cosines = solution.by_harmonic().astype(float)
    return orbit_of(chain, seed, omega, cosines, iterations=0, sigma=sigma)


def breather_of_frequency(
    chain: Chain, seed: int, frequency: Number
) -> Torus[HarmonicBalance]:
    """The first orbit on the family from rest with the given frequency, with A > 0.

    chain : with fixed ends. Newton's method on the Fourier coefficients of Eq. eqmo (harmonic
    balance), where the paper has the series of section 6.4. A frequency may have several orbits.
    Raises InputError; NoRealAmplitude or UndeterminedAmplitudes if the lowest order has no
    amplitude; NoPeriodicOrbit with the best iterate.
    """
    omega = positive_frequency(frequency)
    shift, sigma = detuning(chain, seed, omega)
    lowest_amplitude(chain, seed, shift)
    orbit = _on_the_family(chain, seed, DetuningGoal(sigma))
    return replace(orbit, frequencies=(omega,))


def positive_frequency(frequency: Number) -> Fraction:
    """The exact number that a frequency denotes; raises InputError."""
    omega = exact(frequency, "frequency")
    if not 0 < omega <= LARGEST_FREQUENCY:
        advice = "take one near the linear frequency"
        raise InputError(
            "frequency", frequency, f"a positive number up to {LARGEST_FREQUENCY}", advice
        )
    return omega


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
    if A == 0:
        raise InputError(
            "amplitude", amplitude, "a number that is not 0", "take a small one"
        )
    orbit = _on_the_family(chain, seed, AmplitudeGoal(abs(A)))
    return orbit if A > 0 else half_a_period_later(orbit)


def _on_the_family(chain: Chain, seed: int, goal: Goal) -> Torus[HarmonicBalance]:
    """The first orbit of the family from rest that has what is asked for."""
    walk = FromRest(chain, seed)
    return orbit_at(first_passage(walk, goal), walk.iterations)


def orbit_at(point: Point, iterations: int) -> Torus[HarmonicBalance]:
    """A point of a curve as an orbit, with the corrections on the way to it."""
    balance, cosines = point.balance, point.cosines
    last = int(np.flatnonzero(relative_heights(cosines) > TAIL / 100)[-1])
    omega = exact(balance.frequency(point.z), "frequency")
    total, sigma = iterations + point.iterations, float(point.z[-1])
    kept = cosines[: last + 1]
    return orbit_of(balance.chain, balance.seed, omega, kept, iterations=total, sigma=sigma)


def half_a_period_later(orbit: Torus[HarmonicBalance]) -> Torus[HarmonicBalance]:
    """The same orbit from its other rest: A has the other sign."""
    signs = np.where(np.arange(len(orbit.cosines)) % 2, -1.0, 1.0)
    return replace(orbit, cosines=signs[:, None] * orbit.cosines)
