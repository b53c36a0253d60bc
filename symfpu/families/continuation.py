"""Families of tori by pseudo-arclength continuation from the linear limit.

A family keeps the ratio of its amplitudes or mode energies. Its way is measured in the variables
(ln |A|, shift / scale) of the seeds, scale the shift where the step begins: from one member a step
goes along the secant of the last two and Newton's method returns to the family in the plane across
it, so that a turn of the energy or of a frequency is passed like any other point.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.breathers.floquet import Floquet, floquet
from symfpu.chain.chain import Chain
from symfpu.families.extrapolation import FamilyTorus, extrapolated
from symfpu.files.progress import Progress
from symfpu.frames.attributes import attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.recorded import Recorded
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.normal.frequencies import NormalFrequencies
from symfpu.normal.torus import Solution
from symfpu.refinement.conditions import (
    Condition,
    Energy,
    Plane,
    ratio_conditions,
)
from symfpu.refinement.equation import Floats
from symfpu.refinement.guesses import shifts_of
from symfpu.refinement.refined_torus import NoTorus, refined_torus
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.torus import QTorus

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.3, 0.6, 1e-3  # along the way
# the smallest from a doubtful member: near a saddle such ones crawl on without end
DOUBTFUL_STEP = 0.05
EASY_STEPS = 4  # Newton steps up to which the next step along the way is longer
FACTOR = 1.3  # by how much
KEPT_SCALE = (
    0.3  # of the largest shift so far, below which the unit of shifts does not fall
)
# distance from the predicted point, in steps, beyond which a member belongs to another family
DISTANCE_LIMIT = 0.5
RESIDUAL_LIMIT = 1e-6  # residual beyond which a torus is no member
ENERGY_TOLERANCE = (
    1e-12  # relative: what an energy asked for and that of a member may differ by
)
OVERHANG = (
    1e-6  # of the distance of two tori, by which one between them may seem to lie outside
)


def linear_by_mode(chain: Chain, modes: Iterable[int]) -> dict[int, float]:
    """Omega of modes of a chain in doubles, in their order."""
    known, numbers = chain.frequencies().tolist(), chain.mode_numbers
    return {q: known[numbers.index(q)] for q in modes}


def harmonic_energy_of(torus: Solution) -> float:
    """Sum E_q at the angles zero; of waves of a ring, nowhere at rest, averaged over the angles."""
    if isinstance(torus, RingTorus):
        return float(torus.average_spectrum().sum())
    return float(torus.harmonic_energies().sum())


@dataclass(frozen=True)
class Level:
    """An energy asked for, H or with `harmonic` sum E_q; see `harmonic_energy_of`."""

    energy: float
    harmonic: bool

    @property
    def name(self) -> str:
        """The symbol of this energy."""
        return "sum E_q" if self.harmonic else "H"

    def of(self, torus: Solution) -> float:
        """This energy of a torus."""
        return harmonic_energy_of(torus) if self.harmonic else float(torus.energy())

    def of_member(self, found: Member) -> float:
        """This energy of a member, which knows both."""
        return found.harmonic_energy if self.harmonic else found.energy

    def met(self, energy: float) -> bool:
        """Whether an energy is the one asked for."""
        return abs(energy - self.energy) <= ENERGY_TOLERANCE * self.energy

    def passed(self, energy: float) -> bool:
        """Whether an energy is the one asked for, or beyond it."""
        return energy >= self.energy or self.met(energy)

    @property
    def condition(self) -> Condition:
        """For Newton's method."""
        return Energy(np.longdouble(self.energy), self.harmonic)


