"""Birkhoff's normal form restricted to the modes of a torus: H as a polynomial in the actions.

The series of a torus with linear frequencies in all divisors gives frequencies and actions as
power series in the squared amplitudes,

    kappa^2 I_i = sum over q and nu of 2 nu_i (nu.omega) / Omega_q^2 y^|nu| (sum u_q[nu] y^e)^2,

y and kappa as in symfpu.series.expanded. Inverted, omega(I). As omega = dH/dI, and the part
omega_(n-1) is homogeneous of degree n - 1 in the actions, Euler's theorem gives the part of H:

    H_n(I) = sum_i I_i omega_(i, n-1)(I) / n.

Its gradient is omega again, exactly, if and only if d omega_i / d I_j is symmetric: that is the
theorem the tests prove, in two fields: that of 2 cos(pi / 2N), where the chain's own Omega_q are,
and the rational functions of the Omega_q of all modes, taken as independent symbols.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import symengine as se

from symfpu.algebra.formulas import Multiplier
from symfpu.algebra.quotients import expression_of, quotient_field
from symfpu.algebra.real_cyclotomic import RealCyclotomic, double_cosines
from symfpu.algebra.truncated import Exponents, Truncated, inverted, variables
from symfpu.chain.chain import Chain, require_chain
from symfpu.chain.symbols import amplitude_symbol, linear_symbol
from symfpu.errors import InputError, ResonantDivisor
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import MULTIPRECISION, with_digits
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Table, joined
from symfpu.series.arguments import digits_of
from symfpu.series.expanded import ExpandedSeries, driven_modes, monomial_of
from symfpu.series.lindstedt import lindstedt
from symfpu.series.series import LindstedtSeries

# of divisors of a universal series: fractions of 10^4 take seconds, of 3 10^5 minutes
MOST_PRODUCTS = 10**5
MOST_WORK = 10**8  # operations with numbers of one digit or so: five minutes, about
# for the same: of a number of the field of degree N; of a fraction, or of mpf beside their digits
OPERATIONS, DIGITS_AN_OPERATION = 8, 50
INVERSION = 1000  # of (N times degree)^3, as a part of it
SPARE_DIGITS = 5  # of the working precision, to which a divisor may be zero
WAY_OUT = (
    "the normal form has no finite coefficient here: take other seeds or a lower degree"
)


@public
@dataclass(frozen=True)
class BirkhoffForm(Tabled):
    """H = sum over e of h_e I^e, the normal form of a chain on the torus of its seeds.

    Made by `birkhoff_form`; dimensionless. Ours.

    chain, seeds : the model and its modes. degree : the highest in the actions, half of that in
    the coordinates. digits : of coefficients that are mpf; None where they are expressions.
    coefficients : h_e by exponents e of the actions, those that are not zero.

    >>> from symfpu import Chain, birkhoff_form
    >>> form = birkhoff_form(Chain("N", beta=1), (1,), 2)
    >>> form
    BirkhoffForm(N='N', beta=1, seeds=1, degree 2 in the actions, 2 terms)
    >>> form.coefficients[2,]
    (9/16)*Omega_1**2/N
    >>> form.hamiltonian()
    I1*Omega_1 + (9/16)*I1**2*Omega_1**2/N
    >>> birkhoff_form(Chain(8, beta=1), (1,), 2, digits=12).to_frame().coefficient.tolist()
    [mpf('0.390180644032'), mpf('0.0107044...')]
    """

    not_kept = "make it again, or keep its table: to_frame()"

    chain: Chain
    seeds: tuple[int, ...]
    degree: int
    digits: int | None
    coefficients: Mapping[Exponents, Any]

    def __repr__(self) -> str:
        chain = self.chain.label
        listed = ",".join(map(str, self.seeds))
        count = f"degree {self.degree} in the actions, {counted(len(self.coefficients), 'term')}"
        return f"BirkhoffForm({chain}, seeds={listed}, {count})"

    def hamiltonian(self) -> Any:
        """H as a SymEngine expression in the actions I_q and the linear frequencies Omega_q."""
        symbols = [action_symbol(q) for q in self.seeds]
        return se.Add(*(_term(c, e, symbols) for e, c in self.coefficients.items()))

    def frequencies(self) -> dict[int, Any]:
        """omega_q = dH/dI_q by seed, as SymEngine expressions."""
        H = self.hamiltonian()
        return {q: se.expand(H.diff(action_symbol(q))) for q in self.seeds}

    def energy_at(self, actions: Mapping[int, Any]) -> Any:
        """H at actions by seed, of coefficients with digits; mpf. Raises InputError."""
        values = self._values(actions)
        with MULTIPRECISION.context(self.digits):
            total = mpmath.fsum(
                c * _product(values, e) for e, c in self.coefficients.items()
            )
        return with_digits(total, self.digits)

    def frequencies_at(self, actions: Mapping[int, Any]) -> dict[int, Any]:
        """omega_q = dH/dI_q at actions by seed, of coefficients with digits; mpf."""
        values = self._values(actions)
        found = {}
        with MULTIPRECISION.context(self.digits):
            for place, q in enumerate(self.seeds):
                total = mpmath.mpf(0)
                for e, c in self.coefficients.items():
                    if e[place]:
                        lowered = [n - (i == place) for i, n in enumerate(e)]
                        total += c * e[place] * _product(values, lowered)
                found[q] = total
        return with_digits(found, self.digits)

    def _values(self, actions: Mapping[int, Any]) -> list[Any]:
        if self.digits is None:
            advice = "make the form with digits="
            raise InputError("digits", None, "a form with numbers", advice)
        given: object = actions
        if not isinstance(given, Mapping) or set(given) != set(self.seeds):
            allowed = f"an action for each of the seeds {self.seeds}"
            raise InputError("actions", given, allowed, "write it as {seed: number}")
        with MULTIPRECISION.context(self.digits):
            try:
                return list(MULTIPRECISION.array([given[q] for q in self.seeds]))
            except (TypeError, ValueError) as error:
                allowed = "numbers by seed"
                raise InputError("actions", given, allowed, "pass real numbers") from error

    def _table(self) -> Table:
        """One row for each monomial."""
        columns: dict[str, Any] = {"exponents": list(map(joined, self.coefficients))}
        columns["degree"] = list(map(sum, self.coefficients))
        columns["coefficient"] = list(self.coefficients.values())
        known = attributes(
            self, self.chain, seeds=self.seeds, degree=self.degree, digits=self.digits
        )
        return Table(columns, known)


def action_symbol(q: int) -> Any:
    """I_q, written I1 or I_{N-1}."""
    name = str(amplitude_symbol(q))
    return se.Symbol(f"I{name.removeprefix('A')}")


def _term(coefficient: Any, exponents: Exponents, symbols: Sequence[Any]) -> Any:
    powers = [x**n for x, n in zip(symbols, exponents, strict=True)]
    return se.Mul(se.sympify(coefficient), *powers)


def _product(values: Sequence[Any], exponents: Sequence[int]) -> Any:
    return mpmath.fprod(x**n for x, n in zip(values, exponents, strict=True))


@public
def birkhoff_form(
    chain: Chain,
    seeds: Sequence[int | str],
    degree: int,
    *,
    over: str | None = None,
    digits: int | None = None,
    progress: Progress | None = None,
) -> BirkhoffForm:
    """H as a polynomial in the actions of the seeds: Birkhoff's normal form on their torus.

    chain : of any potential, N a number or "N" for all large ones; fixed ends. seeds : any modes.
    degree : in the actions; 2 is the fourth order in the coordinates.
    over : of exact coefficients. "chain" for numbers of this chain, sums of cosines of k pi / 2N;
        "symbols" for rational functions of Omega_q of all modes that are driven, as they come from
        the recursion: degree 2 is short, degree 3 of one seed. Default: the chain's where N is a
        number. A form that would take longer than some minutes is refused before it begins.
    digits : for mpf at the chain's frequencies instead; None for exact coefficients.
    progress : called as (label, fraction done).

    Dimensionless; the rest of the modes is on the torus, at rest beyond what the seeds drive. From
    the series (Eqs. qser, omeser) with linear frequencies in all divisors; ours. The second
    derivatives of the part of degree 2 are those of `twist_at_rest`. Raises InputError;
    ResonantDivisor where linear frequencies of the chain resonate, for numbers.

    >>> from symfpu import Chain
    >>> form = birkhoff_form(Chain(3, alpha=1), (1,), 3)
    >>> form.coefficients
    {(1,): 1, (2,): 1/24, (3,): 109/1728}
    >>> str(birkhoff_form(Chain(3, beta=1), (1,), 2, over="symbols").coefficients[2,])
    '(3/16)*Omega_1**2'
    """
    require_chain(chain)
    top = integer(degree, "degree", 1)
    if digits is not None:
        digits_of(digits)
    field = _field(chain, over, digits)
    _require_little_work(chain, len(seeds), top, field, digits)
    tell = progress or unheard
    tell("series", 0.0)
    series = lindstedt(chain, seeds, order=_series_order(chain, top), ring="nested")
    if digits is None:
        coefficients = FIELDS[field](series, top, tell)
    else:
        with MULTIPRECISION.context(digits):
            coefficients = with_digits(_in_numbers(series, top, tell), digits)
    return BirkhoffForm(chain, series.seeds, top, digits, coefficients)


def _field(chain: Chain, over: str | None, digits: int | None) -> str:
    """The name of the field; InputError for one that does not fit."""
    if chain.symbolic:
        for name, value, fitting in (("digits", digits, None), ("over", over, "symbols")):
            if value is not None and value != fitting:
                advice = "leave it out, or put a number for N: chain.at(N=32)"
                raise InputError(name, value, f"{fitting} while N is a symbol", advice)
    if digits is not None and over is not None:
        raise InputError("over", over, "None where digits are given", "leave one out")
    found = over or ("symbols" if chain.symbolic else "chain")
    if found not in FIELDS:
        raise InputError("over", over, ", ".join(FIELDS), "leave it out")
    return found


def _require_little_work(
    chain: Chain, seeds: int, degree: int, field: str, digits: int | None
) -> None:
    """InputError for a form that would take longer than MOST_WORK, before anything begins."""

    def work(d: int) -> int:
        return _work(chain, seeds, d, field, digits)

    if work(degree) <= MOST_WORK:
        return
    allowed = (
        f"a form of at most {MOST_WORK:.0e} operations ({work(degree):.1e} are needed)"
    )
    fitting = bisect.bisect_right(range(degree), MOST_WORK, lo=1, key=work) - 1
    lower = f"take degree {fitting} or less" if fitting else "take a shorter chain"
    raise InputError("degree", degree, allowed, f"{lower}, or fewer seeds")


def _work(chain: Chain, seeds: int, degree: int, field: str, digits: int | None) -> int:
    """About how many operations a form takes, as measured for one to four seeds.

    A product of two terms of the series, expanded in the actions, has 4s exponents of amplitudes
    and 2s of actions, of a weight of at most degree - 1 in all. Numbers grow with the degree.
    Those of the chain's field have N parts, and to invert one takes elimination.
    """
    top = max(1, degree - 1)
    products = seeds * math.comb(top + 6 * seeds, 6 * seeds) * top**2
    if digits is not None:
        return products * (OPERATIONS + digits // DIGITS_AN_OPERATION)
    if field != "chain":
        return products * OPERATIONS
    N = int(chain.N)
    return products * N + (N * top) ** 3 // INVERSION


def _series_order(chain: Chain, degree: int) -> int:
    """Of the frequencies: degree - 1 in the actions."""
    return 2 * (degree - 1) // chain.degree_step


def normal_form(
    expanded: ExpandedSeries, degree: int, tell: Progress = unheard
) -> tuple[Truncated, list[Truncated]]:
    """kappa^2 H and omega as power series in J = kappa^2 I, over the field of the series."""
    chain, one = expanded.series.chain, expanded.one
    top = max(1, degree - 1)
    y = variables([one * 0 for _ in expanded.linear], top, one)
    omega = [x * 0 + w for x, w in zip(y, expanded.linear, strict=True)]
    if degree > 1:
        ratios = expanded.frequency_ratios(top, tell)
        omega = [ratio * w for ratio, w in zip(ratios, expanded.linear, strict=True)]
    coordinates = max(0, 2 * (degree - 2) // chain.degree_step - 1)
    J = _scaled_actions(expanded, omega, y, coordinates)
    tell("actions", (degree - 1) / degree)
    of_actions = inverted(J)
    rates = [w.composed(of_actions) for w in omega]
    return _by_euler(rates, degree, one), rates


def _scaled_actions(
    expanded: ExpandedSeries,
    omega: Sequence[Truncated],
    y: Sequence[Truncated],
    order: int,
) -> list[Truncated]:
    """kappa^2 I_i of the coordinates cut at an order."""
    found = [y[0] * 0 for _ in expanded.linear]
    inverses: dict[int, Any] = {}
    for nu, columns in expanded.coordinates(omega, y, order).items():
        size = [abs(n) for n in nu]
        top = y[0].top - sum(size)  # the degrees that y^|nu| leaves
        rate = sum((w.cut(top) * n for w, n in zip(omega, nu, strict=True)), start=0)
        total: Any = 0
        for q, whole in columns.items():
            if q not in inverses:
                inverses[q] = 1 / expanded.squares[q]
            column = whole.cut(top)
            total = column * column * inverses[q] + total
        weight = (total * rate).cut(y[0].top) * monomial_of(y, size)
        for i, n in enumerate(nu):
            if n:
                found[i] = found[i] + weight * (2 * n)
    return found


def _by_euler(rates: Sequence[Truncated], degree: int, one: Any) -> Truncated:
    """sum_i I_i omega_i, the part of degree n over n."""
    size = len(rates)
    parts: list[dict[Exponents, Any]] = [{} for _ in range(degree + 1)]
    for place, rate in enumerate(rates):
        for e, c in rate.items():
            raised = tuple(n + (i == place) for i, n in enumerate(e))
            n = sum(raised)
            if n <= degree:
                parts[n][raised] = parts[n].get(raised, one * 0) + c / n
    kept = [{e: c for e, c in part.items() if c} for part in parts]
    return Truncated(kept, size)


def symbolic_series(series: LindstedtSeries) -> tuple[ExpandedSeries, list[int]]:
    """A universal series over the rational functions of Omega_q, and the q of its variables."""
    modes = driven_modes(series)
    field = quotient_field([f"x{i}" for i in range(len(modes))])
    linear = dict(zip(modes, field, strict=True))
    squares = {q: x * x for q, x in linear.items()}
    own = [linear[q] for q in series.seeds]
    one = field[0] * 0 + 1
    return ExpandedSeries(series, own, _Squares(squares, one), one), modes


class _Squares(dict[int, Any]):
    """Omega_q^2 by mode; 1 for modes that are not driven."""

    def __init__(self, known: Mapping[int, Any], one: Any) -> None:
        super().__init__(known)
        self.one = one

    def __missing__(self, q: int) -> Any:
        return self.one


def _in_symbols(
    series: LindstedtSeries, degree: int, tell: Progress
) -> dict[Exponents, Any]:
    _check_divisors(series, degree)
    expanded, modes = symbolic_series(series)
    H, _ = normal_form(expanded, degree, tell)
    symbols = list(map(linear_symbol, modes))
    kappa, found = _kappa_square(series.chain), {}
    for e, c in H.items():
        top, bottom = (expression_of(part, symbols) for part in (c.top, c.bottom))
        found[e] = kappa ** (sum(e) - 1) * top / bottom
    return found


def _check_divisors(series: LindstedtSeries, degree: int) -> None:
    """InputError for rational functions with more products of divisors than can be expanded.

    A coefficient has a factor 1/divisor for each order that it passes, degree - 1 of them apart
    from powers.
    """
    program = series.node_tables()[0].program
    divisors = sum(isinstance(symbol, Multiplier) for symbol in program.symbols)
    products = divisors ** (degree - 1)
    if products > MOST_PRODUCTS:
        allowed = (
            f"at most {MOST_PRODUCTS:.0e} products of divisors ({products:.1e} are there)"
        )
        advice = "take a lower degree, or fewer seeds; with a number for N, over='chain'"
        raise InputError("degree", degree, allowed, advice)


def _kappa_square(chain: Chain) -> Any:
    """mu^(2/step): alpha^2/2N, or beta/2N where V is even."""
    length = se.Symbol("N") if chain.symbolic else se.Integer(chain.N)
    unit = chain.unit_coupling ** (2 // chain.degree_step)
    return se.Integer(unit.numerator) / (se.Integer(unit.denominator) * 2 * length)


def chain_series(series: LindstedtSeries) -> ExpandedSeries:
    """A universal series over the field of 2 cos(pi / 2N), with Omega_q = 2 cos((N-q) pi / 2N)."""
    N = series.chain.N
    cosines = double_cosines(4 * N, N + 1)
    linear = {q: cosines[N - q] for q in series.chain.mode_numbers}
    # Omega_q^2 = 2 - 2 cos(2 q pi / 2N)
    squares = {
        q: 2 - cosines[2 * q] if 2 * q <= N else 2 + cosines[2 * (N - q)] for q in linear
    }
    own = [linear[q] for q in series.seeds]
    return _GuardedSeries(series, own, squares, cosines[0] / 2)


def _in_chain(series: LindstedtSeries, degree: int, tell: Progress) -> dict[Exponents, Any]:
    H, _ = normal_form(chain_series(series), degree, tell)
    kappa = _kappa_square(series.chain)
    N = series.chain.N
    return {e: se.expand(kappa ** (sum(e) - 1) * _cosines(c, N)) for e, c in H.items()}


def _cosines(value: RealCyclotomic, N: int) -> Any:
    """A number of the field as a rational sum of cosines of k pi / 2N."""
    terms = []
    for k, (p, q) in enumerate(value.by_cosines()):
        factor = 2 if k else 1
        terms.append(se.Rational(factor * p, q) * se.cos(k * se.pi / (2 * N)))
    return se.Add(*terms)


class _GuardedSeries(ExpandedSeries):
    """Over numbers, where a divisor may vanish."""

    def multiplier(self, symbol: Multiplier, omega: Sequence[Truncated]) -> Truncated:
        pairs = zip(self.linear, symbol.harmonic, strict=True)
        drive = sum((w * n for w, n in pairs), start=self.one * 0)
        divisor = self.squares[symbol.mode] - drive * drive
        if self._vanishes(divisor):
            seeds, order = self.series.seeds, self.series.order
            where = (symbol.mode, symbol.harmonic, seeds, order)
            raise ResonantDivisor(*where, exact=not self._rounded, way_out=WAY_OUT)
        return super().multiplier(symbol, omega)

    @property
    def _rounded(self) -> bool:
        return isinstance(self.one, mpmath.mpf)

    def _vanishes(self, divisor: Any) -> bool:
        if self._rounded:
            return bool(abs(divisor) < mpmath.mpf(10) ** (SPARE_DIGITS - mpmath.mp.dps))
        return not divisor


def _in_numbers(
    series: LindstedtSeries, degree: int, tell: Progress
) -> dict[Exponents, Any]:
    """At the working precision of mpmath."""
    chain = series.chain
    linear = {q: chain.linear_frequency(q) for q in chain.mode_numbers}
    squares = {q: w**2 for q, w in linear.items()}
    own = [linear[q] for q in series.seeds]
    expanded = _GuardedSeries(series, own, squares, mpmath.mpf(1))
    H, _ = normal_form(expanded, degree, tell)
    unit = chain.unit_coupling ** (2 // chain.degree_step) / chain.turn
    kappa = MULTIPRECISION.number(unit)
    return {e: c * kappa ** (sum(e) - 1) for e, c in H.items()}


FIELDS = {"chain": _in_chain, "symbols": _in_symbols}
