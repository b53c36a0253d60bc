"""A judgement of a series of travelling waves and its torus, by the measures of fixed ends."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.series.travelling import TravellingSeries
from symfpu.tori.amplitudes import (
    AmplitudeHistory,
    history_of,
    steps_of_frequencies,
)
from symfpu.tori.resummation import pade_poles
from symfpu.tori.ring_torus import RingTorus, cut_waves
from symfpu.tori.verdict import (
    FLOOR,
    Assessment,
    LargestTerm,
    growth_of,
    judged,
    pole_radius_of,
    root_uncertainty_of,
)


def assess_waves(
    series: TravellingSeries, torus: RingTorus, *, progress: Progress | None = None
) -> Assessment:
    """Judge a series of travelling waves and its torus as `assess` does, but for Pade sums.

    series : of `travelling_waves`. torus : made from it by `travelling_torus`; dimensionless.
    progress : called as (label, fraction done).

    Residuals are over all angles: two opposite waves may shift against each other. The sums S_1 and
    S_2 of a seed are those of |u| over the harmonics in its mode. Ours. Raises InputError for a
    torus of another series, or of none.

    >>> from symfpu import Chain, travelling_torus, travelling_waves
    >>> series = travelling_waves(Chain(8, beta=1, ends="periodic"), (1,), ("0.767",), 8)
    >>> assess_waves(series, travelling_torus(series)).word
    'converged'
    """
    _require_made_from(torus, series)
    assert torus.order is not None
    tell, step = progress or unheard, steps_of_frequencies(series)
    residuals, energy_errors = [], []
    for k in range(torus.order + 1):
        cut = cut_waves(series, torus, k)
        residuals.append(cut.residual())
        energy_errors.append(cut.energy_error())
        tell("verdict", (k + 1) / (torus.order + 1))
    evidence = _evidence(series, torus, history_of(series))
    measured = replace(
        evidence,
        best_order=int(np.argmin(residuals)),
        residuals=np.array(residuals),
        energy_errors=np.array(energy_errors),
    )
    return judged(measured, torus.residual(), step, FLOOR)


def _require_made_from(torus: RingTorus, series: TravellingSeries) -> None:
    same = (torus.chain, torus.seeds, torus.frequencies)
    of_series = series.chain, series.seeds, series.frequencies
    if same != of_series or torus.order is None or torus.order > series.order:
        allowed = "one made from this series"
        advice = "call travelling_torus(series)"
        raise InputError("torus", "of another series", allowed, advice)


def _evidence(
    series: TravellingSeries, torus: RingTorus, history: AmplitudeHistory
) -> Assessment:
    """All that is measured but for residuals by order."""
    assert torus.order is not None
    assert torus.frequency_order is not None
    differences = history.differences()
    terms, sums = _terms(series, torus)
    step = steps_of_frequencies(series)
    growth = growth_of(terms, step)
    poles = {q: pade_poles(series, q, torus.amplitudes) for q in torus.seeds}
    return Assessment(
        word="undecided",
        best_order=0,
        reasons=(),
        order=torus.order,
        frequency_order=torus.frequency_order,
        amplitudes=history.amplitudes,
        differences=differences,
        root_uncertainty=root_uncertainty_of(
            torus.amplitudes, history.amplitudes, differences
        ),
        sums={q: (np.array(sums[q]), np.array(sums[q])) for q in series.seeds},
        terms=tuple(terms),
        growth=growth,
        pole_radius=pole_radius_of(poles, step),
        poles=poles,
        residuals=np.zeros(0),
        energy_errors=np.zeros(0),
        resummed_residual=math.inf,
        certificate=None,
    )


def _terms(
    series: TravellingSeries, torus: RingTorus
) -> tuple[list[LargestTerm], dict[int, list[float]]]:
    """The largest term of every order, and the sums in the modes of the seeds."""
    assert torus.order is not None
    N, seeds = series.chain.N, np.array(series.seeds)
    omega = np.array([float(w) for w in series.frequencies])
    amplitudes = [torus.amplitudes[q] for q in series.seeds]
    terms = []
    sums: dict[int, list[float]] = {q: [] for q in series.seeds}
    for k in range(torus.order + 1):
        nu, u = series.harmonic_terms(amplitudes, k)
        waves, sizes = nu @ seeds % N, np.abs(u)
        for q in series.seeds:
            own = (waves == q % N) | (waves == -q % N)
            sums[q].append(float(sizes[own].sum()))
        row = int(np.argmax(sizes))
        if sizes[row]:
            mode, harmonic = min(waves[row], N - waves[row]), tuple(nu[row].tolist())
            own_frequency = _frequency(series, int(mode))
            divisor = own_frequency**2 - float(nu[row] @ omega) ** 2
            term = LargestTerm(k, float(sizes[row]), int(mode), harmonic, divisor)
            terms.append(term)
    return terms, sums


def _frequency(series: TravellingSeries, mode: int) -> float:
    """The root of lambda of a mode up to sign: that of a seed is chosen."""
    for q, omega in zip(series.seeds, series.frequencies, strict=True):
        if abs(q) == mode:
            return float(omega)
    return 2 * math.sin(math.pi * mode / series.chain.N)
