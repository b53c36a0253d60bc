"""Tori in phase space: sections, and in three dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.typed import integer
from symfpu.plots.legends import legend
from symfpu.plots.style import Axes, Floats, axes_for, chosen_modes, look, of_solution
from symfpu.tori.torus import Torus

POINTS = 2000  # of a section
ORBITS = 48  # that rule a torus of two angles
AROUND = 120  # steps of each of them, even: faces of a surface take two
LEAST_SPAN = 0.1  # of the amplitudes, that the axes of a section have at least
TURNS = 60  # of an orbit on a torus of more angles
SOLUTION = "a solution: a torus or a breather"
ADVICE = "pass what torus, solve_amplitudes or refine gave"


def section(
    result: Any,
    ax: Axes | None = None,
    *,
    modes: Sequence[int] | None = None,
    seed: int | None = None,
    points: int = POINTS,
) -> Axes:
    """A section of a torus: its orbit once a period of a seed, in the planes (Q_q, P_q).

    result : a torus or breather. Q_q and P_q are dimensionless (Eq. lintra); on a ring they are
        complex, and their real parts are drawn.
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
    Q, P = _phase_space(torus, 2 * np.pi / omega * np.arange(number))
    columns = _columns(torus.chain, listed)
    real = _real_part(torus.chain)
    with axes_for(ax, of_solution(torus)) as axes:
        for i, (q, column) in enumerate(zip(listed, columns, strict=True)):
            colour = look(i)["color"]
            size = 1.5 if len(torus.seeds) > 1 else 7
            style = {"marker": "o", "ls": "none", "ms": size, "mew": 0, "color": colour}
            axes.plot(Q[:, column], P[:, column], label=f"$q = {q}$", **style)
        axes.set_xlabel(f"${real}Q_q$")
        axes.set_ylabel(f"${real}P_q$")
        axes.set_title(rf"once a period $2\pi/\omega_{{{beat}}}$")
        _wide_enough(axes, torus.chain.frequencies()[columns])
        legend(axes)
        _large_marks(axes)
    return axes


def _solution(result: Any) -> Torus:
    if isinstance(result, Torus):
        return result
    raise InputError("result", type(result).__name__, SOLUTION, ADVICE)


def _phase_space(found: Torus, times: Any) -> tuple[Floats, Floats]:
    """Q and P at times, (T, N-1) each, in doubles; of a ring their real parts."""
    doubles = found.in_doubles()
    return doubles.Q(times).real, doubles.P(times).real


def _columns(chain: Chain, modes: Sequence[int]) -> list[int]:
    """Where modes stand in arrays of all of them."""
    return [chain.mode_numbers.index(q) for q in modes]


def _real_part(chain: Chain) -> str:
    """What stands before the letter of a coordinate."""
    return r"\mathrm{Re}\, " if chain.periodic else ""


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

    result : a torus or breather. ax : axes of three dimensions; default new ones. Dimensionless;
        on a ring real parts.
    modes : a, b, c; or two, a and b, for (Q_a, P_a, Q_b). Default the first seed and the second,
        or the mode of the largest energy that is no seed; on a ring of another |q|.

    A torus of two angles is a surface ruled by orbits, a breather a closed curve; of one of more
    angles an orbit of sixty turns is seen. Returns the axes. Raises InputError. Ours.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=8, alpha="0.33"), (1,), energy="5e-5")
    >>> ax = Figure().add_subplot(projection="3d")
    >>> torus(breather, ax, modes=(1, 2, 3)).get_zlabel()
    '$Q_{3}$'
    """
    found = _solution(result)
    listed = _modes(found, modes)
    Q, P = _surface(found)
    columns, real = _columns(found.chain, listed), _real_part(found.chain)
    names = [f"${real}Q_{{{q}}}$" for q in listed]
    parts = [Q[..., column] for column in columns]
    if len(listed) == 2:
        names.insert(1, f"${real}P_{{{listed[0]}}}$")
        parts.insert(1, P[..., columns[0]])
    with axes_for(ax, of_solution(found), projection="3d") as axes:
        _draw(axes, parts, angles=len(found.seeds))
        axes.set_xlabel(names[0], labelpad=7)
        axes.set_ylabel(names[1], labelpad=7)
        axes.set_zlabel(names[2], labelpad=7)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(_few_ticks())
        axes.ticklabel_format(style="sci", scilimits=(-2, 3))
        axes.set_box_aspect(None, zoom=0.85)
    return axes


def _few_ticks() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(3)


def _modes(found: Torus, modes: Sequence[int] | None) -> list[int]:
    """Two modes or three; InputError for other numbers, and for a chain of one mode."""
    numbers = found.chain.mode_numbers
    if len(set(map(abs, numbers))) < 2:  # q and -q of a ring have one real part
        allowed = "a chain of two modes or more"
        raise InputError("result", found.chain, allowed, "draw its section instead")
    if modes is not None:
        listed = chosen_modes(found.chain, modes)
        if len(listed) not in (2, 3):
            raise InputError("modes", tuple(modes), "two modes or three", "choose so many")
        return listed
    first = found.seeds[0]
    second = [q for q in found.seeds if abs(q) != abs(first)]
    if second:
        return [first, second[0]]
    energies = np.asarray(found.average_spectrum(), dtype=float)
    energies[[abs(q) == abs(first) for q in numbers]] = -1
    return [first, numbers[int(np.argmax(energies))]]


def _surface(found: Torus) -> tuple[Floats, Floats]:
    """Q and P on the torus, (orbits, points, N-1).

    Of two angles orbits of one turn of the first, from equally spaced phases of the second.
    """
    turn = 2 * np.pi / float(found.frequencies[0])
    if len(found.seeds) > 2:
        return _one_orbit(found, np.linspace(0, TURNS * turn, TURNS * AROUND))
    times = np.linspace(0, turn, AROUND + 1)
    if len(found.seeds) == 1:
        return _one_orbit(found, times)
    plain = found.in_doubles()
    second = found.seeds[1]
    orbits = []
    for phase in np.linspace(0, 2 * np.pi, ORBITS + 1):
        phases = {**plain.phases, second: plain.phases[second] + phase}
        orbits.append(_phase_space(replace(plain, phases=phases), times))
    Q, P = zip(*orbits, strict=True)
    return np.array(Q), np.array(P)


def _one_orbit(found: Torus, times: Floats) -> tuple[Floats, Floats]:
    Q, P = _phase_space(found, times)
    return Q[None], P[None]


def _draw(axes: Axes, parts: Sequence[Floats], *, angles: int) -> None:
    if angles == 2:
        style = {"alpha": 0.2, "color": "C0", "linewidth": 0}
        axes.plot_surface(*parts, rstride=1, cstride=2, **style)
        axes.plot_wireframe(*parts, rstride=4, cstride=0, color="C0", lw=0.45)
        return
    width = 1.6 if angles == 1 else 0.4
    axes.plot(*(part[0] for part in parts), lw=width)
