"""Long chains: what terms, divisors and energies become for N to infinity at fixed seeds.

With linear frequencies everything depends on N through x = pi/2N alone. Modes are counted from
the ends of the spectrum: Omega_m = 2 sin mx, Omega_(N-b) = 2 cos bx. So L_q(nu) is a quotient of
power series in x with rational coefficients, and the nodes of the universal series are Laurent
series in x, exactly; in x^2 where all seeds are at one end. At fixed seeds and modes this is the
expansion in small kappa = q/N, or 1 - kappa, too. Divisors whose leading powers cancel are almost
resonant, Appendix E: Omega_m^2 - (nu.Omega)^2 with m = nu.q for low seeds, and for high ones with
sum nu = +-1.

Averages over time take the harmonics of a term apart, as for incommensurable frequencies.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import reduce
from itertools import product
from operator import mul
from typing import Any

import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.formulas import Coupling, Multiplier
from symfpu.algebra.laurent import Laurent
from symfpu.algebra.program_values import ancestors, values_in
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.length import HighMode, mode_label, mode_of, seed_labels
from symfpu.chain.propagation import excitation_sequence
from symfpu.chain.symbols import amplitude_symbol, energy_symbol, phase_symbol
from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, rational
from symfpu.proofs.long_chain import BOTH_ENDS, ONE_END, LongChain
from symfpu.series.all_lengths import SeriesForAllN, ends_reached, in_order
from symfpu.series.lindstedt import lindstedt

GUARD = 2  # coefficients beyond those asked for, at first
MOST = 128  # coefficients after which a term counts as zero

Mode = int | str


@public
def asymptotic_divisor(
    mode: Mode,
    seeds: Sequence[Mode],
    harmonic: Sequence[int],
    *,
    terms: int = 2,
    squared: bool = True,
) -> Any:
    """Omega_m^2 - (nu.Omega)^2 of a long chain, as the first terms in 1/N.

    mode : m. seeds : modes, from the start of the spectrum or "N-1", "N-2", ... from its end.
    harmonic : nu, one integer for each seed, in the order of the seeds. terms : how many powers
        of 1/N, counted from the leading one: every second power where all modes are at one end,
        else every one. squared : False for Omega_m - |nu.Omega|, the detuning of Appendix E,
        approximation iii. All is dimensionless.

    Returns a SymEngine expression in N; 0 where both frequencies are the same for every N. Almost
    resonant divisors, m = |nu.q|, fall as N^-4, others of low modes as N^-2. Differs from
    Appendix E, whose pi^3 m^3 / 24 N^3 lacks the factor 1 - sum_i nu_i q_i^3 / m^3.
    Raises InputError for what are no modes, and numbers that are none.

    >>> asymptotic_divisor(2, (1,), (2,), terms=1, squared=False)
    (-1/4)*pi**3/N**3
    >>> asymptotic_divisor(2, (1,), (2,), terms=1)
    -pi**4/N**4
    >>> asymptotic_divisor("N-3", ("N-1",), (1,), terms=1)
    -8*pi**2/N**2
    """
    labels, m = seed_labels(seeds), mode_label(mode, "mode")
    count = integer(terms, "terms", 1)
    nu = [integer(n, "harmonic", -(10**6)) for n in harmonic]
    if len(nu) != len(labels):
        allowed = f"one integer for each of the seeds {labels}"
        raise InputError("harmonic", tuple(nu), allowed, "add or drop some")

    def expanded(chain: LongChain) -> list[Laurent]:
        own, drive = chain.frequency(m), chain.drive(labels, nu)
        if squared:
            return [own * own + drive * drive * -1]
        if not any(nu):
            return [own]
        sign = -1 if drive.leads_below_zero() else 1
        return [own + drive * -sign]

    # a difference of frequencies mixes odd and even powers where the ends differ
    acting = [q for n, q in zip(nu, labels, strict=True) if n]
    (found,) = _leading(expanded, count, _step(acting if squared else [m, *acting]))
    return se.expand(found)


@public
def asymptotic_term(series: SeriesForAllN, q: Mode, order: int, *, terms: int = 2) -> Any:
    """Q_q^(k) of a long chain at fixed amplitudes, as the first terms in 1/N.

    Without mu^k, with linear frequencies in all divisors (Eqs. moda, modb, Lm).

    series : `lindstedt` of a chain whose N is a symbol, of any potential, with any seeds. q,
        order : mode and k. terms : how many powers of 1/N are kept, counted from the leading one
        of the whole term: of 1/N^2 for seeds at one end of the spectrum, else of 1/N. All is
        dimensionless, phases theta in radians.

    Returns a SymEngine expression in N, A_i and theta_i; 0 for a term that vanishes.
    Raises InputError for other series, modes or orders.

    >>> series = lindstedt(Chain("N", alpha=1), (1,), order=1)
    >>> asymptotic_term(series, 2, 1, terms=1)
    N*A1**2*cos(2*theta1)/pi
    >>> series = lindstedt(Chain("N", beta=1), ("N-1",), order=1)
    >>> asymptotic_term(series, "N-3", 1, terms=1)
    (-3/2)*N**2*A_{N-1}**3*cos(theta_{N-1})/pi**2
    """
    seeds = _series(series)
    count = integer(terms, "terms", 1)
    column, degree = series._mode(q) - 1, series.degree(order)
    label = series.modes[column]
    nodes = series.coordinates[order].nodes[:, [column]]
    powers = series.grading.powers(degree).tolist()
    harmonics = _harmonics(series, degree)

    def expanded(chain: LongChain) -> list[Laurent]:
        inverse, found = chain.frequency(label).inverse(), []
        for value, row in zip(_values(series, nodes, chain), powers, strict=True):
            # w_i = Omega_i A_i / 2
            w = (
                chain.frequency(p) * Fraction(1, 2)
                for p, e in zip(seeds, row, strict=True)
                for _ in range(e)
            )
            found.append(value * _product(w) * inverse)
        return found

    total, leading = se.Integer(0), _leading(expanded, count, _step(seeds))
    for value, row, nu in zip(leading, powers, harmonics, strict=True):
        amplitudes = [amplitude_symbol(p) ** e for p, e in zip(seeds, row, strict=True)]
        angle = se.Add(*(n * phase_symbol(p) for n, p in zip(nu, seeds, strict=True)))
        pair = se.Integer(2 if any(nu) else 1)
        total += pair * value * se.Mul(*amplitudes) * se.cos(angle)
    return se.expand(total)


@public
def asymptotic_energy(
    chain: Chain, seeds: Sequence[Mode], q: Mode, *, terms: int = 2
) -> Any:
    """The mean harmonic energy of the leading term of a mode in a long chain.

    E_q = mu^2k (1/2) <(d Q_q^(k)/dt)^2 + Omega_q^2 (Q_q^(k))^2>, k the order at which q is first
    excited, averaged over all phases, with linear frequencies: the quantity that Appendix E
    estimates.

    chain : its couplings, of any potential; N has to be a symbol. seeds : modes, from the start
        of the spectrum or "N-1", "N-2", ... from its end. q : a mode that they excite. terms :
        how many powers of 1/N^2, or of 1/N for seeds at both ends. All is dimensionless.

    Returns a SymEngine expression in N and the energies E_i = Omega_i^2 A_i^2 / 2 of the seeds.
    Raises InputError for a chain with a number for N, for what are no modes, and for modes that
    are not excited.

    >>> asymptotic_energy(Chain("N", alpha=1), (1,), 2, terms=1)
    4*N**3*E1**2/pi**4
    >>> asymptotic_energy(Chain("N", beta=1), ("N-1",), "N-3", terms=1)
    (9/64)*N**2*E_{N-1}**3/pi**4
    """
    require_symbolic(chain)
    labels, count = in_order(seed_labels(seeds)), integer(terms, "terms", 1)
    label = mode_label(q, "q")
    order = _first_order(chain, labels, label)
    series = lindstedt(chain, _written(labels), order=order, ring="nested")
    assert isinstance(series, SeriesForAllN)
    return se.expand(_energy(series, label, order, count) * _squared_mu(chain) ** order)


def require_symbolic(chain: Chain) -> None:
    """InputError for a chain whose N is a number."""
    require_chain(chain)
    if not chain.symbolic:
        advice = "leave N open: Chain('N', alpha=...)"
        raise InputError("chain", chain, "a chain whose N is a symbol", advice)


def _first_order(chain: Chain, labels: Sequence[int], mode: int) -> int:
    """The order at which the rule first excites a mode.

    A shortest signed sum can be ordered so that its partial sums stay between -span and |mode| +
    span, and comes to none twice with the same parities of its length and of its high seeds.
    """
    span = max(abs(q) for q in labels)
    longest = 4 * (2 * span + abs(mode) + 1)
    order = 1
    while True:
        ends = ends_reached(chain, labels, order)
        N = ends.valid_from
        if abs(mode) <= (ends.high if mode < 0 else ends.low):
            modes = [mode_of(q, N) for q in labels]
            sequence = excitation_sequence(N, modes, order, potential=chain.potential)
            for k, excited in enumerate(sequence):
                if mode_of(mode, N) in excited:
                    return k
        if order > longest:
            break
        order *= 2
    allowed = f"a mode that the seeds {tuple(labels)} excite"
    raise InputError("q", mode, allowed, "other modes stay at rest")


def _written(labels: Sequence[int]) -> list[Mode]:
    return [str(q) if isinstance(q, HighMode) else q for q in labels]


def _energy(series: SeriesForAllN, q: int, order: int, count: int) -> Any:
    """E_q of the term of an order without mu^2k, in the energies of the seeds."""
    degree, seeds = series.degree(order), series.seeds
    nodes = series.coordinates[order].nodes[:, [series._mode(q) - 1]]
    powers = series.grading.powers(degree).tolist()
    harmonics = _harmonics(series, degree)
    monomials: list[tuple[int, ...]] = []

    def expanded(chain: LongChain) -> list[Laurent]:
        by_harmonic: dict[tuple[int, ...], list[tuple[tuple[int, ...], Laurent]]] = (
            defaultdict(list)
        )
        rows = zip(_values(series, nodes, chain), powers, harmonics, strict=True)
        for value, row, nu in rows:
            by_harmonic[nu].append((tuple(row), value))
        sums: dict[tuple[int, ...], Laurent] = {}
        for nu, parts in by_harmonic.items():
            weight = _kinetic_and_potential(q, seeds, nu, chain)
            for (e, a), (f, b) in product(parts, repeat=2):
                # w_i^2 = E_i/2
                key = tuple((m + n) // 2 for m, n in zip(e, f, strict=True))
                energy = a * b * weight
                sums[key] = sums[key] + energy if key in sums else energy
        monomials[:] = list(sums)
        return list(sums.values())

    total, leading = se.Integer(0), _leading(expanded, count, _step(seeds))
    for value, row in zip(leading, monomials, strict=True):
        energies = [(energy_symbol(p) / 2) ** e for p, e in zip(seeds, row, strict=True)]
        total += value * se.Mul(*energies)
    return total


def _kinetic_and_potential(
    q: int, seeds: Sequence[int], nu: Sequence[int], chain: LongChain
) -> Laurent:
    """What the square of sum c w^e of a harmonic has to be multiplied with.

    u_q = 2 c w^e cos(nu.theta) has the mean energy (1/4) (1 + (nu.Omega / Omega_q)^2) (2 c w^e)^2.
    """
    if not any(nu):
        return chain.number(Fraction(1, 2))
    own, drive = chain.frequency(q).inverse(), chain.drive(seeds, nu)
    return (drive * drive) * (own * own) + 1


def _squared_mu(chain: Chain) -> Any:
    """mu^2 in N."""
    length, coupling = se.Symbol("N"), rational(chain.unit_coupling**2)
    if chain.degree_step == 1:
        return coupling / (2 * length)
    return coupling / (4 * length**2)


def _values(
    series: SeriesForAllN, nodes: NDArray[np.int64], chain: LongChain
) -> list[Laurent]:
    """Nodes of a column with linear frequencies."""
    program = series.coordinates[0].program
    needed = set(ancestors(program, nodes.ravel()).tolist())
    leaves: list[Any] = []
    for leaf, symbol in zip(program.leaves, program.symbols, strict=True):
        if leaf in needed and isinstance(symbol, Multiplier):
            own = chain.frequency(symbol.mode)
            drive = chain.drive(series.seeds, symbol.harmonic)
            square = own * own
            leaves.append(square * (square + drive * drive * -1).inverse())
        else:
            value = symbol.value if isinstance(symbol, Coupling) else None
            leaves.append(value if leaf in needed else None)
    found = values_in(program, leaves, nodes)[:, 0].tolist()
    return [v if isinstance(v, Laurent) else chain.number(v) for v in found]


def _product(factors: Iterable[Laurent]) -> Laurent:
    """Of one factor or more."""
    return reduce(mul, factors)


def _leading(
    expanded: Callable[[LongChain], list[Laurent]], count: int, step: int
) -> list[Any]:
    """Several series as expressions in N, to `count` powers from the lowest of all."""
    length = count + GUARD
    while length <= MOST:
        try:
            found = expanded(LongChain(length, step))
        except ZeroDivisionError:  # a divisor begins beyond what is known
            length *= 2
            if length > MOST:
                raise
            continue
        lowest = min((v.first for v in found if v.first is not None), default=None)
        if lowest is not None and all(v.end >= lowest + step * count for v in found):
            return [_in_length(v, lowest, lowest + step * count) for v in found]
        length *= 2
    return [se.Integer(0) for _ in found]


def _in_length(value: Laurent, low: int, end: int) -> Any:
    """Powers of x = pi/2N in N."""
    x = se.pi / (2 * se.Symbol("N"))
    coefficients = value.from_power(low, end)
    powers = range(low, end, value.step)
    return se.Add(*(rational(c) * x**p for p, c in zip(powers, coefficients, strict=False)))


def _step(labels: Sequence[int]) -> int:
    """Powers of x from one that occurs to the next."""
    ends = {q < 0 for q in labels}
    return BOTH_ENDS if len(ends) > 1 else ONE_END


def _harmonics(series: SeriesForAllN, degree: int) -> list[tuple[int, ...]]:
    """nu of every canonical monomial of a degree."""
    nu, index = series.grading.harmonics(degree)
    return [tuple(row) for row in nu[index].tolist()]


def _series(series: object) -> tuple[int, ...]:
    """The seeds of a series for all N."""
    if not isinstance(series, SeriesForAllN):
        allowed = "a series of every N"
        raise InputError(
            "series", type(series).__name__, allowed, "lindstedt(Chain('N', ...), ...)"
        )
    return series.seeds
