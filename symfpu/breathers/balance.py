"""Exact q-breathers: time-periodic orbits by harmonic balance and Newton's method, in doubles.

Q_q(t) = sum_n c[n, q-1] cos(n omega t) solves Q'' = chain.accelerations(Q). The unknowns are c
and sigma = omega^2 - Omega^2 of the seed, so that a small shift loses no digits; one of them,
sigma or A = c[1, seed-1], is given. Reflection of the chain with a change of sign is half a
period of the family: only c with q - n seed even (and n odd where V is even) are unknowns.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import InputError, NoRealAmplitude, SymfpuError, UndeterminedAmplitudes
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import Number, decimal, exact, seed_modes
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic

Floats = NDArray[np.float64]
# of z: what has to vanish, relative to what it is made of, and its derivatives
Condition = Callable[[Floats], tuple[float, Floats]]
LARGEST_SYSTEM = 8192  # unknowns; a matrix of 512 MB
TAIL = 1e-14  # of the largest coefficient: what the last eighth of the harmonics may reach
STEP = 1e-14  # relative Newton step that ends the iteration at once
ROUNDING_STEP = 1e-9  # the one that ends it when it no longer shrinks
ITERATIONS = 25
MOST_POWER = 5  # of the stretches, whose harmonics do not fold
GROWTH = 1e3  # factor by which iterates may leave the size of the guess, up or down
# change of a coefficient from one guess to its orbit, relative to the largest, that stays on
# the family
REACH = 0.3
ONE_ANGLE = "a solution of one angle"
ONE_SEED = "take a solution of one seed, or None"
NEARER = "start from a guess nearer to the orbit, such as an orbit of smaller amplitude"
SMALLEST_PART = 1 / 64  # of the way from rest, in one step


class NoPeriodicOrbit(SymfpuError):
    """Newton's method found no periodic orbit: raised by `periodic_orbit` and its sisters.

    seed : the mode. iterate : the one with the smallest residual, cosine coefficients, shape
        (H+1, N-1).
    frequency, residual : of it, dimensionless; the residual relative to the largest acceleration.
        Ours.
    """

    def __init__(
        self, balance: Balance, reason: str, z: Floats, advice: str = NEARER
    ) -> None:
        self.seed = balance.seed
        self.iterate = balance.cosines(z)
        self.frequency = balance.frequency(z)
        self.residual = residual(balance.chain, self.frequency, self.iterate)
        amplitude = z[balance.first]
        super().__init__(
            f"no periodic orbit of seed {self.seed}: {reason}; "
            f"the best iterate, omega = {self.frequency:.12g} and A = {amplitude:.6g} "
            f"with {balance.harmonics} harmonics, "
            f"leaves {self.residual:.2g} of the largest acceleration; {advice}"
        )


@dataclass(frozen=True, eq=False, kw_only=True)
class PeriodicOrbit(FourierTorus):
    """The periodic orbit Q_q(t) = sum_n c[n, q-1] cos(n omega t) of a chain; dimensionless.

    A solution of one angle. Made by `periodic_orbit`, `breather_at_amplitude` and
    `breather_at_energy`: Eq. qser with s = 1, exact where the paper cuts it (section 6.4).

    chain, seeds : the model and its one seed. frequencies : omega, exact, shape (1,).
    harmonics : 0 .. H, shape (H+1, 1). cosines : c in doubles, shape (H+1, N-1), harmonic 0 first.
    phases : 0 of the seed, radians. digits : None, of doubles.
    iterations : Newton steps on the way. sigma : omega^2 - Omega_seed^2.

    >>> from symfpu import periodic_orbit
    >>> periodic_orbit(Chain(N=8, alpha="0.3"), 1, "0.3905")
    PeriodicOrbit(N=8, alpha=0.3, seed 1, omega=0.3905, A=0.4051586230417, H=0.012798422083,
    13 harmonics, residual ...)
    """

    iterations: int
    sigma: float

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        which = (
            f"seed {self.seed}, omega={decimal(self.frequency)}, A={self.amplitude:.13g}"
        )
        quality = (
            f"{counted(len(self.cosines) - 1, 'harmonic')}, residual {self.residual():.2g}"
        )
        return f"PeriodicOrbit({chain}, {which}, H={self.energy():.11g}, {quality})"


def orbit_of(
    chain: Chain,
    seed: int,
    omega: Fraction,
    cosines: Floats,
    *,
    iterations: int,
    sigma: float,
) -> PeriodicOrbit:
    """The orbit with these coefficients, harmonic 0 first, shape (H+1, N-1)."""
    harmonics = np.arange(len(cosines))[:, None]
    phases = {seed: 0.0}
    return PeriodicOrbit(
        chain,
        (seed,),
        (omega,),
        harmonics,
        cosines,
        phases,
        iterations=iterations,
        sigma=sigma,
    )


def as_periodic_orbit(solution: object, argument: str, advice: str) -> PeriodicOrbit:
    """A solution of one angle as a periodic orbit in doubles, at rest at t = 0.

    Raises InputError for any other. advice : what to do with a torus of more angles.
    """
    if not isinstance(solution, QuasiPeriodic):
        advice = "take one from periodic_orbit, breather_at_amplitude or refine"
        raise InputError(argument, type(solution).__name__, ONE_ANGLE, advice)
    if len(solution.seeds) > 1:
        raise InputError(
            argument, f"a torus of {len(solution.seeds)} angles", ONE_ANGLE, advice
        )
    if isinstance(solution, PeriodicOrbit) and not solution.phases[solution.seed]:
        return solution
    chain, seed, omega = solution.chain, solution.seed, solution.frequency
    _, sigma = detuning(chain, seed, omega)
    cosines = solution.by_harmonic().astype(float)
    return orbit_of(chain, seed, omega, cosines, iterations=0, sigma=sigma)


def unknowns(
    chain: Chain, seed: int, harmonics: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Harmonics n and places q - 1 of the coefficients that the symmetry allows.

    They stand in the order of the vectors z.
    """
    n, q = np.indices((harmonics + 1, chain.N - 1))
    reflected = (q + 1 - n * seed) % 2 == 0
    in_time = (n % 2 == 1) | (not chain.potential.even)
    harmonic, place = np.nonzero(reflected & in_time)
    return harmonic, place


