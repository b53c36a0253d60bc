"""Exact q-breathers: time-periodic orbits of a given frequency or amplitude, in doubles.

Harmonic balance and Newton's method (`symfpu.breathers.equations`). Without a guess they are on the
family from rest (`symfpu.breathers.from_rest`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.breathers.curve import Point
from symfpu.breathers.equations import (
    GROWTH,
    LARGEST_SYSTEM,
    TAIL,
    Balance,
    Condition,
    NoPeriodicOrbit,
    held_amplitude,
    held_frequency,
    relative_heights,
)
from symfpu.breathers.from_rest import FromRest
from symfpu.breathers.passage import AmplitudeGoal, DetuningGoal, Goal, first_passage
from symfpu.breathers.waves import travelling_wave
from symfpu.chain.chain import Chain, require_any_chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, NoRealAmplitude, UndeterminedAmplitudes
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, double, exact, seed_modes
from symfpu.refinement.refined_torus import Newton
from symfpu.tori.torus import Origin, Torus, comes_from, require_fixed_solution

Floats = NDArray[np.float64]
ONE_ANGLE = "a solution of one angle"
ONE_SEED = "take a solution of one seed, or None"
LARGEST_FREQUENCY = 10**6


@dataclass(frozen=True, eq=False, repr=False)
class HarmonicBalance(Origin):
    """Where a breather comes from: harmonic balance in doubles, Eq. qser with s = 1.

    Exact where the paper cuts it (section 6.4). Its torus has the harmonics 0 .. H.

    iterations : Newton steps on the way. sigma : omega^2 - Omega_seed^2, dimensionless.

    >>> from symfpu import periodic_orbit
    >>> periodic_orbit(Chain(N=8, alpha="0.3"), 1, "0.3905")
    Torus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.012798422083...,
    14 harmonics, residual ...)
    """

    name: ClassVar[str] = "breather"

    iterations: int
    sigma: float


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
        advice = "take one from periodic_orbit, breather_at_amplitude or refine"
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


@public
def periodic_orbit(
    chain: Chain,
    seed: int,
    frequency: Number,
    guess: ArrayLike | Torus | None = None,
) -> Torus[HarmonicBalance | Newton]:
    """The q-breather of a seed mode with the given frequency.

    chain, seed : the model and the mode, of a ring that of a travelling wave, signed; all
        quantities are dimensionless.
    frequency : omega, an exact number.
    guess : a solution of one angle, or cosine coefficients, shape (H+1, N-1), of which those that
        the symmetry forbids are dropped; None follows the family from rest. On a ring a wave.

    Newton's method on the Fourier coefficients of Eq. eqmo (harmonic balance), where the paper
    has the series of section 6.4. A frequency may have several orbits. Without a guess this is the
    first one on the family from rest, with A > 0; with a guess one near it.
    Raises InputError; without a guess NoRealAmplitude or UndeterminedAmplitudes if the lowest
    order has no amplitude; NoPeriodicOrbit with the best iterate, on a ring NoTorus.

    >>> orbit = periodic_orbit(Chain(N=32, alpha="0.33"), 25, "1.8830741847088537")
    >>> round(float(orbit.energy()), 12)
    0.004649999361
    """
    if require_any_chain(chain).periodic:
        return travelling_wave(chain, seed, "frequency", frequency, guess)
    (seed,), omega = seed_modes((seed,), chain.N), positive_frequency(frequency)
    shift, sigma = detuning(chain, seed, omega)
    if guess is not None:
        orbit = orbit_near(chain, seed, _cosines(chain, seed, guess), sigma, held_frequency)
    else:
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


@public
def breather_at_amplitude(
    chain: Chain,
    seed: int,
    amplitude: Number,
    guess: ArrayLike | Torus | None = None,
) -> Torus[HarmonicBalance | Newton]:
    """The q-breather of a seed mode with the given amplitude; its frequency is found.

    chain, seed : the model and the mode, of a ring that of a travelling wave, signed; all
        quantities are dimensionless.
    amplitude : A, the coefficient of cos(omega t) in Q_seed, an exact number, not 0.
    guess : a solution of one angle, or cosine coefficients, shape (H+1, N-1); None follows the
        family from rest. On a ring a wave.

    Harmonic balance with A among the equations: the gauge of Eq. qq0, A is not Q_seed(0). An
    amplitude may have several orbits. Without a guess this is the first one on the family from
    rest, with a guess one near it.
    Raises InputError, and NoPeriodicOrbit with the best iterate, on a ring NoTorus.

    >>> round(float(breather_at_amplitude(Chain(N=8, alpha="0.3"), 1, "0.4").frequency), 9)
    0.390491915
    """
    if require_any_chain(chain).periodic:
        return travelling_wave(chain, seed, "amplitude", amplitude, guess)
    (seed,), A = seed_modes((seed,), chain.N), double(amplitude, "amplitude")
    if A == 0:
        raise InputError(
            "amplitude", amplitude, "a number that is not 0", "take a small one"
        )
    if guess is None:
        orbit = _on_the_family(chain, seed, AmplitudeGoal(abs(A)))
        return orbit if A > 0 else half_a_period_later(orbit)
    cosines = _cosines(chain, seed, guess)
    cosines[1, seed - 1] = A
    balance = Balance(chain, seed, len(cosines) - 1)
    z = balance.vector(cosines, 0.0)
    equations, _ = balance.system(z)
    sigma = float(-equations[balance.first] / A)  # balances cos(omega t) of the seed
    return orbit_near(chain, seed, cosines, sigma, held_amplitude)


def _cosines(chain: Chain, seed: int, guess: ArrayLike | Torus) -> Floats:
    if isinstance(guess, Torus):
        guess = as_periodic_orbit(guess, "guess", ONE_SEED).cosines
    shape = f"(H+1, {chain.N - 1})"
    try:
        cosines = DOUBLES.array(guess).copy()
    except (TypeError, ValueError) as error:
        raise InputError(
            "guess", guess, f"an array of shape {shape}", "pass numbers"
        ) from error
    if cosines.ndim != 2 or len(cosines) < 2 or cosines.shape[1] != chain.N - 1:
        advice = "put the harmonics first, the modes last"
        raise InputError("guess", cosines.shape, f"the shape {shape}, H from 1 up", advice)
    A = cosines[1, seed - 1]
    if not np.isfinite(cosines).all() or A == 0:
        allowed = f"finite numbers, A = guess[1, {seed - 1}] not 0"
        raise InputError("guess", A, allowed, "give the seed an amplitude")
    return cosines


@np.errstate(
    over="ignore", invalid="ignore", divide="ignore"
)  # iterates that run away are refused by their size
def orbit_near(
    chain: Chain,
    seed: int,
    cosines: Floats,
    sigma: float,
    given: Callable[[Balance], int | Condition],
    reach: float = GROWTH,
) -> Torus[HarmonicBalance]:
    """The orbit near cosines and sigma, with as many harmonics as it needs.

    No coefficient is changed by more than reach.

    given : of a balance, the place of what keeps its value, or the condition to meet.
    reach : relative to the largest coefficient.

    Raises NoPeriodicOrbit.
    """
    guess, harmonics, iterations = cosines, max(8, len(cosines) - 1), 0
    if harmonics * (chain.N - 1) > 2 * LARGEST_SYSTEM:
        allowed = f"at most {2 * LARGEST_SYSTEM} as their product"
        raise InputError("N, harmonics", (chain.N, harmonics), allowed, "cut the guess")
    while True:
        balance = Balance(chain, seed, harmonics)
        z, steps = balance.newton(balance.vector(cosines, sigma), given(balance))
        cosines, sigma = balance.cosines(z), float(z[-1])
        iterations += steps
        if balance.frequency(z) <= 0:
            reason = f"the equations hold for omega^2 - Omega^2 = {sigma:.6g}, a negative omega^2"
            raise NoPeriodicOrbit(balance, reason, z)
        heights = relative_heights(cosines)
        tail = max(2, harmonics // 8)
        if np.max(heights[-tail:]) <= TAIL:
            break
        harmonics *= 2
        if harmonics * (chain.N - 1) > 2 * LARGEST_SYSTEM:
            reason = f"{harmonics // 2} harmonics do not resolve it"
            raise NoPeriodicOrbit(balance, reason, z)
    largest = float(np.max(np.abs(cosines)))
    change = float(np.max(np.abs(z - balance.vector(guess, sigma)))) / largest
    if change > reach or abs(cosines[1, seed - 1]) < largest / GROWTH:
        moved = f"a change by {change:.3g} of the largest coefficient"
        raise NoPeriodicOrbit(balance, f"the orbit found is another one: {moved}", z)
    last = int(np.flatnonzero(heights > TAIL / 100)[-1])
    omega = exact(balance.frequency(z), "frequency")
    return orbit_of(
        chain, seed, omega, cosines[: last + 1], iterations=iterations, sigma=sigma
    )


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
