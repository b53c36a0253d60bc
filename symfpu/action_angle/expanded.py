"""A universal series evaluated in power series cut at a degree, over any field.

The program of the recursion (Eqs. moda, modb) runs on whatever its multipliers
L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2) are. Here they are power series: in the amplitudes,
which gives Birkhoff's normal form, or cut at degree 1, which gives derivatives.

With kappa^2 = mu^(2/step) and y_i = kappa^2 (Omega_i A_i / 2)^2 every sum is in whole powers of y:
    omega_i^2 = Omega_i^2 (1 + sum W_i y^e),
    kappa^2 I_i = sum over q and nu of 2 nu_i (nu.omega) / Omega_q^2 y^|nu| (sum u_q[nu] y^e)^2.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from math import prod
from typing import Any

from symfpu.algebra.formulas import Multiplier, NodeTable
from symfpu.algebra.truncated import Truncated
from symfpu.series.all_lengths import SeriesForAllN
from symfpu.series.series import LindstedtSeries

Columns = Mapping[tuple[int, ...], list[Truncated]]


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

    @property
    def modes(self) -> Sequence[int]:
        """Those of the columns of coordinates."""
        series = self.series
        return (
            series.modes if isinstance(series, SeriesForAllN) else series.chain.mode_numbers
        )

    def squared_frequencies(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], order: int
    ) -> list[list[Truncated]]:
        """The terms Omega_i^2 W_i^(k) of orders 1 .. k, by order and seed, divisors of omega."""
        found = []
        for k in range(1, order + 1):
            table, rows = self.series.corrections[k], self._diagonal(k)
            # y^e vanishes at rest where it is a variable: its factor is needed to fewer degrees
            needed = y[0].top - (sum(rows[0]) if rows and not y[0].parts[0] else 0)
            shorter = [w.cut(needed) for w in omega]
            values: Any = self._values(table, shorter) if rows else None
            sums = [y[0] * 0 for _ in self.linear]
            for number, row in enumerate(rows):
                monomial = _monomial(y, row)
                for i in range(len(sums)):
                    value = values[number, i]
                    if value:
                        sums[i] = sums[i] + monomial * _as_long(value, y[0].top)
            squares = [x * x for x in self.linear]
            found.append([part * w for part, w in zip(sums, squares, strict=True)])
        return found

    def _diagonal(self, k: int) -> list[list[int]]:
        degree = self.series.chain.degree_step * k
        rows: list[list[int]] = self.series.grading.diagonal(degree).tolist()
        return rows if len(self.series.corrections[k]) else []

    def scaled_actions(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], order: int
    ) -> list[Truncated]:
        """kappa^2 I_i of the coordinates cut at an order."""
        found = [y[0] * 0 for _ in self.linear]
        for nu, columns in self._coordinates(omega, y, order).items():
            rate = sum((w * n for w, n in zip(omega, nu, strict=True)), start=y[0] * 0)
            total = y[0] * 0
            for q, column in zip(self.modes, columns, strict=True):
                if column:
                    total = total + column * column * (1 / self.squares[q])
            weight = total * rate * _monomial(y, [abs(n) for n in nu])
            for i, n in enumerate(nu):
                if n:
                    found[i] = found[i] + weight * (2 * n)
        return found

    def _coordinates(
        self, omega: Sequence[Truncated], y: Sequence[Truncated], order: int
    ) -> Columns:
        """u_q[nu] / y^(|nu|/2) by harmonic that is not 0, one of each pair, and mode."""
        found: dict[tuple[int, ...], list[Truncated]] = {}
        for k in range(order + 1):
            values = self._values(self.series.coordinates[k], omega)
            for (nu, row), line in zip(self._rows(k), values, strict=True):
                if not any(nu):
                    continue
                columns = found.setdefault(nu, [y[0] * 0 for _ in self.modes])
                monomial = _monomial(y, row)
                for place, value in enumerate(line):
                    if value:
                        columns[place] = columns[place] + monomial * value
        return found

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


def _as_long(value: Any, top: int) -> Any:
    """A series up to a degree; a number as it is."""
    return value.cut(top) if isinstance(value, Truncated) else value


def _monomial(y: Sequence[Truncated], exponents: Sequence[int]) -> Any:
    """The product of powers of the variables; the integer 1 where there are none."""
    powers = [x for x, n in zip(y, exponents, strict=True) for _ in range(n)]
    return prod(powers[1:], start=powers[0]) if powers else 1
