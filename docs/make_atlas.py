"""The atlas of docs/atlas.md: its data, its tables and its pictures.

python docs/make_atlas.py           tables and pictures from docs/data/atlas.jsonl
python docs/make_atlas.py --data    first the data: rows that the file has are not computed again
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from symfpu import Atlas, AtlasBorder, Chain, atlas, read_atlas
from symfpu.borders.chaos import FACTOR
from symfpu.borders.laws import power_law
from symfpu.borders.newton_end import WIDE_FACTOR
from symfpu.errors import InputError
from symfpu.sweeps.rows import SweepRow
from symfpu.sweeps.this_process import ThisProcess

HERE = Path(__file__).parent
FILE = HERE / "data" / "atlas.jsonl"
NEWTON_FILE = HERE / "data" / "newton.jsonl"
ONE_SEED_FILE = HERE / "data" / "newton-one.jsonl"
CHAOS_FILES = {
    T: HERE / "data" / f"chaos-1e{round(math.log10(T))}.jsonl" for T in (1e5, 1e6, 1e7)
}
PAGE = HERE / "atlas.md"
SERIES = ("ratio", "poles")
LENGTHS = (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
LONG = 32  # from here on fits without the resonances of short chains
MODELS: dict[str, dict[str, str]] = {
    "alpha=1": {"alpha": "1"},
    "beta=1": {"beta": "1"},
    "potential=toda:1": {"potential": "toda:1"},
}
TODA = "potential=toda:1"
ORDERS = {
    1: {"alpha=1": (16, 12), "beta=1": (8, 6), TODA: (16,)},
    2: {"alpha=1": (8, 6), "beta=1": (5, 4), TODA: (8,)},
}
EXTENSIVE = {"alpha=1": 4, "beta=1": 3}
PARTS = {"1/32": (32, 64, 128, 256), "1/16": (16, 32, 64, 128)}
REACH = 2
FLACH_LENGTHS = (8, 12, 16, 24, 32)
FLACH_SEEDS = ("2", "3")
NEWTON_SEEDS = {
    1: (8, 16, 32),
    2: (8, 16, 32, 64, 128),
    3: (16, 32, 64, 128),
    4: (16, 32, 64, 128),
}
ODD = (9, 17, 33, 65)
OTHER_MIDDLES = (33, 34, 65, 66, 129, 130)  # lengths that are no multiples of 4
MIDDLE_LENGTH, FROM_MIDDLE = 128, ("66", "68", "72")
OTHER_MODELS: dict[str, dict[str, str]] = {
    "alpha=1, beta=1": {"alpha": "1", "beta": "1"},
    "alpha=1/4, beta=1": {"alpha": "1/4", "beta": "1"},
    "beta=-1": {"beta": "-1"},
}
LABELS = ("alpha=1, beta=1", "alpha=0.25, beta=1", "beta=-1")  # of the same in the data
DOUBLINGS = (8, 16, 32, 64)
MORE_SEEDS = {"low:3": (5, 4), "low:4": (4, 3)}  # orders for alpha and beta
EIGHT = {"1/16": 128, "1/32": 256}  # with eight seeds, whose series are long
NEEDED = (1000, 2000)  # harmonics, at which tori are compared
NEWTON_HOW: dict[str, Any] = {
    "order": 2,
    "borders": ["newton"],
    "places": ["1e-8"],
    "reach": 10**8,
    "most_harmonics": 4000,
}
CHAOS_PARTS: dict[float, dict[str, tuple[int, ...]]] = {
    1e5: {
        "1/8": (8, 16, 32, 64, 128, 256),
        "1/16": (16, 32, 64, 128),
        "1/32": (32, 64, 128),
    },
    1e6: {"1/8": (8, 16, 32, 64), "1/16": (16, 32, 64), "1/32": (32, 64)},
    1e7: {"1/8": (8, 16)},
}
CHAOS_SEEDS: dict[float, dict[str, tuple[int, ...]]] = {
    1e5: {"1": (64, 128), "2": (8, 128), "4": (16,)},
    1e6: {},
    1e7: {},
}
TODA_LENGTHS = (8, 16)  # that must show no chaos
SEEN_BY = (1e4, 1e5, 1e6, 1e7)
ONE_SEED_LENGTHS = {"alpha=1": (8, 12, 16, 24, 32), "beta=1": (8, 12, 16, 24, 32, 48)}
ONE_SEED_HOW: dict[str, Any] = {
    "order": 4,
    "borders": ["newton"],
    "places": ["1e-6"],
    "reach": 10**9,
    "most_harmonics": 4000,
}
PICTURES = ("atlas-alpha.png", "atlas-beta.png", "atlas-map.png")
CHAOS_PICTURES = {"alpha=1": "atlas-chaos-alpha.png", "beta=1": "atlas-chaos-beta.png"}


def grids() -> Iterator[dict[str, Any]]:
    """The arguments of every call of `atlas`, in one file together."""
    for model, couplings in MODELS.items():
        for N in LENGTHS:
            chain = Chain(N, **couplings)
            for place in ("low", "middle", "high"):
                borders = SERIES
                if (16 if place == "middle" else 64) >= N:
                    borders += ("fold",)
                if N <= 32 and model != TODA and place != "middle":
                    borders += ("stability",)
                yield grid(chain, [f"{place}:1"], ORDERS[1][model], borders)
            two = (*SERIES, "newton") if N <= 32 and model != TODA else SERIES
            yield grid(chain, ["low:2", "high:2"], ORDERS[2][model], two)
    for model, order in EXTENSIVE.items():
        for part, lengths in PARTS.items():
            for N in lengths:
                eight = part in EIGHT and EIGHT[part] == N
                borders = ("ratio",) if eight else SERIES
                yield grid(Chain(N, **MODELS[model]), [f"low:{part}"], (order,), borders)
        seeds = [str(q) for q in range(1, 16)]
        order = max(ORDERS[1][model])
        yield grid(Chain(16, **MODELS[model]), seeds, (order,), (*SERIES, "fold"))
    for N in FLACH_LENGTHS:
        chain = Chain(N, **MODELS["beta=1"])
        yield grid(chain, list(FLACH_SEEDS), (8,), (*SERIES, "stability"))
    yield from more_grids()


def more_grids() -> Iterator[dict[str, Any]]:
    """Whether the laws hold for other couplings, at odd lengths, and for more seeds."""
    for N in DOUBLINGS:
        for model, couplings in OTHER_MODELS.items():
            chain, fold = (
                Chain(N, **couplings),
                () if "-" in model and N < LONG else ("fold",),
            )
            yield grid(chain, ["low:1"], (8, 6), (*SERIES, *fold))
            yield grid(chain, ["high:1"], (8, 6), SERIES)
    for model in EXTENSIVE:
        orders = ORDERS[1][model]
        for N in OTHER_MIDDLES:
            yield grid(Chain(N, **MODELS[model]), ["middle:1"], orders, SERIES)
        for seed in FROM_MIDDLE:
            yield grid(Chain(MIDDLE_LENGTH, **MODELS[model]), [seed], orders, SERIES)
        for N in ODD:
            chain = Chain(N, **MODELS[model])
            fold = ("fold",) if model == "alpha=1" or N >= LONG else ()
            yield grid(chain, ["low:1"], orders, (*SERIES, *fold))
            yield grid(chain, ["high:1"], orders, SERIES)
            yield grid(chain, ["low:2", "high:2"], ORDERS[2][model], SERIES)
        for packet in MORE_SEEDS:
            for N in DOUBLINGS[1:]:
                order = MORE_SEEDS[packet][model == "beta=1"]
                yield grid(Chain(N, **MODELS[model]), [packet], (order,), SERIES)


def grid(
    chain: Chain, packets: list[str], order: tuple[int, ...], borders: tuple[str, ...]
) -> dict[str, Any]:
    """One call of `atlas`."""
    return {"chains": [chain], "packets": packets, "order": order, "borders": borders}


def make_data() -> None:
    """All rows that the file has not; it may be stopped and called again."""
    for number, arguments in enumerate(grids(), 1):
        found = atlas(**arguments, reach=REACH, file=FILE)
        print(number, found, flush=True)
    for arguments in (*newton_grids(), *one_seed_grids()):
        print(atlas(**arguments), flush=True)
    make_chaos_data()


def make_chaos_data() -> None:
    """The orbits, a column at a time: fewer cores than two cost what they cost."""
    for arguments in chaos_grids():
        print(atlas(**arguments, executor=ThisProcess()), flush=True)


def chaos_grids() -> Iterator[dict[str, Any]]:
    """The arguments of every call for the borders of chaos; the shortest time first."""
    for T, file in CHAOS_FILES.items():
        packets = {**CHAOS_PARTS[T], **CHAOS_SEEDS[T]}
        cases = [(N, name) for name, lengths in packets.items() for N in lengths]
        for N, name in sorted(cases, key=lambda case: case[0]):
            for model in EXTENSIVE:
                yield chaos_grid(Chain(N, **MODELS[model]), f"low:{name}", T, file)
        if min(CHAOS_FILES) == T:
            for N in TODA_LENGTHS:
                yield chaos_grid(Chain(N, **MODELS[TODA]), "low:1/8", T, file)


def chaos_grid(chain: Chain, packet: str, T: float, file: Path) -> dict[str, Any]:
    """One call of `atlas` for orbits alone."""
    borders = ["chaos", "in-phase"]
    return {
        "chains": [chain],
        "packets": [packet],
        "order": 1,
        "borders": borders,
        "time": T,
        "file": file,
    }


def newton_grids() -> Iterator[dict[str, Any]]:
    """The arguments of every call for Newton's tori of low packets."""
    for s, lengths in NEWTON_SEEDS.items():
        for model in EXTENSIVE:
            chains = [Chain(N, **MODELS[model]) for N in lengths]
            shared = {"chains": chains, "packets": [f"low:{s}"], "file": NEWTON_FILE}
            yield shared | NEWTON_HOW


