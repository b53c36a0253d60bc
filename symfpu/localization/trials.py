"""The laws of localization on trial: does a profile stay put as N grows, and does its slope
follow log(energy)?
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain
from symfpu.dynamics.orbits import integrate
from symfpu.errors import InputError
from symfpu.localization.laws import (
    FLOOR,
    ProfileFit,
    fit_profile,
    packet_groups,
    positive,
    rounding_floor,
)
from symfpu.localization.profiles import fpu_trajectory, packet_amplitudes
from symfpu.numbers.typed import Number, exact, integer

Floats = NDArray[np.float64]
# times the expected rounding noise: what noise adds to log10 e is 0.04 there
ABOVE_ROUNDING = 10.0
POINTS = 3  # of a trend with an error bar
PHASES = ("equal", "random")


@dataclass(frozen=True, eq=False)
class Trend:
    """Rate of y with x by least squares, all points alike, and its standard error.

    Made by `slope_by_energy` and others. Ours.

    x, y : the points, (n,). rate : dy/dx, in units of y over x (dimensionless for the logarithms here).
        error : of it.

    >>> Trend(np.array([0.0, 1, 2]), np.array([0.0, 2.1, 3.9]), 1.95, 0.087)
    Trend(1.95 +- 0.087, 3 points)
    """

    x: Floats
    y: Floats
    rate: float
    error: float

    def __repr__(self) -> str:
        return f"Trend({self.rate:.4g} +- {self.error:.2g}, {len(self.x)} points)"


def _trend(x: ArrayLike, y: ArrayLike) -> Trend:
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    dx, dy = x - x.mean(), y - y.mean()
    rate = float(dx @ dy / (dx @ dx))
    left = dy - rate * dx
    return Trend(x, y, rate, float(np.sqrt(left @ left / (len(x) - 2) / (dx @ dx))))


def slope_by_energy(
    chain: Chain,
    s: int,
    specific_energies: Sequence[float],
    spectra: ArrayLike,
    *,
    modes: str | Sequence[int] = "tail",
    power: float | None = None,
    floor: float | ArrayLike = FLOOR,
) -> Trend:
    """Rate of the fitted slope with log10 eps, as a Trend; Eqs. eksa2 and eksp2 say 1/M = N/s.

    chain : the model. s : how many seeds, 1 .. N-1; all is dimensionless.
    specific_energies : eps = E/N, (n,), three or more.
    spectra : (n, N-1), of trajectories or tori with the seeds 1 .. s.
    modes, floor : as for `fit_profile`; one floor for all.
    power : of kappa; default the law's own, 2 (alpha) or 0 (beta).

    Ours. Raises InputError.

    >>> from symfpu.localization.laws import profile_law
    >>> chain, energies = Chain(N=32, beta=1), (1e-5, 1e-4, 1e-3)
    >>> kappa = np.arange(1, 32) / 32
    >>> spectra = [10 ** profile_law(chain, 4, e)(kappa) for e in energies]
    >>> round(slope_by_energy(chain, 4, energies, spectra, floor=0).rate, 9)
    8.0
    """
    energies = np.array([positive(energy, "specific_energies") for energy in specific_energies])
    try:
        rows = np.asarray(spectra, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(
            "spectra", type(spectra).__name__, "numbers, (n, N-1)", "pass one row for each energy"
        ) from error
    if (
        len(energies) < POINTS
        or rows.shape != (len(energies), chain.N - 1)
        or len(set(energies.tolist())) < POINTS
    ):
        raise InputError(
            "spectra",
            rows.shape,
            f"one of {chain.N - 1} modes for each of three energies or more",
            "pass (n, N-1)",
        )
    power = (2.0 if chain.alpha else 0.0) if power is None else power
    fits = [fit_profile(chain, row, s, modes=modes, power=power, floor=floor) for row in rows]
    return _trend(np.log10(energies), [fit.line.slope for fit in fits])


@dataclass(frozen=True, eq=False)
class ProfileInvariance:
    """Profiles of packets of the same M and eps in chains of several lengths (section 6.1); dimensionless.

    Made by `profile_invariance`. fraction : M = s/N. specific_energy : eps. T : the time averaged over.
    phases : equal or random. chains : by size.
    spectra : by size, e_kappa of every realisation, (R, N-1). fits : of their mean, with the power of the
        law.
    floors : by size, (N-1,).

    >>> from symfpu import profile_invariance
    >>> profile_invariance(Chain(N=16, beta=1), "1/8", 1e-2, (16, 32, 48), 1e4)
    ProfileInvariance(N=16, 32, 48, M=1/8, eps=0.01, T=10000, equal phases, 1 realisations: E_q/eps ~ N^c,
    c = D_1 1.73 +- 0.17, ...; d slope/d log10 N = Trend(... 3 points))
    """

    fraction: Fraction
    specific_energy: float
    T: float
    phases: str
    chains: tuple[Chain, ...] = field(repr=False)
    spectra: tuple[Floats, ...] = field(repr=False)
    floors: tuple[Floats, ...] = field(repr=False)
    fits: tuple[ProfileFit, ...] = field(repr=False)

    def __repr__(self) -> str:
        sizes = ", ".join(str(chain.N) for chain in self.chains)
        growth = ", ".join(
            f"D_{k} {trend.rate:.2f} +- {trend.error:.2g}" for k, trend in self.growth.items()
        )
        return (
            f"ProfileInvariance(N={sizes}, M={self.fraction}, eps={self.specific_energy:.6g}, T={self.T:.6g}, {self.phases} phases, "
            f"{len(self.spectra[0])} realisations: E_q/eps ~ N^c, c = {growth}; d slope/d log10 N = {self.slope_rate})"
        )

    @property
    def slope_rate(self) -> Trend:
        """Of the fitted slopes with log10 N; 0 by the laws."""
        return _trend(
            [math.log10(chain.N) for chain in self.chains], [fit.line.slope for fit in self.fits]
        )

    @property
    def _coarse(self) -> Chain:
        """The chain whose kappas all others have too."""
        return replace(self.chains[0], N=math.gcd(*(chain.N for chain in self.chains)))

    def levels(self) -> tuple[Floats, Floats]:
        """log10 of E_q/eps in the middle halves of D_1, D_2, ..., mean over the kappas that all
        sizes share, and its standard error over realisations; (sizes, groups).

        The laws are of middle modes; at the edges of a group small divisors take over. Only the
        same kappas compare like with like: within a group e_kappa falls by decades. nan where a
        mode is below the floor, or without a second realisation.
        """
        coarse = self._coarse
        s = int(self.fraction * coarse.N)
        width = s * coarse.degree_step
        groups = [group for group in packet_groups(coarse, s)[1:] if len(group) == width]
        values, errors = np.full((2, len(self.chains), len(groups)), math.nan)
        for i, (chain, e, floor) in enumerate(
            zip(self.chains, self.spectra, self.floors, strict=True)
        ):
            for k, group in enumerate(groups):
                middle = [q for q in group if width < 4 * (q - group.start + 1) <= 3 * width]
                places = chain.N // coarse.N * np.array(middle) - 1
                if (e.mean(axis=0)[places] > floor[places]).all():
                    values[i, k] = np.log10(chain.N * e[:, places].mean(axis=0)).mean()
                    if len(e) > 1:
                        errors[i, k] = (
                            np.log10(e[:, places]).mean(axis=1).std(ddof=1) / len(e) ** 0.5
                        )
        return values, errors

    @property
    def growth(self) -> dict[int, Trend]:
        """By k, the exponent c of E_q/eps ~ N^c in the middle half of D_k; 0 by the laws."""
        sizes = [math.log10(chain.N) for chain in self.chains]
        return {
            k + 1: _trend(sizes, column)
            for k, column in enumerate(self.levels()[0].T)
            if np.isfinite(column).all()
        }

    @property
    def late_growth(self) -> dict[int, float]:
        """The same exponents between the two longest chains, where packets of few modes no longer
        weigh.
        """
        first, second = self.levels()[0][-2:]
        rates = (second - first) / math.log10(self.chains[-1].N / self.chains[-2].N)
        return {k + 1: float(rate) for k, rate in enumerate(rates) if math.isfinite(rate)}

    def moved(self, *, per_mode: bool = False) -> tuple[float, float]:
        """Largest change of log10 e_kappa between two sizes at a common kappa beyond the packet, and that kappa.

        per_mode : of log10 E_q/eps = log10 (N e_kappa) instead, which the laws leave in place.
        """
        coarse = self._coarse.N
        worst = (0.0, math.nan)
        for q in (q for q in range(1, coarse) if Fraction(q, coarse) > self.fraction):
            places = [chain.N // coarse * q - 1 for chain in self.chains]
            e = [float(rows[:, i].mean()) for rows, i in zip(self.spectra, places, strict=True)]
            if all(
                value > floor[i] for value, floor, i in zip(e, self.floors, places, strict=True)
            ):
                logs = [
                    math.log10(value * (chain.N if per_mode else 1))
                    for value, chain in zip(e, self.chains, strict=True)
                ]
                worst = max(worst, (max(logs) - min(logs), q / coarse))
        return worst


def profile_invariance(
    chain: Chain,
    fraction: Number,
    specific_energy: float,
    sizes: Sequence[int],
    T: float,
    *,
    phases: str = "equal",
    realisations: int = 1,
    seed: int = 0,
    scheme: str = "kahan_li8",
    step: float = 0.5,
    workers: int = 1,
) -> ProfileInvariance:
    """Does the profile stay put as N grows at fixed M and eps? By orbits of packets (Definition 4).

    chain : its couplings, alpha or beta. All is dimensionless.
    fraction : M, with M N whole for each of the sizes. specific_energy : eps = E/N.
    sizes : the N, three or more. Seeds 1 .. M N of equal harmonic energies, eps N together.
    T : the time averaged over.
    phases : equal, all 0; or random, uniform in 0 .. 2 pi radians.
    realisations : orbits of random phases, from numpy's default generator at (seed, N). seed : of it.
    scheme, step, workers : of `integrate`.

    Spectra are averaged over 0 .. T. Section 6.1 says of the normalised profiles that they stay as they are;
    e_kappa falls as 1/N. Modes within ABOVE_ROUNDING of `rounding_floor` count as below the floor. Raises
    InputError, OrbitStopped.

    >>> found = profile_invariance(Chain(N=16, beta=1), "1/8", 1e-2, (16, 32, 48), 1e4)
    >>> [spectra.shape for spectra in found.spectra]
    [(1, 15), (1, 31), (1, 47)]
    """
    M, sizes, epsilon = (
        exact(fraction, "fraction"),
        [integer(N, "sizes", 2) for N in sizes],
        positive(specific_energy, "specific_energy"),
    )
    if len(set(sizes)) < POINTS or not 0 < M < 1 or any((M * N).denominator != 1 for N in sizes):
        raise InputError(
            "fraction, sizes",
            (str(M), sizes),
            "three sizes N or more with M N whole",
            "change one of them",
        )
    if M * math.gcd(*sizes) < 2:
        expected = f"numbers N with a common divisor d so that M d is 2 or more (here {M * math.gcd(*sizes)})"
        raise InputError(
            "sizes", sizes, expected, "take sizes that share kappas in the middles of groups"
        )
    positive(T, "T")  # integrate would take a negative one
    if phases not in PHASES:
        raise InputError("phases", phases, ", ".join(PHASES), "choose one of them")
    if integer(realisations, "realisations", 1) > 1 and phases == "equal":
        raise InputError("realisations", realisations, "1 with equal phases", "take random phases")
    chains = tuple(replace(chain, N=N) for N in sorted(set(sizes)))
    spectra, floors, fits = [], [], []
    for longer in chains:
        s = int(M * longer.N)
        generator = (
            np.random.default_rng((integer(seed, "seed", 0), longer.N))
            if phases == "random"
            else None
        )
        E = _averaged(
            longer,
            s,
            epsilon,
            T,
            realisations,
            generator,
            scheme=scheme,
            step=step,
            workers=workers,
        )
        floor = ABOVE_ROUNDING * rounding_floor(longer, E.mean(axis=0), T, step=step, scheme=scheme)
        spectra.append(E / E.sum(axis=1, keepdims=True))
        floors.append(floor / E.mean(axis=0).sum())
        fits.append(
            fit_profile(longer, E.mean(axis=0), s, power=2.0 if chain.alpha else 0.0, floor=floor)
        )
    return ProfileInvariance(
        M, epsilon, float(T), phases, chains, tuple(spectra), tuple(floors), tuple(fits)
    )


def _averaged(
    chain: Chain,
    s: int,
    epsilon: float,
    T: float,
    count: int,
    generator: np.random.Generator | None,
    **how: Any,
) -> Floats:
    """Mean E_q until T of so many trajectories, integrated with the keywords `how`.

    (count, N-1).
    """
    seeds = range(1, s + 1)
    amplitudes = packet_amplitudes(chain, seeds, epsilon * chain.N)
    states = []
    for _ in range(count):
        angles = (
            {}
            if generator is None
            else dict(zip(seeds, generator.uniform(0, 2 * math.pi, s).tolist(), strict=True))
        )
        states.append(fpu_trajectory(chain, amplitudes, angles))
    Q, P = (np.array(part) for part in zip(*states, strict=True))
    averages = integrate(chain, Q, P, T, samples=1, averages=True, **how).averages
    assert averages is not None
    return np.asarray(averages[-1])
