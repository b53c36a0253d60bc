"""A refined torus as plain entries and flat arrays, for files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.bundles.entries import (
    FIXED,
    chain_entries,
    chain_from,
    travelling_entry,
    travels_from,
)
from symfpu.files.archive import Archive, Json
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.refinement.newton import NewtonStep
from symfpu.refinement.refined_torus import RefinedTorus
from symfpu.refinement.resonances import NearResonance
from symfpu.tori.columns import columns_of

Array = NDArray[Any]
FLOATS, INTEGERS = "<f8", "<i8"


def refined_entries(torus: RefinedTorus) -> tuple[Json, dict[str, Array]]:
    """The entries of a document and the arrays from which the same torus is made again.

    The arrays are `harmonics` and `cosines`.
    """
    entries: Json = {
        **chain_entries(torus.chain),
        "seeds": list(torus.seeds),
        "frequencies": [fraction_text(w) for w in torus.frequencies],
        "amplitudes": [repr(a) for a in torus.amplitudes.values()],
        "phases": [repr(phi) for phi in torus.phases.values()],
        "harmonics": len(torus.harmonics),
        **travelling_entry(torus),
        **newton_entries(torus),
        "warnings": list(torus.warnings),
    }
    harmonics = torus.harmonics.ravel().astype(INTEGERS)
    cosines = torus.cosines.ravel().astype(FLOATS)
    return entries, {"harmonics": harmonics, "cosines": cosines}


def refined_from(archive: Archive, body: Json) -> RefinedTorus:
    """The torus of such entries; ValueError where they do not fit together."""
    chain, travels = chain_from(body, body.get("ends", FIXED)), travels_from(body)
    if chain.periodic and not travels:
        raise ValueError("standing waves by Newton's method")
    seeds = chain.seeds_of(body["seeds"])
    count = integer(body["harmonics"], "harmonics", 1)
    s = len(seeds)
    lengths = {name: len(body[name]) for name in ("frequencies", "amplitudes", "phases")}
    if set(lengths.values()) != {s}:
        raise ValueError(f"{lengths} numbers where {s} are due")
    frequencies = tuple(fraction(w) for w in body["frequencies"])
    flat = np.asarray(archive.array("harmonics", INTEGERS, count * s))
    harmonics = flat.reshape(count, s).astype(np.int64)
    columns = columns_of(chain, seeds, harmonics, travels=travels).count
    flat = np.asarray(archive.array("cosines", FLOATS, count * columns))
    cosines = flat.reshape(count, columns)
    if min(frequencies) <= 0 or not np.isfinite(cosines).all():
        wrong = (
            "a frequency that is not positive, or a coefficient that is no finite number"
        )
        raise ValueError(wrong)
    for unit in np.eye(s, dtype=np.int64):
        if np.count_nonzero((harmonics == unit).all(axis=1)) != 1:
            raise ValueError("a seed whose own harmonic is not there, or is there twice")
    return RefinedTorus(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        amplitudes=_by_seed(seeds, body["amplitudes"]),
        phases=_by_seed(seeds, body["phases"]),
        harmonics=harmonics,
        cosines=cosines,
        **newton_from(body),
        warnings=tuple(map(str, body["warnings"])),
        travels=travels,
    )


def _by_seed(seeds: Sequence[int], entries: Sequence[str]) -> dict[int, float]:
    return {q: float(entry) for q, entry in zip(seeds, entries, strict=True)}


def newton_entries(torus: RefinedTorus) -> Json:
    """Steps and small divisors."""
    near = [_near_resonance_entry(resonance) for resonance in torus.near_resonances]
    return {"steps": [_step_entry(step) for step in torus.steps], "near_resonances": near}


def newton_from(body: Json) -> dict[str, Any]:
    """The same as fields; ValueError where they are none."""
    near = tuple(_near_resonance(*entry) for entry in body["near_resonances"])
    return {
        "steps": tuple(_step(*entry) for entry in body["steps"]),
        "near_resonances": near,
    }


def _step_entry(step: NewtonStep) -> list[Any]:
    numbers = (step.residual, step.change, step.conditions)
    return [*map(repr, numbers), step.krylov]


def _step(residual: str, change: str, conditions: str, krylov: int) -> NewtonStep:
    count = integer(krylov, "krylov", 0)
    return NewtonStep(float(residual), float(change), float(conditions), count)


def _near_resonance_entry(resonance: NearResonance) -> list[Any]:
    numbers = (resonance.divisor, resonance.coefficient)
    return [resonance.mode, list(resonance.harmonic), *map(repr, numbers)]


def _near_resonance(
    mode: int, harmonic: Sequence[int], divisor: str, coefficient: str
) -> NearResonance:
    nu = tuple(map(int, harmonic))
    return NearResonance(int(mode), nu, float(divisor), float(coefficient))
