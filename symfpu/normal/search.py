"""The door: normal frequencies of a torus, mode by mode, with as many harmonics as they need."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np

from symfpu.breathers.digits import PreciseOrbit
from symfpu.chain.chain import require_fixed_ends
from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.normal.collisions import undecided_modes
from symfpu.normal.digits import PreciseModes
from symfpu.normal.linearised import LinearisedFlow, coefficients_by_harmonic
from symfpu.normal.modes import NoNormalModes, NormalDivisor, NormalMode, NormalModes
from symfpu.normal.reduction import Reduced, continued, reduced
from symfpu.normal.resonances import ParametricResonance, resonances_of
from symfpu.numbers.arithmetic import DOUBLES, arithmetic_of
from symfpu.numbers.typed import integer
from symfpu.refinement.digits import Failure, PreciseTorus
from symfpu.refinement.harmonics import chosen_harmonics
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of, require_solution

PRECISE = (PreciseTorus, PreciseOrbit)  # solutions whose digits are those of the equations
REFINED = 1e-9  # residual of a torus, relative, above which it is refused
# coefficients of the torus above these parts of its largest, and what their harmonics may leave
HEIGHTS, TOLERANCE = (1e-8, 1e-11, 1e-14, 1e-17), 1e-10
SMALLEST_KEPT = (
    1e-18  # coefficients of the torus below this part of its largest are rounding
)
SHOWN_DIVISORS = 5
LENGTH = 12  # sum |nu_i| of the resonances that are listed
SAME = 1e-9  # difference of two frequencies that are one


def normal_modes(
    solution: QuasiPeriodic,
    *,
    modes: Iterable[int] | None = None,
    resonance_length: int = LENGTH,
    progress: Progress | None = None,
) -> NormalModes:
    """Normal frequencies of a torus or breather, their eigenfunctions, signatures and resonances.

    solution : of any potential with fixed ends and of any number of angles, refined: its residual
        is at most 1e-9. Dimensionless. Of one that was refined to many digits (PreciseTorus,
        PreciseOrbit) frequencies and eigenfunctions have as many, by sweeps in fixed point; any
        other is rounded to doubles, as `solution.in_doubles()` is.
    modes : which of the N-1-s modes; default all.
    resonance_length : largest sum |nu_i| of the resonances listed.
    progress : called as (label, fraction), once a mode.

    The equations of motion (Eq. eqmo) linearised about the torus are solved by exp(i sigma t)
    p(theta), in harmonics of the angles: Newton's method from Omega_q with its closed shift of
    second order, products on the lattice that `refine` uses. Of a breather, exp(2 pi i
    sigma/omega) are the Floquet multipliers. Ours: the paper has none. Raises InputError, and
    NoNormalModes where a resonance does not let a mode be told from others.

    >>> from symfpu import Chain, refine_at_amplitudes, torus_at_amplitudes
    >>> amplitudes = {1: "0.2", 2: "0.1"}
    >>> guess = torus_at_amplitudes(Chain(N=4, alpha="0.3"), amplitudes, order=4)
    >>> round(normal_modes(refine_at_amplitudes(guess, amplitudes)).frequencies[3], 9)
    1.847...
    """
    torus = _checked(solution)
    chosen = checked_modes(torus, modes)
    length = integer(resonance_length, "resonance_length", 1)
    tell = progress or unheard
    guesses = second_order(torus)
    found: dict[int, NormalMode] = {}
    search = _Search(torus)
    for number, q in enumerate(chosen):
        tell(f"normal mode {q}", number / len(chosen))
        mode = search.mode(q, guesses[q], found)
        if mode is None:
            nearest = _resonances(torus, {q: guesses[q]}, length)[0]
            raise NoNormalModes(q, guesses[q], nearest)
        found[q] = mode
    if isinstance(solution, PRECISE):
        found = _in_digits(solution, found, guesses, length, tell)
    real = {q: mode.sigma.real for q, mode in found.items()}
    return NormalModes(
        torus=solution,
        modes=tuple(found.values()),
        guesses={q: guesses[q] for q in chosen},
        resonances=tuple(_resonances(solution, real, length)),
        undecided=undecided_modes(solution, tuple(found.values())),
    )


def _in_digits(
    torus: QuasiPeriodic,
    found: Mapping[int, NormalMode],
    guesses: Mapping[int, float],
    length: int,
    tell: Progress,
) -> dict[int, NormalMode]:
    """Modes in doubles with the digits of the torus; NoNormalModes where that fails."""
    precise: dict[int, NormalMode] = {}
    search: PreciseModes | None = None
    for number, (q, mode) in enumerate(found.items()):
        tell(f"normal mode {q}, {torus.digits} digits", number / len(found))
        try:
            search = search or PreciseModes(torus)
            precise[q] = search.refined(mode, tell)
        except Failure as failure:
            real = {q: complex(mode.sigma).real}
            nearest = _resonances(torus, real, length)[0]
            reason = f"no {torus.digits} digits of its frequency: {failure}"
            raise NoNormalModes(q, guesses[q], nearest, reason) from None
    return precise


def _checked(solution: object) -> QuasiPeriodic:
    """The solution in doubles; InputError for what is no refined torus of fixed ends."""
    require_solution(solution, "solution")
    assert isinstance(solution, QuasiPeriodic)
    require_fixed_ends(solution.chain)
    torus = solution.in_doubles()
    residual = solution.residual()
    if not residual <= REFINED:
        given = f"a torus whose residual is {residual:.2g}"
        allowed = f"one that solves the equations of motion to {REFINED:.0e}"
        raise InputError("solution", given, allowed, "refine it first: refine(solution)")
    return torus


def checked_modes(torus: QuasiPeriodic, modes: Iterable[int] | None) -> tuple[int, ...]:
    """Those asked for, ascending; InputError for what is no normal mode."""
    normal = [q for q in torus.chain.mode_numbers if q not in torus.seeds]
    if modes is None:
        return tuple(normal)
    allowed = f"different modes that are no seeds, of {normal}"
    try:
        given = [integer(q, "modes", 1) for q in modes]
    except TypeError as error:
        raise InputError("modes", modes, allowed, "pass a list of modes") from error
    if set(given) - set(normal) or len(set(given)) < len(given):
        raise InputError("modes", given, allowed, "name other modes")
    return tuple(sorted(given))


def second_order(torus: QuasiPeriodic) -> dict[int, float]:
    """Omega_q with the closed shift of second order by the amplitudes of the seeds, by mode."""
    chain = torus.chain
    squares = chain.frequencies() ** 2
    cubic, quartic = (float(chain.potential.coefficient(n)) for n in (3, 4))
    guesses = {}
    for q in chain.mode_numbers:
        shift = 0.0
        for n, A in amplitudes_of(torus).items():
            (a, b), c = shift_coefficients(chain.N, q, n)
            square = float(squares[n - 1])
            by_cubic = cubic**2 * (float(a) + float(b) * square)
            shift += A**2 / (2 * chain.N) * (by_cubic + quartic * float(c) * square)
        guesses[q] = float(np.sqrt(squares[q - 1])) * (1 + shift)
    return guesses


class _Search:
    """Linearised flows of one torus with ever more harmonics, made when they are needed."""

    def __init__(self, torus: QuasiPeriodic) -> None:
        known = coefficients_by_harmonic(torus)
        largest = max(float(np.abs(row).max()) for row in known.values())
        least = SMALLEST_KEPT * largest
        self._known = {nu: row for nu, row in known.items() if np.abs(row).max() > least}
        self._torus = torus
        self._flows: list[LinearisedFlow] = []

    def mode(
        self, q: int, guess: float, others: dict[int, NormalMode]
    ) -> NormalMode | None:
        """The one that continues q and is none of the others; None where there is none.

        Another that turns out to be this one is sought anew.
        """
        found = self._sought(lambda flow: reduced(flow, q, guess))
        twin = found and _twin(found, others.values())
        if not twin:
            return found
        found = self._sought(lambda flow: continued(flow, q))
        twin = found and _twin(found, others.values())
        if not found or not twin:
            return found
        again = self._sought(lambda flow: continued(flow, twin.mode))
        if again is None or _twin(again, [found, *others.values()]):
            return None
        others[twin.mode] = again
        return found

    def _sought(
        self, find: Callable[[LinearisedFlow], Reduced | None]
    ) -> NormalMode | None:
        """With as many harmonics as the tolerance needs; the best one met if none do."""
        best: NormalMode | None = None
        for place in range(len(HEIGHTS)):
            flow = self._flow(place)
            found = find(flow)
            if found and (best is None or found.residual < best.residual):
                best = _mode_of(flow, found)
            if best and best.residual < TOLERANCE:
                break
        return best

    def _flow(self, place: int) -> LinearisedFlow:
        if place == len(self._flows):
            torus, height = self._torus, HEIGHTS[place]
            functions = (torus.chain.N + 1) // 2
            chosen, _ = chosen_harmonics(self._known, functions, len(torus.seeds), height)
            self._flows.append(LinearisedFlow(torus, chosen))
        return self._flows[place]


def _twin(found: NormalMode, others: Iterable[NormalMode]) -> NormalMode | None:
    """One of the others that is the same solution, shifted by a harmonic or conjugate.

    Of a hyperbolic mode the partner in a quartet, with two more solutions between them, is none.
    """
    for other in others:
        if found.growth or other.growth or found.mode == other.mode:
            continue
        at = int(np.argmax(np.abs(found.coefficients[:, other.mode - 1])))
        rate = found.rate(at)
        if abs(abs(rate) - complex(other.sigma).real) < SAME:
            return other
    return None


def _mode_of(flow: LinearisedFlow, found: Reduced) -> NormalMode:
    return NormalMode(
        mode=found.mode,
        sigma=found.sigma,
        harmonics=flow.harmonics,
        rates=flow.rates.astype(float),
        coefficients=found.coefficients,
        action=found.action,
        residual=found.residual,
        divisors=_smallest_divisors(flow, found),
        deflated=found.deflated,
        products=found.products,
        rounding=found.rounding,
    )


def _smallest_divisors(flow: LinearisedFlow, found: Reduced) -> tuple[NormalDivisor, ...]:
    every = flow.divisors(found.sigma)
    sizes = np.where(flow.allowed(found.mode), np.abs(every), np.inf)
    sizes[0, found.mode - 1] = np.inf
    order = np.argsort(sizes, axis=None)[:SHOWN_DIVISORS]
    places = zip(*np.unravel_index(order, sizes.shape), strict=True)
    nearest = []
    for row, column in places:
        if np.isfinite(sizes[row, column]):
            harmonic = tuple(flow.harmonics[row].tolist())
            divisor = every[row, column].item()
            coefficient = found.coefficients[row, column].item()
            nearest.append(NormalDivisor(int(column) + 1, harmonic, divisor, coefficient))
    return tuple(nearest)


def _resonances(
    torus: QuasiPeriodic, sigma: Mapping[int, Any], length: int
) -> list[ParametricResonance]:
    """Those of real parts in doubles or in digits; a distance has all its digits."""
    omega = tuple(float(w) for w in torus.frequencies)
    doubles = {q: float(w) for q, w in sigma.items()}
    found = resonances_of(torus.chain, torus.seeds, omega, doubles, length)
    if arithmetic_of(list(sigma.values())) is DOUBLES:
        return found
    with torus.numbers.context(torus.digits):
        exact = [torus.numbers.number(w) for w in torus.frequencies]
        distances = [r.left_of(sigma) - mpmath.fdot(r.harmonic, exact) for r in found]
    pairs = zip(found, distances, strict=True)
    refined = [replace(r, distance=float(distance)) for r, distance in pairs]
    return sorted(refined, key=lambda r: abs(r.distance))
