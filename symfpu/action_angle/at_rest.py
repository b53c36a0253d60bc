"""The twist at rest: fourth order of Birkhoff's normal form, in closed form and for any N.

By the shifts of `symfpu.chain.frequency_shift` and I_n = Omega_n A_n^2 / 2,

    Lambda = (alpha^2/N) (1 + tau G),  tau = (3/2)(beta/alpha^2 - 2/3);  Lambda = (3 beta/2N) G
    where alpha = 0;  G_qq = 3/4 Omega_q^2 (1/2 for q = N/2),  G_qn = Omega_q Omega_n, halved where
    q + n = N.

At Toda's coupling beta/alpha^2 = 2/3 it is alpha^2/N times 1 for any modes. G has p + 1 positive
eigenvalues and s - p - 1 negative ones, p the number of pairs q + n = N among the s modes: without
Omega_q, G is a sum of blocks and the matrix of ones, and 1 - 8p/3 - 2f - 4m < 0 (f = 1 with N/2, m
modes without partner) decides. So the twist of the beta chain is definite for one mode, and for a
pair q, N-q, and for nothing else; with alpha it is definite between two values of beta/alpha^2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import flint
import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.chain.symbols import linear_symbol
from symfpu.errors import InputError
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.numbers.typed import rational, seed_modes

Floats = NDArray[np.float64]
FIRST_BITS = 128
TODA = Fraction(2, 3)  # beta / alpha^2
PLACES = 10**12  # of the ends of the range
EDGE = Fraction(1, 10**10)  # half width of the enclosure of an end of the range


def in_words(signature: tuple[int, int, int]) -> str:
    """How many eigenvalues are positive, negative and zero, as a word.

    >>> in_words((2, 0, 0)), in_words((1, 1, 0))
    ('positive definite', 'indefinite (1 positive, 1 negative)')
    """
    positive, negative, zero = signature
    if zero:
        return f"degenerate ({positive} positive, {negative} negative, {zero} zero)"
    if positive and negative:
        return f"indefinite ({positive} positive, {negative} negative)"
    return "positive definite" if positive else "negative definite"


@dataclass(frozen=True)
class TwistAtRest(Tabled):
    """Lambda = d omega / d I of some modes as their amplitudes vanish; made by `twist_at_rest`.

    chain, seeds : the model and its modes. signature : how many eigenvalues are positive, negative,
    zero: exact.
    definite_range : beta/alpha^2 between which Lambda of these modes is positive definite, whatever
        the couplings of this chain; -inf or inf where it does not end; to 1e-10, proved.
    Dimensionless. Ours.

    >>> from symfpu import Chain, twist_at_rest
    >>> twist_at_rest(Chain(32, alpha="0.33"), (1, 2))
    TwistAtRest(N=32, alpha=0.33, seeds=1,2, positive definite, definite for
    beta/alpha^2 in (-15.9649..., 165.7073...))
    """

    chain: Chain
    seeds: tuple[int, ...]
    signature: tuple[int, int, int]
    definite_range: tuple[float, float]

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        seeds = ",".join(map(str, self.seeds))
        low, high = self.definite_range
        where = f"definite for beta/alpha^2 in ({low:.10g}, {high:.10g})"
        return f"TwistAtRest({chain}, seeds={seeds}, {self.definiteness}, {where})"

    @property
    def definiteness(self) -> str:
        """The signature in words."""
        return in_words(self.signature)

    @property
    def matrix(self) -> Floats:
        """Lambda in doubles, (s, s)."""
        linear = self.chain.frequencies()[np.array(self.seeds) - 1]
        alpha, beta = map(float, _couplings(self.chain))
        weights = np.array(
            [[float(_weight(self.chain.N, q, n)) for n in self.seeds] for q in self.seeds]
        )
        G = weights * np.outer(linear, linear)
        own = alpha**2 * (np.eye(len(self.seeds)) - G) + 1.5 * beta * G
        return np.asarray(own / self.chain.N)

    def formula(self) -> list[list[Any]]:
        """Lambda as SymEngine expressions in Omega_q, rows of columns."""
        N = self.chain.N
        alpha, beta = _couplings(self.chain)
        rows = []
        for q in self.seeds:
            row = []
            for n in self.seeds:
                (a, b), c = shift_coefficients(N, q, n)
                product = linear_symbol(q) * linear_symbol(n)
                constant = rational(alpha**2 * a / N) if q == n else se.Integer(0)
                row.append(constant + rational((alpha**2 * b + beta * c) / N) * product)
            rows.append(row)
        return rows

    def _table(self) -> Table:
        s = range(len(self.seeds))
        entries = [(i, j) for i in s for j in s]
        formula, matrix = self.formula(), self.matrix
        columns: dict[str, Any] = {
            "seed": [self.seeds[i] for i, _ in entries],
            "by": [self.seeds[j] for _, j in entries],
            "twist": [float(matrix[i, j]) for i, j in entries],
            "formula": [formula[i][j] for i, j in entries],
        }
        known = attributes(
            self,
            self.chain,
            seeds=self.seeds,
            signature=self.signature,
            definite_range=self.definite_range,
        )
        return Table(columns, known)


def twist_at_rest(chain: Chain, seeds: Sequence[int] | None = None) -> TwistAtRest:
    """Lambda = d omega / d I at rest, in closed form, with its exact signature.

    chain : of any potential, with fixed ends; c_3 and c_4 count as alpha and beta. seeds : modes;
        default all N-1. Dimensionless.

    Signs are proved: pivots in balls; where one holds zero, the coefficients of the characteristic
    polynomial, until they are below what an algebraic integer of their field can be. Returns
    TwistAtRest.
    Ours; fourth order of Birkhoff's normal form. Raises InputError, also where both couplings are
    zero.

    >>> from symfpu import Chain
    >>> twist_at_rest(Chain(8, beta=1)).signature
    (4, 3, 0)
    >>> twist_at_rest(Chain(12, alpha=3, beta=-2), (4,)).signature  # beta/alpha^2 = -2/9
    (0, 0, 1)
    """
    require_chain(chain)
    modes = seed_modes(chain.mode_numbers if seeds is None else seeds, chain.N)
    alpha, beta = _couplings(chain)
    if not alpha and not beta:
        allowed = "c_3 or c_4 other than zero"
        raise InputError("chain", chain, allowed, "see birkhoff_form for higher orders")
    if alpha:
        tau = Fraction(3, 2) * (beta / alpha**2 - TODA)
        found = _signature(chain.N, modes, Fraction(1), tau)
    else:
        found = _signature(chain.N, modes, Fraction(0), beta)
    return TwistAtRest(chain, modes, found, definite_range(chain.N, modes))


def _couplings(chain: Chain) -> tuple[Fraction, Fraction]:
    alpha, beta = (Fraction(chain.potential.coefficient(n)) for n in (3, 4))
    return alpha, beta


def _weight(N: int, q: int, n: int) -> Fraction:
    """G_qn / (Omega_q Omega_n)."""
    if q == n:
        return Fraction(1, 2) if 2 * q == N else Fraction(3, 4)
    return Fraction(1, 2 if q + n == N else 1)


def definite_range(N: int, seeds: Sequence[int]) -> tuple[float, float]:
    """beta/alpha^2 between which 1 + tau G is positive definite; ends to 1e-10, proved."""
    linear = 2 * np.sin(np.pi * np.array(seeds) / (2 * N))
    weights = np.array([[float(_weight(N, q, n)) for n in seeds] for q in seeds])
    values = np.linalg.eigvalsh(weights * np.outer(linear, linear))
    low = _end(N, seeds, float(values[-1]))
    high = (
        _end(N, seeds, float(values[0])) if len(seeds) > 1 and values[0] < 0 else math.inf
    )
    return low, high


def _end(N: int, seeds: Sequence[int], eigenvalue: float) -> float:
    """2/3 - 2 / (3 g) of an extreme eigenvalue g: definite inside, not definite outside."""
    guess = Fraction(round((TODA - TODA / Fraction(eigenvalue)) * PLACES), PLACES)
    inward = EDGE if eigenvalue > 0 else -EDGE
    for end, inside in ((guess + inward, True), (guess - inward, False)):
        tau = Fraction(3, 2) * (end - TODA)
        positive, *_ = _signature(N, seeds, Fraction(1), tau)
        if (positive == len(seeds)) != inside:
            raise ArithmeticError(f"the end {float(guess)} of modes {seeds} is not proved")
    return float(guess)


def _signature(
    N: int, seeds: Sequence[int], constant: Fraction, tau: Fraction
) -> tuple[int, int, int]:
    """Of constant + tau G: how many eigenvalues are positive, negative, zero."""
    scale = 4 * math.lcm(constant.denominator, tau.denominator)
    constant, tau = constant * scale, tau * scale
    with flint.ctx.workprec(FIRST_BITS + 8 * len(seeds)):
        pivots = _pivots(_entries(N, seeds, constant, tau))
    if pivots is not None:
        positive = sum(pivots)
        return positive, len(seeds) - positive, 0
    # all roots of the characteristic polynomial are real: Descartes' rule counts them
    signs = _signs(N, seeds, constant, tau)
    zero = next(k for k, sign in enumerate(signs) if sign)
    present = [sign for sign in signs if sign]
    positive = sum(a != b for a, b in pairwise(present))
    return positive, len(seeds) - positive - zero, zero


def _pivots(rows: list[list[Any]]) -> list[bool] | None:
    """Whether each pivot of a symmetric elimination is positive: Sylvester's law of inertia.

    None where a ball does not tell the sign of a pivot.
    """
    left, found = rows, []
    while left:
        place = max(range(len(left)), key=lambda k: abs(float(left[k][k])))
        pivot = left[place][place]
        if pivot.contains(0):
            return None
        found.append(bool(pivot > 0))
        line = left[place]
        others = [k for k in range(len(left)) if k != place]
        factors = {k: left[k][place] / pivot for k in others}
        left = [[left[i][j] - factors[i] * line[j] for j in others] for i in others]
    return found


def _signs(N: int, seeds: Sequence[int], constant: Fraction, tau: Fraction) -> list[int]:
    """Signs of the coefficients of the characteristic polynomial, the lowest first.

    Entries are algebraic integers. All conjugates of a coefficient of degree k in the entries are
    at most binomial(s, k) R^k, R a bound of the row sums with |Omega| <= 2: if it is not zero, it
    is not smaller than that to the power 1 - d, d the degree of their field.
    """
    s, field = len(seeds), _totient(4 * N)
    bound = math.ceil(abs(constant) + 4 * s * abs(tau)) + 1
    bits = FIRST_BITS
    while True:
        with flint.ctx.workprec(bits):
            matrix = flint.arb_mat(_entries(N, seeds, constant, tau))
            coefficients = list(matrix.charpoly().coeffs())
            signs = []
            for k, c in enumerate(coefficients):
                power = s - k
                largest = math.comb(s, power) * bound**power
                signs.append(_sign(c, (field - 1) * largest.bit_length()))
        if None not in signs:
            return [sign for sign in signs if sign is not None]
        bits *= 2


def _sign(ball: Any, gap: int) -> int | None:
    """Of a number that is zero or at least 2^-gap; None where the ball does not tell."""
    if not ball.contains(0):
        return 1 if ball > 0 else -1
    return 0 if abs(ball) < flint.arb(2) ** -gap else None


def _entries(
    N: int, seeds: Sequence[int], constant: Fraction, tau: Fraction
) -> list[list[Any]]:
    """constant + tau G in balls."""
    linear = {q: 2 * flint.arb.sin_pi_fmpq(flint.fmpq(q, 2 * N)) for q in seeds}
    rows: list[list[Any]] = []
    for q in seeds:
        row = [linear[q] * linear[n] * _fmpq(tau * _weight(N, q, n)) for n in seeds]
        row[len(rows)] += _fmpq(constant)
        rows.append(row)
    return rows


def _fmpq(value: Fraction) -> Any:
    return flint.arb(flint.fmpq(value.numerator, value.denominator))


def _totient(n: int) -> int:
    return sum(math.gcd(k, n) == 1 for k in range(1, n + 1))
