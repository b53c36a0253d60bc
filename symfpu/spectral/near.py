"""The q-torus that the lines of an orbit make: a guess for Newton's method."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symfpu.errors import InputError
from symfpu.numbers.public import public
from symfpu.numbers.typed import seed_modes
from symfpu.spectral.analysis import FrequencyAnalysis, SpectralLine
from symfpu.tori.torus import Torus


@public
def torus_near(analysis: FrequencyAnalysis, seeds: Sequence[int] | None = None) -> Torus:
    """The q-torus that an orbit is on or near, from its lines.

    analysis : of the orbit, by `frequency_analysis`; with more lines a mode the guess is better.
    seeds : those of analysis.seeds whose angles the torus has; all, if left out. Lines of the
        others, turns about the torus, are left out.

    Q_q = sum of c_q[nu] cos(nu.(omega t + phi)), the phases phi from the lines of the seeds
    themselves; c is A cos of the phase that a line has beside nu.phi, which on a torus that is
    symmetric in time is 0 or pi. Phases in radians, all else dimensionless. `refine` takes the
    result; `residual` says how near it is. Ours. Raises InputError for other seeds, and
    for those that name a second frequency of another mode.

    >>> import symfpu
    >>> from symfpu import Chain, frequency_analysis, integrate, refine
    >>> torus = symfpu.torus(Chain(N=4, alpha="0.3"), (1,), amplitudes={1: "0.4"})
    >>> orbit = integrate(torus.chain, *torus.state(1.7), 1000, step=0.1)
    >>> near = torus_near(frequency_analysis(orbit, lines=8))
    >>> bool(abs(refine(near).energy() - torus.energy()) < 1e-9)
    True
    """
    chosen = _chosen(analysis, seeds)
    places = [analysis.seeds.index(q) for q in chosen]
    units = {q: _unit(analysis, place) for q, place in zip(chosen, places, strict=True)}
    _require_own_lines(units)
    phases = {q: line.phase for q, line in units.items()}
    offsets = np.array([phases[q] for q in chosen])
    rows: dict[tuple[int, ...], NDArray[np.float64]] = {}
    for line in analysis.lines:
        nu = _among(line, places, len(analysis.seeds))
        if nu is None:
            continue
        sign = -1 if next((n for n in nu if n), 1) < 0 else 1
        beside = line.phase - float(np.dot(nu, offsets))
        row = rows.setdefault(tuple(sign * n for n in nu), np.zeros(analysis.chain.N - 1))
        row[line.mode - 1] += line.amplitude * math.cos(beside)
    return Torus(
        analysis.chain,
        chosen,
        tuple(Fraction(float(analysis.frequencies[place])) for place in places),
        np.array(list(rows), dtype=np.int64),
        np.array(list(rows.values())),
        phases,
    )


def _chosen(analysis: FrequencyAnalysis, seeds: Sequence[int] | None) -> tuple[int, ...]:
    if not isinstance(analysis, FrequencyAnalysis):
        advice = "make one with frequency_analysis"
        raise InputError("analysis", analysis, "a FrequencyAnalysis", advice)
    if not analysis.seeds:
        advice = "take a longer orbit"
        raise InputError("analysis", "no independent frequency", "one at least", advice)
    if seeds is None:
        return tuple(sorted(analysis.seeds))
    chosen = seed_modes(seeds, analysis.chain.N)
    if not set(chosen) <= set(analysis.seeds):
        allowed = f"modes of independent frequencies, {analysis.seeds}"
        raise InputError("seeds", tuple(seeds), allowed, "leave out the others")
    return tuple(sorted(chosen))


def _unit(analysis: FrequencyAnalysis, place: int) -> SpectralLine:
    """The strongest line of an independent frequency itself."""
    unit = tuple(int(i == place) for i in range(len(analysis.seeds)))
    return max(
        (line for line in analysis.lines if line.harmonic == unit),
        key=lambda line: line.amplitude,
    )


def _require_own_lines(units: dict[int, SpectralLine]) -> None:
    """A second frequency of a mode has the name of another mode, which does not move with it."""
    for q, line in units.items():
        if line.mode != q:
            given = f"{q}, a second frequency of mode {line.mode} ({line.frequency:.6g})"
            own = tuple(seed for seed, other in units.items() if other.mode == seed)
            allowed = "modes with a frequency of their own"
            raise InputError("seeds", given, allowed, f"take seeds={own} or fewer of them")


def _among(line: SpectralLine, places: list[int], s: int) -> tuple[int, ...] | None:
    """The harmonic of a line by the chosen frequencies; None if another takes part."""
    if line.harmonic is None:
        return None
    others = [n for i, n in enumerate(line.harmonic) if i not in places]
    if any(others) or len(line.harmonic) != s:
        return None
    return tuple(line.harmonic[i] for i in places)