def one_seed_grids() -> Iterator[dict[str, Any]]:
    """The arguments of every call for the end of Newton's breathers."""
    for model, lengths in ONE_SEED_LENGTHS.items():
        for N in lengths:
            chain = Chain(N, **MODELS[model])
            shared = {"chains": [chain], "packets": ["low:1"], "file": ONE_SEED_FILE}
            yield shared | ONE_SEED_HOW


def tables(found: Atlas) -> dict[str, str]:
    """The tables of the page by name."""
    return {
        "laws": laws_table(found),
        "couplings": couplings_table(found),
        "odd": odd_table(found),
        "middle": middle_table(found),
        "folds": folds_table(found),
        "packets": packets_table(found),
        "flach": flach_table(found),
        "newton": newton_table(found),
        "newton-laws": newton_laws_table(),
        "one-seed": one_seed_table(),
        "chaos": chaos_table(),
        "chaos-laws": chaos_laws_table(),
    }


def rows_of(head: list[str], rows: list[list[str]]) -> str:
    """A table of Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def exponent(
    found: Atlas, packet: str, border: str, model: str, least: int = 0, **how: Any
) -> str:
    """A fitted power of N with its error, or why there is none."""
    try:
        law = found.law(packet, border, model=model, **how)
        pairs = zip(law.lengths, law.energies, strict=True)
        kept = [
            (N, H)
            for N, H in pairs
            if least <= N and (N % 2 == 0 or "middle" not in packet)
        ]
        law = power_law([N for N, _ in kept], [H for _, H in kept])
    except InputError:
        return ""
    return f"{law.exponent:.2f} ± {law.error:.2f}"


def laws_table(found: Atlas) -> str:
    """Exponents of H in N at a fixed number of seeds."""
    head = [
        "model",
        "packet",
        "ratio",
        "Padé poles",
        f"ratio, N >= {LONG}",
        f"poles, N >= {LONG}",
        "poles, lower order",
        "fold",
        "stability",
    ]
    rows = []
    for model in MODELS:
        for packet in ("low:1", "middle:1", "high:1", "low:2", "high:2"):
            orders = ORDERS[int(packet[-1])][model]
            cells = [exponent(found, packet, name, model) for name in SERIES]
            cells += [exponent(found, packet, name, model, LONG) for name in SERIES]
            lower = exponent(found, packet, "poles", model, order=orders[-1])
            cells.append(lower if len(orders) > 1 else "")
            cells += [
                exponent(found, packet, name, model) for name in ("fold", "stability")
            ]
            if any(cells):
                rows.append([model, packet, *cells])
    return rows_of(head, rows)


def couplings_table(found: Atlas) -> str:
    """Exponents of other couplings and of more seeds, N from 8 or 16 to 64."""
    head = ["model", "packet", "order", "ratio", "Padé poles", "fold", "H by ratio, N = 64"]
    cases = [(name, packet) for name in LABELS for packet in ("low:1", "high:1")]
    cases += [(name, packet) for name in EXTENSIVE for packet in MORE_SEEDS]
    rows = []
    for model, packet in cases:
        cells = [exponent(found, packet, name, model) for name in (*SERIES, "fold")]
        last = chosen(found, packet, "ratio", model)[DOUBLINGS[-1]]
        rows.append([model, packet, str(last.order), *cells, energy(last)])
    return rows_of(head, rows)


def odd_table(found: Atlas) -> str:
    """H at odd lengths over the power of N between the even neighbours in the atlas, less 1."""
    head = ["model", "packet", "border", *(f"N = {N}" for N in ODD[1:])]
    rows = []
    for model in EXTENSIVE:
        for packet in ("low:1", "high:1", "low:2", "high:2"):
            for name in (*SERIES, "fold"):
                by_length = chosen(found, packet, name, model)
                cells = [departure(by_length, N) for N in ODD[1:]]
                if any(cells):
                    rows.append([model, packet, name, *cells])
    return rows_of(head, rows)


def departure(by_length: dict[int, AtlasBorder], N: int) -> str:
    """Of one length from the power of N between its even neighbours, in percent."""
    below = max((M for M in by_length if M % 2 == 0 and M < N), default=0)
    above = min((M for M in by_length if M % 2 == 0 and M > N), default=0)
    if N not in by_length or not below or not above:
        return ""
    law = math.log(by_length[above].energy / by_length[below].energy) / math.log(
        above / below
    )
    between = by_length[below].energy * (N / below) ** law
    return f"{100 * (by_length[N].energy / between - 1):+.1f} %"


def middle_table(found: Atlas) -> str:
    """H of seeds at a distance m from the middle of the band."""
    head = [
        "model",
        "N",
        "N mod 4",
        "seed",
        "m = q - N/2",
        "H by ratio",
        "H by poles",
        "H/m",
    ]
    rows = []
    for model in EXTENSIVE:
        for N in (32, 64, 128, 256, *OTHER_MIDDLES):
            rows += [middle_row(found, model, N, "middle:1")]
        rows += [middle_row(found, model, MIDDLE_LENGTH, seed) for seed in FROM_MIDDLE]
    rows.sort(key=lambda row: (row[0], float(row[4]), int(row[1])))
    return rows_of(head, rows)


def middle_row(found: Atlas, model: str, N: int, packet: str) -> list[str]:
    """One line of it."""
    ratio, poles = (chosen(found, packet, name, model)[N] for name in SERIES)
    (q,) = poles.modes
    m = q - N / 2
    sizes = [energy(ratio), energy(poles), f"{poles.energy / m:.3g}"]
    return [model, str(N), str(N % 4), str(q), f"{m:g}", *sizes]


def chosen(found: Atlas, packet: str, border: str, model: str) -> dict[int, AtlasBorder]:
    """Borders by N, of the largest order."""
    members = sorted(found.borders, key=lambda b: b.order)
    wanted = [
        b for b in members if (b.packet, b.border, b.model) == (packet, border, model)
    ]
    return {b.N: b for b in wanted if b.energy is not None}


def folds_table(found: Atlas) -> str:
    """Energies of the lowest borders of one low seed, in units of lambda = 1."""
    head = [
        "model",
        "N",
        "ratio",
        "Padé poles",
        "fold",
        "what folds",
        "lambda of the fold",
        "stability lost",
    ]
    rows = []
    for model in ("alpha=1", "beta=1"):
        by_name = {
            name: chosen(found, "low:1", name, model)
            for name in (*SERIES, "fold", "stability")
        }
        for N in LENGTHS:
            cells = [energy(by_name[name].get(N)) for name in (*SERIES, "fold")]
            fold = by_name["fold"].get(N)
            what = "" if fold is None else "not sure"
            if fold is not None and fold.details.get("mode"):
                mode, (harmonic, *_) = fold.details["mode"], fold.details["harmonic"]
                what = f"mode {mode}, harmonic {harmonic}"
            size = "" if fold is None else f"{fold.energy / unit(model, N, 1):.3f}"
            rows.append(
                [model, str(N), *cells, what, size, energy(by_name["stability"].get(N))]
            )
    return rows_of(head, rows)


def unit(model: str, N: int, s: int) -> float:
    """The energy at which the paper's lambda is 1."""
    if model == "alpha=1":
        return math.pi**4 * s**4 / N**3
    return math.pi**2 * s**2 / N


