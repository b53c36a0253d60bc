"""A q-torus with numbers in it: orbit, energies, averages and residuals of a series at chosen amplitudes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.algebra.grading import Ints
from symfpu.errors import InputError
from symfpu.exact import integer
from symfpu.series import LindstedtSeries

Floats = NDArray[np.float64]

CHUNK = 4_000_000  # entries of a table of cosines held at once
GRID_POINTS = 4096  # angles at which a residual is taken, about


@dataclass(frozen=True, eq=False)
class QTorus:
    """The quasi-periodic solution Q_q(t) = sum over harmonics of c_q[nu] cos(nu.(omega t + phi)), truncated at `order`.

    Made by `solve_amplitudes`. amplitudes, phases : by seed; phases in radians. frequency_order : truncation of the
    frequency series that gave the amplitudes; order : truncation of the coordinates. history : amplitudes by frequency
    order. root_residual : largest |omega_q - truncated series|. warnings : reasons to doubt that this is a torus.
    """

    series: LindstedtSeries = field(repr=False)
    amplitudes: Mapping[int, float]
    phases: Mapping[int, float]
    frequency_order: int
    order: int
    history: Mapping[int, tuple[float, ...]] = field(repr=False, default_factory=dict)
    root_residual: float = 0.0
    warnings: tuple[str, ...] = ()

    def __repr__(self) -> str:
        amplitudes = ", ".join(f"A_{q}={a:.12g}" for q, a in self.amplitudes.items())
        chain = repr(self.series.chain).removeprefix("Chain(").removesuffix(")")
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        return (
            f"QTorus({chain}, {amplitudes}, frequency order {self.frequency_order}, order {self.order}, "
            f"H={self.energy():.10g}, residual {self.residual():.2g}{doubts})"
        )

    @cached_property
    def _terms(self) -> tuple[Ints, Floats]:
        """Harmonics (H, s) and cosine coefficients (H, N-1), all orders summed."""
        amplitudes = [self.amplitudes[q] for q in self.series.seeds]
        parts = [self.series.harmonic_terms(amplitudes, k) for k in range(self.order + 1)]
        keys = np.concatenate([self.series.grading.harmonic_keys(nu) for nu, _ in parts])
        _, first, index = np.unique(keys, return_index=True, return_inverse=True)
        values = np.zeros((len(first), self.series.chain.N - 1))
        at = 0
        for nu, part in parts:
            values[index[at : at + len(nu)]] += part
            at += len(nu)
        return np.concatenate([nu for nu, _ in parts])[first], values

    @property
    def harmonics(self) -> Ints:
        """The harmonics nu of the solution, one of each pair +-nu; shape (H, s)."""
        return self._terms[0]

    @property
    def cosines(self) -> Floats:
        """The coefficients c_q[nu] of cos(nu.theta) in Q_q; shape (H, N-1)."""
        return self._terms[1]

    @cached_property
    def _omega(self) -> Floats:
        assert self.series.frequencies is not None
        return np.array([float(w) for w in self.series.frequencies])

    @cached_property
    def _rates(self) -> Floats:
        """nu.omega of every harmonic; shape (H,)."""
        return np.asarray(self.harmonics @ self._omega)

    def positions(self, t: ArrayLike) -> Floats:
        """Mode coordinates Q_q(t); t a number or an array (T,), result (N-1,) or (T, N-1)."""
        return self._along(t, lambda angles: np.cos(angles) @ self.cosines)

    def momenta(self, t: ArrayLike) -> Floats:
        """Mode momenta P_q(t) = dQ_q/dt; t a number or an array (T,), result (N-1,) or (T, N-1)."""
        return self._along(t, lambda angles: np.sin(angles) @ (-self._rates[:, None] * self.cosines))

    def _along(self, t: ArrayLike, evaluate: object) -> Floats:
        try:
            times = np.asarray(t, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise InputError("t", t, "a finite number or an array of them", "pass real numbers") from error
        if times.ndim > 1 or not np.isfinite(times).all():
            raise InputError("t", t, "a finite number or a one-dimensional array of them", "flatten it")
        phases = np.array([self.phases[q] for q in self.series.seeds])
        theta = times.reshape(-1, 1) * self._omega + phases
        values = self._at_angles(theta, evaluate)
        return values[0] if times.ndim == 0 else values

    def _at_angles(self, theta: Floats, evaluate: object) -> Floats:
        assert callable(evaluate)
        step = max(1, CHUNK // len(self.harmonics))
        parts = [evaluate(theta[i : i + step] @ self.harmonics.T) for i in range(0, len(theta), step)]
        return np.concatenate(parts) if parts else np.zeros((0, self.series.chain.N - 1))

    def energy(self, t: ArrayLike = 0.0) -> Floats:
        """Total energy H along the solution; constant in time for an exact torus. A number, or shape (T,)."""
        return self.series.chain.energy(self.positions(t), self.momenta(t))[()]

    def harmonic_energies(self, t: ArrayLike = 0.0) -> Floats:
        """Harmonic energies E_q(t) (Eq. harmonicene); shape of t with an axis N-1 at the end."""
        return self.series.chain.harmonic_energies(self.positions(t), self.momenta(t))

    def energy_error(self, t: ArrayLike, *, harmonic: bool = False) -> Floats:
        """Relative error in time (E(t) - E(0)) / E(0) of the total energy, or of the harmonic energy sum E_q."""
        values = self.harmonic_energies(t).sum(axis=-1) if harmonic else self.energy(t)
        start = self.harmonic_energies().sum() if harmonic else self.energy()
        return np.asarray((values - start) / start)

    def average_spectrum(self, T: float | None = None) -> Floats:
        """Time averages of the harmonic energies E_q, in closed form; shape (N-1,).

        T : averaging time from t = 0; None for the infinite-time average, (1/4) sum c^2 ((nu.omega)^2 + Omega^2) over
        nu != 0 plus the constant term. With the factor 1/2 of E_q that the paper's section 3.2 leaves out.
        """
        linear = self.series.chain.frequencies()
        if T is None:
            moving = (self.harmonics != 0).any(axis=1)
            weights = np.where(moving, 0.5, 1.0)
            kinetic = (weights * self._rates**2) @ self.cosines**2
            return np.asarray(0.5 * (kinetic + linear**2 * (weights @ self.cosines**2)))
        if not isinstance(T, Real) or not np.isfinite(float(T)) or T <= 0:
            raise InputError("T", T, "a positive finite time, or None for infinite", "pass T > 0")
        psi = self.harmonics @ np.array([self.phases[q] for q in self.series.seeds])
        velocity = self._rates[:, None] * self.cosines
        total = np.zeros(self.series.chain.N - 1)
        step = max(1, CHUNK // len(self.harmonics))
        for i in range(0, len(self.harmonics), step):
            rows = slice(i, i + step)
            difference = mean_cosine(self._rates[rows, None] - self._rates, psi[rows, None] - psi, T)
            total_ = mean_cosine(self._rates[rows, None] + self._rates, psi[rows, None] + psi, T)
            total += np.einsum("hq,hq->q", velocity[rows], (difference - total_) @ velocity)
            total += linear**2 * np.einsum("hq,hq->q", self.cosines[rows], (difference + total_) @ self.cosines)
        return total / 4

    def residuals(self, points: int | None = None) -> Floats:
        """Largest |d^2Q_q/dt^2 - force| of each mode on a grid of angles; zero for an exact torus; shape (N-1,).

        points : grid points for each of the s angles; default such that the grid has about 4096.
        """
        return self._residuals(points)[0]

    def residual(self, points: int | None = None) -> float:
        """Largest residual of the equations of motion on a grid of angles, relative to the largest acceleration."""
        residuals, largest = self._residuals(points)
        return float(residuals.max() / largest)

    def _residuals(self, points: int | None) -> tuple[Floats, float]:
        chain, s = self.series.chain, len(self.series.seeds)
        number = integer(points, "points", 1) if points is not None else max(3, min(64, round(GRID_POINTS ** (1 / s))))
        worst, largest = np.zeros(chain.N - 1), 0.0
        for theta in self._angle_grid(number):
            Q = self._at_angles(theta, lambda angles: np.cos(angles) @ self.cosines)
            second = self._at_angles(theta, lambda angles: np.cos(angles) @ (-(self._rates[:, None] ** 2) * self.cosines))
            force = chain.accelerations(Q)
            worst = np.maximum(worst, np.abs(second - force).max(axis=0))
            largest = max(largest, float(np.abs(force).max()))
        return worst, largest

    def _angle_grid(self, number: int) -> Iterator[Floats]:
        """The tensor grid of angles in portions; a shift keeps it off the symmetric angles 0 and pi."""
        s = len(self.series.seeds)
        for start in range(0, number**s, GRID_POINTS):
            index = np.arange(start, min(start + GRID_POINTS, number**s))
            digits = np.stack(np.unravel_index(index, (number,) * s), axis=-1)
            yield 2 * np.pi * (digits + 1 / 3) / number


def mean_cosine(rate: Floats, phase: Floats, T: float) -> Floats:
    """(1/T) times the integral of cos(rate t + phase) over 0 .. T, stable for every rate."""
    half = rate * (T / 2)
    return np.asarray(np.sinc(half / np.pi) * np.cos(half + phase))
