"""Normal frequencies of a torus with many digits, to as many, by iterative refinement.

The residual L(sigma) p is taken in integers, its products by Kronecker substitution; the Jacobian
is that of Newton's method for the mode in doubles. The harmonics are those that the fall-off of the
torus' own coefficients expects above the last digit. At the end the residual at all harmonics of a
quarter more says which are missing.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import mpmath
import numpy as np

from symfpu.files.progress import Progress
from symfpu.normal.correction import NormalCorrection
from symfpu.normal.kronecker import KroneckerFlow, multiplied
from symfpu.normal.linearised import Linearised, Values
from symfpu.normal.modes import NormalMode
from symfpu.numbers.arithmetic import doubles_as_integers, from_integers, with_digits
from symfpu.refinement.digits import (
    CARRIED_DIGITS,
    CHECKED,
    MOST_HARMONICS,
    SPARE_DIGITS,
    IterativeRefinement,
)
from symfpu.refinement.harmonics import within_reach
from symfpu.refinement.iterative_refinement import (
    CHECK_BITS,
    DOUBLE_BITS,
    Failure,
    TruncatedProblem,
    Truncation,
    neglected,
    refined,
)
from symfpu.refinement.kronecker import Integers
from symfpu.refinement.lattice import Floats, Ints, dilated
from symfpu.tori.torus import Torus, comes_from

FAR = 1e-6  # change of sigma, relative, that leads to another mode
SETTLED = 15  # digits of sigma and p up to which their doubles change, and the Jacobian


class PreciseModes:
    """The normal modes of one torus with many digits, each refined from doubles."""

    def __init__(self, torus: Torus) -> None:
        assert torus.digits is not None
        self.torus, self.digits = torus, torus.digits
        with mpmath.workdps(self.digits + CARRIED_DIGITS):
            self._stage = Stage(torus, fitted_harmonics(torus), self.digits)

    def refined(self, mode: NormalMode, tell: Progress) -> NormalMode:
        """A normal mode in doubles with all digits of the torus; raises Failure.

        An elliptic one that real numbers do not lead to may be hyperbolic.
        """
        with mpmath.workdps(self.digits + CARRIED_DIGITS):
            try:
                return self._refined(mode, mode.sigma, tell)
            except Failure:
                if mode.growth:
                    raise
                return self._refined(mode, mode.sigma + 1j * mode.rounding, tell)

    def _refined(self, mode: NormalMode, sigma: complex, tell: Progress) -> NormalMode:
        """From a number that is complex for a hyperbolic mode."""
        state = State.of_doubles(mode, sigma, self._stage.fixed.bits)
        start = NormalModeProblem(self._stage, mode, state)
        problem, left = refined(start, self.digits, tell)
        self._stage = problem.stage
        return problem.result(left)


def fitted_harmonics(torus: Torus) -> Ints:
    """One of each pair: those in which the torus' own coefficients reach its last digit."""
    assert torus.digits is not None
    sizes = [max(abs(x) for x in row) for row in torus.cosines]
    largest = max(sizes)
    least = largest * mpmath.mpf(10) ** -torus.digits
    pairs = zip(map(tuple, torus.harmonics.tolist()), sizes, strict=True)
    heights = {nu: float(mpmath.log(x / largest)) for nu, x in pairs if x > least}
    depth = (torus.digits + SPARE_DIGITS) * math.log(10)
    functions, s = (torus.chain.N + 1) // 2, len(torus.seeds)
    found, full = within_reach(heights, functions, s, depth, most=MOST_HARMONICS)
    if full:
        raise Failure(f"{MOST_HARMONICS} harmonics are not enough")
    return found


class Stage:
    """One choice of harmonics for all modes, and L there in doubles and in fixed point.

    chosen : one of each pair, (H, s).
    """

    def __init__(self, torus: Torus, chosen: Ints, digits: int) -> None:
        self.torus, self.chosen, self.digits = torus, chosen, digits
        self.flow = Linearised(torus.in_doubles(), chosen)
        self.fixed = KroneckerFlow(torus, self.flow.harmonics, int(mpmath.mp.prec))

    @cached_property
    def finer(self) -> KroneckerFlow:
        """At more harmonics, in more digits: the check."""
        with mpmath.workprec(self.fixed.bits + CHECK_BITS):
            wanted = dilated(self.chosen, CHECKED)
            return KroneckerFlow(self.torus, wanted, self.fixed.bits + CHECK_BITS)

    def extended(self, more: Ints) -> Stage:
        """With more harmonics."""
        every = np.unique(np.concatenate([self.chosen, _positive(more)]), axis=0)
        return Stage(self.torus, every, self.digits)


