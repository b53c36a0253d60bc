"""A sweep of the propagation rule as text."""

from __future__ import annotations

from symfpu.proofs.sweeps import Sweep, SweepCase
from symfpu.reports.tables import markdown_table


def sweep_markdown(sweep: Sweep) -> str:
    """A sweep of the propagation rule: how often it holds by N and number of seeds, and every
    exception.
    """
    groups: dict[tuple[int, int], list[SweepCase]] = {}
    for case in sweep.cases:
        groups.setdefault((case.N, len(case.seeds)), []).append(case)
    rows = [
        [
            str(N),
            str(s),
            str(len(cases)),
            *(str(sum(c.verdict == v for c in cases)) for v in ("proved", "refuted", "undecided")),
        ]
        for (N, s), cases in groups.items()
    ]
    exceptions = [
        [
            str(case.N),
            ", ".join(map(str, case.seeds)),
            "; ".join(f"{q}: {p} -> {a}" for q, p, a in case.exceptions),
        ]
        for case in sweep.exceptions
    ]
    holds = sum(case.corrected_rule_holds for case in sweep.cases)
    parts = [
        f"## {sweep.model} model, order {sweep.order}",
        f"{len(sweep.cases)} seed sets. The proposition holds in {sum(c.verdict == 'proved' for c in sweep.cases)}; "
        f"the corrected rule predicts the actual sets in {holds}.",
        markdown_table(["N", "seeds", "sets", "proved", "refuted", "undecided"], rows),
    ]
    if exceptions:
        parts += [
            "Exceptions (mode: predicted order -> actual order):",
            markdown_table(["N", "seeds", "exceptions"], exceptions),
        ]
    return "\n\n".join(parts) + "\n"
