"""What a certificate says of a flat."""

from itertools import pairwise
from typing import Any, NamedTuple

from symfpu.checkers.every_length.claim import Theorem
from symfpu.checkers.every_length.signs import Powers
from symfpu.checkers.reading import Json, need


class Evidence(NamedTuple):
    """What a certificate says of one flat."""

    exceptions: list[tuple[int, Any, Any]]
    witnesses: dict[tuple[int, int], tuple[int, int, Powers]]
    undecided: list[int]


NOTHING = Evidence([], {}, [])


def read_evidence(data: Json, claim: Theorem, count: int) -> list[Evidence]:
    """Exceptions, witnesses and undecided modes, flat by flat, ascending and none twice."""
    found = [Evidence([], {}, []) for _ in range(count)]
    for key in ("exceptions", "undecided", "witnesses"):
        named = [row[:2] if key != "witnesses" else [row[0], row[2]] for row in data[key]]
        need(
            all(a < b for a, b in pairwise(named)),
            f"{key} not ascending",
        )
    for i, mode, rule, actual in data["exceptions"]:
        found[i].exceptions.append((mode, rule, actual))
    for i, point, mode, order, residue, *powers in data["witnesses"]:
        fits = 0 < order <= claim.order and sum(powers) == claim.degree(order)
        need(fits and len(powers) == claim.s, "a witness of wrong degree")
        found[i].witnesses[mode, order] = point, residue, tuple(powers)
    for i, mode in data["undecided"]:
        found[i].undecided.append(mode)
    return found
