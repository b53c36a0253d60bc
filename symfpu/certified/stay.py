"""How long an orbit stays near a computed torus: a proof.

In the frame of tangents, of directions of the actions and of normal directions an orbit is
K(theta) + Z(theta) v with |v|' <= g(|v|) (docs/tori-proofs.md). No small divisors: the frame is
there, and what it leaves is bounded.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath

from symfpu.certified.frame import FRAME_BITS, RATE_BITS, Direction, directions_of
from symfpu.certified.growth import Growth, rounded_up
from symfpu.certified.norms import Norms, norms, weights_of
from symfpu.certified.residual import (
    SLACK,
    Body,
    bound_text,
    cosine_rows,
    dyadic_pair,
    residual_proof,
    rows_of,
    shown,
    torus_proof_fields,
    torus_text,
    torus_words,
)
from symfpu.certified.rounded_torus import RoundedTorus, residual_of, rounded_torus
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.numbers.one_sided import above, below
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal, exact
from symfpu.proofs.certified import Certified
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits
from symfpu.results.table import Table
from symfpu.tori.torus import Torus

TIME = 10**9  # the paper's longest orbits
LAST = Fraction(511, 512)  # of the time to the farthest distance
LONGEST_TIME = Fraction(10**100)
MOST_DIGITS = 18  # of a double, which tell it from any other


class NoStayProof(SymfpuError):
    """The bounds do not prove that orbits stay near the torus for so long.

    Raised by `prove_stay`. time : asked for. longest : what can be proved. residual, frame,
    curvature : the terms of the growth of a distance, doubles, dimensionless. Ours.
    """

    def __init__(
        self, time: float, longest: float, residual: float, frame: float, curvature: float
    ) -> None:
        self.time, self.longest = time, longest
        self.residual, self.frame, self.curvature = residual, frame, curvature
        advice = "more digits help: refine(torus, digits=30)"
        if frame**2 > residual * curvature:
            advice = f"the frame, known in doubles, allows some {1 / frame:.1g}"
        asked, most = told_apart(time, longest)
        super().__init__(
            f"no proof of a stay of {asked}: at most {most}; "
            f"residual {residual:.2g}, frame {frame:.2g}, curvature {curvature:.2g}; {advice}"
        )


def told_apart(larger: float, smaller: float) -> tuple[str, str]:
    """Decimals of two times, rounded away from each other, in three digits or as many as differ."""
    words = above(larger, 3), below(smaller, 3)
    for digits in range(4, MOST_DIGITS):
        if words[0] != words[1]:
            break
        words = above(larger, digits), below(smaller, digits)
    return words


@public
@dataclass(frozen=True, eq=False, kw_only=True)
class StayProof(Certified):
    """A theorem: every orbit that starts on the computed torus stays near it for so long.

    chain, seeds, frequencies : the model and the angles; frequencies exact.
    time : exact. distance : for times up to that the stretch of every bond, and momentum : every
        particle's velocity, differ by at most this from those of a point of the torus, mpf.
    drift : whose angles differ by at most this from phi + omega t, mpf by seed, radians.
    residual, frame, curvature : |v|' <= residual + frame |v| + curvature |v|^2 + ..., doubles;
        room : of the inverse of the frame, 1 where it is exact.
    longest : the longest time that these bounds allow. sigma : normal frequencies of the frame.
    bound : of the residual of the equations of motion, as of ResidualProof, mpf.
    growth : the bounds, exact. reach : stretches at |v| = 1. harmonics, digits : of the torus.
    body : the certificate without its digest. Dimensionless. Ours: docs/tori-proofs.md.

    >>> import symfpu
    >>> from symfpu import Chain, prove_stay, refine
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> torus = symfpu.torus(Chain(N=3, alpha="0.3"), (1, 2), amplitudes=amplitudes, digits=30)
    >>> prove_stay(torus)
    StayProof(N=3, alpha=0.3, omega_1=0.99..., omega_2=1.73..., 30 digits: an orbit that starts
    on the torus stays within ... of it for t <= 1000000000, its angles within ... of phi +
    omega t; at most t <= ...)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    time: Fraction
    distance: Any
    momentum: Any
    drift: dict[int, Any]
    bound: Any
    residual: float
    frame: float
    curvature: float
    room: float
    longest: float
    sigma: dict[int, float]
    growth: Growth = field(repr=False)
    reach: Fraction = field(repr=False)
    harmonics: int
    digits: int
    body: Body = field(repr=False)

    def _certificate_body(self) -> dict[str, Any]:
        return self.body

    def _lines(self, width: int | None) -> Iterator[str]:
        """The theorem, and what it follows from."""
        bounds = (self.residual, self.frame, self.curvature, self.room)
        residual, frame, curvature, room = (f"{x:.3g}" for x in bounds)
        yield f"{torus_words(self)}: proved"
        yield f"  {self._claim};"
        yield f"  velocities within {mpmath.nstr(self.momentum, 3)}; {self.most}"
        yield (
            f"  residual {residual}, frame {frame}, curvature {curvature}, room {room}; "
            f"residual of every particle below {mpmath.nstr(self.bound, 3)}"
        )

    def _fields(self) -> Iterator[Field]:
        """With the time, the distances and what they follow from."""
        yield from torus_proof_fields(self)
        yield Field("bound", bound_text(self.bound), "residual below")
        yield Field("time", decimal(self.time), "up to t")
        yield Field("distance", bound_text(self.distance), "within")
        yield Field("momentum", bound_text(self.momentum))
        yield Field("drift", {str(q): bound_text(x) for q, x in self.drift.items()})
        yield Field("longest", fifteen_digits(self.longest))
        sigma = {str(q): fifteen_digits(x) for q, x in self.sigma.items()}
        yield Field("sigma", sigma)
        sizes = {"frame": self.frame, "curvature": self.curvature, "room": self.room}
        bounds = {name: fifteen_digits(x) for name, x in sizes.items()}
        residual = bound_text(self.growth.terms[0])
        yield Field("bounds", {"residual": residual, **bounds})

    def __repr__(self) -> str:
        which = torus_text(self.chain, self.seeds, self.frequencies)
        return f"StayProof({which}, {self.digits} digits: {self._claim}; {self.most})"

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, exact."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    @property
    def _claim(self) -> str:
        """The theorem without its torus."""
        size, apart = above(self.distance, 3), above(max(self.drift.values()), 3)
        return (
            f"an orbit that starts on the torus stays within {size} of it for "
            f"t <= {decimal(self.time)}, its angles within {apart} of phi + omega t"
        )

    @property
    def theorem(self) -> str:
        """What is proved, in one sentence."""
        which = torus_text(self.chain, self.seeds, self.frequencies)
        return f"{which}: {self._claim}"

    @property
    def most(self) -> str:
        """The longest time in words."""
        return f"at most t <= {below(self.longest, 3)}"

    def distance_at(self, time: Number) -> Any:
        """The distance that is proved for another time, mpf; not of the certificate.

        time : an exact number. Raises InputError for no time, and NoStayProof for one too long.
        """
        d = distance_of(self.growth, time_of(time))
        return shown(d * self.reach)

    def _table(self) -> Table:
        """Distances at powers of 10 of the time, up to the longest."""
        times, power = [], 1
        while power <= self.longest:
            times.append(float(power))
            power *= 10
        distances = [float(self.distance_at(Fraction(t))) for t in times]
        known = attributes(self, self.chain, seeds=self.seeds, frequencies=self.frequencies)
        return Table({"time": times, "distance": distances}, known)


