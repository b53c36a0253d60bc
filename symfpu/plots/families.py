"""Families in energy: frequencies, amplitudes, multipliers and spectra of their members."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from symfpu.breathers.floquet import ELLIPTIC, TRIVIAL
from symfpu.errors import InputError
from symfpu.families.family import Family
from symfpu.families.members import Event, Member
from symfpu.plots.legends import legend
from symfpu.plots.spectra import spectrum_of_torus
from symfpu.plots.style import (
    MARK,
    QUIET,
    Axes,
    Floats,
    axes_for,
    look,
    require,
    subject,
    whole_numbers,
)

# of the smallest of the largest shifts: below it a scale with folds is linear
LINEAR_SCALE_SHARE = 0.01
SHIFT_ROUNDING = 1e-15  # of a relative shift in doubles
MOST_POWERS = 3  # at ticks on each side of a scale with powers of ten on both sides
SPECTRA_SHOWN = 5  # as many as the style has colours
MANY_MEMBERS = 60  # members above which they have no markers
A_FAMILY, ADVICE = "a Family", "pass what family gave"
EVENT_LOOKS = {
    "fold": ("fold", {"color": QUIET, "ls": "-", "lw": 0.9}),
    "stability": ("change of stability", {"color": MARK, "ls": "--", "lw": 1.2}),
}


def family_frequencies(result: Any, ax: Axes | None = None) -> Axes:
    """H against omega_q / Omega_q - 1 of every seed, with folds and changes of stability.

    result : what `family` gave; dimensionless (Appendix A; Eq. omeser). ax : axes of matplotlib;
        default new ones.

    A scale with folds is in powers of ten on both sides of zero; doubtful members are crosses.
    Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, family
    >>> found = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> family_frequencies(found, Figure().add_subplot()).get_ylabel()
    '$H$'
    """
    found = require(result, Family, A_FAMILY, ADVICE)
    energies = _energies(found)
    pairs = zip(found.chain.mode_numbers, found.chain.frequencies(), strict=True)
    linear = dict(pairs)
    smallest = np.inf
    with axes_for(ax, _subject(found)) as axes:
        for i, q in enumerate(found.seeds):
            rates = np.array([float(m.torus.frequencies[i]) for m in found.members])
            shifts = (rates - linear[q]) / linear[q]
            axes.plot(shifts, energies, label=f"$q = {q}$", **_look(i, found))
            _cross_doubtful(axes, found, shifts, energies)
            largest = float(np.abs(shifts).max())
            smallest = min(smallest, largest)
        folds = _mark_events(axes, found.events, "fold", vertical=False)
        _mark_events(axes, found.events, "stability", vertical=False)
        if folds:
            linear_below = max(LINEAR_SCALE_SHARE * smallest, SHIFT_ROUNDING)
            _scale_both_sides(axes, linear_below)
        axes.set_yscale("log")
        axes.set_xlabel(r"$\omega_q / \Omega_q - 1$")
        axes.set_ylabel("$H$")
        legend(axes)
    return axes


def _scale_both_sides(axes: Axes, linear_below: float) -> None:
    """Powers of ten on both sides of zero, with few ticks."""
    axes.set_xscale("symlog", linthresh=linear_below)
    axes.autoscale_view(scaley=False)
    left, right = axes.get_xlim()
    apart = np.log10(max(right, -left) / linear_below) / MOST_POWERS
    above = _powers(linear_below, right, apart)
    below = _powers(linear_below, -left, apart)
    axes.set_xticks([*(-below[::-1]), 0.0, *above])
    axes.set_xlim(left, right)


def _powers(linear_below: float, largest: float, apart: float) -> Floats:
    """Powers of ten above the linear part of a scale, ascending, so many decades apart."""
    lowest = np.ceil(np.log10(linear_below)) + 1
    highest = np.floor(np.log10(max(largest, linear_below)))
    exponents = np.arange(highest, lowest - 1, -max(1, np.ceil(apart)))
    return np.asarray(10.0 ** exponents[::-1])


def family_amplitudes(result: Any, ax: Axes | None = None) -> Axes:
    """Amplitudes |A_q| of the seeds against H; resonances as ticks below, other events as lines.

    result : what `family` gave; dimensionless (Appendix A). ax : axes of matplotlib; default new
        ones. Doubtful members are crosses. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, family
    >>> found = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> family_amplitudes(found, Figure().add_subplot()).get_xlabel()
    '$H$'
    """
    found = require(result, Family, A_FAMILY, ADVICE)
    energies = _energies(found)
    with axes_for(ax, _subject(found)) as axes:
        for i, q in enumerate(found.seeds):
            sizes = np.array([abs(m.amplitudes[q]) for m in found.members])
            axes.plot(energies, sizes, label=f"$q = {q}$", **_look(i, found))
            _cross_doubtful(axes, found, energies, sizes)
        _tick_resonances(axes, found.events)
        _mark_events(axes, found.events, "fold")
        _mark_events(axes, found.events, "stability")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("$H$")
        axes.set_ylabel("$|A_q|$")
        legend(axes)
    return axes


def family_multipliers(result: Any, ax: Axes | None = None) -> Axes:
    """Angles of the Floquet multipliers on the unit circle against H.

    Moduli of those off it are crosses on a second axis.

    result : what `family(..., multipliers=True)` gave; dimensionless, angles in radians. Ours.
    ax : axes of matplotlib; default new ones.

    Changes of stability are lines; the pair at 1 is left out. Returns the axes. Raises
    InputError where no member has multipliers.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, family
    >>> found = family(Chain(6, beta=1), (5,), "0.05", from_energy="0.03", multipliers=True)
    >>> family_multipliers(found, Figure().add_subplot()).get_xscale()
    'log'
    """
    found = require(result, Family, A_FAMILY, ADVICE)
    known = [m for m in found.members if m.multipliers is not None]
    if not known:
        advice = "call family(..., multipliers=True), of one seed"
        raise InputError("result", "without", "a family with multipliers", advice)
    with axes_for(ax, _subject(found)) as axes:
        for m in known:
            angles = np.abs(np.angle(_firsts(m, on_circle=True)))
            same = np.full(len(angles), m.energy)
            axes.plot(same, angles, ".", color="C0", ms=3)
        _mark_events(axes, found.events, "stability")
        axes.set_xscale("log")
        axes.set_ylim(0, 1.02 * np.pi)
        parts = ("0", r"$\pi/4$", r"$\pi/2$", r"$3\pi/4$", r"$\pi$")
        axes.set_yticks(np.pi / 4 * np.arange(5), parts)
        axes.set_xlabel("$H$")
        axes.set_ylabel(r"$|\arg \lambda|$, $|\lambda| = 1$")
        _moduli_beside(axes, known)
        legend(axes)
    return axes


def _moduli_beside(axes: Axes, members: Iterable[Member]) -> None:
    """Moduli of the multipliers off the circle, on a second axis, if there are any."""
    off = []
    for m in members:
        off += [(m.energy, float(abs(x))) for x in _firsts(m, on_circle=False)]
    if not off:
        return
    right = axes.twinx()
    right.plot(*zip(*off, strict=True), "x", color=MARK, ms=5)
    right.set_ylim(bottom=1)
    right.grid(visible=False)
    right.set_ylabel(r"$|\lambda|$ of those off the circle", color=MARK)
    right.tick_params(axis="y", colors=MARK)


def _firsts(m: Member, *, on_circle: bool) -> Any:
    """The first of each pair of a member that is on the unit circle, or off it."""
    assert m.multipliers is not None
    kinds = m.multipliers.kinds
    places = [
        i for i, k in enumerate(kinds) if k != TRIVIAL and (k == ELLIPTIC) == on_circle
    ]
    return m.multipliers.pairs[places, 0]


def family_spectra(result: Any, ax: Axes | None = None) -> Axes:
    """Average spectra of some members from the first to the last, normalised.

    result : what `family` gave; dimensionless (Eq. harmonicene). ax : axes of matplotlib; default
        new ones. Modes at or below the floor of their member, as in `spectrum`, are rounding, and
        not drawn. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, family
    >>> found = family(Chain(N=8, alpha="0.3"), (1,), "0.001", from_energy="0.0005")
    >>> family_spectra(found, Figure().add_subplot()).get_yscale()
    'log'
    """
    found = require(result, Family, A_FAMILY, ADVICE)
    last = len(found.members) - 1
    places = np.linspace(0, last, SPECTRA_SHOWN).round().astype(int)
    with axes_for(ax, _subject(found)) as axes:
        for i, k in enumerate(np.unique(places)):
            m = found.members[k]
            drawn = spectrum_of_torus(m.torus)
            known = drawn.energies > drawn.floor
            modes, shares = np.array(drawn.modes)[known], drawn.energies[known]
            label = f"$H$ = {m.energy:.2g}"
            axes.plot(modes, shares / drawn.energies.sum(), label=label, **look(i))
        axes.set_yscale("log")
        whole_numbers(axes.xaxis)
        axes.set_xlabel("$q$")
        axes.set_ylabel(r"$\overline{E}_q \,/\, \sum \overline{E}_q$")
        legend(axes)
    return axes


def _subject(found: Family) -> str:
    """Chain, seeds, and the energies from one end to the other."""
    energies = _energies(found)
    span = f"H={energies.min():.6g} .. {energies.max():.6g}"
    return f"{subject(found.chain, found.seeds)}, {span}"


def _energies(found: Family) -> Floats:
    return np.array([m.energy for m in found.members])


def _look(i: int, found: Family) -> dict[str, Any]:
    style = look(i)
    style["ms"] = 3.5
    if len(found.members) > MANY_MEMBERS:
        style["marker"] = None
    return style


def _cross_doubtful(axes: Axes, found: Family, x: Floats, y: Floats) -> None:
    """Crosses over members that are doubtful."""
    doubtful = np.array([bool(m.warnings) for m in found.members])
    if doubtful.any():
        earlier = axes.get_legend_handles_labels()[1]
        label = None if "doubtful" in earlier else "doubtful"
        axes.plot(x[doubtful], y[doubtful], "x", color=MARK, ms=7, label=label)


def _mark_events(
    axes: Axes, events: Iterable[Event], kind: str, *, vertical: bool = True
) -> int:
    """A line for each event of a kind, one of them in the legend; how many there are."""
    marked = [event for event in events if event.kind == kind]
    words, style = EVENT_LOOKS[kind]
    line = axes.axvline if vertical else axes.axhline
    named: set[str] = set()
    for event in marked:
        name = words if kind != "fold" else f"{words} of {_symbol(event.what)}"
        line(event.energy, zorder=0, label=None if name in named else name, **style)
        named.add(name)
    return len(marked)


def _symbol(what: str) -> str:
    """omega_2 as the paper writes it."""
    letter, _, index = what.partition("_")
    letter = rf"\{letter}" if letter == "omega" else letter
    return f"${letter}_{{{index}}}$" if index else f"${letter}$"


def _tick_resonances(axes: Axes, events: Iterable[Event]) -> None:
    energies = [event.energy for event in events if event.kind == "resonance"]
    if energies:
        at_bottom = np.zeros(len(energies))
        style = {"transform": axes.get_xaxis_transform(), "clip_on": False, "zorder": 3}
        marks = {"marker": "|", "ls": "none", "color": "C3", "ms": 12}
        axes.plot(energies, at_bottom, label="resonance", **marks, **style)
