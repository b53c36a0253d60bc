"""The small divisors lambda_q - (nu.omega)^2, and the multipliers L_q(nu) made of them.

L_q(nu) = Omega_q^2 / (lambda_q - (nu.omega)^2) with lambda_q = omega_q^2 for a seed and Omega_q^2
otherwise: the L of Eq. Lm, which the paper has at leading order, for every order. Everything that
depends on N and on the frequencies enters the series through it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import frexp, lcm
from typing import Any

import mpmath
import numpy as np
import symengine as se
from numpy.typing import NDArray

from symfpu.algebra.formulas import multiplier_symbol
from symfpu.algebra.grading import HarmonicRows, Ints, extended
from symfpu.algebra.residue import ResidueRing, cosine_table
from symfpu.algebra.selection import NO_SEED, CosineModes, Modes
from symfpu.chain.chain import Chain
from symfpu.errors import ResonantDivisor, VanishingResidue
from symfpu.numbers.arithmetic import mpf
from symfpu.results.numbers import fifteen_digits
from symfpu.series.ring_resonances import refuse_resonances

Floats = NDArray[np.float64]
SMALLEST_KEPT = 10  # how many of the smallest divisors a series remembers


@dataclass(frozen=True)
class SmallDivisor:
    """|lambda_q - (nu.omega)^2| = size, at the order where the harmonic first meets the mode."""

    size: float
    mode: int
    harmonic: tuple[int, ...]
    order: int

    def entry(self) -> dict[str, Any]:
        """For a record."""
        size = fifteen_digits(self.size)
        place = {"mode": self.mode, "harmonic": list(self.harmonic), "order": self.order}
        return {"size": size, **place}

    def __repr__(self) -> str:
        harmonic = ",".join(map(str, self.harmonic))
        place = f"mode {self.mode}, harmonic ({harmonic})"
        return f"{self.size:.2g} at {place}, order {self.order}"


class Divisors(ABC):
    """The multipliers L_q(nu) of a chain and its chosen frequencies, in the ring of the series."""

    @abstractmethod
    def multipliers(self, harmonics: Ints, carried: NDArray[np.bool_], order: int) -> Any:
        """L_q(nu) where the selection rules let mode q carry nu.

        Zero elsewhere and in the gauge term nu = e_q of a seed.

        harmonics : (H, s). carried : (H, C), as the result, one column for each mode, or one for
        the waves of a ring. Raises where a divisor vanishes.
        """

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """The smallest divisors met so far, smallest first; none where they have no size."""
        return ()


class Float64Divisors(Divisors):
    """Multipliers as doubles, correct to a few units in the last place.

    That holds down to divisors of 1e-18; below they are less exact.

    Frequencies are split on a grid of doubles so coarse that nu.omega is summed without rounding;
    what the grid leaves over is carried separately. So Omega_q - |nu.omega| loses no digits where
    the two nearly cancel.
    """

    def __init__(self, chain: Chain, space: Modes, frequencies: Sequence[Fraction]) -> None:
        self.chain, self.space = chain, space
        self.frequencies = tuple(frequencies)
        largest_frequency = max(2.0, *(float(w) for w in frequencies))
        _, exponent = np.frexp(largest_frequency * (space.grading.degree + 1))
        self._grid = 52 - int(exponent)
        with mpmath.workdps(60):
            # by wave number, and after them those of the seeds
            linear = [chain.linear_frequency(q) for q in range(chain.N)]
            chosen = [mpf(w) for w in frequencies]
            self._base = self._split([*linear, *chosen])
            self._chosen = self._split(chosen)
            self._numerators = np.array([float(omega**2) for omega in linear])
        self._smallest: dict[tuple[int, tuple[int, ...]], SmallDivisor] = {}

    def _split(self, values: Sequence[Any]) -> tuple[Floats, Floats]:
        coarse, fine = [], []
        for value in values:
            whole = mpmath.nint(mpmath.ldexp(value, self._grid))
            on_grid = mpmath.ldexp(whole, -self._grid)
            coarse.append(float(on_grid))
            fine.append(float(value - on_grid))
        return np.array(coarse), np.array(fine)

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> Floats:
        """L_q(nu), (H, C).

        Raises ResonantDivisor where a divisor is exactly zero, or so small that doubles cannot
        tell it from zero, and for a resonance of a ring.
        """
        wanted = carried & ~self.space.gauge(harmonics)
        waves = self.space.wave_numbers(harmonics)
        if self.chain.periodic:
            refuse_resonances(self.chain, self.space, harmonics, wanted[:, 0], order)
        met = self.space.seeds_met(harmonics)
        own = np.where(met == NO_SEED, waves, self.chain.N + met)
        chosen, chosen_rest = self._chosen
        coarse = harmonics @ chosen
        fine = harmonics @ chosen_rest
        sign = np.where(coarse < 0, -1.0, 1.0)
        drive = (sign * coarse)[:, None]
        drive_rest = (sign * fine)[:, None]
        base, base_rest = (part[own] for part in self._base)
        difference = (base - drive) + (base_rest - drive_rest)
        divisors = difference * ((base + drive) + (base_rest + drive_rest))
        places = np.broadcast_to(waves, wanted.shape)
        self._refuse_zero(harmonics, places, wanted, difference, order)
        self._remember(harmonics, places, wanted, np.abs(divisors), order)
        table, numerators = np.zeros_like(divisors), self._numerators[waves]
        return np.asarray(np.divide(numerators, divisors, out=table, where=wanted))

    def _refuse_zero(
        self,
        harmonics: Ints,
        waves: Ints,
        wanted: NDArray[np.bool_],
        difference: Floats,
        order: int,
    ) -> None:
        resolution = 2.0 ** -(self._grid + 40)
        near_zero = np.abs(difference) < 2.0 ** (4 - self._grid)
        for row, column in np.argwhere(wanted & near_zero):
            harmonic, mode = self.space.named(harmonics[row], waves[row, column])
            seeds = self.space.seeds
            exact = vanishes(self.chain, seeds, self.frequencies, mode, harmonic)
            if exact or abs(difference[row, column]) < resolution:
                raise ResonantDivisor(mode, harmonic, seeds, order, exact=exact)

    def _remember(
        self,
        harmonics: Ints,
        waves: Ints,
        wanted: NDArray[np.bool_],
        sizes: Floats,
        order: int,
    ) -> None:
        candidates = np.where(wanted, sizes, np.inf).ravel()
        # some may be there already
        count = min(len(candidates), SMALLEST_KEPT + len(self._smallest))
        smallest = np.argpartition(candidates, count - 1)[:count] if count else ()
        for at in smallest:
            if np.isfinite(candidates[at]):
                row, column = divmod(int(at), self.space.columns)
                harmonic, mode = self.space.named(harmonics[row], waves[row, column])
                found = SmallDivisor(float(candidates[at]), mode, harmonic, order)
                self._smallest.setdefault((mode, harmonic), found)
        by_size = sorted(self._smallest.items(), key=lambda item: item[1].size)
        self._smallest = dict(by_size[:SMALLEST_KEPT])

    def smallest(self) -> tuple[SmallDivisor, ...]:
        """The smallest divisors met so far, smallest first."""
        return tuple(self._smallest.values())


class FixedPointDivisors(Divisors):
    """Multipliers as integers, 2^bits L rounded down.

    They come from exact frequencies and from linear ones of so many places that divisors above
    2^-depth leave no more than 2^-20 of a unit to the rounding down.
    """

    def __init__(
        self,
        chain: Chain,
        space: CosineModes,
        frequencies: Sequence[Fraction],
        bits: int,
        *,
        least: float = 0.0,
    ) -> None:
        """least : the smallest divisor, as doubles know it; 0 for any above 2^-bits."""
        self.chain, self.space = chain, space
        self.frequencies = tuple(frequencies)
        self.bits = bits
        self.known: dict[int, Floats] = {}  # moduli of multipliers, by order
        self._rows = HarmonicRows()  # of the two tables of multipliers found so far
        self._found = np.zeros((0, chain.N - 1), dtype=object)
        self._sizes = np.zeros(
            (0, chain.N - 1)
        )  # their moduli; zero where there is none yet
        self._depth = min(bits, 2 - frexp(least)[1]) if least else bits
        # a divisor is off by two units, and enters squared; numerators are at most 4
        self._places = bits + 2 * max(self._depth, 0) + 32
        self._common = lcm(*(w.denominator for w in frequencies))
        whole_frequencies = [int(w * self._common) for w in frequencies]
        self._omega = np.array(whole_frequencies, dtype=object)
        linear = []
        with mpmath.workprec(self._places + 32):
            for q in range(1, chain.N):
                square = mpmath.ldexp(chain.linear_frequency(q) ** 2, self._places)
                linear.append(int(mpmath.nint(square)))
        self._lambda = np.array(linear, dtype=object)
        self._numerators = self._lambda << bits
        for column, whole in zip(space.seed_columns, self._omega, strict=True):
            self._lambda[column] = self._squared(whole)

    def _squared(self, whole: Any) -> Any:
        square = whole * whole
        return (square << self._places) // self._common**2

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> NDArray[np.object_]:
        """2^bits L_q(nu) where the selection rules let mode q carry nu; shape (H, N-1).

        Zero elsewhere and in the gauge term.

        Raises ResonantDivisor where a divisor is zero or below 2^-bits, or 2^-depth.
        """
        wanted = carried & ~self.space.gauge(harmonics)
        rows = self._rows.of(harmonics)
        self._found = extended(self._found, len(self._rows), 0)
        self._sizes = extended(self._sizes, len(self._rows), 0.0)
        missing = wanted & (self._sizes[rows] == 0)
        self._find(harmonics, rows, missing, order)
        self.known[order] = np.where(wanted, self._sizes[rows], 0.0)
        return np.where(wanted, self._found[rows], 0)

    def _find(
        self, harmonics: Ints, own: Ints, missing: NDArray[np.bool_], order: int
    ) -> None:
        """Multipliers that no lower order had. own : the rows of the harmonics."""
        rows, columns = np.nonzero(missing)
        drives = harmonics.astype(object) @ self._omega
        divisors = self._lambda[columns] - self._squared(drives)[rows]
        smallest_allowed = 1 << (self._places - self._depth)
        for at in np.flatnonzero(np.abs(divisors) < smallest_allowed):
            mode, seeds = int(columns[at]) + 1, self.space.seeds
            harmonic = tuple(map(int, harmonics[rows[at]]))
            exact = vanishes(self.chain, seeds, self.frequencies, mode, harmonic)
            raise ResonantDivisor(mode, harmonic, seeds, order, exact=exact)
        multipliers = self._numerators[columns] // divisors
        moduli = np.abs((multipliers / 2**self.bits).astype(np.float64))
        self._found[own[rows], columns] = multipliers
        # more than the rounding to a double
        self._sizes[own[rows], columns] = moduli * (1 + 1e-12)

    def moduli(self) -> MultiplierModuli:
        """The same multipliers by their moduli, as doubles not below them."""
        return MultiplierModuli(self)


class MultiplierModuli(Divisors):
    """Upper bounds of |L_q(nu)| as doubles, from fixed-point multipliers."""

    def __init__(self, divisors: FixedPointDivisors) -> None:
        self._divisors = divisors

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> Floats:
        """|L_q(nu)|, enlarged by more than the rounding to a double; shape (H, N-1).

        Those of an order that was asked for before are remembered.
        """
        if order not in self._divisors.known:
            self._divisors.multipliers(harmonics, carried, order)
        return self._divisors.known[order]


class EnlargedMultipliers(Divisors):
    """Moduli of multipliers in doubles, a little enlarged, to be compared with proved ones."""

    enlarged = 1 + 2.0**-28
    most = 1 + 2.0**-26  # that one may be above a proved one

    def __init__(self, divisors: Float64Divisors) -> None:
        self._divisors = divisors
        self._by_order: dict[int, Floats] = {}

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> Floats:
        """|L_q(nu)|, enlarged; shape (H, N-1)."""
        table = np.abs(self._divisors.multipliers(harmonics, carried, order))
        self._by_order[order] = table * self.enlarged
        return self._by_order[order]

    def cover(self, proved: FixedPointDivisors) -> bool:
        """Whether all are upper bounds of proved ones, and near to them."""
        pairs = [(own, proved.known[order]) for order, own in self._by_order.items()]
        return all(bool(((b <= a) & (a <= b * self.most)).all()) for a, b in pairs)


class ResidueDivisors(Divisors):
    """Multipliers modulo a prime, at a point where the chosen frequencies are residues.

    Raises VanishingResidue where a divisor is zero modulo the prime: nothing follows from such a
    point, take another.
    """

    def __init__(
        self,
        chain: Chain,
        space: CosineModes,
        ring: ResidueRing,
        frequencies: Sequence[int],
    ) -> None:
        self.space, self.ring = space, ring
        cosines = cosine_table(chain.N, ring.prime, ring.root)
        squares = [ring.element(2 - 2 * cosines[2 * q]) for q in range(1, chain.N)]
        self._numerators = np.array(squares)
        self._lambda = self._numerators.copy()
        for column, omega in zip(space.seed_columns, frequencies, strict=True):
            self._lambda[column] = ring.element(omega * omega)
        self._omega = [int(w) for w in frequencies]

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> Floats:
        """L_q(nu) modulo the prime.

        Zero where the selection rules keep nu from mode q, and in the gauge term.
        """
        ring = self.ring
        wanted = carried & ~self.space.gauge(harmonics)
        residues = []
        for nu in harmonics:
            drive = sum(int(n) * w for n, w in zip(nu, self._omega, strict=True))
            residues.append(ring.element(drive))
        drives = np.array(residues)
        squares = ring.products(drives, drives)[:, None]
        divisors = ring.reduced(self._lambda - squares)
        if np.any(wanted & (divisors == 0)):
            raise VanishingResidue(ring.prime, order)
        quotients = ring.products(ring.inverses(divisors), self._numerators)
        return np.where(wanted, quotients, 0.0)


class UniversalDivisors(Divisors):
    """Multipliers as symbols L_q(nu): the universal form.

    It holds for every chain and all generic frequencies at once.
    """

    def __init__(self, space: CosineModes) -> None:
        self.space = space

    def multipliers(
        self, harmonics: Ints, carried: NDArray[np.bool_], order: int
    ) -> NDArray[np.object_]:
        """Symbols L_q(nu), zero where the selection rules or the gauge leave nothing.

        Shape (H, N-1).
        """
        gauge = self.space.gauge(harmonics)
        table = np.full(carried.shape, se.Integer(0), dtype=object)
        for row, column in np.argwhere(carried & ~gauge):
            nu = [int(n) for n in harmonics[row]]
            table[row, column] = multiplier_symbol(int(column) + 1, nu)
        return table


def vanishes(
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Sequence[Fraction],
    mode: int,
    harmonic: Sequence[int],
) -> bool:
    """Whether lambda_mode = (nu.omega)^2 for the exact rational frequencies.

    A linear frequency 2 sin(q pi / 2N) is rational only if it is 1, for q = N/3, or, on a ring of N
    for 2N, 2, for q = N/2 (Niven).
    """
    drive = _drive(harmonic, frequencies)
    if mode in seeds:
        own = frequencies[list(seeds).index(mode)]
        return abs(drive) == own
    parts_of_a_turn = Fraction(abs(mode), chain.turn)
    rational = {Fraction(1, 6): 1, Fraction(1, 2): 2}.get(parts_of_a_turn)
    return abs(drive) == rational


def divisor(
    chain: Chain,
    seeds: Sequence[int],
    frequencies: Sequence[Fraction],
    mode: int,
    harmonic: Sequence[int],
) -> float:
    """lambda_q - (nu.omega)^2 of one mode and harmonic, correctly rounded."""
    drive = _drive(harmonic, frequencies)
    with mpmath.workdps(60):
        base = chain.linear_frequency(mode)
        for own in (mode, -mode):  # two waves of a ring
            if own in seeds:
                base = mpf(frequencies[list(seeds).index(own)])
                break
        return float(base**2 - mpf(drive) ** 2)


def _drive(harmonic: Sequence[int], frequencies: Sequence[Fraction]) -> Fraction:
    """nu.omega, exactly."""
    parts = [n * w for n, w in zip(harmonic, frequencies, strict=True)]
    return sum(parts, start=Fraction(0))