class State(NamedTuple):
    """A normal mode in fixed point: sigma (n,) and rows of p by harmonic, (n, N-1).

    n : 1, or 2 for real and imaginary parts.
    """

    sigma: Integers
    rows: dict[tuple[int, ...], Integers]

    @staticmethod
    def of_doubles(mode: NormalMode, sigma: complex, bits: int) -> State:
        """Of a mode in doubles and its frequency."""
        p, unreal = mode.coefficients, isinstance(sigma, complex)
        parts = [np.asarray(x) for x in (sigma.real, sigma.imag)][: 1 + unreal]
        tables = [p.real, p.imag] if unreal else [p.real]
        table = np.stack([doubles_as_integers(part, bits) for part in tables], axis=1)
        rows = map(tuple, mode.harmonics.tolist())
        return State(
            np.concatenate([doubles_as_integers(x[None], bits) for x in parts]),
            dict(zip(rows, table, strict=True)),
        )

    def at(self, harmonics: Ints, modes: int) -> Integers:
        """p at chosen harmonics, (n, F, N-1)."""
        nothing = np.zeros((len(self.sigma), modes), dtype=object)
        rows = [self.rows.get(tuple(nu), nothing) for nu in harmonics.tolist()]
        return np.asarray(np.stack(rows, axis=1))


