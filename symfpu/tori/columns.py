"""What the columns of the coefficients of a torus stand for: three kinds of motion.

A torus has coefficients c (H, C) of cos(nu.theta), a row for every harmonic nu and C columns.

- Fixed ends: a column for every mode, Q_q = sum c_q[nu] cos(nu.theta).
- Standing waves of a ring of N = 2N': the columns are the modes of the chain of N' bonds with fixed
  ends whose odd extension they are, x_(N-j) = -x_j.
- Travelling waves of a ring: the harmonic nu lives in the wave m = nu.seeds alone, one column,

    x_j = N^(-1/2) sum +-c[nu] sin(2 pi m j / N - nu.theta),

  with the sign of sin(pi m / N), so that c[nu] Omega_m is that of the stretches of the bonds.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES, Arithmetic, Numbers
from symfpu.results.grid import Variable
from symfpu.tori.grid_sums import grid_sums

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 4_000_000  # entries of a table of cosines held at once


class Columns(ABC):
    """Mode coordinates of a chain from the coefficients of a torus at its harmonics.

    chain : the model. seeds, harmonics : of the torus; (s,), (H, s).
    """

    def __init__(self, chain: Chain, seeds: Sequence[int], harmonics: Ints) -> None:
        self.chain, self.seeds, self.harmonics = chain, tuple(seeds), harmonics

    @property
    @abstractmethod
    def count(self) -> int:
        """C."""

    @property
    @abstractmethod
    def columns(self) -> dict[str, Sequence[int]]:
        """The axis of the columns in a table, by its name; none for a single column."""

    @abstractmethod
    def variables(self, coefficients: Numbers) -> dict[str, Variable]:
        """Coefficients (H, C) and what they are of, for a table."""

    @abstractmethod
    def linear(self, numbers: Arithmetic = DOUBLES) -> Numbers:
        """Linear frequencies of the coefficients; (H | 1, C)."""

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Which harmonics move anything, (H,)."""
        return np.ones(len(self.harmonics), dtype=bool)

    @abstractmethod
    def column(self, q: int) -> int:
        """That of the mode q at its own harmonic."""

    @abstractmethod
    def mode_of(self, row: int, column: int) -> int:
        """The mode of the chain that a coefficient moves."""

    @abstractmethod
    def of_mode(self, q: int, table: Numbers) -> Numbers:
        """Those entries of a table (H, C) that move the mode q or -q; one-dimensional."""

    @abstractmethod
    def modes(
        self,
        angles: Numbers,
        tables: Sequence[Numbers],
        numbers: Arithmetic = DOUBLES,
        *,
        sine: bool = False,
    ) -> list[Numbers]:
        """Mode coordinates (P, N-1) of each table of coefficients (H, C) of cos(nu.theta).

        angles : nu.theta, (P, H). sine : whether the coefficients are of sin(nu.theta).
        """

    @abstractmethod
    def averages(
        self,
        T: float | None,
        coefficients: Numbers,
        frequencies: Sequence[Fraction],
        offsets: Numbers,
        numbers: Arithmetic = DOUBLES,
    ) -> Numbers:
        """Averages of E_q of the modes of the chain from t = 0 to T, in doubles; (N-1,).

        T : None for those over all times. frequencies : by seed, exact. offsets : nu.phi, (H,).
        """


