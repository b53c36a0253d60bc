"""The torus that passes through given coordinates of its seeds at t = 0.

What an orbit's own torus is, as far as so many angles can tell: `torus_near`
(`symfpu.spectral.near`) gives a guess.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.long_doubles import long
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number
from symfpu.refinement.conditions import Start
from symfpu.refinement.guesses import numbers_by_seed
from symfpu.refinement.harmonics import MOST_HARMONICS
from symfpu.refinement.refined_torus import TOLERANCE, RefinedTorus, refined_torus
from symfpu.tori.quasiperiodic import QuasiPeriodic, require_fixed_solution


@public
def refine_at_start(
    torus: QuasiPeriodic,
    coordinates: Mapping[int, Number],
    *,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus:
    """The torus whose seeds have given coordinates at t = 0; frequencies and amplitudes are found.

    torus : the guess, of the same seeds; its phases (radians) are kept, so that 0 and pi are those
        of an orbit that starts at rest. Of fixed ends.
    coordinates : Q_q(0) by seed, exact numbers, dimensionless; 0 is allowed.
    tolerance, most_harmonics : as of `refine`.
    progress : called as (label, NO_FRACTION) on every step.

    s conditions for s angles: an orbit that starts at rest is on it but for the modes that are no
    seeds, whose coordinates at t = 0 say how far off it is. Ours; Eq. eqmo on a torus. Raises
    InputError, also for a seed left out, and NoTorus with the best iterate.

    >>> from symfpu import Chain, refine_at_start, torus_at_amplitudes
    >>> amplitudes, phases = {1: "0.4", 2: "0.02"}, {2: "3.14159265358979324"}
    >>> guess = torus_at_amplitudes(Chain(8, alpha="0.3"), amplitudes, order=4, phases=phases)
    >>> refine_at_start(guess, {1: "0.4", 2: 0}).Q(0.0)[:3].round(6) + 0.0
    array([ 0.4     ,  0.      , -0.000641])
    """
    ring = "on a ring give amplitudes to refine_at_amplitudes"
    require_fixed_solution(torus, "torus", ring)
    given = _coordinates(torus, coordinates)
    size = float(max(abs(x) for x in given.values()))
    phases = tuple(float(torus.phases[q]) for q in torus.seeds)
    conditions = [
        Start(place, long(given[q]), phases, size) for place, q in enumerate(torus.seeds)
    ]
    return refined_torus(
        torus,
        conditions,
        tolerance=tolerance,
        most_harmonics=most_harmonics,
        progress=progress,
    )


def _coordinates(torus: QuasiPeriodic, values: Mapping[int, Number]) -> dict[int, Fraction]:
    """A number for each seed, not all of them 0."""
    allowed = f"a number for each of the seeds {torus.seeds}, by seed"
    numbers = numbers_by_seed("coordinates", values, torus.seeds, allowed)
    if not any(numbers.values()):
        advice = "take the coordinates of an orbit that moves"
        raise InputError("coordinates", dict(values), f"{allowed}, not all 0", advice)
    return numbers
