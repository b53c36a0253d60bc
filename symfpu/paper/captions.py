"""The lines printed in the captions of Figs.

2(a), 4(a), 4(b), and which reading of the laws gives them.
"""

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
    printed = ProfileLine(float(line.slope), float(line.intercept), float(line.power))
    return Curve("line of the caption", kappa, 10 ** printed(kappa), "law")


def law_of(
    line: PrintedLine,
    chain: Chain,
    *,
    denominator: int | None = None,
    specific_energy: float | None = None,
) -> ProfileLine:
    """Eqs. eksa2, eksp2 for the parameters of a caption."""
    return profile_law(
        chain, line.seeds(chain), specific_energy or line.specific_energy, denominator=denominator
    )


def same_numbers(line: PrintedLine, law: ProfileLine) -> bool:
    """Whether slope and intercept round to the printed ones."""
    return rounds_to(law.slope, line.slope) and rounds_to(law.intercept, line.intercept)


def caption_claim(line: PrintedLine, section: str, readings: dict[str, ProfileLine]) -> Claim:
    """Whether the laws give the printed line: with the caption's parameters for every chain, or
    only with some other reading.
    """
    own = [law_of(line, chain) for chain in line.chains]
    given = [same_numbers(line, law) and law.power == line.power for law in own]
    meant = next((name for name, law in readings.items() if same_numbers(line, law)), None)
    sizes = ", ".join(
        f"N = {chain.N}: {_text(law)}" for chain, law in zip(line.chains, own, strict=True)
    )
    ours = f"the law with the caption's parameters: {sizes}; "
    ours += (
        f"every printed digit of slope and intercept comes out with {meant}"
        if meant
        else "no reading gives the printed digits"
    )
    law = ProfileLine(float(line.slope), float(line.intercept), float(line.power))
    text = f"{line.label}: the line of the caption is the law"
    return Claim(section, text, _text(law), ours, judged(all(given), meant is not None))


def _text(law: ProfileLine) -> str:
    power = f"{law.power:+g} log kappa" if law.power else ""
    return f"{law.intercept:+.6g} {law.slope:+.6g} kappa {power}".strip()
