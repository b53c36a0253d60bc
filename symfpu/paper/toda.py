"""What Toda teaches: which results of the paper are the integrable chain's, and which FPU's own.

At equal c_3. The numbers come from toda_fig1.py, toda_tori.py and toda_orbits.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from symfpu.files.progress import Progress
from symfpu.paper.claims import PaperFigure
from symfpu.paper.toda_fig1 import Fig1Study, fig1_study
from symfpu.paper.toda_orbits import OrbitStudy, orbit_study
from symfpu.paper.toda_panels import (
    LAST_GAP,
    angle_panel,
    fig1_panels,
    orbit_panels,
    spectra_panel,
)
from symfpu.paper.toda_tori import (
    GroupStudy,
    TorusStudy,
    gap_energies,
    group_study,
    torus_studies,
)
from symfpu.results.numbers import fifteen_digits
from symfpu.results.text_tables import markdown_table

SHOWN_RATIOS = (12, 18, 24, 30)
SHOWN_GAPS = (0, 1, 2, 3, 4, 7, 10, 13, 16)  # places of the modes in the table of gaps
LOWEST_SHARE = 1e-24  # of averages to compare: below is rounding


@dataclass(frozen=True, eq=False)
class TodaStudy:
    """All that the page needs."""

    fig1: Fig1Study
    tori: dict[str, TorusStudy]
    groups: GroupStudy
    orbits: OrbitStudy


def toda_page(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """Figs. 1, 2, 3 and 9 in the Toda chain beside alpha, with Toda's gaps."""
    study = TodaStudy(
        fig1=fig1_study(progress),
        tori=torus_studies(progress),
        groups=group_study(progress),
        orbits=orbit_study(progress),
    )
    return toda_figure(study)


def toda_figure(study: TodaStudy) -> PaperFigure:
    """What the study found."""
    panels = (
        *fig1_panels(study.fig1),
        spectra_panel("toda-c", study.tori["Fig. 1"]),
        spectra_panel("toda-d", study.tori["Fig. 2"]),
        angle_panel(study.tori["Fig. 1"]),
        *orbit_panels(study.orbits),
    )
    text = (
        "### Fig. 1: the pole of the series",
        series_table(study.fig1),
        *resonance_text(study.fig1),
        "### Figs. 1 and 2: profiles and gaps",
        *(tori_table(torus) for torus in study.tori.values()),
        *(gaps_table(torus) for torus in study.tori.values()),
        *(tail_text(torus) for torus in study.tori.values()),
        "### Groups D_k",
        groups_text(study.groups),
        "### Fig. 3: the FPU-trajectory",
        drift_table(study.orbits),
        averages_text(study.orbits),
        "### Fig. 9: recurrences, and the end of the series",
        recurrence_table(study.orbits),
        fold_table(study.orbits),
    )
    title = "What Toda teaches: alpha and Toda chains of the same c_3"
    return PaperFigure("toda", title, panels, (), text=text, numbers=toda_numbers(study))


def series_table(data: Fig1Study) -> str:
    """Growth of the resonant harmonic, the pole that the probe predicts, residuals."""
    head = ["chain", *(f"c_{k}/c_{k - 2}" for k in SHOWN_RATIOS), "1/pole", "best order"]
    rows = []
    for name, study in data.series.items():
        row = [name, *(f"{study.ratios[k]:.5f}" for k in SHOWN_RATIOS)]
        row += [f"{1 / study.pole:.5f}", str(study.assessment.best_order)]
        residuals = study.assessment.residuals
        row += [f"{residuals.min():.1e}", f"{residuals[-1]:.1e}", f"{study.resummed:.1e}"]
        rows.append(row)
    last = next(iter(data.series.values())).torus.origin.order
    head += ["least residual", f"order {last}", f"order {last}, Pade"]
    return markdown_table(head, rows)


def resonance_text(data: Fig1Study) -> tuple[str, ...]:
    """The scans, by chain."""
    head = ("chain", "resonance at omega_2", "residue", "largest residual of the tori")
    rows = []
    for name, scan in data.scans.items():
        row = [name, f"{scan.resonance:.9f}", f"{scan.residue:.2e}", f"{scan.worst:.0e}"]
        rows.append(row)
    text = "On tori of Newton's method, omega_1 as printed: the coefficient of (5,-4) in mode 3 "
    text += "as residue/(omega_2 - resonance) and what is smooth."
    exact = (
        f"The exact Toda torus with the printed frequencies has H = {data.exact.energy}."
    )
    return text, markdown_table(head, rows), exact


