"""A series in a bundle: its tables as flat arrays, everything else as entries; and back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from fractions import Fraction
from functools import partial
from math import comb, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import canonical_count
from symfpu.chain.chain import Chain
from symfpu.chain.length import label_entry, seed_labels
from symfpu.files.archive import (
    Archive,
    Json,
)
from symfpu.numbers.typed import fraction, fraction_text, integer, order_of
from symfpu.series.all_lengths import SeriesForAllN, ends_reached, in_order
from symfpu.series.coefficients import ResiduePoint
from symfpu.series.divisors import SmallDivisor
from symfpu.series.lindstedt import UNIVERSAL
from symfpu.series.monomials import shared_grading
from symfpu.series.rings import FIXED_POINT, FLOAT64, RINGS, RingKind
from symfpu.series.series import LindstedtSeries
from symfpu.series.tables import Shapes
from symfpu.store.entries import (
    FIXED,
    chain_entries,
    chain_from,
)

Array = NDArray[Any]
Labels = tuple[int, ...]  # of seeds
RADII = "<f8"


def series_tables(series: LindstedtSeries) -> tuple[dict[str, Array], Json]:
    """The flat arrays by name, and what else is needed to cut them into tables again."""
    corrections = series.corrections[1:]  # order 0 has none
    parts = {"coordinates": series.coordinates, "corrections": corrections}
    arrays, layout = series.tables.pack(parts)
    members = {}
    for name, tables in arrays.items():
        dtype = series.tables.dtype if name in parts else tables[0].dtype.str
        members[name] = _flat(tables, dtype)
    if series.radii:
        largest = np.array([radius for radius, _ in series.radii])
        members["coordinate_radii"] = _flat([largest], RADII)
        members["correction_radii"] = _flat([radii for _, radii in series.radii], RADII)
    return members, layout


def _flat(parts: Iterable[Array], dtype: str) -> Array:
    """Row after row, order after order."""
    rows = [np.empty(0, dtype), *map(np.ravel, parts)]
    return np.concatenate(rows).astype(dtype, copy=False)


def series_entries(series: LindstedtSeries) -> Json:
    """Everything but the tables."""
    frequencies = None
    if series.frequencies is not None:
        frequencies = [fraction_text(w) for w in series.frequencies]
    divisors = [asdict(d) | {"size": repr(d.size)} for d in series.smallest_divisors]
    return {
        **chain_entries(series.chain),
        "seeds": list(map(label_entry, series.seeds)),
        "frequencies": frequencies,
        "order": series.order,
        "ring": series.ring,
        "digits": series.digits,
        "bits": series.bits,
        "unit": fraction_text(series.unit),
        "multiply_adds": str(series.multiply_adds),
        "smallest_divisors": divisors,
        "point": _point_entries(series.point),
    }


def _point_entries(point: ResiduePoint | None) -> Json | None:
    if point is None:
        return None
    frequencies = list(map(str, point.frequencies))
    return {"prime": str(point.prime), "root": str(point.root), "frequencies": frequencies}


def _shapes(chain: Chain, seeds: Labels, order: int, most: int) -> tuple[Shapes, Shapes]:
    """The shapes of the tables of coordinates, and of corrections from order 1 on.

    ValueError as soon as they need more than `most` rows, so that no count grows without bound.
    """
    coordinates: Shapes = []
    corrections: Shapes = []
    s, columns = len(seeds), _columns(chain, seeds, order)
    for k in range(order + 1):
        degree = chain.degree_step * k
        rows = canonical_count(s, degree + 1)
        most -= rows
        if most < 0:
            raise ValueError(
                f"order {order} of {s} seeds needs more rows than the file holds"
            )
        coordinates.append((rows, columns))
        if k:
            diagonal = 0 if degree % 2 else comb(degree // 2 + s - 1, s - 1)
            corrections.append((diagonal, s))
    return coordinates, corrections


def _columns(chain: Chain, seeds: Labels, order: int) -> int:
    """Of a table of coordinates: all modes of a chain, or those that are excited for every N.

    One on a ring.
    """
    if chain.periodic:
        return 1
    if not chain.symbolic:
        return chain.N - 1
    ends = ends_reached(chain, seeds, order)
    return ends.low + ends.high


def _split(flat: Array, shapes: Iterable[tuple[int, ...]]) -> list[Array]:
    parts, at = [], 0
    for shape in shapes:
        parts.append(flat[at : at + prod(shape)].reshape(shape))
        at += prod(shape)
    return parts


class _Reader:
    """Tables of a series out of the flat arrays of a file."""

    def __init__(
        self, archive: Archive, body: Json, chain: Chain, seeds: Labels, order: int
    ) -> None:
        self.archive, self.body, self.order = archive, body, order
        self.seeds = len(seeds)
        self.shapes = _shapes(chain, seeds, order, archive.entries("coordinates"))
        self.tables = _kind(body).tables(None, 0)

    def parts(self) -> Json:
        """Coordinates, corrections and radii as a series holds them."""
        coordinates, corrections = self.shapes
        kept = self._read("coordinates", coordinates) + self._read(
            "corrections", corrections
        )
        members = {}
        for name, member in self.tables.members(self.body).items():
            members[name] = self.archive.array(name, *member)
        tables = self.tables.unpack(kept, self.body, members)
        count = len(coordinates)
        none = np.zeros((0, self.seeds))  # order 0 has no corrections
        return {
            "coordinates": tuple(tables[:count]),
            "corrections": (none, *tables[count:]),
            "radii": self._radii(corrections),
        }

    def _read(self, name: str, shapes: Shapes) -> list[Array]:
        stored = self.tables.shapes(name, shapes, self.body)
        return self._arrays(name, self.tables.dtype, stored)

    def _arrays(self, name: str, dtype: str, shapes: Shapes) -> list[Array]:
        size = sum(map(prod, shapes))
        return _split(self.archive.array(name, dtype, size), shapes)

    def _radii(self, shapes: Shapes) -> tuple[Any, ...]:
        if "coordinate_radii" not in self.archive.digests:
            return ()
        largest = self.archive.array("coordinate_radii", RADII, self.order + 1).tolist()
        of_corrections = self._arrays("correction_radii", RADII, [(0, self.seeds), *shapes])
        return tuple(zip(largest, of_corrections, strict=True))


def _kind(body: Json) -> RingKind:
    if body["ring"] not in RINGS:
        raise ValueError(f"no ring {body['ring']!r:.40}")
    return RINGS[body["ring"]]


def series_from(archive: Archive, body: Json) -> LindstedtSeries:
    """The series again; whatever does not fit is an error."""
    chain = chain_from(body, body.get("ends", FIXED))
    seeds = _seeds(chain, body["seeds"])
    order = order_of(body["order"])
    frequencies = _chosen_frequencies(body, seeds)
    point, digits = body["point"], body["digits"]
    kind = _kind(body)
    expected = (kind.numeric, kind.name == FIXED_POINT.name, kind.exact_point)
    given = (frequencies is not None, digits is not None, point is not None)
    if given != expected:
        raise ValueError(
            f"frequencies, digits and point do not fit the ring {body['ring']!r:.40}"
        )
    if chain.symbolic and kind.name not in UNIVERSAL:
        raise ValueError(f"no series of the ring {kind.name!r} is one for all N")
    if chain.periodic and kind is not FLOAT64:
        raise ValueError(f"no series of the ring {kind.name!r} is one of waves")
    parts = _Reader(archive, body, chain, seeds, order).parts()
    series: Callable[..., LindstedtSeries] = LindstedtSeries
    if chain.symbolic:
        ends = ends_reached(chain, seeds, order)._asdict()
        series = partial(SeriesForAllN, **ends)
    return series(
        chain=chain,
        seeds=seeds,
        frequencies=frequencies,
        order=order,
        ring=body["ring"],
        **parts,
        grading=shared_grading(len(seeds), 1 + chain.degree_step * order),
        unit=fraction(body["unit"]),
        smallest_divisors=tuple(_divisor(chain, d) for d in body["smallest_divisors"]),
        multiply_adds=int(body["multiply_adds"]),
        digits=None if digits is None else integer(digits, "digits", 1),
        bits=integer(body["bits"], "bits", 0),
        point=point and _point(point),
    )


def _seeds(chain: Chain, entries: Sequence[int | str]) -> Labels:
    """Seeds as the series has them, those of fixed ends ascending; InputError for others."""
    seeds = seed_labels(entries) if chain.symbolic else chain.seeds_of(entries)
    if not chain.periodic and seeds != in_order(seeds):
        raise ValueError(f"seeds {seeds} do not go together in this order")
    return seeds


def _chosen_frequencies(body: Json, seeds: tuple[int, ...]) -> tuple[Fraction, ...] | None:
    """None if none are chosen; ValueError where seeds and frequencies do not go together."""
    chosen = body["frequencies"]
    if chosen is None:
        return None
    frequencies = tuple(fraction(w) for w in chosen)
    if len(frequencies) != len(seeds) or min(frequencies) <= 0:
        raise ValueError(f"seeds {seeds} and frequencies {chosen} do not go together")
    return frequencies


def _divisor(chain: Chain, entry: Json) -> SmallDivisor:
    [mode] = chain.seeds_of([entry["mode"]])
    harmonic = tuple(map(int, entry["harmonic"]))
    return SmallDivisor(float(entry["size"]), mode, harmonic, order_of(entry["order"]))


def _point(entry: Json) -> ResiduePoint:
    prime, root = int(entry["prime"]), int(entry["root"])
    return ResiduePoint(prime, root, tuple(map(int, entry["frequencies"])))
