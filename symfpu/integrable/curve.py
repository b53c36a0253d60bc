"""Actions and frequencies from the edges of the bands, by integrals over the gaps alone.

A ring of n particles has the discriminant Delta(lambda), Delta^2 - 4 = 4^n (lambda - top)
(lambda - bottom) prod_j ((lambda - e_j)^2 - w_j^2) with gaps of centre e_j and half width w_j. Its
actions are (Flaschka, McLaughlin; scaled to V = (e^(2ar) - 1 - 2ar)/(4a^2))

    I_k = 1/(2 pi a^2) int_(gap k) arcosh |Delta/2| d lambda,                                   (1)

in the linear limit the energy of the wave divided by its frequency. The coefficient of
lambda^(n-2) in Delta is -2^n a^2 H + const, all higher ones are fixed; so the change of Delta with
I_k alone is a polynomial f_k of degree n - 2 and, by omega_k = dH/dI_k,

    omega_k = leading coefficient of F_k,
    int_(gap i) F_k / sqrt(Delta^2 - 4) d lambda = 2 pi delta_ik / 2^n.

In the basis prod_(l != m) (lambda - e_l) the integrals form a matrix M, and omega solves
M^T omega = 2 (1, ..., 1). Substituting lambda = e_i + w_i cos(phi) turns integrals over a gap into
means over phi (`symfpu.integrable.quadrature`). A closed gap has w_i = 0: its row is diagonal, and
omega_i is the frequency of small oscillations about the torus. No formula asks whether a gap is
closed.

With C = Delta'/(n 2^n), determined by int_(gap i) C / sqrt(Delta^2 - 4) = 0, (1) becomes

    I_k = n/(2 pi a^2) int_(gap k) (lambda - e_k) C / sqrt(...) d lambda.

Fixed ends with N bonds are the odd states of the ring of n = 2N. There Delta is even; in z = 2
lambda^2 - 1 it is a polynomial of degree N, again with leading coefficient 2^N, and bottom = -1,
where it stays +-2. Gap q of z is the pair q, 2N - q of the ring; gap N of the ring is closed. The
same steps give, with d lambda = dz / sqrt(8 (z + 1)) and H half of the ring's,

    M^T omega = sqrt(2) (1, ..., 1) without the factor z + 1 under the root,
    I_q = N/(pi a^2 sqrt(8)) int_(gap q) sqrt(z + 1) C(z) / sqrt(...) dz.

Source: ours, after Date and Tanaka.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.integrable.discriminant import Edges
from symfpu.integrable.quadrature import mean_rule
from symfpu.numbers.arithmetic import DOUBLES, Arithmetic, Numbers
from symfpu.numbers.mpfr import MPFR, in_mpf


@dataclass(frozen=True)
class SpectralCurve:
    """Edges of the bands, and what they belong to.

    edges : in lambda for a ring, in z = 2 lambda^2 - 1 for fixed ends, there with bottom = -1.
    length : n, or N; fixed : whether the ends are; a : of the potential, exact. numbers : the
    arithmetic of the edges.
    """

    edges: Edges
    length: int
    fixed: bool
    a: Fraction
    numbers: Arithmetic

    @property
    def open(self) -> NDArray[np.intp]:
        """Indices of gaps that are not closed."""
        return np.nonzero(self.edges.half_widths)[0]

    def frequencies(self) -> Numbers:
        """omega_k of every gap, shape (n-1,): of its own angle, or normal where it is closed."""
        everywhere = np.arange(len(self.edges.centres))
        right = self._right(everywhere)
        matrix = self._means(everywhere)
        if len(matrix):
            inside = self._solve(matrix[:, self.open].T, right[self.open])
            right = right - inside @ matrix
        omega = right / self._closed_diagonal()
        if len(matrix):
            omega[self.open] = inside
        return np.asarray(omega)

    def open_frequencies(self) -> Numbers:
        """omega_k of the open gaps alone, in their order."""
        matrix = self._means(self.open)
        right = self._right(self.open)
        return self._solve(matrix.T, right)

    def actions(self) -> Numbers:
        """I_k of every gap, shape (n-1,); zero where it is closed."""
        actions = self.edges.centres * 0
        if not len(self.open):
            return actions
        rules = [self._rule(i) for i in self.open]
        bases = [
            self._basis(i, offsets, self.open, outer_root=True)
            for i, (offsets, _) in zip(self.open, rules, strict=True)
        ]
        y = self._critical(rules, bases)
        for k, i in enumerate(self.open):
            offsets, weights = rules[k]
            density = bases[k][:, k] * offsets + bases[k] @ y
            actions[i] = (density * offsets * self._lever(i, offsets) * weights).sum()
        scale = self.length / (2 * self.numbers.number(self.a**2))
        return np.asarray(actions * scale)

    def _right(self, columns: NDArray[np.intp]) -> Numbers:
        """2 (1, ..., 1), or sqrt(2) (1, ..., 1) for fixed ends."""
        two = self.numbers.array(np.full(len(columns), 2))
        return np.asarray(self.numbers.sqrt(two) if self.fixed else two)

    def _lever(self, i: int, offsets: Numbers) -> Numbers:
        """lambda - lambda(e_i) over z - e_i, at nodes of a gap."""
        if not self.fixed:
            return offsets * 0 + 1
        above = self.edges.centres[i] + 1
        roots = self.numbers.sqrt(offsets + above) + self.numbers.sqrt(offsets * 0 + above)
        return np.asarray(1 / (roots * self.numbers.sqrt(offsets * 0 + 2)))

    def _means(self, columns: NDArray[np.intp]) -> Numbers:
        """Rows of M for the open gaps."""
        rows = []
        for i in self.open:
            offsets, weights = self._rule(i)
            values = self._basis(i, offsets, columns, outer_root=not self.fixed)
            rows.append(weights @ values)
        return np.array(rows)

    def _critical(
        self, rules: Sequence[tuple[Numbers, Numbers]], bases: Sequence[Numbers]
    ) -> Numbers:
        """y of the open gaps in C = prod (z - e_l) + sum_m y_m prod_(l != m) (z - e_l)."""
        matrix, constants = [], []
        for k, (offsets, weights) in enumerate(rules):
            matrix.append(weights @ bases[k])
            constants.append(-(bases[k][:, k] * offsets * weights).sum())
        return self._solve(np.array(matrix), np.array(constants))

    def _basis(
        self, i: int, offsets: Numbers, columns: NDArray[np.intp], *, outer_root: bool
    ) -> Numbers:
        """prod_(l != m) (z - e_l) / prod_(l != i) root_l at nodes z of gap i, m in columns.

        root_l^2 = (z - e_l)^2 - w_l^2, with the sign of z - e_l. outer_root : whether z - bottom
        stands under the outer root. Shape (nodes, columns).
        """
        e = self.edges.centres
        product = 1 / self._outer(i, offsets, outer_root)
        for l in self.open:
            if l != i:
                product = product / self._root_ratio(offsets - (e[l] - e[i]), l)
        differences = offsets[:, None] - (e[columns] - e[i])
        differences[:, columns == i] = 1
        values = (product * offsets)[:, None] / differences
        values[:, columns == i] = product[:, None]
        return np.asarray(values)

    def _root_ratio(self, difference: Numbers, l: int) -> Numbers:
        relative = (1 / difference) * self.edges.half_widths[l]
        return self.numbers.sqrt((1 - relative) * (1 + relative))

    def _outer(self, i: int, offsets: Numbers, outer_root: bool) -> Numbers:
        e = self.edges.centres[i]
        below = (offsets - (self.edges.top - e)) * -1
        if not outer_root:
            return self.numbers.sqrt(below)
        return self.numbers.sqrt(below * (offsets + (e - self.edges.bottom)))

    def _closed_diagonal(self) -> Numbers:
        """Entries of M at closed gaps, where z = e_i is the only node; ones elsewhere."""
        e = self.edges.centres
        below, above = (e - self.edges.top) * -1, e - self.edges.bottom
        diagonal = 1 / self.numbers.sqrt(below if self.fixed else below * above)
        closed = self.edges.half_widths == 0
        for l in self.open:
            diagonal[closed] = diagonal[closed] / self._root_ratio(e[closed] - e[l], l)
        return np.asarray(diagonal)

    def _rule(self, i: int) -> tuple[Numbers, Numbers]:
        """Offsets from the centre of gap i, and weights of the mean over phi; sum of weights 1."""
        return mean_rule(self.edges, i, self.numbers)

    def _solve(self, matrix: Numbers, right: Numbers) -> Numbers:
        if self.numbers is DOUBLES:
            return np.asarray(np.linalg.solve(matrix, right))
        if self.numbers is MPFR:
            matrix, right = in_mpf(matrix), in_mpf(right)
        columns = mpmath.matrix([[x] for x in right])
        solution = mpmath.lu_solve(mpmath.matrix(matrix.tolist()), columns)
        return self.numbers.array(list(solution))
