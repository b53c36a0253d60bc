"""The frequencies as functions of the amplitudes alone, in closed form.

The paper's omega_q^(k) have the chosen frequencies in their divisors. Put omega = Omega + ... into
them again and again, and the divisors have linear frequencies: what is left is the expansion of
classical perturbation theory, the derivatives of Birkhoff's normal form. With x_i = q_i pi / 2N
and the mode m of a signed sum j.q of the seeds, Omega_m^2 = 2 - 2 cos(2 j.x) for every m, folded
or not. So each coefficient is a rational function of Omega_1 = 2 sin x_1, Omega_2 = 2 sin x_2 and
    rho = sin 2x_1 sin 2x_2,    rho^2 = W_1 W_2 (4 - W_1)(4 - W_2) / 16,    W_i = Omega_i^2,
exactly. rho and odd powers of Omega_1 Omega_2 drop out for seeds in general position, because the
modes of j and of j with one sign changed come with the same harmonics.

Two seeds are special at order k where a signed sum j.q of as many seeds as the degree is, and no
sum for all seeds, is a multiple of N, so that its mode is missing, or the seed of the secular
harmonic: then the chain's own recursion is taken. Else the formula of seeds in general position
is right, also where the modes of two different j coincide: with linear frequencies in all
divisors each mode is driven linearly.

Special seeds obey a relation j.q = wN, so one angle is left: q_i = w_i N + m_i g, and with
u = g pi/2N every frequency is a polynomial in 2 sin u and 2 cos u. Both signs of a frequency give
the same motion, so omega_q / Omega_q is a rational function of (2 sin u)^2 = Omega_g^2 alone.
Ours; at lowest order it is `frequency_shift_formula`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from itertools import count, product
from math import prod
from typing import Any, NamedTuple

import numpy as np
import symengine as se

from symfpu.algebra.quotients import expression_of, quotient_field
from symfpu.algebra.selection import fold
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.length import label_entry, mode_label, mode_of
from symfpu.chain.symbols import amplitude_symbol, linear_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import order_of
from symfpu.series.all_lengths import SeriesForAllN, reach
from symfpu.series.expanded import ExpandedSeries, driven_modes
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries

MOST_SEEDS = 2


@public
def frequency_expansion(
    chain: Chain, seeds: Sequence[int | str], q: int | str, order: int
) -> Any:
    """omega_q^(k) with linear frequencies in all divisors, as a closed formula, without mu^k.

    omega_q = Omega_q + sum_k mu^k omega_q^(k)(A), dimensionless: the frequency as a function of
    the amplitudes alone, as Eq. omeser gives it when its divisors are expanded too. For the alpha
    model k = 2 and 4 are the first corrections, for beta k = 1 and 2.

    chain : of any potential; any N, or "N" for all large ones. seeds : one or two modes D_0.
    q : one of them. order : k, from 0 up.

    Returns a SymEngine expression in A_q and Omega_q of the seeds, a polynomial in the squares of
    the amplitudes with rational functions of Omega_q^2 in front. Two seeds in special position,
    such as (1, 2), (1, 3) or (1, "N-1"), have rational functions of one Omega_g^2: g is their
    greatest common divisor, or the mode that both are multiples of when multiples of N are left
    out.
    It has no value where linear frequencies of the chain resonate. Differs from the paper's
    omega_q^(k), whose divisors hold the chosen frequencies: that is
    `LindstedtSeries.frequency_correction`. Ours.
    Raises InputError for more seeds, modes outside the chain, or an order below 0.

    >>> frequency_expansion(Chain("N", alpha=1), (1,), 1, 2)
    (1/4)*A1**2*(4*Omega_1 - 3*Omega_1**3)
    >>> frequency_expansion(Chain(N=32, beta=1), (5,), 5, 1)
    (9/8)*A5**2*Omega_5**3
    >>> frequency_expansion(Chain("N", alpha=1), (1, "N-1"), 1, 2)
    (1/4)*A1**2*(4 - 3*Omega_1**2)*Omega_1 + (1/2)*(-4 + Omega_1**2)*Omega_1*A_{N-1}**2
    """
    require_chain(chain)
    order = order_of(order)
    start = lindstedt(chain, seeds, order=0, ring="nested")
    if len(start.seeds) > MOST_SEEDS:
        allowed = f"at most {MOST_SEEDS} for a closed form"
        raise InputError(
            "seeds", start.seeds, allowed, "see LindstedtSeries.frequency_correction"
        )
    place = start.seeds.index(_seed(start, q))
    if order == 0:
        return linear_symbol(start.seeds[place])
    degree = chain.degree_step * order
    N, modes = _representative(start, order)
    if not _is_special(N, modes, degree):
        apart = (1, 2 * degree + 1)[: len(modes)]
        every = Chain("N", potential=chain.potential)
        series = lindstedt(every, apart, order=order, ring="nested")
        return _Closed(series, start.seeds).formula(place, order)
    written = [label_entry(label) for label in start.seeds]
    series = lindstedt(chain, written, order=order, ring="nested")
    if len(modes) == 1:
        return _Closed(series, start.seeds).formula(place, order)
    relation = _relation(chain, start.seeds)
    return _OnOneAngle(series, start.seeds, relation).formula(place, order)


def _seed(series: LindstedtSeries, q: int | str) -> int:
    """A seed as the series has it; InputError for what is none."""
    label = mode_label(q, "q")
    if label not in series.seeds:
        allowed = f"a seed, one of {series.seeds}"
        raise InputError("q", q, allowed, "only seeds have frequency corrections")
    return label


def _representative(series: LindstedtSeries, order: int) -> tuple[int, tuple[int, ...]]:
    """N, or a large one, and the seeds as modes of that chain."""
    chain = series.chain
    N = chain.N
    if chain.symbolic:
        N = 1 + sum(reach(chain.degree_step, series.seeds, order))
    return N, tuple(mode_of(q, N) for q in series.seeds)


def _is_special(N: int, modes: Sequence[int], degree: int) -> bool:
    """Whether a signed sum of special seeds is no mode, or a seed, where for others it is not.

    j.q = 0 modulo N with j other than 0; or j.q = +-q_i modulo 2N where j has the parities of e_i
    and is not +-e_i, so that its mode can carry the secular harmonic of q_i.
    """
    units = np.eye(len(modes), dtype=np.int64)
    for j in product(range(-degree, degree + 1), repeat=len(modes)):
        if not 0 < sum(map(abs, j)) <= degree:
            continue
        total = sum(n * q for n, q in zip(j, modes, strict=True))
        if total % N == 0:
            return True
        for unit, q in zip(units, modes, strict=True):
            secular = fold(total, N) == q and not ((unit - j) % 2).any()
            if secular and (np.abs(j) != unit).any():
                return True
    return False


class _Relation(NamedTuple):
    """Two seeds as q_i = w_i N + m_i g: turns w, multiples m, and the mode g."""

    turns: tuple[int, int]
    multiples: tuple[int, int]
    mode: int

    def of(self, j: Sequence[int]) -> tuple[int, int]:
        """w and m of j.q."""
        turns = sum(n * w for n, w in zip(j, self.turns, strict=True))
        return turns, sum(n * m for n, m in zip(j, self.multiples, strict=True))


def _relation(chain: Chain, seeds: Sequence[int]) -> _Relation:
    """The shortest that binds two seeds: j.q is a multiple of N, j without a common divisor."""
    first, second = map(int, seeds)
    if chain.symbolic:
        g = math.gcd(first, second)
        return _Relation((first < 0, second < 0), (first // g, second // g), g)
    for size in count(2):
        for a in range(1, size):
            for j in ((a, size - a), (a, a - size)):
                turns, rest = divmod(j[0] * first + j[1] * second, chain.N)
                if math.gcd(*j) == 1 and not rest:
                    return _bound(chain.N, first, j, turns)
    raise AssertionError("(q_2, -q_1) over their common divisor is one")


def _bound(N: int, first: int, j: tuple[int, int], turns: int) -> _Relation:
    """The relation of q_1 and q_2 with a q_1 + b q_2 = turns N, where (a, b) = j is primitive."""
    a, b = j
    pairs = [(w, (turns - a * w) // b) for w in range(-abs(b), abs(b) + 1)]
    w, v = min((p for p in pairs if a * p[0] + b * p[1] == turns), key=_size)
    # (q_1, q_2) - N (w, v) is a multiple of (b, -a)
    g, sign = (first - w * N) // b, 1
    if g < 0:
        g, sign = -g, -1
    return _Relation((w, v), (sign * b, -sign * a), fold(g, N))


def _size(numbers: Sequence[int]) -> int:
    return sum(map(abs, numbers))


class _Element:
    """a + b rho over a field of rational functions."""

    __slots__ = ("a", "b", "square")

    def __init__(self, a: Any, b: Any, square: Any) -> None:
        self.a, self.b, self.square = a, b, square

    def __bool__(self) -> bool:
        return bool(self.a) or bool(self.b)

    def _with(self, a: Any, b: Any) -> _Element:
        return _Element(a, b, self.square)

    def __add__(self, other: Any) -> _Element:
        if isinstance(other, _Element):
            return self._with(self.a + other.a, self.b + other.b)
        return self._with(self.a + other, self.b)

    __radd__ = __add__

    def __neg__(self) -> _Element:
        return self._with(-self.a, -self.b)

    def __sub__(self, other: Any) -> _Element:
        return self.__add__(-other)

    def __mul__(self, other: Any) -> _Element:
        if not isinstance(other, _Element):
            return self._with(self.a * other, self.b * other)
        if not self.b and not other.b:
            return self._with(self.a * other.a, self.b)
        a = self.a * other.a + self.b * other.b * self.square
        return self._with(a, self.a * other.b + self.b * other.a)

    __rmul__ = __mul__

    def __truediv__(self, number: int) -> _Element:
        return self._with(self.a / number, self.b / number)

    def __rtruediv__(self, number: int) -> _Element:
        norm = self.a * self.a
        if self.b:
            norm = norm - self.b * self.b * self.square
        return self._with(number * self.a / norm, -number * self.b / norm)


class _Frequencies(ABC):
    """Linear frequencies of a universal series over a field that subclasses choose.

    series : universal. names : of its seeds in the formula. one : of the field. linear : Omega_q
    of the seeds.
    """

    one: Any
    linear: Sequence[Any]

    def __init__(self, series: LindstedtSeries, names: Sequence[int]) -> None:
        self.series, self.names = series, names

    @abstractmethod
    def linear_square(self, q: int) -> Any:
        """Omega_q^2 of any mode."""

    @abstractmethod
    def expression(self, value: Any, place: int) -> Any:
        """An element of the field times Omega_q of a seed, as an expression."""

    def formula(self, place: int, order: int) -> Any:
        """omega^(k) of a seed as an expression."""
        top, odd = divmod(order * self.series.chain.degree_step, 2)
        if odd:
            return se.Integer(0)
        squares = {q: self.linear_square(q) for q in driven_modes(self.series)}
        expanded = ExpandedSeries(self.series, self.linear, squares, self.one)
        ratio = expanded.frequency_ratios(top)[place]
        terms = [self._term(e, c, place) for e, c in ratio.parts[top].items()]
        return se.Add(*terms)

    def _term(self, exponents: Sequence[int], value: Any, place: int) -> Any:
        """c y^e Omega_q without mu, y_i = (Omega_i A_i / 2)^2."""
        amplitudes = [se.Integer(1)]
        for e, q, linear in zip(exponents, self.names, self.linear, strict=True):
            value = prod([linear * linear / 4] * e, start=value)
            amplitudes.append(amplitude_symbol(q) ** (2 * e))
        return self.expression(value, place) * se.Mul(*amplitudes)


class _Closed(_Frequencies):
    """Over the rational functions of Omega_1, Omega_2, and rho."""

    def __init__(self, series: LindstedtSeries, names: Sequence[int]) -> None:
        super().__init__(series, names)
        frequencies = quotient_field([f"Omega_{i}" for i in range(len(names))])
        self._zero, self._unit = frequencies[0] * 0, frequencies[0] * 0 + 1
        squares = [x * x for x in frequencies]
        sines = [w * (4 - w) / 4 for w in squares]  # squared, of twice the angles
        self._square_of_rho = prod(sines, start=self._unit)
        self._cosines = [_chebyshev(1 - w / 2, self.degree) for w in squares]
        self.one = self._element(self._unit, self._zero)
        self.linear = [self.one * x for x in frequencies]
        self._sums = _signed_sums(series)

    @property
    def degree(self) -> int:
        """Of the longest products of seeds."""
        return self.series.degree(self.series.order)

    def _element(self, a: Any, b: Any) -> _Element:
        return _Element(a, b, self._square_of_rho)

    def linear_square(self, q: int) -> _Element:
        """Omega_q^2 = 2 - 2 cos(2 j.x)."""
        j = self._sums[q]
        cosine, second = self._unit, []
        for (first_kind, second_kind), n in zip(self._cosines, j, strict=True):
            cosine = cosine * first_kind[abs(n)]
            kind = second_kind[abs(n) - 1] if n else self._zero
            second.append(kind if n >= 0 else -kind)
        sines = prod(second) if len(second) == MOST_SEEDS else self._zero
        return self._element(2 - 2 * cosine, 2 * sines)

    def expression(self, value: _Element, place: int) -> Any:
        """In the symbols Omega_q; rho is Omega_1 Omega_2 sqrt(4 - W_1) sqrt(4 - W_2) / 4."""
        linear, scaled = list(map(linear_symbol, self.names)), value * self.linear[place]
        first, second = (_rational(part, linear) for part in (scaled.a, scaled.b))
        rho = se.Mul(*linear, *(se.sqrt(4 - x**2) for x in linear)) / 4
        return first + second * rho


class _OnOneAngle(_Frequencies):
    """Over the rational functions of 2 sin u and 2 cos u: seeds that obey a relation."""

    def __init__(
        self, series: LindstedtSeries, names: Sequence[int], relation: _Relation
    ) -> None:
        super().__init__(series, names)
        self.relation, self._sums = relation, _signed_sums(series)
        (sine,) = quotient_field(["sine"])
        zero, unit = sine * 0, sine * 0 + 1
        self._square = 4 - sine * sine
        self.one = self._element(unit, zero)
        highest = 2 * series.degree(series.order) * max(map(abs, relation.multiples))
        cosine = self._element(zero, unit)
        self._sines = _multiples(self.one * 0, self._element(sine, zero), cosine, highest)
        self._cosines = _multiples(self.one * 2, cosine, cosine, highest)
        pairs = zip(relation.turns, relation.multiples, strict=True)
        self.linear = [self._frequency(w, m) for w, m in pairs]

    def _element(self, a: Any, b: Any) -> _Element:
        return _Element(a, b, self._square)

    def _frequency(self, turns: int, multiple: int) -> _Element:
        """2 sin(w pi/2 + m u)."""
        n = abs(multiple)
        value = self._cosines[n]
        if turns % 2 == 0:
            value = self._sines[n] if multiple > 0 else -self._sines[n]
        return value if turns % 4 < 2 else -value

    def linear_square(self, q: int) -> _Element:
        """Omega_m^2 = 2 - 2 cos(w pi + 2 m u)."""
        turns, multiple = self.relation.of(self._sums[q])
        cosine = self._cosines[2 * abs(multiple)]
        return 2 + (cosine if turns % 2 else -cosine)

    def expression(self, value: _Element, place: int) -> Any:
        """Omega_q times a rational function of Omega_g."""
        assert not value.b, "both signs of the cosine give the same motion"
        front = linear_symbol(self.names[place])
        return front * _rational(value.a, [linear_symbol(self.relation.mode)])


def _multiples(
    zeroth: _Element, first: _Element, cosine: _Element, highest: int
) -> list[_Element]:
    """f_0 .. f_highest with f_(n+1) = 2 cos u f_n - f_(n-1)."""
    found = [zeroth, first]
    for _ in range(highest - 1):
        found.append(cosine * found[-1] - found[-2])
    return found


def _signed_sums(series: LindstedtSeries) -> dict[int, tuple[int, ...]]:
    """For each mode j with j.q that mode: the shortest."""
    degree = series.degree(series.order)
    N = series.valid_from if isinstance(series, SeriesForAllN) else series.chain.N
    numbers = [mode_of(q, N) for q in series.seeds]
    found: dict[int, tuple[int, ...]] = {}
    span = range(-degree, degree + 1)
    for j in sorted(product(span, repeat=len(numbers)), key=_size):
        if _size(j) <= degree:
            total = sum(n * m for n, m in zip(j, numbers, strict=True))
            found.setdefault(fold(total, N), j)
    return {q: found[mode_of(q, N)] for q in series.modes if mode_of(q, N) in found}


def _chebyshev(c: Any, degree: int) -> tuple[list[Any], list[Any]]:
    """T_0 .. T_degree and U_0 .. U_degree at c."""
    first, second = [c * 0 + 1, c], [c * 0 + 1, 2 * c]
    for _ in range(degree):
        first.append(2 * c * first[-1] - first[-2])
        second.append(2 * c * second[-1] - second[-2])
    return first, second


def _rational(value: Any, symbols: Sequence[Any]) -> Any:
    """A rational function as an expression."""
    top, bottom = (expression_of(part, symbols) for part in (value.top, value.bottom))
    return top / bottom
