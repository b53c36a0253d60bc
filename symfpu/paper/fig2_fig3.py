"""Figs. 2 and 3: the 4-torus of the lowest modes, its FPU-trajectory, and the groups in which energy spreads.

The claims are those of section 4.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import excitation_sequence
from symfpu.dynamics.orbits import Orbit
from symfpu.figures.alignment import alignment_panel
from symfpu.figures.panels import Curve, Panel
from symfpu.localization.floors import spectrum_floor
from symfpu.localization.growth import GroupGrowth, GrowthExponents, growth_exponents
from symfpu.localization.laws import fit_profile, middle_modes
from symfpu.localization.profiles import fpu_trajectory, normalised_averages, profile_distance
from symfpu.paper.captions import caption_claim, caption_curve, law_of, printed_line
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.dimensions import FULL_TIME, indices, settled_after
from symfpu.paper.judgements import (
    AGREEMENT,
    FLOOR,
    SIMILAR,
    cancellation_claim,
    dimension_claim,
    falls,
    groups_claim,
    runs,
    same_profile,
    sums_panel,
)
from symfpu.paper.printed import PrintedLine, PrintedTorus
from symfpu.paper.starts import (
    follow,
    normalised_floor,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.paper.steps import Step
from symfpu.paper.table import rounds_to
from symfpu.refinement.tori import RefinedTorus, refine
from symfpu.tori.torus import QTorus

Floats = NDArray[np.float64]
TIME = 1e6  # the paper's
IDENTICAL = 1e-3  # of the largest coordinate: orbits that a picture cannot tell apart
PAPER_EXPONENT = 1.5  # c_q(k) = (3/2) k + eps_q
PLATEAU = 3e7  # the time of stabilization of G_4, after which G_5 falls
FOUND = 1e-10  # a residual of the equations of motion that no truncated series of this torus has
EARLY = (1.0, 100.0)  # the window in which a line reads (3/2) k
# spread of exponents in a group, far below the distance of groups; distance of an exponent per
# order from 3/2
SMALL, READ = 0.3, 0.1
DECADE = 10**0.5  # factor within which a size is the printed power of ten
GROUPS_SEEN = 4  # D_1 .. D_4 have room to grow before they saturate


def figure2(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """The 4-torus of N = 32: its spectrum three ways, its alignment indices, its sums."""
    row = printed_row("Fig. 2")
    step("fig2: series")
    torus = printed_torus(row)
    exact = refine(torus, report=lambda line: step(f"fig2: exact torus: {line}"))
    orbit = follow("fig2 PLn", row.chain, torus, TIME, step)
    found = indices("fig2", (torus.positions(0.0), torus.momenta(0.0)), step, folder, full=full)
    profiles = {
        "PL": torus.average_spectrum() / torus.energy(),
        "PLn": normalised_averages(orbit)[-1],
        "exact torus": exact.average_spectrum() / exact.energy(),
    }
    floors = {"PL": normalised_floor(torus), "exact torus": normalised_floor(exact)}
    line = printed_line("Fig. 2a")
    sums = torus.series.absolute_sums(1, list(torus.amplitudes.values()), with_mu=True)
    panels = (
        profile_panel(
            "fig2a",
            "Fig. 2(a): the 4-torus, average spectrum",
            row.chain,
            profiles,
            *_lines(line),
            floors=floors,
        ),
        alignment_panel("fig2b", "Fig. 2(b): alignment indices of PLn", found),
        sums_panel("fig2c", "Fig. 2(c): cancellations in the series of mode 1", 1, sums),
    )
    H = float(torus.energy())
    meant = {
        f"the total energy H = {H:.9f} for E, and + 2 log kappa": law_of(
            line, row.chain, specific_energy=H / row.chain.N
        )
    }
    settled = (
        f"; G_4 within 0.3 decades of its last value from t = {settled_after(found, 4):.0e} on"
    )
    claims = (
        same_profile(
            "4",
            "PL and PLn have no distinguishable difference in their profiles",
            profiles,
            "PL",
            "PLn",
        ),
        same_profile(
            "4",
            "the truncated series shows the profile of a q-torus",
            profiles,
            "PL",
            "exact torus",
        ),
        _identical(torus, orbit),
        _exponential(exact),
        caption_claim(line, "4", meant),
        _line_fits(line, profiles["exact torus"]),
        dimension_claim(
            "4",
            "G_2, G_3 soon constant, G_4 after 3e7, G_5 falls as 1/t from there to 1e9",
            4,
            found,
            shown_after=PLATEAU,
            whole=FULL_TIME,
            more=settled,
        ),
        _both_fall(sums, row.order),
        cancellation_claim(
            "4",
            "cancellations make about two orders of magnitude between S_1 and S_2 at k = 11",
            2.0,
            sums,
            row.order,
        ),
        _root_finding(exact),
    )
    return PaperFigure("fig2", "Fig. 2: the 4-torus of N = 32, seeds 1 to 4", panels, claims)


def _lines(line: PrintedLine) -> tuple[Curve, Curve]:
    """The line of the caption, and the law it is said to be."""
    chain = line.chains[0]
    kappa = np.arange(1.0, chain.N) / chain.N
    return caption_curve(line, kappa), Curve("Eq. eksa2", kappa, 10 ** law_of(line, chain)(kappa))


def _identical(torus: QTorus, orbit: Orbit) -> Claim:
    there = torus.positions(orbit.times)
    off = np.max(np.abs(orbit.Q - there), axis=1) / np.max(np.abs(there))
    late = orbit.times[off > IDENTICAL]
    ours = f"they part by {off[1]:.0e} of the largest coordinate at t = {orbit.times[1]:.2g}, {off[-1]:.1e} at t = {orbit.times[-1]:.0e}"
    ours += f", more than {IDENTICAL:g} from t = {late[0]:.1e} on" if late.size else ""
    text = "the solutions themselves, PL(t) and PLn(t), are almost identical"
    return Claim(
        "4, note",
        text,
        "",
        ours,
        judged(not late.size, bool(late.size and late[0] > orbit.times[-1] / 10)),
    )


def _exponential(exact: RefinedTorus) -> Claim:
    """A straight line beyond the seeds."""
    spectrum = np.asarray(exact.average_spectrum(), dtype=float)
    fit = fit_profile(exact.chain, spectrum, len(exact.seeds), floor=spectrum_floor(exact))
    text = "strong localization in the first four modes, then an exponential decay of e_kappa with kappa"
    return Claim(
        "4",
        text,
        "",
        f"{fit!r} (exact torus)",
        judged(-fit.line.slope > 3 * fit.errors[0] and fit.scatter <= SIMILAR),
    )


def _line_fits(line: PrintedLine, spectrum: Floats) -> Claim:
    """How far the line of the caption is from the middle modes, for which the law is made."""
    chain = line.chains[0]
    middle = np.array(middle_modes(chain, line.seeds(chain)))
    levels, law = np.log10(spectrum[middle - 1]), law_of(line, chain)
    printed = np.log10(caption_curve(line, middle / chain.N).y)
    off, meant = (
        float(np.max(np.abs(levels - values))) for values in (printed, law(middle / chain.N))
    )
    ours = f"middle modes {', '.join(map(str, middle))}: off by up to {off:.2g} decades as printed, {meant:.2g} from Eq. eksa2"
    text = "the theoretical line of Fig. 2(a) predicts the localization profile"
    return Claim("4", text, "", ours, judged(off <= SIMILAR, meant <= SIMILAR))


def _both_fall(sums: tuple[Floats, Floats], order: int) -> Claim:
    upper, lower = (falls(values, order) for values in sums)
    words = {True: "falls", False: "does not fall"}
    ours = f"from every k to k + 2, S_1 {words[upper]}, S_2 {words[lower]}"
    return Claim(
        "4", "both sums decay up to k = 11", "", ours, judged(upper and lower, upper or lower)
    )


def _root_finding(exact: RefinedTorus) -> Claim:
    residual = exact.residual()
    ours = f"Newton's method in Fourier space has found this 4-torus, residual {residual:.0e}"
    text = "a root-finding determination is possible only for q-breathers, not for tori of dimension above one"
    return Claim(
        "6.4",
        text,
        "",
        ours if residual < FOUND else f"{ours}: not found",
        judged(residual >= FOUND),
    )


def figure3(folder: Path, step: Step, *, full: bool = False) -> PaperFigure:
    """The FPU-trajectory of the same seeds: growth of the groups, and its spectrum beside that of
    the torus.
    """
    row = printed_row("Fig. 2")
    torus = printed_torus(row)
    orbit = follow(
        "fig3 FPU-trajectory",
        row.chain,
        fpu_trajectory(row.chain, printed_amplitudes(row)),
        TIME,
        step,
        samples=600,
    )
    shares = normalised_averages(orbit)
    groups = excitation_sequence(row.chain.N, row.seeds, (row.chain.N - 1) // len(row.seeds))
    growth = [
        growth_exponents(row.chain, orbit.times, shares, groups, window=window)
        for window in (None, EARLY)
    ]
    profiles = {
        "torus (PL)": np.asarray(torus.average_spectrum() / torus.energy()),
        "FPU-trajectory": shares[-1],
    }
    floors = {"torus (PL)": normalised_floor(torus)}
    curves = tuple(
        Curve(f"$D_{{{k}}}$", orbit.times, shares[:, q - 1], group=k, name=f"D_{k} q={q}")
        for k, modes in enumerate(groups)
        for q in modes
    )
    axes, title = (
        ("t", "average_energy_over_H"),
        "Fig. 3(a): FPU-trajectory, running averages by mode",
    )
    panels = (
        Panel("fig3a", title, r"$t$", r"$\overline{E}_q(t) / E$", curves, axes, log_x=True),
        profile_panel(
            "fig3b", "Fig. 3(b): torus and FPU-trajectory", row.chain, profiles, floors=floors
        ),
    )
    text = "the FPU-trajectory settles to a profile very similar to that of the torus"
    claims = (
        _distance(torus, orbit.Q[0]),
        *_growth_claims(*growth),
        _steady_seeds(shares, row),
        _persists(orbit.times, shares),
        same_profile("4.1", text, profiles, *profiles, within=SIMILAR),
        groups_claim(
            "4.1",
            "the groups D_k are well distinguished in the spectrum of the FPU-trajectory",
            groups,
            shares[-1],
        ),
    )
    return PaperFigure("fig3", "Fig. 3: the FPU-trajectory near the 4-torus", panels, claims)


def _distance(torus: QTorus, Q: Floats) -> Claim:
    """Between the initial conditions, as a part of the largest coordinate.

    Q : of the FPU-trajectory.
    """
    mu = torus.series.chain.mu
    off = float(np.abs(np.asarray(torus.positions(0.0), dtype=float) - Q).max() / np.abs(Q).max())
    ours = (
        f"mu = {mu:.5f}; they begin {off:.2g} = {off / mu:.2g} mu of the largest coordinate apart"
    )
    text = "the initial distance of FPU-trajectory and torus is O(mu), mu about 4e-2"
    return Claim(
        "4.1", text, "4e-2", ours, judged(rounds_to(mu, "0.04") and off <= 10 * mu, off <= 10 * mu)
    )


def _growth_claims(own: GrowthExponents, early: GrowthExponents) -> tuple[Claim, ...]:
    first, second = (
        [group for group in growth.groups if group.order <= GROUPS_SEEN] for growth in (own, early)
    )
    return (_alike(second), _exponents(first, second), _times(first))


def _alike(groups: list[GroupGrowth]) -> Claim:
    """Modes of one group grow alike, and groups differ."""
    ours = "; ".join(
        f"D_{g.order} = {runs(g.modes)}: {g.mean:.2f} +- {g.spread:.2f}" for g in groups
    )
    apart = min(b.mean - a.mean for a, b in itertools.pairwise(groups))
    text = "during the first stage the modes of a group D_k = {ks+1 .. (k+1)s} grow by almost the same power of t"
    holds = all(g.spread <= SMALL for g in groups) and apart > 2 * SMALL
    ours = f"exponents between t = {EARLY[0]:g} and {EARLY[1]:g}, {ours}"
    return Claim("4.1", text, "", ours, judged(holds, apart > 2 * SMALL))


def _exponents(own: list[GroupGrowth], early: list[GroupGrowth]) -> Claim:
    """The paper's exponent is that of a line through two stages, each of which has another one."""
    stages, line = ([g.mean / g.order for g in groups] for groups in (own, early))
    read = [
        g.order for g, rate in zip(early, line, strict=True) if abs(rate - PAPER_EXPONENT) <= READ
    ]
    by_order, by_stage = (", ".join(f"{rate:.2f}" for rate in rates) for rates in (line, stages))
    ours = (
        f"exponents for each order k = 1 .. {len(line)}: {by_order} of a line through t = {EARLY[0]:g} .. {EARLY[1]:g}, "
        f"{by_stage} from pi/Omega_1 to a quarter of the last value. "
        "Perturbation theory has two stages: t^(4k-2) before t = 1/Omega_q, t^(2k) until one over the detuning"
    )
    holds = all(abs(rate - PAPER_EXPONENT) <= READ for rate in (*stages, *line))
    return Claim(
        "4.1",
        "the exponents are c_q(k) = (3/2) k + eps_q, |eps_q| << 1",
        "3/2 k",
        ours,
        judged(holds, len(read) > 1),
    )


