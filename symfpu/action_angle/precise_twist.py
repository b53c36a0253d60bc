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

from symfpu.action_angle.newton_twist import (
    NoTwist,
    action_change,
    equation_of,
    jacobian_of_amplitudes,
    singular_without_twist,
)
from symfpu.files.progress import unheard
from symfpu.normal.kronecker import KroneckerFlow
from symfpu.numbers.arithmetic import Numbers, from_integers, mpf
from symfpu.refinement.digits import ACCURACY, CARRIED_DIGITS
from symfpu.refinement.iterative_refinement import Failure, Problem, converge
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Floats
from symfpu.tori.torus import Torus


def changes_in_digits(torus: Torus) -> tuple[Numbers, Numbers]:
    """Derivatives of the frequencies and of the actions by ln A_j, (s, s), j last, as mpf.

    torus : that solves the equations of motion to its digits. Raises NoTwist.
    """
    assert torus.digits is not None
    smallest = min(float(abs(A)) for A in torus.amplitudes.values())
    spare = 2 * max(0, math.ceil(-math.log10(smallest)))
    with mpmath.workdps(torus.digits + CARRIED_DIGITS + spare):
        problem = TwistProblem(torus)
        pairs = [problem.by_amplitude(j) for j in range(len(torus.seeds))]
        by_shift, by_action = zip(*pairs, strict=True)
        return np.array(by_shift).T, np.array(by_action).T


class TwistProblem(Problem):
    """J (dc, domega) = 0 where ln A of one seed changes by one: dc and domega are unknown.

    J is exact, and its Jacobian in doubles; at the working precision of mpmath.
    """

    def __init__(self, torus: Torus) -> None:
        self.torus = torus
        self.equation, self.known = equation_of(torus)
        self.harmonics, self.mask = self.equation.harmonics, self.equation.mask
        self._seeds = self.equation.seed_rows, self.equation.seed_columns
        self._moving: NDArray[np.bool_] = np.asarray(self.harmonics.any(axis=1))
        both = np.concatenate([self.harmonics, -self.harmonics[self._moving]])
        self.flow = KroneckerFlow(torus, both, int(mpmath.mp.prec))
        self.bits, self.frequency_scale = self.flow.bits, 1.0
        each_fixed = np.frompyfunc(lambda x: self.flow.fixed(mpf(x)), 1, 1)
        self.c: Integers = each_fixed(self.known)
        self.rates: Integers = self.flow.rates[: len(self.harmonics)]
        squares = (self.rates**2) >> self.bits
        self.divisors: Integers = squares[:, None] - self.flow.squares(self.harmonics)
        doubles = self.known.astype(float).astype(np.longdouble)
        with singular_without_twist():
            self.jacobian = jacobian_of_amplitudes(torus, self.equation, doubles)

    def by_amplitude(self, place: int) -> tuple[Numbers, Numbers]:
        """Derivatives of the frequencies and of the actions by ln A of one seed, (s,)."""
        self._begin(place)
        try:
            converge(self, int(mpmath.mp.dps), unheard)
        except Failure as failure:
            raise NoTwist(f"{failure}: take twist(torus.in_doubles())") from failure
        with mpmath.workprec(self.bits):
            exponent = np.asarray(-self.bits)
            by_cosine = from_integers(self.coefficients, exponent)
            by_shift = from_integers(self.frequencies, exponent)
            omega = np.array([mpf(w) for w in self.torus.frequencies])
            change = by_cosine, by_shift
            return by_shift, action_change(self.harmonics, omega, self.known, *change)

    def _begin(self, place: int) -> None:
        """With a change of nothing but the amplitude of a seed."""
        at = tuple(part[place] for part in self._seeds)
        self.coefficients = np.zeros(self.mask.shape, dtype=object)
        self.coefficients[at] = self.c[at]
        self.frequencies = np.zeros(len(self.equation.seeds), dtype=object)
        self.largest, self.steps = abs(int(self.c[at])), 0

    def residual(self) -> Integers:
        """J of the changes of coefficients (H, C) and frequencies (s,); (H, C)."""
        turned = self.harmonics.astype(object) @ self.frequencies
        along = (self.rates * turned) >> self.bits
        moved = self.divisors * self.coefficients + 2 * along[:, None] * self.c
        return np.where(self.mask, (moved >> self.bits) - self._force_change(), 0)

    def _force_change(self) -> Integers:
        """The derivative of the force along the change of the coefficients, (H, C).

        Twice sum c cos(nu.theta) has c at nu and -nu, and twice c where nu = 0.
        """
        still = ~self._moving[:, None]
        halves = np.where(still, 2 * self.coefficients, self.coefficients)
        p = np.concatenate([halves, halves[self._moving]])
        found = self.flow.coupling(np.arange(len(p)), p)[: len(halves)]
        return np.where(still, found >> 1, found)

    def conditions(self) -> Integers:
        """None is left: the amplitudes are held."""
        return np.zeros(len(self.frequencies), dtype=object)

    def solve(self, residual: Floats, conditions: Floats) -> tuple[Floats, Floats]:
        by_cosine, by_shift = self.jacobian.correction(residual, conditions, ACCURACY)
        by_cosine[self._seeds] = 0
        return by_cosine, by_shift

    def after_step(self, digits: float) -> None:
        """Nothing: the equations are linear, so that no step leads elsewhere."""
