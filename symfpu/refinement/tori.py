"""q-tori by Newton's method, which solve the equations of motion to rounding.

Their series only approximate them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from numbers import Real
from pathlib import Path
from typing import Any, overload

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError, SymfpuError
from symfpu.files.checkpoint import checkpoint_path
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.typed import Number, exact, integer
from symfpu.refinement.conditions import (
    Amplitude,
    Condition,
    Energy,
    FrequencyShift,
    ratio_conditions,
    seed_amplitudes,
)
from symfpu.refinement.digits import (
    Failure,
    PreciseTorus,
    guess_of,
    precise_torus,
    require_digits,
    resumed,
)
from symfpu.refinement.equation import Floats, Ints
from symfpu.refinement.harmonics import MOST_HARMONICS, known_rows
from symfpu.refinement.invariance import DIGITS, InvarianceEquation, long
from symfpu.refinement.kept_sweeps import SweepsFile, require_digits_beside, unkept
from symfpu.refinement.newton import Iterate, NewtonStep
from symfpu.refinement.resonances import NearResonance, near_resonances
from symfpu.refinement.ring_tori import (
    RefinedRingTorus,
    driven_in_resonance,
    refined_waves,
    require_independent,
)
from symfpu.refinement.search import Search, Unknowns
from symfpu.refinement.waves import WaveEquation
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of, require_solution
from symfpu.tori.ring_torus import RingTorus
from symfpu.tori.travelling import require_travelling, wave_coefficients

# residual of the equations of motion, relative to the largest acceleration, that ends the search
# for harmonics
TOLERANCE = 1e-13
LEAST_SIZE = Fraction(1, 10**40)  # of amplitudes and coefficients
USEFUL = 1e-9  # residual of a torus up to which normal modes and others take it
ENDED_EARLY = "Newton's method ended early"  # how the warning of such a torus begins


@dataclass(frozen=True, eq=False)
class RefinedTorus(QuasiPeriodic):
    """A torus found by Newton's method, Q_q(t) = sum c_q[nu] cos(nu.(omega t + phi)).

    Made by `refine` and its sisters; dimensionless, phases in radians. Ours: the paper has series
    alone.

    chain, seeds : the model and the s seeds. frequencies : omega of every seed, exact, shape (s,).
    amplitudes : by seed, of cos(theta_q) in Q_q. phases : by seed.
    harmonics : the nu, shape (H, s). cosines : c_q[nu] in doubles, shape (H, N-1).
    steps : of Newton's method with the final harmonics.
    near_resonances : the smallest divisors (nu.omega)^2 - Omega_q^2, with the coefficients under
        them.
    warnings : reasons to doubt it: a residual above the tolerance, or that Newton's method failed
        when it had reached a residual of 1e-9 or less. digits : None, of doubles.

    >>> from symfpu import Chain, lindstedt, refine, solve_amplitudes
    >>> refine(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)))
    RefinedTorus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.0127984220834,
    20 harmonics, residual ..., smallest divisor 0.024 at mode 2, harmonic (2), coefficient 0.031)
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    amplitudes: Mapping[int, float]
    phases: Mapping[int, float]
    harmonics: Ints = field(repr=False)
    cosines: Floats = field(repr=False)
    steps: tuple[NewtonStep, ...] = field(repr=False)
    near_resonances: tuple[NearResonance, ...] = field(repr=False)
    warnings: tuple[str, ...] = ()
    digits: int | None = None

    @property
    def verdict(self) -> str:
        """'torus', or 'doubtful' with the reasons in `warnings`."""
        return "doubtful" if self.warnings else "torus"

    def __repr__(self) -> str:
        chain = repr(self.chain)[6:-1]
        amplitudes = ", ".join(f"A_{q}={a:.13g}" for q, a in self.amplitudes.items())
        by_seed = zip(self.seeds, self.frequencies, strict=True)
        rates = ", ".join(f"omega_{q}={float(w):.16g}" for q, w in by_seed)
        energy = float(self.energy())
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        nearest = (
            f", smallest divisor {self.near_resonances[0]}" if self.near_resonances else ""
        )
        found = f"{len(self.harmonics)} harmonics, residual {self.residual():.2g}"
        return (
            f"RefinedTorus({chain}, {rates}, {amplitudes}, H={energy:.12g}, "
            f"{found}{nearest}{doubts})"
        )


