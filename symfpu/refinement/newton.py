"""Newton's method on the invariance equation with conditions.

One Krylov solution a step, preconditioned by the exact linear part.

A step solves for the changes of all coefficients and shifts at once
(`symfpu.refinement.linear_system`). Forces are taken in doubles where what those round shows in no
coefficient, else in long doubles.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.counted import counted
from symfpu.refinement.conditions import Condition, seed_amplitudes
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats
from symfpu.refinement.linear_system import (
    ACCURACY,
    INEXACT,
    Jacobian,
    NewtonState,
    unsolved_words,
)
from symfpu.refinement.resonances import NearResonance
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits
from symfpu.tori.torus import Origin, Torus

FALL = 0.9  # of the error, at least, by a step that leaves more
# errors by rounding up to which a force is taken in doubles: of an amplitude, relative, and of
# other coefficients, relative to the largest
AMPLITUDES, COEFFICIENTS = 1e-14, 1e-13
# relative change to come that ends the iteration, and the one that does when it no longer shrinks
STEP, ROUNDING_STEP = 1e-16, 1e-9
ITERATIONS = 15
SHOWN_DIVISORS = 5  # that readers see
GROWTH = 30.0  # factor by which iterates may leave the size of the guess


class Tolerances(NamedTuple):
    """How far Newton's method goes.

    change : to come, relative, that ends it. krylov : accuracy of a Krylov solution.
    """

    change: float
    krylov: float


TIGHT = Tolerances(STEP, ACCURACY)  # to rounding


class NewtonStep(NamedTuple):
    """One step of Newton's method.

    residual : of the equations before the step, relative to the largest acceleration. change : of
    the coefficients, relative to the largest. conditions : largest relative violation. krylov :
    products with the derivative.
    """

    residual: float
    change: float
    conditions: float
    krylov: int


@dataclass(frozen=True, eq=False)
class Iterate:
    """cosines (H, C) and shifts (s,) in long doubles, and the way there.

    failure : why it ended early, empty if it converged. at_rounding : whether it ended early
    because no further step could be solved for, when the next one was expected to change less than
    what ends a search that no longer gains.
    """

    cosines: Floats
    shifts: Floats
    steps: tuple[NewtonStep, ...]
    failure: str = ""
    at_rounding: bool = False

    @property
    def residual(self) -> float:
        """Of the equations at the chosen harmonics, before the last step."""
        return self.steps[-1].residual if self.steps else np.inf


@dataclass(frozen=True, eq=False, repr=False)
class Newton(Origin):
    """Where a torus comes from: Newton's method on the invariance equation, in doubles (`refine`).

    Not in the paper, which has series alone. All is dimensionless.

    steps : of Newton's method with the final harmonics.
    near_resonances : the smallest divisors (nu.omega)^2 - Omega_q^2, with the coefficients under
        them.

    A torus of it doubts itself where its residual is above the tolerance, or where the method
    failed when it had reached a residual of 1e-9 or less.

    >>> from symfpu import Chain, lindstedt, refine, solve_amplitudes
    >>> refine(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)))
    Torus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.0127984220834,
    20 harmonics, residual ..., smallest divisor 0.024 at mode 2, harmonic (2), coefficient 0.031)
    """

    name: ClassVar[str] = "Newton's method"

    steps: tuple[NewtonStep, ...]
    near_resonances: tuple[NearResonance, ...]

    def require_whole(self, torus: Torus) -> None:
        """In doubles, waves that travel, each seed with its own harmonic."""
        if torus.stands or torus.digits is not None:
            raise ValueError("standing waves, or many digits, by Newton's method")
        for unit in np.eye(len(torus.seeds), dtype=np.int64):
            if np.count_nonzero((torus.harmonics == unit).all(axis=1)) != 1:
                raise ValueError(
                    "a seed whose own harmonic is not there, or is there twice"
                )
        if any(step.krylov < 0 for step in self.steps):
            raise ValueError("a negative number of products")

    def fields(self, torus: Torus) -> Iterator[Field]:
        steps = []
        for step in self.steps:
            residual, change = fifteen_digits(step.residual), fifteen_digits(step.change)
            steps.append({"residual": residual, "change": change, "products": step.krylov})
        yield Field("energy_error", fifteen_digits(energy_spread(torus)))
        yield Field("newton", steps)
        yield Field("smallest_divisors", [near.entry() for near in self.near_resonances])
        yield Field("verdict", "doubtful" if torus.warnings else "torus")

    def lines(self, known: Mapping[str, Any]) -> Iterator[str]:
        """For a reader. known : the record of the torus."""
        over = "relative, over 25 periods of the slowest seed"
        yield f"energy constancy   {known['energy_error']:.2g}   ({over})"
        if self.steps:
            last = f"the last change {self.steps[-1].change:.1g}"
            yield f"Newton's method    {counted(len(self.steps), 'step')}, {last}"
        if self.near_resonances:
            yield "smallest divisors:"
        yield from (f"  {near}" for near in self.near_resonances[:SHOWN_DIVISORS])

    def facts(self) -> tuple[str, ...]:
        return tuple(f"smallest divisor {nearest}" for nearest in self.near_resonances[:1])


def energy_spread(torus: Torus, periods: int = 25, points: int = 100) -> float:
    """Largest relative change of H along the orbit over some periods of the slowest seed."""
    slowest = min(float(w) for w in torus.frequencies)
    period = 2 * np.pi / slowest
    times = np.linspace(0, periods * period, points)
    energies, start = torus.energy(times), torus.energy()
    return float(np.abs((energies - start) / start).max())


@np.errstate(divide="ignore", invalid="ignore")
def force_precision(equation: InvarianceEquation, cosines: Floats, shifts: Floats) -> type:
    """Doubles for the force where what they round shows in no coefficient, else long doubles.

    An error of the force is divided by the divisor. At small amplitudes those of the seeds, their
    shifts, fall with the square of the amplitude, the force of alpha relative to it as the first.
    """
    divisors = np.abs(equation.divisors(shifts)).astype(float)
    errors = equation.rounding(cosines, np.float64) / divisors
    seeds = equation.seed_rows, equation.seed_columns
    allowed = np.full(cosines.shape, COEFFICIENTS * float(np.abs(cosines).max()))
    allowed[seeds] = AMPLITUDES * np.abs(cosines[seeds])
    enough = (errors <= allowed)[equation.mask].all()
    return np.float64 if enough else np.longdouble


def _left(state: NewtonState, precision: type) -> tuple[Floats, float, float]:
    """What all equations and conditions leave, (U + s,), and the sizes of both, relative.

    Divisors times coefficients in long doubles: near a torus the force cancels them.
    """
    equation, conditions, cosines, shifts = state
    force = equation.force(cosines.astype(precision))
    left = (equation.divisors(shifts) * cosines - force)[equation.mask].astype(float)
    rates = equation.rates(shifts).astype(float)
    accelerations = rates**2 @ np.abs(cosines).astype(float)
    residual = float(np.abs(left).max() / accelerations.max())
    given = [condition.value(equation, cosines, shifts) for condition in conditions]
    values = np.array(given).astype(float)
    return np.concatenate([left, values]), residual, float(np.abs(values).max())


# iterates that run away are refused by their size
@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def newton(
    equation: InvarianceEquation,
    conditions: Sequence[Condition],
    cosines: Floats,
    shifts: Floats,
    progress: Progress = unheard,
    *,
    tolerances: Tolerances = TIGHT,
    growth: float = GROWTH,
) -> Iterate:
    """The torus near a guess that meets the conditions.

    growth : factor by which amplitudes may change from those of the guess. An iterate with
    `failure` where there is none, the best one met.
    """
    state = NewtonState(equation, conditions, cosines, shifts)
    steps: list[NewtonStep] = []
    best, least = state, np.inf
    sizes = _sizes(state)
    precision = force_precision(equation, cosines, shifts)
    to_come, left, products = np.inf, 0.0, 0

    def failed(reason: str, *, unsolved: bool = False) -> Iterate:
        at_rounding = unsolved and to_come < ROUNDING_STEP
        return Iterate(best.cosines, best.shifts, tuple(steps), reason, at_rounding)

    for _ in range(ITERATIONS):
        errors, residual, violation = _left(state, precision)
        error = residual + violation
        if not np.isfinite(error):
            return failed("the equations or conditions leave the range of numbers")
        gained = error < FALL * least
        if error < least:
            best, least = state, error
        if left > INEXACT and not gained:
            return failed(unsolved_words(products, left), unsolved=True)
        try:
            moved, turned, products, left = _step(state, errors, tolerances.krylov)
        except np.linalg.LinAlgError as failure:
            return failed(str(failure), unsolved=True)
        cosines, shifts = state.cosines + moved, state.shifts + turned
        state = state._replace(cosines=cosines, shifts=shifts)
        relative = float(np.abs(moved).max() / np.abs(cosines).max())
        steps.append(NewtonStep(residual, relative, violation, products))
        line = f"step {len(steps)}: residual {residual:.1e}, change {relative:.1e}"
        progress(line, NO_FRACTION)
        if runs_away := _runs_away(sizes, _sizes(state), growth):
            return failed(runs_away)
        if left > INEXACT:
            continue
        before = steps[-2].change if len(steps) > 1 else 1.0
        to_come = relative * max(tolerances.krylov, left, relative / before)
        if to_come < tolerances.change or before / 2 < relative < ROUNDING_STEP:
            return Iterate(cosines, shifts, tuple(steps))
    return failed(f"no convergence in {ITERATIONS} steps")


def _step(
    state: NewtonState, errors: Floats, accuracy: float
) -> tuple[Floats, Floats, int, float]:
    """Changes of coefficients (H, C) and shifts (s,), products, and what is left of the errors.

    By a Jacobian that is not kept: it is large. LinAlgError with the reason where there is none.
    """
    try:
        jacobian = Jacobian(state)
        change, products, left = jacobian.approximate(-errors, accuracy)
    except (np.linalg.LinAlgError, ValueError) as failure:
        reason = f"the matrix of Newton's method is singular ({failure})"
        raise np.linalg.LinAlgError(reason) from failure
    if not left < 1:
        raise np.linalg.LinAlgError(unsolved_words(products, left))
    return *jacobian.parts(change), products, left


def _sizes(state: NewtonState) -> dict[str, float]:
    """What must not run away or vanish: the largest coefficient, and every seed's amplitude."""
    equation, _, cosines, _ = state
    amplitudes = np.abs(seed_amplitudes(equation, cosines))
    by_seed = zip(equation.seeds, amplitudes, strict=True)
    largest = float(np.abs(cosines).max())
    return {"the largest coefficient": largest} | {f"A_{q}": float(a) for q, a in by_seed}


def _runs_away(sizes: dict[str, float], reached: dict[str, float], growth: float) -> str:
    """The first size that has left that of the guess, in words; empty where there is none."""
    for name, old in sizes.items():
        new = reached[name]
        if not old / growth < new < old * growth:
            return f"{name} goes from {old:.3g} to {new:.3g}"
    return ""
