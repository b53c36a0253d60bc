"""Tori of any number of angles to many digits.

One sweep takes the residual of the invariance equation in fixed point, by Kronecker products, and
solves Newton's equations for it in doubles, with the matrix at the torus in doubles: it gains as
many digits as the solution has. The harmonics are those that a fit of the coefficients expects
above the last digit; after the sweeps the residual at all harmonics, of a box a quarter larger,
says what is missing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.tension_terms import has_terms
from symfpu.errors import InputError
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.numbers.arithmetic import (
    GUARD_DIGITS,
    doubles_as_integers,
    from_integers,
    mpf,
)
from symfpu.numbers.typed import integer
from symfpu.refinement.conditions import Amplitude, Condition, FrequencyShift
from symfpu.refinement.equation import Floats, Ints
from symfpu.refinement.harmonics import within_reach
from symfpu.refinement.invariance import InvarianceEquation, long
from symfpu.refinement.kept_sweeps import Keep, Reached, unkept
from symfpu.refinement.kronecker import Box, Integers, KroneckerForce
from symfpu.refinement.lattice import canonical_signs, places_of
from symfpu.refinement.newton import Correction
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic, show

MOST_DIGITS = 1000
MOST_HARMONICS = 150_000
SPARE_DIGITS = 4  # beyond those asked for, of the smallest coefficient that is kept
DOUBLE_DIGITS = 16
CARRIED_DIGITS = (
    GUARD_DIGITS + 6
)  # beyond those asked for, in fixed point: small divisors take some
ACCURACY = 1e-12  # of the solution for a correction
SWEEPS = 300
STALL_SWEEPS = 4  # sweeps without a smaller residual that end the search
ROUNDING_BITS = 24  # of a residual in last places, before the last correction
GUARD_BITS = 128  # of coefficients that are larger than 1
CHECK_BITS = 64  # more than those of the torus, in the check of its residual
CHECKED = 1.25  # times as large as the harmonics of the torus: those of its residual
DOUBLE_BITS = 1000  # of an integer that goes into a double
ROUNDS = 6  # choices of harmonics
NEAR_REACH = 1.01  # times the largest stretch
SAMPLES = 512  # times at which the acceleration is looked at

NO_TERMS = "refine it in doubles, or take the polynomial of its first coefficients"


@dataclass(frozen=True, eq=False, kw_only=True)
class PreciseTorus(FourierTorus):
    """A torus with many digits, of any number of angles; dimensionless, phases in radians.

    Made by `refine` and `refine_at_amplitudes` with `digits`. Ours: the paper has series alone.

    chain, seeds : the model and the s seeds. frequencies : omega of every seed, exact, shape (s,).
    harmonics : the nu, shape (H, s). cosines : c_q[nu] as mpf, shape (H, N-1). phases : by seed.
    digits : of the largest coefficient.
    bound : above |Q'' - force| of every mode at all angles, relative to the largest acceleration
        at 512 times: the sum of the sizes of the Fourier coefficients of the residual, with all
        that its computation rounds or leaves out.
    error : of a coefficient, relative to the largest: an estimate, what one more step of Newton's
        method would change, at harmonics that were left out too. No proof: that takes a bound of
        the inverse, for all small divisors.
    sweeps : corrections made, those with fewer harmonics too.

    >>> from symfpu import Chain, refine, torus_at_amplitudes
    >>> guess = torus_at_amplitudes(Chain(N=4, beta="0.5"), {1: "0.1", 2: "0.1"}, order=3)
    >>> refine(guess, digits=30)
    PreciseTorus(N=4, beta=0.5, omega_1=0.76711..., omega_2=1.41631..., A_1=0.0999...,
    A_2=0.1000..., 30 digits, ... harmonics, residual below ..., error about ...)
    """

    bound: Any = field(default=mpmath.inf)
    error: Any = field(default=mpmath.inf)
    sweeps: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        show(self, "bound", "error")

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        by_seed = zip(self.seeds, self.frequencies, strict=True)
        rates = ", ".join(f"omega_{q}={float(w):.16g}" for q, w in by_seed)
        sizes = ", ".join(f"A_{q}={float(a):.16g}.." for q, a in self.amplitudes.items())
        which = f"{chain}, {rates}, {sizes}, {self.digits} digits"
        bound, error = mpmath.nstr(self.bound, 2), mpmath.nstr(self.error, 2)
        quality = f"residual below {bound}, error about {error}"
        return f"PreciseTorus({which}, {len(self.harmonics)} harmonics, {quality})"


class Failure(Exception):
    """The sweeps gain no digits; the message says how far they came."""


class Guess(NamedTuple):
    """Where the sweeps begin: coefficients by harmonic (N-1,), and what is held.

    frequencies : exact; found anew where amplitudes are given. amplitudes : None, or of the seeds.
    phases : of the result. digits : of the coefficients, None for doubles. sweeps : made so far.
    """

    chain: Chain
    seeds: tuple[int, ...]
    coefficients: dict[tuple[int, ...], Any]
    frequencies: tuple[Fraction, ...]
    amplitudes: tuple[Fraction, ...] | None
    phases: dict[int, Any]
    digits: int | None
    sweeps: int = 0


def require_digits(chain: Chain, digits: int) -> None:
    """InputError for digits out of range, and for chains whose force has no known series."""
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"1..{MOST_DIGITS}", "take fewer")
    if not has_terms(chain):
        allowed = "a torus of a chain whose V is a polynomial, or not even and made of "
        allowed += "exponentials and powers, with rational numbers"
        raise InputError("torus", f"one of {chain!r}", allowed, NO_TERMS)


def guess_of(
    torus: QuasiPeriodic,
    frequencies: tuple[Fraction, ...],
    amplitudes: tuple[Fraction, ...] | None,
) -> Guess:
    """A torus in doubles or in digits as where the sweeps begin."""
    rows = {}
    for nu, row in zip(torus.harmonics.tolist(), torus.cosines, strict=True):
        sign = -1 if next((n for n in nu if n), 1) < 0 else 1
        rows[tuple(sign * n for n in nu)] = row
    phases = dict(torus.phases)
    return Guess(
        torus.chain, torus.seeds, rows, frequencies, amplitudes, phases, torus.digits
    )


def resumed(guess: Guess, reached: Reached) -> Guess:
    """A guess with what an earlier run had reached."""
    with mpmath.workprec(reached.bits + GUARD_BITS):
        table = from_integers(reached.coefficients, np.asarray(-reached.bits))
        rows = map(tuple, reached.harmonics.tolist())
        frequencies = guess.frequencies
        if guess.amplitudes is not None:
            frequencies = _rational(reached.omega, reached.bits)
        return guess._replace(
            coefficients=dict(zip(rows, table, strict=True)),
            frequencies=frequencies,
            digits=reached.digits,
            sweeps=reached.sweeps,
        )


def _rational(omega: Integers, bits: int) -> tuple[Fraction, ...]:
    return tuple(Fraction(int(w), 1 << bits) for w in omega)


def precise_torus(
    guess: Guess, digits: int, tell: Progress, keep: Keep = unkept
) -> PreciseTorus:
    """The torus near the guess with so many digits; raises Failure, and InputError for too many.

    keep : called with what is reached after every sweep.

    Half of the digits first: from their fall-off the harmonics of all are known better, and fewer
    sweeps need all of them. Then harmonics are added until none that is left out has an error
    above the last digit.
    """
    if digits // 2 > _digits_of(guess):
        _fitted(guess, digits)  # refuses what will not fit before anything is computed
        guess = _reached(guess, digits // 2, tell, keep)
    with mpmath.workdps(digits + CARRIED_DIGITS):
        harmonics = _fitted(guess, digits)
        for _ in range(ROUNDS):
            sweeps = _converged(guess, harmonics, digits, tell, keep)
            left = sweeps.left_over()
            tell(f"residual below {mpmath.nstr(left.bound, 2)}", NO_FRACTION)
            if left.error < mpmath.mpf(10) ** -digits:
                return sweeps.result(digits, left)
            guess = sweeps.guess(digits)
            more = _fitted(guess, digits), left.needed(digits)
            harmonics = np.unique(np.concatenate([harmonics, *more]), axis=0)
    reason = f"{ROUNDS} choices of harmonics leave errors of {mpmath.nstr(left.error, 2)}"
    raise Failure(reason)


def _reached(guess: Guess, digits: int, tell: Progress, keep: Keep) -> Guess:
    """A guess of so many digits, with the harmonics that a fit expects; not checked."""
    if digits // 2 > _digits_of(guess):
        guess = _reached(guess, digits // 2, tell, keep)
    with mpmath.workdps(digits + CARRIED_DIGITS):
        harmonics = _fitted(guess, digits)
        return _converged(guess, harmonics, digits, tell, keep).guess(digits)


def _converged(
    guess: Guess, harmonics: Ints, digits: int, tell: Progress, keep: Keep
) -> TorusSweeps:
    sweeps = TorusSweeps(guess, harmonics)
    tell(f"{len(harmonics)} harmonics, {sweeps.force.bits} bits", NO_FRACTION)
    sweeps.converge(digits, tell, keep)
    return sweeps


def _fitted(guess: Guess, digits: int) -> Ints:
    """Harmonics expected above the last digit of the largest coefficient, and some more."""
    sizes = {nu: max(abs(x) for x in row) for nu, row in guess.coefficients.items()}
    largest = mpf(max(sizes.values()))
    least = largest * mpmath.mpf(10) ** -_digits_of(guess)
    pairs = ((nu, mpf(x)) for nu, x in sizes.items())
    heights = {nu: float(mpmath.log(x / largest)) for nu, x in pairs if x > least}
    functions, s = (guess.chain.N + 1) // 2, len(guess.seeds)
    depth = (digits + SPARE_DIGITS) * math.log(10)
    found, full = within_reach(heights, functions, s, depth, most=MOST_HARMONICS)
    if full:
        allowed = f"what {MOST_HARMONICS} harmonics, or a lattice that fits, can give"
        raise InputError("digits", digits, allowed, "take fewer, or smaller amplitudes")
    return found


def _digits_of(guess: Guess) -> int:
    return DOUBLE_DIGITS if guess.digits is None else guess.digits


@dataclass(frozen=True, eq=False)
class LeftOver:
    """What Newton's method left at chosen harmonics and at others, relative.

    inside : largest change that the matrix asks for. outside : |residual / divisor| at harmonics
    that were left out, (M, s), the largest of each.
    """

    inside: Any
    harmonics: Ints
    outside: list[Any]

    @property
    def error(self) -> Any:
        return max([self.inside, *self.outside])

    def needed(self, digits: int) -> Ints:
        """Harmonics that were left out with an error of the last digit; (M, s)."""
        least = mpmath.mpf(10) ** -(digits + 1)
        return self.harmonics[[x > least for x in self.outside]]


@dataclass(frozen=True, eq=False)
class LeftOfTorus(LeftOver):
    """The residual at all harmonics of a larger box, over the largest coefficient.

    bound : as of PreciseTorus, not relative.
    """

    bound: Any


class TorusSweeps:
    """A torus in fixed point, c and omega, and Newton's matrix that corrects it.

    Made at the working precision of mpmath.
    """

    def __init__(self, guess: Guess, harmonics: Ints) -> None:
        self.start, self.chain, self.harmonics = guess, guess.chain, harmonics
        chain, seeds = guess.chain, guess.seeds
        self.number = guess.sweeps
        self.equation = InvarianceEquation(chain, seeds, harmonics)
        none = np.zeros(chain.N - 1)
        rows = [guess.coefficients.get(tuple(nu), none) for nu in harmonics.tolist()]
        table = np.where(self.equation.mask, np.array(rows, dtype=object), 0)
        doubles = table.astype(float)
        largest = float(np.abs(doubles).max())
        _, exponent = math.frexp(largest)
        bits = int(mpmath.mp.prec) - exponent
        box = Box(np.abs(harmonics).max(axis=0), whole=False)
        self.force = KroneckerForce(chain, box, bits, self._reach(doubles))
        fixed = self.force.fixed
        self.size = fixed(mpmath.mpf(largest))
        each_fixed = np.frompyfunc(lambda x: fixed(mpmath.mpf(x)), 1, 1)
        self.c: Integers = each_fixed(table)
        self.omega: Integers = np.array([fixed(w) for w in guess.frequencies], dtype=object)
        if guess.amplitudes is not None:
            held = [fixed(a) for a in guess.amplitudes]
            self.c[self.equation.seed_rows, self.equation.seed_columns] = held
        self._set_matrix(doubles)

    def _reach(self, doubles: Floats) -> float:
        """What no stretch of the torus exceeds, nor of one near to it."""
        stretch, _ = self.equation.stretches_of_half()
        return float(NEAR_REACH * np.abs(doubles @ stretch).sum(axis=0).max())

    def _set_matrix(self, doubles: Floats) -> None:
        equation, guess = self.equation, self.start
        linear = [self.chain.linear_frequency(q) for q in guess.seeds]
        pairs = zip(guess.frequencies, linear, strict=True)
        shifts = np.array([long(mpf(w) - x) for w, x in pairs])
        conditions: Sequence[Condition]
        if guess.amplitudes is None:
            conditions = [FrequencyShift(i, x) for i, x in enumerate(shifts)]
        else:
            conditions = [Amplitude(i, long(a)) for i, a in enumerate(guess.amplitudes)]
        self.correction = Correction(
            equation, conditions, doubles.astype(np.longdouble), shifts
        )

    def converge(self, digits: int, tell: Progress, keep: Keep = unkept) -> None:
        """Sweep until the next residual is below the last digit, or rounding. Raises Failure.

        A sweep is expected to gain what the one before it did.
        """
        wanted = math.floor((digits + SPARE_DIGITS + 2) * math.log2(10))
        enough = max(ROUNDING_BITS, self.size.bit_length() - wanted)
        least, stalled = math.inf, 0
        for _ in range(SWEEPS):
            self.number += 1
            imbalance = self._imbalance()
            bits = max(abs(int(x)).bit_length() for x in imbalance.flat)
            left = (bits - self.size.bit_length()) * math.log10(2)
            tell(f"sweep {self.number}: residual 1e{left:.0f}", NO_FRACTION)
            self._correct(imbalance, bits)
            keep(self._kept(min(digits, math.floor(-left))))
            expected = bits if math.isinf(least) else 2 * bits - least
            if bits <= ROUNDING_BITS or expected <= enough:
                return
            least, stalled = min(least, bits), 0 if bits < least else stalled + 1
            if stalled >= STALL_SWEEPS:
                break
        gained = (self.size.bit_length() - least) * math.log10(2)
        raise Failure(f"the sweeps in fixed point stop at a residual of 1e-{gained:.0f}")

    def _imbalance(self) -> Integers:
        """((nu.omega)^2 - Omega_q^2) c_q[nu] - force at the chosen harmonics; (H, N-1)."""
        force, _ = self.force.force(self.harmonics, self.c, self.harmonics)
        rates = self.harmonics.astype(object) @ self.omega
        divisors = ((rates**2) >> self.force.bits)[:, None] - self.force.squares
        moved = (divisors * self.c) >> self.force.bits
        return np.where(self.equation.mask, moved - force, 0)

    def _correct(self, imbalance: Integers, bits: int) -> None:
        by_cosine, by_shift = self._change(imbalance, bits)
        equation = self.equation
        if self.start.amplitudes is None:
            by_shift = np.zeros(len(by_shift))
        else:
            by_cosine[equation.seed_rows, equation.seed_columns] = 0
        mask = equation.mask
        self.c[mask] += doubles_as_integers(by_cosine[mask], bits)
        self.omega += doubles_as_integers(by_shift, bits)

    def _change(self, imbalance: Integers, bits: int) -> tuple[Floats, Floats]:
        """What takes the imbalance away, times 2^-bits."""
        dropped, kept = max(bits - DOUBLE_BITS, 0), min(bits, DOUBLE_BITS)
        small = np.asarray(imbalance >> dropped, dtype=float)
        by_cosine, by_shift, _ = self.correction(np.ldexp(small, -kept), ACCURACY)
        return by_cosine, by_shift

    @property
    def frequencies(self) -> tuple[Fraction, ...]:
        """Exact: those given, or those found."""
        if self.start.amplitudes is None:
            return self.start.frequencies
        return _rational(self.omega, self.force.bits)

    def coefficients(self) -> Any:
        """c as mpf, (H, N-1)."""
        return from_integers(self.c, np.asarray(-self.force.bits))

    def _kept(self, digits: int) -> Reached:
        bits, reached = self.force.bits, max(digits, 1)
        return Reached(self.harmonics, self.c, self.omega, bits, reached, self.number)

    def guess(self, digits: int) -> Guess:
        """What was reached, of so many digits, to go on from with other harmonics."""
        rows = map(tuple, self.harmonics.tolist())
        reached = dict(zip(rows, self.coefficients(), strict=True))
        return self.start._replace(
            coefficients=reached,
            frequencies=self.frequencies,
            digits=digits,
            sweeps=self.number,
        )

    def left_over(self) -> LeftOfTorus:
        """The residual at all harmonics of a larger box, in more digits."""
        finer = self._finer()
        wanted = canonical_signs(finer.box.harmonics)
        c = self.c << CHECK_BITS
        force, off = finer.force(self.harmonics, c, wanted)
        rows = places_of(self.harmonics, wanted)
        omega = np.array([finer.fixed(w) for w in self.frequencies], dtype=object)
        rates = wanted.astype(object) @ omega
        divisors = ((rates**2) >> finer.bits)[:, None] - finer.squares
        allowed = self.equation.allowed(wanted)
        imbalance = np.where(allowed, -force, 0)
        imbalance[rows] += (divisors[rows] * c) >> finer.bits
        out = np.ones(len(wanted), dtype=bool)
        out[rows] = False
        outside = self._relative(imbalance[out], divisors[out], finer.bits)
        rounding = len(c) * (1 + max(abs(int(w)) for w in omega) >> finer.bits)
        total = max(abs(imbalance).sum(axis=0) + off) + rounding
        bound = mpmath.ldexp(int(total), -finer.bits) / self._acceleration()
        inside = self._inside(imbalance[rows])
        return LeftOfTorus(inside, wanted[out], outside, bound)

    def _finer(self) -> KroneckerForce:
        highest = np.ceil(CHECKED * np.abs(self.harmonics).max(axis=0)).astype(int)
        bits = self.force.bits + CHECK_BITS
        reach = self._reach(self.in_doubles())
        return KroneckerForce(self.chain, Box(highest, whole=True), bits, reach)

    def in_doubles(self) -> Floats:
        """The coefficients in doubles, (H, N-1)."""
        return np.asarray(self.coefficients(), dtype=float)

    def _relative(self, imbalance: Integers, divisors: Integers, bits: int) -> list[Any]:
        """Largest |imbalance / divisor| of each harmonic over the largest coefficient."""
        with mpmath.workprec(64):
            largest = mpmath.mpf(self.size) * 2**CHECK_BITS
            found = []
            for row, below in zip(abs(imbalance), abs(divisors), strict=True):
                pairs = zip(row.tolist(), below.tolist(), strict=True)
                shares = [(x << bits) // max(d, 1) for x, d in pairs if x]
                found.append(mpmath.mpf(int(max(shares, default=0))) / largest)
            return found

    def _inside(self, imbalance: Integers) -> Any:
        """Largest change that the matrix asks for, over the largest coefficient."""
        bits = max(abs(int(x)).bit_length() for x in imbalance.flat)
        by_cosine, _ = self._change(imbalance, bits)
        change = mpmath.ldexp(mpmath.mpf(float(np.abs(by_cosine).max())), bits - CHECK_BITS)
        return change / self.size

    def _acceleration(self) -> float:
        """The largest acceleration of a mode at some times: below the largest of all."""
        doubles = self._torus(None, self.in_doubles())
        t = np.linspace(0, 100 * np.pi / float(min(self.frequencies)), SAMPLES)
        forces = self.chain.accelerations(doubles.positions(t))
        return float(np.max(np.abs(forces)))

    def _torus(self, digits: int | None, cosines: Any) -> FourierTorus:
        guess = self.start
        return FourierTorus(
            guess.chain, guess.seeds, self.frequencies, self.harmonics, cosines, {}, digits
        )

    def result(self, digits: int, left: LeftOfTorus) -> PreciseTorus:
        """The torus, without harmonics that are zero in fixed point."""
        kept = self.c.any(axis=1)
        guess = self.start
        return PreciseTorus(
            chain=guess.chain,
            seeds=guess.seeds,
            frequencies=self.frequencies,
            harmonics=self.harmonics[kept],
            cosines=self.coefficients()[kept],
            phases=guess.phases,
            digits=digits,
            bound=left.bound,
            error=left.error,
            sweeps=self.number,
        )