def half_period_points(chain: Chain, harmonics: int) -> int:
    """Into how many parts half a period is cut for the force up to a harmonic.

    Of r^n harmonics from 2 points - harmonics on would fold onto those: (n + 1) harmonics / 2 + 1
    points are enough for powers up to n. What still folds of powers above MOST_POWER is as small
    as that power of the last harmonics, which are at TAIL.
    """
    degree = chain.potential.degree or MOST_POWER + 1
    power = min(max(degree - 1, 3), MOST_POWER)
    return (power + 1) * harmonics // 2 + 1


def products_of_modes(N: int) -> Floats:
    """cos(pi m (j + 1/2)/N) / N of the bonds j and of m = 0 .. N; shape (N, N+1)."""
    angles = np.outer(2 * np.arange(N) + 1, np.arange(N + 1)) % (4 * N)
    return np.asarray(np.cos(np.pi / (2 * N) * angles) / N)


class Balance:
    """The equations n^2 omega^2 c + force = 0 up to a number of harmonics.

    Their unknowns are vectors z: the c that the symmetry allows, then sigma.
    """

    def __init__(self, chain: Chain, seed: int, harmonics: int) -> None:
        self.chain, self.seed, self.harmonics = chain, seed, harmonics
        self.n, self.q = unknowns(chain, seed, harmonics)
        linear = chain.frequencies()
        own, driven = linear[self.q], linear[seed - 1]
        self.detuning = self.n**2 * driven**2 - own**2
        is_first = (self.n == 1) & (self.q == seed - 1)
        self.first = int(np.flatnonzero(is_first)[0])
        # of every bond by a unit of each mode
        self.stretch = chain.stretches(np.eye(chain.N - 1))
        self.products = products_of_modes(chain.N)
        points = half_period_points(chain, harmonics)
        k = np.arange(points + 1)
        ends = np.where(k % points == 0, 0.5, 1.0)
        self.table = np.cos(np.pi / points * np.outer(k, k))
        self.analysis = 2 / points * ends[:, None] * self.table * ends

    def vector(self, cosines: Floats, sigma: float) -> Floats:
        length = max(self.harmonics + 1, len(cosines))
        padded = np.zeros((length, self.chain.N - 1))
        padded[: len(cosines)] = cosines
        return np.append(padded[self.n, self.q], sigma)

    def cosines(self, z: Floats) -> Floats:
        c = np.zeros((self.harmonics + 1, self.chain.N - 1))
        c[self.n, self.q] = z[:-1]
        return c

    def frequency(self, z: Floats) -> float:
        linear = float(self.chain.frequencies()[self.seed - 1])
        sigma = float(z[-1])
        squared = max(linear**2 + sigma, 0.0)
        return linear + sigma / (linear + math.sqrt(squared))

    def system(self, z: Floats) -> tuple[Floats, Floats]:
        """The equations, shape (n,), and their derivatives by z, shape (n, n+1)."""
        law, c, sigma = self.chain.law(), z[:-1], z[-1]
        diagonal = self.detuning + self.n**2 * sigma
        synthesis = self.table[:, : self.harmonics + 1]
        r = synthesis @ self.cosines(z) @ self.stretch
        tension = bonds.anharmonic_tension(law, r)
        force = -(self.analysis @ tension @ self.stretch.T)
        slope = self.analysis @ bonds.anharmonic_stiffness(law, r)
        J = self._coupling(slope)
        J[np.diag_indices_from(J)] += diagonal
        equations = diagonal * c + force[self.n, self.q]
        return equations, np.column_stack([J, self.n**2 * c])

    def _coupling(self, slope: Floats) -> Floats:
        """Derivatives of the force by the unknowns.

        slope : cosine coefficients of the anharmonic part of V'' of every bond, overwritten.
        """
        slope[1:] /= 2  # coefficients of exp(i k theta), k of both signs
        table = slope @ self.products
        J = np.empty((len(self.n), len(self.n)))
        rows = [(n, self._of_harmonic(n)) for n in np.unique(self.n).tolist()]
        for place, (n, those) in enumerate(rows):
            for other, columns in rows[: place + 1]:
                both = table[n - other] + (table[n + other] if n else 0.0)
                block = self._by_modes(both, those, columns)
                J[those, columns] = -block
                # the mean takes the slope of one sign alone
                J[columns, those] = -block.T if other or not n else -block.T / 2
        return J

    def _of_harmonic(self, n: int) -> slice:
        """The coefficients of a harmonic, which stand together."""
        first, last = np.searchsorted(self.n, [n, n + 1])
        return slice(int(first), int(last))

    def _by_modes(self, row: Floats, those: slice, columns: slice) -> Floats:
        """A slope of the bonds between the modes of some coefficients.

        row : what it has of the modes 0 .. N. Of q and q' it makes Omega_q Omega_q' times what it
        has of |q - q'| and q + q', beyond N of 2 N - q - q' with the other sign.
        """
        N, linear = self.chain.N, self.chain.frequencies()
        p, q = self.q[those, None], self.q[None, columns]
        total = p + q + 2
        beyond = np.where(total > N, -1.0, 1.0) * row[np.minimum(total, 2 * N - total)]
        return np.asarray(linear[p] * linear[q] * (row[np.abs(p - q)] + beyond))

    def newton(self, z: Floats, given: int | Condition) -> tuple[Floats, int]:
        """The solution with the same z[given], or that meets a condition, and the number of steps.

        Raises NoPeriodicOrbit.
        """
        places = np.arange(len(z))
        free = places if callable(given) else np.delete(places, given)
        best, least, before = z, np.inf, np.inf
        size = _largest(z[:-1])
        for iteration in range(1, ITERATIONS + 1):
            equations, jacobian = self.system(z)
            imbalance = _largest(equations) / _largest(z[:-1])
            if imbalance < least:
                best, least = z, imbalance
            if callable(given):
                value, row = given(z)
                equations = np.append(equations, value)
                jacobian = np.vstack([jacobian, row])
            try:
                step = np.linalg.solve(jacobian[:, free], equations)
            except np.linalg.LinAlgError:
                reason = "the matrix of Newton's method is singular"
                raise NoPeriodicOrbit(self, reason, best) from None
            z = z.copy()
            z[free] -= step
            reached = _largest(z[:-1])
            if not size / GROWTH < reached < size * GROWTH:
                reason = f"the largest coefficient goes from {size:.3g} to {reached:.3g}"
                raise NoPeriodicOrbit(self, reason, best)
            of_coefficients = step[free < len(z) - 1]
            relative = _largest(of_coefficients) / reached
            if relative <= STEP or before / 2 < relative < ROUNDING_STEP:
                return z, iteration
            before = relative
        raise NoPeriodicOrbit(self, f"no convergence in {ITERATIONS} steps", best)