@public
def prove_stay(
    torus: Torus, *, time: Number = TIME, progress: Progress | None = None
) -> StayProof:
    """A proof of how near to a computed torus an orbit stays that starts on it, and for how long.

    torus : of two or more angles, elliptic, fixed ends and a polynomial potential, from `refine`
        and its sisters, in doubles or with `digits`. Dimensionless.
    time : how long, an exact number; default 1e9. progress : called as (label, fraction).

    The distance grows by the residual of the torus, by what its frame (twist, normal modes, in
    doubles) leaves of the linearised equations, and by the curvature of the force; all three
    are bounded in integers at all angles, and the scalar inequality is solved from above
    (docs/tori-proofs.md; ours). No frequency needs to be Diophantine, and no true torus to exist.
    Raises InputError for what is not such a torus, NoTwist and NoNormalModes where it has no
    frame, NoStayProof with the longest time.

    >>> import symfpu
    >>> from symfpu import Chain, prove_stay, refine
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> torus = symfpu.torus(Chain(N=4, alpha="0.3"), (1, 2), amplitudes=amplitudes, digits=30)
    >>> proof = prove_stay(torus)
    >>> proof.distance < 1e-19
    True
    """
    tell = progress or unheard
    long = time_of(time)
    rounded = rounded_torus(torus)
    directions = directions_of(torus, tell)
    return stay_proof(rounded, directions, long, tell)


