"""Any solution, a breather above all, for JSON and for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from symfpu.breathers.floquet import Floquet
from symfpu.numbers.arithmetic import DOUBLES, MULTIPRECISION
from symfpu.refinement.digits import IterativeRefinement
from symfpu.refinement.refined_torus import Newton
from symfpu.reports.series import divisor_records, frequencies_record
from symfpu.reports.tables import fifteen_digits, number_text
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from
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
    """A solution for JSON: keys of the command line, numbers of more than 15 digits as strings.

    assessment : the verdict on its series, if there is one. found : its multipliers, if they were
    asked for. warnings : besides its own.
    """
    chain, digits = solution.chain, solution.digits
    record = {
        "kind": type(solution).__name__,
        "origin": type(solution.origin).__name__,
        **chain.typed,
        "seeds": list(solution.seeds),
        "frequencies": frequencies_record(solution),
        "digits": digits,
        "amplitudes": {
            str(q): number_text(a, digits) for q, a in solution.amplitudes.items()
        },
        **{name: number_text(value, digits) for name, value in _energies(solution)},
        "residual": fifteen_digits(solution.residual()),
        "harmonics": len(solution.harmonics),
        "warnings": [*solution.warnings, *warnings],
        **_known_by_origin(solution),
    }
    if assessment is not None:
        record |= {"verdict": assessment.verdict, "assessment": assessment.record()}
    return record if found is None else record | multipliers_record(found)


def _known_by_origin(torus: Torus) -> dict[str, Any]:
    """What only the way of making it knows."""
    if comes_from(torus, FromSeries):
        return _of_series(torus)
    if comes_from(torus, Newton):
        return _of_newton(torus)
    if comes_from(torus, IterativeRefinement):
        bound, error = torus.origin.bound, torus.origin.error
        return {
            "residual_bound": number_text(bound, 3),
            "coefficient_error": number_text(error, 3),
        }
    return {}


def _of_series(torus: Torus[FromSeries]) -> dict[str, Any]:
    """Orders, the amplitudes of all seeds by frequency order, and divisors."""
    origin, digits = torus.origin, torus.digits
    certificate, history = origin.certificate, {}
    for k, values in origin.history.items():
        history[str(k)] = [number_text(a, digits) for a in values]
    return {
        "order": origin.order,
        "frequency_order": origin.frequency_order,
        "guard_digits": None if digits is None else origin.series.guard_digits,
        "certified": None if certificate is None else certificate.certified,
        "history": history,
        "root_residual": fifteen_digits(origin.root_residual),
        "smallest_divisors": divisor_records(origin.series),
    }


def _of_newton(torus: Torus[Newton]) -> dict[str, Any]:
    """Steps and small divisors, and how well H stays along the orbit."""
    steps = []
    for step in torus.origin.steps:
        residual, change = fifteen_digits(step.residual), fifteen_digits(step.change)
        steps.append({"residual": residual, "change": change, "products": step.krylov})
    divisors: list[dict[str, Any]] = []
    for resonance in torus.origin.near_resonances:
        record: dict[str, Any] = {"size": fifteen_digits(resonance.divisor)}
        record["mode"] = resonance.mode
        record["harmonic"] = list(resonance.harmonic)
        record["coefficient"] = fifteen_digits(resonance.coefficient)
        divisors.append(record)
    return {
        "energy_error": fifteen_digits(energy_spread(torus)),
        "newton": steps,
        "smallest_divisors": divisors,
        "verdict": "doubtful" if torus.warnings else "torus",
    }


def energy_spread(torus: Torus, periods: int = 25, points: int = 100) -> float:
    """Largest relative change of H along the orbit over some periods of the slowest seed."""
    slowest = min(float(w) for w in torus.frequencies)
    period = 2 * np.pi / slowest
    times = np.linspace(0, periods * period, points)
    energies, start = torus.energy(times), torus.energy()
    return float(np.abs((energies - start) / start).max())


def _energies(solution: Torus) -> Iterator[tuple[str, Any]]:
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
