"""Verdicts on the numbers of Appendix F and of the captions, from the rows of the table."""

from __future__ import annotations

from collections.abc import Sequence

from symfpu.paper.claims import Claim, judged
from symfpu.paper.table import AmplitudeRow


def table_claims(rows: Sequence[AmplitudeRow]) -> tuple[Claim, Claim]:
    """Of the printed amplitudes, and of the printed energies."""
    return amplitudes_claim(rows), energies_claim(rows)


def amplitudes_claim(rows: Sequence[AmplitudeRow]) -> Claim:
    """Do the printed amplitudes belong to the printed frequencies, at any order?"""
    met = {row.printed.label: row.best for row in rows if row.met}
    missed = [row for row in rows if not row.met]
    text = (
        "the amplitudes of Appendix F and of Fig. 1 solve Eqs. omeser for its frequencies"
    )
    orders = ", ".join(f"{label}: {k}" for label, k in met.items())
    ours = f"met by {len(met)} of {len(rows)} rows, at frequency orders {orders or 'none'}"
    for row in missed:
        ours += f"; not by {row.printed.label} ({row.digits[row.best]:.1f} digits at best)"
    return Claim("Appendix F", text, "", ours, judged(not missed, bool(met)))


def energies_claim(rows: Sequence[AmplitudeRow]) -> Claim:
    """Is the printed E the energy of the printed torus?"""
    total = [row for row in rows if "H(0)" in row.energy_matches]
    other = [row for row in rows if row.energy_matches and row not in total]
    cut = [row for row in rows if not row.energy_matches and row.energy_orders]
    none = [row for row in rows if not row.energy_matches and not row.energy_orders]
    text = "the printed E of Appendix F's tori and of Fig. 1 are their total energies"
    ours = f"E is H at t = 0 in {_labels(total)}"
    for name, found in (
        ("another energy of the printed order", other),
        ("an energy of another coordinate order", cut),
        ("none of ours", none),
    ):
        ours += f"; {name} in {_labels(found)}" if found else ""
    every = len(total) == len(rows)
    return Claim("Appendix F", text, "", ours, judged(every, bool(total)))


def _labels(rows: Sequence[AmplitudeRow]) -> str:
    return ", ".join(row.printed.label for row in rows) or "none"
