"""Every claim of a propagation certificate in turn."""

from pathlib import Path

from symfpu.checkers.propagation.case import Case, check_sizes, read_case
from symfpu.checkers.propagation.claims import (
    check_conclusions,
    check_names,
    check_probabilities,
    check_zeros_are_complete,
    excitation_orders,
)
from symfpu.checkers.propagation.couplings import Budget
from symfpu.checkers.propagation.potentials import is_known
from symfpu.checkers.propagation.reading import read_certificate
from symfpu.checkers.propagation.residues import check_points, check_witnesses
from symfpu.checkers.propagation.rule import propagation_rule
from symfpu.checkers.propagation.zeros import (
    check_zeros_by_couplings,
    check_zeros_by_identity,
)
from symfpu.checkers.reading import Json, verified


def check_certificate(data: Json) -> list[str]:
    """Every claim in turn; what was checked, in three lines."""
    case, budget = read_case(data), Budget()
    check_sizes(data, case)
    check_names(data)
    orders = excitation_orders(data, case)
    zeros = check_zeros_are_complete(data, case, orders)
    check_probabilities(data)
    rule = propagation_rule(case, budget)
    verdict = check_conclusions(data, case, rule, orders)
    check_zeros_by_couplings(data, case, budget)
    check_zeros_by_identity(data, case, budget)
    check_points(data, case)
    check_witnesses(data, case, budget)
    return report(data, case, verdict, zeros, budget.steps)


def report(data: Json, case: Case, verdict: str, zeros: int, steps: int) -> list[str]:
    """What was checked."""
    unsure = sorted({e["mode"] for e in data["undecided"]})
    primes = [e["prime"] for e in data["points"]]
    excited = f"{len(data['excited'])} modes excited"
    return [
        f"theorem: {sentence(data, case, verdict)}",
        f"{excited}: residues computed again, modulo {primes}, in {steps} steps",
        f"{zeros} zeros before: by couplings or identity; undecided, not checked: modes {unsure}",
    ]


def sentence(data: Json, case: Case, verdict: str) -> str:
    """What is proved of the rule."""
    chain = f"in the {law(data)}, N = {case.N}, seeds {case.seeds}, to order {case.order}"
    unsure = {e["mode"] for e in data["undecided"]}
    modes = [e["mode"] for e in data["exceptions"] if e["mode"] not in unsure]
    says = {
        "proved": "holds",
        "refuted": f"does not hold, at modes {modes}",
        "undecided": "is not decided",
    }
    return f"{chain}, the propagation rule {says[verdict]}, for generic frequencies"


def law(data: Json) -> str:
    """What chain it is, and whether the coefficients are known to be those of its potential."""
    if data["schema"] == 1:
        return f"{data['model']} chain"
    name = data["potential"]
    unknown = (
        "" if is_known(name) else " (its coefficients as written, the name not checked)"
    )
    return f"chain of potential {name:.80}{unknown}"


def verify(path: str | Path) -> list[str]:
    """Lines that say what was checked in the certificate of a file.

    Raises CertificateError, with the reason, if it is not right.
    """
    return verified(path, read_certificate, check_certificate)[1]
