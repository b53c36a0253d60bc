"""The laws of localization on trial.

Does a profile stay put as N grows, and does its slope follow log(energy)?
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.averages import LOOK
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
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.numbers.typed import Number, exact, integer, random_seed
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Table

Floats = NDArray[np.float64]
# times the expected rounding noise: what noise adds to log10 e is 0.04 there
ROUNDING_MARGIN = 10.0
LEAST_POINTS = 3  # of a trend with an error bar
PHASES = ("equal", "random")


@dataclass(frozen=True, eq=False)
class Trend(Tabled):
    """Rate of y with x by least squares, all points alike, and its standard error.

    Made by `slope_by_energy` and others. Ours.

    x, y : the points, (n,). rate : dy/dx, in units of y over x (dimensionless for the logarithms
        here). error : of it.

    >>> Trend(np.array([0.0, 1, 2]), np.array([0.0, 2.1, 3.9]), 1.95, 0.087)
    Trend(1.95 +- 0.087, 3 points)
    >>> Trend(np.array([0.0, 1, 2]), np.array([0.0, 2.1, 3.9]), 1.95, 0.087).to_frame()
         x    y
    0  0.0  0.0
    1  1.0  2.1
    2  2.0  3.9
    """

    x: Floats
    y: Floats
    rate: float
    error: float

    def __repr__(self) -> str:
        return f"Trend({self.rate:.4g} +- {self.error:.2g}, {len(self.x)} points)"

    def _table(self) -> Table:
        known = attributes(self, rate=self.rate, error=self.error)
        return Table({"x": self.x, "y": self.y}, known)


def _trend(x: ArrayLike, y: ArrayLike) -> Trend:
    x = DOUBLES.array(x)
    y = DOUBLES.array(y)
    dx = x - x.mean()
    dy = y - y.mean()
    square = dx @ dx
    rate = float(dx @ dy / square)
    left = dy - rate * dx
    variance = left @ left / (len(x) - 2)
    return Trend(x, y, rate, float(np.sqrt(variance / square)))


@public
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
    require_chain(chain)
    energies = np.array(
        [positive(energy, "specific_energies") for energy in specific_energies]
    )
    try:
        rows = DOUBLES.array(spectra)
    except (TypeError, ValueError) as error:
        raise InputError(
            "spectra",
            type(spectra).__name__,
            "numbers, (n, N-1)",
            "pass one row for each energy",
        ) from error
    different = len(set(energies.tolist()))
    if different < LEAST_POINTS or rows.shape != (len(energies), chain.N - 1):
        raise InputError(
            "spectra",
            rows.shape,
            f"one of {chain.N - 1} modes for each of three energies or more",
            "pass (n, N-1)",
        )
    if power is None:
        power = _power_of_the_law(chain)
    slopes = []
    for row in rows:
        fit = fit_profile(chain, row, s, modes=modes, power=power, floor=floor)
        slopes.append(fit.line.slope)
    return _trend(np.log10(energies), slopes)


def _power_of_the_law(chain: Chain) -> float:
    """Of kappa: Eqs. eksa2 and eksp2."""
    return 2.0 if chain.alpha else 0.0


@public
@dataclass(frozen=True, eq=False)
class ProfileInvariance(Tabled):
    """Profiles of packets of the same M and eps in chains of several lengths.

    They are those of section 6.1; dimensionless. Made by `profile_invariance`.
    fraction : M = s/N. specific_energy : eps. T : the time averaged over.
    phases : equal or random. chains : by size.
    spectra : by size, e_kappa of every realisation, (R, N-1). fits : of their mean, with the
        power of the law.
    floors : by size, (N-1,).

    >>> from symfpu import profile_invariance
    >>> profile_invariance(Chain(N=16, beta=1), "1/8", 1e-2, (16, 32, 48), 1e4)
    ProfileInvariance(N=16, 32, 48, M=1/8, eps=0.01, T=10000, equal phases,
    1 realisations: E_q/eps ~ N^c, c = D_1 1.73 +- 0.17,
    ...; d slope/d log10 N = Trend(... 3 points))
    >>> profile_invariance(Chain(N=16, beta=1), "1/8", 1e-2, (16, 32, 48), 1e2).to_frame().shape
    (93, 7)
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
        packets = f"N={sizes}, M={self.fraction}, eps={self.specific_energy:.6g}"
        phases = f"{self.phases} phases, {len(self.spectra[0])} realisations"
        rates = []
        for k, trend in self.growth.items():
            rates.append(f"D_{k} {trend.rate:.2f} +- {trend.error:.2g}")
        growth = f"E_q/eps ~ N^c, c = {', '.join(rates)}"
        slopes = f"d slope/d log10 N = {self.slope_rate}"
        return f"ProfileInvariance({packets}, T={self.T:.6g}, {phases}: {growth}; {slopes})"

    @property
    def _log_sizes(self) -> list[float]:
        return [math.log10(chain.N) for chain in self.chains]

    @property
    def slope_rate(self) -> Trend:
        """Of the fitted slopes with log10 N; 0 by the laws."""
        slopes = [fit.line.slope for fit in self.fits]
        return _trend(self._log_sizes, slopes)

    @property
    def _coarse(self) -> Chain:
        """The chain whose kappas all others have too."""
        sizes = [chain.N for chain in self.chains]
        return replace(self.chains[0], N=math.gcd(*sizes))

    def levels(self) -> tuple[Floats, Floats]:
        """Levels of the middle halves of D_1, D_2, ... and their standard errors; (sizes, groups).

        A level is log10 of E_q/eps, mean over the kappas that all sizes share; its error is over
        realisations. The laws are of middle modes; at the edges of a group small divisors take
        over. Only the same kappas compare like with like: within a group e_kappa falls by decades.
        nan where a mode is below the floor, or without a second realisation.
        """
        coarse = self._coarse
        middles = middle_halves(coarse, self.fraction)
        values, errors = np.full((2, len(self.chains), len(middles)), math.nan)
        by_size = zip(self.chains, self.spectra, self.floors, strict=True)
        for i, (chain, shares, floor) in enumerate(by_size):
            ratio = chain.N // coarse.N
            for k, middle in enumerate(middles):
                places = ratio * middle - 1
                values[i, k], errors[i, k] = _level(chain.N, shares, floor, places)
        return values, errors

    @property
    def growth(self) -> dict[int, Trend]:
        """By k, the exponent c of E_q/eps ~ N^c in the middle half of D_k; 0 by the laws."""
        values, _ = self.levels()
        trends = {}
        for k, column in enumerate(values.T, start=1):
            if np.isfinite(column).all():
                trends[k] = _trend(self._log_sizes, column)
        return trends

    @property
    def late_growth(self) -> dict[int, float]:
        """The same exponents between the two longest chains.

        Packets of few modes no longer weigh there.
        """
        values, _ = self.levels()
        shorter, longer = self.chains[-2:]
        rates = (values[-1] - values[-2]) / math.log10(longer.N / shorter.N)
        numbered = enumerate(rates.tolist(), start=1)
        return {k: rate for k, rate in numbered if math.isfinite(rate)}

    def moved(self, *, per_mode: bool = False) -> tuple[float, float]:
        """Largest change of log10 e_kappa between two sizes at a common kappa, and that kappa.

        Of the kappas beyond the packet.
        per_mode : of log10 E_q/eps = log10 (N e_kappa) instead, which the laws leave in place.
        """
        coarse = self._coarse.N
        worst = (0.0, math.nan)
        for q in range(1, coarse):
            if Fraction(q, coarse) <= self.fraction:
                continue
            logs = self._logs_at(q, coarse, per_mode)
            if logs:
                change = max(logs) - min(logs)
                worst = max(worst, (change, q / coarse))
        return worst

    def _logs_at(self, q: int, coarse: int, per_mode: bool) -> list[float]:
        """log10 e_kappa at kappa = q/coarse by size; none if one of them is below its floor."""
        logs = []
        for chain, spectra, floor in zip(
            self.chains, self.spectra, self.floors, strict=True
        ):
            place = chain.N // coarse * q - 1
            share = float(spectra[:, place].mean())
            if not share > floor[place]:
                return []
            unit = chain.N if per_mode else 1
            logs.append(math.log10(share * unit))
        return logs

    def _table(self) -> Table:
        """One row for each mode of each realisation of each size."""
        by_size = zip(self.chains, self.spectra, self.floors, self.fits, strict=True)
        parts = [_profile_columns(*one) for one in by_size]
        columns = {
            name: np.concatenate([part[name] for part in parts]) for name in parts[0]
        }
        known = attributes(
            self,
            chains=tuple(map(repr, self.chains)),
            fraction=self.fraction,
            specific_energy=self.specific_energy,
            T=self.T,
            phases=self.phases,
        )
        return Table(columns, known)


