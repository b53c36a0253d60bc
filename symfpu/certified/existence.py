"""Breathers that exist: a proof by Newton's method and a contraction, with a certificate.

In a space of cosine series c - A F(c) maps a small ball around a computed orbit into itself and
contracts it (docs/existence.md): there is one true orbit of this frequency in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import compress
from typing import Any

import flint
import mpmath

from symfpu.certified.bond_balls import SPARE_BITS, BondBalls, Rows
from symfpu.certified.border import AMPLITUDE, ENERGY, FREQUENCY, Fixed
from symfpu.certified.bordered_newton import fixed_orbit
from symfpu.certified.contraction import INVERSE_BITS, WEIGHT_BITS
from symfpu.certified.existence_bounds import (
    ProofBounds,
    Radii,
    double_above,
    of_dyadic,
    proof_bounds,
    radii,
)
from symfpu.certified.force_series import ForceSeries, ball
from symfpu.certified.packed_integers import packed
from symfpu.certified.rounded_orbit import RoundedOrbit, rounded_orbit
from symfpu.certified.segment import Line, direction
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.one_sided import above, below, rational
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal, energy_of, exact
from symfpu.proofs.certified import Certified
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, seeds_field
from symfpu.results.numbers import fifteen_digits
from symfpu.results.table import Table
from symfpu.series.arguments import digits_of
from symfpu.tori.torus import Torus

FORMAT = "symfpu existence certificate"
SCHEMA = 3
ROOM = 2  # times the radius of the stated intervals of A and H
MORE_DIGITS = "more digits may help: digits=40"
MORE_HARMONICS = "more harmonics may help: digits=40 takes what it needs"
SMALLER = "an orbit of smaller amplitude is easier"
GIVEN = "give amplitude= or energy= instead of it"
NO_ORBIT = "more digits of it do not help: Newton's method, torus, finds orbits"
HALF_A_RING = (
    "a standing breather of a ring, odd about two particles, is that of half the ring with fixed "
    "ends; travelling waves have torus and refine"
)
SHORTER = "a shorter segment can: a half width of"
HALVINGS = 60
NEAR = 1e-6  # relative, of a given amplitude or energy to that of the orbit
FAR = 1e-3  # a Newton step over the orbit: above it this is no orbit to rounding


class NoExistenceProof(SymfpuError):
    """The bounds do not prove that there is an orbit near the one computed.

    Raised by `prove_existence`. bound : which one, "Z1" or "Y". value : of it. needed : what it
    would have to be below, dimensionless. advice : what may help. Ours.
    """

    def __init__(self, bound: str, value: float, needed: float, advice: str) -> None:
        self.bound, self.value, self.needed, self.advice = bound, value, needed, advice
        name = {"Z1": "the norm of I - A DF, Z0 + Z1", "Y": "the Newton step, Y"}[bound]
        by = f"{value:.3g} is not below {needed:.3g}"
        super().__init__(f"no proof of existence: {name} = {by}; {advice}")


@public
@dataclass(frozen=True, eq=False, kw_only=True)
class ExistenceProof(Certified):
    """A theorem: the chain has a periodic orbit of this frequency near the computed one.

    chain, seed : the model and the mode; of a ring the orbit is a travelling wave.
    fixed : "frequency", "amplitude" or "energy", what the orbit has exactly; value : that, a
        fraction; half_width : of the interval of values about it that a segment of the family
        has, else 0.
    frequency, frequency_radius : omega, exact where it is fixed and its radius 0; else the middle
        and the radius of an interval that holds it.
    radius : above the distance of the true orbit from the computed one: of every stretch of a
        bond at all times, and of the weighted sum of all Fourier coefficients. unique : within it
        there is no other one of the same symmetry. nu : the orbit is analytic where
        |Im omega t| < log nu.
    amplitude, amplitude_radius, energy, energy_radius : intervals that hold A and H, mpf and
        doubles.
    residual, linear, curvature : Y, Z0 + Z1 and Z2 of the theorem, doubles.
    harmonics, block : of the orbit, and unknowns in the dense part of the inverse.
    digits : of the orbit that was given. body : the certificate in plain lists, without its
        digest. Dimensionless. Ours: docs/existence.md.

    >>> import symfpu
    >>> from symfpu import Chain, prove_existence
    >>> prove_existence(symfpu.torus(Chain(N=8, alpha="0.3"), (1,), frequencies=("0.3905",)))
    ExistenceProof(N=8, alpha=0.3, seed 1, omega=0.3905: a periodic orbit within ... of the
    computed one, the only one within ...; A = 0.4051586230... +- ..., H = 0.01279842208... +- ...)
    """

    chain: Chain
    seed: int
    fixed: str
    value: Fraction
    half_width: Fraction
    frequency: Fraction
    frequency_radius: float
    radius: float
    unique: float
    nu: Fraction
    amplitude: Any
    amplitude_radius: float
    energy: Any
    energy_radius: float
    residual: float
    linear: float
    curvature: float
    harmonics: int
    block: int
    digits: int
    body: dict[str, Any] = field(repr=False)

    def _certificate_body(self) -> dict[str, Any]:
        return self.body | packed_entries(self.body)

    def _lines(self, width: int | None) -> Iterator[str]:
        """The theorem, the intervals, and the bounds."""
        given = f"of each such {self.fixed}" if self.half_width else f"of this {self.fixed}"
        yield f"{self.chain.label}, seed {self.seed}, {self.condition}: proved"
        yield (
            f"  a {self.kind} {given} exists within {above(self.radius, 2)} "
            f"of the computed one, the only one within {below(self.unique, 2)}"
        )
        yield f"  in the norm {self.norm}, nu = {self.nu};"
        yield f"  analytic for |Im omega t| < log {self.nu}"
        yield from (f"  {interval}" for interval in self.intervals)
        yield (
            f"  Y = {self.residual:.2g}, Z0 + Z1 = {self.linear:.3g}, "
            f"Z2 = {self.curvature:.3g}; {self.harmonics} harmonics, block of {self.block}"
        )

    def _fields(self) -> Iterator[Field]:
        """A and H are the middles of intervals."""
        digits, seed = self.digits + 3, str(self.seed)
        yield from chain_fields(self.chain)
        yield seeds_field((self.seed,))
        yield Field("frequencies", {seed: decimal(self.frequency)})
        yield Field("frequency_radius", fifteen_digits(self.frequency_radius))
        yield Field("proved", True)
        yield Field("theorem", self.theorem, "theorem")
        yield Field("fixed", self.fixed)
        yield Field("value", decimal(self.value))
        yield Field("half_width", decimal(self.half_width))
        yield Field("radius", fifteen_digits(self.radius))
        yield Field("unique", fifteen_digits(self.unique))
        yield Field("nu", str(self.nu))
        yield Field("amplitudes", {seed: mpmath.nstr(self.amplitude, digits)})
        yield Field("amplitude_radius", fifteen_digits(self.amplitude_radius))
        yield Field("energy", mpmath.nstr(self.energy, digits))
        yield Field("energy_radius", fifteen_digits(self.energy_radius))
        bounds = {"Y": self.residual, "Z1": self.linear, "Z2": self.curvature}
        yield Field("bounds", {name: fifteen_digits(x) for name, x in bounds.items()})
        yield Field("harmonics", self.harmonics, "harmonics")
        yield Field("block", self.block)

    @property
    def kind(self) -> str:
        """Of orbit, in words."""
        return "travelling wave" if self.chain.periodic else "periodic orbit"

    def __repr__(self) -> str:
        chain = self.chain.label
        found = f"a {self.kind} within {above(self.radius, 2)} of the computed one"
        only = f"the only one within {below(self.unique, 2)}"
        case = f"{chain}, seed {self.seed}, {self.condition}"
        return f"ExistenceProof({case}: {found}, {only}; {', '.join(self.intervals)})"

    @property
    def theorem(self) -> str:
        """What is proved, in one sentence."""
        joined = "for" if self.half_width else "with"
        return (
            f"{self.chain!r} has a {self.kind} of seed {self.seed} {joined} {self.condition} "
            f"within {above(self.radius, 2)} of the computed one, and no other of its symmetry "
            f"within {below(self.unique, 2)}, distances in the norm {self.norm}"
        )

    @property
    def norm(self) -> str:
        """Of the distances: of c_q[n], and of m that stands for an unknown frequency."""
        if self.fixed == FREQUENCY and not self.half_width:
            return "sum v nu^n |c_q[n]|"
        return "v_0 |m| + sum v nu^n |c_q[n]|"

    @property
    def condition(self) -> str:
        """What the orbit has exactly, in words."""
        sign = {FREQUENCY: "omega", AMPLITUDE: "A", ENERGY: "H"}[self.fixed]
        if not self.half_width:
            return f"{sign}={decimal(self.value)}"
        return f"every {sign} within {below(self.half_width, 3)} of {decimal(self.value)}"

    @property
    def intervals(self) -> tuple[str, ...]:
        """Those that hold the two of A, H and omega that are not given, in words."""
        omega = "" if self.fixed == FREQUENCY else self._omega_interval()
        A = f"A = {interval_text(self.amplitude, self.amplitude_radius)}"
        H = f"H = {interval_text(self.energy, self.energy_radius)}"
        found = (
            omega,
            "" if self.fixed == AMPLITUDE else A,
            "" if self.fixed == ENERGY else H,
        )
        return tuple(text for text in found if text)

    def _omega_interval(self) -> str:
        places, exact_middle = self.body["frequency"][2], self.frequency
        with mpmath.workprec(places + 53):
            middle = mpmath.mpf(exact_middle.numerator) / exact_middle.denominator
            return f"omega = {interval_text(middle, self.frequency_radius)}"

    def _table(self) -> Table:
        """One row for each bound of the theorem."""
        names = {
            "Y": self.residual,
            "Z0 + Z1": self.linear,
            "Z2": self.curvature,
            "r": self.radius,
            "R": self.unique,
        }
        frequency = self.frequency
        known = attributes(self, self.chain, seeds=(self.seed,), frequencies=(frequency,))
        return Table({"bound": list(names), "value": list(names.values())}, known)


def interval_text(middle: Any, radius: float) -> str:
    """A number with the digits that its radius leaves, and the radius with what they are off by."""
    size = abs(float(middle)) or 1.0
    digits = max(2, math.ceil(math.log10(size / radius)) + 1) if radius else 17
    with mpmath.workdps(digits + 5):
        text = mpmath.nstr(middle, digits)
    off = abs(rational(middle) - Fraction(text))
    return f"{text} +- {above(rational(radius) + off, 1)}"


@public
def prove_existence(
    orbit: Torus,
    *,
    amplitude: Number | None = None,
    energy: Number | None = None,
    half_width: Number = 0,
    digits: int | None = None,
) -> ExistenceProof:
    """A proof that the chain has a periodic orbit near the computed one, or an error that says why.

    orbit : of one angle, of a chain with fixed ends: from `torus` or
        `refine`, or a series of one seed;
        or a travelling wave of a ring, from the same. Its phase does not matter. All
        is dimensionless.
    amplitude, energy : that of the orbit, an exact number: the true orbit has exactly this A or H,
        and its frequency is in an interval. Without them it has exactly the orbit's frequency.
    half_width : of an interval about the frequency, amplitude or energy: a proof for each of its
        values, of a segment of the family as one analytic curve.
    digits : of the computed orbit, where Newton's method has to find more than it has; the radius
        falls with them.

    Newton's method and a contraction in a weighted space of Fourier coefficients, every rounding
    bounded (docs/existence.md; ours): the orbit exists, is the only one nearby, and analytic. The
    radius falls with the digits of the orbit; along a segment with the square of its length.
    Raises InputError for what is not such an orbit; NoExistenceProof with the bound that failed:
    that is no proof that there is none.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> orbit = symfpu.torus(Chain(N=2, beta=1), (1,), frequencies=("1.5",))
    >>> proof = prove_existence(orbit)
    >>> proof.radius < 1e-13 < 1e-4 < proof.unique
    True
    >>> prove_existence(orbit, half_width="1e-4").fixed
    'frequency'
    """
    checked = checked_orbit(orbit)
    fixed = fixed_value(checked, amplitude, energy, half_width)
    rounded = rounded_orbit(checked, None if digits is None else digits_of(digits))
    with flint.ctx.workprec(rounded.bits + SPARE_BITS):
        if fixed.kind != FREQUENCY or digits is not None:
            rounded = fixed_orbit(rounded, fixed)
        bounds, linear = proof_bounds(rounded, fixed)
        if bounds is None:
            raise NoExistenceProof("Z1", linear, 1.0, advice_of(linear, fixed))
        line = line_of(bounds) if fixed.half_width else None
        bounds = on_line(bounds, line)
        found = radii(bounds)
        if found is None:
            raise NoExistenceProof(*not_small(bounds))
        return assembled(bounds, found, fixed, line)


def advice_of(linear: float, fixed: Fixed) -> str:
    """What helps where no block makes Z small."""
    if math.isinf(linear) and fixed.kind == FREQUENCY:
        return f"the frequency may not tell this orbit from its neighbours: {GIVEN}"
    return f"{MORE_HARMONICS}; {SMALLER}"


def fixed_value(
    orbit: Torus,
    amplitude: Number | None,
    energy: Number | None,
    half_width: Number,
) -> Fixed:
    """What the orbit has exactly; InputError where it does not have it."""
    width = exact(half_width, "half_width")
    if not 0 <= width <= 1:
        advice = "take a part of the frequency, amplitude or energy"
        raise InputError("half_width", half_width, "a number from 0 to 1", advice)
    if amplitude is not None and energy is not None:
        given = f"amplitude={amplitude} and energy={energy}"
        raise InputError("energy", given, "one of the two", "leave one out")
    if amplitude is not None:
        fixed = Fixed(AMPLITUDE, exact(amplitude, "amplitude"), width)
        return near(fixed, orbit.amplitude, orbit.chain)
    if energy is not None:
        fixed = Fixed(ENERGY, energy_of(energy), width)
        return near(fixed, orbit.energy(), orbit.chain)
    return Fixed(FREQUENCY, orbit.frequency, width)


def near(fixed: Fixed, own: Any, chain: Chain) -> Fixed:
    """The same where it is about the orbit's own."""
    if abs(float(fixed.value) - float(own)) > NEAR * abs(float(own)):
        allowed = f"about that of the orbit, {float(own):.10g}"
        given = decimal(fixed.value)
        raise InputError(fixed.kind, given, allowed, "take an orbit from torus")
    return fixed


