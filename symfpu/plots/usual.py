"""The picture that one expects of a result, and its answer as HTML.

One entry for each kind of result: what `plot` and `_repr_html_` of `symfpu.notebook.Shown` look up.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator
from functools import partial
from html import escape
from typing import Any, NamedTuple

from symfpu.action_angle.foretold import ForetoldIndices, settled_text
from symfpu.borders.atlas import Atlas
from symfpu.breathers.floquet import Floquet
from symfpu.dynamics.alignment import AlignmentIndices
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError
from symfpu.families.family import Family
from symfpu.families.normal_family import NormalFamily
from symfpu.frames.attributes import exact_text
from symfpu.integrable.invariants import TodaInvariants
from symfpu.normal.modes import NormalModes
from symfpu.numbers.arithmetic import text
from symfpu.numbers.counted import counted
from symfpu.numbers.typed import decimal
from symfpu.plots.atlas import atlas_borders
from symfpu.plots.families import family_frequencies
from symfpu.plots.frequency_map import frequency_map
from symfpu.plots.indices import alignment, foretold
from symfpu.plots.lines import lines
from symfpu.plots.motion import time_series
from symfpu.plots.normal import normal_frequencies
from symfpu.plots.normal_family import family_normal_frequencies
from symfpu.plots.rule import propagation
from symfpu.plots.series import amplitudes, residuals, small_divisors
from symfpu.plots.spectra import spectrum
from symfpu.plots.stability import multipliers
from symfpu.plots.style import Axes, picture_bytes
from symfpu.plots.toda import toda_gaps
from symfpu.proofs.certificates import PropagationProof
from symfpu.series.series import LindstedtSeries
from symfpu.spectral.analysis import FrequencyAnalysis
from symfpu.spectral.mapping import FrequencyMap
from symfpu.tori.amplitudes import AmplitudeHistory
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment

SIZE, DPI = (4.2, 2.9), 75  # of the picture beside an answer
PLACES = 12  # digits of numbers in doubles
MOST_MODES = 8  # normal frequencies that are shown
LONGEST = 44  # characters of a number; longer ones are cut
Rows = Iterator[tuple[str, str]]
PAGE = """<div class="symfpu-answer" style="display: flex; flex-wrap: wrap; gap: 1.5em">
<div><div style="margin-bottom: 0.4em"><b>{head}</b></div>
<table>{rows}</table></div>
{picture}</div>"""
ROW = '<tr><td style="text-align: left">{}</td><td style="text-align: left">{}</td></tr>'


class Usual(NamedTuple):
    """What is shown of a kind of result: the verdict in a line, numbers, and a picture."""

    kind: type
    picture: Callable[..., Axes]
    verdict: Callable[[Any], str]
    rows: Callable[[Any], Rows]
    has_picture: Callable[[Any], bool] = lambda result: True


def picture(result: Any, ax: Axes | None = None) -> Axes:
    """The picture that one expects of a result; returns the axes. Raises InputError."""
    return _usual(result).picture(result, ax)


def html(result: Any) -> str:
    """The answer of a result as HTML: verdict, numbers, and a small picture within the text."""
    usual = _usual(result)
    head = f"{type(result).__name__}: {usual.verdict(result)}"
    rows = [ROW.format(escape(name), escape(value)) for name, value in usual.rows(result)]
    shown = _inline(result, usual) if usual.has_picture(result) else ""
    return PAGE.format(head=escape(head), rows="".join(rows), picture=shown)


def _inline(result: Any, usual: Usual) -> str:
    draw = partial(usual.picture, result)
    content = picture_bytes(draw, ".png", size=SIZE, dpi=DPI)
    data = base64.b64encode(content).decode()
    name = usual.picture.__name__.lstrip("_")
    words = f"{name} of this {type(result).__name__}".replace("_", " ")
    return f'<img alt="{words}" src="data:image/png;base64,{data}">'


def _usual(result: Any) -> Usual:
    for usual in USUAL:
        if isinstance(result, usual.kind):
            return usual
    allowed = "a result with a usual picture"
    raise InputError("result", type(result).__name__, allowed, "see symfpu.plots")


def _number(value: Any, digits: int | None = None) -> str:
    written = text(value, digits or PLACES)
    return written if len(written) <= LONGEST else f"{written[:LONGEST]}..."


def _frequency(omega: Any) -> str:
    """As it is typed; a long fraction as a double."""
    typed = exact_text(omega)
    return typed if len(typed) <= LONGEST else f"{float(omega):.15g}"


def _listed(values: Any) -> str:
    return ", ".join(map(str, values))


def _torus_verdict(result: Any) -> str:
    return "; ".join(result.warnings) or f"residual {result.residual():.2g}"


def _torus_rows(result: Any) -> Rows:
    digits = getattr(result, "digits", None)
    yield "chain", result.chain.label
    for q, omega in zip(result.seeds, result.frequencies, strict=True):
        size = _number(result.amplitudes[q], digits)
        yield f"seed {q}", f"\N{GREEK SMALL LETTER OMEGA} = {_frequency(omega)}, A = {size}"
    yield "energy H", _number(result.energy(), digits)
    yield "harmonics", f"{len(result.harmonics)}"


def _series_verdict(series: LindstedtSeries) -> str:
    return f"order {series.order}, {counted(series.coefficient_count, 'coefficient')}"


def _series_rows(series: LindstedtSeries) -> Rows:
    yield "chain", series.chain.label
    yield "seeds", _listed(series.seeds)
    if series.frequencies is not None:
        yield "frequencies", _listed(map(_frequency, series.frequencies))
    yield "ring", series.precision
    if series.smallest_divisors:
        yield "smallest divisor", repr(series.smallest_divisors[0])


def _history_verdict(history: AmplitudeHistory) -> str:
    return f"{len(history.amplitudes)} of {len(history.orders)} orders have a root"


def _history_rows(history: AmplitudeHistory) -> Rows:
    yield "seeds", _listed(history.seeds)
    if history.amplitudes:
        last = max(history.amplitudes)
        sizes = ", ".join(_number(A) for A in history.amplitudes[last])
        yield f"amplitudes at order {last}", sizes


def _assessment_rows(found: Assessment) -> Rows:
    yield "best order", f"{found.best_order} of {found.order}"
    yield "least residual", f"{found.residuals[found.best_order]:.2g}"
    yield "radius in mu, by ratio", f"{found.radius:.3g}"
    for reason in found.reasons:
        yield "", reason


def _orbit_rows(orbit: Orbit) -> Rows:
    yield "chain", orbit.chain.label
    yield "to t", f"{orbit.times[-1]:.10g}, {len(orbit.times)} samples"
    yield "scheme", f"{orbit.scheme.name}, step {abs(orbit.step):.6g}"
    energies = orbit.energies[0].reshape(-1)
    yield "energy H", ", ".join(_number(H) for H in energies[:3])


def _index_rows(found: AlignmentIndices) -> Rows:
    yield "chain", found.chain.label
    yield "to t", f"{found.times[-1]:.10g}"
    for slope in found.slopes():
        yield f"slope of G_{slope.k}", f"{slope.value:z.2f} \u00b1 {slope.error:.2f}"
    yield "Lyapunov exponent", f"{found.lyapunov[-1]:.2g}"
    yield "energy error", f"{found.energy_error:.1g}"


def _foretold_rows(found: ForetoldIndices) -> Rows:
    yield "chain", found.torus.chain.label
    yield "seeds", _listed(found.torus.seeds)
    for k, time in found.settling().items():
        slope = found.asymptotic_slopes[k]
        yield f"G_{k}", f"slope {slope}, {settled_text(time, found.times[-1])}"
    yield "rates of growth", ", ".join(f"{rate:.2g}" for rate in found.rates)


def _floquet_rows(found: Floquet) -> Rows:
    yield "chain", found.orbit.chain.label
    yield "seed", str(found.orbit.seed)
    yield "largest |multiplier|", _number(found.largest)
    for kind, count in found.instabilities.items():
        yield "unstable", f"{count} {kind}"


def _normal_rows(found: NormalModes) -> Rows:
    yield "chain", found.torus.chain.label
    yield "seeds", _listed(found.torus.seeds)
    for mode in found.modes[:MOST_MODES]:
        yield f"\N{GREEK SMALL LETTER SIGMA} of mode {mode.mode}", mode.text
    if found.resonances:
        yield "nearest resonance", repr(found.resonances[0])
    yield "residual", f"{found.residual:.2g}"


def _normal_family_rows(found: NormalFamily) -> Rows:
    torus = found.members[0].torus
    yield "chain", torus.chain.label
    yield "seeds", _listed(torus.seeds)
    yield "members", str(len(found.members))
    for event in found.events[:MOST_MODES]:
        yield event.kind, repr(event)


def _family_picture(found: Family, ax: Axes | None = None) -> Axes:
    """Normal frequencies where they are known, else energies by frequencies."""
    if any(m.normal for m in found.members):
        return family_normal_frequencies(found, ax)
    return family_frequencies(found, ax)


def _family_rows(found: Family) -> Rows:
    energies = [m.energy for m in found.members]
    yield "chain", found.chain.label
    yield "seeds", _listed(found.seeds)
    yield "members", f"{len(found.members)}, H = {min(energies):.6g} .. {max(energies):.6g}"
    for kind in ("fold", "resonance", "stability"):
        count = sum(event.kind == kind for event in found.events)
        if count:
            yield f"events: {kind}", str(count)
    for event in found.normal_events[:MOST_MODES]:
        yield event.kind, repr(event)


def _proof_rows(proof: PropagationProof) -> Rows:
    yield "chain", f"N={proof.N}, {proof.model}"
    yield "seeds", _listed(proof.seeds)
    for k, modes in enumerate(proof.actual):
        yield f"D_{k}", _listed(modes) or "none"
    for odd in proof.exceptions:
        yield f"mode {odd.mode}", f"predicted {odd.predicted}, actually {odd.actual}"


def _toda_rows(found: TodaInvariants) -> Rows:
    yield "chain", f"N={found.N}, a={decimal(found.a)}"
    yield "widest gap", _number(max(found.gaps), found.digits)
    yield "sum of actions", _number(sum(found.actions), found.digits)


def _line_rows(found: FrequencyAnalysis) -> Rows:
    yield "chain", found.chain.label
    yield "to t", f"{found.T:.10g}"
    by_seed = zip(found.seeds, found.frequencies, found.errors, strict=True)
    for q, omega, error in by_seed:
        yield f"\N{GREEK SMALL LETTER OMEGA}_{q}", f"{omega:.15g} \u00b1 {error:.1g}"
    unknown = sum(line.harmonic is None for line in found.lines)
    yield "lines", f"{len(found.lines)}, {unknown} of them unidentified"
    yield "drift", f"{found.drift:.2g}"


def _borders_found(found: Atlas) -> int:
    return sum(border.energy is not None for border in found.borders)


def _atlas_rows(found: Atlas) -> Rows:
    yield "points", str(found.points)
    for (model, packet, border), law in found.laws.items():
        yield f"{border} of {packet}, {model}", f"N^({law.exponent:.3g} +- {law.error:.2g})"


def _map_rows(found: FrequencyMap) -> Rows:
    yield "chain", found.chain.label
    yield "packet", _listed(found.packet)
    yield "to t", f"{found.T:.10g}"
    by_energy = zip(found.energies, found.counts, found.drifts, strict=True)
    for energy, count, drift in by_energy:
        yield (
            f"H = {energy:.6g}",
            f"{counted(count, 'frequency', 'frequencies')}, drift {drift:.2g}",
        )


def _energy_series(orbit: Orbit, ax: Axes | None = None) -> Axes:
    return time_series(orbit, ax, quantity="E")


_energy_series.__name__ = "time_series"

USUAL = (
    Usual(Torus, spectrum, _torus_verdict, _torus_rows),
    Usual(
        LindstedtSeries,
        small_divisors,
        _series_verdict,
        _series_rows,
        lambda series: bool(series.smallest_divisors),
    ),
    Usual(
        AmplitudeHistory,
        amplitudes,
        _history_verdict,
        _history_rows,
        lambda history: bool(history.differences()),
    ),
    Usual(Assessment, residuals, lambda found: found.verdict, _assessment_rows),
    Usual(
        Orbit,
        _energy_series,
        lambda orbit: f"energy error {orbit.energy_error:.2g}",
        _orbit_rows,
        lambda orbit: orbit.Q.ndim == 2,
    ),
    Usual(
        AlignmentIndices, alignment, lambda found: found.dimension().verdict, _index_rows
    ),
    Usual(ForetoldIndices, foretold, lambda found: found.verdict, _foretold_rows),
    Usual(
        Floquet,
        multipliers,
        lambda found: "stable" if found.stable else "unstable",
        _floquet_rows,
    ),
    Usual(NormalModes, normal_frequencies, lambda found: found.verdict, _normal_rows),
    Usual(
        NormalFamily,
        family_normal_frequencies,
        lambda found: found.verdict,
        _normal_family_rows,
    ),
    Usual(Family, _family_picture, lambda found: f"it {found.ending}", _family_rows),
    Usual(PropagationProof, propagation, lambda proof: proof.verdict, _proof_rows),
    Usual(
        FrequencyAnalysis,
        lines,
        lambda found: counted(
            len(found.seeds), "independent frequency", "independent frequencies"
        ),
        _line_rows,
    ),
    Usual(
        FrequencyMap,
        frequency_map,
        lambda found: f"{found.counts.min()} to {found.counts.max()} frequencies",
        _map_rows,
    ),
    Usual(
        Atlas,
        atlas_borders,
        lambda found: counted(_borders_found(found), "border"),
        _atlas_rows,
        lambda found: _borders_found(found) > 0,
    ),
    Usual(TodaInvariants, toda_gaps, lambda found: "gaps and actions", _toda_rows),
)
