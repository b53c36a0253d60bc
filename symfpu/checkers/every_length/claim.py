"""What is claimed for every N, and the flats of which something is said."""

from typing import NamedTuple

from symfpu.checkers.propagation.case import MODELS, Case
from symfpu.checkers.reading import Json, need

MOST_SEEDS = 3
LARGEST_DEGREE = {1: 201, 2: 13, 3: 5}  # by number of seeds; beyond, a check takes hours
LARGEST_N = 4096


Row = tuple[int, ...]


class Theorem(NamedTuple):
    """What is claimed: the model, how many seeds, the last order."""

    model: str
    s: int
    order: int

    def degree(self, k: int) -> int:
        """How many leaves a term of order k has."""
        return 1 + k * MODELS[self.model][0]

    def case(self, flat: Row) -> Case:
        """The representative of a flat as one case."""
        N, *seeds = flat
        return Case(N, self.order, seeds, *MODELS[self.model])


def read_claim(data: Json) -> Theorem:
    """Model, number of seeds and order, their sizes bounded."""
    model, s, order = data["model"], data["seeds_number"], data["order"]
    fits = model in MODELS and 0 < s <= MOST_SEEDS and order > 0
    need(fits, "wrong model, number of seeds or order")
    claim = Theorem(model, s, order)
    need(claim.degree(order) <= LARGEST_DEGREE[s], f"order {order} is beyond this checker")
    return claim


def read_flats(data: Json, claim: Theorem) -> list[Row]:
    """N and ascending seeds of the flats of which something is said."""
    found = [tuple(row) for row in data["flats"]]
    for N, *seeds in found:
        need(N <= LARGEST_N and len(seeds) == claim.s, "a representative of wrong size")
        need(
            seeds == sorted({q for q in seeds if 0 < q < N}),
            "seeds are not ascending modes",
        )
    need(len(set(found)) == len(found), "a flat is listed twice")
    return found