@dataclass(frozen=True, eq=False)
class Member(Tabled):
    """One torus of a family; dimensionless.

    torus : the solution. amplitudes : by seed. energy : H, harmonic_energy : sum E_q, both at the
        angles zero, of a ring sum E_q averaged over the angles.
    residual : of the equations of motion, relative to the largest acceleration.
        warnings : reasons to doubt it.
    multipliers : of a breather, normal : NormalFrequencies, if asked for. Ours; Appendix A has
        the linear specific energy of Eq. linespe instead.

    >>> from symfpu import Chain, family
    >>> family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005").members[0]
    Member(torus, H=0.0005, omega_1=..., A_1=..., residual ...)
    >>> found = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> found.members[0].to_frame()[["member", "energy", "verdict"]]
       member  energy verdict
    0       0  0.0005   torus
    """

    torus: Solution
    amplitudes: Mapping[int, float]
    energy: float
    harmonic_energy: float
    residual: float
    warnings: tuple[str, ...] = ()
    multipliers: Floquet | None = field(repr=False, default=None)
    normal: NormalFrequencies | None = field(repr=False, default=None)

    @property
    def verdict(self) -> str:
        """'torus', or 'doubtful' with the reasons in `warnings`."""
        return "doubtful" if self.warnings else "torus"

    def __repr__(self) -> str:
        by_seed = zip(self.torus.seeds, self.torus.frequencies, strict=True)
        rates = ", ".join(f"omega_{q}={float(w):.12g}" for q, w in by_seed)
        amplitudes = ", ".join(f"A_{q}={a:.8g}" for q, a in self.amplitudes.items())
        stability = ""
        if self.multipliers is not None:
            stability = ", stable" if self.multipliers.stable else ", unstable"
        if self.normal is not None:
            stability = f", {self.normal.verdict}"
        doubts = "".join(f"; {w}" for w in self.warnings)
        where = f"H={self.energy:.10g}, {rates}, {amplitudes}, residual {self.residual:.2g}"
        return f"Member({self.verdict}, {where}{stability}{doubts})"

    def _table(self) -> Table:
        """One row."""
        return members_grid(self, (self,)).table()


def members_grid(result: object, members: Sequence[Member]) -> Grid:
    """Members of one family, for a result that has them."""
    torus = members[0].torus
    seeds, each = torus.seeds, ("member", "seed")
    frequencies = [[float(w) for w in one.torus.frequencies] for one in members]
    amplitudes = [[float(one.amplitudes[q]) for q in seeds] for one in members]
    spectra = [one.torus.average_spectrum().astype(float) for one in members]
    known = [one.multipliers for one in members]
    largest = [math.nan if found is None else found.largest for found in known]
    plain: dict[str, tuple[Sequence[Any], str]] = {
        "energy": ([one.energy for one in members], "total energy H"),
        "harmonic_energy": ([one.harmonic_energy for one in members], "sum of E_q"),
        "residual": ([one.residual for one in members], "of the equations of motion"),
        "verdict": ([one.verdict for one in members], "torus or doubtful"),
        "warnings": (["; ".join(one.warnings) for one in members], "reasons to doubt it"),
        "largest_multiplier": (largest, "modulus of the largest Floquet multiplier"),
    }
    average = "infinite-time average of the harmonic energy E_q"
    variables = {name: Variable(each[:1], *pair) for name, pair in plain.items()}
    variables["frequency"] = Variable(each, frequencies, "frequency omega_q of a seed")
    variables["amplitude"] = Variable(each, amplitudes, "amplitude A_q of a seed")
    variables["average_energy"] = Variable(("member", "mode"), spectra, average)
    if any(one.normal for one in members):
        variables |= _normal_variables(members)
    return Grid(
        axes={
            "member": range(len(members)),
            "seed": seeds,
            "mode": torus.chain.mode_numbers,
        },
        variables=variables,
        attributes=attributes(result, torus.chain, seeds=seeds),
        rows=("member",),
        across="seed",
    )


def _normal_variables(members: Sequence[Member]) -> dict[str, Variable]:
    """Normal frequencies by member and mode; NaN for seeds and where there are none."""
    modes = members[0].torus.chain.mode_numbers
    unknown = complex(math.nan, math.nan)
    sigma = np.full((len(members), len(modes)), unknown)
    for row, one in enumerate(members):
        known = one.normal.frequencies if one.normal else {}
        for q, value in known.items():
            sigma[row, modes.index(q)] = value
    axes = ("member", "mode")
    return {
        "sigma": Variable(axes, sigma.real, "normal frequency, real part"),
        "growth": Variable(axes, np.abs(sigma.imag), "|Im sigma|: rate of growth"),
    }


