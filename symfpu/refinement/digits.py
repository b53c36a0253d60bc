"""Tori of any number of angles to many digits, by iterative refinement.

The residual of the invariance equation is taken in integers, its products by Kronecker
substitution; the Jacobian is that of Newton's method at the torus in doubles. The harmonics are
those that a fit of the coefficients expects above the last digit. At the end the residual at all
harmonics of a box a quarter larger says which are missing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.projections.by_ends import count_points, projection
from symfpu.chain.projections.projection import Projection
from symfpu.chain.tension_terms import has_terms, terms
from symfpu.errors import InputError
from symfpu.files.locking import one_run
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.arithmetic import GUARD_DIGITS, from_integers, mpf, with_digits
from symfpu.numbers.typed import integer
from symfpu.refinement.guesses import frequency_shifts
from symfpu.refinement.harmonics import by_harmonic, coefficients_at, within_reach
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.iterative_refinement import (
    CHECK_BITS,
    DOUBLE_DIGITS,
    Failure,
    TruncatedProblem,
    Truncation,
    converge,
    neglected,
    refined,
)
from symfpu.refinement.kronecker import Box, Integers, KroneckerForce
from symfpu.refinement.lattice import Floats, Ints, canonical_signs, places_of
from symfpu.refinement.linear_system import Jacobian, NewtonState
from symfpu.refinement.prescribed import Prescribed
from symfpu.refinement.refinement_file import (
    Checkpoint,
    RefinementFile,
    Save,
    no_checkpoint,
)
from symfpu.results.field import Field
from symfpu.results.numbers import number_text
from symfpu.tori.torus import Origin, Torus

MOST_DIGITS = 1000
MOST_HARMONICS = 150_000
SPARE_DIGITS = 4  # beyond those asked for, of the smallest coefficient that is kept
# beyond those asked for, in fixed point: small divisors take some
CARRIED_DIGITS = GUARD_DIGITS + 6
ACCURACY = 1e-12  # of the solution for a correction
GUARD_BITS = 128  # of coefficients that are larger than 1
CHECKED = 1.25  # times as large as the harmonics of the torus: those of its residual
NEAR_REACH = 1.01  # times the largest stretch
NEAR = 2  # factor by which an amplitude may leave that of the guess
SAMPLES = 512  # times at which the acceleration is looked at

NO_TERMS = "refine it in doubles, or take the polynomial of its first coefficients"


@dataclass(frozen=True, eq=False, repr=False)
class IterativeRefinement(Origin):
    """Where a torus with many digits comes from: iterative refinement (`refine` with `digits`).

    Not in the paper, which has series alone. `digits` of the torus are those of its largest
    coefficient.

    bound : above |Q'' - force| of every mode at all angles, relative to the largest acceleration
        at 512 times: the sum of the sizes of the Fourier coefficients of the residual, with all
        that its computation rounds or leaves out.
    error : of a coefficient, relative to the largest: an estimate, what one more step of Newton's
        method would change, at harmonics that were left out too. No proof: that takes a bound of
        the inverse, for all small divisors.
    sweeps : steps of refinement, those with fewer harmonics too.

    >>> import symfpu
    >>> from symfpu import Chain, refine
    >>> given = {1: "0.1", 2: "0.1"}
    >>> symfpu.torus(Chain(N=4, beta="0.5"), (1, 2), amplitudes=given, digits=30)
    Torus(N=4, beta=0.5, omega_1=0.76711..., omega_2=1.41631..., A_1=0.1, A_2=0.1,
    30 digits, H=..., ... harmonics, residual below ..., error about ...)
    """

    name: ClassVar[str] = "iterative refinement"

    bound: Any
    error: Any
    sweeps: int

    def lines(self, known: Mapping[str, Any]) -> Iterator[str]:
        """For a reader. known : the record of the torus."""
        yield f"residual below     {known['residual_bound']}   (at all angles, relative)"
        yield f"coefficient error  {known['coefficient_error']}   (an estimate, relative)"

    def require_whole(self, torus: Torus) -> None:
        if torus.digits is None:
            raise ValueError("no digits of a torus that was refined to many")

    def fields(self, torus: Torus) -> Iterator[Field]:
        yield Field("residual_bound", number_text(self.bound, 3))
        yield Field("coefficient_error", number_text(self.error, 3))

    def quality(self, torus: Torus) -> str:
        return f"residual below {mpmath.nstr(self.bound, 2)}"

    def facts(self) -> tuple[str, ...]:
        return (f"error about {mpmath.nstr(self.error, 2)}",)


class Guess(NamedTuple):
    """Where refinement begins: a torus in doubles or in digits, and what is to fix it.

    report : called with every step. save : with what is reached after it. steps : made so far.
    """

    torus: Torus
    prescribed: Prescribed
    report: Progress = unheard
    save: Save = no_checkpoint
    steps: int = 0

    @property
    def digits(self) -> int:
        """Of its coefficients."""
        return DOUBLE_DIGITS if self.torus.digits is None else self.torus.digits

    @property
    def frequencies(self) -> tuple[Fraction, ...]:
        """Those that are held, or those of the torus."""
        return self.prescribed.held_frequencies or tuple(self.torus.frequencies)

    def moved(self, to: Checkpoint) -> Guess:
        """The same problem from what refinement has reached."""
        found = tuple(Fraction(int(w), 1 << to.bits) for w in to.omega)
        torus = Torus(
            self.torus.chain,
            self.torus.seeds,
            self.prescribed.held_frequencies or found,
            to.harmonics,
            from_integers(to.coefficients, np.asarray(-to.bits)),
            self.torus.phases,
            digits=to.digits,
            travels=self.torus.travels,
        )
        return self._replace(torus=torus, steps=to.steps)


def require_digits(chain: Chain, digits: int, argument: str) -> None:
    """InputError for digits out of range, and for chains whose force has no known series.

    argument : the name of the one that is of the chain.
    """
    if integer(digits, "digits", 1) > MOST_DIGITS:
        raise InputError("digits", digits, f"1..{MOST_DIGITS}", "take fewer")
    if not has_terms(chain):
        allowed = "a solution of a chain whose V is a polynomial, or not even and made of "
        allowed += "exponentials and powers, with rational numbers"
        raise InputError(argument, f"one of {chain!r}", allowed, NO_TERMS)


def torus_to_digits(
    guess: Guess, digits: int, path: Path | None
) -> Torus[IterativeRefinement]:
    """The torus near the guess; a run with a file goes on from what that holds.

    Raises Failure, and InputError, also for a file of another run or in use.
    """
    if path is None:
        return precise_torus(guess, digits)
    with one_run(path):
        chain, seeds = guess.torus.chain, guess.torus.seeds
        file = RefinementFile(path, chain, digits, seeds, guess.prescribed.by_name())
        guess, before = guess._replace(save=file.write), file.read()
        if before is not None:
            with mpmath.workprec(before.bits + GUARD_BITS):
                guess = guess.moved(before)
        return precise_torus(guess, digits)


def precise_torus(guess: Guess, digits: int) -> Torus[IterativeRefinement]:
    """The torus near the guess with so many digits; raises Failure, and InputError for too many.

    Half of the digits first: from their fall-off the harmonics of all are known better, and fewer
    steps need all of them. Then harmonics are added until none that is left out has an error
    above the last digit.
    """
    stages = [digits]
    while stages[0] // 2 > guess.digits:
        stages.insert(0, stages[0] // 2)
    _require_room(guess, digits)
    for fewer in stages[:-1]:
        with mpmath.workdps(fewer + CARRIED_DIGITS):
            problem = TorusProblem(guess, _fitted(guess, fewer), fewer)
            converge(problem, fewer, guess.report)
            guess = problem.guess(fewer)
    with mpmath.workdps(digits + CARRIED_DIGITS):
        start = TorusProblem(guess, _fitted(guess, digits), digits)
        problem, left = refined(start, digits, guess.report)
        return problem.result(left)


def _require_room(guess: Guess, digits: int) -> None:
    """InputError for more harmonics, or powers of stretches, than can be taken."""
    _fitted(guess, digits)
    torus = guess.torus
    harmonics, table = canonical_signs(torus.harmonics), torus.cosines.astype(float)
    there = projection(torus.chain, torus.seeds, harmonics)
    with mpmath.workdps(digits + CARRIED_DIGITS):
        terms(torus.chain, _bits(table), _reach(there, table))


def _bits(table: Floats) -> int:
    """After the point, so that the largest coefficient has the working precision of mpmath."""
    _, exponent = math.frexp(float(np.abs(table).max()))
    return int(mpmath.mp.prec) - exponent


def _reach(there: Projection, table: Floats) -> float:
    """What no stretch of a torus of coefficients (H, C) exceeds, nor of one near to it."""
    stretches = there.to_points(table)
    return float(NEAR_REACH * np.abs(stretches).sum(axis=0).max())


def _fitted(guess: Guess, digits: int) -> Ints:
    """Harmonics expected above the last digit of the largest coefficient, and some more."""
    torus = guess.torus
    sizes = np.abs(torus.cosines).max(axis=1)
    largest = mpf(max(sizes))
    least = largest * mpmath.mpf(10) ** -guess.digits
    pairs = zip(map(tuple, torus.harmonics.tolist()), map(mpf, sizes), strict=True)
    heights = {nu: float(mpmath.log(x / largest)) for nu, x in pairs if x > least}
    functions, s = count_points(torus.chain), len(torus.seeds)
    depth = (digits + SPARE_DIGITS) * math.log(10)
    found, full = within_reach(heights, functions, s, depth, most=MOST_HARMONICS)
    if full:
        allowed = f"what {MOST_HARMONICS} harmonics, or a lattice that fits, can give"
        raise InputError("digits", digits, allowed, "take fewer, or smaller amplitudes")
    return found


class TorusProblem(TruncatedProblem):
    """The invariance equation of a torus: its coefficients c and its frequencies omega.

    Made at the working precision of mpmath.
    """

    def __init__(self, guess: Guess, harmonics: Ints, digits: int) -> None:
        self.start, self.harmonics, self.digits = guess, harmonics, digits
        self.steps = guess.steps
        torus = guess.torus
        self.equation = InvarianceEquation(torus.chain, torus.seeds, harmonics)
        self.mask = self.equation.mask
        self._seeds = self.equation.seed_rows, self.equation.seed_columns
        table = self._known()
        doubles = table.astype(float)
        self._set_force(doubles)
        fixed = self.force.fixed
        self.bits, self.coefficients = self.force.bits, self.force.fixed_values(table)
        self.largest = fixed(mpmath.mpf(float(np.abs(doubles).max())))
        frequencies = [fixed(w) for w in guess.frequencies]
        self.frequencies = np.array(frequencies, dtype=object)
        self.frequency_scale = min(float(w) for w in guess.frequencies)
        held = guess.prescribed.held_amplitudes
        if held is not None:
            self.coefficients[self._seeds] = [fixed(a) for a in held]
        self._amplitudes = self.coefficients[self._seeds]
        self._set_jacobian(doubles)
        guess.report(f"{len(harmonics)} harmonics, {self.bits} bits", NO_FRACTION)

    def _known(self) -> Any:
        """The coefficients of the guess at the harmonics, (H, C), 0 of others."""
        torus = self.start.torus
        known = by_harmonic(torus.harmonics, torus.cosines.astype(object))
        return np.where(self.mask, coefficients_at(self.harmonics, known), 0)

    def _set_force(self, doubles: Floats) -> None:
        box = Box(np.abs(self.harmonics).max(axis=0), whole=False)
        there = self.equation.projection
        reach = _reach(there, doubles)
        self.force = KroneckerForce(there, box, _bits(doubles), reach)

    def _set_jacobian(self, doubles: Floats) -> None:
        guess = self.start
        chain, seeds = self.equation.chain, self.equation.seeds
        shifts = frequency_shifts(chain, seeds, guess.frequencies)
        conditions = guess.prescribed.conditions()
        table = doubles.astype(np.longdouble)
        try:
            self.jacobian = Jacobian(NewtonState(self.equation, conditions, table, shifts))
        except (np.linalg.LinAlgError, ValueError) as failure:
            raise Failure(f"the Jacobian is singular ({failure})") from failure

    def residual(self) -> Integers:
        """((nu.omega)^2 - Omega_q^2) c_q[nu] - force at the chosen harmonics; (H, C)."""
        c, bits = self.coefficients, self.bits
        force, _ = self.force.force(self.harmonics, c, self.harmonics)
        rates = self.harmonics.astype(object) @ self.frequencies
        squares = self.force.squares(self.harmonics)
        divisors = ((rates**2) >> bits)[:, None] - squares
        return np.where(self.mask, ((divisors * c) >> bits) - force, 0)

    def conditions(self) -> Integers:
        """What is prescribed and not held, as integers, (s,)."""
        prescribed = self.start.prescribed
        if prescribed.held_frequencies or prescribed.held_amplitudes:
            return np.zeros(len(self.frequencies), dtype=object)
        values = prescribed.values(self.guess(mpmath.mp.dps).torus)
        return self.force.fixed_values(np.array(values, dtype=object))

    def solve(self, residual: Floats, conditions: Floats) -> tuple[Floats, Floats]:
        """The Jacobian's, with frequencies or amplitudes as they are where they are held."""
        by_cosine, by_shift = self.jacobian.correction(residual, conditions, ACCURACY)
        if self.start.prescribed.held_frequencies is not None:
            return by_cosine, np.zeros(len(by_shift))
        if self.start.prescribed.held_amplitudes is not None:
            by_cosine[self._seeds] = 0
        return by_cosine, by_shift

    def after_step(self, digits: float) -> None:
        self._require_near()
        self.start.save(self._checkpoint(math.floor(max(1, min(self.digits, digits)))))

    def _require_near(self) -> None:
        """Failure where the amplitude of a seed has left that of the guess."""
        reached = self.coefficients[self._seeds]
        for q, old, new in zip(self.equation.seeds, self._amplitudes, reached, strict=True):
            if not abs(old) < NEAR * abs(new) < NEAR**2 * abs(old):
                before, now = (float(mpmath.ldexp(x, -self.bits)) for x in (old, new))
                reason = f"A_{q} goes from {before:.3g} to {now:.3g}"
                raise Failure(f"iterative refinement leads elsewhere: {reason}")

    def _checkpoint(self, digits: int) -> Checkpoint:
        return Checkpoint(
            self.harmonics,
            self.coefficients,
            self.frequencies,
            self.bits,
            digits,
            self.steps,
        )

    def guess(self, digits: int) -> Guess:
        """What was reached, as a torus of so many digits to go on from with other harmonics."""
        return self.start.moved(self._checkpoint(digits))

    def extended(self, harmonics: Ints) -> TorusProblem:
        """With those, too, that a fit of what was reached expects."""
        guess = self.guess(self.digits)
        more = self.harmonics, _fitted(guess, self.digits), harmonics
        every = np.unique(np.concatenate(more), axis=0)
        return TorusProblem(guess, every, self.digits)

    def truncation(self) -> Truncation:
        """At all harmonics of a box a quarter larger; its residual is the bound of the result."""
        torus = self.guess(self.digits).torus
        finer = self._finer(torus.cosines.astype(float))
        wanted = canonical_signs(finer.box.harmonics)
        c = self.coefficients << CHECK_BITS
        force, off = finer.force(self.harmonics, c, wanted)
        rows = places_of(self.harmonics, wanted)
        omega = np.array([finer.fixed(w) for w in torus.frequencies], dtype=object)
        rates = wanted.astype(object) @ omega
        divisors = ((rates**2) >> finer.bits)[:, None] - finer.squares(wanted)
        allowed = self.equation.projection.at(wanted).mask
        residual = np.where(allowed, -force, 0)
        residual[rows] += (divisors[rows] * c) >> finer.bits
        rounding = self._rounding(rates[rows], c, finer.bits)
        total = max(abs(residual).sum(axis=0) + off + rounding)
        bound = mpmath.ldexp(int(total), -finer.bits) / _acceleration(torus)
        out = np.ones(len(wanted), dtype=bool)
        out[rows] = False
        largest = self.largest << CHECK_BITS
        update = self.update(residual[rows], self.conditions() << CHECK_BITS)
        return Truncation(
            newton_update=self.size(update) / 2**CHECK_BITS,
            harmonics=wanted[out],
            neglected=neglected(residual[out], divisors[out], finer.bits, largest),
            residual=bound,
        )

    def _finer(self, table: Floats) -> KroneckerForce:
        highest = np.ceil(CHECKED * np.abs(self.harmonics).max(axis=0)).astype(int)
        there = self.equation.projection
        reach = _reach(there, table)
        box = Box(highest, whole=True)
        return KroneckerForce(there, box, self.bits + CHECK_BITS, reach)

    def _rounding(self, rates: Integers, c: Integers, bits: int) -> Integers:
        """Above what rounding of rates (H,) and divisors adds to a residual, by column; (C,)."""
        lengths = np.abs(self.harmonics).sum(axis=1).astype(object)
        of_divisors = ((2 * abs(rates) * lengths) >> bits) + lengths + 2
        summed = ((of_divisors[:, None] * abs(c)) >> bits).sum(axis=0)
        return np.asarray(summed + 2 * len(c))

    def result(self, left: Truncation) -> Torus[IterativeRefinement]:
        """The torus, without harmonics that are zero in fixed point."""
        kept = self.coefficients.any(axis=1)
        torus: Torus[Any] = self.guess(self.digits).torus
        bound, error = with_digits((left.residual, left.error), self.digits)
        return replace(
            torus,
            harmonics=torus.harmonics[kept],
            cosines=torus.cosines[kept],
            origin=IterativeRefinement(bound, error, self.steps),
        )


def _acceleration(torus: Torus) -> float:
    """The largest acceleration of a mode at some times: below the largest of all."""
    t = np.linspace(0, 100 * np.pi / float(min(torus.frequencies)), SAMPLES)
    doubles = replace(torus.in_doubles(), phases={})
    forces = torus.chain.accelerations(doubles.Q(t))
    return float(np.max(np.abs(forces)))
