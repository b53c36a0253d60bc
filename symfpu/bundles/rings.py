"""Series and tori of rings as plain entries and flat arrays, for files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, fields
from fractions import Fraction
from math import comb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import canonical_count
from symfpu.bundles.entries import chain_entries, chain_from, number, number_entry
from symfpu.bundles.refined import newton_entries, newton_from
from symfpu.chain.chain import Chain
from symfpu.files.archive import Archive, Json
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.refinement.ring_tori import RefinedRingTorus
from symfpu.series.divisors import SmallDivisor
from symfpu.series.monomials import shared_grading
from symfpu.series.travelling import TravellingSeries
from symfpu.tori.ring_torus import RingTorus

Array = NDArray[Any]
TRAVELLING = "travelling"  # name of the ring of numbers of a series of waves
WAVES = "waves"  # kind of a torus of a ring
REFINED_WAVES = "refined waves"  # the same by Newton's method
FLOATS, INTEGERS = "<f8", "<i8"


def travelling_entries(series: TravellingSeries) -> tuple[Json, dict[str, Array]]:
    """The entries of a document and the arrays, from which the same series is made again."""
    divisors = [asdict(d) | {"size": repr(d.size)} for d in series.smallest_divisors]
    entries: Json = {
        **_wave_entries(series),
        "ring": TRAVELLING,
        "order": series.order,
        "unit": fraction_text(series.unit),
        "multiply_adds": str(series.multiply_adds),
        "smallest_divisors": divisors,
    }
    corrections = [table.ravel() for table in series.corrections]
    arrays = {
        "coordinates": np.concatenate(series.coordinates).astype(FLOATS),
        "corrections": np.concatenate(corrections).astype(FLOATS),
    }
    return entries, arrays


def travelling_from(archive: Archive, body: Json) -> TravellingSeries:
    """The series of such entries; ValueError where they do not fit together."""
    chain, seeds, frequencies = _waves_from(body)
    order = integer(body["order"], "order", 0)
    most = archive.entries("coordinates")
    rows, diagonals = _rows(chain, len(seeds), order, most)
    coordinates = _finite(archive, "coordinates", sum(rows))
    corrections = _finite(archive, "corrections", sum(diagonals) * len(seeds))
    ends = np.cumsum(diagonals)[:-1]
    tables = np.split(corrections.reshape(-1, len(seeds)), ends)
    return TravellingSeries(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        order=order,
        grading=shared_grading(len(seeds), 1 + chain.degree_step * order),
        coordinates=tuple(np.split(coordinates, np.cumsum(rows)[:-1])),
        corrections=tuple(tables),
        unit=fraction(body["unit"]),
        smallest_divisors=tuple(_divisor(chain, d) for d in body["smallest_divisors"]),
        multiply_adds=int(body["multiply_adds"]),
    )


def _rows(chain: Chain, seeds: int, order: int, most: int) -> tuple[list[int], list[int]]:
    """Monomials of coordinates and of corrections, by order.

    ValueError as soon as there are more than `most`, so that no count grows without bound.
    """
    rows, diagonals = [], []
    for k in range(order + 1):
        degree = chain.degree_step * k
        rows.append(canonical_count(seeds, degree + 1))
        exists = k > 0 and degree % 2 == 0
        diagonals.append(comb(degree // 2 + seeds - 1, seeds - 1) if exists else 0)
        if sum(rows) > most:
            raise ValueError(f"order {order} needs more rows than the file holds")
    return rows, diagonals


def _divisor(chain: Chain, entry: Json) -> SmallDivisor:
    [mode] = chain.seeds_of([entry["mode"]])
    harmonic = tuple(map(int, entry["harmonic"]))
    order = integer(entry["order"], "order", 0)
    return SmallDivisor(float(entry["size"]), mode, harmonic, order)


def ring_torus_entries(torus: RingTorus) -> tuple[Json, dict[str, Array]]:
    """The entries of a document and the arrays, from which the same torus is made again."""
    entries: Json = {
        "kind": WAVES,
        **_wave_entries(torus),
        "phases": [number_entry(torus.phases[q]) for q in torus.seeds],
        "amplitudes": [number_entry(torus.amplitudes[q]) for q in torus.seeds],
        "frequency_order": torus.frequency_order,
        "order": torus.order,
        "waves": len(torus.sines),
        "warnings": list(torus.warnings),
    }
    if isinstance(torus, RefinedRingTorus):
        entries |= {"kind": REFINED_WAVES, **newton_entries(torus)}
    arrays = {
        "harmonics": torus.harmonics.ravel().astype(INTEGERS),
        "modes": torus.modes.astype(INTEGERS),
        "sines": torus.sines.astype(FLOATS),
    }
    return entries, arrays


def ring_torus_from(archive: Archive, body: Json) -> RingTorus:
    """The torus of such entries; ValueError where they do not fit together."""
    chain, seeds, frequencies = _waves_from(body)
    count = integer(body["waves"], "waves", 1)
    harmonics = archive.array("harmonics", INTEGERS, count * len(seeds))
    return RingTorus(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        phases=_by_seed(body["phases"], seeds),
        amplitudes=_by_seed(body["amplitudes"], seeds),
        harmonics=harmonics.reshape(count, len(seeds)).astype(np.int64),
        modes=archive.array("modes", INTEGERS, count).astype(np.int64),
        sines=_finite(archive, "sines", count),
        frequency_order=_order(body["frequency_order"]),
        order=_order(body["order"]),
        warnings=tuple(map(str, body["warnings"])),
    )


def refined_waves_from(archive: Archive, body: Json) -> RefinedRingTorus:
    """The torus by Newton's method, likewise."""
    torus = ring_torus_from(archive, body)
    waves = {item.name: getattr(torus, item.name) for item in fields(RingTorus)}
    return RefinedRingTorus(**waves, **newton_from(body))


def _order(entry: Any) -> int | None:
    return None if entry is None else integer(entry, "order", 0)


def _wave_entries(waves: TravellingSeries | RingTorus) -> Json:
    """Chain, seeds and frequencies."""
    return {
        **chain_entries(waves.chain),
        "seeds": list(waves.seeds),
        "frequencies": [fraction_text(w) for w in waves.frequencies],
    }


def _waves_from(body: Json) -> tuple[Chain, tuple[int, ...], tuple[Fraction, ...]]:
    chain = chain_from(body, "periodic")
    seeds = chain.seeds_of(body["seeds"])
    frequencies = tuple(fraction(w) for w in body["frequencies"])
    if len(frequencies) != len(seeds) or min(frequencies) <= 0:
        raise ValueError(f"frequencies do not fit the seeds {seeds}")
    return chain, seeds, frequencies


def _by_seed(entries: Sequence[Any], seeds: tuple[int, ...]) -> dict[int, float]:
    values = map(float, map(number, entries))
    return dict(zip(seeds, values, strict=True))


def _finite(archive: Archive, name: str, count: int) -> Array:
    values = archive.array(name, FLOATS, count)
    if not np.isfinite(values).all():
        raise ValueError(f"a number of {name} is not finite")
    return values
