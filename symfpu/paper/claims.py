"""What the paper says beside what we find: claims with their verdicts, by figure. Data only."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from symfpu.errors import InputError
from symfpu.figures.panels import Panel

HOLDS, PARTLY, FAILS, OPEN = "holds", "holds in part", "does not hold", "undecided"
VERDICTS = (HOLDS, PARTLY, FAILS, OPEN)


@dataclass(frozen=True)
class Claim:
    """A statement or number of the paper and what became of it.

    section : where the paper says it. text : what it says. printed : its number, if there is one.
    ours : what we find, with numbers.
    verdict : one of VERDICTS.
    """

    section: str
    text: str
    printed: str
    ours: str
    verdict: str

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise InputError(
                "verdict", self.verdict, ", ".join(VERDICTS), "choose one of them"
            )

    def record(self) -> dict[str, str]:
        """For JSON."""
        names = ("section", "text", "printed", "ours", "verdict")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class PaperFigure:
    """A figure, a table or a question of the paper computed anew.

    name : such as "fig2". remarks : how, in sentences. text : more for the page, paragraphs and
    tables in Markdown. numbers : for the record, by name or one entry for each row. lines : for
    the terminal, beside the claims.
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    claims: tuple[Claim, ...]
    remarks: tuple[str, ...] = ()
    text: tuple[str, ...] = field(default=(), repr=False)
    numbers: Any = field(default=None, repr=False)
    lines: tuple[str, ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        found = [claim.verdict for claim in self.claims]
        counts = [
            f"{found.count(verdict)} {verdict}" for verdict in VERDICTS if verdict in found
        ]
        claims = ", ".join(counts) or "none"
        panels = ", ".join(panel.name for panel in self.panels)
        return f"PaperFigure({self.name}, panels {panels}; claims: {claims})"


def judged(holds: bool, partly: bool = False) -> str:
    """The verdict on a claim that can be decided."""
    if holds:
        return HOLDS
    return PARTLY if partly else FAILS
