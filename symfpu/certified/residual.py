"""What a computed torus leaves of the equations of motion, at all angles: a proof."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Protocol

import mpmath

from symfpu.certified.growth import rounded_up
from symfpu.certified.rounded_torus import (
    GUARD_BITS,
    RoundedTorus,
    residual_of,
    rounded_torus,
)
from symfpu.certified.series import Series
from symfpu.certified.torus_energy import EnergyBall, energy_of
from symfpu.chain.chain import Chain
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.arithmetic import with_digits
from symfpu.numbers.one_sided import above
from symfpu.numbers.public import public
from symfpu.proofs.certified import Certified
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, chain_fields, exact_by_seed, seeds_field
from symfpu.results.table import Table
from symfpu.tori.torus import Torus

FORMAT = "symfpu torus certificate"
SCHEMA = 2
SLACK = Fraction(1025, 1024)
SHOWN_BITS = 53
BOUND_DIGITS = 15

Body = dict[str, Any]


class TorusProof(Protocol):
    """What all theorems about a computed torus say of it."""

    @property
    def chain(self) -> Chain: ...
    @property
    def seeds(self) -> tuple[int, ...]: ...
    @property
    def frequencies(self) -> tuple[Fraction, ...]: ...
    @property
    def theorem(self) -> str: ...
    @property
    def harmonics(self) -> int: ...
    @property
    def digits(self) -> int: ...


def torus_proof_fields(proof: TorusProof) -> Iterator[Field]:
    """Which torus a theorem is about."""
    yield from chain_fields(proof.chain)
    yield seeds_field(proof.seeds)
    omega = dict(zip(proof.seeds, proof.frequencies, strict=True))
    yield Field("frequencies", exact_by_seed(omega))
    yield Field("proved", True)
    yield Field("theorem", proof.theorem, "theorem")
    yield Field("harmonics", proof.harmonics, "harmonics")
    yield Field("digits", proof.digits, "digits")


def torus_words(proof: TorusProof) -> str:
    """Which torus a theorem is about, in words."""
    seeds = ", ".join(map(str, proof.seeds))
    harmonics = f"{proof.harmonics} harmonics, {proof.digits} digits"
    return f"{proof.chain.label}, seeds {seeds}, {harmonics}"


def bound_text(x: Any) -> str:
    """A proved bound, a fraction or a number of mpmath, in fifteen digits."""
    number = mpmath.mpf(x.numerator) / x.denominator if hasattr(x, "numerator") else x
    return str(mpmath.nstr(number, BOUND_DIGITS))


@public
@dataclass(frozen=True, eq=False, kw_only=True)
class ResidualProof(Certified):
    """A theorem: what a torus leaves of the equations of motion, at all angles.

    chain, seeds, frequencies : the model and the angles; frequencies exact.
    bound : above |x_j'' - force on x_j| of every particle j at all angles of the torus, mpf: the
        largest of `particles`, shape (N-1,), each the sum of the sizes of all coefficients.
    relative : above bound over the largest of the particles' accelerations, mpf.
    energy, energy_radius : at all angles |H - energy| <= energy_radius, mpf; None where nu.omega
        is zero for a harmonic that H can have.
    harmonics : of the torus, one of each pair +-nu. digits : of the torus that was given; the
        theorem is about its coefficients rounded some 20 bits below the last digit.
    body : the certificate without its digest. Dimensionless. Ours: docs/tori-proofs.md.

    >>> import symfpu
    >>> from symfpu import Chain, prove_residual, refine
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> torus = symfpu.torus(Chain(N=4, alpha="0.3"), (1, 2), amplitudes=amplitudes, digits=30)
    >>> prove_residual(torus)
    ResidualProof(N=4, alpha=0.3, omega_1=0.76..., omega_2=1.41..., 30 digits: residual below
    ... of every particle at all angles, H within ..., ... of the largest acceleration)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    bound: Any
    particles: tuple[Any, ...] = field(repr=False)
    relative: Any
    energy: Any
    energy_radius: Any
    harmonics: int
    digits: int
    body: Body = field(repr=False)

    def _certificate_body(self) -> dict[str, Any]:
        return self.body

    def _lines(self, width: int | None) -> Iterator[str]:
        """The theorem."""
        bound, relative = (mpmath.nstr(x, 3) for x in (self.bound, self.relative))
        yield f"{torus_words(self)}: proved"
        below = f"below {bound} of every particle at all angles"
        yield f"  the residual of the equations of motion is {below},"
        yield f"  {relative} of the largest acceleration"
        if self.energy is None:
            yield "  of its energy nothing is proved: a harmonic of it has nu.omega = 0"
        else:
            radius = above(self.energy_radius, 3)
            yield f"  H is within {radius} of {self.energy} at all angles"

    def _fields(self) -> Iterator[Field]:
        """Bounds are texts, as they may be below all doubles."""
        yield from torus_proof_fields(self)
        yield Field("bound", bound_text(self.bound), "residual below")
        yield Field("relative", bound_text(self.relative))
        known = self.energy is not None
        yield Field("energy", str(self.energy) if known else None)
        yield Field("energy_radius", bound_text(self.energy_radius) if known else None)

    def __repr__(self) -> str:
        part = above(self.relative, 3)
        which = torus_text(self.chain, self.seeds, self.frequencies)
        return (
            f"ResidualProof({which}, {self.digits} digits: {self._text}, "
            f"{part} of the largest acceleration)"
        )

    @property
    def _text(self) -> str:
        size = above(self.bound, 3)
        energy = "" if self.energy is None else f", H within {above(self.energy_radius, 3)}"
        return f"residual below {size} of every particle at all angles{energy}"

    @property
    def theorem(self) -> str:
        """What is proved, in one sentence."""
        energy = "" if self.energy is None else f" of {self.energy}"
        return (
            f"{torus_text(self.chain, self.seeds, self.frequencies)}: {self._text}{energy}"
        )

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, exact."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    def _table(self) -> Table:
        """One row for each particle."""
        bounds = [float(x) for x in self.particles]
        known = attributes(self, self.chain, seeds=self.seeds, frequencies=self.frequencies)
        return Table({"particle": list(range(1, self.chain.N)), "bound": bounds}, known)


