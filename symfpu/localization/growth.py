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
from symfpu.numbers.counted import counted
from symfpu.numbers.public import public
from symfpu.numbers.typed import double, seed_modes
from symfpu.results.attributes import attributes
from symfpu.results.result import Tabled
from symfpu.results.table import Columns, Table, joined

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# of its last value, up to which a running average follows its power law: 1 - sinc(x) has the
# slope 1.84 there, and not 2
GROWTH_SHARE = 0.25
# of its last value: a running average that has reached it early has stopped growing
SATURATION_SHARE = 0.9
EARLY_SHARE = 0.25  # of the whole time
LEAST_RATIO = 2.0  # of the ends of a window
LEAST_SAMPLES = 4  # of a window: two in each half


@dataclass(frozen=True)
class GroupGrowth(Tabled):
    """Growth of the averaged energies of the modes of one D_k (section 4.1).

    order : k. modes : of D_k. mean : of their exponents c_q, spread : largest |c_q - mean|;
        dimensionless, nan if none.
    saturation : first and last time of the group, in units of the chain; nan if none.

    >>> GroupGrowth(1, (2, 3), 2.02, 0.05, (110.0, 150.0))
    D_1 (2 modes): c = 2.02, spread 0.05, saturated at 110 .. 150
    >>> GroupGrowth(1, (2, 3), 2.02, 0.05, (110.0, 150.0)).to_frame().modes[0]
    '2,3'
    """

    order: int
    modes: tuple[int, ...]
    mean: float
    spread: float
    saturation: tuple[float, float]

    def __repr__(self) -> str:
        name = f"D_{self.order} ({counted(len(self.modes), 'mode')})"
        return f"{name}: {self._exponents}, {self._times}"

    @property
    def _exponents(self) -> str:
        if math.isnan(self.mean):
            return "no stage of growth"
        return f"c = {self.mean:.3g}, spread {self.spread:.2g}"

    @property
    def _times(self) -> str:
        first, last = self.saturation
        if math.isnan(first):
            return "not saturated"
        return f"saturated at {first:.3g} .. {last:.3g}"

    def _table(self) -> Table:
        """One row."""
        first, last = self.saturation
        columns: Columns = {
            "order": [self.order],
            "modes": [joined(self.modes)],
            "exponent": [self.mean],
            "spread": [self.spread],
            "first_saturation": [first],
            "last_saturation": [last],
        }
        return Table(columns, attributes(self))


@dataclass(frozen=True, eq=False)
class GrowthExponents(Tabled):
    """Exponents of Ebar_q(t) ~ t^(c_q), by mode (section 4.1); dimensionless.

    Made by `growth_exponents`.

    modes, orders : q and the k of its D_k, integers, (M,). exponents : c_q, (M,).
    errors : of the regression, residuals taken as independent, (M,). windows : from and to,
        times, (M, 2).
    halves : exponents in the first and the second half (in log t) of the window, (M, 2); where
        they differ the average is no power law.
    saturation : when Ebar_q first reaches 0.9 of its last value, (M,); nan where it grows to the
        end.

    nan: no window of a factor 2 in time with 4 samples.

    >>> from symfpu import Chain, growth_exponents
    >>> t = np.geomspace(1, 1e3, 61)
    >>> averages = np.stack([1 + 0 * t, np.minimum(1e-9 * t**2, 1e-4), 1e-20 + 0 * t], axis=-1)
    >>> growth_exponents(Chain(N=4, alpha=1), t, averages, [(1,), (2,)], window=(2, 100))
    GrowthExponents(D_1 (1 mode): c = 2, spread 0, not saturated)
    >>> found = growth_exponents(Chain(N=4, alpha=1), t, averages, [(1,), (2,)], window=(2, 100))
    >>> found.to_frame()[["mode", "order", "exponent"]].round(6)
       mode  order  exponent
    0     2      1       2.0
    """

    modes: Ints
    orders: Ints
    exponents: Floats
    errors: Floats = field(repr=False)
    windows: Floats = field(repr=False)
    halves: Floats = field(repr=False)
    saturation: Floats = field(repr=False)

    def __repr__(self) -> str:
        groups = "; ".join(map(repr, self.groups))
        return f"GrowthExponents({groups})"

    @property
    def groups(self) -> tuple[GroupGrowth, ...]:
        """By order, from D_1 on."""
        return tuple(self._group(int(k)) for k in np.unique(self.orders))

    def _group(self, k: int) -> GroupGrowth:
        members = self.orders == k
        modes = tuple(map(int, self.modes[members]))
        exponents = _finite(self.exponents[members])
        times = _finite(self.saturation[members])
        mean = spread = first = last = math.nan
        if exponents.size:
            mean = float(exponents.mean())
            spread = float(np.abs(exponents - mean).max())
        if times.size:
            first = float(times.min())
            last = float(times.max())
        return GroupGrowth(k, modes, mean, spread, (first, last))

    def _table(self) -> Table:
        """One row for each mode."""
        columns: Columns = {
            "mode": self.modes,
            "order": self.orders,
            "exponent": self.exponents,
            "error": self.errors,
            "window_from": self.windows[:, 0],
            "window_to": self.windows[:, 1],
            "first_half": self.halves[:, 0],
            "second_half": self.halves[:, 1],
            "saturation": self.saturation,
        }
        return Table(columns, attributes(self))


