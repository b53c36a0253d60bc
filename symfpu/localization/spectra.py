"""FPU-trajectories and what the paper does with orbits: normalised spectra, growth of the groups D_k, recurrence (sections 3.2, 4.1, 6.4).

An `Orbit` integrated with averages=True is a running spectrum: its `averages` are Ebar_q(t), its `harmonic_energies()` E_q(t). The closed
form of a torus is `torus.average_spectrum(T)`; PLn is the orbit from `torus.positions(0)` and `torus.momenta(0)`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.chain.chain import Chain, require_chain
from symfpu.dynamics.orbits import Orbit
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.typed import Number, exact, seed_modes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHARES = ("energy", "amplitude")
RISE = 0.25  # of its last value, up to which a running average follows its power law: 1 - sinc(x) has the slope 1.84 there, and not 2
SATURATED = 0.9  # of its last value: a running average that has reached it early has stopped growing
EARLY = 0.25  # of the whole time
SHORTEST = 2.0  # ratio of the ends of a window
NEAR, FAR = 1 / 3, 2 / 3  # of the largest distance: apart, so that wiggles do not cross both
FEWEST = 4  # samples of a window: two in each half


def fpu_trajectory(chain: Chain, amplitudes: Mapping[int, Number], phases: Mapping[int, Number] | None = None) -> tuple[Floats, Floats]:
    """Initial conditions (Q, P) of the FPU-trajectory with these seeds, each of shape (N-1,) (Definition 4 of the paper).

    Q_q = A_q cos phi_q, P_q = -A_q Omega_q sin phi_q for the seeds, exactly 0 for other modes. amplitudes, phases : by seed; phases left
    out are 0. Raises InputError.

    >>> fpu_trajectory(Chain(N=4, alpha=1), {1: 0.5, 3: "0.25"})
    (array([0.5 , 0.  , 0.25]), array([0., 0., 0.]))
    """
    require_chain(chain)
    seeds = seed_modes(_mapping(amplitudes, "amplitudes"), chain.N)
    angles = _mapping({} if phases is None else phases, "phases")
    for key in angles:
        if key not in amplitudes:
            raise InputError("phases", key, f"phases of the seeds {seeds}", "give that mode an amplitude, or leave its phase out")
    Q, P = np.zeros(chain.N - 1), np.zeros(chain.N - 1)
    for q in seeds:
        A, phi = _double(amplitudes[q], f"amplitudes[{q}]"), _double(angles.get(q, 0), f"phases[{q}]")
        Q[q - 1], P[q - 1] = A * math.cos(phi), 0.0 - A * chain.frequencies()[q - 1] * math.sin(phi)
    return Q, P


def packet_amplitudes(chain: Chain, seeds: Sequence[int], energy: Number, *, share: str = "energy") -> dict[int, float]:
    """Amplitudes A_q by seed whose harmonic energy, the sum of A_q^2 Omega_q^2 / 2, is `energy`, for `fpu_trajectory` with any phases.

    share : energy, the same E_q for all seeds; or amplitude, the same A_q. This is not H, which adds the anharmonic energy of the phases
    chosen. Raises InputError.

    >>> packet_amplitudes(Chain(N=3, alpha=1), (1, 2), 2, share="amplitude")  # Omega^2 = 1, 3
    {1: 1.0, 2: 1.0}
    """
    require_chain(chain)
    modes = seed_modes(seeds, chain.N)
    total = _double(energy, "energy")
    if not total > 0:
        raise InputError("energy", energy, "a positive number", "pass the harmonic energy of the packet")
    if share not in SHARES:
        raise InputError("share", share, ", ".join(SHARES), "choose one of them")
    linear = chain.frequencies()[np.array(modes) - 1]
    squared = 2 * total / len(modes) / linear**2 if share == "energy" else np.full(len(modes), 2 * total / np.sum(linear**2))
    return {q: float(A) for q, A in zip(modes, np.sqrt(squared), strict=True)}


def normalised_averages(orbit: Orbit) -> Floats:
    """Running averages of the harmonic energies over the total energy, Ebar_q(t)/H; shape (S, ..., N-1).

    orbit : integrated with averages=True; its last row is the paper's normalised averaged spectrum. Raises InputError.
    """
    if getattr(orbit, "averages", None) is None:
        raise InputError("orbit", repr(orbit), "an orbit with running averages", "integrate with averages=True")
    if not (orbit.energies[0] > 0).all():
        raise InputError("orbit", repr(orbit), "an orbit of positive energy", "divide its averages by another number")
    return np.asarray(orbit.averages / orbit.energies[0][..., None])


@dataclass(frozen=True)
class ProfileDistance:
    """Largest |log10(a_q/b_q)| of two profiles, the mode where it is reached, and how many modes of either lie above the floor."""

    distance: float
    mode: int
    modes: int

    def __repr__(self) -> str:
        return f"ProfileDistance({self.distance:.4g} decades at mode {self.mode}, {self.modes} modes above the floor)"


def profile_distance(a: ArrayLike, b: ArrayLike, floor: float) -> ProfileDistance:
    """How far two spectra differ: the largest |log10(a_q/b_q)|, where values below the floor count as the floor.

    a, b : energies by mode, shape (N-1,), not negative. floor : positive, in their units; below it energies are rounding, and two modes
    there do not differ. Raises InputError.

    >>> profile_distance([1, 1e-2, 1e-20], [1, 1e-3, 1e-25], 1e-12)
    ProfileDistance(1 decades at mode 2, 2 modes above the floor)
    """
    first, second, least = _energies(a, "a"), _energies(b, "b"), _double(floor, "floor")
    if first.ndim != 1 or first.shape != second.shape or not first.size:
        raise InputError("a, b", (first.shape, second.shape), "two spectra of the same modes, (N-1,)", "pass one row of each")
    if not least > 0:
        raise InputError("floor", floor, "a positive energy", "pass what rounding leaves, such as 1e-30 of the whole")
    ratios = np.abs(np.log10(np.maximum(first, least)) - np.log10(np.maximum(second, least)))
    mode = int(np.argmax(ratios))
    return ProfileDistance(float(ratios[mode]), mode + 1, int(np.sum(np.maximum(first, second) > least)))


@dataclass(frozen=True)
class GroupGrowth:
    """Growth of the modes of D_k: mean of their exponents, spread (largest |c_q - mean|), first and last saturation time; nan if none."""

    order: int
    modes: tuple[int, ...]
    mean: float
    spread: float
    saturation: tuple[float, float]

    def __repr__(self) -> str:
        first, last = self.saturation
        times = "not saturated" if math.isnan(first) else f"saturated at {first:.3g} .. {last:.3g}"
        exponents = "no stage of growth" if math.isnan(self.mean) else f"c = {self.mean:.3g}, spread {self.spread:.2g}"
        return f"D_{self.order} ({len(self.modes)} modes): {exponents}, {times}"


@dataclass(frozen=True, eq=False)
class GrowthExponents:
    """Exponents of Ebar_q(t) ~ t^(c_q), by mode. modes, orders, exponents, errors, saturation : (M,). windows, halves : (M, 2).

    errors : of the regression, residuals taken as independent. halves : exponents in the first and the second half (in log t) of the
    window; where they differ the average is no power law. saturation : when Ebar_q first reaches 0.9 of its last value. nan: no window of
    a factor 2 in time with 4 samples; still growing at the end.
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
    """Exponents c_q of the running averages Ebar_q(t) ~ t^(c_q) of an FPU-trajectory, for the modes of D_1, D_2, ... (section 4.1).

    times (S,), averages (S, N-1) : of an Orbit with averages=True, log-spaced. groups : D_0, D_1, ... as `excitation_sequence` gives them.
    window : from and to; default for each mode from pi / Omega of the slowest seed to the time at which Ebar_q reaches a quarter of
    its last value. Regression of log Ebar_q on log t, all samples alike.

    Perturbation theory: while t < 1/Omega_q a mode of D_k is pushed by forces that keep their sign, and Ebar_q ~ t^(4k-2) (phases 0).
    From pi / Omega of the slowest seed on the sum harmonics outrun the others, Q_q ~ t^k and Ebar_q ~ t^(2k), until t is about one over
    the detuning |Omega_q - nu.Omega|, of order N^3; then the average saturates. So 2k needs a long chain: at N = 256 it is met to a
    percent, at N = 32 by D_1 alone. The paper's (3/2) k is what a line through t = 1 .. 100, over both stages, gives there for
    k = 1, 2, 3. Tails below 1e-26 of the whole want the scheme aba864_modes. Raises InputError.
    """
    if averages is None:
        raise InputError("averages", None, "those of an orbit that has them", "integrate with averages=True")
    require_chain(chain)
    t, Ebar = _record(times, averages, "averages")
    if Ebar.shape[1] != chain.N - 1:
        raise InputError("averages", Ebar.shape, f"the {chain.N - 1} modes of {chain} on the last axis", "pass those of one orbit")
    seeds, modes, orders = _ordered(chain, groups)
    start = math.pi / chain.frequencies()[min(seeds) - 1]
    if window is None:
        windows = np.array([_window(t, Ebar[:, q - 1], start) for q in modes])
    else:
        windows = np.array([_checked(window, t)] * len(modes))
    fits = np.array([_growth(t, Ebar[:, q - 1], *ends) for q, ends in zip(modes, windows, strict=True)])
    saturation = np.array([_saturation(t, Ebar[:, q - 1]) for q in modes])
    return GrowthExponents(np.array(modes), np.array(orders), fits[:, 0], fits[:, 1], windows, fits[:, 2:], saturation)


