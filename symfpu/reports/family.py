"""Refined tori and families as records for JSON and as lines of text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from symfpu.families.continuation import Event, Member
from symfpu.families.family import Family
from symfpu.numbers.typed import decimal
from symfpu.refinement.tori import RefinedTorus
from symfpu.reports.tables import fifteen_digits

SHOWN_EVENTS = 12
SHOWN_MEMBERS = 8  # besides the first; the last one is among them


def refined_record(torus: RefinedTorus) -> dict[str, Any]:
    """A refined torus for JSON: keys of the command line, numbers to 15 digits, frequencies exact
    as strings.
    """
    return {
        "N": torus.chain.N,
        "alpha": decimal(torus.chain.alpha),
        "beta": decimal(torus.chain.beta),
        "seeds": list(torus.seeds),
        "frequencies": {
            str(q): decimal(w) for q, w in zip(torus.seeds, torus.frequencies, strict=True)
        },
        "amplitudes": {str(q): fifteen_digits(a) for q, a in torus.amplitudes.items()},
        "energy": fifteen_digits(float(torus.energy())),
        "harmonic_energy": fifteen_digits(float(torus.harmonic_energies().sum())),
        "average_harmonic_energy": fifteen_digits(float(torus.average_spectrum().sum())),
        "residual": fifteen_digits(torus.residual()),
        "energy_error": fifteen_digits(energy_spread(torus)),
        "harmonics": len(torus.harmonics),
        "newton": [
            {
                "residual": fifteen_digits(s.residual),
                "change": fifteen_digits(s.change),
                "products": s.krylov,
            }
            for s in torus.steps
        ],
        "smallest_divisors": [
            {
                "size": fifteen_digits(r.divisor),
                "mode": r.mode,
                "harmonic": list(r.harmonic),
                "coefficient": fifteen_digits(r.coefficient),
            }
            for r in torus.near_resonances
        ],
        "verdict": "doubtful" if torus.warnings else "torus",
        "warnings": list(torus.warnings),
    }


def energy_spread(torus: RefinedTorus, periods: int = 25, points: int = 100) -> float:
    """Largest relative change of H along the orbit over some periods of the slowest seed."""
    period = 2 * np.pi / min(float(w) for w in torus.frequencies)
    return float(np.abs(torus.energy_error(np.linspace(0, periods * period, points))).max())


def refined_text(torus: RefinedTorus) -> str:
    """The same for a reader."""
    record = refined_record(torus)
    lines = [
        f"verdict: {record['verdict']}",
        *(
            f"seed {q:<4} omega {w:<28} amplitude {record['amplitudes'][q]:.15g}"
            for q, w in record["frequencies"].items()
        ),
        f"energy H           {record['energy']:.15g}   (at t = 0)",
        f"harmonic energy    {record['harmonic_energy']:.15g}   (at t = 0; time average {record['average_harmonic_energy']:.12g})",
        f"residual           {record['residual']:.2g}   (equations of motion, relative to the largest acceleration)",
        f"energy constancy   {record['energy_error']:.2g}   (relative, over 25 periods of the slowest seed)",
        f"harmonics          {record['harmonics']}, Newton steps {len(torus.steps)}, the last change {torus.steps[-1].change:.1g}",
        "smallest divisors:",
        *(f"  {r}" for r in torus.near_resonances[:5]),
        *(f"warning: {warning}" for warning in torus.warnings),
    ]
    return "\n".join(lines)


def family_record(found: Family) -> dict[str, Any]:
    """A family for JSON."""
    return {
        "N": found.chain.N,
        "alpha": decimal(found.chain.alpha),
        "beta": decimal(found.chain.beta),
        "seeds": list(found.seeds),
        "ending": found.ending,
        "members": [_member_record(m) for m in found.members],
        "events": [
            {
                "kind": e.kind,
                "what": e.what,
                "after": e.after,
                "energy": fifteen_digits(e.energy),
                "value": fifteen_digits(e.value),
                "mode": e.mode or None,
                "harmonic": list(e.harmonic) or None,
                "interpolated": e.interpolated,
            }
            for e in found.events
        ],
    }


def _member_record(m: Member) -> dict[str, Any]:
    known = (
        {}
        if m.multipliers is None
        else {
            "stable": m.multipliers.stable,
            "largest_multiplier": fifteen_digits(m.multipliers.largest),
        }
    )
    return {
        "energy": fifteen_digits(m.energy),
        "harmonic_energy": fifteen_digits(m.harmonic_energy),
        "frequencies": {
            str(q): decimal(w) for q, w in zip(m.torus.seeds, m.torus.frequencies, strict=True)
        },
        "amplitudes": {str(q): fifteen_digits(a) for q, a in m.amplitudes.items()},
        "residual": fifteen_digits(m.residual),
        "verdict": m.verdict,
        "warnings": list(m.warnings),
        **known,
    }


def family_table(found: Family) -> list[list[str]]:
    """Head and rows of a table of the members: energies, frequencies, amplitudes, residual,
    stability.
    """
    stability = any(m.multipliers is not None for m in found.members)
    omega, amplitudes = [f"omega_{q}" for q in found.seeds], [f"A_{q}" for q in found.seeds]
    head = [
        "H",
        "sum E_q",
        *omega,
        *amplitudes,
        "residual",
        "verdict",
        *(["largest multiplier"] if stability else []),
    ]
    rows = []
    for m in found.members:
        rates = [f"{float(w):.15g}" for w in m.torus.frequencies]
        row = [
            f"{m.energy:.15g}",
            f"{m.harmonic_energy:.15g}",
            *rates,
            *(f"{a:.15g}" for a in m.amplitudes.values()),
        ]
        largest = [] if m.multipliers is None else [f"{m.multipliers.largest:.15g}"]
        rows.append([*row, f"{m.residual:.2g}", m.verdict, *largest])
    return [head, *rows]


def family_text(found: Family) -> Iterator[str]:
    """A family for a reader, in lines."""
    yield repr(found)
    last = len(found.members) - 1
    for k in sorted({round(i * last / SHOWN_MEMBERS) for i in range(SHOWN_MEMBERS + 1)}):
        yield f"  {found.members[k]!r}"
    events = sorted(found.events, key=_weight, reverse=True)[:SHOWN_EVENTS]
    for event in sorted(events, key=lambda e: e.after):
        yield f"  {event!r}"
    if len(found.events) > SHOWN_EVENTS:
        yield f"  ... and {len(found.events) - SHOWN_EVENTS} weaker resonances"


def _weight(event: Event) -> float:
    return abs(event.value) if event.kind == "resonance" else float("inf")
