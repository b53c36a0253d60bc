"""Any solution, a breather above all, for JSON and for the terminal."""

from __future__ import annotations

from typing import Any

from symfpu.breathers.floquet import Floquet
from symfpu.refinement.newton import Newton
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment

SHOWN_DIVISORS = 5
SHOWN_FREQUENCY = (
    40  # characters of an exact frequency in the terminal; all of them are in the JSON
)


def solution_record(
    solution: Torus,
    *,
    assessment: Assessment | None = None,
    found: Floquet | None = None,
    warnings: tuple[str, ...] = (),
) -> dict[str, Any]:
    """A solution for JSON, with what else was found of it.

    assessment : the verdict on its series, if there is one. found : its multipliers, if they were
    asked for. warnings : besides its own.
    """
    record = solution.record()
    record["warnings"] = [*solution.warnings, *warnings]
    if assessment is not None:
        record |= {"verdict": assessment.verdict, "assessment": assessment.record()}
    if found is not None:
        record |= {field.key: field.value for field in found.multiplier_fields()}
    return record


def refined_text(torus: Torus[Newton]) -> str:
    """A torus of Newton's method for a reader."""
    record = solution_record(torus)
    amplitudes = {q: float(a) for q, a in record["amplitudes"].items()}
    average = f"time average {float(record['average_harmonic_energy']):.12g}"
    relative = "equations of motion, relative to the largest acceleration"
    steps = torus.origin.steps
    newton = f"Newton steps {len(steps)}, the last change {steps[-1].change:.1g}"
    lines = [f"verdict: {record['verdict']}"]
    if "potential" in record:
        lines.append(f"potential          {record['potential']}")
    if "ends" in record:
        lines.append(f"ends               {record['ends']}")
    for q, w in record["frequencies"].items():
        lines.append(f"seed {q:<4} omega {w:<28} amplitude {amplitudes[q]:.15g}")
    lines.append(f"energy H           {float(record['energy']):.15g}   (at t = 0)")
    lines.append(
        f"harmonic energy    {float(record['harmonic_energy']):.15g}   (at t = 0; {average})"
    )
    lines.append(f"residual           {record['residual']:.2g}   ({relative})")
    over = "relative, over 25 periods of the slowest seed"
    lines.append(f"energy constancy   {record['energy_error']:.2g}   ({over})")
    lines.append(f"harmonics          {record['harmonics']}, {newton}")
    lines.append("smallest divisors:")
    lines += [
        f"  {resonance}" for resonance in torus.origin.near_resonances[:SHOWN_DIVISORS]
    ]
    lines += [f"warning: {warning}" for warning in torus.warnings]
    return "\n".join(lines)


def solution_text(record: dict[str, Any]) -> str:
    """Any other solution for a reader, from its record."""
    average = record["average_harmonic_energy"]
    digits = "doubles" if record["digits"] is None else f"{record['digits']} digits"
    names = [name for name in ("alpha", "beta", "potential", "ends") if name in record]
    law = ", ".join(f"{name}={record[name]}" for name in names)
    lines = [f"{record['kind']}, N={record['N']}, {law}"]
    for q, amplitude in record["amplitudes"].items():
        omega = record["frequencies"][q]
        shown = omega if len(omega) <= SHOWN_FREQUENCY else f"{omega[:SHOWN_FREQUENCY]}.."
        lines.append(f"seed {q:<4} omega {shown:<20} amplitude {amplitude}")
    lines += [
        f"energy H           {record['energy']}   (at t = 0)",
        f"harmonic energy    {record['harmonic_energy']}   (at t = 0; time average {average})",
        f"residual           {record['residual']:.2g}   (equations of motion, relative)",
        *_limit_lines(record),
        f"harmonics          {record['harmonics']}, in {digits}",
        *_stability_lines(record),
        *(f"warning: {warning}" for warning in record["warnings"]),
    ]
    return "\n".join(lines)


def _limit_lines(record: dict[str, Any]) -> list[str]:
    if "residual_bound" not in record:
        return []
    return [
        f"residual below     {record['residual_bound']}   (at all angles, relative)",
        f"coefficient error  {record['coefficient_error']}   (an estimate, relative)",
    ]


def _stability_lines(record: dict[str, Any]) -> list[str]:
    if "stable" not in record:
        return []
    kinds = ", ".join(f"{count} {kind}" for kind, count in record["instabilities"].items())
    verdict = "stable" if record["stable"] else f"unstable: {kinds}"
    largest = f"the largest |multiplier| {record['largest_multiplier']:.12g}"
    return [f"multipliers        {verdict}, {largest}"]
