"""How frequencies and actions of a torus change with its amplitudes, to all digits of the torus.

The equations are those of `newton_twist`: Newton's matrix J and a unit change of ln A_j. They are
linear, and solved by iterative refinement: J (dc, domega) is taken in integers, its products by
Kronecker substitution; the Jacobian is J in doubles.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.actions import half_weighted
from symfpu.action_angle.newton_twist import NoTwist, equation_of
from symfpu.files.progress import unheard
from symfpu.normal.kronecker import KroneckerFlow
from symfpu.numbers.arithmetic import MULTIPRECISION, Numbers, from_integers, mpf
from symfpu.refinement.conditions import amplitude, seed_amplitudes
from symfpu.refinement.digits import ACCURACY, CARRIED_DIGITS
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.iterative_refinement import Failure, Problem, converge
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Floats
from symfpu.refinement.newton import Correction
from symfpu.tori.torus import Torus


def changes_in_digits(torus: Torus) -> tuple[Numbers, Numbers]:
    """Derivatives of the frequencies and of the actions by ln A_j, (s, s), j last, as mpf.

    torus : that solves the equations of motion to its digits. Raises NoTwist.
    """
    assert torus.digits is not None
    smallest = min(float(abs(A)) for A in torus.amplitudes.values())
    spare = 2 * max(0, math.ceil(-math.log10(smallest)))
    with mpmath.workdps(torus.digits + CARRIED_DIGITS + spare):
        tangents = Tangents(torus)
        pairs = [tangents.by_amplitude(j) for j in range(len(torus.seeds))]
        by_shift, by_action = zip(*pairs, strict=True)
        return np.array(by_shift).T, np.array(by_action).T


class Tangents:
    """J at a torus with many digits, exact and in doubles; at the working precision of mpmath."""

    def __init__(self, torus: Torus) -> None:
        self.torus = torus
        self.equation, self.known = equation_of(torus)
        self.harmonics, self.mask = self.equation.harmonics, self.equation.mask
        self._moving: NDArray[np.bool_] = np.asarray(self.harmonics.any(axis=1))
        both = np.concatenate([self.harmonics, -self.harmonics[self._moving]])
        self.flow = KroneckerFlow(torus, both, int(mpmath.mp.prec))
        self.bits = self.flow.bits
        each_fixed = np.frompyfunc(lambda x: self.flow.fixed(mpf(x)), 1, 1)
        self.c: Integers = each_fixed(self.known)
        self.rates: Integers = self.flow.rates[: len(self.harmonics)]
        squares = (self.rates**2) >> self.bits
        self.divisors: Integers = squares[:, None] - self.flow.squares(self.harmonics)
        self.correction = self._correction()

    def _correction(self) -> Correction:
        """Newton's matrix in doubles, where all amplitudes are held."""
        doubles = self.known.astype(float).astype(np.longdouble)
        amplitudes = seed_amplitudes(self.equation, doubles)
        conditions = [amplitude(i, A, len(amplitudes)) for i, A in enumerate(amplitudes)]
        shifts = shifts_of(self.torus)
        try:
            return Correction(self.equation, conditions, doubles, shifts)
        except (np.linalg.LinAlgError, ValueError) as failure:
            raise NoTwist(f"Newton's matrix is singular ({failure})") from failure

    def by_amplitude(self, place: int) -> tuple[Numbers, Numbers]:
        """Derivatives of the frequencies and of the actions by ln A of one seed, (s,)."""
        problem = TwistProblem(self, place)
        try:
            converge(problem, int(mpmath.mp.dps), unheard)
        except Failure as failure:
            raise NoTwist(f"{failure}: take twist(torus.in_doubles())") from failure
        with mpmath.workprec(self.bits):
            exponent = np.asarray(-self.bits)
            by_cosine = from_integers(problem.coefficients, exponent)
            by_shift = from_integers(problem.frequencies, exponent)
            return by_shift, self._by_action(by_cosine, by_shift)

    def _by_action(self, by_cosine: Numbers, by_shift: Numbers) -> Numbers:
        omega = np.array([MULTIPRECISION.number(w) for w in self.torus.frequencies])
        mixed = 2 * (self.known * by_cosine).sum(axis=1)
        squares = (self.known**2).sum(axis=1)
        moved = half_weighted(self.harmonics, omega, mixed)
        return np.asarray(moved + half_weighted(self.harmonics, by_shift, squares))

    def image(self, cosines: Integers, shifts: Integers) -> Integers:
        """J of a change of coefficients (H, C) and frequencies (s,); (H, C)."""
        along = (self.rates * (self.harmonics.astype(object) @ shifts)) >> self.bits
        moved = self.divisors * cosines + 2 * along[:, None] * self.c
        force = self._force_change(cosines)
        return np.where(self.mask, (moved >> self.bits) - force, 0)

    def _force_change(self, cosines: Integers) -> Integers:
        """The derivative of the force along a change of the coefficients, (H, N-1).

        Twice sum c cos(nu.theta) has c at nu and -nu, and twice c where nu = 0.
        """
        still = ~self._moving[:, None]
        halves = np.where(still, 2 * cosines, cosines)
        p = np.concatenate([halves, halves[self._moving]])
        found = self.flow.coupling(np.arange(len(p)), p)[: len(cosines)]
        return np.where(still, found >> 1, found)


class TwistProblem(Problem):
    """J (dc, domega) = 0 where ln A of one seed changes by one: dc and domega are unknown.

    place : of that seed. Refinement begins with a change of nothing but its amplitude.
    """

    def __init__(self, tangents: Tangents, place: int) -> None:
        equation, self.tangents = tangents.equation, tangents
        self.bits, self.mask = tangents.bits, tangents.mask
        self._seeds = equation.seed_rows, equation.seed_columns
        at = equation.seed_rows[place], equation.seed_columns[place]
        self.coefficients = np.zeros(self.mask.shape, dtype=object)
        self.coefficients[at] = tangents.c[at]
        self.frequencies = np.zeros(len(equation.seeds), dtype=object)
        self.largest = abs(int(tangents.c[at]))
        self.frequency_scale = 1.0

    def residual(self) -> Integers:
        return self.tangents.image(self.coefficients, self.frequencies)

    def conditions(self) -> Integers:
        """None is left: the amplitudes are held."""
        return np.zeros(len(self.frequencies), dtype=object)

    def solve(self, residual: Floats, conditions: Floats) -> tuple[Floats, Floats]:
        by_cosine, by_shift, _ = self.tangents.correction(residual, ACCURACY, conditions)
        by_cosine[self._seeds] = 0
        return by_cosine, by_shift

    def after_step(self, digits: float) -> None:
        """Nothing: the equations are linear, so that no step leads elsewhere."""
