"""q-tori by Newton's method, which solve the equations of motion to rounding.

Their series only approximate them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, overload

from symfpu.files.checkpoint import checkpoint_path
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number
from symfpu.refinement.digits import (
    Guess,
    IterativeRefinement,
    require_digits,
    torus_to_digits,
)
from symfpu.refinement.guesses import require_torus, shifts_of
from symfpu.refinement.harmonics import MOST_HARMONICS
from symfpu.refinement.iterative_refinement import Failure
from symfpu.refinement.prescribed import Prescribed, prescribed_by
from symfpu.refinement.refined_torus import (
    DEGENERATE,
    NEARER,
    TOLERANCE,
    USEFUL,
    Newton,
    NoTorus,
    ended_early,
    refined_torus,
)
from symfpu.refinement.refinement_file import require_digits_beside
from symfpu.refinement.umklapp import require_independent
from symfpu.tori.energy import Energy
from symfpu.tori.torus import Torus

# the tori that are given, and what is asked of them, too
__all__ = [
    "TOLERANCE",
    "USEFUL",
    "NoTorus",
    "ended_early",
    "refine",
    "refined_torus",
    "shifts_of",
]


@overload
def refine(
    torus: Torus,
    *,
    frequencies: Sequence[Number] | Mapping[int, Number] | None = ...,
    amplitudes: Mapping[int, Number] | None = ...,
    energy: Number | Energy | None = ...,
    start: Mapping[int, Number] | None = ...,
    digits: int,
    file: Path | str | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> Torus[IterativeRefinement]: ...
@overload
def refine(
    torus: Torus,
    *,
    frequencies: Sequence[Number] | Mapping[int, Number] | None = ...,
    amplitudes: Mapping[int, Number] | None = ...,
    energy: Number | Energy | None = ...,
    start: Mapping[int, Number] | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> Torus[Newton]: ...
@public
def refine(
    torus: Torus,
    *,
    frequencies: Sequence[Number] | Mapping[int, Number] | None = None,
    amplitudes: Mapping[int, Number] | None = None,
    energy: Number | Energy | None = None,
    start: Mapping[int, Number] | None = None,
    digits: int | None = None,
    file: Path | str | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> Torus[Newton] | Torus[IterativeRefinement]:
    """The torus that solves the equations of motion, near a given one.

    It has given frequencies, amplitudes, energy or start: at most one of them, exact numbers,
    dimensionless. Left out, it keeps the frequencies of `torus`.

    torus : the guess, of a series, resummed, or any other; its phases (radians) are kept. A series
        is cut at the order of the least residual, as `assess` names it. On a ring one of
        travelling waves, from `solve_amplitudes`; a ring of standing waves is refined with fixed
        ends, and unfolded.
    frequencies : omega of every seed, in their order or by seed.
    amplitudes : A_q by seed, of cos(theta_q) in Q_q.
    energy : H at the angles zero; of a ring, whose waves are nowhere at rest, averaged over the
        angles. Or an `Energy`, which may be the harmonic one and have a ratio of amplitudes or of
        averaged E_q by seed, on a ring not of opposite ones, whose E_q are equal. Without a ratio
        the amplitudes keep that which they have in `torus`.
    start : Q_q(0) by seed, 0 is allowed; phases of 0 and pi are those of an orbit that starts at
        rest. Such an orbit is on the torus but for the modes that are no seeds, whose coordinates
        at t = 0 say how far off it is. Of fixed ends.
    digits : None for doubles, or 1 .. 1000 of the largest coefficient, by iterative refinement of
        the torus in doubles or of one of fewer digits that was made so.
        Of a polynomial potential or one of exponentials and powers.
    file : with digits, a checkpoint written after every step; a run that finds one goes on from
        it, one to more digits, too.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration,
        dimensionless; harmonics are added until it is reached.
    most_harmonics : how many may be taken, if their lattice fits; what their memory is predicted
        to exceed is TorusTooLarge, before it begins.
    progress : called as (label, NO_FRACTION) on every step.

    Newton's method on the invariance equation (omega.d/dtheta)^2 Q = force(Q): Eq. eqmo on a
    torus, which the paper solves by series, with s conditions for s angles. Raises InputError, on
    a ring also for frequencies with an integer relation, and NoTorus with the best iterate.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> breather = refine(solve_amplitudes(series))
    >>> breather.residual() < 1e-13
    True
    >>> round(float(refine(breather, amplitudes={1: "0.41"}).frequency), 9)
    0.390507682
    >>> round(float(refine(breather, energy="0.012").energy()), 12)
    0.012
    """
    require_torus(torus)
    require_digits_beside(file, digits)
    prescribed = prescribed_by(
        torus,
        {
            "frequencies": frequencies,
            "amplitudes": amplitudes,
            "energy": energy,
            "start": start,
        },
    )
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    if torus.travels and prescribed.held_frequencies is not None:
        require_independent(torus, prescribed.held_frequencies)
    if digits is None:
        return refined_in_doubles(torus, prescribed, **how)
    require_digits(torus.chain, digits, "torus")
    path = None if file is None else checkpoint_path(file)
    near = _near(torus, prescribed, how)
    try:
        guess = Guess(near, prescribed)
        return torus_to_digits(guess, digits, path, progress or unheard)
    except Failure as failure:
        advice = DEGENERATE if prescribed.held_frequencies else NEARER
        raise NoTorus(str(failure), near, near.residual(), advice) from None


def refined_in_doubles(
    torus: Torus, prescribed: Prescribed, part: float = 1.0, **how: Any
) -> Torus[Newton]:
    """The torus near a guess, with frequencies as they were typed.

    part : of the way from rest. how : as of `refined_torus`.
    """
    found = refined_torus(torus, prescribed.conditions(part), **how)
    if part < 1:
        return found
    frequencies = prescribed.held_frequencies or found.frequencies
    return replace(found, frequencies=frequencies)


def _near(torus: Torus, prescribed: Prescribed, how: dict[str, Any]) -> Torus:
    """The torus from which digits are refined: the given one, if it is what is asked for."""
    if prescribed.held_frequencies == tuple(torus.frequencies):
        doubles = torus if torus.digits is None else torus.in_doubles()
        if doubles.residual() <= how["tolerance"]:
            return torus
    return refined_in_doubles(torus, prescribed, **how)
