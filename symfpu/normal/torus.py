"""The torus that normal modes belong to: its checks, harmonics, linearised flow and resonances."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np

from symfpu.chain.frequency_shift import shift_coefficients
from symfpu.errors import InputError
from symfpu.normal.linearised import Linearised, coefficients_by_harmonic
from symfpu.normal.resonances import ParametricResonance, resonances_of
from symfpu.normal.standing import coupled_groups
from symfpu.numbers.arithmetic import DOUBLES, arithmetic_of
from symfpu.numbers.typed import integer
from symfpu.refinement.digits import IterativeRefinement
from symfpu.refinement.harmonics import chosen_harmonics
from symfpu.refinement.lattice import Floats, Ints
from symfpu.refinement.tori import REFINED_RESIDUAL
from symfpu.tori.torus import Torus, comes_from, require_solution
from symfpu.tori.unfolding import folded

REFINED = REFINED_RESIDUAL  # residual of a torus, relative, above which it is refused
HEIGHTS = (1e-8, 1e-11, 1e-14, 1e-17)  # parts of the largest coefficient of the torus
SMALLEST_KEPT = (
    1e-18  # coefficients of the torus below this part of its largest are rounding
)
LENGTH = 12  # sum |nu_i| of the resonances that are listed


def checked_solution(solution: object) -> Torus:
    """The solution in doubles; InputError for what is no refined torus."""
    torus = require_solution(solution, "solution").in_doubles()
    require_refined(torus, REFINED)
    return torus


def in_digits(torus: Torus) -> bool:
    """Whether its normal modes and its twist have digits: on a ring they are in doubles."""
    return comes_from(torus, IterativeRefinement) and not torus.chain.periodic


def require_refined(torus: Torus, level: float) -> None:
    """InputError for a torus whose relative residual is above a level."""
    residual = torus.residual()
    if not residual <= level:
        given = f"a torus whose residual is {residual:.2g}"
        allowed = f"one that solves the equations of motion to {level:.0e}"
        raise InputError("solution", given, allowed, "refine it first: refine(solution)")


def checked_modes(torus: Torus, modes: Iterable[int] | None) -> tuple[int, ...]:
    """Those asked for, ascending; InputError for what is no normal mode."""
    normal = [q for q in torus.chain.mode_numbers if q not in torus.seeds]
    if modes is None:
        return tuple(normal)
    allowed = f"different modes that are no seeds, of {normal}"
    try:
        given = [integer(q, "modes", min(torus.chain.mode_numbers)) for q in modes]
    except TypeError as error:
        raise InputError("modes", modes, allowed, "pass a list of modes") from error
    if set(given) - set(normal) or len(set(given)) < len(given):
        raise InputError("modes", given, allowed, "name other modes")
    return tuple(sorted(given))


def second_order(torus: Torus) -> dict[int, float]:
    """Omega_q with the closed shift of second order by the amplitudes of the seeds, by mode.

    Of a ring without it, but for the sines about standing waves.
    """
    chain = torus.chain
    if chain.periodic:
        linear = chain.frequencies()
        known = dict(zip(chain.mode_numbers, linear.tolist(), strict=True))
        return known | (second_order(folded(torus)) if torus.stands else {})
    squares = chain.frequencies() ** 2
    cubic, quartic = (float(chain.potential.coefficient(n)) for n in (3, 4))
    guesses = {}
    for q in chain.mode_numbers:
        shift = 0.0
        for n, A in torus.amplitudes.items():
            (a, b), c = shift_coefficients(chain.N, q, n)
            square = float(squares[n - 1])
            by_cubic = cubic**2 * (float(a) + float(b) * square)
            shift += A**2 / (2 * chain.N) * (by_cubic + quartic * float(c) * square)
        guesses[q] = float(np.sqrt(squares[q - 1])) * (1 + shift)
    return guesses


class Flows:
    """Linearised flows of one torus with ever more harmonics, made when they are needed."""

    def __init__(self, torus: Torus) -> None:
        self._torus, self._known = torus, _kept_rows(torus)
        self._made: list[Linearised] = []

    def __iter__(self) -> Iterator[Linearised]:
        """With the harmonics of coefficients above each of HEIGHTS."""
        for place, height in enumerate(HEIGHTS):
            if place == len(self._made):
                self._made.append(_flow(self._torus, self._known, height))
            yield self._made[place]


def finest_flow(torus: Torus) -> Linearised:
    """The one with the most harmonics."""
    return _flow(torus, _kept_rows(torus), HEIGHTS[-1])


def _flow(
    torus: Torus, known: Mapping[tuple[int, ...], Floats], height: float
) -> Linearised:
    """With harmonics of coefficients above a part of the largest; known : of `_kept_rows`."""
    return Linearised(torus, _harmonics_of(torus, known, height))


def _kept_rows(torus: Torus) -> dict[tuple[int, ...], Floats]:
    """Coefficients of a torus by harmonic, without those that are rounding."""
    known = coefficients_by_harmonic(torus)
    largest = max(float(np.abs(row).max()) for row in known.values())
    least = SMALLEST_KEPT * largest
    return {nu: row for nu, row in known.items() if np.abs(row).max() > least}


def _harmonics_of(
    torus: Torus, known: Mapping[tuple[int, ...], Floats], height: float
) -> Ints:
    """Those of coefficients above a part of the largest, (H, s); known : of `_kept_rows`."""
    columns = len(next(iter(known.values())))
    travels = torus.travels
    functions = 1 if travels else (columns + 2) // 2
    chosen, _ = chosen_harmonics(known, functions, len(torus.seeds), height)
    return chosen


def resonances_near(
    torus: Torus, sigma: Mapping[int, Any], length: int
) -> list[ParametricResonance]:
    """Those of real parts in doubles or in digits; a distance has all its digits."""
    omega = tuple(float(w) for w in torus.frequencies)
    doubles = {q: float(w) for q, w in sigma.items()}
    found: list[ParametricResonance] = []
    for chain, part in coupled_groups(torus, doubles):
        found += resonances_of(chain, torus.seeds, omega, part, length)
    if in_digits(torus) and arithmetic_of(list(sigma.values())) is not DOUBLES:
        found = _in_all_digits(torus, found, sigma)
    return sorted(found, key=lambda r: abs(r.distance))


def _in_all_digits(
    torus: Torus, found: list[ParametricResonance], sigma: Mapping[int, Any]
) -> list[ParametricResonance]:
    """Resonances with the distances of frequencies in digits."""
    with torus.numbers.context(torus.digits):
        exact = [torus.numbers.number(w) for w in torus.frequencies]
        distances = [r.left_of(sigma) - mpmath.fdot(r.harmonic, exact) for r in found]
    pairs = zip(found, distances, strict=True)
    return [replace(r, distance=float(distance)) for r, distance in pairs]