def torus_text(
    chain: Chain, seeds: tuple[int, ...], frequencies: tuple[Fraction, ...]
) -> str:
    """The chain and the frequencies in words."""
    name = chain.label
    pairs = zip(seeds, frequencies, strict=True)
    return ", ".join([name, *(f"omega_{q}={float(w):.10g}" for q, w in pairs)])


@public
def prove_residual(torus: Torus, *, progress: Progress | None = None) -> ResidualProof:
    """A proof of how well a torus solves the equations of motion, at all angles at once.

    torus : of two or more angles, fixed ends and a polynomial potential, from `refine` and its
        sisters in doubles or with `digits`; also a series. Dimensionless.
    progress : called as (label, fraction), once a bond.

    The residual of a trigonometric polynomial is one; the sum of the sizes of its coefficients,
    in integers with exact products, is above it at every angle (docs/tori-proofs.md; ours).
    Raises InputError for what is not such a torus.

    >>> import symfpu
    >>> from symfpu import Chain, prove_residual, refine
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> torus = symfpu.torus(Chain(N=3, beta=1), (1, 2), amplitudes=amplitudes, digits=40)
    >>> prove_residual(torus).bound < 1e-38
    True
    """
    rounded = rounded_torus(torus)
    found = residual_of(rounded, progress or unheard)
    return residual_proof(rounded, [series.norm for series in found])


def residual_proof(torus: RoundedTorus, found: list[Fraction]) -> ResidualProof:
    """The result of the norms of a residual."""
    bounds = [rounded_up(x * SLACK) for x in found]
    bound = max(bounds)
    energy = stated_energy(torus, energy_of(torus, found))
    return ResidualProof(
        chain=torus.chain,
        seeds=torus.seeds,
        frequencies=torus.omega,
        bound=shown(bound),
        particles=tuple(shown(x) for x in bounds),
        relative=shown(bound) / root_mean_square(torus) * (1 + mpmath.mpf(2) ** -40),
        energy=energy and in_digits(energy.middle, torus.digits),
        energy_radius=energy and shown(energy.radius),
        harmonics=harmonics_of(torus),
        digits=torus.digits,
        body=residual_body(torus, bound, energy),
    )


