"""q-tori by Newton's method, which solve the equations of motion to rounding.

Their series only approximate them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, overload

import numpy as np

from symfpu.errors import InputError
from symfpu.files.checkpoint import checkpoint_path
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.long_doubles import long
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, energy_of, exact
from symfpu.refinement.conditions import (
    Amplitude,
    Energy,
    FrequencyShift,
    ratio_conditions,
)
from symfpu.refinement.digits import (
    PreciseTorus,
    guess_of,
    require_digits,
    torus_to_digits,
)
from symfpu.refinement.guesses import moderate_by_seed, require_torus, shifts_of
from symfpu.refinement.harmonics import MOST_HARMONICS
from symfpu.refinement.iterative_refinement import Failure
from symfpu.refinement.refined_torus import (
    TOLERANCE,
    USEFUL,
    NoTorus,
    RefinedTorus,
    ended_early,
    refined_torus,
)
from symfpu.refinement.refinement_file import require_digits_beside
from symfpu.refinement.umklapp import require_independent
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of

REFINED = RefinedTorus, PreciseTorus

# the tori that are given, and what is asked of them, too
__all__ = [
    "TOLERANCE",
    "USEFUL",
    "NoTorus",
    "RefinedTorus",
    "ended_early",
    "refine",
    "refine_at_amplitudes",
    "refine_at_energy",
    "refined_torus",
    "shifts_of",
]


@overload
def refine(
    torus: QuasiPeriodic,
    *,
    digits: int,
    file: Path | str | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> PreciseTorus: ...
@overload
def refine(
    torus: QuasiPeriodic, *, tolerance: float = ..., progress: Progress | None = ...
) -> RefinedTorus: ...
@public
def refine(
    torus: QuasiPeriodic,
    *,
    digits: int | None = None,
    file: Path | str | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | PreciseTorus:
    """The torus with the same frequencies that solves the equations of motion.

    A given torus is the guess.

    torus : of a series, resummed, or any other; its phases (radians) are kept. A series is cut at
        the order of the least residual, as `assess` names it. On a ring one of travelling waves,
        from `solve_amplitudes`; a ring of standing waves is refined with fixed ends, and unfolded.
    digits : None for doubles, or 1 .. 1000 of the largest coefficient: a PreciseTorus, by
        iterative refinement of the torus in doubles or of a PreciseTorus of fewer digits.
        Of a polynomial potential or one of exponentials and powers.
    file : with digits, a checkpoint written after every step; a run that finds one goes on from
        it, one to more digits, too.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration,
        dimensionless; harmonics are added until it is reached.
    most_harmonics : how many may be taken, if their lattice fits; what their memory is predicted
        to exceed is TorusTooLarge, before it begins.
    progress : called as (label, NO_FRACTION) on every step.

    Newton's method on the invariance equation (omega.d/dtheta)^2 Q = force(Q): Eq. eqmo on a
    torus, which the paper solves by series. Raises InputError, on a ring also for frequencies
    with an integer relation, and NoTorus with the best iterate.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> breather = refine(solve_amplitudes(series))
    >>> breather.residual() < 1e-13
    True
    """
    require_torus(torus)
    require_digits_beside(file, digits)
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    if digits is not None:
        return _of_digits(torus, digits, None, file, how)
    if torus.travels:
        require_independent(torus)
    conditions = [FrequencyShift(i, shift) for i, shift in enumerate(shifts_of(torus))]
    refined = refined_torus(torus, conditions, **how)
    return replace(refined, frequencies=tuple(torus.frequencies))


@overload
def refine_at_amplitudes(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    digits: int,
    file: Path | str | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> PreciseTorus: ...
@overload
def refine_at_amplitudes(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedTorus: ...
@public
def refine_at_amplitudes(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    digits: int | None = None,
    file: Path | str | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | PreciseTorus:
    """The torus with the given amplitude of every seed; its frequencies are found.

    torus : the guess, of the same seeds; its phases (radians) are kept.
    amplitudes : A_q by seed, exact numbers, dimensionless; of cos(theta_q) in Q_q.
    digits, file : as of `refine`; so many digits of the frequencies, too.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration.
    most_harmonics : as of `refine`.
    progress : called as (label, NO_FRACTION) on every step.

    As `refine`, Eq. eqmo with the s frequencies among the unknowns. Raises InputError, also for a
    seed left out, and NoTorus with the best iterate.

    >>> from symfpu import Chain, torus_at_amplitudes
    >>> guess = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4"}, order=4)
    >>> round(float(refine_at_amplitudes(guess, {1: "0.41"}).frequencies[0]), 9)
    0.390507682
    """
    require_torus(torus)
    by_seed = moderate_by_seed("amplitudes", amplitudes, torus.seeds, signed=True)
    given = tuple(by_seed.values())
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    require_digits_beside(file, digits)
    if digits is not None:
        return _of_digits(torus, digits, given, file, how)
    found: RefinedTorus = _at_amplitudes(torus, given, **how)
    return found


def _at_amplitudes(torus: Any, amplitudes: Sequence[Fraction], **how: Any) -> Any:
    conditions = [Amplitude(i, long(a)) for i, a in enumerate(amplitudes)]
    return refined_torus(torus, conditions, **how)


def _of_digits(
    torus: QuasiPeriodic,
    digits: int,
    amplitudes: tuple[Fraction, ...] | None,
    file: Path | str | None,
    how: dict[str, Any],
) -> PreciseTorus:
    """The torus of the same frequencies, or of given amplitudes, with digits.

    how : tolerance, most_harmonics and progress, as of `refine`.
    """
    if torus.travels and amplitudes is None:
        require_independent(torus)
    require_digits(torus.chain, digits, "torus")
    path = None if file is None else checkpoint_path(file)
    near = _near(torus, amplitudes, how)
    frequencies = torus.frequencies if amplitudes is None else near.frequencies
    guess = guess_of(near, frequencies, amplitudes)
    try:
        return torus_to_digits(guess, digits, path, how["progress"] or unheard)
    except Failure as failure:
        raise NoTorus(str(failure), near, near.residual()) from None


def _near(
    torus: QuasiPeriodic,
    amplitudes: tuple[Fraction, ...] | None,
    how: dict[str, Any],
) -> Any:
    """The torus that refinement starts from."""
    near = torus
    if amplitudes is not None:
        near = _at_amplitudes(torus, amplitudes, **how)
    elif not isinstance(torus, REFINED):
        near = refine(torus, **how)
    return near


@public
def refine_at_energy(
    torus: QuasiPeriodic,
    energy: Number,
    *,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None = None,
    energy_ratio: Mapping[int, Number] | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus:
    """The torus with the given energy and ratio of amplitudes or mode energies.

    Its frequencies are found.

    torus : the guess, of the same seeds; its phases (radians) are kept.
    energy : an exact number, dimensionless.
    harmonic : False for the total energy H, True for the harmonic energy sum E_q, both at the
        angles zero; of a ring, whose waves are nowhere at rest, averaged over the angles.
    amplitude_ratio, energy_ratio : by seed, at most one of them; energy_ratio is of E_q of the
        seeds averaged over the torus, on a ring not of opposite ones, whose E_q are equal. Left
        out, the amplitudes keep the ratio they have in `torus`.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration.
    most_harmonics : as of `refine`.
    progress : called as (label, NO_FRACTION) on every step.

    As `refine`, Eq. eqmo with the s frequencies among the unknowns. Raises InputError, and
    NoTorus with the best iterate.

    >>> from symfpu import Chain, torus_at_amplitudes
    >>> guess = torus_at_amplitudes(Chain(N=8, alpha="0.3"), {1: "0.4"}, order=4)
    >>> round(float(refine_at_energy(guess, "0.012", harmonic=False).energy()), 12)
    0.012
    """
    require_torus(torus)
    value = energy_of(energy)
    if not isinstance(harmonic, (bool, np.bool_)):
        allowed = "True for sum E_q, False for H"
        raise InputError("harmonic", harmonic, allowed, "say which energy is meant")
    ratio = _ratio(torus, amplitude_ratio, energy_ratio)
    numbers = {q: float(x) for q, x in ratio.items()}
    conditions = [
        Energy(long(value), bool(harmonic)),
        *ratio_conditions(torus.seeds, numbers, energies=energy_ratio is not None),
    ]
    return refined_torus(
        torus,
        conditions,
        tolerance=tolerance,
        most_harmonics=most_harmonics,
        progress=progress,
    )


def _ratio(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number] | None,
    energies: Mapping[int, Number] | None,
) -> dict[int, Fraction]:
    """The one that was given, by seed, or that of the amplitudes of the guess."""
    if amplitudes is not None and energies is not None:
        allowed = "only one of amplitude_ratio and energy_ratio"
        raise InputError("energy_ratio", energies, allowed, "leave one out")
    if energies is not None:
        _require_energies(torus)
        return moderate_by_seed("energy_ratio", energies, torus.seeds, signed=False)
    if amplitudes is not None:
        return moderate_by_seed("amplitude_ratio", amplitudes, torus.seeds, signed=True)
    found = amplitudes_of(torus)
    return {q: exact(float(a), "amplitude") for q, a in found.items()}


def _require_energies(torus: QuasiPeriodic) -> None:
    """InputError for opposite seeds of a ring, which have the same E_q."""
    opposite = [q for q in torus.seeds if -q in torus.seeds]
    if opposite:
        allowed = "a ratio of modes of different energies: E_q = E_(-q) on a ring"
        given = f"of the seeds {opposite[0]} and {-opposite[0]}"
        raise InputError("energy_ratio", given, allowed, "give amplitude_ratio")