def energy(border: AtlasBorder | None) -> str:
    """To three digits."""
    return "" if border is None else f"{border.energy:.3g}"


def packets_table(found: Atlas) -> str:
    """Energies per particle of packets that grow with the chain."""
    head = ["model", "M", "N", "s", "H/N by ratio", "H/N by poles", "lambda (poles)"]
    rows = []
    for model in EXTENSIVE:
        for part, lengths in PARTS.items():
            ratio, poles = (chosen(found, f"low:{part}", name, model) for name in SERIES)
            for N in lengths:
                if N not in ratio:
                    continue
                s = len(ratio[N].modes)
                cells = [
                    f"{border[N].energy / N:.3g}" if N in border else ""
                    for border in (ratio, poles)
                ]
                size = f"{poles[N].energy / unit(model, N, s):.3g}" if N in poles else ""
                rows.append([model, part, str(N), str(s), *cells, size])
    return rows_of(head, rows)


def flach_table(found: Atlas) -> str:
    """Where breathers of beta lose stability, as 6 beta H N/pi^2, published: 1 + O(1/N^2)."""
    head = ["N", *(f"seed {q}" for q in ("1", *FLACH_SEEDS)), "published"]
    by_seed = [
        chosen(found, packet, "stability", "beta=1") for packet in ("low:1", *FLACH_SEEDS)
    ]
    rows = []
    for N in FLACH_LENGTHS:
        cells = [
            f"{6 * seed[N].energy * N / math.pi**2:.3f}" if N in seed else ""
            for seed in by_seed
        ]
        rows.append([str(N), *cells, "1 + O(1/N^2)"])
    return rows_of(head, rows)