@dataclass(frozen=True)
class Event(Recorded):
    """Something on the way between two members of a family; dimensionless. Ours.

    after : the number of the first of the two.
    kind : 'fold' (what : the quantity that turns), 'resonance' (a divisor changes its sign; mode,
        harmonic) or 'stability' (what : the instability that begins or ends).
    energy : H there. value : of the quantity that turns, or of the divisor's coefficient.
    mode, harmonic : q and nu, integers, shape (s,), of a resonance; else 0 and ().
    interpolated : between the members, not found by Newton's method: good to some per cent of
        their distance.

    >>> Event("resonance", "", 3, 0.0125, 1e-9, mode=5, harmonic=(3,))
    resonance of mode 5 with harmonic (3) at H = 0.0125, coefficient 1e-09
    """

    kind: str
    what: str
    after: int
    energy: float
    value: float
    mode: int = 0
    harmonic: tuple[int, ...] = ()
    interpolated: bool = False

    def __repr__(self) -> str:
        where = f"H = {self.energy:.10g}"
        if self.interpolated:
            where = f"H = {self.energy:.3g} (interpolated)"
        if self.kind == "resonance":
            harmonic = ",".join(map(str, self.harmonic))
            what = f"mode {self.mode} with harmonic ({harmonic})"
            return f"resonance of {what} at {where}, coefficient {self.value:.2g}"
        value = f", {self.value:.10g}" if self.kind == "fold" else ""
        return f"{self.kind}: {self.what} at {where}{value}"


def member(
    torus: FamilyTorus, *, multipliers: bool, normal: NormalFrequencies | None = None
) -> Member:
    """A torus with its energies, its residual and, for a breather, its multipliers.

    normal : its normal frequencies, if they are asked for.
    """
    return Member(
        torus=torus,
        amplitudes=torus.amplitudes,
        energy=float(torus.energy()),
        harmonic_energy=harmonic_energy_of(torus),
        residual=torus.residual(),
        warnings=torus.warnings,
        multipliers=floquet(torus) if multipliers else None,
        normal=normal,
    )


def series_member(torus: QTorus) -> Member:
    """A torus of a series with its energies and its residual."""
    amplitudes = {q: float(a) for q, a in torus.amplitudes.items()}
    energy = float(torus.energy())
    harmonic = float(torus.harmonic_energies().sum())
    return Member(torus, amplitudes, energy, harmonic, torus.residual(), torus.warnings)