def stay_proof(
    torus: RoundedTorus, directions: Sequence[Direction], time: Fraction, tell: Progress
) -> StayProof:
    """The result of a torus and its directions. Raises NoStayProof."""
    left = [series.norm for series in residual_of(torus, tell)]
    residual = residual_proof(torus, left)
    tell("norms of the frame", NO_FRACTION)
    found = norms(torus, directions, left)
    weights = weights_of(found)
    growth = found.growth(weights)
    d = distance_of(growth, time)
    reach, speed = max(found.reach(weights)), max(found.speed(weights))
    drift = drift_of(found, weights, growth, d, time)
    sizes = [d, *(rounded_up(SLACK * d * x) for x in (reach, speed))]
    return StayProof(
        chain=torus.chain,
        seeds=torus.seeds,
        frequencies=torus.omega,
        time=time,
        distance=shown(sizes[1]),
        momentum=shown(sizes[2]),
        drift=dict(zip(torus.seeds, map(shown, drift), strict=True)),
        bound=residual.bound,
        residual=float(growth.terms[0]),
        frame=float(growth.terms[1]),
        curvature=float(growth.terms[2]),
        room=float(growth.room),
        longest=float(longest_of(growth)),
        sigma={p.mode: float(p.rate) for p in directions if not p.twist},
        growth=growth,
        reach=reach,
        harmonics=residual.harmonics,
        digits=torus.digits,
        body=residual.body | stay_body(directions, weights, time, sizes, drift),
    )


def time_of(time: Number) -> Fraction:
    """A positive time, exact."""
    long = exact(time, "time")
    if not 1 / LONGEST_TIME <= long <= LONGEST_TIME:
        allowed = "a positive number of size 1e-100 to 1e100"
        raise InputError("time", time, allowed, "take 1e9")
    return long


def longest_of(growth: Growth) -> Fraction:
    """The longest time for which the bounds give a distance."""
    return Fraction(0) if growth.room <= 0 else LAST * growth.time(growth.longest())


def distance_of(growth: Growth, time: Fraction) -> Fraction:
    """A weighted distance that is not reached before a time. Raises NoStayProof."""
    longest = longest_of(growth)
    found = growth.distance(time) if time <= longest else None
    if found is None:
        raise NoStayProof(float(time), float(longest), *map(float, growth.terms[:3]))
    return found


def drift_of(
    found: Norms,
    weights: Sequence[Fraction],
    growth: Growth,
    d: Fraction,
    time: Fraction,
) -> list[Fraction]:
    """How far the angles are from phi + omega t at most."""
    rates = zip(found.drift(weights), weights[: found.s], strict=True)
    rate = growth.rate(d)
    room = SLACK * time
    return [rounded_up(room * (turned * d + tangent * rate)) for turned, tangent in rates]


def stay_body(
    directions: Sequence[Direction],
    weights: Sequence[Fraction],
    time: Fraction,
    sizes: Sequence[Fraction],
    drift: Sequence[Fraction],
) -> Body:
    """What the certificate of a stay has beyond that of a residual.

    sizes : the weighted distance, that of stretches, that of momenta.
    """
    stay = [str(time), *map(dyadic_pair, sizes), [dyadic_pair(x) for x in drift]]
    return {
        "frame_bits": FRAME_BITS,
        "rate_bits": RATE_BITS,
        "directions": [direction_rows(d) for d in directions],
        "weights": [int(w) for w in weights],
        "stay": stay,
    }


def direction_rows(d: Direction) -> list[Any]:
    """[mode, rate, twist, rows], integers in units of 2^-RATE_BITS and 2^-FRAME_BITS."""
    unit = 2**RATE_BITS
    rows = cosine_rows(d.particles) if d.twist else rows_of(d.particles)
    return [d.mode, int(d.rate * unit), [int(x * unit) for x in d.twist], rows]
