"""The equations of periodic orbits, those of a torus of one angle, in doubles.

Q_q(t) = sum_n c[n, q-1] cos(n omega t) solves Q'' = chain.accelerations(Q): the invariance equation
of one seed (`symfpu.refinement.invariance`). The unknowns are its coefficients and
sigma = omega^2 - Omega^2 of the seed, so that a small shift loses no digits.
"""

from __future__ import annotations

import math
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.errors import SymfpuError
from symfpu.numbers.room import require_room
from symfpu.numbers.typed import exact
from symfpu.refinement.invariance import InvarianceEquation
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
LARGEST_SYSTEM = 8192  # unknowns of a whole matrix; it has 512 MB
TAIL = 1e-14  # of the largest coefficient: what the last eighth of the harmonics may reach
POINTS = 6  # of a harmonic, for the residual
NEARER = "ask for an orbit of smaller amplitude"
# of N^2, of n N and of n^2 doubles that are alive at once
TABLES_OF_MODES, TABLES_OF_HARMONICS, MATRICES = 8, 8, 3


class NoPeriodicOrbit(SymfpuError):
    """Newton's method found no periodic orbit: raised by `torus` of one seed.

    seed : the mode. iterate : the one with the smallest residual, cosine coefficients, shape
        (H+1, N-1).
    frequency, residual : of it, dimensionless; the residual relative to the largest acceleration.
    reason : why. Ours.
    """

    def __init__(
        self, balance: Balance, reason: str, z: Floats, advice: str = NEARER
    ) -> None:
        self.seed, self.reason = balance.seed, reason
        self.iterate = balance.cosines(z)
        self.frequency = balance.frequency(z)
        self.residual = self._orbit(balance).residual(POINTS * len(self.iterate))
        amplitude = z[balance.first]
        super().__init__(
            f"no periodic orbit of seed {self.seed}: {reason}; "
            f"the best iterate, omega = {self.frequency:.12g} and A = {amplitude:.6g} "
            f"with {balance.harmonics} harmonics, "
            f"leaves {self.residual:.2g} of the largest acceleration; {advice}"
        )

    def _orbit(self, balance: Balance) -> Torus:
        omega, phases = exact(self.frequency, "frequency"), {self.seed: 0.0}
        harmonics, seeds = balance.equation.harmonics, (self.seed,)
        return Torus(balance.chain, seeds, (omega,), harmonics, self.iterate, phases)


