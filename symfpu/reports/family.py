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
from symfpu.reports.torus import chain_record

SHOWN_EVENTS = 12
SHOWN_MEMBERS = 8  # besides the first; the last one is among them
SHOWN_DIVISORS = 5


def refined_record(torus: RefinedTorus) -> dict[str, Any]:
    """A refined torus for JSON: keys of the command line, numbers to 15 digits.

    Frequencies are exact, as strings.
    """
    harmonic_energy = float(torus.harmonic_energies().sum())
    average = float(torus.average_spectrum().sum())
    record = chain_record(torus.chain, torus.seeds)
    record["frequencies"] = _frequencies(torus)
    record["amplitudes"] = {str(q): fifteen_digits(a) for q, a in torus.amplitudes.items()}
    record["energy"] = fifteen_digits(float(torus.energy()))
    record["harmonic_energy"] = fifteen_digits(harmonic_energy)
    record["average_harmonic_energy"] = fifteen_digits(average)
    record["residual"] = fifteen_digits(torus.residual())
    record["energy_error"] = fifteen_digits(energy_spread(torus))
    record["harmonics"] = len(torus.harmonics)
    record["newton"] = _newton_records(torus)
    record["smallest_divisors"] = _divisor_records(torus)
    record["verdict"] = "doubtful" if torus.warnings else "torus"
    record["warnings"] = list(torus.warnings)
    return record


def _frequencies(torus: Any) -> dict[str, str]:
    """By seed, exact."""
    by_seed = zip(torus.seeds, torus.frequencies, strict=True)
    return {str(q): decimal(w) for q, w in by_seed}


def _newton_records(torus: RefinedTorus) -> list[dict[str, Any]]:
    records = []
    for step in torus.steps:
        residual = fifteen_digits(step.residual)
        change = fifteen_digits(step.change)
        record = {"residual": residual, "change": change, "products": step.krylov}
        records.append(record)
    return records


def _divisor_records(torus: RefinedTorus) -> list[dict[str, Any]]:
    records: list[dict[str, Any]] = []
    for resonance in torus.near_resonances:
        record: dict[str, Any] = {"size": fifteen_digits(resonance.divisor)}
        record["mode"] = resonance.mode
        record["harmonic"] = list(resonance.harmonic)
        record["coefficient"] = fifteen_digits(resonance.coefficient)
        records.append(record)
    return records


def energy_spread(torus: RefinedTorus, periods: int = 25, points: int = 100) -> float:
    """Largest relative change of H along the orbit over some periods of the slowest seed."""
    slowest = min(float(w) for w in torus.frequencies)
    period = 2 * np.pi / slowest
    times = np.linspace(0, periods * period, points)
    errors = torus.energy_error(times)
    return float(np.abs(errors).max())


def refined_text(torus: RefinedTorus) -> str:
    """The same for a reader."""
    record = refined_record(torus)
    amplitudes = record["amplitudes"]
    average = f"time average {record['average_harmonic_energy']:.12g}"
    relative = "equations of motion, relative to the largest acceleration"
    newton = (
        f"Newton steps {len(torus.steps)}, the last change {torus.steps[-1].change:.1g}"
    )
    lines = [f"verdict: {record['verdict']}"]
    if "potential" in record:
        lines.append(f"potential          {record['potential']}")
    for q, w in record["frequencies"].items():
        lines.append(f"seed {q:<4} omega {w:<28} amplitude {amplitudes[q]:.15g}")
    lines.append(f"energy H           {record['energy']:.15g}   (at t = 0)")
    lines.append(
        f"harmonic energy    {record['harmonic_energy']:.15g}   (at t = 0; {average})"
    )
    lines.append(f"residual           {record['residual']:.2g}   ({relative})")
    over = "relative, over 25 periods of the slowest seed"
    lines.append(f"energy constancy   {record['energy_error']:.2g}   ({over})")
    lines.append(f"harmonics          {record['harmonics']}, {newton}")
    lines.append("smallest divisors:")
    lines += [f"  {resonance}" for resonance in torus.near_resonances[:SHOWN_DIVISORS]]
    lines += [f"warning: {warning}" for warning in torus.warnings]
    return "\n".join(lines)


def family_record(found: Family) -> dict[str, Any]:
    """A family for JSON."""
    record = chain_record(found.chain, found.seeds)
    record["ending"] = found.ending
    record["members"] = [_member_record(m) for m in found.members]
    record["events"] = [_event_record(e) for e in found.events]
    return record


def _event_record(event: Event) -> dict[str, Any]:
    record: dict[str, Any] = {"kind": event.kind, "what": event.what}
    record["after"] = event.after
    record["energy"] = fifteen_digits(event.energy)
    record["value"] = fifteen_digits(event.value)
    record["mode"] = event.mode or None
    record["harmonic"] = list(event.harmonic) or None
    record["interpolated"] = event.interpolated
    return record


def _member_record(m: Member) -> dict[str, Any]:
    record: dict[str, Any] = {"energy": fifteen_digits(m.energy)}
    record["harmonic_energy"] = fifteen_digits(m.harmonic_energy)
    record["frequencies"] = _frequencies(m.torus)
    record["amplitudes"] = {str(q): fifteen_digits(a) for q, a in m.amplitudes.items()}
    record["residual"] = fifteen_digits(m.residual)
    record["verdict"] = m.verdict
    record["warnings"] = list(m.warnings)
    if m.multipliers is not None:
        record["stable"] = m.multipliers.stable
        record["largest_multiplier"] = fifteen_digits(m.multipliers.largest)
    return record


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
    table = [head]
    for m in found.members:
        row = [f"{m.energy:.15g}", f"{m.harmonic_energy:.15g}"]
        row += [f"{float(w):.15g}" for w in m.torus.frequencies]
        row += [f"{a:.15g}" for a in m.amplitudes.values()]
        row += [f"{m.residual:.2g}", m.verdict]
        if m.multipliers is not None:
            row.append(f"{m.multipliers.largest:.15g}")
        table.append(row)
    return table


def family_text(found: Family) -> Iterator[str]:
    """A family for a reader, in lines."""
    yield repr(found)
    last = len(found.members) - 1
    places = {round(i * last / SHOWN_MEMBERS) for i in range(SHOWN_MEMBERS + 1)}
    for k in sorted(places):
        yield f"  {found.members[k]!r}"
    events = sorted(found.events, key=_weight, reverse=True)[:SHOWN_EVENTS]
    for event in sorted(events, key=lambda e: e.after):
        yield f"  {event!r}"
    weaker = len(found.events) - SHOWN_EVENTS
    if weaker > 0:
        yield f"  ... and {weaker} weaker resonances"


def _weight(event: Event) -> float:
    return abs(event.value) if event.kind == "resonance" else float("inf")
