"""Which modes a product drives, and how strongly: the signed sums of Eq. transa."""

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from symfpu.checkers.reading import need

MOST_STEPS = 2 * 10**6
SUMS_A_STEP = 32  # signed sums that take as long as one step


class Budget:
    """Counts steps, and refuses a certificate that would take too many."""

    def __init__(self) -> None:
        self.steps = 0

    def counted(self, items: Iterable[Any]) -> Iterator[Any]:
        """The items, each a step."""
        for item in items:
            self.spend(1)
            yield item

    def spend(self, steps: int) -> None:
        """So many at once."""
        self.steps += steps
        need(self.steps <= MOST_STEPS, "checking it would take more than 2 million steps")


def coupling_steps(N: int, factors: int) -> int:
    """Steps of the couplings of a product, beyond those of three factors."""
    sums = min(1 << factors, 4 * N)
    return factors * sums // SUMS_A_STEP


def couplings(N: int, *modes: int) -> list[tuple[int, int]]:
    """Each q with B_qlm, C_qlmn or their like, where that is not zero: Eq. transa, with all the
    signed sums, + for those that make 0 modulo 4N with q and - for those that make 2N.
    """
    sums = signed_sums(N, modes)
    found = []
    for q in {-total % (2 * N) for total in sums}:
        value = sums[-q % (4 * N)] - sums[(2 * N - q) % (4 * N)]
        if value and 0 < q < N:
            found.append((q, value))
    return found


def signed_sums(N: int, modes: tuple[int, ...]) -> Counter[int]:
    """How many choices of signs give each sum of the modes, modulo 4N."""
    sums = Counter({0: 1})
    for l in modes:
        longer: Counter[int] = Counter()
        for total, count in sums.items():
            longer[(total + l) % (4 * N)] += count
            longer[(total - l) % (4 * N)] += count
        sums = longer
    return sums