def _times(groups: list[GroupGrowth]) -> Claim:
    (first, last), rest = groups[0].saturation, [t for g in groups[1:] for t in g.saturation]
    early = f"{min(rest):.2g} .. {max(rest):.2g} in D_2 .. D_{len(groups)}"
    ours = f"averages reach 0.9 of their last value at {first:.2g} .. {last:.2g} in D_1, {early}"
    slow, fast = 1e3 / DECADE < last < 1e3 * DECADE, 1e2 / DECADE < max(rest) < 1e2 * DECADE
    text = "energy arrives within 1e3 in modes 5 to 8, within 1e2 in the others"
    return Claim("4.1", text, "1e3, 1e2", ours, judged(slow and fast, slow or fast))


def _persists(times: Floats, shares: Floats) -> Claim:
    """Whether the averaged spectrum of the middle of the record is that of its end."""
    middle = int(np.searchsorted(times, times[-1] / 100))
    off = profile_distance(shares[middle], shares[-1], FLOOR)
    ours = f"from t = {times[middle]:.0e} to {times[-1]:.0e} the averages move by at most {off.distance:.2g} decades (mode {off.mode})"
    text = "at the end of the first stage the spectrum is stabilized to a form that persists for quite long times"
    return Claim("4.1", text, "", ours, judged(off.distance <= AGREEMENT, off.distance <= SIMILAR))


def _steady_seeds(shares: Floats, row: PrintedTorus) -> Claim:
    seeds = shares[:, np.array(row.seeds) - 1]
    change = float(np.max(np.abs(seeds[1:] - seeds[0])))
    ours = f"largest change of a seed's average, over E: {change:.1e}; energy that reaches the other modes: {1 - seeds[-1].sum():.1e}"
    return Claim(
        "4.1",
        "the averages of the seeds vary only by about 1e-4",
        "1e-4",
        ours,
        judged(3e-5 < change < 3e-4),
    )
