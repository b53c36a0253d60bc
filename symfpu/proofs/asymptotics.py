"""Long chains: what terms, divisors and energies become for N to infinity at fixed seeds.

With linear frequencies everything depends on N through x = pi/2N alone, and L_q(nu) is a quotient
of power series in y = x^2 with rational coefficients:
    Omega_m^2 / 4y = (sin mx / x)^2 = m^2 - y m^4/3 + ...,  nu.Omega / 2x = sum nu_i sin(q_i x)/x.
Where m = nu.q the divisor begins with y: almost resonant, Appendix E. So the nodes of the
universal series are Laurent series in y, exactly. At fixed seeds and modes this is the expansion
in small kappa = q/N, too.

Averages over time take the harmonics of a term apart, as for incommensurable frequencies.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import reduce
from itertools import product
from math import factorial
from operator import mul
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.formulas import Coupling, Multiplier
from symfpu.algebra.program_values import ancestors, values_in
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.length import HighMode, seed_labels
from symfpu.chain.propagation import excitation_sequence
from symfpu.chain.symbols import amplitude_symbol, phase_symbol
from symfpu.errors import InputError
from symfpu.numbers.typed import integer, rational
from symfpu.series.all_lengths import SeriesForAllN
from symfpu.series.lindstedt import lindstedt
from symfpu.series.power_series import PowerSeries

GUARD = 2  # powers of y beyond those asked for, at first
MOST = 64  # powers of y after which a term counts as zero


def asymptotic_divisor(
    mode: int,
    seeds: Sequence[int],
    harmonic: Sequence[int],
    *,
    terms: int = 2,
    squared: bool = True,
) -> Any:
    """Omega_m^2 - (nu.Omega)^2 of a long chain, as the first terms in 1/N.

    mode : m. seeds : modes from the start of the spectrum. harmonic : nu, one integer for each
        seed. terms : how many. squared : False for Omega_m - |nu.Omega|, the detuning of Appendix
        E, approximation iii. All is dimensionless.

    Returns a SymEngine expression in N; 0 where both frequencies are the same for every N. Almost
    resonant divisors, m = |nu.q|, fall as N^-4, others as N^-2. Differs from Appendix E, whose
    pi^3 m^3 / 24 N^3 lacks the factor 1 - sum_i nu_i q_i^3 / m^3.
    Raises InputError for modes counted from the end, and numbers that are none.

    >>> asymptotic_divisor(2, (1,), (2,), terms=1, squared=False)
    (-1/4)*pi**3/N**3
    >>> asymptotic_divisor(2, (1,), (2,), terms=1)
    -pi**4/N**4
    """
    labels, m = _low(seeds), integer(mode, "mode", 1)
    count = integer(terms, "terms", 1)
    nu = [integer(n, "harmonic", -(10**6)) for n in harmonic]
    if len(nu) != len(labels):
        allowed = f"one integer for each of the seeds {labels}"
        raise InputError("harmonic", tuple(nu), allowed, "add or drop some")

    def expanded(length: int) -> list[Laurent]:
        own, drive = _sine(m, length), _drive(labels, nu, length)
        if squared:
            return [(own * own + drive * drive * -1) * 4]
        sign = -1 if drive.leads_below_zero() else 1
        return [(own + drive * -sign) * 2]

    (found,) = _leading(expanded, count)
    # x^2 or x have been left out
    x = se.pi / (2 * se.Symbol("N"))
    return se.expand(found * (x**2 if squared else x))


def asymptotic_term(series: SeriesForAllN, q: int, order: int, *, terms: int = 2) -> Any:
    """Q_q^(k) of a long chain at fixed amplitudes, as the first terms in 1/N.

    Without mu^k, with linear frequencies in all divisors (Eqs. moda, modb, Lm).

    series : `lindstedt` of a chain whose N is a symbol, with seeds from the start of the
        spectrum. q, order : mode and k. terms : powers of 1/N^2 kept, counted from the leading one
        of the whole term. All is dimensionless, phases theta in radians.

    Returns a SymEngine expression in N, A_i and theta_i; 0 for a term that vanishes.
    Raises InputError for other series, modes or orders.

    >>> series = lindstedt(Chain("N", alpha=1), (1,), order=1)
    >>> asymptotic_term(series, 2, 1, terms=1)
    N*A1**2*cos(2*theta1)/pi
    """
    seeds = _series(series)
    count = integer(terms, "terms", 1)
    column, degree = series._mode(q) - 1, series.degree(order)
    nodes = series.coordinates[order].nodes[:, [column]]
    powers = series.grading.powers(degree).tolist()
    harmonics = _harmonics(series, degree)

    def expanded(length: int) -> list[Laurent]:
        inverse, found = _sine(int(q), length).inverse(), []
        for value, row in zip(_values(series, nodes, length), powers, strict=True):
            seeds_part = _product(
                _sine(p, length) for p, e in zip(seeds, row, strict=True) for _ in range(e)
            )
            found.append(value * seeds_part * inverse)
        return found

    # w_i = Omega_i A_i / 2 is x A_i (sin q_i x / x), and Omega_q is 2x (sin qx / x)
    total, x = se.Integer(0), se.pi / (2 * se.Symbol("N"))
    for value, row, nu in zip(_leading(expanded, count), powers, harmonics, strict=True):
        amplitudes = [amplitude_symbol(p) ** e for p, e in zip(seeds, row, strict=True)]
        angle = se.Add(*(n * phase_symbol(p) for n, p in zip(nu, seeds, strict=True)))
        pair = se.Integer(2 if any(nu) else 1) / 2
        total += pair * value * se.Mul(*amplitudes) * se.cos(angle)
    return se.expand(total * x ** (degree - 1))


def asymptotic_energy(chain: Chain, seeds: Sequence[int], q: int, *, terms: int = 2) -> Any:
    """The mean harmonic energy of the leading term of a mode in a long chain.

    E_q = mu^2k (1/2) <(d Q_q^(k)/dt)^2 + Omega_q^2 (Q_q^(k))^2>, k the order at which q is first
    excited, averaged over all phases, with linear frequencies: the quantity that Appendix E
    estimates.

    chain : its couplings; N has to be a symbol. seeds : modes from the start of the spectrum.
    q : a mode that they excite. terms : how many powers of 1/N^2. All is dimensionless.

    Returns a SymEngine expression in N and the energies E_i = Omega_i^2 A_i^2 / 2 of the seeds.
    Raises InputError for a chain with a number for N, for modes counted from the end, and for
    modes that are not excited.

    >>> asymptotic_energy(Chain("N", alpha=1), (1,), 2, terms=1)
    4*N**3*E1**2/pi**4
    """
    require_chain(chain)
    if not chain.symbolic:
        advice = "leave N open: Chain('N', alpha=...)"
        raise InputError("chain", chain, "a chain whose N is a symbol", advice)
    squared_mu = _squared_mu(chain)
    labels, count = _low(seeds), integer(terms, "terms", 1)
    mode = integer(q, "q", 1)
    # long enough for signed sums of 2q + 1 seeds
    N = (2 * mode + 1) * max(labels) + 2
    sequence = excitation_sequence(N, labels, mode, model=chain.model)
    for order, modes in enumerate(sequence):
        if mode in modes:
            series = lindstedt(chain, labels, order=order, ring="nested")
            assert isinstance(series, SeriesForAllN)
            energy = _energy(series, mode, order, count)
            return se.expand(energy * squared_mu**order)
    allowed = f"a mode that the seeds {labels} excite"
    raise InputError("q", q, allowed, "other modes stay at rest")


def asymptotic_group_energy(chain: Chain, s: int, k: int, *, terms: int = 2) -> Any:
    """E^(k), the energy of the middle mode of D_k, derived: seeds 1 .. s of the same energy.

    The middle modes are ks + [s/2] (alpha) and 2ks (beta), as in section 6.1; for one seed the
    one mode excited, k + 1 and 2k + 1.

    chain : its couplings; N has to be a symbol. s : how many seeds. k : order, from 0 up.
    terms : how many powers of 1/N^2. All is dimensionless.

    Returns a SymEngine expression in N and epsilon = E/N, E the energy of the seeds. It is the
    sum that Eqs. eksa and eksp estimate, over all products of seeds, at random phases. Differs
    from them in the factor: C_k(s) (epsilon/M) lambda^k with a rational C_k(s), which
    docs/asymptotics.md lists, (k + 1)^2 for one seed of alpha.
    Raises InputError for a chain with a number for N, for s or k out of range.

    >>> asymptotic_group_energy(Chain("N", alpha=1), 1, 2, terms=1)
    9*N**9*epsilon**3/pi**8
    """
    require_chain(chain)
    s, k = integer(s, "s", 1), integer(k, "k", 0)
    if chain.degree_step == 1:
        middle = k * s + (s // 2 or 1)
    else:
        middle = 2 * k * s if s > 1 and k else 2 * k + (s + 1) // 2
    seeds = tuple(range(1, s + 1))
    formula = asymptotic_energy(chain, seeds, middle, terms=terms)
    share = se.Symbol("epsilon") * se.Symbol("N") / s
    return se.expand(formula.subs({se.Symbol(f"E{q}"): share for q in seeds}))


def _energy(series: SeriesForAllN, q: int, order: int, count: int) -> Any:
    """E_q of the term of an order without mu^2k, in the energies of the seeds."""
    degree, seeds = series.degree(order), series.seeds
    nodes = series.coordinates[order].nodes[:, [q - 1]]
    powers = series.grading.powers(degree).tolist()
    harmonics = _harmonics(series, degree)
    monomials: list[tuple[int, ...]] = []

    def expanded(length: int) -> list[Laurent]:
        by_harmonic: dict[tuple[int, ...], list[tuple[tuple[int, ...], Laurent]]] = (
            defaultdict(list)
        )
        rows = zip(_values(series, nodes, length), powers, harmonics, strict=True)
        for value, row, nu in rows:
            by_harmonic[nu].append((tuple(row), value))
        sums: dict[tuple[int, ...], Laurent] = {}
        for nu, parts in by_harmonic.items():
            weight = _kinetic_and_potential(q, seeds, nu, length)
            for (e, a), (f, b) in product(parts, repeat=2):
                # w_i^2 = E_i/2
                key = tuple((m + n) // 2 for m, n in zip(e, f, strict=True))
                sums[key] = sums.get(key, Laurent.number(0, length)) + a * b * weight
        monomials[:] = list(sums)
        return list(sums.values())

    total = se.Integer(0)
    for value, row in zip(_leading(expanded, count), monomials, strict=True):
        energies = [(se.Symbol(f"E{p}") / 2) ** e for p, e in zip(seeds, row, strict=True)]
        total += value * se.Mul(*energies)
    return total


def _kinetic_and_potential(
    q: int, seeds: Sequence[int], nu: Sequence[int], length: int
) -> Laurent:
    """What the square of sum c w^e of a harmonic has to be multiplied with.

    u_q = 2 c w^e cos(nu.theta) has the mean energy (1/4) (1 + (nu.Omega / Omega_q)^2) (2 c w^e)^2.
    """
    if not any(nu):
        return Laurent.number(Fraction(1, 2), length)
    ratio = _drive(seeds, nu, length) * _sine(q, length).inverse()
    return ratio * ratio + 1


def _squared_mu(chain: Chain) -> Any:
    """mu^2 in N, of an FPU chain."""
    length = se.Symbol("N")
    if chain.alpha:
        return rational(chain.alpha**2) / (2 * length)
    return rational(chain.beta**2) / (4 * length**2)


class Laurent:
    """y^low (c_0 + c_1 y + ... ) with rational coefficients, known for so many powers.

    >>> x = Laurent(0, [Fraction(0), Fraction(2), Fraction(1)])
    >>> x.inverse()
    Laurent(-1, [Fraction(1, 2), Fraction(-1, 4)])
    """

    __slots__ = ("low", "series")

    def __init__(self, low: int, coefficients: Sequence[Fraction]) -> None:
        self.low, self.series = low, PowerSeries(coefficients)

    @classmethod
    def number(cls, value: int | Fraction, length: int) -> Laurent:
        """A number, known for so many powers."""
        return cls(0, [Fraction(value), *[Fraction(0)] * (length - 1)])

    def __repr__(self) -> str:
        return f"Laurent({self.low}, {self.coefficients})"

    @property
    def coefficients(self) -> list[Fraction]:
        """c_0, c_1, ..."""
        return self.series.coefficients

    @property
    def end(self) -> int:
        """The first power that is not known."""
        return self.low + len(self.series)

    @property
    def first(self) -> int | None:
        """The power of the first coefficient that is not zero, none if all known ones are."""
        for n, c in enumerate(self.coefficients):
            if c:
                return self.low + n
        return None

    def leads_below_zero(self) -> bool:
        """Whether the first coefficient that is not zero is negative."""
        return next((c < 0 for c in self.coefficients if c), False)

    def from_power(self, low: int, end: int) -> list[Fraction]:
        """Coefficients of y^low .. y^(end-1)."""
        padded = [Fraction(0)] * max(0, self.low - low) + self.coefficients
        return padded[max(0, low - self.low) :][: max(0, end - low)]

    def __add__(self, other: Any) -> Laurent:
        if not isinstance(other, Laurent):
            if not other:
                return self
            other = Laurent.number(other, max(1, self.end))
        low, end = min(self.low, other.low), min(self.end, other.end)
        pairs = zip(self.from_power(low, end), other.from_power(low, end), strict=True)
        return Laurent(low, [a + b for a, b in pairs])

    __radd__ = __add__

    def __mul__(self, other: Any) -> Laurent:
        if isinstance(other, Laurent):
            return Laurent(self.low + other.low, (self.series * other.series).coefficients)
        return Laurent(self.low, [c * other for c in self.coefficients])

    __rmul__ = __mul__

    def inverse(self) -> Laurent:
        """1 / series; ZeroDivisionError where no known coefficient differs from zero."""
        first = self.first
        if first is None:
            raise ZeroDivisionError("a series without a known term")
        known = PowerSeries(self.from_power(first, self.end))
        return Laurent(-first, known.inverse().coefficients)


def _sine(q: int, length: int) -> Laurent:
    """sin(qx)/x in powers of y = x^2."""
    terms = [
        Fraction((-1) ** i * q ** (2 * i + 1), factorial(2 * i + 1)) for i in range(length)
    ]
    return Laurent(0, terms)


def _drive(seeds: Sequence[int], nu: Sequence[int], length: int) -> Laurent:
    """nu.Omega / 2x."""
    total = Laurent.number(0, length)
    for n, q in zip(nu, seeds, strict=True):
        total = total + _sine(q, length) * n
    return total


def _values(series: SeriesForAllN, nodes: NDArray[np.int64], length: int) -> list[Laurent]:
    """Nodes of a column with linear frequencies, as Laurent series from so many terms."""
    program = series.coordinates[0].program
    needed = set(ancestors(program, nodes.ravel()).tolist())
    leaves: list[Any] = []
    for leaf, symbol in zip(program.leaves, program.symbols, strict=True):
        if leaf in needed and isinstance(symbol, Multiplier):
            own, drive = (
                _sine(symbol.mode, length),
                _drive(series.seeds, symbol.harmonic, length),
            )
            square = own * own
            leaves.append(square * (square + drive * drive * -1).inverse())
        else:
            value = symbol.value if isinstance(symbol, Coupling) else None
            leaves.append(value if leaf in needed else None)
    found = values_in(program, leaves, nodes)[:, 0].tolist()
    return [v if isinstance(v, Laurent) else Laurent.number(v, length) for v in found]


def _product(factors: Iterable[Laurent]) -> Laurent:
    """Of one factor or more."""
    return reduce(mul, factors)


def _leading(expanded: Callable[[int], list[Laurent]], count: int) -> list[Any]:
    """Several series as expressions in N, to `count` powers of y from the lowest of all."""
    length = count + GUARD
    while length <= MOST:
        found = expanded(length)
        lowest = min((v.first for v in found if v.first is not None), default=None)
        if lowest is not None and all(v.end >= lowest + count for v in found):
            return [_in_length(v, lowest, lowest + count) for v in found]
        length *= 2
    return [se.Integer(0) for _ in found]


def _in_length(value: Laurent, low: int, end: int) -> Any:
    """Powers of y = (pi/2N)^2 in N."""
    y = (se.pi / (2 * se.Symbol("N"))) ** 2
    coefficients = value.from_power(low, end)
    return se.Add(*(rational(c) * y ** (low + n) for n, c in enumerate(coefficients)))


def _harmonics(series: SeriesForAllN, degree: int) -> list[tuple[int, ...]]:
    """nu of every canonical monomial of a degree."""
    nu, index = series.grading.harmonics(degree)
    return [tuple(row) for row in nu[index].tolist()]


def _low(seeds: Sequence[int]) -> tuple[int, ...]:
    labels = seed_labels(seeds)
    if any(isinstance(q, HighMode) for q in labels):
        allowed = "modes from the start of the spectrum"
        raise InputError(
            "seeds", labels, allowed, "expand closed_form(...) in 1/N for others"
        )
    return tuple(sorted(labels))


def _series(series: object) -> tuple[int, ...]:
    """The seeds of a series for all N."""
    if not isinstance(series, SeriesForAllN):
        allowed = "a series of every N"
        raise InputError(
            "series", type(series).__name__, allowed, "lindstedt(Chain('N', ...), ...)"
        )
    return _low(series.seeds)
