"""An atlas: the borders of q-tori over lengths, packets and energies of a chain."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from symfpu.borders.chaos import DRAWS, TIME, chaos_borders
from symfpu.borders.column import BORDERS, OF_ORBITS, REACH, atlas_column
from symfpu.borders.laws import LEAST_LENGTHS, BorderLaw, power_law
from symfpu.borders.newton_end import MOST_HARMONICS, NEWTON, SEARCH_ENDS
from symfpu.borders.packets import packet_modes
from symfpu.borders.point import AMPLITUDE, ENERGY, ESTIMATES
from symfpu.chain.chain import Chain, require_fixed_ends
from symfpu.dynamics.alignment import last_time
from symfpu.errors import InputError
from symfpu.files.progress import Progress
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, decimal, double, exact, integer
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.numbers import number_text
from symfpu.results.result import Tabled
from symfpu.results.table import Column, Table, joined
from symfpu.results.text_tables import text_table
from symfpu.series.memory import series_bytes
from symfpu.sweeps.rows import SweepRow, SweepRows
from symfpu.sweeps.sweep import read_sweep, sweep

Json = dict[str, Any]
FUNCTION = "symfpu.borders.column.atlas_column"


@dataclass(frozen=True)
class AtlasBorder:
    """One border of an atlas. Made by `Atlas`; ours, dimensionless.

    chain : as it is typed. packet : as it was named; modes : its modes. order : of the series.
    border : "ratio", "sums", "poles", "fold", "newton", "stability", "chaos" or "in-phase".
    energy : H there; None if there is none. details : its record.

    >>> chain = {"N": 8, "alpha": "0", "beta": "1"}
    >>> AtlasBorder(chain, "low:1", (1,), 8, "poles", 1.02, {"mode": 5})
    AtlasBorder(N=8, beta=1, packet low:1, order 8: poles at H = 1.02)
    """

    chain: Json
    packet: str
    modes: tuple[int, ...]
    order: int
    border: str
    energy: float | None
    details: Json = field(repr=False)

    def __repr__(self) -> str:
        place = f"at H = {self.energy:.6g}" if self.energy is not None else "nowhere"
        why = f", {self.reason}" if self.reason else ""
        case = f"N={self.N}, {self.model}, packet {self.packet}, order {self.order}"
        return f"AtlasBorder({case}: {self.border} {place}{why})"

    def entry(self) -> dict[str, Any]:
        """For a record."""
        energy = None if self.energy is None else number_text(self.energy, None)
        return {
            "chain": dict(self.chain),
            "packet": self.packet,
            "modes": list(self.modes),
            "order": self.order,
            "border": self.border,
            "energy": energy,
            "details": dict(self.details),
        }

    @property
    def N(self) -> int:
        """Number of bonds."""
        return int(self.chain["N"])

    @property
    def model(self) -> str:
        """The couplings, without the length."""
        others = [f"{k}={v}" for k, v in self.chain.items() if k != "N" and v != "0"]
        return ", ".join(others)

    @property
    def limited(self) -> bool:
        """Whether the search ended and not the tori: the border lies above."""
        return self.border == NEWTON and self.reason in SEARCH_ENDS

    @property
    def reason(self) -> str:
        """Why there is no torus beyond, or no border; empty where a radius says it."""
        found = self.details.get("none") or self.details.get("failure") or ""
        return str(found)


BORDER_HEAD = ("N", "packet", "order", "border", "H", "H/N", "what ends it")
LAW_HEAD = ("packet", "border", "H goes as", "N", "between neighbours")


@public
@dataclass(frozen=True)
class Atlas(Tabled):
    """Borders of q-tori by chain and packet. Made by `atlas` and `read_atlas`; ours.

    rows : a row for each chain, packet and order, with its points and borders, or its failure.
    Everything is dimensionless.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import Chain, atlas
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = atlas([Chain(4, beta=1)], ["low:1"], 3, borders=["ratio"], executor=pool)
    >>> found
    Atlas(1 column, N = 4 .. 4, ... points, borders: 1 ratio)
    >>> found.to_frame()[["N", "packet", "border", "order"]]
       N packet border  order
    0  4  low:1  ratio      3
    """

    rows: SweepRows = field(repr=False)

    def _answer(self) -> str:
        found = sum(border.energy is not None for border in self.borders)
        return counted(found, "border")

    def _lines(self, width: int | None) -> Iterator[str]:
        """The borders, the laws where there are three lengths, and what failed, as tables."""
        borders = [_border_row(border) for border in self.borders]
        if borders:
            yield from text_table(BORDER_HEAD, borders)
        laws = self.laws.items()
        rows = [_law_row(packet, border, law) for (_, packet, border), law in laws]
        if rows:
            yield ""
            yield from text_table(LAW_HEAD, rows)
        for row in self.rows.failures:
            N, packet = row.case["chain"].get("N"), row.case["packet"]
            yield f"N = {N}, packet {packet}: {row.failure}"

    def _fields(self) -> Iterator[Field]:
        """What all columns share, every border, the power laws, and the columns that failed."""
        yield Field("fixed", dict(self.rows.fixed))
        yield Field("cases", len(self.rows.rows))
        yield Field("points", self.points, "points")
        yield Field("borders", [border.entry() for border in self.borders])
        laws = []
        for (model, packet, border), law in self.laws.items():
            which = {"model": model, "packet": packet, "border": border}
            laws.append(which | law.entry())
            power = f"N^({law.exponent:.3g} +- {law.error:.2g})"
            yield Field("", label=f"{border} of {packet}, {model}", shown=power)
        yield Field("laws", laws)
        failed = self.rows.failures
        failures = [{"case": row.case, "reason": str(row.failure)} for row in failed]
        yield Field("failures", failures)

    def __repr__(self) -> str:
        done = [row for row in self.rows.rows if row.failure is None]
        lengths = sorted({int(row.case["chain"]["N"]) for row in done})
        count = _counted(len(self.rows.rows), "column")
        if not done:
            return f"Atlas({count}, none with a result)"
        points = _counted(self.points, "point")
        names = [border.border for border in self.borders if border.energy is not None]
        counts = [f"{names.count(name)} {name}" for name in BORDERS if name in names]
        failed = f", {len(self.rows.failures)} failed" if self.rows.failures else ""
        span = f"N = {lengths[0]} .. {lengths[-1]}"
        listed = ", ".join(counts) or "none"
        return f"Atlas({count}{failed}, {span}, {points}, borders: {listed})"

    @property
    def points(self) -> int:
        """How many tori were looked at, of the series and of Newton's method."""
        done = [row.result for row in self.rows.rows if row.failure is None]
        return sum(len(found["points"]) + len(found["newton"]) for found in done)

    @property
    def borders(self) -> tuple[AtlasBorder, ...]:
        """Of all columns, in their order."""
        return tuple(_borders(self.rows))

    def law(
        self,
        packet: str,
        border: str,
        *,
        model: str | None = None,
        order: int | None = None,
    ) -> BorderLaw:
        """The power of N with which this border of a packet goes.

        packet : as it was named. border : as `atlas` names them.
        model : the couplings, such as "alpha=1"; needed if there are several. order : of the
        series; default for each length the largest.

        Borders that only the search ended are left out. Raises InputError if there are fewer
        than three lengths, or several models and none is named.
        """
        found = [
            b
            for b in self.borders
            if (b.packet, b.border) == (packet, border)
            and model in (None, b.model)
            and order in (None, b.order)
        ]
        models = {b.model for b in found}
        if len(models) > 1:
            allowed = f"one of {sorted(models)}"
            raise InputError("model", model, allowed, "name one")
        energies = _by_length(found)
        return power_law(list(energies), list(energies.values()))

    def by_time(self, T: float) -> Atlas:
        """The atlas whose borders of chaos are those by an earlier time.

        T : at most the time to which the orbits were integrated; such borders are located to the
        factor of 1.2 by that time, a tenth and a hundredth of it. All other borders stay.
        Dimensionless. Raises InputError for a later time.

        >>> from concurrent.futures import ThreadPoolExecutor
        >>> from symfpu import Chain, atlas
        >>> how = {"borders": ["chaos"], "time": 1e3, "draws": 1}
        >>> with ThreadPoolExecutor(1) as pool:
        ...     found = atlas([Chain(4, alpha=1)], ["low:2"], 1, executor=pool, **how)
        >>> found.by_time(100).borders[0].energy > found.borders[0].energy
        True
        """
        latest = float(self.rows.fixed.get("time", TIME))
        earlier = last_time(T)
        if earlier > latest:
            allowed = f"at most {latest:g}, to which orbits were integrated"
            raise InputError("T", T, allowed, "take an earlier time, or another atlas")
        rows = tuple(_by_time(row, earlier) for row in self.rows.rows)
        return Atlas(replace(self.rows, rows=rows))

    @property
    def laws(self) -> dict[tuple[str, str, str], BorderLaw]:
        """By model, packet and border, where there are three lengths or more."""
        groups: dict[tuple[str, str, str], list[AtlasBorder]] = {}
        for b in self.borders:
            groups.setdefault((b.model, b.packet, b.border), []).append(b)
        energies = {key: _by_length(group) for key, group in groups.items()}
        return {
            key: power_law(list(found), list(found.values()))
            for key, found in energies.items()
            if len(found) >= LEAST_LENGTHS
        }

    def _table(self) -> Table:
        """One row for each border, with what ends the torus there."""
        borders = self.borders
        columns: dict[str, Column] = {
            "N": [b.N for b in borders],
            "model": [b.model for b in borders],
            "packet": [b.packet for b in borders],
            "seeds": [joined(b.modes) for b in borders],
            "order": [b.order for b in borders],
            "border": [b.border for b in borders],
            "energy": [_number(b.energy) for b in borders],
            "energy_per_particle": [_number(b.energy) / b.N for b in borders],
            "mode": [b.details.get("mode") for b in borders],
            "harmonic": [joined(b.details.get("harmonic") or ()) for b in borders],
            "divisor": [_number(b.details.get("divisor")) for b in borders],
            "pole": [_number(b.details.get("pole")) for b in borders],
            "growth": [_number(b.details.get("growth")) for b in borders],
            "time": [_number(b.details.get("time")) for b in borders],
            "reason": [b.reason for b in borders],
        }
        return Table(columns, attributes(self, function=self.rows.function))