def line_of(bounds: ProofBounds) -> Line:
    """Of the segment's orbits, along the tangent of the family."""
    assert bounds.border is not None
    given = direction(bounds.balls, bounds.border)
    return Line(bounds.balls, bounds.border, bounds.found, given)


def on_line(bounds: ProofBounds, line: Line | None) -> ProofBounds:
    """The bounds for every orbit of a line."""
    if line is None:
        return bounds
    return replace(bounds, length=line.length, drift=line.drift)


def checked_orbit(orbit: object) -> Torus:
    """An orbit that the theorem is about; InputError for any other, by name."""
    if not isinstance(orbit, Torus):
        name, chain = type(orbit).__name__, getattr(orbit, "chain", None)
        given = name if chain is None else f"{name} of {chain!r}"
        allowed = "a solution of one angle of a chain with fixed ends, or a travelling wave"
        raise InputError("orbit", given, allowed, "take one from torus")
    if len(orbit.seeds) > 1:
        given = f"a torus of {len(orbit.seeds)} angles"
        raise InputError("orbit", given, "a solution of one angle", "take one seed")
    if orbit.stands:
        given, allowed = "a torus of standing waves", "a travelling wave"
        raise InputError("orbit", given, allowed, HALF_A_RING)
    potential = orbit.chain.potential
    series = potential.degree is not None or potential.growths()
    if not potential.exact or not series:
        allowed = "a polynomial with exact coefficients, or toda:, morse: or lennard-jones:"
        advice = "take poly: with its first coefficients"
        raise InputError("chain", orbit.chain, allowed, advice)
    return orbit


