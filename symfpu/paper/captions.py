"""The lines printed in captions of Figs. 2(a), 4(a), 4(b), and how the laws are read."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.chain import Chain
from symfpu.figures.panels import Curve
from symfpu.localization.laws import ProfileLine, profile_law
from symfpu.paper.claims import Claim, judged
from symfpu.paper.printed import LINES, PrintedLine
from symfpu.paper.table import rounds_to

Floats = NDArray[np.float64]


def printed_line(label: str) -> PrintedLine:
    """The line of a caption."""
    return next(line for line in LINES if line.label == label)


def caption_curve(line: PrintedLine, kappa: Floats) -> Curve:
    """The line as printed."""
    printed = _printed_law(line)
    return Curve("line of the caption", kappa, 10 ** printed(kappa), "law")


def law_of(
    line: PrintedLine,
    chain: Chain,
    *,
    denominator: int | None = None,
    specific_energy: float | None = None,
) -> ProfileLine:
    """Eqs. eksa2, eksp2 for the parameters of a caption."""
    energy = specific_energy or line.specific_energy
    return profile_law(chain, line.seeds(chain), energy, denominator=denominator)


def same_numbers(line: PrintedLine, law: ProfileLine) -> bool:
    """Whether slope and intercept round to the printed ones."""
    return rounds_to(law.slope, line.slope) and rounds_to(law.intercept, line.intercept)


def caption_claim(
    line: PrintedLine, section: str, readings: dict[str, ProfileLine]
) -> Claim:
    """Whether the laws give the printed line.

    With the caption's parameters for every chain, or only with some other reading.
    """
    as_printed = []
    sizes = []
    for chain in line.chains:
        own = law_of(line, chain)
        as_printed.append(same_numbers(line, own) and own.power == line.power)
        sizes.append(f"N = {chain.N}: {_text(own)}")
    meant = next((name for name, law in readings.items() if same_numbers(line, law)), None)
    ours = f"the law with the caption's parameters: {', '.join(sizes)}; "
    if meant:
        ours += f"every printed digit of slope and intercept comes out with {meant}"
    else:
        ours += "no reading gives the printed digits"
    text = f"{line.label}: the line of the caption is the law"
    verdict = judged(all(as_printed), meant is not None)
    return Claim(section, text, _text(_printed_law(line)), ours, verdict)


def _printed_law(line: PrintedLine) -> ProfileLine:
    slope, intercept = float(line.slope), float(line.intercept)
    return ProfileLine(slope, intercept, float(line.power))


def _text(law: ProfileLine) -> str:
    power = f"{law.power:+g} log kappa" if law.power else ""
    return f"{law.intercept:+.6g} {law.slope:+.6g} kappa {power}".strip()
