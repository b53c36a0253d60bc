"""What a coefficient ring must offer to the recursion.

A ring keeps a power series u_1, ..., u_(N-1) in the seed variables w_i, conj w_i, degree by
degree, and multiplies it on the N bonds. "Modes" is an array with one row for each canonical
monomial of a degree and one column for each mode; "Bonds" are the same functions in whatever form
the ring multiplies best (values on the bonds, or coefficients of cosines). The product is f o g =
2 f g, which keeps integer coefficients integers: sum_lm B_qlm u_l u_m is the cosine coefficient q
of c o c, and the cubic sum with C that of (c o c) o c.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Protocol

from symfpu.algebra.selection import Modes

Parts = Sequence[tuple[Any, Any]]  # (coefficient, bonds)


class Ring(Protocol):
    """Coefficients, storage and products of one series.

    Degrees are put in ascending order, each once. grows : whether it is a GrowingRing.
    """

    name: str
    grows: bool

    @property
    def space(self) -> Modes:
        """The modes and monomials of its tables."""

    @property
    def multiply_adds(self) -> int:
        """Multiply-adds of all products so far; 0 where they are not counted."""

    def coupling(self, power: int, value: Fraction) -> Any:
        """The coupling of the force r^power, relative to that of the lowest, as an element."""

    def seed_terms(self) -> Any:
        """Modes of degree 1: u_q = w_q + conj w_q for the seeds."""

    def put(self, degree: int, modes: Any) -> None:
        """Store the modes of a degree and make them available to products."""

    def power(self, power: int, degree: int) -> Any:
        """Bonds of sum (c o c) o ...

        O c, `power` factors from 2 up, over all stored degrees with this sum.
        """

    def project(self, degree: int, parts: Parts) -> Any:
        """Modes of sum coefficient * bonds, selection rules applied.

        Parts are pairs (coefficient, bonds).
        """

    def secular(self, degree: int, modes: Any) -> Any:
        """What stands at nu = e_q in seed mode q, divided by w_q: rows of
        `grading.diagonal(degree - 1)`, a column a seed.
        """

    def correct(self, degree: int, corrections: Any) -> None:
        """Store the frequency corrections W_q of an even degree."""

    def corrected(self, degree: int) -> Any:
        """Sum W_q u_q over all stored pairs of degrees.

        A row for each canonical monomial, a column for each seed.
        """

    def solve(self, degree: int, corrected: Any, force: Any, multipliers: Any) -> Any:
        """Modes L (corrected - force), which may overwrite force.

        Multipliers has a row a harmonic and a column a mode.
        """

    def results(self) -> tuple[list[Any], list[Any], Fraction]:
        """Modes and corrections of all degrees, and the unit by which degree d was scaled:
        unit^-(d - 1).
        """


class GrowingRing(Ring, Protocol):
    """A ring that divides by whole numbers, and solves differential equations in the stretch.

    Exactly, or with a rounding that it bounds.
    """

    def number(self, value: Fraction) -> Any:
        """An exact number as an element."""

    def growth(self, number: int, slope: Fraction, rate: Fraction, degree: int) -> Any:
        """Bonds of what the lower degrees give to degree d of g, (1 + slope r) g' = rate g.

        number : which of several such functions, from 0 up. With r = 2c, c the stored function on
        the bonds, this is 1/d sum (rate j - slope (d - j)) c_j o g_(d-j) over 0 < j < d; the rest
        of g_d is 2 rate c_d.
        """
