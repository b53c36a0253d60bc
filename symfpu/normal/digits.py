"""Normal frequencies of a torus with many digits, to as many.

One sweep takes L(sigma) p in fixed point, by Kronecker products, and solves Newton's equations for
it in doubles: it gains as many digits as doubles have. The harmonics are those that the fall-off
of the torus' own coefficients expects above the last digit; after the sweeps the residual at all
harmonics of a quarter more says what is missing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import mpmath
import numpy as np

from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.normal.correction import NormalCorrection
from symfpu.normal.kronecker import KroneckerFlow, multiplied
from symfpu.normal.linearised import LinearisedFlow, Values
from symfpu.normal.modes import NormalMode
from symfpu.numbers.arithmetic import (
    doubles_as_integers,
    from_integers,
    mpf,
    with_digits,
)
from symfpu.refinement.digits import (
    CARRIED_DIGITS,
    CHECK_BITS,
    CHECKED,
    DOUBLE_BITS,
    MOST_HARMONICS,
    SPARE_DIGITS,
    Failure,
    LeftOver,
)
from symfpu.refinement.equation import Ints
from symfpu.refinement.harmonics import within_reach
from symfpu.refinement.invariance import dilated
from symfpu.refinement.kronecker import Integers
from symfpu.tori.quasiperiodic import QuasiPeriodic

SWEEPS = 200
STALL_SWEEPS = 3  # sweeps without a smaller change that end the search
FAR = 1e-6  # change of sigma, relative, that leads to another mode
SETTLED = 50  # bits of p that no longer change: the matrix of doubles is as good as it gets
ROUNDS = 6  # choices of harmonics


class PreciseModes:
    """The normal modes of one torus with many digits, each refined from doubles."""

    def __init__(self, torus: QuasiPeriodic) -> None:
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
        for _ in range(ROUNDS):
            sweeps = NormalSweeps(self._stage, mode, state)
            sweeps.converge(tell)
            left = sweeps.left_over()
            if left.error < mpmath.mpf(10) ** -self.digits:
                return sweeps.result(left)
            self._stage = self._stage.extended(left.needed(self.digits))
            state = sweeps.state
        shown = mpmath.nstr(left.error, 2)
        raise Failure(f"{ROUNDS} choices of harmonics leave errors of {shown}")


def fitted_harmonics(torus: QuasiPeriodic) -> Ints:
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

    def __init__(self, torus: QuasiPeriodic, chosen: Ints, digits: int) -> None:
        self.torus, self.chosen, self.digits = torus, chosen, digits
        self.flow = LinearisedFlow(torus.in_doubles(), chosen)
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


@dataclass(frozen=True, eq=False)
class LeftOfMode(LeftOver):
    """The residual at all harmonics of a quarter more.

    inside is of sigma, relative, or of p. residual : its norm over Omega_q^2. by_torus : change of
    sigma that the error of the torus makes, relative.
    """

    residual: Any
    by_torus: Any


class NormalSweeps:
    """sigma (n,) and p (n, F, N-1) in fixed point, and Newton's matrix that corrects them."""

    def __init__(self, stage: Stage, mode: NormalMode, state: State) -> None:
        self.stage, self.mode, self.start = stage, mode, complex(mode.sigma)
        self.bits = stage.fixed.bits
        self.mask = stage.flow.allowed(mode.mode)
        self.sigma = state.sigma
        table = state.at(stage.flow.harmonics, stage.torus.chain.N - 1)
        self.p: Integers = np.where(self.mask, table, 0)
        self.rows = np.arange(len(stage.flow.harmonics))
        self.correction = NormalCorrection(stage.flow, mode.mode, *self.in_doubles())

    @property
    def state(self) -> State:
        """What was reached."""
        harmonics = map(tuple, self.stage.flow.harmonics.tolist())
        table = np.moveaxis(self.p, 1, 0)
        return State(self.sigma, dict(zip(harmonics, table, strict=True)))

    def in_doubles(self) -> tuple[Any, Values]:
        """sigma and p."""
        sigma = _double(self.sigma, self.bits)
        return sigma.item(), _double(self.p, self.bits)

    def converge(self, tell: Progress) -> None:
        """Sweep until the next change is expected below the last digit. Raises Failure."""
        digits = self.stage.digits + SPARE_DIGITS
        enough = self.bits - math.ceil(digits * math.log2(10))
        before, least, stalled = self.bits, self.bits, 0
        for number in range(1, SWEEPS + 1):
            image = self.stage.fixed.image(self.rows, self.p, self.sigma)
            changed = self._correct(np.where(self.mask, image, 0), self.bits)
            size = (changed - self.bits) * math.log10(2)
            name = f"normal mode {self.mode.mode}, sweep {number}"
            tell(f"{name}: change 1e{size:.0f}", NO_FRACTION)
            self._require_near()
            if 2 * changed - before <= enough:
                return
            if before > self.bits - SETTLED:
                self.correction.take(*self.in_doubles())
            stalled = 0 if changed < least else stalled + 1
            if stalled >= STALL_SWEEPS:
                break
            before, least = changed, min(least, changed)
        gained = (self.bits - least) * math.log10(2)
        raise Failure(f"the sweeps in fixed point stop at changes of 1e-{gained:.0f}")

    def _require_near(self) -> None:
        found = complex(_double(self.sigma, self.bits).item())
        if abs(found - self.start) > FAR * abs(self.start):
            reason = (
                f"the sweeps in fixed point lead from {self.start:.10g} to {found:.10g}"
            )
            raise Failure(reason)

    def _correct(self, image: Integers, bits: int) -> int:
        """Takes an image with so many bits away; the number of bits of the largest change."""
        by_p, by_sigma, scale = self._change(image)
        shift = scale + self.bits - bits
        change = np.stack([doubles_as_integers(x, shift) for x in self._parts(by_p)])
        moved = self._parts(np.array([by_sigma]))
        self.p = np.where(self.mask, self.p + change, 0)
        self.sigma = self.sigma + np.concatenate(
            [doubles_as_integers(x, shift) for x in moved]
        )
        largest = max(float(np.abs(by_p).max()), abs(by_sigma))
        return shift + math.ceil(math.log2(largest)) if largest else 0

    def _change(self, image: Integers) -> tuple[Values, complex, int]:
        """What takes an image away, of p and of sigma, times 2^-scale."""
        scale = max((abs(int(x)).bit_length() for x in image.flat), default=0)
        dropped, kept = max(scale - DOUBLE_BITS, 0), min(scale, DOUBLE_BITS)
        small = np.ldexp((image >> dropped).astype(float), -kept)
        residual = small[0] if len(small) == 1 else small[0] + 1j * small[1]
        by_p, by_sigma = self.correction(residual)
        return by_p, by_sigma, scale

    def _parts(self, values: Values) -> list[Any]:
        return [values.real, values.imag][: len(self.sigma)]

    def left_over(self) -> LeftOfMode:
        """The residual at all harmonics of a quarter more, in more digits."""
        finer, harmonics = self.stage.finer, self.stage.flow.harmonics
        place = {tuple(nu): i for i, nu in enumerate(finer.harmonics.tolist())}
        rows = np.array([place[tuple(nu)] for nu in harmonics.tolist()])
        sigma, p = self.sigma << CHECK_BITS, self.p << CHECK_BITS
        allowed = self.stage.flow.allowed_at(self.mode.mode, finer.harmonics)
        image = np.where(allowed, finer.image(rows, p, sigma), 0)
        out = np.setdiff1d(np.arange(len(finer.harmonics)), rows)
        divisors = finer.divisors(sigma)
        total = mpmath.sqrt(sum(int(x) ** 2 for x in image.flat))
        size = float(self.stage.flow.linear[self.mode.mode - 1]) ** 2
        return LeftOfMode(
            residual=mpmath.ldexp(total, -finer.bits) / size,
            inside=self._inside(image[:, rows], finer.bits),
            by_torus=self._by_torus(),
            harmonics=finer.harmonics[out],
            outside=_relative(image[:, out], divisors[:, out]),
        )

    def _inside(self, image: Integers, bits: int) -> Any:
        by_p, by_sigma, scale = self._change(image)
        size = max(float(np.abs(by_p).max()), abs(by_sigma) / abs(self.start))
        return mpmath.ldexp(mpmath.mpf(size), scale - bits)

    def _by_torus(self) -> Any:
        torus, share = self.stage.torus, self.correction.torus_share()
        error = getattr(torus, "error", mpmath.mpf(10) ** -self.stage.digits)
        return error * float(share) / abs(self.start)

    def result(self, left: LeftOfMode) -> NormalMode:
        """The mode, p of norm 1 with its main coefficient positive."""
        flow, mode = self.stage.flow, self.mode
        p = self._normalised()
        kept = p.any(axis=(0, 2))
        p, rates = p[:, kept], flow.rates.astype(float)[kept]
        sigma = _numbers(self.sigma, self.bits)
        coefficients = _numbers(p, self.bits)
        shown = {"sigma": sigma, "coefficients": coefficients}
        shown |= {"action": self._action(p, kept), "residual": left.residual}
        error = max(left.error, left.by_torus)
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
        norm = math.isqrt(sum(int(x) ** 2 for x in self.p.flat))
        p = (self.p << self.bits) // norm
        main = p[:, 0, self.mode.mode - 1]
        size = math.isqrt(sum(int(x) ** 2 for x in main))
        factor = np.array([(int(x) * one) // size for x in main], dtype=object)
        factor[1:] = -factor[1:]
        return multiplied(factor[:, None, None], p, self.bits)

    def _action(self, p: Integers, kept: Any) -> Any:
        """sum (Re sigma + nu.omega) |p|^2."""
        rates = self.sigma[0] + self.stage.fixed.rates[kept]
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


def _relative(image: Integers, divisors: Integers) -> list[Any]:
    """Largest |image / divisor| of each harmonic, |.| the larger of the parts."""
    above, below = abs(image).max(axis=0), abs(divisors).max(axis=0)
    with mpmath.workprec(64):
        found = []
        for row, under in zip(above, below, strict=True):
            pairs = zip(row.tolist(), under.tolist(), strict=True)
            shares = [mpf(int(x)) / max(int(d), 1) for x, d in pairs if x]
            found.append(max(shares, default=mpmath.mpf(0)))
        return found


def _positive(harmonics: Ints) -> Ints:
    """One of each pair, the first number that is not 0 positive."""
    first = np.argmax(harmonics != 0, axis=1)
    sign = np.sign(harmonics[np.arange(len(harmonics)), first])
    return np.asarray(np.where(sign[:, None] < 0, -harmonics, harmonics))
