"""Fig. 3: the FPU-trajectory near the 4-torus, and the groups in which energy spreads.

The claims are those of section 4.1.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symfpu.chain.propagation import excitation_sequence
from symfpu.figures.panels import Curve, Panel
from symfpu.files.progress import Progress
from symfpu.localization.growth import GroupGrowth, GrowthExponents, growth_exponents
from symfpu.localization.profiles import (
    fpu_trajectory,
    normalised_averages,
    profile_distance,
)
from symfpu.paper.claims import Claim, PaperFigure, judged
from symfpu.paper.judgements import (
    ENERGY_FLOOR,
    SAME_DECADES,
    SIMILAR_DECADES,
    groups_claim,
    runs,
    same_profile,
)
from symfpu.paper.printed import PrintedTorus
from symfpu.paper.starts import (
    integrated_orbit,
    normalised_floor,
    printed_amplitudes,
    printed_row,
    printed_torus,
    profile_panel,
)
from symfpu.paper.table import rounds_to
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus

Floats = NDArray[np.float64]
TIME, LOOKS = 1e6, 600  # the paper's
STEP = 0.7  # growth is fitted from t = 1 on, where looks at every unit are few
PAPER_EXPONENT = 1.5  # c_q(k) = (3/2) k + eps_q
LINE_WINDOW = (1.0, 100.0)  # times in which a line reads (3/2) k
# of exponents in a group, far below the distance of groups
GROUP_SPREAD = 0.3
EXPONENT_TOLERANCE = 0.1  # of an exponent per order, about 3/2
POWER_OF_TEN = 10**0.5  # factor within which a size is the printed power of ten
UNSATURATED_GROUPS = 4  # D_1 .. D_4 have room to grow before they saturate
LATE_TIME, SOON_TIME = 1e3, 1e2  # "within 1e3 in modes 5 to 8, within 1e2 in the others"
SEED_CHANGES = (3e-5, 3e-4)  # "about 1e-4"
MU_FACTOR = 10  # times mu: a distance of the order of mu


def figure3(folder: Path, progress: Progress, *, full: bool = False) -> PaperFigure:
    """The FPU-trajectory of the seeds of Fig. 2.

    Growth of the groups, and its spectrum beside that of the torus.
    """
    row = printed_row("Fig. 2")
    chain = row.chain
    torus = printed_torus(row)
    start = fpu_trajectory(chain, printed_amplitudes(row))
    orbit = integrated_orbit(
        "fig3 FPU-trajectory",
        chain,
        start,
        TIME,
        progress,
        step=STEP,
        samples=LOOKS,
    )
    shares = normalised_averages(orbit)
    groups = excitation_sequence(chain.N, row.seeds, (chain.N - 1) // len(row.seeds))
    own = growth_exponents(chain, orbit.times, shares, groups, window=None)
    early = growth_exponents(chain, orbit.times, shares, groups, window=LINE_WINDOW)
    spectrum = np.asarray(torus.average_spectrum() / torus.energy())
    profiles = {"torus (PL)": spectrum, "FPU-trajectory": shares[-1]}
    floors = {"torus (PL)": normalised_floor(torus)}
    settles = "the FPU-trajectory settles to a profile very similar to that of the torus"
    grouped = "the groups D_k are well distinguished in the spectrum of the FPU-trajectory"
    title_b = "Fig. 3(b): torus and FPU-trajectory"
    claims = (
        distance_claim(torus, orbit.Q[0]),
        *_growth_claims(own, early),
        seeds_claim(shares, row),
        persistence_claim(orbit.times, shares),
        same_profile("4.1", settles, profiles, *profiles, within=SIMILAR_DECADES),
        groups_claim("4.1", grouped, groups, shares[-1]),
    )
    panels = (
        _growth_panel(orbit.times, shares, groups),
        profile_panel("fig3b", title_b, chain, profiles, floors=floors),
    )
    return PaperFigure(
        "fig3", "Fig. 3: the FPU-trajectory near the 4-torus", panels, claims
    )


def _growth_panel(times: Floats, shares: Floats, groups: list[tuple[int, ...]]) -> Panel:
    """Running averages of all modes, a colour for each group."""
    curves = []
    for k, modes in enumerate(groups):
        for q in modes:
            name = f"D_{k} q={q}"
            curve = Curve(f"$D_{{{k}}}$", times, shares[:, q - 1], group=k, name=name)
            curves.append(curve)
    title = "Fig. 3(a): FPU-trajectory, running averages by mode"
    labels = (r"$t$", r"$\overline{E}_q(t) / E$")
    axes = ("t", "average_energy_over_H")
    return Panel("fig3a", title, *labels, tuple(curves), axes, log_x=True)


def distance_claim(torus: Torus[FromSeries], Q: Floats) -> Claim:
    """Between the initial conditions, as a part of the largest coordinate.

    Q : of the FPU-trajectory.
    """
    mu = torus.chain.mu
    there = np.asarray(torus.Q(0.0), dtype=float)
    off = float(np.abs(there - Q).max() / np.abs(Q).max())
    ours = f"mu = {mu:.5f}; they begin {off:.2g} = {off / mu:.2g} mu "
    ours += "of the largest coordinate apart"
    text = "the initial distance of FPU-trajectory and torus is O(mu), mu about 4e-2"
    near = off <= MU_FACTOR * mu
    verdict = judged(rounds_to(mu, "0.04") and near, near)
    return Claim("4.1", text, "4e-2", ours, verdict)


def _growth_claims(own: GrowthExponents, early: GrowthExponents) -> tuple[Claim, ...]:
    first = [group for group in own.groups if group.order <= UNSATURATED_GROUPS]
    second = [group for group in early.groups if group.order <= UNSATURATED_GROUPS]
    return (alike_claim(second), exponents_claim(first, second), arrival_claim(first))


def alike_claim(groups: list[GroupGrowth]) -> Claim:
    """Modes of one group grow alike, and groups differ."""
    parts = []
    for g in groups:
        exponent = f"{g.mean:.2f} +- {g.spread:.2f}"
        parts.append(f"D_{g.order} = {runs(g.modes)}: {exponent}")
    apart = min(b.mean - a.mean for a, b in itertools.pairwise(groups))
    text = "during the first stage the modes of a group D_k = {ks+1 .. (k+1)s} "
    text += "grow by almost the same power of t"
    first, last = LINE_WINDOW
    ours = f"exponents between t = {first:g} and {last:g}, {'; '.join(parts)}"
    alike = all(g.spread <= GROUP_SPREAD for g in groups)
    differ = apart > 2 * GROUP_SPREAD
    return Claim("4.1", text, "", ours, judged(alike and differ, differ))


def exponents_claim(own: list[GroupGrowth], early: list[GroupGrowth]) -> Claim:
    """The paper's exponent is that of a line through two stages, each of which has another one."""
    stages = [g.mean / g.order for g in own]
    line = [g.mean / g.order for g in early]
    by_stage = ", ".join(f"{rate:.2f}" for rate in stages)
    by_order = ", ".join(f"{rate:.2f}" for rate in line)
    first, last = LINE_WINDOW
    ours = f"exponents for each order k = 1 .. {len(line)}: "
    ours += f"{by_order} of a line through t = {first:g} .. {last:g}, "
    ours += f"{by_stage} from pi/Omega_1 to a quarter of the last value. "
    ours += "Perturbation theory has two stages: t^(4k-2) before t = 1/Omega_q, "
    ours += "t^(2k) until one over the detuning"
    text = "the exponents are c_q(k) = (3/2) k + eps_q, |eps_q| << 1"
    read = [_as_in_the_paper(rate) for rate in line]
    holds = all(read) and all(_as_in_the_paper(rate) for rate in stages)
    return Claim("4.1", text, "3/2 k", ours, judged(holds, sum(read) > 1))


