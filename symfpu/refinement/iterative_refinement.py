"""Iterative refinement: solutions with any number of digits, their residuals in integers.

The residual of the equations is computed in integers, the correction with a Jacobian in double
precision. Each step gains about 13 digits, those of a solution in doubles, however small the
residual is (Wilkinson). The unknowns are Fourier coefficients and a few frequencies, in fixed
point: integers times 2^-bits. What they solve is said by a problem: the invariance equation of a
torus (`symfpu.refinement.digits`), the equations linearised about one
(`symfpu.normal.digits`), the derivatives of a torus (`symfpu.action_angle.newton_twist`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, Self, TypeVar

import mpmath
import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.numbers.arithmetic import doubles_as_integers
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Floats, Ints

DOUBLE_DIGITS = 16
ROUNDING_BITS = 24  # of a residual in last places: it is rounding, and ends the refinement
STEP_DIGITS = 4  # beyond those asked for, of what the step after the last one would change
MOST_STEPS = 300
STALLED_STEPS = 4  # that bring no smaller residual and update, and end the refinement
MOST_CHOICES = 6  # of harmonics
CHECK_BITS = 64  # more than those of the unknowns, in the residual that is checked
DOUBLE_BITS = 1000  # of an integer that goes into a double


class Failure(Exception):
    """Refinement gains no digits; the message says how far it came."""


class Update(NamedTuple):
    """A change of the unknowns: doubles times 2^exponent, in last places."""

    coefficients: Floats
    frequencies: Floats
    exponent: int


class Problem(ABC):
    """Unknowns in fixed point, their residual in integers, and a Jacobian in doubles.

    bits : after the point. coefficients : of Fourier series, times 2^bits, shape (.., H, C).
    frequencies : times 2^bits, shape (n,). mask : which coefficients are unknown, (H, C).
    largest : of the coefficients, times 2^bits; updates and residuals are relative to it.
    frequency_scale : what updates of frequencies are relative to. name : in front of what is
    reported. steps : made so far.
    """

    bits: int
    coefficients: Integers
    frequencies: Integers
    mask: Any
    largest: int
    frequency_scale: float
    name: str = ""
    steps: int = 0

    @abstractmethod
    def residual(self) -> Integers:
        """What the equations leave, times 2^bits, of the shape of the coefficients; 0 if masked."""

    def conditions(self) -> Integers:
        """What the conditions leave that fix one solution among many, times 2^bits, (n,)."""
        return np.zeros(0, dtype=object)

    @abstractmethod
    def solve(self, residual: Floats, conditions: Floats) -> tuple[Floats, Floats]:
        """Changes of coefficients and frequencies, by the Jacobian, that take a residual away.

        residual, conditions : one multiple of both that doubles hold. Raises LinAlgError for a
        singular Jacobian.
        """

    @abstractmethod
    def after_step(self, digits: float) -> None:
        """What is checked, kept or made anew after a step; before it there were so many digits."""

    def update(self, residual: Integers, conditions: Integers) -> Update:
        """What takes a residual away, in last places of that residual. Raises Failure."""
        exponent = max(bit_length(residual), bit_length(conditions))
        dropped, kept = max(exponent - DOUBLE_BITS, 0), min(exponent, DOUBLE_BITS)
        scaled = [
            np.ldexp(np.asarray(left >> dropped, dtype=float), -kept)
            for left in (residual, conditions)
        ]
        try:
            return Update(*self.solve(*scaled), exponent)
        except np.linalg.LinAlgError as failure:
            raise Failure(f"the Jacobian is singular ({failure})") from failure

    def size(self, update: Update) -> Any:
        """The largest relative change, as mpf: of a coefficient or of a frequency."""
        of_coefficients = (
            mpmath.mpf(float(np.abs(update.coefficients).max())) / self.largest
        )
        of_frequencies = float(np.abs(update.frequencies).max()) / self.frequency_scale
        relative = max(of_coefficients, mpmath.ldexp(of_frequencies, -self.bits))
        return mpmath.ldexp(relative, update.exponent)

    def add(self, update: Update) -> None:
        """Changes the unknowns."""
        changes = update.coefficients[..., self.mask]
        self.coefficients[..., self.mask] += doubles_as_integers(changes, update.exponent)
        moved = doubles_as_integers(update.frequencies, update.exponent)
        self.frequencies = self.frequencies + moved


def converge(problem: Problem, digits: int, report: Progress) -> None:
    """Refines until the next step is expected below the digits, or rounding. Raises Failure.

    A step is expected to gain what the one before it did. What is left of it is the larger of the
    relative residual and update: a bad Jacobian shows in the first, a small divisor in the second.
    """
    scale = math.log2(problem.largest)
    enough = -(digits + STEP_DIGITS) * math.log2(10)
    least, stalled = math.inf, 0
    for _ in range(MOST_STEPS):
        problem.steps += 1
        residual, conditions = problem.residual(), problem.conditions()
        bits = max(bit_length(residual), bit_length(conditions))
        size = (bits - scale) * math.log10(2)
        label = f"{problem.name}step {problem.steps}: residual 1e{size:.0f}"
        report(label, NO_FRACTION)
        if bits <= ROUNDING_BITS:
            return
        update = problem.update(residual, conditions)
        problem.add(update)
        left = max(bits - scale, _log2(problem.size(update)))
        problem.after_step(-left * math.log10(2))
        expected = left if math.isinf(least) else 2 * left - least
        if expected <= enough:
            return
        least, stalled = min(least, left), 0 if left < least else stalled + 1
        if stalled >= STALLED_STEPS:
            break
    left_over = least * math.log10(2)
    raise Failure(
        f"iterative refinement stops at a residual or update of 1e{left_over:.0f}"
    )


@dataclass(frozen=True, eq=False)
class Truncation:
    """What the equations leave at chosen harmonics and at others, by a residual in more digits.

    newton_update : the largest relative change that the Jacobian asks for. harmonics : those of a
    larger choice that were left out, (M, s). neglected : |residual / divisor| there, the largest
    of each, over the largest coefficient. residual : a measure of all of it, as the problem says.
    """

    newton_update: Any
    harmonics: Ints
    neglected: list[Any]
    residual: Any

    @property
    def error(self) -> Any:
        """Of a coefficient, relative: an estimate."""
        return max([self.newton_update, *self.neglected])

    def needed(self, digits: int) -> Ints:
        """Harmonics that were left out with an error of the last digit; (M, s)."""
        least = mpmath.mpf(10) ** -(digits + 1)
        return self.harmonics[[x > least for x in self.neglected]]


class TruncatedProblem(Problem):
    """A problem at chosen harmonics, to which others can be added."""

    @abstractmethod
    def truncation(self) -> Truncation:
        """What is left at all harmonics of a larger choice."""

    @abstractmethod
    def extended(self, harmonics: Ints) -> Self:
        """The same from what is reached, with more harmonics (M, s)."""


Refined = TypeVar("Refined", bound=TruncatedProblem)


def refined(problem: Refined, digits: int, report: Progress) -> tuple[Refined, Truncation]:
    """A problem solved to the digits, with harmonics added until none is missing.

    Raises Failure.
    """
    for _ in range(MOST_CHOICES):
        converge(problem, digits, report)
        left = problem.truncation()
        report(f"{problem.name}error about {mpmath.nstr(left.error, 2)}", NO_FRACTION)
        if left.error < mpmath.mpf(10) ** -digits:
            return problem, left
        problem = problem.extended(left.needed(digits))
    reason = (
        f"{MOST_CHOICES} choices of harmonics leave errors of {mpmath.nstr(left.error, 2)}"
    )
    raise Failure(reason)


def neglected(residual: Integers, divisors: Integers, bits: int, largest: int) -> list[Any]:
    """Largest |residual / divisor| of each harmonic, over the largest coefficient; M mpf.

    residual, divisors : (M, C); largest : likewise times 2^bits.
    """
    with mpmath.workprec(64):
        found = []
        for row, below in zip(abs(residual), abs(divisors), strict=True):
            pairs = zip(row.tolist(), below.tolist(), strict=True)
            shares = [(x << bits) // max(d, 1) for x, d in pairs if x]
            found.append(mpmath.mpf(int(max(shares, default=0))) / largest)
        return found


def bit_length(values: Integers) -> int:
    """Of the largest integer."""
    return max((abs(int(x)).bit_length() for x in values.flat), default=0)


def _log2(value: Any) -> float:
    return float(mpmath.log(value, 2)) if value else -math.inf
