"""The laws of section 6.1 on tori, by sums over all products of seeds: nothing is drawn.

At leading order E_q is exactly proportional to eps lambda^k (alpha) or eps lambda^2k (beta), so the
slope follows log lambda. What is computed is the factor, and how it goes with N.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symfpu.localization.laws import group_energy, middle_modes
from symfpu.localization.packet_sums import packet_energies
from symfpu.localization.trials import ProfileInvariance, middle_halves
from symfpu.paper.claims import Claim, judged
from symfpu.paper.printed import PrintedLine
from symfpu.results.text_tables import markdown_table

Floats = NDArray[np.float64]

# beyond the paper's chains; wide packets of beta take long
SIZES = {
    "alpha": (64, 128, 256, 512, 1024, 2048, 4096),
    "beta": (64, 128, 256, 512, 1024),
}
GROUPS = 3  # D_1, D_2, D_3
PAPER_SIZES = 4  # the first of them
# an exponent of N between the two longest chains that is on its way to 0
VANISHING, FALLING_SHARE = 0.05, 0.7


@dataclass(frozen=True)
class TorusLaw:
    """log10 E_q/eps of the middle halves of D_1, D_2, ... and factors of the middle modes.

    levels, factors : (sizes, groups). factors : E^(k) over (eps/M) lambda^k, or lambda^2k.
    """

    line: PrintedLine
    sizes: tuple[int, ...]
    levels: Floats
    factors: Floats

    @property
    def steps(self) -> Floats:
        """c of E_q/eps ~ N^c from each size to the next; (sizes - 1, groups)."""
        logs = np.log10(self.sizes)
        return np.asarray(np.diff(self.levels, axis=0) / np.diff(logs)[:, None])

    @property
    def exponents(self) -> Floats:
        """The same of a line through the paper's sizes; (groups,)."""
        logs = np.log10(self.sizes[:PAPER_SIZES])
        return np.asarray(np.polyfit(logs, self.levels[:PAPER_SIZES], 1)[0])

    @property
    def limits(self) -> Floats:
        """Of the factors as N grows, (groups,): steps that shrink go on as they do."""
        before, last = np.diff(self.factors, axis=0)[-2:]
        shrinks = np.abs(last) < np.abs(before)
        ratio = np.divide(last, before, out=np.zeros_like(last), where=shrinks)
        return np.asarray(self.factors[-1] + last * ratio / (1 - ratio))


