"""Resonances of the normal frequencies of a torus with its own, by their distances.

Two modes may couple where sigma_q -+ sigma_q' = nu.omega: with the difference both turn the same
way and stay elliptic, with the sum, 2 sigma_q = nu.omega among them, energy can flow into both.
sigma_q = nu.omega makes reduction to constant coefficients impossible.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from math import comb
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.normal.standing import coupled_groups
from symfpu.numbers.public import public
from symfpu.numbers.room import require_room
from symfpu.numbers.typed import integer
from symfpu.refinement.lattice import Ints, dilated
from symfpu.results.numbers import fifteen_digits
from symfpu.tori.torus import Torus


class Frequencies(Protocol):
    """What knows normal frequencies by mode, and its torus."""

    @property
    def frequencies(self) -> Mapping[int, complex]: ...

    @property
    def torus(self) -> Torus: ...


PARAMETRIC, SUM, DIFFERENCE, OWN = "parametric", "sum", "difference", "own"
KINDS = (PARAMETRIC, SUM, DIFFERENCE, OWN)
LOCKED = 1e-8  # distance up to which a hyperbolic direction is locked to a resonance
LONGEST = 24  # sum |nu_i| up to which it is looked for
MOST = 300_000  # harmonics that are looked through
NUMBERS_A_HARMONIC = (
    4  # arrays of as many numbers as all harmonics have that are alive at once
)


@public
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

    def entry(self) -> dict[str, Any]:
        """For a record."""
        return {
            "resonance": self.kind,
            "modes": list(self.modes),
            "harmonic": list(self.harmonic),
            "distance": fifteen_digits(self.distance),
        }

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
    seeds = first.torus.seeds
    harmonics = harmonics_up_to(len(seeds), length)
    harmonics = harmonics[(harmonics != 0).any(axis=1)]
    before, after = (_sides(found, harmonics) for found in (first, second))
    common = {q: w for q, w in before.sigma.items() if q in after.sigma}
    found = []
    for chain, group in coupled_groups(first.torus, common):
        for kind, modes, value, wave in _combinations(group):
            if kind == OWN:
                continue
            resonance = ParametricResonance(kind, modes, (), 0.0)
            distances = value - before.rates
            later = resonance.left_of(after.sigma) - after.rates
            crossed = _coupled(chain, seeds, harmonics, wave) & (distances * later < 0)
            for at in np.flatnonzero(crossed):
                harmonic, distance = tuple(harmonics[at].tolist()), float(distances[at])
                found.append(ParametricResonance(kind, modes, harmonic, distance))
    return found


def locked_resonances(
    found: Frequencies, modes: Collection[int]
) -> list[ParametricResonance]:
    """Those of a torus to which hyperbolic modes are locked, the shortest first.

    Of modes whose names changed on the way the one that they meet by may be a difference.
    """
    omega = np.array([float(w) for w in found.torus.frequencies])
    sigma = {q: complex(found.frequencies[q]).real for q in modes}
    seeds = found.torus.seeds
    length = _longest(len(seeds))
    harmonics = harmonics_up_to(len(seeds), length)
    rates = harmonics @ omega
    known = []
    for chain, group in coupled_groups(found.torus, sigma):
        for kind, pair, value, wave in _combinations(group):
            near = _coupled(chain, seeds, harmonics, wave) & (abs(value - rates) < LOCKED)
            for at in np.flatnonzero(near if kind != OWN else []):
                harmonic, distance = tuple(harmonics[at].tolist()), float(value - rates[at])
                known.append(ParametricResonance(kind, pair, harmonic, distance))
    return sorted(known, key=lambda r: (r.kind == DIFFERENCE, sum(map(abs, r.harmonic))))


def resonance_length_of(value: object, seeds: tuple[int, ...], least: int) -> int:
    """A largest sum |nu_i| whose harmonics fit into memory; InputError for any other."""
    length, s = integer(value, "resonance_length", least), len(seeds)

    def needed(length: int) -> int:
        return NUMBERS_A_HARMONIC * 8 * (s + 1) * _count(s, length)

    require_room("resonance_length", length, needed)
    return length


def _longest(s: int) -> int:
    """Up to which sum |nu_i| all harmonics are not too many."""
    return next(n for n in range(LONGEST, 0, -1) if _count(s, n) <= MOST)


def _count(s: int, length: int) -> int:
    """How many nu of s numbers have sum |nu_i| <= length."""
    return sum(2**k * comb(s, k) * comb(length, k) for k in range(s + 1))


def _coupled(
    chain: Chain, seeds: tuple[int, ...], harmonics: Ints, wave: int
) -> NDArray[np.bool_]:
    """Harmonics that the selection rules let couple two directions, by their wave; (H,)."""
    allowed = (harmonics @ np.array(seeds) - wave) % _turn(chain) == 0
    if chain.potential.even:
        allowed &= harmonics.sum(axis=1) % 2 == 0
    return np.asarray(allowed)


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
