"""A judgement of a series and its torus.

Does it converge, where is it best cut, is the root a torus at all?

One word first, the evidence after: amplitudes by order, sizes of terms and what carries them,
residuals of the equations of motion and constancy of the energy at every order, radius of
convergence by ratio and by Pade poles, and the resummed torus.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, Arithmetic, Numbers, text
from symfpu.numbers.counted import short
from symfpu.numbers.mpfr import at_the_face, inside
from symfpu.numbers.public import public
from symfpu.results.attributes import Attributes, attributes
from symfpu.results.field import Field, chain_fields
from symfpu.results.result import Tabled
from symfpu.results.table import Column, Table, joined
from symfpu.results.text_tables import GAP, text_table
from symfpu.series.divisors import divisor
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import (
    AGREEMENT,
    AmplitudeHistory,
    frequency_orders,
    steps_of_frequencies,
)
from symfpu.tori.best_order import GRID_POINTS, some_angles
from symfpu.tori.columns import Columns, columns_of
from symfpu.tori.from_series import FromSeries, RootCertificate, require_series_torus
from symfpu.tori.resummation import pade_poles, resum
from symfpu.tori.torus import (
    DOUBLES_RESIDUAL,
    GRID_POINTS_DIGITS,
    Torus,
    points_of_each_angle,
)

Floats = NDArray[np.float64]

# relative residual that no truncation of a torus' series should exceed at its best order
LARGE_RESIDUAL = 1e-3
# relative residual to which a series must have fallen to be called converged
SMALL_RESIDUAL = 1e-7
FLOOR = 1e-12  # relative residual of doubles at which nothing more can be seen
SMALLER_SHARE = 0.9  # of another residual, below which one is called smaller
RATIO_ORDERS = 4  # how many of the last orders a growth ratio is fitted to
# what closes the reasons of a verdict
FALLING_BUT_UNSETTLED = (
    "the residual still falls, but the root has not settled: more orders are needed"
)
TRUNCATED_ROOT = "it is one of the truncated polynomial only"
UNSETTLED = f"the root does not settle with the frequency order: {TRUNCATED_ROOT}"
NO_TRUNCATION = "no truncation meets the equations of motion"
# said of the series: a torus may be beside its root
MAY_BE_FOUND = "this truncation is no torus; refine may find one beside it"
STILL_FALLING = "the residual still falls: more orders would tell whether it goes on"


@dataclass(frozen=True)
class LargestTerm:
    """The largest term of one order: Omega_q |c_q[nu]| with its mode, harmonic and divisor.

    The divisor is lambda_q - (nu.omega)^2.
    """

    order: int
    size: float
    mode: int
    harmonic: tuple[int, ...]
    divisor: float

    def entry(self) -> dict[str, Any]:
        """For a record."""
        where = {"mode": self.mode, "harmonic": list(self.harmonic)}
        size, divisor = short(self.size), short(self.divisor)
        return {"order": self.order, "size": size, **where, "divisor": divisor}

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        return f"{self.size:.2g} at {place}, divisor {self.divisor:.2g}"


def _short(values: Iterable[float]) -> list[float | None]:
    return [short(x) for x in values]


SHOWN_ORDERS = 10  # of the evidence, about


@public
@dataclass(frozen=True, eq=False)
class Assessment(Tabled):
    """What `assess` found; dimensionless numbers.

    word : 'converged', 'asymptotic', 'not a torus', or 'undecided' where too few orders are known.
        'not a torus' is said of this truncation: `refine` may find a torus beside it.
    best_order : coordinate order of the least residual. reasons : why this word, in sentences.
    order, frequency_order : of the torus' coordinates and frequencies.
    amplitudes : K -> A(K), (s,), by frequency order; differences : K -> Delta A(K), (s,)
        (Fig. 1(b)).
    root_uncertainty : what later frequency orders would change of the amplitudes, relative.
    sums : by seed, mu^k S_1(k) and mu^k S_2(k) of its own coordinate, (order + 1,) each
        (Eqs. serabs2, serabs3).
    terms : the largest term of every order; growth : by how much terms grow an order, from the
        last of them.
    radius : by ratio, 1/growth, in units of the actual mu; pole_radius : modulus of the nearest
        pole of the frequencies' approximants, in the same units (infinite if there is none): a
        hint, since approximants of noisy or short series have poles of their own and miss weak
        ones.
    poles : by seed, complex, in units of mu^2 with alpha, of mu with beta alone.
    residuals, energy_errors : by coordinate order, (order + 1,), relative, over a coarse grid of
        angles; the reasons state the residual of the torus itself.
    resummed_residual : of the torus whose coefficients are Pade sums. certificate : of the
        amplitudes. chain : the model.

    >>> from symfpu import Chain, assess, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)
    >>> assess(series, solve_amplitudes(series))
    Assessment(converged: residual of the equations of motion ... at order 8; ...)
    >>> assess(series, solve_amplitudes(series)).to_frame().shape
    (9, 11)
    """

    word: str
    best_order: int
    reasons: tuple[str, ...]
    order: int
    frequency_order: int
    amplitudes: Mapping[int, tuple[Any, ...]] = field(repr=False)
    differences: Mapping[int, tuple[float, ...]] = field(repr=False)
    root_uncertainty: float
    sums: Mapping[int, tuple[Floats, Floats]] = field(repr=False)
    terms: tuple[LargestTerm, ...] = field(repr=False)
    growth: float
    pole_radius: float
    poles: Mapping[int, NDArray[np.complex128]] = field(repr=False)
    residuals: Floats = field(repr=False)
    energy_errors: Floats = field(repr=False)
    resummed_residual: float
    certificate: RootCertificate | None = field(repr=False)
    chain: Chain | None = field(repr=False, default=None)

    @property
    def radius(self) -> float:
        """Radius of convergence by ratio, in units of the actual mu."""
        return 1 / self.growth if self.growth else math.inf

    @property
    def verdict(self) -> str:
        """The word, with the best order where there is one: what the command line prints."""
        if self.word == "asymptotic":
            return f"asymptotic, best at order {self.best_order}"
        return self.word

    def _lines(self, width: int | None) -> Iterator[str]:
        """The evidence: reasons, radii, and a line for some of the orders."""
        yield from (f"  {reason}" for reason in self.reasons)
        poles = "no pole" if math.isinf(self.pole_radius) else f"{self.pole_radius:.3g}"
        radii = f"{self.radius:.3g} by ratio of terms, "
        radii += f"{poles} by Pade poles of the frequencies (a hint)"
        yield f"  radius of convergence in units of mu: {radii}"
        seed = next(iter(self.sums))
        head = ["order", f"A_{seed}(k)", "dA(k)", f"S_1, S_2 of Q_{seed}"]
        head += ["coarse residual", "energy error", "largest term: mode, harmonic, divisor"]
        rows = [_order_line(self, seed, k) for k in _shown_orders(self)]
        inner_width = None if width is None else width - len(GAP)
        yield from (GAP + line for line in text_table(head, rows, inner_width))

    def _fields(self) -> Iterator[Field]:
        if self.chain is not None:
            yield from chain_fields(self.chain)
        yield Field("verdict", self.verdict)
        yield Field("reasons", list(self.reasons), "reasons", "; ".join(self.reasons))
        found = f"{self.best_order} of {self.order}"
        yield Field("best_order", self.best_order, "best order", found)
        yield Field("order", self.order)
        yield Field("frequency_order", self.frequency_order)
        yield Field("root_uncertainty", short(self.root_uncertainty))
        by_order = self.amplitudes.items()
        amplitudes = {str(K): [text(a, 17) for a in values] for K, values in by_order}
        yield Field("amplitudes_by_frequency_order", amplitudes)
        differences = {str(K): _short(x) for K, x in self.differences.items()}
        yield Field("differences", differences)
        for place, name in enumerate(("S_1", "S_2")):
            sums = {str(q): _short(both[place]) for q, both in self.sums.items()}
            yield Field(name, sums)
        yield Field("largest_terms", [term.entry() for term in self.terms])
        yield Field("growth", short(self.growth))
        radius = f"{self.radius:.3g}"
        yield Field("radius_by_ratio", short(self.radius), "radius in mu, by ratio", radius)
        yield Field("radius_by_poles", short(self.pole_radius))
        least = f"{self.residuals[self.best_order]:.2g}"
        yield Field("residuals", _short(self.residuals), "least residual", least)
        yield Field("energy_errors", _short(self.energy_errors))
        yield Field("resummed_residual", short(self.resummed_residual))
        proof = self.certificate
        yield Field("certified", None if proof is None else proof.certified)

    def __repr__(self) -> str:
        return f"Assessment({self.verdict}: {'; '.join(self.reasons)})"

    def _table(self) -> Table:
        """One row for each order: residual, energy error, largest term, sums, amplitudes."""
        orders = range(self.order + 1)
        largest = {term.order: term for term in self.terms}
        terms = [largest.get(k) for k in orders]
        columns: dict[str, Column] = {
            "order": orders,
            "residual": self.residuals,
            "energy_error": self.energy_errors,
            "largest_term": [math.nan if term is None else term.size for term in terms],
            "term_mode": [None if term is None else term.mode for term in terms],
            "term_harmonic": [
                "" if term is None else joined(term.harmonic) for term in terms
            ],
            "divisor": [math.nan if term is None else term.divisor for term in terms],
        }
        for i, (q, (moduli, cosines)) in enumerate(self.sums.items()):
            columns[f"S1_{q}"], columns[f"S2_{q}"] = moduli, cosines
            found = {K: values[i] for K, values in self.amplitudes.items()}
            changes = {K: values[i] for K, values in self.differences.items()}
            columns[f"amplitude_{q}"] = [found.get(k, math.nan) for k in orders]
            columns[f"difference_{q}"] = [changes.get(k, math.nan) for k in orders]
        return Table(columns, self._attributes())

    def _attributes(self) -> Attributes:
        return attributes(
            self,
            self.chain,
            verdict=self.word,
            best_order=self.best_order,
            reasons="; ".join(self.reasons),
            frequency_order=self.frequency_order,
            root_uncertainty=self.root_uncertainty,
            radius_by_ratio=self.radius,
            radius_by_poles=self.pole_radius,
            resummed_residual=self.resummed_residual,
        )


@public
def assess(
    series: LindstedtSeries,
    torus: Torus[FromSeries],
    *,
    resummed: bool = True,
    progress: Progress | None = None,
) -> Assessment:
    """Judge a series and the torus solved from it (Fig. 1(b), (c) for any torus, and more).

    series : with chosen frequencies. torus : made from this series by `solve_amplitudes`.
    resummed : also judge the torus of Pade sums (the slowest part for long series with digits);
        else, and for travelling waves of a ring, its residual is infinite.
    progress : called as (label, fraction done).

    The residuals, relative and dimensionless, decide: they fall to the last order of a converged
    series, fall and rise again for an asymptotic one; a root that moves with the frequency order,
    or whose best residual is large, is no torus. On a ring residuals are over all angles of the
    waves: two opposite ones may shift against each other. The paper judges by the sums of Eqs.
    serabs2, serabs3; these are among the results.
    Raises InputError if the torus belongs to another series, or to none.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)
    >>> assess(series, solve_amplitudes(series)).word
    'converged'
    """
    if require_series_torus(torus).origin.series is not series:
        allowed = "one solved from this series"
        advice = "call solve_amplitudes(series)"
        raise InputError("torus", "of another series", allowed, advice)
    tell = progress or unheard
    passes = 1 if torus.digits is None else 2
    steps = (torus.origin.order + 1) * passes
    found = _orders(torus, steps, tell)
    evidence = _evidence(torus, found, resummed)
    tell("verdict", 1.0)
    step = steps_of_frequencies(series)
    floor = FLOOR if series.digits is None else min(FLOOR, 10.0**-series.digits)
    return judged(evidence, torus.residual(), step, floor)


def judged(evidence: Assessment, residual: float, step: int, floor: float) -> Assessment:
    """What was measured with its word and reasons.

    residual : of the torus. step : orders between two frequency corrections. floor : residual
    below which nothing is seen.
    """
    word, closing = _word(evidence, step, floor)
    reasons = (*_measures(evidence, residual), *closing)
    return replace(evidence, word=word, reasons=reasons)


def _orders(torus: Torus[FromSeries], steps: int, tell: Progress) -> list[_Order]:
    """All orders in doubles; where doubles see no residual any more, in the digits of the torus."""
    found = []
    for k, order in enumerate(_by_order(torus, DOUBLES)):
        found.append(order)
        tell("verdict", (k + 1) / steps)
    if torus.digits is None:
        return found
    least = min(order.residual for order in found)
    if least < DOUBLES_RESIDUAL:
        for k, order in enumerate(_by_order(torus, MULTIPRECISION)):
            if found[k].residual < DOUBLES_RESIDUAL:
                found[k] = order
            tell("verdict", (torus.origin.order + 2 + k) / steps)
    return found


def _evidence(torus: Torus[FromSeries], found: list[_Order], resummed: bool) -> Assessment:
    """All that is measured, without a word yet."""
    series = torus.origin.series
    residuals = [order.residual for order in found]
    energy_errors = [order.energy_error for order in found]
    terms = [order.largest for order in found if order.largest]
    step = steps_of_frequencies(series)
    orders = frequency_orders(series)
    history = AmplitudeHistory(series.seeds, orders, torus.origin.history, {})
    differences = history.differences()
    root_uncertainty = root_uncertainty_of(
        torus.amplitudes, torus.origin.history, differences
    )
    sums = {}
    for q in series.seeds:
        moduli = np.array([order.moduli[q] for order in found])
        cosines = np.array([order.cosines[q] for order in found])
        sums[q] = (moduli, cosines)
    growth = growth_of(terms, step)
    poles = {q: pade_poles(series, q, torus.amplitudes) for q in torus.seeds}
    pole_radius = pole_radius_of(poles, step)
    sums_up = (
        resummed and not series.chain.periodic
    )  # Pade sums of the coordinates of waves are not known
    resummed_residual = resum(torus).residual() if sums_up else math.inf
    return Assessment(
        word="undecided",
        best_order=int(np.argmin(residuals)),
        reasons=(),
        order=torus.origin.order,
        frequency_order=torus.origin.frequency_order,
        amplitudes=torus.origin.history,
        differences=differences,
        root_uncertainty=root_uncertainty,
        sums=sums,
        terms=tuple(terms),
        growth=growth,
        pole_radius=pole_radius,
        poles=poles,
        residuals=np.array(residuals),
        energy_errors=np.array(energy_errors),
        resummed_residual=resummed_residual,
        certificate=torus.origin.certificate,
        chain=torus.chain,
    )


class _Order(NamedTuple):
    """One order: its largest term, its sums, and errors of the series so far.

    By seed, S_1 and S_2 of its own coordinate.
    """

    largest: LargestTerm | None
    moduli: dict[int, float]
    cosines: dict[int, float]
    residual: float
    energy_error: float


def _by_order(torus: Torus[FromSeries], numbers: Arithmetic) -> Iterator[_Order]:
    series, chain = torus.origin.series, torus.chain
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    points = GRID_POINTS if numbers is DOUBLES else GRID_POINTS_DIGITS
    number = points_of_each_angle(points, len(torus.seeds))
    with numbers.context(torus.digits):
        sums = inside(numbers)
        theta = sums.array(some_angles(torus, number))
        omega = np.array([sums.number(w) for w in torus.frequencies])
        Q: Any = 0
        P: Any = 0
        second: Any = 0
        for k, (nu, exact) in enumerate(torus.origin.terms_by_order):
            values = exact.astype(float) if numbers is DOUBLES else exact
            _, moduli = series.harmonic_terms(amplitudes, k, absolute=True)
            rates = nu @ omega
            angles = theta @ nu.T
            velocities = -rates[:, None] * values
            curvatures = -(rates**2)[:, None] * values
            columns = columns_of(chain, torus.seeds, nu, travels=torus.travels)
            more, curving = columns.modes(angles, [values, curvatures], sums)
            [moving] = columns.modes(angles, [velocities], sums, sine=True)
            Q, P, second = Q + more, P + moving, second + curving
            positions = at_the_face(Q)
            force = chain.accelerations(positions)
            energy = chain.energy(positions, at_the_face(P))
            largest = _largest(torus, k, nu, values, columns)
            S_1 = _seed_sums(moduli, torus.seeds, columns)
            S_2 = _seed_sums(np.abs(values), torus.seeds, columns)
            residual = np.abs(at_the_face(second) - force).max() / np.abs(force).max()
            spread = (energy.max() - energy.min()) / abs(energy.mean())
            yield _Order(largest, S_1, S_2, float(residual), float(spread))


def _seed_sums(
    moduli: Numbers, seeds: tuple[int, ...], columns: Columns
) -> dict[int, float]:
    """The sums over harmonics of what (H, C) has in the modes of the seeds."""
    return {q: float(columns.of_mode(q, moduli).sum()) for q in seeds}


def _largest(
    torus: Torus[FromSeries],
    order: int,
    nu: NDArray[np.int64],
    values: Numbers,
    columns: Columns,
) -> LargestTerm | None:
    sizes = np.abs(values).astype(float) * columns.linear()
    first_largest = int(np.argmax(sizes))
    row, column = np.unravel_index(first_largest, sizes.shape)
    size = float(sizes[row, column])
    if size == 0:
        return None
    harmonic = tuple(map(int, nu[row]))
    mode = columns.mode_of(int(row), int(column))
    smallness = divisor(torus.chain, torus.seeds, torus.frequencies, mode, harmonic)
    return LargestTerm(order, size, mode, harmonic, smallness)


def growth_of(terms: list[LargestTerm], step: int) -> float:
    """Factor from order to order by which the largest terms grow.

    Fitted to the last ones of the last one's parity (alpha).
    """
    alike = []
    for term in terms:
        same_parity = (terms[-1].order - term.order) % step == 0
        if term.size > 0 and term.order > 0 and same_parity:
            alike.append(term)
    last = alike[-RATIO_ORDERS:]
    if len(last) < 2:
        return 0.0
    orders = [term.order for term in last]
    sizes = [term.size for term in last]
    return _ratio(orders, sizes)


def _ratio(
    orders: Sequence[int] | NDArray[np.int64], sizes: Sequence[float] | Floats
) -> float:
    """Factor an order of the geometric series nearest to these sizes, by least squares of logs."""
    slope = np.polyfit(orders, np.log(sizes), 1)[0]
    return float(np.exp(slope))


def pole_radius_of(poles: Mapping[int, NDArray[np.complex128]], step: int) -> float:
    """Modulus of the nearest pole in units of mu; infinite where there is none."""
    moduli = [abs(found[0]) for found in poles.values() if len(found)]
    nearest = min(moduli, default=math.inf)
    return float(nearest ** (1 / step)) if math.isfinite(nearest) else math.inf


def root_uncertainty_of(
    torus_amplitudes: Mapping[int, Any],
    history: Mapping[int, tuple[Any, ...]],
    differences: Mapping[int, tuple[float, ...]],
) -> float:
    """Relative uncertainty of the amplitudes: what the frequency orders still to come would change.

    Where Delta A falls to the last order, the rest of the geometric series that its last values
    suggest; where it has a minimum before, the least change met. Added is how far the torus' own
    order is from there. Infinite if too few have a root.
    """
    amplitudes = np.array([float(a) for a in torus_amplitudes.values()])
    orders = list(differences)
    if len(orders) < 2:
        return math.inf
    largest_changes = []
    for K in orders:
        relative = np.array(differences[K]) / amplitudes
        largest_changes.append(max(relative))
    changes = np.array(largest_changes)
    at = int(np.argmin(changes))
    rest = float(changes[at])
    falls_to_the_end = at == len(orders) - 1
    if falls_to_the_end and rest > FLOOR:
        last = changes[-RATIO_ORDERS:]
        ratio = _ratio(np.arange(len(last)), last)
        rest = rest * ratio / (1 - ratio) if ratio < 1 else math.inf
    best = history.get(orders[at], ())
    there = np.array([float(a) for a in best] or amplitudes)
    distance = np.max(np.abs(there / amplitudes - 1))
    return rest + float(distance)


def _measures(evidence: Assessment, residual: float) -> list[str]:
    """What was measured, in sentences.

    residual : of the torus, over all its angles; those by order, over fewer, tell where it is
        least.
    """
    best = evidence.best_order
    least = float(evidence.residuals[best])
    last = float(evidence.residuals[-1])
    where = f"{residual:.2g} at order {evidence.order}"
    if best < evidence.order:
        where += f", least at order {best}: {least / last:.2g} of it"
    reasons = [f"residual of the equations of motion {where}"]
    if math.isfinite(evidence.root_uncertainty):
        reasons.append(f"amplitudes settle to {evidence.root_uncertainty:.1e}")
    if evidence.terms and evidence.growth:
        growth = f"terms grow by {evidence.growth:.3g} an order"
        reasons.append(f"{growth}, the last being {evidence.terms[-1]!r}")
    if evidence.resummed_residual < SMALLER_SHARE * least:
        reasons.append(f"the resummed torus leaves {evidence.resummed_residual:.2g}")
    certificate = evidence.certificate
    if certificate and not certificate.certified:
        reason = certificate.reason
        reasons.append(f"the root of the truncated series is not certified: {reason}")
    return reasons


def _word(evidence: Assessment, step: int, floor: float) -> tuple[str, tuple[str, ...]]:
    """The verdict, and the sentence that closes its reasons where one is needed.

    step : orders between two frequency corrections; floor : residual below which nothing is seen.
    """
    least = float(evidence.residuals[evidence.best_order])
    uncertainty = evidence.root_uncertainty
    one_root_only = len(evidence.differences) < 2
    if evidence.order < 2 * step or one_root_only:
        return "undecided", ("too few orders to compare",)
    falling = evidence.best_order > evidence.order - step
    shrinking = falling and evidence.growth < 1
    if uncertainty > AGREEMENT:
        return (
            ("undecided", (FALLING_BUT_UNSETTLED,))
            if falling
            else ("not a torus", (UNSETTLED, MAY_BE_FOUND))
        )
    if least > LARGE_RESIDUAL:
        return "not a torus", (NO_TRUNCATION, MAY_BE_FOUND)
    if least < floor or (shrinking and least < SMALL_RESIDUAL):
        return "converged", ()
    if shrinking:
        return "undecided", (STILL_FALLING,)
    return "asymptotic", ()


def _shown_orders(found: Assessment) -> list[int]:
    """At most about a dozen orders: the first, the best, the last, and some between."""
    step = max(1, found.order // SHOWN_ORDERS)
    evenly = range(0, found.order + 1, step)
    return sorted({*evenly, found.best_order, found.order})


def _order_line(found: Assessment, seed: int, k: int) -> list[str]:
    first, second = (sums[k] for sums in found.sums[seed])
    position = list(found.sums).index(seed)
    amplitude = change = largest = ""
    if k in found.amplitudes:
        amplitude = f"{float(found.amplitudes[k][position]):.10g}"
    if k in found.differences:
        change = f"{max(found.differences[k]):.1e}"
    term = next((t for t in found.terms if t.order == k), None)
    if term is not None:
        harmonic = ",".join(map(str, term.harmonic))
        largest = f"{term.size:.1e}: {term.mode}, ({harmonic}), {term.divisor:.1e}"
    sums = f"{first:.1e}, {second:.1e}"
    residual = f"{found.residuals[k]:.1e}"
    energy_error = f"{found.energy_errors[k]:.1e}"
    return [str(k), amplitude, change, sums, residual, energy_error, largest]
