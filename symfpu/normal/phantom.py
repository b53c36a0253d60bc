"""Normal frequencies as series, from the recursion of the torus: a phantom seed.

A mode q that is no seed turns with sigma_q when it is moved by an infinitesimal amplitude. That is
the torus with one seed more, at A_q = 0: sigma_q is the frequency omega_q of its series there. To
leave A_q out exactly, the recursion (Eqs. moda, modb) is cut at its first power: it takes the
monomials with z_q, with conj z_q and with neither, three times those of the torus itself, in any
ring. The phantom seed comes first: nu of a symbol L_p(nu) has its place first, then those of D_0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import symengine as se

from symfpu.chain.chain import Chain, require_any_chain
from symfpu.chain.frequency_shift import frequency_shift_formula
from symfpu.chain.symbols import amplitude_symbol
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, Arithmetic, with_digits
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, exact, integer, order_of
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Table, joined
from symfpu.series.arguments import digits_of
from symfpu.series.divisors import SmallDivisor
from symfpu.series.fixed_point import fixed_point_series
from symfpu.series.lindstedt import series_of_waves
from symfpu.series.memory import check_size
from symfpu.series.monomials import monomial_space
from symfpu.series.recursion import named_series
from symfpu.series.rings import BY_NAME, RINGS
from symfpu.series.series import LindstedtSeries

Exponents = tuple[int, ...]


@public
@dataclass(frozen=True, eq=False)
class NormalFrequencySeries(Tabled):
    """sigma_q = Omega_q + sum mu^k sigma_q^(k)(A), a normal frequency by the torus' amplitudes.

    Made by `normal_frequency_series` and `solve_normal_frequency`; dimensionless. Ours.

    chain, seeds, mode, order : the model, D_0, q and K. frequencies : those in the divisors by
        mode, q among them, exact; none in universal form. digits : of coefficients that are mpf.
    coefficients : for each order 0 .. K, those of sigma^(k) without mu^k that are not zero, by
        exponents of the amplitudes (s,). smallest_divisors : of the recursion, ascending; their
        harmonics have q first, then the seeds.

    >>> from symfpu import Chain, normal_frequency_series
    >>> series = normal_frequency_series(Chain(N=4, beta=1), (1,), 3, 1)
    >>> series
    NormalFrequencySeries(N=4, beta=1, seeds=1, mode 3, order 1, 2 terms, universal)
    >>> series.correction(1).subs({"A1": 2, "Omega_1": 1})
    3*Omega_3
    >>> series.to_frame()[["order", "exponents"]]
       order exponents
    0      0         0
    1      1         2
    """

    not_kept = "make it again, or keep its table: to_frame()"

    chain: Chain
    seeds: tuple[int, ...]
    mode: int
    order: int
    frequencies: Mapping[int, Fraction]
    digits: int | None
    coefficients: tuple[Mapping[Exponents, Any], ...] = field(repr=False)
    smallest_divisors: tuple[SmallDivisor, ...] = field(repr=False)

    def __repr__(self) -> str:
        chain = self.chain.label
        listed = ",".join(map(str, self.seeds))
        count = sum(map(len, self.coefficients))
        found = (
            f"sigma_{self.mode}={float(self.sigma):.13g}" if self.numeric else "universal"
        )
        place = f"seeds={listed}, mode {self.mode}, order {self.order}"
        return f"NormalFrequencySeries({chain}, {place}, {counted(count, 'term')}, {found})"

    @property
    def numeric(self) -> bool:
        """Whether the coefficients are numbers."""
        return bool(self.frequencies)

    @property
    def omega(self) -> dict[int, Fraction]:
        """Those of `frequencies` that are of seeds; empty in universal form."""
        return {q: w for q, w in self.frequencies.items() if q != self.mode}

    @property
    def sigma(self) -> Any:
        """The normal frequency in the divisors: a float, or an mpf with digits.

        Where `solve_normal_frequency` made the series it is the solution.
        """
        self._require_numbers()
        value = self.frequencies[self.mode]
        with self._numbers.context(self.digits):
            found = self._numbers.number(value)
        return with_digits(found, self.digits)

    @property
    def _numbers(self) -> Arithmetic:
        return DOUBLES if self.digits is None else MULTIPRECISION

    def _require_numbers(self) -> None:
        if not self.numeric:
            advice = "give frequencies= to normal_frequency_series"
            raise InputError("series", "universal form", "a series of numbers", advice)

    def correction(self, order: int) -> Any:
        """sigma_q^(k), without mu^k, as a SymEngine expression in the amplitudes A{n}."""
        symbols = list(map(amplitude_symbol, self.seeds))
        terms = self.coefficients[self._order(order)].items()
        return se.Add(*(_term(c, e, symbols) for e, c in terms))

    def closed_shift(self) -> Any:
        """Its lowest terms, sigma_q - Omega_q with linear frequencies in the divisors, closed.

        A SymEngine expression in A{n} and Omega_{n}, mu included: `frequency_shift_formula` of
        the seeds and q at A_q = 0. Raises InputError on a ring, which has none.
        """
        formula = frequency_shift_formula(self.chain, (*self.seeds, self.mode))[self.mode]
        return se.expand(formula.subs({amplitude_symbol(self.mode): 0}))

    def _order(self, order: int) -> int:
        if order_of(order) > self.order:
            allowed = f"0..{self.order}, the series' order"
            raise InputError("order", order, allowed, "compute a longer series")
        return int(order)

    def terms(self, amplitudes: Mapping[int, Any]) -> list[Any]:
        """mu^k sigma_q^(k) of k = 0 .. order at amplitudes by seed; floats, or mpf with digits.

        Raises InputError for a series in universal form.
        """
        self._require_numbers()
        with self._numbers.context(self.digits):
            A = self._amplitudes(amplitudes)
            mu = self.chain.small_parameter(self._numbers)
            found = [mu**k * _sum(part, A) for k, part in enumerate(self.coefficients)]
        return [with_digits(value, self.digits) for value in found]

    def at(self, amplitudes: Mapping[int, Any]) -> Any:
        """The sum of `terms`: sigma_q at amplitudes by seed."""
        terms = self.terms(amplitudes)
        if self.digits is None:
            return float(np.sum(terms))
        with self._numbers.context(self.digits):
            total = mpmath.fsum(terms)
        return with_digits(total, self.digits)

    def _amplitudes(self, given: object) -> list[Any]:
        allowed = f"an amplitude for each of the seeds {self.seeds}"
        if not isinstance(given, Mapping) or set(given) != set(self.seeds):
            raise InputError("amplitudes", given, allowed, "write it as {seed: number}")
        try:
            return list(self._numbers.array([given[q] for q in self.seeds]))
        except (TypeError, ValueError) as error:
            raise InputError("amplitudes", given, allowed, "pass real numbers") from error

    def _table(self) -> Table:
        """One row for each coefficient, without mu^k."""
        rows = [(k, e, c) for k, p in enumerate(self.coefficients) for e, c in p.items()]
        orders, exponents, values = zip(*rows, strict=True)
        columns: dict[str, Any] = {"order": list(orders)}
        columns["exponents"] = list(map(joined, exponents))
        columns["coefficient"] = list(values)
        facts = {"mode": self.mode, "order": self.order, "digits": self.digits}
        return Table(columns, attributes(self, self.chain, seeds=self.seeds, **facts))


def _term(coefficient: Any, exponents: Exponents, symbols: Sequence[Any]) -> Any:
    powers = [x**n for x, n in zip(symbols, exponents, strict=True)]
    return se.Mul(se.sympify(coefficient), *powers)


def _sum(part: Mapping[Exponents, Any], amplitudes: Sequence[Any]) -> Any:
    total: Any = 0
    for exponents, coefficient in part.items():
        term = coefficient
        for x, n in zip(amplitudes, exponents, strict=True):
            term = term * x**n
        total = total + term
    return total


@public
def normal_frequency_series(
    chain: Chain,
    seeds: Sequence[int],
    mode: int,
    order: int,
    frequencies: Mapping[int, Number] | None = None,
    *,
    ring: str | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> NormalFrequencySeries:
    """The series of a normal frequency in the amplitudes of a torus, by a phantom seed.

    chain : of any potential, N a number; with fixed ends, or a ring, whose seeds are travelling
        waves. seeds : distinct modes D_0 of the torus. mode : q, none of them. order : K of the
        series, from 0 up.
    frequencies : omega of every seed and sigma of `mode`, by mode, exact numbers: those in the
        divisors; None gives the universal form with symbols L_p(nu), nu of q first, then of D_0.
        On a ring they have to be given, and coefficients are doubles.
    ring : 'float64', or in universal form 'symbolic' (expanded) or 'nested'. digits : of every
        coefficient, proved as in `lindstedt`; None for doubles.
    progress : called as (label, fraction done).

    Dimensionless. It is Eq. omeser of the torus with one seed more, exactly at A_q = 0, for about
    three times the coefficients and four times the products of the series of D_0.
    `solve_normal_frequency` finds the sigma that it is itself. Ours.
    Raises InputError, TooLarge, and ResonantDivisor where the frequency of the phantom seed is
    resonant with those of the others.

    >>> from symfpu import Chain, normal_frequency_series
    >>> omega = {1: "0.4", 2: "0.77"}
    >>> found = normal_frequency_series(Chain(N=8, alpha="0.3"), (1,), 2, 4, omega)
    >>> found.at({1: 0.1})
    0.765...
    """
    require_any_chain(chain)
    if chain.symbolic:
        advice = "put a number for N: chain.at(N=32); for all N see frequency_shift_formula"
        raise InputError("chain", "N a symbol", "a chain whose N is a number", advice)
    torus = tuple(sorted(chain.seeds_of(seeds)))
    phantom = _phantom(chain, torus, mode)
    top = order_of(order)
    chosen = None if frequencies is None else _chosen(frequencies, (phantom, *torus))
    if digits is not None and ring is not None:
        allowed = "none where digits are given"
        raise InputError("ring", ring, allowed, "leave one of them out")
    if chain.periodic:
        _require_doubles(chain, chosen, ring, digits)
    if digits is not None:
        digits = digits_of(digits)
    series = phantom_series(
        chain, torus, phantom, chosen, top, ring=ring, digits=digits, progress=progress
    )
    return of_phantom(series)


def _require_doubles(
    chain: Chain,
    frequencies: tuple[Fraction, ...] | None,
    ring: str | None,
    digits: int | None,
) -> None:
    """InputError for what series of travelling waves do not have."""
    advice = "take fixed ends: standing waves of the ring are theirs"
    if frequencies is None:
        allowed = "fixed ends for a series in universal form"
        given = "on a ring give frequencies=, a number for the mode and for each seed"
        raise InputError("chain", chain, allowed, f"{given}; or {advice}")
    if digits is not None:
        raise InputError("digits", digits, "none on a ring: doubles", advice)
    if ring not in (None, "float64"):
        raise InputError("ring", ring, "'float64' for waves of a ring", advice)


def _phantom(chain: Chain, seeds: tuple[int, ...], mode: object) -> int:
    normal = [q for q in chain.mode_numbers if q not in seeds]
    number = integer(mode, "mode", min(chain.mode_numbers))
    if number not in normal:
        allowed = f"a mode that is no seed, one of {normal}"
        raise InputError("mode", mode, allowed, "the seeds' own are frequency corrections")
    return number


def _chosen(
    frequencies: Mapping[int, Number], modes: tuple[int, ...]
) -> tuple[Fraction, ...]:
    given: object = frequencies
    if not isinstance(given, Mapping) or set(given) != set(modes):
        allowed = f"a number for the mode and for each seed, {modes}"
        raise InputError("frequencies", given, allowed, "write it as {mode: number}")
    found = tuple(exact(given[q], f"frequencies, {q}") for q in modes)
    for q, value in zip(modes, found, strict=True):
        if value <= 0:
            allowed = "positive numbers"
            raise InputError(f"frequencies, {q}", value, allowed, "near 2 sin(q pi/2N)")
    return found


def phantom_series(
    chain: Chain,
    seeds: tuple[int, ...],
    mode: int,
    frequencies: tuple[Fraction, ...] | None,
    order: int,
    *,
    ring: str | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> LindstedtSeries:
    """The series of (mode, *seeds) cut at the first power of the mode's amplitude.

    frequencies : in the order (mode, *seeds).
    """
    modes = (mode, *seeds)
    if chain.periodic and frequencies is not None:
        return series_of_waves(chain, modes, frequencies, order, progress, phantom=True)
    if digits is not None:
        return fixed_point_series(
            chain, modes, frequencies, order, digits, progress, phantom=True
        )
    name = ring or ("symbolic" if frequencies is None else "float64")
    if name not in BY_NAME:
        allowed = f"one of {', '.join(BY_NAME)}"
        raise InputError("ring", ring, allowed, "name a ring or leave it out")
    check_size(chain, modes, order, name, phantom=True)
    space = monomial_space(chain, modes, order, phantom=True)
    return named_series(RINGS[name], chain, space, frequencies, order, progress)


def of_phantom(series: LindstedtSeries) -> NormalFrequencySeries:
    """What a cut series says of the frequency of its first seed."""
    mode, *seeds = series.seeds
    parts = []
    for k in range(series.order + 1):
        exponents, values = series.frequency_coefficients(mode, k)
        rows = map(tuple, exponents[:, 1:].tolist())
        parts.append(dict(zip(rows, values.tolist(), strict=True)))
    return NormalFrequencySeries(
        chain=series.chain,
        seeds=tuple(seeds),
        mode=mode,
        order=series.order,
        frequencies=series.omega,
        digits=series.digits,
        coefficients=tuple(parts),
        smallest_divisors=series.smallest_divisors,
    )
