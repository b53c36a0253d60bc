"""The FPU chain with fixed ends: its modes, couplings and energies (section 2 of the paper).

The Hamiltonian is also an expression.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import count, product
from typing import Any

import mpmath
import numpy as np
import symengine as se
from numpy.typing import ArrayLike, NDArray

from symfpu.chain import bonds
from symfpu.chain.length import LENGTH, SymbolicLength
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.chain.potentials.potential import Potential, checked_coupling
from symfpu.chain.potentials.typed import potential_of_text
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    Arithmetic,
    Numbers,
    arithmetic_of,
    sine_matrix,
)
from symfpu.numbers.typed import Number, decimal, integer, rational

Floats = NDArray[np.float64]
LARGEST_EXPRESSION = 40  # bonds; the cubic coupling has about N^3 terms


@dataclass(frozen=True, init=False, repr=False)
class Chain:
    """Chain of N bonds (N - 1 moving particles, fixed ends), Eq. fpuham; dimensionless.

    N : number of bonds, at least 2; modes are q = 1 .. N-1. "N" leaves it a symbol: such a chain
        has universal series (`lindstedt`), and no numbers until `at` puts one for N.
    alpha, beta : cubic and quartic coupling of an FPU chain, V = r^2/2 + alpha r^3/3 +
        beta r^4/4, exact numbers (see symfpu.numbers.typed); at least one is not zero. "0.33" and
        Fraction(33, 100) are what they say, a float is read by its shortest decimal.
    potential : any other law of a bond, V = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ...: `toda`,
        `lennard_jones`, `polynomial` and others, or as typed on the command line, "toda:1/2".

    The paper has one coupling at a time; here all may act. Order k means mu^k: the small parameter
    mu multiplies the amplitudes, mu = c_3/sqrt(2N), and the terms of order k have degree k + 1 in
    them; where V is even it multiplies their squares, mu = c_4/(2N), and the degree is 2k + 1. c_3
    (c_4) is replaced by 1 where it is zero.

    Raises InputError for an argument outside its range.

    >>> Chain(N=32, alpha="0.33"), Chain(N=8, potential="toda:1/2")
    (Chain(N=32, alpha=0.33), Chain(N=8, potential=toda(0.5)))
    >>> Chain(N=2, beta=1).frequencies()
    array([1.41421356])
    >>> Chain("N", beta=1), Chain("N", beta=1).at(N=32)
    (Chain(N='N', beta=1), Chain(N=32, beta=1))
    """

    N: int
    potential: Potential

    def __init__(
        self,
        N: int | str,
        alpha: Number = 0,
        beta: Number = 0,
        *,
        potential: Potential | str | None = None,
    ) -> None:
        symbolic = N == "N" or isinstance(N, SymbolicLength)
        object.__setattr__(self, "N", LENGTH if symbolic else integer(N, "N", 2))
        couplings = checked_coupling(alpha, "alpha"), checked_coupling(beta, "beta")
        if potential is None:
            if not any(couplings):
                allowed = "at least one of them not zero"
                advice = "give alpha=, beta= or both, or potential="
                raise InputError("alpha, beta", (0, 0), allowed, advice)
            potential = Polynomial(couplings)
        elif any(couplings):
            typed = ", ".join(map(decimal, couplings))
            allowed = "couplings or a potential, not both"
            raise InputError("alpha, beta", typed, allowed, f"leave them to {potential}")
        object.__setattr__(self, "potential", _potential(potential))

    def __repr__(self) -> str:
        length = "'N'" if self.symbolic else self.N
        return f"Chain(N={length}, {self._law_text()})"

    def _law_text(self) -> str:
        """The law of its bonds as an argument."""
        if self.fpu:
            names = zip(("alpha", "beta"), self.couplings, strict=True)
            return ", ".join(f"{name}={decimal(c)}" for name, c in names if c)
        return f"potential={self.potential!r}"

    @property
    def symbolic(self) -> bool:
        """Whether N is a symbol."""
        return isinstance(self.N, SymbolicLength)

    def at(
        self,
        *,
        N: int | None = None,
        alpha: Number | None = None,
        beta: Number | None = None,
    ) -> Chain:
        """The chain with another N, or an FPU chain with another coupling; None keeps its own.

        >>> Chain("N", alpha="1/4").at(N=8).frequencies()[:2].round(3)
        array([0.39 , 0.765])
        >>> Chain(8, alpha="1/4").at(beta="1/10")
        Chain(N=8, alpha=0.25, beta=0.1)
        """
        N = self.N if N is None else N
        if alpha is None and beta is None:
            return Chain(N, potential=self.potential)
        alpha = self.alpha if alpha is None else alpha
        return Chain(N, alpha, self.beta if beta is None else beta)

    @property
    def fpu(self) -> bool:
        """Whether it is one of the paper's chains: V has alpha and beta and nothing else."""
        return isinstance(self.potential, Polynomial) and self.potential.degree <= 4

    @property
    def couplings(self) -> tuple[Fraction, Fraction]:
        """(alpha, beta) of an FPU chain; InputError for another, by its name."""
        if not self.fpu:
            allowed = "an FPU chain: V of degree 4 at most"
            advice = "this is known for alpha and beta only: take Chain(N, alpha=, beta=)"
            raise InputError("chain", self, allowed, advice)
        return self.potential.coefficient(3), self.potential.coefficient(4)

    @property
    def alpha(self) -> Fraction:
        """c_3 of an FPU chain; InputError for another, by its name."""
        return self.couplings[0]

    @property
    def beta(self) -> Fraction:
        """c_4 of an FPU chain; InputError for another, by its name."""
        return self.couplings[1]

    @property
    def model(self) -> str:
        """'alpha', 'beta' or 'alpha+beta'; else the kind of the potential, as 'toda'."""
        if not self.fpu:
            return self.potential.kind
        if self.alpha and self.beta:
            return "alpha+beta"
        return "alpha" if self.alpha else "beta"

    @property
    def degree_step(self) -> int:
        """How much the degree in the amplitudes grows with the order.

        1 (r = k+1); 2 if V is even (r = 2k+1).
        """
        return 2 if self.potential.even else 1

    @property
    def lowest_force(self) -> int:
        """The least power n > 1 of r in the tension."""
        powers = count(2)
        return next(n for n in powers if self.potential.coefficient(n + 1))

    @property
    def unit_coupling(self) -> Fraction:
        """The coupling in the small parameter: c_3, or c_4 where V is even; 1 where it is zero."""
        return self.potential.coefficient(2 + self.degree_step) or Fraction(1)

    @property
    def mu(self) -> float:
        """The small parameter: c_3/sqrt(2N), or c_4/(2N) where V is even."""
        if self.degree_step == 1:
            root: float = (2 * self.N) ** 0.5
            return float(self.unit_coupling) / root
        return float(self.unit_coupling / (2 * self.N))

    def law(self, numbers: Arithmetic = DOUBLES) -> bonds.Law:
        """The law of a bond in an arithmetic, as the functions of symfpu.chain.bonds take it."""
        return self.potential.law(numbers)

    def relative_couplings(self, highest: int) -> dict[int, Fraction]:
        """By power n of the force r^n, from 2 to the highest, the coupling in units of mu.

        Those units are mu^(n-1), or mu^((n-1)/2) where V is even. Powers that do not act are left
        out.
        """
        step, unit = self.degree_step, self.unit_coupling
        relative = {}
        for power in range(1 + step, highest + 1, step):
            coupling = self.potential.coefficient(power + 1)
            if coupling:
                relative[power] = coupling / unit ** ((power - 1) // step)
        return relative

    def linear_frequency(self, q: int) -> mpmath.mpf:
        """Omega_q = 2 sin(q pi / 2N) (Eq. fpuspec) at the working precision of mpmath."""
        half_turns = mpmath.mpf(q) / (2 * self.N)
        return 2 * mpmath.sinpi(half_turns)

    def small_parameter(self, numbers: Arithmetic = DOUBLES) -> Any:
        """mu in the given arithmetic."""
        if numbers is DOUBLES:
            return self.mu
        if self.degree_step == 1:
            return numbers.number(self.unit_coupling) / mpmath.sqrt(2 * self.N)
        return numbers.number(self.unit_coupling / (2 * self.N))

    def frequencies(self, numbers: Arithmetic = DOUBLES) -> Numbers:
        """Linear frequencies Omega_q (Eq. fpuspec), correctly rounded; shape (N-1,).

        In another arithmetic at the working precision of mpmath.
        """
        if numbers is DOUBLES:
            return linear_frequencies(self.N)
        frequencies = [self.linear_frequency(q) for q in range(1, self.N)]
        return np.array(frequencies, dtype=object)

    def positions(self, Q: ArrayLike) -> Numbers:
        """Particle displacements x_1 .. x_(N-1) of mode coordinates Q (Eq. lintra).

        Shapes (..., N-1).

        The transform is orthogonal and its own inverse: it also takes momenta, and positions to
        modes. Here and below arrays of mpf give arrays of mpf at mpmath's working precision.
        """
        from scipy.fft import dst

        state, numbers = self._state(Q, "Q")
        if numbers is not DOUBLES:
            return numbers.dot(state, sine_matrix(self.N))
        return np.asarray(dst(state, type=1, norm="ortho", axis=-1))

    def modes(self, x: ArrayLike) -> Numbers:
        """Mode coordinates Q_1 .. Q_(N-1) of displacements x (Eq. lintra inverted).

        Shapes (..., N-1).
        """
        return self.positions(x)

    def stretches(self, Q: ArrayLike) -> Numbers:
        """Bond stretches r_j = x_(j+1) - x_j, j = 0 .. N-1, of modes Q.

        Shape (..., N-1) to (..., N).
        """
        x = self.positions(Q)
        fixed_end = np.zeros_like(x[..., :1])
        with_ends = np.concatenate([fixed_end, x, fixed_end], axis=-1)
        return np.diff(with_ends, axis=-1)

    def energy(self, Q: ArrayLike, P: ArrayLike) -> Numbers:
        """Total energy H (Eq. fpuham) of mode coordinates Q and momenta P.

        Shapes (..., N-1) to (...).
        """
        r = self.stretches(Q)
        P, numbers = self._state(P, "P")
        potential = bonds.potential(self.law(numbers), r)
        twice_kinetic = np.sum(P**2, axis=-1)
        return np.asarray(0.5 * twice_kinetic + np.sum(potential, axis=-1))

    def harmonic_energies(self, Q: ArrayLike, P: ArrayLike) -> Numbers:
        """Harmonic energy E_q = (P_q^2 + Omega_q^2 Q_q^2)/2 of every mode (Eq. harmonicene).

        Q, P : mode coordinates and momenta, shapes (..., N-1), as that of the result.
        """
        Q, numbers = self._state(Q, "Q")
        P, _ = self._state(P, "P")
        velocities = self.frequencies(numbers) * Q
        return np.asarray(0.5 * (P**2 + velocities**2))

    def accelerations(self, Q: ArrayLike) -> Numbers:
        """Second time derivative of every mode coordinate Q (Eq. eqmo); shapes (..., N-1)."""
        r = self.stretches(Q)
        numbers = arithmetic_of(r)
        tension = bonds.tension(self.law(numbers), r)
        return self.positions(np.diff(tension, axis=-1))

    def _state(self, values: ArrayLike, argument: str) -> tuple[Numbers, Arithmetic]:
        numbers = arithmetic_of(values)
        try:
            array = numbers.array(values)
        except (TypeError, ValueError) as error:
            allowed = "an array of real numbers"
            raise InputError(argument, values, allowed, "pass numbers") from error
        if array.ndim == 0 or array.shape[-1] != self.N - 1:
            allowed = f"an array whose last axis has length N-1 = {self.N - 1}"
            raise InputError(argument, array.shape, allowed, "put the modes last")
        return array, numbers

    def B(self, q: int, l: int, m: int) -> int:
        """Coupling of three modes q, l, m (Eq. transa), by selection rule.

        -1, 0 or 1 for distinct sums.
        """
        return self._coupling(q, l, m)

    def C(self, q: int, l: int, m: int, n: int) -> int:
        """Coupling of four modes q, l, m, n (Eq. transa).

        With the sums of -2N that the paper leaves out.
        """
        return self._coupling(q, l, m, n)

    def _coupling(self, *modes: int) -> int:
        for mode in modes:
            if integer(mode, "mode", 1) >= self.N:
                raise InputError(
                    "mode", mode, f"1..{self.N - 1}", "name a mode of the chain"
                )
        first, *others = modes
        coupling = 0
        for signs in product((1, -1), repeat=len(others)):
            total = first + sum(s * m for s, m in zip(signs, others, strict=True))
            if total == 0:
                coupling += 1
            elif abs(total) == 2 * self.N:
                coupling -= 1
        return coupling

    def coupled(self, *modes: int) -> Iterator[tuple[int, int]]:
        """The modes q with a coupling to the given two or three, each with its B or C."""
        for q in range(1, self.N):
            coupling = self._coupling(q, *modes)
            if coupling:
                yield q, coupling

    def hamiltonian(self) -> Any:
        """H of Eq. fpuham2 as a SymEngine expression with exact numbers.

        In Q1 .. Q(N-1), P1 .. P(N-1).

        Raises InputError for N above LARGEST_EXPRESSION, where it would have millions of terms.
        """
        Q, P, Omega = self._symbols()
        modes = range(1, self.N)
        H = sum(P[q] ** 2 + Omega[q] ** 2 * Q[q] ** 2 for q in modes) / 2
        u = {q: Omega[q] * Q[q] for q in modes}
        if self.alpha:
            cubic = 0
            for l, m in product(modes, repeat=2):
                for q, b in self.coupled(l, m):
                    cubic += b * u[q] * u[l] * u[m]
            H += rational(self.alpha) / (3 * se.sqrt(2 * self.N)) * cubic
        if self.beta:
            quartic = 0
            for l, m, n in product(modes, repeat=3):
                for q, c in self.coupled(l, m, n):
                    quartic += c * u[q] * u[l] * u[m] * u[n]
            H += rational(self.beta) / (8 * self.N) * quartic
        return H

    def equations_of_motion(self) -> dict[int, Any]:
        """Right-hand sides of d^2 Q_q / dt^2 = -dH/dQ_q (Eq. eqmo) by mode.

        As SymEngine expressions.
        """
        H = self.hamiltonian()
        Q, *_ = self._symbols()
        return {q: -se.diff(H, Q[q]) for q in range(1, self.N)}

    def _symbols(self) -> tuple[dict[int, Any], dict[int, Any], dict[int, Any]]:
        if self.N > LARGEST_EXPRESSION:
            allowed = f"at most {LARGEST_EXPRESSION} for an expression"
            raise InputError(
                "N", self.N, allowed, "use energy() and accelerations() with numbers"
            )
        modes = range(1, self.N)
        Q = {q: se.Symbol(f"Q{q}") for q in modes}
        P = {q: se.Symbol(f"P{q}") for q in modes}
        Omega = {q: 2 * se.sin(se.pi * q / (2 * self.N)) for q in modes}
        return Q, P, Omega


@lru_cache(maxsize=64)
def linear_frequencies(N: int) -> Floats:
    """Omega_1 .. Omega_(N-1), correctly rounded, as a read-only array."""
    frequencies = []
    with mpmath.workdps(30):
        for q in range(1, N):
            half_turns = mpmath.mpf(q) / (2 * N)
            frequencies.append(float(2 * mpmath.sinpi(half_turns)))
    values = np.array(frequencies)
    values.flags.writeable = False
    return values


def require_chain(chain: object) -> None:
    """InputError for what is no Chain."""
    if not isinstance(chain, Chain):
        raise InputError(
            "chain",
            type(chain).__name__,
            "a Chain",
            "make one with Chain(N, alpha=..., beta=...)",
        )


def _potential(value: object) -> Potential:
    """A potential as it was given, or as typed."""
    if isinstance(value, str):
        value = potential_of_text(value)
    if not isinstance(value, Potential):
        allowed = "a potential, or a text such as 'toda:1/2'"
        raise InputError("potential", value, allowed, "write potential=toda('1/2')")
    return value
