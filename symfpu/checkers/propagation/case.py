"""What a propagation certificate is about: a chain, its seeds, the last order."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from symfpu.checkers.propagation.potentials import read_potential
from symfpu.checkers.reading import Json, need, whole

MOST_SEEDS = 64
LARGEST_N = 4096
HIGHEST_ORDER = 1000  # and less where N is larger: MOST_PLACES modes and orders
MOST_PLACES = 10**6
LARGEST_RESIDUE = 2**64
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
    N = whole(data["N"], 2, LARGEST_N, "wrong N, order or model: N")
    highest = min(HIGHEST_ORDER, MOST_PLACES // N)
    order = whole(data["order"], 0, highest, "wrong N, order or model: the order")
    seeds = data["seeds"]
    modes = sorted({q for q in seeds if 0 < q < N})
    need(seeds == modes[:MOST_SEEDS] != [], "seeds are not 1 to 64 ascending modes")
    if data["schema"] == 1:
        need(data["model"] in MODELS, "wrong N, order or model")
        return Case(N, order, seeds, *MODELS[data["model"]])
    return Case(N, order, seeds, *read_potential(data, order))


def check_sizes(data: Json, case: Case) -> None:
    """Every number of the claims is in its range, before any of them is used."""
    for e in data["excited"]:
        whole(e["mode"], 1, case.N - 1, "a mode that is excited")
        whole(e["order"], 1, case.order, "the order of a mode")
        whole(e["point"], 0, len(data["points"]), "the point of a mode")
        whole(e["residue"], 0, LARGEST_RESIDUE, "a residue")
        check_list(e["monomial"], case.degree(case.order), "an exponent of a monomial")
    for e in data["vanishing"] + data["undecided"]:
        whole(e["mode"], 1, case.N - 1, "a mode that vanishes")
        check_list(e["orders"], case.order, "an order at which a mode vanishes")
    for e in data["points"]:
        whole(e["prime"], 2, LARGEST_RESIDUE, "a prime")
        whole(e["root"], 0, LARGEST_RESIDUE, "a root")
        check_list(e["frequencies"], LARGEST_RESIDUE, "a frequency")


def check_list(values: Any, most: int, name: str) -> None:
    """Integers from 0 to the most."""
    need(type(values) is list, f"{name}: no list")
    for value in values:
        whole(value, 0, most, name)
