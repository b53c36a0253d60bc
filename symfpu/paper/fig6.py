"""Fig. 6: orders of first excitation around three packets, and what section 6.3 says of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.propagation import excitation_sequence, reachable_modes
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.printed import FIG6_CHAIN, FIG6_WIDTH
from symfpu.results.text_tables import markdown_table
from symfpu.tori.at_energy import series_at_energy
from symfpu.tori.energy import Energy
from symfpu.tori.orders import Orders

PLACES = {"a": "1/4", "b": "1/2", "c": "3/4"}  # of the packets, kappa_0 by panel

# the torus whose spectrum is compared: three seeds, excited wholly at this order
SPECTRUM_CHAIN, SPECTRUM_ENERGY, SPECTRUM_ORDER = Chain(48, alpha="0.33"), "0.0001", 6
STRONG_CORRELATION = 0.95


@dataclass(frozen=True)
class Packet:
    """The order at which each mode is first excited by a packet of seeds (alpha)."""

    N: int
    seeds: tuple[int, ...]
    orders: dict[int, int]


def figure6(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Orders of first excitation, and the intervals M_k against the rule."""
    packets = excited_by_packets()
    panels = tuple(_panel(letter, packet) for letter, packet in packets.items())
    progress("fig6: spectra", NO_FRACTION)
    claims = (
        *map(intervals_claim, packets.values()),
        *(spectrum_claim(name) for name in PLACES.values()),
    )
    numbers = {letter: _record(packet) for letter, packet in packets.items()}
    title = f"Fig. 6: orders of first excitation, N = {FIG6_CHAIN}, alpha"
    table = _table(packets)
    return PaperFigure("fig6", title, panels, claims, text=(table,), numbers=numbers)


def excited_by_packets() -> dict[str, Packet]:
    """Packets of half-width FIG6_WIDTH modes, up to the order that excites every mode; by panel."""
    N, width = FIG6_CHAIN, FIG6_WIDTH
    packets = {}
    for quarter, letter in enumerate(PLACES, 1):
        center = quarter * N // 4
        seeds = tuple(range(center - width, center + width + 1))
        sequence = excitation_sequence(N, seeds, N // width)
        orders = {q: k for k, modes in enumerate(sequence) for q in modes}
        packets[letter] = Packet(N, seeds, orders)
    return packets


def _panel(letter: str, packet: Packet) -> Panel:
    """Small orders on top, as energies would lie."""
    modes = sorted(packet.orders)
    kappa = [q / packet.N for q in modes]
    orders = [packet.orders[q] for q in modes]
    curve = Curve("", np.array(kappa), np.array(orders, dtype=float), "dots", name="order")
    seeds = f"{packet.seeds[0]}..{packet.seeds[-1]}"
    around = rf"$\kappa_0 = {PLACES[letter]}$, N = {packet.N}"
    return Panel(
        f"fig6{letter}",
        f"Fig. 6({letter}): packet {seeds} around {around}",
        r"$\kappa = q/N$",
        r"order $k$ of first excitation",
        (curve,),
        ("kappa", "order"),
        log_y=False,
        x_limits=(0.0, 1.0),
        falling=True,
        columns={"q": modes, "kappa": kappa, "order": orders},
    )


def _record(packet: Packet) -> dict[str, Any]:
    return {"seeds": list(packet.seeds), "orders": packet.orders}


def _table(packets: dict[str, Packet]) -> str:
    rows = []
    for letter, packet in packets.items():
        seeds = f"{packet.seeds[0]}..{packet.seeds[-1]}"
        latest = max(packet.orders.values())
        rows.append([letter, seeds, str(len(packet.orders)), str(latest)])
    return markdown_table(
        ["panel", "seeds", "modes excited", "at order, at the latest"], rows
    )


def intervals_claim(packet: Packet) -> Claim:
    """The intervals M_k of section 6.3 around a packet, against the rule."""
    N, first, last = packet.N, packet.seeds[0], packet.seeds[-1]
    center = (first + last) // 2
    width = (last - first) // 2
    last_order = N // (4 * width) - 1  # before the intervals meet
    sets = reachable_modes(N, packet.seeds, last_order)
    wrong = []
    for k in range(1, last_order + 1):
        stated = _interval_modes(N, center, width * (k + 1), k)
        if set(sets[k]) != stated:
            wrong.append(k)
    where = "all" if not wrong else f"all but {wrong} of"
    ours = f"N = {N}, packets of {len(packet.seeds)} modes: "
    ours += f"M_k as stated for {where} k = 1 .. {last_order}"
    text = f"kappa_0 = {center / N:g}: M_k are intervals of half-width epsilon (k+1) "
    text += "around the places listed"
    return Claim("6.3", text, "", ours, judged(not wrong))


def _interval_modes(N: int, center: int, half: int, k: int) -> set[int]:
    """Modes of the printed intervals of M_k."""
    in_the_middle = 2 * center == N
    if k % 2 == 0:
        places = [center] if in_the_middle else [N // 4, 3 * N // 4]
    elif in_the_middle:
        places = [0, N]
    else:
        places = [0, N // 2]
        if k > 1:
            places.append(N)
    modes: set[int] = set()
    for place in places:
        modes |= set(range(place - half, place + half + 1))
    return modes & set(range(1, N))


def spectrum_claim(place: str) -> Claim:
    """Whether the spectrum of a torus has the pattern of the orders."""
    chain = SPECTRUM_CHAIN
    quarters = int(place[0]) * (4 // int(place[2]))
    center = quarters * chain.N // 4
    seeds = (center - 1, center, center + 1)
    energy, orders = Energy(SPECTRUM_ENERGY), Orders(SPECTRUM_ORDER)
    torus = series_at_energy(chain, seeds, energy, orders)
    sequence = excitation_sequence(chain.N, seeds, SPECTRUM_ORDER)
    return pattern_claim(place, sequence, torus.average_spectrum() / float(torus.energy()))


def pattern_claim(place: str, sequence: list[tuple[int, ...]], spectrum: Any) -> Claim:
    """Order of excitation against log10 e of every mode."""
    levels = {
        k: np.log10(spectrum[np.array(modes) - 1])
        for k, modes in enumerate(sequence)
        if modes
    }
    orders = np.concatenate([np.full(len(level), k) for k, level in levels.items()])
    correlation = float(np.corrcoef(orders, np.concatenate(list(levels.values())))[0, 1])
    medians = [float(np.median(level)) for level in levels.values()]
    falling = all(b < a for a, b in pairwise(medians))
    shown = ", ".join(f"{median:.1f}" for median in medians)
    ours = f"torus of three seeds, N = {SPECTRUM_CHAIN.N}: log10 e against k has the correlation "
    ours += f"{correlation:.3f}; medians by order {shown}"
    text = f"kappa_0 = {place}: the pattern of orders is similar to the energy spectrum"
    strong = correlation <= -STRONG_CORRELATION
    return Claim("6.3", text, "", ours, judged(strong and falling, strong or falling))
