"""Floquet exponents of a periodic orbit to rounding: guesses from a tangent map, Newton's method.

The guess is an eigenvalue of the map of a sector over its period; the Floquet solution
exp(i sigma t) sum_n v_q[n] exp(i n omega t) is then a zero of L(sigma) v in Fourier space. Ours;
docs/stability-proofs.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.certified.room import require_room
from symfpu.certified.rounded_orbit import RoundedOrbit
from symfpu.certified.sectors import Sector
from symfpu.chain import bonds
from symfpu.dynamics.tangent import tangent_map_along

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Values = NDArray[Any]  # float64, or complex128 for an exponent off the axes

STEP = 0.1  # over the square root of the largest stiffness of a bond
ON_CIRCLE = 1e-7  # |log |rho|| below which a multiplier is tried as one of the circle
INVERSES, NEWTON_STEPS = 5, 3
CONVERGED = 1e-12
ALIKE = 1e-6  # relative difference of coefficients that a symmetry makes equal
MATRICES = 7  # of places by places, that are there at once, those of the bounds among them


@dataclass(frozen=True)
class Guess:
    """An exponent to about ten digits: sigma = base h omega / 2 + value.

    base : 1 for a real negative multiplier, else 0. value : real on the circle; with a negative
        imaginary part, a growing solution, off it.
    """

    sector: Sector
    base: int
    value: complex

    @property
    def circle(self) -> bool:
        """Whether its multiplier seems to be of modulus 1."""
        return self.value.imag == 0


def guesses(orbit: RoundedOrbit, sector: Sector) -> list[Guess]:
    """One exponent of every pair of the sector but the trivial one, and of every quadruple."""
    rho = np.linalg.eigvals(sector_map(orbit, sector))
    if sector.trivial:
        rho = rho[np.argsort(abs(rho - 1))[2:]]
    unit = sector.folds * float(orbit.omega) / (2 * math.pi)
    found = []
    for multiplier in rho:
        growth, angle = float(np.log(abs(multiplier))), float(np.angle(multiplier))
        if abs(growth) < ON_CIRCLE and 0 < angle < math.pi:
            found.append(Guess(sector, 0, complex(unit * angle, 0.0)))
        elif growth >= ON_CIRCLE and angle >= 0:
            found.append(_unstable(sector, unit, growth, angle))
    return sorted(found, key=lambda guess: (guess.circle, guess.value.real))


def _unstable(sector: Sector, unit: float, growth: float, angle: float) -> Guess:
    """A growing solution; of a real multiplier exactly on the axis."""
    if angle < ON_CIRCLE:
        return Guess(sector, 0, complex(0.0, -unit * growth))
    if angle > math.pi - ON_CIRCLE:
        return Guess(sector, 1, complex(0.0, -unit * growth))
    return Guess(sector, 0, unit * complex(angle, -growth))


def sector_map(orbit: RoundedOrbit, sector: Sector) -> Floats:
    """U of docs/stability-proofs.md in doubles, shape (2d, 2d)."""
    chain, rows = orbit.chain, orbit.floats
    theta = (np.arange(chain.N) + 0.5) * np.pi / chain.N
    coefficients = rows @ np.cos(np.outer(np.arange(1, chain.N), theta))
    rates = np.arange(len(rows)) * float(orbit.omega)
    duration = 2 * math.pi / float(orbit.omega) / sector.folds

    def stretches(t: Floats) -> Floats:
        return np.asarray(np.cos(np.multiply.outer(t, rates)) @ coefficients)

    r = stretches(np.linspace(0, duration, 2 * len(rows)))
    stiffest = float(np.max(np.abs(bonds.stiffness(chain.law(), r))))
    steps = math.ceil(duration * math.sqrt(stiffest) / STEP)
    whole = tangent_map_along(chain, stretches, duration, steps)
    modes = np.array(sector.modes)
    kept = np.concatenate([modes - 1, chain.N - 1 + modes - 1])
    signs = np.ones(len(modes))
    if sector.folds == 2:
        signs = (-1.0) ** (modes if sector.slope else np.full(len(modes), sector.start))
    return np.asarray(np.tile(signs, 2)[:, None] * whole[np.ix_(kept, kept)])


@dataclass(frozen=True, eq=False)
class FourierZero:
    """An exponent and its solution to rounding: L(base h omega/2 + value) v = 0.

    place : index of kappa among the places, where v is 1. n, q, v : places and coefficients.
    """

    guess: Guess
    value: complex
    place: int
    n: Ints
    q: Ints
    v: Values

    @property
    def end(self) -> float:
        """The largest coefficient of the last two harmonics."""
        last = np.abs(self.n) > np.abs(self.n).max() - 2
        return float(np.abs(self.v[last]).max())


@dataclass(frozen=True, eq=False)
class FourierSystem:
    """L(sigma) of a sector in doubles, harmonics up to |n| = harmonics.

    coupling : G_qp[k], k = 0 .. K, shape (K+1, N-1, N-1).
    """

    sector: Sector
    omega: float
    linear: Floats
    coupling: Floats
    harmonics: int

    @cached_property
    def places(self) -> tuple[Ints, Ints]:
        """All n and q."""
        return self.sector.places(self.harmonics)

    @cached_property
    def force(self) -> Floats:
        """G by places."""
        return coupled(self.coupling, self.places, self.places)

    def angles(self, guess: Guess, value: complex) -> Values:
        """sigma + n omega of all places."""
        shift = guess.base * self.sector.folds * self.omega / 2
        n = self.places[0]
        z: Values = n * self.omega + shift + value
        return z.real if guess.circle else z

    def _place_of_kappa(self, v: Values) -> int:
        """That of the largest coefficient.

        Of those alike, from which rounding would choose, the one of the lowest harmonic.
        """
        sizes = np.abs(v)
        alike = np.flatnonzero(sizes >= (1 - ALIKE) * sizes.max())
        return int(alike[np.argmin(np.abs(self.places[0][alike]))])

    def zero(self, guess: Guess) -> FourierZero | None:
        """The nearest one by Newton's method, one inverse for a few steps; None if it is lost."""
        from scipy.linalg import lu_factor, lu_solve

        count = len(self.places[0])
        require_room(self.sector.N, count, count, MATRICES)
        squared = self.linear[self.places[1] - 1] ** 2
        value, z = guess.value, self.angles(guess, guess.value)
        matrix = self.force + np.diag(1 - z**2 / squared)
        factors = lu_factor(matrix)
        v = lu_solve(factors, np.cos(np.arange(len(squared)) + 0.5))
        v = lu_solve(factors, v / np.abs(v).max())
        place = self._place_of_kappa(v)
        v = v / v[place]
        for _ in range(INVERSES):
            z = self.angles(guess, value)
            matrix = self.force + np.diag(1 - z**2 / squared)
            matrix[:, place] = -2 * z / squared * v
            factors = lu_factor(matrix)
            for _ in range(NEWTON_STEPS):
                z = self.angles(guess, value)
                step = lu_solve(factors, self.force @ v + (1 - z**2 / squared) * v)
                value -= complex(step[place])
                step[place] = 0
                v = v - step
                if np.abs(step).max() < CONVERGED:
                    return FourierZero(guess, value, place, *self.places, v)
        return None


def coupled(
    coupling: Floats, rows: tuple[Ints, Ints], columns: tuple[Ints, Ints]
) -> Floats:
    """G_qp[n - m] by rows (n, q) and columns (m, p)."""
    padded = np.concatenate([coupling, np.zeros((1, *coupling.shape[1:]))])
    apart = np.minimum(np.abs(rows[0][:, None] - columns[0]), len(coupling))
    return np.asarray(padded[apart, rows[1][:, None] - 1, columns[1] - 1])
