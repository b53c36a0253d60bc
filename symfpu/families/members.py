"""Members of families, the energies asked for, and what happens between members."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from symfpu.breathers.floquet import Floquet, floquet
from symfpu.breathers.from_rest import AVOIDED, FOLLOWED, NARROW, PASSED
from symfpu.chain.chain import Chain
from symfpu.normal.frequencies import NormalFrequencies
from symfpu.refinement.conditions import Condition, EnergyLevel
from symfpu.refinement.newton import Newton
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, exact_by_seed, fields_of, numbers_by_seed
from symfpu.results.grid import Grid, Variable
from symfpu.results.numbers import fifteen_digits, number_text
from symfpu.results.result import Result, Tabled
from symfpu.results.table import Table
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

ENERGY_TOLERANCE = (
    1e-12  # relative: what an energy asked for and that of a member may differ by
)
NEAR_LIMIT = (
    1.2  # ratio of a gap's width and the limit of narrow ones, within which this is said
)


def linear_by_mode(chain: Chain, modes: Iterable[int]) -> dict[int, float]:
    """Omega of modes of a chain in doubles, in their order."""
    known, numbers = chain.frequencies().tolist(), chain.mode_numbers
    return {q: known[numbers.index(q)] for q in modes}


def harmonic_energy_of(torus: Torus) -> float:
    """Sum E_q at the angles zero; of waves of a ring, nowhere at rest, averaged over the angles."""
    if torus.chain.periodic:
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

    def of(self, torus: Torus) -> float:
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
        return EnergyLevel(np.longdouble(self.energy), self.harmonic)


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

    torus: Torus
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

    def entry(self) -> dict[str, Any]:
        """For the record of a family, which has the chain and the seeds."""
        found: dict[str, Any] = {
            "energy": number_text(self.energy, None),
            "harmonic_energy": number_text(self.harmonic_energy, None),
            "frequencies": exact_by_seed(self.torus.omega),
            "amplitudes": numbers_by_seed(self.amplitudes, self.torus.digits),
            "residual": fifteen_digits(self.residual),
            "verdict": self.verdict,
            "warnings": list(self.warnings),
        }
        if self.multipliers is not None:
            found["stable"] = self.multipliers.stable
            found["largest_multiplier"] = fifteen_digits(self.multipliers.largest)
        if self.normal is not None:
            found["normal"] = self.normal.entry()
        return found

    def _fields(self) -> Iterator[Field]:
        yield from fields_of(self.entry())

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
class Event(Result):
    """Something on the way between two members of a family; dimensionless. Ours.

    after : the number of the first of the two.
    kind : 'fold' (what : the quantity that turns), 'resonance' (what : "divisor", one changes its
        sign; of breathers also "passed", "followed" or "avoided", where it leaves a gap; mode,
        harmonic) or 'stability' (what : the instability that begins or ends).
    energy : H there. value : of the quantity that turns, of the divisor's coefficient, or half
        of the width of a gap in amplitude, relative. Narrower gaps than 1e-3 are passed. At a
        wider one the family goes on with a growing harmonic (followed), or turns back (avoided).
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

    def entry(self) -> dict[str, Any]:
        """For the record of a family; what it is of, by name and by mode and harmonic."""
        return {
            "event": self.kind,
            "what": self.what,
            "after": self.after,
            "energy": number_text(self.energy, None),
            "value": number_text(self.value, None),
            "mode": self.mode or None,
            "harmonic": list(self.harmonic) or None,
            "interpolated": self.interpolated,
        }

    def _fields(self) -> Iterator[Field]:
        yield from fields_of(self.entry())

    def __repr__(self) -> str:
        where = f"H = {self.energy:.10g}"
        if self.interpolated:
            where = f"H = {self.energy:.3g} (interpolated)"
        if self.kind == "resonance":
            harmonic = ",".join(map(str, self.harmonic))
            what = f"mode {self.mode} with harmonic ({harmonic})"
            if self.what in (PASSED, FOLLOWED, AVOIDED):
                gap = f"{self.what}, its gap is {self.value:.2g} of the amplitude"
                near = 1 / NEAR_LIMIT < self.value / NARROW < NEAR_LIMIT
                limit = f", near the limit {NARROW:g} of narrow ones" if near else ""
                return f"resonance of {what} at {where}: {gap}{limit}"
            return f"resonance of {what} at {where}, coefficient {self.value:.2g}"
        value = f", {self.value:.10g}" if self.kind == "fold" else ""
        return f"{self.kind}: {self.what} at {where}{value}"


def member(
    torus: Torus[Newton], *, multipliers: bool, normal: NormalFrequencies | None = None
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


def series_member(torus: Torus[FromSeries]) -> Member:
    """A torus of a series with its energies and its residual."""
    amplitudes = {q: float(a) for q, a in torus.amplitudes.items()}
    energy = float(torus.energy())
    harmonic = float(torus.harmonic_energies().sum())
    return Member(torus, amplitudes, energy, harmonic, torus.residual(), torus.warnings)