def _profile_columns(
    chain: Chain, shares: Floats, floor: Floats, fit: ProfileFit
) -> dict[str, NDArray[Any]]:
    """All realisations of one size below each other."""
    realisations, count = shares.shape
    modes = np.array(chain.mode_numbers)
    kappa = modes / chain.N
    columns = {
        "N": np.full(count, chain.N),
        "mode": modes,
        "kappa": kappa,
        "floor": floor,
        "log10_fit": fit.line(kappa),
    }
    below = {name: np.tile(values, realisations) for name, values in columns.items()}
    below["realisation"] = np.repeat(range(realisations), count)
    below["share"] = shares.reshape(-1)
    return below


def middle_halves(chain: Chain, fraction: Fraction) -> list[NDArray[np.int64]]:
    """The modes of the middle halves of D_1, D_2, ..., of those that are whole."""
    s = int(fraction * chain.N)
    width = s * chain.degree_step
    middles = []
    for group in packet_groups(chain, s)[1:]:
        if len(group) == width:
            middle = [
                q for place, q in enumerate(group, 1) if width < 4 * place <= 3 * width
            ]
            middles.append(np.array(middle))
    return middles


def _level(
    N: int, shares: Floats, floor: Floats, places: NDArray[np.int64]
) -> tuple[float, float]:
    """Mean of log10 E_q/eps over these places, and its standard error over realisations."""
    if not (shares.mean(axis=0)[places] > floor[places]).all():
        return math.nan, math.nan
    chosen = shares[:, places]
    level = float(np.log10(N * chosen.mean(axis=0)).mean())
    realisations = len(shares)
    if realisations == 1:
        return level, math.nan
    by_realisation = np.log10(chosen).mean(axis=1)
    error = by_realisation.std(ddof=1) / realisations**0.5
    return level, float(error)


