"""The twist of a torus, Lambda = d omega / d I: how its frequencies turn with its actions.

Neighbouring tori turn against each other by t Lambda dI. KAM theory wants Lambda or the
isoenergetic determinant, of Lambda bordered by omega, not to vanish; where Lambda is definite H is
convex in the actions, and Nekhoroshev's estimates are at their best.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import mpmath
import numpy as np

from symfpu.action_angle.actions import actions
from symfpu.action_angle.at_rest import in_words
from symfpu.action_angle.newton_twist import (
    REFINED,
    NoTwist,
    changes_by_newton,
    changes_in_digits,
)
from symfpu.chain.chain import Chain
from symfpu.normal.torus import in_digits, require_refined
from symfpu.numbers.arithmetic import (
    DOUBLES,
    MULTIPRECISION,
    Numbers,
    mpf,
    text,
    with_digits,
)
from symfpu.numbers.public import public
from symfpu.results.attributes import attributes
from symfpu.results.field import (
    Field,
    chain_fields,
    numbers_by_seed,
    seeds_field,
    shown_number,
)
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Gridded
from symfpu.tori.torus import Torus

SHOWN_DIGITS = 10


@dataclass(frozen=True, eq=False)
class Twist(Gridded):
    """Lambda_ij = d omega_i / d I_j of a torus with its actions; made by `twist`, dimensionless.

    chain, seeds : of the torus. frequencies, actions : of every angle, (s,). matrix : Lambda as it
    was computed, (s, s), symmetric on a torus: see `asymmetry`.
    method : "Newton". digits : of numbers that are mpf; None for doubles. Ours.

    >>> import symfpu
    >>> from symfpu import Chain, refine, twist
    >>> twist(symfpu.torus(Chain(8, beta=1), (1, 3), amplitudes={1: "0.1", 3: "0.1"}))
    Twist(N=8, beta=1, seeds=1,3, indefinite (1 positive, 1 negative), smallest eigenvalue
    -0.01375..., isoenergetic determinant 0.01756...)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: Numbers = field(repr=False)
    actions: Numbers = field(repr=False)
    matrix: Numbers = field(repr=False)
    method: str
    digits: int | None = None

    def _fields(self) -> Iterator[Field]:
        digits = self.digits

        def written(values: Any) -> list[str]:
            return [number_text(x, digits) for x in values]

        yield from chain_fields(self.chain)
        yield seeds_field(self.seeds)
        yield Field("frequencies", numbers_by_seed(self.omega, digits))
        yield Field("digits", digits)
        actions = dict(zip(self.seeds, self.actions, strict=True))
        yield Field("actions", numbers_by_seed(actions, digits))
        yield Field("twist", list(map(written, self.matrix)))
        yield Field("twist_method", self.method)
        yield Field("asymmetry", fifteen_digits(self.asymmetry))
        yield Field("eigenvalues", written(self.eigenvalues))
        yield Field("signature", list(self.signature))
        yield Field("definiteness", self.definiteness, "definiteness")
        for name in ("determinant", "isoenergetic_determinant"):
            value = getattr(self, name)
            shown = shown_number(value, digits)
            yield Field(name, number_text(value, digits), name.replace("_", " "), shown)

    def __repr__(self) -> str:
        chain = self.chain.label
        seeds = ",".join(map(str, self.seeds))
        smallest = text(self.smallest_eigenvalue, SHOWN_DIGITS)
        determinant = text(self.isoenergetic_determinant, SHOWN_DIGITS)
        return (
            f"Twist({chain}, seeds={seeds}, {self.definiteness}, smallest eigenvalue {smallest}, "
            f"isoenergetic determinant {determinant})"
        )

    def _context(self) -> Any:
        numbers = DOUBLES if self.digits is None else MULTIPRECISION
        return numbers.context(self.digits)

    @property
    def omega(self) -> dict[int, Any]:
        """The frequencies by seed, as everywhere."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    @property
    def asymmetry(self) -> float:
        """Largest |Lambda_ij - Lambda_ji|, over the largest entry: what the torus lacks."""
        largest = float(np.abs(self.matrix).max())
        difference = float(np.abs(self.matrix - self.matrix.T).max())
        return difference / largest if largest else 0.0

    @cached_property
    def eigenvalues(self) -> Numbers:
        """Of the symmetric part, ascending; (s,)."""
        with self._context():
            symmetric = (self.matrix + self.matrix.T) / 2
            if self.digits is None:
                return np.asarray(np.linalg.eigvalsh(symmetric))
            found = mpmath.eigsy(mpmath.matrix(symmetric.tolist()), eigvals_only=True)
            values = np.array(sorted(found), dtype=object)
        return with_digits(values, self.digits)

    @property
    def smallest_eigenvalue(self) -> Any:
        """The one of smallest modulus, which tells how far the twist is from degenerate."""
        return min(self.eigenvalues, key=abs)

    @property
    def signature(self) -> tuple[int, int, int]:
        """How many eigenvalues are positive, negative, and not told from zero."""
        level = max(self.asymmetry, _rounding(self.digits)) * float(abs(self.matrix).max())
        values = [float(x) for x in self.eigenvalues]
        positive = sum(x > level for x in values)
        negative = sum(x < -level for x in values)
        return positive, negative, len(values) - positive - negative

    @property
    def definiteness(self) -> str:
        """The signature in words."""
        return in_words(self.signature)

    @property
    def determinant(self) -> Any:
        """det Lambda."""
        return self._determinant(self.matrix)

    @property
    def isoenergetic_determinant(self) -> Any:
        """The determinant of Lambda bordered by omega, with 0 in the corner; (s+1, s+1)."""
        s = len(self.seeds)
        bordered = np.zeros((s + 1, s + 1), dtype=self.matrix.dtype)
        bordered[:s, :s] = self.matrix
        bordered[s, :s] = bordered[:s, s] = self.frequencies
        return self._determinant(bordered)

    def _determinant(self, matrix: Numbers) -> Any:
        with self._context():
            if self.digits is None:
                return float(np.linalg.det(matrix))
            return with_digits(mpmath.det(mpmath.matrix(matrix.tolist())), self.digits)

    def _grid(self) -> Grid:
        return Grid(
            axes={"seed": self.seeds, "by": self.seeds},
            variables={
                "frequency": Variable(("seed",), self.frequencies, "frequency omega_q"),
                "action": Variable(("seed",), self.actions, "action I_q"),
                "eigenvalue": Variable(("seed",), self.eigenvalues, "of Lambda, ascending"),
                "twist": Variable(
                    ("seed", "by"),
                    self.matrix,
                    "derivative of omega of the seed by an action",
                ),
            },
            attributes=attributes(
                self,
                self.chain,
                seeds=self.seeds,
                method=self.method,
                signature=self.signature,
                determinant=self.determinant,
                isoenergetic_determinant=self.isoenergetic_determinant,
                digits=self.digits,
            ),
            rows=("seed", "by"),
        )


def _rounding(digits: int | None) -> float:
    return 1e-10 if digits is None else 10.0**-digits


@public
def twist(solution: Torus) -> Twist:
    """Lambda = d omega / d I of a torus or breather, its signature and determinants.

    solution : a refined torus (`refine`) or a breather, by Newton's matrix: in doubles, of one
        that was refined to many digits (`refine` with digits) with as many; of a ring,
        refined: travelling waves, or what `unfold` gave. Dimensionless.

    Nothing is a difference of two tori. Lambda of an exact torus is symmetric. A truncated series
    is no torus: its residual must be below 1e-8, else refine it. Returns Twist. Ours. Raises
    InputError for a solution that is not refined; NoTwist where the amplitudes do not tell the
    actions.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> twist(symfpu.torus(Chain(8, beta=1), (1,), amplitudes={1: "0.01"}))
    Twist(N=8, beta=1, seeds=1, positive definite, smallest eigenvalue 0.0214..., ...)
    """
    by_angle = actions(solution)
    require_refined(solution, REFINED)
    digits = solution.digits if in_digits(solution) else None
    return Twist(
        chain=solution.chain,
        seeds=solution.seeds,
        frequencies=_rounded(solution.frequencies, digits),
        actions=_rounded(by_angle.values(), digits),
        matrix=_lambda(solution, digits),
        method="Newton",
        digits=digits,
    )


def _rounded(values: Iterable[Any], digits: int | None) -> Numbers:
    if digits is None:
        return np.array([float(x) for x in values])
    with MULTIPRECISION.context(digits):
        return with_digits(np.array([mpf(x) for x in values]), digits)


def _lambda(solution: Torus, digits: int | None) -> Numbers:
    """d omega / d I, of what both change by with the amplitudes."""
    try:
        if digits is None:
            by_shift, by_action = changes_by_newton(solution.in_doubles())
            return np.asarray(np.linalg.solve(by_action.T, by_shift.T).T)
        by_shift, by_action = changes_in_digits(solution)
        with MULTIPRECISION.context(digits):
            inverse = (mpmath.matrix(by_action.tolist()) ** -1).tolist()
            return with_digits(by_shift @ np.array(inverse, dtype=object), digits)
    except (np.linalg.LinAlgError, ZeroDivisionError) as failure:
        raise NoTwist("the actions do not change with the amplitudes") from failure


def is_refined(solution: Torus) -> bool:
    """Whether Newton's matrix at the solution is that of a torus."""
    return bool(solution.residual() <= REFINED)
