"""Tori in phase space: sections, and in three dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.typed import integer
from symfpu.plots.style import Axes, Floats, axes_for, chosen_modes, legend, look
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic

POINTS = 2000  # of a section
ORBITS = 48  # that rule a torus of two angles
AROUND = 120  # points of each of them
LEAST_SPAN = 0.1  # of the amplitudes, that the axes of a section have at least
TURNS = 60  # of an orbit on a torus of more angles
SOLUTION = "a solution: a torus or a breather"
ADVICE = "pass what solve_amplitudes, refine or periodic_orbit gave"


def section(
    result: Any,
    ax: Axes | None = None,
    *,
    modes: Sequence[int] | None = None,
    seed: int | None = None,
    points: int = POINTS,
) -> Axes:
    """A section of a torus: its orbit once a period of a seed, in the planes (Q_q, P_q).

    result : a torus or breather. Q_q and P_q are dimensionless (Eq. lintra).
    ax : axes of matplotlib; default new ones. modes : q of the planes, each in its colour;
        default the other seeds, or the seed itself where there is no other.
    seed : whose period 2 pi / omega it is; default the first. points : how many periods.

    A torus of two angles shows closed curves, one of more fills regions, a breather is a point of
    each plane. Returns the axes. Raises InputError. Ours.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1, 2), ("0.3905", "0.7663"), 4))
    >>> section(torus, Figure().add_subplot(), points=50).get_xlabel()
    '$Q_q$'
    """
    torus = _solution(result)
    beat = torus.seeds[0] if seed is None else integer(seed, "seed", 1)
    if beat not in torus.seeds:
        raise InputError("seed", seed, f"one of the seeds {torus.seeds}", "choose one")
    others = [q for q in torus.seeds if q != beat] or [beat]
    listed = others if modes is None else chosen_modes(torus.chain, modes)
    number = integer(points, "points", 1)
    omega = float(torus.frequencies[torus.seeds.index(beat)])
    doubles = torus.in_doubles()
    times = 2 * np.pi / omega * np.arange(number)
    Q, P = doubles.positions(times), doubles.momenta(times)
    with axes_for(ax) as axes:
        for i, q in enumerate(listed):
            colour = look(i)["color"]
            size = 1.5 if len(torus.seeds) > 1 else 7
            style = {"marker": "o", "ls": "none", "ms": size, "mew": 0, "color": colour}
            axes.plot(Q[:, q - 1], P[:, q - 1], label=f"$q = {q}$", **style)
        axes.set_xlabel("$Q_q$")
        axes.set_ylabel("$P_q$")
        axes.set_title(rf"once a period $2\pi/\omega_{{{beat}}}$")
        _wide_enough(axes, torus.chain.frequencies()[np.array(listed) - 1])
        legend(axes)
        _large_marks(axes)
    return axes


def _solution(result: Any) -> QuasiPeriodic:
    if isinstance(result, QuasiPeriodic):
        return result
    raise InputError("result", type(result).__name__, SOLUTION, ADVICE)


def _wide_enough(axes: Axes, linear: Floats) -> None:
    """Room around the points; points of a breather are not drawn apart by their rounding."""
    axes.margins(0.12)
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    size = max(abs(left), abs(right))
    width = max(right - left, LEAST_SPAN * size)
    height = max(top - bottom, LEAST_SPAN * size * float(linear.max()))
    x, y = (left + right) / 2, (bottom + top) / 2
    axes.set_xlim(x - width / 2, x + width / 2)
    axes.set_ylim(y - height / 2, y + height / 2)


def _large_marks(axes: Axes) -> None:
    """Points of a legend that can be seen."""
    for handle in axes.get_legend().legend_handles:
        handle.set_markersize(6)


def torus(
    result: Any, ax: Axes | None = None, *, modes: Sequence[int] | None = None
) -> Axes:
    """A torus in three dimensions, by the coordinates (Q_a, Q_b, Q_c) of three modes.

    result : a torus or breather. ax : axes of three dimensions; default new ones. Dimensionless.
    modes : a, b, c; or two, a and b, for (Q_a, P_a, Q_b). Default the first seed and the second,
        or the mode of the largest energy that is no seed.

    A torus of two angles is a surface ruled by orbits, a breather a closed curve; of one of more
    angles an orbit of sixty turns is seen. Returns the axes. Raises InputError. Ours.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, breather_at_energy
    >>> breather = breather_at_energy(Chain(N=8, alpha="0.33"), 1, "5e-5")
    >>> ax = Figure().add_subplot(projection="3d")
    >>> torus(breather, ax, modes=(1, 2, 3)).get_zlabel()
    '$Q_{3}$'
    """
    found = _solution(result)
    listed = _modes(found, modes)
    Q, P = _surface(found.in_doubles())
    names = [f"$Q_{{{q}}}$" for q in listed]
    parts = [Q[..., q - 1] for q in listed]
    if len(listed) == 2:
        names.insert(1, f"$P_{{{listed[0]}}}$")
        parts.insert(1, P[..., listed[0] - 1])
    with axes_for(ax, "3d") as axes:
        _draw(axes, parts, angles=len(found.seeds))
        axes.set_xlabel(names[0], labelpad=7)
        axes.set_ylabel(names[1], labelpad=7)
        axes.set_zlabel(names[2], labelpad=7)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(_few_ticks())
        axes.set_box_aspect(None, zoom=0.85)
    return axes


def _few_ticks() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(3)


def _modes(found: QuasiPeriodic, modes: Sequence[int] | None) -> list[int]:
    """Two modes or three; InputError for other numbers, and for a chain of one mode."""
    if found.chain.N < 3:
        allowed = "a chain of two modes or more"
        raise InputError("result", found.chain, allowed, "draw its section instead")
    if modes is not None:
        listed = chosen_modes(found.chain, modes)
        if len(listed) not in (2, 3):
            raise InputError("modes", tuple(modes), "two modes or three", "choose so many")
        return listed
    if len(found.seeds) > 1:
        return list(found.seeds[:2])
    energies = np.asarray(found.average_spectrum(), dtype=float)
    energies[found.seeds[0] - 1] = -1
    return [found.seeds[0], int(np.argmax(energies)) + 1]


def _surface(found: FourierTorus) -> tuple[Floats, Floats]:
    """Q and P on the torus, (orbits, points, N-1).

    Of two angles orbits of one turn of the first, from equally spaced phases of the second.
    """
    turn = 2 * np.pi / float(found.frequencies[0])
    if len(found.seeds) > 2:
        times = np.linspace(0, TURNS * turn, TURNS * AROUND)
        return found.positions(times)[None], found.momenta(times)[None]
    times = np.linspace(0, turn, AROUND)
    if len(found.seeds) == 1:
        return found.positions(times)[None], found.momenta(times)[None]
    second = found.seeds[1]
    Q, P = [], []
    for phase in np.linspace(0, 2 * np.pi, ORBITS + 1):
        phases = {**found.phases, second: found.phases[second] + phase}
        parts = (found.chain, found.seeds, found.frequencies, found.harmonics)
        shifted = FourierTorus(*parts, found.cosines, phases)
        Q.append(shifted.positions(times))
        P.append(shifted.momenta(times))
    return np.array(Q), np.array(P)


def _draw(axes: Axes, parts: Sequence[Floats], *, angles: int) -> None:
    if angles == 2:
        style = {"alpha": 0.2, "color": "C0", "linewidth": 0}
        axes.plot_surface(*parts, rstride=1, cstride=2, **style)
        axes.plot_wireframe(*parts, rstride=4, cstride=0, color="C0", lw=0.45)
        return
    width = 1.6 if angles == 1 else 0.4
    axes.plot(*(part[0] for part in parts), lw=width)
