"""Solutions without a series, by their coefficients, as plain entries and flat arrays, for files.

Harmonics and coefficients are written alike for all; what made a solution is written by its origin,
of which a new one is a line in ORIGINS. Coefficients of many digits are mantissas in words
(symfpu.algebra.words), each with its binary exponent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import prod
from typing import Any, NamedTuple

import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.algebra.words import IntegerTable
from symfpu.breathers.balance import HarmonicBalance
from symfpu.bundles.entries import (
    FIXED,
    chain_entries,
    chain_from,
    number,
    number_entry,
    travelling_entry,
    travels_from,
)
from symfpu.errors import InputError
from symfpu.files.archive import Archive, Json
from symfpu.numbers.arithmetic import Numbers, with_digits
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.refinement.digits import IterativeRefinement
from symfpu.refinement.newton import Newton, NewtonStep
from symfpu.refinement.resonances import NearResonance
from symfpu.tori.columns import columns_of
from symfpu.tori.resummation import Resummed
from symfpu.tori.torus import GIVEN, Origin, Torus

Array = NDArray[Any]
Arrays = dict[str, Array]

FOURIER = "fourier"  # kind of a solution that is given by its coefficients
FLOATS, INTEGERS = "<f8", "<i8"


class Written(NamedTuple):
    """entries : of an origin, as an entry and arrays. read : of its torus without it, back."""

    entries: Callable[[Any], tuple[Json, Arrays]]
    read: Callable[[Torus, Archive, Json], Origin]


def solution_entries(solution: Torus) -> tuple[Json, Arrays]:
    """The entries of a document and the arrays, from which the same solution is made again.

    Raises InputError for one of another origin.
    """
    name = type(solution.origin).__name__
    if name not in ORIGINS:
        origins = f"of an origin {', '.join(ORIGINS)}"
        raise InputError("result", name, origins, "save its coefficients: in_doubles()")
    made, arrays = ORIGINS[name].entries(solution.origin)
    cosines, layout = packed("cosines", solution.cosines, solution.digits)
    phases = [number_entry(solution.phases[q]) for q in solution.seeds]
    entries: Json = {
        "kind": FOURIER,
        "origin": name,
        **chain_entries(solution.chain),
        "seeds": list(solution.seeds),
        "frequencies": [fraction_text(w) for w in solution.frequencies],
        "phases": phases,
        "digits": solution.digits,
        "harmonics": len(solution.harmonics),
        **travelling_entry(solution),
        "warnings": list(solution.warnings),
        **layout,
        "made": made,
    }
    harmonics = np.asarray(solution.harmonics).ravel().astype(INTEGERS)
    return entries, {"harmonics": harmonics, **cosines, **arrays}


def solution_from(archive: Archive, body: Json) -> Torus:
    """The solution of such entries; ValueError where they do not fit together."""
    if body["origin"] not in ORIGINS:
        raise ValueError(f"no solution is of the origin {body['origin']!r:.40}")
    chain, travels = chain_from(body, body.get("ends", FIXED)), travels_from(body)
    seeds = chain.seeds_of(body["seeds"])
    frequencies = tuple(fraction(w) for w in body["frequencies"])
    phases = [number(entry) for entry in body["phases"]]
    if {len(frequencies), len(phases)} != {len(seeds)} or min(frequencies) <= 0:
        raise ValueError(f"frequencies and phases do not fit the seeds {seeds}")
    count = integer(body["harmonics"], "harmonics", 1)
    flat = archive.array("harmonics", INTEGERS, count * len(seeds))
    harmonics = flat.reshape(count, len(seeds)).astype(np.int64)
    digits = None if body["digits"] is None else integer(body["digits"], "digits", 1)
    columns = columns_of(chain, seeds, harmonics, travels=travels).count
    cosines = unpacked("cosines", archive, body, (count, columns), digits)
    by_seed = dict(zip(seeds, phases, strict=True))
    known = tuple(map(str, body.get("warnings", ())))
    torus = Torus(
        chain, seeds, frequencies, harmonics, cosines, by_seed, digits, travels, known
    )
    origin = ORIGINS[body["origin"]].read(torus, archive, body["made"])
    return replace(torus, origin=origin)


# coefficients


def packed(name: str, values: Numbers, digits: int | None) -> tuple[Arrays, Json]:
    """The arrays of coefficients of any shape, and what else is needed to read them.

    name : of the array in the file.
    """
    if digits is None:
        return {name: _floats(values)}, {}
    if not all(mpmath.isfinite(c) for c in values.flat):
        problem = "a coefficient that is not finite"
        raise InputError("result", problem, "finite numbers", "compute it again")
    parts = [c._mpf_ for c in values.flat]
    mantissas = np.empty((len(parts), 1), dtype=object)
    mantissas[:, 0] = [
        -int(mantissa) if sign else int(mantissa) for sign, mantissa, _, _ in parts
    ]
    words = IntegerTable.of(mantissas).words
    exponents = np.array([exponent for _, _, exponent, _ in parts], dtype=INTEGERS)
    arrays = {name: words.ravel().astype(INTEGERS), "exponents": exponents}
    return arrays, {"words": words.shape[-1]}


def unpacked(
    name: str, archive: Archive, body: Json, shape: tuple[int, ...], digits: int | None
) -> Numbers:
    """The coefficients of such arrays."""
    count = prod(shape)
    if digits is None:
        return _finite(archive, name, count).reshape(shape)
    words = integer(body["words"], "words", 1)
    flat = archive.array(name, INTEGERS, count * words)
    mantissas = IntegerTable(flat.reshape(count, 1, words)).integers()[:, 0]
    exponents = archive.array("exponents", INTEGERS, count).tolist()
    values = np.empty(count, dtype=object)
    for i, (mantissa, exponent) in enumerate(zip(mantissas, exponents, strict=True)):
        values[i] = mpmath.mp.make_mpf(libmp.from_man_exp(int(mantissa), exponent))
    return values.reshape(shape)


def _floats(values: Array) -> Array:
    flat: Array = np.asarray(values).ravel().astype(FLOATS)
    if not np.isfinite(flat).all():
        problem = "a number that is not finite"
        raise InputError("result", problem, "finite numbers", "compute it again")
    return flat


def _finite(archive: Archive, name: str, count: int) -> Array:
    values = archive.array(name, FLOATS, count)
    if not np.isfinite(values).all():
        raise ValueError(f"a number of {name} is not finite")
    return values


# what made them, by origin


def _plain(origin: Origin) -> tuple[Json, Arrays]:
    return {}, {}


def _given(torus: Torus, archive: Archive, made: Json) -> Origin:
    return GIVEN


def _sums(origin: Resummed) -> tuple[Json, Arrays]:
    return {}, {"disagreement": _floats(origin.disagreement)}


def _resummed(torus: Torus, archive: Archive, made: Json) -> Origin:
    disagreement = _finite(archive, "disagreement", torus.cosines.size)
    return Resummed(disagreement.reshape(torus.cosines.shape))


def _balance(origin: HarmonicBalance) -> tuple[Json, Arrays]:
    return {"iterations": origin.iterations, "sigma": number_entry(origin.sigma)}, {}


def _balanced(torus: Torus, archive: Archive, made: Json) -> Origin:
    numbered = np.arange(len(torus.harmonics))[:, None]
    if len(torus.seeds) > 1 or not np.array_equal(torus.harmonics, numbered):
        raise ValueError("the harmonics are not those of a periodic orbit")
    iterations = integer(made["iterations"], "iterations", 0)
    return HarmonicBalance(iterations, float(made["sigma"]))


def _refinement(origin: IterativeRefinement) -> tuple[Json, Arrays]:
    limits = {"bound": number_entry(origin.bound), "error": number_entry(origin.error)}
    return {**limits, "sweeps": origin.sweeps}, {}


def _refined(torus: Torus, archive: Archive, made: Json) -> Origin:
    if torus.digits is None:
        raise ValueError("no digits of a torus that was refined to many")
    bound, error = number(made["bound"]), number(made["error"])
    return IterativeRefinement(
        *with_digits((bound, error), torus.digits), integer(made["sweeps"], "sweeps", 0)
    )


def _newton(origin: Newton) -> tuple[Json, Arrays]:
    steps = [
        [repr(step.residual), repr(step.change), repr(step.conditions), step.krylov]
        for step in origin.steps
    ]
    near = [
        [one.mode, list(one.harmonic), repr(one.divisor), repr(one.coefficient)]
        for one in origin.near_resonances
    ]
    return {"steps": steps, "near_resonances": near}, {}


def _by_newton(torus: Torus, archive: Archive, made: Json) -> Origin:
    if torus.stands or torus.digits is not None:
        raise ValueError("standing waves, or many digits, by Newton's method")
    for unit in np.eye(len(torus.seeds), dtype=np.int64):
        if np.count_nonzero((torus.harmonics == unit).all(axis=1)) != 1:
            raise ValueError("a seed whose own harmonic is not there, or is there twice")
    return Newton(
        tuple(_step(*entry) for entry in made["steps"]),
        tuple(_near_resonance(*entry) for entry in made["near_resonances"]),
    )


def _step(residual: str, change: str, conditions: str, krylov: int) -> NewtonStep:
    count = integer(krylov, "krylov", 0)
    return NewtonStep(float(residual), float(change), float(conditions), count)


def _near_resonance(
    mode: int, harmonic: Sequence[int], divisor: str, coefficient: str
) -> NearResonance:
    nu = tuple(map(int, harmonic))
    return NearResonance(int(mode), nu, float(divisor), float(coefficient))


ORIGINS = {
    Origin.__name__: Written(_plain, _given),
    Resummed.__name__: Written(_sums, _resummed),
    HarmonicBalance.__name__: Written(_balance, _balanced),
    Newton.__name__: Written(_newton, _by_newton),
    IterativeRefinement.__name__: Written(_refinement, _refined),
}
