"""How frequencies and actions of a torus change with its amplitudes, by Newton's matrix.

The unknowns are the coefficients c and the frequencies, the equations those of invariance with one
condition for each amplitude. Newton's matrix solved for a unit change of ln A_j gives dc and
domega; no difference is taken. Where the frequencies turn back, domega/dlnA is singular and the
matrix is not. On a ring the coefficients are those of its one function of the angles where waves
travel, and those of the fixed ends where they stand: then the ring has twice their actions.

To all digits of a torus the same equations, which are linear, are solved by iterative refinement:
J (dc, domega) is taken in integers, its products by Kronecker substitution; the Jacobian is J in
doubles.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.actions import actions, half_weighted
from symfpu.errors import SymfpuError
from symfpu.files.progress import unheard
from symfpu.normal.kronecker import KroneckerFlow
from symfpu.numbers.arithmetic import Numbers, from_integers, mpf
from symfpu.refinement.conditions import amplitude, seed_amplitudes
from symfpu.refinement.digits import ACCURACY, CARRIED_DIGITS
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.harmonics import by_harmonic, unit_harmonics
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.iterative_refinement import Failure, Problem, converge
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.linear_system import Jacobian, NewtonState
from symfpu.tori.torus import Torus
from symfpu.tori.unfolding import folded

REFINED = 1e-8  # residual of a torus, relative, above which it is refused


class NoTwist(SymfpuError):
    """The twist of a torus does not exist or cannot be found: raised by `twist`.

    reason : in words. Ours.

    >>> raise NoTwist("Newton's matrix is singular")
    Traceback (most recent call last):
    symfpu.action_angle.newton_twist.NoTwist: no twist: Newton's matrix is singular
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(f"no twist: {reason}")


def changes_by_newton(torus: Torus) -> tuple[Floats, Floats]:
    """Derivatives of the frequencies and of the actions by ln A_j, (s, s), j last.

    torus : that solves the equations of motion, in doubles; of a ring, travelling waves or what
        `unfold` gave. Raises NoTwist.
    """
    found = _changes(torus)
    return found.by_shift.T, found.by_action.T


def action_turn(torus: Torus) -> float:
    """det of d ln I_i / d ln A_j: it passes zero where the actions turn on a family; NoTwist."""
    by_action = _changes(torus).by_action
    by_logarithm = by_action / np.array(list(actions(torus).values()))
    return float(np.linalg.det(by_logarithm))


@dataclass(frozen=True, eq=False)
class ActionChanges:
    """A torus and how it changes with its actions.

    harmonics : (H, s). cosines : c, (H, C). by_cosine : dc/dI_i, (s, H, C). twist : Lambda_ij =
    domega_i/dI_j, (s, s). The columns are the modes of fixed ends, C = N-1, also where waves stand;
    of travelling waves there is one, that of their function of the angles.
    """

    harmonics: Ints
    cosines: Floats
    by_cosine: Floats
    twist: Floats


def changes_by_action(torus: Torus) -> ActionChanges:
    """The same by the actions, with what the coefficients do. Raises NoTwist."""
    found = _changes(torus)
    try:
        by_amplitude = np.linalg.inv(found.by_action)
    except np.linalg.LinAlgError as failure:
        raise NoTwist("the actions do not change with the amplitudes") from failure
    return ActionChanges(
        harmonics=found.equation.harmonics,
        cosines=found.cosines,
        by_cosine=np.tensordot(by_amplitude, found.by_cosine, axes=1),
        twist=(by_amplitude @ found.by_shift).T,
    )


class _Changes(NamedTuple):
    """By ln A_j, j first."""

    equation: InvarianceEquation
    cosines: Floats
    by_cosine: Floats
    by_shift: Floats
    by_action: Floats


def _changes(torus: Torus) -> _Changes:
    if torus.stands:
        half = _changes(folded(torus))
        return half._replace(by_action=2 * half.by_action)
    equation, table = equation_of(torus)
    cosines = table.astype(np.longdouble)
    with singular_without_twist():
        jacobian = jacobian_of_amplitudes(torus, equation, cosines)
        by_cosine, by_shift = jacobian.responses(len(torus.seeds))
    omega = np.array([float(w) for w in torus.frequencies])
    known = cosines.astype(float)
    by_action = [
        action_change(equation.harmonics, omega, known, *change)
        for change in zip(by_cosine, by_shift, strict=True)
    ]
    return _Changes(equation, known, by_cosine, by_shift, np.array(by_action))


def jacobian_of_amplitudes(
    torus: Torus, equation: InvarianceEquation, cosines: Floats
) -> Jacobian:
    """Newton's matrix at a torus in long doubles where all amplitudes are held."""
    held = enumerate(seed_amplitudes(equation, cosines))
    conditions = [amplitude(i, A, len(torus.seeds)) for i, A in held]
    return Jacobian(NewtonState(equation, conditions, cosines, shifts_of(torus)))


@contextmanager
def singular_without_twist() -> Iterator[None]:
    """NoTwist where Newton's matrix is singular."""
    try:
        with np.errstate(divide="ignore", invalid="ignore"):
            yield
    except (np.linalg.LinAlgError, ValueError) as failure:
        raise NoTwist(f"Newton's matrix is singular ({failure})") from failure


def action_change(
    harmonics: Ints, omega: Numbers, cosines: Numbers, by_cosine: Numbers, by_shift: Numbers
) -> Numbers:
    """What the actions change by with cosines (H, C) and frequencies (s,); shape (s,)."""
    mixed = 2 * (cosines * by_cosine).sum(axis=1)
    squares = (cosines**2).sum(axis=1)
    moved = half_weighted(harmonics, omega, mixed)
    return np.asarray(moved + half_weighted(harmonics, by_shift, squares))


def equation_of(torus: Torus) -> tuple[InvarianceEquation, Numbers]:
    """The equation on the harmonics of a torus, the seeds' own among them, and its cosines.

    Cosines (H, C) as the torus has them, 0 where the symmetry forbids one.
    """
    rows = by_harmonic(torus.harmonics, torus.cosines)
    none = np.zeros(torus.cosines.shape[1])
    for unit in unit_harmonics(len(torus.seeds)):
        rows.setdefault(unit, none)
    listed = sorted(rows)
    equation = InvarianceEquation(
        torus.chain, torus.seeds, np.array(listed, dtype=np.int64)
    )
    cosines = np.array([rows[nu] for nu in listed])
    return equation, np.where(equation.mask, cosines, 0)


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
        self.c = self.flow.fixed_values(self.known)
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
