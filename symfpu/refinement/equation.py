"""What Newton's method and its conditions ask of the equations of a torus.

Of fixed ends one column of coefficients for each mode (`symfpu.refinement.invariance`), of a ring
one column for all of them (`symfpu.refinement.waves`).
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from symfpu.refinement.lattice import Lattice

Floats = NDArray[Any]
Ints = NDArray[np.int64]
Slopes = tuple[Floats, Floats]  # derivatives by coefficients (H, C) and by shifts (s,)


class TorusEquation(Protocol):
    """The equations (nu.omega)^2 c - Omega^2 c = force of coefficients c (H, C).

    seeds : s of them. harmonics : the nu, (H, s). mask : which c are unknown, (H, C).
    seed_rows, seed_columns : where the amplitudes of the seeds stand. seed_frequencies : their
    linear frequencies, (s,). linear : Omega of every c, broadcast with (H, C).
    """

    seeds: tuple[int, ...]
    harmonics: Ints
    mask: NDArray[np.bool_]
    seed_rows: Ints
    seed_columns: Ints
    linear: Floats

    @property
    def points(self) -> int: ...
    @property
    def seed_frequencies(self) -> Floats: ...

    def divisors(self, shifts: Floats) -> Floats:
        """(nu.omega)^2 - Omega^2 for omega = Omega + shifts of the seeds; (H, C)."""
        ...

    def rates(self, shifts: Floats) -> Floats:
        """nu.omega; (H,)."""
        ...

    def force(self, cosines: Floats) -> Floats:
        """Of the anharmonic part of V, in the precision of the cosines; (H, C)."""
        ...

    def force_on(self, grid: Lattice, cosines: Floats) -> Floats:
        """The same of coefficients at the harmonics of another lattice (M, C), at all of those."""
        ...

    def linear_at(self, harmonics: Ints) -> Floats:
        """Omega of every c at other harmonics (M, s); broadcast with (M, C)."""
        ...

    def rounding(self, cosines: Floats, kind: type) -> Floats:
        """What rounding in numbers of a kind makes of the force, about; broadcast with (H, C)."""
        ...

    def slopes(self, cosines: Floats) -> Floats:
        """V''(r) - 1 at the points, in doubles."""
        ...

    def steps(self, slopes: Floats, most: int) -> Ints:
        """The largest harmonics of the slopes, so many at most, with both signs; (k, s)."""
        ...

    def slope_changes(self, cosines: Floats, weights: Floats) -> Floats:
        """Derivatives of the mean of weights times slopes, (H, C); weights as the slopes are.

        By differences, good to some ten digits: for Newton's matrix.
        """
        ...

    def force_change(self, slopes: Floats, change: Floats) -> Floats:
        """The derivative of the force along a change of the coefficients; (H, C)."""
        ...

    def block(self, slopes: Floats, rows: Ints, columns: Ints) -> Floats:
        """The derivative of the force between m chosen unknowns; (m, m)."""
        ...

    def sparse_rows(self, slopes: Floats, rows: Ints, columns: Ints) -> Any:
        """The rows of m chosen unknowns in it, their largest part, sparse; (m, unknowns).

        Those are in the order of the mask.
        """
        ...

    def energy(
        self, cosines: Floats, shifts: Floats, *, harmonic: bool
    ) -> tuple[np.longdouble, Slopes]:
        """H, or the harmonic energy sum E_q, and its derivatives."""
        ...

    def seed_energy(
        self, place: int, cosines: Floats, shifts: Floats
    ) -> tuple[np.longdouble, Slopes]:
        """E_q of a seed averaged over the angles, and its derivatives."""
        ...
