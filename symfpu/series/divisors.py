"""The small divisors lambda_q - (nu.omega)^2 of a chain and its chosen frequencies, and the multipliers L_q(nu) made of them.

L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2) with lambda_q = omega_q^2 for a seed and Omega_q^2 otherwise:
the L of Eq. Lm, which the paper has at leading order, for every order. Everything that depends on N and on
the frequencies enters the series through it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import Any, Protocol

import mpmath
import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.grading import Ints
from symfpu.algebra.residue import ResidueRing, cosine_table
from symfpu.chain.chain import Chain
from symfpu.errors import ResonantDivisor, VanishingResidue

Floats = NDArray[np.float64]
KEPT = 10  # how many of the smallest divisors a series remembers


@dataclass(frozen=True)
class SmallDivisor:
    """|lambda_q - (nu.omega)^2| = size of one mode and harmonic, at the order where the harmonic first meets the mode."""

    size: float
    mode: int
    harmonic: tuple[int, ...]
    order: int

    def __repr__(self) -> str:
        return f"{self.size:.2g} at mode {self.mode}, harmonic ({','.join(map(str, self.harmonic))}), order {self.order}"


class Divisors(Protocol):
    """The multipliers L_q(nu) of a chain and its chosen frequencies, as the ring of the series takes them."""

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> Any:
        """L_q(nu) where the selection rules let mode q carry nu, zero elsewhere and in the gauge term nu = e_q of a seed.

        harmonics : (H, s). carried : (H, N-1), as the result. Raises where a divisor vanishes.
        """

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """The smallest divisors met so far, smallest first; none where they have no size."""


class Float64Divisors:
    """Multipliers as doubles, correct to a few units in the last place down to divisors of 1e-18, less beyond.

    Frequencies are split on a grid of doubles so coarse that nu.omega is summed without rounding; what the grid leaves
    over is carried separately. So Omega_q - |nu.omega| loses no digits where the two nearly cancel.
    """

    def __init__(self, chain: Chain, seeds: Sequence[int], frequencies: Sequence[Fraction], degree: int) -> None:
        self.chain, self.seeds, self.frequencies = chain, tuple(seeds), tuple(frequencies)
        largest = max(2.0, *(float(w) for w in frequencies)) * (degree + 1)
        self._grid = 52 - int(np.frexp(largest)[1])
        with mpmath.workdps(60):
            linear = [chain.linear_frequency(q) for q in range(1, chain.N)]
            bases = list(linear)
            chosen = [mpmath.mpf(w.numerator) / w.denominator for w in frequencies]
            for q, omega in zip(seeds, chosen, strict=True):
                bases[q - 1] = omega
            self._base = self._split(bases)
            self._chosen = self._split(chosen)
            self._numerators = np.array([float(omega**2) for omega in linear])
        self._smallest: dict[tuple[int, tuple[int, ...]], SmallDivisor] = {}

    def _split(self, values: Sequence[Any]) -> tuple[Floats, Floats]:
        coarse = [mpmath.nint(mpmath.ldexp(v, self._grid)) for v in values]
        fine = [v - mpmath.ldexp(c, -self._grid) for v, c in zip(values, coarse, strict=True)]
        return np.array([float(mpmath.ldexp(c, -self._grid)) for c in coarse]), np.array([float(f) for f in fine])

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> Floats:
        """L_q(nu) where the selection rules let mode q carry nu, zero elsewhere and in the gauge term nu = e_q of a seed.

        harmonics : (H, s). carried : (H, N-1). Raises ResonantDivisor where a divisor is exactly zero, or so small that
        doubles cannot tell it from zero.
        """
        wanted = carried & ~gauge_terms(harmonics, self.seeds, self.chain.N)
        coarse, fine = harmonics @ self._chosen[0], harmonics @ self._chosen[1]
        sign = np.where(coarse < 0, -1.0, 1.0)
        difference = (self._base[0] - (sign * coarse)[:, None]) + (self._base[1] - (sign * fine)[:, None])
        divisors = difference * ((self._base[0] + (sign * coarse)[:, None]) + (self._base[1] + (sign * fine)[:, None]))
        self._refuse_zero(harmonics, wanted, difference, order)
        self._remember(harmonics, wanted, np.abs(divisors), order)
        return np.asarray(np.divide(self._numerators, divisors, out=np.zeros_like(divisors), where=wanted))

    def _refuse_zero(self, harmonics: Ints, wanted: NDArray[np.bool_], difference: Floats, order: int) -> None:
        resolution = 2.0 ** -(self._grid + 40)
        for row, column in np.argwhere(wanted & (np.abs(difference) < 2.0 ** (4 - self._grid))):
            mode, harmonic = int(column) + 1, tuple(map(int, harmonics[row]))
            exact = vanishes(self.chain.N, self.seeds, self.frequencies, mode, harmonic)
            if exact or abs(difference[row, column]) < resolution:
                raise ResonantDivisor(mode, harmonic, self.seeds, order, exact=exact)

    def _remember(self, harmonics: Ints, wanted: NDArray[np.bool_], sizes: Floats, order: int) -> None:
        candidates = np.where(wanted, sizes, np.inf).ravel()
        count = min(len(candidates), KEPT + len(self._smallest))  # some may be there already
        for at in np.argpartition(candidates, count - 1)[:count] if count else ():
            if np.isfinite(candidates[at]):
                row, column = divmod(int(at), self.chain.N - 1)
                key = (column + 1, tuple(map(int, harmonics[row])))
                self._smallest.setdefault(key, SmallDivisor(float(candidates[at]), *key, order))
        kept = sorted(self._smallest.items(), key=lambda item: item[1].size)[:KEPT]
        self._smallest = dict(kept)

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """The smallest divisors met so far, smallest first."""
        return tuple(self._smallest.values())


class FixedPointDivisors:
    """Multipliers as integers, 2^bits L rounded down, from exact frequencies and linear frequencies of four times the bits."""

    def __init__(self, chain: Chain, seeds: Sequence[int], frequencies: Sequence[Fraction], bits: int) -> None:
        self.chain, self.seeds, self.frequencies, self.bits = chain, tuple(seeds), tuple(frequencies), bits
        self._places = 4 * bits + 64
        self._common = lcm(*(w.denominator for w in frequencies))
        self._omega = np.array([int(w * self._common) for w in frequencies], dtype=object)
        with mpmath.workprec(self._places + 32):
            linear = [int(mpmath.nint(mpmath.ldexp(chain.linear_frequency(q) ** 2, self._places))) for q in range(1, chain.N)]
        self._numerators = np.array(linear, dtype=object)
        self._lambda = self._numerators.copy()
        for q, whole in zip(seeds, self._omega, strict=True):
            self._lambda[q - 1] = self._squared(whole)

    def _squared(self, whole: Any) -> Any:
        return ((whole * whole) << self._places) // self._common**2

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> NDArray[np.object_]:
        """2^bits L_q(nu) where the selection rules let mode q carry nu, zero elsewhere and in the gauge term; shape (H, N-1).

        Raises ResonantDivisor where a divisor is zero or below 2^-bits.
        """
        rows, columns = np.nonzero(carried & ~gauge_terms(harmonics, self.seeds, self.chain.N))
        divisors = self._lambda[columns] - self._squared(harmonics.astype(object) @ self._omega)[rows]
        for at in np.flatnonzero(np.abs(divisors) < 1 << (self._places - self.bits)):
            mode, harmonic = int(columns[at]) + 1, tuple(map(int, harmonics[rows[at]]))
            exact = vanishes(self.chain.N, self.seeds, self.frequencies, mode, harmonic)
            raise ResonantDivisor(mode, harmonic, self.seeds, order, exact=exact)
        table = np.full(carried.shape, 0, dtype=object)
        table[rows, columns] = (self._numerators[columns] << self.bits) // divisors
        return table

    def moduli(self) -> MultiplierModuli:
        """The same multipliers by their moduli, as doubles not below them."""
        return MultiplierModuli(self)

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """None here: doubles, which come first, remember them."""
        return ()


class MultiplierModuli:
    """Upper bounds of |L_q(nu)| as doubles, from fixed-point multipliers."""

    def __init__(self, divisors: FixedPointDivisors) -> None:
        self._divisors = divisors

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> Floats:
        """|L_q(nu)|, enlarged by more than the rounding to a double; shape (H, N-1)."""
        whole = self._divisors.multipliers(harmonics, carried, order)
        return np.asarray(np.abs((whole / 2**self._divisors.bits).astype(np.float64)) * (1 + 1e-12))

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """None: bounds are not divisors."""
        return ()


class ResidueDivisors:
    """Multipliers modulo a prime, at a point where the chosen frequencies are residues.

    Raises VanishingResidue where a divisor is zero modulo the prime: nothing follows from such a point, take another.
    """

    def __init__(self, chain: Chain, seeds: Sequence[int], ring: ResidueRing, frequencies: Sequence[int]) -> None:
        self.chain, self.seeds, self.ring = chain, tuple(seeds), ring
        cosines = cosine_table(chain.N, ring.prime, ring.root)
        self._numerators = np.array([ring.element(2 - 2 * cosines[2 * q]) for q in range(1, chain.N)])
        self._lambda = self._numerators.copy()
        for q, omega in zip(seeds, frequencies, strict=True):
            self._lambda[q - 1] = ring.element(omega * omega)
        self._omega = [int(w) for w in frequencies]

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> Floats:
        """L_q(nu) modulo the prime where the selection rules let mode q carry nu, zero elsewhere and in the gauge term."""
        wanted = carried & ~gauge_terms(harmonics, self.seeds, self.chain.N)
        drives = np.array([self.ring.element(sum(int(n) * w for n, w in zip(nu, self._omega, strict=True))) for nu in harmonics])
        divisors = self.ring.reduced(self._lambda - self.ring.products(drives, drives)[:, None])
        if np.any(wanted & (divisors == 0)):
            raise VanishingResidue(self.ring.prime, order)
        return np.where(wanted, self.ring.products(self.ring.inverses(divisors), self._numerators), 0.0)

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """None: residues have no size."""
        return ()


class UniversalDivisors:
    """Multipliers as symbols L_q(nu): the universal form, for every chain and all generic frequencies at once."""

    def __init__(self, chain: Chain, seeds: Sequence[int]) -> None:
        self.chain, self.seeds = chain, tuple(seeds)

    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> NDArray[np.object_]:
        """Symbols L_q(nu), zero where the selection rules or the gauge leave nothing; shape (H, N-1)."""
        table = np.full(carried.shape, se.Integer(0), dtype=object)
        for row, column in np.argwhere(carried & ~gauge_terms(harmonics, self.seeds, self.chain.N)):
            table[row, column] = multiplier_symbol(int(column) + 1, [int(n) for n in harmonics[row]])
        return table

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """None: symbols have no size."""
        return ()


def vanishes(N: int, seeds: Sequence[int], frequencies: Sequence[Fraction], mode: int, harmonic: Sequence[int]) -> bool:
    """Whether lambda_mode = (nu.omega)^2 for the exact rational frequencies.

    A linear frequency 2 sin(q pi / 2N) is rational only if it is 1, for q = N/3 (Niven).
    """
    drive = sum((n * w for n, w in zip(harmonic, frequencies, strict=True)), start=Fraction(0))
    if mode in seeds:
        return abs(drive) == frequencies[list(seeds).index(mode)]
    return 3 * mode == N and abs(drive) == 1


def divisor(chain: Chain, seeds: Sequence[int], frequencies: Sequence[Fraction], mode: int, harmonic: Sequence[int]) -> float:
    """lambda_q - (nu.omega)^2 of one mode and harmonic, correctly rounded."""
    drive = sum((n * w for n, w in zip(harmonic, frequencies, strict=True)), start=Fraction(0))
    with mpmath.workdps(60):
        own = frequencies[list(seeds).index(mode)] if mode in seeds else None
        base = chain.linear_frequency(mode) if own is None else mpmath.mpf(own.numerator) / own.denominator
        return float(base**2 - (mpmath.mpf(drive.numerator) / drive.denominator) ** 2)


def gauge_terms(harmonics: Ints, seeds: Sequence[int], N: int) -> NDArray[np.bool_]:
    """Where a harmonic is +-e_q in the seed mode q itself: the gauge leaves no term there; shape (H, N-1)."""
    gauge = np.zeros((len(harmonics), N - 1), dtype=np.bool_)
    for unit, q in zip(np.eye(len(seeds), dtype=np.int64), seeds, strict=True):
        gauge[:, q - 1] = (np.abs(harmonics) == unit).all(axis=1)
    return gauge


def multiplier_symbol(mode: int, harmonic: Sequence[int]) -> Any:
    """The symbol L_q(nu); its name reads as LaTeX."""
    return se.Symbol(f"L_{{{mode}}}({','.join(map(str, harmonic))})")
