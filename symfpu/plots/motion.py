"""Motion: modes in time, the chain in space and time, and as an animation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.plots.legends import legend
from symfpu.plots.style import (
    EPS,
    QUIET,
    Axes,
    Floats,
    axes_for,
    chosen_modes,
    even,
    look,
    of_solution,
    rounding_below,
    subject,
)
from symfpu.tori.torus import Torus

PERIODS = 6  # of the slowest seed, that are shown where nothing is said
SAMPLES = 1200  # times in them
FRAMES = 120  # of an animation
MODES_SHOWN = 4
DEEPEST = 1e-12  # of the least mean energy, down to which the axis goes
QUANTITIES = ("Q", "E")
ADVICE = "pass a torus, a breather, or one orbit of integrate"


class Motion(NamedTuple):
    """Times (T,) and mode coordinates and energies then, (T, N-1); of rings real parts of Q."""

    chain: Chain
    times: Floats
    Q: Any
    energies: Floats
    rounding: float


def time_series(
    result: Any,
    ax: Axes | None = None,
    *,
    modes: Sequence[int] | None = None,
    quantity: str = "Q",
    times: ArrayLike | None = None,
) -> Axes:
    """Mode coordinates Q_q(t), or harmonic energies E_q(t) on a logarithmic axis, in time.

    result : a torus or breather, or an orbit of `integrate`, which has times of its own; on a
        ring Re Q_q. All quantities are dimensionless.
    ax : axes of matplotlib; default new ones.
    modes : q of the curves; default the four of the largest average energy.
    quantity : "Q" (Eq. lintra) or "E" (Eq. harmonicene).
    times : (T,), of a torus or breather; default six periods of the slowest seed.

    Samples that are not evenly spaced get a logarithmic axis of time. Energies below EPS^2 of
    their sum are shaded: in doubles they are rounding. Returns the axes. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=8, alpha="0.33"), (1,), energy="5e-5")
    >>> ax = time_series(breather, Figure().add_subplot(), modes=(1, 2))
    >>> len(ax.get_lines())
    2
    """
    if quantity not in QUANTITIES:
        raise InputError("quantity", quantity, '"Q" or "E"', "choose one of them")
    motion = _motion(result, times)
    listed = _listed(motion, modes)
    energies = quantity == "E"
    values = motion.energies if energies else np.real(motion.Q)
    columns = [motion.chain.mode_numbers.index(q) for q in listed]
    late = slice(None) if even(motion.times) else motion.times > 0
    with axes_for(ax, _subject(result)) as axes:
        for i, (q, column) in enumerate(zip(listed, columns, strict=True)):
            style = look(i) | {"marker": None}
            shown = values[late, column]
            axes.plot(motion.times[late], shown, label=f"$q = {q}$", lw=1.1, **style)
        if not even(motion.times):
            axes.set_xscale("log")
        axes.set_xlabel("$t$")
        letter = r"\mathrm{Re}\, Q" if motion.chain.periodic else "Q"
        axes.set_ylabel("$E_q$" if energies else f"${letter}_q$")
        if energies:
            _scale_energies(axes, values[late][:, columns], motion.rounding)
        legend(axes, most=0)
    return axes


def _scale_energies(axes: Axes, shown: Floats, rounding: float) -> None:
    """A logarithmic axis down to the least of the means, a little below, and the rounding."""
    axes.set_yscale("log")
    least = float(np.min(shown.mean(axis=0), initial=np.inf))
    if least > 0:
        bottom = max(DEEPEST * least, shown[shown > 0].min())
        axes.set_ylim(bottom / 2, None)
    rounding_below(axes, rounding)


def space_time(
    result: Any, ax: Axes | None = None, *, times: ArrayLike | None = None
) -> Axes:
    """The displacements x_j(t) of all particles as colours: j to the right, time upwards.

    result : a torus or breather, or an orbit of `integrate` sampled at even times. All
        quantities are dimensionless; x_j of Eq. lintra, the fixed ends included.
    ax : axes of matplotlib; default new ones. times : (T,), of a torus or breather; default six
        periods of the slowest seed.

    White is rest, blue and red are of one size on both sides. Returns the axes, which have a
    scale of colours beside them. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=8, alpha="0.33"), (1,), energy="5e-5")
    >>> space_time(breather, Figure().add_subplot(), times=range(40)).get_xlabel()
    '$j$'
    """
    motion = _motion(result, times)
    _require_even(motion.times)
    x = displacements(motion)
    j = _sites(motion.chain)
    largest = float(np.abs(x).max()) or 1.0
    with axes_for(ax, _subject(result)) as axes:
        colours = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}
        mesh = axes.pcolormesh(
            j, motion.times, x, shading="nearest", rasterized=True, **colours
        )
        axes.grid(visible=False)
        axes.set_xlabel("$j$")
        axes.set_ylabel("$t$")
        axes.figure.colorbar(mesh, ax=axes, label="$x_j$")
    return axes


def animation(
    result: Any,
    ax: Axes | None = None,
    *,
    times: ArrayLike | None = None,
    interval: float = 40.0,
) -> Any:
    """The moving chain: x_j(t) against j, drawn across, as an animation of matplotlib.

    result, times : as in `space_time`, a frame for each time; default 120 of one period of the
        slowest seed. Dimensionless. ax : axes of matplotlib; default new ones.
    interval : between frames, in milliseconds.

    Returns matplotlib's FuncAnimation: `.save("chain.gif")` writes it, `.to_jshtml()` is for
    notebooks. Keep it in a variable: it ends with the last reference. Ours. Raises InputError.

    >>> import symfpu
    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain
    >>> breather = symfpu.torus(Chain(N=8, alpha="0.33"), (1,), energy="5e-5")
    >>> moving = animation(breather, Figure().add_subplot(), times=range(2))
    >>> moving.to_jshtml().count("data:image/png")
    2
    """
    from matplotlib.animation import FuncAnimation

    motion = _motion(result, times, periods=1, samples=FRAMES)
    _require_even(motion.times)
    x = displacements(motion)
    largest = float(np.abs(x).max()) or 1.0
    with axes_for(ax, _subject(result)) as axes:
        (line,) = axes.plot(_sites(motion.chain), x[0], marker="o", ms=4)
        axes.axhline(0, color=QUIET, lw=0.6, zorder=0)
        axes.set_ylim(-1.1 * largest, 1.1 * largest)
        axes.set_xlabel("$j$")
        axes.set_ylabel("$x_j$")
        clock = axes.text(0.02, 0.95, "", transform=axes.transAxes, va="top")

        def frame(k: int) -> tuple[Any, ...]:
            line.set_ydata(x[k])
            clock.set_text(f"$t$ = {motion.times[k]:.4g}")
            return line, clock

        frame(0)
        return FuncAnimation(axes.figure, frame, frames=len(x), interval=interval)


def _subject(result: Any) -> str:
    """An orbit has no seeds."""
    if isinstance(result, Orbit):
        return subject(result.chain, (), float(result.energies[0]))
    return of_solution(result)


def displacements(motion: Motion) -> Floats:
    """x_j at the times, (T, N+1) with both fixed ends, (T, N) on a ring."""
    x = np.asarray(motion.chain.positions(motion.Q), dtype=float)
    return x if motion.chain.periodic else np.pad(x, ((0, 0), (1, 1)))


def _sites(chain: Chain) -> Floats:
    return np.arange(chain.N if chain.periodic else chain.N + 1, dtype=float)


def _motion(
    result: Any, times: ArrayLike | None, *, periods: int = PERIODS, samples: int = SAMPLES
) -> Motion:
    if isinstance(result, Orbit):
        return _motion_of_orbit(result, times)
    if not isinstance(result, Torus):
        given = type(result).__name__
        raise InputError("result", given, "a torus, a breather or an orbit", ADVICE)
    if times is None:
        slowest = min(abs(float(w)) for w in result.frequencies)
        chosen = np.linspace(0, periods * 2 * np.pi / slowest, samples)
    else:
        chosen = DOUBLES.array(times)
    if chosen.ndim != 1 or len(chosen) < 2:
        raise InputError("times", np.shape(chosen), "shape (T,), T > 1", "pass times")
    Q: Any = result.Q(chosen).astype(result.chain.kind_of_ends.mode_type)
    energies = np.asarray(result.harmonic_energies(chosen), dtype=float)
    return _with_rounding(result.chain, chosen, Q, energies)


def _motion_of_orbit(orbit: Orbit, times: ArrayLike | None) -> Motion:
    if times is not None:
        allowed = "None for an orbit, which has its own"
        raise InputError("times", "given", allowed, "integrate(..., samples=times)")
    if orbit.Q.ndim > 2:
        given = f"{orbit.Q.shape[1:-1]} orbits"
        raise InputError("result", given, "one orbit", "integrate them one by one")
    found = _with_rounding(orbit.chain, orbit.times, orbit.Q, orbit.harmonic_energies())
    return found._replace(rounding=0.0) if orbit.scheme.in_modes else found


def _with_rounding(chain: Chain, times: Floats, Q: Any, energies: Floats) -> Motion:
    rounding = EPS**2 * float(energies.sum(axis=1).max())
    return Motion(chain, times, Q, energies, rounding)


def _listed(motion: Motion, modes: Sequence[int] | None) -> list[int]:
    """The modes that are asked for, or those of the largest energies, ascending."""
    if modes is not None:
        return chosen_modes(motion.chain, modes)
    by_energy = np.argsort(-motion.energies.mean(axis=0), kind="stable")[:MODES_SHOWN]
    return sorted(motion.chain.mode_numbers[place] for place in by_energy)


def _require_even(times: Floats) -> None:
    if not even(times):
        allowed = "times that are evenly spaced"
        advice = "take np.linspace(0, T, 400), for an orbit integrate(..., samples=...)"
        raise InputError("times", "of growing distances", allowed, advice)