def balance_bytes(N: int, harmonics: int) -> int:
    """What tables of modes and bonds, of harmonics, the matrix and its factors need at most."""
    unknowns = min((harmonics + 1) * N // 2, LARGEST_SYSTEM)
    tables = TABLES_OF_MODES * N**2 + TABLES_OF_HARMONICS * harmonics * N
    return 8 * (tables + MATRICES * unknowns**2)


class Balance:
    """The invariance equation of one seed up to a number of harmonics.

    Its unknowns are vectors z: the coefficients at the mask of the equation, then sigma.

    n, q : harmonics and columns of the coefficients. first : the place of the amplitude. detuning :
    n^2 Omega^2 - Omega_q^2. known : the same of other numbers of harmonics.
    """

    def __init__(self, chain: Chain, seed: int, harmonics: int) -> None:
        require_room("N", chain.N, lambda N: balance_bytes(N, harmonics))
        self.chain, self.seed = chain, seed
        numbers = np.arange(harmonics + 1)[:, None]
        self._choose(InvarianceEquation(chain, (seed,), numbers))
        self.known: dict[int, Balance] = {harmonics: self}

    def _choose(self, equation: InvarianceEquation) -> None:
        """Takes the harmonics of an equation."""
        self.equation, self.harmonics = equation, len(equation.harmonics) - 1
        self.n, self.q = np.nonzero(equation.mask)
        self._places = np.flatnonzero(equation.mask)
        self.first = int(np.flatnonzero((self.n == 1) & (self.q == self.seed - 1))[0])
        rates = equation.rates(np.zeros(1))[:, None]
        divisors = rates**2 - equation.linear**2
        self.detuning = divisors[self.n, self.q].astype(float)
        self.weights = np.where(
            self.n == 0, 2.0, 1.0
        )  # norms of cosines: the mean counts twice

    def at(self, harmonics: int) -> Balance:
        """The same up to another number of harmonics, made once."""
        if harmonics not in self.known:
            require_room("N", self.chain.N, lambda N: balance_bytes(N, harmonics))
            found = self.known[harmonics] = copy(self)
            found._choose(self.equation.at(np.arange(harmonics + 1)[:, None]))
        return self.known[harmonics]

    def vector(self, cosines: Floats, sigma: float) -> Floats:
        """The unknowns of coefficients (H', N-1), of any number of harmonics."""
        length = max(self.harmonics + 1, len(cosines))
        padded = np.zeros((length, self.chain.N - 1))
        padded[: len(cosines)] = cosines
        return np.append(padded[self.n, self.q], sigma)

    def cosines(self, z: Floats) -> Floats:
        """The coefficients of an orbit or of a change, (H+1, N-1)."""
        return self._table(z[:-1])

    def _table(self, coefficients: Floats) -> Floats:
        c = np.zeros(self.equation.mask.shape)
        c.ravel()[self._places] = coefficients
        return c

    def frequency(self, z: Floats) -> float:
        """omega."""
        linear = float(self.chain.frequencies()[self.seed - 1])
        sigma = float(z[-1])
        squared = max(linear**2 + sigma, 0.0)
        return linear + sigma / (linear + math.sqrt(squared))

    def divisors(self, z: Floats) -> Floats:
        """n^2 omega^2 - Omega_q^2."""
        return np.asarray(self.detuning + self.n**2 * z[-1])

    def gradient(self, z: Floats) -> Floats:
        """Of the equations by sigma, and of the action over omega by the coefficients."""
        return np.asarray(self.n**2 * z[:-1])

    def equations(self, z: Floats) -> Floats:
        """What vanishes on an orbit, shape (n,)."""
        force = self.equation.force(self.cosines(z))
        return np.asarray(self.divisors(z) * z[:-1] - force.ravel()[self._places])

    def slopes(self, z: Floats) -> Floats:
        """V'' - 1 of half of the bonds at the points of the lattice."""
        return self.equation.slopes(self.cosines(z))

    def image(self, slopes: Floats, z: Floats, change: Floats) -> Floats:
        """What the equations change by with a change of the coefficients, sigma as it is.

        slopes : of the orbit z.
        """
        force = self.equation.force_change(slopes, self._table(change))
        return np.asarray(self.divisors(z) * change - force.ravel()[self._places])

    def own_divisors(self, slopes: Floats, z: Floats) -> Floats:
        """Derivatives of the equations by their own coefficients, shape (n,)."""
        coupling = self.equation.diagonal(slopes, self.n, self.q)
        return np.asarray(self.divisors(z) - coupling)

    def near_resonance(self, slopes: Floats, z: Floats, factor: float) -> NDArray[np.bool_]:
        """Which coefficients have a divisor within a factor of the largest slope of a bond.

        Divisors are relative to Omega_q^2. The seed's own coefficient is among them.
        """
        squares = self.chain.frequencies()[self.q] ** 2
        near = np.abs(self.divisors(z)) <= factor * _largest(slopes) * squares
        near[self.first] = True
        return np.asarray(near)


def _largest(values: NDArray[np.floating[Any]]) -> float:
    return float(np.max(np.abs(values)))


def relative_heights(cosines: Floats) -> Floats:
    """The largest coefficient of every harmonic over the largest of all; shape (H+1,)."""
    heights = np.max(np.abs(cosines), axis=1)
    return np.asarray(heights / np.max(np.abs(cosines)))
