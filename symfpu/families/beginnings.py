"""Where families of tori begin, and whether one has come back there: tori of short series."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.frequency_shift import frequency_shift
from symfpu.errors import SymfpuError
from symfpu.families.continuation import Level, Member
from symfpu.families.extrapolation import (
    FamilyTorus,
    coefficients_at,
    coefficients_of,
)
from symfpu.files.progress import Progress
from symfpu.numbers.arithmetic import text
from symfpu.refinement.conditions import Amplitude, Condition, ratio_conditions
from symfpu.refinement.invariance import DIGITS
from symfpu.refinement.refined_torus import TOLERANCE, NoTorus, refined_torus
from symfpu.refinement.tori import refine_at_amplitudes
from symfpu.series.lindstedt import lindstedt
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.short_waves import short_waves
from symfpu.tori.torus import QTorus

GUESS_ORDER = 2  # of the series that begins a family
# relative change of an amplitude from the guess of a short series, beyond which it guesses nothing
GUESS_CHANGE = 0.3


def first_torus(
    chain: Chain,
    amplitudes: Mapping[int, float],
    *,
    energy_ratio: Mapping[int, float] | None = None,
    tolerance: float = TOLERANCE,
    progress: Progress | None = None,
) -> FamilyTorus:
    """The torus with these small amplitudes, from a short series about the lowest frequency shift.

    energy_ratio : of the averaged mode energies, by seed; then only the amplitude of the first seed
    is as given.
    """
    guess = _short_series(chain, amplitudes)
    if energy_ratio is None:
        return refine_at_amplitudes(
            guess, amplitudes, tolerance=tolerance, progress=progress
        )
    first = Amplitude(0, np.longdouble(next(iter(amplitudes.values()))))
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
) -> FamilyTorus:
    """The torus of an energy near the linear limit, from a short series with about its amplitudes.

    ratio : the s - 1 conditions beside the energy. Raises NoTorus, also where the amplitudes found
    are far from those of the series: a torus of another family may have the energy.
    """
    guess = _short_series(chain, amplitudes)
    conditions = [level.condition, *ratio]
    found = refined_torus(guess, conditions, tolerance=tolerance, progress=progress)
    astray = max(abs(found.amplitudes[q] / a - 1) for q, a in amplitudes.items())
    if astray > GUESS_CHANGE:
        raise NoTorus(
            f"an amplitude is {astray:.0%} off the one expected", found, found.residual()
        )
    return found


def _short_series(chain: Chain, amplitudes: Mapping[int, float]) -> QTorus | RingTorus:
    """The series of lowest orders about the frequencies that these amplitudes shift."""
    if chain.periodic:
        return short_waves(chain, amplitudes, GUESS_ORDER)
    shifts = frequency_shift(chain, amplitudes)
    with mpmath.workdps(DIGITS):
        shifted = [chain.linear_frequency(q) + mpmath.mpf(shifts[q]) for q in amplitudes]
        omega = [Fraction(text(w, 25)) for w in shifted]
    series = lindstedt(chain, tuple(amplitudes), omega, GUESS_ORDER)
    phases = dict.fromkeys(amplitudes, 0.0)
    return QTorus(series, dict(amplitudes), phases, 0, GUESS_ORDER)


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
    harmonics, known = coefficients_of(last.torus)
    same = coefficients_at(harmonics, other)
    difference = np.abs(known - same).max()
    return bool(difference < np.sqrt(tolerance) * np.abs(same).max())