def not_small(bounds: ProofBounds) -> tuple[str, float, float, str]:
    """The bound that failed, Y for it is too large, what was needed, and what may help."""
    Y = double_above(bounds.residual)
    at_zero = double_above(bounds.curvature(flint.arb(0)))
    needed = (1 - bounds.linear) ** 2 / (4 * at_zero) if at_zero else math.inf
    share = widest_share(bounds) if bounds.length else 0.0
    if share:
        return "Y", Y, needed, f"{SHORTER} {share:.2g} of this one can be proved"
    size = float(sum(abs(bounds.balls.orbit.floats).max(axis=0)))
    if FAR * size < Y:
        return "Y", Y, needed, NO_ORBIT
    tail = double_above(bounds.beyond) > Y / 2
    return "Y", Y, needed, MORE_HARMONICS if tail else MORE_DIGITS


def widest_share(bounds: ProofBounds) -> float:
    """Of a segment that cannot be proved, the share that can about; 0 if none."""
    share = 1.0
    for _ in range(HALVINGS):
        share *= 0.7
        shorter = replace(bounds, length=share * bounds.length, drift=share * bounds.drift)
        if radii(shorter):
            return share
    return 0.0


def assembled(
    bounds: ProofBounds, found: Radii, fixed: Fixed, line: Line | None
) -> ExistenceProof:
    """The result with its certificate."""
    orbit = bounds.balls.orbit
    unique = of_dyadic(found.uniqueness)
    intervals = stated_intervals(bounds, ball(of_dyadic(found.existence)), line)
    A, A_radius = interval(intervals["amplitude"])
    H, H_radius = interval(intervals["energy"])
    omega_radius = 0.0
    if fixed.bordered:
        omega_radius = radius_about(orbit.omega, intervals["frequency"])
    return ExistenceProof(
        chain=orbit.chain,
        seed=orbit.seed,
        fixed=fixed.kind,
        value=fixed.value,
        half_width=fixed.half_width,
        frequency=orbit.omega,
        frequency_radius=omega_radius,
        radius=math.nextafter(float(of_dyadic(found.existence)), math.inf),
        unique=math.nextafter(float(unique), 0),
        nu=bounds.balls.strip,
        amplitude=A,
        amplitude_radius=A_radius,
        energy=H,
        energy_radius=H_radius,
        residual=double_above(bounds.residual),
        linear=bounds.linear,
        curvature=double_above(bounds.curvature(ball(unique) + bounds.length)),
        harmonics=orbit.harmonics,
        block=len(bounds.found.block),
        digits=orbit.digits,
        body=certificate_body(bounds, found, fixed, line, intervals),
    )


