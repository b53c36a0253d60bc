"""Series: where they lose, by order and harmonic, by divisor, by amplitude, by residual."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.typed import integer
from symfpu.plots.legends import legend
from symfpu.plots.style import (
    EPS,
    MARK,
    QUIET,
    Axes,
    Floats,
    axes_for,
    look,
    of_solution,
    require,
    rounding_below,
    subject,
    whole_numbers,
)
from symfpu.refinement.newton import Newton
from symfpu.series.series import LindstedtSeries
from symfpu.tori.amplitudes import AmplitudeHistory, frequency_orders
from symfpu.tori.from_series import FromSeries, require_series_torus
from symfpu.tori.torus import Torus, comes_from
from symfpu.tori.verdict import Assessment

DOUBLES_FLOOR = 16 * EPS  # of a relative residual in doubles
LEAST_DECADES = 20.0  # below the largest coefficient, down to which colours go at most


def coefficients(result: Any, ax: Axes | None = None, *, mode: int | None = None) -> Axes:
    """The largest coefficient of every order and length of the harmonic: where a series loses.

    result : a torus solved from a series. ax : axes of matplotlib; default new ones.
    mode : q of the coordinate; default the largest of all modes.

    Colours are log10 of Omega_q |c|, c the sum of the monomials of one harmonic nu in
    mu^k Q_q^(k) (Eq. serabs3), dimensionless; |nu| is the sum of the moduli, up to the degree of
    the order. White is what the selection rules forbid, or twenty decades below; a ring marks the
    largest of each order. A series converges where rings fade to the right. Returns the axes,
    with a scale of colours. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> torus = solve_amplitudes(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 6))
    >>> coefficients(torus, Figure().add_subplot()).get_xlabel()
    'order $k$'
    """
    torus = require_series_torus(result, "result")
    column = None if mode is None else _column(torus, mode)
    table = _largest(torus, column)
    if not np.isfinite(table).any():
        allowed = "a mode that the series excites up to its order"
        raise InputError("mode", mode, allowed, "choose another, or a higher order")
    top = np.nanmax(table)
    with axes_for(ax, of_solution(torus)) as axes:
        colours = {"cmap": "viridis", "vmin": max(np.nanmin(table), top - LEAST_DECADES)}
        table[table < top - LEAST_DECADES] = np.nan
        orders, lengths = np.arange(table.shape[1]), np.arange(table.shape[0])
        mesh = axes.pcolormesh(orders, lengths, table, shading="nearest", **colours)
        known = np.isfinite(table).any(axis=0)
        largest = np.nanargmax(table[:, known], axis=0)
        ring = {
            "marker": "o",
            "ls": "none",
            "mfc": "none",
            "mec": MARK,
            "ms": 5,
            "mew": 1.4,
        }
        axes.plot(orders[known], largest, label="largest of the order", **ring)
        axes.grid(visible=False)
        whole_numbers(axes.xaxis)
        whole_numbers(axes.yaxis)
        axes.set_xlabel("order $k$")
        axes.set_ylabel(r"$|\nu| = \sum_i |\nu_i|$")
        what = r"\max_q" if column is None else ""
        index = "q" if column is None else str(mode)
        name = rf"$\log_{{10}}\, {what}\, \Omega_{{{index}}} |c_{{{index}}}^{{(k)}}[\nu]|$"
        axes.figure.colorbar(mesh, ax=axes, label=name)
        legend(axes, first="upper left")
    return axes


def _column(torus: Torus[FromSeries], mode: int) -> int:
    q = integer(mode, "mode", 1)
    if q >= torus.chain.N:
        raise InputError("mode", mode, f"1 .. {torus.chain.N - 1}", "choose one of them")
    return q - 1


def _largest(torus: Torus[FromSeries], column: int | None) -> Floats:
    """log10 of the largest coefficients by |nu| and order, (lengths, orders), nan where none."""
    linear = torus.chain.frequencies()
    amplitudes = [torus.amplitudes[q] for q in torus.seeds]
    longest = torus.origin.series.degree(torus.origin.order)
    table = np.zeros((longest + 1, torus.origin.order + 1))
    for k in range(torus.origin.order + 1):
        nu, values = torus.origin.series.harmonic_terms(amplitudes, k)
        sizes = np.abs(values).astype(float) * linear
        row = sizes.max(axis=1) if column is None else sizes[:, column]
        lengths = np.abs(nu).sum(axis=1)
        np.maximum.at(table[:, k], lengths, row)
    table[table == 0] = np.nan
    return np.asarray(np.log10(table))


class _Divisor(NamedTuple):
    size: float
    mode: int
    harmonic: tuple[int, ...]
    note: str


def small_divisors(result: Any, ax: Axes | None = None) -> Axes:
    """The smallest divisors |lambda_q - (nu.omega)^2|, with mode q, harmonic nu and order.

    result : a series or the torus solved from it, or a torus of Newton's method, whose divisors
        (nu.omega)^2 - Omega_q^2 stand beside the coefficients under them. ax : axes of matplotlib;
        default new ones. Dimensionless; those of Eq. Lm, over Omega_q^2.

    Returns the axes. Raises InputError for what has no divisors: series in universal form and
    residues.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, lindstedt
    >>> series = lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 6)
    >>> small_divisors(series, Figure().add_subplot()).get_xscale()
    'log'
    """
    found = _divisors(result)
    if not found:
        allowed = "a series with chosen frequencies and divisors"
        advice = "give frequencies= to lindstedt, and an order above 0"
        raise InputError("result", "without divisors", allowed, advice)
    with axes_for(ax, _subject(result)) as axes:
        places = np.arange(len(found))
        axes.plot([d.size for d in found], places, "o", color="C0")
        for place, d in zip(places, found, strict=True):
            axes.annotate(
                d.note,
                (d.size, place),
                xytext=(8, 0),
                textcoords="offset points",
                va="center",
                color=QUIET,
                fontsize="small",
            )
        axes.set_yticks(places, [_place(d) for d in found])
        axes.set_xscale("log")
        axes.invert_yaxis()
        _leave_room(axes, [d.size for d in found])
        axes.set_xlabel(r"$|\lambda_q - (\nu\cdot\omega)^2|$")
    return axes


def _subject(result: Any) -> str:
    """A series has no energy."""
    if isinstance(result, LindstedtSeries):
        return subject(result.chain, result.seeds)
    return of_solution(result)


def _leave_room(axes: Axes, sizes: list[float]) -> None:
    """Of a logarithmic axis, more on the right side than on the left."""
    decades = np.log10(sizes)
    width = max(float(np.ptp(decades)), 0.5)
    left, right = decades.min() - 0.08 * width, decades.max() + 0.45 * width
    axes.set_xlim(10**left, 10**right)


def _of_coefficient(coefficient: float, rounding: float) -> str:
    """Its size; what is rounding alone is no size."""
    if abs(coefficient) < rounding:
        return "$c$ below rounding"
    return f"$c$ = {_minus(f'{coefficient:.1e}')}"


def _divisors(result: Any) -> list[_Divisor]:
    if comes_from(result, Newton):
        near = result.origin.near_resonances
        rounding = EPS * max(abs(float(A)) for A in result.amplitudes.values())
        notes = [_of_coefficient(float(r.coefficient), rounding) for r in near]
        pairs = zip(near, notes, strict=True)
        return [_Divisor(abs(r.divisor), r.mode, r.harmonic, note) for r, note in pairs]
    series = result.origin.series if comes_from(result, FromSeries) else result
    allowed = "a series, or a torus of a series or of Newton's method"
    checked = require(series, LindstedtSeries, allowed, "pass what lindstedt gave")
    smallest = checked.smallest_divisors
    return [_Divisor(d.size, d.mode, d.harmonic, f"$k$ = {d.order}") for d in smallest]


def _place(divisor: _Divisor) -> str:
    harmonic = ", ".join(_minus(str(n)) for n in divisor.harmonic)
    return rf"$q$ = {_minus(str(divisor.mode))}, $\nu$ = ({harmonic})"


def _minus(number: str) -> str:
    return number.replace("-", "\N{MINUS SIGN}")


def amplitudes(result: Any, ax: Axes | None = None) -> Axes:
    """How amplitudes settle with the frequency order: Delta A_q(K) = |A_q(K + step) - A_q(K)|.

    As in Fig. 1(b); the last amplitudes are in the legend. Dimensionless.

    result : what `amplitude_history` or `assess` gave, or a torus solved from a series.
    ax : axes of matplotlib; default new ones.

    Orders without a real root are shaded; differences below the spacing of doubles at A_q are
    rounding. Returns the axes. Raises InputError, also where fewer than two orders have a root.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, amplitude_history, lindstedt
    >>> history = amplitude_history(lindstedt(Chain(8, alpha="0.3"), (1,), ("0.3905",), 6))
    >>> amplitudes(history, Figure().add_subplot()).get_yscale()
    'log'
    """
    known, differences, failed, seeds = _history(result)
    of = subject(result.chain or "", seeds)
    if not differences:
        allowed = "two neighbouring orders with a root"
        raise InputError("result", "fewer", allowed, "compute a longer series")
    last = known[max(known)]
    with axes_for(ax, of) as axes:
        for i, q in enumerate(seeds):
            changes = np.array([differences[K][i] for K in differences])
            orders = np.array(list(differences))
            seen = changes > 0
            label = f"$A_{{{q}}}$ = {float(last[i]):.6g}"
            axes.plot(orders[seen], changes[seen], label=label, **look(i))
        for K in failed:
            once = "no real root" if failed[0] == K else None
            axes.axvspan(K - 0.5, K + 0.5, color="0.9", lw=0, zorder=0, label=once)
        axes.set_yscale("log")
        whole_numbers(axes.xaxis)
        axes.set_xlabel("frequency order $K$")
        axes.set_ylabel(r"$\Delta A_q(K)$")
        if all(isinstance(A, float) for A in last):
            rounding_below(axes, EPS * min(abs(float(A)) for A in last))
        legend(axes)
    return axes


def _history(
    result: Any,
) -> tuple[
    Mapping[int, tuple[Any, ...]],
    Mapping[int, tuple[float, ...]],
    list[int],
    tuple[int, ...],
]:
    """Amplitudes and their differences by order, orders without a root, and the seeds."""
    if isinstance(result, Assessment):
        return result.amplitudes, result.differences, [], tuple(result.sums)
    if comes_from(result, FromSeries):
        orders = frequency_orders(result.origin.series)
        result = AmplitudeHistory(result.seeds, orders, result.origin.history, {})
    allowed = "an AmplitudeHistory, an Assessment or a torus of a series"
    advice = "pass what amplitude_history gave"
    history = require(result, AmplitudeHistory, allowed, advice)
    return (
        history.amplitudes,
        history.differences(),
        sorted(history.failures),
        history.seeds,
    )


def residuals(result: Any, ax: Axes | None = None) -> Axes:
    """What a series cut at order k leaves of the equations of motion, and of the energy.

    result : what `assess` gave. Both are relative and dimensionless, over a grid of angles (ours;
        the paper judges by the sums of Eqs. serabs2, serabs3). ax : axes of matplotlib; default
        new ones.

    The ring marks the best order; a dashed line is the torus of Pade sums. In doubles what is
    below some 1e-15 is rounding. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import Chain, assess, lindstedt, solve_amplitudes
    >>> series = lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3903",), 8)
    >>> residuals(assess(series, solve_amplitudes(series)), Figure().add_subplot()).get_xlabel()
    'order $k$'
    """
    found = require(result, Assessment, "an Assessment", "pass what assess gave")
    orders = np.arange(len(found.residuals))
    best = found.best_order
    with axes_for(ax, subject(found.chain or "", tuple(found.sums))) as axes:
        curves = {"equations of motion": found.residuals, "energy": found.energy_errors}
        for i, (name, values) in enumerate(curves.items()):
            seen = np.isfinite(values) & (values > 0)
            axes.plot(orders[seen], values[seen], label=name, **look(i))
        ring = {"marker": "o", "ms": 12, "mfc": "none", "mec": MARK, "ls": "none"}
        label = f"best order, $k = {best}$"
        axes.plot([best], [found.residuals[best]], label=label, **ring)
        if np.isfinite(found.resummed_residual):
            style = {"color": QUIET, "ls": "--", "label": "resummed"}
            axes.axhline(found.resummed_residual, **style)
        axes.set_yscale("log")
        whole_numbers(axes.xaxis)
        axes.set_xlabel("order $k$")
        axes.set_ylabel("relative residual")
        if found.certificate is None:  # of doubles
            rounding_below(axes, DOUBLES_FLOOR)
        legend(axes)
    return axes
