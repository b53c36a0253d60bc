"""Floquet exponents of a proved breather, each in a proved interval or disc.

Slopes of the true orbit in doubles and bounds, then for every guess a rounded zero, its block and
weights, and the radius of its contraction. Ours; docs/stability-proofs.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import flint
import numpy as np

from symfpu.certified.bond_balls import SPARE_BITS, BondBalls
from symfpu.certified.existence_bounds import double_above, linear_part, strip
from symfpu.certified.exponent_bounds import (
    WEIGHTS,
    Attempt,
    Choice,
    ExponentBounds,
    RoundedZero,
    Slopes,
    rounded_zero,
)
from symfpu.certified.exponents import FourierSystem, FourierZero, Guess
from symfpu.certified.force_series import ball
from symfpu.certified.rounded_orbit import RoundedOrbit
from symfpu.certified.sectors import Sector
from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress

ALL_SLOPES = 1e-14  # norm of the slopes that are left out of the residual
FIRST_REACH, WIDER, LARGEST_REACH = 1.35, 1.5, 7.0
FIRST_CUT = 1e-6  # and of |I - A DF|
LEAST_CUT = 1e-12
LOST_SHARE = 0.05  # of Z that may come from the latter
BITS = (22, 24, 26, 28, 30, 34, 38, 42, 46)
FINE_BITS, FEW = (38, 42, 46), 8  # where few exponents make short certificates anyway
CHOICE_BITS = 46
PART_OF_GAP = 16  # the enclosures are narrower than the nearest distance over this
SPARE_HARMONICS = 3  # of the solution beyond M
WIDENINGS, SMALL_END = 5, 1e-11
MANTISSA = 16
ADVICE = "an orbit further from a change of stability, or with more digits, is easier"


class NoStabilityProof(SymfpuError):
    """The bounds do not enclose an exponent, or exponents are too close to be told apart.

    Raised by `prove_stability`. exponent : sigma of the one that failed, or None. bound : "Newton",
    "Z", "weights", "Y", "cut", "gap" or "count". value : of it. needed : what it would have to
    be below, for "gap" above, dimensionless. advice : what may help. Ours.
    """

    def __init__(
        self,
        exponent: complex | None,
        bound: str,
        value: float,
        needed: float,
        advice: str,
    ) -> None:
        self.exponent, self.bound = exponent, bound
        self.value, self.needed, self.advice = value, needed, advice
        which = "" if exponent is None else f" for the exponent sigma = {_shown(exponent)}"
        name = {
            "Newton": "the last step of Newton's method",
            "Z": "the norm or spectral radius of I - A DF",
            "Y": "the Newton step, Y",
            "weights": "the largest weight of the norm",
            "cut": "what the slopes of the bonds leave out",
            "gap": "the gap to the next exponent",
            "count": "the number of exponents that were not found",
        }[bound]
        relation = "above" if bound == "gap" else "below"
        failed = f"{name} = {value:.3g} is not {relation} {needed:.3g}"
        super().__init__(f"no proof of stability{which}: {failed}; {advice}")


def _shown(sigma: complex) -> str:
    return f"{sigma.real:.6g}" if not sigma.imag else f"{sigma:.6g}"


def check_count(sectors: tuple[Sector, ...], found: list[list[Guess]]) -> None:
    """As many multipliers as there must be were seen, off 1 and -1."""
    missing = sum(s.count - len(one) for s, one in zip(sectors, found, strict=True))
    if missing:
        advice = "multipliers meet at 1, at -1 or each other: move the amplitude a little"
        raise NoStabilityProof(None, "count", missing, 1, advice)


@dataclass(frozen=True, eq=False)
class Enclosed:
    """A rounded zero, its choices and bounds, and the radius as [m, e]."""

    zero: RoundedZero
    choice: Choice
    bounds: ExponentBounds
    radius: tuple[int, int]

    @property
    def sigma_radius(self) -> Fraction:
        """Above |sigma* - sigma_0|."""
        mantissa, places = self.radius
        return Fraction(mantissa, 2**places) / Fraction(self.bounds.weight)


def enclosed_all(
    orbit: RoundedOrbit,
    radius: list[int],
    tried: list[Guess],
    progress: Progress,
    omega_off: float = 0.0,
) -> tuple[Slopes, list[Enclosed]]:
    """All of them, with as many harmonics of the slopes as the norms need.

    radius : of the proof of existence, [m, e]. omega_off : above what the frequency is off.
    """
    cut, reach = FIRST_CUT, FIRST_REACH
    exact = Fraction(radius[0], 2 ** radius[1])
    while True:
        slopes = slopes_of(orbit, exact, cut, reach, omega_off)
        try:
            return slopes, with_slopes(slopes, tried, progress)
        except NoStabilityProof as error:
            if error.bound == "cut":
                cut /= 100
            elif error.bound == "Z" and reach < LARGEST_REACH:
                reach *= WIDER
            else:
                raise


def with_slopes(slopes: Slopes, tried: list[Guess], progress: Progress) -> list[Enclosed]:
    """All of them with these harmonics."""
    result, bits = [], FINE_BITS if len(tried) <= FEW else BITS
    for done, guess in enumerate(tried):
        progress("exponents", done / len(tried))
        apart = nearest(guess, tried, slopes.omega)
        result.append(enclosed_exponent(slopes, guess, apart, bits))
    return result


def slopes_of(
    orbit: RoundedOrbit,
    radius: Fraction,
    cut: float,
    reach: float,
    omega_off: float = 0.0,
) -> Slopes:
    """The slopes of all bonds along the true orbit, in doubles and bounds."""
    N = orbit.chain.N
    with flint.ctx.workprec(orbit.bits + SPARE_BITS):
        balls = BondBalls(orbit, strip(orbit))
        part = linear_part(balls, ALL_SLOPES)
        moved = flint.arb(0)
        for bond in balls.stretches:
            size = balls.norm(bond) + ball(radius)
            moved += balls.force.curvature_bound(size) * ball(radius)
        lost = part.rest + double_above(moved)
    sizes = 2 * np.abs(part.slopes).sum(axis=1)
    tails = np.append(np.cumsum(sizes[::-1])[::-1], 0.0)
    K = max(int(np.flatnonzero(tails < cut)[0]) - 1, 1)
    K = min(K, part.K)
    errors = part.coupling_errors
    return Slopes(
        N=N,
        omega=float(orbit.omega),
        omega_off=omega_off,
        linear=orbit.chain.frequencies(),
        coupling=part.coupling,
        K=K,
        lost=lost,
        cut=(lost + float(tails[K + 1])) * (1 + 1e-9),
        entry=float(errors[0] + 2 * errors[1:].sum()),
        reach=reach,
    )


def nearest(guess: Guess, others: list[Guess], omega: float) -> float:
    """Distance to the next exponent of the sector, to 0 and to h omega/2, or its growth."""
    if not guess.circle:
        return abs(guess.value.imag)
    x, end = guess.value.real, guess.sector.folds * omega / 2
    same = (o for o in others if o.sector == guess.sector and o is not guess)
    return min([x, end - x, *(abs(o.value.real - x) for o in same)])


def enclosed_exponent(
    slopes: Slopes, guess: Guess, apart: float, bits: tuple[int, ...] = FINE_BITS
) -> Enclosed:
    """One exponent."""
    sigma = guess.value + guess.base * guess.sector.folds * slopes.omega / 2
    zero = zero_of(slopes, guess)
    if zero is None or abs(zero.value - guess.value) > apart / 2:
        moved = math.inf if zero is None else abs(zero.value - guess.value)
        raise NoStabilityProof(sigma, "Newton", moved, apart / 2, ADVICE)
    first = Attempt(slopes, rounded_zero(zero, CHOICE_BITS, slopes.N))
    choice, bound, value = first.choice()
    if choice is None:
        needed = 1.0 if bound == "Z" else float(WEIGHTS[-1])
        raise NoStabilityProof(
            sigma, bound, value, needed, f"{apart_text(apart)}; {ADVICE}"
        )
    for places in bits:
        rounded = rounded_zero(zero, places, slopes.N)
        bounds = Attempt(slopes, rounded).bounds(choice)
        if bounds.lost > LOST_SHARE and slopes.cut > LEAST_CUT + 2 * slopes.lost:
            raise NoStabilityProof(sigma, "cut", bounds.lost, LOST_SHARE, ADVICE)
        if bounds.linear >= 1:
            raise NoStabilityProof(sigma, "Z", bounds.linear, 1.0, ADVICE)
        found = bounds.radius
        if found is not None and found / bounds.weight < apart / PART_OF_GAP:
            return Enclosed(rounded, choice, bounds, dyadic_above(found))
    raise failed(sigma, bounds, apart)


def zero_of(slopes: Slopes, guess: Guess) -> FourierZero | None:
    """To rounding, with as many harmonics as that takes."""
    harmonics = slopes.free(guess.sector) + SPARE_HARMONICS
    for _ in range(WIDENINGS):
        system = FourierSystem(
            guess.sector, slopes.omega, slopes.linear, slopes.coupling, harmonics
        )
        zero = system.zero(guess)
        if zero is not None and zero.end < SMALL_END:
            return zero
        harmonics += math.ceil(harmonics / 3)
    return zero


def failed(sigma: complex, bounds: ExponentBounds, apart: float) -> NoStabilityProof:
    """Why the finest rounding does not do."""
    if bounds.radius is not None:
        width = PART_OF_GAP * bounds.radius / bounds.weight
        return NoStabilityProof(sigma, "gap", apart, width, ADVICE)
    advice = f"{apart_text(apart)}; {ADVICE}"
    return NoStabilityProof(sigma, "Y", bounds.residual, bounds.needed, advice)


def apart_text(apart: float) -> str:
    """How near the next exponent is, to rounding."""
    return f"the next exponent of its sector, or an end, is {apart:.3g} away"


def dyadic_above(x: float) -> tuple[int, int]:
    """m, e with x <= m 2^-e, m of few bits."""
    mantissa, exponent = math.frexp(x)
    return math.ceil(math.ldexp(mantissa, MANTISSA)), MANTISSA - exponent