def stated_intervals(
    bounds: ProofBounds, radius: Any, line: Line | None
) -> dict[str, Interval]:
    """That hold A, H and the frequency of the orbit, or of all of a segment."""
    balls, border = bounds.balls, bounds.border
    bits, layout = balls.orbit.bits, balls.layout
    of_seed, of_border = flint.arb(0), 0
    if line is not None:
        of_seed = abs(line.given.rows[1][layout.place]) * line.unit
        of_border = abs(line.given.of_frequency) * line.unit
    found = {
        "amplitude": stated(balls.amplitude(radius + of_seed), bits),
        "energy": stated(energy_within(balls, radius, line), bits),
    }
    if border is not None:
        weight = flint.arb(int(bounds.found.weights[0])) / 2**WEIGHT_BITS
        around = flint.arb(0, (radius / weight + of_border) * border.unit)
        found["frequency"] = stated((balls.squared + around).sqrt(), bits)
    return found


def energy_within(balls: BondBalls, radius: Any, line: Line | None) -> Any:
    """H where no momentum is left, at t = 0 of fixed ends; of a wave by its mean."""
    if balls.layout.copies > 1:
        moved = sum(map(balls.norm, line.stretches), flint.arb(0)) if line else 0
        return balls.mean_energy_within(radius + moved)
    of_bonds = line.at_rest if line else [flint.arb(0)] * balls.layout.bonds
    return balls.energy_within([radius + x for x in of_bonds])


