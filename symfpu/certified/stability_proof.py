"""Stability that is proved: every Floquet exponent of a proved breather enclosed by a theorem.

One Newton-Kantorovich problem for each exponent in Fourier space, no integrator in the proof:
docs/stability-proofs.md.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from symfpu.certified.border import FREQUENCY
from symfpu.certified.enclosures import (
    ADVICE,
    Enclosed,
    NoStabilityProof,
    check_count,
    enclosed_all,
)
from symfpu.certified.existence import HALF_A_RING, ExistenceProof, prove_existence
from symfpu.certified.exponent_bounds import RoundedZero, Slopes
from symfpu.certified.exponents import guesses
from symfpu.certified.layout import layout_of
from symfpu.certified.rounded_orbit import RoundedOrbit
from symfpu.certified.sectors import Sector, sectors_of
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.counted import counted
from symfpu.numbers.one_sided import above, below
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal
from symfpu.proofs.certified import Certified
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, seeds_field
from symfpu.results.numbers import fifteen_digits
from symfpu.results.table import Table
from symfpu.tori.torus import Torus

FORMAT = "symfpu stability certificate"
SCHEMA = 1


@dataclass(frozen=True)
class ProvedExponent:
    """sigma of a Floquet solution exp(i sigma t) x (periodic), in a proved interval or disc.

    sector : its number. sigma : the middle, complex off the circle, with Im sigma < 0 for the
    growing solution. radius : above its error, in |Re| + |Im|. mode, harmonic : sigma + harmonic
    omega is, up to sign, near the linear frequency of this mode. harmonics, folds : sigma counts
    modulo folds omega. circle : whether the multiplier lies on the unit circle. linear : Z.
    block : size of the dense part. Made by `prove_stability`.
    """

    sector: int
    sigma: complex
    radius: float
    mode: int
    harmonic: int
    folds: int
    circle: bool
    linear: float
    block: int

    def entry(self) -> dict[str, Any]:
        """For a record; sigma of a hyperbolic one as [re, im]."""
        sigma = fifteen_digits(self.sigma.real)
        return {
            "mode": self.mode,
            "harmonic": self.harmonic,
            "sector": self.sector,
            "sigma": sigma if self.circle else [sigma, fifteen_digits(self.sigma.imag)],
            "radius": fifteen_digits(self.radius),
            "growth": [fifteen_digits(x) for x in self.growth],
        }

    @property
    def growth(self) -> tuple[float, float]:
        """Ends of an interval that holds the rate of growth; (0, 0) on the circle."""
        if self.circle:
            return 0.0, 0.0
        rate = abs(self.sigma.imag)
        return rate - self.radius, rate + self.radius

    def multiplier(self, omega: float) -> complex:
        """exp(2 pi i sigma / omega) at the middle."""
        return cmath.exp(2j * math.pi * self.sigma / omega)


@dataclass(frozen=True)
class Gap:
    """Distance in units of omega between neighbours of a sector, sigma in 0 .. h omega/2.

    least, most : it is between them. sector : number. between : the two, as text.
    """

    least: float
    most: float
    sector: int
    between: tuple[str, str]


MOST_GAPS = 5  # that readers see


@public
@dataclass(frozen=True, eq=False, kw_only=True)
class StabilityProof(Certified):
    """A theorem: a breather is linearly stable, or unstable.

    existence : the theorem on the orbit. stable : which of the two. exponents : those enclosed,
        all of them up to sign if stable, else those that grow. gaps : of a stable orbit, ascending;
        an empty tuple for an unstable one. theorem : in one sentence. body : the certificate
        without its digest. Dimensionless. Ours: docs/stability-proofs.md.

    >>> import symfpu
    >>> from symfpu import Chain, prove_stability
    >>> prove_stability(symfpu.torus(Chain(N=8, alpha="0.3"), (1,), frequencies=("0.3905",)))
    StabilityProof(N=8, alpha=0.3, seed 1, omega=0.3905: linearly stable, 6 exponents within ...,
    smallest gap 0.0110... omega)
    """

    existence: ExistenceProof
    stable: bool
    exponents: tuple[ProvedExponent, ...]
    gaps: tuple[Gap, ...]
    body: dict[str, Any] = field(repr=False)

    def _certificate_body(self) -> dict[str, Any]:
        return self.body

    def _lines(self, width: int | None) -> Iterator[str]:
        """The theorem, the smallest gaps or the growth, and the bounds."""
        orbit = self.existence
        word = "linearly stable" if self.stable else "linearly unstable"
        given = f"omega = {decimal(orbit.frequency)}"
        if orbit.fixed != "frequency":
            given = f"{orbit.condition}, {given} +- {above(orbit.frequency_radius, 1)}"
        yield f"{orbit.chain.label}, seed {orbit.seed}, {given}: {word}, proved"
        yield f"  {self.theorem}"
        for gap in self.gaps[:MOST_GAPS]:
            left, right = gap.between
            span = f"{below(gap.least, 6)} .. {above(gap.most, 6)} omega"
            yield f"  gap {span}: {left}; {right}"
        for one in self.exponents:
            if not one.circle:
                least, most = one.growth
                yield (
                    f"  sigma = {one.sigma:.10g} within {above(one.radius, 2)}: "
                    f"grows with a rate of {below(least, 9)} .. {above(most, 9)}"
                )
        count = counted(len(self.exponents), "exponent")
        largest = max((e.block for e in self.exponents), default=0)
        linear = max((e.linear for e in self.exponents), default=0.0)
        yield f"  {count}; Z up to {linear:.3g}, blocks up to {largest}"

    def _fields(self) -> Iterator[Field]:
        orbit = self.existence
        yield from chain_fields(orbit.chain)
        yield seeds_field((orbit.seed,))
        yield Field("frequencies", {str(orbit.seed): decimal(orbit.frequency)})
        yield Field("proved", True)
        yield Field("stable", self.stable)
        yield Field("theorem", self.theorem, "theorem")
        yield Field("radius", fifteen_digits(orbit.radius))
        gaps = [[fifteen_digits(g.least), fifteen_digits(g.most)] for g in self.gaps]
        yield Field("gaps", gaps)
        yield Field("growth", [fifteen_digits(x) for x in self.growth])
        yield Field("exponents", [one.entry() for one in self.exponents])

    def __repr__(self) -> str:
        proof = self.existence
        chain = proof.chain.label
        case = f"{chain}, seed {proof.seed}, {proof.condition}"
        return f"StabilityProof({case}: {self._found()})"

    def _found(self) -> str:
        widest = max((e.radius for e in self.exponents), default=0.0)
        if not self.stable:
            least, most = self.growth
            return (
                f"linearly unstable, growth rate in {below(least, 9)} .. {above(most, 9)}"
            )
        count = f"{counted(len(self.exponents), 'exponent')} within {above(widest, 1)}"
        gap = f", smallest gap {below(self.gaps[0].least, 5)} omega" if self.gaps else ""
        return f"linearly stable, {count}{gap}"

    @property
    def growth(self) -> tuple[float, float]:
        """Ends of an interval that holds the largest enclosed rate of growth; (0, 0) if stable."""
        return max((e.growth for e in self.exponents), default=(0.0, 0.0))

    @property
    def theorem(self) -> str:
        """What is proved, in one sentence."""
        proof = self.existence
        chain = repr(proof.chain)
        given = proof.condition
        if proof.fixed == FREQUENCY:
            given = f"frequency {decimal(proof.frequency)}"
        orbit = f"the periodic orbit of {chain} with {given}"
        where = f"within {above(proof.radius, 2)} of the computed one"
        if not self.stable:
            least, most = self.growth
            return (
                f"{orbit} {where} is linearly unstable: a solution of the linearised equations "
                f"grows with a rate between {below(least, 10)} and {above(most, 10)}"
            )
        gap = f", {below(self.gaps[0].least, 3)} omega or more apart" if self.gaps else ""
        return (
            f"{orbit} {where} is linearly stable: all multipliers lie on the unit circle, 1 is "
            f"double and all others are simple within their symmetry sector{gap}"
        )

    def _table(self) -> Table:
        """One row for each exponent."""
        rows, proof = self.exponents, self.existence
        frequency = proof.frequency
        known = attributes(
            self,
            proof.chain,
            seeds=(proof.seed,),
            frequencies=(frequency,),
            stable=self.stable,
        )
        columns: dict[str, list[Any]] = {
            "mode": [e.mode for e in rows],
            "harmonic": [e.harmonic for e in rows],
            "sigma": [e.sigma.real for e in rows],
            "growth": [abs(e.sigma.imag) for e in rows],
            "radius": [e.radius for e in rows],
            "circle": [e.circle for e in rows],
            "sector": [e.sector for e in rows],
        }
        return Table(columns, known)


@public
def prove_stability(
    solution: ExistenceProof | Torus,
    *,
    amplitude: Number | None = None,
    energy: Number | None = None,
    progress: Progress | None = None,
) -> StabilityProof:
    """A proof that a breather is linearly stable, or unstable, or an error that says why not.

    solution : a breather as `prove_existence` takes it, or its proof, which then is not made again.
    amplitude, energy : that of the orbit, as of `prove_existence`: its frequency then is in an
        interval. A breather whose frequency does not tell it from its neighbours needs one of them.
    progress : called as (label, fraction done).

    Every Floquet exponent is enclosed by a contraction in Fourier space around the proved orbit,
    whose own radius enters; all of them, distinct and on the circle, make the orbit stable, one
    that grows makes it unstable (docs/stability-proofs.md; ours). Dimensionless.
    Raises InputError and NoExistenceProof as `prove_existence` does; NoStabilityProof with the
    exponent and the bound that failed: that proves nothing.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> prove_stability(symfpu.torus(Chain(N=6, beta=1), (4,), amplitudes={4: "0.6"}))
    StabilityProof(N=6, beta=1, seed 4, omega=1.9005...: linearly unstable, growth rate in
    0.02488... .. 0.02488...)
    """
    require_no_ring(solution)
    proof = proof_of(solution, amplitude, energy)
    orbit = orbit_of(proof)
    sectors = sectors_of(orbit.chain, orbit.seed)
    found = [guesses(orbit, sector) for sector in sectors]
    growing = [guess for one in found for guess in one if not guess.circle]
    tried = growing or [guess for one in found for guess in one]
    if not growing:
        check_count(sectors, found)
    radius, off = proof.body["radius"], proof.frequency_radius
    slopes, enclosed = enclosed_all(orbit, radius, tried, progress or unheard, off)
    frequency = Interval(orbit.omega, Fraction(off))
    rows = [proved_exponent(one, sectors, frequency) for one in enclosed]
    gaps = () if growing else tuple(gaps_of(frequency, sectors, enclosed))
    body = certificate_body(proof, slopes, sectors, enclosed, stable=not growing)
    return StabilityProof(
        existence=proof,
        stable=not growing,
        exponents=tuple(rows),
        gaps=gaps,
        body=body,
    )


def require_no_ring(solution: object) -> None:
    """Waves of a ring are proved to exist, and no more."""
    chain = getattr(solution, "chain", None)
    if chain is not None and chain.periodic:
        given, allowed = f"a wave of {chain!r}", "a breather of a chain with fixed ends"
        advice = "prove_existence takes waves; normal_modes has their frequencies"
        if getattr(solution, "stands", False):
            given, advice = f"a standing wave of {chain!r}", HALF_A_RING
        raise InputError("solution", given, allowed, advice)


def proof_of(
    solution: ExistenceProof | Torus,
    amplitude: Number | None,
    energy: Number | None,
) -> ExistenceProof:
    """That the orbit exists; the theorem is about one orbit, not about a segment."""
    if not isinstance(solution, ExistenceProof):
        return prove_existence(solution, amplitude=amplitude, energy=energy)
    for name, value in {"amplitude": amplitude, "energy": energy}.items():
        if value is not None:
            advice = "give it to prove_existence, or pass the breather"
            raise InputError(name, value, "none beside a proof of existence", advice)
    if solution.half_width:
        advice = "prove existence without half_width="
        raise InputError("solution", solution, "one orbit, not a segment", advice)
    return solution


class Interval(NamedTuple):
    """A frequency that is between middle - off and middle + off."""

    middle: Fraction
    off: Fraction


def orbit_of(proof: ExistenceProof) -> RoundedOrbit:
    """The integers that a proof of existence is about."""
    chain, seed, given = proof.chain, proof.seed, proof.body["orbit"]
    allowed = layout_of(chain, seed).allowed(len(given) - 1)
    table = np.zeros(allowed.shape, dtype=object)
    table[allowed] = [x for row in given for x in row]
    rows = tuple(map(tuple, table.tolist()))
    return RoundedOrbit(
        chain, seed, proof.frequency, proof.body["bits"], rows, proof.digits
    )


def proved_exponent(
    one: Enclosed, sectors: tuple[Sector, ...], frequency: Interval
) -> ProvedExponent:
    """The enclosure in doubles."""
    zero = one.zero
    guess, (n, q) = zero.guess, zero.kappa
    turns = Fraction(guess.base * guess.sector.folds, 2)
    shift = turns * frequency.middle
    real, imaginary = (Fraction(x, 2**zero.bits) for x in zero.sigma)
    middle = complex(float(shift + real), float(imaginary))
    rounding = 4 * math.ulp(abs(middle))
    return ProvedExponent(
        sector=sectors.index(guess.sector),
        sigma=middle,
        radius=float(one.sigma_radius + turns * frequency.off) + rounding,
        mode=q,
        harmonic=n,
        folds=guess.sector.folds,
        circle=guess.circle,
        linear=one.bounds.linear,
        block=len(one.choice.block),
    )


def gaps_of(
    frequency: Interval, sectors: tuple[Sector, ...], enclosed: list[Enclosed]
) -> list[Gap]:
    """Between neighbours of every sector, its ends among them; an error where they overlap."""
    result, omega = [], frequency.middle
    for number, sector in enumerate(sectors):
        points = [(Fraction(0), Fraction(0), "0")]
        for one in enclosed:
            if one.zero.guess.sector == sector:
                value = Fraction(one.zero.sigma[0], 2**one.zero.bits)
                width = one.sigma_radius + abs(value) * frequency.off / omega
                n, q = one.zero.kappa
                label = f"mode {q}, harmonic {n}"
                points.append((value / omega, width / (omega - frequency.off), label))
        points.append((Fraction(sector.folds, 2), Fraction(0), f"{sector.folds}/2 omega"))
        points.sort()
        pairs = pairwise(points)
        result += [gap_between(a, b, number) for a, b in pairs]
    return sorted(result, key=lambda gap: gap.least)


Point = tuple[Fraction, Fraction, str]


def gap_between(a: Point, b: Point, sector: int) -> Gap:
    """From one enclosure to the next."""
    apart, width = b[0] - a[0], a[1] + b[1]
    if apart <= width:
        raise NoStabilityProof(
            complex(a[0]),
            "gap",
            float(apart),
            float(width),
            f"{a[2]} meets {b[2]}; {ADVICE}",
        )
    least = math.nextafter(float(apart - width), 0)
    return Gap(least, math.nextafter(float(apart + width), math.inf), sector, (a[2], b[2]))


def certificate_body(
    proof: ExistenceProof,
    slopes: Slopes,
    sectors: tuple[Sector, ...],
    enclosed: list[Enclosed],
    *,
    stable: bool,
) -> dict[str, Any]:
    """The certificate without its digest."""
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "existence": proof.certificate(),
        "claim": "stable" if stable else "unstable",
        "slope_harmonics": slopes.K,
        "free": slopes.free(sectors[0]),
        "exponents": [exponent_body(one, slopes, sectors) for one in enclosed],
    }


def exponent_body(
    one: Enclosed, slopes: Slopes, sectors: tuple[Sector, ...]
) -> dict[str, Any]:
    """Of one exponent; complex numbers as two lists."""
    zero = one.zero
    sector, parts = zero.guess.sector, 1 if zero.guess.circle else 2
    n, q = sector.places(slopes.free(sector))
    block = [[int(n[i]), int(q[i])] for i in one.choice.block]
    return {
        "sector": sectors.index(sector),
        "base": zero.guess.base,
        "bits": zero.bits,
        "sigma": list(zero.sigma[:parts]),
        "kappa": list(zero.kappa),
        "vector": [vector_rows(zero, part) for part in range(parts)],
        "block": block,
        "weights": one.choice.letters,
        "radius": list(one.radius),
    }


def vector_rows(zero: RoundedZero, part: int) -> list[list[int]]:
    """[n, i, v, v, ..] of every harmonic: from the i-th allowed mode on, no zeros at the ends."""
    rows = []
    for n, row in zip(
        range(-zero.harmonics, zero.harmonics + 1), zero.rows[part].tolist(), strict=True
    ):
        values = [row[q - 1] for q in zero.guess.sector.allowed(n)]
        used = [i for i, v in enumerate(values) if v]
        if used:
            rows.append([n, used[0], *values[used[0] : used[-1] + 1]])
    return rows