@public
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
    groups : D_0, D_1, ... as `excitation_sequence` gives them; the modes of D_1, D_2, ... are
        looked at.
    window : from and to; default for each mode from pi / Omega of the slowest seed to the time at
        which Ebar_q reaches a quarter of its last value. Regression of log Ebar_q on log t, all
        samples alike.

    Perturbation theory: while t < 1/Omega_q a mode of D_k is pushed by forces that keep their
    sign, and Ebar_q ~ t^(4k-2) (phases 0). From pi / Omega of the slowest seed on the sum
    harmonics outrun the others, Q_q ~ t^k and Ebar_q ~ t^(2k), until t is about one over the
    detuning |Omega_q - nu.Omega|, of order N^3; then the average saturates. So 2k needs a long
    chain: at N = 256 it is met to a percent, at N = 32 by D_1 alone. The paper's (3/2) k is what
    a line through t = 1 .. 100, over both stages, gives there for k = 1, 2, 3. Tails below 1e-26
    of the whole want the scheme aba864_modes. Raises InputError.

    >>> from symfpu.chain.chain import Chain
    >>> t = np.geomspace(1, 1e3, 61)
    >>> averages = np.stack([1 + 0 * t, 1e-9 * t**2, 1e-20 + 0 * t], axis=-1)
    >>> found = growth_exponents(Chain(N=4, alpha=1), t, averages, [(1,), (2,)], window=(2, 100))
    >>> found.exponents.round(9)
    array([2.])
    """
    require_chain(chain)
    if averages is None:
        raise InputError(
            "averages",
            None,
            "those of an orbit that has them",
            "integrate with averages=True",
        )
    t, Ebar = energy_record(times, averages, "averages")
    if Ebar.shape[1] != chain.N - 1:
        raise InputError(
            "averages",
            Ebar.shape,
            f"the {chain.N - 1} modes of {chain} on the last axis",
            "pass those of one orbit",
        )
    seeds, modes, orders = _ordered(chain, groups)
    columns = [Ebar[:, q - 1] for q in modes]
    if window is None:
        slowest = chain.frequencies()[min(seeds) - 1]
        start = math.pi / slowest
        windows = [_window(t, values, start) for values in columns]
    else:
        windows = [_checked(window, t)] * len(modes)
    fits = []
    for values, (first, last) in zip(columns, windows, strict=True):
        fits.append(_growth(t, values, first, last))
    fitted = np.array(fits)
    saturation = [_saturation(t, values) for values in columns]
    return GrowthExponents(
        modes=np.array(modes),
        orders=np.array(orders),
        exponents=fitted[:, 0],
        errors=fitted[:, 1],
        windows=np.array(windows),
        halves=fitted[:, 2:],
        saturation=np.array(saturation),
    )


def _finite(values: Floats) -> Floats:
    return values[np.isfinite(values)]


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
    seeds = seed_modes(first, chain.N)
    modes = [q for group in others for q in group]
    orders = [k for k, group in enumerate(others, 1) for _ in group]
    seed_modes(modes, chain.N)  # raises for modes that are none
    common = set(seeds) & set(modes)
    if common:
        raise InputError(
            "groups",
            groups,
            "D_0, D_1, ... without common modes",
            f"leave out {min(common)} where it comes again",
        )
    return seeds, modes, orders


def _checked(window: tuple[float, float], t: Floats) -> tuple[float, float]:
    apart = f"a factor {LEAST_RATIO:g} apart or more"
    allowed = f"from and to, {apart}, with {LEAST_SAMPLES} of the times between them"
    try:
        first, last = (double(end, "window") for end in window)
    except (TypeError, ValueError) as error:
        raise InputError("window", window, allowed, "pass two times") from error
    long = 0 < first * LEAST_RATIO <= last
    inside = (t >= first) & (t <= last)
    if not long or inside.sum() < LEAST_SAMPLES:
        raise InputError("window", window, allowed, "take a longer one, or more samples")
    return first, last


def _window(t: Floats, values: Floats, start: float) -> tuple[float, float]:
    """From the start to where the average leaves its power law."""
    risen = values >= GROWTH_SHARE * values[-1]
    end = t[np.argmax(risen)]
    return start, float(end)


def _growth(t: Floats, values: Floats, first: float, last: float) -> list[float]:
    """Exponent, error, exponents of both halves of the window."""
    inside = (t >= first) & (t <= last) & (values > 0)
    if not last >= LEAST_RATIO * first or inside.sum() < LEAST_SAMPLES:
        return [math.nan] * 4
    x = np.log(t[inside])
    y = np.log(values[inside])
    exponent, error = _slope(x, y)
    middle = (x[0] + x[-1]) / 2
    early = x <= middle
    late = ~early
    halves = []
    for half in (early, late):
        part, _ = _slope(x[half], y[half]) if half.sum() > 1 else (math.nan, math.nan)
        halves.append(part)
    return [exponent, error, *halves]


def _slope(x: Floats, y: Floats) -> tuple[float, float]:
    """Of the regression line, and its standard error (nan for two points)."""
    dx = x - x.mean()
    square = dx @ dx
    slope = float(dx @ y / square)
    if len(x) <= 2:
        return slope, math.nan
    left = y - y.mean() - slope * dx
    variance = left @ left / (len(x) - 2)
    return slope, float(np.sqrt(variance / square))


def _saturation(t: Floats, values: Floats) -> float:
    """When the average stopped growing; nan where it did so late, or is 0."""
    saturated = values >= SATURATION_SHARE * values[-1]
    reached = float(t[np.argmax(saturated)])
    early = reached <= EARLY_SHARE * t[-1]
    if values[-1] > 0 and early:
        return reached
    return math.nan