def _ordered(chain: Chain, groups: Sequence[Sequence[int]]) -> tuple[tuple[int, ...], list[int], list[int]]:
    """The seeds; the other modes and the order of each."""
    try:
        first, *others = [tuple(group) for group in groups]
    except (TypeError, ValueError) as error:
        raise InputError("groups", groups, "D_0, D_1, ..., each a sequence of modes", "take those of excitation_sequence") from error
    seeds, modes = seed_modes(first, chain.N), [q for group in others for q in group]
    seed_modes(modes, chain.N)
    if common := set(seeds) & set(modes):
        raise InputError("groups", groups, "D_0, D_1, ... without common modes", f"leave out {min(common)} where it comes again")
    return seeds, modes, [k for k, group in enumerate(others, 1) for _ in group]


def _checked(window: tuple[float, float], t: Floats) -> tuple[float, float]:
    allowed = f"from and to, a factor {SHORTEST:g} apart or more, with {FEWEST} of the times between them"
    try:
        first, last = (_double(end, "window") for end in window)
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
    halves = [_slope(x[half], y[half])[0] if half.sum() > 1 else math.nan for half in (early, ~early)]
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


class NoRecurrence(SymfpuError):
    """The mode energies did not come back within the record."""

    def __init__(self, T: float, excursion: float) -> None:
        self.T, self.excursion = T, excursion
        super().__init__(
            f"no recurrence until t = {T:.6g}: the energies move {excursion:.3g} of the whole away and do not come back by two thirds; "
            f"record a longer orbit"
        )