def _largest(values: NDArray[np.floating[Any]]) -> float:
    return float(np.max(np.abs(values)))


def relative_heights(cosines: Floats) -> Floats:
    """The largest coefficient of every harmonic over the largest of all; shape (H+1,)."""
    heights = np.max(np.abs(cosines), axis=1)
    return np.asarray(heights / np.max(np.abs(cosines)))


def held_frequency(balance: Balance) -> int:
    """The place of sigma in the vectors of a balance."""
    return len(balance.n)


def held_amplitude(balance: Balance) -> int:
    """The place of A in the vectors of a balance."""
    return balance.first


def residual(chain: Chain, omega: float, cosines: Floats) -> float:
    """Largest |Q'' - force| between the collocation points, over the largest acceleration."""
    n, points = np.arange(len(cosines)), 6 * len(cosines)
    angles = np.pi / points * (np.arange(points) + 1 / 3)
    table = np.cos(np.outer(angles, n))
    force = chain.accelerations(table @ cosines)
    largest = max(_largest(force), float(np.finfo(float).tiny))
    rates = n[:, None] * omega
    return _largest(table @ (rates**2 * cosines) + force) / largest


def periodic_orbit(
    chain: Chain,
    seed: int,
    frequency: Number,
    guess: ArrayLike | QuasiPeriodic | None = None,
) -> PeriodicOrbit:
    """The q-breather of a seed mode with the given frequency.

    chain, seed : the model and the mode; all quantities are dimensionless.
    frequency : omega, an exact number.
    guess : a solution of one angle, or cosine coefficients, shape (H+1, N-1), of which those that
        the symmetry forbids are dropped; None follows the family from rest, with the amplitude of
        the lowest order.

    Newton's method on the Fourier coefficients of Eq. eqmo (harmonic balance), where the paper
    has the series of section 6.4. The orbit is one near the guess: a frequency may have several.
    Raises InputError; without a guess NoRealAmplitude or UndeterminedAmplitudes if the lowest
    order has no amplitude; NoPeriodicOrbit with the best iterate.

    >>> orbit = periodic_orbit(Chain(N=32, alpha="0.33"), 25, "1.8830741847088537")
    >>> round(float(orbit.energy()), 12)
    0.004649999361
    """
    require_chain(chain)
    (seed,), omega = seed_modes((seed,), chain.N), positive_frequency(frequency)
    shift, sigma = detuning(chain, seed, omega)
    if guess is not None:
        orbit = orbit_near(chain, seed, _cosines(chain, seed, guess), sigma, held_frequency)
    else:
        orbit = _walk(
            chain, seed, lowest_amplitude(chain, seed, shift), sigma, by_amplitude=False
        )
    return replace(orbit, frequencies=(omega,))


