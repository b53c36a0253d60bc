"""Frequencies to amplitudes: the truncated equations of Eq. omeser.

omega_q = Omega_q + sum mu^k omega_q^(k)(A).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import lcm
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.errors import (
    DidNotConverge,
    InputError,
    NoRealAmplitude,
    SymfpuError,
    UndeterminedAmplitudes,
)
from symfpu.numbers.arithmetic import GUARD_DIGITS, Numbers, mpf, with_digits
from symfpu.numbers.public import public
from symfpu.numbers.typed import decimal, exact
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, listed, shown_number
from symfpu.results.result import Tabled
from symfpu.results.table import Table
from symfpu.series.series import LindstedtSeries, require_any_series
from symfpu.series.sums import require_frequencies
from symfpu.tori.from_series import FromSeries, series_behind
from symfpu.tori.orders import order_argument
from symfpu.tori.root_certificate import certify_root
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
# relative residual below which growth with the order is no reason to doubt
RESIDUAL_FLOOR = 1e-10
LARGEST_GUESS = 1e12
# relative residual above which the solution is doubtful whatever the orders say
LARGE_RESIDUAL = 1e-4
RESIDUAL_POINTS = 128  # angles at which two neighbouring orders are compared, about
# digits beyond the asked ones, of which the difference of two nearly equal frequencies loses some
SHIFT_GUARD = 35
NEWTON_STEPS = 50
LOST_DIGITS = 5  # of the guard digits of an evaluation, at a root
ROUNDING = (
    256 * np.finfo(float).eps
)  # of the sum of moduli of the series: what a root may leave
AGREEMENT = (
    1e-3  # relative change from the neighbouring order above which a root is doubtful
)


@public
@dataclass(frozen=True)
class AmplitudeHistory(Tabled):
    """Amplitudes A(K) by frequency order K, and why orders without a root have none.

    Made by `amplitude_history`; dimensionless. Fig. 1(b) shows the differences |A(K+2) - A(K)| of
    a torus.

    seeds : the modes. orders : all K at which the frequency series gains a term.
    amplitudes : K -> (A of each seed), shape (s,). failures : K -> the error. chain : the model.

    >>> from symfpu import Chain, amplitude_history, lindstedt
    >>> amplitude_history(lindstedt(Chain(N=8, beta="0.3"), (1,), ("0.3905",), 2))
    AmplitudeHistory(seeds=(1,), 2 of 2 orders have a root, A(2) = (0.504955824...))
    >>> history = amplitude_history(lindstedt(Chain(N=8, beta="0.3"), (1,), ("0.3905",), 2))
    >>> history.to_frame()[["frequency_order", "seed", "amplitude"]].round(6)
       frequency_order  seed  amplitude
    0                1     1   0.504850
    1                2     1   0.504956
    """

    seeds: tuple[int, ...]
    orders: tuple[int, ...]
    amplitudes: Mapping[int, tuple[Any, ...]]
    failures: Mapping[int, SymfpuError]
    chain: Chain | None = None

    def _answer(self) -> str:
        return f"{len(self.amplitudes)} of {len(self.orders)} orders have a root"

    def _fields(self) -> Iterator[Field]:
        yield from super()._fields()
        if self.amplitudes:
            last = max(self.amplitudes)
            sizes = listed(shown_number(A) for A in self.amplitudes[last])
            yield Field("", label=f"amplitudes at order {last}", shown=sizes)

    def __repr__(self) -> str:
        with_root = [K for K in self.orders if K in self.amplitudes]
        last = ""
        if with_root:
            K = with_root[-1]
            sizes = (str(A) for A in self.amplitudes[K])
            last = f", A({K}) = ({', '.join(sizes)})"
        counted = f"{len(self.amplitudes)} of {len(self.orders)} orders have a root"
        return f"AmplitudeHistory(seeds={self.seeds}, {counted}{last})"

    def differences(self) -> dict[int, tuple[float, ...]]:
        """Delta A(k) = |A(k + step) - A(k)| between orders that have a root.

        Section 3.2, where step is 2.
        """
        found = {}
        for K, following in itertools.pairwise(self.orders):
            if K in self.amplitudes and following in self.amplitudes:
                pairs = zip(self.amplitudes[K], self.amplitudes[following], strict=True)
                found[K] = tuple(float(abs(after - before)) for before, after in pairs)
        return found

    def _table(self) -> Table:
        """One row for each seed at each order; an order without a root has its error."""
        rows = [(K, i) for K in self.orders for i in range(len(self.seeds))]
        changes = self.differences()
        none = (None,) * len(self.seeds)
        failures = {K: str(error) for K, error in self.failures.items()}
        columns = {
            "frequency_order": [K for K, _ in rows],
            "seed": [self.seeds[i] for _, i in rows],
            "amplitude": [self.amplitudes.get(K, none)[i] for K, i in rows],
            "difference": [changes.get(K, none)[i] for K, i in rows],
            "failure": [failures.get(K, "") for K, _ in rows],
        }
        return Table(columns, attributes(self, self.chain, seeds=self.seeds))


def frequency_orders(series: LindstedtSeries) -> tuple[int, ...]:
    """Orders k at which omega^(k) need not vanish: even ones with alpha, all with beta alone."""
    chain = series.chain
    step = chain.degree_step
    return tuple(degree // step for degree in chain.shift_degrees(step * series.order))


def steps_of_frequencies(series: LindstedtSeries) -> int:
    """The largest step from one of these orders to the next: 2 with alpha, 1 with beta alone."""
    orders = (0, *frequency_orders(series))
    following = orders[1:] or (first_shifting_order(series.chain),)
    return max(b - a for a, b in zip(orders, following, strict=False))


def first_shifting_order(chain: Chain) -> int:
    """The order of the lowest frequency corrections: 2 with alpha, 1 with beta alone."""
    by_the_lowest_force = 2 * (chain.lowest_force - 1)
    return chain.shift_degrees(by_the_lowest_force)[0] // chain.degree_step


@public
def amplitude_history(series: LindstedtSeries | Torus[FromSeries]) -> AmplitudeHistory:
    """The amplitudes for every frequency order, each found from the one before.

    series : with chosen frequencies, or a torus solved from one; amplitudes are dimensionless, mpf
        if it has digits.

    Solves Eq. omeser truncated at every order (section 3.2). The lowest order is linear in A^2
    and needs no guess.
    Raises InputError for a series in universal form or without corrections and for a solution
    without a series, UndeterminedAmplitudes if the lowest order does not determine A^2. Orders
    without a root are kept with their error.

    >>> from symfpu import Chain, lindstedt
    >>> history = amplitude_history(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6))
    >>> {K: round(A, 9) for K, (A,) in history.amplitudes.items()}
    {2: 0.414689531, 4: 0.405667682, 6: 0.40519105}
    """
    return history_of(series_behind(series))


def history_of(series: LindstedtSeries) -> AmplitudeHistory:
    """The same of anything that has such a series."""
    orders = frequency_orders(series)
    found: dict[int, tuple[Any, ...]] = {}
    failures: dict[int, SymfpuError] = {}
    squares = np.abs(_lowest_order(series)) if orders else np.zeros(len(series.seeds))
    for K in orders:
        try:
            root, _ = root_squares(series, K, squares)
            found[K] = square_roots(series, root)
            squares = root
        except (NoRealAmplitude, DidNotConverge) as failure:
            failures[K] = failure
    return AmplitudeHistory(series.seeds, orders, found, failures, series.chain)


@public
def solve_amplitudes(
    series: LindstedtSeries,
    *,
    frequency_order: int | None = None,
    order: int | None = None,
    phases: Mapping[int, float] | None = None,
    guess: Mapping[int, float] | None = None,
) -> Torus[FromSeries]:
    """Seed amplitudes whose truncated frequency series equals the chosen frequencies: a torus.

    Solves Eq. omeser.

    series : with chosen frequencies; all quantities are dimensionless.
    frequency_order : K of the frequency series, up to series.order; default the whole series.
    order : truncation of Q_q(t), up to series.order; default the whole series. The two are
        independent.
    phases : by seed, radians; default 0.
    guess : amplitudes by seed; default none needed: the lowest correction is linear in A^2, and
        each order starts from the root of the one before.

    On a ring the torus is one of travelling waves; seeds q and -q of equal frequencies have equal
    amplitudes, a standing wave.
    Gauge: A_q multiplies cos(omega_q t + phi_q) in Q_q, and is not Q_q(0). The paper's table and
    captions do not always mean the same truncation; here they are two arguments.
    Raises InputError for arguments out of range and for frequencies that are commensurable within
    the harmonics of the series; NoRealAmplitude if an A^2 comes out negative (names the seed),
    also where the lowest order has no real root and no later one up to frequency_order has;
    DidNotConverge with the last iterate and residual; UndeterminedAmplitudes if no correction
    determines the amplitudes. Where neighbouring frequency orders disagree, the torus says so in
    its warnings. For a series with digits the root is polished to them by mpmath, and its
    certificate says whether ball arithmetic proves that it exists within 10^-digits.

    >>> from symfpu import Chain, lindstedt
    >>> chain = Chain(N=16, alpha="0.33")
    >>> torus = solve_amplitudes(lindstedt(chain, (1, 2), ("0.19626", "0.39046"), 8))
    >>> {q: round(A, 7) for q, A in torus.amplitudes.items()}
    {1: 0.5843165, 2: 0.4118684}
    """
    require_frequencies(require_any_series(series))
    if not series.chain.periodic:  # opposite waves of one frequency stand
        _refuse_commensurable(series)
    K = order_argument("frequency_order", frequency_order, series.order)
    coordinate_order = order_argument("order", order, series.order)
    angles = by_seed("phases", phases, series)
    orders = orders_up_to(series, K)
    history = amplitude_history(series)
    start = start_of(series, orders, history, guess)
    squares, residual = root_squares(series, orders[-1], start)
    amplitudes = square_roots(series, squares)
    origin = FromSeries(series, amplitudes, K, coordinate_order, root_residual=residual)
    return judged(origin.torus(angles), history)


def judged(torus: Torus[FromSeries], history: AmplitudeHistory) -> Torus[FromSeries]:
    """The same torus with its amplitude history, certificate and doubts."""
    series, K = torus.origin.series, torus.origin.frequency_order
    amplitudes = torus.origin.amplitudes
    certificate = None
    if series.digits:
        with series.numbers.context(series.digits):
            squares = [a**2 for a in amplitudes]
            certificate = certify_root(series, squares, K)
    known = torus.origin.judged(dict(history.amplitudes), certificate)
    doubts = order_doubts(amplitudes, orders_up_to(series, K), history)
    found = replace(torus, origin=known)
    return found.doubted((*doubts, *residual_doubts(found)))


def square_roots(series: LindstedtSeries, squares: Numbers) -> tuple[Any, ...]:
    """Amplitudes by their squares."""
    with series.numbers.context(series.digits):
        roots = tuple(series.numbers.sqrt(squares).tolist())
    return with_digits(roots, series.digits)


def _refuse_commensurable(series: LindstedtSeries) -> None:
    """Refuse frequencies for which two harmonics of the series coincide, or one is at rest.

    The orbit then fills no torus of s angles.
    """
    assert series.frequencies is not None
    common = lcm(*(w.denominator for w in series.frequencies))
    whole = [int(w * common) for w in series.frequencies]
    constant = (0,) * len(series.seeds)
    by_rate: dict[int, tuple[int, ...]] = {0: constant}
    for order in range(series.order + 1):
        harmonics, *_ = series.grading.harmonics(series.degree(order))
        for row in harmonics.tolist():
            nu = tuple(row)
            rate = sum(n * w for n, w in zip(nu, whole, strict=True))
            other = by_rate.setdefault(abs(rate), nu)
            if other != nu:
                typed = tuple(map(decimal, series.frequencies))
                allowed = "incommensurable up to the harmonics of the series"
                coincide = (
                    f"harmonics {nu} and {other} of the seeds {series.seeds} coincide"
                )
                change = f"change omega_{series.seeds[-1]} or lower the order"
                raise InputError("frequencies", typed, allowed, f"{coincide}: {change}")


def orders_up_to(series: LindstedtSeries, frequency_order: int | None) -> list[int]:
    """The orders of frequency corrections up to one; InputError where there are none."""
    K = order_argument("frequency_order", frequency_order, series.order)
    orders = [k for k in frequency_orders(series) if k <= K]
    if not orders:
        first = first_shifting_order(series.chain)
        allowed = f"{first} or more, the order of the first frequency correction"
        longer, more = "compute a longer series", f"take {first} or more"
        advice = longer if series.order < first else more
        raise InputError("frequency_order", K, allowed, advice)
    return orders


def by_seed(
    name: str, values: Mapping[int, Any] | None, series: LindstedtSeries
) -> dict[int, Any]:
    """Numbers by seed in the arithmetic of the series.

    InputError naming the argument for other keys or values.
    """
    if values is not None and not isinstance(values, Mapping):
        allowed = f"a mapping from the seeds {series.seeds} to numbers"
        raise InputError(name, values, allowed, "write it as {seed: number}")
    given = values or {}
    for q in given:
        if q not in series.seeds:
            raise InputError(name, q, f"seeds {series.seeds} as keys", "name seeds only")
    with series.numbers.context(series.digits):
        return {int(q): series.numbers.number(exact(v, name)) for q, v in given.items()}


def start_of(
    series: LindstedtSeries,
    orders: list[int],
    history: AmplitudeHistory,
    guess: Mapping[int, float] | None,
) -> Numbers:
    """A^2 to start from: as guessed, or those of the last order that has a root."""
    if guess is not None:
        given = by_seed("guess", guess, series)
        if set(given) != set(series.seeds):
            allowed = f"an amplitude for each of the seeds {series.seeds}"
            raise InputError("guess", dict(guess), allowed, "complete it or leave it out")
        if not all(0 < abs(a) < LARGEST_GUESS for a in given.values()):
            allowed = f"amplitudes that are not 0 and below {LARGEST_GUESS:g}"
            raise InputError(
                "guess", dict(guess), allowed, "take them near the expected ones"
            )
        return np.array([float(given[q]) ** 2 for q in series.seeds])
    earlier = [k for k in orders if k in history.amplitudes]
    if not earlier:
        raise history.failures[orders[0]]
    with series.numbers.context(series.digits):
        return np.array(history.amplitudes[earlier[-1]]) ** 2


def shifts(series: LindstedtSeries) -> Numbers:
    """omega_q - Omega_q of the seeds, correctly rounded; shape (s,)."""
    assert series.frequencies is not None
    differences = []
    with mpmath.workdps((series.digits or 17) + SHIFT_GUARD):
        for q, w in zip(series.seeds, series.frequencies, strict=True):
            linear = series.chain.linear_frequency(q)
            differences.append(mpf(w) - linear)
    if series.digits is None:
        return np.array([float(x) for x in differences])
    return np.array(differences, dtype=object)


def _lowest_order(series: LindstedtSeries) -> Floats:
    """A^2 by the lowest correction, a form of the A^2 of some degree; it may be negative.

    Exact where the form is linear. For a degree p above it is a first guess, exact for a sum of
    the A_j^(2p): by its derivatives at A = 1, which sum up to p times the form.
    """
    first = frequency_orders(series)[0]
    degree = series.chain.degree_step * first // 2
    equal = np.full(len(series.seeds), 1.0 if degree > 1 else 0.0)
    _, jacobian = series.frequency_terms(equal, first)
    matrix = jacobian[first].astype(float) / degree
    largest_condition = 1 / np.finfo(float).eps
    if not np.any(matrix) or np.linalg.cond(matrix) > largest_condition:
        raise UndeterminedAmplitudes(series.seeds, first)
    target = shifts(series).astype(float)
    powers = np.linalg.solve(matrix, target)
    return np.asarray(np.sign(powers) * np.abs(powers) ** (1 / degree))


def root_squares(series: LindstedtSeries, K: int, start: Numbers) -> tuple[Numbers, float]:
    """A^2 that solves the equations truncated at order K, and the residual it leaves."""
    from scipy.optimize import root

    target = shifts(series)
    scale = np.where(start != 0, np.abs(start), 1.0)
    unit = np.abs(target) + np.finfo(float).tiny

    def equations(y: Numbers) -> tuple[Numbers, Numbers]:
        terms, jacobian = series.frequency_terms(y * scale, K)
        left = terms[1:].sum(axis=0) - target
        slopes = jacobian[1:].sum(axis=0) * scale
        return left / unit, slopes / unit[:, None]

    def doubles(y: Floats) -> tuple[Floats, Floats]:
        values, jacobian = equations(y)
        return values.astype(float), jacobian.astype(float)

    digits = series.digits
    with np.errstate(over="ignore", invalid="ignore"), series.numbers.context(digits):
        first = (start / scale).astype(float)
        near = root(doubles, first, jac=True, method="hybr", tol=1e-15).x
        scaled = near if digits is None else _polished(equations, near, digits)
        squares = scaled * scale
        terms, _ = series.frequency_terms(squares, K)
        corrections = terms[1:]
        residual = float(np.max(np.abs(corrections.sum(axis=0) - target)))
        moduli = np.abs(corrections).sum(axis=0) + np.abs(target)
        allowed = _root_rounding(digits) * float(np.max(moduli))
    _refuse_no_root(series.seeds, squares, K, residual, allowed)
    return squares, residual


def _root_rounding(digits: int | None) -> float:
    """What a root may leave, relative to the sum of moduli of the series."""
    if digits is None:
        return ROUNDING
    return 10.0 ** -(digits + GUARD_DIGITS - LOST_DIGITS)


def _refuse_no_root(
    seeds: tuple[int, ...], squares: Numbers, K: int, residual: float, allowed: float
) -> None:
    if not residual <= allowed:  # also when it is not a number
        iterate = {}
        for q, x in zip(seeds, squares, strict=True):
            square = float(x)
            iterate[q] = float(np.sign(square) * abs(square) ** 0.5)
        raise DidNotConverge(K, iterate, residual)
    for q, x in zip(seeds, squares, strict=True):
        if x <= 0:
            raise NoRealAmplitude(q, float(x), K)


def _polished(
    equations: Callable[[Numbers], tuple[Numbers, Numbers]], near: Floats, digits: int
) -> Numbers:
    """The root near a point to all digits, by mpmath's Newton iteration.

    The last iterate where it does not converge.
    """
    known: dict[tuple[Any, ...], tuple[Numbers, Numbers]] = {}

    def at(point: tuple[Any, ...]) -> tuple[Numbers, Numbers]:
        if point not in known:
            known[point] = equations(np.array(point, dtype=object))
        return known[point]

    def values(*point: Any) -> list[Any]:
        left, _ = at(point)
        return list(left)

    def jacobian(*point: Any) -> Any:
        _, slopes = at(point)
        return mpmath.matrix(slopes.tolist())

    start = [mpmath.mpf(float(x)) for x in near]
    tolerance = mpmath.mpf(10) ** -(digits + GUARD_DIGITS - LOST_DIGITS)
    found = mpmath.findroot(
        values,
        start,
        solver="mdnewton",
        J=jacobian,
        tol=tolerance,
        maxsteps=NEWTON_STEPS,
        verify=False,
    )
    return np.array(list(found), dtype=object)


def order_doubts(
    amplitudes: tuple[Any, ...], orders: list[int], history: AmplitudeHistory
) -> tuple[str, ...]:
    """Why the root may be one of the truncated polynomial only."""
    K = orders[-1]
    if len(orders) == 1:
        return (
            f"order {K} is the only frequency order: nothing to compare the amplitudes with",
        )
    before = orders[-2]
    earlier = history.amplitudes.get(before)
    if earlier is None:
        no_root = f"frequency order {before} has no root"
        doubt = f"the root at order {K} may be one of the truncated polynomial only"
        return (f"{no_root}: {doubt}",)
    changes = [abs(float(a / b - 1)) for a, b in zip(amplitudes, earlier, strict=True)]
    change = max(changes)
    doubts = []
    if change > AGREEMENT:
        differ = (
            f"the amplitudes of frequency orders {before} and {K} differ by {change:.1%}"
        )
        doubts.append(f"{differ}: not a torus to that accuracy")
    doubts += _parting_doubts(orders, history)
    return tuple(doubts)


def _parting_doubts(orders: list[int], history: AmplitudeHistory) -> list[str]:
    """Whether the amplitudes agreed better between lower orders; the last two have roots."""
    K, before = orders[-1], orders[-2]
    differences = {k: max(d) for k, d in history.differences().items() if k < K}
    if not differences:
        return []
    best = min(differences, key=lambda k: differences[k])
    at = orders.index(best)
    orders_beyond = orders.index(K) - at
    if orders_beyond <= 2 or not differences[before] > 2 * differences[best]:
        return []
    agree = (
        f"the amplitudes agree best between frequency orders {best} and {orders[at + 1]}"
    )
    return [f"{agree} and move apart beyond"]


def residual_doubts(torus: Torus[FromSeries]) -> tuple[str, ...]:
    """Whether the residual of the equations of motion is large, or grew with the last two orders.

    Decided at few angles; the one residual that is stated is `torus.residual()`.
    """
    points = None
    if not torus.digits:
        points = max(3, round(RESIDUAL_POINTS ** (1 / len(torus.seeds))))
    residual = torus.residual(points)
    doubts = []
    if residual > LARGE_RESIDUAL:
        met = f"{torus.residual():.2g}"
        doubts.append(
            f"the equations of motion are met only to {met} of the largest acceleration"
        )
    before = torus.origin.order - 2
    if before >= 1 and residual > RESIDUAL_FLOOR:
        shorter = torus.origin.cut_at(before).torus(torus.phases)
        earlier = shorter.residual(points)
        if residual > 1.05 * earlier:
            orders = f"from order {before} to {before + 2}"
            growth = f"grows, {residual / earlier:.3g} times {orders}"
            advice = "cut the series earlier, by order="
            doubts.append(f"the residual of the equations of motion {growth}: {advice}")
    return tuple(doubts)
