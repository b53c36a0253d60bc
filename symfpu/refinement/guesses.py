"""What a guess of a torus has to be for Newton's method, and what it gives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import mpf
from symfpu.numbers.long_doubles import DIGITS, long
from symfpu.numbers.typed import Number, exact
from symfpu.refinement.harmonics import by_harmonic, coefficients_at
from symfpu.refinement.lattice import Floats
from symfpu.tori.torus import Torus, require_solution

LEAST_SIZE = Fraction(1, 10**40)  # of amplitudes and coefficients


def require_torus(torus: object) -> None:
    """InputError for what is no solution, and for standing waves on a ring."""
    if require_solution(torus, "torus").stands:
        allowed = "a torus of fixed ends, or of travelling waves of a ring"
        advice = "refine the solution with fixed ends and unfold it"
        raise InputError("torus", "a torus of standing waves", allowed, advice)


def numbers_by_seed(
    argument: str, values: object, seeds: tuple[int, ...], allowed: str
) -> dict[int, Fraction]:
    """An exact number for each seed; else InputError, which says what is allowed."""
    if not isinstance(values, Mapping) or set(values) != set(seeds):
        advice = "write it as {seed: number} and name every seed"
        raise InputError(argument, values, allowed, advice)
    return {q: exact(values[q], f"{argument}, {q}") for q in seeds}


def moderate_by_seed(
    argument: str, values: Mapping[int, Number], seeds: tuple[int, ...], *, signed: bool
) -> dict[int, Fraction]:
    """A number for each seed, not 0 and not beyond doubles; positive unless signed."""
    kind = "number that is not 0" if signed else "positive number"
    allowed = f"a {kind} for each of the seeds {seeds}, by seed"
    numbers = numbers_by_seed(argument, values, seeds, allowed)
    sizes = [abs(x) if signed else x for x in numbers.values()]
    if not all(LEAST_SIZE < size < 1 / LEAST_SIZE for size in sizes):
        advice = "leave out a seed that is at rest"
        raise InputError(argument, dict(values), f"{allowed}, of moderate size", advice)
    return numbers


def require_moderate(coefficients: Floats) -> None:
    """InputError where coefficients are all 0 or of no moderate size."""
    largest = float(np.abs(coefficients).max(initial=0))
    if not LEAST_SIZE < largest < 1 / LEAST_SIZE:  # also where it is not a number
        given = f"coefficients up to {largest:.3g}"
        allowed = "coefficients not all 0 and of moderate size"
        raise InputError("torus", given, allowed, "take another guess")


def shifts_of(torus: Torus) -> Floats:
    """omega - Omega of the seeds of a torus in long doubles; shape (s,)."""
    return frequency_shifts(torus.chain, torus.seeds, torus.frequencies)


def frequency_shifts(
    chain: Chain, seeds: Sequence[int], frequencies: Sequence[Fraction]
) -> Floats:
    """omega - Omega of the seeds in long doubles; shape (s,)."""
    with mpmath.workdps(2 * DIGITS):
        linear = [chain.linear_frequency(q) for q in seeds]
        pairs = zip(frequencies, linear, strict=True)
        return np.array([long(mpf(w) - x) for w, x in pairs])


def extrapolated(before: Torus, last: Torus, ratio: float) -> Torus:
    """The guess on the line through two tori, `ratio` of their distance beyond the second."""
    omega = zip(before.frequencies, last.frequencies, strict=True)
    frequencies = tuple(b + Fraction(ratio) * (b - a) for a, b in omega)
    earlier = coefficients_at(last.harmonics, by_harmonic(before.harmonics, before.cosines))
    cosines = last.cosines + ratio * (last.cosines - earlier)
    phases = dict(last.phases)
    return Torus(
        last.chain,
        last.seeds,
        frequencies,
        last.harmonics,
        cosines,
        phases,
        travels=last.travels,
    )
