"""Growth of the groups D_k in an FPU-trajectory (section 4.1)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.errors import InputError
from symfpu.localization.profiles import energy_record
from symfpu.numbers.typed import double, seed_modes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# of its last value, up to which a running average follows its power law: 1 - sinc(x) has the
# slope 1.84 there, and not 2
RISE = 0.25
# of its last value: a running average that has reached it early has stopped growing
SATURATED = 0.9
EARLY = 0.25  # of the whole time
SHORTEST = 2.0  # ratio of the ends of a window
FEWEST = 4  # samples of a window: two in each half


@dataclass(frozen=True)
class GroupGrowth:
    """Growth of the averaged energies of the modes of one D_k (section 4.1).

    order : k. modes : of D_k. mean : of their exponents c_q, spread : largest |c_q - mean|; dimensionless,
        nan if none.
    saturation : first and last time of the group, in units of the chain; nan if none.

    >>> GroupGrowth(1, (2, 3), 2.02, 0.05, (110.0, 150.0))
    D_1 (2 modes): c = 2.02, spread 0.05, saturated at 110 .. 150
    """

    order: int
    modes: tuple[int, ...]
    mean: float
    spread: float
    saturation: tuple[float, float]

    def __repr__(self) -> str:
        first, last = self.saturation
        times = "not saturated" if math.isnan(first) else f"saturated at {first:.3g} .. {last:.3g}"
        exponents = (
            "no stage of growth"
            if math.isnan(self.mean)
            else f"c = {self.mean:.3g}, spread {self.spread:.2g}"
        )
        return f"D_{self.order} ({len(self.modes)} modes): {exponents}, {times}"


@dataclass(frozen=True, eq=False)
class GrowthExponents:
    """Exponents of Ebar_q(t) ~ t^(c_q), by mode (section 4.1). Made by `growth_exponents`; dimensionless.

    modes, orders : q and the k of its D_k, integers, (M,). exponents : c_q, (M,).
    errors : of the regression, residuals taken as independent, (M,). windows : from and to, times, (M, 2).
    halves : exponents in the first and the second half (in log t) of the window, (M, 2); where they differ
        the average is no power law.
    saturation : when Ebar_q first reaches 0.9 of its last value, (M,); nan where it grows to the end.

    nan: no window of a factor 2 in time with 4 samples.

    >>> from symfpu import Chain, growth_exponents
    >>> t = np.geomspace(1, 1e3, 61)
    >>> averages = np.stack([1 + 0 * t, np.minimum(1e-9 * t**2, 1e-4), 1e-20 + 0 * t], axis=-1)
    >>> growth_exponents(Chain(N=4, alpha=1), t, averages, [(1,), (2,)], window=(2, 100))
    GrowthExponents(D_1 (1 modes): c = 2, spread 0, not saturated)
    """

    modes: Ints
    orders: Ints
    exponents: Floats
    errors: Floats = field(repr=False)
    windows: Floats = field(repr=False)
    halves: Floats = field(repr=False)
    saturation: Floats = field(repr=False)

    def __repr__(self) -> str:
        return f"GrowthExponents({'; '.join(map(repr, self.groups))})"

    @property
    def groups(self) -> tuple[GroupGrowth, ...]:
        """By order, from D_1 on."""
        found = []
        for k in map(int, np.unique(self.orders)):
            members = self.orders == k
            known = self.exponents[members][np.isfinite(self.exponents[members])]
            ended = self.saturation[members][np.isfinite(self.saturation[members])]
            mean = float(known.mean()) if known.size else math.nan
            spread = float(np.abs(known - mean).max()) if known.size else math.nan
            times = (float(ended.min()), float(ended.max())) if ended.size else (math.nan, math.nan)
            found.append(GroupGrowth(k, tuple(map(int, self.modes[members])), mean, spread, times))
        return tuple(found)


def growth_exponents(
    chain: Chain,
    times: ArrayLike,
    averages: ArrayLike | None,
    groups: Sequence[Sequence[int]],
    *,
    window: tuple[float, float] | None = None,
) -> GrowthExponents:
    """Exponents c_q of the running averages Ebar_q(t) ~ t^(c_q) of an FPU-trajectory (section 4.1).

    chain : the model; times are in its units, dimensionless.
    times, averages : (S,) and (S, N-1), of an Orbit with averages=True, log-spaced.
    groups : D_0, D_1, ... as `excitation_sequence` gives them; the modes of D_1, D_2, ... are looked at.
    window : from and to; default for each mode from pi / Omega of the slowest seed to the time at which
        Ebar_q reaches a quarter of its last value. Regression of log Ebar_q on log t, all samples alike.

    Perturbation theory: while t < 1/Omega_q a mode of D_k is pushed by forces that keep their sign, and
    Ebar_q ~ t^(4k-2) (phases 0). From pi / Omega of the slowest seed on the sum harmonics outrun the others,
    Q_q ~ t^k and Ebar_q ~ t^(2k), until t is about one over the detuning |Omega_q - nu.Omega|, of order N^3;
    then the average saturates. So 2k needs a long chain: at N = 256 it is met to a percent, at N = 32 by D_1
    alone. The paper's (3/2) k is what a line through t = 1 .. 100, over both stages, gives there for k = 1,
    2, 3. Tails below 1e-26 of the whole want the scheme aba864_modes. Raises InputError.

    >>> from symfpu.chain.chain import Chain
    >>> t = np.geomspace(1, 1e3, 61)
    >>> averages = np.stack([1 + 0 * t, 1e-9 * t**2, 1e-20 + 0 * t], axis=-1)
    >>> growth_exponents(Chain(N=4, alpha=1), t, averages, [(1,), (2,)], window=(2, 100)).exponents.round(9)
    array([2.])
    """
    if averages is None:
        raise InputError(
            "averages", None, "those of an orbit that has them", "integrate with averages=True"
        )
    require_chain(chain)
    t, Ebar = energy_record(times, averages, "averages")
    if Ebar.shape[1] != chain.N - 1:
        raise InputError(
            "averages",
            Ebar.shape,
            f"the {chain.N - 1} modes of {chain} on the last axis",
            "pass those of one orbit",
        )
    seeds, modes, orders = _ordered(chain, groups)
    start = math.pi / chain.frequencies()[min(seeds) - 1]
    if window is None:
        windows = np.array([_window(t, Ebar[:, q - 1], start) for q in modes])
    else:
        windows = np.array([_checked(window, t)] * len(modes))
    fits = np.array(
        [_growth(t, Ebar[:, q - 1], *ends) for q, ends in zip(modes, windows, strict=True)]
    )
    saturation = np.array([_saturation(t, Ebar[:, q - 1]) for q in modes])
    return GrowthExponents(
        np.array(modes), np.array(orders), fits[:, 0], fits[:, 1], windows, fits[:, 2:], saturation
    )


def _ordered(
    chain: Chain, groups: Sequence[Sequence[int]]
) -> tuple[tuple[int, ...], list[int], list[int]]:
    """The seeds; the other modes and the order of each."""
    try:
        first, *others = [tuple(group) for group in groups]
    except (TypeError, ValueError) as error:
        raise InputError(
            "groups",
            groups,
            "D_0, D_1, ..., each a sequence of modes",
            "take those of excitation_sequence",
        ) from error
    seeds, modes = seed_modes(first, chain.N), [q for group in others for q in group]
    seed_modes(modes, chain.N)
    if common := set(seeds) & set(modes):
        raise InputError(
            "groups",
            groups,
            "D_0, D_1, ... without common modes",
            f"leave out {min(common)} where it comes again",
        )
    return seeds, modes, [k for k, group in enumerate(others, 1) for _ in group]


def _checked(window: tuple[float, float], t: Floats) -> tuple[float, float]:
    allowed = (
        f"from and to, a factor {SHORTEST:g} apart or more, with {FEWEST} of the times between them"
    )
    try:
        first, last = (double(end, "window") for end in window)
    except (TypeError, ValueError) as error:
        raise InputError("window", window, allowed, "pass two times") from error
    if not 0 < first * SHORTEST <= last or np.sum((t >= first) & (t <= last)) < FEWEST:
        raise InputError("window", window, allowed, "take a longer one, or more samples")
    return first, last


def _window(t: Floats, values: Floats, start: float) -> tuple[float, float]:
    return start, float(t[np.argmax(values >= RISE * values[-1])])


def _growth(t: Floats, values: Floats, first: float, last: float) -> list[float]:
    """Exponent, error, exponents of both halves of the window."""
    inside = (t >= first) & (t <= last) & (values > 0)
    if not last >= SHORTEST * first or inside.sum() < FEWEST:
        return [math.nan] * 4
    x, y = np.log(t[inside]), np.log(values[inside])
    exponent, scatter = _slope(x, y)
    early = x <= (x[0] + x[-1]) / 2
    halves = [
        _slope(x[half], y[half])[0] if half.sum() > 1 else math.nan for half in (early, ~early)
    ]
    return [exponent, scatter, *halves]


def _slope(x: Floats, y: Floats) -> tuple[float, float]:
    """Of the regression line, and its standard error (nan for two points)."""
    dx = x - x.mean()
    slope = float(dx @ y / (dx @ dx))
    left = y - y.mean() - slope * dx
    return slope, float(np.sqrt(left @ left / (len(x) - 2) / (dx @ dx))) if len(x) > 2 else math.nan


def _saturation(t: Floats, values: Floats) -> float:
    reached = float(t[np.argmax(values >= SATURATED * values[-1])])
    return reached if values[-1] > 0 and reached <= EARLY * t[-1] else math.nan
