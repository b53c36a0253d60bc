"""Pictures of the page on Toda: (a), (b) the pole, (c) to (e) tori, (f) to (i) orbits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from symfpu.figures.panels import Curve, Panel
from symfpu.paper.toda_fig1 import Fig1Study
from symfpu.paper.toda_orbits import FoldStudy, OrbitStudy, RecurrenceStudy, TrajectoryStudy
from symfpu.paper.toda_tori import TorusStudy, gap_energies, gaps_along

Floats = NDArray[np.float64]

CHAIN_LABELS = {
    "alpha": r"$\alpha$",
    "alpha and beta": r"$\alpha + \beta$, $\beta = 2\alpha^2/3$",
    "Toda": "Toda",
}
GROWTH_STYLES = {"alpha": "beads", "alpha and beta": "joined", "Toda": "crosses"}
SCAN_LIMITS = (-1e-5, 5e-5)  # of the coefficients near the pole
MICRO = 1e6  # of omega_2, on the axis
ANGLE_MODES = (1, 2, 3, 4, 6, 8, 11)  # gaps along one angle, Fig. 1
ORBIT_MODES = (1, 4, 5, 9)  # gaps along the orbit of Fig. 3
SPECTRUM_BOTTOM = {"Fig. 1": 1e-15, "Fig. 2": 1e-30}
LAST_GAP = {"Fig. 1": 15, "Fig. 2": 21}  # modes beyond have gaps of the size of rounding
SHARE_BOTTOM = 1e-25  # of time averages: below is rounding
DRIFT_BOTTOM, DRIFT_TOP = 1e-15, 1e3
FOLD_UNIT = 1e5  # of frequencies, on the axis


def fig1_panels(data: Fig1Study) -> tuple[Panel, Panel]:
    """(a) and (b): the pole of the series, and the resonance on the tori themselves."""
    return _growth_panel(data), _scan_panel(data)


def _growth_panel(data: Fig1Study) -> Panel:
    curves = []
    columns: dict[str, list[float]] = {}
    for name, study in data.series.items():
        orders = np.array(list(study.coefficients), dtype=float)
        sizes = np.abs(list(study.coefficients.values()))
        signs = "of one sign" if study.pole > 0 else "signs alternate"
        label = f"{CHAIN_LABELS[name]}: {signs}"
        style = GROWTH_STYLES[name]
        curves.append(Curve(label, orders, sizes, style, name=name))
        columns["k"] = orders.tolist()
        columns[name] = list(study.coefficients.values())
    return Panel(
        "toda-a",
        "Fig. 1: the series has a pole in every chain",
        r"order $k$",
        r"|coefficient of $\cos(5\theta_1 - 4\theta_2)$ in $Q_3$|",
        tuple(curves),
        ("k", "coefficient"),
        columns=columns,
    )


def _scan_panel(data: Fig1Study) -> Panel:
    """Coefficients against the distance from each chain's own resonance."""
    curves: list[Curve] = []
    for name, scan in data.scans.items():
        away = MICRO * (scan.frequencies - scan.resonance)
        for side, part in enumerate((away < 0, away > 0)):
            curve = Curve(
                CHAIN_LABELS[name] if side == 0 else "",
                away[part],
                scan.coefficients[part],
                "beads",
                group=len(curves) // 2,
                name=name,
            )
            curves.append(curve)
    bottom, top = SCAN_LIMITS
    line = Curve("resonance", np.zeros(2), np.array(SCAN_LIMITS), "law")
    curves.append(line)
    return Panel(
        "toda-b",
        "Fig. 1: at the resonance Toda's torus has no pole",
        r"$10^6\,(\omega_2 - \omega_2^*)$, $\omega_2^*$ the chain's own resonance",
        r"coefficient of $\cos(5\theta_1 - 4\theta_2)$ in $Q_3$",
        tuple(curves),
        ("omega_2_from_the_resonance_in_1e-6", "coefficient"),
        log_y=False,
        bottom=bottom,
        top=top,
        legend="upper left",
    )


def spectra_panel(name: str, study: TorusStudy) -> Panel:
    """Average spectra of the tori, and what of the alpha torus is not on a Toda torus."""
    modes = np.arange(1.0, study.alpha.chain.N)
    labels = {
        "alpha": (r"$\alpha$ torus", "points"),
        "Toda, same amplitudes": ("Toda torus, same amplitudes", "crosses"),
        "Toda, same frequencies": ("Toda torus, same frequencies", "rings"),
    }
    curves = []
    for key, (label, style) in labels.items():
        torus = study.tori()[key]
        shares = np.asarray(torus.average_spectrum() / torus.energy(), dtype=float)
        curves.append(Curve(label, modes, shares, style, name=key))
    energies = gap_energies(study.alpha, study.gaps["alpha"].max(axis=0))
    known = modes <= LAST_GAP[study.label]
    label = r"$\alpha$ torus: energy in Toda's gaps"
    gaps = Curve(label, modes[known], energies[known], "beads", name="gaps of alpha")
    return Panel(
        name,
        f"{study.label}: the tail is Toda's, the open gaps are FPU's",
        r"$q$",
        r"$\overline{E}_q/H$ and $N g_q^2/4a^2H$",
        (*curves, gaps),
        ("q", "share_of_H"),
        bottom=SPECTRUM_BOTTOM[study.label],
    )