def done(file: Path) -> list[SweepRow]:
    """The rows of a file that have a result; SystemExit where one has none."""
    rows = read_atlas(file).rows.rows
    failed = [row for row in rows if row.failure is not None]
    if failed:
        reasons = "\n".join(f"{row.case}: {row.failure}" for row in failed)
        sys.exit(
            f"{file} has rows without a result; delete these lines and call again:\n{reasons}"
        )
    return list(rows)


class NewtonColumn(NamedTuple):
    """A column of NEWTON_FILE: seeds 1 .. s of a chain, and H of the tori on the way."""

    model: str
    s: int
    N: int
    end: dict[str, Any]
    tori: list[dict[str, Any]]

    def at_harmonics(self, count: int) -> float | None:
        """H at which tori need so many, between the first that has more and the one before."""
        for before, torus in zip(self.tori, self.tori[1:], strict=False):
            sizes = [math.log(point["harmonics"]) for point in (before, torus)]
            if sizes[0] <= math.log(count) < sizes[1]:
                part = (math.log(count) - sizes[0]) / (sizes[1] - sizes[0])
                return before["energy"] * (torus["energy"] / before["energy"]) ** part
        return None


def newton_columns() -> list[NewtonColumn]:
    """All of them, by model, s and N."""
    columns = []
    for row in done(NEWTON_FILE):
        chain, result = row.case["chain"], row.result
        model = "alpha=1" if chain["alpha"] != "0" else "beta=1"
        s, end = len(result["modes"]), result["borders"]["newton"]
        columns.append(NewtonColumn(model, s, int(chain["N"]), end, result["newton"]))
    return sorted(columns, key=lambda column: column[:3])


