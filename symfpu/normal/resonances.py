"""Resonances of the normal frequencies of a torus with its own, by their distances.

Two modes may couple where sigma_q -+ sigma_q' = nu.omega: with the difference both turn the same
way and stay elliptic, with the sum, 2 sigma_q = nu.omega among them, energy can flow into both.
sigma_q = nu.omega makes reduction to constant coefficients impossible.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.refinement.equation import Ints
from symfpu.refinement.lattice import dilated
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus


class Frequencies(Protocol):
    """What knows normal frequencies by mode, and its torus."""

    @property
    def frequencies(self) -> Mapping[int, complex]: ...

    @property
    def torus(self) -> QuasiPeriodic | RingTorus: ...


PARAMETRIC, SUM, DIFFERENCE, OWN = "parametric", "sum", "difference", "own"
KINDS = (PARAMETRIC, SUM, DIFFERENCE, OWN)


@dataclass(frozen=True)
class ParametricResonance:
    """How far a combination of normal frequencies is from one of the torus.

    kind : "parametric", 2 sigma_q = nu.omega; "sum", sigma_q + sigma_q' = nu.omega; "difference",
    sigma_q - sigma_q' = nu.omega; "own", sigma_q = nu.omega. modes : q, or q and q'.
    harmonic : nu. distance : left side minus right side, of the real parts, dimensionless.
    Ours.

    >>> ParametricResonance("parametric", (4,), (0, 2), 1e-3)
    2 sigma_4 = (0,2).omega, off by 0.001
    """

    kind: str
    modes: tuple[int, ...]
    harmonic: tuple[int, ...]
    distance: float

    def __repr__(self) -> str:
        return f"{self.condition}, off by {self.distance:.3g}"

    @property
    def condition(self) -> str:
        """The equation, in words."""
        harmonic = ",".join(map(str, self.harmonic))
        return f"{self.left} = ({harmonic}).omega"

    def distance_of(self, found: Frequencies) -> float:
        """Its distance on another torus: left side minus right side, of the real parts.

        found : the normal modes of that torus.
        """
        sigma = {q: complex(w).real for q, w in found.frequencies.items()}
        omega = np.array([float(w) for w in found.torus.frequencies])
        return self.left_of(sigma) - float(np.array(self.harmonic) @ omega)

    def left_of(self, sigma: Mapping[int, float]) -> float:
        """Its left side, a number; sigma : real parts by mode."""
        q, other = self.modes[0], self.modes[-1]
        if self.kind == OWN:
            return sigma[q]
        return (
            sigma[q] - sigma[other] if self.kind == DIFFERENCE else sigma[q] + sigma[other]
        )

    @property
    def left(self) -> str:
        """Its left side."""
        q, other = self.modes[0], self.modes[-1]
        sign = "+" if self.kind == SUM else "-"
        if self.kind in (SUM, DIFFERENCE):
            return f"sigma_{q} {sign} sigma_{other}"
        return f"2 sigma_{q}" if self.kind == PARAMETRIC else f"sigma_{q}"


def resonances_of(
    chain: Chain,
    seeds: tuple[int, ...],
    omega: tuple[float, ...],
    sigma: Mapping[int, float],
    length: int,
) -> list[ParametricResonance]:
    """The nearest harmonic of each combination, with sum |nu_i| <= length; by their distance.

    Only harmonics that the selection rules let couple.
    """
    harmonics = harmonics_up_to(len(seeds), length)
    rates = harmonics @ np.array(omega)
    even = harmonics.sum(axis=1) % 2 == 0
    waves = harmonics @ np.array(seeds)
    found = []
    for kind, modes, value, wave in _combinations(sigma):
        allowed = (waves - wave) % _turn(chain) == 0
        if chain.potential.even:
            allowed &= even if kind != OWN else ~even
        if allowed.any():
            distances = np.where(allowed, value - rates, np.inf)
            at = int(np.argmin(np.abs(distances)))
            harmonic = tuple(harmonics[at].tolist())
            found.append(ParametricResonance(kind, modes, harmonic, float(distances[at])))
    return sorted(found, key=lambda r: abs(r.distance))


def crossed_resonances(
    first: Frequencies, second: Frequencies, length: int
) -> list[ParametricResonance]:
    """Those whose distance changes its sign between two tori, of directions elliptic on both.

    All but sigma_q = nu.omega, which twice it is among 2 sigma_q; sum |nu_i| <= length.
    """
    if not length:
        return []
    chain, seeds = first.torus.chain, first.torus.seeds
    harmonics = harmonics_up_to(len(seeds), length)
    harmonics = harmonics[(harmonics != 0).any(axis=1)]
    waves = harmonics @ np.array(seeds)
    even = harmonics.sum(axis=1) % 2 == 0
    before, after = (_sides(found, harmonics) for found in (first, second))
    common = {q: w for q, w in before.sigma.items() if q in after.sigma}
    found = []
    for kind, modes, value, wave in _combinations(common):
        if kind == OWN:
            continue
        allowed = (waves - wave) % _turn(chain) == 0
        if chain.potential.even:
            allowed &= even
        resonance = ParametricResonance(kind, modes, (), 0.0)
        distances = value - before.rates
        later = resonance.left_of(after.sigma) - after.rates
        for at in np.flatnonzero(allowed & (distances * later < 0)):
            harmonic = tuple(harmonics[at].tolist())
            found.append(ParametricResonance(kind, modes, harmonic, float(distances[at])))
    return found


class _Sides(NamedTuple):
    """Real normal frequencies by mode, and nu.omega."""

    sigma: dict[int, float]
    rates: NDArray[np.float64]


def _sides(found: Frequencies, harmonics: Ints) -> _Sides:
    omega = np.array([float(w) for w in found.torus.frequencies])
    every = {q: complex(w) for q, w in found.frequencies.items()}
    real = {q: w.real for q, w in every.items() if not w.imag}
    return _Sides(real, np.asarray(harmonics @ omega))


def harmonics_up_to(s: int, length: int) -> Ints:
    """All nu with sum |nu_i| <= length, of both signs; shape (H, s)."""
    return dilated(np.eye(s, dtype=np.int64), float(length))


def _combinations(
    sigma: Mapping[int, float],
) -> Iterator[tuple[str, tuple[int, ...], float, int]]:
    """Kind, modes, left side, and the wave nu.seeds that couples them, modulo `_turn`."""
    modes = list(sigma)
    for i, q in enumerate(modes):
        yield OWN, (q,), sigma[q], q
        yield PARAMETRIC, (q,), 2 * sigma[q], 2 * q
        for other in modes[i + 1 :]:
            yield SUM, (q, other), sigma[q] + sigma[other], q + other
            yield DIFFERENCE, (q, other), sigma[q] - sigma[other], q - other


def _turn(chain: Chain) -> int:
    """What waves are told apart by: a ring keeps its own, fixed ends the reflection."""
    return 2 if chain.ends == "fixed" else chain.N