Interval = tuple[int, int, int]  # middle, radius, places: units 2^-places


def stated(x: Any, bits: int) -> Interval:
    """An interval around a ball with room for another's rounding."""
    places = bits + SPARE_BITS // 2
    unit = flint.arb(2) ** places
    middle = int((x.mid() * unit).mid().floor().unique_fmpz())
    radius = int((ROOM * x.rad() * unit).upper().ceil().unique_fmpz()) + 2
    return middle, radius, places


def interval(entry: Interval) -> tuple[Any, float]:
    """The middle as mpf, the radius as a double above it."""
    middle, radius, places = entry
    with mpmath.workprec(max(middle.bit_length(), 53)):
        value = mpmath.ldexp(mpmath.mpf(middle), -places)
    return value, math.nextafter(float(Fraction(radius, 2**places)), math.inf)


def radius_about(value: Fraction, entry: Interval) -> float:
    """A double above the distance of an interval's ends from a number."""
    middle, radius, places = entry
    off = abs(value - Fraction(middle, 2**places)) + Fraction(radius, 2**places)
    return math.nextafter(float(off), math.inf)


def certificate_body(
    bounds: ProofBounds,
    found: Radii,
    fixed: Fixed,
    line: Line | None,
    intervals: dict[str, Interval],
) -> dict[str, Any]:
    """The certificate without its digest."""
    choice, orbit, border = bounds.found, bounds.balls.orbit, bounds.border
    places = choice.places
    block = [[int(places.n[i]), int(places.q[i])] for i in choice.block if places.q[i]]
    empty: list[int] = []
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "ends": "travelling" if orbit.chain.periodic else "fixed",
        "N": orbit.chain.N,
        **potential_entries(orbit, bounds.balls.force),
        "seed": orbit.seed,
        "fixed": fixed.kind,
        "value": str(fixed.value),
        "half_width": str(fixed.half_width),
        "omega": str(orbit.omega),
        "nu": str(bounds.balls.strip),
        "bits": orbit.bits,
        "orbit": allowed_rows(orbit, orbit.rows),
        "scales": [border.unknown_places, border.equation_places] if border else empty,
        "direction": [] if line is None else allowed_rows(orbit, line.given.rows),
        "direction_frequency": 0 if line is None else line.given.of_frequency,
        "slope_harmonics": choice.part.K,
        "free": choice.free,
        "block": block,
        "inverse_bits": INVERSE_BITS,
        "inverse": choice.inverse.tolist(),
        "weight_bits": WEIGHT_BITS,
        "weights": choice.weights.tolist(),
        "radius": list(found.existence),
        "unique": list(found.uniqueness),
        "amplitude": list(intervals["amplitude"]),
        "energy": list(intervals["energy"]),
        "frequency": list(intervals["frequency"]) if border else empty,
    }


def packed_entries(body: dict[str, Any]) -> dict[str, Any]:
    """The long lists of integers as text."""
    rows = {key: list(map(packed, body[key])) for key in ("orbit", "direction", "inverse")}
    return rows | {"weights": packed(body["weights"])}


def potential_entries(orbit: RoundedOrbit, force: ForceSeries) -> dict[str, Any]:
    """Coefficients of a polynomial; else its functions and the degree of phi that is used."""
    potential = orbit.chain.potential
    if potential.degree is None:
        growths = [[str(x) for x in growth] for growth in force.growths]
        return {"coefficients": [], "growths": growths, "degree": force.degree}
    coefficients = [str(potential.coefficient(k)) for k in range(3, potential.degree + 1)]
    return {"coefficients": coefficients, "growths": [], "degree": potential.degree - 1}


def allowed_rows(orbit: RoundedOrbit, of_harmonics: Rows) -> list[list[int]]:
    """Of every harmonic the coefficients of the modes that the symmetry allows, ascending."""
    allowed = orbit.layout.allowed(len(of_harmonics) - 1).tolist()
    return [list(compress(*pair)) for pair in zip(of_harmonics, allowed, strict=True)]