def _by_length(borders: Iterable[AtlasBorder]) -> dict[int, float]:
    """Energies by rising N, each at the largest order; without those that only the search ended."""
    best = {}
    for b in sorted(borders, key=lambda b: (b.N, b.order)):
        if b.energy is not None and not b.limited:
            best[b.N] = b.energy
    return best


def _by_time(row: SweepRow, T: float) -> SweepRow:
    """A row whose borders of chaos are those by a time."""
    if row.failure is not None or "orbits" not in row.result:
        return row
    of_orbits = chaos_borders(row.result["orbits"], T)
    borders = {
        name: of_orbits.get(name, border) for name, border in row.result["borders"].items()
    }
    return replace(row, result=row.result | {"borders": borders})


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" + "s" * (count != 1)


def _borders(rows: SweepRows) -> Iterator[AtlasBorder]:
    for row in rows.rows:
        if row.failure is not None:
            continue
        for name, found in row.result["borders"].items():
            yield AtlasBorder(
                chain=row.case["chain"],
                packet=row.case["packet"],
                modes=tuple(row.result["modes"]),
                order=row.case["order"],
                border=name,
                energy=found.get("energy"),
                details=found,
            )


@public
def read_atlas(file: Path | str) -> Atlas:
    """The atlas in a file that `atlas` wrote; also while it is still written.

    file : JSON lines. Raises InputError for a file of anything else. Dimensionless. Ours.

    >>> import tempfile
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import Chain, atlas
    >>> with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as pool:
    ...     how = {"borders": ["ratio"], "executor": pool, "file": f"{folder}/atlas.jsonl"}
    ...     found = atlas([Chain(4, beta=1)], ["low:1"], 3, **how)
    ...     read_atlas(how["file"]) == found
    True
    """
    rows = read_sweep(file)
    if rows.function != FUNCTION:
        raise InputError(
            "file", str(file), "the file of an atlas", f"it is of {rows.function}"
        )
    return Atlas(rows)


