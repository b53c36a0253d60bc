"""A universal series with its divisors expanded in the amplitudes, over any field.

The program of the recursion (Eqs. moda, modb) runs on whatever its multipliers
L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2) are. Here they are power series in the squares of
the amplitudes, with linear frequencies to lowest order: so the frequencies become functions of the
amplitudes alone, and these give the closed formulas of `frequency_expansion` and Birkhoff's normal
form.

With kappa^2 = mu^(2/step) and y_i = kappa^2 (Omega_i A_i / 2)^2 every sum is in whole powers of y:
    omega_i^2 = Omega_i^2 (1 + sum W_i y^e).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from math import prod
from typing import Any

from symfpu.algebra.formulas import Multiplier, NodeTable
from symfpu.algebra.truncated import Truncated, variables
from symfpu.files.progress import Progress, unheard
from symfpu.series.series import LindstedtSeries

Columns = Mapping[tuple[int, ...], Mapping[int, Truncated]]


class ExpandedSeries:
    """A universal series, with Omega_q of its modes as elements of a field.

    linear : Omega of the seeds. squares : Omega_q^2 by mode. one : of the field.
    """

    def __init__(
        self,
        series: LindstedtSeries,
        linear: Sequence[Any],
        squares: Mapping[int, Any],
        one: Any,
    ) -> None:
        self.series, self.linear, self.squares, self.one = series, linear, squares, one

    def frequency_ratios(self, top: int, tell: Progress = unheard) -> list[Truncated]:
        """omega_i / Omega_i as power series in y, cut at a degree of 1 or more.

        tell : called as (label, fraction done).
        """
        step, rest = self.series.chain.degree_step, [self.one * 0 for _ in self.linear]
        ratios = [x * 0 + self.one for x in variables(rest, top, self.one)]
        # the recursion's divisors hold the frequencies: each pass is right to one degree more
        for known in range(1, top + 1):
            tell("frequencies", (known - 1) / top)
            pairs = zip(ratios, self.linear, strict=True)
            omega = [ratio.cut(known) * linear for ratio, linear in pairs]
            y = variables(rest, known, self.one)
            corrections = self._corrections(omega, y, 2 * known // step)
            ratios = [(w + self.one).root() for w in corrections]
        return ratios

    def _corrections(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], order: int
    ) -> list[Truncated]:
        """The sums of W_i y^e of orders 1 .. k by seed, with the divisors of omega."""
        sums = [y[0] * 0 for _ in self.linear]
        for k in range(1, order + 1):
            table, rows = self.series.corrections[k], self._diagonal(k)
            if not rows:
                continue
            # y^e vanishes at rest: its factor is needed to fewer degrees
            shorter = [w.cut(y[0].top - sum(rows[0])) for w in omega]
            values = self._values(table, shorter)
            for row, line in zip(rows, values, strict=True):
                monomial = monomial_of(y, row)
                for i, value in enumerate(line):
                    if value:
                        sums[i] = sums[i] + monomial * _as_long(value, y[0].top)
        return sums

    def _diagonal(self, k: int) -> list[list[int]]:
        degree = self.series.chain.degree_step * k
        rows: list[list[int]] = self.series.grading.diagonal(degree).tolist()
        return rows if len(self.series.corrections[k]) else []

    def coordinates(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], order: int
    ) -> Columns:
        """u_q[nu] / y^(|nu|/2) by harmonic that is not 0, one of each pair, and mode.

        To the degrees that the product with y^|nu| leaves.
        """
        found: dict[tuple[int, ...], dict[int, Truncated]] = {}
        for k in range(order + 1):
            for nu, row, line in self._lines(omega, y, k):
                columns = found.setdefault(nu, {})
                for q, value in zip(self.series.modes, line, strict=True):
                    if value:
                        term = monomial_of(y, row) * _as_long(value, y[0].top)
                        columns[q] = columns[q] + term if q in columns else y[0] * 0 + term
        return found

    def _lines(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], k: int
    ) -> Iterator[tuple[tuple[int, ...], list[int], Any]]:
        """Harmonic, exponents and values by mode of the rows of an order that are needed."""
        rows, needed = list(self._rows(k)), []
        for place, (nu, row) in enumerate(rows):
            # y^|nu| and the exponents vanish at rest: their factor is needed to fewer degrees
            left = y[0].top - sum(map(abs, nu)) - sum(row)
            if any(nu) and left >= 0:
                needed.append((left, place))
        if not needed:
            return
        shorter = [w.cut(max(needed)[0]) for w in omega]
        places = [place for _, place in needed]
        table = self.series.coordinates[k].rows(places)
        for place, line in zip(places, self._values(table, shorter), strict=True):
            yield *rows[place], line

    def _rows(self, k: int) -> Iterator[tuple[tuple[int, ...], list[int]]]:
        """Harmonic, and exponents of y beyond y^(|nu|/2), of the rows of a table of coordinates."""
        grading, degree = self.series.grading, self.series.degree(k)
        harmonics, index = grading.harmonics(degree)
        nu = harmonics[index]
        beyond = (grading.powers(degree) - abs(nu)) // 2
        for row, exponents in zip(nu.tolist(), beyond.tolist(), strict=True):
            yield tuple(row), exponents

    def _values(self, table: NodeTable, omega: Sequence[Truncated]) -> Any:
        def coupling(value: Fraction) -> Truncated:
            number = self.one * value.numerator / value.denominator
            constant: Truncated = omega[0] * 0 + number
            return constant

        return table.values(partial(self.multiplier, omega=omega), coupling)

    def multiplier(self, symbol: Multiplier, omega: Sequence[Truncated]) -> Truncated:
        """L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2)."""
        parts = [w * n for w, n in zip(omega, symbol.harmonic, strict=True)]
        drive = sum(parts, start=omega[0] * 0)
        own = self.squares[symbol.mode]
        base = omega[0] * 0 + own
        if symbol.mode in self.series.seeds:
            chosen = omega[self.series.seeds.index(symbol.mode)]
            base = chosen * chosen
        multiplier: Truncated = (base - drive * drive).inverse() * own
        return multiplier


def driven_modes(series: LindstedtSeries) -> list[int]:
    """All modes that the coefficients of a universal series speak of, the seeds first."""
    program = series.node_tables()[0].program
    named = {s.mode for s in program.symbols if isinstance(s, Multiplier)}
    others = sorted(named - set(series.seeds), key=lambda q: (q < 0, q))
    return [*series.seeds, *others]


def _as_long(value: Any, top: int) -> Any:
    """A series up to a degree; a number as it is."""
    return value.cut(top) if isinstance(value, Truncated) else value


def monomial_of(y: Sequence[Truncated], exponents: Sequence[int]) -> Any:
    """The product of powers of the variables; the integer 1 where there are none."""
    powers = [x for x, n in zip(y, exponents, strict=True) for _ in range(n)]
    return prod(powers[1:], start=powers[0]) if powers else 1
