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

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.chain.symbols import linear_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import rational, seed_modes
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Table

Floats = NDArray[np.float64]
TODA = Fraction(2, 3)  # beta / alpha^2
# of an eigenvalue in doubles, by the size of the matrix: more than eigvalsh loses
ROUNDING = 16 * float(np.finfo(float).eps)


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


@public
@dataclass(frozen=True)
class TwistAtRest(Tabled):
    """Lambda = d omega / d I of some modes as their amplitudes vanish; made by `twist_at_rest`.

    chain, seeds : the model and its modes. signature : how many eigenvalues are positive, negative,
    and zero or below rounding; exact where alpha = 0.
    definite_range : beta/alpha^2 between which Lambda of these modes is positive definite, whatever
        the couplings of this chain; inf where it does not end; of eigenvalues in doubles.
    Dimensionless. Ours.

    >>> from symfpu import Chain, twist_at_rest
    >>> twist_at_rest(Chain(32, alpha="0.33"), (1, 2))
    TwistAtRest(N=32, alpha=0.33, seeds=1,2, positive definite, definite for
    beta/alpha^2 in (-15.9649..., 165.7073...))
    """

    not_kept = "make it again, or keep its table: to_frame()"

    chain: Chain
    seeds: tuple[int, ...]
    signature: tuple[int, int, int]
    definite_range: tuple[float, float]

    def __repr__(self) -> str:
        chain = self.chain.label
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
        alpha, beta = map(float, _couplings(self.chain))
        G = _scaled(self.chain.N, self.seeds)
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


@public
def twist_at_rest(chain: Chain, seeds: Sequence[int] | None = None) -> TwistAtRest:
    """Lambda = d omega / d I at rest, in closed form, with its signature.

    chain : of any potential, with fixed ends; c_3 and c_4 count as alpha and beta. seeds : modes;
        default all N-1. Dimensionless.

    The signature of the beta chain is exact, that of others is that of eigenvalues in doubles: one
    that rounding does not tell from zero counts as zero. Returns TwistAtRest. Ours; fourth order
    of Birkhoff's normal form. Raises InputError, also where both couplings are zero.

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
        found = _signature(chain.N, modes, Fraction(3, 2) * (beta / alpha**2 - TODA))
    else:
        inertia = _inertia(chain.N, modes)
        found = (*(inertia if beta > 0 else inertia[::-1]), 0)
    return TwistAtRest(chain, modes, found, definite_range(chain.N, modes))


def _couplings(chain: Chain) -> tuple[Fraction, Fraction]:
    alpha, beta = (Fraction(chain.potential.coefficient(n)) for n in (3, 4))
    return alpha, beta


def definite_range(N: int, seeds: Sequence[int]) -> tuple[float, float]:
    """beta/alpha^2 between which 1 + tau G is positive definite: 2/3 - 2/(3 g), g its extreme
    eigenvalues in doubles; no upper end where G has no negative one.
    """
    values = np.linalg.eigvalsh(_scaled(N, seeds))
    low = float(TODA) * (1 - 1 / values[-1])
    high = float(TODA) * (1 - 1 / values[0]) if _inertia(N, seeds)[1] else np.inf
    return float(low), float(high)


def _inertia(N: int, seeds: Sequence[int]) -> tuple[int, int]:
    """How many eigenvalues of G are positive and negative: the theorem above."""
    pairs = sum(N - q in seeds for q in seeds if 2 * q < N)
    return pairs + 1, len(seeds) - pairs - 1


def _scaled(N: int, seeds: Sequence[int]) -> Floats:
    """G in doubles."""
    linear = 2 * np.sin(np.pi * np.array(seeds) / (2 * N))
    by_beta = [[shift_coefficients(N, q, n)[1] for n in seeds] for q in seeds]
    weights = np.array(by_beta, dtype=float) * 2 / 3
    return np.asarray(weights * np.outer(linear, linear))


def _signature(N: int, seeds: Sequence[int], tau: Fraction) -> tuple[int, int, int]:
    """Of 1 + tau G: how many eigenvalues are positive, negative, and zero or below rounding."""
    scaled = float(tau) * np.linalg.eigvalsh(_scaled(N, seeds))
    values = 1 + scaled
    rounding = ROUNDING * len(seeds) * (1 + float(np.abs(scaled).max()))
    positive, negative = int(np.sum(values > rounding)), int(np.sum(values < -rounding))
    return positive, negative, len(seeds) - positive - negative