class ModeColumns(Columns):
    """Fixed ends: the modes themselves."""

    @property
    def count(self) -> int:
        return self._fixed.N - 1

    @property
    def columns(self) -> dict[str, Sequence[int]]:
        return {"mode": self.chain.mode_numbers}

    def variables(self, coefficients: Numbers) -> dict[str, Variable]:
        cosine = "coefficient of cos(nu.(omega t + phi)) in Q_q"
        return {"cosine": Variable(("harmonic", *self.columns), coefficients, cosine)}

    @property
    def _fixed(self) -> Chain:
        """The chain with fixed ends whose modes they are."""
        return self.chain

    def linear(self, numbers: Arithmetic = DOUBLES) -> Numbers:
        return self._fixed.frequencies(numbers)[None]

    def column(self, q: int) -> int:
        return abs(q) - 1

    def mode_of(self, row: int, column: int) -> int:
        return column + 1

    def of_mode(self, q: int, table: Numbers) -> Numbers:
        return table[:, self.column(q)]

    def modes(
        self,
        angles: Numbers,
        tables: Sequence[Numbers],
        numbers: Arithmetic = DOUBLES,
        *,
        sine: bool = False,
    ) -> list[Numbers]:
        function = numbers.sin if sine else numbers.cos
        sums = numbers.dot(function(angles), np.hstack(tables))
        return [self._of_chain(part) for part in np.hsplit(sums, len(tables))]

    def modes_on_grid(self, tables: Sequence[Numbers], number: int) -> list[Numbers]:
        """The same at all points of a tensor grid, so many for each angle, by FFT in doubles."""
        sums = grid_sums(self.harmonics, np.hstack(tables), number)
        return [self._of_chain(part) for part in np.hsplit(sums, len(tables))]

    def _of_chain(self, sums: Numbers) -> Numbers:
        """Modes of the chain of sums (P, C); (P, N-1)."""
        return sums

    def _by_mode(self, values: Numbers) -> Numbers:
        """Energies of the columns by mode of the chain, (N-1,)."""
        return values

    def averages(
        self,
        T: float | None,
        coefficients: Numbers,
        frequencies: Sequence[Fraction],
        offsets: Numbers,
        numbers: Arithmetic = DOUBLES,
    ) -> Numbers:
        rates = self.harmonics @ np.array([numbers.number(w) for w in frequencies])
        if T is None:
            return self._by_mode(self._over_all_times(coefficients, rates, numbers))
        return self._by_mode(self._until(T, coefficients, rates, offsets))

    def _over_all_times(
        self, coefficients: Numbers, rates: Numbers, numbers: Arithmetic
    ) -> Numbers:
        """(1/4) sum c^2 ((nu.omega)^2 + Omega^2) over nu != 0 plus the constant term."""
        weights = np.where((self.harmonics != 0).any(axis=1), 0.5, 1.0)
        squares = coefficients**2
        kinetic = (weights * rates**2) @ squares
        linear = self.linear(numbers)[0]
        return np.asarray(0.5 * (kinetic + linear**2 * (weights @ squares)))

    def _until(
        self, T: float, coefficients: Floats, rates: Floats, offsets: Floats
    ) -> Floats:
        linear = self.linear()[0]
        velocity = rates[:, None] * coefficients
        total = np.zeros(self.count)
        step = max(1, CHUNK // len(self.harmonics))
        for i in range(0, len(self.harmonics), step):
            rows = slice(i, i + step)
            difference = mean_cosine(
                rates[rows, None] - rates, offsets[rows, None] - offsets, T
            )
            sums = mean_cosine(rates[rows, None] + rates, offsets[rows, None] + offsets, T)
            total += np.einsum("hq,hq->q", velocity[rows], (difference - sums) @ velocity)
            squares = (difference + sums) @ coefficients
            total += linear**2 * np.einsum("hq,hq->q", coefficients[rows], squares)
        return total / 4


class StandingColumns(ModeColumns):
    """Standing waves of a ring of even length: the modes of half of it, with fixed ends."""

    @property
    def columns(self) -> dict[str, Sequence[int]]:
        """Modes of the chain with fixed ends."""
        return {"standing": range(1, self.count + 1)}

    @cached_property
    def _fixed(self) -> Chain:
        return half_of(self.chain)

    @cached_property
    def _places(self) -> tuple[list[int], list[int]]:
        """Of the modes 1 .. C and of their opposites among those of the ring."""
        place = self.chain.kind_of_ends.place
        numbers = range(1, self.count + 1)
        return [place(q) for q in numbers], [place(-q) for q in numbers]

    def _of_chain(self, sums: Numbers) -> Numbers:
        """(2/N')^(1/2) c sin(pi q j/N') is N^(-1/2) (c / i) (e^(2 pi i q j/N) - conjugate)."""
        shape, nothing = (len(sums), self.chain.N - 1), 0j * sums.flat[0]
        found = np.full(shape, nothing)
        forward, backward = self._places
        found[:, forward], found[:, backward] = -1j * sums, 1j * sums
        return found

    def _by_mode(self, values: Numbers) -> Numbers:
        """By mode of the ring: q and -q share the energy of the standing wave q equally."""
        found = np.full(self.chain.N - 1, 0 * values[0])
        for places in self._places:
            found[places] = values
        return found


class WaveColumns(Columns):
    """Travelling waves of a ring: one column.

    waves : m = nu.seeds of every harmonic, (H,).
    """

    @property
    def count(self) -> int:
        return 1

    @property
    def columns(self) -> dict[str, Sequence[int]]:
        return {}

    def variables(self, coefficients: Numbers) -> dict[str, Variable]:
        cosine = "of N^(-1/2) sin(2 pi m j / N - nu.theta) in x_j, times the sign of sin(pi m / N)"
        return {
            "wave_number": Variable(("harmonic",), self.waves, "m of the wave"),
            "cosine": Variable(("harmonic",), coefficients[:, 0], f"coefficient {cosine}"),
        }

    @cached_property
    def waves(self) -> Ints:
        return np.asarray(self.harmonics @ np.array(self.seeds))

    @property
    def moving(self) -> NDArray[np.bool_]:
        """All but those of m = 0, uniform motion."""
        return np.asarray(self.waves % self.chain.N != 0)

    @property
    def signs(self) -> Ints:
        """Of sin(pi m / N); (H,)."""
        return np.where(self.waves // self.chain.N % 2 == 0, 1, -1)

    def linear(self, numbers: Arithmetic = DOUBLES) -> Numbers:
        sizes = dict(
            zip(self.chain.mode_numbers, self.chain.frequencies(numbers), strict=True)
        )
        last = self.chain.N // 2
        nearest = (last - (last - self.waves) % self.chain.N).tolist()
        return np.array([[sizes.get(m, sizes.get(-m, 0 * self.signs[0]))] for m in nearest])

    def column(self, q: int) -> int:
        return 0

    def mode_of(self, row: int, column: int) -> int:
        m = int(self.waves[row]) % self.chain.N
        return m - self.chain.N if 2 * m > self.chain.N else m

    def of_mode(self, q: int, table: Numbers) -> Numbers:
        """Harmonics of that wave number, of any sign."""
        N, waves = self.chain.N, self.waves % self.chain.N
        return np.asarray(table[(waves == q % N) | (waves == -q % N), 0])

    @cached_property
    def _to_modes(self) -> tuple[Any, Any]:
        """To which modes e^(-i nu.theta) and its conjugate belong, sparse; (H, N-1) each."""
        from scipy.sparse import csr_matrix

        matrices = []
        for waves in (self.waves, -self.waves):
            places = self._places(waves)
            rows = np.flatnonzero(places >= 0)
            entries = (np.ones(len(rows)), (rows, places[rows]))
            shape = (len(waves), self.chain.N - 1)
            matrices.append(csr_matrix(entries, shape=shape))
        return matrices[0], matrices[1]

    def _places(self, waves: Ints) -> Ints:
        """Of waves among the modes of the chain, -1 for m = 0, uniform motion."""
        places = np.full(self.chain.N, -1)
        places[np.array(self.chain.mode_numbers)] = np.arange(self.chain.N - 1)
        return places[waves % self.chain.N]

    def modes(
        self,
        angles: Numbers,
        tables: Sequence[Numbers],
        numbers: Arithmetic = DOUBLES,
        *,
        sine: bool = False,
    ) -> list[Numbers]:
        """sin(a - nu.theta) is -i/2 e^(i a) e^(-i nu.theta) and its conjugate."""
        if numbers is not DOUBLES:
            return [self._in_digits(angles, table, numbers, sine) for table in tables]
        forward, backward = self._to_modes
        quarter = 1.0 if sine else -1j  # e^(-i (nu.theta - pi/2)) is i e^(-i nu.theta)
        turning = np.exp(-1j * angles)
        found = []
        for table in tables:
            waves = turning * (0.5 * quarter * self.signs * table[:, 0])
            found.append(np.asarray(waves @ forward + waves.conj() @ backward))
        return found

    def _in_digits(
        self, angles: Numbers, table: Numbers, numbers: Arithmetic, sine: bool
    ) -> Numbers:
        """Mode coordinates (P, N-1) of one table as mpc; arguments as of `modes`."""
        waves = self._turning(angles, numbers, sine) * (self.signs * table[:, 0])
        total = np.full((len(angles), self.chain.N - 1), mpmath.mpc(0), dtype=object)
        pairs = zip(self._places(self.waves), self._places(-self.waves), strict=True)
        for wave, (forward, backward) in enumerate(pairs):
            if forward >= 0:
                total[:, forward] += waves[:, wave]
                total[:, backward] += np.conjugate(waves[:, wave])
        return total

    def _turning(self, angles: Numbers, numbers: Arithmetic, sine: bool = False) -> Numbers:
        """-i e^(-i nu.theta) / 2, or e^(-i nu.theta) / 2 for sines."""
        cosines, sines = numbers.cos(angles) / 2, numbers.sin(angles) / 2
        if sine:
            return np.asarray(cosines - 1j * sines)
        return np.asarray(-sines - 1j * cosines)

    def averages(
        self,
        T: float | None,
        coefficients: Numbers,
        frequencies: Sequence[Fraction],
        offsets: Numbers,
        numbers: Arithmetic = DOUBLES,
    ) -> Numbers:
        """Averages of E_q.

        Waves of one mode whose rates coincide exactly interfere, as two opposite waves of one
        frequency do.
        """
        rates = [_rate(nu, frequencies) for nu in self.harmonics.tolist()]
        sizes = self.signs * coefficients[:, 0] * self._turning(offsets, numbers)
        terms: dict[int, dict[Fraction, Any]] = {}
        both = (self.waves, sizes, 1), (-self.waves, np.conjugate(sizes), -1)
        for waves, values, sign in both:
            for place, rate, value in zip(self._places(waves), rates, values, strict=True):
                if place >= 0:
                    own = terms.setdefault(int(place), {})
                    own[sign * rate] = own.get(sign * rate, 0) + value
        linear = self.chain.frequencies(numbers)
        average = numbers.zeros((self.chain.N - 1,))
        for place, own in terms.items():
            sums, turns = (
                np.array(list(own.values())),
                np.array(list(map(numbers.number, own))),
            )
            kinetic = _mean_square(turns * sums, turns, T)
            average[place] = (
                kinetic + linear[place] ** 2 * _mean_square(sums, turns, T)
            ) / 2
        return average


def mean_cosine(rate: Floats, phase: Floats, T: float) -> Floats:
    """(1/T) times the integral of cos(rate t + phase) over 0 .. T, stable for every rate."""
    half = rate * (T / 2)
    return np.asarray(np.sinc(half / np.pi) * np.cos(half + phase))


def _mean_square(values: Numbers, rates: Numbers, T: float | None) -> Any:
    """The average of |sum of values e^(-i rate t)|^2 from 0 to T, or for all times."""
    if T is None:
        return (np.abs(values) ** 2).sum()
    step, total = max(1, CHUNK // len(rates)), 0.0
    for i in range(0, len(rates), step):
        half = (rates[i : i + step, None] - rates) * (T / 2)
        means = np.sinc(half / np.pi) * np.exp(-1j * half)
        total += float((values[i : i + step] @ means @ values.conj()).real)
    return total


def _rate(nu: list[int], frequencies: Sequence[Fraction]) -> Fraction:
    """nu.omega, exactly."""
    parts = [n * w for n, w in zip(nu, frequencies, strict=True)]
    return sum(parts, start=Fraction(0))


def half_of(ring: Chain) -> Chain:
    """The chain with fixed ends whose odd extension a ring of twice its length is."""
    return Chain(ring.N // 2, potential=ring.potential)


def require_columns(
    chain: Chain,
    seeds: Sequence[int],
    harmonics: Ints,
    coefficients: Numbers,
    *,
    travels: bool,
) -> None:
    """InputError where coefficients are not those of a torus of this chain, as `columns_of`."""
    if travels and not chain.periodic:
        advice = "leave travels= out, or take a chain with ends='periodic'"
        raise InputError("travels", travels, "False with fixed ends", advice)
    half = chain.N // 2
    if chain.periodic and not travels:
        given = f"standing waves of the seeds {tuple(seeds)} on a ring of {chain.N}"
        if chain.N % 2 or chain.N < 4 or any(not 0 < q < half for q in seeds):
            allowed = "those that unfold makes: N even, 4 or more, and seeds below N/2"
            raise InputError("travels", given, allowed, "pass travels=True for waves")
    count = columns_of(chain, seeds, harmonics, travels=travels).count
    if np.shape(coefficients) != (len(harmonics), count):
        allowed = f"{(len(harmonics), count)}: harmonics by columns"
        advice = "pass travels=True for travelling waves, which have one column"
        raise InputError("cosines", np.shape(coefficients), allowed, advice)


def columns_of(
    chain: Chain, seeds: Sequence[int], harmonics: Ints, *, travels: bool
) -> Columns:
    """Those of a torus. travels : of a ring, whether its waves do."""
    if not chain.periodic:
        return ModeColumns(chain, seeds, harmonics)
    kind = WaveColumns if travels else StandingColumns
    return kind(chain, seeds, harmonics)
