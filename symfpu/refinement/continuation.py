"""Families of tori by pseudo-arclength continuation from the linear limit.

A family keeps the ratio of its amplitudes or mode energies. Its way is measured in the variables (ln |A|, shift / scale) of the seeds,
scale the shift where the step begins: from one member a step goes along the secant of the last two and Newton's method returns to the
family in the plane across it, so that a turn of the energy or of a frequency is passed like any other point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.arithmetic import text
from symfpu.chain import Chain
from symfpu.fourier import FourierTorus, QuasiPeriodic
from symfpu.frequency_shift import frequency_shift
from symfpu.lindstedt import lindstedt
from symfpu.refinement.breathers import PeriodicOrbit
from symfpu.refinement.conditions import Amplitude, Condition, Plane, ratio_conditions
from symfpu.refinement.floquet import Floquet, floquet
from symfpu.refinement.invariance import DIGITS, Floats
from symfpu.refinement.newton import Report
from symfpu.refinement.tori import TOLERANCE, NoTorus, RefinedTorus, refine_at_amplitudes, refined_torus, shifts_of
from symfpu.torus import QTorus

GUESS_ORDER = 2  # of the series that begins a family
FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.3, 0.6, 1e-3  # along the way
EASY, FACTOR = 4, 1.3  # Newton steps up to which the next step along the way is longer, and by how much
KEPT_SCALE = 0.3  # of the largest shift so far, below which the unit of shifts does not fall
ASTRAY = 0.5  # distance from the predicted point, in steps, beyond which a member belongs to another family
SIGNIFICANT = 1e-11  # of the largest coefficient: a divisor of a smaller one may change its sign unnoticed
UNRESOLVED = 1e-6  # residual beyond which a torus is no member
LOCATED, LOCATIONS = 1e-7, 8  # relative change of the place of an event that is enough, and the most members spent on it


@dataclass(frozen=True, eq=False)
class Member:
    """One torus of a family. energy : H, harmonic_energy : sum E_q, both at the angles zero. multipliers : of a breather, if asked for."""

    torus: QuasiPeriodic
    amplitudes: Mapping[int, float]
    energy: float
    harmonic_energy: float
    residual: float
    warnings: tuple[str, ...] = ()
    multipliers: Floquet | None = field(repr=False, default=None)

    @property
    def verdict(self) -> str:
        """'torus', or 'doubtful' with the reasons in `warnings`."""
        return "doubtful" if self.warnings else "torus"

    def __repr__(self) -> str:
        rates = ", ".join(f"omega_{q}={float(w):.12g}" for q, w in zip(self.torus.seeds, self.torus.frequencies, strict=True))
        amplitudes = ", ".join(f"A_{q}={a:.8g}" for q, a in self.amplitudes.items())
        stability = "" if self.multipliers is None else ", stable" if self.multipliers.stable else ", unstable"
        doubts = "".join(f"; {w}" for w in self.warnings)
        return f"Member({self.verdict}, H={self.energy:.10g}, {rates}, {amplitudes}, residual {self.residual:.2g}{stability}{doubts})"


@dataclass(frozen=True)
class Event:
    """Something on the way between the members `after` and `after` + 1.

    kind : 'fold' (what : the quantity that turns), 'resonance' (a divisor changes its sign; mode, harmonic) or 'stability' (what :
    the instability that begins or ends). energy : H there. value : of the quantity that turns, or of the divisor's coefficient.
    """

    kind: str
    what: str
    after: int
    energy: float
    value: float
    mode: int = 0
    harmonic: tuple[int, ...] = ()

    def __repr__(self) -> str:
        where = f"H = {self.energy:.10g}"
        if self.kind == "resonance":
            harmonic = ",".join(map(str, self.harmonic))
            return f"resonance of mode {self.mode} with harmonic ({harmonic}) at {where}, coefficient {self.value:.2g}"
        return f"{self.kind}: {self.what} at {where}" + (f", {self.value:.10g}" if self.kind == "fold" else "")


def first_torus(
    chain: Chain,
    amplitudes: Mapping[int, float],
    *,
    energy_ratio: Mapping[int, float] | None = None,
    tolerance: float = TOLERANCE,
    report: Report = lambda _: None,
) -> RefinedTorus:
    """The torus with these small amplitudes, from a short series about the lowest frequency shift.

    energy_ratio : of the averaged mode energies, by seed; then only the amplitude of the first seed is as given.
    """
    shifts = frequency_shift(chain, amplitudes)
    with mpmath.workdps(DIGITS):
        omega = [Fraction(text(chain.linear_frequency(q) + mpmath.mpf(shifts[q]), 25)) for q in amplitudes]
    series = lindstedt(chain, tuple(amplitudes), omega, GUESS_ORDER)
    guess = QTorus(series, dict(amplitudes), dict.fromkeys(amplitudes, 0.0), 0, GUESS_ORDER)
    if energy_ratio is None:
        return refine_at_amplitudes(guess, amplitudes, tolerance=tolerance, report=report)
    first = Amplitude(0, np.longdouble(next(iter(amplitudes.values()))))
    conditions = [first, *ratio_conditions(tuple(amplitudes), energy_ratio, energies=True)]
    return refined_torus(guess, conditions, tolerance=tolerance, report=report)


def member(torus: RefinedTorus, *, multipliers: bool) -> Member:
    """A torus with its energies, its residual and, for a breather, its multipliers."""
    return Member(
        torus=torus,
        amplitudes=torus.amplitudes,
        energy=float(torus.energy()),
        harmonic_energy=float(torus.harmonic_energies().sum()),
        residual=torus.residual(),
        warnings=torus.warnings,
        multipliers=floquet(periodic(torus)) if multipliers else None,
    )


def periodic(torus: QuasiPeriodic) -> PeriodicOrbit:
    """A torus of one angle as a periodic orbit."""
    order = np.argsort(torus.harmonics[:, 0])
    cosines = np.zeros((int(torus.harmonics[:, 0].max()) + 1, torus.chain.N - 1))
    cosines[torus.harmonics[order, 0]] = torus.cosines[order].astype(float)
    with mpmath.workdps(2 * DIGITS):
        w = mpmath.mpf(torus.frequencies[0].numerator) / torus.frequencies[0].denominator
        sigma = float(w**2 - torus.chain.linear_frequency(torus.seeds[0]) ** 2)
    return PeriodicOrbit(torus.chain, torus.seeds[0], torus.frequencies[0], cosines, torus.residual(), 0, sigma)


class Way:
    """The last two tori of a family, and steps from them."""

    def __init__(
        self,
        ratio: Mapping[int, float],
        *,
        energies: bool,
        tolerance: float,
        report: Report,
        tori: Sequence[RefinedTorus],
        step: float,
        largest: float = 0.0,
    ) -> None:
        self.ratio, self.energies, self.tolerance, self.report = ratio, energies, tolerance, report
        self.tori, self.step = list(tori), step
        self.largest = largest  # relative shift so far

    def scales(self) -> Floats:
        """A size for the shifts of all seeds that vanishes with none of them: the largest relative one, not far below any before."""
        linear = self.tori[0].chain.frequencies()[np.array(self.tori[0].seeds) - 1]
        relative = [float(np.max(np.abs(shifts_of(torus)).astype(float) / linear)) for torus in self.tori[-2:]]
        self.largest = max(self.largest, *relative)
        return np.asarray(max(relative[-1], KEPT_SCALE * self.largest) * linear)

    def _conditions(self, plane: Plane) -> list[Condition]:
        return [plane, *ratio_conditions(tuple(self.ratio), self.ratio, energies=self.energies)]

    def _variables(self, torus: RefinedTorus, scales: Floats) -> Floats:
        A = np.array([np.longdouble(abs(a)) for a in torus.amplitudes.values()])
        return np.concatenate([np.log(A), shifts_of(torus) / scales])

    def at(self, distance: float) -> RefinedTorus:
        """The torus whose way from the last one, along the secant, has this length; raises NoTorus."""
        last, before = self.tori[-1], self.tori[-2]
        scales = self.scales()
        x, difference = self._variables(last, scales), self._variables(last, scales) - self._variables(before, scales)
        length = float(np.linalg.norm(difference.astype(float)))
        tangent = (difference / length).astype(float)
        plane = Plane(tuple(x), tuple(tangent.tolist()), tuple(scales.tolist()), distance)
        found = refined_torus(
            extrapolated(before, last, distance / length), self._conditions(plane), tolerance=self.tolerance, report=self.report
        )
        if min(found.frequencies) <= 0:  # the mirror image of the family behind a saddle
            raise NoTorus("a frequency passes zero", found, found.residual())
        if found.warnings and (residual := found.residual()) > UNRESOLVED:
            raise NoTorus(f"{len(found.harmonics)} harmonics do not resolve it", found, residual)
        off = float(np.linalg.norm((self._variables(found, scales) - x).astype(float) - distance * tangent))
        if off > ASTRAY * max(abs(distance), SMALLEST_STEP):
            raise NoTorus(f"the torus found is {off / abs(distance):.2g} steps off the way", found, found.residual())
        return found

    def advance(self) -> RefinedTorus:
        """The next torus, by the longest step that succeeds; raises NoTorus when none does."""
        while True:
            try:
                found = self.at(self.step)
                break
            except NoTorus:
                if self.step < SMALLEST_STEP:
                    raise
                self.step /= 2
        if len(found.steps) <= EASY:
            self.step = min(self.step * FACTOR, LARGEST_STEP)
        self.tori = [*self.tori[-2:], found]
        return found


def extrapolated(before: QuasiPeriodic, last: QuasiPeriodic, ratio: float) -> FourierTorus:
    """The guess on the line through two tori, `ratio` of their distance beyond the second."""
    rows = {tuple(nu): i for i, nu in enumerate(before.harmonics.tolist())}
    earlier = np.array([before.cosines[rows[nu]] if nu in rows else 0 * last.cosines[0] for nu in map(tuple, last.harmonics.tolist())])
    cosines = last.cosines + ratio * (last.cosines - earlier)
    frequencies = tuple(b + Fraction(ratio) * (b - a) for a, b in zip(before.frequencies, last.frequencies, strict=True))
    return FourierTorus(last.chain, last.seeds, frequencies, last.harmonics, cosines, dict(last.phases))


def quantities(torus: RefinedTorus) -> dict[str, float]:
    """What may turn along a family: energy, shifts of the frequencies, amplitudes."""
    shifts = shifts_of(torus)
    named = {f"omega_{q}": float(x) for q, x in zip(torus.seeds, shifts, strict=True)}
    return {"H": float(torus.energy())} | named | {f"A_{q}": a for q, a in torus.amplitudes.items()}


def resonances(first: RefinedTorus, second: RefinedTorus, after: int) -> Iterator[Event]:
    """The divisors of significant coefficients that change their sign between two tori, the place found by interpolation."""
    rows = {tuple(nu): i for i, nu in enumerate(first.harmonics.tolist())}
    pairs = [(rows[nu], j) for j, nu in enumerate(map(tuple, second.harmonics.tolist())) if nu in rows]
    i, j = (np.array(x) for x in zip(*pairs, strict=True))
    linear = first.chain.frequencies()
    known = []
    for torus, at in ((first, i), (second, j)):
        rates = np.abs(torus.harmonics[at] @ np.array([float(w) for w in torus.frequencies]))
        known.append(rates[:, None] - linear)
    size = np.maximum(np.abs(first.cosines[i]), np.abs(second.cosines[j])) / np.abs(second.cosines).max()
    seeds = np.zeros(size.shape, dtype=bool)
    for k, q in enumerate(first.seeds):
        seeds[:, q - 1] = (np.abs(first.harmonics[i]).sum(axis=1) == 1) & (first.harmonics[i][:, k] == 1)
    for h, q in zip(*np.nonzero((known[0] * known[1] < 0) & (size > SIGNIFICANT) & ~seeds), strict=True):
        part = known[0][h, q] / (known[0][h, q] - known[1][h, q])
        energy = float(first.energy()) + part * (float(second.energy()) - float(first.energy()))
        harmonic = tuple(first.harmonics[i[h]].tolist())
        yield Event("resonance", "divisor", after, energy, float(second.cosines[j[h], q]), int(q) + 1, harmonic)


def folds(way: Way, after: int) -> Iterator[Event]:
    """The quantities that turn at or about the middle of the last three tori, located by a parabola through ever nearer tori."""
    three = way.tori[-3:]
    if len(three) < 3:
        return
    values = [quantities(torus) for torus in three]
    for name in values[0]:
        a, b, c = (v[name] for v in values)
        noise = way.tolerance * max(abs(a), abs(b), abs(c))
        if (b - a) * (c - b) < 0 and min(abs(b - a), abs(c - b)) > noise:
            yield _fold(way, name, after)


def _fold(way: Way, name: str, after: int) -> Event:
    """Newton tori between the last three, at the vertex of the parabola through the best three of all."""
    first, middle, last = way.tori[-3:]
    local = Way(
        way.ratio,
        energies=way.energies,
        tolerance=way.tolerance,
        report=way.report,
        tori=[first, middle],
        step=way.step,
        largest=way.largest,
    )
    scales = local.scales()
    x = [local._variables(torus, scales).astype(float) for torus in (first, middle, last)]
    direction = (x[1] - x[0]) / np.linalg.norm(x[1] - x[0])
    known = {float((y - x[1]) @ direction): torus for y, torus in zip(x, (first, middle, last), strict=True)}
    torus, place = middle, 0.0
    for _ in range(LOCATIONS):
        near = sorted(known, key=lambda s: abs(s - place))[:3]
        vertex = _vertex(near, [quantities(known[s])[name] for s in near])
        if not min(known) <= vertex <= max(known) or abs(vertex - place) < LOCATED:
            break
        try:
            torus, place = local.at(vertex), vertex
        except NoTorus:
            break
        known[vertex] = torus
    value = quantities(torus)[name]
    if name.startswith("omega"):
        value = float(torus.frequencies[torus.seeds.index(int(name.split("_")[1]))])
    return Event("fold", name, after + (place > 0), float(torus.energy()), value)


def _vertex(s: Sequence[float], y: Sequence[float]) -> float:
    second, first, _ = np.polyfit(np.array(s) - s[0], np.array(y) - y[0], 2)
    return float(s[0] - first / (2 * second)) if second else float(s[0])


def stability_change(way: Way, first: Member, second: Member, after: int) -> Event | None:
    """The place between two breathers where one becomes unstable or stable, halved down from the step."""
    if first.multipliers is None or second.multipliers is None or first.multipliers.stable == second.multipliers.stable:
        return None
    before, last = way.tori[-2], way.tori[-1]
    local = Way(
        way.ratio,
        energies=way.energies,
        tolerance=way.tolerance,
        report=way.report,
        tori=[last, before],
        step=way.step,
        largest=way.largest,
    )
    scales = local.scales()
    length = float(np.linalg.norm((local._variables(last, scales) - local._variables(before, scales)).astype(float)))
    low, high, energy = 0.0, -length, first.energy
    for _ in range(LOCATIONS):
        middle = (low + high) / 2
        try:
            torus = local.at(middle)
        except NoTorus:
            break
        stable = floquet(periodic(torus)).stable
        energy = float(torus.energy())
        low, high = (middle, high) if stable == first.multipliers.stable else (low, middle)
    unstable = second.multipliers if first.multipliers.stable else first.multipliers
    change = "begins" if first.multipliers.stable else "ends"
    return Event("stability", f"instability ({', '.join(unstable.instabilities)}) {change}", after, energy, unstable.largest)


Unfinished = Callable[[Member], bool]


def continued(way: Way, start: int, *, multipliers: bool, last: Member, finished: Unfinished) -> Iterator[tuple[Member, list[Event]]]:
    """Members and events from the end of a way on, until `finished` says so; ends with NoTorus where the family cannot be followed."""
    index = start
    while not finished(last):
        torus = way.advance()
        found = member(torus, multipliers=multipliers)
        events = [*folds(way, index - 1), *resonances(way.tori[-2], torus, index)]
        change = stability_change(way, last, found, index)
        yield found, events + ([change] if change else [])
        index, last = index + 1, found
