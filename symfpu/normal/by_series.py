"""Normal frequencies by their series, beside those that were found: for JSON and for readers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from symfpu.errors import ResonantDivisor
from symfpu.normal.modes import NoNormalModes, NormalMode
from symfpu.normal.phantom import NormalFrequencySeries
from symfpu.tori.torus import Torus


class BySeries(NamedTuple):
    """A normal frequency by its series, or why it has none.

    mode : what `normal_modes` found. series : solved; None with the reason. terms : Omega_q, and
    mu^k sigma^(k) of every order.
    """

    mode: NormalMode
    series: NormalFrequencySeries | None
    terms: tuple[float, ...] = ()
    reason: str = ""


def by_series(
    mode: NormalMode,
    solve: Callable[[int], NormalFrequencySeries],
    torus: Torus,
) -> BySeries:
    """One mode by series; solve : gives the series that is its own sigma, by mode."""
    try:
        series = solve(mode.mode)
    except (NoNormalModes, ResonantDivisor) as none:
        return BySeries(mode, None, reason=str(none))
    amplitudes = {q: float(a) for q, a in torus.amplitudes.items()}
    return BySeries(mode, series, tuple(map(float, series.terms(amplitudes))))


def series_records(found: Sequence[BySeries]) -> dict[str, Any]:
    """Normal frequencies by series for JSON; nothing where there are none."""
    if not found:
        return {}
    return {"series": {str(one.mode.mode): _series_record(one) for one in found}}


def _series_record(one: BySeries) -> dict[str, Any]:
    if one.series is None:
        return {"sigma": None, "reason": one.reason}
    return {
        "order": one.series.order,
        "sigma": repr(float(one.series.sigma)),
        "terms": list(map(repr, one.terms)),
        "closed_shift": _closed_shift(one.series),
    }


def series_text(found: Sequence[BySeries]) -> list[str]:
    """The same for a reader: sigma, its difference from the one found, the closed shift."""
    lines = []
    for one in found:
        name = f"sigma_{one.mode.mode}"
        if one.series is None:
            lines.append(f"  {name}: no series: {one.reason}")
            continue
        sigma = float(one.series.sigma)
        off = sigma - complex(one.mode.sigma).real
        lines.append(f"  {name} = {sigma:.13g}, off by {off:+.1e}")
        terms = ", ".join(f"{x:+.4e}" for x in one.terms[1:])
        lines.append(f"    orders 1..{one.series.order}: {terms}")
        if shift := _closed_shift(one.series):
            lines.append(f"    lowest shift: {shift}")
    return ["by series:", *lines] if lines else []


def _closed_shift(series: NormalFrequencySeries) -> str | None:
    """The lowest terms as a formula; None on a ring, which has none."""
    return None if series.chain.periodic else str(series.closed_shift())
