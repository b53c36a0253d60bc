"""The equations of periodic orbits by harmonic balance, and Newton's method on them, in doubles.

Q_q(t) = sum_n c[n, q-1] cos(n omega t) solves Q'' = chain.accelerations(Q). The unknowns are c
and sigma = omega^2 - Omega^2 of the seed, so that a small shift loses no digits. Reflection of the
chain with a change of sign is half a period of the family: only c with q - n seed even (and n odd
where V is even) are unknowns, and of these what the couplings let in.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symfpu.chain import bonds
from symfpu.chain.chain import Chain
from symfpu.chain.propagation import carried_modes
from symfpu.errors import SymfpuError
from symfpu.numbers.room import require_room

Floats = NDArray[np.float64]
LARGEST_SYSTEM = 8192  # unknowns of a whole matrix; it has 512 MB
TAIL = 1e-14  # of the largest coefficient: what the last eighth of the harmonics may reach
STEP = 1e-14  # relative Newton step that ends the iteration at once
ROUNDING_STEP = 1e-9  # the one that ends it when it no longer shrinks
ITERATIONS = 25
MOST_POWER = 5  # of the stretches, whose harmonics do not fold
SMALL_BLOCK = 300  # coefficients of two harmonics, below which all are gathered at once
GROWTH = 1e3  # factor by which iterates may leave the size of the guess, up or down
NEARER = "ask for an orbit of smaller amplitude"
# of N^2 and of n^2 doubles that are alive at once
TABLES_OF_MODES, TABLES_OF_HARMONICS, MATRICES = 12, 6, 3


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
        self.residual = residual(balance.chain, self.frequency, self.iterate)
        amplitude = z[balance.first]
        super().__init__(
            f"no periodic orbit of seed {self.seed}: {reason}; "
            f"the best iterate, omega = {self.frequency:.12g} and A = {amplitude:.6g} "
            f"with {balance.harmonics} harmonics, "
            f"leaves {self.residual:.2g} of the largest acceleration; {advice}"
        )


def unknowns(
    chain: Chain, seed: int, harmonics: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Harmonics n and places q - 1 of the coefficients that the symmetry allows.

    They stand in the order of the vectors z.
    """
    n = np.arange(harmonics + 1)[:, None]
    even = chain.potential.even
    harmonic, place = np.nonzero(carried_modes(chain.N, (seed,), n, even=even))
    return harmonic, place


def half_period_points(chain: Chain, harmonics: int) -> int:
    """Into how many parts half a period is cut for the force up to a harmonic.

    Of r^n harmonics from 2 points - harmonics on would fold onto those: (n + 1) harmonics / 2 + 1
    points are enough for powers up to n. What still folds of powers above MOST_POWER is as small
    as that power of the last harmonics, which are at TAIL.
    """
    degree = chain.potential.degree or MOST_POWER + 1
    power = min(max(degree - 1, 3), MOST_POWER)
    return (power + 1) * harmonics // 2 + 1


def products_of_modes(N: int) -> Floats:
    """cos(pi m (j + 1/2)/N) / N of the bonds j and of m = 0 .. N; shape (N, N+1)."""
    angles = np.outer(2 * np.arange(N) + 1, np.arange(N + 1)) % (4 * N)
    return np.asarray(np.cos(np.pi / (2 * N) * angles) / N)


def mode_sums(N: int) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
    """|q - q'|, q + q' mirrored at N, and the sign that this takes; of all pairs of modes."""
    q = np.arange(1, N)
    total = np.add.outer(q, q)
    sign = np.where(total > N, -1.0, 1.0)
    return np.abs(np.subtract.outer(q, q)), np.minimum(total, 2 * N - total), sign


