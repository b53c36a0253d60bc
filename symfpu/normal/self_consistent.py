"""Numbers from the series of a normal frequency: its divisors hold sigma itself.

sigma = Omega_q + sum mu^k sigma^(k)(A; omega, sigma) at the amplitudes and frequencies of a torus,
one equation for one number, by the secant method from the closed shift of second order; a trial
costs one series.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.normal.modes import NoNormalModes
from symfpu.normal.phantom import NormalFrequencySeries, of_phantom, phantom_series
from symfpu.normal.resonances import resonances_of
from symfpu.normal.torus import LENGTH, second_order
from symfpu.numbers.arithmetic import DOUBLES, GUARD_DIGITS, MULTIPRECISION
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, order_of
from symfpu.refinement.guesses import require_torus
from symfpu.series.arguments import digits_of
from symfpu.series.series import LindstedtSeries
from symfpu.tori.torus import Torus, require_solution

STEPS, STEPS_DIGITS = 30, 60  # with doubles, with digits
LARGEST_MOVE = 0.1  # of sigma, relative, away from the guess
DIFFERENCE = 1e-6  # of the shift, between the first two trials
LEAST_SHIFT = 1e-12  # relative, where the closed shift vanishes
ROUNDING = 8 * np.finfo(float).eps  # relative to sigma, what a solution may leave
DECIMALS = 25  # of trials in doubles: those of their shifts


@public
def solve_normal_frequency(
    solution: Torus,
    mode: int,
    order: int,
    *,
    digits: int | None = None,
    progress: Progress | None = None,
) -> NormalFrequencySeries:
    """The normal frequency of a torus by its series, solved at its amplitudes.

    solution : a torus or breather, of any potential, with fixed ends, or travelling waves of a
        ring: its amplitudes and frequencies are taken, and nothing else of it. mode : q, none of
        its seeds; of a ring signed.
    order : K of the series of sigma, from that of the first correction up. digits : of the
        result; None for doubles, which a ring has alone.
    progress : called as (label, fraction), once a trial.

    Dimensionless. Solves sigma = Omega_q + sum mu^k sigma^(k)(A; omega, sigma) (Eq. omeser of the
    torus with a phantom seed more, ours). Of the true one it misses the next terms of the series:
    an independent check of `normal_modes` at small amplitudes. Where the terms grow, as about the
    onset of a hyperbolic direction, it is no check: few orders do not see it.
    Returns the series; its `sigma` is the solution.
    Raises InputError; ResonantDivisor where the phantom seed is resonant with the torus;
    NoNormalModes where no real number near the guess solves the equation, as in a hyperbolic
    direction.

    >>> import symfpu
    >>> from symfpu import Chain, normal_modes, solve_normal_frequency
    >>> breather = symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.1"})
    >>> found = solve_normal_frequency(breather, 3, 6)
    >>> abs(found.sigma - normal_modes(breather).frequencies[3]) < 1e-12
    True
    """
    torus = require_solution(solution, "solution")
    if torus.chain.periodic:
        require_torus(torus)
        solution = torus.in_doubles()
        if digits is not None:
            raise InputError("digits", digits, "none on a ring: doubles", "leave it out")
    q = integer(mode, "mode", min(solution.chain.mode_numbers))
    normal = [n for n in solution.chain.mode_numbers if n not in solution.seeds]
    if q not in normal:
        allowed = f"a mode that is no seed, one of {normal}"
        raise InputError("mode", mode, allowed, "name a normal mode")
    first = 2 // solution.chain.degree_step
    top = order_of(order)
    if top < first:
        allowed = f"{first} or more, the order of the first correction"
        raise InputError("order", order, allowed, f"take {first} or more")
    places = None if digits is None else digits_of(digits)
    search = _Search(solution, q, top, places, progress or unheard)
    with search.numbers.context(places):
        return of_phantom(search.solved())


class _Search:
    """The equation of one sigma; trials are shifts sigma - Omega_q."""

    def __init__(
        self,
        solution: Torus,
        q: int,
        order: int,
        digits: int | None,
        tell: Progress,
    ) -> None:
        self.solution, self.q, self.order, self.digits = solution, q, order, digits
        self.tell, self.trials = tell, 0
        self.numbers = DOUBLES if digits is None else MULTIPRECISION
        self.chain = solution.chain
        pairs = zip(solution.seeds, solution.frequencies, strict=True)
        self.omega = dict(sorted(pairs))
        with self.numbers.context(digits):
            A = solution.amplitudes
            squares = [0, *(A[n] ** 2 for n in self.omega)]
            self.squares = self.numbers.array(squares)

    @property
    def _linear(self) -> float:
        return float(self.chain.linear_frequency(self.q % self.chain.N))

    def solved(self) -> LindstedtSeries:
        """The series at the solution."""
        guesses = second_order(self.solution)
        start = guesses[self.q] - self._linear
        step = DIFFERENCE * (start or LEAST_SHIFT * self._linear)
        if (
            not start and self.chain.periodic
        ):  # no closed shift: to what the series itself says
            step, _ = self._at(start)
        found = self._secant(start, start + step, LARGEST_MOVE * self._linear)
        if found is None:
            raise NoNormalModes(self.q, guesses[self.q], self._nearest(guesses))
        return found

    def _secant(self, x: Any, y: Any, most: float) -> LindstedtSeries | None:
        """From two trials; None where it runs away or finds no end."""
        x, y = self.numbers.array([x, y])
        start, (left, _) = x, self._at(x)
        for _ in range(self._steps):
            after, series = self._at(y)
            if abs(after) <= self._rounding:
                return series
            if after == left or not abs(y - start) < most:
                return None
            x, y, left = y, y - after * (y - x) / (after - left), after
        return None

    @property
    def _steps(self) -> int:
        return STEPS if self.digits is None else STEPS_DIGITS

    @property
    def _rounding(self) -> Any:
        linear = self._linear
        if self.digits is None:
            return ROUNDING * linear
        return mpmath.mpf(10) ** -self.digits * linear

    def _at(self, shift: Any) -> tuple[Any, LindstedtSeries]:
        """Series - shift at a trial shift, and the series."""
        self.trials += 1
        self.tell(f"sigma_{self.q}, trial {self.trials}", self.trials / self._steps)
        trial = self._exact(shift)
        seeds = tuple(self.omega)
        frequencies = (trial, *self.omega.values())
        series = phantom_series(
            self.chain, seeds, self.q, frequencies, self.order, digits=self.digits
        )
        terms, _ = series.frequency_terms(self.squares)
        total: Any = sum(terms[1:, 0])
        return total - shift, series

    def _exact(self, shift: Any) -> Fraction:
        """Omega_q + shift as an exact decimal in which the shift has all its digits."""
        places = DECIMALS if self.digits is None else self.digits + GUARD_DIGITS
        with mpmath.workdps(2 * places):
            value = self.chain.linear_frequency(self.q % self.chain.N) + mpmath.mpf(shift)
            whole = int(mpmath.nint(value * mpmath.mpf(10) ** places))
        return Fraction(whole, 10**places)

    def _nearest(self, guesses: dict[int, float]) -> Any:
        omega = tuple(float(w) for w in self.solution.frequencies)
        seeds = self.solution.seeds
        sigma = {q: w for q, w in guesses.items() if q not in seeds}
        found = resonances_of(self.chain, seeds, omega, sigma, LENGTH)
        return next(r for r in found if self.q in r.modes)