@public
def atlas(
    chains: Iterable[Chain | Mapping[str, Any]],
    packets: Iterable[str | Sequence[int]],
    order: int | Sequence[int],
    *,
    borders: Sequence[str] = ESTIMATES,
    places: Sequence[Number] = (),
    by: str = ENERGY,
    per_particle: bool = False,
    most_harmonics: int = MOST_HARMONICS,
    reach: float = REACH,
    time: float = TIME,
    draws: int = DRAWS,
    executor: Any = None,
    file: Path | str | None = None,
    retry: bool = False,
    progress: Progress | None = None,
) -> Atlas:
    """Where q-tori end as their energy grows, for each chain and packet.

    chains : of fixed ends and any potential; mappings of the arguments of `Chain` may be
        impossible, and are rows with their error then.
    packets : seed sets as "1,2" or (1, 2), or by name: "low:s", "middle:s", "high:s", of s modes
        or, s below 1, of the part s of all N.
    order : of the series; several, to see what the borders owe to it.
    borders : of "ratio", "sums", "poles" (where the radius of convergence falls to the torus' own
        amplitudes: by the largest term of each order, by the sums of all terms, by the nearest
        pole of Pade approximants to the frequencies), "newton" (where Newton's method finds no
        further torus), "fold" (the first torus on its way that is on another sheet of the series),
        "stability" (the first unstable one), "chaos" and "in-phase" (the lowest energy at which
        an orbit that starts with the modes of the packet alone is seen to be chaotic or to leave
        its well, to a factor of 1.2: the median over random phases, and with phases 0).
    places : energies H > 0 (`per_particle` H/N; with by="amplitude" the A_q of all seeds) at which
        a point is wanted in any case. Each border is located to 1 % between points of its own.
    by : "energy", with equal mode energies, or "amplitude", with equal amplitudes.
    most_harmonics : of a torus of Newton's method, beyond which it is not followed; its residual
        is 1e-9. reach : places up to so many times the series' last one.
    time : by which chaos is to be seen: what is not seen by then may show later. draws : of random
        phases, the same ones at all energies of a packet. Neither asks for a series, nor do its
        orbits: for them alone any order will do.
    executor, file, retry : as for `sweep`: a file is gone on with.
    progress : called as (label, fraction done).

    Everything is dimensionless. Eq. omeser at every point, judged as by `assess`; ours. Tori in
    narrow resonances between two points are not seen. Raises InputError for arguments out of
    range, and what `sweep` raises.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from symfpu import Chain, atlas
    >>> chains = [Chain(N, beta=1) for N in (6, 8, 12)]
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = atlas(chains, ["high:1"], 3, borders=["ratio"], executor=pool)
    >>> round(found.law("high:1", "ratio").exponent, 1)
    -2.2
    """
    shared = {
        "places": _places(places),
        "by": _one_of("by", by, (ENERGY, AMPLITUDE)),
        "per_particle": bool(per_particle),
        "most_harmonics": integer(most_harmonics, "most_harmonics", 1),
        "reach": _reach(reach),
    }
    wanted = tuple(_one_of("borders", name, BORDERS) for name in borders)
    series = tuple(name for name in wanted if name in ESTIMATES)
    of_orbits = {"time": last_time(time), "draws": integer(draws, "draws", 1)}
    if set(wanted) & set(OF_ORBITS):
        shared |= of_orbits
    orders = _orders(order)
    names = _packets(packets)
    cases = [
        {
            "chain": chain,
            "packet": packet,
            "order": K,
            "borders": wanted if max(orders) == K else series,
        }
        for chain in chains
        for packet in names
        for K in orders
    ]
    rows = sweep(
        atlas_column,
        cases,
        fixed=shared,
        executor=executor,
        file=file,
        memory=column_bytes,
        retry=retry,
        progress=progress,
    )
    return Atlas(rows)