class NoTorus(SymfpuError):
    """Newton's method found no torus: raised by `refine`, its sisters and `family`.

    Where it fails with a residual of 1e-9 or less left, they give that torus with a warning.

    iterate : the best one, a RefinedTorus or RefinedRingTorus, or where digits were asked for the
        torus from which they were tried; residual : what it leaves of the
        equations of motion, relative to the largest acceleration, dimensionless; reason : why it
        ended. Ours.
    """

    def __init__(
        self, reason: str, iterate: QuasiPeriodic | RefinedRingTorus, residual: float
    ) -> None:
        self.reason, self.iterate, self.residual = reason, iterate, residual
        left = f"the best iterate leaves {residual:.2g} of the largest acceleration"
        advice = "start from a torus nearer to it, such as one of less energy"
        super().__init__(
            f"no torus of the seeds {iterate.seeds}: {reason}; {left}; {advice}"
        )


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
    torus: RingTorus, *, tolerance: float = ..., progress: Progress | None = ...
) -> RefinedRingTorus: ...
@overload
def refine(
    torus: QuasiPeriodic, *, tolerance: float = ..., progress: Progress | None = ...
) -> RefinedTorus: ...
def refine(
    torus: QuasiPeriodic | RingTorus,
    *,
    digits: int | None = None,
    file: Path | str | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | RefinedRingTorus | PreciseTorus:
    """The torus with the same frequencies that solves the equations of motion.

    A given torus is the guess.

    torus : of a series, resummed, or any other; its phases (radians) are kept. On a ring one of
        travelling waves, from `travelling_torus`; a RefinedRingTorus comes back.
    digits : None for doubles, or 1 .. 1000 of the largest coefficient: a PreciseTorus, whose sweeps
        start from the torus in doubles, or from a PreciseTorus of fewer digits where they ended.
        Of fixed ends, a polynomial potential or one of exponentials and powers.
    file : with digits, a checkpoint written after every sweep; a run that finds one goes on from
        it, one to more digits, too.
    tolerance : of the residual of the equations of motion, relative to the largest acceleration,
        dimensionless; harmonics are added until it is reached.
    most_harmonics : how many may be taken, if their lattice fits; what their memory is predicted
        to exceed is TorusTooLarge, before it begins.
    progress : called as (label, NO_FRACTION) on every step.

    Newton's method on the invariance equation (omega.d/dtheta)^2 Q = force(Q): Eq. eqmo on a
    torus, which the paper solves by series. Raises InputError, on a ring also for frequencies
    with an integer relation and for digits, and NoTorus with the best iterate.

    >>> from symfpu.tori.amplitudes import solve_amplitudes
    >>> from symfpu.series.lindstedt import lindstedt
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> breather = refine(solve_amplitudes(series))
    >>> breather.residual() < 1e-13
    True
    """
    _require_torus(torus)
    require_digits_beside(file, digits)
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    if digits is not None:
        return _of_digits(torus, digits, None, file, **how)
    if isinstance(torus, RingTorus):
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
    torus: RingTorus,
    amplitudes: Mapping[int, Number],
    *,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedRingTorus: ...
@overload
def refine_at_amplitudes(
    torus: QuasiPeriodic,
    amplitudes: Mapping[int, Number],
    *,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedTorus: ...
def refine_at_amplitudes(
    torus: QuasiPeriodic | RingTorus,
    amplitudes: Mapping[int, Number],
    *,
    digits: int | None = None,
    file: Path | str | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | RefinedRingTorus | PreciseTorus:
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
    _require_torus(torus)
    given = tuple(_by_seed("amplitudes", amplitudes, torus, signed=True).values())
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    require_digits_beside(file, digits)
    if digits is not None:
        return _of_digits(torus, digits, given, file, **how)
    found: RefinedTorus | RefinedRingTorus = _at_amplitudes(torus, given, **how)
    return found


def _at_amplitudes(torus: Any, amplitudes: Sequence[Fraction], **how: Any) -> Any:
    conditions = [Amplitude(i, long(a)) for i, a in enumerate(amplitudes)]
    return refined_torus(torus, conditions, **how)


def _of_digits(
    torus: QuasiPeriodic | RingTorus,
    digits: int,
    amplitudes: tuple[Fraction, ...] | None,
    file: Path | str | None,
    *,
    tolerance: float,
    most_harmonics: int,
    progress: Progress | None,
) -> PreciseTorus:
    """The torus of the same frequencies, or of given amplitudes, with digits."""
    if isinstance(torus, RingTorus):
        allowed = "nothing for a torus on a ring, which is refined in doubles"
        raise InputError("digits", digits, allowed, "leave it out")
    require_digits(torus.chain, digits)
    path = None if file is None else checkpoint_path(file)
    how: dict[str, Any] = {
        "tolerance": tolerance,
        "most_harmonics": most_harmonics,
        "progress": progress,
    }
    near: QuasiPeriodic
    if amplitudes is not None:
        near = _at_amplitudes(torus, amplitudes, **how)
    elif isinstance(torus, (RefinedTorus, PreciseTorus)):
        near = torus
    else:
        near = refine(torus, **how)
    frequencies = near.frequencies if amplitudes is not None else torus.frequencies
    guess, keep = guess_of(near, frequencies, amplitudes), unkept
    if path is not None:
        held = frequencies if amplitudes is None else None
        kept = SweepsFile(
            path,
            torus.chain,
            digits,
            seeds=torus.seeds,
            frequencies=held,
            amplitudes=amplitudes,
        )
        before, keep = kept.read(), kept.write
        guess = guess if before is None else resumed(guess, before)
    try:
        return precise_torus(guess, digits, progress or unheard, keep)
    except Failure as failure:
        raise NoTorus(str(failure), near, near.residual()) from None


@overload
def refine_at_energy(
    torus: RingTorus,
    energy: Number,
    *,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None = ...,
    energy_ratio: Mapping[int, Number] | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedRingTorus: ...
@overload
def refine_at_energy(
    torus: QuasiPeriodic,
    energy: Number,
    *,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None = ...,
    energy_ratio: Mapping[int, Number] | None = ...,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedTorus: ...
def refine_at_energy(
    torus: QuasiPeriodic | RingTorus,
    energy: Number,
    *,
    harmonic: bool,
    amplitude_ratio: Mapping[int, Number] | None = None,
    energy_ratio: Mapping[int, Number] | None = None,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | RefinedRingTorus:
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
    _require_torus(torus)
    value = exact(energy, "energy")
    if value <= 0:
        raise InputError(
            "energy", energy, "a positive number", "take one near the energy of the torus"
        )
    if not isinstance(harmonic, (bool, np.bool_)):
        raise InputError(
            "harmonic",
            harmonic,
            "True for sum E_q, False for H",
            "say which energy is meant",
        )
    if amplitude_ratio is not None and energy_ratio is not None:
        raise InputError(
            "energy_ratio",
            energy_ratio,
            "only one of amplitude_ratio and energy_ratio",
            "leave one out",
        )
    if energy_ratio is not None:
        _require_energies(torus)
        ratio = _by_seed("energy_ratio", energy_ratio, torus, signed=False)
    elif amplitude_ratio is not None:
        ratio = _by_seed("amplitude_ratio", amplitude_ratio, torus, signed=True)
    else:
        ratio = {q: exact(float(a), "amplitude") for q, a in _amplitudes(torus).items()}
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


def _require_torus(torus: object) -> None:
    """InputError for what is no solution, and for standing waves on a ring."""
    if isinstance(torus, RingTorus):
        require_travelling(torus)
    else:
        require_solution(torus, "torus")


def _amplitudes(torus: QuasiPeriodic | RingTorus) -> Mapping[int, Any]:
    return torus.amplitudes if isinstance(torus, RingTorus) else amplitudes_of(torus)


def _require_energies(torus: QuasiPeriodic | RingTorus) -> None:
    """InputError for opposite seeds of a ring, which have the same E_q."""
    opposite = [q for q in torus.seeds if -q in torus.seeds]
    if opposite:
        allowed = "a ratio of modes of different energies: E_q = E_(-q) on a ring"
        given = f"of the seeds {opposite[0]} and {-opposite[0]}"
        raise InputError("energy_ratio", given, allowed, "give amplitude_ratio")


def _by_seed(
    argument: str, values: object, torus: QuasiPeriodic | RingTorus, *, signed: bool
) -> dict[int, Fraction]:
    """A number for each seed, not 0 and not beyond doubles; positive unless signed."""
    kind = "number that is not 0" if signed else "positive number"
    allowed = f"a {kind} for each of the seeds {torus.seeds}, by seed"
    if not isinstance(values, Mapping) or set(values) != set(torus.seeds):
        advice = "write it as {seed: number} and name every seed"
        raise InputError(argument, values, allowed, advice)
    numbers = {q: exact(values[q], f"{argument}, {q}") for q in torus.seeds}
    sizes = [abs(x) if signed else x for x in numbers.values()]
    if not all(LEAST_SIZE < size < 1 / LEAST_SIZE for size in sizes):
        advice = "leave out a seed that is at rest"
        raise InputError(argument, dict(values), f"{allowed}, of moderate size", advice)
    return numbers


@overload
def refined_torus(
    torus: RingTorus,
    conditions: Sequence[Condition],
    *,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedRingTorus: ...
@overload
def refined_torus(
    torus: QuasiPeriodic,
    conditions: Sequence[Condition],
    *,
    tolerance: float = ...,
    most_harmonics: int = ...,
    progress: Progress | None = ...,
) -> RefinedTorus: ...
def refined_torus(
    torus: QuasiPeriodic | RingTorus,
    conditions: Sequence[Condition],
    *,
    tolerance: float = TOLERANCE,
    most_harmonics: int = MOST_HARMONICS,
    progress: Progress | None = None,
) -> RefinedTorus | RefinedRingTorus:
    """The torus near a guess that meets as many conditions as it has angles.

    With as many harmonics as the tolerance needs.
    """
    _require_torus(torus)
    if not isinstance(tolerance, Real) or not 0 < tolerance < 1:
        raise InputError(
            "tolerance", tolerance, "a number between 0 and 1", "take 1e-13 or more"
        )
    most = integer(most_harmonics, "most_harmonics", len(torus.seeds))
    kind = WAVES if isinstance(torus, RingTorus) else COSINES
    guess = kind.coefficients(torus)
    _require_moderate(guess[1])
    search = Search(
        kind,
        torus,
        conditions,
        tolerance=tolerance,
        most=most,
        tell=progress or unheard,
    )
    solved = search(known_rows(*guess), shifts_of(torus))
    found: RefinedTorus | RefinedRingTorus = solved.torus
    if solved.failure:
        settled = found if solved.found.settled else None
        return _ended_early(_because(solved.failure, found), settled, solved.reached, found)
    if solved.doubt:
        return replace(found, warnings=(_because(solved.doubt, found),))
    return found


def _ended_early(reason: str, settled: Any, reached: Any, last: Any) -> Any:
    """The best torus there is where Newton's method failed, with a warning; else NoTorus.

    settled : the last iterate, if nothing but rounding was left to be gained. reached : the torus
    of fewer harmonics, on which the method converged.
    """
    tori = [torus for torus in (settled, reached) if torus is not None]
    best = min(tori, key=lambda torus: torus.residual(), default=None)
    if best is None or not best.residual() <= USEFUL:
        raise NoTorus(reason, last, last.residual())
    left = f"the residual is {best.residual():.2g} with {len(best.harmonics)} harmonics"
    return replace(best, warnings=(f"{ENDED_EARLY}: {reason}; {left}",))


def ended_early(torus: RefinedTorus | RefinedRingTorus) -> bool:
    """Whether it is what Newton's method had reached when it failed."""
    return any(warning.startswith(ENDED_EARLY) for warning in torus.warnings)


def _because(reason: str, torus: RefinedTorus | RefinedRingTorus) -> str:
    """With the resonance of a ring that may be the cause."""
    cause = driven_in_resonance(torus) if isinstance(torus, RefinedRingTorus) else ""
    return f"{reason}; {cause}" if cause else reason


def _cosines(torus: QuasiPeriodic) -> tuple[Ints, Floats]:
    with np.errstate(over="ignore"):
        return torus.harmonics, torus.cosines.astype(float)


def _require_moderate(coefficients: Floats) -> None:
    """InputError where coefficients are all 0 or of no moderate size."""
    largest = float(np.abs(coefficients).max(initial=0))
    if not LEAST_SIZE < largest < 1 / LEAST_SIZE:  # also where it is not a number
        given = f"coefficients up to {largest:.3g}"
        allowed = "coefficients not all 0 and of moderate size"
        raise InputError("torus", given, allowed, "take another guess")


def shifts_of(torus: QuasiPeriodic | RingTorus) -> Floats:
    """omega - Omega of the seeds in long doubles; shape (s,)."""
    with mpmath.workdps(2 * DIGITS):
        linear = [torus.chain.linear_frequency(q) for q in torus.seeds]
        chosen = [mpmath.mpf(w.numerator) / w.denominator for w in torus.frequencies]
        shifts = [w - x for w, x in zip(chosen, linear, strict=True)]
    return np.array([long(shift) for shift in shifts])


def _result(
    torus: QuasiPeriodic,
    equation: InvarianceEquation,
    found: Iterate,
    frequencies: tuple[Fraction, ...],
) -> RefinedTorus:
    amplitudes = map(float, seed_amplitudes(equation, found.cosines))
    modes = np.array(torus.chain.mode_numbers)
    return RefinedTorus(
        chain=torus.chain,
        seeds=torus.seeds,
        frequencies=frequencies,
        amplitudes=dict(zip(torus.seeds, amplitudes, strict=True)),
        phases={q: float(phi) for q, phi in torus.phases.items()},
        harmonics=equation.harmonics,
        cosines=found.cosines.astype(float),
        steps=found.steps,
        near_resonances=near_resonances(equation, found.cosines, found.shifts, modes),
    )


COSINES = Unknowns(_cosines, lambda chain: (chain.N + 1) // 2, InvarianceEquation, _result)
WAVES = Unknowns(wave_coefficients, lambda chain: 1, WaveEquation, refined_waves)
