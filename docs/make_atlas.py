"""The atlas of docs/atlas.md: its data, its tables and its pictures.

python docs/make_atlas.py           tables and pictures from docs/data/atlas.jsonl
python docs/make_atlas.py --data    first the data: rows that the file has are not computed again
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from symfpu import Atlas, AtlasBorder, Chain, atlas, read_atlas
from symfpu.borders.laws import power_law
from symfpu.errors import InputError
from symfpu.sweeps.this_process import ThisProcess

HERE = Path(__file__).parent
FILE = HERE / "data" / "atlas.jsonl"
NEWTON_FILE = HERE / "data" / "newton.jsonl"
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
NEWTON_PARTS = {"1/8": (8, 16, 32), "1/16": (16, 32, 64), "1/32": (32, 64, 128)}
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
NEWTON_HOW: dict[str, Any] = {
    "order": 2,
    "borders": ["newton"],
    "places": ["1e-6"],
    "reach": 10**6,
    "most_harmonics": 12000,
}
CHAOS_PARTS = {
    1e5: {
        "1/8": (8, 16, 32, 64, 128, 256),
        "1/16": (16, 32, 64, 128, 256),
        "1/32": (32, 64, 128, 256),
    },
    1e6: {"1/8": (8, 16, 32, 64, 128), "1/16": (16, 32, 64, 128), "1/32": (32, 64)},
    1e7: {"1/8": (8, 16)},
}
CHAOS_SEEDS = {
    1e5: {"1": (64, 128), "2": (8, 128, 256), "4": (16, 256)},
    1e6: {"1": (64,), "2": (8,)},
    1e7: {},
}
TODA_LENGTHS = (8, 16, 32)  # that must show no chaos
PICTURES = ("atlas-alpha.png", "atlas-beta.png", "atlas-map.png")


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
    for part, lengths in NEWTON_PARTS.items():
        for model in EXTENSIVE:
            chains = [Chain(N, **MODELS[model]) for N in lengths]
            print(atlas(chains, [f"low:{part}"], **NEWTON_HOW, file=NEWTON_FILE))
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
            what = (
                ""
                if fold is None
                else f"mode {fold.details['mode']}, harmonic {fold.details['harmonic'][0]}"
            )
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


def newton_table(found: Atlas) -> str:
    """How far Newton's tori of packets that grow with the chain were followed."""
    head = ["model", "M", "N", "s", "H/N by ratio", "H/N, last torus", "harmonics"]
    head += ["with more", "residual", "change", "what ends the search"]
    rows = read_atlas(NEWTON_FILE).rows.rows
    cells = []
    for row in rows:
        chain, packet, result = row.case["chain"], row.case["packet"], row.result
        model = "alpha=1" if chain["alpha"] != "0" else "beta=1"
        N, end = int(chain["N"]), result["borders"]["newton"]
        names = (packet, f"low:{len(result['modes'])}")
        by_name = [chosen(found, name, "ratio", model).get(N) for name in names]
        ratio = by_name[0] or by_name[1]
        sharper = end["confirmed"]
        cells.append(
            (
                (model, -N / len(result["modes"]), N),
                [
                    model,
                    packet.partition(":")[2],
                    str(N),
                    str(len(result["modes"])),
                    f"{ratio.energy / N:.3g}" if ratio else "",
                    f"{end['energy'] / N:.3g}",
                    str(result["newton"][-1]["harmonics"]),
                    str(sharper.get("harmonics", "")),
                    f"{sharper['residual']:.1e}" if "residual" in sharper else "",
                    f"{sharper['change']:.0e}" if "change" in sharper else "",
                    end["failure"],
                ],
            )
        )
    return rows_of(head, [line for _, line in sorted(cells)])


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