def column_bytes(chain: Chain, packet: str, order: int, borders: Sequence[str]) -> int:
    """The bytes that the series of a column need, for `sweep`; orbits need none.

    >>> column_bytes(Chain(32, beta=1), "low:2", 6, ["poles"]) > 0
    True
    """
    require_fixed_ends(chain)
    if borders and set(borders) <= set(OF_ORBITS):
        return 0
    return series_bytes(chain, packet_modes(chain, packet), order)


def _one_of(name: str, value: str, allowed: Sequence[str]) -> str:
    if value not in allowed:
        raise InputError(name, value, f"one of {', '.join(allowed)}", "name one of these")
    return value


def _orders(order: int | Sequence[int]) -> tuple[int, ...]:
    orders = tuple(order) if isinstance(order, Iterable) else (order,)
    if not orders or isinstance(order, str):
        raise InputError("order", order, "a whole number, or several", "take 12")
    return tuple(integer(K, "order", 1) for K in orders)


def _packets(packets: Iterable[str | Sequence[int]]) -> tuple[str, ...]:
    """The packets by name; InputError for one that is not in a list."""
    if isinstance(packets, str):
        raise InputError("packets", packets, "several packets", f"pass [{packets!r}]")
    names = tuple(map(_packet, packets))
    if not names:
        raise InputError("packets", names, "at least one packet", "pass some")
    return names


