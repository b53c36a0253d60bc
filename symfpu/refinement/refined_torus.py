"""What Newton's method makes of a guess and conditions: a torus, or why there is none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np

from symfpu.errors import SymfpuError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.typed import integer, part
from symfpu.refinement.conditions import Condition
from symfpu.refinement.guesses import require_moderate, require_torus, shifts_of
from symfpu.refinement.harmonics import MOST_HARMONICS, known_rows
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.newton import GROWTH, Iterate, NewtonStep
from symfpu.refinement.resonances import NearResonance, near_resonances
from symfpu.refinement.search import Search
from symfpu.refinement.umklapp import driven_in_resonance
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits
from symfpu.tori.best_order import best_order
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Origin, Torus, comes_from

# residual of the equations of motion, relative to the largest acceleration, that ends the search
# for harmonics
TOLERANCE = 1e-13
USEFUL = 1e-9  # residual of a torus up to which normal modes and others take it
NEARER = "start from a torus nearer to it, such as a member of a family from less energy"
SOLVED = 1e-15  # residual of an iterate that solves the equations: it is one of many
DEGENERATE = (
    "the frequencies may be those of many amplitudes, as of mode N/2 in alpha: "
    "give the amplitudes, refine(torus, amplitudes=...)"
)
ENDED_EARLY = "Newton's method ended early"  # how the warning of such a torus begins


@dataclass(frozen=True, eq=False, repr=False)
class Newton(Origin):
    """Where a torus comes from: Newton's method on the invariance equation, in doubles (`refine`).

    Not in the paper, which has series alone. All is dimensionless.

    steps : of Newton's method with the final harmonics.
    near_resonances : the smallest divisors (nu.omega)^2 - Omega_q^2, with the coefficients under
        them.

    A torus of it doubts itself where its residual is above the tolerance, or where the method
    failed when it had reached a residual of 1e-9 or less.

    >>> from symfpu import Chain, lindstedt, refine, solve_amplitudes
    >>> refine(solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 6)))
    Torus(N=8, alpha=0.3, omega_1=0.3905, A_1=0.4051586230417, H=0.0127984220834,
    20 harmonics, residual ..., smallest divisor 0.024 at mode 2, harmonic (2), coefficient 0.031)
    """

    name: ClassVar[str] = "Newton's method"

    steps: tuple[NewtonStep, ...]
    near_resonances: tuple[NearResonance, ...]

    def fields(self, torus: Torus) -> Iterator[Field]:
        steps = []
        for step in self.steps:
            residual, change = fifteen_digits(step.residual), fifteen_digits(step.change)
            steps.append({"residual": residual, "change": change, "products": step.krylov})
        yield Field("energy_error", fifteen_digits(energy_spread(torus)))
        yield Field("newton", steps)
        yield Field("smallest_divisors", [near.entry() for near in self.near_resonances])
        yield Field("verdict", "doubtful" if torus.warnings else "torus")

    def facts(self) -> tuple[str, ...]:
        return tuple(f"smallest divisor {nearest}" for nearest in self.near_resonances[:1])


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
    guess = _coefficients(torus)
    require_moderate(guess[1])
    search = Search(
        _result,
        torus,
        conditions,
        tolerance=part(tolerance, "tolerance"),
        most=most,
        tell=progress or unheard,
        growth=growth,
    )
    solved = search(known_rows(*guess), shifts_of(torus))
    found: Torus[Newton] = solved.torus
    if solved.failure:
        settled = found if solved.found.settled else None
        reason = _because(solved.failure, found)
        return _ended_early(reason, settled, solved.reached, found, advice)
    if solved.doubt:
        return replace(found, warnings=(_because(solved.doubt, found),))
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


def _ended_early(
    reason: str, settled: Any, reached: Any, last: Any, advice: str
) -> Torus[Newton]:
    """The best torus there is where Newton's method failed, with a warning; else NoTorus.

    settled : the last iterate, if nothing but rounding was left to be gained. reached : the torus
    of fewer harmonics, on which the method converged.
    """
    tori = [torus for torus in (settled, reached) if torus is not None]
    best: Torus[Newton] | None
    best = min(tori, key=lambda torus: torus.residual(), default=None)
    if best is None or not best.residual() <= USEFUL:
        left = last.residual()
        raise NoTorus(reason, last, left, DEGENERATE if left <= SOLVED else advice)
    left = f"the residual is {best.residual():.2g} with {len(best.harmonics)} harmonics"
    warnings = (f"{ENDED_EARLY}: {reason}; {left}",)
    ended: Torus[Newton] = replace(best, warnings=warnings)
    return ended


def ended_early(torus: Torus[Newton]) -> bool:
    """Whether it is what Newton's method had reached when it failed."""
    return any(warning.startswith(ENDED_EARLY) for warning in torus.warnings)


def _because(reason: str, torus: Torus[Newton]) -> str:
    """With the resonance of a ring that may be the cause."""
    cause = (
        driven_in_resonance(torus, torus.origin.near_resonances) if torus.travels else ""
    )
    return f"{reason}; {cause}" if cause else reason


def _coefficients(torus: Torus) -> tuple[Ints, Floats]:
    with np.errstate(over="ignore"):
        return torus.harmonics, torus.cosines.astype(float)


def _result(
    torus: Torus,
    equation: InvarianceEquation,
    found: Iterate,
    frequencies: tuple[Fraction, ...],
) -> Torus[Newton]:
    """The torus of an iterate, without harmonics of a ring in which nothing moves."""
    kept = equation.mask[:, 0] if torus.travels else slice(None)
    return Torus(
        torus.chain,
        torus.seeds,
        frequencies,
        equation.harmonics[kept],
        found.cosines[kept].astype(float),
        {q: float(phi) for q, phi in torus.phases.items()},
        travels=torus.travels,
        origin=Newton(found.steps, near_resonances(equation, found.cosines, found.shifts)),
    )


def energy_spread(torus: Torus, periods: int = 25, points: int = 100) -> float:
    """Largest relative change of H along the orbit over some periods of the slowest seed."""
    slowest = min(float(w) for w in torus.frequencies)
    period = 2 * np.pi / slowest
    times = np.linspace(0, periods * period, points)
    energies, start = torus.energy(times), torus.energy()
    return float(np.abs((energies - start) / start).max())
