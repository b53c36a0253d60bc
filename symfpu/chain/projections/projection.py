"""How the harmonics of a torus stretch the bonds of its chain, and what tensions drive in turn.

Coefficients c (H, C) have a row for every harmonic nu and C columns. Points are bonds that move
differently. The stretches of the points have the coefficients c S, and tensions t (H, B) of them
drive t (w S)^T, w the number of bonds that a point stands for. One table S of shape (H | 1, C, B),
the linear frequencies and the selection rules are all in which the ends of a chain differ:

- fixed ends (`ModeProjection`): the columns are the modes, S_qj = (2/N)^(1/2) Omega_q
  cos(q (j + 1/2) pi/N) at every harmonic, and half of the bonds are enough by reflection;
- travelling waves of a ring (`WaveProjection`): the harmonic nu lives in one wave m = nu.seeds, so
  that S_nu = N^(-1/2) Omega_m, with one column, and one point stands for all N bonds.

A deviation from a torus has harmonics of both signs, beside the wave of the mode it starts in.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from copy import copy
from functools import cached_property, lru_cache
from typing import Any, ClassVar, Self

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.numbers.long_doubles import DIGITS, in_halves

Floats = NDArray[Any]  # doubles or long doubles
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

EVERY = slice(None)
DOUBLE = np.dtype(float)


class Projection(ABC):
    """S and its transpose at chosen harmonics, the linear frequencies, and the selection rules.

    harmonics : the nu, (H, s). omega : linear frequencies of all coefficients, (H | 1, C), long
    doubles. modes : their wave numbers, (H | 1, C). scale : omega with the sign and the norm of
    the column, (H | 1, C), doubles. stretch : S, (H | 1, C, B), long doubles. images : how many
    bonds each point stands for, (B,).
    """

    standing: ClassVar[bool]  # whether nothing moves at the angles zero

    chain: Chain
    seeds: tuple[int, ...]
    harmonics: Ints
    omega: Floats
    modes: Ints
    scale: Floats
    stretch: Floats
    images: Floats
    _kinds: dict[Any, tuple[Floats, Floats]]  # S and (w S)^T in numbers of a kind

    def at(self, harmonics: Ints) -> Self:
        """The same at other harmonics (M, s)."""
        found = self._copied()
        found._choose(harmonics)
        return found

    def _copied(self) -> Self:
        found = copy(self)
        for name in ("mask", "_places"):
            found.__dict__.pop(name, None)
        return found

    @abstractmethod
    def _choose(self, harmonics: Ints) -> None:
        """Sets the harmonics and what depends on them."""

    @staticmethod
    @abstractmethod
    def points_of(chain: Chain) -> int:
        """How many points there are."""

    @staticmethod
    @abstractmethod
    def columns_of(chain: Chain) -> int:
        """How many columns a row of coefficients has."""

    @property
    def columns(self) -> int:
        """How many a row of coefficients has."""
        return int(self.stretch.shape[1])

    @property
    def points(self) -> int:
        """How many bonds are held."""
        return int(self.stretch.shape[2])

    @property
    def numbers(self) -> tuple[int, ...]:
        """The modes of the chain."""
        return self.chain.mode_numbers

    @property
    @abstractmethod
    def mask(self) -> Mask:
        """Where the selection rules let a torus have coefficients; (H, C)."""

    def scales(self, rows: Ints, columns: Ints) -> Floats:
        """Those of m coefficients; (m,)."""
        every = np.broadcast_to(self.scale, (len(self.harmonics), self.columns))
        return np.asarray(every[rows, columns])

    @property
    @abstractmethod
    def entries(self) -> Ints:
        """Which of the exact rows each coefficient has; (H | 1, C)."""

    @abstractmethod
    def exact_rows(self) -> tuple[list[Any], list[list[Any]]]:
        """Omega (E,) and S (E, B) of all kinds of coefficients, at the precision of mpmath."""

    @abstractmethod
    def omega_in_halves(self) -> tuple[Floats, Floats]:
        """omega as the sum of two long doubles."""

    @abstractmethod
    def column(self, q: int) -> int:
        """That of the mode q at its own harmonic."""

    def energy_share(self, q: int) -> Floats:
        """Of the energy of this column, by harmonic, the part that the mode q has; (H,)."""
        return np.ones(len(self.harmonics))

    @abstractmethod
    def deviating(self, q: int) -> Projection:
        """The projection of a deviation that starts in the mode q."""

    @abstractmethod
    def mask_of_deviation(self, q: int) -> Mask:
        """Where the selection rules let it have coefficients; (H, C)."""

    def _in(self, kind: Any) -> tuple[Floats, Floats]:
        if kind not in self._kinds:
            stretch = self.stretch.astype(kind)
            back = (self.stretch * self.images).astype(kind)
            self._kinds[kind] = stretch, np.swapaxes(back, 1, 2)
        return self._kinds[kind]

    def to_points(self, c: Floats, part: slice = EVERY) -> Floats:
        """Coefficients (H, b) of the stretches of a part of the points, of those (H, C)."""
        stretch, _ = self._in(c.dtype)
        return _times(c, stretch[:, :, part])

    def from_points(self, t: Floats, part: slice = EVERY) -> Floats:
        """What tensions of a part of the points, (H, b), drive; (H, C)."""
        _, back = self._in(t.dtype)
        return _times(t, back[:, part])

    def transposed(self, t: Floats) -> Floats:
        """t S^T, (H, C), of all points (H, B): as `from_points`, without what they stand for."""
        stretch, _ = self._in(t.dtype)
        return _times(t, np.swapaxes(stretch, 1, 2))

    def from_variances(self, variances: Floats) -> Floats:
        """Root mean squares of what independent tensions of variances (B,) drive; (H | 1, C)."""
        _, back = self._in(DOUBLE)
        return np.asarray(np.sqrt(np.swapaxes(back, 1, 2) ** 2 @ variances))

    def largest_norm(self, t: Floats) -> float:
        """No less than the norm of what tensions at any harmonics, (B, M), drive."""
        _, back = self._in(DOUBLE)
        return float(np.linalg.norm(back[0].T @ t))

    def diagonal(self, slope: Floats) -> Floats:
        """What a slope of the points (B,) couples each coefficient to itself by; (H | 1, C)."""
        stretch, back = self._in(DOUBLE)
        return np.asarray((stretch * np.swapaxes(back, 1, 2)) @ slope)

    @abstractmethod
    def coupling_table(self, spectrum: Floats) -> Floats:
        """What `between` reads: of slopes by place, (B, places), a table (places, W)."""

    @abstractmethod
    def between(
        self, table: Floats, places: Sequence[Ints], columns: Ints, others: Ints
    ) -> Floats:
        """What couples k columns (k, 1) to m others (m,), over the scales of both; (k, m).

        places : of slopes that are added, each (k, m).
        """

    @abstractmethod
    def couplings(
        self, slope: Floats, rows: Ints, columns: Ints, others: Ints, least: float
    ) -> Floats:
        """What a slope (B,) couples m coefficients to those of m other rows by; (m, C).

        rows, columns : of the coefficients, (m,). others : the other rows, (m,). least : of two
        columns, in parts of the largest; smaller ones are 0.
        """

    @cached_property
    def _places(self) -> Ints:
        """Of the modes among those of the chain, (H | 1, C); -1 where nothing moves."""
        place = {q: i for i, q in enumerate(self.numbers)}
        found = [place.get(q, -1) for q in self.modes.ravel().tolist()]
        return np.array(found, dtype=np.int64).reshape(self.modes.shape)

    def by_mode(self, p: Floats) -> Floats:
        """Coefficients of all modes of the chain, (H, N-1), of those (H, C)."""
        every = np.zeros((len(p), len(self.numbers)), dtype=p.dtype)
        places = np.broadcast_to(self._places, p.shape)
        rows, columns = np.nonzero(places >= 0)
        every[rows, places[rows, columns]] = p[rows, columns]
        return every

    def from_modes(self, p: Floats) -> Floats:
        """Coefficients (H, C) of those of all modes of the chain, (H, N-1)."""
        return np.asarray(p[:, self._places[0]])


def _times(rows: Floats, table: Floats) -> Floats:
    """Rows (H, K) times the tables (H | 1, K, L), each with its own or all with the one; (H, L)."""
    if len(table) == 1:
        return np.asarray(rows @ table[0])
    if table.shape[1] == 1:
        return np.asarray(rows * table[:, 0])
    return np.asarray((rows[:, :, None] * table).sum(axis=1))


@lru_cache(maxsize=16)
def linear_halves(chain: Chain) -> tuple[Floats, Floats]:
    """Omega_q of q = 0 .. N as the sums of two long doubles, (N + 1,) each; not to be changed."""
    with mpmath.workdps(2 * DIGITS):
        return in_halves([chain.linear_frequency(q) for q in range(chain.N + 1)])
