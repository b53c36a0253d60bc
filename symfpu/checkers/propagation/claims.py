"""Rule, orders, exceptions and verdict of a certificate: each follows from the rest."""

import re
from typing import Any

from symfpu.checkers.propagation.case import Case
from symfpu.checkers.reading import Json, need

# above 0, up to 1
PROBABILITY = re.compile(
    r"1(\.0+)?(e[+-]?0+)?|0\.0*[1-9][0-9]*|[1-9](\.[0-9]+)?e-0*[1-9][0-9]*"
)


def check_names(data: Json) -> None:
    """Each mode is named once in a list, in ascending order.

    Of zeros, once for each way to show them.
    """
    check_ascending([(e["mode"], e["by"]) for e in data["vanishing"]])
    check_ascending([e["mode"] for e in data["undecided"]])
    check_ascending([e["mode"] for e in data["excited"]])


def check_ascending(names: list[Any]) -> None:
    """In ascending order, none twice."""
    need(names == sorted(set(names)), f"not ascending, or twice: {names!r:.200}")


def excitation_orders(data: Json, case: Case) -> dict[int, int]:
    """The order at which each mode is said to be excited: 0 for seeds."""
    witnessed = {e["mode"]: e["order"] for e in data["excited"]}
    return witnessed | dict.fromkeys(case.seeds, 0)


def check_zeros_are_complete(data: Json, case: Case, orders: dict[int, int]) -> int:
    """At each order before its own, a mode is said to vanish or to be undecided.

    Returns how many zeros that are.
    """
    claimed = []
    for e in data["vanishing"] + data["undecided"]:
        if e["orders"] == sorted(e["orders"]):
            claimed += [(e["mode"], k) for k in e["orders"] or [0]]
    expected = []
    for q in range(1, case.N):
        last = orders.get(q, case.order + 1)
        expected += [(q, k) for k in range(1, last)]
    need(sorted(claimed) == expected, "vanishing, undecided: wrong orders")
    return len(expected)


def check_probabilities(data: Json) -> None:
    """Each undecided zero has its probability of error."""
    texts = [e["error_probability"] for e in data["undecided"]]
    need(all(map(PROBABILITY.fullmatch, texts)), "an error_probability is not in (0, 1]")


def check_conclusions(
    data: Json, case: Case, rule: list[list[int]], orders: dict[int, int]
) -> str:
    """Rule, actual sets, exceptions and verdict follow from the rest; returns the verdict."""
    predicted = {q: k for k, modes in enumerate(rule) for q in modes}
    unsure = {e["mode"] for e in data["undecided"]}
    exceptions = find_exceptions(case, predicted, orders)
    decided = {e["mode"] for e in exceptions} - unsure
    verdict = "refuted" if decided else "undecided" if unsure else "proved"
    actual = [sorted(q for q in orders if orders[q] == k) for k in range(case.order + 1)]
    conclusions = {
        "rule": rule,
        "actual": actual,
        "exceptions": exceptions,
        "verdict": verdict,
    }
    for key, value in conclusions.items():
        need(data[key] == value, f"{key} is not {value!r:.200}")
    named = len(case.seeds) + len(data["excited"])
    need(
        len(orders) == named == sum(map(len, actual)),
        "excited: a mode is a seed, or beyond the order",
    )
    return verdict


def find_exceptions(
    case: Case, predicted: dict[int, int], orders: dict[int, int]
) -> list[Json]:
    """Modes whose order is not the predicted one."""
    found: list[Json] = []
    for q in range(1, case.N):
        expected, actual = predicted.get(q), orders.get(q)
        if expected != actual:
            found.append({"mode": q, "predicted": expected, "actual": actual})
    return found