def _packet(packet: str | Sequence[int]) -> str:
    if isinstance(packet, str):
        return packet
    if not isinstance(packet, Iterable):
        raise InputError("packets", packet, "names, or modes such as (1, 2)", "pass (1,)")
    return joined(packet)


def _places(places: Sequence[Number]) -> tuple[str, ...]:
    found = {exact(place, "places") for place in places}
    if found and min(found) <= 0:
        raise InputError("places", tuple(places), "positive numbers", "leave out others")
    return tuple(decimal(place) for place in sorted(found))


def _reach(reach: float) -> float:
    value = double(reach, "reach")
    if value < 1:
        raise InputError("reach", reach, "a number of at least 1", "take 3")
    return value


def _border_row(border: AtlasBorder) -> list[str]:
    known = border.energy is not None
    H = float(border.energy or 0.0)
    return [
        str(border.N),
        border.packet,
        str(border.order),
        border.border,
        f"{H:.4g}" if known else "none",
        f"{H / border.N:.4g}" if known else "",
        _ended(border),
    ]


def _ended(border: AtlasBorder) -> str:
    """The reason in words; else the term of the series, or the rate of growth."""
    details = border.details
    words = [border.reason] if border.reason else []
    if details.get("mode") is not None:
        nu = ",".join(map(str, details["harmonic"]))
        words.append(f"mode {details['mode']}, harmonic {nu}")
    if details.get("growth") is not None:
        words.append(f"growth {details['growth']:.3g}")
    if "time" in details and details.get("between"):
        lowest, highest = (math.inf if H is None else H for H in details["between"])
        words.append(f"chaos by t = {details['time']:g}, {lowest:.3g} .. {highest:.3g}")
    return "; ".join(words)


def _law_row(packet: str, border: str, law: BorderLaw) -> list[str]:
    lengths = ",".join(map(str, law.lengths))
    between = ", ".join(f"{x:.2f}" for x in law.local)
    power = f"N^({law.exponent:.3f} +- {law.error:.2g})"
    return [packet, border, power, lengths, between]