def angle_panel(study: TorusStudy) -> Panel:
    """Gaps over one angle of the alpha torus; those of Toda's are constants, or rounding."""
    angles, gaps = gaps_along(study.alpha)
    curves = []
    for q in ANGLE_MODES:
        curve = Curve(f"$g_{{{q}}}$", angles / np.pi, gaps[:, q - 1], name=f"gap {q}")
        curves.append(curve)
    rounding = study.gaps["Toda, same amplitudes"][:, len(study.alpha.seeds) :]
    highest = np.full(2, float(rounding.max()))
    ends = np.array([0.0, 2.0])
    label = "largest closed gap\nof the Toda torus"
    curves.append(Curve(label, ends, highest, "law", name="rounding"))
    return Panel(
        "toda-e",
        r"Fig. 1: Toda's gaps over an angle of the $\alpha$ torus",
        r"$\theta_1/\pi$ at $\theta_2 = 0$",
        r"gap $g_q$",
        tuple(curves),
        ("theta_1_over_pi", "gap"),
    )


def orbit_panels(data: OrbitStudy) -> tuple[Panel, ...]:
    """(f) to (i): gaps along an orbit, averages, recurrences, breathers and their series."""
    return (
        _drift_panel(data.trajectories),
        _averages_panel(data.trajectories),
        _recurrence_panel(data.recurrences),
        _fold_panel(data.folds),
    )


def _drift_panel(trajectories: Mapping[str, TrajectoryStudy]) -> Panel:
    """How far gaps are from their first values, in units of these."""
    curves = []
    for name, style in (("alpha", "line"), ("Toda", "dotted")):
        study = trajectories[name]
        times = study.times[1:]
        for place, q in enumerate(ORBIT_MODES):
            gap = study.gaps[:, q - 1]
            off = np.abs(gap[1:] / gap[0] - 1)
            label = _drift_label(name, q)
            curve = Curve(label, times, off, style, group=place, name=f"gap {q}, {name}")
            curves.append(curve)
    return Panel(
        "toda-f",
        "Fig. 3: Toda's gaps along the FPU-trajectory",
        r"$t$",
        r"$|g_q(t)/g_q(0) - 1|$",
        tuple(curves),
        ("t", "relative_drift"),
        bottom=DRIFT_BOTTOM,
        top=DRIFT_TOP,
        legend="upper center",
        legend_columns=3,
    )


def _drift_label(name: str, q: int) -> str:
    """In the legend: every gap of alpha, and that dotted lines are Toda's."""
    if name == "alpha":
        return rf"$g_{{{q}}}$, $\alpha$ chain"
    return "the same,\nToda chain" if q == ORBIT_MODES[0] else ""


def _averages_panel(trajectories: Mapping[str, TrajectoryStudy]) -> Panel:
    curves = []
    for name, style in (("alpha", "points"), ("Toda", "crosses")):
        shares = trajectories[name].shares
        modes = np.arange(1.0, len(shares) + 1)
        known = shares > SHARE_BOTTOM
        curve = Curve(CHAIN_LABELS[name], modes[known], shares[known], style, name=name)
        curves.append(curve)
    return Panel(
        "toda-g",
        r"Fig. 3: averages of the FPU-trajectory to $t = 10^5$",
        r"$q$",
        r"$\overline{E}_q/E$",
        tuple(curves),
        ("q", "average_energy_over_E"),
    )


def _recurrence_panel(recurrences: Mapping[str, RecurrenceStudy]) -> Panel:
    curves = []
    for name, style in (("alpha", "line"), ("Toda", "law")):
        study = recurrences[name]
        few = slice(None, None, 100)
        label = CHAIN_LABELS[name]
        x, y = study.times[few], study.first_mode[few]
        curves.append(Curve(label, x, y, style, name=name))
    return Panel(
        "toda-h",
        "Fig. 9: the energy of mode 1 comes back alike",
        r"$t$",
        r"$E_1(t)/E(0)$",
        tuple(curves),
        ("t", "share_of_mode_1"),
        log_y=False,
        bottom=0.0,
        top=1.3,
        legend="upper center",
        legend_columns=2,
    )


def _fold_panel(folds: Mapping[str, FoldStudy]) -> Panel:
    """What the series reaches at its end, less the breather's frequency, both chains."""
    curves = []
    for name, study in folds.items():
        label = CHAIN_LABELS[name]
        off = FOLD_UNIT * (study.reached - study.frequencies)
        curves.append(Curve(label, study.amplitudes, off, "beads", name=name))
    amplitudes = next(iter(folds.values())).amplitudes
    zero = "the series just reaches its breather"
    curves.append(Curve(zero, amplitudes[[0, -1]], np.zeros(2), "law"))
    return Panel(
        "toda-i",
        "Fig. 9: the series of large breathers ends too early in both chains",
        r"$A_1$ of the breather",
        r"$10^5\,(\omega$ at the end of the series $-\ \omega_1)$",
        tuple(curves),
        ("A", "omega_at_the_end_less_omega_1_in_1e-5"),
        log_y=False,
    )