@dataclass(frozen=True, eq=False)
class Recurrence:
    """Returns of an orbit to its first mode energies. times, returned : (R,), of each visit, in order of time. excursion : the farthest.

    returned : fraction of the harmonic energy that is back in its modes, 1 for all of it.
    """

    times: Floats = field(repr=False)
    returned: Floats = field(repr=False)
    excursion: float

    @property
    def first(self) -> tuple[float, float]:
        """Time and fraction of the first return."""
        return float(self.times[0]), float(self.returned[0])

    @property
    def best(self) -> tuple[float, float]:
        """Time and fraction of the most complete return."""
        place = int(np.argmax(self.returned))
        return float(self.times[place]), float(self.returned[place])

    def __repr__(self) -> str:
        (t, part), (T, most) = self.first, self.best
        return (
            f"Recurrence({len(self.times)} returns, first at t={t:.6g} of {part:.4%}, best at t={T:.6g} of {most:.4%}, "
            f"up to {self.excursion:.3g} of the energy away)"
        )


def recurrence(times: ArrayLike, energies: ArrayLike) -> Recurrence:
    """When the mode energies come back: d(t) = sum |E_q(t) - E_q(0)| / (2 sum E_q(0)), the fraction of the energy that is elsewhere.

    times (S,), energies (S, N-1) : E_q(t), sampled densely (`orbit.harmonic_energies()` with samples=np.arange(...)); E_q(0) is the first
    row. A return is the deepest minimum of d, refined by a parabola, of a visit: a time below a third of the largest d, after and before
    one above two thirds. The last visit may lack its end, but not its minimum. Raises InputError, NoRecurrence.

    >>> t = np.linspace(0, 15, 151)
    >>> recurrence(t, np.stack([1 + np.cos(t), 1 - np.cos(t)], axis=-1)).first
    (6.28..., 0.999...)
    """
    t, E = _record(times, energies, "energies")
    whole = E[0].sum()
    if not whole > 0:
        raise InputError("energies", float(whole), "a positive energy at the first time", "pass those of an orbit that moves")
    d = np.abs(E - E[0]).sum(axis=1) / (2 * whole)
    far, near = np.flatnonzero(d > FAR * d.max()), np.flatnonzero(d < NEAR * d.max())
    # the visits: groups of near samples with a far one between them, without the stay at the beginning
    passed = np.searchsorted(far, near)
    visits = [near[passed == count] for count in np.unique(passed) if count]
    deepest = [int(visit[np.argmin(d[visit])]) for visit in visits]
    found = [place for place in deepest if place < len(d) - 1]
    if not found:
        raise NoRecurrence(float(t[-1]), float(d.max()))
    minima = np.array([_vertex(t[i - 1 : i + 2], d[i - 1 : i + 2]) for i in found])
    return Recurrence(minima[:, 0], 1 - minima[:, 1], float(d.max()))