def positive_frequency(frequency: Number) -> Fraction:
    """The exact number that a frequency denotes; raises InputError."""
    omega = exact(frequency, "frequency")
    if omega <= 0:
        advice = "take one near the linear frequency"
        raise InputError("frequency", frequency, "a positive number", advice)
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


def breather_at_amplitude(
    chain: Chain,
    seed: int,
    amplitude: Number,
    guess: ArrayLike | QuasiPeriodic | None = None,
) -> PeriodicOrbit:
    """The q-breather of a seed mode with the given amplitude; its frequency is found.

    chain, seed : the model and the mode; all quantities are dimensionless.
    amplitude : A, the coefficient of cos(omega t) in Q_seed, an exact number, not 0.
    guess : a solution of one angle, or cosine coefficients, shape (H+1, N-1); None follows the
        family from rest.

    Harmonic balance with A among the equations: the gauge of Eq. qq0, A is not Q_seed(0).
    Raises InputError, and NoPeriodicOrbit with the best iterate.

    >>> round(float(breather_at_amplitude(Chain(N=8, alpha="0.3"), 1, "0.4").frequency), 9)
    0.390491915
    """
    require_chain(chain)
    (seed,), A = seed_modes((seed,), chain.N), float(exact(amplitude, "amplitude"))
    if A == 0:
        raise InputError(
            "amplitude", amplitude, "a number that is not 0", "take a small one"
        )
    if guess is None:
        shift = frequency_shift(chain, {seed: A})[seed]
        sigma = 2 * float(chain.frequencies()[seed - 1]) * shift
        return _walk(chain, seed, A, sigma, by_amplitude=True)
    cosines = _cosines(chain, seed, guess)
    cosines[1, seed - 1] = A
    balance = Balance(chain, seed, len(cosines) - 1)
    z = balance.vector(cosines, 0.0)
    equations, _ = balance.system(z)
    sigma = float(-equations[balance.first] / A)  # balances cos(omega t) of the seed
    return orbit_near(chain, seed, cosines, sigma, held_amplitude)


