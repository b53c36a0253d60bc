"""Figs. 3 and 9 in the alpha and in the Toda chain: FPU-trajectories, recurrences, the fold."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from symfpu.breathers.balance import breather_of_frequency
from symfpu.chain.chain import Chain
from symfpu.chain.propagation import excitation_sequence
from symfpu.dynamics.orbits import Orbit
from symfpu.files.progress import NO_FRACTION, Progress, unheard
from symfpu.integrable.invariants import toda_gaps
from symfpu.integrable.torus import toda_torus
from symfpu.localization.profiles import (
    fpu_trajectory,
    normalised_averages,
    packet_amplitudes,
)
from symfpu.localization.recurrence import Recurrence, recurrence
from symfpu.paper.convergence_fig9 import limit_frequency, series_end
from symfpu.paper.printed import FIG9_BREATHER
from symfpu.paper.starts import integrated_orbit, printed_amplitudes, printed_row
from symfpu.paper.toda_fig1 import chains_of

Floats = NDArray[np.float64]

# the scheme in bond space: that in mode space, whose tails are not rounded, knows polynomials only
ORBIT_SCHEME = "kahan_li8"
TIME, STEP, LOOKS = 1e5, 0.2, 501  # of Fig. 3
# of Fig. 9; a return is known to some hundredths where looks are this near each other
RECURRENCE_TIME, RECURRENCE_STEP, RECURRENCE_LOOKS = 2.5e4, 0.25, 50001
GROUPS = 7
# of breathers of Fig. 9's chain, from near the linear one to the printed one
BREATHER_FREQUENCIES = (
    "0.09817",
    "0.09822",
    "0.09827",
    "0.09832",
    "0.09836",
    "0.0984",
    FIG9_BREATHER.frequencies[0],
)
LIMIT_BRACKET = (0.09832, 0.0984)  # frequencies on both sides of the last that is reached
EXACT_DIGITS = 15


@dataclass(frozen=True, eq=False)
class TrajectoryStudy:
    """The FPU-trajectory of Fig. 3 in one chain.

    shares : time averages of the mode energies to the end, (N-1,). highest : of the groups D_k,
    the largest share at any time. times, gaps : (S,), (S, N-1).
    """

    shares: Floats = field(repr=False)
    highest: Floats = field(repr=False)
    times: Floats = field(repr=False)
    gaps: Floats = field(repr=False)
    energy_error: float

    def drift(self) -> Floats:
        """How far each gap goes from its first value, (N-1,)."""
        return np.asarray(np.abs(self.gaps - self.gaps[0]).max(axis=0))


@dataclass(frozen=True, eq=False)
class RecurrenceStudy:
    """The FPU-trajectory of Fig. 9 in one chain: times (S,), E_1(t)/E (S,), its returns."""

    times: Floats = field(repr=False)
    first_mode: Floats = field(repr=False)
    returns: Recurrence


@dataclass(frozen=True, eq=False)
class FoldStudy:
    """Breathers of seed 1 in one chain, and where the series of the same frequency ends.

    frequencies, amplitudes, ends, reached : (F,); reached is the frequency at the end. limit : of
    the amplitudes, to which the series reach their breathers. energy : of the breather with the
    printed frequency.
    """

    frequencies: Floats = field(repr=False)
    amplitudes: Floats = field(repr=False)
    ends: Floats = field(repr=False)
    reached: Floats = field(repr=False)
    limit: float
    energy: float


@dataclass(frozen=True, eq=False)
class OrbitStudy:
    """All by chain, and the exact energy of Toda's breather with the printed frequency."""

    trajectories: dict[str, TrajectoryStudy]
    recurrences: dict[str, RecurrenceStudy]
    folds: dict[str, FoldStudy]
    exact_energy: float


