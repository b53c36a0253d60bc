"""Which unknowns a proof of existence has, and how they make up the stretches of the bonds.

Fixed ends: r_j = sum_q c_q cos(q theta_j), theta_j = (j + 1/2) pi / N, c_q = sqrt(2/N) Omega_q Q_q.
A wave that travels along a ring of N particles: r_j(t) = r(omega t - 2 pi s (j + 1/2) / N) with one
even function r of all bonds, whose harmonic n is c_q[n] of the mode q = n s modulo N, folded to
0 < q <= N/2. Ours; docs/existence.md.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]
Bonds = list[list[Any]]  # a cosine series of balls for each
ROUNDOFF = 2.0**-53


@dataclass(frozen=True)
class Layout(ABC):
    """Of an orbit of a chain and a seed.

    bonds : series that differ; independent : the first ones, that give the others; copies : bonds
        that move as one of them does, at other times. modes : how many, 1 .. modes; Omega_q is
        2 sin(pi q / folds).
    share : c_q[n] is this times sum_j cos(q theta_j) r_j[n]. of_amplitude : (c_s[1] / Omega_s)^2
        where A is 1.
    """

    chain: Chain
    seed: int
    bonds: int
    independent: int
    copies: int
    modes: int
    folds: int
    share: Fraction
    of_amplitude: Fraction

    @property
    def place(self) -> int:
        """The column of the seed."""
        return abs(self.seed) - 1

    def squares(self) -> list[Any]:
        """Omega_q^2 in balls."""
        parts = [flint.fmpq(q, self.folds) for q in range(1, self.modes + 1)]
        return [4 * flint.arb.sin_pi_fmpq(part) ** 2 for part in parts]

    def frequencies(self) -> Floats:
        """Omega_q in doubles, shape (modes,)."""
        return np.asarray(2 * np.sin(np.pi * np.arange(1, self.modes + 1) / self.folds))

    def allowed(self, harmonics: int) -> Flags:
        """The places that the symmetry leaves, rows harmonics up to the last, columns modes."""
        n, q = np.indices((harmonics + 1, self.modes))
        found = self._moves(n, q + 1)
        if self.chain.potential.even:
            found &= n % 2 == 1
        return found

    @abstractmethod
    def _moves(self, n: Ints, q: Ints) -> Flags:
        """Whether harmonic n of mode q does."""

    @abstractmethod
    def table(self) -> Any:
        """cos(q theta_j) in balls, (modes, bonds)."""

    @abstractmethod
    def coupling(self, slopes: Floats) -> tuple[Floats, Floats]:
        """By harmonic of the slopes, (K+1, bonds), what couples two modes, (K+1, modes, modes), and
        a bound of its rounding, (K+1,).
        """

    def beyond(self, growth: Floats, slopes: Floats) -> Floats:
        """sum_k growth[k] |coupling[k]| and its rounding, (modes, modes)."""
        values, errors = self.coupling(slopes)
        return np.asarray(np.tensordot(growth, np.abs(values), 1) + growth @ errors)

    @abstractmethod
    def together(self, sizes: Floats) -> Floats:
        """Above the sum of sizes of all modes, the first axis, over those of one harmonic."""

    @abstractmethod
    def all_bonds(self, first: Bonds) -> Bonds:
        """Those of every bond from the independent ones."""


class FixedEnds(Layout):
    """A q-breather: q - n s even."""

    def _moves(self, n: Ints, q: Ints) -> Flags:
        return np.asarray((q - n * self.seed) % 2 == 0)

    def table(self) -> Any:
        N = self.bonds
        cosines = [flint.arb.cos_pi_fmpq(flint.fmpq(k, 2 * N)) for k in range(4 * N)]
        return flint.arb_mat(
            [[cosines[q * (2 * j + 1) % (4 * N)] for j in range(N)] for q in range(1, N)]
        )

    def coupling(self, slopes: Floats) -> tuple[Floats, Floats]:
        """The angles have 4 units of rounding times their size, below 2 pi N."""
        N = self.bonds
        angles = (np.arange(N) + 0.5) * np.pi / N
        table = np.cos(np.outer(np.arange(2 * N - 1), angles))
        sums = slopes @ table.T / N
        q = np.arange(1, N)
        values = sums[:, abs(q[:, None] - q)] + sums[:, q[:, None] + q]
        units = 8 * (8 * N + N)
        return values, units * ROUNDOFF * np.abs(slopes).sum(axis=1) / N

    def together(self, sizes: Floats) -> Floats:
        return np.asarray(sizes.sum(axis=0))

    def all_bonds(self, first: Bonds) -> Bonds:
        """Bond N-1-j is at t what bond j is at t, or half a period later where the seed is odd."""
        others = first[: self.bonds // 2]
        if self.seed % 2:
            others = [[-a if n % 2 else a for n, a in enumerate(bond)] for bond in others]
        return [*first, *reversed(others)]


class TravellingWave(Layout):
    """One series for all bonds, one mode a harmonic."""

    def _moves(self, n: Ints, q: Ints) -> Flags:
        own = n * self.seed % self.folds
        return np.asarray(np.minimum(own, self.folds - own) == q)

    def table(self) -> Any:
        return flint.arb_mat([[1]] * self.modes)

    def coupling(self, slopes: Floats) -> tuple[Floats, Floats]:
        """That of the one slope, for all modes; exact."""
        shape = len(slopes), self.modes, self.modes
        return np.broadcast_to(slopes[:, :1, None], shape), np.zeros(len(slopes))

    def beyond(self, growth: Floats, slopes: Floats) -> Floats:
        """One number; held once."""
        return np.broadcast_to(growth @ np.abs(slopes), (self.modes, self.modes))

    def together(self, sizes: Floats) -> Floats:
        return np.asarray(sizes.max(axis=0))

    def all_bonds(self, first: Bonds) -> Bonds:
        return first


def layout_of(chain: Chain, seed: int) -> Layout:
    """Of the chain's ends."""
    N = chain.N
    if chain.periodic:
        parts = Fraction(1), Fraction(1, N)
        return TravellingWave(chain, seed, 1, 1, N, N // 2, N, *parts)
    parts = Fraction(2, N), Fraction(2, N)
    return FixedEnds(chain, seed, N, (N + 1) // 2, 1, N - 1, 2 * N, *parts)