def _cosines(chain: Chain, seed: int, guess: ArrayLike | QuasiPeriodic) -> Floats:
    if isinstance(guess, QuasiPeriodic):
        guess = as_periodic_orbit(guess, "guess", ONE_SEED).cosines
    shape = f"(H+1, {chain.N - 1})"
    try:
        cosines = np.array(guess, dtype=np.float64)
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
) -> PeriodicOrbit:
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
            still = (
                f"the last of {harmonics // 2} harmonics is still {heights[-2:].max():.1g}"
            )
            raise NoPeriodicOrbit(balance, f"{still} of the largest", z)
    largest = _largest(cosines)
    change = _largest(z - balance.vector(guess, sigma)) / largest
    if change > reach or abs(cosines[1, seed - 1]) < largest / GROWTH:
        moved = f"a change by {change:.3g} of the largest coefficient"
        raise NoPeriodicOrbit(balance, f"the orbit found is another one: {moved}", z)
    last = int(np.flatnonzero(heights > TAIL / 100)[-1])
    omega = exact(balance.frequency(z), "frequency")
    return orbit_of(
        chain, seed, omega, cosines[: last + 1], iterations=iterations, sigma=sigma
    )


def _walk(
    chain: Chain, seed: int, amplitude: float, sigma: float, *, by_amplitude: bool
) -> PeriodicOrbit:
    """The member at the end of the way from rest.

    On it A grows about with the part gone, and sigma with its square.
    """
    gone, step, iterations = 0.0, 1.0, 0
    # the guess is cosines, a member or the linear mode, scaled to the next part
    scale, cosines = 1.0, np.zeros((2, chain.N - 1))
    cosines[1, seed - 1] = amplitude
    given = held_amplitude if by_amplitude else held_frequency
    while True:
        part = min(1.0, gone + step)
        guess = cosines * (part / scale)
        if by_amplitude:
            guess[1, seed - 1] = amplitude * part
        try:
            orbit = orbit_near(
                chain, seed, guess, sigma * (part / scale) ** 2, given, REACH
            )
        except NoPeriodicOrbit:
            step /= 2
            if step < SMALLEST_PART:
                raise
            continue
        gone = scale = part
        cosines, sigma = orbit.cosines, orbit.sigma
        iterations += orbit.iterations
        if gone == 1:
            return replace(orbit, iterations=iterations)
