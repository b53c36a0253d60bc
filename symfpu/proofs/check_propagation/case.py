"""What a propagation certificate is about: a chain, its seeds, the last order."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from symfpu.proofs.check_propagation.potentials import read_potential
from symfpu.proofs.reading import Json, need

MOST_SEEDS = 64
LARGEST_N = 4096
MODELS: dict[str, tuple[int, dict[int, Any]]] = {"alpha": (1, {2: 1}), "beta": (2, {3: 1})}


class Case(NamedTuple):
    """N, the last order, the seeds, how much the degree in the amplitudes grows with the order,
    and the force: g_n by power n, where that is not zero.
    """

    N: int
    order: int
    seeds: list[int]
    step: int
    force: Mapping[int, Any]

    def degree(self, k: int) -> int:
        """Of order k in the amplitudes."""
        return 1 + k * self.step

    def added(self, n: int) -> int:
        """How much a product of n factors adds to the sum of their orders."""
        return (n - 1) // self.step


def read_case(data: Json) -> Case:
    """The chain and its seeds, their sizes bounded."""
    N, order, seeds = data["N"], data["order"], data["seeds"]
    fits = 1 < N <= LARGEST_N and max(1000, N) * order <= 10**6
    need(fits, "wrong N, order or model")
    modes = sorted({q for q in seeds if 0 < q < N})
    need(seeds == modes[:MOST_SEEDS] != [], "seeds are not 1 to 64 ascending modes")
    if data["schema"] == 1:
        need(data["model"] in MODELS, "wrong N, order or model")
        return Case(N, order, seeds, *MODELS[data["model"]])
    return Case(N, order, seeds, *read_potential(data, order))
