"""Any solution, a breather above all, for JSON and for the terminal."""

from __future__ import annotations

from typing import Any

from symfpu.breathers.floquet import Floquet
from symfpu.numbers.typed import decimal
from symfpu.reports.tables import fifteen_digits, number_text
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.ring_torus import RingTorus

SHOWN_FREQUENCY = (
    40  # characters of an exact frequency in the terminal; all of them are in the JSON
)


def solution_record(
    solution: QuasiPeriodic | RingTorus,
    found: Floquet | None = None,
    warnings: tuple[str, ...] = (),
) -> dict[str, Any]:
    """A solution for JSON: keys of the command line, numbers of more than 15 digits as strings.

    found : its multipliers, if they were asked for. warnings : besides its own.
    """
    chain, digits = solution.chain, solution.digits
    frequencies = zip(solution.seeds, solution.frequencies, strict=True)
    energies = {
        "energy": solution.energy(),
        "harmonic_energy": solution.harmonic_energies().sum(),
        "average_harmonic_energy": solution.average_spectrum().sum(),
    }
    stability = {} if found is None else multipliers_record(found)
    return {
        "kind": type(solution).__name__,
        **chain.typed,
        "seeds": list(solution.seeds),
        "frequencies": {str(q): decimal(omega) for q, omega in frequencies},
        "digits": digits,
        "amplitudes": {
            str(q): number_text(a, digits) for q, a in solution.amplitudes.items()
        },
        **{name: number_text(value, digits) for name, value in energies.items()},
        "residual": fifteen_digits(solution.residual()),
        "harmonics": len(solution.harmonics),
        "warnings": [*solution.warnings, *warnings],
        **stability,
    }


def multipliers_record(found: Floquet) -> dict[str, Any]:
    """Floquet multipliers for JSON, each as its real and imaginary part."""
    parts = [[repr(float(x.real)), repr(float(x.imag))] for x in found.multipliers]
    return {
        "multipliers": parts,
        "stable": found.stable,
        "instabilities": found.instabilities,
        "largest_multiplier": fifteen_digits(found.largest),
    }


def solution_text(record: dict[str, Any]) -> str:
    """The same for a reader, from the record."""
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
        f"harmonics          {record['harmonics']}, in {digits}",
        *_stability_lines(record),
        *(f"warning: {warning}" for warning in record["warnings"]),
    ]
    return "\n".join(lines)


def _stability_lines(record: dict[str, Any]) -> list[str]:
    if "stable" not in record:
        return []
    kinds = ", ".join(f"{count} {kind}" for kind, count in record["instabilities"].items())
    verdict = "stable" if record["stable"] else f"unstable: {kinds}"
    largest = f"the largest |multiplier| {record['largest_multiplier']:.12g}"
    return [f"multipliers        {verdict}, {largest}"]
