"""Borders of q-tori: as lines for a reader, and as records."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from symfpu.borders.atlas import Atlas, AtlasBorder
from symfpu.borders.laws import BorderLaw
from symfpu.results.text_tables import text_table

Json = dict[str, Any]

BORDER_HEAD = ("N", "packet", "order", "border", "H", "H/N", "what ends it")
LAW_HEAD = ("packet", "border", "H goes as", "N", "between neighbours")


def atlas_text(found: Atlas) -> Iterator[str]:
    """The table of borders, that of the laws where there are three lengths, and what failed."""
    borders = [_border_row(border) for border in found.borders]
    if borders:
        yield from text_table(BORDER_HEAD, borders)
    laws = [
        _law_row(packet, border, law) for (_, packet, border), law in found.laws.items()
    ]
    if laws:
        yield ""
        yield from text_table(LAW_HEAD, laws)
    for row in found.rows.failures:
        yield f"N = {row.case['chain'].get('N')}, packet {row.case['packet']}: {row.failure}"


def _border_row(border: AtlasBorder) -> list[str]:
    known = border.energy is not None
    H = float(border.energy or 0.0)
    return [
        str(border.N),
        border.packet,
        str(border.order),
        border.border,
        f"{H:.4g}" if known else "none",
        f"{H / border.N:.4g}" if known else "",
        _ended(border),
    ]


def _ended(border: AtlasBorder) -> str:
    """The reason in words; else the term of the series, or the rate of growth."""
    details = border.details
    words = [border.reason] if border.reason else []
    if details.get("mode") is not None:
        nu = ",".join(map(str, details["harmonic"]))
        words.append(f"mode {details['mode']}, harmonic {nu}")
    if details.get("growth") is not None:
        words.append(f"growth {details['growth']:.3g}")
    if "time" in details and details.get("between"):
        lowest, highest = (math.inf if H is None else H for H in details["between"])
        words.append(f"chaos by t = {details['time']:g}, {lowest:.3g} .. {highest:.3g}")
    return "; ".join(words)


def _law_row(packet: str, border: str, law: BorderLaw) -> list[str]:
    lengths = ",".join(map(str, law.lengths))
    between = ", ".join(f"{x:.2f}" for x in law.local)
    power = f"N^({law.exponent:.3f} +- {law.error:.2g})"
    return [packet, border, power, lengths, between]
