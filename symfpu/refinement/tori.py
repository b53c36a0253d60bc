"""q-tori by Newton's method, which solve the equations of motion to rounding.

Their series only approximate them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, overload

import numpy as np

from symfpu.errors import SymfpuError
from symfpu.files.checkpoint import checkpoint_path
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, integer, part
from symfpu.refinement.conditions import Condition
from symfpu.refinement.digits import (
    Guess,
    IterativeRefinement,
    require_digits,
    torus_to_digits,
)
from symfpu.refinement.guesses import require_moderate, require_torus
from symfpu.refinement.harmonics import MOST_HARMONICS
from symfpu.refinement.iterative_refinement import Failure
from symfpu.refinement.newton import GROWTH, Newton
from symfpu.refinement.prescribed import Prescribed, prescribed_by
from symfpu.refinement.refinement_file import require_digits_beside
from symfpu.refinement.resonances import driven_in_resonance, require_independent
from symfpu.refinement.search import Search, Solved
from symfpu.tori.best_order import best_order
from symfpu.tori.energy import Energy
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from

# residual of the equations of motion, relative to the largest acceleration, that ends the search
# for harmonics
TOLERANCE = 1e-13
REFINED_RESIDUAL = 1e-9  # of a torus up to which normal modes and others take it
NEARER = "start from a torus nearer to it, such as a member of a family from less energy"
ROUNDING_RESIDUAL = (
    1e-15  # residual of an iterate that solves the equations: it is one of many
)
DEGENERATE = (
    "the frequencies may be those of many amplitudes, as of mode N/2 in alpha: "
    "give the amplitudes, refine(torus, amplitudes=...)"
)
ENDED_EARLY = "Newton's method ended early"  # how the warning of such a torus begins


class NoTorus(SymfpuError):
    """Newton's method found no torus: raised by `refine`, its sisters and `family`.

    Where it fails with a residual of 1e-9 or less left, they give that torus with a warning.

    iterate : the best one, or where digits were asked for the
        torus from which they were tried; residual : what it leaves of the
        equations of motion, relative to the largest acceleration, dimensionless; reason : why it
        ended. Ours.
    """

    def __init__(
        self,
        reason: str,
        iterate: Torus,
        residual: float,
        advice: str = NEARER,
    ) -> None:
        self.reason, self.iterate, self.residual = reason, iterate, residual
        left = f"the best iterate leaves {residual:.2g} of the largest acceleration"
        super().__init__(
            f"no torus of the seeds {iterate.seeds}: {reason}; {left}; {advice}"
        )


def refined_torus(
    torus: Torus,
    conditions: Sequence[Condition],
    *,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
    growth: float = GROWTH,
) -> Torus[Newton]:
    """The torus near a guess that meets as many conditions as it has angles.

    With as many harmonics as the tolerance needs. growth : factor by which amplitudes may change
    from those of the guess.
    """
    require_torus(torus)
    most = integer(most_harmonics, "most_harmonics", len(torus.seeds))
    torus, advice = _best_start(torus)
    with np.errstate(over="ignore"):
        require_moderate(torus.cosines.astype(float))
    search = Search(
        torus,
        conditions,
        tolerance=part(tolerance, "tolerance"),
        most=most,
        report=progress or unheard,
        growth=growth,
    )
    solved = search()
    found = solved.torus
    if solved.failure:
        return _ended_early(solved, advice)
    if solved.warning:
        return replace(found, warnings=(_because(solved.warning, found),))
    return found


def _best_start(torus: Any) -> tuple[Any, str]:
    """The torus of a series cut where its residual is least, and what would help if that fails."""
    if not comes_from(torus, FromSeries):
        return torus, NEARER
    best = best_order(torus)
    cut = torus.origin.cut_at(best).torus(torus.phases)
    start = cut if best else torus  # the linear modes alone lead nowhere
    left = f"its series leaves {cut.residual():.2g} at its best order {best}"
    return start, f"{left}: follow the family of tori from less energy"


def _ended_early(solved: Solved, advice: str) -> Torus[Newton]:
    """The best torus there is where Newton's method failed, with a warning; else NoTorus.

    The last iterate, if nothing but rounding was left to be gained, or that of fewer harmonics.
    """
    last, reason = solved.torus, _because(solved.failure, solved.torus)
    tori = [last] if solved.iterate.at_rounding else []
    if solved.fallback is not None:
        tori.append(solved.fallback)
    best = min(tori, key=lambda torus: torus.residual(), default=None)
    if best is None or not best.residual() <= REFINED_RESIDUAL:
        residual = last.residual()
        advice = DEGENERATE if residual <= ROUNDING_RESIDUAL else advice
        raise NoTorus(reason, last, residual, advice)
    left = f"the residual is {best.residual():.2g} with {len(best.harmonics)} harmonics"
    return replace(best, warnings=(f"{ENDED_EARLY}: {reason}; {left}",))


def ended_early(torus: Torus[Newton]) -> bool:
    """Whether it is what Newton's method had reached when it failed."""
    return any(warning.startswith(ENDED_EARLY) for warning in torus.warnings)


def _because(reason: str, torus: Torus[Newton]) -> str:
    """With the resonance of a ring that may be the cause."""
    cause = (
        driven_in_resonance(torus, torus.origin.near_resonances) if torus.travels else ""
    )
    return f"{reason}; {cause}" if cause else reason


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
        guess = Guess(near, prescribed, progress or unheard)
        return torus_to_digits(guess, digits, path)
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
