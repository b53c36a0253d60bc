"""How frequencies and actions of a torus change with its amplitudes, to all digits of the torus.

The equations are those of `newton_twist`: Newton's matrix J and a unit change of ln A_j. They are
linear: a sweep takes J (dc, domega) in fixed point, by Kronecker products, and solves for what is
left of it in doubles. It gains as many digits as that solution has.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.action_angle.actions import half_weighted
from symfpu.action_angle.newton_twist import NoTwist, equation_of
from symfpu.normal.kronecker import KroneckerFlow
from symfpu.numbers.arithmetic import (
    MULTIPRECISION,
    Numbers,
    doubles_as_integers,
    from_integers,
    mpf,
)
from symfpu.refinement.conditions import Amplitude, seed_amplitudes
from symfpu.refinement.digits import (
    ACCURACY,
    CARRIED_DIGITS,
    DOUBLE_BITS,
    ROUNDING_BITS,
    STALL_SWEEPS,
    SWEEPS,
)
from symfpu.refinement.equation import Floats
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.newton import Correction
from symfpu.tori.quasiperiodic import QuasiPeriodic


class Tangent(NamedTuple):
    """A change of the coefficients (H, N-1) and of the frequencies (s,) in fixed point."""

    cosines: Integers
    shifts: Integers


def changes_in_digits(torus: QuasiPeriodic) -> tuple[Numbers, Numbers]:
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

    def __init__(self, torus: QuasiPeriodic) -> None:
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
        self.divisors: Integers = squares[:, None] - self.flow.squares
        self.correction = self._correction()

    def _correction(self) -> Correction:
        """Newton's matrix in doubles, where all amplitudes are held."""
        doubles = self.known.astype(float).astype(np.longdouble)
        amplitudes = seed_amplitudes(self.equation, doubles)
        conditions = [Amplitude(i, A) for i, A in enumerate(amplitudes)]
        shifts = shifts_of(self.torus)
        try:
            return Correction(self.equation, conditions, doubles, shifts)
        except (np.linalg.LinAlgError, ValueError) as failure:
            raise NoTwist(f"Newton's matrix is singular ({failure})") from failure

    def by_amplitude(self, place: int) -> tuple[Numbers, Numbers]:
        """Derivatives of the frequencies and of the actions by ln A of one seed, (s,)."""
        found = self._converged(self._unit(place))
        with mpmath.workprec(self.bits):
            exponent = np.asarray(-self.bits)
            by_cosine = from_integers(found.cosines, exponent)
            by_shift = from_integers(found.shifts, exponent)
            return by_shift, self._by_action(by_cosine, by_shift)

    def _by_action(self, by_cosine: Numbers, by_shift: Numbers) -> Numbers:
        omega = np.array([MULTIPRECISION.number(w) for w in self.torus.frequencies])
        mixed = 2 * (self.known * by_cosine).sum(axis=1)
        squares = (self.known**2).sum(axis=1)
        moved = half_weighted(self.harmonics, omega, mixed)
        return np.asarray(moved + half_weighted(self.harmonics, by_shift, squares))

    def _unit(self, place: int) -> Tangent:
        """ln A of one seed changes by one, nothing else: where the sweeps begin."""
        cosines = np.zeros(self.mask.shape, dtype=object)
        at = self.equation.seed_rows[place], self.equation.seed_columns[place]
        cosines[at] = self.c[at]
        return Tangent(cosines, np.zeros(len(self.torus.seeds), dtype=object))

    def _converged(self, tangent: Tangent) -> Tangent:
        """With sweeps until what is left of J is rounding; NoTwist where they gain nothing."""
        least, stalled = math.inf, 0
        for _ in range(SWEEPS):
            image = self._image(tangent)
            bits = max(abs(int(x)).bit_length() for x in image.flat)
            if bits <= ROUNDING_BITS:
                return tangent
            stalled = 0 if bits < least else stalled + 1
            if stalled >= STALL_SWEEPS:
                break
            least = min(least, bits)
            tangent = self._corrected(tangent, image, bits)
        gained = (self.bits - least) * math.log10(2)
        reason = f"the sweeps in fixed point leave 1e-{gained:.0f} of Newton's equations"
        raise NoTwist(f"{reason}: take twist(torus.in_doubles())")

    def _image(self, tangent: Tangent) -> Integers:
        """J of a change, where the amplitudes change as they should; (H, N-1)."""
        turned = (
            self.rates * (self.harmonics.astype(object) @ tangent.shifts)
        ) >> self.bits
        moved = self.divisors * tangent.cosines + 2 * turned[:, None] * self.c
        force = self._force_change(tangent.cosines)
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

    def _corrected(self, tangent: Tangent, image: Integers, bits: int) -> Tangent:
        by_cosine, by_shift = self._change(image, bits)
        equation = self.equation
        by_cosine[equation.seed_rows, equation.seed_columns] = 0
        cosines = tangent.cosines + doubles_as_integers(by_cosine, bits)
        return Tangent(cosines, tangent.shifts + doubles_as_integers(by_shift, bits))

    def _change(self, image: Integers, bits: int) -> tuple[Floats, Any]:
        """What takes an image away, times 2^-bits."""
        dropped, kept = max(bits - DOUBLE_BITS, 0), min(bits, DOUBLE_BITS)
        small = np.asarray(image >> dropped, dtype=float)
        try:
            by_cosine, by_shift, _ = self.correction(np.ldexp(small, -kept), ACCURACY)
        except np.linalg.LinAlgError as failure:
            raise NoTwist(f"Newton's matrix is singular ({failure})") from failure
        return by_cosine, by_shift
