"""Exact q-breathers by shooting: Newton's method on the motion over half a period.

Root finding as in section 6.4. A state at rest, P(0) = 0, that is at rest again at T/2 returns at
T, since the motion is reversible. The unknowns are the Q_q(0) that the symmetry of the family
allows: even q for an even seed, q of the seed's parity where V is even, else all. The tangent map
is the exact derivative of the integrator's map, so that Newton's method converges quadratically
down to rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.grading import Ints
from symfpu.breathers.balance import (
    GROWTH,
    ITERATIONS,
    ROUNDING_STEP,
    STEP,
    TAIL,
    detuning,
    lowest_amplitude,
    positive_frequency,
)
from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.kahan_li8 import KAHAN_LI8
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import particle_scheme
from symfpu.dynamics.tangent import tangent_steps
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import Number, decimal, seed_modes
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of

Floats = NDArray[np.float64]
# of the half period, relative to its largest number: a small omega - Omega magnifies errors
ACCURACY = 1e-15
FIRST_STEP = 0.1  # time of the coarser of the first two integrations
DOUBLINGS = 5
HALF_PERIOD_SAMPLES = (
    256,
    1024,
    4096,
)  # for the harmonics of an orbit, until they fall off
NOISE = 4e-15  # of the largest coefficient: those below are rounding of the integration


class ShootingFailed(SymfpuError):
    """Newton's method on the half period found no orbit: raised by `shoot`.

    seed : the mode. reason : why it ended. iterate : Q(0) with the smallest residual, shape (N-1,).
    residuals : of every step; residual : the smallest, relative to omega max|Q|, dimensionless.
        Ours.
    """

    def __init__(
        self, seed: int, reason: str, start: Floats, residuals: tuple[float, ...]
    ) -> None:
        self.seed, self.reason, self.iterate, self.residuals = (
            seed,
            reason,
            start,
            residuals,
        )
        self.residual = min(residuals, default=float("inf"))
        best = f"Q_{seed}(0) = {start[seed - 1]:.6g}"
        super().__init__(
            f"shooting at the breather of seed {seed} failed: {reason}; "
            f"the best start, {best}, is at rest at T/2 up to {self.residual:.2g} of omega max|Q|; "
            f"pass as guess the start of a series or of an orbit nearby"
        )


@dataclass(frozen=True, eq=False)
class ShotOrbit(QuasiPeriodic):
    """A periodic orbit found from its start at rest: a solution of one angle; dimensionless.

    Made by `shoot`, a route to the breathers of section 6.4 independent of harmonic balance. Ours.

    chain, seeds : the model and its one seed. frequencies : omega, exact, shape (1,).
    start : Q(0), shape (N-1,); P(0) = 0.
    closure : the distance of (omega Q, P) after a whole period from the start, over omega max|Q|,
        with steps half as long as those of the search.
    history : max|P(T/2)| / (omega max|Q|) of the guess and after every Newton step.
    steps : of the composition in half a period.

    harmonics, 0 .. H, shape (H+1, 1), and cosines follow from integrating over half a period,
    when they are first asked for. phases : 0 of the seed, radians. digits : None, of doubles.

    >>> from symfpu import Chain, shoot
    >>> shoot(Chain(N=8, alpha="0.3"), 1, "0.3905")
    ShotOrbit(N=8, alpha=0.3, seed 1, omega=0.3905, Q_1(0)=0.4052474469027, H=0.012798422083,
    5 Newton steps, closure ...)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    start: Floats = field(repr=False)
    closure: float
    history: tuple[float, ...] = field(repr=False)
    steps: int

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        energy = self.chain.energy(self.start, np.zeros_like(self.start))
        coordinate = f"Q_{self.seed}(0)={self.start[self.seed - 1]:.13g}"
        which = f"seed {self.seed}, omega={decimal(self.frequency)}, {coordinate}"
        quality = f"{self.iterations} Newton steps, closure {self.closure:.2g}"
        return f"ShotOrbit({chain}, {which}, H={energy:.11g}, {quality})"

    @property
    def iterations(self) -> int:
        """Newton steps."""
        return len(self.history) - 1

    @property
    def phases(self) -> Mapping[int, float]:
        """The orbit is at rest at t = 0."""
        return {self.seed: 0.0}

    @property
    def digits(self) -> None:
        """Doubles."""
        return None

    @property
    def harmonics(self) -> Ints:
        """The harmonics 0 .. H; shape (H+1, 1)."""
        return np.arange(len(self.cosines))[:, None]

    @cached_property
    def cosines(self) -> Floats:
        """The coefficients of cos(n omega t) in Q_q, harmonic 0 first, shape (H+1, N-1).

        Raises ShootingFailed if they do not fall off.
        """
        return _analysed(self)

    @property
    def amplitudes(self) -> Mapping[int, float]:
        """A by seed, the coefficient of cos(omega t) in Q_seed."""
        return amplitudes_of(self)