def newton_table(found: Atlas) -> str:
    """How far Newton's tori of low packets were followed."""
    head = ["model", "s", "N", "M", "H/N by ratio", "H/N, last torus", "harmonics"]
    head += ["with more", "residual", "change", f"chaos by {min(CHAOS_FILES):.0e}"]
    head += ["what ends the search"]
    chaos = chaos_by(min(CHAOS_FILES))
    rows = []
    for column in newton_columns():
        model, s, N, end, tori = column
        names = (f"low:{s}", f"low:1/{N // s}")
        by_name = [chosen(found, name, "ratio", model).get(N) for name in names]
        ratio, sharper = by_name[0] or by_name[1], end["confirmed"]
        rows.append(
            [
                model,
                str(s),
                str(N),
                f"1/{N // s}" if N % s == 0 else "",
                f"{ratio.energy / N:.3g}" if ratio else "",
                f"{end['energy'] / N:.3g}",
                str(tori[-1]["harmonics"]),
                str(sharper.get("harmonics", "")),
                f"{sharper['residual']:.1e}" if "residual" in sharper else "",
                f"{sharper['change']:.0e}" if "change" in sharper else "",
                specific(chaos.get((model, s, N))),
                end["failure"],
            ]
        )
    return rows_of(head, rows)


def newton_laws_table() -> str:
    """Powers of N of H at which tori need so many harmonics, and of the last torus."""
    head = ["model", "packets", "N", f"lambda at {NEEDED[0]} harmonics"]
    head += [*(f"power of N, {count} harmonics" for count in NEEDED), "last torus"]
    columns = [column for column in newton_columns() if column.s > 1]
    rows = []
    for model in EXTENSIVE:
        for name, belongs in NEWTON_GROUPS.items():
            group = [c for c in columns if c.model == model and belongs(c.s, c.N)]
            energies = [(c, c.at_harmonics(NEEDED[0])) for c in group]
            sizes = [H and f"{H / unit(model, c.N, c.s):.3g}" for c, H in energies]
            lists = [", ".join(str(c.N) for c in group), ", ".join(filter(None, sizes))]
            powers = [
                newton_power({c.N: c.at_harmonics(count) for c in group})
                for count in NEEDED
            ]
            last = newton_power({c.N: c.end["energy"] for c in group}, WIDE_FACTOR)
            rows.append([model, name, *lists, *powers, last])
    return rows_of(head, rows)


