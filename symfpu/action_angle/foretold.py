"""Alignment indices of a torus foretold, for all times, in closed form.

The deviations of a frame are known at every time (`symfpu.action_angle.linear_flow`); their
volume is the Gram determinant of the unit vectors, by a QR factorisation whose rows are ordered
by what grows with t. So log GALI_k costs the same at t = 1e3 and at t = 1e12.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.action_angle.linear_flow import (
    LinearFlow,
    NormalDirection,
    direction_at_rest,
    exact_direction,
)
from symfpu.action_angle.newton_twist import REFINED, changes_by_action
from symfpu.dynamics.alignment import (
    SAMPLES,
    Slope,
    drawn_frame,
    frame_size,
    last_time,
    sample_count,
)
from symfpu.dynamics.dimension import (
    DECADES,
    LEAST_SAMPLES,
    ODDNESS,
    Evidence,
    TorusDimension,
    expected_steps,
    fits,
    torus_dimension,
)
from symfpu.errors import InputError
from symfpu.normal.modes import NormalModes
from symfpu.normal.torus import require_refined, second_order
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.numbers.typed import double, random_seed
from symfpu.results.attributes import attributes
from symfpu.results.field import Field, listed
from symfpu.results.grid import Grid, Variable
from symfpu.results.result import Gridded
from symfpu.tori.torus import Torus, require_solution

Floats = NDArray[np.float64]
TABLE = 4_000_000  # cosines held at once
EXACT, AT_REST = "normal modes", "modes at rest"
LONGEST = 1e15  # time: angles are known to 0.1 there


@public
@dataclass(frozen=True, eq=False)
class ForetoldIndices(Gridded):
    """log10 GALI_k of a torus in closed form. Made by `foretold_indices`; ours, dimensionless.

    torus : the torus. times : (S,). log10_gali : (S, vectors-1), for k = 2 .. vectors. growth : of
    the first vector, log |v_1|, natural, (S,).
    rates : (s,), singular values of E Lambda Omega(E, .), descending: |v| grows by up to t times
        the first, and a direction of the torus is seen from about 1 over its rate on.
    normal : "normal modes", which is exact, or "modes at rest", which is near.

    >>> import symfpu
    >>> from symfpu import Chain, foretold_indices, normal_modes
    >>> orbit = symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.4"})
    >>> foretold_indices(orbit, 1e6, vectors=4, normal=normal_modes(orbit))
    ForetoldIndices(N=4, beta=1, seeds=2, t = 1e+06, regular, dimension 1: slopes of GALI_2..4
    ..., on the torus -1, -2, -3, settled from t = ..., by normal modes)
    """

    torus: Torus
    times: Floats
    log10_gali: Floats
    growth: Floats
    rates: Floats = field(repr=False)
    normal: str

    def _fields(self) -> Iterator[Field]:
        yield from super()._fields()
        yield Field("", label="chain", shown=self.torus.chain.label)
        yield Field("", label="seeds", shown=listed(self.torus.seeds))
        for k, time in self.settling().items():
            settled = settled_text(time, self.times[-1])
            shown = f"slope {self.asymptotic_slopes[k]}, {settled}"
            yield Field("", label=f"G_{k}", shown=shown)
        rates = listed(f"{rate:.2g}" for rate in self.rates)
        yield Field("", label="rates of growth", shown=rates)

    def __repr__(self) -> str:
        chain = self.torus.chain.label
        seeds = ",".join(map(str, self.torus.seeds))
        found = ", ".join(f"{slope.value:.2f}" for slope in self.slopes())
        due = ", ".join(map(str, self.asymptotic_slopes.values()))
        settled = _since(list(self.settling().values()))
        return (
            f"ForetoldIndices({chain}, seeds={seeds}, t = {self.times[-1]:.3g}, {self.verdict}: "
            f"slopes of GALI_2..{self.vectors} {found}, on the torus {due}, "
            f"{settled}, by {self.normal})"
        )

    @property
    def vectors(self) -> int:
        """The number of deviation vectors."""
        return int(self.log10_gali.shape[1]) + 1

    @property
    def asymptotic_slopes(self) -> Mapping[int, int]:
        """d log GALI_k / d log t in the end, by k: 0 up to s, then -1, -2, ... ."""
        n = self.torus.chain.N - 1
        steps = expected_steps(len(self.torus.seeds), n, self.vectors)
        return dict(enumerate(np.cumsum(steps).tolist(), start=2))

    @property
    def verdict(self) -> str:
        """What an integration to the last time would say: that of `dimension()`."""
        return self.dimension().verdict

    def slopes(self, T: float | None = None, decades: float = DECADES) -> tuple[Slope, ...]:
        """d log GALI_k / d log t over the last decades before T, default the last time.

        decades : of time. As `AlignmentIndices.slopes`. Raises InputError for too few samples
        before T.
        """
        known = self._until(T)
        found = fits(self.times[:known], self.log10_gali[:known], decades)
        return tuple(Slope(k, *fit) for k, fit in enumerate(found, start=2))

    def dimension(self, T: float | None = None, decades: float = DECADES) -> TorusDimension:
        """What an integration to T can show of the torus, default the last time.

        decades : of time, the last ones, in which slopes are fitted. Judged as
        `AlignmentIndices.dimension` judges. Raises InputError.
        """
        known = self._until(T)
        times, gali = self.times[:known], self.log10_gali[:known]
        n = self.torus.chain.N - 1
        return torus_dimension(Evidence(times, self.growth[:known], gali, n, decades))

    def settling(self, decades: float = DECADES) -> Mapping[int, float]:
        """By k the time from which every fit to the last decades has the slope of the torus.

        To 1/3, as a verdict asks for; inf where the last fit has not. The plateau begins so many
        decades before. decades : of a fit.
        """
        due = np.array(list(self.asymptotic_slopes.values()))
        ends = self._looks()
        found = np.full(len(due), np.inf)
        waiting = np.ones(len(due), dtype=bool)
        for end in reversed(ends):
            slopes = [
                slope.value for slope in self.slopes(float(self.times[end - 1]), decades)
            ]
            waiting &= np.abs(np.array(slopes) - due) <= ODDNESS
            found[waiting] = self.times[end - 1]
        return dict(enumerate(found.tolist(), start=2))

    def _looks(self) -> list[int]:
        """Numbers of samples after which it is looked: every eighth of a decade, about."""
        first, last = LEAST_SAMPLES, len(self.times)
        decades = math.log10(self.times[-1] / self.times[first - 1])
        count = max(2, math.ceil(8 * decades))
        return sorted({round(x) for x in np.linspace(first, last, count)})

    def _until(self, T: float | None) -> int:
        if T is None:
            return len(self.times)
        last = double(T, "T")
        known = int(np.searchsorted(self.times, last * (1 + 1e-12), side="right"))
        if known < LEAST_SAMPLES:
            shortest = self.times[LEAST_SAMPLES - 1]
            advice = "take a longer time, or more samples"
            raise InputError("T", T, f"from {shortest:.3g} on", advice)
        return known

    def _grid(self) -> Grid:
        rows = ("time", "k")
        settled = self.settling()
        return Grid(
            axes={"time": self.times, "k": list(settled), "seed": self.torus.seeds},
            variables={
                "log10_gali": Variable(rows, self.log10_gali, "log10 of GALI_k"),
                "growth": Variable(("time",), self.growth, "log |v_1|"),
                "settled": Variable(
                    ("k",), list(settled.values()), "time of the torus' slope"
                ),
                "asymptotic_slope": Variable(
                    ("k",),
                    list(self.asymptotic_slopes.values()),
                    "of log GALI_k with log t",
                ),
                "rate": Variable(("seed",), self.rates, "of growth, by size"),
            },
            attributes=attributes(
                self,
                self.torus.chain,
                seeds=self.torus.seeds,
                normal=self.normal,
                verdict=self.verdict,
            ),
            rows=rows,
        )


def _since(settled: Sequence[float]) -> str:
    """From when on indices have settled, in words."""
    if all(map(math.isinf, settled)):
        return "none settled by then"
    times = ("not by then" if math.isinf(t) else f"{t:.2g}" for t in settled)
    return f"settled from t = {', '.join(times)}"


def settled_text(time: float, last: float) -> str:
    """From when on one index has settled, in words, where times end at the last one."""
    if math.isinf(time):
        return f"not settled by t = {last:.3g}"
    return f"settled from t = {time:.3g}"


@public
def foretold_indices(
    solution: Torus,
    T: float | ArrayLike,
    *,
    vectors: int | None = None,
    seed: int = 0,
    start: float = 0.0,
    normal: NormalModes | None = None,
    samples: int = SAMPLES,
) -> ForetoldIndices:
    """GALI_2 .. GALI_vectors of a torus or breather for all times, without integration.

    solution : refined: its residual is at most 1e-8. With fixed ends, or of a ring: travelling
        waves, or what `unfold` gave. Dimensionless.
    T : the last time, up to 1e15, or the times (S,), ascending and positive, 64 at least.
    vectors, seed, samples : as `alignment_indices` takes them; the frame is the same.
    start : the time on the solution at which the frame is drawn: `solution.state(start)`, on a
        ring the same, complex.
    normal : what `normal_modes(solution)` gave, all modes, elliptic: then the indices are exact.
        Without it the normal directions turn as modes at rest do, which changes indices by a few
        tenths of a decade at most for weak coupling, and neither slopes nor settling times.
        Standing waves of a ring want it: no mode at rest is like what displaces them.

    Neighbouring tori turn against each other by t Lambda dI, and normal directions turn with
    sigma_q: the volumes of sections 3.2 and 4 are Gram determinants of that. Ours. Raises
    InputError, also for a hyperbolic torus; NoTwist.

    >>> import symfpu
    >>> from symfpu import Chain
    >>> found = foretold_indices(symfpu.torus(Chain(N=4, beta=1), (2,), amplitudes={2: "0.4"}), 1e8)
    >>> found.asymptotic_slopes
    {2: -1, 3: -2, 4: -3, 5: -4, 6: -6}
    """
    torus = _checked(solution)
    count, drawn = frame_size(torus.chain.N - 1, vectors), random_seed(seed)
    times = _times(T, samples)
    flow = flow_of(torus, normal, double(start, "start"))
    return indices_by(flow, solution, times, count, drawn)


def flow_of(
    torus: Torus, normal: NormalModes | None = None, start: float = 0.0
) -> LinearFlow:
    """The linearised flow about a refined torus from its state at a time on."""
    directions = _at_rest(torus) if normal is None else _given(torus, normal)
    phases = np.array([float(torus.phases[q]) for q in torus.seeds])
    omega = np.array([float(w) for w in torus.frequencies])
    begun = phases + omega * start
    doubles = torus.in_doubles()
    changes = changes_by_action(doubles)
    return LinearFlow(doubles, changes, begun, directions, exact=normal is not None)


def indices_by(
    flow: LinearFlow, solution: Torus, times: Floats, vectors: int, seed: int
) -> ForetoldIndices:
    """Indices of one frame; all frames of a torus need one flow."""
    s = len(solution.seeds)
    frame = np.concatenate(drawn_frame(solution.chain, vectors, seed), axis=1).T
    gali, growth = _volumes(flow, frame, times)
    return ForetoldIndices(
        torus=solution,
        times=times,
        log10_gali=gali,
        growth=growth,
        rates=growth_rates(flow)[:s],
        normal=EXACT if flow.exact else AT_REST,
    )


def growth_rates(flow: LinearFlow) -> Floats:
    """Singular values of the growth E Lambda Omega(E, .), |E| averaged over the torus; (s,)."""
    values, vectors = np.linalg.eigh(flow.mean_metric())
    root = (vectors * np.sqrt(np.maximum(values, 0))) @ vectors.T
    along = flow.basis(np.zeros(1))[0][0]
    return np.asarray(np.linalg.svd(root @ flow.twist @ along.T, compute_uv=False))


def _volumes(flow: LinearFlow, frame: Floats, times: Floats) -> tuple[Floats, Floats]:
    """log10 GALI_k of a frame (2D, k), (T, k-1), and log |v_1|."""
    start = flow.coordinates(frame)
    most = max(1, len(flow.harmonics), *(len(d.harmonics) for d in flow.normal))
    portion = max(1, TABLE // (8 * most))
    gali, growth = [], []
    for first in range(0, len(times), portion):
        some = times[first : first + portion]
        logs, lengths = _volumes_at(flow, start, some)
        gali.append(logs)
        growth.append(lengths)
    return np.concatenate(gali), np.concatenate(growth)


def _volumes_at(flow: LinearFlow, start: Floats, times: Floats) -> tuple[Floats, Floats]:
    """The same at few times.

    The coordinates along the torus, which grow, are the first rows: Householder's reflections
    keep rows of different sizes apart.
    """
    basis = np.linalg.qr(np.concatenate(flow.basis(times), axis=2), mode="r")
    vectors = basis @ flow.moved(start, times)
    lengths = np.linalg.norm(vectors, axis=1)
    factors = np.linalg.qr(vectors / lengths[:, None, :], mode="r")
    heights = np.abs(np.diagonal(factors, axis1=1, axis2=2))
    return np.cumsum(np.log10(heights), axis=1)[:, 1:], np.log(lengths[:, 0])


def _checked(solution: object) -> Torus:
    """The solution in doubles; InputError for what is no refined torus."""
    torus = require_solution(solution, "solution")
    require_refined(torus, REFINED)
    return torus.in_doubles()


def _times(T: object, samples: int) -> Floats:
    if np.ndim(T) == 0:  # type: ignore[arg-type]
        last = last_time(T)
        if last > LONGEST:
            raise InputError("T", T, f"up to {LONGEST:.0e}", "take a shorter time")
        return np.asarray(np.geomspace(1.0, last, sample_count(samples)))
    times = DOUBLES.array(T)
    ascending = times.ndim == 1 and len(times) > 0 and bool(np.all(np.diff(times) > 0))
    if not ascending or not 0 < times[0] <= times[-1] <= LONGEST:
        allowed = f"a time, or ascending times between 0 and {LONGEST:.0e}"
        raise InputError(
            "T", T, allowed, "pass the times of alignment_indices, or a number"
        )
    sample_count(len(times))
    return times


def _at_rest(torus: Torus) -> list[NormalDirection]:
    if torus.stands:
        allowed = "normal modes, of standing waves of a ring"
        raise InputError("normal", None, allowed, "pass normal_modes(solution)")
    n, s = torus.chain.N - 1, len(torus.seeds)
    sigma = second_order(torus)
    return [
        direction_at_rest(place, sigma[q], n, s)
        for place, q in enumerate(torus.chain.mode_numbers)
        if q not in torus.seeds
    ]


def _given(torus: Torus, normal: object) -> list[NormalDirection]:
    """The directions of normal modes that are those of this torus; InputError for others."""
    if not isinstance(normal, NormalModes):
        advice = "pass normal_modes(solution)"
        raise InputError("normal", type(normal).__name__, "NormalModes, or None", advice)
    other = normal.torus
    same = (other.chain, other.seeds, other.frequencies) == (
        torus.chain,
        torus.seeds,
        torus.frequencies,
    )
    due = torus.chain.N - 1 - len(torus.seeds)
    if not same or len(normal.modes) != due:
        allowed = f"all {due} normal modes of this solution"
        advice = "pass normal_modes(solution)"
        if normal.missing:
            advice = "take a torus of another amplitude, where none is missing"
        raise InputError("normal", repr(normal), allowed, advice)
    if not normal.stable:
        advice = "along it volumes shrink exponentially: alignment_indices follows them"
        raise InputError("normal", normal.verdict, "a torus with elliptic modes", advice)
    return [exact_direction(mode) for mode in normal.modes]
