"""Breathers that exist: a proof by Newton's method and a contraction, with a certificate.

In a space of cosine series c - A F(c) maps a small ball around a computed orbit into itself and
contracts it (docs/existence.md): there is one true orbit of this frequency in it.
"""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

import flint
import mpmath

from symfpu.breathers.contraction import INVERSE_BITS, WEIGHT_BITS
from symfpu.breathers.existence_bounds import (
    SPARE_BITS,
    ProofBounds,
    Radii,
    double_above,
    of_dyadic,
    proof_bounds,
    radii,
)
from symfpu.breathers.rounded_orbit import RoundedOrbit, rounded_orbit
from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.writing import write_text
from symfpu.frames.attributes import attributes
from symfpu.frames.table import Table
from symfpu.frames.tabled import Tabled
from symfpu.numbers.typed import decimal
from symfpu.tori.quasiperiodic import QuasiPeriodic

FORMAT = "symfpu existence certificate"
SCHEMA = 1
ROOM = 2  # times the radius of the stated intervals of A and H
MORE_DIGITS = "more digits may help: periodic_orbit_digits(orbit, 40)"
MORE_HARMONICS = (
    "more harmonics may help: periodic_orbit_digits(orbit, 40) takes what it needs"
)
SMALLER = "an orbit of smaller amplitude is easier"
NO_ORBIT = "more digits of it do not help: Newton's method, periodic_orbit, finds orbits"
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


@dataclass(frozen=True, eq=False, kw_only=True)
class ExistenceProof(Tabled):
    """A theorem: the chain has a periodic orbit of this frequency near the computed one.

    chain, seed : the model and the mode. frequency : omega, exact.
    radius : above the distance of the true orbit from the computed one: of every stretch of a
        bond at all times, and of the weighted sum of all Fourier coefficients. unique : within it
        there is no other one of the same symmetry. nu : the orbit is analytic where
        |Im omega t| < log nu.
    amplitude, amplitude_radius, energy, energy_radius : intervals that hold A and H, mpf and
        doubles.
    residual, linear, curvature : Y, Z0 + Z1 and Z2 of the theorem, doubles.
    harmonics, block : of the orbit, and unknowns in the dense part of the inverse.
    digits : of the orbit that was given. body : the certificate without its digest. Dimensionless.
        Ours: docs/existence.md.

    >>> from symfpu import Chain, periodic_orbit, prove_existence
    >>> prove_existence(periodic_orbit(Chain(N=8, alpha="0.3"), 1, "0.3905"))
    ExistenceProof(N=8, alpha=0.3, seed 1, omega=0.3905: a periodic orbit within ... of the
    computed one, the only one within ...; A = 0.4051586230... +- ..., H = 0.01279842208... +- ...)
    """

    chain: Chain
    seed: int
    frequency: Fraction
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

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        omega = decimal(self.frequency)
        found = f"a periodic orbit within {self.radius:.2g} of the computed one"
        only = f"the only one within {self.unique:.2g}"
        A = interval_text(self.amplitude, self.amplitude_radius)
        H = interval_text(self.energy, self.energy_radius)
        case = f"{chain}, seed {self.seed}, omega={omega}"
        return f"ExistenceProof({case}: {found}, {only}; A = {A}, H = {H})"

    def certificate(self) -> dict[str, Any]:
        """What `symfpu verify` needs to check the theorem again: integers and strings."""
        text = json.dumps(self.body, sort_keys=True, separators=(",", ":"))
        digest = hashlib.sha256(text.encode()).hexdigest()
        return self.body | {"digest": digest}

    def write(self, path: Path | str) -> None:
        """Write the certificate to a path as JSON, whole or not at all.

        Raises InputError if the file cannot be written.
        """
        text = json.dumps(self.certificate(), separators=(",", ":"))
        write_text(Path(path), text + "\n")

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
    """A number with the digits that its radius leaves, and the radius."""
    size = abs(float(middle)) or 1.0
    digits = max(2, math.ceil(math.log10(size / radius)) + 1) if radius else 17
    with mpmath.workdps(digits + 5):
        return f"{mpmath.nstr(middle, digits)} +- {radius:.1g}"


def prove_existence(orbit: QuasiPeriodic) -> ExistenceProof:
    """A proof that the chain has a periodic orbit near the computed one, or an error that says why.

    orbit : of one angle, of a chain with fixed ends and a polynomial potential: from
        `periodic_orbit`, `periodic_orbit_digits`, `breather_at_energy` and their sisters, or a
        series of one seed. Its phase does not matter. All is dimensionless.

    Newton's method and a contraction in a weighted space of Fourier coefficients, every rounding
    bounded (docs/existence.md; ours): the orbit exists with the frequency exactly as given, is the
    only one nearby, and analytic. The radius falls with the digits of the orbit.
    Raises InputError for what is not such an orbit; NoExistenceProof with the bound that failed:
    that is no proof that there is none.

    >>> from symfpu import Chain, periodic_orbit
    >>> proof = prove_existence(periodic_orbit(Chain(N=2, beta=1), 1, "1.5"))
    >>> proof.radius < 1e-13 < 1e-4 < proof.unique
    True
    """
    checked = checked_orbit(orbit)
    rounded = rounded_orbit(checked)
    with flint.ctx.workprec(rounded.bits + SPARE_BITS):
        bounds, linear = proof_bounds(rounded)
        if bounds is None:
            raise NoExistenceProof("Z1", linear, 1.0, f"{MORE_HARMONICS}; {SMALLER}")
        found = radii(bounds)
        if found is None:
            bound, value, needed, advice = not_small(bounds)
            raise NoExistenceProof(bound, value, needed, advice)
        return assembled(rounded, bounds, found)