def torus_law(line: PrintedLine) -> TorusLaw:
    """At the fraction M and eps of a panel of Fig. 4."""
    chain, eps = line.chains[0], line.specific_energy
    middles = middle_halves(chain, line.fraction)[:GROUPS]
    levels, factors = [], []
    for N in SIZES[chain.model]:
        longer = chain.at(N=N)
        s = line.seeds(longer)
        places = [(N // chain.N * middle).tolist() for middle in middles]
        energies = [packet_energies(longer, s, eps, modes) for modes in places]
        levels.append([float(np.log10(E / eps).mean()) for E in energies])
        middle = middle_modes(longer, s)[:GROUPS]
        by_law = group_energy(longer, s, eps, np.arange(1, GROUPS + 1))
        printed = [printed_factor(chain.model, k) for k in range(1, GROUPS + 1)]
        factors.append(packet_energies(longer, s, eps, middle) / by_law * printed)
    return TorusLaw(line, SIZES[chain.model], np.array(levels), np.array(factors))


def printed_factor(model: str, k: int) -> float:
    """Of Eqs. eksa and eksp."""
    return (k + 0.5) ** 2 if model == "alpha" else 1.0


def invariance_claim(law: TorusLaw, random: ProfileInvariance) -> Claim:
    """Whether E_q/eps keeps its value as N grows: on tori, with trajectories beside them.

    random : of random phases; they do not enter the verdict.
    """
    model = law.line.chains[0].model
    last = law.steps[-1]
    shrinking = np.abs(last) <= FALLING_SHARE * np.abs(law.steps[-2]) + VANISHING / 10
    vanishing = bool(np.all(np.abs(last) <= VANISHING) and np.all(shrinking))
    first, final = law.sizes[0], law.sizes[PAPER_SIZES - 1]
    ours = "leading order, summed over all products of seeds: E_q/eps ~ N^c, c = "
    ours += f"{_listed(law.exponents)} over N = {first} to {final}, {_listed(last)} from "
    ours += f"{law.sizes[-2]} to {law.sizes[-1]}: corrections of 1/s"
    moving = [f"D_{k}" for k, c in enumerate(last, 1) if abs(c) > VANISHING]
    ours += f", but {', '.join(moving)} moves yet. " if moving else ", 0 in the limit. "
    ours += (
        f"Trajectories with random phases: {_listed(_rates(random), draw_errors(random))}"
    )
    text = f"the law's dependence on N, {model} model: E_q/eps stays, on tori"
    section = "6.1.1" if model == "alpha" else "6.1.2"
    return Claim(
        section,
        text,
        "c = 0",
        ours,
        judged(vanishing, bool(np.any(np.abs(last) <= VANISHING))),
    )


def factor_claim(law: TorusLaw) -> Claim:
    """The factor of the middle modes against (k + 1/2)^2, or 1."""
    model = law.line.chains[0].model
    groups = range(1, GROUPS + 1)
    printed = [printed_factor(model, k) for k in groups]
    found = law.limits
    power = "lambda^k" if model == "alpha" else "lambda^2k"
    ours = f"C_k = {_listed(law.factors[0])} for N = {law.sizes[0]}, {_listed(law.factors[-1])} "
    ours += f"for N = {law.sizes[-1]}, about {_listed(found)} in the limit: no draws. "
    ours += "The powers of eps, M and lambda are exact, so the slope of middle modes is "
    ours += "log(lambda)/M but for log(C_(k+1)/C_k)"
    off = np.abs(np.log10(found / printed))
    equation = "eksa" if model == "alpha" else "eksp"
    text = f"Eq. {equation} on tori: the middle mode of D_k has C_k (eps/M) {power}"
    section = "6.1.1" if model == "alpha" else "6.1.2"
    shown = ", ".join(f"{value:g}" for value in printed)
    verdict = judged(bool(off.max() <= math.log10(2)), bool(off.max() <= 1))
    return Claim(section, text, f"C_k = {shown}", ours, verdict)


def _rates(found: ProfileInvariance) -> list[float]:
    return [trend.rate for trend in found.growth.values()]


def draw_errors(found: ProfileInvariance) -> list[float]:
    """Standard errors of the exponents, from the spread over realisations; by group."""
    values, errors = found.levels()
    x = np.log10([chain.N for chain in found.chains])
    weights = (x - x.mean()) / np.sum((x - x.mean()) ** 2)
    known = np.isfinite(values).all(axis=0)
    spread = np.sqrt(np.sum((weights[:, None] * errors[:, known]) ** 2, axis=0))
    return [float(error) for error in spread]


def _listed(values: Sequence[float] | Floats, errors: Sequence[float] | None = None) -> str:
    if errors is None:
        return ", ".join(f"{value:.3g}" for value in values)
    pairs = zip(values, errors, strict=True)
    return ", ".join(f"{value:.2f} +- {error:.2f}" for value, error in pairs)


def exponents_table(
    laws: Mapping[str, TorusLaw],
    equal: Mapping[str, ProfileInvariance],
    random: Mapping[str, ProfileInvariance],
) -> str:
    """One table of all exponents c of E_q/eps ~ N^c; by model."""
    rows = []
    for model, law in laws.items():
        spread = draw_errors(random[model])
        for k in range(GROUPS):
            draws = random[model].growth.get(k + 1)
            phased = equal[model].growth.get(k + 1)
            row = [
                model,
                f"D_{k + 1}",
                f"{law.exponents[k]:.3f}",
                f"{law.steps[-1][k]:.3f}",
            ]
            row.append(f"{draws.rate:.2f} +- {spread[k]:.2f}" if draws else "-")
            row.append(f"{phased.rate:.2f}" if phased else "-")
            rows.append(row)
    count = len(next(iter(random.values())).spectra[0])
    head = ["model", "group", "tori, the paper's N", "tori, the two longest chains"]
    head += [f"random phases, {count} draws", "phases 0"]
    return markdown_table(head, rows)


def factors_table(laws: Mapping[str, TorusLaw]) -> str:
    """C_k by N."""
    rows = []
    for model, law in laws.items():
        for k in range(GROUPS):
            shown = [f"{value:.4g}" for value in law.factors[:, k]]
            shown += [""] * (max(map(len, SIZES.values())) - len(shown))
            rows.append([model, f"C_{k + 1}", f"{printed_factor(model, k + 1):g}", *shown])
    longest = max(SIZES.values(), key=len)
    return markdown_table(
        ["model", "factor", "printed", *(f"N = {N}" for N in longest)], rows
    )
