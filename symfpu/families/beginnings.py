"""Where families of tori begin, and whether one has come back there: tori of short series."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from symfpu.breathers.from_rest import FIRST_SHIFT, FIRST_STRETCH
from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.families.members import Level, Member, linear_by_mode
from symfpu.files.progress import Progress
from symfpu.refinement.conditions import Condition, amplitude, ratio_conditions
from symfpu.refinement.harmonics import by_harmonic, coefficients_at
from symfpu.refinement.newton import Newton
from symfpu.refinement.tori import TOLERANCE, NoTorus, refine, refined_torus
from symfpu.tori.short_series import shifts_by_squares, short_series
from symfpu.tori.torus import Torus

GUESS_ORDER = 2  # of the series that begins a family
# relative change of an amplitude from the guess of a short series, beyond which it guesses nothing
GUESS_CHANGE = 0.3
LOWERED = Fraction(1, 1000)  # of a first energy that is not below the goal


def first_torus(
    chain: Chain,
    amplitudes: Mapping[int, float],
    *,
    energy_ratio: Mapping[int, float] | None = None,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> Torus[Newton]:
    """The torus with these small amplitudes, from a short series about the lowest frequency shift.

    energy_ratio : of the averaged mode energies, by seed; then only the amplitude of the first seed
    is as given.
    """
    guess = short_series(chain, amplitudes, GUESS_ORDER)
    if energy_ratio is None:
        return refine(guess, amplitudes=amplitudes, tolerance=tolerance, progress=progress)
    A = np.longdouble(next(iter(amplitudes.values())))
    first = amplitude(0, A, len(amplitudes))
    conditions = [first, *ratio_conditions(tuple(amplitudes), energy_ratio, energies=True)]
    return refined_torus(guess, conditions, tolerance=tolerance, progress=progress)


def first_at(
    level: Level,
    chain: Chain,
    amplitudes: Mapping[int, float],
    ratio: Sequence[Condition],
    *,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> Torus[Newton]:
    """The torus of an energy near the linear limit, from a short series with about its amplitudes.

    ratio : the s - 1 conditions beside the energy. Raises NoTorus, also where the amplitudes found
    are far from those of the series: a torus of another family may have the energy.
    """
    guess = short_series(chain, amplitudes, GUESS_ORDER)
    conditions = [level.condition, *ratio]
    found = refined_torus(guess, conditions, tolerance=tolerance, progress=progress)
    astray = max(abs(found.amplitudes[q] / a - 1) for q, a in amplitudes.items())
    if astray > GUESS_CHANGE:
        raise NoTorus(
            f"an amplitude is {astray:.0%} off the one expected", found, found.residual()
        )
    return found


def first_energy(chain: Chain, amplitudes: Mapping[int, float], goal: Fraction) -> Fraction:
    """Where a family begins by default: where tori are still near the linear limit.

    amplitudes : of the ratio that is followed. The energy of the linear chain, to two digits, at
    which a frequency is shifted by FIRST_SHIFT of itself or a bond may be stretched by
    FIRST_STRETCH. It does not depend on the goal, but that it is lowered a thousandfold, as often
    as needed, to lie below.

    Raises ResonantDivisor on a ring with a resonance of the lowest order.
    """
    linear = linear_by_mode(chain, amplitudes)
    sizes = np.array(list(amplitudes.values()))
    shifts = shifts_by_squares(chain, tuple(amplitudes)) @ sizes**2
    rates = np.array(list(linear.values()))
    relative = float(np.max(np.abs(shifts) / rates))
    stretch = math.sqrt(2 / chain.N) * float(rates @ np.abs(sizes))
    square = (FIRST_STRETCH / stretch) ** 2
    if relative:
        square = min(square, FIRST_SHIFT / relative)
    energy = square * float(np.sum((rates * sizes) ** 2)) / 2
    first = Fraction(f"{energy:.1e}")
    while first >= goal:
        first *= LOWERED
    return first


def returned(members: Sequence[Member], *, tolerance: float) -> bool:
    """Whether a family has come back to the linear limit.

    It is below where it began, at the torus that the series there lead to.

    Two tori of the same amplitudes nearer to each other than the root of the tolerance are one:
    Newton's method leads from one to the other.
    """
    if len(members) < 3:
        return False
    first, (before, last) = members[0], members[-2:]
    if not last.energy < min(first.energy, before.energy):
        return False
    if any(abs(last.amplitudes[q]) >= abs(a) for q, a in first.amplitudes.items()):
        return False
    try:
        other = first_torus(first.torus.chain, last.amplitudes, tolerance=tolerance)
    except SymfpuError:
        return False
    harmonics, known = last.torus.harmonics, last.torus.cosines
    same = coefficients_at(harmonics, by_harmonic(other.harmonics, other.cosines))
    difference = np.abs(known - same).max()
    return bool(difference < np.sqrt(tolerance) * np.abs(same).max())
