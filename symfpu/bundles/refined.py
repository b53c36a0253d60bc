"""A refined torus as plain entries and flat arrays, for files."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.bundles.entries import chain_entries, chain_from
from symfpu.files.archive import Archive, Json
from symfpu.numbers.typed import fraction, fraction_text, integer, seed_modes
from symfpu.refinement.newton import NewtonStep
from symfpu.refinement.tori import NearResonance, RefinedTorus

Array = NDArray[Any]


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
        "steps": [
            [repr(step.residual), repr(step.change), repr(step.conditions), step.krylov]
            for step in torus.steps
        ],
        "near_resonances": [
            [r.mode, list(r.harmonic), repr(r.divisor), repr(r.coefficient)]
            for r in torus.near_resonances
        ],
        "warnings": list(torus.warnings),
    }
    return entries, {
        "harmonics": torus.harmonics.ravel().astype("<i8"),
        "cosines": torus.cosines.ravel().astype("<f8"),
    }


def refined_from(archive: Archive, body: Json) -> RefinedTorus:
    """The torus of such entries; ValueError where they do not fit together."""
    chain = chain_from(body)
    seeds, count = seed_modes(body["seeds"], chain.N), integer(body["harmonics"], "harmonics", 1)
    s = len(seeds)
    lengths = {name: len(body[name]) for name in ("frequencies", "amplitudes", "phases")}
    if set(lengths.values()) != {s}:
        raise ValueError(f"{lengths} numbers where {s} are due")
    frequencies = tuple(fraction(w) for w in body["frequencies"])
    harmonics = (
        np.asarray(archive.array("harmonics", "<i8", count * s)).reshape(count, s).astype(np.int64)
    )
    cosines = np.asarray(archive.array("cosines", "<f8", count * (chain.N - 1))).reshape(
        count, chain.N - 1
    )
    if min(frequencies) <= 0 or not np.isfinite(cosines).all():
        raise ValueError(
            "a frequency that is not positive, or a coefficient that is no finite number"
        )
    if any(
        np.count_nonzero((harmonics == unit).all(axis=1)) != 1 for unit in np.eye(s, dtype=np.int64)
    ):
        raise ValueError("a seed whose own harmonic is not there, or is there twice")
    return RefinedTorus(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        amplitudes={q: float(a) for q, a in zip(seeds, body["amplitudes"], strict=True)},
        phases={q: float(a) for q, a in zip(seeds, body["phases"], strict=True)},
        harmonics=harmonics,
        cosines=cosines,
        steps=tuple(
            NewtonStep(float(r), float(d), float(g), integer(k, "krylov", 0))
            for r, d, g, k in body["steps"]
        ),
        near_resonances=tuple(
            NearResonance(int(q), tuple(map(int, nu)), float(d), float(c))
            for q, nu, d, c in body["near_resonances"]
        ),
        warnings=tuple(map(str, body["warnings"])),
    )