def _as_in_the_paper(rate: float) -> bool:
    return abs(rate - PAPER_EXPONENT) <= EXPONENT_TOLERANCE


def arrival_claim(groups: list[GroupGrowth]) -> Claim:
    """When the averages reach their last values, in the first group and in the others."""
    first, last = groups[0].saturation
    rest = [t for g in groups[1:] for t in g.saturation]
    latest = max(rest)
    ours = f"averages reach 0.9 of their last value at {first:.2g} .. {last:.2g} in D_1, "
    ours += f"{min(rest):.2g} .. {latest:.2g} in D_2 .. D_{len(groups)}"
    slow = LATE_TIME / POWER_OF_TEN < last < LATE_TIME * POWER_OF_TEN
    fast = SOON_TIME / POWER_OF_TEN < latest < SOON_TIME * POWER_OF_TEN
    text = "energy arrives within 1e3 in modes 5 to 8, within 1e2 in the others"
    return Claim("4.1", text, "1e3, 1e2", ours, judged(slow and fast, slow or fast))


def persistence_claim(times: Floats, shares: Floats) -> Claim:
    """Whether the averaged spectrum of the middle of the record is that of its end."""
    middle = int(np.searchsorted(times, times[-1] / 100))
    off = profile_distance(shares[middle], shares[-1], ENERGY_FLOOR)
    ours = f"from t = {times[middle]:.0e} to {times[-1]:.0e} the averages move "
    ours += f"by at most {off.distance:.2g} decades (mode {off.mode})"
    text = "at the end of the first stage the spectrum is stabilized to a form "
    text += "that persists for quite long times"
    verdict = judged(off.distance <= SAME_DECADES, off.distance <= SIMILAR_DECADES)
    return Claim("4.1", text, "", ours, verdict)


def seeds_claim(shares: Floats, row: PrintedTorus) -> Claim:
    """How far the averages of the seeds change."""
    seeds = shares[:, np.array(row.seeds) - 1]
    change = float(np.max(np.abs(seeds[1:] - seeds[0])))
    elsewhere = 1 - seeds[-1].sum()
    ours = f"largest change of a seed's average, over E: {change:.1e}; "
    ours += f"energy that reaches the other modes: {elsewhere:.1e}"
    text = "the averages of the seeds vary only by about 1e-4"
    low, high = SEED_CHANGES
    return Claim("4.1", text, "1e-4", ours, judged(low < change < high))
