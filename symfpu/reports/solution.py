"""Any solution, a breather above all, for JSON and for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from symfpu.breathers.floquet import Floquet
from symfpu.frames.attributes import exact_text
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from symfpu.refinement.digits import PreciseTorus
from symfpu.reports.tables import fifteen_digits, number_text
from symfpu.tori.quasiperiodic import QuasiPeriodic

SHOWN_FREQUENCY = (
    40  # characters of an exact frequency in the terminal; all of them are in the JSON
)


def solution_record(
    solution: QuasiPeriodic,
    found: Floquet | None = None,
    warnings: tuple[str, ...] = (),
) -> dict[str, Any]:
    """A solution for JSON: keys of the command line, numbers of more than 15 digits as strings.

    found : its multipliers, if they were asked for. warnings : besides its own.
    """
    chain, digits = solution.chain, solution.digits
    stability = {} if found is None else multipliers_record(found)
    return {
        "kind": type(solution).__name__,
        **chain.typed,
        "seeds": list(solution.seeds),
        "frequencies": frequencies_record(solution),
        "digits": digits,
        "amplitudes": {
            str(q): number_text(a, digits) for q, a in solution.amplitudes.items()
        },
        **{name: number_text(value, digits) for name, value in _energies(solution)},
        "residual": fifteen_digits(solution.residual()),
        **_limits(solution),
        "harmonics": len(solution.harmonics),
        "warnings": [*solution.warnings, *warnings],
        **stability,
    }


def _limits(solution: QuasiPeriodic) -> dict[str, str]:
    """What a torus of many digits knows of itself."""
    if not isinstance(solution, PreciseTorus):
        return {}
    bound, error = number_text(solution.bound, 3), number_text(solution.error, 3)
    return {"residual_bound": bound, "coefficient_error": error}


def frequencies_record(solution: Any) -> dict[str, str] | None:
    """By seed, exact; of a series, too: None where none are chosen."""
    if solution.frequencies is None:
        return None
    return {str(q): exact_text(w) for q, w in solution.omega.items()}


def _energies(solution: QuasiPeriodic) -> Iterator[tuple[str, Any]]:
    """H and sum E_q at t = 0, and the time average of the latter, with all digits."""
    numbers = DOUBLES if solution.digits is None else MULTIPRECISION
    with numbers.context(solution.digits):
        yield "energy", solution.energy()
        yield "harmonic_energy", solution.harmonic_energies().sum()
        yield "average_harmonic_energy", solution.average_spectrum().sum()


def floquet_record(found: Floquet) -> dict[str, Any]:
    """Multipliers with the orbit they are of."""
    orbit = found.orbit
    return {
        **orbit.chain.typed,
        "seeds": list(orbit.seeds),
        "frequencies": frequencies_record(orbit),
        "verdict": found.verdict,
        **multipliers_record(found),
        "symplecticity": fifteen_digits(found.symplecticity),
        "map_error": fifteen_digits(found.map_error),
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
