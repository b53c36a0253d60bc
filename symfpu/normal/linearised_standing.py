"""The equations of motion of a ring linearised about standing waves: sines and cosines apart.

A torus of standing waves on a ring of 2N is one of fixed ends on N bonds, unfolded: odd about site
0. Odd deviations, x_j = sum Q_q sin(q pi j/N), are those of the fixed ends; even ones, cosines,
stretch the same bonds by other amounts,

    r_j = -sum Omega_q Q_q sin(q (j + 1/2) pi/N) of unit norm, q = 1 .. N,

and the two do not couple. The modes q and -q of the ring stand for them: q > 0 for the sine, -q
and N for the cosines. At rest both have Omega_q; on the torus the pair is split. The cosine q = 0,
uniform motion, is left out: nothing couples to it. Ours.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy

import mpmath
import numpy as np

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.normal.linearised import LinearisedFlow, Mask, Values
from symfpu.refinement.equation import Floats, Ints
from symfpu.refinement.invariance import DIGITS, long
from symfpu.tori.quasiperiodic import FourierTorus, QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus, unfold

TIMES = (0.0, 0.7, 1.9)  # at which a torus is compared with the one that is unfolded again
SAME = 1e-12  # of coordinates


class LinearisedStanding(LinearisedFlow):
    """K and the frequencies of the torus of fixed ends that a ring of standing waves unfolds.

    `of(q)` chooses sines or cosines, and with them the columns: q = 1 .. N-1, or N.
    """

    def __init__(self, ring: Chain, folded: FourierTorus, harmonics: Ints) -> None:
        super().__init__(folded, harmonics)
        self.ring, self._cosines = ring, False

    def of(self, q: int) -> LinearisedStanding:
        if self._cosines or is_sine(self.ring, q):
            return self
        found = copy(self)
        found.__dict__.pop("means", None)
        found._cosines = True
        found._set_cosines()
        return found

    def _set_cosines(self) -> None:
        """Stretches of half of the bonds by even deviations, and the way back."""
        N = self.chain.N
        modes, half = np.arange(1, N + 1), np.arange((N + 1) // 2)
        with mpmath.workdps(2 * DIGITS):
            linear = [long(self.ring.linear_frequency(q)) for q in range(1, N + 1)]
            sines = [long(mpmath.sinpi(mpmath.mpf(k) / (2 * N))) for k in range(4 * N)]
        self.linear = np.array(linear)
        angles = np.outer(modes, 2 * half + 1) % (4 * N)
        norms = np.sqrt(np.where(modes == N, 1, 2) / N)
        every = (norms * self.linear)[:, None] * np.array(sines)[angles]
        self._stretch = every.astype(float)
        self._back = self._stretch * np.where(2 * half + 1 == N, 1, 2)

    def column(self, q: int) -> int:
        return abs(q) - 1

    def mode_at(self, row: int, column: int) -> int:
        q = column + 1
        return -q if self._cosines and q < self.chain.N else q

    def frequency(self, q: int) -> float:
        return float(self.linear[abs(q) - 1])

    def allowed(self, q: int) -> Mask:
        modes = np.arange(1, len(self.linear) + 1)
        parity = (self.harmonics @ np.array(self.seeds) + q) % 2
        mask = parity[:, None] == modes % 2
        if self.chain.potential.even:
            mask &= (self.harmonics.sum(axis=1) % 2 == 0)[:, None]
        return np.asarray(mask)

    @property
    def _places(self) -> Ints:
        """Of the columns among the modes of the ring."""
        numbers = self.ring.mode_numbers
        columns = range(len(self.linear))
        return np.array([numbers.index(self.mode_at(0, c)) for c in columns])

    def by_mode(self, p: Values) -> Values:
        every = np.zeros((len(p), self.ring.N - 1), dtype=p.dtype)
        every[:, self._places] = p
        return every

    def table(self, p: Values) -> Values:
        return np.asarray(p[:, self._places])


def is_sine(ring: Chain, q: int) -> bool:
    """Whether a mode stands for odd deviations about standing waves."""
    return 0 < 2 * q < ring.N


def coupled_groups(
    torus: QuasiPeriodic | RingTorus, sigma: Mapping[int, float]
) -> list[tuple[Chain, dict[int, float]]]:
    """Frequencies that may couple, by mode, with the chain whose selection rules they have.

    All of them, but about standing waves sines and cosines apart, by the rules of fixed ends.
    """
    ring = torus.chain
    if not (isinstance(torus, RingTorus) and is_standing(torus)):
        return [(ring, dict(sigma))]
    fixed = Chain(ring.N // 2, potential=ring.potential)
    sines = {q: w for q, w in sigma.items() if is_sine(ring, q)}
    cosines = {q: w for q, w in sigma.items() if q not in sines}
    return [(fixed, sines), (fixed, cosines)]


def is_standing(torus: RingTorus) -> bool:
    """Whether some harmonic is in another mode than nu.seeds: then no wave travels."""
    own = torus.harmonics @ np.array(torus.seeds)
    return bool(((own - torus.modes) % torus.chain.N).any())


def folded(torus: RingTorus) -> FourierTorus:
    """The torus of fixed ends that standing waves unfold; InputError for other waves."""
    ring = torus.chain
    sines = all(is_sine(ring, m) for m in torus.modes.tolist())
    if ring.N % 2 == 0 and sines:
        found = _of_fixed_ends(torus)
        again = unfold(found).mode_coordinates(TIMES)
        if np.allclose(again, torus.mode_coordinates(TIMES), rtol=SAME, atol=SAME):
            return found
    allowed = "travelling waves, or standing ones as unfold makes them"
    advice = "refine the solution with fixed ends and unfold it"
    raise InputError("solution", "other waves of a ring", allowed, advice)


def _of_fixed_ends(torus: RingTorus) -> FourierTorus:
    """A torus of fixed ends of the waves whose harmonic has no negative first number."""
    fixed = Chain(torus.chain.N // 2, potential=torus.chain.potential)
    rows: dict[tuple[int, ...], Floats] = {}
    waves = zip(torus.harmonics.tolist(), torus.modes, torus.sines, strict=True)
    for nu, m, b in waves:
        if next((n for n in nu if n), 0) >= 0:
            rows.setdefault(tuple(nu), np.zeros(fixed.N - 1))[m - 1] = b
    harmonics, cosines = np.array(list(rows)), np.array(list(rows.values()))
    phases = dict(torus.phases)
    return FourierTorus(fixed, torus.seeds, torus.frequencies, harmonics, cosines, phases)