class Way:
    """The last two tori of a family, and steps from them."""

    def __init__(
        self,
        ratio: Mapping[int, float],
        *,
        energies: bool,
        tolerance: float,
        progress: Progress | None,
        tori: Sequence[FamilyTorus],
        step: float,
        largest: float = 0.0,
    ) -> None:
        self.ratio, self.energies = ratio, energies
        self.tolerance, self.progress = tolerance, progress
        self.tori, self.step = list(tori), step
        self.largest = largest  # relative shift so far

    def local(self, *tori: FamilyTorus) -> Way:
        """The same family from other tori, to look between members."""
        return Way(
            self.ratio,
            energies=self.energies,
            tolerance=self.tolerance,
            progress=self.progress,
            tori=tori,
            step=self.step,
            largest=self.largest,
        )

    def scales(self) -> Floats:
        """A size for the shifts of all seeds that vanishes with none of them.

        The largest relative one, not far below any before.
        """
        torus = self.tori[0]
        linear = np.array(list(linear_by_mode(torus.chain, torus.seeds).values()))
        shifts = [np.abs(shifts_of(torus)).astype(float) for torus in self.tori[-2:]]
        relative = [float(np.max(shift / linear)) for shift in shifts]
        self.largest = max(self.largest, *relative)
        size = max(relative[-1], KEPT_SCALE * self.largest)
        return np.asarray(size * linear)

    def _conditions(self, first: Condition) -> list[Condition]:
        """A condition, and the ratio that the family keeps."""
        ratio = ratio_conditions(tuple(self.ratio), self.ratio, energies=self.energies)
        return [first, *ratio]

    def variables(self, torus: FamilyTorus, scales: Floats) -> Floats:
        """Where a torus is, (ln |A| of the seeds, shifts in units of scales), shape (2s,)."""
        A = np.array([np.longdouble(abs(a)) for a in torus.amplitudes.values()])
        shifts = shifts_of(torus) / scales
        return np.concatenate([np.log(A), shifts])

    def at(self, distance: float) -> FamilyTorus:
        """The torus at this length of way from the last one, along the secant; raises NoTorus."""
        before, last = self.tori[-2:]
        scales = self.scales()
        x = self.variables(last, scales)
        difference = x - self.variables(before, scales)
        length = float(np.linalg.norm(difference.astype(float)))
        tangent = (difference / length).astype(float)
        plane = Plane(tuple(x), tuple(tangent.tolist()), tuple(scales.tolist()), distance)
        guess = extrapolated(before, last, distance / length)
        conditions = self._conditions(plane)
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        _require_resolved(found)
        gone = (self.variables(found, scales) - x).astype(float)
        off = float(np.linalg.norm(gone - distance * tangent))
        if off > DISTANCE_LIMIT * max(abs(distance), SMALLEST_STEP):
            reason = f"the torus found is {off / abs(distance):.2g} steps off the way"
            raise NoTorus(reason, found, found.residual())
        return found

    def between(self, level: Level) -> FamilyTorus:
        """The torus of an energy between those of the last two; raises NoTorus."""
        before, last = self.tori[-2:]
        low, high = level.of(before), level.of(last)
        part = (level.energy - low) / (high - low)
        conditions = self._conditions(level.condition)
        guess = extrapolated(before, last, part - 1)
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        _require_resolved(found)
        along, astray = self.place(found)
        if astray > DISTANCE_LIMIT or not -OVERHANG <= along <= 1 + OVERHANG:
            torus = f"the torus of {level.name} = {level.energy:.6g}"
            raise NoTorus(f"{torus} is not between two neighbours", found, found.residual())
        return found

    def meeting(self, condition: Condition, guess: Solution) -> FamilyTorus:
        """The torus of a condition between the last two, from a guess.

        Raises NoTorus, also for one that is elsewhere or doubtful.
        """
        conditions = self._conditions(condition)
        found = refined_torus(
            guess, conditions, tolerance=self.tolerance, progress=self.progress
        )
        along, astray = self.place(found)
        if astray > DISTANCE_LIMIT or not 0 <= along <= 1 or found.warnings:
            raise NoTorus("it is not between two neighbours", found, found.residual())
        return found

    def place(self, torus: FamilyTorus) -> tuple[float, float]:
        """How far along the way between the last two tori another one is, and how far off it.

        Both in the distance of the two.
        """
        scales = self.scales()
        three = (*self.tori[-2:], torus)
        start, end, here = (self.variables(x, scales).astype(float) for x in three)
        secant, gone = end - start, here - start
        along = float(gone @ secant) / float(secant @ secant)
        off = float(np.linalg.norm(gone - along * secant))
        return along, off / float(np.linalg.norm(secant))

    def advance(self, goal: Level) -> FamilyTorus:
        """The next torus, by the longest step that succeeds.

        That of the goal where it leads beyond. Raises NoTorus when none does.
        """
        while True:
            try:
                found = self.at(self.step)
                if goal.passed(reached := goal.of(found)) and not goal.met(reached):
                    found = self.local(self.tori[-1], found).between(goal)
                break
            except NoTorus:
                smallest = DOUBTFUL_STEP if self.tori[-1].warnings else SMALLEST_STEP
                if self.step < smallest:
                    raise
                self.step /= 2
        if len(found.steps) <= EASY_STEPS:
            self.step = min(self.step * FACTOR, LARGEST_STEP)
        self.tori = [*self.tori[-2:], found]
        return found


def _require_resolved(found: FamilyTorus) -> None:
    """Raises NoTorus for what is no member of a family."""
    if min(found.frequencies) <= 0:  # the mirror image of the family behind a saddle
        raise NoTorus("a frequency passes zero", found, found.residual())
    if found.warnings and (residual := found.residual()) > RESIDUAL_LIMIT:
        raise NoTorus(
            f"{len(found.harmonics)} harmonics do not resolve it", found, residual
        )