class NormalModeProblem(TruncatedProblem):
    """L(sigma) p = 0 with p of a given norm: coefficients p (n, F, N-1) and one frequency sigma.

    n : 1, or 2 for real and imaginary parts. Of norm 1, p is relative to nothing larger.
    """

    def __init__(self, stage: Stage, mode: NormalMode, state: State) -> None:
        self.stage, self.mode, self.start = stage, mode, complex(mode.sigma)
        self.name = f"normal mode {mode.mode}, "
        self.bits = stage.fixed.bits
        self.largest, self.frequency_scale = 1 << self.bits, abs(self.start)
        self.mask = stage.flow.allowed(mode.mode)
        self.frequencies = state.sigma
        table = state.at(stage.flow.harmonics, stage.torus.chain.N - 1)
        self.coefficients = np.where(self.mask, table, 0)
        self._rows = np.arange(len(stage.flow.harmonics))
        self.jacobian = NormalCorrection(stage.flow, mode.mode, *self.in_doubles())

    @property
    def state(self) -> State:
        """What was reached."""
        harmonics = map(tuple, self.stage.flow.harmonics.tolist())
        table = np.moveaxis(self.coefficients, 1, 0)
        return State(self.frequencies, dict(zip(harmonics, table, strict=True)))

    def in_doubles(self) -> tuple[Any, Values]:
        """sigma and p."""
        sigma = _double(self.frequencies, self.bits)
        return sigma.item(), _double(self.coefficients, self.bits)

    def residual(self) -> Integers:
        """L(sigma) p at the chosen harmonics; (n, F, N-1)."""
        fixed = self.stage.fixed
        image = fixed.image(self._rows, self.coefficients, self.frequencies)
        return np.where(self.mask, image, 0)

    def solve(self, residual: Floats, conditions: Floats) -> tuple[Floats, Floats]:
        image = residual[0] if len(residual) == 1 else residual[0] + 1j * residual[1]
        by_p, by_sigma = self.jacobian(image)
        return self._parts(by_p), self._parts(np.asarray(by_sigma))

    def _parts(self, values: Values) -> Floats:
        """Real, or real and imaginary parts; (n, ..)."""
        return np.stack([values.real, values.imag][: len(self.frequencies)])

    def after_step(self, digits: float) -> None:
        """sigma must stay. Where the doubles of sigma and p have changed, so does the Jacobian."""
        sigma, p = self.in_doubles()
        if abs(sigma - self.start) > FAR * abs(self.start):
            reason = f"from {self.start:.10g} to {sigma:.10g}"
            raise Failure(f"iterative refinement leads elsewhere: {reason}")
        if digits < SETTLED:
            self.jacobian.take(sigma, p)

    def extended(self, harmonics: Ints) -> NormalModeProblem:
        stage = self.stage.extended(harmonics)
        return NormalModeProblem(stage, self.mode, self.state)

    def truncation(self) -> Truncation:
        """At all harmonics of a quarter more; its residual is a norm, over Omega_q^2."""
        finer, harmonics = self.stage.finer, self.stage.flow.harmonics
        place = {tuple(nu): i for i, nu in enumerate(finer.harmonics.tolist())}
        rows = np.array([place[tuple(nu)] for nu in harmonics.tolist()])
        sigma, p = self.frequencies << CHECK_BITS, self.coefficients << CHECK_BITS
        allowed = self.stage.flow.allowed_at(self.mode.mode, finer.harmonics)
        image = np.where(allowed, finer.image(rows, p, sigma), 0)
        out = np.setdiff1d(np.arange(len(finer.harmonics)), rows)
        divisors = abs(finer.divisors(sigma)[:, out]).max(axis=0)
        left_out = abs(image[:, out]).max(axis=0)
        total = mpmath.sqrt(sum(int(x) ** 2 for x in image.flat))
        size = self.stage.flow.frequency(self.mode.mode) ** 2
        largest = self.largest << CHECK_BITS
        return Truncation(
            newton_update=self.size(self.update(image[:, rows], self.conditions()))
            / 2**CHECK_BITS,
            harmonics=finer.harmonics[out],
            neglected=neglected(left_out, divisors, finer.bits, largest),
            residual=mpmath.ldexp(total, -finer.bits) / size,
        )

    def _by_torus(self) -> Any:
        """The relative change of sigma that the error of the torus makes, an estimate."""
        torus, share = self.stage.torus, self.jacobian.torus_share()
        error = mpmath.mpf(10) ** -self.stage.digits
        if comes_from(torus, IterativeRefinement):
            error = torus.origin.error
        return error * float(share) / abs(self.start)

    def result(self, left: Truncation) -> NormalMode:
        """The mode, p of norm 1 with its main coefficient positive."""
        flow, mode = self.stage.flow, self.mode
        p = self._normalised()
        kept = p.any(axis=(0, 2))
        p, rates = p[:, kept], flow.rates.astype(float)[kept]
        sigma = _numbers(self.frequencies, self.bits)
        coefficients = _numbers(p, self.bits)
        shown = {"sigma": sigma, "coefficients": coefficients}
        shown |= {"action": self._action(p, kept), "residual": left.residual}
        error = max(left.error, self._by_torus())
        shown |= {"error": error}
        return NormalMode(
            mode=mode.mode,
            harmonics=flow.harmonics[kept],
            rates=rates,
            divisors=mode.divisors,
            deflated=mode.deflated,
            products=mode.products,
            digits=self.stage.digits,
            rounding=float(error) * abs(self.start),
            **with_digits(shown, self.stage.digits),
        )

    def _normalised(self) -> Integers:
        """p with norm 1 and a positive main coefficient."""
        one = 1 << self.bits
        norm = math.isqrt(sum(int(x) ** 2 for x in self.coefficients.flat))
        p = (self.coefficients << self.bits) // norm
        main = p[:, 0, self.mode.mode - 1]
        size = math.isqrt(sum(int(x) ** 2 for x in main))
        factor = np.array([(int(x) * one) // size for x in main], dtype=object)
        factor[1:] = -factor[1:]
        return multiplied(factor[:, None, None], p, self.bits)

    def _action(self, p: Integers, kept: Any) -> Any:
        """sum (Re sigma + nu.omega) |p|^2."""
        rates = self.frequencies[0] + self.stage.fixed.rates[kept]
        weights = (p**2).sum(axis=(0, 2))
        return mpmath.ldexp(int(rates @ weights), -3 * self.bits)


def _double(values: Integers, bits: int) -> Values:
    """Real (1, ..) or complex (2, ..) numbers in fixed point as doubles (..)."""
    dropped = max(bits - DOUBLE_BITS, 0)
    parts = np.ldexp((values >> dropped).astype(float), dropped - bits)
    return np.asarray(parts[0] if len(parts) == 1 else parts[0] + 1j * parts[1])


def _numbers(values: Integers, bits: int) -> Any:
    """The same as mpf or mpc."""
    parts = from_integers(values, np.asarray(-bits))
    if len(parts) == 1:
        return parts[0]
    return np.frompyfunc(mpmath.mpc, 2, 1)(parts[0], parts[1])


def _positive(harmonics: Ints) -> Ints:
    """One of each pair, the first number that is not 0 positive."""
    first = np.argmax(harmonics != 0, axis=1)
    sign = np.sign(harmonics[np.arange(len(harmonics)), first])
    return np.asarray(np.where(sign[:, None] < 0, -harmonics, harmonics))