def newton_power(energies: dict[int, float | None], factor: float = 1.0) -> str:
    """The power of N with its error, which two lengths do not have.

    factor : between neighbours of the grid that the energies lie on.
    """
    known = {N: H for N, H in energies.items() if H is not None}
    if len(known) == 2:
        (N, H), (longer, lower) = known.items()
        return f"{math.log(lower / H) / math.log(longer / N):.1f}"
    law = power_law(list(known), list(known.values()))
    error = max(law.error, grid_error(law.lengths, factor))
    return f"{law.exponent:.2f} ± {error:.2f}"


def one_seed_table() -> str:
    """Where Newton's breathers of seed 1 end on the way up in H, and why."""
    head = ["model", "N", "H, last breather", "harmonics", "d ln A / d ln H there"]
    head += ["what ends the search"]
    rows = []
    for row in done(ONE_SEED_FILE):
        end = row.result["borders"]["newton"]
        model = "alpha=1" if row.case["chain"]["alpha"] != "0" else "beta=1"
        harmonics = str(row.result["newton"][-1]["harmonics"])
        cells = [f"{end['energy']:.4g}", harmonics, f"{end['slopes'][0]:.2f}"]
        rows.append([model, str(row.case["chain"]["N"]), *cells, end["failure"]])
    rows.sort(key=lambda cells: (cells[0], int(cells[1])))
    return rows_of(head, rows)


