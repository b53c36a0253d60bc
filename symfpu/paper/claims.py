"""What the paper says beside what we find: claims with their verdicts, by figure. Data only."""

from __future__ import annotations

from dataclasses import dataclass

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
            raise InputError("verdict", self.verdict, ", ".join(VERDICTS), "choose one of them")

    def record(self) -> dict[str, str]:
        """For JSON."""
        return {
            name: getattr(self, name) for name in ("section", "text", "printed", "ours", "verdict")
        }


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper computed anew. name : such as "fig2". remarks : how, in sentences."""

    name: str
    title: str
    panels: tuple[Panel, ...]
    claims: tuple[Claim, ...]
    remarks: tuple[str, ...] = ()

    def __repr__(self) -> str:
        counts = ", ".join(
            f"{n} {verdict}"
            for verdict in VERDICTS
            if (n := sum(c.verdict == verdict for c in self.claims))
        )
        return f"PaperFigure({self.name}, panels {', '.join(panel.name for panel in self.panels)}; claims: {counts or 'none'})"


def judged(holds: bool, partly: bool = False) -> str:
    """The verdict on a claim that can be decided."""
    return HOLDS if holds else PARTLY if partly else FAILS