def checked_orbit(orbit: object) -> QuasiPeriodic:
    """An orbit that the theorem is about; InputError for any other, by name."""
    if not isinstance(orbit, QuasiPeriodic) or orbit.chain.periodic:
        chain = getattr(orbit, "chain", None)
        given = (
            type(orbit).__name__
            if chain is None
            else f"{type(orbit).__name__} of {chain!r}"
        )
        allowed = "a solution of one angle of a chain with fixed ends"
        raise InputError("orbit", given, allowed, "take one from periodic_orbit")
    if len(orbit.seeds) > 1:
        given = f"a torus of {len(orbit.seeds)} angles"
        raise InputError("orbit", given, "a solution of one angle", "take one seed")
    potential = orbit.chain.potential
    if potential.degree is None or not potential.exact:
        allowed = "a polynomial potential with exact coefficients"
        advice = "take poly: with its first coefficients"
        raise InputError("chain", orbit.chain, allowed, advice)
    return orbit


def not_small(bounds: ProofBounds) -> tuple[str, float, float, str]:
    """The bound that failed, Y for it is too large, what was needed, and what may help."""
    Y = double_above(bounds.residual)
    at_zero = double_above(bounds.curvature(flint.arb(0)))
    needed = (1 - bounds.linear) ** 2 / (4 * at_zero) if at_zero else math.inf
    size = float(sum(abs(bounds.balls.orbit.floats).max(axis=0)))
    if FAR * size < Y:
        return "Y", Y, needed, NO_ORBIT
    tail = double_above(bounds.beyond) > Y / 2
    return "Y", Y, needed, MORE_HARMONICS if tail else MORE_DIGITS


def assembled(orbit: RoundedOrbit, bounds: ProofBounds, found: Radii) -> ExistenceProof:
    """The result with its certificate."""
    radius, unique = of_dyadic(found.existence), of_dyadic(found.uniqueness)
    around = flint.arb(flint.fmpq(radius.numerator, radius.denominator))
    amplitude = stated(bounds.balls.amplitude(around), orbit.bits)
    energy = stated(bounds.balls.energy(around), orbit.bits)
    A, A_radius = interval(amplitude)
    H, H_radius = interval(energy)
    curvature = bounds.curvature(
        flint.arb(flint.fmpq(unique.numerator, unique.denominator))
    )
    return ExistenceProof(
        chain=orbit.chain,
        seed=orbit.seed,
        frequency=orbit.omega,
        radius=math.nextafter(float(radius), math.inf),
        unique=math.nextafter(float(unique), 0),
        nu=bounds.balls.strip,
        amplitude=A,
        amplitude_radius=A_radius,
        energy=H,
        energy_radius=H_radius,
        residual=double_above(bounds.residual),
        linear=bounds.linear,
        curvature=double_above(curvature),
        harmonics=orbit.harmonics,
        block=len(bounds.found.block),
        digits=orbit.digits,
        body=certificate_body(orbit, bounds, found, amplitude, energy),
    )


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


def certificate_body(
    orbit: RoundedOrbit,
    bounds: ProofBounds,
    found: Radii,
    amplitude: Interval,
    energy: Interval,
) -> dict[str, Any]:
    """The certificate without its digest."""
    choice, potential = bounds.found, orbit.chain.potential
    assert potential.degree is not None
    coefficients = [potential.coefficient(k) for k in range(3, potential.degree + 1)]
    places = choice.places
    block = [[int(places.n[i]), int(places.q[i])] for i in choice.block]
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "N": orbit.chain.N,
        "coefficients": [str(c) for c in coefficients],
        "seed": orbit.seed,
        "omega": str(orbit.omega),
        "nu": str(bounds.balls.strip),
        "bits": orbit.bits,
        "orbit": allowed_rows(orbit),
        "slope_harmonics": choice.part.K,
        "free": choice.free,
        "block": block,
        "inverse_bits": INVERSE_BITS,
        "inverse": choice.inverse.tolist(),
        "weight_bits": WEIGHT_BITS,
        "weights": choice.weights.tolist(),
        "radius": list(found.existence),
        "unique": list(found.uniqueness),
        "amplitude": list(amplitude),
        "energy": list(energy),
    }


def allowed_rows(orbit: RoundedOrbit) -> list[list[int]]:
    """Of every harmonic the coefficients of the modes that the symmetry allows, ascending."""
    even, rows = orbit.chain.potential.even, []
    for n, row in enumerate(orbit.rows):
        first = 0 if n * orbit.seed % 2 else 1
        absent = even and n % 2 == 0
        rows.append([] if absent else list(row[first::2]))
    return rows