def _analysed(orbit: ShotOrbit) -> Floats:
    """Cosine coefficients of an orbit that is even in time, from equal steps of half a period."""
    from scipy.fft import dct

    for samples in HALF_PERIOD_SAMPLES:
        path = _half_period(orbit, samples)
        cosines = dct(path, type=1, axis=0) / samples
        cosines[[0, -1]] /= 2
        heights = np.max(np.abs(cosines), axis=1)
        relative = heights / np.max(heights)
        if np.max(relative[-samples // 8 :]) <= TAIL:
            last = int(np.flatnonzero(relative > NOISE)[-1])
            return np.asarray(cosines[: max(last, 1) + 1])
    last_one = f"the last of {samples} harmonics of the orbit"
    reason = f"{last_one} is still {relative[-1]:.1g} of the largest"
    raise ShootingFailed(orbit.seed, reason, orbit.start, orbit.history)


def _half_period(orbit: ShotOrbit, samples: int) -> Floats:
    """Q at equidistant times of half a period, ends included; shape (samples + 1, N-1).

    Steps are no longer than those of the search.
    """
    none = np.zeros((0, orbit.chain.N - 1))
    pause = np.pi / float(orbit.frequency) / samples
    steps = -(-orbit.steps // samples)
    Q, P = orbit.start, 0 * orbit.start
    path = [Q]
    for _ in range(samples):
        moved = tangent_steps(
            orbit.chain, Q, P, none, none, pause / steps, steps, scheme=KAHAN_LI8
        )
        Q, P, *_ = moved
        path.append(Q)
    return np.array(path)


@np.errstate(over="ignore", invalid="ignore")  # motions that run away are refused
def shoot(
    chain: Chain,
    seed: int,
    frequency: Number,
    guess: ArrayLike | None = None,
    *,
    scheme: str = "kahan_li8",
) -> ShotOrbit:
    """The q-breather of a seed mode with the given frequency, by Newton's method on Q(0).

    chain, seed : the model and the mode; all quantities are dimensionless.
    frequency : omega, an exact number.
    guess : Q(0), shape (N-1,), of which the modes that the symmetry forbids are dropped; None for
        the seed alone with the amplitude of the lowest order, good for small ones.
    scheme : of the integrator, on T + V; with one of lower order the residual is larger.

    Integrates Eq. eqmo from rest over half a period, at whose end an orbit is at rest again.
    Ours: an independent check of `periodic_orbit`. Raises InputError; without a guess
    NoRealAmplitude or UndeterminedAmplitudes; ShootingFailed with the best start.

    >>> shot = shoot(Chain(N=32, alpha="0.33"), 25, "1.8830741847088537")
    >>> round(float(shot.energy()), 12), shot.closure < 1e-13
    (0.004649999361, True)
    """
    require_chain(chain)
    (seed,), omega = seed_modes((seed,), chain.N), positive_frequency(frequency)
    integrator = particle_scheme(scheme)
    if guess is None:
        start = np.zeros(chain.N - 1)
        shift, _ = detuning(chain, seed, omega)
        start[seed - 1] = lowest_amplitude(chain, seed, shift)
    else:
        start = _start(chain, seed, guess)
    allowed = np.full(chain.N - 1, True)
    if chain.potential.even or seed % 2 == 0:
        allowed = (np.arange(1, chain.N) - seed) % 2 == 0
    start = np.where(allowed, start, 0.0)
    half, rate = np.pi / float(omega), float(omega)
    steps = _steps(chain, integrator, seed, start, half)
    start, history = _newton(
        chain, integrator, seed, start, np.flatnonzero(allowed), half, steps
    )
    Q, P = _moved(chain, integrator, start, half / (2 * steps), 4 * steps)
    distance = max(np.max(np.abs(Q - start)), np.max(np.abs(P)) / rate)
    closure = float(distance / np.max(np.abs(start)))
    return ShotOrbit(chain, (seed,), (omega,), start, closure, history, steps)


def _moved(
    chain: Chain, scheme: Scheme, start: Floats, step: float, count: int
) -> tuple[Floats, Floats]:
    """Q and P after so many steps from the start at rest."""
    none = np.zeros((0, chain.N - 1))
    Q, P, *_ = tangent_steps(
        chain, start, 0 * start, none, none, step, count, scheme=scheme
    )
    return Q, P


def _newton(
    chain: Chain,
    scheme: Scheme,
    seed: int,
    start: Floats,
    free: NDArray[np.intp],
    half: float,
    steps: int,
) -> tuple[Floats, tuple[float, ...]]:
    """The start at rest that is at rest after half a period, and the residuals on the way.

    Raises ShootingFailed.
    """
    directions = np.eye(chain.N - 1)[free]
    still = 0 * directions
    history: list[float] = []
    size, before, best = float(np.max(np.abs(start))), np.inf, start

    def failed(reason: str) -> ShootingFailed:
        return ShootingFailed(seed, reason, best, tuple(history))

    for _ in range(ITERATIONS + 1):
        state = start, 0 * start
        moved = tangent_steps(
            chain, *state, directions, still, half / steps, steps, scheme=scheme
        )
        _, P, _, slopes = moved
        velocity = np.pi * np.max(np.abs(start))  # omega max|Q| times half a period
        residual = float(np.max(np.abs(P)) * half / velocity)
        if not np.isfinite(residual):
            raise failed("the motion runs away to infinity")
        history.append(residual)
        best = start if residual == min(history) else best
        stalled = len(history) > 2 and residual > history[-2] / 2
        if before <= STEP or (before < ROUNDING_STEP and stalled):
            return best, tuple(history)
        try:
            step = np.linalg.solve(slopes[:, free].T, P[free])
        except np.linalg.LinAlgError:
            raise failed("the matrix of Newton's method is singular") from None
        start = start.copy()
        start[free] -= step
        reached = float(np.max(np.abs(start)))
        if not size / GROWTH < reached < size * GROWTH:
            raise failed(f"the largest coordinate goes from {size:.3g} to {reached:.3g}")
        before = float(np.max(np.abs(step))) / reached
    raise failed(f"no convergence in {ITERATIONS} steps")


def _start(chain: Chain, seed: int, guess: ArrayLike) -> Floats:
    shape = f"shape ({chain.N - 1},)"
    try:
        start = np.array(guess, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("guess", guess, f"an array of {shape}", "pass numbers") from error
    if start.shape != (chain.N - 1,):
        advice = "pass the mode coordinates Q(0)"
        raise InputError("guess", start.shape, f"the {shape}", advice)
    given = start[seed - 1]
    if not np.isfinite(start).all() or given == 0:
        allowed = f"finite numbers, Q_{seed}(0) not 0"
        raise InputError("guess", given, allowed, "give the seed an amplitude")
    return start


def _steps(chain: Chain, scheme: Scheme, seed: int, start: Floats, half: float) -> int:
    """Steps with which half a period from the guess is integrated to ACCURACY."""
    steps = int(np.ceil(half / FIRST_STEP))

    def end(steps: int) -> Floats:
        return np.concatenate(_moved(chain, scheme, start, half / steps, steps))

    coarse = end(steps)
    for _ in range(DOUBLINGS):
        steps *= 2
        fine = end(steps)
        if not np.isfinite(fine).all():
            raise ShootingFailed(
                seed, "the motion from the guess runs away to infinity", start, ()
            )
        wanted = (2**scheme.order - 1) * ACCURACY * np.max(np.abs(fine))
        if np.max(np.abs(fine - coarse)) <= wanted:
            break
        coarse = fine
    return steps
