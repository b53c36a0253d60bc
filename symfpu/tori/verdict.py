"""A judgement of a series and its torus: does it converge, where is it best cut, is the root a torus at all?

One word first, the evidence after: amplitudes by order, sizes of terms and what carries them, residuals of the equations of
motion and constancy of the energy at every order, radius of convergence by ratio and by Pade poles, and the resummed torus.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION, Arithmetic, Numbers, text
from symfpu.series.divisors import divisor
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, frequency_orders
from symfpu.tori.quasiperiodic import GRID_POINTS_DIGITS, SEEN_BY_DOUBLES
from symfpu.tori.resummation import pade_poles, resum
from symfpu.tori.torus import QTorus, RootCertificate

Floats = NDArray[np.float64]
Progress = Callable[[int, int], None]

AGREEMENT = 1e-3  # relative uncertainty of an amplitude above which the root is not stable under the order
LARGE_RESIDUAL = 1e-3  # relative residual that no truncation of a torus' series should exceed at its best order
SMALL_RESIDUAL = 1e-7  # relative residual to which a series must have fallen to be called converged
FLOOR = 1e-12  # relative residual of doubles at which nothing more can be seen
CLEARLY = 0.9  # of another residual, below which one is called smaller
RATIO_ORDERS = 4  # how many of the last orders a growth ratio is fitted to
GRID_POINTS, MOST_POINTS = 512, 1024  # angles at which residuals by order are taken, about, in doubles, and at most


@dataclass(frozen=True)
class LargestTerm:
    """The largest term of one order: Omega_q |c_q[nu]| with its mode, harmonic and divisor lambda_q - (nu.omega)^2."""

    order: int
    size: float
    mode: int
    harmonic: tuple[int, ...]
    divisor: float

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        return f"{self.size:.2g} at mode {self.mode}, harmonic ({harmonic}), divisor {self.divisor:.2g}"


@dataclass(frozen=True, eq=False)
class Assessment:
    """What `assess` found; dimensionless numbers.

    word : 'converged', 'asymptotic', 'not a torus', or 'undecided' where too few orders are known.
    best_order : coordinate order of the least residual. reasons : why this word, in sentences.
    order, frequency_order : of the torus' coordinates and frequencies.
    amplitudes : K -> A(K), (s,), by frequency order; differences : K -> Delta A(K), (s,) (Fig. 1(b)).
    root_uncertainty : what later frequency orders would change of the amplitudes, relative.
    sums : by seed, mu^k S_1(k) and mu^k S_2(k) of its own coordinate, (order + 1,) each (Eqs. serabs2,
        serabs3).
    terms : the largest term of every order; growth : by how much terms grow an order, from the last of them.
    radius : by ratio, 1/growth, in units of the actual mu; pole_radius : modulus of the nearest pole of the
        frequencies' approximants, in the same units (infinite if there is none): a hint, since approximants
        of noisy or short series have poles of their own and miss weak ones.
    poles : by seed, complex, in units of mu^2 with alpha, of mu with beta alone.
    residuals, energy_errors : by coordinate order, (order + 1,), relative, over a coarse grid of angles;
        the reasons state the residual of the torus itself.
    resummed_residual : of the torus whose coefficients are Pade sums. certificate : of the amplitudes.

    >>> from symfpu import Chain, assess, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)
    >>> assess(series, solve_amplitudes(series))
    Assessment(converged: residual of the equations of motion ... at order 8; ...)
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

    @property
    def radius(self) -> float:
        """Radius of convergence by ratio, in units of the actual mu."""
        return 1 / self.growth if self.growth else math.inf

    @property
    def headline(self) -> str:
        """The verdict in a few words."""
        return f"asymptotic, best at order {self.best_order}" if self.word == "asymptotic" else self.word

    def __repr__(self) -> str:
        return f"Assessment({self.headline}: {'; '.join(self.reasons)})"

    def record(self) -> dict[str, Any]:
        """All of it as JSON can hold it; numbers of more than 15 digits as strings."""
        digits = 17
        return {
            "verdict": self.headline,
            "reasons": list(self.reasons),
            "best_order": self.best_order,
            "order": self.order,
            "frequency_order": self.frequency_order,
            "root_uncertainty": short(self.root_uncertainty),
            "amplitudes_by_frequency_order": {str(k): [text(a, digits) for a in v] for k, v in self.amplitudes.items()},
            "differences": {str(k): [short(x) for x in v] for k, v in self.differences.items()},
            "S_1": {str(q): [short(x) for x in s] for q, (s, _) in self.sums.items()},
            "S_2": {str(q): [short(x) for x in s] for q, (_, s) in self.sums.items()},
            "largest_terms": [
                {"order": t.order, "size": short(t.size), "mode": t.mode, "harmonic": list(t.harmonic), "divisor": short(t.divisor)}
                for t in self.terms
            ],
            "growth": short(self.growth),
            "radius_by_ratio": short(self.radius),
            "radius_by_poles": short(self.pole_radius),
            "residuals": [short(x) for x in self.residuals],
            "energy_errors": [short(x) for x in self.energy_errors],
            "resummed_residual": short(self.resummed_residual),
            "certified": None if self.certificate is None else self.certificate.certified,
        }


