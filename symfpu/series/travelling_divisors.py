"""The divisors of travelling waves on a ring, one for each harmonic, and its exact resonances.

A harmonic nu lives in the mode q = nu.q_seeds modulo N. Omega_q = Omega_(-q): where nu.Omega =
Omega_q exactly and nu is no seed itself, the divisor is as small as the frequency shifts, and the
series has no orders. With waves q and -q such harmonics exist: 2 omega_(-q) - omega_q at q = N/4.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.algebra.travelling import NO_SEED, TravellingModes
from symfpu.chain.chain import Chain
from symfpu.chain.commensurability import frequencies_cancel
from symfpu.errors import ResonantDivisor
from symfpu.series.divisors import SMALLEST_KEPT, SmallDivisor

Floats = NDArray[np.float64]
SUSPECT = 1e-9  # of nu.Omega - Omega_q, below which it is decided exactly
RESOLUTION = 2.0**-80  # of nu.omega - Omega_q, below which doubles do not tell it from zero
GRID_BITS = 51


class TravellingDivisors:
    """Multipliers L_q(nu) as doubles; sums nu.omega are split as those of Float64Divisors."""

    def __init__(
        self, chain: Chain, space: TravellingModes, frequencies: Sequence[Fraction]
    ) -> None:
        self.chain, self.space = chain, space
        self.linear = chain.frequencies()[[place_of(chain, q) for q in space.seeds]]
        largest = max(2.0, *(float(w) for w in frequencies)) * (space.grading.degree + 1)
        self._grid = GRID_BITS - int(np.frexp(largest)[1])
        with mpmath.workdps(60):
            chosen = [mpmath.mpf(w.numerator) / w.denominator for w in frequencies]
            waves = [chain.linear_frequency(min(q, chain.N - q)) for q in range(chain.N)]
            self._chosen = self._split(chosen)
            self._base = self._split([*waves, *chosen])
            self._numerators = np.array([float(omega**2) for omega in waves])
        self._smallest: list[SmallDivisor] = []

    def _split(self, values: Sequence[object]) -> tuple[Floats, Floats]:
        """Doubles on a grid so coarse that their sums are exact, and what it leaves over."""
        scaled = [mpmath.nint(mpmath.ldexp(value, self._grid)) for value in values]
        on_grid = [mpmath.ldexp(whole, -self._grid) for whole in scaled]
        fine = [float(value - x) for value, x in zip(values, on_grid, strict=True)]
        return np.array([float(x) for x in on_grid]), np.array(fine)

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> Floats:
        """L_q(nu) where there is a mode, zero in the gauge term of a seed; shape (H, 1).

        harmonics : (H, s). carried : (H, 1). Raises ResonantDivisor for a resonance of the ring,
        and where the chosen frequencies make a divisor zero.
        """
        wanted = carried[:, 0] & (np.abs(harmonics).sum(axis=1) != 1)
        waves = self.space.wave_numbers(harmonics)
        self._refuse_resonance(harmonics, waves, wanted, order)
        met = self.space.seeds_met(harmonics)
        own = np.where(met == NO_SEED, waves, self.chain.N + met)
        difference, total = self._factors(harmonics, own)
        zero = wanted & (np.abs(difference) < RESOLUTION)
        for row in np.flatnonzero(zero):
            nu, mode = self._named(harmonics[row], waves[row])
            raise ResonantDivisor(mode, nu, self.space.seeds, order, exact=True)
        divisors = difference * total
        self._remember(harmonics, waves, np.where(wanted, np.abs(divisors), np.inf), order)
        table = np.zeros(len(harmonics))
        np.divide(self._numerators[waves], divisors, out=table, where=wanted)
        return table[:, None]

    def _factors(self, harmonics: Ints, own: Ints) -> tuple[Floats, Floats]:
        """lambda_q^(1/2) -+ |nu.omega|."""
        coarse, fine = (harmonics @ part for part in self._chosen)
        sign = np.where(coarse < 0, -1.0, 1.0)
        base, rest = (part[own] for part in self._base)
        difference = (base - sign * coarse) + (rest - sign * fine)
        return difference, (base + sign * coarse) + (rest + sign * fine)

    def _signed(self, wave: int) -> int:
        """The mode of a wave number."""
        inside = wave % self.chain.N
        return inside if 2 * inside <= self.chain.N else inside - self.chain.N

    def _named(self, harmonic: Ints, wave: int) -> tuple[tuple[int, ...], int]:
        """A harmonic and its signed mode; of the two conjugates the one in the mode of a seed."""
        mode, nu = self._signed(int(wave)), tuple(map(int, harmonic))
        if mode not in self.space.seeds and -mode in self.space.seeds:
            return tuple(-n for n in nu), -mode
        return nu, mode

    def _refuse_resonance(
        self, harmonics: Ints, waves: Ints, wanted: NDArray[np.bool_], order: int
    ) -> None:
        """A resonance of the linear frequencies, whatever frequencies are chosen."""
        drive = harmonics @ self.linear
        base = np.sqrt(self._numerators)[waves]
        near = np.abs(np.abs(drive) - base) < SUSPECT
        for row in np.flatnonzero(wanted & near):
            direction = 1 if drive[row] > 0 else -1
            mode = self._signed(direction * int(waves[row]))
            nu = tuple((direction * harmonics[row]).tolist())
            if resonant(self.chain, self.space.seeds, nu, mode):
                way_out = way_out_of(self.chain, self.space.seeds, mode, order)
                raise ResonantDivisor(
                    mode, nu, self.space.seeds, order, exact=True, way_out=way_out
                )

    def _remember(self, harmonics: Ints, waves: Ints, sizes: Floats, order: int) -> None:
        known = {(d.mode, d.harmonic) for d in self._smallest}
        for row in np.argsort(sizes)[: SMALLEST_KEPT + len(known)]:
            nu, mode = self._named(harmonics[row], waves[row])
            if np.isfinite(sizes[row]) and (mode, nu) not in known:
                found = SmallDivisor(float(sizes[row]), mode, nu, order)
                self._smallest.append(found)
        self._smallest.sort(key=lambda divisor: divisor.size)
        del self._smallest[SMALLEST_KEPT:]

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """The smallest divisors met so far, smallest first."""
        return tuple(self._smallest)


def place_of(chain: Chain, q: int) -> int:
    """Where a mode stands on the axis of modes."""
    return chain.mode_numbers.index(q)


def resonant(chain: Chain, seeds: Sequence[int], nu: Sequence[int], mode: int) -> bool:
    """Whether nu.Omega = +-Omega_mode exactly."""
    signs = (1, -1)
    return any(_cancels(chain.turn, seeds, nu, mode, sign) for sign in signs)


def _cancels(
    turn: int, seeds: Sequence[int], nu: Sequence[int], mode: int, sign: int
) -> bool:
    combination = {abs(mode): -sign}
    for q, n in zip(seeds, nu, strict=True):
        combination[abs(q)] = combination.get(abs(q), 0) + n
    return frequencies_cancel(turn, combination)


def way_out_of(chain: Chain, seeds: Sequence[int], mode: int, order: int) -> str:
    """What to do about a resonance that drives a mode."""
    driven = f"waves of mode {mode} are driven in resonance"
    lower = f"stop at order {order - 1}" if order > 1 else "choose other seeds"
    modes = sorted({abs(q) for q in (*seeds, mode)})
    if chain.N % 2 or chain.N // 2 in modes:
        return f"{driven}; {lower}"
    fixed = f"Chain(N={chain.N // 2}, ...) with fixed ends, seeds {tuple(modes)}"
    return f"{driven}; {lower}, or seed all partners as standing waves: {fixed}, and unfold"
