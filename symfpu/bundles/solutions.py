"""Solutions without a series, by their coefficients, as plain entries and flat arrays, for files.

Harmonics and coefficients are written alike for all kinds; what made a solution is written by its
kind, of which a new one is a line in KINDS. Coefficients of many digits are mantissas in words
(symfpu.algebra.words), each with its binary exponent.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from math import prod
from typing import Any, NamedTuple

import mpmath
import numpy as np
from mpmath import libmp
from numpy.typing import NDArray

from symfpu.algebra.words import IntegerTable
from symfpu.breathers.balance import PeriodicOrbit
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
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.refinement.digits import PreciseTorus
from symfpu.tori.columns import columns_of
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic
from symfpu.tori.resummation import ResummedTorus

Array = NDArray[Any]
Arrays = dict[str, Array]

FOURIER = "fourier"  # kind of a solution that is given by its coefficients
FLOATS, INTEGERS = "<f8", "<i8"


class Kind(NamedTuple):
    """written : of a solution, what made it, as an entry and arrays. read : of its parts, back."""

    written: Callable[[Any], tuple[Json, Arrays]]
    read: Callable[[FourierTorus, Archive, Json], QuasiPeriodic]


def solution_entries(solution: QuasiPeriodic) -> tuple[Json, Arrays]:
    """The entries of a document and the arrays, from which the same solution is made again.

    Raises InputError for another kind.
    """
    name = type(solution).__name__
    if name not in KINDS:
        kinds = f"one of {', '.join(KINDS)}"
        raise InputError("result", name, kinds, "save its coefficients: in_doubles()")
    made, arrays = KINDS[name].written(solution)
    cosines, layout = packed("cosines", solution.cosines, solution.digits)
    phases = [number_entry(solution.phases[q]) for q in solution.seeds]
    entries: Json = {
        "kind": FOURIER,
        "class": name,
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


def solution_from(archive: Archive, body: Json) -> QuasiPeriodic:
    """The solution of such entries; ValueError where they do not fit together."""
    if body["class"] not in KINDS:
        raise ValueError(f"no solution is of the class {body['class']!r:.40}")
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
    parts = FourierTorus(
        chain, seeds, frequencies, harmonics, cosines, by_seed, digits, travels, known
    )
    return KINDS[body["class"]].read(parts, archive, body["made"])


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


# what made them, by kind


def _fields(parts: FourierTorus) -> dict[str, Any]:
    """The fields of FourierTorus, which others begin with."""
    return {item.name: getattr(parts, item.name) for item in fields(FourierTorus)}


def _periodic(parts: FourierTorus) -> FourierTorus:
    """The parts, if they are those of a periodic orbit; ValueError otherwise."""
    numbered = np.arange(len(parts.harmonics))[:, None]
    if (
        len(parts.seeds) > 1
        or len(numbered) < 2
        or not np.array_equal(parts.harmonics, numbered)
    ):
        raise ValueError("the harmonics are not those of a periodic orbit")
    return parts


def _made_plainly(solution: FourierTorus) -> tuple[Json, Arrays]:
    return {}, {}


def _read_plainly(parts: FourierTorus, archive: Archive, made: Json) -> QuasiPeriodic:
    return parts


def _made_by_sums(torus: ResummedTorus) -> tuple[Json, Arrays]:
    return {}, {"disagreement": _floats(torus.disagreement)}


def _read_sums(parts: FourierTorus, archive: Archive, made: Json) -> QuasiPeriodic:
    shape = parts.cosines.shape
    disagreement = _finite(archive, "disagreement", parts.cosines.size).reshape(shape)
    return ResummedTorus(**_fields(parts), disagreement=disagreement)


def _made_by_balance(orbit: PeriodicOrbit) -> tuple[Json, Arrays]:
    return {"iterations": orbit.iterations, "sigma": number_entry(orbit.sigma)}, {}


def _read_balance(parts: FourierTorus, archive: Archive, made: Json) -> QuasiPeriodic:
    iterations = integer(made["iterations"], "iterations", 0)
    sigma = float(made["sigma"])
    return PeriodicOrbit(**_fields(_periodic(parts)), iterations=iterations, sigma=sigma)


def _made_precise(torus: PreciseTorus) -> tuple[Json, Arrays]:
    limits = {"bound": number_entry(torus.bound), "error": number_entry(torus.error)}
    return {**limits, "sweeps": torus.sweeps}, {}


def _read_precise(parts: FourierTorus, archive: Archive, made: Json) -> QuasiPeriodic:
    return PreciseTorus(
        **_fields(parts),
        bound=number(made["bound"]),
        error=number(made["error"]),
        sweeps=integer(made["sweeps"], "sweeps", 0),
    )


KINDS = {
    FourierTorus.__name__: Kind(_made_plainly, _read_plainly),
    ResummedTorus.__name__: Kind(_made_by_sums, _read_sums),
    PeriodicOrbit.__name__: Kind(_made_by_balance, _read_balance),
    PreciseTorus.__name__: Kind(_made_precise, _read_precise),
}
