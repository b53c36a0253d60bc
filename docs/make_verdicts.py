"""The tables of verdicts in docs/errata.md, and their counts in docs/paper.md, from the report of a reproduction.

.venv/bin/symfpu reproduce all -o out && .venv/bin/python docs/make_verdicts.py out/report.json
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from symfpu.paper.claims import VERDICTS

PAGE = Path(__file__).parent / "errata.md"
COUNTED = Path(__file__).parent / "paper.md"
# by the heading above its table, the target whose claims it has
TARGETS = {
    "Section 5 and the sets of section 6": "section5",
    "Statements that no figure shows": "statements",
    **{f"Fig. {i}": f"fig{i}" for i in range(1, 10)},
    "Appendix F and the captions": "table",
    "Convergence of the series of Fig. 1": "convergence",
}
HEAD = "| section | the paper says | verdict | evidence |\n| --- | --- | --- | --- |\n"


def verdict_rows(claims: list[dict[str, str]]) -> list[str]:
    """A line of the table for each claim, as `report.json` has it."""
    lines = []
    for claim in claims:
        text, ours = (claim[name].replace("|", r"\|") for name in ("text", "ours"))
        lines.append(f"| {claim['section']} | {text} | **{claim['verdict']}** | {ours} |\n")
    return lines


def with_verdicts(page: str, figures: dict[str, Any]) -> str:
    """The page with the tables of all figures that there are; KeyError for one without a place."""
    for heading, target in TARGETS.items():
        if target in figures:
            page = _with_table(page, heading, verdict_rows(figures[target]["claims"]))
    return page


def _with_table(page: str, heading: str, rows: list[str]) -> str:
    place = re.compile(
        rf"(^### {re.escape(heading)}\n\n{re.escape(HEAD)})(?:\|.*\n)+", re.MULTILINE
    )
    made, count = place.subn(lambda found: found[1] + "".join(rows), page)
    if count != 1:
        raise KeyError(f"errata.md has no table under '### {heading}'")
    return made


def with_counts(page: str, verdicts: str) -> str:
    """The page with a row of counts for each table of the page of verdicts."""
    head = f"| claims about | {' | '.join(VERDICTS)} |\n|{' --- |' * (1 + len(VERDICTS))}\n"
    made, count = re.subn(
        rf"({re.escape(head)})(?:\|.*\n)+", lambda found: found[1] + _counts(verdicts), page
    )
    if count != 1:
        raise KeyError(f"paper.md has no table under {head!r}")
    return made


def _counts(verdicts: str) -> str:
    rows = ""
    for heading in TARGETS:
        table = verdicts.split(f"### {heading}\n\n")[1].split("\n\n")[0]
        found = Counter(re.findall(rf"\| \*\*({'|'.join(VERDICTS)})\*\* \|", table))
        anchor = re.sub("[^a-z0-9-]", "", heading.lower().replace(" ", "-"))
        cells = " | ".join(str(found[verdict] or "") for verdict in VERDICTS)
        rows += f"| [{heading}](errata.md#{anchor}) | {cells} |\n"
    return rows


def main(report: str) -> None:
    figures = json.loads(Path(report).read_text())["figures"]
    verdicts = with_verdicts(PAGE.read_text(), figures)
    PAGE.write_text(verdicts)
    COUNTED.write_text(with_counts(COUNTED.read_text(), verdicts))


if __name__ == "__main__":
    main(sys.argv[1])