def balance_bytes(N: int, harmonics: int) -> int:
    """What tables of pairs of modes, the matrix and its factors need at most."""
    unknowns = min((harmonics + 1) * N // 2, LARGEST_SYSTEM)
    tables = TABLES_OF_MODES + TABLES_OF_HARMONICS * harmonics
    return 8 * (tables * N**2 + MATRICES * unknowns**2)


class Balance:
    """The equations n^2 omega^2 c + force = 0 up to a number of harmonics.

    Their unknowns are vectors z: the c that the symmetry allows, then sigma.
    """

    def __init__(self, chain: Chain, seed: int, harmonics: int) -> None:
        require_room("N", chain.N, lambda N: balance_bytes(N, harmonics))
        self.chain, self.seed, self.harmonics = chain, seed, harmonics
        self.n, self.q = unknowns(chain, seed, harmonics)
        linear = chain.frequencies()
        own, driven = linear[self.q], linear[seed - 1]
        self.detuning = self.n**2 * driven**2 - own**2
        is_first = (self.n == 1) & (self.q == seed - 1)
        self.first = int(np.flatnonzero(is_first)[0])
        # of every bond by a unit of each mode
        self.stretch = chain.stretches(np.eye(chain.N - 1))
        self._linear = np.multiply.outer(linear, linear)
        self._apart, self._mirrored, self._sign = mode_sums(chain.N)
        self.products = products_of_modes(chain.N)
        points = half_period_points(chain, harmonics)
        k = np.arange(points + 1)
        ends = np.where(k % points == 0, 0.5, 1.0)
        self.table = np.cos(np.pi / points * np.outer(k, k))
        self.analysis = 2 / points * ends[:, None] * self.table * ends

    def vector(self, cosines: Floats, sigma: float) -> Floats:
        length = max(self.harmonics + 1, len(cosines))
        padded = np.zeros((length, self.chain.N - 1))
        padded[: len(cosines)] = cosines
        return np.append(padded[self.n, self.q], sigma)

    def cosines(self, z: Floats) -> Floats:
        c = np.zeros((self.harmonics + 1, self.chain.N - 1))
        c[self.n, self.q] = z[:-1]
        return c

    def frequency(self, z: Floats) -> float:
        linear = float(self.chain.frequencies()[self.seed - 1])
        sigma = float(z[-1])
        squared = max(linear**2 + sigma, 0.0)
        return linear + sigma / (linear + math.sqrt(squared))

    def _stretches(self, z: Floats) -> Floats:
        """Of the bonds at the points of half a period."""
        synthesis = self.table[:, : self.harmonics + 1]
        return np.asarray(synthesis @ self.cosines(z) @ self.stretch)

    def equations(self, z: Floats) -> Floats:
        """What vanishes on an orbit, shape (n,)."""
        return self._equations(z, self._stretches(z))

    def _equations(self, z: Floats, r: Floats) -> Floats:
        tension = bonds.anharmonic_tension(self.chain.law(), r)
        force = -(self.analysis @ tension @ self.stretch.T)
        diagonal = self.detuning + self.n**2 * z[-1]
        return np.asarray(diagonal * z[:-1] + force[self.n, self.q])

    def system(self, z: Floats) -> tuple[Floats, Floats]:
        """The equations, shape (n,), and their derivatives by z, shape (n, n+1)."""
        law, c, sigma = self.chain.law(), z[:-1], z[-1]
        diagonal = self.detuning + self.n**2 * sigma
        r = self._stretches(z)
        slope = self.analysis @ bonds.anharmonic_stiffness(law, r)
        J = self._coupling(slope)
        J[np.diag_indices_from(J)] += diagonal
        return self._equations(z, r), np.column_stack([J, self.n**2 * c])

    def slopes(self, z: Floats) -> Floats:
        """V'' - 1 of the bonds at the points of half a period, (points, N)."""
        r = self._stretches(z)
        return np.asarray(bonds.anharmonic_stiffness(self.chain.law(), r))

    def image(self, slopes: Floats, z: Floats, change: Floats) -> Floats:
        """What the equations change by with a change of the coefficients, sigma as it is.

        slopes : of the orbit z.
        """
        table = np.zeros((self.harmonics + 1, self.chain.N - 1))
        table[self.n, self.q] = change
        moved = self.table[:, : self.harmonics + 1] @ table @ self.stretch
        force = -(self.analysis @ (slopes * moved) @ self.stretch.T)
        diagonal = self.detuning + self.n**2 * z[-1]
        return np.asarray(diagonal * change + force[self.n, self.q])

    def rows(
        self, slopes: Floats, z: Floats, places: NDArray[np.intp]
    ) -> tuple[Floats, Floats]:
        """Derivatives of the equations at these places by all coefficients; and the diagonal.

        slopes : of the orbit z. Shapes (places, n) and (n,).
        """
        # lazy: numba takes longer to import than all the rest
        from symfpu.breathers.row_loops import fill_rows

        table = self._slopes_of_modes(slopes)
        n, q, linear = self.n, self.q, self.chain.frequencies()
        own = self.detuning + n**2 * z[-1]
        rows = np.empty((len(places), len(n)))
        fill_rows(rows, table, linear, n[places], q[places], n, q)
        rows[n[places] == 0] /= 2
        rows[np.arange(len(places)), places] += own[places]
        return rows, np.asarray(own + self._own_coupling(table))

    def _slopes_of_modes(self, slopes: Floats) -> Floats:
        """What the slopes have of the harmonics 0 .. 2H and the modes 0 .. N; (2H+1, N+1)."""
        coefficients = self.analysis @ slopes
        coefficients[1:] /= 2
        return np.asarray((coefficients @ self.products)[: 2 * self.harmonics + 1])

    def _own_coupling(self, table: Floats) -> Floats:
        """Of the equations by their own coefficients: what the slopes add to the divisors."""
        n, q = self.n, self.q
        total, sign, size = (x[q, q] for x in (self._mirrored, self._sign, self._linear))
        slopes = [size * (table[k, 0] + sign * table[k, total]) for k in (0 * n, 2 * n)]
        diagonal = -(slopes[0] + slopes[1])
        diagonal[n == 0] /= 2
        return np.asarray(diagonal)

    def own_divisors(self, z: Floats) -> Floats:
        """Derivatives of the equations by their own coefficients, shape (n,)."""
        coupling = self._own_coupling(self._slopes_of_modes(self.slopes(z)))
        return np.asarray(self.detuning + self.n**2 * z[-1] + coupling)

    def near_resonance(self, z: Floats, factor: float) -> NDArray[np.intp]:
        """Places of coefficients with a divisor within a factor of the largest slope of a bond.

        Divisors are relative to Omega_q^2. The seed's own coefficient is among them.
        """
        largest = _largest(self.slopes(z))
        squares = self.chain.frequencies()[self.q] ** 2
        divisors = np.abs(self.detuning + self.n**2 * z[-1]) / squares
        near = divisors <= factor * largest
        near[self.first] = True
        return np.flatnonzero(near)

    def _coupling(self, slope: Floats) -> Floats:
        """Derivatives of the force by the unknowns.

        slope : cosine coefficients of the anharmonic part of V'' of every bond, overwritten.
        """
        slope[1:] /= 2  # coefficients of exp(i k theta), k of both signs
        by_modes = self._by_modes((slope @ self.products)[: 2 * self.harmonics + 1])
        count = len(np.unique(self.n))
        if len(self.n) ** 2 < SMALL_BLOCK * count**2:
            return self._gathered(by_modes)
        J = np.empty((len(self.n), len(self.n)))
        rows = [(n, *self._of_harmonic(n)) for n in np.unique(self.n).tolist()]
        for place, (n, those, modes) in enumerate(rows):
            for other, columns, others in rows[: place + 1]:
                block = by_modes[n - other, modes, others]
                if n:
                    block = block + by_modes[n + other, modes, others]
                J[those, columns] = -block
                # the mean takes the slope of one sign alone
                J[columns, those] = -block.T if other or not n else -block.T / 2
        return J

    def _gathered(self, by_modes: Floats) -> Floats:
        """The same for short chains, whose blocks are small."""
        n, q = self.n, self.q
        apart, total = np.abs(np.subtract.outer(n, n)), np.add.outer(n, n)
        J = -(by_modes[apart, q[:, None], q] + by_modes[total, q[:, None], q])
        J[n == 0] /= 2
        return np.asarray(J)

    def _of_harmonic(self, n: int) -> tuple[slice, slice]:
        """The coefficients of a harmonic, which stand together, and their modes: every other."""
        first, last = map(int, np.searchsorted(self.n, [n, n + 1]))
        return slice(first, last), slice(int(self.q[first]), None, 2)

    def _by_modes(self, table: Floats) -> Floats:
        """Slopes of the bonds between the modes, for every harmonic; shape (2H+1, N-1, N-1).

        table : what they have of the modes 0 .. N. Of q and q' it makes Omega_q Omega_q' times
        what it has of |q - q'| and q + q', beyond N of 2 N - q - q' with the other sign.
        """
        mirrored = self._sign * table[:, self._mirrored]
        return np.asarray(self._linear * (table[:, self._apart] + mirrored))

    def newton(self, z: Floats, most: int = ITERATIONS) -> tuple[Floats, int]:
        """The solution with the same amplitude of the seed, and the number of steps.

        Raises NoPeriodicOrbit, also where more steps than `most` would be needed.
        """
        free = np.delete(np.arange(len(z)), self.first)
        best, least, before = z, np.inf, np.inf
        size = _largest(z[:-1])
        for iteration in range(1, most + 1):
            equations, jacobian = self.system(z)
            imbalance = _largest(equations) / _largest(z[:-1])
            if imbalance < least:
                best, least = z, imbalance
            try:
                step = np.linalg.solve(jacobian[:, free], equations)
            except np.linalg.LinAlgError:
                reason = "the matrix of Newton's method is singular"
                raise NoPeriodicOrbit(self, reason, best) from None
            z = z.copy()
            z[free] -= step
            reached = _largest(z[:-1])
            if not size / GROWTH < reached < size * GROWTH:
                reason = f"the largest coefficient goes from {size:.3g} to {reached:.3g}"
                raise NoPeriodicOrbit(self, reason, best)
            relative = _largest(step[:-1]) / reached
            if relative <= STEP or before / 2 < relative < ROUNDING_STEP:
                return z, iteration
            before = relative
        raise NoPeriodicOrbit(self, f"no convergence in {most} steps", best)


def _largest(values: NDArray[np.floating[Any]]) -> float:
    return float(np.max(np.abs(values)))


def relative_heights(cosines: Floats) -> Floats:
    """The largest coefficient of every harmonic over the largest of all; shape (H+1,)."""
    heights = np.max(np.abs(cosines), axis=1)
    return np.asarray(heights / np.max(np.abs(cosines)))


def residual(chain: Chain, omega: float, cosines: Floats) -> float:
    """Largest |Q'' - force| between the collocation points, over the largest acceleration."""
    n, points = np.arange(len(cosines)), 6 * len(cosines)
    angles = np.pi / points * (np.arange(points) + 1 / 3)
    table = np.cos(np.outer(angles, n))
    force = chain.accelerations(table @ cosines)
    largest = max(_largest(force), float(np.finfo(float).tiny))
    rates = n[:, None] * omega
    return _largest(table @ (rates**2 * cosines) + force) / largest
