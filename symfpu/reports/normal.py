"""Normal frequencies of a torus, for JSON and for the terminal."""

from __future__ import annotations

from typing import Any

from symfpu.families.normal_family import NormalEvent
from symfpu.normal.modes import NormalMode, NormalModes
from symfpu.normal.resonances import ParametricResonance
from symfpu.reports.solution import frequencies_record
from symfpu.reports.tables import fifteen_digits, number_text

SHOWN_RESONANCES = 10


def normal_record(found: NormalModes) -> dict[str, Any]:
    """Keys of the command line; real frequencies as strings, complex ones as [re, im]."""
    torus = found.torus
    return {
        "kind": type(found).__name__,
        **torus.chain.typed,
        "seeds": list(torus.seeds),
        "frequencies": frequencies_record(torus),
        "verdict": found.verdict,
        "stable": found.stable,
        "undecided": list(found.undecided),
        "growth": fifteen_digits(float(found.growth)),
        "normal_frequencies": {str(mode.mode): _sigma(mode) for mode in found.modes},
        "signatures": {str(mode.mode): mode.signature for mode in found.modes},
        "resonances": [_resonance(one) for one in found.resonances[:SHOWN_RESONANCES]],
        "residual": fifteen_digits(float(found.residual)),
        "digits": found.digits,
        **_error(found),
    }


def _error(found: NormalModes) -> dict[str, str]:
    """What is known of frequencies with digits."""
    if found.digits is None:
        return {}
    return {"frequency_error": number_text(found.error, 3)}


def normal_event_record(event: NormalEvent) -> dict[str, Any]:
    """An event of a family of normal frequencies for JSON: what it is, and where."""
    return {
        "event": event.kind,
        "resonance": _resonance(event.resonance),
        "after": event.after,
        "part": fifteen_digits(event.part),
        "amplitudes": {str(q): repr(float(a)) for q, a in event.amplitudes.items()},
        "begins": event.begins,
        "error": fifteen_digits(event.error),
    }


def _sigma(mode: NormalMode) -> str | list[str]:
    real = number_text(mode.sigma.real, mode.digits)
    if not mode.growth:
        return real
    return [real, number_text(mode.sigma.imag, mode.digits)]


def _resonance(one: ParametricResonance) -> dict[str, Any]:
    return {
        "resonance": one.kind,
        "modes": list(one.modes),
        "harmonic": list(one.harmonic),
        "distance": fifteen_digits(one.distance),
    }


def normal_text(found: NormalModes) -> str:
    """Verdict, a line a mode, and the nearest resonances."""
    chain = repr(found.torus.chain).removeprefix("Chain(").removesuffix(")")
    seeds = ",".join(map(str, found.torus.seeds))
    lines = [f"{chain}, seeds {seeds}: {found.verdict}"]
    linear = found.torus.chain.frequencies()
    lines.append("  mode  normal frequency                   shift        kind, residual")
    for mode in found.modes:
        shift = complex(mode.sigma).real - linear[mode.mode - 1]
        kind = f"{mode.kind}, {mode.residual:.0e}"
        lines.append(f"  {mode.mode:4d}  {mode.text:33}  {shift:+.4e}  {kind}")
    if found.resonances:
        lines.append("nearest resonances:")
    lines += [f"  {one!r}" for one in found.resonances[:SHOWN_RESONANCES]]
    return "\n".join(lines)
