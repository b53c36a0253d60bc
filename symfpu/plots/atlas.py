"""Where q-tori end: borders by the length of the chain, and by the mode that is excited."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np

from symfpu.borders.atlas import Atlas, AtlasBorder
from symfpu.borders.laws import LEAST_LENGTHS, power_law
from symfpu.errors import InputError
from symfpu.plots.legends import legend
from symfpu.plots.style import Axes, axes_for, look, require

AN_ATLAS, ADVICE = "an Atlas", "pass what atlas gave"
UNNAMED = "not sure"  # of borders whose coefficient is another on both sides
MOST_HARMONICS = 8  # with a name of their own in the legend of a map
Lines = dict[tuple[str, str, str], list[AtlasBorder]]


def atlas_borders(
    result: Any,
    ax: Axes | None = None,
    *,
    models: Sequence[str] | None = None,
    packets: Sequence[str] | None = None,
    borders: Sequence[str] | None = None,
    per_particle: bool = False,
) -> Axes:
    """Energy at which tori end against the length of the chain, with the fitted power of N.

    result : what `atlas` gave; dimensionless. Ours. ax : axes of matplotlib; default new ones.
    models, packets, borders : which, by their names; default all. per_particle : H/N instead of H.

    Of several orders the largest is drawn, and a line down to the other; of chaos a line over the
    draws. Borders that only the search ended are arrows up, and not fitted. Returns the axes.
    Raises InputError.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, atlas
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = atlas([Chain(4, beta=1)], ["low:1"], 3, borders=["ratio"], executor=pool)
    >>> atlas_borders(found, Figure().add_subplot()).get_xlabel()
    '$N$'
    """
    found = require(result, Atlas, AN_ATLAS, ADVICE)
    lines = _lines(found, models, packets, borders)
    with axes_for(ax, _in_common(lines)) as axes:
        for i, (names, members) in enumerate(lines.items()):
            _draw_line(axes, i, _label(names, lines), members, per_particle)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_xlabel("$N$")
        axes.set_ylabel("$H/N$" if per_particle else "$H$")
        legend(axes)
    return axes


def _lines(
    found: Atlas,
    models: Sequence[str] | None,
    packets: Sequence[str] | None,
    borders: Sequence[str] | None,
) -> Lines:
    """Borders of one model, packet and kind, by growing N; raises InputError if there are none."""
    lines: Lines = defaultdict(list)
    for border in found.borders:
        wanted = (
            (models is None or border.model in models)
            and (packets is None or border.packet in packets)
            and (borders is None or border.border in borders)
        )
        if wanted and border.energy is not None:
            lines[border.model, border.packet, border.border].append(border)
    if not lines:
        allowed = "models, packets and borders of this atlas"
        raise InputError("result", "no such border", allowed, "look at its to_frame()")
    return lines


def _label(names: tuple[str, str, str], lines: Lines) -> str:
    """What tells one line from the others."""
    columns = list(zip(*lines, strict=True))
    telling = [
        name for name, all_of in zip(names, columns, strict=True) if len(set(all_of)) > 1
    ]
    return ", ".join(telling) or names[1]


def _in_common(lines: Lines) -> str:
    """The model, packet and border of all lines."""
    columns = [set(column) for column in zip(*lines, strict=True)]
    return ", ".join(column.pop() for column in columns if len(column) == 1)


def _draw_line(
    axes: Axes, place: int, label: str, members: list[AtlasBorder], per_particle: bool
) -> None:
    best: dict[int, AtlasBorder] = {}
    least: dict[int, AtlasBorder] = {}
    for border in sorted(members, key=lambda b: b.order):
        best[border.N] = border
        least.setdefault(border.N, border)
    lengths = sorted(best)
    energies = np.array([best[N].energy for N in lengths], float)
    others = np.array([least[N].energy for N in lengths], float)
    limited = np.array([best[N].limited for N in lengths])
    unit = np.array(lengths, float) if per_particle else np.ones(len(lengths))
    fitted = [N for N, out in zip(lengths, limited, strict=True) if not out]
    if len(fitted) >= LEAST_LENGTHS:
        law = power_law(fitted, list(energies[~limited]))
        exponent = law.exponent - (1 if per_particle else 0)
        label += f"  $N^{{{exponent:.2f} \\pm {law.error:.2f}}}$"
    style = look(place)
    [line] = axes.plot(lengths, energies / unit, label=label, **style)
    colour = line.get_color()
    axes.vlines(lengths, others / unit, energies / unit, color=colour, lw=0.8)
    spans = [_span_of_draws(best[N]) for N in lengths]
    axes.vlines(lengths, *(np.array(spans).T / unit), color=colour, lw=0.8)
    at = np.array(lengths)[limited]
    above = (energies / unit)[limited]
    axes.plot(at, 1.25 * above, ls="none", marker=r"$\uparrow$", color=colour)


def _span_of_draws(border: AtlasBorder) -> tuple[float, float]:
    """The lowest and the highest energy of random phases; no length for all other borders."""
    here = float(border.energy or 0.0)
    if "draws" not in border.details:
        return here, here
    lowest, highest = border.details["between"]
    return float(lowest), float(highest or here)


def atlas_map(
    result: Any,
    ax: Axes | None = None,
    *,
    N: int | None = None,
    model: str | None = None,
    border: str = "poles",
) -> Axes:
    """Energy at which tori of one chain end by their first seed, coloured by what ends the series.

    result : what `atlas` gave; dimensionless. Ours. ax : axes of matplotlib; default new ones.
    N, model : which chain; needed if there are several. border : which, by its name.

    A colour is the harmonic of the largest term of the series at its border, for one seed nu of
    cos(nu omega t), and the mode that carries it is written beside. Returns the axes. Raises
    InputError.

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, atlas
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = atlas([Chain(4, beta=1)], ["1"], 3, borders=["poles"], executor=pool)
    >>> atlas_map(found, Figure().add_subplot()).get_xlabel()
    'seed'
    """
    found = require(result, Atlas, AN_ATLAS, ADVICE)
    members = _of_one_chain(found, N, model, border)
    by_harmonic: dict[str, list[AtlasBorder]] = defaultdict(list)
    for member in members:
        harmonic = member.details.get("harmonic") or ()
        by_harmonic[",".join(map(str, harmonic))].append(member)
    ordered = sorted(by_harmonic, key=lambda name: -len(by_harmonic[name]))
    of = f"N={members[0].N}, {members[0].model}, border: {border}"
    with axes_for(ax, of) as axes:
        for i, name in enumerate(ordered[:MOST_HARMONICS]):
            label = f"$\\nu$ = ({name})" if name else UNNAMED
            _draw_points(axes, i, label, by_harmonic[name])
        rest = [m for name in ordered[MOST_HARMONICS:] for m in by_harmonic[name]]
        if rest:
            _draw_points(axes, MOST_HARMONICS, "others", rest)
        axes.set_yscale("log")
        axes.set_xlabel("seed")
        axes.set_ylabel("$H$")
        legend(axes)
    return axes


def _of_one_chain(
    found: Atlas, N: int | None, model: str | None, border: str
) -> list[AtlasBorder]:
    """Borders of one kind, of the largest order of each packet."""
    members = [
        b
        for b in found.borders
        if b.border == border and b.energy is not None
        if N in (None, b.N) and model in (None, b.model)
    ]
    chains = {(b.N, b.model) for b in members}
    if len(chains) != 1:
        listed = ", ".join(f"N = {N}, {model}" for N, model in sorted(chains)) or "none"
        allowed = "one chain with this border"
        raise InputError("N, model", listed, allowed, "name N= and model=")
    best: dict[str, AtlasBorder] = {}
    for member in sorted(members, key=lambda b: b.order):
        best[member.packet] = member
    return sorted(best.values(), key=lambda b: b.modes)


def _draw_points(axes: Axes, place: int, label: str, members: list[AtlasBorder]) -> None:
    style = look(place) | {"ls": "none"}
    seeds = [member.modes[0] for member in members]
    energies = [member.energy for member in members]
    axes.plot(seeds, energies, label=label, **style)
    for member in members:
        axes.annotate(
            str(member.details.get("mode") or ""),
            (member.modes[0], member.energy),
            textcoords="offset points",
            xytext=(0, 4),
            ha="center",
            fontsize="x-small",
        )
