"""The chain: its modes, couplings and energies (section 2 of the paper).

The Hamiltonian is also an expression.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import count, product
from operator import index
from typing import Any

import mpmath
import numpy as np
import symengine as se
from numpy.typing import ArrayLike, NDArray

from symfpu.chain import bonds
from symfpu.chain.ends import ENDS, Ends, checked_ends
from symfpu.chain.length import LENGTH, SymbolicLength
from symfpu.chain.potentials.polynomial import Polynomial
from symfpu.chain.potentials.potential import Potential, checked_coupling
from symfpu.chain.potentials.typed import potential_given
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import (
    DOUBLES,
    Arithmetic,
    Numbers,
)
from symfpu.numbers.public import public
from symfpu.numbers.typed import (
    HIGHEST_ORDER,
    Number,
    decimal,
    integer,
    integer_between,
    length_of,
    rational,
)

Floats = NDArray[np.float64]
HIGHEST_POWER = 2 * HIGHEST_ORDER + 2  # of a force, in series of the highest order
LARGEST_EXPRESSION = 40  # bonds; the cubic coupling has about N^3 terms


@public
@dataclass(frozen=True, init=False, repr=False)
class Chain:
    """Chain of N bonds, Eq. fpuham; dimensionless.

    N : number of bonds, at least 2. "N" leaves it a symbol: such a chain has universal series
        (`lindstedt`), and no numbers until `at` puts one for N.
    alpha, beta : cubic and quartic coupling of an FPU chain, V = r^2/2 + alpha r^3/3 +
        beta r^4/4, exact numbers (see symfpu.numbers.typed); at least one is not zero. "0.33" and
        Fraction(33, 100) are what they say, a float is read by its shortest decimal.
    potential : any other law of a bond, V = r^2/2 + c_3 r^3/3 + c_4 r^4/4 + ...: `toda`,
        `lennard_jones`, `polynomial` and others, or as typed on the command line, "toda:1/2".
    ends : "fixed", N - 1 moving particles between walls (the paper's), modes q = 1 .. N-1; or
        "periodic", N particles on a ring, travelling modes q = -(N-1)/2 .. N/2 without 0, complex
        and Q_(-q) = conj Q_q, the mean position and momentum zero. What cannot take a ring
        refuses it by name.

    The paper has one coupling at a time; here all may act. Order k means mu^k: the small parameter
    mu multiplies the amplitudes, mu = c_3/sqrt(2N), and the terms of order k have degree k + 1 in
    them; where V is even it multiplies their squares, mu = c_4/(2N), and the degree is 2k + 1. c_3
    (c_4) is replaced by 1 where it is zero, and 2N by N on a ring.

    Raises InputError for an argument outside its range.

    >>> Chain(N=32, alpha="0.33"), Chain(N=8, potential="toda:1/2")
    (Chain(N=32, alpha=0.33), Chain(N=8, potential=toda(0.5)))
    >>> Chain(N=2, beta=1).frequencies()
    array([1.41421356])
    >>> Chain("N", beta=1), Chain("N", beta=1).at(N=32)
    (Chain(N='N', beta=1), Chain(N=32, beta=1))
    >>> Chain(N=4, beta=1, ends="periodic").mode_numbers
    (-1, 1, 2)
    """

    N: int
    potential: Potential
    ends: str = "fixed"

    def __init__(
        self,
        N: int | str,
        alpha: Number = 0,
        beta: Number = 0,
        *,
        potential: Potential | str | None = None,
        ends: str = "fixed",
    ) -> None:
        symbolic = isinstance(N, SymbolicLength) or (isinstance(N, str) and N == "N")
        object.__setattr__(self, "N", LENGTH if symbolic else length_of(N))
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
        object.__setattr__(self, "potential", potential_given(potential))
        object.__setattr__(self, "ends", checked_ends(ends))
        if symbolic and self.periodic:
            advice = "put a number for N: series of a ring hold for one N"
            raise InputError("N", "N", "a number where ends='periodic'", advice)

    def __repr__(self) -> str:
        return f"Chain({self.label})"

    @property
    def label(self) -> str:
        """The chain as it is typed between the parentheses of `Chain(...)`.

        >>> Chain(N=8, alpha="0.3").label
        'N=8, alpha=0.3'
        """
        length = "'N'" if self.symbolic else self.N
        ends = ", ends='periodic'" if self.periodic else ""
        return f"N={length}, {self._law_text()}{ends}"

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

    @property
    def periodic(self) -> bool:
        """Whether it is a ring."""
        return self.ends == "periodic"

    @cached_property
    def kind_of_ends(self) -> Ends:
        """What its ends decide: particles, modes and the transform between them."""
        return ENDS[self.ends](self.N)

    @property
    def mode_numbers(self) -> tuple[int, ...]:
        """The modes q in the order of every axis of modes, ascending; N - 1 of them."""
        return self.kind_of_ends.modes

    def seeds_of(self, seeds: Iterable[object]) -> tuple[int, ...]:
        """Distinct modes of the chain, in the given order; InputError for what is none.

        seeds : any whole numbers.

        >>> Chain(N=8, beta=1, ends="periodic").seeds_of((1, -1, 4))
        (1, -1, 4)
        """
        return self.kind_of_ends.seeds(seeds)

    @property
    def turn(self) -> int:
        """The period of wave numbers: 2N, or N on a ring."""
        return self.N if self.periodic else 2 * self.N

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
            return Chain(N, potential=self.potential, ends=self.ends)
        alpha = self.alpha if alpha is None else alpha
        beta = self.beta if beta is None else beta
        return Chain(N, alpha, beta, ends=self.ends)

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
    def typed_law(self) -> dict[str, str]:
        """The law of its bonds as files name it: alpha and beta, or the potential as typed."""
        if not self.fpu:
            return {"potential": self.potential.text}
        names = zip(("alpha", "beta"), self.couplings, strict=True)
        return {name: decimal(coupling) for name, coupling in names}

    @property
    def typed(self) -> dict[str, Any]:
        """N and the law as files name them, and the ends of a ring."""
        ends = {"ends": self.ends} if self.periodic else {}
        return {"N": self.N, **self.typed_law, **ends}

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

    def shift_degrees(self, highest: int) -> tuple[int, ...]:
        """The even degrees in the amplitudes, up to the highest, that frequencies can shift with.

        A force r^n raises the degree by n - 1, alone or together with others.
        """
        integer_between(highest, "highest", 0, HIGHEST_POWER - 1, "a lower degree")
        powers = self.relative_couplings(highest + 1)
        reached = {0}
        for degree in range(1, highest + 1):
            if any(degree - (n - 1) in reached for n in powers):
                reached.add(degree)
        return tuple(degree for degree in sorted(reached) if degree and degree % 2 == 0)

    @property
    def unit_coupling(self) -> Fraction:
        """The coupling in the small parameter: c_3, or c_4 where V is even; 1 where it is zero."""
        return self.potential.coefficient(2 + self.degree_step) or Fraction(1)

    @property
    def mu(self) -> float:
        """The small parameter: c_3/sqrt(2N), or c_4/(2N) where V is even; N for 2N on a ring."""
        if self.degree_step == 1:
            root: float = self.turn**0.5
            return float(self.unit_coupling) / root
        return float(self.unit_coupling / self.turn)

    def law(self, numbers: Arithmetic = DOUBLES) -> bonds.Law:
        """The law of a bond in an arithmetic, as the functions of symfpu.chain.bonds take it."""
        return self.potential.law(numbers)

    def relative_couplings(self, highest: int) -> dict[int, Fraction]:
        """By power n of the force r^n, from 2 to the highest, the coupling in units of mu.

        Those units are mu^(n-1), or mu^((n-1)/2) where V is even. Powers that do not act are left
        out.
        """
        integer_between(highest, "highest", 0, HIGHEST_POWER, "a lower power")
        step, unit = self.degree_step, self.unit_coupling
        relative = {}
        for power in range(1 + step, highest + 1, step):
            coupling = self.potential.coefficient(power + 1)
            if coupling:
                relative[power] = coupling / unit ** ((power - 1) // step)
        return relative

    def linear_frequency(self, q: int) -> mpmath.mpf:
        """Omega_q = 2 sin(q pi / 2N) (Eq. fpuspec) at the working precision of mpmath.

        On a ring 2 |sin(q pi / N)|.
        """
        half_turns = mpmath.mpf(abs(index(q))) / self.turn
        return 2 * mpmath.sinpi(half_turns)

    def small_parameter(self, numbers: Arithmetic = DOUBLES) -> Any:
        """mu in the given arithmetic."""
        if numbers is DOUBLES:
            return self.mu
        if self.degree_step == 1:
            return numbers.number(self.unit_coupling) / mpmath.sqrt(self.turn)
        return numbers.number(self.unit_coupling / self.turn)

    def frequencies(self, numbers: Arithmetic = DOUBLES) -> Numbers:
        """Linear frequencies Omega_q (Eq. fpuspec), correctly rounded; shape (N-1,).

        In another arithmetic at the working precision of mpmath.
        """
        if numbers is DOUBLES:
            return linear_frequencies(self.N, self.ends)
        frequencies = [self.linear_frequency(q) for q in self.mode_numbers]
        return np.array(frequencies, dtype=object)

    def positions(self, Q: ArrayLike) -> Numbers:
        """Particle displacements x_1 .. x_(N-1) of mode coordinates Q (Eq. lintra).

        Shapes (..., N-1). On a ring x_0 .. x_(N-1) of complex Q_q, N^(-1/2) sum Q_q
        e^(2 pi i q j / N), (..., N-1) to (..., N).

        The transform of fixed ends is orthogonal and its own inverse: it also takes momenta, and
        positions to modes. Here and below arrays of mpf, or mpc, give the same at mpmath's working
        precision.
        """
        state, numbers = self.kind_of_ends.state(Q, "Q")
        return self.kind_of_ends.positions(state, numbers)

    def modes(self, x: ArrayLike) -> Numbers:
        """Mode coordinates Q_1 .. Q_(N-1) of displacements x (Eq. lintra inverted).

        Shapes (..., N-1). On a ring (..., N) to complex (..., N-1): Q_q of `mode_numbers`; the
        mean, which is no mode, is left out.
        """
        return self.kind_of_ends.coordinates(*self.kind_of_ends.displacements(x, "x"))

    def stretches(self, Q: ArrayLike) -> Numbers:
        """Bond stretches r_j = x_(j+1) - x_j, j = 0 .. N-1, of modes Q.

        Shape (..., N-1) to (..., N).
        """
        return self.kind_of_ends.stretches(self.positions(Q))

    def energy(self, Q: ArrayLike, P: ArrayLike) -> Numbers:
        """Total energy H (Eq. fpuham) of mode coordinates Q and momenta P.

        Shapes (..., N-1) to (...).
        """
        r = self.stretches(Q)
        P, numbers = self.kind_of_ends.state(P, "P")
        potential = bonds.potential(self.law(numbers), r)
        twice_kinetic = np.sum(_squared(P), axis=-1)
        return np.asarray(0.5 * twice_kinetic + np.sum(potential, axis=-1))

    def harmonic_energies(self, Q: ArrayLike, P: ArrayLike) -> Numbers:
        """Harmonic energy E_q = (P_q^2 + Omega_q^2 Q_q^2)/2 of every mode (Eq. harmonicene).

        Q, P : mode coordinates and momenta, shapes (..., N-1), as that of the result. On a ring
        |P_q|^2 and |Q_q|^2.
        """
        Q, numbers = self.kind_of_ends.state(Q, "Q")
        P, _ = self.kind_of_ends.state(P, "P")
        velocities = self.frequencies(numbers) * Q
        return np.asarray(0.5 * (_squared(P) + _squared(velocities)))

    def accelerations(self, Q: ArrayLike) -> Numbers:
        """Second time derivative of every mode coordinate Q (Eq. eqmo); shapes (..., N-1)."""
        Q, numbers = self.kind_of_ends.state(Q, "Q")
        linear = self.frequencies(numbers) ** 2 * Q
        return np.asarray(self.anharmonic_accelerations(Q) - linear)

    def anharmonic_accelerations(self, Q: ArrayLike) -> Numbers:
        """The same without the linear part, -Omega_q^2 Q_q.

        Q : mode coordinates, shapes (..., N-1), as that of the result.
        """
        Q, numbers = self.kind_of_ends.state(Q, "Q")
        r, law = self.kind_of_ends.stretches_of_modes(Q, numbers), self.law(numbers)
        if numbers is DOUBLES:
            tension = bonds.anharmonic_tension(law, r)
        else:
            tension = bonds.tension(law, r) - r
        return self.kind_of_ends.forces_on_modes(tension, numbers)

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
        require_fixed_ends(self)
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
        require_fixed_ends(self)
        for q in range(1, self.N):
            coupling = self._coupling(q, *modes)
            if coupling:
                yield q, coupling

    def hamiltonian(self) -> Any:
        """H of Eq. fpuham2 as a SymEngine expression with exact numbers.

        In Q1 .. Q(N-1), P1 .. P(N-1); of other than FPU chains as the sum of V(r_j) over the
        bonds, with their stretches r_j in the Q.

        Raises InputError for N above LARGEST_EXPRESSION, where it would have millions of terms.
        """
        Q, P, Omega = self._symbols()
        modes = range(1, self.N)
        if not self.fpu:
            return sum(P[q] ** 2 for q in modes) / 2 + self._potential_energy(Q, Omega)
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

    def _potential_energy(self, Q: dict[int, Any], Omega: dict[int, Any]) -> Any:
        """The sum of V(r_j), r_j = sqrt(2/N) sum_q Omega_q Q_q cos(q (j + 1/2) pi/N)."""
        import sympy

        r = sympy.Symbol("r")
        law = se.sympify(self.potential.expression(r))
        total = 0
        for j in range(self.N):
            stretch = 0
            for q in Q:
                half_turns = rational(Fraction(q * (2 * j + 1), 2 * self.N))
                stretch += Omega[q] * Q[q] * se.cos(se.pi * half_turns)
            total += law.subs(
                {se.Symbol("r"): se.sqrt(rational(Fraction(2, self.N))) * stretch}
            )
        return total

    def equations_of_motion(self) -> dict[int, Any]:
        """Right-hand sides of d^2 Q_q / dt^2 = -dH/dQ_q (Eq. eqmo) by mode.

        As SymEngine expressions.
        """
        H = self.hamiltonian()
        Q, *_ = self._symbols()
        return {q: -se.diff(H, Q[q]) for q in range(1, self.N)}

    def _symbols(self) -> tuple[dict[int, Any], dict[int, Any], dict[int, Any]]:
        require_fixed_ends(self)
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
def linear_frequencies(N: int, ends: str = "fixed") -> Floats:
    """Omega_q of all modes, correctly rounded, as a read-only array."""
    kind = ENDS[ends](N)
    frequencies = []
    with mpmath.workdps(30):
        for q in kind.modes:
            half_turns = mpmath.mpf(abs(q)) / kind.turn
            frequencies.append(float(2 * mpmath.sinpi(half_turns)))
    values = np.array(frequencies)
    values.flags.writeable = False
    return values


TAKES_RINGS = (
    "leave ends= out; what takes a ring, as lindstedt or torus, is in docs/chains.md"
)


@lru_cache(maxsize=64)
def linear_by_wave(N: int, ends: str = "fixed") -> Floats:
    """Omega of the wave numbers 0 .. N-1, of which 0 does not move, as a read-only array."""
    values = np.zeros(N)
    values[np.array(ENDS[ends](N).modes) % N] = linear_frequencies(N, ends)
    values.flags.writeable = False
    return values


def require_chain(chain: object) -> None:
    """InputError for what is no Chain with fixed ends: what every public function asks first.

    One that takes a ring too asks `require_any_chain`.
    """
    require_fixed_ends(require_any_chain(chain))


def require_any_chain(chain: object) -> Chain:
    """InputError for what is no Chain, whatever its ends."""
    if not isinstance(chain, Chain):
        raise InputError(
            "chain",
            type(chain).__name__,
            "a Chain",
            "make one with Chain(N, alpha=..., beta=...)",
        )
    return chain


def require_fixed_ends(chain: Chain, advice: str = TAKES_RINGS) -> None:
    """InputError for a ring, by its name."""
    if chain.periodic:
        allowed = "a chain with fixed ends: this is not known on a ring"
        raise InputError("chain", chain, allowed, advice)


def _squared(values: Numbers) -> Numbers:
    """|values|^2."""
    if values.dtype == complex:
        return np.asarray(values.real**2 + values.imag**2)
    if values.dtype == object:
        return np.asarray(_SQUARED_SIZES(values), dtype=object)
    return np.asarray(values**2)


_SQUARED_SIZES = np.frompyfunc(lambda value: value.real**2 + value.imag**2, 1, 1)
