"""How the energy of low-frequency packets falls off along the spectrum.

The paper's laws, those of section 6.1 and, for their derivation, Appendix E; and lines fitted to
profiles.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.schemes import SCHEMES
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.numbers.typed import integer, seed_modes
from symfpu.results.attributes import attributes
from symfpu.results.field import Field
from symfpu.results.numbers import fifteen_digits
from symfpu.results.result import Result, Tabled
from symfpu.results.table import Columns, Table

Floats = NDArray[np.float64]

# of the largest energy: ten times the rounding of an orbit on T + V with N = 512 to T = 1e6
# (docs/localization.md)
FLOOR = 1e-22
# mean square of one rounding, relative: EPS^2/12 times the mean of 1/m^2 over mantissas m
LAST_BIT = 0.045 * 2.0**-104
FLOOR_ADVICE = "pass spectrum_floor(solution) for spectra in closed form"
LEAST_GROUPS = 2  # of modes, for a line with an error bar


@dataclass(frozen=True)
class ProfileLine(Result):
    """log10 e_kappa = slope * kappa + intercept + power * log10 kappa, with kappa = q/N.

    Call it with kappa, a number or an array, for log10 e_kappa in its shape.

    slope : in decades for a unit of kappa. intercept : log10 e_kappa at kappa = 0. power : 2 in
        Eq. eksa2, 0 in Eq. eksp2. kappa and e_kappa, a share of the whole energy, are
        dimensionless.

    >>> line = ProfileLine(-78.6, -1.2)
    >>> line, line([0.25, 0.5]).round(6)
    (log10 e = -78.6 kappa - 1.2, array([-20.85, -40.5 ]))
    """

    slope: float
    intercept: float
    power: float = 0.0

    def __call__(self, kappa: ArrayLike) -> Floats:
        kappa = DOUBLES.array(kappa)
        bend = self.power * np.log10(kappa) if self.power else 0.0
        return np.asarray(self.slope * kappa + self.intercept + bend)

    def _fields(self) -> Iterator[Field]:
        yield from (Field(name, fifteen_digits(x)) for name, x in vars(self).items())

    def __repr__(self) -> str:
        intercept = _signed(self.intercept)
        power = f" {_signed(self.power)} log10 kappa" if self.power else ""
        return f"log10 e = {self.slope:.6g} kappa {intercept}{power}"


def _signed(value: float) -> str:
    """As a term of a sum."""
    sign = "-" if value < 0 else "+"
    return f"{sign} {abs(value):.6g}"


@public
def packet_parameter(chain: Chain, s: int, specific_energy: float) -> float:
    """lambda of seeds 1 .. s: alpha^2 eps / (pi M)^4 or beta eps / (pi M)^2.

    It stands below Eqs. eksa2 and eksp2.

    chain : one coupling. s : how many seeds, 1 .. N-1. specific_energy : eps = E/N; M = s/N. All
        dimensionless.

    The laws are for lambda well below 1. Raises InputError, also for a chain with both couplings.

    >>> round(packet_parameter(Chain(N=256, beta="0.3"), 16, 1.5625e-6), 9)
    1.2159e-05
    """
    require_chain(chain)
    s, epsilon = _packet(chain, s, specific_energy)
    width = math.pi * s / chain.N
    if chain.alpha:
        return float(chain.alpha) ** 2 * epsilon / width**4
    return abs(float(chain.beta)) * epsilon / width**2


@public
def group_energy(chain: Chain, s: int, specific_energy: float, k: ArrayLike) -> Floats:
    """E^(k), the energy of the middle mode of D_k for seeds 1 .. s.

    Eqs. eksa (alpha) and eksp (beta).

    chain : one coupling. s : how many seeds, 1 .. N-1. specific_energy : eps = E/N. k : 0, 1,
        ..., a number or an array (n,). All dimensionless; returns energies of the shape of k.

    Estimates of magnitude. At k = 0 a seed has eps/M, which Eq. eksa gives a quarter of.
    Raises InputError, also for a chain with both couplings.

    >>> group_energy(Chain(N=256, beta="0.3"), 16, 1.5625e-6, [0, 1])
    array([2.50000000e-05, 3.69575361e-15])
    """
    require_chain(chain)
    parameter = packet_parameter(chain, s, specific_energy)
    M = s / chain.N
    k = DOUBLES.array(k)
    if not (k >= 0).all():
        raise InputError("k", k.tolist(), "0 or more", "a group has an order")
    front = specific_energy / M
    with np.errstate(over="ignore", invalid="ignore"):
        powers = parameter**k if chain.alpha else parameter ** (2 * k)
        energies = np.asarray(front * powers * ((k + 0.5) ** 2 if chain.alpha else 1))
    if not np.isfinite(energies).all():
        allowed = f"orders whose energies are doubles (lambda = {parameter:.3g})"
        raise InputError("k", k.tolist(), allowed, "take lower ones")
    return energies


@public
def profile_law(
    chain: Chain, s: int, specific_energy: float, *, denominator: int | None = None
) -> ProfileLine:
    """log10 e_kappa of seeds 1 .. s, Eqs. eksa2 (alpha) and eksp2 (beta) as a ProfileLine.

    chain : one coupling. s : how many seeds, 1 .. N-1. specific_energy : eps = E/N; all
        dimensionless.
    denominator : of kappa = q/denominator, default N; the line of Fig. 4(a) has N-1.

    It is `group_energy` over E = N eps, at k + 1/2, or 2k, = kappa/M. The slope depends on M and
    eps alone, the intercept on N too: e_kappa is a share of the whole energy, and falls as 1/N.
    Raises InputError, also for a chain with both couplings.

    >>> profile_law(Chain(N=256, beta="0.3"), 16, 1.5625e-6)  # Fig. 4(b)
    log10 e = -78.6419 kappa - 1.20412
    """
    require_chain(chain)
    parameter = packet_parameter(chain, s, specific_energy)
    unit = chain.N if denominator is None else integer(denominator, "denominator", 1)
    inverse_width = unit / s
    slope = math.log10(parameter) * inverse_width
    if not chain.alpha:
        return ProfileLine(slope, -math.log10(s))
    intercept = math.log10(inverse_width**2 / (parameter**0.5 * s))
    return ProfileLine(slope, intercept, 2.0)


@public
def breather_law(chain: Chain, energy: float, seed_energy: float | None = None) -> Floats:
    """E_q of the breather with seed 1, alpha model, Eq. brelaw: gamma^(q-1) q^2 E_1; shape (N-1,).

    chain : the alpha model. energy : E; gamma = alpha^2 N^4 eps / pi^4 with eps = energy/N.
    seed_energy : E_1, default the energy. All dimensionless.

    Raises InputError, also where gamma is 1 or more, and for a chain with beta, for which the law
    is not stated.

    >>> breather_law(Chain(N=4, alpha="0.33"), 0.01).round(9)
    array([1.000e-02, 2.862e-05, 4.600e-08])
    """
    require_chain(chain)
    if chain.model != "alpha":
        raise InputError(
            "chain", chain, "the alpha model", "the law is stated for it alone"
        )
    specific_energy = positive(energy, "energy") / chain.N
    gamma = packet_parameter(chain, 1, specific_energy)
    if gamma >= 1:
        allowed = (
            f"one with gamma < 1 (gamma = {gamma:.3g}): the series is of powers of gamma"
        )
        raise InputError("energy", energy, allowed, "take a smaller energy")
    first = energy if seed_energy is None else positive(seed_energy, "seed_energy")
    q = np.arange(1, chain.N)
    return np.asarray(gamma ** (q - 1.0) * q**2 * first)


@public
def least_packet(chain: Chain, specific_energy: float) -> float:
    """The width s at which lambda = 1: alpha^(1/2) eps^(1/4) N / pi, or (beta eps)^(1/2) N / pi.

    chain : one coupling. specific_energy : eps = E/N. Both and the width, a number of modes, are
        dimensionless.

    lambda is that of Eqs. eksa2 and eksp2. Section 6.1 leaves out the 1/pi.
    Raises InputError, also for a chain with both couplings.

    >>> round(least_packet(Chain(N=32, alpha="0.33"), 1e-4), 6)
    0.585136
    """
    require_chain(chain)
    parameter = packet_parameter(chain, 1, specific_energy)
    return float(parameter ** (0.25 if chain.alpha else 0.5))


@public
def natural_packet(chain: Chain, specific_energy: float, exponent: str = "1/4") -> float:
    """Width of the natural packet of the alpha model: (alpha^2 eps)^(1/4) N, or with 1/5.

    It is that of section 6.4.3.

    chain : the alpha model. specific_energy : eps = E/N. Both and the width, a number of modes, are
        dimensionless.
    exponent : of eps, '1/4' or '1/5'.

    Raises InputError, also for a chain with beta.

    >>> round(natural_packet(Chain(N=32, alpha="0.33"), 1e-4), 6)
    1.83826
    """
    require_chain(chain)
    if chain.model != "alpha" or exponent not in ("1/4", "1/5"):
        raise InputError(
            "chain, exponent",
            (chain, exponent),
            "the alpha model, '1/4' or '1/5'",
            "the widths are stated for these",
        )
    alpha = float(chain.alpha)
    epsilon = positive(specific_energy, "specific_energy")
    fraction = (alpha**2 * epsilon) ** float(Fraction(exponent))
    return float(chain.N * fraction)


@public
def packet_groups(chain: Chain, s: int) -> tuple[range, ...]:
    """D_0, D_1, ... of seeds 1 .. s: {ks+1 .. (k+1)s} (alpha), {(2k-1)s+1 .. (2k+1)s} (beta).

    chain : of any potential; where it is even it counts as beta, else as alpha.
    s : how many seeds, 1 .. N-1. All are dimensionless integers.

    Eq. dk for the packets of section 6.1, as ranges of modes, the last one cut at N-1. Raises
    InputError for s outside 1 .. N-1.

    >>> packet_groups(Chain(N=8, alpha=1), 2)
    (range(1, 3), range(3, 5), range(5, 7), range(7, 8))
    """
    require_chain(chain)
    step = packet_width(chain, s) * chain.degree_step
    ends = [0, *range(s, chain.N - 1, step), chain.N - 1]
    return tuple(range(a + 1, b + 1) for a, b in pairwise(ends))


@public
def middle_modes(chain: Chain, s: int) -> tuple[int, ...]:
    """The middle modes of D_1, D_2, ... of seeds 1 .. s: ks + [s/2] (alpha), 2ks (beta), below N.

    chain : of any potential; where it is even it counts as beta, else as alpha.
    s : how many seeds, 1 .. N-1. All are dimensionless integers.

    Differs from section 6.1.1 for s = 1: k + 1, where the paper's formula leaves D_k. Raises
    InputError for s outside 1 .. N-1.

    >>> middle_modes(Chain(N=12, alpha=1), 3)
    (4, 7, 10)
    """
    require_chain(chain)
    step = packet_width(chain, s) * chain.degree_step
    offset = 0 if chain.potential.even else (s // 2 or 1)
    return tuple(range(step + offset, chain.N, step))


@public
def rounding_floor(
    chain: Chain, spectrum: ArrayLike, T: float, *, step: float, scheme: str = "kahan_li8"
) -> Floats:
    """Energy that rounding is expected to put into the average of every mode until T; (N-1,).

    chain : the model. spectrum : mean E_q of the orbit, (N-1,). T : the time, step : of the
        integrator; all dimensionless.
    scheme : of SCHEMES, as for `integrate`.

    On T + V every drift and kick rounds each x_j and p_j once, at random, with the mean square
    EPS^2/12 over the square of the mantissa: white in modes, so that E_q grows by (EPS^2/12)
    <1/m^2> (Omega_q^2 <x^2> + <p^2>)/2 a stage. The average has half of the last. Zero for
    aba864_modes, whose modes do not share their rounding. Ours. Raises InputError.

    >>> float(rounding_floor(Chain(N=4, alpha=1), [1.0, 0, 0], 1e6, step=0.1).max()) < 1e-20
    True
    """
    require_chain(chain)
    E = _spectrum(chain, spectrum)
    T = positive(T, "T")
    step = positive(step, "step")
    if scheme not in SCHEMES:
        raise InputError("scheme", scheme, ", ".join(SCHEMES), "choose one of them")
    if SCHEMES[scheme].in_modes:
        return np.zeros(chain.N - 1)
    squared = chain.frequencies() ** 2
    positions = np.sum(E / squared) / (chain.N - 1)
    momenta = np.sum(E) / (chain.N - 1)
    stages = SCHEMES[scheme].stages
    roundings = 0.25 * LAST_BIT * stages * T / step
    return np.asarray(roundings * (squared * positions + momenta))


@dataclass(frozen=True, eq=False)
class ProfileFit(Tabled):
    """A line through a profile. Made by `fit_profile`; kappa and e_kappa are dimensionless.

    line : a ProfileLine, the form of Eqs. eksa2 and eksp2. errors : standard errors of slope,
        intercept and power (0 if fixed). scatter : rms residual, in decades, over the degrees of
        freedom.
    modes, residuals : those used, and log10 e_kappa minus the line, in decades; (n,).

    >>> q = np.arange(1, 32)
    >>> fit_profile(Chain(N=32, beta=1), 10.0 ** (-20 * q / 32 + 0.1 * np.sin(q)), 2, floor=0)
    ProfileFit(log10 e = (-20.005 +- 0.067) kappa + (0.42305 +- 0.047), 29 modes 3..31,
    scatter 0.072)
    >>> fit = fit_profile(Chain(N=32, beta=1), 10.0 ** (-20 * q / 32 + 0.1 * np.sin(q)), 2, floor=0)
    >>> fit.to_frame().shape, round(fit.to_frame().attrs["slope"], 3)
    ((29, 2), -20.005)
    """

    line: ProfileLine
    errors: tuple[float, float, float]
    scatter: float
    modes: tuple[int, ...] = field(repr=False)
    residuals: Floats = field(repr=False)

    def __repr__(self) -> str:
        line = self.line
        slope_error, intercept_error, power_error = self.errors
        slope = f"({line.slope:.5g} +- {slope_error:.2g})"
        intercept = f"({line.intercept:.5g} +- {intercept_error:.2g})"
        power = f" + {line.power:g} log10 kappa" if line.power else ""
        if power_error:
            power = f", power {line.power:.4g} +- {power_error:.2g}"
        modes = f"{len(self.modes)} modes {self.modes[0]}..{self.modes[-1]}"
        fitted = f"log10 e = {slope} kappa + {intercept}{power}"
        return f"ProfileFit({fitted}, {modes}, scatter {self.scatter:.2g})"

    def _table(self) -> Table:
        names = ("slope", "intercept", "power")
        line = {name: getattr(self.line, name) for name in names}
        errors = zip(names, self.errors, strict=True)
        known = line | {f"{name}_error": error for name, error in errors}
        columns: Columns = {"mode": self.modes, "residual": self.residuals}
        return Table(columns, attributes(self, scatter=self.scatter, **known))


@public
def fit_profile(
    chain: Chain,
    spectrum: ArrayLike,
    s: int,
    *,
    modes: str | Sequence[int] = "tail",
    power: float | None = 0.0,
    floor: float | ArrayLike = FLOOR,
) -> ProfileFit:
    """Regression of log10 e_kappa on kappa beyond the seeds 1 .. s.

    e_kappa is the spectrum over its sum.

    chain : the model. spectrum : E_q in any unit, (N-1,). s : how many seeds, 1 .. N-1.
    modes : tail, all q > s; middle, those of `middle_modes`; or a list.
    power : of kappa, a dimensionless number, or None for a fitted one: 2 in Eq. eksa2, 0 in
        Eq. eksp2.
    floor : modes at or below it are left out; a number, relative to the largest E_q, or energies
        (N-1,) in the unit of the spectrum: `rounding_floor` of an orbit, `spectrum_floor` of a
        torus or breather. 0 fits rounding too.

    All modes count alike. Errors: jackknife over the groups D_k, since within a group the
    residuals are a common staircase; they know of no systematic bend. A part of a group at the
    end of the tail counts as one. Ours.
    Raises InputError, also if modes in other groups do not fix the line.

    >>> spectrum = 10.0 ** (-20 * np.arange(1, 32) / 32)
    >>> fit = fit_profile(Chain(N=32, beta=1), spectrum, 2, floor=0)
    >>> round(fit.line.slope, 9), round(fit.scatter, 9)
    (-20.0, 0.0)
    """
    require_chain(chain)
    E = _spectrum(chain, spectrum)
    s = packet_width(chain, s)
    power = None if power is None else finite(power, "power")
    named = _modes(chain, s, modes)
    least = _floor(chain, floor, E)
    chosen = [q for q in named if E[q - 1] > least[q - 1]]
    groups = _groups_of(chain, s, chosen)
    _check_groups(chosen, groups, unknowns=3 if power is None else 2)
    X, y = _regression(chain, E, np.array(chosen), power)
    fitted = _solved(X, y)
    errors = _jackknife(X, y, groups)
    residuals = y - X @ fitted
    freedom = max(1, len(y) - X.shape[1])
    scatter = float(np.sqrt(residuals @ residuals / freedom))
    if power is not None:  # as given, without an error
        fitted = np.append(fitted, power)
        errors = np.append(errors, 0.0)
    slope_error, intercept_error, power_error = errors.tolist()
    return ProfileFit(
        line=ProfileLine(*fitted.tolist()),
        errors=(slope_error, intercept_error, power_error),
        scatter=scatter,
        modes=tuple(chosen),
        residuals=residuals,
    )


def _groups_of(chain: Chain, s: int, modes: Sequence[int]) -> NDArray[np.int64]:
    """The k of the D_k of every mode."""
    group_of = {}
    for k, group in enumerate(packet_groups(chain, s)):
        group_of.update(dict.fromkeys(group, k))
    return np.array([group_of[q] for q in modes], dtype=np.int64)


def _check_groups(modes: Sequence[int], groups: NDArray[np.int64], unknowns: int) -> None:
    """InputError unless the line is fixed without any one of the groups."""
    names, sizes = np.unique(groups, return_counts=True)
    if len(names) < LEAST_GROUPS or len(modes) - sizes.max() < unknowns:
        several = "modes above the floor in several groups D_k"
        raise InputError(
            "modes",
            tuple(modes),
            f"{several}, more than the line needs without any one of them",
            "name more, take fewer seeds, or the scheme aba864_modes for lower tails",
        )


def _regression(
    chain: Chain, E: Floats, modes: NDArray[np.int64], power: float | None
) -> tuple[Floats, Floats]:
    """Columns kappa, 1 and, if its power is to be found, log10 kappa; and what they are fitted to.

    That is log10 e_kappa, less power log10 kappa where the power is given.
    """
    kappa = modes / chain.N
    columns = [kappa, np.ones_like(kappa)]
    y = np.log10(E[modes - 1]) - math.log10(E.sum())
    if power is None:
        columns.append(np.log10(kappa))
    else:
        y = y - power * np.log10(kappa)
    return np.stack(columns, axis=1), y


def _solved(X: Floats, y: Floats) -> Floats:
    solution, *_ = np.linalg.lstsq(X, y, rcond=None)
    return np.asarray(solution)


def _jackknife(X: Floats, y: Floats, groups: NDArray[np.int64]) -> Floats:
    """Standard errors of the unknowns, from fits that leave one group out."""
    fits = []
    for k in np.unique(groups):
        kept = groups != k
        fits.append(_solved(X[kept], y[kept]))
    without = np.array(fits)
    squares = (without - without.mean(axis=0)) ** 2
    return np.asarray(np.sqrt((len(without) - 1) * np.mean(squares, axis=0)))


def _packet(chain: Chain, s: int, specific_energy: float) -> tuple[int, float]:
    require_chain(chain)
    if chain.model == "alpha+beta":
        raise InputError(
            "chain",
            chain,
            "one coupling, alpha or beta",
            "the laws are stated for each model alone",
        )
    return packet_width(chain, s), positive(specific_energy, "specific_energy")


def packet_width(chain: Chain, s: int) -> int:
    require_chain(chain)
    if integer(s, "s", 1) >= chain.N:
        raise InputError(
            "s",
            s,
            f"1..{chain.N - 1} (N = {chain.N})",
            "take fewer seeds or a longer chain",
        )
    return int(s)


def finite(value: float, argument: str) -> float:
    if (
        isinstance(value, bool)
        or not isinstance(value, Real)
        or not math.isfinite(float(value))
    ):
        raise InputError(argument, value, "a finite number", "pass a number")
    return float(value)


def positive(value: float, argument: str) -> float:
    if not finite(value, argument) > 0:
        raise InputError(argument, value, "a positive number", "pass one")
    return float(value)


def _spectrum(chain: Chain, spectrum: ArrayLike) -> Floats:
    require_chain(chain)
    try:
        E = DOUBLES.array(spectrum)
    except (TypeError, ValueError) as error:
        raise InputError(
            "spectrum", spectrum, "an array of numbers", "pass mean mode energies"
        ) from error
    energies = (np.isfinite(E) & (E >= 0)).all()
    if E.shape != (chain.N - 1,) or not energies or not E.sum() > 0:
        raise InputError(
            "spectrum",
            E.shape,
            f"{chain.N - 1} finite energies, 0 or more, not all 0",
            "pass mean mode energies, (N-1,)",
        )
    return E


def _modes(chain: Chain, s: int, modes: str | Sequence[int]) -> tuple[int, ...]:
    """The modes of a fit.

    tail : all of D_1, D_2, ... of the packet 1 .. s (Definition 3 with k_0 = 1).
    """
    if isinstance(modes, str):
        if modes not in ("tail", "middle"):
            raise InputError(
                "modes", modes, "tail, middle or a list of modes", "choose one of them"
            )
        return tuple(range(s + 1, chain.N)) if modes == "tail" else middle_modes(chain, s)
    listed = seed_modes(modes, chain.N)
    if min(listed) <= s:
        raise InputError(
            "modes", listed, f"modes beyond the seeds 1..{s}", "leave out the seeds"
        )
    return tuple(sorted(listed))


def _floor(chain: Chain, floor: float | ArrayLike, E: Floats) -> Floats:
    """As energies in the unit of E, (N-1,)."""
    try:
        least = DOUBLES.array(floor)
    except (TypeError, ValueError) as error:
        allowed = f"a number, or {chain.N - 1} of them"
        raise InputError("floor", floor, allowed, FLOOR_ADVICE) from error
    if least.ndim == 0:
        least = least * E.max()
    fits = least.shape in ((), (chain.N - 1,))
    if not fits or not (np.isfinite(least) & (least >= 0)).all():
        allowed = f"a number, 0 or more, or {chain.N - 1} of them"
        raise InputError("floor", floor, allowed, FLOOR_ADVICE)
    return np.asarray(np.broadcast_to(least, E.shape))
