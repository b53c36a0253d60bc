"""Tori of a ring: travelling waves at given frequencies, standing ones from fixed ends.

Both are sums of waves, x_j = N^(-1/2) sum b sin(2 pi m j / N - nu.theta).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.grading import Ints
from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.frames.attributes import RADIANS, attributes
from symfpu.frames.grid import Grid, Variable
from symfpu.frames.tabled import Gridded
from symfpu.notebook import Shown
from symfpu.numbers.arithmetic import Numbers
from symfpu.numbers.typed import integer
from symfpu.series.travelling import TravellingSeries
from symfpu.tori.amplitudes import (
    by_seed,
    first_shifting_order,
    frequency_orders,
    history_of,
    order_argument,
    order_doubts,
    root_squares,
    square_roots,
    start_of,
)
from symfpu.tori.quasiperiodic import QuasiPeriodic, amplitudes_of, require_solution

Floats = NDArray[np.float64]
Waves = NDArray[np.complex128]
Value = TypeVar("Value")
GRID_POINTS = 1024  # angles at which a residual is taken, about
CHUNK = 256  # angles held at once


@dataclass(frozen=True, eq=False)
class RingTorus(Shown, Gridded):
    """A torus of a ring of N particles, as a sum of waves; doubles, dimensionless.

    x_j(t) = N^(-1/2) sum b sin(2 pi m j / N - nu.theta), theta = omega t + phi. Ours; made by
    `travelling_torus` and `unfold`.

    chain : with ends="periodic". seeds, frequencies, phases, amplitudes : of the s angles,
        frequencies exact, the others by seed; A_q as in `TravellingSeries`.
    harmonics : nu of every wave, shape (W, s). modes : its m, any whole number, shape (W,).
        sines : its b, shape (W,).
    frequency_order, order : truncations of the series it is from, None where there is none.
    warnings : reasons to doubt that it is a torus.

    >>> from symfpu import Chain, travelling_torus, travelling_waves
    >>> chain = Chain(N=8, alpha="0.3", ends="periodic")
    >>> travelling_torus(travelling_waves(chain, (1,), ("0.766",), 8))
    RingTorus(N=8, alpha=0.3, ends='periodic', A_1=..., H=..., residual ...)
    >>> list(travelling_torus(travelling_waves(chain, (1,), ("0.766",), 8)).to_frame())
    ['wave', 'nu_1', 'wave_number', 'sine']
    """

    chain: Chain
    seeds: tuple[int, ...]
    frequencies: tuple[Fraction, ...]
    phases: Mapping[int, float]
    amplitudes: Mapping[int, float]
    harmonics: Ints = field(repr=False)
    modes: Ints = field(repr=False)
    sines: Floats = field(repr=False)
    frequency_order: int | None = None
    order: int | None = None
    warnings: tuple[str, ...] = ()

    digits = None

    @property
    def omega(self) -> dict[int, Fraction]:
        """The frequencies by seed, as the amplitudes are; exact."""
        return dict(zip(self.seeds, self.frequencies, strict=True))

    def __repr__(self) -> str:
        chain = repr(self.chain).removeprefix("Chain(").removesuffix(")")
        found = ", ".join(f"A_{q}={a:.12g}" for q, a in self.amplitudes.items())
        quality = f"H={float(self.energy()):.10g}, residual {self.residual():.2g}"
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        return f"RingTorus({chain}, {found}, {quality}{doubts})"

    @cached_property
    def _omega(self) -> Floats:
        return np.array([float(w) for w in self.frequencies])

    @cached_property
    def _rates(self) -> Floats:
        return np.asarray(self.harmonics @ self._omega)

    @cached_property
    def _to_modes(self) -> tuple[Any, Any]:
        """What e^(-i nu.theta) and its conjugate give to Q_q; sparse, (waves, modes)."""
        from scipy.sparse import csr_matrix

        N, numbers = self.chain.N, self.chain.mode_numbers
        place = np.full(N, -1)
        place[np.array(numbers)] = np.arange(N - 1)
        rows = np.arange(len(self.modes))
        halves = -0.5j * self.sines
        matrices = []
        for columns, values in ((self.modes, halves), (-self.modes, halves.conj())):
            at = place[columns % N]
            moves = at >= 0
            entries = (values[moves], (rows[moves], at[moves]))
            matrices.append(csr_matrix(entries, shape=(len(rows), N - 1)))
        return matrices[0], matrices[1]

    def _sums(self, theta: Floats, weights: Numbers | float = 1.0) -> Waves:
        """Modes at angles (P, s), each wave times a weight of its own and of its conjugate."""
        forward, backward = self._to_modes
        waves = np.exp(-1j * (theta @ self.harmonics.T)) * weights
        return np.asarray(waves @ forward + waves.conj() @ backward)

    def _along(self, t: ArrayLike, weights: Numbers | float = 1.0) -> Waves:
        times = np.asarray(t, dtype=float)
        if times.ndim > 1 or not np.isfinite(times).all():
            allowed = "a finite number or a one-dimensional array of them"
            raise InputError("t", t, allowed, "flatten it")
        theta = times.reshape(-1, 1) * self._omega + self._offsets()
        values = self._sums(theta, weights)
        return np.asarray(values[0] if times.ndim == 0 else values)

    def _offsets(self) -> Floats:
        return np.array([self.phases[q] for q in self.seeds])

    def mode_coordinates(self, t: ArrayLike) -> Waves:
        """Q_q(t) of chain.mode_numbers; t a number or (T,), result (N-1,) or (T, N-1), complex."""
        return self._along(t)

    def mode_momenta(self, t: ArrayLike) -> Waves:
        """P_q(t) = dQ_q/dt; t a number or (T,), result (N-1,) or (T, N-1), complex."""
        return self._along(t, -1j * self._rates)

    def state(self) -> tuple[Waves, Waves]:
        """Q and P of its modes at t = 0, (N-1,) each and complex, as `integrate` takes them."""
        return self.mode_coordinates(0.0), self.mode_momenta(0.0)

    def positions(self, t: ArrayLike) -> Floats:
        """Displacements x_0 .. x_(N-1); t a number or (T,), result (N,) or (T, N)."""
        return self.chain.positions(self.mode_coordinates(t))

    def momenta(self, t: ArrayLike) -> Floats:
        """Momenta of the particles; t a number or (T,), result (N,) or (T, N)."""
        return self.chain.positions(self.mode_momenta(t))

    def energy(self, t: ArrayLike = 0.0) -> Any:
        """Total energy H at t, a number or (T,); constant in time for an exact torus."""
        return self.chain.energy(self.mode_coordinates(t), self.mode_momenta(t))[()]

    def harmonic_energies(self, t: ArrayLike = 0.0) -> Floats:
        """E_q = (|P_q|^2 + Omega_q^2 |Q_q|^2)/2 at t; (N-1,) or (T, N-1)."""
        return self.chain.harmonic_energies(self.mode_coordinates(t), self.mode_momenta(t))

    def average_spectrum(self) -> Floats:
        """Infinite-time averages of E_q, shape (N-1,), in closed form.

        Waves of one mode whose exact rates coincide, as those of a standing wave, interfere.
        """
        sums: dict[tuple[int, Fraction], complex] = {}
        for column, rate, value in self._mode_waves():
            sums[column, rate] = sums.get((column, rate), 0) + value
        linear = self.chain.frequencies()
        average = np.zeros(self.chain.N - 1)
        for (column, rate), value in sums.items():
            weight = float(rate) ** 2 + linear[column] ** 2
            average[column] += 0.5 * weight * abs(value) ** 2
        return average

    def _mode_waves(self) -> Iterator[tuple[int, Fraction, complex]]:
        """All terms c e^(-i rate t) of the modes: place of the mode, exact rate, c."""
        turned = np.exp(-1j * (self.harmonics @ self._offsets()))
        rates = [_rate(nu, self.frequencies) for nu in self.harmonics.tolist()]
        parts = zip(self._to_modes, (turned, turned.conj()), (1, -1), strict=True)
        for matrix, factors, sign in parts:
            table = matrix.tocoo()
            for row, column, value in zip(table.row, table.col, table.data, strict=True):
                yield int(column), sign * rates[row], complex(value * factors[row])

    @property
    def seed(self) -> int:
        """The seed mode of a solution of one angle; raises InputError for more."""
        return self._only("seed", self.seeds)

    @property
    def frequency(self) -> Fraction:
        """omega of a solution of one angle, exact; raises InputError for more."""
        return self._only("frequency", self.frequencies)

    @property
    def amplitude(self) -> float:
        """A of a solution of one angle; raises InputError for more."""
        return self._only("amplitude", tuple(self.amplitudes.values()))

    def _only(self, name: str, values: tuple[Value, ...]) -> Value:
        if len(self.seeds) > 1:
            given, allowed = (
                f"of {len(self.seeds)} angles",
                "that of a solution of one angle",
            )
            raise InputError(name, given, allowed, "use seeds, frequencies and amplitudes")
        return values[0]

    def residual(self, points: int | None = None) -> float:
        """Largest |d^2Q_q/dt^2 - force| on a grid of angles, over the largest force.

        points : grid points for each of the s angles; default such that the grid has about 1024.
        """
        if points is None:
            return self._residual
        return self._residual_of(integer(points, "points", 1))

    @cached_property
    def _residual(self) -> float:
        """The residual on the default grid, which every sentence on this torus states."""
        s = len(self.seeds)
        return self._residual_of(max(3, min(64, round(GRID_POINTS ** (1 / s)))))

    def _residual_of(self, number: int) -> float:
        """Infinite where a bond is beyond the wall of its potential.

        The linear force of a wave is taken with its second derivative, so that long rings, where
        neighbours move nearly alike, lose no digits.
        """
        worst = largest = 0.0
        squares = self.chain.frequencies() ** 2
        linear = 2 * np.sin(np.pi * self.modes / self.chain.N)
        for theta in self._angle_grid(number):
            Q = self._sums(theta)
            anharmonic = self.chain.anharmonic_accelerations(Q)
            off = self._sums(theta, linear**2 - self._rates**2) - anharmonic
            if not np.isfinite(off).all():
                return math.inf
            worst = max(worst, float(np.abs(off).max()))
            largest = max(largest, float(np.abs(anharmonic - squares * Q).max()))
        return worst / largest

    def energy_error(self) -> float:
        """The range of H over the same angles, over its mean: zero for an exact torus."""
        s = len(self.seeds)
        number = max(3, min(64, round(GRID_POINTS ** (1 / s))))
        energies = []
        for theta in self._angle_grid(number):
            Q, P = self._sums(theta), self._sums(theta, -1j * self._rates)
            energies.append(self.chain.energy(Q, P))
        H = np.concatenate(energies)
        return float((H.max() - H.min()) / abs(H.mean()))

    def _angle_grid(self, number: int) -> Iterator[Floats]:
        shape = (number,) * len(self.seeds)
        for start in range(0, number ** len(shape), CHUNK):
            index = np.arange(start, min(start + CHUNK, number ** len(shape)))
            digits = np.stack(np.unravel_index(index, shape), axis=-1)
            yield 2 * np.pi * (3 * digits + 1) / (3 * number)

    def _grid(self) -> Grid:
        seeds = ("seed",)
        phases = [self.phases[q] for q in self.seeds]
        amplitudes = [self.amplitudes[q] for q in self.seeds]
        sine = "coefficient of N^(-1/2) sin(2 pi m j / N - nu.theta) in x_j"
        average = "infinite-time average of the harmonic energy E_q"
        return Grid(
            axes={
                "wave": range(len(self.modes)),
                "mode": self.chain.mode_numbers,
                "seed": self.seeds,
            },
            variables={
                "nu": Variable(
                    ("wave", "seed"), self.harmonics, "factor of the angle of a seed"
                ),
                "wave_number": Variable(("wave",), self.modes, "m of the wave"),
                "sine": Variable(("wave",), self.sines, sine),
                "frequency": Variable(seeds, self._omega, "frequency omega_q of a seed"),
                "amplitude": Variable(seeds, amplitudes, "amplitude A_q of a seed"),
                "phase": Variable(seeds, phases, "angle at t = 0", RADIANS),
                "average_energy": Variable(("mode",), self.average_spectrum(), average),
            },
            attributes=attributes(
                self,
                self.chain,
                seeds=self.seeds,
                frequencies=self.frequencies,
                frequency_order=self.frequency_order,
                order=self.order,
                energy=self.energy(),
                warnings=self.warnings,
            ),
            rows=("wave",),
            across="seed",
        )


def _rate(nu: list[int], frequencies: tuple[Fraction, ...]) -> Fraction:
    """nu.omega, exactly."""
    parts = [n * w for n, w in zip(nu, frequencies, strict=True)]
    return sum(parts, start=Fraction(0))


def travelling_torus(
    series: TravellingSeries,
    *,
    frequency_order: int | None = None,
    order: int | None = None,
    phases: Mapping[int, float] | None = None,
    guess: Mapping[int, float] | None = None,
) -> RingTorus:
    """Travelling waves on a ring whose amplitudes give the frequencies of their series.

    Solves Eq. omeser, as `solve_amplitudes` does for fixed ends.

    series : of `travelling_waves`; dimensionless. frequency_order : K of the frequency series, up
        to series.order, the default. order : truncation of the coordinates, likewise.
    phases : by seed, radians; default 0. guess : amplitudes by seed; default none needed.

    Seeds q and -q of equal frequencies have equal amplitudes: a standing wave. Raises InputError,
    NoRealAmplitude, DidNotConverge, UndeterminedAmplitudes as `solve_amplitudes`.

    >>> from symfpu import Chain, travelling_waves
    >>> chain = Chain(N=16, alpha="0.3", ends="periodic")
    >>> torus = travelling_torus(travelling_waves(chain, (1, 3), ("0.391", "1.112"), 8))
    >>> {q: round(A, 4) for q, A in torus.amplitudes.items()}
    {1: 0.7282, 3: 0.4826}
    """
    if not isinstance(series, TravellingSeries):
        allowed = "a TravellingSeries"
        advice = "make one with travelling_waves(chain, seeds, frequencies, order)"
        raise InputError("series", type(series).__name__, allowed, advice)
    K = order_argument("frequency_order", frequency_order, series)
    last = order_argument("order", order, series)
    orders = [k for k in frequency_orders(series) if k <= K]
    if not orders:
        first = first_shifting_order(series.chain)
        allowed = f"{first} or more, the order of the first frequency correction"
        raise InputError("frequency_order", K, allowed, "compute a longer series")
    history = history_of(series)
    squares, _ = root_squares(series, orders[-1], start_of(series, orders, history, guess))
    amplitudes = square_roots(series, squares)
    harmonics, modes, sines = _waves(series, amplitudes, last)
    at_rest = dict.fromkeys(series.seeds, 0.0)
    return RingTorus(
        chain=series.chain,
        seeds=series.seeds,
        frequencies=series.frequencies,
        phases=at_rest | by_seed("phases", phases, series),
        amplitudes=dict(zip(series.seeds, amplitudes, strict=True)),
        harmonics=harmonics,
        modes=modes,
        sines=sines,
        frequency_order=K,
        order=last,
        warnings=order_doubts(amplitudes, orders, history),
    )


def cut_waves(series: TravellingSeries, torus: RingTorus, order: int) -> RingTorus:
    """The torus of the same amplitudes with its coordinates cut at another order."""
    amplitudes = tuple(torus.amplitudes[q] for q in series.seeds)
    harmonics, modes, sines = _waves(series, amplitudes, order)
    return replace(torus, harmonics=harmonics, modes=modes, sines=sines, order=order)


def _waves(
    series: TravellingSeries, amplitudes: tuple[Any, ...], order: int
) -> tuple[Ints, Ints, Floats]:
    """Harmonics, wave numbers nu.q and coefficients b of all orders, summed."""
    parts = [series.harmonic_terms(amplitudes, k) for k in range(order + 1)]
    keys = np.concatenate([series.grading.harmonic_keys(nu) for nu, _ in parts])
    _, first, index = np.unique(keys, return_index=True, return_inverse=True)
    stretches = np.concatenate([values for _, values in parts])
    sums = np.bincount(index.reshape(-1), stretches, len(first))
    harmonics = np.concatenate([nu for nu, _ in parts])[first]
    modes = harmonics @ np.array(series.seeds)
    moving = modes % series.chain.N != 0
    harmonics, modes, sums = harmonics[moving], modes[moving], sums[moving]
    return harmonics, modes, sums / (2 * np.sin(np.pi * modes / series.chain.N))


def amplitudes_by_seed(solution: QuasiPeriodic | RingTorus) -> dict[int, Any]:
    """A_q of any solution, whatever the ends."""
    if isinstance(solution, RingTorus):
        return dict(solution.amplitudes)
    return amplitudes_of(solution)


def unfold(solution: QuasiPeriodic) -> RingTorus:
    """A solution with fixed ends as the odd solution of the ring of twice the length.

    solution : any torus or breather of a chain of N bonds; dimensionless. x_0 = x_N = 0 stay at
        rest, x_(2N-j) = -x_j. Its modes are standing waves of the modes q and -q of the ring,
        whose energies are those of the chain. In doubles. Ours. Raises InputError.

    >>> from symfpu import breather_at_amplitude
    >>> unfold(breather_at_amplitude(Chain(N=8, alpha="0.3"), 1, "0.4"))
    RingTorus(N=16, alpha=0.3, ends='periodic', A_1=0.4, H=..., residual ...)
    """
    require_solution(solution, "solution")
    fixed = solution.chain
    ring = Chain(2 * fixed.N, potential=fixed.potential, ends="periodic")
    plain = solution.in_doubles()
    row, column = np.nonzero(plain.cosines)
    values, harmonics = plain.cosines[row, column], plain.harmonics[row]
    return RingTorus(
        chain=ring,
        seeds=plain.seeds,
        frequencies=plain.frequencies,
        phases=plain.phases,
        amplitudes=plain.amplitudes,
        harmonics=np.concatenate([harmonics, -harmonics]),
        modes=np.tile(column + 1, 2),
        sines=np.tile(values, 2),
        warnings=solution.warnings,
    )