def stated_energy(torus: RoundedTorus, found: EnergyBall | None) -> EnergyBall | None:
    """With a middle of so many places as the torus, and a radius of few bits."""
    if found is None:
        return None
    unit = Fraction(1, 1 << (torus.bits + GUARD_BITS))
    middle = round(found.middle / unit) * unit
    apart = found.radius + abs(middle - found.middle)
    return EnergyBall(middle, rounded_up(SLACK * apart))


def in_digits(x: Fraction, digits: int) -> Any:
    """mpf of a dyadic number, exact, that prints so many digits."""
    with mpmath.workprec(max(SHOWN_BITS, abs(x.numerator).bit_length())):
        return with_digits(mpmath.mpf(x.numerator) / x.denominator, digits)


def shown(x: Fraction) -> Any:
    """mpf of SHOWN_BITS bits, not below."""
    with mpmath.workprec(SHOWN_BITS):
        return mpmath.fdiv(x.numerator, x.denominator, rounding="u") if x else mpmath.mpf(0)


def root_mean_square(torus: RoundedTorus) -> Any:
    """The largest root mean square of a particle's acceleration: no maximum is less."""
    most = Fraction(0)
    for x in torus.particles:
        turned = x.turned(torus.omega, Fraction(0), power=2).values
        most = max(most, Fraction(int((turned * turned).sum()), 1 << (2 * x.places)))
    with mpmath.workprec(SHOWN_BITS):
        square = mpmath.fdiv(most.numerator, most.denominator, rounding="d")
        return mpmath.sqrt(square, rounding="d") * (1 - mpmath.mpf(2) ** -40)


def harmonics_of(torus: RoundedTorus) -> int:
    """How many the rounded torus has, one of each pair."""
    return len(cosine_rows(torus.particles))


def cosine_rows(particles: tuple[Series, ...]) -> list[list[int]]:
    """[nu, x_1 .., x_(N//2)] of half of the harmonics of even functions."""
    return [row for row in rows_of(particles) if first_sign(row, particles) >= 0]


def first_sign(row: list[int], particles: tuple[Series, ...]) -> int:
    """The sign of the first number of nu that is not 0; 0 for nu = 0."""
    s = particles[0].values.ndim
    first = next((n for n in row[:s] if n), 0)
    return (first > 0) - (first < 0)


def rows_of(particles: tuple[Series, ...]) -> list[list[int]]:
    """[nu, x_1 .., x_(N//2)] of every harmonic; the other particles follow by reflection."""
    count = (len(particles) + 1) // 2
    rows: dict[tuple[int, ...], list[int]] = {}
    for j, series in enumerate(particles[:count]):
        for place, value in nonzero(series):
            rows.setdefault(place, [0] * count)[j] = value
    return [[*nu, *rows[nu]] for nu in sorted(rows)]


def nonzero(series: Series) -> list[tuple[tuple[int, ...], int]]:
    """Harmonics and values."""
    highest = series.highest
    found = []
    for at in zip(*(series.values != 0).nonzero(), strict=True):
        nu = tuple(int(n) - m for n, m in zip(at, highest, strict=True))
        found.append((nu, int(series.values[at])))
    return found


def residual_body(torus: RoundedTorus, bound: Fraction, energy: EnergyBall | None) -> Body:
    """The certificate of a residual without its digest; what concerns a stay is empty."""
    potential = torus.chain.potential
    assert potential.degree is not None
    coefficients = [potential.coefficient(k) for k in range(3, potential.degree + 1)]
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "N": torus.chain.N,
        "coefficients": [str(c) for c in coefficients],
        "seeds": list(torus.seeds),
        "omega": [str(w) for w in torus.omega],
        "bits": torus.bits,
        "torus": cosine_rows(torus.particles),
        "residual": dyadic_pair(bound),
        "energy": [dyadic_pair(x) for x in energy or ()],
        "frame_bits": 0,
        "rate_bits": 0,
        "directions": [],
        "weights": [],
        "stay": [],
    }


def dyadic_pair(x: Fraction) -> list[int]:
    """[m, e] of m 2^-e, e an integer of any sign."""
    if x.denominator == 1:
        return [x.numerator, 0]
    places = x.denominator.bit_length() - 1
    return [x.numerator, places]