def tori_table(study: TorusStudy) -> str:
    """Energies, amplitudes and residuals."""
    seeds = study.alpha.seeds
    head = [study.label, *(f"omega_{q}" for q in seeds), *(f"A_{q}" for q in seeds)]
    rows = []
    for name, torus in study.tori().items():
        row = [name, *(f"{float(w):.9f}" for w in torus.frequencies)]
        row += [f"{a:.9f}" for a in torus.amplitudes.values()]
        row += [f"{float(torus.energy()):.15f}", f"{torus.residual():.0e}"]
        rows.append(row)
    exact = ["Toda, exact", *rows[1][1 : 1 + len(seeds)], *("" for _ in seeds)]
    rows.append([*exact, f"{study.exact_energy:.15f}", ""])
    return markdown_table([*head, "H", "residual"], rows)


def gaps_table(study: TorusStudy) -> str:
    """Spectra and gaps of chosen modes, in decades."""
    last = study.alpha.chain.N - 1
    places = [i for i in SHOWN_GAPS if i < last]
    head = [f"{study.label}, log10 of", *(f"q = {i + 1}" for i in places)]
    rows = []
    for name, torus in study.tori().items():
        shares = torus.average_spectrum() / torus.energy()
        rows.append([f"E_q/H, {name}", *_decades(shares[places])])
    for name, torus in study.tori().items():
        gaps = study.gaps[name]
        rows.append([f"largest gap, {name}", *_decades(gaps.max(axis=0)[places])])
        if torus is study.alpha:
            energies = gap_energies(torus, gaps.max(axis=0))
            rows.append(["smallest gap, alpha", *_decades(gaps.min(axis=0)[places])])
            rows.append(["its energy/H, largest, alpha", *_decades(energies[places])])
    return markdown_table(head, rows)


def tail_text(study: TorusStudy) -> str:
    """How far the alpha torus is from the Toda torus of its amplitudes, beyond the seeds."""
    s = len(study.alpha.seeds)
    ours, theirs = (
        torus.average_spectrum() / torus.energy()
        for torus in (study.alpha, study.same_amplitudes)
    )
    tail = slice(s, LAST_GAP[study.label])
    apart = np.abs(np.log10(ours[tail] / theirs[tail]).astype(float))
    energies = gap_energies(study.alpha, study.gaps["alpha"].max(axis=0))
    below = np.log10(theirs[tail] / energies[tail])
    widest = s + 1 + int(np.argmax(apart))
    words = (
        f"{study.label}, modes {s + 1} to {LAST_GAP[study.label]}: alpha and Toda of the "
    )
    words += f"same amplitudes are {np.median(apart):.3f} decades apart in the median, "
    words += (
        f"{apart.max():.3f} at most (mode {widest}); the energy in the gaps of alpha is "
    )
    words += f"{below[0]:.1f} decades below that of the Toda torus in mode {s + 1}, "
    words += f"{np.median(below):.1f} in the median, {energies[s:].sum():.1e} of H in all."
    return words


def _decades(values: Any) -> list[str]:
    sizes = np.asarray(values, dtype=float)
    return [f"{np.log10(x):.2f}" if x > 0 else "closed" for x in sizes]


def groups_text(data: GroupStudy) -> str:
    """What was compared, and what differs."""
    words = f"{data.cases} sets of one or two seeds, N = 3 to 8, generic frequencies: "
    words += f"{len(data.differing)} with other groups in Toda than in alpha. "
    words += (
        f"Fig. 1 at the linear frequencies: of {data.terms} coefficients of coordinates "
    )
    words += f"that are not zero in alpha, {data.vanishing} are in Toda. "
    parts = [f"{name} {100 * part:.1f} %" for name, part in data.cross_terms.items()]
    words += "Largest part of the other seeds in the lowest frequency shift of a seed of "
    words += f"Fig. 2 (equal amplitudes), of that of its own amplitude: {', '.join(parts)}."
    return words


