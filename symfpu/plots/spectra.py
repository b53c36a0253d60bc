"""Spectra: averaged energies of the modes, of one result or several, over the groups D_k."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.chain.potentials.potential import Potential
from symfpu.chain.propagation import excitation_sequence
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.localization.floors import spectrum_floor
from symfpu.numbers.typed import integer
from symfpu.plots.legends import legend
from symfpu.plots.style import (
    COLOURS,
    EPS,
    QUIET,
    SHADES,
    Axes,
    Floats,
    axes_for,
    look,
    subject,
    whole_numbers,
)
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

MOST_STRIPES = 40  # of groups that are shaded where nothing is said
NAME_WIDTH = 0.3  # inches of the name of a group above the picture
BELOW, ABOVE = (
    300.0,
    5.0,
)  # factors from the least and largest energies to the ends of the axis
WIDE_CHAIN = 64  # bonds from which markers are small


class Spectrum(NamedTuple):
    """Averaged energies of the modes q, (N-1,), what of them is rounding, and their chain."""

    chain: Chain
    seeds: tuple[int, ...]
    modes: tuple[int, ...]
    energies: Floats
    floor: Floats


def spectrum(
    results: Any,
    ax: Axes | None = None,
    *,
    groups: int | None = None,
    labels: Sequence[str] | None = None,
) -> Axes:
    """Averaged harmonic energies of the modes, normalised, on a logarithmic axis (Fig. 1(a)).

    results : a torus or breather, or an orbit integrated with averages=True, whose last averages
        are shown; or a sequence of these, of chains of one length. E_q and q are dimensionless.
    ax : axes of matplotlib; default new ones.
    groups : the last order k of the groups D_k of the first result's seeds (Eq. dk) that are
        shaded; 0 for none, default all, unless they make more than 40 stripes. Orbits have no
        seeds.
    labels : one for each result; default what they are.

    Modes at or below the `spectrum_floor` of a result are rounding and no physics: a pale
    triangle says that they are somewhere below it. Orbits of T + V have the floor EPS^2 times
    the number of kicks, whose roundings add at random, of the sum of all energies. Returns the
    axes. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=8, alpha="0.33"), (1,), energy="5e-5")
    >>> spectrum(breather, Figure().add_subplot()).get_yscale()
    'log'
    """
    listed = list(results) if isinstance(results, (list, tuple)) else [results]
    shown = [_spectrum_of(result) for result in listed]
    names = _names(listed, labels)
    _require_one_length(shown)
    last = None if groups is None else integer(groups, "groups", 0)
    with axes_for(ax, _subject(listed, shown)) as axes:
        for i, (found, name) in enumerate(zip(shown, names, strict=True)):
            _draw(axes, found, name, i)
        axes.set_yscale("log")
        axes.set_xlabel(r"$q$")
        axes.set_ylabel(r"$\overline{E}_q \,/\, \sum \overline{E}_q$")
        whole_numbers(axes.xaxis)
        _fit_height(axes, shown)
        first = shown[0]
        if last != 0 and first.seeds and not first.chain.periodic:
            _shade_groups(axes, first, last)
        if len(shown) > 1 or labels is not None:
            legend(axes)
    return axes


def _subject(results: Sequence[Any], shown: Sequence[Spectrum]) -> str:
    """What all results have in common; of one result its energy too."""
    first = shown[0]
    chain = first.chain if len({found.chain for found in shown}) == 1 else ""
    seeds = first.seeds if len({found.seeds for found in shown}) == 1 else ()
    return subject(chain, seeds, _energy(results[0]) if len(shown) == 1 else None)


def _draw(axes: Axes, found: Spectrum, name: str, i: int) -> None:
    q = np.array(found.modes)
    total = found.energies.sum()
    known = found.energies > found.floor
    below = ~known & (found.energies > 0) & np.isfinite(found.floor)
    style = look(i)
    style["ms"] = 3 if found.chain.N >= WIDE_CHAIN else 5
    if i % 2:
        style["mfc"] = "white"
    axes.plot(q[known], found.energies[known] / total, label=name, **style)
    limits = found.floor[below] / total
    colour = f"C{i % COLOURS}"
    axes.plot(q[below], limits, "v", ms=4, mfc="none", color=colour, alpha=0.4)


def _fit_height(axes: Axes, shown: Sequence[Spectrum]) -> None:
    """From below the least energy that is known to above the largest, without all the floors."""
    least = 1.0
    for found in shown:
        known = found.energies > found.floor
        if known.any():
            least = min(least, found.energies[known].min() / found.energies.sum())
    axes.set_ylim(least / BELOW, ABOVE)


def _spectrum_of(result: object) -> Spectrum:
    if isinstance(result, Torus):
        return spectrum_of_torus(result)
    if isinstance(result, Orbit):
        return _spectrum_of_orbit(result)
    allowed = "a torus, a breather or an orbit with averages, or a sequence of them"
    advice = "pass what solve_amplitudes, refine or integrate gave"
    raise InputError("results", type(result).__name__, allowed, advice)


def spectrum_of_torus(torus: Torus) -> Spectrum:
    """With what of it is rounding: of waves of a ring EPS^2 times the sum of all energies."""
    energies = np.asarray(torus.average_spectrum(), dtype=float)
    chain = torus.chain
    if chain.periodic:
        floor = np.full(len(energies), EPS**2 * energies.sum())
    else:
        floor = spectrum_floor(torus)
    return Spectrum(chain, torus.seeds, chain.mode_numbers, energies, floor)


def _spectrum_of_orbit(orbit: Orbit) -> Spectrum:
    if orbit.averages is None:
        allowed = "an orbit with time averages"
        raise InputError("results", "without", allowed, "integrate(..., averages=True)")
    if orbit.averages.ndim > 2:
        given = f"{orbit.Q.shape[1:-1]} orbits"
        raise InputError("results", given, "one orbit", "integrate them one by one")
    energies = orbit.averages[-1]
    kicks = abs(orbit.times[-1] / orbit.step) * orbit.scheme.stages
    level = 0.0 if orbit.scheme.in_modes else EPS**2 * kicks * energies.sum()
    floor = np.full(len(energies), level)
    return Spectrum(orbit.chain, (), orbit.chain.mode_numbers, energies, floor)


def _require_one_length(shown: Sequence[Spectrum]) -> None:
    if not shown:
        raise InputError("results", "none", "at least one result", "pass a torus")
    lengths = sorted({found.chain.N for found in shown})
    if len(lengths) > 1:
        allowed = "results of chains of one length"
        raise InputError("results", lengths, allowed, "draw the others in other axes")


def _names(results: Sequence[Any], labels: Sequence[str] | None) -> list[str]:
    if labels is not None:
        if isinstance(labels, str) or len(labels) != len(results):
            allowed = f"{len(results)}, one for each result"
            raise InputError("labels", labels, allowed, "pass a list of them")
        return list(labels)
    names = [_name(result) for result in results]
    if len(set(names)) == len(names):
        return names
    return [f"{n}, $H$ = {_energy(r):.3g}" for n, r in zip(names, results, strict=True)]


def _name(result: Any) -> str:
    if isinstance(result, Orbit):
        return f"orbit, $t$ = {result.times[-1]:.3g}"
    origin = result.origin
    return (
        f"series, order {origin.order}" if isinstance(origin, FromSeries) else origin.name
    )


def _energy(result: Any) -> float:
    energy = result.energies[0] if isinstance(result, Orbit) else result.energy()
    return float(energy)


def _shade_groups(axes: Axes, found: Spectrum, last: int | None) -> None:
    """Stripes for the modes of each group, with the names of some above the picture."""
    N = found.chain.N
    group = _groups(N, found.seeds, found.chain.potential, N if last is None else last)
    filled = sorted(set(group.values()))
    shade = {k: SHADES[i % 2] for i, k in enumerate(filled)}
    runs = [(k, list(run)) for k, run in groupby(range(1, N), key=group.get)]
    stripes = [(k, run[0] - 0.5, run[-1] + 0.5) for k, run in runs if k is not None]
    axes.set_xlim(0.5, N - 0.5)
    if last is None and len(stripes) > MOST_STRIPES:
        return
    inches = axes.bbox.width / axes.figure.dpi
    apart = NAME_WIDTH / inches * (N - 1)
    named = -np.inf
    place = axes.get_xaxis_transform()
    style = {"ha": "center", "va": "bottom", "color": QUIET, "fontsize": "small"}
    for k, left, right in stripes:
        _shade(axes, left, right, shade[k])
        middle = (left + right) / 2
        if middle - named >= apart:
            axes.text(middle, 1.0, f"$D_{{{k}}}$", transform=place, **style)
            named = middle


def _shade(axes: Axes, left: float, right: float, colour: str) -> None:
    """A stripe as axvspan makes it, without its search for new limits: many times quicker."""
    from matplotlib.patches import Rectangle

    place = axes.get_xaxis_transform()
    style: dict[str, Any] = {"facecolor": colour, "linewidth": 0, "zorder": 0}
    axes.add_artist(Rectangle((left, 0), right - left, 1, transform=place, **style))


@lru_cache(maxsize=64)
def _groups(
    N: int, seeds: tuple[int, ...], potential: Potential, last: int
) -> dict[int, int]:
    """The order k of the group D_k of every mode that is in one."""
    sequence = excitation_sequence(N, seeds, last, potential=potential)
    return {q: k for k, modes in enumerate(sequence) for q in modes}