def _vertex(t: Floats, d: Floats) -> tuple[float, float]:
    """The lowest point of the parabola through three points, the middle one lowest; not below 0, which d cannot be."""
    (a, b), (f, g) = np.diff(t), np.diff(d) / np.diff(t)
    curvature = (g - f) / (a + b)
    if not curvature > 0:
        return float(t[1]), float(d[1])
    slope = f + a * curvature
    return float(t[1] - slope / (2 * curvature)), max(0.0, float(d[1] - slope**2 / (4 * curvature)))


def _record(times: ArrayLike, values: ArrayLike, name: str) -> tuple[Floats, Floats]:
    """Times and what was sampled at them, as arrays; raises InputError."""
    array = _energies(values, name)
    t = _energies(times, "times")
    if t.ndim != 1 or len(t) < 3 or not (np.diff(t) > 0).all():
        raise InputError("times", t.shape, "three increasing times or more, (S,)", "pass orbit.times")
    if array.ndim != 2 or len(array) != len(t):
        raise InputError(name, array.shape, f"one row for each of the {len(t)} times, (S, N-1)", "pass those of one orbit")
    return t, array


def _energies(values: ArrayLike, name: str) -> Floats:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(name, values, "an array of numbers", "pass those of an orbit") from error
    if not (np.isfinite(array) & (array >= 0)).all():
        raise InputError(name, "an array with nan, infinity or negative numbers", "finite numbers, 0 or more", "pass those of an orbit")
    return array


def _mapping(values: object, name: str) -> Mapping[int, Number]:
    if not isinstance(values, Mapping):
        raise InputError(name, values, "a mapping from mode to number, such as {1: 0.5}", "pass a dict")
    return values


def _double(value: Number, name: str) -> float:
    try:
        return float(exact(value, name))
    except OverflowError as error:
        raise InputError(name, value, "a number within the range of doubles", "take a smaller one") from error