def drift_table(data: OrbitStudy) -> str:
    """Gaps along the orbit: first value and how far they go from it."""
    alpha = data.trajectories["alpha"]
    places = [i for i in SHOWN_GAPS if i < alpha.gaps.shape[1]]
    head = ["log10 of", *(f"q = {i + 1}" for i in places)]
    rows = [["gap at t = 0, alpha", *_decades(alpha.gaps[0][places])]]
    for name, study in data.trajectories.items():
        rows.append([f"largest change, {name}", *_decades(study.drift()[places])])
    return markdown_table(head, rows)


def averages_text(data: OrbitStudy) -> str:
    """How far averages and group energies are apart, in decades."""
    ours, theirs = (data.trajectories[name] for name in ("alpha", "Toda"))
    known = (ours.shares > LOWEST_SHARE) & (theirs.shares > LOWEST_SHARE)
    off = np.abs(np.log10(ours.shares[known] / theirs.shares[known]))
    apart = np.abs(np.log10(ours.highest / theirs.highest))[ours.highest > LOWEST_SHARE]
    end = ours.times[-1]
    words = f"Averages to t = {end:.0e}: apart by at most {off.max():.3f} decades in the "
    words += f"{int(known.sum())} modes above rounding; largest energies of the groups "
    words += f"D_0 .. D_{len(apart) - 1}: by at most {apart.max():.3f} decades."
    return words


def recurrence_table(data: OrbitStudy) -> str:
    """Times of the returns and how much comes back."""
    rows = []
    for name, study in data.recurrences.items():
        found = study.returns
        for time, part in zip(found.times, found.returned, strict=True):
            rows.append([name, f"{time:.2f}", f"{100 * part:.4f} %"])
    return markdown_table(("chain", "return at t", "of the energy"), rows)


def fold_table(data: OrbitStudy) -> str:
    """The breather with the printed frequency, and the end of its series."""
    head = (
        "chain",
        "A of the breather",
        "H",
        "the series ends at A",
        "with omega",
        "limit",
    )
    rows = []
    for name, study in data.folds.items():
        row = [name, f"{study.amplitudes[-1]:.9f}", f"{study.energy:.15f}"]
        row += [f"{study.ends[-1]:.6f}", f"{study.reached[-1]:.7f}"]
        row.append(f"{study.limit:.6f}")
        rows.append(row)
    rows.append(["Toda, exact", "", f"{data.exact_energy:.15f}", "", "", ""])
    return markdown_table(head, rows)


def toda_numbers(study: TodaStudy) -> dict[str, Any]:
    """For JSON."""
    record: dict[str, Any] = {"series": {}, "resonance": {}, "tori": {}}
    for name, series in study.fig1.series.items():
        last = max(series.ratios)
        ratio = fifteen_digits(series.ratios[last])
        record["series"][name] = {"pole": fifteen_digits(series.pole), "ratio": ratio}
    for name, scan in study.fig1.scans.items():
        place, residue = fifteen_digits(scan.resonance), fifteen_digits(scan.residue)
        record["resonance"][name] = {"omega_2": place, "residue": residue}
    for label, tori in study.tori.items():
        energies = {name: repr(float(t.energy())) for name, t in tori.tori().items()}
        energies["Toda, exact"] = repr(tori.exact_energy)
        record["tori"][label] = {"energies": energies, "gaps": _largest_gaps(tori)}
    groups = study.groups
    record["groups"] = {"cases": groups.cases, "differing": len(groups.differing)}
    record["cross_terms"] = {n: fifteen_digits(x) for n, x in groups.cross_terms.items()}
    orbits = study.orbits
    record["drift"] = {n: _list(t.drift()) for n, t in orbits.trajectories.items()}
    record["returns"] = {n: _list(r.returns.times) for n, r in orbits.recurrences.items()}
    ends = {name: fifteen_digits(fold.ends[-1]) for name, fold in orbits.folds.items()}
    record["series_ends"] = ends
    return record


def _largest_gaps(tori: TorusStudy) -> dict[str, list[float]]:
    return {name: _list(gaps.max(axis=0)) for name, gaps in tori.gaps.items()}


def _list(values: Any) -> list[float]:
    return [fifteen_digits(value) for value in np.asarray(values).tolist()]