def short(value: float) -> float | None:
    """A measure for JSON, to six digits; None where it is infinite or not a number."""
    return float(f"{value:.6g}") if math.isfinite(value) else None


def assess(series: LindstedtSeries, torus: QTorus, *, resummed: bool = True, progress: Progress | None = None) -> Assessment:
    """Judge a series and the torus solved from it (Fig. 1(b), (c) of the paper for any torus, and more).

    series : with chosen frequencies. torus : made from this series by `solve_amplitudes`.
    resummed : also judge the torus of Pade sums (the slowest part for long series with digits); else its
        residual is infinite.
    progress : called as (steps done, steps).

    The residuals, relative and dimensionless, decide: they fall to the last order of a converged series, fall
    and rise again for an asymptotic one; a root that moves with the frequency order, or whose best residual
    is large, is no torus. The paper judges by the sums of Eqs. serabs2, serabs3; these are among the results.
    Raises InputError if the torus belongs to another series.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)
    >>> assess(series, solve_amplitudes(series)).word
    'converged'
    """
    if torus.series is not series:
        raise InputError("torus", "of another series", "one solved from this series", "call solve_amplitudes(series)")
    advance = progress or (lambda done, total: None)
    steps = (torus.order + 1) * (1 if torus.digits is None else 2)
    found = []
    for k, order in enumerate(_by_order(torus, DOUBLES)):
        found.append(order)
        advance(k + 1, steps)
    if torus.digits is not None and min(order.residual for order in found) < SEEN_BY_DOUBLES:
        for k, order in enumerate(_by_order(torus, MULTIPRECISION)):
            if found[k].residual < SEEN_BY_DOUBLES:
                found[k] = order
            advance(torus.order + 2 + k, steps)
    residuals = [order.residual for order in found]
    terms = [order.largest for order in found if order.largest]
    differences = AmplitudeHistory(series.seeds, frequency_orders(series), torus.history, {}).differences()
    evidence = Assessment(
        word="undecided",
        best_order=int(np.argmin(residuals)),
        reasons=(),
        order=torus.order,
        frequency_order=torus.frequency_order,
        amplitudes=torus.history,
        differences=differences,
        root_uncertainty=_root_uncertainty(torus, differences),
        sums={q: (np.array([o.moduli[q] for o in found]), np.array([o.cosines[q] for o in found])) for q in series.seeds},
        terms=tuple(terms),
        growth=_growth(terms, 2 // series.chain.degree_step),
        **_poles(torus),
        residuals=np.array(residuals),
        energy_errors=np.array([order.energy_error for order in found]),
        resummed_residual=resum(torus).residual() if resummed else math.inf,
        certificate=torus.certificate,
    )
    advance(steps, steps)
    word, reasons = _judge(evidence, series, torus.residual())
    return replace(evidence, word=word, reasons=reasons)


class _Order(NamedTuple):
    """One order: its largest term, by seed the sums S_1 and S_2 of its own coordinate, and errors of the series so far."""

    largest: LargestTerm | None
    moduli: dict[int, float]
    cosines: dict[int, float]
    residual: float
    energy_error: float


def _by_order(torus: QTorus, numbers: Arithmetic) -> Iterator[_Order]:
    series = torus.series
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    number = max(2, min(64, round((GRID_POINTS if numbers is DOUBLES else GRID_POINTS_DIGITS) ** (1 / len(torus.seeds)))))
    with numbers.context(torus.digits):
        theta = numbers.array(_angles(torus, number))
        omega = numbers.array([numbers.number(w) for w in torus.frequencies])
        Q, P, second = (numbers.zeros((len(theta), torus.chain.N - 1)) for _ in range(3))
        for k in range(torus.order + 1):
            nu, exact = series.harmonic_terms(amplitudes, k)
            values = exact.astype(float) if numbers is DOUBLES else exact
            moduli = series.harmonic_terms(amplitudes, k, absolute=True)[1]
            rates, angles = nu @ omega, theta @ nu.T
            cosines, sines = numbers.cos(angles), numbers.sin(angles)
            Q = Q + numbers.dot(cosines, values)
            P = P - numbers.dot(sines, rates[:, None] * values)
            second = second - numbers.dot(cosines, (rates**2)[:, None] * values)
            force, energy = torus.chain.accelerations(Q), torus.chain.energy(Q, P)
            yield _Order(
                _largest(torus, k, nu, values),
                {q: float(moduli[:, q - 1].sum()) for q in torus.seeds},
                {q: float(np.abs(values[:, q - 1]).sum()) for q in torus.seeds},
                float(np.abs(second - force).max() / np.abs(force).max()),
                float((energy.max() - energy.min()) / abs(energy.mean())),
            )


def _angles(torus: QTorus, number: int) -> Numbers:
    """A tensor grid of angles; for many seeds, where even two points for each are too many, points drawn at random."""
    s = len(torus.seeds)
    if number**s <= MOST_POINTS:
        return np.concatenate(list(torus.angle_grid(number)))
    return 2 * np.pi * np.random.default_rng(s).random((MOST_POINTS, s))


def _largest(torus: QTorus, order: int, nu: NDArray[np.int64], values: Numbers) -> LargestTerm | None:
    sizes = np.abs(values).astype(float) * torus.chain.frequencies()
    row, column = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    if sizes[row, column] == 0:
        return None
    harmonic, mode = tuple(map(int, nu[row])), int(column) + 1
    return LargestTerm(
        order, float(sizes[row, column]), mode, harmonic, divisor(torus.chain, torus.seeds, torus.frequencies, mode, harmonic)
    )


def _growth(terms: list[LargestTerm], step: int) -> float:
    """Factor from order to order by which the largest terms grow, fitted to the last ones of the last one's parity (alpha)."""
    alike = [t for t in terms if t.size > 0 and t.order > 0 and (terms[-1].order - t.order) % step == 0]
    last = alike[-RATIO_ORDERS:]
    if len(last) < 2:
        return 0.0
    return float(np.exp(np.polyfit([t.order for t in last], np.log([t.size for t in last]), 1)[0]))


def _poles(torus: QTorus) -> dict[str, Any]:
    poles = {q: pade_poles(torus.series, q, torus.amplitudes) for q in torus.seeds}
    nearest = min((abs(p[0]) for p in poles.values() if len(p)), default=math.inf)
    step = 2 // torus.chain.degree_step
    return {"poles": poles, "pole_radius": float(nearest ** (1 / step)) if math.isfinite(nearest) else math.inf}


def _root_uncertainty(torus: QTorus, differences: Mapping[int, tuple[float, ...]]) -> float:
    """Relative uncertainty of the amplitudes: what the frequency orders still to come would change.

    Where Delta A falls to the last order, the rest of the geometric series that its last values suggest; where it has a
    minimum before, the least change met. Added is how far the torus' own order is from there. Infinite if too few have a root.
    """
    amplitudes = np.array([float(a) for a in torus.amplitudes.values()])
    orders = list(differences)
    if len(orders) < 2:
        return math.inf
    changes = np.array([max(np.array(differences[k]) / amplitudes) for k in orders])
    at = int(np.argmin(changes))
    rest = float(changes[at])
    if at == len(orders) - 1 and rest > FLOOR:
        last = changes[-RATIO_ORDERS:]
        ratio = float(np.exp(np.polyfit(np.arange(len(last)), np.log(last), 1)[0]))
        rest = rest * ratio / (1 - ratio) if ratio < 1 else math.inf
    there = np.array([float(a) for a in torus.history.get(orders[at], ())] or amplitudes)
    return rest + float(np.max(np.abs(there / amplitudes - 1)))


def _judge(evidence: Assessment, series: LindstedtSeries, residual: float) -> tuple[str, tuple[str, ...]]:
    """The word and its reasons.

    residual : of the torus, over all its angles; those by order, over fewer, tell where it is least.
    """
    residuals, best = evidence.residuals, evidence.best_order
    least, last = float(residuals[best]), float(residuals[-1])
    step = 2 // series.chain.degree_step
    floor = FLOOR if series.digits is None else min(FLOOR, 10.0**-series.digits)
    reasons = [f"residual of the equations of motion {residual:.2g} at order {evidence.order}"]
    if best < evidence.order:
        reasons[0] += f", least at order {best}: {least / last:.2g} of it"
    if math.isfinite(evidence.root_uncertainty):
        reasons.append(f"amplitudes settle to {evidence.root_uncertainty:.1e}")
    if evidence.terms and evidence.growth:
        reasons.append(f"terms grow by {evidence.growth:.3g} an order, the last being {evidence.terms[-1]!r}")
    if evidence.resummed_residual < CLEARLY * least:
        reasons.append(f"the resummed torus leaves {evidence.resummed_residual:.2g}")
    if evidence.certificate and not evidence.certificate.certified:
        reasons.append(f"the root of the truncated series is not certified: {evidence.certificate.reason}")
    if evidence.order < 2 * step or (not math.isfinite(evidence.root_uncertainty) and least > floor):
        return "undecided", (*reasons, "too few orders to compare")
    falling = best > evidence.order - step
    if evidence.root_uncertainty > AGREEMENT and falling:
        return "undecided", (*reasons, "the residual still falls, but the root has not settled: more orders are needed")
    if evidence.root_uncertainty > AGREEMENT:
        return "not a torus", (*reasons, "the root does not settle with the frequency order: it is one of the truncated polynomial only")
    if least > LARGE_RESIDUAL:
        return "not a torus", (*reasons, "no truncation meets the equations of motion")
    if least < floor or (falling and evidence.growth < 1 and least < SMALL_RESIDUAL):
        return "converged", tuple(reasons)
    if falling and evidence.growth < 1:
        return "undecided", (*reasons, "the residual still falls: more orders would tell whether it goes on")
    return "asymptotic", tuple(reasons)
