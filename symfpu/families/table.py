"""The members of a family as a table of text."""

from __future__ import annotations

import math

from symfpu.families.family import Family


def family_table(found: Family) -> list[list[str]]:
    """Head and rows of a table of the members.

    Energies, frequencies, amplitudes, residual, stability.
    """
    head = ["H", "sum E_q"]
    head += [f"omega_{q}" for q in found.seeds]
    head += [f"A_{q}" for q in found.seeds]
    head += ["residual", "verdict"]
    if any(m.multipliers is not None for m in found.members):
        head.append("largest multiplier")
    normal = [q for q in found.chain.mode_numbers if q not in found.seeds]
    if any(m.normal for m in found.members):
        head += [f"{name}_{q}" for q in normal for name in ("sigma", "growth")]
    table = [head]
    for m in found.members:
        row = [f"{m.energy:.15g}", f"{m.harmonic_energy:.15g}"]
        row += [f"{float(w):.15g}" for w in m.torus.frequencies]
        row += [f"{a:.15g}" for a in m.amplitudes.values()]
        row += [f"{m.residual:.2g}", m.verdict]
        if m.multipliers is not None:
            row.append(f"{m.multipliers.largest:.15g}")
        if m.normal is not None:
            known = (complex(m.normal.frequencies.get(q, math.nan)) for q in normal)
            row += [f"{x:.15g}" for w in known for x in (w.real, abs(w.imag))]
        table.append(row)
    return table