@public
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
    look: float = LOOK,
    workers: int = 1,
) -> ProfileInvariance:
    """Does the profile stay put as N grows at fixed M and eps? By orbits of packets (Definition 4).

    chain : its couplings, alpha or beta. All is dimensionless.
    fraction : M, with M N whole for each of the sizes. specific_energy : eps = E/N.
    sizes : the N, three or more. Seeds 1 .. M N of equal harmonic energies, eps N together.
    T : the time averaged over.
    phases : equal, all 0; or random, uniform in 0 .. 2 pi radians.
    realisations : orbits of random phases, from numpy's default generator at (seed, N). seed : of
        it.
    scheme, step, look, workers : of `integrate`.

    Spectra are averaged over 0 .. T. Section 6.1 says of the normalised profiles that they stay
    as they are; e_kappa falls as 1/N. Modes within ROUNDING_MARGIN of `rounding_floor` count as
    below the floor. Raises InputError, OrbitStopped.

    >>> found = profile_invariance(Chain(N=16, beta=1), "1/8", 1e-2, (16, 32, 48), 1e4)
    >>> [spectra.shape for spectra in found.spectra]
    [(1, 15), (1, 31), (1, 47)]
    """
    require_chain(chain)
    M = exact(fraction, "fraction")
    sizes = [integer(N, "sizes", 2) for N in sizes]
    epsilon = positive(specific_energy, "specific_energy")
    _check_sizes(M, sizes)
    positive(T, "T")  # integrate would take a negative one
    if phases not in PHASES:
        raise InputError("phases", phases, ", ".join(PHASES), "choose one of them")
    if integer(realisations, "realisations", 1) > 1 and phases == "equal":
        raise InputError(
            "realisations", realisations, "1 with equal phases", "take random phases"
        )
    chains = tuple(replace(chain, N=N) for N in sorted(set(sizes)))
    how = {"scheme": scheme, "step": step, "look": look, "workers": workers}
    power = _power_of_the_law(chain)
    spectra, floors, fits = [], [], []
    for longer in chains:
        s = int(M * longer.N)
        generator = None
        if phases == "random":
            generator = np.random.default_rng((random_seed(seed), longer.N))
        E = _averaged(longer, s, epsilon, T, realisations, generator, **how)
        mean = E.mean(axis=0)
        floor = ROUNDING_MARGIN * rounding_floor(longer, mean, T, step=step, scheme=scheme)
        spectra.append(E / E.sum(axis=1, keepdims=True))
        floors.append(floor / mean.sum())
        fits.append(fit_profile(longer, mean, s, power=power, floor=floor))
    return ProfileInvariance(
        fraction=M,
        specific_energy=epsilon,
        T=float(T),
        phases=phases,
        chains=chains,
        spectra=tuple(spectra),
        floors=tuple(floors),
        fits=tuple(fits),
    )


def _check_sizes(M: Fraction, sizes: list[int]) -> None:
    """InputError unless every packet is whole, and the middles of groups have kappas in common."""
    packets = [M * N for N in sizes]
    whole = all(packet.denominator == 1 for packet in packets)
    if len(set(sizes)) < LEAST_POINTS or not 0 < M < 1 or not whole:
        raise InputError(
            "fraction, sizes",
            (str(M), sizes),
            "three sizes N or more with M N whole",
            "change one of them",
        )
    least = M * math.gcd(*sizes)
    if least < 2:
        raise InputError(
            "sizes",
            sizes,
            f"numbers N with a common divisor d so that M d is 2 or more (here {least})",
            "take sizes that share kappas in the middles of groups",
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
    """Mean E_q until T of so many trajectories; (count, N-1).

    how : keywords of `integrate`.
    """
    seeds = range(1, s + 1)
    amplitudes = packet_amplitudes(chain, seeds, epsilon * chain.N)
    states = []
    for _ in range(count):
        angles = {}
        if generator is not None:
            drawn = generator.uniform(0, 2 * math.pi, s).tolist()
            angles = dict(zip(seeds, drawn, strict=True))
        states.append(fpu_trajectory(chain, amplitudes, angles))
    Q, P = (np.array(part) for part in zip(*states, strict=True))
    averages = integrate(chain, Q, P, T, samples=1, averages=True, **how).averages
    assert averages is not None
    return np.asarray(averages[-1])
