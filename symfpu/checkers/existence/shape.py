"""Which unknowns an orbit has, and how they make up the stretches of its bonds.

Fixed ends: r_j = sum_q c_q cos(q theta_j), theta_j = (j + 1/2) pi / N, with 0 < q < N. A wave
that travels along a ring of N particles: r_j(t) = r(omega t - 2 pi s (j + 1/2) / N) of one even
function r, whose harmonic n moves as the mode |n s| modulo N does, 0 < q <= N/2.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple, TypeVar

from symfpu.checkers.existence.fixed_point import Cosines
from symfpu.checkers.reading import Json, need, whole

FIXED, TRAVELLING = "fixed", "travelling"
LARGEST_N = {FIXED: 512, TRAVELLING: 2**14}
Size = TypeVar("Size", int, Fraction)


class Shape(NamedTuple):
    """ends : FIXED or TRAVELLING; even : whether V is, and only odd harmonics move."""

    ends: str
    N: int
    seed: int
    even: bool

    @property
    def travelling(self) -> bool:
        """Whether it is a wave on a ring."""
        return self.ends == TRAVELLING

    @property
    def bonds(self) -> int:
        """Series that differ: one for each bond, or one for all."""
        return 1 if self.travelling else self.N

    @property
    def copies(self) -> int:
        """Bonds that move as one of those series does, at other times."""
        return self.N if self.travelling else 1

    @property
    def share(self) -> Fraction:
        """c_q[n] is this times sum_j cos(q theta_j) r_j[n]."""
        return Fraction(1) if self.travelling else Fraction(2, self.N)

    @property
    def modes(self) -> range:
        """All of them, with frequencies of their own."""
        return range(1, self.N // 2 + 1) if self.travelling else range(1, self.N)

    @property
    def place(self) -> tuple[int, int]:
        """Harmonic and mode of the seed."""
        return 1, abs(self.seed)

    @property
    def of_amplitude(self) -> Fraction:
        """(c_s[1] / Omega_s)^2 where A is 1."""
        return Fraction(1 if self.travelling else 2, self.N)

    def allowed(self, n: int) -> Sequence[int]:
        """The modes at a harmonic: q - n seed even, or the one that moves along with the wave."""
        if self.even and n % 2 == 0:
            return ()
        if not self.travelling:
            return range(1 if n * self.seed % 2 else 2, self.N, 2)
        q = n * self.seed % self.N
        return (min(q, self.N - q),) if q else ()

    def together(self, sizes: Sequence[Size]) -> Size:
        """Above their sum over the modes that one harmonic has; sizes of all modes."""
        return max(sizes) if self.travelling else sum(sizes[1:], start=sizes[0])

    def on_bond(self, cosines: Cosines, q: int, j: int) -> int:
        """cos(q theta_j), or 1 for the one series of a wave."""
        return cosines.one if self.travelling else cosines.bond(q, j)

    def squared(self, cosines: Cosines, q: int) -> int:
        """Omega_q^2 = 2 - 2 cos(q pi / N), or with 2 q on a ring."""
        return 2 * cosines.one - 2 * cosines.of(4 * q if self.travelling else 2 * q)


def read_shape(data: Json, *, even: bool) -> Shape:
    """That of a certificate."""
    ends, seed = data["ends"], data["seed"]
    need(
        ends in (FIXED, TRAVELLING), "ends that are neither fixed nor of a travelling wave"
    )
    N = whole(data["N"], 2 if ends == FIXED else 3, LARGEST_N[ends], "N")
    if ends == FIXED:
        return Shape(FIXED, N, whole(seed, 1, N - 1, "seed"), even)
    q = whole(seed, -((N - 1) // 2), N // 2, "seed")
    need(q != 0, "mode 0 does not move")
    return Shape(TRAVELLING, N, q, even)