Borders = dict[tuple[str, int, int], AtlasBorder]


def chaos_by(T: float, name: str = "chaos") -> Borders:
    """Borders of chaos by a time, by model, s and N; of the file with the fewest longer times."""
    file = next(file for longest, file in CHAOS_FILES.items() if longest >= T)
    borders = read_atlas(file).by_time(T).borders
    return {(b.model, len(b.modes), b.N): b for b in borders if b.border == name}


def chaos_table() -> str:
    """H/N at which orbits of low packets are seen to be chaotic, by several times."""
    columns = [chaos_by(T) for T in SEEN_BY]
    in_phase = [chaos_by(T, "in-phase") for T in SEEN_BY[1:3]]
    head = ["model", "M", "N", "s", *(f"by {T:.0e}" for T in SEEN_BY)]
    head += [f"phases 0, by {T:.0e}" for T in SEEN_BY[1:3]]
    keys = {key for column in columns for key in column}
    rows = []
    for model, s, N in sorted(keys, key=lambda key: (key[0], key[2] / key[1], key[2])):
        cells = [spread(column.get((model, s, N))) for column in columns]
        cells += [specific(column.get((model, s, N))) for column in in_phase]
        rows.append([model, f"1/{N // s}", str(N), str(s), *cells])
    return rows_of(head, rows)


def specific(border: AtlasBorder | None) -> str:
    """H/N to two digits; "none" where no chaos was seen at any energy."""
    if border is None:
        return ""
    return "none" if border.energy is None else f"{border.energy / border.N:.2g}"


def spread(border: AtlasBorder | None) -> str:
    """The median over the draws with the lowest and the highest."""
    middle = specific(border)
    if border is None or border.energy is None:
        return middle
    lowest, highest = (
        f"{H / border.N:.2g}" if H else "" for H in border.details["between"]
    )
    return middle if lowest == highest else f"{middle} ({lowest} .. {highest})"


def chaos_laws_table() -> str:
    """Powers of N and of T with which H/N goes, where there are three lengths or two times."""
    head = ["model", "packets", "N", *(f"power of N, by {T:.0e}" for T in SEEN_BY[:2])]
    head += ["N", *(f"power of T, {T:.0e} to {10 * T:.0e}" for T in SEEN_BY[:2])]
    rows = []
    for model in EXTENSIVE:
        for name, chosen_by in CHAOS_GROUPS.items():
            laws = [power_of_lengths(T, model, chosen_by) for T in SEEN_BY[:2]]
            longest = longest_followed(model, chosen_by)
            times = [power_of_time(T, (model, *longest)) for T in SEEN_BY[:2]]
            lengths = laws[0][0]
            rows.append([model, name, lengths, *(law for _, law in laws)])
            rows[-1] += [str(longest[1]), *times]
    return rows_of(head, rows)


def is_number(seeds: int) -> Callable[[int, int], bool]:
    """Whether s is so many."""
    return lambda s, N: s == seeds


def is_part(part: int) -> Callable[[int, int], bool]:
    """Whether s is this part of N."""
    return lambda s, N: s * part == N


NEWTON_GROUPS: dict[str, Callable[[int, int], bool]] = {
    **{f"s = {s}": is_number(s) for s in (2, 3, 4)},
    **{f"M = 1/{part}": is_part(part) for part in (8, 16, 32)},
}
CHAOS_GROUPS: dict[str, Callable[[int, int], bool]] = {
    "M = 1/8": is_part(8),
    "M = 1/16": is_part(16),
    "M = 1/32": is_part(32),
    "s = 1": is_number(1),
}