def orbit_study(progress: Progress = unheard) -> OrbitStudy:
    """Figs. 3 and 9 for all chains of the same c_3."""
    trajectories = {}
    recurrences = {}
    folds = {}
    chains = chains_of(FIG9_BREATHER.chain)
    for name, chain in chains.items():
        recurrences[name] = recurrence_study(name, chain, progress)
        if name == "alpha and beta":
            continue
        trajectories[name] = trajectory_study(name, chain, progress)
        progress(f"toda: Fig. 9, breathers of {name}", NO_FRACTION)
        folds[name] = fold_study(chain)
    exact = toda_torus(
        chains["Toda"],
        FIG9_BREATHER.seeds,
        frequencies=FIG9_BREATHER.frequencies,
        digits=EXACT_DIGITS,
    )
    return OrbitStudy(trajectories, recurrences, folds, float(exact.energy))


def trajectory_study(
    name: str, chain: Chain, progress: Progress = unheard, *, T: float = TIME
) -> TrajectoryStudy:
    """The FPU-trajectory from the printed amplitudes of Fig. 2, with all gaps along it."""
    row = printed_row("Fig. 2")
    start = fpu_trajectory(chain, printed_amplitudes(row))
    label = f"toda: Fig. 3, {name}"
    orbit = _orbit(label, chain, start, T, STEP, LOOKS, progress, averages=True)
    shares = orbit.harmonic_energies()
    shares = shares / shares.sum(axis=1, keepdims=True)
    groups = excitation_sequence(chain.N, row.seeds, GROUPS)
    highest = [shares[:, np.array(modes) - 1].sum(axis=1).max() for modes in groups]
    gaps = np.asarray(toda_gaps(chain, orbit.Q, orbit.P), dtype=float)
    return TrajectoryStudy(
        shares=normalised_averages(orbit)[-1],
        highest=np.array(highest),
        times=orbit.times,
        gaps=gaps,
        energy_error=orbit.energy_error,
    )


def recurrence_study(
    name: str, chain: Chain, progress: Progress = unheard
) -> RecurrenceStudy:
    """The FPU-trajectory with the printed energy of Fig. 9 in mode 1."""
    row = printed_row("Fig. 9")
    amplitudes = packet_amplitudes(row.chain, row.seeds, row.energy)
    start = fpu_trajectory(chain, amplitudes)
    label = f"toda: Fig. 9, {name}"
    T, step, looks = RECURRENCE_TIME, RECURRENCE_STEP, RECURRENCE_LOOKS
    orbit = _orbit(label, chain, start, T, step, looks, progress, averages=False)
    energies = orbit.harmonic_energies()
    first_mode = energies[:, 0] / energies[0].sum()
    return RecurrenceStudy(orbit.times, first_mode, recurrence(orbit.times, energies))


def _orbit(
    label: str,
    chain: Chain,
    start: tuple[Floats, Floats],
    T: float,
    step: float,
    looks: int,
    progress: Progress,
    *,
    averages: bool,
) -> Orbit:
    return integrated_orbit(
        label,
        chain,
        start,
        T,
        progress,
        scheme=ORBIT_SCHEME,
        step=step,
        samples=np.linspace(0, T, looks),
        averages=averages,
    )


def fold_study(chain: Chain) -> FoldStudy:
    """Breathers by harmonic balance, beside the ends of their series."""
    (seed,) = FIG9_BREATHER.seeds
    orbits = [breather_of_frequency(chain, seed, omega) for omega in BREATHER_FREQUENCIES]
    ends = [series_end(chain, seed, omega) for omega in BREATHER_FREQUENCIES]
    low, high = LIMIT_BRACKET
    omega = limit_frequency(chain, seed, low, high)
    touching = breather_of_frequency(chain, seed, omega)
    return FoldStudy(
        frequencies=np.array([float(orbit.frequency) for orbit in orbits]),
        amplitudes=np.array([orbit.amplitude for orbit in orbits]),
        ends=np.array([end for end, _ in ends]),
        reached=np.array([frequency for _, frequency in ends]),
        limit=touching.amplitude,
        energy=float(orbits[-1].energy()),
    )
