"""One energy of a frequency map: an orbit, and what is kept of its frequencies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import integrate
from symfpu.dynamics.schemes import scheme_of
from symfpu.dynamics.starts import packet_state
from symfpu.dynamics.stopping import require_stable
from symfpu.errors import InputError
from symfpu.files.progress import Progress, unheard
from symfpu.numbers.typed import double
from symfpu.spectral.analysis import FrequencyAnalysis, frequency_analysis
from symfpu.spectral.samples import require_samples

Row = dict[str, Any]

HALVES = 2  # windows of the drift
KEYS = ("modes", "frequencies", "errors", "strengths", "drifts")


def orbit_frequencies(
    energy: str,
    *,
    chain: Chain,
    seeds: Sequence[int],
    T: float,
    step: float,
    scheme: str,
    lines: int,
    progress: Progress | None = None,
) -> Row:
    """The independent frequencies of the packet of this energy, as lists: a row of a map.

    Arguments as of `frequency_map`.

    >>> chain, how = Chain(N=4, beta=1), {"T": 500, "step": 0.1, "scheme": "kahan_li8"}
    >>> orbit_frequencies("0.01", chain=chain, seeds=(1,), lines=8, **how)["modes"]
    [1, 3]
    """
    state = packet_state(chain, seeds, energy)
    orbit = integrate(chain, *state, T, step=step, scheme=scheme, samples=1)
    tell, label = progress or unheard, f"H = {double(energy, 'energy'):.4g}"

    def told(_: str, fraction: float) -> None:
        tell(label, fraction)

    return _row(frequency_analysis(orbit, lines=lines, windows=HALVES, progress=told))


def require_analysable(chain: Chain, T: float, step: float, scheme: str) -> None:
    """What no energy would pass: raises InputError, and UnstableStep."""
    found = scheme_of(chain, scheme)
    for name, value in (("T", T), ("step", step)):
        if not 0 < value < math.inf:
            raise InputError(name, value, "a positive number", "pass a time")
    require_samples(T, step)
    require_stable(chain, found, step, 0.0)


def kept_row(result: Row) -> Row:
    """A row of a file, if it has all that a map takes of it; KeyError or TypeError."""
    for name in KEYS:
        len(result[name])
    return result


def _row(found: FrequencyAnalysis) -> Row:
    return {
        "modes": _modes(found),
        "frequencies": found.frequencies.tolist(),
        "errors": found.errors.tolist(),
        "strengths": found.strengths.tolist(),
        "drifts": [None if math.isnan(x) else x for x in _mode_drifts(found)],
    }


def _modes(found: FrequencyAnalysis) -> list[int]:
    """The mode of the strongest line of each independent frequency."""
    modes = []
    for place in range(len(found.seeds)):
        unit = tuple(int(i == place) for i in range(len(found.seeds)))
        own = [line for line in found.lines if line.harmonic == unit]
        modes.append(max(own, key=lambda line: line.amplitude).mode)
    return modes


def _mode_drifts(found: FrequencyAnalysis) -> list[float]:
    """Relative change of the strongest line of each mode between halves; nan without a line."""
    first, second = found.window_frequencies
    with np.errstate(invalid="ignore", divide="ignore"):
        changes = np.abs(second - first) / np.abs(first)
    return [float(x) for x in changes]