def power_of_lengths(
    T: float, model: str, chosen_by: Callable[[int, int], bool]
) -> tuple[str, str]:
    """The lengths from LONG on, and the power of N of H/N with its error."""
    borders = [
        b for (name, s, N), b in chaos_by(T).items() if name == model and chosen_by(s, N)
    ]
    long_ones = sorted((b for b in borders if b.N >= LONG and b.energy), key=lambda b: b.N)
    law = power_law([b.N for b in long_ones], [b.energy / b.N for b in long_ones])
    error = max(law.error, grid_error(law.lengths, FACTOR))
    return f"{law.lengths[0]} .. {law.lengths[-1]}", f"{law.exponent:.2f} ± {error:.2f}"


def grid_error(lengths: tuple[int, ...], factor: float) -> float:
    """Of an exponent of energies that lie anywhere between two neighbours of a grid."""
    x = [math.log(N) for N in lengths]
    mean = sum(x) / len(x)
    spread_of_lengths = sum((value - mean) ** 2 for value in x)
    return math.log(factor) / math.sqrt(12 * spread_of_lengths)


def longest_followed(model: str, chosen_by: Callable[[int, int], bool]) -> tuple[int, int]:
    """s and N of the longest chain whose orbits were followed to the third time."""
    keys = [
        (s, N) for name, s, N in chaos_by(SEEN_BY[2]) if name == model and chosen_by(s, N)
    ]
    return max(keys, key=lambda key: key[1])


def power_of_time(T: float, key: tuple[str, int, int]) -> str:
    """Between T and 10 T."""
    early, late = (chaos_by(time).get(key) for time in (T, 10 * T))
    if early is None or late is None:
        return ""
    return f"{math.log10(late.energy / early.energy):.2f}"


def with_tables(text: str, found: Atlas) -> str:
    """The page with its tables made anew."""
    for name, table in tables(found).items():
        begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
        start, _, rest = text.partition(begin)
        _, _, after = rest.partition(end)
        text = f"{start}{begin}\n{table}\n{end}{after}"
    return text


def draw(found: Atlas) -> None:
    """The pictures of the page."""
    import matplotlib as mpl

    mpl.use("Agg")
    from symfpu import plots

    packets = ["low:1", "high:1", "low:2"]
    for model, name in zip(("alpha=1", "beta=1"), PICTURES, strict=False):
        axes = plots.atlas_borders(
            found, models=[model], packets=packets, borders=["poles", "fold"]
        )
        save(axes, name)
    axes = plots.atlas_map(found, N=16, model="alpha=1", border="fold")
    save(axes, PICTURES[-1])
    together = with_chaos(found)
    for model, name in CHAOS_PICTURES.items():
        axes = plots.atlas_borders(
            together,
            models=[model],
            borders=["ratio", "newton", "chaos"],
            per_particle=True,
        )
        save(axes, name)


def with_chaos(found: Atlas) -> Atlas:
    """Low packets of the parts 1/8, 1/16 and 1/32: their series, Newton's tori and orbits."""
    chaos, newton = (
        read_atlas(file) for file in (CHAOS_FILES[min(CHAOS_FILES)], NEWTON_FILE)
    )
    wanted = {f"low:{part}" for part in CHAOS_PARTS[min(CHAOS_FILES)]}
    named = [named_by_part(row) for row in newton.rows.rows]
    rows = [*found.rows.rows, *chaos.rows.rows, *named]
    kept = tuple(row for row in rows if row.case["packet"] in wanted)
    return Atlas(replace(found.rows, rows=kept))


def named_by_part(row: SweepRow) -> SweepRow:
    """The same with s seeds as a part of N."""
    seeds = int(row.case["packet"].removeprefix("low:"))
    part = Fraction(seeds, int(row.case["chain"]["N"]))
    return replace(row, case={**row.case, "packet": f"low:{part}"})


def save(axes: Any, name: str) -> None:
    """A picture beside the page."""
    axes.figure.savefig(
        HERE / name, dpi=110, bbox_inches="tight", metadata={"Software": None}
    )


def main() -> None:
    """Data if asked for, then page and pictures."""
    if sys.argv[1:] == ["--data"]:
        make_data()
    found = read_atlas(FILE)
    PAGE.write_text(with_tables(PAGE.read_text(), found))
    draw(found)


if __name__ == "__main__":
    main()
